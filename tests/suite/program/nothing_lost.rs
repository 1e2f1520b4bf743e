//! A run whose gear is cut is never thrown away: parts that fail afterwards are told, the rest is written.

use crate::fixtures::command::{gearcut, read_json};
use gearcut::Job;
use gearcut::backend::Choice;
use gearcut::cut::cpu::Cpu;
use gearcut::cut::sweep_chips::SweepsCut;
use gearcut::cut::{Backend, BlankCut, BlankOperation, CutStats};
use gearcut::dexel::{BlankField, Field, Layer, SpatialField};
use gearcut::error::{Error, Refusal};
use gearcut::findings::Severity;
use gearcut::passes::sections::swept_sections::SweptSections;
use gearcut::passes::{CutPlan, SweepPlan};
use std::ops::Range;
use std::path::Path;

const ROUND: &str = "scenes/shaping/circular_m3_z24.toml";
const COARSE: [&str; 5] = [
    "fields.flank.profile_spacing_um=200",
    "fields.flank.lead_spacing_um=5000",
    "fields.chips.spacing_mm=0.5",
    "fields.blank.spacing_mm=1",
    "picture=[]",
];

/// Columns of a window 5 um apart are more than these, those of flanks, roots and tips fewer.
const COLUMNS: usize = 500;

/// The native backend, which refuses texture windows.
#[derive(Default)]
struct Failing {
    cpu: Cpu,
}

impl Backend for Failing {
    fn name(&self) -> String {
        self.cpu.name()
    }

    fn cut(&self, field: &Field, plan: &CutPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        if field.columns.len() > COLUMNS {
            return Err(Refusal::new("texture", "planted", "take it out").into());
        }
        self.cpu.cut(field, plan, layer)
    }

    fn cut_blank(
        &self,
        field: &mut BlankField,
        operation: &BlankOperation,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<BlankCut>, Error> {
        self.cpu.cut_blank(field, operation, advance)
    }

    fn cut_blank_sweeps(
        &self,
        field: &mut BlankField,
        sections: &SweptSections,
        passes: Range<u32>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<SweepsCut>, Error> {
        self.cpu.cut_blank_sweeps(field, sections, passes, advance)
    }

    fn cut_spatial(&self, field: &SpatialField, plan: &SweepPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        self.cpu.cut_spatial(field, plan, layer)
    }
}

#[test]
fn a_texture_that_cannot_be_cut_costs_nothing_else() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("gear");
    let settings = COARSE.iter().chain(&["texture=[{tooth=3,side='left',profile_spacing_um=5}]"]);
    let settings: Vec<String> = settings.map(|&setting| setting.to_owned()).collect();
    let scene = gearcut::load(Path::new(ROUND), &settings).unwrap_or_else(|problems| panic!("{problems}"));
    let job = Job::new(&scene).expect("a scene that cuts");
    let job = job.on(Choice { backend: Box::new(Failing::default()), why: "it fails".to_owned() });
    let found = job.run().into_folder(&out).expect("the gear is cut and measured").findings;
    let faults: Vec<&str> =
        found.warnings.iter().filter(|of| of.severity == Severity::Fault).map(|of| of.text.as_str()).collect();
    assert_eq!(faults, ["texture: `texture`: planted; way out: take it out; everything else is there"]);
    for file in ["results.json", "report.html", "run.json", "axes/finish.ngc", "mesh/gear.ply", "tables/flanks.csv"] {
        assert!(out.join(file).is_file(), "{file} is missing");
    }
    let listed = &read_json(&out.join("results.json"))["warnings"][0];
    assert_eq!(listed["severity"], "fault");
}

/// Windows of few and coarse dexels cannot be evaluated; the run ends well and says so.
#[test]
fn coarse_legal_scenes_end_well() {
    for (teeth, strokes, cutter) in [("12", "60", "20"), ("17", "100", "20"), ("30", "60", "12")] {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("gear");
        let settings = [
            format!("gear.teeth={teeth}"),
            format!("tool.shaper_cutter.teeth={cutter}"),
            format!("operation.rough.strokes_per_revolution={strokes}"),
            format!("operation.finish.strokes_per_revolution={strokes}"),
        ];
        let coarse_window = "texture=[{tooth=1,profile_spacing_um=200,lead_spacing_um=5000}]";
        let settings = settings.iter().map(String::as_str).chain(COARSE.iter().copied()).chain([coarse_window]);
        let settings = settings.flat_map(|setting| ["--set", setting]);
        let arguments: Vec<&str> = ["cut", ROUND, "--set", "gear.bore_diameter_mm=10", "--out"]
            .into_iter()
            .chain(out.to_str())
            .chain(settings)
            .collect();
        gearcut(&arguments).done();
        let results = read_json(&out.join("results.json"));
        let told = results["warnings"].as_array().expect("a list");
        let window = told.iter().filter(|of| of["text"].as_str().is_some_and(|text| text.starts_with("texture of")));
        assert!(window.count() > 0 && out.join("report.html").is_file(), "{told:?}");
    }
}
