//! The spatial kernel on the GPU against the native one: hobbed patches, tile by tile, and proof that the comparison
//! can fail.

use super::patches::all_of_patches;
use crate::fixtures::oracle_cases::*;
use crate::fixtures::parity::*;

use crate::hobbing::drawn_teeth::cycloid_job;
use gearcut::cut::cpu::Cpu;
use gearcut::cut::{Backend, CutLayers, SweptBy, SweptField};
use gearcut::dexel::SpatialField;
use gearcut::gpu::shaders::Rows;
use gearcut::gpu::{Gpu, GpuOptions, OnGpuFailure};
use gearcut::passes::{SweepPlan, TurningPasses};
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::terms::Side;
use serde_json::Value;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Mutex;

/// [`fingerprint`] of the first patch: llvmpipe rounds alike in all its versions.
const GOLDEN: u64 = 0xe90c_a570_dd4b_ef69;

/// What the shader may add to a height, nm, as its head says; 0.95 measured.
const ADDED_NM: f64 = 2.0;

fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
}

/// A coarse flank from below the tip corner's trochoid to the gear's tip: one tile wide patches at all places of it.
fn case(name: &str) -> (TurningPasses, SpatialField) {
    let file = data(name);
    let case = Case::new(&file["setup"]);
    let cycle = TAU * f64::from(case.teeth) / number(&file["setup"], "K");
    let passes = case.passes([-3.5 * cycle, 4.5 * cycle]);
    (passes, patch(&file, &case))
}

fn patch(file: &Value, case: &Case) -> SpatialField {
    let (space, flank) = (file["space"].as_i64().expect("space"), number(file, "flank"));
    case.patch(space, flank, &even(-26.0, 24.0, 120), &even(-5.0, 5.0, 131))
}

#[test]
fn hobbed_flanks_are_cut_alike() {
    let gpu = software_gpu(strict());
    // One row a thread, as on GPUs.
    let few = software_gpu(GpuOptions { rows: Some(Rows::Few), ..strict() });
    let mut all = Parity::default();
    for name in
        ["p09_patch_s2_axial", "p10_patch_s2_diag_VL", "p11_patch_circle", "p12_patch_spur", "p13_patch_s4_ellipse"]
    {
        let (passes, field) = case(name);
        let plan = SweepPlan::new(&field, &passes);
        let (parity, native, shifted, got) = cut_both_in_space(&gpu, name, &field, &plan);
        println!("{parity}");
        assert_eq!(parity.verdict_within(ADDED_NM), Ok(()), "{name}");
        all.merge(parity);
        // As GPUs have it: patch by patch.
        let in_patches = SweepPlan::in_patches(&field, &passes);
        let (parity, ..) = cut_both_in_space(&gpu, name, &field, &in_patches);
        println!("{parity} in patches");
        assert_eq!(parity.verdict_within(ADDED_NM), Ok(()), "{name} in patches");
        let swept = SweptField { field: field.clone(), operations: vec![vec![&passes]], by: SweptBy::Candidates };
        let own = |gpu: &Gpu| swept.clone().cut(gpu).expect("cuts").layers;
        let in_cells = SweepPlan::in_cells(&field, &passes);
        let (parity, .., of_cells) = cut_both_in_space(&gpu, name, &field, &in_cells);
        assert_eq!(parity.verdict_within(ADDED_NM), Ok(()), "{name} in cells");
        assert!(own(&gpu) == [of_cells], "{name}: a job is its plan");
        let mut alone = field.blank_layer();
        let stats = few.cut_spatial(&field, &plan, &mut alone).expect("cuts");
        assert!(
            (plan.dexel_passes()..=plan.tile_passes()).contains(&stats.dexel_passes),
            "{name}: two cells at a time"
        );
        let mut of_patches = field.blank_layer();
        let searched = few.cut_spatial(&field, &in_patches, &mut of_patches).expect("cuts");
        assert!(own(&few) == [of_patches.clone()], "{name}: a GPU's job is its plan");
        let by_all = all_of_patches(&few, &field, &in_patches);
        assert!(of_patches == by_all.0, "{name}: a search on the device leaves something else than all of a patch");
        assert!(searched.dexel_passes < by_all.1, "{name}: the device leaves out nothing");
        for layer in [&alone, &of_patches] {
            let mut parity = Parity::default();
            parity.add("one row a thread", field.rows(), &native, &shifted, layer);
            assert_eq!(parity.verdict_within(ADDED_NM), Ok(()), "{name}");
        }
        if name == "p09_patch_s2_axial" {
            let hash = fingerprint(std::slice::from_ref(&got));
            println!("hash {hash:#018x}");
            assert_eq!(hash, GOLDEN, "other bytes than before on {}", gpu.name());
            // The comparison is alive: a dexel 20 nm off, a poisoned one, and passes 50 nm off are seen.
            let at = native.passes.iter().position(|&pass| pass != u32::MAX).expect("a cut dexel");
            for plant in [got.heights_mm[at] + 2e-5, f32::from_bits(u32::MAX)] {
                let mut planted = got.clone();
                planted.heights_mm[at] = plant;
                let mut parity = Parity::default();
                parity.add("planted", field.rows(), &native, &shifted, &planted);
                assert!(parity.verdict_within(ADDED_NM).is_err(), "{plant}");
            }
            let mut lifted = plan.clone();
            lifted.records.iter_mut().for_each(|record| record.place_mm[0][0] += 5e-5);
            let mut layer = field.blank_layer();
            gpu.cut_spatial(&field, &lifted, &mut layer).expect("cuts");
            let mut parity = Parity::default();
            parity.add("lifted", field.rows(), &native, &shifted, &layer);
            assert!(parity.verdict_within(ADDED_NM).is_err());
        }
    }
    println!("all: {all}");
}

/// Hollow teeth cut as their tangents: a hob of cycloids, by candidates and by all passes.
#[test]
fn hobs_with_hollow_teeth_are_cut_alike() {
    let gpu = software_gpu(strict());
    let job = cycloid_job();
    let cutter = HobCutter::new(&job).expect("passes");
    let target = cutter.target(3, Side::Left).expect("a target");
    let [arcs_mm, rows_mm] = cutter.places_mm(target).map(|places| places.into_iter().step_by(4).collect());
    let field = cutter.rays_over(target, arcs_mm, rows_mm).field;
    let passes = cutter.operations.last().expect("one");
    let (parity, .., known) = cut_both_in_space(&gpu, "cycloids", &field, &SweepPlan::new(&field, passes));
    println!("{parity}");
    assert_eq!(parity.verdict_within(ADDED_NM), Ok(()));
    let mut all = field.blank_layer();
    gpu.cut_spatial(&field, &SweepPlan::brute_force(&field, passes), &mut all).expect("cuts");
    assert!(known == all, "candidates leave something else than all passes");
}

#[test]
fn a_fault_far_below_the_bound_changes_the_golden_bytes() {
    let gpu = software_gpu(strict());
    let (passes, field) = case("p09_patch_s2_axial");
    let honest = SweepPlan::new(&field, &passes);
    let cut = |plan: &SweepPlan| {
        let mut layer = field.blank_layer();
        gpu.cut_spatial(&field, plan, &mut layer).expect("cuts");
        layer
    };
    let whole = cut(&honest);
    assert_eq!(fingerprint(std::slice::from_ref(&whole)), GOLDEN, "nothing is planted");
    // The pass that left the dexel in the middle of the patch, 2 nm off.
    let lost = whole.passes[whole.passes.len() / 2];
    let mut moved = honest;
    moved.records.iter_mut().filter(|record| record.pass == lost).for_each(|record| record.place_mm[0][0] += 2e-6);
    assert_ne!(fingerprint(&[cut(&moved)]), GOLDEN, "a pass 2 nm off");
}

#[test]
fn small_batches_give_the_same_bytes() {
    let (passes, field) = case("p11_patch_circle");
    let plan = SweepPlan::new(&field, &passes);
    let cut = |memory_limit_bytes: Option<u64>| {
        let gpu = software_gpu(GpuOptions { memory_limit_bytes, ..strict() });
        let mut layer = field.blank_layer();
        gpu.cut_spatial(&field, &plan, &mut layer).expect("fits");
        (layer, gpu.stage_times())
    };
    let (whole, one) = cut(None);
    let (parts, many) = cut(Some(300_000));
    println!("{} batches against {}", many[0].batches, one[0].batches);
    assert!(many[0].batches > 5 * one[0].batches);
    assert!(whole == parts, "batches change the result");
    // A tile that does not fit is a problem with a reason, not a wrong result.
    let gpu = software_gpu(GpuOptions { memory_limit_bytes: Some(20_000), ..strict() });
    let refused = gpu.cut_spatial(&field, &plan, &mut field.blank_layer());
    assert!(refused.is_err_and(|error| error.to_string().contains("groups")));
}

/// Operations of a field follow each other where its dexels lie, and fields share a submission; a field that does not
/// fit is cut alike, and one whose device is lost as natively.
#[test]
fn operations_in_turn_leave_the_bytes_of_operations_one_by_one() {
    let file = data("p11_patch_circle");
    let case = Case::new(&file["setup"]);
    let cycle = TAU * f64::from(case.teeth) / number(&file["setup"], "K");
    let operations = [[-3.5, 0.0], [-3.5, 4.5]].map(|ends: [f64; 2]| case.passes(ends.map(|end| end * cycle)));
    let field = patch(&file, &case);
    let swept = SweptField {
        field: field.clone(),
        operations: operations.iter().map(|passes| vec![passes]).collect(),
        by: SweptBy::Candidates,
    };
    let gpu = software_gpu(strict());
    let left = swept.clone().cut(&gpu).expect("cuts");
    assert_eq!(gpu.stage_times()[0].batches, 1, "one submission");
    let mut layer = field.blank_layer();
    for (passes, left) in operations.iter().zip(&left.layers) {
        let stats = gpu.cut_spatial(&field, &SweepPlan::in_cells(&field, passes), &mut layer).expect("cuts");
        assert!(stats.unconverged == 0 && layer == *left, "an operation by itself leaves something else");
    }
    assert!(left.layers[0] != left.layers[1]);
    let small = software_gpu(GpuOptions { memory_limit_bytes: Some(300_000), ..strict() });
    assert!(swept.clone().cut(&small).expect("cuts") == left, "batches change the result");
    let lost = software_gpu(GpuOptions { on_failure: OnGpuFailure::RedoNatively, ..strict() });
    lost.lose_device();
    let native = swept.clone().cut(&Cpu::default()).expect("cuts");
    assert!(swept.cut(&lost).expect("cut natively") == native && lost.incidents().len() == 1);
}

/// Fields of other sizes and with more or fewer operations share launches; each is left as it is by itself.
#[test]
fn fields_that_share_launches_leave_the_bytes_of_each_alone() {
    let cases = ["p11_patch_circle", "p12_patch_spur", "p09_patch_s2_axial"].map(case);
    let fields: Vec<SweptField> = (1..4)
        .zip(&cases)
        .map(|(operations, (passes, field))| SweptField {
            field: field.clone(),
            operations: vec![vec![passes]; operations],
            by: SweptBy::Candidates,
        })
        .collect();
    let together = |gpu: &Gpu, fields: &[SweptField]| {
        let done = Mutex::new(BTreeMap::new());
        let take = |index: usize, _: SweptField, left: CutLayers| {
            assert!(done.lock().expect("no panic").insert(index, left).is_none(), "field {index} comes twice");
            Ok(())
        };
        gpu.cut_swept(fields.len(), &|index| Ok(Some(fields[index].clone())), &take).expect("cuts");
        done.into_inner().expect("no panic").into_values().collect::<Vec<CutLayers>>()
    };
    for rows in [Rows::Many, Rows::Few] {
        let gpu = software_gpu(GpuOptions { rows: Some(rows), ..strict() });
        let left = together(&gpu, &fields);
        assert_eq!(gpu.stage_times()[0].batches, 1, "one submission");
        let alone: Vec<CutLayers> = fields.iter().map(|swept| swept.clone().cut(&gpu).expect("cuts")).collect();
        assert!(left == alone, "layers or counts differ");
        assert!(together(&gpu, &fields) == left, "other bytes the second time");
        // Alive: the second field of other passes.
        let mut other = fields.clone();
        other[1].operations = vec![vec![&cases[0].0]; 2];
        assert!(together(&gpu, &other)[1] != left[1]);
    }
}

mod slow {
    use super::*;

    #[test]
    fn flanks_of_helical_gashes_are_cut_alike() {
        let gpu = software_gpu(strict());
        let sets = ["fields.flank.profile_spacing_um=80", "fields.flank.lead_spacing_um=400"].map(str::to_owned);
        let loaded = load(Path::new("scenes/hobbing/circular_helical.toml"), &sets).unwrap_or_else(|e| panic!("{e}"));
        let job = HobbingJob::new(&loaded.scene).expect("a scene that cuts");
        let cutter = HobCutter::new(&job).expect("passes");
        let mut all = Parity::default();
        for (tooth, side) in [(1, Side::Left), (1, Side::Right), (23, Side::Left)] {
            let (_, rays) = cutter.rays(tooth, side).expect("a flank");
            for (operation, passes) in job.operations.iter().zip(cutter.operations.iter()) {
                let plan = SweepPlan::new(&rays.field, passes);
                // The rake face turns by this much over the height of a tooth.
                let twist_rad_per_mm =
                    plan.records.iter().map(|record| record.twist_rad_per_mm.abs()).fold(f64::INFINITY, f64::min);
                assert!(twist_rad_per_mm > 1e-4, "the rake faces are planes");
                let place = format!("tooth {tooth} {}, {}", side.name(), operation.spec.name);
                let (parity, native, shifted, got) = cut_both_in_space(&gpu, &place, &rays.field, &plan);
                let heights = native.heights_mm.iter().map(|&h| 1e3 * f64::from(h));
                let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], h| [a.min(h), b.max(h)]);
                println!(
                    "{place}: twist {:.4} deg/mm, heights {low:.3} to {high:.3} um; {parity}",
                    twist_rad_per_mm.to_degrees()
                );
                assert_eq!(parity.verdict_within(ADDED_NM), Ok(()), "{place}");
                all.merge(parity);
                // A rake face that is taken for a plane is seen.
                let mut plane = plan.clone();
                plane.records.iter_mut().for_each(|record| record.twist_rad_per_mm = 0.0);
                let mut layer = rays.field.blank_layer();
                gpu.cut_spatial(&rays.field, &plane, &mut layer).expect("cuts");
                assert!(layer != got);
                let mut parity = Parity::default();
                parity.add("plane", rays.field.rows(), &native, &shifted, &layer);
                assert!(parity.verdict_within(ADDED_NM).is_err());
            }
        }
        println!("all: {all}");
    }

    #[test]
    fn long_lists_go_through_in_rounds() {
        // All passes that can reach the flank at all, on a few of its dexels.
        let (passes, field) = case("p12_patch_spur");
        let few = SpatialField::new(8, 5, field.low_mm, |column, row| {
            let [column, row] = [15 * column, 28 * row];
            (field.ray(column, row), f64::from(field.blank_mm[field.index(column, row)]))
        });
        let plan = SweepPlan::brute_force(&few, &passes);
        let longest = plan.tiles.iter().map(|tile| tile.records.len()).max().expect("tiles");
        println!("{longest} records in a tile");
        assert!(longest > 8 * 1024, "these lists fit a few rounds");
        let gpu = software_gpu(strict());
        let (parity, _, _, whole) = cut_both_in_space(&gpu, "all passes", &few, &plan);
        println!("{parity}");
        assert_eq!(parity.verdict_within(ADDED_NM), Ok(()));
        // Rounds of other lengths leave the same bytes.
        let cut = |memory_limit_bytes: Option<u64>, plan: &SweepPlan| {
            let gpu = software_gpu(GpuOptions { memory_limit_bytes, ..strict() });
            let mut layer = few.blank_layer();
            gpu.cut_spatial(&few, plan, &mut layer).expect("no list is too long");
            layer
        };
        assert!(cut(Some(300_000), &plan) == whole, "rounds change the result");
        // A GPU that searches them, round by round, leaves what it leaves by all of them.
        let gpu = software_gpu(GpuOptions { rows: Some(Rows::Few), ..strict() });
        let searched = SweepPlan { has_open_cells: true, ..plan.clone() };
        let mut layer = few.blank_layer();
        let visits = gpu.cut_spatial(&few, &searched, &mut layer).expect("cuts").dexel_passes;
        let (all, of_all) = all_of_patches(&gpu, &few, &searched);
        println!("{visits} visits of {of_all}");
        assert!(layer == all && 4 * visits < of_all, "{visits} visits of {of_all}");
        // Alive: the first round alone leaves something else.
        let mut short = plan.clone();
        short.tiles.iter_mut().for_each(|tile| tile.records.end = tile.records.start + 1024.min(tile.records.len()));
        assert!(cut(None, &short) != whole);
    }
}
