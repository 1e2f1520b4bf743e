//! Everything measured on one hobbed flank after all operations.
//!
//! In: the cut flank. Out: [`HobbedReport`]: where the flank begins, normal deviations on the evaluated part,
//! stock of earlier operations, profile and helix deviations.
//!
//! The evaluated part of the profile is the scene's `[measure]`: between two heights over the pitch curve, in the
//! middle of the face. Where it names none, and along the face, a twentieth is left out at both ends. Profile
//! deviations are those of the middle row, helix deviations those of the middle column (ISO 1328-1:2013: F_alpha and
//! F_beta total, f_H slope, f_f form), along the target's local normals in space: on a gear that is not round the
//! target takes the place of the design helix, and on a helical gear the standard's figures in the transverse section
//! are these over cos(beta_b). Profiles stand over the roll, as the standard's do: over the place of the contact on the
//! line of action.

use crate::measure::deviation::Trace;
use crate::measure::inspection::{FlankSurface, InspectedFlank, StockRange, SurfaceHeights, TracedLines};
use crate::measure::stock::Extreme;
use crate::process::hobbing::HobbedFlank;
use gearcut_core::dexel::NO_PASS;
use gearcut_core::terms::Side;
use std::ops::Range;

/// Share of profile and face left out at either end.
const MARGIN: f64 = 0.05;

/// Rounding of places, mm: a dexel so near to an end of the evaluated part belongs to it.
const PLACE_MM: f64 = 1e-9;

/// One hobbed flank, measured: profiles stand over the place on the line of action
/// ([`crate::process::hobbing::flank_patch::FlankPatch::roll_mm`]), the line along the tooth runs in the
/// middle of the profile, and dexels of the evaluated part count as untouched. (On the tip's own edge the blank ends
/// where the target does.)
pub type HobbedReport = InspectedFlank<HobbedSurface>;

/// What is measured on hobbed flanks alone.
#[derive(Debug, Clone, PartialEq)]
pub struct HobbedSurface {
    /// Where the field begins: height over the pitch curve of the highest start of the involute in any section, mm.
    pub form_height_mm: f64,
    /// Whether the hob's tip corner has undercut the flank in any section.
    pub undercut: bool,
    /// Normal deviations of the finished surface; `None` where a dexel of the evaluated part was not reached.
    pub finished: Option<SurfaceHeights>,
    /// What each earlier operation left over the finished surface.
    pub stock: Vec<Option<SurfaceHeights>>,
}

impl FlankSurface for HobbedSurface {
    fn deviations(&self) -> Option<[Extreme; 2]> {
        self.finished.map(|of| of.ends)
    }

    fn stock(&self, operation: usize) -> Option<StockRange> {
        (*self.stock.get(operation)?).map(|of| of.stock())
    }
}

/// Measures a cut flank.
pub fn measure(tooth: u32, side: Side, flank: &HobbedFlank) -> HobbedReport {
    let (arcs_mm, rows_z_mm) = (&flank.rays.arcs_mm, &flank.rays.rows_z_mm);
    let [columns, rows] = [arcs_mm.len(), rows_z_mm.len()].map(inner);
    let columns = between(arcs_mm, columns, flank.measured_ends_mm);
    let finished = flank.layers.last().expect("at least one operation");
    let dexels = || {
        let rows = rows.clone();
        columns.clone().flat_map(move |column| rows.clone().map(move |row| flank.rays.field.index(column, row)))
    };
    let over = |height: &dyn Fn(usize) -> Option<f64>| {
        let placed = |(k, i): (usize, usize)| {
            let [arc_mm, z_mm] = [arcs_mm[columns.start + k / rows.len()], rows_z_mm[rows.start + k % rows.len()]];
            Some(Extreme { value_mm: height(i)?, arc_mm, z_mm })
        };
        dexels().enumerate().map(placed).collect::<Option<Vec<_>>>().and_then(|values| SurfaceHeights::of(&values))
    };
    let at = |layer: usize, i: usize| {
        let layer = &flank.layers[layer];
        (layer.passes[i] != NO_PASS).then(|| f64::from(layer.heights_mm[i]))
    };
    let last = flank.layers.len() - 1;
    let trace = |places_mm: &[f64], index: &dyn Fn(usize) -> usize| Trace {
        places_mm: places_mm.to_vec(),
        heights_mm: (0..places_mm.len()).map(|i| at(last, index(i)).unwrap_or(f64::NAN)).collect(),
    };
    let (middle_column, middle_row) = (arcs_mm.len() / 2, rows_z_mm.len() / 2);
    let rolls_mm: Vec<f64> = arcs_mm.iter().map(|&arc| flank.target.roll_mm(arc)).collect();
    let profile_trace = trace(&rolls_mm, &|column| flank.rays.field.index(column, middle_row));
    let helix_trace = trace(rows_z_mm, &|row| flank.rays.field.index(middle_column, row));
    // The places of the inner dexels themselves, so that rounding takes none of them away.
    let ends = |places_mm: &[f64], inner: Range<usize>| [places_mm[inner.start], places_mm[inner.end - 1]];
    let deviation = |trace: &Trace, inner: Range<usize>| {
        if inner.is_empty() { None } else { trace.deviation(ends(&trace.places_mm, inner)) }
    };
    InspectedFlank {
        tooth,
        side,
        length_mm: arcs_mm.last().copied().unwrap_or(0.0),
        evaluated_mm: evaluated_mm(flank.target.length_mm(), flank.measured_ends_mm),
        profile: deviation(&profile_trace, columns.clone()),
        lines: TracedLines {
            arcs_mm: arcs_mm.clone(),
            profile_v_mm: rows_z_mm[middle_row],
            lead_arc_mm: arcs_mm[middle_column],
        },
        profile_trace,
        lead: deviation(&helix_trace, rows.clone()),
        lead_trace: helix_trace,
        untouched: dexels().filter(|&i| finished.passes[i] == NO_PASS).count() as u64,
        own: HobbedSurface {
            form_height_mm: flank.target.form_height_mm,
            undercut: flank.target.undercut,
            finished: over(&|i| at(last, i)),
            stock: (0..last).map(|layer| over(&|i| Some(at(layer, i)? - at(last, i)?))).collect(),
        },
    }
}

/// Ends of the evaluated part of a profile, mm: the scene's, where it names them.
pub fn evaluated_mm(length_mm: f64, [from_mm, to_mm]: [Option<f64>; 2]) -> [f64; 2] {
    let margin_mm = MARGIN * length_mm;
    [from_mm.unwrap_or(margin_mm), to_mm.unwrap_or(length_mm - margin_mm)]
}

/// Indices of places between the ends that are named, else of `inner`.
fn between(places_mm: &[f64], inner: Range<usize>, [from_mm, to_mm]: [Option<f64>; 2]) -> Range<usize> {
    let before = |end_mm: f64| places_mm.partition_point(|&place_mm| place_mm < end_mm);
    let start = from_mm.map_or(inner.start, |mm| before(mm - PLACE_MM));
    start..to_mm.map_or(inner.end, |mm| before(mm + PLACE_MM)).max(start)
}

/// Indices without the margins.
fn inner(count: usize) -> Range<usize> {
    let margin = (MARGIN * count as f64).ceil() as usize;
    margin..count.saturating_sub(margin).max(margin)
}
