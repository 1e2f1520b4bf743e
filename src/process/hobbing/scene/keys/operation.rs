//! Keys of the operations: speed, feed, approach and linkage.

use crate::scene::keys::{Addition, Key, KeySection, Range, Role};

/// Reading of the papers' formulas.
const FORM: Key = Key::word(
    "form",
    &["exact", "as_printed"],
    "exact",
    "\"exact\"",
    "exact rolls without slip at every moment; as_printed adds v_z tan(beta) / r to the work alone, as the papers do: \
    wrong on curves that are no circles, kept to show what it does, never written as G-code.",
);

/// Keys of `[[operation]]`.
pub(super) static ADDED: Addition = Addition {
    path: "operation[]",
    keys: &[
        Key::number(
            "hob_speed_per_minute",
            "1/min",
            Range::closed(0.1, 20000.0),
            120.0,
            "140.0",
            "Speed of the hob spindle, in the mean of a cycle along the pitch curve.",
        ),
        Key::number(
            "axial_feed_mm_per_revolution",
            "mm per revolution",
            Range::closed(0.001, 50.0),
            2.0,
            "2.5",
            "Resulting feed along the gear's axis in the time of one revolution of the work.",
        ),
        Key::word(
            "feed_direction",
            &["climb", "conventional"],
            "climb",
            "\"climb\"",
            "climb: the hob feeds against the way its teeth go through the work; conventional: the same way.",
        ),
        Key::word(
            "approach",
            &["axial", "radial"],
            "axial",
            "\"axial\"",
            "axial: at depth beside the face, then along the axis into the work; radial: to depth at the face, then \
            along the axis.",
        ),
        Key::number(
            "radial_feed_mm_per_revolution",
            "mm per revolution",
            Range::closed(0.001, 20.0),
            0.5,
            "0.5",
            "Radial feed in the time of one revolution of the work, with a radial approach.",
        ),
        Key::optional(
            "approach_mm",
            "mm",
            Range::closed(0.0, 1000.0),
            "as much as the hob needs to start clear of the blank",
            "40.0",
            "Travel of the slide from its start to where the hob's axis passes the face.",
        ),
        Key::optional(
            "overrun_mm",
            "mm",
            Range::closed(0.0, 1000.0),
            "until every tooth's last contact has left the work",
            "8.0",
            "Travel of the slide beyond the other face.",
        ),
        Key::optional(
            "head_angle_deg",
            "deg",
            Range::closed(-60.0, 60.0),
            "helix angle and lead angle with their signs",
            "-7.25",
            "Tilt of the hob's axis against the transverse plane; leave it out unless the setting is off on purpose.",
        ),
        Key::optional(
            "shift_start_mm",
            "mm",
            Range::closed(-2000.0, 2000.0),
            "0, or the end of the shift's range",
            "0.0",
            "Place of the hob's middle along its axis at the start, from the pitch point.",
        ),
        Key::number(
            "ridge_tolerance_um",
            "um",
            Range::above(0.0, 10000.0),
            20.0,
            "20.0",
            "Height of feed marks on the flanks above which a warning is given.",
        ),
    ],
    groups: &[],
};

/// What is inside `[[operation]]`.
pub(super) static SECTIONS: &[KeySection] = &[
    KeySection::new(
        "operation[].linkage",
        Role::Choice { default: Some("hobbing"), what: "linkage" },
        &[],
        "Law that moves the axes.",
    ),
    KeySection::new(
        "operation[].linkage.hobbing",
        Role::Variant,
        &[
            Key::word(
                "even_motion",
                &["arc_length", "rotation_angle", "polar_angle"],
                "arc_length",
                "\"arc_length\"",
                "Motion that is even in time: arc of the pitch curve (the hob turns evenly), angle of the work, or \
                polar angle of the pitch point.",
            ),
            Key::word(
                "extra_rotation",
                &["work", "hob"],
                "work",
                "\"work\"",
                "Spindle that makes the extra rotation for the axial feed of a helical gear.",
            ),
            FORM,
        ],
        "Five axes: hob, work, two slides in the transverse plane and the axial slide. The papers' schemes I, \
            III and V are even arc, work angle and polar angle with work; II, IV and VI the same with hob.",
    ),
    KeySection::new(
        "operation[].linkage.hobbing_diagonal",
        Role::Variant,
        &[
            Key::number(
                "shift_mm_per_revolution",
                "mm per revolution",
                Range::above(0.0, 500.0),
                5.0,
                "7.5",
                "Shift along the hob's axis in the time of one revolution of the work.",
            ),
            Key::word(
                "shift_direction",
                &["adds", "subtracts"],
                "subtracts",
                "\"subtracts\"",
                "Whether the shift adds to the speed of the rolling (U in the paper) or takes from it (V); with \
                reciprocating shift the first stroke's.",
            ),
            Key::word(
                "strategy",
                &["one_way", "repeating", "reciprocating"],
                "reciprocating",
                "\"reciprocating\"",
                "At the end of the hob: one_way must not reach it; repeating backs off and travels back idle; \
                reciprocating turns round.",
            ),
            Key::optional(
                "stroke_mm",
                "mm",
                Range::above(0.0, 3000.0),
                "all of the hob that carries full contact",
                "60.0",
                "Length of hob that the shift uses.",
            ),
            Key::word(
                "feed_of",
                &["slide", "resultant"],
                "slide",
                "\"slide\"",
                "What axial_feed_mm_per_revolution counts: the slide's travel, which spaces the feed marks, or slide \
                and the shift's part along the gear's axis together, as the paper keeps constant.",
            ),
            Key::number(
                "return_mm_per_s",
                "mm/s",
                Range::above(0.0, 1000.0),
                20.0,
                "20.0",
                "Speed of the idle travel of a repeating shift.",
            ),
            FORM,
        ],
        "Six axes: the hob shifts along its axis while it cuts, so that all its teeth take part; conditions UL, \
            UR, VL and VR of the paper follow from shift_direction and gear.hand.",
    ),
];
