//! Gears off their axes against masters and mates, wide play, and what options of mounting may say.

use super::*;
use crate::pair_job::fit::Fit;
use crate::pair_job::flanks::FlankSource;
use crate::pair_job::member;
use crate::pair_job::options::PairOptions;
use crate::pair_job::rolled::{RolledPair, roll_pair};
use crate::scene::Mate;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::gear::GearKind;
use gearcut_core::units::UM_PER_MM;

const RING: &str = "kind = \"internal\"\nrim_mm = 10.0\n";

fn rolled(a: &LoadedScene, b: &LoadedScene, options: &PairOptions) -> RolledPair {
    let scenes = [&a.scene, &b.scene];
    unwatched(|watch| roll_pair(scenes, options, &Cpu::default(), watch)).unwrap_or_else(|error| panic!("{error}"))
}

/// Off its axis by e, a gear comes e nearer to a master and goes e away: F_i" is 2 e. The centre distance follows
/// e cos(angle - at) to first order, so f_i" is e 2 sin(pi / z) about its steepest place.
#[test]
fn masters_feel_a_gear_that_is_off_its_axis() {
    let (a, b) = (round("a", 24, "", ""), round("b", 36, "", ""));
    let few = PairOptions { source: FlankSource::Nominal, positions: Some(576), ..PairOptions::default() };
    for offs in [[[0.0, 0.0], [0.0, 0.0]], [[20.0, 0.0], [0.0, 0.0]], [[12.0, 50.0], [35.0, -130.0]]] {
        let options = PairOptions { eccentricity_um_deg: offs, ..few.clone() };
        let pair = rolled(&a, &b, &options);
        for (found, ([um, at_deg], teeth)) in pair.masters.iter().zip(offs.into_iter().zip([24.0_f64, 36.0])) {
            let found = found.as_ref().expect("a master");
            // Eight places in a pitch miss the largest value by up to half a step.
            let missed_um = 2.0 * um * (1.0 - (std::f64::consts::PI / (8.0 * teeth)).cos()) + 1e-3;
            assert!((found.total_um() - 2.0 * um).abs() <= missed_um + 1e-3 * um, "{} um of {um}", found.total_um());
            let pitch_um = 2.0 * um * (std::f64::consts::PI / teeth).sin();
            assert!((found.in_a_pitch_um() - pitch_um).abs() < 0.02 * um + 1e-3, "{} um", found.in_a_pitch_um());
            let [at_rad, _] = *found.variation_rad_um.iter().max_by(|a, b| a[1].total_cmp(&b[1])).expect("places");
            let beside_deg = (at_rad.to_degrees() - at_deg + 180.0).rem_euclid(360.0) - 180.0;
            assert!(um == 0.0 || beside_deg.abs() < 3.0, "farthest at {} deg", at_rad.to_degrees());
        }
    }
}

/// Shifted gears against masters, which are not shifted: even, for any shift of the mate, as cut and as drawn. With
/// the mate's height a master went 0.48 mm up and down on fillets, and 9 um on flanks that it left too early.
#[test]
fn masters_meet_shifted_gears_on_their_flanks() {
    let shifted = |name: &str, teeth, x: &str| round(name, teeth, "", &format!("profile_shift_coefficient = {x}\n"));
    for (source, x, most_um) in [(FlankSource::Cut, "0.36", 1.0), (FlankSource::Nominal, "-0.6", 0.01)] {
        let (a, b) = (shifted("a", 12, "0.6"), shifted("b", 24, x));
        let pair = rolled(&a, &b, &PairOptions { source, positions: Some(240), ..PairOptions::default() });
        for found in &pair.masters {
            let um = found.as_ref().expect("a master").total_um();
            assert!(um < most_um, "{source:?}, x {x}: {um} um");
        }
    }
}

/// The work off the table's axis while it is cut (`mounting.eccentricity_um`): a master feels 2 e, and the teeth's own.
/// Such a flank turns back in its distance from the axis where the fillet begins; it rolls all the same.
#[test]
fn a_mate_cut_off_its_axis_rolls() {
    let a = third_order(20, 4200, 0.0);
    let settings = ["mounting.eccentricity_um=10".to_owned()];
    let b = member::mate(&a, Mate { teeth: 42, kind: GearKind::External }, &settings).expect("a mate");
    let fit = Fit::new(&a.scene, &b.scene, 0).expect("they belong together");
    let options = PairOptions { positions: Some(336), ..PairOptions::default() };
    let pair = rolled(&a, &b, &options);
    let runs = pair.meshing.sections[0].driven.right.iter().map(|flank| flank.runs.len()).max().expect("flanks");
    assert!(runs > 1, "no flank turns back: this test would not see one that is refused");
    let master = pair.masters[1].as_ref().expect("a master");
    assert!((master.total_um() - 20.0).abs() < 1.0, "{} um", master.total_um());
    assert!(fit.misfit_mm < 1e-6);
}

/// Wide play is play: the sum of the allowances at the distance of the pitch circles, and its tight mesh is found.
#[test]
fn wide_play_is_rolled() {
    let module_1 = |teeth: u32, allowance_mm: f64| {
        parsed(
            "spur",
            &format!(
                "[gear]\nmodule_mm = 1.0\nteeth = {teeth}\ntooth_thickness_allowance_mm = {allowance_mm}\n\
                 [tool.shaper_cutter]\nteeth = 20\n"
            ),
        )
    };
    let spur = |teeth: u32, kind: &str, allowance_mm: f64| {
        round("spur", teeth, kind, &format!("tooth_thickness_allowance_mm = {allowance_mm}\n"))
    };
    for (a, b, play_um) in [
        (module_1(30, -0.08), module_1(60, -0.08), 160.0),
        (spur(20, "", 0.0), spur(60, RING, -0.5), 500.0),
        (spur(25, "", -0.15), spur(50, "", -0.15), 300.0),
    ] {
        let options = PairOptions { source: FlankSource::Nominal, positions: Some(480), ..PairOptions::default() };
        let pair = rolled(&a, &b, &options);
        for play in &pair.backlash {
            let um = UM_PER_MM * play.circumferential_mm;
            assert!((um - play_um).abs() < 1e-3, "{um} um of {play_um}");
        }
        let sign = pair.fit.pitch.sign();
        let found = pair.tight.as_ref().is_ok_and(|tight| tight.mean_um() * sign < 0.0);
        assert!(found, "{play_um} um of play: {:?}", pair.tight.as_ref().err());
        if sign < 0.0 {
            // The ring's tips come below the driver's base circle before the flanks have closed.
            continue;
        }
        let moved_mm = pair.tight.as_ref().expect("a tight mesh").mean_um() / UM_PER_MM;
        // Closed form: 2 a (inv(alpha) - inv(alpha_w)) a / a_w of play left; to first order j / (2 tan(alpha)).
        let (distance_mm, alpha) = (pair.fit.pitch.center_distance_mm(), 20_f64.to_radians());
        let working = (distance_mm * alpha.cos() / (distance_mm + moved_mm)).acos();
        let involute = |angle: f64| angle.tan() - angle;
        let closed_um = sign * UM_PER_MM * 2.0 * distance_mm * (involute(alpha) - involute(working));
        assert!((closed_um - play_um).abs() < 1e-3, "{moved_mm} mm close {closed_um} um of {play_um}");
    }
}

/// A ring whose driver is set back by 30 um: driver r = 35.07685 / (1.06155 - 0.5 sin(phi)). Conjugate flanks are tight
/// where the pitch curves close, so tight mesh is 30 um further on at every angle.
#[test]
fn every_tight_mesh_of_a_ring_is_found() {
    let points: Vec<String> = (0..360)
        .map(|deg| format!("[{deg}.0, {:.9}]", 35.07685 / (1.06155 - 0.5 * f64::from(deg).to_radians().sin())))
        .collect();
    let driver = parsed(
        "driver",
        &format!(
            "[gear]\nmodule_mm = 2.0\nteeth = 40\nface_width_mm = 20.0\n[gear.pitch_curve.table]\n\
             points_deg_mm = [{}]\nscale_to_close = true\n[tool.shaper_cutter]\nteeth = 14\n",
            points.join(", ")
        ),
    );
    let ring = member::mate(&driver, Mate { teeth: 80, kind: GearKind::Internal }, &[]).expect("a ring");
    for off_um in [-30.0, 20.0] {
        let options = PairOptions {
            source: FlankSource::Nominal,
            center_distance_error_um: off_um,
            positions: Some(640),
            ..PairOptions::default()
        };
        let pair = rolled(&driver, &ring, &options);
        let tight = pair.tight.as_ref().expect("a tight mesh");
        // Counted from the distance at which the gears are rolled.
        let worst = tight.variation_rad_um.iter().map(|[_, um]| (um + off_um).abs()).fold(0.0, f64::max);
        println!("ring at {off_um} um: {worst:.2e} um off");
        assert!(worst < 1e-3, "{worst} um");
    }
}

#[test]
fn teeth_are_turned_on_modulo_their_number() {
    let (a, b) = (round("a", 24, "", ""), round("b", 36, "", ""));
    let turned = |phase| Fit::new(&a.scene, &b.scene, phase).expect("a fit");
    for (phase, same) in [(i64::MAX, i64::MAX % 36), (i64::MIN, 36 + i64::MIN % 36), (1_000_000_000_000, 28), (-1, 35)]
    {
        let (one, other) = (turned(phase), turned(same));
        for side in crate::pair_job::fit::SIDES {
            assert_eq!(one.mate_flank(side, 5), other.mate_flank(side, 5), "{phase}");
        }
        assert!((one.turn_rad - other.turn_rad).abs() < 1e-12, "{phase}");
    }
    assert_ne!(
        turned(0).mate_flank(gearcut_core::terms::Side::Right, 5),
        turned(1).mate_flank(gearcut_core::terms::Side::Right, 5)
    );
}
