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
        let flanks: Vec<_> = (1..=gear.teeth)
            .flat_map(|tooth| [Side::Left, Side::Right].map(|side| job.target_flank(tooth, side)))
            .filter(|flank| flank.tip_end == FlankEnd::CutterBase)
            .collect();
        let short = flanks.iter().map(|flank| {
            let tip = flank.at_arc(flank.length_mm());
            let mm = job.blank.height(tip.point_mm, tip.phi_rad).0;
            ToothPlace { mm, tooth: flank.tooth, side: flank.side }
        });
        let reliefs = flanks.par_iter().filter_map(|flank| {
            let mm = TipRelief::new(flank, &job.blank)?.depth_mm(job.blank.addendum_mm);
            Some(ToothPlace { mm, tooth: flank.tooth, side: flank.side })
        });
        let reliefs: Vec<ToothPlace> = reliefs.collect();
        let (z0, h) = (f64::from(job.cutter.teeth), job.cutter_spec.addendum_coefficient);
        let sine_2 = gear.pressure_angle_rad.sin().powi(2);
        let m = gear.module_mm;
        Self {
            sharpest: (rho_mm, sharpest.phi_rad),
            rolling_teeth: (2.0 * rho_mm / m).ceil() as u32 - 1,
            shortest_involute: short.reduce(|a, b| if b.mm < a.mm { b } else { a }),
            relief: reliefs.into_iter().reduce(|a, b| if b.mm > a.mm { b } else { a }),
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
