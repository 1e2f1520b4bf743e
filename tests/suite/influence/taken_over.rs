//! Jobs that take over what another scene of the same gear has made ready.

use super::cut_gears::{KnownErrors, Random, coarse};
use super::round::{SCENE, backend};
use gearcut::influence::gear_grid::GearGrid;
use gearcut::process::{self, ProcessJob};
use gearcut::scene::LoadedScene;
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

/// The peer is the job that is made ready from nothing.
#[test]
fn a_gear_with_other_errors_is_the_same_whether_its_target_is_taken_over_or_found_anew() {
    let loaded = coarse();
    let ready = process::prepare(&loaded.scene).expect("a gear");
    let errors = KnownErrors::draw(&loaded, &mut Random(5)).scene(&loaded);
    let anew = heights_um(process::prepare(&errors).expect("a gear").as_ref());
    let taken_over = heights_um(ready.with_errors_of(&errors).expect("a gear").as_ref());
    assert_eq!(taken_over, anew);
    assert_ne!(anew, heights_um(ready.as_ref()), "errors that do nothing say nothing");
}

/// Everything that makes another target: nothing is taken over from a gear that differs in it.
#[test]
fn another_gear_does_not_take_the_target_over() {
    let first = with(&[]);
    let ready = process::prepare(&first.scene).expect("a gear");
    let others = [
        "gear.tooth_thickness_allowance_mm=0.05",
        "gear.addendum_coefficient=0.9",
        "gear.profile_shift_coefficient=0.1",
        "tool.shaper_cutter.teeth=24",
        "tool.shaper_cutter.addendum_coefficient=1.2",
        "tool.shaper_cutter.profile_shift_coefficient=0.05",
        "tool.shaper_cutter.tip.round.radius_mm=0.3",
        "operation.finish.offset_mm=0.02",
    ];
    let places = |job: &dyn ProcessJob| {
        let mut rays = Vec::new();
        job.with_gear(&mut |gear| {
            rays = gear.target_points(1, Side::Left, gear.profile_length_mm(1, Side::Left)? / 8.0, &[0.0])?.1;
            Ok(())
        })
        .expect("a flank");
        rays
    };
    for setting in others {
        let other = with(&[setting]);
        let anew = places(process::prepare(&other.scene).expect("a gear").as_ref());
        assert_eq!(places(ready.with_errors_of(&other.scene).expect("a gear").as_ref()), anew, "{setting}");
        // Planted: the target of the first gear is another one.
        assert_ne!(places(ready.as_ref()), anew, "{setting} does not matter");
    }
}
