//! Flanks as chains of points in the frame of their gear.
//!
//! In: points from root to tip, with directions where the flank is smooth. Out: [`FlankChain`] for the driver, points
//! at any place; [`PolarFlank`] for the driven gear, the polar angle about its axis as a function of the radius, in as
//! many runs as it turns back; and [`GearFlanks`], all flanks of a gear by tooth and side.
//!
//! Smooth flanks are cubic between points (errors of some 1e-11 mm at 130 points); cut flanks, which have a kink at
//! every scallop, are straight, so that no crest is rounded off and none is invented.

use std::f64::consts::TAU;

use glam::DVec2;

use super::pitch_pair::{ConjugatePoint, Member, PitchPair};
use gearcut_core::error::Refusal;
use gearcut_core::terms::Side;

/// Intervals of a nominal flank.
const INTERVALS: usize = 128;
/// How far nominal flanks go on beyond the deepest contact with the mate's tip, modules along the line of action: tips
/// of flanks with errors reach deeper.
pub const BEYOND_MODULES: f64 = 0.2;
/// Share of the radius of curvature that must be left where a flank ends: at zero it turns back.
const LEAST_CURVATURE_MARGIN: f64 = 0.02;

/// A flank from root to tip.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankChain {
    /// Points, mm.
    pub points_mm: Vec<DVec2>,
    /// Unit tangents towards the tip; none on a flank with kinks.
    tangents: Option<Vec<DVec2>>,
    /// Circle round all points.
    center_mm: DVec2,
    reach_mm: f64,
}

impl FlankChain {
    /// Chain through points from root to tip, straight between them.
    pub fn straight(points_mm: Vec<DVec2>) -> Self {
        Self::new(points_mm, None)
    }

    /// Smooth chain through points of a flank from root to tip.
    pub fn smooth(points: &[ConjugatePoint]) -> Self {
        let places: Vec<DVec2> = points.iter().map(|p| p.point_mm).collect();
        let chord = |i: usize| places[(i + 1).min(places.len() - 1)] - places[i.saturating_sub(1)];
        let tangents = points.iter().enumerate().map(|(i, p)| p.normal.perp() * p.normal.perp().dot(chord(i)).signum());
        let tangents = tangents.collect();
        Self::new(places, Some(tangents))
    }

    fn new(points_mm: Vec<DVec2>, tangents: Option<Vec<DVec2>>) -> Self {
        let center_mm = points_mm[points_mm.len() / 2];
        let reach_mm = points_mm.iter().map(|p| p.distance(center_mm)).fold(0.0, f64::max);
        Self { points_mm, tangents, center_mm, reach_mm }
    }

    /// The chain moved by a vector.
    #[must_use]
    pub fn moved(&self, by_mm: DVec2) -> Self {
        Self::new(self.points_mm.iter().map(|p| *p + by_mm).collect(), self.tangents.clone())
    }

    /// The chain turned about the axis of its gear.
    #[must_use]
    pub fn turned(&self, angle_rad: f64) -> Self {
        let turn = DVec2::from_angle(angle_rad);
        let turned = |vectors: &[DVec2]| vectors.iter().map(|v| turn.rotate(*v)).collect();
        Self::new(turned(&self.points_mm), self.tangents.as_deref().map(turned))
    }

    /// Whether the chain is smooth between its points.
    pub fn is_smooth(&self) -> bool {
        self.tangents.is_some()
    }

    /// Number of the last point: places go from 0 to this.
    pub fn last(&self) -> f64 {
        (self.points_mm.len() - 1) as f64
    }

    /// Point at a place from 0 (root) to [`Self::last`] (tip).
    pub fn at(&self, place: f64) -> DVec2 {
        let i = (place as usize).min(self.points_mm.len() - 2);
        let x = place - i as f64;
        let (a, b) = (self.points_mm[i], self.points_mm[i + 1]);
        let Some(tangents) = &self.tangents else { return a.lerp(b, x) };
        let length = a.distance(b);
        let (ta, tb) = (tangents[i] * length, tangents[i + 1] * length);
        let y = 1.0 - x;
        // Hermite's cubic.
        a * (y * y * (1.0 + 2.0 * x)) + ta * (x * y * y) + b * (x * x * (3.0 - 2.0 * x)) - tb * (x * x * y)
    }

    /// Interval that holds the distances of all points of the chain from a place.
    pub fn distances_mm(&self, from_mm: DVec2) -> [f64; 2] {
        let d = self.center_mm.distance(from_mm);
        [d - self.reach_mm, d + self.reach_mm]
    }
}

/// A flank of the driven gear as polar angle over radius about its axis.
///
/// Most flanks are one run. A gear that sits off its axis, or a fillet that has cut into a flank, makes a flank turn
/// back in its distance from the axis; it then has several runs, and whatever stands farthest out touches.
#[derive(Debug, Clone, PartialEq)]
pub struct PolarFlank {
    /// Stretches along which the distance from the axis changes steadily, from root to tip.
    pub runs: Vec<PolarRun>,
    /// Points of the chain that it was made from.
    pub points: usize,
}

/// A stretch of a flank along which the distance from the axis changes steadily.
#[derive(Debug, Clone, PartialEq)]
pub struct PolarRun {
    /// Radii, increasing, mm.
    pub radii_mm: Vec<f64>,
    angles_rad: Vec<f64>,
    /// The same as unit vectors.
    directions: Vec<DVec2>,
    /// dpsi/drho, rad per mm; none on a flank with kinks.
    slopes: Option<Vec<f64>>,
    /// Number, along the chain, of the point with the smallest radius.
    first: usize,
    /// Whether the numbers of the chain grow with the radius; on a ring they fall.
    outward: bool,
}

impl PolarFlank {
    /// From a chain about the origin.
    pub fn new(chain: &FlankChain) -> Self {
        let points = chain.points_mm.len();
        let radius = |i: usize| chain.points_mm[i].length();
        let grows = |i: usize| radius(i + 1).total_cmp(&radius(i));
        let mut runs = Vec::new();
        let mut from = 0;
        for i in 1..points {
            if i + 1 < points && grows(i) == grows(from) {
                continue;
            }
            if grows(from).is_ne() {
                runs.push([from, i]);
            }
            from = i;
        }
        // At the place where a flank turns back its angle has no slope: such a flank is straight between its points.
        let tangents = chain.tangents.as_deref().filter(|_| runs.len() == 1);
        let runs = runs.into_iter().map(|ends| PolarRun::new(&chain.points_mm, tangents, ends)).collect();
        Self { runs, points }
    }
}

impl PolarRun {
    fn new(points_mm: &[DVec2], tangents: Option<&[DVec2]>, [from, to]: [usize; 2]) -> Self {
        let outward = points_mm[to].length() > points_mm[from].length();
        let order: Vec<usize> = if outward { (from..=to).collect() } else { (from..=to).rev().collect() };
        let radii_mm: Vec<f64> = order.iter().map(|&i| points_mm[i].length()).collect();
        let mut angles_rad: Vec<f64> = order.iter().map(|&i| points_mm[i].to_angle()).collect();
        for i in 1..angles_rad.len() {
            angles_rad[i] -= TAU * ((angles_rad[i] - angles_rad[i - 1]) / TAU).round();
        }
        let slope = |p: DVec2, t: DVec2| p.perp_dot(t) / (p.length() * p.dot(t));
        let slopes = tangents.map(|tangents| order.iter().map(|&i| slope(points_mm[i], tangents[i])).collect());
        let directions = order.iter().map(|&i| points_mm[i].normalize()).collect();
        Self { radii_mm, angles_rad, directions, slopes, first: order[0], outward }
    }

    /// Number of the first radius beyond a given one, walking there from `near`.
    pub fn first_beyond(&self, near: usize, radius_mm: f64) -> usize {
        let mut k = near;
        while k > 0 && self.radii_mm[k - 1] > radius_mm {
            k -= 1;
        }
        while k < self.radii_mm.len() && self.radii_mm[k] <= radius_mm {
            k += 1;
        }
        k
    }

    /// Polar angle at a radius before which the radius number `beyond` is the first larger one, and the number of a
    /// radius beside it; none beyond the ends.
    pub fn angle_before(&self, beyond: usize, radius_mm: f64) -> Option<(usize, f64)> {
        let last = self.radii_mm.len() - 1;
        if beyond == 0 || (beyond > last && radius_mm > self.radii_mm[last]) {
            return None;
        }
        let index = beyond.min(last) - 1;
        Some((index, self.angle_in(index, radius_mm)))
    }

    /// Direction of the point with the radius number `index` from the axis.
    pub fn direction(&self, index: usize) -> DVec2 {
        self.directions[index]
    }

    /// Polar angle of the point with the radius number `index`.
    pub fn angle_of_point(&self, index: usize) -> f64 {
        self.angles_rad[index]
    }

    /// Number, along the chain that it was made from, of the point with the radius number `index`.
    pub fn chain_point(&self, index: usize) -> usize {
        if self.outward { self.first + index } else { self.first - index }
    }

    /// Place along that chain at a radius, held within its ends.
    pub fn chain_place(&self, radius_mm: f64) -> f64 {
        let last = self.radii_mm.len() - 1;
        let i = self.radii_mm.partition_point(|r| *r <= radius_mm).clamp(1, last) - 1;
        let share = (radius_mm - self.radii_mm[i]) / (self.radii_mm[i + 1] - self.radii_mm[i]);
        let along = i as f64 + share.clamp(0.0, 1.0);
        if self.outward { self.first as f64 + along } else { self.first as f64 - along }
    }

    /// Smallest and largest radius, mm.
    pub fn range_mm(&self) -> [f64; 2] {
        [self.radii_mm[0], self.radii_mm[self.radii_mm.len() - 1]]
    }

    /// Polar angle at a radius; none beyond the ends.
    pub fn angle_rad(&self, radius_mm: f64) -> Option<f64> {
        let [low, high] = self.range_mm();
        if !(low..=high).contains(&radius_mm) {
            return None;
        }
        let i = self.radii_mm.partition_point(|r| *r <= radius_mm).clamp(1, self.radii_mm.len() - 1) - 1;
        Some(self.angle_in(i, radius_mm))
    }

    /// Polar angle at a radius in the interval from the point number `i` on.
    fn angle_in(&self, i: usize, radius_mm: f64) -> f64 {
        let width = self.radii_mm[i + 1] - self.radii_mm[i];
        let x = (radius_mm - self.radii_mm[i]) / width;
        let (a, b) = (self.angles_rad[i], self.angles_rad[i + 1]);
        let Some(slopes) = &self.slopes else { return a + x * (b - a) };
        let y = 1.0 - x;
        let bend = width * x * y * (slopes[i] * y - slopes[i + 1] * x);
        a * (y * y * (1.0 + 2.0 * x)) + b * (x * x * (3.0 - 2.0 * x)) + bend
    }
}

/// All flanks of a gear: by side, and by the label of the driver's tooth that they belong to or touch, modulo the
/// number of teeth.
#[derive(Debug, Clone, PartialEq)]
pub struct GearFlanks<F> {
    /// Flanks labelled 0 to z - 1.
    pub right: Vec<F>,
    /// Flanks labelled 0 to z - 1.
    pub left: Vec<F>,
}

impl<F> GearFlanks<F> {
    /// The flank with an unwrapped label.
    pub fn get(&self, side: Side, label: i64) -> &F {
        let flanks = match side {
            Side::Right => &self.right,
            Side::Left => &self.left,
        };
        &flanks[label.rem_euclid(flanks.len() as i64) as usize]
    }

    /// From a function of side and label 0 to `teeth` - 1.
    ///
    /// # Errors
    /// The function's.
    pub fn build<E>(teeth: u32, flank: impl Fn(Side, i64) -> Result<F, E>) -> Result<Self, E> {
        let side = |side: Side| (0..i64::from(teeth)).map(|label| flank(side, label)).collect::<Result<_, E>>();
        Ok(Self { right: side(Side::Right)?, left: side(Side::Left)? })
    }

    /// The same, to be written to.
    pub fn get_mut(&mut self, side: Side, label: i64) -> &mut F {
        let flanks = match side {
            Side::Right => &mut self.right,
            Side::Left => &mut self.left,
        };
        let count = flanks.len() as i64;
        &mut flanks[label.rem_euclid(count) as usize]
    }

    /// Something of every flank.
    pub fn each<G>(&self, of: impl Fn(&F) -> G) -> GearFlanks<G> {
        GearFlanks { right: self.right.iter().map(&of).collect(), left: self.left.iter().map(&of).collect() }
    }

    /// Puts the flanks of another gear with as many teeth to these, one by one.
    pub fn combine(&mut self, other: &Self, with: impl Fn(&mut F, &F)) {
        let both = self.right.iter_mut().zip(&other.right).chain(self.left.iter_mut().zip(&other.left));
        both.for_each(|(own, other)| with(own, other));
    }

    /// Every flank turned into something else.
    ///
    /// # Errors
    /// The function's.
    pub fn map<G, E>(&self, turn: impl Fn(&F) -> Result<G, E>) -> Result<GearFlanks<G>, E> {
        let side = |flanks: &[F]| flanks.iter().map(&turn).collect::<Result<_, E>>();
        Ok(GearFlanks { right: side(&self.right)?, left: side(&self.left)? })
    }
}

/// Nominal flanks of a gear of the pair, from the depth that the mate's tips ask for up to the tips.
///
/// `addendum_mm` are the tip heights of driver and driven gear over their pitch curves; `extra_mm` tells how much
/// material a flank carries beyond the nominal one (thinning by T is -T cos(alpha) / 2 on every flank). All points move
/// along their normals by it, the tip corner too, as heights of dexels do.
///
/// # Errors
/// Tips that the flanks do not reach.
pub fn nominal(
    pair: &PitchPair,
    member: Member,
    addendum_mm: [f64; 2],
    extra_mm: impl Fn(Side, i64) -> f64,
) -> Result<GearFlanks<FlankChain>, Refusal> {
    nominal_section(pair, member, addendum_mm, 0.0, extra_mm)
}

/// The same in a section of a helical pair in which all teeth stand `shift_mm` further along the driver's pitch curve.
///
/// # Errors
/// Tips that the flanks do not reach.
pub fn nominal_section(
    pair: &PitchPair,
    member: Member,
    addendum_mm: [f64; 2],
    shift_mm: f64,
    extra_mm: impl Fn(Side, i64) -> f64,
) -> Result<GearFlanks<FlankChain>, Refusal> {
    let (own, other, mate) = match member {
        Member::Driver => (addendum_mm[0], addendum_mm[1], Member::Driven),
        Member::Driven => (addendum_mm[1], addendum_mm[0], Member::Driver),
    };
    let teeth = match member {
        Member::Driver => pair.teeth().count[0],
        Member::Driven => pair.teeth().count[1],
    };
    let cos = pair.teeth().pressure_angle_rad.cos();
    GearFlanks::build(teeth, |side, label| {
        let crossing_mm = pair.crossing_mm(side, label) + shift_mm;
        let extra_mm = extra_mm(side, label);
        let arc = |phi: f64| pair.curve().arc_mm(phi);
        let tip_mm = arc(pair.phi_at_tip(member, side, crossing_mm, own)?);
        let deepest_mm = arc(pair.phi_at_tip(mate, side, crossing_mm, other)?);
        let root_mm = deepest_mm + (deepest_mm - tip_mm).signum() * BEYOND_MODULES * pair.teeth().module_mm / cos;
        let sound = |s: &f64| {
            let depth_mm = (crossing_mm - s) * cos * (tip_mm - root_mm).signum();
            pair.curvature_margin(member, pair.curve().phi_at_arc(*s), depth_mm) > LEAST_CURVATURE_MARGIN
        };
        let place = |i: usize| tip_mm + (root_mm - tip_mm) * i as f64 / INTERVALS as f64;
        let arcs_mm: Vec<f64> = (0..=INTERVALS).map(place).take_while(sound).collect();
        let point = |s: &f64| {
            let on = pair.flank_point(member, side, crossing_mm, pair.curve().phi_at_arc(*s));
            ConjugatePoint { point_mm: on.point_mm + extra_mm * on.normal, ..on }
        };
        let points: Vec<ConjugatePoint> = arcs_mm.iter().rev().map(point).collect();
        Ok(FlankChain::smooth(&points))
    })
}
