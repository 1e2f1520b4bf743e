//! Rings that cannot be cut, and the exact words they are refused with: file, line, key, value, limit, way out.

use gearcut::error::Error;
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use std::path::Path;

/// A round ring of module 2 with lines of its own under `[gear]` and behind it.
fn scene(teeth: u32, gear: &str, rest: &str) -> String {
    format!("[gear]\nkind = \"internal\"\nmodule_mm = 2.0\nteeth = {teeth}\n{gear}{rest}")
}

/// What preparing a scene is refused with; the file's name is replaced by `ring.toml`.
fn refusal(text: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("ring.toml");
    std::fs::write(&path, text).expect("write the scene");
    let loaded = load(&path, &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let Err(Error::Refused(refusal)) = ShapingJob::new(loaded.scene.clone()) else { panic!("it is cut: {text}") };
    let shown = path.to_str().expect("UTF-8").to_owned();
    loaded.explain(&refusal).to_string().replace(&shown, "ring.toml")
}

#[test]
fn a_cutter_too_large_for_the_curve() {
    let oval = "[gear.pitch_curve.ellipse]\norder = 2\neccentricity = 0.2\n";
    let found = refusal(&scene(60, oval, "[tool.shaper_cutter]\nteeth = 38\n"));
    assert_eq!(
        found,
        "error: ring.toml:9:9: `tool.shaper_cutter.teeth` = 38: at polar angle -0.134 deg the pitch curve has the \
        radius of curvature 35.314 mm; the cutter's pitch radius with the offset, 38.000 mm, does not roll there\n  \
        9 | teeth = 38\n    |         ^^\n  way out: take a cutter with fewer teeth, a smaller offset, or a pitch \
        curve with more room inside"
    );
    // As large as the ring, and larger: not taken for a cutter beyond the axis.
    for teeth in [60, 80] {
        let found = refusal(&scene(60, "", &format!("[tool.shaper_cutter]\nteeth = {teeth}\n")));
        assert!(found.contains("does not roll there"), "{found}");
    }
}

#[test]
fn a_rim_thinner_than_the_teeth() {
    let found = refusal(&scene(60, "rim_mm = 2.0\n", "[tool.shaper_cutter]\nteeth = 20\n"));
    assert_eq!(
        found,
        "error: ring.toml:5:10: `gear.rim_mm` = 2.0: the rim of 2 mm is thinner than the teeth are deep: the cutter \
        reaches 62.500 mm from the gear axis, the ring 62.000 mm\n  5 | rim_mm = 2.0\n    |          ^^^\n  way out: \
        make it thicker than 2.500 mm; 5 modules are usual"
    );
}

#[test]
fn a_curve_that_does_not_close() {
    let open = "[gear.pitch_curve.ellipse]\norder = 2\neccentricity = 0.1\nsemi_major_axis_mm = 61.0\n";
    let found = refusal(&scene(60, open, "[tool.shaper_cutter]\nteeth = 20\n"));
    assert!(
        found.starts_with("error: ring.toml:8:22: `gear.pitch_curve.ellipse.semi_major_axis_mm` = 61.0: the perimeter")
    );
    assert!(found.ends_with("mm; leave it out and it is solved"), "{found}");
    // A mate whose driver looks different after a turn of the ring.
    let mate = "[gear.pitch_curve.mate]\ndriver_teeth = 40\n[gear.pitch_curve.mate.driver.sinusoidal_ratio]\n\
        order = 1\nmean_ratio = 1.0\nratio_amplitude = 0.3\n";
    let found = refusal(&scene(102, mate, "[tool.shaper_cutter]\nteeth = 20\n"));
    assert_eq!(
        found,
        "error: ring.toml:6:16: `gear.pitch_curve.mate.driver_teeth` = 40: one turn of the mate is 2.550000 turns of \
        its driver, after which the driver looks different: the mate's curve does not close\n  \
        6 | driver_teeth = 40\n    |                ^^\n  way out: choose tooth numbers whose quotient is a whole \
        number of the driver's repeats in one turn"
    );
}

#[test]
fn tips_that_cross_where_the_curve_is_sharp() {
    let oval = "addendum_coefficient = 2.0\n[gear.pitch_curve.ellipse]\norder = 2\neccentricity = 0.9\n";
    let found = refusal(&scene(12, oval, "[tool.shaper_cutter]\nteeth = 12\n"));
    assert!(found.starts_with("error: ring.toml:5:24: `gear.addendum_coefficient` = 2.0: the blank's outline, 4 mm"));
    assert!(found.contains("inside the pitch curve, crosses itself where the curve has the radius"), "{found}");
}

#[test]
fn the_shipped_rings_are_not_refused() {
    for name in ["internal_circle", "internal_ellipse", "internal_pair_ring", "internal_pair_driver"] {
        let path = format!("scenes/shaping/{name}.toml");
        let loaded = load(Path::new(&path), &[]).unwrap_or_else(|errors| panic!("{errors}"));
        ShapingJob::new(loaded.scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}
