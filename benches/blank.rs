//! The whole blank: rays through the elliptical gear's stock at 0.1 mm, 4,200 strokes, both operations.
//!
//! Prints a table of its own: time, memory and pairs of ray and pass stand beside each other.
//! `cargo bench --bench blank`; `-- hobbed [SCENE]` for a hobbed blank alone.

mod common;
#[allow(
    dead_code,
    clippy::wildcard_imports,
    reason = "shared with the tests: a bench takes its part, and clippy lets test crates alone import a whole module"
)]
#[path = "../tests/suite/fixtures/paper.rs"]
mod scenes;

use gearcut::cut::Backend;
use gearcut::cut::BlankStats;
use gearcut::cut::cpu::Cpu;
use gearcut::gpu::adapter::AdapterWish;
use gearcut::gpu::{Gpu, GpuOptions};
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::scene::model::Shaping;
use gearcut::steps::planar::blank_report;
use gearcut::surface::BlankMesh;
use std::path::Path;
use std::time::Instant;

/// Rounds; the fastest counts.
const ROUNDS: usize = 3;

/// A hobbing scene's blank on the processor and on whatever GPU or stand-in is there.
fn hobbed(scene: &str) {
    let loaded = load(Path::new(&format!("scenes/hobbing/{scene}.toml")), &[]).expect("a shipped scene");
    let job = HobbingJob::new(&loaded.scene).expect("a scene that cuts");
    let cutter = HobCutter::new(&job).expect("passes");
    let cut = |backend: &dyn Backend| {
        let started = Instant::now();
        let field = job.blank_field().expect("fits in memory");
        let slices = field.slices.len();
        let blank = cutter.cut_blank(backend, field, &|| true).expect("the backend works").expect("not stopped");
        let [chips, spans] = [blank.chips.iter().map(Vec::len).sum(), blank.cut.field.spans()];
        let seconds = started.elapsed().as_secs_f64();
        println!("{scene}, {}: {seconds:.2} s, {slices} slices, {spans} spans, {chips} chips", backend.name());
    };
    cut(&Cpu::default());
    for wish in [AdapterWish::Real, AdapterWish::Software] {
        let Ok(gpu) = Gpu::new(wish, GpuOptions::default()) else { continue };
        cut(&gpu);
        for stage in gpu.stage_times() {
            println!("{}: {} launches", stage.stage, stage.batches);
        }
    }
}

fn main() {
    println!("{}", common::machine());
    let mut arguments = std::env::args().skip_while(|argument| argument != "hobbed").skip(1);
    if std::env::args().any(|argument| argument == "hobbed") {
        return hobbed(arguments.find(|argument| !argument.starts_with('-')).as_deref().unwrap_or("circular_helical"));
    }
    for (name, feed_during_stroke) in [("axes at rest", false), ("feed during the stroke, 13 slices", true)] {
        let mut scene = scenes::paper_scene(vec![
            scenes::operation("rough", scenes::NORMAL, 2.0, 4200),
            scenes::operation("finish", scenes::NORMAL, 0.0, 4200),
        ]);
        for operation in &mut Shaping::of_mut(&mut scene).expect("shaping").operations {
            operation.feed_during_stroke = feed_during_stroke;
        }
        let job = ShapingJob::new(scene).expect("the paper's gear");
        let mut fastest = f64::INFINITY;
        let mut last = None;
        for _ in 0..ROUNDS {
            let started = Instant::now();
            let field = job.planar().blank_field().expect("fits in memory");
            last = job.cut_blank(&Cpu::default(), field, &|| true).expect("native");
            fastest = fastest.min(started.elapsed().as_secs_f64());
        }
        let cut = last.expect("not stopped");
        let mut stats = BlankStats::default();
        for done in &cut.cuts {
            stats += done.stats;
        }
        println!("\n{name}");
        println!("cut, return strokes checked: {fastest:.2} s on {} threads", rayon::current_num_threads());
        println!("field: {:.2} MB, {} spans", 1e-6 * cut.field.bytes() as f64, cut.field.spans());
        println!(
            "ray-passes: {:.2} million cross a tooth, {:.2} million solved, {:.2} million removed something",
            1e-6 * stats.visited as f64,
            1e-6 * stats.solved as f64,
            1e-6 * stats.removing as f64
        );
        let started = Instant::now();
        let target = job.target_outline(0.0, 0.02).expect("ordinary teeth");
        println!("target outline: {:.2} s, {} points", started.elapsed().as_secs_f64(), target.points_mm().len());
        let started = Instant::now();
        let report = blank_report::measure(&job.planar(), &cut, std::slice::from_ref(&target));
        println!("report: {:.2} s, {} gouges", started.elapsed().as_secs_f64(), report.gouges.len());
        let started = Instant::now();
        let mesh = BlankMesh::new(&cut.field, Some(&target)).mesh;
        println!("mesh: {:.2} s, {} triangles", started.elapsed().as_secs_f64(), mesh.triangles.len());
        for wish in [AdapterWish::Real, AdapterWish::Software] {
            let Ok(gpu) = Gpu::new(wish, GpuOptions::default()) else { continue };
            let started = Instant::now();
            let field = job.planar().blank_field().expect("fits in memory");
            let cut = job.cut_blank(&gpu, field, &|| true).expect("the device works").expect("not stopped");
            let rubs: usize = cut.cuts.iter().map(|done| done.rubs.len()).sum();
            println!(
                "{}: {:.2} s, return strokes checked, {rubs} rays rub",
                gpu.name(),
                started.elapsed().as_secs_f64()
            );
        }
    }
    hobbed("circular_helical");
}
