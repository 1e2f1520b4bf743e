//! What advances equally from stroke to stroke: work angle, arc, or time.
//!
//! In: the scene's choice of spacing and the axis speed limits. Out: the progress sigma as a function of phi, as a
//! series and inverted. Law: sigma = psi_c, sigma = S, or sigma = T with dT/dphi = max over the limited axes of
//! |daxis/dphi| / limit, the shortest time in which the path can be run while the slowest axis is at its speed limit.
//!
//! Road not taken: limits on acceleration in T. They make the law depend on the path behind, and the peaks that
//! [`crate::process::shaping::linkage::dynamics`] reports tell whether they matter.

use std::sync::Arc;

use crate::process::shaping::linkage::Axes;
use crate::process::shaping::linkage::ShapingLinkage;
use crate::process::shaping::scene::model::{AxisLimits, StrokeSpacing};
use gearcut_core::error::Refusal;
use gearcut_core::gear::Rolling;
use gearcut_core::math::Jet;
use gearcut_core::math::periodic_integral::PeriodicIntegral;
use gearcut_core::math::roots::{bisect, sample_angle_rad};
use gearcut_core::units::TURN_RAD;

/// Progress along the path.
#[derive(Debug, Clone)]
pub(super) enum PathProgress {
    /// psi_c, rad.
    WorkAngle,
    /// S, mm.
    Arc,
    /// T at the speed limits, s.
    Time(Arc<TimeLaw>),
}

/// T(phi) at one offset.
#[derive(Debug)]
pub(super) struct TimeLaw {
    elapsed: PeriodicIntegral,
    limits: AxisLimits,
    offset_mm: f64,
}

impl PathProgress {
    /// The law for a spacing; `key` is the scene key of the spacing.
    pub(super) fn new(
        spacing: StrokeSpacing,
        linkage: &ShapingLinkage,
        limits: AxisLimits,
        offset_mm: f64,
        key: &str,
    ) -> Result<Self, Refusal> {
        match spacing {
            StrokeSpacing::WorkAngle => Ok(Self::WorkAngle),
            StrokeSpacing::Arc => Ok(Self::Arc),
            StrokeSpacing::Time => Ok(Self::Time(Arc::new(TimeLaw::new(linkage, limits, offset_mm, key)?))),
        }
    }

    /// sigma of one turn.
    pub(super) fn per_turn(&self, linkage: &ShapingLinkage) -> f64 {
        match self {
            Self::WorkAngle => TURN_RAD,
            Self::Arc => linkage.curve().perimeter_mm(),
            Self::Time(law) => law.elapsed.closed(),
        }
    }

    /// sigma where phi and offset are series.
    pub(super) fn along(&self, linkage: &ShapingLinkage, phi_rad: Jet<3>, offset_mm: Jet<3>) -> Jet<3> {
        match self {
            Self::WorkAngle => linkage.work_angle_along(phi_rad, offset_mm),
            Self::Arc => Rolling::new(linkage.curve(), phi_rad).arc(linkage.curve()),
            Self::Time(law) => law.along(linkage, phi_rad),
        }
    }

    /// The phi at which sigma has a value.
    pub(super) fn phi(&self, linkage: &ShapingLinkage, sigma: f64, offset_mm: f64) -> f64 {
        match self {
            Self::WorkAngle => linkage.phi_at_work_angle(sigma, offset_mm),
            Self::Arc => linkage.curve().phi_at_arc(sigma),
            Self::Time(law) => law.elapsed.angle_at(sigma),
        }
    }
}

impl TimeLaw {
    fn new(linkage: &ShapingLinkage, limits: AxisLimits, offset_mm: f64, key: &str) -> Result<Self, Refusal> {
        let axis = |phi: f64| slowest(&linkage.axes(phi, offset_mm), limits);
        let way_out = "write work_speed_deg_per_s or cutter_speed_deg_per_s under [machine.limits]";
        if axis(0.0).is_none() {
            let problem = "equal times let the slowest axis run at its speed limit, but no speed is limited";
            return Err(Refusal::new(key, problem, way_out));
        }
        // The integrand has a kink wherever another axis becomes the slowest, and is zero where the slowest turns back.
        let samples = linkage.curve().samples_per_turn();
        let index = |phi: f64| axis(phi).map(|(index, _)| index);
        let seconds_per_rad = |phi: f64| axis(phi).map_or(f64::NAN, |(_, rate)| rate.value());
        let mut breaks_rad = linkage.curve().breaks_rad();
        for i in 1..=samples {
            let (lo, hi) = (sample_angle_rad(i - 1, samples), sample_angle_rad(i, samples));
            let first = index(lo);
            if first != index(hi) {
                breaks_rad.push(bisect(|phi| index(phi) == first, lo, hi).rem_euclid(TURN_RAD));
            }
        }
        breaks_rad.sort_by(f64::total_cmp);
        let even = (0..samples).map(|i| sample_angle_rad(i, samples));
        let times: Vec<f64> = even.chain(breaks_rad.iter().copied()).map(seconds_per_rad).collect();
        let smallest = times.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = times.iter().copied().fold(0.0, f64::max);
        let refused = |why: String| {
            let problem = "equal times need an axis with a speed limit that never stops; the limited ones do";
            Refusal::new(key, format!("{problem}: {why}"), way_out)
        };
        if smallest <= 1e-6 * largest {
            return Err(refused(format!("{smallest:e} s per radian at the slowest, {largest:e} at the fastest")));
        }
        let elapsed = PeriodicIntegral::new(seconds_per_rad, &breaks_rad, 16, 1e-12 * largest)
            .map_err(|why| refused(why.to_string()))?;
        Ok(Self { elapsed, limits, offset_mm })
    }

    fn along(&self, linkage: &ShapingLinkage, phi_rad: Jet<3>) -> Jet<3> {
        let phi = phi_rad.value();
        let rate =
            slowest(&linkage.axes(phi, self.offset_mm), self.limits).map_or(Jet::constant(f64::NAN), |(_, rate)| rate);
        rate.integrate::<3>(self.elapsed.at(phi)).compose(&phi_rad)
    }
}

/// The axis that takes longest per radian of phi with its direction, and that time in s per rad with its derivative.
fn slowest(axes: &Axes<3>, limits: AxisLimits) -> Option<((usize, bool), Jet<2>)> {
    let limited = [
        (axes.psi_c_rad, limits.work_speed_rad_per_s),
        (axes.psi_b_rad, limits.cutter_speed_rad_per_s),
        (axes.center_distance_mm, limits.center_distance_speed_mm_per_s),
    ];
    let times = limited.into_iter().enumerate().filter_map(|(i, (axis, limit))| {
        let rate = axis.differentiate::<2>();
        Some(((i, rate.value() < 0.0), rate * (rate.value().signum() / limit?)))
    });
    times.max_by(|a, b| a.1.value().total_cmp(&b.1.value()))
}
