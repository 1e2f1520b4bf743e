//! Parts of the report's page that all processes share.

mod averaged;
pub mod blank;
pub mod deviations;
mod digits;
pub mod facts;
pub mod files;
pub mod machine_errors;
pub mod maps;
mod measured;
pub mod paper;
pub mod quantities;
pub mod texture;
pub mod work;

use crate::findings::quantities::OPERATIONS;
use crate::findings::quantities::cutting::{AXES, LIMIT, MARGIN, PEAK};
use crate::findings::{self, Findings, Notice, Place, Quantity, QuantityRow, Severity, unit};
use crate::job::GearJob;
use crate::number_text::significant;
use crate::output::folder::OutputFolder;
use crate::output::report::{Block, KeyNumber, Page, PageSection, PageTable, Tone};
use crate::steps::Work;
use crate::steps::gear_maps::GearMaps;
use crate::steps::view_mesh::ViewMesh;
use gearcut_core::error::{Error, Result};

/// What the run says of itself on the page. Times are left out: the same scene gives the same page.
#[derive(Debug, Clone, Copy)]
pub struct RunWords<'a> {
    /// The scene with every value written out.
    pub resolved_scene: &'a str,
    /// Backend with its adapter, as it stands in files.
    pub backend: &'a str,
    /// Why it was taken.
    pub backend_why: &'a str,
}

/// The gear on the page.
pub struct PageGear {
    /// What it is, in a line: [`facts::gear_words`] of a cylindrical one.
    pub words: String,
    /// Its target, on which maps are laid.
    pub mesh: ViewMesh,
}

/// A page with the parts that are the same for all processes; `operation` puts an operation's findings into a line.
pub fn page(
    job: &dyn GearJob,
    gear: PageGear,
    found: &Findings,
    maps: &GearMaps,
    operation: impl Fn(&findings::Section) -> String,
    sections: Vec<PageSection>,
) -> Page {
    Page {
        what: "cutting report",
        done: "all flanks cut",
        subtitle: gear.words,
        operations: found.parts(&OPERATIONS).iter().map(operation).collect(),
        key_numbers: known_first(found.headline.iter().map(quantities::key_number).collect()),
        viewer: Some(maps::viewer(job, gear.mesh, maps)),
        sections: sections.into_iter().map(|section| warned_open(section, found)).collect(),
        ..page_of(found)
    }
}

/// What every page of findings has: their scene, program, key numbers and notices; the rest is the caller's.
pub fn page_of(found: &Findings) -> Page {
    Page {
        what: "",
        title: found.scene.clone(),
        subtitle: String::new(),
        operations: Vec::new(),
        complete: found.complete,
        done: "",
        program: format!("gearcut {}", found.program_version),
        key_numbers: found.headline.iter().map(quantities::key_number).collect(),
        warnings: found.warnings.iter().map(Notice::with_signs).collect(),
        viewer: None,
        sections: Vec::new(),
    }
}

/// A section that a warning or a fault is about is no fine one.
fn warned_open(mut section: PageSection, found: &Findings) -> PageSection {
    let own = |path: &String| path.split('.').next() == Some(section.id);
    let warned = found.warnings.iter().filter(|of| of.severity > Severity::Note);
    let warned = warned.filter(|of| of.section.as_ref().is_some_and(own)).count();
    if let Some(verdict) = section.verdict.as_mut().filter(|_| warned > 0) {
        verdict.tone = Tone::Wrong;
        let plural = if warned == 1 { "" } else { "s" };
        verdict.words = format!("{}; {warned} warning{plural} about it", verdict.words);
    }
    section
}

/// Numbers of the headline in a line, those that there are.
pub fn headline_words(found: &Findings, rows: &[&QuantityRow]) -> String {
    let known = rows.iter().filter_map(|row| Some((row, found.first(row).filter(|of| of.why().is_none())?)));
    let words = known.map(|(row, quantity)| format!("{} {}", row.title(), quantities::value_with_unit(quantity)));
    words.collect::<Vec<_>>().join(", ")
}

/// A picture of the folder; none where it is left out.
fn read_picture(folder: &OutputFolder, name: &str) -> Result<Option<Vec<u8>>> {
    // Asked for by itself, a path makes its folder.
    let path = folder.path("")?.join(name);
    match std::fs::read(&path) {
        Ok(png) => Ok(Some(png)),
        Err(reason) if reason.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(reason) => Err(Error::reading(&path)(reason)),
    }
}

/// What does not exist here goes to the end.
fn known_first(numbers: Vec<KeyNumber>) -> Vec<KeyNumber> {
    let (mut known, unknown): (Vec<_>, Vec<_>) = numbers.into_iter().partition(|number| number.value != "–");
    known.extend(unknown);
    known
}

/// Peaks of an operation's axes against their limits.
pub fn peak_table(operation: &findings::Section) -> PageTable {
    let number = |value: f64| significant(if value.abs() < 1e-9 { 0.0 } else { value }, 4);
    let dash = || "–".to_owned();
    let peaks = operation.group(&AXES).map_or(&[][..], |axes| &axes.sections);
    let rows = peaks.iter().map(|peak| {
        let largest = peak.of(&PEAK);
        vec![
            peak.title.clone(),
            largest.and_then(Quantity::value).map_or_else(dash, number),
            unit::signs(largest.and_then(Quantity::unit).unwrap_or("")),
            largest.and_then(Quantity::place).map_or_else(dash, Place::words_with_signs),
            peak.value(&LIMIT).map_or_else(dash, number),
            peak.value(&MARGIN).map_or_else(dash, |share| format!("{:.0} %", 100.0 * share)),
        ]
    });
    PageTable {
        caption: "Peaks of the axes".to_owned(),
        columns: ["Axis", "Largest", "Unit", "At", "Limit", "Reserve"].map(str::to_owned).into(),
        rows: rows.collect(),
    }
}

/// What is needed to repeat the run.
pub fn record(flanks: usize, work: &Work, run: &RunWords) -> PageSection {
    let rows = vec![
        ["Backend", &format!("{} ({})", run.backend, run.backend_why)].map(str::to_owned),
        ["Flanks cut".to_owned(), flanks.to_string()],
        ["Dexels".to_owned(), work.dexels_in_words()],
    ];
    let lead =
        "What is needed to repeat the run. Times and the SHA-256 of every file are in run.json beside this page.";
    record_of(rows, &[(SCENE, run.resolved_scene)], lead)
}

/// What a scene is called that is folded away.
pub const SCENE: &str = "The scene, every value written out";

/// The end of a page of a command that cuts no whole gear: its files, and what is needed to repeat it: what made it, by
/// name, and its scenes, every value written out.
///
/// # Errors
/// The folder cannot be read.
pub fn ending(folder: &OutputFolder, made: [&str; 2], scenes: &[(&str, &str)]) -> Result<[PageSection; 2]> {
    let lead = "What is needed to repeat the run; the arguments of the command are in run.json beside this page.";
    Ok([files::section(folder)?, record_of(vec![made.map(str::to_owned)], scenes, lead)])
}

fn record_of(rows: Vec<[String; 2]>, scenes: &[(&str, &str)], lead: &str) -> PageSection {
    let version = format!("gearcut {}", env!("CARGO_PKG_VERSION"));
    let program = ["Program".to_owned(), version.clone()];
    let table = PageTable {
        caption: "Run".to_owned(),
        columns: Vec::new(),
        rows: std::iter::once(program).chain(rows).map(Vec::from).collect(),
    };
    let folded =
        |&(words, scene): &(&str, &str)| Block::Folded(words.to_owned(), vec![Block::Verbatim(scene.to_owned())]);
    let blocks = std::iter::once(Block::Table(table)).chain(scenes.iter().map(folded));
    PageSection::new("record", "Run record", lead, blocks.collect()).judged(Tone::Aside, version)
}
