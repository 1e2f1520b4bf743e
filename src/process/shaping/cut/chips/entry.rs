//! The first stroke of an operation that enters at full depth, alone: its chips and force are known before the cut.
//!
//! In: a job. Out: what the ledger says of those strokes. Law: the ledger's own, space by space, with all passes before
//! the stroke in order of time; only the spaces in which a cutter tooth of the stroke stands are followed, and only the
//! stroke's own chips are measured. Of the first operation that is one stroke in the uncut blank.

use super::ledger::chips_of;
use super::oblique::ElementForce;
use super::space::{Space, contours, middle_pose};
use super::stroke::StrokeChips;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::scene::model::Infeed;
use crate::process::shaping::tool::edge_polygon::EdgePolygon;
use gearcut_core::tool::{CuttingTool, PlanarTool};
use gearcut_core::units::TURN_RAD;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::PI;

/// A tip farther than this from the middle of its space, in radii of the circle that holds a tooth's edge, belongs to a
/// tooth that is clear of the blank.
const NEAR_REACHES: f64 = 4.0;

/// What the first stroke of every operation takes; none where the operation has an infeed, or the stroke is idle.
pub fn entries(job: &ShapingJob) -> Vec<Option<StrokeChips>> {
    let enters = |operation: usize| job.operations[operation].spec.infeed == Infeed::None;
    let operations = 0..job.operations.len();
    if !operations.clone().any(enters) {
        return vec![None; job.operations.len()];
    }
    let polygon = EdgePolygon::new(job.cutter.edge(), job.chip_spacing_mm);
    let forces = ElementForce::along_edge(&job.material, job.cutter_spec.rake_angle_rad, &polygon.stations);
    operations
        .map(|operation| if enters(operation) { entry(job, operation, &polygon, &forces) } else { None })
        .collect()
}

fn entry(job: &ShapingJob, operation: usize, polygon: &EdgePolygon, forces: &[ElementForce]) -> Option<StrokeChips> {
    if job.operations[operation].count() == 0 {
        return None;
    }
    let contours_mm = contours(job);
    let first = (operation as u32, 0);
    let of_space = |number: u32| {
        let mut space = Space::new(job, polygon, &contours_mm, number, 0.0);
        space.passes.retain(|pass| (pass.operation, pass.stroke) <= first);
        for pass in &mut space.passes {
            pass.own &= (pass.operation, pass.stroke) == first;
        }
        if space.passes.iter().any(|pass| pass.own) { chips_of(&space, forces).chips } else { Vec::new() }
    };
    let near = spaces_of(job, operation, polygon);
    let mut chips: Vec<_> = near.into_par_iter().map(of_space).collect::<Vec<_>>().concat();
    chips.sort_unstable_by_key(|chip| chip.blade);
    let center_mm = middle_pose(job, operation, 0).translation_mm + job.eccentricity_mm();
    let mut stroke = StrokeChips::default();
    for chip in &chips {
        stroke.add(chip, job.scene.gear.module_mm, center_mm);
    }
    (!stroke.is_idle()).then_some(stroke)
}

/// Spaces in which a cutter tooth of an operation's first stroke can stand: those that hold a tip.
fn spaces_of(job: &ShapingJob, operation: usize, polygon: &EdgePolygon) -> Vec<u32> {
    let pose = middle_pose(job, operation, 0);
    let blades = (0..job.cutter.blade_count()).map(|blade| job.cutter.tool_from_blade(blade));
    let tips_mm: Vec<DVec2> =
        blades.map(|tool_from_blade| pose.after(&tool_from_blade).point(polygon.tip_mm)).collect();
    let pitch_mm = PI * job.transverse.module_mm;
    let holds_tip = |number: &u32| {
        let at = |pitches: f64| job.curve.phi_at_arc((f64::from(*number) + pitches) * pitch_mm);
        let (from_rad, to_rad, middle_mm) = (at(-0.5), at(0.5), job.curve.frame(at(0.0)).point_mm);
        let near = tips_mm.iter().filter(|tip_mm| tip_mm.distance(middle_mm) < NEAR_REACHES * polygon.reach_mm);
        near.into_iter().any(|tip_mm| (tip_mm.to_angle() - from_rad).rem_euclid(TURN_RAD) < to_rad - from_rad)
    };
    job.spaces().filter(holds_tip).collect()
}
