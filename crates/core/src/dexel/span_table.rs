//! What is left on neighbouring rays, as a rough copy of their spans. It answers "does anything lie between two
//! places?" without a branch, and never says no where the spans say yes.
//!
//! In: rays and their spans ([`super::intervals`]). Out: whether material may lie between two places of a ray.
//!
//! **The law.** A row holds the ends of eight spans in f32, rounded outward by one step; spans beyond them are one with
//! the last, gaps and all. The two places that are asked for are rounded to the nearest f32. Rounding keeps the order
//! of numbers: places that overlap a span overlap its copy as well. A row is renewed when its ray is cut; a row that is
//! out of date holds too much, which is safe.
//!
//! The road not taken: the spans themselves, searched by halves. A list of its own for every ray costs two misses of
//! the cache and a search whose branches no processor predicts: some 50 ns, against 2.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]

use super::blank_field::RayMaterial;
use super::intervals::Span;
use crate::math::ray_reach::RayReach;
use pulp::Arch;

/// Spans of a row: a ray through a gear of 35 teeth meets six at most.
const SPANS: usize = 8;

/// A row per ray.
#[derive(Debug, Clone, PartialEq)]
pub struct SpanTable {
    rows: Vec<Row>,
}

/// Ends of the spans of a ray, mm; places without a span begin beyond all others and end before them.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Row {
    lows_mm: [f32; SPANS],
    highs_mm: [f32; SPANS],
}

impl SpanTable {
    /// Of neighbouring rays.
    pub fn new(rays: &[RayMaterial]) -> Self {
        Self { rows: rays.iter().map(|spans| Row::new(spans)).collect() }
    }

    /// Takes over what is left on a ray.
    pub fn renew(&mut self, ray: usize, spans: &[Span]) {
        self.rows[ray] = Row::new(spans);
    }

    /// Rays on which material may lie between the places that a curve can have there.
    pub fn held(&self, reach: &RayReach, into: &mut Vec<usize>) {
        into.clear();
        Arch::new().dispatch(Holding { table: self, reach, into });
    }

    /// Whether material may lie between two places of a ray; the lower one is larger where there is nothing to ask.
    #[allow(clippy::needless_bitwise_bool, reason = "no branch: all eight spans are compared at once")]
    #[inline(always)]
    fn may_hold(&self, ray: usize, [from_mm, to_mm]: [f64; 2]) -> bool {
        let row = &self.rows[ray];
        let (from_mm, to_mm) = (from_mm as f32, to_mm as f32);
        let mut held = false;
        for (low_mm, high_mm) in row.lows_mm.iter().zip(&row.highs_mm) {
            held |= (*low_mm < to_mm) & (*high_mm > from_mm);
        }
        held
    }
}

/// A reach about to be compared, called through the instruction set dispatch.
struct Holding<'a> {
    table: &'a SpanTable,
    reach: &'a RayReach,
    into: &'a mut Vec<usize>,
}

impl pulp::NullaryFnOnce for Holding<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for (ray, places_mm) in self.reach.rays.clone().zip(&self.reach.places_mm) {
            if self.table.may_hold(ray, *places_mm) {
                self.into.push(ray);
            }
        }
    }
}

impl Row {
    fn new(spans: &[Span]) -> Self {
        let mut row = Self { lows_mm: [f32::INFINITY; SPANS], highs_mm: [f32::NEG_INFINITY; SPANS] };
        for (place, span) in spans.iter().enumerate().take(SPANS) {
            row.lows_mm[place] = (span.low.at_mm as f32).next_down();
            row.highs_mm[place] = (span.high.at_mm as f32).next_up();
        }
        if let (Some(last), true) = (spans.last(), spans.len() > SPANS) {
            row.highs_mm[SPANS - 1] = (last.high.at_mm as f32).next_up();
        }
        row
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dexel::NO_PASS;
    use crate::dexel::intervals::{End, overlaps};
    use proptest::prelude::*;

    proptest! {
        /// Against the spans themselves, also where there are more of them than a row has places for.
        #[test]
        fn whatever_overlaps_is_held(
            ends in proptest::collection::vec(-200.0_f64..200.0, 0..40),
            [a, b] in [-200.0_f64..200.0, -200.0..200.0],
            touching in 0_usize..40,
        ) {
            let mut ends = ends;
            ends.sort_by(f64::total_cmp);
            let end = |at_mm: f64| End { at_mm, pass: NO_PASS, normal: [1.0, 0.0] };
            let spans = ends.as_chunks::<2>().0.iter().map(|[low, high]| Span { low: end(*low), high: end(*high) });
            let spans: Vec<Span> = spans.collect();
            let table = SpanTable::new(std::slice::from_ref(&spans));
            // Also places that only just reach the end of a span, by less than f32 can tell.
            let near = ends.get(touching).map_or(a, |end| end + 1e-9);
            for [from, to] in [[a.min(b), a.max(b)], [near - 0.1, near], [near - 2e-9, near + 0.1]] {
                prop_assert!(table.may_hold(0, [from, to]) || !overlaps(&spans, from, to));
                // With few spans it says no wherever they are clear by a micrometre.
                let near = || overlaps(&spans, from - 1e-3, to + 1e-3);
                prop_assert!(spans.len() > SPANS || !table.may_hold(0, [from, to]) || near());
            }
            prop_assert!(!table.may_hold(0, [f64::INFINITY, f64::NEG_INFINITY]));
        }
    }
}
