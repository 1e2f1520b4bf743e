//! A table of the page.
//!
//! In: a caption, columns and rows of text. Out: HTML; columns of numbers are set to the right.

use maud::{Markup, html};

/// A table.
#[derive(Debug, Clone, PartialEq)]
pub struct PageTable {
    /// What it shows.
    pub caption: String,
    /// Heads of the columns; empty for a list of names and values.
    pub columns: Vec<String>,
    /// Rows; the first cell names the row.
    pub rows: Vec<Vec<String>>,
}

impl PageTable {
    /// Whether a column has numbers, and is set to the right.
    pub(super) fn is_number(&self, column: usize) -> bool {
        let mut cells = self.rows.iter().filter_map(|row| row.get(column));
        !self.columns.is_empty()
            && cells.all(|cell| cell.starts_with(|c: char| c.is_ascii_digit() || "−-–+".contains(c)))
    }

    /// The table as HTML.
    pub(super) fn markup(&self) -> Markup {
        let class = |column: usize| if self.is_number(column) { "number" } else { "" };
        html! {
            div class="table" tabindex="0" role="group" aria-label=(self.caption) {
                table class=(if self.columns.is_empty() { "list" } else { "" }) {
                    caption { (self.caption) }
                    @if !self.columns.is_empty() {
                        thead {
                            tr {
                                @for (index, column) in self.columns.iter().enumerate() {
                                    th scope="col" class=(class(index)) { (column) }
                                }
                            }
                        }
                    }
                    tbody {
                        @for row in &self.rows {
                            tr {
                                @for (index, cell) in row.iter().enumerate() {
                                    @if index == 0 {
                                        th scope="row" class=(class(0)) { (cell) }
                                    } @else {
                                        td class=(class(index)) { (cell) }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}
