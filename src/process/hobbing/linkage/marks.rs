//! Cutting marks on the flanks from kinematics alone: where each gash touches, and the lattice that the touches form.
//!
//! In: linkage, target, hob. Out: [`Mark`]s in flank coordinates (roll past the pitch line, z), steps between them as
//! vectors on the flank, the shortest two of the lattice.
//!
//! **Law.** Hob and gear are conjugate to one rack; both touch it where its flank's normal passes the pitch point of
//! each: on the line of action `Q = (0, 0, z) + lambda N` of the machine frame, N the rack's normal, z the slide. The
//! rack stands at lambda = -e sigma cos(alpha_n) cos(beta) along it, sigma the roll in the section z. A gash's mark is
//! where its rake face holds Q at that moment. There the edge lies on the target exactly; between marks it leaves
//! ridges.
//!
//! Neighbours in the lattice are the next gash (v1) and the same hob tooth when the work has come round, gear teeth /
//! starts turns of the hob later (v2). Without shift v2 is the axial feed along the tooth; with shift it crosses the
//! profile.

use super::HobbingLinkage;
use crate::process::hobbing::Hob;
use crate::process::hobbing::rack_generation::RackGeneration;
use gearcut_core::math::convergence::{Step, iterate};
use gearcut_core::math::newton::{EVERYWHERE, LastStep, newton_within};
use gearcut_core::terms::Side;
use gearcut_core::tool::SpatialTool;
use gearcut_core::units::TURN_RAD;
use glam::{DVec2, DVec3};
use std::ops::ControlFlow;

/// Secant steps to a mark at most, and how much of one plus its moment rounding may keep it from resting.
const MARK_STEPS: u32 = 60;
const MARK_SETTLED: f64 = 1e-12;
/// Newton steps to a rolled arc before its bracket is halved.
const ROLL_STEPS: u32 = 50;

/// Where a gash touches a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// Roll past the flank's crossing with the pitch line, mm.
    pub roll_mm: f64,
    /// Place along the gear's axis, gear frame, mm.
    pub z_mm: f64,
    /// When.
    pub time_s: f64,
}

/// Everything marks follow from.
#[derive(Debug, Clone, Copy)]
pub struct Marks<'a> {
    /// How the axes move.
    pub linkage: &'a HobbingLinkage,
    /// The rack and the pitch curve.
    pub target: &'a RackGeneration,
    /// The hob.
    pub hob: &'a Hob,
    /// Which flanks.
    pub side: Side,
}

impl Marks<'_> {
    /// Mark of gash passage `gash` (any integer, counted from hob angle 0) on the flank of `space` (any integer,
    /// counted along the rolled arc without wrapping).
    pub fn mark(&self, gash: i64, space: i64) -> Mark {
        let start = self.linkage.time_at_hob_angle(TURN_RAD * gash as f64 / f64::from(self.hob.gashes));
        let residual = |t: f64| self.touch(gash, space, t).0;
        // Secant steps: the residual is the hob's angle plus little. They go on until rounding alone moves them.
        let (mut t0, mut f0) = (start, residual(start));
        let second = start + 1e-4 * self.linkage.cycle_s();
        let found = iterate("the moment of a mark", second, MARK_STEPS, |t1| {
            let f1 = residual(t1);
            if f1 == f0 {
                return ControlFlow::Break(t1);
            }
            let to = t1 - f1 * (t1 - t0) / (f1 - f0);
            (t0, f0) = (t1, f1);
            if (to - t1).abs() < 1e-15 * (1.0 + to.abs()) {
                return ControlFlow::Break(to);
            }
            ControlFlow::Continue(Step { to, residual: f1 })
        });
        let settled = found.or_else(|error| error.settled(MARK_SETTLED * (1.0 + error.last.abs())));
        // The hob turns forwards, so that the residual passes zero once: otherwise the moment is bracketed.
        let hand = self.linkage.geometry().hob_hand;
        let time_s = settled.unwrap_or_else(|_| {
            newton_within(start, EVERYWHERE, LastStep::default(), 0, |t| [-hand * residual(t), 0.0])
        });
        self.touch(gash, space, time_s).1
    }

    /// Angle by which the rake face is past Q, and the mark that Q would be.
    fn touch(&self, gash: i64, space: i64, time_s: f64) -> (f64, Mark) {
        let g = self.linkage.geometry();
        let axes = self.linkage.axes::<1>(time_s);
        let rack = &self.target.rack;
        let e = self.side.sign();
        let (sin_t, cos_t) = rack.pressure_angle_rad.sin_cos();
        let (sin_b, cos_b) = g.helix_angle_rad.sin_cos();
        // alpha_n from the transverse section: tan(alpha_n) = tan(alpha_t) cos(beta).
        let (sin_n, cos_n) = (sin_t / cos_t * cos_b).atan().sin_cos();
        let normal = DVec3::new(e * cos_n * cos_b, sin_n, e * g.gear_hand * cos_n * sin_b);
        let slide_mm = axes.slide_mm.value();
        let roll_at_slide = axes.arc_mm.value() - self.target.crossing_arc_mm(space, self.side, -slide_mm);
        let lambda = -e * cos_n * cos_b * roll_at_slide;
        let axis = g.hob_axis();
        let across = axis.cross(DVec3::NEG_Y);
        let from_axis = lambda * normal - DVec3::new(0.0, g.pitch_radius_mm + axes.radial_mm.value(), 0.0);
        let place = from_axis.dot(across).atan2(-from_axis.y);
        let axial_mm = from_axis.dot(axis) - axes.shift_mm.value();
        let passed = axes.hob_rad.value() - TURN_RAD * gash as f64 / f64::from(self.hob.gashes);
        let rake = g.hob_hand * passed - self.hob.rake_twist_rad_per_mm() * axial_mm;
        let transverse_mm = lambda * normal.x.hypot(normal.y);
        let mark = Mark { roll_mm: -e * transverse_mm / cos_t, z_mm: -(slide_mm + lambda * normal.z), time_s };
        (rake - place, mark)
    }

    /// Mark nearest to the pitch line of the flank of `space` (0 to one less than the gear's `teeth`) in the cycle in
    /// which the slide comes nearest to the height `z_mm`: its gash, the space counted without wrapping, the mark.
    pub fn nearest(&self, space: i64, teeth: u32, z_mm: f64) -> (i64, i64, Mark) {
        let cycles = (self.linkage.end_s() / self.linkage.cycle_s()).ceil() as i64;
        let slide_apart = |space: i64| {
            let time_s = self.time_at_arc(self.target.crossing_arc_mm(space, self.side, z_mm));
            (self.linkage.axes::<1>(time_s).slide_mm.value() + z_mm).abs()
        };
        let space = (-1..=cycles)
            .map(|cycle| space + cycle * i64::from(teeth))
            .min_by(|&a, &b| slide_apart(a).total_cmp(&slide_apart(b)))
            .unwrap_or(space);
        let time_s = self.time_at_arc(self.target.crossing_arc_mm(space, self.side, z_mm));
        let hob_rad = self.linkage.axes::<1>(time_s).hob_rad.value();
        let guess = (hob_rad / TURN_RAD * f64::from(self.hob.gashes)).round() as i64;
        let (gash, mark) = (guess - 4..=guess + 4)
            .map(|gash| (gash, self.mark(gash, space)))
            .min_by(|a, b| a.1.roll_mm.abs().total_cmp(&b.1.roll_mm.abs()))
            .expect("nine gashes");
        (gash, space, mark)
    }

    /// Time at which the pitch curve has rolled to `arc_mm`.
    fn time_at_arc(&self, arc_mm: f64) -> f64 {
        let perimeter_mm = self.linkage.curve().perimeter_mm();
        let start = arc_mm / perimeter_mm * self.linkage.cycle_s();
        newton_within(start, EVERYWHERE, LastStep::relative(1e-12), ROLL_STEPS, |time_s| {
            let arc = self.linkage.axes::<2>(time_s).arc_mm;
            // The rate jumps where feeds begin, by little: the rolling is much faster than they are.
            let missing_mm = arc_mm - arc.value();
            [missing_mm, missing_mm / arc.derivative(1)]
        })
    }

    /// Step from a mark to the one of the next gash.
    pub fn to_next_gash(self, gash: i64, space: i64) -> DVec2 {
        step(self.mark(gash, space), self.mark(gash + 1, space))
    }

    /// Step from a mark to the one of the same hob tooth when the work has come round.
    pub fn to_same_tooth(self, gash: i64, space: i64, gear_teeth: u32) -> DVec2 {
        let teeth = i64::from(gear_teeth);
        let turns = teeth * i64::from(self.hob.gashes) / i64::from(self.hob.starts);
        step(self.mark(gash, space), self.mark(gash + turns, space + teeth))
    }

    /// A step (roll, z) measured on the flank where the profile takes `length_per_roll` (see
    /// [`crate::process::hobbing::rack_generation::RackContact::length_per_roll`]).
    pub fn on_flank(&self, step: DVec2, length_per_roll: f64) -> MarkStep {
        let (sin_t, cos_t) = self.target.rack.pressure_angle_rad.sin_cos();
        let g = self.linkage.geometry();
        let (sin_b, cos_b) = g.helix_angle_rad.sin_cos();
        let e = self.side.sign();
        let profile = DVec3::new(sin_t, -e * cos_t, 0.0);
        let trace = DVec3::new(g.gear_hand * sin_b, 0.0, cos_b);
        let vector = length_per_roll * step.x * profile + step.y / cos_b * trace;
        let along = vector.dot(trace);
        let across = (vector - along * trace).length().copysign(step.x);
        let axial = vector.z.abs();
        MarkStep {
            step_mm: step,
            on_flank_mm: DVec2::new(along, across),
            to_axis_rad: vector.truncate().length().atan2(axial),
        }
    }

    /// The two shortest steps that span the same lattice as `steps` on a flank where the profile takes
    /// `length_per_roll`, the shortest first.
    pub fn reduced(&self, steps: [DVec2; 2], length_per_roll: f64) -> [MarkStep; 2] {
        let on_flank = |step: DVec2| self.on_flank(step, length_per_roll);
        shortest(steps, |step| on_flank(step).on_flank_mm).map(on_flank)
    }
}

/// The two shortest steps that span the same lattice as two others (Lagrange's reduction), the shortest first; `vector`
/// gives the length of a step.
///
/// Every round but the last makes the longer step shorter by a factor of `sqrt(3)` or ends the reduction: lengths of 15
/// digits are through after 70 rounds.
pub fn shortest([mut a, mut b]: [DVec2; 2], vector: impl Fn(DVec2) -> DVec2) -> [DVec2; 2] {
    for _ in 0..100 {
        if vector(a).length_squared() > vector(b).length_squared() {
            (a, b) = (b, a);
        }
        let times = (vector(a).dot(vector(b)) / vector(a).length_squared()).round();
        if times == 0.0 {
            break;
        }
        b -= times * a;
    }
    [a, b]
}

/// A vector from one mark to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkStep {
    /// Step in roll and place along the gear's axis, mm.
    pub step_mm: DVec2,
    /// The same on the flank: along the tooth trace and across it, mm.
    pub on_flank_mm: DVec2,
    /// Angle to the gear's axis, 0 to pi/2.
    pub to_axis_rad: f64,
}

impl MarkStep {
    /// Length on the flank, mm.
    pub fn length_mm(&self) -> f64 {
        self.on_flank_mm.length()
    }

    /// Angle to the tooth trace, -pi/2 to pi/2.
    pub fn to_trace_rad(self) -> f64 {
        (self.on_flank_mm.y / self.on_flank_mm.x).atan()
    }
}

fn step(from: Mark, to: Mark) -> DVec2 {
    DVec2::new(to.roll_mm - from.roll_mm, to.z_mm - from.z_mm)
}
