//! The spatial kernel on the GPU against the native one: hobbed patches, tile by tile, and proof that the comparison can fail.

mod gpu_common;
mod hobbing_common;

use gearcut::cut::Backend;
use gearcut::dexel::SpatialField;
use gearcut::passes::{HobTeeth, SweepPlan};
use gearcut::tool::CuttingTool;
use gpu_common::*;
use hobbing_common::*;
use std::f64::consts::TAU;

/// FNV-1a over the bits of heights and passes of the first patch: llvmpipe rounds alike in all its versions.
const GOLDEN: u64 = 0x4829_c375_1cb1_4edd;

fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
}

/// A coarse flank from below the tip corner's trochoid to the gear's tip: one tile wide patches at all places of it.
fn case(name: &str) -> (Case, HobTeeth, SpatialField) {
    let file = data(name);
    let case = Case::new(&file["setup"]);
    let cycle = TAU * f64::from(case.teeth) / number(&file["setup"], "K");
    let passes = case.passes([-3.5 * cycle, 4.5 * cycle]);
    let (space, flank) = (file["space"].as_i64().expect("space"), number(&file, "flank"));
    let field = case.patch(space, flank, &even(-26.0, 24.0, 120), &even(-5.0, 5.0, 131));
    (case, passes, field)
}

#[test]
fn hobbed_flanks_are_cut_alike() {
    let gpu = software_gpu(strict());
    let mut all = Parity::default();
    for name in ["p09_patch_s2_axial", "p10_patch_s2_diag_VL", "p12_patch_spur", "p13_patch_s4_ellipse"] {
        let (case, passes, field) = case(name);
        let plan = SweepPlan::new(&field, &passes, case.hob.edge());
        let (parity, native, shifted, got) = cut_both_in_space(&gpu, name, &field, case.hob.edge(), &plan);
        println!("{parity}");
        assert_eq!(parity.verdict(), Ok(()), "{name}");
        all.merge(parity);
        if name == "p09_patch_s2_axial" {
            let bits = got.heights_mm.iter().map(|h| h.to_bits()).chain(got.passes.iter().copied());
            let hash = bits
                .flat_map(u32::to_le_bytes)
                .fold(0xcbf2_9ce4_8422_2325, |hash: u64, b| (hash ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3));
            println!("hash {hash:#018x}");
            assert_eq!(hash, GOLDEN, "other bytes than before on {}", gpu.name());
            // The comparison is alive: a dexel 20 nm off, a poisoned one, and passes 50 nm off are seen.
            let at = native.passes.iter().position(|&pass| pass != u32::MAX).expect("a cut dexel");
            for plant in [got.heights_mm[at] + 2e-5, f32::from_bits(u32::MAX)] {
                let mut planted = got.clone();
                planted.heights_mm[at] = plant;
                let mut parity = Parity::default();
                parity.add("planted", field.rows(), &native, &shifted, &planted);
                assert!(parity.verdict().is_err(), "{plant}");
            }
            let mut lifted = plan.clone();
            lifted.records.iter_mut().for_each(|record| record.place_mm[0][0] += 5e-5);
            let mut layer = field.blank_layer();
            gpu.cut_spatial(&field, case.hob.edge(), &lifted, &mut layer).expect("cuts");
            let mut parity = Parity::default();
            parity.add("lifted", field.rows(), &native, &shifted, &layer);
            assert!(parity.verdict().is_err());
        }
    }
    println!("all: {all}");
}

#[test]
fn small_batches_give_the_same_bytes() {
    let (case, passes, field) = case("p11_patch_circle");
    let plan = SweepPlan::new(&field, &passes, case.hob.edge());
    let cut = |memory_limit_bytes: Option<u64>| {
        let gpu = software_gpu(gearcut::cut::gpu::GpuOptions { memory_limit_bytes, ..strict() });
        let mut layer = field.blank_layer();
        gpu.cut_spatial(&field, case.hob.edge(), &plan, &mut layer).expect("fits");
        (layer, gpu.stage_times())
    };
    let (whole, one) = cut(None);
    let (parts, many) = cut(Some(300_000));
    println!("{} batches against {}", many[0].batches, one[0].batches);
    assert!(many[0].batches > 5 * one[0].batches);
    assert!(whole == parts, "batches change the result");
    // A tile that does not fit is a problem with a reason, not a wrong result.
    let gpu = software_gpu(gearcut::cut::gpu::GpuOptions { memory_limit_bytes: Some(20_000), ..strict() });
    let refused = gpu.cut_spatial(&field, case.hob.edge(), &plan, &mut field.blank_layer());
    assert!(refused.is_err_and(|error| error.to_string().contains("groups")));
}
