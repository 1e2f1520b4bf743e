//! Contact: ratio, where it begins and ends on the flanks, edges; and tip corners in the mate.

use super::{at_angle, at_moment, largest_at, tables};
use crate::findings::{Place, Quantity, Section};
use crate::pair_job::corners::DeepestCorner;
use crate::pair_job::fit::SIDES;
use crate::pair_job::flanks::FlankSource;
use crate::pair_job::options::PairOptions;
use crate::pair_job::rolled::RolledPair;
use crate::pair_job::teeth::LEAST_LIFT_UM;
use crate::scene::Scene;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// In which position tip corners are looked at.
const WANTED: &str = "where the pitch curves want it";

pub(super) fn section(options: &PairOptions, rolled: &RolledPair) -> Section {
    let sides = (0..2).map(|side| side_section(options, rolled, side));
    Section::new("contact", "Contact").parts(sides).table(tables::teeth(rolled))
}

fn side_section(options: &PairOptions, rolled: &RolledPair, at: usize) -> Section {
    let side = SIDES[at];
    let ratios = rolled.contact_ratio.as_ref().map(|sides| &sides[at]);
    let extreme = |sign: f64, definition: &'static str| match ratios {
        Ok(ratios) => {
            let (moment, ratio) = ratios[largest_at(ratios.iter().map(|(_, ratio)| sign * ratio))];
            Quantity::number(ratio, "1", definition).at(at_moment(rolled, moment))
        }
        Err(why) => Quantity::undefined("1", definition, why.clone()),
    };
    let mean = ratios.ok().map(|ratios| ratios.iter().map(|(_, ratio)| ratio).sum::<f64>() / ratios.len() as f64);
    let why = rolled.contact_ratio.as_ref().err().cloned().unwrap_or_default();
    let pairs = &rolled.pairs[at];
    let marked = format!("pairs of flanks closer than the marking thickness of {} um", options.marking_um);
    let mean_pairs = f64::from(pairs.iter().sum::<u32>()) / pairs.len() as f64;
    let fewest = pairs.iter().copied().min().unwrap_or(0);
    let (edge, share) = &rolled.edges[at];
    let lift = Quantity::number_or(
        edge.as_ref().map(|edge| edge.lift_um),
        "um",
        "how far a tip corner or a fillet drives the gears at most beyond what flanks ask for, along the flank's \
        normal",
        format!("nothing but flanks carries: corners and fillets lift by less than {LEAST_LIFT_UM} um"),
    );
    let lift = match edge {
        Some(edge) => lift.at(at_moment(rolled, edge.moment)
            .and("tooth_of_A", rolled.tooth_of_a(edge.pair.tooth))
            .and("touching", edge.kind.name())),
        None => lift,
    };
    let path = match options.source {
        FlankSource::Cut => {
            "smallest of the contact ratios of all moments: path of contact between tip curves and form points over \
            the base pitch"
        }
        FlankSource::Nominal => {
            "smallest of the contact ratios of all moments: path of contact between the tip curves over the base pitch"
        }
    };
    let title = if side == Side::Right { "Right flanks" } else { "Left flanks" };
    Section::new(side.name(), title)
        .with("smallest_contact_ratio", extreme(-1.0, path))
        .with("mean_contact_ratio", Quantity::number_or(mean, "1", "mean of the contact ratios of all moments", why))
        .with("largest_contact_ratio", extreme(1.0, "largest of the contact ratios of all moments"))
        .shown(
            "mean_pairs",
            "pairs in contact, mean",
            Quantity::number(mean_pairs, "1", format!("mean number of {marked}")),
        )
        .with("fewest_pairs", Quantity::count(fewest.into(), "pairs", format!("smallest number of {marked}")))
        .shown("edge_lift", "lift by edges", lift)
        .with("edge_share", Quantity::number(100.0 * share, "%", "positions at which a tip corner or a fillet carries"))
}

pub(super) fn interference(scenes: [&Scene; 2], rolled: &RolledPair) -> Section {
    let why = "nominal flanks have no fillets: roll cut ones";
    let quantity = |corner: &DeepestCorner, gear: usize, definition: String| {
        let (side, tooth) = match gear {
            0 => (corner.side, rolled.tooth_of_a(corner.label)),
            _ => {
                let (side, tooth) = rolled.fit.mate_flank(corner.side, corner.label);
                (side, tooth as u64)
            }
        };
        let place = at_angle(corner.phi_1_rad).and("tooth", tooth).and("flank", side.name()).and("u_mm", corner.u_mm);
        let zone = if corner.u_mm < 0.0 { "in the fillet" } else { "on the flank" };
        Quantity::number(UM_PER_MM * corner.depth_mm, "um", definition).at(zone_of(place, zone))
    };
    let definition = |gear: usize| {
        let own = ["gear A", "gear B"][gear];
        format!("deepest place of a tip corner of the mate in the material of {} ({own}), {WANTED}", scenes[gear].name)
    };
    let clear = |gear: usize| {
        let own = ["gear A", "gear B"][gear];
        format!(
            "smallest distance of the mate's tip corners from flanks and fillets of {} ({own}), {WANTED}",
            scenes[gear].name
        )
    };
    // A depth below 0 is a clearance, and goes by that name.
    let [in_a, in_b, clear_a, clear_b] = [(0, true), (1, true), (0, false), (1, false)].map(|(gear, inside)| {
        let words = if inside { definition(gear) } else { clear(gear) };
        match &rolled.corners[gear] {
            None => Quantity::undefined("um", words, why),
            Some(corner) if inside && corner.depth_mm <= 0.0 => Quantity::undefined("um", words, "tips stay clear"),
            Some(corner) if !inside && corner.depth_mm > 0.0 => {
                Quantity::undefined("um", words, "a tip stands in the material")
            }
            Some(corner) => {
                let sign = if inside { 1.0 } else { -1.0 };
                quantity(&DeepestCorner { depth_mm: sign * corner.depth_mm, ..*corner }, gear, words)
            }
        }
    });
    let worst = |pair: [&Quantity; 2], sign: f64| {
        let value = |of: &Quantity| of.value().map_or(f64::NEG_INFINITY, |value| sign * value);
        if value(pair[1]) > value(pair[0]) { pair[1].clone() } else { pair[0].clone() }
    };
    let deepest = worst([&in_a, &in_b], 1.0);
    let clearance = match deepest.value() {
        Some(_) => Quantity::undefined("um", "smallest clearance of all tip corners", "a tip stands in the material"),
        None => worst([&clear_a, &clear_b], -1.0),
    };
    let numbers = [
        ("in_A", "tip of B in A", in_a),
        ("in_B", "tip of A in B", in_b),
        ("clear_of_A", "tip of B clear of A by", clear_a),
        ("clear_of_B", "tip of A clear of B by", clear_b),
    ];
    let section = Section::new("interference", "Interference").with("deepest", deepest).with("clearance", clearance);
    numbers.into_iter().fold(section, |section, (key, title, number)| match number.value() {
        Some(_) => section.shown(key, title, number),
        None => section.with(key, number),
    })
}

fn zone_of(place: Place, zone: &'static str) -> Place {
    place.and("zone", zone)
}
