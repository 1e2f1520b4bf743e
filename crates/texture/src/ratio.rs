//! The areal material ratio curve (Abbott curve) and what is read from it: Smr(c), Smc(p), Sdc, Sxp, Vm(p), Vv(p).
//!
//! Heights sorted downwards are the curve itself: height k of N stands at the ratio (k + 1/2) / N, straight lines
//! between. No histogram: equal classes of height would cost about a per cent that more classes do not give back.

use super::surface::Surface;
use rayon::prelude::*;

/// Samples summed at a time.
const CHUNK: usize = 1 << 16;
/// Heights laid into classes at a time.
const PART: usize = 1 << 18;
/// Heights of a class on average: few enough to be sorted in the nearest cache.
const IN_A_CLASS: usize = 256;
/// Sign of a float among its bits.
const SIGN: u64 = 1 << 63;

/// Whole number that is the smaller the higher a point stands: whole numbers are sorted faster than floats.
fn key(height: f64) -> u64 {
    let bits = height.to_bits();
    if height.is_sign_negative() { bits } else { !(bits | SIGN) }
}

/// Height of a key.
fn height(key: u64) -> f64 {
    f64::from_bits(if key & SIGN != 0 { key } else { !key & !SIGN })
}

/// Keys of some heights, class after class.
struct ClassedKeys {
    keys: Vec<u64>,
    /// Where every class begins, and where the last ends.
    starts: Vec<usize>,
}

impl ClassedKeys {
    fn of(heights_um: &[f64], classes: usize, class: impl Fn(f64) -> usize) -> Self {
        let measured = || heights_um.iter().copied().filter(|z| !z.is_nan());
        let mut starts = vec![0; classes + 1];
        measured().for_each(|z| starts[class(z) + 1] += 1);
        for i in 0..classes {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut keys = vec![0; starts[classes]];
        for z in measured() {
            let place = &mut next[class(z)];
            keys[*place] = key(z);
            *place += 1;
        }
        Self { keys, starts }
    }

    fn class(&self, class: usize) -> &[u64] {
        &self.keys[self.starts[class]..self.starts[class + 1]]
    }
}

/// Heights over `level_um`, sorted downwards; holes are left out. Classes of equal height part them, so that each is
/// sorted by itself: heights that all lie in a few of them take no longer than sorting without classes.
fn sorted(heights_um: &[f64], [low, high]: [f64; 2], level_um: f64) -> Vec<f64> {
    let classes = (heights_um.len() / IN_A_CLASS).clamp(1, 1 << 14);
    let per_um = if high > low { classes as f64 / (high - low) } else { 0.0 };
    let class = |z: f64| (((high - z) * per_um) as usize).min(classes - 1);
    let parts: Vec<ClassedKeys> =
        heights_um.par_chunks(PART).map(|part| ClassedKeys::of(part, classes, class)).collect();
    let mut sorted_um = vec![0.0; parts.iter().map(|part| part.keys.len()).sum()];
    let mut rest = sorted_um.as_mut_slice();
    let mut places = Vec::with_capacity(classes);
    for class in 0..classes {
        let (place, after) = rest.split_at_mut(parts.iter().map(|part| part.class(class).len()).sum());
        places.push(place);
        rest = after;
    }
    places.into_par_iter().enumerate().for_each_init(Vec::new, |keys, (class, place)| {
        keys.clear();
        for part in &parts {
            keys.extend_from_slice(part.class(class));
        }
        keys.sort_unstable();
        for (z, &key) in place.iter_mut().zip(keys.iter()) {
            *z = height(key) - level_um;
        }
    });
    sorted_um
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
        self.height_at_um(percent / 100.0 * self.sorted_um.len() as f64 - 0.5)
    }

    /// Height at a fractional index of the sorted heights.
    pub(crate) fn height_at_um(&self, index: f64) -> f64 {
        let last = self.sorted_um.len() - 1;
        let index = index.clamp(0.0, last as f64);
        let low = index.floor() as usize;
        let high = (low + 1).min(last);
        self.sorted_um[low] + (index - low as f64) * (self.sorted_um[high] - self.sorted_um[low])
    }

    /// Smr(c): share of the area where material stands at or above `height_um`, per cent.
    pub fn smr_percent(&self, height_um: f64) -> f64 {
        let n = self.sorted_um.len();
        let above = self.sorted_um.partition_point(|&z| z >= height_um);
        if above == 0 {
            return 0.0;
        }
        if above == n {
            return 100.0;
        }
        let (upper, lower) = (self.sorted_um[above - 1], self.sorted_um[above]);
        let part = (upper - height_um) / (upper - lower);
        100.0 * (above as f64 - 0.5 + part) / n as f64
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
