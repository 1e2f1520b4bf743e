//! What a bevel pair shows: motion error, path and ellipse of contact, and how they move with the mounting.

use super::{MountingError, MountingErrors, RolledBevels, RolledSide, Trend};
use crate::findings::{Entry, Findings, Notice, QuantityRow, Section, Table};
use crate::process::bevel::BevelJob;
use crate::process::bevel::notices::EdgeContact;
use crate::process::bevel::quantities::pair::{
    ADDED, ALONG, ALONG_LINE, AT_EDGE, CENTER_ALONG, CENTER_HEIGHT, ELLIPSE_LENGTH, ERROR, ERROR_AT, ERROR_OF_TREND,
    GEAR, GEAR_AXIAL_ERROR, HALF_LENGTH, HALF_LENGTH_AT, HALF_WIDTH, HALF_WIDTH_AT, HEIGHT, HYPOID_OFFSET, ISO_NAME,
    MARKING, MOTION_ERROR, MOVED_ALONG, MOVED_UP, OFFSET_ERROR, OUTER_MODULE, PAIR, PARABOLA, PATH, PINION,
    PINION_ANGLE, PINION_AXIAL_ERROR, SHAFT_ANGLE, SHAFT_ANGLE_ERROR, TEETH_OF_GEAR, TEETH_OF_PINION, TOO_FEW_PLACES,
    TRENDS, TURNED,
};
use gearcut_core::bevel::contact::Contact;
use gearcut_core::units::UM_PER_MM;

/// Name of the process in findings.
pub const PROCESS: &str = "bevel pair";
/// Seconds of arc in a radian.
pub const ARCSEC_PER_RAD: f64 = 180.0 * 3600.0 / std::f64::consts::PI;

/// Everything that was found; `jobs` are the gear and the scenes of its pinion, here and below.
pub fn findings(name: &str, jobs: &[BevelJob], rolled: &RolledBevels) -> Findings {
    let headline = rolled.sides.iter().flat_map(headline);
    let warnings = rolled.sides.iter().filter_map(at_edge);
    let sections = std::iter::once(mounted(jobs, rolled)).chain(rolled.sides.iter().map(side));
    Findings::new(PROCESS, name, true, headline, warnings, sections.collect())
}

/// A side in a word: the form of the gear's flanks.
pub fn words(side: &RolledSide) -> &'static str {
    side.gear_blades.flank()
}

fn headline(side: &RolledSide) -> impl Iterator<Item = Entry> {
    let name = words(side);
    let first = [motion_error(side), center_along(side), half_axis(&ELLIPSE_LENGTH, side, 0, 2.0)];
    first.into_iter().map(move |entry| {
        let (key, title) = (format!("{}_{name}", entry.key), format!("{}, {name}", entry.title));
        entry.keyed(key).titled(title)
    })
}

fn motion_error(side: &RolledSide) -> Entry {
    MOTION_ERROR.of(ARCSEC_PER_RAD * side.running.motion_error_rad())
}

fn center_along(side: &RolledSide) -> Entry {
    CENTER_ALONG.of(side.running.center_mm()[0])
}

/// A half axis of the ellipse in the middle of a pitch times a factor; flanks that touch along a line have no long one.
fn half_axis(row: &QuantityRow, side: &RolledSide, which: usize, factor: f64) -> Entry {
    match side.running.middle().ellipse.map(|ellipse| factor * ellipse.half_axes_mm[which]) {
        Some(mm) if mm.is_finite() => row.of(mm),
        Some(_) => row.none(ALONG_LINE),
        None => row.none(AT_EDGE),
    }
}

/// A side whose contact runs over an edge within the pitch.
fn at_edge(side: &RolledSide) -> Option<Notice> {
    let at_edge = side.running.carrying.iter().filter(|(_, contact, _)| contact.ellipse.is_none()).count();
    let percent = 100 * at_edge / side.running.carrying.len();
    (at_edge > 0).then(|| EdgeContact { flanks: words(side), percent }.notice())
}

/// The pair as it is mounted.
pub fn mounted(jobs: &[BevelJob], rolled: &RolledBevels) -> Section {
    let (gear, pinions) = (&jobs[0], &jobs[1..]);
    let names: Vec<&str> = pinions.iter().map(|pinion| pinion.scene.name.as_str()).collect();
    let MountingErrors { offset_mm, pinion_axial_mm, gear_axial_mm, shaft_angle_rad } = rolled.errors;
    PAIR.section([
        GEAR.of(gear.scene.name.as_str()),
        PINION.of(names.join(", ")),
        TEETH_OF_GEAR.of(gear.blank.teeth),
        TEETH_OF_PINION.of(pinions[0].blank.teeth),
        OUTER_MODULE.of(gear.blank.outer_module_mm()),
        SHAFT_ANGLE.of(rolled.nominal.shaft_angle_rad.to_degrees()),
        HYPOID_OFFSET.of(rolled.nominal.offset_mm),
        OFFSET_ERROR.of(offset_mm),
        PINION_AXIAL_ERROR.of(pinion_axial_mm),
        GEAR_AXIAL_ERROR.of(gear_axial_mm),
        SHAFT_ANGLE_ERROR.of(shaft_angle_rad.to_degrees()),
        MARKING.of(UM_PER_MM * rolled.marking_mm),
    ])
}

/// Contact on a side.
pub fn side(side: &RolledSide) -> Section {
    let name = words(side);
    let parabola = side.running.parabola().map(|parabola| ARCSEC_PER_RAD * parabola.over_pitch_rad());
    Section::new(name, format!("{}{} flanks of the gear", name[..1].to_uppercase(), &name[1..]))
        .entries([
            motion_error(side),
            PARABOLA.of_or(parabola, TOO_FEW_PLACES),
            center_along(side).titled("center along"),
            CENTER_HEIGHT.of(side.running.center_mm()[1]),
            half_axis(&HALF_LENGTH, side, 0, 1.0),
            half_axis(&HALF_WIDTH, side, 1, 1.0),
        ])
        .table(path(side))
        .table(trends(side))
}

fn path(side: &RolledSide) -> Table {
    let contact = |met: &Option<(Contact, f64)>| met.as_ref().map(|(contact, _)| *contact);
    let axis_mm = |met: &Option<(Contact, f64)>, which: usize| {
        contact(met).and_then(|contact| contact.ellipse).map(|ellipse| ellipse.half_axes_mm[which])
    };
    PATH.table(&side.running.teeth)
        .column(&PINION_ANGLE, |(pinion_rad, _)| pinion_rad.to_degrees())
        .column(&ERROR_AT, |(_, met)| met.as_ref().map(|(_, error_rad)| ARCSEC_PER_RAD * error_rad))
        .column(&ALONG, |(_, met)| contact(met).map(|contact| contact.place_mm[0]))
        .column(&HEIGHT, |(_, met)| contact(met).map(|contact| contact.place_mm[1]))
        .column(&HALF_LENGTH_AT, |(_, met)| axis_mm(met, 0))
        .column(&HALF_WIDTH_AT, |(_, met)| axis_mm(met, 1))
        .in_file(&format!("contact_{}", words(side)))
}

/// What errors of the mounting do on a side.
pub fn trends(side: &RolledSide) -> Table {
    let from_mm = side.running.center_mm();
    let is_angle = |of: &Trend| matches!(of.error, MountingError::ShaftAngle);
    let moved_mm = |of: &Trend, k: usize| of.found.map(|(_, center_mm)| center_mm[k] - from_mm[k]);
    TRENDS
        .table(&side.trends)
        .column(&ERROR, |of| of.error.names()[0])
        .column(&ISO_NAME, |of| of.error.names()[1])
        .column(&ADDED, |of| (!is_angle(of)).then_some(of.added))
        .column(&TURNED, |of| is_angle(of).then(|| of.added.to_degrees()))
        .column(&ERROR_OF_TREND, |of| of.found.map(|(error_rad, _)| ARCSEC_PER_RAD * error_rad))
        .column(&MOVED_ALONG, |of| moved_mm(of, 0))
        .column(&MOVED_UP, |of| moved_mm(of, 1))
        .in_file(&format!("trends_{}", words(side)))
}
