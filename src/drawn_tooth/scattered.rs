//! Where a curve runs of which points were measured.
//!
//! In: points that lie beside a curve by up to a tolerance, near enough to each other to say more together than alone.
//! Out: place and direction of the curve at a point, and by how much it turns there at once.
//!
//! **Law.** Both coordinates are polynomials of degree 2 over the length of the chain, by least squares over all points
//! within a reach: to both sides for the place, to one side each for the turn. A round of 0.3 mm is followed so within
//! a micrometre over 0.2 mm to either side.
//!
//! Points further apart than a tenth of the reach say what a drawing says: each lies on the curve.

use gearcut_core::math::least_squares::solve;
use glam::DVec2;
use std::ops::RangeInclusive;

/// Points this many tolerances away count: what they are off by a tolerance turns a direction by a fiftieth.
pub(super) const REACH: f64 = 50.0;
/// Points to one side that say more than one; where they are sparse, up to so many reaches away.
const FEWEST: usize = 5;
const MOST_REACHES: f64 = 2.0;

/// Turn from one direction to another one, rad: to the last digits where it is small, which an arc cosine is not.
pub fn turn_rad(from: DVec2, to: DVec2) -> f64 {
    from.perp_dot(to).atan2(from.dot(to))
}

/// Place and direction of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CurvePlace {
    /// On the curve, mm.
    pub(super) point_mm: DVec2,
    /// Unit vector along it.
    pub(super) tangent: DVec2,
}

/// A chain of points beside a curve.
pub(super) struct Scattered<'a> {
    chain: &'a [DVec2],
    /// Length of the chain up to each point, mm.
    lengths_mm: Vec<f64>,
    reach_mm: f64,
}

impl<'a> Scattered<'a> {
    /// Points that lie beside their curve by so much at most.
    pub(super) fn new(chain: &'a [DVec2], tolerance_mm: f64) -> Self {
        let mut length_mm = 0.0;
        let chords = chain.windows(2).map(|pair| pair[0].distance(pair[1]));
        let ends = chords.map(|chord_mm| {
            length_mm += chord_mm;
            length_mm
        });
        Self { chain, lengths_mm: [0.0].into_iter().chain(ends).collect(), reach_mm: REACH * tolerance_mm }
    }

    /// The points that count on both sides of one; none where they are too far apart on either side.
    fn windows(&self, i: usize) -> Option<[RangeInclusive<usize>; 2]> {
        let is_within = |j: &usize, reaches: f64| self.chain[*j].distance(self.chain[i]) <= reaches * self.reach_mm;
        let count = |beyond: &dyn Fn() -> Box<dyn Iterator<Item = usize>>| {
            let near = beyond().take_while(|j| is_within(j, 1.0)).count().max(FEWEST);
            let all = beyond().take(near).take_while(|j| is_within(j, MOST_REACHES)).count();
            // Fewer do where the chain ends.
            (all >= FEWEST || all == beyond().count()).then_some(all)
        };
        let last = self.chain.len() - 1;
        let before = count(&|| Box::new((0..i).rev()))?;
        let after = count(&|| Box::new(i + 1..=last))?;
        Some([i - before..=i, i..=i + after])
    }

    /// The curve at a point, from the points of a window; none from too few of them.
    fn fitted(&self, i: usize, window: RangeInclusive<usize>) -> Option<CurvePlace> {
        if window.clone().count() <= FEWEST {
            return None;
        }
        let coordinate = |of: fn(DVec2) -> f64| {
            let row = |j: usize| {
                let s = (self.lengths_mm[j] - self.lengths_mm[i]) / self.reach_mm;
                ([1.0, s, s * s], of(self.chain[j] - self.chain[i]))
            };
            solve(window.clone().map(row)).ok()
        };
        let ([x, along_x, _], [y, along_y, _]) = (coordinate(|at| at.x)?, coordinate(|at| at.y)?);
        let tangent = DVec2::new(along_x, along_y).try_normalize()?;
        Some(CurvePlace { point_mm: self.chain[i] + DVec2::new(x, y), tangent })
    }

    /// The curve at a point; none where its neighbours say less than it does alone.
    pub(super) fn at(&self, i: usize) -> Option<CurvePlace> {
        let [before, after] = self.windows(i)?;
        self.fitted(i, *before.start()..=*after.end())
    }

    /// By how much the curve turns at a point, rad; 0 near its ends; none where the points beside are too far apart.
    pub(super) fn turn_rad(&self, i: usize) -> Option<f64> {
        let [before, after] = self.windows(i)?.map(|window| self.fitted(i, window));
        Some(before.zip(after).map_or(0.0, |(before, after)| turn_rad(before.tangent, after.tangent).abs()))
    }

    /// The points within whose windows a point lies, nearly.
    pub(super) fn beside(&self, i: usize) -> RangeInclusive<usize> {
        self.windows(i).map_or(i..=i, |[before, after]| *before.start()..=*after.end())
    }
}
