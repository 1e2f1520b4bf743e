//! Hybrid parameters: root mean square gradient Sdq and developed area ratio Sdr (ISO 25178-2:2021, D.3).
//!
//! Sdq takes forward differences, each direction averaged over its own pairs. Sdr splits every cell of four points
//! along both diagonals and averages the two areas: one diagonal alone would favour a direction. Pairs and cells with a
//! hole are left out.

use super::surface::Surface;

/// Values taken at a time, so that the compiler can use vectors; their sums are folded in a fixed order.
const LANES: usize = 8;

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
        Self { sdq: sdq(surface), sdr: sdr(surface) }
    }
}

/// Root mean square gradient Sdq, dimensionless; NaN without two measured neighbours in both directions.
pub fn sdq(surface: &Surface) -> f64 {
    let (nx, ny) = (surface.nx(), surface.ny());
    let square = |[low, high]: [f64; 2]| (high - low) * (high - low);
    let [x2, x_pairs, y2, y_pairs] = surface.sum_rows(|y, row| {
        let [x2, x_pairs] = sum_measured([&row[..nx - 1], &row[1..]], square);
        let [y2, y_pairs] = if y + 1 < ny { sum_measured([row, surface.row(y + 1)], square) } else { [0.0; 2] };
        [x2, x_pairs, y2, y_pairs]
    });
    (x2 / x_pairs / surface.dx_um().powi(2) + y2 / y_pairs / surface.dy_um().powi(2)).sqrt()
}

/// Developed interfacial area ratio Sdr, per cent; NaN without a whole cell.
pub fn sdr(surface: &Surface) -> f64 {
    let (nx, ny) = (surface.nx(), surface.ny());
    let (per_dx, per_dy) = (1.0 / surface.dx_um(), 1.0 / surface.dy_um());
    let excess = |[a, b, c, d]: [f64; 4]| {
        // Slopes along the cell's four sides, squared; a triangle lies between one along x and one along y.
        let square = |low: f64, high: f64, per_step: f64| ((high - low) * per_step).powi(2);
        let (ab, cd) = (square(a, b, per_dx), square(c, d, per_dx));
        let (ac, bd) = (square(a, c, per_dy), square(b, d, per_dy));
        let triangle = |x: f64, y: f64| (1.0 + x + y).sqrt();
        0.25 * (triangle(ab, ac) + triangle(cd, bd) + triangle(ab, bd) + triangle(cd, ac)) - 1.0
    };
    let [area, cells] = surface.sum_rows(|y, row| {
        if y + 1 == ny {
            return [0.0; 2];
        }
        let next = surface.row(y + 1);
        sum_measured([&row[..nx - 1], &row[1..], &next[..nx - 1], &next[1..]], excess)
    });
    100.0 * area / cells
}

/// Sum and number of the values that are not NaN, of lines of equal length.
#[inline]
fn sum_measured<const N: usize>(lines: [&[f64]; N], value: impl Fn([f64; N]) -> f64) -> [f64; 2] {
    let (mut sums, mut counts) = ([0.0; LANES], [0.0; LANES]);
    let mut add = |lane: usize, value: f64| {
        sums[lane] += if value.is_nan() { 0.0 } else { value };
        counts[lane] += if value.is_nan() { 0.0 } else { 1.0 };
    };
    let blocks = lines.map(<[f64]>::as_chunks::<LANES>);
    for index in 0..blocks[0].0.len() {
        let block = blocks.map(|(whole, _)| whole[index]);
        for lane in 0..LANES {
            add(lane, value(block.map(|values| values[lane])));
        }
    }
    for lane in 0..blocks[0].1.len() {
        add(lane, value(blocks.map(|(_, rest)| rest[lane])));
    }
    [sums.iter().sum(), counts.iter().sum()]
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

    /// Parabolic marks z = (x / p)^2 um have the slope 1 / (p sqrt(3)). Of N steps per mark one lies across a cusp; for
    /// want of its slope Sdq is 1 / N too small.
    #[test]
    fn marks_of_few_points_lose_slope_at_their_cusps() {
        for steps in [10.37, 20.37, 80.37_f64] {
            let row = |i: usize| (i as f64 / steps - (i as f64 / steps).round()).powi(2);
            let marks =
                Surface::new(20_000, 2, 1.0, 1.0, (0..40_000).map(|i| row(i % 20_000)).collect()).expect("a grid");
            let lost = 1.0 - sdq(&marks) * steps * 3_f64.sqrt();
            assert!((lost * steps - 1.0).abs() < 0.1, "{steps} steps: {lost}");
        }
    }
}
