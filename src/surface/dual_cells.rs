//! How a surface passes through a cube of eight nodes that are inside or outside: which of the twelve edges it crosses
//! together.
//!
//! Node bits: x + 2 y + 4 z. Edges: 0 to 3 along x (y + 2 z), 4 to 7 along y (x + 2 z), 8 to 11 along z (x + 2 y).
//! Edges that one sheet of the surface crosses carry the same label. Faces with the inside at two opposite nodes are
//! ambiguous; there the insides are kept apart, by the same rule in both cells that share the face. Every crossed edge
//! then has exactly one partner in each of its two faces, so each sheet is bounded by one closed chain of edges, and a
//! surface with one vertex per sheet and one polygon per crossed edge has exactly two polygons at every edge (dual
//! marching cubes: Nielson 2004).

use std::sync::LazyLock;

/// Label of an edge that is not crossed.
pub const NOT_CROSSED: u8 = u8::MAX;

/// Number of the edge along x at offsets (y, z) of a cell.
pub fn edge_x(y: usize, z: usize) -> usize {
    y + 2 * z
}

/// Number of the edge along y at offsets (x, z).
pub fn edge_y(x: usize, z: usize) -> usize {
    4 + x + 2 * z
}

/// Number of the edge along z at offsets (x, y).
pub fn edge_z(x: usize, y: usize) -> usize {
    8 + x + 2 * y
}

/// The two nodes of an edge.
fn nodes(edge: usize) -> [usize; 2] {
    let (a, b) = (edge & 1, edge >> 1 & 1);
    match edge >> 2 {
        0 => [2 * a + 4 * b, 1 + 2 * a + 4 * b],
        1 => [a + 4 * b, a + 2 + 4 * b],
        _ => [a + 2 * b, a + 2 * b + 4],
    }
}

/// Labels of the twelve edges for each pattern of inside nodes.
static LABELS: LazyLock<Vec<[u8; 12]>> = LazyLock::new(|| (0..256).map(|pattern| label(pattern as u8)).collect());

/// Labels of the edges of a cell with these nodes inside.
pub fn labels(pattern: u8) -> &'static [u8; 12] {
    &LABELS[usize::from(pattern)]
}

fn label(pattern: u8) -> [u8; 12] {
    let inside = |node: usize| pattern >> node & 1 == 1;
    let crossed = |edge: usize| inside(nodes(edge)[0]) != inside(nodes(edge)[1]);
    let mut labels = [NOT_CROSSED; 12];
    for edge in (0..12).filter(|&e| crossed(e)) {
        labels[edge] = edge as u8;
    }
    for face in 0..6 {
        let (axis, side) = (face >> 1, face & 1);
        let in_face = |node: usize| node >> axis & 1 == side;
        let edges: Vec<usize> = (0..12).filter(|&e| nodes(e).iter().all(|&n| in_face(n)) && crossed(e)).collect();
        for (i, &a) in edges.iter().enumerate() {
            for &b in &edges[i + 1..] {
                let shared = nodes(a).into_iter().find(|n| nodes(b).contains(n));
                // Two crossed edges belong together; of four, those that meet at an inside node.
                if edges.len() == 2 || shared.is_some_and(inside) {
                    let (from, to) = (labels[a].max(labels[b]), labels[a].min(labels[b]));
                    labels.iter_mut().filter(|l| **l == from).for_each(|l| *l = to);
                }
            }
        }
    }
    labels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheets_are_closed_chains_and_opposites_are_kept_apart() {
        for pattern in 0..=255_u8 {
            let labels = labels(pattern);
            for (edge, &label) in labels.iter().enumerate() {
                let [a, b] = nodes(edge);
                assert_eq!(label == NOT_CROSSED, (pattern >> a & 1) == (pattern >> b & 1));
            }
        }
        // One corner: one sheet of three edges. Opposite corners: two sheets.
        assert_eq!([edge_x(0, 0), edge_y(0, 0), edge_z(0, 0)].map(|edge| labels(1)[edge]), [0; 3]);
        let mut sheets: Vec<u8> = labels(0b1000_0001).iter().copied().filter(|&l| l != NOT_CROSSED).collect();
        sheets.sort_unstable();
        sheets.dedup();
        assert_eq!(sheets.len(), 2);
        // Two diagonal corners of one face.
        assert_ne!(labels(0b0000_1001)[edge_x(0, 0)], labels(0b0000_1001)[edge_x(1, 0)]);
    }
}
