//! The gear inspector's sheet on one page: profile, helix, pitch and runout with their figures, limits and verdicts.
//!
//! In: traces as on the report, pitch deviations and runout in um, the gear's sizes, figures. Out: a [`VectorPage`],
//! written as SVG and PDF. Left flanks stand left. Profiles share one magnification, helices another, both sides of a
//! pitch deviation one axis; a division is a micrometre at least.

use super::axis::{Ticks, number_text, round_step, value_text};
use super::report::traces::{TraceColumn, TraceSheet, division, thinned_upright};
use super::vector_page::{A4_PT, Anchor, Ink, VectorPage};

/// What stands on the sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct InspectionSheet {
    /// Name of the scene.
    pub title: String,
    /// The gear in a line.
    pub subtitle: String,
    /// Program with its version.
    pub program: String,
    /// Name, sign and value of every size.
    pub sizes: Vec<[String; 3]>,
    /// Profiles of left and right flanks.
    pub profiles: [TraceSheet; 2],
    /// Helices of left and right flanks.
    pub helices: [TraceSheet; 2],
    /// Single pitch deviations of left and right flanks, tooth by tooth, um; empty where not measured.
    pub single_pitch_um: [Vec<f64>; 2],
    /// Cumulative ones.
    pub cumulative_pitch_um: [Vec<f64>; 2],
    /// Limit of single pitch deviations, um.
    pub single_pitch_limit_um: Option<f64>,
    /// Place of the probe in the space after each tooth, um; empty where not measured.
    pub runout_um: Vec<f64>,
    /// Figures with limits: cells of the table below.
    pub figures: Vec<SheetFigure>,
    /// Verdict of the whole gear, and the limits that it was judged by.
    pub verdict: String,
    /// Whether a limit is passed.
    pub fails: bool,
    /// What a reader must know of the numbers.
    pub notes: Vec<String>,
}

/// A row of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct SheetFigure {
    /// Sign, left, right, limit, class, verdict.
    pub cells: [String; 6],
    /// Whether it is beyond its limit.
    pub fails: bool,
}

const LEFT: f64 = 36.0;
const RIGHT: f64 = A4_PT[0] - 36.0;
const MIDDLE: f64 = 0.5 * A4_PT[0];
const GAP: f64 = 8.0;
/// Divisions from the zero line of a trace to its neighbour's.
const DIVISIONS: f64 = 4.0;
const TRACE_HEIGHT: f64 = 122.0;
/// From row to row of the table.
const TABLE_ROW: f64 = 7.8;
/// Size of figures under traces: a sign and six digits fit under the narrowest trace.
const FIGURE_EM: f64 = 5.2;
/// Smallest division of an axis, um.
const LEAST_DIVISION_UM: f64 = 1.0;

impl InspectionSheet {
    /// The page.
    pub fn page(&self) -> VectorPage {
        let mut page = VectorPage::new(&format!("{}: gear inspection", self.title));
        let foot = self.down_to_the_foot(&mut page);
        self.foot(&mut page, foot);
        page
    }

    /// Everything but the foot; where that begins.
    fn down_to_the_foot(&self, page: &mut VectorPage) -> f64 {
        let mut y = self.head(page);
        for (name, sheets) in [("Profile", &self.profiles), ("Helix", &self.helices)] {
            y = traces(page, y, name, sheets);
        }
        self.pitch(page, y)
    }

    /// Title and sizes; where they end.
    fn head(&self, page: &mut VectorPage) -> f64 {
        page.words((LEFT, 44.0), 15.0, Ink::Black, Anchor::Start, &format!("Gear inspection: {}", self.title));
        page.words((RIGHT, 44.0), 7.0, Ink::Grey, Anchor::End, &self.program);
        page.words((LEFT, 57.0), 7.5, Ink::Grey, Anchor::Start, &self.subtitle);
        let columns = 3;
        let rows = self.sizes.len().div_ceil(columns);
        let width = (RIGHT - LEFT) / columns as f64;
        for (index, [name, sign, value]) in self.sizes.iter().enumerate() {
            let x = LEFT + width * (index / rows) as f64;
            let y = 72.0 + 9.6 * (index % rows) as f64;
            page.words((x, y), 6.6, Ink::Grey, Anchor::Start, &format!("{name}, {sign}"));
            page.words((x + width - 10.0, y), 6.6, Ink::Black, Anchor::End, value);
        }
        72.0 + 9.6 * rows as f64
    }

    /// Single and cumulative pitch deviations and runout; where they end.
    fn pitch(&self, page: &mut VectorPage, top: f64) -> f64 {
        let half = MIDDLE - LEFT - GAP;
        let single = ValueAxis::over(self.single_pitch_um.iter().flatten().chain(&self.limits()));
        let cumulative = ValueAxis::over(self.cumulative_pitch_um.iter().flatten());
        let sides = [(LEFT, "left flanks"), (MIDDLE + GAP, "right flanks")];
        for (index, (x, side)) in sides.into_iter().enumerate() {
            let place = ChartBox { x, y: top, width: half, height: 60.0 };
            let title = format!("Single pitch deviation fp, {side} [µm]");
            single.frame(page, place, &title);
            single.bars(page, place, &self.single_pitch_um[index]);
            for limit in self.limits() {
                let at = single.y(place, limit);
                page.dashes(&[(x, at), (x + half, at)], Ink::Red, 0.7);
            }
            let place = ChartBox { y: top + 80.0, ..place };
            cumulative.frame(page, place, &format!("Cumulative pitch deviation Fp, {side} [µm]"));
            cumulative.line(page, place, &self.cumulative_pitch_um[index]);
        }
        let runout = ValueAxis::over(self.runout_um.iter());
        let place = ChartBox { x: LEFT, y: top + 160.0, width: half, height: 60.0 };
        runout.frame(page, place, "Runout Fr: probe in the space after each tooth [µm]");
        runout.bars(page, place, &self.runout_um);
        let table = self.table(page, MIDDLE + GAP, top + 162.0);
        (table + 14.0).max(top + 160.0 + 60.0 + 32.0)
    }

    /// Both signs of the limit of single pitch deviations.
    fn limits(&self) -> Vec<f64> {
        self.single_pitch_limit_um.map_or_else(Vec::new, |limit| vec![-limit, limit])
    }

    /// Figures with limits; where they end.
    fn table(&self, page: &mut VectorPage, x: f64, top: f64) -> f64 {
        let ends = [0.0, 78.0, 118.0, 158.0, 205.0, RIGHT - x];
        let heads = ["[µm]", "left", "right", "limit", "class", "verdict"];
        let row = |page: &mut VectorPage, y: f64, cells: [&str; 6], inks: [Ink; 2]| {
            for (index, (cell, end)) in cells.into_iter().zip(ends).enumerate() {
                let anchor = if index == 0 { Anchor::Start } else { Anchor::End };
                let ink = if index == 5 { inks[1] } else { inks[0] };
                page.words((x + end, y), 6.6, ink, anchor, cell);
            }
        };
        row(page, top, heads, [Ink::Grey; 2]);
        page.path(&[(x, top + 2.5), (RIGHT, top + 2.5)], Ink::Grey, 0.5);
        for (index, figure) in self.figures.iter().enumerate() {
            let y = top + 10.5 + TABLE_ROW * index as f64;
            let ink = if figure.fails { Ink::Red } else { Ink::Black };
            row(page, y, figure.cells.each_ref().map(String::as_str), [Ink::Black, ink]);
        }
        top + 10.5 + TABLE_ROW * self.figures.len().saturating_sub(1) as f64
    }

    fn foot(&self, page: &mut VectorPage, top: f64) {
        let ink = if self.fails { Ink::Red } else { Ink::Black };
        page.words((LEFT, top), 9.0, ink, Anchor::Start, &self.verdict);
        for (index, note) in self.notes.iter().enumerate() {
            page.words((LEFT, top + 11.0 + 8.4 * index as f64), 6.4, Ink::Grey, Anchor::Start, note);
        }
    }
}

/// Traces of left and right flanks side by side on one scale; where they end.
fn traces(page: &mut VectorPage, top: f64, name: &str, sheets: &[TraceSheet; 2]) -> f64 {
    let um = division(sheets);
    let half = MIDDLE - LEFT - GAP;
    let rows = sheets.iter().flat_map(|sheet| &sheet.traces).map(|trace| trace.figures.len()).max().unwrap_or(0);
    for (x, sheet, side) in [(LEFT, &sheets[0], "left"), (MIDDLE + GAP, &sheets[1], "right")] {
        let arrow = if sheet.mirrored { "←" } else { "→" };
        page.words((x, top + 6.0), 8.0, Ink::Black, Anchor::Start, &format!("{name}, {side} flanks"));
        let scale = format!("1 division = {} µm, material {arrow}", value_text(um));
        page.words((x + half, top + 6.0), 6.4, Ink::Grey, Anchor::End, &scale);
        let frame = ChartBox { x: x + 20.0, y: top + 19.0, width: half - 50.0, height: TRACE_HEIGHT };
        sheet_of_traces(page, frame, sheet, um);
    }
    top + 19.0 + TRACE_HEIGHT + 8.0 * rows as f64 + 14.0
}

fn sheet_of_traces(page: &mut VectorPage, place: ChartBox, sheet: &TraceSheet, um: f64) {
    let all = || sheet.traces.iter().flat_map(|trace| trace.points.iter().map(|point| point.0));
    let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    if low >= high {
        page.words((place.x, place.y + 20.0), 7.0, Ink::Grey, Anchor::Start, "not measured");
        return;
    }
    let y = |at: f64| place.y + place.height - (at - low) / (high - low) * place.height;
    let ticks = Ticks::over(low, high, 5);
    for (&value, label) in ticks.values.iter().zip(&ticks.labels) {
        page.path(&[(place.x, y(value)), (place.x + place.width, y(value))], Ink::Pale, 0.4);
        page.words((place.x - 3.0, y(value) + 2.2), 6.2, Ink::Grey, Anchor::End, label);
    }
    let column = place.width / sheet.traces.len() as f64;
    let half = 0.5 * column - 2.0;
    let sign = if sheet.mirrored { -1.0 } else { 1.0 };
    for (index, trace) in sheet.traces.iter().enumerate() {
        let zero = place.x + column * (index as f64 + 0.5);
        let x = |deviation: f64| zero + sign * (deviation / um * (half / DIVISIONS)).clamp(-half, half);
        for step in -(DIVISIONS as i32)..=(DIVISIONS as i32) {
            let at = zero + f64::from(step) * half / DIVISIONS;
            let (ink, width) = if step == 0 { (Ink::Grey, 0.5) } else { (Ink::Pale, 0.35) };
            page.path(&[(at, place.y), (at, place.y + place.height)], ink, width);
        }
        page.words((zero, place.y - 3.5), 6.4, Ink::Black, Anchor::Middle, &trace.label);
        let points: Vec<(f64, f64)> = trace.points.iter().map(|&(at, value)| (x(value), y(at))).collect();
        page.path(&thinned_upright(&points), Ink::Blue, 0.8);
        if let Some(ends) = trace.mean_line {
            for (at, _) in ends {
                page.dashes(&[(zero - half, y(at)), (zero + half, y(at))], Ink::Grey, 0.5);
            }
            page.path(&ends.map(|(at, value)| (x(value), y(at))), Ink::Red, 0.8);
        }
        figures(page, (zero - half, zero + half), place.y + place.height + 9.0, trace);
    }
    let limits = sheet.traces.first().map_or(&[][..], |trace| &trace.figures);
    for (row, limit) in limits.iter().enumerate().filter_map(|(row, figure)| Some((row, figure.limit?))) {
        let at = (place.x + place.width + 28.0, place.y + place.height + 9.0 + 8.0 * row as f64);
        page.words(at, 6.4, Ink::Grey, Anchor::End, &format!("≤ {}", value_text(limit)));
    }
}

fn figures(page: &mut VectorPage, (from, to): (f64, f64), top: f64, trace: &TraceColumn) {
    for (row, figure) in trace.figures.iter().enumerate() {
        let y = top + 8.0 * row as f64;
        page.words((from, y), FIGURE_EM, Ink::Grey, Anchor::Start, &figure.name);
        let ink = if figure.fails() { Ink::Red } else { Ink::Black };
        page.words((to, y), FIGURE_EM, ink, Anchor::End, &figure.text());
    }
}

/// A rectangle of the page, points.
#[derive(Debug, Clone, Copy)]
struct ChartBox {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

/// A value axis about zero, the same for all charts that are compared.
struct ValueAxis {
    /// Value at the top; its negative is at the bottom.
    reach_um: f64,
    step_um: f64,
}

impl ValueAxis {
    fn over<'a>(values: impl Iterator<Item = &'a f64>) -> Self {
        let largest = values.copied().filter(|value| value.is_finite()).fold(0.0, |most: f64, um| most.max(um.abs()));
        let step_um = round_step((largest / 2.0).max(LEAST_DIVISION_UM));
        let steps = (largest / step_um).ceil().max(2.0);
        Self { reach_um: step_um * steps, step_um }
    }

    fn y(&self, place: ChartBox, value: f64) -> f64 {
        place.y + 10.0 + (place.height - 10.0) * 0.5 * (1.0 - value / self.reach_um)
    }

    fn frame(&self, page: &mut VectorPage, place: ChartBox, title: &str) {
        page.words((place.x, place.y + 4.0), 7.0, Ink::Black, Anchor::Start, title);
        let steps = (self.reach_um / self.step_um).round() as i32;
        for step in -steps..=steps {
            let value = f64::from(step) * self.step_um;
            let (ink, width) = if step == 0 { (Ink::Grey, 0.5) } else { (Ink::Pale, 0.4) };
            page.path(&[(place.x, self.y(place, value)), (place.x + place.width, self.y(place, value))], ink, width);
            let decimals = usize::from(self.step_um < 1.0);
            let at = (place.x - 3.0, self.y(place, value) + 2.0);
            page.words(at, 5.6, Ink::Grey, Anchor::End, &number_text(value, decimals));
        }
    }

    fn bars(&self, page: &mut VectorPage, place: ChartBox, values: &[f64]) {
        let slot = slot(page, place, values);
        for (index, &value) in values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
            let [zero, end] = [0.0, value].map(|value| self.y(place, value));
            let corner = (place.x + slot * (index as f64 + 0.15), zero.min(end));
            page.block(corner, (0.7 * slot, (zero - end).abs()), Ink::Blue);
        }
    }

    fn line(&self, page: &mut VectorPage, place: ChartBox, values: &[f64]) {
        let slot = slot(page, place, values);
        let at = |(index, &value): (usize, &f64)| (place.x + slot * (index as f64 + 0.5), self.y(place, value));
        page.path(&values.iter().enumerate().map(at).collect::<Vec<_>>(), Ink::Blue, 0.9);
    }
}

/// Width of a tooth's place; labels the first and the last tooth, or says that nothing was measured.
fn slot(page: &mut VectorPage, place: ChartBox, values: &[f64]) -> f64 {
    let below = place.y + place.height + 7.0;
    if values.is_empty() {
        page.words((place.x + 4.0, below), 6.0, Ink::Grey, Anchor::Start, "not measured");
        return 0.0;
    }
    let slot = place.width / values.len() as f64;
    for index in [0, values.len() - 1] {
        let x = place.x + slot * (index as f64 + 0.5);
        page.words((x, below), 5.6, Ink::Grey, Anchor::Middle, &format!("{}", index + 1));
    }
    slot
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::report::traces::TraceFigure;

    #[test]
    fn axes_are_equal_left_and_right_and_have_a_floor() {
        let noise = ValueAxis::over([0.02, -0.04].iter());
        assert_eq!((noise.step_um, noise.reach_um), (1.0, 2.0));
        let both = ValueAxis::over([3.0, f64::NAN, -11.0].iter());
        assert_eq!((both.step_um, both.reach_um), (10.0, 20.0));
    }

    /// A round gear's sizes, its figures with Ra and Rz in both directions, and six notes.
    #[test]
    fn the_fullest_sheet_stays_on_its_page() {
        let figure = || TraceFigure { name: "F".to_owned(), value: None, limit: None };
        let trace = || TraceColumn {
            label: String::new(),
            points: Vec::new(),
            mean_line: None,
            figures: vec![figure(), figure(), figure()],
        };
        let sheets = || {
            [false, true].map(|mirrored| TraceSheet {
                title: String::new(),
                place_name: String::new(),
                place_unit: "mm".to_owned(),
                unit: "\u{b5}m".to_owned(),
                mirrored,
                traces: vec![trace()],
            })
        };
        let row = || SheetFigure { cells: std::array::from_fn(|_| String::new()), fails: false };
        let sheet = InspectionSheet {
            title: String::new(),
            subtitle: String::new(),
            program: String::new(),
            sizes: vec![std::array::from_fn(|_| String::new()); 24],
            profiles: sheets(),
            helices: sheets(),
            single_pitch_um: [Vec::new(), Vec::new()],
            cumulative_pitch_um: [Vec::new(), Vec::new()],
            single_pitch_limit_um: None,
            runout_um: Vec::new(),
            figures: (0..13).map(|_| row()).collect(),
            verdict: String::new(),
            fails: false,
            notes: vec![String::new(); 6],
        };
        let mut page = VectorPage::new("");
        let end = sheet.down_to_the_foot(&mut page);
        assert!(end + 11.0 + 5.0 * 8.4 <= A4_PT[1], "the foot begins at {end}");
    }
}
