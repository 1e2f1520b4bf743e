//! `report.html`: a run as one page that opens offline in any browser.
//!
//! In: a [`Page`], plain data: headings, numbers, tables, charts, maps, meshes. Out: one file that holds everything:
//! style sheet, scripts, the 3D library (three.js, `assets/three/`), maps and triangles ([`viewer`]), SVG charts
//! ([`BarChart`] and its like, [`traces`], [`texture`]).
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

pub mod texture;
pub mod traces;
pub mod viewer;

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use sha2::{Digest, Sha256};

use crate::Result;
use crate::findings::Place;
use crate::output::atomic::write_bytes_atomically;
use crate::output::bar_chart::BarChart;
use crate::output::line_chart::LineChart;
use crate::output::range_chart::RangeChart;
use crate::output::report::texture::TextureWindow;
use crate::output::report::traces::TraceSheet;
use crate::output::report::viewer::Viewer;

/// Name of the file in an output folder.
pub const REPORT_FILE: &str = "report.html";

const STYLE: &str =
    concat!(include_str!("../../assets/report/page.css"), include_str!("../../assets/report/chart.css"));
const THREE: &str = include_str!("../../assets/three/three.min.js");
/// The page's own scripts, in order: data and colours, maps and picker, the gear.
const SCRIPTS: [&str; 3] = [
    include_str!("../../assets/report/data.js"),
    include_str!("../../assets/report/maps.js"),
    include_str!("../../assets/report/gear.js"),
];

/// Everything on the page.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    /// Name of the scene.
    pub title: String,
    /// What was cut, in a line.
    pub subtitle: String,
    /// What was done to it: one line per operation.
    pub operations: Vec<String>,
    /// Whether all flanks were cut.
    pub complete: bool,
    /// Program and version.
    pub program: String,
    /// What to look at first; the first two are shown largest.
    pub key_numbers: Vec<KeyNumber>,
    /// What a reader must know before trusting the numbers.
    pub warnings: Vec<String>,
    /// The gear to turn, with its maps.
    pub viewer: Option<Viewer>,
    /// The rest, in order.
    pub sections: Vec<Section>,
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

/// A part of the page with its own heading.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Name in links; lower-case letters.
    pub id: &'static str,
    /// Heading.
    pub title: String,
    /// A sentence or two about what is shown.
    pub lead: String,
    /// What it holds.
    pub blocks: Vec<Block>,
}

/// A piece of a section.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// A smaller heading.
    Heading(String),
    /// A paragraph in small print.
    Note(String),
    /// Curves.
    Lines(LineChart),
    /// Bars.
    Bars(BarChart),
    /// Bars from low to high.
    Ranges(RangeChart),
    /// The inspector's sheets, side by side.
    Traces(Vec<TraceSheet>),
    /// Rows and columns.
    Table(Table),
    /// A texture window.
    Texture(TextureWindow),
    /// Blocks that are folded away until asked for.
    Folded(String, Vec<Block>),
    /// Text as it is, such as a scene.
    Verbatim(String),
}

/// A table.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Heads of the columns; empty for a list of names and values.
    pub columns: Vec<String>,
    /// Rows; the first cell names the row.
    pub rows: Vec<Vec<String>>,
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
                            @if self.viewer.is_some() { (viewer_section()) }
                            @for section in &self.sections { (section.markup()) }
                        }
                    }
                    footer { "Written by " (self.program) ". Every number with its unit and definition: results.json \
                        beside this file." }
                    @if let Some(packed) = packed {
                        script type="application/json" id="viewer-description" { (PreEscaped(inert_json(&packed.description))) }
                        script type="text/plain" id="viewer-block" { (PreEscaped(packed.block)) }
                        @for script in scripts { script { (PreEscaped(script)) } }
                    }
                }
            }
        }
        .into_string()
    }

    fn links(&self) -> Vec<(&'static str, &str)> {
        let gear = self.viewer.as_ref().map(|_| ("gear", "Gear and maps"));
        let own = self.sections.iter().map(|section| (section.id, section.title.as_str()));
        [("key-numbers", "Key numbers")].into_iter().chain(gear).chain(own).collect()
    }

    fn head(&self) -> Markup {
        let warned = match self.warnings.len() {
            0 => "no warnings".to_owned(),
            1 => "1 warning".to_owned(),
            count => format!("{count} warnings"),
        };
        html! {
            header class="top" {
                p class="brand" { strong { "gearcut" } " cutting report" }
                h1 { (self.title) }
                p class="subtitle" { (self.subtitle) }
                ol class="operations" { @for operation in &self.operations { li { (operation) } } }
                ul class="chips" {
                    @if self.complete { li class="good" { "all flanks cut" } } @else { li class="bad" { "stopped before all flanks were cut" } }
                    @if self.warnings.is_empty() { li class="good" { (warned) } } @else { li class="bad" { a href="#warnings" { (warned) } } }
                }
            }
        }
    }

    fn numbers(&self) -> Markup {
        html! {
            section id="key-numbers" aria-labelledby="key-numbers-title" {
                h2 id="key-numbers-title" { "Key numbers" }
                dl class="numbers" {
                    @for (index, number) in self.key_numbers.iter().enumerate() { (number.markup(index < 2)) }
                }
                div id="warnings" {
                    @for warning in &self.warnings { p class="warning" role="note" { strong { "Warning. " } (warning) } }
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
                        button type="button" class="place" data-tooth=(place.tooth) data-side=(place.flank) data-u=(place.u_mm) data-v=(place.v_mm) {
                            "tooth " (place.tooth) " " (place.flank) ", u " (fixed(place.u_mm, 2)) ", v " (fixed(place.v_mm, 1)) " mm"
                        }
                    }
                    @if !self.note.is_empty() { span class="note" { (self.note) } }
                }
            }
        }
    }
}

impl Section {
    fn markup(&self) -> Markup {
        let title_id = format!("{}-title", self.id);
        html! {
            section id=(self.id) aria-labelledby=(title_id) {
                h2 id=(title_id) { (self.title) }
                @if !self.lead.is_empty() { p class="lead" { (self.lead) } }
                @for block in &self.blocks { (block.markup()) }
            }
        }
    }
}

impl Block {
    fn markup(&self) -> Markup {
        match self {
            Self::Heading(words) => html! { h3 { (words) } },
            Self::Note(words) => html! { p class="note" { (words) } },
            Self::Lines(chart) => chart.figure().html(),
            Self::Bars(chart) => chart.figure().html(),
            Self::Ranges(chart) => chart.figure().html(),
            Self::Traces(sheets) => traces::sheets(sheets),
            Self::Table(table) => table.markup(),
            Self::Texture(window) => texture::window(window),
            Self::Folded(summary, blocks) => html! {
                details { summary { (summary) } @for block in blocks { (block.markup()) } }
            },
            Self::Verbatim(text) => html! { pre tabindex="0" { (text) } },
        }
    }
}

impl Table {
    fn markup(&self) -> Markup {
        // A column of numbers is set to the right.
        let number = |column: usize| {
            let cells = || self.rows.iter().filter_map(|row| row.get(column));
            !self.columns.is_empty()
                && cells().all(|cell| cell.starts_with(|c: char| c.is_ascii_digit() || "−-–+".contains(c)))
        };
        let class = |column: usize| if number(column) { "number" } else { "" };
        html! {
            div class="table" tabindex="0" role="group" aria-label=(self.caption) {
                table class=(if self.columns.is_empty() { "list" } else { "" }) {
                    caption { (self.caption) }
                    @if !self.columns.is_empty() {
                        thead { tr { @for (index, column) in self.columns.iter().enumerate() { th scope="col" class=(class(index)) { (column) } } } }
                    }
                    tbody {
                        @for row in &self.rows {
                            tr {
                                @for (index, cell) in row.iter().enumerate() {
                                    @if index == 0 { th scope="row" class=(class(0)) { (cell) } } @else { td class=(class(index)) { (cell) } }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// The 3D view, the picker and the map: empty frames that the scripts fill.
fn viewer_section() -> Markup {
    let turn = |action: &str, words: &str, label: &str| html! { button type="button" data-view=(action) title=(label) aria-label=(label) { (words) } };
    html! {
        section id="gear" aria-labelledby="gear-title" {
            h2 id="gear-title" { "Gear and maps" }
            noscript { p class="warning" { "The gear and its maps need JavaScript; all numbers and charts below do \
                not." } }
            div class="viewer" {
                div class="stage" {
                    canvas id="gear-view" tabindex="0" role="application" aria-label="The gear in three dimensions" aria-describedby="gear-help" {}
                    p id="gear-failed" class="warning" hidden { "This browser gives no WebGL 2: the gear cannot be \
                        drawn. Maps and charts work without it." }
                    div class="stage-tools" role="toolbar" aria-label="View" {
                        (turn("home", "Home", "View from above, the whole gear"))
                        (turn("front", "Face", "View along the axis"))
                        (turn("flank", "Flank", "View of the picked flank"))
                        (turn("closer", "+", "Closer"))
                        (turn("further", "−", "Further away"))
                    }
                    output id="gear-readout" class="readout" aria-live="off" {}
                }
                div class="picker" {
                    label class="field" { span { "Show" } select id="quantity" {} }
                    div class="field" {
                        span id="tooth-label" { "Tooth" }
                        div class="stepper" {
                            button type="button" id="tooth-before" aria-label="Tooth before" { "‹" }
                            input id="tooth" type="number" inputmode="numeric" min="1" step="1" aria-labelledby="tooth-label";
                            button type="button" id="tooth-after" aria-label="Tooth after" { "›" }
                        }
                    }
                    fieldset class="field sides" {
                        legend { "Flank" }
                        label { input type="radio" name="side" value="left" checked; span { "left" } }
                        label { input type="radio" name="side" value="right"; span { "right" } }
                    }
                    div class="field bar" { span id="bar-name" {} canvas id="bar" role="img" aria-labelledby="bar-name" {} }
                    p id="quantity-definition" class="note" {}
                    dl id="flank-numbers" class="flank-numbers" {}
                }
            }
            p id="gear-help" class="note" {
                "Drag to turn; click into the view, then turn the wheel or pinch to come closer; drag with the right \
                button to move. Keys: arrows turn, + and − come closer and go away, Home goes back. A click on a flank \
                picks it."
            }
            figure class="chart map" {
                figcaption id="map-title" {}
                canvas id="map" tabindex="0" role="application" aria-labelledby="map-title" aria-describedby="map-help" {}
                div class="x-name" { "v: along the tooth from the middle of the face [mm]" }
                output id="map-readout" class="readout-line" aria-live="polite" {}
                p id="map-help" class="note" { "Point at a place, or move the cross with the arrow keys, to read its \
                    value. Up is u: along the profile from the form point (the root side) to the tip." }
            }
            figure class="chart sheet" {
                figcaption { "All flanks, to one scale" }
                div id="sheet" role="listbox" aria-label="All flanks" {}
            }
        }
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
mod tests {
    use super::*;

    const HOSTILE: &str = "</script><script>alert('x')</script><img src=x onerror=alert(1)>\"'&";

    fn page() -> Page {
        let chart = |title: &str| LineChart {
            title: title.into(),
            x_name: title.into(),
            x_unit: title.into(),
            panels: vec![crate::output::line_chart::Panel {
                least_division: 0.0,
                value_name: title.into(),
                unit: title.into(),
                series: vec![crate::output::line_chart::LineSeries {
                    name: title.into(),
                    points: vec![(0.0, 0.0), (1.0, 1.0)],
                }],
                limits: vec![],
            }],
        };
        let axis = || crate::output::grid::MapAxis {
            name: HOSTILE.into(),
            meaning: HOSTILE.into(),
            start_mm: 0.0,
            step_mm: 1.0,
            count: 2,
        };
        Page {
            title: HOSTILE.into(),
            subtitle: HOSTILE.into(),
            operations: vec![HOSTILE.into()],
            complete: true,
            program: HOSTILE.into(),
            key_numbers: vec![KeyNumber {
                name: HOSTILE.into(),
                value: HOSTILE.into(),
                unit: HOSTILE.into(),
                definition: HOSTILE.into(),
                note: HOSTILE.into(),
                place: Some(Place::on_flank(1, HOSTILE, 1.0, -2.0)),
            }],
            warnings: vec![HOSTILE.into()],
            viewer: Some(Viewer {
                flanks: vec![viewer::ViewerFlank {
                    tooth: 1,
                    side: HOSTILE.into(),
                    grid: Some(crate::output::grid::MapGrid { u: axis(), v: axis() }),
                    triangles: crate::surface::triangles::Triangles::default(),
                    places_mm: vec![],
                }],
                quantities: vec![viewer::ViewerQuantity {
                    name: HOSTILE.into(),
                    definition: HOSTILE.into(),
                    unit: HOSTILE.into(),
                    scale: crate::colormap::ColourScale::Diverging { limit: 1.0 },
                    thinning: viewer::Thinning::Mean,
                    values: vec![vec![0.0, 1.0, f32::NAN, -1.0]],
                }],
                body: crate::surface::triangles::Triangles::default(),
            }),
            sections: vec![Section {
                id: "all",
                title: HOSTILE.into(),
                lead: HOSTILE.into(),
                blocks: vec![
                    Block::Heading(HOSTILE.into()),
                    Block::Note(HOSTILE.into()),
                    Block::Lines(chart(HOSTILE)),
                    Block::Table(Table {
                        caption: HOSTILE.into(),
                        columns: vec![HOSTILE.into()],
                        rows: vec![vec![HOSTILE.into()]],
                    }),
                    Block::Folded(HOSTILE.into(), vec![Block::Verbatim(HOSTILE.into())]),
                ],
            }],
        }
    }

    /// The only tags are the page's own, wherever hostile text is put.
    #[test]
    fn text_from_a_scene_stays_text() {
        let text = page().html();
        assert_eq!(
            text.matches("<script").count(),
            2 + 1 + SCRIPTS.len(),
            "two blocks of data, three.js, the page's scripts"
        );
        assert_eq!(text.matches("</script").count(), 2 + 1 + SCRIPTS.len());
        assert_eq!(text.matches("<img").count(), 0);
        assert!(!text.contains("onerror=alert(1)>\"'"), "an attribute is left open");
        assert!(text.contains("&lt;script&gt;alert"));
    }

    #[test]
    fn the_same_page_has_the_same_bytes_and_names_its_scripts() {
        let text = page().html();
        assert_eq!(text, page().html());
        let hash = STANDARD.encode(Sha256::digest(SCRIPTS[2]));
        assert!(text.contains(&format!("'sha256-{hash}'")), "the policy lets the page's own scripts run");
        assert!(text.contains("default-src 'none'"));
    }

    /// What could make a browser ask the network for anything; names of XML dialects are no addresses.
    #[test]
    fn nothing_on_the_page_lies_elsewhere() {
        let text = page().html();
        for word in [
            "src=\"http",
            "href=\"http",
            "url(",
            "@import",
            "<link",
            "<iframe",
            "fetch(",
            "XMLHttpRequest(",
            "navigator.sendBeacon",
        ] {
            let own =
                if ["fetch(", "XMLHttpRequest("].contains(&word) { text.replace(THREE, "") } else { text.clone() };
            assert!(!own.contains(word), "{word}");
        }
    }

    #[test]
    fn the_library_is_the_one_that_its_record_names() {
        let record = include_str!("../../assets/three/README.md");
        let hash: String = Sha256::digest(THREE)
            .iter()
            .flat_map(|byte| [byte >> 4, byte & 15])
            .filter_map(|half| char::from_digit(half.into(), 16))
            .collect();
        assert!(record.contains(&hash), "assets/three/README.md does not name {hash}");
    }
}
