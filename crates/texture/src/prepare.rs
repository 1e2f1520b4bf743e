//! What is done to a surface before its chain: points left out, outliers, holes filled, replicas turned back.
//!
//! In: a [`Surface`] and a [`Preparation`]. Out: the surface with what was done, in words and counted. Order:
//! rectangles left out, outliers left out, holes filled, heights inverted, mirrored, cropped to a rectangle, rotated.
//!
//! - A replica shows hills for valleys, and left for right: `invert` and one `mirror` give back the original.
//! - An outlier is a point farther from the median of its 5 x 5 neighbours than a number of standard deviations of
//!   these differences, which are estimated by 1.4826 times their median (Hampel's identifier).
//! - A hole is filled with the harmonic surface through its edge: every point the mean of its four neighbours. At the
//!   edge of the map the missing neighbours do not count.
//! - Right angles turn points; other angles interpolate (cubic convolution, Keys 1981, which damps waves of 10 points
//!   by
//!   0.1 % and of 4 points by up to a tenth) and keep the largest rectangle that lies inside the turned map.
//!
//! Road not taken: fitting outliers and holes after the form is off. What is left out must not depend on what is made
//! of the rest.

use crate::error::{TextureError, rectangle_words};
use rayon::prelude::*;

use super::form::{self, Form};
use super::spatial::Spatial;
use super::surface::Surface;

/// Median absolute deviation to standard deviation, Gaussian.
const MAD_TO_SIGMA: f64 = 1.4826;
/// Half of the side of the neighbourhood whose median an outlier leaves.
const REACH: usize = 2;
/// Share of holes beyond which a surface is not filled: more of it would be made up than a reader expects.
const MOST_FILLED: f64 = 0.2;
/// Rounds of relaxation, and the change, as a share of the heights' range, at which they end.
const MOST_ROUNDS: usize = 20_000;
const SETTLED: f64 = 1e-7;

/// An axis of the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MirrorAxis {
    /// Along a row.
    X,
    /// From row to row.
    Y,
}

/// How far to turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Turn {
    /// Degrees, counter-clockwise from +x towards +y.
    Degrees(f64),
    /// Until the lay runs along x: the direction of Std runs along y.
    Lay,
}

/// From first to last, um: along x, along y; the first point is 0.
pub type RectangleUm = [[f64; 2]; 2];

/// What is to be done.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Preparation {
    /// Points in these rectangles are left out.
    pub masks_um: Vec<RectangleUm>,
    /// Outliers beyond so many standard deviations are left out.
    pub outliers: Option<f64>,
    /// Holes are filled.
    pub fill: bool,
    /// Heights change their sign.
    pub invert: bool,
    /// The axis that runs the other way.
    pub mirror: Option<MirrorAxis>,
    /// The rectangle that is kept.
    pub crop_um: Option<RectangleUm>,
    /// Rotation, after everything else.
    pub rotate: Option<Turn>,
}

impl Preparation {
    /// Prepares a surface; the words say what was done and how often.
    ///
    /// # Errors
    /// A step that leaves nothing, a rectangle beside the map, more holes than are filled, a lay that does not exist.
    pub fn apply(&self, surface: &Surface) -> Result<(Surface, Vec<String>), TextureError> {
        let mut words = Vec::new();
        let mut surface = surface.clone();
        for rectangle in &self.masks_um {
            let before = surface.holes();
            surface = masked(&surface, rectangle)?;
            words.push(format!("mask: {} points left out in {}", surface.holes() - before, rectangle_words(rectangle)));
        }
        if let Some(sigmas) = self.outliers {
            let (kept, count, limit_um) = without_outliers(&surface, sigmas)?;
            surface = kept;
            words.push(format!(
                "outliers: {count} points left out, farther than {limit_um:.4} um from the median of 5 x 5 points"
            ));
        }
        if self.fill {
            let (filled, count) = filled(&surface)?;
            surface = filled;
            words.push(format!("fill: {count} holes filled with harmonic surfaces"));
        }
        if self.invert {
            surface = surface.with_heights(surface.heights_um().iter().map(|z| -z).collect());
            words.push("invert: heights change their sign".to_owned());
        }
        if let Some(axis) = self.mirror {
            surface = mirrored(&surface, axis);
            words.push(format!("mirror: {} runs the other way", if axis == MirrorAxis::X { "x" } else { "y" }));
        }
        if let Some(rectangle) = &self.crop_um {
            surface = cropped(&surface, rectangle)?;
            words.push(format!("crop: to {}", rectangle_words(rectangle)));
        }
        if let Some(turn) = self.rotate {
            let degrees = match turn {
                Turn::Degrees(degrees) => degrees,
                // Std is the direction of the waves; the lay runs across it.
                Turn::Lay => {
                    let (level, _) = form::remove(&surface, Form::Plane)?;
                    let std = Spatial::of(&level, false).std;
                    90.0 - std.map_err(|why| TextureError::NoLay(why.into()))?
                }
            };
            surface = rotated(&surface, degrees)?;
            words.push(format!("rotate: by {degrees:.3} deg, counter-clockwise from +x towards +y"));
        }
        Ok((surface, words))
    }
}

/// Indices from the first to behind the last point in a rectangle.
fn indices(surface: &Surface, rectangle: &RectangleUm) -> Result<[std::ops::Range<usize>; 2], TextureError> {
    let range = |[from, to]: [f64; 2], step: f64, count: usize| {
        let (from, to) = ((from / step - 1e-9).ceil().max(0.0), (to / step + 1e-9).floor());
        // A negative end is 0 as a whole number, and would hold the first point.
        if to < 0.0 { 0..0 } else { (from as usize).min(count)..(to as usize + 1).min(count) }
    };
    let [x, y] =
        [range(rectangle[0], surface.dx_um(), surface.nx()), range(rectangle[1], surface.dy_um(), surface.ny())];
    if x.is_empty() || y.is_empty() {
        let size_um = surface.size_mm().map(|side| side * 1e3);
        return Err(TextureError::EmptyRectangle { rectangle_um: *rectangle, size_um });
    }
    Ok([x, y])
}

fn masked(surface: &Surface, rectangle: &RectangleUm) -> Result<Surface, TextureError> {
    let [x, y] = indices(surface, rectangle)?;
    let mut heights = surface.heights_um().to_vec();
    for row in y {
        heights[row * surface.nx()..][x.clone()].fill(f64::NAN);
    }
    Surface::new(surface.nx(), surface.ny(), surface.dx_um(), surface.dy_um(), heights)
}

fn cropped(surface: &Surface, rectangle: &RectangleUm) -> Result<Surface, TextureError> {
    let [x, y] = indices(surface, rectangle)?;
    let heights = y.clone().flat_map(|row| surface.row(row)[x.clone()].to_vec()).collect();
    Surface::new(x.len(), y.len(), surface.dx_um(), surface.dy_um(), heights)
}

fn mirrored(surface: &Surface, axis: MirrorAxis) -> Surface {
    let (nx, ny) = (surface.nx(), surface.ny());
    let heights = (0..ny).flat_map(|y| {
        let row = surface.row(if axis == MirrorAxis::Y { ny - 1 - y } else { y });
        let turned: Vec<f64> = if axis == MirrorAxis::X { row.iter().rev().copied().collect() } else { row.to_vec() };
        debug_assert_eq!(turned.len(), nx);
        turned
    });
    surface.with_heights(heights.collect())
}

fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The surface without outliers, their number, and the distance that makes one.
fn without_outliers(surface: &Surface, sigmas: f64) -> Result<(Surface, usize, f64), TextureError> {
    let (nx, ny) = (surface.nx(), surface.ny());
    let differences: Vec<f64> = (0..ny)
        .into_par_iter()
        .flat_map_iter(|y| {
            let mut near = Vec::with_capacity((2 * REACH + 1) * (2 * REACH + 1));
            (0..nx)
                .map(|x| {
                    let z = surface.row(y)[x];
                    if z.is_nan() {
                        return f64::NAN;
                    }
                    near.clear();
                    for row in y.saturating_sub(REACH)..=(y + REACH).min(ny - 1) {
                        let cells = &surface.row(row)[x.saturating_sub(REACH)..=(x + REACH).min(nx - 1)];
                        near.extend(cells.iter().copied().filter(|z| !z.is_nan()));
                    }
                    z - median(&mut near)
                })
                .collect::<Vec<f64>>()
        })
        .collect();
    let mut sizes: Vec<f64> = differences.iter().filter(|d| !d.is_nan()).map(|d| d.abs()).collect();
    let limit_um = sigmas * MAD_TO_SIGMA * median(&mut sizes);
    let is_outlier = |d: f64| d.abs() > limit_um;
    let count = differences.iter().filter(|&&d| is_outlier(d)).count();
    let heights = surface.heights_um().iter().zip(&differences);
    let heights = heights.map(|(z, d)| if is_outlier(*d) { f64::NAN } else { *z }).collect();
    Ok((Surface::new(nx, ny, surface.dx_um(), surface.dy_um(), heights)?, count, limit_um))
}

/// The surface without holes, and how many there were.
fn filled(surface: &Surface) -> Result<(Surface, usize), TextureError> {
    let (nx, ny) = (surface.nx(), surface.ny());
    let holes: Vec<usize> = (0..nx * ny).filter(|&i| surface.heights_um()[i].is_nan()).collect();
    let share = holes.len() as f64 / (nx * ny) as f64;
    if share > MOST_FILLED {
        return Err(TextureError::TooManyHoles { percent: 100.0 * share, most_percent: 100.0 * MOST_FILLED });
    }
    let mut heights = surface.heights_um().to_vec();
    let mean = surface.mean_um();
    let range = heights.iter().filter(|z| !z.is_nan()).fold(0.0_f64, |m, z| m.max((z - mean).abs()));
    for &i in &holes {
        heights[i] = mean;
    }
    // Over-relaxation: on a hole of n points across plain means take n^2 rounds, these some n.
    let across = (share.sqrt() * nx.max(ny) as f64).max(3.0);
    let over = 2.0 / (1.0 + std::f64::consts::PI / across);
    for _ in 0..MOST_ROUNDS {
        let mut change = 0.0_f64;
        for &i in &holes {
            let (x, y) = (i % nx, i / nx);
            let (mut sum, mut count) = (0.0, 0.0);
            let neighbours =
                [(x > 0, i.wrapping_sub(1)), (x + 1 < nx, i + 1), (y > 0, i.wrapping_sub(nx)), (y + 1 < ny, i + nx)];
            for (_, k) in neighbours.into_iter().filter(|(inside, _)| *inside) {
                sum += heights[k];
                count += 1.0;
            }
            let step = sum / count - heights[i];
            change = change.max(step.abs());
            heights[i] += over * step;
        }
        if change <= SETTLED * range {
            break;
        }
    }
    Ok((surface.with_heights(heights), holes.len()))
}

/// Turned about its middle.
fn rotated(surface: &Surface, degrees: f64) -> Result<Surface, TextureError> {
    let (nx, ny, dx, dy) = (surface.nx(), surface.ny(), surface.dx_um(), surface.dy_um());
    let quarters = (degrees / 90.0).round();
    if (degrees - 90.0 * quarters).abs() < 1e-9 {
        let z = |x: usize, y: usize| surface.row(y)[x];
        let turned: Vec<f64> = match quarters.rem_euclid(4.0) as u8 {
            0 => surface.heights_um().to_vec(),
            1 => (0..nx).flat_map(|y| (0..ny).map(move |x| (y, ny - 1 - x))).map(|(x, y)| z(x, y)).collect(),
            2 => surface.heights_um().iter().rev().copied().collect(),
            _ => (0..nx).flat_map(|y| (0..ny).map(move |x| (nx - 1 - y, x))).map(|(x, y)| z(x, y)).collect(),
        };
        return if quarters.rem_euclid(2.0) == 0.0 {
            Surface::new(nx, ny, dx, dy, turned)
        } else {
            Surface::new(ny, nx, dy, dx, turned)
        };
    }
    let (sin, cos) = degrees.to_radians().sin_cos();
    let (w, h) = ((nx - 1) as f64 * dx, (ny - 1) as f64 * dy);
    let [width, height] = inscribed(w, h, sin.abs(), cos.abs());
    let (mx, my) = ((width / dx).floor() as usize + 1, (height / dy).floor() as usize + 1);
    let heights: Vec<f64> = (0..my)
        .into_par_iter()
        .flat_map_iter(|y| {
            let v = (y as f64 - 0.5 * (my - 1) as f64) * dy;
            (0..mx)
                .map(|x| {
                    let u = (x as f64 - 0.5 * (mx - 1) as f64) * dx;
                    // The place in the map that comes to lie at (u, v).
                    interpolated(surface, (0.5 * w + u * cos + v * sin) / dx, (0.5 * h - u * sin + v * cos) / dy)
                })
                .collect::<Vec<f64>>()
        })
        .collect();
    Surface::new(mx, my, dx, dy, heights)
}

/// Sides of the largest rectangle along the axes inside a rectangle of `w` x `h` that is turned.
fn inscribed(w: f64, h: f64, sin: f64, cos: f64) -> [f64; 2] {
    let (long, short) = (w.max(h), w.min(h));
    if short <= 2.0 * sin * cos * long || (sin - cos).abs() < 1e-12 {
        // Two corners lie on the long sides.
        let half = 0.5 * short;
        if w >= h { [half / sin, half / cos] } else { [half / cos, half / sin] }
    } else {
        let double = cos * cos - sin * sin;
        [(w * cos - h * sin) / double, (h * cos - w * sin) / double]
    }
}

/// Height between points by cubic convolution; a hole among its sixteen neighbours makes one.
pub(crate) fn interpolated(surface: &Surface, x: f64, y: f64) -> f64 {
    let weights = |t: f64| {
        [
            ((-0.5 * t + 1.0) * t - 0.5) * t,
            (1.5 * t - 2.5) * t * t + 1.0,
            ((-1.5 * t + 2.0) * t + 0.5) * t,
            (0.5 * t - 0.5) * t * t,
        ]
    };
    let cell = |at: f64, count: usize| {
        let first = at.floor().clamp(0.0, (count - 2) as f64);
        (first as usize, at - first)
    };
    let ((ix, tx), (iy, ty)) = (cell(x, surface.nx()), cell(y, surface.ny()));
    let (wx, wy) = (weights(tx), weights(ty));
    let at = |i: usize, k: usize, count: usize| (i + k).saturating_sub(1).min(count - 1);
    let mut sum = 0.0;
    for (k, wy) in wy.into_iter().enumerate() {
        let row = surface.row(at(iy, k, surface.ny()));
        for (l, wx) in wx.into_iter().enumerate() {
            // A weight of nothing takes nothing, not even a hole.
            if wx * wy != 0.0 {
                sum += wx * wy * row[at(ix, l, surface.nx())];
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests;
