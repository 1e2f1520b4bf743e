//! Feature parameters: Spd, Spc, S10z, S5p, S5v (ISO 25178-2, feature characterisation with Wolf pruning at 5 % of Sz).
//!
//! Hills that reach the edge of the map or a hole are left out: nobody knows how high they rise beyond it. The area is
//! that of all points, nx dx times ny dy.

use super::surface::Surface;
use super::watershed::{Hill, hills};

/// Share of Sz by which a hill must rise.
pub const PRUNING: f64 = 0.05;
/// Peaks and pits whose mean S5p and S5v are.
const FIVE: usize = 5;

/// Feature parameters, each with the reason where it is undefined.
#[derive(Debug, Clone, PartialEq)]
pub struct Features {
    /// Density of peaks, 1/um^2.
    pub spd: Result<f64, String>,
    /// Mean curvature of the peaks, 1/um.
    pub spc: Result<f64, String>,
    /// Mean height of the five highest peaks over the mean, um.
    pub s5p: Result<f64, String>,
    /// Mean depth of the five deepest pits, um.
    pub s5v: Result<f64, String>,
    /// S5p + S5v, um.
    pub s10z: Result<f64, String>,
}

impl Features {
    /// Of a surface about its mean; `sz_um` is its height.
    pub fn of(centred: &Surface, sz_um: f64) -> Self {
        if sz_um == 0.0 {
            let none = || Err("the surface is flat".to_owned());
            return Self { spd: none(), spc: none(), s5p: none(), s5v: none(), s10z: none() };
        }
        let closed = |sign: f64| -> Vec<Hill> {
            hills(centred, sign, PRUNING * sz_um).into_iter().filter(|hill| !hill.open).collect()
        };
        let (peaks, pits) = rayon::join(|| closed(1.0), || closed(-1.0));
        let measured = centred.heights_um().len() - centred.holes();
        let area_um2 = measured as f64 * centred.dx_um() * centred.dy_um();
        let curvatures: Vec<f64> =
            peaks.iter().map(|hill| curvature(centred, hill.peak)).filter(|c| !c.is_nan()).collect();
        let spc = if curvatures.is_empty() {
            Err("no hill lies wholly inside the window".to_owned())
        } else {
            Ok(curvatures.iter().sum::<f64>() / curvatures.len() as f64)
        };
        let s5p = five(centred, &peaks, 1.0, "peaks");
        let s5v = five(centred, &pits, -1.0, "pits");
        let s10z = match (&s5p, &s5v) {
            (Ok(p), Ok(v)) => Ok(p + v),
            (Err(why), _) | (_, Err(why)) => Err(why.clone()),
        };
        Self { spd: Ok(peaks.len() as f64 / area_um2), spc, s5p, s5v, s10z }
    }
}

/// -(zxx + zyy) / 2 by central second differences; NaN beside a hole.
fn curvature(surface: &Surface, peak: usize) -> f64 {
    let nx = surface.nx();
    let z = surface.heights_um();
    let second = |step: usize, d: f64| (z[peak - step] - 2.0 * z[peak] + z[peak + step]) / (d * d);
    -0.5 * (second(1, surface.dx_um()) + second(nx, surface.dy_um()))
}

/// Mean of the five largest.
fn five(surface: &Surface, hills: &[Hill], sign: f64, what: &str) -> Result<f64, String> {
    if hills.len() < FIVE {
        return Err(format!("only {} significant {what} lie wholly inside the window, five are needed", hills.len()));
    }
    let mut heights: Vec<f64> = hills.iter().map(|hill| sign * surface.heights_um()[hill.peak]).collect();
    heights.sort_unstable_by(|a, b| b.total_cmp(a));
    Ok(heights[..FIVE].iter().sum::<f64>() / FIVE as f64)
}
