//! Shapes that a gear can have beside the errors of a machine.
//!
//! In: a measured place. Out: what 1 um of a shape adds there. Each has a size on left flanks and one on right
//! flanks: 1 on the flanks of a tooth; 1 - s^2 along a profile, s from -1 to 1; -1/2 and 1/2 before and behind a
//! step.

use crate::influence::measured::MeasuredPoint;

/// What stands out.
#[derive(Debug, Clone, PartialEq)]
pub struct StandingOut {
    /// What it is.
    pub shape: StandingShape,
    /// What 1 um of it adds at every measured place, um: on left flanks, and on right ones.
    pub um_per_um: [Vec<f64>; 2],
}

/// What can stand out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StandingShape {
    /// A tooth.
    Tooth(u32),
    /// The profiles of a tooth, or of all; positive sizes are crowned, negative ones hollow.
    Profile(Option<u32>),
    /// A step at this place of the face, mm, of a tooth, or of all; positive sizes rise towards the larger place.
    Step(Option<u32>, f64),
}

impl StandingShape {
    /// What 1 um of it adds at a place, um; `ends_mm` are those of the profile there.
    pub(super) fn um_at(self, point: &MeasuredPoint, ends_mm: [f64; 2]) -> f64 {
        let is_on = |tooth: Option<u32>| tooth.is_none_or(|tooth| tooth == point.tooth);
        match self {
            Self::Tooth(tooth) => f64::from(u8::from(tooth == point.tooth)),
            Self::Profile(tooth) if is_on(tooth) && ends_mm[1] > ends_mm[0] => {
                let s = 2.0 * (point.u_mm - ends_mm[0]) / (ends_mm[1] - ends_mm[0]) - 1.0;
                1.0 - s * s
            }
            Self::Step(tooth, at_mm) if is_on(tooth) => 0.5 * (point.v_mm - at_mm).signum(),
            Self::Profile(_) | Self::Step(..) => 0.0,
        }
    }

    /// What it is, without sizes.
    pub fn title(self) -> String {
        let of = |tooth: Option<u32>| tooth.map_or_else(|| "all teeth".to_owned(), |tooth| format!("tooth {tooth}"));
        match self {
            Self::Tooth(tooth) => format!("tooth {tooth} stands out"),
            Self::Profile(tooth) => format!("profiles of {} are bent", of(tooth)),
            Self::Step(tooth, at_mm) => format!("flanks of {} step at v = {at_mm:.2} mm", of(tooth)),
        }
    }
}
