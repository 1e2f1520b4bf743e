//! Damage to the target, and the work of cutting a whole blank, as findings of any process.

use super::notices::{BelowTarget, Gouge};
use super::{Datum, Notice, Place, Quantity, Section, Table, TableColumn};
use crate::measure::damage::{Damage, LEAST_DEPTH_MM, gouge_mm};
use gearcut_core::units::UM_PER_MM;
use std::collections::BTreeSet;

/// All places of one kind of damage together; each of them is a row of [`damage_table`].
///
/// `what` says which material it is; `made_by` adds to the deepest place what made it.
pub fn damage(
    key: &str,
    title: &str,
    places: &[Damage],
    what: &'static str,
    made_by: impl Fn(Place, &Damage) -> Place,
) -> Section {
    let none = format!("there is none deeper than {LEAST_DEPTH_MM} mm");
    let depth = "largest depth along the normal; at its place the height over the pitch curve and the distance z from \
                 the middle of the face";
    let deepest = places.iter().max_by(|a, b| a.depth_mm.total_cmp(&b.depth_mm)).map(|d| {
        let place = Place::default()
            .and("tooth", d.place.tooth)
            .and("flank", d.place.side.name())
            .and("zone", d.place.zone.name())
            .and("height_mm", d.place.height_mm)
            .and("z_mm", d.z_mm);
        Quantity::number(d.depth_mm, "mm", depth).at(made_by(place, d))
    });
    let count = sides_of_teeth(places) as u64;
    Section::new(key, title)
        .shown(
            "places",
            "sides of teeth",
            Quantity::count(count, "sides of teeth", format!("{what}, deeper than {LEAST_DEPTH_MM} mm")),
        )
        .shown("deepest", "deepest", deepest.unwrap_or_else(|| Quantity::undefined("mm", depth, none)))
        .with(
            "volume",
            // From +0, so that no damage is not -0.
            Quantity::number(
                places.iter().fold(0.0, |sum, d| sum + d.volume_mm3),
                "mm^3",
                "volume, all places together",
            ),
        )
}

/// How many sides of teeth these places lie on: a side has three zones, and operations damage it each for themselves.
fn sides_of_teeth(places: &[Damage]) -> usize {
    places.iter().map(|damage| (damage.place.tooth, damage.place.side)).collect::<BTreeSet<_>>().len()
}

/// What is said of cuts below the target: a fault where they are gouges, deeper than `gouge_mm`. `by` says what made
/// one; `flank_mm` is the deepest cut that the rays of flanks found, which stand closer than the blank's: the deeper of
/// both is graded.
pub fn warning(places: &[Damage], flank_mm: f64, gouge_mm: f64, by: impl Fn(&Damage) -> String) -> Option<Notice> {
    let deepest = places.iter().max_by(|a, b| a.depth_mm.total_cmp(&b.depth_mm))?;
    let [depth_um, gouge_um] = [deepest.depth_mm, gouge_mm].map(|mm| UM_PER_MM * mm);
    let place = format!("tooth {} {}, {}", deepest.place.tooth, deepest.place.side.name(), deepest.place.zone.name());
    let (count, by) = (sides_of_teeth(places), by(deepest));
    let sides = if count == 1 { "1 side of a tooth is".to_owned() } else { format!("{count} sides of teeth are") };
    let flanks_um = format!("{:.1}", UM_PER_MM * flank_mm);
    let on_flanks = if flank_mm > deepest.depth_mm && flanks_um != format!("{depth_um:.1}") {
        format!(", rays of flanks say {flanks_um} um")
    } else {
        String::new()
    };
    let is_gouge = deepest.depth_mm.max(flank_mm) > gouge_mm;
    let [depth_um, gouge_um] = [depth_um, gouge_um].map(|um| format!("{um:.1}"));
    Some(if is_gouge {
        Gouge { sides, by, place, depth_um, on_flanks, gouge_um }.notice()
    } else {
        BelowTarget { sides, by, place, depth_um, on_flanks, gouge_um }.notice()
    })
}

/// What a cut below the target is called in the table: `gouged` from `gouge_mm` on, a deviation before.
pub fn kind(damage: &Damage, gouge_mm: f64, gouged: &'static str) -> &'static str {
    if damage.depth_mm > gouge_mm { gouged } else { "deviation" }
}

/// The depth that tells gouges from deviations, as a quantity.
pub fn gouge_from(module_mm: f64) -> Quantity {
    let definition = "depth from which on a cut below the target is a gouge and no deviation: form deviation that ISO \
                      1328-1:2013 allows a profile in class 8";
    Quantity::number(gouge_mm(module_mm), "mm", definition)
}

/// Every place of damage of the whole blank; `pass` names what did it, which differs between processes.
pub fn damage_table(pass: [TableColumn; 2], rows: impl IntoIterator<Item = Vec<Datum>>) -> Table {
    let none = "a stroke has no place on the gear";
    let number = |key, unit, definition| TableColumn::new(key, unit, definition).or(none);
    let mut columns = vec![
        TableColumn::words("kind", "what is wrong: a deviation, a gouge, interference, rubbing on the way back"),
        TableColumn::words("operation", "operation that did it"),
        TableColumn::new("tooth", "1", "tooth, from 1"),
        TableColumn::words("side", "side of the tooth: left or right"),
        TableColumn::words("zone", "part of the side"),
        number("height", "mm", "height over the pitch curve along its normal, deepest place"),
        number("z", "mm", "z of the gear frame, from the middle of the face, deepest place"),
        number("x", "mm", "x of the gear frame, deepest place"),
        number("y", "mm", "y of the gear frame, deepest place"),
        number("depth", "mm", "largest depth along the normal"),
        number("volume", "mm^3", "volume"),
    ];
    columns.extend(pass);
    Table::new("damage", "Places of damage", columns).with_rows(rows).in_file("damage")
}

/// A row of it but for the pass.
pub fn damage_row(kind: &str, operation: &str, damage: &Damage) -> Vec<Datum> {
    vec![
        kind.into(),
        operation.into(),
        damage.place.tooth.into(),
        damage.place.side.name().into(),
        damage.place.zone.name().into(),
        damage.place.height_mm.into(),
        damage.z_mm.into(),
        damage.point_mm.x.into(),
        damage.point_mm.y.into(),
        damage.depth_mm.into(),
        damage.volume_mm3.into(),
    ]
}

/// Pairs of ray and pass that the native backend counts.
pub fn pairs(count: u64, definition: &'static str) -> Quantity {
    if count > 0 {
        Quantity::count(count, "pairs", definition)
    } else {
        Quantity::undefined("pairs", definition, "the GPU does not count them")
    }
}
