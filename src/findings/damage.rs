//! Damage to the target, and the work of cutting a whole blank, as findings of any process.

use super::notices::{BelowTarget, Gouge};
use super::quantities::blank::{
    DEEPEST, DEPTH, HEIGHT, KIND, NO_DAMAGE, NO_TARGET, NOT_COUNTED, OPERATION, PAIRS_REMOVING, PAIRS_VISITED, PLACES,
    SIDE, VOLUME, VOLUME_OF_PLACE, X, Y, Z, ZONE,
};
use super::quantities::teeth::TOOTH;
use super::{Columns, Entry, Notice, Place, QuantityRow, Section, Table};
use crate::measure::damage::Damage;
use gearcut_core::units::UM_PER_MM;
use std::collections::BTreeSet;

/// All places of one kind of damage together, named by the section's title; each of them is a row of [`damage_table`].
///
/// `made_by` adds to the deepest place what made it.
pub fn damage(key: &str, title: &str, places: &[Damage], made_by: impl Fn(Place, &Damage) -> Place) -> Section {
    let deepest = places.iter().max_by(|a, b| a.depth_mm.total_cmp(&b.depth_mm)).map(|d| {
        let place = Place::default()
            .and("tooth", d.place.tooth)
            .and("flank", d.place.side.name())
            .and("zone", d.place.zone.name())
            .and("height_mm", d.place.height_mm)
            .and("z_mm", d.z_mm);
        DEEPEST.of(d.depth_mm).at(made_by(place, d))
    });
    Section::new(key, title).entries([
        PLACES.of(sides_of_teeth(places)),
        deepest.unwrap_or_else(|| DEEPEST.none(NO_DAMAGE)),
        // From +0, so that no damage is not -0.
        VOLUME.of(places.iter().fold(0.0, |sum, d| sum + d.volume_mm3)),
    ])
}

/// The same where there is no target.
pub fn without_target(key: &str, title: &str) -> Section {
    Section::new(key, title).entries([&PLACES, &DEEPEST, &VOLUME].map(|row| row.none(NO_TARGET)))
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

/// A place of damage with what a row of the table says of it beside: its kind, and the operation that did it.
pub struct DamagePlace<'a> {
    /// Kind, as [`kind`] calls it.
    pub kind: &'static str,
    /// Name of the operation.
    pub operation: &'a str,
    /// The place.
    pub damage: Damage,
}

/// Every place of damage of the whole blank; columns of the pass that did it, which differ between processes, follow.
pub fn damage_table<'a>(places: impl IntoIterator<Item = DamagePlace<'a>>) -> Columns<DamagePlace<'a>> {
    Table::over("damage", "Places of damage", places)
        .column(&KIND, |of| of.kind)
        .column(&OPERATION, |of| of.operation)
        .column(&TOOTH, |of| of.damage.place.tooth)
        .column(&SIDE, |of| of.damage.place.side.name())
        .column(&ZONE, |of| of.damage.place.zone.name())
        .column(&HEIGHT, |of| of.damage.place.height_mm)
        .column(&Z, |of| of.damage.z_mm)
        .column(&X, |of| of.damage.point_mm.x)
        .column(&Y, |of| of.damage.point_mm.y)
        .column(&DEPTH, |of| of.damage.depth_mm)
        .column(&VOLUME_OF_PLACE, |of| of.damage.volume_mm3)
}

/// Pairs of ray and pass that the native backend counts: in which the ray crosses the tool, and that removed material.
pub fn pairs([visited, removing]: [u64; 2]) -> [Entry; 2] {
    let counted = |row: &QuantityRow, count: u64| if count > 0 { row.of(count) } else { row.none(NOT_COUNTED) };
    [counted(&PAIRS_VISITED, visited), counted(&PAIRS_REMOVING, removing)]
}
