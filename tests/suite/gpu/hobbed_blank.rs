//! The blank of hobbed gears on the GPU beside the native kernel: ends of spans, volumes and chips of every pass; lists
//! that grow; devices that fail; and proof that the comparison can fail.

use crate::fixtures::blank_parity::BlankParity;
use crate::fixtures::parity::{software_gpu, strict};
use gearcut::Error;
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::cut::sweep_chips::PassChip;
use gearcut::dexel::{BlankField, BlankGrid};
use gearcut::gear::blank_outline::BlankOutline;
use gearcut::gpu::{Gpu, GpuOptions, OnGpuFailure};
use gearcut::process::hobbing::measure::blank_report;
use gearcut::process::hobbing::measure::hob_load::OperationLoad;
use gearcut::process::hobbing::{HobCutter, HobbedBlank, HobbingJob};
use gearcut::process::load;
use std::path::Path;
use std::sync::LazyLock;

/// A round spur gear in one cut, a helical one in two by a hob with helical gashes, and the third-order gear, whose
/// radius of 170 mm f32 resolves to 15 nm.
const CASES: [(&str, [&str; 4]); 3] = [
    (
        "circular_spur",
        ["gear.teeth=24", "gear.face_width_mm=2", "fields.blank.spacing_mm=0.8", "fields.blank.slice_spacing_mm=2"],
    ),
    (
        "circular_helical",
        ["gear.teeth=21", "gear.face_width_mm=4", "fields.blank.spacing_mm=0.8", "fields.blank.slice_spacing_mm=4"],
    ),
    (
        "third_order_diagonal",
        [
            "operation.finish.axial_feed_mm_per_revolution=5",
            "gear.face_width_mm=50",
            "fields.blank.spacing_mm=4",
            "fields.blank.slice_spacing_mm=50",
        ],
    ),
];

fn job((scene, sets): (&str, [&str; 4])) -> HobbingJob {
    let loaded = load(Path::new(&format!("scenes/hobbing/{scene}.toml")), &sets.map(str::to_owned));
    HobbingJob::new(&loaded.unwrap_or_else(|e| panic!("{e}")).scene).expect("a scene that cuts")
}

/// The uncut blank with all rays shifted sideways.
fn shifted_field(job: &HobbingJob, by_mm: f64) -> BlankField {
    let mut grid = job.blank_grid().expect("fits");
    for row in &mut grid.rows {
        row.first_mm += by_mm;
    }
    BlankField::new(grid, &BlankOutline::new(&job.blank))
}

fn cut(cutter: &HobCutter, backend: &dyn Backend, field: BlankField) -> Result<HobbedBlank, Error> {
    Ok(cutter.cut_blank(backend, field, &|| true)?.expect("not stopped"))
}

/// Native blanks of shifted rays.
fn native_beside(cutter: &HobCutter, bound_mm: f64) -> [HobbedBlank; 2] {
    [bound_mm, -bound_mm].map(|by_mm| cut(cutter, &Cpu::default(), shifted_field(cutter.job, by_mm)).expect("native"))
}

/// A case's passes, and its blanks as they are cut natively: rays where they are, and shifted to both sides.
struct Native {
    cutter: HobCutter<'static>,
    blank: HobbedBlank,
    beside: [HobbedBlank; 2],
}

impl Native {
    fn of(case: (&str, [&str; 4])) -> Self {
        let job: &'static HobbingJob = Box::leak(Box::new(job(case)));
        let cutter = HobCutter::new(job).expect("passes");
        let blank = cut(&cutter, &Cpu::default(), job.blank_field().expect("fits")).expect("native");
        let beside = native_beside(&cutter, BlankParity::bound_mm(&blank.cut.field));
        Self { cutter, blank, beside }
    }
}

/// The spur gear, which several tests look at.
static SPUR: LazyLock<Native> = LazyLock::new(|| Native::of(CASES[0]));

/// What a pass may remove more or less than it does natively, on rays where they are and shifted to both sides, mm
/// along its rays: twenty rays that are 50 nm off. A ray that grazes a surface crosses it or not, and what it meets
/// there may be tenths of a millimetre; the shifts say where.
const PASS_BOUND_MM: f64 = 1e-3;
/// What all passes of an operation together may be off.
const SUM_BOUND: f64 = 1e-6;

/// Largest volume by which a pass leaves what the native passes span, mm3, and what all passes together are off,
/// relatively, by the worse family.
fn volumes_apart(native: &[[f64; 2]], beside: [&[[f64; 2]]; 2], gpu: &[[f64; 2]]) -> [f64; 2] {
    let mut worst_mm3 = 0.0_f64;
    for (pass, got) in gpu.iter().enumerate() {
        for f in 0..2 {
            let ours = [native, beside[0], beside[1]].map(|passes| passes[pass][f]);
            let (low, high) = ours.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &v| (a.min(v), b.max(v)));
            worst_mm3 = worst_mm3.max(low - got[f]).max(got[f] - high);
        }
    }
    let whole = [0, 1].map(|f| {
        let [ours, theirs] = [native, gpu].map(|passes| passes.iter().map(|pass| pass[f]).sum::<f64>());
        (theirs / ours - 1.0).abs()
    });
    [worst_mm3, whole[0].max(whole[1])]
}

fn volumes_verdict(apart: [f64; 2], grid: &BlankGrid) -> bool {
    let area_mm2 = grid.spacing_mm() * grid.slice_widths_mm().into_iter().fold(0.0, f64::max);
    apart[0] < PASS_BOUND_MM * area_mm2 && apart[1] < SUM_BOUND
}

fn thickest_mm(load: &OperationLoad) -> f64 {
    load.teeth.iter().map(|tooth| tooth.thickness_mm).fold(0.0, f64::max)
}

#[test]
fn the_comparison_can_fail() {
    let Native { blank: native, beside, .. } = &*SPUR;
    let field = &native.cut.field;
    let bound_mm = BlankParity::bound_mm(field);
    let verdict =
        |gpu: &BlankField| BlankParity::of(field, [&beside[0].cut.field, &beside[1].cut.field], gpu).verdict();
    assert_eq!(verdict(field), Ok(()));
    // A ray through the middle of the gear, whose first end every shift leaves where it is.
    let ray = field.grid.rows[0].count / 2;
    let plant = |change: &dyn Fn(&mut BlankField)| {
        let mut planted = field.clone();
        change(&mut planted);
        verdict(&planted)
    };
    for off_mm in [2.0 * bound_mm, -2.0 * bound_mm, f64::NAN] {
        let told = plant(&|planted| planted.slices[1].rays[0][ray][0].low.at_mm += off_mm);
        println!("{told:?}");
        assert!(told.is_err());
    }
    let told = plant(&|planted| planted.slices[0].rays[1][ray].clear());
    println!("{told:?}");
    assert!(told.is_err());
    // A ledger without one pass.
    let [ours, left, right] = [native, &beside[0], &beside[1]].map(|blank| &blank.cut.cuts[0].removed_mm3);
    let mut dropped = ours.clone();
    let at = ours.iter().position(|pass| pass[0] > 0.1).expect("some pass cuts");
    dropped[at] = [0.0; 2];
    let verdict = |gpu: &[[f64; 2]]| volumes_verdict(volumes_apart(ours, [left, right], gpu), &field.grid);
    assert!(verdict(ours) && !verdict(&dropped));
}

#[test]
fn a_blank_after_the_loss_is_cut_natively_and_the_loss_is_told() {
    let Native { cutter, blank: native, .. } = &*SPUR;
    let job = cutter.job;
    let gpu = software_gpu(GpuOptions { on_failure: OnGpuFailure::RedoNatively, ..strict() });
    // Ctrl-C.
    let stopped = cutter.cut_blank(&gpu, job.blank_field().expect("fits"), &|| false).expect("no failure");
    assert!(stopped.is_none() && gpu.incidents().is_empty());
    gpu.lose_device();
    let blank = |gpu: &Gpu| cut(cutter, gpu, job.blank_field().expect("fits"));
    assert!(blank(&gpu).expect("cut natively") == *native);
    assert!(gpu.incidents()[0].contains("the blank is cut again on cpu"), "{:?}", gpu.incidents());
    let strict = software_gpu(strict());
    strict.lose_device();
    assert!(matches!(blank(&strict), Err(Error::Device(_))));
}

mod slow {
    use super::*;

    #[test]
    fn lists_without_room_grow_and_end_the_same() {
        let gpu = software_gpu(strict());
        let Native { cutter, .. } = &*SPUR;
        let job = cutter.job;
        let run = |room: Option<usize>| -> (BlankField, Vec<PassChip>) {
            let mut field = job.blank_field().expect("fits");
            let passes = &cutter.operations[0];
            let ids = passes.first_pass..passes.end_pass();
            let cut = gpu.cut_blank_sweeps_on_device(
                &mut field,
                &cutter.sections(0, true).expect("a hob"),
                ids,
                room,
                &|| true,
            );
            (field, cut.expect("a software adapter works").expect("not stopped").chips)
        };
        assert!(run(None) == run(Some(0)));
    }

    #[test]
    fn the_gpu_leaves_the_same_spans_volumes_and_chips() {
        let gpu = software_gpu(strict());
        let others = [CASES[1], CASES[2]].map(Native::of);
        for (case, all) in CASES.iter().zip([&*SPUR, &others[0], &others[1]]) {
            let Native { cutter, blank: native, beside } = all;
            let job = cutter.job;
            let got = cut(cutter, &gpu, job.blank_field().expect("fits")).expect("a software adapter works");
            let parity =
                BlankParity::of(&native.cut.field, [&beside[0].cut.field, &beside[1].cut.field], &got.cut.field);
            println!("{}: {parity}", case.0);
            assert_eq!(parity.verdict(), Ok(()), "{}", case.0);
            for operation in 0..job.operations.len() {
                let [ours, left, right, theirs] =
                    [native, &beside[0], &beside[1], &got].map(|blank| &blank.cut.cuts[operation].removed_mm3);
                let apart = volumes_apart(ours, [left, right], theirs);
                println!(
                    "operation {operation}: single passes {:.1e} mm3, all together {:.1e} apart",
                    apart[0], apart[1]
                );
                assert!(volumes_verdict(apart, &got.cut.field.grid));
            }
            let report = blank_report::measure(cutter, &got.cut);
            for removed in &report.operations {
                println!("what passes took against what is missing: {:.1e}", removed.imbalance());
                assert!(removed.imbalance() < 1e-6);
            }
            let left = [0, 1]
                .map(|f| (got.cut.left_mm3.last().unwrap()[f] / native.cut.left_mm3.last().unwrap()[f] - 1.0).abs());
            assert!(left[0] < 1e-7 && left[1] < 1e-7, "{left:?}");
            for (index, passes) in cutter.operations.iter().enumerate() {
                let [ours, theirs] = [native, &got].map(|blank| OperationLoad::of_blank(passes, &blank.chips[index]));
                let sum = |load: &OperationLoad| load.teeth.iter().map(|tooth| tooth.travel_mm).sum::<f64>();
                let apart_um =
                    ours.teeth.iter().zip(&theirs.teeth).map(|(a, b)| 1e3 * (a.thickness_mm - b.thickness_mm).abs());
                let (apart_um, largest) = (apart_um.fold(0.0, f64::max), thickest_mm(&ours));
                println!(
                    "operation {index}: {} and {} chips, travel {:.1} and {:.1} mm, thickest {largest:.4} mm, teeth at \
                    most {apart_um:.4} um apart",
                    native.chips[index].len(),
                    got.chips[index].len(),
                    sum(&ours),
                    sum(&theirs)
                );
                assert!((sum(&theirs) / sum(&ours) - 1.0).abs() < 1e-3);
                assert!(largest > 0.05 && apart_um < 1.0);
            }
        }
    }
}
