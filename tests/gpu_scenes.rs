//! Every shipped scene, some of its flanks and a root, on the GPU backend and on the native one.

mod gpu_common;

use gearcut::cut::Backend;
use gearcut::dexel::Field;
use gearcut::gear::generation::Side;
use gearcut::job::Job;
use gearcut::passes::CutPlan;
use gearcut::scene::{load, model::Scene};
use gearcut::tool::CuttingTool;
use gpu_common::*;
use std::path::PathBuf;

/// Rows of a test: two whole threads and one row more.
const ROW_INTERVALS: f64 = 8.0;

fn scenes() -> Vec<Scene> {
    let folder = std::fs::read_dir("scenes/shaping").expect("the folder of scenes");
    let mut paths: Vec<PathBuf> = folder.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    assert!(paths.len() >= 8, "only {} scenes found", paths.len());
    paths.iter().map(|path| load(path, &[]).unwrap_or_else(|errors| panic!("{errors}")).scene).collect()
}

/// Three flanks and a root of a scene.
fn fields(job: &Job) -> Vec<(String, Field)> {
    let generation = job.target_generation();
    let teeth = job.scene.gear.teeth;
    let flanks = [(1, Side::Left), (teeth / 3 + 1, Side::Right), (teeth - 1, Side::Left)];
    let mut fields: Vec<(String, Field)> = flanks
        .into_iter()
        .map(|(tooth, side)| {
            let flank = job.target_flank(&generation, tooth, side).expect("a flank");
            (format!("tooth {tooth} {side:?}"), job.flank_field(&flank))
        })
        .collect();
    fields.push(("root 2".into(), job.root_field(2)));
    fields
}

fn compare(gpu: &dyn Backend, mut scene: Scene, feed_during_stroke: bool) -> Parity {
    scene.fields.lead_spacing_mm = scene.gear.face_width_mm / ROW_INTERVALS;
    for operation in &mut scene.shaping_mut().expect("shaping").operations {
        operation.feed_during_stroke = feed_during_stroke;
    }
    let name = scene.name.clone();
    let job = Job::new(scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    let mut all = Parity::default();
    for (what, field) in fields(&job) {
        let blank = field.blank_layer();
        let mut layers = [blank.clone(), blank.clone(), blank.clone(), blank];
        for operation in &job.operations {
            let plan = CutPlan::new(&field, &operation.strokes, &job.cutter);
            let place = format!("{name}, {what}, {}", operation.spec.name);
            let before = layers.each_ref();
            let (parity, after) = cut_both(gpu, &place, &field, job.cutter.edge(), &plan, before);
            all.merge(parity);
            layers = after;
        }
    }
    println!("{name}{}: {all}", if feed_during_stroke { ", feed during stroke" } else { "" });
    all
}

#[test]
fn every_scene_is_cut_alike() {
    let gpu = software_gpu(strict());
    let mut all = Parity::default();
    for scene in scenes() {
        for feed_during_stroke in [false, true] {
            all.merge(compare(&gpu, scene.clone(), feed_during_stroke));
        }
    }
    println!("all scenes: {all}");
    println!("{:?}", gpu.stage_times());
    assert_eq!(all.verdict(), Ok(()));
}
