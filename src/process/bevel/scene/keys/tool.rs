//! Keys of the face-mill head.

use crate::scene::keys::machine_errors::{TOOL_WOBBLE, TOOL_WOBBLE_ANGLE};
use crate::scene::keys::{Default, Key, KeySection, Kind, Range, Role};

/// `[tool.face_mill]`.
pub(super) static SECTIONS: &[KeySection] = &[KeySection::new(
    "tool.face_mill",
    Role::Variant,
    &[
        Key::optional(
            "radius_mm",
            "mm",
            Range::above(0.0, 1000.0),
            "inferred from the machine's settings",
            "50.0",
            "Mean cutter radius: of the middle of the slot at the tips.",
        ),
        Key {
            name: "point_width_mm",
            kind: Kind::Number(Range::above(0.0, 50.0)),
            unit: "mm",
            default: Default::Required,
            example: "1.5",
            teach: "Point width: from outside to inside cutting edge at the tips.",
        },
        Key::number(
            "outside_blade_angle_deg",
            "deg",
            Range::above(0.0, 45.0),
            20.0,
            "20.0",
            "Angle of the outside blades' cutting edges against the head's axis.",
        ),
        Key::number(
            "inside_blade_angle_deg",
            "deg",
            Range::above(0.0, 45.0),
            20.0,
            "20.0",
            "Angle of the inside blades' cutting edges against the head's axis.",
        ),
        Key::number(
            "corner_radius_mm",
            "mm",
            Range::closed(0.0, 10.0),
            0.0,
            "0.3",
            "Radius of the round at the cutting corners; 0 is sharp.",
        ),
        Key::optional(
            "tip_width_mm",
            "mm",
            Range::above(0.0, 50.0),
            "0.7 point widths",
            "1.0",
            "Width of a blade at its tip: more than half of the point width, so that both kinds together clear the \
            slot.",
        ),
        Key {
            name: "blades",
            kind: Kind::Whole { min: 2, max: 100 },
            unit: "",
            default: Default::Whole(12),
            example: "12",
            teach: "Number of blades; outside and inside ones take turns, the first is an outside blade.",
        },
        Key {
            name: "runouts_um",
            kind: Kind::Numbers { range: Range::closed(-1000.0, 1000.0), most: 100 },
            unit: "um",
            default: Default::EmptyList,
            example: "[]",
            teach: "How far each blade is set out in radius, one number for each; empty: none does.",
        },
        Key::number(
            "start_angle_deg",
            "deg",
            Range::closed(-360.0, 360.0),
            0.0,
            "0.0",
            "Angle of the first blade, from the middle of the first slot, when that slot begins.",
        ),
        TOOL_WOBBLE,
        TOOL_WOBBLE_ANGLE,
    ],
    "Face-mill head with inside and outside blades in turn.",
)];
