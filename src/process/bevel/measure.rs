//! What is measured on bevel flanks: heights, traces, a grid of points as gear inspection takes them, slot and marks.
//!
//! In: cut flanks. Out: [`BevelReport`] for each, [`SlotRow`]s for the slot beside them, [`MarkForm`] as it should be.
//!
//! A twentieth of profile and face is left out at either end. The **grid** has 5 points along the profile and 9 along
//! the tooth (AGMA 2009, ISO 17485) unless the scene asks for more, on the dexels nearest to its even places: points,
//! normals and deviations belong to each other exactly. Deviations run along the target's normal, positive where
//! material is left.

use super::job::{BevelJob, index};
use crate::job::GearJob;
use crate::measure::cut_grid::{CutGrid, within};
use crate::measure::inspection::{FlankSurface, InspectedFlank, StockRange, SurfaceHeights};
use crate::measure::stock::Extreme;
use gearcut_core::bevel::ease_off::{Explained, explain};
use gearcut_core::bevel::face_mill::FaceMill;
use gearcut_core::cut::Backend;
use gearcut_core::dexel::{FreeRays, Layer, NO_PASS, Ray, SpatialField};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::terms::Side;
use glam::{DMat3, DVec3};
use std::f64::consts::TAU;
use std::ops::Range;

/// How far rays of the bottom record below the blank's root, in outer modules.
const BOTTOM_MODULES: f64 = 0.5;
/// Deviations below this are marks of the blades, and no setting is looked for, mm.
const LEAST_EXPLAINED_MM: f64 = 5e-4;
/// Step of the difference quotients of the moment of generation over a flank, mm; the moment bends little over that.
const PLACE_STEP_MM: f64 = 0.05;

/// One measured flank.
pub type BevelReport = InspectedFlank<BevelSurface>;

/// What is measured on bevel flanks alone.
#[derive(Debug, Clone, PartialEq)]
pub struct BevelSurface {
    /// Heights of the finished surface; `None` where a dexel of the evaluated part was not reached.
    pub finished: Option<SurfaceHeights>,
    /// What each earlier operation left over the finished surface.
    pub stock: Vec<Option<SurfaceHeights>>,
    /// The grid, row by row along the tooth from the toe, each from the root to the tip.
    pub grid: Vec<GridPoint>,
    /// Shares of the profile and places along the tooth, mm, of the grid.
    pub grid_places: [Vec<f64>; 2],
    /// Dexels of the whole flank that each blade left last.
    pub left_by_blade: Vec<u64>,
    /// Deviations on the pitch cone at the grid's rows, mm; `None` where no pass came.
    pub on_pitch_cone_mm: Vec<Option<f64>>,
}

impl FlankSurface for BevelSurface {
    fn deviations(&self) -> Option<[Extreme; 2]> {
        self.finished.map(|of| of.ends)
    }

    fn stock(&self, operation: usize) -> Option<StockRange> {
        (*self.stock.get(operation)?).map(|of| of.stock())
    }
}

/// A point of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridPoint {
    /// Column along the profile from the root and row along the tooth from the toe, from 1.
    pub place: [u32; 2],
    /// Nominal point and normal out of the material, gear frame.
    pub target: Ray,
    /// Deviation, mm; `None` where no pass came.
    pub deviation_mm: Option<f64>,
}

/// The slot at one place along the tooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlotRow {
    /// Place along the tooth from the middle of the face, mm.
    pub along_mm: f64,
    /// Width on the pitch cone along its circle, mm.
    pub width_mm: Option<f64>,
    /// Depth from the face cone, square to the pitch cone, in the middle of the slot, mm.
    pub depth_mm: Option<f64>,
    /// The blank's whole depth there, mm.
    pub whole_depth_mm: f64,
}

/// Marks of one kind of blades in closed form, in the middle of a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkForm {
    /// Distance of neighbouring marks across them, mm.
    pub spacing_mm: f64,
    /// Height of the ridges between them, mm.
    pub height_mm: f64,
}

/// Measures a cut flank.
///
/// # Errors
/// A row of the grid that the roll does not generate.
pub fn measure(job: &BevelJob, tooth: u32, side: Side, rays: &FreeRays, layers: &[Layer]) -> Result<BevelReport> {
    let (arcs_mm, rows_mm) = (&rays.arcs_mm, &rays.rows_mm);
    let target = job.target_of(side);
    let grid = CutGrid {
        tooth,
        side,
        length_mm: target.length_mm(),
        arcs_mm,
        rolls_mm: arcs_mm.clone(),
        rows_mm,
        layers,
        evaluated_mm: job.evaluated_mm(side),
        evaluated_rolls_mm: job.evaluated_mm(side)[0],
    };
    let last = layers.len() - 1;
    let mut left_by_blade = vec![0; job.head.blades() as usize];
    // Along the tooth a pass leaves many dexels in a row.
    for left in layers[last].passes.chunk_by(|a, b| a == b).filter(|left| left[0] != NO_PASS) {
        left_by_blade[job.slots.blade_of(left[0]) as usize] += left.len() as u64;
    }
    let [columns, rows] = grid.evaluated();
    let [grid_columns, grid_rows] =
        [(&columns, job.spec.grid[0]), (&rows, job.spec.grid[1])].map(|(inner, count)| grid_places(inner, count));
    let points = grid_rows.iter().enumerate().flat_map(|(j, &row)| {
        let grid = &grid;
        grid_columns.iter().enumerate().map(move |(i, &column)| GridPoint {
            place: [i as u32 + 1, j as u32 + 1],
            target: rays.field.ray(column, row),
            deviation_mm: grid.height_mm(last, column, row),
        })
    });
    let on_pitch_cone = |&row: &usize| -> Result<Option<f64>, Refusal> {
        let arc_mm = target.arc_at(target.row(rows_mm[row])?.pitch_share());
        let column = arcs_mm.partition_point(|&arc| arc < arc_mm).min(arcs_mm.len() - 1);
        Ok(grid.height_mm(last, column, row))
    };
    Ok(grid.inspected(BevelSurface {
        finished: grid.finished(),
        stock: grid.stock(),
        grid: points.collect(),
        grid_places: [
            grid_columns.iter().map(|&column| target.share_at(arcs_mm[column])).collect(),
            grid_rows.iter().map(|&row| rows_mm[row]).collect(),
        ],
        left_by_blade,
        on_pitch_cone_mm: slot_rows(&rows, job.spec.grid[1]).iter().map(on_pitch_cone).collect::<Result<_, _>>()?,
    }))
}

/// Indices nearest to even places over a range, both ends among them.
fn grid_places(inner: &Range<usize>, count: usize) -> Vec<usize> {
    let last = (inner.len() - 1) as f64;
    (0..count).map(|i| inner.start + (last * i as f64 / (count - 1) as f64).round() as usize).collect()
}

/// Rows at which a slot is measured: those of the grid, and the one in the middle.
fn slot_rows(inner: &Range<usize>, count: usize) -> Vec<usize> {
    let mut rows = grid_places(inner, count);
    let middle = inner.start + (inner.len() - 1) / 2;
    if let Err(place) = rows.binary_search(&middle) {
        rows.insert(place, middle);
    }
    rows
}

/// The slot behind a tooth at the rows of the grid and in the middle of the face: its width from both flanks, its depth
/// from rays into its bottom.
///
/// # Errors
/// Flanks that do not reach the pitch cone; the backend's.
pub fn slot(job: &BevelJob, backend: &dyn Backend, flanks: [&BevelReport; 2]) -> Result<Vec<SlotRow>> {
    let [before, after] = flanks;
    let space = job.space_of(before.tooth, before.side);
    let [_, rows_mm] = job.places_mm(before.side);
    let rows_mm: Vec<f64> = slot_rows(&within(&rows_mm, job.evaluated_face_mm()), job.spec.grid[1])
        .into_iter()
        .map(|row| rows_mm[row])
        .collect();
    let blank = &job.blank;
    let turn = index(space, blank.teeth);
    // On the pitch cone: polar angle and normal of a flank, gear frame.
    let crossing = |side: Side, along_mm: f64| -> Result<(f64, f64, DVec3), Refusal> {
        let row = job.target_of(side).row(along_mm)?;
        let point = row.point(row.pitch_share())?;
        let at = turn.point(job.gear_from_work.point(point.point_mm));
        let normal = turn.direction(job.gear_from_work.direction(point.normal));
        let polar = at.y.atan2(at.x);
        Ok((polar, at.truncate().length(), normal))
    };
    let mut widths_mm = Vec::new();
    let mut bottom = Vec::new();
    for (row, &along_mm) in rows_mm.iter().enumerate() {
        let (from, radius_mm, from_normal) = crossing(before.side, along_mm)?;
        let (to, _, to_normal) = crossing(after.side, along_mm)?;
        let across = (to - from).rem_euclid(TAU);
        // A deviation d along the normal n stands d / (n . t) farther along the circle.
        let along_circle = |polar: f64, normal: DVec3, deviation_mm: f64| {
            deviation_mm / normal.dot(DVec3::new(-polar.sin(), polar.cos(), 0.0))
        };
        let width = before.own.on_pitch_cone_mm[row].zip(after.own.on_pitch_cone_mm[row]).map(|(left, right)| {
            radius_mm * across + along_circle(to, to_normal, right) - along_circle(from, from_normal, left)
        });
        widths_mm.push(width);
        bottom.push(from + 0.5 * across);
    }
    let whole_mm = |along_mm: f64| {
        let distance_mm = blank.mean_cone_distance_mm() + along_mm;
        blank.addendum_mm(distance_mm) + blank.dedendum_mm(distance_mm)
    };
    let low_mm = -BOTTOM_MODULES * blank.outer_module_mm();
    let field = SpatialField::new(1, rows_mm.len(), low_mm, |_, row| {
        let distance_mm = blank.mean_cone_distance_mm() + rows_mm[row];
        let root = blank.axial_mm([distance_mm, -blank.dedendum_mm(distance_mm)]);
        let (sin, cos) = blank.pitch_angle_rad.sin_cos();
        let turn = DMat3::from_rotation_z(bottom[row]);
        let ray = Ray { origin_mm: turn * DVec3::new(root.y, 0.0, -root.x), normal: turn * DVec3::new(cos, 0.0, sin) };
        (ray, whole_mm(rows_mm[row]))
    });
    let (layers, _) = job.cut_field(backend, space, &field)?;
    let finished = layers.last().expect("at least one operation");
    Ok(rows_mm
        .iter()
        .enumerate()
        .map(|(row, &along_mm)| SlotRow {
            along_mm,
            width_mm: widths_mm[row],
            depth_mm: (finished.passes[row] != NO_PASS)
                .then(|| whole_mm(along_mm) - f64::from(finished.heights_mm[row])),
            whole_depth_mm: whole_mm(along_mm),
        })
        .collect())
}

/// Settings that explain a flank's deviations on the grid, best first; `None` where a point of it was not cut or all
/// deviations are below half a micrometre.
///
/// # Errors
/// A flank that is not generated somewhere on the grid.
pub fn explained(job: &BevelJob, flank: &BevelReport) -> Result<Option<Vec<Explained>>, Refusal> {
    let deviations: Option<Vec<f64>> = flank.own.grid.iter().map(|point| point.deviation_mm).collect();
    let Some(deviations) = deviations else { return Ok(None) };
    if deviations.iter().all(|deviation| deviation.abs() < LEAST_EXPLAINED_MM) {
        return Ok(None);
    }
    let [shares, along_mm] = &flank.own.grid_places;
    explain(job.target_of(flank.side), shares, along_mm, &deviations).map(Some)
}

/// Marks of the blades of one kind on a side of the teeth, in the middle of the flank: blades of the kind follow each
/// other every dq of the cradle. A point between two of them is passed dq / 2 beside its moment, where the cone stands
/// over it; and the moments of generation q over the flank put their lines dq / |grad q| apart. A head that plunges
/// leaves none: at full depth all blades of a kind sweep the same cone.
///
/// # Errors
/// The flank has no middle.
pub fn marks(job: &BevelJob, side: Side) -> Result<Option<MarkForm>, Refusal> {
    let (target, operation) = (job.target_of(side), job.finishing());
    if operation.settings.plunges() {
        return Ok(None);
    }
    let kind = job.kind_of(side);
    let of_kind = (0..job.head.blades()).filter(|&blade| FaceMill::kind_of(blade) == kind).count();
    let period_s = TAU / operation.spec.head_speed_rad_per_s / of_kind as f64;
    let step_rad = operation.course.per_s.abs() * period_s;
    let middle = target.row(0.0)?.point(0.5)?;
    let height = |sign: f64| target.envelope.beyond_mm(middle.point_mm, middle.cradle_rad + sign * 0.5 * step_rad);
    let share_step = PLACE_STEP_MM / target.length_mm();
    let beside = [target.row(PLACE_STEP_MM)?.point(0.5)?, target.row(0.0)?.point(0.5 + share_step)?];
    // Moments over two steps in the flank give their gradient in its tangent plane.
    let [a, b] = beside.map(|point| point.point_mm - middle.point_mm);
    let [q_a, q_b] = beside.map(|point| point.cradle_rad - middle.cradle_rad);
    let (aa, ab, bb) = (a.dot(a), a.dot(b), b.dot(b));
    let determinant = aa * bb - ab * ab;
    let gradient = ((q_a * bb - q_b * ab) * a + (q_b * aa - q_a * ab) * b) / determinant;
    let height_mm = 0.5 * (height(1.0) + height(-1.0));
    Ok(Some(MarkForm { spacing_mm: step_rad / gradient.length(), height_mm }))
}
