//! Dexel-passes in a second: the planar kernel natively and on every adapter that is there, the same plan in one run.
//!
//! One flank of the paper's gear as shipped (5 um by 50 um), finished; strokes that move and strokes that rest. The
//! rates hold for whole cuts, transfers included. Candidates leave four passes for a dexel, so that most of the time
//! may go into bringing dexels to the device and back; the same records twenty times over show what a pass costs beside
//! that.

#[path = "common/limits.rs"]
mod limits;
#[path = "common/mod.rs"]
mod machine;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::Field;
use gearcut::gpu::adapter::adapters;
use gearcut::gpu::{Gpu, GpuOptions};
use gearcut::passes::{CutPlan, Tile};
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::scene::model::Shaping;
use gearcut::terms::Side;
use std::path::Path;

fn planar(criterion: &mut Criterion) {
    println!(
        "{}; limits measured here: {:.1e} f64 operations/s, {:.1} GB/s to and from memory",
        machine::machine(),
        limits::operations_per_s(),
        limits::memory_bytes_per_s() * 1e-9
    );
    for feed_during_stroke in [true, false] {
        let mut scene = load(Path::new("scenes/shaping/elliptical_normal.toml"), &[]).expect("the shipped scene").scene;
        for operation in &mut Shaping::of_mut(&mut scene).expect("shaping").operations {
            operation.feed_during_stroke = feed_during_stroke;
        }
        let job = ShapingJob::new(scene).expect("the shipped gear");
        let field = job.flank_field(job.target_flank(5, Side::Left));
        let plan = CutPlan::new(&field, &job.finishing().strokes, &job.cutter);
        let kind = if feed_during_stroke { "moving" } else { "frozen" };
        for (name, plan) in
            [(kind.to_owned(), plan.clone()), (format!("{kind}, records 20 times over"), repeated(&plan, 20))]
        {
            compare(criterion, &name, &field, &plan);
        }
    }
}

/// The same tiles with all their records several times over.
fn repeated(plan: &CutPlan, times: usize) -> CutPlan {
    let mut records = Vec::new();
    let tiles = plan.tiles.iter().map(|tile| {
        let first = records.len();
        records.extend(std::iter::repeat_n(&plan.records[tile.records.clone()], times).flatten().copied());
        Tile { records: first..records.len(), ..tile.clone() }
    });
    CutPlan { tiles: tiles.collect(), records, row_phases: plan.row_phases.clone(), segments: plan.segments.clone() }
}

fn compare(criterion: &mut Criterion, group: &str, field: &Field, plan: &CutPlan) {
    // Opened anew, so that stage times are this group's.
    let mut backends: Vec<(String, Box<dyn Backend>)> = vec![("native".into(), Box::new(Cpu::default()))];
    for adapter in adapters() {
        match Gpu::on(&adapter, GpuOptions::default()) {
            Ok(gpu) => backends.push((adapter.facts.name, Box::new(gpu))),
            Err(problem) => eprintln!("left out: {problem}"),
        }
    }
    let mut group = criterion.benchmark_group(group);
    group.throughput(Throughput::Elements(plan.dexel_passes())).sample_size(10);
    println!("{} dexels, {} dexel-passes, {} records", field.len(), plan.dexel_passes(), plan.records.len());
    for (name, backend) in &backends {
        group.bench_function(BenchmarkId::from_parameter(name), |bencher| {
            bencher.iter(|| {
                let mut layer = field.blank_layer();
                backend.cut(field, plan, &mut layer).expect("cuts");
                layer
            });
        });
        for time in backend.stage_times() {
            let each_ms = time.device_s * 1e3 / time.batches as f64;
            let rate = plan.dexel_passes() as f64 / each_ms * 1e-3;
            println!("{name}: {} takes {each_ms:.2} ms of the device, {rate:.0} million dexel-passes/s", time.stage);
        }
    }
}

criterion_group!(benches, planar);
criterion_main!(benches);
