//! Every number that a cut of a scene reports, by its path.
//!
//! In: a scene. Out: the numbers of its findings: those of the headline as `headline.KEY`, those of sections by the
//! path of `results.json`. The gear is cut as by `gearcut cut --only numbers`; its folder vanishes.

use crate::backend::Choice;
use crate::interrupt::Interrupt;
use crate::process;
use crate::run::Run;
use crate::scene::LoadedScene;
use crate::steps::parts::Parts;
use gearcut_core::error::{Error, Result};
use std::collections::BTreeMap;

/// Paths with numbers and their units.
pub type Numbers = BTreeMap<String, (f64, String)>;

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
    let mut add = |path: String, quantity: &crate::findings::Quantity| {
        if let Some(value) = quantity.value() {
            numbers.insert(path, (value, quantity.unit().unwrap_or_default().to_owned()));
        }
    };
    for entry in &found.headline {
        add(format!("headline.{}", entry.key), &entry.quantity);
    }
    found.walk(&mut |path, section| {
        for entry in &section.entries {
            add(format!("{path}.{}", entry.key), &entry.quantity);
        }
    });
    Ok(numbers)
}
