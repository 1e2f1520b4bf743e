//! The transverse section of the work while it is being cut, and the cutter, as bodies for pictures.
//!
//! In: a job and a number of strokes. Out: the blank after exactly these strokes, none left out: a blank field of one
//! slice, which is the whole face, cut in the pose of every stroke when the middle of the face is cut. It serves the
//! pictures of the cut as it happens; what is measured comes from the fields of the whole job, in which the feed may go
//! on during a stroke.
//!
//! Chords of the drawn cutter lie within `CHORD_MM` of its edge, far below a pixel.

use crate::process::shaping::ShapingJob;
use crate::surface::BlankMesh;
use crate::surface::mesh::{Mesh, MeshPart};
use crate::surface::plane_area::{sides_of_contours, triangles_inside};
use gearcut_core::cut::BlankOperation;
use gearcut_core::cut::cpu::blank;
use gearcut_core::dexel::{BlankField, BlankGrid};
use gearcut_core::error::Refusal;
use gearcut_core::frame::Rigid2;
use gearcut_core::gear::blank_outline::BlankOutline;
use gearcut_core::passes::StrokeSet;
use gearcut_core::passes::planar::strokes::{StrokeLaw, cubic_through};
use gearcut_core::tool::{CuttingTool, PlanarTool};
use glam::DVec2;
use std::f64::consts::TAU;

/// Largest distance between chords and the cutter's edge, mm.
const CHORD_MM: f64 = 2e-3;
/// Corners of the drawn cutter's bore.
const BORE_CORNERS: usize = 96;

/// Section that grows smaller stroke by stroke.
#[derive(Debug)]
pub struct CutSection<'a> {
    job: &'a ShapingJob,
    /// One slice over the whole face.
    field: BlankField,
    /// Strokes that have been cut, over all operations.
    done: usize,
}

impl<'a> CutSection<'a> {
    /// The uncut blank, with rays as far apart as in the scene's blank field.
    ///
    /// # Errors
    /// A field that does not fit in memory.
    pub fn new(job: &'a ShapingJob) -> Result<Self, Refusal> {
        let outline = BlankOutline::new(&job.blank);
        let gear = &job.scene.gear;
        let spacing_mm = job.scene.fields.blank_spacing_mm;
        let grid = BlankGrid::new(&job.blank, &outline, gear.face_width_mm, spacing_mm, None)?;
        let field = BlankField::new(grid, &outline);
        Ok(Self { job, field, done: 0 })
    }

    /// Strokes of all operations together.
    pub fn strokes(job: &ShapingJob) -> usize {
        job.operations.iter().map(|operation| operation.strokes.count()).sum()
    }

    /// Operation and stroke of a stroke counted over all operations.
    pub fn operation_and_stroke(job: &ShapingJob, stroke: usize) -> (usize, usize) {
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
    pub fn work_from_tool(job: &ShapingJob, stroke: usize) -> Rigid2 {
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
        let reach_mm = BlankOutline::new(&self.job.blank).reach_mm();
        let (cutter, first) = (&self.job.cutter, self.done);
        let count = until.saturating_sub(first);
        let first_pass = first as u32 * cutter.blade_count();
        let strokes = StrokeSet::new(first_pass, cutter, StrokeLaw::Frozen, count, |stroke| {
            Self::work_from_tool(self.job, first + stroke as usize)
        });
        let teeth = self.job.planar().closed_teeth(&strokes, reach_mm);
        let operation = BlankOperation {
            strokes: &strokes,
            returns: None,
            tool: cutter,
            teeth: &teeth,
            blank_reach_mm: reach_mm,
            cull: true,
        };
        // The field is what is asked for; nothing stops this, and what each pass removed is not needed.
        let _removed = blank::cut(&mut self.field, &operation, &|| true);
        self.done = first + count;
    }

    /// Area of the section, mm^2: the mean of both families of rays.
    #[cfg(feature = "testing")]
    pub fn area_mm2(&self) -> f64 {
        let [x, y] = self.field.areas_mm2()[0];
        0.5 * (x + y)
    }

    /// The section as a body over the whole face, turned by an angle about the gear's axis.
    pub fn solid(&self, turn: DVec2) -> Mesh {
        let mut mesh = BlankMesh::new(&self.field, None).mesh;
        for position in &mut mesh.positions_mm {
            *position = turn.rotate(position.truncate()).extend(position.z);
        }
        mesh
    }
}

/// The cutter's edges, one tooth after the other round its axis, chords within about `chord_mm`; cutter frame, mm.
pub fn cutter_outline(job: &ShapingJob, chord_mm: f64) -> Vec<DVec2> {
    // A tooth begins where the one before it ends, but for pitch errors.
    let mut tooth = job.cutter.edge().points_mm(chord_mm);
    tooth.pop();
    let blades = 0..job.cutter.blade_count();
    blades.flat_map(|blade| tooth.iter().map(move |&p| job.cutter.tool_from_blade(blade).point(p))).collect()
}

/// The whole cutter as a body between two heights, placed in the plane.
pub fn cutter_solid(job: &ShapingJob, [low_mm, high_mm]: [f64; 2], place: &Rigid2) -> Mesh {
    let mut points_mm = cutter_outline(job, CHORD_MM);
    let lengths = [points_mm.len(), BORE_CORNERS];
    let bore_mm = 0.35 * job.cutter.pitch_radius_mm;
    let corner = |i: usize| bore_mm * DVec2::from_angle(TAU * i as f64 / BORE_CORNERS as f64);
    points_mm.extend((0..BORE_CORNERS).rev().map(corner));
    for point in &mut points_mm {
        *point = place.point(*point);
    }
    prism(&points_mm, &sides_of_contours(&lengths), [low_mm, high_mm])
}

/// Walls and two ends over the sides of contours (outer ones counter-clockwise, holes clockwise).
fn prism(points_mm: &[DVec2], sides: &[[usize; 2]], ends_mm: [f64; 2]) -> Mesh {
    let total = points_mm.len() as u32;
    let positions_mm = ends_mm.iter().flat_map(|&z| points_mm.iter().map(move |p| p.extend(z))).collect();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for side in sides {
        let [a, b] = side.map(|i| i as u32);
        triangles.extend([[a, b, b + total], [a, b + total, a + total]]);
    }
    let walls = triangles.len();
    // Contours that cross have no ends; the chord between two teeth is far longer than pitch errors.
    for triangle in triangles_inside(points_mm, sides).unwrap_or_default() {
        let [a, b, c] = triangle.map(|i| i as u32);
        triangles.extend([[a, c, b], [a + total, b + total, c + total]]);
    }
    let part = |name: &str, triangles| MeshPart { name: name.to_owned(), triangles, measured: false };
    let parts = vec![part("wall", 0..walls), part("ends", walls..triangles.len())];
    Mesh { positions_mm, triangles, parts, ..Mesh::default() }
}
