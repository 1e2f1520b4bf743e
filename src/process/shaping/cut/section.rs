//! The transverse section of the work while it is being cut, and the cutter, as bodies for pictures.
//!
//! In: a job and a number of strokes. Out: the blank after exactly these strokes, none left out: a blank field of one
//! slice, which is the whole face, cut in the pose of every stroke when the middle of the face is cut. It serves the
//! pictures of the cut as it happens; what is measured comes from the fields of the whole job, in which the feed may go
//! on during a stroke.
//!
//! Chords of the drawn cutter lie within `CHORD_MM` of its edge, far below a pixel.

use crate::process::shaping::ShapingJob;
use crate::steps::frames::place;
use crate::steps::whole_blank;
use crate::surface::mesh::Mesh;
use crate::surface::prism::prism;
use gearcut_core::cut::BlankOperation;
use gearcut_core::cut::cpu::blank;
use gearcut_core::dexel::BlankField;
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
        Ok(Self { job, field: whole_blank::field(&job.scene, &job.blank, true)?, done: 0 })
    }

    /// Strokes of all operations together.
    pub fn strokes(job: &ShapingJob) -> usize {
        job.operations.iter().map(|operation| operation.strokes.count()).sum()
    }

    /// Operation and stroke of a stroke counted over all operations.
    pub fn operation_and_stroke(job: &ShapingJob, stroke: usize) -> (usize, usize) {
        place(job.operations.iter().map(|operation| operation.strokes.count()), stroke)
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

    /// What is left.
    pub fn field(&self) -> &BlankField {
        &self.field
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
    prism(&cutter_contours(job, place), [low_mm, high_mm])
}

/// The whole cutter and its bore, placed in the plane, mm.
pub fn cutter_contours(job: &ShapingJob, place: &Rigid2) -> Vec<Vec<DVec2>> {
    let bore_mm = 0.35 * job.cutter.pitch_radius_mm;
    let corner = |i: usize| bore_mm * DVec2::from_angle(TAU * i as f64 / BORE_CORNERS as f64);
    let contours = [cutter_outline(job, CHORD_MM), (0..BORE_CORNERS).rev().map(corner).collect()];
    contours.into_iter().map(|contour| contour.into_iter().map(|point| place.point(point)).collect()).collect()
}
