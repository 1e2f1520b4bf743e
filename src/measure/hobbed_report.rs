//! Everything measured on one hobbed flank after all operations.
//!
//! In: the cut flank. Out: [`HobbedReport`]: where the flank begins, heights over the target on the evaluated part, stock of earlier operations, profile and helix deviations.
//!
//! The evaluated part leaves out a twentieth at both ends of profile and face. Profile deviations are those of the middle row, helix deviations those of the middle
//! column (ISO 1328-1:2013: F_alpha and F_beta total, f_H slope, f_f form), along the target's local normals: on a gear that is not round the target takes the place of the design helix.

use super::deviation::{TraceDeviation, of_points};
use crate::dexel::NO_PASS;
use crate::gear::generation::Side;
use crate::job::HobbedFlank;
use std::ops::Range;

/// Share of profile and face left out at either end.
const MARGIN: f64 = 0.05;

/// Heights over many dexels, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heights {
    /// Lowest.
    pub lowest_mm: f64,
    /// Highest.
    pub highest_mm: f64,
    /// Arithmetic mean.
    pub mean_mm: f64,
    /// Root mean square about the mean: Sq of the marks where the form is exact (ISO 25178-2).
    pub rms_mm: f64,
}

/// One hobbed flank, measured.
#[derive(Debug, Clone, PartialEq)]
pub struct HobbedReport {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Flank.
    pub side: Side,
    /// Where the field begins: height over the pitch curve of the highest start of the involute in any section, mm.
    pub form_height_mm: f64,
    /// Whether the hob's tip corner has undercut the flank in any section.
    pub undercut: bool,
    /// Length of the profile in the middle of the face, mm.
    pub length_mm: f64,
    /// Finished surface over the target; `None` where a dexel of the evaluated part was not reached.
    pub finished: Option<Heights>,
    /// What each earlier operation left over the finished surface.
    pub stock: Vec<Option<Heights>>,
    /// Profile deviations in the middle of the face.
    pub profile: Option<TraceDeviation>,
    /// Helix deviations in the middle of the profile.
    pub helix: Option<TraceDeviation>,
    /// Dexels of the evaluated part that no pass reached. (On the tip's own edge the blank ends where the target does.)
    pub untouched: u64,
}

/// Measures a cut flank.
pub fn measure(tooth: u32, side: Side, flank: &HobbedFlank) -> HobbedReport {
    let [columns, rows] = [flank.rays.arcs_mm.len(), flank.rays.leads_mm.len()].map(inner);
    let finished = flank.layers.last().expect("at least one operation");
    let dexels = || {
        let rows = rows.clone();
        columns.clone().flat_map(move |column| rows.clone().map(move |row| flank.rays.field.index(column, row)))
    };
    let over = |height: &dyn Fn(usize) -> Option<f64>| {
        let values: Option<Vec<f64>> = dexels().map(height).collect();
        values.filter(|v| !v.is_empty()).map(|v| heights(&v))
    };
    let at = |layer: usize, i: usize| {
        let layer = &flank.layers[layer];
        (layer.passes[i] != NO_PASS).then(|| f64::from(layer.heights_mm[i]))
    };
    let last = flank.layers.len() - 1;
    let line = |points: Vec<(f64, Option<f64>)>| {
        let points: Option<Vec<(f64, f64)>> =
            points.into_iter().map(|(place, height)| Some((place, height?))).collect();
        of_points(&points?)
    };
    let (middle_column, middle_row) = (flank.rays.arcs_mm.len() / 2, flank.rays.leads_mm.len() / 2);
    let profile =
        columns.clone().map(|c| (flank.rays.arcs_mm[c], at(last, flank.rays.field.index(c, middle_row)))).collect();
    let helix =
        rows.clone().map(|r| (flank.rays.leads_mm[r], at(last, flank.rays.field.index(middle_column, r)))).collect();
    HobbedReport {
        tooth,
        side,
        form_height_mm: flank.target.form_height_mm,
        undercut: flank.target.undercut,
        length_mm: flank.rays.arcs_mm.last().copied().unwrap_or(0.0),
        finished: over(&|i| at(last, i)),
        stock: (0..last).map(|layer| over(&|i| Some(at(layer, i)? - at(last, i)?))).collect(),
        profile: line(profile),
        helix: line(helix),
        untouched: dexels().filter(|&i| finished.passes[i] == NO_PASS).count() as u64,
    }
}

/// Ends of the evaluated part of a length, mm.
pub fn evaluated_mm([from_mm, to_mm]: [f64; 2]) -> [f64; 2] {
    let margin_mm = MARGIN * (to_mm - from_mm);
    [from_mm + margin_mm, to_mm - margin_mm]
}

/// Indices without the margins.
fn inner(count: usize) -> Range<usize> {
    let margin = (MARGIN * count as f64).ceil() as usize;
    margin..count.saturating_sub(margin).max(margin)
}

fn heights(values: &[f64]) -> Heights {
    let count = values.len() as f64;
    let mean_mm = values.iter().sum::<f64>() / count;
    Heights {
        lowest_mm: values.iter().copied().fold(f64::INFINITY, f64::min),
        highest_mm: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        mean_mm,
        rms_mm: (values.iter().map(|v| (v - mean_mm).powi(2)).sum::<f64>() / count).sqrt(),
    }
}
