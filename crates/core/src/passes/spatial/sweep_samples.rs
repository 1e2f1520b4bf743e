//! The heights of sweeps on nine rays of each region of a spatial field.
//!
//! In: a field, candidates. Out: for every candidate the heights at which its segment, or the continuation of it,
//! enters nine rays: first, middle and last column by first, middle and last row. Neighbouring regions share their
//! edges, and the parts of a region share its nine rays: where both directions are halved, sixteen new rays serve four
//! parts. They are searched eight at a time, from the mean of their neighbours.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]

use super::sweep::{LARGEST_T, Sweep, SweepRecord};
use super::sweep_regions::{RAYS, Region, SIDE};
use super::sweep_roots::{LANES, Lanes, Rays, Roots};
use super::turning_passes::{BladePass, TurningPasses};
use crate::dexel::SpatialField;
use crate::tool::edge::Segment;
use glam::DVec3;
use pulp::Arch;

/// Rays along each side of a region with its parts.
const FINE: usize = 2 * SIDE - 1;
/// Rays steeper than this against an edge's normal (cosine) prove nothing. A larger value is safe: candidates that such
/// a ray meets are undecided, and kept unless their box stays clear of the rays.
const GRAZING_COSINE: f64 = 0.1;
/// A candidate goes where all nine rays run out of its segment at more than this cosine from their lowest height on. A
/// straight edge is then run out of everywhere, and so is a round, whose middle lies below all nine. Where rays miss a
/// round, the search ends nowhere, and nothing is known: rays farther apart than a round is wide may all miss one that
/// the rays between them enter. Between the rays the cosine changes by less, on regions of the sizes in use; no proof.
/// Too small, a sweep is dropped that some ray between the
/// nine enters, and the surface stays too high there. Brute force samples nothing: the comparison with it in
/// `tests/suite/hobbing/spatial.rs` sees such a loss on the fields it looks at, and no other.
const LEAVING_COSINE: f64 = 0.05;
/// Newton steps below this, in mm and in t, are the last: the error after them, of the order of their squares, is some
/// picometres.
pub(super) const LAST_STEP: f64 = 1e-5;
/// No root further away is one, mm: what a ray of a flank may keep is some millimetres long.
const FARTHEST_MM: f64 = 1e3;

/// A blade's sweep by one of its segments, as far as one piece of the motion goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepCandidate {
    /// The pass.
    pub pass: BladePass,
    /// Piece of the motion.
    pub piece: u32,
    /// Index of the segment among those of all edges.
    pub segment: usize,
}

impl SweepCandidate {
    /// Pass and piece: one smooth sweep.
    pub fn sweep(&self) -> (u32, u32) {
        (self.pass.pass, self.piece)
    }
}

/// Sweeps as seen from one origin.
pub struct SweepFrame {
    /// Gear frame, mm.
    pub origin_mm: DVec3,
    /// Nothing that is looked at is further from it, mm.
    pub reach_mm: f64,
    /// What the records are.
    pub candidates: Vec<SweepCandidate>,
    /// Records.
    pub records: Vec<SweepRecord>,
}

impl SweepFrame {
    /// Sweeps of candidates, in their order; those whose blades hold the origin at no moment are left out. `index_of`
    /// gives the place of every candidate.
    pub fn new(
        set: &TurningPasses,
        origin_mm: DVec3,
        reach_mm: f64,
        candidates: &[SweepCandidate],
    ) -> (Self, Vec<Option<u32>>) {
        let (records, kept) = (Vec::with_capacity(candidates.len()), Vec::with_capacity(candidates.len()));
        let mut frame = Self { origin_mm, reach_mm, candidates: kept, records };
        let mut index_of = Vec::with_capacity(candidates.len());
        for of_sweep in candidates.chunk_by(|a, b| a.sweep() == b.sweep()) {
            let sweep = Sweep::new(set, &of_sweep[0].pass, of_sweep[0].piece, origin_mm, reach_mm);
            for candidate in of_sweep {
                index_of.push(sweep.is_some().then_some(frame.records.len() as u32));
                if let Some(sweep) = &sweep {
                    let segment = &set.edges.segments()[candidate.segment];
                    frame.records.push(sweep.record(candidate.pass.pass, candidate.segment, segment));
                    frame.candidates.push(*candidate);
                }
            }
        }
        (frame, index_of)
    }
}

/// A candidate on the nine rays of a region.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sampled {
    /// Its place in the frame.
    pub index: u32,
    /// Rays that enter its segment or the continuation of it, as bits.
    pub entered: u32,
    /// Rays that run out of it at their lowest height and wherever they meet it, as bits.
    pub left: u32,
    /// Least cosine at which any ray searched so far enters it.
    pub cosine: f64,
    /// Heights of the entries, mm.
    pub height_mm: [f64; RAYS],
    /// Places of the entries along the segment, mm.
    pub y_mm: [f64; RAYS],
}

impl Sampled {
    /// Mean height of the rays that enter it.
    pub fn mean_entry_mm(&self) -> Option<f64> {
        let entries = self.height_mm.iter().enumerate().filter(|&(ray, _)| self.entered >> ray & 1 == 1);
        let sum_mm: f64 = entries.map(|(_, height_mm)| height_mm).sum();
        (self.entered != 0).then(|| sum_mm / f64::from(self.entered.count_ones()))
    }
}

/// A candidate on the rays of a region and of its parts.
struct Fine {
    entered: u32,
    left: u32,
    cosine: f64,
    height_mm: [f64; FINE * FINE],
    y_mm: [f64; FINE * FINE],
}

impl Fine {
    fn of(sampled: &Sampled) -> Self {
        let cosine = sampled.cosine;
        let mut fine = Self { entered: 0, left: 0, cosine, height_mm: [0.0; FINE * FINE], y_mm: [0.0; FINE * FINE] };
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
        let mut part = Sampled { index, cosine: self.cosine, ..Sampled::default() };
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
struct SearchedRay {
    /// On the fine grid.
    fine: usize,
    /// In the field.
    dexel: usize,
    /// Where on the fine grid heights to start from may be known.
    neighbours: [usize; 4],
}

/// Samples candidates on new rays of a region.
struct SampledRays<'a> {
    frame: &'a SweepFrame,
    segments: &'a [Segment],
    lowest_mm: f64,
    field: &'a SpatialField,
    places: &'a [SearchedRay],
    indices: &'a [u32],
    fine: &'a mut [Fine],
}

impl pulp::NullaryFnOnce for SampledRays<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for places in self.places.chunks(LANES) {
            // Lanes beyond the last place repeat it.
            let lane: [SearchedRay; LANES] = std::array::from_fn(|l| places[l.min(places.len() - 1)]);
            let rays = Rays::new(self.field, self.frame.origin_mm, lane.map(|place| place.dexel));
            for (&index, fine) in self.indices.iter().zip(self.fine.iter_mut()) {
                let record = &self.frame.records[index as usize];
                let segment = &self.segments[record.segment as usize];
                let start_mm: Lanes = std::array::from_fn(|l| fine.start_mm(&lane[l].neighbours));
                let roots = record.roots_from(segment, &rays, &start_mm, self.lowest_mm, LAST_STEP);
                for (l, place) in places.iter().enumerate() {
                    let (height_mm, cosine) = (roots.height_mm[l], roots.cosine[l]);
                    let sure = entered(&roots, l) && cosine >= GRAZING_COSINE;
                    fine.entered |= u32::from(sure) << place.fine;
                    fine.cosine = if sure { fine.cosine.min(cosine) } else { fine.cosine };
                    let leaves = !roots.falls[l] && roots.step_mm[l].abs() < LAST_STEP && cosine < -LEAVING_COSINE;
                    fine.left |= u32::from(leaves) << place.fine;
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
    pub fn sample(&self, frame: &SweepFrame, segments: &[Segment]) -> Vec<Sampled> {
        let even = [0, 2, 4];
        let dexels = self.dexels();
        let places: Vec<SearchedRay> = (0..RAYS)
            .map(|ray| {
                let fine = even[ray / SIDE] * FINE + even[ray % SIDE];
                SearchedRay { fine, dexel: dexels[ray], neighbours: [fine; 4] }
            })
            .collect();
        let indices: Vec<u32> = (0..frame.records.len() as u32).collect();
        let nothing = Sampled { cosine: 1.0, ..Sampled::default() };
        let mut fine: Vec<Fine> = indices.iter().map(|_| Fine::of(&nothing)).collect();
        self.search(frame, segments, &places, &indices, &mut fine);
        indices.iter().zip(&fine).map(|(&index, fine)| fine.part(index, [even, even])).collect()
    }

    /// Parts of the region with what is sampled on each; a candidate goes to the parts whose cells are set in its mask
    /// (cells in the order of columns, then rows).
    pub fn parts(
        &self,
        frame: &SweepFrame,
        segments: &[Segment],
        alive: &[(Sampled, u8)],
    ) -> Vec<(Self, Vec<Sampled>)> {
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
                    places.push(SearchedRay { fine: i * FINE + j, dexel: self.field.index(*column, *row), neighbours });
                }
            }
        }
        let indices: Vec<u32> = alive.iter().map(|(sampled, _)| sampled.index).collect();
        let mut fine: Vec<Fine> = alive.iter().map(|(sampled, _)| Fine::of(sampled)).collect();
        self.search(frame, segments, &places, &indices, &mut fine);
        let mut parts = Vec::with_capacity(4);
        for i in 0..=usize::from(split[0]) {
            for j in 0..=usize::from(split[1]) {
                let span = |direction: usize, part: usize| {
                    let whole = [self.columns, self.rows][direction];
                    if split[direction] || self.is_tile() { halves[direction][part] } else { whole }
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

    fn search(
        &self,
        frame: &SweepFrame,
        segments: &[Segment],
        places: &[SearchedRay],
        indices: &[u32],
        fine: &mut [Fine],
    ) {
        let lowest_mm = 2.0 * self.field.low_mm;
        Arch::new().dispatch(SampledRays { frame, segments, lowest_mm, field: self.field, places, indices, fine });
    }
}

/// Whether the ray of a lane enters the segment or its continuation.
#[inline(always)]
pub(super) fn entered(roots: &Roots, l: usize) -> bool {
    roots.falls[l]
        && roots.step_mm[l].abs() < LAST_STEP
        && roots.t[l].abs() < LARGEST_T
        && roots.height_mm[l].abs() < FARTHEST_MM
}
