//! Scenes of mates: they read back, close, and say what their driver says.

use crate::fixtures::command::gearcut;
use gearcut::gear::{GearKind, PitchCurve, PitchCurveShape};
use gearcut::process;
use gearcut::process::shaping::scene::model::{Feed, Shaping};
use gearcut::scene::{LoadedScene, Mate, Scene};
use gearcut::terms::Hand;
use std::path::Path;

fn driver(name: &str, settings: &[&str]) -> LoadedScene {
    let settings: Vec<String> = settings.iter().map(|&s| s.to_owned()).collect();
    process::load(Path::new(&format!("scenes/{name}.toml")), &settings).expect("a scene")
}

/// The mate's scene, read back in another folder than the driver's, and the distance of the axes, mm.
fn mate(driver: &LoadedScene, teeth: u32, kind: GearKind) -> (Scene, f64) {
    let mate = driver.mate(Mate { teeth, kind }, Path::new("/")).expect("a mate");
    let read = process::parse(&mate.text, "mate.toml", Path::new("/"), &[]);
    (read.unwrap_or_else(|errors| panic!("{errors}\n{}", mate.text)).scene, mate.center_distance_mm)
}

/// The gap after the last tooth, mm.
fn gap_mm(scene: &Scene) -> f64 {
    let module_mm = scene.gear.transverse_module_mm();
    let curve = PitchCurve::new(&scene.gear.pitch_curve, module_mm, scene.gear.teeth).expect("a curve");
    curve.closure_error_mm()
}

/// The mate closes on its teeth as well as its driver does: a driver of a written size leaves a gap, and its mate the
/// same for every turn of the driver.
fn closes(mate: &Scene, driver: &Scene) {
    let turns = f64::from(mate.gear.teeth) / f64::from(driver.gear.teeth);
    assert!((gap_mm(mate) - turns * gap_mm(driver)).abs() < 1e-9, "{} after {}", gap_mm(mate), gap_mm(driver));
}

#[test]
fn round_gears_mate_at_half_the_sum_or_difference_of_their_diameters() {
    let driver = driver("shaping/circular_m3_z24", &["measure.iso_1328_class=5", "measure.ball_diameter_mm=5"]);
    for (teeth, kind, sign) in [(31, GearKind::External, 1.0), (90, GearKind::Internal, -1.0)] {
        let (scene, distance_mm) = mate(&driver, teeth, kind);
        assert!((distance_mm - 1.5 * (f64::from(teeth) + sign * 24.0)).abs() < 1e-9, "{distance_mm}");
        assert_eq!((scene.gear.teeth, scene.gear.kind, scene.gear.module_mm), (teeth, kind, 3.0));
        // Balls fit the driver's spaces.
        assert_eq!((scene.measure.iso_1328_class, scene.measure.ball_diameter_mm), (Some(5), None));
        closes(&scene, &driver.scene);
    }
}

/// The distance of the axes is that of the closing constants of the literature's pair: a = 67.364980175 mm.
#[test]
fn the_pair_of_the_literature_is_the_shipped_ring() {
    let pinion = driver("shaping/internal_pair_driver", &[]);
    let (scene, distance_mm) = mate(&pinion, 102, GearKind::Internal);
    assert!((distance_mm - 67.364_980_175).abs() < 1e-8, "{distance_mm}");
    let ring = driver("shaping/internal_pair_ring", &[]).scene;
    let shape =
        |scene: &Scene| (scene.gear.kind, scene.gear.module_mm, scene.gear.teeth, scene.gear.pitch_curve.clone());
    assert_eq!(shape(&scene), shape(&ring));
    let strokes = |scene: &Scene| -> Vec<_> {
        Shaping::of(scene)
            .expect("shaping")
            .operations
            .iter()
            .map(|operation| (operation.name.clone(), operation.feed))
            .collect()
    };
    assert_eq!(strokes(&scene), strokes(&ring));
    closes(&scene, &pinion.scene);
}

#[test]
fn every_driver_of_the_scenes_has_a_mate_that_closes() {
    let scenes =
        std::fs::read_dir("scenes/shaping").expect("scenes").chain(std::fs::read_dir("scenes/hobbing").unwrap());
    let mut mated = 0;
    for path in scenes.map(|entry| entry.expect("an entry").path()) {
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let driver = process::load(&path, &[]).expect("a scene");
        let gear = &driver.scene.gear;
        let has_none = matches!(gear.pitch_curve, PitchCurveShape::Mate { .. } | PitchCurveShape::Sector { .. });
        if gear.kind == GearKind::Internal || has_none {
            continue;
        }
        let (scene, _) = mate(&driver, gear.teeth, GearKind::External);
        closes(&scene, &driver.scene);
        assert!(scene.process.files_read().iter().all(|file| file.is_file()), "{:?}", scene.process.files_read());
        assert_eq!(scene.process.operation_names(), driver.scene.process.operation_names());
        mated += 1;
    }
    assert!(mated >= 10, "{mated}");
}

#[test]
fn a_helix_changes_its_hand_outside_and_keeps_it_inside() {
    let driver = driver("hobbing/circular_helical", &[]);
    let opposite = if driver.scene.gear.hand == Hand::Left { Hand::Right } else { Hand::Left };
    let teeth = driver.scene.gear.teeth;
    let (scene, _) = mate(&driver, teeth, GearKind::External);
    assert_eq!((scene.gear.hand, scene.gear.helix_angle_rad), (opposite, driver.scene.gear.helix_angle_rad));
    // No hob reaches into a ring: the scene is written, and its reader refuses it.
    let ring = driver.mate(Mate { teeth: 3 * teeth, kind: GearKind::Internal }, Path::new("/")).expect("a mate");
    assert!(
        process::parse(&ring.text, "mate.toml", Path::new("/"), &[]).unwrap_err().to_string().contains("a hob cuts")
    );
    let hand = if driver.scene.gear.hand == Hand::Left { "left" } else { "right" };
    assert!(ring.text.contains(&format!("hand = \"{hand}\"")), "{}", ring.text);
}

/// Operations that the driver's file does not list: the mate's process has its own, or those of the driver as set.
#[test]
fn operations_that_nobody_wrote_pass_to_the_mate() {
    let text = "[gear]\nmodule_mm = 3.0\nteeth = 24\n[tool.shaper_cutter]\nteeth = 20\n";
    for settings in [&[][..], &["operation.finish.strokes_per_revolution=2424".to_owned()]] {
        let driver = process::parse(text, "driver.toml", Path::new(""), settings).expect("a scene");
        let (scene, _) = mate(&driver, 48, GearKind::External);
        let [rough, finish] = Shaping::of(&scene).expect("shaping").operations.as_slice() else { panic!("two") };
        let of_driver = &Shaping::of(&driver.scene).expect("shaping").operations;
        for (operation, driver) in [rough, finish].into_iter().zip(of_driver) {
            assert_eq!(operation.name, driver.name);
            if settings.is_empty() {
                // A mate's curve is no circle by its name: its stock is left by the law of a rack.
                let stock_mm = if driver.name == "rough" { 0.2 } else { 0.0 };
                assert!((operation.offset_mm - stock_mm / 20_f64.to_radians().sin()).abs() < 1e-12, "{operation:?}");
            } else {
                let what = (operation.offset_mm, operation.infeed, operation.overlap_rad);
                assert_eq!(what, (driver.offset_mm, driver.infeed, driver.overlap_rad));
            }
        }
        let strokes = if settings.is_empty() { 4800 } else { 4848 };
        assert_eq!([rough.feed, finish.feed], [960, strokes].map(Feed::StrokesPerRevolution));
    }
}

#[test]
fn places_on_the_driver_stay_there() {
    let driver = driver(
        "shaping/order_1",
        &[
            "operation.finish.window_deg=[0.0, 40.0]",
            "output.folder='out/driver'",
            "mounting.eccentricity_um=12",
            "gear.addendum_coefficient=0.9",
        ],
    );
    let text = driver.mate(Mate { teeth: 36, kind: GearKind::External }, Path::new("/")).expect("a mate").text;
    for left_out in ["window_deg", "folder", "[[picture]]", "[[texture]]", "[mounting]"] {
        assert!(!text.contains(left_out), "{text}");
    }
    assert!(text.contains("addendum_coefficient = 0.9") && text.contains("bore_diameter_mm = 16.0"), "{text}");
}

#[test]
fn gears_without_a_mate_are_refused_with_a_way_out() {
    let scene = "scenes/shaping/elliptical_normal.toml";
    gearcut(&["mate", scene, "--teeth", "40"]).failed(1, &["no external mate with 40 teeth", "way out:"]);
    gearcut(&["mate", scene, "--teeth", "42", "--internal"]).failed(1, &["no internal mate", "fewer teeth"]);
    gearcut(&["mate", "scenes/shaping/internal_circle.toml", "--teeth", "200"]).failed(1, &["internal", "way out:"]);
    gearcut(&["mate", "scenes/shaping/internal_pair_ring.toml", "--teeth", "34"]).failed(1, &["way out:"]);
    gearcut(&["mate", scene]).failed(2, &["--teeth"]);
}

#[test]
fn the_command_writes_a_scene_that_can_be_checked_and_replaces_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("ring.toml");
    let path = path.to_str().expect("a path");
    let driver = "scenes/shaping/circular_m3_z24.toml";
    let arguments = ["mate", driver, "--teeth", "90", "--internal", "--out", path];
    gearcut(&arguments).done().says(&["distance of the axes 99.000000 mm", "gearcut check"]);
    let text = std::fs::read_to_string(path).expect("written");
    process::prepare(&process::parse(&text, path, Path::new("/"), &[]).expect("a scene").scene).expect("it can be cut");
    gearcut(&arguments).failed(1, &["the file exists"]);
    // Files beside the driver are found from the mate's folder.
    let path = folder.path().join("cycloid.toml");
    let arguments = ["mate", "scenes/shaping/cycloid.toml", "--teeth", "18", "--out"];
    gearcut(&[&arguments[..], &[path.to_str().expect("a path")]].concat()).done();
    let scene = process::load(&path, &[]).expect("a scene").scene;
    assert_eq!(scene.process.files_read().len(), 1);
    process::prepare(&scene).expect("its cutter's contour is found");
}

/// Unequal lobes: a driver of two lobes on 24 teeth, given by a formula, runs with a mate of three lobes on 36:
/// r_1 + r_2 = C at equal arcs.
#[test]
fn two_lobes_run_with_three() {
    let text = "[gear]\nmodule_mm = 3.0\nteeth = 24\nface_width_mm = 20.0\n[gear.pitch_curve.radius_formula]\n\
        radius = \"1/(2.5 + 0.1*sin(2*phi))\"\n[tool.shaper_cutter]\nteeth = 20\n";
    let driver = process::parse(text, "driver.toml", Path::new("/"), &[]).expect("a driver");
    let (scene, center_distance_mm) = mate(&driver, 36, GearKind::External);
    closes(&scene, &driver.scene);
    let curve = |scene: &Scene| {
        PitchCurve::new(&scene.gear.pitch_curve, scene.gear.module_mm, scene.gear.teeth).expect("a curve")
    };
    let (own, its) = (curve(&driver.scene), curve(&scene));
    assert!(its.repeats_after(std::f64::consts::TAU / 3.0) && !its.repeats_after(std::f64::consts::PI));
    // Equal arcs from where both meet: the middle of the driver's first tooth, and the mate's space at 0, turning back.
    let pitch_mm = 3.0 * std::f64::consts::PI;
    for i in 0..40 {
        let arc_mm = 2.9 * f64::from(i);
        let [r_1, r_2] = [(&own, 0.5 * pitch_mm + arc_mm), (&its, -arc_mm)]
            .map(|(curve, arc_mm)| curve.radius(curve.phi_at_arc(arc_mm)).value());
        assert!((r_1 + r_2 - center_distance_mm).abs() < 1e-6, "{r_1} + {r_2} not {center_distance_mm}");
    }
    // A driver whose lobes do not stand in the ratio of the teeth has no such mate.
    let refusal =
        driver.mate(Mate { teeth: 30, kind: GearKind::External }, Path::new("/")).expect_err("two lobes and a half");
    assert!(refusal.problem.contains("looks different"), "{}", refusal.problem);
}
