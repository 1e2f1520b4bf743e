//! Values of a shaping scene compared with each other.

use super::defaults::reach_mm;
use super::keys::{
    AXES, BUILT_UP_EDGE, BUILT_UP_EDGE_KEYS, CMM, EDGE_ROUGHNESS, EDGE_ROUNDING, GRINDING, PROFILE, VIBRATION_KEYS,
    VIBRATION_PATH, WEAR,
};
use super::model::guide_hand;
use super::stock::{self, StockLimit};
use crate::scene::build::sector_deg;
use crate::scene::drawn_profile;
use crate::scene::keys::join;
use crate::scene::machine_errors;
use crate::scene::problems::Found;
use crate::scene::tool_wear;
use gearcut_core::gear::GearKind;
use std::f64::consts::PI;

/// Most strokes of one operation; ten thousand per tooth of a hundred-tooth gear are already beyond any machine.
const MOST_STROKES: f64 = 1e7;

/// Finest spacing of the rays on which chips are followed, per module: ten times finer than usual, maps take some
/// hundred megabytes.
const MOST_CHIP_SPACINGS_PER_MODULE: f64 = 600.0;

/// Dedendum of a cutter that does not say its own, modules.
const USUAL_DEDENDUM: f64 = 1.25;

/// Adds a problem for every contradiction.
pub(super) fn check(found: &mut Found<'_, '_, '_>) {
    // A missing value ends only the check that asks for it.
    let _: [Option<()>; 4] = [cutter_core(found), cutter_thinning(found), pitch_errors(found), chips(found)];
    tip(found);
    together(found, EDGE_ROUGHNESS, &["rq_um", "correlation_length_um"]);
    together(found, EDGE_ROUNDING, &["radius_um", "minimum_chip_share"]);
    together(found, BUILT_UP_EDGE, &BUILT_UP_EDGE_KEYS);
    tool_wear::check(found, WEAR);
    speeds(found);
    let measures_nothing = found.values.has_section(CMM) && found.values.count("operation") == 1;
    let message = || format!("`{CMM}` measures allowances between operations, and the scene has one alone");
    found.blame(measures_nothing, CMM, message, "remove it, or write an operation that roughs before");
    together(found, VIBRATION_PATH, &VIBRATION_KEYS);
    vibration(found);
    drawn_tooth(found);
    sector(found);
    let _: Option<()> = helix(found);
    machine_errors::check(found, &AXES);
    for index in 0..found.values.count("operation") {
        let path = format!("operation.{index}");
        let _: [Option<()>; 7] = [
            window(found, &path),
            offset(found, index, &path),
            strokes(found, &path),
            feed(found, &path),
            time_spacing(found, &path),
            infeed(found, &path),
            scatter(found, &path),
        ];
    }
}

/// A sector is an external gear with a law of its own, cut in one swing from beside the stock.
fn sector(found: &mut Found) {
    let (key, gear) = ("gear.sector_deg", found.view("gear"));
    if sector_deg(found.values).is_none() {
        let message = || "`gear.dwell_radius_mm`: a gear with teeth all round has no dwell".to_owned();
        let way_out = "remove it, or write sector_deg = [-60.0, 60.0], for example";
        found.blame(gear.number("dwell_radius_mm").is_some(), "gear.dwell_radius_mm", message, way_out);
        return;
    }
    let (ring, mate) = (gear.text("kind") == Some("internal"), gear.variant("pitch_curve") == Some("mate"));
    let message = || format!("`{key}`: a ring with teeth over a part of its turn is not cut");
    found.blame(ring, key, message, "write kind = \"external\", or leave the sector out");
    let message = || format!("`{key}`: the law of a mate is closed all round, with the teeth of its whole turn");
    found.blame(mate, key, message, "write the radius or the ratio of the sector itself");
    for index in 0..found.values.count("operation") {
        let path = format!("operation.{index}");
        let operation = found.view(&path);
        let law = operation.variant("infeed").unwrap_or("none").to_owned();
        let turns = operation.whole("revolutions").unwrap_or(1) > 1;
        let overlap = operation.number("overlap_deg").unwrap_or(0.0) > 0.0;
        let message = || format!("`operation.infeed.{law}`: the swing over a sector begins beside the stock, at depth");
        let way_out = "write [operation.infeed.none]; a cut before it with an offset_mm takes less at a time";
        found.blame(law != "none", &join(&path, &format!("infeed.{law}")), message, way_out);
        for (name, wrong) in [("revolutions", turns), ("overlap_deg", overlap)] {
            let message =
                || format!("`operation.{name}`: a sector is cut in one swing, from before its teeth to behind them");
            found.blame(wrong, &join(&path, name), message, "remove it, or write the operation twice");
        }
    }
}

/// A helical gear needs a guide of its hand, and is not cut with all that a spur gear is.
fn helix(found: &mut Found) -> Option<()> {
    let (gear, machine) = (found.view("gear"), found.view("machine"));
    let is_helical = gear.number("helix_angle_deg")? > 0.0;
    let written = [
        ("machine.guide_lead_mm", machine.number("guide_lead_mm").is_some()),
        ("machine.guide_hand", machine.text("guide_hand").is_some()),
    ];
    for (key, is_written) in written {
        let message = || format!("`{key}`: a spur gear is cut with a straight guide");
        found.blame(!is_helical && is_written, key, message, "remove it, or write gear.helix_angle_deg");
    }
    if !is_helical {
        return None;
    }
    let kind = if gear.text("kind")? == "internal" { GearKind::Internal } else { GearKind::External };
    let (gear_hand, needed) = (gear.hand("hand")?, guide_hand(kind, gear.hand("hand")?));
    let is_other = machine.hand("guide_hand").is_some_and(|hand| hand != needed);
    let message = || {
        let where_to = if kind == GearKind::Internal { "ring" } else { "external gear" };
        format!(
            "`machine.guide_hand`: a {}-hand {where_to} needs a {}-hand guide; this one cuts the other hand",
            gear_hand.name(),
            needed.name()
        )
    };
    found.blame(is_other, "machine.guide_hand", message, "remove it, or give the gear the other hand");
    let spur_only = [
        ("gear.sector_deg", sector_deg(found.values).is_some(), "a sector"),
        ("machine.compliance", yields(found), "deflection by the cut"),
        (EDGE_ROUNDING, found.view(EDGE_ROUNDING).number("radius_um").is_some(), "ploughing by rounded edges"),
        (BUILT_UP_EDGE, found.view(BUILT_UP_EDGE).number("density_per_mm2").is_some(), "tearing by a built-up edge"),
        (CMM, found.values.has_section(CMM), "a coordinate measurement"),
    ];
    for (key, is_written, what) in spur_only {
        let message = || format!("`{key}`: {what} is known for spur gears alone");
        found.blame(is_written, key, message, "remove it, or write helix_angle_deg = 0");
    }
    Some(())
}

/// Whether the machine gives way at all.
fn yields(found: &Found) -> bool {
    let compliance = found.view("machine.compliance");
    let of = |side: &str| {
        ["radial_um_per_kn", "tangential_um_per_kn", "torsional_urad_per_nm"].map(|name| format!("{side}_{name}"))
    };
    ["tool", "work"].iter().flat_map(|side| of(side)).any(|name| compliance.number(&name).is_some_and(|of| of > 0.0))
}

/// A mass vibrates on a spring.
fn vibration(found: &mut Found) {
    let Some(coordinate) = found.view(VIBRATION_PATH).text(VIBRATION_KEYS[0]) else { return };
    let compliance = found.view("machine.compliance");
    let unit = if coordinate.ends_with("torsional") { "urad_per_nm" } else { "um_per_kn" };
    // A turn has a side of its own.
    let names = match coordinate {
        "radial" | "tangential" => ["tool", "work"].map(|side| format!("{side}_{coordinate}_{unit}")).to_vec(),
        _ => vec![format!("{coordinate}_{unit}")],
    };
    let is_rigid = !names.iter().any(|name| compliance.number(name).is_some_and(|of| of > 0.0));
    let key = join(VIBRATION_PATH, VIBRATION_KEYS[0]);
    let message = || format!("`{key}`: {coordinate} has no compliance, and a mass without a spring does not vibrate");
    let way_out = format!("write {} under [machine.compliance], or remove [{VIBRATION_PATH}]", names.join(" or "));
    found.blame(is_rigid, &key, message, &way_out);
}

/// Each of some keys says nothing without the others: a root mean square without a length, a radius without a share.
fn together(found: &mut Found, section: &str, names: &[&'static str]) {
    // One with a wrong value is written, and is blamed for that.
    let (there, missing): (Vec<&str>, Vec<&str>) =
        names.iter().partition(|name| found.values.is_written(section, name));
    let (Some(there), false) = (there.first(), missing.is_empty()) else { return };
    let missing = missing.join(" and ");
    let key = join(section, there);
    let message = || format!("`{key}` says nothing without {missing}");
    found.blame(true, &key, message, &format!("write {missing} as well, or remove it"));
}

/// A contour says all of a tooth.
fn drawn_tooth(found: &mut Found) {
    let cutter = "tool.shaper_cutter";
    let replaced = [
        (cutter, "dedendum_coefficient", Some(USUAL_DEDENDUM)),
        (cutter, "profile_shift_coefficient", Some(0.0)),
        (cutter, "thinning_mm", Some(0.0)),
        (EDGE_ROUGHNESS, "rq_um", None),
        (GRINDING, "tip_relief_angle_deg", Some(0.0)),
        (GRINDING, "pressure_angle_deg", None),
    ];
    if !drawn_profile::refuse_beside(found, PROFILE, "cutter", &replaced) {
        return;
    }
    let rough = join(EDGE_ROUGHNESS, "profile");
    let is_rough = found.view(EDGE_ROUGHNESS).text("profile").is_some();
    let message = || format!("`{rough}` says nothing of a tooth that {PROFILE}.file draws");
    found.blame(is_rough, &rough, message, "remove it: a measured contour has its own roughness");
    let tip = join(cutter, "tip");
    let has_tip = found.view(cutter).variant("tip").is_some_and(|tip| tip != "sharp");
    let message = || format!("`{tip}` says nothing of a tooth that {PROFILE}.file draws");
    found.blame(has_tip, &tip, message, "remove the section: the contour has its own corners");
}

/// Marks are densest between speeds at which there are any.
fn speeds(found: &mut Found) {
    let view = found.view(BUILT_UP_EDGE);
    let (Some(&[from, to]), Some(&[full_from, full_to])) =
        (view.numbers("speeds_m_per_min"), view.numbers("full_speeds_m_per_min"))
    else {
        return;
    };
    let key = join(BUILT_UP_EDGE, "speeds_m_per_min");
    let message = || format!("the speeds [{from}, {to}] m/min have no width");
    found.blame(from >= to, &key, message, "write the smaller speed first, and another one after it");
    let key = join(BUILT_UP_EDGE, "full_speeds_m_per_min");
    let message =
        || format!("the speeds [{full_from}, {full_to}] m/min do not lie in order between {from} and {to} m/min");
    let wrong = from < to && !(from <= full_from && full_from <= full_to && full_to <= to);
    found.blame(wrong, &key, message, "take speeds inside of speeds_m_per_min, the smaller one first");
}

fn cutter_core(found: &mut Found) -> Option<()> {
    let path = "tool.shaper_cutter";
    let cutter = found.view(path);
    let teeth = f64::from(cutter.whole("teeth")?);
    let (dedendum, shift) = (cutter.number("dedendum_coefficient")?, cutter.number("profile_shift_coefficient")?);
    let root_modules = teeth / 2.0 - dedendum + shift;
    let message = || format!("`{path}.teeth`: {teeth} teeth leave a cutter root radius of {root_modules:.3} modules");
    found.blame(root_modules < 0.5, &join(path, "teeth"), message, "take more teeth or a smaller dedendum_coefficient");
    Some(())
}

fn cutter_thinning(found: &mut Found) -> Option<()> {
    let path = "tool.shaper_cutter";
    let module_mm = found.view("gear").number("module_mm")?;
    let thinning_mm = found.view(path).number("thinning_mm")?;
    let allowance_mm = found.view("gear").number("tooth_thickness_allowance_mm")?;
    let half_pitch_mm = PI * module_mm / 2.0;
    let key = join(path, "thinning_mm");
    let message = || format!("`{key}`: {thinning_mm} takes the whole tooth thickness of {half_pitch_mm:.3} mm away");
    found.blame(thinning_mm.abs() >= half_pitch_mm, &key, message, "thin by a small part of the module");
    let key = "gear.tooth_thickness_allowance_mm";
    let message =
        || format!("`{key}`: {allowance_mm} is as much as the whole tooth thickness of {half_pitch_mm:.3} mm");
    found.blame(allowance_mm.abs() >= half_pitch_mm, key, message, "take a small part of the module");
    Some(())
}

fn pitch_errors(found: &mut Found) -> Option<()> {
    let path = "tool.shaper_cutter";
    let cutter = found.view(path);
    let (teeth, errors) = (cutter.whole("teeth")? as usize, cutter.numbers("pitch_errors_um")?.len());
    let message = || format!("`{path}.pitch_errors_um`: {errors} values for {teeth} cutter teeth");
    let key = join(path, "pitch_errors_um");
    found.blame(errors != 0 && errors != teeth, &key, message, "give one value per cutter tooth, or none");
    Some(())
}

fn tip(found: &mut Found) {
    for (path, name) in [("tool.shaper_cutter.tip.round", "radius_mm"), ("tool.shaper_cutter.tip.chamfer", "height_mm")]
    {
        let size_mm = found.view(path).number(name);
        let addendum = found.view("tool.shaper_cutter").number("addendum_coefficient");
        let module_mm = found.view("gear").number("module_mm");
        if let (Some(size_mm), Some(addendum), Some(module_mm)) = (size_mm, addendum, module_mm) {
            let addendum_mm = addendum * module_mm;
            let key = join(path, name);
            let message =
                || format!("`{key}`: {size_mm} is not smaller than the cutter's addendum of {addendum_mm:.3} mm");
            found.blame(size_mm >= addendum_mm, &key, message, "take about 0.2 modules");
        }
    }
}

fn chips(found: &mut Found) -> Option<()> {
    let path = "fields.chips.spacing_mm";
    let spacing_mm = found.view("fields.chips").number("spacing_mm")?;
    let least_mm = found.view("gear").number("module_mm")? / MOST_CHIP_SPACINGS_PER_MODULE;
    let message =
        || format!("`{path}`: {spacing_mm} is finer than the maps of chips can hold for this module: {least_mm:.4} mm");
    found.blame(spacing_mm < least_mm, path, message, "use module_mm / 600 or more; module_mm / 60 is the default");
    Some(())
}

fn window(found: &mut Found, path: &str) -> Option<()> {
    let operation = found.view(path);
    let window = operation.numbers("window_deg")?;
    let (start, end) = (*window.first()?, *window.get(1)?);
    let (revolutions, overlap_deg) = (operation.whole("revolutions"), operation.number("overlap_deg"));
    let key = join(path, "window_deg");
    let message = || format!("the window [{start}, {end}] deg ends before it begins");
    found.blame(start >= end, &key, message, "write the smaller work angle first");
    let message = || format!("the window [{start}, {end}] deg is wider than a turn");
    found.blame(end - start > 360.0, &key, message, "leave window_deg out, and use revolutions and overlap_deg");
    let message = || "a window cuts part of one turn, so more revolutions or an overlap contradict it".to_owned();
    let contradicted = revolutions.is_some_and(|turns| turns > 1) || overlap_deg.is_some_and(|overlap| overlap > 0.0);
    found.blame(contradicted, &key, message, "keep either window_deg or revolutions and overlap_deg");
    Some(())
}

fn offset(found: &mut Found, index: usize, path: &str) -> Option<()> {
    let reach_mm = reach_mm(found.values)?;
    let operation = found.view(path);
    if let Some(stock_mm) = operation.number("stock_per_flank_mm")
        && let Some(limit) = stock::limit(found.values, index)
    {
        let (beyond, end) = match limit {
            StockLimit::Most(most_mm) => (stock_mm >= most_mm, format!("less than {most_mm:.3} mm")),
            StockLimit::Least(least_mm) => (stock_mm <= least_mm, format!("more than {least_mm:.3} mm")),
        };
        let message = || format!("no depth of the cutter makes a stock of {stock_mm} mm on each flank");
        found.blame(beyond, &join(path, "stock_per_flank_mm"), message, &format!("take {end}"));
    }
    let offset_mm = stock::offset_mm(found.values, index)?;
    let name = if operation.number("stock_per_flank_mm").is_some() { "stock_per_flank_mm" } else { "offset_mm" };
    let message = || {
        format!(
            "an offset of {offset_mm:.3} mm keeps the cutter out of the blank: it reaches {reach_mm:.3} mm deep at \
            offset 0"
        )
    };
    found.blame(offset_mm >= reach_mm, &join(path, name), message, "take a smaller offset or stock");
    Some(())
}

fn strokes(found: &mut Found, path: &str) -> Option<()> {
    let operation = found.view(path);
    let per_turn = f64::from(operation.whole("strokes_per_revolution")?);
    let turns = f64::from(operation.whole("revolutions")?) + operation.number("overlap_deg")? / 360.0;
    let strokes = per_turn * turns;
    let message = || format!("{strokes:.2e} strokes in one operation; at most {MOST_STROKES:.0e} are taken");
    let key = join(path, "strokes_per_revolution");
    found.blame(strokes > MOST_STROKES, &key, message, "take fewer strokes or revolutions");
    Some(())
}

fn feed(found: &mut Found, path: &str) -> Option<()> {
    let gear = found.view("gear");
    let perimeter_mm = PI * gear.number("module_mm")? * f64::from(gear.whole("teeth")?);
    let operation = found.view(path);
    let feed_mm = operation.number("circular_feed_mm_per_stroke")?;
    let strokes = perimeter_mm / feed_mm;
    let key = join(path, "circular_feed_mm_per_stroke");
    let message = || {
        format!(
            "a feed of {feed_mm} mm gives {strokes:.1} strokes on a pitch curve of {perimeter_mm:.3} mm; 8 are the \
            fewest"
        )
    };
    found.blame(strokes < 8.0, &key, message, "take a smaller feed");
    let turns = f64::from(operation.whole("revolutions")?) + operation.number("overlap_deg")? / 360.0;
    let all = strokes * turns;
    let message = || format!("{all:.2e} strokes in one operation; at most {MOST_STROKES:.0e} are taken");
    found.blame(all > MOST_STROKES, &key, message, "take a larger feed or fewer revolutions");
    Some(())
}

fn time_spacing(found: &mut Found, path: &str) -> Option<()> {
    let by_time = found.view(path).text("stroke_spacing")? == "time";
    let limits = found.view("machine.limits");
    let names = ["work_speed_deg_per_s", "cutter_speed_deg_per_s", "center_distance_speed_mm_per_s"];
    let limited = names.iter().any(|name| limits.number(name).is_some());
    let message =
        || "stroke_spacing = \"time\" lets the slowest axis run at its limit, but no axis speed is limited".to_owned();
    let way_out = "write a speed under [machine.limits], or take \"work_angle\" or \"arc\"";
    found.blame(by_time && !limited, &join(path, "stroke_spacing"), message, way_out);
    Some(())
}

fn infeed(found: &mut Found, path: &str) -> Option<()> {
    let operation = found.view(path);
    let inside = format!("{path}.infeed.{}", operation.variant("infeed")?);
    let angle_deg = found.view(&inside).number("angle_deg")?;
    let turn_deg = match operation.numbers("window_deg") {
        Some([start, end]) => end - start,
        _ => 360.0 * f64::from(operation.whole("revolutions")?) + operation.number("overlap_deg")?,
    };
    let message = || format!("the infeed takes {angle_deg} deg, but the operation rolls over only {turn_deg} deg");
    let way_out = "feed over a smaller angle, or roll over more: revolutions, overlap_deg";
    found.blame(angle_deg >= turn_deg, &join(&inside, "angle_deg"), message, way_out);
    Some(())
}

/// A length over which nothing scatters says nothing.
fn scatter(found: &mut Found, path: &str) -> Option<()> {
    let operation = found.view(path);
    operation.number("stock_scatter_length_mm")?;
    let key = join(path, "stock_scatter_length_mm");
    let message = || format!("`{key}` says nothing without stock_scatter_um");
    let alone = operation.number("stock_scatter_um").is_none();
    found.blame(alone, &key, message, "write stock_scatter_um as well, or remove it");
    Some(())
}
