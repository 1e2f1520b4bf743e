//! Charts laid out, whatever they show: plots one below the other, each with its name and legend over it.
//!
//! In: what [`LineChart`](crate::output::line_chart::LineChart), [`BarChart`](crate::output::bar_chart::BarChart) and
//! their like draw: SVG markup whose colours are classes. Out: the same chart in two surroundings.
//!
//! - On the page of the report title, names and legends are HTML beside the SVG: they wrap on narrow screens, readers
//!   can select them, and the page gives the colours, light and dark.
//! - As a file ([`mod@file`]) everything is inside one SVG with fixed colours on white.
//!
//! Both take their rules from `assets/report/chart.css`. The colours of series are those of M. Okabe and K. Ito (2008),
//! darkened for thin lines, the dark ones first and without the yellow that vanishes on white.
//!
//! Road not taken: pictures of charts. A chart of lines and words is smaller as SVG, sharp at every size, and its words
//! can be searched.

mod file;

use maud::{Markup, html};

use crate::output::plot::px;

/// Series that have colours of their own.
pub(super) const MOST_SERIES: usize = 7;

/// A chart laid out.
pub(super) struct Figure<'a> {
    /// What is shown.
    pub title: &'a str,
    /// From the top.
    pub plots: Vec<Plot>,
    /// What the common axis is.
    pub x_name: Name,
}

/// One plot of a figure.
pub(super) struct Plot {
    /// What the values are.
    pub name: Name,
    /// What the colours mean.
    pub legend: Vec<LegendEntry>,
    /// Width and height of the drawing, pixels.
    pub size_px: (f64, f64),
    /// The drawing.
    pub drawing: Markup,
}

/// What an axis shows.
pub(super) struct Name {
    words: String,
    unit: String,
}

impl Name {
    pub(super) fn new(words: &str, unit: String) -> Self {
        Self { words: words.to_owned(), unit }
    }

    /// The unit in brackets; nothing for plain numbers.
    fn bracketed_unit(&self) -> Option<String> {
        (!["", "1"].contains(&self.unit.as_str())).then(|| format!("[{}]", self.unit))
    }

    fn html(&self) -> Markup {
        html! { (self.words) @if let Some(unit) = self.bracketed_unit() { " " span class="unit" { (unit) } } }
    }

    fn text(&self) -> String {
        self.bracketed_unit().map_or_else(|| self.words.clone(), |unit| format!("{} {unit}", self.words))
    }
}

/// One entry of a legend.
pub(super) struct LegendEntry {
    pub sample: Sample,
    pub words: String,
}

/// How an entry looks; numbers are those of series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sample {
    Line(usize),
    Block(usize),
    /// A surface under a curve: see-through.
    Area(usize),
    Limit,
}

impl Sample {
    fn html(self) -> Markup {
        let (kind, series) = match self {
            Self::Line(series) => ("line", Some(series)),
            Self::Block(series) => ("block", Some(series)),
            Self::Area(series) => ("block area", Some(series)),
            Self::Limit => ("dashes", None),
        };
        html! { i class=(series.map_or_else(|| kind.to_owned(), |series| format!("{kind} s{series}"))) {} }
    }
}

impl Figure<'_> {
    /// The chart on a page.
    pub(super) fn html(&self) -> Markup {
        html! {
            figure class="chart" {
                figcaption { (self.title) }
                @for plot in &self.plots {
                    div class="panel" {
                        div class="panel-head" {
                            span class="panel-name" { (plot.name.html()) }
                            ul class="legend" {
                                @for entry in &plot.legend { li { (entry.sample.html()) (entry.words) } }
                            }
                        }
                        (drawing(plot.size_px, &format!("{}: {}", self.title, plot.name.words), &plot.drawing))
                    }
                }
                div class="x-name" { (self.x_name.html()) }
            }
        }
    }
}

/// A drawing on a page, with what a screen reader says of it.
pub(super) fn drawing((width, height): (f64, f64), label: &str, content: &Markup) -> Markup {
    // As wide as drawn and a tenth more, so that letters keep their size on every sheet.
    let style = format!("max-width: {}px", px(1.1 * width));
    html! {
        div class="plot" tabindex="0" role="group" aria-label=(label) {
            svg style=(style) viewBox=(format!("0 0 {} {}", px(width), px(height))) role="img" aria-label=(label) {
                (content)
            }
        }
    }
}
