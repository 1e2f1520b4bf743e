//! Radius laws that a formula of phi gives: the radius itself, or the ratio of a pair.
//!
//! In: the formula and what it means. Out: the unit radius with three derivatives, or the angle at which there is none.
//! Law, with i the angular speed of this gear over that of its mate (Litvin and Fuentes, *Noncircular Gears*, 2009,
//! ch. 2): outside r + r_2 = C and r_2 = i r give r = C / (1 + i); in a ring r - r_2 = C and r_2 = i r give
//! r = C / (1 - i), with i below 1.
//!
//! A formula may be anything; that it is positive, smooth and the same after a turn is looked at on many angles. How
//! fast it varies is read from its harmonics, which a reader of formulas cannot know.

use crate::error::Refusal;
use crate::gear::{FormulaMeaning, GearKind};
use crate::math::Jet;
use crate::math::formula::Formula;
use crate::math::roots::bisect;
use crate::parameter;
use crate::units::TURN_RAD;
use glam::DVec2;

/// Angles at which a formula is looked at: a prime, so that no usual multiple of phi is the same at all of them.
const ANGLES: usize = 4099;
/// Highest harmonic that is taken: one more and teeth are no longer what varies fastest.
const HIGHEST_HARMONIC: usize = 256;
/// A harmonic j counts whose amplitude times j^2 is more than this share of the mean: it moves curvatures by that.
const COUNTING_SHARE: f64 = 1e-3;
/// Value and derivatives at the end of the turn are those at its beginning within this share of their largest.
const CLOSING: f64 = 1e-9;

/// Unit radius by a formula.
#[derive(Debug, Clone)]
pub(super) struct FormulaLaw {
    formula: Formula,
    meaning: FormulaMeaning,
    /// Where the turn begins over which the formula is taken, rad.
    start_rad: f64,
    /// Highest harmonic of the radius that counts.
    pub(super) harmonics: f64,
}

impl FormulaLaw {
    /// # Errors
    /// A radius or a ratio that passes zero, is no number or does not come back after a turn, with the angle. Of a
    /// sector, its range alone is looked at.
    pub(super) fn new(formula: &Formula, meaning: FormulaMeaning, sector: Option<[f64; 2]>) -> Result<Self, Refusal> {
        let [start_rad, end_rad] = sector.unwrap_or([0.0, TURN_RAD]);
        let law = Self { formula: formula.clone(), meaning, start_rad, harmonics: 1.0 };
        let key = match meaning {
            FormulaMeaning::Radius => parameter::RADIUS_FORMULA,
            FormulaMeaning::Ratio(_) => parameter::RATIO_FORMULA,
        };
        let angle = |i: usize| start_rad + (end_rad - start_rad) * i as f64 / ANGLES as f64;
        // The end of a turn is its beginning; that of a sector is looked at.
        if let Some(i) = (0..ANGLES + usize::from(sector.is_some())).find(|&i| law.fault(angle(i)).is_some()) {
            let before = if i == 0 { start_rad } else { angle(i - 1) };
            let phi = bisect(|phi| law.fault(phi).is_none(), before, angle(i));
            let fault = law.fault(angle(i)).unwrap_or_default();
            let problem = format!("`{}` {fault} at {:.3} deg", formula.text(), phi.to_degrees());
            return Err(Refusal::new(key, problem, law.way_out()));
        }
        if sector.is_some() {
            return Ok(law);
        }
        let [start, end] = [0.0, TURN_RAD].map(|phi| formula.at::<4>(phi));
        let opens = |k: usize| {
            let of = |i: usize| formula.at::<4>(angle(i)).derivative(k).abs();
            (end.derivative(k) - start.derivative(k)).abs() > CLOSING * (0..ANGLES).map(of).fold(1.0, f64::max)
        };
        if let Some(k) = (0..4).find(|&k| opens(k)) {
            let what = ["", "the slope of ", "the second derivative of ", "the third derivative of "][k];
            let problem = format!(
                "{what}`{}` is {:.6} at 0 deg and {:.6} at 360 deg: the curve does not close smoothly",
                formula.text(),
                start.derivative(k),
                end.derivative(k)
            );
            return Err(Refusal::new(key, problem, "use whole multiples of phi, such as sin(2*phi)"));
        }
        let radii: Vec<f64> = (0..ANGLES).map(|i| law.unit(angle(i)).value()).collect();
        let highest = highest_harmonic(&radii);
        if highest > HIGHEST_HARMONIC {
            let problem = format!("`{}` varies with the harmonic {highest}", formula.text());
            let way_out = format!("up to {HIGHEST_HARMONIC} are taken: use smaller multiples of phi");
            return Err(Refusal::new(key, problem, way_out));
        }
        Ok(Self { harmonics: highest as f64, ..law })
    }

    /// Unit radius with its derivatives.
    pub(super) fn unit(&self, phi_rad: f64) -> Jet<4> {
        let value = self.formula.at(self.start_rad + (phi_rad - self.start_rad).rem_euclid(TURN_RAD));
        match self.meaning {
            FormulaMeaning::Radius => value,
            FormulaMeaning::Ratio(kind) => (value * kind.tip_sign() + 1.0).recip(),
        }
    }

    /// Why there is no radius at an angle.
    fn fault(&self, phi_rad: f64) -> Option<&'static str> {
        let value = self.formula.at::<4>(phi_rad);
        if !value.taylor().iter().all(|c| c.is_finite()) {
            return Some("is no number or has no derivative");
        }
        match self.meaning {
            _ if value.value() <= 0.0 => Some("passes zero"),
            FormulaMeaning::Ratio(GearKind::Internal) if value.value() >= 1.0 => Some("reaches 1"),
            _ => None,
        }
    }

    fn way_out(&self) -> &'static str {
        match self.meaning {
            FormulaMeaning::Radius => "keep the radius above zero everywhere",
            FormulaMeaning::Ratio(GearKind::External) => {
                "keep the ratio above zero everywhere: the mate would stop or turn back"
            }
            FormulaMeaning::Ratio(GearKind::Internal) => {
                "keep the ratio of a ring between 0 and 1 everywhere: it turns more slowly than the gear inside it"
            }
        }
    }
}

/// Number of the highest harmonic that counts, by Fourier sums over evenly spaced values.
pub(super) fn highest_harmonic(values: &[f64]) -> usize {
    let count = values.len();
    let waves: Vec<DVec2> =
        (0..count).map(|i| DVec2::from_angle(TURN_RAD * i as f64 / count as f64) * (2.0 / count as f64)).collect();
    let mean = values.iter().sum::<f64>() / count as f64;
    let counts = |j: &usize| {
        let sum: DVec2 = values.iter().enumerate().map(|(i, value)| waves[i * j % count] * (value - mean)).sum();
        sum.length() * (j * j) as f64 > COUNTING_SHARE * mean
    };
    (1..count / 3).rev().find(counts).unwrap_or(1)
}
