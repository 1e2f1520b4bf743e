//! What can be typed behind several commands.

use crate::notices::{NoticePattern, NoticeRules};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// A scene and what is changed in it.
#[derive(Debug, Args)]
pub struct SceneArguments {
    /// Scene file (TOML).
    pub scene: PathBuf,
    /// Put another value into the scene, such as gear.module_mm=2.5 or operation.rough.offset_mm=1.5; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,
}

/// How gears are cut.
#[derive(Debug, Args)]
pub struct ComputeArguments {
    /// What computes: auto takes a real GPU that answers within ten seconds; cut tries it first, on tiles of flanks and
    /// on passes over the whole blank of the scene, and takes it for what it cuts faster [default: auto for cut; cpu
    /// for few places at a time, where it is fastest].
    #[arg(long, value_enum)]
    pub backend: Option<BackendChoice>,
    /// Show no progress and no summary of a cut.
    #[arg(long)]
    pub quiet: bool,
}

/// How gears are cut, and how the command ends.
#[derive(Debug, Args)]
pub struct RunArguments {
    /// Backend and progress.
    #[command(flatten)]
    pub compute: ComputeArguments,
    /// What makes the verdict bad.
    #[command(flatten)]
    pub verdict: VerdictArguments,
}

/// Notices that set the exit code.
#[derive(Debug, Args)]
pub struct VerdictArguments {
    /// End with exit code 3 on this notice, an id or the beginning of ids and a star, such as 'texture.*'
    /// (docs/notices.md); may be repeated.
    #[arg(long, value_name = "ID")]
    pub deny: Vec<NoticePattern>,
    /// Do not end with exit code 3 on this fault; may be repeated.
    #[arg(long, value_name = "ID")]
    pub allow: Vec<NoticePattern>,
}

impl VerdictArguments {
    /// The rules.
    pub fn rules(&self) -> NoticeRules {
        NoticeRules { denied: self.deny.clone(), allowed: self.allow.clone() }
    }
}

/// What computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum BackendChoice {
    /// A real GPU where there is one (cut: for what it cuts faster), else the processor.
    Auto,
    /// A GPU, or a software adapter where there is none; fail without either.
    Gpu,
    /// The processor, in double precision.
    Cpu,
}

/// What to do when a GPU fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum GpuFailureChoice {
    /// Cut the flank again on the processor.
    Redo,
    /// Stop the run.
    Stop,
}
