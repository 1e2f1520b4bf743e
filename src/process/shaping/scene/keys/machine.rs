//! Keys of the machine around the cut: ram, limits of the axes, errors of each.

use crate::machine::AxisKind;
use crate::process::shaping::scene::model::MachineVibration;
use crate::scene::keys::machine_errors::{GUIDE, WORK, linear, rotary};
use crate::scene::keys::{Addition, Default, Key, KeySection, Kind, Range, Role};

/// Axes with errors, by the last names of their sections, in the machine's order.
pub const AXES: [(&str, AxisKind); 3] =
    [("work", AxisKind::Rotary), ("cutter", AxisKind::Rotary), ("center_distance", AxisKind::Linear)];

/// Keys of `[machine]`.
pub(super) static ADDED: Addition = Addition {
    path: "machine",
    keys: &[
        Key {
            name: "double_strokes_per_minute",
            kind: Kind::Number(Range::closed(0.1, 5000.0)),
            unit: "1/min",
            default: Default::Number(400.0),
            example: "400.0",
            teach: "Speed of the ram: one double stroke is a cutting stroke and its return.",
        },
        Key {
            name: "approach_mm",
            kind: Kind::Number(Range::closed(0.0, 100.0)),
            unit: "mm",
            default: Default::Number(3.0),
            example: "3.0",
            teach: "Travel of the ram above the face before the cut.",
        },
        Key {
            name: "overrun_mm",
            kind: Kind::Number(Range::closed(0.0, 100.0)),
            unit: "mm",
            default: Default::Number(3.0),
            example: "3.0",
            teach: "Travel of the ram below the face after the cut.",
        },
        Key {
            name: "back_off_mm",
            kind: Kind::Number(Range::closed(0.0, 20.0)),
            unit: "mm",
            default: Default::Number(0.5),
            example: "0.5",
            teach: "How far the cutter is lifted off during the return stroke.",
        },
        Key {
            name: "retraction",
            kind: Kind::Word(&["center_line", "normal", "turned", "tilted", "auto"]),
            unit: "",
            default: Default::Word("center_line"),
            example: "\"auto\"",
            teach: "Which way: along the line of centres, by the machine's own relief; or moved by the axes, along \
                the normal of the pitch curve, along the line of centres with the cutter turned as it would roll on, \
                tilted out of the normal so that it clears stock too, or turned only where the line of centres is not \
                clear.",
        },
        Key::optional(
            "guide_lead_mm",
            "mm",
            Range::closed(1.0, 1e6),
            "the lead that the gear's helix needs: 2 pi r_c / tan(helix angle), r_c the cutter's pitch radius",
            "728.29",
            "Lead of the helical guide on the ram, which turns the cutter about its axis once over that much of its \
                way; helical gears alone have one. Another lead than the gear's helix needs cuts another helix.",
        ),
        Key {
            name: "guide_hand",
            kind: Kind::Word(&["right", "left"]),
            unit: "",
            default: Default::LeftOut(
                "the hand that the gear needs: against the gear's outside, the gear's own in a ring",
            ),
            example: "\"left\"",
            teach: "Hand of the helical guide, and of the cutter.",
        },
    ],
    groups: &[],
};

/// What is inside `[machine]`.
pub(super) static SECTIONS: &[KeySection] = &[LIMITS, COMPLIANCE, VIBRATION, WORK, CUTTER, CENTER_DISTANCE, GUIDE];

const CUTTER: KeySection = rotary("machine.errors.cutter", "Errors of the cutter spindle.");
const CENTER_DISTANCE: KeySection =
    linear("machine.errors.center_distance", "Errors of the radial axis, which sets the centre distance.");

/// A compliance: not negative, at most a hundred times that of a slender machine.
const fn compliance(name: &'static str, unit: &'static str, example: &'static str, teach: &'static str) -> Key {
    Key::optional(name, unit, Range::closed(0.0, 10_000.0), "rigid", example, teach)
}

const COMPLIANCE: KeySection = KeySection::new(
    "machine.compliance",
    Role::Plain,
    &[
        compliance(
            "tool_radial_um_per_kn",
            "um/kN",
            "8.0",
            "Compliance of cutter, spindle and ram along the line of centres; 100 N/um are 10 um/kN.",
        ),
        compliance("tool_tangential_um_per_kn", "um/kN", "8.0", "The same across the line of centres."),
        compliance(
            "tool_torsional_urad_per_nm",
            "urad/(N m)",
            "1.0",
            "Turn of the cutter spindle per torque; 1 N m/arcsec are 4.85 urad/(N m).",
        ),
        compliance("work_radial_um_per_kn", "um/kN", "4.0", "Compliance of work, clamping and table along it."),
        compliance("work_tangential_um_per_kn", "um/kN", "4.0", "The same across it."),
        compliance("work_torsional_urad_per_nm", "urad/(N m)", "0.5", "Turn of the work spindle per torque."),
    ],
    "How far cutter and work give way to the forces of the cut, stroke by stroke: deflected strokes leave \
        other flanks. No compliance has a default: measure it, one side fixed and the other one pushed.",
);

/// Section of the mass that vibrates.
pub const VIBRATION_PATH: &str = "machine.vibration";
/// Its keys: each of them says nothing without the others.
pub const VIBRATION_KEYS: [&str; 3] = ["coordinate", "natural_frequency_hz", "damping_ratio"];

const VIBRATION: KeySection = KeySection::new(
    VIBRATION_PATH,
    Role::Plain,
    &[
        Key {
            name: VIBRATION_KEYS[0],
            kind: Kind::Word(&MachineVibration::AXES),
            unit: "",
            default: Default::LeftOut("nothing vibrates"),
            example: "\"tangential\"",
            teach: "Which compliance of cutter and work, both together, is the spring of the mass.",
        },
        Key::optional(
            VIBRATION_KEYS[1],
            "Hz",
            Range::closed(5.0, 5000.0),
            "nothing vibrates",
            "180.0",
            "Natural frequency of that mass, without damping: tap the machine and count.",
        ),
        Key::optional(
            VIBRATION_KEYS[2],
            "",
            Range::closed(1e-4, 0.9),
            "nothing vibrates",
            "0.03",
            "Its damping over the critical damping: the logarithmic decrement over 2 pi, where that is small.",
        ),
    ],
    "Chatter: cutter and work vibrate as one mass on a spring, under the force of the chips that they cut, from the \
        waves of one stroke to those of the next. Off unless all three keys are written; none has a default.",
);

const LIMITS: KeySection = KeySection::new(
    "machine.limits",
    Role::Plain,
    &[
        Key::limit("work_speed_deg_per_s", "deg/s", "60.0", "Largest speed of the work spindle; 1 rpm is 6 deg/s."),
        Key::limit("cutter_speed_deg_per_s", "deg/s", "120.0", "Largest speed of the cutter spindle."),
        Key::limit("center_distance_speed_mm_per_s", "mm/s", "50.0", "Largest speed of the radial axis."),
        Key::limit("work_acceleration_deg_per_s2", "deg/s^2", "600.0", "Largest acceleration of the work spindle."),
        Key::limit(
            "cutter_acceleration_deg_per_s2",
            "deg/s^2",
            "1200.0",
            "Largest acceleration of the cutter spindle.",
        ),
        Key::limit(
            "center_distance_acceleration_mm_per_s2",
            "mm/s^2",
            "500.0",
            "Largest acceleration of the radial axis.",
        ),
        Key::limit(
            "cutting_force_n",
            "N",
            "30000.0",
            "Largest cutting force of the ram; strokes that need more are warned about, without the key those that \
                need more than 40 kN.",
        ),
    ],
    "Largest speeds and accelerations of the axes, with which the peaks of every operation are compared, and \
        the force of the ram.",
);
