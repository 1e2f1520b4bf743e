//! What stands in `results.json` for every tooth.

use serde::{Deserialize, Serialize};

use crate::output::quantity::Quantity;

/// Target of one tooth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TargetTooth {
    /// Tooth, from 1.
    pub index: u32,
    /// Left flank (larger arc).
    pub left: TargetFlankResults,
    /// Right flank (smaller arc).
    pub right: TargetFlankResults,
    /// Width of the tip between the flanks.
    pub tip_land: Quantity,
}

/// Ends of one target flank.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TargetFlankResults {
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
}

/// What an operation left on one tooth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ToothResults {
    /// Tooth, from 1.
    pub index: u32,
    /// Left flank (larger arc).
    pub left: FlankResults,
    /// Right flank (smaller arc).
    pub right: FlankResults,
    /// Allowance of the left flank, chord on the pitch curve from A (this operation) to B (last operation).
    #[serde(rename = "AB")]
    pub ab: Quantity,
    /// Allowance of the right flank, chord on the pitch curve from C (last operation) to D (this operation).
    #[serde(rename = "CD")]
    pub cd: Quantity,
    /// |AB - CD| divided by the mean of AB and CD.
    pub unevenness_mean_denominator: Quantity,
    /// |AB - CD| divided by delta_d tan(alpha).
    pub unevenness_rack_denominator: Quantity,
    /// Tooth thickness, arc on the pitch curve.
    pub thickness: Quantity,
}

/// What an operation left on one flank.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FlankResults {
    /// Lowest height over the target, with its place.
    pub smallest_height: Quantity,
    /// Largest height over the target, with its place.
    pub largest_height: Quantity,
    /// Mean height over the target.
    pub mean_height: Quantity,
    /// Root mean square of the heights about their mean.
    pub rms_height: Quantity,
    /// Dexels that no pass touched.
    pub untouched_dexels: Quantity,
    /// Highest feed mark.
    pub scallop_height: Quantity,
    /// Profile against the target along its normal, in the manner of ISO 1328-1.
    pub profile: ProfileDeviations,
    /// Single pitch deviation f_p from the neighbouring tooth, arc on the pitch curve.
    pub single_pitch: Quantity,
    /// Cumulative pitch deviation F_p from tooth 1.
    pub cumulative_pitch: Quantity,
}

/// Profile deviations between the evaluated heights; no tolerance class exists for a non-circular gear.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProfileDeviations {
    /// F_alpha.
    pub total: Quantity,
    /// f_f alpha.
    pub form: Quantity,
    /// f_H alpha, positive where the profile rises towards the tip.
    pub slope: Quantity,
}
