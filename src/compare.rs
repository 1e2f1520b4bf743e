//! Results of one process side by side: numbers with their differences, and bars tooth by tooth.
//!
//! In: two to seven [`AnyResults`] of one process with the names to show them by; the first is what the others are held against. Out: [`Comparison`], which prints itself and writes into a folder:
//!
//! | file | what |
//! | --- | --- |
//! | `comparison.csv` | one line per number: unit, the values a, b, ..., their differences to a, definition |
//! | shaped gears: `unevenness_first_period.png`, `.svg` | unevenness of the allowance by tooth of the gear over the first period of the pitch curve, with mean lines (Gao et al. 2017, Fig. 10) |
//! | `unevenness_all_teeth.png`, `.svg` | the same over all teeth |
//! | `unevenness_a.png`, `unevenness_b.png`, ..., `.svg` | one result each, on its own scale, first period |
//! | hobbed gears: `load_<operation>_volume.png`, `.svg` | volume that each tooth of the hob takes over the whole process |
//! | `load_<operation>_thickness.png`, `.svg` | its largest uncut chip thickness |
//! | `load_<operation>_way.png`, `.svg` | way of its tip through the work |
//!
//! Results of different gears may be compared: what one of them lacks stays empty.

mod hob_load;
mod lines;
mod table;
mod unevenness;

use crate::Result;
use crate::output::bar_chart::BarChart;
use crate::output::folder::OutputFolder;
use crate::output::results::{AnyResults, HobbedResults, Results};
use crate::output::text::Sheet;
use lines::Line;

/// Most results that stand side by side: as many as a chart has colours for.
pub const MOST_RESULTS: usize = 7;

/// One of the results.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared<R> {
    /// Name in tables and legends.
    pub name: String,
    /// What was found.
    pub results: R,
}

/// The results by process.
#[derive(Debug, Clone, PartialEq)]
enum Group {
    Shaped(Vec<Compared<Results>>),
    Hobbed(Vec<Compared<HobbedResults>>),
}

/// Results and the lines in which they are compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    names: Vec<String>,
    /// Names of those that were stopped before all flanks were cut.
    stopped: Vec<String>,
    group: Group,
    lines: Vec<Line>,
}

impl Comparison {
    /// Compares; equal names are told apart by letters.
    ///
    /// # Errors
    /// In words: results of different processes, or too few or too many of them.
    pub fn new(results: Vec<Compared<AnyResults>>) -> Result<Self, String> {
        if !(2..=MOST_RESULTS).contains(&results.len()) {
            return Err(format!("2 to {MOST_RESULTS} results stand side by side, not {}", results.len()));
        }
        let first = (&results[0].name, results[0].results.process());
        if let Some(other) = results.iter().find(|other| other.results.process() != first.1) {
            return Err(format!(
                "{} was made by {} and {} by {}: compare results of one process",
                first.0,
                first.1,
                other.name,
                other.results.process()
            ));
        }
        let given: Vec<String> = results.iter().map(|one| one.name.clone()).collect();
        let named = results.into_iter().zip(letters()).map(|(mut one, letter)| {
            if given.iter().filter(|name| **name == one.name).count() > 1 {
                one.name = format!("{} ({letter})", one.name);
            }
            one
        });
        let (mut names, mut stopped) = (Vec::new(), Vec::new());
        let (mut shaped, mut hobbed) = (Vec::new(), Vec::new());
        for Compared { name, results } in named {
            names.push(name.clone());
            if !results.is_complete() {
                stopped.push(name.clone());
            }
            match results {
                AnyResults::Shaped(results) => shaped.push(Compared { name, results: *results }),
                AnyResults::Hobbed(results) => hobbed.push(Compared { name, results: *results }),
            }
        }
        let (group, lines) = if hobbed.is_empty() {
            let lines = lines::of_shaped(&shaped);
            (Group::Shaped(shaped), lines)
        } else {
            let lines = lines::of_hobbed(&hobbed);
            (Group::Hobbed(hobbed), lines)
        };
        Ok(Self { names, stopped, group, lines })
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

    /// The charts with their file names.
    fn charts(&self) -> Vec<(String, BarChart)> {
        match &self.group {
            Group::Shaped(results) => unevenness::charts(results),
            Group::Hobbed(results) => hob_load::charts(results),
        }
    }

    /// The table for the terminal.
    pub fn print(&self, sheet: &mut Sheet) {
        let (last, others) = self.names.split_last().expect("two or more");
        sheet.heading(&format!("{} and {last}", others.join(", ")));
        sheet.table(&self.printed_rows());
        for name in &self.stopped {
            sheet.line("", format!("{name} was stopped before all flanks were cut"));
        }
    }
}

/// `a`, `b`, ... for the results in their order.
fn letters() -> impl Iterator<Item = char> {
    'a'..='z'
}
