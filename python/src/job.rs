//! A scene made ready: checked, its axes moved, single flanks and whole gears cut.

use crate::failure;
use crate::flank::{arrays, side_named};
use crate::scene::NativeScene;
use crate::waiting::{EventWatch, waited};
use gearcut::backend::{BackendWish, OnFailure, choose};
use gearcut::findings::Notice;
use gearcut::interrupt::Interrupt;
use gearcut::output::folder::OutputFolder;
use gearcut::output::text::Sheet;
use gearcut::{Error, Job, Part, Parts};
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Map, json};
use std::path::PathBuf;

/// A scene made ready.
#[pyclass(frozen, module = "gearcut._native")]
pub struct NativeJob {
    job: Job,
}

/// A notice: id, severity, text, and the section that it is about.
pub type NoticeFields = (String, &'static str, String, Option<String>);

fn fields(notices: &[Notice]) -> Vec<NoticeFields> {
    let of =
        |notice: &Notice| (notice.id.to_string(), notice.severity.name(), notice.text.clone(), notice.section.clone());
    notices.iter().map(of).collect()
}

/// The backend's wish by its name.
fn wish(name: &str) -> PyResult<BackendWish> {
    match name {
        "auto" => Ok(BackendWish::Auto),
        "cpu" => Ok(BackendWish::Cpu),
        "gpu" => Ok(BackendWish::Gpu),
        _ => Err(PyValueError::new_err(format!("`{name}` is no backend; give \"auto\", \"cpu\" or \"gpu\""))),
    }
}

/// Parts by their names, all of them where none are given.
fn parts(names: Option<Vec<String>>) -> PyResult<Parts> {
    let Some(names) = names else { return Ok(Parts::all()) };
    let known = Part::ALL.map(Part::name);
    if let Some(other) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(PyValueError::new_err(format!("`{other}` is no part; give some of {}", known.join(", "))));
    }
    Ok(Parts::named(names.iter().map(String::as_str)))
}

#[pymethods]
impl NativeJob {
    #[new]
    fn new(py: Python<'_>, scene: &NativeScene, backend: &str) -> PyResult<Self> {
        let (wish, loaded) = (wish(backend)?, scene.loaded.clone());
        let made = || Job::new(loaded).and_then(|job| Ok(job.on(choose(wish, OnFailure::default())?)));
        let job = py.detach(made).map_err(|error| failure::of_scene(py, &scene.loaded, error))?;
        Ok(Self { job })
    }

    /// Notices and facts.
    fn check(&self, py: Python<'_>) -> PyResult<(Vec<NoticeFields>, String)> {
        self.on_a_sheet(py, |_, sheet| self.job.check(sheet))
    }

    /// Notices and facts; tables, charts and programs go to `axes/` in the folder `out`.
    fn axes(&self, py: Python<'_>, out: PathBuf) -> PyResult<(Vec<NoticeFields>, String)> {
        let written = |interrupt: &Interrupt, sheet: &mut Sheet| {
            let folder = OutputFolder::create_of(&out, "axes", &[])?;
            let mut filled = || {
                let notices = self.job.axes(&folder, interrupt, sheet)?;
                interrupt.check()?;
                let record = [
                    ("program", json!("gearcut")),
                    ("program_version", json!(env!("CARGO_PKG_VERSION"))),
                    ("command", json!("axes")),
                    ("scene", json!(self.job.scene().resolved_toml())),
                ];
                folder.write_record(
                    record.map(|(key, value)| (key.to_owned(), value)).into_iter().collect::<Map<_, _>>(),
                )?;
                Ok(notices)
            };
            let notices = filled().map_err(|error| folder.explain(error))?;
            folder.finish()?;
            Ok(notices)
        };
        self.on_a_sheet(py, written)
    }

    /// One flank; `at` are arcs along the profile and places along the tooth, mm.
    fn flank<'py>(
        &self,
        py: Python<'py>,
        tooth: u32,
        side: &str,
        at: Option<(Vec<f64>, Vec<f64>)>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let side = side_named(side)?;
        let (cut, raised) = waited(py, &Interrupt::default(), || match &at {
            None => self.job.cut_flank(tooth, side),
            Some((arcs_mm, face_mm)) => self.job.cut_flank_at(tooth, side, arcs_mm, face_mm),
        });
        match raised {
            Some(signal) => Err(signal),
            None => arrays(py, cut.map_err(|error| self.failed(py, error))?),
        }
    }

    /// The whole gear: its folder, the text of `results.json`, the summary.
    fn cut(
        &self,
        py: Python<'_>,
        out: PathBuf,
        only: Option<Vec<String>>,
        frames: Option<u32>,
        watcher: Option<Py<PyAny>>,
    ) -> PyResult<(PathBuf, String, String)> {
        let parts = parts(only)?;
        let interrupt = Interrupt::default();
        let watch = EventWatch::new(watcher, &interrupt);
        let (cut, raised) = waited(py, &interrupt, || {
            let run = self.job.run().show(&watch.progress).until(&interrupt).only(parts).frames(frames);
            let done = run.into_folder(&out)?;
            let folder = done.folder.cleared()?;
            Ok::<_, Error>((folder, done.findings.to_json().to_string(), done.summary.brief))
        });
        if let Some(raised) = watch.raised().or(raised) {
            return Err(match cut {
                Ok((folder, ..)) if raised.is_instance_of::<PyKeyboardInterrupt>(py) => {
                    PyKeyboardInterrupt::new_err(format!("what is finished is in {}", folder.display()))
                }
                Err(Error::Interrupted) if raised.is_instance_of::<PyKeyboardInterrupt>(py) => {
                    PyKeyboardInterrupt::new_err("no flank is finished, nothing is written")
                }
                _ => raised,
            });
        }
        cut.map_err(|error| self.failed(py, error))
    }
}

impl NativeJob {
    /// The exception for an error of work on its scene.
    fn failed(&self, py: Python<'_>, error: Error) -> PyErr {
        failure::of_scene(py, self.job.scene(), error)
    }

    /// Work that fills a sheet and gives notices.
    fn on_a_sheet(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Interrupt, &mut Sheet) -> gearcut::Result<Vec<Notice>> + Send,
    ) -> PyResult<(Vec<NoticeFields>, String)> {
        let interrupt = Interrupt::default();
        let (done, raised) = waited(py, &interrupt, || {
            let mut sheet = Sheet::default();
            Ok((work(&interrupt, &mut sheet)?, sheet.into_text()))
        });
        match raised {
            Some(signal) => Err(signal),
            None => done.map(|(notices, text)| (fields(&notices), text)).map_err(|error| self.failed(py, error)),
        }
    }
}
