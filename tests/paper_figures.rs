//! The unevenness figures that Gao et al. (2017) print, beside what geometry gives: with a closed turn, with strokes that begin and end inside the first lobe, and with two readings of
//! the formulas that do not fit. docs/shaping.md shows the table that this test prints (`cargo test --test paper_figures -- --nocapture`).
//!
//! Expected values come from an independent implementation in another language; nothing here is fitted to the paper.

mod common;

use common::*;
use gearcut::job::Job;
use gearcut::measure::unevenness::{Surface, ToothAllowance, Unevenness, allowances, rack_allowance_mm, summarise};
use gearcut::scene::model::*;

/// The paper averages over the teeth of the first lobe.
const LOBE_TEETH: usize = 14;
const AS_PRINTED: Linkage = Linkage::ShapingNormal { reading: NormalReading::AsPrinted };
const POLAR: Linkage = Linkage::ShapingTraditional { direction: TraditionalDirection::PolarRadius };
/// What the paper prints: largest and mean, percent.
const PRINTED: [[f64; 2]; 2] = [[132.47, 91.23], [5.03, 2.76]];

/// Allowances of the first lobe and the rack allowance; roughing 2 mm off by `linkage`, then finishing, both with N strokes per revolution in a window of work angles.
fn lobe(linkage: Linkage, strokes: u32, window_deg: Option<[f64; 2]>, surface: Surface) -> (Vec<ToothAllowance>, f64) {
    let mut operations = vec![operation("rough", linkage, 2.0, strokes), operation("finish", NORMAL, 0.0, strokes)];
    for operation in &mut operations {
        operation.window_rad = window_deg.map(|ends| ends.map(f64::to_radians));
    }
    let job = Job::new(paper_scene(operations)).expect("the paper's gear");
    let mut teeth = allowances(&job, 0, surface).expect("flanks");
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

/// Agreement to the digits printed: half a unit of the last one.
#[track_caller]
fn agrees(what: &str, found: Unevenness, [max, mean]: [f64; 2], digits: i32) {
    let half_unit = 0.5 * 10_f64.powi(-digits) + 1e-9;
    let off = [found.max_percent - max, found.mean_percent - mean];
    assert!(off.iter().all(|d| d.abs() <= half_unit), "{what}: {found:?}, expected {max} / {mean}");
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
    let closed = [TRADITIONAL, NORMAL].map(|linkage| both_denominators(&lobe(linkage, 360, None, Surface::Envelope)));
    row("envelope, closed turn; over the mean of AB and CD", closed[0][0], closed[1][0]);
    agrees("envelope, traditional", closed[0][0], [129.52, 85.58], 2);
    agrees("envelope, normal", closed[1][0], [3.98, 2.07], 2);
    row("envelope, closed turn; over the rack allowance", closed[0][1], closed[1][1]);
    agrees("envelope, traditional, rack", closed[0][1], [135.3, 88.9], 1);
    agrees("envelope, normal, rack", closed[1][1], [4.07, 2.17], 2);

    let runs = [
        (360, [1.0, 119.0], [[129.61, 87.20], [4.38, 2.53]], Some([[135.26, 90.82], [4.97, 2.70]])),
        (720, [1.0, 119.0], [[f64::NAN; 2]; 2], Some([[135.3, 90.9], [4.97, 2.81]])),
        (400, [1.0, 132.0], [[129.9, 87.3], [5.25, 2.68]], None),
        (415, [1.0, 137.0], [[129.70, 87.28], [5.04, 2.68]], None),
    ];
    for (strokes, window_deg, mean, rack) in runs {
        let [traditional, normal] = [TRADITIONAL, NORMAL]
            .map(|linkage| both_denominators(&lobe(linkage, strokes, Some(window_deg), Surface::Strokes)));
        let what = format!("N = {strokes}, strokes at {} to {} deg", window_deg[0], window_deg[1]);
        row(&format!("{what}; over the mean of AB and CD"), traditional[0], normal[0]);
        row(&format!("{what}; over the rack allowance"), traditional[1], normal[1]);
        println!("{strokes} {mean:?} {rack:?}");
    }
}

#[test]
fn two_readings_that_do_not_fit() {
    let of = |linkage| both_denominators(&lobe(linkage, 360, None, Surface::Envelope))[0];
    let (polar, as_printed) = (of(POLAR), of(AS_PRINTED));
    row("offset along the polar radius; Eq. 12 as printed", polar, as_printed);
    agrees("offset along the polar radius", polar, [200.0, 131.9], 1);
    agrees("Eq. 12 as printed", as_printed, [43.6, 28.9], 1);
}
