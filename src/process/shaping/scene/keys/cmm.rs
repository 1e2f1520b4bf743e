//! Keys of a coordinate measurement of the allowances.

use crate::scene::keys::{Default, Key, KeySection, Kind, Range, Role};

/// The section.
pub(in crate::process::shaping::scene) const CMM: &str = "measure.cmm";

/// `[measure.cmm]`.
pub(super) static SECTIONS: &[KeySection] = &[KeySection::new(
    CMM,
    Role::Plain,
    &[
        Key {
            name: "points",
            kind: Kind::Whole { min: 5, max: 200 },
            unit: "",
            default: Default::Whole(20),
            example: "20",
            teach: "Points on the profile of a flank in the middle of the face, evenly over its length.",
        },
        Key {
            name: "probe_diameter_mm",
            kind: Kind::Number(Range::closed(0.05, 20.0)),
            unit: "mm",
            default: Default::Number(1.0),
            example: "1.0",
            teach: "Diameter of the probe's ball. Its radius is taken off along the nominal normal.",
        },
        Key {
            name: "point_deviation_um",
            kind: Kind::Number(Range::closed(0.0, 1000.0)),
            unit: "um",
            default: Default::Number(0.0),
            example: "1.0",
            teach: "Standard deviation of a single point along its normal.",
        },
        Key {
            name: "clamping_offset_um",
            kind: Kind::Number(Range::closed(0.0, 1000.0)),
            unit: "um",
            default: Default::Number(0.0),
            example: "5.0",
            teach: "Standard deviation in x and in y each of the gear's axis, clamped anew before it is finished.",
        },
        Key {
            name: "clamping_turn_deg",
            kind: Kind::Number(Range::closed(0.0, 1.0)),
            unit: "deg",
            default: Default::Number(0.0),
            example: "0.005",
            teach: "Standard deviation of the angle by which it is turned then.",
        },
        Key {
            name: "draws",
            kind: Kind::Whole { min: 20, max: 100_000 },
            unit: "",
            default: Default::Whole(1000),
            example: "1000",
            teach: "Measurements by chance, from which the interval of 95 % follows.",
        },
        Key {
            name: "seed",
            kind: Kind::Whole { min: 0, max: u32::MAX },
            unit: "",
            default: Default::Whole(1),
            example: "1",
            teach: "Chance begins here: the same seed, the same measurements.",
        },
    ],
    "The allowances AB and CD as a coordinate measuring machine would find them; without the section nothing is \
     measured so.",
)];
