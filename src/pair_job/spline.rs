//! A splined shaft in its hub: as many teeth inside as outside, on one axis.
//!
//! In: the scenes of shaft and hub. Out: [`SplineFit`]: what the hub can turn on the shaft, and what each tooth and
//! each space lend to that.
//!
//! Law: a turn about the common axis keeps every point at its radius. So the gap of a tooth in its space is the
//! difference of the polar angles of two flanks at equal radii, the smallest over all radii that both have, fillets and
//! tip corners included, times the pitch radius m z / 2. The fit of two parts is the sum of the smallest gaps on both
//! sides: whichever tooth touches first stops the hub.
//!
//! The words are those of ISO 4156-1: space width E and tooth thickness S on the pitch circle; the effective ones E_v
//! and S_v belong to perfect mates, whose involutes are drawn over all flanks and touch the worst of each side. Then
//! c_v = E_v - S_v is the clearance that is left in the worst position of one part in the other.

pub mod report;

use super::fit::teeth_alike;
use super::flanks::{FlankSource, errors_vary_along_tooth, sections_z_mm};
use super::options::PairOptions;
use super::outline::{self, ToothOutline};
use super::watch::{CUT, Watch};
use crate::measure::round_gear::is_round;
use crate::pair::flank_chain::{FlankChain, GearFlanks, PolarFlank};
use crate::process;
use crate::scene::Scene;
use gearcut_core::cut::Backend;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::gear::{GearKind, PitchCurve};
use gearcut_core::terms::Side;
use std::f64::consts::TAU;

/// A tooth of the shaft, or a space of the hub, turned to the polar angle 0: the flank below that angle, and the one
/// above.
struct Turned {
    below: PolarFlank,
    above: PolarFlank,
}

/// All teeth of the shaft, or all spaces of the hub, in one section.
struct Toothing {
    turned: Vec<Turned>,
    /// Smallest and largest radius, mm.
    reach_mm: [f64; 2],
    /// Radius at which the last flank's involute ends towards the root, mm.
    form_mm: f64,
}

/// One tooth in its space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothInSpace {
    /// Tooth of the shaft, from 1.
    pub tooth: u32,
    /// Space of the hub: that behind the tooth of this number, from 1.
    pub space: u32,
    /// S, on the pitch circle, mm.
    pub thickness_mm: f64,
    /// E, on the pitch circle, mm.
    pub width_mm: f64,
    /// Gaps of the right and of the left flank along the pitch circle, with the hub midway between its stops, mm.
    pub gaps_mm: [f64; 2],
}

/// How a shaft fits its hub.
#[derive(Debug, Clone, PartialEq)]
pub struct SplineFit {
    /// m z, mm.
    pub pitch_diameter_mm: f64,
    /// What the hub can turn, along the pitch circle, mm; below 0 the parts do not go together.
    pub clearance_mm: f64,
    /// Smallest and largest of that over all positions of the hub on the shaft, mm.
    pub positions_mm: [f64; 2],
    /// S_v and E_v, mm.
    pub effective_mm: [f64; 2],
    /// Tooth by tooth.
    pub teeth: Vec<ToothInSpace>,
    /// From the tips of the shaft to the roots of the hub, and from the tips of the hub to the roots of the shaft, mm.
    pub root_clearance_mm: [f64; 2],
    /// The same to where the mate's involute ends, mm; below 0 a tip meets a fillet.
    pub form_clearance_mm: [f64; 2],
}

/// Whether the two belong together as shaft and hub and not as gears.
pub fn is_spline([a, b]: [&Scene; 2]) -> bool {
    let kinds = (a.gear.kind, b.gear.kind);
    kinds == (GearKind::External, GearKind::Internal) && a.gear.teeth == b.gear.teeth
}

/// Cuts shaft and hub and puts them together.
///
/// # Errors
/// Parts that do not belong together; options that a fit has no use for; parts that cannot be cut; Ctrl-C.
pub fn fit(scenes: [&Scene; 2], options: &PairOptions, backend: &dyn Backend, watch: &Watch) -> Result<SplineFit> {
    let gears = [&scenes[0].gear, &scenes[1].gear];
    teeth_alike(gears[0], gears[1])?;
    can_be_a_fit(scenes, options)?;
    let face_mm = gears[0].face_width_mm.min(gears[1].face_width_mm);
    let teeth = gears[0].teeth;
    let jobs = [process::prepare(scenes[0])?, process::prepare(scenes[1])?];
    let rows_mm = sections_z_mm(face_mm, options.sections(gears, || errors_vary_along_tooth(&jobs))?);
    let cut = |at: usize| -> Result<Vec<Toothing>> {
        let stage = watch.stage(CUT[at], 3 * teeth as usize, "flanks and roots")?;
        let sections = outline::cut(jobs[at].as_ref(), backend, &rows_mm, &stage)?.sections;
        stage.finish();
        Ok(sections.iter().map(|flanks| Toothing::new(flanks, gears[at].kind)).collect())
    };
    let (shaft, hub) = (cut(0)?, cut(1)?);
    let pitch_radius_mm = 0.5 * gears[0].module_mm * f64::from(teeth);
    let involute =
        SplineInvolute { pitch_radius_mm, base_radius_mm: pitch_radius_mm * gears[0].pressure_angle_rad.cos() };
    Ok(put_together(&shaft, &hub, &involute, options.phase_teeth))
}

/// Refuses what is no spline, and options that mean nothing to one.
fn can_be_a_fit(scenes: [&Scene; 2], options: &PairOptions) -> Result<()> {
    for scene in scenes {
        let gear = &scene.gear;
        let curve = PitchCurve::new(&gear.pitch_curve, gear.transverse_module_mm(), gear.teeth)?;
        if !is_round(&curve) || gear.helix_angle_rad != 0.0 {
            return Err(Refusal::new(
                "gear",
                format!(
                    "{} has as many teeth as the other part, one outside and one inside: a splined shaft and its hub, \
                     which are round with straight teeth",
                    scene.name
                ),
                "give circles and no helix, or gears of other numbers of teeth",
            )
            .into());
        }
    }
    let plain = PairOptions {
        positions: options.positions,
        sections: options.sections,
        phase_teeth: options.phase_teeth,
        marking_um: options.marking_um,
        source: FlankSource::Cut,
        ..PairOptions::default()
    };
    if *options != plain {
        return Err(Refusal::new(
            "options of the pair",
            "a splined shaft is on the axis of its hub, and its fit is that of cut flanks: it has no centre distance, \
             no eccentricity, no parallelism and no nominal flanks",
            "leave these options out; mounting.eccentricity_um in a scene cuts a part off its axis",
        )
        .into());
    }
    Ok(())
}

impl Toothing {
    fn new(flanks: &GearFlanks<ToothOutline>, kind: GearKind) -> Self {
        let teeth = flanks.right.len() as i64;
        let pitch_rad = TAU / teeth as f64;
        let turned = (0..teeth).map(|index| {
            // The tooth of the shaft with this number and one more; the space of the hub behind the tooth with it.
            let (below, above, at) = match kind {
                GearKind::External => ((Side::Right, index + 1), (Side::Left, index + 1), index as f64 + 0.5),
                GearKind::Internal => ((Side::Left, index), (Side::Right, index + 1), index as f64),
            };
            let flank = |(side, tooth): (Side, i64)| {
                let points_mm = flanks.get(side, tooth).points_mm.clone();
                PolarFlank::new(&FlankChain::straight(points_mm).turned(-at * pitch_rad))
            };
            Turned { below: flank(below), above: flank(above) }
        });
        let all = || flanks.right.iter().chain(&flanks.left);
        let radii = || all().flat_map(|flank| &flank.points_mm).map(|point| point.length());
        let forms = all().filter_map(|flank| {
            let form = flank.u_mm.iter().position(|&u_mm| u_mm >= 0.0)?;
            Some(flank.points_mm[form].length())
        });
        let form_mm = match kind {
            GearKind::External => forms.fold(0.0, f64::max),
            GearKind::Internal => forms.fold(f64::INFINITY, f64::min),
        };
        let reach_mm = [radii().fold(f64::INFINITY, f64::min), radii().fold(0.0, f64::max)];
        Self { turned: turned.collect(), reach_mm, form_mm }
    }
}

/// The involute of both parts.
struct SplineInvolute {
    pitch_radius_mm: f64,
    base_radius_mm: f64,
}

impl SplineInvolute {
    /// How much further towards its tooth's middle a flank is at a radius than on the pitch circle, rad.
    fn inwards_rad(&self, radius_mm: f64) -> f64 {
        let inv = |radius_mm: f64| {
            let angle = (self.base_radius_mm / radius_mm).min(1.0).acos();
            angle.tan() - angle
        };
        inv(radius_mm) - inv(self.pitch_radius_mm)
    }

    /// Where involutes through all points of a flank between two radii cross the pitch circle: smallest and largest
    /// polar angle; `side` is -1 below the middle and +1 above it.
    fn crossings_rad(&self, flank: &PolarFlank, side: f64, [low_mm, high_mm]: [f64; 2]) -> [f64; 2] {
        let points = flank.runs.iter().flat_map(|run| {
            run.radii_mm.iter().enumerate().map(|(index, &radius_mm)| (radius_mm, run.angle_of_point(index)))
        });
        let between = points.filter(|(radius_mm, _)| (low_mm..=high_mm).contains(radius_mm));
        let crossings = between.map(|(radius_mm, angle)| angle + side * self.inwards_rad(radius_mm));
        crossings.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
    }
}

/// Smallest difference of the polar angles of two flanks at equal radii, rad: how far `inner` is above `outer`.
fn gap_rad(inner: &PolarFlank, outer: &PolarFlank) -> f64 {
    let mut least = f64::INFINITY;
    for (a, b) in inner.runs.iter().flat_map(|a| outer.runs.iter().map(move |b| (a, b))) {
        for &radius_mm in a.radii_mm.iter().chain(&b.radii_mm) {
            if let (Some(of_a), Some(of_b)) = (a.angle_rad(radius_mm), b.angle_rad(radius_mm)) {
                least = least.min(of_a - of_b);
            }
        }
    }
    least
}

/// Polar angle of a flank at a radius, rad; NaN where it does not reach it.
fn angle_rad(flank: &PolarFlank, radius_mm: f64) -> f64 {
    flank.runs.iter().find_map(|run| run.angle_rad(radius_mm)).unwrap_or(f64::NAN)
}

fn put_together(shaft: &[Toothing], hub: &[Toothing], involute: &SplineInvolute, phase_teeth: i64) -> SplineFit {
    let radius_mm = involute.pitch_radius_mm;
    let teeth = shaft[0].turned.len();
    let sections = || shaft.iter().zip(hub);
    // Gaps of a tooth in a space on both sides, the smallest of all sections.
    let gaps_rad = |tooth: usize, space: usize| {
        let of = sections().map(|(shaft, hub)| {
            let (tooth, space) = (&shaft.turned[tooth], &hub.turned[space]);
            [gap_rad(&tooth.below, &space.below), gap_rad(&space.above, &tooth.above)]
        });
        of.fold([f64::INFINITY; 2], |least, gaps| [0, 1].map(|side| least[side].min(gaps[side])))
    };
    let space_of = |tooth: usize, phase: i64| (tooth as i64 + phase).rem_euclid(teeth as i64) as usize;
    let stops = |gaps: &[[f64; 2]]| [0, 1].map(|side| gaps.iter().map(|gaps| gaps[side]).fold(f64::INFINITY, f64::min));
    let at_phase = |phase: i64| (0..teeth).map(|tooth| gaps_rad(tooth, space_of(tooth, phase))).collect::<Vec<_>>();
    let gaps = at_phase(phase_teeth);
    let [right, left] = stops(&gaps);
    let positions = (0..teeth as i64).map(|phase| stops(&at_phase(phase)).iter().sum::<f64>() * radius_mm);
    let positions_mm =
        positions.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)]);
    // Midway between the stops, both smallest gaps are alike.
    let turned_on = 0.5 * (left - right);
    let middle = |toothings: &[Toothing], index: usize| {
        let of = &toothings[toothings.len() / 2].turned[index];
        radius_mm * (angle_rad(&of.above, radius_mm) - angle_rad(&of.below, radius_mm))
    };
    let in_space = |tooth: usize| {
        let space = space_of(tooth, phase_teeth);
        let [right, left] = gaps[tooth];
        ToothInSpace {
            tooth: tooth as u32 + 1,
            space: if space == 0 { teeth as u32 } else { space as u32 },
            thickness_mm: middle(shaft, tooth),
            width_mm: middle(hub, space),
            gaps_mm: [right + turned_on, left - turned_on].map(|rad| radius_mm * rad),
        }
    };
    let extreme = |of: fn(&Toothing) -> f64, toothings: &[Toothing], pick: fn(f64, f64) -> f64| {
        toothings.iter().map(of).reduce(pick).unwrap_or(f64::NAN)
    };
    let [shaft_root_mm, shaft_tip_mm] =
        [extreme(|t| t.reach_mm[0], shaft, f64::min), extreme(|t| t.reach_mm[1], shaft, f64::max)];
    let [hub_tip_mm, hub_root_mm] =
        [extreme(|t| t.reach_mm[0], hub, f64::min), extreme(|t| t.reach_mm[1], hub, f64::max)];
    let [shaft_form_mm, hub_form_mm] = [extreme(|t| t.form_mm, shaft, f64::max), extreme(|t| t.form_mm, hub, f64::min)];
    let active_mm = [shaft_form_mm.max(hub_tip_mm), hub_form_mm.min(shaft_tip_mm)];
    let worst = |toothings: &[Toothing]| {
        let all = toothings.iter().flat_map(|toothing| &toothing.turned);
        let of = all.map(|turned| {
            [
                involute.crossings_rad(&turned.below, -1.0, active_mm),
                involute.crossings_rad(&turned.above, 1.0, active_mm),
            ]
        });
        let of: Vec<[[f64; 2]; 2]> = of.collect();
        let end = |side: usize, end: usize, pick: fn(f64, f64) -> f64| {
            of.iter().map(|sides| sides[side][end]).reduce(pick).unwrap_or(f64::NAN)
        };
        // Around all teeth, and inside all spaces.
        [end(1, 1, f64::max) - end(0, 0, f64::min), end(1, 0, f64::min) - end(0, 1, f64::max)]
            .map(|rad| radius_mm * rad)
    };
    SplineFit {
        pitch_diameter_mm: 2.0 * radius_mm,
        clearance_mm: radius_mm * (right + left),
        positions_mm,
        effective_mm: [worst(shaft)[0], worst(hub)[1]],
        teeth: (0..teeth).map(in_space).collect(),
        root_clearance_mm: [hub_root_mm - shaft_tip_mm, hub_tip_mm - shaft_root_mm],
        form_clearance_mm: [hub_form_mm - shaft_tip_mm, hub_tip_mm - shaft_form_mm],
    }
}
