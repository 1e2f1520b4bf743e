//! `gearcut deviations`: measured points on a target.

use super::points::table;
use crate::fixtures::command::{Outcome, gearcut, read_json};
use glam::DVec2;
use std::collections::HashMap;
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const ROUND: &str = "scenes/shaping/circular_m3_z24.toml";

struct Room(tempfile::TempDir);

impl Room {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder for the test"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn run(&self, scene: &str, measured: &Path, more: &[&str]) -> Outcome {
        let [out, measured] = [self.path("out"), measured.to_owned()].map(|path| path.display().to_string());
        gearcut(&[&["deviations", scene, "--quiet", "--measured", &measured, "--out", &out], more].concat())
    }

    fn rows(&self) -> Vec<HashMap<String, String>> {
        table(&self.path("out/tables/deviations.csv"))
    }

    /// A number of `results.json` by its key.
    fn value(&self, key: &str) -> f64 {
        let results = read_json(&self.path("out/results.json"));
        let of = |part: &serde_json::Value| part[key]["value"].as_f64();
        of(&results["headline"])
            .or_else(|| of(&results["sections"]["deviations"]))
            .unwrap_or_else(|| panic!("no {key} in {}", results["sections"]["deviations"]["$title"]))
    }
}

fn number(row: &HashMap<String, String>, name: &str) -> f64 {
    row[name].parse().unwrap_or_else(|_| panic!("{name} of {row:?}"))
}

/// Points of an involute gear of module 3 mm and 24 teeth in closed form, `um` outside of the nominal flanks, the gear
/// turned and shifted. The normal of an involute at roll angle xi touches the base circle, xi r_b away from the point.
fn involute_csv(um: f64, turn_rad: f64, shift_mm: DVec2) -> String {
    let alpha = 20_f64.to_radians();
    let base_mm = 36.0 * alpha.cos();
    // Half a tooth on the base circle; the first tooth is half a pitch from the x axis.
    let half_rad = PI / 48.0 + alpha.tan() - alpha;
    let mut text = "x_mm,y_mm,z_mm\n".to_owned();
    for tooth in 0..24 {
        for sign in [1.0, -1.0] {
            for step in 0..9 {
                let roll_rad = 0.30 + 0.02 * f64::from(step);
                let middle_rad = (f64::from(tooth) + 0.5) * PI / 12.0 + turn_rad;
                let touched = DVec2::from_angle(middle_rad + sign * (half_rad - roll_rad));
                let at = base_mm * touched + sign * (base_mm * roll_rad + 1e-3 * um) * touched.perp() + shift_mm;
                let _ = writeln!(text, "{},{},{}", at.x, at.y, 0.5 * f64::from(step) - 2.0);
            }
        }
    }
    text
}

/// Teeth that are 5 um thick on either side, turned and off centre: the closed form's deviations, turn and shift come
/// back. Where the shift is not free, an eccentricity stays in the deviations; a probe's ball is taken off.
#[test]
fn an_involute_gear_gives_its_deviations() {
    let room = Room::new();
    let (turn_rad, shift_mm) = (0.01_f64, DVec2::new(0.03, -0.02));
    let write = |name: &str, text: &str| {
        std::fs::write(room.path(name), text).expect("written");
        room.path(name)
    };
    let points = write("thick.csv", &involute_csv(5.0, turn_rad, shift_mm));
    room.run(ROUND, &points, &["--fit", "centre"]).done();
    let rows = room.rows();
    assert_eq!(rows.len(), 24 * 2 * 9);
    for row in &rows {
        assert!((number(row, "deviation_um") - 5.0).abs() < 1e-4, "{row:?}");
    }
    let moved_um = -1e3 * DVec2::from_angle(-turn_rad).rotate(shift_mm);
    for (key, value) in [("turn", -turn_rad.to_degrees()), ("shift_x", moved_um.x), ("shift_y", moved_um.y)] {
        assert!((room.value(key) - value).abs() < 1e-4, "{key} is {}, not {value}", room.value(key));
    }
    room.run(ROUND, &points, &["--fit", "turn"]).done();
    assert!((room.value("highest") - room.value("deepest") - 2e3 * shift_mm.length()).abs() < 3.0, "runs out");

    // Balls smaller and larger than half a module; the larger ones' centres lie near the other flank of the space.
    for (radius, um) in [("1", 1005.0), ("2", 2005.0)] {
        let centres = write("centres.csv", &involute_csv(um, 0.01, DVec2::ZERO));
        room.run(ROUND, &centres, &["--probe-radius-mm", radius]).done();
        assert!(room.rows().iter().all(|row| (number(row, "deviation_um") - 5.0).abs() < 1e-4), "ball of {radius} mm");
        assert_eq!(room.value("on_flanks"), 432.0);
    }
}

/// Tooth 5 left, counted as here, is 10 um high. Files that count teeth clockwise, or call the other flank left, do not
/// pass for measured gears; without their names the tooth is found.
#[test]
fn files_that_count_otherwise_are_contradicted() {
    let room = Room::new();
    let named = |tooth_of: &dyn Fn(usize) -> usize, sides: [&str; 2]| {
        let plain = involute_csv(0.0, 0.0, DVec2::ZERO);
        let high = involute_csv(10.0, 0.0, DVec2::ZERO);
        let mut text = "tooth,flank,x_mm,y_mm,z_mm\n".to_owned();
        for (index, (plain, high)) in plain.lines().zip(high.lines()).skip(1).enumerate() {
            let (tooth, side) = (index / 18 + 1, index / 9 % 2);
            let place = if (tooth, side) == (5, 0) { high } else { plain };
            let _ = writeln!(text, "{},{},{place}", tooth_of(tooth), sides[side]);
        }
        std::fs::write(room.path("named.csv"), text).expect("written");
        room.path("named.csv")
    };
    let sides = ["left", "right"];
    room.run(ROUND, &named(&|tooth| tooth, sides), &["--fit", "none"]).done();
    assert!((room.value("highest") - 10.0).abs() < 1e-4 && room.value("on_flanks") == 432.0);
    // A gear that was turned by two pitches counts from another tooth: that is no contradiction.
    room.run(ROUND, &named(&|tooth| (tooth + 1) % 24 + 1, sides), &[]).done();
    assert!((room.value("highest") - 10.0).abs() < 0.5 && room.value("on_flanks") == 432.0);
    let clockwise = named(&|tooth| 25 - tooth, sides);
    room.run(ROUND, &clockwise, &[]).failed(3, &["contradict their places", "432 if they may lie on any"]);
    room.run(ROUND, &clockwise, &["--fit", "none"]).failed(1, &["contradict their places", "counter-clockwise"]);
    let swapped = named(&|tooth| tooth, ["right", "left"]);
    room.run(ROUND, &swapped, &[]).failed(3, &["contradict their places"]);
}

/// Points that gearcut writes come back: of a cut gear with its deviations, of helical teeth and of a bevel gear in
/// inches with none, and of a gear that is not round in any place of its turn.
#[test]
fn exported_points_come_back() {
    let room = Room::new();
    let file = room.path("points.csv");
    let write = |scene: &str, more: &[&str]| {
        let file = file.to_str().expect("UTF-8");
        gearcut(&[&["export", scene, "--quiet", "--force", "--points", file], more].concat()).done();
        table(&room.path("points.csv"))
    };
    for (scene, more, fit) in [
        (ROUND, &["--teeth", "2..3", "--grid", "20x1", "--as-cut"][..], "none"),
        ("scenes/hobbing/circular_helical.toml", &["--teeth", "1..2", "--grid", "5x3"], "none"),
        ("scenes/bevel/crown_gear.toml", &["--teeth", "1", "--grid", "4x3", "--units", "inch"], "none"),
        // Fifteen points on each flank, and every fifteenth is compared.
        ("scenes/shaping/internal_circle.toml", &["--grid", "5x3"], "axis"),
    ] {
        let written = write(scene, more);
        room.run(scene, &file, &["--fit", fit]).done();
        let back = room.rows();
        assert_eq!(back.len(), written.len(), "{scene}");
        for (row, own) in back.iter().zip(&written) {
            assert_eq!([&row["tooth"], &row["flank"]], [&own["tooth"], &own["flank"]], "{scene}");
            let unit_mm = if own.contains_key("u_in") { 25.4 } else { 1.0 };
            let [u, v] = if unit_mm == 1.0 { ["u_mm", "v_mm"] } else { ["u_in", "v_in"] };
            let um = own.get("deviation_um").map_or(0.0, |um| um.parse().expect("a number"));
            let off_mm = (number(row, "u_mm") - unit_mm * number(own, u)).abs()
                + (number(row, "v_mm") - unit_mm * number(own, v)).abs();
            assert!(off_mm < 1e-5 && (number(row, "deviation_um") - um).abs() < 1e-3, "{scene}: {row:?}, {own:?}");
        }
    }
    // An ellipse of one lobe, turned by 137 deg: no tooth named.
    let scene = "scenes/shaping/elliptical_normal.toml";
    let mut turned = "x_mm,y_mm,z_mm\n".to_owned();
    for row in write(scene, &["--teeth", "3..9", "--grid", "5x2"]) {
        let at = DVec2::from_angle(137_f64.to_radians()).rotate(DVec2::new(number(&row, "x_mm"), number(&row, "y_mm")));
        let _ = writeln!(turned, "{},{},{}", at.x, at.y, row["z_mm"]);
    }
    let place = room.path("turned.csv");
    std::fs::write(&place, turned).expect("written");
    room.run(scene, &place, &[]).done();
    let lobes_deg = (room.value("turn") + 137.0).rem_euclid(180.0);
    assert!(lobes_deg.min(180.0 - lobes_deg) < 1e-6, "turned by {}", room.value("turn"));
    assert!(room.value("rms") < 1e-3 && room.value("on_flanks") == 140.0);
}

/// A drawing of the cut section is laid on the target within its tolerance; what is not sure is refused with a way out.
#[test]
fn drawings_are_read_and_doubts_refused() {
    let room = Room::new();
    let drawing = room.path("cut.dxf");
    let name = drawing.to_str().expect("UTF-8");
    gearcut(&["export", ROUND, "--quiet", "--dxf", name, "--teeth", "2..4", "--as-cut"]).done();
    room.run(ROUND, &drawing, &[]).failed(1, &["several layers", "PITCH_CURVE", "--layer"]);
    room.run(ROUND, &drawing, &["--layer", "AS_CUT"]).done().says(&["points on flanks", "gearcut diagnose"]);
    // Scallops and the drawing's tolerance.
    assert!(room.value("rms") < 2.0 && room.value("on_flanks") > 30.0, "{} um", room.value("rms"));

    let write = |text: &str| {
        std::fs::write(room.path("wrong.csv"), text).expect("written");
        room.path("wrong.csv")
    };
    room.run(ROUND, &write("x,y,z\n1,2,3\n"), &[]).failed(1, &["unit", "x_mm"]);
    room.run(ROUND, &write("x_mm,y_mm\n1,2\n"), &[]).failed(1, &["no column z_mm"]);
    room.run(ROUND, &write("x_mm,y_mm,z_mm\n36,inf,0\n"), &[]).failed(1, &["line 2", "y_mm"]);
    room.run(ROUND, &write("x_mm,y_mm,z_mm,tooth,flank\n36,1,0,99,left\n"), &[]).failed(1, &["tooth 99", "24"]);
    room.run(ROUND, &write("x_mm,y_mm,z_mm\n1,0,0\n2,0,0\n"), &[]).failed(1, &["of 2 points lie", "unit"]);
    room.run(ROUND, &write("x_mm,y_mm,z_mm\n1,0,0\n"), &["--layer", "A"]).failed(1, &["--layer", "no drawing"]);
    room.run(ROUND, &write("x_mm,y_mm,z_mm\n1,0,0\n"), &["--section-mm", "99"]).failed(1, &["--section-mm", "face"]);
    // The sides of spur teeth do not say where the gear is along its axis.
    let spur = involute_csv(0.0, 0.0, DVec2::ZERO);
    room.run(ROUND, &write(&spur), &["--fit", "body"]).failed(1, &["do not determine", "less to move"]);
}
