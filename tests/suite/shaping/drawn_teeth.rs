//! Cutters whose tooth is drawn: what they cut and generate, against the analytic cutter, cycloids and a sprocket, all
//! written down here.

use super::flank_heights::compare_whole_field;
use gearcut::cut::cpu::Cpu;
use gearcut::drawn_tooth::drawn_words;
use gearcut::process;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::axes_report::OperationAxes;
use gearcut::process::shaping::findings::ring;
use gearcut::process::shaping::gear::ring::{RingFacts, corners_of_any_edge};
use gearcut::process::shaping::target::{FlankEnd, TargetFlank};
use gearcut::terms::Side;
use glam::DVec2;
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

/// Default of `tolerance_um`.
const TOLERANCE_MM: f64 = 1e-3;

fn scene_job(text: &str, contour: Option<(&str, &str)>, settings: &[&str]) -> Result<ShapingJob, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let mut settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    if let Some((name, contour)) = contour {
        let path = folder.path().join(name);
        std::fs::write(&path, contour).expect("written");
        settings.push(format!("tool.shaper_cutter.profile.file=\"{}\"", path.display()));
    }
    let loaded = process::parse(text, "scene.toml", Path::new("."), &settings).map_err(|errors| errors.to_string())?;
    ShapingJob::new(loaded.scene).map_err(|error| error.to_string())
}

/// Points of a contour, given in the blade's frame, as the table of an upright tooth.
pub(super) fn table(points: &[DVec2]) -> String {
    let mut text = String::from("x_mm,y_mm\n");
    for at in points {
        let _ = writeln!(text, "{:.9},{:.9}", -at.y, at.x);
    }
    text
}

/// A chain from the middle of the tip to the left root, with its mirror image before it.
fn both_sides(left: &[DVec2]) -> Vec<DVec2> {
    let right = left.iter().rev().map(|at| DVec2::new(at.x, -at.y));
    right.chain(left.iter().copied()).collect()
}

/// Points along an arc about the origin, the first left out.
fn arc(radius_mm: f64, from_rad: f64, to_rad: f64, count: u32) -> impl Iterator<Item = DVec2> {
    (1..=count)
        .map(move |i| radius_mm * DVec2::from_angle(from_rad + (to_rad - from_rad) * f64::from(i) / f64::from(count)))
}

const MODULE_MM: f64 = 3.0;
pub(super) const ROUND: &str = "[gear]\nmodule_mm = 3\nteeth = 24\nface_width_mm = 4\n\
    [tool.shaper_cutter]\nteeth = 20\n\
    [[operation]]\nname = \"finish\"\nstrokes_per_revolution = 1200\n[operation.infeed.none]\n";

/// The contour of the standard cutter, an involute given as 200 points: 20 teeth of module 3, addendum and dedendum of
/// 1.25 modules, straight along the radius below the base circle.
pub(super) fn involute_contour() -> Vec<DVec2> {
    let alpha = 20_f64.to_radians();
    let pitch_mm = 0.5 * MODULE_MM * 20.0;
    let (base_mm, tip_mm, root_mm) = (pitch_mm * alpha.cos(), pitch_mm + 1.25 * MODULE_MM, pitch_mm - 1.25 * MODULE_MM);
    let half = PI / 40.0 + alpha.tan() - alpha;
    let end = ((tip_mm / base_mm).powi(2) - 1.0).sqrt();
    let involute = |u: f64| base_mm * (1.0 + u * u).sqrt() * DVec2::from_angle(half - (u - u.atan()));
    let flank: Vec<DVec2> = (0..=98).map(|i| involute(end * f64::from(98 - i) / 98.0)).collect();
    let tip = arc(tip_mm, 0.0, flank[0].to_angle(), 6);
    let base = (1..=20).map(|i| DVec2::from_angle(half) * (base_mm + (root_mm - base_mm) * f64::from(i) / 20.0));
    let root = arc(root_mm, half, PI / 20.0, 5);
    let left: Vec<DVec2> = tip.chain(flank.iter().skip(1).copied()).chain(base).chain(root).collect();
    both_sides(&left)
}

/// Largest distance of one target flank from another one, at equal heights over the pitch curve, mm.
fn apart_mm(job: &ShapingJob, flank: &TargetFlank, other: &TargetFlank) -> f64 {
    let places = (1..200).map(|i| flank.at_arc(flank.length_mm() * f64::from(i) / 200.0));
    let off = places.filter_map(|at| {
        let height_mm = job.blank.height(at.point_mm, at.phi_rad).0;
        let (_, there) = other.at_height(&job.blank, height_mm)?;
        Some((at.point_mm - there.point_mm).dot(there.normal).abs())
    });
    off.fold(0.0, f64::max)
}

/// The flank that the analytic cutter generates, also where its tip has undercut it, and on a ring; and heights that
/// both cutters leave on the same rays.
#[test]
fn an_involute_given_as_points_cuts_the_analytic_ones_flank() {
    let contour = table(&involute_contour());
    for (gear, is_undercut) in [
        (["gear.teeth=24", "gear.kind=\"external\""], false),
        (["gear.teeth=11", "gear.kind=\"external\""], true),
        (["gear.teeth=60", "gear.kind=\"internal\""], false),
    ] {
        let analytic = scene_job(ROUND, None, &gear).expect("the standard cutter");
        let drawn = scene_job(ROUND, Some(("tooth.csv", &contour)), &gear).expect("the drawn one");
        for side in [Side::Left, Side::Right] {
            let [flank, expected] = [&drawn, &analytic].map(|job| job.target_flank(2, side));
            let off_mm = apart_mm(&drawn, flank, expected);
            println!("{gear:?} {side:?}: {:.1} nm apart, {:?}", 1e6 * off_mm, flank.undercut);
            assert!(off_mm < TOLERANCE_MM && off_mm > 1e-8, "{gear:?} {side:?}: {off_mm} mm");
            assert_eq!(flank.form_end == FlankEnd::Undercut, is_undercut, "{gear:?} {side:?}");
            // On the ring the straight base below the involute shapes the tips: a drawn flank goes on along it.
            assert_eq!(flank.tip_end, FlankEnd::BlankOutline, "{gear:?} {side:?}");
            let [starts, expected_at] = [flank, expected].map(|flank| flank.form_contact().point_mm.length());
            // An arc that stays within t of a curve over a length l leaves its direction by up to 4 t / l, 1 mrad for
            // half the tolerance and 2 mm, and contacts move by that times their radius of curvature, up to 30 mm.
            assert!((starts - expected_at).abs() < 0.03, "{gear:?} {side:?}: {starts}, {expected_at}");
            let [depth_mm, expected_mm] = [flank, expected].map(|of| of.undercut.map_or(0.0, |cut| cut.depth_mm));
            assert!((depth_mm - expected_mm).abs() < 5.0 * TOLERANCE_MM, "{gear:?}: {depth_mm}, {expected_mm}");
            let [land, expected_land] = [&drawn, &analytic].map(|job| job.target(2).tip_land_mm);
            assert!((land - expected_land).abs() < 3.0 * TOLERANCE_MM, "{land} {expected_land}");
            let field = analytic.flank_field(expected);
            let [ours, theirs] =
                [&drawn, &analytic].map(|job| job.cut(&Cpu::default(), field.clone()).expect("native"));
            let pairs = ours.layers[0].heights_mm.iter().zip(&theirs.layers[0].heights_mm);
            let off = pairs.map(|(a, b)| f64::from((a - b).abs())).skip(4 * field.rows_z_mm.len());
            let cut_mm = off.fold(0.0, f64::max);
            println!("    cut {:.1} nm apart", 1e6 * cut_mm);
            assert!(cut_mm < 1.5 * TOLERANCE_MM, "{gear:?} {side:?}: cut {cut_mm} mm apart");
        }
    }
}

/// Room and depth of the tip corners in rings, on the path of rolling and while the cutter goes in on a spiral, are
/// those of the analytic cutter with its sharp corner. In the smaller ring they cut.
#[test]
fn tip_corners_of_points_come_as_near_to_a_ring_as_the_analytic_ones() {
    let contour = table(&involute_contour());
    let text = ROUND.replace("infeed.none", "infeed.spiral");
    for (teeth, cuts, trims) in [("gear.teeth=60", false, false), ("gear.teeth=26", true, true)] {
        let gear = [teeth, "gear.kind=\"internal\""];
        let analytic = RingFacts::new(&scene_job(&text, None, &gear).expect("the standard cutter"));
        let drawn = scene_job(&text, Some(("tooth.csv", &contour)), &gear).expect("the drawn one");
        let (corner, trimming) = corners_of_any_edge(&drawn);
        let rooms_mm = [corner, analytic.tightest_corner].map(|of| of.expect("a known outline").path.clearance_mm);
        let depths_mm = [trimming, analytic.trimming].map(|of| of.expect("a known outline").depth_mm);
        println!("{teeth}: room {rooms_mm:?}, trimmed {depths_mm:?} mm");
        assert_eq!((rooms_mm[1] < 0.0, depths_mm[1] > 0.01), (cuts, trims), "{teeth}");
        for [ours_mm, theirs_mm] in [rooms_mm, depths_mm] {
            assert!((ours_mm - theirs_mm).abs() < 5.0 * TOLERANCE_MM, "{teeth}: {ours_mm}, {theirs_mm}");
        }
        let said = ring::of_job(&drawn, &OperationAxes::of_job(&drawn)).expect("a ring");
        assert_eq!(ring::warnings(&said, 0.01).len(), usize::from(cuts) + usize::from(trims), "{teeth}");
    }
}

/// The same contour a hundredth of a millimetre thicker is seen.
#[test]
fn a_thicker_contour_is_seen() {
    let moved = involute_contour().into_iter().map(|at| at + DVec2::new(0.0, 0.01 * at.y.signum()));
    let thicker: Vec<DVec2> = moved.filter(|at| at.to_angle().abs() < PI / 20.0).collect();
    let analytic = scene_job(ROUND, None, &[]).expect("the standard cutter");
    let drawn = scene_job(ROUND, Some(("tooth.csv", &table(&thicker))), &[]).expect("the drawn one");
    let off_mm = apart_mm(&drawn, drawn.target_flank(2, Side::Left), analytic.target_flank(2, Side::Left));
    assert!((off_mm - 0.01 * 20_f64.to_radians().cos()).abs() < 2e-3, "{off_mm}");
}

fn cycloid_job(settings: &[&str]) -> ShapingJob {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let scene = process::load(Path::new("scenes/shaping/cycloid.toml"), &settings).expect("the shipped scene").scene;
    ShapingJob::new(scene).expect("it can be cut")
}

/// A pair of cycloids with one rolling circle has a constant ratio: the face of one is rolled out by the circle that
/// rolls out the flank of the other. So the gear has to be the epicycloid of that circle over its pitch circle and the
/// hypocycloid below, each with the closed form of its distance from the point where it crosses the pitch circle.
#[test]
fn a_cycloidal_cutter_generates_the_cycloids_of_its_rolling_circle() {
    let job = cycloid_job(&[]);
    let (pitch_mm, rho_mm) = (24.0, 4.0);
    // How far the cycloid has turned about the axis at a radius, from the pitch circle on.
    let turned_rad = |radius_mm: f64| {
        let center_mm = if radius_mm > pitch_mm { pitch_mm + rho_mm } else { pitch_mm - rho_mm };
        // The triangle of both centres and the point: the angle at the rolling circle's centre, and at the axis.
        let rolled =
            ((center_mm * center_mm + rho_mm * rho_mm - radius_mm * radius_mm) / (2.0 * center_mm * rho_mm)).acos();
        let seen = (rho_mm * rolled.sin() / radius_mm).asin();
        if radius_mm > pitch_mm {
            rho_mm / pitch_mm * rolled - seen
        } else {
            let rolled = PI - rolled;
            rho_mm / pitch_mm * rolled - seen
        }
    };
    let (mut worst_mm, mut compared) = (0.0_f64, 0);
    for side in [Side::Left, Side::Right] {
        let flank = job.target_flank(3, side);
        // The middle of tooth 3 stands at two and a half pitches.
        let middle_rad = 2.5 * PI / 12.0;
        for i in 1..400 {
            let at = flank.at_arc(flank.length_mm() * f64::from(i) / 400.0).point_mm;
            let radius_mm = at.length();
            let inwards = if radius_mm > pitch_mm { -1.0 } else { 1.0 };
            let expected_rad = PI / 48.0 + inwards * turned_rad(radius_mm);
            let found_rad = side.sign() * (at.to_angle() - middle_rad);
            worst_mm = worst_mm.max(radius_mm * (found_rad - expected_rad).abs());
            compared += 1;
        }
    }
    println!("{compared} places, {:.1} nm off", 1e6 * worst_mm);
    assert!(worst_mm < 2.0 * TOLERANCE_MM && worst_mm > 1e-8, "{worst_mm} mm");
}

/// ISO 606, 08B: pitch 12.7 mm, roller of 8.51 mm, roller seat of 0.505 d_1 about the pitch circle over 120 deg.
#[test]
fn a_sprocket_has_the_roller_seat_of_its_standard() {
    let (teeth, cutter_teeth, seat_mm) = (17, 23, 0.505 * 8.51);
    let sprocket_mm = 12.7 / (PI / f64::from(teeth)).sin() / 2.0;
    let module_mm = 2.0 * sprocket_mm / f64::from(teeth);
    let pitch_mm = 0.5 * module_mm * f64::from(cutter_teeth);
    // The tip is the seat's arc about the cutter's pitch circle, then its tangents lead to the root.
    let center = DVec2::new(pitch_mm, 0.0);
    let end = center + seat_mm * DVec2::from_angle(PI / 3.0);
    let tangent = DVec2::from_angle(PI / 3.0).perp();
    let seat = (1..=60).map(|i| center + seat_mm * DVec2::from_angle(PI / 3.0 * f64::from(i) / 60.0));
    let line = (1..=40).map(|i| end + 4.7 * f64::from(i) / 40.0 * tangent);
    let left: Vec<DVec2> = seat.chain(line).collect();
    let text = format!(
        "[gear]\nmodule_mm = {module_mm:.12}\nteeth = {teeth}\nface_width_mm = 4\naddendum_coefficient = 0.3\n\
         [tool.shaper_cutter]\nteeth = {cutter_teeth}\naddendum_coefficient = {:.6}\n[[operation]]\nname = \"finish\"\n\
         strokes_per_revolution = 1700\n[operation.infeed.none]\n",
        seat_mm / module_mm
    );
    let mut chain = both_sides(&left);
    chain.insert(left.len(), center + DVec2::new(seat_mm, 0.0));
    let job = scene_job(&text, Some(("tooth.csv", &table(&chain))), &[]).unwrap_or_else(|why| panic!("{why}"));
    let space_rad = 2.0 * 2.0 * PI / f64::from(teeth);
    let roller = sprocket_mm * DVec2::from_angle(space_rad);
    let points = job.target_root(2, 0.02);
    let flanks = [(2, Side::Left), (3, Side::Right)].map(|(tooth, side)| job.target_flank(tooth, side));
    let on_flanks = flanks
        .iter()
        .flat_map(|flank| (0..100).map(|i| flank.at_arc(flank.length_mm() * f64::from(i) / 100.0).point_mm));
    let (mut worst_mm, mut widest_rad) = (0.0_f64, 0.0_f64);
    for at in points.iter().map(|point| point.point_mm).chain(on_flanks) {
        let off = at - roller;
        let seen_rad = (-roller).angle_to(off).abs();
        if seen_rad < 59.5_f64.to_radians() {
            worst_mm = worst_mm.max((off.length() - seat_mm).abs());
            widest_rad = widest_rad.max(seen_rad);
        }
    }
    println!("seat {:.1} nm off over {:.1} deg", 1e6 * worst_mm, 2.0 * widest_rad.to_degrees());
    assert!(worst_mm < TOLERANCE_MM, "{worst_mm}");
    assert!(widest_rad > 58_f64.to_radians(), "{} deg", widest_rad.to_degrees());
}

/// What no tooth can be taken from, with its place and a way out.
#[test]
fn contours_that_are_no_tooth_are_refused() {
    let good = involute_contour();
    let n = good.len();
    let refused = |name: &str, text: &str, words: &[&str]| {
        let why = scene_job(ROUND, Some((name, text)), &[]).err().unwrap_or_else(|| panic!("{words:?}: taken"));
        for words in words.iter().chain(&["tool.shaper_cutter.", "way out"]) {
            assert!(why.contains(words), "{words} not in: {why}");
        }
    };
    let mut crossed = good.clone();
    crossed.swap(40, 44);
    refused("tooth.csv", &table(&crossed), &["crosses itself at x ", "take the loop out"]);
    refused("tooth.csv", &table(&good).replace("x_mm,y_mm", "x,y"), &["line 1", "header `x,y`"]);
    refused("tooth.csv", "x_mm,y_mm\n1,2\n3;4\n", &["line 3", "`3;4`"]);
    refused("tooth.csv", &table(&good[..n / 2 - 10]), &["from one side of x = 0"]);
    refused("tooth.csv", &table(&good).replace("x_mm,y_mm", "x_in,y_in"), &["pitch circle of 30.000 mm"]);
    let turned: Vec<DVec2> = good.iter().map(|at| DVec2::from_angle(0.2).rotate(*at)).collect();
    refused("tooth.csv", &table(&turned), &["does not lie on a tooth"]);
    let lower: Vec<DVec2> =
        good.iter().map(|at| if at.length() > 33.0 { *at * (33.0 / at.length()) } else { *at }).collect();
    refused("tooth.csv", &table(&lower), &["addendum_coefficient", "write addendum_coefficient = 1.000"]);
    let dxf = |head: &str, lines: &[[DVec2; 2]]| {
        let mut text = format!("{head}0\nSECTION\n2\nENTITIES\n");
        for [a, b] in lines {
            let _ = writeln!(text, "0\nLINE\n8\n0\n10\n{:.9}\n20\n{:.9}\n11\n{:.9}\n21\n{:.9}", -a.y, a.x, -b.y, b.x);
        }
        text + "0\nENDSEC\n0\nEOF\n"
    };
    let mut lines: Vec<[DVec2; 2]> = good.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    let mm = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n";
    let whole = scene_job(ROUND, Some(("tooth.dxf", &dxf(mm, &lines))), &[]).expect("a drawing in mm");
    let points = scene_job(ROUND, Some(("tooth.csv", &table(&good))), &[]).expect("a table");
    assert_eq!(whole.cutter.drawn().map(|own| own.parts.len()), points.cutter.drawn().map(|own| own.parts.len()));
    // A symmetric contour has symmetric arcs, to the digits of the table.
    let parts = &points.cutter.drawn().expect("a contour").parts;
    for (left, right) in parts.iter().zip(parts.iter().rev()) {
        let [from, to] = [left.law.at(0.0).point_mm, right.law.at(1.0).point_mm];
        assert!(from.distance(DVec2::new(to.x, -to.y)) < 1e-8, "{from} {to}");
    }
    refused("tooth.dxf", &dxf("", &lines), &["does not say what its unit is", "$INSUNITS"]);
    let circle = "0\nCIRCLE\n8\n0\n10\n0.0\n20\n0.0\n40\n30.0\n0\nENDSEC\n0\nEOF\n";
    let beside = dxf(mm, &lines).replace("0\nENDSEC\n0\nEOF\n", circle);
    refused("tooth.dxf", &beside, &["a closed curve, such as a circle, lies beside the open contour", "TOOTH"]);
    lines[60][0] += DVec2::new(0.0, 1e-3);
    refused("tooth.dxf", &dxf(mm, &lines), &["the contour is open at x ", "a gap of 0.0010 mm", "join its ends"]);
}

/// Keys that would shape or shift another tooth are no keys of a drawn one.
#[test]
fn keys_of_involute_teeth_are_refused_beside_a_contour() {
    let contour = table(&involute_contour());
    for setting in [
        "tool.shaper_cutter.dedendum_coefficient=1.3",
        "tool.shaper_cutter.thinning_mm=0.1",
        "tool.shaper_cutter.profile_shift_coefficient=0.1",
        "tool.shaper_cutter.tip.round.radius_mm=0.3",
        "gear.profile_shift_coefficient=0.2",
        "gear.tooth_thickness_allowance_mm=-0.1",
        "measure.iso_1328_class=6",
    ] {
        let why = scene_job(ROUND, Some(("tooth.csv", &contour)), &[setting]).err();
        let why = why.unwrap_or_else(|| panic!("{setting}: taken"));
        assert!(why.contains("profile.file draws"), "{setting}: {why}");
    }
}

/// A cutter measured every 0.02 mm with a scatter of 3 um to either side: smoothed within 10 um, its flanks are those
/// of the analytic cutter, nearer than single points are.
#[test]
fn a_measured_contour_is_smoothed_within_its_tolerance() {
    const SCATTER_MM: f64 = 3e-3;
    let chain = involute_contour();
    let mut points = Vec::new();
    for pair in chain.windows(2) {
        let count = (pair[0].distance(pair[1]) / 0.02).ceil();
        points.extend((0..count as u32).map(|i| pair[0].lerp(pair[1], f64::from(i) / count)));
    }
    points.extend(chain.last());
    let mut state = 1_u64;
    let mut even = || {
        // Knuth's linear congruential numbers of 64 bits (MMIX), the upper half.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 32) as f64 / (1_u64 << 31) as f64 - 1.0
    };
    let edge = PI / 20.0;
    let noisy: Vec<DVec2> = points
        .iter()
        .map(|&at| at + SCATTER_MM * DVec2::new(even(), even()))
        .map(|at| DVec2::from_angle(at.to_angle().clamp(-edge, edge)) * at.length())
        .collect();
    let analytic = scene_job(ROUND, None, &[]).expect("the standard cutter");
    let settings = ["tool.shaper_cutter.profile.tolerance_um=10"];
    let measured =
        scene_job(ROUND, Some(("tooth.csv", &table(&noisy))), &settings).unwrap_or_else(|why| panic!("{why}"));
    let own = measured.cutter.drawn().expect("drawn");
    println!("{} parts, {}", own.parts.len(), drawn_words(own));
    for side in [Side::Left, Side::Right] {
        let off_mm = apart_mm(&measured, measured.target_flank(2, side), analytic.target_flank(2, side));
        println!("{side:?}: {:.2} um", 1e3 * off_mm);
        assert!(off_mm < SCATTER_MM && off_mm > 1e-5, "{off_mm}");
    }
}

/// A hollow 0.15 mm deep and 0.3 mm long on the flank of a cutter would shape a bump that runs back on itself.
#[test]
fn a_flank_that_runs_back_is_refused() {
    let hollow = |at: &DVec2| {
        let deep = 0.15 * (-((at.length() - 31.0) / 0.15).powi(2)).exp();
        *at - DVec2::new(0.0, deep * at.y.signum())
    };
    let points: Vec<DVec2> = involute_contour().iter().map(hollow).collect();
    let job = scene_job(ROUND, Some(("tooth.csv", &table(&points))), &["tool.shaper_cutter.profile.tolerance_um=5"]);
    let Err(why) = job else { panic!("no flank goes on over such a bump") };
    assert!(why.contains("runs back on itself") && why.contains("profile.file"), "{why}");
}

/// Tests of more than some ten seconds.
mod slow {
    use super::*;

    #[test]
    fn a_cut_by_a_hollow_edge_equals_brute_force() {
        // Nine rows, one more than a vector: rows of strokes that do not feed are alike.
        let rows = ["gear.face_width_mm=2.0", "fields.flank.lead_spacing_um=250"];
        let job = cycloid_job(&[&rows[..], &["operation.finish.strokes_per_revolution=600"]].concat());
        assert!(!job.cutter.edge().is_convex, "cycloids are hollow below the pitch circle");
        for (tooth, side) in [(1, Side::Left), (7, Side::Right)] {
            let field = job.flank_field(job.target_flank(tooth, side));
            for operation in &job.operations {
                compare_whole_field(&job, &field, operation);
            }
        }
        compare_whole_field(&job, &job.root_field(2), job.finishing());
    }
}
