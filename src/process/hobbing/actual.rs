//! Where hob and work really stand: the commanded axes with the errors of machine, clamping and hob.
//!
//! In: a linkage or the program that is cut instead, and the machine's errors. Out: the pose of the work in the hob's
//! head at any hob angle, from which passes are made. What is commanded stays in tables, charts and programs.
//!
//! The tool angle of the passes is the commanded one. What the hob spindle is off by turns the head with it; so do the
//! runout and the wobble of the hob, whose own axis the head carries.

use super::commanded::HobbingCommand;
use super::linkage::HobbingLinkage;
use crate::machine::Motion as _;
use crate::machine_errors::{
    ActualMotion, Course, Guide, MachineErrors, MachineMoment, ToolMounting, WorkMounting, noise_knots_s,
    refuse_fast_noise,
};
use gearcut_core::error::Refusal;
use gearcut_core::frame::Rigid3;
use gearcut_core::units::TURN_RAD;
use glam::{DMat3, DVec3};

/// Most waves of a periodic error in a turn of the hob: passes keep the motion as polynomials of degree seven over
/// eighths of a turn, which then hold it to 2e-5 of its amplitude.
const MOST_WAVES_PER_HOB_TURN: f64 = 8.0;
/// Time before the beginning and after the end at which poses are asked for, in turns of the hob.
const BEYOND_TURNS: f64 = 1.0;
/// Places of both spindles among the axes.
const HOB: usize = 0;
const WORK: usize = 1;
/// Sections of the axes in `machine.errors`.
const SECTIONS: [&str; 6] = ["hob", "work", "x", "y", "slide", "shift"];

/// Errors over an operation.
#[derive(Debug, Clone)]
pub struct ActualHobbing {
    motion: Option<ActualMotion<6>>,
    guide: Guide,
    mounting: WorkMounting,
    hob: ToolMounting,
    half_face_mm: f64,
    start_s: f64,
    /// Turn of the work that its zero makes up for, rad.
    turn_rad: f64,
}

impl ActualHobbing {
    /// Errors over an operation that begins `start_s` after the first one.
    ///
    /// # Errors
    /// Periodic errors with more waves in a turn of the hob than passes can follow, and noise faster than they do.
    pub fn new(
        errors: &MachineErrors<6>,
        hob: ToolMounting,
        commanded: HobbingCommand,
        start_s: f64,
        half_face_mm: f64,
    ) -> Result<Self, Refusal> {
        let linkage = commanded.linkage;
        refuse_fast_waves(errors, linkage)?;
        let beyond_s = BEYOND_TURNS * linkage.end_s() / (linkage.axes::<1>(linkage.end_s()).hob_rad.value() / TURN_RAD);
        let hob_turns_per_s = BEYOND_TURNS / beyond_s;
        refuse_fast_noise(errors.axes.iter().zip(SECTIONS), hob_turns_per_s)?;
        let cycles = (commanded.end_s() + 2.0 * beyond_s) / linkage.cycle_s();
        let course = Course {
            from_s: -beyond_s,
            to_s: commanded.end_s() + beyond_s,
            corners_s: commanded.corners_s(),
            cells: (linkage.curve().samples_per_turn().clamp(64, 2048) as f64 * cycles).ceil() as usize,
            noise_knots_s: Some(noise_knots_s(hob_turns_per_s)),
        };
        Ok(Self {
            motion: ActualMotion::new(&errors.axes, &course, |time_s| commanded.motion(time_s)),
            guide: errors.guide,
            mounting: errors.mounting,
            hob,
            half_face_mm,
            start_s,
            turn_rad: 0.0,
        })
    }

    /// How far work and hob are turned against each other for good in the middle of the operation, rad
    /// ([`ActualMotion::turn_rad`]).
    pub fn turn_rad(&self, commanded: HobbingCommand) -> f64 {
        let middle_s = 0.5 * commanded.end_s();
        let turn =
            |motion: &ActualMotion<6>| motion.turn_rad(WORK, &[HOB], middle_s, |time_s| commanded.motion(time_s));
        self.motion.as_ref().map_or(0.0, turn)
    }

    /// The zero of the work spindle makes up for a turn.
    pub fn make_up_for(&mut self, turn_rad: f64) {
        self.turn_rad = turn_rad;
    }

    /// When the operation begins, s after the first one.
    pub fn start_s(&self) -> f64 {
        self.start_s
    }

    /// Pose of the work in the hob's head when the hob has been told to turn to `hob_rad`.
    pub fn head_from_work(&self, commanded: HobbingCommand, hob_rad: f64) -> Rigid3 {
        let linkage = commanded.linkage;
        let exact = commanded.program.is_none() && self.motion.is_none() && self.hob.is_none();
        if exact && self.guide.is_none() && self.mounting.is_none() {
            return linkage.head_from_work(hob_rad);
        }
        let time_s = commanded.time_at_hob_angle(hob_rad);
        let since_start_s = self.start_s + time_s;
        let moment = MachineMoment { time_s, since_start_s, at_rest_s: 0.0, passage: 0, indexed: [0.0; 6] };
        let mut axes = match &self.motion {
            Some(motion) => motion.positions(&moment, |time_s| commanded.positions(time_s)),
            None => commanded.positions(time_s),
        };
        axes[WORK] -= self.turn_rad;
        // The slide runs along the work's rotation vector, against the gear's z.
        let [_, work_rad, _, _, slide_mm, _] = axes;
        let along_z_mm = -slide_mm;
        let shift_mm = self.guide.shift_mm(along_z_mm, self.half_face_mm);
        let out = DVec3::new(work_rad.cos(), work_rad.sin(), 0.0);
        let guided = out * shift_mm.x + DVec3::Z.cross(out) * shift_mm.y;
        let mut spindle = linkage.work_from_tool_at(time_s, axes);
        spindle.translation_mm += guided;
        let gear_from_tool = self.mounting.gear_from_spindle(0.0).after(&spindle).after(&self.hob.spindle_from_tool());
        let rotation = DMat3::from_rotation_z(linkage.geometry().hob_hand * hob_rad);
        Rigid3 { rotation, translation_mm: DVec3::ZERO }.after(&gear_from_tool.inverse())
    }
}

/// Refuses waves that pass by faster than the passes' polynomials can follow.
fn refuse_fast_waves(errors: &MachineErrors<6>, linkage: &HobbingLinkage) -> Result<(), Refusal> {
    let corners = linkage.corners_s();
    // Speeds at the corners and between show how fast axes run; slides at constant feeds show theirs anywhere.
    let moments =
        corners.windows(2).flat_map(|ends| (0..64).map(move |i| ends[0] + (ends[1] - ends[0]) * f64::from(i) / 64.0));
    for time_s in moments {
        let axes = linkage.at(time_s);
        let hob_turns_per_s = axes[0].velocity / TURN_RAD;
        for ((errors, axis), name) in errors.axes.iter().zip(axes).zip(SECTIONS) {
            let waves = |rate: f64| (rate * axis.velocity / TURN_RAD / hob_turns_per_s).abs();
            if let Some(wave) = errors.periodic.iter().find(|wave| waves(wave.rate) > MOST_WAVES_PER_HOB_TURN) {
                return Err(Refusal::new(
                    &format!("machine.errors.{name}"),
                    format!(
                        "a periodic error has {:.1} waves in a turn of the hob; passes follow at most \
                        {MOST_WAVES_PER_HOB_TURN}",
                        waves(wave.rate)
                    ),
                    "leave out waves that are shorter",
                ));
            }
        }
    }
    Ok(())
}
