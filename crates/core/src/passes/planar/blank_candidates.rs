//! The passes that can take material from some rays of the blank field, in order of time.
//!
//! A pass is left out only when the circle round its edge stays clear of the blank's circle or of the strip that a
//! tile's rays fill. No assumption is made about which tooth cuts where. Whether the candidates leave the same spans
//! and marks as all passes do is tested bit for bit.

use super::strokes::StrokeSet;
use crate::frame::Rigid2;
use crate::math::planar_rays::Family;
use crate::tool::PlanarTool;
use crate::tool::closed_tooth::ClosedTooth;
use glam::DVec2;

/// One tooth of the cutter in one stroke, where it stands in one slice.
#[derive(Debug, Clone, Copy)]
pub struct PlacedPass {
    /// Stroke number.
    pub stroke: u32,
    /// Blade of the tool.
    pub blade: u32,
    /// Number of its edge, and of its tooth.
    pub edge: usize,
    /// Pose of the blade.
    pub work_from_blade: Rigid2,
    /// Centre of the circle round the edge, gear frame.
    pub center_mm: DVec2,
}

/// Passes at phase `tau` whose edges come within `blank_reach_mm` of the gear axis, in order of time; `teeth` has one
/// for each edge of the tool.
pub fn passes_at(
    set: &StrokeSet,
    tau: f64,
    tool: &dyn PlanarTool,
    teeth: &[ClosedTooth],
    blank_reach_mm: f64,
) -> Vec<PlacedPass> {
    let blades: Vec<(usize, Rigid2)> =
        (0..tool.blade_count()).map(|blade| (tool.edges().index_of(blade), tool.tool_from_blade(blade))).collect();
    let mut passes = Vec::new();
    for stroke in 0..set.count() {
        let pose = set.pose_at(stroke, tau);
        for (blade, (edge, tool_from_blade)) in blades.iter().enumerate() {
            let (tooth, work_from_blade) = (&teeth[*edge], pose.after(tool_from_blade));
            let center_mm = work_from_blade.point(tooth.center_mm);
            if center_mm.length() <= blank_reach_mm + tooth.reach_mm {
                passes.push(PlacedPass {
                    stroke: stroke as u32,
                    blade: blade as u32,
                    edge: *edge,
                    work_from_blade,
                    center_mm,
                });
            }
        }
    }
    passes
}

/// Indices of the passes that reach the strip between two rays of a family.
pub fn reaching_strip<'a>(
    passes: &'a [PlacedPass],
    teeth: &'a [ClosedTooth],
    family: Family,
    [low_mm, high_mm]: [f64; 2],
) -> impl Iterator<Item = &'a PlacedPass> {
    passes.iter().filter(move |pass| {
        let reach_mm = teeth[pass.edge].reach_mm;
        let across = family.across(pass.center_mm);
        across + reach_mm >= low_mm && across - reach_mm <= high_mm
    })
}
