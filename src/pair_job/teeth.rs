//! Contact tooth by tooth: where it begins and ends on the profiles, and with what.
//!
//! In: the moments of a period. Out: for every flank of the driver the range of heights over the pitch curve in which
//! its gap to the mate is no more than the marking thickness, on both gears, and how much of the time it carries.
//!
//! A pair is **on edge** where a tip corner or a fillet carries: it then asks for a rotation that no flank asks for.

use super::fit::Fit;
use super::flanks::PairFlanks;
use super::watch::WatchedUnits;
use crate::pair::assembly::{Meshing, Moment, ToothTouch};
use crate::pair::contact::TouchKind;
use crate::pair::pitch_pair::Member;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;

/// A corner or fillet that lifts the gears by less than this over what their flanks ask for carries nothing: it is the
/// end of a path of contact, um.
pub const LEAST_LIFT_UM: f64 = 0.05;

/// Contact on one flank of the driver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothContact {
    /// The driver's tooth, from 1.
    pub tooth: i64,
    /// Its flank.
    pub side: Side,
    /// Lowest and highest contact over the pitch curve of A and of B, mm.
    pub heights_mm: [[f64; 2]; 2],
    /// The same as arcs from the form points, mm; NaN on nominal flanks.
    pub arcs_mm: [[f64; 2]; 2],
    /// Moments at which it is within the marking thickness, and at which it is the pair that touches first.
    pub moments: [u32; 2],
}

/// A corner or a fillet that carries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeContact {
    /// How far it drives the gears beyond what flanks ask for, along the flank's normal, um.
    pub lift_um: f64,
    /// Number of the moment.
    pub moment: usize,
    /// The pair.
    pub pair: ToothTouch,
    /// What touches what.
    pub kind: EdgeKind,
}

/// What touches besides flanks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EdgeKind {
    /// Tip corner of a gear on the flank of the other: A, or B.
    Tip(Member),
    /// The other gear in the fillet of this one.
    Fillet(Member),
}

impl EdgeKind {
    /// As in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tip(Member::Driver) => "tip of A",
            Self::Tip(Member::Driven) => "tip of B",
            Self::Fillet(Member::Driver) => "fillet of A",
            Self::Fillet(Member::Driven) => "fillet of B",
        }
    }
}

/// What a pair touches with; none where flanks touch.
pub fn edge(flanks: &PairFlanks, side: Side, pair: &ToothTouch) -> Option<EdgeKind> {
    let [a, b] = &flanks.sections[pair.section];
    // In the fillet first: it is the tip of the other gear that stands there.
    if a.chain_u(side, pair.tooth, pair.touch.driver_place) < 0.0 {
        return Some(EdgeKind::Fillet(Member::Driver));
    }
    if b.chain_u(side, pair.tooth, pair.touch.driven_place) < 0.0 {
        return Some(EdgeKind::Fillet(Member::Driven));
    }
    match pair.touch.kind {
        TouchKind::DriverTip => Some(EdgeKind::Tip(Member::Driver)),
        TouchKind::DrivenTip => Some(EdgeKind::Tip(Member::Driven)),
        TouchKind::Inner | TouchKind::DriverRoot | TouchKind::DrivenRoot => None,
    }
}

/// Gap of a pair at the touch of its side, along the normal, um.
pub fn gap_um(meshing: &Meshing, moment: &Moment, side: Side, pair: &ToothTouch) -> f64 {
    let first_rad = moment.side(side).error_rad;
    -side.sign() * (first_rad - pair.touch.error_rad) * meshing.pitch.arm_mm(&moment.pitch, side) * UM_PER_MM
}

/// The edge contact of a side that lifts most, and the share of moments at which one carries.
pub fn edges(flanks: &PairFlanks, meshing: &Meshing, moments: &[Moment], side: Side) -> (Option<EdgeContact>, f64) {
    let mut most: Option<EdgeContact> = None;
    let mut carrying = 0_u32;
    for (index, moment) in moments.iter().enumerate() {
        let touch = moment.side(side);
        let Some(kind) = edge(flanks, side, &touch.acting) else { continue };
        let flank_pairs = touch.pairs.iter().filter(|pair| edge(flanks, side, pair).is_none());
        let lift_um = flank_pairs.map(|pair| gap_um(meshing, moment, side, pair)).fold(f64::INFINITY, f64::min);
        if lift_um < LEAST_LIFT_UM {
            continue;
        }
        carrying += 1;
        // With no flank within reach there is nothing to be lifted off.
        if lift_um.is_finite() && most.is_none_or(|found| lift_um > found.lift_um) {
            most = Some(EdgeContact { lift_um, moment: index, pair: touch.acting, kind });
        }
    }
    (most, f64::from(carrying) / moments.len() as f64)
}

/// How many pairs are within the marking thickness at a moment.
pub fn pairs_in_contact(meshing: &Meshing, moment: &Moment, side: Side, marking_um: f64) -> u32 {
    let near = moment.side(side).pairs.iter().filter(|pair| gap_um(meshing, moment, side, pair) <= marking_um);
    let mut teeth: Vec<i64> = near.map(|pair| pair.tooth).collect();
    teeth.sort_unstable();
    teeth.dedup();
    teeth.len() as u32
}

/// Contact on every flank of a side of the driver, in the order of teeth; flanks that never come within the marking
/// thickness are left out.
///
/// # Errors
/// A contact that has no foot on a pitch curve; Ctrl-C.
pub fn teeth(
    fit: &Fit,
    flanks: &PairFlanks,
    meshing: &Meshing,
    moments: &[Moment],
    side: Side,
    marking_um: f64,
    stage: &WatchedUnits,
) -> Result<Vec<ToothContact>> {
    let count = i64::from(fit.pitch.teeth().count[0]);
    let none = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    let mut found: Vec<ToothContact> = (1..=count)
        .map(|tooth| ToothContact { tooth, side, heights_mm: none, arcs_mm: none, moments: [0; 2] })
        .collect();
    for moment in moments {
        let touch = moment.side(side);
        for pair in touch.pairs.iter().filter(|pair| gap_um(meshing, moment, side, pair) <= marking_um) {
            let tooth = &mut found[(pair.tooth - 1).rem_euclid(count) as usize];
            tooth.moments[0] += 1;
            tooth.moments[1] += u32::from(*pair == touch.acting);
            let [a, b] = &flanks.sections[pair.section];
            let arcs = [
                a.chain_u(side, pair.tooth, pair.touch.driver_place),
                b.chain_u(side, pair.tooth, pair.touch.driven_place),
            ];
            let heights = heights_mm(fit, meshing, moment, pair.touch.point_mm)?;
            for gear in 0..2 {
                widen(&mut tooth.heights_mm[gear], heights[gear]);
                widen(&mut tooth.arcs_mm[gear], arcs[gear]);
            }
        }
        stage.count()?;
    }
    found.retain(|tooth| tooth.moments[0] > 0);
    Ok(found)
}

fn widen([low, high]: &mut [f64; 2], value: f64) {
    (*low, *high) = (value.min(*low), value.max(*high));
}

/// Heights of a point of the machine over both pitch curves, mm.
fn heights_mm(fit: &Fit, meshing: &Meshing, moment: &Moment, point_mm: DVec2) -> Result<[f64; 2], Refusal> {
    let pair = &fit.pitch;
    let axis_mm =
        [DVec2::ZERO, pair.axis_mm(Member::Driven) + DVec2::X * pair.sign() * meshing.center_distance_error_mm()];
    let height = |member: Member, axis_mm: DVec2| {
        let own_mm = pair.gear_from_machine(&moment.pitch, member, point_mm - axis_mm);
        pair.height(member, own_mm, moment.pitch.phi_1_rad).map(|(height_mm, _)| height_mm)
    };
    Ok([height(Member::Driver, axis_mm[0])?, height(Member::Driven, axis_mm[1])?])
}
