//! What scenes of shaping may say, and what becomes of it.

mod build;
mod checks;
mod defaults;
mod keys;
pub mod layers;
pub mod model;
mod stock;

use crate::machine_errors::{AxisErrors, ErrorLayer};
use crate::scene::error_sources::{self, ErrorSource, KeyForm, Tried};
use crate::scene::{ProcessPart, SceneProcess, StandardOperation};
pub(in crate::process::shaping) use keys::PROFILE;
use model::{EdgeRoughness, Shaping};
use std::path::Path;

/// Errors of the cutter.
static TOOL_ERRORS: &[ErrorSource] = &[
    error_sources::runout("tool.shaper_cutter"),
    ErrorSource::new(
        "tool.shaper_cutter",
        KeyForm::Entries { list: "pitch_errors_um", count: "teeth" },
        "um",
        4.0,
        "pitch of cutter tooth",
    ),
];

/// A compliance of the machine.
const fn compliance(key: &'static str, unit: &'static str, step: f64, what: &'static str) -> ErrorSource {
    ErrorSource::new("machine.compliance", KeyForm::Amount(key), unit, step, what).tried(Tried::WhereItIs)
}

/// A number of the cutter's rounded edges.
const fn rounding(form: KeyForm, unit: &'static str, step: f64, what: &'static str) -> ErrorSource {
    ErrorSource::new(keys::EDGE_ROUNDING, form, unit, step, what).tried(Tried::WhereItIs)
}

/// A number of the marks of a built-up edge, by its name: where marks lie is random. Which of them are scratches, and
/// at which speeds there are any, is decided mark by mark.
const fn marks(key: &'static str, unit: &'static str, step: f64, what: &'static str) -> ErrorSource {
    ErrorSource::new(keys::BUILT_UP_EDGE, KeyForm::Amount(key), unit, step, what).tried(Tried::ByName)
}

/// What the cut itself does, and what is random in it.
static CUT_ERRORS: &[ErrorSource] = &[
    compliance("tool_radial_um_per_kn", "um/kN", 1.0, "compliance: tool, radial"),
    compliance("tool_tangential_um_per_kn", "um/kN", 1.0, "compliance: tool, tangential"),
    compliance("tool_torsional_urad_per_nm", "urad/(N m)", 0.2, "compliance: tool, torsional"),
    compliance("work_radial_um_per_kn", "um/kN", 1.0, "compliance: work, radial"),
    compliance("work_tangential_um_per_kn", "um/kN", 1.0, "compliance: work, tangential"),
    compliance("work_torsional_urad_per_nm", "urad/(N m)", 0.2, "compliance: work, torsional"),
    rounding(KeyForm::Amount("radius_um"), "um", 0.5, "edge radius"),
    rounding(KeyForm::Amount("minimum_chip_share"), "1", 0.05, "thinnest chip over radius"),
    rounding(KeyForm::Missing("recovery_share"), "1", 0.1, "share that stays pressed down").needs("radius_um"),
    ErrorSource::new(keys::EDGE_ROUGHNESS, KeyForm::Amount("rq_um"), "um", 0.1, "edge roughness Rq")
        .tried(Tried::ByName),
    marks("density_per_mm2", "1/mm^2", 5.0, "marks of a built-up edge"),
    marks("depth_um", "um", 0.1, "depth of these marks"),
    marks("width_um", "um", 2.0, "width of these marks"),
    marks("scratch_length_um", "um", 5.0, "length of scratches"),
    ErrorSource::new("operation[]", KeyForm::Amount("stock_scatter_um"), "um", 2.0, "stock scatter")
        .tried(Tried::ByName),
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
    of_one_gear: &["window_deg"],
    on_demand: &[keys::CMM],
    draft: "",
    cuts_rings: true,
    senseless: &[],
    axes: &keys::AXES,
    errors: &[error_sources::MOUNTING, error_sources::GUIDE, TOOL_ERRORS, CUT_ERRORS],
    derive: defaults::derive,
    check: checks::check,
    build: build::build,
};

impl ProcessPart for Shaping {
    fn process(&self) -> &'static SceneProcess {
        &SCENE
    }

    fn other_teeth_key(&self) -> Option<&'static str> {
        self.tool.profile.as_ref().map(|_| PROFILE)
    }

    fn files_read(&self) -> Vec<&Path> {
        let profile = self.tool.edge_roughness.iter().filter_map(|roughness| match roughness {
            EdgeRoughness::Profile(path) => Some(path.as_path()),
            EdgeRoughness::Spectrum { .. } => None,
        });
        let contour = self.tool.profile.iter().map(|profile| profile.file.as_path());
        profile
            .chain(contour)
            .chain(self.operations.iter().filter_map(|operation| operation.program.as_deref()))
            .collect()
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

    fn axis_errors_mut(&mut self) -> &mut [AxisErrors] {
        &mut self.machine.errors.axes
    }

    fn operation_names(&self) -> Vec<&str> {
        self.operations.iter().map(|operation| operation.name.as_str()).collect()
    }

    fn ray_spacings(&self) -> Vec<(&'static str, [f64; 2])> {
        vec![("fields.chips.spacing_mm", [self.chip_spacing_mm, keys::LARGEST_CHIP_SPACING_MM])]
    }
}
