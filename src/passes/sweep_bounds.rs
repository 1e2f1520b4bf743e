//! Which sweeps can leave the lowest surface on a region of a spatial field.
//!
//! Nine rays (three columns by three rows) are sampled: the height at which each sweep's segment, or the continuation of it, enters them. In each of the four cells between them
//! the difference of two sweeps' heights lies above its lowest corner less an eighth of its second differences along both sides; all sweeps of one tool bend nearly
//! alike, so these are small where the heights' own are not. A sweep goes when in every cell some other one, certain to enter through the segment itself, is lower by this
//! measure with half as much again for what second differences cannot show.
//!
//! What the samples cannot judge (no root on one of the rays) is kept unless the blade stays clear of the rays below the lowest certain surface.

use super::hob_teeth::HobTeeth;
use super::sweep::{Meeting, Sweep, SweepHit};
use super::sweep_plan::Candidate;
use crate::dexel::{Ray, SpatialField};
use crate::tool::edge::{Edge, Segment};
use glam::DVec3;
use std::ops::Range;

/// Safety on second differences, for what varies inside a cell.
const BEND_SAFETY: f64 = 1.5;
/// Added to every bound: what sampling and the backends' roots may err, mm.
const ROUNDING_MM: f64 = 2e-7;
/// Rays steeper than this against an edge's normal (cosine) prove nothing.
const GRAZING_COSINE: f64 = 0.1;
/// Rays sampled along each side.
const SIDE: usize = 3;
/// Rays sampled.
const RAYS: usize = SIDE * SIDE;
/// Cells of the sampling: index of the first corner; the others follow at 1, 3 and 4.
const CELLS: [usize; 4] = [0, 1, 3, 4];

/// Dexels that are judged together.
pub struct Region {
    /// Origin of the region's frame: the middle ray's, gear frame, mm.
    pub origin_mm: DVec3,
    /// Nothing between lowest and blank height of any ray is further from it, mm.
    pub reach_mm: f64,
    /// Nine rays, column by column, in the region's frame.
    rays: [Ray; RAYS],
    /// Height of the blank along each.
    blank_mm: [f64; RAYS],
    low_mm: f64,
}

impl Region {
    /// Region of some columns and rows of a field.
    pub fn new(field: &SpatialField, columns: Range<usize>, rows: Range<usize>) -> Self {
        let [column_at, row_at] =
            [columns, rows].map(|range| [range.start, (range.start + range.end - 1) / 2, range.end - 1]);
        let origin_mm = field.ray(column_at[1], row_at[1]).origin_mm;
        let place = |i: usize| (column_at[i / SIDE], row_at[i % SIDE]);
        let rays: [Ray; RAYS] = std::array::from_fn(|i| {
            let (column, row) = place(i);
            let ray = field.ray(column, row);
            Ray { origin_mm: ray.origin_mm - origin_mm, ..ray }
        });
        let blank_mm: [f64; RAYS] = std::array::from_fn(|i| {
            let (column, row) = place(i);
            f64::from(field.blank_mm[field.index(column, row)])
        });
        let ends = (0..RAYS).flat_map(|i| [field.low_mm, blank_mm[i]].map(|h| rays[i].at(h).length()));
        let reach_mm = 1.05 * ends.fold(0.0, f64::max);
        Self { origin_mm, reach_mm, rays, blank_mm, low_mm: field.low_mm }
    }

    /// The middle ray.
    pub fn middle(&self) -> &Ray {
        &self.rays[RAYS / 2]
    }

    /// Size along the profile and along the tooth, mm.
    pub fn extent_mm(&self) -> [f64; 2] {
        let distance = |a: usize, b: usize| self.rays[a].origin_mm.distance(self.rays[b].origin_mm);
        [distance(1, RAYS - SIDE + 1), distance(SIDE, 2 * SIDE - 1)]
    }
}

/// Heights of one sweep on the nine rays.
struct Samples {
    candidate: Candidate,
    hits: [SweepHit; RAYS],
    /// Cells in which the ray enters through the segment itself, wherever it is.
    certain: [bool; CELLS.len()],
}

/// Judges candidates on one region.
pub struct Judge<'a> {
    /// The passes.
    pub set: &'a HobTeeth,
    /// The blades' edge.
    pub edge: &'a Edge,
    /// The region.
    pub region: &'a Region,
}

impl Judge<'_> {
    /// Candidates that may leave the lowest surface somewhere in the region, in their order, and a height that this surface is certainly below; `ceiling_mm` is such a height of a
    /// region around this one.
    pub fn keep(&self, candidates: &[Candidate], ceiling_mm: f64) -> (Vec<Candidate>, f64) {
        let (mut judged, mut unjudged) = (Vec::new(), Vec::new());
        for of_pass in candidates.chunk_by(|a, b| a.pass.pass == b.pass.pass) {
            let pass = &of_pass[0].pass;
            let Some(sweep) = Sweep::new(self.set, pass, self.region.origin_mm, self.region.reach_mm) else {
                continue;
            };
            // Boxes first: they cost a tenth of samples, and the ceiling makes them low.
            let Some(bounds) = self.rake_face_box(&sweep, ceiling_mm) else { continue };
            for candidate in of_pass {
                if !bounds.meets(&self.edge.segments[candidate.segment]) {
                    continue;
                }
                match self.sample(&sweep, candidate) {
                    Some(Ok(samples)) => judged.push(samples),
                    Some(Err(())) => unjudged.push((sweep, *candidate)),
                    None => {}
                }
            }
        }
        let ceiling_mm = self.ceiling_mm(&judged).min(ceiling_mm);
        let mut kept: Vec<Candidate> = self.undominated(&judged);
        kept.extend(
            unjudged
                .into_iter()
                .filter(|(sweep, candidate)| {
                    let bounds = self.rake_face_box(sweep, ceiling_mm);
                    bounds.is_some_and(|b| b.meets(&self.edge.segments[candidate.segment]))
                })
                .map(|(_, candidate)| candidate),
        );
        kept.sort_unstable_by_key(|candidate| (candidate.pass.pass, candidate.segment));
        (kept, ceiling_mm)
    }

    /// Samples of one candidate; an error if they do not judge it, nothing if it is clear of the region.
    fn sample(&self, sweep: &Sweep, candidate: &Candidate) -> Option<Result<Samples, ()>> {
        let segment = &self.edge.segments[candidate.segment];
        let record = sweep.record(candidate.pass.pass, candidate.segment, segment);
        let mut hits = [SweepHit { height_mm: 0.0, t: 0.0, y_mm: 0.0, cosine: 0.0 }; RAYS];
        let (mut found, mut leaves) = (0, 0);
        // From the middle outwards, each from its neighbour's height.
        for at in [4, 3, 5, 1, 7, 0, 2, 6, 8] {
            let start_mm = match at {
                4 => 0.0,
                1 | 3 | 5 | 7 => hits[4].height_mm,
                _ => hits[if at % SIDE == 0 { 3 } else { 5 }].height_mm,
            };
            match record.enter(segment, &self.region.rays[at], start_mm) {
                Meeting::Enters(hit) => {
                    hits[at] = hit;
                    found += 1;
                }
                Meeting::Leaves => leaves += 1,
                Meeting::Missed => {}
            }
        }
        if leaves == RAYS {
            return None;
        }
        let floor_mm = 2.0 * self.region.low_mm;
        if found < RAYS || hits.iter().any(|hit| hit.cosine < GRAZING_COSINE) {
            return Some(Err(()));
        }
        let range = |value: fn(&SweepHit) -> f64| {
            hits.iter().map(value).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)])
        };
        let [lowest, highest] = range(|hit| hit.height_mm);
        if lowest <= floor_mm {
            return if highest < floor_mm - 0.2 * (highest - lowest) - 1e-3 { None } else { Some(Err(())) };
        }
        let [y_low, y_high] = range(|hit| hit.y_mm);
        let [y_start, y_end] = segment.y_range_mm;
        let slack = |from: f64, to: f64| 0.5 * (to - from) + 1e-6;
        if y_low - slack(y_low, y_high) > y_end || y_high + slack(y_low, y_high) < y_start {
            return None;
        }
        let certain = CELLS.map(|cell| {
            let y = corners(cell).map(|corner| hits[corner].y_mm);
            let (low, high) =
                (y.into_iter().fold(f64::INFINITY, f64::min), y.into_iter().fold(-f64::INFINITY, f64::max));
            low - slack(low, high) > y_start && high + slack(low, high) < y_end
        });
        Some(Ok(Samples { candidate: *candidate, hits, certain }))
    }

    /// A height that the surface left is certainly below everywhere.
    fn ceiling_mm(&self, judged: &[Samples]) -> f64 {
        let blank_mm = self.region.blank_mm.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (0..CELLS.len())
            .map(|cell| {
                judged
                    .iter()
                    .filter(|samples| samples.certain[cell])
                    .map(|samples| {
                        let heights = samples.hits.map(|hit| hit.height_mm);
                        let top =
                            corners(CELLS[cell]).map(|c| heights[c]).into_iter().fold(f64::NEG_INFINITY, f64::max);
                        top + bend_mm(&heights)
                    })
                    .fold(blank_mm, f64::min)
            })
            .fold(f64::NEG_INFINITY, f64::max)
    }

    fn undominated(&self, judged: &[Samples]) -> Vec<Candidate> {
        // In each cell the certain sweeps that are lowest at one of its corners: no other can rule.
        let rulers: [Vec<usize>; CELLS.len()] = std::array::from_fn(|cell| {
            let mut lowest: Vec<usize> = corners(CELLS[cell])
                .into_iter()
                .filter_map(|corner| {
                    let height = |k: usize| judged[k].hits[corner].height_mm;
                    (0..judged.len())
                        .filter(|&k| judged[k].certain[cell])
                        .min_by(|&a, &b| height(a).total_cmp(&height(b)))
                })
                .collect();
            lowest.sort_unstable();
            lowest.dedup();
            lowest
        });
        let above = |k: &Samples, ruler: &dyn Fn(usize) -> f64, cell: usize| {
            let difference: [f64; RAYS] = std::array::from_fn(|i| k.hits[i].height_mm - ruler(i));
            let margin_mm = bend_mm(&difference) + ROUNDING_MM;
            corners(CELLS[cell]).into_iter().all(|corner| difference[corner] > margin_mm)
        };
        judged
            .iter()
            .enumerate()
            .filter(|(index, k)| {
                !(0..CELLS.len()).all(|cell| {
                    above(k, &|i| self.region.blank_mm[i], cell)
                        || rulers[cell].iter().any(|&r| r != *index && above(k, &|i| judged[r].hits[i].height_mm, cell))
                })
            })
            .map(|(_, samples)| samples.candidate)
            .collect()
    }

    /// Box in the rake face of all that the rays pass between their lowest height and a ceiling while the blade sweeps; nothing if they pass no rake face.
    fn rake_face_box(&self, sweep: &Sweep, ceiling_mm: f64) -> Option<RakeFaceBox> {
        let floor_mm = 2.0 * self.region.low_mm;
        let heights_mm = [floor_mm, 0.5 * (floor_mm + ceiling_mm), ceiling_mm];
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let (mut outside, mut inside) = (0, 0);
        for ray in &self.region.rays {
            for height_mm in heights_mm {
                let Some(place) = sweep.in_rake_face(ray.at(height_mm)) else {
                    outside += 1;
                    continue;
                };
                inside += 1;
                for axis in 0..2 {
                    low[axis] = low[axis].min(place[axis]);
                    high[axis] = high[axis].max(place[axis]);
                }
            }
        }
        if inside == 0 {
            return None;
        }
        if outside > 0 {
            return Some(RakeFaceBox { low: [f64::NEG_INFINITY; 2], high: [f64::INFINITY; 2] });
        }
        // Between the samples the way through the rake face bends by no more than the tool's radius makes it.
        let [width_mm, length_mm] = self.region.extent_mm();
        let cell_mm = (0.5 * width_mm).hypot(0.5 * length_mm).max(0.5 * (ceiling_mm - floor_mm));
        let margin_mm = cell_mm * cell_mm / (8.0 * 0.5 * low[0].max(1.0)) + 1e-3;
        Some(RakeFaceBox { low: low.map(|v| v - margin_mm), high: high.map(|v| v + margin_mm) })
    }
}

/// Ranges of the distance from the tool's axis and of the blade's y, mm.
struct RakeFaceBox {
    low: [f64; 2],
    high: [f64; 2],
}

impl RakeFaceBox {
    fn meets(&self, segment: &Segment) -> bool {
        // The chord's box, widened by what the segment's circle has beyond half the chord.
        let center = segment.blade_from_segment.translation_mm.to_array();
        let [x, y] = segment.blade_from_segment.rotation.to_array();
        let half = 0.5 * (segment.y_range_mm[1] - segment.y_range_mm[0]);
        let bulge = (segment.reach_mm * segment.reach_mm - half * half).max(0.0).sqrt();
        let reach = [(half * y).abs() + bulge, (half * x).abs() + bulge];
        (0..2).all(|axis| self.low[axis] <= center[axis] + reach[axis] && self.high[axis] >= center[axis] - reach[axis])
    }
}

/// Corners of a cell.
fn corners(first: usize) -> [usize; 4] {
    [first, first + 1, first + SIDE, first + SIDE + 1]
}

/// How far a smooth function of which nine values are known can leave its bilinear interpolation.
fn bend_mm(values: &[f64; RAYS]) -> f64 {
    let second = |a: usize, b: usize, c: usize| (values[a] - 2.0 * values[b] + values[c]).abs();
    let along = |step: usize, lines: [usize; SIDE]| {
        lines.map(|first| second(first, first + step, first + 2 * step)).into_iter().fold(0.0, f64::max)
    };
    BEND_SAFETY / 8.0 * (along(SIDE, [0, 1, 2]) + along(1, [0, SIDE, 2 * SIDE]))
}
