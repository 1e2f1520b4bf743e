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
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

use super::columns::TurnedMap;
use super::surface::Surface;

/// What rounding may add to a wave beyond the sum over its column.
const ROUNDING: f64 = 1e-9;
/// Columns searched at once; fixed, although the number of threads would not change what is found.
const AT_ONCE: usize = 16;

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

impl PowerSpectrum {
    /// The wave with the most power.
    pub fn largest_wave(&self) -> Wave {
        let waves = self.power.par_iter().enumerate().map(|(place, &power)| Wave { place, power });
        waves.reduce(Wave::default, Wave::larger)
    }
}

/// One value of the spectrum.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Wave {
    /// Its place in [`PowerSpectrum::power`].
    pub place: usize,
    /// Its power; 0 where there is no wave.
    pub power: f64,
}

impl Wave {
    /// Of two waves the one with more power, of equals the first: opposite frequencies on fx = 0 are equal but for
    /// rounding. The mean is no wave.
    fn larger(self, other: Self) -> Self {
        let first = other.power == self.power && other.place < self.place;
        if other.place > 0 && (other.power > self.power || first) { other } else { self }
    }
}

/// The transform along x, padded with zeros to `mx` values, of heights over `level_um`; holes count as that level. One
/// column of `ny` values for each frequency from 0 to `mx` / 2.
fn transformed_along_x(surface: &Surface, mx: usize, level_um: f64) -> TurnedMap<Complex<f64>, 1> {
    let to_x = RealFftPlanner::<f64>::new().plan_fft_forward(mx);
    TurnedMap::of(
        [mx / 2 + 1, surface.ny()],
        || (vec![0.0; mx], to_x.make_scratch_vec()),
        |(line, scratch), y, [out]| {
            line.fill(0.0);
            for (value, &z) in line.iter_mut().zip(surface.row(y)) {
                *value = if z.is_nan() { 0.0 } else { z - level_um };
            }
            to_x.process_with_scratch(line, out, scratch).expect("lengths are the plan's");
        },
    )
}

/// Columns of the transform along x, transformed along y in turn.
struct ColumnTransforms {
    along_x: TurnedMap<Complex<f64>, 1>,
    to_y: Arc<dyn Fft<f64>>,
}

impl ColumnTransforms {
    fn of(surface: &Surface) -> Self {
        let along_x = transformed_along_x(surface, surface.nx(), surface.mean_um());
        Self { along_x, to_y: FftPlanner::new().plan_fft_forward(surface.ny()) }
    }

    /// A line along y, and what its transform needs.
    fn buffers(&self) -> [Vec<Complex<f64>>; 2] {
        [self.to_y.len(), self.to_y.get_inplace_scratch_len()].map(|length| vec![Complex::default(); length])
    }

    /// Power of all waves of one frequency along x.
    fn power<'a>(&self, [line, scratch]: &'a mut [Vec<Complex<f64>>; 2], fx: usize) -> impl Iterator<Item = f64> + 'a {
        self.along_x.read(0, fx, line);
        self.to_y.process_with_scratch(line, scratch);
        line.iter().map(Complex::norm_sqr)
    }
}

/// Power of a surface without holes about its mean; that of the mean itself is rounding.
pub(crate) fn power(surface: &Surface) -> PowerSpectrum {
    let (ny, columns) = (surface.ny(), ColumnTransforms::of(surface));
    let mut power = vec![0.0; (surface.nx() / 2 + 1) * ny];
    power.par_chunks_mut(ny).enumerate().for_each_init(
        || columns.buffers(),
        |buffers, (fx, out)| {
            for (value, power) in out.iter_mut().zip(columns.power(buffers, fx)) {
                *value = power;
            }
        },
    );
    PowerSpectrum { ny, power }
}

/// [`PowerSpectrum::largest_wave`] of a surface without holes, without the whole of its spectrum: no wave has more
/// power than all of its column, which is known before the column is transformed (Parseval).
pub(crate) fn largest_wave(surface: &Surface) -> Wave {
    let (ny, columns) = (surface.ny(), ColumnTransforms::of(surface));
    let all_waves = |[line, _]: &mut [Vec<Complex<f64>>; 2], fx: usize| {
        columns.along_x.read(0, fx, line);
        (ny as f64 * line.iter().map(Complex::norm_sqr).sum::<f64>() * (1.0 + ROUNDING), fx)
    };
    let half = surface.nx() / 2 + 1;
    let mut bounds: Vec<(f64, usize)> = (0..half).into_par_iter().map_init(|| columns.buffers(), all_waves).collect();
    bounds.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
    let mut largest = Wave::default();
    for columns_of_most in bounds.chunks(AT_ONCE) {
        if columns_of_most[0].0 < largest.power {
            break;
        }
        let of_column = |buffers: &mut [_; 2], &(_, fx): &(f64, usize)| {
            let waves = (fx * ny..).zip(columns.power(buffers, fx)).map(|(place, power)| Wave { place, power });
            waves.fold(Wave::default(), Wave::larger)
        };
        let waves = columns_of_most.par_iter().map_init(|| columns.buffers(), of_column);
        largest = largest.larger(waves.reduce(Wave::default, Wave::larger));
    }
    largest
}

/// Sums of products of heights over `level_um`; holes count as that level.
pub(crate) fn products(surface: &Surface, level_um: f64) -> Products {
    let (nx, ny) = (surface.nx(), surface.ny());
    let (mx, my) = (2 * nx, 2 * ny);
    let half = nx + 1;
    let along_x = transformed_along_x(surface, mx, level_um);
    let to_y = FftPlanner::<f64>::new().plan_fft_forward(my);
    // Power is real: transforming it back gives the conjugates of what transforming it once more gives.
    let from_y = RealFftPlanner::<f64>::new().plan_fft_forward(my);
    let rows: TurnedMap<_, 1> = TurnedMap::of(
        [ny, half],
        || {
            let scratch = to_y.get_inplace_scratch_len().max(from_y.get_scratch_len());
            (
                from_y.make_output_vec(),
                from_y.make_input_vec(),
                [my, scratch].map(|length| vec![Complex::default(); length]),
            )
        },
        |(back, power, [line, scratch]), fx, [out]| {
            along_x.read(0, fx, &mut line[..ny]);
            line[ny..].fill(Complex::default());
            to_y.process_with_scratch(line, scratch);
            for (power, z) in power.iter_mut().zip(line.iter()) {
                *power = z.norm_sqr();
            }
            from_y.process_with_scratch(power, back, scratch).expect("lengths are the plan's");
            for (out, z) in out.iter_mut().zip(back.iter()) {
                *out = z.conj();
            }
        },
    );
    drop(along_x);
    let from_x = RealFftPlanner::<f64>::new().plan_fft_inverse(mx);
    let lags = 2 * nx - 1;
    let scale = 1.0 / (mx as f64 * my as f64);
    let mut sums = vec![0.0; lags * ny];
    sums.par_chunks_mut(lags).enumerate().for_each_init(
        || (vec![Complex::default(); half], vec![0.0; mx], from_x.make_scratch_vec()),
        |(row, line, scratch), (ty, out)| {
            rows.read(0, ty, row);
            // Rounding leaves dust where a real line's transform must be real; the plan refuses it.
            row[0].im = 0.0;
            row[half - 1].im = 0.0;
            from_x.process_with_scratch(row, line, scratch).expect("lengths are the plan's");
            let (before, from_zero) = out.split_at_mut(nx - 1);
            for (lags, sums) in [(before, &line[mx + 1 - nx..]), (from_zero, &line[..nx])] {
                for (lag, sum) in lags.iter_mut().zip(sums) {
                    *lag = scale * sum;
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
        assert_eq!(largest_wave(&surface), spectrum.largest_wave());
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
