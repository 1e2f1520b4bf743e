//! Sizes of hobbed helical gears from the flanks that the hob's rack generates: thickness, span and balls against
//! closed forms and against the generated flanks themselves, and an inspection sheet.

use crate::fixtures::command::{gearcut, read_json};
use gearcut::job::{CylindricalGear, GearJob};
use gearcut::measure::round_gear::RoundGear;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::terms::Side;
use glam::DVec3;
use std::f64::consts::PI;
use std::path::Path;

const SCENE: &str = "scenes/hobbing/circular_helical.toml";
const ALPHA_RAD: f64 = 20.0 * PI / 180.0;

fn job(settings: &[&str]) -> HobbingJob {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let scene = load(Path::new(SCENE), &settings).unwrap_or_else(|problems| panic!("{problems}")).scene;
    HobbingJob::new(&scene).expect("a gear")
}

/// The gear of a job with its sizes, given to a test.
fn with_sizes(settings: &[&str], test: impl FnOnce(&HobCutter, &RoundGear)) {
    let job = job(settings);
    let gear = HobCutter::new(&job).expect("passes");
    let round = gear.round_gear().expect("flanks").expect("it is round");
    test(&gear, &round);
}

/// The tooth that the shifted hob generates is thicker by 2 x m_n tan(alpha_t) on the reference circle, and so are its
/// diameters those of the drawing, whatever the hand and the angle of the helix.
#[test]
fn a_profile_shift_makes_the_helical_tooth_that_its_definition_says() {
    for (helix_deg, hand, shift) in
        [(0.0, "right", 0.3), (12.5, "left", -0.1), (20.0, "right", 0.0), (20.0, "left", 0.35), (30.0, "right", 0.2)]
    {
        let settings = [
            format!("gear.helix_angle_deg={helix_deg}"),
            format!("gear.hand=\"{hand}\""),
            format!("gear.profile_shift_coefficient={shift}"),
            "gear.tooth_thickness_allowance_mm=-0.04".to_owned(),
        ];
        with_sizes(&settings.each_ref().map(String::as_str), |_, round| {
            let beta = f64::to_radians(helix_deg);
            let (m_t, tan_t) = (3.0 / beta.cos(), ALPHA_RAD.tan() / beta.cos());
            let thickness_mm = 0.5 * PI * m_t + 2.0 * shift * 3.0 * tan_t - 0.04;
            let error_mm = round.thickness_mm - thickness_mm;
            println!("{helix_deg} deg {hand}, x {shift}: {error_mm:.1e} mm");
            assert!(error_mm.abs() < 1e-8, "{helix_deg} deg, x {shift}: {error_mm} mm");
            let d = 41.0 * m_t;
            for (found, wanted) in [
                (round.reference_diameter_mm(), d),
                (round.base_diameter_mm(), d * tan_t.atan().cos()),
                (round.tip_diameter_mm, d + 2.0 * 3.0 * (1.0 + shift)),
            ] {
                assert!((found - wanted).abs() < 1e-9, "{found} for {wanted}");
            }
        });
    }
}

/// A point of a flank in the section at `z_mm` where its distance from the axis is `radius_mm`, with its normal:
/// between the two nearest points of the generated target.
fn on_flank(gear: &HobCutter, tooth: u32, side: Side, radius_mm: f64, z_mm: f64) -> [DVec3; 2] {
    let arcs_mm = gear.even_arcs_mm(tooth, side, 0.005).expect("a flank");
    let rows = gear.target_points(tooth, side, &arcs_mm, &[z_mm]).expect("a flank");
    let radius = |index: usize| rows[0][index].origin_mm.truncate().length();
    let above = (1..rows[0].len()).find(|&index| radius(index) > radius_mm).expect("it lies on the flank");
    let share = (radius_mm - radius(above - 1)) / (radius(above) - radius(above - 1));
    let [a, b] = [rows[0][above - 1], rows[0][above]];
    [a.origin_mm.lerp(b.origin_mm, share), a.normal.lerp(b.normal, share).normalize()]
}

/// Anvils touch along one normal of both flanks: where the right flank of tooth 1 and the left flank of tooth k have
/// opposite normals at the diameter of touch, their points lie W_k apart along it.
#[test]
fn the_span_is_the_distance_of_the_generated_helical_flanks() {
    with_sizes(&["gear.profile_shift_coefficient=0.2"], |gear, round| {
        let span = round.span().expect("it can be spanned");
        let radius_mm = 0.5 * span.touch_diameter_mm;
        // The points of touch lie W_k sin(beta_b) apart along the tooth, on a face of 30 mm.
        let half_mm = 0.5 * span.length_mm * (1.0 - round.base_helix_cosine().powi(2)).sqrt();
        let off_mm = [-half_mm, half_mm].map(|z_mm| {
            let [first, normal] = on_flank(gear, 1, Side::Right, radius_mm, z_mm);
            let [last, other] = on_flank(gear, span.teeth, Side::Left, radius_mm, -z_mm);
            ((normal + other).length(), (first - last).dot(normal), first.distance(last))
        });
        // One of the two is the way that this hand winds.
        let &(apart, across_mm, distance_mm) = off_mm.iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("two");
        println!("W_{} {:.6} mm, generated flanks {across_mm:.6} and {distance_mm:.6} mm", span.teeth, span.length_mm);
        assert!(apart < 1e-5, "normals are not opposite: {apart}");
        assert!((across_mm - span.length_mm).abs() < 2e-6, "{across_mm} for {}", span.length_mm);
        assert!((distance_mm - span.length_mm).abs() < 2e-6, "{distance_mm} for {}", span.length_mm);
    });
}

/// A ball in the space touches both generated flanks.
#[test]
fn balls_touch_the_generated_helical_flanks() {
    with_sizes(&["gear.profile_shift_coefficient=0.2"], |gear, round| {
        let over = round.over_balls(round.usual_ball_mm()).expect("they fit");
        // 41 teeth: the balls lie in spaces that are not quite opposite.
        let center_mm = 0.5 * (over.dimension_mm - over.ball_mm) / (0.5 * PI / 41.0).cos();
        let rows_mm: Vec<f64> = (-150..=150).map(|row| 0.01 * f64::from(row)).collect();
        // The space between tooth 1 and tooth 2 stands half way between their flanks in the middle section.
        let radius_mm = 0.5 * round.reference_diameter_mm();
        let sides =
            [(1, Side::Left), (2, Side::Right)].map(|(tooth, side)| on_flank(gear, tooth, side, radius_mm, 0.0)[0]);
        let middle = (sides[0] + sides[1]).truncate().normalize();
        let center = (middle * center_mm).extend(0.0);
        for (tooth, side) in [(1, Side::Left), (2, Side::Right)] {
            let arcs_mm = gear.even_arcs_mm(tooth, side, 0.01).expect("a flank");
            let rows = gear.target_points(tooth, side, &arcs_mm, &rows_mm).expect("a flank");
            let distances = rows.iter().flatten().map(|ray| ray.origin_mm.distance(center));
            let nearest_mm = distances.fold(f64::INFINITY, f64::min);
            println!("{} of tooth {tooth}: {nearest_mm:.6} mm from a ball of {:.6}", side.name(), 0.5 * over.ball_mm);
            // Points 10 um apart lie up to 5 um beside the place of contact: 5^2 / (2 x 2600) um further off.
            assert!((nearest_mm - 0.5 * over.ball_mm).abs() < 2e-5, "{nearest_mm}");
        }
    });
}

mod slow {
    use super::*;

    #[test]
    fn a_hobbed_gear_off_its_axis_fails_its_class_and_the_sheet_shows_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("out");
        let settings = [
            "gear.teeth=21",
            "gear.face_width_mm=10",
            "mounting.eccentricity_um=6",
            "measure.iso_1328_class=2",
            "measure.limits.runout_um=15",
            "operation.finish.axial_feed_mm_per_revolution=1",
            "fields.flank.profile_spacing_um=300",
            "fields.flank.lead_spacing_um=5000",
            "fields.blank.spacing_mm=3",
            "fields.blank.slice_spacing_mm=10",
            "picture=[]",
            "texture=[]",
        ];
        let settings = settings.iter().flat_map(|setting| ["--set", setting]);
        let arguments: Vec<&str> = ["cut", SCENE, "--only", "report", "--out"]
            .into_iter()
            .chain([out.to_str().expect("a path")])
            .chain(settings)
            .collect();
        gearcut(&arguments).done();
        let results = read_json(&out.join("results.json"));
        let rows = results["sections"]["inspection"]["figures"]["rows"].as_array().expect("rows");
        let row = |symbol: &str| rows.iter().find(|row| row[0] == symbol).expect("all figures are there");
        // F_p of a circle off its axis is 2 e / cos(alpha_t) in the transverse section.
        let alpha_t = (ALPHA_RAD.tan() / f64::to_radians(20.0).cos()).atan();
        let (pitch, runout) = (row("F_p"), row("F_r"));
        println!("F_p {pitch}, F_r {runout}");
        assert!((pitch[2].as_f64().expect("um") - 12.0 / alpha_t.cos()).abs() < 1.0, "{pitch}");
        assert_eq!(pitch[9].as_str(), Some("fail"), "{pitch}");
        assert_eq!(
            (runout[6].as_f64(), runout[7].as_str(), runout[9].as_str()),
            (Some(15.0), Some("drawing"), Some("pass"))
        );
        let span = &results["sections"]["round_gear"]["span"];
        // 21 teeth of module 3 at 20 deg over k teeth: m cos(alpha) ((k - 1/2) pi + z inv(alpha_t)).
        let k = 3.0;
        let wanted_mm = 3.0 * ALPHA_RAD.cos() * ((k - 0.5) * PI + 21.0 * (alpha_t.tan() - alpha_t));
        assert!((span["value"].as_f64().expect("mm") - wanted_mm).abs() < 1e-4, "{span} for {wanted_mm}");
        let svg = std::fs::read_to_string(out.join("inspection.svg")).expect("a sheet");
        let drawing = roxmltree::Document::parse(&svg).expect("XML");
        let words: Vec<&str> = drawing.descendants().filter_map(|node| node.text()).collect();
        for word in
            ["Profile, left flanks", "Helix, right flanks", "Span, W_k", "fail", "Gear inspection: circular_helical"]
        {
            assert!(words.contains(&word), "{word} is not among {words:?}");
        }
        assert!(std::fs::read(out.join("inspection.pdf")).expect("a sheet").starts_with(b"%PDF-1."));
    }
}
