//! Contact: ratio, where it begins and ends on the flanks, edges; and tip corners in the mate.

use super::{at_angle, at_moment, largest_at, tables};
use crate::findings::{Entry, QuantityRow, Section};
use crate::pair_job::corners::DeepestCorner;
use crate::pair_job::fit::SIDES;
use crate::pair_job::options::PairOptions;
use crate::pair_job::quantities::{
    CLEAR, CLEAR_OF_A, CLEAR_OF_B, CONTACT, DEEPEST_TIP, EDGE_LIFT, EDGE_SHARE, FEWEST_PAIRS, IN_A, IN_B, INSIDE,
    INTERFERENCE, LARGEST_CONTACT_RATIO, MEAN_CONTACT_RATIO, MEAN_PAIRS, NO_FILLETS, SMALLEST_CONTACT_RATIO,
    TIP_CLEARANCE,
};
use crate::pair_job::rolled::RolledPair;
use crate::pair_job::teeth::LEAST_LIFT_UM;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

pub(super) fn section(options: &PairOptions, rolled: &RolledPair) -> Section {
    let sides = (0..2).map(|side| side_section(options, rolled, side));
    CONTACT.section([]).parts(sides).table(tables::teeth(rolled))
}

fn side_section(options: &PairOptions, rolled: &RolledPair, at: usize) -> Section {
    let side = SIDES[at];
    let ratios = rolled.contact_ratio.as_ref().map(|sides| &sides[at]);
    let extreme = |row: &QuantityRow, sign: f64| match ratios {
        Ok(ratios) => {
            let (moment, ratio) = ratios[largest_at(ratios.iter().map(|(_, ratio)| sign * ratio))];
            row.of(ratio).at(at_moment(rolled, moment))
        }
        Err(why) => row.none(why.clone()),
    };
    let mean = ratios.ok().map(|ratios| ratios.iter().map(|(_, ratio)| ratio).sum::<f64>() / ratios.len() as f64);
    let why = rolled.contact_ratio.as_ref().err().cloned().unwrap_or_default();
    let pairs = &rolled.pairs[at];
    let marked = format!(" of {} um", options.marking_um);
    let mean_pairs = f64::from(pairs.iter().sum::<u32>()) / pairs.len() as f64;
    let fewest = pairs.iter().copied().min().unwrap_or(0);
    let (edge, share) = &rolled.edges[at];
    let no_edge = format!("nothing but flanks carries: corners and fillets lift by less than {LEAST_LIFT_UM} um");
    let place = edge.as_ref().map(|edge| {
        let place = at_moment(rolled, edge.moment).and("tooth_of_A", rolled.tooth_of_a(edge.pair.tooth));
        place.and("touching", edge.kind.name())
    });
    let title = if side == Side::Right { "Right flanks" } else { "Left flanks" };
    Section::new(side.name(), title).entries([
        extreme(&SMALLEST_CONTACT_RATIO, -1.0),
        MEAN_CONTACT_RATIO.of_or(mean, why),
        extreme(&LARGEST_CONTACT_RATIO, 1.0),
        MEAN_PAIRS.of(mean_pairs).remarked(&marked),
        FEWEST_PAIRS.of(fewest).remarked(&marked),
        EDGE_LIFT.of_or(edge.as_ref().map(|edge| edge.lift_um), no_edge).at(place),
        EDGE_SHARE.of(100.0 * share),
    ])
}

/// Tip corners in the mate. A depth below 0 is a clearance, and goes by that name.
pub(super) fn interference(rolled: &RolledPair) -> Section {
    let place = |corner: &DeepestCorner, gear: usize| {
        let (side, tooth) = match gear {
            0 => (corner.side, rolled.tooth_of_a(corner.label)),
            _ => {
                let (side, tooth) = rolled.fit.mate_flank(corner.side, corner.label);
                (side, tooth as u64)
            }
        };
        let zone = if corner.u_mm < 0.0 { "in the fillet" } else { "on the flank" };
        let place = at_angle(corner.phi_1_rad).and("tooth", tooth).and("flank", side.name());
        place.and("u_mm", corner.u_mm).and("zone", zone)
    };
    let corner = |gear: usize| rolled.corners[gear].as_ref();
    let depth = |row: &QuantityRow, gear: usize| match corner(gear) {
        None => row.none(NO_FILLETS),
        Some(corner) if corner.depth_mm <= 0.0 => row.none(CLEAR),
        Some(corner) => row.of(UM_PER_MM * corner.depth_mm).at(place(corner, gear)),
    };
    let clearance = |row: &QuantityRow, gear: usize| match corner(gear) {
        None => row.none(NO_FILLETS),
        Some(corner) if corner.depth_mm > 0.0 => row.none(INSIDE),
        Some(corner) => row.of(UM_PER_MM * -corner.depth_mm).at(place(corner, gear)),
    };
    // The gear in which a tip is deepest, or that a tip comes nearest to.
    let depth_mm = |gear: usize| corner(gear).map_or(f64::NEG_INFINITY, |corner| corner.depth_mm);
    let worst = usize::from(depth_mm(1) > depth_mm(0));
    let shown = |entry: Entry| if entry.quantity.value().is_some() { entry.shown() } else { entry };
    INTERFERENCE
        .section([depth(&DEEPEST_TIP, worst), clearance(&TIP_CLEARANCE, worst)])
        .entries([depth(&IN_A, 0), depth(&IN_B, 1), clearance(&CLEAR_OF_A, 0), clearance(&CLEAR_OF_B, 1)].map(shown))
}
