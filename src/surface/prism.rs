//! Bodies with straight walls over an area of the plane.
//!
//! In: contours, the area on their left; or a blade of a turning tool. Out: a mesh of walls and two ends.

use super::mesh::{Mesh, MeshPart};
use super::plane_area::{sides_of_contours, triangles_inside};
use gearcut_core::tool::SpatialTool;
use glam::{DVec2, DVec3};

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

/// A blade of a tool that turns clockwise or counter-clockwise (-1, +1) about its z axis: its edge, closed behind its
/// ends, and so much of it behind its rake face, mm; tool frame. Chords lie within `chord_mm` of the edge.
pub fn blade(tool: &dyn SpatialTool, index: u32, turn: f64, behind_mm: f64, chord_mm: f64) -> Mesh {
    let place = tool.tool_from_blade(index);
    let edge = tool.edge_of(index);
    let forward = turn * DVec3::Z.cross(place.point(edge.center_mm.extend(0.0)));
    let ends_mm = if place.rotation.z_axis.dot(forward) > 0.0 { [-behind_mm, 0.0] } else { [0.0, behind_mm] };
    let mut mesh = prism(&[edge.points_mm(chord_mm)], ends_mm);
    mesh.positions_mm.iter_mut().for_each(|at| *at = place.point(*at));
    mesh
}
