//! Hobbing scenes: cut and measured flank by flank, and what is written about the gear as a whole.

pub mod blank;
pub mod load;

use self::blank::WholeBlank;
use super::{Work, all_flanks, files};
use crate::cut::{Backend, CutStats};
use crate::error::{Error, Result};
use crate::gear::generation::Side;
use crate::job::{HobCutter, HobbingJob};
use crate::measure::hobbed_report::{self, Heights, HobbedReport};
use crate::output::flank_maps::{FlankMaps, OperationMaps};
use crate::output::folder::OutputFolder;
use crate::output::interrupt::Interrupt;
use crate::output::progress::Progress;
use crate::output::quantity::{Place, Quantity};
use crate::output::results::{RESULTS_FILE, SCHEMA_VERSION};
use crate::output::table::{Cell, write_table};
use crate::output::text::{Sheet, significant};
use crate::units::UM_PER_MM;
use serde_json::{Value, json};
use std::path::Path;
use std::time::{Duration, Instant};

/// A hobbed and measured gear.
#[derive(Debug)]
pub struct HobbedGear {
    /// Finished flanks in order.
    pub flanks: Vec<HobbedReport>,
    /// Their maps at map spacing.
    pub maps: Vec<FlankMaps>,
    /// Passes of every operation.
    pub passes: Vec<u32>,
    /// How much work it was.
    pub work: Work,
}

/// Cuts and measures all flanks; maps go to `folder` as soon as a flank is done.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error: what is finished is returned.
pub fn cut_gear(
    job: &HobbingJob,
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
    folder: Option<(&OutputFolder, &[(String, String)])>,
) -> Result<HobbedGear> {
    let started = Instant::now();
    let cutter = HobCutter::new(job)?;
    let operations = map_operations(job);
    let flanks: Vec<(u32, Side)> =
        (1..=job.scene.gear.teeth).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]).collect();
    let step = progress.step("cut", flanks.len() as u64, "flanks");
    let finished = all_flanks(&flanks, |&(tooth, side)| {
        if interrupt.is_raised() {
            return Ok(None);
        }
        let flank = cutter.cut(backend, tooth, side)?;
        let report = hobbed_report::measure(tooth, side, &flank);
        let places = [flank.arcs_mm.as_slice(), flank.leads_mm.as_slice()];
        let maps = FlankMaps::sample(tooth, side, places, &flank.layers, job.scene.output.map_spacing_mm);
        if let Some((folder, notes)) = folder {
            maps.write(folder, &operations, notes)?;
        }
        step.advance(1);
        Ok(Some((report, maps, flank.stats, (flank.field.len() * flank.layers.len()) as u64)))
    })?;
    step.finish();
    let interrupted = finished.iter().any(Option::is_none);
    let mut gear = HobbedGear {
        flanks: Vec::new(),
        maps: Vec::new(),
        passes: cutter.operations.iter().map(crate::passes::HobTeeth::count).collect(),
        work: Work { stats: CutStats::default(), dexels: 0, elapsed: Duration::ZERO, interrupted },
    };
    for (report, maps, stats, dexels) in finished.into_iter().flatten() {
        gear.flanks.push(report);
        gear.maps.push(maps);
        gear.work.stats += stats;
        gear.work.dexels += dexels;
    }
    gear.work.elapsed = started.elapsed();
    if gear.flanks.is_empty() {
        return Err(Error::Interrupted);
    }
    Ok(gear)
}

fn map_operations(job: &HobbingJob) -> Vec<OperationMaps> {
    let finishing_mm = job.finishing().offset_mm;
    let pressure_angle_rad = job.scene.gear.transverse_pressure_angle_rad();
    job.operations
        .iter()
        .map(|o| OperationMaps::new(&o.spec.name, o.offset_mm - finishing_mm, pressure_angle_rad))
        .collect()
}

/// Writes tables, pictures and results; gives the results. `whole`: the cut blank, unless the run was stopped.
///
/// # Errors
/// Files that cannot be written.
pub fn write(
    job: &HobbingJob,
    gear: &HobbedGear,
    whole: Option<(&HobCutter, &WholeBlank)>,
    folder: &OutputFolder,
) -> Result<Value> {
    write_flank_table(job, gear, &folder.path("tables/flanks.csv")?)?;
    let operations = map_operations(job);
    let last = operations.len() - 1;
    for (index, operation) in operations[..last].iter().enumerate() {
        files::write_stock_sheet(&job.scene.name, operation, index, &gear.maps, folder)?;
    }
    files::write_height_sheet(&job.scene.name, &operations[last].name, &gear.maps, folder)?;
    let mut results = results(job, gear)?;
    if let Some((cutter, whole)) = whole {
        let loads = load::measure(cutter, &whole.blank);
        load::write(job, &loads, folder)?;
        results["hob_load"] = load::results(job, &loads)?;
        blank::write(cutter, whole, folder)?;
        results["blank"] = blank::results(cutter, whole)?;
    }
    folder.write_json(RESULTS_FILE, &results)?;
    Ok(results)
}

fn write_flank_table(job: &HobbingJob, gear: &HobbedGear, path: &Path) -> Result<()> {
    let mut columns: Vec<String> =
        ["tooth", "flank", "start_of_involute_mm", "undercut", "profile_length_mm"].map(str::to_owned).into();
    for operation in &job.operations[..job.operations.len() - 1] {
        columns.extend(["smallest", "largest", "mean"].map(|what| format!("{}_{what}_stock_mm", operation.spec.name)));
    }
    let measures = [
        "lowest_um",
        "highest_um",
        "mean_um",
        "Sq_um",
        "F_alpha_um",
        "f_f_alpha_um",
        "f_H_alpha_um",
        "F_beta_um",
        "f_f_beta_um",
        "f_H_beta_um",
    ];
    columns.extend(measures.map(str::to_owned));
    let um = |value: Option<f64>| Cell::from(value.map(|v| v * UM_PER_MM));
    let rows = gear.flanks.iter().map(|f| {
        let mut row: Vec<Cell> = vec![
            f.tooth.into(),
            f.side.name().into(),
            f.form_height_mm.into(),
            if f.undercut { "yes" } else { "no" }.into(),
            f.length_mm.into(),
        ];
        for stock in &f.stock {
            let part = |value: fn(&Heights) -> f64| Cell::from(stock.as_ref().map(value));
            row.extend([part(|s| s.lowest_mm), part(|s| s.highest_mm), part(|s| s.mean_mm)]);
        }
        let height = |value: fn(&Heights) -> f64| um(f.finished.as_ref().map(value));
        row.extend([height(|h| h.lowest_mm), height(|h| h.highest_mm), height(|h| h.mean_mm), height(|h| h.rms_mm)]);
        for deviation in [&f.profile, &f.helix] {
            row.extend([
                um(deviation.as_ref().map(|d| d.total_mm)),
                um(deviation.as_ref().map(|d| d.form_mm)),
                um(deviation.as_ref().map(|d| d.slope_mm)),
            ]);
        }
        row
    });
    write_table(path, &columns.iter().map(String::as_str).collect::<Vec<_>>(), rows)
}

/// Largest value over all flanks with its flank.
fn largest(gear: &HobbedGear, value: impl Fn(&HobbedReport) -> Option<f64>) -> Option<(f64, &HobbedReport)> {
    gear.flanks.iter().filter_map(|flank| value(flank).map(|v| (v, flank))).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Headline quantities by key.
fn headline(job: &HobbingJob, gear: &HobbedGear) -> Vec<(&'static str, Quantity)> {
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

/// A quantity as it stands in `results.json`.
fn value(quantity: &Quantity) -> Result<Value> {
    serde_json::to_value(quantity)
        .map_err(|reason| Error::Output { path: RESULTS_FILE.into(), reason: reason.to_string() })
}

fn results(job: &HobbingJob, gear: &HobbedGear) -> Result<Value> {
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
        "candidates": value(&Quantity::number(
            work.stats.dexel_passes as f64 / work.dexels.max(1) as f64,
            "passes",
            "passes visited per dexel and operation; two or three touch it",
        ))?,
    }))
}

/// What is printed when a run is done.
pub fn summary(job: &HobbingJob, gear: &HobbedGear, out: &Path, backend: &str) -> String {
    let mut sheet = Sheet::default();
    let spec = &job.scene.gear;
    let work = &gear.work;
    let state = if work.interrupted { ", stopped before all flanks were done" } else { "" };
    sheet.heading(&format!(
        "{}: {} teeth, module {} mm, {} of {} flanks hobbed{state}",
        job.scene.name,
        spec.teeth,
        spec.module_mm,
        gear.flanks.len(),
        2 * spec.teeth,
    ));
    for (key, quantity) in headline(job, gear) {
        let label = key.replace('_', " ");
        let value = match (quantity.value(), quantity.place()) {
            (Some(value), place) => {
                let at = place.map_or_else(String::new, |p| format!(" (tooth {} {})", p.tooth, p.flank));
                format!("{} {}{at}", significant(value, 4), quantity.unit().unwrap_or(""))
            }
            (None, _) => format!("none ({})", quantity.why().unwrap_or("not defined")),
        };
        sheet.line(&label, value);
    }
    let seconds = work.elapsed.as_secs_f64();
    sheet.line(
        "work",
        format!(
            "{} dexels, {:.1} passes each, in {seconds:.1} s on {backend}",
            work.dexels,
            work.stats.dexel_passes as f64 / work.dexels.max(1) as f64
        ),
    );
    let untouched: u64 = gear.flanks.iter().map(|f| f.untouched).sum();
    if untouched > 0 {
        sheet.line(
            "warning",
            format!("{untouched} dexels were reached by no pass: the hob does not cover the whole face"),
        );
    }
    if work.stats.unconverged > 0 {
        let count = work.stats.unconverged;
        sheet.line(
            "warning",
            format!("{count} rays did not converge: their heights may be too large; please report the scene"),
        );
    }
    sheet.line("files", out.display().to_string());
    sheet.into_text()
}
