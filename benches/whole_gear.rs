//! How fast the native backend cuts: one flank in its parts, and the whole gear.
//!
//! Job: the third-order elliptical gear (m 3, z 42, face 30 mm), dexels every 5 um along the profile and 50 um along
//! the tooth, roughing 2 mm off and finishing, each with 4,200 strokes. The flank (tooth 7, left) is timed in its
//! parts, in one thread: the plan (which passes can matter to which tile), the cut, the measures. The whole gear runs
//! once per instruction set through `shaping::cut_gear`, as `gearcut cut` does, without files, on all threads. A
//! dexel-pass is one ray tried against one segment of one pass.
//!
//! `cargo bench --bench whole_gear` for both; `-- flank` for the parts alone.

mod common;
#[allow(
    dead_code,
    clippy::wildcard_imports,
    reason = "shared with the tests: a bench takes its part, and clippy lets test crates alone import a whole module"
)]
#[path = "../tests/suite/fixtures/paper.rs"]
mod scenes;

use criterion::{BatchSize, Criterion, Throughput};
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::interrupt::Interrupt;
use gearcut::passes::CutPlan;
use gearcut::process::shaping;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::gear::measure::flank_report;
use gearcut::progress::{Progress, ProgressMode};
use gearcut::steps::parts::Stages;
use gearcut::terms::Side;
use std::hint::black_box;
use std::time::Duration;

const STROKES: u32 = 4200;

/// With frozen strokes all rows are alike and one is cut for all; when the feed goes on during the stroke every dexel
/// is cut.
fn job(feed_during_stroke: bool) -> ShapingJob {
    let operation = |name, offset_mm| shaping::scene::model::Operation {
        feed_during_stroke,
        ..scenes::operation(name, scenes::NORMAL, offset_mm, STROKES)
    };
    ShapingJob::new(scenes::paper_scene(vec![operation("rough", 2.0), operation("finish", 0.0)]))
        .expect("the paper's gear")
}

fn one_flank(criterion: &mut Criterion, job: &ShapingJob) {
    let flank = job.target_flank(7, Side::Left);
    let field = job.flank_field(flank);
    let finishing = job.finishing();
    let plan = CutPlan::new(&field, &finishing.strokes, &job.cutter);
    println!(
        "flank 7 left: {} dexels, {} tiles, {} records, {:.2} dexel-passes per dexel in finishing",
        field.len(),
        plan.tiles.len(),
        plan.records.len(),
        plan.dexel_passes() as f64 / field.len() as f64
    );
    let mut group = criterion.benchmark_group("flank");
    group.sample_size(10).warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(4));
    group.bench_function("plan", |b| b.iter(|| CutPlan::new(black_box(&field), &finishing.strokes, &job.cutter)));
    group.throughput(Throughput::Elements(plan.dexel_passes()));
    for cpu in common::backends() {
        group.bench_function(format!("cut, {}", cpu.instruction_set()), |b| {
            let cut = |mut layer| cpu.cut(&field, &plan, &mut layer).map(|stats| (stats, layer));
            b.iter_batched(|| field.blank_layer(), cut, BatchSize::LargeInput);
        });
    }
    let cut = job.cut(&Cpu::default(), field.clone()).expect("native");
    group.throughput(Throughput::Elements(field.len() as u64));
    group
        .bench_function("measure", |b| b.iter(|| flank_report::measure(job, flank, black_box(&cut), &field.rows_z_mm)));
    group.finish();
}

fn whole_gear(job: &ShapingJob, strokes: &str) {
    for cpu in common::backends() {
        let quiet = Progress::new(ProgressMode::Quiet);
        let gear = shaping::cut_gear(job, Stages::ALL, &cpu, (&quiet, &Interrupt::default()), None).expect("native");
        let seconds = gear.work.elapsed.as_secs_f64();
        let visits = gear.work.stats.dexel_passes as f64;
        println!(
            "whole gear, {strokes}, {}: {seconds:.2} s; {:.1} million dexels (both operations), {:.2} million cut, \
            {:.2} million dexel-passes, {:.2} per dexel cut, {:.2} ns each (wall time, measures included); {}",
            cpu.name(),
            gear.work.dexels as f64 * 1e-6,
            gear.work.stats.dexels as f64 * 1e-6,
            visits * 1e-6,
            visits / gear.work.stats.dexels as f64,
            1e9 * seconds / visits,
            peak_memory()
        );
        assert_eq!(gear.work.stats.unconverged, 0, "every root was found");
    }
}

/// Largest resident memory of this process so far, where the system tells it.
fn peak_memory() -> String {
    std::fs::read_to_string("/proc/self/status")
        .ok()
        .and_then(|status| status.lines().find_map(|line| Some(line.strip_prefix("VmHWM:")?.trim().to_owned())))
        .map_or_else(|| "peak memory unknown".to_owned(), |peak| format!("peak memory {peak} so far"))
}

fn main() {
    println!("{}", common::machine());
    let job_of_moving_strokes = job(true);
    let mut criterion = Criterion::default().configure_from_args();
    one_flank(&mut criterion, &job_of_moving_strokes);
    criterion.final_summary();
    // `cargo bench -- flank` asks for the parts alone; `cargo test --benches` only wants to see that it runs.
    if !std::env::args().any(|argument| argument == "flank" || argument == "--test") {
        whole_gear(&job_of_moving_strokes, "feed during the stroke");
        whole_gear(&job(false), "frozen strokes");
    }
}
