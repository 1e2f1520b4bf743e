//! The lattice of cutting marks on a hobbed flank: from the machine's motion, and from the surface itself.
//!
//! **From kinematics.** A gash leaves its mark where its rake face passes the point in which worm, rack and gear touch. In the machine frame (origin in the pitch point, see
//! [`crate::linkage::hobbing`]) the gear touches the rack at p = c (e cos(alpha_t), sin(alpha_t), .) + z, c = -e sigma cos(alpha_t), sigma the roll past the flank's crossing with the pitch line; the worm
//! touches the rack's plane (normal N) where the screw motion of the worm, less the rack's translation, has no part along N:
//!
//! `N . (h_b d0 x (p - C) + (lead / 2 pi) d0) = 0`,  C the hob's centre;
//!
//! and the rake face of gash g holds p when the hob has turned by p's own angle about the axis from g's. Two equations for time and z; the heights of the surface left are zero
//! there. Neither the pitch curve nor the law in time enters: in the coordinates (sigma, z) the marks of an even feed are one lattice on every gear.
//!
//! **From the surface.** Its autocorrelation has peaks at the vectors from mark to mark.
//!
//! Lengths and angles are those on the flank: a step of sigma is (sin(alpha_t) + c / rho) long in the transverse plane, a step of z at constant sigma 1 / cos(beta) along the tooth
//! trace.

use crate::linkage::HobbingLinkage;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A flank as the marks see it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkedFlank {
    /// +1 for left flanks (low-arc side of their space), -1 for right ones.
    pub side: f64,
    /// Arc of the pitch curve at which the flank crosses the pitch line in the section z = 0, mm.
    pub crossing_arc_mm: f64,
    /// alpha_t.
    pub pressure_angle_rad: f64,
}

/// A mark: roll past the crossing of its section, place along the work's rotation vector, moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// sigma, mm.
    pub roll_mm: f64,
    /// z, machine frame, mm.
    pub z_mm: f64,
    /// Time, s.
    pub time_s: f64,
}

/// A vector from one mark to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkStep {
    /// Step in (sigma, z), mm.
    pub step_mm: DVec2,
    /// Length on the flank, mm.
    pub length_mm: f64,
    /// Angle to the tooth trace, -pi/2 to pi/2, positive towards growing sigma.
    pub to_trace_rad: f64,
    /// Angle to the gear's axis, 0 to pi/2.
    pub to_axis_rad: f64,
}

/// Mark of a gash passage (counted from hob angle 0) on a flank; `None` if the equations have no root near the moment when the gash looks at the gear.
pub fn mark(linkage: &HobbingLinkage, gashes: u32, flank: &MarkedFlank, passage: i64) -> Option<Mark> {
    let g = linkage.geometry();
    let (e, h, hand) = (flank.side, g.gear_hand, g.hob_hand);
    let (sin, cos) = flank.pressure_angle_rad.sin_cos();
    let tan_helix = g.helix_angle_rad.tan();
    let normal = DVec3::new(e * cos, sin, h * e * tan_helix * cos);
    let axis = g.hob_axis();
    let parameter_mm = 0.5 * g.starts * g.module_mm / g.lead_angle_rad.cos();
    let gash_rad = TAU * passage as f64 / f64::from(gashes);
    let roll =
        |time_s: f64, z: f64| linkage.axes::<1>(time_s).arc_mm.value() - flank.crossing_arc_mm + h * z * tan_helix;
    let residuals = |time_s: f64, z: f64| -> DVec2 {
        let axes = linkage.axes::<1>(time_s);
        let c = -e * roll(time_s, z) * cos;
        let point = DVec3::new(c * e * cos, c * sin, z);
        let stand = DVec3::new(0.0, g.pitch_radius_mm + axes.radial_mm.value(), axes.slide_mm.value());
        let from_center = point - stand - axis * axes.shift_mm.value();
        let worm = normal.dot(hand * axis.cross(from_center) + parameter_mm * axis);
        let angle = from_center.dot(axis.cross(DVec3::NEG_Y)).atan2(-from_center.y);
        DVec2::new(worm, g.pitch_radius_mm * (angle - hand * (axes.hob_rad.value() - gash_rad)))
    };
    let mut time_s = linkage.time_at_hob_angle(gash_rad);
    let mut z = linkage.axes::<1>(time_s).slide_mm.value();
    let step_s = 1e-6 * linkage.cycle_s();
    for _ in 0..40 {
        let r = residuals(time_s, z);
        // Central differences: the motion is smooth, and Newton's method corrects itself.
        let over_t = (residuals(time_s + step_s, z) - residuals(time_s - step_s, z)) / (2.0 * step_s);
        let over_z = (residuals(time_s, z + 1e-4) - residuals(time_s, z - 1e-4)) / 2e-4;
        let determinant = over_t.perp_dot(over_z);
        let (dt, dz) = (r.perp_dot(over_z) / determinant, over_t.perp_dot(r) / determinant);
        time_s -= dt;
        z -= dz;
        if !(dt.is_finite() && dz.is_finite()) {
            return None;
        }
        if dz.abs() < 1e-11 && dt.abs() < 1e-13 * linkage.cycle_s().max(1.0) {
            break;
        }
    }
    (residuals(time_s, z).length() < 1e-8).then(|| Mark { roll_mm: roll(time_s, z), z_mm: z, time_s })
}

/// Vectors to the mark of the next gash and to the next mark of the same hob tooth, which comes back after `teeth` / starts turns of the hob, (sigma, z) in mm.
pub fn lattice(
    linkage: &HobbingLinkage,
    gashes: u32,
    teeth: u32,
    flank: &MarkedFlank,
    passage: i64,
) -> Option<[DVec2; 2]> {
    let starts = linkage.geometry().starts;
    let cycle = (f64::from(gashes) * f64::from(teeth) / starts).round() as i64;
    let at = |turns: f64, passage: i64| {
        // A cycle later the same space is a whole perimeter further on.
        let crossing_arc_mm = flank.crossing_arc_mm + turns * linkage.curve().perimeter_mm();
        let mark = mark(linkage, gashes, &MarkedFlank { crossing_arc_mm, ..*flank }, passage)?;
        Some(DVec2::new(mark.roll_mm, mark.z_mm))
    };
    let first = at(0.0, passage)?;
    Some([at(0.0, passage + 1)? - first, at(1.0, passage + cycle)? - first])
}

/// Lengths and angles of steps on a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankMetric {
    /// +1 for left flanks, -1 for right ones.
    pub side: f64,
    /// h: +1 for a right-hand gear.
    pub gear_hand: f64,
    /// beta.
    pub helix_angle_rad: f64,
    /// alpha_t.
    pub pressure_angle_rad: f64,
    /// Profile length per roll, sin(alpha_t) + c / rho.
    pub length_per_roll: f64,
}

impl FlankMetric {
    /// A step on the flank, machine frame at the pitch point.
    fn on_flank(&self, step: DVec2) -> DVec3 {
        let (sin, cos) = self.pressure_angle_rad.sin_cos();
        // With growing sigma the contact of a left flank runs towards the root.
        let along_profile = DVec3::new(sin, -self.side * cos, 0.0);
        self.length_per_roll * step.x * along_profile + step.y / self.helix_angle_rad.cos() * self.trace()
    }

    fn trace(&self) -> DVec3 {
        let (sin, cos) = self.helix_angle_rad.sin_cos();
        DVec3::new(-self.gear_hand * sin, 0.0, cos)
    }

    /// Length and angles of a step (sigma, z).
    pub fn step(&self, step_mm: DVec2) -> MarkStep {
        let v = self.on_flank(step_mm);
        let length_mm = v.length();
        let along = v.dot(self.trace());
        let across = (length_mm * length_mm - along * along).max(0.0).sqrt();
        let sign = if step_mm.x * along < 0.0 { -1.0 } else { 1.0 };
        MarkStep {
            step_mm,
            length_mm,
            to_trace_rad: sign * across.atan2(along.abs()),
            to_axis_rad: v.truncate().length().atan2(v.z.abs()),
        }
    }

    /// The shortest two independent steps of the lattice that two steps span (Lagrange and Gauss), shortest first.
    pub fn reduced(&self, [a, b]: [DVec2; 2]) -> [MarkStep; 2] {
        let (mut a, mut b) = (a, b);
        for _ in 0..64 {
            if self.on_flank(a).length_squared() > self.on_flank(b).length_squared() {
                (a, b) = (b, a);
            }
            let (u, v) = (self.on_flank(a), self.on_flank(b));
            let times = (u.dot(v) / u.length_squared()).round();
            if times == 0.0 {
                break;
            }
            b -= times * a;
        }
        [self.step(a), self.step(b)]
    }
}

/// Steps from mark to mark as the surface shows them: peaks of its autocorrelation, nearest first by `length`, none the negative of another.
///
/// `heights` stand on a regular grid, `count[0]` columns of `count[1]` rows, `spacing_mm` apart. Lags reach a third of the grid. A parabola through a peak's neighbours places it
/// between grid points.
pub fn autocorrelation_steps(
    heights: &[f64],
    count: [usize; 2],
    spacing_mm: [f64; 2],
    length: impl Fn(DVec2) -> f64,
) -> Vec<DVec2> {
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    let centered: Vec<f64> = heights.iter().map(|h| h - mean).collect();
    let reach = count.map(|n| (n / 3) as i64);
    let [columns, rows] = count.map(|n| n as i64);
    // Mean product of the overlapping parts, over their own powers: 1 for a surface that repeats itself.
    let correlation = |du: i64, dv: i64| {
        let (mut product, mut here, mut there) = (0.0, 0.0, 0.0);
        for column in du.max(0)..(columns + du).min(columns) {
            for row in dv.max(0)..(rows + dv).min(rows) {
                let a = centered[(column * rows + row) as usize];
                let b = centered[((column - du) * rows + row - dv) as usize];
                product += a * b;
                here += a * a;
                there += b * b;
            }
        }
        product / (here * there).sqrt()
    };
    let width = 2 * reach[1] + 1;
    // Half a plane of lags, with a border: the other half mirrors it.
    let lags: Vec<f64> = (-1..=reach[0])
        .flat_map(|du| (-reach[1]..=reach[1]).map(move |dv| (du, dv)))
        .map(|(du, dv)| correlation(du, dv))
        .collect();
    let at = |du: i64, dv: i64| lags[((du + 1) * width + dv + reach[1]) as usize];
    let mut peaks: Vec<DVec2> = Vec::new();
    for du in 0..reach[0] {
        for dv in -reach[1] + 1..reach[1] {
            if (du == 0 && dv <= 0) || at(du, dv) < SMALLEST_PEAK {
                continue;
            }
            let around = [(-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)];
            if around.iter().any(|&(i, j)| at(du + i, dv + j) > at(du, dv)) {
                continue;
            }
            let vertex =
                |before: f64, middle: f64, after: f64| 0.5 * (before - after) / (before - 2.0 * middle + after);
            let fine = DVec2::new(
                du as f64 + vertex(at(du - 1, dv), at(du, dv), at(du + 1, dv)),
                dv as f64 + vertex(at(du, dv - 1), at(du, dv), at(du, dv + 1)),
            );
            peaks.push(fine * DVec2::from_array(spacing_mm));
        }
    }
    peaks.sort_by(|a, b| length(*a).total_cmp(&length(*b)));
    peaks
}

/// Lower peaks are chance: marks repeat with correlations above 0.9.
const SMALLEST_PEAK: f64 = 0.5;

/// Arc at which a flank of a space crosses the pitch line in the section z = 0, for teeth of the space's half width `half_mm`.
pub fn crossing_arc_mm(space: i64, side: f64, transverse_module_mm: f64, half_mm: f64) -> f64 {
    space as f64 * PI * transverse_module_mm - side * half_mm
}
