//! Ease-off: how far one flank of a gear stands from another one of the same gear, and which setting explains it.
//!
//! In: two flanks on one blank, such as the target and what a machine with wrong settings generates. Out: the distance
//! along the first one's normal on a grid, positive where the second one leaves material ([`ease_off_mm`]); and, for a
//! grid of measured deviations, the setting whose error explains it best ([`explain`]).
//!
//! A turn of the work is no error of form: before anything is compared, the work is turned so that the deviation in the
//! middle of the grid is gone, as inspection does it.
//!
//! The law of the distance: the second flank is sought on the first one's normal at P + h n, where its point at the
//! same cone distance and height has the same polar angle. Its change per h is that of a plane to the first order, so
//! that secants arrive in a few steps.
//!
//! The road not taken for the explanation: one fit of all settings at once. Sliding base, machine centre to back and
//! blank offset change a flank in nearly the same way, and a common fit shares a single error out among them. Each
//! setting is tried by itself, and what it leaves unexplained is said.

use super::blank::BevelBlank;
use super::cradle::CradleSettings;
use super::envelope::{Envelope, FlankPoint, OnFlank};
use super::flank::BevelFlank;
use crate::error::{NotConverged, Refusal};
use crate::math::convergence::{Step, iterate};
use crate::parameter;
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

/// A step along the normal below this is the last, mm.
const LAST_STEP_MM: f64 = 1e-11;
/// Steps at most; it takes three or four.
const MOST_STEPS: u32 = 30;
/// A distance this small in the middle of the grid is turned away for the last time, mm: what that leaves is a small
/// share of it, far below the errors of measurements.
const FITTED_MM: f64 = 1e-9;
/// Errors of settings at which sensitivities are taken: mm, rad, ratio. Deviations of a hundredth of a millimetre are
/// still proportional to a thousandth of themselves.
const LENGTH_STEP_MM: f64 = 0.01;
const ANGLE_STEP_RAD: f64 = 1e-4;
const RATIO_STEP: f64 = 1e-4;

/// A setting whose error may explain deviations ([`Setting::acts_on`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Setting {
    /// S_r, mm.
    Radial,
    /// q, rad.
    CradleAngle,
    /// E_m, mm.
    BlankOffset,
    /// Sliding base, mm.
    SlidingBase,
    /// X_p, mm.
    CenterToBack,
    /// gamma_m, rad.
    RootAngle,
    /// R_a.
    RollRatio,
    /// Tilt i, rad, towards the swivel's direction.
    Tilt,
    /// Swivel j, rad.
    Swivel,
}

/// What a setting's error explains of measured deviations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Explained {
    /// The setting.
    pub setting: Setting,
    /// Its error, mm, rad or a ratio.
    pub error: f64,
    /// Root mean square of what is left unexplained, mm.
    pub left_rms_mm: f64,
}

impl Setting {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Radial,
        Self::CradleAngle,
        Self::BlankOffset,
        Self::SlidingBase,
        Self::CenterToBack,
        Self::RootAngle,
        Self::RollRatio,
        Self::Tilt,
        Self::Swivel,
    ];

    /// Whether its error changes a flank. Where the roll is even, the head on another place of the cradle cuts the same
    /// slot at another angle of the work; where nothing rolls there is no ratio and no tilt, and an upright head leans
    /// nowhere.
    pub fn acts_on(self, settings: &CradleSettings) -> bool {
        match self {
            Self::CradleAngle => settings.plunges(),
            Self::RollRatio | Self::Tilt => !settings.plunges(),
            Self::Swivel => !settings.tilt.is_none(),
            _ => true,
        }
    }

    /// Its usual name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Radial => "radial setting",
            Self::CradleAngle => "cradle angle",
            Self::BlankOffset => "blank offset",
            Self::SlidingBase => "sliding base",
            Self::CenterToBack => "machine centre to back",
            Self::RootAngle => "root angle",
            Self::RollRatio => "ratio of roll",
            Self::Tilt => "tilt of the head",
            Self::Swivel => "swivel of the head",
        }
    }

    /// Whether it is an angle, rad.
    pub fn is_angle(self) -> bool {
        matches!(self, Self::CradleAngle | Self::RootAngle | Self::Tilt | Self::Swivel)
    }

    fn step(self) -> f64 {
        match self {
            Self::RollRatio => RATIO_STEP,
            _ if self.is_angle() => ANGLE_STEP_RAD,
            _ => LENGTH_STEP_MM,
        }
    }

    /// Settings that are off by an error in this one.
    pub fn off_by(self, error: f64, settings: &CradleSettings) -> CradleSettings {
        let mut off = *settings;
        match self {
            Self::Radial => off.radial_setting_mm += error,
            Self::CradleAngle => off.cradle_angle_rad += error,
            Self::BlankOffset => off.blank_offset_mm += error,
            Self::SlidingBase => off.sliding_base_mm += error,
            Self::CenterToBack => off.center_to_back_mm += error,
            Self::RootAngle => off.root_angle_rad += error,
            Self::RollRatio => off.roll.ratio += error,
            Self::Tilt => off.tilt.tilt_rad += error,
            Self::Swivel => off.tilt.swivel_rad += error,
        }
        off
    }
}

/// Where the second flank stands on the normal of a point of the first one, mm; `turn_rad` turns the second one about
/// the work's axis.
///
/// # Errors
/// The second flank is not generated there.
pub fn distance_mm(at: &FlankPoint, other: &Envelope, blank: &BevelBlank, turn_rad: f64) -> Result<f64, NotConverged> {
    let mut start = other.guess(blank.cone_distance_and_height_mm(at.point_mm)[0]);
    // Beyond the second flank along the circle of a point, mm.
    let mut beyond = |height_mm: f64| -> Result<(f64, f64), NotConverged> {
        let point_mm = at.point_mm + height_mm * at.normal;
        let [distance_mm, over_mm] = blank.cone_distance_and_height_mm(point_mm);
        let found = other.find(blank, distance_mm, OnFlank::Height(over_mm), start)?;
        start = found.coordinates;
        let [own, others] = [point_mm, found.point_mm].map(|p| p.z.atan2(p.y));
        let radius_mm = point_mm.with_x(0.0).length();
        let along = DVec3::new(0.0, -own.sin(), own.cos());
        let arc = (own - others - turn_rad + PI).rem_euclid(TAU) - PI;
        Ok((radius_mm * arc, at.normal.dot(along)))
    };
    let mut height_mm = 0.0;
    let mut lost = NotConverged {
        what: "a flank on another one's normal",
        after: MOST_STEPS,
        last: 0.0,
        last_step: f64::INFINITY,
        residual: f64::INFINITY,
    };
    for _ in 0..MOST_STEPS {
        let (arc_mm, along) = beyond(height_mm)?;
        // Along the normal by dh the arc grows by dh / along: planes of the same normal.
        let step_mm = -arc_mm * along;
        height_mm += step_mm;
        (lost.last, lost.last_step, lost.residual) = (height_mm, step_mm, arc_mm);
        if step_mm.abs() < LAST_STEP_MM {
            return Ok(height_mm);
        }
    }
    Err(lost)
}

/// Distances of another flank on the grid of a flank, so many shares of the profile times places along the tooth, with
/// the other one turned so that the middle of the grid fits; row by row along the tooth, mm.
///
/// # Errors
/// One of the flanks is not generated somewhere on the grid.
pub fn ease_off_mm(
    flank: &BevelFlank,
    other: &Envelope,
    shares: &[f64],
    along_mm: &[f64],
) -> Result<Vec<f64>, Refusal> {
    let blank = &flank.blank;
    let lost = |lost: NotConverged| Refusal::new(parameter::CRADLE, lost.to_string(), "check the settings");
    let mut points = Vec::new();
    for &along in along_mm {
        let row = flank.row(along)?;
        for &share in shares {
            points.push(row.point(share)?);
        }
    }
    let middle = points[points.len() / 2];
    let turn_rad = fitting_turn_rad(&middle, other, blank).map_err(lost)?;
    points.iter().map(|point| distance_mm(point, other, blank, turn_rad).map_err(lost)).collect()
}

/// Turn of the other flank that takes its distance from a point away, rad: by the point's arc, which the distance
/// follows but for the flanks' slopes against each other, so that every step leaves a small share of the one before.
fn fitting_turn_rad(at: &FlankPoint, other: &Envelope, blank: &BevelBlank) -> Result<f64, NotConverged> {
    let arm_mm = DVec3::X.cross(at.point_mm).dot(at.normal);
    let step = |turn_rad: f64| {
        let off_mm = match distance_mm(at, other, blank, turn_rad) {
            Ok(off_mm) => off_mm,
            Err(lost) => return ControlFlow::Break(Err(lost)),
        };
        let to = turn_rad - off_mm / arm_mm;
        if off_mm.abs() <= FITTED_MM {
            ControlFlow::Break(Ok(to))
        } else {
            ControlFlow::Continue(Step { to, residual: off_mm })
        }
    };
    iterate("the turn of a flank onto another one", 0.0, MOST_STEPS, step)?
}

/// Settings that explain measured deviations, best first; deviations stand on the same grid as in [`ease_off_mm`], mm.
///
/// # Errors
/// A flank is not generated somewhere on the grid.
pub fn explain(
    flank: &BevelFlank,
    shares: &[f64],
    along_mm: &[f64],
    measured_mm: &[f64],
) -> Result<Vec<Explained>, Refusal> {
    let settled = levelled(flank, shares, along_mm, measured_mm)?;
    let mut found = Vec::new();
    for setting in Setting::ALL.into_iter().filter(|setting| setting.acts_on(&flank.envelope.settings)) {
        let step = setting.step();
        let envelope = Envelope { settings: setting.off_by(step, &flank.envelope.settings), ..flank.envelope };
        let shape = ease_off_mm(flank, &envelope, shares, along_mm)?;
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let scale = dot(&shape, &settled) / dot(&shape, &shape);
        let left: f64 = settled.iter().zip(&shape).map(|(m, s)| (m - scale * s).powi(2)).sum();
        let left_rms_mm = (left / settled.len() as f64).sqrt();
        found.push(Explained { setting, error: scale * step, left_rms_mm });
    }
    found.sort_by(|a, b| a.left_rms_mm.total_cmp(&b.left_rms_mm));
    Ok(found)
}

/// Deviations less those of a turn of the work that takes the middle's away.
fn levelled(flank: &BevelFlank, shares: &[f64], along_mm: &[f64], measured_mm: &[f64]) -> Result<Vec<f64>, Refusal> {
    let mut arms = Vec::new();
    for &along in along_mm {
        let row = flank.row(along)?;
        for &share in shares {
            let point = row.point(share)?;
            arms.push(DVec3::X.cross(point.point_mm).dot(point.normal));
        }
    }
    let middle = measured_mm.len() / 2;
    let turn = measured_mm[middle] / arms[middle];
    Ok(measured_mm.iter().zip(&arms).map(|(measured, arm)| measured - turn * arm).collect())
}
