//! Areas of the plane seen from above, such as the transverse sections of two gears in mesh: a frame of an animation.
//!
//! In: areas as closed polygons in mm, each with a colour, marked points, a window and words. Out: a frame.
//!
//! Law: a point belongs to an area where a ray from it crosses the area's polygons an odd number of times, so a ring is
//! an outline and a circle round it. Every pixel is looked at on 3 by 3 places.

use glam::DVec2;

use crate::output::apng::AnimationFrame;
use crate::output::canvas::{Align, Canvas, INK};
use crate::output::raster::Raster;
use gearcut_core::{Error, Result};

/// Places in a pixel along each side.
const FINER: usize = 3;
/// Height of the words below the picture, pixels.
const BELOW_PX: u32 = 34;
const EM_PX: f64 = 15.0;
/// Half the side of a marked point, pixels.
const MARK_PX: f64 = 3.0;

/// What a frame shows.
#[derive(Debug, Clone, PartialEq)]
pub struct RollingPicture {
    /// Colour and polygons of every area, the last one on top.
    pub areas: Vec<([u8; 3], Vec<Vec<DVec2>>)>,
    /// Points that are marked, mm.
    pub marks_mm: Vec<DVec2>,
    /// Colour of the marks.
    pub mark_colour: [u8; 3],
    /// Lower left and upper right corner, mm.
    pub window_mm: [DVec2; 2],
    /// Width without the words, pixels; the height follows from the window.
    pub width_px: u32,
    /// Words below.
    pub words: String,
}

impl RollingPicture {
    /// Draws the frame.
    ///
    /// # Errors
    /// Words that the font does not have.
    pub fn frame(&self) -> Result<AnimationFrame> {
        self.draw().map(AnimationFrame).map_err(|reason| Error::Output { path: "frame".into(), reason })
    }

    fn draw(&self) -> std::result::Result<Raster, String> {
        let [low, high] = self.window_mm;
        let px_per_mm = f64::from(self.width_px) / (high.x - low.x);
        let height_px = ((high.y - low.y) * px_per_mm).round() as u32;
        let mut raster = Raster::white((self.width_px, height_px + BELOW_PX));
        let in_px = |p: &DVec2| DVec2::new((p.x - low.x) * px_per_mm, (high.y - p.y) * px_per_mm);
        for (colour, polygons) in &self.areas {
            let polygons: Vec<Vec<DVec2>> =
                polygons.iter().map(|polygon| polygon.iter().map(in_px).collect()).collect();
            fill(&mut raster, (self.width_px, height_px), &polygons, *colour);
        }
        let mut canvas = Canvas(&mut raster);
        for mark in self.marks_mm.iter().map(in_px) {
            let [from, to] = [mark - MARK_PX, mark + MARK_PX];
            canvas.fill((from.x, from.y), (to.x, to.y), self.mark_colour);
        }
        let bottom = f64::from(height_px);
        canvas.frame((0.0, 0.0), (f64::from(self.width_px) - 1.0, bottom - 1.0), INK);
        canvas.text(&self.words, (8.0, bottom + 0.5 * f64::from(BELOW_PX)), EM_PX, Align::Start)?;
        Ok(raster)
    }
}

/// Fills an area, blended by how many places of each pixel belong to it.
fn fill(raster: &mut Raster, (width, height): (u32, u32), polygons: &[Vec<DVec2>], colour: [u8; 3]) {
    let columns = width as usize * FINER;
    let crossings = crossings(polygons, height as usize);
    let mut hits = vec![0_u8; width as usize];
    for (y, lines) in crossings.chunks_exact(FINER).enumerate() {
        hits.fill(0);
        for pair in lines.iter().flat_map(|line| line.chunks_exact(2)) {
            let [from, to] = [pair[0], pair[1]]
                .map(|x| (x * FINER as f64 - 0.5).ceil().clamp(0.0, columns as f64) as usize)
                .map(|column| (column / FINER, (column % FINER) as u8));
            if from.0 == to.0 {
                if from.0 < hits.len() {
                    hits[from.0] += to.1 - from.1;
                }
                continue;
            }
            for count in &mut hits[from.0..to.0] {
                *count += FINER as u8;
            }
            hits[from.0] -= from.1;
            if to.1 > 0 {
                hits[to.0] += to.1;
            }
        }
        for (x, &count) in hits.iter().enumerate().filter(|(_, count)| **count > 0) {
            raster.blend((x as i32, y as i32), colour, f64::from(count) / (FINER * FINER) as f64);
        }
    }
}

/// Where the polygons cross each line of places, from left to right; a side is looked at on the lines that it reaches.
fn crossings(polygons: &[Vec<DVec2>], height: usize) -> Vec<Vec<f64>> {
    let mut lines = vec![Vec::new(); height * FINER];
    let count = lines.len() as f64;
    for polygon in polygons {
        for (i, a) in polygon.iter().enumerate() {
            let b = polygon[(i + 1) % polygon.len()];
            let reach = |y: f64| (y * FINER as f64).clamp(0.0, count) as usize;
            let (first, last) = (reach(a.y.min(b.y)).saturating_sub(1), (reach(a.y.max(b.y)) + 1).min(lines.len()));
            for (line, crossings) in lines.iter_mut().enumerate().take(last).skip(first) {
                let at = (line / FINER) as f64 + ((line % FINER) as f64 + 0.5) / FINER as f64;
                if (a.y <= at) != (b.y <= at) {
                    crossings.push(a.x + (at - a.y) / (b.y - a.y) * (b.x - a.x));
                }
            }
        }
    }
    for line in &mut lines {
        line.sort_unstable_by(f64::total_cmp);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(half: f64) -> Vec<DVec2> {
        [[-half, -half], [half, -half], [half, half], [-half, half]].map(DVec2::from).into()
    }

    #[test]
    fn areas_have_their_size_and_holes_are_empty() {
        let picture = RollingPicture {
            areas: vec![([0, 0, 0], vec![square(10.0), square(4.0)])],
            marks_mm: Vec::new(),
            mark_colour: [255, 0, 0],
            window_mm: [DVec2::splat(-16.0), DVec2::splat(16.0)],
            width_px: 320,
            words: String::new(),
        };
        let raster = picture.draw().expect("a frame");
        let inside = |x: usize, y: usize| raster.rgb[3 * (320 * y + x)] == 0;
        let black = (1..319).flat_map(|x| (1..319).map(move |y| (x, y))).filter(|&(x, y)| inside(x, y)).count();
        // 200 by 200 pixels less 80 by 80.
        assert_eq!(black, 40_000 - 6_400);
        assert!(!inside(160, 160) && inside(80, 160) && !inside(40, 160));
    }
}
