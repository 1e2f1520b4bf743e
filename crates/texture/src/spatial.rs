//! Spatial parameters: Sal and Str from the autocorrelation, Std and Ssw from the spectrum (ISO 25178-2).
//!
//! f(tx, ty) is the unbiased linear autocorrelation, 1 at lag 0. The region round lag 0 where f stays above s = 0.2 is
//! followed; Sal is the shortest distance from lag 0 to its border, Str that divided by the longest one. A region that
//! reaches the edge of the field (feed marks do, along the lay) has no longest distance: Str is undefined there, which
//! is not 0.
//!
//! Std is in `direction`. Ssw is the wavelength of the largest Fourier component of the window, as fine as
//! whole waves in the window can tell.

use super::direction::direction_deg;
use super::spectrum::{Products, Wave, largest_wave, power, products};
use super::surface::Surface;
use crate::error::TextureError;
use rayon::prelude::*;

/// Share of the value at lag 0 to which the autocorrelation decays.
const DECAY: f64 = 0.2;

/// Spatial parameters, each with the reason where it is undefined.
#[derive(Debug, Clone, PartialEq)]
pub struct Spatial {
    /// Autocorrelation length, um.
    pub sal: Result<f64, TextureError>,
    /// Texture aspect ratio.
    pub str: Result<f64, TextureError>,
    /// Direction of the dominant wave vector, deg, 0 to 180.
    pub std: Result<f64, TextureError>,
    /// Wavelength of the largest component, um.
    pub ssw: Result<f64, TextureError>,
}

impl Spatial {
    /// Of a surface about its mean; `flat` when its heights do not differ.
    pub fn of(surface: &Surface, flat: bool) -> Self {
        if flat {
            let none = || Err(TextureError::FlatSurface);
            return Self { sal: none(), str: none(), std: none(), ssw: none() };
        }
        let (sal, str) = correlation_lengths(surface);
        let [std, ssw] = match whole(surface).map(power) {
            Ok(power) => [direction_deg(&power, surface), wavelength_um(power.largest_wave(), surface)],
            Err(why) => [Err(why.clone()), Err(why)],
        };
        Self { sal, str, std, ssw }
    }
}

/// Sal, um, and Str of a surface that is not flat.
pub fn correlation_lengths(surface: &Surface) -> (Result<f64, TextureError>, Result<f64, TextureError>) {
    let mut found = products(surface, surface.mean_um());
    if surface.holes() == 0 {
        divide_by_overlap(&mut found);
    } else {
        let measured = surface.heights_um().iter().map(|z| f64::from(u8::from(!z.is_nan()))).collect();
        let overlap = products(&surface.with_heights(measured), 0.0);
        for (sum, count) in found.sums.iter_mut().zip(&overlap.sums) {
            // Half a pair is rounding: at such a lag no two measured points lie over each other.
            *sum = if *count > 0.5 { *sum / count } else { f64::NAN };
        }
    }
    decay(&found, [surface.dx_um(), surface.dy_um()])
}

/// Std alone, deg, of a surface that is not flat.
///
/// # Errors
/// Holes.
pub fn std_deg(surface: &Surface) -> Result<f64, TextureError> {
    direction_deg(&power(whole(surface)?), surface)
}

/// Ssw alone, um, of a surface that is not flat.
///
/// # Errors
/// Holes.
pub fn ssw_um(surface: &Surface) -> Result<f64, TextureError> {
    wavelength_um(largest_wave(whole(surface)?), surface)
}

/// A surface without holes.
fn whole(surface: &Surface) -> Result<&Surface, TextureError> {
    match surface.holes() {
        0 => Ok(surface),
        holes => Err(TextureError::HolesInSpectrum { holes }),
    }
}

fn divide_by_overlap(products: &mut Products) {
    let (nx, ny) = (products.nx, products.ny);
    products.sums.par_chunks_mut(2 * nx - 1).enumerate().for_each(|(ty, row)| {
        for (i, sum) in row.iter_mut().enumerate() {
            *sum /= ((nx - i.abs_diff(nx - 1)) * (ny - ty)) as f64;
        }
    });
}

/// Half-plane of the autocorrelation with its other half by symmetry: f(-t) = f(t).
struct Correlation<'a> {
    products: &'a Products,
    threshold: f64,
}

/// A lag in points.
type Lag = (i64, i64);

impl Correlation<'_> {
    fn index(&self, (tx, ty): Lag) -> Option<usize> {
        let (tx, ty) = if ty < 0 { (-tx, -ty) } else { (tx, ty) };
        let nx = self.products.nx as i64;
        (tx.abs() < nx && ty < self.products.ny as i64)
            .then(|| ty as usize * (2 * nx as usize - 1) + (tx + nx - 1) as usize)
    }

    /// How far f is above the threshold, in the units of the products; outside the field and where no points overlap
    /// there is no value.
    fn excess(&self, lag: Lag) -> Option<f64> {
        self.index(lag).map(|i| self.products.sums[i] - self.threshold).filter(|e| !e.is_nan())
    }
}

const SIDES: [Lag; 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// Sal and Str.
fn decay(products: &Products, [dx, dy]: [f64; 2]) -> (Result<f64, TextureError>, Result<f64, TextureError>) {
    let origin = products.sums[products.nx - 1];
    let field = Correlation { products, threshold: DECAY * origin };
    let mut inside = vec![false; products.sums.len()];
    let mut region: Vec<Lag> = vec![(0, 0)];
    let mut open = false;
    inside[products.nx - 1] = true;
    let mut next = 0;
    while next < region.len() {
        let (tx, ty) = region[next];
        next += 1;
        for (sx, sy) in SIDES {
            let beside = (tx + sx, ty + sy);
            match field.excess(beside) {
                None => open = true,
                Some(excess) if excess > 0.0 => {
                    let (bx, by) = if beside.1 < 0 { (-beside.0, -beside.1) } else { beside };
                    // On the axis ty = 0 a lag and its opposite are two points of the half-plane.
                    for lag in [(bx, by), (-bx, by)].into_iter().take(if by == 0 { 2 } else { 1 }) {
                        if let Some(i) = field.index(lag).filter(|&i| !inside[i]) {
                            inside[i] = true;
                            region.push(lag);
                        }
                    }
                }
                Some(_) => {}
            }
        }
    }
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
    // Border of the region cell by cell: straight between the places where f falls through the threshold along the
    // cell's sides.
    for &(tx, ty) in &region {
        if SIDES.iter().all(|(sx, sy)| field.excess((tx + sx, ty + sy)).is_none_or(|e| e > 0.0)) {
            continue;
        }
        for (cx, cy) in [(tx, ty), (tx - 1, ty), (tx, ty - 1), (tx - 1, ty - 1)] {
            let corners = [(cx, cy), (cx + 1, cy), (cx + 1, cy + 1), (cx, cy + 1)];
            let mut crossings: Vec<[f64; 2]> = Vec::with_capacity(4);
            for side in 0..4 {
                let (a, b) = (corners[side], corners[(side + 1) % 4]);
                let (Some(ea), Some(eb)) = (field.excess(a), field.excess(b)) else { continue };
                if (ea > 0.0) != (eb > 0.0) {
                    let part = ea / (ea - eb);
                    let along = |a: i64, b: i64, step: f64| (a as f64 + part * (b - a) as f64) * step;
                    crossings.push([along(a.0, b.0, dx), along(a.1, b.1, dy)]);
                }
            }
            for p in &crossings {
                longest = longest.max(p[0].hypot(p[1]));
                shortest = shortest.min(p[0].hypot(p[1]));
            }
            if let [p, q] = crossings[..] {
                shortest = shortest.min(distance_to_segment(p, q));
            }
        }
    }
    if shortest.is_infinite() {
        return (Err(TextureError::NoDecay), Err(TextureError::NoDecay));
    }
    let str = if open { Err(TextureError::OpenDecay) } else { Ok(shortest / longest) };
    (Ok(shortest), str)
}

/// Distance of lag 0 from a segment.
fn distance_to_segment(p: [f64; 2], q: [f64; 2]) -> f64 {
    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
    let length2 = dx * dx + dy * dy;
    let along = if length2 > 0.0 { (-(p[0] * dx + p[1] * dy) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (p[0] + along * dx).hypot(p[1] + along * dy)
}

/// Ssw. The mean has no power: it was taken off.
fn wavelength_um(wave: Wave, surface: &Surface) -> Result<f64, TextureError> {
    if wave.power == 0.0 {
        return Err(TextureError::NoWaves);
    }
    let ny = surface.ny();
    let (fx, fy) = (wave.place / ny, wave.place % ny);
    let fy = if fy <= ny / 2 { fy as f64 } else { fy as f64 - ny as f64 };
    let frequency = (fx as f64 / (surface.nx() as f64 * surface.dx_um())).hypot(fy / (ny as f64 * surface.dy_um()));
    Ok(1.0 / frequency)
}
