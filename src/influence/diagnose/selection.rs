//! Which sources explain measured deviations: forward selection with removal.
//!
//! In: columns of sources and what is to be explained, all over the noise's standard deviation. Out: the sources that
//! explain more than noise would.
//!
//! A source joins while it takes more off the squared residuals than noise would in one of a hundred diagnoses:
//! chi-square of as many degrees as it has parameters, at 1 % shared by all sources (Bonferroni); it leaves again where
//! others have made it idle (Draper and Smith, *Applied Regression Analysis*, 1998, ch. 15).

use gearcut_core::math::column_basis::{ColumnBasis, DEPENDENT, norm};
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Chance that noise alone names any source.
const NAMED_BY_CHANCE: f64 = 0.01;

/// What sources are chosen from; everything over the noise's standard deviation.
pub(super) struct Selection<'a> {
    /// Columns of each source.
    pub columns: &'a [Vec<Vec<f64>>],
    /// What every fit has: a turn on the measuring machine, and what stands out of the gear.
    pub always: &'a [Vec<f64>],
    /// What is to be explained.
    pub off: &'a [f64],
}

impl Selection<'_> {
    /// What every fit has, and the columns of these sources.
    pub fn basis(&self, sources: &[usize]) -> ColumnBasis {
        let mut basis = ColumnBasis::default();
        for column in self.always.iter().chain(sources.iter().flat_map(|&i| &self.columns[i])) {
            let _dependent = basis.take(column);
        }
        basis
    }

    /// Squared residuals with these sources.
    pub fn left(&self, sources: &[usize]) -> f64 {
        self.basis(sources).left_of(self.off)
    }

    /// The sources that explain more than noise would, in the order in which they were found.
    pub fn select(&self, candidates: &[usize]) -> Vec<usize> {
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
pub(super) fn chi_square_quantile(degrees: usize, chance: f64) -> f64 {
    ChiSquared::new(degrees.max(1) as f64).expect("one degree at least").inverse_cdf(chance)
}
