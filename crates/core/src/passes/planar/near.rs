//! The passes that can reach a region of the work at all: blade circle against region circle, for every stroke and
//! blade.
//!
//! No assumption about which tooth cuts which space: runout, pitch errors, several turns and plunges need no special
//! case.

use super::strokes::StrokeSet;
use crate::frame::Rigid2;
use crate::tool::PlanarTool;
use crate::tool::blade_edges::BladeEdges;
use arrayvec::ArrayVec;
use glam::DVec2;
use std::ops::Deref;

/// Phases at which a pass is sampled at most: three, or one where the stroke is frozen.
pub const MAX_PHASES: usize = 3;
/// Phases at which bounds look at a pass: the whole range and its middle, or the one pose of a frozen stroke.
const BOUND_PHASES: [f64; MAX_PHASES] = [-1.0, 0.0, 1.0];

/// Safety on the bend of a path that three poses show. A path of second degree leaves its chords by an eighth of the
/// second difference; what its third derivative adds is counted by itself ([`NearPass::wander_mm`]). That the edge
/// turns no more than this between two poses is not proved: the comparison with all passes in
/// `tests/suite/shaping/flank_heights.rs` stands for it.
const BEND_SAFETY: f64 = 1.5;
/// How far a point of the tool moves from its middle place during a stroke at most, in shares of what the poses at the
/// nodes show. Poses are cubics through four Chebyshev nodes ([`super::strokes::NODES`]): between and beside these no
/// cubic exceeds 1.848 times its largest value at them (the Lebesgue constant, a quarter of the sum of cot((2 k - 1) pi
/// / 16)). Planning with all passes begins with the same ones: the bound rests on this derivation alone.
const BETWEEN_NODES: f64 = 2.0;

/// Added to circles that hold edges and segments, mm: entries count up to a nanometre beyond a segment's ends.
const CIRCLE_MM: f64 = 1e-5;
/// Poses turn by less than this, or are looked at one by one: a point 100 mm away moves by 0.01 nm.
const SAME_TURN: f64 = 1e-13;
/// Poses further apart than this are looked at one by one, mm: what an edge bends on so short a way is a small part of
/// its distance from its tangent.
const LARGEST_SHIFT_MM: f64 = 0.05;

/// A pass near a region, with its poses at the phases where bounds are taken.
#[derive(Debug, Clone)]
pub struct NearPass {
    /// Stroke number.
    pub stroke: usize,
    /// Blade of the tool.
    pub blade: u32,
    /// Poses of the work in the blade frame: one when frozen, else at tau = -1, 0, 1.
    pub blade_from_work: PhasePoses,
    /// How far it leaves the parabolas through its places at these phases at most, mm: as noise of the axes lets it.
    pub wander_mm: f64,
}

/// Poses at the phases where bounds look at a pass, in their order: one or [`MAX_PHASES`].
///
/// The memory of those that a frozen stroke lacks holds its one pose as well. Compiled code places rays in all of them
/// before it asks how many there are; what happened to lie in memory that was never written took a quarter of a whole
/// run, probably numbers next to zero, with which processors take a hundred times as long.
#[derive(Debug, Clone, Copy)]
pub struct PhasePoses {
    poses: [Rigid2; MAX_PHASES],
    count: usize,
}

impl PhasePoses {
    /// The one pose of a frozen stroke.
    pub fn frozen(pose: Rigid2) -> Self {
        Self { poses: [pose; MAX_PHASES], count: 1 }
    }

    /// Poses at all phases.
    pub fn moving(poses: [Rigid2; MAX_PHASES]) -> Self {
        Self { poses, count: MAX_PHASES }
    }

    /// Poses to look at, and how far from what each of them shows the work stands in the blade's frame, phase by phase,
    /// mm. While the axes rest, a guide or a wobble shifts the work a little and turns it not at all: one look then
    /// serves all phases.
    pub fn looks(&self) -> (&[Rigid2], ArrayVec<DVec2, MAX_PHASES>) {
        let middle = self.poses[1];
        let shift = |pose: &Rigid2| pose.translation_mm - middle.translation_mm;
        let is_near = |pose: &Rigid2| {
            (pose.rotation - middle.rotation).length() < SAME_TURN && shift(pose).length() < LARGEST_SHIFT_MM
        };
        if self.count == MAX_PHASES && self.poses.iter().all(is_near) {
            return (&self.poses[1..2], self.poses.iter().map(shift).collect());
        }
        (&self.poses[..self.count], ArrayVec::from_iter([DVec2::ZERO]))
    }

    /// The same with every pose mapped to another.
    fn map(self, to: impl Fn(Rigid2) -> Rigid2) -> Self {
        if self.count == 1 { Self::frozen(to(self.poses[0])) } else { Self { poses: self.poses.map(to), ..self } }
    }
}

impl Deref for PhasePoses {
    type Target = [Rigid2];

    fn deref(&self) -> &[Rigid2] {
        &self.poses[..self.count]
    }
}

impl NearPass {
    /// Pose at the middle of the stroke.
    pub fn middle(&self) -> &Rigid2 {
        &self.blade_from_work[self.blade_from_work.len() / 2]
    }

    /// How far the path of any point within `reach_mm` of `center_mm` departs from the chords between the poses, mm.
    pub fn bend_mm(&self, center_mm: DVec2, reach_mm: f64) -> f64 {
        let [before, middle, after] = &self.blade_from_work[..] else { return 0.0 };
        let bend = |pick: &dyn Fn(&Rigid2) -> DVec2| (pick(before) - 2.0 * pick(middle) + pick(after)).length();
        let parabola_mm = bend(&|pose| pose.point(center_mm)) + bend(&|pose| pose.rotation) * reach_mm;
        BEND_SAFETY / 8.0 * parabola_mm + self.wander_mm
    }
}

/// All passes whose blade comes within `reach_mm` of `center_mm` (gear frame), in time order.
pub fn near_passes(set: &StrokeSet, tool: &dyn PlanarTool, center_mm: DVec2, reach_mm: f64) -> Vec<NearPass> {
    let blades: Vec<Rigid2> = (0..tool.blade_count()).map(|blade| tool.tool_from_blade(blade)).collect();
    let edges = tool.edges();
    let centers_mm: Vec<DVec2> =
        (0..).zip(&blades).map(|(blade, place)| place.point(edges.edge_of(blade).center_mm)).collect();
    let edge_reach_mm = edges.largest_reach_mm();
    let limit_mm = reach_mm + edge_reach_mm;
    // No blade reaches further from the tool's axis than this.
    let tool_reach_mm = centers_mm.iter().map(|center| center.length()).fold(0.0, f64::max);
    let mut near = Vec::new();
    for stroke in 0..set.count() {
        let poses = set.poses(stroke);
        let middle = poses[poses.len() / 2];
        // How far any point of the tool moves in the work from node to node.
        let travel_mm = poses
            .iter()
            .map(|pose| {
                pose.translation_mm.distance(middle.translation_mm)
                    + (pose.rotation - middle.rotation).length() * (tool_reach_mm + edge_reach_mm)
            })
            .fold(0.0, f64::max);
        let limit_mm = limit_mm + BETWEEN_NODES * travel_mm;
        if middle.translation_mm.distance(center_mm) > tool_reach_mm + limit_mm {
            continue;
        }
        let (bounds, wander_mm) = bound_poses(set, stroke, center_mm, reach_mm);
        for (blade, tool_from_blade) in blades.iter().enumerate() {
            if middle.point(centers_mm[blade]).distance(center_mm) > limit_mm {
                continue;
            }
            let blade_from_work = bounds.map(|pose| pose.after(tool_from_blade).inverse());
            near.push(NearPass { stroke, blade: blade as u32, blade_from_work, wander_mm });
        }
    }
    near
}

/// Poses of a stroke at [`BOUND_PHASES`], and how far a place within `reach_mm` of `center_mm` in the work
/// leaves the parabolas through its places at these, mm.
fn bound_poses(set: &StrokeSet, stroke: usize, center_mm: DVec2, reach_mm: f64) -> (PhasePoses, f64) {
    if let [pose] = set.poses(stroke) {
        return (PhasePoses::frozen(*pose), 0.0);
    }
    let path = set.path(stroke);
    let from_axis_mm = path.at(0.0).translation_mm.distance(center_mm) + reach_mm;
    (PhasePoses::moving(BOUND_PHASES.map(|tau| path.at(tau))), path.beyond_parabola_mm(from_axis_mm))
}

/// Height at which the lowest of some passes meets a ray of the gear frame at the middle of the stroke, above `low_mm`;
/// exact, without tables' neighbours or tiles.
pub fn lowest_entry(
    near: &[NearPass],
    edges: &BladeEdges,
    origin_mm: DVec2,
    direction: DVec2,
    low_mm: f64,
) -> Option<f64> {
    let mut lowest: Option<f64> = None;
    for pass in near {
        let (blade_from_work, edge) = (pass.middle(), edges.edge_of(pass.blade));
        let (o, n) = (blade_from_work.point(origin_mm), blade_from_work.direction(direction));
        // A circle that holds an edge or a segment against the part of the ray on which something lower would lie.
        let is_met = |center_mm: DVec2, reach_mm: f64, lowest: Option<f64>| {
            let (from_ray, reach_mm) = (center_mm - o, reach_mm + CIRCLE_MM);
            let along_mm = n.dot(from_ray);
            n.perp_dot(from_ray).abs() <= reach_mm
                && along_mm + reach_mm > low_mm
                && lowest.is_none_or(|lowest| along_mm - reach_mm < lowest)
        };
        if !is_met(edge.center_mm, edge.reach_mm, lowest) {
            continue;
        }
        for segment in &edge.segments {
            if !is_met(segment.blade_from_segment.translation_mm, segment.reach_mm, lowest) {
                continue;
            }
            let segment_from_blade = segment.blade_from_segment.inverse();
            let Some(hit) = segment.enter(segment_from_blade.point(o), segment_from_blade.direction(n)) else {
                continue;
            };
            let [y_from, y_to] = segment.y_range_mm;
            let on_segment = hit.y_mm >= y_from - 1e-9 && hit.y_mm <= y_to + 1e-9;
            if on_segment && hit.height_mm > low_mm && lowest.is_none_or(|h| hit.height_mm < h) {
                lowest = Some(hit.height_mm);
            }
        }
    }
    lowest
}
