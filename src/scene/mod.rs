//! Scene text to checked values: every key present, in range and in internal units, or a list of all problems.
//!
//! In: a TOML file and `--set` arguments. Out: a [`LoadedScene`], which holds the [`Scene`] for the computation, can
//! point at any key again when geometry refuses it, and can write the scene back with every default filled in.
//!
//! The path of a text: `tree` (TOML with places) -> `overrides` (`--set`) -> `walk` (against the table in [`keys`]) ->
//! `points` (CSV) -> `checks` (values against each other) -> `build` (the model). What was written and what it means
//! are two types; only `build` knows both.

mod build;
mod check;
mod checks;
pub mod errors;
pub mod keys;
mod loaded;
pub mod model;
mod overrides;
mod points;
mod process;
pub mod reference;
pub mod schema;
mod sources;
mod suggest;
mod template;
mod tree;
mod values;
mod walk;
mod write;

pub use errors::{Place, Problem, SceneErrors};
pub use loaded::{LoadedScene, Located, load, parse};
pub use model::Scene;
pub use process::{PROCESSES, SceneProcess};
pub use template::template;
