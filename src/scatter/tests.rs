//! Layers, rows and quantiles, without cutting.

use super::layers::cases;
use super::numbers::NUMBERS;
use super::rows::{self, Rows};
use super::statistics::Spread;
use crate::machine_errors::ErrorLayer;
use crate::process;
use std::fs;
use std::path::Path;

/// R's `quantile(c(7, 1, 3, 10, 2), c(.05, .5, .95))`, type 7: 1.2, 3.0, 9.4.
#[test]
fn quantiles_are_those_of_other_programs() {
    let spread = Spread::of([7.0, 1.0, 3.0, 10.0, 2.0]).expect("five values");
    for (found, expected) in [(spread.low, 1.2), (spread.median, 3.0), (spread.high, 9.4)] {
        assert!((found - expected).abs() < 1e-12, "{spread:?}");
    }
    assert!(Spread::of([]).is_none());
    let one = Spread::of([4.0]).expect("one value");
    assert_eq!([one.low, one.median, one.high], [4.0; 3]);
}

#[test]
fn a_line_that_was_broken_off_is_cut_away_and_the_others_stay() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("seeds.csv");
    let values = |of: f64| (0..NUMBERS.len()).map(|i| (i != 3).then_some(of + i as f64 / 3.0)).collect::<Vec<_>>();
    let (file, rows) = rows::open(folder.path()).expect("made");
    assert!(rows.is_empty());
    for seed in [5, 2, 9] {
        file.add(&seed, &values(f64::from(seed))).expect("written");
    }
    let whole = fs::read_to_string(&path).expect("text");
    // A kill in the middle of a line, at any place of it.
    let last_line = whole.trim_end().rfind('\n').expect("lines") + 1;
    for end in last_line..whole.len() {
        fs::write(&path, &whole[..end]).expect("written");
        let (file, rows) = rows::open(folder.path()).expect("read");
        assert_eq!(rows, Rows::from([(2, values(2.0)), (5, values(5.0))]), "broken off at {end}");
        file.add(&7, &values(7.0)).expect("written");
        assert_eq!(rows::open(folder.path()).expect("read").1.len(), 3);
    }
    fs::write(&path, "seed,other\n1,2\n").expect("written");
    assert!(rows::open(folder.path()).is_err(), "another table is no table of these");
}

#[test]
fn layers_of_a_scene_are_switched_one_by_one() {
    let load = |scene: &str| process::load(Path::new(scene), &[]).expect("a scene").scene;
    for (scene, layers) in [
        ("scenes/shaping/noise.toml", &[ErrorLayer::Noise, ErrorLayer::Stock, ErrorLayer::Edge][..]),
        (
            "scenes/shaping/machine_errors.toml",
            &[ErrorLayer::Axes, ErrorLayer::Guide, ErrorLayer::Mounting, ErrorLayer::Tool],
        ),
        (
            "scenes/hobbing/machine_errors.toml",
            &[ErrorLayer::Axes, ErrorLayer::Guide, ErrorLayer::Mounting, ErrorLayer::Tool],
        ),
        ("scenes/bevel/machine_errors.toml", &[ErrorLayer::Axes, ErrorLayer::Mounting, ErrorLayer::Tool]),
        ("scenes/shaping/deflection.toml", &[ErrorLayer::Deflection]),
        ("scenes/shaping/ploughing.toml", &[ErrorLayer::Ploughing]),
        ("scenes/shaping/built_up_edge.toml", &[ErrorLayer::Tearing]),
        ("scenes/shaping/circular_m3_z24.toml", &[]),
    ] {
        let full = load(scene);
        assert_eq!(full.process.error_layers(), layers, "{scene}");
        for case in cases(layers) {
            let mut kept = full.clone();
            kept.process.keep_layers(&case.kept);
            assert_eq!(kept.process.error_layers(), case.kept, "{scene}: {}", case.name);
            assert_eq!(kept == full, case.kept == layers, "{scene}: {}", case.name);
        }
    }
}
