//! Same scene, same software adapter, same bytes.

use crate::fixtures::parity::*;
use gearcut::cut::Backend;
use gearcut::dexel::{Field, Layer};
use gearcut::gpu::Gpu;
use gearcut::passes::CutPlan;
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use gearcut::terms::Side;
use std::path::Path;

/// [`fingerprint`] of the flanks below: llvmpipe rounds alike in all its versions, widths and thread counts.
const GOLDEN: u64 = 0x95f2_78c8_524e_98a1;

fn job() -> ShapingJob {
    let mut scene = load(Path::new("scenes/shaping/elliptical_finishing_stock.toml"), &[]).expect("loads").scene;
    scene.fields.lead_spacing_mm = 0.5;
    ShapingJob::new(scene).expect("a gear")
}

fn fields(job: &ShapingJob) -> Vec<Field> {
    let flank = |(tooth, side)| job.flank_field(job.target_flank(tooth, side));
    [(1, Side::Left), (15, Side::Right)].map(flank).into()
}

/// What all operations leave on both flanks, each plan of the last operation changed before it is cut.
fn cut_with(job: &ShapingJob, gpu: &Gpu, change: impl Fn(&mut CutPlan)) -> Vec<Layer> {
    let mut layers = Vec::new();
    for field in fields(job) {
        let mut layer = field.blank_layer();
        for (index, operation) in job.operations.iter().enumerate() {
            let mut plan = CutPlan::new(&field, &operation.strokes, &job.cutter);
            if index + 1 == job.operations.len() {
                change(&mut plan);
            }
            gpu.cut(&field, &plan, &mut layer).expect("cuts");
            layers.push(layer.clone());
        }
    }
    layers
}

#[test]
fn the_finishing_stock_scene_has_its_golden_bytes() {
    let job = job();
    let gpu = software_gpu(strict());
    let flanks = fields(&job);
    let layers: Vec<Layer> =
        flanks.iter().flat_map(|field| job.planar().cut_rows(&gpu, field).expect("cuts").layers).collect();
    let dexels: usize = layers.iter().map(|l| l.passes.len()).sum();
    println!("{dexels} dexels, fingerprint {:#018x}", fingerprint(&layers));
    assert_eq!(fingerprint(&layers), GOLDEN, "other bytes than before on {}", gpu.name());
}

#[test]
fn faults_far_below_the_bound_between_backends_change_the_golden_bytes() {
    let job = job();
    let gpu = software_gpu(strict());
    let honest = cut_with(&job, &gpu, |_| ());
    assert_eq!(fingerprint(&honest), GOLDEN, "nothing is planted");
    // The passes that left the dexels in the middle of the flanks.
    let lost: Vec<u32> = honest.iter().map(|layer| layer.passes[layer.passes.len() / 2]).collect();
    let moved = cut_with(&job, &gpu, |plan| {
        let own = plan.records.iter_mut().filter(|record| lost.contains(&record.pass));
        own.for_each(|record| record.x_mm[0] += 2e-6);
    });
    assert_ne!(fingerprint(&moved), GOLDEN, "a pass 2 nm off");
    let short = cut_with(&job, &gpu, |plan| {
        for tile in &mut plan.tiles {
            tile.records.end -= usize::from(tile.records.len() > 1);
        }
    });
    assert_ne!(fingerprint(&short), GOLDEN, "the last record of every tile left out");
}
