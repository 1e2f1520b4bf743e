//! Height parameters: Sa, Sq, Ssk, Sku, Sp, Sv, Sz (ISO 25178-2).
//!
//! Population moments (divided by N) about the mean; Sku is 3 for Gaussian heights, nothing is subtracted from it.
//! Holes are left out.

use super::surface::Surface;
use rayon::prelude::*;

/// Height parameters; heights in um.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heights {
    /// Arithmetical mean height.
    pub sa: f64,
    /// Root mean square height.
    pub sq: f64,
    /// Skewness; NaN on a flat surface.
    pub ssk: f64,
    /// Kurtosis; NaN on a flat surface.
    pub sku: f64,
    /// Largest peak height.
    pub sp: f64,
    /// Largest pit depth.
    pub sv: f64,
}

impl Heights {
    /// Of a surface about its mean ([`Surface::centred`]).
    pub fn of(centred: &Surface) -> Self {
        let [n, s1, s2, s3, s4] = centred.sum_rows(|_, row| {
            let mut sums = [0.0; 5];
            for &z in row.iter().filter(|z| !z.is_nan()) {
                let z2 = z * z;
                sums[0] += 1.0;
                sums[1] += z.abs();
                sums[2] += z2;
                sums[3] += z2 * z;
                sums[4] += z2 * z2;
            }
            sums
        });
        let sq = (s2 / n).sqrt();
        // Largest and smallest pass over holes: NaN is neither.
        let sp = centred.heights_um().par_iter().copied().reduce(|| f64::NEG_INFINITY, f64::max);
        let sv = -centred.heights_um().par_iter().copied().reduce(|| f64::INFINITY, f64::min);
        let flat = sp + sv == 0.0;
        let over = |moment: f64, power: i32| if flat { f64::NAN } else { moment / n / sq.powi(power) };
        Self { sa: s1 / n, sq, ssk: over(s3, 3), sku: over(s4, 4), sp, sv }
    }
}
