//! Keys of the machines: the cradle machine's settings and their errors, the six-axis machine, limits of its axes.

use crate::machine::AxisKind;
use crate::scene::keys::machine_errors::{WORK, X, Y, linear, rotary};
use crate::scene::keys::{Default, Group, Key, KeySection, Kind, Range, Role};

/// Axes with errors, by the last names of their sections, in the machine's order.
pub const AXES: [(&str, AxisKind); 5] = [
    ("x", AxisKind::Linear),
    ("y", AxisKind::Linear),
    ("z", AxisKind::Linear),
    ("work", AxisKind::Rotary),
    ("swing", AxisKind::Rotary),
];

/// A length that is 0 unless it is written.
const fn length(name: &'static str, example: &'static str, teach: &'static str) -> Key {
    Key::number(name, "mm", Range::closed(-500.0, 500.0), 0.0, example, teach)
}

/// An end of an axis's travel.
const fn end(name: &'static str, unit: &'static str, example: &'static str, teach: &'static str) -> Key {
    Key::optional(name, unit, Range::closed(-5000.0, 5000.0), "not limited", example, teach)
}

/// `[machine.cradle]`, `[machine.cradle_errors]`, `[machine.five_axis]`, `[machine.bevel_limits]`.
pub(super) static SECTIONS: &[KeySection] = &[
    KeySection {
        path: "machine.cradle",
        role: Role::Plain,
        keys: &[
            Key {
                name: "radial_setting_mm",
                kind: Kind::Number(Range::above(0.0, 1000.0)),
                unit: "mm",
                default: Default::OneOfGroup,
                example: "70.878",
                teach: "Radial setting S_r: distance of the head's axis from the cradle's.",
            },
            Key {
                name: "cradle_angle_deg",
                kind: Kind::Number(Range::closed(-180.0, 180.0)),
                unit: "deg",
                default: Default::OneOfGroup,
                example: "61.722",
                teach: "Cradle angle q in the middle of the roll, or at rest; its sign chooses the hand of the spiral, \
                    positive is right-hand.",
            },
            Key {
                name: "spiral_angle_deg",
                kind: Kind::Number(Range::closed(-60.0, 60.0)),
                unit: "deg",
                default: Default::OneOfGroup,
                example: "35.0",
                teach: "Mean spiral angle in place of radial setting and cradle angle: both follow from it, the blank \
                    and tool.face_mill.radius_mm. Positive is right-hand; 0 is a Zerol gear.",
            },
            length("blank_offset_mm", "0.0", "Blank offset E_m; 0 on spiral bevel gears."),
            length("cross_shift_mm", "0.0", "X_B as the five-linkage paper draws it, along the machine's x axis."),
            Key::optional(
                "sliding_base_mm",
                "mm",
                Range::closed(-500.0, 500.0),
                "0; with spiral_angle_deg what brings the blades' tips to the root cone",
                "0.0",
                "Sliding base: how much deeper the head is set along the cradle's axis.",
            ),
            length("center_to_back_mm", "0.0", "Machine centre to back X_p: how far the work is set back."),
            Key::optional(
                "root_angle_deg",
                "deg",
                Range::above(0.0, 89.9),
                "the blank's root angle",
                "41.025",
                "Machine root angle gamma_m.",
            ),
            Key::number(
                "tilt_deg",
                "deg",
                Range::closed(0.0, 45.0),
                0.0,
                "0.0",
                "Tilt i of the head's axis against the cradle's, about the middle of the plane of the tips.",
            ),
            Key::number(
                "swivel_deg",
                "deg",
                Range::closed(-180.0, 180.0),
                0.0,
                "0.0",
                "Swivel j: direction to which the head leans with its end at the work, from the line of the radial \
                setting; it turns with the cradle.",
            ),
            Key::optional(
                "roll_ratio",
                "",
                Range::closed(0.0, 100.0),
                "that of a crown gear in the plane of the root cone",
                "1.4647",
                "Ratio of roll R_a: work angle per cradle angle. With 0 the gear is not generated (Formate): cradle \
                 and work rest, the head plunges into each slot, and its cones are the flanks.",
            ),
            Key::number(
                "modified_roll_c",
                "",
                Range::closed(-5.0, 5.0),
                0.0,
                "0.0",
                "Coefficient C of the modified roll, per rad: the work turns by R_a (d - C d^2 - D d^3) while the \
                cradle turns by d from the middle of the roll.",
            ),
            Key::number(
                "modified_roll_d",
                "",
                Range::closed(-50.0, 50.0),
                0.0,
                "0.0",
                "Coefficient D of the modified roll, per rad squared.",
            ),
        ],
        groups: &[
            Group { names: &["radial_setting_mm", "spiral_angle_deg"], required: true },
            Group { names: &["cradle_angle_deg", "spiral_angle_deg"], required: true },
        ],
        teach: "Settings of a cradle machine for bevel gears; the six-axis machine follows from them.",
    },
    KeySection::new(
        "machine.cradle_errors",
        Role::Plain,
        &[
            length("radial_setting_mm", "0.02", "Error of the radial setting."),
            Key::number(
                "cradle_angle_deg",
                "deg",
                Range::closed(-5.0, 5.0),
                0.0,
                "0.02",
                "Error of the cradle angle; an even roll takes it away.",
            ),
            length("blank_offset_mm", "0.02", "Error of the blank offset."),
            length("sliding_base_mm", "0.02", "Error of the sliding base."),
            length("center_to_back_mm", "0.02", "Error of machine centre to back."),
            Key::number("root_angle_deg", "deg", Range::closed(-5.0, 5.0), 0.0, "0.02", "Error of the root angle."),
            Key::number("roll_ratio", "", Range::closed(-0.1, 0.1), 0.0, "0.0005", "Error of the ratio of roll."),
            Key::number(
                "tilt_deg",
                "deg",
                Range::closed(-5.0, 5.0),
                0.0,
                "0.02",
                "Error of the tilt, towards the swivel's direction; an upright head may have one too.",
            ),
            Key::number(
                "swivel_deg",
                "deg",
                Range::closed(-5.0, 5.0),
                0.0,
                "0.02",
                "Error of the swivel; an upright head has none.",
            ),
        ],
        "Errors of a machine that is not set as it should be: it cuts with settings and errors together, and \
            the target is that of the settings alone.",
    ),
    KeySection::new(
        "machine.five_axis",
        Role::Plain,
        &[Key::number(
            "mounting_distance_mm",
            "mm",
            Range::closed(-1000.0, 1000.0),
            100.0,
            "100.0",
            "Mounting distance x_e from the swing axis B to the apex of the work, fixed on the machine.",
        )],
        "The six-axis machine of bevel gears: X, Y, Z, A and B are linked, C turns the head.",
    ),
    KeySection::new(
        "machine.bevel_limits",
        Role::Plain,
        &[
            Key::limit("x_speed_mm_per_s", "mm/s", "200.0", "Largest speed of X."),
            Key::limit("y_speed_mm_per_s", "mm/s", "200.0", "Largest speed of Y."),
            Key::limit("z_speed_mm_per_s", "mm/s", "200.0", "Largest speed of Z."),
            Key::limit("a_speed_deg_per_s", "deg/s", "120.0", "Largest speed of the work spindle A."),
            Key::limit("b_speed_deg_per_s", "deg/s", "30.0", "Largest speed of the swing B."),
            Key::limit("x_acceleration_mm_per_s2", "mm/s^2", "1000.0", "Largest acceleration of X."),
            Key::limit("y_acceleration_mm_per_s2", "mm/s^2", "1000.0", "Largest acceleration of Y."),
            Key::limit("z_acceleration_mm_per_s2", "mm/s^2", "1000.0", "Largest acceleration of Z."),
            Key::limit("a_acceleration_deg_per_s2", "deg/s^2", "500.0", "Largest acceleration of A."),
            Key::limit("b_acceleration_deg_per_s2", "deg/s^2", "200.0", "Largest acceleration of B."),
            end("x_from_mm", "mm", "-250.0", "Lowest position of X."),
            end("x_to_mm", "mm", "250.0", "Highest position of X."),
            end("y_from_mm", "mm", "-250.0", "Lowest position of Y."),
            end("y_to_mm", "mm", "250.0", "Highest position of Y."),
            end("z_from_mm", "mm", "-100.0", "Lowest position of Z."),
            end("z_to_mm", "mm", "500.0", "Highest position of Z."),
            end("b_from_deg", "deg", "-10.0", "Smallest angle of the swing B."),
            end("b_to_deg", "deg", "100.0", "Largest angle of the swing B."),
        ],
        "Largest speeds and accelerations of the linked axes of a six-axis bevel machine, and how far they \
            travel, where known. They hold for a slot's motion; the way back and the indexing are left to the control.",
    ),
    X,
    Y,
    linear("machine.errors.z", "Errors of the slide Z, along the head's axis."),
    WORK,
    rotary("machine.errors.swing", "Errors of the swing axis B."),
];
