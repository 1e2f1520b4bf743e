//! Errors that scenes of a process can name, as tables of numbers that can be shifted a little.
//!
//! A line for each error key, in the shared lists here and in each process: its keys, how they become numbers, unit,
//! natural step, what it is. A new error key joins by its line. [`super::error_parameters`] makes the numbers of a
//! scene from them. Road not taken: every number among the keys of a scene. Most of them say what is to be cut, and a
//! key alone does not tell how large a usual error is.
//!
//! Some error keys have no line, for nothing has a derivative by them. Commands that are **rounded** jump from
//! step to step, wherever the increments come to lie. The **bandwidth** of a noise and the length over which stock
//! scatters stretch a course that is rough at every scale: a little stretched, all of it is another course. The
//! **correlation length** of a rough edge stretches it too, so that a place 6 mm from the tip has another part of it
//! after a change of a hundredth. What they do shows between two runs of many seeds.

use crate::machine::AxisKind;

/// An error that scenes of a process can name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorSource {
    /// Section of its keys; `operation[]` stands for each operation.
    pub section: &'static str,
    /// Its keys in that section, and how they become parameters.
    pub form: KeyForm,
    /// Unit of its parameters.
    pub unit: &'static str,
    /// Natural step, in that unit: of the size that such an error has on a good machine, and far above rounding.
    pub step: f64,
    /// What it is, in a few words.
    pub what: &'static str,
    /// When it is shifted.
    pub tried: Tried,
    /// Key of the same section without which it means nothing: scenes that do not write it have no such parameter.
    pub needs: Option<&'static str>,
}

/// When an error is shifted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tried {
    /// Among all errors.
    Always,
    /// Among all errors where the scene has its key, and where its section or key is named: what the cut itself does,
    /// which not every scene asks for.
    WhereItIs,
    /// Where its key is named: the size of something random. The seed stays, so that what the shift does is not hidden
    /// by what another seed would do (common random numbers); the influence is that of this seed.
    ByName,
}

/// How the keys of an error become parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KeyForm {
    /// A number of any sign.
    Number(&'static str),
    /// A number that is not negative.
    Amount(&'static str),
    /// A number above 0 that a scene without the key does not have.
    Positive(&'static str),
    /// A share from 0 to 1, 0 without the key; shifted by no more than what is missing from 1, where all of it is
    /// there not at all.
    Share(&'static str),
    /// A share from 0 to 1, 1 without the key, as what is missing from it.
    Missing(&'static str),
    /// A size and its direction, deg: parts along 0 and 90 degrees.
    Vector {
        /// Key of the size.
        size: &'static str,
        /// Key of the direction.
        angle: &'static str,
    },
    /// Waves in lists: sine and cosine part of each. Their keys follow from the kind of the axis.
    Waves {
        /// Orders or lengths that are tried beside those that the scene names.
        natural: &'static [f64],
    },
    /// The velocity gain of a drive, as its time lag 1000 / K_v, ms; 0 without the key.
    Lag,
    /// A list with an entry for each of so many blades.
    Entries {
        /// Key of the list.
        list: &'static str,
        /// Key of the number of entries, in the same section.
        count: &'static str,
    },
}

impl ErrorSource {
    /// An error that is tried among all.
    pub const fn new(section: &'static str, form: KeyForm, unit: &'static str, step: f64, what: &'static str) -> Self {
        Self { section, form, unit, step, what, tried: Tried::Always, needs: None }
    }

    /// The same, tried at other times.
    #[must_use]
    pub const fn tried(self, tried: Tried) -> Self {
        Self { tried, ..self }
    }

    /// The same for scenes that write another key of its section.
    #[must_use]
    pub const fn needs(self, key: &'static str) -> Self {
        Self { needs: Some(key), ..self }
    }
}

const fn line(section: &'static str, form: KeyForm, unit: &'static str, step: f64, what: &'static str) -> ErrorSource {
    ErrorSource::new(section, form, unit, step, what)
}

const fn vector(
    section: &'static str,
    [size, angle]: [&'static str; 2],
    unit: &'static str,
    step: f64,
    what: &'static str,
) -> ErrorSource {
    line(section, KeyForm::Vector { size, angle }, unit, step, what)
}

/// Keys of a runout, and of a wobble.
const RUNOUT: [&str; 2] = ["runout_um", "runout_angle_deg"];
const WOBBLE: [&str; 2] = ["wobble_um_per_100mm", "wobble_angle_deg"];

/// Runout of the tool whose section this is.
pub const fn runout(section: &'static str) -> ErrorSource {
    vector(section, RUNOUT, "um", 4.0, "tool runout")
}

/// Wobble of the tool whose section this is.
pub const fn wobble(section: &'static str) -> ErrorSource {
    vector(section, WOBBLE, "um/100 mm", 10.0, "tool wobble")
}

/// How the work sits on its spindle.
pub static MOUNTING: &[ErrorSource] = &[
    vector("mounting", ["eccentricity_um", "eccentricity_angle_deg"], "um", 4.0, "work eccentricity"),
    vector("mounting", WOBBLE, "um/100 mm", 10.0, "work wobble"),
    line("mounting", KeyForm::Number("axial_offset_um"), "um", 20.0, "work axial offset"),
];

/// How the guide along the gear's axis runs.
pub static GUIDE: &[ErrorSource] = &[
    line("machine.errors.guide", KeyForm::Number("radial_um_per_100mm"), "um/100 mm", 20.0, "guide: radial slope"),
    line(
        "machine.errors.guide",
        KeyForm::Number("tangential_um_per_100mm"),
        "um/100 mm",
        20.0,
        "guide: tangential slope",
    ),
    line("machine.errors.guide", KeyForm::Number("radial_bow_um"), "um", 2.0, "guide: radial bow"),
    line("machine.errors.guide", KeyForm::Number("tangential_bow_um"), "um", 2.0, "guide: tangential bow"),
];

/// How the drive of an axis follows its command, beside the lag itself. Without a lag there is nothing to feed forward,
/// and no loop under it.
const FEED_FORWARD: ErrorSource =
    line("", KeyForm::Share("feed_forward"), "1", 0.05, "share fed forward").needs(VELOCITY_GAIN);
const SPEED_LOOP: ErrorSource =
    line("", KeyForm::Amount("speed_loop_ms"), "ms", 1.0, "speed loop").needs(VELOCITY_GAIN);
const VELOCITY_GAIN: &str = "velocity_gain_per_s";

/// Errors of a rotary axis, its section left empty. Once and twice a turn: eccentric and leaning wheels and scales.
static ROTARY: &[ErrorSource] = &[
    line("", KeyForm::Waves { natural: &[1.0, 2.0] }, "arcsec", 5.0, "wave"),
    line("", KeyForm::Amount("backlash_arcsec"), "arcsec", 5.0, "backlash"),
    line("", KeyForm::Lag, "ms", 2.0, "lag"),
    FEED_FORWARD,
    SPEED_LOOP,
    line("", KeyForm::Amount("gearbox_cycle_ms"), "ms", 2.0, "gearbox cycle"),
    line("", KeyForm::Amount("noise_arcsec"), "arcsec", 1.0, "noise").tried(Tried::ByName),
];

/// Errors of a linear axis, its section left empty. The leads of its screws are known to its scene alone.
static LINEAR: &[ErrorSource] = &[
    line("", KeyForm::Number("scale_um_per_m"), "um/m", 20.0, "scale"),
    line("", KeyForm::Waves { natural: &[] }, "um", 2.0, "wave"),
    line("", KeyForm::Amount("backlash_um"), "um", 4.0, "backlash"),
    line("", KeyForm::Lag, "ms", 2.0, "lag"),
    FEED_FORWARD,
    SPEED_LOOP,
    line("", KeyForm::Amount("gearbox_cycle_ms"), "ms", 2.0, "gearbox cycle"),
    line("", KeyForm::Number("drift_um_per_h"), "um/h", 60.0, "drift"),
    line("", KeyForm::Positive("drift_time_constant_min"), "min", 1.0, "time constant of the drift")
        .needs("drift_time_constant_min"),
    line("", KeyForm::Amount("noise_um"), "um", 0.5, "noise").tried(Tried::ByName),
];

/// Errors of an axis of a kind, their sections left empty.
pub(super) fn of_axis(kind: AxisKind) -> &'static [ErrorSource] {
    match kind {
        AxisKind::Rotary => ROTARY,
        AxisKind::Linear => LINEAR,
    }
}
