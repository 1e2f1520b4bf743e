//! The Sk family: core height, reduced peaks and dales (ISO 25178-2:2021 with the construction of ISO 13565-2, clause
//! 4).
//!
//! 1. Of all windows 40 % of the ratio wide, the one in which the curve drops least; the first of several.
//! 2. The **least-squares** straight line of the curve inside that window, continued to 0 % and 100 %: heights y_u and
//!    y_l. The secant of the window instead, as some codes take it, makes Sk of Gaussian heights 1.9 % too large.
//! 3. Sk = y_u - y_l; Smrk1 and Smrk2 (Smr1 and Smr2 before the edition of 2021) are where the curve meets those
//!    heights.
//! 4. Hills above y_u and dales below y_l as right-angled triangles of the same area on Smrk1 and 100 - Smrk2: Spk and
//!    Svk; 0 where the region is empty.

use super::ratio::MaterialRatio;
use rayon::prelude::*;

/// Width of the window.
const WINDOW: f64 = 0.4;
/// Windows whose drops differ by less than this share of the height are tied.
const TIE: f64 = 1e-9;

/// Sk family; heights in um, ratios in per cent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Core {
    /// Core height.
    pub sk: f64,
    /// Reduced peak height.
    pub spk: f64,
    /// Reduced dale height.
    pub svk: f64,
    /// Material ratio of the hills.
    pub smr1: f64,
    /// Material ratio above the dales.
    pub smr2: f64,
    /// Height of the highest point over the core.
    pub spkx: f64,
    /// Depth of the lowest point under the core.
    pub svkx: f64,
    /// Volume of the hills above the core per unit area, um.
    pub sak1: f64,
    /// Volume of the dales below the core per unit area, um.
    pub sak2: f64,
    /// Equivalent line at 0 %, um over the mean.
    pub upper_um: f64,
    /// Equivalent line at 100 %, um over the mean.
    pub lower_um: f64,
    /// Where the window begins, per cent; it is 40 % wide.
    pub window_percent: f64,
}

impl Core {
    /// Of a curve.
    pub fn of(curve: &MaterialRatio) -> Self {
        let sorted = curve.sorted_um();
        let n = sorted.len();
        let [top, bottom] = curve.ends_um();
        let width = WINDOW * n as f64;
        // Windows from one height to a place 40 % further, which may lie between two heights.
        let whole = width.floor() as usize;
        let part = width - whole as f64;
        let last = ((1.0 - WINDOW) * n as f64).floor() as usize;
        let drop = |start: usize| {
            let low = sorted[(start + whole).min(n - 1)];
            let lower = sorted[(start + whole + 1).min(n - 1)];
            sorted[start] - (low + part * (lower - low))
        };
        let tie = TIE * (top - bottom);
        let starts = last.min(n - 1) + 1;
        let least = (0..starts).into_par_iter().map(drop).reduce(|| f64::INFINITY, f64::min);
        let start = (0..starts).find(|&start| drop(start) <= least + tie).unwrap_or(0);
        let [intercept, slope] = line(sorted, start, (start + whole).min(n - 1));
        let at = |percent: f64| intercept + slope * (percent / 100.0 * n as f64 - 0.5);
        let (upper_um, lower_um) = (at(0.0), at(100.0));
        let smr1 = if upper_um >= top { 0.0 } else { curve.smr_percent(upper_um) };
        let smr2 = if lower_um <= bottom { 100.0 } else { curve.smr_percent(lower_um) };
        let sak1 = if smr1 > 0.0 { curve.excess_um(smr1, upper_um) } else { 0.0 };
        let sak2 = if smr2 < 100.0 { curve.shortfall_um(smr2, lower_um) } else { 0.0 };
        Self {
            sk: upper_um - lower_um,
            spk: if smr1 > 0.0 { 200.0 * sak1 / smr1 } else { 0.0 },
            svk: if smr2 < 100.0 { 200.0 * sak2 / (100.0 - smr2) } else { 0.0 },
            smr1,
            smr2,
            spkx: (top - upper_um).max(0.0),
            svkx: (lower_um - bottom).max(0.0),
            sak1,
            sak2,
            upper_um,
            lower_um,
            window_percent: 100.0 * (start as f64 + 0.5) / n as f64,
        }
    }
}

/// Least-squares line of heights `first..=last` over their index: value at index 0 and slope per index.
fn line(sorted: &[f64], first: usize, last: usize) -> [f64; 2] {
    let window = &sorted[first..=last];
    let n = window.len() as f64;
    let middle = 0.5 * (first + last) as f64;
    let mean = window.iter().sum::<f64>() / n;
    let (xx, xz) = window.iter().enumerate().fold((0.0, 0.0), |(xx, xz), (i, z)| {
        let x = (first + i) as f64 - middle;
        (xx + x * x, xz + x * (z - mean))
    });
    let slope = if xx > 0.0 { xz / xx } else { 0.0 };
    [mean - slope * middle, slope]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quantiles of a distribution as heights.
    fn curve(quantile: impl Fn(f64) -> f64, n: usize) -> MaterialRatio {
        MaterialRatio::of_heights(&(0..n).map(|k| quantile((k as f64 + 0.5) / n as f64)).collect::<Vec<_>>())
    }

    /// A parabolic cusp of height 1: z = (2x - 1)^2, of which the share 1 - sqrt(z) stands above z.
    fn cusp() -> MaterialRatio {
        curve(|p| (1.0 - p).powi(2) - 1.0 / 3.0, 200_000)
    }

    #[test]
    fn a_parabolic_cusp_has_its_closed_form() {
        let core = Core::of(&cusp());
        let expected = [
            (core.sk, 0.4),
            (core.spk, 0.5762),
            (core.svk, 0.0),
            (core.smr1, 38.90),
            (core.smr2, 100.0),
            (core.window_percent, 60.0),
        ];
        for (value, closed) in expected {
            assert!((value - closed).abs() <= 1e-4 * closed.max(1.0), "{value} is not {closed}");
        }
        let volumes = [
            (cusp().material_um(10.0), 0.009333),
            (cusp().material_um(80.0) - cusp().material_um(10.0), 0.28933),
            (cusp().void_um(10.0) - cusp().void_um(80.0), 0.48067),
            (cusp().void_um(80.0), 0.005333),
        ];
        for (value, closed) in volumes {
            assert!((value - closed).abs() <= 1e-5, "{value} is not {closed}");
        }
    }

    /// The triangle of a straight curve has no hills and dales; a flat surface has no core either.
    #[test]
    fn straight_and_flat_curves_leave_nothing_over() {
        let core = Core::of(&curve(|p| 0.5 - p, 10_000));
        assert!((core.sk - 1.0).abs() < 1e-9 && core.spk.abs() < 1e-9 && core.svk.abs() < 1e-9, "{core:?}");
        let flat = Core::of(&curve(|_| 0.0, 15));
        assert_eq!((flat.sk, flat.spk, flat.svk), (0.0, 0.0, 0.0));
    }

    #[test]
    fn ratio_and_height_are_inverse() {
        let curve = cusp();
        for percent in [2.5, 10.0, 50.0, 80.0, 97.0] {
            let there = curve.smr_percent(curve.smc_um(percent));
            assert!((there - percent).abs() < 1e-9, "{percent}: {there}");
        }
        assert_eq!((curve.smr_percent(9.0), curve.smr_percent(-9.0)), (0.0, 100.0));
    }

    /// A few heights only: integrals over parts of them stay exact for the steps they stand for.
    #[test]
    fn integrals_of_few_heights_are_those_of_steps() {
        let curve = MaterialRatio::of_heights(&[3.0, 1.0, 0.0, f64::NAN]);
        assert!((curve.excess_um(100.0, 0.0) - 4.0 / 3.0).abs() < 1e-12);
        assert!((curve.excess_um(50.0, 0.0) - (3.0 + 0.5) / 3.0).abs() < 1e-12);
        assert!((curve.excess_um(20.0, 0.0) - 0.6).abs() < 1e-12);
        assert!((curve.shortfall_um(50.0, 1.0) - 1.0 / 3.0).abs() < 1e-12);
    }
}
