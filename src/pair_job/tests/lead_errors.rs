//! Errors that vary along the face are rolled in sections by default, against closed forms: a guide that leans by f
//! over the face along the pitch circle takes f of the play, as right flanks touch at one end of the face and left ones
//! at the other.

use super::*;
use crate::pair_job::flanks::{FlankSource, errors_vary_along_tooth, made_ready};
use crate::pair_job::options::PairOptions;
use crate::pair_job::rolled::roll_pair;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::units::UM_PER_MM;

/// Face width, mm, and what a guide of 100 um in 100 mm leans over it.
const FACE_MM: f64 = 20.0;
const LEAN_UM: f64 = 20.0;
const LEANS: &str = "[machine.errors.guide]\ntangential_um_per_100mm = 100.0\n";
/// Ridges of both gears, um.
const STROKES_UM: f64 = 1.0;

fn gear(teeth: u32, allowance_mm: f64, more: &str) -> LoadedScene {
    let strokes = 120 * teeth;
    parsed(
        "gear",
        &format!(
            "[gear]\nmodule_mm = 3.0\nteeth = {teeth}\nface_width_mm = {FACE_MM:?}\n\
             addendum_coefficient = 0.6\ntooth_thickness_allowance_mm = {allowance_mm:?}\n\
             [tool.shaper_cutter]\nteeth = 16\naddendum_coefficient = 0.8\n{more}\
             [[operation]]\nname = \"finish\"\nstrokes_per_revolution = {strokes}\n[operation.infeed.none]\n\
             [fields.flank]\nprofile_spacing_um = 40.0\n"
        ),
    )
}

#[test]
fn a_leaning_guide_takes_from_the_backlash() {
    let (a, b) = (gear(24, -0.1, LEANS), gear(24, 0.0, ""));
    for (sections, taken_um, count) in [(None, LEAN_UM, 11), (Some(1), 0.0, 1)] {
        let options = PairOptions { sections, positions: Some(192), ..PairOptions::default() };
        let pair =
            unwatched(|watch| roll_pair([&a.scene, &b.scene], &options, &Cpu::default(), watch)).expect("a pair");
        assert_eq!(pair.flanks.rows_mm.len(), count);
        for play in &pair.backlash {
            let um = UM_PER_MM * play.tangential_mm;
            assert!((um - (100.0 - taken_um)).abs() < STROKES_UM, "{um} um in {count} sections");
        }
    }
}

/// What makes sections differ, of either process, and what does not.
#[test]
fn one_section_is_enough_where_errors_repeat_along_the_face() {
    let vary = |scene: &str, setting: &str| {
        let settings: Vec<String> = setting.split_whitespace().map(str::to_owned).collect();
        let gear = process::load(Path::new(scene), &settings).unwrap_or_else(|errors| panic!("{setting}: {errors}"));
        let ready = made_ready([&gear.scene; 2], FlankSource::Cut).expect("gears that can be cut");
        errors_vary_along_tooth(&ready.expect("cut ones")).expect("strokes that can be followed")
    };
    for (shaped, setting) in [
        (false, ""),
        (false, "mounting.eccentricity_um=20"),
        (false, "tool.shaper_cutter.runout_um=20"),
        (true, "mounting.wobble_um_per_100mm=20"),
        (true, "machine.errors.guide.radial_bow_um=5"),
        (true, "machine.errors.work.noise_arcsec=5 machine.errors.work.noise_bandwidth_hz=20"),
    ] {
        assert_eq!(vary("scenes/shaping/circular_m3_z24.toml", setting), shaped, "{setting}");
    }
    for (hobbed, setting) in [
        (false, ""),
        (false, "mounting.eccentricity_um=20"),
        (true, "mounting.wobble_um_per_100mm=20"),
        (true, "machine.errors.guide.tangential_um_per_100mm=50"),
    ] {
        assert_eq!(vary("scenes/hobbing/spline_shaft.toml", setting), hobbed, "{setting}");
    }
}
