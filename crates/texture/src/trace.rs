//! A traced line: heights at equal distances, as a stylus gives them, or a row or column of a surface.
//!
//! In: heights in um, NaN where nothing was measured. Out: the line without holes. Holes at its ends are cut off; holes
//! between measured points are bridged by straight lines as far as their length allows, and counted. Filters, crossings
//! and sections need every point, and one missing point must not cost the line.
//!
//! Road not taken: leaving holes out. A roughness that is summed over what is left is no different, but a spacing or a
//! slope across a hole is, and a filter then needs weights for what a bridge says in a word.

use super::surface::{SPACINGS_UM, Surface, check_heights};
use crate::error::TextureError;

/// Fewest points of a line.
const FEWEST: usize = 10;

/// Heights along a line.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileTrace {
    heights_um: Vec<f64>,
    spacing_um: f64,
}

/// A line without holes, and what became of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Bridged {
    /// Heights from the first to the last measured point, um.
    pub heights_um: Vec<f64>,
    /// Points that were bridged.
    pub points: usize,
    /// Holes that these points made.
    pub holes: usize,
    /// Distance between the measured points on both sides of the longest, um.
    pub longest_um: f64,
    /// Points without height that were cut off at both ends.
    pub cut_off: usize,
}

impl ProfileTrace {
    /// Heights (um, NaN or infinite in holes) at equal distances.
    ///
    /// # Errors
    /// A spacing out of [`SPACINGS_UM`], fewer than ten heights, or heights beyond
    /// [`crate::surface::LARGEST_HEIGHT_UM`].
    pub fn new(mut heights_um: Vec<f64>, spacing_um: f64) -> Result<Self, TextureError> {
        let [least, most] = SPACINGS_UM;
        if !(least..=most).contains(&spacing_um) {
            return Err(TextureError::SpacingOutOfRange { spacing_um, range_um: SPACINGS_UM });
        }
        for height in heights_um.iter_mut().filter(|z| z.is_infinite()) {
            *height = f64::NAN;
        }
        check_heights(&heights_um, |i| (i, None))?;
        Self { heights_um, spacing_um }.checked()
    }

    /// Row `y` of a surface, along x.
    ///
    /// # Errors
    /// Fewer than ten points.
    pub fn row(surface: &Surface, y: usize) -> Result<Self, TextureError> {
        Self { heights_um: surface.row(y).to_vec(), spacing_um: surface.dx_um() }.checked()
    }

    /// Column `x` of a surface, along y.
    ///
    /// # Errors
    /// Fewer than ten points.
    pub fn column(surface: &Surface, x: usize) -> Result<Self, TextureError> {
        Self { heights_um: surface.column(x), spacing_um: surface.dy_um() }.checked()
    }

    fn checked(self) -> Result<Self, TextureError> {
        match self.heights_um.len() {
            FEWEST.. => Ok(self),
            few => Err(TextureError::ShortLine { points: few, fewest: FEWEST }),
        }
    }

    /// All heights, um; NaN in holes.
    pub fn heights_um(&self) -> &[f64] {
        &self.heights_um
    }

    /// Distance of points, um.
    pub fn spacing_um(&self) -> f64 {
        self.spacing_um
    }

    /// From the first to the last point, um.
    pub fn length_um(&self) -> f64 {
        self.spacing_um * (self.heights_um.len() - 1) as f64
    }

    /// The line without holes. Holes that are longer than `longest_um` from measured point to measured point are
    /// refused; one missing point is bridged always.
    ///
    /// # Errors
    /// A longer hole, or fewer than ten measured points.
    pub fn bridged(&self, longest_um: f64) -> Result<Bridged, TextureError> {
        let measured: Vec<usize> = (0..self.heights_um.len()).filter(|&i| !self.heights_um[i].is_nan()).collect();
        let (&[first, .., last], FEWEST..) = (measured.as_slice(), measured.len()) else {
            return Err(TextureError::HardlyMeasured { points: measured.len(), fewest: FEWEST });
        };
        let mut line = Bridged {
            heights_um: self.heights_um[first..=last].to_vec(),
            points: 0,
            holes: 0,
            longest_um: 0.0,
            cut_off: self.heights_um.len() - (last + 1 - first),
        };
        for pair in measured.windows(2).filter(|pair| pair[1] - pair[0] > 1) {
            let (before, after) = (pair[0], pair[1]);
            let length_um = self.spacing_um * (after - before) as f64;
            if after - before > 2 && length_um > longest_um * (1.0 + 1e-9) {
                let (points, start_um) = (after - before - 1, self.spacing_um * before as f64);
                return Err(TextureError::LongHole { points, length_um, start_um, longest_um });
            }
            let (low, high) = (self.heights_um[before], self.heights_um[after]);
            for i in before + 1..after {
                let part = (i - before) as f64 / (after - before) as f64;
                line.heights_um[i - first] = low + part * (high - low);
            }
            line.points += after - before - 1;
            line.holes += 1;
            line.longest_um = line.longest_um.max(length_um);
        }
        Ok(line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_are_bridged_as_far_as_they_may_and_counted() {
        let mut heights: Vec<f64> = (0..20).map(f64::from).collect();
        for i in [0, 1, 5, 9, 10, 11, 19] {
            heights[i] = f64::NAN;
        }
        let trace = ProfileTrace::new(heights, 2.0).expect("a line");
        let line = trace.bridged(8.0).expect("bridged");
        assert_eq!(line.heights_um, (2..19).map(f64::from).collect::<Vec<_>>());
        assert_eq!((line.points, line.holes, line.longest_um, line.cut_off), (4, 2, 8.0, 3));
        let refused = trace.bridged(7.9).expect_err("too long");
        assert!(refused.to_string().contains("3 points, 8.0000 um long, 16.0000 um from its start"), "{refused}");
        let single =
            ProfileTrace::new((0..12).map(|i| if i == 4 { f64::NAN } else { 1.0 }).collect(), 2.0).expect("a line");
        assert_eq!(single.bridged(0.0).expect("one missing point is bridged always").points, 1);
    }

    #[test]
    fn lines_are_checked() {
        assert!(ProfileTrace::new(vec![0.0; 9], 1.0).expect_err("short").to_string().contains("9 points"));
        assert!(ProfileTrace::new(vec![0.0; 20], 0.0).expect_err("spacing").to_string().contains("spacing"));
        assert!(ProfileTrace::new(vec![2e6; 20], 1.0).expect_err("too high").to_string().contains("point 1"));
        let empty = ProfileTrace::new(vec![f64::NAN; 20], 1.0).expect("holes alone");
        assert!(empty.bridged(100.0).expect_err("nothing measured").to_string().contains("only 0 points"));
    }
}
