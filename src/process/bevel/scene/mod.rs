//! What scenes of bevel gears may say, and what becomes of it.

mod build;
mod keys;
pub mod model;

use crate::machine_errors::{AxisErrors, ErrorLayer, ToolMounting};
use crate::scene::error_sources::{self, ErrorSource, KeyForm};
use crate::scene::keys::join;
use crate::scene::machine_errors;
use crate::scene::problems::Found;
use crate::scene::values::{Checked, Values};
use crate::scene::{FINISH_ALONE, ProcessPart, SceneProcess, Senseless};
use model::Bevel;
use std::path::Path;

/// Why keys of the normal force are refused, and what is there instead.
const NO_NORMAL_FORCE: &str = "the cutting force alone is computed";
const CUTTING_FORCE: &str = "remove it; cutting_force_n_per_mm2 and cutting_edge_force_n_per_mm give the cutting force";

/// Section of the head.
const HEAD: &str = "tool.face_mill";
/// Speed of the cradle where the scene names none, deg/s.
const ROLL_DEG_PER_S: f64 = 2.0;
/// Infeed for each turn and blade where the scene names none, outer modules: chips of a tenth of a millimetre at module
/// 4, as blades of both kinds share the width of the slot.
const INFEED_MODULES: f64 = 0.02;
/// Turns at full depth where the scene names none: the window of a blade is below half a turn.
const DWELL_TURNS: f64 = 1.5;

/// A shared key or section without sense here.
const fn without(path: &'static str, why: &'static str, instead: &'static str) -> Senseless {
    Senseless { path, why, instead }
}

/// Errors of the head.
static TOOL_ERRORS: &[ErrorSource] = &[
    error_sources::wobble("tool.face_mill"),
    ErrorSource::new(
        "tool.face_mill",
        KeyForm::Entries { list: "runouts_um", count: "blades" },
        "um",
        4.0,
        "runout of blade",
    ),
];

/// An error of a setting of the cradle machine.
const fn setting(key: &'static str, unit: &'static str, step: f64, what: &'static str) -> ErrorSource {
    ErrorSource::new("machine.cradle_errors", KeyForm::Number(key), unit, step, what)
}

/// Errors of the settings; natural steps are a division of the scales of old machines.
static CRADLE_ERRORS: &[ErrorSource] = &[
    setting("radial_setting_mm", "mm", 0.01, "radial setting"),
    setting("cradle_angle_deg", "deg", 0.01, "cradle angle"),
    setting("blank_offset_mm", "mm", 0.01, "blank offset"),
    setting("sliding_base_mm", "mm", 0.01, "sliding base"),
    setting("center_to_back_mm", "mm", 0.01, "machine centre to back"),
    setting("root_angle_deg", "deg", 0.01, "root angle"),
    setting("roll_ratio", "1", 0.0002, "ratio of roll"),
    setting("tilt_deg", "deg", 0.01, "tilt of the head"),
    setting("swivel_deg", "deg", 0.01, "swivel of the head"),
];

/// Spiral bevel gears cut with a face-mill head.
pub static SCENE: SceneProcess = SceneProcess {
    name: "bevel",
    tool: "face_mill",
    tool_words: "a face-mill head",
    needed: "the module, the number of teeth, the blank's cones and the machine's settings",
    scenes: include_str!("scenes.md"),
    sections: keys::SECTIONS,
    added: keys::ADDED,
    operations: FINISH_ALONE,
    per_revolution: &[],
    of_one_gear: &[],
    on_demand: &["material"],
    draft: ", and thickest chips and largest forces come out too high",
    cuts_rings: false,
    senseless: &[
        without("gear.kind", "the pitch angle says where the teeth are", "remove it"),
        without("gear.helix_angle_deg", "the machine's settings make the spiral", "remove it"),
        without("gear.hand", "the sign of the spiral angle or cradle angle chooses the hand", "remove it"),
        without("gear.addendum_coefficient", "the addendum is a key of [gear.bevel]", "write gear.bevel.addendum_mm"),
        without("gear.profile_shift_coefficient", "the settings make the teeth", "remove it"),
        without("gear.bore_diameter_mm", "the body is the toothed ring", "remove it"),
        without("gear.rim_mm", "no gear is internal", "remove it"),
        without("gear.tooth_thickness_allowance_mm", "the head makes the slot", "set tool.face_mill.point_width_mm"),
        without("gear.center_distance_mm", "the axes cross", "remove it"),
        without("gear.pitch_curve", "gears roll on cones", "remove it"),
        without("measure", "flanks are measured on a grid", "remove it"),
        without("material.normal_force_n_per_mm2", NO_NORMAL_FORCE, CUTTING_FORCE),
        without("material.normal_edge_force_n_per_mm", NO_NORMAL_FORCE, CUTTING_FORCE),
    ],
    axes: &keys::AXES,
    errors: &[error_sources::MOUNTING, TOOL_ERRORS, CRADLE_ERRORS],
    derive,
    check,
    build: build::build,
};

/// What shared code reads of every gear, with the values that mean nothing.
fn derive(values: &mut Values) {
    values.put_default("gear", "kind", Checked::Text("external".to_owned()));
    for (section, key, number) in [
        ("gear", "addendum_coefficient", 1.0),
        ("gear", "profile_shift_coefficient", 0.0),
        ("gear", "bore_diameter_mm", 0.0),
        ("gear", "tooth_thickness_allowance_mm", 0.0),
    ] {
        values.put_default(section, key, Checked::Number(number));
    }
    let _: Option<()> = slot_feeds(values);
}

/// Speed of the roll, or infeed and dwell where nothing rolls.
fn slot_feeds(values: &mut Values) -> Option<()> {
    let infeed_mm =
        INFEED_MODULES * values.view("gear").number("module_mm")? * f64::from(values.view(HEAD).whole("blades")?);
    let feeds: &[(&str, f64)] = if plunges(values) {
        &[("infeed_mm_per_revolution", infeed_mm), ("dwell_revolutions", DWELL_TURNS)]
    } else {
        &[("roll_speed_deg_per_s", ROLL_DEG_PER_S)]
    };
    for index in 0..values.count("operation") {
        for &(key, number) in feeds {
            values.put_default(&format!("operation.{index}"), key, Checked::Number(number));
        }
    }
    Some(())
}

/// Whether nothing rolls.
fn plunges(values: &Values) -> bool {
    values.view("machine.cradle").number("roll_ratio") == Some(0.0)
}

/// Holds values against each other.
fn check(found: &mut Found<'_, '_, '_>) {
    let _: Option<()> = runouts(found);
    rolls(found);
    spiral_angle(found);
    keys_of_the_other_way(found);
    swivel_of_an_upright_head(found);
    machine_errors::check(found, &keys::AXES);
    machine_errors::check_noise_in_time(found, &keys::AXES, "a face-mill head");
}

/// One runout for each blade.
fn runouts(found: &mut Found) -> Option<()> {
    let head = found.view("tool.face_mill");
    let (blades, runouts) = (head.whole("blades")? as usize, head.numbers("runouts_um")?.len());
    let message = || format!("`tool.face_mill.runouts_um` has {runouts} entries for {blades} blades");
    let wrong = runouts > 0 && runouts != blades;
    found.blame(wrong, "tool.face_mill.runouts_um", message, "write one for each blade, or leave the list empty");
    Some(())
}

/// A roll has a length.
fn rolls(found: &mut Found) {
    for index in 0..found.values.count("operation") {
        let path = format!("operation.{index}");
        let [from, to] = ["roll_from_deg", "roll_to_deg"].map(|key| found.view(&path).number(key));
        let message = || format!("the roll from {} to {} deg has no length", from.unwrap_or(0.0), to.unwrap_or(0.0));
        let wrong = from.is_some() && from == to;
        found.blame(wrong, &format!("{path}.roll_to_deg"), message, "make the ends differ");
    }
}

/// A spiral angle gives the settings of an upright head of known radius on a crown gear about the machine's centre.
fn spiral_angle(found: &mut Found) {
    let (path, radius) = ("machine.cradle.spiral_angle_deg", "radius_mm");
    let cradle = found.view("machine.cradle");
    if cradle.number("spiral_angle_deg").is_none() {
        return;
    }
    let unknown = !found.values.is_written(HEAD, radius);
    let message = || format!("`{path}` gives no settings without a cutter radius");
    found.blame(unknown, path, message, "write tool.face_mill.radius_mm, the mean radius of the head");
    let is_set = |key: &&str| cradle.number(key).is_some_and(|number| number != 0.0);
    for key in ["tilt_deg", "swivel_deg", "cross_shift_mm", "center_to_back_mm"].into_iter().filter(is_set) {
        let key = join("machine.cradle", key);
        let message = || {
            format!("`{key}`: the settings of a spiral angle are those of an upright head about the machine's centre")
        };
        let way_out = "remove it, or write radial_setting_mm and cradle_angle_deg in place of spiral_angle_deg";
        found.blame(true, &key, message, way_out);
    }
}

/// An upright head leans nowhere: an error of its swivel does nothing.
fn swivel_of_an_upright_head(found: &mut Found) {
    let is_set = |section: &str, key: &str| found.view(section).number(key).is_some_and(|number| number != 0.0);
    let leans = ["machine.cradle", "machine.cradle_errors"].iter().any(|section| is_set(section, "tilt_deg"));
    let path = "machine.cradle_errors.swivel_deg";
    let wrong = is_set("machine.cradle_errors", "swivel_deg") && !leans;
    let message = || format!("`{path}` does nothing: machine.cradle.tilt_deg is 0, and an upright head leans nowhere");
    found.blame(wrong, path, message, "remove it, or give the head a tilt");
}

/// Keys of the roll where nothing rolls, and keys of the plunge where the cradle rolls.
fn keys_of_the_other_way(found: &mut Found) {
    let (keys, why, way_out): (&[&str], _, _) = if plunges(found.values) {
        let keys = &["roll_speed_deg_per_s", "roll_from_deg", "roll_to_deg"];
        (keys, "nothing rolls: machine.cradle.roll_ratio is 0", "remove it, or write another roll_ratio")
    } else {
        (
            &["infeed_mm_per_revolution", "dwell_revolutions"],
            "the cradle rolls",
            "remove it, or write machine.cradle.roll_ratio = 0",
        )
    };
    let in_operation = |index| keys.iter().map(move |key| (format!("operation.{index}"), *key));
    let mut wrong: Vec<(String, &str)> = (0..found.values.count("operation")).flat_map(in_operation).collect();
    wrong.retain(|(path, key)| found.view(path).number(key).is_some());
    if plunges(found.values) {
        let of_roll = [
            ("cradle", "modified_roll_c"),
            ("cradle", "modified_roll_d"),
            ("cradle_errors", "roll_ratio"),
            ("cradle_errors", "tilt_deg"),
        ];
        let of_roll = of_roll.map(|(section, key)| (format!("machine.{section}"), key));
        let is_set = |(path, key): &(String, &str)| found.view(path).number(key).is_some_and(|number| number != 0.0);
        wrong.extend(of_roll.into_iter().filter(is_set));
    }
    for (path, key) in wrong {
        let key = join(&path, key);
        found.blame(true, &key, || format!("`{key}`: {why}"), way_out);
    }
}

impl ProcessPart for Bevel {
    fn process(&self) -> &'static SceneProcess {
        &SCENE
    }

    fn files_read(&self) -> Vec<&Path> {
        self.operations.iter().filter_map(|operation| operation.program.as_deref()).collect()
    }

    fn error_layers(&self) -> Vec<ErrorLayer> {
        let tool = !self.head.mounting.is_none() || self.head.runouts_mm.iter().any(|&runout| runout != 0.0);
        let mut layers = self.errors.layers(&[(ErrorLayer::Tool, tool)]);
        let off = self.settings.errors.iter().any(|&(_, error)| error != 0.0);
        if off && !layers.contains(&ErrorLayer::Axes) {
            layers.insert(0, ErrorLayer::Axes);
        }
        layers
    }

    fn keep_layers(&mut self, kept: &[ErrorLayer]) {
        self.errors.keep(kept);
        if !kept.contains(&ErrorLayer::Tool) {
            self.head.mounting = ToolMounting::default();
            self.head.runouts_mm.clear();
        }
        if !kept.contains(&ErrorLayer::Axes) {
            self.settings.errors.iter_mut().for_each(|(_, error)| *error = 0.0);
        }
    }

    fn axis_errors_mut(&mut self) -> &mut [AxisErrors] {
        &mut self.errors.axes
    }

    fn operation_names(&self) -> Vec<&str> {
        self.operations.iter().map(|operation| operation.name.as_str()).collect()
    }
}
