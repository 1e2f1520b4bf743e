//! What is wrong with the machine, layer by layer, in words: the errors that a cut followed, as findings.
//!
//! In: the errors that all machines may have, and in words what only the process knows. Out: a section with an entry
//! for every layer that is on; none of a machine without errors. What a layer does to the gear is not told here: a cut
//! has all of them at once, and `gearcut scatter` cuts the gear with each alone.

use crate::findings::Section;
use crate::findings::quantities::program::{LAYER, MACHINE_ERRORS, TURN, TURN_ANGLE, TURN_ON_FLANKS};
use crate::machine::{Axis, AxisKind};
use crate::machine_errors::{AxisErrors, ErrorLayer, Guide, MachineErrors, NoiseLaw, ToolMounting, WorkMounting};
use crate::number_text::{number, size, um};
use crate::scene::model::Gear;
use gearcut_core::gear::PitchCurve;
use gearcut_core::units::{TURN_RAD, UM_PER_MM};

/// mm per mm as um in 100 mm.
const UM_IN_100MM: f64 = 1e5;
/// Turns that move flanks by less are rounding, mm.
const LEAST_TURN_MM: f64 = 1e-9;

/// A turn of the finished gear that the zero of the work spindle makes up for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurnTakenOff {
    /// The turn, rad.
    pub turn_rad: f64,
    /// What a radian of it moves left flanks by along their normals, mm.
    pub mm_per_rad: f64,
}

impl TurnTakenOff {
    /// That of a cylindrical gear: its normals point along the pitch circle by the cosines of pressure and helix angle.
    pub fn of_round(turn_rad: f64, gear: &Gear, curve: &PitchCurve) -> Self {
        let along = gear.pressure_angle_rad.cos() * gear.helix_angle_rad.cos();
        Self { turn_rad, mm_per_rad: along * curve.perimeter_mm() / TURN_RAD }
    }

    /// As findings; none where it is rounding.
    fn section(self) -> Option<Section> {
        let on_flanks_mm = self.turn_rad * self.mm_per_rad;
        let entries = || [TURN_ANGLE.of(self.turn_rad.to_degrees()), TURN_ON_FLANKS.of(on_flanks_mm * UM_PER_MM)];
        (on_flanks_mm.abs() > LEAST_TURN_MM).then(|| TURN.section(entries()))
    }
}

/// The layers that are on; `own` has what only the process knows, layer by layer, in words.
pub fn section<const N: usize>(
    errors: &MachineErrors<N>,
    axes: &[Axis; N],
    own: &[(ErrorLayer, String)],
    turn: TurnTakenOff,
) -> Option<Section> {
    let of_axes = |words: fn(&AxisErrors, AxisKind) -> Vec<String>| {
        let named = errors.axes.iter().zip(axes).map(|(of, axis)| (axis.name, words(of, axis.kind).join(", ")));
        let told = named.filter(|(_, words)| !words.is_empty()).map(|(name, words)| format!("{name}: {words}"));
        told.collect::<Vec<_>>().join("; ")
    };
    let of_all_machines = [
        (ErrorLayer::Axes, of_axes(same_in_every_gear)),
        (ErrorLayer::Noise, of_axes(noise)),
        (ErrorLayer::Guide, guide(&errors.guide).join("; ")),
        (ErrorLayer::Mounting, mounting(&errors.mounting).join("; ")),
    ];
    let entry = |layer: &ErrorLayer| {
        let all = of_all_machines.iter().chain(own);
        let words: Vec<&str> =
            all.filter(|(of, words)| of == layer && !words.is_empty()).map(|(_, words)| words.as_str()).collect();
        let entry = (!words.is_empty()).then(|| LAYER.of(words.join("; ")))?;
        let remark = format!(": {}", layer.definition());
        Some(entry.keyed(layer.name()).titled(layer.name().replace('_', " ")).remarked(&remark))
    };
    let section = MACHINE_ERRORS.section(ErrorLayer::ALL.iter().filter_map(entry)).parts(turn.section());
    (!section.entries.is_empty()).then_some(section)
}

/// How a tool sits on its spindle; nothing where it sits well.
pub fn tool_words(tool: &ToolMounting) -> String {
    [um("runout", tool.runout_mm), slope("wobble", tool.wobble_rad)].concat().join(", ")
}

fn slope(name: &str, value: f64) -> Vec<String> {
    size(name, value * UM_IN_100MM, "um in 100 mm")
}

fn guide(guide: &Guide) -> Vec<String> {
    let words = [
        slope("radially", guide.radial_slope),
        slope("sideways", guide.tangential_slope),
        um("bow radially", guide.radial_bow_mm),
        um("bow sideways", guide.tangential_bow_mm),
    ];
    words.concat()
}

fn mounting(mounting: &WorkMounting) -> Vec<String> {
    let words = [
        um("eccentricity", mounting.eccentricity_mm),
        slope("wobble", mounting.wobble_rad),
        um("axial offset", mounting.axial_offset_mm),
    ];
    words.concat()
}

/// Unit of an axis's errors, and how many of it are a radian or a millimetre.
fn unit(kind: AxisKind) -> (&'static str, f64) {
    match kind {
        AxisKind::Rotary => ("arcsec", 1f64.to_degrees() * 3600.0),
        AxisKind::Linear => ("um", UM_PER_MM),
    }
}

fn same_in_every_gear(errors: &AxisErrors, kind: AxisKind) -> Vec<String> {
    let (unit, per_unit) = unit(kind);
    let mut words = size("scale", errors.scale * 1e6, "um/m");
    words.extend(errors.periodic.iter().flat_map(|wave| size("wave of", wave.amplitude * per_unit, unit)));
    words.extend(size("backlash", errors.backlash * per_unit, unit));
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
    words
}

fn noise(errors: &AxisErrors, kind: AxisKind) -> Vec<String> {
    let (unit, per_unit) = unit(kind);
    let one = |noise: &crate::machine_errors::AxisNoise| {
        let law = match noise.law {
            NoiseLaw::EachPassage => "in every stroke".to_owned(),
            NoiseLaw::InTime { bandwidth_hz } | NoiseLaw::AlongFeed { bandwidth_hz } => {
                format!("up to {} Hz", number(bandwidth_hz))
            }
        };
        format!("{} {unit} {law}", number(noise.deviation * per_unit))
    };
    errors.noise.iter().map(one).collect()
}
