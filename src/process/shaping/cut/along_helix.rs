//! Fields of helical gears: rows cut in bands, each with the poses that the guide gives the cutter there.
//!
//! In: the rays of a part of the gear in the middle of the face. Out: what all operations leave on them, row by row. On
//! a round gear a row's rays, turned back with its section, are those of the middle; so rows are cut together, with the
//! poses turned back along them. Elsewhere every row has rays of its own.
//!
//! Candidates are those of the planar kernels: a band is a short field whose cutter moves.

use crate::process::shaping::ShapingJob;
use crate::process::shaping::helix::Helix;
use crate::process::shaping::sections::GearPart;
use crate::steps::planar::{CutField, PlanarGear, PlanarOperation};
use gearcut_core::cut::{Backend, CutStats};
use gearcut_core::dexel::{Field, Layer, NO_PASS};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::frame::Rigid2;
use gearcut_core::passes::StrokeSet;
use gearcut_core::passes::planar::strokes::StrokeLaw;
use gearcut_core::terms::Side;
use glam::DVec2;

/// Rays of a band of rows, and the strokes of every operation over it.
#[derive(Debug)]
pub struct HelixBand {
    /// Rays, their rows counted from the middle of the band.
    pub field: Field,
    /// Strokes, operation by operation.
    pub strokes: Vec<StrokeSet>,
}

impl ShapingJob {
    /// The bands of a field.
    ///
    /// # Errors
    /// A section in which the cutter generates no flank.
    pub fn bands<'a>(
        &'a self,
        helix: &'a Helix,
        part: GearPart,
        field: &'a Field,
    ) -> impl Iterator<Item = Result<HelixBand>> + 'a {
        let bands = helix.bands(&field.rows_z_mm, self.planar().rests());
        bands.into_iter().map(move |rows| {
            let rows_z_mm = &field.rows_z_mm[rows];
            if let [z_mm] = *rows_z_mm {
                let field = Field { columns: self.columns_in_section(part, field, z_mm)?, rows_z_mm: vec![0.0] };
                let strokes = self.operations.iter().map(|operation| self.strokes_in_section(operation, z_mm));
                return Ok(HelixBand { field, strokes: strokes.collect() });
            }
            let [from_mm, to_mm] = [rows_z_mm[0], rows_z_mm[rows_z_mm.len() - 1]];
            let middle_mm = 0.5 * (from_mm + to_mm);
            let law = StrokeLaw::Guided { half_face_mm: 0.5 * (to_mm - from_mm) };
            let strokes = self.operations.iter().map(|operation| {
                let set = &operation.strokes;
                StrokeSet::along_guide(set.first_pass, &self.cutter, law, set.count(), |stroke, beside_mm| {
                    let z_mm = middle_mm + beside_mm;
                    let turn_rad = helix.turn_rad(z_mm).unwrap_or_default();
                    Rigid2::new(-turn_rad, DVec2::ZERO).after(&self.pose_in_section(operation, stroke as usize, z_mm))
                })
            });
            let rows_z_mm = rows_z_mm.iter().map(|z_mm| z_mm - middle_mm).collect();
            Ok(HelixBand { field: Field { columns: field.columns.clone(), rows_z_mm }, strokes: strokes.collect() })
        })
    }

    /// How much more strokes leave on a flank of a leaning gear than in the poses that they have, in the section, mm,
    /// row by row of each column. A pose is that of the height at which the ram passes the stroke's pitch point; the
    /// contact beside it, on the normal through it, is passed at another one.
    fn beside_pitch_points_mm(
        &self,
        helix: &Helix,
        (tooth, side): (u32, Side),
        field: &Field,
    ) -> Result<Vec<f64>, Refusal> {
        let (actual, rows) = (&self.finishing().actual, field.rows());
        let mut more_mm = vec![0.0; field.columns.len() * rows];
        for (row, &z_mm) in field.rows_z_mm.iter().enumerate() {
            let flank = self.flank_in_section(tooth, side, z_mm)?;
            for (column, of) in field.columns.iter().enumerate() {
                let place = flank.at_arc(of.arc_mm);
                let pitch_point_mm = self.curve.frame(place.phi_rad).point_mm;
                let [there_mm, posed_mm] =
                    [place.point_mm, pitch_point_mm].map(|point_mm| actual.ram_height_mm(point_mm.extend(z_mm)));
                more_mm[column * rows + row] = helix.climb(side) * (there_mm - posed_mm);
            }
        }
        Ok(more_mm)
    }

    /// Planar steps over the strokes of a band.
    pub fn planar_of<'a>(&'a self, strokes: &'a [StrokeSet]) -> PlanarGear<'a> {
        let operations = self.operations.iter().zip(strokes);
        PlanarGear {
            operations: operations.map(|(of, strokes)| PlanarOperation { name: &of.spec.name, strokes }).collect(),
            ..self.planar()
        }
    }

    /// Runs all operations over a field.
    ///
    /// # Errors
    /// A section in which the cutter generates no flank; the backend's.
    pub(super) fn cut_along_helix(
        &self,
        backend: &dyn Backend,
        helix: &Helix,
        part: GearPart,
        mut field: Field,
    ) -> Result<CutField> {
        let mut stats = CutStats::default();
        let mut bands: Vec<(usize, Vec<Layer>)> = Vec::new();
        for band in self.bands(helix, part, &field) {
            let HelixBand { field, strokes } = band?;
            let cut = self.planar_of(&strokes).cut_rows(backend, &field)?;
            stats += cut.stats;
            bands.push((field.rows(), cut.layers));
        }
        let mut layers = beside_each_other(&bands, field.columns.len(), self.operations.len());
        if let GearPart::Flank(tooth, side) = part {
            if self.finishing().actual.leans() {
                let beside_mm = self.beside_pitch_points_mm(helix, (tooth, side), &field)?;
                for layer in &mut layers {
                    add_to_cut(layer, &field, &beside_mm);
                }
            }
            let along_normal = helix.cos_base_helix();
            for height_mm in layers.iter_mut().flat_map(|layer| &mut layer.heights_mm) {
                *height_mm = (f64::from(*height_mm) * along_normal) as f32;
            }
            for column in &mut field.columns {
                column.low_mm *= along_normal;
                column.blank_mm *= along_normal;
            }
        }
        Ok(CutField { field, layers, figures: None, stats })
    }
}

/// Adds to the heights of dexels that passes have reached and that are no deeper than their rays record.
fn add_to_cut(layer: &mut Layer, field: &Field, more_mm: &[f64]) {
    let of_dexels = layer.heights_mm.iter_mut().zip(&layer.passes).zip(more_mm);
    for (dexel, ((height_mm, &pass), more_mm)) in of_dexels.enumerate() {
        let low_mm = field.columns[dexel / field.rows()].low_mm;
        if pass != NO_PASS && f64::from(*height_mm) > low_mm {
            *height_mm = (f64::from(*height_mm) + more_mm) as f32;
        }
    }
}

/// Layers of all rows from those of bands.
pub(super) fn beside_each_other(bands: &[(usize, Vec<Layer>)], columns: usize, operations: usize) -> Vec<Layer> {
    let of = |operation: usize| {
        let (mut heights_mm, mut passes) = (Vec::new(), Vec::new());
        for column in 0..columns {
            for (rows, layers) in bands {
                let own = column * rows..(column + 1) * rows;
                heights_mm.extend_from_slice(&layers[operation].heights_mm[own.clone()]);
                passes.extend_from_slice(&layers[operation].passes[own]);
            }
        }
        Layer { heights_mm, passes }
    };
    (0..operations).map(of).collect()
}
