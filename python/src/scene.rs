//! Scenes: read from text or file, every problem as an exception.

use crate::failure;
use gearcut::LoadedScene;
use gearcut::scene::draft::draft_settings;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene without problems.
#[pyclass(frozen, module = "gearcut._native")]
pub struct NativeScene {
    pub loaded: Arc<LoadedScene>,
}

#[pymethods]
impl NativeScene {
    /// The scene in a file, or in a folder that a cut has written.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf, settings: Vec<String>) -> PyResult<Self> {
        let read = gearcut::pair_job::member::read(&path, &settings);
        Ok(Self { loaded: Arc::new(read.map_err(|error| failure::of_error(py, error))?) })
    }

    /// The scene in a text; `name` stands for the file in messages, `folder` holds the files that it refers to.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, name: &str, folder: PathBuf, settings: Vec<String>) -> PyResult<Self> {
        let read = gearcut::parse(text, name, Path::new(&folder), &settings);
        Ok(Self { loaded: Arc::new(read.map_err(|errors| failure::of_problems(py, &errors))?) })
    }

    /// The same with coarser dexels, what `settings` say apart.
    fn draft(&self, py: Python<'_>, settings: Vec<String>) -> PyResult<Self> {
        let settings = [draft_settings(&self.loaded.scene), settings].concat();
        let read = self.loaded.with_settings(&settings, gearcut::key_table());
        Ok(Self { loaded: Arc::new(read.map_err(|errors| failure::of_problems(py, &errors))?) })
    }

    #[getter]
    fn name(&self) -> &str {
        &self.loaded.scene.name
    }

    #[getter]
    fn process(&self) -> &str {
        self.loaded.scene.process_name()
    }

    #[getter]
    fn teeth(&self) -> u32 {
        self.loaded.scene.gear.teeth
    }

    #[getter]
    fn module_mm(&self) -> f64 {
        self.loaded.scene.gear.module_mm
    }

    #[getter]
    fn face_width_mm(&self) -> f64 {
        self.loaded.scene.gear.face_width_mm
    }

    #[getter]
    fn operations(&self) -> Vec<String> {
        self.loaded.scene.process.operation_names().into_iter().map(str::to_owned).collect()
    }

    /// The scene with every default written out.
    fn toml(&self) -> String {
        self.loaded.resolved_toml()
    }
}
