//! The cut gear as one closed body, from the rays through the whole blank; or a few slots of it.
//!
//! In: the cut cells ([`super::blank`]). Out: a closed [`Mesh`]: the toothed surface, both ends of the face square to
//! the pitch cone, and a cone under the roots. What the blank has below that the scene does not say: the body is the
//! toothed ring.
//!
//! The columns of all cells follow each other round the axis, so that edges have two triangles by construction. Rows
//! lie at cone distances, and between two of them the surface runs straight along the slot. A body of a few slots
//! ends in walls along its first and last columns.

use super::blank::{CellGrid, CutCells};
use super::job::{BevelJob, index};
use crate::surface::flanks::pass_scalar;
use crate::surface::mesh::{Mesh, MeshPart};
use crate::surface::triangles::Triangles;
use gearcut_core::dexel::{Layer, NO_PASS};
use gearcut_core::error::Refusal;
use gearcut_core::terms::Side;
use glam::DVec3;

/// Columns of every cell about `spacing_mm` apart, never closer than the rays.
fn kept_columns(job: &BevelJob, grid: &CellGrid, spacing_mm: f64) -> Vec<usize> {
    let heel_mm = grid.strip_rad * job.blank.outer_cone_distance_mm * job.blank.pitch_angle_rad.sin();
    let step = ((spacing_mm / heel_mm) as usize).clamp(1, grid.columns / 4);
    (0..grid.columns).step_by(step).collect()
}

/// Closed body with columns about `spacing_mm` apart, never closer than the rays.
pub fn body(job: &BevelJob, whole: &CutCells, spacing_mm: f64) -> Mesh {
    let last = |layers: &Vec<Layer>| layers.last().expect("a job has at least one operation").clone();
    let cells: Vec<(u32, Layer)> = (0..).zip(whole.slots.iter().map(last)).collect();
    of_cells(job, &whole.grid, &cells, spacing_mm)
}

/// The same of the cells of slots that follow each other, of all of them or of a few.
pub fn of_cells(job: &BevelJob, grid: &CellGrid, cells: &[(u32, Layer)], spacing_mm: f64) -> Mesh {
    let (rows, is_ring) = (grid.rows(), cells.len() == job.blank.teeth as usize);
    let kept = kept_columns(job, grid, spacing_mm);
    let columns = cells.len() * kept.len();
    // Toothed surface, then the cone under the roots.
    let mut positions_mm: Vec<DVec3> = Vec::with_capacity(2 * columns * rows);
    let mut passes: Vec<u32> = Vec::with_capacity(2 * columns * rows);
    for under in [false, true] {
        for (slot, layer) in cells {
            let turn = index(*slot, job.blank.teeth);
            for &column in &kept {
                for row in 0..rows {
                    let (ray, _) = grid.ray(job, column, row);
                    let at = grid.index(column, row);
                    let height_mm = if under { grid.low_mm } else { f64::from(layer.heights_mm[at]) };
                    positions_mm.push(turn.point(ray.at(height_mm)));
                    passes.push(if under { NO_PASS } else { layer.passes[at] });
                }
            }
        }
    }
    let at = |under: usize, column: usize, row: usize| ((under * columns + column % columns) * rows + row) as u32;
    let mut mesh = Mesh { positions_mm, ..Mesh::default() };
    let mut add = |name: String, triangles: Vec<[u32; 3]>, measured: bool| {
        let start = mesh.triangles.len();
        mesh.triangles.extend(triangles);
        mesh.parts.push(MeshPart { name, triangles: start..mesh.triangles.len(), measured });
    };
    let quad = |[p, q, s, t]: [u32; 4]| [[p, q, s], [p, s, t]];
    // Along the face, then round the axis, is counter-clockwise seen from outside.
    let strip = |under: usize, column: usize| {
        (1..rows).flat_map(move |row| {
            let [p, q] = [row - 1, row].map(|row| at(under, column, row));
            let [t, s] = [row - 1, row].map(|row| at(under, column + 1, row));
            quad(if under == 0 { [p, q, s, t] } else { [p, t, s, q] })
        })
    };
    // After the last column of a few slots comes no other one.
    let strips = if is_ring { columns } else { columns - 1 };
    for (place, (slot, _)) in cells.iter().enumerate() {
        let of_slot = place * kept.len()..((place + 1) * kept.len()).min(strips);
        add(format!("slot_{:02}", slot + 1), of_slot.flat_map(|column| strip(0, column)).collect(), true);
    }
    add("under_roots".to_owned(), (0..strips).flat_map(|column| strip(1, column)).collect(), false);
    let end = |row: usize, outwards: bool| {
        (0..strips).flat_map(move |column| {
            let [p, q] = [1, 0].map(|under| at(under, column, row));
            let [t, s] = [1, 0].map(|under| at(under, column + 1, row));
            quad(if outwards { [p, t, s, q] } else { [p, q, s, t] })
        })
    };
    add("toe".to_owned(), end(0, false).collect(), false);
    add("heel".to_owned(), end(rows - 1, true).collect(), false);
    if !is_ring {
        let wall = |column: usize, is_last: bool| {
            (1..rows).flat_map(move |row| {
                let [p, q] = [row - 1, row].map(|row| at(1, column, row));
                let [t, s] = [row - 1, row].map(|row| at(0, column, row));
                quad(if is_last { [p, t, s, q] } else { [p, q, s, t] })
            })
        };
        add("walls".to_owned(), wall(0, false).chain(wall(columns - 1, true)).collect(), false);
    }
    mesh.scalars.push(pass_scalar(passes));
    mesh
}

/// What a viewer shows beside the target flanks: roots and tip lands as cut, both ends of the face; columns about
/// `spacing_mm` apart.
///
/// # Errors
/// A row that the roll does not generate.
pub fn beside_flanks(job: &BevelJob, whole: &CutCells, spacing_mm: f64) -> Result<Triangles, Refusal> {
    let grid = &whole.grid;
    let (rows, mean_mm) = (grid.rows(), job.blank.mean_cone_distance_mm());
    let kept = kept_columns(job, grid, spacing_mm);
    // Height over the root cone at which both flanks have begun, row by row.
    let mut form_mm = Vec::with_capacity(rows);
    for &distance_mm in &grid.distances_mm {
        let of = |side: Side| Ok::<_, Refusal>(job.target_of(side).row(distance_mm - mean_mm)?.form_height_mm);
        form_mm.push(of(Side::Left)?.max(of(Side::Right)?) + job.blank.dedendum_mm(distance_mm));
    }
    let mut triangles = Triangles::default();
    let columns = whole.slots.len() * kept.len();
    let at = |column: usize| {
        let column = column % columns;
        (column / kept.len(), kept[column % kept.len()])
    };
    let height_mm = |column: usize, row: usize| {
        let (slot, column) = at(column);
        let layer = whole.slots[slot].last().expect("a job has at least one operation");
        let i = grid.index(column, row);
        (f64::from(layer.heights_mm[i]), layer.passes[i])
    };
    let on_flank = |column: usize, row: usize| {
        let (height_mm, pass) = height_mm(column, row);
        pass != NO_PASS && height_mm > form_mm[row]
    };
    for column in 0..columns {
        let (slot, own) = at(column);
        let turn = index(slot as u32, job.blank.teeth);
        for row in 0..rows {
            let (ray, _) = grid.ray(job, own, row);
            let normal = turn.direction(ray.normal);
            for height_mm in [height_mm(column, row).0, grid.low_mm] {
                triangles.corner(turn.point(ray.at(height_mm)), normal);
            }
        }
    }
    let corner = |column: usize, row: usize, under: u32| 2 * (column % columns * rows + row) as u32 + under;
    for column in 0..columns {
        for row in 1..rows {
            let corners = [(column, row - 1), (column, row), (column + 1, row), (column + 1, row - 1)];
            // A quad between flank and land or root belongs to both: no gap is left.
            if !corners.iter().all(|&(column, row)| on_flank(column, row)) {
                let [p, q, s, t] = corners.map(|(column, row)| corner(column, row, 0));
                triangles.indices.extend([p, q, s, p, s, t]);
            }
            let [p, q, s, t] = corners.map(|(column, row)| corner(column, row, 1));
            triangles.indices.extend([p, s, q, p, t, s]);
        }
        for (row, outwards) in [(0, false), (rows - 1, true)] {
            let [p, q] = [1, 0].map(|under| corner(column, row, under));
            let [t, s] = [1, 0].map(|under| corner(column + 1, row, under));
            triangles.indices.extend(if outwards { [p, s, q, p, t, s] } else { [p, q, s, p, s, t] });
        }
    }
    Ok(triangles)
}
