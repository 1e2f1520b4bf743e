//! What the cutter can do in a ring, on the terminal: the answers, and charts along the curve.

use super::along::{self, bars, largest, values};
use crate::findings::Section;
use crate::output::summary;
use crate::output::text::Sheet;
use crate::process::shaping::findings::answers;

/// Adds the lines.
pub fn print(sheet: &mut Sheet, ring: &Section, addendum_mm: f64) {
    sheet.heading(&ring.title);
    if let Some(why) = ring.entries.first().and_then(|entry| entry.quantity.why()) {
        summary::line(sheet, "not known", why);
        return;
    }
    answers::print(sheet, ring);
    let Some(table) = ring.table_of("teeth") else { return };
    let place = || [values("tooth", "tooth", 0), values("phi", "polar angle", 2)];
    sheet.heading("Along the curve: largest cutter, radius of curvature, limit of the module");
    let rolling = [
        values("radius_of_curvature", "radius of curvature", 2),
        values("rolling_teeth", "cutter rolls to", 0),
        values("rolling_module", "module to", 2),
        bars("rolling_share", "share of the limit", 1, 100.0),
    ];
    along::print(sheet, table, &place().into_iter().chain(rolling).collect::<Vec<_>>());
    sheet.heading("Along the curve: undercut");
    let undercut = [
        values("start_left", "left flank from", 3),
        values("start_right", "right flank from", 3),
        values("printed_module", "printed limit of the module", 2),
        bars("printed_undercut", "printed condition, share", 1, 100.0),
    ];
    along::print(sheet, table, &place().into_iter().chain(undercut).collect::<Vec<_>>());
    sheet.heading("Along the curve: what the involute reaches, and how far the base sets the tip back");
    let deepest_um = largest(table, &["tip_relief_left", "tip_relief_right"]);
    let tips = [
        bars("involute_left", "left to", 3, addendum_mm),
        values("involute_right", "right to", 3),
        bars("tip_relief_left", "left set back", 2, deepest_um),
        values("tip_relief_right", "right set back", 2),
    ];
    along::print(sheet, table, &place().into_iter().chain(tips).collect::<Vec<_>>());
    sheet.heading("Along the curve: room of the tip corners in the space after the tooth, negative where they cut");
    let widest_mm = largest(table, &["corners_in", "corners_out"]);
    let corners =
        [bars("corners_in", "on the way in", 3, widest_mm), bars("corners_out", "on the way out", 3, widest_mm)];
    along::print(sheet, table, &place().into_iter().chain(corners).collect::<Vec<_>>());
}
