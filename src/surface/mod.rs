//! Surfaces of the cut gear as triangles.
//!
//! In: fields with what the operations left on them. Out: [`Mesh`]es in the gear frame, which files and pictures are made of.
//!
//! | what | where |
//! | --- | --- |
//! | triangles with named values and parts; is it closed, volume, area | [`mesh`] |
//! | one flank or root as a grid, thinned out to the spacing of meshes | [`flanks`] |
//! | the fields of roots and tip lands | [`gear_surfaces`] |
//! | all of them in one closed chain of columns | [`outline`] |
//! | the gear as one closed body | [`gear_solid`] |
//! | the section of the half-cut work | [`section`] |
//! | pictures of meshes | [`render`] |

pub mod flanks;
pub mod gear_solid;
pub mod gear_surfaces;
pub mod mesh;
pub mod outline;
pub mod render;
pub mod section;

pub use flanks::SurfaceGrid;
pub use mesh::Mesh;
