//! The whole cut gear as one closed mesh, from the blank field.
//!
//! In: a [`BlankField`]. Out: a [`Mesh`] in which every edge lies between exactly two triangles, whatever the shape;
//! with the pass that left each vertex, and its normal deviation.
//!
//! **Inside** is decided by family X alone, at the nodes of the grid. An edge of the grid with one node inside is
//! crossed by the surface; where, the rays of its direction say, with the normal there. If the other family does not
//! know of a crossing (both see the same surface, so only rounding at a node can do that), its middle stands in.
//! Between slices, where sections differ by micrometres, a crossing is where the straight line between the sections
//! passes the node. Nothing is assumed about the result, and features thinner than the grid are left out.
//!
//! **Vertices** stand one per cell and sheet of the surface (`dual_cells`), where the tangents at the sheet's crossings
//! meet best (dual contouring: Ju et al. 2002): sharp edges stay sharp. They keep inside their cells, so sections of
//! different cells never cross. **Polygons** stand one per crossed edge. In a face whose inside is at two opposite
//! nodes two edges of the mesh could join the same two vertices; there each gets a vertex of its own in its middle.
//!
//! **End faces** are flat: the outermost cells hold the rim, and the end face within is triangulated between these
//! vertices and no others. A field of one slice therefore gives walls as tall as the face.

mod crossing;
#[cfg(test)]
mod tests;

use super::dual_cells::{NOT_CROSSED, edge_x, edge_y, edge_z, labels};
use super::flanks::{height_scalar, pass_scalar};
use super::mesh::{Mesh, MeshPart};
use super::plane_area::triangles_inside;
use crate::measure::target_outline::TargetOutline;
use crossing::{Cross, best_meeting, end_between};
use gearcut_core::dexel::NO_PASS;
use gearcut_core::dexel::blank_field::BlankField;
use gearcut_core::units::UM_PER_MM;
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// Vertices stay this share of a cell away from its sides: no two of them coincide, and 10 nm at 0.1 mm are no loss.
const MARGIN: f64 = 1e-4;

/// Layer (or slice) and place in it: a cell by its lowest node, or a node.
type Cell = (usize, usize, usize);

struct Builder<'a> {
    field: &'a BlankField,
    /// Inside flags per slice, node (i, j) at `j * columns + i`.
    inside: Vec<Vec<bool>>,
    columns: usize,
    rows: usize,
    /// Vertex of every sheet, by cell and label.
    vertices: HashMap<(Cell, u8), u32>,
    /// Vertices in ambiguous faces, by axis and higher cell of the face, and the inside node that they go round.
    middles: HashMap<((u8, Cell), Cell), u32>,
    positions_mm: Vec<DVec3>,
    passes: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    /// Directed rim of the lower and the upper end face, the inside on the left as seen from above.
    rims: [Vec<[u32; 2]>; 2],
    guessed: usize,
}

/// A closed mesh and how many crossings of it were guessed.
#[derive(Debug, Clone, PartialEq)]
pub struct BlankMesh {
    /// Parts `outline`, `end_face_low`, `end_face_high`.
    pub mesh: Mesh,
    /// Crossings that only one family knew of.
    pub guessed: usize,
}

impl BlankMesh {
    /// Mesh of a field; heights over `target` where it is given, on surfaces that passes left.
    pub fn new(field: &BlankField, target: Option<&TargetOutline>) -> Self {
        let mut builder = Builder::new(field);
        builder.walls();
        let outline = builder.triangles.len();
        let rims = std::mem::take(&mut builder.rims);
        builder.end_face(&rims[0], true);
        let low = builder.triangles.len();
        builder.end_face(&rims[1], false);
        let all = builder.triangles.len();
        let part = |name: &str, triangles| MeshPart { name: name.to_owned(), triangles, measured: name == "outline" };
        let parts =
            vec![part("outline", 0..outline), part("end_face_low", outline..low), part("end_face_high", low..all)];
        let heights = target.map(|target| {
            let height = |(p, &pass): (&DVec3, &u32)| {
                let known = (pass != NO_PASS).then(|| target.distance_mm(p.truncate(), 10.0)).flatten();
                known.map_or(f32::NAN, |mm| (mm * UM_PER_MM) as f32)
            };
            height_scalar(builder.positions_mm.iter().zip(&builder.passes).map(height).collect())
        });
        let scalars = heights.into_iter().chain([pass_scalar(builder.passes)]).collect();
        let mesh = Mesh { positions_mm: builder.positions_mm, triangles: builder.triangles, scalars, parts };
        Self { mesh, guessed: builder.guessed }
    }
}

impl<'a> Builder<'a> {
    fn new(field: &'a BlankField) -> Self {
        let [along_x, along_y] = &field.grid.rows;
        let (columns, rows) = (along_y.count, along_x.count);
        let inside = field
            .slices
            .iter()
            .map(|slice| {
                let mut flags = vec![false; columns * rows];
                for (j, ray) in slice.rays[0].iter().enumerate() {
                    for span in ray {
                        let from = along_y.first_at_or_above(span.low.at_mm);
                        let to = along_y.first_at_or_above(span.high.at_mm);
                        flags[j * columns + from..j * columns + to.max(from)].fill(true);
                    }
                }
                flags
            })
            .collect();
        Self {
            field,
            inside,
            columns,
            rows,
            vertices: HashMap::new(),
            middles: HashMap::new(),
            positions_mm: Vec::new(),
            passes: Vec::new(),
            triangles: Vec::new(),
            rims: [Vec::new(), Vec::new()],
            guessed: 0,
        }
    }

    fn is_inside(&self, slice: Option<usize>, i: usize, j: usize) -> bool {
        slice.and_then(|s| self.inside.get(s)).is_some_and(|flags| flags[j * self.columns + i])
    }

    /// Inside nodes of a cell; layer k lies between slices k - 1 and k, and nothing is inside beyond the ends.
    fn pattern(&self, (layer, i, j): Cell) -> u8 {
        let slices = [layer.checked_sub(1), Some(layer)];
        let bit = |n: usize| u8::from(self.is_inside(slices[n >> 2], i + (n & 1), j + (n >> 1 & 1))) << n;
        (0..8).map(bit).sum()
    }

    /// Crossing of the edge along x from node (i, j), or along y if `up`.
    fn crossing(&mut self, slice: usize, i: usize, j: usize, up: bool) -> Cross {
        let [along_x, along_y] = &self.field.grid.rows;
        let (x, y) = (along_y.at_mm(i), along_x.at_mm(j));
        let low_inside = self.is_inside(Some(slice), i, j);
        let rays = &self.field.slices[slice].rays;
        let (ray, from, to) =
            if up { (&rays[1][i], y, along_x.at_mm(j + 1)) } else { (&rays[0][j], x, along_y.at_mm(i + 1)) };
        let point = |at: f64| if up { DVec2::new(x, at) } else { DVec2::new(at, y) };
        let end = end_between(ray, from, to, low_inside);
        end.map_or_else(
            || {
                self.guessed += 1;
                let out = if low_inside { 1.0 } else { -1.0 };
                let normal = if up { DVec2::new(0.0, out) } else { DVec2::new(out, 0.0) };
                Cross { point_mm: point(0.5 * (from + to)), normal, pass: NO_PASS }
            },
            |end| Cross {
                point_mm: point(end.at_mm),
                normal: DVec2::new(f64::from(end.normal[0]), f64::from(end.normal[1])),
                pass: end.pass,
            },
        )
    }

    /// Vertex of the sheet that crosses local edge `edge` of a cell.
    fn vertex(&mut self, cell: Cell, edge: usize) -> u32 {
        let (layer, i, j) = cell;
        let pattern = self.pattern(cell);
        let labels = labels(pattern);
        let label = labels[edge];
        debug_assert_ne!(label, NOT_CROSSED, "only crossed edges carry polygons");
        if let Some(&id) = self.vertices.get(&(cell, label)) {
            return id;
        }
        let mut crosses = Vec::new();
        for (offset, slice) in [layer.checked_sub(1), Some(layer)].into_iter().enumerate() {
            let Some(slice) = slice.filter(|&s| s < self.inside.len()) else { continue };
            for side in 0..2 {
                if labels[edge_x(side, offset)] == label {
                    crosses.push(self.crossing(slice, i, j + side, false));
                }
                if labels[edge_y(side, offset)] == label {
                    crosses.push(self.crossing(slice, i + side, j, true));
                }
            }
        }
        let [along_x, along_y] = &self.field.grid.rows;
        let low = DVec2::new(along_y.at_mm(i), along_x.at_mm(j));
        let size = self.field.grid.spacing_mm();
        let margin = MARGIN * size;
        let mut point = if crosses.is_empty() { low + 0.5 * size } else { best_meeting(&crosses) };
        point = point.clamp(low + margin, low + size - margin);
        // Opposite corners of one section: each vertex keeps to its corner's half of the cell.
        let section = (pattern | pattern >> 4) & 0b1111;
        let single = pattern.trailing_zeros() >= 4 || pattern.leading_zeros() >= 4;
        if single && (section == 0b1001 || section == 0b0110) {
            let corner = corner_of(labels, label, pattern);
            let away = ((point - low) / size - corner).abs();
            let over = (away.x + away.y - (1.0 - 2.0 * MARGIN)).max(0.0);
            point += (corner * 2.0 - 1.0) * (0.5 * over * size);
            point = point.clamp(low + margin, low + size - margin);
        }
        let nearest = crosses
            .iter()
            .min_by(|a, b| a.point_mm.distance_squared(point).total_cmp(&b.point_mm.distance_squared(point)));
        let id = self.add(point.extend(self.layer_mm(layer)), nearest.map_or(NO_PASS, |c| c.pass));
        self.vertices.insert((cell, label), id);
        id
    }

    /// Place of a layer's vertices along the tooth: on the end faces in the outermost cells, else midway between
    /// slices.
    fn layer_mm(&self, layer: usize) -> f64 {
        let grid = &self.field.grid;
        let slices_z_mm = &grid.slices_z_mm;
        match layer {
            0 => -0.5 * grid.face_width_mm,
            l if l == slices_z_mm.len() => 0.5 * grid.face_width_mm,
            l => 0.5 * (slices_z_mm[l - 1] + slices_z_mm[l]),
        }
    }

    fn add(&mut self, position_mm: DVec3, pass: u32) -> u32 {
        self.positions_mm.push(position_mm);
        self.passes.push(pass);
        self.positions_mm.len() as u32 - 1
    }

    fn walls(&mut self) {
        for slice in 0..self.inside.len() {
            let above = slice + 1;
            for j in 0..self.rows {
                for i in 0..self.columns {
                    let here = self.is_inside(Some(slice), i, j);
                    let node = (slice, i, j);
                    if i + 1 < self.columns && here != self.is_inside(Some(slice), i + 1, j) {
                        let cells = [(slice, i, j - 1), (slice, i, j), (above, i, j), (above, i, j - 1)];
                        let edges = [edge_x(1, 1), edge_x(0, 1), edge_x(0, 0), edge_x(1, 0)];
                        self.polygon(slice, cells, edges, [node, (slice, i + 1, j)]);
                    }
                    if j + 1 < self.rows && here != self.is_inside(Some(slice), i, j + 1) {
                        let cells = [(slice, i - 1, j), (above, i - 1, j), (above, i, j), (slice, i, j)];
                        let edges = [edge_y(1, 1), edge_y(1, 0), edge_y(0, 0), edge_y(0, 1)];
                        self.polygon(slice, cells, edges, [node, (slice, i, j + 1)]);
                    }
                    if above < self.inside.len() && here != self.is_inside(Some(above), i, j) {
                        let cells = [(above, i - 1, j - 1), (above, i, j - 1), (above, i, j), (above, i - 1, j)];
                        let edges = [edge_z(1, 1), edge_z(0, 1), edge_z(0, 0), edge_z(1, 0)];
                        self.polygon(slice, cells, edges, [node, (above, i, j)]);
                    }
                }
            }
        }
    }

    /// Polygon round a crossed edge: cells counter-clockwise as seen from its higher node, the edge's number in each,
    /// and the edge's nodes; the surface faces the higher node if the lower one is inside.
    fn polygon(&mut self, slice: usize, cells: [Cell; 4], edges: [usize; 4], nodes: [Cell; 2]) {
        let lower_inside = self.is_inside(Some(nodes[0].0), nodes[0].1, nodes[0].2);
        let inner = nodes[usize::from(!lower_inside)];
        let mut ring = [0, 1, 2, 3].map(|c| (cells[c], self.vertex(cells[c], edges[c])));
        if !lower_inside {
            ring.reverse();
        }
        let last = self.inside.len();
        let mut corners = Vec::with_capacity(8);
        let mut start = 0;
        for at in 0..4 {
            let ((cell_a, a), (cell_b, b)) = (ring[at], ring[(at + 1) % 4]);
            // The side of a wall that lies in an end layer is part of the rim.
            if cell_a.0 == cell_b.0 && cell_a.0 == 0 && slice == 0 {
                self.rims[0].push([a, b]);
            }
            if cell_a.0 == cell_b.0 && cell_a.0 == last && slice + 1 == last {
                self.rims[1].push([b, a]);
            }
            corners.push(a);
            if let Some(face) = self.ambiguous_face(cell_a, cell_b) {
                start = corners.len();
                let middle = self.middle((face, inner), a, b);
                corners.push(middle);
            }
        }
        let n = corners.len();
        if n == 4 {
            // The shorter diagonal.
            let length = |a: u32, b: u32| self.positions_mm[a as usize].distance_squared(self.positions_mm[b as usize]);
            start = usize::from(length(corners[1], corners[3]) < length(corners[0], corners[2]));
        }
        let at = |k: usize| corners[(start + k) % n];
        self.triangles.extend((1..n - 1).map(|k| [at(0), at(k), at(k + 1)]));
    }

    /// The face between two cells, as its axis and the higher cell, if its inside is at two opposite nodes.
    fn ambiguous_face(&self, a: Cell, b: Cell) -> Option<(u8, Cell)> {
        let high = a.max(b);
        let pattern = self.pattern(high);
        let (axis, bits) = match (a.0 == b.0, a.1 == b.1) {
            (false, _) => (2, [0, 1, 2, 3]),
            (true, false) => (0, [0, 2, 4, 6]),
            (true, true) => (1, [0, 1, 4, 5]),
        };
        let [n00, n10, n01, n11] = bits.map(|bit: u8| pattern >> bit & 1);
        (n00 == n11 && n10 == n01 && n00 != n10).then_some((axis, high))
    }

    /// Vertex in the middle of a side of the mesh that lies in an ambiguous face, told by the inside node that the side
    /// goes round.
    fn middle(&mut self, key: ((u8, Cell), Cell), a: u32, b: u32) -> u32 {
        if let Some(&id) = self.middles.get(&key) {
            return id;
        }
        let place = 0.5 * (self.positions_mm[a as usize] + self.positions_mm[b as usize]);
        let id = self.add(place, self.passes[a.min(b) as usize]);
        self.middles.insert(key, id);
        id
    }

    /// Triangles inside a rim, between its vertices; facing down if `low`.
    fn end_face(&mut self, rim: &[[u32; 2]], low: bool) {
        let ids: Vec<u32> = rim.iter().map(|side| side[0]).collect();
        let index: HashMap<u32, usize> = ids.iter().enumerate().map(|(k, &id)| (id, k)).collect();
        let sides: Vec<[usize; 2]> = rim.iter().map(|side| side.map(|id| index[&id])).collect();
        let points_mm: Vec<DVec2> = ids.iter().map(|&id| self.positions_mm[id as usize].truncate()).collect();
        let triangles = triangles_inside(&points_mm, &sides).expect("vertices lie apart, and rims do not cross");
        for triangle in triangles {
            let [a, b, c] = triangle.map(|place| ids[place]);
            self.triangles.push(if low { [a, c, b] } else { [a, b, c] });
        }
    }
}

/// The inside corner (0 or 1 in x and y) of a section that a sheet goes round, in a cell with one section.
fn corner_of(labels: &[u8; 12], label: u8, pattern: u8) -> DVec2 {
    let slice = usize::from(pattern.trailing_zeros() >= 4);
    let section = if slice == 1 { pattern >> 4 } else { pattern };
    let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
    let met = corners.into_iter().find(|&(x, y): &(usize, usize)| {
        section >> (x + 2 * y) & 1 == 1 && labels[edge_x(y, slice)] == label && labels[edge_y(x, slice)] == label
    });
    met.map_or(DVec2::splat(0.5), |(x, y)| DVec2::new(x as f64, y as f64))
}
