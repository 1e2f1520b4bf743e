//! Keys of the grid on which flanks are inspected.

use crate::scene::keys::{Default, Key, KeySection, Kind, Role};

/// Points in one direction.
const fn points(name: &'static str, usual: u32, example: &'static str, teach: &'static str) -> Key {
    Key { name, kind: Kind::Whole { min: 3, max: 200 }, unit: "", default: Default::Whole(usual), example, teach }
}

/// `[inspection]`.
pub(super) static SECTIONS: &[KeySection] = &[KeySection::new(
    "inspection",
    Role::Plain,
    &[
        points("profile_points", 5, "5", "Points along the profile; no more than the flank has columns of dexels."),
        points("tooth_points", 9, "9", "Points along the tooth; no more than the flank has rows of dexels."),
    ],
    "The grid on which bevel flanks are inspected, 5 by 9 points by default as gear inspection takes it. \
        tables/grid.csv has nominal points, normals and deviations of all flanks.",
)];
