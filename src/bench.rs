//! Rates of the kernels on one machine, for `gearcut devices --bench`.
//!
//! In: a backend. Out: [`KernelRate`]s. Law: two small gears of its own go through every kernel as in a run, plans made
//! before, transfers included. The first round is not timed: it compiles pipelines. The fastest of those that follow
//! counts, for others have the machine too.
//!
//! Road not taken: rates of the shaders alone. What a run waits for is the way to the device and back as well.

use crate::process;
use crate::process::hobbing::{HobCutter, HobbingJob};
use crate::process::shaping::ShapingJob;
use gearcut_core::cut::{Backend, PlannedField, cut_alone};
use gearcut_core::error::{Error, Result};
use gearcut_core::passes::{CutPlan, SweepPlan};
use gearcut_core::terms::Side;
use std::path::Path;
use std::time::Duration;
use web_time::Instant;

/// A round gear shaped in one operation, the feed going on during the strokes.
const SHAPED: &str = "
[gear]
module_mm = 3.0
teeth = 24
face_width_mm = 10.0
[tool.shaper_cutter]
teeth = 20
[[operation]]
name = \"finish\"
feed_during_stroke = true
[fields.flank]
profile_spacing_um = 10.0
lead_spacing_um = 50.0
[fields.blank]
spacing_mm = 0.5
slice_spacing_mm = 5.0
";
/// A round gear hobbed in one operation.
const HOBBED: &str = "
[gear]
module_mm = 3.0
teeth = 24
face_width_mm = 10.0
[tool.hob]
gashes = 12
length_mm = 60.0
[[operation]]
name = \"finish\"
axial_feed_mm_per_revolution = 2.0
[fields.flank]
profile_spacing_um = 10.0
lead_spacing_um = 50.0
[fields.blank]
spacing_mm = 0.5
slice_spacing_mm = 5.0
";
/// How long a kernel is timed at least, and in how many rounds.
const LEAST: Duration = Duration::from_millis(200);
const ROUNDS: usize = 3;

/// How fast a kernel is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KernelRate {
    /// What it cuts.
    pub kernel: &'static str,
    /// What is counted.
    pub unit: &'static str,
    /// So many of them in a second.
    pub per_second: f64,
}

/// Kernels of which rates are given.
pub const KERNELS: usize = 4;

/// Rates of all kernels on a backend; `advance` is called after each.
///
/// # Errors
/// The backend's.
pub fn kernel_rates(backend: &dyn Backend, advance: &dyn Fn()) -> Result<[KernelRate; KERNELS]> {
    let scene = |text: &str, name: &str| {
        let loaded = process::parse(text, name, Path::new(""), &[]);
        loaded.map(|loaded| loaded.scene).map_err(|problems| Error::Scene(Box::new(problems)))
    };
    let rate = |kernel, unit, units: u64, work: &dyn Fn() -> Result<()>| -> Result<KernelRate> {
        let per_second = units as f64 / fastest_s(work)?;
        advance();
        Ok(KernelRate { kernel, unit, per_second })
    };

    let shaped = ShapingJob::new(scene(SHAPED, "shaped.toml")?)?;
    let strokes = &shaped.finishing().strokes;
    let field = shaped.flank_field(shaped.target_flank(1, Side::Left));
    let plans = vec![CutPlan::new(&field, strokes, &shaped.cutter)];
    let dexel_passes = plans[0].dexel_passes();
    let planned = PlannedField { field, plans, lines: None };
    let blank = shaped.planar().blank_field()?;
    let [shaped_passes, slices] = [strokes.end_pass() - strokes.first_pass, blank.slices.len() as u32].map(u64::from);
    let planar = rate("flanks of shaping", "dexel-passes", dexel_passes, &|| cut_alone(backend, &planned).map(drop))?;
    let strokes = rate("blank of shaping", "passes in a slice", shaped_passes * slices, &|| {
        shaped.cut_blank(backend, blank.clone(), &|| true).map(drop)
    })?;

    let hobbed = HobbingJob::new(&scene(HOBBED, "hobbed.toml")?)?;
    let cutter = HobCutter::new(&hobbed)?;
    let field = cutter.rays(1, Side::Left)?.1.field;
    let plan = SweepPlan::new(&field, &cutter.operations[0]);
    let blank = hobbed.blank_field()?;
    let passes = u64::from(cutter.operations[0].count()) * blank.slices.len() as u64;
    let spatial = rate("flanks of hobbing", "dexel-passes", plan.dexel_passes(), &|| {
        backend.cut_spatial(&field, &plan, &mut field.blank_layer()).map(drop)
    })?;
    let sweeps = rate("blank of hobbing", "passes in a slice", passes, &|| {
        cutter.cut_blank(backend, blank.clone(), &|| true).map(drop)
    })?;
    Ok([planar, strokes, spatial, sweeps])
}

/// Time of the fastest round, s.
fn fastest_s(work: &dyn Fn() -> Result<()>) -> Result<f64> {
    work()?;
    let (started, mut rounds, mut fastest_s) = (Instant::now(), 0, f64::INFINITY);
    while rounds < ROUNDS || started.elapsed() < LEAST {
        let round = Instant::now();
        work()?;
        fastest_s = fastest_s.min(round.elapsed().as_secs_f64());
        rounds += 1;
    }
    Ok(fastest_s)
}
