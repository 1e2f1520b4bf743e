//! The chips that left the flanks: against closed forms, against the heights' own passes, and with a stroke left out.

use crate::fixtures::paper::*;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::{Field, NO_PASS};
use gearcut::gear::PitchCurveShape;
use gearcut::passes::StrokeSet;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::cut::chips::flank::side_code;
use gearcut::process::shaping::cut::chips::last_chips;
use gearcut::process::shaping::tool::edge_polygon::EdgeSide;
use gearcut::terms::Side;
use std::f64::consts::TAU;

/// Rays of a flank at so many places of its profile.
fn field(job: &ShapingJob, tooth: u32, side: Side, count: u32) -> (Field, Vec<f64>) {
    let flank = job.target_flank(tooth, side);
    let arcs = (0..count).map(|i| flank.length_mm() * f64::from(i) / f64::from(count - 1));
    let rolls = arcs.clone().map(|arc_mm| flank.at_arc(arc_mm).roll).collect();
    (job.field_over(flank, arcs, vec![-15.0, 0.0, 7.5, 15.0]), rolls)
}

/// What each pass of the cutter's involute leaves of a ray on its own, by the closed form: stroke, tooth, height and
/// cosine, in order of time.
fn exact_heights(job: &ShapingJob, side: Side, field: &Field, column: usize) -> Vec<(usize, u32, [f64; 2])> {
    let ray = field.columns[column];
    let near =
        |stroke: &usize| job.finishing().schedule.state(*stroke as f64).pose.center_mm.distance(ray.origin_mm) < 34.0;
    (0..job.finishing().strokes.count())
        .filter(near)
        .flat_map(|stroke| (0..20).map(move |blade| (stroke, blade)))
        .filter_map(|(stroke, blade)| {
            let exact = involute_height_mm(job, stroke, blade, side.sign(), ray.origin_mm, ray.normal)?;
            (exact[0] > -1.5).then_some((stroke, blade, exact))
        })
        .collect()
}

#[test]
fn thickness_on_a_flank_is_that_of_the_closed_form() {
    let job = ShapingJob::new(paper_scene(vec![operation("finish", NORMAL, 0.0, 720)])).expect("the paper's gear");
    let (mut worst_nm, mut compared) = (0.0_f64, 0);
    for (tooth, side) in [(2, Side::Left), (5, Side::Right), (9, Side::Left)] {
        let (field, rolls) = field(&job, tooth, side, 200);
        let chips = &last_chips(&job, &field)[0];
        // Away from the form point and the cutter's base circle, where corner and base cut too.
        for column in (4..198).filter(|&column| rolls[column] > 0.08) {
            let (mut surface_mm, mut before) = (f64::INFINITY, 0);
            let mut expected: Option<(usize, u32, f64)> = None;
            for (stroke, blade, [height_mm, cosine]) in exact_heights(&job, side, &field, column) {
                if height_mm < surface_mm {
                    before = expected.map_or(0, |(stroke, ..)| stroke);
                    expected = Some((stroke, blade, (surface_mm - height_mm) * cosine));
                    surface_mm = height_mm;
                }
            }
            let (stroke, blade, thickness_mm) = expected.expect("a pass");
            // Where the stroke before met the ray with its tip corner, the involute does not know the surface.
            if before + 1 != stroke {
                continue;
            }
            let dexel = column * field.rows();
            let off_nm = (f64::from(chips.thickness_mm[dexel]) - thickness_mm).abs() * 1e6;
            worst_nm = worst_nm.max(off_nm);
            assert_eq!(chips.passes[dexel], job.finishing().strokes.pass_id(stroke, blade), "column {column}");
            // A right flank is cut by the side of the cutter tooth that lies behind it.
            let edge = if side == Side::Left { EdgeSide::Left } else { EdgeSide::Right };
            assert_eq!(chips.sides[dexel], side_code(Some(edge)), "{side:?}");
            compared += 1;
        }
    }
    println!("{compared} columns, worst difference {worst_nm:.4} nm");
    assert!(compared > 350 && worst_nm < 0.2, "{compared} {worst_nm} nm");
}

#[test]
fn chips_on_a_round_gear_are_four_scallops_thick() {
    // Facets meet half a stroke from their contacts; a chip goes from nothing to twice c, and c is four times the
    // scallop's height: sin(alpha) / 8 (1 / rho + 1 / r_c) ds^2 at the pitch point.
    let strokes = 2400;
    let mut scene = paper_scene(vec![operation("finish", NORMAL, 0.0, strokes)]);
    (scene.gear.pitch_curve, scene.gear.teeth) = (PitchCurveShape::Circle, 24);
    let job = ShapingJob::new(scene).expect("a round gear");
    let ds_mm = TAU * 36.0 / f64::from(strokes);
    let scallop_mm = 20_f64.to_radians().sin() / 8.0 * (1.0 / 36.0 + 1.0 / 30.0) * ds_mm * ds_mm;
    let (field, _) = field(&job, 3, Side::Left, 6000);
    let chips = &last_chips(&job, &field)[0];
    let pitch_point = |&column: &usize| (field.columns[column].origin_mm.length() - 36.0).abs() < 0.3;
    let near: Vec<f64> = (0..6000)
        .filter(pitch_point)
        .map(|column| f64::from(chips.thickness_mm[column * field.rows()]) / (4.0 * scallop_mm))
        .collect();
    let mean = near.iter().sum::<f64>() / near.len() as f64;
    let low = near.iter().copied().fold(f64::INFINITY, f64::min);
    let high = near.iter().copied().fold(0.0, f64::max);
    println!(
        "{} places: {low:.3} to {high:.3}, mean {mean:.3} of four scallops of {:.4} um",
        near.len(),
        1e3 * scallop_mm
    );
    assert!((mean - 1.0).abs() < 0.05 && low < 0.3 && (1.7..2.5).contains(&high), "{low} {mean} {high}");
}

#[test]
fn the_last_chips_passes_are_those_of_the_heights() {
    for feed_during_stroke in [false, true] {
        let mut operations = vec![operation("rough", TRADITIONAL, 2.0, 900), operation("finish", NORMAL, 0.0, 1200)];
        for op in &mut operations {
            op.feed_during_stroke = feed_during_stroke;
        }
        let job = ShapingJob::new(paper_scene(operations)).expect("the paper's gear");
        let (mut other, mut all) = (0, 0);
        for (tooth, side) in [(1, Side::Left), (1, Side::Right), (7, Side::Left), (14, Side::Right)] {
            let (field, _) = field(&job, tooth, side, 80);
            let chips = last_chips(&job, &field);
            let cut = job.cut(&Cpu::default(), field).expect("native");
            for (chips, layer) in chips.iter().zip(&cut.layers) {
                assert_eq!(chips.passes.len(), layer.passes.len());
                for (dexel, (&ours, &theirs)) in chips.passes.iter().zip(&layer.passes).enumerate() {
                    all += 1;
                    // Between facets two passes leave the same height to a picometre; f32 does not tell which is lower.
                    other += usize::from(ours != theirs);
                    assert_eq!(chips.thickness_mm[dexel].is_nan(), ours == NO_PASS);
                    assert!(ours == NO_PASS || chips.thickness_mm[dexel] > 0.0);
                }
            }
        }
        println!("{other} of {all} dexels by another pass");
        assert!(all > 2000 && 1000 * other <= all);
    }
}

#[test]
fn the_stroke_after_a_missing_one_takes_the_chips_of_both() {
    let scene = || paper_scene(vec![operation("finish", NORMAL, 0.0, 720)]);
    let mut job = ShapingJob::new(scene()).expect("the paper's gear");
    let (field, _) = field(&job, 5, Side::Left, 400);
    let clean = last_chips(&job, &field);
    let set = &job.finishing().strokes;
    let (stroke, blade) = set.stroke_and_blade(clean[0].passes[200 * field.rows()]);
    let schedule = &job.operations[0].schedule;
    let fewer = StrokeSet::new(0, &job.cutter, set.law, 719, |lambda| {
        let pose = schedule.state(if lambda > stroke as f64 - 1.5 { lambda + 1.0 } else { lambda }).pose;
        gearcut::frame::Rigid2::new(pose.angle_rad, pose.center_mm)
    });
    // The stroke before is gone, so that this one has its number.
    let id = fewer.pass_id(stroke - 1, blade);
    let own = |passes: &[u32], id: u32| -> Vec<usize> { (0..passes.len()).filter(|&d| passes[d] == id).collect() };
    let before = own(&clean[0].passes, set.pass_id(stroke, blade));
    job.operations[0].strokes = fewer;
    let faulty = last_chips(&job, &field);
    let after = own(&faulty[0].passes, id);
    assert!(after.len() > before.len());
    // c ((2 + t)^2 - t^2) over c ((1 + t)^2 - t^2), t from -1/2 to 1/2 strokes: never below 3.
    for &dexel in before.iter().filter(|dexel| after.contains(dexel)) {
        let ratio = faulty[0].thickness_mm[dexel] / clean[0].thickness_mm[dexel];
        assert!(ratio > 2.9, "{ratio}");
    }
}
