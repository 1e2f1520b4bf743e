//! A flank or root of a drawn tooth's envelope as a curve over its arc.
//!
//! In: points of an envelope with normals. Out: place and normal at an arc, on the cubic through two points with their
//! tangents.

use super::envelope::{EnvelopePoint, SAME_MM};
use gearcut_core::gear::blank::Blank;
use gearcut_core::math::roots::bisect;

/// A flank of a drawn tooth's envelope as a curve over its arc.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnFlank {
    points: Vec<EnvelopePoint>,
    arcs_mm: Vec<f64>,
}

impl DrawnFlank {
    /// Through points of an envelope.
    pub fn through(mut points: Vec<EnvelopePoint>) -> Self {
        points.dedup_by(|later, kept| later.is_same(kept));
        let mut arc_mm = 0.0;
        let mut arcs_mm = vec![0.0; points.len().min(1)];
        for pair in points.windows(2) {
            arc_mm += pair[0].point_mm.distance(pair[1].point_mm);
            arcs_mm.push(arc_mm);
        }
        Self { points, arcs_mm }
    }

    /// Its length, mm.
    pub fn length_mm(&self) -> f64 {
        self.arcs_mm.last().copied().unwrap_or(0.0)
    }

    /// Contact at an arc from its beginning (clamped to the flank): the cubic through two points with their tangents.
    pub fn at_arc(&self, arc_mm: f64) -> EnvelopePoint {
        let last = self.points.len() - 1;
        let arc_mm = arc_mm.clamp(0.0, self.length_mm());
        let index = self.arcs_mm.partition_point(|&arc| arc <= arc_mm).clamp(1, last.max(1)) - 1;
        let (a, b) = (&self.points[index], &self.points[(index + 1).min(last)]);
        let chord = b.point_mm - a.point_mm;
        let length_mm = chord.length().max(SAME_MM);
        let t = (arc_mm - self.arcs_mm[index]) / length_mm;
        let side = if a.normal.perp().dot(chord) < 0.0 { -1.0 } else { 1.0 };
        let [p, q] = [a, b].map(|at| side * length_mm * at.normal.perp());
        let (square, cube) = (3.0 * chord - 2.0 * p - q, p + q - 2.0 * chord);
        let along = p + t * (2.0 * square + t * 3.0 * cube);
        EnvelopePoint {
            phi_rad: a.phi_rad + t * (b.phi_rad - a.phi_rad),
            point_mm: a.point_mm + t * (p + t * (square + t * cube)),
            normal: -side * along.perp().normalize_or(side * -a.normal),
            part: a.part,
        }
    }

    /// The same up to a height over the pitch curve; `None` where it ends below, or begins above.
    pub fn up_to(self, blank: &Blank, top_mm: f64) -> Option<Self> {
        let height_mm = |at: &EnvelopePoint| blank.height(at.point_mm, at.phi_rad).0;
        let is_above = |at: &EnvelopePoint| blank.height(at.point_mm, at.phi_rad).0 >= top_mm;
        let above = self.points.iter().position(is_above).filter(|&index| index > 0)?;
        let arc_mm =
            bisect(|arc_mm| height_mm(&self.at_arc(arc_mm)) < top_mm, self.arcs_mm[above - 1], self.arcs_mm[above]);
        let tip = EnvelopePoint { part: self.points[above].part, ..self.at_arc(arc_mm) };
        Some(Self::through(self.points[..above].iter().copied().chain([tip]).collect()))
    }
}
