//! A GPU that nobody asked for by name is taken only if it is faster than the processor.

use crate::fixtures::command::read_json;
use crate::fixtures::parity::{software_gpu, strict};
use gearcut::backend::Choice;
use gearcut::bench::kernel_rates;
use gearcut::cut::cpu::Cpu;
use gearcut::cut::sweep_chips::SweepsCut;
use gearcut::cut::{Backend, BlankCut, BlankOperation, CutStats};
use gearcut::dexel::{BlankField, Field, Layer, SpatialField};
use gearcut::job::GearJob;
use gearcut::passes::sections::swept_sections::SweptSections;
use gearcut::passes::{CutPlan, SweepPlan};
use gearcut::steps::backend_trial::{BackendTrial, StageTrial};
use gearcut::{Job, Parts, Result};
use std::ops::Range;
use std::path::Path;
use std::sync::Mutex;
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
    let why = record["backend_why"].as_str().expect("a text");
    assert!(why.starts_with("auto: slow, not faster than the processor on tiles of this scene: "), "{why}");
    // The blank is tried by itself, on a backend that only waits for flanks: either may be faster.
    let blank = why.split_once("; ").expect("two verdicts").1;
    assert!(blank.contains("faster than the processor on passes over the whole blank of this scene: "), "{why}");
    let cpu = Cpu::default().name();
    let both = format!("{cpu}; the whole blank: slow");
    assert_eq!(record["backend"], if blank.starts_with("not faster") { cpu } else { both }, "{why}");
}

/// Seconds of a trial: the processor's and the GPU's.
fn times(native_s: f64, gpu_s: f64) -> StageTrial {
    StageTrial { native_s, gpu_s }
}

#[test]
fn each_stage_gets_the_faster_backend() {
    let (slow, native) = (Slow::default(), Cpu::default());
    let names = |flanks: StageTrial, blank: Option<StageTrial>| {
        let by = BackendTrial { flanks, blank, took_s: 0.1 }.backends(&slow, &native);
        (by.flanks.name(), by.blank.name(), by.name())
    };
    let (gpu, cpu) = (slow.name(), native.name());
    let both = |one: &str, other: &str| (one.to_owned(), other.to_owned(), format!("{one}; the whole blank: {other}"));
    assert_eq!(names(times(2.0, 1.0), Some(times(1.0, 2.0))), both(&gpu, &cpu));
    assert_eq!(names(times(1.0, 2.0), Some(times(2.0, 1.0))), both(&cpu, &gpu));
    assert_eq!(names(times(2.0, 1.0), None), (gpu.clone(), gpu.clone(), gpu));
    assert_eq!(names(times(1.0, 2.0), Some(times(1.0, 2.0))), (cpu.clone(), cpu.clone(), cpu));
}

/// Passes over the blank that a trial makes, of shaped gears with straight and helical teeth and of a hobbed one: they
/// meet material, and a GPU takes as much of it as the processor.
#[test]
fn a_trial_takes_material_from_the_blank() {
    let gpu = software_gpu(strict());
    for (scene, settings) in [
        ("scenes/shaping/circular_m3_z24.toml", &["fields.blank.spacing_mm=2"][..]),
        ("scenes/shaping/helical.toml", &["fields.blank.spacing_mm=2"][..]),
        (
            "scenes/hobbing/circular_helical.toml",
            &["fields.blank.spacing_mm=2", "fields.blank.slice_spacing_mm=10"][..],
        ),
    ] {
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        let loaded = gearcut::load(Path::new(scene), &settings).unwrap_or_else(|problems| panic!("{problems}"));
        let prepared = gearcut::process::prepare(&loaded.scene).expect("a scene that cuts");
        let removed_mm3 = |backend: &dyn Backend| {
            let watched = Watched { backend, removed_mm3: Mutex::default() };
            let with_gear = |gear: &dyn GearJob| {
                let trial = gear.trial_blank()?.expect("a blank that is cut by itself");
                (trial.cut)(&watched, trial.uncut.clone())
            };
            prepared.with_gear(&mut |gear| with_gear(gear)).expect("cuts");
            watched.removed_mm3.into_inner().expect("no panic")
        };
        let [native_mm3, gpu_mm3] = [removed_mm3(&Cpu::default()), removed_mm3(&gpu)];
        println!("{scene}: {native_mm3:?} {gpu_mm3:?}");
        for (native_mm3, gpu_mm3) in native_mm3.iter().zip(gpu_mm3) {
            assert!(*native_mm3 > 10.0 && (gpu_mm3 / native_mm3 - 1.0).abs() < 1e-6, "{scene}");
        }
    }
}

/// A backend, and what it takes from the blank.
struct Watched<'a> {
    backend: &'a dyn Backend,
    removed_mm3: Mutex<[f64; 2]>,
}

impl Watched<'_> {
    fn note(&self, before_mm3: [f64; 2], field: &BlankField) {
        let after_mm3 = field.volumes_mm3();
        *self.removed_mm3.lock().expect("no panic") = [0, 1].map(|family| before_mm3[family] - after_mm3[family]);
    }
}

impl Backend for Watched<'_> {
    fn name(&self) -> String {
        "watched".to_owned()
    }

    fn cut(&self, field: &Field, plan: &CutPlan, layer: &mut Layer) -> Result<CutStats> {
        self.backend.cut(field, plan, layer)
    }

    fn cut_blank(
        &self,
        field: &mut BlankField,
        operation: &BlankOperation,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<BlankCut>> {
        let before_mm3 = field.volumes_mm3();
        let cut = self.backend.cut_blank(field, operation, advance)?;
        self.note(before_mm3, field);
        Ok(cut)
    }

    fn cut_blank_sweeps(
        &self,
        field: &mut BlankField,
        sections: &SweptSections,
        passes: Range<u32>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<SweepsCut>> {
        let before_mm3 = field.volumes_mm3();
        let cut = self.backend.cut_blank_sweeps(field, sections, passes, advance)?;
        self.note(before_mm3, field);
        Ok(cut)
    }

    fn cut_spatial(&self, field: &SpatialField, plan: &SweepPlan, layer: &mut Layer) -> Result<CutStats> {
        self.backend.cut_spatial(field, plan, layer)
    }
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
    let settled = |flanks| BackendTrial { flanks, blank: None, took_s: 0.09 }.settle(on_trial());
    let faster = settled(times(0.02, 0.01));
    assert_eq!(faster.backend.name(), "slow");
    let slower = settled(times(0.01, 0.02));
    assert_eq!(slower.backend.name(), Cpu::default().name());
    for (settled, verdict) in [(faster, "faster"), (slower, "not faster")] {
        assert!(!settled.on_trial && settled.why.starts_with(&format!("auto: slow, {verdict} than the processor")));
        assert!(settled.why.ends_with("(tried in 90.0 ms)"), "{}", settled.why);
    }
}
