//! Drawing on any plotters backend, in one set of units.
//!
//! In: points in picture pixels, text sizes in pixels per em. Out: lines, rectangles and text on a bitmap or an SVG.
//!
//! plotters places text by boxes whose relation to the letters differs between its bitmap and its SVG backend (by a
//! sixth of the letter height). This layer places text by the middle of its capitals, which both then agree on, and
//! draws at a multiple of the picture's size: bitmaps are averaged down afterwards (smooth lines), SVG gets finer
//! coordinates.
//!
//! Road not taken: plotters' chart builder. Its label areas are fixed numbers of pixels, so long labels are clipped.

use std::fmt::Display;

use plotters::prelude::{BitMapBackend, DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontDesc, FontFamily, FontStyle, FontTransform, RGBColor, ShapeStyle, TextStyle};

use crate::output::{font, letters};

/// Text, axes and frames.
pub(super) const INK: RGBColor = RGBColor(34, 34, 34);
/// Grid lines.
pub(super) const FAINT: RGBColor = RGBColor(222, 222, 222);
/// Background.
pub(super) const PAPER: RGBColor = RGBColor(255, 255, 255);

/// A point of the picture, pixels from its upper left corner.
pub(super) type Point = (f64, f64);
/// Why something could not be drawn.
pub(super) type Drawn = Result<(), String>;

/// Where a text lies relative to its point, in reading direction; across it the capitals' middle is on the point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    /// The text begins at the point.
    Start,
    /// The text is centred on the point.
    Middle,
    /// The text ends at the point.
    End,
}

/// A backend with units.
pub(super) struct Canvas<DB> {
    backend: DB,
    /// Backend pixels per picture pixel.
    scale: f64,
    /// plotters' font size per em on this backend.
    size_per_em: f64,
    /// Distance from the top that plotters takes for a text's place down to the baseline, in em.
    baseline_em: f64,
    /// Bitmaps: letters are drawn this many times finer and averaged. SVG files leave letters to the viewer.
    letters_finer: Option<i32>,
}

impl<'a> Canvas<BitMapBackend<'a>> {
    /// Canvas over an RGB buffer of `scale` times the picture's size.
    pub(super) fn bitmap(rgb: &'a mut [u8], size_px: (u32, u32), scale: u32) -> Result<Self, String> {
        font::register()?;
        let backend = BitMapBackend::with_buffer(rgb, (size_px.0 * scale, size_px.1 * scale));
        // plotters-bitmap draws the baseline half a line height below the top.
        let (size_per_em, baseline_em) = (font::LINE_HEIGHT_EM, 0.5 * font::LINE_HEIGHT_EM);
        Ok(Self {
            backend,
            scale: f64::from(scale),
            size_per_em,
            baseline_em,
            letters_finer: Some(if scale == 1 { 4 } else { 2 }),
        })
    }
}

impl<'a> Canvas<SVGBackend<'a>> {
    /// Canvas that writes SVG text with coordinates `scale` times finer than a pixel.
    pub(super) fn svg(text: &'a mut String, size_px: (u32, u32), scale: u32) -> Result<Self, String> {
        font::register()?;
        let backend = SVGBackend::with_string(text, (size_px.0 * scale, size_px.1 * scale));
        // plotters-svg writes font-size = size / 1.24 and dy = 0.76 em for texts placed by their top.
        Ok(Self { backend, scale: f64::from(scale), size_per_em: 1.24, baseline_em: 0.76, letters_finer: None })
    }
}

impl<DB: DrawingBackend> Canvas<DB> {
    fn place(&self, point: Point) -> (i32, i32) {
        ((point.0 * self.scale).round() as i32, (point.1 * self.scale).round() as i32)
    }

    fn stroke(&self, colour: RGBColor, width_px: f64) -> ShapeStyle {
        ShapeStyle {
            color: colour.to_rgba(),
            filled: false,
            stroke_width: (width_px * self.scale).round().max(1.0) as u32,
        }
    }

    /// Line through all points.
    pub(super) fn line(&mut self, points: &[Point], colour: RGBColor, width_px: f64) -> Drawn {
        let mut places: Vec<(i32, i32)> = Vec::with_capacity(points.len());
        for &point in points {
            let next = self.place(point);
            // Points that go straight on, or stand still, add nothing but bytes.
            while let [.., a, b] = places[..]
                && goes_straight_on(a, b, next)
            {
                places.pop();
            }
            if places.last() != Some(&next) {
                places.push(next);
            }
        }
        let style = self.stroke(colour, width_px);
        if self.letters_finer.is_none() {
            return self.backend.draw_path(places, &style).map_err(text);
        }
        // plotters fills the outline of a wide line as one polygon, and spikes where its sides nearly coincide; piece
        // by piece it does not.
        places.windows(2).try_for_each(|piece| self.backend.draw_path(piece.iter().copied(), &style).map_err(text))
    }

    /// Dashed straight line.
    pub(super) fn dashed(&mut self, from: Point, to: Point, colour: RGBColor, width_px: f64) -> Drawn {
        const DASH_PX: f64 = 7.0;
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        let at = |along: f64| {
            let part = (along / length).min(1.0);
            (from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1))
        };
        let dashes = (length / (2.0 * DASH_PX)).ceil() as u32;
        (0..dashes)
            .map(|k| 2.0 * DASH_PX * f64::from(k))
            .try_for_each(|start| self.line(&[at(start), at(start + DASH_PX)], colour, width_px))
    }

    /// Filled rectangle between two corners.
    pub(super) fn fill(&mut self, upper_left: Point, lower_right: Point, colour: RGBColor) -> Drawn {
        let style = ShapeStyle { filled: true, ..self.stroke(colour, 1.0) };
        self.backend.draw_rect(self.place(upper_left), self.place(lower_right), &style, true).map_err(text)
    }

    /// Frame between two corners.
    pub(super) fn frame(&mut self, a: Point, b: Point, colour: RGBColor) -> Drawn {
        self.line(&[a, (b.0, a.1), b, (a.0, b.1), a], colour, 1.0)
    }

    /// Filled polygon.
    pub(super) fn polygon(&mut self, points: &[Point], colour: RGBColor) -> Drawn {
        let places: Vec<_> = points.iter().map(|&point| self.place(point)).collect();
        self.backend.fill_polygon(places, &colour).map_err(text)
    }

    /// Horizontal text.
    pub(super) fn text(&mut self, words: &str, at: Point, em_px: f64, side: Side) -> Drawn {
        self.letters(words, at, em_px, side, FontTransform::None)
    }

    /// Text that reads upward.
    pub(super) fn text_upward(&mut self, words: &str, at: Point, em_px: f64, side: Side) -> Drawn {
        self.letters(words, at, em_px, side, FontTransform::Rotate270)
    }

    fn letters(&mut self, words: &str, at: Point, em_px: f64, side: Side, turn: FontTransform) -> Drawn {
        let up_px = em_px * (self.baseline_em - 0.5 * font::CAPITAL_HEIGHT_EM);
        if let Some(finer) = self.letters_finer {
            return self.letters_as_pixels(words, at, (em_px, up_px), side, &turn, finer);
        }
        let top = match turn {
            FontTransform::Rotate270 => (at.0 - up_px, at.1),
            _ => (at.0, at.1 - up_px),
        };
        let h_pos = match side {
            Side::Start => HPos::Left,
            Side::Middle => HPos::Center,
            Side::End => HPos::Right,
        };
        let style = TextStyle {
            font: font_desc(em_px * self.scale * self.size_per_em).transform(turn),
            color: INK.to_backend_color(),
            pos: Pos::new(h_pos, VPos::Top),
        };
        // Many installed fonts lack the minus sign, and not every viewer borrows it from another font; a dash is there.
        self.backend.draw_text(&words.replace('−', "–"), &style, self.place(top)).map_err(text)
    }

    /// Draws letters from coverage gathered on a finer raster: plotters sets each letter to whole pixels, which makes
    /// the gaps between small letters uneven.
    fn letters_as_pixels(
        &mut self,
        words: &str,
        at: Point,
        (em_px, up_px): (f64, f64),
        side: Side,
        turn: &FontTransform,
        finer: i32,
    ) -> Drawn {
        let width_px = text_width_px(words, em_px)?;
        let back_px = match side {
            Side::Start => 0.0,
            Side::Middle => 0.5 * width_px,
            Side::End => width_px,
        };
        let fine_per_px = self.scale * f64::from(finer);
        let [fine_left, fine_top] = [-back_px, -up_px].map(|offset| (offset * fine_per_px).round() as i32);
        // Pixels that the letters can touch: the text's width, a line, and a line more for accents and descenders.
        let line_px = font::LINE_HEIGHT_EM * em_px * self.scale;
        let (left, top) = (fine_left.div_euclid(finer) - 1, fine_top.div_euclid(finer) - (0.5 * line_px) as i32 - 1);
        let (columns, rows) = ((width_px * self.scale) as usize + 4, (2.0 * line_px) as usize + 4);
        let mut coverage = vec![0.0; columns * rows];
        letters::draw(words, em_px * self.size_per_em * fine_per_px, |x, y, part| {
            let column = usize::try_from((x + fine_left).div_euclid(finer) - left);
            let row = usize::try_from((y + fine_top).div_euclid(finer) - top);
            if let (Ok(column), Ok(row)) = (column, row)
                && column < columns
                && row < rows
            {
                coverage[row * columns + column] += f64::from(part) / f64::from(finer * finer);
            }
        })?;
        let (width, height) = self.backend.get_size();
        let inside = |at: i32, size: u32| u32::try_from(at).is_ok_and(|at| at < size);
        let origin = self.place(at);
        let pixels = (top..)
            .zip(coverage.chunks_exact(columns))
            .flat_map(|(y, row)| (left..).zip(row).map(move |(x, &part)| (x, y, part)));
        for (x, y, part) in pixels.filter(|pixel| pixel.2 > 0.0) {
            let (dx, dy) = match turn {
                FontTransform::Rotate270 => (y, -x),
                _ => (x, y),
            };
            let (x, y) = (origin.0 + dx, origin.1 + dy);
            if inside(x, width) && inside(y, height) {
                let colour = INK.mix(part.min(1.0)).to_backend_color();
                self.backend.draw_pixel((x, y), colour).map_err(text)?;
            }
        }
        Ok(())
    }

    /// Ends the drawing.
    pub(super) fn finish(mut self) -> Drawn {
        self.backend.present().map_err(text)
    }
}

/// Whether the way from `a` over `b` to `c` keeps its direction; exact, in whole pixels.
fn goes_straight_on(a: (i32, i32), b: (i32, i32), c: (i32, i32)) -> bool {
    let difference = |from: (i32, i32), to: (i32, i32)| (i64::from(to.0 - from.0), i64::from(to.1 - from.1));
    let (first, second) = (difference(a, b), difference(b, c));
    first.0 * second.1 == first.1 * second.0 && first.0 * second.0 + first.1 * second.1 > 0
}

/// Width of a text, pixels.
pub(super) fn text_width_px(words: &str, em_px: f64) -> Result<f64, String> {
    /// Measured at this many times the size, because widths are whole pixels.
    const FINER: f64 = 16.0;
    Ok(f64::from(letters::width(words, em_px * font::LINE_HEIGHT_EM * FINER)?) / FINER)
}

fn font_desc(size: f64) -> FontDesc<'static> {
    FontDesc::new(FontFamily::Name(font::FAMILY), size, FontStyle::Normal)
}

fn text(reason: impl Display) -> String {
    reason.to_string()
}
