//! `report.html`: a run as one page that opens offline in any browser.
//!
//! In: a [`Page`], plain data: headings, numbers, tables, charts, maps, meshes. Out: one file that holds everything:
//! style sheet, scripts, the 3D library (three.js, `assets/three/`), maps and triangles ([`viewer`]), SVG charts
//! ([`crate::output::bar_chart`] and its like, [`traces`], [`texture`]).
//!
//! The rules:
//! - Text from a scene is text. Markup is made by maud, which escapes whatever is put into it; JSON escapes every `<`;
//!   and the page's own security policy names its scripts by their SHA-256, so that nothing else would run, and forbids
//!   requests of any kind.
//! - Same results, same bytes: no date, no duration. Those are in `run.json`.
//! - Numbers, tables and charts need no script: they are there on paper, in a mail preview and without WebGL.
//!
//! Road not taken: charts drawn by a script library from JSON. They would move under the mouse, but not exist on paper,
//! and tie the page to another library.

mod blocks;
mod gear_frame;
pub mod paper;
mod table;
pub mod texture;
pub mod traces;
pub mod viewer;

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use sha2::{Digest, Sha256};

use crate::findings::Place;
use crate::findings::notice::{Notice, Severity, count_words};
use crate::output::atomic::write_bytes_atomically;
use gear_frame::gear_frame;
use gearcut_core::Result;
use viewer::Viewer;

pub use blocks::{Block, FileLinks, PageSection, Tone};
pub use table::PageTable;

/// Name of the file in an output folder.
pub const REPORT_FILE: &str = "report.html";
/// Name of the printed report beside it.
pub const PAPER_FILE: &str = "report.pdf";

const STYLE: &str =
    concat!(include_str!("../../assets/report/page.css"), include_str!("../../assets/report/chart.css"));
const THREE: &str = include_str!("../../assets/three/three.min.js");
/// The page's own scripts, in order: data and colours, maps and picker, the gear, marks over it, the work while it is
/// cut, its strokes.
const SCRIPTS: [&str; 6] = [
    include_str!("../../assets/report/data.js"),
    include_str!("../../assets/report/maps.js"),
    include_str!("../../assets/report/gear.js"),
    include_str!("../../assets/report/marks.js"),
    include_str!("../../assets/report/work.js"),
    include_str!("../../assets/report/strokes.js"),
];

/// Everything on the page.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    /// What kind of report it is, such as "cutting report".
    pub what: &'static str,
    /// Name of the scene.
    pub title: String,
    /// What was cut, in a line.
    pub subtitle: String,
    /// What was done to it: one line per operation.
    pub operations: Vec<String>,
    /// Whether all flanks were cut.
    pub complete: bool,
    /// What was done when it is complete, such as "all flanks cut".
    pub done: &'static str,
    /// Program and version.
    pub program: String,
    /// What to look at first; the first two are shown largest.
    pub key_numbers: Vec<KeyNumber>,
    /// What a reader must know before trusting the numbers, units in the signs of a page.
    pub warnings: Vec<Notice>,
    /// The gear to turn, with its maps.
    pub viewer: Option<Viewer>,
    /// The rest, in order.
    pub sections: Vec<PageSection>,
}

/// A number to look at first.
#[derive(Debug, Clone, PartialEq)]
pub struct KeyNumber {
    /// What it is called.
    pub name: String,
    /// The number, or a word where there is none.
    pub value: String,
    /// Its unit.
    pub unit: String,
    /// What it is, in a sentence.
    pub definition: String,
    /// What stands under it: the reason of a missing value, a second value.
    pub note: String,
    /// Where on the gear it was found.
    pub place: Option<Place>,
}

impl Page {
    /// Writes the page.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        write_bytes_atomically(path, self.html().as_bytes())
    }

    /// The text of the page.
    pub fn html(&self) -> String {
        let scripts: Vec<String> = if self.viewer.is_some() {
            std::iter::once(THREE).chain(SCRIPTS).map(own_script).collect()
        } else {
            Vec::new()
        };
        let policy = policy(&scripts);
        let packed = self.viewer.as_ref().map(Viewer::packed);
        let sections = self.links();
        html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta http-equiv="Content-Security-Policy" content=(policy);
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    meta name="generator" content=(self.program);
                    title { (self.title) " – gearcut report" }
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    a class="skip" href="#key-numbers" { "Skip to the numbers" }
                    (self.head())
                    div class="layout" {
                        nav aria-label="Sections" {
                            ul { @for (id, title) in &sections { li { a href=(format!("#{id}")) { (title) } } } }
                        }
                        main {
                            (self.numbers())
                            @if let Some(viewer) = &self.viewer { (gear_frame(viewer)) }
                            @for section in &self.sections { (section.markup()) }
                        }
                    }
                    footer { "Written by " (self.program) ". Every number with its unit and definition: results.json \
                        beside this file." }
                    @if let Some(packed) = packed {
                        script type="application/json" id="viewer-description" {
                            (PreEscaped(inert_json(&packed.description)))
                        }
                        script type="text/plain" id="viewer-block" { (PreEscaped(packed.block)) }
                        @for script in scripts { script { (PreEscaped(script)) } }
                    }
                }
            }
        }
        .into_string()
    }

    fn links(&self) -> Vec<(String, &str)> {
        let gear = self.viewer.as_ref().map(|_| ("gear".to_owned(), "Gear and maps"));
        let own = self.sections.iter().map(|section| (section.anchor(), section.title.as_str()));
        [("key-numbers".to_owned(), "Key numbers")].into_iter().chain(gear).chain(own).collect()
    }

    fn head(&self) -> Markup {
        let warned = count_words(&self.warnings);
        let class = match self.warnings.iter().map(|warning| warning.severity).max() {
            Some(Severity::Fault) => "faulty",
            Some(Severity::Warning) => "bad",
            Some(Severity::Note) | None => "good",
        };
        html! {
            header class="top" {
                p class="brand" { strong { "gearcut" } " " (self.what) }
                h1 { (self.title) }
                p class="subtitle" { (self.subtitle) }
                ol class="operations" { @for operation in &self.operations { li { (operation) } } }
                ul class="chips" {
                    @if self.complete {
                        li class="good" { (self.done) }
                    } @else {
                        li class="bad" { "stopped before all flanks were cut" }
                    }
                    @if self.warnings.is_empty() {
                        li class="good" { (warned) }
                    } @else {
                        li class=(class) { a href="#warnings" { (warned) } }
                    }
                }
            }
        }
    }

    fn numbers(&self) -> Markup {
        let notes = self.warnings.iter().filter(|warning| warning.severity == Severity::Note);
        let notes: Vec<Notice> = notes.cloned().collect();
        html! {
            section id="key-numbers" aria-labelledby="key-numbers-title" {
                h2 id="key-numbers-title" { "Key numbers" }
                dl class="numbers" {
                    @for (index, number) in self.key_numbers.iter().enumerate() { (number.markup(index < 2)) }
                }
                div id="warnings" {
                    @for warning in self.warnings.iter().filter(|warning| warning.severity > Severity::Note) {
                        (sentence(warning))
                    }
                    @if !notes.is_empty() {
                        details {
                            summary { (count_words(&notes)) " on how to read the numbers" }
                            @for note in &notes { (sentence(note)) }
                        }
                    }
                }
            }
        }
    }
}

impl KeyNumber {
    fn markup(&self, large: bool) -> Markup {
        html! {
            div class=(if large { "number-card large" } else { "number-card" }) title=(self.definition) {
                dt { (self.name) }
                dd {
                    span class="value" { (self.value) } " " span class="unit" { (self.unit) }
                    @if let Some(place) = self.place.as_ref().and_then(Place::flank) {
                        button type="button" class="place" data-tooth=(place.tooth) data-side=(place.flank)
                            data-u=(place.u_mm) data-v=(place.v_mm) {
                            "tooth " (place.tooth) " " (place.flank) ", u " (fixed(place.u_mm, 2))
                            ", v " (fixed(place.v_mm, 1)) " mm"
                        }
                    }
                    @if !self.note.is_empty() { span class="note" { (self.note) } }
                }
            }
        }
    }
}

/// What must be known, in a paragraph.
fn sentence(warning: &Notice) -> Markup {
    html! {
        p class=(format!("warning {}", warning.severity.name())) role="note" {
            strong { (heading(warning.severity)) ". " } (warning.text) " " code { (warning.id) }
        }
    }
}

/// A severity at the head of its sentence.
fn heading(severity: Severity) -> &'static str {
    match severity {
        Severity::Fault => "Fault",
        Severity::Warning => "Warning",
        Severity::Note => "Note",
    }
}

/// A number with fixed decimals and a real minus sign.
fn fixed(value: f64, decimals: usize) -> String {
    crate::output::axis::number_text(value, decimals)
}

/// A script as it stands in the page; its end must not be found inside.
fn own_script(text: &str) -> String {
    debug_assert!(!text.to_ascii_lowercase().contains("</script"), "a script of the page ends its own element");
    text.to_owned()
}

/// JSON that no text inside can break out of.
fn inert_json(document: &serde_json::Value) -> String {
    document.to_string().replace('<', "\\u003c")
}

/// Only the page's own scripts run, and nothing is fetched from anywhere.
fn policy(scripts: &[String]) -> String {
    let hashes: Vec<String> =
        scripts.iter().map(|script| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(script)))).collect();
    let scripts = if hashes.is_empty() { "'none'".to_owned() } else { hashes.join(" ") };
    format!(
        "default-src 'none'; style-src 'unsafe-inline'; img-src data:; script-src {scripts}; base-uri 'none'; \
        form-action 'none'"
    )
}

/// Bytes as an address that holds them.
fn data_url(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", STANDARD.encode(bytes))
}

#[cfg(test)]
mod tests;
