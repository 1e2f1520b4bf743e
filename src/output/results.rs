//! The layout of `results.json`: what a run found, headline numbers first.
//!
//! In: measured quantities, filled in by the run. Out: the file, and the same structs again when results are compared.
//!
//! The rules: every value is a [`Quantity`] with unit and definition; what does not exist is null with its reason and never
//! left out, so that all results of one schema version have the same keys. A change of keys or meanings raises
//! [`SCHEMA_VERSION`]; new keys that old readers may overlook do not.
//!
//! Two measures are told apart everywhere. A **height** stands over the target, the envelope of the last operation. A **stock**
//! is what an operation leaves over the finished surface. Both run along the target's normal, positive where material is.

mod blank;
mod chips;
mod hob_load;
mod hobbed;
mod machine;
mod teeth;
mod texture;

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::atomic::write_bytes_atomically;
use super::quantity::Quantity;
use crate::{Error, Result};
pub use blank::{BlankOperationResults, BlankResults, DamageResults};
pub use chips::{ChipPeak, ChipResults};
pub use hob_load::{HobLoadResults, OperationLoadResults, ToothLoadResults};
pub use hobbed::{HobbedOperationResults, HobbedResults, MarkResults};
pub use machine::{AxesResults, AxisPeak, ReliefResults};
pub use teeth::{FinishedFlank, FinishedTooth, OperationTooth, ProfileDeviations, StockRange};
pub use texture::{AbbottCurve, Parameters, TextureResults};

/// Version of the layout.
pub const SCHEMA_VERSION: u32 = 1;
/// Name of the file in an output folder.
pub const RESULTS_FILE: &str = "results.json";

/// Everything a run found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// [`SCHEMA_VERSION`] of the program that wrote the file.
    pub schema_version: u32,
    /// `gearcut`.
    pub program: String,
    /// Version of the program.
    pub program_version: String,
    /// Name of the scene.
    pub scene: String,
    /// Whether all flanks were cut; false after Ctrl-C, when the numbers cover the finished flanks only.
    pub complete: bool,
    /// Teeth after which the pitch curve repeats: the first period of tables and charts.
    pub period_teeth: u32,
    /// What to look at first.
    pub headline: Headline,
    /// What each operation did and left over the finished gear, in order.
    pub operations: Vec<OperationResults>,
    /// The whole gear: volumes, damage, rubbing; null after Ctrl-C, and in files of older programs left out.
    #[serde(default)]
    pub blank: Option<BlankResults>,
    /// The finished gear, tooth by tooth.
    pub teeth: Vec<FinishedTooth>,
    /// Surface texture of windows on flanks, after every operation; absent in results of programs before texture.
    #[serde(default)]
    pub texture: Vec<TextureResults>,
}

/// The numbers that a gear engineer asks for first. Extremes over flanks carry their place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Headline {
    /// Smallest stock that the last operation finds on an active flank; undefined with a single operation.
    pub smallest_normal_stock: Quantity,
    /// Largest stock that the last operation finds on an active flank.
    pub largest_normal_stock: Quantity,
    /// Start of the involute: the highest one of all flanks, as height over the pitch curve (mostly negative).
    pub start_of_involute: Quantity,
    /// Number of flanks that are undercut.
    pub undercut_flanks: Quantity,
    /// Narrowest tip land.
    pub tip_land: Quantity,
    /// Number of teeth that are pointed below the blank's outline.
    pub pointed_teeth: Quantity,
    /// Highest feed mark that the last operation leaves on an evaluated profile.
    pub scallop_height: Quantity,
    /// Smallest tooth thickness after the last operation, arc on the pitch curve.
    pub smallest_tooth_thickness: Quantity,
    /// Largest tooth thickness after the last operation.
    pub largest_tooth_thickness: Quantity,
    /// Highest step that the first and last strokes of the last operation leave.
    pub witness_mark: Quantity,
    /// What is left of the tightest axis limit, as a share of it; undefined without limits.
    pub axis_margin: Quantity,
    /// Smallest relief clearance on the return stroke, as a share of a circular gear's.
    pub relief_ratio: Quantity,
    /// Time of all strokes.
    pub cycle_time: Quantity,
    /// Largest section of all chips of a stroke, over all operations.
    pub largest_chip_section: ChipPeak,
    /// Largest cutting force along the stroke.
    pub largest_cutting_force: ChipPeak,
    /// Largest cutting force of a first stroke at full depth without infeed.
    pub entry_cutting_force: Quantity,
    /// Volume taken away over the time of all strokes.
    pub removal_rate: Quantity,
    /// Strokes that cut nothing.
    pub idle_strokes: Quantity,
    /// Largest unevenness of the stock that the last operation finds (denominator: mean of AB and CD).
    pub unevenness_max: Quantity,
    /// Mean of that unevenness over the teeth.
    pub unevenness_mean: Quantity,
}

/// One operation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OperationResults {
    /// Name in the scene.
    pub name: String,
    /// Linkage in words.
    pub linkage: String,
    /// delta_d in force, thickness allowance included.
    pub offset: Quantity,
    /// Strokes made, plunging ones included.
    pub strokes: Quantity,
    /// Mean arc of pitch curve per double stroke.
    pub circular_feed: Quantity,
    /// Time of the operation.
    pub cycle_time: Quantity,
    /// Peaks of the axes against their limits.
    pub axes: AxesResults,
    /// Clearance on the return stroke.
    pub relief: ReliefResults,
    /// Chips and cutting forces.
    pub chips: ChipResults,
    /// Stock on all active flanks; undefined for the last operation.
    pub flank_stock: StockRange,
    /// Stock in all roots, which only the cutter's tip touches.
    pub root_stock: StockRange,
    /// Unevenness of its allowance over the teeth.
    pub unevenness: Unevenness,
    /// Stock and allowance of each tooth; empty for the last operation.
    pub teeth: Vec<OperationTooth>,
}

/// Unevenness of an operation's allowance: of what was cut, and of its envelope (the limit of many strokes).
/// The last operation has no allowance: everything is undefined there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Unevenness {
    /// |AB - CD| divided by the mean of AB and CD.
    pub mean_denominator: Spread,
    /// |AB - CD| divided by delta_d tan(alpha).
    pub rack_denominator: Spread,
    /// As `mean_denominator`, of the envelope.
    pub envelope_mean_denominator: Spread,
    /// As `rack_denominator`, of the envelope.
    pub envelope_rack_denominator: Spread,
}

/// Largest and mean value over the teeth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Largest.
    pub max: Quantity,
    /// Arithmetic mean.
    pub mean: Quantity,
}

/// The results of a run, whichever process it was.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyResults {
    /// A shaped gear.
    Shaped(Box<Results>),
    /// A hobbed gear.
    Hobbed(Box<HobbedResults>),
}

impl AnyResults {
    /// Reads the results of a run from its output folder, or from the file itself.
    ///
    /// # Errors
    /// No such file, another schema version, or a file that is not of this layout.
    pub fn read(path: &Path) -> Result<Self> {
        let file = if path.is_dir() { path.join(RESULTS_FILE) } else { path.to_owned() };
        let bytes = std::fs::read(&file).map_err(Error::reading(&file))?;
        let refuse = |reason: String| Error::Unreadable { path: file.clone(), reason };
        let document: serde_json::Value =
            serde_json::from_slice(&bytes).map_err(|reason| refuse(format!("it is not JSON: {reason}")))?;
        match document.get("schema_version").and_then(serde_json::Value::as_u64) {
            Some(version) if version == u64::from(SCHEMA_VERSION) => {}
            Some(version) => {
                return Err(refuse(format!(
                    "it has schema version {version}, this gearcut reads {SCHEMA_VERSION}; cut the scene again"
                )));
            }
            None => return Err(refuse("it has no schema_version: it is not a gearcut result".to_owned())),
        }
        // Results of shaping name no process.
        let read = match document.get("process").and_then(serde_json::Value::as_str) {
            Some("hobbing") => serde_json::from_value(document).map(|hobbed| Self::Hobbed(Box::new(hobbed))),
            _ => serde_json::from_value(document).map(|shaped| Self::Shaped(Box::new(shaped))),
        };
        read.map_err(|reason| refuse(format!("it is not a complete result: {reason}")))
    }

    /// The process in words.
    pub fn process(&self) -> &'static str {
        match self {
            Self::Shaped(_) => "shaping",
            Self::Hobbed(_) => "hobbing",
        }
    }

    /// Whether all flanks were cut.
    pub fn is_complete(&self) -> bool {
        match self {
            Self::Shaped(results) => results.complete,
            Self::Hobbed(results) => results.complete,
        }
    }
}

impl Results {
    /// The text of the file.
    ///
    /// # Errors
    /// Never for results of this layout; the writer's reason if it should.
    pub fn write(&self, path: &Path) -> Result<()> {
        let refused = |reason: serde_json::Error| Error::Output { path: path.to_owned(), reason: reason.to_string() };
        let text = serde_json::to_string_pretty(self).map_err(refused)?;
        write_bytes_atomically(path, format!("{text}\n").as_bytes())
    }

    /// The last operation that leaves an allowance, whose unevenness the headline names.
    pub fn last_with_allowance(&self) -> Option<&OperationResults> {
        self.operations.iter().rev().find(|operation| operation.unevenness.mean_denominator.max.value().is_some())
    }
}
