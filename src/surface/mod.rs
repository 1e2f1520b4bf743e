//! Surfaces of the cut gear as triangles.
//!
//! In: fields with what the operations left on them. Out: [`Mesh`]es in the gear frame, which files and pictures are made of.
//!
//! | what | where |
//! | --- | --- |
//! | the whole gear as one closed mesh, from the blank field | [`blank_mesh`] |
//! | triangles with named values and parts; is it closed, volume, area | [`mesh`] |
//! | one flank or root as a grid, thinned out to the spacing of meshes | [`flanks`] |
//! | the fields of roots and tip lands | [`gear_surfaces`] |
//! | all of them in one closed chain of columns | [`outline`] |
//! | the gear as one closed body | [`gear_solid`] |
//! | the section of the half-cut work | [`section`] |
//! | pictures of meshes | [`render`] |
//! | the target gear, thinned out for the report's 3D view | [`view_mesh`] |

pub mod blank_mesh;
mod dual_cells;
pub mod flanks;
pub mod gear_solid;
pub mod gear_surfaces;
pub mod mesh;
pub mod outline;
pub mod render;
pub mod section;
pub mod view_mesh;

pub use blank_mesh::BlankMesh;
pub use flanks::SurfaceGrid;
pub use mesh::Mesh;
