//! Axis positions from the text of a bevel program: only what is known is read, everything else is refused by line and
//! word.

use super::program::{BevelKnot, BevelProgram};
use crate::gcode::{Word, blocks};
use crate::process::bevel::motion::AXES;

/// Axis positions of a program in this dialect: `G0` to the start, `G1` in `G93` with `F` in every block, `G21`, `G90`,
/// `G94`, `M30`, words `N X Y Z A B`, comments.
///
/// # Errors
/// Line and word of what is malformed, unknown or missing.
pub fn read(text: &str) -> Result<BevelProgram, String> {
    let mut reader = Reader { position: [None; 5], motion: None, inverse_time: false, knots: Vec::new(), ended: false };
    let (lines, ended) = blocks(text, |words| {
        reader.block(words)?;
        Ok(reader.ended)
    })?;
    ended?;
    if reader.knots.is_empty() {
        return Err(format!("line {lines}: no axis has moved"));
    }
    Ok(BevelProgram { knots: reader.knots })
}

/// What the blocks so far have said.
struct Reader {
    /// In mm and deg.
    position: [Option<f64>; 5],
    motion: Option<u32>,
    inverse_time: bool,
    knots: Vec<BevelKnot>,
    ended: bool,
}

impl Reader {
    fn block(&mut self, words: &[Word]) -> Result<(), String> {
        let (mut moves, mut per_minute) = (false, None);
        for word in words {
            let refuse = |why: &str| Err(format!("word `{}`: {why}", word.text));
            match (word.letter, (word.number * 10.0).round() as i64) {
                ('N', _) | ('G', 210 | 900) => {}
                ('G', 0) => self.motion = Some(0),
                ('G', 10) => self.motion = Some(1),
                ('G', 930) => self.inverse_time = true,
                ('G', 940) => self.inverse_time = false,
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
                    None => return refuse("this letter is not read; axes are X, Y, Z, A and B"),
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
        let time_s = match (self.motion, self.knots.last()) {
            (Some(0), None) => 0.0,
            (Some(1), Some(last)) => match per_minute {
                Some(per_minute) if self.inverse_time => last.time_s + 60.0 / per_minute,
                Some(_) => return Err("axes move without G93: the time of the block is not known".to_owned()),
                None => return Err("word `F` is missing: in G93 every block needs its own".to_owned()),
            },
            (Some(0), Some(_)) => return Err("word `G0`: rapid travel after the start; use G1 with G93".to_owned()),
            _ => return Err("the program does not begin with G0 to its first position".to_owned()),
        };
        self.knots.push(BevelKnot { time_s, axes });
        Ok(())
    }
}
