//! Keys of the hob.

use crate::scene::keys::machine_errors::{TOOL_RUNOUT, TOOL_RUNOUT_ANGLE, TOOL_WOBBLE, TOOL_WOBBLE_ANGLE};
use crate::scene::keys::{Default, Group, Key, KeySection, Kind, Range, Role};

/// `[tool.hob]`.
pub(super) static SECTIONS: &[KeySection] = &[KeySection {
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
        Key::word("hand", &["right", "left"], "right", "\"left\"", "Hand of the thread."),
        Key {
            name: "gashes",
            kind: Kind::Whole { min: 4, max: 60 },
            unit: "",
            default: Default::Whole(12),
            example: "10",
            teach: "Number of gashes: rows of cutting teeth round the hob.",
        },
        Key::word(
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
        Key::number(
            "addendum_coefficient",
            "modules",
            Range::closed(0.1, 2.5),
            1.25,
            "1.25",
            "Height of the hob tooth over its pitch cylinder; it cuts the gear's dedendum.",
        ),
        Key::number(
            "dedendum_coefficient",
            "modules",
            Range::closed(0.1, 2.5),
            1.25,
            "1.25",
            "Depth of the hob's thread under its pitch cylinder; more than the gear's addendum, or the hob tops the \
            gear.",
        ),
        Key::word(
            "worm",
            &["involute", "straight_sided"],
            "involute",
            "\"involute\"",
            "Flanks of the thread: involute helicoid (ZI), which cuts exact involutes, or straight in the axial \
            section (ZA), which cuts nearly that.",
        ),
        Key::number(
            "tip_radius_mm",
            "mm",
            Range::closed(0.0, 50.0),
            0.0,
            "1.5",
            "Radius of the tip round in the rake face; 0 is a sharp corner, about 0.2 modules is common.",
        ),
        Key::optional(
            "protuberance_height_mm",
            "mm",
            Range::above(0.0, 100.0),
            "no protuberance",
            "4.0",
            "Height below the tip at which a protuberance begins; it undercuts the gear's root for grinding.",
        ),
        Key::number(
            "protuberance_angle_deg",
            "deg",
            Range::closed(0.0, 44.0),
            10.0,
            "10.0",
            "Normal pressure angle of the protuberance, smaller than the flank's.",
        ),
        Key::number(
            "thinning_mm",
            "mm",
            Range::closed(-5.0, 5.0),
            0.0,
            "0.3",
            "Normal thickness taken off every hob tooth on the pitch cylinder, as on a roughing hob.",
        ),
        Key::number(
            "regrind_mm",
            "mm",
            Range::closed(0.0, 50.0),
            0.0,
            "2.0",
            "How much the hob's radius has shrunk by regrinding its rake faces; the lead stays, so the profile \
            changes.",
        ),
        TOOL_RUNOUT,
        TOOL_RUNOUT_ANGLE,
        TOOL_WOBBLE,
        TOOL_WOBBLE_ANGLE,
        Key {
            name: "pitch_errors_um",
            kind: Kind::Numbers { range: Range::closed(-1000.0, 1000.0), most: 480 },
            unit: "um",
            default: Default::EmptyList,
            example: "[]",
            teach: "How far the hob's teeth stand off their thread along its axis, towards the end where uncut work \
                arrives: one value per gash in the order of their cuts, from the gash at the hob's angle 0 on, or one \
                for each gash of each thread, thread after thread, or none.",
        },
    ],
    groups: &[Group { names: &["lead_angle_deg", "reference_diameter_mm"], required: true }],
    teach: "Hob; module and pressure angle are the gear's, in the normal section.",
}];
