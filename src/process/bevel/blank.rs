//! The whole blank on rays: every slot's part of it, cut by the passes of all operations.
//!
//! In: a job, a backend. Out: [`CutCells`]: what is left on every ray after each operation, with the pass that left
//! it, and volumes.
//!
//! **Cells.** The blank is shared out to the slots: the cell of a slot reaches half a pitch to either side of the
//! slot's middle on the pitch cone, and leans with it along the face. Cells differ by a turn alone.
//!
//! **Rays.** Columns stand side by side round the axis, rows at cone distances from toe to heel. A ray begins on the
//! root cone and runs square to the pitch cone to the face cone; it has a share of the volume
//! dV = (rho + h cos gamma) dh dphi dR, where rho is the radius of its foot and h the height over that. Flanks lean by
//! the blades' angles against the rays, so that no ray grazes them. What the blank has below
//! [`RIM_MODULES`] under the roots is not counted: the scene does not say it.
//!
//! A ray keeps its **lowest** cut, as flanks do: material that hung over it, as on undercut teeth, is counted as gone.
//! The ledger of chips ([`super::chips`]) knows several pieces of material on a ray and says how much that is.
//!
//! Natively all passes that come near a row go over all its rays. Candidates, as flanks have them, leave the same on
//! what the tests compare, but planning a row costs more than they save the kernel, and their bounds are no proof. A
//! device takes the candidates of the whole cell: a record is composed in more time than a candidate is looked at, and
//! the cells of all slots go over in a few submissions.
//!
//! The road not taken: slices across the axis, as hobbing has them. Blades of a face-mill head move nearly along them.

use super::job::{BevelJob, index};
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use gearcut_core::bevel::clearance::HeadInSlot;
use gearcut_core::cut::{Backend, CutLayers, CutStats, SweptBy, SweptField};
use gearcut_core::dexel::{Layer, NO_PASS, Ray, SpatialField};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::terms::Side;
use gearcut_core::units::TURN_RAD;
use glam::{DMat3, DVec3};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::ops::Range;
use std::sync::OnceLock;

/// How far below the root cone rays record cuts and the body ends, in outer modules.
pub const RIM_MODULES: f64 = 1.0;
/// Memory that cells may take, bytes: as much as the blank fields of the other processes.
const MOST_BYTES: f64 = gearcut_core::dexel::blank_field::MOST_BYTES;
/// Bytes of a ray on each layer: height and pass.
const BYTES_PER_RAY: f64 = 8.0;

/// Where the rays of a slot's cell stand.
#[derive(Debug, Clone, PartialEq)]
pub struct CellGrid {
    /// Cone distances of the rows from the toe to the heel, both ends among them, mm.
    pub distances_mm: Vec<f64>,
    /// Polar angle of the slot's middle on every row, space 0, gear frame, rad.
    pub middles_rad: Vec<f64>,
    /// Number of columns: their strips fill a pitch.
    pub columns: usize,
    /// Lowest height that rays record, over the root cone, mm; negative.
    pub low_mm: f64,
    /// Angle of a column's strip, rad.
    pub strip_rad: f64,
}

/// Every slot's cell after each operation.
#[derive(Debug, Clone, PartialEq)]
pub struct CutCells {
    /// Where the rays stand.
    pub grid: CellGrid,
    /// Slot after slot, what the operations left.
    pub slots: Vec<Vec<Layer>>,
    /// Whether a slot next to one has left a place of its cell: teeth come to a point.
    pub neighbours_reach: bool,
    /// Volume of the uncut ring, mm3.
    pub blank_mm3: f64,
    /// Volume of the ring after every operation, mm3.
    pub left_mm3: Vec<f64>,
    /// Work done.
    pub stats: CutStats,
}

impl CellGrid {
    /// Rays at most so far apart round the axis, at the heel's pitch circle, and along the face, mm.
    ///
    /// # Errors
    /// A slot without a middle; more memory than is taken.
    pub fn new(job: &BevelJob, spacing_mm: f64, slice_spacing_mm: f64) -> Result<Self, Refusal> {
        let blank = &job.blank;
        let pitch_rad = TURN_RAD / f64::from(blank.teeth);
        let arc_mm = pitch_rad * blank.outer_cone_distance_mm * blank.pitch_angle_rad.sin();
        let columns = (arc_mm / spacing_mm).ceil().max(4.0);
        let intervals = (blank.face_width_mm / slice_spacing_mm).ceil().max(1.0);
        let layers = job.operations.len() as f64;
        let bytes = BYTES_PER_RAY * layers * columns * (intervals + 1.0) * f64::from(blank.teeth);
        if bytes > MOST_BYTES {
            return Err(Refusal::new(
                "fields.blank.spacing_mm",
                format!(
                    "rays {spacing_mm} mm apart in rows {slice_spacing_mm} mm apart need about {bytes:.2e} bytes; at \
                     most {MOST_BYTES:.0e} are taken"
                ),
                format!(
                    "use a spacing_mm of {:.3} or more, or a larger slice_spacing_mm",
                    spacing_mm * bytes / MOST_BYTES
                ),
            ));
        }
        let half_mm = 0.5 * blank.face_width_mm;
        let along_mm = (0..=intervals as usize).map(|i| blank.face_width_mm * i as f64 / intervals - half_mm);
        let (mut distances_mm, mut middles_rad) = (Vec::new(), Vec::new());
        for along_mm in along_mm {
            distances_mm.push(blank.mean_cone_distance_mm() + along_mm);
            middles_rad.push(job.slot_middle_rad(along_mm)?);
        }
        Ok(Self {
            distances_mm,
            middles_rad,
            columns: columns as usize,
            low_mm: -RIM_MODULES * blank.outer_module_mm(),
            strip_rad: pitch_rad / columns,
        })
    }

    /// The grid at the scene's spacing.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_scene(job: &BevelJob) -> Result<Self, Refusal> {
        let fields = &job.scene.fields;
        Self::new(job, fields.blank_spacing_mm, fields.blank_slice_spacing_mm)
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.distances_mm.len()
    }

    /// A ray of space 0 with the height of the face cone on it, mm. Columns beyond a pitch go on into the next cell.
    pub fn ray(&self, job: &BevelJob, column: usize, row: usize) -> (Ray, f64) {
        let (blank, distance_mm) = (&job.blank, self.distances_mm[row]);
        let dedendum_mm = blank.dedendum_mm(distance_mm);
        let root = blank.axial_mm([distance_mm, -dedendum_mm]);
        let (sin, cos) = blank.pitch_angle_rad.sin_cos();
        let from_middle_rad = self.strip_rad * (column as f64 + 0.5 - 0.5 * self.columns as f64);
        let turn = DMat3::from_rotation_z(self.middles_rad[row] + from_middle_rad);
        let ray = Ray { origin_mm: turn * DVec3::new(root.y, 0.0, -root.x), normal: turn * DVec3::new(cos, 0.0, sin) };
        (ray, blank.addendum_mm(distance_mm) + dedendum_mm)
    }

    /// Rays of a slot's cell, row after row; in the field's own words rows of the cell are columns.
    pub fn field(&self, job: &BevelJob, slot: u32) -> SpatialField {
        self.field_of_rows(job, slot, 0..self.rows())
    }

    /// Rays of some rows of a slot's cell.
    pub fn field_of_rows(&self, job: &BevelJob, slot: u32, rows: Range<usize>) -> SpatialField {
        let turn = index(slot, job.blank.teeth);
        SpatialField::new(rows.len(), self.columns, self.low_mm, |row, column| {
            let (ray, blank_mm) = self.ray(job, column, rows.start + row);
            (Ray { origin_mm: turn.point(ray.origin_mm), normal: turn.direction(ray.normal) }, blank_mm)
        })
    }

    /// Place of a ray in a cell's layers.
    pub fn index(&self, column: usize, row: usize) -> usize {
        row * self.columns + column
    }

    /// Share of the face that every row stands for, mm: the trapezoidal rule.
    pub fn row_widths_mm(&self) -> Vec<f64> {
        let (at, last) = (&self.distances_mm, self.rows() - 1);
        (0..=last).map(|i| 0.5 * (at[(i + 1).min(last)] - at[i.saturating_sub(1)])).collect()
    }

    /// Volume for each mm of cone distance between two heights of a ray, mm2.
    pub fn between_mm2(&self, job: &BevelJob, row: usize, [from_mm, to_mm]: [f64; 2]) -> f64 {
        let distance_mm = self.distances_mm[row];
        let foot_mm = job.blank.axial_mm([distance_mm, -job.blank.dedendum_mm(distance_mm)]).y;
        let middle_mm = foot_mm + 0.5 * (from_mm + to_mm) * job.blank.pitch_angle_rad.cos();
        self.strip_rad * middle_mm * (to_mm - from_mm)
    }

    /// Volume below heights of a cell, mm3.
    pub fn volume_mm3(&self, job: &BevelJob, heights_mm: &[f32]) -> f64 {
        let widths_mm = self.row_widths_mm();
        let below = |i: usize| {
            let row = i / self.columns;
            widths_mm[row] * self.between_mm2(job, row, [self.low_mm, f64::from(heights_mm[i])])
        };
        (0..heights_mm.len()).map(below).sum()
    }
}

impl BevelJob {
    /// Polar angle of the middle of slot 0 on the pitch cone at a place along the tooth, gear frame, rad.
    ///
    /// # Errors
    /// A flank that is not generated there.
    pub fn slot_middle_rad(&self, along_mm: f64) -> Result<f64, Refusal> {
        let polar = |side: Side| -> Result<f64, Refusal> {
            let row = self.target_of(side).row(along_mm)?;
            let at = self.gear_from_work.point(row.point(row.pitch_share())?.point_mm);
            Ok(at.y.atan2(at.x))
        };
        // Left flanks of the tooth before stand at the smaller angle of a space.
        let (from, to) = (polar(Side::Left)?, polar(Side::Right)?);
        let across = (to - from + PI).rem_euclid(TURN_RAD) - PI;
        Ok(from + 0.5 * across)
    }

    /// What the operations leave of a slot's cell; with the slots beside it where they reach into it.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_cell(
        &self,
        backend: &dyn Backend,
        grid: &CellGrid,
        slot: u32,
        beside: bool,
    ) -> Result<(Vec<Layer>, CutStats)> {
        let cells = self.cut_cells(backend, grid, slot..slot + 1, beside, [&|| true, &|| true])?;
        let (mut slots, stats) = cells.unwrap_or_default();
        Ok((slots.pop().unwrap_or_default(), stats))
    }

    /// The same of some slots in one job; `goes_on` says before each whether to go on, `advance` is called after it.
    /// `None`: stopped.
    fn cut_cells(
        &self,
        backend: &dyn Backend,
        grid: &CellGrid,
        slots: Range<u32>,
        beside: bool,
        [goes_on, advance]: [&(dyn Fn() -> bool + Sync); 2],
    ) -> Result<Option<(Vec<Vec<Layer>>, CutStats)>> {
        let done: Vec<OnceLock<CutLayers>> = vec![OnceLock::new(); slots.len()];
        let make = |index: usize| Ok(goes_on().then(|| self.swept_cell(grid, slots.start + index as u32, beside)));
        let take = |index: usize, _, left| {
            let _is_first = done[index].set(left);
            advance();
            Ok(())
        };
        backend.cut_swept(done.len(), &make, &take)?;
        let done: Option<Vec<CutLayers>> = done.into_iter().map(OnceLock::into_inner).collect();
        let Some(done) = done else { return Ok(None) };
        let mut stats = CutStats::default();
        for cell in &done {
            stats += cell.stats;
        }
        Ok(Some((done.into_iter().map(|cell| cell.layers).collect(), stats)))
    }

    /// A slot's cell with the passes of all operations, and those of the slots beside it where they reach into it.
    pub fn swept_cell(&self, grid: &CellGrid, slot: u32, beside: bool) -> SweptField<'_> {
        let teeth = self.blank.teeth;
        let by = [slot, (slot + 1) % teeth, (slot + teeth - 1) % teeth];
        let by = &by[..if beside { 3 } else { 1 }];
        let sets = |operation| by.iter().map(|&slot| self.slots.of(operation, slot)).collect();
        let operations = (0..self.operations.len()).map(sets).collect();
        SweptField { field: grid.field(self, slot), operations, by: SweptBy::NearPasses }
    }

    /// Whether the slots beside one may take anything from its cell, wherever the blades stand: teeth that come to a
    /// point, or are hit. Cells are alike, so that one stands for all.
    pub fn neighbours_may_reach(&self, grid: &CellGrid) -> bool {
        let teeth = self.blank.teeth;
        let heads: Vec<HeadInSlot> = self
            .operations
            .iter()
            .map(|operation| HeadInSlot::new(&operation.as_set, operation.course.range, &self.head))
            .collect();
        let works = [1, teeth - 1].map(|slot| index(slot, teeth).after(&self.gear_from_work).inverse());
        let cleared = |i: usize| {
            let (ray, top_mm) = grid.ray(self, i % grid.columns, i / grid.columns);
            works.iter().all(|work_from_gear| {
                let ends_mm = [grid.low_mm, top_mm].map(|height_mm| work_from_gear.point(ray.at(height_mm)));
                heads.iter().all(|head| head.clears(ends_mm))
            })
        };
        !(0..grid.columns * grid.rows()).into_par_iter().all(cleared)
    }
}

/// Cuts the whole blank; nothing after Ctrl-C.
///
/// # Errors
/// Rays that do not fit in memory; the backend's.
pub fn cut(
    job: &BevelJob,
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<Option<CutCells>> {
    let grid = CellGrid::of_scene(job)?;
    let teeth = job.blank.teeth;
    let step = progress.step("cut the whole blank", u64::from(teeth), "slots");
    let beside = job.neighbours_may_reach(&grid);
    let advance = || {
        step.advance(1);
        true
    };
    let cells = job.cut_cells(backend, &grid, 0..teeth, beside, [&|| !interrupt.is_raised(), &advance])?;
    let Some((slots, stats)) = cells else { return Ok(None) };
    step.finish();
    let mut left_mm3 = vec![0.0; job.operations.len()];
    let mut neighbours_reach = false;
    for (slot, layers) in (0..).zip(&slots) {
        neighbours_reach |= beside && others_left_a_place(job, slot, layers);
        for (left_mm3, layer) in left_mm3.iter_mut().zip(layers) {
            *left_mm3 += grid.volume_mm3(job, &layer.heights_mm);
        }
    }
    let uncut = grid.field(job, 0).blank_mm;
    let blank_mm3 = f64::from(job.blank.teeth) * grid.volume_mm3(job, &uncut);
    Ok(Some(CutCells { grid, slots, neighbours_reach, blank_mm3, left_mm3, stats }))
}

/// Whether passes of another slot than a cell's own are the last somewhere in it.
fn others_left_a_place(job: &BevelJob, slot: u32, layers: &[Layer]) -> bool {
    let own = (0..job.operations.len()).map(|operation| job.slots.of(operation, slot));
    let own: Vec<Range<u32>> = own.map(|set| set.first_pass..set.end_pass()).collect();
    let is_other = |&pass: &u32| pass != NO_PASS && !own.iter().any(|ids| ids.contains(&pass));
    layers.last().is_some_and(|layer| layer.passes.iter().any(is_other))
}
