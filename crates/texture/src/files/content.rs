//! What a file holds and what its reader adds: a surface or a trace, its notes, and remarks on how it was read.
//!
//! In: heights with the sides that a header gives them. Out: [`MeasuredContent`]. A single line of points is a trace,
//! whatever the format calls it, and several lines are a surface.

use super::units::LengthUnit;
use super::{SpacingUm, SurfaceFile};
use crate::error::FileFault;
use crate::surface::Surface;
use crate::trace::ProfileTrace;

/// What is known of a file beside it: needed where the file does not say it, refused where the file says otherwise.
#[derive(Debug, Clone, Copy, Default)]
pub struct Given {
    /// Distance of points along x and y.
    pub spacing_um: Option<SpacingUm>,
    /// Unit of the heights.
    pub height_unit: Option<LengthUnit>,
    /// Unit of spacings and positions.
    pub spacing_unit: Option<LengthUnit>,
    /// Points that the file's own mask marks are holes (GWY).
    pub use_mask: bool,
}

impl Given {
    /// Nothing but a spacing.
    pub fn spacing(spacing_um: Option<SpacingUm>) -> Self {
        Self { spacing_um, ..Self::default() }
    }
}

/// A surface or a trace.
#[derive(Debug, Clone, PartialEq)]
pub enum MeasuredContent {
    /// Heights on a grid.
    Surface(Surface),
    /// Heights along one line.
    Trace(ProfileTrace),
}

impl MeasuredContent {
    /// `nx` x `ny` heights; one line along either axis is a trace.
    pub(super) fn new(nx: usize, ny: usize, dx_um: f64, dy_um: f64, heights_um: Vec<f64>) -> Result<Self, FileFault> {
        if nx.checked_mul(ny) != Some(heights_um.len()) {
            return Err(format!("{} heights do not fill a grid of {nx} x {ny}", heights_um.len()).into());
        }
        match (nx, ny) {
            (_, 1) => Ok(Self::Trace(ProfileTrace::new(heights_um, dx_um)?)),
            (1, _) => Ok(Self::Trace(ProfileTrace::new(heights_um, dy_um)?)),
            _ => Ok(Self::Surface(Surface::new(nx, ny, dx_um, dy_um, heights_um)?)),
        }
    }

    /// All heights, um.
    pub fn heights_um(&self) -> &[f64] {
        match self {
            Self::Surface(surface) => surface.heights_um(),
            Self::Trace(trace) => trace.heights_um(),
        }
    }
}

/// Largest and smallest range of heights that a field of a lens or a trace of a stylus has, um: 1 nm and 1 mm.
const USUAL_RANGE_UM: [f64; 2] = [1e-3, 1e3];

/// A file that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredFile {
    /// Heights and spacing.
    pub content: MeasuredContent,
    /// Texts by name, as in [`SurfaceFile::notes`].
    pub notes: Vec<(String, String)>,
    /// What the reader took otherwise than it is written, or left out, in words.
    pub remarks: Vec<String>,
}

impl MeasuredFile {
    pub(super) fn new(content: MeasuredContent, notes: Vec<(String, String)>) -> Self {
        Self { content, notes, remarks: Vec::new() }
    }

    /// Refuses what is given otherwise than the file says it.
    pub(super) fn agrees(&self, given: &Given) -> Result<(), FileFault> {
        if given.height_unit.is_some() || given.spacing_unit.is_some() {
            let sentence = "the file says the units of its heights and spacings itself: leave --height-unit and \
                            --spacing-unit out";
            return Err(FileFault::Contradicted(sentence.to_owned()));
        }
        let (x, y) = match &self.content {
            MeasuredContent::Surface(surface) => (surface.dx_um(), surface.dy_um()),
            MeasuredContent::Trace(trace) => (trace.spacing_um(), trace.spacing_um()),
        };
        match given.spacing_um {
            Some([ax, ay]) if (x - ax).abs() > 1e-6 * ax || (y - ay).abs() > 1e-6 * ay => Err(FileFault::Contradicted(
                format!("the file says its points are {x} x {y} um apart, not {ax} x {ay} um"),
            )),
            _ => Ok(()),
        }
    }

    /// Why the heights are hardly those of a texture, if they are not: a wrong unit of heights is off by a thousand.
    pub fn doubt(&self) -> Option<String> {
        let measured = self.content.heights_um().iter().filter(|z| !z.is_nan());
        let (low, high) = measured.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &z| (l.min(z), h.max(z)));
        let range = high - low;
        let [least, most] = USUAL_RANGE_UM;
        let is = match range {
            _ if range == 0.0 => return Some("all heights are equal".to_owned()),
            _ if range < least => "less than 1 nm",
            _ if range > most => "more than 1 mm",
            _ => return None,
        };
        Some(format!("from lowest to highest the heights span {range:.4e} um, {is}: are they in another unit?"))
    }

    /// The surface.
    ///
    /// # Errors
    /// It is a trace.
    pub fn into_surface(self) -> Result<SurfaceFile, FileFault> {
        match self.content {
            MeasuredContent::Surface(surface) => Ok(SurfaceFile { surface, notes: self.notes }),
            MeasuredContent::Trace(trace) => Err(format!(
                "the file holds a profile of {} points, where a surface is needed",
                trace.heights_um().len()
            )
            .into()),
        }
    }
}
