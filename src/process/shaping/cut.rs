//! What all operations leave on a field of rays: the lowest of all passes, or what rounded edges make of them; on
//! flanks, what a built-up edge tears out of that.
//!
//! In: a job and a field on a flank, a root or a tip. Out: its layers. With sharp edges the order of passes does not
//! matter, and the backend's kernels find the lowest one. Rounded edges ask for the order: they are followed here in
//! f64, whatever the backend. The whole blank is cut by the kernels alone.

mod along_helix;
pub mod blank;
pub mod chips;
pub mod section;
pub(super) mod stroke_noise;
mod tearing;

use super::ShapingJob;
use super::cut::along_helix::beside_each_other;
use super::sections::GearPart;
use crate::process::shaping::cut::chips::ploughed_layers;
use crate::steps::planar::{CutField, PreparedField};
use gearcut_core::cut::{Backend, CutStats};
use gearcut_core::dexel::figures::LinesAt;
use gearcut_core::dexel::{Field, Layer};
use gearcut_core::error::Result;

impl ShapingJob {
    /// Runs all operations over a field.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut(&self, backend: &dyn Backend, field: Field) -> Result<CutField> {
        let rows_z_mm = field.rows_z_mm.clone();
        Ok(self.prepare(backend, field, None)?.cut(backend)?.over_rows(rows_z_mm))
    }

    /// Runs all operations over a field on a part of the gear, the marks of a built-up edge on flanks included.
    ///
    /// # Errors
    /// The backend's; a section in which the cutter generates no flank.
    pub fn cut_on(&self, backend: &dyn Backend, part: GearPart, field: Field) -> Result<CutField> {
        let rows_z_mm = field.rows_z_mm.clone();
        Ok(self.prepare_on(backend, part, field, None)?.cut(backend)?.over_rows(rows_z_mm))
    }

    /// Makes a field on a part of the gear ready as [`Self::prepare`] does.
    ///
    /// # Errors
    /// As for [`Self::cut_on`].
    pub(super) fn prepare_on(
        &self,
        backend: &dyn Backend,
        part: GearPart,
        field: Field,
        lines: Option<LinesAt>,
    ) -> Result<PreparedField> {
        if let Some(helix) = &self.helix {
            return self.cut_along_helix(backend, helix, part, field).map(PreparedField::Cut);
        }
        let (Some(edge), GearPart::Flank(tooth, side)) = (&self.cutter_spec.built_up_edge, part) else {
            return self.prepare(backend, field, lines);
        };
        let mut cut = self.cut(backend, field)?;
        self.tear(edge, (tooth, side), &mut cut);
        Ok(PreparedField::Cut(cut))
    }

    /// Cuts every row of a field as its section is cut: a cutter that vibrates is elsewhere in each.
    fn cut_in_rows(&self, backend: &dyn Backend, field: Field) -> Result<CutField> {
        let mut stats = CutStats::default();
        let mut rows: Vec<(usize, Vec<Layer>)> = Vec::with_capacity(field.rows());
        for &z_mm in &field.rows_z_mm {
            let row = Field { columns: field.columns.clone(), rows_z_mm: vec![z_mm] };
            let cut = self.of_section(z_mm).cut(backend, row)?;
            stats += cut.stats;
            rows.push((1, cut.layers));
        }
        let layers = beside_each_other(&rows, field.columns.len(), self.operations.len());
        Ok(CutField { field, layers, figures: None, stats })
    }

    /// Makes those rows of a field ready that differ, or all of them; where `lines` are given, figures of the columns
    /// and these lines are enough.
    ///
    /// # Errors
    /// The backend's.
    pub fn prepare(&self, backend: &dyn Backend, field: Field, lines: Option<LinesAt>) -> Result<PreparedField> {
        if self.vibrates() {
            return self.cut_in_rows(backend, field).map(PreparedField::Cut);
        }
        match &self.cutter_spec.edge_rounding {
            None => self.planar().prepare(backend, field, lines),
            Some(rounding) => {
                let (layers, stats) = ploughed_layers(self, &field, rounding);
                Ok(PreparedField::Cut(CutField { field, layers, figures: None, stats }))
            }
        }
    }
}
