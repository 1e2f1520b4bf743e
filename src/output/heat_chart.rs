//! A table of numbers as coloured cells: values over two lists, such as means of a quantity over two parameters.
//!
//! In: labels down and across, and a value or none for each pair. Out: one plot, on a page or as SVG. Every cell has
//! its number; colours are those of maps ([`ColourScale`]).

use maud::html;

use crate::colormap::ColourScale;
use crate::output::figure::{Figure, Name, Plot};
use crate::output::plot::{LABELS_PX, WIDTH_PX, px};

/// Height of a cell, and room for the labels of the rows, pixels.
const CELL_PX: f64 = 26.0;
const ROOM_PX: f64 = 110.0;
/// Colours lighter than this have dark numbers, of 255.
const LIGHT: f64 = 140.0;

/// A chart of coloured cells.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatChart {
    /// What is shown.
    pub title: String,
    /// What the values are, and their unit.
    pub value_name: [String; 2],
    /// What the rows and the columns are.
    pub names: [String; 2],
    /// Labels of rows and of columns.
    pub labels: [Vec<String>; 2],
    /// Values row by row, and as they are written.
    pub cells: Vec<Vec<Option<(f64, String)>>>,
}

impl HeatChart {
    /// The chart laid out.
    pub(super) fn figure(&self) -> Figure<'_> {
        let [rows, columns] = &self.labels;
        let values: Vec<f32> = self.cells.iter().flatten().flatten().map(|of| of.0 as f32).collect();
        let scale = ColourScale::heights_over([values.as_slice()]);
        let width_px = (WIDTH_PX - ROOM_PX - 10.0) / columns.len().max(1) as f64;
        let left = |column: usize| ROOM_PX + width_px * column as f64;
        let top = |row: usize| 4.0 + CELL_PX * row as f64;
        let cell = |row: usize, column: usize| {
            let (value, words) = self.cells[row][column].as_ref()?;
            let [r, g, b] = scale.colour(*value as f32);
            let lightness = 0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b);
            let ink = if lightness > LIGHT { "#000000" } else { "#ffffff" };
            Some((format!("#{r:02x}{g:02x}{b:02x}"), ink, words))
        };
        let drawing = html! {
            @for (row, label) in rows.iter().enumerate() {
                text class="tick end" x=(px(ROOM_PX - 7.0)) y=(px(top(row) + 0.5 * CELL_PX + 4.0)) { (label) }
                @for (column, across) in columns.iter().enumerate() {
                    @if let Some((fill, ink, words)) = cell(row, column) {
                        rect x=(px(left(column))) y=(px(top(row))) width=(px(width_px)) height=(px(CELL_PX))
                            fill=(fill) {
                            title {
                                (self.names[0]) " " (label) ", " (self.names[1]) " " (across) ": " (words) " "
                                (self.value_name[1])
                            }
                        }
                        text class="middle" x=(px(left(column) + 0.5 * width_px))
                            y=(px(top(row) + 0.5 * CELL_PX + 4.0)) style=(format!("fill:{ink}")) { (words) }
                    }
                }
            }
            @for (column, label) in columns.iter().enumerate() {
                text class="tick middle" x=(px(left(column) + 0.5 * width_px)) y=(px(top(rows.len()) + 17.0)) {
                    (label)
                }
            }
        };
        let [value, unit] = &self.value_name;
        Figure {
            title: &self.title,
            plots: vec![Plot {
                name: Name::new(value, unit.clone()),
                legend: Vec::new(),
                size_px: (WIDTH_PX, top(rows.len()) + LABELS_PX),
                drawing,
            }],
            x_name: Name::new(&format!("{} (down), {} (across)", self.names[0], self.names[1]), String::new()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_have_the_colours_of_maps_and_their_numbers() {
        let of = |value: f64| Some((value, format!("{value}")));
        let chart = HeatChart {
            title: "means".to_owned(),
            value_name: ["scallop", "µm"].map(str::to_owned),
            names: ["teeth", "strokes"].map(str::to_owned),
            labels: [vec!["20".to_owned(), "30".to_owned()], vec!["1".to_owned(), "2".to_owned()]],
            cells: vec![vec![of(1.0), of(3.0)], vec![None, of(2.0)]],
        };
        let text = chart.figure().html().into_string();
        assert_eq!(text.matches("<rect").count(), 3, "{text}");
        // Ends and middle of viridis.
        for (fill, words) in
            [("#440154", "20, strokes 1: 1"), ("#fde725", "20, strokes 2: 3"), ("#21908c", "30, strokes 2: 2")]
        {
            assert!(text.contains(&format!("fill=\"{fill}\"><title>teeth {words} µm")), "{fill} {words}: {text}");
        }
        assert!(text.contains("style=\"fill:#ffffff\">1<") && text.contains("style=\"fill:#000000\">3<"), "{text}");
    }
}
