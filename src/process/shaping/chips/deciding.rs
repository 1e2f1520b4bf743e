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
//! bit (test in [`super::flank`]). Road not taken: halving the rows of a column with bounds of their own. They cost
//! more than a look at the edge for each row (75 s for 60 s on the paper's gear with the feed going on).

use super::column_group::ColumnGroup;
use super::segments::{Near, Reaching, SegmentSet, Segments};
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
    /// These segments may meet the rays, but surely higher than this, mm.
    Above(SegmentSet, f64),
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

    /// A pass's bounds, unless it misses the column or surely stays above a height.
    fn below(&mut self, pass: usize, height_mm: f64) -> Option<Reaching> {
        match self.looks[pass] {
            Look::Misses => return None,
            Look::Above(_, above_mm) if above_mm >= height_mm => return None,
            Look::Bounded(reaching) => return Some(reaching),
            Look::None | Look::Above(..) => {}
        }
        let near = &self.near[pass];
        if self.group.stays_above(self.segments, pass, near, height_mm) {
            return None;
        }
        let set = match self.looks[pass] {
            Look::Above(set, _) => set,
            _ => self.segments.meeting(near, self.ray, 0.0),
        };
        let (look, reaching) = if set == 0 {
            (Look::Misses, None)
        } else if self.segments.stays_above(near, self.ray, set, height_mm, 0.0) {
            (Look::Above(set, height_mm), None)
        } else {
            let reaching = self.segments.reaching(pass, near, self.ray, set);
            (reaching.map_or(Look::Misses, Look::Bounded), reaching)
        };
        self.looks[pass] = look;
        reaching
    }

    /// The lowest that any of some passes surely leaves, asked in their order: those that stay above it need no bounds.
    /// With it the pass that leaves it, if it lies below `from_mm`.
    fn surely_left_mm(&mut self, passes: impl Iterator<Item = usize>, from_mm: f64) -> (f64, Option<usize>) {
        passes.fold((from_mm, None), |(left_mm, by), pass| match self.below(pass, left_mm) {
            Some(reaching) if reaching.heights_mm[1] < left_mm => (reaching.heights_mm[1], Some(pass)),
            _ => (left_mm, by),
        })
    }

    /// The lowest that any of some passes surely leaves, or `from_mm`.
    pub fn surely_left_by(&mut self, passes: Range<usize>, from_mm: f64) -> f64 {
        let before = self.group.lowest_pass(&passes);
        let first = before.into_iter().chain(passes.clone().step_by(STRIDE));
        let (coarse_mm, by_coarse) = self.surely_left_mm(first, from_mm);
        let (left_mm, by) = self.surely_left_mm(passes.clone(), coarse_mm);
        if let Some(lowest) = by.or(by_coarse) {
            self.group.is_lowest(&passes, lowest);
        }
        left_mm
    }

    /// Those of some passes that may come as low as a height on any of the column's rays.
    pub fn reaching_below(&mut self, passes: Range<usize>, height_mm: f64) -> Vec<Reaching> {
        let below = passes.filter_map(|pass| self.below(pass, height_mm));
        below.filter(|pass| pass.heights_mm[0] <= height_mm).collect()
    }

    /// All of some passes that reach the column.
    #[cfg(test)]
    pub fn all(&self, passes: Range<usize>) -> Vec<Reaching> {
        let bounds = |pass: usize| {
            let near = &self.near[pass];
            let set = self.segments.meeting(near, self.ray, 0.0);
            if set == 0 { None } else { self.segments.reaching(pass, near, self.ray, set) }
        };
        passes.filter_map(bounds).collect()
    }
}

/// Those of the first `end` passes that can decide the last chip.
pub(super) fn deciding(column: &mut ColumnPasses, end: usize) -> Vec<Reaching> {
    let left_mm = column.surely_left_by(0..end, column.ray.blank_mm);
    let may_rule = |look: &Look| matches!(look, Look::Bounded(pass) if pass.heights_mm[0] <= left_mm);
    let ruling = column.looks[..end].iter().position(may_rule).zip(column.looks[..end].iter().rposition(may_rule));
    let Some((first, last)) = ruling else { return Vec::new() };
    // The surface that the first of them meets was left shortly before.
    let before_mm = column.surely_left_mm((0..first).rev(), column.ray.blank_mm).0;
    let asked = (0..=last).filter_map(|pass| column.below(pass, before_mm));
    asked.filter(|pass| pass.heights_mm[0] <= before_mm).collect()
}
