//! Points of flanks with their normals.

use super::{TOLERANCE_MM, export, from_path_mm, polyline};
use crate::fixtures::command::gearcut;
use glam::DVec2;
use std::path::Path;

/// Columns of a table of points, by name.
pub(super) fn table(path: &Path) -> Vec<std::collections::HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).expect("CSV");
    let heads = reader.headers().expect("heads").clone();
    let row =
        |row: csv::StringRecord| heads.iter().zip(row.iter()).map(|(h, c)| (h.to_owned(), c.to_owned())).collect();
    reader.records().map(|record| row(record.expect("a row"))).collect()
}

/// Normals of an involute touch its base circle, and its points lie on the drawing; as cut, the deviation is how far
/// the point stands off along that normal, and `gearcut diagnose` reads the table.
#[test]
fn points_lie_on_the_flanks_with_their_normals() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let scene = "scenes/shaping/circular_m3_z24.toml";
    let path = |name: &str| folder.path().join(name);
    let write = |name: &str, more: &[&str]| {
        let file = path(name);
        let file = file.to_str().expect("UTF-8");
        gearcut(&[&["export", scene, "--quiet", "--points", file, "--teeth", "2..3"], more].concat()).done();
        table(&path(name))
    };
    let (_, drawn) = polyline(&export(scene, &["--teeth", "2..3"]), "TARGET");
    let base_mm = 36.0 * 20_f64.to_radians().cos();
    let rows = write("nominal.csv", &[]);
    assert_eq!(rows.len(), 2 * 2 * 9 * 5);
    let number =
        |row: &std::collections::HashMap<String, String>, name: &str| row[name].parse::<f64>().expect("a number");
    for row in &rows {
        let [x, y, nx, ny] = ["x_mm", "y_mm", "nx", "ny"].map(|name| number(row, name));
        assert!((DVec2::new(x, y).perp_dot(DVec2::new(nx, ny)).abs() - base_mm).abs() < 1e-6, "{row:?}");
        assert!((nx.hypot(ny) - 1.0).abs() < 1e-8 && number(row, "nz") == 0.0);
        assert!(from_path_mm(&drawn, DVec2::new(x, y)) <= TOLERANCE_MM, "{row:?}");
        assert!(number(row, "z_mm").abs() <= 0.4 * 20.0 + 1e-9);
    }
    let cut = write("cut.csv", &["--as-cut", "--grid", "40x1"]);
    let mut largest_um = 0.0_f64;
    for row in &cut {
        let [x, y, nx, ny, um] = ["x_mm", "y_mm", "nx", "ny", "deviation_um"].map(|name| number(row, name));
        let foot = DVec2::new(x, y) - 1e-3 * um * DVec2::new(nx, ny);
        assert!(
            (foot.perp_dot(DVec2::new(nx, ny)).abs() - base_mm).abs() < 1e-6 && from_path_mm(&drawn, foot) <= 1.1e-3
        );
        largest_um = largest_um.max(um);
    }
    assert!(cut.len() == 160 && largest_um > 0.01, "{largest_um} um of marks");
    let read = gearcut::influence::measured::read_charts(&path("cut.csv")).expect("places that diagnose reads");
    assert_eq!(read.len(), 160);
    // A bevel gear has points, too.
    let file = path("bevel.csv");
    let file = file.to_str().expect("UTF-8");
    gearcut(&["export", "scenes/bevel/crown_gear.toml", "--points", file, "--teeth", "1", "--units", "inch"]).done();
    assert!(std::fs::read_to_string(path("bevel.csv")).expect("written").starts_with("tooth,flank,u_in,v_in,x_in"));
}
