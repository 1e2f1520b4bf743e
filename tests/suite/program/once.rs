//! Nothing is cut twice in a run: a backend that writes down every ray and every pass that it is asked for.

use gearcut::backend::Choice;
use gearcut::cut::cpu::Cpu;
use gearcut::cut::sweep_chips::SweepsCut;
use gearcut::cut::{Backend, BlankCut, BlankOperation, CutStats};
use gearcut::dexel::{BlankField, Field, Layer, SpatialField};
use gearcut::error::Error;
use gearcut::passes::sections::swept_sections::SweptSections;
use gearcut::passes::{CutPlan, SweepPlan};
use gearcut::{Job, Side};
use glam::DVec3;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::sync::{Arc, Mutex};

/// A ray, bit by bit, and the first pass of its plan, which tells operations apart.
type Asked = ([u64; 6], u32);

/// What a backend was asked for.
#[derive(Default)]
struct Log {
    /// How often every ray was cut.
    rays: BTreeMap<Asked, u32>,
    /// First pass of every cut of the whole blank.
    blanks: Vec<u32>,
}

impl Log {
    fn ray(&mut self, origin_mm: DVec3, normal: DVec3, first_pass: u32) {
        let bits = |v: DVec3| v.to_array().map(f64::to_bits);
        let ([a, b, c], [d, e, f]) = (bits(origin_mm), bits(normal));
        *self.rays.entry(([a, b, c, d, e, f], first_pass)).or_default() += 1;
    }

    fn cut_twice(&self) -> usize {
        self.rays.values().filter(|&&times| times > 1).count()
    }
}

/// The native backend with a log.
#[derive(Default)]
struct Logging {
    cpu: Cpu,
    log: Arc<Mutex<Log>>,
}

impl Backend for Logging {
    fn name(&self) -> String {
        self.cpu.name()
    }

    fn cut(&self, field: &Field, plan: &CutPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        let mut log = self.log.lock().expect("no thread has failed");
        let first_pass = plan.records.iter().map(|record| record.pass).min().unwrap_or(u32::MAX);
        for column in &field.columns {
            for &z_mm in &field.rows_z_mm {
                log.ray(column.origin_mm.extend(z_mm), column.normal.extend(0.0), first_pass);
            }
        }
        drop(log);
        self.cpu.cut(field, plan, layer)
    }

    fn cut_blank(
        &self,
        field: &mut BlankField,
        operation: &BlankOperation,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<BlankCut>, Error> {
        self.log.lock().expect("no thread has failed").blanks.push(operation.strokes.first_pass);
        self.cpu.cut_blank(field, operation, advance)
    }

    fn cut_blank_sweeps(
        &self,
        field: &mut BlankField,
        sections: &SweptSections,
        passes: Range<u32>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<SweepsCut>, Error> {
        self.log.lock().expect("no thread has failed").blanks.push(passes.start);
        self.cpu.cut_blank_sweeps(field, sections, passes, advance)
    }

    fn cut_spatial(&self, field: &SpatialField, plan: &SweepPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        let mut log = self.log.lock().expect("no thread has failed");
        let first_pass = plan.records.iter().map(|record| record.pass).min().unwrap_or(u32::MAX);
        for column in 0..field.columns() {
            for row in 0..field.rows() {
                let ray = field.ray(column, row);
                log.ray(ray.origin_mm, ray.normal, first_pass);
            }
        }
        drop(log);
        self.cpu.cut_spatial(field, plan, layer)
    }
}

/// A whole result of a scene, on coarse dexels; what `more` does with the job comes on top.
fn logged(scene: &str, settings: &[&str], more: impl Fn(&Job)) -> Log {
    let coarse = [
        "gear.face_width_mm=6",
        "fields.flank.profile_spacing_um=100",
        "fields.flank.lead_spacing_um=1000",
        "fields.blank.spacing_mm=0.5",
        "picture=[{name='flank',view='flank',width_px=96,height_px=72}]",
    ];
    let settings: Vec<String> = coarse.iter().chain(settings).map(|&setting| setting.to_owned()).collect();
    let scene = gearcut::load(Path::new(scene), &settings).unwrap_or_else(|problems| panic!("{problems}"));
    let backend = Logging::default();
    let log = Arc::clone(&backend.log);
    let job = Job::new(&scene).expect("a scene that cuts");
    let job = job.on(Choice { backend: Box::new(backend), why: "it writes down what it is asked for".to_owned() });
    let folder = tempfile::tempdir().expect("a folder");
    job.run().into_folder(&folder.path().join("gear")).expect("a whole result");
    more(&job);
    drop(job);
    let log = Arc::into_inner(log).expect("the backend is gone");
    log.into_inner().expect("no thread has failed")
}

#[test]
fn a_run_cuts_no_ray_twice() {
    for (scene, settings) in [
        ("scenes/shaping/circular_m3_z24.toml", &[][..]),
        ("scenes/hobbing/circular_spur.toml", &["gear.teeth=16", "tool.hob.reference_diameter_mm=50"]),
    ] {
        let log = logged(scene, settings, |_| {});
        println!("{scene}: {} rays, {} cut twice, blanks {:?}", log.rays.len(), log.cut_twice(), log.blanks);
        assert!(log.rays.len() > 1000 && !log.blanks.is_empty());
        assert_eq!(log.cut_twice(), 0, "{scene}");
        let mut blanks = log.blanks.clone();
        blanks.dedup();
        assert_eq!(blanks, log.blanks, "{scene}: the blank is cut once by every operation");
    }
}

/// The log is alive: a flank that is cut again shows, ray by ray.
#[test]
fn a_flank_that_is_cut_again_is_noticed() {
    let log = logged("scenes/shaping/circular_m3_z24.toml", &[], |job| {
        job.cut_flank(5, Side::Left).expect("a flank");
    });
    assert!(log.cut_twice() > 100, "{} rays were cut twice", log.cut_twice());
}
