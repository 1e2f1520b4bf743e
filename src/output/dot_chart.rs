//! Dots over two axes of numbers, such as the cases of a study by two of their numbers.
//!
//! In: places with words, and where each leads; a line through some of them. Out: one plot, on a page or as SVG.
//!
//! More dots than can be seen apart would only make the page heavy: of more than [`MOST_DOTS`] so many are drawn,
//! evenly chosen, and the legend says so.

use maud::html;

use crate::output::axis::{Ticks, round_range, widened};
use crate::output::figure::{Figure, LegendEntry, Name, Plot, Sample};
use crate::output::plot::{LABELS_PX, PlotFrame, WIDTH_PX, path, px};

/// Most dots that are drawn.
const MOST_DOTS: usize = 1000;
/// Radius of a dot, pixels.
const DOT_PX: f64 = 3.0;
/// Room beside the outermost dots, as a share of how far they are apart.
const MARGIN: f64 = 0.03;

/// A chart of dots.
#[derive(Debug, Clone, PartialEq)]
pub struct DotChart {
    /// What is shown.
    pub title: String,
    /// Across and up.
    pub axes: [DotAxis; 2],
    /// What the dots are, such as "cases".
    pub name: String,
    /// The dots.
    pub dots: Vec<Dot>,
    /// Name of the line, and its points; none without.
    pub line: Option<(String, Vec<[f64; 2]>)>,
}

/// An axis.
#[derive(Debug, Clone, PartialEq)]
pub struct DotAxis {
    /// What the values are.
    pub name: String,
    /// Their unit.
    pub unit: String,
    /// Smallest distance of two ticks, where less would make rounding look like a finding.
    pub least_division: f64,
}

/// One dot.
#[derive(Debug, Clone, PartialEq)]
pub struct Dot {
    /// Where it lies.
    pub at: [f64; 2],
    /// What it is.
    pub words: String,
    /// File beside the page that it leads to.
    pub link: Option<String>,
}

impl DotChart {
    fn range(&self, axis: usize) -> (f64, f64) {
        let values = self.dots.iter().map(|dot| dot.at[axis]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), value| (l.min(value), h.max(value)));
        let division = self.axes[axis].least_division;
        if axis == 0 && high - low > division {
            // Dots and the last tick keep clear of the sides.
            return (low - MARGIN * (high - low), high + MARGIN * (high - low));
        }
        widened(round_range(low, high), division)
    }

    /// The chart laid out.
    pub(super) fn figure(&self) -> Figure<'_> {
        let frame = PlotFrame::new(236.0, self.range(1));
        let (low, high) = self.range(0);
        let ticks = Ticks::over(low, high, 12);
        let x = |value: f64| frame.left + (value - low) / (high - low) * (frame.right - frame.left);
        let every = self.dots.len().div_ceil(MOST_DOTS).max(1);
        let drawn: Vec<&Dot> = self
            .dots
            .iter()
            .enumerate()
            .filter(|(i, dot)| i % every == 0 || dot.link.is_some())
            .map(|of| of.1)
            .collect();
        // The colour is the circle's own: what is inside of a link has that of links.
        let dot = |class: &str, dot: &Dot| {
            let [x, y] = [x(dot.at[0]), frame.y(dot.at[1])].map(px);
            html! { circle class=(class) cx=(x) cy=(y) r=(DOT_PX) { title { (dot.words) } } }
        };
        let drawing = html! {
            @for &value in &ticks.values { (frame.upright("grid", x(value))) }
            (frame.value_axis())
            @if let Some((_, points)) = &self.line {
                @let places: Vec<_> = points.iter().map(|at| (x(at[0]), frame.y(at[1]))).collect();
                path class="curve s1" d=(path(&places)) {}
            }
            @for of in drawn.iter().filter(|of| of.link.is_none()) { (dot("dots s0", of)) }
            @for of in &drawn {
                @if let Some(link) = &of.link { a href=(link) { (dot("dots s1", of)) } }
            }
            (frame.outline())
            @for (&value, label) in ticks.values.iter().zip(&ticks.labels) { (frame.label_below(x(value), label)) }
        };
        let share = if every > 1 { format!(", {} of {}", drawn.len(), self.dots.len()) } else { String::new() };
        let dots = LegendEntry { sample: Sample::Block(0), words: format!("{}{share}", self.name) };
        let line = self.line.iter().map(|(name, _)| LegendEntry { sample: Sample::Line(1), words: name.clone() });
        let [across, up] = &self.axes;
        Figure {
            title: &self.title,
            plots: vec![Plot {
                name: Name::new(&up.name, frame.ticks().unit_text(&up.unit)),
                legend: std::iter::once(dots).chain(line).collect(),
                size_px: (WIDTH_PX, frame.bottom + LABELS_PX),
                drawing,
            }],
            x_name: Name::new(&across.name, ticks.unit_text(&across.unit)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(count: u32) -> DotChart {
        let axis = |name: &str| DotAxis { name: name.to_owned(), unit: "mm".to_owned(), least_division: 0.0 };
        let dot = |i: u32| Dot {
            at: [f64::from(i), f64::from(i % 11)],
            words: format!("case {i}"),
            link: (i == 7).then(|| "cases/case_7.toml".to_owned()),
        };
        DotChart {
            title: "cases".to_owned(),
            axes: [axis("time"), axis("scallop")],
            name: "cases".to_owned(),
            dots: (0..count).map(dot).collect(),
            line: Some(("best".to_owned(), vec![[0.0, 0.0], [10.0, 10.0]])),
        }
    }

    #[test]
    fn dots_lie_at_their_values_and_lead_to_their_files() {
        let text = chart(11).figure().html().into_string();
        assert_eq!(text.matches("<circle").count(), 11, "{text}");
        // The plot is 894 pixels wide from 56 on, with 3 % of the dots' way beside them, and 236 high from 8 on.
        assert!(
            text.contains("<circle class=\"dots s0\" cx=\"503\" cy=\"126\" r=\"3\"><title>case 5</title>"),
            "{text}"
        );
        assert!(text.contains("<a href=\"cases/case_7.toml\"><circle class=\"dots s1\""), "{text}");
        assert!(text.contains("d=\"M81.3 244L924.7 8\""), "{text}");
    }

    #[test]
    fn of_many_dots_some_are_drawn_and_all_that_lead_somewhere() {
        let text = chart(2500).figure().html().into_string();
        assert_eq!(text.matches("<circle").count(), 834 + 1, "each third, and case 7");
        assert!(text.contains("cases, 835 of 2500"), "{text}");
    }
}
