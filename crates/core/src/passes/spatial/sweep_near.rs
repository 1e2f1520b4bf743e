//! Passes whose blades come near a region of the work at all: the first look, in a few poses of the work.
//!
//! In: the passes of an operation, a place and a reach. Out: the passes that planning begins with, with candidates
//! and with brute force alike; so the comparison with all passes says nothing about the numbers here.

use super::turning_passes::{BladePass, TurningPasses};
use crate::tool::edge::Edge;
use glam::DVec3;

/// What profiles and paths bend between the places that are looked at, along the tool's axis, mm.
const AXIAL_MARGIN_MM: f64 = 1.0;
/// While a blade sweeps through the work, a point of it moves in the head by at most this, mm: rolling moves the pitch
/// curve
/// by half of module x starts per radian of the tool, so that over 60 degrees this holds up to module x starts = 38 mm.
/// Planning with all passes begins with the same ones: the bound rests on this derivation alone.
const ROLLED_MM: f64 = 20.0;
/// What is within reach turns in the head meanwhile: it comes nearer to the tool by at most this share of the reach. A
/// gear
/// with z teeth per start turns by 1.05 / z rad in 60 degrees of the tool: the share holds from six teeth per start on.
const TURNED_SHARE: f64 = 0.2;
/// Share of the reach, and length in mm, that a pass may be further away than the reach when it is looked at in one
/// pose.
/// Found by trial; the bound is kept wide, as planning with all passes begins with the same ones.
const NEAR_SHARE: f64 = 1.1;
const NEAR_MM: f64 = 1.0;
/// A region that holds the tool's axis is seen from this share of the tip's radius: it limits the angle at which a
/// blade meets
/// it to four times what is within reach of the tip. Found by trial.
const LEAST_DISTANCE: f64 = 0.25;

/// Passes whose blade comes within `reach_mm` of a place of the work, in time order.
///
/// While the rake face goes through the neighbourhood the place itself moves in the head, and with it everything within
/// reach turns a little: some per cent of the sweep. The bound takes a tenth of the reach for that, and a millimetre
/// more.
pub fn near_passes(set: &TurningPasses, edge: &Edge, center_mm: DVec3, reach_mm: f64) -> Vec<BladePass> {
    let margin_mm = NEAR_SHARE * reach_mm + NEAR_MM;
    let y_reach_mm = edge.center_mm.y.abs() + edge.reach_mm;
    let tip_mm = edge.center_mm.x + edge.reach_mm;
    (0..set.count())
        .map(|index| set.pass(index))
        .filter(|pass| {
            let place = set.place(pass);
            // Where the place stands when the blade points to it, to the first order of the motion in between.
            let at = |swept: f64| set.motion.head_from_work(pass.tool_angle_rad + set.turn * swept).point(center_mm);
            let first = at(0.0);
            if first.x.hypot(first.y) - margin_mm > tip_mm + ROLLED_MM + TURNED_SHARE * reach_mm {
                return false;
            }
            let swept = first.y.atan2(first.x);
            let second = at(swept);
            let spread = reach_mm / (second.x.hypot(second.y) - reach_mm).max(LEAST_DISTANCE * tip_mm);
            let moved_mm = (at(swept + spread.min(1.0)) - at(swept - spread.min(1.0))).length();
            let margin_mm = margin_mm + moved_mm;
            second.x.hypot(second.y) <= tip_mm + margin_mm
                && (second.z - place.axial_mm).abs() <= y_reach_mm + margin_mm
                && swept.abs() <= set.half_sweep_rad + spread
        })
        .collect()
}

/// Whether a pass's blade passes some points of the work (the first one in their middle, none further than `reach_mm`
/// from it) in their own place along the tool's axis.
///
/// While the rake face goes through the neighbourhood the points move a little along the axis, nearly evenly: their
/// places are taken at the moment when the rake face holds the middle, and when it holds what is furthest before and
/// behind.
pub fn passes_beside(set: &TurningPasses, edge: &Edge, pass: &BladePass, points_mm: &[DVec3], reach_mm: f64) -> bool {
    let place = set.place(pass);
    let pose = |swept: f64| set.motion.head_from_work(pass.tool_angle_rad + set.turn * swept);
    let first = pose(0.0).point(points_mm[0]);
    let swept = first.y.atan2(first.x);
    let middle = pose(swept);
    let distance_mm = middle.point(points_mm[0]).truncate().length();
    let spread = reach_mm / (distance_mm - reach_mm).max(LEAST_DISTANCE * (edge.center_mm.x + edge.reach_mm));
    let (mut low_mm, mut high_mm) = (f64::INFINITY, f64::NEG_INFINITY);
    for pose in [pose(swept - spread.min(1.0)), middle, pose(swept + spread.min(1.0))] {
        for &point_mm in points_mm {
            let y_mm = place.y_sign * (pose.point(point_mm).z - place.axial_mm) - edge.center_mm.y;
            (low_mm, high_mm) = (low_mm.min(y_mm), high_mm.max(y_mm));
        }
    }
    let y_reach_mm = edge.reach_mm + AXIAL_MARGIN_MM;
    low_mm <= y_reach_mm && high_mm >= -y_reach_mm
}
