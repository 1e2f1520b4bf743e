//! Studies: many scenes that differ in a few keys, and of each the quantities that are kept, as one row.
//!
//! In: a [`StudyPlan`], from a file ([`mod@file`]) or a command line ([`parameter`]). Out: `rows.csv`, a row for every
//! case ([`engine`]), and `columns.csv`, which says what its columns are; of a whole study also tables, results and a
//! page of what its parameters do to what is kept.
//!
//! The law: case `i` of a plan is always the same scene ([`plan`]), whoever makes it and when; so shards, runs that
//! were stopped and runs on other machines make the same rows, and merging them is laying their files together. A case
//! that cannot be cut is a row with the reason.
//!
//! Road not taken: a scheduler of its own. Shares of a plan (`--shard 2/8`) make any scheduler do.

pub mod design;
mod effects;
pub mod engine;
pub mod file;
mod findings;
pub mod kept;
pub mod map;
pub(crate) mod notices;
mod page;
pub mod pair;
pub mod parameter;
pub mod plan;
pub mod quantities;
mod rows;

pub use engine::{Study, StudyBase, StudyOutcome};
pub use parameter::{ParameterValues, StudyParameter};
pub use plan::{SampleDesign, Shard, StudyCommand, StudyPlan};
