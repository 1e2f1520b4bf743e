//! The unevenness figures that Gao et al. (2017) print, beside what geometry gives: with a closed turn, with strokes
//! that begin and end inside the first lobe, and with two readings of the formulas that do not fit. docs/shaping.md
//! shows the table that this test prints (`cargo test --test paper_figures -- --nocapture`).
//!
//! Expected values come from an independent implementation in another language; nothing here is fitted to the paper.

use crate::fixtures::paper::*;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::gear::measure::unevenness::{
    CrossedSurface, ToothAllowance, Unevenness, rack_allowance_mm, summarise,
};
use gearcut::process::shaping::scene::model::*;

/// The paper averages over the teeth of the first lobe.
const LOBE_TEETH: usize = 14;
const AS_PRINTED: Linkage = Linkage::ShapingNormal { reading: NormalReading::AsPrinted };
const POLAR: Linkage = Linkage::ShapingTraditional { direction: TraditionalDirection::PolarRadius };
/// What the paper prints: largest and mean, percent.
const PRINTED: [[f64; 2]; 2] = [[132.47, 91.23], [5.03, 2.76]];

/// A run whose strokes begin about a degree after the lobe does and end about a degree before its end: no stroke comes
/// back over the first and the last flank.
struct Run {
    /// N.
    strokes: u32,
    /// Number of the first stroke; stroke i stands at the work angle i 360 / N deg.
    first_stroke: u32,
    /// Number of the last stroke.
    last_stroke: u32,
    /// Largest and mean unevenness over the mean of AB and CD: traditional, normal.
    mean: Option<[[f64; 2]; 2]>,
    /// The same over the rack allowance.
    rack: Option<[[f64; 2]; 2]>,
    /// Decimals to which the traditional linkage's values are known.
    traditional_tolerance: f64,
}

const RUNS: [Run; 4] = [
    Run {
        strokes: 360,
        first_stroke: 1,
        last_stroke: 119,
        mean: Some([[129.61, 87.20], [4.38, 2.53]]),
        rack: Some([[135.26, 90.82], [4.97, 2.70]]),
        traditional_tolerance: TWO_DECIMALS,
    },
    Run {
        strokes: 720,
        first_stroke: 2,
        last_stroke: 238,
        mean: None,
        rack: Some([[135.3, 90.9], [4.97, 2.81]]),
        traditional_tolerance: ONE_DECIMAL,
    },
    Run {
        strokes: 400,
        first_stroke: 1,
        last_stroke: 132,
        mean: Some([[129.9, 87.3], [5.25, 2.68]]),
        rack: None,
        traditional_tolerance: ONE_DECIMAL,
    },
    Run {
        strokes: 415,
        first_stroke: 1,
        last_stroke: 137,
        mean: Some([[129.70, 87.28], [5.04, 2.68]]),
        rack: None,
        traditional_tolerance: TWO_DECIMALS,
    },
];

/// Allowances of the first lobe and the rack allowance; roughing 2 mm off by `linkage`, then finishing, both with N
/// strokes per revolution in a window of work angles.
fn lobe(
    linkage: Linkage,
    strokes: u32,
    window_deg: Option<[f64; 2]>,
    surface: CrossedSurface,
) -> (Vec<ToothAllowance>, f64) {
    let mut operations = vec![operation("rough", linkage, 2.0, strokes), operation("finish", NORMAL, 0.0, strokes)];
    for operation in &mut operations {
        operation.window_rad = window_deg.map(|ends| ends.map(f64::to_radians));
    }
    let job = ShapingJob::new(paper_scene(operations)).expect("the paper's gear");
    let mut teeth = paper_allowances(&job, surface);
    teeth.truncate(LOBE_TEETH);
    (teeth, rack_allowance_mm(&job, 0))
}

/// Unevenness with the mean of AB and CD as denominator, and with the rack allowance.
fn both_denominators((teeth, rack_mm): &(Vec<ToothAllowance>, f64)) -> [Unevenness; 2] {
    let of = |percent: &dyn Fn(&ToothAllowance) -> Option<f64>| {
        let percents: Vec<_> = teeth.iter().map(percent).collect();
        assert!(percents.iter().all(Option::is_some), "every tooth of the lobe has both allowances");
        summarise(percents).expect("teeth")
    };
    [of(&ToothAllowance::unevenness_mean_percent), of(&|tooth| tooth.unevenness_rack_percent(*rack_mm))]
}

/// Half a unit of the second decimal, which is the last that most expected values have.
const TWO_DECIMALS: f64 = 0.00501;
/// Half a unit of the first decimal.
const ONE_DECIMAL: f64 = 0.0501;

#[track_caller]
fn agrees(what: &str, found: Unevenness, [max, mean]: [f64; 2], tolerance_percent: f64) {
    let off = [found.max_percent - max, found.mean_percent - mean];
    assert!(off.iter().all(|d| d.abs() < tolerance_percent), "{what}: {found:?}, expected {max} / {mean}");
}

fn row(what: &str, traditional: Unevenness, normal: Unevenness) {
    println!(
        "| {what} | {:.2} / {:.2} | {:.2} / {:.2} |",
        traditional.max_percent, traditional.mean_percent, normal.max_percent, normal.mean_percent
    );
}

#[test]
fn a_closed_turn_and_the_runs_that_explain_the_paper() {
    println!("| teeth 1 to 14, largest / mean unevenness in % | traditional | normal |\n| --- | --- | --- |");
    let [[t_max, t_mean], [n_max, n_mean]] = PRINTED;
    println!("| printed in the paper | {t_max} / {t_mean} | {n_max} / {n_mean} |");
    let [traditional, normal] =
        [TRADITIONAL, NORMAL].map(|linkage| both_denominators(&lobe(linkage, 360, None, CrossedSurface::Envelope)));
    row("closed turn, envelope; mean of AB and CD", traditional[0], normal[0]);
    row("closed turn, envelope; rack allowance", traditional[1], normal[1]);
    agrees("envelope, traditional, mean", traditional[0], [129.52, 85.58], TWO_DECIMALS);
    agrees("envelope, normal, mean", normal[0], [3.98, 2.07], TWO_DECIMALS);
    agrees("envelope, traditional, rack", traditional[1], [135.26, 88.95], TWO_DECIMALS);
    agrees("envelope, normal, rack", normal[1], [4.07, 2.17], TWO_DECIMALS);

    for Run { strokes, first_stroke, last_stroke, mean, rack, traditional_tolerance } in RUNS {
        let ends_deg = [first_stroke, last_stroke].map(|stroke| 360.0 * f64::from(stroke) / f64::from(strokes));
        let [traditional, normal] = [TRADITIONAL, NORMAL]
            .map(|linkage| both_denominators(&lobe(linkage, strokes, Some(ends_deg), CrossedSurface::Strokes)));
        let what = format!("N = {strokes}, {:.1} to {:.1} deg", ends_deg[0], ends_deg[1]);
        row(&format!("{what}; mean of AB and CD"), traditional[0], normal[0]);
        row(&format!("{what}; rack allowance"), traditional[1], normal[1]);
        for (found, expected) in [([traditional[0], normal[0]], mean), ([traditional[1], normal[1]], rack)] {
            let Some([expected_traditional, expected_normal]) = expected else { continue };
            agrees(&format!("{what}, traditional"), found[0], expected_traditional, traditional_tolerance);
            agrees(&format!("{what}, normal"), found[1], expected_normal, TWO_DECIMALS);
        }
    }
}

#[test]
fn two_readings_that_do_not_fit() {
    let of = |linkage| both_denominators(&lobe(linkage, 360, None, CrossedSurface::Envelope))[0];
    let (polar, as_printed) = (of(POLAR), of(AS_PRINTED));
    row("closed turn, envelope: offset along the polar radius; Eq. 12 as printed", polar, as_printed);
    // On one tooth CD falls below zero: the difference is larger than the sum.
    agrees("offset along the polar radius", polar, [201.14, 132.18], TWO_DECIMALS);
    agrees("Eq. 12 as printed", as_printed, [43.61, 28.86], TWO_DECIMALS);
}
