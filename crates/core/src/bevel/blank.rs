//! The blank of a bevel gear from its cone data, and whether the data agree with each other.
//!
//! In: angles of pitch, face and root cone, outer cone distance, face width, outer addendum and dedendum. Out: the
//! tooth between them at every cone distance, and a list of what does not fit.
//!
//! **Places.** A point of the axial section is told by its cone distance R along the pitch cone from the pitch apex,
//! and by its height h over the pitch cone, square to it, positive towards the tips. In the work frame it stands at
//! R cos(gamma) - h sin(gamma) along the axis and R sin(gamma) + h cos(gamma) away from it. Face and root cone need not
//! meet the pitch apex: what fixes them is addendum and dedendum at the outer cone distance.
//!
//! Source of the terms: ISO 23509. The checks hold the rounding of printed data (0.01 deg, 0.5 % of the depth) as
//! equal.

use crate::error::Refusal;
use crate::parameter;
use glam::{DVec2, DVec3, Vec3Swizzles};
use std::f64::consts::PI;

/// Angles that differ by more than this contradict each other, rad: a hundredth of a degree, as drawings round.
const ANGLE_ROUNDING_RAD: f64 = 0.01 * PI / 180.0;

/// Cone data of one member; mm and rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BevelBlank {
    /// Number of teeth.
    pub teeth: u32,
    /// Pitch angle gamma.
    pub pitch_angle_rad: f64,
    /// Face angle: of the cone of the tips.
    pub face_angle_rad: f64,
    /// Root angle: of the cone of the roots.
    pub root_angle_rad: f64,
    /// Outer cone distance R_e.
    pub outer_cone_distance_mm: f64,
    /// Face width b, along the pitch cone.
    pub face_width_mm: f64,
    /// Addendum at the outer cone distance.
    pub outer_addendum_mm: f64,
    /// Dedendum at the outer cone distance.
    pub outer_dedendum_mm: f64,
}

impl BevelBlank {
    /// The data, if they describe teeth.
    ///
    /// # Errors
    /// Angles in the wrong order or beyond a right angle, a face that reaches the apex, no depth at the toe.
    pub fn new(data: Self) -> Result<Self, Refusal> {
        let degrees = f64::to_degrees;
        let between = |low: f64, value: f64, high: f64| value >= low && value <= high;
        if !between(0.0, data.pitch_angle_rad, 0.5 * PI) || data.pitch_angle_rad <= 0.0 {
            return Err(Refusal::new(
                parameter::PITCH_ANGLE,
                format!("the pitch angle is {:.4} deg; it lies between 0 and 90 deg", degrees(data.pitch_angle_rad)),
                "write the angle between the gear's axis and its pitch cone",
            ));
        }
        for (key, low, value, high) in [
            (parameter::ROOT_ANGLE, 0.0, data.root_angle_rad, data.pitch_angle_rad),
            (parameter::FACE_ANGLE, data.pitch_angle_rad, data.face_angle_rad, 0.5 * PI),
        ] {
            if !between(low, value, high) {
                return Err(Refusal::new(
                    key,
                    format!(
                        "{:.4} deg lies outside of {:.4} to {:.4} deg: the root cone stands inside the pitch cone, the \
                         face cone outside",
                        degrees(value),
                        degrees(low),
                        degrees(high)
                    ),
                    "check which column of the data sheet is which",
                ));
            }
        }
        if data.face_width_mm >= data.outer_cone_distance_mm {
            return Err(Refusal::new(
                parameter::FACE_WIDTH,
                format!(
                    "a face of {} mm reaches the apex: the outer cone distance is {:.3} mm",
                    data.face_width_mm, data.outer_cone_distance_mm
                ),
                "write at most a third of the outer cone distance",
            ));
        }
        let inner_mm = data.outer_cone_distance_mm - data.face_width_mm;
        let depth_mm = data.addendum_mm(inner_mm) + data.dedendum_mm(inner_mm);
        if depth_mm <= 0.0 {
            return Err(Refusal::new(
                parameter::ROOT_ANGLE,
                format!("at the toe no depth is left ({depth_mm:.3} mm): face and root cone meet within the face"),
                "check face and root angle, addendum and dedendum",
            ));
        }
        Ok(data)
    }

    /// Outer transverse module, mm: 2 R_e sin(gamma) / z.
    pub fn outer_module_mm(&self) -> f64 {
        2.0 * self.outer_cone_distance_mm * self.pitch_angle_rad.sin() / f64::from(self.teeth)
    }

    /// Mean cone distance, mm: to the middle of the face.
    pub fn mean_cone_distance_mm(&self) -> f64 {
        self.outer_cone_distance_mm - 0.5 * self.face_width_mm
    }

    /// Addendum angle: from pitch to face cone, rad.
    pub fn addendum_angle_rad(&self) -> f64 {
        self.face_angle_rad - self.pitch_angle_rad
    }

    /// Dedendum angle: from root to pitch cone, rad.
    pub fn dedendum_angle_rad(&self) -> f64 {
        self.pitch_angle_rad - self.root_angle_rad
    }

    /// Height of the face cone over the pitch cone at a cone distance, mm.
    pub fn addendum_mm(&self, cone_distance_mm: f64) -> f64 {
        self.outer_addendum_mm - (self.outer_cone_distance_mm - cone_distance_mm) * self.addendum_angle_rad().tan()
    }

    /// Depth of the root cone under the pitch cone at a cone distance, mm.
    pub fn dedendum_mm(&self, cone_distance_mm: f64) -> f64 {
        self.outer_dedendum_mm - (self.outer_cone_distance_mm - cone_distance_mm) * self.dedendum_angle_rad().tan()
    }

    /// Place of the axial section from cone distance and height: along the axis and away from it, mm.
    pub fn axial_mm(&self, [cone_distance_mm, height_mm]: [f64; 2]) -> DVec2 {
        DVec2::from_angle(self.pitch_angle_rad).rotate(DVec2::new(cone_distance_mm, height_mm))
    }

    /// Place of the axial section on the root cone in the middle of the face, mm.
    pub fn mean_root_mm(&self) -> DVec2 {
        let mean_mm = self.mean_cone_distance_mm();
        self.axial_mm([mean_mm, -self.dedendum_mm(mean_mm)])
    }

    /// Cone distance and height of a point of the work frame, mm.
    pub fn cone_distance_and_height_mm(&self, point_mm: DVec3) -> [f64; 2] {
        let section = DVec2::new(point_mm.x, point_mm.yz().length());
        DVec2::from_angle(-self.pitch_angle_rad).rotate(section).into()
    }

    /// Whether a point of the work frame is in the blank, between its cones and both ends of its face.
    pub fn holds(&self, point_mm: DVec3) -> bool {
        let [distance_mm, height_mm] = self.cone_distance_and_height_mm(point_mm);
        let from_toe_mm = distance_mm - (self.outer_cone_distance_mm - self.face_width_mm);
        from_toe_mm >= 0.0 && from_toe_mm <= self.face_width_mm && height_mm <= self.addendum_mm(distance_mm)
    }

    /// What in the data contradicts itself; the mate counts where it is known.
    pub fn contradictions(&self, mate: Option<MatingCones>) -> Vec<Contradiction> {
        let of_mate = mate.and_then(|mate| {
            let right_rad = pitch_angle_rad(self.teeth, mate.teeth, mate.shaft_angle_rad);
            let is_off = (right_rad - self.pitch_angle_rad).abs() > ANGLE_ROUNDING_RAD;
            is_off.then_some(Contradiction::PitchAngle { mate, right_rad })
        });
        let share = self.face_width_mm / self.outer_cone_distance_mm;
        let of_face = (share > 1.0 / 3.0).then_some(Contradiction::WideFace { share });
        of_mate.into_iter().chain(of_face).collect()
    }
}

/// What in a blank's data contradicts itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Contradiction {
    /// The pitch cone does not roll on the mate's.
    PitchAngle {
        /// The mate.
        mate: MatingCones,
        /// The pitch angle that does, rad.
        right_rad: f64,
    },
    /// The face takes more than a third of the outer cone distance, which makes the toe weak.
    WideFace {
        /// Share of the outer cone distance.
        share: f64,
    },
}

/// What is known of the mate's cones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MatingCones {
    /// Its number of teeth.
    pub teeth: u32,
    /// Angle between both axes, rad.
    pub shaft_angle_rad: f64,
}

/// Pitch angle of a member with so many teeth that rolls on a mate without offset, rad:
/// tan gamma = sin Sigma / (z_mate / z + cos Sigma).
pub fn pitch_angle_rad(teeth: u32, mate_teeth: u32, shaft_angle_rad: f64) -> f64 {
    let (sin, cos) = shaft_angle_rad.sin_cos();
    sin.atan2(f64::from(mate_teeth) / f64::from(teeth) + cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn data() -> BevelBlank {
        let rad = f64::to_radians;
        BevelBlank {
            teeth: 62,
            pitch_angle_rad: rad(77.5833),
            face_angle_rad: rad(78.4333),
            root_angle_rad: rad(75.4333),
            outer_cone_distance_mm: 132.334,
            face_width_mm: 36.83,
            outer_addendum_mm: 1.905,
            outer_dedendum_mm: 5.715,
        }
    }

    #[test]
    fn data_that_make_no_teeth_are_refused() {
        assert!(BevelBlank::new(data()).is_ok());
        let exchanged = BevelBlank { face_angle_rad: data().root_angle_rad, ..data() };
        let refused = BevelBlank::new(exchanged).unwrap_err();
        assert!(refused.key == parameter::FACE_ANGLE && refused.problem.contains("75.4333"), "{refused}");
        for wrong in [
            BevelBlank { root_angle_rad: data().face_angle_rad, ..data() },
            BevelBlank { pitch_angle_rad: -0.1, ..data() },
            BevelBlank { face_width_mm: 133.0, ..data() },
            BevelBlank { root_angle_rad: 1.0, ..data() },
        ] {
            assert!(BevelBlank::new(wrong).is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn the_pair_says_whether_the_pitch_angle_is_its_own() {
        let mate = |degrees: f64| Some(MatingCones { teeth: 19, shaft_angle_rad: degrees.to_radians() });
        assert!(data().contradictions(mate(95.0)).is_empty());
        let off = data().contradictions(mate(90.0));
        let [Contradiction::PitchAngle { right_rad, .. }] = off[..] else { panic!("{off:?}") };
        assert!((right_rad.to_degrees() - 72.9).abs() < 0.1, "{right_rad}");
        assert!(data().contradictions(None).is_empty());
        assert_eq!(BevelBlank { face_width_mm: 50.0, ..data() }.contradictions(None).len(), 1);
    }

    #[test]
    fn places_of_the_axial_section_go_there_and_back() {
        let at = data().axial_mm([110.0, -2.5]);
        let point = DVec3::new(at.x, -0.6 * at.y, 0.8 * at.y);
        let [distance_mm, height_mm] = data().cone_distance_and_height_mm(point);
        assert!((distance_mm - 110.0).abs() < 1e-12 && (height_mm + 2.5).abs() < 1e-12);
        assert!(data().holds(point));
        let over = data().axial_mm([110.0, data().addendum_mm(110.0) + 1e-6]);
        assert!(!data().holds(DVec3::new(over.x, over.y, 0.0)));
    }
}
