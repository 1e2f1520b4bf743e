//! Where a flank of the driver touches one of the driven gear.
//!
//! In: both flanks and how the gears stand. Out: the rotation of the driven gear at which they touch, and where.
//!
//! Law: a point of the driver's flank at the distance rho from the driven axis meets the point of the driven flank at
//! the same radius, after a rotation that is the difference of their polar angles. The right flanks push, so the gears
//! touch at the largest of these rotations; at the left flanks it is the smallest. Ends of the chains belong to the
//! search, so tip corners that touch beside the path of contact are found like everything else.
//!
//! The largest value is looked for at every point of both chains; an angle is computed only where a sine shows that the
//! point may ask for more than those before. Between straight pieces that is all there is (to the sag of a chord); on
//! smooth flanks a golden-section search goes on from the best point to rounding. No iteration can miss: it starts from
//! a value that is attained and never leaves it for a smaller one.
//!
//! Road not taken: solving for equal normals. It needs curvature, fails at corners and on scallops, and finds any
//! stationary point.

use std::f64::consts::TAU;

use glam::DVec2;

use super::flank_chain::{FlankChain, PolarFlank, PolarRun};
use gearcut_core::math::extremum::maximum;
use gearcut_core::math::roots::halve;
use gearcut_core::terms::Side;

/// Halvings of an interval towards the place where the driven flank ends in it.
const END_HALVINGS: u32 = 50;
/// A place this near to the end of a chain counts as the end, intervals.
const END_INTERVALS: f64 = 1e-5;

/// How the two gears stand to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairPose {
    /// The driver is turned by minus this.
    pub phi_1_rad: f64,
    /// The driven gear's axis in the machine, mm; the driver's is the origin.
    pub axis_2_mm: DVec2,
    /// Nominal rotation of the driven gear, counted in its own direction of turning.
    pub phi_2_rad: f64,
    /// +1 where that direction is counter-clockwise (external), -1 else.
    pub sign: f64,
}

/// What touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum TouchKind {
    /// Flank on flank.
    Inner,
    /// The driver's tip corner on the driven flank.
    DriverTip,
    /// The driven gear's tip corner on the driver's flank.
    DrivenTip,
    /// The lower end of the driver's flank.
    DriverRoot,
    /// The lower end of the driven flank.
    DrivenRoot,
}

impl TouchKind {
    /// As in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inner => "flank",
            Self::DriverTip => "tip of A",
            Self::DrivenTip => "tip of B",
            Self::DriverRoot => "lower end of A",
            Self::DrivenRoot => "lower end of B",
        }
    }
}

/// A touch of two flanks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Rotation of the driven gear beyond the nominal one, rad.
    pub error_rad: f64,
    /// What touches.
    pub kind: TouchKind,
    /// Where, machine frame, mm.
    pub point_mm: DVec2,
    /// Place along the driver's chain.
    pub driver_place: f64,
    /// Place along the driven gear's chain.
    pub driven_place: f64,
}

/// A point of one chain against the flank opposite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probe {
    /// Place along the driver's chain.
    pub place: f64,
    /// Number of the driven chain's point, if it is one of those.
    pub driven_point: Option<usize>,
    /// Rotation that the point asks for, counted in the direction in which this side pushes, rad.
    pub push_rad: f64,
}

/// Difference of two angles within half a turn.
fn wrapped(angle_rad: f64) -> f64 {
    angle_rad - TAU * (angle_rad / TAU).round()
}

/// Points of the driver that are asked first: the nearer the best of them comes, the fewer angles are computed.
const FIRST_ASKED: usize = 16;
/// x is at most sin x + this sin^3 x up to a right angle, where both are equal: pi / 2 - 1.
const SINE_CUBED: f64 = std::f64::consts::FRAC_PI_2 - 1.0;
/// More than rounding of sines and angles.
const ROUNDING_RAD: f64 = 1e-12;
/// Down to this value, points that ask for half a turn more show a negative cosine.
const LEAST_COMPARED_RAD: f64 = -1.0;

/// A point of either chain and what the driven flank has at its radius.
struct Opposite {
    /// Place along the driver's chain.
    place: f64,
    /// Number of the driven chain's point, if it is one of those.
    driven_point: Option<usize>,
    point_mm: DVec2,
    radius_mm: f64,
    /// Polar angle of the driven flank there, and number of the radius beside it.
    angle_rad: f64,
    beside: usize,
}

/// One flank of each gear, and how they stand.
struct Facing<'a> {
    driver: &'a FlankChain,
    driven: &'a PolarRun,
    stand: &'a PairPose,
    /// The driven axis as the driver sees it: its points need not be turned one by one.
    axis_mm: DVec2,
    pushing: f64,
}

impl<'a> Facing<'a> {
    /// None where the distances of both flanks from the driven axis have nothing in common.
    fn new(driver: &'a FlankChain, driven: &'a PolarRun, stand: &'a PairPose, side: Side) -> Option<Self> {
        let axis_mm = DVec2::from_angle(stand.phi_1_rad).rotate(stand.axis_2_mm);
        let [low, high] = driven.range_mm();
        let [nearest, farthest] = driver.distances_mm(axis_mm);
        (farthest >= low && nearest <= high).then_some(Self { driver, driven, stand, axis_mm, pushing: -side.sign() })
    }

    /// What a point of the driver asks for; larger is where the gears touch first.
    fn push_rad(&self, point_mm: DVec2) -> Option<f64> {
        Some(self.push_at(point_mm, self.driven.angle_rad(point_mm.distance(self.axis_mm))?))
    }

    /// Turns the direction of a point, as seen from that of the driven flank beside it, into the rotation that it asks
    /// for beyond `value`.
    fn beyond(&self, value: f64) -> DVec2 {
        let Self { stand, pushing, .. } = self;
        DVec2::from_angle(-pushing * (stand.sign * stand.phi_1_rad + stand.phi_2_rad) - value)
    }

    /// Whether a point may ask for more than the value that `beyond` was made for.
    fn may_exceed(&self, beyond: DVec2, at: &Opposite) -> bool {
        let way = self.pushing * self.stand.sign;
        let (from_axis_mm, own) = (at.point_mm - self.axis_mm, self.driven.direction(at.beside));
        let turned = beyond.rotate(DVec2::new(own.dot(from_axis_mm), way * own.perp_dot(from_axis_mm)));
        let sine = turned.y / at.radius_mm;
        let most_rad = sine + SINE_CUBED * sine.max(0.0).powi(3);
        let apart_rad = way * (at.angle_rad - self.driven.angle_of_point(at.beside));
        turned.x <= 0.0 || most_rad + ROUNDING_RAD >= apart_rad
    }

    /// The same where the driven flank's angle there is known.
    fn push_at(&self, point_mm: DVec2, angle_rad: f64) -> f64 {
        let d = point_mm - self.axis_mm;
        let error = self.stand.sign * (d.to_angle() - self.stand.phi_1_rad - angle_rad) - self.stand.phi_2_rad;
        self.pushing * wrapped(error)
    }

    /// Every point of either chain that has something opposite. Both chains are walked side by side: the cost is the
    /// number of their points.
    fn visit(&self, mut visit: impl FnMut(Opposite)) {
        let (driver, driven) = (self.driver, self.driven);
        let radii = &driven.radii_mm;
        let mut radius = driver.points_mm[0].distance(self.axis_mm);
        // Number of the first driven radius beyond that of the driver's point.
        let mut beyond = 0;
        for (i, &point_mm) in driver.points_mm.iter().enumerate() {
            beyond = driven.first_beyond(beyond, radius);
            if let Some((beside, angle_rad)) = driven.angle_before(beyond, radius) {
                let place = i as f64;
                visit(Opposite { place, driven_point: None, point_mm, radius_mm: radius, angle_rad, beside });
            }
            let Some(next) = driver.points_mm.get(i + 1).map(|point| point.distance(self.axis_mm)) else { break };
            let mut offer = |k: usize| {
                let place = i as f64 + (radii[k] - radius) / (next - radius);
                visit(Opposite {
                    place,
                    driven_point: Some(driven.chain_point(k)),
                    point_mm: driver.at(place),
                    radius_mm: radii[k],
                    angle_rad: driven.angle_of_point(k),
                    beside: k,
                });
            };
            if next > radius {
                (beyond..radii.len()).take_while(|&k| radii[k] < next).for_each(&mut offer);
            } else {
                let between = (0..beyond).rev().take_while(|&k| radii[k] > next);
                between.filter(|&k| radii[k] < radius).for_each(&mut offer);
            }
            radius = next;
        }
    }
}

/// Shows every point of either flank that has the other one opposite.
pub fn probes(driver: &FlankChain, driven: &PolarFlank, stand: &PairPose, side: Side, mut visit: impl FnMut(Probe)) {
    for run in &driven.runs {
        if let Some(facing) = Facing::new(driver, run, stand, side) {
            facing.visit(|Opposite { place, driven_point, point_mm, angle_rad, .. }| {
                visit(Probe { place, driven_point, push_rad: facing.push_at(point_mm, angle_rad) });
            });
        }
    }
}

/// The rotation at which a flank of the driver touches one of the driven gear; none where their distances from the
/// driven axis have nothing in common.
pub fn touch(driver: &FlankChain, driven: &PolarFlank, stand: &PairPose, side: Side) -> Option<Touch> {
    let on_run = |run: &PolarRun| first_on(&Facing::new(driver, run, stand, side)?);
    let touches = driven.runs.iter().filter_map(on_run);
    let [value, place, driven_place] = touches.max_by(|a, b| a[0].total_cmp(&b[0]))?;
    let ends_at = |place: f64, last: f64| [place <= END_INTERVALS, place >= last - END_INTERVALS];
    let kind = match (ends_at(place, driver.last()), ends_at(driven_place, (driven.points - 1) as f64)) {
        ([_, true], _) => TouchKind::DriverTip,
        ([true, _], _) => TouchKind::DriverRoot,
        (_, [_, true]) => TouchKind::DrivenTip,
        (_, [true, _]) => TouchKind::DrivenRoot,
        _ => TouchKind::Inner,
    };
    let point_mm = DVec2::from_angle(-stand.phi_1_rad).rotate(driver.at(place));
    Some(Touch { error_rad: -side.sign() * value, kind, point_mm, driver_place: place, driven_place })
}

/// What a run of the driven flank asks for, and the places of the touch along the driver's chain and its own.
fn first_on(facing: &Facing) -> Option<[f64; 3]> {
    let Facing { driver, driven, .. } = facing;
    let mut best = (f64::NEG_INFINITY, 0.0);
    for first in 0..=FIRST_ASKED {
        let place = (driver.last() * first as f64 / FIRST_ASKED as f64).floor();
        let value = facing.push_rad(driver.at(place)).unwrap_or(f64::NEG_INFINITY);
        if value > best.0 {
            best = (value, place);
        }
    }
    let mut beyond = facing.beyond(best.0);
    facing.visit(|at| {
        if best.0 < LEAST_COMPARED_RAD || facing.may_exceed(beyond, &at) {
            let value = facing.push_at(at.point_mm, at.angle_rad);
            if value > best.0 {
                best = (value, at.place);
                beyond = facing.beyond(value);
            }
        }
    });
    let (mut value, mut place) = best;
    if value == f64::NEG_INFINITY {
        return None;
    }
    if driver.is_smooth() {
        (value, place) = climbed(&|place| facing.push_rad(driver.at(place)), value, place, driver.last());
    }
    Some([value, place, driven.chain_place(driver.at(place).distance(facing.axis_mm))])
}

/// Goes on from an attained value to the largest one within an interval of the chain on either side.
fn climbed(push: &dyn Fn(f64) -> Option<f64>, value: f64, place: f64, last: f64) -> (f64, f64) {
    // Where the driven flank ends within the interval, its end is the end of the search, and a candidate.
    let end = |outside: f64| {
        if push(outside).is_some() {
            return outside;
        }
        halve(|at| push(at).is_some(), place, outside, END_HALVINGS)[0]
    };
    let ends = [end((place - 1.0).max(0.0)), end((place + 1.0).min(last))];
    let at = |place: f64| push(place).unwrap_or(f64::NEG_INFINITY);
    // Both ends are candidates, and the middle between them; what was attained before is never left for less.
    let (found, highest) = maximum(at, ends[0], ends[1], 2);
    if highest > value { (highest, found) } else { (value, place) }
}
