//! The lowest surface that is certain so far on a tile: what a pass must undercut to matter.
//!
//! In each cell between two places it is **one** pass with its error, not the lowest of several corner by corner:
//! between two corners that belong to different passes both may lie high, and a third may be lowest there.

use super::near::MAX_PHASES;
use super::samples::{MAX_PLACES, PassSamples};
use arrayvec::ArrayVec;

/// Heights at the sample rays of a tile above which a pass is undercut in every cell.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundHeights {
    /// Place by place, and phase by phase where phases are told apart, mm.
    pub heights_mm: ArrayVec<f64, { MAX_PLACES * MAX_PHASES }>,
    /// Largest climb of a dominating pass across a cell, mm.
    pub climb_mm: f64,
}

/// Upper bound of the surface that is left on a tile, by the dominating pass of each cell.
#[derive(Debug)]
pub struct UpperBound {
    /// Cell by cell: its two places, phase by phase.
    cells: Vec<ArrayVec<f64, { 2 * MAX_PHASES }>>,
    phases: usize,
    /// No dexel of the tile ends up higher than this, mm.
    pub highest_mm: f64,
    /// For passes looked at phase by phase.
    pub by_phase: BoundHeights,
    /// For looks that stand for all phases.
    pub all_phases: BoundHeights,
}

impl UpperBound {
    /// The blank, nowhere higher than `highest_mm`, over so many cells and phases.
    pub fn new(cells: usize, phases: usize, highest_mm: f64) -> Self {
        let cell: ArrayVec<f64, { 2 * MAX_PHASES }> = std::iter::repeat_n(highest_mm, 2 * phases).collect();
        let level =
            |count: usize| BoundHeights { heights_mm: std::iter::repeat_n(highest_mm, count).collect(), climb_mm: 0.0 };
        Self {
            cells: vec![cell; cells],
            phases,
            highest_mm,
            by_phase: level((cells + 1) * phases),
            all_phases: level(cells + 1),
        }
    }

    /// Takes a pass into account that enters its segment everywhere on the tile ([`PassSamples::certain`]).
    pub fn lower(&mut self, samples: &PassSamples) {
        let Self { phases, .. } = *self;
        self.highest_mm = self.highest_mm.min(highest(&samples.heights_mm) + samples.error_mm);
        let mut lowered = false;
        for (cell, dominating) in self.cells.iter_mut().enumerate() {
            let corners = &samples.heights_mm[cell * phases..(cell + 2) * phases];
            if highest(corners) + samples.error_mm < highest(dominating) {
                *dominating = corners.iter().map(|height| height + samples.error_mm).collect();
                lowered = true;
            }
        }
        if !lowered {
            return;
        }
        let corner = |cell: Option<usize>, end: usize, phase: usize| {
            cell.and_then(|cell| self.cells.get(cell))
                .map_or(f64::NEG_INFINITY, |dominating| dominating[end * phases + phase])
        };
        let at = |place: usize, phase: usize| corner(Some(place), 0, phase).max(corner(place.checked_sub(1), 1, phase));
        let places = self.cells.len() + 1;
        let climb = |dominating: &ArrayVec<f64, { 2 * MAX_PHASES }>| {
            (0..phases).map(|phase| (dominating[phases + phase] - dominating[phase]).abs()).fold(0.0, f64::max)
        };
        let climb_mm = self.cells.iter().map(climb).fold(0.0, f64::max);
        let heights_mm: ArrayVec<f64, { MAX_PLACES * MAX_PHASES }> =
            (0..places).flat_map(|place| (0..phases).map(move |phase| (place, phase))).map(|(p, t)| at(p, t)).collect();
        self.all_phases = BoundHeights { heights_mm: heights_mm.chunks(phases).map(highest).collect(), climb_mm };
        self.by_phase = BoundHeights { heights_mm, climb_mm };
    }
}

fn highest(heights_mm: &[f64]) -> f64 {
    heights_mm.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pass(heights_mm: &[f64]) -> PassSamples {
        PassSamples {
            pass: 0,
            segment: 0,
            heights_mm: heights_mm.iter().copied().collect(),
            error_mm: 0.5,
            certain: true,
        }
    }

    #[test]
    fn a_cell_is_bounded_by_one_pass() {
        let mut upper = UpperBound::new(2, 1, 100.0);
        upper.lower(&pass(&[0.0, 10.0, 20.0]));
        upper.lower(&pass(&[20.0, 10.0, 0.0]));
        // The lowest corner by corner would be 0, 10, 0: no pass is that low on both sides of a cell.
        assert_eq!(upper.by_phase.heights_mm[..], [0.5, 10.5, 0.5]);
        upper.lower(&pass(&[9.0, 9.0, 30.0]));
        assert_eq!(
            upper.by_phase.heights_mm[..],
            [9.5, 10.5, 0.5],
            "the first cell is dominated by a pass whose highest corner is lower"
        );
        assert_eq!(upper.highest_mm, 20.5);
        assert_eq!(upper.by_phase.climb_mm, 10.0);
    }

    #[test]
    fn a_look_at_all_phases_takes_the_highest() {
        let mut upper = UpperBound::new(1, 3, 100.0);
        upper.lower(&pass(&[1.0, 2.0, 3.0, 6.0, 5.0, 4.0]));
        assert_eq!(upper.all_phases.heights_mm[..], [3.5, 6.5]);
    }
}
