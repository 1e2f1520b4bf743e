//! Round gears as their drawings state them: sizes from the generated flanks against closed forms, profile shift, an
//! inspection against a class with its sheet.

use crate::fixtures::command::{gearcut, read_json};
use gearcut::gear::GearKind;
use gearcut::job::{CylindricalGear, GearJob};
use gearcut::measure::round_gear::RoundGear;
use gearcut::process;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::scene::model::Shaping;
use gearcut::terms::Side;
use std::f64::consts::PI;
use std::path::Path;

const ALPHA_RAD: f64 = 20.0 * PI / 180.0;

fn job(scene: &str, shift: f64, cutter_shift: f64, allowance_mm: f64) -> ShapingJob {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/shaping").join(scene);
    let mut scene = process::load(&path, &[]).expect("a shipped scene").scene;
    scene.gear.profile_shift_coefficient = shift;
    scene.gear.tooth_thickness_allowance_mm = allowance_mm;
    Shaping::of_mut(&mut scene).expect("shaping").tool.profile_shift_coefficient = cutter_shift;
    ShapingJob::new(scene).expect("a gear")
}

fn sizes(job: &ShapingJob) -> RoundGear {
    job.round_gear().expect("flanks").expect("it is round")
}

/// The tooth that the shifted cutter generates is thicker by 2 x m tan(alpha) and the allowance on the reference
/// circle, outside and in a ring; a shift of the cutter itself, new or reground, changes nothing of that.
#[test]
fn a_profile_shift_makes_the_tooth_that_its_definition_says() {
    for (scene, kind, shifts) in [
        ("circular_m3_z24.toml", GearKind::External, [-0.2, 0.0, 0.3, 0.6]),
        ("internal_circle.toml", GearKind::Internal, [-0.2, 0.0, 0.1, 0.3]),
    ] {
        let plain = shifts.into_iter().map(|shift| (shift, 0.0, 0.0));
        let others = [(0.3, 0.1, 0.0), (0.0, 0.3, 0.0), (0.1, -0.3, -0.08), (0.0, 0.0, -0.5), (0.1, 0.0, -0.08)];
        for (shift, cutter_shift, allowance_mm) in plain.chain(others) {
            let job = job(scene, shift, cutter_shift, allowance_mm);
            let (gear, round) = (&job.scene.gear, sizes(&job));
            assert_eq!(round.kind, kind);
            let thickness_mm = gear.module_mm * (0.5 * PI + 2.0 * shift * ALPHA_RAD.tan()) + allowance_mm;
            let thinned_mm = Shaping::of(&job.scene).expect("shaping").tool.thinning_mm;
            let error_mm = round.thickness_mm - thickness_mm - thinned_mm;
            assert!(error_mm.abs() < 1e-9, "{scene}, x {shift}, x0 {cutter_shift}, {allowance_mm} mm: {error_mm} mm");
            let sign = kind.tip_sign();
            let d = gear.module_mm * f64::from(gear.teeth);
            let tip_mm = d + 2.0 * sign * gear.module_mm * (gear.addendum_coefficient + shift);
            assert!((round.tip_diameter_mm - tip_mm).abs() < 1e-12);
        }
    }
}

/// The distance of the axes by hand: inv(alpha_w) = inv(alpha) + 2 (x + x0) tan(alpha) / (z + z0), 66.860 mm for 24
/// teeth of module 3 that a new cutter of 20 teeth, x0 = 0.3, cuts without a shift of their own. Roots follow it.
#[test]
fn a_new_cutter_stands_as_far_off_as_its_teeth_are_thicker() {
    let (z, z0, m) = (24.0, 20.0, 3.0);
    for (shift, cutter_shift) in [(0.0, 0.3), (0.0, -0.3), (0.2, 0.15)] {
        let text = "[gear]\nmodule_mm = 3.0\nteeth = 24\n[tool.shaper_cutter]\nteeth = 20\n";
        let settings = [
            format!("gear.profile_shift_coefficient={shift}"),
            format!("tool.shaper_cutter.profile_shift_coefficient={cutter_shift}"),
        ];
        let scene = process::parse(text, "scene.toml", Path::new(""), &settings).expect("a scene").scene;
        let job = ShapingJob::new(scene).expect("a gear");
        let inv = |angle: f64| angle.tan() - angle;
        let wanted = inv(ALPHA_RAD) + 2.0 * (shift + cutter_shift) * ALPHA_RAD.tan() / (z + z0);
        let [mut low, mut high] = [0.0, 1.0];
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if inv(middle) < wanted { low = middle } else { high = middle }
        }
        let axes_mm = 0.5 * m * (z + z0) * ALPHA_RAD.cos() / low.cos();
        assert!(cutter_shift != 0.3 || (axes_mm - 66.8595).abs() < 1e-4, "{axes_mm}");
        let finishing = job.finishing();
        assert!((66.0 + finishing.spec.offset_mm - axes_mm).abs() < 1e-9);
        assert_eq!(finishing.short_of_depth_mm, 0.0);
        let root_mm = 2.0 * (axes_mm - job.cutter.tip_radius_mm);
        assert!((sizes(&job).root_diameter_mm - root_mm).abs() < 1e-9, "{} mm", sizes(&job).root_diameter_mm);
        // Roughing keeps its stock: the closed form of two involutes between both depths.
        let stock_mm = |offset_mm: f64| {
            let working = (0.5 * m * (z + z0) * ALPHA_RAD.cos() / (66.0 + offset_mm)).acos();
            (inv(working) - wanted) * 0.5 * m * (z + z0) * ALPHA_RAD.cos()
        };
        let rough = &job.operations[0];
        assert!(stock_mm(finishing.spec.offset_mm).abs() < 1e-9 && stock_mm(rough.spec.offset_mm) > 0.05);
    }
}

/// Profiles are inspected over the roll: the length sqrt(r^2 - r_b^2) of the line of action less that of the pitch
/// point, r_p sin(alpha). In a ring it falls towards the tip.
#[test]
fn rolls_are_lengths_on_the_line_of_action() {
    for (scene, shift) in [("circular_m3_z24.toml", 0.0), ("circular_m3_z24.toml", 0.3), ("internal_circle.toml", 0.0)]
    {
        let job = job(scene, shift, 0.0, 0.0);
        let pitch_mm = 0.5 * job.scene.gear.module_mm * f64::from(job.scene.gear.teeth);
        for side in [Side::Left, Side::Right] {
            let length_mm = job.profile_length_mm(5, side).expect("a flank");
            let arcs_mm: Vec<f64> = (0..=10).map(|i| length_mm * f64::from(i) / 10.0).collect();
            let rolls_mm = job.rolls_mm(5, side, &arcs_mm).expect("a flank");
            let rays = job.target_points(5, side, &arcs_mm, &[0.0]).expect("a flank").remove(0);
            for (roll_mm, ray) in rolls_mm.iter().zip(rays) {
                let touch_mm = (ray.origin_mm.length_squared() - (pitch_mm * ALPHA_RAD.cos()).powi(2)).sqrt();
                let expected_mm = job.blank().kind().tip_sign() * (touch_mm - pitch_mm * ALPHA_RAD.sin());
                assert!((roll_mm - expected_mm).abs() < 1e-9, "{scene}, x {shift}: {roll_mm} for {expected_mm} mm");
            }
            assert!(rolls_mm[0] < 0.0 && rolls_mm[10] > 0.0 && rolls_mm.is_sorted());
        }
    }
}

/// The span touches two flanks along one tangent of the base circle: the distance of the target's flanks there, point
/// by point, is W_k.
#[test]
fn the_span_is_the_distance_of_the_generated_flanks() {
    let job = job("circular_m3_z24.toml", 0.3, 0.0, 0.0);
    let round = sizes(&job);
    let span = round.span().expect("it can be spanned");
    // Right flank of tooth 1 and left flank of tooth k, each where its distance from the axis is the touching radius.
    let touch_mm = 0.5 * span.touch_diameter_mm;
    let at = |tooth: u32, side: Side| {
        let flank = job.target_flank(tooth, side);
        let mut range = [0.0, flank.length_mm()];
        for _ in 0..60 {
            let middle = 0.5 * (range[0] + range[1]);
            range[usize::from(flank.at_arc(middle).point_mm.length() > touch_mm)] = middle;
        }
        flank.at_arc(range[0])
    };
    let (first, last) = (at(1, Side::Right), at(span.teeth, Side::Left));
    let across = last.point_mm - first.point_mm;
    assert!((across.length() - span.length_mm).abs() < 1e-8, "{} for {}", across.length(), span.length_mm);
    // Both normals lie along it: flat anvils touch there.
    assert!(across.normalize().perp_dot(last.normal).abs() < 1e-8 && across.perp_dot(first.normal).abs() < 1e-6);
}

#[test]
fn a_gear_off_its_axis_fails_its_class_and_the_sheet_shows_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let settings = [
        "mounting.eccentricity_um=6",
        "measure.iso_1328_class=2",
        "measure.limits.runout_um=15",
        "fields.flank.profile_spacing_um=50",
        "fields.flank.lead_spacing_um=5000",
        "fields.chips.spacing_mm=0.3",
        "fields.blank.spacing_mm=1",
    ];
    let settings = settings.iter().flat_map(|setting| ["--set", setting]);
    let arguments: Vec<&str> = ["cut", "scenes/shaping/circular_m3_z24.toml", "--only", "report", "--out"]
        .into_iter()
        .chain([out.to_str().expect("a path")])
        .chain(settings)
        .collect();
    gearcut(&arguments).done();
    let results = read_json(&out.join("results.json"));
    let rows = results["sections"]["inspection"]["figures"]["rows"].as_array().expect("rows");
    let row = |symbol: &str| rows.iter().find(|row| row[0] == symbol).expect("all figures are there");
    // F_p of a circle off its axis is 2 e / cos(alpha), 12.8 um; class 2 allows 18.911 / sqrt(8) = 6.7, rounded 6.5 um.
    let pitch = row("F_p");
    assert!((pitch[2].as_f64().expect("um") - 12.0 / ALPHA_RAD.cos()).abs() < 0.3, "{pitch}");
    assert_eq!((pitch[6].as_f64(), pitch[9].as_str()), (Some(6.5), Some("fail")), "{pitch}");
    // Runout is 2 e; the drawing allows 15 um, its class 6.
    let runout = row("F_r");
    assert_eq!((runout[6].as_f64(), runout[7].as_str()), (Some(15.0), Some("drawing")), "{runout}");
    assert_eq!(runout[9].as_str(), Some("pass"), "{runout}");
    let warnings = results["warnings"].to_string();
    assert!(warnings.contains("total pitch deviation F_p") && !warnings.contains("runout F_r"), "{warnings}");
    let span = &results["sections"]["round_gear"]["span"];
    // An offset of the finishing cut none: x 0, 24 teeth, three of them: 3 cos(20 deg) (2.5 pi + 24 inv(20 deg)).
    assert!((span["value"].as_f64().expect("mm") - 23.149_385).abs() < 1e-4, "{span}");
    let svg = std::fs::read_to_string(out.join("inspection.svg")).expect("a sheet");
    let drawing = roxmltree::Document::parse(&svg).expect("XML");
    let words: Vec<&str> = drawing.descendants().filter_map(|node| node.text()).collect();
    for word in ["Profile, left flanks", "Helix, right flanks", "Span, W_k", "fail", "Gear inspection: circular_m3_z24"]
    {
        assert!(words.contains(&word), "{word} is not among {words:?}");
    }
    let pdf = std::fs::read(out.join("inspection.pdf")).expect("a sheet");
    assert!(pdf.starts_with(b"%PDF-1."));
}
