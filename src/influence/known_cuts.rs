//! Cuts of trials that are made once: what each found stands on disk as soon as it is known.
//!
//! In: a scene, what is asked of its gear, and how to cut it. Out: the numbers, cut now or by an earlier run that was
//! stopped. Rows grow beside the result, in the folder that keeps what is not complete, as those of gears that scatter
//! do ([`crate::output::growing`]); the next run to the same name takes them up.
//!
//! The law: a cut is known by the SHA-256 of the program's version, of everything that the scene says, of the files
//! that it names, and of what is asked. So a run takes up what is the same, whatever else has changed, and no other.
//! Numbers are written with all their digits: what follows from them has the same bytes, whether they were cut or read.

use crate::findings::table::table_file;
use crate::output::folder::{OutputFolder, RUN_RECORD};
use crate::output::growing::{KeyedRows, RowFile, RowKind, RowValues, begin};
use crate::scene::Scene;
use gearcut_core::error::{Error, Result};
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::{self, Debug, Write};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// File of the rows, without its ending.
const CUTS: &str = "cuts";

/// Cuts that are known, and how many were made.
#[derive(Debug, Default)]
pub struct KnownCuts {
    place: Option<GrowingPlace>,
    rows: Mutex<KeyedRows<String>>,
    made: AtomicUsize,
    /// Keys of rows of an earlier run, each with whether this one took it.
    earlier: Mutex<BTreeMap<String, bool>>,
}

/// Where rows grow.
#[derive(Debug)]
struct GrowingPlace {
    folder: PathBuf,
    record: Map<String, Value>,
    /// Made with the first row.
    file: Mutex<Option<RowFile<String>>>,
    /// Whether this run made the folder.
    is_own: bool,
}

fn kind() -> RowKind {
    RowKind { header: "cut,values".to_owned(), numbers: None }
}

impl KnownCuts {
    /// Cuts that are kept in a folder, and those that an earlier run has left there; `record` says whose it is. A
    /// folder of another command is left alone, and nothing is kept.
    ///
    /// # Errors
    /// Rows that cannot be read.
    pub fn growing_in(folder: &Path, record: Map<String, Value>) -> Result<Self> {
        let there = fs::read(folder.join(RUN_RECORD)).ok();
        let there = there.and_then(|text| serde_json::from_slice::<Map<String, Value>>(&text).ok());
        if there.as_ref().is_some_and(|there| there.get("command") != record.get("command")) {
            return Ok(Self::default());
        }
        let path = folder.join(table_file(CUTS));
        let (file, rows) = if path.exists() {
            let (file, rows) = RowFile::open(&path, &kind())?;
            (Some(file), rows)
        } else {
            (None, KeyedRows::new())
        };
        let is_own = there.is_none();
        let place = GrowingPlace { folder: folder.to_owned(), record, file: Mutex::new(file), is_own };
        let earlier = rows.keys().map(|key| (key.clone(), false)).collect();
        Ok(Self { place: Some(place), rows: Mutex::new(rows), earlier: Mutex::new(earlier), ..Self::default() })
    }

    /// Numbers of a scene's gear: known ones, or what `cut` finds. `asked` tells what they are, beyond the scene.
    ///
    /// # Errors
    /// Those of the cut; rows that cannot be written.
    pub fn of(&self, scene: &Scene, asked: &str, cut: impl FnOnce() -> Result<RowValues>) -> Result<RowValues> {
        let Some(place) = &self.place else {
            self.made.fetch_add(1, Ordering::Relaxed);
            return cut();
        };
        let read = |path: &Path| fs::read(path).map_err(Error::reading(path));
        let files = scene.process.files_read().into_iter().map(read).collect::<Result<Vec<_>>>()?;
        let key = digest(&(env!("CARGO_PKG_VERSION"), scene, files, asked));
        if let Some(known) = locked(&self.rows).get(&key) {
            if let Some(taken) = locked(&self.earlier).get_mut(&key) {
                *taken = true;
            }
            return Ok(known.clone());
        }
        self.made.fetch_add(1, Ordering::Relaxed);
        let values = cut()?;
        place.add(&key, &values)?;
        locked(&self.rows).insert(key, values.clone());
        Ok(values)
    }

    /// The same where all numbers exist but those that are none (NaN).
    ///
    /// # Errors
    /// As for [`Self::of`].
    pub fn all_of(&self, scene: &Scene, asked: &str, cut: impl FnOnce() -> Result<Vec<f64>>) -> Result<Vec<f64>> {
        let known = |value: f64| Some(value).filter(|value| !value.is_nan());
        let values = self.of(scene, asked, || Ok(cut()?.into_iter().map(known).collect()))?;
        Ok(values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect())
    }

    /// How many cuts were made, and how many of an earlier run were taken.
    pub fn made_and_taken(&self) -> [usize; 2] {
        [self.made.load(Ordering::Relaxed), locked(&self.earlier).values().filter(|taken| **taken).count()]
    }

    /// How many finished cuts are on disk, and in which folder; none before the first one.
    pub fn kept(&self) -> Option<(usize, &Path)> {
        let place = self.place.as_ref()?;
        Some((locked(&self.rows).len(), place.folder.as_path())).filter(|(count, _)| *count > 0)
    }

    /// Writes all rows into the folder of a run that ends early, which takes the place of the one that grew.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, folder: &OutputFolder) -> Result<()> {
        if self.place.is_none() {
            return Ok(());
        }
        kind().write(&folder.path(table_file(CUTS))?, &locked(&self.rows))
    }

    /// Takes away what this run has left beside the result: it has failed, and would fail again.
    ///
    /// # Errors
    /// The folder cannot be removed.
    pub fn forget(self) -> Result<()> {
        match self.place {
            Some(place) if place.is_own => {
                let grew = locked(&place.file).take().is_some();
                if grew { fs::remove_dir_all(&place.folder).map_err(Error::writing(&place.folder)) } else { Ok(()) }
            }
            _ => Ok(()),
        }
    }
}

impl GrowingPlace {
    fn add(&self, key: &String, values: &RowValues) -> Result<()> {
        let mut file = locked(&self.file);
        if file.is_none() {
            begin(&self.folder, &self.record)?;
            *file = Some(RowFile::open(&self.folder.join(table_file(CUTS)), &kind())?.0);
        }
        file.as_ref().map_or(Ok(()), |file| file.add(key, values))
    }
}

/// SHA-256 of a value as `Debug` writes it: every number with all its digits.
pub fn digest(of: &impl Debug) -> String {
    let mut text = HashedText(Sha256::new());
    write!(text, "{of:?}").expect("a hash takes any text");
    format!("{:x}", text.0.finalize())
}

struct HashedText(Sha256);

impl Write for HashedText {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text);
        Ok(())
    }
}

fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}
