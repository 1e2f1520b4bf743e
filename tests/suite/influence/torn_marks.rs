//! Influences of the marks that a built-up edge tears: the mean over flanks against Campbell's theorem.
//!
//! Marks are elliptic paraboloids of a Poisson process. By Campbell's theorem (Rice, *Mathematical analysis of random
//! noise*, Bell System Technical Journal 23, 1944) they lower a flank by lambda E(d) pi E(a) E(b) / 2 in the mean, d
//! being their depth and a, b their half axes. Its derivatives are what the influences are in the mean.

use super::round::{SCENE, backend};
use gearcut::influence::budget::chosen;
use gearcut::influence::derivative::Influence;
use gearcut::influence::gear_grid::{FlankGrid, GearGrid, evenly};
use gearcut::process;
use gearcut::terms::Side;
use std::f64::consts::PI;
use std::path::Path;

const SECTION: &str = "tool.shaper_cutter.built_up_edge";
/// lambda, 1/mm2; depth, um; width and length of scratches, mm; which share of the marks scratches are.
const DENSITY: f64 = 25.0;
const DEPTH_UM: f64 = 2.0;
const WIDTH_MM: f64 = 0.06;
const LENGTH_MM: f64 = 0.3;
const SCRATCHES: f64 = 0.5;
/// Flanks that are looked at, and places along profile and tooth: rims of marks are as far apart.
const FLANKS: u32 = 8;
const PLACES: [usize; 2] = [60, 80];

fn settings() -> Vec<String> {
    let own = [
        format!("density_per_mm2={DENSITY}"),
        format!("depth_um={DEPTH_UM}"),
        format!("width_um={}", 1e3 * WIDTH_MM),
        format!("scratch_length_um={}", 1e3 * LENGTH_MM),
        format!("scratch_share={SCRATCHES}"),
        "speeds_m_per_min=[0, 1000]".to_owned(),
        "full_speeds_m_per_min=[0, 1000]".to_owned(),
        "chip_um=1".to_owned(),
        "chip_exponent=0".to_owned(),
    ];
    let own = own.map(|setting| format!("{SECTION}.{setting}"));
    own.into_iter().chain(["operation.finish.strokes_per_revolution=480".to_owned()]).collect()
}

/// Derivatives of the mean height, um per unit: by the density, and by um of depth, width and length.
fn by_campbell() -> [(&'static str, f64); 4] {
    let (a_mm, pit_mm, scratch_mm) = (0.5 * WIDTH_MM, 0.5 * WIDTH_MM, 0.5 * LENGTH_MM);
    let b_mm = SCRATCHES * scratch_mm + (1.0 - SCRATCHES) * pit_mm;
    let per_area = 0.5 * PI * DENSITY * DEPTH_UM;
    let lowered_um = per_area * a_mm * b_mm;
    [
        ("density_per_mm2", -lowered_um / DENSITY),
        ("depth_um", -lowered_um / DEPTH_UM),
        // The width makes both axes of a pit.
        ("width_um", -per_area * (0.5 * b_mm + a_mm * 0.5 * (1.0 - SCRATCHES)) * 1e-3),
        ("scratch_length_um", -per_area * a_mm * 0.5 * SCRATCHES * 1e-3),
    ]
}

fn grid(loaded: &gearcut::scene::LoadedScene) -> GearGrid {
    let mut flanks = Vec::new();
    process::prepare(&loaded.scene)
        .expect("a gear")
        .with_gear(&mut |gear| {
            for tooth in 1..=FLANKS / 2 {
                for side in [Side::Left, Side::Right] {
                    let [from_mm, to_mm] = gear.evaluated_profile_mm(tooth, side)?;
                    let arcs_mm = evenly([from_mm + 0.3, to_mm - 0.3], PLACES[0]);
                    flanks.push(FlankGrid::new(gear, tooth, side, arcs_mm, evenly([-9.0, 9.0], PLACES[1]))?);
                }
            }
            Ok(())
        })
        .expect("flanks");
    GearGrid { teeth: loaded.scene.gear.teeth, flanks }
}

#[test]
fn influences_of_torn_marks_are_those_of_campbells_theorem_in_the_mean() {
    let loaded = process::parse(SCENE, "round.toml", Path::new(""), &settings()).expect("a scene");
    let grid = grid(&loaded);
    let before_um = grid.heights_um(&loaded.scene, &backend()).expect("cut");
    for (key, expected) in by_campbell() {
        let parameter = chosen(&loaded, &[format!("{SECTION}.{key}")]).expect("a parameter").remove(0);
        let influence = Influence::new(&loaded, &grid, &before_um, &parameter, &backend()).expect("cut");
        let means: Vec<f64> =
            grid.split(&influence.um_per_unit).map(|(_, um)| um.iter().sum::<f64>() / um.len() as f64).collect();
        // Flanks are independent.
        let count = f64::from(FLANKS);
        let mean = means.iter().sum::<f64>() / count;
        let error = (means.iter().map(|of| (of - mean).powi(2)).sum::<f64>() / (count - 1.0) / count).sqrt();
        println!("{key}: {mean:.6} +- {error:.6} for {expected:.6} um per unit");
        assert!((mean - expected).abs() < 4.0 * error, "{key}: {mean} +- {error} for {expected} um per unit");
        // Planted: half as much again is noticed.
        assert!((mean - 1.5 * expected).abs() > 4.0 * error, "{key}: {mean} +- {error} says nothing");
    }
}
