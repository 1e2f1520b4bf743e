//! The flanks of both gears as they are rolled: cut or nominal, in the frames and under the labels of the pair.
//!
//! In: two gears that belong together. Out: [`PairFlanks`]: chains for the contact search, arcs along the profiles, and
//! the outlines of spaces for the corners.
//!
//! Cut flanks go on into the root. On the driven gear they end where the root turns along the pitch curve: there the
//! distance from the axis no longer tells places apart, and what comes so deep is found as a corner in the outline.
//! Nominal flanks are the conjugate ones of the straight-sided rack; they have no root.

use crate::job::{CylindricalGear, rows_z_mm};
use crate::pair::assembly::{AssemblyErrors, Meshing, SectionFlanks};
use crate::pair::flank_chain::{FlankChain, GearFlanks, nominal_section};
use crate::pair::penetration::SpaceOutline;
use crate::pair::pitch_pair::Member;
use crate::process::{self, ProcessJob};
use crate::scene::Scene;
use crate::scene::model::Gear;
use crate::steps::view_mesh::ViewMesh;
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;
use gearcut_core::terms::{Hand, Side};

use super::fit::Fit;
use super::generated::FlankEnds;
use super::outline::{self, GearInSections, ToothOutline};
use super::watch::{CUT, Watch};

/// Least change of the distance from the axis along a driven root, as a share of its arc: with less it may turn back
/// when the gear is mounted off its axis.
const LEAST_CLIMB: f64 = 0.05;

/// Which flanks are rolled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlankSource {
    /// Cut ones: nominal points and the heights that are left on them.
    Cut,
    /// Conjugate flanks without feed marks, roots and errors of cutting.
    Nominal,
}

/// Both gears made ready to cut.
pub type ReadyGears = [Box<dyn ProcessJob>; 2];

/// Makes both gears ready to cut; none for nominal flanks.
///
/// # Errors
/// Geometry that cannot be cut.
pub fn made_ready(scenes: [&Scene; 2], source: FlankSource) -> Result<Option<ReadyGears>> {
    match source {
        FlankSource::Cut => Ok(Some([process::prepare(scenes[0])?, process::prepare(scenes[1])?])),
        FlankSource::Nominal => Ok(None),
    }
}

/// Whether errors may let sections of either gear differ along the tooth.
///
/// # Errors
/// A machine that yields, whose strokes cannot be followed.
pub fn errors_vary_along_tooth(ready: &ReadyGears) -> Result<bool> {
    let mut vary = false;
    for job in ready {
        job.with_gear(&mut |gear| {
            vary |= gear.cylindrical().is_some_and(CylindricalGear::errors_vary_along_tooth);
            Ok(())
        })?;
    }
    Ok(vary)
}

/// Places of `count` sections over a face, mm from its middle: one in the middle, or evenly with both ends.
pub fn sections_z_mm(face_mm: f64, count: usize) -> Vec<f64> {
    if count == 1 { vec![0.0] } else { rows_z_mm(face_mm, face_mm / (count as f64 - 1.0)) }
}

/// Flanks of one gear in one section.
#[derive(Debug, Clone)]
pub struct SectionOfGear {
    /// Chains to roll, by the labels of the pair.
    pub chains: GearFlanks<FlankChain>,
    /// Arc from the form point at every point of the chains, mm; empty on nominal flanks.
    pub u_mm: GearFlanks<Vec<f64>>,
    /// Spaces by label: that which the right flank of a label bounds; none on nominal flanks.
    pub spaces: Vec<SpaceOutline>,
    /// Whether the right flank of a label is the first one of its space, seen counter-clockwise: on a ring.
    pub right_is_first: bool,
    /// Points of the root that the outlines of spaces have and the chains leave out.
    left_out: GearFlanks<usize>,
}

impl SectionOfGear {
    /// Arc from the form point, mm, at a place along a flank of an outline; the chain's lower end where it begins
    /// later.
    pub fn outline_u(&self, side: Side, label: i64, place: f64) -> f64 {
        arc_at(self.u_mm.get(side, label), place - *self.left_out.get(side, label) as f64)
    }

    /// Arc from the form point, mm, at a place along a chain; NaN on nominal flanks.
    pub fn chain_u(&self, side: Side, label: i64, place: f64) -> f64 {
        arc_at(self.u_mm.get(side, label), place)
    }
}

fn arc_at(u_mm: &[f64], place: f64) -> f64 {
    let Some(last) = u_mm.len().checked_sub(1) else { return f64::NAN };
    let place = place.clamp(0.0, last as f64);
    let i = (place as usize).min(last - 1);
    u_mm[i] + (place - i as f64) * (u_mm[i + 1] - u_mm[i])
}

/// Both gears in all sections.
#[derive(Debug, Clone)]
pub struct PairFlanks {
    /// Places along the face, mm.
    pub rows_mm: Vec<f64>,
    /// Driver and driven gear in every section.
    pub sections: Vec<[SectionOfGear; 2]>,
    /// Where the flanks that the tools generate begin and end; none of nominal flanks, which no tool has made.
    pub ends: Option<[FlankEnds; 2]>,
    /// Both gears to look at; none of nominal flanks, which belong to no body.
    pub views: Option<[ViewMesh; 2]>,
}

impl PairFlanks {
    /// Flanks of the gears of two scenes in `count` sections over the common face: as they are cut where the gears are
    /// made ready, else nominal ones.
    ///
    /// # Errors
    /// Gears that cannot be cut; flanks that the teeth do not reach; Ctrl-C.
    pub fn new(
        fit: &Fit,
        scenes: [&Scene; 2],
        ready: Option<&ReadyGears>,
        count: usize,
        backend: &dyn Backend,
        watch: &Watch,
    ) -> Result<Self> {
        let face_mm = scenes[0].gear.face_width_mm.min(scenes[1].gear.face_width_mm);
        let rows_mm = sections_z_mm(face_mm, count);
        let (mut ends, mut views) = (None, None);
        let sections = match ready {
            Some(jobs) => {
                let cut = |at: usize| -> Result<GearInSections> {
                    // A root and two flanks for each tooth.
                    let stage = watch.stage(CUT[at], 3 * scenes[at].gear.teeth as usize, "flanks and roots")?;
                    let gear = outline::cut(jobs[at].as_ref(), backend, &rows_mm, &stage)?;
                    stage.finish();
                    Ok(gear)
                };
                let (a, b) = (cut(0)?, cut(1)?);
                let sections = a.sections.iter().zip(&b.sections).map(|(a, b)| [driver(a), driven(fit, b)]).collect();
                (ends, views) = (Some([a.ends, b.ends]), Some([a.view, b.view]));
                sections
            }
            None => {
                let section = |z_mm: &f64| -> Result<_> {
                    watch.check()?;
                    let shift_mm = shift_mm(fit, &scenes[0].gear, *z_mm);
                    let gear = |member| nominal(fit, member, shift_mm);
                    Ok([gear(Member::Driver)?, gear(Member::Driven)?])
                };
                rows_mm.iter().map(section).collect::<Result<_>>()?
            }
        };
        Ok(Self { rows_mm, sections, ends, views })
    }

    /// The gears in the machine.
    pub fn meshing(&self, fit: &Fit, driver: &Gear, mounting: &AssemblyErrors) -> Meshing {
        let section = |(z_mm, [a, b]): (&f64, &[SectionOfGear; 2])| {
            (*z_mm, shift_mm(fit, driver, *z_mm), a.chains.clone(), b.chains.clone())
        };
        let owned: Vec<_> = self.rows_mm.iter().zip(&self.sections).map(section).collect();
        let sections: Vec<SectionFlanks> = owned
            .iter()
            .map(|(z_mm, shift_mm, driver, driven)| SectionFlanks { z_mm: *z_mm, shift_mm: *shift_mm, driver, driven })
            .collect();
        Meshing::of_sections(fit.pitch.clone(), &sections, mounting)
    }
}

/// How far the teeth of a helical driver stand along its pitch curve in a section, mm.
fn shift_mm(fit: &Fit, gear: &Gear, z_mm: f64) -> f64 {
    let hand = if gear.hand == Hand::Left { -1.0 } else { 1.0 };
    hand * fit.stretch() * gear.helix_angle_rad.tan() * z_mm
}

fn driver(flanks: &GearFlanks<ToothOutline>) -> SectionOfGear {
    let teeth = flanks.right.len() as i64;
    let space = |label: i64| {
        // The space before a tooth lies between the left flank of the one before and its own right one.
        let [left, right] = [(Side::Left, label - 1), (Side::Right, label)];
        let chain = |(side, label)| FlankChain::straight(flanks.get(side, label).points_mm.clone());
        SpaceOutline::new(&chain(left), &chain(right), 1.0)
    };
    SectionOfGear {
        chains: flanks.each(|profile| FlankChain::straight(profile.points_mm.clone())),
        u_mm: flanks.each(|profile| profile.u_mm.clone()),
        spaces: (0..teeth).map(space).collect(),
        right_is_first: false,
        left_out: flanks.each(|_| 0),
    }
}

fn driven(fit: &Fit, flanks: &GearFlanks<ToothOutline>) -> SectionOfGear {
    let teeth = flanks.right.len() as u32;
    let tip_sign = fit.pitch.sign();
    let in_pair = |profile: &ToothOutline| -> Vec<_> { profile.points_mm.iter().map(|p| fit.in_pair(*p)).collect() };
    let own = |side: Side, label: i64| {
        let (side, tooth) = fit.mate_flank(side, label);
        flanks.get(side, tooth)
    };
    let rolled = |side: Side, label: i64| {
        let profile = own(side, label);
        let first = climbing_from(profile);
        (FlankChain::straight(in_pair(profile).split_off(first)), profile.u_mm[first..].to_vec(), first)
    };
    let all = |side: Side| (0..i64::from(teeth)).map(move |label| (side, label));
    let of = |side: Side| all(side).map(|(side, label)| rolled(side, label)).collect::<Vec<_>>();
    let rolled = GearFlanks { right: of(Side::Right), left: of(Side::Left) };
    let space = |label: i64| {
        let (side, tooth) = fit.mate_flank(Side::Right, label);
        // Seen from the driven gear: the flank at the smaller angle of the space is the left one of the tooth before.
        let (left, right) = if side == Side::Right { (tooth - 1, tooth) } else { (tooth, tooth + 1) };
        let chain = |side, tooth| FlankChain::straight(in_pair(flanks.get(side, tooth)));
        SpaceOutline::new(&chain(Side::Left, left), &chain(Side::Right, right), tip_sign)
    };
    SectionOfGear {
        chains: rolled.each(|(chain, ..)| chain.clone()),
        u_mm: rolled.each(|(_, u_mm, _)| u_mm.clone()),
        spaces: (0..i64::from(teeth)).map(space).collect(),
        right_is_first: tip_sign < 0.0,
        left_out: rolled.each(|(.., first)| *first),
    }
}

/// First point from which the distance from the axis changes steadily up to the tip.
fn climbing_from(profile: &ToothOutline) -> usize {
    let points = &profile.points_mm;
    let last = points.len() - 1;
    let outwards = (points[last].length() - points[0].length()).signum();
    let climbs = |i: usize| {
        let arc_mm = points[i + 1].distance(points[i]);
        outwards * (points[i + 1].length() - points[i].length()) > LEAST_CLIMB * arc_mm
    };
    // Down to the form point the flank is as it was cut, whether it turns back or not.
    let form = profile.u_mm.iter().position(|u| *u >= 0.0).unwrap_or(0);
    (0..form).rev().find(|&i| !climbs(i)).map_or(0, |i| i + 1)
}

fn nominal(fit: &Fit, member: Member, shift_mm: f64) -> Result<SectionOfGear> {
    let thicker_mm = fit.extra_thickness_mm[usize::from(member == Member::Driven)];
    let extra_mm = 0.5 * thicker_mm * fit.pitch.teeth().pressure_angle_rad.cos();
    let chains = nominal_section(&fit.pitch, member, fit.addendum_mm, shift_mm, |_, _| extra_mm)?;
    Ok(SectionOfGear {
        u_mm: chains.each(|_| Vec::new()),
        left_out: chains.each(|_| 0),
        chains,
        spaces: Vec::new(),
        right_is_first: false,
    })
}
