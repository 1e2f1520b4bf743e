//! What the cutter can do in a ring, as findings: how large it may be, how far its involute reaches, how deep its base
//! relieves the tips, whether its tip corners come clear.
//!
//! In: [`RingFacts`], known before cutting. Out: a section, with a row for every tooth of a period in
//! `tables/ring.csv`.

use crate::findings::{Datum, Place, Quantity, Section, Table, TableColumn};
use crate::process::shaping::check::ring::{RingFacts, TipCorners, ToothPlace};
use gearcut_core::units::UM_PER_MM;

/// Why there is no radius, and no largest cutter.
const NOT_CURVED: &str = "the pitch curve is not curved towards the axis there";
/// Why there is no depth of the tips.
const NO_RELIEF: &str = "the cutter's base does not shape the tip, or leaves it out of its reach";

/// The section.
pub fn section(facts: &RingFacts, module_mm: f64) -> Section {
    let at = |place: ToothPlace| Place::default().and("tooth", u64::from(place.tooth)).and("side", place.side.name());
    let (radius_mm, phi_rad) = facts.sharpest;
    let angle = |phi_rad: f64| Place::default().and("phi_deg", phi_rad.to_degrees());
    let placed = |mm: Option<ToothPlace>, scale: f64, unit: &'static str, definition: &'static str, why| {
        let quantity = Quantity::number_or(mm.map(|place| scale * place.mm), unit, definition, why);
        match mm {
            Some(place) => quantity.at(at(place)),
            None => quantity,
        }
    };
    let deepest = "largest depth at which a tip corner of the cutter runs through teeth beside its space";
    let corners = match facts.tip_corners {
        TipCorners::Unknown => Quantity::undefined("mm", deepest, "the target's outline is not known"),
        TipCorners::Clear => Quantity::number(0.0, "mm", deepest),
        TipCorners::Cut { depth_mm, phi_rad } => Quantity::number(depth_mm, "mm", deepest).at(angle(phi_rad)),
    };
    let rolling = "most cutter teeth whose pitch circle rolls everywhere";
    let reach = "lowest end of a flank that the cutter's involute generates, height over the pitch curve";
    let relief = "largest depth of a tip behind the conjugate flank, which the cutter's base has shaped";
    Section::new("ring", "What the cutter can do in the ring")
        .with(
            "smallest_radius_of_curvature",
            Quantity::number(radius_mm, "mm", "smallest radius of curvature of the pitch curve").at(angle(phi_rad)),
        )
        .with("rolling_teeth", Quantity::count(facts.rolling_teeth.into(), "teeth", rolling))
        .with(
            "involute_height",
            placed(facts.shortest_involute, 1.0, "mm", reach, "the involute reaches the tip on all flanks"),
        )
        .with("tip_relief", placed(facts.relief, UM_PER_MM, "um", relief, NO_RELIEF))
        .with("tip_corner_depth", corners)
        .table(table(facts, module_mm))
}

fn table(facts: &RingFacts, module_mm: f64) -> Table {
    let um = |key, definition| TableColumn::new(key, "um", definition).or(NO_RELIEF);
    let columns = vec![
        TableColumn::new("tooth", "1", "number of the tooth, from 1"),
        TableColumn::new("phi", "deg", "polar angle of its middle on the pitch curve"),
        TableColumn::new("radius_of_curvature", "mm", "radius of curvature of the pitch curve").or(NOT_CURVED),
        TableColumn::new("rolling_teeth", "1", "most cutter teeth whose pitch circle rolls there").or(NOT_CURVED),
        TableColumn::new("involute_left", "mm", "height over the pitch curve at which the generated left flank ends"),
        TableColumn::new("involute_right", "mm", "height over the pitch curve at which the generated right flank ends"),
        um("tip_relief_left", "depth of the left tip behind the conjugate flank"),
        um("tip_relief_right", "depth of the right tip behind the conjugate flank"),
    ];
    let rows = facts.teeth.iter().map(|of| {
        let curved = of.rolling_teeth(module_mm);
        let mut row = vec![Datum::from(of.tooth), of.phi_rad.to_degrees().into()];
        row.push(curved.map(|_| 1.0 / of.curvature_per_mm).into());
        row.push(curved.map_or(Datum::Undefined, Datum::from));
        row.extend(of.involute_mm.map(Datum::from));
        row.extend(of.relief_mm.map(|mm| Datum::from(mm.map(|mm| UM_PER_MM * mm))));
        row
    });
    Table::new("teeth", "What the cutter can do, tooth by tooth over one period of the pitch curve", columns)
        .with_rows(rows)
        .in_file("ring")
}
