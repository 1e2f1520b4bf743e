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
//! 3. From the best of these shifts on, shift and plane are refined together by least squares on the points themselves
//!    (Gauss and Newton), the second interpolated by cubic convolution. That which then correlates best is taken: marks
//!    that follow each other fit at every pitch nearly as well.
//!
//! Road not taken: rotation and scale. A flank lies in its instrument by its axis, and a turned one is turned by
//! [`crate::prepare`]; free turns of marks that run one way are hardly determined.

mod cells;
mod marks;

use crate::error::TextureError;
use rayon::prelude::*;

use super::form::{self, Form};
use super::prepare::{MirrorAxis, Preparation, interpolated};
use super::surface::Surface;
use cells::{COARSE, Cells, correlations};
pub use marks::{SurfaceMarks, marks};

/// How much better a mirrored surface must correlate to be taken, or the better of two good ones by `HARDLY` where it
/// halves the variance that is left.
const CLEARLY: f64 = 0.1;
const HARDLY: f64 = 0.005;
/// Points that the refinement looks at, about.
const LOOKED_AT: usize = 60_000;
/// Rounds of refinement: four are enough without noise, whose slopes shorten the steps along marks.
const ROUNDS: usize = 60;

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
pub fn aligned(first: &Surface, second: &Surface) -> Result<Aligned, TextureError> {
    let (a, _) = form::remove(first, Form::Plane)?;
    let (b, _) = form::remove(second, Form::Plane)?;
    let cell = [0, 1].map(|k| {
        let side = |s: &Surface| [(s.nx() as f64) * s.dx_um(), (s.ny() as f64) * s.dy_um()][k];
        let step = |s: &Surface| [s.dx_um(), s.dy_um()][k];
        (side(&a).max(side(&b)) / COARSE as f64).max(step(&a).max(step(&b)))
    });
    let (coarse_a, coarse_b) = (Cells::of(&a, cell), Cells::of(&b, cell));
    let found = correlations(&coarse_a, &coarse_b);
    let by_mirror = [0, 1, 2, 3].map(|k| found[k].peaks.first().map_or(f64::NEG_INFINITY, |peak| peak.0));
    let best = (1..4).fold(0, |best, k| if by_mirror[k] > by_mirror[best] { k } else { best });
    let [as_it_is, mirrored] = [by_mirror[0], by_mirror[best]];
    let taken = if fits_better(mirrored, as_it_is) { best } else { 0 };
    let mirrored = MIRRORS[taken];
    let b = mirror(&b, mirrored)?;
    // Cells blur what tells the peaks apart.
    let refine = |(_, cells): &(f64, [f64; 2])| refined(&a, &b, [cells[0] * cell[0], cells[1] * cell[1]]);
    let shifts: Vec<[f64; 2]> = found[taken].peaks.par_iter().map(refine).collect();
    let left: Vec<f64> = shifts.par_iter().map(|&shift| left_over(&a, &b, shift)).collect();
    let best = (0..shifts.len()).min_by(|&a, &b| left[a].total_cmp(&left[b]));
    let shift_um = best.map(|best| shifts[best]);
    let shift_um = shift_um.ok_or(TextureError::TooLittleInCommon)?;
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
        return Err(TextureError::NoOverlap);
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
    let inverted = found[0].inverted;
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
pub fn difference(aligned: &Aligned) -> Result<Surface, TextureError> {
    let (a, b) = (&aligned.first, &aligned.second);
    let heights = a.heights_um().iter().zip(b.heights_um()).map(|(a, b)| b - a).collect();
    Surface::new(a.nx(), a.ny(), a.dx_um(), a.dy_um(), heights)
}

fn mirror(surface: &Surface, [x, y]: Mirrored) -> Result<Surface, TextureError> {
    let axes = [(x, MirrorAxis::X), (y, MirrorAxis::Y)].into_iter().filter(|(wanted, _)| *wanted);
    axes.into_iter().try_fold(surface.clone(), |surface, (_, axis)| {
        Ok(Preparation { mirror: Some(axis), ..Preparation::default() }.apply(&surface)?.0)
    })
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

/// Points of the first that are looked at, about evenly: their indices, and their places on the second in points.
fn looked_at(a: &Surface, b: &Surface, shift: [f64; 2]) -> impl Iterator<Item = ([usize; 2], [f64; 2])> {
    let stride = ((a.nx() * a.ny()) as f64 / LOOKED_AT as f64).sqrt().ceil().max(1.0) as usize;
    let (step, on) = ([a.dx_um(), a.dy_um()], [b.dx_um(), b.dy_um()]);
    let ends = [(b.nx() - 1) as f64, (b.ny() - 1) as f64];
    let rows = (0..a.ny()).step_by(stride);
    let points = rows.flat_map(move |y| (0..a.nx()).step_by(stride).map(move |x| [x, y]));
    let placed = points.map(move |[x, y]| {
        let place = [(x as f64 * step[0] - shift[0]) / on[0], (y as f64 * step[1] - shift[1]) / on[1]];
        ([x, y], place)
    });
    placed.filter(move |(_, place)| (0..2).all(|k| place[k] >= 0.0 && place[k] <= ends[k]))
}

/// What a plane and the second surface, at any scale, leave of the first's variance: 1 less the correlation's square.
fn left_over(a: &Surface, b: &Surface, shift: [f64; 2]) -> f64 {
    let (mut matrix, mut right, mut squares) = ([[0.0; 5]; 5], [0.0; 5], 0.0);
    for ([x, y], [u, v]) in looked_at(a, b, shift) {
        let (z, other) = (a.row(y)[x], interpolated(b, u, v));
        if z.is_nan() || other.is_nan() {
            continue;
        }
        let row = [1.0, x as f64 / a.nx() as f64, y as f64 / a.ny() as f64, other];
        for i in 0..4 {
            for k in 0..4 {
                matrix[i][k] += row[i] * row[k];
            }
            right[i] += row[i] * z;
        }
        squares += z * z;
    }
    let rest = |count: usize| {
        let found = solved(&matrix, &right, count)?;
        Some(squares - (0..count).map(|k| found[k] * right[k]).sum::<f64>())
    };
    rest(3).zip(rest(4)).map_or(f64::INFINITY, |(plane, both)| both / plane)
}

fn normal_equations(a: &Surface, b: &Surface, shift: [f64; 2]) -> Option<Normal> {
    let (mut matrix, mut right, mut squares, mut count) = ([[0.0; 5]; 5], [0.0; 5], 0.0, 0.0);
    for ([x, y], [u, v]) in looked_at(a, b, shift) {
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
fn correlation_of(first: &Surface, second: &Surface) -> Result<f64, TextureError> {
    let (a, b) = (form::remove(first, Form::Plane)?.0, form::remove(second, Form::Plane)?.0);
    let sums = a.heights_um().iter().zip(b.heights_um()).filter(|(p, q)| !p.is_nan() && !q.is_nan());
    let [pp, qq, pq] = sums.fold([0.0; 3], |[pp, qq, pq], (p, q)| [pp + p * p, qq + q * q, pq + p * q]);
    Ok(if pp * qq > 0.0 { pq / (pp * qq).sqrt() } else { 0.0 })
}

#[cfg(test)]
mod tests;
