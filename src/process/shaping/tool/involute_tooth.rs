//! A cutter tooth with involute flanks: its profile and its edge.
//!
//! In: what the scene says of the cutter. Out: [`InvoluteTooth`] with the edge. The edge is the **projected transverse
//! profile**: an involute with the gear's pressure angle on the pitch circle r_c = m z0 / 2, tooth thickness pi m / 2 +
//! 2 x0 m tan(alpha) - thinning, tip circle (ha0 + x0) m above it. Below the base circle the flank goes on straight
//! along the tangent of the involute's last point, as cutters are relieved there; its exact run touches only gear tips
//! that reach below the cutter's involute.

use super::ground_flank::GroundFlank;
use crate::process::shaping::scene::model;
use crate::process::shaping::scene::model::Grinding;
use crate::scene::model::Gear;
use gearcut_core::error::Refusal;
use gearcut_core::tool::edge::{Edge, Segment, SegmentName};
use gearcut_core::tool::edge_profile::BladeCurve as _;
use gearcut_core::tool::edge_table::TableError;
use gearcut_core::tool::involute::{Involute, inv};
use glam::DVec2;
use std::f64::consts::PI;

/// Smallest root circle, as a share of the pitch radius: a choice, no limit of the method. The teeth need a body with a
/// bore; with usual dedenda of 1.25 modules it refuses cutters of three teeth and fewer.
const LEAST_ROOT_SHARE: f64 = 0.2;
/// Least height of the tip circle over the base circle, as a share of its radius: below it nothing of the flank is an
/// involute. A choice: a hundred times what the start of the involute is rounded by.
const LEAST_INVOLUTE_SHARE: f64 = 1e-4;
/// Key of the profile shift.
pub(in crate::process::shaping) const PROFILE_SHIFT: &str = "tool.shaper_cutter.profile_shift_coefficient";
/// The involute is followed down to the roll where its tangent leaves it by this much at the base circle: half the edge
/// tables' tolerance.
const BASE_CIRCLE_TOLERANCE_MM: f64 = 2.5e-8;
/// Below this radius of curvature (in modules) the involute gets a table of its own: its curvature changes too fast for
/// the cells of the rest.
const NEAR_BASE_CURVATURE_MODULES: f64 = 0.5;
/// Steps to the corner of a ground tooth: each leaves a thousandth of the one before, of some micrometres.
const CORNER_STEPS: usize = 4;

/// A cutter tooth with involute flanks.
#[derive(Debug, Clone, PartialEq)]
pub struct InvoluteTooth {
    /// r_b = r_c cos(alpha).
    pub base_radius_mm: f64,
    /// Half tooth angle on the base circle.
    pub half_angle_rad: f64,
    /// Rolls where the involute starts (near the base circle) and ends (at the tip corner).
    pub roll_range: [f64; 2],
    /// Length of the straight base between the involute and the root circle; 0 where the involute reaches it.
    pub base_length_mm: f64,
    /// What lies between the left flank and the tip circle, from the flank on; the right side mirrors it.
    pub corner: Vec<CornerPart>,
}

impl InvoluteTooth {
    /// One flank; `side` +1: left (counter-clockwise), -1: right.
    pub fn flank(&self, side: f64) -> Involute {
        Involute { base_radius_mm: self.base_radius_mm, half_angle_rad: self.half_angle_rad, side }
    }
}

/// Part of the left tip corner that the fillet is the envelope of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CornerPart {
    /// A round, or a sharp corner (radius 0): a circle that touches with normals between two polar angles in the tooth
    /// frame.
    Round {
        /// Centre in the tooth frame.
        center_mm: DVec2,
        /// Radius; 0 for a sharp corner.
        radius_mm: f64,
        /// Angle of the outward normal on the tip's side and on the flank's side.
        normals_rad: [f64; 2],
    },
    /// A straight chamfer.
    Chamfer {
        /// End on the flank's side.
        flank_end_mm: DVec2,
        /// End on the tip's side.
        tip_end_mm: DVec2,
    },
}

/// The tooth of a scene, its edge, and the radii of its tip and its root.
///
/// # Errors
/// Pointed teeth, teeth without an involute, a tip round that does not fit.
pub(super) fn involute_tooth(
    spec: &model::CutterSpec,
    gear: &Gear,
) -> Result<(InvoluteTooth, Edge, [f64; 2]), Refusal> {
    tooth_with(spec, gear, None)
}

/// Thickness of a tooth on the pitch circle, mm.
fn thickness_mm(spec: &model::CutterSpec, gear: &Gear) -> f64 {
    let shift_mm = spec.profile_shift_coefficient * gear.module_mm;
    0.5 * PI * gear.module_mm + 2.0 * shift_mm * gear.pressure_angle_rad.tan() - spec.thinning_mm
}

/// The edge of the same tooth as it is ground. Its tip begins where the ground flank ends, as if the whole tooth were
/// that much thicker.
///
/// # Errors
/// The same; a pressure angle of another cutter.
pub(super) fn ground_edge(spec: &model::CutterSpec, grinding: &Grinding, gear: &Gear) -> Result<Edge, Refusal> {
    let flank = GroundFlank::new(spec, grinding, gear, thickness_mm(spec, gear))?;
    let mut thicker = spec.clone();
    for _ in 0..CORNER_STEPS {
        let (tooth, ..) = tooth_with(&thicker, gear, None)?;
        let corner_mm = tooth.flank(1.0).point(tooth.roll_range[1]).length();
        thicker.thinning_mm = spec.thinning_mm - 2.0 * flank.deviation_mm(corner_mm) / gear.pressure_angle_rad.cos();
    }
    tooth_with(&thicker, gear, Some(&flank)).map(|(_, edge, _)| edge)
}

/// The tooth with its edge, whose flanks are ground ones where there is one.
fn tooth_with(
    spec: &model::CutterSpec,
    gear: &Gear,
    ground: Option<&GroundFlank>,
) -> Result<(InvoluteTooth, Edge, [f64; 2]), Refusal> {
    let (m, alpha) = (gear.module_mm, gear.pressure_angle_rad);
    let pitch_radius_mm = 0.5 * m * f64::from(spec.teeth);
    let base_radius_mm = pitch_radius_mm * alpha.cos();
    let x0 = spec.profile_shift_coefficient;
    let tip_radius_mm = pitch_radius_mm + (spec.addendum_coefficient + x0) * m;
    let root_radius_mm = pitch_radius_mm - (spec.dedendum_coefficient - x0) * m;
    let thickness_mm = thickness_mm(spec, gear);
    let half_angle_rad = 0.5 * thickness_mm / pitch_radius_mm + inv(alpha);
    let left = Involute { base_radius_mm, half_angle_rad, side: 1.0 };
    if root_radius_mm <= LEAST_ROOT_SHARE * pitch_radius_mm {
        return Err(Refusal::new(
            "tool.shaper_cutter.dedendum_coefficient",
            format!("the cutter's root circle has radius {root_radius_mm:.3} mm; nothing is left of its body"),
            "use more cutter teeth or a smaller dedendum",
        ));
    }
    let tip_half_angle = |radius_mm: f64| {
        let u = left.roll_at_radius(radius_mm);
        half_angle_rad - (u - u.atan())
    };
    if tip_radius_mm <= base_radius_mm * (1.0 + LEAST_INVOLUTE_SHARE) {
        let least = (base_radius_mm * (1.0 + LEAST_INVOLUTE_SHARE) - pitch_radius_mm) / m;
        return Err(Refusal::new(
            if x0 < 0.0 { PROFILE_SHIFT } else { "tool.shaper_cutter.addendum_coefficient" },
            format!(
                "with an addendum of {} and a profile shift of {x0} modules the cutter's tip circle of radius \
                {tip_radius_mm:.3} mm allows no involute over the base circle of radius \
                {base_radius_mm:.3} mm",
                spec.addendum_coefficient
            ),
            format!("together they must be more than {least:.3} modules: use more of either, or more cutter teeth"),
        ));
    }
    if thickness_mm <= 0.0 {
        return Err(Refusal::new(
            if x0 < 0.0 { PROFILE_SHIFT } else { "tool.shaper_cutter.thinning_mm" },
            format!(
                "a profile shift of {x0} modules and a thinning of {} mm leave the cutter's teeth no thickness on \
                its pitch circle ({thickness_mm:.3} mm)",
                spec.thinning_mm
            ),
            "use a larger profile_shift_coefficient or less thinning_mm",
        ));
    }
    if tip_half_angle(tip_radius_mm) <= 0.0 {
        return Err(Refusal::new(
            "tool.shaper_cutter.addendum_coefficient",
            format!("the cutter's teeth are pointed below the tip circle of radius {tip_radius_mm:.3} mm"),
            "use a smaller addendum_coefficient or profile_shift_coefficient, less thinning_mm, or more cutter \
            teeth",
        ));
    }
    let least_roll = |base_mm: f64| (6.0 * BASE_CIRCLE_TOLERANCE_MM / base_mm).cbrt();
    let start_roll = least_roll(base_radius_mm).max(left.roll_at_radius(root_radius_mm));

    // Tip corner: the roll where the involute ends, and the segments between it and the tip circle.
    let (end_roll, corner, corner_segment, tip_angle_rad) = match spec.tip {
        model::Tip::Sharp => {
            let u = left.roll_at_radius(tip_radius_mm);
            let center_mm = left.point(u);
            let normals_rad = [center_mm.to_angle(), left.normal(u).to_angle()];
            (u, vec![CornerPart::Round { center_mm, radius_mm: 0.0, normals_rad }], None, center_mm.to_angle())
        }
        model::Tip::Round { radius_mm } => {
            // The round's centre lies on the parallel involute radius_mm inside the flank, radius_mm below the tip
            // circle.
            let inner = Involute { half_angle_rad: half_angle_rad - radius_mm / base_radius_mm, ..left };
            let u_center = inner.roll_at_radius(tip_radius_mm - radius_mm);
            let center_mm = inner.point(u_center);
            let u = u_center + radius_mm / base_radius_mm;
            if center_mm.y <= 0.0 || u <= start_roll {
                return Err(Refusal::new(
                    "tool.shaper_cutter.tip.round.radius_mm",
                    format!("a tip round of {radius_mm} mm does not fit the cutter's tip"),
                    format!("use less; half the tip land is {:.3} mm", tip_radius_mm * tip_half_angle(tip_radius_mm)),
                ));
            }
            let normals_rad = [center_mm.to_angle(), left.normal(u).to_angle()];
            let arc = Segment::arc(SegmentName::CornerLeft, center_mm, radius_mm, normals_rad);
            (u, vec![CornerPart::Round { center_mm, radius_mm, normals_rad }], Some(arc), normals_rad[0])
        }
        model::Tip::Chamfer { height_mm, angle_rad } => {
            let u = left.roll_at_radius(tip_radius_mm - height_mm);
            let start = left.point(u);
            // Along the chamfer: outwards and towards the centre line at angle_rad from it.
            let along = DVec2::new(angle_rad.cos(), -angle_rad.sin());
            let b = start.dot(along);
            let run = -b + (b * b - start.length_squared() + tip_radius_mm * tip_radius_mm).max(0.0).sqrt();
            let end = start + run * along;
            let normal_rad = along.perp().to_angle();
            let flank_normal_rad = left.normal(u).to_angle();
            if end.y <= 0.0 || u <= start_roll || height_mm <= 0.0 || normal_rad >= flank_normal_rad {
                return Err(Refusal::new(
                    "tool.shaper_cutter.tip.chamfer.height_mm",
                    format!("a chamfer {height_mm} mm high at this angle does not fit the cutter's tip"),
                    "use a smaller height_mm, or an angle_deg between the flank's own slope and 90",
                ));
            }
            let corner = |center_mm, normals_rad| CornerPart::Round { center_mm, radius_mm: 0.0, normals_rad };
            let parts = vec![
                corner(start, [normal_rad, flank_normal_rad]),
                CornerPart::Chamfer { flank_end_mm: start, tip_end_mm: end },
                corner(end, [end.to_angle(), normal_rad]),
            ];
            (u, parts, Some(Segment::straight(SegmentName::CornerLeft, end, start)), end.to_angle())
        }
    };

    let no_fit = |error: TableError| {
        Refusal::new(
            "tool.shaper_cutter",
            error.to_string(),
            "the flank is too long or too sharply curved; use ordinary proportions",
        )
    };
    // Base circle of the flank that cuts, and its rolls where it ends at the tip corner and where it starts.
    let (edge_base_mm, [edge_end, edge_start]) = match ground {
        None => (base_radius_mm, [end_roll, start_roll]),
        Some(flank) => {
            let base_mm = flank.base_radius_mm;
            let [end, start] =
                [end_roll, start_roll].map(|roll| flank.roll_at_radius(base_radius_mm * roll.hypot(1.0)));
            (base_mm, [end, start.max(least_roll(base_mm))])
        }
    };
    let arc_mm = |roll: f64| 0.5 * edge_base_mm * roll * roll;
    let (start, inwards) = match ground {
        None => (left.point(start_roll), left.normal(start_roll).perp()),
        Some(flank) => {
            let [point_mm, rate] = flank.point_and_rate(arc_mm(edge_start));
            (point_mm, -rate.normalize())
        }
    };
    let start_radius_mm = start.length();
    let near_base_roll = NEAR_BASE_CURVATURE_MODULES * m / edge_base_mm;
    let mut flank_rolls = vec![edge_end];
    if edge_start < 0.5 * near_base_roll && edge_end > 2.0 * near_base_roll {
        flank_rolls.push(near_base_roll);
    }
    flank_rolls.push(edge_start);

    // The left half of the chain, from the tip's middle to the root's middle.
    let mut left_half = Vec::new();
    left_half.extend(corner_segment);
    for rolls in flank_rolls.windows(2) {
        let name = SegmentName::FlankLeft;
        let flank = match ground {
            None => Segment::involute(name, left, [rolls[1], rolls[0]]),
            Some(flank) => Segment::curve(name, flank, [rolls[0], rolls[1]].map(arc_mm)),
        };
        left_half.push(flank.map_err(no_fit)?);
    }
    let mut root_from_rad = start.to_angle();
    let mut base_length_mm = 0.0;
    if start_radius_mm > root_radius_mm + 1e-6 {
        let b = start.dot(inwards);
        let run = -b - (b * b - start_radius_mm * start_radius_mm + root_radius_mm * root_radius_mm).max(0.0).sqrt();
        let end = start + run * inwards;
        base_length_mm = run;
        root_from_rad = end.to_angle();
        left_half.push(Segment::straight(SegmentName::BaseLeft, start, end));
    }
    let half_pitch_rad = PI / f64::from(spec.teeth);
    if root_from_rad < half_pitch_rad {
        let angles = [root_from_rad, half_pitch_rad];
        left_half.push(Segment::arc(SegmentName::RootLeft, DVec2::ZERO, root_radius_mm, angles));
    }
    let tip = Segment::arc(SegmentName::Tip, DVec2::ZERO, tip_radius_mm, [-tip_angle_rad, tip_angle_rad]);
    let mut segments = left_half.iter().rev().map(Segment::mirrored).collect::<Vec<_>>();
    segments.push(tip);
    segments.extend(left_half);

    let tooth =
        InvoluteTooth { base_radius_mm, half_angle_rad, roll_range: [start_roll, end_roll], base_length_mm, corner };
    Ok((tooth, Edge::new(segments), [tip_radius_mm, root_radius_mm]))
}
