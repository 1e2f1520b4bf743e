//! Pitch curve of the gear that runs with a driver: r2 rolls on r1 at a fixed centre distance.
//!
//! In: the driver's closed curve r1(phi1), tooth numbers, and whether the mate is external or internal. Out: r2(phi2)
//! with three derivatives, and the centre distance a. Law (Litvin and Fuentes, *Noncircular Gears*, 2009, ch. 2): both
//! curves touch on the line of centres and pass equal arcs, r1 dphi1 = r2 dphi2, hence
//!
//! ```text
//! external: r2 = a - r1, phi2 runs against phi1        internal: r2 = a + r1, phi2 runs with phi1
//! closure:  integral over one turn of r1 / r2 dphi1 = 2 pi z1 / z2
//! ```
//!
//! The closure has one solution a, which is found; a rounded centre distance leaves a gap after the last tooth. The
//! curve's perimeter is then pi m z2 by itself. It closes smoothly only if the driver looks the same after z2 / z1 of
//! its turns.
//!
//! The mate's angle phi2 = 0 meets the driver's angle `start`. A tooth space is centred on zero of either gear, so
//! gears that run together need a start in the middle of a driver's tooth; the first one is taken unless another is
//! given.

use std::f64::consts::PI;

use super::{LARGEST_CLOSURE_ERROR_MODULES, PitchCurve};
use crate::error::Refusal;
use crate::gear::{Driver, GearKind};
use crate::math::Jet;
use crate::math::periodic_integral::PeriodicIntegral;
use crate::math::roots::bisect;
use crate::parameter;
use crate::units::TURN_RAD;

/// Accuracy of phi2(phi1), rad: 1e-12 mm on a radius of 100 mm.
const TURN_ACCURACY_RAD: f64 = 1e-14;

/// r2(phi2) of a mate.
#[derive(Debug, Clone)]
pub(super) struct MateLaw {
    driver: PitchCurve,
    kind: GearKind,
    center_distance_mm: f64,
    /// phi2 as an integral over phi1.
    turn: PeriodicIntegral,
    /// phi2 of the start.
    start_turn_rad: f64,
    /// Driver's turns per turn of the mate.
    turns: f64,
}

impl MateLaw {
    /// Mate with `teeth` teeth of `module_mm`.
    ///
    /// # Errors
    /// A driver that is refused by itself, an internal mate with no more teeth than its driver, a driver that does not
    /// close or does not look the same after the mate's turn.
    pub(super) fn new(
        driver: &Driver,
        kind: GearKind,
        module_mm: f64,
        teeth: u32,
        accuracy_mm: f64,
    ) -> Result<Self, Refusal> {
        let curve =
            PitchCurve::with_accuracy(&driver.curve, module_mm, driver.teeth, accuracy_mm).map_err(|mut e| {
                // The module is the mate's own.
                e.key = match e.key.as_str() {
                    parameter::MODULE => parameter::MATE_DRIVER_TEETH.to_owned(),
                    of_curve => format!("{}{of_curve}", parameter::OF_DRIVER),
                };
                e
            })?;
        let turns = f64::from(teeth) / f64::from(driver.teeth);
        if kind == GearKind::Internal && turns <= 1.0 {
            return Err(Refusal::new(
                parameter::MATE_DRIVER_TEETH,
                format!("an internal gear with {teeth} teeth has no room for a driver with {}", driver.teeth),
                "give the driver fewer teeth than the internal gear",
            ));
        }
        let gap_mm = turns * curve.closure_error_mm();
        if gap_mm.abs() > LARGEST_CLOSURE_ERROR_MODULES * module_mm {
            return Err(Refusal::new(
                parameter::MATE_DRIVER,
                format!("the driver does not close: its mate would be {gap_mm:.6} mm too long"),
                "leave the driver's size out, and it is solved",
            ));
        }
        if !curve.repeats_after(turns * TURN_RAD) {
            return Err(Refusal::new(
                parameter::MATE_DRIVER_TEETH,
                format!(
                    "one turn of the mate is {turns:.6} turns of its driver, after which the driver looks different: \
                    the mate's curve does not close"
                ),
                "choose tooth numbers whose quotient is a whole number of the driver's repeats in one turn",
            ));
        }
        let sign = kind.tip_sign();
        let turn_at = |center_mm: f64| {
            let rate = |phi: f64| {
                let r = curve.radius(phi).value();
                r / (center_mm - sign * r)
            };
            PeriodicIntegral::new(rate, &curve.breaks_rad(), 16, TURN_ACCURACY_RAD)
        };
        let wanted_rad = TURN_RAD / turns;
        // The turn of the mate falls with the centre distance; equal circles bound it on both sides.
        let facts = curve.facts();
        let circle = |r: f64| r * (turns + sign);
        let [near_mm, far_mm] = [circle(facts.smallest_radius_mm), circle(facts.largest_radius_mm)];
        let low_mm = if sign > 0.0 { near_mm.max(facts.largest_radius_mm) } else { near_mm };
        // Nearer than the driver's largest radius the law has no integral: the mate would turn without end.
        let long = |center_mm: f64| turn_at(center_mm).map_or(true, |turn| turn.closed() > wanted_rad);
        let center_distance_mm = bisect(long, low_mm * (1.0 - 1e-12), far_mm * (1.0 + 1e-12));
        let turn = turn_at(center_distance_mm).map_err(|why| {
            Refusal::new(
                parameter::MATE,
                format!("the mate's angle cannot be integrated over the driver's: {why}"),
                "make the variation of the driver's radius smaller",
            )
        })?;
        let start_rad = driver.start_rad.unwrap_or_else(|| curve.phi_at_arc(0.5 * PI * module_mm));
        let start_turn_rad = turn.at(start_rad);
        Ok(Self { driver: curve, kind, center_distance_mm, turn, start_turn_rad, turns })
    }

    /// Distance of the axes, mm.
    pub(super) fn center_distance_mm(&self) -> f64 {
        self.center_distance_mm
    }

    /// Polar angle of the driver in contact at the mate's `phi_rad`; both unwrapped.
    fn driver_angle_rad(&self, phi_rad: f64) -> f64 {
        self.turn.angle_at(self.start_turn_rad - self.kind.tip_sign() * phi_rad)
    }

    /// r2 / a at `phi_rad` with its derivatives with respect to phi2.
    pub(super) fn unit(&self, phi_rad: f64) -> Jet<4> {
        let sign = self.kind.tip_sign();
        let driver_rad = self.driver_angle_rad(phi_rad);
        let driver = self.driver.radius(driver_rad);
        let radius = driver * -sign + self.center_distance_mm;
        // dphi1/dphi2 = -+ r2 / r1: each round makes one more term of phi1(phi2) exact.
        let rate = radius / driver * -sign;
        let mut angle = Jet::<4>::constant(driver_rad);
        for _ in 0..3 {
            angle = rate.compose(&angle).truncate::<3>().integrate::<4>(driver_rad);
        }
        radius.compose(&angle) * (1.0 / self.center_distance_mm)
    }

    /// Angles of the mate where the driver's third derivative jumps.
    pub(super) fn breaks_rad(&self) -> Vec<f64> {
        let driver_breaks = self.driver.breaks_rad();
        let mut breaks: Vec<f64> = (0..self.turns.ceil() as u32)
            .flat_map(|turn| driver_breaks.iter().map(move |b| b + TURN_RAD * f64::from(turn)))
            .filter(|b| *b < self.turns * TURN_RAD)
            .map(|b| (self.kind.tip_sign() * (self.start_turn_rad - self.turn.at(b))).rem_euclid(TURN_RAD))
            .collect();
        breaks.sort_by(f64::total_cmp);
        breaks
    }

    /// Samples that resolve the curve: the driver's for each of its turns, twice where the mate is a ring.
    pub(super) fn samples_per_turn(&self) -> usize {
        (2.0 * self.turns * self.driver.samples_per_turn() as f64).ceil() as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::PitchCurveShape;

    fn sinusoidal(order: u32) -> PitchCurveShape {
        PitchCurveShape::SinusoidalRatio { order, mean_ratio: 1.2, ratio_amplitude: 0.2, center_distance_mm: None }
    }

    fn mate(curve: PitchCurveShape, driver_teeth: u32, kind: GearKind, teeth: u32) -> Result<PitchCurve, Refusal> {
        let driver = Box::new(Driver { curve, teeth: driver_teeth, start_rad: None });
        PitchCurve::new(&PitchCurveShape::Mate { driver, kind }, 2.0, teeth)
    }

    /// Gears that roll on each other: points of both curves meet on the line of centres after equal arcs.
    #[test]
    fn a_mate_rolls_on_its_driver() {
        for (kind, teeth) in [(GearKind::External, 34), (GearKind::External, 51), (GearKind::Internal, 102)] {
            let order = if teeth == 51 { 2 } else { 1 };
            let driver = PitchCurve::new(&sinusoidal(order), 2.0, 34).unwrap();
            let curve = mate(sinusoidal(order), 34, kind, teeth).unwrap();
            assert!(curve.closure_error_mm().abs() < 1e-9, "{kind:?} closes to {} mm", curve.closure_error_mm());
            let sign = kind.tip_sign();
            for i in 0..50 {
                let phi = 0.37 * f64::from(i) - 4.0;
                let arc = PI - sign * curve.arc_mm(phi);
                let r1 = driver.radius(driver.phi_at_arc(arc)).value();
                let gap = curve.radius(phi).value() - (curve.size_mm() - sign * r1);
                assert!(gap.abs() < 1e-9, "{kind:?}: {gap:.2e} mm at {phi}");
            }
        }
    }

    /// Circles: a = m (z2 -+ z1) / 2 and r2 = m z2 / 2.
    #[test]
    fn a_circle_has_a_circle_for_its_mate() {
        for (kind, center_mm) in [(GearKind::External, 74.0), (GearKind::Internal, 34.0)] {
            let curve = mate(PitchCurveShape::Circle, 20, kind, 54).unwrap();
            assert!((curve.size_mm() - center_mm).abs() < 1e-11, "{kind:?}: {}", curve.size_mm());
            assert!((curve.radius(1.0).value() - 54.0).abs() < 1e-11);
            assert!(curve.facts().curvature_extrema.is_empty() && curve.facts().convex);
        }
    }

    #[test]
    fn refusals_name_their_key() {
        let open = mate(sinusoidal(1), 34, GearKind::External, 51).unwrap_err();
        assert_eq!(open.key, parameter::MATE_DRIVER_TEETH);
        let full = mate(sinusoidal(1), 34, GearKind::Internal, 34).unwrap_err();
        assert!(full.problem.contains("no room"), "{}", full.problem);
        let ellipse = PitchCurveShape::Ellipse { order: 1, eccentricity: 1.5, semi_major_axis_mm: None };
        assert_eq!(mate(ellipse, 34, GearKind::Internal, 102).unwrap_err().key, "driver's eccentricity of the ellipse");
    }
}
