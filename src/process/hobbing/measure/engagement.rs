//! Which hob teeth do the work: the area of a tooth space in one transverse section, counted for the tooth that removes
//! it first.
//!
//! In: a hobbing linkage that cuts into full stock, hob, pitch curve. Out: [`Engagement`], area per hob tooth. Law: a
//! point of the section is taken by the first pass whose edge holds it at the moment when the rake face goes through
//! it. Only the thread that runs through the space can reach it, so there is one tooth per gash passage.
//!
//! This is a load figure in a plane, from points: it says how the work is shared, not how thick the chips are, and
//! nothing about tool life. It is a forecast for `gearcut axes`, before anything is cut, and takes a second; what the
//! teeth do in the whole process is measured on the cut blank ([`super::hob_load`]). Where both can say it, what share
//! of a full stock's volume each tooth takes, `tests/suite/hobbing/blank.rs` compares them.
//!
//! The point's path in the hob's head is a polynomial in the hob angle through five poses per pass, exact to far below
//! the grid.

use crate::process::hobbing::Hob;
use crate::process::hobbing::linkage::HobbingLinkage;
use crate::process::hobbing::rack_generation::RackGeneration;
use gearcut_core::error::NotConverged;
use gearcut_core::frame::Rigid3;
use gearcut_core::math::convergence::{Step, iterate};
use gearcut_core::tool::{CuttingTool, SpatialTool};
use gearcut_core::units::TURN_RAD;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::ControlFlow;

/// Hob angles at which the pose is taken, from where the rake face looks at the gear, rad.
const NODES_RAD: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];
/// Steps of the rake face's moment that are always made: the point moves in the head with the work, as much slower than
/// the hob as the gear has teeth per start, so that each step leaves so much of what was missing: with thirty, four
/// leave a millionth of a sweep, 0.1 um at the tip.
const STEPS: u32 = 4;
/// Steps go on where the last one was longer, rad: few teeth per start.
const LAST_STEP_RAD: f64 = 1e-4;
/// Steps at most.
const MOST_STEPS: u32 = 60;
/// A place beyond this angle to either side is not in the work, rad: a hob tooth is in it within 60 degrees (1.05,
/// [`SpatialTool::half_window_rad`]), and the rest is for steps that go beyond the moment and come back.
const LARGEST_SWEPT_RAD: f64 = 1.2;

/// Area per tooth.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Engagement {
    /// Area in mm^2 by gash passage of the tooth (see [`crate::process::hobbing::hob::HobTooth::passage`]), negative
    /// towards the entering side.
    pub area_mm2: BTreeMap<i64, f64>,
}

/// One pass of the thread through the section.
struct Pass {
    passage: i64,
    axial_mm: f64,
    /// How far a point of the work can move in the head between the nodes and the middle, generously, mm.
    drift_mm: f64,
    head_from_work: [Rigid3; 5],
    /// The hob's root, mm: nearer to the axis the tooth is taken as thick as there.
    innermost_mm: f64,
}

impl Engagement {
    /// Whole area removed.
    pub fn total_mm2(&self) -> f64 {
        self.area_mm2.values().sum()
    }

    /// Share of a tooth.
    pub fn share(&self, passage: i64) -> f64 {
        self.area_mm2.get(&passage).copied().unwrap_or(0.0) / self.total_mm2()
    }

    /// Tooth that takes the most, and its share.
    #[cfg(feature = "testing")]
    pub fn peak(&self) -> Option<(i64, f64)> {
        let (&passage, _) = self.area_mm2.iter().max_by(|a, b| a.1.total_cmp(b.1))?;
        Some((passage, self.share(passage)))
    }

    /// Adds another space's.
    pub fn add(&mut self, other: &Self) {
        for (&passage, area) in &other.area_mm2 {
            *self.area_mm2.entry(passage).or_default() += area;
        }
    }

    /// Engagement in `space` at the section `z_mm` (gear frame); points stand `spacing_mm` apart from `depth_mm` below
    /// to `addendum_mm` over the pitch curve.
    ///
    /// # Errors
    /// The moment is not found at which a rake face holds a point: the work turns nearly as fast as the hob.
    pub fn of_space(
        linkage: &HobbingLinkage,
        target: &RackGeneration,
        hob: &Hob,
        space: u32,
        z_mm: f64,
        [depth_mm, addendum_mm, spacing_mm]: [f64; 3],
    ) -> Result<Self, NotConverged> {
        let passes = passes(linkage, target, hob, space, z_mm);
        let curve = &target.curve;
        let middle_mm = target.space_arc_mm(i64::from(space), z_mm);
        let half_mm = 0.5 * std::f64::consts::PI * target.rack.transverse_module_mm;
        let columns = (2.0 * half_mm / spacing_mm).ceil() as u32;
        let rows = ((depth_mm + addendum_mm) / spacing_mm).ceil() as u32;
        let (wide, high) = (2.0 * half_mm / f64::from(columns), (depth_mm + addendum_mm) / f64::from(rows));
        let column = |i: u32| {
            let mut counted = Self::default();
            let frame = curve.frame(curve.phi_at_arc(middle_mm - half_mm + wide * (f64::from(i) + 0.5)));
            // Passes that can reach this column at all, still in the order of time.
            let middle = (frame.point_mm + 0.5 * (addendum_mm - depth_mm) * frame.normal).extend(z_mm);
            let near: Vec<&Pass> =
                passes.iter().filter(|p| p.reaches(hob, middle, 0.5 * (depth_mm + addendum_mm))).collect();
            for j in 0..rows {
                let height = -depth_mm + high * (f64::from(j) + 0.5);
                let point = (frame.point_mm + height * frame.normal).extend(z_mm);
                for pass in &near {
                    if pass.takes(hob, linkage.geometry().hob_hand, point)? {
                        let area = wide * high * (1.0 + frame.curvature_per_mm * height);
                        *counted.area_mm2.entry(pass.passage).or_default() += area;
                        break;
                    }
                }
            }
            Ok(counted)
        };
        // Sums in the order of the columns: the same bytes on any number of threads.
        let columns: Vec<Self> = (0..columns).into_par_iter().map(column).collect::<Result<_, _>>()?;
        let mut all = Self::default();
        for counted in &columns {
            all.add(counted);
        }
        Ok(all)
    }
}

/// Passes of the thread that runs through a space, in the order of time, whose tip can reach the section.
fn passes(linkage: &HobbingLinkage, target: &RackGeneration, hob: &Hob, space: u32, z_mm: f64) -> Vec<Pass> {
    let g = linkage.geometry();
    let per_gash = TURN_RAD / f64::from(hob.gashes);
    let teeth =
        (target.curve.perimeter_mm() / (std::f64::consts::PI * target.rack.transverse_module_mm)).round() as i64;
    let (starts, gashes) = (i64::from(hob.starts), i64::from(hob.gashes));
    let [first, last] = [0.0, linkage.end_s()].map(|t| (linkage.axes::<1>(t).hob_rad.value() / per_gash) as i64);
    let innermost_mm = innermost_mm(hob);
    let mut passes = Vec::new();
    for gash in first..=last {
        let t = linkage.time_at_hob_angle(gash as f64 * per_gash);
        let axes = linkage.axes::<1>(t);
        let reach_mm = 0.5 * hob.length_mm * g.head_angle_rad.sin().abs() + hob.tip_radius_mm;
        if (axes.slide_mm.value() + z_mm).abs() > reach_mm {
            continue;
        }
        // The space, counted along the rolled arc, that stands nearest to the pitch point in this cycle.
        let pitch_mm = std::f64::consts::PI * target.rack.transverse_module_mm;
        let arc_mm = axes.arc_mm.value() - target.space_arc_mm(0, z_mm);
        let cycle = ((arc_mm / pitch_mm - f64::from(space)) / teeth as f64).round() as i64;
        let counted = i64::from(space) + cycle * teeth;
        // Thread and turn that run through that space: start = space modulo starts, one turn further for every `starts`
        // spaces.
        let start = counted.rem_euclid(starts);
        let passage = gash - gashes * counted.div_euclid(starts);
        let Some(tooth) = hob.teeth.iter().find(|tooth| i64::from(tooth.start) == start && tooth.passage == passage)
        else {
            continue;
        };
        let head_from_work = NODES_RAD.map(|node| {
            let t = linkage.time_at_hob_angle(gash as f64 * per_gash + node);
            linkage.work_from_head(t).inverse()
        });
        let drift_mm = 2.0 * g.arc_per_hob_rad_mm();
        passes.push(Pass { passage, axial_mm: tooth.axial_mm, drift_mm, head_from_work, innermost_mm });
    }
    passes
}

impl Pass {
    /// Whether the tooth may reach anything within a distance of a point: not behind the hob nor beyond its tip or
    /// flanks by more than the work moves meanwhile.
    fn reaches(&self, hob: &Hob, point: DVec3, around_mm: f64) -> bool {
        let middle = self.head_from_work[2].point(point);
        let margin_mm = self.drift_mm + around_mm;
        (middle.z - self.axial_mm).abs() <= 0.5 * hob.axial_pitch_mm + margin_mm
            && middle.x > -margin_mm
            && middle.truncate().length() <= hob.tip_radius_mm + margin_mm
    }

    /// Whether the edge holds a point of the work when its rake face goes through it.
    fn takes(&self, hob: &Hob, hand: f64, point: DVec3) -> Result<bool, NotConverged> {
        let middle = self.head_from_work[2].point(point);
        if !self.reaches(hob, point, 0.0) {
            return Ok(false);
        }
        let path = divided_differences([0, 1, 2, 3, 4].map(|k| self.head_from_work[k].point(point)));
        let twist = hob.rake_twist_rad_per_mm();
        let mut q = middle;
        let mut steps = 0;
        let moment = iterate("the moment at which a rake face holds a point", 0.0, MOST_STEPS, |before| {
            // The rake face stands at the angle hand * passed, turned by the twist of a helical gash.
            let place = q.y.atan2(q.x) + twist * (q.z - self.axial_mm);
            let passed = hand * place;
            if passed.abs() > LARGEST_SWEPT_RAD {
                return ControlFlow::Break(false);
            }
            q = interpolated(&path, passed);
            steps += 1;
            let residual = passed - before;
            if steps >= STEPS && residual.abs() < LAST_STEP_RAD {
                ControlFlow::Break(true)
            } else {
                ControlFlow::Continue(Step { to: passed, residual })
            }
        });
        let at = DVec2::new(q.truncate().length(), (q.z - self.axial_mm).abs());
        Ok(moment? && at.x < hob.tip_radius_mm && at.y < hob.half_thickness_mm(at.x.max(self.innermost_mm)))
    }
}

/// Smallest distance of the edge from the axis, mm: the root.
fn innermost_mm(hob: &Hob) -> f64 {
    let ends = hob.edges().segments().iter().flat_map(|segment| {
        let place = |y_mm: f64| segment.blade_from_segment.point(DVec2::new(segment.x_and_slope(y_mm)[0], y_mm));
        segment.y_range_mm.map(|y_mm| place(y_mm).x)
    });
    ends.fold(f64::INFINITY, f64::min)
}

/// Divided differences of the path at the nodes: Newton's form of the polynomial through them.
fn divided_differences(mut path: [DVec3; 5]) -> [DVec3; 5] {
    for order in 1..5 {
        for k in (order..5).rev() {
            path[k] = (path[k] - path[k - 1]) / (NODES_RAD[k] - NODES_RAD[k - order]);
        }
    }
    path
}

/// The polynomial at a hob angle.
fn interpolated(differences: &[DVec3; 5], at: f64) -> DVec3 {
    (0..4).rev().fold(differences[4], |sum, k| sum * (at - NODES_RAD[k]) + differences[k])
}
