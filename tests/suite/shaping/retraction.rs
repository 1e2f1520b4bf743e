//! Retraction of the return strokes against closed forms and an independent implementation.
//!
//! tests/data/shaping/internal_s1.json has epsilon, clearance and angles of the method for the pair of the paper on
//! internal gears, internal_retraction_overlap.json the area that the returning cutter has in common with the finished
//! gear, from polygons of the whole cutter and the whole gear.

use crate::fixtures::expected::{data, number};
use crate::fixtures::paper::{NORMAL, operation, paper_scene};
use crate::fixtures::rings::ring_scene;
use gearcut::cut::cpu::Cpu;
use gearcut::frame::Rigid2;
use gearcut::gear::{Driver, GearKind, PitchCurve, PitchCurveShape};
use gearcut::process::shaping::axes_report::OperationAxes;
use gearcut::process::shaping::axes_report::programs;
use gearcut::process::shaping::linkage::retraction::{RetractingCutter, RetractionLaw};
use gearcut::process::shaping::linkage::{CutterPose, dynamics};
use gearcut::process::shaping::motion::gcode;
use gearcut::process::shaping::motion::returns::clearance::{Clearance, ReturnRoom};
use gearcut::process::shaping::motion::returns::motion::{RamTimes, RetractionMotion};
use gearcut::process::shaping::motion::returns::survey::tightest;
use gearcut::process::shaping::scene::model as shaping;
use gearcut::process::shaping::{ShapingJob, findings};
use gearcut::steps::planar::blank_report;
use glam::DVec2;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The internal gear of 102 teeth that runs with a driver of the ratio c + 1 - b sin phi.
fn internal_shape(b: f64) -> PitchCurveShape {
    let driver = PitchCurveShape::SinusoidalRatio {
        order: 1,
        mean_ratio: (9.0 + b * b).sqrt() - 2.0,
        ratio_amplitude: -b,
        center_distance_mm: None,
    };
    let driver = Box::new(Driver { curve: driver, teeth: 34, start_rad: Some(0.0) });
    PitchCurveShape::Mate { driver, kind: GearKind::Internal }
}

fn internal_curve(b: f64) -> PitchCurve {
    PitchCurve::new(&internal_shape(b), 2.0, 102).expect("a closing pair")
}

/// The finishing pose written from geometry: the cutter's pitch circle rolls on the curve, tooth 0 from P(0).
fn rolling_pose(curve: &PitchCurve, kind: GearKind, r_c: f64, phi: f64) -> CutterPose {
    let frame = curve.frame(phi);
    let side = kind.tip_sign();
    let normal_rad = phi + frame.mu_rad - FRAC_PI_2;
    let to_curve_rad = if side > 0.0 { PI } else { 0.0 };
    CutterPose {
        center_mm: frame.point_mm + side * r_c * frame.normal,
        angle_rad: normal_rad + to_curve_rad + side * curve.arc_mm(phi) / r_c,
    }
}

#[test]
fn the_method_finds_the_places_of_the_independent_implementation() {
    let case = &data("shaping/internal_s1")["cases"][0];
    let within = |key: &str| number(&case["tolerance"][key]);
    let (curve, r_c) = (internal_curve(0.3), number(&case["r0"]));
    let retraction = RetractingCutter { curve: &curve, kind: GearKind::Internal, cutter_pitch_radius_mm: r_c };
    let rows = case["retraction"].as_array().expect("rows");
    for row in rows {
        let value = |key: &str| number(&row[key]);
        let pose = rolling_pose(&curve, GearKind::Internal, r_c, value("phi"));
        let law = RetractionLaw::Turned;
        let back = retraction.retracted(law, &pose, value("phi"), value("delta_a")).expect("a foot");
        assert!((back.foot_rad - value("epsilon")).abs() < within("epsilon"), "{row}: {back:?}");
        assert!((back.clearance_mm - value("clearance")).abs() < within("clearance"), "{row}: {back:?}");
        assert!((back.pose.center_mm.length() - value("a")).abs() < within("axes"), "{row}: {back:?}");
        // Work angle Phi, and the cutter's angle psi = Phi - orientation in the gear frame.
        let work_rad = back.pose.center_mm.to_angle();
        let off = |angle: f64| (angle + PI).rem_euclid(TAU) - PI;
        assert!(off(work_rad - value("Phi")).abs() < within("axes"), "{row}: {back:?}");
        assert!((value("Phi") - back.pose.angle_rad - value("psi")).abs() < within("axes"), "{row}: {back:?}");
        // Between the line of centres and the normal at the new foot.
        let delta_rad = back.pose.center_mm.angle_to(curve.frame(back.foot_rad).normal);
        assert!((delta_rad - value("Delta_new")).abs() < within("axes"), "{row}: {delta_rad}");
    }
    assert_eq!(rows.len(), 15);
}

#[test]
fn on_a_circle_the_method_is_the_line_of_centres() {
    let curve = PitchCurve::new(&PitchCurveShape::Circle, 2.0, 60).expect("a circle");
    for kind in [GearKind::External, GearKind::Internal] {
        let retraction = RetractingCutter { curve: &curve, kind, cutter_pitch_radius_mm: 17.0 };
        for phi in [-0.4, 0.0, 2.0, 9.0] {
            let pose = rolling_pose(&curve, kind, 17.0, phi);
            let straight = retraction.retracted(RetractionLaw::CenterLine, &pose, phi, 0.7).expect("a foot");
            let away = kind.tip_sign() * 0.7 * DVec2::from_angle(phi);
            assert!(straight.pose.center_mm.distance(pose.center_mm + away) < 1e-12);
            for law in [RetractionLaw::Turned, RetractionLaw::Normal] {
                let back = retraction.retracted(law, &pose, phi, 0.7).expect("a foot");
                assert!(back.pose.center_mm.distance(straight.pose.center_mm) < 1e-12, "{law:?}");
                assert!((back.pose.angle_rad - pose.angle_rad).abs() < 1e-12, "{law:?}");
                assert!((back.clearance_mm - 0.7).abs() < 1e-12 && (back.foot_rad - phi).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn small_retractions_move_and_turn_at_the_rates_of_rolling() {
    // With Delta between line of centres and normal the foot moves by delta_a sin(Delta) / (1 + s d kappa) along the
    // curve, d the cutter's distance from it, and the cutter turns by the curve's turn and by rolling.
    let h = 1e-5;
    for (curve, kind, r_c) in [
        (PitchCurve::new(&paper_scene(Vec::new()).gear.pitch_curve, 3.0, 42).expect("S0"), GearKind::External, 30.0),
        (internal_curve(0.6), GearKind::Internal, 17.0),
    ] {
        let side = kind.tip_sign();
        let retraction = RetractingCutter { curve: &curve, kind, cutter_pitch_radius_mm: r_c };
        for i in 0..60 {
            let phi = 0.1 * f64::from(i);
            let pose = rolling_pose(&curve, kind, r_c, phi);
            let at = |back_off: f64| {
                let back = retraction.retracted(RetractionLaw::Turned, &pose, phi, back_off).expect("a foot");
                (back.foot_rad, back.pose.angle_rad, back.clearance_mm)
            };
            let (ahead, behind) = (at(h), at(-h));
            let frame = curve.frame(phi);
            let out = side * pose.center_mm.normalize();
            let arc_rate = out.dot(frame.tangent) / (1.0 + side * r_c * frame.curvature_per_mm);
            let found = (ahead.0 - behind.0) / (2.0 * h);
            assert!((found - arc_rate / frame.arc_rate_mm_per_rad).abs() < 1e-8, "{kind:?} {phi}: {found}");
            let turn = arc_rate * (frame.curvature_per_mm + side / r_c);
            let found = (ahead.1 - behind.1) / (2.0 * h);
            assert!((found - turn).abs() < 1e-8, "{kind:?} {phi}: {found} {turn}");
            let found = (ahead.2 - behind.2) / (2.0 * h);
            assert!((found - side * out.dot(frame.normal)).abs() < 1e-8, "{kind:?} {phi}: {found}");
        }
    }
}

/// A ring of the design `b`, finished in strokes.
fn ring_job(b: f64, cutter_teeth: u32, retraction: shaping::Retraction, back_off_mm: f64, strokes: u32) -> ShapingJob {
    let finish = vec![operation("finish", NORMAL, 0.0, strokes)];
    let mut scene = ring_scene(internal_shape(b), 102, cutter_teeth, finish);
    let machine = &mut shaping::Shaping::of_mut(&mut scene).expect("shaping").machine;
    (machine.retraction, machine.back_off_mm) = (retraction, back_off_mm);
    ShapingJob::new(scene).expect("a ring")
}

#[test]
fn overlaps_of_the_returning_cutter_agree() {
    let data = data("shaping/internal_retraction_overlap");
    let mut rows_seen = 0;
    for case in data["cases"].as_array().expect("cases") {
        let (b, z0, phi) = (number(&case["b"]), number(&case["z0"]), number(&case["phi"]));
        let job = ring_job(b, z0 as u32, shaping::Retraction::CenterLine, 0.3, 1020);
        let (linkage, cutter) = (&job.finishing().linkage, &job.cutter);
        let finish = |phi: f64| linkage.pose(phi, 0.0);
        let room = ReturnRoom::new(cutter, 102, 2.0, &finish, &[]);
        let retracting = RetractingCutter::of(linkage);
        for row in case["rows"].as_array().expect("rows") {
            let row: Vec<f64> = row.as_array().expect("a row").iter().map(number).collect();
            let laws = [RetractionLaw::CenterLine, RetractionLaw::Normal, RetractionLaw::Turned];
            for (law, expected_mm2) in laws.into_iter().zip(&row[1..]) {
                let at = |phase: usize| {
                    let place = (phi / TAU * room.swept.places() as f64).round() as usize + 8 * phase;
                    let phi = room.swept.phi_rad(place);
                    let back = retracting.retracted(law, &finish(phi), phi, row[0]).expect("a foot").pose;
                    let back = Rigid2::new(back.angle_rad, back.center_mm);
                    let beyond_mm = |p: DVec2| job.blank.height(p, phi + DVec2::from_angle(phi).angle_to(p)).0 - 2.0;
                    let depth_mm = -room.at(place, &back, beyond_mm, Clearance::ANY).surface_mm;
                    if depth_mm > 0.0 { (room.overlap_mm2(place, &back, beyond_mm), depth_mm) } else { (0.0, depth_mm) }
                };
                let found = (0..6).map(at).max_by(|a, b| a.0.total_cmp(&b.0)).expect("phases");
                println!(
                    "b {b} da {} {law:?}: {:.3e} mm2, {:.4} mm deep; {expected_mm2:.3e}",
                    row[0], found.0, found.1
                );
                let within_mm2 = if *expected_mm2 == 0.0 { 1e-6 } else { (0.05 * expected_mm2).max(1e-3) };
                assert!((found.0 - expected_mm2).abs() <= within_mm2, "{row:?} {law:?}: {found:?}");
                rows_seen += 1;
            }
        }
    }
    assert_eq!(rows_seen, 48);
}

/// The printed design at twelve places, drawn back by up to 4.5 mm: along the line of centres, along the normal and by
/// the method it overlaps its teeth nowhere.
#[test]
fn the_printed_example_overlaps_nowhere() {
    let data = data("shaping/internal_s1_envelope");
    let job = ring_job(0.3, 13, shaping::Retraction::CenterLine, 0.3, 1020);
    let (linkage, finish) = (&job.finishing().linkage, |phi: f64| job.finishing().linkage.pose(phi, 0.0));
    let room = ReturnRoom::new(&job.cutter, 102, 2.0, &finish, &[]);
    let retracting = RetractingCutter::of(linkage);
    let (mut compared, mut smallest_mm) = (0, f64::INFINITY);
    for case in data["retraction"].as_array().expect("places") {
        let place = (number(&case["phi"]) / TAU * room.swept.places() as f64).round() as usize;
        let phi = room.swept.phi_rad(place);
        let beyond_mm = |p: DVec2| job.blank.height(p, phi + DVec2::from_angle(phi).angle_to(p)).0 - 2.0;
        for row in case["rows"].as_array().expect("rows") {
            let row: Vec<f64> = row.as_array().expect("a row").iter().map(number).collect();
            let laws = [RetractionLaw::CenterLine, RetractionLaw::Normal, RetractionLaw::Turned];
            for (law, expected_mm2) in laws.into_iter().zip(&row[1..]) {
                let back = retracting.retracted(law, &finish(phi), phi, row[0]).expect("a foot").pose;
                let back = Rigid2::new(back.angle_rad, back.center_mm);
                let clearance_mm = room.at(place, &back, beyond_mm, Clearance::ANY).surface_mm;
                smallest_mm = smallest_mm.min(clearance_mm);
                // An edge that stands in no tooth has nothing in common with them.
                assert!(*expected_mm2 == 0.0 && clearance_mm > 0.0, "{row:?} {law:?} at {phi}: {clearance_mm}");
                compared += 1;
            }
        }
    }
    println!("{compared} poses, at least {smallest_mm:.5} mm clear");
    assert_eq!(compared, 216);
}

#[test]
fn the_printed_example_never_reaches_the_angle_at_which_it_is_said_to_interfere() {
    let steepest = |b: f64, z0: u32| {
        let job = ring_job(b, z0, shaping::Retraction::CenterLine, 0.5, 1020);
        let rooms = job.operations[0].survey.rooms(0.5, |_| RetractionLaw::CenterLine).expect("poses");
        let angle = rooms.iter().map(|room| room.from_normal_rad.abs()).fold(0.0, f64::max).to_degrees();
        (angle, tightest(&rooms, |room| room.clearance.surface_mm).expect("rooms").clearance.surface_mm)
    };
    let (angle, smallest_mm) = steepest(0.3, 13);
    println!("printed design: {angle:.4} deg, {smallest_mm:.4} mm");
    // Places stand 0.59 deg apart: half of that beside its peak, the angle is some hundredths of a degree less.
    assert!((angle - 9.8127).abs() < 0.02 && smallest_mm > 0.08, "{angle} {smallest_mm}");
    let (angle, smallest_mm) = steepest(0.6, 17);
    println!("b = 0.6: {angle:.4} deg, {smallest_mm:.4} mm");
    assert!((angle - 20.318).abs() < 0.05 && smallest_mm < 0.0, "{angle} {smallest_mm}");
}

/// What a run of the whole blank says of the return strokes from `first` on: deepest on the gear and on stock, mm, with
/// the volume, mm3. At the first strokes stock stands on both sides, and no direction clears it.
fn rubbing(job: &ShapingJob, first: usize) -> [(f64, f64); 2] {
    let cut = job.cut_blank(&Cpu::default(), job.planar().blank_field().expect("fits"), &|| true).expect("native");
    let mut cut = cut.expect("not stopped");
    let strokes = &job.finishing().strokes;
    cut.cuts[0].rubs.retain(|rub| strokes.stroke_and_blade(rub.pass).0 >= first);
    let report = blank_report::measure(&job.planar(), &cut, &[]);
    [true, false].map(|stays| {
        let found = report.rubbing.iter().filter(|rubbing| rubbing.stays == stays);
        found.fold((0.0, 0.0), |(depth, volume), rubbing| {
            (f64::max(depth, rubbing.damage.depth_mm), volume + rubbing.damage.volume_mm3)
        })
    })
}

#[test]
fn auto_clears_a_ring_that_the_line_of_centres_does_not() {
    let standard = ring_job(0.6, 17, shaping::Retraction::CenterLine, 1.0, 2040);
    let [on_gear, on_stock] = rubbing(&standard, 0);
    println!("line of centres: {on_gear:?} on the gear, {on_stock:?} on stock");
    // 0.0219 mm deep by the poses; rays 0.1 mm apart come near the deepest place.
    assert!(on_gear.0 > 0.01 && on_gear.0 < 0.0235, "{on_gear:?}");
    let auto = ring_job(0.6, 17, shaping::Retraction::Auto, 1.0, 2040);
    let zones = auto.finishing().retraction.turned_rad();
    println!("turned in {:?}", zones.iter().map(|zone| zone.map(f64::to_degrees)).collect::<Vec<_>>());
    // Three waves, each with a steep place on either side.
    assert_eq!(zones.len(), 6);
    assert!(zones.iter().map(|[from, to]| to - from).sum::<f64>() < 0.5 * TAU, "{zones:?}");
    let [on_gear, _] = rubbing(&auto, 0);
    assert_eq!(on_gear, (0.0, 0.0));
}

fn external_job(round: bool, retraction: shaping::Retraction, strokes: u32) -> ShapingJob {
    let mut scene = paper_scene(vec![operation("finish", NORMAL, 0.0, strokes)]);
    if round {
        (scene.gear.pitch_curve, scene.gear.teeth) = (PitchCurveShape::Circle, 24);
    }
    shaping::Shaping::of_mut(&mut scene).expect("shaping").machine.retraction = retraction;
    ShapingJob::new(scene).expect("a gear")
}

#[test]
fn a_tilted_retraction_clears_stock_as_well() {
    // Behind the first four pitches.
    for (round, strokes, first) in [(true, 480, 80), (false, 1440, 140)] {
        let standard = rubbing(&external_job(round, shaping::Retraction::CenterLine, strokes), first);
        let job = external_job(round, shaping::Retraction::Tilted, strokes);
        let tilts = job.finishing().retraction.tilts_rad().expect("tilted").map(f64::to_degrees);
        let tilted = rubbing(&job, first);
        println!("round {round}: {standard:?} along the line of centres, {tilted:?} at {tilts:?} deg");
        assert!(standard[1].0 > 0.02, "{standard:?}");
        assert!(tilts[0] < tilts[1], "{tilts:?}");
        assert_eq!(tilted, [(0.0, 0.0); 2]);
    }
}

#[test]
fn the_survey_says_what_the_whole_blank_finds() {
    let job = external_job(true, shaping::Retraction::CenterLine, 480);
    let rooms = job.operations[0].survey.rooms(0.5, |_| RetractionLaw::CenterLine).expect("poses");
    let least = tightest(&rooms, |room| room.clearance.material_mm).expect("rooms");
    let [_, on_stock] = rubbing(&job, 0);
    println!("survey {:.4} mm, whole blank {:.4} mm", -least.clearance.material_mm, on_stock.0);
    // The blank's rays stand 0.15 mm apart.
    assert!((-least.clearance.material_mm - on_stock.0).abs() < 0.01);
    // A round gear clears the flanks by b sin(alpha), wherever the cutter is in its pitch.
    let surface = tightest(&rooms, |room| room.clearance.surface_mm).expect("rooms").clearance.surface_mm;
    let expected_mm = 0.5 * 20_f64.to_radians().sin();
    assert!((surface - expected_mm).abs() < 0.03 * expected_mm, "{surface:?} {expected_mm}");
}

#[test]
fn programs_draw_the_cutter_back_and_are_read_back() {
    use shaping::Retraction::{Auto, Normal, Tilted, Turned};
    for (round, retraction, continuous) in
        [(false, Turned, false), (false, Normal, true), (true, Tilted, false), (false, Auto, false)]
    {
        let mut scene = paper_scene(vec![operation("finish", NORMAL, 0.0, 480)]);
        if round {
            (scene.gear.pitch_curve, scene.gear.teeth) = (PitchCurveShape::Circle, 24);
        }
        let part = shaping::Shaping::of_mut(&mut scene).expect("shaping");
        part.machine.retraction = retraction;
        part.machine.limits = shaping::AxisLimits::default();
        part.operations[0].feed_during_stroke = continuous;
        let mut job = ShapingJob::new(scene).expect("a gear");
        let operation = job.finishing();
        let text = programs::text(&job, operation, &[]).expect("wanted").expect("written");
        assert!(text.contains("RETRACTION"), "{}", &text[..600]);
        let program = gcode::read::program(&text).expect("it is read");
        assert_eq!(program.count(), operation.schedule.count());
        let ram = job.ram_times();
        let (gear, tip_mm) = (GearKind::External, job.cutter.tip_radius_mm);
        let cut = program.cut_error_mm(&operation.schedule, tip_mm, &ram, continuous);
        assert!(cut.0 < 0.001, "{cut:?}");
        for stroke in (0_u32..480).step_by(7) {
            let moment = f64::from(stroke) + ram.return_middle;
            let at = if continuous { moment } else { f64::from(stroke) };
            let state = operation.schedule.state(at);
            let expected = operation.retraction.retracted(&operation.linkage, &state.pose, state.phi_rad);
            let found = program.at(moment).pose(gear);
            assert!(found.center_mm.distance(expected.center_mm) < 0.001, "{retraction:?} {stroke}");
            assert!((found.angle_rad - expected.angle_rad).abs() * tip_mm < 0.001, "{retraction:?} {stroke}");
            // Drawn back it is: a program without its return would be caught.
            assert!(found.center_mm.distance(state.pose.center_mm) > 0.49);
        }
        job.operations[0].program = Some(program);
        let motion = OperationAxes::of_job(&job);
        let told = findings::program::warnings(&job, &motion);
        assert!(told.is_empty(), "{retraction:?}: {told:?}");
        // Beside the drawing back the axes go straight.
        let between_mm = motion[0].program().expect("judged").between_mm;
        assert!(between_mm < 0.01, "{retraction:?}: {between_mm} mm between strokes");
    }
}

/// Defects of the drawing back, each planted at one stroke: before the cut has ended, while the ram returns, before the
/// next cut begins.
#[test]
fn drawing_back_is_judged_over_the_whole_way_of_the_ram() {
    use gcode::{AxisProgram, Knot};
    type Plant = Box<dyn Fn(&mut [Knot])>;
    // Knots of stroke 200: it has cut, is drawn back, still is, and stands for the next cut.
    const CUT: usize = 1 + 4 * 200;
    let mut scene = paper_scene(vec![operation("finish", NORMAL, 0.0, 480)]);
    let part = shaping::Shaping::of_mut(&mut scene).expect("shaping");
    part.machine.retraction = shaping::Retraction::Normal;
    part.machine.limits = shaping::AxisLimits::default();
    let mut job = ShapingJob::new(scene).expect("a gear");
    let operation = job.finishing();
    let text = programs::text(&job, operation, &[]).expect("wanted").expect("written");
    let own = gcode::read::program(&text).expect("it is read");
    let ram = job.ram_times();
    let [cut_mm, back_mm] = [CUT, CUT + 1].map(|knot| own.knots[knot].center_distance_mm);
    println!("stroke 200 at {cut_mm:.4} mm, drawn back to {back_mm:.4} mm");
    let moved = |knots: std::ops::RangeInclusive<usize>, drawn: f64| -> Plant {
        Box::new(move |all| {
            let (cut, back) = (all[CUT].axes(), all[CUT + 1].axes());
            for knot in knots.clone() {
                let at = |axis: usize| cut[axis] + drawn * (back[axis] - cut[axis]);
                all[knot] =
                    Knot { stroke: all[knot].stroke, psi_c_rad: at(0), psi_b_rad: at(1), center_distance_mm: at(2) };
            }
        })
    };
    let at = |knot: usize, moment: f64| -> Plant { Box::new(move |all| all[knot].stroke = 200.0 + moment) };
    let (off, drags) = ("off the scene's own strokes, at stroke 200.", "it drags over the flanks");
    let cases: Vec<(&str, Option<&str>, Plant)> = vec![
        ("the program itself", None, Box::new(|_| {})),
        ("a tenth before the cut ends", Some(off), at(CUT, 0.9 * ram.cut_ends)),
        ("in the middle of the cut", Some(off), at(CUT, 0.1 * ram.cut_ends)),
        ("never", Some(drags), moved(CUT + 1..=CUT + 2, 0.0)),
        ("a millimetre deep on the way back", Some(drags), moved(CUT + 1..=CUT + 2, -2.0)),
        ("half as far", Some("it clears the flanks by less"), moved(CUT + 1..=CUT + 2, 0.5)),
        ("twice as far", None, moved(CUT + 1..=CUT + 2, 2.0)),
        ("back in the middle of the return alone", Some("by less than the scene says"), at(CUT + 1, ram.return_middle)),
        ("not before the return stroke has entered the face", Some(drags), moved(CUT + 1..=CUT + 1, 0.0)),
        ("in again before the return ends", Some("short of where"), at(CUT + 2, ram.return_middle)),
        (
            "in again when the next cut has begun",
            Some("off the scene's own strokes, at stroke 200."),
            at(CUT + 3, 0.5 * (1.0 + ram.next_begins)),
        ),
    ];
    let mut wrong = Vec::new();
    for (name, words, plant) in cases {
        let mut knots = own.knots.clone();
        plant(&mut knots);
        job.operations[0].program = Some(AxisProgram { knots, ..own.clone() });
        let motion = OperationAxes::of_job(&job);
        let told = findings::program::warnings(&job, &motion);
        let text = told.iter().map(|of| of.text.as_str()).collect::<Vec<_>>().join("; ");
        println!("{name}: {text}");
        if words.map_or(!told.is_empty(), |words| !text.contains(words)) {
            wrong.push(name);
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn the_ram_is_at_the_ends_of_the_face_when_it_is_said_to_be() {
    for [approach, overrun] in [[3.0, 3.0], [5.0, 1.0], [0.0, 2.0]] {
        let ram = RamTimes::new(30.0, approach, overrun);
        let (length, middle) = (30.0 + approach + overrun, 0.5 * (approach - overrun));
        // z = middle + L / 2 cos(theta), and the face is between -15 and 15.
        let start = (-2.0 * middle / length).acos();
        let z = |share: f64| middle + 0.5 * length * (start + TAU * share).cos();
        for (share, expected) in [
            (0.0, 0.0),
            (ram.cut_ends, -15.0),
            (ram.return_begins, -15.0),
            (ram.return_middle, 0.0),
            (ram.return_ends, 15.0),
            (ram.next_begins, 15.0),
        ] {
            assert!((z(share) - expected).abs() < 1e-6, "{ram:?} {share}: {} not {expected}", z(share));
        }
        let order = [0.0, ram.cut_ends, ram.return_begins, ram.return_middle, ram.return_ends, ram.next_begins, 1.0];
        assert!(order.windows(2).all(|pair| pair[0] <= pair[1] + 1e-9), "{ram:?}");
    }
}

#[test]
fn the_time_that_the_axes_need_is_that_of_half_speeding_up_and_half_slowing_down() {
    let mut scene = paper_scene(vec![operation("finish", NORMAL, 0.0, 480)]);
    let part = shaping::Shaping::of_mut(&mut scene).expect("shaping");
    part.machine.retraction = shaping::Retraction::Normal;
    part.machine.limits =
        shaping::AxisLimits { center_distance_acceleration_mm_per_s2: Some(500.0), ..shaping::AxisLimits::default() };
    let job = ShapingJob::new(scene).expect("a gear");
    let operation = job.finishing();
    let limits = dynamics::limits(&job.machine.limits);
    let motion = RetractionMotion::new(&operation.schedule, &operation.retraction, &job.ram_times(), &limits);
    let motion = motion.expect("the axes draw back");
    // At phi = 0 normal and line of centres are one: the whole 0.5 mm is travel of X. 500 mm/s2 for half of it, 0.25
    // mm, take sqrt(2 s / a) = 31.6 ms, and as long to stop.
    let travel = motion.axes[2].travel;
    assert!((travel - 0.5).abs() < 1e-6, "{motion:?}");
    let half_s = (2.0 * 0.5 * travel / 500.0_f64).sqrt();
    assert!((motion.needed_s.expect("limited") - 2.0 * half_s).abs() < 1e-12, "{motion:?}");
    assert!((motion.slowdown().expect("limited") - 2.0 * half_s / motion.time_s).abs() < 1e-12, "{motion:?}");
    // Travelling so in the time that there is: mean speed is half of the largest.
    let x = motion.axes[2];
    assert!((x.speed * motion.time_s / 2.0 - travel).abs() < 1e-12);
    assert!((x.acceleration * (motion.time_s / 2.0).powi(2) - travel).abs() < 1e-9);
}
