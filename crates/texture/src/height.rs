//! Height parameters: Sa, Sq, Ssk, Sku, Sp, Sv, Sz (ISO 25178-2).
//!
//! Population moments (divided by N) about the mean; Sku is 3 for Gaussian heights, nothing is subtracted from it.
//! Holes are left out.

use super::surface::Surface;

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
    /// Of a surface.
    pub fn of(surface: &Surface) -> Self {
        let mean_um = surface.mean_um();
        let [n, s1, s2, s3, s4] = surface.sum_rows(|_, row| {
            let mut sums = [0.0; 5];
            for z in row.iter().filter(|z| !z.is_nan()).map(|z| z - mean_um) {
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
        let [low, high] = surface.ends_um();
        let (sp, sv) = (high - mean_um, mean_um - low);
        let flat = low == high;
        let over = |moment: f64, power: i32| if flat { f64::NAN } else { moment / n / sq.powi(power) };
        Self { sa: s1 / n, sq, ssk: over(s3, 3), sku: over(s4, 4), sp, sv }
    }
}
