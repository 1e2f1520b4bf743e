//! Where the cutter really stands: the commanded axes with the errors of machine and clamping.
//!
//! In: the strokes of an operation or the program that is cut instead, and the machine's errors. Out: poses for the
//! passes, at every stroke coordinate and every place along the tooth. What is commanded stays in tables, charts and
//! programs.
//!
//! The gear's frame is that of its own axis: an eccentric or leaning gear sees the cutter shifted against it by the
//! same amount. The lean itself turns the section by less than its square, 5e-7 mm on a face of 100 mm that leans by
//! 10 um, and is left out; so is what an axial offset does to the moment at which the ram passes.
//!
//! A place of the gear is met when the ram is at its height on the machine, which is not its own where the gear sits
//! too high or leans. Guides go by that height: a helical one turns the cutter by tan(beta) times the difference along
//! the pitch curve. What a lean of the gear does to heights on a straight guide is a product of two errors, left out.
//!
//! While the feed rests during a stroke the commanded axes stand still, but noise of a bandwidth goes on: at a place
//! along the tooth it is that of the moment at which the ram passes there.

use crate::machine::{AxisMotion, Motion};
use crate::machine_errors::{
    ActualMotion, AxisNoise, Course, Guide, MachineErrors, MachineMoment, NoiseLaw, WorkMounting,
};
use crate::process::shaping::linkage::{CutterPose, StrokeSchedule};
use crate::process::shaping::motion::gcode::AxisProgram;
use crate::process::shaping::scene::model::StockScatter;
use gearcut_core::frame::Rigid2;
use gearcut_core::gear::GearKind;
use glam::{DVec2, DVec3};

/// Strokes before the first and after the last one at which poses are asked for: the way back of the last, and room.
const BEYOND_STROKES: f64 = 2.0;
/// The way back begins this part of a double stroke after the stroke's own moment, and ends as much before the next.
const BEFORE_STROKE: f64 = 0.25;
/// Places of both spindles among the axes.
const WORK: usize = 0;
const CUTTER: usize = 1;

/// What the axes are told: the strokes of the linkage, or a program in their place.
#[derive(Debug, Clone, Copy)]
pub struct Commanded<'a> {
    /// The strokes.
    pub schedule: &'a StrokeSchedule,
    /// The program.
    pub program: Option<&'a AxisProgram>,
}

/// Errors over the strokes of an operation.
#[derive(Debug, Clone)]
pub struct ActualStrokes {
    motion: Option<ActualMotion<3>>,
    /// Whether noise goes on while the feed rests.
    noise_at_rest: bool,
    guide: Guide,
    mounting: WorkMounting,
    gear: GearKind,
    half_face_mm: f64,
    start_s: f64,
    /// Turn of the cutter by a helical guide per mm of the ram, rad; none of a straight guide.
    cutter_rad_per_mm: Option<f64>,
    /// Turn of the work that its zero makes up for, rad.
    turn_rad: f64,
}

impl Commanded<'_> {
    /// Axes at a stroke coordinate: work angle and cutter angle, rad, centre distance, mm.
    fn positions(&self, stroke: f64) -> [f64; 3] {
        match self.program {
            Some(program) => program.at(stroke).axes(),
            None => {
                let state = self.schedule.state(stroke);
                [state.psi_c_rad, state.psi_b_rad, state.center_distance_mm]
            }
        }
    }

    /// How many strokes there are.
    pub fn count(&self) -> usize {
        self.program.map_or(self.schedule.count(), AxisProgram::count)
    }

    fn motion(&self, stroke: f64) -> [AxisMotion; 3] {
        let strokes_per_s = 1.0 / self.schedule.time_s(1.0);
        match self.program {
            Some(program) => {
                let (positions, rates) = (program.at(stroke).axes(), program.rates(stroke));
                std::array::from_fn(|axis| AxisMotion {
                    position: positions[axis],
                    velocity: rates[axis] * strokes_per_s,
                    acceleration: 0.0,
                })
            }
            None => self.schedule.at(stroke),
        }
    }

    /// All strokes, with room at both ends.
    fn course(&self) -> Course {
        let schedule = self.schedule;
        let last = (schedule.count() - 1) as f64 + BEYOND_STROKES;
        let corners: Vec<f64> = match self.program {
            Some(program) => program.knots.iter().map(|knot| knot.stroke).collect(),
            None => schedule.corners().to_vec(),
        };
        let turns = (last + BEYOND_STROKES) / f64::from(schedule.strokes_per_revolution());
        let per_turn = schedule.linkage().curve().samples_per_turn() as f64;
        Course {
            from_s: schedule.time_s(-BEYOND_STROKES),
            to_s: schedule.time_s(last),
            corners_s: corners.into_iter().map(|stroke| schedule.time_s(stroke)).collect(),
            cells: (per_turn * turns).ceil().max(64.0) as usize,
            noise_knots_s: None,
        }
    }
}

/// Errors of an operation whose stock scatters: its centre distance does, which holds the cutter back.
pub fn scattered(
    errors: &MachineErrors<3>,
    scatter: Option<StockScatter>,
    schedule: &StrokeSchedule,
) -> MachineErrors<3> {
    let mut errors = errors.clone();
    if let Some(StockScatter { deviation_mm, length_mm, draws }) = scatter {
        let turn_s = schedule.time_s(f64::from(schedule.strokes_per_revolution()));
        let mm_per_s = schedule.linkage().curve().perimeter_mm() / turn_s;
        let law = length_mm.map_or(NoiseLaw::EachPassage, |length| NoiseLaw::along_feed(length / mm_per_s));
        let [_, _, center_distance] = &mut errors.axes;
        center_distance.noise.push(AxisNoise { deviation: deviation_mm, law, draws });
    }
    errors
}

impl ActualStrokes {
    /// Errors over the strokes of an operation that begins `start_s` after the first one.
    pub fn new(
        errors: &MachineErrors<3>,
        commanded: Commanded<'_>,
        start_s: f64,
        half_face_mm: f64,
        cutter_rad_per_mm: Option<f64>,
    ) -> Self {
        let seconds_per_stroke = commanded.schedule.time_s(1.0);
        let at = |time_s: f64| commanded.motion(time_s / seconds_per_stroke);
        Self {
            motion: ActualMotion::new(&errors.axes, &commanded.course(), at),
            noise_at_rest: errors.axes.iter().flat_map(|axis| &axis.noise).any(|noise| noise.law.goes_on_at_rest()),
            guide: errors.guide,
            mounting: errors.mounting,
            gear: commanded.schedule.linkage().gear(),
            half_face_mm,
            start_s,
            cutter_rad_per_mm,
            turn_rad: 0.0,
        }
    }

    /// How far work and cutter are turned against each other for good in the middle of the operation, rad
    /// ([`ActualMotion::turn_rad`]).
    pub fn turn_rad(&self, commanded: Commanded<'_>) -> f64 {
        let schedule = commanded.schedule;
        let seconds_per_stroke = schedule.time_s(1.0);
        let middle_s = 0.5 * schedule.time_s(commanded.count() as f64);
        let at = |time_s: f64| commanded.motion(time_s / seconds_per_stroke);
        self.motion.as_ref().map_or(0.0, |motion| motion.turn_rad(WORK, &[CUTTER], middle_s, at))
    }

    /// The zero of the work spindle makes up for a turn.
    pub fn make_up_for(&mut self, turn_rad: f64) {
        self.turn_rad = turn_rad;
    }

    /// When the operation begins, s after the first one.
    pub fn start_s(&self) -> f64 {
        self.start_s
    }

    /// Whether sections at different places along the tooth are cut differently while the axes rest.
    pub fn differs_along_tooth(&self) -> bool {
        !self.guide.is_none() || self.mounting.wobble_rad != 0.0 || self.noise_at_rest
    }

    /// Height of the ram over the middle of the face when it passes a place of the gear, mm.
    pub fn ram_height_mm(&self, place_mm: DVec3) -> f64 {
        self.mounting.height_mm(place_mm)
    }

    /// Whether the gear leans.
    pub fn leans(&self) -> bool {
        self.mounting.wobble_rad != 0.0
    }

    /// Cutter in the spindle's frame at a stroke coordinate; `at_rest` double strokes later where the feed rests from
    /// there on.
    pub fn pose(&self, commanded: Commanded<'_>, stroke: f64, at_rest: f64) -> CutterPose {
        let Some(motion) = &self.motion else { return CutterPose::new(self.gear, commanded.positions(stroke)) };
        let seconds_per_stroke = commanded.schedule.time_s(1.0);
        let time_s = commanded.schedule.time_s(stroke);
        let strokes_before = (self.start_s / seconds_per_stroke).round();
        let moment = MachineMoment {
            time_s,
            since_start_s: self.start_s + time_s,
            at_rest_s: at_rest * seconds_per_stroke,
            passage: (strokes_before + stroke + BEFORE_STROKE).floor() as i64,
            indexed: [0.0; 3],
        };
        let mut positions = motion.positions(&moment, |time_s| commanded.positions(time_s / seconds_per_stroke));
        positions[WORK] -= self.turn_rad;
        CutterPose::new(self.gear, positions)
    }

    /// A cutter's pose in the spindle's frame at a stroke coordinate, in the gear's frame at a place along the
    /// tooth: led there by the guide, seen from the gear's own axis. Its helical guide's turn at that place is left to
    /// the helix; here it is turned by what the ram is higher there, at the stroke's pitch point.
    pub fn placed(&self, schedule: &StrokeSchedule, stroke: f64, pose: &CutterPose, z_mm: f64) -> Rigid2 {
        let shift_mm = self.guide.shift_mm(z_mm + self.mounting.axial_offset_mm, self.half_face_mm);
        let outwards = pose.center_mm.normalize_or(DVec2::X);
        let angle_rad = match self.cutter_rad_per_mm {
            Some(turn) if self.leans() || self.mounting.axial_offset_mm != 0.0 => {
                let pitch_point_mm = schedule.linkage().curve().frame(schedule.phi_rad(stroke)).point_mm;
                pose.angle_rad + turn * (self.ram_height_mm(pitch_point_mm.extend(z_mm)) - z_mm)
            }
            _ => pose.angle_rad,
        };
        Rigid2::new(angle_rad, pose.center_mm + outwards.rotate(shift_mm) - self.mounting.axis_mm(z_mm))
    }
}
