//! How fast the native backend hobs: single flanks in their parts, the whole gear, and the case of a peer program.
//!
//! Job: the third-order gear of Liu et al. 2015 as `scenes/hobbing/third_order_plain.toml` has it: 35 teeth, 50 mm
//! wide, 20 feeds, dexels every 20 um along the profile and 50 um along the tooth. Flanks are timed in their parts, in
//! one thread; the whole gear runs through `hobbing::cut_gear`, as `gearcut cut` does, without files, on all
//! threads.
//!
//! Of every flank it is said how many records a dexel visits and how far that is from the ideal. Somebody must visit
//! the pass that left a dexel: one record per dexel at least. As long as all dexels of a cell visit the same records,
//! they are at least the passes that left any dexel of the cell.
//!
//! The peer's case is one space of a spur gear, cut by the 363 sweeps that `benches/peers/manifold_hobbing.py`
//! subtracts: both flanks, every 9 to 25 um by 50 um.
//!
//! The whole blank of the same gear, rays 0.3 mm apart, slices 1 mm and 0.3 mm apart: pairs of ray and sweep stand
//! beside the time.
//!
//! `cargo bench --bench hobbed_gear` for all; `-- flank` for the parts alone, `-- peer` for the peer's case alone,
//! `-- blank` for the whole blank alone.

mod common;
#[allow(dead_code, reason = "shared with the tests: a bench takes its part")]
#[path = "../tests/suite/fixtures/expected.rs"]
mod expected;
#[allow(
    dead_code,
    clippy::wildcard_imports,
    reason = "shared with the tests: a bench takes its part, and clippy lets test crates alone import a whole module"
)]
#[path = "../tests/suite/fixtures/oracle_cases.rs"]
mod oracle_cases;

use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::{Layer, NO_PASS, SpatialField};
use gearcut::interrupt::Interrupt;
use gearcut::passes::SweepPlan;
use gearcut::process::hobbing;
use gearcut::process::hobbing::measure::flank_report;
use gearcut::process::hobbing::{HobCutter, HobbedFlank, HobbingJob};
use gearcut::process::load;
use gearcut::progress::{Progress, ProgressMode};
use gearcut::terms::Side;
use oracle_cases::{Case, data, heights, number, numbers};
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::path::Path;
use std::time::Instant;

/// Times in milliseconds, and what was made in them. On a machine with other work the processor time of the thread is
/// the one to read, where the system tells it.
struct Times {
    wall: f64,
    processor: f64,
}

impl std::fmt::Display for Times {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{:.1} ms ({:.1} of processor time)", self.wall, self.processor)
    }
}

fn timed<T>(make: impl FnOnce() -> T) -> (Times, T) {
    let on_processor = || -> Option<f64> {
        let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
        Some(text.split_whitespace().next()?.parse::<f64>().ok()? * 1e-6)
    };
    let (before, started) = (on_processor(), Instant::now());
    let made = make();
    let wall = 1e3 * started.elapsed().as_secs_f64();
    let processor = before.zip(on_processor()).map_or(f64::NAN, |(before, after)| after - before);
    (Times { wall, processor }, made)
}

/// (Dexel, pass) pairs that no choice of records for whole cells can do without.
fn indispensable(field: &SpatialField, plan: &SweepPlan, layer: &Layer) -> usize {
    let mut pairs = 0;
    for tile in &plan.tiles {
        let mut cells = [const { (0, BTreeSet::new()) }; 16];
        for column in tile.columns.clone() {
            for row in tile.rows.clone() {
                let (dexels, passes) = &mut cells[tile.cell(column, row)];
                *dexels += 1;
                passes.insert(layer.passes[field.index(column, row)]);
            }
        }
        pairs += cells
            .iter()
            .map(|(dexels, passes)| dexels * (passes.len() - usize::from(passes.contains(&NO_PASS))))
            .sum::<usize>();
    }
    pairs
}

fn one_flank(cutter: &HobCutter, tooth: u32, side: Side) {
    let cpu = Cpu::default();
    let (rays_time, (target, rays)) = timed(|| cutter.rays(tooth, side).expect("a flank"));
    let field = &rays.field;
    let (plan_time, plan) = timed(|| SweepPlan::new(field, &cutter.operations[0]));
    let mut layer = field.blank_layer();
    let (cut_time, stats) = timed(|| cpu.cut_spatial(field, &plan, &mut layer).expect("native"));
    assert_eq!(stats.unconverged, 0, "every root was found");
    let per_dexel = |pairs: f64| pairs / field.len() as f64;
    println!(
        "flank {tooth} {}: {} dexels, {} tiles, {} records; per dexel {:.2} visited, {:.2} indispensable for cells, 1 \
        ideal ({:.2} for whole tiles)",
        side.name(),
        field.len(),
        plan.tiles.len(),
        plan.records.len(),
        per_dexel(plan.dexel_passes() as f64),
        per_dexel(indispensable(field, &plan, &layer) as f64),
        per_dexel(plan.tile_passes() as f64)
    );
    let evaluated_mm = cutter.evaluated_mm(target);
    let flank = HobbedFlank { target, rays, evaluated_mm, layers: vec![layer], stats };
    let (measure_time, _) = timed(|| flank_report::measure(tooth, side, &flank));
    println!("  rays {rays_time}, plan {plan_time}, cut {cut_time}, measure {measure_time}");
}

/// Processor time of all threads so far, s, where the system tells it.
fn processor_seconds() -> f64 {
    let ticks = || -> Option<u64> {
        let text = std::fs::read_to_string("/proc/self/stat").ok()?;
        let fields = text.rsplit_once(')')?.1.split_whitespace();
        fields.skip(11).take(2).map(|ticks| ticks.parse::<u64>().ok()).sum()
    };
    // A tick is a hundredth of a second on every Linux.
    ticks().map_or(f64::NAN, |ticks| ticks as f64 / 100.0)
}

fn whole_gear(cutter: &HobCutter) {
    let cpu = Cpu::default();
    let quiet = Progress::new(ProgressMode::Quiet);
    let before = processor_seconds();
    let gear = hobbing::cut_gear(cutter, &cpu, &quiet, &Interrupt::default(), None).expect("native");
    assert_eq!(gear.work.stats.unconverged, 0, "every root was found");
    println!(
        "whole gear, {}: {} flanks in {:.2} s ({:.2} s of processor time); {:.1} million dexels, {:.1} million \
        dexel-passes, {:.2} per dexel",
        cpu.name(),
        gear.flanks.len(),
        gear.work.elapsed.as_secs_f64(),
        processor_seconds() - before,
        gear.work.dexels as f64 * 1e-6,
        gear.work.stats.dexel_passes as f64 * 1e-6,
        gear.work.stats.dexel_passes as f64 / gear.work.dexels as f64,
    );
}

/// The whole blank, at some distances of rays and slices.
fn whole_blank() {
    for slice_spacing_mm in [1.0, 0.3] {
        let sets = [format!("fields.blank.slice_spacing_mm={slice_spacing_mm}")];
        let scene = load(Path::new("scenes/hobbing/third_order_plain.toml"), &sets).expect("the scene").scene;
        let job = HobbingJob::new(&scene).expect("the gear");
        let cutter = HobCutter::new(&job).expect("passes");
        let field = job.blank_field().expect("fits in memory");
        let expected_mb = 1e-6 * field.grid.estimated_bytes(&job.blank);
        let (before, started) = (processor_seconds(), Instant::now());
        let cut = cutter.cut_blank(&Cpu::default(), field, &|| true).expect("cuts").expect("not stopped").cut;
        let (wall, processor) = (started.elapsed().as_secs_f64(), processor_seconds() - before);
        let (field, stats) = (&cut.field, cut.cuts[0].stats);
        println!(
            "whole blank, rays {} mm, {} slices: {wall:.1} s ({processor:.1} s of processor time) on {} threads; {:.0} \
            MB, {expected_mb:.0} MB expected",
            field.grid.spacing_mm(),
            field.slices.len(),
            rayon::current_num_threads(),
            1e-6 * field.bytes() as f64,
        );
        println!(
            "  pairs of ray and sweep: {:.1} million visited, {:.1} million solved, {:.1} million removed something; \
            {:.0} ns of processor time per visited, {:.0} ns per solved pair",
            1e-6 * stats.visited as f64,
            1e-6 * stats.solved as f64,
            1e-6 * stats.removing as f64,
            1e9 * processor / stats.visited as f64,
            1e9 * processor / stats.solved as f64,
        );
    }
}

/// One space of the spur gear of the peer: 11 revolutions of the work.
fn peer() {
    let file = data("p12_patch_spur");
    let case = Case::new(&file["setup"]);
    let cycle = TAU * f64::from(case.teeth) / number(&file["setup"], "K");
    let even = |from: f64, to: f64, step: f64| -> Vec<f64> {
        let count = ((to - from) / step).ceil() as usize;
        (0..=count).map(|i| from + (to - from) * i as f64 / count as f64).collect()
    };
    let cpu = Cpu::default();
    let (time, dexels) = timed(|| {
        let passes = case.passes([-5.5 * cycle, 5.5 * cycle]);
        let flanks = [-1.0, 1.0].map(|side: f64| {
            // Nearly the whole flank; 0.05 mm of roll are 9 to 25 um along the profile.
            let sigmas = even(-22.0, 22.0, 0.05);
            let field = case.patch(0, side, &sigmas, &even(-3.2, 3.2, 0.05));
            let plan = SweepPlan::new(&field, &passes);
            let mut layer = field.blank_layer();
            cpu.cut_spatial(&field, &plan, &mut layer).expect("native");
            field.len()
        });
        flanks.iter().sum::<usize>()
    });
    let passes = case.passes([-5.5 * cycle, 5.5 * cycle]);
    let field = case.patch(0, number(&file, "flank"), &numbers(&file["sigma"]), &numbers(&file["z"]));
    let plan = SweepPlan::new(&field, &passes);
    let mut layer = field.blank_layer();
    cpu.cut_spatial(&field, &plan, &mut layer).expect("native");
    let off_mm = heights("p12_patch_spur", &file).into_iter().enumerate().flat_map(|(row, line)| {
        let (field, layer) = (&field, &layer);
        line.into_iter()
            .enumerate()
            .map(move |(column, exact)| f64::from(layer.heights_mm[field.index(column, row)]) - exact)
    });
    let off_mm: Vec<f64> = off_mm.collect();
    let rms = (off_mm.iter().map(|off| off * off).sum::<f64>() / off_mm.len() as f64).sqrt();
    let largest = off_mm.iter().fold(0.0_f64, |most, off| most.max(off.abs()));
    println!(
        "the peer's case, one thread: {dexels} dexels in {time}; off the exact surface {:.3e} um rms, {:.3e} um \
        largest",
        1e3 * rms,
        1e3 * largest
    );
}

fn main() {
    println!("{}", common::machine());
    // `cargo test --benches` only wants to see that it runs.
    let only = |name: &str| std::env::args().any(|argument| argument == name);
    let [flank_only, peer_only, blank_only] = ["flank", "peer", "blank"].map(only);
    if !flank_only && !blank_only {
        peer();
    }
    if peer_only {
        return;
    }
    if blank_only {
        return whole_blank();
    }
    let scene = load(Path::new("scenes/hobbing/third_order_plain.toml"), &[]).expect("the scene").scene;
    let job = HobbingJob::new(&scene).expect("the gear");
    let (passes_time, cutter) = timed(|| HobCutter::new(&job).expect("passes"));
    println!("{} passes, tabulated in {:.1} ms (all threads)", cutter.operations[0].count(), passes_time.wall);
    for (tooth, side) in [(1, Side::Left), (5, Side::Left), (6, Side::Right), (12, Side::Left)] {
        one_flank(&cutter, tooth, side);
    }
    if !flank_only && !only("--test") {
        whole_gear(&cutter);
        whole_blank();
    }
}
