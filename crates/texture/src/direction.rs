//! Std: the direction of the **wave vector** with the largest power per angle, counter-clockwise from +x towards +y;
//! the lay runs across it.
//!
//! In: the power of a surface's waves, one value for each pair of frequencies. Law: power per angle is a density over
//! the plane of frequencies, and a value stands for a whole cell of it, not for a point. Within 45 deg of the x axis
//! the cells of one frequency along x are the segments of a line across the directions; near the y axis those of one
//! frequency along y are. What such a line gives to a class of half a degree is what it carries between the two
//! directions. Std is the mean direction of the cells in the class that has most, by the squares of their power, so
//! that noise beside a wave does not pull.
//!
//! Road not taken: giving each value to the class of its own direction. On a long window hundreds of frequencies along
//! it have the very same one, its axis, and their noise adds up there until it outweighs any wave.

use crate::error::TextureError;
use rayon::prelude::*;
use std::ops::Range;

use super::spectrum::PowerSpectrum;
use super::surface::Surface;

/// Classes in a degree.
const PER_DEG: f64 = 2.0;
/// Classes within 45 deg of an axis on both sides.
const CLASSES: usize = 180;
/// Lines taken at a time; fixed, so that the number of threads never changes a digit.
const LINES: usize = 32;

/// Lines across the directions near one axis.
struct Fan<'a> {
    spectrum: &'a PowerSpectrum,
    /// Steps of frequency from line to line, and from cell to cell along a line, 1/um.
    steps: [f64; 2],
    /// Lines of this fan, the first with frequency 1.
    lines: usize,
    /// Cells on either side of the axis.
    cells: usize,
    /// Largest frequency, 1/um: corners of the plane beyond the circle would favour diagonals.
    reach: f64,
    /// The axis is that of y.
    along_y: bool,
}

impl Fan<'_> {
    /// Cells on either side of the axis that directions up to 45 deg cross.
    fn side(&self, number: usize) -> usize {
        let [across, along] = self.steps;
        ((number as f64 * across / along) as usize + 1).min(self.cells)
    }

    /// Cells on either side of the axis that lie within reach; none, where not even the axis does.
    fn within(&self, number: usize) -> Option<usize> {
        let [across, along] = self.steps;
        let (distance, reach) = (number as f64 * across, self.reach);
        (distance <= reach).then(|| ((reach * reach - distance * distance).sqrt() / along) as usize)
    }

    /// Power of the cells of some lines, from one end to the other, each line as long as the last; beyond reach zero.
    fn block(&self, numbers: Range<usize>) -> Vec<f64> {
        let side = self.side(numbers.end - 1);
        let (ny, width) = (self.spectrum.ny, 2 * side + 1);
        let mut block = vec![0.0; numbers.len() * width];
        let column = |fx: usize| &self.spectrum.power[fx * ny..(fx + 1) * ny];
        let ends = numbers.clone().map_while(|number| Some(self.within(number)?.min(side)));
        if self.along_y {
            // As the spectrum lies in memory; opposite frequencies are one wave.
            let ends: Vec<usize> = ends.collect();
            for cell in 0..=side {
                let power = column(cell);
                let within = ends.partition_point(|end| *end >= cell);
                for (row, fy) in block.chunks_exact_mut(width).zip(numbers.clone()).take(within) {
                    row[side - cell] = power[ny - fy];
                    row[side + cell] = power[fy];
                }
            }
        } else {
            for ((row, fx), end) in block.chunks_exact_mut(width).zip(numbers).zip(ends) {
                let power = column(fx);
                row[side - end..side].copy_from_slice(&power[ny - end..]);
                row[side..=side + end].copy_from_slice(&power[..=end]);
            }
        }
        block
    }

    /// Where the direction with this tangent to the axis crosses a line, in cells from the axis.
    fn crossing(&self, number: usize, tangent: f64) -> f64 {
        let [across, along] = self.steps;
        let end = self.side(number) as f64 + 0.5;
        (tangent * number as f64 * across / along).clamp(-end, end)
    }

    /// Power of all classes, which lie between directions with these tangents.
    fn classes(&self, tangents: &[f64]) -> Vec<f64> {
        let starts: Vec<usize> = (1..=self.lines).step_by(LINES).collect();
        let of_block = |start: usize| {
            let numbers = start..(start + LINES).min(self.lines + 1);
            let side = self.side(numbers.end - 1);
            let block = self.block(numbers.clone());
            let mut sums = vec![0.0; tangents.len() - 1];
            let mut below = Vec::with_capacity(2 * side + 2);
            for (line, number) in block.chunks(2 * side + 1).zip(numbers) {
                below.clear();
                below.push(0.0);
                let mut sum = 0.0;
                below.extend(line.iter().map(|power| {
                    sum += power;
                    sum
                }));
                let up_to = |tangent: f64| {
                    let place = self.crossing(number, tangent) + side as f64 + 0.5;
                    let cell = (place as usize).min(line.len() - 1);
                    below[cell] + (place - cell as f64) * line[cell]
                };
                let mut before = up_to(tangents[0]);
                for (sum, &tangent) in sums.iter_mut().zip(&tangents[1..]) {
                    let here = up_to(tangent);
                    *sum += here - before;
                    before = here;
                }
            }
            sums
        };
        let parts: Vec<Vec<f64>> = starts.into_par_iter().map(of_block).collect();
        let mut sums = vec![0.0; tangents.len() - 1];
        for part in parts {
            for (sum, part) in sums.iter_mut().zip(part) {
                *sum += part;
            }
        }
        sums
    }

    /// Power of a cell, counted from the axis.
    fn power(&self, number: usize, offset: i64) -> f64 {
        if self.within(number).is_none_or(|end| offset.unsigned_abs() as usize > end) {
            return 0.0;
        }
        // Opposite frequencies are one wave.
        let (fx, fy) = if self.along_y { (offset, number as i64) } else { (number as i64, offset) };
        let (fx, fy) = if fx < 0 { (-fx, -fy) } else { (fx, fy) };
        let ny = self.spectrum.ny;
        self.spectrum.power[fx as usize * ny + if fy < 0 { ny - (-fy) as usize } else { fy as usize }]
    }

    /// Mean direction of the cells between two tangents by the squares of their power, deg.
    fn mean_deg(&self, tangents: [f64; 2]) -> f64 {
        let [across, along] = self.steps;
        let (mut power, mut turned) = (0.0, 0.0);
        for number in 1..=self.lines {
            let [from, to] = tangents.map(|tangent| self.crossing(number, tangent));
            for offset in (from + 0.5).floor() as i64..=(to + 0.5).floor() as i64 {
                let cell = offset as f64;
                let share = (to.min(cell + 0.5) - from.max(cell - 0.5)).max(0.0) * self.power(number, offset).powi(2);
                power += share;
                turned += share * (cell * along).atan2(number as f64 * across).to_degrees();
            }
        }
        let angle = turned / power;
        if self.along_y { 90.0 - angle } else { angle.rem_euclid(180.0) }
    }
}

/// Std, deg, 0 to 180.
///
/// # Errors
/// No wave at all.
pub(crate) fn direction_deg(spectrum: &PowerSpectrum, surface: &Surface) -> Result<f64, TextureError> {
    let (half, ny) = (surface.nx() / 2 + 1, spectrum.ny);
    let [x, y] = [surface.nx() as f64 * surface.dx_um(), ny as f64 * surface.dy_um()].map(|length_um| 1.0 / length_um);
    let reach = 0.5 / surface.dx_um().max(surface.dy_um());
    let middle = (ny - 1) / 2;
    let near_x = Fan { spectrum, steps: [x, y], lines: half - 1, cells: ny / 2, reach, along_y: false };
    let near_y = Fan { spectrum, steps: [y, x], lines: middle.max(1), cells: half - 1, reach, along_y: true };
    let fans = [&near_x, &near_y];
    let tangents: Vec<f64> = (0..=CLASSES).map(|class| (class as f64 / PER_DEG - 45.0).to_radians().tan()).collect();
    let classes = fans.map(|fan| fan.classes(&tangents));
    let mut best = (0.0, None);
    for (fan, sums) in fans.into_iter().zip(&classes) {
        for (class, &sum) in sums.iter().enumerate() {
            if sum > best.0 {
                best = (sum, Some((fan, class)));
            }
        }
    }
    best.1.map(|(fan, class)| fan.mean_deg([tangents[class], tangents[class + 1]])).ok_or(TextureError::NoWaves)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::power;
    use std::f64::consts::TAU;

    /// Noise of standard deviation 0.6 um, the same in every run.
    fn noise(i: usize) -> f64 {
        let mut state = i as u64 ^ 0x9e37_79b9_7f4a_7c15;
        let mut next = || {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
        };
        0.6 * (12.0_f64 / 4.0).sqrt() * ((next() + next() + next() + next()) - 2.0)
    }

    fn std_deg(size: [usize; 2], spacing: [f64; 2], height: impl Fn(usize, usize) -> f64) -> f64 {
        let heights = (0..size[0] * size[1]).map(|i| height(i % size[0], i / size[0])).collect();
        let surface = Surface::new(size[0], size[1], spacing[0], spacing[1], heights).expect("a grid");
        direction_deg(&power(&surface), &surface).expect("waves")
    }

    /// One wave in noise on windows twenty times as long as wide, in all directions.
    #[test]
    fn noise_on_a_long_window_does_not_turn_the_direction() {
        for (kx, ky) in [(60, 3), (30, -2), (100, 5), (7, 1), (40, 0), (0, 4), (25, -6)] {
            for turned in [false, true] {
                let wave = |x: usize, y: usize| {
                    let turns = f64::from(kx) * x as f64 / 600.0 + f64::from(ky) * y as f64 / 30.0;
                    (TAU * turns).sin() + noise(y * 600 + x)
                };
                let closed = (f64::from(ky) / 60.0).atan2(f64::from(kx) / 1200.0).to_degrees();
                let (found, closed) = if turned {
                    (std_deg([30, 600], [2.0, 2.0], |x, y| wave(y, x)), 90.0 - closed)
                } else {
                    (std_deg([600, 30], [2.0, 2.0], wave), closed)
                };
                let off = (found - closed + 90.0).rem_euclid(180.0) - 90.0;
                assert!(off.abs() < 0.5, "{kx} {ky} {turned}: {found} is not {closed}");
            }
        }
    }

    /// Without noise the direction is that of the wave to rounding, on points that are no squares.
    #[test]
    fn a_wave_alone_has_its_own_direction() {
        for (kx, ky) in [(5, 3), (3, 8), (6, -2), (2, -9), (4, 4)] {
            let wave =
                |x: usize, y: usize| (TAU * (f64::from(kx) * x as f64 / 120.0 + f64::from(ky) * y as f64 / 90.0)).cos();
            let closed = (f64::from(ky) / (90.0 * 3.0)).atan2(f64::from(kx) / (120.0 * 2.0)).to_degrees();
            let found = std_deg([120, 90], [2.0, 3.0], wave);
            assert!(((found - closed + 90.0).rem_euclid(180.0) - 90.0).abs() < 1e-6, "{kx} {ky}: {found}, {closed}");
        }
    }
}
