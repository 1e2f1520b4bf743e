//! What scenes of hobbing may say, and what becomes of it.

mod build;
mod keys;
pub mod model;

use crate::machine_errors::{ErrorLayer, ToolMounting};
use crate::scene::error_sources::{self, ErrorSource, KeyForm};
use crate::scene::machine_errors;
use crate::scene::problems::Found;
use crate::scene::{FINISH_ALONE, ProcessPart, SceneProcess, Senseless};
use model::Hobbing;

/// Why coefficients of the force normal to the edge have no sense.
const NO_NORMAL_FORCE: &str = "only the force against the edge's motion is computed";

/// Errors of the hob.
static TOOL_ERRORS: &[ErrorSource] = &[
    error_sources::runout("tool.hob"),
    error_sources::wobble("tool.hob"),
    ErrorSource::new(
        "tool.hob",
        KeyForm::Entries { list: "pitch_errors_um", count: "gashes" },
        "um",
        4.0,
        "pitch of hob gash",
    ),
];

/// Hobbing with five and six axes.
pub static SCENE: SceneProcess = SceneProcess {
    name: "hobbing",
    tool: "hob",
    tool_words: "a hob",
    needed: "the module, the number of teeth and the hob's size",
    scenes: include_str!("scenes.md"),
    sections: keys::SECTIONS,
    added: keys::ADDED,
    operations: FINISH_ALONE,
    per_revolution: &[],
    of_one_gear: &[],
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
    axes: &keys::AXES,
    errors: &[error_sources::MOUNTING, error_sources::GUIDE, TOOL_ERRORS],
    derive: |_| {},
    check,
    build: build::build,
};

/// Holds values against each other.
fn check(found: &mut Found<'_, '_, '_>) {
    external(found);
    let _: Option<()> = pitch_errors(found);
    machine_errors::check(found, &keys::AXES);
    machine_errors::check_noise_in_time(found, &keys::AXES, "a hob");
}

/// Refuses what no hob reaches.
fn external(found: &mut Found<'_, '_, '_>) {
    let internal = found.view("gear").text("kind") == Some("internal");
    let message = || "`gear.kind`: a hob cuts external gears; it does not fit into a ring".to_owned();
    let way_out = "write kind = \"external\", or shape the ring with [tool.shaper_cutter]";
    found.blame(internal, "gear.kind", message, way_out);
}

/// A pitch error for each gash, or for each gash of each thread.
fn pitch_errors(found: &mut Found) -> Option<()> {
    let key = "tool.hob.pitch_errors_um";
    let hob = found.view("tool.hob");
    let (starts, gashes, errors) = (hob.whole("starts")?, hob.whole("gashes")?, hob.numbers("pitch_errors_um")?.len());
    let wrong = errors != 0 && errors != gashes as usize && errors != (starts * gashes) as usize;
    let message = || format!("`{key}`: {errors} values for {gashes} gashes and {starts} threads");
    let way_out = "give one value per gash, or one for each gash of each thread, or leave the key out";
    found.blame(wrong, key, message, way_out);
    Some(())
}

impl ProcessPart for Hobbing {
    fn process(&self) -> &'static SceneProcess {
        &SCENE
    }

    fn error_layers(&self) -> Vec<ErrorLayer> {
        let tool = !self.tool.mounting.is_none() || self.tool.has_pitch_errors();
        self.errors.layers(&[(ErrorLayer::Tool, tool)])
    }

    fn keep_layers(&mut self, kept: &[ErrorLayer]) {
        self.errors.keep(kept);
        if !kept.contains(&ErrorLayer::Tool) {
            self.tool.mounting = ToolMounting::default();
            self.tool.pitch_errors_mm.clear();
        }
    }

    fn operation_names(&self) -> Vec<&str> {
        self.operations.iter().map(|operation| operation.name.as_str()).collect()
    }
}
