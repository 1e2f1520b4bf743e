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
pub(crate) mod drawn_contour;
pub(crate) mod drawn_profile;
pub mod errors;
mod files;
mod foreign;
mod loaded;
pub(crate) mod machine_errors;
mod mate;
pub mod model;
mod motion_table;
mod overrides;
mod parameters;
mod points;
pub(crate) mod problems;
mod process;
mod shop_words;
mod sources;
pub mod suggest;
mod table;
mod template;
#[cfg(test)]
mod tests;
pub(crate) mod tool_wear;
mod tree;
pub(crate) mod values;
mod walk;
mod write;

cfg_if::cfg_if! {
    // Tests and benchmarks see them, other programs do not.
    if #[cfg(feature = "testing")] {
        pub mod error_parameters;
        pub mod error_sources;
        pub mod keys;
        pub mod reference;
        pub mod schema;
        pub use mate::{Mate, MateScene};
        pub use process::{Copied, FINISH_ALONE, ProcessPart, ScenePart, SceneProcess, Senseless, StandardOperation};
        pub use template::template;
    } else {
        pub(crate) mod error_parameters;
        pub(crate) mod error_sources;
        pub(crate) mod keys;
        pub(crate) mod schema;
        pub(crate) use mate::Mate;
        pub(crate) use process::{FINISH_ALONE, ProcessPart, ScenePart, SceneProcess, Senseless, StandardOperation};
        pub(crate) use template::template;
    }
}

pub use errors::{Problem, SceneErrors, SourcePlace};
pub use keys::Key;
pub use loaded::{LoadedScene, Located, load, parse};
pub use model::{Post, Scene};
pub use table::{KeyTable, TableSection};
