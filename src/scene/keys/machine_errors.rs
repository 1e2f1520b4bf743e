//! Keys of what is wrong with machine and clamping: the work on its spindle, each axis, the guide along the work.
//!
//! Sections of axes stand with the processes that have the axes; [`rotary`] and [`linear`] give them their keys.

use super::{Default, Key, KeySection, Kind, Range, Role};

/// What holds without a key.
const NONE: &str = "no error";
/// Most waves of an axis.
const MOST_WAVES: usize = 100;

/// A number of any sign that may be left out.
const fn number(name: &'static str, unit: &'static str, most: f64, example: &'static str, teach: &'static str) -> Key {
    Key::optional(name, unit, Range::closed(-most, most), NONE, example, teach)
}

/// A number that is not negative and may be left out.
const fn amount(name: &'static str, unit: &'static str, most: f64, example: &'static str, teach: &'static str) -> Key {
    Key::optional(name, unit, Range::closed(0.0, most), NONE, example, teach)
}

const fn list(name: &'static str, unit: &'static str, range: Range, example: &'static str, teach: &'static str) -> Key {
    Key { name, kind: Kind::Numbers { range, most: MOST_WAVES }, unit, default: Default::EmptyList, example, teach }
}

const DIRECTION: Range = Range::closed(-360.0, 360.0);

const PHASES: Key = list(
    "periodic_phases_deg",
    "deg",
    DIRECTION,
    "[0.0, 90.0]",
    "Phase phi of each wave; 0 for all where the list is empty.",
);
const VELOCITY_GAIN: Key = Key::optional(
    "velocity_gain_per_s",
    "1/s",
    Range::closed(1.0, 10_000.0),
    "no lag",
    "40.0",
    "Velocity gain K_v of the position loop: at constant speed v the axis lags by v / K_v. 1 m/min per mm is 16.7.",
);
const FEED_FORWARD: Key = amount(
    "feed_forward",
    "",
    1.0,
    "0.9",
    "Share of the commanded speed that is fed forward; what is left of the lag is 1 less it.",
);
const SPEED_LOOP: Key = amount(
    "speed_loop_ms",
    "ms",
    1000.0,
    "5.0",
    "Time constant of the speed loop under the position loop: the axis then follows like a second-order element.",
);
const CYCLE: Key = Key::optional(
    "gearbox_cycle_ms",
    "ms",
    Range::above(0.0, 100.0),
    "commands without interruption",
    "2.0",
    "Cycle of the electronic gearbox: commands come once in a cycle and are reached in the next, straight between.",
);
const BANDWIDTH: Key = Key::optional(
    "noise_bandwidth_hz",
    "Hz",
    Range::closed(1e-6, 1e6),
    "a new value for every stroke",
    "0.2",
    "Bandwidth f_c of the noise, first order: its values at times dt apart have the correlation exp(-2 pi f_c dt).",
);
const SETTLING: Key = Key::optional(
    "drift_time_constant_min",
    "min",
    Range::above(0.0, 10_000.0),
    "the drift goes on evenly",
    "30.0",
    "Time constant with which the drift settles as the machine warms up.",
);

static ROTARY: &[Key] = &[
    list(
        "periodic_orders",
        "1/turn",
        Range::above(0.0, 1000.0),
        "[1.0, 2.0]",
        "Waves per turn of each periodic error A sin(order x angle + phi).",
    ),
    list("periodic_amplitudes_arcsec", "arcsec", Range::closed(-3600.0, 3600.0), "[5.0, 1.5]", "Amplitude A of each."),
    PHASES,
    amount("backlash_arcsec", "arcsec", 36_000.0, "10.0", "Play between drive and axis, felt where it turns back."),
    VELOCITY_GAIN,
    FEED_FORWARD,
    SPEED_LOOP,
    CYCLE,
    amount(
        "gearbox_increment_arcsec",
        "arcsec",
        3600.0,
        "1.0",
        "Step to which commands are rounded; needs gearbox_cycle_ms.",
    ),
    amount("noise_arcsec", "arcsec", 3600.0, "2.0", "Standard deviation of what the axis does at random."),
    BANDWIDTH,
];

static LINEAR: &[Key] = &[
    number("scale_um_per_m", "um/m", 10_000.0, "15.0", "How much further than commanded the axis moves, from 0 on."),
    list(
        "periodic_lengths_mm",
        "mm",
        Range::above(0.0, 10_000.0),
        "[10.0, 5.0]",
        "Wavelength of each periodic error A sin(2 pi position / length + phi), such as the lead of a screw.",
    ),
    list("periodic_amplitudes_um", "um", Range::closed(-1000.0, 1000.0), "[2.0, 0.5]", "Amplitude A of each."),
    PHASES,
    amount("backlash_um", "um", 10_000.0, "4.0", "Play between drive and axis, felt where it turns back."),
    VELOCITY_GAIN,
    FEED_FORWARD,
    SPEED_LOOP,
    CYCLE,
    amount("gearbox_increment_um", "um", 1000.0, "0.1", "Step to which commands are rounded; needs gearbox_cycle_ms."),
    number(
        "drift_um_per_h",
        "um/h",
        100_000.0,
        "60.0",
        "How fast the axis drifts from the beginning of the first operation on, as the machine warms up.",
    ),
    SETTLING,
    amount("noise_um", "um", 1000.0, "0.5", "Standard deviation of what the axis does at random."),
    BANDWIDTH,
];

/// Errors of a rotary axis.
pub const fn rotary(path: &'static str, teach: &'static str) -> KeySection {
    KeySection { path, role: Role::Plain, keys: ROTARY, groups: &[], teach }
}

/// Errors of a linear axis.
pub const fn linear(path: &'static str, teach: &'static str) -> KeySection {
    KeySection { path, role: Role::Plain, keys: LINEAR, groups: &[], teach }
}

/// Errors of the work spindle, which all machines have.
pub const WORK: KeySection = rotary("machine.errors.work", "Errors of the work spindle.");

/// Errors of the slide X of hobbing and bevel machines.
pub const X: KeySection =
    linear("machine.errors.x", "Errors of the slide X: on hobbing machines tangential, along the rack's pitch line.");
/// Errors of their slide Y.
pub const Y: KeySection =
    linear("machine.errors.y", "Errors of the slide Y: on hobbing machines radial, it sets the centre distance.");

/// Errors of the guide along the gear's axis.
pub const GUIDE: KeySection = KeySection::new(
    "machine.errors.guide",
    Role::Plain,
    &[
        number(
            "radial_um_per_100mm",
            "um/100 mm",
            10_000.0,
            "5.0",
            "How much the tool moves away from the gear's axis while it rises along the gear's z axis.",
        ),
        number(
            "tangential_um_per_100mm",
            "um/100 mm",
            10_000.0,
            "5.0",
            "How much it moves sideways then, counter-clockwise about the gear's axis.",
        ),
        number(
            "radial_bow_um",
            "um",
            1000.0,
            "2.0",
            "How much further it is from the gear's axis at both ends of the face than in the middle; a parabola.",
        ),
        number("tangential_bow_um", "um", 1000.0, "2.0", "The same sideways."),
    ],
    "How the guide along the gear's axis (ram or slide) runs against that axis: out of parallel, not straight.",
);

/// How a tool that turns in space sits on its spindle: runout, its direction, wobble, its direction.
pub const TOOL_RUNOUT: Key =
    amount("runout_um", "um", 1000.0, "8.0", "Distance of the tool's axis from its spindle's, at the tool's middle.");
/// Its direction.
pub const TOOL_RUNOUT_ANGLE: Key =
    Key::optional("runout_angle_deg", "deg", DIRECTION, "0", "0.0", "Direction of that runout, from the first blade.");
/// The wobble of a tool.
pub const TOOL_WOBBLE: Key = amount(
    "wobble_um_per_100mm",
    "um/100 mm",
    10_000.0,
    "10.0",
    "How much the tool's axis leans against its spindle's.",
);
/// Its direction.
pub const TOOL_WOBBLE_ANGLE: Key = Key::optional(
    "wobble_angle_deg",
    "deg",
    DIRECTION,
    "0",
    "0.0",
    "Direction in which it leans, from the first blade.",
);

/// `[machine.errors]`, which holds what processes list, and `[mounting]`.
pub(super) static SECTIONS: &[KeySection] = &[
    KeySection::new(
        "machine.errors",
        Role::Plain,
        &[Key {
            name: "seed",
            kind: Kind::Whole { min: 0, max: u32::MAX },
            unit: "",
            default: Default::Whole(1),
            example: "1",
            teach: "Which noise is cut: equal seeds make equal gears, another one makes another gear of the machine.",
        }],
        "What is wrong with the machine: the cut follows what its axes really do, the target stays the \
            ideal one.",
    ),
    KeySection::new(
        "mounting",
        Role::Plain,
        &[
            amount(
                "eccentricity_um",
                "um",
                1000.0,
                "10.0",
                "Distance of the gear's axis from that of the work spindle, in the middle of the face.",
            ),
            Key::optional(
                "eccentricity_angle_deg",
                "deg",
                DIRECTION,
                "0",
                "30.0",
                "Direction of the gear's axis from the spindle's, counted from phi = 0 of the gear.",
            ),
            amount(
                "wobble_um_per_100mm",
                "um/100 mm",
                10_000.0,
                "10.0",
                "How much the gear's axis leans against that of the work spindle.",
            ),
            Key::optional(
                "wobble_angle_deg",
                "deg",
                DIRECTION,
                "0",
                "30.0",
                "Direction in which it leans along its z axis, counted from phi = 0 of the gear.",
            ),
            number(
                "axial_offset_um",
                "um",
                10_000.0,
                "20.0",
                "How far the gear sits too high along its z axis: in bevel cutting an error of the mounting distance.",
            ),
        ],
        "How the work sits on its spindle. The gear is measured about its own axis.",
    ),
];
