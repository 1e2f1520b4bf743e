//! How a gear shaper has to move: what shaping adds to the axes' tables, charts and peaks.
//!
//! In: a prepared [`ShapingJob`]. Out: [`OperationAxes`] for the shared steps ([`crate::steps::axes`]): facts for the
//! terminal (of a program under test its own peaks), clearance on the return stroke as findings, and in `axes/` per
//! operation `<operation>.csv` (one row per stroke) and the charts `_positions`, `_velocities`, `_accelerations`,
//! `_relief`, and `_retraction` where the axes draw the cutter back.
//!
//! The laws stand in [`crate::process::shaping::linkage::dynamics`] and [`crate::process::shaping::linkage::relief`].

mod charts;
mod facts;
pub mod programs;
mod retraction;
mod strokes;

use crate::findings::{Notice, Place, Section, Table};
use crate::machine::{Peak, peaks};
use crate::output::line_chart::LineChart;
use crate::output::text::Sheet;
use crate::process::shaping::linkage::dynamics;
use crate::process::shaping::linkage::relief;
use crate::process::shaping::linkage::relief::{ReliefFlank, SmallestRelief};
use crate::process::shaping::motion::gcode::{AxisProgram, Judgement};
use crate::process::shaping::motion::returns::motion::RetractionMotion;
use crate::process::shaping::quantities::axes::{LARGEST_BETA, RELIEF, SMALLEST_CLEARANCE, SMALLEST_RATIO};
use crate::process::shaping::{PreparedOperation, ShapingJob};
use crate::steps::axes::{AxesOfOperation, Named, NamedChart, PeakWords};
use gearcut_core::Result;
use gearcut_core::units::UM_PER_MM;
use std::sync::OnceLock;
use strokes::StrokeRow;

/// Places per turn at which beta is looked at; its peaks are so flat that nothing is lost.
const BETA_PLACES: u32 = 7200;

/// How shaping speaks of peaks.
const PEAK_WORDS: PeakWords = PeakWords {
    at: "at work angle",
    place: "work_angle_deg",
    place_unit: ("deg", 2),
    place_note: "",
    way_out: "take more strokes per revolution or fewer double strokes per minute",
    named,
    zero_below: 0.0,
};

/// What one operation asks of the machine.
#[derive(Debug)]
pub struct OperationAxes<'a> {
    job: &'a ShapingJob,
    index: usize,
    peaks: Vec<Peak>,
    /// The program under test against the scene's own strokes, if one is cut.
    program: Option<Judgement>,
    /// Where the return stroke has the least clearance, once somebody has asked.
    relief: OnceLock<SmallestRelief>,
    /// Largest angle between the line of centres and the common normal direction, without its sign, and polar angle of
    /// the pitch point there, rad; once somebody has asked.
    largest_beta_rad: OnceLock<[f64; 2]>,
    /// All strokes, once a table or chart has asked for them.
    strokes: OnceLock<Vec<StrokeRow>>,
    /// Charts for folder and page, drawn once.
    charts: OnceLock<Vec<NamedChart<LineChart>>>,
    /// What the retraction asks for, where the axes carry it out.
    retraction: Option<RetractionMotion>,
}

impl<'a> OperationAxes<'a> {
    /// Peaks and relief of operation `index` of a job.
    pub fn new(job: &'a ShapingJob, index: usize) -> Self {
        let PreparedOperation { spec, schedule, retraction, program, .. } = &job.operations[index];
        let limits = dynamics::limits(&job.machine.limits);
        let judged = |program: &AxisProgram| {
            let ram = job.ram_times();
            let back = retraction.is_in_axes().then_some((&ram, retraction));
            let asked_mm = job.scene.output.gcode_contour_error_mm;
            program.judged(
                schedule,
                job.cutter.tip_radius_mm,
                back,
                asked_mm,
                job.machine.double_strokes_per_minute,
                spec.feed_during_stroke,
            )
        };
        Self {
            job,
            index,
            peaks: program
                .as_ref()
                .map_or_else(|| peaks(schedule, &limits), |program| program.peaks(schedule, &limits)),
            program: program.as_ref().map(judged),
            relief: OnceLock::new(),
            largest_beta_rad: OnceLock::new(),
            strokes: OnceLock::new(),
            charts: OnceLock::new(),
            retraction: RetractionMotion::new(schedule, retraction, &job.ram_times(), &limits),
        }
    }

    /// Of all operations of a job, in order.
    pub fn of_job(job: &'a ShapingJob) -> Vec<Self> {
        (0..job.operations.len()).map(|index| Self::new(job, index)).collect()
    }

    fn operation(&self) -> &'a PreparedOperation {
        &self.job.operations[self.index]
    }

    /// Where the return stroke has the least clearance.
    pub fn relief(&self) -> &SmallestRelief {
        let PreparedOperation { spec, linkage, .. } = self.operation();
        let alpha_rad = self.job.transverse.pressure_angle_rad;
        self.relief.get_or_init(|| relief::smallest_relief(linkage, spec.offset_mm, alpha_rad))
    }

    /// Largest angle between the line of centres and the common normal direction, without its sign, and polar angle of
    /// the pitch point there, rad.
    fn largest_beta_rad(&self) -> [f64; 2] {
        let PreparedOperation { spec, linkage, .. } = self.operation();
        let beta = |phi: f64| {
            let motion = linkage.pose_motion(phi, spec.offset_mm);
            let out = motion.pose.center_mm - motion.instantaneous_center_mm();
            let back = linkage.gear().tip_sign() * motion.pose.center_mm;
            out.perp_dot(back).atan2(out.dot(back)).abs()
        };
        let [from, to] = linkage.curve().toothed_rad();
        let places = (0..BETA_PLACES).map(|i| from + (to - from) * f64::from(i) / f64::from(BETA_PLACES));
        *self.largest_beta_rad.get_or_init(|| {
            let betas = places.map(|phi| [beta(phi), phi]);
            betas.fold([0.0; 2], |best, here| if here[0] > best[0] { here } else { best })
        })
    }

    fn strokes(&self) -> &[StrokeRow] {
        self.strokes.get_or_init(|| strokes::rows(self.job, self.operation()))
    }

    /// The program under test against the scene's own strokes, if one is cut.
    pub fn program(&self) -> Option<&Judgement> {
        self.program.as_ref()
    }

    /// Whether a program cuts that lies so far off the scene's own strokes that what is known of them does not hold.
    pub fn is_off_the_scene(&self) -> bool {
        self.program.as_ref().is_some_and(|program| program.is_off(self.job.scene.output.gcode_contour_error_mm))
    }

    /// What the retraction asks of the axes, where they carry it out.
    pub fn retraction_findings(&self) -> Option<Section> {
        self.retraction.map(|motion| retraction::findings(self.operation(), &motion))
    }

    /// Clearance on the return stroke.
    pub fn relief_findings(&self) -> Section {
        let relief = self.relief();
        let flank = match relief.flank {
            ReliefFlank::Left => "left",
            ReliefFlank::Right => "right",
        };
        let at = Place::default().and("flank", flank).and("polar_angle_deg", relief.phi_rad.to_degrees());
        let clearance_um = UM_PER_MM * relief.clearance_mm(self.job.machine.back_off_mm);
        let [beta_rad, beta_phi_rad] = self.largest_beta_rad();
        let beta_at = Place::default().and("polar_angle_deg", beta_phi_rad.to_degrees());
        RELIEF.section([
            SMALLEST_RATIO.of(relief.ratio).at(at.clone()),
            SMALLEST_CLEARANCE.of(clearance_um).at(at),
            LARGEST_BETA.of(beta_rad.to_degrees()).at(beta_at),
        ])
    }
}

impl AxesOfOperation for OperationAxes<'_> {
    fn name(&self) -> &str {
        &self.operation().spec.name
    }

    fn linkage_words(&self) -> String {
        self.operation().linkage.words().to_owned()
    }

    fn peak_words(&self) -> &PeakWords {
        &PEAK_WORDS
    }

    fn peaks(&self) -> &[Peak] {
        &self.peaks
    }

    fn place(&self, peak: &Peak) -> f64 {
        self.operation().work_angle_rad(peak.at).to_degrees()
    }

    fn print_facts(&self, sheet: &mut Sheet) {
        facts::print(self, sheet);
        if let Some(motion) = &self.retraction {
            retraction::print(self, motion, sheet);
        }
    }

    fn is_under_test(&self) -> bool {
        self.program.is_some()
    }

    /// Little or no relief by the machine's own relief; axes too slow for another one. Both are known of the scene's
    /// own strokes alone.
    fn own_warnings(&self) -> Vec<Notice> {
        if self.is_off_the_scene() {
            return Vec::new();
        }
        match &self.retraction {
            None => self.relief().warning(self.name(), self.job.machine.back_off_mm).into_iter().collect(),
            Some(motion) => retraction::warnings(self, motion),
        }
    }

    fn table(&self) -> Table {
        strokes::table(self.operation(), self.strokes())
    }

    fn charts(&self) -> &[NamedChart<LineChart>] {
        self.charts.get_or_init(|| charts::all(self.job, self.operation(), self.strokes()))
    }

    fn programs(&self, warnings: &[Notice]) -> Option<Result<Vec<(String, String)>, String>> {
        let file = self.job.scene.output.post.file_name(self.name(), self.index as u32 + 1);
        Some(programs::text(self.job, self.operation(), warnings)?.map(|text| vec![(file, text)]))
    }
}

fn named(peak: &Peak) -> Named {
    let (axis, order) = (peak.axis, peak.order.word());
    let mut letters = axis.name.chars();
    let capital: String = letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect();
    Named {
        key: format!("{}_{order}", axis.stem),
        title: format!("{capital}, {order}"),
        unlimited: format!("machine.limits.{} is not given", axis.column(peak.order)),
    }
}
