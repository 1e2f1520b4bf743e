//! Maps of flanks as quantities of a case: the finished flank at so many places along its profile and its tooth.
//!
//! In: which flank, how many places. Out: a section of findings with one number for each place. Places are those at
//! which influences are looked at (`crate::influence::gear_grid`): evenly over the evaluated part of the profile and
//! over the face without a twentieth at either end, so that a row of a study is what `gearcut diagnose` reads. A map of
//! one place along the tooth is a profile, of one along the profile a helix.

use super::quantities::{MAP, MAP_HEIGHT, NO_PASS_THERE};
use crate::findings::{Findings, Section};
use crate::influence::gear_grid::FlankGrid;
use crate::job::GearJob;
use gearcut_core::cut::Backend;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::terms::Side;

/// Most places along either direction.
const MOST_PLACES: usize = 1000;

/// A map of a flank.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FlankMap {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Which of its flanks.
    pub side: Side,
    /// Places along the profile, from the form point to the tip, and along the tooth.
    pub places: [usize; 2],
}

impl FlankMap {
    /// Checked.
    ///
    /// # Errors
    /// In words: numbers of places that are none.
    pub fn new(tooth: u32, side: Side, places: [usize; 2]) -> Result<Self, String> {
        if tooth > 0 && places.iter().all(|count| (1..=MOST_PLACES).contains(count)) {
            return Ok(Self { tooth, side, places });
        }
        Err(format!("teeth count from 1, and a map has 1 to {MOST_PLACES} places along profile and tooth"))
    }

    /// Key of its section.
    fn key(self) -> String {
        format!("tooth_{:02}_{}", self.tooth, self.side.name())
    }

    /// Paths of its numbers, row by row along the tooth, in each from the form point to the tip.
    pub fn paths(self) -> impl Iterator<Item = String> {
        let [columns, rows] = self.places;
        (0..rows).flat_map(move |row| {
            (0..columns).map(move |column| format!("{}.{}.{}", MAP.key, self.key(), self.place(column, row)))
        })
    }

    /// Key of a place: two numbers of as many digits as the largest ones need.
    fn place(self, column: usize, row: usize) -> String {
        let [columns, rows] = self.places.map(|count| (count - 1).to_string().len());
        format!("u{column:0columns$}_v{row:0rows$}")
    }

    fn section(self, gear: &dyn GearJob, backend: &dyn Backend) -> Result<Section> {
        let Self { tooth, side, places } = self;
        let teeth = gear.scene().gear.teeth;
        if tooth > teeth {
            let problem = format!("a map is of tooth {tooth}, and the gear has {teeth}");
            return Err(Refusal::new("gear.teeth", problem, "take a tooth that all cases have").into());
        }
        let grid = FlankGrid::inspected(gear, tooth, side, places)?;
        let heights_um = grid.heights_um(gear, backend)?;
        let [columns, rows] = places;
        let entries = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        let entries = entries.map(|(column, row)| {
            let height_um = Some(heights_um[grid.index(column, row)]).filter(|um| um.is_finite());
            let remark = format!(
                ": place {} of {columns} from the form point to the tip, {} of {rows} along the tooth",
                column + 1,
                row + 1
            );
            MAP_HEIGHT.of_or(height_um, NO_PASS_THERE).keyed(self.place(column, row)).remarked(&remark)
        });
        let title = format!("Tooth {tooth} {}", side.name());
        Ok(Section::new(self.key(), title).entries(entries))
    }
}

/// Adds maps to the findings of a gear.
///
/// # Errors
/// A tooth that the gear does not have; the tool generates no flank there; the backend's.
pub fn add(found: &mut Findings, gear: &dyn GearJob, maps: &[FlankMap], backend: &dyn Backend) -> Result<()> {
    let sections = maps.iter().map(|map| map.section(gear, backend)).collect::<Result<Vec<_>>>()?;
    found.sections.push(Section::new(MAP.key, MAP.title).parts(sections));
    Ok(())
}

/// Whether a path is that of a place on a map.
pub fn is_of_map(path: &str) -> bool {
    path.strip_prefix(MAP.key).is_some_and(|rest| rest.starts_with('.'))
}
