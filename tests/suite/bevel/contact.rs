//! `gearcut contact`: a gear and a pinion that one crown gear generates, from their scenes to the folder; and a pinion
//! whose motion error, path and ellipse were chosen.

use super::jobs::job;
use crate::fixtures::command::{gearcut, read_json};
use crate::fixtures::json_schema::assert_is_results;
use gearcut::bevel::contact::{BevelPair, Contact, Mounting};
use gearcut::bevel::face_mill::BladeKind;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::Ray;
use gearcut::interrupt::Interrupt;
use gearcut::process::bevel::BevelJob;
use gearcut::process::bevel::pair::findings::ARCSEC_PER_RAD;
use gearcut::process::bevel::pair::{MountingError, MountingErrors, RolledBevels, Running, roll};
use gearcut::progress::{Progress, ProgressMode};
use gearcut::terms::Side;
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};

const MARKING_MM: f64 = 0.00635;
/// Where the gear's outside blades cut, mm; the common cone stands two dedenda further, and the scene's pinion takes
/// 1.5 mm off that.
const GEAR_POINTS_MM: f64 = 75.0;
const DEDENDUM_MM: f64 = 5.0;
const BLADE_RAD: f64 = 20.0 * PI / 180.0;
const CROWNING_MM: f64 = 1.5;

fn jobs(pinion: &[&str]) -> [BevelJob; 2] {
    [job("crown_gear", &[]).expect("a gear"), job("crown_pinion", pinion).expect("a pinion")]
}

fn rolled([gear, pinion]: &[BevelJob; 2], errors: &MountingErrors) -> RolledBevels {
    let (progress, interrupt) = (Progress::new(ProgressMode::Quiet), Interrupt::default());
    roll(gear, [pinion, pinion], errors, MARKING_MM, (&progress, &interrupt)).expect("they meet")
}

/// Settings of a pinion whose inside blades follow the gear's cone: no crowning at all.
fn conjugate_pinion() -> [String; 3] {
    let crowned = job("crown_pinion", &[]).expect("a pinion");
    let settings = crowned.finishing().settings;
    // The head's circle goes through the same mean point, with the radius of the gear's outside blades.
    let spiral_rad = 35_f64.to_radians();
    let mean_mm = crowned.blank.mean_cone_distance_mm();
    let across_mm = GEAR_POINTS_MM * spiral_rad.cos();
    let along_mm = mean_mm - GEAR_POINTS_MM * spiral_rad.sin();
    assert!(settings.cradle_angle_rad < 0.0);
    [
        format!("tool.face_mill.radius_mm={}", crowned.head.radius_mm + CROWNING_MM),
        format!("machine.cradle.radial_setting_mm={}", along_mm.hypot(across_mm)),
        format!("machine.cradle.cradle_angle_deg={}", -across_mm.atan2(along_mm).to_degrees()),
    ]
}

/// Conjugate flanks turn evenly and touch along lines; an offset of the axis ends that.
#[test]
fn flanks_of_one_crown_gear_turn_evenly() {
    let settings = conjugate_pinion();
    let [gear, pinion] = jobs(&settings.iter().map(String::as_str).collect::<Vec<_>>());
    let running = |offset_mm: f64| {
        let [gear, pinion] =
            [&gear.target[BladeKind::Outside.index()], &pinion.target[BladeKind::Inside.index()]].map(Clone::clone);
        let mounting = Mounting { shaft_angle_rad: 0.5 * PI, offset_mm, pinion_axial_mm: 0.0, gear_axial_mm: 0.0 };
        Running::of(&BevelPair { gear, pinion, mounting }, MARKING_MM).expect("they meet")
    };
    let concave = running(0.0);
    let arcsec = ARCSEC_PER_RAD * concave.motion_error_rad();
    let [long_mm, short_mm] = concave.middle().ellipse.expect("inside the flank").half_axes_mm;
    println!("conjugate: {arcsec:e} arc seconds, {long_mm} by {short_mm} mm");
    assert!(arcsec < 0.1, "{arcsec} arc seconds");
    assert_eq!(concave.parabola().map(|parabola| parabola.over_pitch_rad()), Some(0.0), "less than is known");
    // A line: as long as differences over places known to 1e-4 mm can tell, far beyond the face of 25 mm.
    assert!(long_mm > 60.0 && short_mm < 2.0, "{long_mm} by {short_mm} mm");
    let arcsec = ARCSEC_PER_RAD * running(0.05).motion_error_rad();
    println!("E = 50 um: {arcsec} arc seconds");
    assert!(arcsec > 0.5, "{arcsec} arc seconds");
}

/// The crowned side has the ellipse of both cones' curvature, and its contact moves with the mounting, the more for
/// the larger error, the other way for the other sign.
#[test]
fn a_crowned_pinion_shows_its_bearing_and_how_it_moves() {
    let rolled = rolled(&jobs(&[]), &MountingErrors::default());
    let concave = &rolled.sides[0];
    let radius_mm = GEAR_POINTS_MM + DEDENDUM_MM * BLADE_RAD.tan();
    let bend = CROWNING_MM / (radius_mm * (radius_mm - CROWNING_MM)) * BLADE_RAD.cos();
    let wanted_mm = (2.0 * MARKING_MM / bend).sqrt();
    let middle: &Contact = concave.running.middle();
    let [long_mm, _] = middle.ellipse.expect("inside the flank").half_axes_mm;
    println!("long half axis {long_mm} mm, {wanted_mm} mm by the cutters' radii");
    assert!(long_mm > wanted_mm && long_mm < 1.05 * wanted_mm);
    assert!(ARCSEC_PER_RAD * concave.running.motion_error_rad() < 0.1);
    assert_eq!(concave.trends.len(), 2 * MountingError::ALL.len());
    let [from_mm, _] = concave.running.center_mm();
    for pair in concave.trends.chunks_exact(2) {
        let moved_mm: Vec<f64> =
            pair.iter().map(|trend| trend.found.expect("they still meet").1[0] - from_mm).collect();
        println!("{:?}: moved along by {moved_mm:?} mm", pair[0].error);
        assert!(moved_mm[0] * moved_mm[1] < 0.0, "{:?}: {moved_mm:?}", pair[0].error);
        assert!((moved_mm[0] + moved_mm[1]).abs() < 0.3 * moved_mm[0].abs(), "{:?}: {moved_mm:?}", pair[0].error);
    }
    // Turned about the axis of the gear, and along it, the flank moves against its mate; the offset moves it most.
    let moved = |error: MountingError| {
        let of = concave.trends.iter().filter(|trend| trend.error == error);
        of.map(|trend| (trend.found.expect("met").1[0] - from_mm).abs()).fold(0.0, f64::max)
    };
    assert!(moved(MountingError::Offset) > 0.1);
}

/// A parabola with a slope, as errors of one pair of teeth that carries over the middle pitch, comes back with its
/// value at half a pitch; outside of that pitch the errors may be what they like.
#[test]
fn the_parabola_of_a_motion_error_has_its_value() {
    let rolled = rolled(&jobs(&[]), &MountingErrors::default());
    let middle = *rolled.sides[0].running.middle();
    let pitch_rad = 2.0 * PI / 15.0;
    let angle = |i: usize| pitch_rad * (i as f64 - 20.0) / 20.0;
    let error = |i: usize| if (10..=30).contains(&i) { 1e-6 + 2e-5 * angle(i) - 3e-4 * angle(i).powi(2) } else { 1e-4 };
    let contact = |i: usize| Contact { place_mm: [i as f64, 0.0], ..middle };
    let running = Running {
        teeth: (0..=40).map(|i| (angle(i), Some((contact(i), error(i))))).collect(),
        carrying: (10..=30).map(|i| (angle(i), contact(i), error(i))).collect(),
    };
    let parabola = running.parabola().expect("21 places");
    assert!((parabola.over_pitch_rad() / (-3e-4 * (0.5 * pitch_rad).powi(2)) - 1.0).abs() < 1e-9);
    for (at_rad, error_rad) in parabola.points() {
        let wanted_rad = 1e-6 + 2e-5 * at_rad - 3e-4 * at_rad.powi(2);
        assert!((error_rad - wanted_rad).abs() < 1e-12, "{error_rad} for {wanted_rad}");
    }
}

/// Flanks that one crown gear generates on blanks with an offset touch it, and each other, in a point: the closed form
/// of hypoid pairs is an even motion. An offset that is 20 um off is none.
#[test]
fn a_hypoid_pair_of_one_crown_gear_turns_evenly() {
    let [gear, pinion] = ["hypoid_crown_gear", "hypoid_crown_pinion"].map(|name| job(name, &[]).expect("a gear"));
    let offsets_mm = [&gear, &pinion].map(|job| job.finishing().settings.blank_offset_mm);
    let nominal_mm = gear.spec.cones.hypoid_offset_mm;
    assert_eq!(offsets_mm[0] + offsets_mm[1], nominal_mm);
    let running = |off_mm: f64| {
        let [gear, pinion] =
            [&gear.target[BladeKind::Outside.index()], &pinion.target[BladeKind::Inside.index()]].map(Clone::clone);
        let offset_mm = nominal_mm + off_mm;
        let mounting = Mounting { shaft_angle_rad: 0.5 * PI, offset_mm, pinion_axial_mm: 0.0, gear_axial_mm: 0.0 };
        Running::of(&BevelPair { gear, pinion, mounting }, MARKING_MM).expect("they meet")
    };
    let concave = running(0.0);
    let arcsec = ARCSEC_PER_RAD * concave.motion_error_rad();
    let ellipse = concave.middle().ellipse;
    println!("hypoid: {arcsec:e} arc seconds, contact at {:?}, {ellipse:?}", concave.center_mm());
    assert!(arcsec < 0.1, "{arcsec} arc seconds");
    let [long_mm, short_mm] = ellipse.expect("inside the flank").half_axes_mm;
    assert!(long_mm.is_finite() && short_mm < long_mm, "{long_mm} by {short_mm} mm");
    for off_mm in [-0.02, 0.02] {
        let arcsec = ARCSEC_PER_RAD * running(off_mm).motion_error_rad();
        println!("offset {off_mm} mm off: {arcsec} arc seconds");
        assert!(arcsec > 0.1, "{arcsec} arc seconds");
    }
}

/// Points of a cut flank about a place (along the tooth, height over the pitch cone; mm), in the work frame with the
/// normals of their rays: an even patch of `count` by `count` dexels, `step_mm` apart.
fn cut_patch(job: &BevelJob, kind: BladeKind, [along_mm, height_mm]: [f64; 2], count: usize, step_mm: f64) -> Vec<Ray> {
    let side = if job.left == kind { Side::Left } else { Side::Right };
    let target = &job.target[kind.index()];
    let row = target.row(along_mm).expect("a row");
    let share = (height_mm - row.form_height_mm) / (row.tip_height_mm - row.form_height_mm);
    let even = |middle: f64| (0..count).map(|i| middle + step_mm * (i as f64 - 0.5 * (count - 1) as f64)).collect();
    // The tooth whose flank stands in space 0.
    let tooth = if side == Side::Left { job.blank.teeth } else { 1 };
    assert_eq!(job.space_of(tooth, side), 0);
    let rays = job.rays_over(tooth, side, even(target.arc_at(share)), even(along_mm)).expect("rays");
    let (layers, _) = job.cut_field(&Cpu::default(), 0, &rays.field).expect("cuts");
    let heights_mm = &layers.last().expect("an operation").heights_mm;
    let work_from_gear = job.gear_from_work.inverse();
    let point = |i: usize| {
        let ray = rays.field.ray(i / count, i % count);
        let at_mm = ray.at(f64::from(heights_mm[i]));
        Ray { origin_mm: work_from_gear.point(at_mm), normal: work_from_gear.direction(ray.normal) }
    };
    (0..count * count).map(point).collect()
}

/// Brute force, with nothing of the contact search in it: both flanks are cut, the dexels about the contact are turned
/// by the angles that were found, and every point of the gear is compared with the pinion's nearest one.
#[test]
fn cut_flanks_touch_where_the_contact_is_found() {
    // So slow a roll that marks stay below a micrometre's hundredth.
    let slow = "operation.finish.roll_speed_deg_per_s=0.5";
    for [gear, pinion] in [["crown_gear", "crown_pinion"], ["hypoid_crown_gear", "hypoid_crown_pinion"]] {
        let [gear, pinion] = [gear, pinion].map(|name| job(name, &[slow]).expect("a gear"));
        let offset_mm = gear.spec.cones.hypoid_offset_mm;
        let mounting = Mounting { shaft_angle_rad: 0.5 * PI, offset_mm, pinion_axial_mm: 0.0, gear_axial_mm: 0.0 };
        let [gear_flank, pinion_flank] =
            [&gear.target[BladeKind::Outside.index()], &pinion.target[BladeKind::Inside.index()]].map(Clone::clone);
        let pair = BevelPair { gear: gear_flank, pinion: pinion_flank, mounting };
        let [pinion_rad, gear_rad] = pair.middle_rad().expect("a middle");
        let contact = pair.contact(pinion_rad, gear_rad, MARKING_MM).expect("a search that ends").expect("they meet");
        // Axes of both members in one frame: the gear's leans by its pitch angle, the pinion's by its own the other
        // way.
        let [gear_lean, pinion_lean] = [&gear, &pinion].map(|job| DMat3::from_rotation_y(-job.blank.pitch_angle_rad));
        let gear_turn = gear_lean * DMat3::from_rotation_x(contact.gear_rad);
        let pinion_turn = DMat3::from_rotation_x(PI) * pinion_lean * DMat3::from_rotation_x(contact.pinion_rad);
        let beside = offset_mm * DVec3::Y;
        let in_pinion = |at_mm: DVec3| pinion_turn.transpose() * (gear_turn * at_mm - beside);
        let gear_points = cut_patch(&gear, BladeKind::Outside, contact.place_mm, 21, 0.05);
        let middle = in_pinion(gear_points[gear_points.len() / 2].origin_mm);
        let [distance_mm, height_mm] = pinion.blank.cone_distance_and_height_mm(middle);
        let place_mm = [distance_mm - pinion.blank.mean_cone_distance_mm(), height_mm];
        let pinion_points = cut_patch(&pinion, BladeKind::Inside, place_mm, 101, 0.015);
        // The tooth of the pinion that is there: cut in space 0, wanted near the gear's point.
        let turned = |point: DVec3| {
            let polar = |at: DVec3| at.z.atan2(at.y);
            let pitch = TAU / f64::from(pinion.blank.teeth);
            let by = ((polar(middle) - polar(point)) / pitch).round() * pitch;
            DMat3::from_rotation_x(by)
        };
        let turn = turned(pinion_points[pinion_points.len() / 2].origin_mm);
        let pinion_points: Vec<Ray> = pinion_points
            .iter()
            .map(|ray| Ray { origin_mm: turn * ray.origin_mm, normal: turn * ray.normal })
            .collect();
        let gap_mm = |gear_point: &Ray| {
            let at = in_pinion(gear_point.origin_mm);
            let nearest = pinion_points
                .iter()
                .min_by(|a, b| at.distance_squared(a.origin_mm).total_cmp(&at.distance_squared(b.origin_mm)));
            let nearest = nearest.expect("points");
            // Beyond the patch the nearest point is its border.
            let [along, off] = [(at - nearest.origin_mm).dot(nearest.normal), at.distance(nearest.origin_mm)];
            ((off * off - along * along).max(0.0).sqrt() < 0.02).then_some(along)
        };
        let gaps: Vec<f64> = gear_points.iter().filter_map(gap_mm).collect();
        let smallest_mm = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        println!("{}: {} gaps, the smallest {smallest_mm:e} mm", gear.scene.name, gaps.len());
        assert!(gaps.len() > 100, "{}", gaps.len());
        assert!(smallest_mm.abs() < 1e-5, "{smallest_mm:e} mm");
    }
}

/// The pinion of the gear of 2008 follows from a local synthesis: in the mean point the motion error bends as a
/// parabola of 10 arc seconds at half a pitch, the path of contact crosses the trace of the tooth at 115 and 65 deg,
/// and 6.35 um of compound reach 9 mm along the line of contact. Over the pitch the path stays inside of the flank.
#[test]
fn a_synthesised_pinion_runs_as_it_was_chosen() {
    let [gear, convex, concave] = ["five_linkage_corrected", "five_linkage_pinion", "five_linkage_pinion_concave"]
        .map(|name| job(name, &[]).expect("a gear"));
    let (progress, interrupt) = (Progress::new(ProgressMode::Quiet), Interrupt::default());
    let pinions = [&convex, &concave];
    let rolled = roll(&gear, pinions, &MountingErrors::default(), MARKING_MM, (&progress, &interrupt)).expect("met");
    for (side, (mean_mm, chosen_deg)) in rolled.sides.iter().zip([(-0.9_f64, 115.0_f64), (-1.1, 65.0)]) {
        let (running, blades) = (&side.running, side.gear_blades);
        let half_pitch_rad = PI / f64::from(convex.blank.teeth);
        // Second difference about the chosen mean point of what one pair of teeth does.
        let met: Vec<(f64, Contact, f64)> =
            running.teeth.iter().filter_map(|&(at, met)| met.map(|(contact, error)| (at, contact, error))).collect();
        let mean = (1..met.len() - 1).min_by(|&a, &b| {
            let off = |i: usize| (met[i].1.place_mm[1] - mean_mm).abs();
            off(a).total_cmp(&off(b))
        });
        let [before, at, after] = mean.map(|i| [met[i - 1], met[i], met[i + 1]]).expect("contacts");
        let bend = (before.2 + after.2 - 2.0 * at.2) / (after.0 - at.0).powi(2);
        let arcsec = ARCSEC_PER_RAD * 0.5 * bend * half_pitch_rad.powi(2);
        // The path against the trace of the tooth, both in the plane that touches the flank.
        let point = |[along_mm, height_mm]: [f64; 2]| {
            let row = side.pair.gear.row(along_mm).expect("a row");
            let share = (height_mm - row.form_height_mm) / (row.tip_height_mm - row.form_height_mm);
            row.point(share).expect("a point")
        };
        let [along_mm, height_mm] = at.1.place_mm;
        let trace = point([along_mm + 0.1, height_mm]).point_mm - point([along_mm - 0.1, height_mm]).point_mm;
        let up = point([along_mm, height_mm + 0.1]).point_mm - point([along_mm, height_mm - 0.1]).point_mm;
        let across = up - up.project_onto(trace);
        let path = point(after.1.place_mm).point_mm - point(before.1.place_mm).point_mm;
        let path_deg = path.dot(across.normalize()).atan2(path.dot(trace.normalize())).to_degrees().rem_euclid(180.0);
        let [long_mm, _] = at.1.ellipse.expect("inside of the flank").half_axes_mm;
        let parabola = ARCSEC_PER_RAD * running.parabola().expect("21 places").over_pitch_rad();
        let range = ARCSEC_PER_RAD * running.motion_error_rad();
        println!("{}: bend {arcsec}, parabola {parabola}, range {range} arc seconds, {long_mm} mm", blades.flank());
        println!("path at {path_deg} deg, chosen {chosen_deg} deg");
        assert!((path_deg - chosen_deg).abs() < 1.5 && (long_mm - 9.0).abs() < 0.5, "{path_deg} deg, {long_mm} mm");
        // Both sides lag, each in the sense in which it drives.
        assert!((arcsec + 10.0).abs() < 0.1, "{arcsec} arc seconds");
        assert!((parabola + 10.0).abs() < 0.2, "{parabola} arc seconds");
        assert!(range > 9.0 && range < 10.5, "{range} arc seconds");
        let off_mm = running.carrying.iter().map(|(_, contact, _)| contact.place_mm[0].abs()).fold(0.0, f64::max);
        println!("path within {off_mm} mm of the middle");
        assert!(off_mm < 0.8, "{off_mm} mm");
        for (_, contact, _) in &running.carrying {
            let [along_mm, height_mm] = contact.place_mm;
            let row = side.pair.gear.row(along_mm).expect("a row");
            assert!(height_mm > row.form_height_mm + 0.3 && height_mm < row.tip_height_mm - 0.3, "{height_mm} mm");
            let ellipse = contact.ellipse.expect("no edge");
            assert!((ellipse.half_axes_mm[0] - 9.0).abs() < 2.0, "{ellipse:?}");
        }
    }
    // Alive: without its blank offset the pinion does not run so.
    let plain = job("five_linkage_pinion", &["machine.cradle.blank_offset_mm=0"]).expect("a pinion");
    let rolled = roll(&gear, [&plain, &plain], &MountingErrors::default(), MARKING_MM, (&progress, &interrupt));
    assert!(ARCSEC_PER_RAD * rolled.expect("met").sides[0].running.motion_error_rad() > 50.0);
}

/// Signs without a convention: where the gear is ahead by e while the pinion drives it, it is beyond the place of a
/// constant ratio, and flanks turned to that place cut into each other by e times their lever; where it is behind, they
/// are apart by that. And the pinion drives in the sense in which its angles grow: turned on by itself, it cuts in.
#[test]
fn the_gear_is_ahead_in_the_sense_in_which_a_side_drives() {
    let [gear, convex, concave] = ["five_linkage_corrected", "five_linkage_pinion", "five_linkage_pinion_concave"]
        .map(|name| job(name, &[]).expect("a gear"));
    let ratio = f64::from(convex.blank.teeth) / f64::from(gear.blank.teeth);
    for (kind, mate, pinion) in
        [(BladeKind::Outside, BladeKind::Inside, &convex), (BladeKind::Inside, BladeKind::Outside, &concave)]
    {
        let shaft_angle_rad = gear.blank.pitch_angle_rad + pinion.blank.pitch_angle_rad;
        let mounting = Mounting { shaft_angle_rad, offset_mm: 0.0, pinion_axial_mm: 0.0, gear_axial_mm: 0.0 };
        let [gear, pinion] = [gear.target[kind.index()].clone(), pinion.target[mate.index()].clone()];
        let pair = BevelPair { gear, pinion, mounting };
        let running = Running::of(&pair, MARKING_MM).expect("they meet");
        let met: Vec<(f64, Contact, f64)> =
            running.teeth.iter().filter_map(|&(at, met)| met.map(|(contact, error)| (at, contact, error))).collect();
        let (_, middle, _) = *met.iter().find(|(at, ..)| *at == 0.0).expect("the middle");
        for &(at, contact, error) in met.iter().filter(|(at, ..)| at.abs() > 0.05 && at.abs() < 0.16) {
            // Gear and pinion turn in opposite senses.
            let even_rad = middle.gear_rad - ratio * (contact.pinion_rad - middle.pinion_rad);
            let even = Contact { gear_rad: even_rad, ..contact };
            let [found_mm, even_mm] = [contact, even].map(|contact| pair.nearest_mm(&contact, [60, 120]).0);
            // The flanks' normals meet the gear's circle at cos(pressure angle) cos(spiral angle) of its radius.
            let lever_mm = 0.77 * gear_radius_mm(&pair);
            println!("{at}: {} arc seconds, {} um", ARCSEC_PER_RAD * error, 1e3 * (even_mm - found_mm));
            assert!(((even_mm - found_mm) / (-error * lever_mm) - 1.0).abs() < 0.15, "{even_mm}, {error}");
            let sense = at.signum() * (contact.pinion_rad - middle.pinion_rad).signum();
            let on = Contact { pinion_rad: contact.pinion_rad + 1e-3 * sense, ..contact };
            assert!(pair.nearest_mm(&on, [60, 120]).0 < -0.01, "the pinion drives");
        }
    }
}

fn gear_radius_mm(pair: &BevelPair) -> f64 {
    pair.gear.blank.mean_cone_distance_mm() * pair.gear.blank.pitch_angle_rad.sin()
}

/// A pair of teeth is followed as far as it carries: over a pitch the teeth that carry are nowhere behind any that are
/// in contact a pitch or two beside, which are sought afresh; and the curve falls at both ends.
#[test]
fn no_pair_of_teeth_is_let_go_while_it_carries() {
    let rolled = rolled(&jobs(&[]), &MountingErrors::default());
    let convex = &rolled.sides[1];
    let (running, pair) = (&convex.running, &convex.pair);
    let pitch_rad = TAU / f64::from(pair.pinion.blank.teeth);
    let mesh = pair.mesh(MARKING_MM).expect("a middle");
    for &(at_rad, contact, error_rad) in running.carrying.iter().step_by(4) {
        println!(
            "{:.3} deg: {} arc seconds at {:?}",
            at_rad.to_degrees(),
            ARCSEC_PER_RAD * error_rad,
            contact.place_mm
        );
        for pitches in -3..=3 {
            let other = mesh.at(at_rad + pitch_rad * f64::from(pitches), 0.0).expect("a search that ends");
            let ahead_rad = other.map_or(f64::NEG_INFINITY, |(_, other_rad)| other_rad - error_rad);
            assert!(ARCSEC_PER_RAD * ahead_rad < 0.1, "{pitches} pitches beside: {}", ARCSEC_PER_RAD * ahead_rad);
        }
        // Nothing of the gear's flank is in the pinion's.
        let (nearest_mm, place_mm) = pair.nearest_mm(&contact, [100, 200]);
        println!("nearest {nearest_mm:e} mm at {place_mm:?}");
        assert!(nearest_mm > -2e-4, "{nearest_mm:e} mm at {place_mm:?}");
    }
    let met: Vec<f64> = running.teeth.iter().filter_map(|(_, met)| met.map(|(_, error_rad)| error_rad)).collect();
    assert!(met[0] < met[1] && met[met.len() - 1] < met[met.len() - 2], "cut off while it rises");
    let arcsec = ARCSEC_PER_RAD * running.motion_error_rad();
    println!("{arcsec} arc seconds over a pitch");
    assert!(arcsec > 100.0 && arcsec < 250.0, "{arcsec} arc seconds");
}

/// Ctrl-C ends the work between two mountings.
#[test]
fn contact_stops_when_asked() {
    let [gear, pinion] = jobs(&[]);
    let (progress, interrupt) = (Progress::new(ProgressMode::Quiet), Interrupt::default());
    interrupt.raise();
    let stopped = roll(&gear, [&pinion, &pinion], &MountingErrors::default(), MARKING_MM, (&progress, &interrupt));
    assert!(matches!(stopped, Err(gearcut::Error::Interrupted)));
}

#[test]
fn the_command_writes_a_folder_and_refuses_what_is_no_pair() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("pair");
    let [gear, pinion] = ["scenes/bevel/crown_gear.toml", "scenes/bevel/crown_pinion.toml"];
    gearcut(&["contact", gear, pinion, "--e-um", "20", "--out", out.to_str().expect("a path")])
        .done()
        .says(&["motion error, concave", "ellipse, convex"]);
    let results = read_json(&out.join("results.json"));
    assert_is_results(&results);
    assert_eq!(results["process"], "bevel pair");
    for file in ["report.html", "tables/contact_concave.csv", "tables/trends_convex.csv", "pictures/bearing_convex.svg"]
    {
        assert!(out.join(file).is_file(), "{file} is missing");
    }
    // The bearing is filled, and cut off at the flank's outline.
    let bearing = std::fs::read_to_string(out.join("pictures/bearing_concave.svg")).expect("a drawing");
    assert!(bearing.contains("<g clip-path=\"url(#flank)\"") && bearing.matches("<polygon").count() > 10, "{bearing}");
    for (arguments, words) in [
        (vec![pinion, gear], "name the gear first, then the pinion"),
        (vec![gear, gear], "the same hand of spiral"),
        (vec![gear, pinion, "--set-pinion", "gear.module_mm=4.1"], "the gear's outer module is 4.0000 mm"),
        (vec![gear, pinion, "--set-gear", "gear.bevel.mate_teeth=20"], "names a mate with 20 teeth"),
        (vec![gear, "scenes/bevel/hypoid_crown_pinion.toml"], "names an offset of 0 mm, the pinion's 8 mm"),
        (vec![gear, pinion, "--g-um", "5000"], "5000 is not -2000 to 2000"),
        (vec![gear, "scenes/shaping/circular_m3_z24.toml"], "this tool does not cut bevel gears"),
    ] {
        gearcut(&[&["contact"][..], &arguments].concat()).failed(1, &[words]);
    }
}
