//! The spatial kernel against an independent implementation: heights of hobbed flanks, the passes that left them.

mod hobbing_common;

use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::SpatialField;
use gearcut::passes::{HobTeeth, SweepPlan};
use gearcut::tool::CuttingTool;
use hobbing_common::*;
use serde_json::Value;
use std::f64::consts::TAU;

/// Largest difference from the oracle's heights: numerical resolution of the native backend.
const BOUND_NM: f64 = 0.1;

fn patch(name: &str) -> (Case, HobTeeth, SpatialField, Value) {
    let file = data(name);
    let case = Case::new(&file["setup"]);
    // The slide passes the patch within 3 mm and a facet; three cycles to either side hold every pass that can be lowest there.
    let cycle = TAU * f64::from(case.teeth) / number(&file["setup"], "K");
    let passes = case.passes([-3.5 * cycle, 4.5 * cycle]);
    let space = file["space"].as_i64().expect("space");
    let field = case.patch(space, number(&file, "flank"), &numbers(&file["sigma"]), &numbers(&file["z"]));
    (case, passes, field, file)
}

#[test]
fn patches_agree_with_the_independent_solver() {
    for name in
        ["p09_patch_s2_axial", "p10_patch_s2_diag_VL", "p11_patch_circle", "p12_patch_spur", "p13_patch_s4_ellipse"]
    {
        let (case, passes, field, file) = patch(name);
        let wanted = heights(name, &file);
        let plan = SweepPlan::new(&field, &passes, case.hob.edge());
        let mut layer = field.blank_layer();
        let stats = Cpu::default().cut_spatial(&field, case.hob.edge(), &plan, &mut layer).expect("cuts");
        let mut worst = (0.0, 0, 0);
        for (row, heights) in wanted.iter().enumerate() {
            for (column, wanted) in heights.iter().enumerate() {
                let got = f64::from(layer.heights_mm[field.index(column, row)]);
                let nm = (got - wanted).abs() * 1e6;
                assert!(nm.is_finite());
                if nm > worst.0 {
                    worst = (nm, column, row);
                }
            }
        }
        let per_dexel = stats.dexel_passes as f64 / field.len() as f64;
        println!(
            "{name}: {} passes, {:.1} candidates per dexel, worst {:.4} nm at column {} row {}",
            passes.count(),
            per_dexel,
            worst.0,
            worst.1,
            worst.2
        );
        assert_eq!(stats.unconverged, 0);
        assert!(worst.0 < BOUND_NM, "{name}: {worst:?}");
    }
}

#[test]
fn target_rays_are_those_of_the_independent_implementation() {
    for name in ["p09_patch_s2_axial", "p10_patch_s2_diag_VL"] {
        let (_, _, field, file) = patch(name);
        for point in file["nominal_points"].as_array().expect("points") {
            let index = |key: &str| point[key].as_u64().expect("an index") as usize;
            let ray = field.ray(index("isigma"), index("iz"));
            let exchanged = |v: &Value| {
                let v = numbers(v);
                glam::DVec3::new(v[1], v[0], -v[2])
            };
            let (p, n) = (exchanged(&point["P"]), exchanged(&point["N"]));
            println!("{name}: {} against {p}, {} against {n}", ray.origin_mm, ray.normal);
            assert!(ray.origin_mm.distance(p) < 1e-9 && ray.normal.distance(n) < 1e-12);
        }
    }
}

/// Two plans of one field leave the same bytes.
fn same_as_brute_force(name: &str, case: &Case, passes: &HobTeeth, field: &SpatialField) {
    let run = |plan: &SweepPlan| {
        let mut layer = field.blank_layer();
        let stats = Cpu::default().cut_spatial(field, case.hob.edge(), plan, &mut layer).expect("cuts");
        assert_eq!(stats.unconverged, 0, "{name}");
        layer
    };
    let [plan, all] = [SweepPlan::new, SweepPlan::brute_force].map(|make| make(field, passes, case.hob.edge()));
    let (few, brute) = (run(&plan), run(&all));
    let differ =
        (0..field.len()).filter(|&i| few.heights_mm[i] != brute.heights_mm[i] || few.passes[i] != brute.passes[i]);
    let differ: Vec<usize> = differ.collect();
    println!(
        "{name}: {} tiles, {} of {} records, {} dexels differ",
        plan.tiles.len(),
        plan.records.len(),
        all.records.len(),
        differ.len()
    );
    assert!(differ.is_empty(), "{name}: dexel {} of {}", differ[0], field.len());
}

#[test]
fn candidates_leave_what_all_passes_leave() {
    let even = |from: f64, to: f64, count: usize| -> Vec<f64> {
        (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
    };
    // Tiles as in use (20 um by 50 um), stratified over the profile from the tip corner's trochoid to the gear's tip; the ends have the longest lists.
    let cases: [(&str, &[[f64; 2]]); 3] = [
        ("p09_patch_s2_axial", &[[-26.0, -2.6], [-14.0, 0.7], [8.0, -1.0], [23.0, 0.7]]),
        ("p10_patch_s2_diag_VL", &[[-3.0, -2.6], [23.0, -2.6]]),
        ("p13_patch_s4_ellipse", &[[-26.0, 0.7], [8.0, -2.6]]),
    ];
    for (name, places) in cases {
        let (case, passes, _, file) = patch(name);
        let (space, flank) = (file["space"].as_i64().expect("space"), number(&file, "flank"));
        for &[sigma, z] in places {
            let field = case.patch(space, flank, &even(sigma, sigma + 0.8, 16), &even(z, z + 1.55, 32));
            same_as_brute_force(&format!("{name} at {sigma}, {z}"), &case, &passes, &field);
        }
        // A whole flank, coarse: regions as large as the first halvings.
        let field = case.patch(space, flank, &even(-26.0, 24.0, 20), &even(-12.0, 12.0, 34));
        same_as_brute_force(&format!("{name}, whole"), &case, &passes, &field);
    }
}

/// A gash touches the target in one point, where it lies on it exactly: a ray there is left by a tooth of that gash and of no other.
#[test]
fn marks_are_left_by_the_gashes_of_the_independent_implementation() {
    let file = data("p08_events_s2");
    for name in ["axial", "diagonal_VL"] {
        let part = &file[name];
        let case = Case::new(&part["setup"]);
        let cycle = TAU * f64::from(case.teeth);
        let passes = case.passes([-3.5 * cycle, 4.5 * cycle]);
        let gash_rad = TAU / number(&part["setup"], "Zb");
        let (space, flank) = (part["space"].as_i64().expect("space"), number(part, "flank"));
        let events = part["events"].as_array().expect("events");
        for event in events {
            let mark = &event["mark"];
            let field = case.patch(space, flank, &[number(mark, "sigma")], &[number(mark, "z")]);
            let plan = SweepPlan::new(&field, &passes, case.hob.edge());
            let mut layer = field.blank_layer();
            Cpu::default().cut_spatial(&field, case.hob.edge(), &plan, &mut layer).expect("cuts");
            let pass = passes.pass(layer.passes[0] - passes.first_pass);
            let gash = (pass.tool_angle_rad / gash_rad).round() as i64;
            assert_eq!(gash, event["g"].as_i64().expect("g"), "{name} at {mark}");
            assert!(layer.heights_mm[0].abs() < 1e-7, "{name} at {mark}: {} mm", layer.heights_mm[0]);
        }
        assert!(events.len() >= 17);
    }
}
