//! How far a point lies from a cutter tooth, in closed form.
//!
//! In: a point of the tooth's frame (x along its centre line). Out: its distance from the tooth in mm, negative inside.
//! Law: a tooth is what lies inside its flanks, its tip circle and its chamfers, so the distance is the largest of
//! theirs; beside a round or a corner it is that of the round's circle. The distance of an involute flank is
//! `r_b (sigma theta + u - atan u - psi_b)`, exact along the flank's normals; below the involute the straight base
//! goes on.
//!
//! The tooth is taken to go on towards the axis without end: what a tooth of the work meets at the root circle of the
//! cutter is not looked at. A drawn tooth has no such form: [`EdgeDistance`].

use super::edge_distance::EdgeDistance;
use crate::process::shaping::ShaperCutter;
use crate::process::shaping::tool::involute_tooth::{CornerPart, InvoluteTooth};
use gearcut_core::tool::involute::Involute;
use glam::DVec2;

/// A cutter tooth, as far as distances need it.
#[derive(Debug, Clone)]
pub struct ToothDistance {
    law: DistanceLaw,
    /// Radius of the tip circle, mm.
    pub tip_radius_mm: f64,
}

/// How distances are found.
#[derive(Debug, Clone)]
enum DistanceLaw {
    /// In closed form.
    Involute(InvoluteDistance),
    /// From the chords of an edge.
    Drawn(EdgeDistance),
}

/// A tooth with involute flanks; symmetric to its centre line.
#[derive(Debug, Clone)]
struct InvoluteDistance {
    flank: Involute,
    /// Where the involute begins, and its normal there.
    start_mm: DVec2,
    start_normal: DVec2,
    corner: Vec<Corner>,
    tip_radius_mm: f64,
}

/// A part of the corner between flank and tip.
#[derive(Debug, Clone, Copy)]
enum Corner {
    /// Round, with its normals at the tip and at the flank.
    Round { center_mm: DVec2, radius_mm: f64, at_tip: DVec2, at_flank: DVec2 },
    /// Straight, with its end at the tip and its normal.
    Chamfer { tip_end_mm: DVec2, out: DVec2 },
}

impl Corner {
    fn new(part: &CornerPart) -> Self {
        match *part {
            CornerPart::Round { center_mm, radius_mm, normals_rad: [tip_rad, flank_rad] } => Self::Round {
                center_mm,
                radius_mm,
                at_tip: DVec2::from_angle(tip_rad),
                at_flank: DVec2::from_angle(flank_rad),
            },
            CornerPart::Chamfer { flank_end_mm, tip_end_mm } => {
                Self::Chamfer { tip_end_mm, out: -(flank_end_mm - tip_end_mm).normalize_or_zero().perp() }
            }
        }
    }
}

impl ToothDistance {
    /// Of a cutter's teeth.
    pub fn new(cutter: &ShaperCutter) -> Self {
        let tip_radius_mm = cutter.tip_radius_mm;
        let law = match cutter.involute() {
            Some(tooth) => DistanceLaw::Involute(InvoluteDistance::new(tooth, tip_radius_mm)),
            None => DistanceLaw::Drawn(EdgeDistance::new(cutter.edge())),
        };
        Self { law, tip_radius_mm }
    }

    /// Distance of a point from the tooth, mm; negative inside.
    pub fn at_mm(&self, point_mm: DVec2) -> f64 {
        match &self.law {
            DistanceLaw::Involute(tooth) => tooth.at_mm(point_mm),
            DistanceLaw::Drawn(edge) => edge.at_mm(point_mm),
        }
    }
}

impl InvoluteDistance {
    fn new(tooth: &InvoluteTooth, tip_radius_mm: f64) -> Self {
        let flank = tooth.flank(1.0);
        let [start_roll, _] = tooth.roll_range;
        Self {
            flank,
            start_mm: flank.point(start_roll),
            start_normal: flank.normal(start_roll),
            corner: tooth.corner.iter().map(Corner::new).collect(),
            tip_radius_mm,
        }
    }

    fn at_mm(&self, point_mm: DVec2) -> f64 {
        let p = DVec2::new(point_mm.x, point_mm.y.abs());
        let mut distance_mm = self.side_mm(p).max(p.length() - self.tip_radius_mm);
        for part in &self.corner {
            match *part {
                Corner::Round { center_mm, radius_mm, at_tip, at_flank } => {
                    let away = p - center_mm;
                    if at_tip.perp_dot(away) > 0.0 && at_flank.perp_dot(away) < 0.0 {
                        return away.length() - radius_mm;
                    }
                }
                Corner::Chamfer { tip_end_mm, out } => distance_mm = distance_mm.max(out.dot(p - tip_end_mm)),
            }
        }
        distance_mm
    }

    /// Distance from the left flank and the base below it.
    fn side_mm(&self, p: DVec2) -> f64 {
        let from_start = p - self.start_mm;
        if from_start.perp_dot(self.start_normal) < 0.0 {
            return from_start.dot(self.start_normal);
        }
        let u = self.flank.roll_at_radius(p.length());
        self.flank.base_radius_mm * (p.to_angle() + u - u.atan() - self.flank.half_angle_rad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::shaping::scene::model::Tip;
    use crate::process::shaping::tool::cutter::tests::paper_cutter;
    use crate::process::shaping::tool::edge_polygon::EdgePolygon;

    #[test]
    fn points_beside_the_edge_lie_as_far_as_they_were_moved() {
        for tip in [Tip::Sharp, Tip::Round { radius_mm: 0.6 }, Tip::Chamfer { height_mm: 0.5, angle_rad: 0.8 }] {
            let cutter = paper_cutter(tip);
            let distance = ToothDistance::new(&cutter);
            let stations = EdgePolygon::new(cutter.edge(), 0.05).stations;
            // A chamfer's own ends are no corners of the stations. Within 0.04 mm of one, another side is
            // nearer to a point that was moved inwards: 0.1 mm tan(23 deg), half the turn of the normal there.
            let corner = &cutter.involute().expect("involute flanks").corner;
            let ends = corner.iter().flat_map(|part| match *part {
                CornerPart::Chamfer { flank_end_mm, tip_end_mm } => vec![flank_end_mm, tip_end_mm],
                CornerPart::Round { .. } => Vec::new(),
            });
            let ends: Vec<DVec2> = ends.collect();
            let beside_an_end = |p: DVec2| ends.iter().any(|end| end.distance(DVec2::new(p.x, p.y.abs())) < 0.1);
            let mut looked_at = 0;
            for station in stations.iter().filter(|s| s.to_corner_mm > 0.35 && s.point_mm.length() > 27.0) {
                if beside_an_end(station.point_mm) {
                    continue;
                }
                for moved_mm in [-0.1, -0.01, 0.0, 0.01, 0.2] {
                    let found = distance.at_mm(station.point_mm + moved_mm * station.normal);
                    assert!((found - moved_mm).abs() < 1e-6, "{tip:?} {station:?} {moved_mm}: {found}");
                    looked_at += 1;
                }
            }
            assert!(looked_at > 500, "{looked_at}");
        }
    }

    #[test]
    fn a_sharp_corner_is_as_far_as_a_point() {
        let cutter = paper_cutter(Tip::Sharp);
        let tooth = cutter.involute().expect("involute flanks");
        let flank = tooth.flank(1.0);
        let corner = flank.point(tooth.roll_range[1]);
        let between = corner.normalize() + flank.normal(tooth.roll_range[1]);
        let p = corner + 0.3 * between.normalize();
        assert!((ToothDistance::new(&cutter).at_mm(p) - 0.3).abs() < 1e-12);
        assert!((ToothDistance::new(&cutter).at_mm(DVec2::new(p.x, -p.y)) - 0.3).abs() < 1e-12);
    }
}
