//! Which machine cuts: a real GPU if there is one and it is faster, else the processor; anything else only when asked
//! for.
//!
//! Whether a GPU is faster depends on the scene: a run tries it on tiles of its own ([`Choice::on_trial`]).
//! The native backend is faster than a software adapter on the same cores, so llvmpipe and its like are for checking
//! the shaders. A build without the feature `gpu` has the native backend alone, and says so wherever a GPU could be
//! asked for.

#[cfg(feature = "gpu")]
mod with_gpu;
#[cfg(not(feature = "gpu"))]
mod without_gpu;

use gearcut_core::cut::Backend;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::error::Result;
#[cfg(feature = "gpu")]
use with_gpu as build;
#[cfg(not(feature = "gpu"))]
use without_gpu as build;

pub use build::{Devices, bench_machines, devices, drivers_asked};

/// What `--backend` says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BackendWish {
    /// A real GPU if it is faster on the scene's own tiles, else the processor.
    #[default]
    Auto,
    /// A real GPU, else a software adapter, else an error.
    Gpu,
    /// The processor.
    Cpu,
}

/// What to do when a GPU fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OnFailure {
    /// Cut the flank again on the processor, and say so.
    #[default]
    RedoNatively,
    /// Stop the run with the problem.
    Stop,
}

/// A backend and the reason for it, for the run record.
pub struct Choice {
    /// The backend.
    pub backend: Box<dyn Backend>,
    /// One line.
    pub why: String,
    /// A GPU that nobody asked for by name: a run takes it if it is faster than the processor on the scene's own tiles.
    pub on_trial: bool,
}

impl Choice {
    /// The backend of those who try none: the processor where a GPU would be on trial.
    pub fn untried<'a>(&'a self, processor: &'a Cpu) -> &'a dyn Backend {
        if self.on_trial { processor } else { self.backend.as_ref() }
    }
}

/// The backend for a wish.
///
/// # Errors
/// A GPU was asked for, and there is none, it does not work, or this build has no GPU backend.
pub fn choose(wish: BackendWish, on_failure: OnFailure) -> Result<Choice> {
    match wish {
        BackendWish::Cpu => Ok(native("chosen by --backend cpu".into())),
        BackendWish::Gpu => build::gpu(on_failure),
        BackendWish::Auto => Ok(build::any(on_failure)),
    }
}

fn native(why: String) -> Choice {
    Choice { backend: Box::new(Cpu::default()), why, on_trial: false }
}
