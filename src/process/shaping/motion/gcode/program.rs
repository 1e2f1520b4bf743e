//! Axis positions as straight lines between knots, in the stroke coordinate.

use crate::gcode::{Digits, beyond_limits, longest_lines};
use crate::machine::{AxisMotion, Limits, Order, Peak};
use crate::process::shaping::linkage::dynamics::{self, AXES};
use crate::process::shaping::linkage::{CutterPose, StrokeSchedule};
use crate::process::shaping::scene::model::AxisLimits;
use crate::scene::Post;
use gearcut_core::gear::GearKind;
use glam::DVec2;

/// Half of the arc of the cutter round the line of centres that can be in the work; a cutter of twelve teeth meets it
/// over less.
const ENGAGED_RAD: f64 = 1.0;
/// Samples between two places where knots may stand, where the feed goes on during the strokes.
const SAMPLES_PER_PART: usize = 4;
/// Parts of a stroke on which knots may stand. The error between knots falls with the square of their distance, at the
/// end of an infeed with the distance: a 64th takes any of them below what is asked for steel.
const PARTS_OF_A_STROKE: [usize; 4] = [1, 4, 16, 64];
/// Strokes that differ by less are one: rounding of F.
pub(super) const WHOLE_STROKE: f64 = 1e-6;
/// A stroke is made if the ram runs on for this share of it: its cutting half. Dwells are rounded up to milliseconds by
/// some controls, which is no stroke.
const CUTTING_HALF: f64 = 0.5;
/// Shortest block, s: what block buffers of older controls keep up with.
const SHORTEST_S: f64 = 1e-3;

/// Axis positions at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knot {
    /// Stroke coordinate: stroke i (from 0) is made at i.
    pub stroke: f64,
    /// Work angle psi_c, rad.
    pub psi_c_rad: f64,
    /// Cutter angle psi_b, rad.
    pub psi_b_rad: f64,
    /// Centre distance, mm.
    pub center_distance_mm: f64,
}

/// A program: knots in order of time, the first at stroke 0.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisProgram {
    /// Speed of the ram.
    pub double_strokes_per_minute: f64,
    /// At least one.
    pub knots: Vec<Knot>,
    /// Double strokes that the ram makes after the last knot before it stops.
    pub runs_on: f64,
}

/// How many strokes a ram makes that stops at a stroke coordinate.
pub(super) fn strokes_until(stop: f64) -> usize {
    (stop + 1.0 - CUTTING_HALF + WHOLE_STROKE).floor() as usize
}

impl Knot {
    /// The knot as it will be written.
    pub(super) fn rounded(&self, digits: Digits) -> Self {
        let axes = self.axes();
        Self::at(self.stroke, std::array::from_fn(|index| digits.rounded(AXES[index].kind, axes[index])))
    }

    /// Of axes in the order of [`AXES`].
    pub(super) fn at(stroke: f64, [psi_c_rad, psi_b_rad, center_distance_mm]: [f64; 3]) -> Self {
        Self { stroke, psi_c_rad, psi_b_rad, center_distance_mm }
    }

    /// In the order of [`AXES`].
    pub fn axes(&self) -> [f64; 3] {
        [self.psi_c_rad, self.psi_b_rad, self.center_distance_mm]
    }

    /// Where a schedule has the axes.
    pub(super) fn of(schedule: &StrokeSchedule, stroke: f64) -> Self {
        let state = schedule.state(stroke);
        Self {
            stroke,
            psi_c_rad: state.psi_c_rad,
            psi_b_rad: state.psi_b_rad,
            center_distance_mm: state.center_distance_mm,
        }
    }

    /// Cutter in the gear frame.
    pub fn pose(&self, gear: GearKind) -> CutterPose {
        CutterPose::new(gear, self.axes())
    }

    fn between(a: &Self, b: &Self, stroke: f64) -> Self {
        let share = if b.stroke > a.stroke { (stroke - a.stroke) / (b.stroke - a.stroke) } else { 0.0 };
        let mix = |a: f64, b: f64| a + share * (b - a);
        Self {
            stroke,
            psi_c_rad: mix(a.psi_c_rad, b.psi_c_rad),
            psi_b_rad: mix(a.psi_b_rad, b.psi_b_rad),
            center_distance_mm: mix(a.center_distance_mm, b.center_distance_mm),
        }
    }

    /// Largest displacement of the cutter's edge in the work against another position, over the arc that can be in the
    /// work, mm.
    pub fn displacement_mm(&self, other: &Self, gear: GearKind, tip_radius_mm: f64) -> f64 {
        let (a, b) = (self.pose(gear), other.pose(gear));
        let shift = b.center_mm - a.center_mm;
        let turn = b.angle_rad - a.angle_rad;
        let to_work = -gear.tip_sign() * a.center_mm.normalize_or_zero();
        [-1.0, -0.5, 0.0, 0.5, 1.0]
            .into_iter()
            .map(|share| {
                let arm = tip_radius_mm * DVec2::from_angle(share * ENGAGED_RAD).rotate(to_work);
                // (R - I) arm with sin and 2 sin^2(half angle): differences of nanometres stay exact.
                let half = (0.5 * turn).sin();
                (shift + turn.sin() * arm.perp() - 2.0 * half * half * arm).length()
            })
            .fold(0.0, f64::max)
    }
}

impl AxisProgram {
    /// Longest straight lines, one after the other, that keep every stroke of a schedule within `contour_error_mm`;
    /// with `continuous` also what lies between the strokes. Knots stand on whole strokes, or on parts of them where
    /// whole strokes leave more than is asked: where an infeed begins or ends between two of them. They are rounded as
    /// they will be written for `post`.
    pub fn fit(
        schedule: &StrokeSchedule,
        tip_radius_mm: f64,
        contour_error_mm: f64,
        continuous: bool,
        post: Post,
    ) -> Self {
        let shortest_s = SHORTEST_S.max(post.shortest_block_s());
        let fitting = |parts: usize| parts == 1 || continuous && schedule.time_s(1.0) / parts as f64 >= shortest_s;
        let mut program = None;
        for parts in PARTS_OF_A_STROKE.into_iter().filter(|&parts| fitting(parts)) {
            let fitted = Self::fit_parts(schedule, tip_radius_mm, contour_error_mm, continuous, post, parts);
            let reached_mm = fitted.contour_error_mm(schedule, tip_radius_mm, continuous).0;
            program = Some(fitted);
            if reached_mm <= contour_error_mm {
                break;
            }
        }
        program.expect("whole strokes are always tried")
    }

    /// The same with knots on the `parts`th parts of strokes.
    fn fit_parts(
        schedule: &StrokeSchedule,
        tip_radius_mm: f64,
        contour_error_mm: f64,
        continuous: bool,
        post: Post,
        parts: usize,
    ) -> Self {
        let per_part = if continuous { SAMPLES_PER_PART } else { 1 };
        let per_stroke = per_part * parts;
        let gear = schedule.linkage().gear();
        let last = (schedule.count() - 1) * parts;
        let exact: Vec<Knot> =
            (0..=last * per_part).map(|sample| Knot::of(schedule, sample as f64 / per_stroke as f64)).collect();
        let reach_mm = exact.iter().map(|k| k.center_distance_mm).fold(0.0, f64::max) + tip_radius_mm;
        let digits = post.digits(contour_error_mm, reach_mm);
        let fits = |from: usize, to: usize| {
            let (a, b) = (exact[from * per_part].rounded(digits), exact[to * per_part].rounded(digits));
            exact[from * per_part..=to * per_part].iter().all(|knot| {
                Knot::between(&a, &b, knot.stroke).displacement_mm(knot, gear, tip_radius_mm) <= contour_error_mm
            })
        };
        let mut knots = vec![exact[0].rounded(digits)];
        knots.extend(longest_lines(last, fits).into_iter().map(|end| exact[end * per_part].rounded(digits)));
        // The last stroke is made where the last line ends.
        Self { double_strokes_per_minute: 60.0 / schedule.time_s(1.0), knots, runs_on: 1.0 }
    }

    /// Strokes that the ram makes until it stops.
    pub fn count(&self) -> usize {
        strokes_until(self.last().stroke + self.runs_on)
    }

    pub(super) fn last(&self) -> &Knot {
        self.knots.last().expect("a program has a first position")
    }

    /// Parts of a stroke that its shortest block is one of, up to the finest of a written program.
    fn parts_of_a_stroke(&self) -> usize {
        let blocks = self.knots.windows(2).map(|pair| pair[1].stroke - pair[0].stroke);
        let shortest = blocks.filter(|&strokes| strokes > 0.0).fold(1.0, f64::min);
        let [.., finest] = PARTS_OF_A_STROKE;
        (1.0 / shortest).round().min(finest as f64) as usize
    }

    /// Axis positions at a stroke coordinate; before the first and after the last knot the motion is continued.
    pub fn at(&self, stroke: f64) -> Knot {
        let after = self.block_at(stroke);
        match self.knots.get(after) {
            Some(b) => Knot::between(&self.knots[after - 1], b, stroke),
            None => Knot { stroke, ..self.knots[0] },
        }
    }

    /// Number of the knot that ends the block run at a stroke coordinate.
    fn block_at(&self, stroke: f64) -> usize {
        self.knots.partition_point(|k| k.stroke <= stroke).clamp(1, self.knots.len().max(2) - 1)
    }

    /// How the axes change per stroke in the block that ends at a knot, and its length in strokes; none where there is
    /// no such block, or one without length.
    fn rates_of(&self, after: usize) -> Option<([f64; 3], f64)> {
        let (a, b) = (self.knots.get(after.checked_sub(1)?)?, self.knots.get(after)?);
        let strokes = b.stroke - a.stroke;
        (strokes > 0.0).then(|| (std::array::from_fn(|i| (b.axes()[i] - a.axes()[i]) / strokes), strokes))
    }

    /// How the axes change per stroke at a stroke coordinate, in the order of [`AXES`]: those of its block.
    pub fn rates(&self, stroke: f64) -> [f64; 3] {
        self.rates_of(self.block_at(stroke)).map_or([0.0; 3], |(rates, _)| rates)
    }

    /// The axes at a stroke coordinate: within a block at its speed; where two blocks meet, the step of speed is taken
    /// within a double stroke, or within the shorter of both blocks where that is less.
    pub fn motion(&self, stroke: f64) -> [AxisMotion; 3] {
        let stroke_s = 60.0 / self.double_strokes_per_minute;
        let after = self.block_at(stroke);
        let speeds = |after: usize| self.rates_of(after).map(|(rates, strokes)| (rates.map(|r| r / stroke_s), strokes));
        let here = speeds(after);
        // A stroke that stands on a knot begins a block.
        let meets = (self.knots[after - 1].stroke - stroke).abs() < WHOLE_STROKE;
        let before = if meets { speeds(after - 1) } else { None };
        let position = self.at(stroke).axes();
        std::array::from_fn(|i| AxisMotion {
            position: position[i],
            velocity: here.map_or(0.0, |(speeds, _)| speeds[i]),
            acceleration: match (before, here) {
                (Some((before, shorter)), Some((here, strokes))) => {
                    (here[i] - before[i]) / (shorter.min(strokes).min(1.0) * stroke_s)
                }
                _ => 0.0,
            },
        })
    }

    /// Largest displacement from a schedule at its strokes, with `continuous` also between them, mm, and the stroke
    /// coordinate.
    pub fn contour_error_mm(&self, schedule: &StrokeSchedule, tip_radius_mm: f64, continuous: bool) -> (f64, f64) {
        let per_stroke = if continuous { SAMPLES_PER_PART * self.parts_of_a_stroke() } else { 1 };
        (0..=(schedule.count() - 1) * per_stroke)
            .map(|sample| {
                let stroke = sample as f64 / per_stroke as f64;
                let gear = schedule.linkage().gear();
                (Knot::of(schedule, stroke).displacement_mm(&self.at(stroke), gear, tip_radius_mm), stroke)
            })
            .fold((0.0, 0.0), |worst, next| if next.0 > worst.0 { next } else { worst })
    }

    /// What the program asks of the axes, axis by axis: speeds within blocks, and steps of speed between blocks taken
    /// within one double stroke, or within the shorter of both blocks where that is less; each with its stroke. Where
    /// an infeed of `schedule` begins or ends, the control rounds the corner, as it does for the schedule itself.
    pub fn peaks(&self, schedule: &StrokeSchedule, limits: &[Limits; 3]) -> Vec<Peak> {
        let rounded = |at: f64| schedule.corners().iter().any(|corner| (corner - at).abs() < 1.0);
        let stroke_s = 60.0 / self.double_strokes_per_minute;
        let mut peaks = Vec::new();
        for (index, (axis, limits)) in AXES.iter().zip(limits).enumerate() {
            // Speed of each block, how many double strokes it lasts, and where it begins.
            let blocks: Vec<[f64; 3]> = self
                .knots
                .windows(2)
                .filter(|pair| pair[1].stroke > pair[0].stroke)
                .map(|pair| {
                    let travel = pair[1].axes()[index] - pair[0].axes()[index];
                    let strokes = pair[1].stroke - pair[0].stroke;
                    [travel / (strokes * stroke_s), strokes, pair[0].stroke]
                })
                .collect();
            let largest = |of: &mut dyn Iterator<Item = [f64; 2]>| {
                of.fold([0.0, 0.0], |most, next| if next[0] > most[0] { next } else { most })
            };
            let speed = largest(&mut blocks.iter().map(|[speed, _, at]| [speed.abs(), *at]));
            let joints = blocks.windows(2).filter(|pair| !rounded(pair[1][2]));
            let acceleration = largest(&mut joints.map(|pair| {
                let [[v, strokes, _], [next_v, next_strokes, at]] = [pair[0], pair[1]];
                [(next_v - v).abs() / (strokes.min(next_strokes).min(1.0) * stroke_s), at]
            }));
            for (order, [value, at]) in [(Order::Speed, speed), (Order::Acceleration, acceleration)] {
                peaks.push(Peak { axis, order, value, at, limit: limits.of(order) });
            }
        }
        peaks
    }

    /// What the program asks beyond the machine's limits.
    pub fn exceeded(&self, schedule: &StrokeSchedule, limits: &AxisLimits) -> Vec<String> {
        let limits = dynamics::limits(limits);
        let peaks = self.peaks(schedule, &limits);
        let pairs = AXES.iter().zip(&limits).zip(peaks.chunks_exact(2));
        pairs.flat_map(|((axis, limits), of)| beyond_limits(axis, limits, [of[0].value, of[1].value])).collect()
    }
}
