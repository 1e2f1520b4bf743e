//! Linkages of shaping, ready for queries.
//!
//! In: the kind of gear and of linkage, the pitch curve, the cutter's pitch radius r_c = m z0 / 2. Out: axis positions,
//! poses, and the polar angle that belongs to a work angle, each for any offset: infeed changes the offset from stroke
//! to stroke. The laws stand in [`crate::process::shaping::linkage::normal`] and
//! [`crate::process::shaping::linkage::traditional`].
//!
//! In a ring the cutter stands inside the pitch curve. The laws then hold with -r_c and -delta_d for r_c and delta_d:
//! the centre P + d n moves to the other side of the curve, S / r_c runs the other way, an offset draws the cutter
//! inwards. The published three-axis linkage ("Advanced Shaping Technology for Non-Circular Internal Gears", a text
//! without author and year) has the same centre distance a = |P - r_0 n|, but gives the work angle as phi - arg(o_1),
//! which is 0 on a circle (right is arg(o_1)), and loses the sign of the angle between normal and line of centres in an
//! arccos, which is wrong wherever r' > 0. The signed law has neither fault.
//!
//! Road not taken: a second set of laws for rings. Every formula would stand here twice, with signs to be kept apart.

use std::sync::Arc;

use super::axes::{Axes, CutterPose, PoseMotion};
use super::inverse::{Starts, solve};
use crate::process::shaping::linkage::{normal, traditional};
use crate::process::shaping::scene::model::{Linkage, NormalReading, TraditionalDirection};
use gearcut_core::error::Refusal;
use gearcut_core::gear::{GearKind, PitchCurve, Rolling};
use gearcut_core::math::Jet;

/// One linkage on one pitch curve with one cutter.
#[derive(Debug, Clone)]
pub struct ShapingLinkage {
    gear: GearKind,
    kind: Linkage,
    curve: Arc<PitchCurve>,
    cutter_pitch_radius_mm: f64,
    starts: Arc<Starts>,
    /// Offsets at which it is known to roll, mm.
    rolls_at_mm: [f64; 2],
}

impl ShapingLinkage {
    /// Linkage for offsets from 0 to `offset_mm` (the largest that will be used; inverse queries are fastest there).
    ///
    /// # Errors
    /// A pitch radius or offset that is not finite, r_c <= 0 or r_c + offset <= 0, or a curvature so sharp that the
    /// work would have to turn back: the cutter's pitch circle (with the offset) does not fit into a hollow of the
    /// curve, or into the ring.
    pub fn new(
        gear: GearKind,
        kind: Linkage,
        curve: Arc<PitchCurve>,
        cutter_pitch_radius_mm: f64,
        offset_mm: f64,
    ) -> Result<Self, Refusal> {
        if !(cutter_pitch_radius_mm.is_finite() && cutter_pitch_radius_mm > 0.0) {
            let problem = format!("the cutter's pitch radius would be {cutter_pitch_radius_mm} mm");
            return Err(Refusal::new("tool.shaper_cutter.teeth", problem, "give a positive number of teeth"));
        }
        let (starts, rolls_at_mm) = (Arc::new(Starts::none()), [f64::NAN; 2]);
        let mut linkage = Self { gear, kind, curve, cutter_pitch_radius_mm, starts, rolls_at_mm };
        linkage.check(0.0)?;
        linkage.rolls_at_mm = [0.0; 2];
        linkage.check(offset_mm)?;
        linkage.rolls_at_mm = [0.0, offset_mm];
        let lag = |phi: f64| {
            let rolling = Rolling::<1>::new(&linkage.curve, Jet::constant(phi));
            linkage.lag(&rolling, Jet::constant(offset_mm)).value()
        };
        let slope = |phi: f64| {
            let rolling = Rolling::<2>::new(&linkage.curve, Jet::variable(phi));
            linkage.lag(&rolling, Jet::constant(offset_mm)).derivative(1)
        };
        let starts = Starts::new([&lag, &slope], linkage.curve.samples_per_turn().clamp(1024, 1 << 16));
        linkage.starts = Arc::new(starts);
        Ok(linkage)
    }

    /// Refuses an offset at which the work angle does not increase with phi everywhere.
    pub(super) fn check(&self, offset_mm: f64) -> Result<(), Refusal> {
        if self.rolls_at_mm.contains(&offset_mm) {
            return Ok(());
        }
        let reach_mm = self.cutter_pitch_radius_mm + offset_mm;
        if !(reach_mm.is_finite() && reach_mm > 0.0) {
            let problem = format!("offset {offset_mm} mm brings the cutter axis to the pitch curve");
            return Err(Refusal::new("operation.offset_mm", problem, "give a smaller offset in magnitude"));
        }
        let facts = self.curve.facts();
        let samples = self.curve.samples_per_turn();
        let even = (0..samples).map(|i| gearcut_core::math::roots::sample_angle_rad(i, samples));
        let sharp = facts.curvature_extrema.iter().map(|e| e.phi_rad);
        for phi in even.chain(sharp) {
            let turn = self.work_angle_along::<2>(Jet::variable(phi), Jet::constant(offset_mm)).derivative(1);
            let curvature_per_mm = || self.curve.frame(phi).curvature_per_mm;
            // A circle larger than a ring would turn the work forwards again, from beyond its centre of curvature.
            let fits = self.gear == GearKind::External || self.cutter_pitch_radius_mm * curvature_per_mm() < 1.0;
            if (!fits || turn.is_nan() || turn <= 0.0) && !self.curve.carries(phi) {
                return Err(Refusal::new(
                    "gear.sector_deg",
                    format!(
                        "the bridge that closes the pitch curve over the dwell has a hollow of radius {:.3} mm at \
                        polar angle {:.3} deg; the cutter's pitch radius with the offset, {reach_mm:.3} mm, does not \
                        roll there",
                        -1.0 / curvature_per_mm(),
                        phi.to_degrees()
                    ),
                    "leave a wider dwell, let the radii at its ends differ less, or take a cutter with fewer teeth",
                ));
            }
            if !fits || turn.is_nan() || turn <= 0.0 {
                let way_out = match self.gear {
                    GearKind::External => {
                        "take a cutter with fewer teeth, a smaller offset, or a pitch curve with a wider hollow"
                    }
                    GearKind::Internal => {
                        "take a cutter with fewer teeth, a smaller offset, or a pitch curve with more room inside"
                    }
                };
                return Err(Refusal::new(
                    "tool.shaper_cutter.teeth",
                    format!(
                        "at polar angle {:.3} deg the pitch curve has the radius of curvature {:.3} mm; the cutter's \
                        pitch radius with the offset, {reach_mm:.3} mm, does not roll there",
                        phi.to_degrees(),
                        1.0 / curvature_per_mm()
                    ),
                    way_out,
                ));
            }
        }
        Ok(())
    }

    /// External gear or ring.
    pub fn gear(&self) -> GearKind {
        self.gear
    }

    /// The pitch curve.
    pub fn curve(&self) -> &Arc<PitchCurve> {
        &self.curve
    }

    /// The linkage in words.
    pub fn words(&self) -> &'static str {
        match self.kind {
            Linkage::ShapingNormal { reading: NormalReading::Corrected } => "normal linkage",
            Linkage::ShapingNormal { reading: NormalReading::AsPrinted } => "normal linkage, Eq. 12 as printed",
            Linkage::ShapingTraditional { direction: TraditionalDirection::CenterLine } => "traditional linkage",
            Linkage::ShapingTraditional { direction: TraditionalDirection::PolarRadius } => {
                "traditional linkage along the polar radius"
            }
        }
    }

    /// r_c, mm.
    pub fn cutter_pitch_radius_mm(&self) -> f64 {
        self.cutter_pitch_radius_mm
    }

    /// Axis positions at `phi_rad` (any real, unwrapped) with two derivatives with respect to phi, at constant offset.
    pub fn axes(&self, phi_rad: f64, offset_mm: f64) -> Axes<3> {
        self.axes_along(Jet::variable(phi_rad), Jet::constant(offset_mm))
    }

    /// Axis positions where phi and the offset are series in any parameter, for N <= 3 terms.
    pub fn axes_along<const N: usize>(&self, phi_rad: Jet<N>, offset_mm: Jet<N>) -> Axes<N> {
        let rolling = Rolling::new(&self.curve, phi_rad);
        let arc = rolling.arc(&self.curve);
        let (r_c, offset_mm) = self.signed(offset_mm);
        match self.kind {
            Linkage::ShapingNormal { reading } => normal::axes(&rolling, arc, r_c, offset_mm, reading),
            Linkage::ShapingTraditional { direction } => traditional::axes(&rolling, arc, r_c, offset_mm, direction),
        }
    }

    /// Work angle alone, as a series.
    pub(super) fn work_angle_along<const N: usize>(&self, phi_rad: Jet<N>, offset_mm: Jet<N>) -> Jet<N> {
        phi_rad - self.lag(&Rolling::new(&self.curve, phi_rad), offset_mm)
    }

    /// Cutter radius and offset along the outward normal of the pitch curve: both negative in a ring.
    fn signed<const N: usize>(&self, offset_mm: Jet<N>) -> (f64, Jet<N>) {
        let sign = self.gear.tip_sign();
        (sign * self.cutter_pitch_radius_mm, offset_mm * sign)
    }

    /// phi - psi_c.
    fn lag<const N: usize>(&self, rolling: &Rolling<N>, offset_mm: Jet<N>) -> Jet<N> {
        let (r_c, offset_mm) = self.signed(offset_mm);
        match self.kind {
            Linkage::ShapingNormal { .. } => normal::alpha(rolling, offset_mm + r_c),
            Linkage::ShapingTraditional { direction } => traditional::work_lag(rolling, r_c, offset_mm, direction),
        }
    }

    /// Pose of the cutter in the gear frame.
    pub fn pose(&self, phi_rad: f64, offset_mm: f64) -> CutterPose {
        self.axes_along::<1>(Jet::constant(phi_rad), Jet::constant(offset_mm)).pose(self.gear)
    }

    /// Pose with its derivative with respect to phi at constant offset.
    pub fn pose_motion(&self, phi_rad: f64, offset_mm: f64) -> PoseMotion {
        self.axes_along::<2>(Jet::variable(phi_rad), Jet::constant(offset_mm)).pose_motion(self.gear)
    }

    /// Polar angle (unwrapped) at which the work angle is `psi_c_rad` (any real), to rounding.
    pub fn phi_at_work_angle(&self, psi_c_rad: f64, offset_mm: f64) -> f64 {
        let offset = Jet::<1>::constant(offset_mm);
        let lag = |phi: f64| self.lag(&Rolling::new(&self.curve, Jet::constant(phi)), offset).value();
        solve(lag, psi_c_rad, self.starts.guess(psi_c_rad))
    }
}
