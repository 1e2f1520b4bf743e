//! Where the surface crosses edges of the grid, and where the tangents at crossings meet.

use gearcut_core::dexel::blank_field::RayMaterial;
use gearcut_core::dexel::intervals;
use glam::DVec2;

/// A sheet is a sharp edge where its tangents differ enough: tan(theta / 2) squared, theta = 11 degrees; below, the
/// vertex moves along the mean normal only.
const SHARP: f64 = 0.01;

/// A crossing of a grid edge.
#[derive(Clone, Copy)]
pub struct Cross {
    /// Where the surface crosses the edge.
    pub point_mm: DVec2,
    /// Normal of the surface, out of the material.
    pub normal: DVec2,
    /// Pass that left it.
    pub pass: u32,
}

/// The end of material in an edge of the grid: where it ends if the lower node is inside, else where it begins.
pub fn end_between(ray: &RayMaterial, from_mm: f64, to_mm: f64, low_inside: bool) -> Option<intervals::End> {
    if low_inside {
        let span = ray.get(ray.partition_point(|s| s.high.at_mm < from_mm))?;
        (span.high.at_mm <= to_mm).then_some(span.high)
    } else {
        let span = ray[..ray.partition_point(|s| s.low.at_mm <= to_mm)].last()?;
        (span.low.at_mm >= from_mm).then_some(span.low)
    }
}

/// Where the tangents at some crossings meet best: least squares of the distances from all of them, from the crossings'
/// mean, along the mean normal alone where they are nearly parallel.
pub fn best_meeting(crosses: &[Cross]) -> DVec2 {
    let count = crosses.len() as f64;
    let mean = crosses.iter().map(|c| c.point_mm).sum::<DVec2>() / count;
    let (mut xx, mut xy, mut yy, mut right) = (0.0, 0.0, 0.0, DVec2::ZERO);
    for Cross { point_mm, normal, .. } in crosses {
        xx += normal.x * normal.x;
        xy += normal.x * normal.y;
        yy += normal.y * normal.y;
        right += *normal * normal.dot(*point_mm - mean);
    }
    let (half_trace, half_gap) = (0.5 * (xx + yy), (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt());
    let (large, small) = (half_trace + half_gap, half_trace - half_gap);
    // Eigenvector of the larger eigenvalue, from the better conditioned column.
    let steep = if xx > yy { DVec2::new(large - yy, xy) } else { DVec2::new(xy, large - xx) };
    let steep = steep.try_normalize().unwrap_or(if xx > yy { DVec2::X } else { DVec2::Y });
    let along = |axis: DVec2, value: f64| axis * (axis.dot(right) / value);
    let sharp = if small > SHARP * large { along(steep.perp(), small) } else { DVec2::ZERO };
    mean + along(steep, large) + sharp
}
