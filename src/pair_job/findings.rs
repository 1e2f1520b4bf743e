//! What a pair has shown, as the tree of findings: headline, sections, tables.
//!
//! In: a rolled pair. Out: [`Findings`] of the process "pair", with the sections `pair`, `ratio`, `transmission_error`,
//! `backlash`, `contact`, `interference`, `double_flank` and `center_distance`.
//!
//! Transmission errors belong to the driven gear B: its rotation less the one that the pitch curves ask for, positive
//! where it runs ahead. In um they are that rotation times r2, across the line of centres at the pitch point.

mod contact;
mod play;
mod tables;
mod transmission;

use super::flanks::FlankSource;
use super::notices::{ContactRatio, EdgeContact, Interference, Jams, Misfit};
use super::options::PairOptions;
use super::quantities::{
    BACKLASH, CENTER_DISTANCE, CHANGE_OF_ERROR, CLOSING_DISTANCE, CONTACT, COUNT_OF_POSITIONS, DEEPEST_TIP, DISTANCE,
    DISTANCE_ERROR, DOUBLE_FLANK, ECCENTRICITY_A, ECCENTRICITY_ANGLE_A, ECCENTRICITY_ANGLE_B, ECCENTRICITY_B,
    FLANKS_ROLLED, GEAR_A, GEAR_B, IN_PLANE, INTERFERENCE, KIND, LEAST_MORE_PLAY, MARKING, MATE, MESH_RANGE, MISFIT,
    MODULE, MOST_MORE_PLAY, OUT_OF_PLANE, PAIR, PEAK_TO_PEAK, PRESSURE_ANGLE, RANGE_AT_PITCH_POINT, RANGE_OF_CHANGE,
    RATIO, RATIO_DEVIATION, SECTIONS, SMALLEST_BACKLASH, SMALLEST_CONTACT_RATIO, TEETH_A, TEETH_B, TIGHT_RANGE,
    TIP_CLEARANCE, TRANSMISSION_ERROR, TURNS, WORKING_PRESSURE_ANGLE,
};
use super::rolled::RolledPair;
use crate::findings::{Entry, Findings, Notice, Place, QuantityGroup, QuantityRow, Section};
use crate::scene::Scene;
use gearcut_core::units::UM_PER_MM;

/// Name of the process in findings.
pub const PROCESS: &str = "pair";
/// Seconds of arc in a radian.
pub const ARCSEC_PER_RAD: f64 = 180.0 * 3600.0 / std::f64::consts::PI;
/// Play below this is none: what is left is the resolution of the dexels, um.
const JAMS_UM: f64 = -0.1;
/// Below this, feed marks do not explain what is missing: the gears do not go together, um.
const WEDGED_UM: f64 = -10.0;
/// Corners deeper than this are told as interference, um: below it lie scallops.
const INTERFERES_UM: f64 = 1.0;
/// Misfit of the pitch curves from which it is told, mm: what the sixth digit of a size makes.
const TOLD_MISFIT_MM: f64 = 1e-3;

/// Everything that was found.
pub fn findings(name: &str, scenes: [&Scene; 2], options: &PairOptions, rolled: &RolledPair) -> Findings {
    let sections = vec![
        pair(scenes, options, rolled),
        transmission::ratio(rolled),
        transmission::errors(rolled),
        play::backlash(rolled),
        contact::section(options, rolled),
        contact::interference(rolled),
        play::double_flank(rolled),
        center_distance(rolled),
    ];
    Findings::new(PROCESS, name, true, headline(&sections), warnings(rolled), sections)
}

/// Section, part of it if there is one, row and title of the numbers that come first.
type First = (&'static QuantityGroup, Option<&'static QuantityGroup>, &'static QuantityRow, &'static str);
/// The part of the flanks that drive.
static RIGHT: QuantityGroup = QuantityGroup::of_parts("right", "Right flanks");
/// Numbers of the sections that come first.
static HEADLINE: [First; 10] = [
    (&TRANSMISSION_ERROR, Some(&RIGHT), &PEAK_TO_PEAK, "transmission error, range"),
    (&TRANSMISSION_ERROR, Some(&RIGHT), &MESH_RANGE, "its tooth-mesh part, range"),
    (&TRANSMISSION_ERROR, Some(&RIGHT), &RANGE_AT_PITCH_POINT, "at the pitch point"),
    (&RATIO, None, &RATIO_DEVIATION, "ratio off by at most"),
    (&BACKLASH, None, &SMALLEST_BACKLASH, "smallest backlash"),
    (&CONTACT, Some(&RIGHT), &SMALLEST_CONTACT_RATIO, "smallest transverse contact ratio"),
    (&INTERFERENCE, None, &DEEPEST_TIP, "deepest tip in the mate, teeth centred"),
    (&INTERFERENCE, None, &TIP_CLEARANCE, "tips clear the mate by, teeth centred"),
    (&DOUBLE_FLANK, Some(&MATE), &TIGHT_RANGE, "tight centre distance, range"),
    (&CENTER_DISTANCE, None, &CHANGE_OF_ERROR, "10 um of centre distance do"),
];

fn headline(sections: &[Section]) -> Vec<Entry> {
    let entry = |(group, part, row, title): &First| {
        let section = sections.iter().find(|section| section.key == group.key)?;
        let of = part.map_or(Some(section), |part| section.group(part))?;
        let entry = of.entry_of(row)?.clone();
        // Depth and clearance exclude each other; nominal flanks have neither, and say so once.
        let is_silent = group.key == INTERFERENCE.key && entry.quantity.value().is_none();
        if is_silent && (row.key == TIP_CLEARANCE.key || section.value(&TIP_CLEARANCE).is_some()) {
            return None;
        }
        let path = [Some(group.key), part.map(|part| part.key), Some(row.key)];
        Some(entry.keyed(path.into_iter().flatten().collect::<Vec<_>>().join("_")).titled(*title))
    };
    HEADLINE.iter().filter_map(entry).collect()
}

/// The driver's angle of a moment as a place.
fn at_moment(rolled: &RolledPair, moment: usize) -> Place {
    at_angle(rolled.period.moments[moment].pitch.phi_1_rad)
}

fn at_angle(phi_1_rad: f64) -> Place {
    Place::default().and("angle_of_A_deg", phi_1_rad.to_degrees())
}

/// Number of the moment with the largest value.
fn largest_at(values: impl Iterator<Item = f64>) -> usize {
    values.enumerate().fold((0, f64::NEG_INFINITY), |most, (i, v)| if v > most.1 { (i, v) } else { most }).0
}

/// A quantity that drawn teeth do not have.
fn of_involutes(rolled: &RolledPair, row: &QuantityRow, value: f64) -> Entry {
    match rolled.fit.no_involutes() {
        Some(why) => row.none(why.to_owned()),
        None => row.of(value),
    }
}

fn pair(scenes: [&Scene; 2], options: &PairOptions, rolled: &RolledPair) -> Section {
    let teeth = rolled.fit.pitch.teeth();
    let own = &rolled.fit.own;
    let closing_mm = rolled.fit.pitch.center_distance_mm();
    let error_um = UM_PER_MM * rolled.meshing.center_distance_error_mm();
    let [a, b] = options.eccentricity_um_deg;
    let flanks = match options.source {
        FlankSource::Cut => "cut",
        FlankSource::Nominal => "nominal",
    };
    PAIR.section([
        GEAR_A.of(scenes[0].name.as_str()),
        GEAR_B.of(scenes[1].name.as_str()),
        KIND.of(teeth.driven.name()),
        TEETH_A.of(teeth.count[0]),
        TEETH_B.of(teeth.count[1]),
        MODULE.of(own.module_mm),
        of_involutes(rolled, &PRESSURE_ANGLE, own.pressure_angle_rad.to_degrees()),
        of_involutes(rolled, &WORKING_PRESSURE_ANGLE, teeth.pressure_angle_rad.to_degrees()),
        FLANKS_ROLLED.of(flanks),
        DISTANCE.of(closing_mm + error_um / UM_PER_MM),
        CLOSING_DISTANCE.of(closing_mm),
        DISTANCE_ERROR.of(error_um),
        ECCENTRICITY_A.of(a[0]),
        ECCENTRICITY_ANGLE_A.of(a[1]),
        ECCENTRICITY_B.of(b[0]),
        ECCENTRICITY_ANGLE_B.of(b[1]),
        IN_PLANE.of(options.parallelism_um[0]),
        OUT_OF_PLANE.of(options.parallelism_um[1]),
        MISFIT.of(UM_PER_MM * rolled.fit.misfit_mm).at(at_angle(rolled.fit.misfit_at_rad)),
        TURNS.of(rolled.period.turns),
        COUNT_OF_POSITIONS.of(rolled.period.moments.len()),
        SECTIONS.of(rolled.flanks.rows_mm.len()),
        MARKING.of(options.marking_um),
    ])
}

fn center_distance(rolled: &RolledPair) -> Section {
    let change = &rolled.sensitivity;
    let [low, high] = change.backlash_um;
    CENTER_DISTANCE.section([
        CHANGE_OF_ERROR.of(change.error_arcsec),
        RANGE_OF_CHANGE.of(change.error_range_arcsec),
        LEAST_MORE_PLAY.of(low),
        MOST_MORE_PLAY.of(high),
    ])
}

fn warnings(rolled: &RolledPair) -> Vec<Notice> {
    let mut warnings = Vec::new();
    let smallest = rolled.backlash.iter().map(|play| UM_PER_MM * play.circumferential_mm).fold(f64::INFINITY, f64::min);
    if smallest < JAMS_UM {
        let by = match rolled.fit.no_involutes() {
            Some(_) => "draw the tool's tooth wider",
            None => "gear.tooth_thickness_allowance_mm below 0",
        };
        let jams = Jams { missing_um: format!("{:.1}", -smallest), by }.notice();
        warnings.push(jams.fault_where(smallest < WEDGED_UM));
    }
    warnings.extend(interference(rolled));
    warnings.extend(contact::too_short(rolled));
    warnings.extend(contact::on_edges(rolled));
    if rolled.fit.misfit_mm > TOLD_MISFIT_MM {
        let misfit_um = format!("{:.1}", UM_PER_MM * rolled.fit.misfit_mm);
        warnings.push(Misfit { misfit_um }.notice());
    }
    warnings
}

/// Tips that stand in the mate; none where they stay clear. Play that is missing is none of it: teeth of full thickness
/// lack what their feed marks are high.
fn interference(rolled: &RolledPair) -> impl Iterator<Item = Notice> {
    rolled.corners.iter().zip([["A", "B"], ["B", "A"]]).filter_map(|(corner, [own, other])| {
        let corner = corner.filter(|corner| UM_PER_MM * corner.depth_mm > INTERFERES_UM)?;
        let place = if corner.u_mm < 0.0 { "fillet" } else { "flank" };
        let depth_um = format!("{:.1}", UM_PER_MM * corner.depth_mm);
        let angle_deg = format!("{:.2}", corner.phi_1_rad.to_degrees());
        Some(Interference { other, depth_um, place, own, angle_deg }.notice())
    })
}
