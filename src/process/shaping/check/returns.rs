//! The return strokes, before anything is cut: room between the returning cutter and the work, the place where it is
//! least, and what to change.
//!
//! In: a prepared [`ShapingJob`]. Out: lines and warnings for each operation, from the survey of ideal strokes
//! ([`crate::process::shaping::returns::survey`]); the blank field of a run says what the strokes of the scene meet.

use crate::output::text::Sheet;
use crate::process::shaping::linkage::dynamics;
use crate::process::shaping::linkage::retraction::RetractionLaw;
use crate::process::shaping::returns::RetractionPlan;
use crate::process::shaping::returns::clearance::Clearance;
use crate::process::shaping::returns::motion::RetractionMotion;
use crate::process::shaping::returns::plan::{CLEAR_MM, no_pose};
use crate::process::shaping::returns::survey::{PlacedRoom, Survey, tightest};
use crate::process::shaping::scene::model::Retraction;
use crate::process::shaping::{PreparedOperation, ShapingJob};
use gearcut_core::error::Refusal;
use gearcut_core::units::UM_PER_MM;

/// Rows of the chart along the curve at most, and the width of its bars: full at the largest clearance.
const CHART_ROWS: usize = 24;
const CHART_WIDTH: f64 = 24.0;

/// Adds the lines; gives the warnings.
///
/// # Errors
/// A back-off so large that the retraction leads to no pose.
pub fn print(sheet: &mut Sheet, job: &ShapingJob) -> Result<Vec<String>, Refusal> {
    if job.machine.back_off_mm <= 0.0 {
        return Ok(vec!["machine.back_off_mm = 0: the cutter returns along the surfaces that it has cut".to_owned()]);
    }
    let mut warnings = Vec::new();
    for (index, operation) in job.operations.iter().enumerate() {
        let plan = &operation.retraction;
        let survey = job.survey(index);
        let rooms = survey.rooms(plan.back_off_mm(), |phi| plan.law(phi)).map_err(|_| no_pose(plan.back_off_mm()))?;
        sheet.heading(&format!("Return strokes of {}: {}", operation.spec.name, plan.asked().words()));
        angles(sheet, &rooms);
        warnings.extend(surface(sheet, operation, &survey, &rooms));
        stock(sheet, job, operation, &survey, &rooms);
        along(sheet, plan, &rooms[..survey.period_places()]);
    }
    Ok(warnings)
}

/// Angle between the line of centres and the normal along the curve.
fn angles(sheet: &mut Sheet, rooms: &[PlacedRoom]) {
    let Some(steepest) = rooms.iter().max_by(|a, b| a.from_normal_rad.abs().total_cmp(&b.from_normal_rad.abs())) else {
        return;
    };
    let most_rad = steepest.from_normal_rad.abs();
    let place = format!("{:.2} deg at polar angle {:.2} deg", most_rad.to_degrees(), steepest.phi_rad.to_degrees());
    sheet.line("retraction angle", format!("at most {place} (line of centres against the normal)"));
}

/// The chart along the curve, over the places after which it repeats: angle, law, clearance from what is left, depth in
/// stock.
fn along(sheet: &mut Sheet, plan: &RetractionPlan, period: &[PlacedRoom]) {
    let widest_mm = period.iter().map(|room| room.clearance.surface_mm).filter(|mm| mm.is_finite()).fold(0.0, f64::max);
    let um = |mm: f64| if mm.is_finite() { format!("{:.1} um", UM_PER_MM * mm) } else { "-".to_owned() };
    let row = |room: &PlacedRoom| {
        let Clearance { surface_mm, material_mm } = room.clearance;
        let bar = if surface_mm.is_finite() && widest_mm > 0.0 {
            (CHART_WIDTH * (surface_mm / widest_mm).clamp(0.0, 1.0)).round() as usize
        } else {
            0
        };
        vec![
            format!("{:.2} deg", room.phi_rad.to_degrees()),
            format!("{:.2} deg", room.from_normal_rad.to_degrees()),
            if plan.law(room.phi_rad) == RetractionLaw::Turned { "turned".to_owned() } else { "-".to_owned() },
            um(surface_mm),
            um((-material_mm).max(0.0)),
            format!("|{:<width$}|", "#".repeat(bar), width = CHART_WIDTH as usize),
        ]
    };
    let heading = ["polar angle", "retraction angle", "cutter", "clearance", "in stock", "clearance"];
    let step = period.len().div_ceil(CHART_ROWS);
    let rows = period.iter().step_by(step).map(row);
    sheet.table(&std::iter::once(heading.map(str::to_owned).to_vec()).chain(rows).collect::<Vec<_>>());
}

/// Room to the surfaces that stay.
fn surface(sheet: &mut Sheet, operation: &PreparedOperation, survey: &Survey, rooms: &[PlacedRoom]) -> Option<String> {
    let name = &operation.spec.name;
    let least = tightest(rooms, |room| room.clearance.surface_mm)?;
    let (clearance_um, phi_deg) = (UM_PER_MM * least.clearance.surface_mm, least.phi_rad.to_degrees());
    sheet
        .line("smallest clearance", format!("{clearance_um:.1} um from what is left, at polar angle {phi_deg:.2} deg"));
    if least.clearance.surface_mm >= CLEAR_MM {
        return None;
    }
    if clearance_um >= 0.0 {
        return Some(format!(
            "operation {name}: the returning cutter clears the teeth near polar angle {phi_deg:.2} deg by \
             {clearance_um:.2} um only: set a larger machine.back_off_mm, or machine.retraction = \"auto\""
        ));
    }
    let overlap_mm2 = survey.overlap_mm2(least);
    let way_out = match operation.retraction.asked() {
        Retraction::CenterLine => "set machine.retraction = \"auto\", which turns the cutter there",
        Retraction::Tilted => "set machine.retraction = \"turned\", or leave less stock to this operation",
        Retraction::Normal | Retraction::Turned | Retraction::Auto => "set another machine.back_off_mm",
    };
    Some(format!(
        "operation {name}: the returning cutter stands {:.1} um deep in the teeth near polar angle {phi_deg:.2} deg, \
         over {overlap_mm2:.4} mm2 of their section: {way_out}",
        -clearance_um
    ))
}

/// Room to all material, stock included. That return strokes rub on stock is ordinary and costs the edge, not the gear:
/// a line, and no warning.
fn stock(sheet: &mut Sheet, job: &ShapingJob, operation: &PreparedOperation, survey: &Survey, rooms: &[PlacedRoom]) {
    let Some(least) = tightest(rooms, |room| room.clearance.material_mm) else { return };
    let (depth_mm, phi_deg) = (-least.clearance.material_mm, least.phi_rad.to_degrees());
    if depth_mm < CLEAR_MM {
        sheet.line("stock", "clear of all material");
        return;
    }
    let way_out = match operation.retraction.asked() {
        Retraction::Tilted => "leave less of it to this operation".to_owned(),
        _ => offer(job, operation, survey),
    };
    sheet.line("stock", format!("rubs up to {depth_mm:.3} mm deep on it, at polar angle {phi_deg:.2} deg; {way_out}"));
}

/// The direction that clears stock, and what it costs in stroke time.
fn offer(job: &ShapingJob, operation: &PreparedOperation, survey: &Survey) -> String {
    let Some([low_rad, high_rad]) = survey.tilts().filter(|[low, high]| low < high) else {
        return "no direction clears all of it: leave less of it to this operation".to_owned();
    };
    let plan = RetractionPlan::tilted(job.machine.back_off_mm, [low_rad, high_rad]);
    let limits = dynamics::limits(&job.machine.limits);
    let motion = RetractionMotion::new(&operation.schedule, &plan, &job.ram_times(), &limits);
    let cost = match motion.and_then(|motion| motion.slowdown()) {
        None => "machine.limits does not say at what cost in time".to_owned(),
        Some(factor) if !factor.is_finite() => "approach and overrun leave the axes no time".to_owned(),
        Some(factor) if factor > 1.0 => format!(
            "double strokes then last {factor:.2} times as long, at most {:.0} per minute",
            job.machine.double_strokes_per_minute / factor
        ),
        Some(_) => "it costs no time".to_owned(),
    };
    let tilt_deg = 0.5 * (low_rad + high_rad).to_degrees();
    format!("machine.retraction = \"tilted\" draws the edge away from it, {tilt_deg:.1} deg out of the normal: {cost}")
}
