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

use super::notices::{Interference, Jams, Misfit};
use super::options::PairOptions;
use super::rolled::{PROBE_UM, RolledPair};
use crate::findings::notice::ranked;
use crate::findings::{Entry, Findings, Notice, Place, Quantity, Section};
use crate::scene::Scene;
use gearcut_core::units::UM_PER_MM;

/// Name of the process in findings.
pub const PROCESS: &str = "pair";
/// Seconds of arc in a radian.
pub const ARCSEC_PER_RAD: f64 = 180.0 * 3600.0 / std::f64::consts::PI;
/// Play below this is none: what is left is the resolution of the dexels, um.
const JAMS_UM: f64 = -0.1;
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
        contact::interference(scenes, rolled),
        play::double_flank(rolled),
        center_distance(rolled),
    ];
    let mut found = Findings {
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        process: PROCESS.to_owned(),
        scene: name.to_owned(),
        complete: true,
        headline: Vec::new(),
        warnings: ranked(warnings(rolled)),
        sections,
    };
    found.headline = headline(&found);
    found
}

/// Numbers of the sections that are told first.
const HEADLINE: [(&str, &str, &str); 10] = [
    ("transmission_error.right", "peak_to_peak", "transmission error, range"),
    ("transmission_error.right", "mesh_peak_to_peak", "its tooth-mesh part, range"),
    ("transmission_error.right", "peak_to_peak_at_pitch_point", "at the pitch point"),
    ("ratio", "largest_deviation", "ratio off by at most"),
    ("backlash", "smallest", "smallest backlash"),
    ("contact.right", "smallest_contact_ratio", "smallest contact ratio"),
    ("interference", "deepest", "deepest tip in the mate"),
    ("interference", "clearance", "tips clear the mate by"),
    ("double_flank.mate", "total", "tight centre distance, range"),
    ("center_distance", "transmission_error", "10 um of centre distance do"),
];

fn headline(found: &Findings) -> Vec<Entry> {
    let entry = |(path, key, title): (&str, &str, &str)| {
        let quantity = found.find(path)?.quantity(key)?.clone();
        // Depth and clearance exclude each other; nominal flanks have neither, and say so once.
        let silent = path == "interference" && quantity.value().is_none();
        if silent && (key == "clearance" || found.find(path)?.number("clearance").is_some()) {
            return None;
        }
        Some(Entry::headline(&format!("{}_{key}", path.replace('.', "_")), title, quantity))
    };
    HEADLINE.into_iter().filter_map(entry).collect()
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

fn pair(scenes: [&Scene; 2], options: &PairOptions, rolled: &RolledPair) -> Section {
    let teeth = rolled.fit.pitch.teeth();
    let own = &rolled.fit.own;
    let closing_mm = rolled.fit.pitch.center_distance_mm();
    let error_um = UM_PER_MM * rolled.meshing.center_distance_error_mm();
    let length = |mm: f64, definition: &'static str| Quantity::number(mm, "mm", definition);
    let angle = |rad: f64, definition: &'static str| Quantity::number(rad.to_degrees(), "deg", definition);
    let um = |value: f64, definition: &'static str| Quantity::number(value, "um", definition);
    let [a, b] = options.eccentricity_um_deg;
    Section::new("pair", "The pair")
        .with("gear_A", Quantity::text(scenes[0].name.clone(), "gear A, the driver"))
        .with("gear_B", Quantity::text(scenes[1].name.clone(), "gear B, driven"))
        .with("kind", Quantity::text(teeth.driven.name(), "whether gear B is external or a ring"))
        .with("teeth_A", Quantity::count(teeth.count[0].into(), "teeth", "teeth of gear A"))
        .with("teeth_B", Quantity::count(teeth.count[1].into(), "teeth", "teeth of gear B"))
        .with("module", length(own.module_mm, "transverse module"))
        .with("pressure_angle", angle(own.pressure_angle_rad, "transverse pressure angle"))
        .with(
            "working_pressure_angle",
            angle(teeth.pressure_angle_rad, "transverse pressure angle on the pitch curves that roll on each other"),
        )
        .with(
            "flanks",
            Quantity::text(
                match options.source {
                    super::flanks::FlankSource::Cut => "cut",
                    super::flanks::FlankSource::Nominal => "nominal",
                },
                "whether flanks as cut or nominal ones are rolled",
            ),
        )
        .shown(
            "center_distance",
            "centre distance",
            length(closing_mm + error_um / UM_PER_MM, "distance of the axes at which the gears are rolled"),
        )
        .with(
            "closing_center_distance",
            length(
                closing_mm,
                "distance of the axes at which the pitch curves roll on each other: of round gears that of their \
                 profile shifts, or the one that is named",
            ),
        )
        .with("center_distance_error", um(error_um, "added to that distance"))
        .with("eccentricity_A", um(a[0], "from gear A's axis of rotation to the origin of its pitch curve"))
        .with("eccentricity_angle_A", Quantity::number(a[1], "deg", "polar angle of that vector in gear A"))
        .with("eccentricity_B", um(b[0], "from gear B's axis of rotation to the origin of its pitch curve"))
        .with("eccentricity_angle_B", Quantity::number(b[1], "deg", "polar angle of that vector in gear B"))
        .with("in_plane_deviation", um(options.parallelism_um[0], "axes apart over the face, in their plane"))
        .with("out_of_plane_deviation", um(options.parallelism_um[1], "axes apart over the face, across their plane"))
        .with(
            "misfit",
            Quantity::number(
                UM_PER_MM * rolled.fit.misfit_mm,
                "um",
                "largest distance of gear B's own pitch curve from the mate's that closes with gear A",
            )
            .at(at_angle(rolled.fit.misfit_at_rad)),
        )
        .with("turns", Quantity::count(rolled.period.turns.into(), "turns", "turns of gear A in a period of the pair"))
        .with(
            "positions",
            Quantity::count(
                rolled.period.moments.len() as u64,
                "positions",
                "positions in a period, even over the teeth",
            ),
        )
        .with(
            "sections",
            Quantity::count(rolled.flanks.rows_mm.len() as u64, "sections", "transverse sections that are rolled"),
        )
        .with("marking_thickness", um(options.marking_um, "thickness of the marking compound"))
}

fn center_distance(rolled: &RolledPair) -> Section {
    let change = &rolled.sensitivity;
    let of = |what: &str| format!("{what} when the axes are moved {PROBE_UM} um further apart");
    let [low, high] = change.backlash_um;
    Section::new("center_distance", "What the centre distance does")
        .with(
            "transmission_error",
            Quantity::number(
                change.error_arcsec,
                "arcsec",
                of("largest change of the driving flanks' transmission error"),
            ),
        )
        .shown(
            "transmission_error_range",
            "10 um: change of error, range",
            Quantity::number(
                change.error_range_arcsec,
                "arcsec",
                of("largest less smallest change of the transmission error: 0 on round gears"),
            ),
        )
        .shown(
            "smallest_backlash_change",
            "10 um: more backlash, least",
            Quantity::number(low, "um", of("smallest change of the circumferential backlash")),
        )
        .shown(
            "largest_backlash_change",
            "10 um: more backlash, most",
            Quantity::number(high, "um", of("largest change of the circumferential backlash")),
        )
}

fn warnings(rolled: &RolledPair) -> Vec<Notice> {
    let mut warnings = Vec::new();
    let smallest = rolled.backlash.iter().map(|play| UM_PER_MM * play.circumferential_mm).fold(f64::INFINITY, f64::min);
    if smallest < JAMS_UM {
        warnings.push(Jams { missing_um: format!("{:.1}", -smallest) }.notice());
    }
    warnings.extend(interference(rolled));
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
