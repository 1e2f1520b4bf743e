//! Helical gears that sit too high or lean on the work spindle: the helix of the guide follows the ram, not the gear.
//!
//! To first order a gear that is moved by d and turned by w against the machine has its surface cut off by
//! h = -n . (d + w x p), n and p in space: an offset turns the teeth by it times tan(beta), and a lean runs out at the
//! circumference, so that the helix makes waves of pitch of it. Both are nothing on spur gears.

use crate::fixtures::closed_form;
use crate::fixtures::shaped_gear::shaped_gear;
use gearcut::cut::cpu::Cpu;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::gear::measure::unevenness::{CrossedSurface, crossings};
use gearcut::process::shaping::sections::GearPart;
use gearcut::terms::Side;
use glam::{DVec2, DVec3};
use std::path::Path;

const ROUND: &str = shaped_gear!("teeth = 24\nhelix_angle_deg = 20", 2400, "[operation.infeed.none]");
const RING: &str = shaped_gear!(
    "kind = \"internal\"\nteeth = 60\nhelix_angle_deg = 15\nhand = \"left\"\naddendum_coefficient = 0.8",
    3600,
    "[operation.infeed.none]"
);
const OVAL: &str = shaped_gear!(
    "teeth = 42\nhelix_angle_deg = 15\n[gear.pitch_curve.ellipse]\norder = 3\neccentricity = 0.1348",
    3600,
    "[operation.infeed.none]"
);
const ROWS_MM: [f64; 3] = [-9.0, 1.0, 9.0];
/// Places along the profile, shares of it: feet and tips are cut by strokes whose pitch points lie elsewhere.
const SHARES: [f64; 3] = [0.25, 0.5, 0.9];
const OFFSET: &str = "mounting.axial_offset_um=200";
const LEAN: [&str; 2] = ["mounting.wobble_um_per_100mm=200", "mounting.wobble_angle_deg=40"];

fn job(text: &str, settings: &[&str]) -> ShapingJob {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let scene = gearcut::process::parse(text, "scene.toml", Path::new(""), &settings).expect("a scene");
    ShapingJob::new(scene.scene).expect("a gear")
}

/// A place on a flank in space, with its normal.
struct Place {
    point_mm: DVec3,
    normal: DVec3,
}

/// What an error of the mounting changes on a few flanks, mm.
fn changes(text: &str, settings: &[&str]) -> Vec<(Place, f64)> {
    let (sound, faulty) = (job(text, &[]), job(text, settings));
    let helix = sound.helix.expect("a helix");
    let mut found = Vec::new();
    for tooth in [3, 11, 20] {
        for side in [Side::Left, Side::Right] {
            let flank = sound.target_flank(tooth, side);
            // Five columns together have the mean of the feed marks.
            let arcs_mm: Vec<f64> = SHARES
                .iter()
                .flat_map(|share| (-2..=2).map(move |i| share * flank.length_mm() + 0.02 * f64::from(i)))
                .collect();
            let cut = |job: &ShapingJob| {
                let field = sound.field_over(flank, arcs_mm.iter().copied(), ROWS_MM.to_vec());
                job.cut_on(&Cpu::default(), GearPart::Flank(tooth, side), field).expect("native")
            };
            let [before, after] = [&sound, &faulty].map(cut);
            for (row, &z_mm) in ROWS_MM.iter().enumerate() {
                let section = sound.flank_in_section(tooth, side, z_mm).expect("a flank");
                for (share, columns) in [0..5, 5..10, 10..15].into_iter().enumerate() {
                    let at = section.at_arc(SHARES[share] * flank.length_mm());
                    let normal = helix.flank_normal(side, at.normal);
                    let place = Place { point_mm: at.point_mm.extend(z_mm), normal };
                    let height_mm = |cut: &gearcut::steps::planar::CutField, column: usize| {
                        f64::from(cut.layers.last().expect("an operation").column(column, ROWS_MM.len())[row])
                    };
                    let change = |column| height_mm(&after, column) - height_mm(&before, column);
                    found.push((place, columns.map(change).sum::<f64>() / 5.0));
                }
            }
        }
    }
    found
}

#[test]
fn a_helical_gear_that_sits_too_high_has_its_teeth_turned() {
    for text in [ROUND, RING, OVAL] {
        let found = changes(text, &[OFFSET]);
        closed_form::agree("axial offset", &found, [40.0, 0.3], |place| -0.2 * place.normal.z);
    }
    // By hand: 200 um tan(beta) cos(alpha_t) cos(beta_b), out of the material on one side and into it on the other.
    let beta = 20_f64.to_radians();
    let alpha_t = (beta.tan() / beta.cos()).atan();
    let base_cos = (1.0 + (beta.tan() * alpha_t.cos()).powi(2)).sqrt().recip();
    let by_hand_mm = 0.2 * beta.tan() * alpha_t.cos() * base_cos;
    assert!((by_hand_mm - 64.28e-3).abs() < 5e-6);
    for (place, change_mm) in changes(ROUND, &[OFFSET]) {
        assert!((change_mm.abs() - by_hand_mm).abs() < 0.3e-3, "{change_mm} mm at {}", place.point_mm);
    }
}

#[test]
fn a_leaning_helical_gear_has_waves_of_pitch() {
    let towards = DVec2::from_angle(40_f64.to_radians());
    let turn = 2e-3 * towards.perp().extend(0.0);
    for text in [ROUND, RING, OVAL] {
        let found = changes(text, &LEAN);
        closed_form::agree("lean", &found, [20.0, 0.3], |place| -place.normal.dot(turn.cross(place.point_mm)));
    }
}

/// Flanks cross the pitch curve earlier or later by the runout times tan(beta): F_p is 2 r tau tan(beta), as hobbed.
#[test]
fn its_pitch_is_off_by_the_runout_and_the_helix() {
    let [sound, leaning] =
        [&[][..], &LEAN].map(|settings| crossings(&job(ROUND, settings), 0, CrossedSurface::Strokes).teeth);
    let (towards, tan) = (DVec2::from_angle(40_f64.to_radians()), 20_f64.to_radians().tan());
    let found: Vec<(DVec2, f64)> = sound
        .iter()
        .flatten()
        .zip(leaning.iter().flatten())
        .map(|(before, after)| (before.expect("a crossing"), after.expect("a crossing")))
        .map(|(before, after)| (before.point_mm, after.arc_mm - before.arc_mm))
        .collect();
    assert_eq!(found.len(), 48);
    closed_form::agree("pitch", &found, [27.0, 0.1], |place| -2e-3 * tan * towards.dot(*place));
    let arcs_mm = found.iter().map(|(_, arc_mm)| *arc_mm);
    let [low, high] = arcs_mm.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], of| [low.min(of), high.max(of)]);
    let by_hand_mm = 2.0 * 36.0 / 20_f64.to_radians().cos() * 2e-3 * tan;
    assert!((by_hand_mm - 55.8e-3).abs() < 1e-4);
    assert!((high - low) / by_hand_mm > 0.98 && high - low < by_hand_mm + 1e-4, "{} mm", high - low);
}
