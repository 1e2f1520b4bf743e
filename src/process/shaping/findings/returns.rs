//! The return strokes of an operation before anything is cut, as findings: the angle of the retraction, the room to the
//! teeth and to stock, and what to change.
//!
//! In: [`ReturnFacts`]. Out: a section for each operation, with a row for every place of a period in
//! `tables/returns_<operation>.csv`; its warning.

use super::answers::answered;
use crate::findings::{Datum, Notice, Place, Quantity, Section, Table, TableColumn};
use crate::process::shaping::linkage::retraction::RetractionLaw;
use crate::process::shaping::notices::{ReturnEnters, ReturnTight};
use crate::process::shaping::returns::facts::{Offer, ReturnFacts, TiltCost};
use crate::process::shaping::returns::plan::CLEAR_MM;
use crate::process::shaping::returns::survey::PlacedRoom;
use crate::process::shaping::scene::model::Retraction;
use crate::process::shaping::{PreparedOperation, ShapingJob};
use gearcut_core::error::Refusal;
use gearcut_core::units::UM_PER_MM;

/// Why there is no clearance.
const NOWHERE_NEAR: &str = "the edge is outside the uncut blank on its way back";
/// Why there is no direction to offer.
const NO_OFFER: &str = "none is needed, none clears all of it, or the cutter is tilted already";
/// Why there is no cost.
const NO_COST: &str = "no direction is offered, or machine.limits does not say what the axes can do";

/// Entry that holds of the scene whatever is cut.
const DIRECTION: &str = "direction";

/// The section of an operation; none where the cutter is not drawn back. Where a program cuts other strokes, `other`
/// says why nothing of it holds.
///
/// # Errors
/// A back-off so large that the retraction leads to no pose.
pub fn section(job: &ShapingJob, index: usize, other: Option<&str>) -> Result<Option<Section>, Refusal> {
    let operation = &job.operations[index];
    let Some(facts) = job.return_facts(index)? else { return Ok(None) };
    let asked = operation.retraction.asked();
    let words = Quantity::text(asked.words(), "which way the cutter is drawn back");
    let section = Section::new("return_strokes", "Return strokes").with(DIRECTION, words);
    let section = angle(section, facts, asked, job.scene.gear.pressure_angle_rad);
    let section = surface(section, facts, asked);
    let section = stock(section, operation.schedule.double_strokes_per_minute(), facts);
    let section = section.table(table(operation, facts));
    Ok(Some(match other {
        Some(why) => section.without_values(why, &[DIRECTION]),
        None => section,
    }))
}

fn at(room: &PlacedRoom) -> Place {
    Place::default().and("polar_angle_deg", room.phi_rad.to_degrees())
}

/// Between the line of centres and the normal.
fn angle(section: Section, facts: &ReturnFacts, asked: Retraction, pressure_angle_rad: f64) -> Section {
    let most_rad = facts.steepest.from_normal_rad.abs();
    let definition = "largest angle between the line of centres and the normal of the pitch curve";
    let angle = Quantity::number(most_rad.to_degrees(), "deg", definition).at(at(&facts.steepest));
    let limit = format!("the {:.1} deg of the pressure angle", pressure_angle_rad.to_degrees());
    let advice = if most_rad < pressure_angle_rad {
        format!("nothing: it is below {limit}, at which a cutter drawn along the line of centres slides on a flank")
    } else {
        let way_out = match asked {
            Retraction::CenterLine => "machine.retraction = \"auto\" turns the cutter there".to_owned(),
            other => format!("here it is drawn back {}", other.words()),
        };
        format!("beyond {limit}, a cutter drawn along the line of centres enters a flank: {way_out}")
    };
    answered(section, "retraction_angle", "retraction angle", angle, advice)
}

/// Room to the surfaces that stay.
fn surface(section: Section, facts: &ReturnFacts, asked: Retraction) -> Section {
    let definition =
        "smallest distance of the returning edge from the surfaces that the operation leaves, negative inside";
    let clearance = facts.surface.map(|room| UM_PER_MM * room.clearance.surface_mm);
    let clearance = Quantity::number_or(clearance, "um", definition, NOWHERE_NEAR);
    let clearance = match &facts.surface {
        Some(room) => clearance.at(at(room)),
        None => clearance,
    };
    let advice = match facts.surface.map(|room| room.clearance.surface_mm) {
        Some(mm) if mm < 0.0 => match asked {
            Retraction::CenterLine => "set machine.retraction = \"auto\", which turns the cutter there",
            Retraction::Tilted => "set machine.retraction = \"turned\", or leave less stock to this operation",
            Retraction::Normal | Retraction::Turned | Retraction::Auto => "set another machine.back_off_mm",
        },
        Some(mm) if mm < CLEAR_MM => "set a larger machine.back_off_mm, or machine.retraction = \"auto\"",
        _ => "nothing: the returning cutter clears the teeth",
    };
    let common = "area that the returning cutter has in common with the teeth where it lies deepest in them, in their \
                  transverse section; elsewhere it may lie less deep and have more in common";
    let overlap = Quantity::number(facts.overlap_mm2, "mm^2", common);
    let overlap = match &facts.surface {
        Some(room) => overlap.at(at(room)),
        None => overlap,
    };
    answered(section, "smallest_clearance", "smallest clearance", clearance, advice).with("overlap", overlap)
}

/// Room to all material, stock included. That return strokes rub on stock is ordinary and costs the edge, not the gear:
/// no warning comes of it.
fn stock(section: Section, run_per_minute: f64, facts: &ReturnFacts) -> Section {
    let definition = "largest depth of the returning edge in material, stock included; 0 where it is clear";
    let depth_mm = facts.material.map_or(0.0, |room| -room.clearance.material_mm);
    let depth = Quantity::number(if depth_mm < CLEAR_MM { 0.0 } else { depth_mm }, "mm", definition);
    let depth = match &facts.material {
        Some(room) if depth_mm >= CLEAR_MM => depth.at(at(room)),
        _ => depth,
    };
    let (tilts_rad, slowdown, advice) = match facts.offer {
        Offer::NotNeeded => (None, None, "nothing: clear of all material".to_owned()),
        Offer::Nothing => (None, None, "no direction clears all of it: leave less of it to this operation".to_owned()),
        Offer::Tilt { tilts_rad, cost } => {
            let slowdown = match cost {
                TiltCost::Slowdown(factor) => Some(factor),
                TiltCost::Unknown | TiltCost::NoTime => None,
            };
            (Some(tilts_rad), slowdown, tilt_words(run_per_minute, tilts_rad, cost))
        }
    };
    let deg = |pick: fn([f64; 2]) -> f64, definition: &'static str| {
        Quantity::number_or(tilts_rad.map(|tilts| pick(tilts).to_degrees()), "deg", definition, NO_OFFER)
    };
    let per_minute = slowdown.map(|factor| run_per_minute / factor);
    let last = "factor by which double strokes would have to last longer with that direction";
    answered(section, "depth_in_stock", "rubs on stock", depth, advice)
        .with(
            "clearing_tilt",
            deg(|of| 0.5 * (of[0] + of[1]), "direction that clears all material, from the normal of the pitch curve"),
        )
        .with("smallest_clearing_tilt", deg(|of| of[0], "smallest such angle"))
        .with("largest_clearing_tilt", deg(|of| of[1], "largest such angle"))
        .with("clearing_slowdown", Quantity::number_or(slowdown, "1", last, NO_COST))
        .with(
            "clearing_strokes_per_minute",
            Quantity::number_or(per_minute, "1/min", "double strokes that then leave the axes their time", NO_COST),
        )
}

/// The direction that clears stock, and what it costs in stroke time.
fn tilt_words(per_minute: f64, tilts_rad: [f64; 2], cost: TiltCost) -> String {
    let cost = match cost {
        TiltCost::Unknown => "machine.limits does not say at what cost in time".to_owned(),
        TiltCost::NoTime => "approach and overrun leave the axes no time".to_owned(),
        TiltCost::Slowdown(factor) if factor > 1.0 => {
            format!("double strokes then last {factor:.2} times as long, at most {:.0} per minute", per_minute / factor)
        }
        TiltCost::Slowdown(_) => "it costs no time".to_owned(),
    };
    let tilt_deg = 0.5 * (tilts_rad[0] + tilts_rad[1]).to_degrees();
    format!("machine.retraction = \"tilted\" draws the edge away from it, {tilt_deg:.1} deg out of the normal: {cost}")
}

/// What must be known before cutting.
pub fn warning(operation: &str, section: &Section) -> Option<Notice> {
    let clearance = section.quantity("smallest_clearance")?;
    let clearance_um = clearance.value().filter(|&um| um < UM_PER_MM * CLEAR_MM)?;
    let place = clearance.place().map(Place::words)?;
    let way_out = section.words("smallest_clearance_advice");
    Some(if clearance_um >= 0.0 {
        ReturnTight { operation, place, clearance_um: format!("{clearance_um:.2}"), way_out }.notice()
    } else {
        let overlap_mm2 = format!("{:.4}", section.number("overlap")?);
        let depth_um = format!("{:.1}", -clearance_um);
        ReturnEnters { operation, depth_um, place, overlap_mm2, way_out }.notice()
    })
}

fn table(operation: &PreparedOperation, facts: &ReturnFacts) -> Table {
    let columns = vec![
        TableColumn::new("phi", "deg", "polar angle of the pitch point at the stroke"),
        TableColumn::new(
            "retraction_angle",
            "deg",
            "angle from the normal of the pitch curve to the line of centres, positive where the radius grows with phi",
        ),
        TableColumn::words("cutter", "whether the cutter is turned on its way back"),
        TableColumn::new("clearance", "um", "distance of the edge from the surfaces that stay, negative inside")
            .or(NOWHERE_NEAR),
        TableColumn::new("depth_in_stock", "um", "depth of the edge in material, stock included"),
    ];
    let row = |room: &PlacedRoom| {
        let turned = operation.retraction.law(room.phi_rad) == RetractionLaw::Turned;
        vec![
            Datum::from(room.phi_rad.to_degrees()),
            room.from_normal_rad.to_degrees().into(),
            if turned { "turned" } else { "-" }.into(),
            (UM_PER_MM * room.clearance.surface_mm).into(),
            (UM_PER_MM * (-room.clearance.material_mm).max(0.0)).into(),
        ]
    };
    Table::new("places", "Return strokes over one period of the pitch curve", columns)
        .with_rows(facts.period.iter().map(row))
        .rows_in_file(&format!("returns_{}", operation.spec.name))
}
