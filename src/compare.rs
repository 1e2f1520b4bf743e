//! Two results side by side: headline numbers with their differences, and the unevenness of the allowance tooth by tooth.
//!
//! In: two [`Results`] with the names to show them by. Out: [`Comparison`], which prints itself and writes into a folder:
//!
//! | file | what |
//! | --- | --- |
//! | `comparison.csv` | one line per number: unit, both values, difference b - a, definition |
//! | `unevenness_first_period.png`, `.svg` | bars by tooth over the first period of the pitch curve, with mean lines (Gao et al. 2017, Fig. 10) |
//! | `unevenness_all_teeth.png`, `.svg` | the same over all teeth |
//! | `unevenness_a.png`, `unevenness_b.png`, `.svg` | one result each, on its own scale, first period |
//!
//! Results of different gears may be compared: what one of them lacks stays empty.

mod chart;
mod table;

use crate::Result;
use crate::output::folder::OutputFolder;
use crate::output::quantity::Quantity;
use crate::output::results::Results;
use crate::output::text::Sheet;

/// One of the two results.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Name in tables and legends.
    pub name: String,
    /// What was found.
    pub results: Results,
}

/// One line of the comparison.
#[derive(Debug, Clone, PartialEq)]
struct Line {
    /// Key in `results.json`, with the operation's name in front where there is one.
    name: String,
    a: Option<Quantity>,
    b: Option<Quantity>,
}

/// Two results and the lines in which they are compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    a: Compared,
    b: Compared,
    lines: Vec<Line>,
}

impl Comparison {
    /// Compares; equal names are told apart by `a` and `b`.
    pub fn new(mut a: Compared, mut b: Compared) -> Self {
        if a.name == b.name {
            a.name.push_str(" (a)");
            b.name.push_str(" (b)");
        }
        let lines = table::lines(&a.results, &b.results);
        Self { a, b, lines }
    }

    /// Writes table and charts.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write(&self, folder: &OutputFolder) -> Result<()> {
        self.write_csv(&folder.path("comparison.csv")?)?;
        for (name, chart) in self.charts() {
            chart.write_png(&folder.path(format!("{name}.png"))?)?;
            chart.write_svg(&folder.path(format!("{name}.svg"))?)?;
        }
        Ok(())
    }

    /// The table for the terminal.
    pub fn print(&self, sheet: &mut Sheet) {
        sheet.heading(&format!("{} and {}", self.a.name, self.b.name));
        sheet.table(&self.printed_rows());
        for result in [&self.a, &self.b] {
            if !result.results.complete {
                sheet.line("", format!("{} was stopped before all flanks were cut", result.name));
            }
        }
    }
}
