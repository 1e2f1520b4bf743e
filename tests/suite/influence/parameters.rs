//! Which errors are shifted, and what shifting the size of something random means.

use super::round::{SCENE, backend, grid};
use gearcut::influence::budget::chosen;
use gearcut::influence::derivative::{Influence, refusal};
use gearcut::process;
use gearcut::scene::LoadedScene;
use std::path::Path;

fn loaded(more: &str, settings: &[&str]) -> LoadedScene {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    process::parse(&format!("{SCENE}{more}"), "round.toml", Path::new(""), &settings).expect("a scene")
}

fn ids(loaded: &LoadedScene, names: &[&str]) -> Vec<String> {
    let names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
    chosen(loaded, &names).expect("parameters").into_iter().map(|parameter| parameter.id).collect()
}

#[test]
fn what_the_cut_does_is_tried_where_it_is_and_what_is_random_where_it_is_named() {
    let plain = loaded("", &[]);
    let cut_or_random = |ids: &[String]| {
        let words = ["noise", "compliance", "edge_", "scatter"];
        ids.iter().filter(|id| words.iter().any(|word| id.contains(word))).count()
    };
    assert_eq!(cut_or_random(&ids(&plain, &[])), 0);
    assert_eq!(cut_or_random(&ids(&plain, &["machine.errors", "tool", "operation.0.stock_scatter_um"])), 1);
    assert_eq!(ids(&plain, &["machine.compliance"]).len(), 6);
    assert_eq!(ids(&plain, &["tool.shaper_cutter.edge_rounding"]).len(), 2);
    for name in [
        "machine.errors.work.noise_arcsec",
        "machine.errors.center_distance.noise_um",
        "tool.shaper_cutter.edge_roughness.rq_um",
        "operation.0.stock_scatter_um",
    ] {
        assert_eq!(ids(&plain, &[name]), [name]);
    }
    // Where the scene has it, it is one of all: the keys that are there.
    let soft = loaded(
        "[tool.shaper_cutter.edge_rounding]\nradius_um = 5.0\nminimum_chip_share = 0.3\n",
        &["machine.compliance.tool_radial_um_per_kn=8", "machine.errors.center_distance.noise_um=0.5"],
    );
    let all = ids(&soft, &[]);
    assert_eq!(cut_or_random(&all), 3, "{all:?}");
    assert!(all.contains(&"machine.compliance.tool_radial_um_per_kn".to_owned()));
}

/// Equal seeds: heights grow in proportion to the standard deviation of a noise so slow that neighbouring strokes have
/// the same, so that the derivative times the deviation is all that the noise does.
#[test]
fn the_derivative_by_a_noise_is_the_course_of_its_seed() {
    let sigma_um = 2.0;
    let key = "machine.errors.center_distance.noise_um";
    let noisy = |seed: &str| {
        loaded("", &[&format!("{key}={sigma_um}"), "machine.errors.center_distance.noise_bandwidth_hz=2e-4", seed])
    };
    let (still, first, second) = (loaded("", &[]), noisy("machine.errors.seed=1"), noisy("machine.errors.seed=2"));
    let grid = grid(&still);
    let heights_um = |of: &LoadedScene| grid.heights_um(&of.scene, &backend()).expect("cut");
    let (quiet_um, noisy_um) = (heights_um(&still), heights_um(&first));
    let parameter = chosen(&first, &[key.to_owned()]).expect("a noise").remove(0);
    let influence =
        |of: &LoadedScene| Influence::new(of, &grid, &heights_um(of), &parameter, &backend()).expect("cut").um_per_unit;
    let whole_um: Vec<f64> = noisy_um.iter().zip(&quiet_um).map(|(a, b)| a - b).collect();
    let most_um = whole_um.iter().fold(0.0, |most: f64, um| most.max(um.abs()));
    assert!(most_um > 0.3 * sigma_um, "{most_um} um");
    let off = |per_unit: &[f64]| {
        per_unit.iter().zip(&whole_um).map(|(of, whole)| (sigma_um * of - whole).abs()).fold(0.0, f64::max)
    };
    // Marks of strokes move by 0.02 um.
    let own = off(&influence(&first));
    assert!(own < 0.02 + 0.01 * most_um, "{own} of {most_um} um");
    // Planted: another seed is another course.
    assert!(off(&influence(&second)) > 0.2 * most_um);
}

/// An upright head leans nowhere: the note says so, and nothing of a command line that nobody wrote.
#[test]
fn a_refused_step_is_said_in_the_words_of_its_problem() {
    let loaded = process::load(Path::new("scenes/bevel/five_linkage_printed.toml"), &[]).expect("a scene");
    let key = "machine.cradle_errors.swivel_deg";
    let parameter = chosen(&loaded, &[key.to_owned()]).expect("a parameter").remove(0);
    let error = Influence::by(&loaded, &[], &parameter, &|_| Ok(Vec::new())).expect_err("nothing leans");
    let why = refusal(error).expect("a refusal");
    assert!(why.contains("an upright head leans nowhere"), "{why}");
    assert!(!["error:", "--set", "way out", "\n"].iter().any(|nested| why.contains(nested)), "{why}");
}
