//! Round gears with profile shifts: at the distance of their shifts they run without play, outside and in a ring; at
//! any other one with the play of ISO 21771. All against closed forms of involutes.

use super::*;
use crate::findings::Severity;
use crate::pair::rolling::{LEAST_POSITIONS_PER_TOOTH, turns_of_period};
use crate::pair_job::findings::findings;
use crate::pair_job::fit::Fit;
use crate::pair_job::flanks::FlankSource;
use crate::pair_job::options::PairOptions;
use crate::pair_job::rolled::{RolledPair, roll_pair};
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;

const RING: &str = "kind = \"internal\"\nrim_mm = 20.0\n";
/// A ring whose tips stay outside of the driver's end of the line of action: its tip radius of 72.6 mm is above
/// sqrt(r_b^2 + (a sin(alpha_w))^2) = 72.27 mm, which the 72 mm of a full tooth are not.
const LOW_RING: &str = "kind = \"internal\"\nrim_mm = 20.0\naddendum_coefficient = 0.8\n";

fn shifted(name: &str, teeth: u32, shift: f64, more: &str) -> LoadedScene {
    let kind = if more.contains("internal") { RING } else { "" };
    let rest = more.replace(RING, "");
    round(name, teeth, kind, &format!("profile_shift_coefficient = {shift}\n{rest}"))
}

fn rolled(a: &LoadedScene, b: &LoadedScene, options: &PairOptions) -> Result<RolledPair> {
    // All teeth are alike: the fewest positions show each of them.
    let teeth = [a, b].map(|gear| gear.scene.gear.teeth);
    let positions = LEAST_POSITIONS_PER_TOOTH * teeth[0] * turns_of_period(teeth);
    let options = PairOptions { source: FlankSource::Nominal, positions: Some(positions as usize), ..options.clone() };
    unwatched(|watch| roll_pair([&a.scene, &b.scene], &options, &Cpu::default(), watch))
}

fn involute(angle: f64) -> f64 {
    angle.tan() - angle
}

/// Working distance of module 3 and 20 deg by Newton's method on inv(alpha_w) = inv(alpha) + s 2 (x1 + x2) tan(alpha) /
/// (z2 + s z1).
fn distance_mm(teeth: [u32; 2], shifts: f64, sign: f64) -> f64 {
    let alpha = 20_f64.to_radians();
    let apart = f64::from(teeth[1]) + sign * f64::from(teeth[0]);
    let wanted = involute(alpha) + sign * 2.0 * shifts * alpha.tan() / apart;
    let mut working = alpha;
    for _ in 0..60 {
        working -= (involute(working) - wanted) / working.tan().powi(2);
    }
    1.5 * apart * alpha.cos() / working.cos()
}

/// Contact ratio of round gears (ISO 21771, 5.4.1), tip radii (z / 2 + s (1 + x)) m.
fn contact_ratio(teeth: [u32; 2], shifts: [f64; 2], sign: f64, distance_mm: f64) -> f64 {
    let alpha = 20_f64.to_radians();
    let reach = |i: usize, own: f64| {
        let radius = 1.5 * f64::from(teeth[i]);
        ((radius + own * 3.0 * (1.0 + shifts[i])).powi(2) - (radius * alpha.cos()).powi(2)).sqrt()
    };
    let apart = f64::from(teeth[1]) + sign * f64::from(teeth[0]);
    let sin = (1.0 - (1.5 * apart * alpha.cos() / distance_mm).powi(2)).sqrt();
    (reach(0, 1.0) + sign * reach(1, sign) - sign * distance_mm * sin) / (3.0 * std::f64::consts::PI * alpha.cos())
}

#[test]
fn shifted_gears_run_without_play_at_the_distance_of_their_shifts() {
    // The first is the pair of the handbooks: a = 56.499870 mm.
    for (teeth, shifts, more) in [
        ([12, 24], [0.6, 0.36], ""),
        ([17, 34], [0.3, 0.5], ""),
        ([25, 25], [-0.2, 0.6], ""),
        ([30, 60], [-0.1, -0.3], ""),
        ([18, 54], [0.4, -0.1], RING),
        ([16, 48], [0.1, -0.5], RING),
    ] {
        let sign = if more.is_empty() { 1.0 } else { -1.0 };
        let (a, b) = (shifted("a", teeth[0], shifts[0], ""), shifted("b", teeth[1], shifts[1], more));
        let pair = rolled(&a, &b, &PairOptions::default()).expect("a pair");
        let expected_mm = distance_mm(teeth, shifts[0] + shifts[1], sign);
        let found_mm = pair.fit.pitch.center_distance_mm();
        assert!((found_mm - expected_mm).abs() < 1e-9, "{teeth:?}: {found_mm} mm, {expected_mm} expected");
        if teeth == [12, 24] {
            assert!((found_mm - 56.499_870).abs() < 5e-7, "{found_mm} mm");
        }
        for play in &pair.backlash {
            let um = UM_PER_MM * play.circumferential_mm;
            assert!(um.abs() < 1e-4, "{teeth:?}: {um} um of play");
        }
        for error in &pair.errors {
            let most = error.total_rad.iter().fold(0.0_f64, |most, rad| most.max(rad.abs()));
            assert!(most.to_degrees() * 3600.0 < 1e-3, "{teeth:?}: {most} rad");
        }
        let tight = pair.tight.as_ref().expect("a tight mesh");
        assert!(tight.total_um() < 1e-4 && tight.mean_um().abs() < 1e-4, "{teeth:?}: {} um", tight.mean_um());
        let ratio = pair.contact_ratio.as_ref().expect("contact ratios")[0][0].1;
        let expected = contact_ratio(teeth, shifts, sign, expected_mm);
        assert!((ratio - expected).abs() < 1e-6, "{teeth:?}: {ratio}, {expected} expected");
    }
}

/// At a named distance the play on the rolling circles is 2 a (inv(alpha_w) - inv(alpha)), less what shifts fill, with
/// the allowance of both gears on top: e1 and e2 without their shifts, and with 2 um of them.
#[test]
fn a_named_distance_is_rolled_with_its_play() {
    let alpha = 20_f64.to_radians();
    for (teeth, shift, named_mm, more) in
        [([20, 30], 0.0, 75.4, ""), ([20, 20], 0.25, 61.1, ""), ([20, 50], -0.2, 45.2, LOW_RING)]
    {
        let sign = if more.is_empty() { 1.0 } else { -1.0 };
        let apart = f64::from(teeth[1]) + sign * f64::from(teeth[0]);
        let working = (1.5 * apart * alpha.cos() / named_mm).acos();
        let thinned_mm = 0.03;
        let stretch = named_mm / (1.5 * apart);
        let expected_mm = sign * 2.0 * named_mm * (involute(working) - involute(alpha))
            - stretch * (2.0 * shift * 3.0 * alpha.tan() - thinned_mm);
        let a = shifted("a", teeth[0], shift, &format!("center_distance_mm = {named_mm}\n"));
        let b = shifted("b", teeth[1], 0.0, &format!("{more}tooth_thickness_allowance_mm = -{thinned_mm}\n"));
        let by_key = rolled(&a, &b, &PairOptions::default()).expect("a pair");
        let a_silent = shifted("a", teeth[0], shift, "");
        let named = PairOptions { center_distance_mm: Some(named_mm), ..PairOptions::default() };
        let by_option = rolled(&a_silent, &b, &named).expect("a pair");
        for pair in [by_key, by_option] {
            assert!((pair.fit.pitch.center_distance_mm() - named_mm).abs() < 1e-9);
            let mm = pair.backlash[0].circumferential_mm;
            assert!((mm - expected_mm).abs() < 1e-7, "{teeth:?} at {named_mm}: {mm} mm, {expected_mm} expected");
            let tight = pair.tight.expect("a tight mesh");
            if !more.is_empty() {
                // The ring's tips come below the driver's base circle before the flanks have closed.
                continue;
            }
            let tight_mm = distance_mm_of_thickness(teeth, shift, thinned_mm, sign);
            let found_mm = named_mm + tight.mean_um() / UM_PER_MM;
            assert!((found_mm - tight_mm).abs() < 1e-6, "{teeth:?}: tight at {found_mm} mm, {tight_mm} expected");
        }
    }
}

/// An error of the distance gives the contact ratio of the axes as they are, and play on the circles of the distance
/// without it.
#[test]
fn an_error_of_the_distance_counts_towards_the_contact_ratio() {
    let (a, b) = (shifted("a", 20, 0.0, ""), shifted("b", 30, 0.0, ""));
    for error_um in [150.0, -60.0] {
        let mm = 75.0 + error_um / UM_PER_MM;
        let off = PairOptions { center_distance_error_um: error_um, ..PairOptions::default() };
        let pair = rolled(&a, &b, &off).expect("a pair");
        let ratio = pair.contact_ratio.as_ref().expect("contact ratios")[0][0].1;
        let expected = contact_ratio([20, 30], [0.0; 2], 1.0, mm);
        assert!((ratio - expected).abs() < 1e-6, "{error_um} um: {ratio}, {expected} expected");
        let alpha = 20_f64.to_radians();
        let play_mm = 2.0 * 75.0 * (involute((75.0 * alpha.cos() / mm).acos()) - involute(alpha));
        let found_mm = pair.backlash[0].circumferential_mm;
        assert!((found_mm - play_mm).abs() < 1e-6, "{error_um} um: {found_mm} mm of play, {play_mm} expected");
    }
}

/// Distance without play of one shifted gear with another that is thinned: a shift of -T / (2 m tan(alpha)).
fn distance_mm_of_thickness(teeth: [u32; 2], shift: f64, thinned_mm: f64, sign: f64) -> f64 {
    distance_mm(teeth, shift - thinned_mm / (6.0 * 20_f64.to_radians().tan()), sign)
}

#[track_caller]
fn refused(a: &LoadedScene, b: &LoadedScene, says: &[&str]) {
    let Err(refusal) = Fit::new(&a.scene, &b.scene, 0) else { panic!("they do not run") };
    let text = refusal.to_string();
    assert!(says.iter().all(|words| text.contains(words)), "{text} does not say {says:?}");
}

#[test]
fn distances_without_teeth_in_mesh_are_refused() {
    let named =
        |teeth, mm: f64, more: &str| shifted("named", teeth, 0.0, &format!("{more}center_distance_mm = {mm}\n"));
    let plain = |teeth| shifted("plain", teeth, 0.0, "");
    refused(&named(20, 81.5, ""), &plain(30), &["81.5 mm", "70.4769", "81.0000 mm"]);
    refused(&named(20, 70.0, ""), &plain(30), &["70 mm", "70.4769"]);
    refused(&plain(20), &named(50, 38.9, RING), &["38.9 mm", "39.0000 mm"]);
    // Half a module nearer than without play the tips are in the roots.
    refused(&named(20, 72.0, ""), &plain(30), &["72 mm", "3.000 mm too near", "75.0000 mm", "above 73.5000 and below"]);
    refused(&plain(20), &named(50, 47.0, RING), &["47 mm", "2.000 mm too far apart", "above 42.2862 and below 46.5"]);
    refused(&named(20, 76.0, ""), &named(30, 76.1, ""), &["76 mm", "76.1 mm", "--center-distance-mm"]);
    // inv(20 deg) = 0.014904 is used up by 0.014904 * 36 / (2 tan(20 deg)) = 0.7371 modules.
    refused(&shifted("a", 12, -0.4, ""), &shifted("b", 24, -0.4, ""), &["-0.4 and -0.4", "above -0.7371"]);
}

fn noticed(pair: &RolledPair, gears: [&LoadedScene; 2]) -> Vec<(String, Severity)> {
    let found = findings("pair", gears.map(|gear| &gear.scene), &PairOptions::default(), pair);
    found.warnings.iter().map(|notice| (notice.id.to_string(), notice.severity)).collect()
}

/// Axes 4.5 mm too far apart leave a contact ratio of a third, and edges carry in between.
#[test]
fn gears_that_lose_their_flanks_between_teeth_say_so() {
    let coarse = ["fields.flank.profile_spacing_um=40", "operation.finish.strokes_per_revolution=1080"];
    let gear = round("a", 18, "", "tooth_thickness_allowance_mm = -0.05\n");
    let gear = gear.with_settings(&coarse.map(str::to_owned), process::table()).expect("a gear");
    let at = |mm: f64| {
        let options = PairOptions { center_distance_mm: Some(mm), positions: Some(144), ..PairOptions::default() };
        let scenes = [&gear.scene; 2];
        noticed(&unwatched(|watch| roll_pair(scenes, &options, &Cpu::default(), watch)).expect("a pair"), [&gear; 2])
    };
    let ratio = contact_ratio([18, 18], [0.0; 2], 1.0, 58.5);
    assert!((0.1..0.6).contains(&ratio), "{ratio}");
    assert_eq!(at(58.5), ["pair.contact_ratio", "pair.edge_contact"].map(|id| (id.to_owned(), Severity::Warning)));
    assert_eq!(at(54.2), []);
}

/// Feed marks of teeth without allowance take some micrometres, which is a warning; more cannot be put together.
#[test]
fn gears_that_do_not_go_together_are_a_fault() {
    let (a, b) = (round("a", 24, "", ""), round("b", 24, "", ""));
    for (nearer_um, severity) in [(5.0, Severity::Warning), (50.0, Severity::Fault)] {
        let options = PairOptions { center_distance_error_um: -nearer_um, ..PairOptions::default() };
        let noticed = noticed(&rolled(&a, &b, &options).expect("a pair"), [&a, &b]);
        assert_eq!(noticed, [("pair.jams".to_owned(), severity)], "{nearer_um} um nearer");
    }
}

/// The tight mesh goes over all turns of the period, and its angle with it.
#[test]
fn tight_mesh_is_counted_over_all_turns() {
    let (a, b) = (round("a", 24, "", ""), round("b", 36, "", ""));
    let pair = rolled(&a, &b, &PairOptions::default()).expect("a pair");
    let tight = pair.tight.as_ref().expect("a tight mesh");
    let deg: Vec<f64> = tight.variation_rad_um.iter().map(|[rad, _]| rad.to_degrees()).collect();
    // Three turns of A, eight places in a pitch.
    for (index, deg) in deg.iter().enumerate() {
        assert!((deg - 15.0 / 8.0 * index as f64).abs() < 1e-6, "place {index} at {deg} deg");
    }
    assert_eq!(deg.len(), 3 * 24 * 8);
}
