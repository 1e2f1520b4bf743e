//! An element of the cutter's edge and the force that its chip puts on it.
//!
//! In: the chip's thickness h. Out: the force along the normal f(h) = k h + e r(h), its rate and its integral; k and e
//! are the element's chip and edge coefficients (K_n b, K_ne b), r rises evenly from 0 at h = 0 to 1 at the least chip
//! that counts.

use gearcut_core::cut::LEAST_CHIP_MM;
use glam::DVec4;

/// An element of the edge in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeElement {
    /// Thickness of its chip at the displacement where it was looked at, mm.
    pub thickness_mm: f64,
    /// How far each coordinate moves it into the material along its normal.
    pub moves: DVec4,
    /// Force along the normal per thickness: K_n b, N/mm.
    pub chip_n_per_mm: f64,
    /// Force along the normal of an edge that cuts: K_ne b, N.
    pub edge_n: f64,
}

impl EdgeElement {
    /// Force along the normal, its rate by thickness, its integral: N, N/mm, N mm.
    pub(super) fn force(&self, h_mm: f64) -> [f64; 3] {
        if h_mm <= 0.0 {
            return [0.0; 3];
        }
        let (k, e) = (self.chip_n_per_mm, self.edge_n);
        let chip = [k * h_mm, k, 0.5 * k * h_mm * h_mm];
        let share = h_mm / LEAST_CHIP_MM;
        let edge = if share < 1.0 {
            [e * share, e / LEAST_CHIP_MM, 0.5 * e * share * h_mm]
        } else {
            [e, 0.0, e * (h_mm - 0.5 * LEAST_CHIP_MM)]
        };
        [chip[0] + edge[0], chip[1] + edge[1], chip[2] + edge[2]]
    }

    /// Least rate of the force by thickness, N/mm: outside the material, along a chip, while the edge begins to cut.
    pub(super) fn least_rate(&self) -> f64 {
        let chip = self.chip_n_per_mm;
        chip.min(chip + self.edge_n / LEAST_CHIP_MM).min(0.0)
    }
}
