//! Keys of the hobbing machine: limits of its axes.

use crate::scene::keys::{Key, KeySection, Role};

/// `[machine.hobbing_limits]`.
pub(super) static SECTIONS: &[KeySection] = &[KeySection {
    path: "machine.hobbing_limits",
    role: Role::Plain,
    keys: &[
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
    groups: &[],
    teach: "Largest speeds and accelerations of the axes of a hobbing machine, where known. Slide and shift run at \
        constant feeds; their jumps are left to the control.",
}];
