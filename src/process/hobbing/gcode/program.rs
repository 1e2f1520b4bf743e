//! Straight lines in all axes that follow a linkage.
//!
//! In: a prepared operation, the contour error. Out: a [`HobbingProgram`]: the longest blocks that keep the hob, where
//! it can be in the work, within that error; what it asks of the axes; the share of it that an electronic gearbox takes
//! over.

use crate::gcode::{Digits, beyond_limits, longest_lines};
use crate::process::hobbing::HobbingJob;
use crate::process::hobbing::commanded::{HobbingKnot, HobbingProgram, Positions};
use crate::process::hobbing::job::PreparedHobbing;
use crate::process::hobbing::linkage::HobbingLinkage;
use crate::process::hobbing::linkage::dynamics::{self, AXES, in_order};
use crate::process::hobbing::linkage::{HobbingGeometry, work_from_machine_at};
use crate::process::hobbing::scene::model::HobbingAxisLimits;
use gearcut_core::units::TURN_RAD;
use glam::DVec3;
use rayon::prelude::*;

/// Shortest block, s: what block buffers of older controls keep up with.
const SHORTEST_S: f64 = 1e-3;
/// Blocks in a cycle along the pitch curve are no shorter than this share of it.
const SHARE_OF_CYCLE: f64 = 1.0 / 1440.0;
/// Places within the shortest block at which a program is compared with its linkage.
const SAMPLES: usize = 2;
/// Share of the contour error that the samples may show, so that what lies between them stays below all of it.
const SAMPLED_SHARE: f64 = 0.95;

/// What an electronic gearbox adds to the work's angle, rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gearbox {
    /// Work per hob angle: starts over teeth.
    pub per_hob: f64,
    /// Work per slide, rad/mm: the helix.
    pub per_slide: f64,
    /// Work per shift, rad/mm.
    pub per_shift: f64,
}

impl Gearbox {
    /// Of a linkage: a circle as long as its pitch curve rolls on the hob's rack.
    pub fn new(linkage: &HobbingLinkage) -> Self {
        let (g, per_arc) = (linkage.geometry(), TURN_RAD / linkage.curve().perimeter_mm());
        Self {
            per_hob: per_arc * g.arc_per_hob_rad_mm(),
            per_slide: per_arc * g.arc_per_slide(),
            per_shift: per_arc * g.arc_per_shift(),
        }
    }

    /// Angle of the work that the gearbox gives, rad.
    pub fn work_rad(&self, axes: &Positions) -> f64 {
        self.per_hob * axes[0] + self.per_slide * axes[4] + self.per_shift * axes[5]
    }
}

/// Points of the hob that can be in the work, machine frame at the pitch point, mm.
pub(super) struct ContactZone {
    geometry: HobbingGeometry,
    points_mm: Vec<DVec3>,
}

impl ContactZone {
    pub(super) fn new(job: &HobbingJob, operation: &PreparedHobbing) -> Self {
        let geometry = *operation.linkage.geometry();
        let along_mm = operation.plan.contact_half_length_mm;
        let tip_mm = job.hob.tip_radius_mm - job.hob.pitch_radius_mm;
        let points_mm = [-along_mm, 0.0, along_mm]
            .into_iter()
            .flat_map(|along| [-tip_mm, job.stock.addendum_mm].map(|y| along * geometry.hob_axis() + y * DVec3::Y))
            .collect();
        Self { geometry, points_mm }
    }

    /// Largest displacement of these points of the hob in the work between two positions, mm.
    pub(super) fn displacement_mm(&self, exact: &Positions, other: &Positions) -> f64 {
        let [a, b] = [exact, other].map(|&[hob, work, x, y, slide, shift]| {
            // Infeed counts in Y: the pitch plane stands where the program says.
            let machine_from_tool = self.geometry.machine_from_tool(hob, 0.0, slide, shift);
            (work_from_machine_at(work, x, y).after(&machine_from_tool), machine_from_tool)
        });
        let tool_from_machine = a.1.inverse();
        let stand_mm = DVec3::new(0.0, 0.0, exact[4]);
        self.points_mm
            .iter()
            .map(|&point| tool_from_machine.point(point + stand_mm))
            .map(|point| a.0.point(point).distance(b.0.point(point)))
            .fold(0.0, f64::max)
    }
}

/// Shortest block of an operation, s.
pub(super) fn shortest_block_s(job: &HobbingJob, linkage: &HobbingLinkage) -> f64 {
    let of_control_s = job.scene.output.post.shortest_block_s();
    SHORTEST_S.max(of_control_s).max(SHARE_OF_CYCLE * linkage.cycle_s())
}

/// Digits of lengths and angles: angles count at the largest distance from an axis of rotation that matters.
pub(super) fn digits(job: &HobbingJob, contour_error_mm: f64) -> Digits {
    let reach_mm = (job.curve.facts().largest_radius_mm + job.stock.addendum_mm).max(job.hob.tip_radius_mm);
    job.scene.output.post.digits(contour_error_mm, reach_mm)
}

pub(super) fn exact(linkage: &HobbingLinkage, time_s: f64) -> Positions {
    in_order(&linkage.axes::<1>(time_s)).map(|series| series.value())
}

/// Moments at which a program is compared with its linkage.
pub(super) fn sample_times_s(linkage: &HobbingLinkage, shortest_s: f64) -> impl ParallelIterator<Item = f64> {
    let count = (linkage.end_s() / shortest_s * SAMPLES as f64).ceil() as u32;
    let end_s = linkage.end_s();
    (0..=count).into_par_iter().map(move |i| end_s * f64::from(i) / f64::from(count))
}

/// Positions as they will be written.
fn rounded(axes: &Positions, digits: Digits) -> Positions {
    std::array::from_fn(|axis| digits.rounded(AXES[axis].kind, axes[axis]))
}

impl HobbingProgram {
    /// Longest straight lines, one after the other, that keep the hob within `contour_error_mm` of the operation's
    /// linkage, as far as the shortest blocks can. Feeds begin and end at knots.
    pub fn fit(job: &HobbingJob, operation: &PreparedHobbing, contour_error_mm: f64) -> Self {
        let linkage = &operation.linkage;
        let zone = ContactZone::new(job, operation);
        let digits = digits(job, contour_error_mm);
        let shortest_s = shortest_block_s(job, linkage);
        let sampled_mm = SAMPLED_SHARE * contour_error_mm;
        let mut knots: Vec<HobbingKnot> = Vec::new();
        for corner in linkage.corners_s().windows(2) {
            let [from_s, to_s] = [corner[0], corner[1]];
            let blocks = ((to_s - from_s) / shortest_s).floor().max(1.0) as usize;
            let time = |sample: usize| from_s + (to_s - from_s) * sample as f64 / (blocks * SAMPLES) as f64;
            let samples: Vec<HobbingKnot> = (0..=blocks * SAMPLES)
                .into_par_iter()
                .map(|sample| HobbingKnot { time_s: time(sample), axes: exact(linkage, time(sample)) })
                .collect();
            let written = |block: usize| {
                let knot = samples[block * SAMPLES];
                HobbingKnot { axes: rounded(&knot.axes, digits), ..knot }
            };
            let fits = |from: usize, to: usize| {
                let (a, b) = (written(from), written(to));
                samples[from * SAMPLES..=to * SAMPLES]
                    .iter()
                    .all(|knot| zone.displacement_mm(&knot.axes, &a.between(&b, knot.time_s)) <= sampled_mm)
            };
            if knots.is_empty() {
                knots.push(written(0));
            }
            knots.extend(longest_lines(blocks, fits).into_iter().map(written));
        }
        Self { knots }
    }

    /// Largest displacement of the hob from an operation's linkage, mm, and when, s.
    pub fn contour_error_mm(&self, job: &HobbingJob, operation: &PreparedHobbing) -> (f64, f64) {
        let (linkage, zone) = (&operation.linkage, ContactZone::new(job, operation));
        let shortest_s = shortest_block_s(job, linkage);
        sample_times_s(linkage, shortest_s)
            .map(|time_s| (zone.displacement_mm(&exact(linkage, time_s), &self.at(time_s)), time_s))
            .reduce(|| (0.0, 0.0), |worst, next| if next.0 > worst.0 { next } else { worst })
    }

    /// What the program asks beyond the machine's limits: speeds within blocks, and steps of speed between blocks over
    /// the mean of their times. Where feeds begin, change and end, at `corners_s`, the control's own ramps hold.
    pub fn exceeded(&self, limits: &HobbingAxisLimits, corners_s: &[f64]) -> Vec<String> {
        let limits = dynamics::limits(limits);
        let mut exceeded = Vec::new();
        for (axis, described) in AXES.iter().enumerate() {
            let speeds: Vec<(f64, f64, f64)> = self
                .knots
                .windows(2)
                .map(|pair| (pair[0].time_s, pair[1].time_s, pair))
                .map(|(from, to, pair)| (from, to, (pair[1].axes[axis] - pair[0].axes[axis]) / (to - from)))
                .collect();
            let largest = speeds.iter().fold(0.0_f64, |most, (.., speed)| most.max(speed.abs()));
            let ramp = |time: f64| corners_s.iter().any(|corner| (corner - time).abs() < 1e-9);
            let step = speeds
                .windows(2)
                .filter(|pair| !ramp(pair[1].0))
                .map(|pair| 2.0 * (pair[1].2 - pair[0].2).abs() / (pair[1].1 - pair[0].0))
                .fold(0.0, f64::max);
            exceeded.extend(beyond_limits(described, &limits[axis], [largest, step]));
        }
        exceeded
    }

    /// The same program with the gearbox's share taken off the work's angle, or with `sign` = 1 put back on.
    pub(super) fn geared(&self, gearbox: &Gearbox, sign: f64) -> Self {
        let mut program = self.clone();
        for knot in &mut program.knots {
            knot.axes[1] += sign * gearbox.work_rad(&knot.axes);
        }
        program
    }

    /// Axes of a program that commands only what is added to the gearbox.
    #[must_use]
    #[cfg(feature = "testing")]
    pub fn with_gearbox(&self, gearbox: &Gearbox) -> Self {
        self.geared(gearbox, 1.0)
    }
}
