//! A cylindrical gear's cut as frames show it: the transverse section in the middle of the face, drawn as a body over
//! the whole face.
//!
//! In: a section that grows smaller step by step, the tool in it ([`SectionByStep`]). Out: what frames draw.
//!
//! Work and tool lie as on the machine: the line of centres stays, the gear and the tool turn. The tool is drawn above
//! the face; its height is a drawing's, not the tool's.

use super::{CutByStep, SIZE_PX};
use crate::surface::BlankMesh;
use crate::surface::mesh::Mesh;
use crate::surface::prism::prism;
use crate::surface::render::Camera;
use gearcut_core::dexel::BlankField;
use gearcut_core::error::Result;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Steps at which the tool is looked at so that the camera holds it through all of them.
const CAMERA_STEPS: usize = 40;

/// A cut that can be followed step by step in the middle of the face.
pub trait SectionByStep {
    /// Steps of all operations together.
    fn steps(&self) -> usize;

    /// Cuts all steps before step `until`.
    ///
    /// # Errors
    /// The cut's.
    fn advance(&mut self, until: usize) -> Result<()>;

    /// What is left: one slice over the whole face.
    fn field(&self) -> &BlankField;

    /// The tool's axis at a step, where it goes through the section; gear frame, mm.
    fn axis_mm(&self, step: usize) -> DVec2;

    /// The tool in the section at a step, part by part: contours, counter-clockwise outside and clockwise round holes;
    /// gear frame, mm.
    ///
    /// # Errors
    /// A tool without sections.
    fn tool_mm(&self, step: usize) -> Result<Vec<Vec<Vec<DVec2>>>>;

    /// Heights between which the tool is drawn, from the middle of the face, mm.
    fn tool_z_mm(&self) -> [f64; 2];

    /// Operation and number of the last step before `until`.
    fn title(&self, until: usize) -> String;
}

/// Such a cut for frames.
pub struct InSection<T>(pub T);

impl<T: SectionByStep> InSection<T> {
    /// Turn from the gear frame into the machine, where the tool's axis lies at positive x, as a unit vector.
    fn machine_from_gear(&self, step: usize) -> DVec2 {
        let along = self.0.axis_mm(step).normalize_or(DVec2::X);
        DVec2::new(along.x, -along.y)
    }
}

impl<T: SectionByStep> CutByStep for InSection<T> {
    fn steps(&self) -> usize {
        self.0.steps()
    }

    fn advance(&mut self, until: usize) -> Result<()> {
        self.0.advance(until)
    }

    fn work(&self, step: usize) -> Result<Mesh> {
        Ok(section_body(self.0.field(), self.machine_from_gear(step)))
    }

    fn tool(&self, step: usize) -> Result<Vec<Mesh>> {
        let machine_from_gear = self.machine_from_gear(step);
        let mut parts = self.0.tool_mm(step)?;
        parts.iter_mut().flatten().flatten().for_each(|point| *point = machine_from_gear.rotate(*point));
        Ok(parts.iter().map(|contours| prism(contours, self.0.tool_z_mm())).collect())
    }

    fn camera(&self) -> Result<Camera> {
        let mut points: Vec<DVec3> = Vec::new();
        for look in 0..=CAMERA_STEPS {
            let step = (self.steps() - 1) * look / CAMERA_STEPS;
            points.extend(self.tool(step)?.into_iter().flat_map(|part| part.positions_mm));
        }
        let work = section_body(self.0.field(), DVec2::X);
        let radius_mm = work.positions_mm.iter().map(|at| at.truncate().length()).fold(0.0, f64::max);
        let ring = |z: f64| (0..24).map(move |i| (radius_mm * DVec2::from_angle(f64::from(i) * TAU / 24.0)).extend(z));
        let heights_mm = work.positions_mm.iter().map(|at| at.z);
        for z_mm in heights_mm.fold([0.0_f64; 2], |[low, high], z| [low.min(z), high.max(z)]) {
            points.extend(ring(z_mm));
        }
        let towards = Camera::direction(DVec3::NEG_Y, DVec3::X, 0.0, 0.85);
        Ok(Camera::new(DVec3::ZERO, towards, DVec3::Z, 1.0, SIZE_PX).fitted(&points))
    }

    fn title(&self, until: usize) -> String {
        self.0.title(until)
    }

    fn note(&self) -> &'static str {
        "section in the middle of the face"
    }
}

/// A section as a body over the whole face, turned about the gear's axis.
pub fn section_body(field: &BlankField, turn: DVec2) -> Mesh {
    let mut body = BlankMesh::new(field, None).mesh;
    for position in &mut body.positions_mm {
        *position = turn.rotate(position.truncate()).extend(position.z);
    }
    body
}
