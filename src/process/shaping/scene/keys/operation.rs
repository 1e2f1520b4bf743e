//! Keys of the operations: feed, linkage and infeed.

use crate::scene::keys::{Addition, Default, Group, Key, KeySection, Kind, Range, Role};

/// A depth of an infeed.
const fn depth(name: &'static str, default: Default, example: &'static str, teach: &'static str) -> Key {
    Key { name, kind: Kind::Number(Range::above(0.0, 100.0)), unit: "mm", default, example, teach }
}

/// What is said of the depth of a single infeed.
const DEPTH: &str = "Depth to feed; the whole tooth depth is 2.25 modules.";

/// Work angle over which an infeed takes place.
const fn angle(default: Default) -> Key {
    Key {
        name: "angle_deg",
        kind: Kind::Number(Range::above(0.0, 3600.0)),
        unit: "deg",
        default,
        example: "90.0",
        teach: "Work angle over which the depth is fed.",
    }
}

/// Strokes of a plunge.
const STROKES: Key = Key {
    name: "strokes",
    kind: Kind::Whole { min: 1, max: 100_000 },
    unit: "",
    default: Default::Required,
    example: "60",
    teach: "Number of strokes over which the cutter plunges.",
};

/// Keys of `[[operation]]`.
pub(super) static ADDED: Addition = Addition {
    path: "operation[]",
    keys: &[
        Key {
            name: "strokes_per_revolution",
            kind: Kind::Whole { min: 8, max: 1_000_000 },
            unit: "",
            default: Default::Derived("100 x teeth of the gear; 20 for the roughing of a scene without operations"),
            example: "4200",
            teach: "Double strokes in one turn of the work; 100 per tooth is a fine finishing cut, 20 a rough one.",
        },
        Key {
            name: "circular_feed_mm_per_stroke",
            kind: Kind::Number(Range::closed(1e-4, 20.0)),
            unit: "mm per stroke",
            default: Default::LeftOut("strokes_per_revolution holds"),
            example: "0.3",
            teach: "Mean arc of pitch curve per double stroke, as shops set it.",
        },
        Key::optional(
            "stock_scatter_um",
            "um",
            Range::closed(0.0, 1000.0),
            "even stock",
            "15.0",
            "Standard deviation of the stock on flanks after the operation, normal to them, about \
                stock_per_flank_mm: its infeed scatters by as much / sin(pressure angle).",
        ),
        Key::optional(
            "stock_scatter_length_mm",
            "mm",
            Range::closed(0.001, 10_000.0),
            "from stroke to stroke",
            "20.0",
            "Arc of pitch curve over which that scatter loses its correlation (1/e): from place to place.",
        ),
        Key {
            name: "stroke_spacing",
            kind: Kind::Word(&["work_angle", "arc", "time"]),
            unit: "",
            default: Default::Word("work_angle"),
            example: "\"work_angle\"",
            teach: "What advances equally from stroke to stroke: the work angle, the arc of pitch curve, or time \
                with the slowest axis at its limit.",
        },
        Key {
            name: "window_deg",
            kind: Kind::Pair(Range::closed(-360.0, 720.0)),
            unit: "deg",
            default: Default::LeftOut("the whole turn"),
            example: "[0.0, 120.0]",
            teach: "First and last work angle, when only part of the turn is cut.",
        },
        Key {
            name: "revolutions",
            kind: Kind::Whole { min: 1, max: 100 },
            unit: "",
            default: Default::Whole(1),
            example: "1",
            teach: "Turns of the work.",
        },
        Key {
            name: "overlap_deg",
            kind: Kind::Number(Range::closed(0.0, 360.0)),
            unit: "deg",
            default: Default::Derived("the angle of a spiral infeed that is not written either, else 0"),
            example: "5.0",
            teach: "Work angle cut beyond the whole turns, so that the end runs over the start.",
        },
        Key {
            name: "feed_during_stroke",
            kind: Kind::Boolean,
            unit: "",
            default: Default::Boolean(false),
            example: "false",
            teach: "true: the rotary feed goes on while the cutter is in the work, as on a crank machine; false: \
                the axes rest during each stroke.",
        },
    ],
    groups: &[Group { names: &["strokes_per_revolution", "circular_feed_mm_per_stroke"], required: false }],
};

/// What is inside `[[operation]]`.
pub(super) static SECTIONS: &[KeySection] = &[
    KeySection::new(
        "operation[].linkage",
        Role::Choice { default: Some("shaping_normal"), what: "linkage" },
        &[],
        "Law that moves the axes. With an offset of 0 both linkages of shaping cut the same gear.",
    ),
    KeySection::new(
        "operation[].linkage.shaping_traditional",
        Role::Variant,
        &[Key {
            name: "direction",
            kind: Kind::Word(&["center_line", "polar_radius"]),
            unit: "",
            default: Default::Word("center_line"),
            example: "\"center_line\"",
            teach: "Direction of the offset: the machine's radial axis, or the polar radius of the pitch point (kept \
                for comparison).",
        }],
        "The angles of the finishing cut, the offset added to the centre distance: simple, with uneven \
            stock where the curvature changes.",
    ),
    KeySection::new(
        "operation[].linkage.shaping_normal",
        Role::Variant,
        &[Key {
            name: "reading",
            kind: Kind::Word(&["corrected", "as_printed"]),
            unit: "",
            default: Default::Word("corrected"),
            example: "\"corrected\"",
            teach: "Reading of the paper's Eq. 12: with the offset in the cutter's angle, or without it as printed \
                (wrong, kept to show what it does).",
        }],
        "The offset along the normal of the pitch curve, so that both flanks keep even stock.",
    ),
    KeySection::new(
        "operation[].infeed",
        Role::Choice { default: Some("spiral"), what: "infeed" },
        &[],
        "How the cutter gets to depth. An operation with a window_deg, and one that goes no deeper than those \
            before it, is at depth from the first stroke on unless it says otherwise.",
    ),
    KeySection::new(
        "operation[].infeed.none",
        Role::Variant,
        &[],
        "At depth from the first stroke on: from the blank, that stroke takes whole tooth spaces at once.",
    ),
    KeySection::new(
        "operation[].infeed.plunge",
        Role::Variant,
        &[depth("depth_mm", Default::Required, "6.75", DEPTH), STROKES],
        "Radially at the start angle, without rolling.",
    ),
    KeySection::new(
        "operation[].infeed.spiral",
        Role::Variant,
        &[
            depth(
                "depth_mm",
                Default::Derived("what is left to feed, from the blank or the operation before"),
                "6.75",
                DEPTH,
            ),
            angle(Default::Derived("a quarter turn for the whole tooth depth, less for less")),
        ],
        "Evenly while rolling over the first part of the turn. Cut as much overlap, or the start stays shallow.",
    ),
    KeySection::new(
        "operation[].infeed.plunge_and_roll",
        Role::Variant,
        &[
            depth("plunge_depth_mm", Default::Required, "4.0", "Depth plunged at the start angle."),
            STROKES,
            depth("roll_depth_mm", Default::Required, "2.75", "Depth fed afterwards while rolling."),
            angle(Default::Required),
        ],
        "Part by plunging, the rest while rolling.",
    ),
];
