//! Contours that cross themselves.

use glam::DVec2;
use std::collections::HashMap;

/// Crossings of a closed contour with itself, found through a grid of 0.5 mm.
pub fn crossings(contour: &[DVec2]) -> usize {
    let count = contour.len();
    let piece = |i: usize| (contour[i], contour[(i + 1) % count]);
    let mut cells: HashMap<(i64, i64), Vec<usize>> = HashMap::new();
    for i in 0..count {
        let (a, b) = piece(i);
        let cell = |p: DVec2| ((p.x * 2.0).floor() as i64, (p.y * 2.0).floor() as i64);
        let (low, high) = (cell(a.min(b)), cell(a.max(b)));
        for x in low.0..=high.0 {
            for y in low.1..=high.1 {
                cells.entry((x, y)).or_default().push(i);
            }
        }
    }
    let side = |a: DVec2, b: DVec2, p: DVec2| (b - a).perp_dot(p - a);
    let mut found = 0;
    for pieces in cells.values() {
        for (k, &i) in pieces.iter().enumerate() {
            for &j in &pieces[k + 1..] {
                let ((a, b), (c, d)) = (piece(i), piece(j));
                let apart = i.abs_diff(j) > 1 && i.abs_diff(j) < count - 1;
                if apart && side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0 {
                    found += 1;
                }
            }
        }
    }
    found
}
