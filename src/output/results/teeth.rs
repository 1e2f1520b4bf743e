//! What stands in `results.json` for every tooth: the stock an operation left on it, and the tooth as it is finished.

use serde::{Deserialize, Serialize};

use crate::output::quantity::Quantity;

/// What an operation left on one tooth over the finished surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OperationTooth {
    /// Tooth, from 1.
    pub index: u32,
    /// Stock on the left flank (larger arc).
    pub left: StockRange,
    /// Stock on the right flank (smaller arc).
    pub right: StockRange,
    /// Allowance of the left flank: chord on the pitch curve from A (this operation) to B (finished).
    #[serde(rename = "AB")]
    pub ab: Quantity,
    /// Allowance of the right flank: chord on the pitch curve from C (finished) to D (this operation).
    #[serde(rename = "CD")]
    pub cd: Quantity,
    /// |AB - CD| divided by the mean of AB and CD.
    pub unevenness_mean_denominator: Quantity,
    /// |AB - CD| divided by delta_d tan(alpha).
    pub unevenness_rack_denominator: Quantity,
    /// AB in the limit of many strokes.
    #[serde(rename = "envelope_AB")]
    pub envelope_ab: Quantity,
    /// CD in the limit of many strokes.
    #[serde(rename = "envelope_CD")]
    pub envelope_cd: Quantity,
}

/// Extremes and mean of a stock.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StockRange {
    /// Smallest, with its place.
    pub smallest: Quantity,
    /// Largest, with its place.
    pub largest: Quantity,
    /// Mean over the dexels.
    pub mean: Quantity,
}

/// One finished tooth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FinishedTooth {
    /// Tooth, from 1.
    pub index: u32,
    /// Left flank (larger arc).
    pub left: FinishedFlank,
    /// Right flank (smaller arc).
    pub right: FinishedFlank,
    /// Width of the tip between the flanks.
    pub tip_land: Quantity,
    /// Thickness along the pitch curve.
    pub thickness_arc: Quantity,
    /// Thickness straight from flank to flank on the pitch curve.
    pub thickness_chord: Quantity,
}

/// One finished flank.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FinishedFlank {
    /// Start of the involute, as height over the pitch curve.
    pub start_of_involute: Quantity,
    /// What begins there: `cutter corner` or `undercut`.
    pub start: Quantity,
    /// Where the flank ends, as height over the pitch curve.
    pub tip: Quantity,
    /// What ends it: `blank outline`, `cutter base`, `pointed tip` or `undercut`.
    pub end: Quantity,
    /// Length of the profile from start to tip.
    pub length: Quantity,
    /// Arc from the start at which the evaluated profile begins.
    pub evaluated_from: Quantity,
    /// Arc from the start at which it ends.
    pub evaluated_to: Quantity,
    /// Lowest height over the target on the evaluated profile, with its place.
    pub smallest_height: Quantity,
    /// Largest height over the target on the evaluated profile, with its place.
    pub largest_height: Quantity,
    /// Deepest cut below the target anywhere on the flank; undefined if there is none.
    pub deepest_cut: Quantity,
    /// Profile against the target in the middle of the face, in the manner of ISO 1328-1.
    pub profile: ProfileDeviations,
    /// Highest feed mark on the evaluated profile.
    pub largest_scallop: Quantity,
    /// Feed mark nearest to the pitch curve.
    pub scallop_at_pitch_curve: Quantity,
    /// Step that the first and last strokes stand above the rest of the flank.
    pub witness_mark: Quantity,
    /// Single pitch deviation f_p from the tooth before, arc on the pitch curve.
    pub single_pitch: Quantity,
    /// Cumulative pitch deviation F_p from tooth 1, arc on the pitch curve.
    pub cumulative_pitch: Quantity,
    /// Dexels cut deeper than their rays record.
    pub below_range_dexels: Quantity,
    /// Dexels that no pass touched.
    pub untouched_dexels: Quantity,
}

/// Profile deviations between the evaluated ends; no tolerance class exists for a non-circular gear.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProfileDeviations {
    /// F_alpha.
    pub total: Quantity,
    /// f_f alpha.
    pub form: Quantity,
    /// f_H alpha, positive where material is left towards the tip.
    pub slope: Quantity,
}
