//! Noise that goes on within a stroke while the feed rests, as worked out by hand.
//!
//! Two places of a stroke that are a time t apart differ, where first-order noise of the standard deviation sigma and
//! the bandwidth f_c moves the centre distance, by heights of the variance 2 sigma^2 sin^2(alpha) (1 - exp(-2 pi f_c
//! t)): the noise's own at both, whatever the stroke and its neighbours are ([`super::noise`]). The ram is at z at
//! theta = arccos(2 (z - z_m) / L), and 2 pi are a double stroke.

use super::machine_errors::{ALPHA_RAD, ROUND, job};
use super::noise::contacts;
use gearcut::cut::cpu::Cpu;
use gearcut::process::shaping::ShapingJob;
use gearcut::terms::Side;
use std::f64::consts::TAU;

const FINE: [&str; 3] =
    ["operation.finish.strokes_per_revolution=10000", "machine.approach_mm=5", "machine.overrun_mm=3"];
const SECONDS_PER_STROKE: f64 = 0.2;
/// Length of the stroke and its middle over that of the face, mm: 5 mm before a face of 20 mm and 3 mm behind it.
const LENGTH_MM: f64 = 28.0;
const MIDDLE_MM: f64 = 1.0;
/// Half a nanometre: ridges between strokes are higher.
const SIGMA_MM: f64 = 5e-7;
/// The places of the face through which a stroke's cubic runs: roots of Chebyshev's fourth polynomial over half the
/// face, and others between them.
const NODES_MM: [f64; 4] = [-9.238_795_325, -3.826_834_324, 3.826_834_324, 9.238_795_325];
const BETWEEN_MM: [f64; 2] = [-6.6, 6.6];

fn passed_s(from_mm: f64, to_mm: f64) -> f64 {
    let angle = |z_mm: f64| (2.0 * (z_mm - MIDDLE_MM) / LENGTH_MM).acos();
    (angle(to_mm) - angle(from_mm)).abs() / TAU * SECONDS_PER_STROKE
}

/// Heights at rows along the tooth where strokes touch the left flanks of all teeth, ray by ray.
fn heights(settings: &[&str], rows_mm: &[f64]) -> Vec<Vec<f64>> {
    let (sound, noisy) = (job(ROUND, &FINE), job(ROUND, &[&FINE, settings].concat()));
    let mut found = Vec::new();
    for tooth in 1..=24 {
        let arcs_mm = contacts(&sound, tooth, Side::Left).into_iter().map(|(arc_mm, _)| arc_mm);
        let field = sound.field_over(sound.target_flank(tooth, Side::Left), arcs_mm, rows_mm.to_vec());
        let layers = noisy.cut(&Cpu::default(), field).expect("native").layers;
        let heights: Vec<f64> = layers[0].heights_mm.iter().map(|&height| f64::from(height)).collect();
        found.extend(heights.chunks(rows_mm.len()).map(<[f64]>::to_vec));
    }
    found
}

fn variance_of_difference(heights: &[Vec<f64>], [a, b]: [usize; 2]) -> f64 {
    heights.iter().map(|rows| (rows[a] - rows[b]).powi(2)).sum::<f64>() / heights.len() as f64
}

fn by_hand(bandwidth_hz: f64, passed_s: f64) -> f64 {
    2.0 * (SIGMA_MM * ALPHA_RAD.sin()).powi(2) * (1.0 - (-TAU * bandwidth_hz * passed_s).exp())
}

#[test]
fn places_of_a_stroke_differ_by_the_noise_of_the_time_between_them() {
    let bandwidth_hz = 5.0;
    let noise = [
        "machine.errors.seed=4".to_owned(),
        format!("machine.errors.center_distance.noise_um={}", 1e3 * SIGMA_MM),
        format!("machine.errors.center_distance.noise_bandwidth_hz={bandwidth_hz}"),
    ];
    let heights = heights(&noise.each_ref().map(String::as_str), &NODES_MM);
    assert!(heights.len() > 9000, "{} contacts", heights.len());
    for pair in [[0, 1], [1, 2], [2, 3], [0, 3]] {
        let found = variance_of_difference(&heights, pair);
        let [from_mm, to_mm] = pair.map(|row| NODES_MM[row]);
        let share = |passed_s: f64| found / by_hand(bandwidth_hz, passed_s);
        let passed_s = passed_s(from_mm, to_mm);
        println!("{from_mm} to {to_mm} mm, {passed_s:.4} s: {:.4} of the variance by hand", share(passed_s));
        // Strokes 0.2 s apart have noise of the correlation 0.002, so that 9,000 differences have a variance that
        // scatters by sqrt(2 / 9,000) = 1.5 %: three times that.
        assert!((share(passed_s) - 1.0).abs() < 0.045, "{from_mm} to {to_mm} mm");
        // Planted: a ram that runs through the face evenly, and one that takes half as long.
        assert!((share(0.5 * passed_s) - 1.0).abs() > 0.045);
    }
    let even_s = |pair: [usize; 2]| {
        let [from_mm, to_mm] = pair.map(|row| NODES_MM[row]);
        (to_mm - from_mm) / 20.0 * passed_s(-10.0, 10.0)
    };
    assert!((variance_of_difference(&heights, [1, 2]) / by_hand(bandwidth_hz, even_s([1, 2])) - 1.0).abs() > 0.045);
}

/// Noise that strokes are said to follow keeps its variance between the four places as well: a tenth of sigma apart is
/// a hundredth of the variance, and what differs along the face is some tenths of it.
#[test]
fn slow_noise_has_its_variance_between_the_nodes() {
    let bandwidth_hz = 0.25;
    let noise = [
        format!("machine.errors.center_distance.noise_um={}", 1e3 * SIGMA_MM),
        format!("machine.errors.center_distance.noise_bandwidth_hz={bandwidth_hz}"),
    ];
    let heights = heights(&noise.each_ref().map(String::as_str), &BETWEEN_MM);
    let found = variance_of_difference(&heights, [0, 1]);
    let share = found / by_hand(bandwidth_hz, passed_s(BETWEEN_MM[0], BETWEEN_MM[1]));
    println!("{share:.4} of the variance by hand");
    assert!((share - 1.0).abs() < 0.1, "{share}");
}

fn rows_are_alike(settings: &[&str]) -> bool {
    let job: ShapingJob = job(ROUND, &[&["operation.finish.strokes_per_revolution=600"], settings].concat());
    job.planar().rows_are_alike()
}

/// A stroke of which nothing goes on is cut once for the whole face: without noise, with one value for each stroke, and
/// with stock that scatters along the pitch curve, on which a resting feed stands still.
#[test]
fn only_noise_in_time_goes_on_while_the_feed_rests() {
    let sigma = "machine.errors.work.noise_arcsec=1";
    assert!(rows_are_alike(&[]) && rows_are_alike(&[sigma]));
    assert!(rows_are_alike(&["operation.finish.stock_scatter_um=3", "operation.finish.stock_scatter_length_mm=5"]));
    assert!(!rows_are_alike(&[sigma, "machine.errors.work.noise_bandwidth_hz=1"]));
}
