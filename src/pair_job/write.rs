//! What a pair writes: results, tables, charts, contact patterns, an animation, the page.

use super::charts;
use super::flanks::FlankSource;
use super::options::PairOptions;
use super::page::{PageParts, PairRecord, ending, page};
use super::pictures::{write_animation, write_pattern};
use super::rolled::RolledPair;
use super::watch::Watch;
use crate::findings::{Findings, RESULTS_FILE};
use crate::output::folder::OutputFolder;
use crate::output::report::REPORT_FILE;
use crate::output::table::write_tables;
use crate::pair::pitch_pair::Member;
use crate::scene::Scene;
use gearcut_core::error::{Error, Result};

/// Writes everything but the run record.
///
/// # Errors
/// Files that cannot be written; Ctrl-C.
pub fn write(
    scenes: [&Scene; 2],
    options: &PairOptions,
    rolled: &RolledPair,
    found: &Findings,
    folder: &OutputFolder,
    record: &PairRecord,
    watch: &Watch,
) -> Result<()> {
    write_tables(found, folder)?;
    let lines = charts::lines(rolled);
    for (name, chart) in &lines {
        chart.write_svg(&folder.path(format!("pictures/{name}.svg"))?)?;
    }
    if let Some(chart) = charts::waves(found) {
        chart.write_svg(&folder.path("pictures/waves.svg")?)?;
    }
    let bytes = |name: &str| {
        let path = folder.path(name)?;
        std::fs::read(&path).map_err(Error::reading(path))
    };
    let mut patterns = Vec::new();
    for (member, scene, gear) in [(Member::Driver, scenes[0], "A"), (Member::Driven, scenes[1], "B")] {
        if let Some(name) = write_pattern(rolled, member, scene, options.marking_um, folder)? {
            patterns.push((format!("Contact pattern on all flanks of gear {gear}"), bytes(&name)?));
        }
        watch.check()?;
    }
    let animation = bytes(&write_animation(rolled, options.marking_um, folder, watch)?)?;
    let flanks = match options.source {
        FlankSource::Cut => format!("cut by {}", record.backend),
        FlankSource::Nominal => "nominal, not cut".to_owned(),
    };
    let parts = PageParts { patterns, animation, end: ending(folder, &flanks, record)? };
    let page = page(scenes, options, rolled, found, &lines, parts);
    page.write(&folder.path(REPORT_FILE)?)?;
    folder.write_json(RESULTS_FILE, &found.to_json())
}
