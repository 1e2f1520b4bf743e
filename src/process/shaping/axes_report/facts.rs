//! What a gear engineer reads on the terminal about the strokes of an operation and their relief.

use super::OperationAxes;
use crate::number_text::{from_full_depth, plain, significant};
use crate::output::text::Sheet;
use crate::process::shaping::linkage::relief::ReliefFlank;
use crate::progress::duration_text;
use crate::steps::axes::AxesOfOperation;
use gearcut_core::units::UM_PER_MM;
use std::f64::consts::PI;

/// A smaller beta than this, rad, is rounding: the curve is a circle.
const ROUND_BETA_RAD: f64 = 1e-9;

/// Strokes, time, relief.
pub(super) fn print(axes: &OperationAxes, sheet: &mut Sheet) {
    let (operation, back_off_mm) = (axes.operation(), axes.job.machine.back_off_mm);
    let (name, offset, schedule) = (axes.name(), from_full_depth(operation.short_of_depth_mm), &operation.schedule);
    sheet.heading(&format!("Operation {name}: {}, {offset}", axes.linkage_words()));
    let shifted_mm = operation.spec.offset_mm - operation.short_of_depth_mm;
    if shifted_mm != 0.0 {
        let sign = if shifted_mm > 0.0 { "+" } else { "" };
        sheet.line(
            "depth as drawn",
            format!("at offset {sign}{} mm, by profile shifts and allowance", plain(shifted_mm)),
        );
    }
    let plunging = match schedule.plunge_count() {
        0 => String::new(),
        count => format!(", {count} of them plunging"),
    };
    let per_turn = schedule.strokes_per_revolution();
    sheet.line("strokes", format!("{}{plunging}; {per_turn} per turn", schedule.count()));
    if operation.program.is_some() {
        let scene = if axes.is_off_the_scene() { "; feed, beta and relief below are the scene's own" } else { "" };
        sheet.line(
            "program",
            format!("{} strokes; tables, charts and peaks are those of the program{scene}", operation.count()),
        );
    }
    let feed = significant(schedule.circular_feed_mm_per_stroke(), 3);
    sheet.details(|sheet| {
        sheet.line("circular feed", format!("{feed} mm per double stroke, mean over the pitch curve"));
    });
    let largest = axes.job.ram_speed_mm_per_s(axes.index) * 60.0 / 1e3;
    let [largest, mean] = [largest, 2.0 / PI * largest].map(|speed| significant(speed, 3));
    sheet.details(|sheet| {
        sheet.line("cutting speed", format!("{largest} m/min at most, {mean} m/min in the mean of a cutting stroke"));
    });
    sheet.line("time", duration_text(schedule.time_s(schedule.count() as f64)));
    let ([beta_rad, beta_phi_rad], relief) = (axes.largest_beta_rad(), axes.relief());
    let round = beta_rad < ROUND_BETA_RAD;
    let beta_place =
        if round { "everywhere".to_owned() } else { format!("at polar angle {:.2} deg", beta_phi_rad.to_degrees()) };
    let beta_deg = beta_rad.to_degrees();
    sheet.details(|sheet| {
        sheet.line("largest beta", format!("{beta_deg:.2} deg {beta_place} (line of centres against the normal)"));
    });
    let flank = match relief.flank {
        ReliefFlank::Left => "left",
        ReliefFlank::Right => "right",
    };
    let relief_place = if round {
        "everywhere".to_owned()
    } else {
        format!("on the {flank} flank at polar angle {:.2} deg", relief.phi_rad.to_degrees())
    };
    let reference = if round { "that where the pitch circles touch" } else { "a circular gear's" };
    sheet.line(
        "smallest relief",
        format!(
            "{} um to first order for {} mm back-off {relief_place}, {:.0} % of {reference}",
            significant(UM_PER_MM * relief.clearance_mm(back_off_mm), 3),
            plain(back_off_mm),
            100.0 * relief.ratio,
        ),
    );
}
