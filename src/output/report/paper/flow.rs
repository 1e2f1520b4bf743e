//! What is written down a printed page and goes on on the next.
//!
//! In: paragraphs, tables, drawings, pictures, in order. Out: pages of one size; the room above them is the head's.
//! Measures are points. Nothing is cut off: what is wider than the page becomes smaller, what is longer goes on.

use super::super::table::PageTable;
use crate::output::vector_page::{Anchor, Ink, VectorPage, words_pt};
use std::sync::Arc;

/// Empty edge at the left and at the right.
pub(super) const EDGE: f64 = 36.0;
/// Where the head ends and the page's own begins.
const TOP: f64 = 76.0;
/// Empty edge below.
const BOTTOM: f64 = 34.0;
/// From line to line, of the letters' size.
const LEADING: f64 = 1.32;
/// Letters of tables.
const CELL: f64 = 7.0;
/// Between two columns of a table.
const GAP: f64 = 11.0;
/// A column is not squeezed below this.
const NARROWEST: f64 = 70.0;

type Said<T> = Result<T, String>;

/// Pages with the place where the next piece goes.
pub(super) struct Flow {
    title: String,
    size_pt: [f64; 2],
    pub(super) pages: Vec<VectorPage>,
    y: f64,
}

impl Flow {
    pub(super) fn new(title: &str, size_pt: [f64; 2]) -> Self {
        let mut flow = Self { title: title.to_owned(), size_pt, pages: Vec::new(), y: TOP };
        flow.new_page();
        flow
    }

    /// Width of what is written.
    pub(super) fn width(&self) -> f64 {
        self.size_pt[0] - 2.0 * EDGE
    }

    /// Height that is left on the page.
    pub(super) fn room(&self) -> f64 {
        self.size_pt[1] - BOTTOM - self.y
    }

    /// Begins a page, unless it has just begun.
    pub(super) fn new_page(&mut self) {
        if self.pages.is_empty() || self.y > TOP {
            self.pages.push(VectorPage::of_size(&self.title, self.size_pt));
            self.y = TOP;
        }
    }

    /// Place of a piece of this height: the page it is drawn on and its top; a new page where this one is full.
    pub(super) fn take(&mut self, height: f64) -> (&mut VectorPage, f64) {
        if height > self.room() {
            self.new_page();
        }
        let top = self.y;
        self.y += height;
        (self.pages.last_mut().expect("a page is there from the start"), top)
    }

    pub(super) fn space(&mut self, height: f64) {
        self.y += height;
    }

    /// A line; smaller where it would be wider than the page.
    pub(super) fn line(&mut self, size: f64, ink: Ink, words: &str) -> Said<()> {
        let size = fitting(words, size, self.width())?;
        let (page, top) = self.take(LEADING * size);
        page.words((EDGE, top + size), size, ink, Anchor::Start, words);
        Ok(())
    }

    /// A heading, with room for something below it.
    pub(super) fn heading(&mut self, words: &str) -> Said<()> {
        self.space(8.0);
        if self.room() < 60.0 {
            self.new_page();
        }
        self.line(10.5, Ink::Black, words)?;
        self.space(2.0);
        Ok(())
    }

    /// Words in lines, on so many at most.
    pub(super) fn paragraph(&mut self, size: f64, ink: Ink, words: &str, most: usize) -> Said<()> {
        let mut lines = wrapped_pt(words, size, self.width())?;
        if lines.len() > most {
            lines.truncate(most);
            lines[most - 1].push_str(" …");
        }
        lines.iter().try_for_each(|line| self.line(size, ink, line))
    }

    /// A drawing as wide as the page, or by a factor of `most` larger than it is.
    pub(super) fn drawing(&mut self, drawing: &VectorPage, most: f64) {
        let [width, height] = drawing.size_pt;
        let scale = (self.width() / width).min(most);
        let (page, top) = self.take(scale * height);
        page.place(drawing, (EDGE, top), scale);
    }

    /// A picture, as wide as the page and as high as the rest of it, where that is `least` at least; no larger than
    /// `most` points for a pixel.
    pub(super) fn picture(&mut self, png: Arc<[u8]>, least: f64, most: f64) -> Said<()> {
        let (width, height) = png_size(&png)?;
        if self.room() < least {
            self.new_page();
        }
        let scale = (self.width() / width).min((self.room() - 4.0) / height).min(most);
        let left = EDGE + 0.5 * (self.width() - scale * width);
        let (page, top) = self.take(scale * height + 4.0);
        page.picture((left, top), (scale * width, scale * height), png);
        Ok(())
    }

    /// A table: columns as wide as their words, the widest broken into lines where all are wider than the page.
    pub(super) fn table(&mut self, table: &PageTable) -> Said<()> {
        let count = table.rows.iter().map(Vec::len).max().unwrap_or(0).max(table.columns.len());
        let mut widths = vec![0.0_f64; count];
        for row in table.rows.iter().chain([&table.columns]) {
            for (width, cell) in widths.iter_mut().zip(row) {
                *width = width.max(words_pt(cell, CELL)?);
            }
        }
        let room = self.width() - GAP * count.saturating_sub(1) as f64;
        // The widest gives way first, then the next.
        while widths.iter().sum::<f64>() > room + 0.01 {
            let widest = (0..count).max_by(|&a, &b| widths[a].total_cmp(&widths[b])).unwrap_or(0);
            let less = widths[widest] - (widths.iter().sum::<f64>() - room);
            let next =
                widths.iter().enumerate().filter(|(k, _)| *k != widest).map(|(_, w)| *w).fold(NARROWEST, f64::max);
            let narrower = less.max(next.min(widths[widest] - 1.0));
            widths[widest] = narrower;
        }
        let lefts: Vec<f64> = (0..count).map(|k| EDGE + widths[..k].iter().sum::<f64>() + GAP * k as f64).collect();
        if !table.caption.is_empty() {
            self.line(8.0, Ink::Black, &table.caption)?;
        }
        let head = (!table.columns.is_empty()).then_some((&table.columns, Ink::Grey));
        for (row, ink) in head.into_iter().chain(table.rows.iter().map(|row| (row, Ink::Black))) {
            let cells: Vec<Vec<String>> =
                row.iter().zip(&widths).map(|(cell, &width)| wrapped_pt(cell, CELL, width)).collect::<Said<_>>()?;
            let lines = cells.iter().map(Vec::len).max().unwrap_or(1);
            let height = LEADING * CELL * lines as f64 + 1.6;
            let right = EDGE + self.width();
            let (page, top) = self.take(height);
            page.path(&[(EDGE, top), (right, top)], Ink::Pale, 0.4);
            for (k, lines) in cells.iter().enumerate() {
                let (x, anchor) =
                    if table.is_number(k) { (lefts[k] + widths[k], Anchor::End) } else { (lefts[k], Anchor::Start) };
                for (index, line) in lines.iter().enumerate() {
                    page.words((x, top + CELL + 1.0 + LEADING * CELL * index as f64), CELL, ink, anchor, line);
                }
            }
        }
        self.space(6.0);
        Ok(())
    }
}

/// Size of letters at which words are no wider than this.
pub(super) fn fitting(words: &str, size: f64, width: f64) -> Said<f64> {
    Ok(size * (width / words_pt(words, size)?.max(1e-3)).min(1.0))
}

/// Words in lines no wider than this; a longer word has its own.
pub(super) fn wrapped_pt(words: &str, size: f64, width: f64) -> Said<Vec<String>> {
    let mut lines: Vec<String> = vec![String::new()];
    for word in words.split(' ') {
        let last = lines.last_mut().expect("the first line is there from the start");
        let longer = if last.is_empty() { word.to_owned() } else { format!("{last} {word}") };
        if last.is_empty() || words_pt(&longer, size)? <= width {
            *last = longer;
        } else {
            lines.push(word.to_owned());
        }
    }
    Ok(lines)
}

/// Width and height of a PNG file, pixels.
pub(super) fn png_size(png: &[u8]) -> Said<(f64, f64)> {
    let number = |at: usize| png.get(at..at + 4)?.try_into().ok().map(u32::from_be_bytes).map(f64::from);
    number(16).zip(number(20)).ok_or_else(|| "a picture has no size".to_owned())
}
