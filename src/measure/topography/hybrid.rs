//! Hybrid parameters: root mean square gradient Sdq and developed area ratio Sdr (ISO 25178-2:2021, D.3).
//!
//! Sdq takes forward differences, each direction averaged over its own pairs. Sdr splits every cell of four points along both diagonals and averages the two areas: one diagonal alone would favour
//! a direction. Pairs and cells with a hole are left out.

use super::surface::Surface;

/// Hybrid parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hybrid {
    /// Root mean square gradient, dimensionless; NaN without two measured neighbours in both directions.
    pub sdq: f64,
    /// Developed interfacial area ratio, per cent; NaN without a whole cell.
    pub sdr: f64,
}

impl Hybrid {
    /// Of a surface.
    pub fn of(surface: &Surface) -> Self {
        let (nx, ny) = (surface.nx(), surface.ny());
        let (dx, dy) = (surface.dx_um(), surface.dy_um());
        let squares = |sum: &mut [f64; 6], first: usize, slope: f64| {
            if !slope.is_nan() {
                sum[first] += slope * slope;
                sum[first + 1] += 1.0;
            }
        };
        let [x2, x_pairs, y2, y_pairs, area, cells] = surface.sum_rows(|y, row| {
            let mut sums = [0.0; 6];
            for x in 1..nx {
                squares(&mut sums, 0, (row[x] - row[x - 1]) / dx);
            }
            if y + 1 == ny {
                return sums;
            }
            let next = surface.row(y + 1);
            for x in 0..nx {
                squares(&mut sums, 2, (next[x] - row[x]) / dy);
            }
            for x in 1..nx {
                let [a, b, c, d] = [row[x - 1], row[x], next[x - 1], next[x]];
                // Slopes along the cell's four sides; a triangle lies between one along x and one along y.
                let (ab, cd, ac, bd) = ((b - a) / dx, (d - c) / dx, (c - a) / dy, (d - b) / dy);
                let triangle = |sx: f64, sy: f64| (1.0 + sx * sx + sy * sy).sqrt();
                let mean = 0.25 * (triangle(ab, ac) + triangle(cd, bd) + triangle(ab, bd) + triangle(cd, ac));
                if !mean.is_nan() {
                    sums[4] += mean - 1.0;
                    sums[5] += 1.0;
                }
            }
            sums
        });
        Self { sdq: (x2 / x_pairs + y2 / y_pairs).sqrt(), sdr: 100.0 * area / cells }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilted_plane_has_the_slope_and_area_of_its_tilt() {
        let heights = (0..20).flat_map(|j| (0..30).map(move |i| 0.3 * f64::from(i) * 2.0 + 0.4 * f64::from(j)));
        let mut heights: Vec<f64> = heights.collect();
        for holes in 0..2 {
            let plane = Surface::new(30, 20, 2.0, 1.0, heights.clone()).expect("a grid");
            let hybrid = Hybrid::of(&plane);
            assert!((hybrid.sdq - 0.5).abs() < 1e-12, "{holes}: {hybrid:?}");
            assert!((hybrid.sdr - 100.0 * (1.25_f64.sqrt() - 1.0)).abs() < 1e-10, "{holes}: {hybrid:?}");
            heights[137] = f64::NAN;
        }
    }
}
