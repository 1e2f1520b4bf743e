//! Every shipped scene, some of its flanks and a root, on the GPU backend and on the native one.

use crate::fixtures::parity::*;
use gearcut::cut::Backend;
use gearcut::dexel::Field;
use gearcut::passes::{CutPlan, SweepPlan};
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::scene::model::Shaping;
use gearcut::process::shaping::sections::GearPart;
use gearcut::scene::model::Scene;
use gearcut::terms::Side;
use std::path::PathBuf;

/// Rows of a test: two whole threads and one row more.
const ROW_INTERVALS: f64 = 8.0;

/// Largest difference on shaped flanks and roots, nm: 0.24 measured.
const SHAPED_NM: f64 = 0.5;
/// Largest difference on hobbed flanks, nm: 0.72 measured.
const HOBBED_NM: f64 = 1.0;

fn scenes(process: &str, fewest: usize) -> Vec<Scene> {
    let folder = std::fs::read_dir(format!("scenes/{process}")).expect("the folder of scenes");
    let mut paths: Vec<PathBuf> = folder.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    assert!(paths.len() >= fewest, "only {} scenes found", paths.len());
    paths.iter().map(|path| load(path, &[]).unwrap_or_else(|errors| panic!("{errors}")).scene).collect()
}

/// Two flanks and a root of a scene.
fn fields(job: &ShapingJob) -> Vec<(String, Field)> {
    let teeth = job.scene.gear.teeth;
    let flanks = [(1, Side::Left), (teeth / 3 + 1, Side::Right)];
    let mut fields: Vec<(String, Field)> = flanks
        .into_iter()
        .map(|(tooth, side)| {
            let flank = job.target_flank(tooth, side);
            (format!("tooth {tooth} {side:?}"), job.flank_field(flank))
        })
        .collect();
    fields.push(("root 2".into(), job.root_field(2)));
    fields
}

fn compare(gpu: &dyn Backend, mut scene: Scene, feed_during_stroke: bool) -> Parity {
    scene.fields.lead_spacing_mm = scene.gear.face_width_mm / ROW_INTERVALS;
    for operation in &mut Shaping::of_mut(&mut scene).expect("shaping").operations {
        operation.feed_during_stroke = feed_during_stroke;
    }
    let name = scene.name.clone();
    let job = ShapingJob::new(scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    let mut all = Parity::default();
    for (what, field) in fields(&job) {
        let blank = field.blank_layer();
        let mut layers = [blank.clone(), blank.clone(), blank.clone(), blank];
        for operation in &job.operations {
            let plan = CutPlan::new(&field, &operation.strokes, &job.cutter);
            let place = format!("{name}, {what}, {}", operation.spec.name);
            let before = layers.each_ref();
            let (parity, after) = cut_both(gpu, &place, &field, &plan, before);
            all.merge(parity);
            layers = after;
        }
    }
    println!("{name}{}: {all}", if feed_during_stroke { ", feed during stroke" } else { "" });
    all
}

/// Two flanks of a hobbing scene, coarse in both directions, after every operation.
fn compare_hobbed(gpu: &dyn Backend, mut scene: Scene) -> Parity {
    scene.fields.profile_spacing_mm = 0.1;
    scene.fields.lead_spacing_mm = scene.gear.face_width_mm / 32.0;
    let name = scene.name.clone();
    let job = HobbingJob::new(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    let cutter = HobCutter::new(&job).expect("passes");
    let mut all = Parity::default();
    for (tooth, side) in [(1, Side::Left), (scene.gear.teeth / 3 + 1, Side::Right)] {
        let (_, rays) = cutter.rays(tooth, side).expect("a flank");
        for (operation, passes) in job.operations.iter().zip(cutter.operations.iter()) {
            let plan = SweepPlan::new(&rays.field, passes);
            let place = format!("{name}, tooth {tooth} {}, {}", side.name(), operation.spec.name);
            all.merge(cut_both_in_space(gpu, &place, &rays.field, &plan).0);
        }
    }
    println!("{name}: {all}");
    all
}

/// Bands of a helical gear: short fields whose cutter moves by strokes.
#[test]
fn bands_along_a_helix_are_cut_alike() {
    let gpu = software_gpu(strict());
    let mut all = Parity::default();
    let scene = load(&PathBuf::from("scenes/shaping/helical.toml"), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let job = ShapingJob::new(scene.scene).expect("the shipped gear");
    let helix = job.helix.expect("a helix");
    for (tooth, side) in [(1, Side::Left), (9, Side::Right)] {
        let part = GearPart::Flank(tooth, side);
        let field = job.flank_field(job.target_flank(tooth, side));
        for band in job.bands(&helix, part, &field) {
            let band = band.expect("a section");
            let blank = band.field.blank_layer();
            let mut layers = [blank.clone(), blank.clone(), blank.clone(), blank];
            for (operation, strokes) in job.operations.iter().zip(&band.strokes) {
                let plan = CutPlan::new(&band.field, strokes, &job.cutter);
                let place = format!("tooth {tooth} {side:?}, {}", operation.spec.name);
                let (parity, after) = cut_both(&gpu, &place, &band.field, &plan, layers.each_ref());
                all.merge(parity);
                layers = after;
            }
        }
    }
    println!("bands: {all}");
    assert_eq!(all.verdict_within(SHAPED_NM), Ok(()));
}

mod slow {
    use super::*;

    #[test]
    fn every_hobbing_scene_is_cut_alike() {
        let gpu = software_gpu(strict());
        let mut all = Parity::default();
        for scene in scenes("hobbing", 5) {
            all.merge(compare_hobbed(&gpu, scene));
        }
        println!("all hobbing scenes: {all}");
        assert_eq!(all.verdict_within(HOBBED_NM), Ok(()));
    }

    #[test]
    fn every_shaping_scene_is_cut_alike() {
        let gpu = software_gpu(strict());
        let mut all = Parity::default();
        for scene in scenes("shaping", 8) {
            for feed_during_stroke in [false, true] {
                all.merge(compare(&gpu, scene.clone(), feed_during_stroke));
            }
        }
        println!("all shaping scenes: {all}");
        println!("{:?}", gpu.stage_times());
        assert_eq!(all.verdict_within(SHAPED_NM), Ok(()));
    }
}
