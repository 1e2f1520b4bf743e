//! What the cutter can do in a ring, on the terminal: the answers, and charts along the curve.

use super::along::{self, bars, largest, values};
use crate::findings::Section;
use crate::findings::quantities::teeth::TOOTH;
use crate::output::summary;
use crate::output::text::Sheet;
use crate::process::shaping::findings::answers;
use crate::process::shaping::quantities::ring::{
    CORNERS_IN, CORNERS_OUT, INVOLUTE_LEFT, INVOLUTE_RIGHT, PHI, PRINTED_MODULE, PRINTED_UNDERCUT, RADIUS, RING_TEETH,
    ROLLING_MODULE, ROLLING_SHARE, ROLLING_TEETH_AT, START_LEFT, START_RIGHT, TIP_RELIEF_LEFT, TIP_RELIEF_RIGHT,
};

/// Adds the lines.
pub fn print(sheet: &mut Sheet, ring: &Section, addendum_mm: f64) {
    sheet.heading(&ring.title);
    if let Some(why) = ring.entries.first().and_then(|entry| entry.quantity.why()) {
        summary::line(sheet, "not known", why);
        return;
    }
    answers::print(sheet, ring);
    let Some(table) = ring.table_of(&RING_TEETH) else { return };
    let place = || [values(&TOOTH, "tooth", 0), values(&PHI, "polar angle", 2)];
    sheet.heading("Along the curve: largest cutter, radius of curvature, limit of the module");
    let rolling = [
        values(&RADIUS, "radius of curvature", 2),
        values(&ROLLING_TEETH_AT, "cutter rolls to", 0),
        values(&ROLLING_MODULE, "module to", 2),
        bars(&ROLLING_SHARE, "share of the limit", 1, 100.0),
    ];
    along::print(sheet, table, &place().into_iter().chain(rolling).collect::<Vec<_>>());
    sheet.heading("Along the curve: undercut");
    let undercut = [
        values(&START_LEFT, "left flank from", 3),
        values(&START_RIGHT, "right flank from", 3),
        values(&PRINTED_MODULE, "printed limit of the module", 2),
        bars(&PRINTED_UNDERCUT, "printed condition, share", 1, 100.0),
    ];
    along::print(sheet, table, &place().into_iter().chain(undercut).collect::<Vec<_>>());
    sheet.heading("Along the curve: what the involute reaches, and how far the base sets the tip back");
    let deepest_um = largest(table, &[&TIP_RELIEF_LEFT, &TIP_RELIEF_RIGHT]);
    let tips = [
        bars(&INVOLUTE_LEFT, "left to", 3, addendum_mm),
        values(&INVOLUTE_RIGHT, "right to", 3),
        bars(&TIP_RELIEF_LEFT, "left set back", 2, deepest_um),
        values(&TIP_RELIEF_RIGHT, "right set back", 2),
    ];
    along::print(sheet, table, &place().into_iter().chain(tips).collect::<Vec<_>>());
    sheet.heading("Along the curve: room of the tip corners in the space after the tooth, negative where they cut");
    let widest_mm = largest(table, &[&CORNERS_IN, &CORNERS_OUT]);
    let corners =
        [bars(&CORNERS_IN, "on the way in", 3, widest_mm), bars(&CORNERS_OUT, "on the way out", 3, widest_mm)];
    along::print(sheet, table, &place().into_iter().chain(corners).collect::<Vec<_>>());
}
