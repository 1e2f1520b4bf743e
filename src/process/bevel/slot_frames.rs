//! One slot of a bevel gear as frames show it: the blades of the head roll through it, pass by pass.
//!
//! In: a job. Out: the first slot between its neighbours, which are uncut, after a number of passes of all operations;
//! the blades about the work at a pass. The work rests in the picture and the head moves against it, as the tooth sees
//! it. What is drawn of a blade is its edge, closed behind its tip, and a thickness.
//!
//! The slot is cut from the uncut blank for every frame: one cell takes a few hundredths of a second.

use super::blank::CellGrid;
use super::body::of_cells;
use super::job::BevelJob;
use crate::steps::frames::{CutByStep, SIZE_PX, place};
use crate::surface::mesh::Mesh;
use crate::surface::prism::blade;
use crate::surface::render::Camera;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::cut::{SweptBy, SweptField};
use gearcut_core::dexel::Layer;
use gearcut_core::error::Result;
use gearcut_core::frame::Rigid3;
use gearcut_core::passes::TurningPasses;
use gearcut_core::units::TURN_RAD;
use glam::{DMat3, DVec3};

/// The slot that is followed, and its neighbours.
const SLOT: u32 = 0;
/// Chords of a drawn edge, mm.
const CHORD_MM: f64 = 0.02;
/// Thickness of a drawn blade, as a share of the way from blade to blade.
const THICKNESS: f64 = 0.3;
/// Elevation of the viewer over the pitch cone at the heel, rad.
const ELEVATION_RAD: f64 = 0.9;

/// The slot as it is cut.
pub struct SlotFrames<'a> {
    job: &'a BevelJob,
    grid: CellGrid,
    /// Its cell after the passes so far.
    layer: Layer,
}

impl<'a> SlotFrames<'a> {
    /// The uncut slot, with rays as far apart as in the scene's blank field.
    ///
    /// # Errors
    /// Rays that do not fit in memory.
    pub fn new(job: &'a BevelJob) -> Result<Self> {
        let grid = CellGrid::of_scene(job)?;
        let layer = grid.field(job, SLOT).blank_layer();
        Ok(Self { job, grid, layer })
    }

    fn sets(&self) -> impl Iterator<Item = &TurningPasses> {
        (0..self.job.operations.len()).map(|operation| self.job.slots.of(operation, SLOT))
    }

    fn place(&self, step: usize) -> (usize, u32) {
        let (operation, own) = place(self.sets().map(|set| set.count() as usize), step);
        (operation, own as u32)
    }

    /// The first slot between uncut ones.
    fn body(&self, layer: &Layer) -> Mesh {
        let teeth = self.job.blank.teeth;
        let uncut = self.grid.field(self.job, SLOT).blank_layer();
        let cells = [(teeth - 1, uncut.clone()), (SLOT, layer.clone()), (1, uncut)];
        of_cells(self.job, &self.grid, &cells, self.job.scene.fields.blank_spacing_mm)
    }

    /// Pose in the gear of the head with its blades where they are at a step, and the angle that it has turned, rad.
    fn gear_from_tool(&self, step: usize) -> (Rigid3, f64) {
        let (operation, own) = self.place(step);
        let set = self.job.slots.of(operation, SLOT);
        let pass = set.pass(own);
        (set.work_from_tool(&pass), set.turn * pass.tool_angle_rad)
    }
}

impl CutByStep for SlotFrames<'_> {
    fn steps(&self) -> usize {
        self.sets().map(|set| set.count() as usize).sum()
    }

    fn advance(&mut self, until: usize) -> Result<()> {
        let mut rest = until as u32;
        let mut done = Vec::new();
        for set in self.sets() {
            done.push(set.first(rest));
            rest -= rest.min(set.count());
        }
        let operations = done.iter().map(|set| vec![set]).collect();
        let field = self.grid.field(self.job, SLOT);
        let layers = SweptField { field, operations, by: SweptBy::NearPasses }.cut(&Cpu::default())?.layers;
        self.layer = layers.into_iter().next_back().expect("a job has at least one operation");
        Ok(())
    }

    fn work(&self, _: usize) -> Result<Mesh> {
        Ok(self.body(&self.layer))
    }

    fn tool(&self, step: usize) -> Result<Vec<Mesh>> {
        let head = &self.job.head;
        let tool = head.tool()?;
        let (gear_from_tool, turned_rad) = self.gear_from_tool(step);
        let between_rad = TURN_RAD / f64::from(head.blades());
        let behind_mm = THICKNESS * between_rad * head.radius_mm;
        let near_rad = head.half_window_rad + between_rad;
        let is_near = |blade: &u32| {
            let from_work = turned_rad + between_rad * f64::from(*blade);
            (from_work - TURN_RAD * (from_work / TURN_RAD).round()).abs() < near_rad
        };
        let drawn = |index: u32| {
            let mut mesh = blade(&tool, index, 1.0, behind_mm, CHORD_MM);
            mesh.positions_mm.iter_mut().for_each(|at| *at = gear_from_tool.point(*at));
            mesh
        };
        Ok((0..head.blades()).filter(is_near).map(drawn).collect())
    }

    fn camera(&self) -> Result<Camera> {
        let held = self.body(&self.grid.field(self.job, SLOT).blank_layer()).positions_mm;
        let (sin, cos) = self.job.blank.pitch_angle_rad.sin_cos();
        let middle_rad = self.job.slot_middle_rad(0.0)?;
        let turn = DMat3::from_rotation_z(middle_rad);
        // Away from the apex along the pitch cone, and out of it.
        let [to_heel, out] = [DVec3::new(sin, 0.0, -cos), DVec3::new(cos, 0.0, sin)].map(|axis| turn * axis);
        let towards = ELEVATION_RAD.cos() * to_heel + ELEVATION_RAD.sin() * out;
        Ok(Camera::new(DVec3::ZERO, towards, out, 1.0, SIZE_PX).fitted(&held))
    }

    fn title(&self, until: usize) -> String {
        let (operation, own) = self.place(until.saturating_sub(1));
        let after = if until == 0 { 0 } else { own + 1 };
        let count = self.job.slots.of(operation, SLOT).count();
        format!("{}: pass {after} of {count} through the first slot", self.job.operations[operation].spec.name)
    }

    fn note(&self) -> &'static str {
        "the first slot between uncut ones, seen from the heel; the head moves, the work rests"
    }
}
