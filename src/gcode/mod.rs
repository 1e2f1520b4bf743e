//! G-code: the words, blocks and straight lines of programs, whatever the machine's axes are.
//!
//! What a program says of a machine belongs to the process; here is only how programs are written and read. Letters
//! and units of positions follow from the axes ([`crate::machine`]).

mod axes;
mod digits;
mod file;
mod lines;
mod post;
mod script;
mod statement;
mod timed;
mod words;

pub use axes::beyond_limits;
pub use digits::Digits;
pub use file::read_file;
pub use lines::longest_lines;
pub(crate) use post::ascii;
pub use script::{AxisColumn, Ram, Script, StraightLine};
pub use statement::{Grammar, Move, ProgramArc, Statement, statements};
pub use timed::{TimedKnot, TimedProgram, read_timed};
