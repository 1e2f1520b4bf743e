//! Passes over columns that stand next to each other: most are out of the question for all of them at once.
//!
//! In: some columns of a field, and the passes near it, one after another, with a height. Out: whether a pass surely
//! leaves all rays of all columns higher than that.
//!
//! **The law.** The points of one height on the columns' rays lie within a distance a of those on a ray in the middle,
//! from the lowest place that is looked at up to the blank. Segments that rays within a of the middle one cannot meet
//! are left out; in front of the others the middle ray must stand further away than the columns differ
//! ([`Segments::stays_above`]), or be past one of them ([`Segments::misses`]). Of some thousand passes near a flank all
//! but the few dozen whose blades come within a of the surface are answered for so, once for a group instead of once
//! for a column.
//!
//! The answer is kept for each pass: the heights that it surely stays above, and the lowest for which this could not be
//! said. It decides about time alone: a pass that is not answered for is looked at column by column.

use super::near::Near;
use super::phase_heights::PhaseHeights;
use super::segments::Segments;
use super::shared_segment::Beside;
use gearcut_core::dexel::field::Column;
use std::collections::BTreeMap;
use std::ops::Range;

/// Columns of a group lie within this length of the profile, mm. It decides about time alone: a wide group answers for
/// more columns, a narrow one about passes that come closer.
const WIDTH_MM: f64 = 0.4;

/// A group is asked for heights that are more than those looked at by this share of how far its columns differ: those
/// of the next columns are answered as well.
const SPARE_SHARE: f64 = 0.1;

/// What is known of the passes over a group of columns.
pub(super) struct ColumnGroup {
    /// A ray in the middle, as long as the longest of the columns' rays.
    middle: Column,
    /// How far points of the columns' rays lie from the point of the same height on the middle one, mm.
    apart_mm: f64,
    /// How much their directions differ from that of the middle one at most.
    turned: f64,
    passes: Vec<GroupLook>,
    /// The pass that lies lowest of some, on the column that was looked at last.
    lowest: BTreeMap<(usize, usize), usize>,
}

/// What is known of a pass.
#[derive(Clone, Copy)]
struct GroupLook {
    /// It surely stays above these on all columns.
    above: PhaseHeights,
    /// Of these heights and higher ones it could not be said.
    open: PhaseHeights,
}

impl ColumnGroup {
    /// Of so many passes nothing is known but which of them lay lowest on a group before.
    pub fn new(columns: &[Column], passes: usize, before: Option<Self>) -> Self {
        let low_mm = columns.iter().map(|column| column.low_mm).fold(f64::INFINITY, f64::min);
        let blank_mm = columns.iter().map(|column| column.blank_mm).fold(f64::NEG_INFINITY, f64::max);
        let middle = Column { low_mm, blank_mm, ..columns[columns.len() / 2] };
        let farthest_mm = (2.0 * low_mm).abs().max(blank_mm.abs());
        let apart_mm = columns.iter().map(|column| {
            column.origin_mm.distance(middle.origin_mm) + farthest_mm * column.normal.distance(middle.normal)
        });
        let turned = columns.iter().map(|column| column.normal.distance(middle.normal));
        let [above, open] = [f64::NEG_INFINITY, f64::INFINITY].map(PhaseHeights::even);
        let nothing = GroupLook { above, open };
        Self {
            apart_mm: apart_mm.fold(0.0, f64::max),
            turned: turned.fold(0.0, f64::max),
            middle,
            passes: vec![nothing; passes],
            lowest: before.map(|group| group.lowest).unwrap_or_default(),
        }
    }

    /// Columns in order, in groups, with the number of the first one of each.
    pub fn groups(columns: &[Column]) -> Vec<(usize, &[Column])> {
        let (mut groups, mut rest) = (Vec::new(), columns);
        while let [first, ..] = rest {
            let count = rest.partition_point(|column| column.arc_mm <= first.arc_mm + WIDTH_MM).max(1);
            let (group, others) = rest.split_at(count);
            groups.push((columns.len() - rest.len(), group));
            rest = others;
        }
        groups
    }

    /// Whether a pass surely stays above some heights on all columns, as far as a look at the middle ray can say.
    pub fn stays_above(&mut self, segments: &Segments, pass: usize, near: &Near, heights: &PhaseHeights) -> bool {
        let look = &mut self.passes[pass];
        if look.above.covers(heights) {
            return true;
        }
        if heights.covers(&look.open) {
            return false;
        }
        let heights = heights.raised(SPARE_SHARE * self.apart_mm);
        let set = segments.meeting(near, &self.middle, self.apart_mm);
        let beside = Beside { apart_mm: self.apart_mm, turned: self.turned };
        if set == 0 || segments.misses(near, &self.middle, set, beside) {
            look.above = PhaseHeights::even(f64::INFINITY);
            return true;
        }
        let stays = segments.stays_above(near, &self.middle, set, &heights, self.apart_mm);
        *(if stays { &mut look.above } else { &mut look.open }) = heights;
        stays
    }

    /// The pass that lay lowest of some on the column before, if one has been looked at.
    pub fn lowest_pass(&self, passes: &Range<usize>) -> Option<usize> {
        self.lowest.get(&(passes.start, passes.end)).copied()
    }

    /// Keeps the pass that lies lowest of some.
    pub fn is_lowest(&mut self, passes: &Range<usize>, lowest: usize) {
        self.lowest.insert((passes.start, passes.end), lowest);
    }
}

#[cfg(test)]
mod tests {
    use super::super::deciding::{ColumnPasses, deciding};
    use super::super::near::passes_near;
    use super::*;
    use crate::process::load;
    use crate::process::shaping::ShapingJob;
    use gearcut_core::terms::Side;
    use std::path::Path;

    /// Columns of some groups of which a group with `share` of its margin loses a pass that decides on the last chip;
    /// and all columns. What decides is what columns say that are looked at one by one.
    fn columns_that_lose(share: f64) -> [usize; 2] {
        let scene = load(Path::new("scenes/shaping/elliptical_normal.toml"), &[]).expect("the shipped scene");
        let job = ShapingJob::new(scene.scene).expect("the shipped gear");
        let field = job.flank_field(job.target_flank(4, Side::Left));
        let places: Vec<usize> = (0..field.columns.len()).step_by(4).collect();
        let field = field.at([&places, &[0]]);
        let near = passes_near(&job, &field);
        let segments = Segments::new(job.cutter.edge(), std::slice::from_ref(job.cutter.edge()));
        let decide = |group: &mut ColumnGroup, ray: &Column| -> Vec<usize> {
            let mut passes = ColumnPasses::new(&segments, &near, ray, group);
            deciding(&mut passes, near.len()).iter().map(|reaching| reaching.near).collect()
        };
        let (mut lost, mut all) = (0, 0);
        for (_, columns) in ColumnGroup::groups(&field.columns).into_iter().step_by(5) {
            assert!(columns.len() > 3, "a group of {} columns", columns.len());
            let mut group = ColumnGroup::new(columns, near.len(), None);
            assert!(group.apart_mm > 0.1, "{} mm", group.apart_mm);
            group.apart_mm *= share;
            for ray in columns {
                let alone = decide(&mut ColumnGroup::new(std::slice::from_ref(ray), near.len(), None), ray);
                let in_group = decide(&mut group, ray);
                all += 1;
                lost += usize::from(alone.iter().any(|pass| !in_group.contains(pass)));
            }
        }
        [lost, all]
    }

    /// Planted: without the margin passes that decide are answered for. Half of it loses none here: it counts how far
    /// rays lie apart from twice their lowest height on, where few surfaces are.
    #[test]
    fn a_group_whose_margin_is_too_small_loses_chips() {
        let [whole, none] = [1.0, 0.0].map(columns_that_lose);
        println!("whole margin {whole:?}, none {none:?}");
        assert!(whole[0] == 0 && whole[1] > 20, "{whole:?}");
        assert!(none[0] > none[1] / 2, "{none:?}");
    }
}
