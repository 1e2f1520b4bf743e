//! Every number that a cut of a scene reports, by its path.
//!
//! In: a scene. Out: the numbers of its findings: those of the headline as `headline.KEY`, those of sections by the
//! path of `results.json`, figures of the inspection by `inspection.figures.FIGURE.left`. The gear is cut as by
//! `gearcut cut --only numbers`; its folder vanishes. Windows of texture can be had alone.

use crate::backend::Choice;
use crate::findings::{Quantity, Section, Table};
use crate::interrupt::Interrupt;
use crate::process;
use crate::progress::{Progress, ProgressMode};
use crate::run::Run;
use crate::scene::LoadedScene;
use crate::steps::parts::Parts;
use crate::texture;
use crate::texture::quantities::{ROUGHNESS, TEXTURE};
use gearcut_core::error::{Error, Result};
use gearcut_core::terms::Side;
use std::collections::BTreeMap;

/// Paths with numbers and their units.
pub type Numbers = BTreeMap<String, (f64, String)>;

/// Key of the first column of tables whose rows are named figures.
const FIGURE: &str = "figure";

/// Numbers of a scene.
///
/// # Errors
/// Geometry that cannot be cut; the backend's; files; Ctrl-C.
pub fn numbers(loaded: &LoadedScene, choice: &Choice, interrupt: &Interrupt) -> Result<Numbers> {
    let folder = tempfile::tempdir().map_err(Error::writing("a temporary folder"))?;
    let prepared = process::prepare(&loaded.scene)?;
    let run = Run::new(loaded, prepared.as_ref(), choice).until(interrupt).only(Parts::NONE);
    let found = run.into_folder(&folder.path().join("numbers"))?.findings;
    interrupt.check()?;
    let mut numbers = Numbers::new();
    for entry in &found.headline {
        add(&mut numbers, format!("headline.{}", entry.key), &entry.quantity);
    }
    found.walk(&mut |path, section| add_section(&mut numbers, path, section));
    Ok(numbers)
}

/// The same numbers of a scene's texture windows alone, of those flanks that are asked for: nothing else is cut.
///
/// # Errors
/// As for [`numbers`].
pub fn texture_numbers(
    loaded: &LoadedScene,
    flanks: &[(u32, Side)],
    choice: &Choice,
    interrupt: &Interrupt,
) -> Result<Numbers> {
    let mut numbers = Numbers::new();
    let quiet = Progress::new(ProgressMode::Quiet);
    process::prepare(&loaded.scene)?.with_gear(&mut |gear| {
        let mut windows = texture::windows(gear)?;
        windows.retain(|window| flanks.contains(&(window.tooth, window.side)));
        let windows = texture::sampled(gear, &windows)?;
        let textures = texture::measure(gear, &windows, choice.backend.as_ref(), &quiet, interrupt)?;
        interrupt.check()?;
        for section in [texture::findings(gear, &textures), texture::roughness(gear, &textures)] {
            section.walk(&section.key, &mut |path, section| add_section(&mut numbers, path, section));
        }
        Ok(())
    })?;
    Ok(numbers)
}

/// The window that the number of a path belongs to (such as `finish.tooth_03_left`) and its symbol, if it is one of a
/// window's surface or of the lines across it.
pub fn of_window(quantity: &str) -> Option<(&str, &str)> {
    let (path, symbol) = quantity.rsplit_once('.')?;
    if let Some(window) = path.strip_prefix(TEXTURE.key).and_then(|rest| rest.strip_prefix('.')) {
        return Some((window.strip_suffix(".parameters").unwrap_or(window), symbol));
    }
    let lines = path.strip_prefix(ROUGHNESS.key)?.strip_prefix('.')?;
    let window = texture::Direction::BOTH.into_iter().find_map(|way| lines.strip_suffix(way.key())?.strip_suffix('_'));
    Some((window?, symbol))
}

fn add(numbers: &mut Numbers, path: String, quantity: &Quantity) {
    if let Some(value) = quantity.value() {
        numbers.insert(path, (value, quantity.unit().unwrap_or_default().to_owned()));
    }
}

/// Quantities of a section, and the cells of its tables of figures as `TABLE.FIGURE.COLUMN`.
fn add_section(numbers: &mut Numbers, path: &str, section: &Section) {
    for entry in &section.entries {
        add(numbers, format!("{path}.{}", entry.key), &entry.quantity);
    }
    let of_figures = |table: &&Table| table.columns.first().is_some_and(|column| column.key == FIGURE);
    for table in section.tables.iter().filter(of_figures) {
        for row in table.rows() {
            for (column, cell) in table.columns.iter().zip(&row).skip(1) {
                if let Some(value) = cell.number() {
                    let unit = column.unit.as_deref().unwrap_or_default().to_owned();
                    numbers.insert(format!("{path}.{}.{}.{}", table.key, row[0].name(), column.key), (value, unit));
                }
            }
        }
    }
}
