//! The target's transverse section as one closed polygon: flanks, roots and tip lands as finishing leaves them in the
//! limit of many strokes.
//!
//! In: points of the chain, counter-clockwise, and the stock's back. Out: area, material on rays, signed distances;
//! what the blank field is judged against, by formulas that share nothing with it.
//!
//! Where a part of the chain runs on past its crossing with the next one, the little loop that they form runs clockwise
//! round air, on a ring counter-clockwise. Material of an external gear is therefore where the winding number is
//! positive, that of a ring where it is not, and nothing has to be trimmed.

use gearcut_core::dexel::intervals;
use gearcut_core::gear::{Back, GearKind};
use gearcut_core::math::planar_rays::{Family, RayRow};
use glam::DVec2;

/// Edge length of the buckets in which segments are looked up, mm.
const BUCKET_MM: f64 = 0.5;

/// Closed polygon with an index of its segments.
#[derive(Debug, Clone)]
pub struct TargetOutline {
    points_mm: Vec<DVec2>,
    back: Back,
    low_mm: DVec2,
    columns: usize,
    buckets: Vec<Vec<u32>>,
}

impl TargetOutline {
    /// Polygon through points, counter-clockwise, and the stock's other side; the last point is joined to the first.
    ///
    /// # Panics
    /// Fewer than three points.
    pub fn new(points_mm: Vec<DVec2>, back: Back) -> Self {
        assert!(points_mm.len() >= 3, "an outline encloses something");
        let low = points_mm.iter().copied().reduce(DVec2::min).unwrap_or_default() - BUCKET_MM;
        let high = points_mm.iter().copied().reduce(DVec2::max).unwrap_or_default() + BUCKET_MM;
        let [columns, rows] = ((high - low) / BUCKET_MM).ceil().to_array().map(|n| n as usize + 1);
        let mut outline = Self { points_mm, back, low_mm: low, columns, buckets: vec![Vec::new(); columns * rows] };
        for index in 0..outline.points_mm.len() {
            let [a, b] = outline.segment(index);
            let [from, to] = [a.min(b), a.max(b)].map(|p| outline.bucket(p));
            for row in from[1]..=to[1] {
                for column in from[0]..=to[0] {
                    outline.buckets[row * columns + column].push(index as u32);
                }
            }
        }
        outline
    }

    /// The polygon's points.
    #[cfg(feature = "testing")]
    pub fn points_mm(&self) -> &[DVec2] {
        &self.points_mm
    }

    /// The stock's other side.
    pub fn back(&self) -> Back {
        self.back
    }

    fn segment(&self, index: usize) -> [DVec2; 2] {
        [self.points_mm[index], self.points_mm[(index + 1) % self.points_mm.len()]]
    }

    fn bucket(&self, p: DVec2) -> [usize; 2] {
        let rows = self.buckets.len() / self.columns;
        let cell = ((p - self.low_mm) / BUCKET_MM).max(DVec2::ZERO);
        [(cell.x as usize).min(self.columns - 1), (cell.y as usize).min(rows - 1)]
    }

    /// Area that the polygon encloses, mm2, loops round air taken off.
    pub fn area_mm2(&self) -> f64 {
        0.5 * (0..self.points_mm.len()).map(|i| self.segment(i)).map(|[a, b]| a.perp_dot(b)).sum::<f64>()
    }

    /// How far the area by rays of a family may be off, mm2: half a spacing times the length of the outline along the
    /// rays. The midpoint rule errs by no more than that times the total variation of the length that it sums.
    pub fn area_bound_mm2(&self, family: Family, spacing_mm: f64) -> f64 {
        let length_mm: f64 =
            (0..self.points_mm.len()).map(|i| self.segment(i)).map(|[a, b]| family.along(b - a).abs()).sum();
        0.5 * spacing_mm * length_mm
    }

    /// Area of the target's section, between the polygon and the back, mm2.
    pub fn section_mm2(&self) -> f64 {
        self.back.section_mm2(self.area_mm2())
    }

    /// How far the section by rays of a family may be off, mm2: the back adds four radii of length along the rays.
    pub fn section_bound_mm2(&self, family: Family, spacing_mm: f64) -> f64 {
        self.area_bound_mm2(family, spacing_mm) + 2.0 * self.back.radius_mm * spacing_mm
    }

    /// Material on the rays of a family, between the polygon and the back.
    pub fn spans(&self, family: Family, row: &RayRow) -> Vec<Vec<[f64; 2]>> {
        let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); row.count];
        for index in 0..self.points_mm.len() {
            let [a, b] = self.segment(index);
            let [from, to] = [a, b].map(|p| family.across(p));
            let rays = row.first_at_or_above(from.min(to))..row.first_at_or_above(from.max(to));
            for ray in rays {
                let share = (row.at_mm(ray) - from) / (to - from);
                let along = family.along(a) + share * family.along(b - a);
                crossings[ray].push((along, if to > from { 1 } else { -1 }));
            }
        }
        // Counter-clockwise, an edge that climbs across rays along x has the material at smaller x; for rays along y it
        // is the other way round.
        let enters = if family == Family::X { -1 } else { 1 };
        crossings
            .into_iter()
            .enumerate()
            .map(|(ray, mut crossings)| {
                crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
                let mut spans: Vec<[f64; 2]> = Vec::new();
                let mut winding = 0;
                for (along, turn) in crossings {
                    let before = winding;
                    winding += turn * enters;
                    match (before > 0, winding > 0) {
                        (false, true) => spans.push([along, along]),
                        (true, false) => spans.last_mut().expect("entered before")[1] = along,
                        _ => {}
                    }
                }
                self.material(spans, row.at_mm(ray))
            })
            .collect()
    }

    /// What of a ray is material, from what of it the polygon encloses.
    fn material(&self, enclosed: Vec<[f64; 2]>, at_mm: f64) -> Vec<[f64; 2]> {
        let half_mm = self.back.half_chord_mm(at_mm);
        let long = |[low, high]: &[f64; 2]| high - low > intervals::LEAST_SPAN_MM;
        match self.back.kind {
            GearKind::External if half_mm == 0.0 => enclosed,
            GearKind::External => {
                let keep = |[low, high]: [f64; 2]| [[low, high.min(-half_mm)], [low.max(half_mm), high]];
                enclosed.into_iter().flat_map(keep).filter(long).collect()
            }
            // Between the ends of the chord and of the holes in it.
            GearKind::Internal => {
                let starts = [-half_mm].into_iter().chain(enclosed.iter().map(|hole| hole[1].min(half_mm)));
                let ends = enclosed.iter().map(|hole| hole[0].max(-half_mm)).chain([half_mm]);
                starts.zip(ends).map(|(low, high)| [low, high]).filter(long).collect()
            }
        }
    }

    /// Distance of a point from the outline, mm: positive outside the target, negative inside; at most `limit_mm` is
    /// looked for.
    pub fn distance_mm(&self, p: DVec2, limit_mm: f64) -> Option<f64> {
        let [column, row] = self.bucket(p);
        let rows = self.buckets.len() / self.columns;
        let mut best: Option<(f64, f64)> = None;
        // The last ring holds all buckets, wherever the point is.
        for ring in 0..=self.columns.max(rows) {
            let reached_mm = (ring as f64 - 1.0) * BUCKET_MM;
            if reached_mm > limit_mm || best.is_some_and(|(distance, _)| distance < reached_mm) {
                break;
            }
            let (left, right) = (column.saturating_sub(ring), (column + ring).min(self.columns - 1));
            for r in row.saturating_sub(ring)..=(row + ring).min(rows - 1) {
                let edge = r + ring == row || r == row + ring;
                let step = if edge || ring == 0 { 1 } else { (right - left).max(1) };
                for c in (left..=right).step_by(step) {
                    for &index in &self.buckets[r * self.columns + c] {
                        let found = signed_distance(self.segment(index as usize), p);
                        // Both segments of a corner are as near; the one that is squarer to the way there has the side.
                        if best.is_none_or(|b| found.0 < b.0 || found.0 == b.0 && found.1.abs() > b.1.abs()) {
                            best = Some(found);
                        }
                    }
                }
            }
        }
        let sign = self.back.kind.tip_sign();
        best.filter(|(distance, _)| *distance <= limit_mm).map(|(distance, side)| sign * distance * side.signum())
    }
}

/// Distance from a segment, and how far the point is beside its line, mm, positive on the right.
fn signed_distance([a, b]: [DVec2; 2], p: DVec2) -> (f64, f64) {
    let along = b - a;
    let share = ((p - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    let foot = if share == 1.0 { b } else { a + share * along };
    (p.distance(foot), -along.normalize_or_zero().perp_dot(p - a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearcut_core::math::planar_rays::FAMILIES;

    fn square_with_loop() -> TargetOutline {
        // A square of 10 mm whose corner at (10, 10) carries a clockwise loop of 1 mm outside.
        let points = [
            (0.0, 0.0),
            (10.0, 0.0),
            (10.0, 10.0),
            (10.0, 11.0),
            (11.0, 11.0),
            (11.0, 10.0),
            (10.0, 10.0),
            (0.0, 10.0),
        ];
        TargetOutline::new(points.map(|(x, y)| DVec2::new(x, y)).to_vec(), Back::bore(0.0))
    }

    #[test]
    fn loops_that_run_backwards_hold_no_material() {
        let outline = square_with_loop();
        assert_eq!(outline.area_mm2(), 99.0);
        let row = RayRow { first_mm: 0.5, spacing_mm: 1.0, count: 11 };
        for family in FAMILIES {
            let spans = outline.spans(family, &row);
            assert!(spans[..10].iter().all(|s| *s == [[0.0, 10.0]]), "{family:?}: {spans:?}");
            assert!(spans[10].is_empty());
        }
    }

    #[test]
    fn distances_are_signed_and_found_across_buckets() {
        let points = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(|(x, y)| DVec2::new(x, y));
        let outline = TargetOutline::new(points.to_vec(), Back::bore(0.0));
        let at = |x, y| outline.distance_mm(DVec2::new(x, y), 20.0).expect("near");
        assert!((at(5.0, 3.0) + 3.0).abs() < 1e-12 && (at(5.0, -2.0) - 2.0).abs() < 1e-12);
        assert!((at(13.0, 14.0) - 5.0).abs() < 1e-12, "from the corner");
        assert!((at(9.9, 9.9) + 0.1).abs() < 1e-12);
        assert_eq!(outline.distance_mm(DVec2::new(5.0, 5.0), 1.0), None);
    }

    /// A square hole of 10 mm in a disc of 20 mm: material and air change places.
    #[test]
    fn a_ring_is_what_its_hole_leaves_of_the_disc() {
        let points = [(-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)].map(|(x, y)| DVec2::new(x, y));
        let outline = TargetOutline::new(points.to_vec(), Back::ring(10.0));
        assert!((outline.section_mm2() - (100.0 * std::f64::consts::PI - 100.0)).abs() < 1e-12);
        let row = RayRow { first_mm: 3.0, spacing_mm: 3.0, count: 3 };
        for family in FAMILIES {
            let spans = outline.spans(family, &row);
            let half = |at: f64| (100.0 - at * at).sqrt();
            assert_eq!(spans[0], [[-half(3.0), -5.0], [5.0, half(3.0)]]);
            assert_eq!(spans[1], [[-half(6.0), half(6.0)]], "beside the hole");
            assert_eq!(spans[2], [[-half(9.0), half(9.0)]]);
        }
        let at = |x| outline.distance_mm(DVec2::new(x, 0.0), 20.0).expect("near");
        assert!((at(3.0) - 2.0).abs() < 1e-12 && (at(6.0) + 1.0).abs() < 1e-12);
    }
}
