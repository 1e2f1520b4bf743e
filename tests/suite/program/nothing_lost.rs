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

/// The native backend, which refuses texture windows, or the whole blank.
#[derive(Default)]
struct Failing {
    cpu: Cpu,
    blank: bool,
}

impl Backend for Failing {
    fn name(&self) -> String {
        self.cpu.name()
    }

    fn cut(&self, field: &Field, plan: &CutPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        if !self.blank && field.columns.len() > COLUMNS {
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
        if self.blank {
            return Err(Refusal::new("blank", "planted", "take it out").into());
        }
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
    let job = Job::new(scene).expect("a scene that cuts");
    let job = job.on(Choice { backend: Box::new(Failing::default()), why: "it fails".to_owned(), on_trial: false });
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

#[test]
fn a_blank_that_cannot_be_cut_costs_nothing_else() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("gear");
    let settings = COARSE.map(str::to_owned);
    let scene = gearcut::load(Path::new(ROUND), &settings).unwrap_or_else(|problems| panic!("{problems}"));
    let job = Job::new(scene).expect("a scene that cuts");
    let failing = Failing { blank: true, ..Failing::default() };
    let job = job.on(Choice { backend: Box::new(failing), why: "it fails".to_owned(), on_trial: false });
    let found = job.run().into_folder(&out).expect("the gear is cut and measured").findings;
    let faults: Vec<&str> =
        found.warnings.iter().filter(|of| of.severity == Severity::Fault).map(|of| of.text.as_str()).collect();
    assert_eq!(faults, ["whole blank: `blank`: planted; way out: take it out; everything else is there"]);
    assert!(found.complete && out.join("mesh/gear.ply").is_file() && out.join("report.html").is_file());
}

/// Strokes of the round scene's finishing operation as a program of a hand.
const STROKES: u32 = 120;

/// A program for the round scene: 24 teeth, a cutter of 20, a knot for every stroke. `b_sign` is the cutter's sense of
/// rotation, `change` what is wrong with the centre distance at a stroke.
fn program(b_sign: f64, change: impl Fn(u32) -> f64) -> String {
    let place = |stroke: u32| {
        let work_deg = 360.0 / f64::from(STROKES) * f64::from(stroke);
        format!("X{} C{} B{}", 66.0 + change(stroke), -work_deg, b_sign * work_deg * 24.0 / 20.0)
    };
    let lines: Vec<String> = (1..STROKES).map(|stroke| format!("G93 G1 {} F400", place(stroke))).collect();
    format!("G21 G90 G94\nG0 {}\nS400 M3\n{}\nM5\nM30\n", place(0), lines.join("\n"))
}

/// Cuts the round scene by a program; the gear must be told to be damaged, and everything must be there.
fn cut_by(program: &str) -> serde_json::Value {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, path) = (folder.path().join("gear"), folder.path().join("planted.ngc"));
    std::fs::write(&path, program).expect("a file");
    let settings = [
        format!("operation.rough.strokes_per_revolution={STROKES}"),
        format!("operation.finish.strokes_per_revolution={STROKES}"),
        format!("operation.finish.program='{}'", path.display()),
        "texture=[{tooth=1,profile_spacing_um=200,lead_spacing_um=5000}]".to_owned(),
    ];
    let settings = settings.iter().map(String::as_str).chain(COARSE).flat_map(|setting| ["--set", setting]);
    let arguments: Vec<&str> = ["cut", ROUND, "--out"].into_iter().chain(out.to_str()).chain(settings).collect();
    let told = gearcut(&arguments);
    assert_eq!(told.code, 3, "{}", told.err);
    for file in ["results.json", "report.html", "tables/flanks.csv", "tables/teeth.csv"] {
        assert!(out.join(file).is_file(), "{file} is missing");
    }
    let text = std::fs::read_to_string(out.join("results.json")).expect("a file") + &told.out + &told.err;
    assert!(!text.contains("inf u") && !text.contains("inf m"), "a number without end");
    read_json(&out.join("results.json"))
}

/// Programs that leave surfaces without a crossing with the pitch curve are cut to the end: the cutter turning the
/// other way, and a centre distance that is 36 mm short.
#[test]
fn a_gear_that_a_program_destroys_is_told_and_written() {
    for text in [program(-1.0, |_| 0.0), program(1.0, |_| -36.0)] {
        cut_by(&text);
    }
}

/// The number at a path of keys in a headline or section; null where it is not stated.
fn number<'a>(results: &'a serde_json::Value, path: &[&str]) -> &'a serde_json::Value {
    let found = path.iter().fold(results, |at, key| &at[key]);
    assert!(found["unit"].is_string(), "{path:?} is not there: {found}");
    assert!(!found["value"].is_null() || found["why"].is_string(), "{path:?}: {found}");
    &found["value"]
}

/// Nothing is measured on flanks that are not there: a centre distance in inches, whose strokes leave a tenth of the
/// gear, and one stroke that goes 60 mm too deep, through half of it.
#[test]
fn flanks_that_are_gone_have_no_numbers() {
    let inches = |_| 66.0 / 25.4 - 66.0;
    let jump = |stroke| if stroke == 60 { -60.0 } else { 0.0 };
    for text in [program(1.0, inches), program(1.0, jump)] {
        let results = cut_by(&text);
        for key in ["f_p", "F_p", "F_r"] {
            assert!(number(&results, &["headline", key]).is_null(), "{key} of a gear that is gone");
        }
        assert!(number(&results, &["sections", "inspection", "class"]).is_null());
        assert!(results["sections"]["round_gear"]["span_as_cut"].is_null(), "W_k of a gear that is gone");
        assert!(number(&results, &["sections", "teeth", "tooth_01", "tip_land"]).is_null());
    }
    // One stroke of the sound program touches nothing of the other side: it is measured.
    let results = cut_by(&program(1.0, |_| -0.2));
    assert!(number(&results, &["headline", "f_p"]).is_number());
}

/// A gear that is clamped 200 um off its axis is gouged, whether or not the cutter's base shapes its tips; and it is
/// told once.
#[test]
fn a_gouge_is_a_fault_whatever_the_cutter() {
    for cutter in ["8", "20"] {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("gear");
        let settings = [
            "gear.module_mm=1".to_owned(),
            "gear.teeth=17".to_owned(),
            "gear.bore_diameter_mm=5".to_owned(),
            format!("tool.shaper_cutter.teeth={cutter}"),
            "mounting.eccentricity_um=200".to_owned(),
            "operation.rough.strokes_per_revolution=170".to_owned(),
            "operation.finish.strokes_per_revolution=170".to_owned(),
            "fields.flank.profile_spacing_um=100".to_owned(),
            "fields.blank.spacing_mm=0.2".to_owned(),
            "texture=[]".to_owned(),
        ];
        let coarse = COARSE.iter().copied().filter(|setting| !setting.starts_with("fields.flank.profile_spacing"));
        let coarse = coarse.filter(|setting| !setting.starts_with("fields.blank"));
        let settings = settings.iter().map(String::as_str).chain(coarse).flat_map(|setting| ["--set", setting]);
        let arguments: Vec<&str> =
            ["cut", ROUND, "--only", "numbers", "--out"].into_iter().chain(out.to_str()).chain(settings).collect();
        let told = gearcut(&arguments);
        assert_eq!(told.code, 3, "cutter of {cutter} teeth: {}", told.err);
        let results = read_json(&out.join("results.json"));
        let warnings = results["warnings"].as_array().expect("a list");
        let texts: Vec<&str> = warnings.iter().filter_map(|of| of["text"].as_str()).collect();
        let of_damage = texts.iter().filter(|text| text.contains("cut below the target"));
        assert_eq!(of_damage.count(), 1, "{texts:?}");
    }
}

/// Strokes of a scene are complete: sixty coarse ones without an infeed leave uneven chips, and none is told missing.
#[test]
fn a_scene_misses_none_of_its_own_strokes() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("gear");
    let settings = [
        "operation.rough.strokes_per_revolution=60",
        "operation.finish.strokes_per_revolution=120",
        "fields.blank.spacing_mm=0.1",
        "texture=[]",
    ];
    let coarse = COARSE.iter().copied().filter(|setting| !setting.starts_with("fields.blank"));
    let settings = settings.into_iter().chain(coarse).flat_map(|setting| ["--set", setting]);
    let arguments: Vec<&str> =
        ["cut", ROUND, "--only", "numbers", "--out"].into_iter().chain(out.to_str()).chain(settings).collect();
    gearcut(&arguments).done();
    let results = std::fs::read_to_string(out.join("results.json")).expect("a file");
    assert!(!results.contains("seem to be missing"), "{results}");
}
