//! A face-mill head, whose blades stand along its axis: at rest it leaves cones of revolution, and with a slow feed
//! marks of known spacing and height.

use crate::fixtures::face_mill::*;
use gearcut::cut::cpu::Cpu;
use gearcut::cut::{Backend, CutStats};
use gearcut::dexel::{Layer, Ray, SpatialField};
use gearcut::passes::sections::swept_sections::SweptSections;
use gearcut::passes::spatial::turning_passes::BladePass;
use gearcut::passes::{SweepPlan, TurningPasses};
use gearcut::tool::blade_edges::BladeEdges;
use std::f64::consts::{PI, TAU};

/// Largest difference from a closed form: numerical resolution of the native backend, as against the independent solver
/// of hobbed flanks.
const BOUND_MM: f64 = 1e-7;
/// Feed per blade of one kind, mm.
const FEED_MM: f64 = 4.0;
/// The same per radian of the head.
const FEED_MM_PER_RAD: f64 = FEED_MM * 0.5 * BLADES as f64 / TAU;
/// Head angles in which the fed work passes the fields.
const FED_RAD: [f64; 2] = [-30.0, 30.0];

fn cut(field: &SpatialField, plan: &SweepPlan) -> (Layer, CutStats) {
    let mut layer = field.blank_layer();
    let stats = Cpu::default().cut_spatial(field, plan, &mut layer).expect("native");
    assert_eq!(stats.unconverged, 0);
    (layer, stats)
}

/// What candidates leave, and all passes as well.
fn cut_as_by_all(field: &SpatialField, passes: &TurningPasses) -> Layer {
    let (plan, brute) = (SweepPlan::new(field, passes), SweepPlan::brute_force(field, passes));
    assert!(brute.dexel_passes() > plan.dexel_passes());
    let [layer, all] = [plan, brute].map(|plan| cut(field, &plan).0);
    assert!(layer == all, "candidates and all passes leave different flanks");
    layer
}

/// Heights over the tips' plane above the corners' rounds.
fn above_the_corner() -> Vec<f64> {
    even(0.5, 5.0, 40)
}

#[test]
fn a_head_at_rest_leaves_cones_of_revolution() {
    // An outside blade stands out, and an inside one inwards: each leaves all of its side.
    let head = FaceMill { runout_mm: [0.004, 0.0, 0.01, -0.02, 0.0, -0.007, -0.03, 0.05], ..FaceMill::default() };
    let passes = head.passes(0.0, [-1.0, 14.0]);
    assert_eq!(passes.count(), 2 * BLADES);
    for (side, blade) in [(1.0, 2), (-1.0, 3)] {
        let field = cone(side, &above_the_corner(), &even(-0.3, 0.3, 90));
        let layer = cut_as_by_all(&field, &passes);
        let wanted_mm = -side * head.runout_mm[blade as usize] * BLADE_ANGLE_RAD.cos();
        for (height_mm, pass) in layer.heights_mm.iter().zip(&layer.passes) {
            assert_eq!(passes.blade_of(*pass).1, blade, "side {side}");
            let off_mm = f64::from(*height_mm) - wanted_mm;
            assert!(off_mm.abs() < BOUND_MM, "side {side}: {off_mm:e} mm off {wanted_mm}");
        }
    }
}

/// In the corner's round the slot is a torus: rays along its normals meet it in the cone's own radius of curvature.
#[test]
fn corners_leave_a_torus() {
    let passes = FaceMill::default().passes(0.0, [-1.0, 8.0]);
    let (sin, cos) = BLADE_ANGLE_RAD.sin_cos();
    // Distance of the round's centre from the axis and from the tips' plane.
    let center_radius_mm = RADIUS_MM + 0.5 * POINT_WIDTH_MM - CORNER_MM * (1.0 - sin) / cos;
    let (leans, angles) = (even(BLADE_ANGLE_RAD + 0.02, 0.5 * PI - 0.02, 20), even(-0.2, 0.2, 40));
    let field = SpatialField::new(leans.len(), angles.len(), -0.2, |column, row| {
        let (sin, cos) = leans[column].sin_cos();
        let out = glam::DVec3::new(angles[row].cos(), angles[row].sin(), 0.0);
        let direction = cos * out - sin * glam::DVec3::Z;
        let center_mm = center_radius_mm * out + CORNER_MM * glam::DVec3::Z;
        (Ray { origin_mm: center_mm + CORNER_MM * direction, normal: -direction }, 0.2)
    });
    let layer = cut_as_by_all(&field, &passes);
    let worst_mm = layer.heights_mm.iter().map(|h| f64::from(*h).abs()).fold(0.0, f64::max);
    assert!(worst_mm < BOUND_MM, "{worst_mm:e} mm");
}

/// The window that follows from the work's place holds all of it; beyond the window no blade cuts; and a window of a
/// whole turn closes without a step.
#[test]
fn blades_cut_within_their_window() {
    let field = cone(1.0, &above_the_corner(), &even(-0.4, 0.4, 100));
    let beyond = cone(1.0, &above_the_corner(), &even(0.8, 1.1, 70));
    let of = |field: &SpatialField, half_window_rad: f64| {
        let head = FaceMill { half_window_rad, ..FaceMill::default() };
        cut(field, &SweepPlan::new(field, &head.passes(0.0, [-4.0, 17.0]))).0
    };
    let half_window_rad = FaceMill::default().half_window_rad;
    assert!(half_window_rad > 0.45 && half_window_rad < 0.5, "{half_window_rad} rad");
    assert!(of(&field, half_window_rad).heights_mm == of(&field, PI).heights_mm);
    assert!(of(&beyond, half_window_rad) == beyond.blank_layer() && of(&beyond, PI) != beyond.blank_layer());
    let round = FaceMill { half_window_rad: PI, ..FaceMill::default() };
    for middle in [0.0, 2.0, PI, -2.5] {
        let field = cone(1.0, &above_the_corner(), &even(middle - 0.2, middle + 0.2, 70));
        let (layer, _) = cut(&field, &SweepPlan::new(&field, &round.passes(0.0, [-4.0, 17.0])));
        let worst_mm = layer.heights_mm.iter().map(|h| f64::from(*h).abs()).fold(0.0, f64::max);
        assert!(worst_mm < BOUND_MM, "{worst_mm:e} mm at {middle} rad");
    }
}

/// Distance of a point at height h of a ray from the cone of a side, when the blade of a pass comes by while the work
/// moves: by iteration, from nothing but circles and a cone.
fn beyond_mm(side: f64, pass: &BladePass, ray: &Ray, height_mm: f64) -> f64 {
    let at = ray.at(height_mm);
    let mut swept = 0.0_f64;
    for _ in 0..60 {
        swept = (at.y + FEED_MM_PER_RAD * (pass.tool_angle_rad + swept)).atan2(at.x);
    }
    let y_mm = at.y + FEED_MM_PER_RAD * (pass.tool_angle_rad + swept);
    side * (at.x.hypot(y_mm) - radius_at_mm(side, at.z))
}

/// Height at which a ray meets the cone of a pass.
fn height_mm(side: f64, pass: &BladePass, ray: &Ray) -> Option<f64> {
    let (mut low, mut high) = (-0.4, 1.4);
    // Material is outside of the slot, where rays begin.
    if beyond_mm(side, pass, ray, low) < 0.0 || beyond_mm(side, pass, ray, high) > 0.0 {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if beyond_mm(side, pass, ray, middle) > 0.0 { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}

/// Whether a blade cuts the outer side.
fn cuts_outer(passes: &TurningPasses, pass: &BladePass) -> bool {
    passes.place(pass).blade.is_multiple_of(2)
}

#[test]
fn a_fed_work_gets_marks_of_known_spacing_and_height() {
    let head = FaceMill::default();
    let passes = head.passes(FEED_MM_PER_RAD, FED_RAD);
    let places = even(-9.0, 9.0, 361);
    let side = 1.0;
    let field = plane(&above_the_corner(), &places);
    let layer = cut_as_by_all(&field, &passes);
    let mut worst_mm = 0.0_f64;
    for column in (0..field.columns()).step_by(13) {
        for row in 0..field.rows() {
            let (ray, dexel) = (field.ray(column, row), field.index(column, row));
            let all = (0..passes.count()).map(|index| passes.pass(index)).filter(|pass| cuts_outer(&passes, pass));
            let heights = all.filter_map(|pass| Some((height_mm(side, &pass, &ray)?, pass.pass)));
            let mut heights: Vec<(f64, u32)> = heights.collect();
            heights.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (wanted_mm, pass) = heights[0];
            // On a ridge two marks are equally low.
            let on_ridge = heights.get(1).is_some_and(|next| next.0 < wanted_mm + BOUND_MM);
            assert!(on_ridge || layer.passes[dexel] == pass, "column {column}, row {row}");
            worst_mm = worst_mm.max((f64::from(layer.heights_mm[dexel]) - wanted_mm).abs());
        }
        // Marks follow each other a feed per blade apart. Against the work a blade goes on a trochoid: where it goes
        // with the feed, its path bends by radius / (radius - feed per radian)^2, and a ridge stands over the marks by
        // an eighth of that, times the square of the feed.
        let heights: Vec<f64> =
            (0..field.rows()).map(|row| f64::from(layer.heights_mm[field.index(column, row)])).collect();
        let ridges: Vec<usize> =
            (1..heights.len() - 1).filter(|&i| heights[i] > heights[i - 1] && heights[i] >= heights[i + 1]).collect();
        let radius_mm = radius_at_mm(side, above_the_corner()[column]);
        let bend_per_mm = radius_mm / (radius_mm - FEED_MM_PER_RAD).powi(2);
        let ridge_mm = FEED_MM * FEED_MM * bend_per_mm / 8.0 * BLADE_ANGLE_RAD.cos();
        assert!(ridges.len() >= 4, "{} ridges", ridges.len());
        for pair in ridges.windows(2) {
            let apart_mm = places[pair[1]] - places[pair[0]];
            assert!((apart_mm - FEED_MM).abs() < 0.06, "ridges {apart_mm} mm apart");
        }
        for &ridge in &ridges {
            // To the first order in feed / radius, 4 %, squared.
            let share = heights[ridge] / ridge_mm;
            assert!((share - 1.0).abs() < 2e-3, "a ridge of {:.5} of {ridge_mm:.5} mm", heights[ridge]);
        }
        let lowest_mm = heights.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(lowest_mm.abs() < 1e-6, "the marks go down to {lowest_mm:e} mm");
    }
    println!("worst difference from the closed form: {:.4} nm", 1e6 * worst_mm);
    assert!(worst_mm < BOUND_MM, "{worst_mm:e} mm");
}

/// A work that moves along the axis is cut by the cones of the last blade of each kind, in the moment when it comes by:
/// exact, for a cone that moves by d along its axis moves by d sin(angle) along its normal.
#[test]
fn a_plunging_head_leaves_what_the_last_blade_of_each_kind_leaves() {
    const FEED_MM_PER_RAD: f64 = 0.002;
    let [outside, inside] = edges();
    let head = |edges: Vec<_>| FaceMill { edges: BladeEdges::in_turn(edges), ..FaceMill::default() };
    let [both, exchanged] = [head(vec![outside.clone(), inside.clone()]), head(vec![inside, outside])];
    let passes = both.plunging(FEED_MM_PER_RAD, FED_RAD);
    let angles = even(-0.3, 0.3, 100);
    for side in SIDES {
        let field = cone(side, &above_the_corner(), &angles);
        let layer = cut_as_by_all(&field, &passes);
        let own = |pass: &BladePass| passes.place(pass).blade.is_multiple_of(2) == (side > 0.0);
        let last = (0..passes.count()).rev().map(|index| passes.pass(index)).find(own).expect("blades of this kind");
        for (dexel, height_mm) in layer.heights_mm.iter().enumerate() {
            let moved_mm = FEED_MM_PER_RAD * (last.tool_angle_rad + angles[dexel % angles.len()]);
            let off_mm = f64::from(*height_mm) + moved_mm * BLADE_ANGLE_RAD.sin();
            assert!(off_mm.abs() < BOUND_MM, "side {side}: {off_mm:e} mm off");
            assert_eq!(layer.passes[dexel], last.pass, "side {side}");
        }
        let (other, _) = cut(&field, &SweepPlan::new(&field, &exchanged.plunging(FEED_MM_PER_RAD, FED_RAD)));
        assert!(layer.heights_mm.iter().zip(&other.heights_mm).all(|(a, b)| a != b), "side {side}");
    }
}

#[test]
fn rays_through_the_whole_blank_refuse_blades_along_the_axis() {
    let passes = FaceMill::default().passes(0.0, [-1.0, 8.0]);
    let refused = SweptSections::new(|_| true, &passes, 100.0, 10.0, true).err().expect("no sections");
    assert!(refused.to_string().contains("does not look straight away from the tool's axis"), "{refused}");
}
