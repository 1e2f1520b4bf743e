//! Keys of the chips that shaping follows from stroke to stroke, and of the forces that only it computes.

use crate::scene::keys::{Addition, Default, Key, KeySection, Kind, Range, Role};

/// Largest distance of the rays on which chips are followed, mm.
pub const LARGEST_CHIP_SPACING_MM: f64 = 2.0;

/// `[fields.chips]`.
pub(super) static SECTIONS: &[KeySection] = &[KeySection::new(
    "fields.chips",
    Role::Plain,
    &[Key {
        name: "spacing_mm",
        kind: Kind::Number(Range::closed(0.002, LARGEST_CHIP_SPACING_MM)),
        unit: "mm",
        default: Default::Derived("module_mm / 60"),
        example: "0.05",
        teach: "Distance of the rays through a tooth space and of the places along the cutter's edge.",
    }],
    "The rays on which chips are followed from stroke to stroke; half the spacing doubles the time.",
)];

/// Keys of `[material]`.
pub(super) static ADDED: Addition = Addition {
    path: "material",
    keys: &[
        Key::coefficient(
            "normal_force_n_per_mm2",
            "N/mm^2",
            "1500.0",
            "K_n: force normal to the edge per area of chip.",
        ),
        Key::coefficient(
            "normal_edge_force_n_per_mm",
            "N/mm",
            "30.0",
            "K_ne: force normal to the edge per length of edge.",
        ),
    ],
    groups: &[],
};
