//! From what was measured on a hobbed gear to `results.json`: names, units, definitions, places.

use super::HobbedGear;
use crate::error::{Error, Result};
use crate::job::{HobCutter, HobbingJob};
use crate::measure::hobbed_report::HobbedReport;
use crate::output::quantity::{Place, Quantity};
use crate::output::results::{RESULTS_FILE, SCHEMA_VERSION};
use crate::texture::{self, WindowTexture};
use crate::units::UM_PER_MM;
use serde_json::{Value, json};

/// Largest value over all flanks with its flank.
fn largest(gear: &HobbedGear, value: impl Fn(&HobbedReport) -> Option<f64>) -> Option<(f64, &HobbedReport)> {
    gear.flanks.iter().filter_map(|flank| value(flank).map(|v| (v, flank))).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Headline quantities by key.
pub(super) fn headline(job: &HobbingJob, gear: &HobbedGear) -> Vec<(&'static str, Quantity)> {
    let extreme = |value: &dyn Fn(&HobbedReport) -> Option<f64>, definition: &'static str| {
        let found = largest(gear, value);
        let quantity = Quantity::number_or(
            found.map(|(v, _)| v * UM_PER_MM),
            "um",
            definition,
            "a dexel of every evaluated part was reached by no pass",
        );
        match found {
            None => quantity,
            Some((_, flank)) => quantity.at(Place {
                tooth: flank.tooth,
                flank: flank.side.name().into(),
                u_mm: 0.5 * flank.length_mm,
                v_mm: 0.0,
            }),
        }
    };
    let curvatures = job.curve.facts().curvature_extrema.iter().map(|e| e.curvature_per_mm);
    let sharpest = curvatures.fold(0.0, f64::max);
    vec![
        (
            "highest_mark",
            extreme(
                &|f| f.finished.map(|h| h.highest_mm),
                "highest place of the finished surface over the target on the evaluated part of any flank: feed and generating marks together",
            ),
        ),
        (
            "deepest_cut",
            extreme(
                &|f| f.finished.map(|h| -h.lowest_mm),
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
            "undercut_flanks",
            Quantity::count(
                gear.flanks.iter().filter(|f| f.undercut).count() as u64,
                "flanks",
                "flanks whose involute the hob's tip corner has cut away in some section",
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

/// Everything that was found.
///
/// # Errors
/// A value that JSON cannot hold.
pub fn results(cutter: &HobCutter, gear: &HobbedGear, textures: &[WindowTexture]) -> Result<Value> {
    let job = cutter.job;
    let value = |quantity: &Quantity| {
        serde_json::to_value(quantity)
            .map_err(|reason| Error::Output { path: RESULTS_FILE.into(), reason: reason.to_string() })
    };
    let mut head = serde_json::Map::new();
    for (key, quantity) in headline(job, gear) {
        head.insert(key.to_owned(), value(&quantity)?);
    }
    let mut operations = Vec::new();
    for (operation, &passes) in job.operations.iter().zip(&gear.passes) {
        operations.push(json!({
            "name": operation.spec.name,
            "offset": value(&Quantity::number(operation.offset_mm, "mm", "how far the hob stays back from full depth, allowance included"))?,
            "passes": value(&Quantity::count(u64::from(passes), "passes", "teeth times turns of the hob"))?,
            "axial_feed": value(&Quantity::number(operation.spec.axial_feed_mm_per_revolution, "mm", "feed along the gear's axis in the time of one cycle"))?,
            "cycle_time": value(&Quantity::number(operation.linkage.end_s(), "s", "time of the operation"))?,
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
        "texture": texture::results(cutter, textures),
        "candidates": value(&Quantity::number(
            work.stats.dexel_passes as f64 / work.dexels.max(1) as f64,
            "passes",
            "passes visited per dexel and operation; two or three touch it",
        ))?,
    }))
}
