//! What a second clamping and a coordinate measuring machine (CMM) make of the allowances AB and CD.
//!
//! In: crossings of the pitch curve by the flanks of both gears after roughing and after finishing, rigid and exact.
//! Out: rows of docs/experiment.md: one size, fitted to the unevenness that was measured on the normally roughed gear,
//! and what it makes of the traditionally roughed one; then fitted to that one.
//!
//! Law: where the gear is clamped or aligned again between the two measurements, its finished flanks are moved by
//! v(p) = e + delta z x p. A flank crosses the pitch curve under 90 deg less the pressure angle, so that its crossing
//! moves along the curve by v x u / (t x u), with the tangent t of the curve and the direction u of the flank. Each
//! measured point of a CMM is off along the curve by a number of its own. Only the first order of v counts: terms of
//! the second are v^2 over the radius of curvature, 10 nm at 0.1 mm.
//!
//! Road not taken: cutting a gear that is mounted off its axis. That moves roughing and finishing alike.

use gearcut::measure::crossing::Crossing;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::gear::measure::unevenness::{
    CrossedSurface, ToothAllowance, ToothCrossings, allowances, crossings, summarise,
};
use gearcut::random::Draws;
use glam::DVec2;
use std::f64::consts::TAU;

use super::{Found, PERIOD, mean, range_words, scene};

/// Measured unevenness in the mean of the first period, percent: normally and traditionally roughed gear.
const MEASURED_PERCENT: [f64; 2] = [4.95, 110.21];
/// Directions of an offset, and draws of all points of a gear.
const TRIES: i64 = 72;
/// Halvings of a range of 1 um to 2 mm.
const HALVINGS: usize = 40;
const RANGE_UM: [f64; 2] = [1.0, 2000.0];

/// Crossings of a gear and the frames of its pitch curve there.
struct Crossed {
    job: ShapingJob,
    rough: Vec<ToothCrossings>,
    finish: Vec<ToothCrossings>,
}

impl Crossed {
    fn new(linkage: &str) -> Found<Self> {
        let job = ShapingJob::new(scene(linkage, &[])?)?;
        let [rough, finish] = [0, 1].map(|operation| crossings(&job, operation, CrossedSurface::Strokes).teeth);
        Ok(Self { job, rough, finish })
    }

    /// A crossing moved along the pitch curve by a length.
    fn along(&self, crossing: &Crossing, by_mm: f64) -> Crossing {
        let point_mm = crossing.point_mm + by_mm * self.job.curve.frame(crossing.phi_rad).tangent;
        let turned_rad = crossing.point_mm.angle_to(point_mm);
        Crossing { point_mm, phi_rad: crossing.phi_rad + turned_rad, arc_mm: crossing.arc_mm + by_mm }
    }

    /// Where a flank of a gear that is moved by `offset_mm` and turned by `turn_rad` crosses the curve.
    fn moved(&self, crossing: &Crossing, is_left: bool, offset_mm: DVec2, turn_rad: f64) -> Crossing {
        let frame = self.job.curve.frame(crossing.phi_rad);
        let (sin, cos) = self.job.scene.gear.pressure_angle_rad.sin_cos();
        // Teeth grow narrower outwards: the left flank lies towards larger arcs and leans back.
        let flank = cos * frame.normal + if is_left { -sin } else { sin } * frame.tangent;
        let by_mm = offset_mm + turn_rad * crossing.point_mm.perp();
        self.along(crossing, by_mm.perp_dot(flank) / frame.tangent.perp_dot(flank))
    }

    /// Mean unevenness of the first period, the gear clamped anew before it is finished; `points_mm` are the errors of
    /// the rough and the finished point of a tooth and side (left first) along the curve.
    fn uneven_percent(&self, points_mm: impl Fn(usize, usize) -> [f64; 2], clamped: Clamped) -> Option<f64> {
        let side = |tooth: usize, side: usize| {
            let [rough, finish] = [self.rough[tooth][side]?, self.finish[tooth][side]?];
            let finish = self.moved(&finish, side == 0, clamped.offset_mm, clamped.turn_rad);
            let [rough_mm, finish_mm] = points_mm(tooth, side);
            Some([self.along(&rough, rough_mm), self.along(&finish, finish_mm)])
        };
        let teeth: Option<Vec<[[Crossing; 2]; 2]>> =
            (0..PERIOD).map(|tooth| Some([side(tooth, 0)?, side(tooth, 1)?])).collect();
        let surface = |of: usize| -> Option<Vec<ToothCrossings>> {
            Some(teeth.as_ref()?.iter().map(|sides| [Some(sides[0][of]), Some(sides[1][of])]).collect())
        };
        let found = allowances(&surface(0)?, &surface(1)?);
        Some(summarise(found.iter().map(ToothAllowance::unevenness_mean_percent))?.mean_percent)
    }
}

/// How the gear sits beside its first clamping.
#[derive(Clone, Copy, Default)]
struct Clamped {
    offset_mm: DVec2,
    turn_rad: f64,
}

/// One cause with one size, um.
struct Cause {
    name: &'static str,
    size: &'static str,
    /// Unevenness of a gear at each of its directions, senses or draws.
    percents: fn(&Crossed, f64) -> Option<Vec<f64>>,
}

const CAUSES: [Cause; 3] = [
    Cause {
        name: "H9a clamped off the axis before finishing",
        size: "offset, um, mean of all directions",
        percents: |gear, um| {
            let direction = |k: i64| DVec2::from_angle(TAU * k as f64 / TRIES as f64);
            let clamped = |k| Clamped { offset_mm: 1e-3 * um * direction(k), ..Clamped::default() };
            (0..TRIES).map(|k| gear.uneven_percent(|_, _| [0.0; 2], clamped(k))).collect()
        },
    },
    Cause {
        name: "H9b clamped turned before finishing",
        size: "on the mean pitch radius, um, mean of both senses",
        percents: |gear, um| {
            let radius_mm = gear.job.curve.perimeter_mm() / TAU;
            let clamped = |sign: f64| Clamped { turn_rad: sign * 1e-3 * um / radius_mm, ..Clamped::default() };
            [-1.0, 1.0].into_iter().map(|sign| gear.uneven_percent(|_, _| [0.0; 2], clamped(sign))).collect()
        },
    },
    Cause {
        name: "H9c each point of the CMM",
        size: "standard deviation along the curve, um, mean of 72 gears",
        percents: |gear, um| {
            let draw = |seed: i64, tooth: usize, side: usize, of: i64| {
                1e-3 * um * Draws::new(seed as u32, 0).normal([2 * tooth as i64 + side as i64, of])
            };
            let gears = 1..=TRIES;
            gears
                .map(|seed| {
                    let points_mm = |tooth: usize, side: usize| [0, 1].map(|of| draw(seed, tooth, side, of));
                    gear.uneven_percent(points_mm, Clamped::default())
                })
                .collect()
        },
    },
];

/// Prints a row for each cause and each measured value that it is fitted to.
pub fn print() -> Found<()> {
    let [normal, traditional] = [Crossed::new("normal")?, Crossed::new("traditional")?];
    println!(
        "| cause | fitted to | size, fitted | unevenness normal, % | unevenness traditional, % |\n|{}",
        " --- |".repeat(5)
    );
    for cause in CAUSES {
        for (gear, name, measured) in
            [(&normal, "4.95, normal", MEASURED_PERCENT[0]), (&traditional, "110.21, traditional", MEASURED_PERCENT[1])]
        {
            let [mut low_um, mut high_um] = RANGE_UM;
            for _ in 0..HALVINGS {
                let middle = (low_um * high_um).sqrt();
                // A tooth without an allowance has no unevenness: too far.
                let percents = (cause.percents)(gear, middle);
                if percents.is_some_and(|all| mean(&all) < measured) {
                    low_um = middle;
                } else {
                    high_um = middle;
                }
            }
            let found = [&normal, &traditional].map(|gear| (cause.percents)(gear, low_um));
            let cells = found.map(|all| all.map_or_else(|| "none".to_owned(), |all| range_words(&all)));
            println!("| {} | {name} | {}: {low_um:.1} | {} | {} |", cause.name, cause.size, cells[0], cells[1]);
        }
    }
    Ok(())
}
