//! The gears of a pair, as they are named on the command line.
//!
//! In: a scene file, or a folder that `gearcut cut` has written, and settings that change keys. Out: a loaded scene.
//!
//! A folder of results is read by its run record, which holds the scene with every value written out and the way to the
//! files that it names: flanks are cut
//! again in the sections that are rolled, with the same bytes as in that run. Its maps are not used: they stand 0.1 mm
//! apart, scallops are some tens of micrometres wide.

use std::path::Path;

use crate::output::folder::{RUN_RECORD, SCENE_FOLDER};
use crate::process;
use crate::scene::{LoadedScene, Mate};
use gearcut_core::error::{Error, Result};
use serde_json::Value;

/// Reads a gear of a pair.
///
/// # Errors
/// No such file, a folder that `gearcut cut` did not write, problems of the scene.
pub fn read(path: &Path, settings: &[String]) -> Result<LoadedScene> {
    if !path.is_dir() {
        return Ok(process::load(path, settings)?);
    }
    let record_path = path.join(RUN_RECORD);
    let unreadable = |reason: String| Error::Unreadable { path: record_path.clone(), reason };
    let text = std::fs::read(&record_path).map_err(Error::reading(&record_path))?;
    let record: Value = serde_json::from_slice(&text).map_err(|reason| unreadable(reason.to_string()))?;
    let command = record.get("command").and_then(Value::as_str).unwrap_or("nothing that it tells");
    let scene = record.get("scene").and_then(Value::as_str).filter(|_| command == "cut").ok_or_else(|| {
        unreadable(format!("it is the record of {command}, not of a cut gear: give a folder that `gearcut cut` wrote"))
    })?;
    let files = record.get(SCENE_FOLDER).and_then(Value::as_str).map_or_else(|| path.to_owned(), |way| path.join(way));
    let mut loaded = process::parse(scene, &record_path.display().to_string(), &files, settings)?;
    if let Some(name) = path.canonicalize().ok().as_deref().and_then(Path::file_name) {
        loaded.scene.name = name.to_string_lossy().into_owned();
    }
    Ok(loaded)
}

/// The mate of a driver, cut alike, as a scene in the driver's folder.
///
/// # Errors
/// No such gear runs with the driver; settings that its scene does not take.
pub fn mate(driver: &LoadedScene, mate: Mate, settings: &[String]) -> Result<LoadedScene> {
    let text = driver.mate(mate, driver.base_dir())?.text;
    let name = format!("{}_mate_{}.toml", driver.scene.name, mate.teeth);
    Ok(process::parse(&text, &name, driver.base_dir(), settings)?)
}
