//! External shaping against the independent implementation's values (tests/data/shaping): target flanks, allowances,
//! unevenness, facets.

use crate::fixtures::expected::number;
use crate::fixtures::paper::*;
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::frame::Rigid2;
use gearcut::gear::PitchCurveShape;
use gearcut::measure::scallop::{cusps, facets};
use gearcut::passes::planar::strokes::StrokeLaw;
use gearcut::passes::{CutPlan, StrokeSet};
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::gear::measure::unevenness::{CrossedSurface, ToothAllowance, summarise};
use gearcut::process::shaping::scene::model::*;
use gearcut::scene::model::*;
use gearcut::terms::Side;
use glam::DVec2;
use serde_json::Value;
use std::f64::consts::TAU;

fn oracle(name: &str) -> Value {
    let path = format!("{}/tests/data/shaping/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).expect("oracle file")).expect("oracle JSON")
}

fn point(value: &Value) -> DVec2 {
    DVec2::new(number(&value[0]), number(&value[1]))
}

fn rough_and_finish(linkage: Linkage, strokes: u32) -> ShapingJob {
    ShapingJob::new(paper_scene(vec![
        operation("rough", linkage, 2.0, strokes),
        operation("finish", NORMAL, 0.0, strokes),
    ]))
    .expect("the paper's gear")
}

fn circle(strokes: u32) -> ShapingJob {
    let mut scene =
        paper_scene(vec![operation("rough", NORMAL, 2.0, strokes), operation("finish", NORMAL, 0.0, strokes)]);
    scene.gear.pitch_curve = PitchCurveShape::Circle;
    ShapingJob::new(scene).expect("a round gear")
}

const READINGS: [(&str, Linkage); 3] = [
    ("traditional", TRADITIONAL),
    ("normal", NORMAL),
    ("normal_as_printed", Linkage::ShapingNormal { reading: NormalReading::AsPrinted }),
];

#[test]
fn target_flanks_are_the_oracles() {
    for (file, job) in [("external_s0_flanks", rough_and_finish(NORMAL, 360)), ("external_circle", circle(360))] {
        let data = oracle(file);
        let flanks = if file == "external_circle" { &data["flanks"] } else { &data };
        let tolerance = number(&flanks["tolerance"]);
        let generation = job.target_generation();
        let mut worst = 0.0_f64;
        for row in flanks["points"].as_array().expect("points") {
            let tooth = row["tooth"].as_i64().expect("tooth");
            let (space, side) = if row["flank"] == "left" { (tooth, Side::Left) } else { (tooth - 1, Side::Right) };
            let contact = generation.flank_contact(number(&row["phi_contact"]), space as f64, side).expect("contact");
            worst = worst.max(contact.point_mm.distance(point(&row["point"])));
            assert!((contact.roll - number(&row["u"])).abs() < 1e-10, "{row}");
        }
        println!("{file}: worst distance {worst:.2e} mm");
        assert!(worst < tolerance);
    }
}

fn check_exact(expected: &Value, got: &[ToothAllowance], tolerance: &Value) {
    let points = number(&tolerance["exact_points"]);
    let percent = number(&tolerance["exact_unevenness_percent"]);
    for row in expected["teeth"].as_array().expect("teeth") {
        let tooth = &got[row["tooth"].as_u64().expect("tooth") as usize - 1];
        for (name, crossing) in [("A", tooth.a), ("B", tooth.b), ("C", tooth.c), ("D", tooth.d)] {
            let distance = crossing.expect("crossing").point_mm.distance(point(&row[name]));
            assert!(distance < points, "tooth {} {name}: {distance:.2e} mm off", tooth.tooth);
        }
        assert!((tooth.ab_mm().expect("AB") - number(&row["AB"])).abs() < number(&tolerance["exact_allowance"]));
        assert!((tooth.cd_mm().expect("CD") - number(&row["CD"])).abs() < number(&tolerance["exact_allowance"]));
        assert!((tooth.unevenness_mean_percent().expect("ratio") - number(&row["unevenness"])).abs() < percent);
    }
    // The oracle's summary is over the first period of the third-order gear, its teeth 1 to 14; of the circle over the
    // rows given.
    let count = expected["teeth"].as_array().expect("teeth").len().min(14);
    let summary = summarise(got[..count].iter().map(ToothAllowance::unevenness_mean_percent)).expect("teeth");
    assert!((summary.max_percent - number(&expected["max"])).abs() < percent);
    assert!((summary.mean_percent - number(&expected["mean"])).abs() < percent);
}

#[test]
fn envelope_allowances_are_the_oracles() {
    let data = oracle("external_s0_allowances");
    for (name, linkage) in READINGS {
        let got = paper_allowances(&rough_and_finish(linkage, 360), CrossedSurface::Envelope);
        check_exact(&data["exact_envelope"][name], &got, &data["tolerance"]);
    }
    let data = oracle("external_circle");
    let got = paper_allowances(&circle(360), CrossedSurface::Envelope);
    check_exact(&data["allowances"]["exact_envelope"]["normal"], &got, &data["allowances"]["tolerance"]);
}

#[test]
fn stroke_allowances_are_the_oracles() {
    let data = oracle("external_s0_allowances");
    for strokes in [120, 360, 720, 4000, 20000] {
        for (name, linkage) in &READINGS[..2] {
            let expected = &data["discrete"][strokes.to_string()][name];
            let got = paper_allowances(&rough_and_finish(*linkage, strokes), CrossedSurface::Strokes);
            let mut worst = 0.0_f64;
            for tooth in &got {
                let i = tooth.tooth as usize - 1;
                worst = worst.max((tooth.ab_mm().expect("AB") - number(&expected["AB"][i])).abs());
                worst = worst.max((tooth.cd_mm().expect("CD") - number(&expected["CD"][i])).abs());
            }
            println!("N = {strokes} {name}: worst {worst:.2e} mm");
            // Both programs are exact here: far inside the oracle's own tolerance (2e-6 mm), which serves polygon
            // models.
            assert!(worst < 1e-10, "N = {strokes} {name}: {worst:.2e} mm");
        }
    }
}

#[test]
fn facets_are_the_oracles() {
    let shape = paper_scene(Vec::new()).gear.pitch_curve;
    check_facets(&oracle("external_s0_facets"), &shape);
    check_facets(&oracle("external_circle")["facets"], &PitchCurveShape::Circle);
}

/// Crest heights, and with them the law K / N^2 between the two stroke counts that the oracle gives.
fn check_facets(data: &Value, shape: &PitchCurveShape) {
    let tolerance = number(&data["tolerance"]["simulated_relative_at_N_ge_720"]);
    for row in data["rows"].as_array().expect("rows") {
        let strokes = row["N"].as_u64().expect("N") as u32;
        let tooth = row["tooth"].as_u64().expect("tooth") as u32;
        let side = if row["flank"] == "left" { Side::Left } else { Side::Right };
        let mut scene = paper_scene(vec![operation("finish", NORMAL, 0.0, strokes)]);
        scene.gear.pitch_curve = shape.clone();
        scene.fields = Fields { profile_spacing_mm: 0.72 / f64::from(strokes), lead_spacing_mm: 30.0, ..scene.fields };
        let job = ShapingJob::new(scene).expect("the gear");
        let flank = job.target_flank(tooth, side);
        let field = job.flank_field(flank);
        // Two strokes, half a step before and after the contact that the row names: one crest.
        let linkage = &job.finishing().linkage;
        let psi_c = linkage.axes(number(&row["phi_contact"]), 0.0).psi_c_rad.value();
        let strokes_around = StrokeSet::new(0, &job.cutter, StrokeLaw::Frozen, 2, |lambda| {
            let phi = linkage.phi_at_work_angle(psi_c + (lambda - 0.5) * TAU / f64::from(strokes), 0.0);
            let pose = linkage.pose(phi, 0.0);
            Rigid2::new(pose.angle_rad, pose.center_mm)
        });
        let mut layer = field.blank_layer();
        let plan = CutPlan::new(&field, &strokes_around, &job.cutter);
        Cpu::default().cut(&field, &plan, &mut layer).expect("native");
        let found = cusps(&facets(&field, &layer, 0));
        let height = found.iter().map(|c| c.height_mm).fold(f64::INFINITY, f64::min);
        let (closed, crest) = (number(&row["closed_form_mm"]), number(&row["crest_simulated_mm"]));
        println!(
            "N {strokes} tooth {tooth}: {:.6} um, closed {:.6}, oracle crest {:.6}",
            height * 1e3,
            closed * 1e3,
            crest * 1e3
        );
        assert!((height / crest - 1.0).abs() < tolerance, "N = {strokes}: {height} against {crest}");
        assert!((height / closed - 1.0).abs() < tolerance, "N = {strokes}: {height} against {closed}");
    }
}
