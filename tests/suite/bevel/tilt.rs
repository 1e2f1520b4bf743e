//! A head that leans against the cradle's axis: its pose, the six axes and the way back, and its flanks.

use super::cases::close;
use super::jobs::job;
use crate::fixtures::command::gearcut;
use gearcut::bevel::cradle::{CradleSettings, Roll, Tilt};
use gearcut::bevel::ease_off::{Setting, ease_off_mm, explain};
use gearcut::bevel::envelope::Envelope;
use gearcut::bevel::face_mill::{BladeKind, CuttingSurface};
use gearcut::bevel::five_axis::{FiveAxisMachine, SixAxes};
use gearcut::process::bevel::BevelJob;
use gearcut::process::bevel::axis_program::read;
use gearcut::process::bevel::gcode;
use gearcut::process::bevel::motion::SlotMotion;
use glam::DVec3;

type Matrix = [[f64; 3]; 3];

fn settings(tilt_rad: f64, swivel_rad: f64) -> CradleSettings {
    CradleSettings {
        radial_setting_mm: 98.0,
        cradle_angle_rad: 0.92,
        blank_offset_mm: 4.0,
        cross_shift_mm: -0.4,
        sliding_base_mm: 1.3,
        center_to_back_mm: -2.5,
        root_angle_rad: 1.1,
        tilt: Tilt { tilt_rad, swivel_rad },
        roll: Roll { ratio: 1.08, second_order_per_rad: 0.03, third_order_per_rad2: -0.2, ..Roll::default() },
    }
}

/// Turn about x, y or z, entry by entry.
fn about(axis: usize, angle_rad: f64) -> Matrix {
    let (s, c) = angle_rad.sin_cos();
    match axis {
        0 => [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]],
        1 => [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]],
        _ => [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]],
    }
}

fn times(a: Matrix, b: Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn moved(a: Matrix, v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|k| a[i][k] * v[k]).sum())
}

/// p = R_x(-A) (R_y(gamma_m) (R_z(q) (R_z(j) R_y(i) R_z(-j) t + (S_r, 0, 0)) + (X_B, E_m, X_D)) - (X_p, 0, 0)).
#[test]
fn the_pose_of_a_tilted_head_is_the_product_of_its_turns() {
    for (tilt_rad, swivel_rad) in [(0.0, 0.7), (0.12, -1.9), (0.4, 2.8)] {
        let of = settings(tilt_rad, swivel_rad);
        for cradle_rad in [0.7, 0.92, 1.2] {
            let [work_rad, _] = of.work_angle(cradle_rad);
            let outer = times(about(0, -work_rad), about(1, of.root_angle_rad));
            let lean = times(times(about(2, swivel_rad), about(1, tilt_rad)), about(2, -swivel_rad));
            let rotation = times(outer, times(about(2, cradle_rad), lean));
            let [x, y, z] = moved(about(2, cradle_rad), [of.radial_setting_mm, 0.0, 0.0]);
            let middle = [x + of.cross_shift_mm, y + of.blank_offset_mm, z + of.sliding_base_mm];
            let back = moved(about(0, -work_rad), [of.center_to_back_mm, 0.0, 0.0]);
            let there = moved(outer, middle);
            let pose = of.work_from_tool(cradle_rad);
            for (i, row) in rotation.iter().enumerate() {
                for (j, entry) in row.iter().enumerate() {
                    close("rotation", pose.rotation.col(j)[i], *entry, 1e-11);
                }
                close("place", pose.translation_mm[i], there[i] - back[i], 1e-9);
            }
        }
    }
}

/// The six axes place the tool where the cradle does, at their rates; and the settings come back from them.
#[test]
fn the_axes_of_a_tilted_head_lead_both_ways() {
    let machine = FiveAxisMachine { mounting_mm: 37.0 };
    let of = settings(0.12, -1.9);
    let places = (0..40).map(|i| 0.7 + 0.01 * f64::from(i));
    let roll: Vec<SixAxes> = places.clone().map(|q| machine.axes_of_cradle(&of, q)).collect();
    for (q, axes) in places.zip(&roll) {
        let (wanted, found) = (of.work_from_tool(q), machine.work_from_tool(axes));
        assert!(wanted.rotation.abs_diff_eq(found.rotation, 1e-11), "{axes:?}");
        assert!(wanted.translation_mm.distance(found.translation_mm) < 1e-9, "{axes:?}");
        let own = machine.axes_of(&wanted).expect("axes");
        assert!(own.slides_mm.distance(axes.slides_mm) < 1e-9);
        close("B", own.swing_rad, axes.swing_rad, 1e-11);
        let jets = machine.axes_of_tilted(&of, q);
        let [before, after] = [-1e-4, 1e-4].map(|by| machine.axes_of_tilted(&of, q + by));
        for k in 0..6 {
            let rate = (after[k].value() - before[k].value()) / 2e-4;
            let bend = (after[k].derivative(1) - before[k].derivative(1)) / 2e-4;
            close("rate", jets[k].derivative(1), rate, 1e-5);
            close("bend", jets[k].derivative(2), bend, 1e-5);
        }
    }
    // B moves while the cradle turns.
    assert!((roll[0].swing_rad - roll[39].swing_rad).abs() > 0.01);
    let (found, off_mm) = machine.cradle_of(&roll, of.cradle_angle_rad, of.sliding_base_mm, of.tilt).expect("settings");
    assert!(off_mm < 1e-9, "{off_mm:e} mm");
    for (found, wanted) in [
        (found.radial_setting_mm, of.radial_setting_mm),
        (found.blank_offset_mm, of.blank_offset_mm),
        (found.cross_shift_mm, of.cross_shift_mm),
        (found.center_to_back_mm, of.center_to_back_mm),
        (found.root_angle_rad, of.root_angle_rad),
        (found.roll.ratio, of.roll.ratio),
        (found.roll.second_order_per_rad, of.roll.second_order_per_rad),
        (found.roll.third_order_per_rad2, of.roll.third_order_per_rad2),
    ] {
        close("setting", found, wanted, 1e-9);
    }
    // Another tilt is not the path's.
    let other = Tilt { tilt_rad: 0.1, ..of.tilt };
    let (_, off_mm) = machine.cradle_of(&roll, of.cradle_angle_rad, of.sliding_base_mm, other).expect("settings");
    assert!(off_mm > 1e-3, "{off_mm:e} mm");
}

/// In the meridian of its lean a tilted cone is an upright one: of the blade angle less (outside) or more (inside) the
/// tilt, of the radius times the tilt's cosine, and deeper by the radius times its sine. What that meridian generates
/// is the same.
#[test]
fn in_the_meridian_of_its_lean_a_tilted_cone_is_an_upright_one() {
    let (tilt_rad, swivel_rad) = (0.08_f64, -0.6);
    for kind in BladeKind::BOTH {
        let cone = CuttingSurface { kind, point_radius_mm: 95.0, blade_angle_rad: 0.35, corner_radius_mm: 0.0 };
        let (sin, cos) = tilt_rad.sin_cos();
        let upright = CuttingSurface {
            point_radius_mm: cone.point_radius_mm * cos,
            blade_angle_rad: cone.blade_angle_rad - kind.sign() * tilt_rad,
            ..cone
        };
        let tilted = settings(tilt_rad, swivel_rad);
        let straight = CradleSettings {
            tilt: Tilt::default(),
            sliding_base_mm: tilted.sliding_base_mm - cone.point_radius_mm * sin,
            ..tilted
        };
        for cradle_rad in [0.8, 0.92, 1.05] {
            let a = Envelope { settings: tilted, surface: cone }.at(swivel_rad, cradle_rad);
            let b = Envelope { settings: straight, surface: upright }.at(swivel_rad, cradle_rad);
            assert!(a.point_mm.distance(b.point_mm) < 1e-9, "{a:?} not {b:?}");
            assert!(a.normal.distance(b.normal) < 1e-11, "{a:?} not {b:?}");
            close("place on the edge", a.edge_mm, b.edge_mm, 1e-9);
        }
    }
}

/// What the shipped tilted head is for. Its blades act as those of 20 deg on an upright head at the mean point, but
/// their cones are curved along the tooth by cos(24 deg) / r and cos(16 deg) / r in place of cos(20 deg) / r: flanks
/// fall off from the middle by half the difference times the square of the distance along the tooth.
#[test]
fn a_tilted_head_crowns_both_flanks_along_the_tooth() {
    let [tilted, upright] = ["tilted", "spiral_angle"].map(|scene| job(scene, &[]).expect("a gear"));
    let radius_mm = upright.head.radius_mm;
    let along_mm: Vec<f64> = (-4..=4).map(|i| 2.5 * f64::from(i)).collect();
    for kind in BladeKind::BOTH {
        let [own, lean] = [&upright, &tilted].map(|job| &job.target[kind.index()]);
        let off_mm = ease_off_mm(own, &lean.envelope, &[0.5], &along_mm).expect("flanks");
        let cos = |job: &BevelJob| job.head.blade_angles_rad[kind.index()].cos();
        let curvature_per_mm = (cos(&tilted) - cos(&upright)).abs() / radius_mm;
        // A slope is a spiral angle that is a little off; the bend is the mean of both ends.
        for end in 1..=4 {
            let on_tooth_mm = along_mm[4 + end] / upright.inferred.spiral_angle_rad.cos();
            let expected_mm = -0.5 * curvature_per_mm * on_tooth_mm * on_tooth_mm;
            let bend_mm = 0.5 * (off_mm[4 - end] + off_mm[4 + end]);
            println!("{} {on_tooth_mm:.2} mm: {bend_mm:.5}, expected {expected_mm:.5} mm", kind.name());
            assert!((bend_mm / expected_mm - 1.0).abs() < 0.15);
        }
        assert!(off_mm[0] < -0.01 && off_mm[8] < -0.01, "{off_mm:?}");
    }
}

/// Errors of every setting of a tilted head are found again by what they do to flanks.
#[test]
fn wrong_settings_of_a_tilted_head_are_named() {
    let job = job("tilted", &[]).expect("a gear");
    let (shares, along_mm) = ([0.05, 0.3, 0.5, 0.7, 0.95], [-10.0, -5.0, 0.0, 5.0, 10.0]);
    let lean = &job.target[0];
    let settings = lean.envelope.settings;
    for setting in Setting::ALL.into_iter().filter(|setting| setting.acts_on(&settings)) {
        let error = if setting == Setting::RollRatio || setting.is_angle() { 4e-4 } else { 0.04 };
        let off = Envelope { settings: setting.off_by(error, &settings), ..lean.envelope };
        let measured = ease_off_mm(lean, &off, &shares, &along_mm).expect("flanks");
        let found = explain(lean, &shares, &along_mm, &measured).expect("flanks");
        println!("{}: {:?}", setting.name(), &found[..2]);
        assert_eq!(found[0].setting, setting);
        assert!((found[0].error / error - 1.0).abs() < 0.02, "{:?}", found[0]);
    }
}

const TILTED: [&str; 3] =
    ["machine.cradle.tilt_deg=2", "machine.cradle.swivel_deg=-40", "tool.face_mill.radius_mm=95.25"];

/// Straight lines of X, Y, Z, A and B follow a tilted head, and a machine without errors is where it is commanded.
#[test]
fn programs_follow_a_tilted_head() {
    let job = job("five_linkage_printed", &TILTED).expect("a gear");
    let motion = SlotMotion { job: &job, operation: job.finishing() };
    let slot_s = job.finishing().course.slot_s();
    let [from, to] = [0.0, slot_s].map(|time_s| motion.positions(time_s)[4]);
    assert!((from - to).abs() > 1e-3, "B from {from} to {to} rad");
    let text = gcode::text(&job, job.finishing(), &[]).expect("wanted").expect("a program");
    let program = read(&text).expect("it reads");
    let swings: Vec<f64> = program.knots.iter().map(|knot| knot.axes[4]).collect();
    assert!(program.knots.len() > 3 && swings[0] != swings[1]);
    // The pose of the axes, against the settings' own.
    for i in 0..=10 {
        let time_s = slot_s * f64::from(i) / 10.0;
        let [x, y, z, work_rad, swing_rad] = motion.positions(time_s);
        let axes = SixAxes { slides_mm: DVec3::new(x, y, z), work_rad, swing_rad, head_rad: 0.0 };
        let [at, wanted] = [
            job.machine.work_from_tool(&axes),
            job.finishing().settings.work_from_tool(job.finishing().course.at(time_s)[0]),
        ];
        assert!(at.translation_mm.distance(wanted.translation_mm) < 1e-9);
        assert!(at.rotation.z_axis.distance(wanted.rotation.z_axis) < 1e-11);
    }
}

#[test]
fn tilts_that_cannot_be_cut_are_refused() {
    let formate = ["check", "scenes/bevel/formate.toml", "--set", "machine.cradle.tilt_deg=1"];
    gearcut(&formate).failed(1, &["machine.cradle.tilt_deg", "a tilted head does not plunge"]);
    let lean = ["check", "scenes/bevel/five_linkage_printed.toml", "--set", "machine.cradle.tilt_deg=15"];
    gearcut(&lean).failed(1, &["machine.cradle.tilt_deg", "it would run along the axis of the work"]);
}
