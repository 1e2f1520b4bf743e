//! Roughness of profiles on windows: Ra, Rz and their kin along the profile and along the tooth (ISO 21920).
//!
//! In: a window and the operation that left it. Out: [`Traced`] for both directions. Three lines, in the middles of
//! three equal parts of the window, are cut with dexels of their own, close enough for the shortest cut-off, and long
//! enough for five sections of 2.5 mm where the window is; what follows is the chain of
//! [`gearcut_texture::profile_chain`], the same that measured lines go through.
//!
//! Road not taken: rows and columns of the window. Its points along the tooth are as far apart as half a cut-off.

use super::{Window, heights_um};
use crate::job::GearJob;
use crate::measure::topography::profile_chain::{CutOff, ProfileChain, Profiles};
use crate::measure::topography::{Parameter, ProfileTrace, Surface, TextureError, parameters::of_profiles};
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;

/// Lines in each direction.
const LINES: usize = 3;
/// Distance of points at most: ten in the shortest cut-off of ISO 21920-3, mm.
const STEP_MM: f64 = 0.008;
/// Length of lines at most: five sections of 2.5 mm and half of one at both ends, mm.
const LENGTH_MM: f64 = 15.0;

/// Direction of a trace: the index that lengths and steps of a window have for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Along the tooth.
    Tooth,
    /// Along the profile.
    Profile,
}

impl Direction {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Profile, Self::Tooth];

    /// Words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Tooth => "along the tooth",
            Self::Profile => "along the profile",
        }
    }

    /// Key.
    pub fn key(self) -> &'static str {
        match self {
            Self::Tooth => "along_tooth",
            Self::Profile => "along_profile",
        }
    }
}

/// Lines of a window in one direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Traced {
    /// Which way they run.
    pub direction: Direction,
    /// Where they are in the other direction, mm: from the form point, or from the middle of the face.
    pub places_mm: Vec<f64>,
    /// Their parameters, or why there are none.
    pub profiles: std::result::Result<Profiles, TextureError>,
}

/// A parameter over the lines: mean and largest, um.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OfLines {
    /// Mean.
    pub mean_um: f64,
    /// Largest.
    pub largest_um: f64,
}

impl Traced {
    /// A parameter, if there is one.
    pub fn of(&self, symbol: &str) -> Option<OfLines> {
        let spread = of_profiles(self.profiles.as_ref().ok()?, &[]);
        let found = spread.into_iter().find(|of| of.mean.symbol == symbol)?;
        Some(OfLines { mean_um: found.mean.value.ok()?, largest_um: found.range?[1] })
    }
}

/// Cuts and evaluates the lines of a window in both directions.
///
/// # Errors
/// Geometry and the backend.
pub(super) fn traced(job: &dyn GearJob, backend: &dyn Backend, window: &Window) -> Result<Vec<Traced>> {
    Direction::BOTH.into_iter().map(|direction| along(job, backend, window, direction)).collect()
}

fn along(job: &dyn GearJob, backend: &dyn Backend, window: &Window, direction: Direction) -> Result<Traced> {
    let (k, other) = (direction as usize, 1 - direction as usize);
    let (start, length) = (window.start_mm, window.length_mm());
    let places_mm: Vec<f64> =
        (0..LINES).map(|i| start[other] + length[other] * (i as f64 + 0.5) / LINES as f64).collect();
    let traced_mm = length[k].min(LENGTH_MM);
    let step_mm = window.spacing_mm()[k].min(STEP_MM);
    let steps = (traced_mm / step_mm + 1e-6).floor();
    let first_mm = start[k] + 0.5 * (length[k] - steps * step_mm);
    let line_mm: Vec<f64> = (0..=steps as usize).map(|i| first_mm + step_mm * i as f64).collect();
    let (arcs_mm, rows_mm) = match direction {
        Direction::Tooth => (&places_mm, &line_mm),
        Direction::Profile => (&line_mm, &places_mm),
    };
    let layers = job.cut_flank(backend, window.tooth, window.side, arcs_mm, rows_mm)?;
    let heights_um = heights_um(job, &layers[window.operation]);
    // Rows run along the tooth, one for each arc.
    let line = |i: usize| -> Vec<f64> {
        match direction {
            Direction::Tooth => heights_um[i * line_mm.len()..(i + 1) * line_mm.len()].to_vec(),
            Direction::Profile => heights_um.iter().skip(i).step_by(LINES).copied().collect(),
        }
    };
    let traces = (0..LINES)
        .map(|i| ProfileTrace::new(line(i), step_mm * UM_PER_MM))
        .collect::<std::result::Result<Vec<_>, TextureError>>();
    let profiles = traces.and_then(|traces| chain(job, window).evaluate(&traces));
    Ok(Traced { direction, places_mm, profiles })
}

/// Parameters of lines of a measured surface of a window, through the chain that the window's own lines go through.
///
/// # Errors
/// Lines that do not suit the chain.
pub fn of_surface(
    job: &dyn GearJob,
    window: &Window,
    surface: &Surface,
    direction: Direction,
) -> std::result::Result<Vec<Parameter>, TextureError> {
    let all = if direction == Direction::Tooth { surface.ny() } else { surface.nx() };
    let traces = (0..LINES).map(|i| (2 * i + 1) * all / (2 * LINES)).map(|place| match direction {
        Direction::Tooth => ProfileTrace::row(surface, place),
        Direction::Profile => ProfileTrace::column(surface, place),
    });
    let profiles = chain(job, window).evaluate(&traces.collect::<std::result::Result<Vec<_>, _>>()?)?;
    Ok(of_profiles(&profiles, &[]).into_iter().map(|of| of.mean).collect())
}

fn chain(job: &dyn GearJob, window: &Window) -> ProfileChain {
    let limits = job.scene().measure.limits;
    let cutoff = match (window.cutoff_um, limits.ra_um, limits.rz_um) {
        (Some(um), ..) => CutOff::Um(um),
        (None, Some(ra), _) => CutOff::OfRaLimit(ra),
        (None, None, Some(rz)) => CutOff::OfRzLimit(rz),
        (None, None, None) => CutOff::Estimated,
    };
    ProfileChain { cutoff, robust: window.chain.robust, ..ProfileChain::default() }
}
