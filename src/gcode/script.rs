//! A program before a control's dialect is chosen: what moves where, how fast, and what the operator must know.
//!
//! In: axes with their digits, the start, straight lines with their times, the ram of a shaper, the position of one
//! axis at which the tool is clear of the work. Out: the text for a control ([`Script::text`]), from the rules of its
//! dialect ([`super::post`]). Law: every line is one block in inverse time (`G93`, F = 1 / minutes of the block).
//!
//! Where a control takes few digits of F, the rounding of each block's time is carried on to the next one, so that the
//! ends of all blocks keep their moments; and lines that would last too long for those digits are parted.
//!
//! Road not taken: feeds in mm/min (`G94`). They mean one thing for a line in X and another for a turn of C, and
//! controls disagree on a mixture of both.

use super::post::{Dialect, Opening};
use crate::machine::AxisKind;
use crate::scene::Post;
use crate::wrap::wrapped;
use std::fmt::Write as _;

/// Longest line of a comment, beyond which it goes on in the next one; no control here takes less.
const COMMENT_COLUMNS: usize = 80;

/// An axis of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisColumn {
    /// Its word.
    pub letter: char,
    /// Rotary axes turn on without end.
    pub kind: AxisKind,
    /// Digits after the point.
    pub digits: usize,
}

/// A straight line in all axes at once.
#[derive(Debug, Clone, PartialEq)]
pub struct StraightLine {
    /// Where it ends, mm and deg, in the order of the columns.
    pub to: Vec<f64>,
    /// Reciprocal of its time, 1/min.
    pub per_minute: f64,
}

/// The ram of a shaper.
#[derive(Debug, Clone, PartialEq)]
pub struct Ram {
    /// Double strokes per minute.
    pub per_minute: f64,
    /// The same as a scene gives it.
    pub shown: String,
    /// Double strokes that it makes after the last line.
    pub runs_on: f64,
}

/// A program of straight lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Script {
    /// Name of the operation.
    pub name: String,
    /// Number of the program among those of the scene, from 1.
    pub number: u32,
    /// What must be known before it is run, a comment each.
    pub head: Vec<String>,
    /// The axes, in the order of their words.
    pub columns: Vec<AxisColumn>,
    /// AxisColumn and position, mm, at which the tool is clear of the work wherever the other axes stand.
    pub clear: (usize, f64),
    /// The ram that runs along the lines, if there is one; it makes its last stroke after the last line.
    pub ram: Option<Ram>,
    /// Where the axes stand first, mm and deg.
    pub start: Vec<f64>,
    /// The lines.
    pub lines: Vec<StraightLine>,
    /// Largest displacement that the lines may cause, mm.
    pub contour_error_mm: f64,
}

impl Script {
    /// The program for a control.
    ///
    /// # Errors
    /// Why the control cannot say it.
    pub fn text(&self, post: Post) -> Result<String, String> {
        let dialect = post.dialect();
        let lines = dialect.parted(self)?;
        let mut text = Text { dialect, written: String::new(), number: 0 };
        for line in (dialect.opening)(&Opening { name: &self.name, number: self.number }) {
            text.line(&line);
        }
        let incremental = dialect.runs_beyond(self);
        let beyond = incremental
            .then(|| format!("PATH in increments, G91: an axis runs beyond {} deg", dialect.largest_position));
        for words in self.head.iter().map(String::as_str).chain(dialect.told.iter().copied()).chain(beyond.as_deref()) {
            text.comment(words);
        }
        for words in (dialect.safe_start)(self.contour_error_mm) {
            text.block(&words);
        }
        let start = dialect.start(self)?;
        let (clear, clear_mm) = self.clear;
        let clear_word = dialect.word(&self.columns[clear], clear_mm);
        if dialect.approaches {
            let others: Vec<usize> = (0..self.columns.len()).filter(|&column| column != clear).collect();
            let word = |column: usize| dialect.word(&self.columns[column], start[column]);
            text.block(&format!("G0 {clear_word}"));
            text.block(&format!("G0 {}", others.into_iter().map(word).collect::<Vec<_>>().join(" ")));
            text.block(&format!("G0 {}", word(clear)));
        } else {
            text.block(&format!("G0 {}", self.words(dialect, &start)));
        }
        if let Some(ram) = &self.ram {
            text.block(&format!("S{} M3", dialect.speed(ram)?));
        }
        if incremental {
            text.block("G91");
        }
        let mut from = &self.start;
        let mut clock = BlockTimes::default();
        for line in &lines {
            let position =
                if incremental { self.steps(dialect, from, &line.to) } else { self.words(dialect, &line.to) };
            text.block(&format!("G93 G1 {position} F{}", clock.feed(dialect, line)?));
            from = &line.to;
        }
        if incremental {
            text.block("G90");
        }
        if let Some(ram) = &self.ram {
            text.block(&(dialect.dwell)(60.0 * ram.runs_on / ram.per_minute));
            text.block("M5");
        }
        if dialect.approaches {
            text.block("G94");
            text.block(&format!("G0 {clear_word}"));
        }
        text.block("M30");
        if dialect.tape_ends {
            text.line("%");
        }
        Ok(text.written)
    }

    fn words(&self, dialect: &Dialect, position: &[f64]) -> String {
        let words = self.columns.iter().zip(position).map(|(column, &at)| dialect.word(column, at));
        words.collect::<Vec<_>>().join(" ")
    }

    /// Steps between rounded positions: their sum is the sum of the path, to the last digit.
    fn steps(&self, dialect: &Dialect, from: &[f64], to: &[f64]) -> String {
        let word = |(column, (&from, &to)): (&AxisColumn, (&f64, &f64))| {
            let digits = dialect.digits(column);
            let scale = 10_f64.powi(digits as i32);
            let step = (to * scale).round() - (from * scale).round();
            format!("{}{:.digits$}", column.letter, positive_zero(step / scale))
        };
        let words = self.columns.iter().zip(from.iter().zip(to)).map(word);
        words.collect::<Vec<_>>().join(" ")
    }
}

/// Moments of block ends, as asked and as the written words say them, min.
#[derive(Debug, Default)]
struct BlockTimes {
    asked: f64,
    written: f64,
}

impl BlockTimes {
    /// The number of F for a line.
    fn feed(&mut self, dialect: &Dialect, line: &StraightLine) -> Result<String, String> {
        let digits = dialect.feed_digits;
        if line.per_minute > dialect.most_per_minute {
            return Err(format!(
                "a block lasts {:.3} ms, and the control takes none shorter than {:.3} ms; ask for a larger \
                 output.gcode_contour_error_um, or run slower",
                6e4 / line.per_minute,
                6e4 / dialect.most_per_minute
            ));
        }
        self.asked += line.per_minute.recip();
        let per_minute = if dialect.carries_time {
            let left = self.asked - self.written;
            if left > dialect.most_per_minute.recip() { left.recip() } else { dialect.most_per_minute }
        } else {
            line.per_minute
        };
        let text = format!("{per_minute:.digits$}");
        self.written += text.parse::<f64>().map_or(0.0, f64::recip);
        Ok(text)
    }
}

impl Dialect {
    /// Digits of an axis that this control takes.
    fn digits(&self, column: &AxisColumn) -> usize {
        column.digits.min(self.most_digits)
    }

    fn word(&self, column: &AxisColumn, at: f64) -> String {
        let digits = self.digits(column);
        // Negated zeros read as nonsense.
        let text = format!("{at:.digits$}");
        let zero = !text.contains(|c: char| c.is_ascii_digit() && c != '0');
        format!("{}{}", column.letter, if zero { text.trim_start_matches('-') } else { &text })
    }

    fn speed(&self, ram: &Ram) -> Result<String, String> {
        if self.whole_speeds && ram.per_minute.fract() != 0.0 {
            return Err(format!(
                "S is a whole number on this control, the ram makes {} double strokes per minute; give \
                 machine.double_strokes_per_minute without a fraction",
                ram.shown
            ));
        }
        Ok(ram.shown.clone())
    }

    /// Whether a rotary axis leaves the range of positions: the path is then written in increments.
    fn runs_beyond(&self, script: &Script) -> bool {
        let ends = script.lines.iter().map(|line| &line.to);
        ends.chain([&script.start]).flatten().any(|at| at.abs() > self.largest_position)
    }

    /// The first position; whole turns of rotary axes are left out where it is out of range.
    fn start(&self, script: &Script) -> Result<Vec<f64>, String> {
        let of = |(column, &at): (&AxisColumn, &f64)| match column.kind {
            _ if at.abs() <= self.largest_position => Ok(at),
            AxisKind::Rotary => Ok(at % 360.0),
            AxisKind::Linear => {
                Err(format!("{}{at} is beyond the {} mm that this control takes", column.letter, self.largest_position))
            }
        };
        let clear = (&script.columns[script.clear.0], &script.clear.1);
        of(clear)?;
        script.columns.iter().zip(&script.start).map(of).collect()
    }

    /// The lines, those that last too long for the digits of F in equal parts.
    fn parted(&self, script: &Script) -> Result<Vec<StraightLine>, String> {
        let mut lines = Vec::new();
        let mut from = &script.start;
        for line in &script.lines {
            if !(line.per_minute.is_finite() && line.per_minute > 0.0) {
                return Err(format!("a block has no time: F would be {}", line.per_minute));
            }
            let parts = (self.least_per_minute / line.per_minute).ceil().max(1.0);
            for part in 1..=parts as usize {
                let share = part as f64 / parts;
                let to = from.iter().zip(&line.to).map(|(from, to)| from + share * (to - from)).collect();
                let to = if part as f64 == parts { line.to.clone() } else { to };
                lines.push(StraightLine { to, per_minute: line.per_minute * parts });
            }
            from = &line.to;
        }
        Ok(lines)
    }
}

fn positive_zero(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value }
}

/// A program as it grows.
struct Text<'a> {
    dialect: &'a Dialect,
    written: String,
    number: u32,
}

impl Text<'_> {
    fn line(&mut self, line: &str) {
        let _ = writeln!(self.written, "{line}");
    }

    fn comment(&mut self, words: &str) {
        let words = (self.dialect.comment_words)(words);
        let [before, after] = self.dialect.comment_marks;
        if !self.dialect.approaches {
            return self.line(&format!("{before}{words}{after}"));
        }
        let room = COMMENT_COLUMNS - before.len() - after.len();
        for line in wrapped(&words, room) {
            // A word that is longer than a line, such as a path.
            let line: Vec<char> = line.chars().collect();
            for part in line.chunks(room) {
                self.line(&format!("{before}{}{after}", part.iter().collect::<String>()));
            }
        }
    }

    fn block(&mut self, words: &str) {
        if self.dialect.numbers_blocks {
            self.number += 10;
            let _ = writeln!(self.written, "N{} {words}", self.number);
        } else {
            self.line(words);
        }
    }
}
