//! G-code for a three-axis CNC gear shaper: written from a stroke schedule, and read back into axis positions.
//!
//! The programs move three axes while the ram runs: `X` centre distance (mm), `C` work spindle and `B` cutter spindle
//! (deg). Signs are those of the machine: the work turns by -psi_c, so C = -psi_c, and B = psi_b, both
//! counter-clockwise seen from above, from where the ram comes. Blocks are straight lines in all axes at once and last
//! whole double strokes, in inverse time (`G93`: F = 1 / minutes), so that ram and feed stay in step whatever the axes
//! do.
//!
//! In: [`AxisProgram::fit`] takes a schedule and the **contour error**, the largest displacement that straight lines
//! may cause anywhere on the cutter's flanks. Out: the text (`programs`), and from any such text the axis
//! positions at every stroke ([`read::program`]). A scene's operation can name a program; the gear is then cut as the
//! program says, and the program is judged ([`judge`]).
//!
//! The dialect that is read: `G0`, `G1`, `G4 P` (dwell, s), `G21`, `G90`, `G93`, `G94`, `M3`, `M5`, `M2`, `M30`, words
//! `N S F X B C`, comments in round brackets or after `;`, `%`. Everything else is refused by line and word: a word
//! that is passed over may be the one that matters.
//!
//! Where the axes draw the cutter back for the return strokes (`machine.retraction`), that is in the program as well,
//! in four blocks to a double stroke ([`retracting`]), and a program that is read back says where the cutter returns.
//!
//! Road not taken: one point per stroke. It is exact, and at 4,200 strokes it starves the block buffer of older
//! controls; straight lines within a micrometre need a tenth.

pub mod between;
pub mod judge;
pub mod program;
pub mod read;
pub mod retracting;

pub use judge::Judgement;
pub use program::{AxisProgram, Knot};
