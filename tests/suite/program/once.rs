//! Nothing is cut twice in a run: a backend that writes down every ray and every pass that it is asked for.

use gearcut::backend::Choice;
use gearcut::cut::cpu::Cpu;
use gearcut::cut::sweep_chips::SweepsCut;
use gearcut::cut::{Backend, BlankCut, BlankOperation, CutStats};
use gearcut::dexel::{BlankField, Field, Layer, Ray, SpatialField};
use gearcut::error::Error;
use gearcut::passes::sections::swept_sections::SweptSections;
use gearcut::passes::{CutPlan, SweepPlan};
use gearcut::{Job, Side};
use glam::DVec3;
use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;
use std::sync::{Arc, Mutex};

/// A ray, bit by bit, and the first pass of its plan, which tells operations apart.
type Asked = ([u64; 6], u32);

/// What a backend was asked for.
#[derive(Default)]
struct Log {
    rays: BTreeSet<Asked>,
    /// Fields all of whose rays had been cut before. (Single rays of different grids may coincide.)
    again: Vec<String>,
    /// First pass of every cut of the whole blank.
    blanks: Vec<u32>,
}

impl Log {
    fn field(&mut self, name: &str, rays: impl Iterator<Item = Ray>, first_pass: u32) {
        let bits = |v: DVec3| v.to_array().map(f64::to_bits);
        let (mut all, mut fresh) = (0, 0);
        let mut first = None;
        for ray in rays {
            let ([a, b, c], [d, e, f]) = (bits(ray.origin_mm), bits(ray.normal));
            all += 1;
            fresh += usize::from(self.rays.insert(([a, b, c, d, e, f], first_pass)));
            first = first.or(Some(ray.origin_mm));
        }
        if fresh == 0 {
            self.again.push(format!("{name}: {all} rays from {first:?} on, passes from {first_pass} on"));
        }
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
        let first_pass = plan.records.iter().map(|record| record.pass).min().unwrap_or(u32::MAX);
        let rays = field.columns.iter().flat_map(|column| {
            field
                .rows_z_mm
                .iter()
                .map(|&z_mm| Ray { origin_mm: column.origin_mm.extend(z_mm), normal: column.normal.extend(0.0) })
        });
        self.log.lock().expect("no thread has failed").field("planar", rays, first_pass);
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
        let first_pass = plan.records.iter().map(|record| record.pass).min().unwrap_or(u32::MAX);
        let rays = (0..field.columns()).flat_map(|column| (0..field.rows()).map(move |row| field.ray(column, row)));
        self.log.lock().expect("no thread has failed").field("in space", rays, first_pass);
        self.cpu.cut_spatial(field, plan, layer)
    }
}

/// A scene on coarse dexels, cut by a backend with a log as `cut` says.
fn logged(scene: &str, settings: &[&str], cut: impl Fn(&Job)) -> Log {
    let coarse = [
        "gear.face_width_mm=6",
        "fields.flank.profile_spacing_um=100",
        "fields.flank.lead_spacing_um=1000",
        "fields.blank.spacing_mm=1",
        "picture=[{name='gear',width_px=96,height_px=72},{name='flank',view='flank',width_px=96,height_px=72}]",
    ];
    let settings: Vec<String> = coarse.iter().chain(settings).map(|&setting| setting.to_owned()).collect();
    let scene = gearcut::load(Path::new(scene), &settings).unwrap_or_else(|problems| panic!("{problems}"));
    let backend = Logging::default();
    let log = Arc::clone(&backend.log);
    let job = Job::new(scene).expect("a scene that cuts");
    let job = job.on(Choice {
        backend: Box::new(backend),
        why: "it writes down what it is asked for".to_owned(),
        on_trial: false,
    });
    cut(&job);
    drop(job);
    let log = Arc::into_inner(log).expect("the backend is gone");
    log.into_inner().expect("no thread has failed")
}

#[test]
fn a_run_cuts_nothing_twice() {
    for (scene, settings) in [
        ("scenes/shaping/circular_m3_z24.toml", &[][..]),
        ("scenes/hobbing/circular_spur.toml", &["gear.teeth=16", "tool.hob.reference_diameter_mm=50"]),
    ] {
        let log = logged(scene, settings, |job| {
            let folder = tempfile::tempdir().expect("a folder");
            job.run().into_folder(&folder.path().join("gear")).expect("a whole result");
        });
        println!("{scene}: {} rays, blanks {:?}", log.rays.len(), log.blanks);
        assert!(log.rays.len() > 1000 && !log.blanks.is_empty());
        assert_eq!(log.again, [""; 0], "{scene}");
        let mut blanks = log.blanks.clone();
        blanks.dedup();
        assert_eq!(blanks, log.blanks, "{scene}: the blank is cut once by every operation");
    }
}

/// The log is alive: a flank that is cut again shows, for every operation.
#[test]
fn a_flank_that_is_cut_again_is_noticed() {
    let log = logged("scenes/shaping/circular_m3_z24.toml", &[], |job| {
        for _ in 0..2 {
            job.cut_flank(5, Side::Left).expect("a flank");
        }
    });
    assert!(!log.again.is_empty(), "{} rays", log.rays.len());
}
