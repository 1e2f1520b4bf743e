//! The surface that was measured in a window: read before anything is cut, so that a file that cannot be used costs no
//! cut.

use crate::measure::topography::Surface;
use crate::output::surface_files::read_surface;
use crate::scene::model::{TextureWindow, WindowSides};
use gearcut_core::error::{Refusal, Result};
use std::path::PathBuf;
use std::sync::Arc;

/// A surface that was measured in a window.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSurface {
    /// Its file.
    pub path: PathBuf,
    /// Its heights.
    pub surface: Surface,
}

impl MeasuredSurface {
    /// That of the window at `index` of the scene, if it names one.
    pub(super) fn of(index: usize, spec: &TextureWindow) -> Result<Option<Arc<Self>>, Refusal> {
        let Some(path) = &spec.measured else { return Ok(None) };
        let refuse =
            |problem: String, way_out: &str| Refusal::new(&format!("texture[{index}].measured"), problem, way_out);
        if spec.sides == WindowSides::Both {
            let problem = format!("{} is of one flank, and the window is on both", path.display());
            return Err(refuse(problem, "write side = \"left\" or side = \"right\""));
        }
        let way_out = "save it as X3P where it was measured; `gearcut texture FILE --save FILE.x3p` says what it holds";
        let file = read_surface(path, None).map_err(|error| refuse(error.to_string(), way_out))?;
        Ok(Some(Arc::new(Self { path: path.clone(), surface: file.surface })))
    }
}
