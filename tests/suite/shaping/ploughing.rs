//! Rounded edges on flanks: against closed forms, against the law by hand over all strokes, and beside sharp ones.

use super::machine_errors::{ALPHA_RAD, PITCH_MM, ROUND, job};
use crate::fixtures::paper::*;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::{Field, Layer, NO_PASS};
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::cut::chips::{deflections, last_chips};
use gearcut::process::shaping::scene::model::EdgeRounding;
use gearcut::terms::Side;
use std::f64::consts::TAU;
use std::path::Path;

const CUTTER_MM: f64 = 30.0;

fn rounded(text: &str, chip_um: f64, recovery: f64, settings: &[&str]) -> ShapingJob {
    let keys = [
        format!("tool.shaper_cutter.edge_rounding.radius_um={}", 4.0 * chip_um),
        "tool.shaper_cutter.edge_rounding.minimum_chip_share=0.25".to_owned(),
        format!("tool.shaper_cutter.edge_rounding.recovery_share={recovery}"),
    ];
    job(text, &[settings, &keys.each_ref().map(String::as_str)].concat())
}

fn cut(job: &ShapingJob, field: Field) -> Vec<Layer> {
    job.cut(&Cpu::default(), field).expect("native").layers
}

/// Heights on the left flank of a tooth of the round gear near its pitch point, um.
fn near_the_pitch_point(job: &ShapingJob) -> Vec<f64> {
    let flank = job.target_flank(3, Side::Left);
    let arcs_mm = (0..12_000).map(|i| flank.length_mm() * f64::from(i) / 11_999.0);
    let places = arcs_mm.filter(|&arc_mm| (flank.at_arc(arc_mm).point_mm.length() - PITCH_MM).abs() < 0.1);
    let places: Vec<f64> = places.collect();
    let layers = cut(job, job.field_over(flank, places.into_iter(), vec![0.0]));
    layers[0].heights_mm.iter().map(|&height| 1e3 * f64::from(height)).collect()
}

/// A stroke that stands t strokes away from its contact leaves c t^2, c four scallops: passes are the parabolas of a
/// turned surface with f^2 / (2 r) = c. Brammertz 1961: Rth = f^2 / (8 r) + h_min / 2 (1 + r h_min / f^2).
#[test]
fn flanks_have_the_height_of_brammertz() {
    let strokes = 1200.0;
    let fine = format!("operation.finish.strokes_per_revolution={strokes}");
    let ds_mm = TAU * PITCH_MM / strokes;
    let c_um = 1e3 * 0.5 * ALPHA_RAD.sin() * (1.0 / PITCH_MM + 1.0 / CUTTER_MM) * ds_mm * ds_mm;
    for share in [1e-4, 0.2, 0.5, 0.9] {
        let chip_um = share * c_um;
        let heights_um = near_the_pitch_point(&rounded(ROUND, chip_um, 1.0, &[&fine]));
        let low_um = heights_um.iter().copied().fold(f64::INFINITY, f64::min);
        let high_um = heights_um.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let expected_um = 0.25 * c_um + 0.5 * chip_um * (1.0 + chip_um / (2.0 * c_um));
        println!(
            "h_min {chip_um:.4} um: {:.4} um high, Brammertz {expected_um:.4} um, {} places",
            high_um - low_um,
            heights_um.len()
        );
        // Along 0.5 mm of flank the feed along it, and with it c, changes by some per cent; 5 % are seen here as in the
        // test of chips that are four scallops thick.
        assert!(((high_um - low_um) / expected_um - 1.0).abs() < 0.05, "{share}: {} um", high_um - low_um);
        assert!(heights_um.len() > 200);
    }
}

/// All strokes of the paper's gear by the closed form of the involute, one after the other.
#[test]
fn surfaces_are_those_of_the_law_by_hand() {
    let mut scene = paper_scene(vec![operation("finish", NORMAL, 0.0, 720)]);
    let rounding = EdgeRounding { radius_mm: 0.016, minimum_chip_share: 0.25, recovery_share: 0.9 };
    gearcut::process::shaping::scene::model::Shaping::of_mut(&mut scene).expect("shaping").tool.edge_rounding =
        Some(rounding);
    let job = ShapingJob::new(scene).expect("the paper's gear");
    let (mut compared, mut apart, mut ploughed) = (0, 0, 0);
    for (tooth, side) in [(2, Side::Left), (5, Side::Right), (9, Side::Left)] {
        let flank = job.target_flank(tooth, side);
        let arcs_mm = (0..100).map(|i| flank.length_mm() * (0.15 + 0.008 * f64::from(i)));
        let field = job.field_over(flank, arcs_mm, vec![0.0]);
        let layers = cut(&job, field.clone());
        for (column, ray) in field.columns.iter().enumerate() {
            let near = |stroke: &usize| {
                job.finishing().schedule.state(*stroke as f64).pose.center_mm.distance(ray.origin_mm) < 34.0
            };
            let passes = (0..job.finishing().count()).filter(near).flat_map(|s| (0..20).map(move |blade| (s, blade)));
            let (mut surface_mm, mut lowest_mm) = (ray.blank_mm, ray.blank_mm);
            for (stroke, blade) in passes {
                let edge = involute_height_mm(&job, stroke, blade, side.sign(), ray.origin_mm, ray.normal);
                let Some([edge_mm, cosine]) = edge.filter(|[h, _]| *h > -1.5 && *h < surface_mm) else { continue };
                let depth_mm = surface_mm - edge_mm;
                surface_mm = if depth_mm * cosine >= 0.004 { edge_mm } else { surface_mm - 0.1 * depth_mm };
                lowest_mm = lowest_mm.min(edge_mm);
            }
            compared += 1;
            ploughed += usize::from(surface_mm > lowest_mm + 1e-6);
            // f32 of heights of micrometres is good to a picometre; a depth that is h_min to a picometre may go
            // either way.
            apart += usize::from((f64::from(layers[0].heights_mm[column]) - surface_mm).abs() > 1e-8);
        }
    }
    println!("{compared} rays, {ploughed} of them higher than the lowest stroke, {apart} apart");
    assert!(compared == 300 && ploughed > 100 && apart == 0, "{compared}, {ploughed}, {apart}");
}

/// With a thinnest chip of a picometre the lowest pass is left, as by the kernels, with rough and with smooth edges,
/// and never lower; with a thick one the surface stands at most h_min over it, measured across.
#[test]
fn sharp_edges_are_the_limit_and_the_thinnest_chip_the_bound() {
    let few = ["operation.finish.strokes_per_revolution=700", "operation.finish.feed_during_stroke=true"];
    let rough = [
        "tool.shaper_cutter.edge_roughness.rq_um=0.5",
        "tool.shaper_cutter.edge_roughness.correlation_length_um=30",
        "machine.errors.center_distance.noise_um=1",
    ];
    for settings in [few.to_vec(), [&few[..], &rough].concat()] {
        let sharp = job(ROUND, &settings);
        let field = |job: &ShapingJob| {
            let flank = job.target_flank(5, Side::Right);
            let arcs_mm = (0..120).map(|i| flank.length_mm() * f64::from(i) / 119.0);
            job.field_over(flank, arcs_mm, vec![-10.0, 0.0, 10.0])
        };
        let kernels = cut(&sharp, field(&sharp));
        for (chip_um, recovery) in [(1e-6, 1.0), (0.8, 1.0), (0.8, 0.5), (2.5, 1.0)] {
            let rounded = rounded(ROUND, chip_um, recovery, &settings);
            let ploughed = cut(&rounded, field(&rounded));
            let pairs = ploughed[0].heights_mm.iter().zip(&kernels[0].heights_mm);
            let above_um: Vec<f64> = pairs.map(|(a, b)| 1e3 * (f64::from(*a) - f64::from(*b))).collect();
            let low_um = above_um.iter().copied().fold(f64::INFINITY, f64::min);
            let high_um = above_um.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            println!("h_min {chip_um} um, recovery {recovery}: {low_um:.6} to {high_um:.6} um above");
            // f32 at heights of 0.03 mm, beside the tip corner's fillet: 2e-9 mm.
            assert!(low_um > -1e-5, "{low_um}");
            // Where edges plough they lie within some degrees of the flank: a cosine above 0.99.
            assert!(high_um < 1.01 * chip_um + 1e-5, "{high_um}");
            assert!(chip_um < 0.1 || high_um > 0.9 * chip_um * recovery, "{high_um}");
        }
    }
}

#[test]
fn chips_on_ploughed_flanks_are_thick_enough_and_those_of_the_heights() {
    let few = ["operation.finish.strokes_per_revolution=2400"];
    let rounded = rounded(ROUND, 0.5, 1.0, &few);
    let flank = rounded.target_flank(7, Side::Left);
    let arcs_mm = (0..300).map(|i| flank.length_mm() * f64::from(i) / 299.0);
    let field = rounded.field_over(flank, arcs_mm, vec![0.0]);
    let chips = &last_chips(&rounded, &field)[0];
    let layer = &cut(&rounded, field)[0];
    assert_eq!(chips.passes, layer.passes);
    let touched = chips.thickness_mm.iter().zip(&chips.passes).filter(|(_, pass)| **pass != NO_PASS);
    let thinnest_mm = touched.clone().map(|(&thickness, _)| thickness).fold(f32::INFINITY, f32::min);
    assert!(touched.count() > 250 && (0.0005..0.0006).contains(&thinnest_mm), "{thinnest_mm}");
}

#[test]
fn a_machine_that_yields_ploughs_as_well() {
    let settings = [
        "operation.finish.strokes_per_revolution=240",
        "operation.finish.stock_per_flank_mm=0",
        "operation.finish.infeed.spiral.depth_mm=6.5",
        "operation.finish.infeed.spiral.angle_deg=60",
        "operation.finish.overlap_deg=60",
        "machine.compliance.tool_radial_um_per_kn=8",
        "machine.compliance.tool_tangential_um_per_kn=8",
    ];
    let text = ROUND.replace("[operation.infeed.none]", "");
    let [sharp, rounded] = [job(&text, &settings), rounded(&text, 1.0, 1.0, &settings)];
    let cut = |rigid: &ShapingJob| {
        let job = rigid.deflected(deflections(rigid, &|| true).expect("small").expect("not stopped"));
        cut(&job, job.field_over(job.target_flank(5, Side::Left), [1.5, 2.0, 2.5].into_iter(), vec![0.0])).remove(0)
    };
    let (sharp, rounded) = (cut(&sharp), cut(&rounded));
    for (low, high) in sharp.heights_mm.iter().zip(&rounded.heights_mm) {
        assert!((-1e-6..0.0011).contains(&(high - low)), "{low} {high}");
    }
}

#[test]
fn equal_scenes_make_equal_bytes_on_any_number_of_threads() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let job = rounded(ROUND, 1.0, 0.9, &["operation.finish.strokes_per_revolution=700"]);
            cut(&job, job.flank_field(job.target_flank(5, Side::Right)))
        })
    };
    assert!(on(1) == on(3));
}

#[test]
fn rounding_that_means_nothing_is_refused() {
    for (setting, why) in [
        ("radius_um=0", "0 to 200"),
        ("radius_um=nan", "0 to 200"),
        ("radius_um=5", "says nothing without minimum_chip_share"),
        ("minimum_chip_share=0.3", "says nothing without radius_um"),
        ("minimum_chip_share=1.5", "0 to 1"),
        ("recovery_share=-0.1", "0 to 1"),
        ("recovery_share=2", "0 to 1"),
        ("radius=5", "radius_um"),
    ] {
        let setting = format!("tool.shaper_cutter.edge_rounding.{setting}");
        let read = gearcut::process::parse(ROUND, "scene.toml", Path::new(""), std::slice::from_ref(&setting));
        let said = read.map_or_else(|errors| errors.to_string(), |_| String::new());
        assert!(said.contains(why), "{setting}: {said}");
    }
}
