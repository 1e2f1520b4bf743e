//! How coarse the steps of an instrument's heights are.
//!
//! In: heights as they were read. Out: the step, where all of them are whole numbers of one, and it is so coarse that
//! it shows in the parameters: the root mean square height is below ten steps. Slopes, peaks and the curve's ends then
//! are those of the converter and not of the surface.

use super::surface::Surface;
use std::collections::BTreeSet;

/// Steps that the root mean square height should have.
const FEWEST: f64 = 10.0;
/// Different heights above which steps are no longer looked for: coarse ones have some hundred at most.
const MOST: usize = 2000;
/// How far a distance of heights may be off a whole number of steps.
const OFF: f64 = 0.02;

/// The step of a surface's heights, um, where it is coarser than a tenth of their root mean square height.
pub fn coarse_step_um(surface: &Surface) -> Option<f64> {
    let mut different = BTreeSet::new();
    let key = |z: f64| {
        let bits = z.to_bits() as i64;
        bits ^ ((bits >> 63) as u64 >> 1) as i64
    };
    let mut last = f64::NAN;
    for &z in surface.heights_um().iter().filter(|z| !z.is_nan()) {
        if z != last {
            different.insert(key(z + 0.0));
            last = z;
        }
        if different.len() > MOST {
            return None;
        }
    }
    let heights: Vec<f64> =
        different.into_iter().map(|key| f64::from_bits((key ^ ((key >> 63) as u64 >> 1) as i64) as u64)).collect();
    let range = heights.last()? - heights.first()?;
    let gaps: Vec<f64> = heights.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > 1e-9 * range).collect();
    let step = gaps.iter().copied().reduce(f64::min)?;
    let mean = surface.mean_um();
    let [squares, count] = surface.sum_rows(|_, row| {
        row.iter().filter(|z| !z.is_nan()).fold([0.0, 0.0], |[sum, n], z| [sum + (z - mean) * (z - mean), n + 1.0])
    });
    let whole = |gap: &f64| (gap / step - (gap / step).round()).abs() <= OFF;
    (step * FEWEST > (squares / count).sqrt() && gaps.len() > 1 && gaps.iter().all(whole)).then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(height: impl Fn(f64) -> f64) -> Option<f64> {
        let heights = (0..200 * 50).map(|i| height(f64::from(i % 200) + 0.37 * f64::from(i / 200))).collect();
        coarse_step_um(&Surface::new(200, 50, 1.0, 1.0, heights).expect("a grid"))
    }

    #[test]
    fn steps_are_found_where_they_are_coarse_and_only_there() {
        let wave = |x: f64| (0.11 * x).sin() - 3.0;
        let found = step(|x| (wave(x) / 0.2).round() * 0.2).expect("five steps in the amplitude");
        assert!((found - 0.2).abs() < 1e-9, "{found}");
        assert_eq!(step(|x| (wave(x) / 0.01).round() * 0.01), None, "fine steps");
        assert_eq!(step(wave), None, "no steps");
        // Whole waves of few points have few heights, but no step.
        assert_eq!(step(|x| (std::f64::consts::TAU * x.floor() / 20.0).sin()), None);
        assert_eq!(step(|_| 1.0), None, "a flat surface");
    }
}
