//! Where the parallel rays of a family cross a closed curve.
//!
//! In: a [`ClosedCurve`] in pieces that hardly turn; the rays of one family. Out: for every ray the crossings, with the
//! curve's normal and its sense, so that what lies inside follows from the winding number.
//!
//! A piece whose tangent turns through the rays' direction is split there. Every part is then monotone across the rays,
//! and a ray between its two ends crosses it exactly once: no root is searched for where there is none, and none is
//! missed, however a ray grazes the curve. Parts own their lower end and not their upper one, and neighbours share the
//! same node, so crossings of a closed curve always come in pairs. The root itself is found by Newton's method inside
//! the part's ends.
//!
//! Road not taken: each ray against each segment. The rays of a pass lie side by side, and going along the curve finds
//! all of them in the time that a handful of rays would take.

use super::roots::{bisect, halve};
use glam::DVec2;
use std::ops::Range;

/// A Newton step below this ends the iteration; the error after it is its square.
const LAST_STEP: f64 = 1e-9;
/// A place across the rays lies between two of them when it is this far from both at least, as a share of their
/// distance.
const ROUNDING: f64 = 1e-6;
/// Halvings of a piece's range towards the place where it runs along the rays: its rate is smooth, and a place that is
/// off by 2^-48 of the piece is off by nothing across the rays.
const TURNING_HALVINGS: u32 = 48;
/// Steps towards a crossing before what is left is only halved: two or three suffice.
const CROSSING_STEPS: u32 = 60;

/// Direction of a family of rays in the transverse plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Rays along x, side by side in y.
    X,
    /// Rays along y, side by side in x.
    Y,
}

/// Both families, in the order in which fields hold them.
pub const FAMILIES: [Family; 2] = [Family::X, Family::Y];

impl Family {
    /// Coordinate along the rays.
    pub fn along(self, p: DVec2) -> f64 {
        match self {
            Self::X => p.x,
            Self::Y => p.y,
        }
    }

    /// Coordinate across the rays.
    pub fn across(self, p: DVec2) -> f64 {
        match self {
            Self::X => p.y,
            Self::Y => p.x,
        }
    }

    /// Point from both.
    pub fn point(self, along_mm: f64, across_mm: f64) -> DVec2 {
        match self {
            Self::X => DVec2::new(along_mm, across_mm),
            Self::Y => DVec2::new(across_mm, along_mm),
        }
    }
}

/// Rays side by side: ray i stands at `first_mm + i * spacing_mm`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayRow {
    /// Place of ray 0, mm.
    pub first_mm: f64,
    /// Distance of neighbours, mm.
    pub spacing_mm: f64,
    /// Number of rays.
    pub count: usize,
}

impl RayRow {
    /// Place of a ray, mm.
    pub fn at_mm(&self, ray: usize) -> f64 {
        self.first_mm + ray as f64 * self.spacing_mm
    }

    /// First ray at or above a place; `count` if there is none.
    pub fn first_at_or_above(&self, at_mm: f64) -> usize {
        self.first_near(at_mm, (at_mm - self.first_mm) / self.spacing_mm)
    }

    /// The same where it is known, but for rounding, how many rays lie below.
    fn first_near(&self, at_mm: f64, rays_below: f64) -> usize {
        // Rounds up without a call: the cast rounds towards zero.
        let place = rays_below.clamp(0.0, self.count as f64);
        let below = place as usize;
        let mut ray = below + usize::from(below as f64 != place);
        // Division rounds; the rays' own places decide.
        while ray < self.count && self.at_mm(ray) < at_mm {
            ray += 1;
        }
        while ray > 0 && self.at_mm(ray - 1) >= at_mm {
            ray -= 1;
        }
        ray
    }
}

/// Part of a closed curve between two nodes; piece i ends where piece i + 1 starts, the last one where the first
/// starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Law of the curve that holds here; [`Piece::STRAIGHT`] for a chord.
    pub law: u32,
    /// Parameter of the law at start and end.
    pub range: [f64; 2],
    /// Largest distance of the curve from the piece's chord, mm.
    pub sagitta_mm: f64,
}

impl Piece {
    /// The straight line from node to node.
    pub const STRAIGHT: u32 = u32::MAX;
}

/// A closed curve, inside on its left.
pub trait ClosedCurve {
    /// Its pieces.
    fn pieces(&self) -> &[Piece];
    /// Where piece `index` starts.
    fn node_mm(&self, index: usize) -> DVec2;
    /// Point and derivative with respect to the parameter under a law.
    fn place(&self, law: u32, parameter: f64) -> [DVec2; 2];
    /// Directions (of any length) at start and end of piece `index`.
    fn tangents(&self, index: usize) -> [DVec2; 2];
}

/// One crossing of a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveCrossing {
    /// Coordinate along the ray, mm.
    pub at_mm: f64,
    /// Direction of the curve there.
    pub tangent: DVec2,
    /// Whether the curve climbs across the rays.
    pub climbs: bool,
}

impl CurveCrossing {
    /// Unit normal out of the curve's inside.
    pub fn outward(&self) -> DVec2 {
        -self.tangent.perp().normalize_or_zero()
    }
}

/// A monotone part of a piece.
#[derive(Debug, Clone, Copy)]
struct MonotonePart {
    law: u32,
    range: [f64; 2],
    /// Coordinates along and across at both ends.
    along: [f64; 2],
    across: [f64; 2],
    /// How far its chord runs along the rays from ray to ray, in mm per mm.
    slope: f64,
    /// How far the part may lie from its chord, measured along the rays.
    tolerance_mm: f64,
}

/// A part as cubics in a parameter from 0 to 1, by powers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartCubic {
    /// Along the rays, mm.
    pub along: [f64; 4],
    /// Across them, mm.
    pub across: [f64; 4],
    /// Place across of the end, mm: that of the next part's start, bit for bit.
    pub across_end_mm: f64,
}

/// Parts that a ray crosses, in their order. Nearly all rays cross two or none: what is known of a tile's rays then
/// lies side by side in memory.
#[derive(Debug, Default, Clone)]
struct MetParts {
    count: u32,
    first: [u32; 3],
    others: Vec<u32>,
}

impl MetParts {
    fn push(&mut self, part: u32) {
        match self.first.get_mut(self.count as usize) {
            Some(place) => *place = part,
            None => self.others.push(part),
        }
        self.count += 1;
    }

    fn clear(&mut self) {
        if self.count as usize > self.first.len() {
            self.others.clear();
        }
        self.count = 0;
    }

    fn ids(&self) -> impl Iterator<Item = usize> {
        let beside = self.first.len().min(self.count as usize);
        self.first[..beside].iter().chain(&self.others[..self.count as usize - beside]).map(|&id| id as usize)
    }
}

/// Crossings of one curve with some rays: scratch memory that is used over and over.
#[derive(Debug, Default)]
pub struct RayCrossings {
    parts: Vec<MonotonePart>,
    /// Per ray of the window: parts that it crosses.
    met: Vec<MetParts>,
    /// Parts are kept that come this near to a ray.
    margin_mm: f64,
    /// Rays per mm.
    per_mm: f64,
    rays: Range<usize>,
    touched: Range<usize>,
}

impl RayCrossings {
    /// Finds which rays of `window` cross which parts of the curve.
    pub fn lay(&mut self, curve: &impl ClosedCurve, family: Family, row: &RayRow, window: Range<usize>) {
        self.lay_within(curve, family, row, window, 0.0);
    }

    /// The same; [`Self::cubics`] then gives the parts as well that come within `margin_mm` of a ray: a kernel that
    /// rounds places has rays cross some of them, and counts in pairs only if it has all.
    pub fn lay_within(
        &mut self,
        curve: &impl ClosedCurve,
        family: Family,
        row: &RayRow,
        window: Range<usize>,
        margin_mm: f64,
    ) {
        (self.margin_mm, self.per_mm) = (margin_mm, 1.0 / row.spacing_mm);
        if self.touched.start < self.touched.end {
            let touched = self.touched.start - self.rays.start..self.touched.end - self.rays.start;
            self.met[touched].iter_mut().for_each(MetParts::clear);
        }
        self.parts.clear();
        self.met.resize(window.len().max(self.met.len()), MetParts::default());
        self.rays = window.clone();
        self.touched = window.end..window.start;
        if window.is_empty() {
            return;
        }
        let (low_mm, high_mm) = (row.at_mm(window.start) - margin_mm, row.at_mm(window.end - 1) + margin_mm);
        let pieces = curve.pieces();
        let first = curve.node_mm(0);
        let mut start = first;
        for (index, piece) in pieces.iter().enumerate() {
            let end = if index + 1 < pieces.len() { curve.node_mm(index + 1) } else { first };
            let (from, to) = (family.across(start), family.across(end));
            let (low, high) = (from.min(to) - piece.sagitta_mm, from.max(to) + piece.sagitta_mm);
            if high >= low_mm && low <= high_mm {
                // Most pieces are shorter than the rays lie apart and meet none: they lie well inside one gap.
                let place = |at_mm: f64| (at_mm - row.first_mm) * self.per_mm;
                let (from, to) = (place(low - margin_mm), place(high + margin_mm));
                let gap = from as i64 as f64;
                if from <= gap + ROUNDING || to >= gap + 1.0 - ROUNDING {
                    self.split(curve, family, row, index, [start, end]);
                }
            }
            start = end;
        }
    }

    fn split(&mut self, curve: &impl ClosedCurve, family: Family, row: &RayRow, index: usize, nodes: [DVec2; 2]) {
        let piece = curve.pieces()[index];
        if piece.law != Piece::STRAIGHT {
            let rates = curve.tangents(index).map(|t| family.across(t));
            if rates[0] * rates[1] < 0.0 {
                let turn = turning_point(rates[0], piece.range, |t| family.across(curve.place(piece.law, t)[1]));
                let middle = curve.place(piece.law, turn)[0];
                self.part(family, row, &piece, [piece.range[0], turn], [nodes[0], middle]);
                self.part(family, row, &piece, [turn, piece.range[1]], [middle, nodes[1]]);
                return;
            }
        }
        self.part(family, row, &piece, piece.range, nodes);
    }

    fn part(&mut self, family: Family, row: &RayRow, piece: &Piece, range: [f64; 2], ends: [DVec2; 2]) {
        let across = ends.map(|p| family.across(p));
        let (low, high) = (across[0].min(across[1]), across[0].max(across[1]));
        // By a product: a part costs hardly more than two divisions.
        let first = |at_mm: f64| row.first_near(at_mm, (at_mm - row.first_mm) * self.per_mm);
        let between = |from: f64, to: f64| first(from).max(self.rays.start)..first(to).min(self.rays.end);
        let rays = between(low, high);
        if rays.is_empty() && (self.margin_mm == 0.0 || between(low - self.margin_mm, high + self.margin_mm).is_empty())
        {
            return;
        }
        let along = ends.map(|p| family.along(p));
        let slope = (along[1] - along[0]) / (across[1] - across[0]);
        let tolerance_mm = piece.sagitta_mm * (1.0 + slope * slope).sqrt();
        let id = self.parts.len() as u32;
        self.parts.push(MonotonePart { law: piece.law, range, along, across, slope, tolerance_mm });
        if rays.is_empty() {
            return;
        }
        self.touched.start = self.touched.start.min(rays.start);
        self.touched.end = self.touched.end.max(rays.end);
        for ray in rays {
            self.met[ray - self.rays.start].push(id);
        }
    }

    /// The parts as cubics through their ends with the curve's own directions there, for kernels that know no curve. A
    /// part turns by a few degrees, so its cubic is off by a nanometre at most on an arc of 30 mm.
    pub fn cubics(&self, curve: &impl ClosedCurve, family: Family) -> impl Iterator<Item = PartCubic> {
        self.parts.iter().map(move |part| {
            let run = [part.along[1] - part.along[0], part.across[1] - part.across[0]];
            let rates = if part.law == Piece::STRAIGHT {
                [run, run]
            } else {
                let scale = part.range[1] - part.range[0];
                part.range.map(|t| {
                    let rate = curve.place(part.law, t)[1] * scale;
                    [family.along(rate), family.across(rate)]
                })
            };
            let hermite = |start: f64, run: f64, from: f64, to: f64| {
                [start, from, 3.0 * run - 2.0 * from - to, from + to - 2.0 * run]
            };
            PartCubic {
                along: hermite(part.along[0], run[0], rates[0][0], rates[1][0]),
                across: hermite(part.across[0], run[1], rates[0][1], rates[1][1]),
                across_end_mm: part.across[1],
            }
        })
    }

    /// Rays that may cross the curve.
    pub fn touched(&self) -> Range<usize> {
        self.touched.clone()
    }

    /// Whether a ray crosses the curve.
    pub fn crosses(&self, ray: usize) -> bool {
        self.met[ray - self.rays.start].count > 0
    }

    /// Bounds of all crossings of a ray without solving for any.
    pub fn bounds_mm(&self, ray: usize, at_mm: f64) -> [f64; 2] {
        let mut bounds = [f64::INFINITY, f64::NEG_INFINITY];
        for id in self.met[ray - self.rays.start].ids() {
            let part = &self.parts[id];
            let near = part.along[0] + (at_mm - part.across[0]) * part.slope;
            bounds[0] = bounds[0].min(near - part.tolerance_mm);
            bounds[1] = bounds[1].max(near + part.tolerance_mm);
        }
        bounds
    }

    /// Crossings of a ray in order along it.
    pub fn solve(
        &self,
        curve: &impl ClosedCurve,
        family: Family,
        ray: usize,
        at_mm: f64,
        found: &mut Vec<CurveCrossing>,
    ) {
        found.clear();
        for id in self.met[ray - self.rays.start].ids() {
            found.push(cross(curve, family, &self.parts[id], at_mm));
        }
        found.sort_by(|a, b| a.at_mm.total_cmp(&b.at_mm));
    }
}

/// Parameter at which the rate across the rays changes its sign.
fn turning_point(first_rate: f64, range: [f64; 2], rate: impl Fn(f64) -> f64) -> f64 {
    let [same, other] = halve(|t| rate(t) * first_rate > 0.0, range[0], range[1], TURNING_HALVINGS);
    0.5 * (same + other)
}

fn cross(curve: &impl ClosedCurve, family: Family, part: &MonotonePart, at_mm: f64) -> CurveCrossing {
    let climbs = part.across[1] > part.across[0];
    let share = (at_mm - part.across[0]) / (part.across[1] - part.across[0]);
    if part.law == Piece::STRAIGHT {
        let run = part.along[1] - part.along[0];
        let tangent = family.point(run, part.across[1] - part.across[0]);
        return CurveCrossing { at_mm: part.along[0] + share * run, tangent, climbs };
    }
    // Parameters below and above the root.
    let [mut low, mut high] = if climbs { part.range } else { [part.range[1], part.range[0]] };
    let mut t = part.range[0] + share * (part.range[1] - part.range[0]);
    let mut place = curve.place(part.law, t);
    let mut arrived = false;
    for _ in 0..CROSSING_STEPS {
        let residual = family.across(place[0]) - at_mm;
        if residual > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let newton = t - residual / family.across(place[1]);
        // A step that leaves the bracket, as near a turning point, is replaced by its middle.
        let inside = (newton - low) * (newton - high) <= 0.0;
        let next = if inside { newton } else { 0.5 * (low + high) };
        let step = (next - t).abs();
        t = next;
        place = curve.place(part.law, t);
        if step < LAST_STEP {
            arrived = true;
            break;
        }
    }
    if !arrived {
        // The part is monotone across the rays: halving what is left of it cannot fail.
        t = bisect(|t| family.across(curve.place(part.law, t)[0]) <= at_mm, low, high);
        place = curve.place(part.law, t);
    }
    let along = family.along(place[0]);
    // The rest of the way along the tangent: none but the last bits.
    let rest = (at_mm - family.across(place[0])) / family.across(place[1]);
    let at_mm = if rest.abs() < LAST_STEP { along + rest * family.along(place[1]) } else { along };
    let forward = if part.range[1] >= part.range[0] { place[1] } else { -place[1] };
    CurveCrossing { at_mm, tangent: forward, climbs }
}
