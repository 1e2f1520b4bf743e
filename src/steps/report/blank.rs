//! The whole gear from rays through the blank, on the page: volumes, gouges, interference, rubbing.

use super::quantities;
use crate::findings::{Findings, Place, Quantity, Section, unit};
use crate::output::report::{Block, PageSection, PageTable};

/// Quantities of the whole that say what was made; how the rays stand is a matter of `results.json`.
const OF_THE_GEAR: [&str; 5] = ["blank_volume", "left_volume", "end_face_area", "target_end_face_area", "gouge_from"];

/// The section; none where the whole blank was not cut.
pub fn section(found: &Findings) -> Option<PageSection> {
    let blank = found.find("blank")?;
    let shown = blank.entries.iter().filter(|entry| OF_THE_GEAR.contains(&entry.key.as_str()));
    let removed = blank.find("operations").map_or(&[][..], |operations| &operations.sections);
    let volumes =
        shown.map(|entry| row(&entry.heading(), &entry.quantity)).chain(removed.iter().filter_map(|operation| {
            let volume = operation.quantity("removed_volume")?;
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
    Some(PageSection {
        id: "blank",
        title: "The whole gear".to_owned(),
        lead: "Rays through the whole blank: what was taken, what is left, and where the tool took what should have \
            stayed (tables/damage.csv has every place; results.json how the rays stand)."
            .to_owned(),
        blocks: std::iter::once(Block::Table(volumes)).chain(damage).collect(),
    })
}

fn row(name: &str, quantity: &Quantity) -> Vec<String> {
    let what = quantity.why().unwrap_or(quantity.definition());
    vec![unit::sentence_with_signs(name), quantities::value_with_unit(quantity), unit::sentence_with_signs(what)]
}

/// How many, how deep, where, how much; none for a part that is no damage.
fn damage_row(part: &Section) -> Option<Vec<String>> {
    let deepest = part.quantity("deepest")?;
    let value = |key: &str| part.quantity(key).map_or_else(String::new, quantities::value_with_unit);
    let place = deepest.place().map(Place::words_with_signs);
    let place = place.or_else(|| deepest.why().map(str::to_owned)).unwrap_or_default();
    let places = part.quantity("places").map_or_else(String::new, quantities::value_alone);
    Some(vec![part.title.clone(), places, quantities::value_with_unit(deepest), place, value("volume")])
}
