//! From what was measured on a hobbed gear to `results.json`: names, units, definitions, places.

use super::{HobbedGear, marks, points};
use crate::axes_report::HobbingAxesReport;
use crate::error::{Error, Result};
use crate::job::{HobCutter, HobbingJob};
use crate::measure::deviation::PitchDeviations;
use crate::measure::hobbed_report::HobbedReport;
use crate::measure::marks::MarkLattice;
use crate::output::quantity::{Place, Quantity};
use crate::output::results::{RESULTS_FILE, SCHEMA_VERSION};
use crate::texture::{self, WindowTexture};
use crate::units::UM_PER_MM;
use serde::Serialize;
use serde_json::{Value, json};

/// Why a pitch is not known.
const NOT_CROSSED: &str = "a flank was not cut or does not cross the pitch curve";

/// Largest value over all flanks with its flank.
fn largest(gear: &HobbedGear, value: impl Fn(&HobbedReport) -> Option<f64>) -> Option<(f64, &HobbedReport)> {
    gear.flanks.iter().filter_map(|flank| value(flank).map(|v| (v, flank))).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Headline quantities by key.
pub(in crate::run) fn headline(job: &HobbingJob, gear: &HobbedGear) -> Vec<(&'static str, Quantity)> {
    type At<'a> = &'a dyn Fn(&HobbedReport) -> Option<[f64; 2]>;
    let extreme_at = |value: &dyn Fn(&HobbedReport) -> Option<f64>, at: At, definition: &'static str| {
        let found = largest(gear, value);
        let quantity = Quantity::number_or(
            found.map(|(v, _)| v * UM_PER_MM),
            "um",
            definition,
            "a dexel of every evaluated part was reached by no pass",
        );
        match found {
            None => quantity,
            Some((_, flank)) => {
                let [u_mm, v_mm] = at(flank).unwrap_or([0.5 * flank.length_mm, 0.0]);
                quantity.at(Place { tooth: flank.tooth, flank: flank.side.name().into(), u_mm, v_mm })
            }
        }
    };
    // Traces stand in the middle of the flank.
    let extreme = |value: &dyn Fn(&HobbedReport) -> Option<f64>, definition: &'static str| {
        extreme_at(value, &|_| None, definition)
    };
    let of_pitch = |pick: fn(&PitchDeviations) -> f64, definition: &'static str| {
        let largest = gear.pitch.iter().flatten().map(pick).reduce(f64::max);
        Quantity::number_or(largest.map(|mm| mm * UM_PER_MM), "um", definition, NOT_CROSSED)
    };
    let sharpest = job.curve.facts().largest_curvature.curvature_per_mm;
    vec![
        (
            "highest_mark",
            extreme_at(
                &|f| f.finished.map(|h| h.highest_mm),
                &|f| f.finished.map(|h| h.extremes_at_mm[1]),
                "highest place of the finished surface over the target on the evaluated part of any flank: feed and generating marks together",
            ),
        ),
        (
            "deepest_cut",
            extreme_at(
                &|f| f.finished.map(|h| -h.lowest_mm),
                &|f| f.finished.map(|h| h.extremes_at_mm[0]),
                "deepest place of the finished surface below the target, positive inwards; an exact linkage leaves none",
            ),
        ),
        (
            "feed_mark_closed_form",
            Quantity::number(
                job.finishing().plan.feed_mark_mm * UM_PER_MM,
                "um",
                "f^2 sin(alpha_n) / (8 R_c) of the last operation, f the feed over cos of the head angle, R_c the hob's smallest contact radius",
            ),
        ),
        (
            "generating_mark_closed_form",
            Quantity::number(
                job.generating_mark_mm(sharpest) * UM_PER_MM,
                "um",
                "arc per gash squared times sin(alpha_t) cos(beta_b) / (8 rho) where the pitch curve bends most",
            ),
        ),
        ("profile_deviation", extreme(&|f| f.profile.map(|d| d.total_mm), "largest F_alpha in the middle of the face")),
        ("helix_deviation", extreme(&|f| f.helix.map(|d| d.total_mm), "largest F_beta in the middle of the profile")),
        (
            "single_pitch_deviation",
            of_pitch(PitchDeviations::largest_single_mm, "largest f_p of either flank, arc of the pitch curve"),
        ),
        (
            "total_pitch_deviation",
            of_pitch(PitchDeviations::total_mm, "F_p, range of the cumulative pitch deviations, larger of both flanks"),
        ),
        (
            "runout",
            Quantity::number_or(
                gear.runout.as_ref().map(|r| r.total_mm() * UM_PER_MM),
                "um",
                "F_r, range of a probe's place along the pitch curve's normal over all spaces",
                NOT_CROSSED,
            ),
        ),
        (
            "undercut_flanks",
            Quantity::count(
                gear.flanks.iter().filter(|f| f.undercut).count() as u64,
                "flanks",
                "flanks whose involute the hob's tip corner has cut away in some section",
            ),
        ),
        (
            "axis_margin",
            Quantity::number_or(
                HobbingAxesReport::of_job(job).iter().filter_map(HobbingAxesReport::smallest_margin).reduce(f64::min),
                "1",
                "what is left of the tightest axis limit, as a share of it",
                "the scene gives no axis limits",
            ),
        ),
        (
            "cycle_time",
            Quantity::number(
                job.operations.iter().map(|o| o.linkage.end_s()).sum(),
                "s",
                "time of all operations, approach, overrun and idle travel included",
            ),
        ),
    ]
}

/// A quantity, or a struct of them, as it stands in `results.json`.
pub(super) fn value(part: &impl Serialize) -> Result<Value> {
    serde_json::to_value(part).map_err(|reason| Error::Output { path: RESULTS_FILE.into(), reason: reason.to_string() })
}

/// Everything that was found.
///
/// # Errors
/// A value that JSON cannot hold.
pub fn results(
    cutter: &HobCutter,
    gear: &HobbedGear,
    textures: &[WindowTexture],
    lattices: &[MarkLattice],
) -> Result<Value> {
    let job = cutter.job;
    let mut head = serde_json::Map::new();
    for (key, quantity) in headline(job, gear) {
        head.insert(key.to_owned(), value(&quantity)?);
    }
    let mut operations = Vec::new();
    let reports = HobbingAxesReport::of_job(job);
    for ((operation, axes), &passes) in job.operations.iter().zip(&reports).zip(&gear.passes) {
        operations.push(json!({
            "name": operation.spec.name,
            "offset": value(&Quantity::number(operation.offset_mm, "mm", "how far the hob stays back from full depth, allowance included"))?,
            "passes": value(&Quantity::count(u64::from(passes), "passes", "teeth times turns of the hob"))?,
            "axial_feed": value(&Quantity::number(operation.spec.axial_feed_mm_per_revolution, "mm", "feed along the gear's axis in the time of one cycle"))?,
            "cycle_time": value(&Quantity::number(operation.linkage.end_s(), "s", "time of the operation"))?,
            "axes": axes.axes_results(),
            "idle_time": value(&Quantity::number(operation.plan.idle_s, "s", "time in which the hob does not cut"))?,
        }));
    }
    let work = &gear.work;
    Ok(json!({
        "schema_version": SCHEMA_VERSION,
        "program": "gearcut",
        "program_version": env!("CARGO_PKG_VERSION"),
        "process": "hobbing",
        "scene": job.scene.name,
        "complete": !work.interrupted,
        "headline": head,
        "operations": operations,
        "offset_curves": points::results(gear),
        "marks": marks::results(lattices),
        "teeth": teeth(job, gear),
        "texture": texture::results(cutter, textures),
        "candidates": value(&Quantity::number(
            work.stats.dexel_passes as f64 / work.dexels.max(1) as f64,
            "passes",
            "passes visited per dexel and operation; two or three touch it",
        ))?,
    }))
}

/// Pitch and thickness of every tooth, middle of the face.
fn teeth(job: &HobbingJob, gear: &HobbedGear) -> Vec<Value> {
    let um = |value: Option<f64>, definition: &'static str| {
        Quantity::number_or(value.map(|mm| mm * UM_PER_MM), "um", definition, NOT_CROSSED)
    };
    (0..job.scene.gear.teeth as usize)
        .map(|row| {
            let side = |index: usize| {
                let pitch = gear.pitch[index].as_ref();
                json!({
                    "single_pitch": um(pitch.map(|p| p.single_mm[row]), "f_p: arc of the pitch curve from the tooth before, less pi m_t"),
                    "cumulative_pitch": um(pitch.map(|p| p.cumulative_mm[row]), "arc of the pitch curve from tooth 1, less its pitches"),
                })
            };
            let thickness = gear.thickness.get(row).copied().flatten();
            json!({
                "index": row + 1,
                "left": side(0),
                "right": side(1),
                "thickness_arc": Quantity::number_or(thickness.map(|t| t.arc_mm), "mm", "tooth thickness along the pitch curve", NOT_CROSSED),
                "thickness_chord": Quantity::number_or(thickness.map(|t| t.chord_mm), "mm", "tooth thickness straight between its crossings with the pitch curve", NOT_CROSSED),
            })
        })
        .collect()
}
