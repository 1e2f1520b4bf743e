//! Surfaces of the cut gear as triangles.
//!
//! In: fields with what the operations left on them. Out: [`Mesh`]es in the gear frame, which files and pictures are made of.
//!
//! | what | where |
//! | --- | --- |
//! | triangles with named values and parts; is it closed, volume, area | [`mesh`] |
//! | one flank or root as a grid, thinned out to the spacing of meshes | [`flanks`] |

pub mod flanks;
pub mod mesh;

pub use flanks::SurfaceGrid;
pub use mesh::Mesh;
