//! Profile parameters of `gearcut texture`: what a line of a surface gives, which are other numbers than those of a
//! surface that was filtered.

use crate::fixtures::command::gearcut;
use gearcut::measure::topography::Surface;
use gearcut::output::surface_files::{Format, SurfaceFile, write_surface};
use serde_json::Value;
use std::f64::consts::{PI, TAU};

/// JSON of a surface with these heights, evaluated with these arguments.
fn evaluated(size: [usize; 2], step_um: [f64; 2], height: impl Fn(f64, f64) -> f64, arguments: &[&str]) -> Value {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("s.npy");
    let heights = (0..size[0] * size[1])
        .map(|i| height((i % size[0]) as f64 * step_um[0], (i / size[0]) as f64 * step_um[1]))
        .collect();
    let surface = Surface::new(size[0], size[1], step_um[0], step_um[1], heights).expect("a surface");
    write_surface(&path, Format::Npy, &SurfaceFile { surface, notes: Vec::new() }).expect("written");
    let path = path.to_str().expect("a plain path");
    let out = gearcut(&[&["texture", path, "--json"], arguments].concat()).done().out;
    serde_json::from_str(&out).expect("JSON")
}

fn value(line: &Value, symbol: &str) -> f64 {
    line["parameters"][symbol]["value"].as_f64().unwrap_or_else(|| panic!("{symbol}: {line}"))
}

fn near(value: f64, closed: f64, share: f64) {
    assert!((value / closed - 1.0).abs() < share, "{value} is not {closed}");
}

fn wave(x: f64, length: f64) -> f64 {
    (TAU * x / length).sin()
}

/// Grooves along the trace whose depth waves: 2 mm is waviness for 0.8 mm, of which 1 - 2^-0.16 is left. An areal
/// filter of 0.8 mm lets all of it through, because the grooves across are short.
#[test]
fn a_wave_along_the_trace_is_filtered_however_short_the_waves_across_are() {
    let grooves = |x: f64, y: f64| (TAU * x / 2000.0).cos() * (TAU * y / 20.0).cos();
    let found =
        evaluated([1001, 61], [8.0, 1.0], grooves, &["--form", "none", "--l-filter-um", "800", "--line", "y=40"]);
    near(value(&found["profiles"][0], "Ra"), 2.0 / PI * (1.0 - 2_f64.powf(-0.16)), 0.01);
    assert_eq!(found["profiles"][0]["cutoff_um"], 800.0);
}

/// Feed marks of 0.12 mm that lean against the trace: it meets one every 3.44 mm.
#[test]
fn feed_marks_that_lean_are_waviness_along_the_tooth() {
    let lean = 2_f64.to_radians();
    let marks = |x: f64, y: f64| wave(x * lean.sin() + y * lean.cos(), 120.0);
    let found =
        evaluated([701, 81], [20.0, 6.0], marks, &["--form", "none", "--l-filter-um", "800", "--line", "y=240"]);
    let length: f64 = 0.12 / lean.sin();
    near(value(&found["profiles"][0], "Ra"), 2.0 / PI * (1.0 - 2_f64.powf(-(0.8 / length).powi(2))), 0.1);
    // Across the marks they are roughness: lines along y, 4.2 mm long, so that 0.25 mm is the cut-off that fits.
    let found = evaluated([81, 701], [20.0, 6.0], marks, &["--lines", "x", "5"]);
    let left = 1.0 - 2_f64.powf(-(250.0 * lean.cos() / 120.0).powi(2));
    near(value(&found["profiles"][0], "Ra"), 2.0 / PI * left, 0.01);
}

#[test]
fn without_a_cutoff_parameters_are_those_of_the_primary_profile() {
    let waves = |x: f64, _: f64| wave(x + 1000.0, 4000.0) + 0.1 * wave(x, 100.0);
    let of = |arguments: &[&str]| {
        evaluated([1001, 5], [8.0, 10.0], waves, &[arguments, &["--form", "plane", "--line", "y=20"]].concat())
    };
    let found = of(&[]);
    let line = &found["profiles"][0];
    // Ra 0.065 um is of class Sc2, whose cut-off of 0.25 mm leaves 0.27 % of the wave and 99 % of the roughness.
    near(value(line, "Ra"), 0.0634, 0.02);
    assert_eq!(line["cutoff_um"], 250.0);
    near(value(&of(&["--cutoff-um", "800"])["profiles"][0], "Ra"), 0.0647, 0.01);
    let primary = &of(&["--profile", "p"])["profiles"][0];
    near(value(primary, "Pq"), (0.5 * 1.01_f64).sqrt(), 0.01);
    assert!(primary["cutoff_um"].is_null());
    let symbols = |line: &Value| line["parameters"].as_object().expect("by symbol").keys().cloned().collect::<Vec<_>>();
    assert!(symbols(primary).iter().all(|symbol| symbol.starts_with('P')), "{primary}");
    let wanted = "Ra Rq Rz Rt Rp Rv Rzx Rsk Rku Rdq RSm Rk Rpk Rvk Rmrk1 Rmrk2 Rmr(0)";
    assert_eq!(symbols(line), wanted.split(' ').collect::<Vec<_>>());
}

/// A form that no areal polynomial of second order takes off, and a straight line along each trace.
#[test]
fn a_line_loses_its_own_tilt() {
    let twisted = |x: f64, y: f64| {
        let rows = 1e-9 * x * ((y - 400.0).powi(2) - 56_000.0);
        rows + 0.05 * wave(x, 77.0)
    };
    let found = evaluated([501, 41], [8.0, 20.0], twisted, &["--line", "y=0"]);
    near(value(&found["profiles"][0], "Ra"), 0.1 / PI, 0.01);
}

#[test]
fn holes_are_bridged_and_counted_and_longer_ones_named() {
    let holed = |x: f64, y: f64| if x == 70.0 + y { f64::NAN } else { 0.5 * wave(x, 25.0) };
    let found = evaluated([400, 3], [0.5, 5.0], holed, &["--form", "none", "--line", "y=5"]);
    let line = &found["profiles"][0];
    // The line is too short for five sections: 119.5 um in its middle are evaluated, from 40 um on, which are 4.78
    // waves and no whole number. Of the mean of |sin| over them lambda_s of 2.5 um leaves 2^-(2.5 / 25)^2, and the
    // cut-off of 80 um 1 - 2^-(80 / 25)^2.
    let left = 2_f64.powf(-0.01) * (1.0 - 2_f64.powf(-10.24));
    let mean = |from: f64, to: f64| {
        let steps = 100_000;
        let at = |i: i32| wave(from + (to - from) * (f64::from(i) + 0.5) / f64::from(steps), 25.0).abs();
        (0..steps).map(at).sum::<f64>() / f64::from(steps)
    };
    near(value(line, "Ra"), 0.5 * mean(40.0, 159.5) * left, 2e-3);
    // All 400 points, which are 8 waves, without form and filter: the law of whole waves.
    let whole = ["--form", "none", "--line", "y=5", "--profile", "p", "--line-form", "none", "--lambda-s-um", "0"];
    let whole = evaluated([400, 3], [0.5, 5.0], holed, &whole);
    near(value(&whole["profiles"][0], "Pa"), 1.0 / PI, 3e-3);
    assert_eq!(line["chain"][0], "holes: 1 of 1 points in all, bridged by straight lines, the longest over 1 um");
    let wide = |x: f64, y: f64| if (70.0..80.0).contains(&x) && y > 3.0 { f64::NAN } else { 0.5 * wave(x, 25.0) };
    let of = |arguments: &[&str]| evaluated([400, 3], [0.5, 5.0], wide, &[&["--form", "none"], arguments].concat());
    let refused = of(&["--line", "y=5"])["profiles"][0]["why"].to_string();
    assert!(refused.contains("20 points, 10.5000 um long, 69.5000 um from its start"), "{refused}");
    assert!(of(&["--line", "y=5", "--bridge-um", "11"])["profiles"][0]["parameters"].is_object());
    // Of three lines, two are without parameters; mean and range are those of the third.
    let three = &of(&["--lines", "y", "3"])["profiles"][0];
    assert_eq!(three["lines_without_parameters"].as_array().map(Vec::len), Some(2));
    near(value(three, "Ra"), 0.5 * mean(40.0, 159.5) * left, 2e-3);
}

/// Amplitudes of 0.5 to 1.5 um over the rows: mean and range of five of them, and a drawing's limits.
#[test]
fn several_lines_have_mean_and_range_and_are_judged_by_the_largest() {
    let growing = |x: f64, y: f64| (0.5 + y / 1000.0) * wave(x, 50.0);
    let arguments = ["--form", "none", "--lines", "y", "5", "--ra-limit-um", "0.8", "--rz-limit-um", "4"];
    let found = evaluated([2001, 101], [4.0, 10.0], growing, &arguments);
    let lines = &found["profiles"][0];
    assert_eq!(lines["at_um"], serde_json::json!([100.0, 300.0, 500.0, 700.0, 900.0]));
    near(value(lines, "Ra"), 2.0 / PI, 0.01);
    let range = |symbol: &str, k: usize| lines["ranges"][symbol][k].as_f64().expect("a number");
    near(range("Ra", 0), 2.0 / PI * 0.6, 0.01);
    near(range("Ra", 1), 2.0 / PI * 1.4, 0.01);
    assert_eq!(lines["limits"]["Ra"]["kept"], false, "{lines}");
    assert_eq!(lines["limits"]["Rz"]["kept"], true, "{lines}");
    assert!(lines["chain"][3].as_str().is_some_and(|words| words.contains("for a limit of Ra 0.8 um")), "{lines}");
}
