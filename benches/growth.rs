//! How the time of a flank grows: with the spacing of the dexels, the number of strokes, the width of the face.
//!
//! One flank of the paper's gear, finished, the feed going on during the strokes so that every dexel is cut for itself.
//! Cost must follow area times the passes that touch it and nothing else: dexels grow with 1/spacing and with the
//! width; passes per dexel do not grow with the strokes once a facet is narrower than a tile is wide, only planning
//! meets more of them. Each table varies one quantity; the exponent is the least-squares slope of log time over log
//! quantity. Fastest of several runs each; native in one thread, so that its rate is one core's.
//!
//! `cargo bench --bench growth`

mod common;
#[allow(
    dead_code,
    clippy::wildcard_imports,
    reason = "shared with the tests: a bench takes its part, and clippy lets test crates alone import a whole module"
)]
#[path = "../tests/suite/fixtures/paper.rs"]
mod scenes;

use gearcut::cut::Backend;
use gearcut::gpu::adapter::adapters;
use gearcut::gpu::{Gpu, GpuOptions};
use gearcut::passes::CutPlan;
use gearcut::process::shaping::ShapingJob;
use gearcut::terms::Side;
use std::time::Instant;

/// Runs of which the fastest counts.
const RUNS: usize = 5;

/// One flank to be cut.
#[derive(Clone, Copy)]
struct Case {
    profile_um: f64,
    lead_um: f64,
    strokes: u32,
    width_mm: f64,
}

const SHIPPED: Case = Case { profile_um: 5.0, lead_um: 50.0, strokes: 4200, width_mm: 30.0 };

/// What one case took: dexels, dexel-passes, planning and cutting on every backend, ms.
struct Taken {
    dexels: usize,
    dexel_passes: u64,
    plan_ms: f64,
    cut_ms: Vec<f64>,
}

fn take(case: Case, backends: &[(String, Box<dyn Backend>)]) -> Taken {
    let mut operation = scenes::operation("finish", scenes::NORMAL, 0.0, case.strokes);
    operation.feed_during_stroke = true;
    let mut scene = scenes::paper_scene(vec![operation]);
    scene.gear.face_width_mm = case.width_mm;
    scene.fields.profile_spacing_mm = 1e-3 * case.profile_um;
    scene.fields.lead_spacing_mm = 1e-3 * case.lead_um;
    let job = ShapingJob::new(scene).expect("the paper's gear");
    let field = job.flank_field(job.target_flank(5, Side::Left));
    let fastest_ms = |run: &mut dyn FnMut()| {
        let time = |()| {
            let started = Instant::now();
            run();
            1e3 * started.elapsed().as_secs_f64()
        };
        std::iter::repeat_n((), RUNS).map(time).fold(f64::INFINITY, f64::min)
    };
    let strokes = &job.finishing().strokes;
    let plan = CutPlan::new(&field, strokes, &job.cutter);
    let plan_ms = fastest_ms(&mut || {
        std::hint::black_box(CutPlan::new(&field, strokes, &job.cutter));
    });
    let cut_ms = backends
        .iter()
        .map(|(_, backend)| {
            let mut layers = vec![field.blank_layer(); RUNS];
            fastest_ms(&mut || {
                let mut layer = layers.pop().expect("one for each run");
                backend.cut(&field, &plan, &mut layer).expect("cuts");
            })
        })
        .collect();
    Taken { dexels: field.len(), dexel_passes: plan.dexel_passes(), plan_ms, cut_ms }
}

/// Slope of log y over log x.
fn exponent(points: &[[f64; 2]]) -> f64 {
    let logs: Vec<[f64; 2]> = points.iter().map(|p| p.map(f64::ln)).collect();
    let count = logs.len() as f64;
    let mean = [0, 1].map(|axis| logs.iter().map(|p| p[axis]).sum::<f64>() / count);
    let over = |other: usize| logs.iter().map(|p| (p[0] - mean[0]) * (p[other] - mean[other])).sum::<f64>();
    over(1) / over(0)
}

fn main() {
    println!("{}; fastest of {RUNS} runs", common::machine());
    let mut backends: Vec<(String, Box<dyn Backend>)> = common::backends()
        .into_iter()
        .map(|cpu| (format!("{}, one thread", cpu.instruction_set()), Box::new(cpu) as _))
        .collect();
    for adapter in adapters() {
        match Gpu::on(&adapter, GpuOptions::default()) {
            Ok(gpu) => backends.push((adapter.facts.name, Box::new(gpu))),
            Err(problem) => eprintln!("left out: {problem}"),
        }
    }
    let tables: [(&str, Vec<(f64, Case)>); 4] = [
        (
            "spacing along the profile, um",
            [20.0, 10.0, 5.0, 2.5].map(|profile_um| (profile_um, Case { profile_um, ..SHIPPED })).to_vec(),
        ),
        (
            "spacing along the tooth, um",
            [200.0, 100.0, 50.0, 25.0].map(|lead_um| (lead_um, Case { lead_um, ..SHIPPED })).to_vec(),
        ),
        (
            "strokes per revolution",
            [1050, 2100, 4200, 8400].map(|strokes| (f64::from(strokes), Case { strokes, ..SHIPPED })).to_vec(),
        ),
        ("face width, mm", [7.5, 15.0, 30.0, 60.0].map(|width_mm| (width_mm, Case { width_mm, ..SHIPPED })).to_vec()),
    ];
    for (quantity, cases) in tables {
        let names: Vec<String> = backends.iter().map(|(name, _)| format!("cut, ms: {name}")).collect();
        println!("\n| {quantity} | dexels | passes per dexel | plan, ms | {} |", names.join(" | "));
        println!("{}", "| --- ".repeat(4 + names.len()) + "|");
        let mut curves: Vec<Vec<[f64; 2]>> = vec![Vec::new(); 1 + names.len()];
        for (value, case) in cases {
            let taken = take(case, &backends);
            let times: Vec<f64> = std::iter::once(taken.plan_ms).chain(taken.cut_ms).collect();
            let shown: Vec<String> = times.iter().map(|ms| format!("{ms:.1}")).collect();
            let per_dexel = taken.dexel_passes as f64 / taken.dexels as f64;
            println!("| {value} | {} | {per_dexel:.2} | {} |", taken.dexels, shown.join(" | "));
            for (curve, ms) in curves.iter_mut().zip(times) {
                curve.push([value, ms]);
            }
        }
        let exponents: Vec<String> = curves.iter().map(|curve| format!("{:.2}", exponent(curve))).collect();
        println!("| exponent | | | {} |", exponents.join(" | "));
    }
}
