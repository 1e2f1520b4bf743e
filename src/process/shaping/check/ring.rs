//! What a cutter can do in a ring: whether it rolls and how large it may be, how much of the tip its involute
//! generates, whether its teeth come clear of their neighbours.
//!
//! In: a prepared job of an internal gear. Out: [`RingFacts`], and their lines and warnings. Nothing is cut for this.
//!
//! Laws. The cutter rolls where its pitch circle is smaller than the osculating circle, r_c < 1 / kappa. Its involute
//! ends near its base circle; [`TipRelief`] says what the base leaves. **Interference** is told from the target: a tip
//! corner of the cutter goes in and out of its space past the neighbouring teeth, and where its path runs through their
//! material it cuts there what no envelope of the flanks has shaped. The tip of a cutter does not undercut a ring as it
//! does a small external gear; the condition that is printed for it, m^2 h (z0 + h) <= rho (rho + m z0) sin^2(alpha),
//! is that of an external gear of the radius rho, and is given beside.

use crate::measure::damage::LEAST_DEPTH_MM;
use crate::output::text::{Sheet, significant};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::cutter::CornerPart;
use crate::process::shaping::target::FlankEnd;
use crate::process::shaping::tip_relief::TipRelief;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Points of the target's outline, mm: chords of the sharpest fillet, 0.2 mm, then miss a fifteenth of the least
/// damage.
const TARGET_SPACING_MM: f64 = 0.01;
/// Both sides of a tooth, in the order of what is told of them.
const SIDES: [Side; 2] = [Side::Left, Side::Right];
/// Rows of the chart along the curve at most, and the width of its bars: full where the cutter ceases to roll.
const CHART_ROWS: usize = 24;
const CHART_WIDTH: f64 = 24.0;
/// Places of a tip corner's path per pitch.
const PLACES_PER_PITCH: i32 = 64;

/// A length with the tooth and side where it is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothPlace {
    /// Length, mm.
    pub mm: f64,
    /// Tooth, from 1.
    pub tooth: u32,
    /// Its side.
    pub side: Side,
}

/// What holds of one tooth of the ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingTooth {
    /// Its number, from 1.
    pub tooth: u32,
    /// Polar angle of its middle, rad.
    pub phi_rad: f64,
    /// Curvature of the pitch curve there, positive where the ring is hollow towards its axis.
    pub curvature_per_mm: f64,
    /// Height over the pitch curve up to which the cutter's involute generates the flanks, mm: left and right.
    pub involute_mm: [f64; 2],
    /// Depth of the tips behind the conjugate flank, mm: left and right; `None` where their shape is not known.
    pub relief_mm: [Option<f64>; 2],
}

impl RingTooth {
    fn new(job: &ShapingJob, tooth: u32) -> Self {
        let phi_rad = job.curve.phi_at_arc(PI * job.scene.gear.module_mm * (f64::from(tooth) - 0.5));
        let flanks = SIDES.map(|side| job.target_flank(tooth, side));
        let addendum_mm = job.blank.addendum_mm;
        Self {
            tooth,
            phi_rad,
            curvature_per_mm: job.curve.frame(phi_rad).curvature_per_mm,
            involute_mm: flanks.map(|flank| {
                let tip = flank.at_arc(flank.length_mm());
                job.blank.height(tip.point_mm, tip.phi_rad).0
            }),
            relief_mm: flanks.map(|flank| match flank.tip_end {
                FlankEnd::CutterBase => Some(TipRelief::new(flank, &job.blank)?.depth_mm(addendum_mm)),
                _ => Some(0.0),
            }),
        }
    }

    /// Most cutter teeth of a module whose pitch circle rolls there; `None` where any rolls.
    pub fn rolling_teeth(&self, module_mm: f64) -> Option<u32> {
        (self.curvature_per_mm > 0.0).then(|| rolling_teeth(1.0 / self.curvature_per_mm, module_mm))
    }
}

/// Most cutter teeth whose pitch circle is smaller than a radius.
fn rolling_teeth(radius_mm: f64, module_mm: f64) -> u32 {
    (2.0 * radius_mm / module_mm).ceil() as u32 - 1
}

/// What the tip corners of the cutter do on their way past the teeth beside their space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TipCorners {
    /// Not known, for the target's outline is not.
    Unknown,
    /// They come clear.
    Clear,
    /// They cut into the teeth.
    Cut {
        /// Deepest place, mm.
        depth_mm: f64,
        /// Polar angle of the pitch point then, rad.
        phi_rad: f64,
    },
}

/// What is known of cutter and ring before cutting.
#[derive(Debug, Clone, PartialEq)]
pub struct RingFacts {
    /// The teeth after which the pitch curve repeats.
    pub teeth: Vec<RingTooth>,
    /// Smallest radius of curvature of the pitch curve, mm, and its polar angle, rad.
    pub sharpest: (f64, f64),
    /// Most cutter teeth whose pitch circle rolls everywhere.
    pub rolling_teeth: u32,
    /// Lowest end of an involute before the tip: height over the pitch curve; `None` where all reach the tip.
    pub shortest_involute: Option<ToothPlace>,
    /// Largest depth of a tip behind the conjugate flank; `None` where there is none, or its shape is not known.
    pub relief: Option<ToothPlace>,
    /// Interference of the cutter's tip corners.
    pub tip_corners: TipCorners,
    /// Both sides of the printed condition of undercut, mm2.
    pub printed_undercut_mm2: [f64; 2],
    /// The module up to which it holds at this radius, mm.
    pub printed_module_mm: f64,
}

impl RingFacts {
    /// Of a job of an internal gear.
    pub fn new(job: &ShapingJob) -> Self {
        let gear = &job.scene.gear;
        let sharpest = job.curve.facts().largest_curvature;
        let rho_mm = 1.0 / sharpest.curvature_per_mm;
        let teeth = 1..=job.curve.period_teeth(gear.teeth);
        let teeth: Vec<RingTooth> = teeth.into_par_iter().map(|tooth| RingTooth::new(job, tooth)).collect();
        let ends = teeth.iter().flat_map(|of| {
            SIDES.into_iter().zip(of.involute_mm).map(|(side, mm)| ToothPlace { mm, tooth: of.tooth, side })
        });
        let short = ends.filter(|end| job.target_flank(end.tooth, end.side).tip_end == FlankEnd::CutterBase);
        let shortest_involute = short.reduce(|a, b| if b.mm < a.mm { b } else { a });
        let reliefs = teeth.iter().flat_map(|of| {
            let sides = SIDES.into_iter().zip(of.relief_mm);
            sides.filter_map(|(side, mm)| Some(ToothPlace { mm: mm?, tooth: of.tooth, side }))
        });
        let relief = reliefs.filter(|of| of.mm > 0.0).reduce(|a, b| if b.mm > a.mm { b } else { a });
        let (z0, h) = (f64::from(job.cutter.teeth), job.cutter_spec.addendum_coefficient);
        let sine_2 = gear.pressure_angle_rad.sin().powi(2);
        let m = gear.module_mm;
        Self {
            sharpest: (rho_mm, sharpest.phi_rad),
            rolling_teeth: rolling_teeth(rho_mm, m),
            teeth,
            shortest_involute,
            relief,
            tip_corners: tip_corners(job),
            printed_undercut_mm2: [m * m * h * (z0 + h), rho_mm * (rho_mm + m * z0) * sine_2],
            // The quadratic h (z0 + h) m^2 - rho z0 sin^2 m - rho^2 sin^2 = 0.
            printed_module_mm: {
                let (a, b) = (h * (z0 + h), 0.5 * z0 * sine_2);
                rho_mm * (b + (b * b + a * sine_2).sqrt()) / a
            },
        }
    }
}

/// Follows the tip corners through the target.
fn tip_corners(job: &ShapingJob) -> TipCorners {
    let Ok(target) = job.target_outline(TARGET_SPACING_MM) else { return TipCorners::Unknown };
    let rounds: Vec<(DVec2, f64)> = job
        .cutter
        .corner
        .iter()
        .filter_map(|part| match *part {
            CornerPart::Round { center_mm, radius_mm, .. } => Some((center_mm, radius_mm)),
            CornerPart::Chamfer { .. } => None,
        })
        .flat_map(|(center_mm, radius_mm)| [(center_mm, radius_mm), (DVec2::new(center_mm.x, -center_mm.y), radius_mm)])
        .collect();
    let (linkage, offset_mm) = (&job.finishing().linkage, job.finishing().spec.offset_mm);
    let (module_mm, curve) = (job.scene.gear.module_mm, &job.curve);
    let pitch_mm = PI * module_mm;
    let of_space = |space: u32| {
        // Half a turn of the cutter to either side: where it nearly fills the ring, its teeth leave it late.
        let most = job.cutter.teeth.div_ceil(2) as i32 * PLACES_PER_PITCH;
        let places = -most..=most;
        let deepest = places.map(|place| {
            let arc_mm = pitch_mm * (f64::from(space) + f64::from(place) / f64::from(PLACES_PER_PITCH));
            let phi_rad = curve.phi_at_arc(arc_mm);
            let pose = linkage.pose(phi_rad, offset_mm);
            // The tooth that cuts this space.
            let turn = DVec2::from_angle(pose.angle_rad + TAU * f64::from(space) / f64::from(job.cutter.teeth));
            let depth = |&(center_mm, radius_mm): &(DVec2, f64)| {
                let place_mm = pose.center_mm + turn.rotate(center_mm);
                target.distance_mm(place_mm, 0.5 * module_mm).map_or(0.0, |distance_mm| radius_mm - distance_mm)
            };
            (rounds.iter().map(depth).fold(0.0, f64::max), phi_rad)
        });
        deepest.fold((0.0, 0.0), |a: (f64, f64), b| if b.0 > a.0 { b } else { a })
    };
    // All spaces of a period are all spaces.
    let spaces: Vec<(f64, f64)> = (0..curve.period_teeth(job.scene.gear.teeth)).into_par_iter().map(of_space).collect();
    let deepest = spaces.into_iter().fold((0.0, 0.0), |a: (f64, f64), b| if b.0 > a.0 { b } else { a });
    match deepest {
        (depth_mm, phi_rad) if depth_mm >= LEAST_DEPTH_MM => TipCorners::Cut { depth_mm, phi_rad },
        _ => TipCorners::Clear,
    }
}

/// Lines for the terminal.
pub fn print(sheet: &mut Sheet, job: &ShapingJob, facts: &RingFacts) {
    sheet.heading("Ring");
    let (rho_mm, phi_rad) = facts.sharpest;
    sheet.line(
        "cutter that rolls",
        format!(
            "up to {} teeth: the curve is sharpest with {rho_mm:.3} mm at polar angle {:.2} deg; this one has {}",
            facts.rolling_teeth,
            phi_rad.to_degrees(),
            job.cutter.teeth
        ),
    );
    let reach = facts.shortest_involute.map_or("to the tip on all flanks".to_owned(), |short| {
        let relief = facts.relief.map_or(String::new(), |relief| {
            let (um, tooth, side) = (significant(UM_PER_MM * relief.mm, 3), relief.tooth, relief.side.name());
            format!("; the base relieves the rest by up to {um} um (tooth {tooth} {side})")
        });
        format!(
            "{:.3} mm of {:.3} mm addendum (tooth {} {}){relief}",
            short.mm,
            job.blank.addendum_mm,
            short.tooth,
            short.side.name()
        )
    });
    sheet.line("involute of the cutter", reach);
    let clear = match facts.tip_corners {
        TipCorners::Unknown => "not known, for the target's outline is not".to_owned(),
        TipCorners::Clear => "come clear of the teeth beside their space".to_owned(),
        TipCorners::Cut { depth_mm, phi_rad } => {
            format!("cut {depth_mm:.3} mm into the teeth near polar angle {:.2} deg", phi_rad.to_degrees())
        }
    };
    sheet.line("tip corners", clear);
    let [left, right] = facts.printed_undercut_mm2;
    sheet.line(
        "undercut",
        format!(
            "not by the tip in a ring; the condition of an external gear of this radius reads {left:.1} <= {right:.1} mm2, \
            true up to module {:.3} mm",
            facts.printed_module_mm
        ),
    );
    along(sheet, job, facts);
}

/// The chart along the pitch curve: tooth by tooth, some left out where there are many.
fn along(sheet: &mut Sheet, job: &ShapingJob, facts: &RingFacts) {
    if facts.teeth.len() < 2 {
        return;
    }
    let heading =
        ["tooth", "polar angle", "radius of curvature", "cutter rolls", "involute to", "tip relief", "r_c / rho"];
    let row = |of: &RingTooth| {
        let share = job.cutter.pitch_radius_mm * of.curvature_per_mm;
        let bar = "#".repeat((CHART_WIDTH * share.clamp(0.0, 1.0)).round() as usize);
        let relief_mm = of.relief_mm.into_iter().try_fold(0.0, |most: f64, mm| Some(most.max(mm?)));
        let teeth = of.rolling_teeth(job.scene.gear.module_mm);
        vec![
            of.tooth.to_string(),
            format!("{:.2} deg", of.phi_rad.to_degrees()),
            if of.curvature_per_mm == 0.0 { "straight".into() } else { format!("{:.2} mm", 1.0 / of.curvature_per_mm) },
            teeth.map_or("any".to_owned(), |teeth| format!("{teeth} teeth")),
            format!("{:.3} mm", of.involute_mm[0].min(of.involute_mm[1])),
            relief_mm.map_or("not known".to_owned(), |mm| format!("{:.2} um", UM_PER_MM * mm)),
            format!("{share:.3} |{bar:<width$}|", width = CHART_WIDTH as usize),
        ]
    };
    let step = facts.teeth.len().div_ceil(CHART_ROWS);
    let rows = facts.teeth.iter().step_by(step).map(row);
    sheet.table(&std::iter::once(heading.map(str::to_owned).to_vec()).chain(rows).collect::<Vec<_>>());
}

/// What must be known before cutting.
pub fn warning(facts: &RingFacts) -> Option<String> {
    let TipCorners::Cut { depth_mm, phi_rad } = facts.tip_corners else { return None };
    Some(format!(
        "the tip corners of the cutter cut {depth_mm:.3} mm into teeth beside their space near polar angle {:.2} deg: use a \
        cutter with fewer teeth or a smaller tool.shaper_cutter.addendum_coefficient, or cut the tips of the ring lower \
        (gear.addendum_coefficient)",
        phi_rad.to_degrees()
    ))
}
