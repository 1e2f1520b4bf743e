//! A printed page of lines, rectangles and words: one list of strokes, written as SVG and as PDF alike.
//!
//! In: strokes in points (1/72 inch) from the upper left corner. Out: an SVG file, and a PDF file (`pdf.rs`) that
//! has the letters of the embedded font inside.
//!
//! The law: both files are made of the same list, so that paper and screen show the same. Road not taken: a converter
//! from SVG to PDF. The crate for that (svg2pdf) brings some sixty others and two and a half minutes of compiling;
//! sheets need four kinds of strokes.

mod pdf;

use super::atomic::write_bytes_atomically;
use super::letters::text_width_px;
use gearcut_core::error::{Error, Result};
use maud::{Markup, html};
use std::path::Path;

/// A4 upright, points.
pub const A4_PT: [f64; 2] = [595.28, 841.89];

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
    /// Words on a baseline.
    Words { at: (f64, f64), size: f64, ink: Ink, anchor: Anchor, words: String },
}

/// A page.
#[derive(Debug, Clone, PartialEq)]
pub struct VectorPage {
    title: String,
    pub(super) strokes: Vec<PagePiece>,
}

impl VectorPage {
    /// An empty A4 page, upright.
    pub fn new(title: &str) -> Self {
        Self { title: title.to_owned(), strokes: Vec::new() }
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
        let bytes = self.pdf().map_err(|reason| Error::Output { path: pdf.to_owned(), reason })?;
        write_bytes_atomically(pdf, &bytes)
    }

    /// The page as SVG.
    pub fn svg(&self) -> Markup {
        let [width, height] = A4_PT;
        html! {
            svg xmlns="http://www.w3.org/2000/svg" width="210mm" height="297mm"
                viewBox=(format!("0 0 {width} {height}")) font-family="Noto Sans, DejaVu Sans, Arial, sans-serif"
                role="img" aria-labelledby="title" {
                title id="title" { (self.title) }
                rect width=(width) height=(height) fill="#ffffff" {}
                @for stroke in &self.strokes { (stroke.svg()) }
            }
        }
    }
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

    /// The file is taken apart as a reader does: from its end, by the table of places.
    #[test]
    fn the_printed_page_has_every_object_where_its_table_says() {
        let bytes = page().pdf().expect("the font is read");
        assert_eq!(bytes, page().pdf().expect("the font is read"), "the same page, the same bytes");
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
