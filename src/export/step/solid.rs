//! The solid's shell: walls round the teeth, bore or rim, two plane ends. Every edge belongs to two faces, which run
//! through it in opposite senses.
//!
//! Straight walls are cubic B-splines swept along z (`SURFACE_OF_LINEAR_EXTRUSION`), helical ones bicubic B-spline
//! surfaces. The bore or the rim is two half cylinders, so that no face closes upon itself.

use super::{
    DIGITS, EdgeLoop, InstanceId, InstanceWriter, StepFile, StepWords, oriented, real, references, text, whole,
};
use crate::export::solid::GearSolid;
use gearcut_core::gear::GearKind;
use glam::{DVec2, DVec3};

/// Edges of a closed wall: at the lower and at the upper end and between faces, counter-clockwise.
struct WallEdges {
    lower: Vec<InstanceId>,
    upper: Vec<InstanceId>,
    seams: Vec<InstanceId>,
}

/// The solid as a file.
pub fn step(solid: &GearSolid, words: &StepWords) -> StepFile {
    let mut file = InstanceWriter::default();
    let is_external = solid.back.kind == GearKind::External;
    let half_mm = solid.half_face_mm;
    let (edges, surfaces) = file.profile(solid);
    file.wall(&edges, &surfaces, is_external);
    let back = (solid.back.radius_mm > 0.0).then(|| {
        let (edges, surface) = file.back(solid.back.radius_mm, half_mm);
        file.wall(&edges, &[surface; 2], !is_external);
        edges
    });
    for (z_mm, is_upper) in [(-half_mm, false), (half_mm, true)] {
        let loop_of = |edges: &WallEdges, is_forward: bool| -> EdgeLoop {
            let own = if is_upper { &edges.upper } else { &edges.lower };
            oriented(own.iter().map(|&edge| (edge, true)).collect(), is_forward == is_upper)
        };
        let mut loops = vec![loop_of(&edges, is_external)];
        loops.extend(back.iter().map(|edges| loop_of(edges, !is_external)));
        if !is_external {
            loops.reverse();
        }
        let up = if is_upper { DVec3::Z } else { DVec3::NEG_Z };
        let place = file.placement(DVec3::Z * z_mm, up);
        let plane = file.add(&format!("PLANE('',#{place})"));
        file.face(plane, true, loops);
    }
    let shell = file.add(&format!("CLOSED_SHELL('',{})", references(&file.faces)));
    let brep = file.add(&format!("MANIFOLD_SOLID_BREP({},#{shell})", text(&words.name)));
    let faces = file.faces.len();
    file.product(words, "ADVANCED_BREP_SHAPE_REPRESENTATION", brep);
    StepFile { text: whole(&file.text, words), faces }
}

impl InstanceWriter {
    /// A length along z.
    fn upwards(&mut self, length_mm: f64) -> InstanceId {
        let up = self.direction(DVec3::Z);
        self.add(&format!("VECTOR('',#{up},{})", real(length_mm, DIGITS[0])))
    }

    /// Faces round the axis; `is_forward`: the material lies on the side of the axis. Surfaces look away from it.
    fn wall(&mut self, edges: &WallEdges, surfaces: &[InstanceId], is_forward: bool) {
        for (i, &surface) in surfaces.iter().enumerate() {
            let next = edges.seams[(i + 1) % edges.seams.len()];
            let around = vec![(edges.lower[i], true), (next, true), (edges.upper[i], false), (edges.seams[i], false)];
            self.face(surface, is_forward, vec![oriented(around, is_forward)]);
        }
    }

    /// Edges and surfaces round the teeth.
    fn profile(&mut self, solid: &GearSolid) -> (WallEdges, Vec<InstanceId>) {
        let half_mm = solid.half_face_mm;
        let heights_mm: Vec<f64> = match &solid.across {
            None => vec![-half_mm, half_mm],
            Some(across) => (0..across.count()).map(|row| across.greville(row)).collect(),
        };
        let last = heights_mm.len() - 1;
        let mut points: Vec<Vec<Vec<InstanceId>>> = Vec::new();
        for wall in &solid.walls {
            let row = |(row, &z_mm): (usize, &f64)| {
                let own_mm: &[DVec2] = &wall.rows_mm[row.min(wall.rows_mm.len() - 1)];
                // The last one is the first of the next wall.
                own_mm[..own_mm.len() - 1].iter().map(|point_mm| self.point(point_mm.extend(z_mm))).collect()
            };
            points.push(heights_mm.iter().enumerate().map(row).collect());
        }
        let firsts: Vec<Vec<InstanceId>> = points.iter().map(|rows| rows.iter().map(|row| row[0]).collect()).collect();
        for (i, rows) in points.iter_mut().enumerate() {
            for (row, &first) in rows.iter_mut().zip(&firsts[(i + 1) % firsts.len()]) {
                row.push(first);
            }
        }
        let ends: Vec<[InstanceId; 2]> =
            firsts.iter().map(|column| [column[0], column[last]].map(|point| self.vertex(point))).collect();
        let mut edges = WallEdges { lower: Vec::new(), upper: Vec::new(), seams: Vec::new() };
        let mut surfaces = Vec::new();
        let upwards = self.upwards(2.0 * half_mm);
        for (i, wall) in solid.walls.iter().enumerate() {
            let next = ends[(i + 1) % ends.len()];
            let [lower, upper] = [0, last].map(|row| self.curve(&wall.along, &points[i][row]));
            edges.lower.push(self.edge([ends[i][0], next[0]], lower));
            edges.upper.push(self.edge([ends[i][1], next[1]], upper));
            let (seam, surface) = match &solid.across {
                None => (
                    self.add(&format!("LINE('',#{},#{upwards})", firsts[i][0])),
                    self.add(&format!("SURFACE_OF_LINEAR_EXTRUSION('',#{lower},#{upwards})")),
                ),
                Some(across) => (self.curve(across, &firsts[i]), self.surface([&wall.along, across], &points[i])),
            };
            edges.seams.push(self.edge(ends[i], seam));
            surfaces.push(surface);
        }
        (edges, surfaces)
    }

    /// Edges of two half cylinders about the axis, and their surface.
    fn back(&mut self, radius_mm: f64, half_mm: f64) -> (WallEdges, InstanceId) {
        let upwards = self.upwards(2.0 * half_mm);
        let mut edges = WallEdges { lower: Vec::new(), upper: Vec::new(), seams: Vec::new() };
        let mut columns = Vec::new();
        for side in [1.0, -1.0] {
            let points = [-half_mm, half_mm].map(|z_mm| self.point(DVec3::new(side * radius_mm, 0.0, z_mm)));
            let ends = points.map(|point| self.vertex(point));
            let line = self.add(&format!("LINE('',#{},#{upwards})", points[0]));
            edges.seams.push(self.edge(ends, line));
            columns.push(ends);
        }
        let radius = real(radius_mm, DIGITS[0]);
        for (end, z_mm) in [-half_mm, half_mm].into_iter().enumerate() {
            let place = self.placement(DVec3::Z * z_mm, DVec3::Z);
            let circle = self.add(&format!("CIRCLE('',#{place},{radius})"));
            for side in [0, 1] {
                let edge = self.edge([columns[side][end], columns[1 - side][end]], circle);
                if end == 0 { edges.lower.push(edge) } else { edges.upper.push(edge) }
            }
        }
        let place = self.placement(DVec3::Z * -half_mm, DVec3::Z);
        (edges, self.add(&format!("CYLINDRICAL_SURFACE('',#{place},{radius})")))
    }
}
