//! End faces: an area of the plane in triangles between the points of its contours and no others.
//!
//! In: points, and the contours' sides with the area on their left: any number of contours, holes and islands, in any
//! order. Out: triangles, counter-clockwise. Every side of a contour is a side of exactly one triangle, so that walls
//! lofted from the same points close with the area. Law: constrained Delaunay triangulation (L. P. Chew 1989) with
//! exact predicates; the area is what can be reached from the left of the sides without crossing one.
//!
//! Road not taken: ear clipping. It leaves out points that lie straight between others, so that walls with such points
//! stay open, and its predicates round.

use glam::DVec2;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};
use std::collections::HashSet;

/// Triangles of the area on the left of directed sides, as numbers of points. `None` where the contours cross each
/// other, two points coincide, or one is not finite: there is no such area.
pub fn triangles_inside(points_mm: &[DVec2], sides: &[[usize; 2]]) -> Option<Vec<[usize; 3]>> {
    let points = points_mm.iter().map(|p| Point2::new(p.x, p.y)).collect();
    let mut crossing = false;
    let plane = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(points, sides.to_vec(), |_| {
        crossing = true;
    })
    .ok()?;
    if crossing || plane.num_vertices() != points_mm.len() {
        return None;
    }
    let directed: HashSet<[usize; 2]> = sides.iter().copied().collect();
    let on_contour = |a: usize, b: usize| directed.contains(&[a, b]) || directed.contains(&[b, a]);
    // From the triangles on the left of the sides to all that are joined to them without crossing one.
    let mut reached = vec![false; plane.num_all_faces()];
    let mut open = Vec::new();
    for face in plane.inner_faces() {
        let [a, b, c] = face.vertices().map(|v| v.fix().index());
        if [[a, b], [b, c], [c, a]].iter().any(|side| directed.contains(side)) {
            reached[face.fix().index()] = true;
            open.push(face.fix());
        }
    }
    while let Some(face) = open.pop() {
        for edge in plane.face(face).adjacent_edges() {
            let [a, b] = edge.vertices().map(|v| v.fix().index());
            let Some(next) = edge.rev().face().as_inner() else { continue };
            if !on_contour(a, b) && !reached[next.fix().index()] {
                reached[next.fix().index()] = true;
                open.push(next.fix());
            }
        }
    }
    let inside = plane.inner_faces().filter(|face| reached[face.fix().index()]);
    Some(inside.map(|face| face.vertices().map(|v| v.fix().index())).collect())
}

/// Sides of closed contours whose points follow each other in one list, `lengths` points each.
pub fn sides_of_contours(lengths: &[usize]) -> Vec<[usize; 2]> {
    let mut sides = Vec::with_capacity(lengths.iter().sum());
    for &length in lengths {
        let first = sides.len();
        sides.extend((0..length).map(|i| [first + i, first + (i + 1) % length]));
    }
    sides
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn area_mm2(points: &[DVec2], triangles: &[[usize; 3]]) -> f64 {
        let twice = triangles.iter().map(|&[a, b, c]| (points[b] - points[a]).perp_dot(points[c] - points[a]));
        twice.inspect(|twice| assert!(*twice > 0.0, "counter-clockwise")).sum::<f64>() * 0.5
    }

    fn ring(radius_mm: f64, count: usize, sense: f64) -> impl Iterator<Item = DVec2> {
        (0..count).map(move |i| radius_mm * DVec2::from_angle(sense * TAU * i as f64 / count as f64))
    }

    /// n points on a circle of radius r enclose n r^2 sin(2 pi / n) / 2.
    #[test]
    fn rings_holes_and_islands_have_their_areas() {
        let polygon = |r: f64, n: usize| 0.5 * n as f64 * r * r * (TAU / n as f64).sin();
        let points: Vec<DVec2> = ring(30.0, 90, 1.0).chain(ring(20.0, 60, -1.0)).chain(ring(8.0, 12, 1.0)).collect();
        let sides = sides_of_contours(&[90, 60, 12]);
        let triangles = triangles_inside(&points, &sides).expect("contours lie apart");
        let expected_mm2 = polygon(30.0, 90) - polygon(20.0, 60) + polygon(8.0, 12);
        assert!((area_mm2(&points, &triangles) / expected_mm2 - 1.0).abs() < 1e-13);
        for [a, b] in sides {
            let with = triangles.iter().filter(|t| (0..3).any(|k| [t[k], t[(k + 1) % 3]] == [a, b])).count();
            assert_eq!(with, 1, "side {a} to {b}");
        }
    }

    /// A square with nine points straight along every side: none may be left out.
    #[test]
    fn points_along_straight_sides_are_kept() {
        let corners = [DVec2::ZERO, DVec2::new(10.0, 0.0), DVec2::splat(10.0), DVec2::new(0.0, 10.0)];
        let points: Vec<DVec2> =
            (0..40).map(|i| corners[i / 10].lerp(corners[(i / 10 + 1) % 4], (i % 10) as f64 / 10.0)).collect();
        let triangles = triangles_inside(&points, &sides_of_contours(&[40])).expect("a square");
        assert_eq!(triangles.len(), 38);
        assert!((area_mm2(&points, &triangles) - 100.0).abs() < 1e-12);
    }

    #[test]
    fn contours_that_cross_or_touch_have_no_area() {
        let bow = [DVec2::ZERO, DVec2::new(2.0, 2.0), DVec2::new(2.0, 0.0), DVec2::new(0.0, 2.0)];
        assert_eq!(triangles_inside(&bow, &sides_of_contours(&[4])), None);
        let twice = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::ONE];
        assert_eq!(triangles_inside(&twice, &sides_of_contours(&[4])), None);
        assert_eq!(triangles_inside(&[DVec2::ZERO, DVec2::X, DVec2::NAN], &sides_of_contours(&[3])), None);
    }
}
