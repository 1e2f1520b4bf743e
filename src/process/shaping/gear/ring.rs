//! What a cutter can do in a ring: whether it rolls and how large it may be, how much of the tip its involute
//! generates, whether it undercuts, whether its tip corners come clear of the teeth beside their space.
//!
//! In: a prepared job of an internal gear. Out: [`RingFacts`]: one period of the pitch curve, tooth by tooth, and the
//! tightest place of each question. Nothing is cut for this.
//!
//! Laws. The cutter rolls where its pitch circle is smaller than the osculating circle, r_c < rho; with z0 teeth that
//! holds up to the module 2 rho / z0. Its involute ends near its base circle; [`TipRelief`] says what the base leaves.
//! Contact runs along the line of action, and the base circle touches that line at r_c sin(alpha) from the pitch point,
//! where a ring of the radius rho has the height
//!
//! ```text
//! h = rho - sqrt(rho^2 cos^2(alpha) + (rho - r_c)^2 sin^2(alpha))
//! ```
//!
//! over its pitch circle: that height solved for r_c tells how many teeth generate the whole tip. The tip of a cutter
//! does not undercut a ring as it does a small external gear; the condition that is printed for it, m^2 h (z0 + h) <=
//! rho (rho + m z0) sin^2(alpha), is that of an external gear of the radius rho, and is given beside what the target's
//! flanks say.

mod corners;
mod infeed;

pub use corners::CornerPath;
pub use infeed::Trimming;

use crate::process::shaping::ShapingJob;
use crate::process::shaping::target::tip_relief::TipRelief;
use crate::process::shaping::target::{FlankEnd, TargetFlank};
use gearcut_core::terms::Side;
use gearcut_core::tool::involute::inv;
use gearcut_core::units::TURN_RAD;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Points of the target's outline, mm: chords of the sharpest fillet, 0.2 mm, then miss a fifteenth of the least
/// damage.
const TARGET_SPACING_MM: f64 = 0.01;
/// Both sides of a tooth, in the order of their values.
const SIDES: [Side; 2] = [Side::Left, Side::Right];

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

/// What holds of one tooth of the ring, or of the space behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingTooth {
    /// Its number, from 1.
    pub tooth: u32,
    /// Polar angle of its middle, rad.
    pub phi_rad: f64,
    /// Curvature of the pitch curve there, positive where the ring is hollow towards its axis.
    pub curvature_per_mm: f64,
    /// Height over the pitch curve at which the generated flanks begin, mm: left and right.
    pub start_mm: [f64; 2],
    /// Whether the cutter's tip has cut their beginning away.
    pub undercut: [bool; 2],
    /// Height over the pitch curve up to which the cutter's involute generates the flanks, mm: left and right.
    pub involute_mm: [f64; 2],
    /// Whether the flanks end there before the tip.
    pub ends_early: [bool; 2],
    /// Depth of the tips behind the conjugate flank, mm: left and right; `None` where their shape is not known.
    pub relief_mm: [Option<f64>; 2],
    /// The cutter's tip corners on their way into the space behind the tooth, and out of it; `None` where the target's
    /// outline is not known.
    pub corners: Option<[CornerPath; 2]>,
}

impl RingTooth {
    fn new(job: &ShapingJob, tooth: u32, corners: Option<[CornerPath; 2]>) -> Self {
        let phi_rad = job.curve.phi_at_arc(PI * job.transverse.module_mm * (f64::from(tooth) - 0.5));
        let flanks = SIDES.map(|side| job.target_flank(tooth, side));
        let addendum_mm = job.blank.addendum_mm;
        let height_mm = |flank: &TargetFlank, arc_mm: f64| {
            let contact = flank.at_arc(arc_mm);
            job.blank.height(contact.point_mm, contact.phi_rad).0
        };
        Self {
            tooth,
            phi_rad,
            curvature_per_mm: job.curve.frame(phi_rad).curvature_per_mm,
            start_mm: flanks.map(|flank| height_mm(flank, 0.0)),
            undercut: flanks.map(|flank| flank.form_end == FlankEnd::Undercut),
            involute_mm: flanks.map(|flank| height_mm(flank, flank.length_mm())),
            ends_early: flanks.map(|flank| flank.tip_end == FlankEnd::CutterBase),
            relief_mm: flanks.map(|flank| match flank.tip_end {
                FlankEnd::CutterBase => Some(TipRelief::new(flank, &job.blank)?.depth_mm(addendum_mm)),
                _ => Some(0.0),
            }),
            corners,
        }
    }

    /// Radius of curvature of the pitch curve there, mm; `None` where it is not hollow towards the axis.
    pub fn radius_mm(&self) -> Option<f64> {
        (self.curvature_per_mm > 0.0).then(|| 1.0 / self.curvature_per_mm)
    }
}

/// Most cutter teeth whose pitch circle is smaller than a radius, by more than rounding.
pub fn rolling_teeth(radius_mm: f64, module_mm: f64) -> u32 {
    (2.0 * radius_mm / module_mm - 1e-9).ceil() as u32 - 1
}

/// Module at which the pitch circle of a cutter is as large as the osculating circle, mm.
pub fn rolling_module_mm(radius_mm: f64, cutter_teeth: u32) -> f64 {
    2.0 * radius_mm / f64::from(cutter_teeth)
}

/// Fewest cutter teeth that generate a ring of a radius up to a height over its pitch curve; `None` where no cutter
/// that rolls does.
pub fn generating_teeth(radius_mm: f64, height_mm: f64, pressure_angle_rad: f64, module_mm: f64) -> Option<u32> {
    let (sine, cosine) = pressure_angle_rad.sin_cos();
    let across_mm2 = (radius_mm - height_mm).powi(2) - (radius_mm * cosine).powi(2);
    let pitch_radius_mm = radius_mm - across_mm2.max(0.0).sqrt() / sine;
    let teeth = (2.0 * pitch_radius_mm / module_mm).ceil().max(1.0) as u32;
    (across_mm2 > 0.0 && teeth <= rolling_teeth(radius_mm, module_mm)).then_some(teeth)
}

/// A cutter's tips against the tips of a round ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipPair {
    /// Pitch radius of the ring, or radius of curvature of its curve, mm.
    pub radius_mm: f64,
    /// Height of the ring's tips over the pitch curve, mm.
    pub addendum_mm: f64,
    /// Height of the cutter's tips over its pitch circle, mm.
    pub cutter_addendum_mm: f64,
    /// alpha, rad.
    pub pressure_angle_rad: f64,
}

impl TipPair {
    /// How far the corners of two sharp tips pass each other, arc on the pitch circles, mm: positive where they come
    /// clear. `None` where no place of the cutter decides it, or the ring's tips lie inside its base circle.
    ///
    /// Law: at the place that decides the corners stand at the angles delta from the line of centres, and each gear has
    /// turned by inv(alpha_a) - inv(alpha) and delta since its tip was in contact,
    ///
    /// ```text
    /// r_c (inv(alpha_a0) + delta_0) - rho (inv(alpha_a) + delta) + (rho - r_c) inv(alpha)  >=  0
    /// ```
    ///
    /// A cutter that **rolls** fouls where the tip circles cross. One that goes in **radially** trims where both
    /// corners have the same distance from the line of centres, `h^2 = (rho^2 r_a0^2 - r_c^2 r_a^2) / (rho^2 - r_c^2)`
    /// (trimming interference of internal gears; Elements of Metric Gear Technology, SDP/SI).
    fn passing_mm(&self, cutter_pitch_radius_mm: f64, way: Way) -> Option<f64> {
        let alpha = self.pressure_angle_rad;
        let radii_mm = [cutter_pitch_radius_mm, self.radius_mm];
        let tips_mm = [cutter_pitch_radius_mm + self.cutter_addendum_mm, self.radius_mm - self.addendum_mm];
        let apart_mm = self.radius_mm - cutter_pitch_radius_mm;
        let delta = match way {
            Way::Rolling => [(-1.0, tips_mm[0]), (1.0, tips_mm[1])].map(|(sign, tip_mm)| {
                let across_mm2 = tips_mm[1].powi(2) - tips_mm[0].powi(2) + sign * apart_mm * apart_mm;
                (across_mm2 / (2.0 * tip_mm * apart_mm)).acos()
            }),
            Way::Radial => {
                let squares_mm2 = radii_mm.map(|mm| mm * mm);
                let across_mm2 = squares_mm2[1] * tips_mm[0].powi(2) - squares_mm2[0] * tips_mm[1].powi(2);
                let across_mm = (across_mm2 / (squares_mm2[1] - squares_mm2[0])).sqrt();
                tips_mm.map(|tip_mm| (across_mm / tip_mm).asin())
            }
        };
        let turned = |i: usize| radii_mm[i] * (inv((radii_mm[i] * alpha.cos() / tips_mm[i]).acos()) + delta[i]);
        let passing_mm = turned(0) - turned(1) + apart_mm * inv(alpha);
        passing_mm.is_finite().then_some(passing_mm)
    }

    /// Most teeth of a cutter whose sharp tip corners come clear of the ring's on its way; `None` where none is known
    /// to.
    pub fn clearing_teeth(&self, module_mm: f64, way: Way) -> Option<u32> {
        let passing_mm = |teeth: u32| self.passing_mm(0.5 * module_mm * f64::from(teeth), way);
        let clears = |teeth: &u32| passing_mm(*teeth).is_some_and(|mm| mm >= 0.0);
        (1..=rolling_teeth(self.radius_mm, module_mm)).rev().find(clears)
    }
}

/// How a cutter comes into a ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// It rolls in and out of the spaces.
    Rolling,
    /// It is fed along the line of centres.
    Radial,
}

/// The condition of undercut as it is printed: that of an external gear whose pitch circle has the radius of curvature
/// of the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrintedUndercut {
    /// Module, mm.
    pub module_mm: f64,
    /// z0.
    pub cutter_teeth: f64,
    /// Addendum of the cutter in modules.
    pub addendum_coefficient: f64,
    /// sin(alpha); the paper rounds it to 0.34.
    pub sine: f64,
}

impl PrintedUndercut {
    fn of(job: &ShapingJob) -> Self {
        Self {
            module_mm: job.transverse.module_mm,
            cutter_teeth: f64::from(job.cutter.teeth),
            addendum_coefficient: job.cutter_spec.addendum_coefficient
                * (job.scene.gear.module_mm / job.transverse.module_mm),
            sine: job.transverse.pressure_angle_rad.sin(),
        }
    }

    /// Its two sides for a radius of curvature, mm2: it holds where the first is not larger.
    pub fn sides_mm2(&self, radius_mm: f64) -> [f64; 2] {
        let (m, z0, h) = (self.module_mm, self.cutter_teeth, self.addendum_coefficient);
        [m * m * h * (z0 + h), radius_mm * (radius_mm + m * z0) * self.sine.powi(2)]
    }

    /// The module up to which it holds for a radius of curvature, mm: the root of
    /// h (z0 + h) m^2 - rho z0 sin^2 m - rho^2 sin^2 = 0.
    pub fn module_limit_mm(&self, radius_mm: f64) -> f64 {
        let (z0, h, sine_2) = (self.cutter_teeth, self.addendum_coefficient, self.sine.powi(2));
        let (a, b) = (h * (z0 + h), 0.5 * z0 * sine_2);
        radius_mm * (b + (b * b + a * sine_2).sqrt()) / a
    }
}

/// The tightest path of a tip corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TightestCorner {
    /// Its path.
    pub path: CornerPath,
    /// The tooth before the space.
    pub tooth: u32,
    /// Whether the corner is on its way into the space; otherwise out of it.
    pub entering: bool,
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
    /// Most cutter teeth whose sharp tip corners come clear of the teeth at the sharpest place; `None` where not known.
    pub clearing_teeth: Option<u32>,
    /// Most cutter teeth that go in along the line of centres at the sharpest place; `None` where not known.
    pub radial_teeth: Option<u32>,
    /// Deepest place where the strokes of an infeed trim the ring; `None` where the target's outline is not known.
    pub trimming: Option<Trimming>,
    /// Lowest end of an involute before the tip: height over the pitch curve; `None` where all reach the tip.
    pub shortest_involute: Option<ToothPlace>,
    /// Fewest cutter teeth that generate the whole tips at the sharpest place; `None` where none does.
    pub generating_teeth: Option<u32>,
    /// Largest depth of a tip behind the conjugate flank; `None` where there is none, or its shape is not known.
    pub relief: Option<ToothPlace>,
    /// Highest start of a generated flank, over the pitch curve.
    pub highest_start: ToothPlace,
    /// Flanks of the whole gear whose beginning the cutter's tip cuts away.
    pub undercut_flanks: u32,
    /// Tightest path of a tip corner; `None` where the target's outline is not known.
    pub tightest_corner: Option<TightestCorner>,
    /// The printed condition of undercut.
    pub printed: PrintedUndercut,
}

impl RingFacts {
    /// Of a job of an internal gear.
    pub fn new(job: &ShapingJob) -> Self {
        let gear = &job.transverse;
        let sharpest = job.curve.facts().largest_curvature;
        let rho_mm = 1.0 / sharpest.curvature_per_mm;
        let period = job.curve.period_teeth(gear.teeth);
        let target = job.target_outline(0.0, TARGET_SPACING_MM).ok();
        let corners = target.as_ref().map(|target| corners::of_period(job, target, period));
        let corners = |tooth: u32| corners.as_ref().map(|of| of[tooth as usize - 1]);
        let teeth: Vec<RingTooth> =
            (1..=period).into_par_iter().map(|tooth| RingTooth::new(job, tooth, corners(tooth))).collect();
        // Where the involute ends before the tip.
        let ends = flanks(&teeth, |of| [0, 1].map(|side| of.ends_early[side].then_some(of.involute_mm[side])));
        let tips = TipPair {
            radius_mm: rho_mm,
            addendum_mm: job.blank.addendum_mm,
            cutter_addendum_mm: job.cutter.tip_radius_mm - job.cutter.pitch_radius_mm,
            pressure_angle_rad: gear.pressure_angle_rad,
        };
        let undercut = teeth.iter().flat_map(|of| of.undercut).filter(|&undercut| undercut).count() as u32;
        Self {
            // All periods are alike: the first place is told.
            sharpest: (rho_mm, sharpest.phi_rad.rem_euclid(TURN_RAD * f64::from(period) / f64::from(gear.teeth))),
            rolling_teeth: rolling_teeth(rho_mm, gear.module_mm),
            clearing_teeth: tips.clearing_teeth(gear.module_mm, Way::Rolling),
            radial_teeth: tips.clearing_teeth(gear.module_mm, Way::Radial),
            trimming: target.map(|target| infeed::deepest(job, &target)),
            shortest_involute: ends.flatten().reduce(|a, b| if b.mm < a.mm { b } else { a }),
            generating_teeth: generating_teeth(rho_mm, job.blank.addendum_mm, gear.pressure_angle_rad, gear.module_mm),
            relief: flanks(&teeth, |of| of.relief_mm)
                .flatten()
                .filter(|of| of.mm > 0.0)
                .reduce(|a, b| if b.mm > a.mm { b } else { a }),
            highest_start: flanks(&teeth, |of| of.start_mm.map(Some))
                .flatten()
                .reduce(|a, b| if b.mm > a.mm { b } else { a })
                .expect("a ring has teeth"),
            undercut_flanks: undercut * (gear.teeth / period),
            tightest_corner: tightest_corner(teeth.iter().filter_map(|of| Some((of.tooth, of.corners?)))),
            printed: PrintedUndercut::of(job),
            teeth,
        }
    }
}

/// Lengths of both sides of all teeth with their places.
fn flanks(
    teeth: &[RingTooth],
    of: impl Fn(&RingTooth) -> [Option<f64>; 2],
) -> impl Iterator<Item = Option<ToothPlace>> {
    teeth.iter().flat_map(move |tooth| {
        let place = |(side, mm): (Side, Option<f64>)| mm.map(|mm| ToothPlace { mm, tooth: tooth.tooth, side });
        SIDES.into_iter().zip(of(tooth)).map(place).collect::<Vec<_>>()
    })
}

/// What holds of tip corners of any edge: the tightest path, and the deepest place where an infeed trims the ring;
/// `None` where the target's outline is not known.
pub fn corners_of_any_edge(job: &ShapingJob) -> (Option<TightestCorner>, Option<Trimming>) {
    let Ok(target) = job.target_outline(0.0, TARGET_SPACING_MM) else { return (None, None) };
    let paths = corners::of_period(job, &target, job.curve.period_teeth(job.transverse.teeth));
    (tightest_corner((1..).zip(paths)), Some(infeed::deepest(job, &target)))
}

fn tightest_corner(spaces: impl Iterator<Item = (u32, [CornerPath; 2])>) -> Option<TightestCorner> {
    let paths = spaces.flat_map(|(tooth, paths)| {
        paths.into_iter().zip([true, false]).map(move |(path, entering)| TightestCorner { path, tooth, entering })
    });
    paths.reduce(|a, b| if b.path.clearance_mm < a.path.clearance_mm { b } else { a })
}

#[cfg(test)]
mod tests {
    use super::{TipPair, Way, rolling_teeth};

    /// A cutter with as many teeth as a round ring touches it everywhere.
    #[test]
    fn a_cutter_as_large_as_the_ring_does_not_roll() {
        for teeth in 4..=500_u32 {
            // As a curvature gives the radius.
            let radius_mm = 1.0 / (1.0 / (0.5 * 3.0 * f64::from(teeth)));
            assert_eq!(rolling_teeth(radius_mm, 3.0), teeth - 1);
        }
        assert_eq!(rolling_teeth(30.001, 3.0), 20);
    }

    /// Rings of 40, 58 and 118 teeth: 22, 40 and 100 cutter teeth go in radially, as the condition of trimming gives
    /// with the addenda 1.25 and 1 modules, worked out elsewhere from the angles of both corners.
    #[test]
    fn as_many_teeth_go_in_radially_as_the_condition_of_trimming_says() {
        for (ring_teeth, cutter_teeth) in [(40, 22), (58, 40), (118, 100)] {
            for module_mm in [1.0, 4.0] {
                let tips = TipPair {
                    radius_mm: 0.5 * module_mm * f64::from(ring_teeth),
                    addendum_mm: module_mm,
                    cutter_addendum_mm: 1.25 * module_mm,
                    pressure_angle_rad: 20_f64.to_radians(),
                };
                assert_eq!(tips.clearing_teeth(module_mm, Way::Radial), Some(cutter_teeth));
                assert!(tips.clearing_teeth(module_mm, Way::Rolling) > Some(cutter_teeth));
            }
        }
    }
}
