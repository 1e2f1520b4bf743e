//! What is wrong with the machine, in words.

use super::facts::table;
use crate::machine::{Axis, AxisKind};
use crate::machine_errors::{AxisErrors, Guide, MachineErrors, NoiseLaw, ToolMounting, WorkMounting};
use crate::output::report::Block;
use crate::output::text::significant;
use gearcut_core::units::UM_PER_MM;

/// mm per mm as um in 100 mm.
const UM_IN_100MM: f64 = 1e5;

/// The errors that the cut followed, as a table; none on a machine without.
pub fn errors_table<const N: usize>(
    errors: &MachineErrors<N>,
    axes: &[Axis; N],
    tool: Option<ToolMounting>,
) -> Option<Block> {
    let of_axes = errors.axes.iter().zip(axes).filter(|(errors, _)| !errors.is_none());
    let mut rows: Vec<(&str, String)> =
        of_axes.map(|(errors, axis)| (axis.name, axis_words(errors, axis.kind))).collect();
    if !errors.guide.is_none() {
        rows.push(("Guide along the gear", guide_words(&errors.guide)));
    }
    if !errors.mounting.is_none() {
        rows.push(("Work on its spindle", mounting_words(&errors.mounting)));
    }
    if let Some(tool) = tool.filter(|tool| !tool.is_none()) {
        let words = [um("runout", tool.runout_mm), leaning(tool.wobble_rad)];
        rows.push(("Tool on its spindle", words.concat().join(", ")));
    }
    (!rows.is_empty()).then(|| table("Errors of the machine: the cut follows them, the target does not", rows))
}

fn number(value: f64) -> String {
    significant(value, 4).replace('-', "−")
}

/// A length, where it is not 0.
fn um(name: &str, value_mm: f64) -> Vec<String> {
    if value_mm == 0.0 { Vec::new() } else { vec![format!("{name} {} µm", number(value_mm * UM_PER_MM))] }
}

fn slope(name: &str, value: f64) -> Vec<String> {
    if value == 0.0 { Vec::new() } else { vec![format!("{name} {} µm in 100 mm", number(value * UM_IN_100MM))] }
}

fn leaning(wobble_rad: f64) -> Vec<String> {
    slope("wobble", wobble_rad)
}

fn guide_words(guide: &Guide) -> String {
    let words = [
        slope("radially", guide.radial_slope),
        slope("sideways", guide.tangential_slope),
        um("bow radially", guide.radial_bow_mm),
        um("bow sideways", guide.tangential_bow_mm),
    ];
    words.concat().join(", ")
}

fn mounting_words(mounting: &WorkMounting) -> String {
    let words = [
        um("eccentricity", mounting.eccentricity_mm),
        leaning(mounting.wobble_rad),
        um("axial offset", mounting.axial_offset_mm),
    ];
    words.concat().join(", ")
}

fn axis_words(errors: &AxisErrors, kind: AxisKind) -> String {
    let (unit, per_unit) = match kind {
        AxisKind::Rotary => ("″", 1f64.to_degrees() * 3600.0),
        AxisKind::Linear => ("µm", UM_PER_MM),
    };
    let mut words = Vec::new();
    if errors.scale != 0.0 {
        words.push(format!("scale {} µm/m", number(errors.scale * 1e6)));
    }
    for wave in &errors.periodic {
        words.push(format!("wave of {} {unit}", number(wave.amplitude * per_unit)));
    }
    if errors.backlash != 0.0 {
        words.push(format!("backlash {} {unit}", number(errors.backlash * per_unit)));
    }
    if let Some(servo) = errors.servo {
        let forward = 100.0 * servo.feed_forward;
        words.push(format!("K_v {} /s, {} % fed forward", number(servo.velocity_gain_per_s), number(forward)));
    }
    if let Some(gearbox) = errors.gearbox {
        words.push(format!("gearbox cycle {} ms", number(1e3 * gearbox.cycle_s)));
    }
    if let Some(drift) = errors.drift {
        words.push(format!("drift {} {unit}/h at first", number(drift.per_s * per_unit * 3600.0)));
    }
    for noise in &errors.noise {
        let law = match noise.law {
            NoiseLaw::EachPassage => "in every stroke".to_owned(),
            NoiseLaw::InTime { bandwidth_hz } => format!("up to {} Hz", number(bandwidth_hz)),
        };
        words.push(format!("noise {} {unit} {law}", number(noise.deviation * per_unit)));
    }
    words.join(", ")
}
