//! Curves of passes as the kernel reads them: parts that the rays of a tile cross.
//!
//! In: a closed curve and a range of rays. Out: [`BlankPart`]s in f32, places across the rays from the tile's first
//! one.

use crate::records::BlankPart;
use gearcut_core::math::planar_rays::{ClosedCurve, Family, RayCrossings, RayRow};
use std::ops::Range;

/// More than rounding moves a ray and a node against each other: an ulp of f32 is 8 nm up to 128 mm from a tile's first
/// ray, where tiles of rays 2 mm apart end.
const MARGIN_MM: f64 = 2e-5;

/// The parts of a curve that rays of a tile cross; in f64 until the last subtraction. None: no ray comes near.
///
/// Rounded to f32 a node may change sides with a ray beside it. Neighbouring parts share the rounded node, so that the
/// ray crosses one of them still, and crossings come in pairs as long as both are there: parts are taken along that
/// come within [`MARGIN_MM`] of a ray.
pub fn parts(
    crossings: &mut RayCrossings,
    curve: &impl ClosedCurve,
    family: Family,
    row: &RayRow,
    rays: Range<usize>,
) -> Vec<BlankPart> {
    let origin_mm = row.at_mm(rays.start);
    crossings.lay_within(curve, family, row, rays, MARGIN_MM);
    let single = |c: [f64; 4]| c.map(|c| c as f32);
    crossings
        .cubics(curve, family)
        .map(|cubic| {
            let mut across = cubic.across;
            across[0] -= origin_mm;
            BlankPart {
                along: single(cubic.along),
                across: single(across),
                across_end_mm: (cubic.across_end_mm - origin_mm) as f32,
                ..bytemuck::Zeroable::zeroed()
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearcut_core::math::planar_rays::Piece;
    use glam::DVec2;

    struct Polygon {
        pieces: Vec<Piece>,
        nodes_mm: Vec<DVec2>,
    }

    impl ClosedCurve for Polygon {
        fn pieces(&self) -> &[Piece] {
            &self.pieces
        }
        fn node_mm(&self, index: usize) -> DVec2 {
            self.nodes_mm[index]
        }
        fn place(&self, _law: u32, _parameter: f64) -> [DVec2; 2] {
            [DVec2::ZERO; 2]
        }
        fn tangents(&self, _index: usize) -> [DVec2; 2] {
            [DVec2::ZERO; 2]
        }
    }

    /// Rays of a tile that cross an odd number of parts, as the shader counts.
    fn odd_rays(parts: &[BlankPart], row: &RayRow, rays: usize) -> usize {
        let odd = |ray: &usize| {
            let at_mm = *ray as f32 * row.spacing_mm as f32;
            let crosses = |part: &&BlankPart| {
                let (a, b) = (part.across[0], part.across_end_mm);
                a.min(b) <= at_mm && at_mm < a.max(b)
            };
            parts.iter().filter(crosses).count() % 2 == 1
        };
        (0..rays).filter(odd).count()
    }

    #[test]
    fn rays_cross_in_pairs_where_nodes_stand_beside_them() {
        let row = RayRow { first_mm: -60.25, spacing_mm: 0.3, count: 400 };
        let (mut alone, mut laid) = (0, RayCrossings::default());
        for turn in 0..40 {
            // Nodes within two nanometres of the rays, on both sides, on a zigzag up one side and down the other.
            let beside = |ray: usize, k: usize| row.at_mm(ray) + 1e-7 * f64::from((7 * k as i32 + turn) % 41 - 20);
            let up = (0..60).map(|k| DVec2::new(30.0, beside(100 + k, k)));
            let down = (0..60).rev().map(|k| DVec2::new(20.0, beside(100 + k, k + 3)));
            let nodes_mm: Vec<DVec2> = up.chain(down).collect();
            let straight = Piece { law: Piece::STRAIGHT, range: [0.0, 1.0], sagitta_mm: 0.0 };
            let curve = Polygon { pieces: vec![straight; nodes_mm.len()], nodes_mm };
            for first in [96, 128] {
                let rays = first..first + 64;
                assert_eq!(odd_rays(&parts(&mut laid, &curve, Family::X, &row, rays.clone()), &row, 64), 0);
                // Alive: without the margin some part is missing.
                laid.lay(&curve, Family::X, &row, rays);
                let origin_mm = row.at_mm(first);
                let bare: Vec<BlankPart> = laid
                    .cubics(&curve, Family::X)
                    .map(|cubic| BlankPart {
                        across: [(cubic.across[0] - origin_mm) as f32, 0.0, 0.0, 0.0],
                        across_end_mm: (cubic.across_end_mm - origin_mm) as f32,
                        ..bytemuck::Zeroable::zeroed()
                    })
                    .collect();
                alone += odd_rays(&bare, &row, 64);
            }
        }
        println!("{alone} rays would cross an odd number");
        assert!(alone > 0);
    }
}
