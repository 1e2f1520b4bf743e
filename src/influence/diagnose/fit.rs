//! One linear fit: which sources are chosen about a model, their sizes, and what is left.
//!
//! In: a model, measured deviations and their noise. Out: [`Diagnosis`].
//!
//! What every fit has may be a combination of a source's parameters: all gashes of a hob off by as much are a turn of
//! the gear. No measured gear says how much of it is whose. The fit gives all of it to what it always has: each such
//! combination is one more value, 0, beside the measured ones (`free`).

use super::averaging::{Averaging, FitColumn};
use super::free::free_directions;
use super::selection::{Selection, chi_square_quantile};
use super::{Diagnosis, ErrorModel, FittedSize, NamedSource, Noise, Without};
use crate::influence::interval::interval;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::math::column_basis::{ColumnBasis, norm};
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Chance that noise alone tells two sources apart that are the same.
const TOLD_APART_BY_CHANCE: f64 = 0.01;
/// Chance that noise alone is called unexplained.
const UNEXPLAINED_BY_CHANCE: f64 = 1e-3;

/// Measured deviations and the columns of a model, over the noise.
pub(super) struct LinearFit<'a> {
    model: &'a ErrorModel,
    without: &'a Without,
    noise_um: f64,
    /// Columns of each source at the places that the fit takes.
    columns: Vec<Vec<Vec<f64>>>,
    /// The turn, and the columns of what stands out.
    always: Vec<Vec<f64>>,
    off: Vec<f64>,
    /// Sources with a combination that the fit always has, once for each: the values behind the measured ones.
    held: Vec<usize>,
    /// Deviations from a gear without errors, um, at all places.
    off_um: Vec<f64>,
    /// Squares of the deviations from the scene's own gear that neither a turn nor what stands out explains.
    whole: f64,
}

impl<'a> LinearFit<'a> {
    /// Takes values over their noise.
    pub fn new(model: &'a ErrorModel, measured_um: &[f64], noise: &Noise, without: &'a Without) -> Self {
        let mut taken = vec![true; measured_um.len()];
        without.places.iter().for_each(|&place| taken[place] = false);
        let whitened = |values: &[f64]| noise.over(values, |place| taken[place]);
        let less = |other_um: &[f64]| measured_um.iter().zip(other_um).map(|(a, b)| a - b).collect::<Vec<f64>>();
        let of_source = model.sources.iter().map(|source| source.um_per_unit.iter().map(|of| whitened(of)).collect());
        let mut columns: Vec<Vec<Vec<f64>>> = of_source.collect();
        let mut always: Vec<Vec<f64>> = model.always().map(whitened).collect();
        let off_um = less(&model.without_errors_um());
        let mut off = whitened(&off_um);
        let before = whitened(&less(&model.before_um));
        let of = |columns: &[Vec<f64>]| free_directions(columns, &always);
        let free: Vec<Vec<Vec<f64>>> = columns.iter().map(|columns| of(columns)).collect();
        let held: Vec<usize> = free.iter().enumerate().flat_map(|(source, of)| vec![source; of.len()]).collect();
        always.iter_mut().chain([&mut off]).for_each(|column| column.extend(vec![0.0; held.len()]));
        let directions: Vec<&Vec<f64>> = free.iter().flatten().collect();
        for (source, columns) in columns.iter_mut().enumerate() {
            for (index, column) in columns.iter_mut().enumerate() {
                let own = held.iter().zip(&directions).map(|(&of, by)| if of == source { by[index] } else { 0.0 });
                column.extend(own.collect::<Vec<f64>>());
            }
        }
        let mut fit = Self { model, without, noise_um: noise.value_um, columns, always, off, held, off_um, whole: 0.0 };
        fit.whole = fit.selection().basis(&[]).left_of(&[before, vec![0.0; fit.held.len()]].concat());
        fit
    }

    /// How many measured values there are.
    fn count(&self) -> usize {
        self.off.len() - self.held.len()
    }

    pub(super) fn selection(&self) -> Selection<'_> {
        Selection { columns: &self.columns, always: &self.always, off: &self.off }
    }

    /// Sources that are tried, and those whose natural step noise hides.
    pub(super) fn candidates_and_hidden(&self) -> (Vec<usize>, Vec<usize>) {
        let turned = self.selection().basis(&[]);
        let seen = |source: usize| {
            let steps = self.model.sources[source].parameters.iter().map(|parameter| parameter.step);
            let beside = |column: &[f64]| norm(&turned.beside(column).0[..self.count()]);
            self.columns[source].iter().zip(steps).any(|(column, step)| step * beside(column) > 1.0)
        };
        let (mut candidates, hidden): (Vec<usize>, Vec<usize>) = (0..self.columns.len()).partition(|&i| seen(i));
        candidates.retain(|source| !self.without.sources.contains(source));
        (candidates, hidden)
    }

    /// Explains the deviations.
    ///
    /// # Errors
    /// Fewer places than parameters.
    pub fn diagnosis(&self) -> Result<Diagnosis> {
        let Self { model, noise_um, columns, always, off, whole, .. } = self;
        let fit = self.selection();
        let (candidates, hidden) = self.candidates_and_hidden();
        let chosen = fit.select(&candidates);
        let basis = fit.basis(&chosen);
        let mut solution = basis.solve(off);
        // What holds a source that is not there says nothing.
        let idle = self.held.iter().filter(|source| !chosen.contains(source)).count();
        solution.freedom = solution.freedom.saturating_sub(idle);
        if solution.freedom == 0 {
            let problem = format!("{} places are too few for {} parameters", self.count(), basis.columns());
            return Err(Refusal::new("--measured", problem, "measure more places").into());
        }
        // Intervals widen where residuals say that the noise was stated too low.
        let variance = (solution.chi_square / solution.freedom as f64).max(1.0);
        let width = variance.sqrt() * interval(solution.freedom);
        let averaging = Averaging::new(&fit, &candidates, &chosen, variance);
        let sized = |i: usize, column: FitColumn| {
            let (size, [low, high]) = (solution.values[i], averaging.interval(column));
            // Sources are named for more than it takes to weigh: the named set may be one of little weight.
            let interval = [low.min(size), high.max(size)];
            FittedSize { size, interval, half_if_right: width * solution.covariance[i][i].sqrt() }
        };
        let mut residuals_um = self.off_um.clone();
        let mut take_off = |column: &[f64], size: f64| {
            residuals_um.iter_mut().zip(column).for_each(|(um, per_unit)| *um -= size * per_unit);
        };
        let mut basis_so_far = ColumnBasis::default();
        let mut place = 0;
        let mut always_fitted = Vec::new();
        for (index, (column, um_per_unit)) in always.iter().zip(model.always()).enumerate() {
            let own = basis_so_far.take(column).then(|| sized(place, FitColumn::Always(index)));
            take_off(um_per_unit, own.map_or(0.0, |own| own.size));
            place += usize::from(own.is_some());
            always_fitted.push(own);
        }
        let turn_arcsec = always_fitted.remove(0);
        let mut named = Vec::new();
        for &source in &chosen {
            let mut fitted = Vec::new();
            for (index, column) in columns[source].iter().enumerate() {
                let own = basis_so_far.take(column).then(|| sized(place, FitColumn::Of(source, index)));
                if let Some(FittedSize { size, .. }) = own {
                    take_off(&model.sources[source].um_per_unit[index], size);
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
                weight: averaging.weight(source),
                alone: (left_by_others - solution.chi_square) / whole,
                same_as: candidates.iter().copied().filter(|&other| same(other)).collect(),
            });
        }
        named.sort_by(|a, b| b.alone.total_cmp(&a.alone));
        let there = residuals_um.iter().enumerate().filter(|(place, _)| !self.without.places.contains(place));
        let there = there.map(|(_, um)| um * um);
        let residual_um = (there.sum::<f64>() / self.count() as f64).sqrt();
        let noise = ChiSquared::new(solution.freedom as f64).expect("freedom is above 0");
        let chance = noise.sf(solution.chi_square);
        let beyond = (solution.chi_square / solution.freedom as f64 - 1.0).max(0.0);
        Ok(Diagnosis {
            named,
            turn_arcsec,
            standing_out_um: always_fitted,
            explained: (*whole > 0.0).then(|| 1.0 - solution.chi_square / whole),
            residual_um,
            unexplained_um: if chance < UNEXPLAINED_BY_CHANCE { noise_um * beyond.sqrt() } else { 0.0 },
            chance,
            freedom: solution.freedom,
            residuals_um,
            hidden,
            unsayable: self.without.sources.clone(),
            bent: self.without.places.len(),
            rounds: 0,
            settled: false,
        })
    }
}
