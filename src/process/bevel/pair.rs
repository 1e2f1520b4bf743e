//! A bevel gear and its pinion in contact, without load: motion error, contact path and ellipses, and what errors of
//! the mounting do to them.
//!
//! In: the bevel jobs of gear and pinion, and how they are mounted. Out: [`RolledBevels`], its findings ([`findings`]),
//! charts ([`charts`], [`bearing`]) and page ([`page`]).
//!
//! Target flanks touch, those that the heads' cones generate: marks of single blades are left out. The law stands in
//! [`gearcut_core::bevel::contact`]. Concave flanks of the gear, cut by outside blades, run on the pinion's convex
//! ones, cut by inside blades, and the other way round.
//!
//! At every moment the pair of teeth carries that pushes the gear farthest on: the actual motion error over a pitch is
//! the largest of the errors of one pair of teeth, taken a pitch apart. A pair is therefore followed until it trails or
//! its teeth part, at their edges as well: a curve that is cut off while it carries would hand over to the next pair
//! too early.
//!
//! Road not taken: contact on the cut dexel flanks. Their marks are some hundredths of a micrometre high and say
//! nothing of the bearing; the deviations of the cut flanks are reported by `gearcut cut`.

pub mod bearing;
pub mod charts;
pub mod findings;
pub mod page;

use super::BevelJob;
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use gearcut_core::bevel::contact::{BevelMesh, BevelPair, Contact, Mounting};
use gearcut_core::bevel::face_mill::BladeKind;
use gearcut_core::error::{Refusal, Result};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Intervals of a pitch; errors of neighbouring pairs of teeth are then known at the same angles.
const PER_PITCH: isize = 20;
/// A pair of teeth is followed for a pitch to either side, and farther until it trails and falls back all along so many
/// intervals.
const TRAILING: isize = 5;
/// Motion errors are known to this, rad, two millionths of an arc second: what the search for contact leaves.
const KNOWN_RAD: f64 = 1e-11;
/// Modules that differ by more belong to no pair, mm: rounding of data sheets.
const MODULE_MM: f64 = 2e-3;

/// How much every error of the mounting is changed to see what it does, in both directions: mm, or rad of the shaft
/// angle (3').
const TRIED_MM: f64 = 0.05;
const TRIED_RAD: f64 = 0.05 * std::f64::consts::PI / 180.0;

/// How far a pair is mounted off its nominal place; mm and rad.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MountingErrors {
    /// E, offset of the pinion's axis.
    pub offset_mm: f64,
    /// P, pinion along its axis, away from the apex.
    pub pinion_axial_mm: f64,
    /// G, gear along its axis, away from the apex.
    pub gear_axial_mm: f64,
    /// Sigma, shaft angle.
    pub shaft_angle_rad: f64,
}

/// One of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MountingError {
    /// E.
    Offset,
    /// P.
    PinionAxial,
    /// G.
    GearAxial,
    /// Sigma.
    ShaftAngle,
}

impl MountingError {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Offset, Self::PinionAxial, Self::GearAxial, Self::ShaftAngle];

    /// Gleason's letter and ISO's name (ISO 23509, ISO/TR 10064-6).
    pub fn names(self) -> [&'static str; 2] {
        match self {
            Self::Offset => ["E", "hypoid offset a"],
            Self::PinionAxial => ["P", "pinion mounting distance t_B1"],
            Self::GearAxial => ["G", "wheel mounting distance t_B2"],
            Self::ShaftAngle => ["Sigma", "shaft angle Sigma"],
        }
    }

    fn added(self, to: &MountingErrors, sign: f64) -> MountingErrors {
        let mut errors = *to;
        match self {
            Self::Offset => errors.offset_mm += sign * TRIED_MM,
            Self::PinionAxial => errors.pinion_axial_mm += sign * TRIED_MM,
            Self::GearAxial => errors.gear_axial_mm += sign * TRIED_MM,
            Self::ShaftAngle => errors.shaft_angle_rad += sign * TRIED_RAD,
        }
        errors
    }
}

/// How one pair of flanks runs. Angles grow in the sense in which the pinion turns when it drives these flanks; motion
/// errors are above 0 where the gear is ahead.
#[derive(Debug, Clone, PartialEq)]
pub struct Running {
    /// Angle of the pinion about the middle, rad; contact and motion error of one pair of teeth, rad, where they meet.
    pub teeth: Vec<(f64, Option<(Contact, f64)>)>,
    /// The same over a pitch about the middle, of the pair of teeth that carries at each angle.
    pub carrying: Vec<(f64, Contact, f64)>,
}

/// One pair of teeth, as far as it is followed.
struct Followed<'a> {
    mesh: BevelMesh<'a>,
    pitch_rad: f64,
    /// Contacts and motion errors by interval from the middle.
    met: BTreeMap<isize, Option<(Contact, f64)>>,
}

impl Followed<'_> {
    fn angle_rad(&self, i: isize) -> f64 {
        self.pitch_rad * i as f64 / PER_PITCH as f64
    }

    /// Contact and motion error at an interval, where they are known.
    fn at(&self, i: isize) -> Option<(Contact, f64)> {
        self.met.get(&i).copied().flatten()
    }

    /// What carries at an interval, of all that is known; of pairs that carry alike, as conjugate ones do, the one
    /// nearest to the middle is taken.
    fn carrying(&self, i: isize) -> Option<(Contact, f64)> {
        let mut alike: Vec<isize> = self.met.keys().copied().filter(|j| (j - i).rem_euclid(PER_PITCH) == 0).collect();
        alike.sort_by_key(|j| j.abs());
        let met = alike.into_iter().filter_map(|j| self.at(j));
        met.reduce(|best, next| if next.1 > best.1 + KNOWN_RAD { next } else { best })
    }

    /// Whether the pair trails, and falls back outwards, at the last intervals up to this one; or the teeth have
    /// parted.
    fn trails(&self, last: isize) -> bool {
        let outwards = last.signum();
        let falls = |i: isize| match (self.at(i - outwards), self.at(i), self.carrying(i)) {
            (Some(before), Some(here), Some(carrying)) => {
                here.1 < before.1 - KNOWN_RAD && here.1 < carrying.1 - KNOWN_RAD
            }
            (_, None, _) => true,
            _ => false,
        };
        (0..TRAILING).all(|k| falls(last - k * outwards))
    }

    /// Goes on to an interval from the one before it, seen from the middle.
    fn go_on_to(&mut self, i: isize) -> Result<(), Refusal> {
        let near_rad = self.at(i - i.signum()).map_or(0.0, |(_, error_rad)| error_rad);
        let met = self.mesh.at(self.angle_rad(i), near_rad)?;
        self.met.insert(i, met);
        Ok(())
    }
}

impl Running {
    /// How a pair of flanks runs; ellipses are those of `marking_mm` of compound.
    ///
    /// # Errors
    /// Flanks that do not meet.
    pub fn of(pair: &BevelPair, marking_mm: f64) -> Result<Self> {
        let teeth = pair.pinion.blank.teeth;
        let mesh = pair.mesh(marking_mm)?;
        let met = BTreeMap::from([(0, Some((*mesh.middle(), 0.0)))]);
        let mut followed = Followed { mesh, pitch_rad: std::f64::consts::TAU / f64::from(teeth), met };
        for i in 1..=PER_PITCH {
            followed.go_on_to(-i)?;
            followed.go_on_to(i)?;
        }
        let half_turn = PER_PITCH * teeth as isize / 2;
        for outwards in [-1, 1] {
            let mut last = outwards * PER_PITCH;
            while !followed.trails(last) {
                last += outwards;
                if last.abs() > half_turn {
                    return Err(Refusal::new(
                        "pair",
                        "one pair of teeth is in contact over half a turn of the pinion",
                        "check the mounting and both scenes",
                    )
                    .into());
                }
                followed.go_on_to(last)?;
            }
        }
        let carrying = (-PER_PITCH / 2..=PER_PITCH / 2).map(|i| {
            let (contact, error_rad) = followed.carrying(i).ok_or_else(|| {
                Refusal::new("pair", "no teeth meet at an angle of the pinion", "check the mounting and both scenes")
            })?;
            Ok((followed.angle_rad(i), contact, error_rad))
        });
        let carrying = carrying.collect::<Result<_>>()?;
        let teeth = followed.met.iter().map(|(&i, &met)| (followed.angle_rad(i), met)).collect();
        Ok(Self { teeth, carrying })
    }

    /// Range of the motion error over a pitch, rad; 0 where the search for places is no finer.
    pub fn motion_error_rad(&self) -> f64 {
        let errors = || self.carrying.iter().map(|(.., error_rad)| *error_rad);
        let range_rad = errors().fold(f64::NEG_INFINITY, f64::max) - errors().fold(f64::INFINITY, f64::min);
        if range_rad > KNOWN_RAD { range_rad } else { 0.0 }
    }

    /// The parabola that lies nearest to the motion error of one pair of teeth while it carries; none where it carries
    /// at fewer than three places in a row.
    pub fn parabola(&self) -> Option<Parabola> {
        let carries = |contact: &Contact| self.carrying.iter().any(|(_, carrying, _)| carrying == contact);
        let of_pair: Vec<Option<(f64, f64)>> = self
            .teeth
            .iter()
            .map(|(at, met)| met.filter(|(contact, _)| carries(contact)).map(|(_, error_rad)| (*at, error_rad)))
            .collect();
        let run = of_pair.split(Option::is_none).max_by_key(|run| run.len())?;
        let run: Vec<(f64, f64)> = run.iter().flatten().copied().collect();
        if run.len() < 3 {
            return None;
        }
        let pitch_rad = PER_PITCH as f64 * (run[1].0 - run[0].0);
        let mean = |value: &dyn Fn(&(f64, f64)) -> f64| run.iter().map(value).sum::<f64>() / run.len() as f64;
        // Places are even, so that a level, a slope and a bend about their middle are found by themselves.
        let middle_rad = mean(&|of| of.0);
        let square = mean(&|of| (of.0 - middle_rad).powi(2));
        let bend_of = |at: f64| (at - middle_rad).powi(2) - square;
        let slope = mean(&|of| (of.0 - middle_rad) * of.1) / square;
        let bend_per_rad = mean(&|of| bend_of(of.0) * of.1) / mean(&|of| bend_of(of.0).powi(2));
        let level_rad = mean(&|of| of.1) - bend_per_rad * square;
        let ends_rad = [run[0].0, run[run.len() - 1].0];
        Some(Parabola { middle_rad, level_rad, slope, bend_per_rad, ends_rad, pitch_rad })
    }

    /// Mean place of the contact of one pair of teeth over a pitch about the middle: along the gear's tooth from the
    /// middle of the face, and height over the pitch cone, mm. Which teeth carry does not enter: conjugate ones all do.
    pub fn center_mm(&self) -> [f64; 2] {
        let of_pitch = |at_rad: f64| at_rad >= self.carrying[0].0 && at_rad <= self.carrying[self.carrying.len() - 1].0;
        let met = self.teeth.iter().filter(|(at_rad, _)| of_pitch(*at_rad));
        let met: Vec<&Contact> = met.filter_map(|(_, met)| met.as_ref().map(|(contact, _)| contact)).collect();
        [0, 1].map(|k| met.iter().map(|contact| contact.place_mm[k]).sum::<f64>() / met.len() as f64)
    }

    /// Contact in the middle of the pitch.
    pub fn middle(&self) -> &Contact {
        &self.carrying[self.carrying.len() / 2].1
    }
}

/// A parabola of the motion error over the pinion's angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parabola {
    middle_rad: f64,
    level_rad: f64,
    slope: f64,
    bend_per_rad: f64,
    ends_rad: [f64; 2],
    pitch_rad: f64,
}

impl Parabola {
    /// Points of it in a row: the pinion's angle and the error, rad.
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        let (of, [from, to]) = (*self, self.ends_rad);
        (0..=PER_PITCH).map(move |i| {
            let at = from + (to - from) * i as f64 / PER_PITCH as f64;
            let beside = at - of.middle_rad;
            (at, of.level_rad + of.slope * beside + of.bend_per_rad * beside * beside)
        })
    }

    /// How far it falls from its top to half a pitch beside it, rad; negative where the gear runs behind there, 0 where
    /// it is no more than the search leaves.
    pub fn over_pitch_rad(&self) -> f64 {
        let over_rad = self.bend_per_rad * (0.5 * self.pitch_rad).powi(2);
        if over_rad.abs() > KNOWN_RAD { over_rad } else { 0.0 }
    }
}

/// What an error of the mounting does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trend {
    /// The error.
    pub error: MountingError,
    /// What was added to it: mm, or rad of the shaft angle.
    pub added: f64,
    /// Motion error over a pitch, rad, and the mean place of the contact, mm; `None` where the teeth part.
    pub found: Option<(f64, [f64; 2])>,
}

/// One side of the teeth.
#[derive(Debug, Clone, PartialEq)]
pub struct RolledSide {
    /// Blades that cut the gear's flanks.
    pub gear_blades: BladeKind,
    /// The flanks.
    pub pair: BevelPair,
    /// How they run.
    pub running: Running,
    /// What errors of the mounting do.
    pub trends: Vec<Trend>,
}

/// Both sides, and how they are mounted.
#[derive(Debug, Clone, PartialEq)]
pub struct RolledBevels {
    /// Concave flanks of the gear, then convex ones.
    pub sides: [RolledSide; 2],
    /// How the pair is meant to be mounted.
    pub nominal: Nominal,
    /// Errors of the mounting.
    pub errors: MountingErrors,
    /// Thickness of the marking compound, mm.
    pub marking_mm: f64,
}

/// How a pair is meant to be mounted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nominal {
    /// Shaft angle, rad.
    pub shaft_angle_rad: f64,
    /// Offset of the pinion's axis along y of the gear's machine, mm; 0 on spiral bevel gears.
    pub offset_mm: f64,
}

/// Brings a gear into contact with its pinion: as the flanks that run on the gear's concave ones are finished, and as
/// those on the convex ones are. Both are the same job where the pinion is finished at once.
///
/// # Errors
/// Scenes that make no pair; flanks that do not meet; Ctrl-C.
pub fn roll(
    gear: &BevelJob,
    pinions: [&BevelJob; 2],
    errors: &MountingErrors,
    marking_mm: f64,
    (progress, interrupt): (&Progress, &Interrupt),
) -> Result<RolledBevels> {
    if pinions[0].blank != pinions[1].blank {
        return Err(Refusal::new(
            "pair",
            format!("{} and {} have different blanks", pinions[0].scene.name, pinions[1].scene.name),
            "name two scenes of one pinion, its convex flanks first",
        )
        .into());
    }
    let [nominal, _] = [fitting(gear, pinions[0])?, fitting(gear, pinions[1])?];
    let tried: Vec<(MountingError, f64)> =
        MountingError::ALL.into_iter().flat_map(|error| [(error, -1.0), (error, 1.0)]).collect();
    let step = progress.step("contact", 2 * (1 + tried.len()) as u64, "mountings");
    let running = |pair: &BevelPair| -> Result<Result<Running>> {
        interrupt.check()?;
        let running = Running::of(pair, marking_mm);
        step.advance(1);
        Ok(running)
    };
    let side = |gear_blades: BladeKind| -> Result<RolledSide> {
        let pinion_blades = match gear_blades {
            BladeKind::Outside => BladeKind::Inside,
            BladeKind::Inside => BladeKind::Outside,
        };
        let mounted = |errors: &MountingErrors| BevelPair {
            gear: gear.target[gear_blades.index()].clone(),
            pinion: pinions[gear_blades.index()].target[pinion_blades.index()].clone(),
            mounting: Mounting {
                shaft_angle_rad: nominal.shaft_angle_rad + errors.shaft_angle_rad,
                offset_mm: nominal.offset_mm + errors.offset_mm,
                pinion_axial_mm: errors.pinion_axial_mm,
                gear_axial_mm: errors.gear_axial_mm,
            },
        };
        let pair = mounted(errors);
        let as_mounted = running(&pair)??;
        let trends = tried.par_iter().map(|&(error, sign)| {
            // Teeth that part say so in the table.
            let found = running(&mounted(&error.added(errors, sign)))?.ok();
            let tried = if error == MountingError::ShaftAngle { TRIED_RAD } else { TRIED_MM };
            Ok(Trend {
                error,
                added: sign * tried,
                found: found.map(|running| (running.motion_error_rad(), running.center_mm())),
            })
        });
        Ok(RolledSide { gear_blades, trends: trends.collect::<Result<_>>()?, pair, running: as_mounted })
    };
    let sides = [side(BladeKind::Outside)?, side(BladeKind::Inside)?];
    step.finish();
    Ok(RolledBevels { sides, nominal, errors: *errors, marking_mm })
}

/// How they are meant to be mounted, if both belong together.
fn fitting(gear: &BevelJob, pinion: &BevelJob) -> Result<Nominal, Refusal> {
    let [gear_mm, pinion_mm] = [gear, pinion].map(|job| job.blank.outer_module_mm());
    if (gear_mm - pinion_mm).abs() > MODULE_MM {
        return Err(Refusal::new(
            "gear.module_mm",
            format!("the gear's outer module is {gear_mm:.4} mm, the pinion's {pinion_mm:.4} mm"),
            "a pair has one module",
        ));
    }
    let [gear_teeth, pinion_teeth] = [gear, pinion].map(|job| job.blank.teeth);
    if pinion_teeth > gear_teeth {
        return Err(Refusal::new(
            "gear.teeth",
            format!("the first scene has {gear_teeth} teeth, the second one {pinion_teeth}"),
            "name the gear first, then the pinion",
        ));
    }
    let hand = |job: &BevelJob| job.finishing().settings.cradle_angle_rad.signum();
    if hand(gear) * hand(pinion) > 0.0 {
        return Err(Refusal::new(
            "machine.cradle.cradle_angle_deg",
            "gear and pinion have the same hand of spiral",
            "a pair has opposite hands: change the sign of one cradle angle or spiral angle (-0.0 is a left-hand Zerol \
             gear)",
        ));
    }
    let offsets_mm = [gear, pinion].map(|job| job.spec.cones.hypoid_offset_mm);
    if (offsets_mm[0] - offsets_mm[1]).abs() > OFFSET_MM {
        return Err(Refusal::new(
            "gear.bevel.hypoid_offset_mm",
            format!("the gear's scene names an offset of {} mm, the pinion's {} mm", offsets_mm[0], offsets_mm[1]),
            "write the same offset into both scenes",
        ));
    }
    let offset_mm = offsets_mm[0];
    let angles_rad = [gear, pinion].map(|job| job.blank.pitch_angle_rad);
    // Pitch cones of hypoid gears do not meet in an apex: their angles add up to no shaft angle.
    let shaft_angle_rad =
        if offset_mm == 0.0 { angles_rad[0] + angles_rad[1] } else { gear.spec.cones.shaft_angle_rad };
    for (job, mate_teeth) in [(gear, pinion_teeth), (pinion, gear_teeth)] {
        let Some(mate) = job.spec.cones.mate else { continue };
        if mate.teeth != mate_teeth {
            return Err(Refusal::new(
                "gear.bevel.mate_teeth",
                format!("{} names a mate with {} teeth; this one has {mate_teeth}", job.scene.name, mate.teeth),
                "correct it, or take the scene of its mate",
            ));
        }
        let off_rad = mate.shaft_angle_rad - shaft_angle_rad;
        if off_rad.abs() > SHAFT_ANGLE_RAD {
            return Err(Refusal::new(
                "gear.bevel.shaft_angle_deg",
                format!(
                    "{} names a shaft angle of {:.4} deg; the pair's is {:.4} deg",
                    job.scene.name,
                    mate.shaft_angle_rad.to_degrees(),
                    shaft_angle_rad.to_degrees()
                ),
                "correct the pitch angles or the shaft angle",
            ));
        }
    }
    Ok(Nominal { shaft_angle_rad, offset_mm })
}

/// Offsets that differ by more belong to no pair, mm.
const OFFSET_MM: f64 = 1e-6;
/// Shaft angles that differ by more belong to no pair, rad: rounding of data sheets.
const SHAFT_ANGLE_RAD: f64 = 0.02 * std::f64::consts::PI / 180.0;
