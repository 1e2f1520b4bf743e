//! One tooth space in the transverse plane, cut stroke by stroke: what every stroke takes away, and how thick it is
//! along the edge.
//!
//! In: the blank's contours, a window round the space, then the poses of the cutter's teeth **in order of time**. Out,
//! per pass: chip area and uncut chip thickness at the edge's stations.
//!
//! The material is held by two families of rays, along and across the space. A pass crosses a ray at two places of the
//! edge; the material between them is the chip on that ray, and where it ends lies on the surface that the stroke
//! found. These ends, from both families, are exact points of the surface before; joined in the order of the edge they
//! are that surface. **Uncut chip thickness** at a place of the edge is its shortest distance from there: where edge
//! and old surface run parallel, as they do within milliradians from stroke to stroke, the distance along the edge's
//! normal. In a corner of the edge, where normals cross inside the tool, it stays defined.
//!
//! Errors: ends are exact but for chords of 20 nm; between rays the old surface is straight, which costs spacing^2 / (8
//! radius), 30 nm at 0.05 mm on a radius of 10 mm; lengths of contact and areas end within half a spacing at each end
//! of a chip.

use crate::process::shaping::tool::edge_polygon::{EdgePolygon, Station};
use gearcut_core::dexel::NO_PASS;
use gearcut_core::dexel::intervals::{self, End, LEAST_SPAN_MM, Span};
use gearcut_core::frame::Rigid2;
use gearcut_core::math::planar_rays::{FAMILIES, Family, RayRow};
use glam::DVec2;

/// Crossings further apart than this many spacings are not joined: a corner of the edge lies between them.
const JOINED_SPACINGS: f64 = 4.0;

/// Added to a number between 0 and 2^51 and taken away again it leaves the nearest whole one: 1.5 times 2^52.
const ROUNDS: f64 = 6_755_399_441_055_744.0;

/// A place where a ray crosses the edge of the pass just cut, section frame.
#[derive(Debug, Clone, Copy)]
struct EdgeCrossing {
    ray: u32,
    along_mm: f64,
    /// Parameter of the edge polygon.
    parameter: f64,
    /// The place itself.
    near_mm: DVec2,
    /// Other end of the material that the edge meets here; the place itself where there is none.
    far_mm: DVec2,
    /// The edge is in material here.
    cuts: bool,
    /// The far end is the old surface and not another part of the edge.
    surface: bool,
    /// The ray crosses the edge within 60 degrees of its normal.
    square: bool,
}

/// Rays of one family with the crossings of the last pass.
#[derive(Debug)]
struct FamilyRays {
    family: Family,
    row: RayRow,
    rays: Vec<Vec<Span>>,
    /// In the order of the edge.
    crossings: Vec<EdgeCrossing>,
    by_ray: Vec<Vec<u32>>,
    zone: Vec<Vec<f64>>,
    touched: std::ops::Range<usize>,
    /// Rays from which the last pass took material, with the number of spans that each had.
    changed: Vec<(u32, u32)>,
    /// Those spans, ray after ray.
    before: Vec<Span>,
    /// Ranks of the corners that are laid, among the rays.
    ranks: Vec<f64>,
}

/// The material of one space and its neighbourhood. Frame: x mostly outwards, y mostly to larger arcs.
#[derive(Debug)]
pub struct SpaceSection<'a> {
    polygon: &'a EdgePolygon,
    spacing_mm: f64,
    sides: [FamilyRays; 2],
    corners_mm: Vec<DVec2>,
    /// Longest run of material from the edge to the old surface that the last pass met, mm.
    deepest_mm: f64,
}

impl<'a> SpaceSection<'a> {
    /// Uncut material between `contours_mm` (closed, section frame): inside one of them, or between two, on rays
    /// through the window between two corners.
    pub fn new(polygon: &'a EdgePolygon, spacing_mm: f64, contours_mm: &[Vec<DVec2>], window_mm: [DVec2; 2]) -> Self {
        let [low, high] = window_mm;
        let sides = FAMILIES.map(|family| {
            let (from, to) = (family.across(low), family.across(high));
            let count = ((to - from) / spacing_mm).ceil().max(1.0) as usize + 1;
            let row = RayRow { first_mm: from, spacing_mm, count };
            let (mut ends, mut ranks) = (vec![Vec::new(); count], Vec::new());
            for contour_mm in contours_mm {
                lay(contour_mm, family, &row, &mut ranks, |ray, along_mm, _, _| ends[ray].push(along_mm));
            }
            let rays = ends.into_iter().map(blank_spans).collect();
            FamilyRays {
                family,
                row,
                rays,
                crossings: Vec::new(),
                by_ray: vec![Vec::new(); count],
                zone: vec![Vec::new(); count],
                touched: 0..0,
                changed: Vec::new(),
                before: Vec::new(),
                ranks,
            }
        });
        Self { polygon, spacing_mm, sides, corners_mm: Vec::new(), deepest_mm: 0.0 }
    }

    /// Cuts with a tooth at a pose; gives the chip's area, mm^2.
    pub fn cut(&mut self, section_from_blade: &Rigid2) -> f64 {
        self.corners_mm.clear();
        self.corners_mm.extend(self.polygon.corners_mm.iter().map(|&p| section_from_blade.point(p)));
        let zone = self.polygon.tip_zone_mm.map(|p| section_from_blade.point(p));
        self.deepest_mm = 0.0;
        let edge_chords = self.polygon.edge_chords() as f64;
        let mut length_mm = 0.0;
        for side in &mut self.sides {
            let (taken_mm, deepest_mm) = side.cut(&self.corners_mm, &zone, edge_chords);
            length_mm += taken_mm;
            self.deepest_mm = self.deepest_mm.max(deepest_mm);
        }
        length_mm * self.spacing_mm
    }

    /// Gives back what the last cut took: the material is as if that had never been. Chip thickness can still be asked.
    pub fn put_back(&mut self) {
        for side in &mut self.sides {
            let mut from = 0;
            for (ray, count) in side.changed.drain(..) {
                let to = from + count as usize;
                let spans = &mut side.rays[ray as usize];
                spans.clear();
                spans.extend_from_slice(&side.before[from..to]);
                from = to;
            }
        }
    }

    /// Area of material in the window by each family, mm^2, between two coordinates along the rays.
    #[cfg(feature = "testing")]
    pub fn areas_mm2(&self, window_mm: [DVec2; 2]) -> [f64; 2] {
        [0, 1].map(|f| {
            let side = &self.sides[f];
            let [low, high] = window_mm.map(|p| side.family.along(p));
            side.rays.iter().map(|spans| intervals::overlap_mm(spans, low, high)).sum::<f64>() * self.spacing_mm
        })
    }

    /// Uncut chip thickness at every station for the pass just cut, mm; 0 where the edge meets no material.
    pub fn thickness_mm(&self, section_from_blade: &Rigid2, thickness_mm: &mut Vec<f64>) {
        thickness_mm.clear();
        let mut at = [0; 2];
        for station in &self.polygon.stations {
            // Both stand in the order of the edge: from station to station there are few steps or none.
            for (side, at) in self.sides.iter().zip(&mut at) {
                *at += side.crossings[*at..].iter().take_while(|c| c.parameter <= station.parameter).count();
            }
            thickness_mm.push(self.thickness_at_mm(station, section_from_blade, at));
        }
    }

    /// `after`: for both families, the number of crossings before the station.
    fn thickness_at_mm(&self, station: &Station, section_from_blade: &Rigid2, after: [usize; 2]) -> f64 {
        let normal = section_from_blade.direction(station.normal);
        // The family that crosses the edge more squarely says whether it is in material.
        let square = usize::from(normal.x.abs() < normal.y.abs());
        let side = &self.sides[square];
        let point = section_from_blade.point(station.point_mm);
        let joined_mm = JOINED_SPACINGS * self.spacing_mm;
        let neighbours = [after[square].checked_sub(1), Some(after[square])].into_iter().flatten();
        let met = neighbours
            .filter_map(|i| side.crossings.get(i))
            .filter(|c| c.near_mm.distance_squared(point) < joined_mm * joined_mm && c.cuts);
        // The length through the chip along the normal, as the rays beside the station have it.
        let through = |c: &EdgeCrossing| (c.far_mm - c.near_mm).dot(normal).abs();
        let shorter =
            |length_mm: Option<f64>, c: &EdgeCrossing| Some(length_mm.map_or(through(c), |w: f64| w.min(through(c))));
        let Some(through_mm) = met.clone().fold(None, shorter) else { return 0.0 };
        let to_surface_mm = met.filter(|c| c.surface).fold(None, shorter).unwrap_or(f64::INFINITY);
        let nearest_mm = self.sides.iter().zip(after).fold(to_surface_mm, |best_mm, (side, after)| {
            side.distance_mm(point, after, best_mm, self.deepest_mm, joined_mm)
        });
        // A chip that is all between edges of the same tooth meets no old surface; it is as thick as the length through
        // it. Old surface farther away than any run of this stroke is that of another chip.
        if nearest_mm <= self.deepest_mm.max(through_mm) { nearest_mm } else { through_mm }
    }
}

impl FamilyRays {
    /// Takes the tooth away; gives the length removed in this family's zone and the longest run from edge to old
    /// surface, mm.
    fn cut(&mut self, corners_mm: &[DVec2], zone_mm: &[DVec2; 3], edge_chords: f64) -> (f64, f64) {
        for ray in self.touched.clone() {
            self.by_ray[ray].clear();
            self.zone[ray].clear();
        }
        self.crossings.clear();
        self.changed.clear();
        self.before.clear();
        let (mut first, mut last) = (usize::MAX, 0);
        let (crossings, by_ray) = (&mut self.crossings, &mut self.by_ray);
        let family = self.family;
        let row = self.row;
        lay(corners_mm, family, &row, &mut self.ranks, |ray, along_mm, parameter, square| {
            first = first.min(ray);
            last = last.max(ray + 1);
            by_ray[ray].push(crossings.len() as u32);
            let near_mm = family.point(along_mm, row.at_mm(ray));
            let square = square && parameter < edge_chords;
            let (ray, cuts, surface) = (ray as u32, false, false);
            crossings.push(EdgeCrossing { ray, along_mm, parameter, near_mm, far_mm: near_mm, cuts, surface, square });
        });
        let zone = &mut self.zone;
        lay(zone_mm, family, &row, &mut self.ranks, |ray, along_mm, _, _| {
            first = first.min(ray);
            last = last.max(ray + 1);
            zone[ray].push(along_mm);
        });
        self.touched = first.min(last)..last;
        let (mut taken_mm, mut deepest_mm) = (0.0, 0.0_f64);
        for ray in self.touched.clone() {
            let spans = &mut self.rays[ray];
            let ids = &mut self.by_ray[ray];
            if spans.is_empty() || ids.is_empty() {
                continue;
            }
            ids.sort_unstable_by(|&a, &b| {
                crossings[a as usize].along_mm.total_cmp(&crossings[b as usize].along_mm).then(a.cmp(&b))
            });
            let zone = match self.zone[ray][..] {
                [a, b] => [a.min(b), a.max(b)],
                _ => [0.0, 0.0],
            };
            for pair in ids.as_chunks::<2>().0 {
                let [from, to] = pair.map(|id| crossings[id as usize].along_mm);
                if !intervals::overlaps(spans, from, to) {
                    continue;
                }
                if self.changed.last().is_none_or(|(last, _)| *last != ray as u32) {
                    self.changed.push((ray as u32, spans.len() as u32));
                    self.before.extend_from_slice(spans);
                }
                let entering = spans.partition_point(|s| s.high.at_mm <= from + LEAST_SPAN_MM);
                if let Some(span) = spans.get(entering).filter(|s| s.low.at_mm <= from) {
                    let met = &mut crossings[pair[0] as usize];
                    meet(met, family, &row, span.high.at_mm.min(to), span.high.at_mm <= to, &mut deepest_mm);
                }
                let leaving = spans.partition_point(|s| s.low.at_mm < to - LEAST_SPAN_MM);
                if let Some(span) = leaving.checked_sub(1).map(|i| spans[i]).filter(|s| s.high.at_mm >= to) {
                    let met = &mut crossings[pair[1] as usize];
                    meet(met, family, &row, span.low.at_mm.max(from), span.low.at_mm >= from, &mut deepest_mm);
                }
                let in_zone_mm =
                    intervals::overlap_mm(spans, from.max(zone[0]), to.min(zone[1]).max(from.max(zone[0])));
                // Rays along the space count inside the tip zone, those across it outside.
                taken_mm += match family {
                    Family::X => in_zone_mm,
                    Family::Y => intervals::overlap_mm(spans, from, to) - in_zone_mm,
                };
                let end = |at_mm| End { at_mm, pass: NO_PASS, normal: [0.0; 2] };
                intervals::subtract(spans, end(from), end(to));
            }
        }
        // Rays that run along the edge find the old surface far away, where others find it too; the chords that close
        // the tooth are no edge.
        self.crossings.retain(|c| c.square);
        (taken_mm, deepest_mm)
    }

    /// Shortest distance of a point to the old surface, as far as it is below `best_mm`.
    fn distance_mm(&self, point: DVec2, after: usize, best_mm: f64, deepest_mm: f64, joined_mm: f64) -> f64 {
        let mut best_mm = best_mm;
        let crossings = &self.crossings;
        let mut look = |a: &EdgeCrossing, b: &EdgeCrossing| {
            let on_surface = |c: &EdgeCrossing| c.surface || !c.cuts;
            let joined = a.near_mm.distance_squared(b.near_mm) < joined_mm * joined_mm;
            if joined && (a.surface || b.surface) && on_surface(a) && on_surface(b) {
                best_mm = best_mm.min(distance_to_chord_mm(point, a.far_mm, b.far_mm));
            } else if a.surface {
                best_mm = best_mm.min(a.far_mm.distance(point));
            }
            // Further on, old surface can come no nearer than the edge there less the longest run.
            a.near_mm.distance(point) - deepest_mm < best_mm
        };
        for i in (0..after.min(crossings.len())).rev() {
            if !look(&crossings[i], crossings.get(i + 1).unwrap_or(&crossings[i])) {
                break;
            }
        }
        for i in after..crossings.len() {
            if !look(&crossings[i], crossings.get(i + 1).unwrap_or(&crossings[i])) {
                break;
            }
        }
        best_mm
    }
}

fn meet(crossing: &mut EdgeCrossing, family: Family, row: &RayRow, far_mm: f64, surface: bool, deepest_mm: &mut f64) {
    crossing.far_mm = family.point(far_mm, row.at_mm(crossing.ray as usize));
    crossing.cuts = true;
    crossing.surface = surface;
    if surface && crossing.square {
        *deepest_mm = deepest_mm.max((far_mm - crossing.along_mm).abs());
    }
}

fn distance_to_chord_mm(point: DVec2, a: DVec2, b: DVec2) -> f64 {
    let chord = b - a;
    let share = ((point - a).dot(chord) / chord.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    point.distance(a + share * chord)
}

fn blank_spans(mut ends_mm: Vec<f64>) -> Vec<Span> {
    ends_mm.sort_unstable_by(f64::total_cmp);
    let end = |at_mm| End { at_mm, pass: NO_PASS, normal: [0.0; 2] };
    ends_mm.as_chunks::<2>().0.iter().map(|&[low, high]| Span { low: end(low), high: end(high) }).collect()
}

/// Calls `meet` with every crossing of a closed polygon with the rays, in the polygon's order: ray, coordinate along
/// it, parameter of the polygon, and whether the ray stands within 60 degrees of the chord's normal. Every ray is
/// crossed an even number of times, because which rays a chord crosses follows from the ranks of its corners alone.
fn lay(
    corners_mm: &[DVec2],
    family: Family,
    row: &RayRow,
    ranks: &mut Vec<f64>,
    mut meet: impl FnMut(usize, f64, f64, bool),
) {
    // All ranks first, without a branch or a cast: most chords lie between two rays, and this is what they cost.
    let (per_mm, count) = (1.0 / row.spacing_mm, row.count as f64);
    let rank = |p: &DVec2| {
        let place = ((family.across(*p) - row.first_mm) * per_mm).max(0.0).min(count);
        let nearest = (place + ROUNDS) - ROUNDS;
        if nearest < place { nearest + 1.0 } else { nearest }
    };
    ranks.clear();
    ranks.extend(corners_mm.iter().map(rank));
    let Some(&first) = corners_mm.first() else { return };
    ranks.push(ranks[0]);
    for (chord, (ends, &a)) in ranks.windows(2).zip(corners_mm).enumerate() {
        let [rank_a, rank_b] = [ends[0], ends[1]];
        if rank_a == rank_b {
            continue;
        }
        let b = corners_mm.get(chord + 1).copied().unwrap_or(first);
        let (across, along) = (family.across(a), family.along(a));
        let (rise, run) = (family.across(b) - across, family.along(b) - along);
        let square = 3.0 * rise * rise > run * run;
        let mut one = |ray: usize| {
            let share = ((row.at_mm(ray) - across) / rise).clamp(0.0, 1.0);
            meet(ray, along + share * run, chord as f64 + share, square);
        };
        let [rank_a, rank_b] = [rank_a, rank_b].map(|rank| rank as usize);
        if rank_a < rank_b {
            (rank_a..rank_b).for_each(&mut one);
        } else {
            (rank_b..rank_a).rev().for_each(&mut one);
        }
    }
}
