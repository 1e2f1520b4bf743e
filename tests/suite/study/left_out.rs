//! What studies leave out changes nothing of what they keep: bit for bit, whatever is kept.

use crate::fixtures::stopping::Stopping;
use gearcut::backend::{BackendWish, Choice, OnFailure, choose};
use gearcut::findings::{Findings, Quantity};
use gearcut::interrupt::Interrupt;
use gearcut::process::{self, ProcessJob};
use gearcut::run::Run;
use gearcut::scene::LoadedScene;
use gearcut::steps::parts::{Stage, Stages};
use std::collections::BTreeMap;
use std::path::Path;

/// All quantities by their paths.
fn quantities(found: &Findings) -> BTreeMap<String, Quantity> {
    let headline = found.headline.iter().map(|entry| (entry.key.clone(), entry.quantity.clone()));
    let mut all: BTreeMap<_, _> = headline.collect();
    found.walk(&mut |path, section| {
        all.extend(section.entries.iter().map(|entry| (format!("{path}.{}", entry.key), entry.quantity.clone())));
    });
    all
}

/// Every quantity of a gear, with its own stages alone, is that of the whole run; what other stages find is missing.
fn compare(scene: &str, settings: &[&str], stages: &[Stage]) {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let scene = process::load_draft(Path::new(scene), &settings).expect("a scene");
    let choice = choose(BackendWish::Cpu, OnFailure::Stop).expect("the processor");
    let found = |stages: Stages| {
        let prepared = process::prepare(&scene.scene).expect("a gear");
        quantities(&Run::new(&scene, prepared.as_ref(), &choice).stages(stages).found().expect("findings"))
    };
    let whole = found(Stages::ALL);
    let mut missing = 0;
    let mut compared = 0;
    let sets: Vec<Stages> = whole.keys().map(|path| Stages::of_paths(std::slice::from_ref(path))).collect();
    let alone = Stages::of_paths(&[]);
    for &stage in stages {
        assert!(sets.iter().any(|set| set.has(stage)), "no quantity needs {stage:?}");
    }
    let mut distinct = vec![alone];
    for set in sets {
        if !distinct.contains(&set) {
            distinct.push(set);
        }
    }
    assert_eq!(distinct.len(), 1 + stages.len());
    for set in distinct {
        let few = found(set);
        for (path, quantity) in &whole {
            if set.find(path) {
                assert_eq!(few.get(path), Some(quantity), "{path}");
                compared += 1;
            } else {
                assert!(!few.contains_key(path), "{path}");
                missing += 1;
            }
        }
    }
    println!("{}: {compared} compared, {missing} missing, {} in all", scene.scene.name, whole.len());
    assert!(compared > 500 && missing > 50, "{compared}, {missing}");
}

#[test]
fn of_a_shaped_gear() {
    let small = ["gear.face_width_mm=4", "gear.teeth=12", "gear.profile_shift_coefficient=0.4"];
    let all = [Stage::Texture, Stage::Blank, Stage::Chips, Stage::Roots, Stage::Allowances];
    compare("scenes/shaping/circular_m3_z24.toml", &small, &all);
}

/// A machine that yields has sections of its own that follow from chips.
#[test]
fn of_a_machine_that_yields() {
    let all = [Stage::Texture, Stage::Blank, Stage::Chips, Stage::Roots, Stage::Allowances];
    let few = ["rough", "finish"].map(|name| format!("operation.{name}.strokes_per_revolution=240"));
    compare("scenes/shaping/deflection.toml", &["gear.face_width_mm=4", "gear.teeth=12", &few[0], &few[1]], &all);
}

/// What a case takes over from another one is what it would find itself: the peer is a job made ready from nothing.
#[test]
fn of_what_cases_share() {
    let few = ["rough", "finish"].map(|name| format!("operation.{name}.strokes_per_revolution=300"));
    let small = ["gear.face_width_mm=4", "gear.teeth=12", "gear.profile_shift_coefficient=0.4", &few[0], &few[1]];
    let of = |setting: &str| {
        let settings: Vec<String> = small.iter().chain([&setting]).map(|&setting| setting.to_owned()).collect();
        process::load_draft(Path::new("scenes/shaping/circular_m3_z24.toml"), &settings).expect("a scene")
    };
    let choice = choose(BackendWish::Cpu, OnFailure::Stop).expect("the processor");
    // All but rays through the blank, which are their own.
    let stages = Stages::of_paths(&["unevenness_max", "idle_strokes", "root_stock"].map(str::to_owned));
    let found = |scene: &LoadedScene, prepared: &dyn ProcessJob| {
        let found = Run::new(scene, prepared, &choice).stages(stages).found().expect("findings");
        (quantities(&found), found.warnings)
    };
    let base = of("gear.module_mm=3");
    let first = process::prepare(&base.scene).expect("a gear");
    let of_first = found(&base, first.as_ref());
    for setting in [
        "operation.finish.strokes_per_revolution=400",
        "operation.rough.offset_mm=0.3",
        "operation.finish.offset_mm=0.02",
        "operation.rough.linkage={ shaping_traditional = {} }",
        "machine.back_off_mm=0.2",
        "machine.retraction=\"tilted\"",
        "mounting.eccentricity_um=9",
        "tool.shaper_cutter.runout_um=8",
        "tool.shaper_cutter.edge_roughness={ rq_um = 0.4, correlation_length_um = 30.0 }",
        "tool.shaper_cutter.tip={ round = { radius_mm = 0.3 } }",
        "tool.shaper_cutter.teeth=22",
        "gear.profile_shift_coefficient=0.5",
    ] {
        let scene = of(setting);
        let anew = found(&scene, process::prepare(&scene.scene).expect("a gear").as_ref());
        let shared = found(&scene, first.with_errors_of(&scene.scene).expect("a gear").as_ref());
        assert_eq!(shared, anew, "{setting}");
        assert_ne!(anew.0, of_first.0, "{setting} does not matter");
    }
}

/// The axes alone have the peaks that a cut has.
#[test]
fn of_axes() {
    let narrow = "gear.face_width_mm=3".to_owned();
    for scene in ["shaping/elliptical_normal", "hobbing/machine_errors", "bevel/machine_errors"] {
        let narrow = if scene.starts_with("bevel") { &[] } else { std::slice::from_ref(&narrow) };
        let scene = process::load_draft(Path::new(&format!("scenes/{scene}.toml")), narrow).expect("a scene");
        let choice = choose(BackendWish::Cpu, OnFailure::Stop).expect("the processor");
        let prepared = process::prepare(&scene.scene).expect("a gear");
        let run = Run::new(&scene, prepared.as_ref(), &choice).stages(Stages::of_paths(&[]));
        let cut = quantities(&run.found().expect("findings"));
        let axes = quantities(&process::axis_peaks(&scene.scene).expect("peaks"));
        assert!(axes.len() > 10, "{}", scene.scene.name);
        for (path, quantity) in axes {
            assert_eq!(cut.get(&path), Some(&quantity), "{}: {path}", scene.scene.name);
        }
    }
}

/// A gear that Ctrl-C broke off says so, with all stages and with none: its row must not be kept.
#[test]
fn a_broken_off_gear_is_not_complete() {
    let scene = process::load(Path::new("scenes/shaping/circular_m3_z24.toml"), &[]).expect("a scene");
    let prepared = process::prepare(&scene.scene).expect("a gear");
    for stages in [Stages::of_paths(&[]), Stages::ALL] {
        let interrupt = Interrupt::default();
        // At the fifth of 48 flanks.
        let backend = Box::new(Stopping::at(5, &interrupt));
        let choice = Choice { backend, why: String::new(), on_trial: false };
        let run = Run::new(&scene, prepared.as_ref(), &choice).stages(stages).until(&interrupt);
        let found = run.found().expect("findings of some flanks");
        assert!(interrupt.is_raised());
        let is_stopped = found.warnings.iter().any(|notice| notice.id == "cut.stopped");
        assert!(!found.complete && is_stopped, "{:?}", found.warnings);
    }
}
