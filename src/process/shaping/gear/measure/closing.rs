//! Where a finishing operation closes: what a gear inspector finds there is the machine's drift, and no fault of teeth.
//!
//! In: the gear as cut. Out: sentences on the largest step, and on the largest single pitch deviation if it is measured
//! between teeth that strokes more than half a turn apart have left.

use super::{FlankReport, GearReport};
use crate::findings::Notice;
use crate::machine_errors::ErrorLayer;
use crate::number_text::significant;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::notices::{ClosingPitch, ClosingStep};
use crate::process::shaping::scene::model::Shaping;
use crate::scene::ProcessPart as _;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// A step of a micrometre is more than scallops are, and seen in every profile trace.
const LEAST_STEP_MM: f64 = 1e-3;

/// The sentences.
pub fn warnings(job: &ShapingJob, report: &GearReport) -> Vec<Notice> {
    step(job, report).into_iter().chain(pitch(job, report)).collect()
}

fn step(job: &ShapingJob, report: &GearReport) -> Option<Notice> {
    let steps = report.flanks.iter().filter_map(|flank| Some((flank, flank.own.witness?)));
    let (flank, step) = steps.max_by(|a, b| a.1.value_mm.abs().total_cmp(&b.1.value_mm.abs()))?;
    (step.value_mm.abs() > LEAST_STEP_MM).then(|| {
        let closing = ClosingStep {
            operation: &job.finishing().spec.name,
            tooth: flank.tooth,
            side: flank.side.name(),
            step_um: significant(UM_PER_MM * step.value_mm.abs(), 3),
            way: if step.value_mm < 0.0 { "deeper than" } else { "above" },
            causes: causes(job),
        };
        closing.notice()
    })
}

/// The largest single pitch deviation, if strokes of different turns made it.
fn pitch(job: &ShapingJob, report: &GearReport) -> Option<Notice> {
    let of_side = |(side, index): (Side, usize)| {
        let single_mm = &report.inspection.pitch[index].as_ref()?.single_mm;
        let worst = (0..single_mm.len()).max_by(|&a, &b| single_mm[a].abs().total_cmp(&single_mm[b].abs()))?;
        Some((side, worst, single_mm[worst]))
    };
    let sides = [(Side::Left, 0), (Side::Right, 1)].into_iter().filter_map(of_side);
    let (side, worst, single_mm) = sides.max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()))?;
    let teeth = job.scene.gear.teeth;
    let tooth = worst as u32 + 1;
    let before = match worst {
        0 if job.curve.sector_rad().is_some() => return None,
        0 => teeth,
        _ => tooth - 1,
    };
    let stroke = |tooth: u32| {
        let is_it = |flank: &&FlankReport| flank.tooth == tooth && flank.side == side;
        report.flanks.iter().find(is_it)?.own.pitch_stroke
    };
    let closes = stroke(tooth)?.abs_diff(stroke(before)?) > job.finishing().half_turn();
    (closes && single_mm.abs() > LEAST_STEP_MM).then(|| {
        let (single_um, side) = (significant(UM_PER_MM * single_mm, 3), side.name());
        ClosingPitch { single_um, before, tooth, side, operation: &job.finishing().spec.name, causes: causes(job) }
            .notice()
    })
}

/// What of the scene can part the last strokes of a turn from its first: errors that are not the same turn by turn, or
/// else strokes that come round at other places of the teeth.
fn causes(job: &ShapingJob) -> String {
    let Some(model) = Shaping::of(&job.scene) else { return String::new() };
    let layers = model.error_layers();
    let is_on = |of: &[ErrorLayer]| of.iter().any(|layer| layers.contains(layer));
    let tool = model.tool.runout_mm != 0.0 || model.tool.pitch_errors_mm.iter().any(|&error| error != 0.0);
    let known = [
        (tool, "runout_um and pitch_errors_um of the cutter, which cuts there with another tooth than a turn before"),
        (is_on(&[ErrorLayer::Axes, ErrorLayer::Noise]), "machine.errors"),
        (is_on(&[ErrorLayer::Deflection]), "machine.compliance"),
        (is_on(&[ErrorLayer::Stock]), "the scatter of the stock"),
        (
            is_on(&[ErrorLayer::Edge, ErrorLayer::Ploughing, ErrorLayer::Tearing]),
            "edges of the cutter, which cuts there with another tooth than a turn before",
        ),
    ];
    let named: Vec<&str> = known.iter().filter_map(|&(is_there, words)| is_there.then_some(words)).collect();
    if !named.is_empty() {
        return named.join("; ");
    }
    let (strokes, teeth) = (job.finishing().schedule.strokes_per_revolution(), job.scene.gear.teeth);
    if job.curve.sector_rad().is_none() && !strokes.is_multiple_of(teeth) {
        return format!("strokes_per_revolution: {strokes} for {teeth} teeth are no whole number per tooth");
    }
    "whether more strokes or finer dexels make it smaller: the scene has no error that lasts beyond a turn".to_owned()
}
