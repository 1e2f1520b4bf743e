//! Checked values of a hobbing scene to the model.

use super::keys::{AXES, PROFILE, WEAR};
use super::model::{
    Approach, EvenMotion, ExtraRotation, FeedDirection, FeedOf, GashForm, HobRelief, HobSize, HobSpec, Hobbing,
    HobbingAxisLimits, HobbingKind, HobbingOperation, LinkageForm, Protuberance, ShiftDirection, ShiftStrategy, Worm,
};
use super::standard_hob::{self, HobTip};
use crate::scene::ScenePart;
use crate::scene::build::{cutting_force, linear_programs, stock_or_offset_mm};
use crate::scene::drawn_profile::ToolProfile;
use crate::scene::machine_errors::{machine_errors, tool_mounting};
use crate::scene::tool_wear;
use crate::scene::values::{Values, View};
use gearcut_core::units::{TURN_RAD, UM_PER_MM};
use std::path::Path;

/// Hobbing: hob, limits and operations.
pub(super) fn build(values: &Values, base_dir: &Path) -> Option<ScenePart> {
    let pressure_angle_rad = values.view("gear").rad("pressure_angle_deg")?;
    let operations: Option<Vec<HobbingOperation>> = (0..values.count("operation"))
        .map(|index| operation(values, &format!("operation.{index}"), base_dir, pressure_angle_rad))
        .collect();
    let profile = ToolProfile::of(values, PROFILE, base_dir);
    let tool = HobSpec { profile, ..hob(values.view("tool.hob"), values.view("gear"))? };
    let material = match values.view("material") {
        material if material.text("name").is_some() => Some(cutting_force(material)?),
        _ => None,
    };
    let programs = linear_programs(values)?;
    Some(ScenePart::new(Hobbing {
        tool,
        limits: limits(values),
        errors: machine_errors(values, &AXES)?,
        operations: operations?,
        material,
        wear: tool_wear::spec(values, WEAR),
        programs,
    }))
}

fn hob(hob: View<'_>, gear: View<'_>) -> Option<HobSpec> {
    let module_mm = gear.number("module_mm")?;
    let addendum_coefficient = hob.number("addendum_coefficient")?;
    let thinning_mm = hob.number("thinning_mm")?;
    let protuberance = match hob.number("protuberance_height_mm") {
        Some(height_mm) => Some(Protuberance { height_mm, angle_rad: hob.rad("protuberance_angle_deg")? }),
        None => None,
    };
    let tip = HobTip {
        module_mm,
        pressure_angle_rad: gear.rad("pressure_angle_deg")?,
        hob_addendum: addendum_coefficient,
        gear_addendum: gear.number("addendum_coefficient")?,
        thinning_mm,
        protuberance,
    };
    let usual_mm = standard_hob::size_mm(module_mm);
    Some(HobSpec {
        starts: hob.whole("starts")?,
        hand: hob.hand("hand")?,
        gashes: hob.whole("gashes")?,
        gash_form: match hob.text("gash_form")? {
            "axial" => GashForm::Axial,
            "helical" => GashForm::Helical,
            _ => return None,
        },
        size: match (hob.rad("lead_angle_deg"), hob.number("reference_diameter_mm")) {
            (Some(angle), _) => HobSize::LeadAngle(angle),
            (None, Some(diameter_mm)) => HobSize::ReferenceDiameter(diameter_mm),
            (None, None) => HobSize::ReferenceDiameter(usual_mm?[0] - 2.0 * addendum_coefficient * module_mm),
        },
        length_mm: hob.number("length_mm").or(usual_mm.map(|[_, length_mm]| length_mm))?,
        addendum_coefficient,
        dedendum_coefficient: hob.number("dedendum_coefficient")?,
        worm: match hob.text("worm")? {
            "involute" => Worm::Involute,
            "straight_sided" => Worm::StraightSided,
            _ => return None,
        },
        profile: None,
        tip_radius_mm: hob.number("tip_radius_mm").unwrap_or_else(|| tip.round_mm()),
        protuberance,
        tip_reliefs: tip_reliefs(hob, gear)?,
        thinning_mm,
        regrind_mm: hob.number("regrind_mm")?,
        mounting: tool_mounting(hob),
        pitch_errors_mm: hob.numbers("pitch_errors_um")?.iter().map(|um| um / UM_PER_MM).collect(),
    })
}

/// HobTip relief as a share of the height up to the gear's addendum, semi-topping by its angle.
fn tip_reliefs(hob: View<'_>, gear: View<'_>) -> Option<Vec<HobRelief>> {
    let flank_rad = gear.rad("pressure_angle_deg")?;
    let addendum_mm = gear.number("addendum_coefficient")? * gear.number("module_mm")?;
    let mut reliefs = Vec::new();
    if let Some(height_mm) = hob.number("tip_relief_height_mm") {
        let aside_mm = hob.mm_from_um("tip_relief_um")? / flank_rad.cos();
        reliefs.push(HobRelief { height_mm, slope: aside_mm / (addendum_mm - height_mm) });
    }
    if let Some(height_mm) = hob.number("semi_topping_height_mm") {
        let slope = hob.rad("semi_topping_angle_deg")?.tan() - flank_rad.tan();
        reliefs.push(HobRelief { height_mm, slope });
    }
    Some(reliefs)
}

fn limits(values: &Values) -> HobbingAxisLimits {
    let limits = values.view("machine.hobbing_limits");
    HobbingAxisLimits {
        speeds: [
            limits.rad("hob_speed_deg_per_s"),
            limits.rad("work_speed_deg_per_s"),
            limits.number("tangential_speed_mm_per_s"),
            limits.number("radial_speed_mm_per_s"),
            limits.number("slide_speed_mm_per_s"),
            limits.number("shift_speed_mm_per_s"),
        ],
        accelerations: [
            limits.rad("hob_acceleration_deg_per_s2"),
            limits.rad("work_acceleration_deg_per_s2"),
            limits.number("tangential_acceleration_mm_per_s2"),
            limits.number("radial_acceleration_mm_per_s2"),
            None,
            None,
        ],
    }
}

fn operation(values: &Values, path: &str, base_dir: &Path, pressure_angle_rad: f64) -> Option<HobbingOperation> {
    let operation = values.view(path);
    Some(HobbingOperation {
        name: operation.text("name")?.to_owned(),
        offset_mm: stock_or_offset_mm(operation, pressure_angle_rad)?,
        kind: kind(values, path, operation.variant("linkage")?)?,
        hob_speed_rad_per_s: operation.number("hob_speed_per_minute")? * TURN_RAD / 60.0,
        axial_feed_mm_per_revolution: operation.number("axial_feed_mm_per_revolution")?,
        feed_direction: match operation.text("feed_direction")? {
            "climb" => FeedDirection::Climb,
            "conventional" => FeedDirection::Conventional,
            _ => return None,
        },
        approach: match operation.text("approach")? {
            "axial" => Approach::Axial,
            "radial" => Approach::Radial { feed_mm_per_revolution: operation.number("radial_feed_mm_per_revolution")? },
            _ => return None,
        },
        approach_mm: operation.number("approach_mm"),
        overrun_mm: operation.number("overrun_mm"),
        head_angle_rad: operation.rad("head_angle_deg"),
        shift_start_mm: operation.number("shift_start_mm"),
        ridge_tolerance_mm: operation.mm_from_um("ridge_tolerance_um")?,
        program: operation.text("program").map(|name| base_dir.join(name)),
    })
}

fn kind(values: &Values, path: &str, law: &str) -> Option<HobbingKind> {
    let path = format!("{path}.linkage.{law}");
    let linkage = values.view(&path);
    let form = match linkage.text("form")? {
        "exact" => LinkageForm::Exact,
        "as_printed" => LinkageForm::AsPrinted,
        _ => return None,
    };
    Some(match law {
        "hobbing" => HobbingKind::Plain {
            even: match linkage.text("even_motion")? {
                "arc_length" => EvenMotion::ArcLength,
                "rotation_angle" => EvenMotion::RotationAngle,
                "polar_angle" => EvenMotion::PolarAngle,
                _ => return None,
            },
            extra: match linkage.text("extra_rotation")? {
                "work" => ExtraRotation::Work,
                "hob" => ExtraRotation::Hob,
                _ => return None,
            },
            form,
        },
        "hobbing_diagonal" => HobbingKind::Diagonal {
            shift_mm_per_revolution: linkage.number("shift_mm_per_revolution")?,
            direction: match linkage.text("shift_direction")? {
                "adds" => ShiftDirection::Adds,
                "subtracts" => ShiftDirection::Subtracts,
                _ => return None,
            },
            strategy: match linkage.text("strategy")? {
                "one_way" => ShiftStrategy::OneWay,
                "repeating" => ShiftStrategy::Repeating { return_mm_per_s: linkage.number("return_mm_per_s")? },
                "reciprocating" => ShiftStrategy::Reciprocating,
                _ => return None,
            },
            stroke_mm: linkage.number("stroke_mm"),
            feed_of: match linkage.text("feed_of")? {
                "slide" => FeedOf::Slide,
                "resultant" => FeedOf::Resultant,
                _ => return None,
            },
            form,
        },
        _ => return None,
    })
}
