//! Keys of hobbing: the hob, the machine's limits, feeds and linkages.

use super::{Default, Group, Key, Kind, Range, Role, Section};

/// A switch between words.
const fn word(
    name: &'static str,
    words: &'static [&'static str],
    default: &'static str,
    example: &'static str,
    teach: &'static str,
) -> Key {
    Key { name, kind: Kind::Word(words), unit: "", default: Default::Word(default), example, teach }
}

/// A number with a default.
const fn number(
    name: &'static str,
    unit: &'static str,
    range: Range,
    default: f64,
    example: &'static str,
    teach: &'static str,
) -> Key {
    Key { name, kind: Kind::Number(range), unit, default: Default::Number(default), example, teach }
}

/// A number that may be left out.
const fn optional(
    name: &'static str,
    unit: &'static str,
    range: Range,
    words: &'static str,
    example: &'static str,
    teach: &'static str,
) -> Key {
    Key { name, kind: Kind::Number(range), unit, default: Default::LeftOut(words), example, teach }
}

/// A limit of an axis, where known.
const fn limit(name: &'static str, unit: &'static str, example: &'static str, teach: &'static str) -> Key {
    optional(name, unit, Range::above(0.0, 1e7), "not limited", example, teach)
}

/// Reading of the papers' formulas.
const FORM: Key = word(
    "form",
    &["exact", "as_printed"],
    "exact",
    "\"exact\"",
    "exact rolls without slip at every moment; as_printed adds v_z tan(beta) / r to the work alone, as the papers do: \
    wrong on curves that are no circles, kept to show what it does, never written as G-code.",
);

/// Tool sections, after the shaper cutter's.
pub(super) static TOOL: &[Section] = &[Section {
    path: "tool.hob",
    role: Role::Variant,
    keys: &[
        Key {
            name: "starts",
            kind: Kind::Whole { min: 1, max: 8 },
            unit: "",
            default: Default::Whole(1),
            example: "1",
            teach: "Number of starts K of the thread.",
        },
        word("hand", &["right", "left"], "right", "\"left\"", "Hand of the thread."),
        Key {
            name: "gashes",
            kind: Kind::Whole { min: 4, max: 60 },
            unit: "",
            default: Default::Whole(12),
            example: "10",
            teach: "Number of gashes: rows of cutting teeth round the hob.",
        },
        word(
            "gash_form",
            &["axial", "helical"],
            "axial",
            "\"axial\"",
            "Gashes parallel to the axis, or at right angles to the thread.",
        ),
        Key {
            name: "lead_angle_deg",
            kind: Kind::Number(Range::above(0.0, 20.0)),
            unit: "deg",
            default: Default::OneOfGroup,
            example: "3.316667",
            teach: "Lead angle of the thread on the pitch cylinder; the pitch radius is K m / (2 sin lead).",
        },
        Key {
            name: "reference_diameter_mm",
            kind: Kind::Number(Range::above(0.0, 1000.0)),
            unit: "mm",
            default: Default::OneOfGroup,
            example: "138.0",
            teach: "Diameter of the pitch cylinder.",
        },
        Key {
            name: "length_mm",
            kind: Kind::Number(Range::above(0.0, 3000.0)),
            unit: "mm",
            default: Default::Required,
            example: "132.0",
            teach: "Length of the hob that carries full teeth.",
        },
        number(
            "addendum_coefficient",
            "modules",
            Range::closed(0.1, 2.5),
            1.25,
            "1.25",
            "Height of the hob tooth over its pitch cylinder; it cuts the gear's dedendum.",
        ),
        number(
            "dedendum_coefficient",
            "modules",
            Range::closed(0.1, 2.5),
            1.25,
            "1.25",
            "Depth of the hob's thread under its pitch cylinder; more than the gear's addendum, or the hob tops the \
            gear.",
        ),
        word(
            "worm",
            &["involute", "straight_sided"],
            "involute",
            "\"involute\"",
            "Flanks of the thread: involute helicoid (ZI), which cuts exact involutes, or straight in the axial \
            section (ZA), which cuts nearly that.",
        ),
        number(
            "tip_radius_mm",
            "mm",
            Range::closed(0.0, 50.0),
            0.0,
            "1.5",
            "Radius of the tip round in the rake face; 0 is a sharp corner, about 0.2 modules is common.",
        ),
        optional(
            "protuberance_height_mm",
            "mm",
            Range::above(0.0, 100.0),
            "no protuberance",
            "4.0",
            "Height below the tip at which a protuberance begins; it undercuts the gear's root for grinding.",
        ),
        number(
            "protuberance_angle_deg",
            "deg",
            Range::closed(0.0, 44.0),
            10.0,
            "10.0",
            "Normal pressure angle of the protuberance, smaller than the flank's.",
        ),
        number(
            "thinning_mm",
            "mm",
            Range::closed(-5.0, 5.0),
            0.0,
            "0.3",
            "Normal thickness taken off every hob tooth on the pitch cylinder, as on a roughing hob.",
        ),
        number(
            "regrind_mm",
            "mm",
            Range::closed(0.0, 50.0),
            0.0,
            "2.0",
            "How much the hob's radius has shrunk by regrinding its rake faces; the lead stays, so the profile \
            changes.",
        ),
    ],
    groups: &[Group { names: &["lead_angle_deg", "reference_diameter_mm"], required: true }],
    teach: "Hob; module and pressure angle are the gear's, in the normal section.",
}];

/// Machine sections.
pub(super) static MACHINE: &[Section] = &[Section {
    path: "machine.hobbing_limits",
    role: Role::Plain,
    keys: &[
        limit("hob_speed_deg_per_s", "deg/s", "1800.0", "Largest speed of the hob spindle."),
        limit("work_speed_deg_per_s", "deg/s", "120.0", "Largest speed of the work spindle."),
        limit(
            "tangential_speed_mm_per_s",
            "mm/s",
            "200.0",
            "Largest speed of the slide along the rack's pitch line (X).",
        ),
        limit("radial_speed_mm_per_s", "mm/s", "200.0", "Largest speed of the radial slide (Y)."),
        limit("slide_speed_mm_per_s", "mm/s", "100.0", "Largest speed of the slide along the gear's axis (Z)."),
        limit("shift_speed_mm_per_s", "mm/s", "50.0", "Largest speed of the shift along the hob's axis."),
        limit("hob_acceleration_deg_per_s2", "deg/s^2", "5000.0", "Largest acceleration of the hob spindle."),
        limit("work_acceleration_deg_per_s2", "deg/s^2", "500.0", "Largest acceleration of the work spindle."),
        limit("tangential_acceleration_mm_per_s2", "mm/s^2", "1000.0", "Largest acceleration of X."),
        limit("radial_acceleration_mm_per_s2", "mm/s^2", "1000.0", "Largest acceleration of Y."),
    ],
    groups: &[],
    teach: "Largest speeds and accelerations of the axes of a hobbing machine, where known. Slide and shift run at \
        constant feeds; their jumps are left to the control.",
}];

/// Keys of an operation that only hobbing has.
pub(super) const HOB_SPEED: Key = number(
    "hob_speed_per_minute",
    "1/min",
    Range::above(0.0, 20000.0),
    120.0,
    "140.0",
    "Speed of the hob spindle, in the mean of a cycle along the pitch curve.",
);
/// Axial feed.
pub(super) const AXIAL_FEED: Key = number(
    "axial_feed_mm_per_revolution",
    "mm per revolution",
    Range::above(0.0, 50.0),
    2.0,
    "2.5",
    "Resulting feed along the gear's axis in the time of one revolution of the work.",
);
/// Direction of the feed.
pub(super) const FEED_DIRECTION: Key = word(
    "feed_direction",
    &["climb", "conventional"],
    "climb",
    "\"climb\"",
    "climb: the hob feeds against the way its teeth go through the work; conventional: the same way.",
);
/// Approach.
pub(super) const APPROACH: Key = word(
    "approach",
    &["axial", "radial"],
    "axial",
    "\"axial\"",
    "axial: at depth beside the face, then along the axis into the work; radial: to depth at the face, then along the \
    axis.",
);
/// Radial feed.
pub(super) const RADIAL_FEED: Key = number(
    "radial_feed_mm_per_revolution",
    "mm per revolution",
    Range::above(0.0, 20.0),
    0.5,
    "0.5",
    "Radial feed in the time of one revolution of the work, with a radial approach.",
);
/// Way before the face.
pub(super) const APPROACH_WAY: Key = optional(
    "approach_mm",
    "mm",
    Range::closed(0.0, 1000.0),
    "as much as the hob needs to start clear of the blank",
    "40.0",
    "Way of the slide from its start to where the hob's axis passes the face.",
);
/// Way beyond the face.
pub(super) const OVERRUN_WAY: Key = optional(
    "overrun_mm",
    "mm",
    Range::closed(0.0, 1000.0),
    "until every tooth's last contact has left the work",
    "8.0",
    "Way of the slide beyond the other face.",
);
/// Head angle.
pub(super) const HEAD_ANGLE: Key = optional(
    "head_angle_deg",
    "deg",
    Range::closed(-60.0, 60.0),
    "helix angle and lead angle with their signs",
    "-7.25",
    "Tilt of the hob's axis against the transverse plane; leave it out unless the setting is off on purpose.",
);
/// Start of the shift.
pub(super) const SHIFT_START: Key = optional(
    "shift_start_mm",
    "mm",
    Range::closed(-2000.0, 2000.0),
    "0, or the end of the shift's range",
    "0.0",
    "Place of the hob's middle along its axis at the start, from the pitch point.",
);

/// Tolerance of feed marks.
pub(super) const RIDGE_TOLERANCE: Key = number(
    "ridge_tolerance_um",
    "um",
    Range::above(0.0, 10000.0),
    20.0,
    "20.0",
    "Height of feed marks on the flanks above which a warning is given.",
);

/// Linkage sections, after those of shaping.
pub(super) static LINKAGES: &[Section] = &[
    Section {
        path: "operation[].linkage.hobbing",
        role: Role::Variant,
        keys: &[
            word(
                "even_motion",
                &["arc_length", "rotation_angle", "polar_angle"],
                "arc_length",
                "\"arc_length\"",
                "Motion that is even in time: arc of the pitch curve (the hob turns evenly), angle of the work, or \
                polar angle of the pitch point.",
            ),
            word(
                "extra_rotation",
                &["work", "hob"],
                "work",
                "\"work\"",
                "Spindle that carries the extra rotation which the axial feed of a helical gear asks for.",
            ),
            FORM,
        ],
        groups: &[],
        teach: "Five axes: hob, work, two slides in the transverse plane and the axial slide. The papers' schemes I, \
            III and V are even arc, work angle and polar angle with work; II, IV and VI the same with hob.",
    },
    Section {
        path: "operation[].linkage.hobbing_diagonal",
        role: Role::Variant,
        keys: &[
            number(
                "shift_mm_per_revolution",
                "mm per revolution",
                Range::above(0.0, 500.0),
                5.0,
                "7.5",
                "Shift along the hob's axis in the time of one revolution of the work.",
            ),
            word(
                "shift_direction",
                &["adds", "subtracts"],
                "subtracts",
                "\"subtracts\"",
                "Whether the shift adds to the speed of the rolling (U in the paper) or takes from it (V); with \
                reciprocating shift the first stroke's.",
            ),
            word(
                "strategy",
                &["one_way", "repeating", "reciprocating"],
                "reciprocating",
                "\"reciprocating\"",
                "At the end of the hob: one_way must not reach it; repeating leaves the work and travels back idle; \
                reciprocating turns round.",
            ),
            optional(
                "stroke_mm",
                "mm",
                Range::above(0.0, 3000.0),
                "all of the hob that carries full contact",
                "60.0",
                "Length of hob that the shift uses.",
            ),
            word(
                "feed_of",
                &["slide", "resultant"],
                "slide",
                "\"slide\"",
                "What axial_feed_mm_per_revolution counts: the slide's way, which spaces the feed marks, or slide and \
                the shift's part along the gear's axis together, as the paper keeps constant.",
            ),
            number(
                "return_mm_per_s",
                "mm/s",
                Range::above(0.0, 1000.0),
                20.0,
                "20.0",
                "Speed of the idle travel of a repeating shift.",
            ),
            FORM,
        ],
        groups: &[],
        teach: "Six axes: the hob shifts along its axis while it cuts, so that all its teeth take part; conditions UL, \
            UR, VL and VR of the paper follow from shift_direction and gear.hand.",
    },
];
