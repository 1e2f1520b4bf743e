//! The files beside the page, as links.
//!
//! In: the folder as it stands when the page is written. Out: a section with a row for each subfolder: what it holds,
//! and its files; of many files of one kind the first few. Links are relative, so that they hold wherever the folder
//! goes.

use crate::findings::RESULTS_FILE;
use crate::output::folder::OutputFolder;
use crate::output::report::{Block, FileLinks, PageSection, Tone};
use gearcut_core::error::Result;

/// Files that are named one by one; of more, these are.
const NAMED: usize = 12;

/// What stands in a subfolder of results.
const CONTENTS: [(&str, &str); 11] = [
    ("tables", "every number by tooth, flank, stroke"),
    ("axes", "axis positions, speeds, accelerations, and programs"),
    ("chips", "chips of every stroke: charts and maps"),
    ("load", "work and forces of the tool's teeth"),
    ("allowance", "stock for the last operation over every flank"),
    ("deviation", "deviation of every finished flank"),
    ("maps", "surface after every operation, with pass and chip"),
    ("mesh", "the gear and its flanks as bodies"),
    ("pictures", "drawn gear, teeth, flanks, sheets"),
    ("texture", "surface texture of windows"),
    ("frames", "the cut as it happens"),
];

/// The section.
///
/// # Errors
/// The folder cannot be read.
pub fn section(folder: &OutputFolder) -> Result<PageSection> {
    let written = folder.written()?;
    let mut rows = vec![FileLinks {
        what: "every number with unit and definition; how to repeat the run".to_owned(),
        files: [RESULTS_FILE, "run.json"].map(str::to_owned).to_vec(),
        more: 0,
    }];
    for (name, what) in CONTENTS {
        let inside = format!("{name}/");
        let mut files: Vec<&String> = written.iter().filter(|file| file.starts_with(&inside)).collect();
        // What stands in the subfolder itself comes before what is deeper.
        files.sort_by_key(|file| file.matches('/').count());
        if files.is_empty() {
            continue;
        }
        rows.push(FileLinks {
            what: format!("{name}: {what}"),
            files: files.iter().take(NAMED).map(|&file| file.clone()).collect(),
            more: files.len().saturating_sub(NAMED),
        });
    }
    Ok(PageSection::new(
        "files",
        "Files",
        "What lies beside this page; the links hold while it stays in its folder.",
        vec![Block::Files(rows)],
    )
    .judged(Tone::Aside, format!("{} files beside this page", written.len())))
}
