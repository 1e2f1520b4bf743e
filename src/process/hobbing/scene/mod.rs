//! What scenes of hobbing may say, and what becomes of it.

mod build;
mod keys;
pub mod model;

use crate::scene::{ProcessPart, SceneProcess, Senseless};
use model::Hobbing;

/// Why coefficients of the force normal to the edge have no sense.
const NO_NORMAL_FORCE: &str = "only the force against the edge's motion is computed";

/// Hobbing with five and six axes.
pub static SCENE: SceneProcess = SceneProcess {
    name: "hobbing",
    tool: "hob",
    tool_words: "a hob",
    needed: "the module, the number of teeth and the hob's size",
    scenes: include_str!("scenes.md"),
    sections: keys::SECTIONS,
    added: keys::ADDED,
    on_demand: &["material", "measure"],
    senseless: &[
        Senseless {
            path: "material.normal_force_n_per_mm2",
            why: NO_NORMAL_FORCE,
            instead: "remove it; cutting_force_n_per_mm2 and cutting_edge_force_n_per_mm give the cutting force",
        },
        Senseless {
            path: "material.normal_edge_force_n_per_mm",
            why: NO_NORMAL_FORCE,
            instead: "remove it; cutting_force_n_per_mm2 and cutting_edge_force_n_per_mm give the cutting force",
        },
        Senseless {
            path: "fields.chips",
            why: "chips are counted on the rays of the blank",
            instead: "set spacing_mm and slice_spacing_mm in [fields.blank]",
        },
    ],
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
