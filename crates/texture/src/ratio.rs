//! The areal material ratio curve (Abbott curve) and what is read from it: Smr(c), Smc(p), Sdc, Sxp, Vm(p), Vv(p).
//!
//! Heights sorted downwards are the curve itself: height k of N stands at the ratio (k + 1/2) / N, straight lines
//! between. No histogram: equal classes of height would cost about a per cent that more classes do not give back. The
//! whole curve needs all heights sorted; a single Smc(p) or Smr(c) does not, and has a function of its own.

use super::sorting::{HeightSelection, measured, sorted};
use super::surface::Surface;
use rayon::prelude::*;

/// Samples summed at a time.
const CHUNK: usize = 1 << 16;
/// Smc(p) at some material ratios alone, um: the numbers of [`MaterialRatio::smc_um`] without sorting more heights than
/// those of their classes.
pub fn smc_um<const N: usize>(surface: &Surface, percent: [f64; N]) -> [f64; N] {
    let level_um = surface.mean_um();
    let mut selection = HeightSelection::of(surface.heights_um(), surface.ends_um());
    let count = selection.count();
    percent.map(|percent| between_um(percent, count, |index| selection.nth_um(index) - level_um))
}

/// Smr(c) alone, per cent: the number of [`MaterialRatio::smr_percent`] by counting.
pub fn smr_percent(surface: &Surface, height_um: f64) -> f64 {
    let level_um = surface.mean_um();
    let of_part = |part: &[f64]| {
        measured(part).map(|z| z - level_um).fold(HeightsBeside::default(), |beside, z| beside.with(z, height_um))
    };
    let beside = surface.heights_um().par_chunks(CHUNK).map(of_part).reduce(HeightsBeside::default, HeightsBeside::and);
    beside.ratio_percent(height_um)
}

/// Heights above and below a level.
#[derive(Clone, Copy)]
struct HeightsBeside {
    /// How many are at it or above, and how many below.
    counts: [usize; 2],
    /// The lowest of the former.
    upper_um: f64,
    /// The highest of the latter.
    lower_um: f64,
}

impl Default for HeightsBeside {
    fn default() -> Self {
        Self { counts: [0; 2], upper_um: f64::INFINITY, lower_um: f64::NEG_INFINITY }
    }
}

impl HeightsBeside {
    fn with(self, z: f64, level_um: f64) -> Self {
        let [above, below] = self.counts;
        if z >= level_um {
            Self { counts: [above + 1, below], upper_um: self.upper_um.min(z), ..self }
        } else {
            Self { counts: [above, below + 1], lower_um: self.lower_um.max(z), ..self }
        }
    }

    fn and(self, other: Self) -> Self {
        Self {
            counts: [0, 1].map(|side| self.counts[side] + other.counts[side]),
            upper_um: self.upper_um.min(other.upper_um),
            lower_um: self.lower_um.max(other.lower_um),
        }
    }

    /// Smr at the level.
    fn ratio_percent(self, level_um: f64) -> f64 {
        match self.counts {
            [0, _] => 0.0,
            [_, 0] => 100.0,
            [above, below] => {
                let part = (self.upper_um - level_um) / (self.upper_um - self.lower_um);
                100.0 * (above as f64 - 0.5 + part) / (above + below) as f64
            }
        }
    }
}

/// Height at a material ratio of `count` heights, of which `nth_um` gives the one of an index downwards.
fn between_um(percent: f64, count: usize, mut nth_um: impl FnMut(usize) -> f64) -> f64 {
    let last = count - 1;
    let index = (percent / 100.0 * count as f64 - 0.5).clamp(0.0, last as f64);
    let low = index.floor() as usize;
    let (upper, lower) = (nth_um(low), nth_um((low + 1).min(last)));
    upper + (index - low as f64) * (lower - upper)
}

/// Heights sorted downwards, um.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialRatio {
    sorted_um: Vec<f64>,
}

impl MaterialRatio {
    /// Curve of a surface about its mean; holes are left out.
    pub fn of(surface: &Surface) -> Self {
        Self { sorted_um: sorted(surface.heights_um(), surface.ends_um(), surface.mean_um()) }
    }

    /// Curve of some heights, of which at least one is not NaN.
    pub fn of_heights(heights_um: &[f64]) -> Self {
        let ends = heights_um.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], z| [l.min(*z), h.max(*z)]);
        Self { sorted_um: sorted(heights_um, ends, 0.0) }
    }

    /// Number of heights.
    pub fn len(&self) -> usize {
        self.sorted_um.len()
    }

    /// No height at all.
    pub fn is_empty(&self) -> bool {
        self.sorted_um.is_empty()
    }

    /// Heights downwards, um.
    pub fn sorted_um(&self) -> &[f64] {
        &self.sorted_um
    }

    /// Highest and lowest height, um.
    pub fn ends_um(&self) -> [f64; 2] {
        [self.sorted_um[0], self.sorted_um[self.sorted_um.len() - 1]]
    }

    /// Smc(p): height at which the material ratio is `percent`, um.
    pub fn smc_um(&self, percent: f64) -> f64 {
        between_um(percent, self.sorted_um.len(), |index| self.sorted_um[index])
    }

    /// Smr(c): share of the area where material stands at or above `height_um`, per cent.
    pub fn smr_percent(&self, height_um: f64) -> f64 {
        let n = self.sorted_um.len();
        let above = self.sorted_um.partition_point(|&z| z >= height_um);
        let at = |index: Option<usize>| index.and_then(|index| self.sorted_um.get(index)).map_or(f64::NAN, |z| *z);
        let (upper_um, lower_um) = (at(above.checked_sub(1)), at(Some(above)));
        HeightsBeside { counts: [above, n - above], upper_um, lower_um }.ratio_percent(height_um)
    }

    /// Vm(p): material above the height at `percent`, per unit area, um.
    pub fn material_um(&self, percent: f64) -> f64 {
        let height = self.smc_um(percent);
        self.excess_um(percent, height)
    }

    /// Vv(p): void below the height at `percent`, per unit area, um.
    pub fn void_um(&self, percent: f64) -> f64 {
        let height = self.smc_um(percent);
        self.shortfall_um(percent, height)
    }

    /// Integral of Smc(q) - `height_um` over the ratios 0 to `percent`, um.
    pub(crate) fn excess_um(&self, percent: f64, height_um: f64) -> f64 {
        self.integral_um(0.0, percent, height_um)
    }

    /// Integral of `height_um` - Smc(q) over the ratios `percent` to 100, um.
    pub(crate) fn shortfall_um(&self, percent: f64, height_um: f64) -> f64 {
        -self.integral_um(percent, 100.0, height_um)
    }

    /// Every height stands for 1/N of the area; the two at the ends count by the part of them that lies inside.
    fn integral_um(&self, from_percent: f64, to_percent: f64, height_um: f64) -> f64 {
        let n = self.sorted_um.len() as f64;
        let (from, to) = (from_percent / 100.0 * n, to_percent / 100.0 * n);
        let (first, end) = ((from.ceil() as usize).min(self.sorted_um.len()), to.floor() as usize);
        if first > end {
            return (to - from) / n * (self.sorted_um[end.min(self.sorted_um.len() - 1)] - height_um);
        }
        let whole: Vec<f64> = self.sorted_um[first..end.min(self.sorted_um.len())]
            .par_chunks(CHUNK)
            .map(|chunk| chunk.iter().map(|z| z - height_um).sum())
            .collect();
        let part = |index: usize, weight: f64| {
            self.sorted_um.get(index).filter(|_| weight > 0.0).map_or(0.0, |z| weight * (z - height_um))
        };
        let ends = part(first.wrapping_sub(1), first as f64 - from) + part(end, to - end as f64);
        (whole.iter().sum::<f64>() + ends) / n
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Selected and counted heights are those of the sorted ones to the last digit: with holes, with many equal
    /// heights, with one far away from all others, and where all are equal.
    #[test]
    fn a_parameter_alone_is_that_of_the_curve() {
        let waves = |i: usize| (0.37 * i as f64).sin() + 0.2 * (0.011 * i as f64).cos();
        let cases: [fn(usize, f64) -> f64; 5] = [
            |_, wave| wave,
            |i, wave| if i % 7 == 3 { f64::NAN } else { wave },
            |_, wave| (3.0 * wave).round(),
            |i, wave| if i == 77 { 1e5 } else { wave },
            |_, _| 0.25,
        ];
        for (case, height) in cases.into_iter().enumerate() {
            let heights = (0..600 * 500).map(|i| height(i, waves(i))).collect();
            let surface = Surface::new(600, 500, 1.0, 1.0, heights).expect("a grid");
            let curve = MaterialRatio::of(&surface);
            let percent = [0.0, 2.5, 10.0, 50.0, 80.0, 99.99, 100.0];
            assert_eq!(smc_um(&surface, percent), percent.map(|percent| curve.smc_um(percent)), "case {case}");
            for height_um in [-2e5, -1.0, -0.3, 0.0, 0.011, 0.8, 2e5] {
                assert_eq!(smr_percent(&surface, height_um), curve.smr_percent(height_um), "case {case}: {height_um}");
            }
        }
    }
}
