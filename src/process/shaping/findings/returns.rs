//! The return strokes of an operation before anything is cut, as findings: the angle of the retraction, the room to the
//! teeth and to stock, each with its advice.
//!
//! In: [`ReturnFacts`]. Out: a section for each operation, with a row for every place of a period in
//! `tables/returns_<operation>.csv`; its warning.

use crate::findings::{Entry, Notice, Place, Section, Table};
use crate::number_text::significant;
use crate::process::shaping::linkage::retraction::RetractionLaw;
use crate::process::shaping::motion::returns::facts::{Offer, ReturnFacts, TiltCost};
use crate::process::shaping::motion::returns::plan::CLEAR_MM;
use crate::process::shaping::motion::returns::survey::PlacedRoom;
use crate::process::shaping::notices::{ReturnEnters, ReturnTight};
use crate::process::shaping::quantities::returns::{
    ANGLE_AT, CLEARANCE, CLEARANCE_AT, CLEARING_SLOWDOWN, CLEARING_STROKES, CLEARING_TILT, CUTTER, DEPTH_AT,
    DEPTH_IN_STOCK, DIRECTION, LARGEST_CLEARING_TILT, NO_COST, NO_OFFER, NOWHERE_NEAR, OVERLAP, PHI, RETRACTION_ANGLE,
    RETURN_PLACES, RETURN_STROKES, SMALLEST_CLEARING_TILT,
};
use crate::process::shaping::scene::model::Retraction;
use crate::process::shaping::{PreparedOperation, ShapingJob};
use gearcut_core::error::Refusal;
use gearcut_core::units::UM_PER_MM;

/// Depths below this are rounding, um.
const LEAST_DEPTH_UM: f64 = 1e-3;

/// The section of an operation; none where the cutter is not drawn back. Where a program cuts other strokes, `other`
/// says why nothing of it holds.
///
/// # Errors
/// A back-off so large that the retraction leads to no pose.
pub fn section(job: &ShapingJob, index: usize, other: Option<&str>) -> Result<Option<Section>, Refusal> {
    let operation = &job.operations[index];
    let Some(facts) = job.return_facts(index)? else { return Ok(None) };
    let asked = operation.retraction.asked();
    let section = RETURN_STROKES
        .section([DIRECTION.of(asked.words()), angle(job, facts, asked)])
        .entries(surface(facts, asked))
        .entries(stock(operation.schedule.double_strokes_per_minute(), facts))
        .table(table(operation, facts));
    Ok(Some(match other {
        // The direction holds of the scene whatever is cut.
        Some(why) => section.without_values(why, &[&DIRECTION]),
        None => section,
    }))
}

fn at(room: &PlacedRoom) -> Place {
    Place::default().and("polar_angle_deg", room.phi_rad.to_degrees())
}

/// Between the line of centres and the normal.
fn angle(job: &ShapingJob, facts: &ReturnFacts, asked: Retraction) -> Entry {
    let (most_rad, pressure_angle_rad) = (facts.steepest.from_normal_rad.abs(), job.transverse.pressure_angle_rad);
    let limit = format!("the {:.1} deg of the pressure angle", pressure_angle_rad.to_degrees());
    let angle = RETRACTION_ANGLE.of(most_rad.to_degrees()).at(at(&facts.steepest));
    if job.cutter.drawn().is_some() {
        // Its flanks have angles of their own.
        return angle;
    }
    if most_rad < pressure_angle_rad {
        return angle
            .fine(format!("It is below {limit}, at which a cutter drawn along the line of centres slides on a flank"));
    }
    let beyond = format!("Beyond {limit}, a cutter drawn along the line of centres enters a flank");
    match asked {
        Retraction::CenterLine => angle.change(format!("{beyond}. machine.retraction = \"auto\" turns it there")),
        other => angle.fine(format!("{beyond}. This one is drawn back {}", other.words())),
    }
}

/// Room to the surfaces that stay.
fn surface(facts: &ReturnFacts, asked: Retraction) -> [Entry; 2] {
    let place = facts.surface.as_ref().map(at);
    let clearance_mm = facts.surface.as_ref().map(|room| room.clearance.surface_mm);
    let clearance = CLEARANCE.of_or(clearance_mm.map(|mm| UM_PER_MM * mm), NOWHERE_NEAR).at(place.clone());
    let clearance = match clearance_mm {
        Some(mm) if mm < 0.0 => clearance.change(match asked {
            Retraction::CenterLine => "Set machine.retraction = \"auto\", which turns the cutter there",
            Retraction::Tilted => "Set machine.retraction = \"turned\", or plan less stock for this operation",
            Retraction::Normal | Retraction::Turned | Retraction::Auto => "Set another machine.back_off_mm",
        }),
        Some(mm) if mm < CLEAR_MM => {
            clearance.change("Set a larger machine.back_off_mm, or machine.retraction = \"auto\"")
        }
        _ => clearance.fine("The returning cutter clears the teeth"),
    };
    [clearance, OVERLAP.of(facts.overlap_mm2).at(place)]
}

/// Room to all material, stock included. That return strokes rub on stock is ordinary and costs the edge, not the gear:
/// no warning comes of it.
fn stock(run_per_minute: f64, facts: &ReturnFacts) -> [Entry; 6] {
    let depth_mm = facts.material.map_or(0.0, |room| -room.clearance.material_mm);
    let is_deep = depth_mm >= CLEAR_MM;
    let place = facts.material.as_ref().filter(|_| is_deep).map(at);
    let depth = DEPTH_IN_STOCK.of(if is_deep { depth_mm } else { 0.0 }).at(place);
    let (tilts_rad, slowdown, depth) = match facts.offer {
        Offer::NotNeeded => (None, None, depth.fine("The returning cutter clears all material")),
        Offer::Nothing => {
            (None, None, depth.change("No direction clears all of it. Plan less stock for this operation"))
        }
        Offer::Tilt { tilts_rad, cost } => {
            let slowdown = match cost {
                TiltCost::Slowdown(factor) => Some(factor),
                TiltCost::Unknown | TiltCost::NoTime => None,
            };
            (Some(tilts_rad), slowdown, depth.change(tilt_words(run_per_minute, tilts_rad, cost)))
        }
    };
    let deg = |pick: fn([f64; 2]) -> f64| tilts_rad.map(|tilts| pick(tilts).to_degrees());
    [
        depth,
        CLEARING_TILT.of_or(deg(|of| 0.5 * (of[0] + of[1])), NO_OFFER),
        SMALLEST_CLEARING_TILT.of_or(deg(|of| of[0]), NO_OFFER),
        LARGEST_CLEARING_TILT.of_or(deg(|of| of[1]), NO_OFFER),
        CLEARING_SLOWDOWN.of_or(slowdown, NO_COST),
        CLEARING_STROKES.of_or(slowdown.map(|factor| run_per_minute / factor), NO_COST),
    ]
}

/// The direction that clears stock, and what it costs in stroke time.
fn tilt_words(per_minute: f64, tilts_rad: [f64; 2], cost: TiltCost) -> String {
    let cost = match cost {
        TiltCost::Unknown => "Its cost in time is known with machine.limits".to_owned(),
        TiltCost::NoTime => "Approach and overrun then give the axes no time".to_owned(),
        TiltCost::Slowdown(factor) if factor > 1.0 => {
            format!("Double strokes then last {factor:.2} times as long, at most {:.0} per minute", per_minute / factor)
        }
        TiltCost::Slowdown(_) => "It costs no time".to_owned(),
    };
    let tilt_deg = 0.5 * (tilts_rad[0] + tilts_rad[1]).to_degrees();
    format!("machine.retraction = \"tilted\" draws the edge away from it, {tilt_deg:.1} deg out of the normal. {cost}")
}

/// What must be known before cutting.
pub fn warning(operation: &str, section: &Section) -> Option<Notice> {
    let entry = section.entry_of(&CLEARANCE)?;
    let clearance = &entry.quantity;
    let clearance_um = clearance.value().filter(|&um| um < UM_PER_MM * CLEAR_MM)?;
    let place = clearance.place().map(Place::words)?;
    let way_out = entry.advice.as_ref()?.text.as_str();
    Some(if clearance_um > -LEAST_DEPTH_UM {
        ReturnTight { operation, place, clearance_um: significant(clearance_um.max(0.0), 3), way_out }.notice()
    } else {
        let overlap_mm2 = significant(section.value(&OVERLAP)?, 2);
        let depth_um = significant(-clearance_um, 3);
        ReturnEnters { operation, depth_um, place, overlap_mm2, way_out }.notice()
    })
}

fn table(operation: &PreparedOperation, facts: &ReturnFacts) -> Table {
    let is_turned = |room: &PlacedRoom| operation.retraction.law(room.phi_rad) == RetractionLaw::Turned;
    RETURN_PLACES
        .table(&facts.period)
        .column(&PHI, |room| room.phi_rad.to_degrees())
        .column(&ANGLE_AT, |room| room.from_normal_rad.to_degrees())
        .column(&CUTTER, |room| if is_turned(room) { "turned" } else { "-" })
        .column(&CLEARANCE_AT, |room| UM_PER_MM * room.clearance.surface_mm)
        .column(&DEPTH_AT, |room| UM_PER_MM * (-room.clearance.material_mm).max(0.0))
        .rows_in_file(&format!("returns_{}", operation.spec.name))
}
