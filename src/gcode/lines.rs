//! Straight lines between knots, or arcs, as few of them as a tolerance allows.

/// Ends of the longest lines that fit, one after the other, from place 0 to place `last`; where not even a line to the
/// next place fits, it is taken.
pub fn longest_lines(last: usize, fits: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let mut ends = Vec::new();
    let mut from = 0;
    while from < last {
        // Double the length until it no longer fits, then halve the doubt.
        let (mut good, mut step) = (from + 1, 2);
        while from + step <= last && fits(from, from + step) {
            good = from + step;
            step *= 2;
        }
        let mut bad = (from + step).min(last + 1);
        while bad - good > 1 {
            let middle = usize::midpoint(good, bad);
            if fits(from, middle) { good = middle } else { bad = middle }
        }
        ends.push(good);
        from = good;
    }
    ends
}
