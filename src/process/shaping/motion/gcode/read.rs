//! Reads a program back into axis positions, or says by line and word what it does not understand.

use super::program::{AxisProgram, Knot, WHOLE_STROKE as SAME_STROKE, strokes_until};
use crate::gcode::{Grammar, Move, Statement, read_file, statements};
use crate::machine::AxisKind;
use gearcut_core::error::Result;
use std::path::Path;

/// Block ends this near to a whole stroke stand on it: the digits of F leave so much.
const WHOLE_STROKE: f64 = 1e-5;

/// Reads a program file.
///
/// # Errors
/// The file cannot be read, or what [`program`] refuses, with the file's name.
pub fn file(path: &Path) -> Result<AxisProgram> {
    read_file(path, program)
}

/// What the blocks so far have done.
#[derive(Default)]
struct State {
    position: [Option<f64>; 3],
    strokes_per_minute: Option<f64>,
    ram_runs: bool,
    stroke: f64,
    /// The axes stood still for a while; a knot there is needed if they move on.
    dwelt: bool,
    knots: Vec<Knot>,
    /// Double strokes between the last knot and the stop of the ram.
    runs_on: f64,
}

/// Words of the axes, in the order of [`State::position`].
const GRAMMAR: Grammar<3> = Grammar {
    axes: [('X', AxisKind::Linear), ('C', AxisKind::Rotary), ('B', AxisKind::Rotary)],
    names: "X (centre distance), C (work) and B (cutter)",
    ram: true,
    arcs: false,
};

/// Axis positions of a program in the dialect of [`super`].
///
/// # Errors
/// Line and word of what is malformed, unknown or missing.
pub fn program(text: &str) -> Result<AxisProgram, String> {
    let mut state = State::default();
    let (lines, ended) = statements(text, &GRAMMAR, |statement| state.take(statement))?;
    if state.knots.is_empty() {
        return Err(format!("line {lines}: the program ends and the ram never ran (M3) over a known position"));
    }
    ended?;
    let double_strokes_per_minute = state.strokes_per_minute.unwrap_or_default();
    Ok(AxisProgram { double_strokes_per_minute, knots: state.knots, runs_on: state.runs_on })
}

impl State {
    fn take(&mut self, statement: Statement<3>) -> Result<(), String> {
        if let Some(speed) = statement.speed {
            if self.ram_runs && self.strokes_per_minute != Some(speed) {
                return Err(format!("word `S{speed}`: the ram's speed changes while it runs, which is not read"));
            }
            self.strokes_per_minute = Some(speed);
        }
        if let (Some(seconds), true) = (statement.dwell_s, self.ram_runs) {
            self.pass(seconds / 60.0 * self.strokes_per_minute.unwrap_or_default());
            self.dwelt = true;
        }
        if let Some((motion, target)) = statement.travel {
            self.travel(motion, target, &statement)?;
        }
        if statement.ram == Some(true) {
            self.start()?;
        }
        if statement.ram == Some(false) || statement.ends {
            self.stop()?;
        }
        Ok(())
    }

    fn travel(&mut self, motion: Move, target: [Option<f64>; 3], statement: &Statement<3>) -> Result<(), String> {
        if std::mem::take(&mut self.dwelt) {
            self.knot();
        }
        for (axis, value) in self.position.iter_mut().zip(target) {
            *axis = value.or(*axis);
        }
        match (motion, self.ram_runs, statement.feed) {
            (Move::Rapid, true, _) => Err("word `G0`: rapid travel while the ram runs; use G1 with G93".to_owned()),
            (Move::Rapid, false, _) | (Move::Straight, false, Some(_)) => Ok(()),
            (Move::Straight, true, _) if !statement.inverse_time => {
                Err("axes move under the running ram without G93: the time of the block is not known".to_owned())
            }
            (Move::Straight, _, None) if statement.inverse_time => {
                Err("word `F` is missing: in G93 every block needs its own".to_owned())
            }
            (Move::Straight, _, None) => Err("word `F` is missing: G1 has no feed yet".to_owned()),
            (Move::Straight, true, Some(per_minute)) => {
                self.pass(self.strokes_per_minute.unwrap_or_default() / per_minute);
                self.knot();
                Ok(())
            }
        }
    }

    fn start(&mut self) -> Result<(), String> {
        if self.ram_runs {
            return Ok(());
        }
        if !self.knots.is_empty() {
            return Err("word `M3`: the ram starts a second time, which is not read".to_owned());
        }
        if self.strokes_per_minute.is_none() {
            return Err("word `M3`: the ram starts without S, its double strokes per minute".to_owned());
        }
        if let Some(axis) = self.position.iter().position(Option::is_none) {
            let letter = GRAMMAR.axes[axis].0;
            return Err(format!("word `M3`: the ram starts before axis {letter} has a position"));
        }
        self.ram_runs = true;
        self.knot();
        Ok(())
    }

    /// The ram stops. Where it makes strokes after the one that the axes came for, the axes rest under them.
    fn stop(&mut self) -> Result<(), String> {
        if !std::mem::take(&mut self.ram_runs) {
            return Ok(());
        }
        let made = strokes_until(self.stroke);
        if made == 0 {
            return Err(
                "the ram stops (M5, M30 or M2) before it has made a stroke; let it run for one in a dwell (G4 P)"
                    .to_owned(),
            );
        }
        let last = |knots: &[Knot]| knots.last().map_or(0.0, |knot| knot.stroke);
        if made as f64 - 1.0 > last(&self.knots) + SAME_STROKE {
            self.knot();
        }
        self.dwelt = false;
        self.runs_on = self.stroke - last(&self.knots);
        Ok(())
    }

    /// Time goes on by some strokes.
    fn pass(&mut self, strokes: f64) {
        self.stroke += strokes;
        let whole = self.stroke.round();
        if (self.stroke - whole).abs() < WHOLE_STROKE * strokes.max(1.0) {
            self.stroke = whole;
        }
    }

    fn knot(&mut self) {
        let [x, c, b] = self.position.map(Option::unwrap_or_default);
        self.knots.push(Knot {
            stroke: self.stroke,
            psi_c_rad: (-c).to_radians(),
            psi_b_rad: b.to_radians(),
            center_distance_mm: x,
        });
    }
}
