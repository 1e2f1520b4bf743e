//! G-code: the words, blocks and straight lines of programs, whatever the machine's axes are.
//!
//! What a program says of a machine belongs to the process; here is only how programs are written and read. Letters
//! and units of positions follow from the axes ([`crate::machine`]).

mod axes;
mod digits;
mod lines;
mod post;
mod script;
mod timed;
mod words;

pub use axes::beyond_limits;
pub use digits::Digits;
pub use lines::longest_lines;
pub use script::{AxisColumn, Ram, Script, StraightLine};
pub use timed::{TimedKnot, read_timed};
pub use words::{Word, blocks};
