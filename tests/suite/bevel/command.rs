//! A bevel gear from the command line: what a run writes, and that the same scene gives the same bytes.

use crate::fixtures::command::{assert_same_files, check_as_it_is, files, gearcut_on_threads, read_json};
use crate::fixtures::json_schema::assert_is_results;

const COARSE: [&str; 12] = [
    "--set",
    "operation.finish.roll_speed_deg_per_s=20",
    "--set",
    "fields.blank.spacing_mm=1",
    "--set",
    "fields.flank.profile_spacing_um=300",
    "--set",
    "fields.flank.lead_spacing_um=2000",
    "--set",
    "texture.0.tooth=2",
    "--set",
    "picture.0.width_px=96",
];

#[test]
fn a_run_writes_the_same_files_on_one_thread_and_on_two() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut runs = Vec::new();
    for threads in [1, 2] {
        let out = folder.path().join(format!("on_{threads}"));
        let arguments =
            ["cut", "scenes/bevel/setting_errors.toml", "--backend", "cpu", "--out", out.to_str().expect("a path")];
        let alone: &[&str] = if threads == 1 {
            &["--only", "numbers"]
        } else {
            &["--only", "numbers,axes,report,texture,pictures", "--frames", "2"]
        };
        gearcut_on_threads(threads, &[&arguments[..], &COARSE[..], alone].concat()).done().says(&[
            "highest deviation",
            "slot depth",
            "idle share of the roll",
            "root angle off by 0.0",
            "124 of 124 flanks cut",
        ]);
        assert_is_results(&read_json(&out.join("results.json")));
        runs.push(out);
    }
    let numbers = |out: &std::path::Path| {
        let all = files(out).into_iter();
        all.filter(|(path, _)| path.starts_with("tables") || path.ends_with("results.json")).collect::<Vec<_>>()
    };
    assert!(numbers(&runs[0]).len() >= 5);
    assert_same_files(&numbers(&runs[0]), &numbers(&runs[1]));
    for file in [
        "report.html",
        "axes/finish.csv",
        "axes/finish.ngc",
        "axes/finish_positions.svg",
        "tables/grid.csv",
        "pictures/flank.png",
    ] {
        assert!(runs[1].join(file).is_file(), "{file} is missing");
    }
    // Points for a measuring machine: 45 on each of 124 flanks, with unit normals.
    let grid = std::fs::read_to_string(runs[1].join("tables/grid.csv")).expect("a table");
    assert_eq!(grid.lines().count(), 1 + 124 * 45);
    for line in grid.lines().skip(1).step_by(97) {
        let normal: Vec<f64> = line.split(',').skip(7).take(3).map(|cell| cell.parse().expect("a number")).collect();
        assert!((normal.iter().map(|n| n * n).sum::<f64>() - 1.0).abs() < 1e-12, "{line}");
    }
}

#[test]
fn check_says_what_a_bevel_engineer_asks() {
    let outcome = check_as_it_is("scenes/bevel/five_linkage_printed.toml").done().says(&[
        "Spiral bevel gear, 62 teeth, outer module 4.16899 mm",
        "pitch 77.5833, face 78.4333, root 75.4333 deg",
        "concave, cut by outside blades, spiral angle 34.845 deg",
        "convex, cut by inside blades, spiral angle 35.141 deg",
        "95.2502 mm, inferred from the settings",
        "0.7464 mm short of the blank's roots",
    ]);
    assert!(outcome.err.contains("slots come out 0.7464 mm too shallow"), "{}", outcome.err);
}
