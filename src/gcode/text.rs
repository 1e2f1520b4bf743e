//! A program as text.

use std::fmt::Write;

/// A program as it grows: comments at its head, then numbered blocks between tape ends.
pub struct ProgramText {
    text: String,
    number: u32,
}

impl ProgramText {
    /// Head only: what it says of itself, then what must be known before it is run, a comment each.
    pub fn new(head: &[String], warnings: impl IntoIterator<Item = String>) -> Self {
        let mut text = "%\n".to_owned();
        for line in head.iter().cloned().chain(warnings) {
            // Round brackets end a comment.
            let _ = writeln!(text, "({})", line.replace(['(', ')'], " "));
        }
        Self { text, number: 0 }
    }

    /// One more block.
    pub fn block(&mut self, words: &str) {
        self.number += 10;
        let _ = writeln!(self.text, "N{} {words}", self.number);
    }

    /// The whole text.
    pub fn finish(self) -> String {
        self.text + "%\n"
    }
}
