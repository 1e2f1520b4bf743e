//! How a hobbing machine has to move: axis table, charts like the papers' figures, peaks against limits, marks.
//!
//! In: a prepared [`HobbingJob`]. Out: [`HobbingAxesReport`] with its text for the terminal, and per operation in
//! `axes/`: `<operation>.csv` (even steps of time over the whole operation), `<operation>_velocities` over the polar
//! angle and `<operation>_accelerations` over time, both for one cycle in the middle of the cut (as figures 4 and 5 of
//! Liu et al. 2013 and 5 and 6 of Liu et al. 2015), `<operation>_path` with slide, shift and infeed; before anything is
//! cut also, for the first operation, `<operation>_teeth`: how the hob's teeth share one transverse section. Once the
//! blank is cut, the volumes of all passes say it better ([`super::measure::hob_load`]).

use crate::error::Result;
use crate::findings::{Place, Quantity, Section};
use crate::machine::Peak;
use crate::math::newton::{EVERYWHERE, LastStep, newton_within};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::folder::OutputFolder;
use crate::output::line_chart::{Limit, LineChart, LineSeries, Panel};
use crate::output::progress::duration_text;
use crate::output::table::{Cell, write_table};
use crate::output::text::{Sheet, plain, significant};
use crate::process::hobbing::HobbingJob;
use crate::process::hobbing::job::PreparedHobbing;
use crate::process::hobbing::linkage::peaks::{HobbingPeaks, in_order, peaks};
use crate::process::hobbing::linkage::{HobbingAxes, HobbingLaw};
use crate::process::hobbing::measure::engagement::Engagement;
use crate::process::hobbing::scene::model::{HobbingKind, HobbingOperation, ShiftDirection, ShiftStrategy};
use crate::units::{TURN_RAD, UM_PER_MM};

/// Rows of the axis table per cycle along the pitch curve.
const ROWS_PER_CYCLE: f64 = 360.0;
/// Spacing of the points at which the work of the teeth is shared out, modules.
const ENGAGEMENT_MODULES: f64 = 0.05;
/// Most rows of the axis table; longer operations get wider steps.
const MOST_ROWS: f64 = 50_000.0;
/// Points of a chart.
const CHART_POINTS: u32 = 1440;
/// Speeds and accelerations of standing axes are drawn as zero below this.
const STEADY: f64 = 1e-9;

/// Names and units of the axes in their order.
const AXES: [(&str, &str); 6] = [
    ("hob spindle", "°"),
    ("work spindle", "°"),
    ("X tangential", "mm"),
    ("Y radial", "mm"),
    ("Z slide", "mm"),
    ("shift", "mm"),
];

/// What one operation asks of the machine.
#[derive(Debug)]
pub struct HobbingAxesReport {
    index: usize,
    spec: HobbingOperation,
    law: HobbingLaw,
    hand_letter: char,
    head_angle_rad: f64,
    time_s: f64,
    idle_s: f64,
    cycles: f64,
    passes: f64,
    way: [f64; 3],
    slide_feeds_mm: [f64; 2],
    shift_range_mm: [f64; 2],
    shift_strokes: u32,
    shift_of_resultant_mm: f64,
    feed_mark_mm: f64,
    generating_marks_mm: [f64; 2],
    gash_arc_mm: f64,
    peaks: HobbingPeaks,
}

impl HobbingAxesReport {
    /// Of operation `index` of a job.
    pub fn new(job: &HobbingJob, index: usize) -> Self {
        let PreparedHobbing { spec, plan, linkage, .. } = &job.operations[index];
        let facts = job.curve.facts();
        let tilt = linkage.geometry().head_angle_rad;
        let shift_mm = match spec.kind {
            HobbingKind::Diagonal { shift_mm_per_revolution, .. } => shift_mm_per_revolution,
            HobbingKind::Plain { .. } => 0.0,
        };
        Self {
            index,
            spec: spec.clone(),
            law: linkage.law(),
            hand_letter: if linkage.geometry().gear_hand > 0.0 { 'R' } else { 'L' },
            head_angle_rad: tilt,
            time_s: linkage.end_s(),
            idle_s: plan.idle_s,
            cycles: linkage.end_s() / linkage.cycle_s(),
            passes: job.passes(&job.operations[index]),
            way: [plan.approach_mm, job.scene.gear.face_width_mm, plan.overrun_mm],
            slide_feeds_mm: plan.slide_feeds_mm,
            shift_range_mm: plan.shift_range_mm,
            shift_strokes: plan.shift_strokes,
            shift_of_resultant_mm: shift_mm * tilt.sin().abs(),
            feed_mark_mm: plan.feed_mark_mm,
            generating_marks_mm: [facts.smallest_curvature, facts.largest_curvature]
                .map(|e| job.generating_mark_mm(e.curvature_per_mm)),
            gash_arc_mm: job.gash_arc_mm(),
            peaks: peaks(linkage, &job.limits),
        }
    }

    /// Of all operations of a job, in order.
    pub fn of_job(job: &HobbingJob) -> Vec<Self> {
        (0..job.operations.len()).map(|index| Self::new(job, index)).collect()
    }

    /// Name of the operation.
    pub fn name(&self) -> &str {
        &self.spec.name
    }

    /// Linkage in words.
    pub fn words(&self) -> String {
        let printed = if self.law.is_as_printed() { ", as printed" } else { "" };
        match self.spec.kind {
            HobbingKind::Plain { .. } => format!("five axes, scheme {}{printed}", self.law.scheme()),
            HobbingKind::Diagonal { direction, strategy, .. } => {
                let letter = if direction == ShiftDirection::Adds { 'U' } else { 'V' };
                let strategy = match strategy {
                    ShiftStrategy::OneWay => "one way",
                    ShiftStrategy::Repeating { .. } => "repeating",
                    ShiftStrategy::Reciprocating => "reciprocating",
                };
                format!("six axes, diagonal, condition {letter}{}, {strategy} shift{printed}", self.hand_letter)
            }
        }
    }

    /// Feeds, ways, times, marks and the table of peaks.
    pub fn print(&self, sheet: &mut Sheet) {
        let spec = &self.spec;
        sheet.heading(&format!("Operation {}: {}, offset {} mm", spec.name, self.words(), plain(spec.offset_mm)));
        let hob_speed = spec.hob_speed_rad_per_s / TURN_RAD * 60.0;
        sheet.line("hob speed", format!("{} 1/min, mean of a cycle", significant(hob_speed, 5)));
        sheet.line("head angle", format!("{:.4} deg", self.head_angle_rad.to_degrees()));
        let [first, second] = self.slide_feeds_mm;
        let feeds = if (first - second).abs() < 1e-9 {
            significant(first, 4)
        } else {
            format!("{} and, the shift reversed, {}", significant(first, 4), significant(second, 4))
        };
        sheet.line("feed of the slide", format!("{feeds} mm per revolution of the work"));
        let [approach, face, overrun] = self.way;
        sheet.line(
            "way of the slide",
            format!("{approach:.3} mm before the face, {face:.3} across, {overrun:.3} beyond"),
        );
        if let HobbingKind::Diagonal { shift_mm_per_revolution, .. } = spec.kind {
            let [from, to] = self.shift_range_mm;
            sheet.line(
                "shift",
                format!(
                    "{} mm per revolution between {from:.3} and {to:.3} mm, {} strokes; {} mm of it along the gear's \
                    axis",
                    significant(shift_mm_per_revolution, 4),
                    self.shift_strokes,
                    significant(self.shift_of_resultant_mm, 3)
                ),
            );
        }
        let idle =
            if self.idle_s > 0.0 { format!(", {} of it idle", duration_text(self.idle_s)) } else { String::new() };
        sheet.line(
            "time",
            format!("{}{idle}; {:.2} cycles along the pitch curve", duration_text(self.time_s), self.cycles),
        );
        sheet.line("passes", format!("{:.0} of hob teeth", self.passes));
        sheet.line("feed marks", format!("up to {} um high", significant(UM_PER_MM * self.feed_mark_mm, 3)));
        let [flat, sharp] = self.generating_marks_mm.map(|mark| significant(UM_PER_MM * mark, 3));
        sheet.line(
            "generating marks",
            format!(
                "{flat} um where the curve is flattest, {sharp} um where it is sharpest, one every {:.4} mm of arc",
                self.gash_arc_mm
            ),
        );
        sheet.table(&self.peak_rows());
    }

    /// Peaks of the axes against their limits: a row of titles, then one per axis.
    pub fn peak_rows(&self) -> Vec<Vec<String>> {
        let titles = ["axis", "largest", "at", "limit", "left"].map(str::to_owned).to_vec();
        let rows = self.named_peaks().map(|(name, unit, peak)| {
            let text = |value: f64| format!("{} {unit}", significant(shown(value, unit), 4));
            let limit = peak.limit.map_or_else(|| "not given".to_owned(), text);
            let left = peak.margin().map_or_else(String::new, |share| format!("{:.0} %", 100.0 * share));
            vec![name, text(peak.value), format!("{:.3} s", peak.stroke), limit, left]
        });
        [titles].into_iter().chain(rows).collect()
    }

    /// Speeds, then accelerations, with names and units; slide and shift have constant feeds and no acceleration.
    fn named_peaks(&self) -> impl Iterator<Item = (String, &'static str, &Peak)> {
        let unit = |unit: &str, speed: bool| match (unit, speed) {
            ("°", true) => "deg/s",
            ("°", false) => "deg/s^2",
            (_, true) => "mm/s",
            (_, false) => "mm/s^2",
        };
        let speeds = AXES.iter().zip(&self.peaks.speeds);
        let speeds = speeds.map(move |((name, u), peak)| (format!("{name} speed"), unit(u, true), peak));
        let accelerations = AXES.iter().zip(&self.peaks.accelerations).take(4);
        speeds.chain(accelerations.map(move |((name, u), peak)| (format!("{name} acceleration"), unit(u, false), peak)))
    }

    /// What is left of the tightest limit, as a share of it; `None` without limits.
    pub fn smallest_margin(&self) -> Option<f64> {
        self.named_peaks().filter_map(|(.., peak)| peak.margin()).min_by(f64::total_cmp)
    }

    /// Peaks against limits, by axis.
    pub fn axes_findings(&self) -> Section {
        let one = |(axis, unit, peak): (String, &'static str, &Peak)| {
            let unlimited = "machine.limits gives none for this axis";
            let at = Place::default().and("time_s", peak.stroke);
            Section::new(axis.to_lowercase().replace(' ', "_"), axis.clone())
                .with(
                    "peak",
                    Quantity::number(
                        shown(peak.value, unit),
                        unit,
                        format!("largest {axis} during the operation; its time counts from the operation's start"),
                    )
                    .at(at),
                )
                .with(
                    "limit",
                    Quantity::number_or(
                        peak.limit.map(|limit| shown(limit, unit)),
                        unit,
                        format!("largest {axis} that the machine allows"),
                        unlimited,
                    ),
                )
                .with("margin", Quantity::number_or(peak.margin(), "1", "1 - peak / limit", unlimited))
        };
        Section::new("axes", "Peaks of the axes").parts(self.named_peaks().map(one))
    }

    /// What the user should know before cutting.
    pub fn warnings(&self) -> Vec<String> {
        let name = &self.spec.name;
        let mut warnings: Vec<String> = self
            .named_peaks()
            .filter_map(|(axis, unit, peak)| {
                let limit = peak.limit.filter(|limit| peak.value > *limit)?;
                let text = |value: f64| significant(shown(value, unit), 4);
                Some(format!(
                    "operation {name}: the {axis} reaches {} {unit}, the machine allows {} {unit}: lower \
                    hob_speed_per_minute, or take another even_motion",
                    text(peak.value),
                    text(limit)
                ))
            })
            .collect();
        if self.feed_mark_mm > self.spec.ridge_tolerance_mm {
            let ratio = (self.spec.ridge_tolerance_mm / self.feed_mark_mm).sqrt();
            warnings.push(format!(
                "operation {name}: the feed leaves marks up to {} um high, {} um are allowed (ridge_tolerance_um): \
                feed at most {} mm per revolution",
                significant(UM_PER_MM * self.feed_mark_mm, 3),
                significant(UM_PER_MM * self.spec.ridge_tolerance_mm, 3),
                significant(ratio * self.spec.axial_feed_mm_per_revolution, 3)
            ));
        }
        if self.law.is_as_printed() {
            warnings.push(format!(
                "operation {name}: the linkage is the one printed in the paper; work and carriage part on a curve that \
                is no circle, and no G-code is written"
            ));
        }
        warnings
    }

    /// Writes table and charts into the folder's `axes/`.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write(&self, job: &HobbingJob, folder: &OutputFolder) -> Result<()> {
        let operation = &job.operations[self.index];
        let name = &self.spec.name;
        let linkage = &operation.linkage;
        let count = (self.cycles * ROWS_PER_CYCLE).ceil().clamp(1.0, MOST_ROWS) as u32;
        let rows = (0..=count).map(|i| {
            let t = self.time_s * f64::from(i) / f64::from(count);
            cells(t, &linkage.axes::<3>(t))
        });
        write_table(&folder.path(format!("axes/{name}.csv"))?, &COLUMNS, rows)?;
        for (what, chart) in self.charts(job) {
            chart.write_png(&folder.path(format!("axes/{name}_{what}.png"))?)?;
            chart.write_svg(&folder.path(format!("axes/{name}_{what}.svg"))?)?;
        }
        Ok(())
    }

    /// Writes how the hob's teeth share the first operation's work, as far as it can be told before anything is cut;
    /// nothing for later operations.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write_work_of_teeth(&self, job: &HobbingJob, folder: &OutputFolder) -> Result<()> {
        if let Some(chart) = self.work_of_teeth(job) {
            chart.write_png(&folder.path(format!("axes/{}_teeth.png", self.spec.name))?)?;
            chart.write_svg(&folder.path(format!("axes/{}_teeth.svg", self.spec.name))?)?;
        }
        Ok(())
    }

    /// Velocities, accelerations and the feed path, each with the word that ends its file name.
    pub fn charts(&self, job: &HobbingJob) -> [(&'static str, LineChart); 3] {
        let operation = &job.operations[self.index];
        [
            ("velocities", self.velocities(job, operation)),
            ("accelerations", self.accelerations(job, operation)),
            ("path", self.path(job, operation)),
        ]
    }

    /// Share of the first operation's work on every hob tooth: one space in the middle of the face stands for all; none
    /// for later operations.
    fn work_of_teeth(&self, job: &HobbingJob) -> Option<BarChart> {
        let operation = job.operations.first().filter(|_| self.index == 0)?;
        let module_mm = job.scene.gear.module_mm;
        let depth_mm = job.hob.tip_radius_mm - job.hob.pitch_radius_mm;
        let grid = [depth_mm, job.blank.addendum_mm, ENGAGEMENT_MODULES * module_mm];
        let work = Engagement::of_space(&operation.linkage, &job.target, &job.hob, 0, 0.0, grid);
        let numbered = job.hob.teeth.iter().filter(|tooth| tooth.start == 0);
        let (categories, values) =
            numbered.map(|tooth| (tooth.number.to_string(), Some(100.0 * work.share(tooth.passage)))).unzip();
        Some(BarChart {
            least_division: 0.0,
            title: format!(
                "{} of {}: area that each hob tooth takes, space 0 ({})",
                self.spec.name,
                job.scene.name,
                self.words()
            ),
            category_name: "hob tooth along the thread".to_owned(),
            categories,
            value_name: "share of the space".to_owned(),
            unit: "%".to_owned(),
            series: vec![BarSeries { name: "all starts".to_owned(), values }],
        })
    }

    fn chart(&self, job: &HobbingJob, what: &str, x: [&str; 2], panels: Vec<Panel>) -> LineChart {
        LineChart {
            title: format!("{} of {}: {what} ({})", self.spec.name, job.scene.name, self.words()),
            x_name: x[0].to_owned(),
            x_unit: x[1].to_owned(),
            panels,
        }
    }

    /// One cycle in the middle of the longest stretch.
    fn cycle(operation: &PreparedHobbing) -> Vec<(f64, HobbingAxes<3>)> {
        let linkage = &operation.linkage;
        let corners = linkage.corners_s();
        let longest = corners.windows(2).max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
        let [from, to] = longest.map_or([0.0, 1.0], |c| [c[0], c[1]]);
        // From where a cycle begins, if the stretch holds a whole one.
        let middle = (0.5 * (from + to - linkage.cycle_s())).max(from);
        let turn = (linkage.axes::<1>(middle).polar_rad.value() / TURN_RAD).ceil();
        let start = polar_time(operation, turn * TURN_RAD, middle);
        let end = polar_time(operation, (turn + 1.0) * TURN_RAD, start + linkage.cycle_s());
        (0..=CHART_POINTS)
            .map(|i| {
                let t = start + (end - start) * f64::from(i) / f64::from(CHART_POINTS);
                (t, linkage.axes::<3>(t))
            })
            .collect()
    }

    fn velocities(&self, job: &HobbingJob, operation: &PreparedHobbing) -> LineChart {
        let cycle = Self::cycle(operation);
        let turn = cycle.first().map_or(0.0, |(_, axes)| axes.polar_rad.value());
        let x = |axes: &HobbingAxes<3>| (axes.polar_rad.value() - turn).to_degrees();
        let panels = self.moving(&cycle, 1, |_, axes| x(axes), &job.limits.speeds, "speed", "/s");
        self.chart(job, "axis velocities", ["polar angle of the pitch point", "°"], panels)
    }

    fn accelerations(&self, job: &HobbingJob, operation: &PreparedHobbing) -> LineChart {
        let cycle = Self::cycle(operation);
        let start = cycle.first().map_or(0.0, |(t, _)| *t);
        let panels = self.moving(&cycle, 2, |t, _| t - start, &job.limits.accelerations, "acceleration", "/s²");
        self.chart(job, "axis accelerations", ["time within the cycle", "s"], panels)
    }

    fn moving(
        &self,
        cycle: &[(f64, HobbingAxes<3>)],
        order: usize,
        x: impl Fn(f64, &HobbingAxes<3>) -> f64,
        limits: &[Option<f64>; 6],
        what: &str,
        per: &str,
    ) -> Vec<Panel> {
        let shown_axes = match (order, self.spec.kind) {
            (1, HobbingKind::Diagonal { .. }) => 6,
            (1, HobbingKind::Plain { .. }) => 5,
            _ => 4,
        };
        (0..shown_axes)
            .map(|axis| {
                let (name, unit) = AXES[axis];
                let in_unit = |value: f64| if unit == "°" { value.to_degrees() } else { value };
                let points = cycle
                    .iter()
                    .map(|(t, axes)| {
                        let value = in_unit(in_order(axes)[axis].derivative(order));
                        (x(*t, axes), (value / STEADY).round() * STEADY)
                    })
                    .collect();
                let limits = limits[axis].map(in_unit).into_iter();
                let limits = limits.flat_map(|l| [l, -l]).map(|value| Limit { name: "limit".to_owned(), value });
                Panel {
                    least_division: 0.0,
                    value_name: what.to_owned(),
                    unit: format!("{unit}{per}"),
                    series: vec![LineSeries { name: name.to_owned(), points }],
                    limits: limits.collect(),
                }
            })
            .collect()
    }

    fn path(&self, job: &HobbingJob, operation: &PreparedHobbing) -> LineChart {
        let linkage = &operation.linkage;
        // Feeds are constant between corners: both sides of each corner draw the path exactly.
        let times: Vec<f64> = linkage.corners_s();
        let panel = |name: &str, value: fn(&HobbingAxes<1>) -> f64| Panel {
            least_division: 0.0,
            value_name: name.to_owned(),
            unit: "mm".to_owned(),
            series: vec![LineSeries {
                name: name.to_owned(),
                points: times.iter().map(|&t| (t, value(&linkage.axes::<1>(t)))).collect(),
            }],
            limits: vec![],
        };
        let panels = vec![
            panel("Z slide", |axes| axes.slide_mm.value()),
            panel("shift", |axes| axes.shift_mm.value()),
            panel("back from full depth", |axes| axes.radial_mm.value()),
        ];
        self.chart(job, "feed path", ["time", "s"], panels)
    }
}

/// Time near `guess_s` at which the pitch point has the polar angle `polar_rad`.
fn polar_time(operation: &PreparedHobbing, polar_rad: f64, guess_s: f64) -> f64 {
    newton_within(guess_s, EVERYWHERE, LastStep::relative(1e-12), 50, |time_s| {
        let polar = operation.linkage.axes::<2>(time_s).polar_rad;
        let missing_rad = polar_rad - polar.value();
        [missing_rad, missing_rad / polar.derivative(1)]
    })
}

/// A value in the unit that is printed; rounding of a standing axis reads as zero.
fn shown(value: f64, unit: &str) -> f64 {
    let value = if unit.starts_with("deg") { value.to_degrees() } else { value };
    if value.abs() < STEADY { 0.0 } else { value }
}

/// Columns with their units; angles run on beyond a turn.
const COLUMNS: [&str; 18] = [
    "time_s",
    "polar_angle_deg",
    "hob_deg",
    "work_deg",
    "x_mm",
    "y_mm",
    "slide_mm",
    "shift_mm",
    "hob_speed_deg_per_s",
    "work_speed_deg_per_s",
    "x_speed_mm_per_s",
    "y_speed_mm_per_s",
    "slide_speed_mm_per_s",
    "shift_speed_mm_per_s",
    "hob_acceleration_deg_per_s2",
    "work_acceleration_deg_per_s2",
    "x_acceleration_mm_per_s2",
    "y_acceleration_mm_per_s2",
];

fn cells(time_s: f64, axes: &HobbingAxes<3>) -> Vec<Cell> {
    let all = in_order(axes);
    let order = |k: usize| {
        all.into_iter().enumerate().map(move |(axis, series)| {
            let value = series.derivative(k);
            if axis < 2 { value.to_degrees() } else { value }
        })
    };
    let numbers = [time_s, axes.polar_rad.value().to_degrees()].into_iter();
    numbers.chain(order(0)).chain(order(1)).chain(order(2).take(4)).map(Cell::Number).collect()
}
