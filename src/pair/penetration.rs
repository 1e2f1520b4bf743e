//! How deep tip corners stand in the material of the mate.
//!
//! In: the outlines of the spaces of both gears, and how the gears stand. Out: the deepest place of a corner in the
//! position that the pitch curves ask for, on the flank or in the fillet below its form point.
//!
//! Law: the space between two teeth is a chain of points from the tip of its one flank through the root to the tip of
//! the other, with the material on its left (external gear). A corner is inside where the nearest place of the chain
//! has it on that side; its depth is the distance. Conjugate flanks touch their mate's corner at the end of the path of
//! contact, so a depth of nothing is what a sound pair shows.

use glam::DVec2;

use super::flank_chain::FlankChain;

/// The outline of one space.
#[derive(Debug, Clone, PartialEq)]
pub struct SpaceOutline {
    points_mm: Vec<DVec2>,
    /// Points of the first flank; the others are the second one's.
    first: usize,
    inside: f64,
    center_mm: DVec2,
    reach_mm: f64,
}

/// Where a corner stands to an outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerDepth {
    /// Distance from the nearest place of the outline, mm; positive in the material.
    pub depth_mm: f64,
    /// Whether that place belongs to the first flank.
    pub on_first: bool,
    /// Place along the chain of its flank, from root to tip.
    pub place: f64,
}

impl SpaceOutline {
    /// From the flanks that bound a space, each with its half of the root, from root to tip: `first` stands at the
    /// smaller polar angle. `tip_sign` is +1 on an external gear, -1 on a ring.
    pub fn new(first: &FlankChain, second: &FlankChain, tip_sign: f64) -> Self {
        let points_mm: Vec<DVec2> = first.points_mm.iter().rev().chain(&second.points_mm).copied().collect();
        let center_mm = points_mm[points_mm.len() / 2];
        let reach_mm = points_mm.iter().map(|p| p.distance(center_mm)).fold(0.0, f64::max);
        Self { points_mm, first: first.points_mm.len(), inside: tip_sign, center_mm, reach_mm }
    }

    /// Where a corner stands; none where it is far from the space.
    pub fn corner(&self, corner_mm: DVec2) -> Option<CornerDepth> {
        if corner_mm.distance(self.center_mm) > self.reach_mm {
            return None;
        }
        let mut nearest = (f64::INFINITY, 0, 0.0, 0.0);
        for (i, side) in self.points_mm.windows(2).enumerate() {
            let along = side[1] - side[0];
            let to = corner_mm - side[0];
            let share = (to.dot(along) / along.length_squared()).clamp(0.0, 1.0);
            let square = (to - share * along).length_squared();
            if square < nearest.0 {
                nearest = (square, i, share, along.perp_dot(to));
            }
        }
        let (square, index, share, left) = nearest;
        let at = index as f64 + share;
        let on_first = at < self.first as f64 - 0.5;
        let place = if on_first { ((self.first - 1) as f64 - at).max(0.0) } else { (at - self.first as f64).max(0.0) };
        Some(CornerDepth { depth_mm: square.sqrt() * left.signum() * self.inside, on_first, place })
    }
}
