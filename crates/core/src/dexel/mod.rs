//! Dexels: rays with what is left on them.
//!
//! A [`Field`] holds rays along the normals of a target curve, column by column along the profile and row by row along
//! the tooth; a [`SpatialField`] holds rays that differ from row to row as well. A [`Layer`] holds, per ray and
//! operation, the height that is left and the pass that left it. A [`BlankField`] holds rays through the whole blank
//! with all spans of material on them, and [`removal`] tells when they go. [`figures`] are what measures need of a
//! field where its dexels stay on a device.

pub mod blank_field;
pub mod field;
pub mod figures;
pub mod intervals;
pub mod placed_rays;
pub mod removal;
pub mod span_table;
pub mod spatial;

pub use blank_field::{BlankField, BlankGrid};
pub use field::{Column, Field, Layer, NO_PASS};
pub use placed_rays::{FreeRays, PlacedRays, RayGrid};
pub use spatial::{Ray, SpatialField};
