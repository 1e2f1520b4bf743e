//! What a gear costs the places of a shaper cutter's teeth ([`crate::measure::tool_wear`]).
//!
//! In: every tooth's chip in every stroke, from the ledger. Out: [`ToolWear`]; none where the scene does not say how
//! the cutter wears.
//!
//! A place of an edge that meets material cuts over the whole face: in every stroke its length of cut is the face width
//! along the helix, times the share of the place that is in contact. The speed is the largest of the ram in the stroke:
//! it is the same share of a stroke's speeds in all operations, whose strokes are equally long.

use crate::measure::tool_wear::{CutChip, GearCost, ToolWear};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::cut::chips::ChipLedger;
use crate::process::shaping::cut::chips::stroke::ToothChip;
use crate::process::shaping::tool::edge_polygon::EdgePolygon;

/// Wear over all operations.
pub fn measure(job: &ShapingJob, ledger: &ChipLedger) -> Option<ToolWear> {
    let speeds_mm_per_s: Vec<f64> = (0..job.operations.len()).map(|index| job.ram_speed_mm_per_s(index)).collect();
    let lengths_mm = EdgePolygon::wear_place_lengths_mm(&ledger.stations);
    let gear = &job.scene.gear;
    let cut_mm = gear.face_width_mm / gear.helix_angle_rad.cos();
    Some(ToolWear::new(job.wear?, *speeds_mm_per_s.last()?, |law| {
        let mut cost = GearCost::nothing(job.cutter_spec.teeth as usize);
        // A first stroke at full depth takes whole tooth spaces at once, as no machine would.
        let is_entry = |chip: &ToothChip| chip.stroke == 0 && ledger.operations[chip.operation].enters_at_depth;
        for chip in ledger.worn_by.iter().filter(|chip| !is_entry(chip)) {
            for (place, contact) in chip.edge.iter().enumerate().filter(|(_, contact)| contact.length_mm > 0.0) {
                let of = CutChip {
                    thickness_mm: contact.thick_mm2 / contact.length_mm,
                    speed_mm_per_s: speeds_mm_per_s[chip.operation],
                };
                let length_mm = cut_mm * contact.length_mm / lengths_mm[place];
                cost.add(law, [chip.blade as usize, place], length_mm, of);
            }
        }
        cost
    }))
}
