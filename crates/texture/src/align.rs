//! Two surfaces of one place, laid over each other: mirrored, shifted, levelled; and the feed marks that both have.
//!
//! In: two [`Surface`]s, the first the one that keeps its place. Out: [`Aligned`], both on the points of the first
//! where they overlap, with what was done to the second.
//!
//! 1. Both lose their least-squares planes and are averaged to at most `COARSE` cells a side.
//! 2. For the second as it is and mirrored in x, in y and in both, the normalised cross-correlation of every shift
//!    is taken at once by Fourier transforms, each shift over the cells that overlap and were measured (Padfield 2012).
//!    The largest of overlaps of at least half of the smaller surface counts. A mirror is taken only where it
//!    correlates better by `CLEARLY`, or leaves less than half of the variance: symmetrical marks fit either way.
//! 3. Shift and plane are refined together by least squares on the points themselves (Gauss and Newton), the second
//!    interpolated by cubic convolution.
//!
//! Marks: the wave of largest amplitude that the overlap holds at least `FEWEST_WAVES` times, with a Hann window, its
//! wave vector refined on the points.
//!
//! Road not taken: rotation and scale. A flank lies in its instrument by its axis, and a turned one is turned by
//! [`crate::prepare`]; free turns of marks that run one way are hardly determined.

use rayon::prelude::*;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use std::f64::consts::TAU;

use super::form::{self, Form};
use super::prepare::{MirrorAxis, Preparation, interpolated};
use super::surface::{Surface, transposed};

/// Cells a side of the averaged surfaces: marks of 20 points keep five cells on maps of 1500 points.
const COARSE: usize = 384;
/// How much better a mirrored surface must correlate to be taken, or the better of two good ones by `HARDLY` where it
/// halves the variance that is left.
const CLEARLY: f64 = 0.1;
const HARDLY: f64 = 0.005;
/// Overlap that counts, as a share of the smaller surface's points.
const LEAST_OVERLAP: f64 = 0.5;
/// Points that the refinement looks at, about.
const LOOKED_AT: usize = 60_000;
/// Rounds of refinement: four are enough without noise, whose slopes shorten the steps along marks.
const ROUNDS: usize = 60;
/// Waves that a field must hold to be marks: fewer are form.
const FEWEST_WAVES: f64 = 3.0;

/// How the second surface is mirrored: its x, its y run the other way.
pub type Mirrored = [bool; 2];

/// What was done to the second surface, and how well it fits.
#[derive(Debug, Clone, PartialEq)]
pub struct Alignment {
    /// Axes that run the other way.
    pub mirrored: Mirrored,
    /// Where its first point, mirrored, lies on the first surface, um.
    pub shift_um: [f64; 2],
    /// Height and slopes that were added to it: um, um per mm along x and y.
    pub plane: [f64; 3],
    /// Correlation of both on the points of the overlap, their planes off.
    pub correlation: f64,
    /// Largest coarse correlation of every mirror: none, x, y, both.
    pub by_mirror: [f64; 4],
    /// Largest coarse correlation of its heights with the other sign, not mirrored.
    pub inverted: f64,
    /// Points of the overlap, as a share of the smaller surface's.
    pub overlap: f64,
}

/// Both surfaces on the points that they share.
#[derive(Debug, Clone, PartialEq)]
pub struct Aligned {
    /// The first, cut to the overlap.
    pub first: Surface,
    /// The second on the same points, levelled with the first.
    pub second: Surface,
    /// What was done to the second.
    pub alignment: Alignment,
}

const MIRRORS: [Mirrored; 4] = [[false, false], [true, false], [false, true], [true, true]];

/// Whether one correlation is better than another beyond doubt: by `CLEARLY`, or by `HARDLY` where it halves the
/// variance that is left.
pub fn fits_better(correlation: f64, than: f64) -> bool {
    let left = |correlation: f64| 1.0 - correlation * correlation;
    correlation > than + CLEARLY || correlation > than + HARDLY && left(correlation) < 0.5 * left(than)
}

/// Lays `second` over `first`.
///
/// # Errors
/// Surfaces too small or too empty to be compared, or that overlap nowhere.
pub fn aligned(first: &Surface, second: &Surface) -> Result<Aligned, String> {
    let (a, _) = form::remove(first, Form::Plane)?;
    let (b, _) = form::remove(second, Form::Plane)?;
    let cell = [0, 1].map(|k| {
        let side = |s: &Surface| [(s.nx() as f64) * s.dx_um(), (s.ny() as f64) * s.dy_um()][k];
        let step = |s: &Surface| [s.dx_um(), s.dy_um()][k];
        (side(&a).max(side(&b)) / COARSE as f64).max(step(&a).max(step(&b)))
    });
    let (coarse_a, coarse_b) = (Cells::of(&a, cell), Cells::of(&b, cell));
    let found = correlations(&coarse_a, &coarse_b);
    let by_mirror = [0, 1, 2, 3].map(|k| found[k].0.0);
    let best = (1..4).fold(0, |best, k| if by_mirror[k] > by_mirror[best] { k } else { best });
    let [as_it_is, mirrored] = [by_mirror[0], by_mirror[best]];
    let taken = if fits_better(mirrored, as_it_is) { best } else { 0 };
    let (correlation, cells) = found[taken].0;
    if correlation == f64::NEG_INFINITY {
        return Err("the surfaces share too few measured points to be laid over each other".to_owned());
    }
    let mirrored = MIRRORS[taken];
    let b = mirror(&b, mirrored)?;
    let start = [cells[0] * cell[0], cells[1] * cell[1]];
    let shift_um = refined(&a, &b, start);
    // The points of the first that lie on the second.
    let range = |k: usize| {
        let (step, count) = [(a.dx_um(), a.nx()), (a.dy_um(), a.ny())][k];
        let length = [(b.nx() - 1) as f64 * b.dx_um(), (b.ny() - 1) as f64 * b.dy_um()][k];
        let from = (shift_um[k] / step - 1e-6).ceil().max(0.0);
        let to = ((shift_um[k] + length) / step + 1e-6).floor().min((count - 1) as f64);
        (from as usize, to)
    };
    let [(x0, x1), (y0, y1)] = [range(0), range(1)];
    if x1 < x0 as f64 + 1.0 || y1 < y0 as f64 + 1.0 {
        return Err("the surfaces do not overlap".to_owned());
    }
    let (nx, ny) = (x1 as usize - x0 + 1, y1 as usize - y0 + 1);
    let on_points = |of: &(dyn Fn(usize, usize) -> f64 + Sync)| {
        let heights: Vec<f64> = (0..nx * ny).into_par_iter().map(|i| of(x0 + i % nx, y0 + i / nx)).collect();
        Surface::new(nx, ny, a.dx_um(), a.dy_um(), heights)
    };
    let first = on_points(&|x, y| first.row(y)[x])?;
    let second_original = mirror(second, mirrored)?;
    let second = on_points(&|x, y| {
        let u = (x as f64 * a.dx_um() - shift_um[0]) / b.dx_um();
        let v = (y as f64 * a.dy_um() - shift_um[1]) / b.dy_um();
        interpolated(&second_original, u, v)
    })?;
    let (second, plane) = levelled(&first, &second);
    let correlation = correlation_of(&first, &second)?;
    let measured = first.heights_um().iter().zip(second.heights_um()).filter(|(p, q)| !p.is_nan() && !q.is_nan());
    let area = |s: &Surface| (s.nx() * s.ny()) as f64 * s.dx_um() * s.dy_um();
    let overlap = measured.count() as f64 * a.dx_um() * a.dy_um() / area(&a).min(area(&b));
    let inverted = found[0].1;
    Ok(Aligned {
        first,
        second,
        alignment: Alignment { mirrored, shift_um, plane, correlation, by_mirror, inverted, overlap },
    })
}

/// Second less first, where both were measured.
///
/// # Errors
/// No point that both have.
pub fn difference(aligned: &Aligned) -> Result<Surface, String> {
    let (a, b) = (&aligned.first, &aligned.second);
    let heights = a.heights_um().iter().zip(b.heights_um()).map(|(a, b)| b - a).collect();
    Surface::new(a.nx(), a.ny(), a.dx_um(), a.dy_um(), heights)
}

fn mirror(surface: &Surface, [x, y]: Mirrored) -> Result<Surface, String> {
    let axes = [(x, MirrorAxis::X), (y, MirrorAxis::Y)].into_iter().filter(|(wanted, _)| *wanted);
    axes.into_iter().try_fold(surface.clone(), |surface, (_, axis)| {
        Ok(Preparation { mirror: Some(axis), ..Preparation::default() }.apply(&surface)?.0)
    })
}

/// A surface averaged over cells; cells without a point weigh nothing.
struct Cells {
    nx: usize,
    ny: usize,
    heights: Vec<f64>,
    weights: Vec<f64>,
}

impl Cells {
    fn of(surface: &Surface, [cx, cy]: [f64; 2]) -> Self {
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
            transformed(out, mx, my, false)
        };
        [at(&|i| self.weights[i]), at(&|i| self.heights[i]), at(&|i| self.heights[i] * self.heights[i])]
    }
}

/// The transform of `mx` x `my` values, or back; transposed, which products and a second transform undo.
fn transformed(mut values: Vec<Complex<f64>>, mx: usize, my: usize, back: bool) -> Vec<Complex<f64>> {
    let mut planner = FftPlanner::<f64>::new();
    let mut lines = |values: &mut Vec<Complex<f64>>, length: usize| {
        let plan = if back { planner.plan_fft_inverse(length) } else { planner.plan_fft_forward(length) };
        values.par_chunks_mut(length).for_each(|line| plan.process(line));
    };
    lines(&mut values, mx);
    let mut turned = transposed(&values, mx, my);
    lines(&mut turned, my);
    turned
}

/// For every mirror the largest correlation with its shift in cells, and the largest of heights with the other sign.
fn correlations(a: &Cells, b: &Cells) -> Vec<((f64, [f64; 2]), f64)> {
    let (mx, my) = (a.nx + b.nx, a.ny + b.ny);
    let of_a = a.transforms([mx, my], [false, false]);
    let total = |cells: &Cells| cells.weights.iter().sum::<f64>();
    let least = (LEAST_OVERLAP * total(a).min(total(b))).max(4.0);
    let scale = 1.0 / (mx * my) as f64;
    MIRRORS
        .iter()
        .map(|&mirrored| {
            let of_b = b.transforms([mx, my], mirrored);
            // Sums over the overlap of products with the second shifted.
            let sums = |p: usize, q: usize| {
                let product = of_a[p].iter().zip(&of_b[q]).map(|(p, q)| p * q.conj() * scale).collect();
                transformed(product, my, mx, true)
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
            let mut best = (f64::NEG_INFINITY, 0);
            let mut lowest = 0.0_f64;
            for (i, &value) in values.iter().enumerate() {
                if value > best.0 {
                    best = (value, i);
                }
                lowest = lowest.min(value);
            }
            let signed = |i: usize, count: usize, m: usize| if i < count { i as f64 } else { i as f64 - m as f64 };
            let (x, y) = (best.1 % mx, best.1 / mx);
            let value = |x: usize, y: usize| values[(y % my) * mx + x % mx];
            let apex = |low: f64, high: f64| {
                let bend = low - 2.0 * best.0 + high;
                let apex = 0.5 * (low - high) / bend;
                if bend < 0.0 && apex.abs() <= 1.0 { apex } else { 0.0 }
            };
            let place = [
                signed(x, a.nx, mx) + apex(value(x + mx - 1, y), value(x + 1, y)),
                signed(y, a.ny, my) + apex(value(x, y + my - 1), value(x, y + 1)),
            ];
            ((best.0, place), -lowest)
        })
        .collect()
}

/// The shift, um, that leaves the least squares of first less second and a plane.
fn refined(a: &Surface, b: &Surface, start: [f64; 2]) -> [f64; 2] {
    let mut shift = start;
    let mut damping = 1e-6;
    let mut current = normal_equations(a, b, shift);
    for _ in 0..ROUNDS {
        let Some((matrix, right, squares)) = &current else { return shift };
        let mut damped = *matrix;
        // Along marks a shift changes nothing: there it stays.
        let steepest = matrix[3][3].max(matrix[4][4]);
        damped[3][3] += damping * steepest;
        damped[4][4] += damping * steepest;
        let Some(solution) = solved(&damped, right, 5) else { return shift };
        let step = [solution[3] * b.dx_um(), solution[4] * b.dy_um()];
        // No further than a few points at once: beyond them the slopes say nothing.
        let reach = [4.0 * b.dx_um(), 4.0 * b.dy_um()];
        let next = [0, 1].map(|k| shift[k] + step[k].clamp(-reach[k], reach[k]));
        let tried = normal_equations(a, b, next);
        if tried.as_ref().is_some_and(|(.., after)| *after < *squares) {
            let moved = (0..2).any(|k| (next[k] - shift[k]).abs() > 1e-6 * [b.dx_um(), b.dy_um()][k]);
            (shift, current, damping) = (next, tried, damping * 0.1);
            if !moved {
                break;
            }
        } else {
            damping = damping.max(1e-6) * 100.0;
        }
    }
    shift
}

/// Normal matrix and right side of a plane and a shift in points, and the mean square that the plane alone leaves.
type Normal = ([[f64; 5]; 5], [f64; 5], f64);

fn normal_equations(a: &Surface, b: &Surface, shift: [f64; 2]) -> Option<Normal> {
    let stride = ((a.nx() * a.ny()) as f64 / LOOKED_AT as f64).sqrt().ceil().max(1.0) as usize;
    let (mut matrix, mut right, mut squares, mut count) = ([[0.0; 5]; 5], [0.0; 5], 0.0, 0.0);
    let inside = |at: f64, count: usize| at >= 0.0 && at <= (count - 1) as f64;
    for y in (0..a.ny()).step_by(stride) {
        for x in (0..a.nx()).step_by(stride) {
            let (px, py) = (x as f64 * a.dx_um(), y as f64 * a.dy_um());
            let (u, v) = ((px - shift[0]) / b.dx_um(), (py - shift[1]) / b.dy_um());
            if !inside(u, b.nx()) || !inside(v, b.ny()) {
                continue;
            }
            // Over two points: noise weighs a quarter of what it does over one.
            let slope_x = 0.5 * (interpolated(b, u + 1.0, v) - interpolated(b, u - 1.0, v));
            let slope_y = 0.5 * (interpolated(b, u, v + 1.0) - interpolated(b, u, v - 1.0));
            let rest = a.row(y)[x] - interpolated(b, u, v);
            // Moving the second by a point changes it by minus its slope per point.
            let row = [1.0, x as f64 / a.nx() as f64, y as f64 / a.ny() as f64, -slope_x, -slope_y];
            if rest.is_nan() || row.iter().any(|value| value.is_nan()) {
                continue;
            }
            for i in 0..5 {
                for k in 0..5 {
                    matrix[i][k] += row[i] * row[k];
                }
                right[i] += row[i] * rest;
            }
            squares += rest * rest;
            count += 1.0;
        }
    }
    if count < 25.0 {
        return None;
    }
    // What the best plane takes off.
    let plane = solved(&matrix, &right, 3)?;
    let taken: f64 = (0..3).map(|k| plane[k] * right[k]).sum();
    Some((matrix, right, (squares - taken) / count))
}

/// The first `count` unknowns: of three the plane, of five the shift with it.
fn solved(matrix: &[[f64; 5]; 5], right: &[f64; 5], count: usize) -> Option<[f64; 6]> {
    let mut m = [[0.0; 7]; 6];
    for i in 0..count {
        m[i][..count].copy_from_slice(&matrix[i][..count]);
        m[i][6] = right[i];
    }
    form::solve(&mut m, count)
}

/// The second with the plane added that brings it nearest to the first; the plane as height and slopes per mm.
fn levelled(first: &Surface, second: &Surface) -> (Surface, [f64; 3]) {
    let (nx, ny) = (first.nx(), first.ny());
    let place = |i: usize| [1.0, (i % nx) as f64 / nx as f64, (i / nx) as f64 / ny as f64];
    let (mut matrix, mut right) = ([[0.0; 5]; 5], [0.0; 5]);
    for i in 0..nx * ny {
        let rest = first.heights_um()[i] - second.heights_um()[i];
        if !rest.is_nan() {
            let row = place(i);
            for (j, value) in row.iter().enumerate() {
                for (k, other) in row.iter().enumerate() {
                    matrix[j][k] += value * other;
                }
                right[j] += value * rest;
            }
        }
    }
    let [c, x, y, ..] = solved(&matrix, &right, 3).unwrap_or([0.0; 6]);
    let heights = second.heights_um().iter().enumerate();
    let heights = heights
        .map(|(i, z)| {
            let [_, px, py] = place(i);
            z + c + x * px + y * py
        })
        .collect();
    let per_mm = |slope: f64, count: usize, step: f64| slope / (count as f64 * step) * 1e3;
    (second.with_heights(heights), [c, per_mm(x, nx, first.dx_um()), per_mm(y, ny, first.dy_um())])
}

/// Correlation of the heights of both, planes off.
fn correlation_of(first: &Surface, second: &Surface) -> Result<f64, String> {
    let (a, b) = (form::remove(first, Form::Plane)?.0, form::remove(second, Form::Plane)?.0);
    let sums = a.heights_um().iter().zip(b.heights_um()).filter(|(p, q)| !p.is_nan() && !q.is_nan());
    let [pp, qq, pq] = sums.fold([0.0; 3], |[pp, qq, pq], (p, q)| [pp + p * p, qq + q * q, pq + p * q]);
    Ok(if pp * qq > 0.0 { pq / (pp * qq).sqrt() } else { 0.0 })
}

/// The marks of a surface: its largest wave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceMarks {
    /// Wavelength across the marks, um.
    pub pitch_um: f64,
    /// Direction across the marks, deg from +x towards +y, above -90 and up to 90.
    pub direction_deg: f64,
    /// Amplitude of the wave, um.
    pub amplitude_um: f64,
    /// Phase at the first point, deg.
    pub phase_deg: f64,
    /// Waves per um along x and y.
    pub frequency: [f64; 2],
}

/// The marks of a surface.
///
/// # Errors
/// A surface without a wave that it holds often enough.
pub fn marks(surface: &Surface) -> Result<SurfaceMarks, String> {
    let (level, _) = form::remove(surface, Form::Poly2)?;
    let (lx, ly) = (level.nx() as f64 * level.dx_um(), level.ny() as f64 * level.dy_um());
    let cell = [(lx / COARSE as f64).max(level.dx_um()), (ly / COARSE as f64).max(level.dy_um())];
    let cells = Cells::of(&level, cell);
    let (mx, my) = (2 * cells.nx, 2 * cells.ny);
    let window = |i: usize, count: usize| 0.5 - 0.5 * (TAU * (i as f64 + 0.5) / count as f64).cos();
    let mut values = vec![Complex::default(); mx * my];
    for i in 0..cells.nx * cells.ny {
        let (x, y) = (i % cells.nx, i / cells.nx);
        values[y * mx + x] = Complex::new(cells.heights[i] * window(x, cells.nx) * window(y, cells.ny), 0.0);
    }
    let power = transformed(values, mx, my, false);
    let mut best = (0.0, [0.0; 2]);
    for x in 0..=cells.nx {
        for y in 0..my {
            let fy = if y <= my / 2 { y as f64 } else { y as f64 - my as f64 };
            let frequency = [x as f64 / (mx as f64 * cell[0]), fy / (my as f64 * cell[1])];
            let held = (frequency[0] * lx).hypot(frequency[1] * ly);
            let strength = power[x * my + y].norm_sqr();
            if held >= FEWEST_WAVES && strength > best.0 {
                best = (strength, frequency);
            }
        }
    }
    if best.0 == 0.0 {
        return Err("the surface has no marks".to_owned());
    }
    // Up the hill of the windowed amplitude, by parabolas along both axes.
    let mut frequency = best.1;
    let mut step = [0.25 / lx, 0.25 / ly];
    for _ in 0..6 {
        for k in 0..2 {
            let at = |shift: f64| {
                let mut there = frequency;
                there[k] += shift;
                wave(&level, there).norm()
            };
            let [low, middle, high] = [at(-step[k]), at(0.0), at(step[k])];
            let bend = low - 2.0 * middle + high;
            if bend < 0.0 {
                frequency[k] += (0.5 * (low - high) / bend).clamp(-2.0, 2.0) * step[k];
            }
            step[k] *= 0.5;
        }
    }
    if frequency[0] < 0.0 || (frequency[0].abs() * lx < 1e-9 && frequency[1] < 0.0) {
        frequency = [-frequency[0], -frequency[1]];
    }
    let found = wave(&level, frequency);
    let size = frequency[0].hypot(frequency[1]);
    Ok(SurfaceMarks {
        pitch_um: 1.0 / size,
        direction_deg: frequency[1].atan2(frequency[0]).to_degrees(),
        amplitude_um: found.norm(),
        phase_deg: found.arg().to_degrees(),
        frequency,
    })
}

impl SurfaceMarks {
    /// Phase of these marks on another surface less that on this one, deg, -180 to 180: where the other's marks come
    /// later along [`SurfaceMarks::direction_deg`] it is negative.
    ///
    /// # Errors
    /// A surface without form.
    pub fn phase_on_deg(&self, other: &Surface) -> Result<f64, String> {
        let (level, _) = form::remove(other, Form::Poly2)?;
        let phase = wave(&level, self.frequency).arg().to_degrees() - self.phase_deg;
        Ok(phase - 360.0 * (phase / 360.0).round())
    }
}

/// Amplitude and phase of one wave under a Hann window; holes count as zero height.
fn wave(surface: &Surface, frequency: [f64; 2]) -> Complex<f64> {
    let line = |count: usize, step: f64, frequency: f64| -> Vec<Complex<f64>> {
        let window = |i: usize| 0.5 - 0.5 * (TAU * (i as f64 + 0.5) / count as f64).cos();
        (0..count).map(|i| Complex::from_polar(window(i), -TAU * frequency * i as f64 * step)).collect()
    };
    let along = line(surface.nx(), surface.dx_um(), frequency[0]);
    let up = line(surface.ny(), surface.dy_um(), frequency[1]);
    let rows: Vec<Complex<f64>> = (0..surface.ny())
        .into_par_iter()
        .map(|y| {
            let row = surface.row(y).iter().zip(&along).filter(|(z, _)| !z.is_nan());
            row.map(|(z, w)| w * *z).sum::<Complex<f64>>() * up[y]
        })
        .collect();
    let weight = |line: &[Complex<f64>]| line.iter().map(|w| w.norm()).sum::<f64>();
    rows.into_iter().sum::<Complex<f64>>() * (2.0 / (weight(&along) * weight(&up)))
}

#[cfg(test)]
mod tests;
