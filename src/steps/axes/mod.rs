//! What every operation asks of a machine's axes: tables, charts, peaks against limits, programs, once for all
//! processes.
//!
//! In: operations that tell how the axes of their machine move ([`AxesOfOperation`]). Out: lines and warnings for the
//! terminal, findings, the files in `axes/`, the page's section. Names and units follow from the axes
//! ([`crate::machine`]); a process adds what only it knows (strokes, relief, feeds, marks), how it speaks of a place,
//! and the way out of an exceeded limit.

pub mod charts;
mod peaks;
mod table;
#[cfg(test)]
mod tests;

pub use peaks::{Named, PeakWords, STEADY, findings, margin};
pub use table::{positions, rates};

use crate::findings::notices::NoProgram;
use crate::findings::quantities::OPERATIONS;
use crate::findings::quantities::cutting::{AXIS_MARGIN, NO_LIMITS};
use crate::findings::table::table_file;
use crate::findings::{Findings, Notice, Section, Severity, Table};
use crate::interrupt::Interrupt;
use crate::machine::{Peak, smallest_margin};
use crate::output::atomic::write_bytes_atomically;
use crate::output::bar_chart::BarChart;
use crate::output::folder::OutputFolder;
use crate::output::line_chart::LineChart;
use crate::output::report::{Block, PageSection, Tone};
use crate::output::table::write_table;
use crate::output::text::Sheet;
use crate::scene::Scene;
use crate::steps::report::peak_table;
use gearcut_core::error::{Error, Result};

/// A chart with the word that ends the name of its file.
pub type NamedChart<C> = (&'static str, C);

/// How the axes of a machine move in one operation.
pub trait AxesOfOperation {
    /// Name of the operation; its files are named after it.
    fn name(&self) -> &str;

    /// The linkage in words.
    fn linkage_words(&self) -> String;

    /// How this process speaks of peaks.
    fn peak_words(&self) -> &PeakWords;

    /// Peaks of the axes in the order in which they are listed.
    fn peaks(&self) -> &[Peak];

    /// Where a peak is, in the unit of [`PeakWords::place`].
    fn place(&self, peak: &Peak) -> f64;

    /// Heading and facts for the terminal, the table of peaks apart.
    fn print_facts(&self, sheet: &mut Sheet);

    /// Whether a program under test makes this motion: an exceeded limit is a fault then.
    fn is_under_test(&self) -> bool {
        false
    }

    /// What the user should know beside exceeded limits.
    fn own_warnings(&self) -> Vec<Notice>;

    /// The axis table.
    fn table(&self) -> Table;

    /// Charts of the motion; the first one is shown first.
    fn charts(&self) -> &[NamedChart<LineChart>];

    /// Charts of what can be told before anything is cut.
    ///
    /// # Errors
    /// A search that finds nothing.
    fn forecasts(&self) -> Result<Vec<NamedChart<BarChart>>> {
        Ok(Vec::new())
    }

    /// Programs, each with the name of its file, `warnings` in their heads; an error is the reason why there are none,
    /// `None`: none are wanted.
    fn programs(&self, warnings: &[Notice]) -> Option<Result<Vec<(String, String)>, String>>;
}

/// Facts and peaks of an operation.
pub fn print(operation: &impl AxesOfOperation, sheet: &mut Sheet) {
    operation.print_facts(sheet);
    sheet.table(&peaks::rows(operation));
}

/// What the user should know before cutting: limits exceeded, what the process says, and operations for which no
/// program can be written, with the reason.
pub fn warnings<O: AxesOfOperation>(operations: &[O]) -> Vec<Notice> {
    let of = |operation: &O| -> Vec<Notice> {
        let left_out = operation.programs(&[]).and_then(Result::err);
        let left_out = left_out.map(|why| NoProgram { operation: operation.name(), why }.notice());
        peaks::exceeded(operation).chain(operation.own_warnings()).chain(left_out).collect()
    };
    operations.iter().flat_map(of).collect()
}

/// What is found of the axes alone: peaks of every operation under the paths that a cut has them at, the smallest
/// margin in the headline, and exceeded limits as notices.
pub fn found<O: AxesOfOperation>(scene: &Scene, operations: &[O]) -> Findings {
    let sections = operations.iter().map(|of| Section::new(of.name(), of.linkage_words()).part(findings(of)));
    let all = OPERATIONS.section([]).parts(sections);
    let margin = AXIS_MARGIN.of_or(margin(operations), NO_LIMITS);
    let exceeded: Vec<Notice> = operations.iter().flat_map(peaks::exceeded).collect();
    Findings::new(scene.process_name(), &scene.name, true, [margin], exceeded, vec![all])
}

/// Writes tables and charts of the motion into the folder's `axes/`.
///
/// # Errors
/// Files that cannot be written.
pub fn write(operation: &impl AxesOfOperation, folder: &OutputFolder) -> Result<()> {
    let name = operation.name();
    write_table(&folder.path(table_file(&format!("axes/{name}")))?, &operation.table())?;
    for (what, chart) in operation.charts() {
        chart.write_svg(&folder.path(format!("axes/{name}_{what}.svg"))?)?;
    }
    Ok(())
}

/// Charts of the motion as SVG, by the names of their files without endings.
///
/// # Errors
/// A chart that cannot be drawn.
pub fn svg_charts(operations: &[impl AxesOfOperation]) -> Result<Vec<(String, String)>> {
    let of = |operation: &_, (what, chart): &NamedChart<LineChart>| {
        let file = format!("{}_{what}", AxesOfOperation::name(operation));
        match chart.svg() {
            Ok(svg) => Ok((file, svg)),
            Err(reason) => Err(Error::Output { path: file.into(), reason }),
        }
    };
    operations.iter().flat_map(|operation| operation.charts().iter().map(move |chart| of(operation, chart))).collect()
}

/// Writes the programs of all operations into `axes/`, the faults and warnings among `warnings` in their heads: notes
/// say how to read numbers, and nothing at the machine hangs on how texture is sampled. An operation that has none is
/// told in [`warnings`].
///
/// # Errors
/// Files that cannot be written.
pub fn write_programs<O: AxesOfOperation>(operations: &[O], warnings: &[Notice], folder: &OutputFolder) -> Result<()> {
    let concerns = |of: &&Notice| of.severity > Severity::Note && !of.id.starts_with("texture.");
    let head: Vec<Notice> = warnings.iter().filter(concerns).cloned().collect();
    for operation in operations {
        let Some(Ok(programs)) = operation.programs(&head) else { continue };
        for (file, text) in programs {
            write_bytes_atomically(&folder.path(format!("axes/{file}"))?, text.as_bytes())?;
        }
    }
    Ok(())
}

/// All that the command `axes` writes and says, the job's `warnings` in the heads of programs; gives these back.
///
/// # Errors
/// Files that cannot be written; Ctrl-C.
pub fn command<O: AxesOfOperation>(
    operations: &[O],
    warnings: Vec<Notice>,
    folder: &OutputFolder,
    interrupt: &Interrupt,
    sheet: &mut Sheet,
) -> Result<Vec<Notice>> {
    for operation in operations {
        interrupt.check()?;
        write(operation, folder)?;
        let name = operation.name();
        for (what, chart) in operation.forecasts()? {
            chart.write_svg(&folder.path(format!("axes/{name}_{what}.svg"))?)?;
        }
        print(operation, sheet);
    }
    interrupt.check()?;
    write_programs(operations, &warnings, folder)?;
    Ok(warnings)
}

/// The page's section: peaks and first chart of every operation, the other charts folded under their name.
pub fn section<O: AxesOfOperation>(operations: &[O], found: &Findings, lead: &str, folded: &str) -> PageSection {
    let mut blocks = Vec::new();
    for (operation, found) in operations.iter().zip(found.parts(&OPERATIONS)) {
        blocks.push(Block::Heading(format!("{}: {}", operation.name(), operation.linkage_words())));
        blocks.push(Block::Table(peak_table(found)));
        let mut charts = operation.charts().iter().map(|(_, chart)| Block::Lines(chart.clone()));
        blocks.extend(charts.next());
        blocks.push(Block::Folded(folded.to_owned(), charts.collect()));
    }
    let (tone, words) = match smallest_margin(operations.iter().flat_map(AxesOfOperation::peaks)) {
        Some(left) if left < 0.0 => (Tone::Wrong, format!("a limit is exceeded by {:.0} %", -100.0 * left)),
        Some(left) => (Tone::Fine, format!("within all limits, {:.0} % left of the tightest", 100.0 * left)),
        None => (Tone::Aside, "the scene gives no axis limits".to_owned()),
    };
    PageSection::new("motion", "Axis motion", lead, blocks).judged(tone, words)
}
