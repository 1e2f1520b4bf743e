//! One tooth of a cutter as a closed region of the transverse plane: its edge, closed inwards through the cutter's
//! body.
//!
//! In: the blade's [`Edge`]. Out: nodes and pieces for [`crate::math::planar_rays`], in the blade frame, and the curve
//! in any pose. From the ends of the edge two straight lines run towards the blade's origin, the cutter's axis, to a
//! radius that the blank never reaches; so whatever of the blank lies in the cutter lies in the region of one of its
//! teeth, and the lines themselves never meet material that the edge has not taken.
//!
//! Pieces turn by at most `PIECE_TURN_RAD`, which makes the chord a good guess for Newton's method and leaves at most
//! one place in a piece where it runs along a ray, and they lie within `CUBIC_MM` of the cubic through their ends,
//! which stands for them in f32 kernels. Roughness of an edge is left out: a blank is cut some ten times coarser.

use super::edge::{Edge, Segment};
use crate::frame::Rigid2;
use crate::math::planar_rays::{ClosedCurve, Piece};
use glam::DVec2;

/// Largest turn of the tangent within a piece: 3 degrees of an arc of 30 mm stay within 10 um of their chord. Half as
/// much doubles the pieces and saves no Newton step.
const PIECE_TURN_RAD: f64 = 0.05;

/// Largest distance of a piece from the cubic through its ends and end tangents, mm: a fraction of what f32 resolves 70
/// mm from the axis.
const CUBIC_MM: f64 = 1e-6;

/// A piece stays within this many arrow heights at its middle of its chord. Pieces lie within [`CUBIC_MM`] of the cubic
/// through their ends and end tangents, whose distance from the chord is t (1 - t) ((1 - t) a + t b) with the slopes a
/// and b at its ends: at the middle (a + b) / 8, at most 4/27 max(a, b) anywhere. The ratio is 32/27 where one slope is
/// 0, and below that where both turn the same way, as on a convex edge; the rest is for [`CUBIC_MM`].
const SAGITTA_SAFETY: f64 = 1.5;
/// Added to arrow heights, mm: rounding.
const ROUNDING_MM: f64 = 1e-9;

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
        let segments: Vec<Segment> = edge.segments.iter().map(Segment::smoothed).collect();
        for (law, segment) in segments.iter().enumerate() {
            for range in subdivide(segment, segment.y_range_mm) {
                let [start, middle, end] = [range[0], 0.5 * (range[0] + range[1]), range[1]].map(|y| place(segment, y));
                nodes_mm.push(start[0]);
                tangents.push([start[1], end[1]]);
                let chord = (end[0] - start[0]).normalize_or_zero();
                let sagitta_mm = SAGITTA_SAFETY * chord.perp_dot(middle[0] - start[0]).abs() + ROUNDING_MM;
                pieces.push(Piece { law: law as u32, range, sagitta_mm });
            }
        }
        let ends = [segments.last(), segments.first()];
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
        Self { segments, pieces, nodes_mm, tangents, center_mm, reach_mm }
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

/// A tooth through the tool's body to its axis, as a polygon in the blade frame.
#[derive(Debug, Clone)]
pub struct ToothPolygon {
    /// Its corners, mm.
    pub corners_mm: Vec<DVec2>,
    /// The box that holds them: most places lie outside of it.
    box_mm: [DVec2; 2],
}

impl ToothPolygon {
    /// Of an edge.
    pub fn new(edge: &Edge) -> Self {
        let corners_mm = ClosedTooth::new(edge, 0.0).nodes_mm;
        let nowhere = [DVec2::INFINITY, DVec2::NEG_INFINITY];
        let box_mm = corners_mm.iter().fold(nowhere, |[low, high], node| [low.min(*node), high.max(*node)]);
        Self { corners_mm, box_mm }
    }

    /// Whether it holds a place.
    pub fn holds(&self, p: DVec2) -> bool {
        let [low, high] = self.box_mm;
        if p.cmplt(low).any() || p.cmpgt(high).any() {
            return false;
        }
        let Some(mut a) = self.corners_mm.last() else { return false };
        let mut is_inside = false;
        for b in &self.corners_mm {
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                is_inside = !is_inside;
            }
            a = b;
        }
        is_inside
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

/// Ranges of y that turn little enough and are near enough to cubics.
fn subdivide(segment: &Segment, [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let length = to - from;
    let [start, end] = [from, to].map(|y| segment.x_and_slope(y));
    let turn_rad = (start[1].atan() - end[1].atan()).abs();
    let hermite = |t: f64| {
        let (a, b) = (start[1] * length, end[1] * length);
        let run = end[0] - start[0];
        start[0] + t * (a + t * (3.0 * run - 2.0 * a - b + t * (a + b - 2.0 * run)))
    };
    let off = |t: f64| (hermite(t) - segment.x_and_slope(from + t * length)[0]).abs();
    let near = [0.25, 0.5, 0.75].into_iter().all(|t| off(t) < CUBIC_MM);
    // A tenth of a micrometre is no place for another node, whatever the tables say there.
    if (turn_rad <= PIECE_TURN_RAD && near) || length < 1e-4 {
        return vec![[from, to]];
    }
    let middle = 0.5 * (from + to);
    [subdivide(segment, [from, middle]), subdivide(segment, [middle, to])].concat()
}
