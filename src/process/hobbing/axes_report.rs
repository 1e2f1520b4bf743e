//! How a hobbing machine has to move: what hobbing adds to the axes' tables, charts and peaks.
//!
//! In: a prepared [`HobbingJob`]. Out: [`HobbingAxesReport`] for the shared steps ([`crate::steps::axes`]): feeds,
//! travel, times and marks for the terminal, and in `axes/` per operation `<operation>.csv` (even steps of time over
//! the whole operation), `<operation>_velocities` over the polar angle and `<operation>_accelerations` over time, both
//! for one cycle in the middle of the cut (as figures 4 and 5 of Liu et al. 2013 and 5 and 6 of Liu et al. 2015),
//! `<operation>_path` with slide, shift and infeed; before anything is cut also, for the first operation,
//! `<operation>_teeth`: how the hob's teeth share one transverse section. Once the blank is cut, the volumes of all
//! passes say it better ([`super::measure::hob_load`]).

mod charts;
mod facts;

use super::gcode;
use crate::findings::quantities::cutting::TIME;
use crate::findings::{Notice, Table};
use crate::machine::{Peak, peaks};
use crate::measure::round_gear::is_round;
use crate::number_text::significant;
use crate::output::bar_chart::BarChart;
use crate::output::line_chart::LineChart;
use crate::output::text::Sheet;
use crate::process::hobbing::HobbingJob;
use crate::process::hobbing::job::PreparedHobbing;
use crate::process::hobbing::linkage::dynamics::{self, AXES};
use crate::process::hobbing::notices::{AsPrinted, FeedMarks, ShortOverrun, StartsInside};
use crate::process::hobbing::quantities::POLAR_ANGLE;
use crate::process::hobbing::scene::model::{Approach, HobbingKind, ShiftDirection, ShiftStrategy};
use crate::steps::axes::{self, AxesOfOperation, Named, NamedChart, PeakWords, STEADY};
use crate::steps::program_under_test::ProgramUnderTest;
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;
use std::sync::OnceLock;

/// Rows of the axis table per cycle along the pitch curve.
const ROWS_PER_CYCLE: f64 = 360.0;
/// Most rows of the axis table; longer operations get wider steps.
const MOST_ROWS: f64 = 50_000.0;

/// Travels that are short by less are rounding, mm.
const LEAST_MM: f64 = 1e-6;

/// How hobbing speaks of peaks.
const PEAK_WORDS: PeakWords = PeakWords {
    at: "at",
    place: "time_s",
    place_unit: ("s", 3),
    place_note: "; its time counts from the operation's start",
    way_out: "lower hob_speed_per_minute, or take another even_motion",
    named,
    zero_below: STEADY,
};

/// What one operation asks of the machine.
#[derive(Debug)]
pub struct HobbingAxesReport<'a> {
    job: &'a HobbingJob,
    index: usize,
    peaks: Vec<Peak>,
    /// The program under test, if one is cut.
    program: Option<ProgramUnderTest>,
    /// Charts for folder and page, drawn once.
    charts: OnceLock<[NamedChart<LineChart>; 3]>,
}

impl<'a> HobbingAxesReport<'a> {
    /// Of operation `index` of a job.
    pub fn new(job: &'a HobbingJob, index: usize) -> Self {
        let mut peaks = peaks(&job.operations[index].linkage, &dynamics::limits(&job.limits));
        // Speeds of all axes first.
        peaks.sort_by_key(|peak| peak.order);
        let program = gcode::judged(job, &job.operations[index]);
        Self { job, index, peaks, program, charts: OnceLock::new() }
    }

    /// Of all operations of a job, in order.
    pub fn of_job(job: &'a HobbingJob) -> Vec<Self> {
        (0..job.operations.len()).map(|index| Self::new(job, index)).collect()
    }

    /// Whether the hob is in the blank at depth where the slide begins.
    fn starts_inside(&self) -> bool {
        let PreparedHobbing { spec, plan, .. } = self.operation();
        let is_axial = matches!(spec.approach, Approach::Axial);
        is_axial && self.program.is_none() && plan.approach_mm < plan.clear_mm - LEAST_MM
    }

    /// The program under test against the scene's own motion, if one is cut.
    pub fn program(&self) -> Option<&ProgramUnderTest> {
        self.program.as_ref()
    }

    fn operation(&self) -> &'a PreparedHobbing {
        &self.job.operations[self.index]
    }
}

impl AxesOfOperation for HobbingAxesReport<'_> {
    fn name(&self) -> &str {
        &self.operation().spec.name
    }

    fn linkage_words(&self) -> String {
        linkage_words(self.operation())
    }

    fn peak_words(&self) -> &PeakWords {
        &PEAK_WORDS
    }

    fn peaks(&self) -> &[Peak] {
        &self.peaks
    }

    fn place(&self, peak: &Peak) -> f64 {
        peak.at
    }

    fn print_facts(&self, sheet: &mut Sheet) {
        facts::print(self, sheet);
    }

    /// Feed marks above what is allowed, and a linkage that is for comparison only.
    fn own_warnings(&self) -> Vec<Notice> {
        let PreparedHobbing { spec, linkage, .. } = self.operation();
        let name = &spec.name;
        let mut warnings = Vec::new();
        let feed_mark_mm = self.job.feed_mark_mm(self.operation());
        if let Some(feed_mark_mm) = feed_mark_mm.filter(|&mm| mm > spec.ridge_tolerance_mm) {
            let ratio = (spec.ridge_tolerance_mm / feed_mark_mm).sqrt();
            let [height_um, allowed_um, feed_mm] = [
                UM_PER_MM * feed_mark_mm,
                UM_PER_MM * spec.ridge_tolerance_mm,
                ratio * spec.axial_feed_mm_per_revolution,
            ]
            .map(|value| significant(value, 3));
            warnings.push(FeedMarks { operation: name, height_um, allowed_um, feed_mm }.notice());
        }
        if linkage.law().is_as_printed() {
            warnings.push(AsPrinted { operation: name }.notice());
        }
        let plan = &self.operation().plan;
        if self.starts_inside() {
            let [approach_mm, clear_mm] = [plan.approach_mm, plan.clear_mm].map(|mm| significant(mm, 4));
            let starts = StartsInside { operation: name, approach_mm, clear_mm }.notice();
            warnings.push(starts.fault_where(is_round(&self.job.curve)));
        }
        if self.program.is_none() && plan.overrun_mm < plan.leaves_mm - LEAST_MM {
            let [overrun_mm, leaves_mm] = [plan.overrun_mm, plan.leaves_mm].map(|mm| significant(mm, 4));
            warnings.push(ShortOverrun { operation: name, overrun_mm, leaves_mm }.notice());
        }
        let (asked_mm, module_mm) = (self.job.scene.output.gcode_contour_error_mm, self.job.scene.gear.module_mm);
        warnings.extend(self.program.iter().flat_map(|program| program.warnings(name, asked_mm, module_mm)));
        warnings
    }

    fn table(&self) -> Table {
        let linkage = &self.operation().linkage;
        let cycles = linkage.end_s() / linkage.cycle_s();
        let count = (cycles * ROWS_PER_CYCLE).ceil().clamp(1.0, MOST_ROWS) as u32;
        let rows = (0..=count).map(|i| {
            let time_s = linkage.end_s() * f64::from(i) / f64::from(count);
            let axes = linkage.axes(time_s);
            (time_s, axes.polar_rad.value().to_degrees(), dynamics::motion(&axes))
        });
        let table = Table::over("axes", "Axes", rows).column(&TIME, |row| row.0).column(&POLAR_ANGLE, |row| row.1);
        axes::rates(axes::positions(table, &AXES, |row| &row.2), &AXES, |row| &row.2).into()
    }

    fn charts(&self) -> &[NamedChart<LineChart>] {
        self.charts.get_or_init(|| charts::all(self.job, self.operation()))
    }

    /// How the hob's teeth share the first operation's work, as far as it can be told before anything is cut.
    fn forecasts(&self) -> Result<Vec<NamedChart<BarChart>>> {
        if self.index > 0 {
            return Ok(Vec::new());
        }
        Ok(vec![("teeth", charts::work_of_teeth(self.job, self.operation())?)])
    }

    fn programs(&self, warnings: &[Notice]) -> Option<Result<Vec<(String, String)>, String>> {
        let programs = gcode::texts(self.job, self.operation(), warnings)?;
        if self.starts_inside() {
            return Some(Err("its first position lies inside the blank".to_owned()));
        }
        let (post, name) = (self.job.scene.output.post, self.name());
        let numbers = gcode::program_numbers(self.index);
        let files = [name.to_owned(), format!("{name}_gearbox")];
        let named = |texts: [String; 2]| {
            files
                .iter()
                .zip(numbers)
                .zip(texts)
                .map(|((file, number), text)| (post.file_name(file, number), text))
                .collect()
        };
        Some(programs.map(named))
    }
}

fn named(peak: &Peak) -> Named {
    let name = peak.name();
    Named {
        key: name.to_lowercase().replace(' ', "_"),
        title: name,
        unlimited: "machine.hobbing_limits gives none for this axis".to_owned(),
    }
}

/// The linkage in words.
pub fn linkage_words(operation: &PreparedHobbing) -> String {
    let law = operation.linkage.law();
    let printed = if law.is_as_printed() { ", as printed" } else { "" };
    match operation.spec.kind {
        HobbingKind::Plain { .. } => format!("five axes, scheme {}{printed}", law.scheme()),
        HobbingKind::Diagonal { direction, strategy, .. } => {
            let letter = if direction == ShiftDirection::Adds { 'U' } else { 'V' };
            let hand = if operation.linkage.geometry().gear_hand > 0.0 { 'R' } else { 'L' };
            let strategy = match strategy {
                ShiftStrategy::OneWay => "one way",
                ShiftStrategy::Repeating { .. } => "repeating",
                ShiftStrategy::Reciprocating => "reciprocating",
            };
            format!("six axes, diagonal, condition {letter}{hand}, {strategy} shift{printed}")
        }
    }
}
