//! Dexel-passes in a second of the spatial kernel: natively and on every adapter that is there, the same plan in one
//! run; and planning by itself.
//!
//! A part of one flank of a hobbed three-lobed gear, 20 um by 50 um. The rates hold for whole cuts, transfers included.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::gpu::adapter::adapters;
use gearcut::gpu::{Gpu, GpuOptions};
use gearcut::passes::SweepPlan;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::terms::Side;
use std::path::Path;

fn spatial(criterion: &mut Criterion) {
    let mut backends: Vec<(String, Box<dyn Backend>)> = vec![("native".into(), Box::new(Cpu::default()))];
    for adapter in adapters() {
        match Gpu::on(&adapter, GpuOptions::default()) {
            Ok(gpu) => backends.push((adapter.facts.name, Box::new(gpu))),
            Err(problem) => eprintln!("left out: {problem}"),
        }
    }
    let mut scene = load(Path::new("tests/data/hobbing/three_lobes.toml"), &[]).expect("the scene").scene;
    (scene.fields.profile_spacing_mm, scene.fields.lead_spacing_mm) = (0.02, 0.05);
    let job = HobbingJob::new(&scene).expect("the gear");
    let cutter = HobCutter::new(&job).expect("passes");
    let field = cutter.rays(5, Side::Left).expect("a flank").1.field;
    let plan = SweepPlan::new(&field, &cutter.operations[0]);
    println!("{} dexels, {} dexel-passes, {} records", field.len(), plan.dexel_passes(), plan.records.len());
    let mut group = criterion.benchmark_group("spatial");
    group.sample_size(10);
    group.bench_function("plan", |bencher| {
        bencher.iter(|| SweepPlan::new(&field, &cutter.operations[0]));
    });
    group.throughput(Throughput::Elements(plan.dexel_passes()));
    for (name, backend) in &backends {
        group.bench_function(BenchmarkId::from_parameter(name), |bencher| {
            bencher.iter(|| {
                let mut layer = field.blank_layer();
                backend.cut_spatial(&field, &plan, &mut layer).expect("cuts");
                layer
            });
        });
    }
}

criterion_group!(benches, spatial);
criterion_main!(benches);
