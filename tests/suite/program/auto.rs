//! A GPU that nobody asked for by name is taken only if it is faster than the processor.

use crate::fixtures::command::read_json;
use gearcut::backend::Choice;
use gearcut::bench::kernel_rates;
use gearcut::cut::cpu::Cpu;
use gearcut::cut::sweep_chips::SweepsCut;
use gearcut::cut::{Backend, BlankCut, BlankOperation, CutStats};
use gearcut::dexel::{BlankField, Field, Layer, SpatialField};
use gearcut::passes::sections::swept_sections::SweptSections;
use gearcut::passes::{CutPlan, SweepPlan};
use gearcut::steps::backend_trial::BackendTrial;
use gearcut::{Job, Parts, Result};
use std::ops::Range;
use std::path::Path;
use std::time::Duration;

/// The native backend, which waits before every planar cut.
#[derive(Default)]
struct Slow {
    cpu: Cpu,
}

impl Backend for Slow {
    fn name(&self) -> String {
        "slow".to_owned()
    }

    fn cut(&self, field: &Field, plan: &CutPlan, layer: &mut Layer) -> Result<CutStats> {
        std::thread::sleep(Duration::from_millis(200));
        self.cpu.cut(field, plan, layer)
    }

    fn cut_blank(
        &self,
        field: &mut BlankField,
        operation: &BlankOperation,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<BlankCut>> {
        self.cpu.cut_blank(field, operation, advance)
    }

    fn cut_blank_sweeps(
        &self,
        field: &mut BlankField,
        sections: &SweptSections,
        passes: Range<u32>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<SweepsCut>> {
        self.cpu.cut_blank_sweeps(field, sections, passes, advance)
    }

    fn cut_spatial(&self, field: &SpatialField, plan: &SweepPlan, layer: &mut Layer) -> Result<CutStats> {
        self.cpu.cut_spatial(field, plan, layer)
    }
}

#[test]
fn a_gpu_that_is_slower_is_not_taken_and_the_record_says_why() {
    let settings = [
        "fields.flank.profile_spacing_um=200",
        "fields.flank.lead_spacing_um=5000",
        "fields.chips.spacing_mm=0.5",
        "fields.blank.spacing_mm=1",
    ];
    let scene = Path::new("scenes/shaping/circular_m3_z24.toml");
    let scene = gearcut::load(scene, &settings.map(str::to_owned)).unwrap_or_else(|problems| panic!("{problems}"));
    let job = Job::new(scene).expect("a scene that cuts");
    let job = job.on(Choice { backend: Box::new(Slow::default()), why: "auto: slow".to_owned(), on_trial: true });
    let folder = tempfile::tempdir().expect("a folder");
    let done = job.run().only(Parts::NONE).into_folder(&folder.path().join("gear")).expect("cuts");
    let record = read_json(&done.folder.path.join("run.json"));
    assert_eq!(record["backend"], Cpu::default().name());
    let why = record["backend_why"].as_str().expect("a text");
    assert!(why.starts_with("auto: slow, not faster than the processor on tiles of this scene: "), "{why}");
    assert!(BackendTrial { native_s: 0.02, gpu_s: 0.01, took_s: 0.1 }.takes_gpu());
}

#[test]
fn rates_are_those_of_the_backend_kernel_by_kernel() {
    let count = std::cell::Cell::new(0);
    let rates = |backend: &dyn Backend| {
        kernel_rates(backend, &|| count.set(count.get() + 1)).expect("cuts").map(|rate| (rate.kernel, rate.per_second))
    };
    let (native, slow) = (rates(&Cpu::default()), rates(&Slow::default()));
    println!("{native:?}\n{slow:?}");
    assert_eq!(count.get(), 8);
    // A flank of 24 teeth takes milliseconds; waiting for 200 of them shows, and only where the backend waits.
    assert!(slow[0].1 < native[0].1 / 2.0);
    assert!((1..4).all(|kernel| slow[kernel].1 > native[kernel].1 / 20.0));
    assert!(native.iter().all(|(_, per_second)| per_second.is_finite() && *per_second > 0.0));
}

#[test]
fn a_choice_on_trial_is_settled_with_its_reason() {
    let on_trial = || Choice { backend: Box::new(Slow::default()), why: "auto: slow".to_owned(), on_trial: true };
    let faster = BackendTrial { native_s: 0.02, gpu_s: 0.01, took_s: 0.09 }.settle(on_trial());
    assert_eq!(faster.backend.name(), "slow");
    let slower = BackendTrial { native_s: 0.01, gpu_s: 0.02, took_s: 0.09 }.settle(on_trial());
    assert_eq!(slower.backend.name(), Cpu::default().name());
    for (settled, verdict) in [(faster, "faster"), (slower, "not faster")] {
        assert!(!settled.on_trial && settled.why.starts_with(&format!("auto: slow, {verdict} than the processor")));
        assert!(settled.why.ends_with("(tried in 90.0 ms)"), "{}", settled.why);
    }
}
