//! A pair rolled over its period, with everything that is found out about it.
//!
//! In: two scenes and options. Out: [`RolledPair`]: the moments, and from them transmission error, play, ratio, contact
//! and interference; the same gears in tight mesh; and what ten micrometres of centre distance do.

use std::f64::consts::PI;
use std::sync::Arc;

use rayon::prelude::*;

use super::corners::{self, DeepestCorner};
use super::double_flank::{self, Tight};
use super::fit::{Fit, MEMBERS, SIDES};
use super::flanks::{FlankSource, PairFlanks, errors_vary_along_tooth, made_ready};
use super::generated;
use super::options::PairOptions;
use super::teeth::{self, EdgeContact, ToothContact};
use super::watch::{BY_TOOTH, CORNERS, DISTANCE, MASTERS, PATTERN, RATIO, ROLL, RollingWork, Watch, WatchedUnits};
use crate::pair::assembly::{AssemblyErrors, Meshing, Moment};
use crate::pair::backlash::Backlash;
use crate::pair::contact_ratio::path_of_contact;
use crate::pair::flank_chain::GearFlanks;
use crate::pair::flank_limits::FlankLimits;
use crate::pair::pattern::{SectionGaps, smallest_gaps};
use crate::pair::pitch_pair::Member;
use crate::pair::rolling::{RolledPeriod, TransmissionError, enough, roll};
use crate::scene::Scene;
use gearcut_core::cut::Backend;
use gearcut_core::error::{Error, Refusal, Result};
use gearcut_core::gear::{GearKind, PitchCurve};
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// Change of the centre distance whose effect is told, um.
pub const PROBE_UM: f64 = 10.0;
/// Places in a pitch at which the path of contact is computed, and at which the effect of the
/// centre distance is looked at.
const PROBES_PER_PITCH: usize = 4;
/// Gaps are noted up to this many marking thicknesses.
const GAPS_REACH: f64 = 3.0;

/// What ten micrometres more centre distance change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensitivity {
    /// Largest change of the transmission error of the driving flanks, arcsec.
    pub error_arcsec: f64,
    /// Its change from peak to peak, arcsec: what a mean cannot take off.
    pub error_range_arcsec: f64,
    /// Smallest and largest change of the play, circumferential, um.
    pub backlash_um: [f64; 2],
}

/// A pair and what was found.
#[derive(Debug)]
pub struct RolledPair {
    /// How the gears belong together.
    pub fit: Fit,
    /// Common width of the face, mm.
    pub face_mm: f64,
    /// What is rolled.
    pub flanks: PairFlanks,
    /// In the machine.
    pub meshing: Meshing,
    /// Every moment.
    pub period: RolledPeriod,
    /// Transmission error of both sides.
    pub errors: [TransmissionError; 2],
    /// Play at every moment.
    pub backlash: Vec<Backlash>,
    /// Ratio asked for and achieved at every moment.
    pub ratios: Vec<[f64; 2]>,
    /// Contact ratio of both sides: number of the moment, and its ratio. Nominal flanks go on to the tip curve of the
    /// mate; cut ones end at their form points. Else why there is none.
    pub contact_ratio: std::result::Result<[Vec<(usize, f64)>; 2], String>,
    /// Overlap ratio of helical gears over the common face; 0 of spur gears.
    pub overlap_ratio: f64,
    /// Pairs within the marking thickness at every moment, of both sides.
    pub pairs: [Vec<u32>; 2],
    /// Contact by tooth, of both sides.
    pub teeth: [Vec<ToothContact>; 2],
    /// The edge contact that lifts most, and the share of moments at which one carries.
    pub edges: [(Option<EdgeContact>, f64); 2],
    /// Smallest gaps on all flanks.
    pub gaps: Vec<SectionGaps>,
    /// Deepest corner in A and in B.
    pub corners: [Option<DeepestCorner>; 2],
    /// In tight mesh with each other; else why not.
    pub tight: Tight,
    /// A and B against a master; else why not.
    pub masters: [Tight; 2],
    /// What the centre distance does.
    pub sensitivity: Sensitivity,
}

impl RolledPair {
    /// Tooth of gear A, from 1, of an unwrapped label.
    pub fn tooth_of_a(&self, label: i64) -> u64 {
        ((label - 1).rem_euclid(i64::from(self.fit.pitch.teeth().count[0])) + 1) as u64
    }
}

/// Makes two scenes ready, cuts what is needed and rolls them.
///
/// # Errors
/// Gears that do not belong together, cannot be cut or do not reach each other; too few positions; Ctrl-C.
pub fn roll_pair(
    scenes: [&Scene; 2],
    options: &PairOptions,
    backend: &dyn Backend,
    watch: &Watch,
) -> Result<RolledPair> {
    let gears = [&scenes[0].gear, &scenes[1].gear];
    let fit = Fit::at_distance(scenes[0], scenes[1], options.phase_teeth, options.center_distance_mm)?;
    if options.source == FlankSource::Nominal
        && let Some(key) = scenes.iter().find_map(|scene| scene.process.other_teeth_key())
    {
        let problem = "nominal flanks are those of a straight-sided rack, and drawn teeth have other ones";
        return Err(Refusal::new(key, problem, "roll them as cut: leave --flanks nominal out").into());
    }
    let mounting = options.mounting(&fit, gears)?;
    let positions = options.positions(fit.pitch.teeth().count);
    enough(fit.pitch.teeth().count, positions)?;
    // What one gear lacks is said before the other is cut.
    let ready = made_ready(scenes, options.source)?;
    let sections = options.sections(gears, || ready.as_ref().map_or(Ok(false), errors_vary_along_tooth))?;
    watch.plan(&RollingWork {
        teeth: fit.pitch.teeth().count,
        ring: fit.pitch.teeth().driven == GearKind::Internal,
        cut: options.source == FlankSource::Cut,
        helical: gears[0].helix_angle_rad != 0.0,
        sections,
        positions,
        pitches: double_flank::pitches(&fit.pitch),
    });
    let flanks = PairFlanks::new(&fit, scenes, ready.as_ref(), sections, backend, watch)?;
    let meshing = flanks.meshing(&fit, gears[0], &mounting);
    let period = in_stage(watch, ROLL, positions, |stage| roll(&meshing, positions, || stage.count()))?;
    let moments = &period.moments;
    let both = 2 * moments.len();
    let marking_um = options.marking_um;
    let [right, left] = in_stage(watch, BY_TOOTH, both, |stage| {
        let [right, left] = SIDES.map(|side| teeth::teeth(&fit, &flanks, &meshing, moments, side, marking_um, stage));
        Ok([right?, left?])
    })?;
    let teeth = [right, left];
    let gaps = in_stage(watch, PATTERN, moments.len(), |stage| {
        smallest_gaps(&meshing, moments, GAPS_REACH * marking_um, || stage.count())
    })?;
    let corners = in_stage(watch, CORNERS, both, |stage| {
        let [in_a, in_b] = MEMBERS.map(|member| corners::deepest(&flanks, &meshing, moments, member, stage));
        Ok([in_a?, in_b?])
    })?;
    let probes = moments.len().div_ceil(stride(&period, PROBES_PER_PITCH));
    let contact_ratio = in_stage(watch, RATIO, 2 * probes, |stage| {
        if let Some(why) = fit.no_involutes() {
            return Ok(Err(why.to_owned()));
        }
        let ratios = || -> Result<_> {
            // The line of action is that of the axes as they are: involutes on round gears have one at any distance.
            let error_mm = mounting.center_distance_error_mm;
            let off = fit.round_involutes && error_mm != 0.0;
            let distance_mm = off.then_some(fit.pitch.center_distance_mm() + error_mm);
            let moved = distance_mm
                .map(|mm| Fit::at_distance(scenes[0], scenes[1], options.phase_teeth, Some(mm)))
                .transpose()?;
            let fit = moved.as_ref().unwrap_or(&fit);
            let limits = flanks.ends.as_ref().map(|ends| generated::limits(fit, ends)).transpose()?;
            let [right, left] = [0, 1].map(|at| {
                let limits = limits.as_ref().map(|limits| &limits[at]);
                contact_ratios(fit, limits, &period, SIDES[at], stage)
            });
            Ok([right?, left?])
        };
        match ratios() {
            Ok(ratios) => Ok(Ok(ratios)),
            // A path that a tip curve does not end costs the contact ratio, and nothing else.
            Err(Error::Refused(refusal)) => Ok(Err(refusal.problem)),
            Err(other) => Err(other),
        }
    })?;
    let tight = double_flank::with_mate(&meshing, watch)?;
    let [master_a, master_b] = MEMBERS.map(|member| master(&fit, &flanks, &mounting, scenes, member, watch));
    let masters = [master_a?, master_b?];
    let sensitivity = in_stage(watch, DISTANCE, probes, |stage| sensitivity(&meshing, &period, stage))?;
    watch.check()?;
    let face_mm = gears[0].face_width_mm.min(gears[1].face_width_mm);
    Ok(RolledPair {
        errors: SIDES.map(|side| period.transmission_error(side)),
        backlash: moments.iter().map(|moment| Backlash::of(&fit.pitch, moment)).collect(),
        ratios: period.ratios(),
        contact_ratio,
        pairs: SIDES.map(|side| {
            moments.iter().map(|moment| teeth::pairs_in_contact(&meshing, moment, side, marking_um)).collect()
        }),
        teeth,
        edges: SIDES.map(|side| teeth::edges(&flanks, &meshing, moments, side)),
        gaps,
        corners,
        tight,
        masters,
        sensitivity,
        overlap_ratio: face_mm * gears[0].helix_angle_rad.tan() / (PI * gears[0].transverse_module_mm()),
        face_mm,
        fit,
        flanks,
        meshing,
        period,
    })
}

/// Does the work of a stage.
fn in_stage<T>(
    watch: &Watch,
    name: &str,
    positions: usize,
    work: impl FnOnce(&WatchedUnits) -> Result<T>,
) -> Result<T> {
    let stage = watch.stage(name, positions, "positions")?;
    let done = work(&stage)?;
    stage.finish();
    Ok(done)
}

/// Contact ratio of a side at some moments of the period.
fn contact_ratios(
    fit: &Fit,
    limits: Option<&[FlankLimits; 2]>,
    period: &RolledPeriod,
    side: Side,
    stage: &WatchedUnits,
) -> Result<Vec<(usize, f64)>> {
    let step = stride(period, PROBES_PER_PITCH);
    let at = |index: usize| {
        let pitch = fit.pitch.at(period.moments[index].pitch.phi_1_rad);
        let between_tips = path_of_contact(&fit.pitch, &pitch, side, fit.addendum_mm)?;
        let path = limits.map_or(between_tips, |[a, b]| between_tips.generated(side, [a, b], pitch.phi_1_rad));
        stage.count()?;
        Ok((index, path.contact_ratio(&fit.pitch)))
    };
    (0..period.moments.len()).into_par_iter().step_by(step).map(at).collect()
}

/// Every so many moments of a period, for about `per_pitch` in each pitch.
fn stride(period: &RolledPeriod, per_pitch: usize) -> usize {
    let pitches = (period.turns * period.teeth) as usize;
    (period.moments.len() / (per_pitch * pitches)).max(1)
}

/// A gear, mounted as in the pair, against a master with its own module and pressure angle.
fn master(
    fit: &Fit,
    flanks: &PairFlanks,
    mounting: &AssemblyErrors,
    scenes: [&Scene; 2],
    member: Member,
    watch: &Watch,
) -> Result<Tight> {
    let middle = &flanks.sections[flanks.sections.len() / 2];
    let at = usize::from(member == Member::Driven);
    if fit.drawn[at] {
        return Ok(Err("a master has involute teeth, and these are drawn".to_owned()));
    }
    let gear = &scenes[at].gear;
    let off_mm = mounting.eccentricity_mm[at];
    let chains = middle[at].chains.each(|chain| chain.moved(off_mm));
    let own = match member {
        Member::Driver => chains,
        Member::Driven => GearFlanks::build(gear.teeth, |side, tooth| {
            let (side, label) = fit.label_of(side, tooth);
            Ok::<_, Refusal>(chains.get(side, label).turned(-fit.turn_rad))
        })?,
    };
    let curve = Arc::new(PitchCurve::new(&gear.pitch_curve, gear.transverse_module_mm(), gear.teeth)?);
    // A master has no shift: as high as the mate, it would meet the fillet of one gear and miss the root of another.
    let mate = &scenes[1 - at].gear;
    let addendum_mm = mate.addendum_coefficient * mate.module_mm;
    double_flank::with_master(&curve, &own, gear.kind, &fit.own, addendum_mm, MASTERS[at], watch)
}

/// What a larger centre distance changes at some moments of the period.
fn sensitivity(meshing: &Meshing, period: &RolledPeriod, stage: &WatchedUnits) -> Result<Sensitivity> {
    let change = |moment: &Moment| {
        let [right, left] = SIDES.map(|side| meshing.side(&moment.pitch, side, PROBE_UM / UM_PER_MM));
        let error_rad = right?.error_rad - moment.right.error_rad;
        let play_rad = left?.error_rad - moment.left.error_rad - error_rad;
        stage.count()?;
        Ok([error_rad.to_degrees() * 3600.0, play_rad * moment.pitch.radius_mm[1] * UM_PER_MM])
    };
    let step = stride(period, PROBES_PER_PITCH);
    let changes: Vec<[f64; 2]> = period.moments.par_iter().step_by(step).map(change).collect::<Result<_>>()?;
    let ends = |of: usize| {
        let values = changes.iter().map(|change| change[of]);
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [value.min(low), value.max(high)])
    };
    let [low, high] = ends(0);
    Ok(Sensitivity {
        error_arcsec: if high.abs() > low.abs() { high } else { low },
        error_range_arcsec: high - low,
        backlash_um: ends(1),
    })
}
