//! The edge of a hob tooth in its rake face: the worm's flank, a protuberance, the tip round, as segments.
//!
//! In: the scene's hob and the flank of its worm in the rake face ([`RakeFlank`]; the laws stand with the hob). Out:
//! the segments of one tooth, right root to left root, and where the flank proper ends.

use crate::process::hobbing::scene::model;
use crate::process::hobbing::scene::model::Worm;
use gearcut_core::error::Refusal;
use gearcut_core::math::convergence::{Step, iterate};
use gearcut_core::tool::edge::{Segment, SegmentName};
use gearcut_core::tool::edge_profile::BladeCurve;
use gearcut_core::tool::edge_table::TableError;
use glam::DVec2;
use std::ops::ControlFlow;

/// Steps to the place where the tip round touches the flank at most, and how far rounding may still move it then, mm.
const TOUCH_STEPS: u32 = 100;
const TOUCH_SETTLED_MM: f64 = 1e-9;
/// Smallest tip land, modules: less is a pointed tooth.
const SMALLEST_TIP_LAND_MODULES: f64 = 0.01;

/// Left flank in the rake face over its distance from the axis.
#[derive(Debug, Clone)]
pub(super) struct RakeFlank {
    pub worm: Worm,
    /// Distance from the axis before regrinding at which the half thickness is `half_mm`.
    pub reference_radius_mm: f64,
    pub half_mm: f64,
    /// Axial lengths in the rake face over those in the axial section.
    pub scale: f64,
    pub parameter_mm_per_rad: f64,
    pub base_radius_mm: f64,
    pub axial_tan: f64,
    pub regrind_mm: f64,
    /// How far this part of the flank stands out of its line.
    pub relief: Option<FlankRelief>,
}

/// A part of a flank that stands out of its line: distance from the axis at which it begins (new hob), what it stands
/// out by there, and how much more per length towards the axis; in the axial section.
#[derive(Debug, Clone, Copy)]
pub(super) struct FlankRelief {
    from_mm: f64,
    aside_mm: f64,
    slope: f64,
}

impl RakeFlank {
    /// Half thickness (rake face) and its derivative at a radius of the new hob.
    pub fn half_and_slope(&self, radius_mm: f64) -> [f64; 2] {
        let [drop, slope] = match self.worm {
            Worm::Involute => {
                let u = |r: f64| ((r / self.base_radius_mm).powi(2) - 1.0).sqrt();
                let (at, reference) = (u(radius_mm), u(self.reference_radius_mm));
                let involute = (at - at.atan()) - (reference - reference.atan());
                [self.parameter_mm_per_rad * involute, self.parameter_mm_per_rad * at / radius_mm]
            }
            Worm::StraightSided => [(radius_mm - self.reference_radius_mm) * self.axial_tan, self.axial_tan],
        };
        let [out, more] =
            self.relief.map_or([0.0, 0.0], |of| [of.aside_mm + of.slope * (of.from_mm - radius_mm), of.slope]);
        [self.scale * (self.half_mm - drop + out), -self.scale * (slope + more)]
    }

    /// Second derivative of the half thickness at a radius of the new hob, 1/mm.
    pub fn bend_per_mm(&self, radius_mm: f64) -> f64 {
        match self.worm {
            Worm::Involute => {
                let u = ((radius_mm / self.base_radius_mm).powi(2) - 1.0).sqrt();
                -self.scale * self.parameter_mm_per_rad / (u * radius_mm * radius_mm)
            }
            Worm::StraightSided => 0.0,
        }
    }

    /// Unit normal out of the tooth.
    fn normal(&self, radius_mm: f64) -> DVec2 {
        DVec2::new(-self.half_and_slope(radius_mm)[1], 1.0).normalize()
    }
}

impl BladeCurve for RakeFlank {
    fn point_and_rate(&self, radius_mm: f64) -> [DVec2; 2] {
        let [half, slope] = self.half_and_slope(radius_mm);
        [DVec2::new(radius_mm - self.regrind_mm, half), DVec2::new(1.0, slope)]
    }
}

/// Segments of one tooth, right root to left root, and the radius where the flank proper ends.
pub(super) fn tooth_edge(
    spec: &model::HobSpec,
    flank: &RakeFlank,
    [root_mm, tip_mm]: [f64; 2],
    pitch_mm: f64,
    module_mm: f64,
    cos_lead: f64,
) -> Result<(Vec<Segment>, f64), Refusal> {
    let drop = |p: DVec2| p - DVec2::new(flank.regrind_mm, 0.0);
    let r = spec.tip_radius_mm;
    // The last flank before the tip is the worm's own or the protuberance, a straight line in the rake face.
    let protuberance = spec.protuberance.map(|p| {
        let start_mm = tip_mm - p.height_mm;
        let tan = flank.scale * p.angle_rad.tan() / cos_lead;
        (start_mm, flank.half_and_slope(start_mm)[0], tan)
    });
    if let Some((start_mm, _, tan)) = protuberance
        && (start_mm <= root_mm || tan >= -flank.half_and_slope(start_mm)[1])
    {
        return Err(Refusal::new(
            "tool.hob.protuberance_height_mm",
            format!("a protuberance beginning {:.3} mm below the tip does not rise over the flank", tip_mm - start_mm),
            "use a height below the whole tooth depth and a protuberance_angle_deg smaller than the pressure angle",
        ));
    }
    let half_at = |radius: f64| match protuberance {
        Some((start_mm, half, tan)) if radius > start_mm => half - (radius - start_mm) * tan,
        _ => flank.half_and_slope(radius)[0],
    };
    let normal_at = |radius: f64| match protuberance {
        Some((start_mm, _, tan)) if radius > start_mm => DVec2::new(tan, 1.0).normalize(),
        _ => flank.normal(radius),
    };
    // The round touches the flank where its centre, r inside, lies r below the tip.
    let touch_mm = iterate("the place where the tip round touches the flank", tip_mm, TOUCH_STEPS, |touch_mm| {
        let to = tip_mm - r + r * normal_at(touch_mm).x;
        let residual = to - touch_mm;
        if residual == 0.0 { ControlFlow::Break(to) } else { ControlFlow::Continue(Step { to, residual }) }
    })
    .or_else(|error| error.settled(TOUCH_SETTLED_MM))
    .map_err(|error| {
        Refusal::new("tool.hob.tip_radius_mm", error.to_string(), "use a smaller round or a thicker tooth")
    })?;
    let center = DVec2::new(touch_mm, half_at(touch_mm)) - r * normal_at(touch_mm);
    let land_mm = 2.0 * center.y;
    let blocked = protuberance.is_some_and(|(start_mm, ..)| touch_mm <= start_mm);
    if land_mm < SMALLEST_TIP_LAND_MODULES * module_mm || blocked {
        let sharp_land_mm = 2.0 * half_at(tip_mm);
        let (key, problem) = if r > 0.0 && sharp_land_mm > 0.0 {
            ("tool.hob.tip_radius_mm", format!("a tip round of {r} mm does not fit the hob's tip"))
        } else {
            ("tool.hob.addendum_coefficient", "the hob's teeth are pointed below their tip".to_owned())
        };
        return Err(Refusal::new(
            key,
            problem,
            format!(
                "the tip is {sharp_land_mm:.3} mm wide without a round; use a smaller round or addendum_coefficient"
            ),
        ));
    }
    let no_fit = |error: TableError| {
        Refusal::new(
            "tool.hob",
            error.to_string(),
            "the flank is too long or too sharply curved; use ordinary proportions",
        )
    };
    let flank_end_mm = protuberance.map_or(touch_mm, |(start_mm, ..)| start_mm);
    let touch = DVec2::new(touch_mm, half_at(touch_mm));
    let mut left_half = Vec::new();
    if r > 0.0 {
        let angles = [0.0, normal_at(touch_mm).to_angle()];
        left_half.push(Segment::arc(SegmentName::CornerLeft, drop(center), r, angles));
    }
    if let Some((start_mm, half, _)) = protuberance {
        left_half.push(Segment::straight(SegmentName::CornerLeft, drop(touch), drop(DVec2::new(start_mm, half))));
    }
    let parts = flank_parts(spec, flank, [flank_end_mm, root_mm], cos_lead)?;
    for (index, (part, from_mm)) in parts.iter().enumerate() {
        let to_mm = parts.get(index + 1).map_or(root_mm, |(_, from_mm)| *from_mm);
        left_half.push(Segment::curve(SegmentName::FlankLeft, part, [*from_mm, to_mm]).map_err(no_fit)?);
    }
    let at_root = parts.last().map_or(flank, |(part, _)| part);
    let root = DVec2::new(root_mm, at_root.half_and_slope(root_mm)[0]);
    if root.y < 0.5 * pitch_mm {
        let middle = DVec2::new(root_mm, 0.5 * pitch_mm);
        left_half.push(Segment::straight(SegmentName::RootLeft, drop(root), drop(middle)));
    }
    let tip_end = drop(DVec2::new(tip_mm, center.y));
    let tip = Segment::straight(SegmentName::Tip, DVec2::new(tip_end.x, -tip_end.y), tip_end);
    let mut segments: Vec<Segment> = left_half.iter().rev().map(Segment::mirrored).collect();
    segments.push(tip);
    segments.extend(left_half);
    Ok((segments, flank_end_mm - flank.regrind_mm))
}

/// The flank and its parts that relieve or chamfer the gear's tips, each with the distance from the axis (new hob) from
/// which on it goes towards the root.
fn flank_parts(
    spec: &model::HobSpec,
    flank: &RakeFlank,
    [flank_end_mm, root_mm]: [f64; 2],
    cos_lead: f64,
) -> Result<Vec<(RakeFlank, f64)>, Refusal> {
    let mut parts = vec![(flank.clone(), flank_end_mm)];
    let mut before: Option<FlankRelief> = None;
    for relief in &spec.tip_reliefs {
        let from_mm = flank.reference_radius_mm - relief.height_mm;
        if from_mm <= root_mm || from_mm >= flank_end_mm {
            return Err(Refusal::new(
                "tool.hob",
                format!(
                    "tip relief or semi-topping begins {:.3} mm over the pitch line; the flank goes from {:.3} mm \
                     under it to {:.3} mm over it",
                    relief.height_mm,
                    flank_end_mm - flank.reference_radius_mm,
                    flank.reference_radius_mm - root_mm
                ),
                "begin it on the flank, or use a larger dedendum_coefficient",
            ));
        }
        let aside_mm = before.map_or(0.0, |of| of.aside_mm + of.slope * (of.from_mm - from_mm));
        let part = FlankRelief { from_mm, aside_mm, slope: relief.slope / cos_lead };
        parts.push((RakeFlank { relief: Some(part), ..flank.clone() }, from_mm));
        before = Some(part);
    }
    Ok(parts)
}
