//! Hobs whose tooth is drawn: what they cut and generate, against the analytic hob, a parallel-sided spline and a
//! cycloid, all written down here.

use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::{Layer, SpatialField};
use gearcut::passes::SweepPlan;
use gearcut::process;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::terms::Side;
use gearcut::tool::CuttingTool;
use glam::DVec2;
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

const TOLERANCE_MM: f64 = 1e-3;
const MODULE_MM: f64 = 3.0;
const ROUND: &str = "[gear]\nmodule_mm = 3\nteeth = 24\nface_width_mm = 4\n[tool.hob]\nreference_diameter_mm = 60\n\
    length_mm = 50\ntip_radius_mm = 0\n[fields.flank]\nprofile_spacing_um = 400\nlead_spacing_um = 1000\n\
    [[operation]]\nname = \"finish\"\naxial_feed_mm_per_revolution = 4\n[operation.linkage.hobbing]\n";

pub(crate) fn scene_job(text: &str, contour: Option<(&str, &str)>, settings: &[&str]) -> Result<HobbingJob, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let mut settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let mut text = text.to_owned();
    if let Some((name, contour)) = contour {
        let path = folder.path().join(name);
        std::fs::write(&path, contour).expect("written");
        settings.push(format!("tool.hob.profile.file=\"{}\"", path.display()));
        text = text.replace("tip_radius_mm = 0\n", "");
    }
    let loaded = process::parse(&text, "scene.toml", Path::new("."), &settings).map_err(|errors| errors.to_string())?;
    HobbingJob::new(&loaded.scene).map_err(|error| error.to_string())
}

/// The table of a symmetric contour by its right half in the file, (x, y) from the tip's middle to the root.
fn table(half: &[[f64; 2]]) -> String {
    let mut text = String::from("x_mm,y_mm\n");
    let left = half.iter().rev().map(|&[x, y]| [-x, y]);
    for [x, y] in left.chain(half.iter().copied().filter(|at| at[0] > 0.0)) {
        let _ = writeln!(text, "{x:.12},{y:.12}");
    }
    text
}

/// The standard rack by lines: 20 deg, addendum and dedendum of 1.25 modules.
fn rack(flank_points: u32) -> Vec<[f64; 2]> {
    let half = |y: f64| 0.25 * PI * MODULE_MM - y * 20_f64.to_radians().tan();
    let top = 1.25 * MODULE_MM;
    let flank = (0..=flank_points).map(|i| top - 2.0 * top * f64::from(i) / f64::from(flank_points));
    flank.map(|y| [half(y), y]).collect()
}

/// Largest distance of two jobs' targets at equal heights over the pitch curve, mm, and where each begins.
fn targets_apart_mm(drawn: &HobbingJob, other: &HobbingJob, side: Side, z_mm: f64) -> f64 {
    let [own, their] = [drawn, other].map(|job| HobCutter::new(job).expect("passes"));
    let [flank, expected] = [&own, &their].map(|cutter| cutter.target(2, side).expect("a target"));
    let [section, there] = [flank, expected].map(|flank| flank.section(z_mm));
    let height_mm = |at: DVec2| drawn.blank.height(at, at.to_angle()).0;
    let mut worst_mm = 0.0_f64;
    for i in 1..60 {
        let at = section.ray(f64::from(i) / 60.0);
        let height = height_mm(at.origin_mm.truncate());
        let (mut low, mut high) = (0.0, 1.0);
        if height_mm(there.ray(0.0).origin_mm.truncate()) > height {
            continue;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if height_mm(there.ray(middle).origin_mm.truncate()) < height { low = middle } else { high = middle }
        }
        let expected = there.ray(low);
        worst_mm = worst_mm.max((at.origin_mm - expected.origin_mm).dot(expected.normal).abs());
        assert!(at.normal.distance(expected.normal) < 5e-3, "{} {}", at.normal, expected.normal);
    }
    worst_mm
}

/// Heights that a job leaves on a field.
fn cut(job: &HobbingJob, field: &SpatialField) -> Layer {
    let cutter = HobCutter::new(job).expect("passes");
    cutter.cut_field(&Cpu::default(), field).expect("native").0.pop().expect("one operation")
}

fn cuts_apart_mm(drawn: &HobbingJob, other: &HobbingJob, side: Side) -> f64 {
    let cutter = HobCutter::new(other).expect("passes");
    let field = cutter.rays(2, side).expect("rays").1.field;
    let [own, their] = [drawn, other].map(|job| cut(job, &field));
    // The first columns stand where the fillet begins: a corner's path bends there.
    let from = 2 * field.rows();
    let all = (0..field.len()).filter(|index| !(0..2).any(|c| (0..field.rows()).any(|r| field.index(c, r) == *index)));
    assert!(field.len() > 2 * from);
    all.map(|i| f64::from((own.heights_mm[i] - their.heights_mm[i]).abs())).fold(0.0, f64::max)
}

/// Lines alone in the axial section of axial gashes: the analytic hob, to rounding, in edge, target and cut.
#[test]
fn lines_alone_are_the_straight_sided_hob() {
    let worm = "tool.hob.worm=\"straight_sided\"";
    let analytic = scene_job(ROUND, None, &[worm]).expect("the standard hob");
    let drawn = scene_job(ROUND, Some(("tooth.csv", &table(&rack(1)))), &[worm]).expect("the drawn one");
    let flanks = |job: &HobbingJob| -> Vec<[DVec2; 2]> {
        let ends = job
            .hob
            .edges()
            .segments()
            .iter()
            .map(|of| of.y_range_mm.map(|y| of.blade_from_segment.point(DVec2::new(of.x_and_slope(y)[0], y))));
        ends.filter(|[a, b]| (a.x - b.x).abs() > 1.0 || (a.y + b.y).abs() < 1e-9).collect()
    };
    let [own, their] = [&drawn, &analytic].map(flanks);
    assert_eq!((own.len(), their.len()), (3, 3), "two flanks and a tip");
    for (a, b) in own.iter().flatten().zip(their.iter().flatten()) {
        assert!(a.distance(*b) < 1e-11, "{a} {b}");
    }
    for side in [Side::Left, Side::Right] {
        let off_mm = targets_apart_mm(&drawn, &analytic, side, 0.0);
        assert!(off_mm < 2e-9, "{off_mm} mm");
        let cut_mm = cuts_apart_mm(&drawn, &analytic, side);
        assert!(cut_mm < 1e-9, "{cut_mm} mm");
    }
    for radius_mm in [27.0, 30.0, 33.0] {
        let [own, their] = [&drawn, &analytic].map(|job| job.hob.half_thickness_mm(radius_mm));
        assert!((own - their).abs() < 1e-9, "{own} {their}");
    }
    let reach = [&drawn, &analytic].map(|job| job.finishing().plan.contact_half_length_mm);
    assert!((reach[0] - reach[1]).abs() < 1e-9, "{reach:?}");
}

/// The thread that generates with a straight rack is the involute worm, also with a steep lead, gashes across the
/// thread and a helical gear.
#[test]
fn a_straight_rack_gives_the_involute_worm() {
    let steep = ["tool.hob.starts=3", "tool.hob.gash_form=\"helical\"", "gear.helix_angle_deg=15"];
    let points = rack(120);
    for (settings, contour, target_mm, cut_mm) in [
        (&[][..], rack(1), 2e-9, 2e-7),
        (&steep[..], rack(1), 2e-9, 2e-7),
        (&steep[..1], points, TOLERANCE_MM, TOLERANCE_MM),
    ] {
        let analytic = scene_job(ROUND, None, settings).expect("the standard hob");
        let drawn = scene_job(ROUND, Some(("tooth.csv", &table(&contour))), settings).unwrap_or_else(|e| panic!("{e}"));
        for side in [Side::Left, Side::Right] {
            for z_mm in [0.0, 1.5] {
                let off_mm = targets_apart_mm(&drawn, &analytic, side, z_mm);
                assert!(off_mm < target_mm, "{settings:?} {side:?}: {off_mm} mm");
            }
            let off_mm = cuts_apart_mm(&drawn, &analytic, side);
            println!("{settings:?} {side:?}: cut {:.3} nm apart", 1e6 * off_mm);
            assert!(off_mm < cut_mm, "{settings:?} {side:?}: cut {off_mm} mm apart");
        }
    }
}

/// A contour that is a hundredth of a millimetre thicker is seen in target and cut.
#[test]
fn a_thicker_contour_is_seen() {
    let thicker: Vec<[f64; 2]> = rack(1).into_iter().map(|[x, y]| [x + 0.01, y]).collect();
    let thicker: Vec<[f64; 2]> = thicker.into_iter().map(|[x, y]| [x.min(0.5 * PI * MODULE_MM), y]).collect();
    let analytic = scene_job(ROUND, None, &[]).expect("the standard hob");
    let drawn = scene_job(ROUND, Some(("tooth.csv", &table(&thicker))), &[]).expect("the drawn one");
    let expected_mm = 0.01 * 20_f64.to_radians().cos();
    let off_mm = targets_apart_mm(&drawn, &analytic, Side::Left, 0.0);
    assert!((off_mm - expected_mm).abs() < 1e-4, "{off_mm}");
    let cut_mm = cuts_apart_mm(&drawn, &analytic, Side::Left);
    assert!((cut_mm - expected_mm).abs() < 3e-4, "{cut_mm}");
}

/// The rack of a shaft with parallel sides, file's frame, from its tip to its root: the pitch point is (0, R), the
/// middle plane of a tooth stands at the angle t behind it, and its side, `half_mm` before that plane, touches in the
/// foot of the perpendicular from the pitch point, (R sin t - half) (cos t, -sin t) from there. The middle of the
/// rack's tooth has gone on by R (t - half a pitch).
fn spline_rack(pitch_mm: f64, teeth: f64, half_mm: f64, top_mm: f64) -> Vec<[f64; 2]> {
    let place = |t: f64| {
        let away = pitch_mm * t.sin() - half_mm;
        [away * t.cos() - pitch_mm * (t - PI / teeth), away * t.sin()]
    };
    // Heights away sin(t): that of the tip, and down to where the sides no longer touch.
    let angle = |height_mm: f64| {
        ((half_mm + (half_mm * half_mm + 4.0 * pitch_mm * height_mm).sqrt()) / (2.0 * pitch_mm)).asin()
    };
    let (from, to) = (angle(top_mm), angle(-0.24 * half_mm * half_mm / pitch_mm));
    (0..=200).map(|i| place(from + (to - from) * f64::from(i) / 200.0)).collect()
}

/// A contour that is no straight rack: its gear has parallel sides, at half their distance from the tooth's middle
/// plane.
#[test]
fn a_spline_hob_leaves_parallel_sides() {
    let (pitch_mm, teeth, half_mm, top_mm) = (30.0, 6, 11.5, 2.5);
    let text = format!(
        "[gear]\nmodule_mm = 10\nteeth = {teeth}\nface_width_mm = 3\naddendum_coefficient = 0.1\n[tool.hob]\n\
        reference_diameter_mm = 120\nlength_mm = 100\naddendum_coefficient = 0.25\n[fields.flank]\n\
        profile_spacing_um = 150\nlead_spacing_um = 500\n[[operation]]\nname = \"finish\"\n\
        axial_feed_mm_per_revolution = 1\n[operation.linkage.hobbing]\n"
    );
    let contour = table(&spline_rack(pitch_mm, f64::from(teeth), half_mm, top_mm));
    let job = scene_job(&text, Some(("tooth.csv", &contour)), &[]).unwrap_or_else(|why| panic!("{why}"));
    let cutter = HobCutter::new(&job).expect("passes");
    let middle = DVec2::from_angle(1.5 * 2.0 * PI / f64::from(teeth));
    for side in [Side::Left, Side::Right] {
        let target = cutter.target(2, side).expect("a target");
        assert!(target.length_mm() > 2.0, "{} mm", target.length_mm());
        let off = (0..=100).map(|i| {
            let at = target.section(0.0).ray(f64::from(i) / 100.0).origin_mm.truncate();
            (middle.perp_dot(at).abs() - half_mm).abs()
        });
        let off_mm = off.fold(0.0, f64::max);
        assert!(off_mm < TOLERANCE_MM && off_mm > 1e-8, "{off_mm} mm");
        let left = cut(&job, &cutter.rays(2, side).expect("rays").1.field);
        let heights = left.heights_mm.iter().map(|&height_mm| f64::from(height_mm));
        let (low, high) = heights.fold((f64::INFINITY, 0.0_f64), |(low, high), h| (low.min(h), high.max(h)));
        println!("{side:?}: {:.1} nm off, cut {:.2} to {:.2} um over it", 1e6 * off_mm, 1e3 * low, 1e3 * high);
        assert!(low > -TOLERANCE_MM && low < TOLERANCE_MM && high < 0.03, "{low} {high}");
    }
}

/// The rack that a circle of 4 mm rolls out on both sides of the pitch line of module 2.
fn cycloid_rack(rho_mm: f64) -> Vec<[f64; 2]> {
    let place = |t: f64| [0.5 * PI - rho_mm * (t - t.sin()), rho_mm * (1.0 - t.cos()) * t.signum()];
    let end = (1.0_f64 - 2.2 / rho_mm).acos();
    (0..=240).map(|i| place(end * (1.0 - f64::from(i) / 120.0))).collect()
}

pub(crate) fn cycloid_job() -> HobbingJob {
    let text = "[gear]\nmodule_mm = 2\nteeth = 24\nface_width_mm = 2\naddendum_coefficient = 0.8\n[tool.hob]\n\
        reference_diameter_mm = 60\nlength_mm = 16\ngashes = 8\naddendum_coefficient = 1.1\n[fields.flank]\n\
        profile_spacing_um = 150\nlead_spacing_um = 500\n[[operation]]\nname = \"finish\"\n\
        axial_feed_mm_per_revolution = 3\n[operation.linkage.hobbing]\n";
    scene_job(text, Some(("tooth.csv", &table(&cycloid_rack(4.0)))), &[]).unwrap_or_else(|why| panic!("{why}"))
}

/// A rack rolled out by a circle generates the epicycloid of that circle over the gear's pitch circle and the
/// hypocycloid below, each with the closed form of its distance from the point where it crosses the pitch circle.
#[test]
fn a_cycloidal_rack_generates_the_cycloids_of_its_rolling_circle() {
    let job = cycloid_job();
    let (pitch_mm, rho_mm) = (24.0, 4.0);
    let turned_rad = |radius_mm: f64| {
        let is_outside = radius_mm > pitch_mm;
        let center_mm: f64 = if is_outside { pitch_mm + rho_mm } else { pitch_mm - rho_mm };
        // The triangle of both centres and the point: the angle at the rolling circle's centre, and at the axis.
        let seen_mm2 = center_mm * center_mm + rho_mm * rho_mm - radius_mm * radius_mm;
        let rolled = (seen_mm2 / (2.0 * center_mm * rho_mm)).acos();
        let seen = (rho_mm * rolled.sin() / radius_mm).asin();
        rho_mm / pitch_mm * if is_outside { rolled } else { PI - rolled } - seen
    };
    let cutter = HobCutter::new(&job).expect("passes");
    let (mut worst_mm, mut compared) = (0.0_f64, 0);
    for side in [Side::Left, Side::Right] {
        let section = cutter.target(3, side).expect("a target").section(0.0);
        let middle_rad = 2.5 * PI / 12.0;
        for i in 1..400 {
            let at = section.ray(f64::from(i) / 400.0).origin_mm.truncate();
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

#[test]
fn a_cut_by_a_hollow_edge_equals_brute_force() {
    let job = cycloid_job();
    assert!(!job.hob.edge_of(0).is_convex, "cycloids are hollow under the pitch line");
    let cutter = HobCutter::new(&job).expect("passes");
    for (tooth, side) in [(1, Side::Left), (7, Side::Right)] {
        let field = cutter.rays(tooth, side).expect("rays").1.field;
        let known = cut(&job, &field);
        let mut all = field.blank_layer();
        let plan = SweepPlan::brute_force(&field, cutter.operations.last().expect("one"));
        Cpu::default().cut_spatial(&field, &plan, &mut all).expect("native");
        assert!(known == all, "tooth {tooth} {side:?}");
        // The comparison is alive.
        let at = known.passes.iter().position(|&pass| pass != u32::MAX).expect("a cut dexel");
        let mut planted = known;
        planted.heights_mm[at] = f32::from_bits(planted.heights_mm[at].to_bits() ^ 1);
        assert!(planted != all);
    }
}

/// What no tooth can be taken from, with its place and a way out.
#[test]
fn contours_that_are_no_tooth_of_a_hob_are_refused() {
    let good = rack(40);
    let refused = |name: &str, text: &str, words: &[&str]| {
        let why = scene_job(ROUND, Some((name, text)), &[]).err().unwrap_or_else(|| panic!("{words:?}: taken"));
        for words in words.iter().chain(&["tool.hob.", "way out"]) {
            assert!(why.contains(words), "{words} not in: {why}");
        }
    };
    let mm = table(&good);
    let moved = |by: f64| table(&good.iter().map(|&[x, y]| [x, y + by]).collect::<Vec<_>>());
    let mut crossed = good.clone();
    crossed.swap(20, 24);
    refused("tooth.csv", &table(&crossed), &["crosses itself at x ", "take the loop out"]);
    refused("tooth.csv", &mm.replace("x_mm,y_mm", "x,y"), &["line 1", "header `x,y`", "pitch line outwards"]);
    refused("tooth.csv", &mm.replace("x_mm,y_mm", "x_in,y_in"), &["of a hob of pitch 9.4248 mm", "4.7124 mm"]);
    refused("tooth.csv", &mm.replace("x_mm,y_mm", "x_um,y_um"), &["addendum_coefficient"]);
    refused("tooth.csv", &moved(30.0), &["not from the hob's axis"]);
    refused("tooth.csv", &moved(-0.5), &["write addendum_coefficient = 1.083"]);
    // Ends above the gear's tips.
    let short: Vec<[f64; 2]> = good.iter().copied().filter(|at| at[1] > -2.0).collect();
    refused("tooth.csv", &table(&short), &["ends 1.1250 mm below the tips of the gear"]);
    // A wall square to the pitch line.
    let wall = [[2.0, 3.75], [2.0, -3.75]];
    refused("tooth.csv", &table(&wall), &["no thread", "worm = \"straight_sided\""]);
    let lines: String =
        mm.lines().skip(1).map(|at| at.replace(',', "\n20\n")).collect::<Vec<_>>().windows(2).fold(
            String::new(),
            |text, pair| {
                text + &format!("0\nLINE\n8\n0\n10\n{}\n11\n{}\n", pair[0], pair[1].replace("\n20\n", "\n21\n"))
            },
        );
    let dxf = |head: &str| format!("{head}0\nSECTION\n2\nENTITIES\n{lines}0\nENDSEC\n0\nEOF\n");
    refused("tooth.dxf", &dxf(""), &["$INSUNITS"]);
    let unit = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n";
    let [drawing, points] = [("tooth.dxf", dxf(unit)), ("tooth.csv", mm)]
        .map(|(name, text)| scene_job(ROUND, Some((name, &text)), &[]).expect("a rack"));
    assert!(targets_apart_mm(&drawing, &points, Side::Left, 0.0) < 1e-6);
    for beside in ["tool.hob.thinning_mm=0.1", "tool.hob.tip_radius_mm=0.5", "gear.profile_shift_coefficient=0.2"] {
        let why = scene_job(ROUND, Some(("tooth.csv", &table(&good))), &[beside]).expect_err("refused");
        assert!(why.contains("tool.hob.profile.file draws"), "{why}");
    }
    let helical =
        ["gear.helix_angle_deg=20", "gear.pitch_curve.ellipse.order=2", "gear.pitch_curve.ellipse.eccentricity=0.1"];
    let why = scene_job(ROUND, Some(("tooth.csv", &table(&good))), &helical).expect_err("refused");
    assert!(why.contains("round pitch curve"), "{why}");
}
