//! Damage to the target, and the work of cutting a whole blank, as findings of any process.

use super::{Place, Quantity, Section};
use crate::measure::damage::{Damage, LEAST_DEPTH_MM};

/// All places of one kind of damage together; each of them is a row of `tables/damage.csv`.
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
    let depth = "largest depth along the normal; at its place the height over the pitch curve and the distance from \
                 the middle of the face";
    let deepest = places.iter().max_by(|a, b| a.depth_mm.total_cmp(&b.depth_mm)).map(|d| {
        let place = Place::default()
            .and("tooth", d.place.tooth)
            .and("flank", d.place.side.name())
            .and("zone", d.place.zone.name())
            .and("height_mm", d.place.height_mm)
            .and("lead_mm", d.z_mm);
        Quantity::number(d.depth_mm, "mm", depth).at(made_by(place, d))
    });
    let count = places.len() as u64;
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
                "mm3",
                "volume, all places together",
            ),
        )
}

/// Pairs of ray and pass that the native backend counts.
pub fn pairs(count: u64, definition: &'static str) -> Quantity {
    if count > 0 {
        Quantity::count(count, "pairs", definition)
    } else {
        Quantity::undefined("pairs", definition, "the GPU does not count them")
    }
}
