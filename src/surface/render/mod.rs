//! Pictures of meshes: one ray caster on the processor, so that every machine makes the same picture.
//!
//! | what | where |
//! | --- | --- |
//! | which triangle any ray meets | [`bvh`] |
//! | boxes of surfaces that lean | `levelling` |
//! | parallel projection | [`camera`] |
//! | which triangle each of the camera's rays meets first | [`visible`] |
//! | bodies, their looks, what a ray finds | [`bodies`] |
//! | lamp, sky, pixels | [`light`] |
//!
//! Road not taken: drawing on the GPU. A picture must not depend on driver and adapter, and a second of the processor
//! is cheap beside the cut.

pub mod bodies;
pub mod bvh;
pub mod camera;
mod levelling;
pub mod light;
pub mod visible;

pub use bodies::{Appearance, Bodies, CLAY, STEEL, Shape};
pub use camera::Camera;
pub use light::{Lights, Rendered, Seen, bare_srgb, render, seen};
