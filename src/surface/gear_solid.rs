//! The cut gear as one closed body: the outline of every row lofted to the next one, two end faces, and the bore.
//!
//! In: the outline and the bore. Out: a closed [`Mesh`] with a part per flank, tip and root, and `bore`, `face_top`,
//! `face_bottom`; heights, stock and pass ids on the vertices of the outline.
//!
//! Every column of the outline has the same neighbours in every row, so that edges have two triangles by construction;
//! the end faces use the outline's own vertices and add none (`plane_area`). An outline that crosses itself has no end
//! faces; whether the body is closed is checked before it is given away.

use super::flanks::{height_scalar, pass_scalar, stock_scalar};
use super::mesh::{Mesh, MeshPart};
use super::outline::Outline;
use super::plane_area::{sides_of_contours, triangles_inside};
use crate::dexel::NO_PASS;
use crate::error::Refusal;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Columns of the bore: a chord error below 0.1 % of its radius.
const BORE_COLUMNS: usize = 192;

/// Closed body of a gear.
///
/// # Errors
/// A bore that reaches the tooth roots; an outline that crosses itself.
pub fn gear_solid(outline: &Outline, bore_diameter_mm: f64) -> Result<Mesh, Refusal> {
    let rows = outline.rows();
    let columns = outline.columns.len();
    let bore_radius_mm = 0.5 * bore_diameter_mm;
    let thinnest_mm =
        outline.columns.iter().flat_map(|c| &c.points_mm).map(|p| p.length()).fold(f64::INFINITY, f64::min);
    if bore_radius_mm >= 0.999 * thinnest_mm {
        return Err(Refusal::new(
            "gear.bore_diameter_mm",
            format!(
                "the bore of {bore_diameter_mm} mm reaches the tooth roots, which come down to {:.3} mm",
                2.0 * thinnest_mm
            ),
            "use a smaller bore",
        ));
    }
    let bore_columns = if bore_radius_mm > 0.0 { BORE_COLUMNS } else { 0 };
    let bore: Vec<DVec2> =
        (0..bore_columns).map(|i| bore_radius_mm * DVec2::from_angle(TAU * i as f64 / bore_columns as f64)).collect();
    let at = |column: usize, row: usize| (column * rows + row) as u32;
    let bore_at = |column: usize, end: usize| (columns * rows + 2 * column + end) as u32;
    let ends_mm = [outline.rows_z_mm[0], outline.rows_z_mm[rows - 1]];

    let mut positions_mm: Vec<DVec3> = outline
        .columns
        .iter()
        .flat_map(|column| column.points_mm.iter().zip(&outline.rows_z_mm).map(|(p, &z)| p.extend(z)))
        .collect();
    positions_mm.extend(bore.iter().flat_map(|p| ends_mm.map(|z| p.extend(z))));

    let mut mesh = Mesh { positions_mm, ..Mesh::default() };
    let mut lofted: Vec<Vec<[u32; 3]>> = vec![Vec::new(); outline.parts.len()];
    for c in 0..columns {
        let next = (c + 1) % columns;
        // Between two flanks, roots and tips own the seam: the flank ends at its own last point.
        let (a, b) = (outline.columns[c].part, outline.columns[next].part);
        let part = if outline.parts[b].starts_with("tooth") { a } else { b };
        for r in 1..rows {
            let [p, q, s, t] = [at(c, r - 1), at(next, r - 1), at(next, r), at(c, r)];
            lofted[part].extend([[p, q, s], [p, s, t]]);
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
    let wall = (0..bore_columns).flat_map(|c| {
        let next = (c + 1) % bore_columns;
        let [p, q, s, t] = [bore_at(c, 0), bore_at(next, 0), bore_at(next, 1), bore_at(c, 1)];
        [[p, s, q], [p, t, s]]
    });
    add("bore", wall.collect(), false);
    let contours = sides_of_contours(&[columns, bore_columns]);
    for (end, row, name) in [(0, 0, "face_bottom"), (1, rows - 1, "face_top")] {
        let points_mm: Vec<DVec2> = outline.row_mm(row).into_iter().chain(bore.iter().rev().copied()).collect();
        // The bore is a hole: it runs clockwise.
        let vertex = |i: usize| if i < columns { at(i, row) } else { bore_at(columns + bore_columns - 1 - i, end) };
        let inside = triangles_inside(&points_mm, &contours).unwrap_or_default();
        let triangles = inside.into_iter().map(|[a, b, c]| if end == 1 { [a, b, c] } else { [a, c, b] }.map(vertex));
        add(name, triangles.collect(), false);
    }
    let bore_vertices = 2 * bore_columns;
    let values = |pick: fn(&super::outline::OutlineColumn) -> &Vec<f32>| -> Vec<f32> {
        outline
            .columns
            .iter()
            .flat_map(|c| pick(c).iter().copied())
            .chain(std::iter::repeat_n(f32::NAN, bore_vertices))
            .collect()
    };
    let passes = outline.columns.iter().flat_map(|c| c.passes.iter().copied());
    mesh.scalars.push(height_scalar(values(|c| &c.height_um)));
    if outline.has_stock {
        mesh.scalars.push(stock_scalar(values(|c| &c.stock_mm)));
    }
    mesh.scalars.push(pass_scalar(passes.chain(std::iter::repeat_n(NO_PASS, bore_vertices)).collect()));
    if !mesh.is_closed() {
        return Err(Refusal::new(
            "output.mesh_spacing_mm",
            format!(
                "the outline of the cut gear crosses itself, so that its body is not closed: {:?}",
                mesh.edge_faults()
            ),
            "use a smaller mesh spacing",
        ));
    }
    Ok(mesh)
}
