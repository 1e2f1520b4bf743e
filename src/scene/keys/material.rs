//! Keys of the work's material: what the cutting forces follow from.

use super::{Default, Key, KeySection, Kind, Range, Role};
use crate::material::{MATERIAL_NAMES, MATERIALS};

impl Key {
    /// A coefficient of the force law.
    pub const fn coefficient(
        name: &'static str,
        unit: &'static str,
        example: &'static str,
        teach: &'static str,
    ) -> Self {
        Self {
            name,
            kind: Kind::Number(Range::closed(0.0, 20_000.0)),
            unit,
            default: Default::Derived("from the material's name"),
            example,
            teach,
        }
    }
}

/// `[material]`.
pub(super) static SECTIONS: &[KeySection] = &[KeySection::new(
    "material",
    Role::Plain,
    &[
        Key {
            name: "name",
            kind: Kind::Word(&MATERIAL_NAMES),
            unit: "",
            default: Default::Word(MATERIALS[0].name),
            example: "\"16MnCr5\"",
            teach: "Steel whose built-in force coefficients hold: Kienzle's law after Koenig and Essel (1973), as a \
                line from 0.01 to 0.1 mm of chip.",
        },
        Key::coefficient(
            "cutting_force_n_per_mm2",
            "N/mm^2",
            "3000.0",
            "K_c: cutting force per area of chip, against the motion of the edge.",
        ),
        Key::coefficient(
            "cutting_edge_force_n_per_mm",
            "N/mm",
            "60.0",
            "K_ce: cutting force per length of edge that a chip of no thickness would need.",
        ),
    ],
    "The work's material: cutting force = (K_c h + K_ce) b for a chip of thickness h over a length b of edge. \
        Some processes compute forces always, others only where this section is written.",
)];
