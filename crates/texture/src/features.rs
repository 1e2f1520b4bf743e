//! Feature parameters: Spd, Spc, Sha of hills, Svd, Svc, Sda of dales, S10z, S5p, S5v (ISO 25178-2, feature
//! characterisation with Wolf pruning at 5 % of Sz).
//!
//! Hills that reach the edge of the map or a hole are left out: nobody knows how high they rise beyond it. The area is
//! that of all points, nx dx times ny dy.

use super::surface::Surface;
use super::watershed::{Hill, hills};
use crate::error::TextureError;

/// Share of Sz by which a hill must rise.
pub const PRUNING: f64 = 0.05;
/// Peaks and pits whose mean S5p and S5v are.
const FIVE: usize = 5;

/// Feature parameters, each with the reason where it is undefined.
#[derive(Debug, Clone, PartialEq)]
pub struct Features {
    /// Density of peaks, 1/um^2.
    pub spd: Result<f64, TextureError>,
    /// Mean curvature of the peaks, 1/um.
    pub spc: Result<f64, TextureError>,
    /// Mean area of hills, um^2.
    pub sha: Result<f64, TextureError>,
    /// Density of pits, 1/um^2.
    pub svd: Result<f64, TextureError>,
    /// Mean curvature of the pits, 1/um.
    pub svc: Result<f64, TextureError>,
    /// Mean area of dales, um^2.
    pub sda: Result<f64, TextureError>,
    /// Mean height of the five highest peaks over the mean, um.
    pub s5p: Result<f64, TextureError>,
    /// Mean depth of the five deepest pits, um.
    pub s5v: Result<f64, TextureError>,
    /// S5p + S5v, um.
    pub s10z: Result<f64, TextureError>,
}

impl Features {
    /// Of a surface; `sz_um` is its height.
    pub fn of(surface: &Surface, sz_um: f64) -> Self {
        if sz_um == 0.0 {
            let none = || Err(TextureError::FlatSurface);
            return Self {
                spd: none(),
                spc: none(),
                sha: none(),
                svd: none(),
                svc: none(),
                sda: none(),
                s5p: none(),
                s5v: none(),
                s10z: none(),
            };
        }
        let closed = |sign: f64| -> Vec<Hill> {
            hills(surface, sign, PRUNING * sz_um).into_iter().filter(|hill| !hill.open).collect()
        };
        let (peaks, pits) = rayon::join(|| closed(1.0), || closed(-1.0));
        let measured = surface.heights_um().len() - surface.holes();
        let point_um2 = surface.dx_um() * surface.dy_um();
        let area_um2 = measured as f64 * point_um2;
        let mean = |values: Vec<f64>, what: &'static str| match values.len() {
            0 => Err(TextureError::NoFeature { what }),
            count => Ok(values.iter().sum::<f64>() / count as f64),
        };
        let curvatures = |hills: &[Hill], sign: f64, what: &'static str| {
            mean(hills.iter().map(|hill| sign * curvature(surface, hill.peak)).filter(|c| !c.is_nan()).collect(), what)
        };
        let area = |hills: &[Hill], what: &'static str| {
            mean(hills.iter().map(|hill| hill.points as f64 * point_um2).collect(), what)
        };
        let mean_um = surface.mean_um();
        let over = |hill: &Hill| surface.heights_um()[hill.peak] - mean_um;
        let s5p = five(peaks.iter().map(over).collect(), "peaks");
        let s5v = five(pits.iter().map(|pit| -over(pit)).collect(), "pits");
        let s10z = match (&s5p, &s5v) {
            (Ok(p), Ok(v)) => Ok(p + v),
            (Err(why), _) | (_, Err(why)) => Err(why.clone()),
        };
        Self {
            spd: Ok(peaks.len() as f64 / area_um2),
            spc: curvatures(&peaks, 1.0, "hill"),
            sha: area(&peaks, "hill"),
            svd: Ok(pits.len() as f64 / area_um2),
            svc: curvatures(&pits, -1.0, "dale"),
            sda: area(&pits, "dale"),
            s5p,
            s5v,
            s10z,
        }
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
fn five(mut heights_um: Vec<f64>, what: &'static str) -> Result<f64, TextureError> {
    if heights_um.len() < FIVE {
        return Err(TextureError::FewFeatures { found: heights_um.len(), what });
    }
    heights_um.sort_unstable_by(|a, b| b.total_cmp(a));
    Ok(heights_um[..FIVE].iter().sum::<f64>() / FIVE as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// cos(x) cos(y) of 16 by 12 points a wave: hills and dales alike, each a rhombus of half a cell of the waves, with
    /// the curvature A (k_x^2 + k_y^2) / 2, which central differences see as 4 sin^2(k d / 2) / d^2.
    #[test]
    fn an_egg_crate_has_equal_hills_and_dales_of_known_curvature_and_area() {
        let (nx, ny, dx, dy) = (16 * 9 + 1, 12 * 8 + 1, 2.0, 3.0);
        let at = |i: usize| 0.7 * (TAU * (i % nx) as f64 / 16.0).cos() * (TAU * (i / nx) as f64 / 12.0).cos();
        let egg = Surface::new(nx, ny, dx, dy, (0..nx * ny).map(at).collect()).expect("a grid");
        let found = Features::of(&egg, 1.4);
        let near = |value: &Result<f64, TextureError>, closed: f64, share: f64| {
            let value = *value.as_ref().expect("defined");
            assert!((value / closed - 1.0).abs() < share, "{value} is not {closed}");
        };
        let second = |points: f64, d: f64| 4.0 * (TAU / points / 2.0).sin().powi(2) / (d * d);
        let curvature = 0.35 * (second(16.0, dx) + second(12.0, dy));
        near(&found.spc, curvature, 1e-9);
        near(&found.svc, curvature, 1e-9);
        let cell = 0.5 * 16.0 * dx * 12.0 * dy;
        near(&found.sha, cell, 0.05);
        near(&found.sda, cell, 0.05);
        // Those that the edge cuts are left out: of 128 peaks and 127 pits inside, 98 and 97 have whole rhombuses well
        // inside; the corner of a rhombus on the edge may belong to either neighbour.
        let area = (nx * ny) as f64 * dx * dy;
        for (density, inside) in [(&found.spd, 98.0..=128.0), (&found.svd, 97.0..=127.0)] {
            let count = density.as_ref().expect("defined") * area;
            assert!(inside.contains(&count.round()) && (count - count.round()).abs() < 1e-6, "{count}");
        }
    }
}
