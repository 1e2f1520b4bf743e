//! What scenes of hobbing may say, and what becomes of it.

mod build;
mod keys;
pub mod model;

use crate::scene::problems::Found;
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
    per_revolution: &[],
    of_one_gear: &[],
    derive: |_| {},
    check: external,
    build: build::build,
};

/// Refuses what no hob reaches.
fn external(found: &mut Found<'_, '_, '_>) {
    let internal = found.view("gear").text("kind") == Some("internal");
    let message = || "`gear.kind`: a hob cuts external gears; it does not fit into a ring".to_owned();
    let way_out = "write kind = \"external\", or shape the ring with [tool.shaper_cutter]";
    found.blame(internal, "gear.kind", message, way_out);
}

impl ProcessPart for Hobbing {
    fn process(&self) -> &'static SceneProcess {
        &SCENE
    }

    fn operation_names(&self) -> Vec<&str> {
        self.operations.iter().map(|operation| operation.name.as_str()).collect()
    }
}
