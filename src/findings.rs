//! What a run found: one tree of sections with quantities and tables, made once and rendered many times.
//!
//! In: quantities that a process fills in, each with unit and definition. Out: [`Findings`]. `results.json`, the
//! summary on the terminal, the report's numbers and comparisons read this tree and compute nothing of their own, so
//! that what joins the tree joins all of them.
//!
//! A path names a part of the tree: keys joined by dots, such as `operations.rough.relief.largest_beta`. It is the
//! path in `results.json` under `sections`, and the name of the line in a comparison.
//!
//! Two measures are told apart everywhere. A **normal deviation** is measured from the target, the envelope of
//! the last operation. A **stock** is what an operation leaves over the finished surface. Both run along the target's
//! normal, positive where material is.
//!
//! Roads not taken: a struct for each process, which every renderer had to know; headline numbers marked by a level
//! inside their sections, which a file with the headline first would have to move or to repeat.

pub mod column;
pub mod damage;
pub mod datum;
pub mod entry;
mod json;
pub mod notice;
pub(crate) mod notices;
pub mod place;
pub mod quantities;
pub mod quantity;
mod read;
pub mod row;
pub mod table;
pub mod tree;
pub mod unit;

pub use column::{TableCell, TableCells};
pub use datum::Datum;
pub use entry::{Advice, Entry};
pub use json::{RESULTS_FILE, SCHEMA, SCHEMA_VERSION};
pub use notice::{Notice, Severity};
pub use place::{Coordinate, Place};
pub use quantity::Quantity;
pub(crate) use row::rows;
pub use row::{ColumnChart, Level, QuantityGroup, QuantityRow};
pub use table::{Columns, Table, TableColumn};
pub use tree::{Findings, Section};
