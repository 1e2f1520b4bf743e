//! What scenes of shaping may say, and what becomes of it.

mod build;
mod checks;
mod defaults;
mod keys;
pub mod layers;
pub mod model;

use crate::machine_errors::ErrorLayer;
use crate::scene::error_sources::{self, ErrorSource, KeyForm};
use crate::scene::{ProcessPart, SceneProcess, Senseless, StandardOperation};
use model::Shaping;

/// Errors of the cutter.
static TOOL_ERRORS: &[ErrorSource] = &[
    error_sources::runout("tool.shaper_cutter"),
    ErrorSource {
        section: "tool.shaper_cutter",
        form: KeyForm::Entries { list: "pitch_errors_um", count: "teeth" },
        unit: "um",
        step: 4.0,
        what: "pitch of cutter tooth",
    },
];

/// Shaping with a pinion cutter.
pub static SCENE: SceneProcess = SceneProcess {
    name: "shaping",
    tool: "shaper_cutter",
    tool_words: "a shaper cutter",
    needed: "the module and the numbers of teeth",
    scenes: include_str!("scenes.md"),
    sections: keys::SECTIONS,
    added: keys::ADDED,
    operations: &[
        StandardOperation {
            name: "rough",
            template: &[("name", "\"rough\""), ("stock_per_flank_mm", "0.2"), ("strokes_per_revolution", "840")],
        },
        StandardOperation { name: "finish", template: &[("name", "\"finish\""), ("strokes_per_revolution", "4200")] },
    ],
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
    axes: &keys::AXES,
    errors: &[error_sources::MOUNTING, error_sources::GUIDE, TOOL_ERRORS],
    derive: defaults::derive,
    check: checks::check,
    build: build::build,
};

impl ProcessPart for Shaping {
    fn process(&self) -> &'static SceneProcess {
        &SCENE
    }

    fn error_layers(&self) -> Vec<ErrorLayer> {
        self.machine.errors.layers(&layers::OWN.each_ref().map(|own| (own.layer, own.is_on(self))))
    }

    fn keep_layers(&mut self, kept: &[ErrorLayer]) {
        self.machine.errors.keep(kept);
        for own in layers::OWN.iter().filter(|own| !kept.contains(&own.layer)) {
            (own.off)(self);
        }
    }

    fn operation_names(&self) -> Vec<&str> {
        self.operations.iter().map(|operation| operation.name.as_str()).collect()
    }

    fn ray_spacings(&self) -> Vec<(&'static str, [f64; 2])> {
        vec![("fields.chips.spacing_mm", [self.chip_spacing_mm, keys::LARGEST_CHIP_SPACING_MM])]
    }
}
