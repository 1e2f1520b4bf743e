//! What stands on the page: sections of headings, charts, tables and notes.

use super::data_url;
use super::table::PageTable;
use super::texture::{self, TextureBlock};
use super::traces::{self, TraceSheet};
use crate::output::bar_chart::BarChart;
use crate::output::bar_panels::BarPanels;
use crate::output::dot_chart::DotChart;
use crate::output::heat_chart::HeatChart;
use crate::output::line_chart::LineChart;
use crate::output::range_chart::RangeChart;
use crate::output::strip_chart::StripChart;
use maud::{Markup, html};

/// A part of the page with its own heading.
#[derive(Debug, Clone, PartialEq)]
pub struct PageSection {
    /// Name in links; lower-case letters.
    pub id: &'static str,
    /// Heading.
    pub title: String,
    /// A sentence or two about what is shown.
    pub lead: String,
    /// What it holds.
    pub blocks: Vec<Block>,
    /// What it comes to, in a line; none where only a reader can say.
    pub verdict: Option<SectionVerdict>,
}

/// What a section comes to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SectionVerdict {
    /// In a line.
    pub words: String,
    /// Whether it is good or bad.
    pub tone: Tone,
}

/// How a verdict looks, and whether its section is folded away.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// All is as it should be: folded.
    Fine,
    /// Something is not: open.
    Wrong,
    /// Numbers that nothing judges: open.
    Open,
    /// To be looked up: folded.
    Aside,
}

impl PageSection {
    /// A part of the page, open.
    pub fn new(id: &'static str, title: impl Into<String>, lead: impl Into<String>, blocks: Vec<Block>) -> Self {
        Self { id, title: title.into(), lead: lead.into(), blocks, verdict: None }
    }

    /// The same with what it comes to.
    #[must_use]
    pub fn judged(self, tone: Tone, words: impl Into<String>) -> Self {
        Self { verdict: Some(SectionVerdict { words: words.into(), tone }), ..self }
    }

    /// The place that links lead to. It is inside what is folded: a browser then unfolds it, without a script.
    pub(super) fn anchor(&self) -> String {
        format!("{}-inside", self.id)
    }

    fn is_folded(&self) -> bool {
        self.verdict.as_ref().is_some_and(|verdict| matches!(verdict.tone, Tone::Fine | Tone::Aside))
    }
}

impl Tone {
    /// Its class on the page.
    fn class(self) -> &'static str {
        match self {
            Self::Fine => "good",
            Self::Wrong => "bad",
            Self::Open | Self::Aside => "plain",
        }
    }
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
    /// Bars in panels.
    Panels(BarPanels),
    /// Dots over two axes.
    Dots(DotChart),
    /// Coloured cells.
    Heat(HeatChart),
    /// Dots along lines.
    Strips(StripChart),
    /// Bars from low to high.
    Ranges(RangeChart),
    /// The inspector's sheets, side by side.
    Traces(Vec<TraceSheet>),
    /// Rows and columns.
    Table(PageTable),
    /// A texture window.
    Texture(TextureBlock),
    /// A picture with what it shows: PNG, plain or animated.
    Picture(String, Vec<u8>),
    /// A drawing with what it shows: SVG that brings its own colours.
    Drawing(String, String),
    /// Blocks that are folded away until asked for.
    Folded(String, Vec<Block>),
    /// Text as it is, such as a scene.
    Verbatim(String),
    /// Files beside the page.
    Files(Vec<FileLinks>),
}

/// Files of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct FileLinks {
    /// What they hold.
    pub what: String,
    /// Their paths, relative to the page.
    pub files: Vec<String>,
    /// How many more there are.
    pub more: usize,
}

impl FileLinks {
    fn markup(&self) -> Markup {
        html! {
            dt { (self.what) }
            dd {
                @for file in &self.files { a href=(address(file)) { (file) } " " }
                @if self.more > 0 { span class="note" { "and " (self.more) " more" } }
            }
        }
    }
}

/// A relative path as an address: what may mean something else there is written by its bytes.
fn address(path: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_./".contains(&byte);
    path.bytes().map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") }).collect()
}

impl PageSection {
    /// The section as HTML.
    pub(super) fn markup(&self) -> Markup {
        let title_id = format!("{}-title", self.id);
        html! {
            section id=(self.id) aria-labelledby=(title_id) {
                details class="section" open[!self.is_folded()] {
                    summary {
                        h2 id=(title_id) { (self.title) }
                        @if let Some(verdict) = &self.verdict {
                            span class=(format!("verdict {}", verdict.tone.class())) { (verdict.words) }
                        }
                    }
                    div id=(self.anchor()) class="inside" {
                        @if !self.lead.is_empty() { p class="lead" { (self.lead) } }
                        @for block in &self.blocks { (block.markup()) }
                    }
                }
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
            Self::Panels(chart) => chart.figure().html(),
            Self::Dots(chart) => chart.figure().html(),
            Self::Heat(chart) => chart.figure().html(),
            Self::Strips(chart) => chart.figure().html(),
            Self::Ranges(chart) => chart.figure().html(),
            Self::Traces(sheets) => traces::sheets(sheets),
            Self::Table(table) => table.markup(),
            Self::Texture(window) => texture::window(window),
            Self::Picture(words, png) => html! {
                figure class="picture" {
                    figcaption { (words) }
                    img src=(data_url("image/png", png)) alt=(words);
                }
            },
            Self::Drawing(words, svg) => html! {
                figure class="picture" {
                    figcaption { (words) }
                    img src=(data_url("image/svg+xml", svg.as_bytes())) alt=(words);
                }
            },
            Self::Folded(summary, blocks) => html! {
                details { summary { (summary) } @for block in blocks { (block.markup()) } }
            },
            Self::Verbatim(text) => html! { pre tabindex="0" { (text) } },
            Self::Files(rows) => html! { dl class="files" { @for row in rows { (row.markup()) } } },
        }
    }
}
