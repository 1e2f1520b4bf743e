//! The return strokes, before anything is cut: room between the returning cutter and the work, the place where it is
//! least, and what to change.
//!
//! In: a prepared [`ShapingJob`]. Out: lines and warnings for each operation, from the survey of ideal strokes
//! ([`crate::process::shaping::returns::survey`]); the blank field of a run says what the strokes of the scene meet.

use crate::output::text::Sheet;
use crate::process::shaping::returns::plan::CLEAR_MM;
use crate::process::shaping::returns::survey::{PlacedRoom, tightest};
use crate::process::shaping::scene::model::Retraction;
use crate::process::shaping::{PreparedOperation, ShapingJob};
use crate::units::UM_PER_MM;

/// Rows of the chart of the retraction angle, and the width of its bars.
const CHART_ROWS: usize = 24;
const CHART_WIDTH: f64 = 24.0;

/// Adds the lines; gives the warnings.
pub fn print(sheet: &mut Sheet, job: &ShapingJob) -> Vec<String> {
    if job.machine.back_off_mm <= 0.0 {
        return vec!["machine.back_off_mm = 0: the cutter returns through the surfaces that it has cut".to_owned()];
    }
    let mut warnings = Vec::new();
    for (index, operation) in job.operations.iter().enumerate() {
        let plan = &operation.retraction;
        let Ok(rooms) = job.survey(index).rooms(plan.back_off_mm(), |phi| plan.law(phi)) else {
            continue;
        };
        sheet.heading(&format!("Return strokes of {}: {}", operation.spec.name, plan.asked().words()));
        angles(sheet, &rooms);
        surface(sheet, operation, &rooms, &mut warnings);
        stock(sheet, operation, &rooms, &mut warnings);
    }
    warnings
}

/// Angle between the line of centres and the normal along the curve.
fn angles(sheet: &mut Sheet, rooms: &[PlacedRoom]) {
    let Some(steepest) = rooms.iter().max_by(|a, b| a.from_normal_rad.abs().total_cmp(&b.from_normal_rad.abs())) else {
        return;
    };
    let most_rad = steepest.from_normal_rad.abs();
    let place = format!("{:.2} deg at polar angle {:.2} deg", most_rad.to_degrees(), steepest.phi_rad.to_degrees());
    sheet.line("retraction angle", format!("at most {place} (line of centres against the normal)"));
    if most_rad < 1e-6 {
        return;
    }
    let rows = (0..CHART_ROWS).map(|row| {
        let room = &rooms[row * rooms.len() / CHART_ROWS];
        let bar = (CHART_WIDTH * room.from_normal_rad.abs() / most_rad).round() as usize;
        let [left, right] = if room.from_normal_rad < 0.0 { [bar, 0] } else { [0, bar] };
        let width = CHART_WIDTH as usize;
        vec![
            format!("{:.0} deg", room.phi_rad.to_degrees()),
            format!("{:.2} deg", room.from_normal_rad.to_degrees()),
            format!("{}{}|{}", " ".repeat(width - left), "#".repeat(left), "#".repeat(right)),
        ]
    });
    sheet.table(&rows.collect::<Vec<_>>());
}

fn surface(sheet: &mut Sheet, operation: &PreparedOperation, rooms: &[PlacedRoom], warnings: &mut Vec<String>) {
    let name = &operation.spec.name;
    let Some(least) = tightest(rooms, |room| room.clearance.surface.smallest_mm) else { return };
    let (clearance_um, phi_deg) = (UM_PER_MM * least.clearance.surface.smallest_mm, least.phi_rad.to_degrees());
    sheet.line("smallest clearance", format!("{clearance_um:.1} um from what is left, at polar angle {phi_deg:.2} deg"));
    if least.clearance.surface.smallest_mm >= CLEAR_MM {
        return;
    }
    let overlap = tightest(rooms, |room| -room.clearance.surface.overlap_mm2);
    let overlap_mm2 = overlap.map_or(0.0, |room| room.clearance.surface.overlap_mm2);
    let way_out = match operation.retraction.asked() {
        Retraction::CenterLine => "set machine.retraction = \"auto\", which turns the cutter there",
        Retraction::Tilted => "set machine.retraction = \"turned\", or leave less stock to this operation",
        Retraction::Normal | Retraction::Turned | Retraction::Auto => "set another machine.back_off_mm",
    };
    warnings.push(format!(
        "operation {name}: the returning cutter stands {:.1} um deep in the teeth near polar angle {phi_deg:.2} deg, over \
         up to {overlap_mm2:.4} mm2 of their section: {way_out}",
        -clearance_um
    ));
}

fn stock(sheet: &mut Sheet, operation: &PreparedOperation, rooms: &[PlacedRoom], warnings: &mut Vec<String>) {
    let name = &operation.spec.name;
    let Some(least) = tightest(rooms, |room| room.clearance.material.smallest_mm) else { return };
    let (depth_mm, phi_deg) = (-least.clearance.material.smallest_mm, least.phi_rad.to_degrees());
    if depth_mm < CLEAR_MM {
        sheet.line("stock", "clear of all material");
        return;
    }
    sheet.line("stock", format!("rubs up to {depth_mm:.3} mm deep on stock that later strokes take, at {phi_deg:.2} deg"));
    if operation.retraction.asked() != Retraction::Tilted {
        warnings.push(format!(
            "operation {name}: the returning cutter rubs up to {depth_mm:.3} mm deep on stock near polar angle \
             {phi_deg:.2} deg, which wears its edge: set machine.retraction = \"tilted\", which draws it away from there"
        ));
    }
}
