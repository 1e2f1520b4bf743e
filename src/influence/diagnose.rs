//! Which errors of machine, clamping and tool explain measured flanks.
//!
//! In: a scene, measured deviations and their noise. Out: [`Diagnosis`]: the sources that are named, their sizes with
//! intervals, how much they explain, sources that explain the same, and what is left over.
//!
//! **Law.** Measured deviations are those of the scene's own gear, plus influences times sizes, plus a turn of the gear
//! on the measuring machine, plus noise of one known standard deviation. Sizes are fitted by least squares. A source
//! joins while it takes more off the squared residuals than noise would in one of a hundred diagnoses: chi-square of as
//! many degrees as it has parameters, at 1 % shared by all sources (Bonferroni); it leaves again where others have made
//! it idle. Forward selection with removal: Draper and Smith, *Applied Regression Analysis*, 1998, ch. 15.
//!
//! A source B that would explain as much in place of a named A, within what noise can hide, cannot be told apart from
//! A. What no source explains is compared with the noise: chi-square of the residuals.
//!
//! Road not taken: sizes of all sources at once. Where two have nearly the same map, both become large with opposite
//! signs, and none of them says anything.

mod findings;
mod model;
mod page;

use super::interval::interval;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::math::column_basis::{ColumnBasis, DEPENDENT, norm};
use statrs::distribution::{ChiSquared, ContinuousCDF};

pub use findings::{findings, sheet};
pub use model::{ErrorModel, ModelledSource};
pub use page::write;

/// Chance that noise alone names any source.
const NAMED_BY_CHANCE: f64 = 0.01;
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

impl Diagnosis {
    /// Explains measured deviations, um, at the model's places; `noise_um` is their standard deviation, from place to
    /// place on its own.
    ///
    /// # Errors
    /// Fewer places than parameters.
    pub fn new(model: &ErrorModel, measured_um: &[f64], noise_um: f64) -> Result<Self> {
        let whitened = |values: &[f64]| values.iter().map(|value| value / noise_um).collect::<Vec<f64>>();
        let columns: Vec<Vec<Vec<f64>>> =
            model.sources.iter().map(|source| source.um_per_unit.iter().map(|of| whitened(of)).collect()).collect();
        let turn = whitened(&model.um_per_arcsec);
        let off: Vec<f64> = measured_um.iter().zip(&model.before_um).map(|(a, b)| (a - b) / noise_um).collect();
        let fit = Selection { columns: &columns, turn: &turn, off: &off };
        let seen = |source: usize| {
            let steps = model.sources[source].parameters.iter().map(|parameter| parameter.step);
            let turned = fit.basis(&[]);
            columns[source].iter().zip(steps).any(|(column, step)| step * norm(&turned.beside(column).0) > 1.0)
        };
        let (candidates, hidden): (Vec<usize>, Vec<usize>) = (0..columns.len()).partition(|&source| seen(source));
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
        let whole = fit.basis(&[]).left_of(&off);
        let mut named = Vec::new();
        let mut taken = ColumnBasis::default();
        let mut place = usize::from(taken.take(&turn));
        for &source in &chosen {
            let mut fitted = Vec::new();
            for column in &columns[source] {
                let own = taken.take(column);
                fitted.push(own.then(|| sized(place)));
                place += usize::from(own);
            }
            let others: Vec<usize> = chosen.iter().copied().filter(|&other| other != source).collect();
            let without = fit.left(&others);
            let hides = chi_square_quantile(columns[source].len(), 1.0 - TOLD_APART_BY_CHANCE);
            let same = |other: usize| {
                let exchanged: Vec<usize> = others.iter().copied().chain([other]).collect();
                !chosen.contains(&other) && fit.left(&exchanged) <= solution.chi_square + hides
            };
            named.push(NamedSource {
                source,
                fitted,
                alone: (without - solution.chi_square) / whole,
                same_as: candidates.iter().copied().filter(|&other| same(other)).collect(),
            });
        }
        named.sort_by(|a, b| b.alone.total_cmp(&a.alone));
        let noise = ChiSquared::new(solution.freedom as f64).expect("freedom is above 0");
        let chance = noise.sf(solution.chi_square);
        let beyond = (solution.chi_square / solution.freedom as f64 - 1.0).max(0.0);
        Ok(Self {
            named,
            turn_arcsec: if norm(&turn) > 0.0 { sized(0) } else { [0.0; 2] },
            explained: (whole > 0.0).then(|| 1.0 - solution.chi_square / whole),
            residual_um: noise_um * (solution.chi_square / off.len() as f64).sqrt(),
            unexplained_um: if chance < UNEXPLAINED_BY_CHANCE { noise_um * beyond.sqrt() } else { 0.0 },
            chance,
            freedom: solution.freedom,
            residuals_um: basis.beside(&off).0.iter().map(|rest| noise_um * rest).collect(),
            hidden,
        })
    }
}

/// What sources are chosen from; everything over the noise's standard deviation.
struct Selection<'a> {
    /// Columns of each source.
    columns: &'a [Vec<Vec<f64>>],
    /// A turn on the measuring machine, which every fit has.
    turn: &'a [f64],
    /// What is to be explained.
    off: &'a [f64],
}

impl Selection<'_> {
    /// The turn and the columns of these sources.
    fn basis(&self, sources: &[usize]) -> ColumnBasis {
        let mut basis = ColumnBasis::default();
        for column in
            std::iter::once(self.turn).chain(sources.iter().flat_map(|&i| self.columns[i].iter().map(Vec::as_slice)))
        {
            let _dependent = basis.take(column);
        }
        basis
    }

    /// Squared residuals with these sources.
    fn left(&self, sources: &[usize]) -> f64 {
        self.basis(sources).left_of(self.off)
    }

    /// The sources that explain more than noise would, in the order in which they were found.
    fn select(&self, candidates: &[usize]) -> Vec<usize> {
        let needed = |source: usize| {
            chi_square_quantile(self.columns[source].len(), 1.0 - NAMED_BY_CHANCE / candidates.len() as f64)
        };
        let mut chosen: Vec<usize> = Vec::new();
        // Every source is named once; one that left does not come back.
        let mut open = candidates.to_vec();
        while !open.is_empty() {
            let basis = self.basis(&chosen);
            let (rest, _) = basis.beside(self.off);
            let gains = open.iter().enumerate().map(|(place, &source)| {
                let mut own = ColumnBasis::default();
                for column in &self.columns[source] {
                    let (beside, _) = basis.beside(column);
                    if norm(&beside) > DEPENDENT * norm(column) {
                        let _dependent = own.take(&beside);
                    }
                }
                let gain = norm(&rest).powi(2) - own.left_of(&rest);
                (place, gain - needed(source))
            });
            let best = gains.max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((place, _)) = best.filter(|(_, beyond)| *beyond > 0.0) else { break };
            chosen.push(open.remove(place));
            while let Some(idle) = chosen.iter().copied().find(|&source| {
                let others: Vec<usize> = chosen.iter().copied().filter(|&other| other != source).collect();
                self.left(&others) - self.left(&chosen) <= needed(source)
            }) {
                chosen.retain(|&source| source != idle);
            }
        }
        chosen
    }
}

/// The value that chi-square of so many degrees stays below with this chance.
fn chi_square_quantile(degrees: usize, chance: f64) -> f64 {
    ChiSquared::new(degrees.max(1) as f64).expect("one degree at least").inverse_cdf(chance)
}
