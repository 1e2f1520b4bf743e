//! A measured surface over the window that was cut: key `measured` of `[[texture]]`.
//!
//! With `GEARCUT_KEEP=folder` the page is kept there for a look.

use crate::fixtures::command::{Outcome, gearcut_in};
use gearcut::measure::topography::Surface;
use gearcut::output::surface_files::{Format, SurfaceFile, read_surface, write_surface};
use serde_json::Value;
use std::path::Path;

const SCENE: &str = "tests/browser/scene.toml";
const STEM: &str = "texture/finish/tooth_03_left";

fn cut(folder: &Path, settings: &[&str], out: &str) -> Outcome {
    let settings = settings.iter().flat_map(|setting| ["--set", setting]).collect::<Vec<_>>();
    let arguments = ["cut", "scene.toml", "--backend", "cpu", "--only", "texture,report", "--out", out];
    gearcut_in(folder, &[&arguments[..], &settings].concat())
}

/// The window's own heights as another instrument would give them: a tenth higher, lifted and tilted. Marks that all
/// look alike hold no part of themselves in its place, so it is the whole window.
#[test]
fn a_measured_surface_is_laid_over_its_window() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let at = |name: &str| folder.path().join(name);
    std::fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join(SCENE), at("scene.toml")).expect("copied");
    cut(folder.path(), &[], "cut").done();
    let own = read_surface(&at(&format!("cut/{STEM}.x3p")), None).expect("a window").surface;
    let (nx, ny) = (own.nx(), own.ny());
    let height = |i: usize| {
        let (x, y) = (i % nx, i / nx);
        1.1 * own.row(y)[x] + 3.0 + 0.004 * x as f64 - 0.002 * y as f64
    };
    let measured = Surface::new(nx, ny, own.dx_um(), own.dy_um(), (0..nx * ny).map(height).collect()).expect("a copy");
    let write = |name: &str, surface: Surface| {
        write_surface(&at(name), Format::X3p, &SurfaceFile { surface, notes: Vec::new() }).expect("written");
    };
    write("flank.x3p", measured);
    cut(folder.path(), &["texture.0.measured=flank.x3p"], "laid").done();
    let results: Value = serde_json::from_slice(&std::fs::read(at("laid/results.json")).expect("there")).expect("JSON");
    let found = &results["sections"]["texture"]["finish"]["tooth_03_left"]["measured"];
    let number = |key: &str| found[key]["value"].as_f64().unwrap_or_else(|| panic!("{key}: {found}"));
    assert!(number("correlation") > 0.9999, "{found}");
    for (key, step_um) in [("shift_x", own.dx_um()), ("shift_y", own.dy_um())] {
        assert!(number(key).abs() < 0.1 * step_um, "{key}: {}", number(key));
    }
    // A tenth more height is a tenth more of everything that is measured in um.
    let rows = found["parameters"]["rows"].as_array().expect("rows");
    for symbol in ["Sa", "Sq", "Sk"] {
        let row = rows.iter().find(|row| row[0] == symbol).unwrap_or_else(|| panic!("{symbol}"));
        let [cut, measured, difference] = [2, 3, 4].map(|k| row[k].as_f64().expect("a number"));
        assert!((measured / cut - 1.1).abs() < 1e-3, "{row}");
        assert!((difference - (measured - cut)).abs() < 1e-12, "{row}");
    }
    for name in ["first.png", "second.png", "difference.png", "difference.x3p"] {
        assert!(at(&format!("laid/{STEM}_{name}")).exists(), "{name}");
    }
    let page = std::fs::read_to_string(at("laid/report.html")).expect("a page");
    for words in ["Measured over cut: tooth 3 left", "Measured less cut, levelled", "How the measured surface lies"] {
        assert!(page.contains(words), "{words}");
    }
    // The inspector's sheet has Ra and Rz of the finished window. Marks hardly lean: lines along them are smooth.
    let sheet = std::fs::read_to_string(at("laid/inspection.svg")).expect("a sheet");
    let lines = &results["sections"]["roughness"]["finish"]["tooth_03_left_along_profile"];
    let largest = lines["Ra_largest"]["value"].as_f64().expect("um");
    for words in ["Ra profile", &format!("{largest:.4}"), "Ra tooth", "&lt; 0.001", "cut-off 0.0800, 0.250 mm"] {
        assert!(sheet.contains(words), "{words}");
    }
    if let Some(kept) = std::env::var_os("GEARCUT_KEEP") {
        std::fs::copy(at("laid/report.html"), Path::new(&kept).join("measured.html")).expect("kept");
    }
    // Another surface: it is shown, and doubted.
    let strange = |i: usize| ((i * i % 977) as f64 * 0.37).sin();
    write("strange.x3p", Surface::new(100, 120, 20.0, 10.0, (0..12_000).map(strange).collect()).expect("a surface"));
    cut(folder.path(), &["texture.0.measured=strange.x3p"], "strange").done();
    let results = std::fs::read(at("strange/results.json")).expect("there");
    let results: Value = serde_json::from_slice(&results).expect("JSON");
    let doubted = |warning: &Value| {
        warning["section"] == "texture.finish.tooth_03_left.measured"
            && warning["text"].as_str().is_some_and(|text| text.contains("surfaces of one place?"))
    };
    assert!(results["warnings"].as_array().expect("a list").iter().any(doubted), "{}", results["warnings"]);
}

/// What is wrong with the file is said before anything is cut, by `check` as well.
#[test]
fn a_bad_measured_surface_is_refused_before_the_cut() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let at = |name: &str| folder.path().join(name);
    std::fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join(SCENE), at("scene.toml")).expect("copied");
    std::fs::write(at("words.txt"), "no heights here\n").expect("written");
    std::fs::write(at("zygo.dat"), b"\x88\x1b\x03\x6f\0\0").expect("written");
    let own = "# gearcut surface: heights in um\n# dx_um = 1\n# dy_um = 1\n1,2,3\n4,5,7\n";
    std::fs::write(at("flank.csv"), own).expect("written");
    for (settings, words) in [
        (&["texture.0.measured=gone.x3p"][..], "gone.x3p"),
        (&["texture.0.measured=words.txt"], "no row of numbers"),
        (&["texture.0.measured=zygo.dat"], "a Zygo MetroPro file (DAT), which is not read"),
        (&["texture.0.measured=flank.csv", "texture.0.side=both"], "write side = \"left\""),
    ] {
        cut(folder.path(), settings, "out").failed(1, &["texture", "measured", words]);
        assert!(!at("out").exists(), "something was cut");
        let settings = settings.iter().flat_map(|setting| ["--set", setting]).collect::<Vec<_>>();
        gearcut_in(folder.path(), &[&["check", "scene.toml"], &settings[..]].concat()).failed(1, &[words]);
    }
}
