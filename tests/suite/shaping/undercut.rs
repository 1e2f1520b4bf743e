//! Flanks into which the cutter's tip corner has cut: where they begin, and how deep the cut goes.
//!
//! Round gears are compared with the path of the corner and the involute, each written down here from the rolling of
//! two circles; other gears with the poses of the cutter.

use crate::fixtures::command::{gearcut, read_json};
use crate::fixtures::own_program::own_program;
use gearcut::job::CylindricalGear;
use gearcut::process;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::axes_report::OperationAxes;
use gearcut::process::shaping::findings::warnings;
use gearcut::process::shaping::target::FlankEnd;
use gearcut::terms::Side;
use glam::DVec2;
use std::f64::consts::{PI, TAU};
use std::path::Path;

const MODULE_MM: f64 = 3.0;
const ALPHA_RAD: f64 = 20.0 * PI / 180.0;
const SCENE: &str = "[gear]\nmodule_mm = 3\nteeth = 24\n\n[tool.shaper_cutter]\nteeth = 20\n";

fn job(settings: &[&str]) -> ShapingJob {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let scene = process::parse(SCENE, "scene.toml", Path::new("."), &settings).expect("a scene").scene;
    ShapingJob::new(scene).unwrap_or_else(|why| panic!("{settings:?}: {why}"))
}

fn teeth(gear: u32, cutter: u32) -> [String; 2] {
    [format!("gear.teeth={gear}"), format!("tool.shaper_cutter.teeth={cutter}")]
}

fn inv(angle: f64) -> f64 {
    angle.tan() - angle
}

/// A pinion cutter without shift and a round gear, rolling on their pitch circles. The gear turns by theta, the cutter
/// by -theta r / r_c. The space is centred on the line of centres at theta = 0.
struct Rolling {
    gear_mm: f64,
    cutter_mm: f64,
    /// Centre of the corner's round: distance from the cutter's axis, angle off the tooth's middle.
    corner: [f64; 2],
    round_mm: f64,
}

impl Rolling {
    fn new(gear_teeth: u32, cutter_teeth: u32, addendum: f64, round_mm: f64) -> Self {
        let [gear_mm, cutter_mm] = [gear_teeth, cutter_teeth].map(|z| 0.5 * MODULE_MM * f64::from(z));
        let center_mm = cutter_mm + addendum * MODULE_MM - round_mm;
        let base_mm = cutter_mm * ALPHA_RAD.cos();
        // Half the tooth there, less the round's radius along the base circle.
        let half = 0.5 * PI / f64::from(cutter_teeth) + inv(ALPHA_RAD) - inv((base_mm / center_mm).acos());
        Self { gear_mm, cutter_mm, corner: [center_mm, half - round_mm / base_mm], round_mm }
    }

    fn base_mm(&self) -> f64 {
        self.gear_mm * ALPHA_RAD.cos()
    }

    /// The corner's centre in the frame of the gear.
    fn corner_mm(&self, theta: f64) -> DVec2 {
        let axis = DVec2::new(self.gear_mm + self.cutter_mm, 0.0);
        let turned = PI - self.corner[1] - theta * self.gear_mm / self.cutter_mm;
        DVec2::from_angle(-theta).rotate(axis + self.corner[0] * DVec2::from_angle(turned))
    }

    /// Polar angle at which the involute beside the space begins on the base circle.
    fn involute_rad(&self) -> f64 {
        0.25 * PI * MODULE_MM / self.gear_mm - inv(ALPHA_RAD)
    }

    /// Point of the involute at the angle whose tangent is its roll.
    fn involute_mm(&self, roll: f64) -> DVec2 {
        let e = DVec2::from_angle(self.involute_rad() + roll);
        self.base_mm() * (e - roll * e.perp())
    }

    /// Roll of the involute at the radius of a point outside the base circle, and how far the point lies behind the
    /// involute, in the tooth: involutes of one circle keep their distance, which is the arc of the base circle between
    /// their beginnings.
    fn roll_and_depth_mm(&self, p: DVec2) -> [f64; 2] {
        let roll = ((p.length() / self.base_mm()).powi(2) - 1.0).max(0.0).sqrt();
        [roll, self.base_mm() * (p.to_angle() - self.involute_rad() - (roll - roll.atan()))]
    }

    /// Diameter at which the involute begins where nothing is undercut: the corner's round ends on it, on the line of
    /// action. None where that lies behind the base circle's tangent point.
    fn begin_mm(&self) -> Option<f64> {
        let base_mm = self.cutter_mm * ALPHA_RAD.cos();
        let reach_mm = (self.corner[0] * self.corner[0] - base_mm * base_mm).sqrt() + self.round_mm;
        let left_mm = (self.gear_mm + self.cutter_mm) * ALPHA_RAD.sin() - reach_mm;
        (left_mm > 0.0).then(|| 2.0 * self.base_mm().hypot(left_mm))
    }

    /// Diameter at which a sharp corner's path comes out of the tooth, and its largest depth below.
    fn sharp_undercut_mm(&self) -> [f64; 2] {
        let depth_mm = |theta: f64| self.roll_and_depth_mm(self.corner_mm(theta))[1];
        let radius_mm = |theta: f64| self.corner_mm(theta).length();
        let zero = |f: &dyn Fn(f64) -> f64, mut from: f64, mut to: f64| {
            for _ in 0..60 {
                let middle = 0.5 * (from + to);
                if (f(middle) > 0.0) == (f(from) > 0.0) { from = middle } else { to = middle }
            }
            0.5 * (from + to)
        };
        // From the bottom, where the corner stands on the line of centres, the path climbs along the tooth beside it:
        // over the base circle, deep in the tooth, and out of it.
        let (bottom, step) = (-self.corner[1] * self.cutter_mm / self.gear_mm, 1e-3);
        let up =
            |holds: &dyn Fn(f64) -> bool| (0..2000).map(|i| bottom + f64::from(i) * step).find(|&theta| holds(theta));
        let over = up(&|theta| radius_mm(theta) > self.base_mm()).expect("it climbs");
        let base = zero(&|theta| radius_mm(theta) - self.base_mm(), over - step, over);
        let out = up(&|theta| theta > base && depth_mm(theta) < 0.0).expect("it comes out");
        let crossing = zero(&depth_mm, (out - step).max(base), out);
        // A point lies on two tangents of the base circle. The deeper half of the path is met by normals of the
        // involute on either.
        let deepest = (0..=4000).map(|i| base + (crossing - base) * f64::from(i) / 4000.0).map(|theta| {
            let [roll, depth_mm] = self.roll_and_depth_mm(self.corner_mm(theta));
            let other_mm = depth_mm + 2.0 * self.base_mm() * (roll - roll.atan());
            let is_met = other_mm / self.base_mm() > roll;
            if is_met { other_mm } else { depth_mm }
        });
        [2.0 * radius_mm(crossing), deepest.fold(0.0, f64::max)]
    }

    /// Diameter at which the involute comes as near to the path of the corner's centre as its round is large.
    fn round_undercut_mm(&self) -> f64 {
        let off_mm = |roll: f64| {
            let point = self.involute_mm(roll);
            let distance = |theta: f64| self.corner_mm(theta).distance(point);
            let coarse = (0..3000).map(|i| f64::from(i) * 1e-3 - 1.5);
            let near = coarse.min_by(|a, b| distance(*a).total_cmp(&distance(*b))).expect("places");
            let (mut a, mut b) = (near - 1e-3, near + 1e-3);
            for _ in 0..60 {
                let (c, d) = (b - 0.618_034 * (b - a), a + 0.618_034 * (b - a));
                if distance(c) < distance(d) { b = d } else { a = c }
            }
            distance(0.5 * (a + b)) - self.round_mm
        };
        // Just above the base circle the round covers the involute; further up it does not, to the pitch circle.
        let (mut covered, mut clear) = (0.0, ALPHA_RAD.tan());
        for _ in 0..50 {
            let middle = 0.5 * (covered + clear);
            if off_mm(middle) < 0.0 { covered = middle } else { clear = middle }
        }
        2.0 * self.involute_mm(clear).length()
    }
}

/// Form and active diameter, and the depth below, for gears and cutters of all sizes: of those that the corner
/// undercuts, and of the others.
#[test]
fn a_round_gear_begins_where_the_corners_path_crosses_its_involute() {
    let (mut undercut, mut ordinary) = (0, 0);
    for gear in [6, 8, 10, 13, 17, 24, 31] {
        for cutter in [20, 40, 100] {
            for addendum in [1.0, 1.25] {
                let [z, z0] = teeth(gear, cutter);
                let setting = format!("tool.shaper_cutter.addendum_coefficient={addendum}");
                let job = job(&[&z, &z0, &setting]);
                let round = job.round_gear().expect("flanks").expect("it is round");
                let rolling = Rolling::new(gear, cutter, addendum, 0.0);
                let name = format!("z {gear}, z0 {cutter}, {addendum}");
                let flank = job.target_flank(3, Side::Right);
                if let Some(begin_mm) = rolling.begin_mm() {
                    assert!((round.form_diameter_mm - begin_mm).abs() < 1e-7, "{name}: {}", round.form_diameter_mm);
                    assert_eq!((flank.form_end, flank.undercut), (FlankEnd::CutterCorner, None), "{name}");
                    ordinary += 1;
                    continue;
                }
                let [form_mm, depth_mm] = rolling.sharp_undercut_mm();
                assert!(
                    (round.form_diameter_mm - form_mm).abs() < 1e-8,
                    "{name}: {} not {form_mm}",
                    round.form_diameter_mm
                );
                assert!(form_mm - round.base_diameter_mm() > 1e-3 || depth_mm < 1e-3, "{name}: {form_mm}");
                assert_eq!(flank.form_end, FlankEnd::Undercut, "{name}");
                let found_mm = flank.undercut.expect("undercut").depth_mm;
                println!("{name}: d_Ff {form_mm:.5}, depth {:.3} um, found {:.3} um", 1e3 * depth_mm, 1e3 * found_mm);
                assert!((found_mm - depth_mm).abs() < 1e-8 + 1e-3 * depth_mm, "{name}: {found_mm} not {depth_mm}");
                let active_mm = round.active_diameter_with_rack_mm().expect("external");
                assert!(active_mm >= round.form_diameter_mm, "{name}");
                undercut += 1;
            }
        }
    }
    assert!(undercut > 15 && ordinary > 12, "{undercut} undercut, {ordinary} not");
}

/// The corner's round leaves the curve that runs beside the path of its centre.
#[test]
fn a_round_corner_undercuts_as_far_as_its_round_reaches() {
    for (gear, cutter, round_mm) in [(8, 40, 0.3), (7, 100, 0.5), (10, 50, 0.2)] {
        let [z, z0] = teeth(gear, cutter);
        let setting = format!("tool.shaper_cutter.tip.round.radius_mm={round_mm}");
        let round = job(&[&z, &z0, &setting]).round_gear().expect("flanks").expect("it is round");
        let rolling = Rolling::new(gear, cutter, 1.25, round_mm);
        assert_eq!(rolling.begin_mm(), None, "{gear} {cutter}");
        let form_mm = rolling.round_undercut_mm();
        let found_mm = round.form_diameter_mm;
        println!("z {gear}, z0 {cutter}, round {round_mm}: {form_mm:.6} {found_mm:.6}");
        assert!((found_mm - form_mm).abs() < 1e-6, "{gear} {cutter}: {found_mm} not {form_mm}");
        let sharp_mm = Rolling::new(gear, cutter, 1.25, 0.0).sharp_undercut_mm()[0];
        assert!(sharp_mm - form_mm > 1e-3, "a sharp corner would have been noticed: {sharp_mm}");
    }
}

/// On an oval the form point of every undercut flank is where the cutter stops covering it: just above no pose does,
/// just below one does.
#[test]
fn on_an_oval_the_form_point_is_where_the_cutter_leaves_the_flank() {
    let job = job(&[
        "gear.teeth=17",
        "tool.shaper_cutter.teeth=60",
        "gear.pitch_curve.ellipse.order=2",
        "gear.pitch_curve.ellipse.eccentricity=0.15",
    ]);
    let cutter = &job.cutter;
    let tooth = cutter.involute().expect("involute flanks");
    // How far inside a cutter tooth a point lies, towards its flanks; negative outside, none beyond the tip circle.
    let cover_mm = |center: DVec2, angle: f64, p: DVec2| -> Option<f64> {
        let off = p - center;
        let radius_mm = off.length();
        (radius_mm < cutter.tip_radius_mm - 1e-9 && radius_mm > tooth.base_radius_mm).then(|| {
            let roll = ((radius_mm / tooth.base_radius_mm).powi(2) - 1.0).sqrt();
            let pitch = TAU / f64::from(cutter.teeth);
            let turned = (off.to_angle() - angle) / pitch;
            let aside = (turned - turned.round()).abs() * pitch;
            tooth.base_radius_mm * (tooth.half_angle_rad - (roll - roll.atan()) - aside)
        })
    };
    let generation = job.target_generation();
    let covered_mm = |p: DVec2, phi: f64| {
        let poses = (-40_000..=40_000).map(|i| generation.linkage.pose(phi + f64::from(i) * 2e-5, 0.0));
        poses.filter_map(|pose| cover_mm(pose.center_mm, pose.angle_rad, p)).fold(-1.0, f64::max)
    };
    let (mut undercut, mut others) = (0, 0);
    for (tooth, side) in (1..=5).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]) {
        let flank = job.target_flank(tooth, side);
        let Some(cut) = flank.undercut else {
            others += 1;
            continue;
        };
        undercut += 1;
        let [form, above] = [0.0, 0.02].map(|arc_mm| flank.at_arc(arc_mm));
        let towards_root = (form.point_mm - above.point_mm).normalize();
        let below_mm = form.point_mm + 0.02 * towards_root;
        let [above_mm, below_mm] = [above.point_mm, below_mm].map(|p| covered_mm(p, form.phi_rad));
        println!("tooth {tooth} {side:?}: depth {:.1} um, {above_mm:.6} {below_mm:.6}", 1e3 * cut.depth_mm);
        assert!(above_mm < 1e-6, "tooth {tooth} {side:?}: the cutter goes {above_mm} mm into the flank");
        assert!(below_mm > 1e-4, "tooth {tooth} {side:?}: nothing is cut away below, {below_mm}");
    }
    assert!(undercut >= 2, "{undercut} undercut, {others} not");
}

/// No flank runs past the blank, whatever gear and cutter; the end is found in the middle of the roll or not.
#[test]
fn no_flank_ends_above_the_blank() {
    let mut outlines = 0;
    for gear in [4, 5, 6, 8, 12, 17, 24, 40] {
        for cutter in [20, 40, 50, 100, 300] {
            for [addendum, dedendum] in [[1.25, 1.25], [1.0, 1.25], [1.25, 1.5]] {
                let [z, z0] = teeth(gear, cutter);
                let settings = [
                    z,
                    z0,
                    "gear.bore_diameter_mm=2".to_owned(),
                    format!("tool.shaper_cutter.addendum_coefficient={addendum}"),
                    format!("tool.shaper_cutter.dedendum_coefficient={dedendum}"),
                ];
                let scene = process::parse(SCENE, "scene.toml", Path::new("."), &settings).expect("a scene").scene;
                let made = ShapingJob::new(scene);
                let job = match made {
                    Ok(job) => job,
                    Err(why) => {
                        assert!(gear == 4 && why.to_string().contains("no flank is generated"), "{settings:?}: {why}");
                        continue;
                    }
                };
                for side in [Side::Left, Side::Right] {
                    let flank = job.target_flank(2, side);
                    let tip = flank.at_arc(flank.length_mm()).point_mm;
                    let over_mm = tip.length() - 0.5 * MODULE_MM * f64::from(gear) - MODULE_MM;
                    assert!(over_mm < 1e-9, "{settings:?}: {over_mm} mm over the blank");
                    assert!(flank.tip_end != FlankEnd::BlankOutline || over_mm > -1e-9, "{settings:?}: {over_mm}");
                    outlines += u32::from(flank.tip_end == FlankEnd::BlankOutline);
                }
            }
        }
    }
    assert!(outlines > 100, "{outlines}");
}

/// Scenes without an error are cut without a fault: undercut is told with its depth, and is no gouge.
#[test]
fn undercut_is_no_gouge_and_ends_a_cut_well() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, SCENE).expect("a file");
    for (gear, cutter, more) in
        [(6, 40, None), (8, 40, None), (24, 50, Some("tool.shaper_cutter.dedendum_coefficient=1.5"))]
    {
        let [z, z0] = teeth(gear, cutter);
        let out = folder.path().join(format!("{gear}_{cutter}"));
        let mut arguments =
            vec!["cut", scene.to_str().expect("a path"), "--only", "numbers,meshes", "--backend", "cpu"];
        for setting in
            [&*z, &*z0, "fields.flank.profile_spacing_um=20", "fields.blank.spacing_mm=0.4"].into_iter().chain(more)
        {
            arguments.extend(["--set", setting]);
        }
        arguments.extend(["--out", out.to_str().expect("a path")]);
        gearcut(&arguments).done();
        let results = read_json(&out.join("results.json"));
        let warnings = results["warnings"].to_string();
        assert!(!warnings.contains("below the target") && !warnings.contains("reached by no pass"), "{warnings}");
        assert_eq!(warnings.contains("the cutter undercuts tooth 1 left"), more.is_none(), "{warnings}");
    }
}

/// A program that pulls the cutter back does not undercut as the scene's own strokes do: nothing is said of it.
#[test]
fn undercut_is_told_of_the_scenes_own_strokes_alone() {
    let [z, z0] = teeth(8, 40);
    let mut job = job(&[&z, &z0]);
    let tells = |job: &ShapingJob| {
        let told = warnings::before(job, &OperationAxes::of_job(job), None).expect("poses");
        told.iter().any(|warning| warning.text.contains("the cutter undercuts"))
    };
    assert!(tells(&job));
    for (back_mm, told) in [(0.0, true), (0.5, false)] {
        let mut program = own_program(&job);
        program.knots.iter_mut().for_each(|knot| knot.center_distance_mm += back_mm);
        job.operations[1].program = Some(program);
        assert_eq!(tells(&job), told, "{back_mm} mm back");
        job.operations[1].program = None;
    }
}
