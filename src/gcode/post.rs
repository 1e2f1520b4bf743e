//! Posts: what each control asks of a program's text.
//!
//! In: which control ([`Post`]). Out: its [`Dialect`], rules as data: comments, digits, range of F, dwell, first
//! blocks, end. The program itself is a [`super::Script`], the same for all. Each control's file names the manual that
//! its rules come from; `tests/suite/posts` reads programs by readers that were written from those manuals alone.
//!
//! Machines add their own: M codes of the ram, reference points, probing. A post writes what the control defines and
//! leaves those to the machine's builder.

mod fanuc;
mod linuxcnc;
mod plain;
mod siemens;

use super::Digits;
use crate::scene::Post;

/// What the first lines of a program are made of.
pub(super) struct Opening<'a> {
    /// Name of the operation.
    pub name: &'a str,
    /// Number of the program among those of the scene, from 1.
    pub number: u32,
}

/// Rules of a control.
#[expect(clippy::struct_excessive_bools, reason = "what a control wants or does not want are switches")]
pub(super) struct Dialect {
    /// End of a file's name, without the point.
    pub extension: &'static str,
    /// Lines before everything else: tape end, program number.
    pub opening: fn(&Opening) -> Vec<String>,
    /// Whether the program ends with the tape end, `%`.
    pub tape_ends: bool,
    /// What stands before and after a comment.
    pub comment_marks: [&'static str; 2],
    /// Words of a comment in the characters that the control takes.
    pub comment_words: fn(&str) -> String,
    /// What the operator must know of the control.
    pub told: &'static [&'static str],
    /// Blocks are numbered.
    pub numbers_blocks: bool,
    /// Blocks that bring the control into a known state, for a contour error in mm.
    pub safe_start: fn(f64) -> Vec<String>,
    /// The tool comes to the start, and leaves the end, by the clear position.
    pub approaches: bool,
    /// Most digits after the point of a position.
    pub most_digits: usize,
    /// Largest position without its sign, mm or deg.
    pub largest_position: f64,
    /// Digits after the point of F.
    pub feed_digits: usize,
    /// Largest F, 1/min: the shortest block.
    pub most_per_minute: f64,
    /// Least F, 1/min: below it the digits of F leave too much time in doubt.
    pub least_per_minute: f64,
    /// What F's rounding leaves of a block's time is made up for in the next block.
    pub carries_time: bool,
    /// S has no fraction.
    pub whole_speeds: bool,
    /// A dwell of so many seconds.
    pub dwell: fn(f64) -> String,
}

impl Post {
    /// Its rules.
    pub(super) fn dialect(self) -> &'static Dialect {
        match self {
            Self::Plain => &plain::DIALECT,
            Self::LinuxCnc => &linuxcnc::DIALECT,
            Self::Siemens => &siemens::DIALECT,
            Self::Fanuc => &fanuc::DIALECT,
        }
    }

    /// Shortest block that the control takes, s.
    pub fn shortest_block_s(self) -> f64 {
        60.0 / self.dialect().most_per_minute
    }

    /// Digits of a contour error, no more than the control takes.
    pub fn digits(self, contour_error_mm: f64, reach_mm: f64) -> Digits {
        Digits::new(contour_error_mm, reach_mm).at_most(self.dialect().most_digits)
    }

    /// Name of the file of a program named `name`, the `number`th of its scene.
    pub fn file_name(self, name: &str, number: u32) -> String {
        let name = match self {
            Self::Siemens => siemens::program_name(name, number),
            _ => name.to_owned(),
        };
        format!("{name}.{}", self.dialect().extension)
    }
}

/// A comment in printable ASCII, round brackets left out, for they begin and end comments.
pub(crate) fn ascii(words: &str) -> String {
    let mut text = String::new();
    for c in words.chars() {
        match c {
            'µ' | 'μ' => text.push('u'),
            '°' => text.push_str(" deg"),
            '(' | ')' => text.push(' '),
            ' '..='~' => text.push(c),
            _ => text.push('?'),
        }
    }
    text
}
