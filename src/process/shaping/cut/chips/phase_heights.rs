//! Heights over the rays of a column, at the phases of a stroke where passes are looked at.

use gearcut_core::passes::planar::near::MAX_PHASES;

/// Heights over a column's rays at the phases where passes are looked at, mm: between these they follow a parabola. All
/// three are equal where strokes are frozen.
///
/// Where a guide leads the cutter aside, or the feed goes on, all passes come to other heights at other phases, and
/// alike: compared phase by phase a few dozen nanometres tell them apart, where their heights anywhere on the column
/// overlap by micrometres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PhaseHeights(pub [f64; MAX_PHASES]);

impl PhaseHeights {
    /// The same height at every phase.
    pub fn even(height_mm: f64) -> Self {
        Self([height_mm; MAX_PHASES])
    }

    /// Whether it is as high as another or higher at every phase.
    pub fn covers(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).all(|(own, other)| own >= other)
    }

    /// Whether it comes as low as another at any phase. Bounds hold between phases as well: what they are widened by
    /// holds how far parabolas dip there.
    pub fn reaches(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).any(|(own, other)| own <= other)
    }

    /// The same, higher by so much.
    pub fn raised(self, by_mm: f64) -> Self {
        Self(self.0.map(|height_mm| height_mm + by_mm))
    }

    /// The highest of its heights at the phases.
    pub fn highest_mm(&self) -> f64 {
        self.0.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether it lies lower than another in the mean.
    pub fn is_lower(&self, other: &Self) -> bool {
        self.0.iter().sum::<f64>() < other.0.iter().sum::<f64>()
    }

    /// Height at a phase.
    pub fn at_mm(&self, tau: f64) -> f64 {
        let [before, middle, after] = self.0;
        middle + 0.5 * tau * (after - before + tau * (before - 2.0 * middle + after))
    }
}
