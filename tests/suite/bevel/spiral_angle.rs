//! Settings that are computed from blank, spiral angle and cutter radius: their closed form both ways, the settings of
//! published gears, the spiral angle of target and cut, and what is refused.

use super::cases::{blank, close, data, number, settings};
use super::jobs::{job, job_of};
use crate::fixtures::command::{check_as_it_is, gearcut, read_json};
use gearcut::bevel::cradle::CradleSettings;
use gearcut::bevel::inferred::InferredCutter;
use gearcut::cut::cpu::Cpu;
use gearcut::process::bevel::BevelJob;
use gearcut::terms::Side;
use std::path::Path;

const SCENE: &str = "scenes/bevel/spiral_angle.toml";
const SIDES: [Side; 2] = [Side::Left, Side::Right];

/// What the settings say of the cutter is the cutter they were computed for; of both hands, with and without offset.
#[test]
fn computed_settings_say_the_cutter_they_are_for() {
    let file = data("b04_blank");
    let (blank, plain) = (blank(&file), settings(&file));
    for (radius_mm, spiral_deg, offset_mm) in [
        (95.25, 35.0, 0.0),
        (95.25, -35.0, 0.0),
        (76.2, 20.0, -8.0),
        (114.3, -28.0, 5.0),
        (190.5, 50.0, 0.0),
        (95.25, 0.0, 3.0),
    ] {
        let spiral_rad = f64::to_radians(spiral_deg);
        let settings = CradleSettings { blank_offset_mm: offset_mm, ..plain };
        let settings = settings.through_mean_point(&blank, radius_mm, spiral_rad).expect("a place");
        assert_eq!(settings.cradle_angle_rad.signum(), spiral_rad.signum(), "{spiral_deg} deg");
        let said = InferredCutter::new(&settings, &blank);
        close("radius", said.radius_mm, radius_mm, 1e-12 * radius_mm);
        close("spiral angle", said.spiral_angle_rad, spiral_rad.abs(), 1e-12);
        // That of the crown gear, less what an offset takes.
        let along_mm = blank.mean_cone_distance_mm() * blank.dedendum_angle_rad().cos() - offset_mm * spiral_rad.tan();
        let ratio = along_mm / (blank.mean_cone_distance_mm() * blank.pitch_angle_rad.sin());
        close("ratio of roll", said.roll_ratio, ratio, 1e-12);
    }
    let beyond = CradleSettings { blank_offset_mm: 100.0, ..plain };
    let refused = beyond.through_mean_point(&blank, 95.25, 0.6).expect_err("beyond the head").to_string();
    assert!(refused.contains("past the head") && refused.contains("100 mm"), "{refused}");
}

/// The gear of Chen et al. 2008 with a head of 7.5 in and 35 deg. Its angles are printed to a minute of arc: half a
/// minute moves the mean point by 0.5' R_m sin(theta_f) = 0.62 um along the root cone, and S_r and q with it. The paper
/// has no sliding base; the line of its roots misses the pitch apex by 0.7464 mm, which is what it takes (0.1 nm of it
/// by the rounding of the module). The other gear has teeth of one depth: its root cone lies a dedendum of 5 mm inside.
#[test]
fn settings_are_those_of_published_gears() {
    let file = data("b04_blank");
    let printed = settings(&file);
    let of_2008 =
        ["machine.cradle.spiral_angle_deg=35", "tool.face_mill.radius_mm=95.25", "machine.cradle.cross_shift_mm=0"];
    let even = ["machine.cradle.spiral_angle_deg=35"];
    let base_mm = number(&file, "root_plane_offset_from_apex");
    for (found, [radial_mm, cradle_deg, base_mm], tolerance) in [
        (
            job("five_linkage_printed", &of_2008),
            [printed.radial_setting_mm, printed.cradle_angle_rad.to_degrees(), base_mm],
            [0.00067, 0.00034, 1e-7],
        ),
        (
            job_of(Path::new("tests/data/bevel/formate_gear.toml"), &even),
            [70.636849361929, 60.429606775372, 5.0],
            [1e-11, 1e-11, 1e-12],
        ),
    ] {
        let found = found.expect("a gear");
        let of = found.finishing().settings;
        close("radial setting", of.radial_setting_mm, radial_mm, tolerance[0]);
        close("cradle angle", of.cradle_angle_rad.to_degrees(), cradle_deg, tolerance[1]);
        close("sliding base", of.sliding_base_mm, base_mm, tolerance[2]);
        close("depth", found.depth_missed_mm(), 0.0, 1e-12);
    }
}

/// Spiral angle of a cut flank where it crosses the pitch cone in the middle of the face, rad, positive where the tooth
/// turns clockwise towards the heel as seen from the apex, which is right-hand.
fn cut_spiral_rad(job: &BevelJob, tooth: u32, side: Side) -> f64 {
    let target = job.target_of(side);
    let at = |along_mm: f64| {
        let row = target.row(along_mm).expect("a row");
        let arc_mm = target.arc_at(row.pitch_share());
        let rays = job.rays_over(tooth, side, vec![arc_mm], vec![along_mm]).expect("a ray");
        let (layers, _) = job.cut_field(&Cpu::default(), job.space_of(tooth, side), &rays.field).expect("cuts");
        rays.field.ray(0, 0).at(f64::from(layers.last().expect("an operation").heights_mm[0]))
    };
    let [toe, heel] = [-1.0, 1.0].map(at);
    let turn_rad = heel.y.atan2(heel.x) - toe.y.atan2(toe.x);
    let [toe_mm, heel_mm] = [toe, heel].map(|point| point.truncate().length());
    // tan(psi) = r dphi / dR, r = R sin(gamma) in the middle.
    let middle_mm = job.blank.mean_cone_distance_mm() * job.blank.pitch_angle_rad.sin();
    (-middle_mm * turn_rad).atan2((heel_mm - toe_mm) / job.blank.pitch_angle_rad.sin())
}

/// On teeth of one depth the blades' cones meet the pitch plane of the crown gear in circles about the head's axis, of
/// the radius r_c with half the slot's width there more or less. A circle of radius r whose middle lies S_r beside the
/// apex has sin(psi) = (R_m^2 + r^2 - S_r^2) / (2 R_m r) at the mean cone distance. Tapered teeth have the wished angle
/// in the mean of both flanks, but for the square of the slot's width; cut flanks have that of their target, but for
/// marks. Right-hand spirals are positive, and the flanks of a Zerol gear lie to both sides of none.
#[test]
fn the_gear_has_the_spiral_angle() {
    let one_depth = ["face_angle_deg=65.1363", "root_angle_deg=65.1363", "dedendum_mm=5", "addendum_mm=4"];
    for (is_even, wish_deg) in [(true, 35.0), (true, -20.0), (true, 0.0), (false, 35.0), (false, -35.0)] {
        let mut set = vec![format!("machine.cradle.spiral_angle_deg={wish_deg:?}")];
        set.extend(one_depth.iter().filter(|_| is_even).map(|key| format!("gear.bevel.{key}")));
        let job = job_of(Path::new(SCENE), &set.iter().map(String::as_str).collect::<Vec<_>>()).expect("a gear");
        let target_deg = SIDES.map(|side| {
            let row = job.target_of(side).row(0.0).expect("a row");
            row.spiral_angle_rad().expect("a pitch point").to_degrees()
        });
        let cut_deg = SIDES.map(|side| cut_spiral_rad(&job, 3, side).to_degrees());
        println!("{wish_deg} deg: target {target_deg:?}, cut {cut_deg:?}");
        let mean_deg = 0.5 * (target_deg[0] + target_deg[1]);
        close("mean", mean_deg, wish_deg, 0.05);
        for ((side, target_deg), cut_deg) in SIDES.into_iter().zip(target_deg).zip(cut_deg) {
            close("cut", cut_deg, target_deg, 0.01);
            if is_even {
                let mean_mm = job.blank.mean_cone_distance_mm();
                let radius_mm = 76.2 + job.kind_of(side).sign() * (1.0 + 5.0 * 20_f64.to_radians().tan());
                let radial_mm = job.finishing().settings.radial_setting_mm;
                let sin = (mean_mm.powi(2) + radius_mm.powi(2) - radial_mm.powi(2)) / (2.0 * mean_mm * radius_mm);
                close("target", target_deg, f64::signum(wish_deg) * sin.asin().to_degrees(), 1e-9);
            }
        }
    }
}

/// The scene that is shipped says its settings with units, and a Formate gear may be set so as well.
#[test]
fn the_run_says_the_computed_settings() {
    check_as_it_is(SCENE).done().says(&[
        "radial setting 71.0945 mm, cradle angle 61.3994 deg, sliding base -0.0003 mm",
        "computed from spiral angle, cutter radius and blank",
        "radius 76.2000 mm and spiral angle 35.0000 deg",
    ]);
    let job = job_of(Path::new(SCENE), &["machine.cradle.roll_ratio=0"]).expect("a gear that is not generated");
    assert!(job.finishing().settings.plunges() && job.finishing().settings.cradle_angle_rad > 1.0);
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let coarse =
        ["fields.flank.profile_spacing_um=600", "fields.flank.lead_spacing_um=2000", "fields.blank.spacing_mm=2"];
    let coarse = coarse.iter().chain(&["operation.finish.roll_speed_deg_per_s=20"]).flat_map(|of| ["--set", of]);
    let arguments = ["cut", SCENE, "--only", "numbers", "--out", out.to_str().expect("a path")];
    gearcut(&arguments.into_iter().chain(coarse).collect::<Vec<_>>()).done();
    let settings = &read_json(&out.join("results.json"))["sections"]["settings"];
    close("radial", settings["radial_setting"]["value"].as_f64().expect("mm"), 71.0945, 5e-5);
    assert_eq!(settings["radial_setting"]["unit"], "mm");
    assert_eq!(settings["settings_source"]["value"], "computed from spiral angle, cutter radius and blank");
}

#[test]
fn mixed_keys_are_refused_with_a_way_out() {
    let text = std::fs::read_to_string(SCENE).expect("the scene");
    let folder = tempfile::tempdir().expect("a folder");
    let with = |what: &str, instead: &str| {
        let path = folder.path().join("mixed.toml");
        assert!(text.contains(what));
        std::fs::write(&path, text.replace(what, instead)).expect("written");
        gearcut(&["check", path.to_str().expect("a path")])
    };
    let angle = "spiral_angle_deg = 35.0\n";
    for (instead, words) in [
        ("radial_setting_mm = 71.0\n", &["mixed.toml:24:1: ", "`radial_setting_mm` say the same thing twice"][..]),
        ("cradle_angle_deg = 61.0\n", &["mixed.toml:24:1: ", "`cradle_angle_deg` say the same thing twice"]),
        ("tilt_deg = 2.0\n", &["mixed.toml:24:12: ", "`machine.cradle.tilt_deg`", "upright head", "in place of"]),
        ("swivel_deg = 2.0\n", &["`machine.cradle.swivel_deg`"]),
        ("center_to_back_mm = 1.0\n", &["`machine.cradle.center_to_back_mm`", "about the machine's centre"]),
        ("cross_shift_mm = 1.0\n", &["`machine.cradle.cross_shift_mm`"]),
        ("blank_offset_mm = 70.0\n", &["mixed.toml:24:19: ", "`machine.cradle.blank_offset_mm`", "62.4194 mm beside"]),
    ] {
        with(angle, &format!("{angle}{instead}")).failed(1, words);
    }
    with(angle, "").failed(1, &["is missing one of `radial_setting_mm` or `spiral_angle_deg`"]);
    with(angle, "cradle_angle_deg = 61.0\n").failed(1, &["is missing one of `radial_setting_mm`"]);
    with(angle, "spiral_angle_deg = 70.0\n").failed(1, &["mixed.toml:23:20: ", "-60 to 60"]);
    with("radius_mm = 76.2\n", "")
        .failed(1, &["gives no settings without a cutter radius", "tool.face_mill.radius_mm"]);
    // A setting of the command line takes the place of what the file says about the same choice.
    let settings = ["machine.cradle.radial_setting_mm=71.0945", "machine.cradle.cradle_angle_deg=61.3994"];
    let given = job_of(Path::new(SCENE), &settings).expect("a gear");
    assert!(given.spec.settings.spiral_angle_rad.is_none());
    assert!(InferredCutter::new(&given.finishing().settings, &given.blank).radius_mm > 76.0);
}
