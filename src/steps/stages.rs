//! The stages of a run with what each is expected to take: for the time left of the whole command.
//!
//! In: the job, what is written, what the process knows of its own stages. Out: names of stages with seconds for each
//! tooth, flank, window or picture: processor time of whole runs of shipped scenes, stage by stage. For the time left
//! only the proportions count: the pace of what is done says how fast this machine and this scene are.
//!
//! Road not taken: what `check` finds on samples ([`super::forecast`]). They take a moment, in which nothing would
//! show; `check` takes from here what is not cutting.

use super::needs_surfaces;
use super::parts::{Part, Parts};
use crate::job::GearJob;
use crate::scene::model::WindowSides;
use crate::texture::default_teeth;

/// What a process takes where processes differ.
#[derive(Debug, Clone, Copy)]
pub struct Costs<'a> {
    /// Stages of its own, with seconds for a tooth.
    pub before: &'a [(&'static str, f64)],
    /// For cutting and measuring a flank, s.
    pub flank_s: f64,
    /// For the chips that are followed on the maps of a flank, s.
    pub map_chips_s: f64,
    /// For a texture window, s.
    pub window_s: f64,
    /// For a picture, s.
    pub picture_s: f64,
    /// For cutting a root that only meshes show, s; 0 where roots are measured with the flanks.
    pub root_s: f64,
    /// For a tooth's share of the blank, s.
    pub blank_s: f64,
    /// For a tooth's share of what is found between the stages: crossings, roots, findings, s.
    pub between_s: f64,
}

/// How many texture windows there are: those of the scene, or both flanks of the teeth that have them by default.
fn windows(job: &dyn GearJob) -> f64 {
    match job.scene().textures.as_slice() {
        [] => 2.0 * default_teeth(job).len() as f64,
        asked => asked.iter().map(|window| if window.sides == WindowSides::Both { 2.0 } else { 1.0 }).sum(),
    }
}

/// What a whole run takes beside flanks, blank and chips: measuring texture, drawing, writing, s of one core.
pub fn beside_cutting_s(job: &dyn GearJob, costs: &Costs) -> f64 {
    let beside = Costs { before: &[], flank_s: 0.0, map_chips_s: 0.0, blank_s: 0.0, ..*costs };
    let stages: f64 = plan(job, Parts::all(), None, &beside).iter().map(|(_, seconds)| seconds).sum();
    stages + costs.between_s * f64::from(job.scene().gear.teeth)
}

/// Stages of a run with expected seconds; `frames` is how many pictures of the cut as it happens are drawn.
pub fn plan(job: &dyn GearJob, parts: Parts, frames: Option<u32>, costs: &Costs) -> Vec<(&'static str, f64)> {
    let scene = job.scene();
    let teeth = f64::from(scene.gear.teeth);
    let share = |part: Part, seconds: f64| if parts.has(part) { seconds } else { 0.0 };
    let mut stages: Vec<(&'static str, f64)> =
        costs.before.iter().map(|(name, tooth_s)| (*name, tooth_s * teeth)).collect();
    let drawn = parts.has_any(&[Part::Maps, Part::Pictures]);
    let chips_s = if drawn { costs.map_chips_s } else { 0.0 };
    stages.extend([
        ("cut", 2.0 * teeth * (costs.flank_s + chips_s + share(Part::Maps, 0.003) + share(Part::Meshes, 0.001))),
        ("texture", costs.window_s * windows(job)),
        ("cut the whole blank", costs.blank_s * teeth),
        ("tables and charts", 0.02 + share(Part::Chips, 0.2)),
        ("sheets", share(Part::Pictures, 0.005 * teeth)),
        ("flank pictures", share(Part::Maps, 0.01 * teeth.min(10.0))),
        ("roots", if needs_surfaces(job, parts) { costs.root_s * teeth } else { 0.0 }),
        ("tips", if needs_surfaces(job, parts) { 0.004 * teeth } else { 0.0 }),
        ("meshes", share(Part::Meshes, 0.002 * teeth)),
        ("pictures", share(Part::Pictures, costs.picture_s * scene.pictures.len() as f64)),
        ("frames", frames.map_or(0.0, |count| 0.5 * f64::from(count))),
        ("axis programs", share(Part::Axes, 0.05)),
        ("report", share(Part::Report, 0.003 * teeth)),
        ("checksums", 0.02 + share(Part::Maps, 0.002 * teeth)),
    ]);
    stages
}
