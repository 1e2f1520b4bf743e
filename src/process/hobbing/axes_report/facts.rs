//! What a gear engineer reads on the terminal about feeds, travel, times and marks of an operation.

use super::HobbingAxesReport;
use crate::number_text::{from_full_depth, significant};
use crate::output::text::Sheet;
use crate::process::hobbing::job::PreparedHobbing;
use crate::process::hobbing::scene::model::HobbingKind;
use crate::progress::duration_text;
use crate::steps::axes::AxesOfOperation;
use gearcut_core::units::{TURN_RAD, UM_PER_MM};

/// Feeds, travel, times, marks.
pub(super) fn print(axes: &HobbingAxesReport, sheet: &mut Sheet) {
    let (job, operation) = (axes.job, axes.operation());
    let PreparedHobbing { spec, plan, linkage, .. } = operation;
    sheet.heading(&format!("Operation {}: {}, {}", spec.name, axes.linkage_words(), from_full_depth(spec.offset_mm)));
    if let Some(program) = &operation.program {
        let knots = program.knots.len();
        sheet.line("program", format!("{knots} positions are cut; tables, charts and peaks are the scene's own"));
    }
    let hob_speed = spec.hob_speed_rad_per_s / TURN_RAD * 60.0;
    sheet.line("hob speed", format!("{} 1/min, mean of a cycle", significant(hob_speed, 5)));
    let tilt_rad = linkage.geometry().head_angle_rad;
    sheet.line("head angle", format!("{:.4} deg", tilt_rad.to_degrees()));
    let [first, second] = plan.slide_feeds_mm;
    let feeds = if (first - second).abs() < 1e-9 {
        significant(first, 4)
    } else {
        format!("{} and, the shift reversed, {}", significant(first, 4), significant(second, 4))
    };
    sheet.line("feed of the slide", format!("{feeds} mm per revolution of the work"));
    let (approach, face, overrun) = (plan.approach_mm, job.scene.gear.face_width_mm, plan.overrun_mm);
    sheet.line(
        "travel of the slide",
        format!("{approach:.3} mm before the face, {face:.3} across, {overrun:.3} beyond"),
    );
    if let HobbingKind::Diagonal { shift_mm_per_revolution, .. } = spec.kind {
        let [from, to] = plan.shift_range_mm;
        let strokes = match plan.shift_strokes {
            1 => "one stroke".to_owned(),
            more => format!("{more} strokes"),
        };
        sheet.line(
            "shift",
            format!(
                "{} mm per revolution between {from:.3} and {to:.3} mm, {strokes}; {} mm of it along the gear's axis",
                significant(shift_mm_per_revolution, 4),
                significant(shift_mm_per_revolution * tilt_rad.sin().abs(), 3)
            ),
        );
    }
    let idle = if plan.idle_s > 0.0 { format!(", {} of it idle", duration_text(plan.idle_s)) } else { String::new() };
    let cycles = linkage.end_s() / linkage.cycle_s();
    sheet.line("time", format!("{}{idle}; {cycles:.2} cycles along the pitch curve", duration_text(linkage.end_s())));
    sheet.line("passes", format!("{:.0} of hob teeth", job.passes(operation)));
    if let Some(feed_mark_mm) = job.feed_mark_mm(operation) {
        sheet.line("feed marks", format!("up to {} um high", significant(UM_PER_MM * feed_mark_mm, 3)));
    } else {
        sheet.line("marks", "of a drawn tooth are found by the cut alone");
    }
    let facts = job.curve.facts();
    let marks = [facts.smallest_curvature, facts.largest_curvature]
        .map(|extremum| job.generating_mark_mm(extremum.curvature_per_mm).map(|mm| significant(UM_PER_MM * mm, 3)));
    let [Some(flat), Some(sharp)] = marks else { return };
    sheet.line(
        "generating marks",
        format!(
            "{flat} um where the curve is flattest, {sharp} um where it is sharpest, one every {:.4} mm of arc",
            job.gash_arc_mm()
        ),
    );
}
