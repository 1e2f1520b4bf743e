//! Sections of hob teeth as fine polygons: no rays, no normals of surfaces.

use gearcut::math::planar_rays::{ClosedCurve, Piece};
use gearcut::passes::sections::swept_sections::SweptSection;
use gearcut::process::hobbing::HobCutter;
use glam::DVec2;

/// Distance of the corners of sections, mm. Clouds of points that they are compared with stand as near, so that two
/// sections that nearly coincide hold each other's points alike.
pub const STEP_MM: f64 = 0.04;

/// Height of the rows in which sides of a polygon are looked for, mm. It decides about time alone.
const ROW_MM: f64 = 0.2;

/// Visits the sections of all passes of the first operation that come within `reach_mm` of a place in the slice
/// `z_mm`, in order of time, as they are and as polygons.
pub fn sections_near(
    cutter: &HobCutter,
    z_mm: f64,
    place: DVec2,
    reach_mm: f64,
    mut visit: impl FnMut(&SweptSection, Polygon),
) {
    let sections = cutter.sections(0, true).expect("a hob");
    let mut section = SweptSection::default();
    for index in 0..sections.len() {
        if !sections.section(index, z_mm, &mut section) {
            continue;
        }
        let polygon = Polygon::new(&section);
        if (polygon.low - reach_mm).cmple(place).all() && (polygon.high + reach_mm).cmpge(place).all() {
            visit(&section, polygon);
        }
    }
}

/// A section as a polygon.
pub struct Polygon {
    corners: Vec<DVec2>,
    /// Corners at which sides end, by rows of `ROW_MM` from the lowest on that the sides cross: a point is asked for
    /// in one row.
    sides: Vec<Vec<u32>>,
    /// Points of the edge.
    pub of_edge: Vec<EdgePoint>,
    /// Smallest coordinates.
    pub low: DVec2,
    /// Largest coordinates.
    pub high: DVec2,
}

/// A point of the edge in a section.
pub struct EdgePoint {
    /// Where it stands.
    pub place: DVec2,
    /// Direction into the tool.
    pub inward: DVec2,
    /// Length of the section's border that it stands for, mm.
    pub length_mm: f64,
}

impl Polygon {
    /// The polygon of a section.
    pub fn new(section: &SweptSection) -> Self {
        let (mut corners, mut of_edge) = (Vec::new(), Vec::new());
        for (index, piece) in section.pieces().iter().enumerate() {
            let start = section.node_mm(index);
            if piece.law == Piece::STRAIGHT {
                corners.push(start);
                continue;
            }
            let length_mm = start.distance(section.node_mm(index + 1));
            let count = (length_mm / STEP_MM).ceil().max(2.0) as u32;
            for i in 0..count {
                let [place, rate] = section.place(piece.law, f64::from(i) / f64::from(count));
                corners.push(place);
                // Inside is on the left.
                let inward = rate.perp().normalize();
                of_edge.push(EdgePoint { place, inward, length_mm: rate.length() / f64::from(count) });
            }
        }
        let low = corners.iter().fold(DVec2::INFINITY, |a, &b| a.min(b));
        let high = corners.iter().fold(DVec2::NEG_INFINITY, |a, &b| a.max(b));
        let row = |y: f64| ((y - low.y) / ROW_MM) as usize;
        let mut sides = vec![Vec::new(); row(high.y) + 1];
        for end in 0..corners.len() {
            let [a, b] = [corners[(end + corners.len() - 1) % corners.len()].y, corners[end].y];
            sides[row(a.min(b))..=row(a.max(b))].iter_mut().for_each(|row| row.push(end as u32));
        }
        Self { corners, sides, of_edge, low, high }
    }

    /// Whether a point lies inside.
    pub fn holds(&self, p: DVec2) -> bool {
        if p.cmplt(self.low).any() || p.cmpgt(self.high).any() {
            return false;
        }
        let mut inside = false;
        for &end in &self.sides[((p.y - self.low.y) / ROW_MM) as usize] {
            let (end, count) = (end as usize, self.corners.len());
            let [a, b] = [self.corners[(end + count - 1) % count], self.corners[end]];
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                inside = !inside;
            }
        }
        inside
    }
}
