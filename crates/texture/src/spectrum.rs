//! Fourier transforms of a surface: the autocorrelation, and the power of its waves.
//!
//! **Autocorrelation.** Padded with zeros to twice its size, transformed, squared and transformed back, a surface gives
//! the sum of products at every lag **without** wrap-around; divided by the number of points that overlap it is the
//! unbiased linear autocorrelation. Road not taken: the circular one. It correlates the upper edge with the lower one,
//! which moves Sal by several per cent.
//!
//! **Power.** The transform about the mean without padding, from which directions and wavelengths are read.

use rayon::prelude::*;
use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::columns::by_columns;
use super::surface::Surface;

/// Rows transformed back at a time.
const ROWS: usize = 8;

/// Sums of products over lags (tx, ty): ty from 0 upwards, tx from -(nx - 1) to nx - 1.
pub(crate) struct Products {
    /// Points along x of the surface.
    pub nx: usize,
    /// Points along y.
    pub ny: usize,
    /// Row by row of ty; `tx` stands at column `tx + nx - 1`.
    pub sums: Vec<f64>,
}

/// Squared moduli of the surface's transform without padding: half-plane fx >= 0.
pub(crate) struct PowerSpectrum {
    /// Frequencies along y; those beyond the middle are negative.
    pub ny: usize,
    /// Column by column of fx, from 0 to nx / 2: `power[fx * ny + fy]`.
    pub power: Vec<f64>,
}

/// Lines along y of the transform along x, padded with zeros to `mx` values, of heights over `level_um`; holes count as
/// that level. One line of `ny` values for each frequency from 0 to `mx` / 2.
fn transformed_along_x(surface: &Surface, mx: usize, level_um: f64) -> Vec<Complex<f64>> {
    let to_x = RealFftPlanner::<f64>::new().plan_fft_forward(mx);
    let [columns] = by_columns(
        [mx / 2 + 1, surface.ny()],
        || (vec![0.0; mx], to_x.make_scratch_vec()),
        |(line, scratch), y, [out]| {
            line.fill(0.0);
            for (value, &z) in line.iter_mut().zip(surface.row(y)) {
                *value = if z.is_nan() { 0.0 } else { z - level_um };
            }
            to_x.process_with_scratch(line, out, scratch).expect("lengths are the plan's");
        },
    );
    columns
}

/// Power of a surface without holes about its mean; that of the mean itself is rounding.
pub(crate) fn power(surface: &Surface) -> PowerSpectrum {
    let ny = surface.ny();
    let mut columns = transformed_along_x(surface, surface.nx(), surface.mean_um());
    let to_y = FftPlanner::<f64>::new().plan_fft_forward(ny);
    let mut power = vec![0.0; columns.len()];
    power.par_chunks_mut(ny).zip(columns.par_chunks_mut(ny)).for_each_init(
        || vec![Complex::default(); to_y.get_inplace_scratch_len()],
        |scratch, (power, line)| {
            to_y.process_with_scratch(line, scratch);
            for (value, z) in power.iter_mut().zip(line.iter()) {
                *value = z.norm_sqr();
            }
        },
    );
    PowerSpectrum { ny, power }
}

/// Sums of products of heights over `level_um`; holes count as that level.
pub(crate) fn products(surface: &Surface, level_um: f64) -> Products {
    let (nx, ny) = (surface.nx(), surface.ny());
    let (mx, my) = (2 * nx, 2 * ny);
    let half = nx + 1;
    let mut columns = transformed_along_x(surface, mx, level_um);
    let mut planner = FftPlanner::<f64>::new();
    let (to_y, from_y) = (planner.plan_fft_forward(my), planner.plan_fft_inverse(my));
    columns.par_chunks_mut(ny).for_each_init(
        || {
            let scratch = to_y.get_inplace_scratch_len().max(from_y.get_inplace_scratch_len());
            (vec![Complex::default(); my], vec![Complex::default(); scratch])
        },
        |(line, scratch), column| {
            line[..ny].copy_from_slice(column);
            line[ny..].fill(Complex::default());
            to_y.process_with_scratch(line, scratch);
            for z in line.iter_mut() {
                *z = Complex::new(z.norm_sqr(), 0.0);
            }
            from_y.process_with_scratch(line, scratch);
            column.copy_from_slice(&line[..ny]);
        },
    );
    let from_x = RealFftPlanner::<f64>::new().plan_fft_inverse(mx);
    let lags = 2 * nx - 1;
    let scale = 1.0 / (mx as f64 * my as f64);
    let mut sums = vec![0.0; lags * ny];
    sums.par_chunks_mut(lags * ROWS).enumerate().for_each_init(
        || (vec![Complex::default(); half * ROWS], vec![0.0; mx], from_x.make_scratch_vec()),
        |(rows, line, scratch), (block, out)| {
            // Several rows at once: each takes one value out of every column.
            for (x, column) in columns.chunks(ny).enumerate() {
                for (y, value) in column[block * ROWS..].iter().take(ROWS).enumerate() {
                    rows[y * half + x] = *value;
                }
            }
            for (row, out) in rows.chunks_mut(half).zip(out.chunks_mut(lags)) {
                // Rounding leaves dust where a real line's transform must be real; the plan refuses it.
                row[0].im = 0.0;
                row[half - 1].im = 0.0;
                from_x.process_with_scratch(row, line, scratch).expect("lengths are the plan's");
                for (i, value) in out.iter_mut().enumerate() {
                    *value = scale * line[(i + mx + 1 - nx) % mx];
                }
            }
        },
    );
    Products { nx, ny, sums }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the sums written out, on sizes that are no powers of two.
    #[test]
    fn products_are_the_sums_over_overlapping_points() {
        let (nx, ny) = (7_usize, 5_usize);
        let at = |x: usize, y: usize| ((3 * x * x + 7 * y + x * y) % 11) as f64 - 5.0;
        let heights = (0..nx * ny).map(|i| at(i % nx, i / nx)).collect();
        let surface = Surface::new(nx, ny, 1.0, 1.0, heights).expect("a grid");
        let products = products(&surface, 0.0);
        for ty in 0..ny {
            for tx in -(nx as i64 - 1)..nx as i64 {
                let mut sum = 0.0;
                for y in 0..ny - ty {
                    for x in 0..nx as i64 {
                        if (0..nx as i64).contains(&(x + tx)) {
                            sum += at(x as usize, y) * at((x + tx) as usize, y + ty);
                        }
                    }
                }
                let found = products.sums[ty * (2 * nx - 1) + (tx + nx as i64 - 1) as usize];
                assert!((found - sum).abs() < 1e-9, "lag {tx} {ty}: {found} is not {sum}");
            }
        }
        let spectrum = power(&surface);
        // The mean is off: it has no waves.
        assert!(spectrum.power[0] < 1e-20, "{}", spectrum.power[0]);
        for (fx, fy) in [(1, 0), (0, 2), (2, 3), (3, 4)] {
            let mut z = Complex::new(0.0, 0.0);
            for i in 0..nx * ny {
                let turns = (fx * (i % nx)) as f64 / nx as f64 + (fy * (i / nx)) as f64 / ny as f64;
                z += Complex::from_polar(at(i % nx, i / nx), -std::f64::consts::TAU * turns);
            }
            let found = spectrum.power[fx * ny + fy];
            assert!((found - z.norm_sqr()).abs() < 1e-8, "{fx} {fy}: {found} is not {}", z.norm_sqr());
        }
    }
}
