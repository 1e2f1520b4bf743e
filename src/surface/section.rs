//! The transverse section of the work while it is being cut, by clipping polygons.
//!
//! In: a job and a number of strokes. Out: the section in the middle of the face after exactly these strokes: the blank's outline less every cutter tooth that has passed, none left out. It serves
//! the pictures of the cut as it happens, where all strokes up to a moment count; what is measured comes from dexels.
//!
//! Chords of the cutter's flanks lie within `CHORD_MM` of the edge, far below a pixel; clipping is exact on a grid of some nanometres. Teeth are wedges down to the cutter's axis. Strokes are
//! clipped `BATCH` at a time: the union of neighbours is small, while the outline with its thousands of facets is gone through once per batch.

use super::mesh::{Mesh, Part};
use crate::frame::Rigid2;
use crate::job::Job;
use crate::passes::strokes::cubic_through;
use crate::tool::edge::SegmentShape;
use crate::tool::{CuttingTool, PlanarTool};
use earcut::Earcut;
use glam::{DVec2, DVec3};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use std::f64::consts::TAU;

/// Largest distance between chords and the cutter's edge, mm.
const CHORD_MM: f64 = 2e-3;
/// Strokes clipped together: few enough for a small union, enough to spare the outline most of its rounds.
const BATCH: usize = 16;
/// Corners of the blank's outline, and of the bore.
const BLANK_CORNERS: u32 = 720;
const BORE_CORNERS: u32 = 96;

/// A closed contour, mm.
type Contour = Vec<[f64; 2]>;

/// Section that grows smaller stroke by stroke.
#[derive(Debug)]
pub struct Section<'a> {
    job: &'a Job,
    /// Outer contours and holes of every piece.
    shapes: Vec<Vec<Contour>>,
    /// One cutter tooth in the blade frame.
    tooth: Vec<DVec2>,
    /// Furthest point of the blank from the gear's axis, mm.
    reach_mm: f64,
    /// Strokes that have been cut, over all operations.
    done: usize,
}

impl<'a> Section<'a> {
    /// The uncut blank.
    pub fn new(job: &'a Job) -> Self {
        let at = |i: u32, of: u32| TAU * f64::from(i) / f64::from(of);
        let outline: Vec<DVec2> = (0..BLANK_CORNERS).map(|i| job.blank.outline_mm(at(i, BLANK_CORNERS))).collect();
        let reach_mm = outline.iter().map(|p| p.length()).fold(0.0, f64::max);
        let mut contours = vec![outline.iter().map(DVec2::to_array).collect::<Contour>()];
        let bore_mm = 0.5 * job.scene.gear.bore_diameter_mm;
        if bore_mm > 0.0 {
            contours.push(
                (0..BORE_CORNERS)
                    .rev()
                    .map(|i| (bore_mm * DVec2::from_angle(at(i, BORE_CORNERS))).to_array())
                    .collect(),
            );
        }
        Self { job, shapes: vec![contours], tooth: tooth_contour(job), reach_mm, done: 0 }
    }

    /// Strokes of all operations together.
    pub fn strokes(job: &Job) -> usize {
        job.operations.iter().map(|operation| operation.strokes.count()).sum()
    }

    /// Operation and stroke of a stroke counted over all operations.
    pub fn operation_and_stroke(job: &Job, stroke: usize) -> (usize, usize) {
        let mut rest = stroke;
        for (index, operation) in job.operations.iter().enumerate() {
            if rest < operation.strokes.count() {
                return (index, rest);
            }
            rest -= operation.strokes.count();
        }
        let last = job.operations.len() - 1;
        (last, job.operations[last].strokes.count() - 1)
    }

    /// Where the cutter stands in the work at a stroke, at the moment when the middle of the face is cut.
    pub fn work_from_tool(job: &Job, stroke: usize) -> Rigid2 {
        let (operation, stroke) = Self::operation_and_stroke(job, stroke);
        let poses = job.operations[operation].strokes.poses(stroke);
        let middle = |pick: fn(&Rigid2) -> f64| cubic_through(&poses.iter().map(pick).collect::<Vec<_>>())[0];
        Rigid2 {
            rotation: DVec2::new(middle(|p| p.rotation.x), middle(|p| p.rotation.y)),
            translation_mm: DVec2::new(middle(|p| p.translation_mm.x), middle(|p| p.translation_mm.y)),
        }
    }

    /// Cuts all strokes before stroke `until`.
    pub fn advance(&mut self, until: usize) {
        let blades: Vec<Rigid2> =
            (0..self.job.cutter.blade_count()).map(|b| self.job.cutter.tool_from_blade(b)).collect();
        while self.done < until {
            let next = (self.done + BATCH).min(until);
            let teeth: Vec<Contour> = (self.done..next)
                .flat_map(|stroke| {
                    let pose = Self::work_from_tool(self.job, stroke);
                    blades.iter().map(move |blade| pose.after(blade))
                })
                .map(|work_from_blade| {
                    self.tooth.iter().map(|&p| work_from_blade.point(p).to_array()).collect::<Contour>()
                })
                .filter(|tooth| tooth.iter().any(|&p| DVec2::from_array(p).length() < self.reach_mm))
                .collect();
            if !teeth.is_empty() {
                self.shapes = self.shapes.overlay(&teeth, OverlayRule::Difference, FillRule::NonZero);
            }
            self.done = next;
        }
    }

    /// Area of the section, mm^2.
    pub fn area_mm2(&self) -> f64 {
        self.shapes.iter().flatten().map(|contour| signed_area_mm2(contour)).sum()
    }

    /// The section as a body between two heights, turned by an angle about the gear's axis.
    pub fn solid(&self, [low_mm, high_mm]: [f64; 2], turn: DVec2) -> Mesh {
        prism(&self.shapes, [low_mm, high_mm], |p| turn.rotate(p))
    }
}

/// The whole cutter as a body between two heights, placed in the plane.
pub fn cutter_solid(job: &Job, [low_mm, high_mm]: [f64; 2], place: &Rigid2) -> Mesh {
    let tooth = tooth_contour(job);
    // Teeth one after the other round the axis, without the axis itself.
    let outline: Contour = (0..job.cutter.blade_count())
        .flat_map(|blade| {
            let tool_from_blade = job.cutter.tool_from_blade(blade);
            tooth[1..].iter().map(move |&p| tool_from_blade.point(p).to_array()).collect::<Contour>()
        })
        .collect();
    let bore_mm = 0.35 * job.cutter.pitch_radius_mm;
    let bore = (0..BORE_CORNERS)
        .rev()
        .map(|i| (bore_mm * DVec2::from_angle(TAU * f64::from(i) / f64::from(BORE_CORNERS))).to_array());
    prism(&[vec![outline, bore.collect()]], [low_mm, high_mm], |p| place.point(p))
}

/// Axis, then the edge of one tooth from its right root to its left one; blade frame.
fn tooth_contour(job: &Job) -> Vec<DVec2> {
    // tool_from_blade moves the blade's own frame, whose origin is the cutter's axis.
    let mut contour = vec![DVec2::ZERO];
    for segment in &job.cutter.edge().segments {
        let [from, to] = segment.y_range_mm;
        let x = |y: f64| match &segment.shape {
            SegmentShape::Table(table) => table.x_and_slope(y)[0],
            SegmentShape::Arc { radius_mm } => (radius_mm * radius_mm - y * y).max(0.0).sqrt() - radius_mm,
        };
        // A chord of 1/n of the segment bulges by 1/n^2 of what the whole segment bulges over its own chord.
        let bulge_mm = (1..8).map(|i| (x(from + (to - from) * f64::from(i) / 8.0) - x(from)).abs()).fold(0.0, f64::max);
        let count = (bulge_mm / CHORD_MM).sqrt().ceil().max(1.0);
        contour.extend((0..count as u32).map(|i| {
            let y = from + (to - from) * f64::from(i) / count;
            segment.blade_from_segment.point(DVec2::new(x(y), y))
        }));
    }
    contour
}

fn signed_area_mm2(contour: &[[f64; 2]]) -> f64 {
    let point = |i: usize| DVec2::from_array(contour[i % contour.len()]);
    (0..contour.len()).map(|i| 0.5 * point(i).perp_dot(point(i + 1))).sum()
}

/// Walls and two ends over contours (outer ones counter-clockwise, holes clockwise).
fn prism(shapes: &[Vec<Contour>], [low_mm, high_mm]: [f64; 2], place: impl Fn(DVec2) -> DVec2) -> Mesh {
    let mut mesh = Mesh::default();
    let (mut walls, mut ends): (Vec<[u32; 3]>, Vec<[u32; 3]>) = (Vec::new(), Vec::new());
    for shape in shapes {
        let first = mesh.positions_mm.len() as u32;
        let points: Vec<[f64; 2]> = shape.iter().flatten().copied().collect();
        let total = points.len() as u32;
        for z in [low_mm, high_mm] {
            mesh.positions_mm.extend(points.iter().map(|&p| place(DVec2::from_array(p)).extend(z)));
        }
        let mut start = 0;
        let mut holes = Vec::new();
        for contour in shape {
            let count = contour.len() as u32;
            for i in 0..count {
                let (a, b) = (first + start + i, first + start + (i + 1) % count);
                walls.extend([[a, b, b + total], [a, b + total, a + total]]);
            }
            start += count;
            holes.push(start as usize);
        }
        holes.pop();
        let mut indices: Vec<u32> = Vec::new();
        Earcut::new().earcut(
            points.iter().copied(),
            &holes.iter().map(|&h| h as u32).collect::<Vec<_>>(),
            &mut indices,
        );
        for t in indices.chunks_exact(3) {
            let [a, b, c] = [t[0], t[1], t[2]].map(|i| DVec2::from_array(points[i as usize]));
            let [a, b, c] =
                if (b - a).perp_dot(c - a) < 0.0 { [t[0], t[2], t[1]] } else { [t[0], t[1], t[2]] }.map(|i| first + i);
            ends.extend([[a, c, b], [a + total, b + total, c + total]]);
        }
    }
    let wall_count = walls.len();
    mesh.triangles = walls;
    mesh.triangles.extend(ends);
    let part = |name: &str, triangles| Part { name: name.to_owned(), triangles, measured: false };
    mesh.parts = vec![part("wall", 0..wall_count), part("ends", wall_count..mesh.triangles.len())];
    debug_assert!(mesh.positions_mm.iter().all(|p: &DVec3| p.is_finite()));
    mesh
}
