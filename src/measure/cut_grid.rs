//! A cut flank as a grid of dexels: its evaluated part, and what an inspector traces there, whatever process cut it.
//!
//! In: places of columns and rows, what each operation left, the ends of the evaluated part. Out: [`CutGrid`], which
//! gives the heights of the evaluated part and the two traces as an [`InspectedFlank`].
//!
//! A twentieth of the profile and of the face is left out at either end ([`evaluated_mm`]) unless a scene names the
//! ends; dexels are evaluated where they stand between the ends. The profile runs in the middle row, the line along the
//! tooth in the middle column.
//!
//! Shaped flanks are alike along the tooth and keep columns in place of layers; they have traces of their own.

use super::deviation::Trace;
use super::inspection::{InspectedFlank, SurfaceHeights, TracedLines};
use super::stock::Extreme;
use gearcut_core::dexel::{Layer, NO_PASS};
use gearcut_core::terms::Side;
use std::ops::Range;

/// Share of profile and face that is left out at either end.
pub const MARGIN: f64 = 0.05;
/// Rounding of places, mm: a dexel so near to an end of the evaluated part belongs to it.
pub const PLACE_MM: f64 = 1e-9;

/// Ends of the evaluated part of a length that begins at 0, mm: those that a scene names, else without the margins.
pub fn evaluated_mm(length_mm: f64, [from_mm, to_mm]: [Option<f64>; 2]) -> [f64; 2] {
    [from_mm.unwrap_or(MARGIN * length_mm), to_mm.unwrap_or((1.0 - MARGIN) * length_mm)]
}

/// The same of a face, from its middle.
pub fn evaluated_face_mm(face_width_mm: f64) -> [f64; 2] {
    [MARGIN - 0.5, 0.5 - MARGIN].map(|share| share * face_width_mm)
}

/// Indices of increasing places between two ends.
pub fn within(places_mm: &[f64], [from_mm, to_mm]: [f64; 2]) -> Range<usize> {
    let start = places_mm.partition_point(|&place_mm| place_mm < from_mm - PLACE_MM);
    start..places_mm.partition_point(|&place_mm| place_mm <= to_mm + PLACE_MM).max(start)
}

/// A flank after all operations, column by column along the profile, each row by row along the tooth.
#[derive(Debug)]
pub struct CutGrid<'a> {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Flank.
    pub side: Side,
    /// Length of the profile in the middle of the face, mm.
    pub length_mm: f64,
    /// Arcs of the columns from the form point, mm, increasing.
    pub arcs_mm: &'a [f64],
    /// Their rolls ([`crate::job::GearJob::rolls_mm`]), mm.
    pub rolls_mm: Vec<f64>,
    /// Places of the rows from the middle of the face, mm, increasing.
    pub rows_mm: &'a [f64],
    /// What each operation left, in order.
    pub layers: &'a [Layer],
    /// Ends of the evaluated part: arcs, and places along the tooth, mm.
    pub evaluated_mm: [[f64; 2]; 2],
    /// Rolls of the ends along the profile, mm.
    pub evaluated_rolls_mm: [f64; 2],
}

impl CutGrid<'_> {
    /// Columns and rows of the evaluated part.
    pub fn evaluated(&self) -> [Range<usize>; 2] {
        [within(self.arcs_mm, self.evaluated_mm[0]), within(self.rows_mm, self.evaluated_mm[1])]
    }

    /// Height that an operation left at a column and a row, mm; none where no pass came.
    pub fn height_mm(&self, operation: usize, column: usize, row: usize) -> Option<f64> {
        let (layer, index) = (&self.layers[operation], column * self.rows_mm.len() + row);
        (layer.passes[index] != NO_PASS).then(|| f64::from(layer.heights_mm[index]))
    }

    /// Heights of the finished surface over the evaluated part; none where a dexel of it was not reached.
    pub fn finished(&self) -> Option<SurfaceHeights> {
        self.over(|column, row| self.height_mm(self.last(), column, row))
    }

    /// What each earlier operation left over the finished surface there.
    pub fn stock(&self) -> Vec<Option<SurfaceHeights>> {
        let left = |operation, column, row| {
            Some(self.height_mm(operation, column, row)? - self.height_mm(self.last(), column, row)?)
        };
        (0..self.last()).map(|operation| self.over(|column, row| left(operation, column, row))).collect()
    }

    /// The flank with its traces, and what only its process measures.
    pub fn inspected<Own>(&self, own: Own) -> InspectedFlank<Own> {
        let [columns, rows] = self.evaluated();
        let [middle_column, middle_row] = [self.arcs_mm.len() / 2, self.rows_mm.len() / 2];
        let finished_mm = |column, row| self.height_mm(self.last(), column, row).unwrap_or(f64::NAN);
        let profile_trace = Trace {
            places_mm: self.rolls_mm.clone(),
            heights_mm: (0..self.arcs_mm.len()).map(|column| finished_mm(column, middle_row)).collect(),
        };
        let lead_trace = Trace {
            places_mm: self.rows_mm.to_vec(),
            heights_mm: (0..self.rows_mm.len()).map(|row| finished_mm(middle_column, row)).collect(),
        };
        // No end lies inside of the outer dexels, so that rounding takes none of them away.
        let deviation = |trace: &Trace, inner: &Range<usize>, [from_mm, to_mm]: [f64; 2]| {
            let places_mm = &trace.places_mm[inner.clone()];
            trace.deviation([from_mm.min(*places_mm.first()?), to_mm.max(*places_mm.last()?)])
        };
        InspectedFlank {
            tooth: self.tooth,
            side: self.side,
            length_mm: self.length_mm,
            evaluated_mm: self.evaluated_mm[0],
            lines: TracedLines {
                arcs_mm: self.arcs_mm.to_vec(),
                profile_v_mm: self.rows_mm[middle_row],
                lead_arc_mm: self.arcs_mm[middle_column],
            },
            profile: deviation(&profile_trace, &columns, self.evaluated_rolls_mm),
            profile_trace,
            lead: deviation(&lead_trace, &rows, self.evaluated_mm[1]),
            lead_trace,
            untouched: self.places().filter(|&[column, row]| finished_mm(column, row).is_nan()).count() as u64,
            own,
        }
    }

    fn last(&self) -> usize {
        self.layers.len() - 1
    }

    /// Columns and rows of the evaluated dexels, column by column.
    fn places(&self) -> impl Iterator<Item = [usize; 2]> {
        let [columns, rows] = self.evaluated();
        columns.flat_map(move |column| rows.clone().map(move |row| [column, row]))
    }

    fn over(&self, height_mm: impl Fn(usize, usize) -> Option<f64>) -> Option<SurfaceHeights> {
        let placed = |[column, row]: [usize; 2]| {
            Some(Extreme { value_mm: height_mm(column, row)?, arc_mm: self.arcs_mm[column], z_mm: self.rows_mm[row] })
        };
        self.places().map(placed).collect::<Option<Vec<_>>>().and_then(|values| SurfaceHeights::of(&values))
    }
}
