//! Passes that decide the last chip on the rays of a column.
//!
//! In: the passes near a field in order of time, and a column of its rays. Out: those of them that can decide, with the
//! segments of the edge that the rays can meet. A pass decides if it may lie lowest, or lowest of all before one that
//! may. The others lower surfaces too, but surfaces that are gone when the last chip is cut. Where edges plough, other
//! passes are asked for: all that may come below a bound ([`super::ploughing`]).
//!
//! Bounds of the height that a pass leaves on the column's rays choose. Most passes need none: few come close to the
//! surface that is left, and one look at the edge says of the others that they stay above it. What is left is bounded
//! first by the pass that lies lowest on the column before and by a pass in sixteen; then each pass is asked once, and
//! most are answered for by the group of columns ([`super::column_group`]). The chips equal those of all passes bit for
//! bit (tests in [`super::flank`] and [`super::near`]). Road not taken: halving the rows of a column with bounds of
//! their own. They cost more than a look at the edge for each row (75 s for 60 s on the paper's gear with the feed
//! going on).

use super::column_group::ColumnGroup;
use super::near::Near;
use super::phase_heights::PhaseHeights;
use super::segments::{Reaching, SegmentSet, Segments};
use super::shared_segment::Beside;
use gearcut_core::dexel::field::Column;
use std::ops::Range;

/// One pass in so many is asked first: the one next to the lowest stands a few micrometres above it.
const STRIDE: usize = 16;

/// What is known of a pass over a column.
#[derive(Debug, Clone, Copy)]
enum Look {
    /// Nothing.
    None,
    /// It meets no ray of the column.
    Misses,
    /// These segments may meet the rays, but surely higher than this.
    Above(SegmentSet, PhaseHeights),
    /// Its bounds.
    Bounded(Reaching),
}

/// The passes near a field over one of its columns, in order of time.
pub(super) struct ColumnPasses<'a> {
    segments: &'a Segments<'a>,
    near: &'a [Near],
    ray: &'a Column,
    group: &'a mut ColumnGroup,
    looks: Vec<Look>,
}

impl<'a> ColumnPasses<'a> {
    /// A column of a group.
    pub fn new(segments: &'a Segments<'a>, near: &'a [Near], ray: &'a Column, group: &'a mut ColumnGroup) -> Self {
        Self { segments, near, ray, group, looks: vec![Look::None; near.len()] }
    }

    /// A pass's bounds, unless it misses the column or surely stays above some heights.
    fn below(&mut self, pass: usize, heights: &PhaseHeights) -> Option<Reaching> {
        match &self.looks[pass] {
            Look::Misses => return None,
            Look::Above(_, above) if above.covers(heights) => return None,
            Look::Bounded(reaching) => return Some(*reaching),
            Look::None | Look::Above(..) => {}
        }
        let near = &self.near[pass];
        if self.group.stays_above(self.segments, pass, near, heights) {
            return None;
        }
        let set = match self.looks[pass] {
            Look::Above(set, _) => set,
            _ => self.segments.meeting(near, self.ray, 0.0),
        };
        let (look, reaching) = if set == 0 || self.segments.misses(near, self.ray, set, Beside::ALONE) {
            (Look::Misses, None)
        } else if self.segments.stays_above(near, self.ray, set, heights, 0.0) {
            (Look::Above(set, *heights), None)
        } else {
            let reaching = self.segments.reaching(pass, near, self.ray, set);
            (reaching.map_or(Look::Misses, Look::Bounded), reaching)
        };
        self.looks[pass] = look;
        reaching
    }

    /// The lowest, in the mean over the phases, that any of some passes surely leaves, asked in their order: those that
    /// stay above it need no bounds. With it the pass that leaves it, if it lies below `from`.
    fn surely_left(
        &mut self,
        passes: impl Iterator<Item = usize>,
        from: PhaseHeights,
    ) -> (PhaseHeights, Option<usize>) {
        passes.fold((from, None), |(left, by), pass| match self.below(pass, &left) {
            Some(reaching) if reaching.highest.is_lower(&left) => (reaching.highest, Some(pass)),
            _ => (left, by),
        })
    }

    /// The lowest that any of some passes surely leaves, or `from`.
    pub fn surely_left_by(&mut self, passes: Range<usize>, from: PhaseHeights) -> PhaseHeights {
        let before = self.group.lowest_pass(&passes);
        let first = before.into_iter().chain(passes.clone().step_by(STRIDE));
        let (coarse, by_coarse) = self.surely_left(first, from);
        let (left, by) = self.surely_left(passes.clone(), coarse);
        if let Some(lowest) = by.or(by_coarse) {
            self.group.is_lowest(&passes, lowest);
        }
        left
    }

    /// Those of some passes that may come as low as some heights on any of the column's rays.
    pub fn reaching_below(&mut self, passes: Range<usize>, heights: PhaseHeights) -> Vec<Reaching> {
        let below = passes.filter_map(|pass| self.below(pass, &heights));
        below.filter(|pass| pass.lowest.reaches(&heights)).collect()
    }

    /// All of some passes that reach the column, whatever their bounds.
    #[cfg(test)]
    pub fn all(&self, passes: Range<usize>) -> Vec<Reaching> {
        const FAR_BELOW_MM: f64 = -1e6;
        let bounds = |pass: usize| {
            let near = &self.near[pass];
            let set = self.segments.meeting(near, self.ray, 0.0);
            let reaching = (set != 0).then(|| self.segments.reaching(pass, near, self.ray, set)).flatten();
            reaching.map(|reaching| Reaching { lowest: PhaseHeights::even(FAR_BELOW_MM), ..reaching })
        };
        passes.filter_map(bounds).collect()
    }
}

/// Those of the first `end` passes that can decide the last chip.
pub(super) fn deciding(column: &mut ColumnPasses, end: usize) -> Vec<Reaching> {
    let blank = PhaseHeights::even(column.ray.blank_mm);
    let left = column.surely_left_by(0..end, blank);
    let may_rule = |look: &Look| matches!(look, Look::Bounded(pass) if pass.lowest.reaches(&left));
    let ruling = column.looks[..end].iter().position(may_rule).zip(column.looks[..end].iter().rposition(may_rule));
    let Some((first, last)) = ruling else { return Vec::new() };
    // The surface that the first of them meets was left shortly before.
    let before = column.surely_left((0..first).rev(), blank).0;
    column.reaching_below(0..last + 1, before)
}
