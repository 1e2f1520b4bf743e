//! What the cut will cost: dexels, records, evaluations, rays through the blank, memory, time.
//!
//! Dexels follow from the lengths of all profiles and the spacing. Records and evaluations are planned for a few flanks
//! spread over the gear, exactly as the cut would plan them, and scaled to all flanks by their dexels. Time is that of
//! the whole command: what `check` has done itself until then, work of which pieces were timed, and the other parts at
//! rates measured on one processor, times what some of this very work takes here
//! ([`super::computer_speed::ComputerSpeed`]).

use crate::output::progress::duration_text;
use crate::output::text::{Sheet, plain, significant};
use crate::scene::model::Fields;
use gearcut_core::dexel::BlankGrid;

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
    /// On one core of this machine.
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
    /// On one core of this machine.
    pub seconds: f64,
}

/// The time of the whole command.
#[derive(Debug, Clone, Copy)]
pub struct TimeCost {
    /// Flanks cut and measured, s of one core of this machine.
    pub flanks_s: f64,
    /// The whole blank and the chips.
    pub blank_s: f64,
    /// What comes before the first cut, is drawn and written, and texture.
    pub beside_s: f64,
}

impl TimeCost {
    /// Prints the line.
    pub fn print(&self, sheet: &mut Sheet) {
        let cores = rayon::current_num_threads();
        let seconds = |of_one_core: f64| duration_text(of_one_core / cores as f64);
        let whole_s = self.flanks_s + self.blank_s + self.beside_s;
        sheet.line(
            "time",
            format!(
                "some {} for all of it on {cores} threads of this machine: {} for flanks, {} for blank and chips, {} \
                 to prepare, draw and write",
                seconds(whole_s),
                seconds(self.flanks_s),
                seconds(self.blank_s),
                seconds(self.beside_s)
            ),
        );
    }
}

/// Prints the cost of a cut; `beside_s` is what else the command takes, on one core of this machine.
pub fn print(sheet: &mut Sheet, fields: &Fields, flanks: &FlankCost, blank: &BlankCost, beside_s: f64) {
    let cores = rayon::current_num_threads();
    sheet.heading("Cost of the cut (nothing has been cut)");
    sheet.details(|sheet| {
        sheet.line(
            "flank fields",
            format!(
                "{} of at most {:.2} million dexels, {} by {} um; {} million in all",
                flanks.flanks,
                1e-6 * flanks.largest,
                plain(1e3 * fields.profile_spacing_mm),
                plain(1e3 * fields.lead_spacing_mm),
                significant(1e-6 * flanks.dexels, 3)
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
    });
    TimeCost { flanks_s: flanks.seconds, blank_s: blank.seconds, beside_s }.print(sheet);
}
