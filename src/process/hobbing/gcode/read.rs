//! Axis positions from the text of a hobbing program: only what is known is read, everything else is refused by line
//! and word.

use super::program::{HobbingKnot, HobbingProgram};
use crate::gcode::{Word, blocks};
use crate::process::hobbing::linkage::dynamics::AXES;

/// Axis positions of a program in this dialect: `G0` to the start, `G1` in `G93` with `F` in every block, `G21`, `G90`,
/// `G94`, `M30`, words `N X Y Z W B C`, comments. Without W the shift is `shift_mm`.
///
/// # Errors
/// Line and word of what is malformed, unknown or missing.
pub fn read(text: &str, shift_mm: f64) -> Result<HobbingProgram, String> {
    let mut state = Reader { position: [None; 6], motion: None, inverse_time: false, knots: Vec::new(), ended: false };
    state.position[5] = Some(shift_mm);
    let (lines, ended) = blocks(text, |words| {
        state.block(words)?;
        Ok(state.ended)
    })?;
    ended?;
    if state.knots.is_empty() {
        return Err(format!("line {lines}: no axis has moved"));
    }
    Ok(HobbingProgram { knots: state.knots })
}

/// What the blocks so far have said.
struct Reader {
    /// In mm and deg.
    position: [Option<f64>; 6],
    motion: Option<u32>,
    inverse_time: bool,
    knots: Vec<HobbingKnot>,
    ended: bool,
}

impl Reader {
    fn block(&mut self, words: &[Word]) -> Result<(), String> {
        let (mut moves, mut per_minute) = (false, None);
        let mut seen = Vec::new();
        for word in words {
            let refuse = |why: &str| Err(format!("word `{}`: {why}", word.text));
            if !matches!(word.letter, 'G' | 'M') && seen.contains(&word.letter) {
                return refuse("this letter stands twice in the block");
            }
            seen.push(word.letter);
            match (word.letter, (word.number * 10.0).round() as i64) {
                ('N', _) | ('G', 210 | 900) => {}
                ('G', 0) => self.motion = Some(0),
                ('G', 10) => self.motion = Some(1),
                ('G', 930) => self.inverse_time = true,
                ('G', 940) => self.inverse_time = false,
                ('G', 200) => return refuse("inches are not read; write the program in mm (G21)"),
                ('G', 910) => return refuse("relative positions are not read; write absolute ones (G90)"),
                ('G', _) => return refuse("this G is not read; known are G0, G1, G21, G90, G93, G94"),
                ('M', 20 | 300) => self.ended = true,
                ('M', _) => return refuse("this M is not read; known are M2, M30"),
                ('F', _) if word.number > 0.0 => per_minute = Some(word.number),
                ('F', _) => return refuse("a feed must be above zero"),
                (letter, _) => match AXES.iter().position(|axis| axis.letter == letter) {
                    Some(axis) => {
                        self.position[axis] = Some(word.number);
                        moves = true;
                    }
                    None => return refuse("this letter is not read; axes are X, Y, Z, W, B and C"),
                },
            }
        }
        if moves { self.travel(per_minute) } else { Ok(()) }
    }

    fn travel(&mut self, per_minute: Option<f64>) -> Result<(), String> {
        if let Some(axis) = self.position.iter().position(Option::is_none) {
            return Err(format!("axes move before axis {} has a position", AXES[axis].letter));
        }
        let axes = std::array::from_fn(|axis| AXES[axis].kind.from_shown(self.position[axis].unwrap_or_default()));
        match (self.motion, self.knots.last()) {
            (None, _) => Err("axes move, but neither G0 nor G1 has been given".to_owned()),
            (Some(0), None) => {
                self.knots.push(HobbingKnot { time_s: 0.0, axes });
                Ok(())
            }
            (Some(0), Some(_)) => Err("word `G0`: rapid travel after the start; use G1 with G93".to_owned()),
            (Some(_), None) => Err("the program does not begin with G0 to its first position".to_owned()),
            (Some(_), Some(last)) => {
                if !self.inverse_time {
                    return Err("axes move without G93: the time of the block is not known".to_owned());
                }
                let Some(per_minute) = per_minute else {
                    return Err("word `F` is missing: in G93 every block needs its own".to_owned());
                };
                self.knots.push(HobbingKnot { time_s: last.time_s + 60.0 / per_minute, axes });
                Ok(())
            }
        }
    }
}
