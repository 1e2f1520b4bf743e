//! The roughness of cutting edges comes out on flanks: one stroke copies it, many strokes leave what cuts deepest.

use super::flank_heights::compare_whole_field;
use super::machine_errors::{ROUND, job};
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::Field;
use gearcut::passes::{CutPlan, StrokeSet};
use gearcut::process::shaping::ShapingJob;
use gearcut::terms::Side;
use glam::DVec2;
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Wave on the edge: 1 um high, 0.2 mm long.
const AMPLITUDE_MM: f64 = 1e-3;
const LENGTH_MM: f64 = 0.2;

fn wave(arc_mm: f64) -> f64 {
    AMPLITUDE_MM * (TAU * arc_mm / LENGTH_MM).sin()
}

/// A job whose cutter has the wave on its edges, as a table of points 2 um apart.
fn wavy(settings: &[&str]) -> ShapingJob {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("edge.csv");
    let mut table = String::from("# a wave\nposition_um,height_nm\n");
    for point in 0..=5000 {
        let um = 2.0 * f64::from(point);
        let _ = writeln!(table, "{um},{}", 1e6 * wave(1e-3 * um));
    }
    std::fs::write(&path, table).expect("written");
    let profile = format!("tool.shaper_cutter.edge_roughness.profile=\"{}\"", path.display());
    job(ROUND, &[settings, &[profile.as_str()]].concat())
}

/// Heights that strokes of a job alone leave on a field.
fn heights(job: &ShapingJob, field: &Field, strokes: &[usize]) -> Vec<f64> {
    let (all, law) = (&job.finishing().strokes, job.finishing().strokes.law);
    let set = StrokeSet::new(0, &job.cutter, law, strokes.len(), |index| all.poses(strokes[index as usize])[0]);
    let mut layer = field.blank_layer();
    Cpu::default().cut(field, &CutPlan::new(field, &set, &job.cutter), &mut layer).expect("native");
    layer.heights_mm.iter().map(|&height| f64::from(height)).collect()
}

/// The stroke that touches the middle of a flank, and rays around that place.
fn middle(job: &ShapingJob, tooth: u32, side: Side, half_mm: f64) -> (usize, Field) {
    let flank = job.target_flank(tooth, side);
    let arc_mm = 0.5 * flank.length_mm();
    let turn = job.finishing().linkage.axes(flank.at_arc(arc_mm).phi_rad, 0.0).psi_c_rad.value() / TAU;
    let stroke = (turn.rem_euclid(1.0) * job.finishing().count() as f64).round() as usize;
    let arcs_mm = (-100..=100).map(|i| arc_mm + half_mm * f64::from(i) / 100.0);
    (stroke, job.field_over(flank, arcs_mm, vec![0.0]))
}

/// Height at which a ray comes to a parallel of the cutter's involute that is as far out as the wave is there. On the
/// tangent to the base circle through a point, the point lies r_b (sigma theta + u - atan(u) - psi_b) off the involute,
/// whose foot has the roll u less that distance / r_b; its arc from the tip corner is r_b (u_tip^2 - u^2) / 2.
fn by_hand(job: &ShapingJob, stroke: usize, side: f64, origin_mm: DVec2, normal: DVec2) -> f64 {
    let cutter = &job.cutter;
    let flank = cutter.involute().expect("involute flanks");
    let work_from_tool = job.finishing().strokes.poses(stroke)[0];
    // The tooth of the cutter that stands nearest to the ray.
    let in_tool = work_from_tool.inverse().point(origin_mm);
    let pitch_rad = TAU / f64::from(cutter.teeth);
    let tooth = (in_tool.to_angle() / pitch_rad).round() * pitch_rad;
    let r_b = flank.base_radius_mm;
    let missing = |height_mm: f64| {
        let p = DVec2::from_angle(-tooth).rotate(work_from_tool.inverse().point(origin_mm + height_mm * normal));
        let u = (p.length_squared() / (r_b * r_b) - 1.0).sqrt();
        let off_mm = r_b * (side * p.to_angle() + u - u.atan() - flank.half_angle_rad);
        let foot = u - off_mm / r_b;
        off_mm - wave(0.5 * r_b * (flank.roll_range[1].powi(2) - foot * foot))
    };
    let (mut low, mut high) = (-0.1, 0.1);
    for _ in 0..80 {
        let height_mm = 0.5 * (low + high);
        if missing(height_mm) > 0.0 { low = height_mm } else { high = height_mm }
    }
    low
}

#[test]
fn one_stroke_copies_its_edge() {
    let (smooth, rough) = (job(ROUND, &[]), wavy(&[]));
    for side in [Side::Left, Side::Right] {
        let (stroke, field) = middle(&smooth, 5, side, 0.3);
        let (even, found) = (heights(&smooth, &field, &[stroke]), heights(&rough, &field, &[stroke]));
        let (mut worst_mm, mut largest_mm) = (0.0_f64, 0.0_f64);
        for (column, (even, found)) in field.columns.iter().zip(even.iter().zip(&found)) {
            let expected = by_hand(&smooth, stroke, side.sign(), column.origin_mm, column.normal);
            worst_mm = worst_mm.max((found - expected).abs());
            largest_mm = largest_mm.max((found - even).abs());
        }
        println!("{side:?}: worst {:.3} nm of a wave of {:.1} nm", 1e6 * worst_mm, 1e6 * largest_mm);
        assert!(largest_mm > 0.9 * AMPLITUDE_MM, "the wave is there");
        assert!(worst_mm < 1e-6, "within a nanometre");
    }
}

#[test]
fn many_strokes_leave_what_each_of_them_leaves_alone() {
    let settings = [
        "operation.finish.strokes_per_revolution=1200",
        "tool.shaper_cutter.edge_roughness.rq_um=0.6",
        "tool.shaper_cutter.edge_roughness.correlation_length_um=30",
    ];
    let rough = job(ROUND, &settings);
    let (stroke, field) = middle(&rough, 5, Side::Left, 0.2);
    let around: Vec<usize> = (stroke - 15..=stroke + 15).collect();
    let together = heights(&rough, &field, &around);
    let alone: Vec<Vec<f64>> = around.iter().map(|&stroke| heights(&rough, &field, &[stroke])).collect();
    let deepest = |column: usize| alone.iter().map(|heights| heights[column]).fold(f64::INFINITY, f64::min);
    let mut deepest_strokes = Vec::new();
    for (column, &height) in together.iter().enumerate() {
        assert!((height - deepest(column)).abs() < 1e-8, "{height} for {}", deepest(column));
        deepest_strokes.extend(alone.iter().position(|heights| heights[column] == height));
    }
    deepest_strokes.dedup();
    assert!(deepest_strokes.len() > 10, "many strokes have a part in it: {deepest_strokes:?}");
}

#[test]
fn candidates_equal_brute_force_with_rough_edges_and_noise() {
    for (rq, strokes) in [("0.3", 500), ("1.5", 500), ("0.5", 2400)] {
        for feed in [false, true] {
            let settings = [
                format!("operation.finish.strokes_per_revolution={strokes}"),
                format!("operation.finish.feed_during_stroke={feed}"),
                format!("tool.shaper_cutter.edge_roughness.rq_um={rq}"),
                "tool.shaper_cutter.edge_roughness.correlation_length_um=20".to_owned(),
                "machine.errors.center_distance.noise_um=1".to_owned(),
                "fields.flank.lead_spacing_um=10000".to_owned(),
                "fields.flank.profile_spacing_um=20".to_owned(),
            ];
            let rough = job(ROUND, &settings.each_ref().map(String::as_str));
            for (tooth, side) in [(3, Side::Left), (9, Side::Right)] {
                compare_whole_field(&rough, &rough.flank_field(rough.target_flank(tooth, side)), rough.finishing());
            }
        }
    }
}

#[test]
fn smooth_edges_change_no_byte_and_other_cutters_do() {
    let cut = |settings: &[&str]| {
        let job = job(ROUND, settings);
        let field = job.field_over(job.target_flank(5, Side::Left), [1.0, 1.5, 2.0].into_iter(), vec![0.0, 3.0]);
        job.cut(&Cpu::default(), field).expect("native").layers
    };
    let edge = |rq: &str, seed: &str| {
        cut(&[
            &format!("tool.shaper_cutter.edge_roughness.rq_um={rq}"),
            &format!("tool.shaper_cutter.edge_roughness.seed={seed}"),
            "tool.shaper_cutter.edge_roughness.correlation_length_um=20",
        ])
    };
    let sound = cut(&[]);
    assert!(sound == edge("0", "7"));
    assert!(sound != edge("0.2", "7") && edge("0.2", "7") != edge("0.2", "8"));
    assert!(edge("0.2", "7") == edge("0.2", "7"));
}

#[test]
fn edges_that_are_none_are_refused() {
    let refused = |settings: &[&str]| {
        let settings: Vec<String> =
            settings.iter().map(|&s| format!("tool.shaper_cutter.edge_roughness.{s}")).collect();
        let scene = gearcut::process::parse(ROUND, "scene.toml", std::path::Path::new(""), &settings).expect("a scene");
        ShapingJob::new(scene.scene).expect_err("no edge").to_string()
    };
    let steep = refused(&["rq_um=3", "correlation_length_um=10"]);
    assert!(steep.contains("climbs with a slope"), "{steep}");
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text, why) in [
        ("short.csv", "position_um,height_um\n0,0\n100,1\n", "the flank from 0 to"),
        ("header.csv", "x,height_um\n0,0\n100,1\n", "column 1 is not position_um"),
        ("back.csv", "position_um,height_um\n0,0\n100,1\n50,1\n", "line 4 is not beyond"),
        ("word.csv", "position_um,height_um\n0,0\n100,much\n", "column 2 of line 3 is no number"),
        ("nan.csv", "position_um,height_um\n0,0\n100,NaN\n", "column 2 of line 3 is no number"),
        ("empty.csv", "position_um,height_um\n", "fewer than two points"),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        let said = refused(&[&format!("profile=\"{}\"", path.display())]);
        assert!(said.contains(why), "{name}: {said}");
    }
    let missing = refused(&["profile=\"nowhere.csv\""]);
    assert!(missing.contains("there is no such file"), "{missing}");
}
