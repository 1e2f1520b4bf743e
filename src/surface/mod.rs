//! Surfaces of the cut gear as triangles.
//!
//! In: fields with what the operations left on them. Out: [`Mesh`]es in the gear frame, which files and pictures are
//! made of.
//!
//! | what | where |
//! | --- | --- |
//! | the whole gear as one closed mesh, from the blank field | [`blank_mesh`] |
//! | triangles with named values and parts; is it closed, volume, area | [`mesh`] |
//! | one flank or root as a grid, thinned out to the spacing of meshes | [`flanks`] |
//! | all of them in one closed chain of columns | [`outline`] |
//! | the gear as one closed body | [`gear_solid`] |
//! | end faces of both bodies | [`plane_area`] |
//! | fewer triangles within a distance | [`decimated`] |
//! | pictures of meshes | [`render`] |

pub mod blank_mesh;
pub mod decimated;
mod dual_cells;
pub mod flanks;
pub mod gear_solid;
pub mod mesh;
pub mod outline;
pub mod plane_area;
pub mod prism;
pub mod render;
pub mod triangles;

pub use blank_mesh::BlankMesh;
pub use flanks::SurfaceGrid;
pub use mesh::Mesh;
