//! Everything measured on one hobbed flank after all operations.
//!
//! In: the cut flank. Out: [`HobbedReport`]: where the flank begins, normal deviations on the evaluated part,
//! stock of earlier operations, profile and helix deviations.
//!
//! The evaluated part of the profile is the scene's `[measure]`: between two heights over the pitch curve, in the
//! middle of the face. Where it names none, and along the face, a twentieth is left out at both ends. Profile
//! deviations are those of the middle row, helix deviations those of the middle column (ISO 1328-1:2013: F_alpha and
//! F_beta total, f_H slope, f_f form), along the target's local normals in space: on a gear that is not round the
//! target takes the place of the design helix, and on a helical gear the standard's figures in the transverse section
//! are these over cos(beta_b). Profiles stand over the roll, as the standard's do: over the place of the contact on the
//! line of action.

use crate::measure::cut_grid::CutGrid;
use crate::measure::inspection::{FlankSurface, InspectedFlank, StockRange, SurfaceHeights};
use crate::measure::stock::Extreme;
use crate::process::hobbing::HobbedFlank;
use gearcut_core::terms::Side;

/// One hobbed flank, measured: profiles stand over the place on the line of action
/// ([`crate::process::hobbing::flank_patch::FlankPatch::roll_mm`]), the line along the tooth runs in the
/// middle of the profile, and dexels of the evaluated part count as untouched. (On the tip's own edge the blank ends
/// where the target does.)
pub type HobbedReport = InspectedFlank<HobbedSurface>;

/// What is measured on hobbed flanks alone.
#[derive(Debug, Clone, PartialEq)]
pub struct HobbedSurface {
    /// Where the field begins: height over the pitch curve of the highest start of the involute in any section, mm.
    pub form_height_mm: f64,
    /// Whether the hob's tip corner has undercut the flank in any section.
    pub undercut: bool,
    /// Normal deviations of the finished surface; `None` where a dexel of the evaluated part was not reached.
    pub finished: Option<SurfaceHeights>,
    /// What each earlier operation left over the finished surface.
    pub stock: Vec<Option<SurfaceHeights>>,
}

impl FlankSurface for HobbedSurface {
    fn deviations(&self) -> Option<[Extreme; 2]> {
        self.finished.map(|of| of.ends)
    }

    fn stock(&self, operation: usize) -> Option<StockRange> {
        (*self.stock.get(operation)?).map(|of| of.stock())
    }
}

/// Measures a cut flank.
pub fn measure(tooth: u32, side: Side, flank: &HobbedFlank) -> HobbedReport {
    let (arcs_mm, rows_mm) = (&flank.rays.arcs_mm, &flank.rays.rows_z_mm);
    let grid = CutGrid {
        tooth,
        side,
        length_mm: flank.target.length_mm(),
        arcs_mm,
        rolls_mm: arcs_mm.iter().map(|&arc_mm| flank.target.roll_mm(arc_mm)).collect(),
        rows_mm,
        layers: &flank.layers,
        evaluated_mm: flank.evaluated_mm,
        evaluated_rolls_mm: flank.evaluated_mm[0].map(|arc_mm| flank.target.roll_mm(arc_mm)),
    };
    grid.inspected(HobbedSurface {
        form_height_mm: flank.target.form_height_mm,
        undercut: flank.target.undercut,
        finished: grid.finished(),
        stock: grid.stock(),
    })
}
