//! Which errors of machine, clamping and tool explain measured flanks.
//!
//! In: a scene, measured deviations and their noise. Out: [`Diagnosis`]: the sources that are named, their sizes with
//! intervals, how much they explain, sources that explain the same, and what is left over.
//!
//! **Law.** Measured deviations are those of a gear that is cut with the errors, plus a turn of the gear on the
//! measuring machine, plus noise that is known ([`Noise`]). About a gear with known errors they are linear:
//! influences times sizes. Sources are chosen and their sizes fitted by least squares (`selection`); then the gear is
//! cut with them, and the fit begins again from there, until it moves no more (`refit`).
//!
//! The same values choose the sources and size them. On gears of few teeth waves of work and cutter nearly stand in for
//! each other, and intervals of the named sources alone would hold too seldom: they are taken over all sets of sources
//! that explain the gear about as well (`averaging`).
//!
//! Errors of a machine make all teeth alike, or wave from tooth to tooth. Single teeth, steps along the face and hollow
//! profiles that none of them explains are looked for where something is left unexplained, named as what they are, and
//! fitted beside the sources (`standing_out`): two displaced teeth are no waves. Where deviations are still left that
//! nothing explains, intervals rest on noise that is not there, and none is said.
//!
//! A source B that would explain as much in place of a named A, within what noise can hide, cannot be told apart from
//! A. What no source explains is compared with the noise: chi-square of the residuals.
//!
//! Roads not taken: sizes of all sources at once. Where two have nearly the same map, both become large with opposite
//! signs, and none of them says anything. Influences about the scene's gear alone: where a cut ends over its own
//! beginning the deeper stroke remains, which bends like a knee in the size of an error; a few such places were
//! explained by many large errors that cancel everywhere else.

mod averaging;
mod cuts;
mod findings;
mod fit;
mod free;
mod model;
mod noise;
mod page;
mod refit;
mod selection;
mod shapes;
mod standing_out;

use fit::LinearFit;

pub use cuts::MeasuredCuts;
pub use findings::{findings, sheet};
pub use model::{ErrorModel, tried};
pub use noise::Noise;
pub use page::write;
pub use refit::diagnose;
pub use shapes::StandingShape;

/// What explains a measured gear.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// Sources that are named, the one that explains most first.
    pub named: Vec<NamedSource>,
    /// How far the gear was turned on the measuring machine, arc seconds; `None` where no place shows it.
    pub turn_arcsec: Option<FittedSize>,
    /// Sizes of what stands out of the gear, um: in the order of [`ErrorModel::standing_out`], the columns of each one
    /// after the other; `None` where the others say all of it.
    pub standing_out_um: Vec<Option<FittedSize>>,
    /// Share of the variance beside that turn that the named sources explain together; `None` where there is none.
    pub explained: Option<f64>,
    /// Root mean square of the residuals, um.
    pub residual_um: f64,
    /// What of it is beyond the noise, um: 0 where the noise explains it.
    pub unexplained_um: f64,
    /// Chance of residuals as large as these from noise alone.
    pub chance: f64,
    /// Values less parameters.
    pub freedom: usize,
    /// Residuals at the measured places, um.
    pub residuals_um: Vec<f64>,
    /// Sources whose natural step noise hides: by their numbers in the model.
    pub hidden: Vec<usize>,
    /// Sources that were not tried further: the scene has no word for their fitted sizes.
    pub unsayable: Vec<usize>,
    /// Measured places that the first fit went without: deviations bend there by more than the noise within a natural
    /// step.
    pub bent: usize,
    /// How often the gear was cut with the sizes that were found.
    pub rounds: usize,
    /// Whether the last round moved them no more, and named the same sources.
    pub settled: bool,
}

/// A fitted size, and what it may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedSize {
    /// As the named sources have it together.
    pub size: f64,
    /// Its 95 % interval over all sets of sources that explain the gear about as well.
    pub interval: [f64; 2],
    /// Half the 95 % interval that it has if exactly the named sources are there.
    pub half_if_right: f64,
}

/// A source that is named.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedSource {
    /// Its number in the model.
    pub source: usize,
    /// Size of each of its parameters; `None` where the others say all of it.
    pub fitted: Vec<Option<FittedSize>>,
    /// How sure it is: the weight of all sets of sources that have it, among those that explain the gear about as well.
    pub weight: f64,
    /// Share of the variance that nobody else explains.
    pub alone: f64,
    /// Sources that would explain as much in its place.
    pub same_as: Vec<usize>,
}

/// What a fit goes without.
#[derive(Debug, Clone, Default)]
struct Without {
    /// Sources.
    sources: Vec<usize>,
    /// Places, by their numbers.
    places: Vec<usize>,
}

impl FittedSize {
    /// Whether a size lies in the interval.
    #[cfg(feature = "testing")]
    pub fn holds(&self, size: f64) -> bool {
        (self.interval[0]..=self.interval[1]).contains(&size)
    }
}

impl Diagnosis {
    /// Explains measured deviations, um, at the model's places, as if all errors were linear about the model's gear,
    /// with their noise.
    ///
    /// # Errors
    /// Fewer places than parameters.
    #[cfg(feature = "testing")]
    pub fn new(model: &ErrorModel, measured_um: &[f64], noise: &Noise) -> gearcut_core::Result<Self> {
        LinearFit::new(model, measured_um, noise, &Without::default()).diagnosis()
    }
}
