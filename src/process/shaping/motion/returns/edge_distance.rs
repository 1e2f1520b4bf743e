//! How far a point lies from a cutter tooth of any shape.
//!
//! In: the edge of a tooth, a point of its frame. Out: the distance from the nearest chord of the edge in mm, negative
//! inside. From both ends of the edge the tooth goes on towards the cutter's axis.
//!
//! Chords come in groups with a circle round each: most are passed over.

use gearcut_core::tool::edge::Edge;
use glam::DVec2;

/// Distance of chords from the edge, mm. Where the curvature of a segment is uneven they keep up to three times as
/// much: a tenth of what a contact is known to.
const CHORD_MM: f64 = 3e-5;
/// Chords of a group: the square root of those of an edge.
const GROUP: usize = 16;
/// The tooth is followed inwards to this share of where its edge ends.
const INNER_SHARE: f64 = 0.5;

/// An edge as far as distances need it.
#[derive(Debug, Clone)]
pub struct EdgeDistance {
    nodes_mm: Vec<DVec2>,
    /// First chord of every group, with a circle that holds its chords.
    groups: Vec<(usize, DVec2, f64)>,
}

impl EdgeDistance {
    /// Of an edge.
    pub fn new(edge: &Edge) -> Self {
        let edge_mm = edge.points_mm(CHORD_MM);
        let inner = |end: Option<&DVec2>| end.map(|at| INNER_SHARE * *at);
        let ends = [inner(edge_mm.first()), inner(edge_mm.last())];
        let mut nodes_mm: Vec<DVec2> = ends[0].into_iter().chain(edge_mm).chain(ends[1]).collect();
        nodes_mm.dedup_by(|later, kept| later.distance(*kept) < 1e-9);
        let group = |first: usize| {
            let nodes = &nodes_mm[first..=(first + GROUP).min(nodes_mm.len() - 1)];
            let center = nodes.iter().sum::<DVec2>() / nodes.len() as f64;
            (first, center, nodes.iter().map(|at| at.distance(center)).fold(0.0, f64::max))
        };
        let groups = (0..nodes_mm.len() - 1).step_by(GROUP).map(group).collect();
        Self { nodes_mm, groups }
    }

    /// Distance of a point, mm; negative inside.
    pub fn at_mm(&self, p: DVec2) -> f64 {
        let (mut nearest_mm2, mut at) = (f64::INFINITY, (0, 0.0));
        for &(first, center, radius_mm) in &self.groups {
            let least_mm = p.distance(center) - radius_mm;
            if least_mm > 0.0 && least_mm * least_mm >= nearest_mm2 {
                continue;
            }
            for i in first..(first + GROUP).min(self.nodes_mm.len() - 1) {
                let (a, b) = (self.nodes_mm[i], self.nodes_mm[i + 1]);
                let share = ((p - a).dot(b - a) / b.distance_squared(a)).clamp(0.0, 1.0);
                let mm2 = p.distance_squared(a.lerp(b, share));
                if mm2 < nearest_mm2 {
                    (nearest_mm2, at) = (mm2, (i, share));
                }
            }
        }
        let (i, share) = at;
        let chord = |i: usize| (self.nodes_mm[i + 1] - self.nodes_mm[i]).normalize_or_zero();
        // At a node both chords decide.
        let along = match share {
            0.0 if i > 0 => chord(i - 1) + chord(i),
            1.0 if i + 2 < self.nodes_mm.len() => chord(i) + chord(i + 1),
            _ => chord(i),
        };
        let away = p - self.nodes_mm[i].lerp(self.nodes_mm[i + 1], share);
        nearest_mm2.sqrt().copysign(-along.perp().dot(away))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::shaping::motion::returns::tooth_distance::ToothDistance;
    use crate::process::shaping::scene::model::Tip;
    use crate::process::shaping::tool::cutter::tests::paper_cutter;

    /// The same tooth by its chords and in closed form, about the edge and far from it.
    #[test]
    fn an_involute_tooth_is_as_far_as_in_closed_form() {
        for tip in [Tip::Sharp, Tip::Round { radius_mm: 0.6 }] {
            let cutter = paper_cutter(tip);
            let (chords, closed) = (EdgeDistance::new(cutter.edge()), ToothDistance::new(&cutter));
            let mut looked_at = 0;
            for i in 0..=60 {
                for j in -40..=40 {
                    let p = DVec2::new(28.5 + 0.1 * f64::from(i), 0.08 * f64::from(j));
                    let (found, expected) = (chords.at_mm(p), closed.at_mm(p));
                    // Inside, the closed form takes the largest of three distances: the nearest of the sides.
                    if expected.abs() < 0.6 {
                        assert!((found - expected).abs() < 3.0 * CHORD_MM, "{tip:?} {p}: {found} for {expected}");
                        looked_at += 1;
                    }
                }
            }
            assert!(looked_at > 1000, "{looked_at}");
        }
    }
}
