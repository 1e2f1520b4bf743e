//! Words, frames and marks on a picture.
//!
//! In: points in pixels from the picture's upper left corner, text sizes in pixels per em. Out: pixels.
//!
//! The law: lines and rectangles cover whole pixels, both ends included, so that frames and ticks are sharp. Letters
//! and slanted edges are blended by the part of a pixel that they cover. A text is placed by the middle of its
//! capitals. What lies outside the picture is not drawn.
//!
//! Road not taken: a library of charts. It sets letters to whole pixels, which makes the gaps between small ones
//! uneven, and gives axis labels a fixed room, in which long ones are clipped.

use crate::output::font;
use crate::output::letters::{self, text_width_px};
use crate::output::raster::Raster;

/// Text, axes and frames.
pub(super) const INK: [u8; 3] = [34, 34, 34];
/// Background.
pub(super) const PAPER: [u8; 3] = [255, 255, 255];

/// A point of the picture, pixels from its upper left corner.
pub(super) type Point = (f64, f64);
/// Why something could not be drawn.
pub(super) type Drawn = Result<(), String>;

/// Where a text lies relative to its point, in reading direction; across it the capitals' middle is on the point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Align {
    /// The text begins at the point.
    Start,
    /// The text is centred on the point.
    Middle,
    /// The text ends at the point.
    End,
}

/// A picture that is drawn on.
pub(super) struct Canvas<'a>(pub &'a mut Raster);

impl Canvas<'_> {
    /// Filled rectangle between two corners, a line where they share a side.
    pub(super) fn fill(&mut self, upper_left: Point, lower_right: Point, colour: [u8; 3]) {
        let ((left, top), (right, bottom)) = (pixel(upper_left), pixel(lower_right));
        for (x, y) in (top..=bottom).flat_map(|y| (left..=right).map(move |x| (x, y))) {
            self.0.blend((x, y), colour, 1.0);
        }
    }

    /// Frame between two corners.
    pub(super) fn frame(&mut self, (left, top): Point, (right, bottom): Point, colour: [u8; 3]) {
        for y in [top, bottom] {
            self.fill((left, y), (right, y), colour);
        }
        for x in [left, right] {
            self.fill((x, top), (x, bottom), colour);
        }
    }

    /// Filled triangle, corners on whole pixels: column by column, with its upper and lower end blended.
    pub(super) fn triangle(&mut self, corners: [Point; 3], colour: [u8; 3]) {
        let mut corners = corners.map(pixel);
        corners.sort_unstable();
        let [first, middle, last] = corners.map(|(x, y)| (f64::from(x), f64::from(y)));
        let edge = |a: Point, b: Point, x: f64| a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0);
        for column in corners[0].0..=corners[2].0 {
            let x = f64::from(column);
            let (a, b) = if first.0 < middle.0 && x <= middle.0 { (first, middle) } else { (middle, last) };
            let (long, short) = (edge(first, last, x), edge(a, b, x));
            let (from, to) = (long.min(short), long.max(short));
            for y in from.ceil() as i32..=to.floor() as i32 {
                self.0.blend((column, y), colour, 1.0);
            }
            self.0.blend((column, from.floor() as i32), colour, from.ceil() - from);
            self.0.blend((column, to.ceil() as i32), colour, to - to.floor());
        }
    }

    /// Horizontal text.
    pub(super) fn text(&mut self, words: &str, at: Point, em_px: f64, side: Align) -> Drawn {
        self.letters(words, at, em_px, side, |x, y| (x, y))
    }

    /// Text that reads upward.
    pub(super) fn text_upward(&mut self, words: &str, at: Point, em_px: f64, side: Align) -> Drawn {
        self.letters(words, at, em_px, side, |x, y| (y, -x))
    }

    /// Draws letters from coverage gathered on a finer raster, so that the gaps between them are even.
    fn letters(
        &mut self,
        words: &str,
        at: Point,
        em_px: f64,
        side: Align,
        turned: impl Fn(i32, i32) -> (i32, i32),
    ) -> Drawn {
        /// Fine pixels per pixel.
        const FINER: i32 = 4;
        let finer = f64::from(FINER);
        // Letters are drawn with their baseline half a line height below their top.
        let up_px = em_px * (0.5 * font::LINE_HEIGHT_EM - 0.5 * font::CAPITAL_HEIGHT_EM);
        let width_px = text_width_px(words, em_px)?;
        let back_px = match side {
            Align::Start => 0.0,
            Align::Middle => 0.5 * width_px,
            Align::End => width_px,
        };
        let [fine_left, fine_top] = [-back_px, -up_px].map(|offset| (offset * finer).round() as i32);
        // Pixels that the letters can touch: the text's width, a line, and a line more for accents and descenders.
        let line_px = font::LINE_HEIGHT_EM * em_px;
        let (left, top) = (fine_left.div_euclid(FINER) - 1, fine_top.div_euclid(FINER) - (0.5 * line_px) as i32 - 1);
        let (columns, rows) = (width_px as usize + 4, (2.0 * line_px) as usize + 4);
        let mut coverage = vec![0.0; columns * rows];
        letters::draw(words, em_px * font::LINE_HEIGHT_EM * finer, |x, y, part| {
            let column = usize::try_from((x + fine_left).div_euclid(FINER) - left);
            let row = usize::try_from((y + fine_top).div_euclid(FINER) - top);
            if let (Ok(column), Ok(row)) = (column, row)
                && column < columns
                && row < rows
            {
                coverage[row * columns + column] += f64::from(part) / (finer * finer);
            }
        })?;
        let origin = pixel(at);
        for (y, row) in (top..).zip(coverage.chunks_exact(columns)) {
            for (x, &part) in (left..).zip(row) {
                let (across, down) = turned(x, y);
                self.0.blend((origin.0 + across, origin.1 + down), INK, part);
            }
        }
        Ok(())
    }
}

/// The pixel of a point.
fn pixel(point: Point) -> (i32, i32) {
    (point.0.round() as i32, point.1.round() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn white() -> Raster {
        Raster::white((60, 40))
    }

    fn ink(raster: &Raster) -> f64 {
        let darkness = |value: u8| f64::from(255 - value) / f64::from(255 - INK[0]);
        raster.rgb.iter().step_by(3).map(|&value| darkness(value)).sum()
    }

    #[test]
    fn triangles_cover_their_area() {
        let corners = [(10.0, 30.0), (50.0, 30.0), (22.0, 5.0)];
        let mut raster = white();
        Canvas(&mut raster).triangle(corners, INK);
        // Half of base times height, and a pixel more in each of 41 columns, whose ends are both included. Blending
        // rounds 80 pixels by less than a fiftieth each.
        let expected = 0.5 * 40.0 * 25.0 + 41.0;
        assert!((ink(&raster) - expected).abs() < 1.6, "{}", ink(&raster));
        assert_eq!(raster.rgb[3 * (20 * 60 + 25)], INK[0], "inside");
        assert_eq!(raster.rgb[3 * (4 * 60 + 25)], 255, "above");
    }

    #[test]
    fn what_lies_outside_is_not_drawn() {
        let mut raster = white();
        let mut canvas = Canvas(&mut raster);
        canvas.frame((-10.0, -10.0), (70.0, 50.0), INK);
        canvas.text("words far to the left", (-400.0, 20.0), 15.0, Align::Start).expect("the embedded font");
        assert_eq!(ink(&raster), 0.0);
        Canvas(&mut raster).fill((50.0, 30.0), (500.0, 300.0), INK);
        assert_eq!(ink(&raster), 10.0 * 10.0);
    }

    #[test]
    fn words_lie_about_their_point() {
        // Letters begin with their ink, not with their bearing: a word of H lies 0.1 em before its place.
        const BEARING_PX: f64 = 1.5;
        let middle = |raster: &Raster, of: fn(usize) -> usize| {
            let places: Vec<usize> = (0..60 * 40).filter(|&i| raster.rgb[3 * i] < 200).map(of).collect();
            let (low, high) = (places.iter().min().expect("ink"), places.iter().max().expect("ink"));
            0.5 * (low + high) as f64
        };
        let off = |raster: &Raster| [middle(raster, |i| i % 60) - 30.0, middle(raster, |i| i / 60) - 20.0];
        let mut level = white();
        Canvas(&mut level).text("HIH", (30.0, 20.0), 15.0, Align::Middle).expect("the embedded font");
        let mut upright = white();
        Canvas(&mut upright).text_upward("HIH", (30.0, 20.0), 15.0, Align::Middle).expect("the embedded font");
        for (found, expected) in [(off(&level), [-BEARING_PX, 0.0]), (off(&upright), [0.0, BEARING_PX])] {
            let apart = [found[0] - expected[0], found[1] - expected[1]];
            assert!(apart.iter().all(|distance| distance.abs() <= 1.0), "{found:?} for {expected:?}");
        }
    }
}
