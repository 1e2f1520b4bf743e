//! Results side by side: numbers with their differences, and bars tooth by tooth.
//!
//! In: two to seven [`Findings`] with the names to show them by; the others are compared with the first.
//! Out: [`Comparison`], which prints itself and writes into a folder:
//!
//! | file | what |
//! | --- | --- |
//! | `report.html` | all of it on one page: what changed most, maps, charts, headline and summary |
//! | `comparison.csv` | one line per quantity: unit, the values a, b, ..., differences to a, a over them, definition |
//! | `<path>_<column>.svg` | bars of a column that asks for them, all rows |
//! | `<path>_<column>_first_period.svg` | the rows of the pitch curve's first period (Gao et al. 2017, Fig. 10) |
//! | `<path>_<column>_a.svg`, `_b.svg`, ... | one result each, on its own scale |
//! | `<path>.svg` | curves of the columns that ask for them, such as the transmission error of pairs |
//! | `difference_deviation_b_minus_a.png` | deviations of b less those of a, all flanks, where they differ |
//! | `difference_allowance_b_minus_a.png` | the same of what the operation before leaves |
//!
//! Everything is read from the trees by path, whatever the process: what joins the tree joins the comparison. Results
//! of different gears may be compared: what one of them lacks stays empty. Of results of different processes, such as a
//! hobbed and a shaped gear of one drawing, the numbers are compared that two of them have, without charts. Places are
//! not compared. The terminal shows what changed most, and all of headline and summary where that is wanted.

mod charts;
mod lines;
mod maps;
pub(crate) mod notices;
mod page;
pub(crate) mod quantities;
mod ranked;
pub mod surfaces;
mod table;

use crate::findings::table::table_file;
use crate::findings::{Findings, Level};
use crate::output::folder::OutputFolder;
use crate::output::report::REPORT_FILE;
use crate::output::table::write_table;
use crate::output::text::Sheet;
use gearcut_core::Result;
use lines::Line;
use quantities::COMPARISON;
use std::path::PathBuf;

/// Most results that stand side by side: as many as a chart has colours for.
pub const MOST_RESULTS: usize = 7;

/// One of the results.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Name in tables and legends.
    pub name: String,
    /// What was found.
    pub findings: Findings,
    /// Its folder, in which tables are that `results.json` only names.
    pub folder: PathBuf,
}

/// Results and the lines in which they are compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    results: Vec<Compared>,
    lines: Vec<Line>,
    /// Whether they are of more than one process.
    is_mixed: bool,
}

impl Comparison {
    /// Compares; equal names are told apart by letters.
    ///
    /// # Errors
    /// In words: too few or too many results, or results of different processes without a number in common.
    pub fn new(mut results: Vec<Compared>) -> Result<Self, String> {
        if !(2..=MOST_RESULTS).contains(&results.len()) {
            return Err(format!("2 to {MOST_RESULTS} results can be compared, not {}", results.len()));
        }
        let given: Vec<String> = results.iter().map(|one| one.name.clone()).collect();
        for (one, letter) in results.iter_mut().zip(letters()) {
            if given.iter().filter(|name| **name == one.name).count() > 1 {
                one.name = format!("{} ({letter})", one.name);
            }
        }
        let mut lines = lines::lines(&results);
        let first = &results[0];
        let foreign = results.iter().find(|other| other.findings.process != first.findings.process);
        if let Some(other) = foreign {
            lines.retain(Line::is_shared);
            if lines.is_empty() {
                return Err(format!(
                    "{} was made by {} and {} by {}: they have no number in common",
                    first.name, first.findings.process, other.name, other.findings.process
                ));
            }
        }
        let is_mixed = foreign.is_some();
        Ok(Self { results, lines, is_mixed })
    }

    /// Writes table, charts, maps and page.
    ///
    /// # Errors
    /// Files that cannot be written; tables of the results that cannot be read.
    pub fn write(&self, folder: &OutputFolder) -> Result<()> {
        write_table(&folder.path(table_file(COMPARISON.key))?, &self.as_table())?;
        let drawn: &[Compared] = if self.is_mixed { &[] } else { &self.results };
        let (bars, curves) = (charts::charts(drawn), charts::curves(drawn)?);
        for (name, chart) in &bars {
            chart.write_svg(&folder.path(format!("{name}.svg"))?)?;
        }
        for (name, chart) in &curves {
            chart.write_svg(&folder.path(format!("{name}.svg"))?)?;
        }
        let maps = self.write_maps(folder)?;
        page::page(self, bars, curves, maps).write(&folder.path(REPORT_FILE)?)
    }

    /// What is said where no number changed, and of the numbers of headline and summary that stand in some results and
    /// not in others; empty where there is nothing to say.
    fn beside_changes(&self, changed: bool) -> Vec<String> {
        let count = self.lines.iter().filter(|line| line.level <= Level::Summary && line.is_one_sided()).count();
        let nothing = if count == 0 { "nothing changed" } else { "nothing changed of what all results have" };
        let one_sided = match count {
            0 => None,
            1 => Some("1 number is in some of the results only".to_owned()),
            _ => Some(format!("{count} numbers are in some of the results only")),
        };
        (!changed).then(|| nothing.to_owned()).into_iter().chain(one_sided).collect()
    }

    /// What changed most, for the terminal, or `all` lines of headline and summary; where a line has a width and a
    /// table is wider, names stand above their numbers.
    pub fn print(&self, sheet: &mut Sheet, width: Option<usize>, all: bool) {
        let names: Vec<&str> = self.results.iter().map(|one| one.name.as_str()).collect();
        let (last, others) = names.split_last().expect("two or more");
        sheet.heading(&format!("{} and {last}", others.join(", ")));
        let ranked = ranked::ranked(&self.lines, &ranked::limits_um(&self.results));
        if !ranked.is_empty() {
            sheet.heading("Changed most");
            self.print_rows(sheet, width, ranked.iter().take(ranked::FIRST).map(|(line, _)| *line));
        }
        for words in self.beside_changes(!ranked.is_empty()) {
            sheet.words(&words);
        }
        if all {
            sheet.heading("All");
            self.print_rows(sheet, width, self.lines.iter().filter(|line| line.level <= Level::Summary));
        }
        for one in self.results.iter().filter(|one| !one.findings.complete) {
            sheet.line("", format!("{} was stopped before all flanks were cut", one.name));
        }
    }
}

/// `a`, `b`, ... for the results in their order.
fn letters() -> impl Iterator<Item = char> {
    'a'..='z'
}
