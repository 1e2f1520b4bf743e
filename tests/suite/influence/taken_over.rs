//! Jobs that take over what another scene of the same gear has made ready.

use super::cut_gears::{KnownErrors, Random, coarse};
use super::round::{SCENE, backend};
use gearcut::influence::gear_grid::GearGrid;
use gearcut::process::{self, ProcessJob};
use gearcut::scene::{LoadedScene, Scene};
use gearcut::terms::Side;
use std::path::Path;

/// Heights of both flanks of the first tooth, at places of the job's own target.
fn heights_um(job: &dyn ProcessJob) -> Vec<f64> {
    let mut grid = None;
    job.with_gear(&mut |gear| {
        grid = Some(GearGrid::inspected(gear, &[(1, Side::Left), (1, Side::Right)], false)?);
        Ok(())
    })
    .expect("flanks");
    grid.expect("a gear").heights_of_um(job, &backend()).expect("cut")
}

fn with(settings: &[&str]) -> LoadedScene {
    let coarse = ["gear.teeth=16", "operation.finish.strokes_per_revolution=600"];
    let settings: Vec<String> = coarse.iter().chain(settings).map(|&setting| setting.to_owned()).collect();
    process::parse(SCENE, "round.toml", Path::new(""), &settings).expect("a scene")
}

fn hobbed(settings: &[&str]) -> LoadedScene {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    process::load(Path::new("scenes/hobbing/circular_spur.toml"), &settings).expect("a scene")
}

fn ready(loaded: &LoadedScene) -> Box<dyn ProcessJob> {
    process::prepare(&loaded.scene).expect("a gear")
}

/// The peer is the job that is made ready from nothing.
fn is_the_same(sound: &LoadedScene, with_errors: &Scene) {
    let first = ready(sound);
    let sound_um = heights_um(first.as_ref());
    let anew = heights_um(process::prepare(with_errors).expect("a gear").as_ref());
    let taken_over = heights_um(first.with_errors_of(with_errors).expect("a gear").as_ref());
    assert_eq!(taken_over, anew);
    assert_ne!(anew, sound_um, "errors that do nothing say nothing");
}

#[test]
fn a_gear_with_other_errors_is_the_same_whether_its_target_is_taken_over_or_found_anew() {
    let shaped = coarse();
    is_the_same(&shaped, &KnownErrors::draw(&shaped, &mut Random(5)).scene(&shaped));
    let errors =
        hobbed(&["mounting.eccentricity_um=8", "tool.hob.runout_um=6", "machine.errors.guide.radial_bow_um=3"]);
    is_the_same(&hobbed(&[]), &errors.scene);
}

/// Everything that makes another target: nothing is taken over from a gear that differs in it.
fn each_has_its_own(of: fn(&[&str]) -> LoadedScene, others: &[&str]) {
    let places = |job: &dyn ProcessJob| {
        let mut rays = Vec::new();
        job.with_gear(&mut |gear| {
            let arcs_mm = gear.even_arcs_mm(1, Side::Left, gear.profile_length_mm(1, Side::Left)? / 8.0)?;
            rays = gear.target_points(1, Side::Left, &arcs_mm, &[0.0])?;
            Ok(())
        })
        .expect("a flank");
        rays
    };
    let first = ready(&of(&[]));
    let of_first = places(first.as_ref());
    for &setting in others {
        let other = of(&[setting]);
        let anew = places(ready(&other).as_ref());
        assert_eq!(places(first.with_errors_of(&other.scene).expect("a gear").as_ref()), anew, "{setting}");
        // Planted: the target of the first gear is another one.
        assert_ne!(of_first, anew, "{setting} does not matter");
    }
}

#[test]
fn another_gear_does_not_take_the_target_over() {
    let shaped = [
        "gear.tooth_thickness_allowance_mm=0.05",
        "gear.addendum_coefficient=0.9",
        "gear.profile_shift_coefficient=0.1",
        "tool.shaper_cutter.teeth=24",
        "tool.shaper_cutter.addendum_coefficient=1.2",
        "tool.shaper_cutter.profile_shift_coefficient=0.05",
        "tool.shaper_cutter.tip.round.radius_mm=0.3",
        "operation.finish.offset_mm=0.02",
    ];
    each_has_its_own(with, &shaped);
    let hobbed_ones = [
        "gear.tooth_thickness_allowance_mm=0.05",
        "gear.addendum_coefficient=0.9",
        "gear.profile_shift_coefficient=0.1",
        "tool.hob.tip_radius_mm=0.3",
        "tool.hob.thinning_mm=0.05",
    ];
    each_has_its_own(hobbed, &hobbed_ones);
}
