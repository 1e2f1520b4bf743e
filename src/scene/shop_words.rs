//! Words of drawings and shops that a scene does not take, and what to write in their stead.
//!
//! In: a name that is no key, with its value. Out: a way out with the number that belongs there, in mm. Lengths in
//! inches are known by their ending; a diametral pitch P is the module 25.4 mm / P (ISO 54). Road not taken: keys in
//! inches. Two units for one value double every key, range and message, and a scene with both would be read wrongly one
//! day.

use super::keys::{Key, join};
use super::table::TableSection;
use super::tree::{Node, TomlValue};

/// An inch, mm.
const INCH_MM: f64 = 25.4;
/// Names of the diametral pitch, in the normal section of helical gears as the module is.
const DIAMETRAL_PITCH: [&str; 4] = ["diametral_pitch", "normal_diametral_pitch", "dp", "pitch_diametral"];
/// What lengths in inches end with.
const INCHES: [&str; 4] = ["_in", "_inch", "_inches", "_mil"];
/// Beginnings of what a shaper cutter's or another edge has beyond its basic profile.
const SHAPED_TIPS: [&str; 3] = ["tip_relief", "semi_topping", "semitopping"];

/// What to write instead of an entry of a section; `None` of a name that is no such word.
pub(super) fn way_out(section: &TableSection, name: &str, node: &Node) -> Option<String> {
    let number = match node.value {
        TomlValue::Whole(value) => Some(value as f64),
        TomlValue::Number(value) => Some(value),
        _ => None,
    };
    let name = name.to_ascii_lowercase();
    if DIAMETRAL_PITCH.contains(&name.as_str()) {
        let module_mm = number.filter(|pitch| *pitch > 0.0).map(|pitch| shown(INCH_MM / pitch));
        return Some(match module_mm {
            Some(module_mm) => format!("write module_mm = {module_mm}: a module is 25.4 mm over the diametral pitch"),
            None => "write module_mm, 25.4 mm over the diametral pitch".to_owned(),
        });
    }
    if name == "units" || name == "unit" {
        return Some(
            "remove it: every key names its unit, and lengths are in mm; an inch is 25.4 mm, and a module 25.4 mm over \
             the diametral pitch"
                .to_owned(),
        );
    }
    if SHAPED_TIPS.iter().any(|word| name.starts_with(word)) && section.path == "tool.shaper_cutter" {
        return Some(
            "remove it, and give the tooth as a contour, from points or a drawing, by [tool.shaper_cutter.profile]; \
             without one flanks are one involute down to the root, with a tip by [tool.shaper_cutter.tip]"
                .to_owned(),
        );
    }
    let (stem, ending) = INCHES.iter().find_map(|ending| Some((name.strip_suffix(ending)?, *ending)))?;
    let of_inch = if ending == "_mil" { 1e-3 } else { 1.0 };
    let (key, per_mm) = section.keys.iter().find_map(|key: &&Key| {
        let units = [("_mm", 1.0), ("_um", 1e3)];
        units.iter().find_map(|(unit, per_mm)| (key.name.strip_suffix(unit)? == stem).then_some((key.name, *per_mm)))
    })?;
    Some(match number {
        Some(value) => format!("write {key} = {}: an inch is 25.4 mm", shown(value * of_inch * INCH_MM * per_mm)),
        None => format!("write {} in mm: an inch is 25.4 mm", join(section.path, key)),
    })
}

/// A number as a scene takes it, to a nanometre of a metre.
fn shown(value: f64) -> String {
    format!("{}", (value * 1e9).round() / 1e9)
}
