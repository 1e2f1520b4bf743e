//! What the cut will cost: dexels, records, evaluations, rays through the blank, memory, time.
//!
//! Dexels follow from the lengths of all profiles and the spacing. Records and evaluations are planned for a few flanks
//! spread over the gear, exactly as the cut would plan them, and scaled to all flanks by their dexels. Time is the sum
//! of the parts at rates measured on one processor, named with the result.

use crate::output::progress::duration_text;
use crate::output::text::{Sheet, plain, significant};
use crate::scene::model::Fields;
use gearcut_core::dexel::BlankGrid;

/// Processor on whose cores the rates were measured.
pub const PROCESSOR: &str = "an AMD EPYC (Zen 5, AVX-512)";
/// Flanks that are planned: left and right in turn, and a number that seldom divides the periods of a curve.
pub const PLANNED_FLANKS: usize = 9;
/// Bytes per dexel and surface: height and pass id.
pub const BYTES_PER_DEXEL: usize = 8;

/// The flanks' part.
pub struct FlankCost {
    /// Number of flanks.
    pub flanks: usize,
    /// Dexels of the largest flank.
    pub largest: f64,
    /// Of all flanks.
    pub dexels: f64,
    /// Dexels against passes, all of them.
    pub evaluations: f64,
    /// Per dexel that is cut and operation.
    pub per_dexel: f64,
    /// Records of passes in tiles.
    pub records: f64,
    /// What else there is to say about the evaluations.
    pub note: &'static str,
    /// At one time on all cores.
    pub bytes: f64,
    /// On one core.
    pub seconds: f64,
}

/// The whole blank's part, chips included.
pub struct BlankCost {
    /// Where the rays are.
    pub grid: BlankGrid,
    /// What crosses what, in words.
    pub crossings: String,
    /// Memory at one time.
    pub bytes: f64,
    /// On one core.
    pub seconds: f64,
}

/// Prints the cost of a cut.
pub fn print(sheet: &mut Sheet, fields: &Fields, flanks: &FlankCost, blank: &BlankCost) {
    let cores = rayon::current_num_threads();
    sheet.heading("Cost of the cut (nothing has been cut)");
    sheet.line(
        "flank fields",
        format!(
            "{} of at most {:.2} million dexels, {} by {} um; {:.1} million in all",
            flanks.flanks,
            1e-6 * flanks.largest,
            plain(1e3 * fields.profile_spacing_mm),
            plain(1e3 * fields.lead_spacing_mm),
            1e-6 * flanks.dexels
        ),
    );
    sheet.line(
        "evaluations",
        format!(
            "{} million dexels against passes, {:.1} per dexel and operation, from {} thousand records{}",
            significant(1e-6 * flanks.evaluations, 3),
            flanks.per_dexel,
            (1e-3 * flanks.records).round(),
            flanks.note
        ),
    );
    let rays: usize = blank.grid.rows.iter().map(|row| row.count).sum();
    let sections = blank.grid.slices_z_mm.len();
    sheet.line(
        "whole blank",
        format!(
            "{} rays {} mm apart in {sections} sections; {}; {:.0} MB",
            rays * sections,
            plain(fields.blank_spacing_mm),
            blank.crossings,
            1e-6 * blank.bytes
        ),
    );
    sheet.line("memory", format!("{:.0} MB: one flank at a time on each of {cores} threads", 1e-6 * flanks.bytes));
    let seconds = |of_one_core: f64| of_one_core / cores as f64;
    sheet.line(
        "time",
        format!(
            "{} on {cores} threads of {PROCESSOR}, {} of it for blank and chips; files come on top",
            duration_text(seconds(flanks.seconds + blank.seconds)),
            duration_text(seconds(blank.seconds))
        ),
    );
}
