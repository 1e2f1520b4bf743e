//! A device that fails loses nothing: the flank is cut again natively, or the run stops with the reason.

use crate::fixtures::paper::*;
use crate::fixtures::parity::*;
use gearcut::Error;
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::Field;
use gearcut::gpu::{Gpu, GpuOptions, GpuProblem, OnGpuFailure};
use gearcut::passes::CutPlan;
use gearcut::process::shaping::ShapingJob;
use gearcut::terms::Side;
use std::time::Duration;

fn job() -> ShapingJob {
    let mut scene = paper_scene(vec![operation("rough", NORMAL, 2.0, 360), operation("finish", NORMAL, 0.0, 720)]);
    scene.fields.lead_spacing_mm = 1.0;
    ShapingJob::new(scene).expect("the paper's gear")
}

fn field(job: &ShapingJob, tooth: u32) -> Field {
    job.flank_field(job.target_flank(tooth, Side::Left))
}

fn redoing(memory_limit_bytes: Option<u64>) -> GpuOptions {
    GpuOptions { on_failure: OnGpuFailure::RedoNatively, memory_limit_bytes, poison_outputs: true, rows: None }
}

#[test]
fn a_flank_after_the_loss_is_cut_natively_and_the_loss_is_told() {
    let gpu = software_gpu(redoing(None));
    let job = job();
    job.cut(&gpu, field(&job, 3)).expect("the device works");
    assert!(gpu.incidents().is_empty());
    gpu.lose_device();
    let redone = job.cut(&gpu, field(&job, 4)).expect("cut natively");
    let native = job.cut(&Cpu::default(), field(&job, 4)).expect("the native backend");
    assert!(redone.layers == native.layers, "a flank that was cut again is the native one, to the bit");
    println!("{:?}", gpu.incidents());
    // All operations of a flank go to the device together, and are cut again together.
    assert_eq!(gpu.incidents().len(), 1);
    assert!(gpu.incidents()[0].contains("lost"), "{:?}", gpu.incidents());
}

#[test]
fn a_blank_after_the_loss_is_cut_natively_and_the_loss_is_told() {
    let mut scene = paper_scene(vec![operation("rough", NORMAL, 2.0, 90)]);
    scene.fields.blank_spacing_mm = 0.5;
    let job = ShapingJob::new(scene).expect("the paper's gear");
    let cut = |backend: &dyn Backend| job.cut_blank(backend, job.planar().blank_field().expect("fits"), &|| true);
    let gpu = software_gpu(redoing(None));
    gpu.lose_device();
    assert!(cut(&gpu).expect("cut natively") == cut(&Cpu::default()).expect("the native backend"));
    assert!(gpu.incidents()[0].contains("the blank is cut again on cpu"), "{:?}", gpu.incidents());
    let strict = software_gpu(strict());
    strict.lose_device();
    assert!(matches!(cut(&strict), Err(Error::Device(_))));
    // Ctrl-C between tiles.
    let working = software_gpu(redoing(None));
    assert!(
        job.cut_blank(&working, job.planar().blank_field().expect("fits"), &|| false).expect("no failure").is_none()
    );
}

#[test]
fn a_device_lost_in_the_middle_of_a_flank_loses_nothing() {
    let job = job();
    let field = field(&job, 7);
    let plan = CutPlan::brute_force(&field, &job.finishing().strokes, &job.cutter);
    let native = {
        let mut layer = field.blank_layer();
        Cpu::default().cut(&field, &plan, &mut layer).expect("the native backend");
        layer
    };
    let mut lost = 0;
    for delay_ms in [1, 5, 20, 50] {
        // So little memory that the flank goes through in many batches.
        let gpu = software_gpu(redoing(Some(120_000)));
        let mut layer = field.blank_layer();
        std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(Duration::from_millis(delay_ms));
                gpu.lose_device();
            });
            gpu.cut(&field, &plan, &mut layer).expect("cut in any case");
        });
        if gpu.incidents().is_empty() {
            continue;
        }
        lost += 1;
        println!("after {delay_ms} ms: {:?}", gpu.incidents());
        assert!(gpu.incidents()[0].contains("lost"), "{:?}", gpu.incidents());
        assert!(layer == native, "lost after {delay_ms} ms: not the native flank");
    }
    assert!(lost > 0, "no device was lost in the middle of its work");
}

/// What a cut that must stop says; its layer must be as before.
fn stops(gpu: &Gpu, job: &ShapingJob) -> GpuProblem {
    let field = field(job, 5);
    let plan = CutPlan::new(&field, &job.finishing().strokes, &job.cutter);
    let before = field.blank_layer();
    let mut layer = before.clone();
    let Err(Error::Device(problem)) = gpu.cut(&field, &plan, &mut layer) else { panic!("the cut did not stop") };
    assert!(layer == before, "a failed cut left something");
    *problem.downcast().expect("a problem of the device")
}

#[test]
fn the_run_stops_when_the_user_wants_it() {
    let gpu = software_gpu(strict());
    gpu.lose_device();
    let problem = stops(&gpu, &job());
    assert!(matches!(problem, GpuProblem::Lost { .. }), "{problem}");
}

#[test]
fn refused_memory_is_told_and_made_good() {
    let job = job();
    // Less than one column needs.
    let strict = software_gpu(GpuOptions { memory_limit_bytes: Some(500), ..strict() });
    let problem = stops(&strict, &job);
    println!("{problem}");
    assert!(matches!(problem, GpuProblem::OutOfMemory { .. }), "{problem}");

    let redoing = software_gpu(redoing(Some(500)));
    let cut = job.planar().cut_rows(&redoing, &field(&job, 5)).expect("cut natively");
    let native = job.planar().cut_rows(&Cpu::default(), &field(&job, 5)).expect("the native backend");
    assert!(cut.layers == native.layers && cut.stats == native.stats);
    assert!(redoing.incidents()[0].contains("out of device memory"), "{:?}", redoing.incidents());
}

#[test]
fn flanks_cut_in_parallel_do_not_disturb_each_other() {
    let gpu = software_gpu(strict());
    let job = job();
    let together: Vec<_> = std::thread::scope(|scope| {
        let cuts: Vec<_> = (1..=6)
            .map(|tooth| {
                scope.spawn({
                    let (job, gpu) = (&job, &gpu);
                    move || job.cut(gpu, field(job, tooth))
                })
            })
            .collect();
        cuts.into_iter().map(|cut| cut.join().expect("no panic").expect("cuts")).collect()
    });
    for (tooth, cut) in (1..).zip(together) {
        let alone = job.cut(&gpu, field(&job, tooth)).expect("cuts");
        assert!(cut.layers == alone.layers, "tooth {tooth}");
    }
}
