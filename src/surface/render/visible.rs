//! Which triangle every ray of the camera meets first, found triangle by triangle.
//!
//! In: the triangles of a tree, a camera, rays per pixel. Out: [`Visible`], which gives the hits of a band of pixel
//! rows, in the order of its rays. The camera's rays are parallel and even, so that a triangle covers a run of rays in
//! every row of them: each is asked for the rays that it covers alone, where a walk through the tree asks some eighteen
//! triangles for a ray. Whether and where a ray meets a triangle is the tree's own law, so that both find the same.

use super::bvh::{Bvh, Hit, meet};
use super::camera::Camera;
use glam::{DVec2, DVec3};
use std::ops::Range;

/// Pixel rows of a band: small enough for its hits to stay in the cache, large enough that few triangles lie in two.
const BAND_PX: u32 = 8;
/// Runs of rays are this much longer at either end than the triangle's outline, rays: rounding may not lose one.
const ROUNDING: f64 = 1e-6;

/// The rays of a picture and the triangles that each band of them may meet.
pub struct Visible<'a> {
    tree: &'a Bvh,
    camera: &'a Camera,
    /// Rays per pixel along one side.
    side: u32,
    far_mm: f64,
    /// Triangles of each band, by their places in the tree.
    bands: Vec<Vec<u32>>,
}

/// What the rays of a band meet first.
pub struct BandHits<'a> {
    rays: &'a Visible<'a>,
    /// Rows of pixels in the band.
    pub pixel_rows: Range<u32>,
    first: Vec<Option<Hit>>,
}

impl BandHits<'_> {
    /// Origin and hit of a ray, counted over the whole picture from its upper left corner; `None` where it meets
    /// nothing.
    pub fn hit(&self, x: u32, y: u32) -> Option<(DVec3, Hit)> {
        let (side, width) = (self.rays.side, self.rays.camera.size_px.0);
        let hit = self.first[((y - side * self.pixel_rows.start) * side * width + x) as usize];
        hit.map(|hit| (self.rays.origin_mm(x, y), hit))
    }
}

impl<'a> Visible<'a> {
    /// Rays of a camera, `side` by `side` per pixel, that start `far_mm` before its target.
    pub fn new(tree: &'a Bvh, camera: &'a Camera, side: u32, far_mm: f64) -> Self {
        let count = camera.size_px.1.div_ceil(BAND_PX) as usize;
        let mut this = Self { tree, camera, side, far_mm, bands: Vec::new() };
        let mut bands = vec![Vec::new(); count];
        for (index, triangle) in (0..).zip(tree.triangles()) {
            let rows = this.rows(&this.outline(triangle));
            let band = |row: i64| (row / i64::from(BAND_PX * side)) as usize;
            if !rows.is_empty() {
                bands[band(rows.start)..=band(rows.end - 1)].iter_mut().for_each(|band| band.push(index));
            }
        }
        this.bands = bands;
        this
    }

    /// Number of bands.
    pub fn bands(&self) -> usize {
        self.bands.len()
    }

    /// What the rays of a band meet first, row by row of rays; of triangles at the same distance the one that the tree
    /// holds first.
    pub fn first(&self, band: usize) -> BandHits<'_> {
        let above = band as u32 * BAND_PX;
        let pixels = above..(above + BAND_PX).min(self.camera.size_px.1);
        let [top, below] = [pixels.start, pixels.end].map(|row| i64::from(row * self.side));
        let width = i64::from(self.camera.size_px.0 * self.side);
        let mut first: Vec<Option<Hit>> = vec![None; (width * (below - top)) as usize];
        let direction = -self.camera.towards;
        for &index in &self.bands[band] {
            let triangle = &self.tree.triangles()[index as usize];
            let outline = self.outline(triangle);
            let rows = self.rows(&outline);
            for y in rows.start.max(top)..rows.end.min(below) {
                let run = run(&outline, y as f64);
                let (from, to) = (run[0].ceil().max(0.0) as i64, (run[1].floor() as i64).min(width - 1));
                for x in from..=to {
                    let Some((distance_mm, weights)) = meet(triangle, self.origin_mm(x as u32, y as u32), direction)
                    else {
                        continue;
                    };
                    let nearest = &mut first[((y - top) * width + x) as usize];
                    if distance_mm > 0.0 && nearest.is_none_or(|hit| distance_mm < hit.distance_mm) {
                        *nearest = Some(Hit { distance_mm, triangle: self.tree.number(index), weights });
                    }
                }
            }
        }
        BandHits { rays: self, pixel_rows: pixels, first }
    }

    fn origin_mm(&self, x: u32, y: u32) -> DVec3 {
        let [x_px, y_px] = [x, y].map(|place| (f64::from(place) + 0.5) / f64::from(self.side));
        self.camera.origin_mm(x_px, y_px, self.far_mm)
    }

    /// Corners in the picture, counted in rays from the ray in the upper left corner.
    fn outline(&self, &[corner, u, v]: &[DVec3; 3]) -> [DVec2; 3] {
        let rays_per_mm = f64::from(self.side) / self.camera.pixel_mm();
        let middle =
            0.5 * f64::from(self.side) * DVec2::new(self.camera.size_px.0.into(), self.camera.size_px.1.into());
        [corner, corner + u, corner + v].map(|point| {
            let d = point - self.camera.target_mm;
            middle + rays_per_mm * DVec2::new(d.dot(self.camera.right), -d.dot(self.camera.up)) - 0.5
        })
    }

    /// Rows of rays that an outline covers.
    fn rows(&self, outline: &[DVec2; 3]) -> Range<i64> {
        let heights = outline.map(|p| p.y);
        let last = i64::from(self.camera.size_px.1 * self.side) - 1;
        let low = (heights.into_iter().fold(f64::INFINITY, f64::min) - ROUNDING).ceil().max(0.0) as i64;
        let high = (heights.into_iter().fold(f64::NEG_INFINITY, f64::max) + ROUNDING).floor() as i64;
        low..high.min(last) + 1
    }
}

/// First and last place that an outline covers in a row, counted in rays; the first is the larger one where it covers
/// none.
fn run(outline: &[DVec2; 3], y: f64) -> [f64; 2] {
    let mut run = [f64::INFINITY, f64::NEG_INFINITY];
    for k in 0..3 {
        let (a, b) = (outline[k], outline[(k + 1) % 3]);
        let (above, below) = if a.y <= b.y { (a, b) } else { (b, a) };
        if y < above.y - ROUNDING || y > below.y + ROUNDING {
            continue;
        }
        let places = if below.y - above.y < ROUNDING {
            [a.x, b.x]
        } else {
            [above.x + (below.x - above.x) * ((y - above.y) / (below.y - above.y)).clamp(0.0, 1.0); 2]
        };
        run = [places.into_iter().fold(run[0], f64::min), places.into_iter().fold(run[1], f64::max)];
    }
    [run[0] - ROUNDING, run[1] + ROUNDING]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::render::bvh::numbers;

    /// Needles and flat triangles, seen from the side, edge on, and cut by the picture's rim.
    #[test]
    fn rays_find_what_walks_through_the_tree_find() {
        let mut next = numbers(11);
        let mut point = |scale: f64| DVec3::new(next() - 0.5, next() - 0.5, next() - 0.5) * scale;
        let mut triangles: Vec<[DVec3; 3]> = (0..400)
            .map(|i| {
                let corner = point(100.0);
                let narrow = if i % 3 == 0 { 0.02 } else { 12.0 };
                [corner, corner + point(narrow), corner + point(60.0)]
            })
            .collect();
        // A wall along the view, and a square that shares its edges.
        let [a, b, c, d] = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]].map(|[x, y]| DVec3::new(x, y, 40.0));
        triangles.extend([[a, b, c], [a, c, d], [a, b, a - 90.0 * DVec3::Z], [b, b - 90.0 * DVec3::Z, a]]);
        let tree = Bvh::new(&triangles);
        for towards in [DVec3::Z, DVec3::new(0.3, -0.8, 0.5)] {
            let camera = Camera::new(DVec3::ZERO, towards, DVec3::Y, 70.0, (150, 101));
            for side in [1, 2] {
                let visible = Visible::new(&tree, &camera, side, 200.0);
                let width = camera.size_px.0 * side;
                let (mut met, mut rays) = (0, 0);
                for hits in (0..visible.bands()).map(|band| visible.first(band)) {
                    let rows = hits.pixel_rows.start * side..hits.pixel_rows.end * side;
                    for (x, y) in rows.flat_map(|y| (0..width).map(move |x| (x, y))) {
                        let walked = tree.first(visible.origin_mm(x, y), -camera.towards, f64::INFINITY);
                        let hit = hits.hit(x, y).map(|(_, hit)| hit.distance_mm);
                        assert_eq!(hit, walked.map(|hit| hit.distance_mm), "ray {x}, {y}");
                        met += u32::from(hit.is_some());
                        rays += 1;
                    }
                }
                assert_eq!(rays, width * camera.size_px.1 * side);
                assert!(met > rays / 3 && met < rays, "{met} of {rays} rays met a triangle");
            }
        }
    }
}
