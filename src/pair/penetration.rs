//! How deep tip corners stand in the material of the mate.
//!
//! In: the outlines of the spaces of both gears, and how the gears stand. Out: the deepest place of a corner in the
//! position that the pitch curves ask for, on the flank or in the fillet below its form point.
//!
//! Law: the space between two teeth is a chain of points from the tip of its one flank through the root to the tip of
//! the other, with the material on its left (external gear). A corner is inside where the nearest place of the chain
//! has it on that side; its depth is the distance from there, or from the tip curve of both teeth where that is nearer.
//! Over the tip curve it is clear: far from the line of centres the driver's teeth pass over those of a ring. The
//! curve has a radius that is linear in the polar angle between the tips of both flanks, a circle on round gears.
//! Conjugate flanks touch their mate's corner at the end of the path of contact, so a depth of nothing is what a sound
//! pair shows.

use glam::DVec2;

use super::flank_chain::FlankChain;

/// Squares of distances of one place from two sides that meet there differ by less than this share of them.
const AS_NEAR: f64 = 1e-9;

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
        // Two sides that meet nearest to the corner are as near as each other: the one whose line is farther off knows
        // on which side the corner is. A flank may meet its fillet with a step of some nanometres straight across.
        let mut nearest = (f64::INFINITY, 0, 0.0, 0.0_f64);
        for (i, side) in self.points_mm.windows(2).enumerate() {
            let along = side[1] - side[0];
            let to = corner_mm - side[0];
            let share = (to.dot(along) / along.length_squared()).clamp(0.0, 1.0);
            let square = (to - share * along).length_squared();
            let left_mm = along.perp_dot(to) / along.length();
            let is_as_near = square <= (1.0 + AS_NEAR) * nearest.0;
            if square < (1.0 - AS_NEAR) * nearest.0 || (is_as_near && left_mm.abs() > nearest.3.abs()) {
                nearest = (square, i, share, left_mm);
            }
        }
        let (square, index, share, left_mm) = nearest;
        let at = index as f64 + share;
        let on_first = at < self.first as f64 - 0.5;
        let place = if on_first { ((self.first - 1) as f64 - at).max(0.0) } else { (at - self.first as f64).max(0.0) };
        let depth_mm = square.sqrt() * left_mm.signum() * self.inside;
        let depth_mm = if depth_mm > 0.0 { depth_mm.min(self.below_tips_mm(corner_mm)) } else { depth_mm };
        Some(CornerDepth { depth_mm, on_first, place })
    }

    /// How far a place is below the tip curve of the teeth on both sides of the space, towards their roots, mm.
    fn below_tips_mm(&self, place_mm: DVec2) -> f64 {
        let [first, second] = [self.points_mm[0], self.points_mm[self.points_mm.len() - 1]];
        let share = first.angle_to(place_mm) / first.angle_to(second);
        let tip_mm = first.length() + share * (second.length() - first.length());
        self.inside * (tip_mm - place_mm.length())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The space between two teeth, upwards; its left flank meets the fillet with a step of 12 nm straight across, and
    /// its right one with a ridge of 30 degrees. The side is that of the polygon which a chord over the tips closes.
    #[test]
    fn a_step_or_a_ridge_in_the_outline_turns_no_side() {
        // The axis of the ring is above.
        let point = |x: f64, y: f64| DVec2::new(x, y - 30.0);
        let left = vec![point(-0.2, 0.0), point(-1.0, 1.0), point(-1.0 - 12e-6, 1.0), point(-2.0, 3.0)];
        let right = vec![point(0.2, 0.0), point(1.2, 0.6), point(0.7, 1.1), point(1.2, 1.0), point(2.0, 3.0)];
        let [first, second] = [&left, &right].map(|points_mm| FlankChain::straight(points_mm.clone()));
        let closed: Vec<DVec2> = left.iter().rev().chain(&right).copied().collect();
        let is_open = |p: DVec2| {
            let sides = (0..closed.len()).map(|i| [closed[i], closed[(i + 1) % closed.len()]]);
            let crosses =
                |[a, b]: &[DVec2; 2]| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
            sides.filter(crosses).count() % 2 == 1
        };
        let outline = SpaceOutline::new(&first, &second, -1.0);
        let mut seen = [0; 2];
        for (i, j) in (0..100).flat_map(|i| (0..100).map(move |j| (i, j))) {
            let place_mm = point(-1.5 + 0.0301 * f64::from(i), 0.0103 + 0.0207 * f64::from(j));
            let found = outline.corner(place_mm).expect("within reach");
            assert_eq!(found.depth_mm < 0.0, is_open(place_mm), "{place_mm}: {found:?}");
            seen[usize::from(is_open(place_mm))] += 1;
        }
        assert!(seen.iter().all(|&count| count > 1000), "{seen:?}");
    }
}
