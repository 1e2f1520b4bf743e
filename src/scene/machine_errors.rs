//! Checked values of what is wrong with machine and clamping to the model, and what only several of them show.

use super::keys::join;
use super::problems::Found;
use super::values::{Values, View};
use crate::machine::AxisKind;
use crate::machine_errors::{
    AxisErrors, AxisNoise, GearboxCycle, Guide, MachineErrors, NoiseLaw, PeriodicError, Servo, ThermalDrift,
    ToolMounting, WorkMounting,
};
use crate::random::Draws;
use gearcut_core::units::UM_PER_MM;
use std::f64::consts::TAU;

/// Seconds of arc in a radian.
const ARCSEC_PER_RAD: f64 = 180.0 * 3600.0 / std::f64::consts::PI;
const MS_PER_S: f64 = 1000.0;
const S_PER_MIN: f64 = 60.0;
const S_PER_H: f64 = 3600.0;
/// mm per mm for 1 um in 100 mm.
const PER_UM_IN_100MM: f64 = 1e-5;
const BANDWIDTH: &str = "noise_bandwidth_hz";

/// `machine.errors.work` and its like.
pub(super) fn path(stem: &str) -> String {
    format!("machine.errors.{stem}")
}

/// Unit at the end of a key, and how many of it make a rad or mm.
pub(super) fn unit(kind: AxisKind) -> (&'static str, f64) {
    match kind {
        AxisKind::Rotary => ("arcsec", ARCSEC_PER_RAD),
        AxisKind::Linear => ("um", UM_PER_MM),
    }
}

/// Key with the waves' orders or lengths.
pub(super) fn waves(kind: AxisKind) -> &'static str {
    match kind {
        AxisKind::Rotary => "periodic_orders",
        AxisKind::Linear => "periodic_lengths_mm",
    }
}

/// Errors of a machine whose axes have sections of these names.
pub(crate) fn machine_errors<const N: usize>(
    values: &Values,
    axes: &[(&str, AxisKind); N],
) -> Option<MachineErrors<N>> {
    let seed = values.view("machine.errors").whole("seed")?;
    let read: Option<Vec<AxisErrors>> = (0..)
        .zip(axes)
        .map(|(number, &(stem, kind))| axis_errors(values, stem, kind, Draws::new(seed, number)))
        .collect();
    Some(MachineErrors { axes: read?.try_into().ok()?, guide: guide(values), mounting: mounting(values) })
}

/// Errors of the axis whose section is `[machine.errors.STEM]`; `draws` are the axis's own.
fn axis_errors(values: &Values, stem: &str, kind: AxisKind, draws: Draws) -> Option<AxisErrors> {
    let path = path(stem);
    let view = values.view(&path);
    let (unit, per_unit) = unit(kind);
    let small = |name: &str| view.number(&format!("{name}_{unit}")).unwrap_or(0.0) / per_unit;
    let phases = view.numbers("periodic_phases_deg")?;
    let amplitudes = view.numbers(&format!("periodic_amplitudes_{unit}"))?;
    let periodic = view.numbers(waves(kind))?.iter().zip(amplitudes).enumerate().map(|(index, (&wave, amplitude))| {
        PeriodicError {
            rate: if kind == AxisKind::Rotary { wave } else { TAU / wave },
            amplitude: amplitude / per_unit,
            phase_rad: phases.get(index).copied().unwrap_or(0.0).to_radians(),
        }
    });
    // What has no size is left out, so that it changes no byte: an axis with errors is worked out another way.
    let servo = view.number("velocity_gain_per_s").map(|velocity_gain_per_s| Servo {
        velocity_gain_per_s,
        feed_forward: view.number("feed_forward").unwrap_or(0.0),
        speed_loop_s: view.number("speed_loop_ms").unwrap_or(0.0) / MS_PER_S,
    });
    Some(AxisErrors {
        scale: view.number("scale_um_per_m").unwrap_or(0.0) * 1e-6,
        periodic: periodic.filter(|wave| wave.amplitude != 0.0).collect(),
        backlash: small("backlash"),
        servo: servo.filter(Servo::lags),
        gearbox: view
            .number("gearbox_cycle_ms")
            .map(|cycle_ms| GearboxCycle { cycle_s: cycle_ms / MS_PER_S, increment: small("gearbox_increment") }),
        drift: view.number("drift_um_per_h").filter(|&um_per_h| um_per_h != 0.0).map(|um_per_h| ThermalDrift {
            per_s: um_per_h / UM_PER_MM / S_PER_H,
            time_constant_s: view.number("drift_time_constant_min").map(|minutes| minutes * S_PER_MIN),
        }),
        noise: (small("noise") > 0.0)
            .then(|| AxisNoise {
                deviation: small("noise"),
                law: match view.number(BANDWIDTH) {
                    Some(bandwidth_hz) => NoiseLaw::InTime { bandwidth_hz },
                    None => NoiseLaw::EachPassage,
                },
                draws,
            })
            .into_iter()
            .collect(),
    })
}

/// How the work sits on its spindle.
fn mounting(values: &Values) -> WorkMounting {
    let view = values.view("mounting");
    let um = |name: &str| view.mm_from_um(name).unwrap_or(0.0);
    let (eccentricity_mm, wobble_rad) = (um("eccentricity_um"), lean(view, "wobble_um_per_100mm"));
    WorkMounting {
        eccentricity_mm,
        eccentricity_angle_rad: direction_rad(view, "eccentricity_angle_deg", eccentricity_mm),
        wobble_rad,
        wobble_angle_rad: direction_rad(view, "wobble_angle_deg", wobble_rad),
        axial_offset_mm: um("axial_offset_um"),
    }
}

/// How the guide along the gear's axis runs.
fn guide(values: &Values) -> Guide {
    let path = path("guide");
    let view = values.view(&path);
    let um = |name: &str| view.mm_from_um(name).unwrap_or(0.0);
    Guide {
        radial_slope: lean(view, "radial_um_per_100mm"),
        tangential_slope: lean(view, "tangential_um_per_100mm"),
        radial_bow_mm: um("radial_bow_um"),
        tangential_bow_mm: um("tangential_bow_um"),
    }
}

/// How a tool that turns in space sits on its spindle.
pub(crate) fn tool_mounting(tool: View<'_>) -> ToolMounting {
    let (runout_mm, wobble_rad) = (tool.mm_from_um("runout_um").unwrap_or(0.0), lean(tool, "wobble_um_per_100mm"));
    ToolMounting {
        runout_mm,
        runout_angle_rad: direction_rad(tool, "runout_angle_deg", runout_mm),
        wobble_rad,
        wobble_angle_rad: direction_rad(tool, "wobble_angle_deg", wobble_rad),
    }
}

/// Direction of an error; 0 where the error has no size, so that a direction alone is no error.
fn direction_rad(view: View<'_>, name: &str, size: f64) -> f64 {
    if size == 0.0 { 0.0 } else { view.rad(name).unwrap_or(0.0) }
}

fn lean(view: View<'_>, name: &str) -> f64 {
    view.number(name).unwrap_or(0.0) * PER_UM_IN_100MM
}

/// Adds a problem for every contradiction in the errors of these axes.
pub(crate) fn check(found: &mut Found<'_, '_, '_>, axes: &[(&str, AxisKind)]) {
    for &(stem, kind) in axes {
        check_axis(found, stem, kind);
    }
}

/// Adds a problem for every axis whose noise is to change from passage to passage of a `tool` that has none: it is in
/// the work all the time.
pub(crate) fn check_noise_in_time(found: &mut Found<'_, '_, '_>, axes: &[(&str, AxisKind)], tool: &str) {
    for &(stem, kind) in axes {
        let path = path(stem);
        let name = format!("noise_{}", unit(kind).0);
        let view = found.view(&path);
        let wrong = view.number(&name).is_some() && view.number(BANDWIDTH).is_none();
        let key = join(&path, &name);
        let message = || format!("`{key}`: {tool} is in the work all the time, its noise needs a bandwidth");
        found.blame(wrong, &key, message, &format!("write {BANDWIDTH} as well"));
    }
}

fn check_axis(found: &mut Found, stem: &str, kind: AxisKind) {
    let path = path(stem);
    let view = found.view(&path);
    let (unit, _) = unit(kind);
    let count = |name: &str| view.numbers(name).map_or(0, <[f64]>::len);
    let (waves, amplitudes) = (waves(kind), format!("periodic_amplitudes_{unit}"));
    let [wanted, given, phases] = [count(waves), count(&amplitudes), count("periodic_phases_deg")];
    let key = join(&path, &amplitudes);
    let message = || format!("`{key}` has {given} entries for {wanted} of {waves}");
    found.blame(given != wanted, &key, message, "write one amplitude for each wave");
    let key = join(&path, "periodic_phases_deg");
    let message = || format!("`{key}` has {phases} entries for {wanted} of {waves}");
    let way_out = "write one phase for each wave, or leave the list out";
    found.blame(phases != 0 && phases != wanted, &key, message, way_out);
    let alone = |name: &str, needed: &str| view.number(name).is_some() && view.number(needed).is_none();
    let increment = format!("gearbox_increment_{unit}");
    let noise = format!("noise_{unit}");
    for (name, needed) in [
        ("feed_forward", "velocity_gain_per_s"),
        ("speed_loop_ms", "velocity_gain_per_s"),
        (increment.as_str(), "gearbox_cycle_ms"),
        ("drift_time_constant_min", "drift_um_per_h"),
        (BANDWIDTH, noise.as_str()),
    ] {
        let key = join(&path, name);
        let message = || format!("`{key}` says nothing without {needed}");
        found.blame(alone(name, needed), &key, message, &format!("write {needed} as well, or remove it"));
    }
}
