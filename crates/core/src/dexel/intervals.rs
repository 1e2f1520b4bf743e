//! Material on one ray of the blank: sorted, disjoint spans, each end with the pass that left it and the surface's
//! normal there.
//!
//! The law is subtraction of closed intervals in order of time. A pass that ends exactly where an earlier one ended
//! removes nothing, so the earlier one, which has the lower id, keeps its mark: ties need no rule of their own. Lists
//! grow as they must; there is no capacity to run out of.

use super::NO_PASS;
use glam::DVec2;

/// Shorter remnants are dropped and counted as removed: a picometre is what rounding leaves between two strokes, not
/// material.
pub const LEAST_SPAN_MM: f64 = 1e-9;

/// One end of a span.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// Coordinate along the ray, mm.
    pub at_mm: f64,
    /// Pass that left this surface, or [`NO_PASS`]: the blank's own.
    pub pass: u32,
    /// Unit normal out of the material, gear frame.
    pub normal: [f32; 2],
}

/// Material between two ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// End at the smaller coordinate.
    pub low: End,
    /// End at the larger coordinate.
    pub high: End,
}

impl End {
    /// End on the blank's own surface.
    pub fn of_blank(at_mm: f64, normal: DVec2) -> Self {
        Self { at_mm, pass: NO_PASS, normal: normal.as_vec2().to_array() }
    }
}

impl Span {
    /// Length in mm.
    pub fn length_mm(&self) -> f64 {
        self.high.at_mm - self.low.at_mm
    }
}

/// Length of all spans, mm.
pub fn length_mm(spans: &[Span]) -> f64 {
    spans.iter().map(Span::length_mm).sum()
}

/// Whether a coordinate lies in material.
pub fn contains(spans: &[Span], at_mm: f64) -> bool {
    let next = spans.partition_point(|s| s.high.at_mm <= at_mm);
    spans.get(next).is_some_and(|s| s.low.at_mm <= at_mm)
}

/// Whether any material lies between two coordinates.
pub fn overlaps(spans: &[Span], low_mm: f64, high_mm: f64) -> bool {
    let next = spans.partition_point(|s| s.high.at_mm <= low_mm);
    spans.get(next).is_some_and(|s| s.low.at_mm < high_mm)
}

/// Length of material between two coordinates, mm.
pub fn overlap_mm(spans: &[Span], low_mm: f64, high_mm: f64) -> f64 {
    let first = spans.partition_point(|s| s.high.at_mm <= low_mm);
    spans[first..]
        .iter()
        .take_while(|s| s.low.at_mm < high_mm)
        .map(|s| s.high.at_mm.min(high_mm) - s.low.at_mm.max(low_mm))
        .sum()
}

/// Takes the material between `from` and `to` away; these become the ends of what is left. Gives the length removed,
/// mm.
pub fn subtract(spans: &mut Vec<Span>, from: End, to: End) -> f64 {
    let first = spans.partition_point(|s| s.high.at_mm <= from.at_mm);
    let met = spans[first..].partition_point(|s| s.low.at_mm < to.at_mm);
    if met == 0 {
        return 0.0;
    }
    let last = first + met;
    let mut removed_mm = length_mm(&spans[first..last]);
    let mut keep = |span: Span| {
        let long = span.length_mm() > LEAST_SPAN_MM;
        removed_mm -= if long { span.length_mm() } else { 0.0 };
        long.then_some(span)
    };
    let before = keep(Span { low: spans[first].low, high: from });
    let after = keep(Span { low: to, high: spans[last - 1].high });
    match (before, after) {
        // By far the most frequent: a chip off one end.
        (Some(rest), None) | (None, Some(rest)) if met == 1 => spans[first] = rest,
        _ => drop(spans.splice(first..last, before.into_iter().chain(after))),
    }
    removed_mm
}

/// Intervals of `wanted` that `present` does not cover, as pairs of coordinates.
pub fn missing(wanted: &[[f64; 2]], present: &[Span]) -> Vec<[f64; 2]> {
    let mut gaps = Vec::new();
    for &[low, high] in wanted {
        let mut at = low;
        let first = present.partition_point(|s| s.high.at_mm <= low);
        for span in present[first..].iter().take_while(|s| s.low.at_mm < high) {
            if span.low.at_mm > at {
                gaps.push([at, span.low.at_mm]);
            }
            at = at.max(span.high.at_mm);
        }
        if at < high {
            gaps.push([at, high]);
        }
    }
    gaps
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn end(at_mm: f64, pass: u32) -> End {
        End { at_mm, pass, normal: [1.0, 0.0] }
    }

    #[test]
    fn a_tie_keeps_the_earlier_pass() {
        let mut spans = vec![Span { low: end(0.0, NO_PASS), high: end(10.0, NO_PASS) }];
        assert_eq!(subtract(&mut spans, end(4.0, 1), end(12.0, 1)), 6.0);
        assert_eq!(subtract(&mut spans, end(4.0, 2), end(12.0, 2)), 0.0);
        assert_eq!(spans, vec![Span { low: end(0.0, NO_PASS), high: end(4.0, 1) }]);
    }

    #[test]
    fn gaps_are_what_is_wanted_and_not_there() {
        let spans = [Span { low: end(1.0, 0), high: end(2.0, 0) }, Span { low: end(3.0, 0), high: end(9.0, 0) }];
        assert_eq!(missing(&[[0.0, 4.0], [8.0, 10.0]], &spans), [[0.0, 1.0], [2.0, 3.0], [9.0, 10.0]]);
        assert_eq!(overlap_mm(&spans, 1.5, 3.5), 1.0);
        assert!(contains(&spans, 1.5) && !contains(&spans, 2.5) && !overlaps(&spans, 2.0, 3.0));
    }

    proptest! {
        /// Against a bitmap of a thousand cells: what is left, what was removed, order and disjointness.
        #[test]
        fn subtraction_is_that_of_sets(cuts in proptest::collection::vec((0_u32..1000, 1_u32..400), 1..40)) {
            let mut spans = vec![Span { low: end(0.0, NO_PASS), high: end(1000.0, NO_PASS) }];
            let mut cells = vec![NO_PASS; 1000];
            for (pass, &(from, length)) in cuts.iter().enumerate() {
                let to = (from + length).min(1000);
                let there = cells[from as usize..to as usize].iter().filter(|&&c| c == NO_PASS).count();
                cells[from as usize..to as usize].fill(0);
                let removed = subtract(&mut spans, end(f64::from(from), pass as u32), end(f64::from(to), pass as u32));
                prop_assert_eq!(removed, there as f64);
            }
            for (index, &cell) in cells.iter().enumerate() {
                prop_assert_eq!(contains(&spans, index as f64 + 0.5), cell == NO_PASS);
            }
            prop_assert!(spans.windows(2).all(|s| s[0].high.at_mm < s[1].low.at_mm));
        }
    }
}
