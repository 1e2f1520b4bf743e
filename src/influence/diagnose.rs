//! Which errors of machine, clamping and tool explain measured flanks.
//!
//! In: a scene, measured deviations and their noise. Out: [`Diagnosis`]: the sources that are named, their sizes with
//! intervals, how much they explain, sources that explain the same, and what is left over.
//!
//! **Law.** Measured deviations are those of a gear that is cut with the errors, plus a turn of the gear on the
//! measuring machine, plus noise of one known standard deviation. About a gear with known errors they are linear:
//! influences times sizes. Sources are chosen and their sizes fitted by least squares (`selection`); then the gear is
//! cut with them, and the fit begins again from there, until it moves no more (`refit`).
//!
//! A source B that would explain as much in place of a named A, within what noise can hide, cannot be told apart from
//! A. What no source explains is compared with the noise: chi-square of the residuals.
//!
//! Roads not taken: sizes of all sources at once. Where two have nearly the same map, both become large with opposite
//! signs, and none of them says anything. Influences about the scene's gear alone: where a cut ends over its own
//! beginning the deeper stroke remains, which bends like a knee in the size of an error; a few such places were
//! explained by many large errors that cancel everywhere else.

mod cuts;
mod findings;
mod model;
mod page;
mod refit;
mod selection;

use super::interval::interval;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::math::column_basis::{ColumnBasis, norm};
use selection::{Selection, chi_square_quantile};
use statrs::distribution::{ChiSquared, ContinuousCDF};

pub use cuts::MeasuredCuts;
pub use findings::{findings, sheet};
pub use model::{ErrorModel, ModelledSource};
pub use page::write;
pub use refit::diagnose;

/// Chance that noise alone tells two sources apart that are the same.
const TOLD_APART_BY_CHANCE: f64 = 0.01;
/// Chance that noise alone is called unexplained.
const UNEXPLAINED_BY_CHANCE: f64 = 1e-3;

/// What explains a measured gear.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// Sources that are named, the one that explains most first.
    pub named: Vec<NamedSource>,
    /// How far the gear was turned on the measuring machine, arc seconds, with half its interval.
    pub turn_arcsec: [f64; 2],
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

/// A source that is named.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedSource {
    /// Its number in the model.
    pub source: usize,
    /// Size of each of its parameters with half its interval; `None` where the others say all of it.
    pub fitted: Vec<Option<[f64; 2]>>,
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

impl Diagnosis {
    /// Explains measured deviations, um, at the model's places, as if all errors were linear about the model's gear;
    /// `noise_um` is their standard deviation, from place to place on its own.
    ///
    /// # Errors
    /// Fewer places than parameters.
    pub fn new(model: &ErrorModel, measured_um: &[f64], noise_um: f64) -> Result<Self> {
        Self::without(model, measured_um, noise_um, &Without::default())
    }

    /// The same without some sources and places.
    fn without(model: &ErrorModel, measured_um: &[f64], noise_um: f64, without: &Without) -> Result<Self> {
        let mut taken = vec![true; measured_um.len()];
        without.places.iter().for_each(|&place| taken[place] = false);
        let whitened = |values: &[f64]| {
            values
                .iter()
                .zip(&taken)
                .filter(|(_, taken)| **taken)
                .map(|(value, _)| value / noise_um)
                .collect::<Vec<f64>>()
        };
        let less = |other_um: &[f64]| measured_um.iter().zip(other_um).map(|(a, b)| a - b).collect::<Vec<f64>>();
        let columns: Vec<Vec<Vec<f64>>> =
            model.sources.iter().map(|source| source.um_per_unit.iter().map(|of| whitened(of)).collect()).collect();
        let turn = whitened(&model.um_per_arcsec);
        let off_um = less(&model.without_errors_um());
        let off = whitened(&off_um);
        let fit = Selection { columns: &columns, turn: &turn, off: &off };
        let seen = |source: usize| {
            let steps = model.sources[source].parameters.iter().map(|parameter| parameter.step);
            let turned = fit.basis(&[]);
            columns[source].iter().zip(steps).any(|(column, step)| step * norm(&turned.beside(column).0) > 1.0)
        };
        let (mut candidates, hidden): (Vec<usize>, Vec<usize>) = (0..columns.len()).partition(|&source| seen(source));
        candidates.retain(|source| !without.sources.contains(source));
        let chosen = fit.select(&candidates);
        let basis = fit.basis(&chosen);
        let solution = basis.solve(&off);
        if solution.freedom == 0 {
            let problem = format!("{} places are too few for {} parameters", off.len(), basis.columns());
            return Err(Refusal::new("--measured", problem, "measure more places").into());
        }
        // Intervals widen where residuals say that the noise was stated too low.
        let spread = (solution.chi_square / solution.freedom as f64).max(1.0).sqrt();
        let width = spread * interval(solution.freedom);
        let sized = |i: usize| [solution.values[i], width * solution.covariance[i][i].sqrt()];
        let whole = fit.basis(&[]).left_of(&whitened(&less(&model.before_um)));
        let turn_arcsec = if norm(&turn) > 0.0 { sized(0) } else { [0.0; 2] };
        let mut residuals_um = off_um;
        let mut take_off = |column: &[f64], size: f64| {
            residuals_um.iter_mut().zip(column).for_each(|(um, per_unit)| *um -= size * per_unit);
        };
        take_off(&model.um_per_arcsec, turn_arcsec[0]);
        let mut named = Vec::new();
        let mut basis_so_far = ColumnBasis::default();
        let mut place = usize::from(basis_so_far.take(&turn));
        for &source in &chosen {
            let mut fitted = Vec::new();
            for (column, um_per_unit) in columns[source].iter().zip(&model.sources[source].um_per_unit) {
                let own = basis_so_far.take(column).then(|| sized(place));
                if let Some([size, _]) = own {
                    take_off(um_per_unit, size);
                    place += 1;
                }
                fitted.push(own);
            }
            let others: Vec<usize> = chosen.iter().copied().filter(|&other| other != source).collect();
            let left_by_others = fit.left(&others);
            let hides = chi_square_quantile(columns[source].len(), 1.0 - TOLD_APART_BY_CHANCE);
            let same = |other: usize| {
                let exchanged: Vec<usize> = others.iter().copied().chain([other]).collect();
                !chosen.contains(&other) && fit.left(&exchanged) <= solution.chi_square + hides
            };
            named.push(NamedSource {
                source,
                fitted,
                alone: (left_by_others - solution.chi_square) / whole,
                same_as: candidates.iter().copied().filter(|&other| same(other)).collect(),
            });
        }
        named.sort_by(|a, b| b.alone.total_cmp(&a.alone));
        let noise = ChiSquared::new(solution.freedom as f64).expect("freedom is above 0");
        let chance = noise.sf(solution.chi_square);
        let beyond = (solution.chi_square / solution.freedom as f64 - 1.0).max(0.0);
        Ok(Self {
            named,
            turn_arcsec,
            explained: (whole > 0.0).then(|| 1.0 - solution.chi_square / whole),
            residual_um: noise_um * (solution.chi_square / off.len() as f64).sqrt(),
            unexplained_um: if chance < UNEXPLAINED_BY_CHANCE { noise_um * beyond.sqrt() } else { 0.0 },
            chance,
            freedom: solution.freedom,
            residuals_um,
            hidden,
            unsayable: without.sources.clone(),
            bent: without.places.len(),
            rounds: 0,
            settled: false,
        })
    }
}
