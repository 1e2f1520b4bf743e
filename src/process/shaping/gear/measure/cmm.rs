//! What a coordinate measuring machine (CMM) would say of the allowances AB and CD.
//!
//! In: the job, what its strokes leave in the middle of the face, and the measurement ([`CmmSpec`]). Out: [`CmmReport`]
//! for every operation but the last: allowances by probe and points alone, and what the errors of points and clamping
//! make of the unevenness.
//!
//! **Law.** The probe, a ball, comes along the target's normal at each nominal point and stops where it first touches
//! what is cut; its centre less its radius along that normal is the measured point. A crest beside the point lifts it.
//! A cubic through the four points around carries the profile, and where it meets the pitch curve is A, B, C or D.
//!
//! A point is off along its normal n, and a gear that is clamped anew before it is finished is moved by v = e + delta z
//! x p between both measurements. A crossing goes along the curve by (v . n + the points' errors) / (n . t), with the
//! tangent t of the curve. Only the first order counts: the second is v^2 over the radius of curvature, 10 nm at
//! 0.1 mm.
//!
//! Road not taken: cutting the gear off its axis. That moves roughing and finishing alike.

use super::unevenness::{ToothAllowance, ToothCrossings, allowances, summarise};
use crate::job::{GearJob, RAY_DEPTH_MODULES, RAY_HEIGHT_MODULES};
use crate::measure::crossing::Crossing;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::scene::model::CmmSpec;
use crate::random::Draws;
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;
use gearcut_core::math::roots::bisect;
use gearcut_core::terms::Side;
use glam::DVec2;

/// Distance of the places that the probe may touch, mm.
const PLACES_MM: f64 = 0.005;
/// Source of random numbers: axes and operations have those below.
const CMM_SOURCE: u32 = 500;
/// Points of the cubic that carries a profile.
const AROUND: usize = 4;
/// Ends of the interval that holds 95 % of the draws.
const ENDS: [f64; 2] = [0.025, 0.975];

/// An operation, measured.
#[derive(Debug, Clone, PartialEq)]
pub struct CmmReport {
    /// Index of the operation.
    pub operation: usize,
    /// By probe and points, without chance.
    pub teeth: Vec<ToothAllowance>,
    /// Largest and mean unevenness of each draw, percent; in no order.
    pub unevenness_percent: [Vec<f64>; 2],
    /// Standard deviation of AB and CD over the draws, root mean square of the teeth, mm.
    pub deviation_mm: Option<f64>,
}

/// A crossing as it was measured.
#[derive(Debug, Clone, Copy)]
struct ProbedCrossing {
    crossing: Crossing,
    /// Out of the gear.
    normal: DVec2,
    /// n . t.
    slope: f64,
    /// Points that carry it, with their weights.
    weights: [(usize, f64); AROUND],
}

/// A place of a flank: point and normal of the target, and height of what is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutPlace {
    /// On the target, mm.
    pub point_mm: DVec2,
    /// Unit normal out of the gear.
    pub normal: DVec2,
    /// Over the target, mm.
    pub height_mm: f64,
}

/// Where a ball of this radius touches that comes along the normal of a place: height of its centre less the radius,
/// mm; none where it meets nothing.
pub fn touched_mm(places: &[CutPlace], at: usize, radius_mm: f64) -> Option<f64> {
    let own = &places[at];
    let centre_mm = |place: &CutPlace| {
        let from = place.point_mm + place.height_mm * place.normal - own.point_mm;
        let across = from.perp_dot(own.normal);
        (across.abs() < radius_mm).then(|| from.dot(own.normal) + (radius_mm * radius_mm - across * across).sqrt())
    };
    places.iter().filter_map(centre_mm).reduce(f64::max).map(|centre| centre - radius_mm)
}

/// Weights of the four nodes around a place, and the first of them: the cubic through them (Lagrange).
fn cubic(nodes: &[f64], at: f64) -> [(usize, f64); AROUND] {
    let before = nodes.partition_point(|&node| node <= at);
    let first = before.saturating_sub(AROUND / 2).min(nodes.len() - AROUND);
    let own = &nodes[first..first + AROUND];
    std::array::from_fn(|i| {
        let others = own.iter().enumerate().filter(|&(j, _)| j != i);
        (first + i, others.map(|(_, node)| (at - node) / (own[i] - node)).product())
    })
}

/// Crossings of a flank after every operation.
fn measured(
    job: &ShapingJob,
    backend: &dyn Backend,
    (tooth, side): (u32, Side),
    spec: &CmmSpec,
) -> Result<Vec<Option<ProbedCrossing>>> {
    let flank = job.target_flank(tooth, side);
    let arcs_mm = job.even_arcs_mm(tooth, side, PLACES_MM)?;
    let layers = job.cut_flank(backend, tooth, side, &arcs_mm, &[0.0])?;
    let targets: Vec<_> = arcs_mm.iter().map(|&arc_mm| flank.at_arc(arc_mm)).collect();
    let last = arcs_mm.len() - 1;
    let ends_mm = [-RAY_DEPTH_MODULES, RAY_HEIGHT_MODULES].map(|end| 0.999 * end * job.scene.gear.module_mm);
    let range_mm = ends_mm[0]..ends_mm[1];
    // Even along the profile, half a distance from its ends.
    let mut indices: Vec<usize> = (0..spec.points)
        .map(|k| ((f64::from(k) + 0.5) / f64::from(spec.points) * last as f64).round() as usize)
        .collect();
    indices.dedup();
    let of_layer = |heights_mm: &[f32]| {
        let places: Vec<CutPlace> = targets
            .iter()
            .zip(heights_mm)
            .map(|(at, &height)| CutPlace { point_mm: at.point_mm, normal: at.normal, height_mm: f64::from(height) })
            .collect();
        // A ray that nothing cut, or that was cut beyond its end, says nothing of the surface.
        let read = |&i: &usize| {
            let is_known = range_mm.contains(&places[i].height_mm);
            Some((arcs_mm[i], touched_mm(&places, i, 0.5 * spec.probe_diameter_mm)?, is_known))
        };
        let points: Vec<(f64, f64, bool)> = indices.iter().filter_map(read).collect();
        if points.len() < AROUND {
            return None;
        }
        let nodes: Vec<f64> = points.iter().map(|point| point.0).collect();
        let on_profile = |arc_mm: f64| {
            let weights = cubic(&nodes, arc_mm);
            let height_mm: f64 = weights.iter().map(|&(i, weight)| weight * points[i].1).sum();
            let target = flank.at_arc(arc_mm);
            (target.point_mm + height_mm * target.normal, target, weights)
        };
        let over = |arc_mm: f64| {
            let (point_mm, target, _) = on_profile(arc_mm);
            job.blank.height(point_mm, target.phi_rad)
        };
        let crossed = nodes.windows(2).find(|pair| over(pair[0]).0 <= 0.0 && over(pair[1]).0 > 0.0)?;
        let arc_mm = bisect(|arc_mm| over(arc_mm).0 <= 0.0, crossed[0], crossed[1]);
        let (point_mm, target, weights) = on_profile(arc_mm);
        if !weights.iter().all(|&(i, _)| points[i].2) {
            return None;
        }
        let phi_rad = over(arc_mm).1;
        Some(ProbedCrossing {
            crossing: Crossing { point_mm, phi_rad, arc_mm: job.curve.arc_mm(phi_rad) },
            normal: target.normal,
            slope: target.normal.dot(job.curve.frame(phi_rad).tangent),
            weights,
        })
    };
    Ok(layers.iter().map(|layer| of_layer(&layer.heights_mm)).collect())
}

/// Measures all flanks after every operation, but for those that are cut away; nothing where a scene has one operation
/// alone.
///
/// # Errors
/// The backend's.
pub fn measure(
    job: &ShapingJob,
    backend: &dyn Backend,
    spec: &CmmSpec,
    is_lost: impl Fn(u32, Side) -> bool,
) -> Result<Vec<CmmReport>> {
    let finished = job.operations.len() - 1;
    if finished == 0 {
        return Ok(Vec::new());
    }
    let mut flanks = Vec::new();
    for tooth in 1..=job.scene.gear.teeth {
        let [left, right] = [Side::Left, Side::Right].map(|side| {
            if is_lost(tooth, side) {
                return Ok(vec![None; job.operations.len()]);
            }
            measured(job, backend, (tooth, side), spec)
        });
        flanks.push([left?, right?]);
    }
    let surface = |operation: usize| -> Vec<[Option<ProbedCrossing>; 2]> {
        flanks.iter().map(|sides| sides.each_ref().map(|operations| operations[operation])).collect()
    };
    let own = surface(finished);
    Ok((0..finished).map(|operation| report(job, (operation, &surface(operation)), &own, spec)).collect())
}

fn report(
    job: &ShapingJob,
    (operation, rough): (usize, &[[Option<ProbedCrossing>; 2]]),
    finish: &[[Option<ProbedCrossing>; 2]],
    spec: &CmmSpec,
) -> CmmReport {
    let draws = Draws::new(spec.seed, CMM_SOURCE + operation as u32);
    let crossings = |of: &[[Option<ProbedCrossing>; 2]], by_mm: &dyn Fn(usize, usize, &ProbedCrossing) -> f64| {
        let moved = |(tooth, sides): (usize, &[Option<ProbedCrossing>; 2])| -> ToothCrossings {
            [0, 1].map(|side| sides[side].map(|found| along(job, &found, by_mm(tooth, side, &found))))
        };
        of.iter().enumerate().map(moved).collect::<Vec<_>>()
    };
    let teeth = allowances(&crossings(rough, &|_, _, _| 0.0), &crossings(finish, &|_, _, _| 0.0));
    let mut unevenness_percent = [Vec::new(), Vec::new()];
    let mut squares = (0.0, 0_u64);
    for draw in 1..=i64::from(spec.draws) {
        let normal = |number: usize| draws.normal([draw, number as i64]);
        let offset_mm = spec.clamping_offset_mm * DVec2::new(normal(0), normal(1));
        let turn_rad = spec.clamping_turn_rad * normal(2);
        // Errors of the points of one surface, tooth and side.
        let points_mm = |surface: usize, tooth: usize, side: usize, found: &ProbedCrossing| {
            let first = 3 + ((surface * finish.len() + tooth) * 2 + side) * spec.points as usize;
            if spec.point_deviation_mm == 0.0 {
                return 0.0;
            }
            let of = |&(i, weight): &(usize, f64)| weight * spec.point_deviation_mm * normal(first + i);
            found.weights.iter().map(of).sum::<f64>()
        };
        let a = crossings(rough, &|tooth, side, found| points_mm(0, tooth, side, found) / found.slope);
        let b = crossings(finish, &|tooth, side, found| {
            let clamped_mm = (offset_mm + turn_rad * found.crossing.point_mm.perp()).dot(found.normal);
            (clamped_mm + points_mm(1, tooth, side, found)) / found.slope
        });
        let found = allowances(&a, &b);
        for (tooth, exact) in found.iter().zip(&teeth) {
            let off = [(tooth.ab_mm(), exact.ab_mm()), (tooth.cd_mm(), exact.cd_mm())];
            for (drawn, exact) in off.into_iter().filter_map(|(drawn, exact)| drawn.zip(exact)) {
                squares = (squares.0 + (drawn - exact).powi(2), squares.1 + 1);
            }
        }
        let found = summarise(found.iter().map(ToothAllowance::unevenness_mean_percent));
        unevenness_percent[0].extend(found.map(|of| of.max_percent));
        unevenness_percent[1].extend(found.map(|of| of.mean_percent));
    }
    let deviation_mm = (squares.1 > 0).then(|| (squares.0 / squares.1 as f64).sqrt());
    CmmReport { operation, teeth, unevenness_percent, deviation_mm }
}

/// A crossing moved along the pitch curve by a length.
fn along(job: &ShapingJob, found: &ProbedCrossing, by_mm: f64) -> Crossing {
    let from = &found.crossing;
    let point_mm = from.point_mm + by_mm * job.curve.frame(from.phi_rad).tangent;
    let turned_rad = from.point_mm.angle_to(point_mm);
    Crossing { point_mm, phi_rad: from.phi_rad + turned_rad, arc_mm: from.arc_mm + by_mm }
}

impl CmmReport {
    /// Largest (0) or mean (1) unevenness: median of the draws and the ends of the interval that holds 95 % of them.
    pub fn percent(&self, which: usize) -> Option<[f64; 3]> {
        let mut sorted = self.unevenness_percent[which].clone();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().checked_sub(1)?;
        let at = |share: f64| sorted[(share * last as f64).round() as usize];
        Some([at(0.5), at(ENDS[0]), at(ENDS[1])])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight flank with cusps 0.3 mm apart: on a cusp the ball is as high as it, over the valley it rests on both
    /// sides of it, R - sqrt(R^2 - 0.15^2) lower.
    #[test]
    fn a_ball_rests_on_cusps() {
        let (apart, radius) = (60, 1.0);
        let places: Vec<CutPlace> = (0..=240)
            .map(|i| CutPlace {
                point_mm: DVec2::new(0.0, f64::from(i) * PLACES_MM),
                normal: DVec2::X,
                height_mm: if i % apart == 0 { 0.02 } else { 0.0 },
            })
            .collect();
        let on_cusp = touched_mm(&places, 120, radius).expect("it touches");
        assert!((on_cusp - 0.02).abs() < 1e-15, "{on_cusp}");
        let in_valley = touched_mm(&places, 150, radius).expect("it touches");
        let expected = 0.02 - (1.0 - (1.0 - 0.15_f64.powi(2)).sqrt());
        assert!((in_valley - expected).abs() < 1e-15, "{in_valley} {expected}");
    }

    /// A cubic is carried exactly, between nodes that are not even and before the first of them.
    #[test]
    fn four_points_carry_a_cubic() {
        let nodes = [0.0, 1.0, 2.5, 3.0, 5.0, 6.0];
        let law = |x: f64| x * x * x - 4.0 * x * x + 2.0;
        for at in [0.2, 1.7, 2.9, 4.4, 5.9] {
            let found: f64 = cubic(&nodes, at).iter().map(|&(i, weight)| weight * law(nodes[i])).sum();
            assert!((found - law(at)).abs() < 1e-12, "{at}: {found}");
        }
    }
}
