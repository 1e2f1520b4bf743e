//! Aligned text for the terminal: labelled lines and tables.
//!
//! Plain text without colours, the same on a terminal and in a log; units stand behind every number.

use std::fmt::Write as _;

use crate::wrap::wrapped;

/// Where values begin on labelled lines, in characters.
pub const VALUE_COLUMN: usize = 32;
/// Characters of a line within which tables keep if they can.
const LINE: usize = 80;
/// Blanks between the columns of a table, and between those of one that would be too wide; where even one blank is too
/// many, the columns keep apart.
const GAPS: [usize; 3] = [3, 2, 1];

/// Text that grows line by line. A brief one leaves out tables and details, and headings under which nothing is left.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Sheet {
    text: String,
    brief: bool,
    /// Headings of a brief sheet that nothing has followed yet.
    awaited: String,
}

impl Sheet {
    /// A sheet without tables and details.
    pub fn brief() -> Self {
        Self { brief: true, ..Self::default() }
    }

    /// Whether tables and details are left out.
    pub fn is_brief(&self) -> bool {
        self.brief
    }

    /// What is printed unless the sheet is brief.
    pub fn details(&mut self, print: impl FnOnce(&mut Self)) {
        if !self.brief {
            print(self);
        }
    }

    /// A heading, set off by an empty line unless it is the first.
    pub fn heading(&mut self, words: &str) {
        let gap = if self.text.is_empty() { "" } else { "\n" };
        if self.brief && !self.text.is_empty() {
            self.awaited = format!("{gap}{words}\n");
        } else {
            let _ = writeln!(self.text, "{gap}{words}");
        }
    }

    fn awaited_heading(&mut self) {
        self.text.push_str(&std::mem::take(&mut self.awaited));
    }

    /// A label and its value, indented under the heading.
    pub fn line(&mut self, label: &str, value: impl AsRef<str>) {
        self.awaited_heading();
        // A label as wide as the column keeps apart from its value.
        let gap = if label.chars().count() < VALUE_COLUMN - 2 { "" } else { "  " };
        let _ = writeln!(self.text, "  {label:<width$}{gap}{}", value.as_ref(), width = VALUE_COLUMN - 2);
    }

    /// A line of words, indented under the heading.
    pub fn words(&mut self, words: &str) {
        self.awaited_heading();
        let _ = writeln!(self.text, "  {words}");
    }

    /// A line at the margin.
    pub fn margin(&mut self, words: &str) {
        self.awaited_heading();
        let _ = writeln!(self.text, "{words}");
    }

    /// A table, indented under the heading: words to the left, numbers to the right, as wide as their widest cell.
    /// Where lines would be too long, the first row, which names the columns, is broken between words, and columns
    /// stand closer.
    pub fn table(&mut self, rows: &[Vec<String>]) {
        if self.brief {
            return;
        }
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |rows: &[Vec<String>], column: usize| {
            rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let whole: Vec<usize> = (0..columns).map(|column| width(rows, column)).collect();
        let line = |widths: &[usize], gap: usize| 2 + widths.iter().sum::<usize>() + gap * columns.saturating_sub(1);
        let Some((head, body)) = rows.split_first().filter(|_| line(&whole, GAPS[0]) > LINE) else {
            for row in rows {
                self.row(row, &whole, GAPS[0]);
            }
            return;
        };
        let longest_word = |cell: &String| cell.split(' ').map(|word| word.chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> =
            (0..columns).map(|column| width(body, column).max(head.get(column).map_or(0, longest_word))).collect();
        let gap = GAPS.into_iter().find(|&gap| line(&widths, gap) <= LINE).unwrap_or(GAPS[1]);
        let names: Vec<Vec<String>> = head.iter().zip(&widths).map(|(cell, &width)| wrapped(cell, width)).collect();
        let high = names.iter().map(Vec::len).max().unwrap_or(0);
        for k in 0..high {
            // Names end in the last line above their columns.
            let part = |name: &Vec<String>| (k + name.len()).checked_sub(high).map_or("", |at| &name[at]).to_owned();
            self.row(&names.iter().map(part).collect::<Vec<_>>(), &widths, gap);
        }
        for row in body {
            self.row(row, &widths, gap);
        }
    }

    /// One line of a table.
    fn row(&mut self, cells: &[String], widths: &[usize], gap: usize) {
        let mut line = String::from(" ");
        for (column, (cell, width)) in cells.iter().zip(widths).enumerate() {
            let _ =
                if column == 0 { write!(line, " {cell:<width$}") } else { write!(line, "{:gap$}{cell:>width$}", "") };
        }
        let _ = writeln!(self.text, "{}", line.trim_end());
    }

    /// Adds another sheet, set off by an empty line, if both together have no more than so many lines; whether it did.
    pub fn append_within(&mut self, other: &Self, most: usize) -> bool {
        let fits = !other.text.is_empty() && other.text.lines().count() < most;
        if fits {
            let gap = if self.text.is_empty() { "" } else { "\n" };
            let _ = write!(self.text, "{gap}{}", other.text);
        }
        fits
    }

    /// How many lines it has.
    pub fn count_lines(&self) -> usize {
        self.text.lines().count()
    }

    /// Whether one of its lines has more characters.
    pub fn is_wider_than(&self, width: usize) -> bool {
        self.text.lines().any(|line| line.chars().count() > width)
    }

    /// The text, ending with a newline.
    pub fn into_text(self) -> String {
        self.text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_as_wide_as_its_column_keeps_apart_from_its_value() {
        let mut sheet = Sheet::default();
        sheet.line("mean power while a slot is rolled", "216.9 W");
        sheet.line("time", "3 s");
        assert_eq!(
            sheet.into_text(),
            format!("  mean power while a slot is rolled  216.9 W\n  time{}3 s\n", " ".repeat(26))
        );
    }

    #[test]
    fn a_brief_sheet_leaves_out_tables_details_and_headings_of_nothing() {
        let print = |mut sheet: Sheet| {
            sheet.heading("title");
            sheet.heading("Peaks");
            sheet.table(&[vec!["axis".to_owned(), "1".to_owned()]]);
            sheet.heading("Cost");
            sheet.details(|sheet| sheet.line("memory", "24 MB"));
            sheet.line("time", "8 s");
            sheet.into_text()
        };
        let time = format!("  time{}8 s\n", " ".repeat(26));
        assert_eq!(print(Sheet::brief()), format!("title\n\nCost\n{time}"));
        let whole = print(Sheet::default());
        assert!(whole.contains("\nPeaks\n  axis   1\n") && whole.contains("24 MB"), "{whole}");
    }

    #[test]
    fn values_and_columns_stand_below_each_other() {
        let mut sheet = Sheet::default();
        sheet.heading("Machine");
        sheet.line("strokes", "4200");
        sheet.table(&[vec!["axis".into(), "peak".into()], vec!["work spindle".into(), "5.7 deg/s".into()]]);
        let expected =
            "Machine\n  strokes                       4200\n  axis                peak\n  work spindle   5.7 deg/s\n";
        assert_eq!(sheet.into_text(), expected);
    }

    #[test]
    fn names_of_columns_are_broken_where_a_table_would_be_too_wide() {
        let mut sheet = Sheet::default();
        let row = |cells: [&str; 4]| cells.map(str::to_owned).to_vec();
        let bar = "|################################|";
        sheet.table(&[row(["a", "retraction angle of it", "", ""]), row(["1", "0.00 deg", bar, bar])]);
        let expected = format!("     retraction\n       angle of\n  a          it\n  1    0.00 deg  {bar}  {bar}\n");
        assert_eq!(sheet.into_text(), expected);
    }
}
