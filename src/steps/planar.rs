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
use gearcut_core::cut::{Backend, CutLayers, CutStats, PlannedField, cut_alone, cut_in_turn};
use gearcut_core::dexel::figures::{FieldColumns, FieldFigures, LinesAt};
use gearcut_core::dexel::{Column, Field, Layer};
use gearcut_core::error::Result;
use gearcut_core::gear::blank::Blank;
use gearcut_core::passes::planar::strokes::StrokeLaw;
use gearcut_core::passes::{CutPlan, StrokeSet};
use gearcut_core::tool::PlanarTool;
use glam::DVec2;

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
    /// What each operation left, in order; empty where figures of the columns were enough.
    pub layers: Vec<Layer>,
    /// Those figures.
    pub figures: Option<FieldFigures>,
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

    /// Columns as figures ask for them. Where a device has made figures, the lines are those that it was asked for.
    pub fn columns(&self, lines: LinesAt) -> FieldColumns<'_> {
        match &self.figures {
            Some(figures) => FieldColumns::Figures(figures),
            None => FieldColumns::Dexels { field: &self.field, layers: &self.layers, lines },
        }
    }
}

/// A field on its way to the backend.
pub enum PreparedField {
    /// With the plans that run over it.
    Planned(PlannedField),
    /// Cut already, since its plans alone do not say what is left.
    Cut(CutField),
}

impl PreparedField {
    /// Cuts it.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut(self, backend: &dyn Backend) -> Result<CutField> {
        match self {
            Self::Planned(planned) => Ok(with_left(cut_alone(backend, &planned)?, planned)),
            Self::Cut(cut) => Ok(cut),
        }
    }
}

fn with_left(left: CutLayers, planned: PlannedField) -> CutField {
    CutField { field: planned.field, layers: left.layers, figures: left.figures, stats: left.stats }
}

/// Cuts so many fields, several at once: `make` gives the field of an index (`None`: it is left out), `take` gets it
/// when it is cut.
///
/// # Errors
/// The backend's, those of `make` and `take`.
pub fn cut_fields(
    backend: &dyn Backend,
    count: usize,
    make: impl Fn(usize) -> Result<Option<PreparedField>> + Sync,
    take: impl Fn(usize, CutField) -> Result<()> + Sync,
) -> Result<()> {
    let planned = |index| match make(index)? {
        Some(PreparedField::Planned(planned)) => Ok(Some(planned)),
        Some(PreparedField::Cut(cut)) => take(index, cut).map(|()| None),
        None => Ok(None),
    };
    backend.cut_fields(count, &planned, &|index, planned, left| take(index, with_left(left, planned)))
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
        Field { columns, rows_z_mm: self.root_rows_z_mm() }
    }

    /// Rows of [`Self::root_field`].
    pub fn root_rows_z_mm(&self) -> Vec<f64> {
        self.rows_z_mm(self.scene.fields.lead_spacing_mm.max(ROOT_SPACING_MM[1]))
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
        let columns = self.tip_columns(feet_rad, count as usize);
        Some(Field { columns, rows_z_mm: self.rows_z_mm(TIP_SPACING_MM[1]) })
    }

    /// So many rays over a tip land.
    pub fn tip_columns(&self, feet_rad: [f64; 2], count: usize) -> Vec<Column> {
        let curve = self.blank.curve();
        let [from_mm, to_mm] = feet_rad.map(|phi| curve.arc_mm(phi));
        let column = |i: usize| {
            let arc_mm = (to_mm - from_mm) * (i as f64 + 0.5) / count as f64;
            let phi_rad = curve.phi_at_arc(from_mm + arc_mm);
            let frame = curve.frame(phi_rad);
            let normal = self.blank.towards_tip(&frame);
            let point = ProfilePoint { arc_mm, point_mm: frame.point_mm, normal, phi_rad };
            self.column(&point, self.blank.addendum_mm)
        };
        (0..count).map(column).collect()
    }

    /// Whether every row of a field is cut alike: the tool stands still while it is in the work, so its pose is the
    /// same at all places along the tooth, and no helical guide turns it.
    pub fn rows_are_alike(&self) -> bool {
        self.scene.gear.helix_angle_rad == 0.0
            && self.operations.iter().all(|operation| operation.strokes.law == StrokeLaw::Frozen)
    }

    /// Whether the axes rest while the tool is in the work.
    pub fn rests(&self) -> bool {
        self.operations.iter().all(|operation| operation.strokes.law.rests())
    }

    /// Makes those rows of a field ready that differ: the first one where all are alike, since every height and pass id
    /// is what cutting each of them would give. [`CutField::over_rows`] has them all. While the axes rest, rows that
    /// differ follow from a few of them ([`rows_between`]), which are cut here. Where `lines` are given, figures of the
    /// columns and these lines are enough.
    ///
    /// # Errors
    /// The backend's.
    pub fn prepare(&self, backend: &dyn Backend, mut field: Field, lines: Option<LinesAt>) -> Result<PreparedField> {
        if self.rows_are_alike() {
            field.rows_z_mm.truncate(1);
        } else if self.rests() {
            return self.cut_resting(backend, field).map(PreparedField::Cut);
        }
        let plans = self.plans(&field);
        self.prepare_planned(backend, PlannedField { field, plans, lines })
    }

    /// Runs all operations over every row of a field.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_rows(&self, backend: &dyn Backend, field: &Field) -> Result<CutField> {
        let planned = PlannedField { field: field.clone(), plans: self.plans(field), lines: None };
        self.prepare_planned(backend, planned)?.cut(backend)
    }

    /// The passes that every operation visits on a field.
    fn plans(&self, field: &Field) -> Vec<CutPlan> {
        self.operations.iter().map(|operation| CutPlan::new(field, operation.strokes, self.tool)).collect()
    }

    /// A planned field as it is; cut already, if strokes cover some of its rays as a whole: these go to their lowest
    /// before the next operation. Such rays are rare.
    fn prepare_planned(&self, backend: &dyn Backend, planned: PlannedField) -> Result<PreparedField> {
        let covered: Vec<_> =
            self.operations.iter().map(|of| covered::columns(&planned.field, of.strokes, self.tool)).collect();
        if covered.iter().all(Vec::is_empty) {
            return Ok(PreparedField::Planned(planned));
        }
        let lower = |operation: usize, layer: &mut Layer| covered::lower(&planned.field, &covered[operation], layer);
        let left = cut_in_turn(backend, &planned, lower)?;
        Ok(PreparedField::Cut(with_left(left, planned)))
    }
}
