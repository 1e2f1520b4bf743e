//! Patches whose cells a GPU searches: what it leaves out lowers nothing, compared with all records of the patch, bit
//! for bit.

use crate::bevel::{cut::patch, jobs::job};
use crate::fixtures::parity::*;
use gearcut::cut::Backend;
use gearcut::dexel::{Layer, Ray, SpatialField};
use gearcut::gpu::shaders::Rows;
use gearcut::gpu::{Gpu, GpuOptions};
use gearcut::passes::{SweepPlan, TurningPasses};
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::terms::Side;
use std::path::Path;

/// What all records of a plan's patches leave, over what was there, and how many visits they take.
pub fn all_of_patches(gpu: &Gpu, field: &SpatialField, plan: &SweepPlan) -> (Layer, u64) {
    let listed = SweepPlan { has_open_cells: false, ..plan.clone() };
    let mut layer = field.blank_layer();
    let visits = gpu.cut_spatial(field, &listed, &mut layer).expect("cuts").dexel_passes;
    assert_eq!(visits, plan.tile_passes());
    (layer, visits)
}

/// Visits searched, and of all records.
fn compared(name: &str, gpu: &Gpu, field: &SpatialField, passes: &TurningPasses) -> [u64; 2] {
    let plan = SweepPlan::in_patches(field, passes);
    let (all, visits) = all_of_patches(gpu, field, &plan);
    let mut layer = field.blank_layer();
    let searched = gpu.cut_spatial(field, &plan, &mut layer).expect("cuts").dexel_passes;
    println!("{name}: {searched} visits of {visits} on {} dexels", field.len());
    assert!(layer == all, "{name}: something is lost");
    let again = gpu.cut_spatial(field, &plan, &mut layer).expect("cuts").dexel_passes;
    assert!(layer == all && again <= searched, "{name}: a second cut takes something, or more visits");
    [searched, visits]
}

/// The same rays from here on outwards, which record nothing below the target of before.
fn raised(field: &SpatialField, by_mm: f64) -> SpatialField {
    SpatialField::new(field.columns(), field.rows(), -0.5 * by_mm, |column, row| {
        let Ray { origin_mm, normal } = field.ray(column, row);
        let ray = Ray { origin_mm: origin_mm + by_mm * normal, normal };
        (ray, f64::from(field.blank_mm[field.index(column, row)]) - by_mm)
    })
}

#[test]
fn hobbed_flanks_are_searched_without_loss() {
    let gpu = software_gpu(GpuOptions { rows: Some(Rows::Few), ..strict() });
    let scene = load(Path::new("scenes/hobbing/third_order_plain.toml"), &[]).expect("the scene").scene;
    let job = HobbingJob::new(&scene).expect("the gear");
    let cutter = HobCutter::new(&job).expect("passes");
    let passes = cutter.operations.last().expect("one");
    let mut sums = [0; 2];
    for (tooth, side) in [(5, Side::Left), (12, Side::Right)] {
        let target = cutter.target(tooth, side).expect("a target");
        let [arcs_mm, rows_mm] = cutter.places_mm(target);
        let field = cutter.rays_over(target, arcs_mm, rows_mm[400..529].to_vec()).field;
        let own = compared(&format!("tooth {tooth}"), &gpu, &field, passes);
        sums = [sums[0] + own[0], sums[1] + own[1]];
        // At the lowest height that is recorded the first pass counts.
        compared(&format!("tooth {tooth}, raised"), &gpu, &raised(&field, 2e-3), passes);
    }
    assert!(2 * sums[0] < sums[1], "{sums:?}");
}

#[test]
fn bevel_flanks_are_searched_without_loss() {
    let gpu = software_gpu(GpuOptions { rows: Some(Rows::Few), ..strict() });
    for scene in ["five_linkage_corrected", "formate"] {
        let job = job(scene, &[]).expect("a gear");
        let mut sums = [0; 2];
        for (tooth, side) in [(1, Side::Left), (2, Side::Right)] {
            let field = patch(&job, tooth, side, [70, 129], [0.02, 0.05]).field;
            let set = job.slots.of(job.operations.len() - 1, job.space_of(tooth, side));
            let own = compared(&format!("{scene}, tooth {tooth}"), &gpu, &field, set);
            sums = [sums[0] + own[0], sums[1] + own[1]];
            compared(&format!("{scene}, tooth {tooth}, raised"), &gpu, &raised(&field, 1e-4), set);
        }
        assert!(sums[0] < sums[1], "{scene}: {sums:?}");
    }
}
