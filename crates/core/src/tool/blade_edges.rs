//! The edges of a tool's blades: one that all share, or several, and which blade has which.
//!
//! In: edges in their blade frames, and the pattern in which the blades have them. Out: the edge of every blade, and
//! the segments of all edges in one list, one edge after another. Records of passes name a segment by its place in that
//! list, so that a backend looks up one table and knows nothing of blades.
//!
//! What bounds and outlines ask of the edges follows from them alone. It is found when it is first asked for and kept
//! with them: a tool cuts hundreds of fields.
//!
//! The road not taken: an edge number beside the segment's in every record. It would be one more look-up for each
//! record, and kernels would have to know what an edge is.

use super::closed_tooth::ToothPolygon;
use super::edge::{Edge, Segment};
use super::segment_course::SegmentCourse;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// Edges of a tool.
#[derive(Debug, Clone)]
pub struct BladeEdges {
    edges: Vec<Edge>,
    /// First segment of every edge in `segments`.
    first: Vec<usize>,
    segments: Arc<[Segment]>,
    pattern: Vec<usize>,
    courses: Arc<OnceLock<Vec<SegmentCourse>>>,
    outlines: Arc<OnceLock<Vec<ToothPolygon>>>,
}

impl BladeEdges {
    /// One edge for all blades.
    pub fn shared(edge: Edge) -> Self {
        Self::in_turn(vec![edge])
    }

    /// Blade 0 has the first edge, blade 1 the second one, and so on, round and round.
    ///
    /// # Panics
    /// No edge.
    pub fn in_turn(edges: Vec<Edge>) -> Self {
        let pattern = (0..edges.len()).collect();
        Self::new(edges, pattern)
    }

    /// Blade b has the edge with the number `pattern[b mod n]`, n the length of the pattern.
    ///
    /// # Panics
    /// An empty pattern, or one that names an edge that is not there.
    pub fn new(edges: Vec<Edge>, pattern: Vec<usize>) -> Self {
        assert!(!pattern.is_empty(), "a tool has at least one edge");
        assert!(pattern.iter().all(|&edge| edge < edges.len()), "the pattern names edges that are there");
        let ends = edges.iter().scan(0, |end, edge| {
            let first = *end;
            *end += edge.segments.len();
            Some(first)
        });
        let first = ends.collect();
        let segments = edges.iter().flat_map(|edge| edge.segments.iter().cloned()).collect();
        Self { edges, first, segments, pattern, courses: Arc::default(), outlines: Arc::default() }
    }

    /// The different edges.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Segments of all edges, one edge after another.
    pub fn segments(&self) -> &Arc<[Segment]> {
        &self.segments
    }

    /// Their courses without roughness, in the same order.
    pub fn courses(&self) -> &[SegmentCourse] {
        self.courses.get_or_init(|| self.segments.iter().map(SegmentCourse::new).collect())
    }

    /// The teeth of the different edges, closed through the tool's body to its axis.
    pub fn outlines(&self) -> &[ToothPolygon] {
        self.outlines.get_or_init(|| self.edges.iter().map(ToothPolygon::new).collect())
    }

    /// Number of a blade's edge.
    pub fn index_of(&self, blade: u32) -> usize {
        self.pattern[blade as usize % self.pattern.len()]
    }

    /// A blade's edge.
    pub fn edge_of(&self, blade: u32) -> &Edge {
        &self.edges[self.index_of(blade)]
    }

    /// Where the segments of a blade's edge stand in [`Self::segments`].
    pub fn segments_of(&self, blade: u32) -> Range<usize> {
        let edge = self.index_of(blade);
        self.first[edge]..self.first[edge] + self.edges[edge].segments.len()
    }

    /// Largest radius of the circles that hold the edges, mm.
    pub fn largest_reach_mm(&self) -> f64 {
        self.edges.iter().map(|edge| edge.reach_mm).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::edge::SegmentName;
    use glam::DVec2;

    fn edge(corners_mm: &[[f64; 2]]) -> Edge {
        let line = |ends: &[[f64; 2]]| Segment::straight(SegmentName::Tip, ends[0].into(), ends[1].into());
        Edge::new(corners_mm.windows(2).map(line).collect())
    }

    #[test]
    fn every_blade_finds_its_own_segments_among_all() {
        let (long, short) = (edge(&[[0.0, -2.0], [3.0, -1.0], [3.0, 1.0]]), edge(&[[0.0, 1.0], [2.0, 0.5]]));
        let edges = BladeEdges::new(vec![long.clone(), short.clone()], vec![0, 1, 1]);
        for (blade, edge) in [&long, &short, &short, &long, &short].into_iter().enumerate() {
            assert_eq!(edges.edge_of(blade as u32), edge, "blade {blade}");
            assert_eq!(edges.segments()[edges.segments_of(blade as u32)], edge.segments, "blade {blade}");
        }
        assert_eq!(edges.segments().len(), 3);
        assert!((edges.largest_reach_mm() - long.reach_mm).abs() < 1e-15 && long.reach_mm > short.reach_mm);
        let shared = BladeEdges::shared(short.clone());
        assert!((0..4).all(|blade| shared.segments_of(blade) == (0..1) && *shared.edge_of(blade) == short));
        assert_eq!(shared.edges()[0].center_mm, DVec2::new(1.0, 0.75));
    }
}
