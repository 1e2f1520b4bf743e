//! The cutter tooth as a polygon: corners to cut with, stations to measure at, and a zone for every
//! family of rays.
//!
//! In: a blade's [`Edge`]. Out, all in the blade frame: the edge as chords that stay within `CHORD_MM` of it, closed
//! through the tool's axis; **stations** in the middle of equal steps along the edge, with exact point and normal; and
//! the **tip zone**, the part of the tooth that lies nearer to its tip than to its flanks.
//!
//! Why zones: a chip of ten micrometres under the tip lies between two rays that run along it, and is seen by one
//! stroke in five. Rays across it see it always. So the chip's area is counted by the rays along the tooth inside the
//! tip zone and by the rays across the tooth outside of it; the zones are disjoint and fill the tooth, so nothing is
//! counted twice.

use gearcut_core::passes::sections::swept_sections::{EDGE_PLACES, FLANK_PLACES};
use gearcut_core::tool::edge::{Edge, Segment, SegmentName};
use glam::DVec2;

/// Largest distance of a chord from the edge: the same chords cut every stroke, so that thicknesses keep far less of
/// it.
const CHORD_MM: f64 = 2e-5;

/// Part of the edge that results tell apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EdgeSide {
    /// Right flank with the base and root beside it.
    Right,
    /// Tip circle and tip corners.
    Tip,
    /// Left flank with the base and root beside it.
    Left,
}

impl EdgeSide {
    /// All sides in the order of the edge.
    pub const ALL: [Self; 3] = [Self::Right, Self::Tip, Self::Left];

    /// The part that a segment belongs to.
    pub fn of(name: SegmentName) -> Self {
        match name {
            SegmentName::RootRight | SegmentName::BaseRight | SegmentName::FlankRight => Self::Right,
            SegmentName::CornerRight | SegmentName::Tip | SegmentName::CornerLeft => Self::Tip,
            SegmentName::FlankLeft | SegmentName::BaseLeft | SegmentName::RootLeft => Self::Left,
        }
    }
}

/// A place of the edge at which chips are measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Parameter of the polygon: chord number and share of the chord.
    pub parameter: f64,
    /// Arc from the middle of the tip, mm; positive on the left.
    pub arc_mm: f64,
    /// Length of edge that it stands for, mm.
    pub length_mm: f64,
    /// Point of the edge, mm.
    pub point_mm: DVec2,
    /// Unit normal out of the tool.
    pub normal: DVec2,
    /// Part of the edge.
    pub side: EdgeSide,
    /// Distance along the edge to the nearest other part, mm.
    pub to_corner_mm: f64,
    /// Place of the edge in whose wear it counts, below [`EDGE_PLACES`]: right flank from its depth, tip, left flank to
    /// its depth; a flank has [`FLANK_PLACES`], each an equal part of the tooth's depth.
    pub wear_place: usize,
}

/// Edge of one blade, sampled.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgePolygon {
    /// Corners of the closed polygon: the edge's, then the tool's axis.
    pub corners_mm: Vec<DVec2>,
    /// Places of measurement in the order of the edge.
    pub stations: Vec<Station>,
    /// Triangle that holds the tip zone.
    pub tip_zone_mm: [DVec2; 3],
    /// Circle that holds the edge: centre.
    pub center_mm: DVec2,
    /// Circle that holds the edge: radius, mm.
    pub reach_mm: f64,
    /// The middle of the tip.
    pub tip_mm: DVec2,
}

impl EdgePolygon {
    /// Samples an edge with stations at most `spacing_mm` apart.
    pub fn new(edge: &Edge, spacing_mm: f64) -> Self {
        let (mut corners_mm, mut stations) = (Vec::new(), Vec::new());
        let mut arc_mm = 0.0;
        let mut tip_arc_mm = 0.0;
        for segment in &edge.segments {
            let [from, to] = segment.y_range_mm;
            let [first, last] = segment.slope_range.map(f64::atan);
            let length_mm = arc_length_mm(segment);
            // A chord of an arc turning by t stays within length t / 8 of it; twice as many chords where the curvature
            // is uneven.
            let chords = (length_mm * (last - first).abs() / (4.0 * CHORD_MM)).sqrt();
            let steps = (length_mm / spacing_mm).ceil().max(1.0);
            let chords_per_step = (chords / steps).ceil().max(1.0);
            let y = |step: f64| from + (to - from) * step / steps;
            let count = (steps * chords_per_step) as usize;
            let start = corners_mm.len() as f64;
            corners_mm.extend((0..count).map(|i| place(segment, y(i as f64 / chords_per_step))[0]));
            if segment.name == SegmentName::Tip {
                tip_arc_mm = arc_mm + 0.5 * length_mm;
            }
            for step in 0..steps as u32 {
                let step = f64::from(step);
                let [point_mm, along] = place(segment, y(step + 0.5));
                let length_mm = place(segment, y(step))[0].distance(place(segment, y(step + 1.0))[0]);
                stations.push(Station {
                    parameter: start + (step + 0.5) * chords_per_step,
                    arc_mm: arc_mm + 0.5 * length_mm,
                    length_mm,
                    point_mm,
                    normal: -along.perp().normalize(),
                    side: EdgeSide::of(segment.name),
                    to_corner_mm: f64::INFINITY,
                    wear_place: FLANK_PLACES,
                });
                arc_mm += length_mm;
            }
        }
        if let Some(last) = edge.segments.last() {
            corners_mm.push(place(last, last.y_range_mm[1])[0]);
        }
        corners_mm.push(DVec2::ZERO);
        for station in &mut stations {
            station.arc_mm -= tip_arc_mm;
        }
        let corners: Vec<f64> = stations
            .windows(2)
            .filter(|pair| pair[0].side != pair[1].side)
            .map(|pair| pair[0].arc_mm + 0.5 * pair[0].length_mm)
            .collect();
        let radii_mm = || stations.iter().map(|s| s.point_mm.length());
        let tip_radius_mm = radii_mm().fold(0.0, f64::max);
        let depth_mm = tip_radius_mm - radii_mm().fold(f64::INFINITY, f64::min);
        for station in &mut stations {
            let share = (tip_radius_mm - station.point_mm.length()) / depth_mm;
            let under = ((share * FLANK_PLACES as f64) as usize).min(FLANK_PLACES - 1);
            station.wear_place = match station.side {
                EdgeSide::Right => FLANK_PLACES - 1 - under,
                EdgeSide::Tip => FLANK_PLACES,
                EdgeSide::Left => FLANK_PLACES + 1 + under,
            };
            station.to_corner_mm = corners.iter().map(|c| (c - station.arc_mm).abs()).fold(f64::INFINITY, f64::min);
        }
        let tip_mm = DVec2::new(stations.iter().map(|s| s.point_mm.x).fold(0.0, f64::max), 0.0);
        let tip_zone_mm = tip_zone(&stations);
        Self { corners_mm, stations, tip_zone_mm, center_mm: edge.center_mm, reach_mm: edge.reach_mm, tip_mm }
    }

    /// Length of every place of wear, mm.
    pub fn wear_place_lengths_mm(stations: &[Station]) -> [f64; EDGE_PLACES] {
        stations.iter().fold([0.0; EDGE_PLACES], |mut lengths_mm, station| {
            lengths_mm[station.wear_place] += station.length_mm;
            lengths_mm
        })
    }

    /// Number of chords of the edge itself; the two after them close the polygon through the axis.
    pub fn edge_chords(&self) -> usize {
        self.corners_mm.len() - 2
    }
}

/// Point and direction of the edge, blade frame.
fn place(segment: &Segment, y_mm: f64) -> [DVec2; 2] {
    let [x, slope] = segment.x_and_slope(y_mm);
    let frame = &segment.blade_from_segment;
    [frame.point(DVec2::new(x, y_mm)), frame.direction(DVec2::new(slope, 1.0))]
}

fn arc_length_mm(segment: &Segment) -> f64 {
    const PIECES: u32 = 64;
    let [from, to] = segment.y_range_mm;
    let at = |i: u32| place(segment, from + (to - from) * f64::from(i) / f64::from(PIECES))[0];
    (0..PIECES).map(|i| at(i).distance(at(i + 1))).sum()
}

/// The triangle between the bisectors of both tip corners, widened beyond the tip. Its sides start where the normal is
/// half-way between tip and flank.
fn tip_zone(stations: &[Station]) -> [DVec2; 3] {
    let half_way = |normal: DVec2| normal.to_angle().abs();
    // Where the left flank begins, beside the tip.
    let flank =
        stations.iter().find(|s| s.side == EdgeSide::Left).map_or(std::f64::consts::FRAC_PI_2, |s| half_way(s.normal));
    // The first place past the half-way normal, from the middle of the tip to the left.
    let corner = stations
        .iter()
        .filter(|s| s.point_mm.y > 0.0)
        .take_while(|s| half_way(s.normal) < 0.5 * flank)
        .last()
        .map_or(DVec2::ZERO, |s| s.point_mm + 0.5 * s.length_mm * s.normal.perp());
    let bisector = DVec2::from_angle(0.5 * flank);
    let apex = corner - bisector * (corner.y / bisector.y);
    let outer = corner + bisector * (corner.x - apex.x);
    [apex, DVec2::new(outer.x, -outer.y), outer]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::shaping::scene::model::Tip;
    use crate::process::shaping::tool::cutter::tests::paper_cutter;

    fn polygon(tip: Tip) -> EdgePolygon {
        EdgePolygon::new(paper_cutter(tip).edge(), 0.05)
    }

    #[test]
    fn the_edge_is_symmetric_and_its_stations_fill_it() {
        for tip in [Tip::Sharp, Tip::Round { radius_mm: 0.6 }] {
            let polygon = polygon(tip);
            let n = polygon.stations.len();
            for (a, b) in polygon.stations.iter().zip(polygon.stations.iter().rev()) {
                assert!((a.arc_mm + b.arc_mm).abs() < 1e-6, "{} {}", a.arc_mm, b.arc_mm);
                assert!(a.point_mm.distance(DVec2::new(b.point_mm.x, -b.point_mm.y)) < 1e-6);
            }
            let total: f64 = polygon.stations.iter().map(|s| s.length_mm).sum();
            let chain: f64 = polygon.corners_mm[..=polygon.edge_chords()].windows(2).map(|c| c[0].distance(c[1])).sum();
            assert!((total - chain).abs() < 1e-4 * chain, "{total} {chain}");
            assert!(n > 300, "{n} stations");
            // Normals point out of the tooth: away from its centre line, or along it at the tip.
            assert!(polygon.stations.iter().all(|s| s.normal.x > 0.0 || s.normal.y * s.point_mm.y > 0.0));
        }
    }

    #[test]
    fn the_tip_zone_holds_the_tip_and_not_the_flanks() {
        for tip in [Tip::Sharp, Tip::Round { radius_mm: 0.6 }] {
            let polygon = polygon(tip);
            let [a, b, c] = polygon.tip_zone_mm;
            assert!((b - a).perp_dot(c - a) > 0.0);
            let inside = |p: DVec2| [(a, b), (b, c), (c, a)].iter().all(|(p0, p1)| (*p1 - *p0).perp_dot(p - *p0) > 0.0);
            for station in &polygon.stations {
                let flat = station.side == EdgeSide::Tip && station.normal.to_angle().abs() < 0.1;
                if flat {
                    assert!(inside(station.point_mm), "{station:?} outside {:?}", polygon.tip_zone_mm);
                } else if station.side != EdgeSide::Tip {
                    assert!(!inside(station.point_mm - 1e-3 * station.normal), "{station:?} inside");
                }
            }
        }
    }
}
