//! What scenes of shaping may say, and what becomes of it.

mod build;
mod checks;
mod keys;
pub mod model;

use crate::scene::values::{Checked, Values};
use crate::scene::{ProcessPart, SceneProcess, Senseless};
use model::Shaping;

/// Shaping with a pinion cutter.
pub static SCENE: SceneProcess = SceneProcess {
    name: "shaping",
    tool: "shaper_cutter",
    tool_words: "a shaper cutter",
    needed: "the module and the numbers of teeth",
    scenes: include_str!("scenes.md"),
    sections: keys::SECTIONS,
    added: keys::ADDED,
    per_revolution: &["strokes_per_revolution"],
    of_one_gear: &["window_deg", "program"],
    on_demand: &[],
    senseless: &[
        Senseless {
            path: "gear.helix_angle_deg",
            why: "the ram strokes along the gear's axis: a helical guide is not modelled",
            instead: "remove it, or hob the gear with [tool.hob]",
        },
        Senseless { path: "gear.hand", why: "the ram strokes along the gear's axis", instead: "remove it" },
    ],
    derive,
    check: checks::check,
    build: build::build,
};

impl ProcessPart for Shaping {
    fn process(&self) -> &'static SceneProcess {
        &SCENE
    }

    fn operation_names(&self) -> Vec<&str> {
        self.operations.iter().map(|operation| operation.name.as_str()).collect()
    }

    fn ray_spacings(&self) -> Vec<(&'static str, [f64; 2])> {
        vec![("fields.chips.spacing_mm", [self.chip_spacing_mm, keys::LARGEST_CHIP_SPACING_MM])]
    }
}

/// Spacing of the chips' rays, strokes per revolution.
fn derive(values: &mut Values) {
    let gear = values.view("gear");
    let (module_mm, teeth) = (gear.number("module_mm"), gear.whole("teeth"));
    if let Some(module_mm) = module_mm {
        values.put_default("fields.chips", "spacing_mm", Checked::Number((module_mm / 60.0).max(0.002)));
    }
    let Some(teeth) = teeth else { return };
    for index in 0..values.count("operation") {
        let path = format!("operation.{index}");
        if !values.is_written(&path, "circular_feed_mm_per_stroke") {
            values.put_default(&path, "strokes_per_revolution", Checked::Whole(100 * teeth));
        }
    }
}
