//! Keys of the hobbing machine: limits of its axes, errors of each.

use crate::machine::AxisKind;
use crate::scene::keys::machine_errors::{GUIDE, WORK, X, Y, linear, rotary};
use crate::scene::keys::{Key, KeySection, Role};

/// Axes with errors, by the last names of their sections, in the machine's order.
pub const AXES: [(&str, AxisKind); 6] = [
    ("hob", AxisKind::Rotary),
    ("work", AxisKind::Rotary),
    ("x", AxisKind::Linear),
    ("y", AxisKind::Linear),
    ("slide", AxisKind::Linear),
    ("shift", AxisKind::Linear),
];

/// `[machine.hobbing_limits]`.
pub(super) static SECTIONS: &[KeySection] = &[
    LIMITS,
    rotary("machine.errors.hob", "Errors of the hob spindle."),
    WORK,
    X,
    Y,
    linear("machine.errors.slide", "Errors of the slide Z along the gear's axis."),
    linear("machine.errors.shift", "Errors of the shift along the hob's axis."),
    GUIDE,
];

const LIMITS: KeySection = KeySection::new(
    "machine.hobbing_limits",
    Role::Plain,
    &[
        Key::limit("hob_speed_deg_per_s", "deg/s", "1800.0", "Largest speed of the hob spindle."),
        Key::limit("work_speed_deg_per_s", "deg/s", "120.0", "Largest speed of the work spindle."),
        Key::limit(
            "tangential_speed_mm_per_s",
            "mm/s",
            "200.0",
            "Largest speed of the slide along the rack's pitch line (X).",
        ),
        Key::limit("radial_speed_mm_per_s", "mm/s", "200.0", "Largest speed of the radial slide (Y)."),
        Key::limit("slide_speed_mm_per_s", "mm/s", "100.0", "Largest speed of the slide along the gear's axis (Z)."),
        Key::limit("shift_speed_mm_per_s", "mm/s", "50.0", "Largest speed of the shift along the hob's axis."),
        Key::limit("hob_acceleration_deg_per_s2", "deg/s^2", "5000.0", "Largest acceleration of the hob spindle."),
        Key::limit("work_acceleration_deg_per_s2", "deg/s^2", "500.0", "Largest acceleration of the work spindle."),
        Key::limit("tangential_acceleration_mm_per_s2", "mm/s^2", "1000.0", "Largest acceleration of X."),
        Key::limit("radial_acceleration_mm_per_s2", "mm/s^2", "1000.0", "Largest acceleration of Y."),
    ],
    "Largest speeds and accelerations of the axes of a hobbing machine, where known. Slide and shift run at \
        constant feeds; their jumps are left to the control.",
);
