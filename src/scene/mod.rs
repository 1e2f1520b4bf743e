//! Scene text to checked values: every key present, in range and in internal units, or a list of all problems.
//!
//! In: a TOML file, `--set` arguments, and the [`KeyTable`] of the keys that processes list. Out: a [`LoadedScene`],
//! which holds the [`Scene`] for the computation, can point at any key again when geometry refuses it, and can write
//! the scene back with every default filled in. No process is known by name: each brings its `SceneProcess`.
//!
//! The path of a text: `tree` (TOML with places) -> `overrides` (`--set`) -> `walk` (against the [`KeyTable`]) ->
//! `foreign` (keys of other processes) -> `points` (CSV) -> `checks` (values against each other) -> `build` (the
//! model). What was written and what it means are two types; only `build` knows both. Defaults that follow from other
//! keys, checks and `build` have a part here for what all processes share, and one in every process.

pub(crate) mod build;
mod check;
mod checks;
pub mod draft;
#[cfg(not(feature = "testing"))]
pub(crate) mod error_parameters;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod error_parameters;
#[cfg(not(feature = "testing"))]
pub(crate) mod error_sources;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod error_sources;
pub mod errors;
mod foreign;
#[cfg(not(feature = "testing"))]
pub(crate) mod keys;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod keys;
mod loaded;
pub(crate) mod machine_errors;
mod mate;
pub mod model;
mod overrides;
mod parameters;
mod points;
pub(crate) mod problems;
mod process;
#[cfg(not(feature = "testing"))]
pub(crate) mod reference;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod reference;
#[cfg(not(feature = "testing"))]
pub(crate) mod schema;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod schema;
mod shop_words;
mod sources;
pub mod suggest;
mod table;
mod template;
#[cfg(test)]
mod tests;
mod tree;
pub(crate) mod values;
mod walk;
mod write;

pub use errors::{Problem, SceneErrors, SourcePlace};
pub use loaded::{LoadedScene, Located, load, parse};
#[cfg(not(feature = "testing"))]
pub(crate) use mate::{Mate, MateScene};
#[cfg(feature = "testing")]
#[doc(hidden)]
pub use mate::{Mate, MateScene};
pub use model::{Post, Scene};
#[cfg(not(feature = "testing"))]
pub(crate) use process::{Copied, FINISH_ALONE, ProcessPart, ScenePart, SceneProcess, Senseless, StandardOperation};
#[cfg(feature = "testing")]
#[doc(hidden)]
pub use process::{Copied, FINISH_ALONE, ProcessPart, ScenePart, SceneProcess, Senseless, StandardOperation};
pub use table::{KeyTable, TableSection};
#[cfg(not(feature = "testing"))]
pub(crate) use template::template;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub use template::template;
