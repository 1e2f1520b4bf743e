//! A gear that is not generated: its flanks are the head's cones, the head plunges along its own axis.

use super::jobs::{job, job_of};
use crate::fixtures::command::{gearcut, read_json};
use crate::fixtures::json_schema::assert_is_results;
use gearcut::bevel::contact::{BevelPair, Mounting};
use gearcut::bevel::ease_off::{Setting, ease_off_mm, explain};
use gearcut::bevel::envelope::Envelope;
use gearcut::bevel::face_mill::BladeKind;
use gearcut::cut::cpu::Cpu;
use gearcut::interrupt::Interrupt;
use gearcut::machine::{Order, peaks};
use gearcut::process::bevel::BevelJob;
use gearcut::process::bevel::axes_report::BevelAxesReport;
use gearcut::process::bevel::axis_program::read;
use gearcut::process::bevel::blank::CellGrid;
use gearcut::process::bevel::chips;
use gearcut::process::bevel::gcode;
use gearcut::process::bevel::measure;
use gearcut::process::bevel::motion::{SlotMotion, limits};
use gearcut::process::bevel::pair::Running;
use gearcut::process::bevel::pair::findings::ARCSEC_PER_RAD;
use gearcut::progress::{Progress, ProgressMode};
use gearcut::steps::axes::AxesOfOperation as _;
use gearcut::terms::Side;
use gearcut::texture::windows;
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};
use std::path::Path;

/// The blank, the head and the machine of the case, as its file has them.
const CASE: &str = "tests/data/bevel/formate_gear.toml";
const ROOT_RAD: f64 = 65.136303428248 * PI / 180.0;
const CRADLE_RAD: f64 = 60.429606775372 * PI / 180.0;
const RADIAL_MM: f64 = 70.636849361929;
const BASE_MM: f64 = 5.0;
const HEAD_MM: f64 = 75.0;
const POINT_WIDTH_MM: f64 = 2.0;
const BLADE_RAD: f64 = 20.0 * PI / 180.0;
const SIDES: [Side; 2] = [Side::Left, Side::Right];

fn case(settings: &[&str]) -> BevelJob {
    job_of(Path::new(CASE), settings).expect("a gear")
}

/// Distance of a point of the work from the head's axis, and its height over the plane of the tips along that axis,
/// towards the work, mm: the middle of the head stands at the radial setting and the cradle angle in the machine, the
/// sliding base deeper, and the work's axis leans by the root angle.
fn about_head(point_mm: DVec3) -> [f64; 2] {
    let machine = DMat3::from_rotation_y(-ROOT_RAD) * point_mm;
    let from_head = machine - DVec3::new(RADIAL_MM * CRADLE_RAD.cos(), RADIAL_MM * CRADLE_RAD.sin(), BASE_MM);
    [from_head.truncate().length(), from_head.z]
}

/// How far a point stands off the cone that cuts a side of the slot, mm: outside r - h tan(blade angle), inside
/// r + h tan(blade angle).
fn off_cone_mm(kind: BladeKind, point_mm: DVec3) -> f64 {
    let [distance_mm, height_mm] = about_head(point_mm);
    let points_mm = HEAD_MM + kind.sign() * 0.5 * POINT_WIDTH_MM;
    (distance_mm - (points_mm - kind.sign() * height_mm * BLADE_RAD.tan())) * BLADE_RAD.cos()
}

/// The case: on the target to rounding, on cut flanks of any slot to the resolution of the dexels.
#[test]
fn flanks_are_the_heads_cones() {
    let gear = case(&[]);
    for side in SIDES {
        let (target, kind) = (gear.target_of(side), gear.kind_of(side));
        let (mut farthest_mm, mut highest_mm) = (0.0_f64, f64::NEG_INFINITY);
        for row in 0..=24 {
            let row = target.row(25.0 * (f64::from(row) / 24.0 - 0.5)).expect("a row");
            for share in 0..=20 {
                let point_mm = row.point(f64::from(share) / 20.0).expect("a point").point_mm;
                farthest_mm = farthest_mm.max(off_cone_mm(kind, point_mm).abs());
                highest_mm = highest_mm.max(-about_head(point_mm)[1]);
            }
        }
        println!("{side:?}: target {farthest_mm:e} mm off, up to {highest_mm} mm over the tips");
        assert!(farthest_mm < 1e-9, "{side:?}: {farthest_mm:e} mm");
        assert!(highest_mm > 8.0, "all of the flank: {highest_mm} mm");
        for tooth in [1, 12, 41] {
            let slot = gear.space_of(tooth, side);
            let arcs_mm: Vec<f64> = (0..40).map(|i| target.length_mm() * f64::from(i) / 39.0).collect();
            let rows_mm = (0..50).map(|i| 12.5 * (f64::from(i) / 24.5 - 1.0)).collect();
            let rays = gear.rays_over(tooth, side, arcs_mm, rows_mm).expect("rays");
            let (layers, stats) = gear.cut_field(&Cpu::default(), slot, &rays.field).expect("cuts");
            assert_eq!(stats.unconverged, 0);
            let back = DMat3::from_rotation_z(-TAU * f64::from(slot) / 41.0);
            let mut cut_mm = 0.0_f64;
            for (i, &height_mm) in layers[0].heights_mm.iter().enumerate() {
                let at = rays.field.ray(i / 50, i % 50).at(f64::from(height_mm));
                let in_work = gear.gear_from_work.inverse().point(back * at);
                cut_mm = cut_mm.max(off_cone_mm(kind, in_work).abs());
            }
            println!("tooth {tooth} {side:?}: cut {cut_mm:e} mm off");
            assert!(cut_mm < 1e-7, "tooth {tooth} {side:?}: {cut_mm:e} mm");
        }
        // No ridges stay, and none are said to.
        assert_eq!(measure::marks(&gear, side).expect("a flank"), None);
    }
    // Alive: a roll leaves another flank.
    let rolled = job("crown_gear", &["tool.face_mill.radius_mm=75"]).expect("a gear");
    let point_mm = rolled.target[0].row(10.0).expect("a row").point(0.9).expect("a point").point_mm;
    assert!(off_cone_mm(BladeKind::Outside, point_mm).abs() > 1e-3);
}

/// The plunge in closed form: Z advances from clear of the blank to full depth at the infeed, and rests; X, Y, A and B
/// rest all the time.
#[test]
fn z_alone_advances_and_rests() {
    let job = case(&["operation.finish.infeed_mm_per_revolution=0.6", "operation.finish.dwell_revolutions=2"]);
    let operation = job.finishing();
    let motion = SlotMotion { job: &job, operation };
    // The head turns 150 times a minute unless the scene says otherwise; the mounting distance is 50 mm.
    let (mm_per_s, dwell_s) = (0.6 * 2.5, 0.8);
    let deepest_z_mm = BASE_MM + 50.0 * ROOT_RAD.sin();
    let way_s = operation.course.slot_s() - dwell_s;
    for i in 0..=400 {
        let time_s = operation.course.slot_s() * f64::from(i) / 400.0;
        let [x, y, z, a, b] = motion.positions(time_s);
        assert!((x - (RADIAL_MM * CRADLE_RAD.cos() + 50.0 * ROOT_RAD.cos())).abs() < 1e-12, "{x}");
        assert!((y - RADIAL_MM * CRADLE_RAD.sin()).abs() < 1e-12 && a == 0.0 && b == ROOT_RAD, "{y} {a} {b}");
        let wanted_mm = deepest_z_mm - (mm_per_s * (way_s - time_s)).max(0.0);
        assert!((z - wanted_mm).abs() < 1e-9, "{time_s} s: {z} of {wanted_mm} mm");
    }
    for peak in peaks(&motion, &limits(&job)) {
        let wanted = if peak.axis.letter == 'Z' && peak.order == Order::Speed { mm_per_s } else { 0.0 };
        assert!((peak.value - wanted).abs() < 1e-12, "{peak:?}");
    }
    // Clear by a turn and a half before the first chip: the highest place of the blank, seen along the cradle's axis.
    let blank = &job.blank;
    let mut first_mm = f64::INFINITY;
    for (distance_mm, i) in [0.0, 12.5, 25.0].into_iter().flat_map(|b| (0..720).map(move |i| (b, i))) {
        let distance_mm = blank.outer_cone_distance_mm - distance_mm;
        let at = blank.axial_mm([distance_mm, blank.addendum_mm(distance_mm)]);
        let around = DMat3::from_rotation_x(TAU * f64::from(i) / 720.0) * DVec3::new(at.x, at.y, 0.0);
        first_mm = first_mm.min((DMat3::from_rotation_y(-ROOT_RAD) * around).z);
    }
    let clear_mm = first_mm - (motion.positions(0.0)[2] - 50.0 * ROOT_RAD.sin());
    println!("clear by {clear_mm} mm, plunges for {way_s} s");
    assert!((clear_mm - 1.5 * 0.6).abs() < 1e-3, "{clear_mm} mm");
}

fn flank_heights(job: &BevelJob) -> Vec<f64> {
    let mut heights = Vec::new();
    for (tooth, side) in [(1, Side::Left), (28, Side::Right)] {
        let arcs_mm = (1..5).map(|i| job.target_of(side).length_mm() * f64::from(i) / 5.0).collect();
        let rays = job.rays_over(tooth, side, arcs_mm, vec![-9.0, 0.3, 7.0]).expect("rays");
        let (layers, _) = job.cut_field(&Cpu::default(), job.space_of(tooth, side), &rays.field).expect("cuts");
        heights.extend(layers[0].heights_mm.iter().map(|&height| f64::from(height)));
    }
    heights
}

/// Two straight blocks and the way back for each slot; read back they leave the same flanks, and a shallow one another.
#[test]
fn a_program_plunges_slot_after_slot_and_cuts_the_same() {
    let own = case(&[]);
    let text = gcode::text(&own, own.finishing(), &[]).expect("wanted").expect("written");
    let program = read(&text).expect("it reads");
    // A slot: begin, full depth, end of the dwell; between two of them out, and on to the next.
    assert_eq!(program.knots.len(), 41 * 3 + 40 * 2);
    let under_test = |text: &str| {
        let file = tempfile::NamedTempFile::new().expect("a file");
        std::fs::write(file.path(), text).expect("written");
        case(&[&format!("operation.finish.program='{}'", file.path().display())])
    };
    let direct = flank_heights(&own);
    let apart_mm = |job: &BevelJob| -> Vec<f64> {
        flank_heights(job).iter().zip(&direct).map(|(of_program, own)| of_program - own).collect()
    };
    let read_back = under_test(&text);
    let worst_mm = apart_mm(&read_back).into_iter().map(f64::abs).fold(0.0, f64::max);
    println!("{worst_mm:e} mm off");
    assert!(worst_mm < 1e-4, "{worst_mm:e} mm");
    let report = &BevelAxesReport::of_job(&read_back)[0];
    assert!(report.own_warnings().is_empty(), "{:?}", report.own_warnings());
    let deepest = format!(" Z{:.4}", program.knots[1].axes[2]);
    let shallow: String = text
        .lines()
        .map(|line| match line.split_once(" Z") {
            Some((before, after)) if line.starts_with('N') => {
                let (z, rest) = after.split_once(' ').expect("more words");
                format!("{before} Z{:.7} {rest}\n", z.parse::<f64>().expect("a number") - 0.05)
            }
            _ => format!("{line}\n"),
        })
        .collect();
    assert!(text.contains(&deepest), "{deepest}");
    let off = apart_mm(&under_test(&shallow));
    let wanted_mm = 0.05 * BLADE_RAD.sin();
    assert!(off.iter().all(|mm| (mm - wanted_mm).abs() < 1e-4), "{off:?}");
}

/// While the head plunges the thickest chip is the infeed over the blades of a kind, as both kinds cut their own edge
/// of the bottom; the first turn takes nothing, and the dwell the rest.
#[test]
fn chips_of_a_plunge_are_as_thick_as_its_infeed() {
    let settings = [
        "fields.blank.spacing_mm=0.05",
        "fields.blank.slice_spacing_mm=5",
        "material.name=\"C45\"",
        "tool.face_mill.corner_radius_mm=0.4",
    ];
    let job = case(&settings);
    let grid = CellGrid::of_scene(&job).expect("rays");
    let quiet = Progress::new(ProgressMode::Quiet);
    let ledger = chips::measure(&job, &grid, 3, &quiet, &Interrupt::default()).expect("cuts").expect("not stopped");
    // 12 blades, module 4: 0.02 x 4 x 12 mm for each turn.
    let wanted_mm = 0.96 / 6.0;
    let thickest_mm = ledger.passes.iter().map(|pass| pass.thickness_mm).fold(0.0, f64::max);
    println!("{thickest_mm} of {wanted_mm} mm");
    assert!((thickest_mm / wanted_mm - 1.0).abs() < 0.01, "{thickest_mm} of {wanted_mm} mm");
    assert!(ledger.passes.iter().all(|pass| !pass.is_plunge() && pass.moment <= 0.0));
    let last = ledger.passes.last().expect("chips");
    let turn_after_mm = 0.96 * 0.1;
    assert!(last.moment >= -turn_after_mm, "{last:?}");
    let taken_mm3: f64 = ledger.passes.iter().map(|pass| pass.volume_mm3).sum();
    assert!((taken_mm3 / (ledger.blank_mm3 - ledger.left_mm3) - 1.0).abs() < 1e-9);
    let force = |pass: &chips::SlotPass| pass.force_n.expect("a material");
    assert!(ledger.passes.iter().map(force).fold(0.0, f64::max) > 100.0);
}

/// Errors of the machine and of its settings come out as their closed forms; the target stays that of the settings.
#[test]
fn errors_come_out_on_the_cones() {
    let sound = flank_heights(&case(&[]));
    let off = |setting: &str| -> Vec<f64> {
        flank_heights(&case(&[setting])).iter().zip(&sound).map(|(faulty, sound)| faulty - sound).collect()
    };
    // The head deeper by d lowers its cones by d sin(blade angle); so does a slide that drifts.
    for mm in off("machine.cradle_errors.sliding_base_mm=0.02") {
        assert!((mm + 0.02 * BLADE_RAD.sin()).abs() < 1e-6, "{mm}");
    }
    // A slide that runs behind arrives during the dwell: nothing is left of it but its rest after one turn and a half.
    let lag = off("machine.errors.z.velocity_gain_per_s=60");
    assert!(lag.iter().all(|mm| mm.abs() < 1e-6), "{lag:?}");
    let cradle = off("machine.cradle_errors.cradle_angle_deg=0.02");
    assert!(cradle.iter().any(|mm| mm.abs() > 0.005), "{cradle:?}");
    // Deviations of the form name the setting.
    let job = case(&[]);
    let (shares, along_mm) = ([0.05, 0.3, 0.5, 0.7, 0.95], [-10.0, -5.0, 0.0, 5.0, 10.0]);
    for (flank, setting) in job.target.iter().flat_map(|flank| Setting::ALL.map(|setting| (flank, setting))) {
        if !setting.acts_on(&flank.envelope.settings) {
            continue;
        }
        let error = if setting.is_angle() { 4e-4 } else { 0.04 };
        let off = Envelope { settings: setting.off_by(error, &flank.envelope.settings), ..flank.envelope };
        let measured = ease_off_mm(flank, &off, &shares, &along_mm).expect("flanks");
        let found = explain(flank, &shares, &along_mm, &measured).expect("flanks");
        println!("{}: {:?}", setting.name(), &found[..2]);
        assert_eq!(found[0].setting, setting);
        assert!((found[0].error / error - 1.0).abs() < 0.02, "{:?}", found[0]);
    }
}

/// The gear and a generated pinion touch nowhere before they touch at the contact that is found. The pinion whose roll
/// is modified for it turns it evenly, with a bearing in the middle of the flank; that of the crown gear does not.
#[test]
fn a_generated_pinion_runs_with_it() {
    let gear = job("formate", &[]).expect("a gear");
    let running = |pinion: &str| {
        let pinion = job(pinion, &[]).expect("a pinion");
        let mounting = Mounting { shaft_angle_rad: 0.5 * PI, offset_mm: 0.0, pinion_axial_mm: 0.0, gear_axial_mm: 0.0 };
        let pair = BevelPair { gear: gear.target[0].clone(), pinion: pinion.target[1].clone(), mounting };
        let running = Running::of(&pair, 0.00635).expect("they meet");
        for (_, contact, _) in running.carrying.iter().step_by(5) {
            let (nearest_mm, place_mm) = pair.nearest_mm(contact, [150, 300]);
            println!("nearest {nearest_mm:e} mm at {place_mm:?}, contact at {:?}", contact.place_mm);
            assert!(nearest_mm > -1e-8 && nearest_mm < 1e-4, "{nearest_mm:e} mm");
        }
        (ARCSEC_PER_RAD * running.motion_error_rad(), running)
    };
    let (arcsec, even) = running("formate_pinion");
    let [along_mm, _] = even.center_mm();
    let ellipse = even.middle().ellipse.expect("inside the flank");
    let ([long_mm, _], [along, height]) = (ellipse.half_axes_mm, ellipse.directions[0]);
    println!("{arcsec} arc seconds, {along_mm} mm from the middle, {ellipse:?}");
    assert!(arcsec < 12.0 && along_mm.abs() < 0.2, "{arcsec} arc seconds, {along_mm} mm");
    // Along the line of contact the gap is the crowning: 12 um at 10.8 mm along the tooth, 6 um at 2.6 mm of height.
    let per_mm2 = 0.012 * (along / 10.8).powi(2) + 0.006 * (height / 2.6).powi(2);
    let wanted_mm = (0.00635 / per_mm2).sqrt();
    println!("half axis {long_mm} of {wanted_mm} mm");
    assert!((long_mm / wanted_mm - 1.0).abs() < 0.15, "{long_mm} of {wanted_mm} mm");
    assert!(running("crown_pinion").0 > 300.0);
}

/// What a user sees: no roll is spoken of where there is none, and keys of the other way are refused with a way out.
#[test]
fn scenes_and_pages_speak_of_a_plunge() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let set =
        ["fields.flank.profile_spacing_um=800", "fields.flank.lead_spacing_um=2000", "fields.blank.spacing_mm=1.2"];
    let set = set.iter().flat_map(|setting| ["--set", setting]);
    let arguments = ["cut", "scenes/bevel/formate.toml", "--only", "numbers,axes,report", "--out"];
    let arguments: Vec<&str> = arguments.into_iter().chain([out.to_str().expect("a path")]).chain(set).collect();
    gearcut(&arguments).done().says(&["82 of 82 flanks cut", "slot depth"]);
    let results = read_json(&out.join("results.json"));
    assert_is_results(&results);
    let operation = &results["sections"]["operations"]["finish"];
    assert!(operation["roll_from"].is_null() && operation["axis_fits"].is_null(), "{operation}");
    assert!((operation["infeed"]["value"].as_f64().expect("a number") - 0.8).abs() < 1e-12, "{operation}");
    let page = std::fs::read_to_string(out.join("report.html")).expect("a page");
    assert!(page.contains("plunged along Z") && page.contains("that is not generated (Formate)"));
    for words in ["while the cradle rolls", "is rolled", "chips of a slot over the roll", "takes what a plunge would"] {
        assert!(!page.contains(words), "{words}");
    }
    // Nothing is left to look at in a window; one that a scene writes says so.
    assert!(windows(&job("formate", &[]).expect("a gear")).expect("windows").is_empty());
    let text = std::fs::read_to_string(CASE).expect("the case") + "[[texture]]\ntooth = 2\n";
    let with_window = folder.path().join("with_window.toml");
    std::fs::write(&with_window, text).expect("written");
    let written = gearcut(&["check", with_window.to_str().expect("a path")]).done();
    assert!(written.err.contains("this flank has no marks of the tool's motion"), "{}", written.err);
    gearcut(&["check", CASE]).done().says(&[
        "plunge",
        "mm along Z, 0.9600 mm for each turn",
        "1.5 turns at full depth",
    ]);
    for (scene, setting, words) in [
        (CASE, "operation.finish.roll_speed_deg_per_s=2", "nothing rolls: machine.cradle.roll_ratio is 0"),
        (CASE, "operation.finish.roll_from_deg=40", "remove it, or write another roll_ratio"),
        (CASE, "machine.cradle.modified_roll_c=0.01", "nothing rolls"),
        (CASE, "machine.cradle_errors.roll_ratio=0.001", "nothing rolls"),
        (CASE, "machine.cradle_errors.tilt_deg=0.1", "nothing rolls"),
        ("scenes/bevel/crown_gear.toml", "machine.cradle_errors.swivel_deg=0.1", "an upright head leans nowhere"),
        ("scenes/bevel/crown_gear.toml", "operation.finish.infeed_mm_per_revolution=0.5", "the cradle rolls"),
        (
            "scenes/bevel/crown_gear.toml",
            "operation.finish.dwell_revolutions=2",
            "or write machine.cradle.roll_ratio = 0",
        ),
    ] {
        gearcut(&["check", scene, "--set", setting]).failed(1, &[words]);
    }
}
