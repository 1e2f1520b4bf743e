//! The stages of a run with what each is expected to take: for the time left of the whole command.
//!
//! In: the job, what is written, what the process knows of its own stages. Out: names of stages with seconds for each
//! tooth, flank, window or picture, estimated by trial. Only their proportions count: the pace of what is done says how
//! fast this machine and this scene are.
//!
//! Road not taken: the cost that `check` estimates. It follows cutting alone, and most stages draw and write.

use super::parts::Part;
use super::{Tools, needs_surfaces};
use crate::job::GearJob;

/// What a process takes where processes differ.
#[derive(Debug, Clone, Copy)]
pub struct Costs<'a> {
    /// Stages of its own, with seconds for a tooth.
    pub before: &'a [(&'static str, f64)],
    /// For cutting and measuring a flank, s.
    pub flank_s: f64,
    /// For cutting a root that only meshes show, s; 0 where roots are measured with the flanks.
    pub root_s: f64,
    /// For a tooth's share of the blank, s.
    pub blank_s: f64,
}

/// Stages of a run with expected seconds; `frames` is how many pictures of the cut as it happens are drawn.
pub fn plan(job: &dyn GearJob, tools: &Tools, frames: Option<u32>, costs: &Costs) -> Vec<(&'static str, f64)> {
    let (scene, parts) = (job.scene(), tools.parts);
    let teeth = f64::from(scene.gear.teeth);
    let share = |part: Part, seconds: f64| if parts.has(part) { seconds } else { 0.0 };
    let mut stages: Vec<(&'static str, f64)> =
        costs.before.iter().map(|(name, tooth_s)| (*name, tooth_s * teeth)).collect();
    stages.extend([
        ("cut", 2.0 * teeth * (costs.flank_s + share(Part::Maps, 0.03) + share(Part::Meshes, 0.005))),
        ("texture", 0.1 * scene.textures.len() as f64),
        ("cut the whole blank", costs.blank_s * teeth),
        ("tables and charts", 0.1 + share(Part::Chips, 0.4) + share(Part::Axes, 0.8)),
        ("sheets", share(Part::Pictures, 0.008 * teeth)),
        ("deviation maps", share(Part::Maps, 0.012 * teeth)),
        ("roots", if needs_surfaces(job, parts) { costs.root_s * teeth } else { 0.0 }),
        ("tips", if needs_surfaces(job, parts) { 0.005 * teeth } else { 0.0 }),
        ("meshes", share(Part::Meshes, 0.02 * teeth)),
        ("pictures", share(Part::Pictures, 1.6 * scene.pictures.len() as f64)),
        ("frames", frames.map_or(0.0, |count| 0.5 * f64::from(count))),
        ("axis programs", share(Part::Axes, 0.2)),
        ("report", share(Part::Report, 0.01 * teeth)),
        ("checksums", 0.1 + share(Part::Maps, 0.01 * teeth)),
    ]);
    stages
}
