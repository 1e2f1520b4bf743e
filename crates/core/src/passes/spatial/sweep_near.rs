//! Passes whose blades come near a region of the work at all: the first look, in a few poses of the work.
//!
//! In: the passes of an operation, a place and a reach. Out: the passes that planning begins with. [`near_passes`]
//! serves candidates and brute force alike, so that the comparison of both says nothing about its numbers: they rest on
//! their derivations, and on the patches of an independent solver that `tests/suite/hobbing/spatial.rs` compares with.
//! [`passes_beside`] serves candidates alone; that comparison stands for its numbers.

use super::turning_passes::{BladePass, TurningPasses};
use glam::DVec3;

/// What profiles and paths bend between the places that are looked at, along the tool's axis, mm. Found by trial, no
/// proof; candidates are compared with all passes in `tests/suite/hobbing/spatial.rs`.
const AXIAL_MARGIN_MM: f64 = 1.0;
/// While a blade sweeps through the work, a point of it moves in the head by at most this, mm. Rolling moves the pitch
/// curve by half of module x starts per radian of the tool. Over a sweep's 60 degrees to either side that is 0.52 x
/// module x starts: the bound holds up to module x starts = 38 mm.
const ROLLED_MM: f64 = 20.0;
/// What is within reach turns in the head meanwhile, and comes nearer to the tool by at most this share of the reach. A
/// gear with z teeth per start turns by 1.05 / z rad in 60 degrees of the tool, and a point at distance d from the
/// place moves by d times this angle at most: the bound holds from six teeth per start on.
const TURNED_SHARE: f64 = 0.2;
/// A pass looked at in one pose may be further away than the reach by a tenth of it and [`NEAR_MM`]: what is within
/// reach turns by some per cent during the sweep. Found by trial and kept wide; no proof.
const NEAR_SHARE: f64 = 1.1;
/// The same as a length, mm.
const NEAR_MM: f64 = 1.0;
/// A region that holds the tool's axis is seen from this share of the tip's radius. The angle at which a blade meets it
/// is taken as reach / distance and is so limited to four times what is within reach of the tip. Found by trial; no
/// proof.
const LEAST_DISTANCE: f64 = 0.25;

/// Passes whose blade comes within `reach_mm` of a place of the work, in time order.
///
/// While the rake face goes through the neighbourhood the place itself moves in the head, and everything within reach
/// turns with it a little. The first look takes both by their bounds, the second one by what three poses show.
pub fn near_passes(set: &TurningPasses, center_mm: DVec3, reach_mm: f64) -> Vec<BladePass> {
    let margin_mm = NEAR_SHARE * reach_mm + NEAR_MM;
    (0..set.count())
        .map(|index| set.pass(index))
        .filter(|pass| {
            let (place, edge) = (set.place(pass), set.edge(pass));
            let y_reach_mm = edge.center_mm.y.abs() + edge.reach_mm;
            let tip_mm = edge.center_mm.x + edge.reach_mm;
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
pub fn passes_beside(set: &TurningPasses, pass: &BladePass, points_mm: &[DVec3], reach_mm: f64) -> bool {
    let (place, edge) = (set.place(pass), set.edge(pass));
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
