//! Contact: ratio, where it begins and ends on the flanks, edges; and tip corners in the mate.

use super::{ContactRatio, EdgeContact, INTERFERES_UM, at_angle, at_moment, largest_at, tables};
use crate::findings::{Entry, Notice, QuantityRow, Section};
use crate::pair_job::corners::DeepestCorner;
use crate::pair_job::fit::SIDES;
use crate::pair_job::options::PairOptions;
use crate::pair_job::quantities::{
    CLEAR, CLEAR_OF_A, CLEAR_OF_B, CONTACT, DEEPEST_TIP, EDGE_LIFT, EDGE_SHARE, FEWEST_PAIRS, IN_A, IN_B, INSIDE,
    INTERFERENCE, LARGEST_CONTACT_RATIO, MEAN_CONTACT_RATIO, MEAN_PAIRS, NO_FILLETS, OVERLAP_RATIO,
    SMALLEST_CONTACT_RATIO, TIP_CLEARANCE, TOTAL_CONTACT_RATIO,
};
use crate::pair_job::rolled::RolledPair;
use crate::pair_job::teeth::{EdgeContact as EdgeLift, LEAST_LIFT_UM};
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
    let total = smallest_ratio(rolled, at).map(|ratio| ratio + rolled.overlap_ratio);
    let helical = [OVERLAP_RATIO.of(rolled.overlap_ratio), TOTAL_CONTACT_RATIO.of_or(total, why.clone())];
    let helical = helical.map(Entry::shown).into_iter().filter(|_| rolled.overlap_ratio > 0.0);
    Section::new(side.name(), title)
        .entries([
            extreme(&SMALLEST_CONTACT_RATIO, -1.0),
            MEAN_CONTACT_RATIO.of_or(mean, why),
            extreme(&LARGEST_CONTACT_RATIO, 1.0),
            MEAN_PAIRS.of(mean_pairs).remarked(&marked),
            FEWEST_PAIRS.of(fewest).remarked(&marked),
            EDGE_LIFT.of_or(edge.as_ref().map(|edge| edge.lift_um), no_edge).at(place),
            EDGE_SHARE.of(100.0 * share),
        ])
        .entries(helical)
}

/// Smallest transverse contact ratio of a side; none of drawn teeth.
fn smallest_ratio(rolled: &RolledPair, at: usize) -> Option<f64> {
    let ratios = rolled.contact_ratio.as_ref().ok()?[at].iter().map(|(_, ratio)| *ratio);
    ratios.reduce(f64::min)
}

/// The sides of those of both flanks for which something holds, in words.
fn sides_in_words(holds: [bool; 2]) -> Option<&'static str> {
    match holds {
        [true, true] => Some("right and left"),
        [true, false] => Some("right"),
        [false, true] => Some("left"),
        [false, false] => None,
    }
}

/// A contact ratio below 1, the overlap along the face counted.
pub(super) fn too_short(rolled: &RolledPair) -> Option<Notice> {
    let ratios = [0, 1].map(|at| smallest_ratio(rolled, at).map_or(f64::INFINITY, |of| of + rolled.overlap_ratio));
    let flanks = sides_in_words(ratios.map(|ratio| ratio < 1.0))?;
    let ratio = format!("{:.2}", ratios[0].min(ratios[1]));
    Some(ContactRatio { flanks, ratio }.notice())
}

/// Edges that carry and lift the gears by more than what counts as interference.
pub(super) fn on_edges(rolled: &RolledPair) -> Option<Notice> {
    // Edges that carry where no flank is within reach lift the gears off nothing.
    let lifts = |(edge, share): &(Option<EdgeLift>, f64)| match edge {
        Some(edge) => edge.lift_um > INTERFERES_UM,
        None => *share > 0.0,
    };
    let flanks = sides_in_words([lifts(&rolled.edges[0]), lifts(&rolled.edges[1])])?;
    let percent = format!("{:.0}", 100.0 * rolled.edges.iter().map(|(_, share)| *share).fold(0.0, f64::max));
    let lifted = rolled.edges.iter().filter_map(|(edge, _)| edge.map(|edge| edge.lift_um)).reduce(f64::max);
    let lift = lifted.map_or_else(String::new, |um| format!(", up to {um:.1} um beyond what flanks ask for"));
    Some(EdgeContact { flanks, percent, lift }.notice())
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
