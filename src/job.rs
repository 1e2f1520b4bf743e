//! A scene made ready to cut: one variant per process, each with what its process needs before the first dexel is cut.
//!
//! In: the checked scene. Out: [`Prepared`], which holds pitch curve, tool, blank, linkages and passes. What the processes share lives in the modules they
//! are made of; a process adds its own job here and nothing else.

mod blank;
pub mod gear_job;
pub mod hobbed;
mod hobbed_blank;
mod hobbed_surfaces;
pub mod hobbing;
mod shaped_surfaces;
pub mod shaping;

use crate::error::Result;
use crate::scene::Scene;
use crate::scene::model::Process;

pub use blank::CutBlank;
pub use gear_job::GearJob;
pub use hobbed::{HobCutter, HobbedFlank};
pub use hobbed_blank::HobbedBlank;
pub use hobbing::HobbingJob;
pub use shaping::{CutFlank, Job, PreparedOperation};

/// A scene made ready, by its process.
#[derive(Debug)]
pub enum Prepared {
    /// Shaping with a pinion cutter.
    Shaping(Box<Job>),
    /// Hobbing.
    Hobbing(Box<HobbingJob>),
}

impl Prepared {
    /// Makes a scene ready.
    ///
    /// # Errors
    /// Geometry that cannot be cut: see the parts.
    pub fn new(scene: &Scene) -> Result<Self> {
        Ok(match &scene.process {
            Process::Shaping(_) => Self::Shaping(Box::new(Job::new(scene.clone())?)),
            Process::Hobbing(_) => Self::Hobbing(Box::new(HobbingJob::new(scene)?)),
        })
    }
}
