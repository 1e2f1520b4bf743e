//! Bodies with straight walls over an area of the plane.
//!
//! In: contours, the area on their left. Out: a mesh of walls and two ends.

use super::mesh::{Mesh, MeshPart};
use super::plane_area::{sides_of_contours, triangles_inside};
use glam::DVec2;

/// Walls and two ends over contours, outer ones counter-clockwise and holes clockwise, between two heights, mm.
/// Contours that cross have walls alone.
pub fn prism(contours_mm: &[Vec<DVec2>], ends_mm: [f64; 2]) -> Mesh {
    let points_mm = contours_mm.concat();
    let sides = sides_of_contours(&contours_mm.iter().map(Vec::len).collect::<Vec<_>>());
    let total = points_mm.len() as u32;
    let positions_mm = ends_mm.iter().flat_map(|&z| points_mm.iter().map(move |p| p.extend(z))).collect();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for side in &sides {
        let [a, b] = side.map(|i| i as u32);
        triangles.extend([[a, b, b + total], [a, b + total, a + total]]);
    }
    let walls = triangles.len();
    for triangle in triangles_inside(&points_mm, &sides).unwrap_or_default() {
        let [a, b, c] = triangle.map(|i| i as u32);
        triangles.extend([[a, c, b], [a + total, b + total, c + total]]);
    }
    let part = |name: &str, triangles| MeshPart { name: name.to_owned(), triangles, measured: false };
    let parts = vec![part("wall", 0..walls), part("ends", walls..triangles.len())];
    Mesh { positions_mm, triangles, parts, ..Mesh::default() }
}
