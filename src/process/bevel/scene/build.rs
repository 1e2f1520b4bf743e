//! Checked values of a bevel scene to the model.

use super::keys::AXES;
use super::model::{Bevel, BevelOperation, Cones, HeadSpec, SettingsSpec, SlotFeed};
use crate::scene::ScenePart;
use crate::scene::build::{cutting_force, linear_programs, stock_or_offset_mm};
use crate::scene::machine_errors::{machine_errors, tool_mounting};
use crate::scene::values::{Values, View};
use gearcut_core::bevel::blank::MatingCones;
use gearcut_core::bevel::cradle::{CradleSettings, Roll, Tilt};
use gearcut_core::bevel::ease_off::Setting;
use gearcut_core::units::{TURN_RAD, UM_PER_MM};
use std::path::Path;

/// Axes of the limits: word, and whether they turn.
const LIMITED: [(&str, bool); 5] = [("x", false), ("y", false), ("z", false), ("a", true), ("b", true)];

/// The part of a bevel scene.
pub(super) fn build(values: &Values, base_dir: &Path) -> Option<ScenePart> {
    let pressure_angle_rad = values.view("gear").rad("pressure_angle_deg")?;
    let operations: Option<Vec<BevelOperation>> = (0..values.count("operation"))
        .map(|index| operation(values.view(&format!("operation.{index}")), base_dir, pressure_angle_rad))
        .collect();
    let programs = linear_programs(values)?;
    let limit =
        |order: &str| LIMITED.map(|(axis, turns)| limits(values.view("machine.bevel_limits"), axis, order, turns));
    let material = match values.view("material") {
        material if material.text("name").is_some() => Some(cutting_force(material)?),
        _ => None,
    };
    Some(ScenePart::new(Bevel {
        cones: cones(values.view("gear.bevel"))?,
        head: head(values.view("tool.face_mill"))?,
        settings: settings(values.view("machine.cradle"), values.view("machine.cradle_errors"))?,
        errors: machine_errors(values, &AXES)?,
        mounting_mm: values.view("machine.five_axis").number("mounting_distance_mm")?,
        speed_limits: limit("speed"),
        acceleration_limits: limit("acceleration"),
        travel: travel(values.view("machine.bevel_limits")),
        grid: [
            values.view("inspection").whole("profile_points")? as usize,
            values.view("inspection").whole("tooth_points")? as usize,
        ],
        operations: operations?,
        material,
        programs,
    }))
}

fn cones(cones: View<'_>) -> Option<Cones> {
    let shaft_angle_rad = cones.rad("shaft_angle_deg")?;
    Some(Cones {
        pitch_angle_rad: cones.rad("pitch_angle_deg")?,
        face_angle_rad: cones.rad("face_angle_deg")?,
        root_angle_rad: cones.rad("root_angle_deg")?,
        addendum_mm: cones.number("addendum_mm")?,
        dedendum_mm: cones.number("dedendum_mm")?,
        mate: cones.whole("mate_teeth").map(|teeth| MatingCones { teeth, shaft_angle_rad }),
        shaft_angle_rad,
        hypoid_offset_mm: cones.number("hypoid_offset_mm")?,
    })
}

fn head(head: View<'_>) -> Option<HeadSpec> {
    Some(HeadSpec {
        radius_mm: head.number("radius_mm"),
        point_width_mm: head.number("point_width_mm")?,
        blade_angles_rad: [head.rad("outside_blade_angle_deg")?, head.rad("inside_blade_angle_deg")?],
        corner_radius_mm: head.number("corner_radius_mm")?,
        tip_width_mm: head.number("tip_width_mm"),
        blades: head.whole("blades")?,
        runouts_mm: head.numbers("runouts_um")?.iter().map(|um| um / UM_PER_MM).collect(),
        start_angle_rad: head.rad("start_angle_deg")?,
        mounting: tool_mounting(head),
    })
}

fn settings(cradle: View<'_>, errors: View<'_>) -> Option<SettingsSpec> {
    let (root_angle_rad, roll_ratio) = (cradle.rad("root_angle_deg"), cradle.number("roll_ratio"));
    let (spiral_angle_rad, sliding_base_mm) = (cradle.rad("spiral_angle_deg"), cradle.number("sliding_base_mm"));
    Some(SettingsSpec {
        cradle: CradleSettings {
            radial_setting_mm: cradle.number("radial_setting_mm").unwrap_or_default(),
            cradle_angle_rad: cradle.rad("cradle_angle_deg").unwrap_or_default(),
            blank_offset_mm: cradle.number("blank_offset_mm")?,
            cross_shift_mm: cradle.number("cross_shift_mm")?,
            sliding_base_mm: sliding_base_mm.unwrap_or_default(),
            center_to_back_mm: cradle.number("center_to_back_mm")?,
            root_angle_rad: root_angle_rad.unwrap_or_default(),
            tilt: Tilt { tilt_rad: cradle.rad("tilt_deg")?, swivel_rad: cradle.rad("swivel_deg")? },
            roll: Roll {
                ratio: roll_ratio.unwrap_or_default(),
                second_order_per_rad: cradle.number("modified_roll_c")?,
                third_order_per_rad2: cradle.number("modified_roll_d")?,
                ratio_error: 0.0,
            },
        },
        spiral_angle_rad,
        sliding_base_mm,
        root_angle_rad,
        roll_ratio,
        errors: [
            (Setting::Radial, errors.number("radial_setting_mm")?),
            (Setting::CradleAngle, errors.rad("cradle_angle_deg")?),
            (Setting::BlankOffset, errors.number("blank_offset_mm")?),
            (Setting::SlidingBase, errors.number("sliding_base_mm")?),
            (Setting::CenterToBack, errors.number("center_to_back_mm")?),
            (Setting::RootAngle, errors.rad("root_angle_deg")?),
            (Setting::RollRatio, errors.number("roll_ratio")?),
            (Setting::Tilt, errors.rad("tilt_deg")?),
            (Setting::Swivel, errors.rad("swivel_deg")?),
        ],
    })
}

fn limits(limits: View<'_>, axis: &str, order: &str, turns: bool) -> Option<f64> {
    let square = if order == "acceleration" { "2" } else { "" };
    if turns {
        limits.rad(&format!("{axis}_{order}_deg_per_s{square}"))
    } else {
        limits.number(&format!("{axis}_{order}_mm_per_s{square}"))
    }
}

/// Ends of the travel of X, Y, Z and B.
fn travel(limits: View<'_>) -> [[Option<f64>; 2]; 4] {
    let ends = |axis: &str| ["from", "to"].map(|end| limits.number(&format!("{axis}_{end}_mm")));
    [ends("x"), ends("y"), ends("z"), ["b_from_deg", "b_to_deg"].map(|key| limits.rad(key))]
}

fn operation(operation: View<'_>, base_dir: &Path, pressure_angle_rad: f64) -> Option<BevelOperation> {
    let feed = match operation.number("infeed_mm_per_revolution") {
        Some(mm_per_turn) => {
            SlotFeed::Plunge { mm_per_turn, dwell_revolutions: operation.number("dwell_revolutions")? }
        }
        None => SlotFeed::Roll {
            rad_per_s: operation.rad("roll_speed_deg_per_s")?,
            ends_rad: [operation.rad("roll_from_deg"), operation.rad("roll_to_deg")],
        },
    };
    Some(BevelOperation {
        name: operation.text("name")?.to_owned(),
        offset_mm: stock_or_offset_mm(operation, pressure_angle_rad)?,
        head_speed_rad_per_s: operation.number("head_speed_per_minute")? * TURN_RAD / 60.0,
        feed,
        idle_s: operation.number("idle_s")?,
        program: operation.text("program").map(|name| base_dir.join(name)),
    })
}
