//! Cutter and teeth: what the finishing operation generates in the limit of many strokes.

use crate::output::text::Sheet;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::target::FlankEnd;

use super::facts::{FlankFacts, ToothFacts};

/// Tip lands below this (in modules) are called narrow: case-hardened tips break below about 0.2 to 0.3 modules.
const NARROW_LAND_MODULES: f64 = 0.25;

/// Values closer than this print alike, mm.
const SAME_MM: f64 = 5e-4;

pub fn print(sheet: &mut Sheet, job: &ShapingJob, facts: &[ToothFacts]) {
    let cutter = &job.cutter;
    sheet.heading("Cutter");
    sheet.line("teeth", cutter.teeth.to_string());
    sheet.line(
        "radii",
        format!(
            "pitch {:.3} mm, base {:.3} mm, tip {:.3} mm",
            cutter.pitch_radius_mm, cutter.base_radius_mm, cutter.tip_radius_mm
        ),
    );
    sheet.heading("Teeth");
    sheet.line("start of involute", range(facts, " over the pitch curve", |flank| flank.start_height_mm));
    sheet.line("end of flank", range(facts, " over the pitch curve", |flank| flank.tip_height_mm));
    sheet.line("length of profile", range(facts, "", |flank| flank.length_mm));
    let land = |tooth: &ToothFacts| tooth.tip_land_mm;
    if let (Some(low), Some(high)) = (
        facts.iter().min_by(|a, b| land(a).total_cmp(&land(b))),
        facts.iter().max_by(|a, b| land(a).total_cmp(&land(b))),
    ) {
        let (narrow, wide) = (land(low), land(high));
        let text = if wide - narrow < SAME_MM {
            format!("{narrow:.3} mm on all teeth")
        } else {
            format!("{narrow:.3} mm (tooth {}) to {wide:.3} mm (tooth {})", low.tooth, high.tooth)
        };
        sheet.line("tip land", text);
    }
    sheet.line("undercut", flanks_with(facts, FlankFacts::is_undercut));
    sheet.line(
        "pointed teeth",
        list(facts.iter().filter(|tooth| tooth.is_pointed()).map(|tooth| tooth.tooth.to_string())),
    );
}

pub fn warnings(job: &ShapingJob, facts: &[ToothFacts]) -> Vec<String> {
    let mut warnings = Vec::new();
    let undercut = flanks_with(facts, FlankFacts::is_undercut);
    if undercut != NONE {
        warnings.push(format!(
            "the cutter undercuts {undercut}: use a smaller tool.shaper_cutter.addendum_coefficient, more teeth on the \
            gear, or a pitch curve with a larger smallest radius of curvature"
        ));
    }
    let base = flanks_with(facts, |flank| flank.end == FlankEnd::CutterBase);
    if base != NONE {
        warnings.push(format!(
            "the cutter's involute ends before the tip of {base}: the rest of the tip is cut by the cutter's base; use \
            a cutter with more teeth or a smaller gear.addendum_coefficient"
        ));
    }
    let pointed = list(facts.iter().filter(|tooth| tooth.is_pointed()).map(|tooth| tooth.tooth.to_string()));
    if pointed != NONE {
        warnings.push(format!("pointed below the blank's outline: tooth {pointed}"));
    }
    let narrow_mm = NARROW_LAND_MODULES * job.scene.gear.module_mm;
    let narrow = facts.iter().filter(|tooth| !tooth.is_pointed() && tooth.tip_land_mm < narrow_mm);
    let narrow = list(narrow.map(|tooth| tooth.tooth.to_string()));
    if narrow != NONE {
        warnings.push(format!("tip land below {NARROW_LAND_MODULES} modules ({narrow_mm:.3} mm): tooth {narrow}"));
    }
    warnings
}

/// What stands where a list is empty.
const NONE: &str = "none";
/// Entries of a list that are shown.
const SHOWN: usize = 8;

/// Entries with commas, the first ones when there are many.
fn list(entries: impl Iterator<Item = String>) -> String {
    let entries: Vec<String> = entries.collect();
    match entries.len() {
        0 => NONE.to_owned(),
        1..=SHOWN => entries.join(", "),
        more => format!("{} and {} more", entries[..SHOWN].join(", "), more - SHOWN),
    }
}

fn flanks_with(facts: &[ToothFacts], holds: impl Fn(&FlankFacts) -> bool) -> String {
    let flanks = facts.iter().flat_map(|tooth| tooth.flanks().map(|(side, flank)| (tooth.tooth, side, flank)));
    list(flanks.filter(|(_, _, flank)| holds(flank)).map(|(tooth, side, _)| format!("tooth {tooth} {}", side.name())))
}

/// Smallest and largest value over all flanks, each with its first place.
fn range(facts: &[ToothFacts], over: &str, value: impl Fn(&FlankFacts) -> f64) -> String {
    let flanks = facts.iter().flat_map(|tooth| {
        tooth.flanks().map(|(side, flank)| (value(&flank), format!("tooth {} {}", tooth.tooth, side.name())))
    });
    let (mut low, mut high) = ((f64::INFINITY, String::new()), (f64::NEG_INFINITY, String::new()));
    for (value, place) in flanks {
        if value < low.0 {
            low = (value, place.clone());
        }
        if value > high.0 {
            high = (value, place);
        }
    }
    if high.0 - low.0 < SAME_MM {
        return format!("{:.3} mm{over} on all flanks", high.0);
    }
    format!("{:.3} mm ({}) to {:.3} mm ({}){over}", low.0, low.1, high.0, high.1)
}
