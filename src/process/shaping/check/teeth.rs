//! Cutter and teeth: what the finishing operation generates in the limit of many strokes.

use crate::drawn_tooth::drawn_words;
use crate::output::text::Sheet;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::tool::cutter::CutterTooth;

use crate::process::shaping::gear::tooth_facts::{FlankFacts, ToothFacts, flanks_with, list};

/// Values closer than this print alike, mm.
const SAME_MM: f64 = 5e-4;

/// Adds the lines; `other_gear`: a program cuts another gear than the one that they are of.
pub fn print(sheet: &mut Sheet, job: &ShapingJob, facts: &[ToothFacts], other_gear: bool) {
    let cutter = &job.cutter;
    sheet.details(|sheet| {
        sheet.heading("Cutter");
        sheet.line("teeth", cutter.teeth.to_string());
        let [pitch_mm, tip_mm] = [cutter.pitch_radius_mm, cutter.tip_radius_mm];
        let radii = match &cutter.tooth {
            CutterTooth::Involute(tooth) => {
                format!("pitch {pitch_mm:.3} mm, base {:.3} mm, tip {tip_mm:.3} mm", tooth.base_radius_mm)
            }
            CutterTooth::Drawn(_) => {
                format!("pitch {pitch_mm:.3} mm, root {:.3} mm, tip {tip_mm:.3} mm", cutter.root_radius_mm)
            }
        };
        sheet.line("radii", radii);
        if let Some(helix) = &job.helix {
            sheet.line("helical guide", format!("lead {:.3} mm, {}-hand", helix.lead_mm, helix.hand.name()));
        }
        if let CutterTooth::Drawn(tooth) = &cutter.tooth {
            sheet.line("tooth", drawn_words(tooth));
        }
    });
    sheet.heading(if other_gear { "Teeth by the scene's own strokes, not by the program" } else { "Teeth" });
    sheet.line("start of flank", range(facts, " over the pitch curve", |flank| flank.start_height_mm));
    sheet.details(|sheet| {
        sheet.line("end of flank", range(facts, " over the pitch curve", |flank| flank.tip_height_mm));
        sheet.line("length of profile", range(facts, "", |flank| flank.length_mm));
    });
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
    if facts.iter().flat_map(ToothFacts::flanks).any(|(_, flank)| flank.is_undercut()) {
        sheet.line("depth of undercut", range(facts, " below the flank", |flank| flank.undercut_mm));
    }
    sheet.line(
        "pointed teeth",
        list(facts.iter().filter(|tooth| tooth.is_pointed()).map(|tooth| tooth.tooth.to_string())),
    );
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
