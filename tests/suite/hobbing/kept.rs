//! What a job computes once: passes and targets, whoever asks, and nothing is cut twice for one flank.

use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::terms::Side;
use std::path::Path;

#[test]
fn passes_and_targets_are_made_once() {
    let scene = load(Path::new("scenes/hobbing/circular_spur.toml"), &[]).unwrap_or_else(|e| panic!("{e}")).scene;
    let job = HobbingJob::new(&scene).expect("a scene that cuts");
    let [first, second] = [0, 1].map(|_| HobCutter::new(&job).expect("passes"));
    assert!(std::ptr::eq(first.operations.as_ptr(), second.operations.as_ptr()));
    let target = |cutter| std::ptr::from_ref(HobCutter::target(cutter, 3, Side::Right).expect("a flank"));
    assert_eq!(target(&first), target(&second));
    // Another job has its own.
    let other_job = HobbingJob::new(&scene).expect("a scene that cuts");
    let other = HobCutter::new(&other_job).expect("passes");
    assert!(!std::ptr::eq(first.operations.as_ptr(), other.operations.as_ptr()));
    assert_ne!(target(&first), target(&other));
}
