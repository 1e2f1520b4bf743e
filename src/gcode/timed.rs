//! Programs of axes that run along straight lines over time: how they are read, whatever the axes are.
//!
//! In: the text, the axes of the machine in their order, and positions that stand before the first block. Out: knots,
//! the moments at which blocks end. Law: `G0` to the first position, then `G1` in `G93`, where F is the reciprocal of a
//! block's time in minutes. Only what is known is read; everything else is refused by line and word.

use super::{Word, blocks};
use crate::machine::Axis;

/// Axes at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedKnot<const N: usize> {
    /// Time from the first knot, s.
    pub time_s: f64,
    /// Where the axes stand, mm or rad, in the machine's order.
    pub axes: [f64; N],
}

/// Knots of a program in this dialect: `G0` to the start, `G1` in `G93` with `F` in every block, `G21`, `G90`, `G94`,
/// `M2`, `M30`, `N`, words of the axes, comments. `standing` holds positions, in mm or deg, of axes that a program may
/// leave out.
///
/// # Errors
/// Line and word of what is malformed, unknown or missing.
pub fn read_timed<const N: usize>(
    text: &str,
    axes: &[Axis; N],
    standing: [Option<f64>; N],
) -> Result<Vec<TimedKnot<N>>, String> {
    let mut reader =
        Reader { axes, position: standing, motion: None, inverse_time: false, knots: Vec::new(), ended: false };
    let (lines, ended) = blocks(text, |words| {
        reader.block(words)?;
        Ok(reader.ended)
    })?;
    ended?;
    if reader.knots.is_empty() {
        return Err(format!("line {lines}: no axis has moved"));
    }
    Ok(reader.knots)
}

/// What the blocks so far have said.
struct Reader<'a, const N: usize> {
    axes: &'a [Axis; N],
    /// In mm and deg.
    position: [Option<f64>; N],
    motion: Option<u32>,
    inverse_time: bool,
    knots: Vec<TimedKnot<N>>,
    ended: bool,
}

impl<const N: usize> Reader<'_, N> {
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
                ('F', _) if word.number > 0.0 => per_minute = Some(word.rate()?),
                ('F', _) => return refuse("a feed must be above zero"),
                (letter, _) => match self.axes.iter().position(|axis| axis.letter == letter) {
                    Some(axis) => {
                        self.position[axis] = Some(word.position(self.axes[axis].kind)?);
                        moves = true;
                    }
                    None => {
                        let letters: Vec<String> = self.axes.iter().map(|axis| axis.letter.to_string()).collect();
                        return refuse(&format!("this letter is not read; axes are {}", letters.join(", ")));
                    }
                },
            }
        }
        if moves { self.travel(per_minute) } else { Ok(()) }
    }

    fn travel(&mut self, per_minute: Option<f64>) -> Result<(), String> {
        if let Some(axis) = self.position.iter().position(Option::is_none) {
            return Err(format!("axes move before axis {} has a position", self.axes[axis].letter));
        }
        let axes = std::array::from_fn(|axis| self.axes[axis].kind.from_shown(self.position[axis].unwrap_or_default()));
        let time_s = match (self.motion, self.knots.last()) {
            (None, _) => return Err("axes move, but neither G0 nor G1 has been given".to_owned()),
            (Some(0), None) => 0.0,
            (Some(0), Some(_)) => return Err("word `G0`: rapid travel after the start; use G1 with G93".to_owned()),
            (Some(_), None) => return Err("the program does not begin with G0 to its first position".to_owned()),
            (Some(_), Some(_)) if !self.inverse_time => {
                return Err("axes move without G93: the time of the block is not known".to_owned());
            }
            (Some(_), Some(last)) => match per_minute {
                Some(per_minute) => last.time_s + 60.0 / per_minute,
                None => return Err("word `F` is missing: in G93 every block needs its own".to_owned()),
            },
        };
        self.knots.push(TimedKnot { time_s, axes });
        Ok(())
    }
}
