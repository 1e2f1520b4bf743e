//! `[tool.NAME.profile]`: the contour of a tooth in place of an involute one, for every tool that takes it.
//!
//! In: values of the section. Out: [`ToolProfile`]; what else says how the tooth is shaped is refused beside it.

use super::keys::{Default, Key, Kind, Range};
use super::problems::Found;
use super::values::Values;
use std::path::{Path, PathBuf};

/// How far the edge may pass beside the contour.
pub(crate) const TOLERANCE: Key = Key {
    name: "tolerance_um",
    kind: Kind::Number(Range::closed(0.05, 50.0)),
    unit: "um",
    default: Default::Number(1.0),
    example: "1.0",
    teach: "How far the edge that cuts may pass beside the contour: half for arcs through its points, half for \
        tangents along its hollows. Three times the scatter of measured points or more: they are smoothed within it.",
};

/// The contour of a tooth.
#[derive(Debug, Clone, PartialEq)]
pub struct ToolProfile {
    /// Where it is.
    pub file: PathBuf,
    /// How far the edge that cuts may pass beside it.
    pub tolerance_mm: f64,
}

impl ToolProfile {
    /// What a section says; `None` where it names no file.
    pub(crate) fn of(values: &Values, section: &str, base_dir: &Path) -> Option<Self> {
        let profile = values.view(section);
        Some(Self { file: base_dir.join(profile.text("file")?), tolerance_mm: profile.mm_from_um("tolerance_um")? })
    }
}

/// Keys of the tool that a contour replaces, each with the value that is as good as not written: a resolved scene has
/// all keys.
pub(crate) type Replaced = (&'static str, &'static str, Option<f64>);

/// A contour says all of a tooth: what else would shape it, or would shift it by the law of involutes, is refused;
/// `tool` is what else moves the tooth, in words. Whether the section names a contour.
pub(crate) fn refuse_beside(found: &mut Found, section: &str, tool: &str, replaced: &[Replaced]) -> bool {
    if found.view(section).text("file").is_none() {
        return false;
    }
    for &(of, name, usual) in replaced.iter().chain(&[("measure", "ball_diameter_mm", None)]) {
        let key = format!("{of}.{name}");
        let is_set = found.view(of).number(name).is_some_and(|value| Some(value) != usual);
        let message = || format!("`{key}` says nothing of a tooth that {section}.file draws");
        found.blame(is_set, &key, message, "remove it, or have the contour drawn that way");
    }
    let class = "measure.iso_1328_class";
    let has_class = found.view("measure").whole("iso_1328_class").is_some();
    let message = || format!("`{class}` judges involute flanks, and {section}.file draws others");
    found.blame(has_class, class, message, "remove it, and give the limits of the drawing under [measure]");
    for name in ["profile_shift_coefficient", "tooth_thickness_allowance_mm"] {
        let key = format!("gear.{name}");
        let is_set = found.view("gear").number(name).is_some_and(|value| value != 0.0);
        let message = || format!("`{key}` follows the law of involute teeth, and {section}.file draws others");
        let way_out = format!("remove it, and move the {tool} by offset_mm of the operations");
        found.blame(is_set, &key, message, &way_out);
    }
    true
}
