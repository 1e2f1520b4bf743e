//! Height of the ridges between two feeds, from the second order of what one gash sweeps.
//!
//! In: hob, gearing, curvature of the pitch curve and the place of a contact. Out: the ridge's height over the flank.
//!
//! **Law.** About the point in which it touches, the surface that a gash sweeps leaves a gap of half a quadratic form Q
//! over the flank. Following gashes touch in a row, in the flank's direction c of the pitch line: the rack runs on by s
//! and the contact moves by s c. Between gashes that are close the gap is the least over that row, and half a feed
//! beside it, along the tooth trace T by f / (2 cos beta), a ridge stands
//!
//! `f^2 / (8 cos^2 beta) (Q_TT - Q_Tc^2 / Q_cc)`
//!
//! high. On a spur gear Q_Tc is nearly 0, and Q_TT alone is the arc of the hob's circle, `f^2 sin(alpha_n) / (8 R)`. On
//! a helical one the gashes that follow cut off a third and more of what one gash alone would leave.
//!
//! **Q.** In the frame of the rack, an edge point u along the edge from the contact and t radians of the hob later lies
//! `(A u^2 + 2 B u t + C t^2) / 2` over the rack's flank, N its normal: A the edge's own curvature, B = N . (h_b d0 x
//! E'), C = -N . r the way to the hob's axis. The gear's flank falls back from the rack's by its curvature across the
//! line of contact, cos(beta_b) / (rho sin(alpha_t) + c), while that line moves on by sin(alpha_t) times the arc. Both
//! are forms in (u, t), and (u, t) lies at E' u + V t on the flank, V the edge's speed against the rack; beside the
//! pitch line the gear slides on the rack by c / rho times the arc.
//!
//! Feeds are slow against the cut: the edge's speed is taken without them.

use super::HobbingGeometry;
use crate::process::hobbing::Hob;
use gearcut_core::tool::SpatialTool;
use glam::{DMat2, DVec2, DVec3};

/// Where a flank touches, and on which curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RidgePlace {
    /// e: +1 for left flanks, -1 for right ones.
    pub side: f64,
    /// Normal pressure angle.
    pub pressure_angle_rad: f64,
    /// Curvature of the pitch curve, 1/mm.
    pub curvature_per_mm: f64,
    /// Height of the point over the pitch curve, along its normal, mm.
    pub height_mm: f64,
}

/// Height of the ridge between two feeds of the slide, `feed_mm` apart, normal to the flank, mm; none of a drawn tooth,
/// whose rack is no plane.
pub fn ridge_mm(hob: &Hob, geometry: &HobbingGeometry, contact: &RidgePlace, feed_mm: f64) -> Option<f64> {
    let RidgePlace { side: e, pressure_angle_rad, curvature_per_mm, height_mm } = *contact;
    let (sin_b, cos_b) = geometry.helix_angle_rad.sin_cos();
    let (sin_n, cos_n) = pressure_angle_rad.sin_cos();
    let (sin_t, cos_t) = (sin_n / cos_n / cos_b).atan().sin_cos();
    let normal = DVec3::new(e * cos_n * cos_b, sin_n, e * geometry.gear_hand * cos_n * sin_b);
    let cos_base = normal.truncate().length();
    // On the circle that the pitch curve is there the point at this height is touched so far from the pitch point.
    let rise_mm = height_mm * (2.0 + height_mm * curvature_per_mm);
    let distance_mm = rise_mm / (sin_t + (sin_t * sin_t + curvature_per_mm * rise_mm).max(0.0).sqrt());

    let axis = geometry.hob_axis();
    let from_axis = distance_mm / cos_base * normal - geometry.pitch_radius_mm * DVec3::Y;
    let radial_mm = from_axis - from_axis.dot(axis) * axis;
    let radius_mm = radial_mm.length();
    let radial = radial_mm / radius_mm;
    let turning = geometry.hob_hand * axis;
    let pitch_line = DVec3::X;
    let arc_per_rad_mm = geometry.arc_per_hob_rad_mm();
    // The edge in its rake face, which winds about the axis on hobs with helical gashes.
    let flank = -normal.dot(axis).signum();
    let [slope, bend] = hob.flank_slope_and_bend(radius_mm)?.map(|rate| flank * rate);
    let wound = -hob.rake_twist_rad_per_mm();
    let around = axis.cross(radial);
    let along = axis + wound * radius_mm * around;
    let edge = radial + slope * along;
    let edge_bend = bend * along + 2.0 * slope * wound * around - radius_mm * (slope * wound).powi(2) * radial;
    let speed = turning.cross(radial_mm) + arc_per_rad_mm * pitch_line;

    // On the flank's tangent plane: across the line of contact, in the transverse section, and along it.
    let across = DVec3::new(sin_t, -e * cos_t, 0.0);
    let onto = |v: DVec3| DVec2::new(across.dot(v), normal.cross(across).dot(v));
    let slide = DVec2::new(distance_mm * curvature_per_mm, 0.0);
    let row = onto(pitch_line) + slide;
    let trace = onto(DVec3::Z) - geometry.gear_hand * (sin_b / cos_b) * row;

    let bent = normal.dot(edge_bend);
    let turned = normal.dot(turning.cross(edge));
    let drawn = -normal.dot(radial_mm);
    let curvature = cos_base * curvature_per_mm / (sin_t + distance_mm * curvature_per_mm);
    let behind = DVec2::new(across.dot(edge), across.dot(turning.cross(radial_mm)));
    let gap = |a: DVec2, b: DVec2| {
        let over_rack = bent * a.x * b.x + turned * (a.x * b.y + a.y * b.x) + drawn * a.y * b.y;
        over_rack + curvature * behind.dot(a) * behind.dot(b)
    };
    let edge_and_time = DMat2::from_cols(onto(edge), onto(speed) + arc_per_rad_mm * slide).inverse();
    let [trace, row] = [edge_and_time * trace, edge_and_time * row];
    Some(feed_mm * feed_mm / 8.0 * (gap(trace, trace) - gap(trace, row).powi(2) / gap(row, row)))
}
