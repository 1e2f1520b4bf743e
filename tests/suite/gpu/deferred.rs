//! Flanks that are cut on a device without waiting: asked for twice, they are those of the backend that waits.

use crate::fixtures::parity::*;
use gearcut::backend::Choice;
use gearcut::gpu::waiting::wait;
use gearcut::gpu::{Deferred, Gpu};
use gearcut::{Error, Flank, Job, LoadedScene, Result, Side};
use std::path::Path;
use std::sync::Arc;

fn scene(file: &str) -> LoadedScene {
    let settings = ["fields.flank.profile_spacing_um=40", "fields.flank.lead_spacing_um=2000"];
    gearcut::load(Path::new(file), &settings.map(str::to_owned)).unwrap_or_else(|problems| panic!("{problems}"))
}

fn on(job: &Job, backend: impl gearcut::cut::Backend + 'static) -> Job {
    job.clone().on(Choice { backend: Box::new(backend), why: "asked for".to_owned(), on_trial: false })
}

fn layers(flank: Flank) -> Vec<gearcut::dexel::Layer> {
    flank.into_arrays().2
}

/// Shaped flanks come as fields in a plane, hobbed ones as rays in space.
#[test]
fn a_deferred_flank_has_the_bits_of_one_that_was_waited_for() {
    let gpu = || software_gpu(strict());
    for file in ["scenes/shaping/elliptical_normal.toml", "scenes/hobbing/circular_spur.toml"] {
        let job = Job::new(scene(file)).expect("a scene that cuts");
        let expected = layers(on(&job, gpu()).cut_flank(3, Side::Right).expect("a flank"));
        let deferred = Deferred::new(Arc::new(gpu()));
        let twice = on(&job, deferred.clone());
        for _ in 0..2 {
            let first: Result<Flank> = twice.cut_flank(3, Side::Right);
            assert!(matches!(first, Err(Error::Interrupted)), "{file}: {:?}", first.map(|flank| flank.shape()));
            wait(deferred.settle()).expect("the device works");
            let flank = twice.cut_flank(3, Side::Right).expect("what was brought back");
            assert!(layers(flank) == expected, "{file}: other bits");
        }
    }
}

#[test]
fn a_lost_device_is_told_and_leaves_nothing_behind() {
    let gpu: Arc<Gpu> = Arc::new(software_gpu(strict()));
    let job = Job::new(scene("scenes/shaping/elliptical_normal.toml")).expect("a scene that cuts");
    let deferred = Deferred::new(gpu.clone());
    let twice = on(&job, deferred.clone());
    assert!(matches!(twice.cut_flank(1, Side::Left), Err(Error::Interrupted)));
    gpu.lose_device();
    let problem = wait(deferred.settle()).expect_err("no device").to_string();
    assert!(problem.contains("lost"), "{problem}");
    assert!(matches!(twice.cut_flank(1, Side::Left), Err(Error::Interrupted)), "asked for anew, not taken for done");
}
