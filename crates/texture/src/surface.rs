//! A measured or simulated surface: heights on a regular grid, with holes.
//!
//! Rows follow y, x runs fastest; heights in micrometres, positive out of the material; NaN marks a point that was not
//! measured. Sums over a surface are taken row by row and folded in the order of the rows, so that the number of
//! threads never changes a digit.

use crate::error::TextureError;
use rayon::prelude::*;

/// Largest height, um, over and under zero: 1 m. Fourth powers of heights and squares of slopes, summed, stay far
/// inside of what f64 holds.
pub const LARGEST_HEIGHT_UM: f64 = 1e6;
/// Least and largest spacing of points, um: 1 pm to 1 m.
pub const SPACINGS_UM: [f64; 2] = [1e-6, 1e6];

/// Heights on a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    nx: usize,
    ny: usize,
    dx_um: f64,
    dy_um: f64,
    heights_um: Vec<f64>,
}

impl Surface {
    /// Surface of `nx` x `ny` points at distances `dx_um`, `dy_um`; infinite heights become holes.
    ///
    /// # Errors
    /// Fewer than two points along a side, a spacing out of [`SPACINGS_UM`], heights that do not fill the grid or lie
    /// beyond [`LARGEST_HEIGHT_UM`], or no height at all.
    pub fn new(nx: usize, ny: usize, dx_um: f64, dy_um: f64, mut heights_um: Vec<f64>) -> Result<Self, TextureError> {
        if nx < 2 || ny < 2 {
            return Err(TextureError::SmallGrid { nx, ny });
        }
        if !(dx_um > 0.0 && dy_um > 0.0 && dx_um.is_finite() && dy_um.is_finite()) {
            return Err(TextureError::NoSpacing { dx_um, dy_um });
        }
        let [least, most] = SPACINGS_UM;
        if let Some(spacing_um) = [dx_um, dy_um].into_iter().find(|spacing| !(least..=most).contains(spacing)) {
            return Err(TextureError::SpacingOutOfRange { spacing_um, range_um: SPACINGS_UM });
        }
        if nx.checked_mul(ny) != Some(heights_um.len()) {
            return Err(TextureError::UnfilledGrid { heights: heights_um.len(), nx, ny });
        }
        for height in &mut heights_um {
            if !height.is_finite() {
                *height = f64::NAN;
            }
        }
        if heights_um.iter().all(|h| h.is_nan()) {
            return Err(TextureError::NothingMeasured);
        }
        check_heights(&heights_um, |i| (i % nx, Some(i / nx + 1)))?;
        Ok(Self { nx, ny, dx_um, dy_um, heights_um })
    }

    /// The same grid with other heights.
    pub(crate) fn with_heights(&self, heights_um: Vec<f64>) -> Self {
        debug_assert_eq!(heights_um.len(), self.heights_um.len());
        Self { heights_um, ..*self }
    }

    /// Points along x.
    pub fn nx(&self) -> usize {
        self.nx
    }

    /// Points along y.
    pub fn ny(&self) -> usize {
        self.ny
    }

    /// Distance of points along x, um.
    pub fn dx_um(&self) -> f64 {
        self.dx_um
    }

    /// Distance of points along y, um.
    pub fn dy_um(&self) -> f64 {
        self.dy_um
    }

    /// All heights, um; NaN in holes.
    pub fn heights_um(&self) -> &[f64] {
        &self.heights_um
    }

    /// One line along x.
    pub fn row(&self, y: usize) -> &[f64] {
        &self.heights_um[y * self.nx..(y + 1) * self.nx]
    }

    /// One line along y.
    pub fn column(&self, x: usize) -> Vec<f64> {
        self.heights_um.iter().skip(x).step_by(self.nx).copied().collect()
    }

    /// Number of points that were not measured.
    pub fn holes(&self) -> usize {
        self.heights_um.par_iter().filter(|h| h.is_nan()).count()
    }

    /// Evaluation area from the first to the last point, mm: `[x, y]`.
    pub fn size_mm(&self) -> [f64; 2] {
        [(self.nx - 1) as f64 * self.dx_um * 1e-3, (self.ny - 1) as f64 * self.dy_um * 1e-3]
    }

    /// Sums over the rows, in their order.
    pub(crate) fn sum_rows<const N: usize>(&self, of_row: impl Fn(usize, &[f64]) -> [f64; N] + Sync) -> [f64; N] {
        let rows: Vec<[f64; N]> =
            self.heights_um.par_chunks(self.nx).enumerate().map(|(y, row)| of_row(y, row)).collect();
        rows.into_iter().fold([0.0; N], |mut sum, row| {
            for (total, part) in sum.iter_mut().zip(row) {
                *total += part;
            }
            sum
        })
    }

    /// Mean height, um.
    pub fn mean_um(&self) -> f64 {
        // Eight sums at a time: each waits for its own last addition only.
        let [sum, count] = self.sum_rows(|_, row| {
            let (mut sums, mut counts) = ([0.0; 8], [0.0; 8]);
            for heights in row.chunks(8) {
                for ((sum, count), z) in sums.iter_mut().zip(&mut counts).zip(heights) {
                    let measured = !z.is_nan();
                    *sum += if measured { *z } else { 0.0 };
                    *count += f64::from(u8::from(measured));
                }
            }
            [sums.iter().sum(), counts.iter().sum()]
        });
        sum / count
    }

    /// Lowest and highest height, um.
    pub fn ends_um(&self) -> [f64; 2] {
        // Smallest and largest pass over holes: NaN is neither.
        let ends = |[low, high]: [f64; 2], [a, b]: [f64; 2]| [low.min(a), high.max(b)];
        let none = || [f64::INFINITY, f64::NEG_INFINITY];
        self.heights_um.par_iter().map(|&z| [z, z]).reduce(none, ends)
    }

    /// Without a margin of whole points on every side, at least `margin_um` wide.
    ///
    /// # Errors
    /// Nothing, or a single line, would be left.
    pub fn cropped(&self, margin_um: f64) -> Result<Self, TextureError> {
        let points = |spacing_um: f64| (margin_um / spacing_um - 1e-9).ceil().max(0.0) as usize;
        let (cx, cy) = (points(self.dx_um), points(self.dy_um));
        let leaves_none = |count: usize, cut: usize| count < cut.saturating_mul(2).saturating_add(2);
        if leaves_none(self.nx, cx) || leaves_none(self.ny, cy) {
            return Err(TextureError::NothingLeft { margin_um, size_mm: self.size_mm() });
        }
        let (nx, ny) = (self.nx - 2 * cx, self.ny - 2 * cy);
        let heights = (cy..cy + ny).flat_map(|y| self.row(y)[cx..cx + nx].iter().copied()).collect();
        Self::new(nx, ny, self.dx_um, self.dy_um, heights)
    }
}

/// Refuses heights that are too large to be evaluated; `place` gives column and row of an index.
pub(crate) fn check_heights(
    heights_um: &[f64],
    place: impl FnOnce(usize) -> (usize, Option<usize>),
) -> Result<(), TextureError> {
    let Some(index) = heights_um.iter().position(|z| z.abs() > LARGEST_HEIGHT_UM) else { return Ok(()) };
    let (column, row) = place(index);
    Err(TextureError::HeightOutOfRange {
        point: column + 1,
        row,
        height_um: heights_um[index],
        most_um: LARGEST_HEIGHT_UM,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_are_checked() {
        for (nx, ny, dx, count, word) in
            [(1, 5, 1.0, 5, "2 x 2"), (2, 2, 0.0, 4, "spacing"), (2, 2, 1.0, 5, "do not fill")]
        {
            let reason = Surface::new(nx, ny, dx, 1.0, vec![0.0; count]).expect_err("refused");
            assert!(reason.to_string().contains(word), "{reason}");
        }
        assert!(Surface::new(2, 2, 1.0, 1.0, vec![f64::INFINITY; 4]).is_err());
        for (dx, height, word) in [
            (1e300, 0.0, "spacing of 1e300 um is out of range"),
            (1e-300, 0.0, "out of range"),
            (1.0, 1e308, "point 2 in row 1 is 1e308 um, beyond +-1e6 um"),
            (1.0, -f64::MAX, "more than any number"),
        ] {
            let reason = Surface::new(2, 2, dx, 1.0, vec![0.0, height, 0.0, 0.0]).expect_err("refused");
            assert!(reason.to_string().contains(word), "{reason}");
        }
        assert!(Surface::new(2, 2, 1e-6, 1e6, vec![0.0, 1e6, -1e6, 0.0]).is_ok());
    }

    #[test]
    fn cropping_takes_whole_points_and_refuses_to_take_all() {
        let heights: Vec<f64> = (0..35).map(f64::from).collect();
        let surface = Surface::new(7, 5, 1.0, 2.0, heights).expect("a grid");
        let inner = surface.cropped(1.5).expect("something is left");
        assert_eq!((inner.nx(), inner.ny()), (3, 3));
        assert_eq!(inner.row(0), [9.0, 10.0, 11.0]);
        assert!(surface.cropped(3.0).is_err());
        assert!(surface.cropped(1e300).is_err());
    }
}
