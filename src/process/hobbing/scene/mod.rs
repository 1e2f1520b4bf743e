//! What scenes of hobbing may say, and what becomes of it.

mod build;
mod keys;
pub mod model;
mod standard_hob;

use crate::machine_errors::{AxisErrors, ErrorLayer, ToolMounting};
use crate::scene::drawn_profile;
use crate::scene::error_sources::{self, ErrorSource, KeyForm};
use crate::scene::machine_errors;
use crate::scene::problems::Found;
use crate::scene::tool_wear;
use crate::scene::{FINISH_ALONE, ProcessPart, SceneProcess, Senseless};
pub(in crate::process::hobbing) use keys::PROFILE;
use model::Hobbing;
use std::path::Path;

/// Dedendum of a hob that does not say its own, modules.
const USUAL_DEDENDUM: f64 = 1.25;
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
    needed: "the module and the number of teeth",
    scenes: include_str!("scenes.md"),
    sections: keys::SECTIONS,
    added: keys::ADDED,
    operations: FINISH_ALONE,
    per_revolution: &[],
    of_one_gear: &[],
    on_demand: &["material", "measure", keys::WEAR],
    draft: ", and largest forces and powers of hob teeth come out too high",
    cuts_rings: false,
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
    let _: Option<()> = standard_size(found);
    let _: Option<()> = tip_reliefs(found);
    let _: Option<()> = pitch_errors(found);
    drawn_tooth(found);
    tool_wear::check(found, keys::WEAR);
    machine_errors::check(found, &keys::AXES);
    machine_errors::check_noise_in_time(found, &keys::AXES, "a hob");
}

/// Refuses a hob of unknown size whose module has no usual one.
fn standard_size(found: &mut Found) -> Option<()> {
    let module_mm = found.view("gear").number("module_mm")?;
    let hob = found.view("tool.hob");
    let has_diameter = hob.number("reference_diameter_mm").or(hob.number("lead_angle_deg")).is_some();
    let missing = match (hob.number("length_mm"), has_diameter) {
        (None, _) => "length_mm",
        (_, false) => "reference_diameter_mm",
        _ => return None,
    };
    let [smallest_mm, largest_mm] = standard_hob::MODULES_MM;
    let key = format!("tool.hob.{missing}");
    let message = || {
        format!(
            "`{key}` is missing, and there is no usual hob of module {module_mm} mm: DIN 8002 has modules from \
             {smallest_mm} to {largest_mm} mm"
        )
    };
    let way_out = "give length_mm and reference_diameter_mm (10 to 30 modules) of your hob";
    found.blame(standard_hob::size_mm(module_mm).is_none(), &key, message, way_out);
    Some(())
}

/// Tip relief and semi-topping that take nothing off, or stand in each other's way.
fn tip_reliefs(found: &mut Found) -> Option<()> {
    let [hob, gear] = ["tool.hob", "gear"].map(|path| found.view(path));
    let relief_mm = hob.number("tip_relief_height_mm");
    let chamfer_mm = hob.number("semi_topping_height_mm");
    let angle_deg = hob.number("semi_topping_angle_deg")?;
    let flank_deg = gear.number("pressure_angle_deg")?;
    let addendum_mm = gear.number("addendum_coefficient")? * gear.number("module_mm")?;
    let key = "tool.hob.tip_relief_height_mm";
    let message = || format!("`{key}`: a relief from there on reaches no tip, which is {addendum_mm} mm high");
    found.blame(relief_mm.is_some_and(|mm| mm >= addendum_mm), key, message, "begin lower, about half a module");
    let key = "tool.hob.semi_topping_height_mm";
    let message = || format!("`{key}`: the chamfer begins under the tip relief");
    let crossed = relief_mm.zip(chamfer_mm).is_some_and(|(relief, chamfer)| chamfer <= relief);
    found.blame(crossed, key, message, "begin the chamfer above tip_relief_height_mm");
    let key = "tool.hob.semi_topping_angle_deg";
    let message = || format!("`{key}`: {angle_deg} deg is no chamfer on flanks of {flank_deg} deg");
    let flat = chamfer_mm.is_some() && angle_deg <= flank_deg;
    found.blame(flat, key, message, "use more than the pressure angle, 45 deg for example");
    Some(())
}

/// A contour says all of a tooth.
fn drawn_tooth(found: &mut Found) {
    let hob = "tool.hob";
    let replaced = [
        (hob, "dedendum_coefficient", Some(USUAL_DEDENDUM)),
        (hob, "tip_radius_mm", None),
        (hob, "protuberance_height_mm", None),
        (hob, "tip_relief_height_mm", None),
        (hob, "semi_topping_height_mm", None),
        (hob, "thinning_mm", Some(0.0)),
    ];
    drawn_profile::refuse_beside(found, PROFILE, "hob", &replaced);
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

    fn other_teeth_key(&self) -> Option<&'static str> {
        self.tool.profile.as_ref().map(|_| PROFILE)
    }

    fn files_read(&self) -> Vec<&Path> {
        let contour = self.tool.profile.iter().map(|profile| profile.file.as_path());
        contour.chain(self.operations.iter().filter_map(|operation| operation.program.as_deref())).collect()
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

    fn axis_errors_mut(&mut self) -> &mut [AxisErrors] {
        &mut self.errors.axes
    }

    fn operation_names(&self) -> Vec<&str> {
        self.operations.iter().map(|operation| operation.name.as_str()).collect()
    }
}
