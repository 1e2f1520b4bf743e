//! What all operations leave on a field of rays: the lowest of all passes, or what rounded edges make of them; on
//! flanks, what a built-up edge tears out of that.
//!
//! In: a job and a field on a flank, a root or a tip. Out: its layers. With sharp edges the order of passes does not
//! matter, and the backend's kernels find the lowest one. Rounded edges ask for the order: they are followed here in
//! f64, whatever the backend. The whole blank is cut by the kernels alone.

use super::ShapingJob;
use super::chips::ploughed_layers;
use crate::steps::planar::CutField;
use gearcut_core::cut::Backend;
use gearcut_core::dexel::Field;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use rayon::prelude::*;

impl ShapingJob {
    /// Runs all operations over a field.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut(&self, backend: &dyn Backend, field: Field) -> Result<CutField> {
        let rows_z_mm = field.rows_z_mm.clone();
        Ok(self.cut_distinct_rows(backend, field)?.over_rows(rows_z_mm))
    }

    /// Runs all operations over some fields, all of them as one job of the backend.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_fields(&self, backend: &dyn Backend, fields: Vec<Field>) -> Result<Vec<CutField>> {
        if self.cutter_spec.edge_rounding.is_some() {
            return fields.into_par_iter().map(|field| self.cut(backend, field)).collect();
        }
        let rows_z_mm: Vec<Vec<f64>> = fields.iter().map(|field| field.rows_z_mm.clone()).collect();
        let cut = self.planar().cut_fields(backend, fields)?;
        Ok(cut.into_iter().zip(rows_z_mm).map(|(cut, rows_z_mm)| cut.over_rows(rows_z_mm)).collect())
    }

    /// The same over those rows alone that differ, or over all of them.
    fn cut_distinct_rows(&self, backend: &dyn Backend, field: Field) -> Result<CutField> {
        match &self.cutter_spec.edge_rounding {
            None => self.planar().cut_distinct_rows(backend, field),
            Some(rounding) => {
                let (layers, stats) = ploughed_layers(self, &field, rounding);
                Ok(CutField { field, layers, stats })
            }
        }
    }

    /// Runs all operations over a field on a flank of a tooth (1 to z), the marks of a built-up edge included.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_on_flank(&self, backend: &dyn Backend, flank: (u32, Side), field: Field) -> Result<CutField> {
        let rows_z_mm = field.rows_z_mm.clone();
        Ok(self.cut_distinct_rows_on_flank(backend, flank, field)?.over_rows(rows_z_mm))
    }

    /// The same over those rows alone that differ, or over all of them.
    ///
    /// # Errors
    /// The backend's.
    pub(super) fn cut_distinct_rows_on_flank(
        &self,
        backend: &dyn Backend,
        flank: (u32, Side),
        field: Field,
    ) -> Result<CutField> {
        let Some(edge) = &self.cutter_spec.built_up_edge else { return self.cut_distinct_rows(backend, field) };
        let mut cut = self.cut(backend, field)?;
        self.tear(edge, flank, &mut cut);
        Ok(cut)
    }
}
