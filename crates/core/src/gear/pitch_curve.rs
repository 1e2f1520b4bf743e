//! The pitch curve: the closed curve on which the teeth are rolled.
//!
//! In: the scene's shape, module and number of teeth. Out: radius, frame, curvature and arc length at any polar angle,
//! the inverse of the arc length, and facts about the shape. Frame: the gear frame, phi counter-clockwise, t in the
//! direction of increasing phi, outward normal n = -i t.
//!
//! Law: ds/dphi = sqrt(r^2 + r'^2); z teeth of module m fit without a remainder when the perimeter is pi m z. The
//! perimeter is proportional to the size of the curve, so a size that is left out follows from one quadrature.
//!
//! A curve r(phi) > 0 with one radius per angle cannot cross itself; positive radii are therefore all that is checked
//! against crossing. Road not taken: curves given as points x, y. They can loop, and the polar angle is what every
//! linkage formula in the literature is written in.

#[cfg(test)]
pub(crate) mod examples;
mod facts;
mod formula_law;
pub mod mate;
mod radius_law;
pub mod sector;
pub mod shape;
#[cfg(test)]
mod tests;

use std::f64::consts::PI;

use glam::DVec2;

use crate::error::Refusal;
use crate::gear::{LARGEST_UNASKED_SCALING, PitchCurveShape, TableScaling};
use crate::math::jet::Jet;
use crate::math::periodic_integral::PeriodicIntegral;
use crate::math::roots::sample_angle_rad;
use crate::parameter;
use crate::units::TURN_RAD;
pub use facts::{CurvatureExtremum, CurveFacts};
use radius_law::{RadiusLaw, SizedLaw};
use sector::UnitLaw;

/// Accuracy of the arc length unless asked otherwise, mm.
pub const DEFAULT_ACCURACY_MM: f64 = 1e-10;
/// Largest difference between perimeter and pi m z that is accepted, in modules.
pub const LARGEST_CLOSURE_ERROR_MODULES: f64 = 0.01;
/// A curve repeats when its radii do to this share: 0.1 nm on a radius of 100 mm.
const REPEAT_TOLERANCE: f64 = 1e-9;

/// A closed pitch curve, ready for queries.
#[derive(Debug, Clone)]
pub struct PitchCurve {
    law: RadiusLaw,
    size_mm: f64,
    arc: PeriodicIntegral,
    closure_error_mm: f64,
    /// Arc from phi = 0 to the beginning of a sector; 0 of a closed curve.
    origin_mm: f64,
    pitches: u32,
    scaling: Option<f64>,
    facts: CurveFacts,
}

/// Everything local about the pitch curve at one polar angle; gear frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PitchFrame {
    /// P(phi), mm.
    pub point_mm: DVec2,
    /// Unit tangent in the direction of increasing phi.
    pub tangent: DVec2,
    /// Unit normal out of the gear, -i t.
    pub normal: DVec2,
    /// Angle from the polar radius to the tangent, atan2(r, r'), in (0, pi). The plain arctan(r / r') of the papers
    /// fails where r' < 0.
    pub mu_rad: f64,
    /// ds/dphi, mm per rad.
    pub arc_rate_mm_per_rad: f64,
    /// Signed curvature, positive convex.
    pub curvature_per_mm: f64,
    /// r(phi), mm.
    pub radius_mm: f64,
}

impl PitchCurve {
    /// Pitch curve with arc lengths good to [`DEFAULT_ACCURACY_MM`].
    ///
    /// # Errors
    /// Parameters outside their range, a radius that is not positive everywhere, a table out of order or one whose
    /// radii would be scaled by more than [`LARGEST_UNASKED_SCALING`] unasked, or a given size whose perimeter misses
    /// pi m z by more than [`LARGEST_CLOSURE_ERROR_MODULES`]; the refusal says which size closes.
    pub fn new(shape: &PitchCurveShape, module_mm: f64, teeth: u32) -> Result<Self, Refusal> {
        Self::with_accuracy(shape, module_mm, teeth, DEFAULT_ACCURACY_MM)
    }

    /// Pitch curve with arc lengths good to `accuracy_mm` (1e-12 is the practical floor of f64 at gear size).
    ///
    /// # Errors
    /// As [`Self::new`]; and an arc length that cannot be integrated to the accuracy.
    pub fn with_accuracy(
        shape: &PitchCurveShape,
        module_mm: f64,
        teeth: u32,
        accuracy_mm: f64,
    ) -> Result<Self, Refusal> {
        let toothed_mm = PI * module_mm * f64::from(teeth);
        if !(toothed_mm.is_finite() && toothed_mm > 0.0) {
            let problem = format!("module {module_mm} mm with {teeth} teeth gives no pitch curve");
            return Err(Refusal::new(parameter::MODULE, problem, "give a positive module and at least one tooth"));
        }
        let SizedLaw { law, size_mm, key, size_key } = SizedLaw::new(shape, module_mm, teeth, accuracy_mm)?;
        let (sector_rad, pitches) = match &law {
            RadiusLaw::Sector(sector) => (Some(sector.range_rad()), sector.pitches()),
            _ => (None, teeth),
        };
        let wanted_mm = PI * module_mm * f64::from(pitches);
        let samples = law.samples_per_turn();
        let facts = CurveFacts::new(|phi| law.unit(phi), samples, sector_rad);
        let (smallest, largest) = (facts.smallest_radius_mm, facts.largest_radius_mm);
        if !(smallest > 0.0 && largest.is_finite()) {
            let problem = format!("the radius falls to {smallest} of its mean: it must stay positive and finite");
            return Err(Refusal::new(key, problem, "make the variation of the radius smaller"));
        }
        let arc_rate = |scale: f64| {
            let law = &law;
            move |phi: f64| {
                let r = law.unit(phi);
                scale * r.value().hypot(r.derivative(1))
            }
        };
        let integrate = |size_mm: f64| {
            PeriodicIntegral::new(arc_rate(size_mm), &law.breaks_rad(), 16, accuracy_mm.max(1e-13)).map_err(|why| {
                let problem = format!("the arc length cannot be integrated to {accuracy_mm} mm: {why}");
                Refusal::new(key, problem, "make the variation of the radius smaller, or give fewer points")
            })
        };
        let assumed_mm = size_mm.unwrap_or(wanted_mm / (2.0 * PI));
        let first = integrate(assumed_mm)?;
        let closing_mm = assumed_mm * wanted_mm / first.closed();
        let (size_mm, arc) = match size_mm {
            Some(given_mm) => (given_mm, first),
            None => (closing_mm, integrate(closing_mm)?),
        };
        let closure_error_mm = arc.closed() - wanted_mm;
        if closure_error_mm.abs() > LARGEST_CLOSURE_ERROR_MODULES * module_mm {
            return Err(Refusal::new(
                size_key,
                if sector_rad.is_some() {
                    format!("{teeth} teeth take {toothed_mm:.6} mm, and the sector is longer or shorter than that")
                } else {
                    format!(
                        "the perimeter {:.6} mm misses pi m z = {wanted_mm:.6} mm by {closure_error_mm:.6} mm; {} mm \
                        is allowed",
                        arc.closed(),
                        LARGEST_CLOSURE_ERROR_MODULES * module_mm
                    )
                },
                way_to_close(shape, closing_mm, size_mm, module_mm),
            ));
        }
        let scaling = shape.scaled_from_mm().map(|(points_mm, allowed)| (size_mm / points_mm, allowed));
        if let Some((factor, TableScaling::Small)) = scaling
            && (factor - 1.0).abs() > LARGEST_UNASKED_SCALING
        {
            return Err(Refusal::new(
                size_key,
                format!(
                    "the points make {teeth} teeth of {module_mm} mm only if all radii are multiplied by {factor:.6}; \
                     a change of {} % is allowed unless any scaling is",
                    100.0 * LARGEST_UNASKED_SCALING
                ),
                way_to_close(shape, closing_mm, closing_mm / factor, module_mm),
            ));
        }
        let facts = CurveFacts::new(|phi| law.unit(phi) * size_mm, samples, sector_rad);
        let origin_mm = sector_rad.map_or(0.0, |[from, _]| arc.at(from));
        let scaling = scaling.map(|(factor, _)| factor);
        Ok(Self { law, size_mm, arc, closure_error_mm, origin_mm, pitches, scaling, facts })
    }

    /// r in mm at `phi_rad` (any real) with three derivatives with respect to phi.
    pub fn radius(&self, phi_rad: f64) -> Jet<4> {
        self.law.unit(phi_rad) * self.size_mm
    }

    /// Point, tangent, normal and curvature at `phi_rad` (any real).
    pub fn frame(&self, phi_rad: f64) -> PitchFrame {
        let radius = self.radius(phi_rad);
        let (r, dr) = (radius.value(), radius.derivative(1));
        let arc_rate_mm_per_rad = r.hypot(dr);
        let out = DVec2::from_angle(phi_rad);
        let tangent = (out * dr + out.perp() * r) / arc_rate_mm_per_rad;
        PitchFrame {
            point_mm: out * r,
            tangent,
            normal: -tangent.perp(),
            mu_rad: r.atan2(dr),
            arc_rate_mm_per_rad,
            curvature_per_mm: facts::curvature(&radius).value(),
            radius_mm: r,
        }
    }

    /// Arc length S in mm from phi = 0, of a sector from its beginning, to `phi_rad`: unwrapped, so that a whole turn
    /// adds the perimeter exactly; negative before.
    pub fn arc_mm(&self, phi_rad: f64) -> f64 {
        self.arc.at(phi_rad) - self.origin_mm
    }

    /// Polar angle (unwrapped) at which the arc length is `arc_mm` (any real).
    pub fn phi_at_arc(&self, arc_mm: f64) -> f64 {
        self.arc.angle_at(arc_mm + self.origin_mm)
    }

    /// Length of the closed curve, mm.
    pub fn perimeter_mm(&self) -> f64 {
        self.arc.closed()
    }

    /// Pitches of the closed curve: its teeth, of a sector with those that would find room on its dwell.
    pub fn pitches(&self) -> u32 {
        self.pitches
    }

    /// First and last polar angle of a sector, rad; `None` of a curve with teeth all round.
    pub fn sector_rad(&self) -> Option<[f64; 2]> {
        match &self.law {
            RadiusLaw::Sector(sector) => Some(sector.range_rad()),
            _ => None,
        }
    }

    /// The polar angles that have teeth: a sector's own, or a turn.
    pub fn toothed_rad(&self) -> [f64; 2] {
        self.sector_rad().unwrap_or([0.0, TURN_RAD])
    }

    /// Whether a polar angle (any real) has teeth.
    pub fn carries(&self, phi_rad: f64) -> bool {
        self.sector_rad().is_none_or(|[from, to]| (phi_rad - from).rem_euclid(TURN_RAD) <= to - from)
    }

    /// Perimeter minus pi m z, mm: what the last pitch is too long. Rounding when the size was solved.
    pub fn closure_error_mm(&self) -> f64 {
        self.closure_error_mm
    }

    /// The size parameter in use, given or solved, mm: radius of the circle, semi-major axis, centre distance (also of
    /// a mate), mean radius (for a table: mean of the radii of its points).
    pub fn size_mm(&self) -> f64 {
        self.size_mm
    }

    /// Factor that the radii of a table were multiplied by to close the curve; `None` where nothing was scaled.
    pub fn scaling(&self) -> Option<f64> {
        self.scaling
    }

    /// Shape of the curve.
    pub fn facts(&self) -> &CurveFacts {
        &self.facts
    }

    /// Whether the curve, turned by an angle, covers itself.
    pub fn repeats_after(&self, angle_rad: f64) -> bool {
        let samples = self.samples_per_turn();
        (0..samples).map(|index| sample_angle_rad(index, samples)).all(|phi| {
            let [here, later] = [phi, phi + angle_rad].map(|phi| self.radius(phi).value());
            (later - here).abs() <= REPEAT_TOLERANCE * here
        })
    }

    /// Teeth after which a gear of `teeth` teeth looks the same again: the curve repeats, and a whole number of teeth
    /// has passed. 1 on a circle, `teeth` on a curve without symmetry and on a sector.
    pub fn period_teeth(&self, teeth: u32) -> u32 {
        if self.sector_rad().is_some() {
            return teeth;
        }
        let repeats = |part: &u32| self.repeats_after(TURN_RAD * f64::from(*part) / f64::from(teeth));
        (1..teeth).filter(|part| teeth.is_multiple_of(*part)).find(repeats).unwrap_or(teeth)
    }

    /// Angles in [0, 2 pi) where the third derivative of r jumps (the points of a table).
    pub fn breaks_rad(&self) -> Vec<f64> {
        self.law.breaks_rad()
    }

    /// Number of samples per turn that resolve every variation of the curve.
    pub fn samples_per_turn(&self) -> usize {
        self.law.samples_per_turn()
    }
}

/// What closes a curve that was given a size which does not: the size that does, or for points that are too far from
/// it what else they may be.
fn way_to_close(shape: &PitchCurveShape, closing_mm: f64, size_mm: f64, module_mm: f64) -> String {
    let factor = closing_mm / size_mm;
    match shape {
        PitchCurveShape::Table { .. } if (factor - 1.0).abs() > LARGEST_UNASKED_SCALING => format!(
            "correct the module (the points fit {:.6} mm), the teeth or the points; or allow any scaling",
            module_mm / factor
        ),
        _ => format!("the size that closes is {closing_mm:.9} mm; leave it out and it is solved"),
    }
}
