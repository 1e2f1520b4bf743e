//! Areal Gaussian filter (ISO 16610-61) as a local regression, and its robust form (ISO 16610-71).
//!
//! Weighting function `s(x, y) = 1 / (a L)^2 exp(-pi (x^2 + y^2) / (a L)^2)` with `a = sqrt(ln 2 / pi)`: it lets a wave
//! of length lambda pass with `2^-(L / lambda)^2`, half of it at lambda = L.
//!
//! **Edges and holes.** A plain weighted mean bends a tilted surface where half of the weights miss. Here every point
//! gets the value of the plane that fits its neighbourhood best with those weights (moment criterion of first order,
//! ISO 16610-28): away from edges this is the plain filter, because the weights are symmetric there; at edges and round
//! holes, planes pass unchanged. Holes stay holes.
//!
//! **Robust.** Points that stand far from the filtered surface are weighted down by Tukey's biweight
//! `(1 - (r / c)^2)^2`, `c = 4.4478 median |r|`, and the filter is repeated until c settles, so that deep dales and
//! high peaks do not pull the mean surface.
//!
//! The sums over neighbourhoods are convolutions with `s`, `x s`, `y s` and so on, all separable; lines go through the
//! Fourier transform, so that the time does not grow with L.

use crate::error::TextureError;
use rayon::prelude::*;
use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use std::f64::consts::{LN_2, PI};
use std::sync::Arc;

use super::columns::TurnedMap;
use super::surface::Surface;

/// The weights end at this many nesting indices, where they are 7e-7 of the middle one.
const REACH: f64 = 1.0;
/// c of Tukey's biweight per median of the residuals: three standard deviations of Gaussian residuals.
const TUKEY: f64 = 4.4478;
/// Rounds at most; five are usual. Nothing proves that the rounds of the robust form settle: one that has not by then
/// is an error.
const ROUNDS: usize = 200;
/// Residuals of this share of the heights are rounding: there is nothing left to weigh.
const DUST: f64 = 1e-13;
/// Change of c at which the rounds end.
const SETTLED: f64 = 1e-4;

/// Waves longer than the nesting index.
///
/// # Errors
/// A nesting index under two points, which no grid can filter.
pub fn low_pass(surface: &Surface, index_um: f64) -> Result<Surface, TextureError> {
    let filter = Filter::new(surface, index_um)?;
    let weights = measured(surface);
    Ok(surface.with_heights(filter.apply(surface, weights.as_deref())))
}

/// Robust form of [`low_pass`]; the second value is the number of rounds.
///
/// # Errors
/// As [`low_pass`], and a filter that does not settle.
pub fn robust_low_pass(surface: &Surface, index_um: f64) -> Result<(Surface, usize), TextureError> {
    let filter = Filter::new(surface, index_um)?;
    let first = filter.apply(surface, measured(surface).as_deref());
    let apply = |weights: &[f64]| filter.apply(surface, Some(weights));
    let (mean, rounds) = settled(index_um, surface.heights_um(), first, apply)?;
    Ok((surface.with_heights(mean), rounds))
}

/// Filters again and again from a first mean on, with the weights that its residuals give, until they settle; the
/// second value is the number of rounds.
pub(crate) fn settled(
    index_um: f64,
    heights_um: &[f64],
    first_um: Vec<f64>,
    filter: impl Fn(&[f64]) -> Vec<f64>,
) -> Result<(Vec<f64>, usize), TextureError> {
    let mut mean = first_um;
    let dust = DUST * heights_um.iter().fold(0.0, |most: f64, z| if z.abs() > most { z.abs() } else { most });
    let mut before = f64::INFINITY;
    let mut change = f64::INFINITY;
    for round in 1..=ROUNDS {
        let residuals: Vec<f64> = heights_um.par_iter().zip(&mean).map(|(z, m)| (z - m).abs()).collect();
        let c = TUKEY * median(residuals.iter().copied().filter(|r| !r.is_nan()).collect());
        if c <= dust || (before - c).abs() <= SETTLED * c {
            return Ok((mean, round));
        }
        change = (before - c).abs() / c;
        before = c;
        let biweight = |r: &f64| if *r < c { (1.0 - (r / c).powi(2)).powi(2) } else { 0.0 };
        let weights: Vec<f64> = residuals.par_iter().map(biweight).collect();
        mean = filter(&weights);
    }
    Err(TextureError::UnsettledFilter { index_um, rounds: ROUNDS, c_um: before, change })
}

/// 1 where there is a height, 0 in holes; `None` without holes.
fn measured(surface: &Surface) -> Option<Vec<f64>> {
    (surface.holes() > 0).then(|| surface.heights_um().iter().map(|z| f64::from(u8::from(!z.is_nan()))).collect())
}

fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The filter for one grid.
struct Filter {
    x: LineKernels,
    y: LineKernels,
}

impl Filter {
    fn new(surface: &Surface, index_um: f64) -> Result<Self, TextureError> {
        let coarsest_um = surface.dx_um().max(surface.dy_um());
        if !index_um.is_finite() || index_um < 2.0 * coarsest_um {
            return Err(TextureError::ShortFilter { index_um, spacing_um: coarsest_um });
        }
        Ok(Self {
            x: LineKernels::new(surface.nx(), surface.dx_um(), index_um),
            y: LineKernels::new(surface.ny(), surface.dy_um(), index_um),
        })
    }

    /// Local planes through `surface` with these weights (`None`: all 1).
    fn apply(&self, surface: &Surface, weights: Option<&[f64]>) -> Vec<f64> {
        let (nx, ny) = (surface.nx(), surface.ny());
        let weights_of = |y: usize| weights.map(|weights| &weights[y * nx..(y + 1) * nx]);
        // Along x: sums of the weighted heights.
        let sums: TurnedMap<f64, 2> = TurnedMap::of(
            [nx, ny],
            || self.x.buffers(),
            |buffers, y, sums| {
                let row = surface.row(y).iter().copied();
                *sums = match weights_of(y) {
                    None => self.x.sums(buffers, row),
                    Some(weights) => {
                        self.x.sums(buffers, row.zip(weights).map(|(z, w)| if z.is_nan() { 0.0 } else { w * z }))
                    }
                };
            },
        );
        let moments = match weights {
            None => Moments::of_rectangle(self),
            Some(weights) => Moments::OfWeights(TurnedMap::of(
                [nx, ny],
                || self.x.buffers(),
                |buffers, y, sums| {
                    *sums = self.x.sums(buffers, weights[y * nx..(y + 1) * nx].iter().copied());
                },
            )),
        };
        // Down every column.
        let planes: TurnedMap<f64, 1> = TurnedMap::of(
            [ny, nx],
            || (self.y.buffers(), vec![0.0; ny]),
            |(buffers, column), x, [plane]| {
                sums.read(0, x, column);
                let [sum, sum_y] = self.y.sums(buffers, column.iter().copied());
                sums.read(1, x, column);
                let [sum_x] = self.y.sums(buffers, column.iter().copied());
                let moments = moments.column(&self.y, buffers, column, x);
                for (y, value) in plane.iter_mut().enumerate() {
                    *value = plane_at_middle(moments.each_ref().map(|of| of[y]), [sum[y], sum_x[y], sum_y[y]]);
                }
            },
        );
        drop(sums);
        let mut heights = vec![0.0; nx * ny];
        heights.par_chunks_mut(nx).enumerate().for_each(|(y, row)| planes.read(0, y, row));
        for (value, z) in heights.iter_mut().zip(surface.heights_um()).filter(|(_, z)| z.is_nan()) {
            *value = *z;
        }
        heights
    }
}

/// Value in the middle of the plane that fits with moments 1, x, y, x^2, x y, y^2 of the weights and 1, x, y of the
/// weighted heights; NaN where too little is near.
fn plane_at_middle([m, mx, my, mxx, mxy, myy]: [f64; 6], [z, zx, zy]: [f64; 3]) -> f64 {
    // Too little weight on one side determines no tilt; then the mean has to do.
    let minor = mxx * myy - mxy * mxy;
    let determinant = m * minor - mx * (mx * myy - mxy * my) + my * (mx * mxy - mxx * my);
    if determinant.abs() > 1e-6 * m * mxx * myy {
        return (z * minor - mx * (zx * myy - mxy * zy) + my * (zx * mxy - mxx * zy)) / determinant;
    }
    if m > 1e-12 { z / m } else { f64::NAN }
}

/// Moments of the weights round every point.
enum Moments {
    /// All weights are 1: products of moments along the axes.
    Rectangle { x: [Vec<f64>; 3], y: [Vec<f64>; 3] },
    /// Moments along x.
    OfWeights(TurnedMap<f64, 3>),
}

impl Moments {
    fn of_rectangle(filter: &Filter) -> Self {
        let along = |of: &LineKernels| of.sums(&mut of.buffers(), std::iter::repeat_n(1.0, of.count));
        Self::Rectangle { x: along(&filter.x), y: along(&filter.y) }
    }

    /// 1, x, y, x^2, x y, y^2 down column `x`.
    fn column(&self, along_y: &LineKernels, buffers: &mut LineBuffers, line: &mut [f64], x: usize) -> [Vec<f64>; 6] {
        match self {
            Self::Rectangle { x: along_x, y } => {
                let product = |p: usize, q: usize| y[q].iter().map(|moment| along_x[p][x] * moment).collect();
                [product(0, 0), product(1, 0), product(0, 1), product(2, 0), product(1, 1), product(0, 2)]
            }
            Self::OfWeights(along_x) => {
                along_x.read(0, x, line);
                let [m, my, myy] = along_y.sums(buffers, line.iter().copied());
                along_x.read(1, x, line);
                let [mx, mxy] = along_y.sums(buffers, line.iter().copied());
                along_x.read(2, x, line);
                let [mxx] = along_y.sums(buffers, line.iter().copied());
                [m, mx, my, mxx, mxy, myy]
            }
        }
    }
}

/// Weights times powers of the distance (in nesting indices) along one axis, transformed.
pub(crate) struct LineKernels {
    count: usize,
    padded: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    /// Transforms of s, t s, t^2 s, with the inverse's scale in them.
    kernels: [Vec<Complex<f64>>; 3],
}

impl LineKernels {
    pub(crate) fn new(count: usize, spacing_um: f64, index_um: f64) -> Self {
        let reach = ((REACH * index_um / spacing_um).ceil() as usize).min(count - 1);
        let padded = fast_length(count + reach);
        let mut planner = RealFftPlanner::new();
        let (forward, inverse) = (planner.plan_fft_forward(padded), planner.plan_fft_inverse(padded));
        let width = (LN_2 / PI).sqrt();
        let distance = |i: i64| i as f64 * spacing_um / index_um;
        let weight = |i: i64| (-PI * (distance(i) / width).powi(2)).exp();
        let reach = reach as i64;
        let sum: f64 = (-reach..=reach).map(weight).sum();
        let kernels = [0, 1, 2].map(|power| {
            let mut line = vec![0.0; padded];
            for i in -reach..=reach {
                // A neighbour at distance t lies at index - t of a convolution.
                line[(-i).rem_euclid(padded as i64) as usize] +=
                    weight(i) * distance(i).powi(power) / (sum * padded as f64);
            }
            let mut out = forward.make_output_vec();
            forward.process(&mut line, &mut out).expect("lengths are the plan's");
            out
        });
        Self { count, padded, forward, inverse, kernels }
    }

    /// What the transforms of a line need.
    pub(crate) fn buffers(&self) -> LineBuffers {
        let spectrum = self.forward.make_output_vec();
        let scratch = self.forward.get_scratch_len().max(self.inverse.get_scratch_len());
        LineBuffers {
            line: vec![0.0; self.padded],
            product: spectrum.clone(),
            spectrum,
            scratch: vec![Complex::default(); scratch],
        }
    }

    /// Sums over the neighbourhood of every value of a line, weighted with the powers 0 to `N` - 1 of the distance.
    pub(crate) fn sums<const N: usize>(
        &self,
        buffers: &mut LineBuffers,
        values: impl Iterator<Item = f64>,
    ) -> [Vec<f64>; N] {
        let LineBuffers { line, spectrum, product, scratch } = buffers;
        line[self.count..].fill(0.0);
        for (place, value) in line[..self.count].iter_mut().zip(values) {
            *place = value;
        }
        self.forward.process_with_scratch(line, spectrum, scratch).expect("lengths are the plan's");
        std::array::from_fn(|power| {
            for ((out, a), b) in product.iter_mut().zip(spectrum.iter()).zip(&self.kernels[power]) {
                *out = a * b;
            }
            // Rounding leaves dust where a real line's transform must be real; the plan refuses it.
            product[0].im = 0.0;
            if self.padded.is_multiple_of(2) {
                let last = product.len() - 1;
                product[last].im = 0.0;
            }
            self.inverse.process_with_scratch(product, line, scratch).expect("lengths are the plan's");
            line[..self.count].to_vec()
        })
    }
}

/// Room for the transforms of a line.
pub(crate) struct LineBuffers {
    line: Vec<f64>,
    spectrum: Vec<Complex<f64>>,
    product: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

/// Smallest even length from `least` on with the prime factors 2, 3 and 5 alone, which transforms fast.
fn fast_length(least: usize) -> usize {
    (least.next_multiple_of(2)..)
        .step_by(2)
        .find(|&length| {
            let mut rest = length;
            for factor in [2, 3, 5] {
                while rest.is_multiple_of(factor) {
                    rest /= factor;
                }
            }
            rest == 1
        })
        .unwrap_or(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface(nx: usize, ny: usize, f: impl Fn(f64, f64) -> f64) -> Surface {
        let heights = (0..nx * ny).map(|i| f((i % nx) as f64 * 2.0, (i / nx) as f64 * 3.0)).collect();
        Surface::new(nx, ny, 2.0, 3.0, heights).expect("a grid")
    }

    fn furthest(a: &Surface, b: &Surface) -> f64 {
        let both = a.heights_um().iter().zip(b.heights_um()).filter(|(p, q)| !p.is_nan() && !q.is_nan());
        both.map(|(p, q)| (p - q).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn planes_pass_unchanged_to_the_very_edge_and_round_holes() {
        let plane = surface(60, 40, |x, y| 1.0 + 0.03 * x - 0.02 * y);
        assert!(furthest(&low_pass(&plane, 30.0).expect("a filter"), &plane) < 1e-11);
        let mut holed = plane.heights_um().to_vec();
        for i in [0, 1, 2, 61, 700, 701, 702, 760, 761, 762, 2399] {
            holed[i] = f64::NAN;
        }
        let holed = plane.with_heights(holed);
        let filtered = low_pass(&holed, 30.0).expect("a filter");
        assert!(furthest(&filtered, &plane) < 1e-10);
        assert_eq!(filtered.holes(), 11, "holes stay holes");
    }

    #[test]
    fn waves_pass_as_the_law_says() {
        for (wave, index) in [(40.0, 40.0), (60.0, 40.0), (80.0, 40.0), (24.0, 40.0)] {
            let surface = surface(241, 81, |x, y| (std::f64::consts::TAU * x / wave).sin() + 0.0 * y);
            let filtered = low_pass(&surface, index).expect("a filter");
            let law = 2_f64.powf(-(index / wave).powi(2));
            let middle = |s: &Surface| s.row(40)[60..180].to_vec();
            let (given, left) = (middle(&surface), middle(&filtered));
            let passed =
                given.iter().zip(&left).map(|(a, b)| a * b).sum::<f64>() / given.iter().map(|a| a * a).sum::<f64>();
            assert!((passed - law).abs() < 2e-6, "wave {wave}: {passed} is not {law}");
        }
    }

    /// Weights written out and a full map without them must agree: one law, two ways to its moments.
    #[test]
    fn weights_of_one_change_nothing() {
        let rough = surface(50, 30, |x, y| (0.37 * x).sin() * (0.11 * y * x).cos());
        let filter = Filter::new(&rough, 25.0).expect("a filter");
        let ones = vec![1.0; 1500];
        let apply = |weights| rough.with_heights(filter.apply(&rough, weights));
        assert!(furthest(&apply(None), &apply(Some(&ones))) < 1e-9);
    }

    #[test]
    fn a_robust_filter_is_not_pulled_into_dales() {
        let scratched = surface(120, 60, |x, y| {
            0.01 * x + 0.05 * (x * 1.7 + y).sin() - if (x - 100.0).abs() < 5.0 { 20.0 } else { 0.0 }
        });
        let plane = surface(120, 60, |x, _| 0.01 * x);
        let plain = furthest(&low_pass(&scratched, 60.0).expect("a filter"), &plane);
        let (robust, rounds) = robust_low_pass(&scratched, 60.0).expect("a filter");
        assert!(plain > 1.0 && furthest(&robust, &plane) < 0.08, "{plain}, {}", furthest(&robust, &plane));
        assert!((2..25).contains(&rounds), "{rounds}");
    }

    #[test]
    fn a_filter_finer_than_the_grid_is_refused() {
        assert!(low_pass(&surface(10, 10, |x, _| x), 5.0).is_err());
    }
}
