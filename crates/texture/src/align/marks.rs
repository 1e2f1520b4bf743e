//! Feed marks of a surface: its largest wave, and the phase of that wave on another surface.
//!
//! In: a surface. Out: [`SurfaceMarks`]: the wave of largest amplitude that the surface holds at least `FEWEST_WAVES`
//! times, with a Hann window, its wave vector refined on the points.

use crate::error::TextureError;
use rayon::prelude::*;
use rustfft::num_complex::Complex;
use std::f64::consts::TAU;

use super::cells::{COARSE, Cells, transformed};
use crate::form::{self, Form};
use crate::surface::Surface;

/// Waves that a field must hold to be marks: fewer are form.
const FEWEST_WAVES: f64 = 3.0;

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
pub fn marks(surface: &Surface) -> Result<SurfaceMarks, TextureError> {
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
    let power = transformed(&values, mx, my, false);
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
        return Err(TextureError::NoMarks);
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
    pub fn phase_on_deg(&self, other: &Surface) -> Result<f64, TextureError> {
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
