//! Keys of the hob.

use crate::scene::drawn_profile::TOLERANCE;
use crate::scene::keys::machine_errors::{TOOL_RUNOUT, TOOL_RUNOUT_ANGLE, TOOL_WOBBLE, TOOL_WOBBLE_ANGLE};
use crate::scene::keys::{Default, Group, Key, KeySection, Kind, Range, Role};
use crate::scene::tool_wear;

/// Section of a hob's wear.
pub const WEAR: &str = "tool.hob.wear";

/// Section of a contour in place of a straight-sided basic rack.
pub const PROFILE: &str = "tool.hob.profile";

/// `[tool.hob]` and what it holds.
pub(super) static SECTIONS: &[KeySection] = &[HOB, HOB_PROFILE, tool_wear::section(WEAR)];

const HOB_PROFILE: KeySection = KeySection::new(
    PROFILE,
    Role::Plain,
    &[
        Key {
            name: "file",
            kind: Kind::Path,
            unit: "",
            default: Default::LeftOut("the straight-sided basic rack"),
            example: "\"tooth.csv\"",
            teach: "Contour of one tooth of the basic rack in the normal section, open, from root over tip to root: a \
                table headed x_mm,y_mm (or _um, _in), or a drawing (.dxf; layer TOOTH, if there is one). x runs across \
                the tooth, y from the hob's pitch line outwards along its centre line.",
        },
        TOLERANCE,
    ],
    "Hob tooth that is drawn or measured: any profile, as hob makers draw it, in the normal section. worm = \
        \"involute\" gives the hob the thread that generates with this rack, \"straight_sided\" the contour itself in \
        its axial section. Corners stay corners, by the same rules as on a shaper cutter.",
);

const HOB: KeySection = KeySection {
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
            default: Default::Derived("from the diameter"),
            example: "3.316667",
            teach: "Lead angle of the thread on the pitch cylinder; the pitch radius is K m / (2 sin lead).",
        },
        Key {
            name: "reference_diameter_mm",
            kind: Kind::Number(Range::above(0.0, 1000.0)),
            unit: "mm",
            default: Default::Derived("DIN 8002 by the module, 50 mm at the tips for 1 mm to 140 mm for 10 mm"),
            example: "138.0",
            teach: "Diameter of the pitch cylinder.",
        },
        Key {
            name: "length_mm",
            kind: Kind::Number(Range::above(0.0, 3000.0)),
            unit: "mm",
            default: Default::Derived("DIN 8002 by the module, 25 mm for 1 mm to 160 mm for 10 mm"),
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
        Key {
            name: "tip_radius_mm",
            kind: Kind::Number(Range::closed(0.0, 50.0)),
            unit: "mm",
            default: Default::Derived("0.38 modules (ISO 53), less where clearance or tip have no room for it"),
            example: "1.5",
            teach: "Radius of the tip round in the rake face; 0 is a sharp corner.",
        },
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
        Key::optional(
            "tip_relief_height_mm",
            "mm",
            Range::closed(-50.0, 100.0),
            "no tip relief",
            "1.2",
            "Height over the hob's pitch line, towards its root, from which on its flanks relieve the gear's tips; a \
            place of the gear at the distance c from the pitch point is cut at the height c sin(alpha_t).",
        ),
        Key::number(
            "tip_relief_um",
            "um",
            Range::closed(0.0, 1000.0),
            20.0,
            "20.0",
            "How far the flank bulges from its line, along its normal, at the height of the gear's addendum.",
        ),
        Key::optional(
            "semi_topping_height_mm",
            "mm",
            Range::closed(-50.0, 100.0),
            "no semi-topping",
            "1.6",
            "Height over the hob's pitch line, towards its root, from which on its flanks chamfer the gear's tips.",
        ),
        Key::number(
            "semi_topping_angle_deg",
            "deg",
            Range::closed(5.0, 80.0),
            45.0,
            "45.0",
            "Normal pressure angle of those flanks, larger than the gear's.",
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
            teach: "How far the hob's teeth are off their thread along its axis, towards the end where uncut work \
                arrives: one value per gash in the order of their cuts, from the gash at the hob's angle 0 on, or one \
                for each gash of each thread, thread after thread, or none.",
        },
    ],
    groups: &[Group { names: &["lead_angle_deg", "reference_diameter_mm"], required: false }],
    teach: "Hob; module and pressure angle are the gear's, in the normal section.",
};
