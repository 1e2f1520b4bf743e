//! A gear as an inspector finds it, whatever process cut it: traces of its flanks, pitch, runout, thickness.
//!
//! In: what was traced on each flank, and where the flanks cross the pitch curve. Out: [`InspectedFlank`], which holds
//! what only one process measures as its `own`, and [`GearInspection`].

use super::crossing::Crossing;
use super::deviation::{self, PitchDeviations, Runout, Trace, TraceDeviation};
use super::stock::Extreme;
use super::thickness::Thickness;
use gearcut_core::gear::blank::Blank;
use gearcut_core::terms::Side;

/// One flank after all operations, measured.
#[derive(Debug, Clone, PartialEq)]
pub struct InspectedFlank<Own> {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Flank.
    pub side: Side,
    /// Length of the profile in the middle of the face, mm.
    pub length_mm: f64,
    /// Arcs between which profiles are evaluated, mm.
    pub evaluated_mm: [f64; 2],
    /// Where both traces run.
    pub lines: TracedLines,
    /// Heights along the profile in the middle of the face.
    pub profile_trace: Trace,
    /// Its deviations.
    pub profile: Option<TraceDeviation>,
    /// Heights along the tooth, on one line.
    pub lead_trace: Trace,
    /// Its deviations.
    pub lead: Option<TraceDeviation>,
    /// Dexels that no pass reached.
    pub untouched: u64,
    /// What only the process that cut it measures.
    pub own: Own,
}

/// Heights over many dexels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceHeights {
    /// Lowest and highest, the first of several.
    pub ends: [Extreme; 2],
    /// Arithmetic mean, mm.
    pub mean_mm: f64,
    /// Root mean square about the mean, mm: Sq of the marks where the form is exact (ISO 25178-2).
    pub rms_mm: f64,
}

impl SurfaceHeights {
    /// Of values with their places; none of no value.
    pub fn of(values: &[Extreme]) -> Option<Self> {
        let pick = |best: &Extreme, next: &Extreme, is_better: bool| if is_better { *next } else { *best };
        let lowest = values.iter().copied().reduce(|a, b| pick(&a, &b, b.value_mm < a.value_mm))?;
        let highest = values.iter().copied().reduce(|a, b| pick(&a, &b, b.value_mm > a.value_mm))?;
        let count = values.len() as f64;
        let mean_mm = values.iter().map(|of| of.value_mm).sum::<f64>() / count;
        let squares: f64 = values.iter().map(|of| (of.value_mm - mean_mm).powi(2)).sum();
        Some(Self { ends: [lowest, highest], mean_mm, rms_mm: (squares / count).sqrt() })
    }

    /// As a stock.
    pub fn stock(&self) -> StockRange {
        StockRange { ends: self.ends, mean_mm: self.mean_mm }
    }
}

/// Stock of an operation on a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StockRange {
    /// Smallest and largest.
    pub ends: [Extreme; 2],
    /// Mean, mm.
    pub mean_mm: f64,
}

/// What every process measures of the surface of a flank.
pub trait FlankSurface {
    /// Lowest and highest normal deviation of the evaluated part; none where a dexel of it was not reached.
    fn deviations(&self) -> Option<[Extreme; 2]>;

    /// Stock of an earlier operation, by its index.
    fn stock(&self, operation: usize) -> Option<StockRange>;

    /// Whether the lowest place is deeper than the rays record.
    fn is_below_range(&self) -> bool {
        false
    }

    /// Whether the evaluated profile is.
    fn is_lost(&self) -> bool {
        false
    }
}

/// Where the traces of a flank run: every process names the places of its own traces as its inspectors do, and all of
/// them stand here as arcs and places along the tooth.
#[derive(Debug, Clone, PartialEq)]
pub struct TracedLines {
    /// Arcs from the form point of the places of the profile, mm.
    pub arcs_mm: Vec<f64>,
    /// Place of the profile along the tooth from the middle of the face, mm.
    pub profile_v_mm: f64,
    /// Arc of the line along the tooth, mm.
    pub lead_arc_mm: f64,
}

/// What is measured from tooth to tooth.
#[derive(Debug, Clone, PartialEq)]
pub struct GearInspection {
    /// Pitch deviations of left and right flanks.
    pub pitch: [Option<PitchDeviations>; 2],
    /// Places of a probe in the space after each tooth.
    pub runout: Option<Runout>,
    /// Thickness of each tooth on the pitch curve; `None` where a flank does not cross it, or where nothing is left
    /// between its flanks.
    pub thickness: Vec<Option<Thickness>>,
}

impl GearInspection {
    /// From where left and right flanks, in order of teeth, cross the pitch curve; `pressure_angle_rad` is that of the
    /// transverse section.
    pub fn of_crossings(blank: &Blank, [left, right]: [&[Option<Crossing>]; 2], pressure_angle_rad: f64) -> Self {
        Self {
            pitch: [left, right]
                .map(|side| deviation::pitch(side, blank.curve().perimeter_mm(), blank.curve().pitches())),
            runout: deviation::runout(blank, left, right, pressure_angle_rad),
            thickness: left
                .iter()
                .zip(right)
                .map(|(left, right)| Some(Thickness::between((*left)?, (*right)?)).filter(|of| of.arc_mm > 0.0))
                .collect(),
        }
    }
}
