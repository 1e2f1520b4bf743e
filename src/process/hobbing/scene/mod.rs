//! What scenes of hobbing may say, and what becomes of it.

mod build;
mod keys;
pub mod model;

use crate::scene::{ProcessPart, SceneProcess};
use model::Hobbing;

/// Hobbing with five and six axes.
pub static SCENE: SceneProcess = SceneProcess {
    name: "hobbing",
    tool: "hob",
    tool_words: "a hob",
    needed: "the module, the number of teeth and the hob's size",
    scenes: include_str!("scenes.md"),
    sections: keys::SECTIONS,
    added: keys::ADDED,
    derive: |_| {},
    check: |_| {},
    build: build::build,
};

impl ProcessPart for Hobbing {
    fn process(&self) -> &'static SceneProcess {
        &SCENE
    }

    fn operation_names(&self) -> Vec<&str> {
        self.operations.iter().map(|operation| operation.name.as_str()).collect()
    }
}
