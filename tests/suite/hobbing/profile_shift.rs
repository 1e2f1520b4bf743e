//! Profile shift as large as gears have it: flanks against the closed form of the involute, their beginning against
//! that of ISO 21771, whole sections against the rack that rolls past them, and what the hob cuts.

use gearcut::cut::cpu::Cpu;
use gearcut::job::{CylindricalGear, GearJob};
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::terms::Side;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::path::Path;

const SPUR: &str = "scenes/hobbing/circular_spur.toml";
const HELICAL: &str = "scenes/hobbing/circular_helical.toml";

const SHIFTS: [f64; 5] = [-0.5, 0.0, 0.7, 0.9, 1.2];

fn job(scene: &str, settings: &[String]) -> HobbingJob {
    let scene = load(Path::new(scene), settings).unwrap_or_else(|problems| panic!("{problems}")).scene;
    HobbingJob::new(&scene).expect("a gear")
}

fn involute(angle_rad: f64) -> f64 {
    angle_rad.tan() - angle_rad
}

/// Half the angle of a tooth at a radius of an involute gear: s / d + inv(alpha_t) - inv(alpha_y), cos(alpha_y) = r_b /
/// r, with s = pi m_t / 2 + 2 x m_n tan(alpha_t) (ISO 21771).
fn half_angle_rad(job: &HobbingJob, radius_mm: f64) -> f64 {
    let gear = &job.scene.gear;
    let (m_t, alpha_t) = (gear.transverse_module_mm(), gear.transverse_pressure_angle_rad());
    let diameter_mm = m_t * f64::from(gear.teeth);
    let thickness_mm = 0.5 * PI * m_t + 2.0 * gear.profile_shift_coefficient * gear.module_mm * alpha_t.tan();
    let at_rad = (0.5 * diameter_mm * alpha_t.cos() / radius_mm).acos();
    thickness_mm / diameter_mm + involute(alpha_t) - involute(at_rad)
}

/// Flanks of the target and of its sections are involutes from their beginning up to the tip, whichever shift lifts or
/// lowers them.
#[test]
fn flanks_are_involutes_up_to_the_tip() {
    let helical = [-0.5, 0.7, 1.2].map(|shift| (HELICAL, shift));
    for (scene, shift) in SHIFTS.map(|shift| (SPUR, shift)).into_iter().chain(helical) {
        let job = job(scene, &[format!("gear.profile_shift_coefficient={shift}"), "gear.face_width_mm=6".to_owned()]);
        let gear = HobCutter::new(&job).expect("passes");
        let round = gear.round_gear().expect("flanks").expect("it is round");
        let teeth = f64::from(job.scene.gear.teeth);
        let off_um = |point: DVec2| {
            let radius_mm = point.length();
            1e3 * radius_mm * ((point.to_angle() - PI / teeth).abs() - half_angle_rad(&job, radius_mm))
        };
        let [form_mm, tip_mm] = [round.form_diameter_mm, round.tip_diameter_mm].map(|d| 0.5 * d);
        let patch = gear.even_arcs_mm(1, Side::Left, 0.2).expect("a flank");
        let patch = gear.target_points(1, Side::Left, &patch, &[0.0]).expect("a flank");
        let of_patch: Vec<DVec2> = patch[0].iter().map(|ray| ray.origin_mm.truncate()).collect();
        let of_section = job.tooth_section(1, 0.0, 0.2).tooth_mm;
        for points in [of_patch, of_section] {
            // The tip land lies at the tip radius.
            let on_flank = points.iter().filter(|point| point.length() < tip_mm - 1e-6);
            let worst_um = on_flank.clone().map(|&point| off_um(point).abs()).fold(0.0, f64::max);
            let [low_mm, high_mm] =
                [f64::min, f64::max].map(|of| on_flank.clone().map(|point| point.length()).reduce(of).expect("points"));
            println!("{scene}, x {shift}: {worst_um:.1e} um from {low_mm:.3} to {high_mm:.3} mm");
            assert!(worst_um < 1e-4, "{scene}, x {shift}: {worst_um} um");
            assert!(low_mm < form_mm + 0.2 && high_mm > tip_mm - 0.25, "{low_mm} to {high_mm} mm");
        }
    }
}

/// d_Ff = sqrt(d_b^2 + (d sin(alpha_t) - 2 h / sin(alpha_t))^2), h the depth of the straight flank's end under the
/// pitch line (ISO 21771, generation by a rack): above that line, too, where nothing is undercut.
#[test]
fn the_form_diameter_moves_with_the_shift() {
    let (teeth, m, beta) = (31.0, 2.5, 12_f64.to_radians());
    let (d, alpha_t) = (teeth * m / beta.cos(), (20_f64.to_radians().tan() / beta.cos()).atan());
    for (shift, tip_radius_mm) in SHIFTS.iter().flat_map(|&shift| [0.0, 0.5, 0.95].map(|radius_mm| (shift, radius_mm)))
    {
        let job = job(
            HELICAL,
            &[
                format!("gear.profile_shift_coefficient={shift}"),
                format!("tool.hob.tip_radius_mm={tip_radius_mm}"),
                "gear.teeth=31".to_owned(),
                "gear.module_mm=2.5".to_owned(),
                "gear.helix_angle_deg=12".to_owned(),
                "gear.face_width_mm=6".to_owned(),
            ],
        );
        let form = job.target.form_point(&job.blank, 1, Side::Left, 0.0);
        let addendum_mm = job.hob.tip_radius_mm - job.hob.pitch_radius_mm;
        let depth_mm = addendum_mm - shift * m - tip_radius_mm * (1.0 - alpha_t.sin());
        let form_mm = (d * alpha_t.cos()).hypot(d * alpha_t.sin() - 2.0 * depth_mm / alpha_t.sin());
        let error_mm = d + 2.0 * form.height_mm - form_mm;
        println!("x {shift}, tip radius {tip_radius_mm} mm: d_Ff {form_mm:.4} mm, {error_mm:.1e} mm off");
        assert!(error_mm.abs() < 1e-6 && !form.undercut, "x {shift}, tip radius {tip_radius_mm} mm: {form:?}");
    }
}

/// Signed distance from a rack's tooth, its middle at x = 0, y out of the gear: that of the trapezoid inside it around
/// which the tip round runs.
fn from_rack_mm(job: &HobbingJob, place: DVec2) -> f64 {
    let rack = &job.target.rack;
    let (sin, cos) = rack.pressure_angle_rad.sin_cos();
    let at = DVec2::new(place.x.abs(), place.y);
    let radius_mm = rack.tip_radius_mm;
    let from_flank = (at.x - rack.half_thickness_mm) * cos - at.y * sin + radius_mm;
    let from_tip = -rack.tip_height_mm - at.y + radius_mm;
    // The corner of the inner trapezoid, and whether the place looks at it between both normals.
    let corner_y = radius_mm - rack.tip_height_mm;
    let corner = DVec2::new(rack.half_thickness_mm + (corner_y * sin - radius_mm) / cos, corner_y);
    let to = at - corner;
    let [beside_tip, beside_flank] = [to.x > 0.0, to.dot(DVec2::new(sin, cos)) < 0.0];
    let inner_mm = if beside_tip && beside_flank { to.length() } else { from_flank.max(from_tip) };
    inner_mm - radius_mm
}

/// Nothing of a section lies within the rack anywhere while it rolls past, and the rack touches every point of flank
/// and root: fillets as well whose round has its centre above the pitch line or on it. No flank is touched farther from
/// the pitch point than the hob is made to reach.
#[test]
fn the_rolling_rack_touches_every_point_of_a_section() {
    let oval = &["gear.pitch_curve.ellipse={order=2,eccentricity=0.08}"][..];
    let round = &[][..];
    let undercut = &["gear.teeth=14"][..];
    for (scene, curve, shift, tip_radius_mm) in [
        (SPUR, round, -0.5, 0.6),
        (SPUR, round, 0.0, 1.14),
        (SPUR, round, 0.9, 1.14),
        (SPUR, round, 0.87, 1.14),
        (SPUR, round, 1.2, 0.6),
        (SPUR, round, 1.3, 0.0),
        (SPUR, undercut, -0.2, 0.6),
        (SPUR, undercut, 0.0, 0.0),
        (SPUR, oval, -0.3, 0.6),
        (SPUR, oval, 0.9, 1.14),
        (HELICAL, round, -0.5, 0.6),
        (HELICAL, round, 0.7, 0.6),
        (HELICAL, round, 0.9, 1.0),
        (HELICAL, round, 1.2, 1.0),
    ] {
        let mut settings = vec![
            format!("gear.profile_shift_coefficient={shift}"),
            format!("tool.hob.tip_radius_mm={tip_radius_mm}"),
            "gear.face_width_mm=6".to_owned(),
        ];
        settings.extend(curve.iter().map(|&set| set.to_owned()));
        let job = job(scene, &settings);
        let z_mm = 1.7;
        let section = job.tooth_section(1, z_mm, 0.3);
        let tip_mm = job.blank.addendum_mm;
        let is_flank = |p: &&DVec2| job.blank.height(**p, p.to_angle()).0 < tip_mm - 1e-6;
        let arcs_mm = [0, 1].map(|space| job.target.space_arc_mm(space, z_mm));
        let middle_rad = job.curve.phi_at_arc(0.5 * (arcs_mm[0] + arcs_mm[1]));
        let (mut farthest_um, mut touched_mm) = ([0.0_f64; 2], 0.0_f64);
        // Right flanks lie in the space before the tooth.
        let flanks = section.tooth_mm.iter().filter(is_flank).map(|&p| (p, usize::from(p.to_angle() > middle_rad)));
        for (point, space) in flanks.chain(section.root_mm.iter().map(|&p| (p, 1))) {
            // The point as seen from the pitch point.
            let seen_mm = |rolled_mm: f64| {
                let frame = job.curve.frame(job.curve.phi_at_arc(rolled_mm));
                let from = point - frame.point_mm;
                DVec2::new(from.dot(frame.tangent), from.dot(frame.normal))
            };
            let gap_mm = |rolled_mm: f64| {
                let along = DVec2::new(rolled_mm - arcs_mm[space], 0.0);
                from_rack_mm(&job, seen_mm(rolled_mm) + along)
            };
            // The whole way of a rack past a space, then the nearest place of it closer and closer.
            let (mut middle_mm, mut step_mm) = (arcs_mm[space], 0.1);
            for _ in 0..6 {
                let places = (-250..=250).map(|i| middle_mm + step_mm * f64::from(i));
                middle_mm = places.min_by(|&a, &b| gap_mm(a).total_cmp(&gap_mm(b))).expect("places");
                step_mm *= 0.02;
            }
            let gap_um = 1e3 * gap_mm(middle_mm);
            farthest_um = [farthest_um[0].min(gap_um), farthest_um[1].max(gap_um)];
            touched_mm = touched_mm.max(seen_mm(middle_mm).x.abs());
        }
        let what = format!("{scene} {curve:?}, x {shift}, tip radius {tip_radius_mm} mm");
        let operation = job.finishing();
        let reach_mm = operation.plan.contact_half_length_mm * operation.linkage.geometry().head_angle_rad.cos();
        println!("{what}: {farthest_um:?} um, touched within {touched_mm:.3} of {reach_mm:.3} mm");
        assert!(farthest_um[0] > -1e-4 && farthest_um[1] < 1e-4, "{what}: {farthest_um:?} um");
        assert!(touched_mm < reach_mm, "{what}: {touched_mm} of {reach_mm} mm");
    }
}

/// Fillets end where their flanks begin, on every tooth: no tooth is as another one to the last digit.
#[test]
fn fillets_join_their_flanks_on_every_tooth() {
    for (scene, shift) in [(HELICAL, 0.0), (HELICAL, 0.9), (SPUR, -0.5), (SPUR, 1.2)] {
        let job = job(scene, &[format!("gear.profile_shift_coefficient={shift}"), "gear.face_width_mm=6".to_owned()]);
        let teeth = job.scene.gear.teeth;
        let (mut apart_mm, mut shortest_mm) = (0.0_f64, f64::INFINITY);
        for z_mm in [-2.9, -1.3, 0.0, 0.4, 2.2] {
            let sections: Vec<_> = (1..=teeth).map(|tooth| job.tooth_section(tooth, z_mm, 0.5)).collect();
            for (section, next) in sections.iter().zip(sections.iter().cycle().skip(1)) {
                let (root, [tooth, next]) = (&section.root_mm, [section, next].map(|of| &of.tooth_mm));
                apart_mm = apart_mm.max(root[0].distance(tooth[tooth.len() - 1]));
                apart_mm = apart_mm.max(root[root.len() - 1].distance(next[0]));
                shortest_mm = shortest_mm.min(root.windows(2).map(|pair| pair[0].distance(pair[1])).sum());
            }
        }
        println!("{scene}, x {shift}: {apart_mm:.1e} mm apart, roots at least {shortest_mm:.3} mm long");
        assert!(apart_mm < 1e-9, "{scene}, x {shift}: {apart_mm} mm");
    }
}

/// What the hob leaves of a shifted gear lies over its target by marks alone: flanks up to the tip, and the root, which
/// x = 1.2 lifts to the pitch line.
#[test]
fn a_shifted_gear_is_cut_to_its_target() {
    for shift in [0.9, 1.2] {
        let job = job(SPUR, &["gear.face_width_mm=6".to_owned(), format!("gear.profile_shift_coefficient={shift}")]);
        let cutter = HobCutter::new(&job).expect("passes");
        let within = |what: &str, heights_um: &[f64]| {
            let [low_um, high_um] =
                [f64::min, f64::max].map(|of| heights_um.iter().copied().reduce(of).expect("points"));
            println!("x {shift}, {what}: {low_um:.2} to {high_um:.2} um");
            assert!(low_um > -1.0 && high_um < 10.0, "x {shift}, {what}: {low_um} to {high_um} um");
        };
        for side in [Side::Left, Side::Right] {
            let arcs_mm = cutter.even_arcs_mm(1, side, 0.3).expect("a flank");
            let layers = cutter.cut_flank(&Cpu::default(), 1, side, &arcs_mm, &[-1.1, 0.7]).expect("native");
            let heights_um: Vec<f64> = layers[0].heights_mm.iter().map(|&mm| 1e3 * f64::from(mm)).collect();
            within(side.name(), &heights_um);
        }
        let (spacing_mm, rows_mm) = (0.1, [-1.1, 0.7]);
        let target = cutter.target_roots(1, spacing_mm, &rows_mm).expect("a root");
        let cut = cutter.cut_root(&Cpu::default(), 1, spacing_mm, &rows_mm).expect("native");
        // A ray goes to the middle of the space, across the root or along it.
        let over =
            |(point, (target, normal)): (&DVec2, &(DVec2, DVec3))| 1e3 * (*point - *target).dot(normal.truncate());
        let heights_um: Vec<f64> = cut.iter().flatten().zip(target.iter().flatten()).map(over).collect();
        within("root", &heights_um);
    }
}
