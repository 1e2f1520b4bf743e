//! A gear that is cut in transverse sections by the strokes of a planar tool: its rays on straight flanks, roots and
//! tips, and all operations over them.
//!
//! In: the scene, the blank, the tool, the strokes of every operation. Out: fields, and what every operation leaves on
//! them; in [`blank`], [`blank_report`] and [`blank_findings`] the same for rays through the whole blank. A process
//! whose tool cuts in planes gives points of its target ([`ProfilePoint`]); how it found them is its own.
//!
//! Fields are made one flank at a time, so that memory does not grow with the number of teeth.

pub mod blank;
pub mod blank_findings;
pub mod blank_report;
mod covered;
mod rows_between;

use crate::job::{RAY_DEPTH_MODULES, RAY_HEIGHT_MODULES, ROOT_SPACING_MM, TIP_SPACING_MM, rows_z_mm};
use crate::scene::Scene;
use gearcut_core::cut::{Backend, CutJob, CutLayers, CutStats};
use gearcut_core::dexel::{Column, Field, Layer};
use gearcut_core::error::Result;
use gearcut_core::gear::blank::Blank;
use gearcut_core::passes::planar::strokes::StrokeLaw;
use gearcut_core::passes::{CutPlan, StrokeSet};
use gearcut_core::tool::PlanarTool;
use glam::DVec2;
use rayon::prelude::*;

/// Rays of a fillet stay within this share of its radius: further out they would cross each other.
const FILLET_SHARE: f64 = 0.8;

/// A point of a target's profile with what its ray needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfilePoint {
    /// Arc length along the profile, mm.
    pub arc_mm: f64,
    /// Place in the transverse plane, gear frame, mm.
    pub point_mm: DVec2,
    /// Unit normal out of the gear.
    pub normal: DVec2,
    /// A polar angle near the foot of the point on the pitch curve, rad.
    pub phi_rad: f64,
}

/// One operation.
#[derive(Debug, Clone, Copy)]
pub struct PlanarOperation<'a> {
    /// Name in the scene.
    pub name: &'a str,
    /// Its strokes; pass ids go on from one operation to the next.
    pub strokes: &'a StrokeSet,
}

/// What all planar steps need to know.
#[derive(Clone)]
pub struct PlanarGear<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The stock.
    pub blank: &'a Blank,
    /// The tool of all operations.
    pub tool: &'a dyn PlanarTool,
    /// Operations in order; the last one finishes.
    pub operations: Vec<PlanarOperation<'a>>,
}

/// A field after all operations.
#[derive(Debug)]
pub struct CutField {
    /// Rays.
    pub field: Field,
    /// What each operation left, in order.
    pub layers: Vec<Layer>,
    /// What the backend met.
    pub stats: CutStats,
}

impl CutField {
    /// How many of so many rows each row stands for.
    pub fn copies(&self, rows_z_mm: &[f64]) -> usize {
        rows_z_mm.len() / self.field.rows()
    }

    /// With all of these rows, where one stands for them.
    #[must_use]
    pub fn over_rows(self, rows_z_mm: Vec<f64>) -> Self {
        let copies = self.copies(&rows_z_mm);
        if copies == 1 {
            return self;
        }
        let layers = self.layers.iter().map(|layer| layer.repeated(copies)).collect();
        Self { field: Field { rows_z_mm, ..self.field }, layers, ..self }
    }
}

impl PlanarGear<'_> {
    /// Places along a profile of this length with the scene's spacing, mm from its beginning.
    pub fn arcs_mm(&self, length_mm: f64) -> impl Iterator<Item = f64> + use<> {
        let spacing_mm = self.scene.fields.profile_spacing_mm;
        let count = (length_mm / spacing_mm).floor() as usize + 1;
        (0..count).map(move |i| i as f64 * spacing_mm)
    }

    /// Rows along the tooth: evenly over the face, both ends included.
    pub fn rows_z_mm(&self, spacing_mm: f64) -> Vec<f64> {
        rows_z_mm(self.scene.gear.face_width_mm, spacing_mm)
    }

    /// Rays on points of a target flank, `rows_z_mm` along the tooth.
    pub fn flank_field(&self, points: impl Iterator<Item = ProfilePoint>, rows_z_mm: Vec<f64>) -> Field {
        let limit_mm = RAY_HEIGHT_MODULES * self.scene.gear.module_mm;
        // Rays follow each other: where one leaves the blank, the next one leaves it nearby.
        let mut exit_mm = 0.0;
        let columns = points
            .map(|point| {
                exit_mm = self.blank.exit_mm(point.point_mm, point.normal, point.phi_rad, exit_mm, limit_mm);
                self.column(&point, exit_mm)
            })
            .collect();
        Field { columns, rows_z_mm }
    }

    /// Distance of the points of a root on which [`Self::root_field`] stands, mm.
    pub fn root_spacing_mm(&self) -> f64 {
        self.scene.fields.profile_spacing_mm.max(ROOT_SPACING_MM[0])
    }

    /// Rays on points of a target root, all of them.
    pub fn root_field(&self, points: &[ProfilePoint]) -> Field {
        let module_mm = self.scene.gear.module_mm;
        let columns = points
            .iter()
            .enumerate()
            .map(|(i, point)| {
                let (a, b) = (points[i.saturating_sub(1)], points[(i + 1).min(points.len() - 1)]);
                // Where normals converge (the fillet), rays end before they meet.
                let closing = -(b.normal - a.normal).dot((b.point_mm - a.point_mm).normalize_or_zero());
                let radius_mm = if closing > 0.0 { (b.arc_mm - a.arc_mm) / closing } else { f64::INFINITY };
                let limit_mm = (RAY_HEIGHT_MODULES * module_mm).min(FILLET_SHARE * radius_mm);
                self.column(point, self.blank.exit_mm(point.point_mm, point.normal, point.phi_rad, limit_mm, limit_mm))
            })
            .collect();
        Field { columns, rows_z_mm: self.rows_z_mm(self.scene.fields.lead_spacing_mm.max(ROOT_SPACING_MM[1])) }
    }

    fn column(&self, point: &ProfilePoint, blank_mm: f64) -> Column {
        Column {
            arc_mm: point.arc_mm,
            origin_mm: point.point_mm,
            normal: point.normal,
            low_mm: -RAY_DEPTH_MODULES * self.scene.gear.module_mm,
            blank_mm,
        }
    }

    /// Rays over a tip land, along the normals of the pitch curve and from it towards the tips, between the polar
    /// angles of the feet of both its ends; `None` where there is hardly any land. A ray that no pass reached says that
    /// the blank's own surface stands there; where a tool has cut the tips down, or a window left a tooth alone, it
    /// says that too.
    pub fn tip_field(&self, feet_rad: [f64; 2]) -> Option<Field> {
        let curve = self.blank.curve();
        let [from_mm, to_mm] = feet_rad.map(|phi| curve.arc_mm(phi));
        let count = ((to_mm - from_mm) / TIP_SPACING_MM[0]).floor();
        if count < 2.0 {
            return None;
        }
        let columns = (0..count as u32)
            .map(|i| {
                let arc_mm = (to_mm - from_mm) * (f64::from(i) + 0.5) / count;
                let phi_rad = curve.phi_at_arc(from_mm + arc_mm);
                let frame = curve.frame(phi_rad);
                let normal = self.blank.towards_tip(&frame);
                let point = ProfilePoint { arc_mm, point_mm: frame.point_mm, normal, phi_rad };
                self.column(&point, self.blank.addendum_mm)
            })
            .collect();
        Some(Field { columns, rows_z_mm: self.rows_z_mm(TIP_SPACING_MM[1]) })
    }

    /// Whether every row of a field is cut alike: the tool stands still while it is in the work, so its pose is the
    /// same at all places along the tooth.
    pub fn rows_are_alike(&self) -> bool {
        self.operations.iter().all(|operation| operation.strokes.law == StrokeLaw::Frozen)
    }

    /// Whether the axes rest while the tool is in the work.
    pub fn rests(&self) -> bool {
        self.operations.iter().all(|operation| operation.strokes.law.rests())
    }

    /// Runs all operations over those rows of a field that differ: over the first one where all are alike, since every
    /// height and pass id is what cutting each of them would give. [`CutField::over_rows`] has them all. While the axes
    /// rest, rows that differ follow from a few of them ([`rows_between`]).
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_distinct_rows(&self, backend: &dyn Backend, mut field: Field) -> Result<CutField> {
        if self.rows_are_alike() {
            field.rows_z_mm.truncate(1);
        }
        if self.rests() {
            return self.cut_resting(backend, field);
        }
        let (layers, stats) = self.cut_rows(backend, &field)?;
        Ok(CutField { field, layers, stats })
    }

    /// Runs all operations over every row of a field.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_rows(&self, backend: &dyn Backend, field: &Field) -> Result<(Vec<Layer>, CutStats)> {
        self.cut_planned(backend, field, &self.plans(field))
    }

    /// The passes that every operation visits on a field.
    fn plans(&self, field: &Field) -> Vec<CutPlan> {
        self.operations.iter().map(|operation| CutPlan::new(field, operation.strokes, self.tool)).collect()
    }

    /// Runs all operations over a field, each as its plan says.
    fn cut_planned(&self, backend: &dyn Backend, field: &Field, plans: &[CutPlan]) -> Result<(Vec<Layer>, CutStats)> {
        let cut = backend.cut_jobs(&[CutJob { field, start: None, plans }])?;
        self.covered(backend, field, plans, cut.into_iter().next().unwrap_or_default())
    }

    /// Layers as the kernels leave them, with the rays that strokes cover as a whole at their lowest. Such rays are
    /// rare; where there are any, what follows is cut again from there.
    fn covered(
        &self,
        backend: &dyn Backend,
        field: &Field,
        plans: &[CutPlan],
        cut: CutLayers,
    ) -> Result<(Vec<Layer>, CutStats)> {
        let mut layers: Vec<Layer> = Vec::with_capacity(self.operations.len());
        let mut stats = CutStats::default();
        let mut cut = cut.into_iter();
        while let Some((mut layer, met)) = cut.next() {
            stats += met;
            let is_lowered = covered::lower(field, self.operations[layers.len()].strokes, self.tool, &mut layer);
            layers.push(layer);
            let rest = &plans[layers.len()..];
            if is_lowered && !rest.is_empty() {
                let again = backend.cut_jobs(&[CutJob { field, start: layers.last(), plans: rest }])?;
                cut = again.into_iter().next().unwrap_or_default().into_iter();
            }
        }
        Ok((layers, stats))
    }

    /// Runs all operations over those rows of some fields that differ, as [`Self::cut_distinct_rows`], all fields as
    /// one job of the backend.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_fields(&self, backend: &dyn Backend, mut fields: Vec<Field>) -> Result<Vec<CutField>> {
        if self.rests() && !self.rows_are_alike() {
            // Most rows follow from a few, field by field.
            return fields.into_par_iter().map(|field| self.cut_distinct_rows(backend, field)).collect();
        }
        if self.rows_are_alike() {
            for field in &mut fields {
                field.rows_z_mm.truncate(1);
            }
        }
        let plans: Vec<Vec<CutPlan>> = fields.par_iter().map(|field| self.plans(field)).collect();
        let jobs: Vec<CutJob> =
            fields.iter().zip(&plans).map(|(field, plans)| CutJob { field, start: None, plans }).collect();
        let cut = backend.cut_jobs(&jobs)?;
        let cut: Vec<(Vec<Layer>, CutStats)> = (&fields, &plans, cut)
            .into_par_iter()
            .map(|(field, plans, cut)| self.covered(backend, field, plans, cut))
            .collect::<Result<_>>()?;
        let with = |(field, (layers, stats))| CutField { field, layers, stats };
        Ok(fields.into_iter().zip(cut).map(with).collect())
    }
}
