//! The spatial kernel against an independent implementation: heights of hobbed flanks, the passes that left them.

use crate::fixtures::layers::{frames_apart_mm, same_but_for_frames};
use crate::fixtures::oracle_cases::*;
use gearcut::cut::Backend;
use gearcut::cut::cpu::{Cpu, Vectors};
use gearcut::dexel::{Layer, SpatialField};
use gearcut::passes::{SweepPlan, TurningPasses};
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::terms::Side;
use serde_json::Value;
use std::f64::consts::TAU;
use std::path::Path;

/// Largest difference from the oracle's heights: numerical resolution of the native backend.
const BOUND_NM: f64 = 0.1;

fn patch(name: &str) -> (Case, TurningPasses, SpatialField, Value) {
    let file = data(name);
    let case = Case::new(&file["setup"]);
    // The slide passes the patch within 3 mm and a facet; three cycles to either side hold every pass that can be
    // lowest there.
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
        let (_, passes, field, file) = patch(name);
        let wanted = heights(name, &file);
        let plan = SweepPlan::new(&field, &passes);
        let mut layer = field.blank_layer();
        let stats = Cpu::default().cut_spatial(&field, &plan, &mut layer).expect("cuts");
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
fn all_instruction_sets_give_the_same_bytes() {
    let (_, passes, field, _) = patch("p12_patch_spur");
    let few = SpatialField::new(field.columns() / 4, field.rows() / 4, field.low_mm, |column, row| {
        let [column, row] = [4 * column, 4 * row];
        (field.ray(column, row), f64::from(field.blank_mm[field.index(column, row)]))
    });
    let plan = SweepPlan::new(&few, &passes);
    let cut = |cpu: Cpu| {
        let mut layer = few.blank_layer();
        cpu.cut_spatial(&few, &plan, &mut layer).expect("cuts");
        layer
    };
    let widest = cut(Cpu::default());
    for vectors in [Vectors::Baseline, Vectors::Avx2] {
        let Some(cpu) = Cpu::with_vectors(vectors) else { continue };
        assert!(cut(cpu) == widest, "{} differs from the widest", cpu.instruction_set());
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
pub(super) fn same_as_brute_force(name: &str, passes: &TurningPasses, field: &SpatialField, start: &Layer) -> Layer {
    let run = |plan: &SweepPlan, every_root: bool| {
        let mut layer = start.clone();
        let stats = Cpu::default().cut_spatial(field, plan, &mut layer).expect("cuts");
        // Of a hundred million pairs a few are rays that graze a round tip far above what is left in the end.
        assert!(stats.unconverged == 0 || (!every_root && stats.unconverged < 10), "{name}: {}", stats.unconverged);
        assert_eq!(stats.dexel_passes, plan.dexel_passes(), "{name}");
        layer
    };
    let [plan, all] = [SweepPlan::new, SweepPlan::brute_force].map(|make| make(field, passes));
    let (few, brute) = (run(&plan, true), run(&all, false));
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
    let whole_tiles = SweepPlan::in_patches(field, passes);
    same_but_for_frames(name, &run(&whole_tiles, false), &brute, frames_apart_mm([&plan, &whole_tiles]));
    brute
}

/// A gash touches the target in one point, where it lies on it exactly: a ray there is left by a tooth of that gash and
/// of no other.
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
            let plan = SweepPlan::new(&field, &passes);
            let mut layer = field.blank_layer();
            Cpu::default().cut_spatial(&field, &plan, &mut layer).expect("cuts");
            let pass = passes.pass(layer.passes[0] - passes.first_pass);
            let gash = (pass.tool_angle_rad / gash_rad).round() as i64;
            assert_eq!(gash, event["g"].as_i64().expect("g"), "{name} at {mark}");
            assert!(layer.heights_mm[0].abs() < 1e-7, "{name} at {mark}: {} mm", layer.heights_mm[0]);
        }
        assert!(events.len() >= 17);
    }
}

/// Roots in one section or two, as pairs of gears roll them: rays there look across the hob's tips.
#[test]
fn candidates_of_roots_in_single_sections_leave_what_all_passes_leave() {
    let scene = load(Path::new("scenes/hobbing/third_order_plain.toml"), &[]).expect("the scene").scene;
    let job = HobbingJob::new(&scene).expect("the gear");
    let cutter = HobCutter::new(&job).expect("passes");
    let passes = &cutter.operations[0];
    for rows_z_mm in [&[25.0][..], &[24.9, 25.0]] {
        let whole = cutter.root_rays(10, 0.01, rows_z_mm).expect("a root").field;
        let cut = |field: &SpatialField, plan: &SweepPlan| {
            let mut layer = field.blank_layer();
            Cpu::default().cut_spatial(field, plan, &mut layer).expect("cuts");
            layer
        };
        let few = cut(&whole, &SweepPlan::new(&whole, passes));
        let uncut = (0..whole.len()).filter(|&i| few.passes[i] == gearcut::dexel::NO_PASS).count();
        println!("{} columns, {uncut} dexels not cut", whole.columns());
        // A part of it by brute force: every pass that comes near at all.
        let [from, columns] = [whole.columns() * 35 / 100, 64];
        let part = SpatialField::new(columns, rows_z_mm.len(), whole.low_mm, |column, row| {
            (whole.ray(from + column, row), f64::from(whole.blank_mm[whole.index(from + column, row)]))
        });
        let all = cut(&part, &SweepPlan::brute_force(&part, passes));
        let differ: Vec<_> = (0..part.len())
            .map(|i| (i, whole.index(from + i / part.rows(), i % part.rows())))
            // Tiles of the part have other origins: the last bit of a height may differ.
            .filter(|&(i, own)| (few.heights_mm[own] - all.heights_mm[i]).abs() > 1e-8)
            .map(|(i, own)| (own, few.heights_mm[own], all.heights_mm[i], few.passes[own], all.passes[i]))
            .collect();
        assert!(differ.is_empty(), "{rows_z_mm:?}: {} of {} differ: {differ:?}", differ.len(), part.len());
    }
}

/// Fields of few columns or rows, as roots and texture windows have them: the search for passes halves them wherever
/// there is something to halve, loses nothing, and keeps no more of the passes than on a tile that is full.
#[test]
fn narrow_fields_are_culled_and_lose_nothing() {
    let (case, passes, _, file) = patch("p09_patch_s2_axial");
    let (space, flank) = (file["space"].as_i64().expect("space"), number(&file, "flank"));
    let line = |from: f64, step: f64, count: usize| (0..count).map(|i| from + step * i as f64).collect::<Vec<_>>();
    let sizes =
        [[1, 1], [1, 40], [2, 2], [3, 5], [4, 9], [5, 4], [8, 16], [9, 17], [13, 3], [16, 7], [17, 2], [17, 33]];
    let near = sizes.map(|size| (size, 0.05));
    // Rows so far apart that tiles have four of them, two or one.
    let far = [0.3, 0.6, 1.0].map(|apart_mm| ([9, 7], apart_mm));
    for ([columns, rows], apart_mm) in near.into_iter().chain(far) {
        for [sigma, z] in [[-14.0, 0.7], [8.0, -1.0]] {
            let field = case.patch(space, flank, &line(sigma, 0.05, columns), &line(z, apart_mm, rows));
            let name = format!("{columns} by {rows}, {apart_mm} mm apart, at {sigma}, {z}");
            same_as_brute_force(&name, &passes, &field, &field.blank_layer());
            let per_dexel = SweepPlan::new(&field, &passes).dexel_passes() as f64 / field.len() as f64;
            println!("{name}: {per_dexel:.1} passes per dexel");
            assert!(per_dexel < 8.0, "{name}: {per_dexel} passes per dexel");
        }
    }
}

mod slow {
    use super::*;

    #[test]
    fn candidates_leave_what_all_passes_leave() {
        let even = |from: f64, to: f64, count: usize| -> Vec<f64> {
            (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
        };
        // Tiles as in use (20 um by 50 um), stratified over the profile from the tip corner's trochoid to the gear's
        // tip; the ends have the longest lists.
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
                same_as_brute_force(&format!("{name} at {sigma}, {z}"), &passes, &field, &field.blank_layer());
            }
            // A whole flank, coarse: regions as large as the first halvings.
            let field = case.patch(space, flank, &even(-26.0, 24.0, 20), &even(-12.0, 12.0, 34));
            same_as_brute_force(&format!("{name}, whole"), &passes, &field, &field.blank_layer());
        }
    }

    /// Large modules with many starts, and few teeth per start: the work moves far while a blade sweeps. What
    /// candidates leave is what all passes of the operation leave, taken without any look at where they are.
    #[test]
    fn candidates_of_coarse_gears_leave_what_every_pass_leaves() {
        let cases = [
            [
                "gear.module_mm=50",
                "gear.teeth=30",
                "gear.face_width_mm=40",
                "tool.hob.starts=6",
                "tool.hob.reference_diameter_mm=1000",
                "tool.hob.length_mm=700",
                "tool.hob.tip_radius_mm=8",
                "operation.finish.axial_feed_mm_per_revolution=20",
            ],
            [
                "gear.module_mm=6",
                "gear.teeth=18",
                "gear.face_width_mm=10",
                "tool.hob.starts=6",
                "tool.hob.reference_diameter_mm=130",
                "tool.hob.length_mm=110",
                "tool.hob.tip_radius_mm=1",
                "operation.finish.axial_feed_mm_per_revolution=4",
            ],
        ];
        for sets in cases {
            let coarse = ["fields.flank.profile_spacing_um=200", "fields.flank.lead_spacing_um=200"];
            let sets: Vec<String> = sets.into_iter().chain(coarse).map(str::to_owned).collect();
            let scene = load(Path::new("scenes/hobbing/circular_spur.toml"), &sets);
            let scene = scene.unwrap_or_else(|problem| panic!("{problem}")).scene;
            let job = HobbingJob::new(&scene).expect("the gear");
            let cutter = HobCutter::new(&job).expect("passes");
            let passes = &cutter.operations[0];
            for (tooth, side) in [(1, Side::Left), (2, Side::Right)] {
                let whole = cutter.rays(tooth, side).expect("a flank").1.field;
                let [columns, rows] = [whole.columns() / 8, whole.rows() / 8];
                // On the one flank from its first ray on, on the other between them.
                let [from_column, from_row] = if tooth == 1 { [0, 0] } else { [columns / 2, rows / 2] };
                let field = SpatialField::new(8, 8, whole.low_mm, |column, row| {
                    let (column, row) = (from_column + columns * column, from_row + rows * row);
                    (whole.ray(column, row), f64::from(whole.blank_mm[whole.index(column, row)]))
                });
                let cut = |plan: &SweepPlan| {
                    let mut layer = field.blank_layer();
                    Cpu::default().cut_spatial(&field, plan, &mut layer).expect("cuts");
                    layer
                };
                let [plan, all] = [SweepPlan::new, SweepPlan::of_all_passes].map(|make| make(&field, passes));
                let (few, every) = (cut(&plan), cut(&all));
                println!(
                    "{}: {} of {} records of {} passes",
                    sets[0],
                    plan.records.len(),
                    all.records.len(),
                    passes.count()
                );
                assert!(every.passes.iter().filter(|&&pass| pass != u32::MAX).count() > 32);
                let differ: Vec<_> = (0..field.len())
                    .filter(|&i| few.heights_mm[i] != every.heights_mm[i] || few.passes[i] != every.passes[i])
                    .map(|i| (i, few.heights_mm[i], every.heights_mm[i], few.passes[i], every.passes[i]))
                    .collect();
                assert!(differ.is_empty(), "{sets:?}, tooth {tooth}: {differ:?}");
            }
        }
    }

    /// Whole jobs, from the approach to the overrun: candidates start from all passes of an operation, of which most
    /// work on other teeth. Two cuts with a radial approach, helical gashes and round tips; a hob that shifts; and one
    /// that turns round all the time, so that sweeps end where others go on.
    #[test]
    fn candidates_of_whole_jobs_leave_what_all_passes_leave() {
        let cases = [
            ("circular_helical", &[][..], 3, Side::Right),
            // The shift turns round six times a revolution.
            (
                "third_order_diagonal",
                &["operation.finish.linkage.hobbing_diagonal.shift_mm_per_revolution=500"][..],
                21,
                Side::Right,
            ),
        ];
        let fine = ["fields.flank.profile_spacing_um=20", "fields.flank.lead_spacing_um=50", "gear.face_width_mm=12"];
        for (scene, more, tooth, side) in cases {
            let path = format!("scenes/hobbing/{scene}.toml");
            let set = [&fine[..], more].concat().into_iter().map(str::to_owned).collect::<Vec<_>>();
            let scene = load(Path::new(&path), &set).expect("the scene").scene;
            let job = HobbingJob::new(&scene).expect("the gear");
            let cutter = HobCutter::new(&job).expect("passes");
            let whole = cutter.rays(tooth, side).expect("a flank").1.field;
            // Every so many rays of the flank, so many of them, from a column and a row on.
            let part = |step: [usize; 2], count: [usize; 2], from: [usize; 2]| {
                SpatialField::new(count[0], count[1], whole.low_mm, |column, row| {
                    let (column, row) = (from[0] + column * step[0], from[1] + row * step[1]);
                    (whole.ray(column, row), f64::from(whole.blank_mm[whole.index(column, row)]))
                })
            };
            let (columns, rows) = (whole.columns(), whole.rows());
            // A coarse flank from face to face, two by two tiles as in use where the tip meets one face, cells of a
            // tile where the root meets the other, and the sections of a pair: rows so far apart that each is bounded
            // alone.
            let fields = [
                part([columns / 6, rows / 8], [6, 8], [0, 0]),
                part([1, 1], [17, 17], [columns - 17, 0]),
                part([1, 1], [5, 17], [0, rows - 17]),
                part([1, (rows - 1) / 4], [8, 5], [columns / 2, 0]),
            ];
            for (number, field) in fields.iter().enumerate() {
                let mut layer = field.blank_layer();
                for passes in cutter.operations.iter() {
                    let name = format!("{path}, field {number}");
                    layer = same_as_brute_force(&name, passes, field, &layer);
                }
                assert!(layer.passes.iter().any(|&pass| pass != u32::MAX));
            }
        }
    }
}
