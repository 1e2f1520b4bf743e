//! Reads a program back into axis positions, or says by line and word what it does not understand.

use super::program::{AxisProgram, Knot, WHOLE_STROKE as SAME_STROKE, strokes_until};
use crate::gcode::{Word, blocks};
use crate::machine::AxisKind;
use crate::regular_file;
use gearcut_core::error::{Error, Result};
use std::path::Path;

/// Block ends this near to a whole stroke stand on it: the digits of F leave so much.
const WHOLE_STROKE: f64 = 1e-5;
/// Largest file.
const MOST_BYTES: u64 = 256 << 20;

/// Reads a program file.
///
/// # Errors
/// The file cannot be read, or what [`program`] refuses, with the file's name.
pub fn file(path: &Path) -> Result<AxisProgram> {
    let unreadable = |reason: String| Error::Unreadable { path: path.to_owned(), reason };
    let bytes = regular_file::read(path, MOST_BYTES).map_err(unreadable)?;
    let text = String::from_utf8(bytes).map_err(|_| unreadable("it is not text".to_owned()))?;
    program(&text).map_err(unreadable)
}

/// What the blocks so far have said.
#[expect(clippy::struct_excessive_bools, reason = "modal states of a control are switches")]
#[derive(Default)]
struct State {
    position: [Option<f64>; 3],
    inverse_time: bool,
    motion: Option<u32>,
    strokes_per_minute: Option<f64>,
    ram_runs: bool,
    stroke: f64,
    /// The axes stood still for a while; a knot there is needed if they move on.
    dwelt: bool,
    knots: Vec<Knot>,
    /// Double strokes between the last knot and the stop of the ram.
    runs_on: f64,
    ended: bool,
}

/// Axis letters in the order of [`State::position`].
const AXES: [char; 3] = ['X', 'C', 'B'];
/// How they move.
const KINDS: [AxisKind; 3] = [AxisKind::Linear, AxisKind::Rotary, AxisKind::Rotary];

/// Axis positions of a program in the dialect of [`super`].
///
/// # Errors
/// Line and word of what is malformed, unknown or missing.
pub fn program(text: &str) -> Result<AxisProgram, String> {
    let mut state = State::default();
    let (lines, ended) = blocks(text, |words| {
        state.block(words)?;
        Ok(state.ended)
    })?;
    if state.knots.is_empty() {
        return Err(format!("line {lines}: the program ends and the ram never ran (M3) over a known position"));
    }
    ended?;
    let double_strokes_per_minute = state.strokes_per_minute.unwrap_or_default();
    Ok(AxisProgram { double_strokes_per_minute, knots: state.knots, runs_on: state.runs_on })
}

impl State {
    fn block(&mut self, words: &[Word]) -> Result<(), String> {
        let (mut target, mut per_minute, mut dwell_s) = ([None; 3], None, None);
        let (mut start, mut stop, mut end, mut dwell) = (false, false, false, false);
        let mut seen = Vec::new();
        for word in words {
            let refuse = |why: &str| Err(format!("word `{}`: {why}", word.text));
            if !matches!(word.letter, 'G' | 'M') && seen.contains(&word.letter) {
                return refuse("this letter stands twice in the block");
            }
            seen.push(word.letter);
            match word.letter {
                'N' => {}
                'G' => match (word.number * 10.0).round() as i64 {
                    0 => self.motion = Some(0),
                    10 => self.motion = Some(1),
                    40 => dwell = true,
                    210 | 900 => {}
                    930 => self.inverse_time = true,
                    940 => self.inverse_time = false,
                    200 => return refuse("inches are not read; write the program in mm (G21)"),
                    910 => return refuse("relative positions are not read; write absolute ones (G90)"),
                    20 | 30 => return refuse("arcs are not read; write straight lines (G1)"),
                    840 => {
                        return refuse(
                            "a tapping cycle on most controls, and a one-block gear on one; neither is read",
                        );
                    }
                    _ => {
                        return refuse(
                            "this G is not read; known are G0, G1, G4, G21, G90, G93, G94; a program for a control \
                            is tested as output.post = \"plain\" writes it",
                        );
                    }
                },
                'M' => match (word.number * 10.0).round() as i64 {
                    30 => start = true,
                    50 => stop = true,
                    20 | 300 => end = true,
                    _ => return refuse("this M is not read; known are M2, M3, M5, M30"),
                },
                'S' => {
                    if word.number <= 0.0 {
                        return refuse("double strokes per minute must be above zero");
                    }
                    if self.ram_runs && self.strokes_per_minute != Some(word.number) {
                        return refuse("the ram's speed changes while it runs, which is not read");
                    }
                    self.strokes_per_minute = Some(word.rate()?);
                }
                'F' => {
                    if word.number <= 0.0 {
                        return refuse("a feed must be above zero");
                    }
                    per_minute = Some((word.rate()?, word.text));
                }
                'P' if word.number > 0.0 => dwell_s = Some((word.rate()?, word.text)),
                'P' => dwell_s = Some((word.number, word.text)),
                letter => match AXES.iter().position(|&axis| axis == letter) {
                    Some(axis) => target[axis] = Some(word.position(KINDS[axis])?),
                    None => {
                        return refuse(
                            "this letter is not read; axes are X (centre distance), C (work) and B (cutter)",
                        );
                    }
                },
            }
        }
        let moves = target.iter().any(Option::is_some);
        if dwell {
            let Some((seconds, text)) = dwell_s else {
                return Err("word `G4`: a dwell needs P, its time in s".to_owned());
            };
            if seconds < 0.0 || moves {
                return Err(format!("word `{text}`: a dwell has a time of zero or more and no positions"));
            }
            if self.ram_runs {
                self.pass(seconds / 60.0 * self.strokes_per_minute.unwrap_or_default());
                self.dwelt = true;
            }
        } else if let Some((_, text)) = dwell_s {
            return Err(format!("word `{text}`: P belongs to a dwell (G4)"));
        }
        if moves {
            self.travel(target, per_minute)?;
        }
        if start {
            self.start()?;
        }
        if stop || end {
            self.stop()?;
        }
        self.ended |= end;
        Ok(())
    }

    fn travel(&mut self, target: [Option<f64>; 3], per_minute: Option<(f64, &str)>) -> Result<(), String> {
        if std::mem::take(&mut self.dwelt) {
            self.knot();
        }
        for (axis, value) in self.position.iter_mut().zip(target) {
            *axis = value.or(*axis);
        }
        match self.motion {
            None => Err("axes move, but neither G0 nor G1 has been given".to_owned()),
            Some(0) if self.ram_runs => Err("word `G0`: rapid travel while the ram runs; use G1 with G93".to_owned()),
            Some(0) => Ok(()),
            Some(_) if !self.ram_runs => Ok(()),
            Some(_) if !self.inverse_time => {
                Err("axes move under the running ram without G93: the time of the block is not known".to_owned())
            }
            Some(_) => {
                let Some((per_minute, _)) = per_minute else {
                    return Err("word `F` is missing: in G93 every block needs its own".to_owned());
                };
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
            return Err(format!("word `M3`: the ram starts before axis {} has a position", AXES[axis]));
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
