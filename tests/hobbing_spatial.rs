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
    for name in [
        "p09_patch_s2_axial",
        "p10_patch_s2_diag_VL",
        "p11_patch_circle",
        "p12_patch_spur",
        "p13_patch_s4_ellipse",
    ] {
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
                if !(nm <= worst.0) {
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

#[test]
fn debug() {
    let (case, passes, field, file) = patch("p09_patch_s2_axial");
    for e in data("p08_events_s2")["axial"]["events"].as_array().unwrap() {
        let g = number(e, "g");
        let pts = numbers(&e["edge_points_workpiece"]["left"][1]);
        let p = glam::DVec3::new(pts[1], pts[0], -pts[2]);
        let head = passes.motion.head_from_work(g * TAU / 10.0);
        println!("g {g} thread {} -> head {}", number(e, "thread_axial"), head.point(p));
    }
    let field = case.patch(3, 1.0, &[-10.0, -2.0, 5.0], &[-2.0, 0.0, 1.0]);
    let plan = SweepPlan::brute_force(&field, &passes, case.hob.edge());
    println!("brute: {} records {} segments", plan.records.len(), case.hob.edge().segments.len());
    for s in &case.hob.edge().segments { println!("{:?} {:?} {:?}", s.name, s.blade_from_segment, s.y_range_mm); }
    let mut layer = field.blank_layer();
    let stats = Cpu::default().cut_spatial(&field, case.hob.edge(), &plan, &mut layer).expect("cuts");
    println!("{:?} {:?} {:?}", layer.heights_mm, layer.passes, stats);
    println!("{:?}", numbers(&file["z"])[0]);
}
