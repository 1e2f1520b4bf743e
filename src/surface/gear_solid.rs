//! The cut gear as one closed body: the outline of every row lofted to the next one, two end faces, and the back.
//!
//! In: the outline and the back. Out: a closed [`Mesh`] with a part per flank, tip and root, and `bore` (or, of a ring,
//! `rim`), `face_top`, `face_bottom`; heights, stock and pass ids on the vertices of the outline.
//!
//! Every column of the outline has the same neighbours in every row, so that edges have two triangles by construction;
//! the end faces use the outline's own vertices and add none (`plane_area`). An outline that crosses itself has no end
//! faces; whether the body is closed is checked before it is given away.

use super::flanks::{height_scalar, pass_scalar, stock_scalar};
use super::mesh::{Mesh, MeshPart};
use super::outline::Outline;
use super::plane_area::{sides_of_contours, triangles_inside};
use gearcut_core::dexel::NO_PASS;
use gearcut_core::error::Refusal;
use gearcut_core::gear::{Back, GearKind};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Columns of a bore: a chord error below 0.1 % of its radius.
const BORE_COLUMNS: usize = 192;
/// Columns of a rim, which is the largest surface of a ring: its section is short of 0.002 %.
const RIM_COLUMNS: usize = 720;

/// Closed body of a gear.
///
/// # Errors
/// A bore or rim that reaches the tooth roots; an outline that crosses itself.
pub fn gear_solid(outline: &Outline, back: &Back) -> Result<Mesh, Refusal> {
    let rows = outline.rows();
    let columns = outline.columns.len();
    clear_of_roots(outline, back)?;
    let back_columns = match back.kind {
        GearKind::External if back.radius_mm == 0.0 => 0,
        GearKind::External => BORE_COLUMNS,
        GearKind::Internal => RIM_COLUMNS,
    };
    let circle: Vec<DVec2> =
        (0..back_columns).map(|i| back.radius_mm * DVec2::from_angle(TAU * i as f64 / back_columns as f64)).collect();
    let at = |column: usize, row: usize| (column * rows + row) as u32;
    let back_at = |column: usize, end: usize| (columns * rows + 2 * column + end) as u32;
    // Counter-clockwise seen from outside: the outline of a ring is gone round the other way.
    let facing = |triangle: [u32; 3]| match back.kind {
        GearKind::External => triangle,
        GearKind::Internal => [triangle[0], triangle[2], triangle[1]],
    };
    let ends_mm = [outline.rows_z_mm[0], outline.rows_z_mm[rows - 1]];

    let mut positions_mm: Vec<DVec3> = outline
        .columns
        .iter()
        .flat_map(|column| column.points_mm.iter().zip(&outline.rows_z_mm).map(|(p, &z)| p.extend(z)))
        .collect();
    positions_mm.extend(circle.iter().flat_map(|p| ends_mm.map(|z| p.extend(z))));

    let mut mesh = Mesh { positions_mm, ..Mesh::default() };
    let mut lofted: Vec<Vec<[u32; 3]>> = vec![Vec::new(); outline.parts.len()];
    for c in 0..columns {
        let next = (c + 1) % columns;
        // Between two flanks, roots and tips own the line where they meet: the flank ends at its own last point.
        let (a, b) = (outline.columns[c].part, outline.columns[next].part);
        let part = if outline.parts[b].starts_with("tooth") { a } else { b };
        for r in 1..rows {
            let [p, q, s, t] = [at(c, r - 1), at(next, r - 1), at(next, r), at(c, r)];
            lofted[part].extend([[p, q, s], [p, s, t]].map(facing));
        }
    }
    let mut add = |name: &str, triangles: Vec<[u32; 3]>, measured: bool| {
        if !triangles.is_empty() {
            let start = mesh.triangles.len();
            mesh.triangles.extend(triangles);
            mesh.parts.push(MeshPart { name: name.to_owned(), triangles: start..mesh.triangles.len(), measured });
        }
    };
    for (name, triangles) in outline.parts.iter().zip(lofted) {
        add(name, triangles, true);
    }
    let wall = (0..back_columns).flat_map(|c| {
        let next = (c + 1) % back_columns;
        let [p, q, s, t] = [back_at(c, 0), back_at(next, 0), back_at(next, 1), back_at(c, 1)];
        [[p, s, q], [p, t, s]].map(facing)
    });
    add(back.name(), wall.collect(), false);
    let contours = sides_of_contours(&[columns, back_columns]);
    for (end, row, name) in [(0, 0, "face_bottom"), (1, rows - 1, "face_top")] {
        // What is a hole runs clockwise: the bore, or the outline of a ring.
        let mut order: [Vec<usize>; 2] = [(0..columns).collect(), (0..back_columns).collect()];
        order[usize::from(back.kind == GearKind::External)].reverse();
        let row_mm = outline.row_mm(row);
        let [teeth, round] = &order;
        let points_mm: Vec<DVec2> = teeth.iter().map(|&c| row_mm[c]).chain(round.iter().map(|&c| circle[c])).collect();
        let vertex = |i: usize| if i < columns { at(teeth[i], row) } else { back_at(round[i - columns], end) };
        let inside = triangles_inside(&points_mm, &contours).unwrap_or_default();
        let triangles = inside.into_iter().map(|[a, b, c]| if end == 1 { [a, b, c] } else { [a, c, b] }.map(vertex));
        add(name, triangles.collect(), false);
    }
    let back_vertices = 2 * back_columns;
    let values = |pick: fn(&super::outline::OutlineColumn) -> &Vec<f32>| -> Vec<f32> {
        outline
            .columns
            .iter()
            .flat_map(|c| pick(c).iter().copied())
            .chain(std::iter::repeat_n(f32::NAN, back_vertices))
            .collect()
    };
    let passes = outline.columns.iter().flat_map(|c| c.passes.iter().copied());
    mesh.scalars.push(height_scalar(values(|c| &c.height_um)));
    if outline.has_stock {
        mesh.scalars.push(stock_scalar(values(|c| &c.stock_mm)));
    }
    mesh.scalars.push(pass_scalar(passes.chain(std::iter::repeat_n(NO_PASS, back_vertices)).collect()));
    if !mesh.is_closed() {
        return Err(Refusal::new(
            "output.mesh_spacing_mm",
            "the outline of the cut gear crosses itself, so that its body is not closed",
            "use a smaller mesh spacing; a gear that is cut below its target may have no such outline at all",
        ));
    }
    Ok(mesh)
}

/// Refuses a bore or a rim that the tooth roots reach.
fn clear_of_roots(outline: &Outline, back: &Back) -> Result<(), Refusal> {
    let radii_mm = outline.columns.iter().flat_map(|c| &c.points_mm).map(|p| p.length());
    match back.kind {
        GearKind::External => {
            let thinnest_mm = radii_mm.fold(f64::INFINITY, f64::min);
            if back.radius_mm >= 0.999 * thinnest_mm {
                return Err(Refusal::new(
                    "gear.bore_diameter_mm",
                    format!(
                        "the bore of {} mm reaches the tooth roots, which come down to {:.3} mm",
                        2.0 * back.radius_mm,
                        2.0 * thinnest_mm
                    ),
                    "use a smaller bore",
                ));
            }
        }
        GearKind::Internal => {
            let deepest_mm = radii_mm.fold(0.0, f64::max);
            if back.radius_mm <= deepest_mm / 0.999 {
                return Err(Refusal::new(
                    "gear.rim_mm",
                    format!(
                        "the ring of {:.3} mm diameter is reached by the tooth roots, which come up to {:.3} mm",
                        2.0 * back.radius_mm,
                        2.0 * deepest_mm
                    ),
                    "use a thicker rim",
                ));
            }
        }
    }
    Ok(())
}
