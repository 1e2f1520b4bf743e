//! Helical round gears, nominal flanks, against closed forms of ISO 21771: play and errors along the normal of the
//! flanks in space, j_n = j_t cos(alpha_t) cos(beta_b); overlap and total contact ratio.

use super::*;
use crate::pair_job::findings::findings;
use crate::pair_job::fit::SIDES;
use crate::pair_job::flanks::FlankSource;
use crate::pair_job::options::PairOptions;
use crate::pair_job::quantities::{
    BACKLASH, CONTACT, OVERLAP_RATIO, RANGE_NORMAL, SMALLEST_CONTACT_RATIO, SMALLEST_NORMAL, TOTAL_CONTACT_RATIO,
    TRANSMISSION_ERROR,
};
use crate::pair_job::rolled::roll_pair;
use crate::pair_job::teeth::gap_um;
use gearcut_core::cut::cpu::Cpu;
use std::f64::consts::PI;

const HELIX_DEG: f64 = 25.0;

#[test]
fn normal_values_are_those_of_the_flanks_in_space() {
    let gear = |hand: &str, more: &str| {
        round("h", 24, "", &format!("helix_angle_deg = {HELIX_DEG}\nhand = \"{hand}\"\n{more}"))
    };
    let (a, b) = (gear("left", "tooth_thickness_allowance_mm = -0.1\n"), gear("right", ""));
    let options = PairOptions {
        source: FlankSource::Nominal,
        positions: Some(192),
        eccentricity_um_deg: [[20.0, 0.0], [0.0, 0.0]],
        ..PairOptions::default()
    };
    let scenes = [&a.scene, &b.scene];
    let pair = unwatched(|watch| roll_pair(scenes, &options, &Cpu::default(), watch)).expect("a pair");
    let found = findings("h", scenes, &options, &pair);
    let (alpha, beta) = (20_f64.to_radians(), HELIX_DEG.to_radians());
    let transverse = (alpha.tan() / beta.cos()).atan();
    // tan(beta_b) = tan(beta) cos(alpha_t).
    let base_helix = (beta.tan() * transverse.cos()).atan();
    let share = transverse.cos() * base_helix.cos();
    for play in &pair.backlash {
        for normal_mm in [play.normal_left_mm, play.normal_right_mm] {
            assert!((normal_mm / play.tangential_mm - share).abs() < 1e-9, "{play:?}");
        }
    }
    let least_um = pair.backlash.iter().map(|play| 1e3 * play.tangential_mm * share).fold(f64::INFINITY, f64::min);
    let told_um = found.group(&BACKLASH).and_then(|play| play.value(&SMALLEST_NORMAL)).expect("a number");
    assert!((told_um - least_um).abs() < 1e-6, "{told_um} um, {least_um} expected");
    // 20 um off the axis: from e to -e across the line of action, which lies in the tangent plane of the base cylinder.
    let errors = found.group(&TRANSMISSION_ERROR).and_then(|errors| errors.side(SIDES[0])).expect("right flanks");
    let range_um = errors.value(&RANGE_NORMAL).expect("a number");
    assert!((range_um / (40.0 * base_helix.cos()) - 1.0).abs() < 0.02, "{range_um} um");
    // What a pair lacks of touching is turned into its gap with the same lever: r_b cos(beta_b).
    let moment = &pair.period.moments[5];
    let base_mm = 0.5 * 24.0 * 3.0 / beta.cos() * transverse.cos();
    for (side, touch) in SIDES.into_iter().flat_map(|side| moment.side(side).pairs.iter().map(move |of| (side, of))) {
        let behind_rad = (moment.side(side).error_rad - touch.touch.error_rad).abs();
        let expected_um = 1e3 * behind_rad * base_mm * base_helix.cos();
        let gap_um = gap_um(&pair.meshing, moment, side, touch);
        assert!((gap_um - expected_um).abs() < 1e-6 * (1.0 + expected_um), "{gap_um} um, {expected_um} expected");
    }
    let contact = found.group(&CONTACT).and_then(|contact| contact.side(SIDES[0])).expect("right flanks");
    let [overlap, total, smallest] = [&OVERLAP_RATIO, &TOTAL_CONTACT_RATIO, &SMALLEST_CONTACT_RATIO]
        .map(|row| contact.value(row).expect("a number"));
    assert!((overlap - 20.0 * beta.sin() / (PI * 3.0)).abs() < 1e-12, "{overlap}");
    assert!((total - overlap - smallest).abs() < 1e-12 && smallest > 1.0, "{total}");
}
