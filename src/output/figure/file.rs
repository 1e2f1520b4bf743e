//! A chart as a file of its own: one SVG that browsers, drawing programs and office programs open.
//!
//! In: a [`Figure`]. Out: its title, names, legends and plots in one drawing, what it shows in words for screen
//! readers, the rules of its classes, and a white ground.
//!
//! The law: nothing is left to the viewer but the letters. Variables of style sheets, which most programs do not know,
//! are replaced by the light colours of the report; rules name single classes or elements. Places of words come from
//! the widths of the embedded font, which the file names first, with room for the widest of the others.
//!
//! Road not taken: the font inside the file. It is larger than the chart, and office programs do not read it.

use std::path::Path;

use maud::{Markup, PreEscaped, html};

use super::{Figure, LegendEntry, Plot, Sample};
use crate::output::atomic::write_bytes_atomically;
use crate::output::font;
use crate::output::letters::{fitting_em_px, text_width_px};
use crate::output::plot::px;
use gearcut_core::{Error, Result};

/// Rules of everything that charts draw.
const RULES: &str = include_str!("../../../assets/report/chart.css");
/// Its first block names the light colours.
const PAGE: &str = include_str!("../../../assets/report/page.css");
/// Fonts of the words, from the one whose widths are known.
const FONTS: &str = "Noto Sans, DejaVu Sans, Arial, sans-serif";
/// Widths in DejaVu Sans, the widest of them, over widths in Noto Sans: 1.07 to 1.09 found on words of charts.
const WIDEST: f64 = 1.1;

const MARGIN_PX: f64 = 24.0;
const TITLE_EM_PX: f64 = 19.0;
const TITLE_HEIGHT_PX: f64 = 52.0;
/// Size of names and legends, pixels per em.
const EM_PX: f64 = 13.5;
const ROW_PX: f64 = 23.0;
const SAMPLE_PX: f64 = 24.0;
const GAP_PX: f64 = 22.0;
const PLOT_GAP_PX: f64 = 10.0;
const BELOW_PX: f64 = 34.0;
/// From the middle of a row down to the baseline of its words, em.
const BASELINE_EM: f64 = 0.5 * font::CAPITAL_HEIGHT_EM;

impl Figure<'_> {
    /// Writes the chart, or says why it cannot be drawn.
    pub(in crate::output) fn write_svg(&self, path: &Path, problem: Option<String>) -> Result<()> {
        let text = problem.map_or_else(|| self.svg(), Err);
        let text = text.map_err(|reason| Error::Output { path: path.to_owned(), reason })?;
        write_bytes_atomically(path, text.as_bytes())
    }

    /// The text of the file.
    pub(in crate::output) fn svg(&self) -> std::result::Result<String, String> {
        let inner_px = self.plots.iter().map(|plot| plot.size_px.0).fold(0.0, f64::max);
        let mut y = TITLE_HEIGHT_PX;
        let mut plots = Vec::with_capacity(self.plots.len());
        for plot in &self.plots {
            let head = Head::within(inner_px, plot)?;
            let top = y + head.height_px();
            plots.push(html! {
                (head.svg(y))
                g transform=(format!("translate({} {})", px(MARGIN_PX), px(top))) { (plot.drawing) }
            });
            y = top + plot.size_px.1 + PLOT_GAP_PX;
        }
        let (width, height) = (inner_px + 2.0 * MARGIN_PX, y - PLOT_GAP_PX + BELOW_PX);
        let title_em_px = fitting_em_px(self.title, TITLE_EM_PX, inner_px / WIDEST)?;
        let markup = html! {
            svg xmlns="http://www.w3.org/2000/svg" width=(px(width)) height=(px(height))
                viewBox=(format!("0 0 {} {}", px(width), px(height))) font-family=(FONTS) font-size="12.5"
                role="img" aria-labelledby="title description" {
                title id="title" { (self.title) }
                desc id="description" { (self.description()) }
                style { (PreEscaped(rules())) }
                rect width=(px(width)) height=(px(height)) fill="#ffffff" {}
                text x=(MARGIN_PX) y="34" font-size=(px(title_em_px)) { (self.title) }
                @for plot in plots { (plot) }
                text class="tick middle" x=(px(0.5 * width)) y=(px(height - 20.0)) font-size=(EM_PX) {
                    (self.x_name.text())
                }
            }
        };
        Ok(sound(&markup.into_string()))
    }

    /// What is shown, in a sentence for every plot.
    fn description(&self) -> String {
        let plots = self.plots.iter().map(|plot| {
            let entries: Vec<&str> = plot.legend.iter().map(|entry| entry.words.as_str()).collect();
            format!("{} over {}: {}.", plot.name.text(), self.x_name.text(), entries.join("; "))
        });
        plots.collect::<Vec<_>>().join(" ")
    }
}

/// Name and legend over a plot, in rows as wide as the chart.
struct Head<'a> {
    rows: Vec<Vec<(f64, Item<'a>)>>,
}

enum Item<'a> {
    Name(String),
    Entry(&'a LegendEntry),
}

impl<'a> Head<'a> {
    fn within(width_px: f64, plot: &'a Plot) -> std::result::Result<Self, String> {
        let name = std::iter::once(Item::Name(plot.name.text()));
        let mut rows: Vec<Vec<_>> = vec![Vec::new()];
        let mut x = 0.0;
        for item in name.chain(plot.legend.iter().map(Item::Entry)) {
            let item_px = match &item {
                Item::Name(words) => WIDEST * text_width_px(words, EM_PX)?,
                Item::Entry(entry) => SAMPLE_PX + 7.0 + WIDEST * text_width_px(&entry.words, EM_PX)?,
            };
            if x > 0.0 && x + item_px > width_px {
                rows.push(Vec::new());
                x = 0.0;
            }
            rows.last_mut().expect("the first row is there from the start").push((x, item));
            x += item_px + GAP_PX;
        }
        Ok(Self { rows })
    }

    fn height_px(&self) -> f64 {
        ROW_PX * self.rows.len() as f64
    }

    fn svg(&self, top: f64) -> Markup {
        html! {
            @for (row, items) in self.rows.iter().enumerate() {
                @let y = top + ROW_PX * (row as f64 + 0.5);
                @let baseline = px(y + BASELINE_EM * EM_PX);
                @for (x, item) in items {
                    @let x = MARGIN_PX + x;
                    @match item {
                        Item::Name(words) => text x=(px(x)) y=(baseline) font-size=(EM_PX) { (words) },
                        Item::Entry(entry) => {
                            (entry.sample.svg(x, y))
                            text class="tick" x=(px(x + SAMPLE_PX + 7.0)) y=(baseline) font-size=(EM_PX) {
                                (entry.words)
                            }
                        }
                    }
                }
            }
        }
    }
}

impl Sample {
    /// The sample to the right of `x`, about the height `y`.
    fn svg(self, x: f64, y: f64) -> Markup {
        let line = |class: String| {
            html! { line class=(class) x1=(px(x)) x2=(px(x + SAMPLE_PX)) y1=(px(y)) y2=(px(y)) {} }
        };
        let block = |class: String| {
            html! { rect class=(class) x=(px(x)) y=(px(y - 5.5)) width=(SAMPLE_PX) height="11" {} }
        };
        match self {
            Self::Line(series) => line(format!("curve s{series}")),
            Self::Block(series) => block(format!("bars s{series}")),
            Self::Area(series) => block(format!("area s{series}")),
            Self::Limit => line("limit".to_owned()),
        }
    }
}

/// The rules with the page's light colours in the place of their names.
fn rules() -> String {
    let mut parts = RULES.split("var(--");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once(')').expect("every name of a colour ends");
        let definition = PAGE.split_once(&format!("--{name}: ")).expect("the page names every colour").1;
        text.push_str(definition.split(';').next().unwrap_or_default());
        text.push_str(rest);
    }
    text
}

/// The text without what XML forbids, and with dashes for minus signs: many installed fonts lack the sign, and not
/// every viewer borrows it from another font.
fn sound(text: &str) -> String {
    let forbidden = |c: char| (c.is_control() && !"\n\t".contains(c)) || "\u{fffe}\u{ffff}".contains(c);
    text.replace('−', "–").replace(forbidden, "\u{fffd}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_name_their_colours_and_are_read_by_every_program() {
        let text = rules();
        assert!(text.contains(".s1 { color: #d55e00; }") && !text.contains("var("), "{text}");
        // Selectors of one class or element each, no rules within rules: what office programs understand.
        for selector in text.split('}').filter_map(|rule| rule.split_once('{')).map(|(selector, _)| selector) {
            let selector = selector.rsplit("*/").next().unwrap_or(selector).trim();
            assert!(
                selector.split(',').all(|one| {
                    one.trim().trim_start_matches('.').chars().all(|c| c.is_ascii_alphanumeric() || c == '-')
                }),
                "{selector}"
            );
        }
    }

    #[test]
    fn what_xml_forbids_does_not_get_into_files() {
        assert_eq!(sound("a\u{1}b\u{ffff} −1\n"), "a\u{fffd}b\u{fffd} –1\n");
    }
}
