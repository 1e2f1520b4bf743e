//! Keys of the texture windows.

use super::{Default, Key, KeySection, Kind, Range, Role};

/// `[[texture]]`.
pub(super) static SECTIONS: &[KeySection] = &[KeySection::new(
    "texture[]",
    Role::List { fewest: 0 },
    &[
        Key {
            name: "tooth",
            kind: Kind::Whole { min: 1, max: 2000 },
            unit: "",
            default: Default::Required,
            example: "3",
            teach: "Tooth on which the window lies, counted from 1 at the first one of positive polar angle.",
        },
        Key {
            name: "side",
            kind: Kind::Word(&["both", "left", "right"]),
            unit: "",
            default: Default::Word("both"),
            example: "\"left\"",
            teach: "Flank of the tooth; left is the one at the larger arc of the pitch curve.",
        },
        Key {
            name: "operation",
            kind: Kind::Name,
            unit: "",
            default: Default::LeftOut("the last one"),
            example: "\"rough\"",
            teach: "Operation after which the window is looked at; several operations get a window each.",
        },
        Key {
            name: "center_profile_mm",
            kind: Kind::Number(Range::closed(0.0, 500.0)),
            unit: "mm",
            default: Default::LeftOut("the middle of the evaluated profile"),
            example: "3.0",
            teach: "Middle of the window along the profile, as arc from the start of the involute.",
        },
        Key {
            name: "center_lead_mm",
            kind: Kind::Number(Range::closed(-500.0, 500.0)),
            unit: "mm",
            default: Default::Number(0.0),
            example: "0.0",
            teach: "Middle of the window along the tooth, from the middle of the face.",
        },
        length(
            "length_profile_mm",
            "the evaluated profile",
            "2.0",
            "Length of the window along the profile; five marks at least make the numbers mean something.",
        ),
        length(
            "length_lead_mm",
            "the whole face, of a bevel gear its middle nine tenths",
            "2.0",
            "Length of the window along the tooth.",
        ),
        Key {
            name: "profile_spacing_um",
            kind: Kind::Number(Range::closed(0.1, 1000.0)),
            unit: "um",
            default: Default::LeftOut("fields.flank.profile_spacing_um, or finer where a mark has less than 20 points"),
            example: "2.0",
            teach: "Distance of points along the profile, uniform in arc length.",
        },
        Key {
            name: "lead_spacing_um",
            kind: Kind::Number(Range::closed(0.1, 10000.0)),
            unit: "um",
            default: Default::LeftOut(
                "a fiftieth of the length, at least fields.flank.lead_spacing_um, or finer as above",
            ),
            example: "50.0",
            teach: "Distance of points along the tooth.",
        },
        Key {
            name: "form",
            kind: Kind::Word(&["none", "plane", "poly2", "poly2-plus-cylinder"]),
            unit: "",
            default: Default::Word("poly2"),
            example: "\"plane\"",
            teach: "F-operator: what is taken off the normal deviations before texture is evaluated.",
        },
        Key::optional(
            "s_filter_um",
            "um",
            Range::above(0.0, 10_000.0),
            "no filter",
            "8.0",
            "Areal S-filter (Gaussian, ISO 16610-61): shorter waves go, as those of a measured surface's noise.",
        ),
        Key::optional(
            "l_filter_um",
            "um",
            Range::above(0.0, 100_000.0),
            "no filter",
            "800.0",
            "Areal L-filter: longer waves go.",
        ),
        Key {
            name: "robust",
            kind: Kind::Boolean,
            unit: "",
            default: Default::Boolean(false),
            example: "true",
            teach: "Make the L-filter and the cut-off robust (ISO 16610-71 and -31): deep scratches do not pull them.",
        },
        Key::optional(
            "cutoff_um",
            "um",
            Range::above(0.0, 100_000.0),
            "by ISO 21920-3: from the limits of Ra and Rz, or the estimated Ra",
            "800.0",
            "Cut-off of the lines along profile and tooth whose Ra and Rz are given.",
        ),
        Key {
            name: "measured",
            kind: Kind::Path,
            unit: "",
            default: Default::LeftOut("no measured surface"),
            example: "\"flank_3_left.x3p\"",
            teach: "Measured surface of the window (X3P, SDF, SUR, GWY or text; the path is relative to the scene \
                file), laid over what is cut: maps, difference and parameters of both. The window is one flank.",
        },
    ],
    "A window on a flank whose surface texture is evaluated after an operation. Without any, the active \
        flanks of the teeth with the largest and the smallest pitch-curve radius and of tooth 3 are taken.",
)];

const fn length(name: &'static str, left_out: &'static str, example: &'static str, teach: &'static str) -> Key {
    Key {
        name,
        kind: Kind::Number(Range::above(0.0, 500.0)),
        unit: "mm",
        default: Default::LeftOut(left_out),
        example,
        teach,
    }
}
