//! What a gear engineer reads about the axes on the terminal.

use super::{OperationAxes, in_order, linkage_words};
use crate::output::progress::duration_text;
use crate::output::text::{Sheet, plain, significant};
use crate::process::shaping::linkage::relief::ReliefFlank;
use crate::units::UM_PER_MM;

/// Names and units of the peaks in their order.
const PEAKS: [(&str, &str); 6] = [
    ("work spindle speed", "deg/s"),
    ("work spindle acceleration", "deg/s^2"),
    ("cutter spindle speed", "deg/s"),
    ("cutter spindle acceleration", "deg/s^2"),
    ("centre distance speed", "mm/s"),
    ("centre distance acceleration", "mm/s^2"),
];

/// A smaller beta than this, rad, is rounding: the curve is a circle.
const ROUND_BETA_RAD: f64 = 1e-9;

impl OperationAxes {
    /// Strokes, time, relief and the table of peaks.
    pub fn print(&self, sheet: &mut Sheet) {
        let operation = &self.operation;
        let offset = plain(operation.offset_mm);
        sheet.heading(&format!(
            "Operation {}: {}, offset {offset} mm",
            operation.name,
            linkage_words(operation.linkage)
        ));
        let plunging = match self.plunging_strokes {
            0 => String::new(),
            count => format!(", {count} of them plunging"),
        };
        sheet.line("strokes", format!("{}{plunging}; {} per turn", self.strokes, self.strokes_per_revolution));
        let feed = significant(self.circular_feed_mm_per_stroke, 3);
        sheet.line("circular feed", format!("{feed} mm per double stroke, mean over the pitch curve"));
        sheet.line("time", duration_text(self.cycle_time_s));
        let round = self.largest_beta_rad < ROUND_BETA_RAD;
        let beta_place = if round {
            "everywhere".to_owned()
        } else {
            format!("at polar angle {:.2} deg", self.largest_beta_phi_rad.to_degrees())
        };
        sheet.line(
            "largest beta",
            format!("{:.2} deg {beta_place} (line of centres against the normal)", self.largest_beta_rad.to_degrees()),
        );
        let flank = match self.relief.flank {
            ReliefFlank::Left => "left",
            ReliefFlank::Right => "right",
        };
        let relief_place = if round {
            "everywhere".to_owned()
        } else {
            format!("on the {flank} flank at polar angle {:.2} deg", self.relief.phi_rad.to_degrees())
        };
        sheet.line(
            "smallest relief",
            format!(
                "{} um for {} mm back-off {relief_place}, {:.0} % of a circular gear's",
                significant(UM_PER_MM * self.relief.clearance_mm(self.back_off_mm), 3),
                plain(self.back_off_mm),
                100.0 * self.relief.ratio,
            ),
        );
        sheet.table(&self.peak_rows());
    }

    fn peak_rows(&self) -> Vec<Vec<String>> {
        let titles = ["axis", "largest", "at work angle", "limit", "left"].map(str::to_owned).to_vec();
        let peaks = in_order(&self.peaks).into_iter().zip(self.peaks_at_rad).zip(PEAKS);
        let rows = peaks.map(|((peak, at_rad), (name, unit))| {
            let text = |value: f64| {
                let shown = if unit.starts_with("deg") { value.to_degrees() } else { value };
                // What is only rounding of a standing axis reads as zero.
                let shown = if shown.abs() < 1e-9 { 0.0 } else { shown };
                format!("{} {unit}", significant(shown, 4))
            };
            let limit = peak.limit.map_or_else(|| "not given".to_owned(), text);
            let left = peak.margin().map_or_else(String::new, |share| format!("{:.0} %", 100.0 * share));
            vec![name.to_owned(), text(peak.value), format!("{:.2} deg", at_rad.to_degrees()), limit, left]
        });
        [titles].into_iter().chain(rows).collect()
    }

    /// What the user should know before cutting: limits exceeded, little or no relief.
    pub fn warnings(&self) -> Vec<String> {
        let name = &self.operation.name;
        let exceeded = in_order(&self.peaks).into_iter().zip(PEAKS).filter_map(|(peak, (axis, unit))| {
            let limit = peak.limit.filter(|limit| peak.value > *limit)?;
            let text = |value: f64| significant(if unit.starts_with("deg") { value.to_degrees() } else { value }, 4);
            Some(format!(
                "operation {name}: the {axis} reaches {} {unit}, the machine allows {} {unit}: take more strokes per \
                 revolution or fewer double strokes per minute",
                text(peak.value),
                text(limit)
            ))
        });
        let relief = self.relief.warning(self.back_off_mm).map(|text| format!("operation {name}: {text}"));
        exceeded.chain(relief).collect()
    }
}
