//! gearcut for a page: scenes read, gears checked, flanks cut, findings.
//!
//! In: the text of a scene and settings, as the command line takes them. Out: numbers as typed arrays, everything else
//! as JSON or text, and the library's own messages as exceptions. The page draws and asks; nothing of gears is worked
//! out here or there.
//!
//! The page calls this from a worker: a call lasts as long as its work. What takes long is called in pieces
//! ([`WebJob::flank_part`]), and what has no pieces ([`WebJob::found`]) in a worker of its own, which is ended when
//! nobody waits for it any more.

mod drawing;
mod flank;
mod gpu;

use gearcut::findings::Notice;
use gearcut::scene::draft::draft_settings;
use gearcut::{Error, Job, LoadedScene, Side, Stages};
use serde_json::json;
use std::path::Path;
use wasm_bindgen::prelude::*;

pub use drawing::WebDrawing;
pub use flank::WebFlank;
pub use gpu::WebGpu;

/// A message of the library, as an exception of JavaScript.
type Outcome<T> = Result<T, JsError>;

/// A scene made ready.
#[wasm_bindgen]
pub struct WebJob {
    pub(crate) job: Job,
}

#[wasm_bindgen]
impl WebJob {
    /// Reads a scene and makes it ready; `settings` are those of `--set`, and a draft has dexels further apart.
    ///
    /// # Errors
    /// All problems of the scene; geometry that cannot be cut.
    #[wasm_bindgen(constructor)]
    pub fn new(text: &str, name: &str, settings: Vec<String>, draft: bool) -> Outcome<Self> {
        let mut scene = gearcut::parse(text, name, Path::new(""), &settings)?;
        if draft {
            let settings = [draft_settings(&scene.scene), settings].concat();
            scene = scene.with_settings(&settings, gearcut::key_table())?;
        }
        let job = Job::new(scene.clone()).map_err(|error| explained(&scene, error))?;
        Ok(Self { job })
    }

    /// What the page shows of the scene: JSON with `name`, `process`, `teeth`, `module_mm`, `face_width_mm`,
    /// `operations`.
    pub fn facts(&self) -> String {
        let scene = &self.job.scene().scene;
        json!({
            "name": scene.name,
            "process": scene.process_name(),
            "teeth": scene.gear.teeth,
            "module_mm": scene.gear.module_mm,
            "face_width_mm": scene.gear.face_width_mm,
            "operations": scene.process.operation_names(),
        })
        .to_string()
    }

    /// The scene with every default written out.
    pub fn toml(&self) -> String {
        self.job.scene().resolved_toml()
    }

    /// What must be known before cutting, or of it only what follows from the shapes of gear and tool: JSON, a list of
    /// `id`, `severity`, `text`.
    ///
    /// # Errors
    /// Geometry that cannot be cut.
    pub fn foreseen(&self, shapes: bool) -> Outcome<String> {
        let notices = if shapes { self.job.foreseen_of_shapes() } else { self.job.foreseen() };
        let notices = notices.map_err(|error| self.failed(error))?;
        let of = |notice: &Notice| {
            let (severity, text) = (notice.severity.name(), notice.with_signs().text);
            json!({"id": notice.id, "severity": severity, "text": text})
        };
        Ok(json!(notices.iter().map(of).collect::<Vec<_>>()).to_string())
    }

    /// Outlines of gear, stock and tool, and the tool's places stroke by stroke.
    ///
    /// # Errors
    /// A gear without transverse sections.
    pub fn drawing(&self, chord_mm: f64) -> Outcome<WebDrawing> {
        Ok(WebDrawing(self.job.planar_view(chord_mm).map_err(|error| self.failed(error))?))
    }

    /// Arcs along a flank's profile at the scene's spacing, mm.
    ///
    /// # Errors
    /// A tooth that the gear does not have.
    pub fn arcs_mm(&self, tooth: u32, left: bool) -> Outcome<Vec<f64>> {
        let [arcs_mm, _] = self.job.flank_places_mm(tooth, side(left)).map_err(|error| self.failed(error))?;
        Ok(arcs_mm)
    }

    /// Places along a tooth at the scene's spacing, mm.
    ///
    /// # Errors
    /// A tooth that the gear does not have.
    pub fn face_mm(&self, tooth: u32, left: bool) -> Outcome<Vec<f64>> {
        let [_, face_mm] = self.job.flank_places_mm(tooth, side(left)).map_err(|error| self.failed(error))?;
        Ok(face_mm)
    }

    /// Cuts the part of a flank at these places.
    ///
    /// # Errors
    /// A tooth that the gear does not have; places beside the flank.
    pub fn flank_part(&self, tooth: u32, left: bool, arcs_mm: &[f64], face_mm: &[f64]) -> Outcome<WebFlank> {
        let cut = self.job.cut_flank_at(tooth, side(left), arcs_mm, face_mm);
        Ok(WebFlank(cut.map_err(|error| self.failed(error))?))
    }

    /// Cuts all flanks and measures them, and what the quantities at `paths` need beside: the text of `results.json`.
    ///
    /// # Errors
    /// Geometry.
    #[expect(clippy::needless_pass_by_value, reason = "JavaScript hands over no slices of texts")]
    pub fn found(&self, paths: Vec<String>) -> Outcome<String> {
        let found = self.job.run().stages(Stages::of_paths(&paths)).found();
        Ok(found.map_err(|error| self.failed(error))?.to_json().to_string())
    }

    /// Charts of the axes: JSON, a list of names and SVG.
    ///
    /// # Errors
    /// A chart that cannot be drawn.
    pub fn axis_charts(&self) -> Outcome<String> {
        Ok(json!(self.job.axis_charts().map_err(|error| self.failed(error))?).to_string())
    }
}

impl WebJob {
    fn failed(&self, error: Error) -> JsError {
        explained(self.job.scene(), error)
    }
}

/// An error in the words of the command line: a refusal by the key that says so.
pub(crate) fn explained(scene: &LoadedScene, error: Error) -> JsError {
    match error {
        Error::Refused(refusal) => scene.explain(&refusal).into(),
        other => other.into(),
    }
}

pub(crate) fn side(left: bool) -> Side {
    if left { Side::Left } else { Side::Right }
}

/// Colours of maps, red, green and blue: 256 of the sequential scale, 256 of the one that diverges about zero.
#[wasm_bindgen]
pub fn colours() -> Vec<u8> {
    gearcut::colormap::tables().concat().concat()
}

/// Version of gearcut.
#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}
