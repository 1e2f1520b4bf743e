//! Largest value of a function that is sampled densely enough.
//!
//! In: a function and an even grid on which its largest hump is wider than two cells. Out: place and value of the
//! maximum, by golden-section search around the best sample. It needs no derivative and accepts kinks; the value is
//! good to rounding, the place of a smooth maximum to the square root of it.
//!
//! It cannot fail: every step leaves 0.618 of the bracket, which ends the search after some 50 evaluations beside those
//! of the grid. A function that is not a number anywhere on the grid but at its beginning gives that place.

/// Width of the last bracket, as a share of 1 + |place|: the value of a smooth maximum changes by its square, below
/// rounding.
const LAST_BRACKET: f64 = 1e-10;

/// Place and value of the maximum over `cells` even cells of [lo, hi].
pub fn maximum(f: impl Fn(f64) -> f64, lo: f64, hi: f64, cells: usize) -> (f64, f64) {
    let place = |i: usize| lo + (hi - lo) * i as f64 / cells.max(1) as f64;
    let mut best = (lo, f(lo));
    let mut best_index = 0;
    for i in 1..=cells {
        let value = f(place(i));
        if value > best.1 {
            best = (place(i), value);
            best_index = i;
        }
    }
    let (mut a, mut b) = (place(best_index.saturating_sub(1)), place((best_index + 1).min(cells)));
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut c, mut d) = (b - golden * (b - a), a + golden * (b - a));
    let (mut at_c, mut at_d) = (f(c), f(d));
    while b - a > LAST_BRACKET * (1.0 + a.abs()) {
        if at_c > at_d {
            (b, d, at_d) = (d, c, at_c);
            c = b - golden * (b - a);
            at_c = f(c);
        } else {
            (a, c, at_c) = (c, d, at_d);
            d = a + golden * (b - a);
            at_d = f(d);
        }
    }
    [(c, at_c), (d, at_d)].into_iter().fold(best, |best, here| if here.1 > best.1 { here } else { best })
}

#[cfg(test)]
mod tests {
    use super::maximum;

    #[test]
    fn finds_smooth_and_kinked_maxima() {
        let (place, value) = maximum(|x| (3.0 * x).cos(), 1.0, 3.0, 20);
        assert!((value - 1.0).abs() < 1e-15 && (place - std::f64::consts::TAU / 3.0).abs() < 1e-7);
        let (place, value) = maximum(|x| -(x - 0.123_f64).abs(), 0.0, 1.0, 10);
        assert!(value.abs() < 1e-9 && (place - 0.123).abs() < 1e-9);
        assert_eq!(maximum(|x| x, 0.0, 1.0, 4), (1.0, 1.0));
        assert_eq!(maximum(|x| x, 2.0, 2.0, 4), (2.0, 2.0));
    }

    #[test]
    fn ends_after_some_fifty_evaluations_whatever_the_function() {
        for lost in [f64::NAN, f64::INFINITY] {
            let count = std::cell::Cell::new(0);
            let (place, _) = maximum(
                |x| {
                    count.set(count.get() + 1);
                    if x > 0.5 { lost } else { x }
                },
                0.0,
                1.0,
                10,
            );
            assert!((0.0..=1.0).contains(&place) && count.get() < 11 + 60, "{place} after {}", count.get());
        }
    }
}
