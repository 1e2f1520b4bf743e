//! Pictures of meshes: one ray caster on the processor, so that every machine makes the same picture.
//!
//! | what | where |
//! | --- | --- |
//! | which triangle a ray meets | [`bvh`] |
//! | parallel projection | [`camera`] |
//! | bodies, their looks, what a ray finds | [`bodies`] |
//! | lamp, sky, pixels | [`light`] |
//!
//! Road not taken: drawing on the GPU. A picture must not depend on driver and adapter, and a second of the processor
//! is cheap beside the cut.

pub mod bodies;
pub mod bvh;
pub mod camera;
pub mod light;

pub use bodies::{Appearance, Bodies, CLAY, STEEL, Shape};
pub use camera::Camera;
pub use light::{Lights, Rendered, render};
