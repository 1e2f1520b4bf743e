//! Values of many gears along lines, one line for each number: every gear a dot, the interval and the median behind.
//!
//! In: numbers with their unit, the values of all gears, and low, middle and high value. Out: strips one below the
//! other, each with a scale of its own, on a page or as an SVG file.
//!
//! Road not taken: histograms. Bins hide single gears that are far off, and those are looked for.

use std::path::Path;

use maud::html;

use crate::output::axis::{Ticks, round_range, value_text, widened};
use crate::output::figure::{Figure, LegendEntry, Name, Plot, Sample};
use crate::output::plot::{LABELS_PX, PlotFrame, WIDTH_PX, px};
use gearcut_core::Result;

/// Height of a strip, pixels.
const HEIGHT_PX: f64 = 34.0;
/// Room at both ends of a strip for half a label, pixels.
const SIDE_PX: f64 = 30.0;
/// Labels of a strip at most.
const MOST_TICKS: usize = 12;
/// Radius of a dot, pixels.
const DOT_PX: f64 = 2.2;
/// Dots are spread over the height by multiples of the golden section: neighbours keep apart, and equal gears make
/// equal pictures.
const GOLDEN_SECTION: f64 = 0.618_033_988_749_894_9;

/// Strips of dots.
#[derive(Debug, Clone, PartialEq)]
pub struct StripChart {
    /// What is shown.
    pub title: String,
    /// What a dot is, such as "seed".
    pub dot_name: String,
    /// From the top.
    pub strips: Vec<Strip>,
}

/// One number.
#[derive(Debug, Clone, PartialEq)]
pub struct Strip {
    /// What the values are.
    pub name: String,
    /// Their unit.
    pub unit: String,
    /// Smallest distance of two ticks; 0 for none.
    pub least_division: f64,
    /// Number and value of every dot.
    pub dots: Vec<(u32, f64)>,
    /// Low end of the interval, middle, high end.
    pub interval: [f64; 3],
    /// What the interval is, such as "5 to 95 %".
    pub interval_name: String,
}

impl Strip {
    fn range(&self) -> (f64, f64) {
        let values = || self.dots.iter().map(|dot| dot.1).chain(self.interval);
        let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        widened(round_range(low, high), self.least_division)
    }

    fn plot(&self, dot_name: &str) -> Plot {
        let (low, high) = self.range();
        let frame = PlotFrame { left: SIDE_PX, right: WIDTH_PX - SIDE_PX, ..PlotFrame::new(HEIGHT_PX, (0.0, 1.0)) };
        let ticks = Ticks::over(low, high, MOST_TICKS);
        let x = |value: f64| frame.left + (value - low) / (high - low) * (frame.right - frame.left);
        let [from, middle, to] = self.interval;
        let drawing = html! {
            @for (&value, label) in ticks.values.iter().zip(&ticks.labels) {
                (frame.upright("grid", x(value)))
                (frame.label_below(x(value), label))
            }
            rect class="area s0" x=(px(x(from))) y=(frame.top) width=(px((x(to) - x(from)).max(1.0)))
                height=(frame.bottom - frame.top) {}
            g class="bars s1" {
                @for &(number, value) in &self.dots {
                    @let share = (f64::from(number) * GOLDEN_SECTION).fract();
                    circle cx=(px(x(value))) cy=(px(frame.y(0.1 + 0.8 * share))) r=(DOT_PX) {
                        title { (dot_name) " " (number) ": " (value_text(value)) " " (self.unit) }
                    }
                }
            }
            (frame.upright("curve s0", x(middle)))
            (frame.outline())
        };
        let text = |value: f64| format!("{} {}", value_text(value), self.unit);
        Plot {
            name: Name::new(&self.name, ticks.unit_text(&self.unit)),
            legend: vec![
                LegendEntry { sample: Sample::Line(0), words: format!("median {}", text(middle)) },
                LegendEntry {
                    sample: Sample::Area(0),
                    words: format!("{}: {} to {}", self.interval_name, value_text(from), text(to)),
                },
            ],
            size_px: (WIDTH_PX, frame.bottom + LABELS_PX),
            drawing,
        }
    }
}

impl StripChart {
    /// Writes the chart as SVG.
    ///
    /// # Errors
    /// No strips, values that are not finite, and files that cannot be written.
    pub fn write_svg(&self, path: &Path) -> Result<()> {
        self.figure().write_svg(path, self.problem())
    }

    /// Why the chart cannot be drawn, if it cannot.
    fn problem(&self) -> Option<String> {
        if self.strips.is_empty() {
            return Some("a chart needs at least one strip".to_owned());
        }
        let finite = |strip: &Strip| strip.dots.iter().all(|dot| dot.1.is_finite());
        let wrong = self.strips.iter().find(|strip| !finite(strip))?;
        Some(format!("strip {} has values that are not finite", wrong.name))
    }

    /// The chart laid out.
    pub(super) fn figure(&self) -> Figure<'_> {
        Figure {
            title: &self.title,
            plots: self.strips.iter().map(|strip| strip.plot(&self.dot_name)).collect(),
            x_name: Name::new(&format!("every dot is a {}", self.dot_name), String::new()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_stand_where_their_values_are_on_the_axis() {
        let strip = Strip {
            name: "Sa".to_owned(),
            unit: "µm".to_owned(),
            least_division: 0.0,
            dots: vec![(1, 0.0), (2, 4.0), (3, 1.0)],
            interval: [0.0, 1.0, 4.0],
            interval_name: "5 to 95 %".to_owned(),
        };
        let chart = StripChart { title: "gears".to_owned(), dot_name: "seed".to_owned(), strips: vec![strip] };
        assert_eq!(chart.problem(), None);
        let text = chart.figure().html().into_string();
        // The frame is 900 pixels wide from 30 on: 0 at its left end, 4 at its right one, 1 at a quarter.
        for (x, words) in [("30", "seed 1: 0 µm"), ("930", "seed 2: 4.00 µm"), ("255", "seed 3: 1.00 µm")] {
            let dot = format!("<circle cx=\"{x}\"");
            assert!(text.contains(&dot) && text.contains(words), "{dot} {words}: {text}");
        }
        assert!(text.contains("median 1.00 µm") && text.contains("5 to 95 %: 0 to 4.00 µm"), "{text}");
    }
}
