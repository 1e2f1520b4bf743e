//! What a bevel pair shows: motion error, path and ellipse of contact, and how they move with the mounting.

use super::{MountingError, MountingErrors, RolledBevels, RolledSide, Trend};
use crate::findings::{Datum, Entry, Findings, Notice, Quantity, Section, Table, TableColumn};
use crate::process::bevel::BevelJob;
use crate::process::bevel::notices::EdgeContact;
use gearcut_core::bevel::contact::Contact;
use gearcut_core::units::UM_PER_MM;

/// Name of the process in findings.
pub const PROCESS: &str = "bevel pair";
/// Seconds of arc in a radian.
pub const ARCSEC_PER_RAD: f64 = 180.0 * 3600.0 / std::f64::consts::PI;
const PARTED: &str = "the teeth part there";
const AT_EDGE: &str = "the contact stands at an edge of the flank";
const ALONG: &str = "along the gear's tooth from the middle of the face, positive towards the heel";
const HEIGHT: &str = "height over the gear's pitch cone";

/// Everything that was found.
pub fn findings(name: &str, [gear, pinion]: [&BevelJob; 2], rolled: &RolledBevels) -> Findings {
    let sides = rolled.sides.iter().map(side);
    Findings {
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        process: PROCESS.to_owned(),
        scene: name.to_owned(),
        complete: true,
        headline: rolled.sides.iter().flat_map(headline).collect(),
        warnings: rolled.sides.iter().filter_map(at_edge).collect(),
        sections: std::iter::once(mounted(gear, pinion, rolled)).chain(sides).collect(),
    }
}

/// A side in a word: the form of the gear's flanks.
pub fn words(side: &RolledSide) -> &'static str {
    side.gear_blades.flank()
}

fn headline(side: &RolledSide) -> Vec<Entry> {
    let name = words(side);
    let [along_mm, _] = side.running.center_mm();
    vec![
        Entry::headline(&format!("motion_error_{name}"), &format!("motion error, {name}"), motion_error(side)),
        Entry::headline(
            &format!("center_along_{name}"),
            &format!("contact along, {name}"),
            Quantity::number(along_mm, "mm", format!("mean place over a pitch, {ALONG}")),
        ),
        Entry::headline(
            &format!("ellipse_length_{name}"),
            &format!("ellipse, {name}"),
            half_axis(
                side.running.middle(),
                0,
                2.0,
                "length of the contact ellipse in the middle of a pitch, beyond the edges of the flank as well",
            ),
        ),
    ]
}

fn motion_error(side: &RolledSide) -> Quantity {
    Quantity::number(
        ARCSEC_PER_RAD * side.running.motion_error_rad(),
        "arcsec",
        "range over a pitch of the gear's angle less that of a constant ratio, by the teeth that carry; 0 where it is \
        below two millionths of an arc second, which the search leaves",
    )
}

fn parabola(side: &RolledSide) -> Quantity {
    Quantity::number_or(
        side.running.parabola().map(|parabola| ARCSEC_PER_RAD * parabola.over_pitch_rad()),
        "arcsec",
        "parabola through the motion error of one pair of teeth while it carries: how far it falls from its top to \
        half a pitch beside it, negative where the gear runs behind there",
        "one pair of teeth carries at fewer than three places in a row",
    )
}

/// A half axis of the ellipse times a factor; flanks that touch along a line have no long one.
fn half_axis(contact: &Contact, which: usize, factor: f64, definition: &'static str) -> Quantity {
    match contact.ellipse.map(|ellipse| factor * ellipse.half_axes_mm[which]) {
        Some(mm) if mm.is_finite() => Quantity::number(mm, "mm", definition),
        Some(_) => Quantity::undefined("mm", definition, "the flanks touch along a line"),
        None => Quantity::undefined("mm", definition, AT_EDGE),
    }
}

/// A side whose contact runs over an edge within the pitch.
fn at_edge(side: &RolledSide) -> Option<Notice> {
    let at_edge = side.running.carrying.iter().filter(|(_, contact, _)| contact.ellipse.is_none()).count();
    let percent = 100 * at_edge / side.running.carrying.len();
    (at_edge > 0).then(|| EdgeContact { flanks: words(side), percent }.notice())
}

fn mounted(gear: &BevelJob, pinion: &BevelJob, rolled: &RolledBevels) -> Section {
    let MountingErrors { offset_mm, pinion_axial_mm, gear_axial_mm, shaft_angle_rad } = rolled.errors;
    let mm = |value: f64, definition: &'static str| Quantity::number(value, "mm", definition);
    let deg = |rad: f64, definition: &'static str| Quantity::number(rad.to_degrees(), "deg", definition);
    Section::new("pair", "Pair")
        .with("gear", Quantity::text(gear.scene.name.clone(), "scene of the gear"))
        .with("pinion", Quantity::text(pinion.scene.name.clone(), "scene of the pinion"))
        .with("teeth_of_gear", Quantity::count(gear.blank.teeth.into(), "teeth", "number of teeth of the gear"))
        .with("teeth_of_pinion", Quantity::count(pinion.blank.teeth.into(), "teeth", "number of teeth of the pinion"))
        .with("outer_module", mm(gear.blank.outer_module_mm(), "outer transverse module"))
        .with("shaft_angle", deg(rolled.nominal.shaft_angle_rad, "nominal shaft angle"))
        .with("hypoid_offset", mm(rolled.nominal.offset_mm, "nominal offset a of both axes; 0 of spiral bevel gears"))
        .with("offset_error", mm(offset_mm, "E: offset of the pinion's axis (ISO 23509: hypoid offset a)"))
        .with("pinion_axial_error", mm(pinion_axial_mm, "P: pinion away from the apex (mounting distance t_B1)"))
        .with("gear_axial_error", mm(gear_axial_mm, "G: gear away from the apex (mounting distance t_B2)"))
        .with("shaft_angle_error", deg(shaft_angle_rad, "error of the shaft angle Sigma"))
        .with(
            "marking",
            Quantity::number(UM_PER_MM * rolled.marking_mm, "um", "thickness of the marking compound of the ellipses"),
        )
}

fn side(side: &RolledSide) -> Section {
    let name = words(side);
    let [along_mm, height_mm] = side.running.center_mm();
    let middle = side.running.middle();
    Section::new(name, format!("{}{} flanks of the gear", name[..1].to_uppercase(), &name[1..]))
        .with("motion_error", motion_error(side))
        .with("motion_error_parabola", parabola(side))
        .with("center_along", Quantity::number(along_mm, "mm", format!("mean place over a pitch, {ALONG}")))
        .with("center_height", Quantity::number(height_mm, "mm", format!("mean place over a pitch, {HEIGHT}")))
        .with("half_length", half_axis(middle, 0, 1.0, "long half axis of the ellipse in the middle of a pitch"))
        .with("half_width", half_axis(middle, 1, 1.0, "short half axis of the ellipse in the middle of a pitch"))
        .table(path(side))
        .table(trends(side))
}

fn path(side: &RolledSide) -> Table {
    let columns = vec![
        TableColumn::new("pinion_angle", "deg", "angle of the pinion about the middle of the mesh"),
        TableColumn::new("motion_error", "arcsec", "gear's angle less that of a constant ratio, one pair of teeth")
            .or(PARTED),
        TableColumn::new("along", "mm", ALONG).or(PARTED),
        TableColumn::new("height", "mm", HEIGHT).or(PARTED),
        TableColumn::new("half_length", "mm", "long half axis of the contact ellipse").or(AT_EDGE),
        TableColumn::new("half_width", "mm", "short half axis of the contact ellipse").or(AT_EDGE),
    ];
    let rows = side.running.teeth.iter().map(|(pinion_rad, met)| {
        let contact = met.as_ref().map(|(contact, _)| contact);
        let axis = |which: usize| {
            let mm = contact.and_then(|contact| contact.ellipse).map(|ellipse| ellipse.half_axes_mm[which]);
            Datum::from(mm.filter(|mm| mm.is_finite()))
        };
        vec![
            pinion_rad.to_degrees().into(),
            Datum::from(met.as_ref().map(|(_, error_rad)| ARCSEC_PER_RAD * error_rad)),
            Datum::from(contact.map(|contact| contact.place_mm[0])),
            Datum::from(contact.map(|contact| contact.place_mm[1])),
            axis(0),
            axis(1),
        ]
    });
    let title = "Contact of one pair of teeth";
    Table::new("path", title, columns).with_rows(rows).in_file(&format!("contact_{}", words(side)))
}

fn trends(side: &RolledSide) -> Table {
    let columns = vec![
        TableColumn::words("error", "error of the mounting, Gleason's letter"),
        TableColumn::words("iso_name", "the same in ISO 23509"),
        TableColumn::new("added", "mm", "what was added to a length").or("the error is an angle"),
        TableColumn::new("turned", "deg", "what was added to an angle").or("the error is a length"),
        TableColumn::new("motion_error", "arcsec", "range over a pitch").or(PARTED),
        TableColumn::new("moved_along", "mm", "how far the contact moves along the gear's tooth, towards the heel")
            .or(PARTED),
        TableColumn::new("moved_up", "mm", "how far it moves towards the tip").or(PARTED),
    ];
    let from_mm = side.running.center_mm();
    let rows = side.trends.iter().map(|Trend { error, added, found }| {
        let [letter, iso] = error.names();
        let (added_mm, turned_deg) = match error {
            MountingError::ShaftAngle => (None, Some(added.to_degrees())),
            _ => (Some(*added), None),
        };
        let moved = |k: usize| Datum::from(found.map(|(_, center_mm)| center_mm[k] - from_mm[k]));
        vec![
            letter.into(),
            iso.into(),
            Datum::from(added_mm),
            Datum::from(turned_deg),
            Datum::from(found.map(|(error_rad, _)| ARCSEC_PER_RAD * error_rad)),
            moved(0),
            moved(1),
        ]
    });
    let title = "What errors of the mounting do";
    Table::new("trends", title, columns).with_rows(rows).in_file(&format!("trends_{}", words(side)))
}
