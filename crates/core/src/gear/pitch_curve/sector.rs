//! Pitch curve of a sector: a law over a part of the turn, and a bridge over the rest that closes it.
//!
//! In: the law u(phi) from one polar angle to another, the number of pitches on that range. Out: a closed radius law,
//! and the number of pitches of the whole turn. Everything that rests on a closed curve (arc lengths, linkages,
//! strokes) so holds for a sector as well. On the range the law is u itself, to the last bit.
//!
//! The bridge is what a cutter rolls on before the first tooth and behind the last one; no tooth is there. It is an arc
//! of a radius R with a transition at either end, x being the angle from that end, u' and so on the law's derivatives
//! there:
//!
//! ```text
//! R + (u - R) w(x / L) + (u' x + u'' x^2 / 2 + u''' x^3 / 6) w(x / l)
//! w(t) = 1 - 35 t^4 + 84 t^5 - 70 t^6 + 20 t^7
//! ```
//!
//! w falls from 1 to 0 with three derivatives that vanish at both ends, so the closed curve has three continuous
//! derivatives; through points it has two, like their spline, and u''' is taken as 0. L is 2 rad, l is 1 rad, or half
//! the bridge where that is less. R is solved so that the bridge is a whole number of pitches long, the one nearest to
//! what the mean of both ends gives: of a circle it is the same circle.
//!
//! Road not taken: one polynomial through both ends. Over a bridge of 200 deg the third derivative of an oval throws it
//! far off; and the law itself beyond its range, which may be no number there.

use std::f64::consts::PI;
use std::fmt::Debug;
use std::sync::Arc;

use super::formula_law::highest_harmonic;
use crate::error::Refusal;
use crate::math::Jet;
use crate::math::periodic_integral::{NotIntegrable, PeriodicIntegral};
use crate::parameter;
use crate::units::TURN_RAD;

/// Longest transitions of the radius and of its derivatives, rad.
const TRANSITIONS_RAD: [f64; 2] = [2.0, 1.0];
/// A bridge spans this angle at least, rad: less holds no cutter.
const LEAST_BRIDGE_RAD: f64 = PI / 9.0;
/// Angles at which the closed law is looked at: a prime, so that no usual multiple of phi is the same at all of them.
const ANGLES: usize = 1021;
/// Samples of the curvature over the shorter transition.
const SAMPLES_PER_TRANSITION: f64 = 64.0;
/// Steps to the bridge's radius, and what may be missing of a pitch.
const CLOSING_STEPS: u32 = 30;
const CLOSING_SHARE: f64 = 1e-13;

/// A radius law of unit size.
pub(super) trait UnitLaw: Debug + Send + Sync {
    /// Unit radius at `phi_rad` with its derivatives with respect to phi.
    fn unit(&self, phi_rad: f64) -> Jet<4>;
    /// Angles in (0, 2 pi) where the third derivative jumps.
    fn breaks_rad(&self) -> Vec<f64>;
    /// Number of samples per turn between which the curvature has no two sign changes of itself or its slope.
    fn samples_per_turn(&self) -> usize;
}

/// Closed radius law of a sector.
#[derive(Debug, Clone)]
pub(super) struct SectorLaw {
    law: Arc<dyn UnitLaw>,
    range_rad: [f64; 2],
    /// Taylor coefficients of the law at both ends, the angle counted outwards.
    ends: [[f64; 4]; 2],
    bridge_radius: f64,
    pitches: u32,
    harmonics: f64,
}

impl SectorLaw {
    /// Closes a law that carries `teeth` pitches over a range of polar angle.
    ///
    /// # Errors
    /// A bridge that does not close.
    pub(super) fn new(law: Arc<dyn UnitLaw>, range_rad: [f64; 2], teeth: u32, key: &str) -> Result<Self, Refusal> {
        // Where the third derivative jumps from point to point, the last one says nothing of what is beyond.
        let is_spline = !law.breaks_rad().is_empty();
        let end = |at: usize| {
            let outwards = if at == 0 { -1.0_f64 } else { 1.0 };
            let mut taylor = *law.unit(range_rad[at]).taylor();
            if is_spline {
                taylor[3] = 0.0;
            }
            std::array::from_fn(|k| taylor[k] * outwards.powi(k as i32))
        };
        let ends: [[f64; 4]; 2] = [end(0), end(1)];
        let bridge_radius = 0.5 * (ends[0][0] + ends[1][0]);
        let mut sector = Self { law, range_rad, ends, bridge_radius, pitches: 0, harmonics: 1.0 };
        sector.close(teeth, key)?;
        let radii: Vec<f64> = (0..ANGLES).map(|i| sector.unit(TURN_RAD * i as f64 / ANGLES as f64).value()).collect();
        if radii.iter().any(|radius| radius.is_nan() || *radius <= 0.0) {
            return Err(no_bridge("its radius passes zero"));
        }
        sector.harmonics = highest_harmonic(&radii) as f64;
        Ok(sector)
    }

    /// Solves the bridge's radius.
    fn close(&mut self, teeth: u32, key: &str) -> Result<(), Refusal> {
        let lengths = |sector: &Self| {
            let rate = |phi: f64| {
                let r = sector.unit(phi);
                r.value().hypot(r.derivative(1))
            };
            let accuracy = 1e-14 * sector.bridge_radius.abs().max(f64::MIN_POSITIVE);
            PeriodicIntegral::new(rate, &sector.breaks_rad(), 16, accuracy.max(1e-14)).map(|arc| {
                let [from, to] = sector.range_rad.map(|phi| arc.at(phi));
                [to - from, arc.closed() - (to - from)]
            })
        };
        let refused = |why: NotIntegrable| {
            let problem = format!("the arc length cannot be integrated: {why}");
            Refusal::new(key, problem, "make the variation of the radius smaller, or give fewer points")
        };
        let [sector_length, bridge] = lengths(self).map_err(refused)?;
        let pitch = sector_length / f64::from(teeth);
        let on_bridge = (bridge / pitch).round().max(1.0);
        if on_bridge.is_nan() || on_bridge >= f64::from(u32::MAX / 2) {
            return Err(no_bridge("it has no length"));
        }
        let missing = |length: f64| on_bridge * pitch - length;
        // The length of an arc is its radius times its angle, to begin with.
        let (mut miss, mut rate) = (missing(bridge), TURN_RAD - (self.range_rad[1] - self.range_rad[0]));
        for _ in 0..CLOSING_STEPS {
            if miss.abs() <= CLOSING_SHARE * pitch {
                break;
            }
            let step = miss / rate;
            self.bridge_radius += step;
            let next = missing(lengths(self).map_err(|_| no_bridge("its length is not known"))?[1]);
            if next == miss {
                break;
            }
            rate = (miss - next) / step;
            miss = next;
        }
        if !(miss.abs() <= 1e-9 * pitch && self.bridge_radius > 0.0) {
            return Err(no_bridge("no radius makes it a whole number of pitches long"));
        }
        self.pitches = teeth + on_bridge as u32;
        Ok(())
    }

    /// Pitches of the whole turn.
    pub(super) fn pitches(&self) -> u32 {
        self.pitches
    }

    /// First and last polar angle of the range, rad.
    pub(super) fn range_rad(&self) -> [f64; 2] {
        self.range_rad
    }

    /// Unit radius with its derivatives.
    pub(super) fn unit(&self, phi_rad: f64) -> Jet<4> {
        let [from, to] = self.range_rad;
        let beyond = (phi_rad - from).rem_euclid(TURN_RAD);
        if beyond <= to - from {
            return self.law.unit(from + beyond);
        }
        let [behind, before] = [beyond - (to - from), TURN_RAD - beyond];
        let end = |[u, du, ddu, dddu]: [f64; 4], x: Jet<4>| {
            let [long, short] = self.transitions_rad().map(|length| falling(x * (1.0 / length)));
            long * (u - self.bridge_radius) + (((x * dddu + ddu) * x + du) * x) * short
        };
        end(self.ends[1], Jet::linear(behind, 1.0)) + end(self.ends[0], Jet::linear(before, -1.0)) + self.bridge_radius
    }

    fn transitions_rad(&self) -> [f64; 2] {
        let half = 0.5 * (TURN_RAD - (self.range_rad[1] - self.range_rad[0]));
        TRANSITIONS_RAD.map(|longest| longest.min(half))
    }

    /// Where the law changes, and where its own third derivative jumps; in [0, 2 pi).
    pub(super) fn breaks_rad(&self) -> Vec<f64> {
        let [from, to] = self.range_rad;
        let changes = self.transitions_rad().into_iter().flat_map(|length| [from - length, to + length]);
        let own = self.law.breaks_rad().into_iter();
        let own = own.filter(|phi| (phi - from).rem_euclid(TURN_RAD) < to - from);
        let mut breaks: Vec<f64> = changes.chain([from, to]).chain(own).map(|phi| phi.rem_euclid(TURN_RAD)).collect();
        breaks.sort_by(f64::total_cmp);
        breaks
    }

    /// Samples that resolve the law and its bridge.
    pub(super) fn samples_per_turn(&self) -> usize {
        let of_bridge = (SAMPLES_PER_TRANSITION * TURN_RAD / self.transitions_rad()[1]).ceil() as usize;
        let of_law = (128.0 * self.harmonics).ceil() as usize;
        self.law.samples_per_turn().max(of_bridge).max(of_law)
    }
}

/// w(t) of a jet.
fn falling(t: Jet<4>) -> Jet<4> {
    if t.value() >= 1.0 {
        return Jet::constant(0.0);
    }
    let square = t * t;
    (((t * 20.0 + -70.0) * t + 84.0) * t + -35.0) * (square * square) + 1.0
}

/// Refuses a range that does not rise or leaves no room for a bridge.
pub(super) fn check_range([from, to]: [f64; 2]) -> Result<(), Refusal> {
    let [from_deg, to_deg] = [from.to_degrees(), to.to_degrees()];
    let most_deg = (TURN_RAD - LEAST_BRIDGE_RAD).to_degrees();
    if from.is_finite() && to.is_finite() && to > from && to - from <= TURN_RAD - LEAST_BRIDGE_RAD + 1e-12 {
        return Ok(());
    }
    let problem = if to > from {
        format!(
            "from {from_deg} to {to_deg} deg are {:.3} deg; at most {most_deg:.0} deg are a sector",
            to_deg - from_deg
        )
    } else {
        format!("the sector ends at {to_deg} deg, not beyond its beginning at {from_deg} deg")
    };
    let way_out = "give two angles that rise and leave 20 deg or more for the dwell, or none for teeth all round";
    Err(Refusal::new(parameter::SECTOR, problem, way_out))
}

fn no_bridge(why: &str) -> Refusal {
    Refusal::new(
        parameter::SECTOR,
        format!("the pitch curve cannot be closed over the dwell: {why}"),
        "leave a wider dwell between the ends of the sector, or let its radii differ less",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::pitch_curve::examples::by_formula;
    use crate::gear::{FormulaMeaning, PitchCurve, PitchCurveShape};

    fn sector(shape: PitchCurveShape, range_deg: [f64; 2], teeth: u32) -> Result<PitchCurve, Refusal> {
        let shape = PitchCurveShape::Sector { law: Box::new(shape), range_rad: range_deg.map(f64::to_radians) };
        PitchCurve::new(&shape, 3.0, teeth)
    }

    /// r = a e^(k phi) has the arc sqrt(1 + k^2) (r2 - r1) / k, and the curvature 1 / (r sqrt(1 + k^2)): the size that
    /// carries 12 teeth follows, and every place of the sector.
    #[test]
    fn a_logarithmic_spiral_has_its_closed_form() {
        let (k, teeth) = (0.25_f64, 12);
        let [from, to] = [-1.0, 1.0_f64];
        let spiral = || by_formula(FormulaMeaning::Radius, "exp(0.25*phi)");
        let curve = sector(spiral(), [from.to_degrees(), to.to_degrees()], teeth).unwrap();
        let stretch = (1.0 + k * k).sqrt();
        let a = PI * 3.0 * f64::from(teeth) * k / (stretch * ((k * to).exp() - (k * from).exp()));
        assert!((curve.size_mm() - a).abs() < 1e-10, "{} for {a}", curve.size_mm());
        for i in 0..=200 {
            let phi = from + (to - from) * f64::from(i) / 200.0;
            let r = a * (k * phi).exp();
            let frame = curve.frame(phi);
            assert!((frame.radius_mm - r).abs() < 1e-10);
            assert!((frame.curvature_per_mm * r * stretch - 1.0).abs() < 1e-10);
            let arc = stretch / k * (r - a * (k * from).exp());
            assert!((curve.arc_mm(phi) - arc).abs() < 1e-9, "{} for {arc} at {phi}", curve.arc_mm(phi));
        }
        assert!((curve.perimeter_mm() - PI * 3.0 * f64::from(curve.pitches())).abs() < 1e-9);
    }

    /// The bridge has the law's value and three derivatives at both ends, and all of its own everywhere else.
    #[test]
    fn the_bridge_is_smooth() {
        for range_deg in [[-60.0, 60.0], [10.0, 250.0], [0.0, 330.0]] {
            let curve = sector(by_formula(FormulaMeaning::Radius, "exp(0.1*phi)"), range_deg, 12).unwrap();
            for i in 0..4000 {
                let phi = TURN_RAD * f64::from(i) / 4000.0;
                let step = 1e-5;
                let [a, b] = [curve.radius(phi), curve.radius(phi + step)];
                for order in 0..3 {
                    let slope = (b.derivative(order) - a.derivative(order)) / step;
                    let mean = 0.5 * (a.derivative(order + 1) + b.derivative(order + 1));
                    let scale = curve.size_mm() * 40.0_f64.powi(order as i32);
                    assert!((slope - mean).abs() < 1e-4 * scale, "{range_deg:?}, {order}: {slope} for {mean} at {phi}");
                }
            }
        }
    }

    /// A part of a circle is closed by the rest of it, with the pitches of the whole.
    #[test]
    fn the_bridge_of_a_circle_is_the_circle() {
        let curve = sector(PitchCurveShape::Circle, [30.0, 180.0], 10).unwrap();
        assert_eq!(curve.pitches(), 24);
        for i in 0..100 {
            assert!((curve.radius(0.1 * f64::from(i)).value() - 36.0).abs() < 1e-11);
        }
        assert!(curve.arc_mm(30_f64.to_radians()).abs() < 1e-11, "arcs count from the beginning of the sector");
    }

    #[test]
    fn what_is_no_sector_is_refused() {
        let circle = |range_deg| sector(PitchCurveShape::Circle, range_deg, 10).unwrap_err();
        assert_eq!(circle([30.0, 30.0]).key, parameter::SECTOR);
        assert!(circle([0.0, 345.0]).problem.contains("340"), "{}", circle([0.0, 345.0]).problem);
        let zero = by_formula(FormulaMeaning::Radius, "1 - phi");
        let refusal = sector(zero, [0.0, 90.0], 10).unwrap_err();
        assert!(refusal.problem.contains("passes zero at 57.29"), "{}", refusal.problem);
        // Beyond the sector a law may be what it likes.
        assert!(sector(by_formula(FormulaMeaning::Radius, "sqrt(2 - phi)"), [0.0, 80.0], 10).is_ok());
    }
}
