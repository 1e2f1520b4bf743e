//! Keys of what only shaping measures: chips and the evaluated profile.

use crate::scene::keys::{Default, Key, KeySection, Kind, Range, Role};

/// Largest distance of the rays on which chips are followed, mm.
pub const LARGEST_CHIP_SPACING_MM: f64 = 2.0;

/// `[fields.chips]` and `[measure]`.
pub(super) static SECTIONS: &[KeySection] = &[
    KeySection {
        path: "fields.chips",
        role: Role::Plain,
        keys: &[Key {
            name: "spacing_mm",
            kind: Kind::Number(Range::closed(0.002, LARGEST_CHIP_SPACING_MM)),
            unit: "mm",
            default: Default::Derived("module_mm / 60"),
            example: "0.05",
            teach: "Distance of the rays through a tooth space and of the places along the cutter's edge.",
        }],
        groups: &[],
        teach: "The rays on which chips are followed from stroke to stroke; half the spacing doubles the time.",
    },
    KeySection {
        path: "measure",
        role: Role::Plain,
        keys: &[
            Key::optional(
                "profile_start_height_mm",
                "mm",
                Range::closed(-100.0, 100.0),
                "from the form point, 5 % left out",
                "-2.0",
                "Lower end of the evaluated profile, as height over the pitch curve along its normal.",
            ),
            Key::optional(
                "profile_end_height_mm",
                "mm",
                Range::closed(-100.0, 100.0),
                "to the tip, 5 % left out",
                "2.5",
                "Upper end of the evaluated profile, as height over the pitch curve along its normal.",
            ),
        ],
        groups: &[],
        teach: "Where profiles are evaluated.",
    },
];
