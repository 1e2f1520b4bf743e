//! Points moved onto a target as a rigid body.
//!
//! In: measured points, a gear, what the fit is free to move. Out: [`LaidPoints`].
//!
//! **Law.** A small turn w about the axis and through the origin and a shift t change the deviation h of a point p by
//! n . (w x p + t). Gauss and Newton's method sets the sum of the squares of h on the evaluated parts of the flanks to
//! its least value; after each step feet are looked for anew.
//!
//! Who measures a gear that is alone on a machine, or draws it, knows its axis better than how it is turned. So the
//! search begins with the whole turn in steps of an eighth of a pitch; of all places that end with the same least sum,
//! as of a round gear's pitches, the smallest turn is taken.
//!
//! Files may say to which flank a point belongs. Where the points then lie badly they are laid once more without that:
//! if they lie much better, tooth and flank are counted otherwise than here ([`LaidPoints::unnamed`]).

use super::feet::{Foot, TargetFlanks};
use super::probed::ProbedPoint;
use crate::job::GearJob;
use crate::pair_job::watch::Watch;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::math::least_squares::solve_any;
use glam::{DMat3, DVec3};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Steps of the whole turn in a pitch.
const STEPS_OF_PITCH: u32 = 8;
/// Points by which places of the whole turn are compared.
const COMPARED_POINTS: usize = 120;
/// Places of the whole turn that are fitted.
const FITTED_PLACES: usize = 12;
/// Sums of squares that differ by a smaller share are the same.
const SAME_SUM: f64 = 1e-3;
/// A fit has ended when no point moves further, mm.
const SETTLED_MM: f64 = 1e-8;
/// Steps in which the points are chosen that the fit rests on.
const CHOOSING_STEPS: usize = 4;
/// Most steps of the fit.
const MOST_STEPS: usize = 30;
/// Points whose root mean square is beyond this share of how far they may be off are laid once more without their
/// tooth and flank.
const BADLY_LAID: f64 = 0.1;
/// Mean squares without tooth and flank that are below this share of those with them contradict these.
const CONTRADICTING: f64 = 0.25;
/// Numbers that a body has: turn, shift across, tilt, shift along the axis.
const BODY: usize = 6;

/// What the fit is free to move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FitFreedom {
    /// Nothing: the points are in the gear's frame.
    Fixed,
    /// The turn about the axis.
    Turn,
    /// The turn, and the axis across itself.
    Centre,
    /// The turn, and the axis with its tilt.
    Axis,
    /// All six numbers of a body.
    Body,
}

impl FitFreedom {
    /// How many numbers are fitted.
    pub fn count(self) -> usize {
        match self {
            Self::Fixed => 0,
            Self::Turn => 1,
            Self::Centre => 3,
            Self::Axis => 5,
            Self::Body => BODY,
        }
    }

    /// What is fitted, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Fixed => "nothing: the points are in the frame of the gear",
            Self::Turn => "the turn about the axis",
            Self::Centre => "the turn about the axis, and the axis across itself",
            Self::Axis => "the turn about the axis, and the axis across itself with its tilt",
            Self::Body => "the turn, the axis with its tilt, and the place along it",
        }
    }
}

/// Where the points lie on the gear.
#[derive(Debug, Clone, PartialEq)]
pub struct LaidPoints {
    /// Feet of the points in their order; none where a point lies on no flank.
    pub feet: Vec<Option<Foot>>,
    /// From the frame of the points to that of the gear.
    pub moved: RigidMove,
    /// Points by which they were moved: on the evaluated parts of flanks.
    pub fitted: usize,
    /// Points that lie on flanks if they may lie on any, where the tooth and the flank that they name contradict their
    /// places.
    pub unnamed: Option<usize>,
}

/// A turn about the origin, and then a shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidMove {
    /// The turn.
    pub turn: DMat3,
    /// The shift, mm.
    pub shift_mm: DVec3,
}

impl RigidMove {
    fn about_axis(angle_rad: f64) -> Self {
        Self { turn: DMat3::from_rotation_z(angle_rad), shift_mm: DVec3::ZERO }
    }

    /// Where a point is after the move.
    pub fn place_mm(&self, point: &ProbedPoint) -> DVec3 {
        self.turn * point.place_mm + self.shift_mm
    }

    /// This move and then another one.
    fn then(&self, next: &Self) -> Self {
        Self { turn: next.turn * self.turn, shift_mm: next.turn * self.shift_mm + next.shift_mm }
    }

    /// The turn about the axis, rad, from -pi to pi.
    pub fn angle_rad(&self) -> f64 {
        self.turn.x_axis.y.atan2(self.turn.x_axis.x)
    }

    /// How far the axis is tilted about x and about y, rad.
    pub fn tilt_rad(&self) -> [f64; 2] {
        let DVec3 { x, y, z } = self.turn.z_axis;
        [(-y).atan2(z), x.atan2(z)]
    }
}

/// Lays points on a gear; `probe_radius_mm` is that of the ball whose centres they are, 0 of points of the surface.
///
/// # Errors
/// Flanks that the gear does not have; too few points on flanks, or points that do not say what is free; the tool
/// generates no flank somewhere; Ctrl-C.
pub fn lay(
    gear: &dyn GearJob,
    points: &[ProbedPoint],
    freedom: FitFreedom,
    probe_radius_mm: f64,
    watch: &Watch<'_>,
) -> Result<LaidPoints> {
    let flanks = TargetFlanks::new(gear, probe_radius_mm)?;
    flanks.refuse_unknown(points)?;
    let fit = RigidFit { gear, flanks: &flanks, points, freedom };
    let named = fit.best(watch)?;
    let badly_mm2 = (BADLY_LAID * flanks.reach_mm()).powi(2);
    let is_doubtful =
        named.as_ref().is_none_or(|of| of.mean_mm2 > badly_mm2) && points.iter().any(|p| p.flank.is_some());
    let unnamed = if is_doubtful {
        let points: Vec<ProbedPoint> = points.iter().map(|point| ProbedPoint { flank: None, ..*point }).collect();
        let any = RigidFit { points: &points, ..fit }.best(watch)?;
        let contradicts = |any: &Fitted| named.as_ref().is_none_or(|of| any.mean_mm2 < CONTRADICTING * of.mean_mm2);
        any.filter(contradicts).map(|any| any.feet.iter().flatten().count())
    } else {
        None
    };
    let Some(Fitted { feet, moved, .. }) = named else { return Err(fit.refused(unnamed).into()) };
    let fitted = feet.iter().flatten().filter(|foot| fit.is_evaluated(foot)).count();
    Ok(LaidPoints { feet, moved, fitted, unnamed })
}

/// How a gear and teeth are counted, for files that count otherwise.
pub(super) const COUNTED: &str = "count teeth counter-clockwise from the x axis of the gear, seen from z, and call \
                                  left the flank at larger angles; or leave the columns tooth and flank out";

/// Numbers of the points by which places of the turn are compared, of so many: one in each of equal runs, in each at
/// another place of the run, since flanks may have as many points as a run.
fn compared(points: usize) -> Vec<usize> {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let runs = points.min(COMPARED_POINTS);
    let run = points as f64 / runs.max(1) as f64;
    (0..runs).map(|i| ((i as f64 + (i as f64 * GOLDEN).fract()) * run) as usize).collect()
}

/// Points about the move that suits them best.
struct Fitted {
    /// Mean square of the deviations; what is on no flank counts as far as it may be off one.
    mean_mm2: f64,
    moved: RigidMove,
    feet: Vec<Option<Foot>>,
}

#[derive(Clone, Copy)]
struct RigidFit<'a> {
    gear: &'a dyn GearJob,
    flanks: &'a TargetFlanks<'a>,
    points: &'a [ProbedPoint],
    freedom: FitFreedom,
}

impl RigidFit<'_> {
    /// The best fit; none where the points determine none.
    fn best(&self, watch: &Watch<'_>) -> Result<Option<Fitted>> {
        let begun = match self.freedom {
            FitFreedom::Fixed => vec![RigidMove::about_axis(0.0)],
            _ => self.places(watch)?,
        };
        let stage = watch.stage("feet", begun.len() + 1, "places of the turn")?;
        let some = compared(self.points.len());
        let mut best: Option<(f64, RigidMove)> = None;
        for place in begun {
            if let Some((sum, moved)) = self.settled(place, &some)?
                && best.is_none_or(|(least, other)| {
                    sum < (1.0 - SAME_SUM) * least
                        || sum < (1.0 + SAME_SUM) * least && moved.angle_rad().abs() < other.angle_rad().abs()
                })
            {
                best = Some((sum, moved));
            }
            stage.count()?;
        }
        let all: Vec<usize> = (0..self.points.len()).collect();
        let settled = best.map(|(_, moved)| self.settled(moved, &all)).transpose()?.flatten();
        let feet_about = |(mean_mm2, moved): (f64, RigidMove)| -> Result<Fitted> {
            Ok(Fitted { mean_mm2, moved, feet: self.feet(&moved, &all)? })
        };
        let fitted = settled.map(feet_about).transpose()?;
        stage.count()?;
        stage.finish();
        Ok(fitted)
    }

    /// Why there is no fit; so many points lie on flanks if they may lie on any.
    fn refused(&self, unnamed: Option<usize>) -> Refusal {
        let reach_mm = self.flanks.reach_mm();
        if let Some(on_flanks) = unnamed {
            let problem = format!(
                "tooth and flank of the points contradict their places: {on_flanks} of {} lie on flanks if they may \
                 lie on any, too few on those that they name",
                self.points.len()
            );
            return Refusal::new("--measured", problem, COUNTED);
        }
        let (least, points) = (self.freedom.count() + 1, self.points.len());
        let off = format!("fewer than {least} of {points} points lie within {reach_mm} mm of evaluated flanks");
        let check = "check the unit of the file, the scene's module and teeth, and that the gear's axis is z and z = 0 \
                     is the middle of its face";
        if self.freedom == FitFreedom::Fixed {
            return Refusal::new("--measured", off, format!("{check}; or let --fit turn the points"));
        }
        let problem = format!("{off}, or they do not determine {}", self.freedom.words());
        Refusal::new("--measured", problem, format!("{check}; or give --fit less to move"))
    }

    /// Places of the whole turn about which the points are near to flanks, the nearest first.
    fn places(&self, watch: &Watch<'_>) -> Result<Vec<RigidMove>> {
        let steps = STEPS_OF_PITCH * self.gear.scene().gear.teeth;
        let stage = watch.stage("turn", steps as usize, "places of the turn")?;
        let some = compared(self.points.len());
        let sum = |step: u32| {
            let moved = RigidMove::about_axis(TAU * f64::from(step) / f64::from(steps));
            let squares = some.iter().map(|&index| {
                let point = &self.points[index];
                self.flanks.deviation_mm(moved.place_mm(point), point.flank).powi(2)
            });
            let sum: f64 = squares.sum();
            stage.count()?;
            Ok((sum, moved))
        };
        let sums: Vec<(f64, RigidMove)> = (0..steps).into_par_iter().map(sum).collect::<Result<_>>()?;
        stage.finish();
        let count = sums.len();
        let is_least = |i: usize| sums[i].0 <= sums[(i + 1) % count].0 && sums[i].0 <= sums[(i + count - 1) % count].0;
        let mut least: Vec<&(f64, RigidMove)> = (0..count).filter(|&i| is_least(i)).map(|i| &sums[i]).collect();
        // The smallest turn is among them, even where others are nearer by a little.
        least.sort_by(|a, b| a.1.angle_rad().abs().total_cmp(&b.1.angle_rad().abs()));
        let smallest = least.first().copied();
        least.sort_by(|a, b| a.0.total_cmp(&b.0));
        let nearest = least.into_iter().take(FITTED_PLACES);
        Ok(smallest.into_iter().chain(nearest).map(|(_, moved)| *moved).collect())
    }

    /// Feet of some points, by their numbers.
    fn feet(&self, moved: &RigidMove, some: &[usize]) -> Result<Vec<Option<Foot>>> {
        let foot = |&index: &usize| {
            let point = &self.points[index];
            self.flanks.foot(moved.place_mm(point), point.flank)
        };
        some.par_iter().map(foot).collect()
    }

    /// Whether a foot is on the evaluated part of its flank.
    fn is_evaluated(&self, foot: &Foot) -> bool {
        let face_mm = self.gear.evaluated_face_mm();
        let profile_mm = self.gear.evaluated_profile_mm(foot.tooth, foot.side);
        let is_in = |[from, to]: [f64; 2], at: f64| (from..=to).contains(&at);
        profile_mm.is_ok_and(|ends| is_in(ends, foot.u_mm)) && is_in(face_mm, foot.v_mm)
    }

    /// The move about which some points, by their numbers, have the least mean square, begun from one; and that mean.
    /// None where they do not determine it.
    fn settled(&self, begin: RigidMove, some: &[usize]) -> Result<Option<(f64, RigidMove)>> {
        let radius_mm = self.points.iter().map(|point| point.place_mm.length()).fold(1e-6, f64::max);
        let mut moved = begin;
        let mut counted: Vec<usize> = Vec::new();
        for round in 0..MOST_STEPS {
            // A point at the end of what is evaluated would go in and out for ever.
            let is_chosen = round >= CHOOSING_STEPS;
            let looked_at = if is_chosen { &counted } else { some };
            let feet = self.feet(&moved, looked_at)?;
            let on_flanks: Vec<(usize, Foot)> = looked_at
                .iter()
                .zip(&feet)
                .filter_map(|(&index, foot)| Some((index, (*foot)?)))
                .filter(|(_, foot)| is_chosen || self.is_evaluated(foot))
                .collect();
            if on_flanks.len() <= self.freedom.count() {
                return Ok(None);
            }
            counted = on_flanks.iter().map(|(index, _)| *index).collect();
            let on_flanks: Vec<(DVec3, Foot)> =
                on_flanks.into_iter().map(|(index, foot)| (moved.place_mm(&self.points[index]), foot)).collect();
            // What is not on a flank counts as far as it may be off one: few good points are no better than many.
            let off = (some.len() - on_flanks.len()) as f64 * self.flanks.reach_mm().powi(2);
            let squares: f64 = on_flanks.iter().map(|(_, foot)| foot.height_mm.powi(2)).sum();
            let mean = (squares + off) / some.len() as f64;
            let Some(step) = self.step(&on_flanks, radius_mm) else { return Ok(None) };
            moved = moved.then(&step);
            let far_mm = step.shift_mm.length()
                + radius_mm * (step.turn.x_axis - DVec3::X).length().max((step.turn.z_axis - DVec3::Z).length());
            if far_mm < SETTLED_MM {
                return Ok(Some((mean, moved)));
            }
        }
        Ok(None)
    }

    /// The small move that the deviations of points at their places want; none where they do not determine it.
    fn step(&self, on_flanks: &[(DVec3, Foot)], radius_mm: f64) -> Option<RigidMove> {
        // Turns in mm at the outermost point, so that all numbers are alike.
        let equations = on_flanks.iter().map(|(place_mm, foot)| {
            let turns = place_mm.cross(foot.normal) / radius_mm;
            let n = foot.normal;
            let row = [turns.z, n.x, n.y, turns.x, turns.y, n.z];
            (row[..self.freedom.count()].to_vec(), -foot.height_mm)
        });
        let solved = solve_any(self.freedom.count(), equations).ok()?;
        let [turn, x, y, tilt_x, tilt_y, z]: [f64; BODY] =
            std::array::from_fn(|i| solved.get(i).copied().unwrap_or_default());
        let turn = DVec3::new(tilt_x, tilt_y, turn) / radius_mm;
        let angle = turn.length().min(PI);
        let turn = if angle > 0.0 { DMat3::from_axis_angle(turn.normalize(), angle) } else { DMat3::IDENTITY };
        Some(RigidMove { turn, shift_mm: DVec3::new(x, y, z) })
    }
}
