//! Triangles with values on their corners and names on their parts.
//!
//! Frame: the gear frame in space, mm; x and y are those of the transverse plane (phi = 0 along x, counter-clockwise),
//! z runs along the tooth, counted from the middle of the face. Triangles are counter-clockwise seen from outside the
//! material.
//!
//! A mesh is **closed** when every edge lies between exactly two triangles that run through it in opposite directions;
//! only then has it a volume. Positions are f64: written files are f32, whose ulp at 60 mm is 4 nm, but edges are told
//! apart by vertex numbers and never by places.
//!
//! Road not taken: half-edges. Nothing here edits a mesh; it is made once, checked, written and drawn.

use glam::DVec3;
use std::collections::HashMap;
use std::ops::Range;

/// Values of one quantity, one per vertex.
#[derive(Debug, Clone, PartialEq)]
pub enum ScalarValues {
    /// Measured; NaN where there is none.
    F32(Vec<f32>),
    /// Identifiers.
    U32(Vec<u32>),
}

/// A quantity on the vertices.
#[derive(Debug, Clone, PartialEq)]
pub struct Scalar {
    /// Name with the unit as suffix where there is one: `height_um`, `stock_mm`, `pass_id`.
    pub name: &'static str,
    /// Unit; `1` for identifiers.
    pub unit: &'static str,
    /// What the values are, in a sentence.
    pub definition: String,
    /// The values.
    pub values: ScalarValues,
}

/// A named run of triangles: a flank, a root, an end face.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshPart {
    /// Name, such as `tooth_07_left`.
    pub name: String,
    /// Its triangles.
    pub triangles: Range<usize>,
    /// Whether the vertices' values are the surface's own. An end face shares the vertices of the flanks round it, but
    /// not their heights.
    pub measured: bool,
}

/// Triangles in the gear frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// Corners, mm.
    pub positions_mm: Vec<DVec3>,
    /// Vertex numbers, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Quantities, each with one value per vertex.
    pub scalars: Vec<Scalar>,
    /// Parts, which follow each other and cover all triangles; within a part the surface is smooth.
    pub parts: Vec<MeshPart>,
}

/// What keeps a mesh from being closed; all zero when it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EdgeFaults {
    /// Edges with a triangle on one side only.
    pub open: usize,
    /// Edges with more than two triangles.
    pub crowded: usize,
    /// Edges whose two triangles run through them in the same direction.
    pub turned: usize,
    /// Triangles that use a vertex twice.
    pub degenerate: usize,
}

impl ScalarValues {
    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::F32(values) => values.len(),
            Self::U32(values) => values.len(),
        }
    }

    /// No value at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl Mesh {
    /// The quantity of this name.
    pub fn scalar(&self, name: &str) -> Option<&Scalar> {
        self.scalars.iter().find(|scalar| scalar.name == name)
    }

    /// Corners of a triangle, mm.
    pub fn corners_mm(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|vertex| self.positions_mm[vertex as usize])
    }

    /// Faults of the edges, counted.
    pub fn edge_faults(&self) -> EdgeFaults {
        let mut faults = EdgeFaults::default();
        // Per edge: triangles that run from the lower vertex number to the higher one, and those that run back.
        let mut edges: HashMap<(u32, u32), [u32; 2]> = HashMap::with_capacity(self.triangles.len() * 3 / 2);
        for &[a, b, c] in &self.triangles {
            if a == b || b == c || c == a {
                faults.degenerate += 1;
                continue;
            }
            for (from, to) in [(a, b), (b, c), (c, a)] {
                edges.entry((from.min(to), from.max(to))).or_default()[usize::from(from > to)] += 1;
            }
        }
        // Counts do not depend on the order of the map.
        for [forth, back] in edges.into_values() {
            match (forth, back) {
                (1, 1) => {}
                (1, 0) | (0, 1) => faults.open += 1,
                (2, 0) | (0, 2) => faults.turned += 1,
                _ => faults.crowded += 1,
            }
        }
        faults
    }

    /// Every edge has exactly two triangles, and they run through it in opposite directions.
    pub fn is_closed(&self) -> bool {
        !self.triangles.is_empty() && self.edge_faults() == EdgeFaults::default()
    }

    /// Enclosed volume, mm^3, by the divergence theorem; positive where triangles face outwards. Means nothing unless
    /// the mesh is closed.
    pub fn volume_mm3(&self) -> f64 {
        (0..self.triangles.len())
            .map(|t| {
                let [a, b, c] = self.corners_mm(t);
                a.dot(b.cross(c)) / 6.0
            })
            .sum()
    }

    /// Area of all triangles, mm^2.
    pub fn area_mm2(&self) -> f64 {
        (0..self.triangles.len()).map(|t| 0.5 * self.scaled_normal(t).length()).sum()
    }

    /// Outward normal of a triangle times twice its area, mm^2.
    pub fn scaled_normal(&self, triangle: usize) -> DVec3 {
        let [a, b, c] = self.corners_mm(triangle);
        (b - a).cross(c - a)
    }

    /// Lowest and highest corner of the box round all vertices, mm.
    pub fn bounds_mm(&self) -> Option<[DVec3; 2]> {
        let low = self.positions_mm.iter().copied().reduce(DVec3::min)?;
        let high = self.positions_mm.iter().copied().reduce(DVec3::max)?;
        Some([low, high])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Box from the origin to (2, 3, 4).
    fn block() -> Mesh {
        let positions_mm = (0..8_u8)
            .map(|i| DVec3::new(2.0 * f64::from(i & 1), 3.0 * f64::from(i >> 1 & 1), 4.0 * f64::from(i >> 2 & 1)))
            .collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Mesh { positions_mm, triangles, ..Mesh::default() }
    }

    #[test]
    fn a_block_is_closed_and_has_its_volume_and_area() {
        let block = block();
        assert!(block.is_closed());
        assert_eq!(block.volume_mm3(), 24.0);
        assert_eq!(block.area_mm2(), 52.0);
        assert_eq!(block.bounds_mm(), Some([DVec3::ZERO, DVec3::new(2.0, 3.0, 4.0)]));
    }

    #[test]
    fn every_way_of_not_being_closed_is_counted() {
        let mut open = block();
        open.triangles.pop();
        assert_eq!(open.edge_faults(), EdgeFaults { open: 3, ..EdgeFaults::default() });
        let mut turned = block();
        turned.triangles[0].reverse();
        assert_eq!(turned.edge_faults(), EdgeFaults { turned: 3, ..EdgeFaults::default() });
        let mut crowded = block();
        crowded.triangles.push([0, 3, 4]);
        let faults = crowded.edge_faults();
        assert!(faults.crowded > 0 && !crowded.is_closed(), "{faults:?}");
        let mut degenerate = block();
        degenerate.triangles.push([1, 1, 2]);
        assert_eq!(degenerate.edge_faults(), EdgeFaults { degenerate: 1, ..EdgeFaults::default() });
        assert!(!Mesh::default().is_closed());
    }
}
