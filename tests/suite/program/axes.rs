//! `gearcut axes`: tables, charts, peaks; folders that are not its own.

use std::path::Path;

use crate::fixtures::command::{gearcut, gearcut_in};

const PAPER: &str = "scenes/shaping/elliptical_normal.toml";

/// Rows of a CSV file, the header apart.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut reader = csv::Reader::from_path(path).expect("the table was written");
    let header = reader.headers().expect("a header").iter().map(str::to_owned).collect();
    let number = |cell: &str| cell.parse().expect("all cells are numbers");
    let rows = reader.records().map(|row| row.expect("a row").iter().map(number).collect()).collect();
    (header, rows)
}

#[test]
fn the_papers_axes_are_written() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let out = folder.path().join("axes_of_paper");
    let text = out.display().to_string();
    let outcome = gearcut(&["axes", PAPER, "--out", &text]).done().says(&[
        "Operation rough: normal linkage, 2 mm short of full depth",
        "Operation finish: normal linkage, at full depth",
        "14.95 deg",
        "26 % of a circular gear's",
        "1.321 deg/s",
    ]);
    assert!(outcome.err.contains("26 % of what a circular gear gets"), "{}", outcome.err);
    for operation in ["rough", "finish"] {
        let (header, rows) = table(&out.join(format!("axes/{operation}.csv")));
        let begin = ["stroke", "time_s", "psi_c_deg", "psi_b_deg", "center_distance_mm", "offset_mm", "phi_deg"];
        assert_eq!(header[..7], begin);
        assert_eq!((header.len(), rows.len()), (16, 4200));
        let end = ["left_relief_share_of_circular", "right_relief_share_of_circular", "normal_to_line_of_centres_deg"];
        assert_eq!(header[13..], end);
        for chart in ["positions", "velocities", "accelerations", "relief"] {
            let path = out.join(format!("axes/{operation}_{chart}.svg"));
            let text = std::fs::read_to_string(&path).expect("a chart");
            assert!(text.contains("work angle ψc [°]"), "{operation} {chart}");
        }
    }
    let (_, rows) = table(&out.join("axes/finish.csv"));
    // Half a period: the flattest place, cutter and work at multiples of their closed turn.
    let half = &rows[700];
    assert!((half[2] - 60.0).abs() < 1e-9 && (half[6] - 60.0).abs() < 1e-6, "{half:?}");
    assert!((half[3] - 126.0).abs() < 1e-4 && half[5] == 0.0, "{half:?}");
    assert!((half[13] - 1.0).abs() < 1e-6 && (half[14] - 1.0).abs() < 1e-6, "relief at beta = 0: {half:?}");
    let smallest = rows.iter().flat_map(|row| [row[13], row[14]]).fold(f64::INFINITY, f64::min);
    assert!((smallest - 0.258).abs() < 1e-3, "{smallest}");
}

#[test]
fn its_own_folder_is_replaced_and_no_other() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/shaping/circular_m3_z24.toml");
    let scene = scene.display().to_string();
    for _ in 0..2 {
        gearcut_in(folder.path(), &["axes", &scene]).done();
    }
    assert!(folder.path().join("out/circular_m3_z24_axes/axes/finish.csv").is_file());

    let run = folder.path().join("out/circular_m3_z24");
    std::fs::create_dir_all(&run).expect("a folder in the test's folder");
    std::fs::write(run.join("run.json"), r#"{"program": "gearcut"}"#).expect("a file in the test's folder");
    gearcut_in(folder.path(), &["axes", &scene, "--out", "out/circular_m3_z24"]).failed(1, &["gearcut cut", "--out"]);
    assert!(run.join("run.json").is_file());

    let foreign = folder.path().join("photos");
    std::fs::create_dir(&foreign).expect("a folder in the test's folder");
    std::fs::write(foreign.join("cat.txt"), "miaow").expect("a file in the test's folder");
    gearcut_in(folder.path(), &["axes", &scene, "--out", "photos"]).failed(1, &["not written by gearcut"]);
    assert_eq!(std::fs::read_to_string(foreign.join("cat.txt")).expect("untouched"), "miaow");
}
