//! The gear inspector's sheet: one upright trace per tooth, deviation across, as on the printout of a gear measuring
//! machine.
//!
//! In: traces (place, deviation) with their evaluated range, mean line and figures. Out: markup. All traces of the
//! sheets side by side, left and right flanks, share one magnification: a round number of micrometres per division,
//! chosen so that the evaluated parts fit, and not below one, where a trace would show noise of the sampling as if it
//! were a fault. What lies outside (a tip break, an undercut) is cut off at the edge of its column.

use maud::{Markup, html};

use crate::output::axis::{Ticks, round_step, value_text};
use crate::output::figure::drawing;
use crate::output::plot::{path, px};

/// A sheet of traces.
#[derive(Debug, Clone, PartialEq)]
pub struct TraceSheet {
    /// What is shown, such as "Profile, left flanks".
    pub title: String,
    /// What runs upwards, such as "u: arc from the form point".
    pub place_name: String,
    /// Unit of the places.
    pub place_unit: String,
    /// Unit of the deviations.
    pub unit: String,
    /// Whether material (positive) is drawn to the left, as on the left flanks of a tooth seen from above.
    pub mirrored: bool,
    /// The traces.
    pub traces: Vec<TraceColumn>,
}

/// One trace.
#[derive(Debug, Clone, PartialEq)]
pub struct TraceColumn {
    /// Label, such as "tooth 7".
    pub label: String,
    /// Places and deviations; NaN interrupts.
    pub points: Vec<(f64, f64)>,
    /// First and last evaluated place with the mean line's deviation there.
    pub mean_line: Option<[(f64, f64); 2]>,
    /// Figures under the trace.
    pub figures: Vec<TraceFigure>,
}

/// A figure under a trace, in the unit of the deviations.
#[derive(Debug, Clone, PartialEq)]
pub struct TraceFigure {
    /// Its sign, such as Fα.
    pub name: String,
    /// None where the trace has a hole.
    pub value: Option<f64>,
    /// Limit of its magnitude, if it has one.
    pub limit: Option<f64>,
}

impl TraceFigure {
    /// Whether it is beyond its limit.
    pub fn fails(&self) -> bool {
        matches!((self.value, self.limit), (Some(value), Some(limit)) if value.abs() > limit)
    }

    /// The value as text that fits beside its sign: no digits below [`LEAST_FIGURE`].
    pub fn text(&self) -> String {
        match self.value {
            None => "–".to_owned(),
            Some(value) if value == 0.0 || value.abs() >= LEAST_FIGURE || value.is_nan() => value_text(value),
            Some(value) if value > 0.0 => format!("< {}", value_text(LEAST_FIGURE)),
            Some(_) => format!("> {}", value_text(-LEAST_FIGURE)),
        }
    }
}

const COLUMN: f64 = 84.0;
/// Room for the limits beside the figures of the last trace.
const LIMITS: f64 = 44.0;
const LEFT: f64 = 42.0;
const TOP: f64 = 26.0;
const HEIGHT: f64 = 240.0;
const ROW: f64 = 16.0;
/// Smallest deviation of one division, µm: what inspection machines resolve.
const LEAST_DIVISION: f64 = 1.0;
/// Smallest figure whose digits are printed, µm.
const LEAST_FIGURE: f64 = 1e-3;
/// Divisions from the zero line to the edge of a column.
const DIVISIONS: f64 = 4.0;

/// Sheets side by side, on one scale.
pub fn sheets(sheets: &[TraceSheet]) -> Markup {
    let division = division(sheets);
    html! { div class="sheets" { @for sheet in sheets { (sheet.markup(division)) } } }
}

/// Deviation of one division on all of these sheets.
pub fn division(sheets: &[TraceSheet]) -> f64 {
    let evaluated = sheets.iter().flat_map(|sheet| &sheet.traces).flat_map(|trace| {
        let inside = |place: f64| trace.mean_line.is_none_or(|[from, to]| place >= from.0 && place <= to.0);
        trace.points.iter().filter(move |point| inside(point.0)).map(|point| point.1.abs())
    });
    let largest = evaluated.filter(|value| value.is_finite()).fold(0.0, f64::max);
    round_step((largest / DIVISIONS).max(LEAST_DIVISION))
}

impl TraceSheet {
    /// The sheet as markup.
    fn markup(&self, division: f64) -> Markup {
        let places = || self.traces.iter().flat_map(|trace| trace.points.iter().map(|point| point.0));
        let (low, high) = (places().fold(f64::INFINITY, f64::min), places().fold(f64::NEG_INFINITY, f64::max));
        let (low, high) = if low < high { (low, high) } else { (0.0, 1.0) };
        let y = |place: f64| TOP + HEIGHT - (place - low) / (high - low) * HEIGHT;
        let ticks = Ticks::over(low, high, 7);
        let rows = self.traces.iter().map(|trace| trace.figures.len()).max().unwrap_or(0) as f64;
        let limited = self.limits().iter().any(Option::is_some);
        let traced = LEFT + COLUMN * self.traces.len() as f64;
        let width = traced + if limited { LIMITS } else { 4.0 };
        let content = html! {
            @for (&value, label) in ticks.values.iter().zip(&ticks.labels) {
                line class="grid" x1=(LEFT) x2=(px(traced)) y1=(px(y(value))) y2=(px(y(value))) {}
                text class="tick end" x=(LEFT - 6.0) y=(px(y(value) + 4.0)) { (label) }
            }
            @for (index, trace) in self.traces.iter().enumerate() {
                @let zero = LEFT + COLUMN * (index as f64 + 0.5);
                (self.column(trace, zero, division, y))
            }
            @if limited {
                @for (row, limit) in self.limits().into_iter().enumerate() {
                    @if let Some(limit) = limit {
                        text class="figure-name end" x=(px(width - 2.0)) y=(px(figure_row(row))) {
                            "≤ " (value_text(limit))
                        }
                    }
                }
            }
        };
        html! {
            figure class="chart traces" {
                figcaption { (self.title) }
                div class="panel-head" {
                    span class="panel-name" { (self.place_name) " " span class="unit" { "[" (self.place_unit) "]" } }
                    span class="scale" {
                        "1 division = " (value_text(division)) " " (self.unit) ", material "
                        @if self.mirrored { "←" } @else { "→" }
                    }
                }
                (drawing((width, TOP + HEIGHT + 12.0 + ROW * rows), &self.title, &content))
            }
        }
    }

    /// Limits of the figures, row by row: the same under every trace.
    fn limits(&self) -> Vec<Option<f64>> {
        self.traces.first().map_or_else(Vec::new, |trace| trace.figures.iter().map(|figure| figure.limit).collect())
    }

    fn column(&self, trace: &TraceColumn, zero: f64, division: f64, y: impl Fn(f64) -> f64) -> Markup {
        let half = 0.5 * COLUMN - 4.0;
        let sign = if self.mirrored { -1.0 } else { 1.0 };
        let x = |deviation: f64| {
            let across = (deviation / division * (half / DIVISIONS)).clamp(-half, half);
            zero + sign * across
        };
        let bottom = TOP + HEIGHT;
        let points: Vec<(f64, f64)> = trace.points.iter().map(|&(place, value)| (x(value), y(place))).collect();
        html! {
            text class="label middle" x=(px(zero)) y="16" { (trace.label) }
            @for step in 1..=(DIVISIONS as i32) {
                @for side in [-1.0, 1.0] {
                    @let at = zero + side * f64::from(step) * half / DIVISIONS;
                    line class="division" x1=(px(at)) x2=(px(at)) y1=(TOP) y2=(px(bottom)) {}
                }
            }
            line class="zero" x1=(px(zero)) x2=(px(zero)) y1=(TOP) y2=(px(bottom)) {}
            path class="trace" d=(path(&thinned_upright(&points))) {}
            @if let Some(ends) = trace.mean_line {
                @for (place, _) in ends {
                    line class="limit" x1=(px(zero - half)) x2=(px(zero + half)) y1=(px(y(place))) y2=(px(y(place))) {}
                }
                path class="mean-line" d=(path(&ends.map(|(place, value)| (x(value), y(place))))) {}
            }
            @for (row, figure) in trace.figures.iter().enumerate() {
                @let at = px(figure_row(row));
                text class="figure-name" x=(px(zero - half)) y=(at) { (figure.name) }
                text class=(if figure.fails() { "figure end fails" } else { "figure end" }) x=(px(zero + half)) y=(at) {
                    (figure.text())
                }
            }
        }
    }
}

/// Baseline of a row of figures.
fn figure_row(row: usize) -> f64 {
    TOP + HEIGHT + 8.0 + ROW * (row as f64 + 0.75)
}

/// First, last, leftmost and rightmost point of each half pixel of height.
pub(in crate::output) fn thinned_upright(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut kept = Vec::new();
    for group in points.chunk_by(|a, b| (2.0 * a.1).floor() == (2.0 * b.1).floor() && a.0.is_nan() == b.0.is_nan()) {
        let last = group.len() - 1;
        let mut indices = vec![0, last];
        indices.extend((0..=last).reduce(|best, next| if group[next].0 < group[best].0 { next } else { best }));
        indices.extend((0..=last).reduce(|best, next| if group[next].0 > group[best].0 { next } else { best }));
        indices.sort_unstable();
        indices.dedup();
        kept.extend(indices.into_iter().map(|index| group[index]));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(largest_um: f64) -> TraceSheet {
        TraceSheet {
            title: "Profile".into(),
            place_name: "u".into(),
            place_unit: "mm".into(),
            unit: "µm".into(),
            mirrored: false,
            traces: vec![TraceColumn {
                label: "tooth 1".into(),
                points: vec![(0.0, -50.0), (1.0, 0.0), (2.0, largest_um), (3.0, f64::NAN), (4.0, 0.5)],
                mean_line: Some([(1.0, 0.1), (4.0, 0.2)]),
                figures: vec![
                    TraceFigure { name: "Fα".into(), value: Some(largest_um), limit: Some(16.0) },
                    TraceFigure { name: "fHα".into(), value: None, limit: None },
                ],
            }],
        }
    }

    #[test]
    fn the_division_is_round_and_fits_the_evaluated_part() {
        assert_eq!(division(&[sheet(17.0)]), 5.0);
        assert_eq!(division(&[sheet(0.06)]), 1.0, "never below a micrometre");
        // Left and right flanks are drawn to the scale of the worse.
        let text = sheets(&[sheet(0.4), sheet(17.0)]).into_string();
        assert_eq!(text.matches("1 division = 5.00 µm, material →").count(), 2, "{text}");
        assert!(text.contains("17.0") && text.contains("–"), "{text}");
        // 17 um are more than 16 um, 0.4 um are not.
        assert_eq!((text.matches("figure end fails").count(), text.matches("≤ 16.0").count()), (1, 2), "{text}");
    }

    #[test]
    fn thinning_keeps_extremes_and_gaps() {
        let points: Vec<(f64, f64)> = (0..1000).map(|k| (f64::from((k * 37) % 101), f64::from(k) * 1e-4)).collect();
        let kept = thinned_upright(&points);
        assert!(kept.len() <= 4 && kept.iter().any(|p| p.0 == 100.0) && kept.iter().any(|p| p.0 == 0.0));
        let gap = [(0.0, 0.0), (f64::NAN, 0.1), (1.0, 0.2)];
        assert_eq!(path(&thinned_upright(&gap)), "M0 0M1 0.2");
    }
}
