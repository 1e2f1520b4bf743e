//! gearcut as a library: a scene, a job, its flanks, its findings.
//!
//! In: a [`LoadedScene`]. Out: a [`Job`], which cuts single flanks for programs that look at surfaces, and whole gears
//! with all files for programs that replace the command line. What it needs beyond that (the backend, progress, Ctrl-C,
//! the parts that are written) has defaults and is named when it differs: [`Run`].
//!
//! Heights are normal deviations: from the target flank along its outward normal, positive where material is left.

use crate::backend::{self, BackendWish, Choice, OnFailure};
use crate::job::{GearJob, rows_z_mm};
use crate::process::{self, ProcessJob};
use crate::run::Run;
use crate::scene::LoadedScene;
use gearcut_core::dexel::{Layer, NO_PASS, Ray};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec3;

/// A scene made ready to cut, with what cuts it.
pub struct Job<'a> {
    scene: &'a LoadedScene,
    prepared: Box<dyn ProcessJob>,
    choice: Choice,
}

impl<'a> Job<'a> {
    /// Makes a scene ready; the processor cuts it.
    ///
    /// # Errors
    /// Geometry that cannot be cut; [`LoadedScene::explain`] finds the key that says so.
    pub fn new(scene: &'a LoadedScene) -> Result<Self> {
        let choice = backend::choose(BackendWish::Cpu, OnFailure::default())?;
        Ok(Self { scene, prepared: process::prepare(&scene.scene)?, choice })
    }

    /// The same on another backend: [`backend::choose`].
    #[must_use]
    pub fn on(self, choice: Choice) -> Self {
        Self { choice, ..self }
    }

    /// Cuts one flank with the scene's spacing through all operations.
    ///
    /// `tooth` counts from 1, counter-clockwise. Nothing is written.
    ///
    /// # Errors
    /// A tooth that the gear does not have, a flank that the tool does not generate, the backend's.
    pub fn cut_flank(&self, tooth: u32, side: Side) -> Result<Flank> {
        let mut flank = None;
        self.prepared.with_gear(&mut |gear| {
            flank = Some(Flank::cut(gear, &self.choice, tooth, side)?);
            Ok(())
        })?;
        Ok(flank.expect("a job shows its gear"))
    }

    /// A run of the whole job: all flanks, the blank, and every file that `gearcut cut` writes.
    pub fn run(&self) -> Run<'_> {
        Run::new(self.scene, self.prepared.as_ref(), &self.choice)
    }
}

/// One flank after all operations: dexels on a grid of places along the profile and along the tooth.
#[derive(Debug, Clone)]
pub struct Flank {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Which of its flanks.
    pub side: Side,
    /// Arcs of the target profile from the form point to the tip, mm, increasing: the columns.
    pub arcs_mm: Vec<f64>,
    /// Places along the tooth from the middle of the face, mm, increasing: the rows.
    pub face_mm: Vec<f64>,
    /// Names of the operations in their order.
    pub operations: Vec<String>,
    layers: Vec<Layer>,
    /// Target point and unit normal of each column, row after row.
    target: Vec<Vec<Ray>>,
}

impl Flank {
    fn cut(gear: &dyn GearJob, choice: &Choice, tooth: u32, side: Side) -> Result<Self> {
        let scene = gear.scene();
        let teeth = scene.gear.teeth;
        if !(1..=teeth).contains(&tooth) {
            let problem = format!("tooth {tooth} is asked for, the gear has {teeth}");
            return Err(Refusal::new("gear.teeth", problem, "ask for a tooth from 1 to the number of teeth").into());
        }
        let face_mm = rows_z_mm(scene.gear.face_width_mm, scene.fields.lead_spacing_mm);
        let (arcs_mm, target) = gear.target_points(tooth, side, scene.fields.profile_spacing_mm, &face_mm)?;
        let layers = gear.cut_flank(choice.backend.as_ref(), tooth, side, &arcs_mm, &face_mm)?;
        let operations = gear.operations().into_iter().map(|(name, _)| name.to_owned()).collect();
        Ok(Self { tooth, side, arcs_mm, face_mm, operations, layers, target })
    }

    /// Index of an operation in [`Flank::operations`].
    pub fn operation(&self, name: &str) -> Option<usize> {
        self.operations.iter().position(|operation| operation == name)
    }

    fn dexel(&self, column: usize, row: usize) -> usize {
        assert!(column < self.arcs_mm.len() && row < self.face_mm.len(), "dexel ({column}, {row}) is off the flank");
        column * self.face_mm.len() + row
    }

    /// Pass that left the surface after an operation; `None` where no pass came.
    ///
    /// # Panics
    /// Indices beyond the flank's.
    pub fn pass(&self, operation: usize, column: usize, row: usize) -> Option<u32> {
        Some(self.layers[operation].passes[self.dexel(column, row)]).filter(|&pass| pass != NO_PASS)
    }

    /// Normal deviation after an operation, um; `None` where no pass came, so that the blank's own surface stands
    /// there.
    ///
    /// # Panics
    /// Indices beyond the flank's.
    pub fn deviation_um(&self, operation: usize, column: usize, row: usize) -> Option<f64> {
        self.pass(operation, column, row)?;
        Some(f64::from(self.layers[operation].heights_mm[self.dexel(column, row)]) * UM_PER_MM)
    }

    /// Place of the surface after an operation, gear frame, mm: the target's point and the deviation along its normal;
    /// `None` where no pass came.
    ///
    /// # Panics
    /// Indices beyond the flank's.
    pub fn point_mm(&self, operation: usize, column: usize, row: usize) -> Option<DVec3> {
        let height_mm = self.deviation_um(operation, column, row)? / UM_PER_MM;
        Some(self.target[row][column].at(height_mm))
    }

    /// Profile in one row after an operation: arc from the form point, mm, and normal deviation, um, where a pass came.
    ///
    /// # Panics
    /// Indices beyond the flank's.
    pub fn profile(&self, operation: usize, row: usize) -> Vec<(f64, f64)> {
        let at = |column: usize| Some((self.arcs_mm[column], self.deviation_um(operation, column, row)?));
        (0..self.arcs_mm.len()).filter_map(at).collect()
    }
}
