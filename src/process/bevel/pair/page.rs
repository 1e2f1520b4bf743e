//! The page of a bevel pair: `report.html`.

use super::findings::{self, words};
use super::{RolledBevels, bearing};
use crate::findings::{Datum, Findings, Table, TableColumn, unit};
use crate::number_text::{plain, significant};
use crate::output::folder::OutputFolder;
use crate::output::line_chart::LineChart;
use crate::output::report::{Block, Page, PageSection, PageTable};
use crate::process::bevel::BevelJob;
use crate::process::bevel::check::gear_words;
use crate::steps;
use crate::steps::report::{page_of, quantities};
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;

/// What the jobs of a pair are.
const ROLES: [&str; 3] = ["gear", "pinion", "pinion, concave flanks"];

/// The end of the page: the files, and what is needed to roll the pair again, scenes of gear and pinion.
///
/// # Errors
/// The folder cannot be read.
pub fn ending(folder: &OutputFolder, scenes: &[String]) -> Result<[PageSection; 2]> {
    let words = ROLES.map(|role| format!("The scene of the {role}, every value written out"));
    let scenes: Vec<(&str, &str)> = words.iter().map(String::as_str).zip(scenes.iter().map(String::as_str)).collect();
    steps::report::ending(folder, ["Flanks", "the targets of both scenes, not cut"], &scenes)
}

/// The page; `end` is [`ending`].
pub fn page(
    jobs: &[BevelJob],
    rolled: &RolledBevels,
    found: &Findings,
    motion_error: LineChart,
    end: [PageSection; 2],
) -> Page {
    let mut sections = vec![PageSection::new(
        "motion-error",
        "Motion error",
        "How unevenly the gear turns without load while the pinion turns evenly. At every moment the pair of teeth \
        carries that is ahead, in the sense in which these flanks drive.",
        vec![Block::Lines(motion_error)],
    )];
    for (side, id) in rolled.sides.iter().zip(["concave", "convex"]) {
        let name = words(side);
        sections.push(PageSection::new(
            id,
            format!("Contact on {name} flanks of the gear"),
            format!("Marking: {} µm.", plain(UM_PER_MM * rolled.marking_mm)),
            vec![
                Block::Drawing(format!("Bearing on {name} flanks"), bearing::svg(side, rolled.marking_mm)),
                Block::Table(quantities::table(&findings::side(side))),
                Block::Table(rows(&findings::trends(side))),
            ],
        ));
    }
    sections.push(PageSection::new(
        "pair",
        "Pair and mounting",
        "Gleason's letters and the names of ISO 23509.",
        vec![Block::Table(quantities::table(&findings::mounted(jobs, rolled)))],
    ));
    sections.extend(end);
    let roles = jobs.iter().zip(ROLES);
    Page {
        what: "tooth contact report",
        subtitle: format!(
            "shaft angle {}°, offset {} mm",
            plain(rolled.nominal.shaft_angle_rad.to_degrees()),
            plain(rolled.nominal.offset_mm)
        ),
        operations: roles.map(|(job, role)| format!("{role}: {}. {}", job.scene.name, gear_words(job))).collect(),
        done: "both sides rolled over a pitch",
        sections,
        ..page_of(found)
    }
}

/// A table of findings on the page.
fn rows(table: &Table) -> PageTable {
    let cell = |datum: &Datum| match datum.number() {
        Some(number) => significant(number, 4).replace('-', "−"),
        None => datum.name(),
    };
    PageTable {
        caption: table.title.clone(),
        columns: table.columns.iter().map(head).collect(),
        rows: table.rows().map(|row| row.iter().map(cell).collect()).collect(),
    }
}

/// What it is called, with the unit in brackets.
fn head(column: &TableColumn) -> String {
    match column.unit.as_deref() {
        Some(of) => format!("{} [{}]", column.title, unit::signs(of)),
        None => column.title.to_string(),
    }
}
