//! Dexels: rays with what is left on them.
//!
//! A [`Field`] holds rays along the normals of a target curve, column by column along the profile and row by row along the tooth; a [`SpatialField`] holds rays that
//! differ from row to row as well. A [`Layer`] holds, per ray and operation, the height that is left and the pass that left it.

pub mod field;
pub mod spatial;

pub use field::{Column, Field, Layer, NO_PASS};
pub use spatial::{Ray, SpatialField};
