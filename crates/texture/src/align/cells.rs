//! Surfaces averaged to cells, and the correlation of every shift of one over the other.
//!
//! In: two surfaces of which the second may be mirrored. Out: for every mirror the best shifts with their normalised
//! correlations. Every shift is taken over the cells that overlap and were measured, all at once by Fourier transforms
//! (Padfield 2012).

use rayon::prelude::*;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::{MIRRORS, Mirrored};
use crate::columns::TurnedMap;
use crate::surface::Surface;

/// Cells a side of the averaged surfaces: marks of 20 points keep five cells on maps of 1500 points.
pub(super) const COARSE: usize = 384;
/// Peaks that are looked at on the points: marks that follow each other have one for every pitch.
const PEAKS: usize = 12;
/// Overlap that counts, as a share of the smaller surface's points.
const LEAST_OVERLAP: f64 = 0.5;
/// A surface averaged over cells; cells without a point weigh nothing.
pub(super) struct Cells {
    pub(super) nx: usize,
    pub(super) ny: usize,
    pub(super) heights: Vec<f64>,
    weights: Vec<f64>,
}

impl Cells {
    pub(super) fn of(surface: &Surface, [cx, cy]: [f64; 2]) -> Self {
        let place = |i: usize, step: f64, cell: f64| (i as f64 * step / cell + 1e-9) as usize;
        let nx = place(surface.nx() - 1, surface.dx_um(), cx) + 1;
        let ny = place(surface.ny() - 1, surface.dy_um(), cy) + 1;
        let (mut sums, mut counts) = (vec![0.0; nx * ny], vec![0.0; nx * ny]);
        for y in 0..surface.ny() {
            let row = place(y, surface.dy_um(), cy) * nx;
            for (x, z) in surface.row(y).iter().enumerate().filter(|(_, z)| !z.is_nan()) {
                let cell = row + place(x, surface.dx_um(), cx);
                sums[cell] += z;
                counts[cell] += 1.0;
            }
        }
        let heights = sums.iter().zip(&counts).map(|(s, n)| if *n > 0.0 { s / n } else { 0.0 }).collect();
        let weights = counts.iter().map(|n| f64::from(u8::from(*n > 0.0))).collect();
        Self { nx, ny, heights, weights }
    }

    /// Weights, weighted heights and their squares, mirrored and transformed on a larger grid.
    fn transforms(&self, [mx, my]: [usize; 2], [x, y]: Mirrored) -> [Vec<Complex<f64>>; 3] {
        let at = |value: &dyn Fn(usize) -> f64| {
            let mut out = vec![Complex::default(); mx * my];
            for i in 0..self.nx * self.ny {
                let (cx, cy) = (i % self.nx, i / self.nx);
                let (tx, ty) = (if x { self.nx - 1 - cx } else { cx }, if y { self.ny - 1 - cy } else { cy });
                out[ty * mx + tx] = Complex::new(value(i), 0.0);
            }
            transformed(&out, mx, my, false)
        };
        [at(&|i| self.weights[i]), at(&|i| self.heights[i]), at(&|i| self.heights[i] * self.heights[i])]
    }
}

/// The transform of `mx` x `my` values, or back; turned over, which products and a second transform undo.
pub(super) fn transformed(values: &[Complex<f64>], mx: usize, my: usize, back: bool) -> Vec<Complex<f64>> {
    let mut planner = FftPlanner::<f64>::new();
    let [along_x, along_y] =
        [mx, my].map(|length| if back { planner.plan_fft_inverse(length) } else { planner.plan_fft_forward(length) });
    let rows: TurnedMap<_, 1> = TurnedMap::of(
        [mx, my],
        || (),
        |(), y, [line]| {
            line.copy_from_slice(&values[y * mx..(y + 1) * mx]);
            along_x.process(line);
        },
    );
    let mut columns = vec![Complex::default(); mx * my];
    columns.par_chunks_mut(my).enumerate().for_each(|(x, column)| {
        rows.read(0, x, column);
        along_y.process(column);
    });
    columns
}

/// What the shifts of one mirror correlate with.
pub(super) struct CoarseShifts {
    /// Peaks, the highest first: correlation, and shift in cells.
    pub(super) peaks: Vec<(f64, [f64; 2])>,
    /// Largest correlation of heights with the other sign.
    pub(super) inverted: f64,
}

/// The best shifts of every mirror.
pub(super) fn correlations(a: &Cells, b: &Cells) -> Vec<CoarseShifts> {
    let (mx, my) = (a.nx + b.nx, a.ny + b.ny);
    let of_a = a.transforms([mx, my], [false, false]);
    let total = |cells: &Cells| cells.weights.iter().sum::<f64>();
    let least = (LEAST_OVERLAP * total(a).min(total(b))).max(4.0);
    let scale = 1.0 / (mx * my) as f64;
    let of_mirror = |&mirrored: &Mirrored| {
        let of_b = b.transforms([mx, my], mirrored);
        // Sums over the overlap of products with the second shifted.
        let sums = |p: usize, q: usize| {
            let product: Vec<_> = of_a[p].iter().zip(&of_b[q]).map(|(p, q)| p * q.conj() * scale).collect();
            transformed(&product, my, mx, true)
        };
        let [n, sa, sb, saa, sbb, sab] = [sums(0, 0), sums(1, 0), sums(0, 1), sums(2, 0), sums(0, 2), sums(1, 1)];
        let at = |i: usize| {
            let (n, sa, sb) = (n[i].re, sa[i].re, sb[i].re);
            if n < least - 0.5 {
                return f64::NAN;
            }
            let spread = (saa[i].re - sa * sa / n).max(0.0) * (sbb[i].re - sb * sb / n).max(0.0);
            if spread > 0.0 { (sab[i].re - sa * sb / n) / spread.sqrt() } else { f64::NAN }
        };
        let values: Vec<f64> = (0..mx * my).map(at).collect();
        let value = |x: usize, y: usize| values[(y % my) * mx + x % mx];
        let signed = |i: usize, count: usize, m: usize| if i < count { i as f64 } else { i as f64 - m as f64 };
        // Between the cells: where a parabola has its apex, and how much higher that is.
        let apex = |low: f64, middle: f64, high: f64| {
            let bend = low - 2.0 * middle + high;
            let apex = 0.5 * (low - high) / bend;
            if bend < 0.0 && apex.abs() <= 1.0 { (apex, 0.25 * (high - low) * apex) } else { (0.0, 0.0) }
        };
        let peak = |i: usize| {
            let (x, y) = (i % mx, i / mx);
            let middle = values[i];
            let [left, right, below, above] =
                [value(x + mx - 1, y), value(x + 1, y), value(x, y + my - 1), value(x, y + 1)];
            if middle.is_nan() || [left, right, below, above].iter().any(|beside| *beside > middle) {
                return None;
            }
            let ((dx, rise_x), (dy, rise_y)) = (apex(left, middle, right), apex(below, middle, above));
            Some((middle + rise_x + rise_y, [signed(x, a.nx, mx) + dx, signed(y, a.ny, my) + dy]))
        };
        let mut peaks: Vec<(f64, [f64; 2])> = (0..mx * my).filter_map(peak).collect();
        peaks.sort_by(|a, b| b.0.total_cmp(&a.0));
        peaks.truncate(PEAKS);
        CoarseShifts { peaks, inverted: -values.iter().copied().fold(0.0, f64::min) }
    };
    MIRRORS.iter().map(of_mirror).collect()
}
