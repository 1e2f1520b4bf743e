//! Regions of a spatial field and the heights of sweeps on nine rays of each.
//!
//! In: a field, candidates. Out: for every candidate the heights at which its segment, or the continuation of it, enters nine rays: first, middle and last column by first, middle and last row. Neighbouring
//! regions share their edges, and the parts of a region share its nine rays: where both directions are halved, sixteen new rays serve four parts. They are searched eight at a time, from the mean of
//! their neighbours.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]

use super::hob_teeth::HobTeeth;
use super::sweep::{Sweep, SweepRecord, SweepStart};
use super::sweep_plan::{Candidate, SweepTile, TILE_COLUMNS, TILE_ROWS};
use super::sweep_roots::{LANES, LARGEST_T, Lanes, Rays, Roots};
use crate::dexel::SpatialField;
use crate::tool::edge::Edge;
use glam::DVec3;
use pulp::Arch;
use std::ops::Range;

/// Rays sampled along each side.
pub const SIDE: usize = 3;
/// Rays sampled.
pub const RAYS: usize = SIDE * SIDE;
/// All rays of a region, as bits.
pub const ALL: u32 = (1 << RAYS) - 1;
/// Rays along each side of a region with its parts.
const FINE: usize = 2 * SIDE - 1;
/// Rays steeper than this against an edge's normal (cosine) prove nothing.
const GRAZING_COSINE: f64 = 0.1;
/// Rays that run out of a segment at more than this cosine do not enter it.
const LEAVING_COSINE: f64 = 0.05;
/// Newton steps below this, in mm and in t, are the last: the error after them, of the order of their squares, is some picometres.
const LAST_STEP: f64 = 1e-5;
/// No root further away is one, mm.
const FARTHEST_MM: f64 = 1e3;

/// Lines of dexels in one direction.
#[derive(Debug, Clone, Copy)]
pub struct Span {
    /// First, middle and last line; all dexels lie between first and last.
    pub at: [usize; SIDE],
    /// Number of tiles.
    pub count: usize,
    tile: usize,
    last: usize,
}

impl Span {
    fn new(from: usize, count: usize, tile: usize, last: usize) -> Self {
        let to = (from + count * tile).min(last);
        let middle = from + if count > 1 { count / 2 * tile } else { tile / 2 };
        Self { at: [from, middle.min(to), to], count, tile, last }
    }

    /// Its dexels, tile by tile.
    pub fn tiles(&self) -> impl Iterator<Item = Range<usize>> + use<> {
        let Self { at: [from, ..], count, tile, last } = *self;
        (0..count).map(move |i| from + i * tile..(from + (i + 1) * tile).min(last + 1))
    }

    /// Its dexels: the line that it shares with the next tile belongs to that one.
    pub fn dexels(&self) -> Range<usize> {
        self.at[0]..(self.at[0] + self.count * self.tile).min(self.last + 1)
    }

    /// Parts to both sides of the middle line.
    fn halves(&self) -> [Self; 2] {
        let [from, middle, _] = self.at;
        let (counts, tile) = if self.count > 1 {
            ([self.count / 2, self.count - self.count / 2], self.tile)
        } else {
            ([1, 1], self.tile / 2)
        };
        [Self::new(from, counts[0], tile, self.last), Self::new(middle, counts[1], tile, self.last)]
    }

    /// Weights of three values whose sum is as far as the smooth function behind them leaves straight lines between them, by its second differences. Nothing if it cannot be told.
    fn bend(&self) -> Option<[f64; SIDE]> {
        let [from, middle, to] = self.at;
        let [a, b] = [middle - from, to - middle].map(|lines| lines as f64);
        if to - from <= 1 {
            return Some([0.0; SIDE]);
        }
        (a > 0.0 && b > 0.0).then(|| {
            let scale = 0.25 * a.max(b).powi(2) / (a + b);
            [scale / a, -scale * (1.0 / a + 1.0 / b), scale / b]
        })
    }
}

/// Dexels that are judged together.
pub struct Region<'a> {
    field: &'a SpatialField,
    /// Columns.
    pub columns: Span,
    /// Rows.
    pub rows: Span,
    bends: Option<[[f64; SIDE]; 2]>,
    /// Height of the blank along each of the nine rays, column by column.
    pub blank_mm: [f64; RAYS],
}

impl<'a> Region<'a> {
    /// All of a field.
    pub fn whole(field: &'a SpatialField) -> Self {
        let span = |lines: usize, tile: usize| Span::new(0, lines.div_ceil(tile), tile, lines - 1);
        Self::new(field, span(field.columns(), TILE_COLUMNS), span(field.rows(), TILE_ROWS))
    }

    fn new(field: &'a SpatialField, columns: Span, rows: Span) -> Self {
        let bends = columns.bend().zip(rows.bend()).map(|(c, r)| [c, r]);
        let blank_mm =
            std::array::from_fn(|i| f64::from(field.blank_mm[field.index(columns.at[i / SIDE], rows.at[i % SIDE])]));
        Self { field, columns, rows, bends, blank_mm }
    }

    /// Whether it is one tile.
    pub fn is_tile(&self) -> bool {
        self.columns.count == 1 && self.rows.count == 1
    }

    /// The nine rays as dexels.
    pub fn dexels(&self) -> [usize; RAYS] {
        std::array::from_fn(|i| self.field.index(self.columns.at[i / SIDE], self.rows.at[i % SIDE]))
    }

    /// Size along the profile and along the tooth, mm.
    pub fn extent_mm(&self) -> [f64; 2] {
        let at = |i: usize, j: usize| self.field.ray(self.columns.at[i], self.rows.at[j]).origin_mm;
        [at(0, 1).distance(at(2, 1)), at(1, 0).distance(at(1, 2))]
    }

    /// How far a smooth function with these values on the nine rays can leave its bilinear interpolation in any of the four cells between them.
    #[inline(always)]
    pub fn bend(&self, values: &[f64; RAYS]) -> f64 {
        let Some([across, along]) = &self.bends else { return f64::INFINITY };
        let (mut most_across, mut most_along) = (0.0_f64, 0.0_f64);
        for line in 0..SIDE {
            let [a, b, c] = [0, 1, 2].map(|i| values[SIDE * i + line]);
            most_across = most_across.max((across[0] * a + across[1] * b + across[2] * c).abs());
            let [a, b, c] = [0, 1, 2].map(|i| values[SIDE * line + i]);
            most_along = most_along.max((along[0] * a + along[1] * b + along[2] * c).abs());
        }
        most_across + most_along
    }

    /// Which directions are halved: both, or the longer one; facets are some two and a half times as long as wide. A tile is halved in both.
    fn split(&self) -> [bool; 2] {
        let [width_mm, length_mm] = self.extent_mm();
        let (wide, long) = (self.columns.count > 1, self.rows.count > 1);
        if self.is_tile() {
            return [true; 2];
        }
        [wide && (!long || 5.0 * width_mm > length_mm), long && (!wide || length_mm > 1.25 * width_mm)]
    }
}

/// Sweeps as seen from one origin.
pub struct Frame {
    /// Gear frame, mm.
    pub origin_mm: DVec3,
    /// Nothing that is looked at is further from it, mm.
    pub reach_mm: f64,
    /// What the records are.
    pub candidates: Vec<Candidate>,
    /// Records.
    pub records: Vec<SweepRecord>,
}

impl Frame {
    /// Sweeps of candidates, in their order; those whose blades hold the origin at no moment are left out. `index_of` gives the place of every candidate.
    pub fn new(
        set: &HobTeeth,
        edge: &Edge,
        origin_mm: DVec3,
        reach_mm: f64,
        candidates: &[Candidate],
    ) -> (Self, Vec<Option<u32>>) {
        let mut frame = Self { origin_mm, reach_mm, candidates: Vec::new(), records: Vec::new() };
        let mut index_of = Vec::with_capacity(candidates.len());
        for of_sweep in candidates.chunk_by(|a, b| a.sweep() == b.sweep()) {
            let sweep = Sweep::new(set, &of_sweep[0].pass, of_sweep[0].stretch, origin_mm, reach_mm);
            for candidate in of_sweep {
                index_of.push(sweep.is_some().then_some(frame.records.len() as u32));
                if let Some(sweep) = &sweep {
                    let segment = &edge.segments[candidate.segment];
                    frame.records.push(sweep.record(candidate.pass.pass, candidate.segment, segment));
                    frame.candidates.push(*candidate);
                }
            }
        }
        (frame, index_of)
    }
}

/// A candidate on the nine rays of a region.
#[derive(Debug, Clone, Copy)]
pub struct Sampled {
    /// Its place in the frame.
    pub index: u32,
    /// Rays that enter its segment or the continuation of it, as bits.
    pub entered: u32,
    /// Rays that run out of it wherever they meet it, as bits.
    pub left: u32,
    /// Heights of the entries, mm.
    pub height_mm: [f64; RAYS],
    /// Places of the entries along the segment, mm.
    pub y_mm: [f64; RAYS],
}

/// A candidate on the rays of a region and of its parts.
struct Fine {
    entered: u32,
    left: u32,
    height_mm: [f64; FINE * FINE],
    y_mm: [f64; FINE * FINE],
}

impl Fine {
    fn of(sampled: &Sampled) -> Self {
        let mut fine = Self { entered: 0, left: 0, height_mm: [0.0; FINE * FINE], y_mm: [0.0; FINE * FINE] };
        for ray in 0..RAYS {
            let at = 2 * (ray / SIDE) * FINE + 2 * (ray % SIDE);
            fine.height_mm[at] = sampled.height_mm[ray];
            fine.y_mm[at] = sampled.y_mm[ray];
            fine.entered |= (sampled.entered >> ray & 1) << at;
            fine.left |= (sampled.left >> ray & 1) << at;
        }
        fine
    }

    /// What a part sees: the rays at these places of the fine grid.
    fn part(&self, index: u32, [columns, rows]: [[usize; SIDE]; 2]) -> Sampled {
        let mut part = Sampled { index, entered: 0, left: 0, height_mm: [0.0; RAYS], y_mm: [0.0; RAYS] };
        for ray in 0..RAYS {
            let at = columns[ray / SIDE] * FINE + rows[ray % SIDE];
            part.height_mm[ray] = self.height_mm[at];
            part.y_mm[ray] = self.y_mm[at];
            part.entered |= (self.entered >> at & 1) << ray;
            part.left |= (self.left >> at & 1) << ray;
        }
        part
    }
}

/// A ray to be searched.
#[derive(Clone, Copy)]
struct Place {
    /// On the fine grid.
    fine: usize,
    /// In the field.
    dexel: usize,
    /// Where on the fine grid heights to start from may be known.
    neighbours: [usize; 4],
}

/// Samples candidates on new rays of a region.
struct Sampling<'a> {
    frame: &'a Frame,
    edge: &'a Edge,
    lowest_mm: f64,
    field: &'a SpatialField,
    places: &'a [Place],
    indices: &'a [u32],
    fine: &'a mut [Fine],
}

impl pulp::NullaryFnOnce for Sampling<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for places in self.places.chunks(LANES) {
            // Lanes beyond the last place repeat it.
            let lane: [Place; LANES] = std::array::from_fn(|l| places[l.min(places.len() - 1)]);
            let rays = Rays::new(self.field, self.frame.origin_mm, lane.map(|place| place.dexel));
            for (&index, fine) in self.indices.iter().zip(self.fine.iter_mut()) {
                let record = &self.frame.records[index as usize];
                let segment = &self.edge.segments[record.segment as usize];
                let start_mm: Lanes = std::array::from_fn(|l| fine.start_mm(&lane[l].neighbours));
                let start_t = record.places(&rays, &start_mm, 1)[0];
                let roots = record.roots(segment, &rays, [&start_mm, &start_t], self.lowest_mm, LAST_STEP);
                for (l, place) in places.iter().enumerate() {
                    let (height_mm, cosine) = (roots.height_mm[l], roots.cosine[l]);
                    let sure = entered(&roots, l) && cosine >= GRAZING_COSINE;
                    fine.entered |= u32::from(sure) << place.fine;
                    fine.left |= u32::from(!roots.falls[l] && cosine < -LEAVING_COSINE) << place.fine;
                    fine.height_mm[place.fine] = height_mm;
                    fine.y_mm[place.fine] = roots.y_mm[l];
                }
            }
        }
    }
}

impl Fine {
    #[inline(always)]
    fn start_mm(&self, neighbours: &[usize; 4]) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for &at in neighbours {
            let known = f64::from(self.entered >> at & 1);
            sum += known * self.height_mm[at];
            count += known;
        }
        if count > 0.0 { sum / count } else { 0.0 }
    }
}

impl Region<'_> {
    /// Candidates of a frame on the nine rays, searched from the target.
    pub fn sample(&self, frame: &Frame, edge: &Edge) -> Vec<Sampled> {
        let even = [0, 2, 4];
        let dexels = self.dexels();
        let places: Vec<Place> = (0..RAYS)
            .map(|ray| {
                let fine = even[ray / SIDE] * FINE + even[ray % SIDE];
                Place { fine, dexel: dexels[ray], neighbours: [fine; 4] }
            })
            .collect();
        let indices: Vec<u32> = (0..frame.records.len() as u32).collect();
        let nothing = Sampled { index: 0, entered: 0, left: 0, height_mm: [0.0; RAYS], y_mm: [0.0; RAYS] };
        let mut fine: Vec<Fine> = indices.iter().map(|_| Fine::of(&nothing)).collect();
        self.search(frame, edge, &places, &indices, &mut fine);
        indices.iter().zip(&fine).map(|(&index, fine)| fine.part(index, [even, even])).collect()
    }

    /// Parts of the region with what is sampled on each; a candidate goes to the parts whose cells are set in its mask (cells in the order of columns, then rows).
    pub fn parts(&self, frame: &Frame, edge: &Edge, alive: &[(Sampled, u8)]) -> Vec<(Self, Vec<Sampled>)> {
        let split = self.split();
        let halves = [self.columns.halves(), self.rows.halves()];
        // Dexel lines of the fine grid; a direction that stays whole has its even ones alone.
        let lines: [[Option<usize>; FINE]; 2] = std::array::from_fn(|direction| {
            let [a, b] = halves[direction];
            let whole = [self.columns, self.rows][direction].at;
            if split[direction] {
                [a.at[0], a.at[1], b.at[0], b.at[1], b.at[2]].map(Some)
            } else {
                [Some(whole[0]), None, Some(whole[1]), None, Some(whole[2])]
            }
        });
        let mut places = Vec::with_capacity(FINE * FINE);
        for (i, column) in lines[0].iter().enumerate() {
            for (j, row) in lines[1].iter().enumerate() {
                let (Some(column), Some(row)) = (column, row) else { continue };
                if i % 2 == 1 || j % 2 == 1 {
                    let ([left, right], [below, above]) = ([i - i % 2, i + i % 2], [j - j % 2, j + j % 2]);
                    let neighbours = [(left, below), (left, above), (right, below), (right, above)];
                    let neighbours = neighbours.map(|(i, j)| i * FINE + j);
                    places.push(Place { fine: i * FINE + j, dexel: self.field.index(*column, *row), neighbours });
                }
            }
        }
        let indices: Vec<u32> = alive.iter().map(|(sampled, _)| sampled.index).collect();
        let mut fine: Vec<Fine> = alive.iter().map(|(sampled, _)| Fine::of(sampled)).collect();
        self.search(frame, edge, &places, &indices, &mut fine);
        let mut parts = Vec::with_capacity(4);
        for i in 0..=usize::from(split[0]) {
            for j in 0..=usize::from(split[1]) {
                let span = |direction: usize, part: usize| {
                    if split[direction] { halves[direction][part] } else { [self.columns, self.rows][direction] }
                };
                let grid = |direction: usize, part: usize| {
                    if split[direction] { [2 * part, 2 * part + 1, 2 * part + 2] } else { [0, 2, 4] }
                };
                let cells = |split: bool, part: usize| if split { part..part + 1 } else { 0..2 };
                let mask = cells(split[0], i)
                    .flat_map(|a| cells(split[1], j).map(move |b| 1_u8 << (2 * a + b)))
                    .fold(0, |mask, bit| mask | bit);
                let sampled = alive.iter().zip(&fine).filter(|((_, cells), _)| cells & mask != 0);
                let sampled = sampled.map(|((s, _), fine)| fine.part(s.index, [grid(0, i), grid(1, j)])).collect();
                parts.push((Self::new(self.field, span(0, i), span(1, j)), sampled));
            }
        }
        parts
    }

    fn search(&self, frame: &Frame, edge: &Edge, places: &[Place], indices: &[u32], fine: &mut [Fine]) {
        let lowest_mm = 2.0 * self.field.low_mm;
        Arch::new().dispatch(Sampling { frame, edge, lowest_mm, field: self.field, places, indices, fine });
    }
}

/// Gives the records of a tile the polynomials that Newton's method starts from: through the middle ray, the ends of the middle column and row, and two corners. Where one of them does not meet the segment or
/// its continuation, only the middle ray counts; where that one does not, the lowest height.
pub fn find_starts(field: &SpatialField, tile: &SweepTile, edge: &Edge, records: &mut [SweepRecord]) {
    Arch::new().dispatch(Starting { field, tile, edge, records });
}

struct Starting<'a> {
    field: &'a SpatialField,
    tile: &'a SweepTile,
    edge: &'a Edge,
    records: &'a mut [SweepRecord],
}

impl pulp::NullaryFnOnce for Starting<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let [column, row] = self.tile.middle();
        let [columns, rows] = [&self.tile.columns, &self.tile.rows].map(|lines| [lines.start, lines.end - 1]);
        let places = [
            [column, row],
            [columns[0], row],
            [columns[1], row],
            [column, rows[0]],
            [column, rows[1]],
            [columns[0], rows[0]],
            [columns[1], rows[1]],
            [column, row],
        ];
        let from_middle = places.map(|[c, r]| [c as f64 - column as f64, r as f64 - row as f64]);
        let rays = Rays::new(self.field, self.tile.origin_mm, places.map(|[c, r]| self.field.index(c, r)));
        let lowest_mm = 2.0 * self.field.low_mm;
        for record in self.records {
            let segment = &self.edge.segments[record.segment as usize];
            let start_t = record.places(&rays, &[0.0; LANES], 1)[0];
            let roots = record.roots(segment, &rays, [&[0.0; LANES], &start_t], lowest_mm, LAST_STEP);
            record.start = if (0..LANES).all(|l| entered(&roots, l)) {
                SweepStart {
                    height_mm: quadratic(&from_middle, &roots.height_mm),
                    t: quadratic(&from_middle, &roots.t),
                }
            } else {
                let middle_mm = if entered(&roots, 0) { roots.height_mm[0] } else { lowest_mm };
                SweepStart { height_mm: [middle_mm, 0.0, 0.0, 0.0, 0.0, 0.0], t: [0.0; 6] }
            };
        }
    }
}

/// Coefficients of 1, x, y, x^2, x y, y^2 through values in the middle, to both sides along x and along y, and in two corners (their mean).
#[inline(always)]
fn quadratic(places: &[[f64; 2]; LANES], values: &Lanes) -> [f64; 6] {
    let along = |axis: usize, before: usize, after: usize| {
        let ([a, b], [f, g]) =
            ([places[before][axis], places[after][axis]], [before, after].map(|i| values[i] - values[0]));
        if a == 0.0 || b == 0.0 {
            // A line, or nothing, where there are too few rays.
            return [if b == 0.0 { 0.0 } else { g / b }, 0.0];
        }
        let bend = (g / b - f / a) / (b - a);
        [g / b - bend * b, bend]
    };
    let ([x, xx], [y, yy]) = (along(0, 1, 2), along(1, 3, 4));
    let twist = |corner: usize| {
        let [u, v] = places[corner];
        let rest = values[corner] - values[0] - u * (x + u * xx) - v * (y + v * yy);
        if u * v == 0.0 { 0.0 } else { rest / (u * v) }
    };
    [values[0], x, y, xx, 0.5 * (twist(5) + twist(6)), yy]
}

#[inline(always)]
fn entered(roots: &Roots, l: usize) -> bool {
    roots.falls[l]
        && roots.step_mm[l].abs() < LAST_STEP
        && roots.t[l].abs() < LARGEST_T
        && roots.height_mm[l].abs() < FARTHEST_MM
}
