//! How the six-axis machine has to move: what bevel cutting adds to the axes' tables, charts and peaks.
//!
//! In: a prepared [`BevelJob`]. Out: [`BevelAxesReport`] for the shared steps ([`crate::steps::axes`]): roll or plunge,
//! times and marks for the terminal, per operation `<operation>.csv` over one slot's motion, charts of positions and
//! speeds, how well polynomials follow the axes ([`BevelAxesReport::fits`]), and the program.

use super::gcode;
use super::job::BevelJob;
use super::measure;
use super::motion::{AXES, SlotMotion, limits};
use super::operation::PreparedBevel;
use super::quantities::CRADLE_ANGLE;
use super::scene::model::SlotFeed;
use crate::findings::quantities::cutting::TIME;
use crate::findings::{Notice, Table};
use crate::machine::{Axis, Motion as _, Order, Peak, peaks};
use crate::number_text::{from_full_depth, plain, significant};
use crate::output::line_chart::LineChart;
use crate::output::text::Sheet;
use crate::progress::duration_text;
use crate::steps::axes::charts::{chart, panels};
use crate::steps::axes::{self, AxesOfOperation, Named, NamedChart, PeakWords, STEADY};
use crate::steps::program_under_test::ProgramUnderTest;
use gearcut_core::error::Result;
use gearcut_core::math::least_squares::WindowFit;
use gearcut_core::terms::Side;
use gearcut_core::units::{TURN_RAD, UM_PER_MM};
use std::sync::OnceLock;

/// Rows of the axis table.
const ROWS: u32 = 720;
/// Orders of the polynomials that are fitted to the axes.
const ORDERS: [usize; 3] = [4, 6, 8];
/// Samples of a fit.
const FIT_SAMPLES: usize = 2001;

/// How bevel cutting speaks of peaks, of a roll and of a plunge.
const PEAK_WORDS: [PeakWords; 2] =
    [peak_words("lower roll_speed_deg_per_s"), peak_words("lower infeed_mm_per_revolution")];

const fn peak_words(way_out: &'static str) -> PeakWords {
    PeakWords {
        at: "at",
        place: "time_s",
        place_unit: ("s", 3),
        place_note: "; its time counts from the beginning of a slot",
        way_out,
        named,
        zero_below: STEADY,
    }
}

/// What one operation asks of the machine.
#[derive(Debug)]
pub struct BevelAxesReport<'a> {
    job: &'a BevelJob,
    operation: &'a PreparedBevel,
    peaks: Vec<Peak>,
    program: Option<ProgramUnderTest>,
    charts: OnceLock<[NamedChart<LineChart>; 2]>,
}

/// A polynomial of one axis over one slot's roll.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisFit {
    /// Letter of the axis.
    pub letter: char,
    /// Its order.
    pub order: usize,
    /// The polynomial over time, s, in the axis's unit as it is read.
    pub fit: WindowFit,
}

impl<'a> BevelAxesReport<'a> {
    /// Of all operations of a job, in order.
    pub fn of_job(job: &'a BevelJob) -> Vec<Self> {
        let one = |operation: &'a PreparedBevel| {
            let mut peaks = peaks(&SlotMotion { job, operation }, &limits(job));
            // Speeds of all axes first.
            peaks.sort_by_key(|peak| peak.order);
            Self { job, operation, peaks, program: gcode::judged(job, operation), charts: OnceLock::new() }
        };
        job.operations.iter().map(one).collect()
    }

    fn motion(&self) -> SlotMotion<'a> {
        SlotMotion { job: self.job, operation: self.operation }
    }

    /// The program under test against the scene's own motion, if one is cut.
    pub fn program(&self) -> Option<&ProgramUnderTest> {
        self.program.as_ref()
    }

    /// The operation.
    pub fn operation(&self) -> &'a PreparedBevel {
        self.operation
    }

    /// Polynomials that follow the moving axes over one slot's roll, with their largest errors: the five-linkage paper
    /// fits order 4 over a whole turn of the work, which is millimetres off where the flank is cut. None of a plunge.
    ///
    /// # Errors
    /// None that a roll of any length gives.
    pub fn fits(&self) -> Result<Vec<AxisFit>> {
        let motion = self.motion();
        let mut found = Vec::new();
        if self.operation.settings.plunges() {
            return Ok(found);
        }
        let all_move = !self.operation.settings.tilt.is_none();
        let moves = |axis: &Axis| all_move || matches!(axis.letter, 'X' | 'Y' | 'A');
        for (index, axis) in AXES.iter().enumerate().filter(|(_, axis)| moves(axis)) {
            for order in ORDERS {
                let value = |time_s: f64| axis.kind.shown(motion.positions(time_s)[index]);
                let fit = WindowFit::new(value, [0.0, self.operation.course.slot_s()], order, FIT_SAMPLES)?;
                found.push(AxisFit { letter: axis.letter, order, fit });
            }
        }
        Ok(found)
    }

    fn drawn(&self) -> [NamedChart<LineChart>; 2] {
        let motion = self.motion();
        let slot_s = self.operation.course.slot_s();
        let points: Vec<_> = (0..=ROWS)
            .map(|i| slot_s * f64::from(i) / f64::from(ROWS))
            .map(|time_s| (time_s, motion.at(time_s)))
            .collect();
        let linkage = self.linkage_words();
        let words = [self.operation.spec.name.as_str(), &self.job.scene.name, &linkage];
        [(Order::Position, "positions"), (Order::Speed, "velocities")].map(|(order, name)| {
            // B rests unless the head is tilted.
            let shown = AXES.len() - usize::from(self.operation.settings.tilt.is_none());
            let panels = panels(&AXES, 0..shown, &limits(self.job), order, &points);
            (
                name,
                chart(
                    words,
                    &format!("axis {name} over one slot"),
                    ["time from the beginning of the slot", "s"],
                    panels,
                ),
            )
        })
    }
}

impl AxesOfOperation for BevelAxesReport<'_> {
    fn name(&self) -> &str {
        &self.operation.spec.name
    }

    fn linkage_words(&self) -> String {
        let roll = self.operation.settings.roll;
        if self.operation.settings.plunges() {
            return "six axes, plunged along Z".to_owned();
        }
        let modified = roll.second_order_per_rad != 0.0 || roll.third_order_per_rad2 != 0.0;
        let head = if self.operation.settings.tilt.is_none() { "" } else { "tilted head, " };
        format!("six axes, five linked, {head}{} roll", if modified { "modified" } else { "even" })
    }

    fn peak_words(&self) -> &PeakWords {
        &PEAK_WORDS[usize::from(self.operation.settings.plunges())]
    }

    fn peaks(&self) -> &[Peak] {
        &self.peaks
    }

    fn place(&self, peak: &Peak) -> f64 {
        peak.at
    }

    fn print_facts(&self, sheet: &mut Sheet) {
        let (job, operation) = (self.job, self.operation);
        let spec = &operation.spec;
        sheet.heading(&format!(
            "Operation {}: {}, {}",
            spec.name,
            self.linkage_words(),
            from_full_depth(spec.offset_mm)
        ));
        if let Some(program) = &operation.program {
            let knots = program.knots.len();
            sheet.line("program", format!("{knots} positions are cut; tables, charts and peaks are the scene's own"));
        }
        let speed = spec.head_speed_rad_per_s / TURN_RAD * 60.0;
        let cutting_m_per_min = TURN_RAD * job.head.radius_mm * speed / 1e3;
        sheet.line("head", format!("{} 1/min, {} m/min", significant(speed, 5), significant(cutting_m_per_min, 4)));
        match spec.feed {
            SlotFeed::Roll { rad_per_s, .. } => {
                let [from, to] = operation.course.range.map(f64::to_degrees);
                let speed = plain(rad_per_s.to_degrees());
                sheet.line("roll", format!("cradle from {from:.3} to {to:.3} deg at {speed} deg/s"));
                let [need_from, need_to] = job.needed_rad.map(f64::to_degrees);
                let idle = 100.0 * idle_share(job, operation).unwrap_or_default();
                sheet.line(
                    "flanks need",
                    format!("{need_from:.3} to {need_to:.3} deg; {idle:.0} % of the roll is idle"),
                );
            }
            SlotFeed::Plunge { mm_per_turn, dwell_revolutions } => {
                let (way_mm, infeed) = (-operation.course.range[0], significant(mm_per_turn, 4));
                sheet.line("plunge", format!("{way_mm:.3} mm along Z, {infeed} mm for each turn of the head"));
                let dwell_s = operation.course.dwell_s;
                sheet.line("dwell", format!("{} turns at full depth, {dwell_s:.3} s", plain(dwell_revolutions)));
            }
        }
        let teeth = f64::from(job.blank.teeth);
        sheet.line(
            "time",
            format!(
                "{} for {} slots, {} of it between slots",
                duration_text(teeth * operation.cycle_s()),
                job.blank.teeth,
                duration_text(teeth * spec.idle_s)
            ),
        );
        for side in [Side::Left, Side::Right] {
            if let Ok(Some(marks)) = measure::marks(job, side) {
                let words = format!(
                    "{} um high, {} mm apart, of the {} blades",
                    significant(UM_PER_MM * marks.height_mm, 3),
                    significant(marks.spacing_mm, 3),
                    job.kind_of(side).name()
                );
                sheet.line(&format!("marks on {} flanks", side.name()), words);
            }
        }
    }

    fn own_warnings(&self) -> Vec<Notice> {
        let (asked_mm, module_mm) = (self.job.scene.output.gcode_contour_error_mm, self.job.scene.gear.module_mm);
        let told = |program: &ProgramUnderTest| program.warnings(&self.operation.spec.name, asked_mm, module_mm);
        self.program.as_ref().map(told).unwrap_or_default()
    }

    fn table(&self) -> Table {
        let motion = self.motion();
        let slot_s = self.operation.course.slot_s();
        let rows = (0..=ROWS).map(|i| {
            let time_s = slot_s * f64::from(i) / f64::from(ROWS);
            (time_s, motion.cradle_rad(time_s).to_degrees(), motion.at(time_s))
        });
        let table = Table::over("axes", "Axes", rows).column(&TIME, |row| row.0).column(&CRADLE_ANGLE, |row| row.1);
        axes::rates(axes::positions(table, &AXES, |row| &row.2), &AXES, |row| &row.2).into()
    }

    fn charts(&self) -> &[NamedChart<LineChart>] {
        self.charts.get_or_init(|| self.drawn())
    }

    fn programs(&self, warnings: &[Notice]) -> Option<Result<Vec<(String, String)>, String>> {
        let number = gcode::program_number(self.job, self.operation);
        let file = self.job.scene.output.post.file_name(self.name(), number);
        Some(gcode::text(self.job, self.operation, warnings)?.map(|text| vec![(file, text)]))
    }
}

/// Share of an operation's roll in which no point of the target flanks is generated; none where nothing rolls.
pub fn idle_share(job: &BevelJob, operation: &PreparedBevel) -> Option<f64> {
    let [from, to] = operation.course.range;
    let (low, high) = (from.min(to), from.max(to));
    let used = (high.min(job.needed_rad[1]) - low.max(job.needed_rad[0])).max(0.0);
    (!operation.settings.plunges()).then_some(1.0 - used / (high - low))
}

fn named(peak: &Peak) -> Named {
    let name = peak.name();
    Named {
        key: name.to_lowercase().replace(' ', "_"),
        title: name,
        unlimited: "machine.bevel_limits gives none for this axis".to_owned(),
    }
}
