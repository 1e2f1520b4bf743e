//! What the axes of a hobbing machine are told: the linkage, or a program that is cut in its place.
//!
//! In: a linkage, and a program under test where the scene names one. Out: positions and speeds over time, and the time
//! at which the hob has turned to an angle: passes are made over the angle of the hob, so that every block of a program
//! has to turn it on.

use super::linkage::HobbingLinkage;
use super::linkage::dynamics::{AXES, in_order};
use crate::gcode::{TimedKnot, TimedProgram, read_file, read_timed};
use crate::machine::{AxisMotion, Motion as _};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::units::TURN_RAD;
use std::path::Path;

/// A program under test turns the hob this many times as often as the scene at most.
const MOST_TIMES_THE_TURNS: f64 = 10.0;
/// Place of the hob spindle among the axes.
const HOB: usize = 0;
/// Place of the shift.
const SHIFT: usize = 5;

/// Positions of hob (rad), work (rad), tangential, radial with infeed, slide and shift (mm).
pub type Positions = [f64; 6];
/// Axes at one moment.
pub type HobbingKnot = TimedKnot<6>;
/// A program of a hobbing machine.
pub type HobbingProgram = TimedProgram<6>;

/// Axis positions of a program of straight lines over time ([`read_timed`]). Without W the shift is `shift_mm`.
///
/// # Errors
/// Line and word of what is malformed, unknown or missing.
pub fn read(text: &str, shift_mm: f64) -> Result<HobbingProgram, String> {
    let mut standing = [None; 6];
    standing[SHIFT] = Some(shift_mm);
    Ok(HobbingProgram { knots: read_timed(text, &AXES, standing)? })
}

/// The linkage, or the program in its place.
#[derive(Debug, Clone, Copy)]
pub struct HobbingCommand<'a> {
    /// The linkage.
    pub linkage: &'a HobbingLinkage,
    /// The program, fully interpolated.
    pub program: Option<&'a HobbingProgram>,
}

impl HobbingCommand<'_> {
    /// Where the axes stand at a time.
    pub fn positions(&self, time_s: f64) -> Positions {
        match self.program {
            Some(program) => program.at(time_s),
            None => in_order(&self.linkage.axes::<1>(time_s)).map(|axis| axis.value()),
        }
    }

    /// How they move there; within a block at even speed.
    pub fn motion(&self, time_s: f64) -> [AxisMotion; 6] {
        match self.program {
            Some(program) => {
                let (positions, speeds) = (program.at(time_s), program.speeds(time_s));
                std::array::from_fn(|axis| AxisMotion {
                    position: positions[axis],
                    velocity: speeds[axis],
                    acceleration: 0.0,
                })
            }
            None => self.linkage.at(time_s),
        }
    }

    /// When the hob has turned to an angle, s.
    pub fn time_at_hob_angle(&self, hob_rad: f64) -> f64 {
        match self.program {
            Some(program) => program.time_at(HOB, hob_rad),
            None => self.linkage.time_at_hob_angle(hob_rad),
        }
    }

    /// How long it takes, s.
    pub fn end_s(&self) -> f64 {
        self.program.map_or_else(|| self.linkage.end_s(), TimedProgram::end_s)
    }

    /// Moments at which speeds jump, s.
    pub fn corners_s(&self) -> Vec<f64> {
        match self.program {
            Some(program) => program.knots.iter().map(|knot| knot.time_s).collect(),
            None => self.linkage.corners_s(),
        }
    }

    /// Angles of the hob at the beginning and at the end, rad.
    pub fn turned_rad(&self) -> [f64; 2] {
        [0.0, self.end_s()].map(|time_s| self.positions(time_s)[HOB])
    }
}

/// The program that an operation is cut with; `name` is the operation's.
///
/// # Errors
/// A file that cannot be read; a block that does not turn the hob on; many times the turns of the operation.
pub fn program_of(path: &Path, name: &str, linkage: &HobbingLinkage) -> Result<HobbingProgram> {
    let shift_mm = linkage.axes::<1>(0.0).shift_mm.value();
    let program = read_file(path, |text| read(text, shift_mm))?;
    let key = format!("operation.{name}.program");
    if program.knots.len() < 2 {
        let problem = format!("{} moves no axis after its first position", path.display());
        return Err(Refusal::new(&key, problem, "name a program that cuts").into());
    }
    let back = program.knots.windows(2).find(|pair| pair[1].axes[HOB] <= pair[0].axes[HOB]);
    if let Some([from, to]) = back {
        return Err(Refusal::new(
            &key,
            format!(
                "{}: in the block that ends at {:.4} s the hob spindle turns by {} deg",
                path.display(),
                to.time_s,
                (to.axes[HOB] - from.axes[HOB]).to_degrees()
            ),
            "passes are made over the angle of the hob: let B grow in every block",
        )
        .into());
    }
    let turns = |[from, to]: [f64; 2]| (to - from) / TURN_RAD;
    let [own, scene] = [Some(&program), None].map(|program| turns(HobbingCommand { linkage, program }.turned_rad()));
    if own > MOST_TIMES_THE_TURNS * scene {
        return Err(Refusal::new(
            &key,
            format!(
                "{} turns the hob {own:.1} times, the operation {scene:.1} times: more than {MOST_TIMES_THE_TURNS} \
                 times as often",
                path.display()
            ),
            "look at B of the program, and at the feed of the scene",
        )
        .into());
    }
    Ok(program)
}
