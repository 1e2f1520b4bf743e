//! The whole gear from rays through the blank, on the page: volumes, gouges, interference, rubbing.

use super::quantities;
use crate::findings::quantities::OPERATIONS;
use crate::findings::quantities::blank::{
    BLANK, BLANK_VOLUME, DEEPEST, GOUGE_FROM, LEFT_VOLUME, PLACES, SECTION_AREA, TARGET_AREA, VOLUME,
};
use crate::findings::quantities::cutting::REMOVED_VOLUME;
use crate::findings::{Findings, Place, Quantity, QuantityRow, Section, unit};
use crate::output::report::{Block, PageSection, PageTable, Tone};

/// Quantities of the whole that say what was made; how the rays stand is a matter of `results.json`.
static OF_THE_GEAR: [&QuantityRow; 5] = [&BLANK_VOLUME, &LEFT_VOLUME, &SECTION_AREA, &TARGET_AREA, &GOUGE_FROM];

/// The section; none where the whole blank was not cut.
pub fn section(found: &Findings) -> Option<PageSection> {
    let blank = found.group(&BLANK)?;
    let shown = blank.entries.iter().filter(|entry| OF_THE_GEAR.iter().any(|row| row.key == entry.key));
    let removed = blank.group(&OPERATIONS).map_or(&[][..], |operations| &operations.sections);
    let volumes =
        shown.map(|entry| row(&entry.heading(), &entry.quantity)).chain(removed.iter().filter_map(|operation| {
            let volume = operation.of(&REMOVED_VOLUME)?;
            Some(row(&format!("Removed by {}", operation.key), volume))
        }));
    let volumes = PageTable {
        caption: "Volumes and strokes".to_owned(),
        columns: ["", "Value", "What it is"].map(str::to_owned).into(),
        rows: volumes.collect(),
    };
    let damage: Vec<Vec<String>> = blank.sections.iter().filter_map(damage_row).collect();
    let damage = (!damage.is_empty()).then(|| {
        Block::Table(PageTable {
            caption: "Where material was taken that should have stayed".to_owned(),
            columns: ["", "Sides of teeth", "Deepest", "At", "Volume"].map(str::to_owned).into(),
            rows: damage,
        })
    });
    let found_places = |part: &&Section| part.of(&DEEPEST).is_some() && part.value(&PLACES) > Some(0.0);
    let damaged: Vec<String> =
        blank.sections.iter().filter(found_places).map(|part| part.title.to_lowercase()).collect();
    let (tone, words) = if damaged.is_empty() {
        (Tone::Fine, "nothing was taken that should have stayed".to_owned())
    } else {
        (Tone::Wrong, damaged.join(", "))
    };
    Some(
        PageSection::new(
            "blank",
            "The whole gear",
            "Rays through the whole blank: what was taken, what is left, and where the tool took what should have \
            stayed (tables/damage.csv has every place; results.json the directions of the rays).",
            std::iter::once(Block::Table(volumes)).chain(damage).collect(),
        )
        .judged(tone, words),
    )
}

fn row(name: &str, quantity: &Quantity) -> Vec<String> {
    let what = quantity.why().unwrap_or(quantity.definition());
    vec![unit::sentence_with_signs(name), quantities::value_with_unit(quantity), unit::sentence_with_signs(what)]
}

/// How many, how deep, where, how much; none for a part that is no damage.
fn damage_row(part: &Section) -> Option<Vec<String>> {
    let deepest = part.of(&DEEPEST)?;
    let place = deepest.place().map(Place::words_with_signs);
    let place = place.or_else(|| deepest.why().map(str::to_owned)).unwrap_or_default();
    let places = part.of(&PLACES).map_or_else(String::new, quantities::value_alone);
    let volume = part.of(&VOLUME).map_or_else(String::new, quantities::value_with_unit);
    Some(vec![part.title.clone(), places, quantities::value_with_unit(deepest), place, volume])
}
