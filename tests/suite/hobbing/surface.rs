//! What hobbing leaves: marks and their lattice, the limit of fine feed, the load of the hob's teeth.

use crate::fixtures::oracle_cases::*;
use crate::fixtures::space_ledger::{LedgerGrid, SpaceLedger};
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::SpatialField;
use gearcut::passes::SweepPlan;
use gearcut::process::hobbing::linkage::marks::Marks;
use gearcut::process::hobbing::measure::hob_load::ToothLoad;
use gearcut::process::hobbing::measure::marks::{autocorrelation_steps, between_rad};
use gearcut::process::hobbing::rack_generation::RackGeneration;
use gearcut::process::hobbing::scene::model::GashForm;
use gearcut::terms::Side;
use glam::DVec2;
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};

fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
}

/// Heights of a patch cut by all passes that matter, column by column, mm.
fn simulated(case: &Case, field: &SpatialField, cycles: [f64; 2]) -> Vec<f64> {
    let cycle = TAU * f64::from(case.teeth) / number(&case.setup, "K");
    let passes = case.passes(cycles.map(|c| c * cycle));
    let plan = SweepPlan::new(field, &passes);
    let mut layer = field.blank_layer();
    let stats = Cpu::default().cut_spatial(field, &plan, &mut layer).expect("cuts");
    assert_eq!(stats.unconverged, 0);
    assert!(layer.passes.iter().all(|&pass| pass != u32::MAX));
    layer.heights_mm.iter().map(|&h| f64::from(h)).collect()
}

/// Marks of one side; +1 is the low-arc side of a space.
fn marks<'a>(case: &'a Case, target: &'a RackGeneration, side: f64) -> Marks<'a> {
    let side = if side > 0.0 { Side::Left } else { Side::Right };
    Marks { linkage: &case.linkage, target, hob: &case.hob, side }
}

#[test]
fn the_surface_shows_the_lattice_of_the_kinematics() {
    for name in ["p09_patch_s2_axial", "p10_patch_s2_diag_VL"] {
        let file = data(name);
        let case = Case::new(&file["setup"]);
        let space = file["space"].as_i64().expect("space");
        let side = number(&file, "flank");
        let count = [121, 121];
        let (sigmas, z) = (even(-6.0, 6.0, count[0]), even(-5.0, 5.0, count[1]));
        let field = case.patch(space, side, &sigmas, &z);
        let heights = simulated(&case, &field, [-3.5, 4.5]);
        let target = case.rack_generation();
        let marks = marks(&case, &target, side);
        let length = |step: DVec2| marks.on_flank(step, 1.0).length_mm();
        // The patch counts z against the gear's axis.
        let turned_over = |step: DVec2| DVec2::new(step.x, -step.y);
        let spacing_mm = [12.0 / 120.0, 10.0 / 120.0];
        let steps = autocorrelation_steps(&heights, count, spacing_mm, |step| length(turned_over(step)));
        let steps: Vec<DVec2> = steps.into_iter().map(turned_over).collect();
        let kinematic = [marks.to_next_gash(28, space), marks.to_same_tooth(28, space, case.teeth)];
        println!("{name}: kinematics {kinematic:?}, surface {steps:?}");
        // Every step on the surface is a whole combination of the kinematic ones, within a fiftieth of the shortest.
        let shortest = marks.reduced(kinematic, 1.0)[0].length_mm();
        let [a, b] = kinematic;
        assert!(steps.len() >= 2);
        for step in &steps[..2] {
            let determinant = a.perp_dot(b);
            let (i, j) = ((step.perp_dot(b) / determinant).round(), (a.perp_dot(*step) / determinant).round());
            let apart = length(*step - (i * a + j * b));
            println!("  {step} = {i} v1 + {j} v2, {apart:.4} mm off");
            assert!(apart < 0.02 * shortest, "{step}: {apart} mm off {i}, {j}");
        }
        // And the shortest ones of both agree.
        let reduced = marks.reduced([steps[0], steps[1]], 1.0);
        for (seen, known) in reduced.iter().zip(marks.reduced(kinematic, 1.0)) {
            assert!((seen.length_mm() / known.length_mm() - 1.0).abs() < 0.02, "{seen:?} against {known:?}");
            assert!(between_rad(seen.to_trace_rad(), known.to_trace_rad()) < 0.03, "{seen:?} against {known:?}");
        }
    }
}

#[test]
fn a_circular_helical_gear_tends_to_its_involute_helicoid_quadratically() {
    let setup = &data("p11_patch_circle")["setup"];
    let field_of = |case: &Case| case.patch(0, 1.0, &even(-6.0, 6.0, 81), &even(-2.0, 2.0, 81));
    let mut highest = Vec::new();
    for factor in [1.0, 2.0, 4.0] {
        let case = Case::with(setup, factor, 1.0 / factor);
        let heights = simulated(&case, &field_of(&case), [-3.5 * factor, 3.5 * factor]);
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(lowest > -1e-9, "{lowest} mm: the target is cut into");
        highest.push(heights.iter().copied().fold(0.0, f64::max));
    }
    println!("highest marks {highest:?} mm");
    for pair in highest.windows(2) {
        assert!((3.7..4.4).contains(&(pair[0] / pair[1])), "{highest:?}");
    }
}

#[test]
fn feed_and_generating_marks_have_their_closed_heights() {
    let spur = &data("p12_patch_spur")["setup"];
    let mut lobed = spur.clone();
    lobed["n"] = json!(3);
    lobed["e"] = json!(0.1);
    let check = |setup: &Value, space: i64, name: &str| {
        let case = Case::new(setup);
        let target = case.rack_generation();
        let marks = marks(&case, &target, -1.0);
        let crossing_arc_mm = target.crossing_arc_mm(space, Side::Right, 0.0);
        // The mark nearest to the pitch line, from the kinematics; then straight lines along the tooth and along the
        // profile through it.
        let around = ((crossing_arc_mm / case.linkage.geometry().arc_per_hob_rad_mm()) / TAU * 10.0).round() as i64;
        let (passage, at) = (around - 4..=around + 4)
            .map(|passage| (passage, marks.mark(passage, space)))
            .min_by(|a, b| a.1.roll_mm.abs().total_cmp(&b.1.roll_mm.abs()))
            .expect("a mark");
        let highest = |sigmas: &[f64], z: &[f64]| {
            let field = case.patch(space, -1.0, sigmas, z);
            simulated(&case, &field, [-3.5, 4.5])
        };
        let lines = 4001;
        let along_tooth = highest(&[at.roll_mm], &even(-at.z_mm, -at.z_mm + 2.5, lines));
        let feed_mark = along_tooth.iter().copied().fold(0.0, f64::max);
        let sigmas = even(at.roll_mm, at.roll_mm + 2.5, lines);
        let along_profile = highest(&sigmas, &[-at.z_mm]);
        let ridge = (0..lines).max_by(|&a, &b| along_profile[a].total_cmp(&along_profile[b])).expect("heights");
        let generating_mark = along_profile[ridge];
        let feed = number(setup, "vz").abs() * case.linkage.cycle_s();
        let (sin, cos) = case.pressure_angle_rad.sin_cos();
        let tilt = case.linkage.geometry().head_angle_rad;
        // The contact stands c sin(alpha) above the pitch line, nearer to the hob's axis.
        let contact_radius_mm = case.hob.pitch_radius_mm - at.roll_mm * cos * sin;
        let feed_closed = (feed / tilt.cos()).powi(2) * sin / (8.0 * contact_radius_mm);
        // The involute's own curvature there: rho sin(alpha) + c; the facets are tangents of it.
        let module = case.normal_module_mm;
        let sigma = sigmas[ridge];
        let frame = case.curve.frame(case.curve.phi_at_arc(PI * module * (space as f64 + 0.25) + sigma));
        let (rho, c) = (1.0 / frame.curvature_per_mm, sigma * cos);
        let step = marks.to_next_gash(passage, space);
        // Half a mark away the edge has left the line along which the worm touches the rack (docs/spatial_kernel.md);
        // on spur gears.
        let half_mm = 0.5 * step.x * (sin + c / rho);
        let off_line = (tilt * half_mm).powi(2) / (2.0 * contact_radius_mm * sin);
        let off_line = off_line * (1.0 + 2.0 * sin * sin * contact_radius_mm / rho);
        let generating_closed = step.x * step.x * (sin + c / rho) / (8.0 * rho) + off_line;
        println!(
            "{name}: rho {rho:.1}, feed mark {:.4} against {:.4} um, generating mark {:.4} against {:.4} um, {:.4} of \
            them off the line of contact",
            feed_mark * 1e3,
            feed_closed * 1e3,
            generating_mark * 1e3,
            generating_closed * 1e3,
            off_line * 1e3
        );
        [feed_mark / feed_closed - 1.0, generating_mark / generating_closed - 1.0]
    };
    for (setup, space, name) in [(spur, 0, "spur"), (&lobed, 0, "lobe"), (&lobed, 6, "flat")] {
        let [feed, generating] = check(setup, space, name);
        assert!(feed.abs() < 0.01 && generating.abs() < 0.01, "{name}: {feed}, {generating}");
    }
}

#[test]
fn helical_gashes_leave_the_same_flank() {
    let setup = &data("p11_patch_circle")["setup"];
    let highest = [GashForm::Axial, GashForm::Helical].map(|form| {
        let case = Case::with_gashes(setup, 1.0, 1.0, form);
        let field = case.patch(0, 1.0, &even(-6.0, 6.0, 41), &even(-2.0, 2.0, 41));
        let heights = simulated(&case, &field, [-3.5, 3.5]);
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(lowest > -1e-8, "{form:?}: {lowest} mm");
        heights.iter().copied().fold(0.0, f64::max)
    });
    println!("highest marks {highest:?} mm");
    assert!((highest[0] / highest[1] - 1.0).abs() < 0.05 && highest[0] != highest[1], "{highest:?}");
}

#[test]
fn teeth_take_their_shares() {
    let file = data("p14_engagement");
    let mut circle = data("p08_events_s2")["axial"]["setup"].clone();
    circle["e"] = json!(0.0);
    circle["n"] = json!(1);
    for (name, setup, spaces) in [("circle_r142", &circle, vec![0])] {
        let case = Case::new(setup);
        let cycle = TAU * f64::from(case.teeth);
        // The tip reaches 51 mm ahead of the hob's middle: 21 feeds; nothing is cut on the far side.
        let passes = case.passes([-24.0 * cycle, 6.0 * cycle]);
        let module = case.normal_module_mm / case.helix_angle_rad.cos();
        // One slice that stands for a millimetre: volumes in mm3 are areas in mm2.
        let grid = LedgerGrid { slices_mm: vec![0.0], slice_width_mm: 1.0, spacing_mm: 0.5, heights_mm: [-10.5, 8.0] };
        let mut loads = vec![ToothLoad::default(); case.hob.teeth.len()];
        for &space in &spaces {
            let arc = |z: f64| f64::from(space) * PI * module + case.gear_hand * case.helix_angle_rad.tan() * z;
            let (of, stats) = SpaceLedger::new(&case.curve, &grid, PI * module, arc).cut(&passes);
            assert_eq!(stats.unconverged, 0);
            for (sum, load) in loads.iter_mut().zip(&of) {
                sum.volume_mm3 += load.volume_mm3;
                sum.thickness_mm = sum.thickness_mm.max(load.thickness_mm);
            }
        }
        let total: f64 = loads.iter().map(|load| load.volume_mm3).sum();
        let per_space = total / spaces.len() as f64;
        let wanted = &file[name];
        println!("{name}: {per_space:.2} mm2 per space against {}", wanted["area_per_space"]);
        assert!((per_space / number(wanted, "area_per_space") - 1.0).abs() < 0.01);
        let (js, shares) = (numbers(&wanted["j"]), numbers(&wanted["share"]));
        let mut worst = 0.0_f64;
        for (j, share) in js.iter().zip(&shares) {
            // Count from the tooth at the pitch point: gash passages, growing towards the leaving end.
            let got: f64 = (0..loads.len())
                .filter(|&i| case.hob.teeth[i].passage as f64 == *j)
                .map(|i| loads[i].volume_mm3 / total)
                .sum();
            worst = worst.max((got - share).abs());
            println!("  j {j}: {got:.4} against {share:.4}");
        }
        let thickest = loads.iter().map(|load| load.thickness_mm).fold(0.0, f64::max);
        println!("  worst share {worst:.4}, thickest chip {thickest:.3} mm");
        assert!(worst < number(&file, "tol_share_abs"), "{name}: {worst}");
    }
}
