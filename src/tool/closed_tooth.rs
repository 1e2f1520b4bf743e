//! One tooth of a cutter as a closed region of the transverse plane: its edge, closed inwards through the cutter's body.
//!
//! In: the blade's [`Edge`]. Out: nodes and pieces for [`crate::planar_rays`], in the blade frame, and the curve in any pose. From the ends of the edge two straight lines
//! run towards the blade's origin, the cutter's axis, to a radius that the blank never reaches; so whatever of the blank lies in the cutter lies in the region of one of
//! its teeth, and the lines themselves never meet material that the edge has not taken.
//!
//! Pieces turn by at most [`PIECE_TURN_RAD`], which makes the chord a good guess for Newton's method and leaves at most one place in a piece where it runs along a ray.

use super::edge::{Edge, Segment};
use crate::frame::Rigid2;
use crate::planar_rays::{ClosedCurve, Piece};
use glam::DVec2;

/// Largest turn of the tangent within a piece: 3 degrees of an arc of 30 mm stay within 10 um of their chord. Half as much doubles the pieces and saves no Newton step.
const PIECE_TURN_RAD: f64 = 0.05;

/// Closed outline of a cutter tooth in the blade frame.
#[derive(Debug, Clone)]
pub struct ClosedTooth {
    segments: Vec<Segment>,
    pieces: Vec<Piece>,
    nodes_mm: Vec<DVec2>,
    tangents: Vec<[DVec2; 2]>,
    /// Circle that holds the edge: centre, blade frame. The rest of the outline never meets the blank.
    pub center_mm: DVec2,
    /// Its radius.
    pub reach_mm: f64,
}

impl ClosedTooth {
    /// Closes an edge through the body to `closing_radius_mm` from the blade's origin.
    pub fn new(edge: &Edge, closing_radius_mm: f64) -> Self {
        let (mut pieces, mut nodes_mm, mut tangents) = (Vec::new(), Vec::new(), Vec::new());
        for (law, segment) in edge.segments.iter().enumerate() {
            let [from, to] = segment.y_range_mm;
            let [first, last] = segment.slope_range.map(f64::atan);
            let count = ((last - first).abs() / PIECE_TURN_RAD).ceil().max(1.0);
            let at = |share: f64| from + (to - from) * share;
            for i in 0..count as u32 {
                let range = [at(f64::from(i) / count), at(f64::from(i + 1) / count)];
                let [start, middle, end] = [range[0], 0.5 * (range[0] + range[1]), range[1]].map(|y| place(segment, y));
                nodes_mm.push(start[0]);
                tangents.push([start[1], end[1]]);
                let chord = (end[0] - start[0]).normalize_or_zero();
                // The arrow height at the middle is the largest within some percent.
                let sagitta_mm = 1.5 * chord.perp_dot(middle[0] - start[0]).abs() + 1e-9;
                pieces.push(Piece { law: law as u32, range, sagitta_mm });
            }
        }
        let ends = [edge.segments.last(), edge.segments.first()];
        if let [Some(last), Some(first)] = ends {
            let end = place(last, last.y_range_mm[1])[0];
            let start = place(first, first.y_range_mm[0])[0];
            let inner = [end, start].map(|p| p * (closing_radius_mm / p.length()).min(1.0));
            for node in [end, inner[0], inner[1]] {
                nodes_mm.push(node);
                tangents.push([DVec2::ZERO; 2]);
                pieces.push(Piece { law: Piece::STRAIGHT, range: [0.0, 1.0], sagitta_mm: 0.0 });
            }
        }
        let (center_mm, reach_mm) = (edge.center_mm, edge.reach_mm);
        Self { segments: edge.segments.clone(), pieces, nodes_mm, tangents, center_mm, reach_mm }
    }

    /// The tooth where it stands in the work; `scratch` is reused from pose to pose.
    pub fn placed<'a>(&'a self, work_from_blade: &Rigid2, scratch: &'a mut PlacedScratch) -> PlacedTooth<'a> {
        scratch.nodes_mm.clear();
        scratch.nodes_mm.extend(self.nodes_mm.iter().map(|&p| work_from_blade.point(p)));
        scratch.work_from_segment.clear();
        scratch.work_from_segment.extend(self.segments.iter().map(|s| work_from_blade.after(&s.blade_from_segment)));
        PlacedTooth { tooth: self, work_from_blade: *work_from_blade, scratch }
    }
}

/// Memory of a [`PlacedTooth`].
#[derive(Debug, Default)]
pub struct PlacedScratch {
    nodes_mm: Vec<DVec2>,
    work_from_segment: Vec<Rigid2>,
}

/// A tooth in the gear frame.
#[derive(Debug)]
pub struct PlacedTooth<'a> {
    tooth: &'a ClosedTooth,
    work_from_blade: Rigid2,
    scratch: &'a PlacedScratch,
}

impl PlacedTooth<'_> {
    /// Nodes of the outline in the gear frame.
    pub fn nodes_mm(&self) -> &[DVec2] {
        &self.scratch.nodes_mm
    }
}

impl ClosedCurve for PlacedTooth<'_> {
    fn pieces(&self) -> &[Piece] {
        &self.tooth.pieces
    }

    fn node_mm(&self, index: usize) -> DVec2 {
        self.scratch.nodes_mm[index]
    }

    fn place(&self, law: u32, y_mm: f64) -> [DVec2; 2] {
        let frame = &self.scratch.work_from_segment[law as usize];
        let [x, slope] = self.tooth.segments[law as usize].x_and_slope(y_mm);
        [frame.point(DVec2::new(x, y_mm)), frame.direction(DVec2::new(slope, 1.0))]
    }

    fn tangents(&self, index: usize) -> [DVec2; 2] {
        self.tooth.tangents[index].map(|t| self.work_from_blade.direction(t))
    }
}

/// Point and derivative over y of a segment, in the blade frame.
fn place(segment: &Segment, y_mm: f64) -> [DVec2; 2] {
    let [x, slope] = segment.x_and_slope(y_mm);
    let frame = &segment.blade_from_segment;
    [frame.point(DVec2::new(x, y_mm)), frame.direction(DVec2::new(slope, 1.0))]
}
