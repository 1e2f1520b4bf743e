//! Printed pages of lines, areas, words and pictures: one list of strokes, written as SVG and as PDF alike.
//!
//! In: strokes in points (1/72 inch) from the upper left corner; charts of the report, from their own SVG
//! (`drawn.rs`). Out: an SVG file of one page, and a PDF file of one or many (`pdf.rs`) that has the letters of the
//! embedded font inside.
//!
//! The law: both files are made of the same list, so that paper and screen show the same. Road not taken: a converter
//! from any SVG to PDF. The crate for that (svg2pdf) brings some sixty others and two and a half minutes of compiling;
//! pages need five kinds of strokes.

mod drawn;
mod pdf;

use super::atomic::write_bytes_atomically;
use super::letters::text_width_px;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use gearcut_core::error::{Error, Result};
use maud::{Markup, html};
use std::path::Path;
use std::sync::Arc;

pub use drawn::drawn;

/// A4 upright, points.
pub const A4_PT: [f64; 2] = [595.28, 841.89];
/// US Letter upright, points.
pub const LETTER_PT: [f64; 2] = [612.0, 792.0];

/// Colours of strokes and words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ink {
    /// Words and frames.
    Black,
    /// Grids.
    Pale,
    /// What is said beside.
    Grey,
    /// Traces.
    Blue,
    /// Mean lines, and what fails.
    Red,
    /// What is as it should be.
    Green,
    /// Parts of red, green and blue, of 255.
    Rgb([u8; 3]),
}

impl Ink {
    /// Parts of red, green and blue, of 255.
    fn rgb(self) -> [u8; 3] {
        match self {
            Self::Black => [0x1a, 0x1a, 0x1a],
            Self::Pale => [0xd4, 0xd8, 0xdc],
            Self::Grey => [0x5a, 0x62, 0x6a],
            Self::Blue => [0x00, 0x5a, 0x9c],
            Self::Red => [0xc0, 0x3a, 0x00],
            Self::Green => [0x17, 0x69, 0x3f],
            Self::Rgb(parts) => parts,
        }
    }

    fn hex(self) -> String {
        let [r, g, b] = self.rgb();
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

/// Which end of a text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Its beginning.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// A piece of the page; places in points from the upper left corner.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum PagePiece {
    /// A line through points; broken where one is not finite.
    Path { points: Vec<(f64, f64)>, ink: Ink, width: f64, dashed: bool },
    /// A filled rectangle: left, top, width, height.
    Block { corner: (f64, f64), size: (f64, f64), ink: Ink },
    /// A filled polygon.
    Area { points: Vec<(f64, f64)>, ink: Ink },
    /// A picture in a rectangle, PNG.
    Picture { corner: (f64, f64), size: (f64, f64), png: Arc<[u8]> },
    /// Words on a baseline.
    Words { at: (f64, f64), size: f64, ink: Ink, anchor: Anchor, words: String },
}

/// A page.
#[derive(Debug, Clone, PartialEq)]
pub struct VectorPage {
    title: String,
    /// Width and height, points.
    pub size_pt: [f64; 2],
    pub(super) strokes: Vec<PagePiece>,
}

impl VectorPage {
    /// An empty A4 page, upright.
    pub fn new(title: &str) -> Self {
        Self::of_size(title, A4_PT)
    }

    /// An empty page, width and height in points.
    pub fn of_size(title: &str, size_pt: [f64; 2]) -> Self {
        Self { title: title.to_owned(), size_pt, strokes: Vec::new() }
    }

    /// A line through points.
    pub fn path(&mut self, points: &[(f64, f64)], ink: Ink, width: f64) {
        self.strokes.push(PagePiece::Path { points: points.to_vec(), ink, width, dashed: false });
    }

    /// A dashed line.
    pub fn dashes(&mut self, points: &[(f64, f64)], ink: Ink, width: f64) {
        self.strokes.push(PagePiece::Path { points: points.to_vec(), ink, width, dashed: true });
    }

    /// A frame.
    pub fn frame(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), ink: Ink) {
        let corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height), (x, y)];
        self.path(&corners, ink, 0.6);
    }

    /// A filled rectangle.
    pub fn block(&mut self, corner: (f64, f64), size: (f64, f64), ink: Ink) {
        self.strokes.push(PagePiece::Block { corner, size, ink });
    }

    /// A filled polygon.
    pub fn area(&mut self, points: &[(f64, f64)], ink: Ink) {
        self.strokes.push(PagePiece::Area { points: points.to_vec(), ink });
    }

    /// A picture in a rectangle, PNG.
    pub fn picture(&mut self, corner: (f64, f64), size: (f64, f64), png: Arc<[u8]>) {
        self.strokes.push(PagePiece::Picture { corner, size, png });
    }

    /// The lowest place of a line, area, word or picture, points from the top.
    pub fn lowest_pt(&self) -> f64 {
        let lowest = |points: &[(f64, f64)]| points.iter().map(|point| point.1).fold(0.0, f64::max);
        let of = |stroke: &PagePiece| match stroke {
            PagePiece::Path { points, .. } | PagePiece::Area { points, .. } => lowest(points),
            PagePiece::Block { corner, size, .. } | PagePiece::Picture { corner, size, .. } => corner.1 + size.1,
            PagePiece::Words { at, .. } => at.1,
        };
        self.strokes.iter().map(of).fold(0.0, f64::max)
    }

    /// Another page in this one, so many times as large, its upper left corner here.
    pub fn place(&mut self, page: &Self, corner: (f64, f64), scale: f64) {
        let at = |(x, y): (f64, f64)| (corner.0 + scale * x, corner.1 + scale * y);
        let by = |(width, height): (f64, f64)| (scale * width, scale * height);
        let all = |points: &[(f64, f64)]| points.iter().copied().map(at).collect();
        self.strokes.extend(page.strokes.iter().map(|stroke| match stroke {
            PagePiece::Path { points, ink, width, dashed } => {
                PagePiece::Path { points: all(points), ink: *ink, width: scale * width, dashed: *dashed }
            }
            PagePiece::Block { corner, size, ink } => {
                PagePiece::Block { corner: at(*corner), size: by(*size), ink: *ink }
            }
            PagePiece::Area { points, ink } => PagePiece::Area { points: all(points), ink: *ink },
            PagePiece::Picture { corner, size, png } => {
                PagePiece::Picture { corner: at(*corner), size: by(*size), png: Arc::clone(png) }
            }
            PagePiece::Words { at: place, size, ink, anchor, words } => PagePiece::Words {
                at: at(*place),
                size: scale * size,
                ink: *ink,
                anchor: *anchor,
                words: words.clone(),
            },
        }));
    }

    /// Words on a baseline.
    pub fn words(&mut self, at: (f64, f64), size: f64, ink: Ink, anchor: Anchor, words: &str) {
        let words = words.replace(char::is_control, " ");
        self.strokes.push(PagePiece::Words { at, size, ink, anchor, words });
    }

    /// Writes the page as `<stem>.svg` and `<stem>.pdf`.
    ///
    /// # Errors
    /// Files that cannot be written; a font that cannot be read.
    pub fn write(&self, svg: &Path, pdf: &Path) -> Result<()> {
        write_bytes_atomically(svg, self.svg().into_string().as_bytes())?;
        write_pdf(pdf, std::slice::from_ref(self))
    }

    /// The page as SVG.
    pub fn svg(&self) -> Markup {
        let [width, height] = self.size_pt;
        let mm = |pt: f64| format!("{}mm", (pt * 25.4 / 72.0).round());
        html! {
            svg xmlns="http://www.w3.org/2000/svg" width=(mm(width)) height=(mm(height))
                viewBox=(format!("0 0 {width} {height}")) font-family="Noto Sans, DejaVu Sans, Arial, sans-serif"
                role="img" aria-labelledby="title" {
                title id="title" { (self.title) }
                rect width=(width) height=(height) fill="#ffffff" {}
                @for stroke in &self.strokes { (stroke.svg()) }
            }
        }
    }
}

/// Writes pages as one PDF file, whose title is that of the first.
///
/// # Errors
/// A file that cannot be written; a font or a picture that cannot be read.
pub fn write_pdf(path: &Path, pages: &[VectorPage]) -> Result<()> {
    let bytes = pdf::pdf(pages).map_err(|reason| Error::Output { path: path.to_owned(), reason })?;
    write_bytes_atomically(path, &bytes)
}

/// Width of words, points.
///
/// # Errors
/// The embedded font cannot be read.
pub(super) fn words_pt(words: &str, size: f64) -> std::result::Result<f64, String> {
    text_width_px(words, size)
}

impl PagePiece {
    fn svg(&self) -> Markup {
        match self {
            Self::Path { points, ink, width, dashed } => html! {
                path d=(super::plot::path(points)) fill="none" stroke=(ink.hex()) stroke-width=(width)
                    stroke-linejoin="round" stroke-dasharray=[dashed.then_some("3 2.4")] {}
            },
            Self::Block { corner, size, ink } => html! {
                rect x=(coordinate(corner.0)) y=(coordinate(corner.1)) width=(coordinate(size.0))
                    height=(coordinate(size.1)) fill=(ink.hex()) {}
            },
            Self::Area { points, ink } => html! { path d=(super::plot::path(points)) fill=(ink.hex()) {} },
            Self::Picture { corner, size, png } => html! {
                image x=(coordinate(corner.0)) y=(coordinate(corner.1)) width=(coordinate(size.0))
                    height=(coordinate(size.1)) href=(format!("data:image/png;base64,{}", STANDARD.encode(png))) {}
            },
            Self::Words { at, size, ink, anchor, words } => {
                let anchor = match anchor {
                    Anchor::Start => "start",
                    Anchor::Middle => "middle",
                    Anchor::End => "end",
                };
                // Many installed fonts lack the minus sign.
                let words = words.replace('−', "–");
                html! {
                    text x=(coordinate(at.0)) y=(coordinate(at.1)) font-size=(size) fill=(ink.hex())
                        text-anchor=(anchor) { (words) }
                }
            }
        }
    }
}

/// A hundredth of a point is not seen.
fn coordinate(value: f64) -> String {
    format!("{value:.2}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page() -> VectorPage {
        let mut page = VectorPage::new("a & b");
        page.path(&[(10.0, 10.0), (20.0, 30.0), (f64::NAN, 0.0), (40.0, 30.0), (50.0, 10.0)], Ink::Blue, 1.0);
        page.block((60.0, 60.0), (5.0, 7.0), Ink::Red);
        page.words((100.0, 100.0), 9.0, Ink::Black, Anchor::End, "Fα ≤ 12 µm\u{7}");
        page
    }

    #[test]
    fn the_page_is_xml_that_others_read() {
        let text = page().svg().into_string();
        let document = roxmltree::Document::parse(&text).expect("XML");
        let words: Vec<&str> = document.descendants().filter_map(|node| node.text()).collect();
        assert!(words.contains(&"a & b") && words.contains(&"Fα ≤ 12 µm "), "{text}");
        let path = document.descendants().find(|node| node.has_tag_name("path")).expect("a path");
        assert_eq!(path.attribute("d"), Some("M10 10L20 30M40 30L50 10"));
    }

    /// Two pages, the second with a picture whose rows are those of its PNG file; one of
    /// numbered colours brings its palette, one of grey is refused.
    #[test]
    fn pictures_are_taken_over_as_they_are_packed() {
        let png = |kind: u8| -> Arc<[u8]> {
            let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
            let head = [0, 0, 0, 3, 0, 0, 0, 2, 8, kind, 0, 0, 0];
            for (name, body) in [
                (b"IHDR", &head[..]),
                (b"PLTE", b"abcdef"),
                (b"IDAT", b"one "),
                (b"tEXt", b"not this"),
                (b"IDAT", b"two"),
            ] {
                bytes.extend((body.len() as u32).to_be_bytes());
                bytes.extend(name.iter().chain(body).chain(&[0; 4]));
            }
            bytes.into()
        };
        let mut second = VectorPage::of_size("second", LETTER_PT);
        second.picture((10.0, 20.0), (30.0, 20.0), png(2));
        let bytes = pdf::pdf(&[page(), second.clone()]).expect("the font is read");
        let text = String::from_utf8_lossy(&bytes);
        assert_eq!([text.matches("/MediaBox").count(), text.matches("/Subtype /Image").count()], [2, 1], "{text}");
        assert!(text.contains("stream\none two\nendstream") && text.contains("/Predictor 15"), "{text}");
        assert!(text.contains("/Width 3") && text.contains("/Height 2") && text.contains("/Columns 3"), "{text}");
        let mut numbered = VectorPage::new("numbered");
        numbered.picture((0.0, 0.0), (1.0, 1.0), png(3));
        let text = pdf::pdf(&[numbered]).expect("the font is read");
        let text = String::from_utf8_lossy(&text).into_owned();
        assert!(text.contains("/Indexed /DeviceRGB 1 (abcdef)") && text.contains("/Colors 1"), "{text}");
        let mut outer = VectorPage::new("outer");
        outer.place(&second, (100.0, 100.0), 0.5);
        assert_eq!(outer.lowest_pt(), 120.0);
        second.picture((0.0, 0.0), (1.0, 1.0), png(0));
        assert!(pdf::pdf(&[second]).is_err_and(|why| why.contains("no plain colours")));
    }

    /// The file is taken apart as a reader does: from its end, by the table of places.
    #[test]
    fn the_printed_page_has_every_object_where_its_table_says() {
        let bytes = pdf::pdf(&[page()]).expect("the font is read");
        assert_eq!(bytes, pdf::pdf(&[page()]).expect("the font is read"), "the same page, the same bytes");
        assert!(bytes.starts_with(b"%PDF-1.") && bytes.ends_with(b"%%EOF"), "{:?}", &bytes[..8]);
        let text = String::from_utf8_lossy(&bytes);
        let at: usize = {
            let tail = text.rsplit("startxref").next().expect("a tail");
            tail.lines().nth(1).expect("a place").trim().parse().expect("a number")
        };
        let table = std::str::from_utf8(&bytes[at..]).expect("the table is text");
        let mut lines = table.lines();
        assert_eq!(lines.next(), Some("xref"));
        let count: usize =
            lines.next().and_then(|head| head.split(' ').nth(1)).expect("a count").parse().expect("whole");
        assert!(count > 8, "{count}");
        for (number, line) in lines.take(count).enumerate().skip(1) {
            let place: usize = line.split(' ').next().expect("a place").parse().expect("a number");
            let head = format!("{number} 0 obj");
            assert!(bytes[place..].starts_with(head.as_bytes()), "object {number} is not at {place}");
        }
    }
}
