//! Surfaces of the cut gear in space.
//!
//! In: the job. Out: points, normals and triangles in the work frame (origin on the gear axis in the middle of the face, z along the axis, mm).

pub mod view_mesh;
