//! The place of a flank on whose normal a point lies.
//!
//! In: a gear, points in its frame. Out: [`Foot`]s. The nearest of few places on each flank begins the search; Newton's
//! method ends it on the target itself, whose derivatives are differences over a micrometre of profile and ten along
//! the tooth. Between two flanks that both have the point on a normal, the one from which it deviates less has it.
//! Points that are centres of a probe's ball are its radius away from the flank that it touches: p = o + (R + h) n.

use super::probed::ProbedPoint;
use crate::influence::gear_grid::{FlankGrid, evenly};
use crate::influence::measured::refuse_tooth;
use crate::job::{GearJob, RAY_DEPTH_MODULES};
use crate::steps::flanks_of;
use gearcut_core::dexel::Ray;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Places along profile and tooth of a flank from which the search begins.
const NET: [usize; 2] = [17, 9];
/// Half the distance over which derivatives are taken, along profile and tooth, mm.
const HALF_STEP_MM: [f64; 2] = [1e-3, 1e-2];
/// A place is found when it moves by less, mm.
const FOUND_MM: f64 = 1e-8;
/// A point this far beyond the end of a flank still lies on it, mm: digits of files.
const END_MM: f64 = 1e-5;
/// Most steps of Newton's method.
const MOST_STEPS: usize = 12;

/// Where a point lies on a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Which of its flanks.
    pub side: Side,
    /// Arc from the form point, mm.
    pub u_mm: f64,
    /// Place along the tooth from the middle of the face, mm.
    pub v_mm: f64,
    /// Distance from the target along its normal, mm, positive outside of the material, without the probe's ball.
    pub height_mm: f64,
    /// The normal.
    pub normal: DVec3,
}

/// Flanks of a gear among which feet are looked for.
pub struct TargetFlanks<'a> {
    gear: &'a dyn GearJob,
    flanks: Vec<FlankNet>,
    /// How far a point may deviate from its flank, mm.
    reach_mm: f64,
    /// Radius of the ball whose centres the points are, mm; 0 of points of the surface.
    probe_radius_mm: f64,
}

/// A flank with the ball that its net lies in.
struct FlankNet {
    grid: FlankGrid,
    centre_mm: DVec3,
    radius_mm: f64,
}

/// The place of a net that is nearest to a point.
#[derive(Clone, Copy)]
struct NearestPlace<'a> {
    grid: &'a FlankGrid,
    place: usize,
    distance_mm: f64,
}

impl FlankNet {
    fn new(grid: FlankGrid) -> Self {
        let centre_mm = grid.rays.iter().map(|ray| ray.origin_mm).sum::<DVec3>() / grid.rays.len() as f64;
        let radius_mm = grid.rays.iter().map(|ray| ray.origin_mm.distance(centre_mm)).fold(0.0, f64::max);
        Self { grid, centre_mm, radius_mm }
    }
}

impl<'a> TargetFlanks<'a> {
    /// All flanks of a gear.
    ///
    /// # Errors
    /// The tool generates no flank somewhere.
    pub fn new(gear: &'a dyn GearJob, probe_radius_mm: f64) -> Result<Self> {
        let half_mm = 0.5 * gear.scene().gear.face_width_mm;
        let net = |(tooth, side): (u32, Side)| {
            let arcs_mm = evenly([0.0, gear.profile_length_mm(tooth, side)?], NET[0]);
            FlankGrid::new(gear, tooth, side, arcs_mm, evenly([-half_mm, half_mm], NET[1])).map(FlankNet::new)
        };
        let flanks = flanks_of(gear).into_par_iter().map(net).collect::<Result<_>>()?;
        Ok(Self { gear, flanks, reach_mm: RAY_DEPTH_MODULES * gear.scene().gear.module_mm, probe_radius_mm })
    }

    /// How far a point may deviate from its flank, mm.
    pub fn reach_mm(&self) -> f64 {
        self.reach_mm
    }

    /// Flanks that a point may belong to.
    fn of(&self, flank: Option<(u32, Side)>) -> impl Iterator<Item = &FlankNet> {
        self.flanks.iter().filter(move |net| flank.is_none_or(|of| of == (net.grid.tooth, net.grid.side)))
    }

    /// Refuses flanks that the gear does not have.
    ///
    /// # Errors
    /// A point says that it lies on one.
    pub fn refuse_unknown(&self, points: &[ProbedPoint]) -> Result<()> {
        let unknown = points.iter().filter_map(|point| point.flank).find(|&of| self.of(Some(of)).next().is_none());
        unknown.map_or(Ok(()), |(tooth, _)| refuse_tooth(self.gear, tooth))
    }

    /// Nearest places of the two nearest flanks among those that a point may belong to, the nearest first.
    fn nearest(&self, place_mm: DVec3, flank: Option<(u32, Side)>) -> [Option<NearestPlace<'_>>; 2] {
        let mut best: [Option<NearestPlace<'_>>; 2] = [None; 2];
        for net in self.of(flank) {
            let second_mm = best[1].map_or(f64::INFINITY, |other| other.distance_mm);
            if net.centre_mm.distance(place_mm) - net.radius_mm >= second_mm {
                continue;
            }
            let squares = net.grid.rays.iter().map(|ray| ray.origin_mm.distance_squared(place_mm)).enumerate();
            let (place, square) = squares.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, f64::INFINITY));
            let found = NearestPlace { grid: &net.grid, place, distance_mm: square.sqrt() };
            if best[0].is_none_or(|other| found.distance_mm < other.distance_mm) {
                best = [Some(found), best[0]];
            } else if found.distance_mm < second_mm {
                best[1] = Some(found);
            }
        }
        best
    }

    /// How far a point deviates about from the flanks that it may belong to, mm, [`Self::reach_mm`] at most: along the
    /// normals of the nearest places of the net.
    pub fn deviation_mm(&self, place_mm: DVec3, flank: Option<(u32, Side)>) -> f64 {
        let from = |NearestPlace { grid, place, .. }: NearestPlace<'_>| {
            let Ray { origin_mm, normal } = grid.rays[place];
            ((place_mm - origin_mm).dot(normal) - self.probe_radius_mm).abs()
        };
        self.nearest(place_mm, flank).into_iter().flatten().map(from).fold(self.reach_mm, f64::min)
    }

    /// The foot of a point; none where it lies on no flank that it may belong to.
    ///
    /// # Errors
    /// The tool generates no flank there.
    pub fn foot(&self, place_mm: DVec3, flank: Option<(u32, Side)>) -> Result<Option<Foot>> {
        let mut found: Option<Foot> = None;
        for NearestPlace { grid, place, .. } in self.nearest(place_mm, flank).into_iter().flatten() {
            let [column, row] = [place / grid.faces_mm.len(), place % grid.faces_mm.len()];
            let begin = DVec2::new(grid.arcs_mm[column], grid.faces_mm[row]);
            if let Some(foot) = self.foot_on(grid, place_mm, begin)?
                && found.is_none_or(|other| foot.height_mm.abs() < other.height_mm.abs())
            {
                found = Some(foot);
            }
        }
        Ok(found)
    }

    /// The foot of a point on one flank, looked for from a place (u, v) on.
    fn foot_on(&self, grid: &FlankGrid, place_mm: DVec3, begin: DVec2) -> Result<Option<Foot>> {
        let (tooth, side) = (grid.tooth, grid.side);
        let ends = [
            DVec2::new(grid.arcs_mm[0], grid.faces_mm[0]),
            DVec2::new(grid.arcs_mm[NET[0] - 1], grid.faces_mm[NET[1] - 1]),
        ];
        let half = DVec2::from_array(HALF_STEP_MM).min(0.25 * (ends[1] - ends[0]));
        let mut at = begin;
        for _ in 0..MOST_STEPS {
            // Derivatives are taken inside of the flank.
            let centre = at.clamp(ends[0] + half, ends[1] - half);
            let arcs_mm = [centre.x - half.x, centre.x, centre.x + half.x];
            let faces_mm = [centre.y - half.y, centre.y, centre.y + half.y];
            let rays = self.gear.target_points(tooth, side, &arcs_mm, &faces_mm)?;
            let middle = rays[1][1];
            let off_mm = (place_mm - middle.origin_mm).dot(middle.normal);
            // Of the place on the normal, so far off.
            let along_u = (rays[1][2].at(off_mm) - rays[1][0].at(off_mm)) / (2.0 * half.x);
            let along_v = (rays[2][1].at(off_mm) - rays[0][1].at(off_mm)) / (2.0 * half.y);
            let rest = place_mm - middle.at(off_mm);
            let height_mm = off_mm - self.probe_radius_mm;
            let [uu, uv, vv] = [along_u.length_squared(), along_u.dot(along_v), along_v.length_squared()];
            let [bu, bv] = [along_u.dot(rest), along_v.dot(rest)];
            let determinant = uu * vv - uv * uv;
            let next = centre + DVec2::new(bu * vv - bv * uv, bv * uu - bu * uv) / determinant;
            if !next.is_finite() || height_mm.abs() > 4.0 * self.reach_mm {
                return Ok(None);
            }
            if next.distance(at) < FOUND_MM {
                let beyond = (ends[0] - next).max(next - ends[1]).max_element();
                let found = Foot { tooth, side, u_mm: next.x, v_mm: next.y, height_mm, normal: middle.normal };
                return Ok((beyond <= END_MM && height_mm.abs() <= self.reach_mm).then_some(found));
            }
            at = next.clamp(ends[0] - 10.0 * half, ends[1] + 10.0 * half);
        }
        Ok(None)
    }
}
