//! A chord or stock below zero keeps its sign, and is told before anything is cut.

use gearcut::cut::cpu::Cpu;
use gearcut::findings::Severity;
use gearcut::interrupt::Interrupt;
use gearcut::process::load;
use gearcut::process::shaping::axes_report::OperationAxes;
use gearcut::process::shaping::findings::warnings;
use gearcut::process::shaping::gear::measure::below_finished::below_finished;
use gearcut::process::shaping::gear::measure::unevenness::{CrossedSurface, allowances, crossings};
use gearcut::process::shaping::{ShapingJob, cut_gear};
use gearcut::progress::{Progress, ProgressMode};
use gearcut::steps::parts::Stages;
use std::path::Path;

fn job(scene: &str, settings: &[&str]) -> ShapingJob {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let scene = load(Path::new(scene), &settings).unwrap_or_else(|problems| panic!("{problems}"));
    ShapingJob::new(scene.scene).expect("a gear")
}

const ROUND: &str = "scenes/shaping/circular_m3_z24.toml";
const COARSE: [&str; 3] =
    ["fields.flank.profile_spacing_um=100", "fields.flank.lead_spacing_um=5000", "fields.chips.spacing_mm=0.5"];

/// A roughing that goes d deeper than finishing takes a (inv alpha - inv alpha') off the flanks along the pitch circle,
/// with the centre distance a and cos(alpha') = a cos(alpha) / (a - d), and cos(alpha) times that along the normal.
#[test]
fn a_roughing_deeper_than_finishing_is_negative_by_the_closed_form() {
    const DEEPER_MM: f64 = 0.2;
    let job = job(ROUND, &[&COARSE[..], &["operation.rough.offset_mm=-0.2"]].concat());
    let alpha = job.scene.gear.pressure_angle_rad;
    let progress = Progress::new(ProgressMode::Quiet);
    let gear = cut_gear(&job, Stages::ALL, &Cpu::default(), (&progress, &Interrupt::default()), None).expect("a gear");
    let allowance = &gear.report.allowances[0];
    let center_mm = job.curve.perimeter_mm() / std::f64::consts::TAU + job.cutter.pitch_radius_mm;
    let working = (center_mm * alpha.cos() / (center_mm - DEEPER_MM)).acos();
    let involute = |angle: f64| angle.tan() - angle;
    let closed_mm = center_mm * (involute(working) - involute(alpha));
    for of in [&allowance.strokes[4], &allowance.envelope[4]] {
        for chord_mm in [of.ab_mm().expect("AB"), of.cd_mm().expect("CD")] {
            // Feed marks of the roughing are below a micrometre.
            assert!((chord_mm - closed_mm).abs() < 1e-3, "{chord_mm} mm, {closed_mm} mm by the closed form");
        }
    }
    let smallest = gear.report.flanks[9].own.stock[0].expect("stock").smallest.value_mm;
    let closed_mm = closed_mm * alpha.cos();
    assert!((smallest - closed_mm).abs() < 1e-3, "{smallest} mm, {closed_mm} mm by the closed form");
    let told = warnings::before(&job, &OperationAxes::of_job(&job), None).expect("warnings");
    let fault = "operation rough: it goes 0.200 mm deeper than finishing and cuts some 68.4 um into every flank";
    assert!(told.iter().any(|of| of.severity == Severity::Fault && of.text.starts_with(fault)), "{told:?}");
}

/// The traditional linkage leaves uneven stock on an oval; with little of it one flank falls below zero. Envelope and
/// strokes agree on the sign, and the forecast has the depth of the deepest chord.
#[test]
fn an_oval_roughed_too_close_is_told_with_tooth_and_depth() {
    let settings = [
        "gear.pitch_curve={ellipse={order=2,eccentricity=0.3}}",
        "gear.teeth=42",
        "operation.rough.offset_mm=0.02",
        "operation.rough.strokes_per_revolution=4200",
        "operation.finish.strokes_per_revolution=4200",
    ];
    let job = job("scenes/shaping/elliptical_traditional.toml", &settings);
    let of = |operation, surface| crossings(&job, operation, surface).teeth;
    let envelope = allowances(&of(0, CrossedSurface::Envelope), &of(1, CrossedSurface::Envelope));
    let strokes = allowances(&of(0, CrossedSurface::Strokes), &of(1, CrossedSurface::OwnStrokes));
    let chords = |of: &gearcut::process::shaping::gear::measure::unevenness::ToothAllowance| [of.ab_mm(), of.cd_mm()];
    let mut lowest_mm = f64::INFINITY;
    for (envelope, strokes) in envelope.iter().zip(&strokes) {
        for (envelope, strokes) in chords(envelope).into_iter().zip(chords(strokes)) {
            let (envelope, strokes) = (envelope.expect("a chord"), strokes.expect("a chord"));
            // Feed marks of both operations are below a micrometre.
            assert!((envelope - strokes).abs() < 1e-3, "{envelope} mm and {strokes} mm");
            lowest_mm = lowest_mm.min(envelope);
        }
    }
    let below = below_finished(&job);
    println!("lowest chord {lowest_mm} mm, {below:?}");
    assert_eq!(below.is_empty(), lowest_mm >= 0.0);
    if let Some(below) = below.first() {
        // Along the normal, and at least as deep as on the pitch curve.
        let cos = job.scene.gear.pressure_angle_rad.cos();
        assert!(below.depth_mm > -0.95 * cos * lowest_mm, "{below:?}, {lowest_mm} mm");
    }
    assert!(lowest_mm < 0.0, "the case is meant to fall below zero");
}

/// Even stock warns of nothing.
#[test]
fn stock_above_zero_is_silent() {
    assert_eq!(below_finished(&job(ROUND, &[])), []);
    assert_eq!(below_finished(&job("scenes/shaping/elliptical_normal.toml", &[])), []);
}
