//! What a fitted size may be, where other sets of sources explain a gear about as well as those that are named.
//!
//! In: the columns of all sources, and the chosen ones. Out: [`Averaging`]: sets of sources with their weights, the
//! 95 % interval of every size over all of them, and how sure a source is.
//!
//! **Law.** An interval of one set of sources holds if that set is right, and which one is right was found from the
//! same values. Sets are weighed against each other instead: exp(-BIC / 2), BIC = chi-square / c + k ln n for k sizes
//! and n values (Raftery, *Bayesian Model Selection in Social Research*, 1995, eq. 26), where c is chi-square over its
//! degrees of freedom of the chosen set, 1 at least: residuals beyond the stated noise make all sets more alike
//! (Burnham and Anderson, *Model Selection and Multimodel Inference*, 2002, 2.5). The distribution of a size is the
//! weighted sum of its distributions by all sets (Hoeting, Madigan, Raftery and Volinsky, *Bayesian Model Averaging: A
//! Tutorial*, 1999, eq. 1): Student's t about what the set fits, and 0 by sets without its source. The interval leaves
//! 2.5 % of it to either side (tail areas as averaged by Turek and Fletcher, *Model-averaged Wald confidence
//! intervals*, 2012). So the interval of a source that others can stand in for reaches down to 0.
//!
//! Sets are looked for as far as they are a twentieth as likely as the best one (Occam's window, Madigan and Raftery,
//! *Model Selection and Accounting for Model Uncertainty*, 1994): from those known on, the most likely one first,
//! with one source more, one less, or one exchanged, also over sets that have one size too many.
//!
//! Roads not taken: mean and standard deviation over the sets (Buckland, Burnham and Augustin, *Model Selection: An
//! Integral Part of Inference*, 1997), to both sides alike: 0 lies outside of theirs where sets without the source have
//! a tenth of the weight. All subsets, which are too many from some twenty sources on.

use super::selection::Selection;
use crate::influence::interval::{TAIL, interval, share_below};
use gearcut_core::math::column_basis::{ColumnBasis, norm};
use gearcut_core::math::roots::bisect;
use std::collections::BTreeMap;

/// Sets are looked for that are this share as likely as the best one (Madigan and Raftery 1994).
const WINDOW: f64 = 1.0 / 20.0;
/// Most sets whose neighbours are looked at, the most likely ones; a diagnosis has some dozens.
const MOST_SETS: usize = 1000;
/// Quantiles are looked for a little beyond those of single sets, for rounding.
const BEYOND: f64 = 1.001;

/// What a fitted number belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum FitColumn {
    /// What every fit has: the turn, and what stands out of the gear.
    Always(usize),
    /// A source and the place of one of its parameters.
    Of(usize, usize),
}

/// Sets of sources that explain a gear about as well as each other.
#[derive(Debug, Clone)]
pub(super) struct Averaging {
    sets: Vec<WeightedSet>,
}

/// A set of sources.
#[derive(Debug, Clone)]
struct WeightedSet {
    sources: Vec<usize>,
    /// Likelihood against the others; all together are 1.
    weight: f64,
    freedom: usize,
    /// Size and standard deviation of each column that it has.
    sizes: BTreeMap<FitColumn, [f64; 2]>,
}

/// Columns without what all of them have in common: coordinates along an orthonormal basis of all, which lengths and
/// angles are the same in.
struct Coordinates {
    columns: Vec<Vec<Vec<f64>>>,
    always: Vec<Vec<f64>>,
    off: Vec<f64>,
}

impl Coordinates {
    fn new(of: &Selection, candidates: &[usize]) -> Self {
        let basis = of.basis(candidates);
        let within = |column: &[f64]| [basis.beside(column).1, vec![0.0]].concat();
        let (rest, along) = basis.beside(of.off);
        let of_source = |(source, columns): (usize, &Vec<Vec<f64>>)| {
            let candidate = candidates.contains(&source);
            columns.iter().map(|column| if candidate { within(column) } else { Vec::new() }).collect()
        };
        Self {
            columns: of.columns.iter().enumerate().map(of_source).collect(),
            always: of.always.iter().map(|column| within(column)).collect(),
            off: [along, vec![norm(&rest)]].concat(),
        }
    }
}

/// What sets are compared by.
struct SetComparison<'a> {
    fit: Selection<'a>,
    /// Sources that were chosen: they take columns up before others do.
    chosen: &'a [usize],
    /// Values.
    count: usize,
    /// Variance of the residuals over that of the stated noise.
    variance: f64,
}

impl SetComparison<'_> {
    /// A set's basis, and the columns that it takes up; `None` where a source adds nothing to the others, for it is the
    /// set without that source.
    fn basis(&self, set: &[usize]) -> Option<(ColumnBasis, Vec<FitColumn>)> {
        let is_chosen = |source: &&usize| self.chosen.contains(source);
        let first = self.chosen.iter().filter(|source| set.contains(source));
        let mut basis = ColumnBasis::default();
        let mut taken = Vec::new();
        for (place, column) in self.fit.always.iter().enumerate() {
            if basis.take(column) {
                taken.push(FitColumn::Always(place));
            }
        }
        for &source in first.chain(set.iter().filter(|source| !is_chosen(source))) {
            let before = taken.len();
            for (place, column) in self.fit.columns[source].iter().enumerate() {
                if basis.take(column) {
                    taken.push(FitColumn::Of(source, place));
                }
            }
            if taken.len() == before {
                return None;
            }
        }
        Some((basis, taken)).filter(|(basis, _)| basis.columns() < self.count)
    }

    /// BIC but for what all sets have in common.
    fn criterion(&self, set: &[usize]) -> Option<f64> {
        let (basis, taken) = self.basis(set)?;
        Some(basis.left_of(self.fit.off) / self.variance + taken.len() as f64 * (self.count as f64).ln())
    }

    /// Sets in Occam's window with their criteria.
    fn window(&self, candidates: &[usize]) -> Vec<(Vec<usize>, f64)> {
        let reach = -2.0 * WINDOW.ln();
        // The way from one set to another may lead over a set with a size too many.
        let way_over = (self.count as f64).ln();
        let mut start = self.chosen.to_vec();
        start.sort_unstable();
        let mut known: BTreeMap<Vec<usize>, Option<f64>> = BTreeMap::new();
        let mut open: Vec<(Vec<usize>, f64)> = Vec::new();
        let mut found: Vec<(Vec<usize>, f64)> = Vec::new();
        let criterion = self.criterion(&start);
        known.insert(start.clone(), criterion);
        open.extend(criterion.map(|criterion| (start, criterion)));
        let mut best = f64::INFINITY;
        while let Some(place) = (0..open.len()).min_by(|&a, &b| open[a].1.total_cmp(&open[b].1)) {
            let (set, criterion) = open.swap_remove(place);
            best = best.min(criterion);
            if criterion > best + reach + way_over || found.len() >= MOST_SETS {
                break;
            }
            for near in neighbours(&set, candidates) {
                if known.contains_key(&near) {
                    continue;
                }
                let criterion = self.criterion(&near);
                open.extend(criterion.map(|criterion| (near.clone(), criterion)));
                known.insert(near, criterion);
            }
            found.push((set, criterion));
        }
        found.retain(|(_, criterion)| *criterion <= best + reach);
        found
    }
}

/// Sets with one source more, one less, or one exchanged.
fn neighbours(set: &[usize], candidates: &[usize]) -> Vec<Vec<usize>> {
    let without = (0..set.len()).map(|place| [&set[..place], &set[place + 1..]].concat());
    let smaller: Vec<Vec<usize>> = without.collect();
    let with = |set: &Vec<usize>, other: usize| {
        let mut larger = set.clone();
        larger.insert(set.partition_point(|&source| source < other), other);
        larger
    };
    let others = candidates.iter().copied().filter(|other| !set.contains(other));
    let of_other = others.flat_map(|other| {
        let exchanged = smaller.iter().map(move |set| with(set, other));
        exchanged.chain([with(&set.to_vec(), other)])
    });
    of_other.chain(smaller.iter().cloned()).collect()
}

impl Averaging {
    /// Sets beside the chosen one, of these candidates; `variance` is that of the residuals over the stated noise's.
    pub fn new(fit: &Selection, candidates: &[usize], chosen: &[usize], variance: f64) -> Self {
        let Coordinates { columns, always, off } = Coordinates::new(fit, candidates);
        let short = Selection { columns: &columns, always: &always, off: &off };
        let of = SetComparison { fit: short, chosen, count: fit.off.len(), variance };
        let window = of.window(candidates);
        let best = window.iter().map(|(_, criterion)| *criterion).fold(f64::INFINITY, f64::min);
        let mut sets = Vec::new();
        for (sources, criterion) in window {
            let (basis, taken) = of.basis(&sources).expect("it has a criterion");
            let solution = basis.solve(&off);
            let deviation = |place: usize| (variance * solution.covariance[place][place]).sqrt();
            let sizes = taken.into_iter().enumerate();
            let sizes = sizes.map(|(place, column)| (column, [solution.values[place], deviation(place)])).collect();
            let freedom = of.count - basis.columns();
            sets.push(WeightedSet { sources, weight: (0.5 * (best - criterion)).exp(), freedom, sizes });
        }
        let all: f64 = sets.iter().map(|set| set.weight).sum();
        for set in &mut sets {
            set.weight /= all;
        }
        Self { sets }
    }

    /// How sure a source is: the weight of all sets that have it.
    pub fn weight(&self, source: usize) -> f64 {
        self.sets.iter().filter(|set| set.sources.contains(&source)).map(|set| set.weight).sum()
    }

    /// The 95 % interval of the size of a column.
    pub fn interval(&self, column: FitColumn) -> [f64; 2] {
        [TAIL, 1.0 - TAIL].map(|share| self.quantile(column, share))
    }

    /// The least size that at least this share of the distribution does not exceed.
    fn quantile(&self, column: FitColumn, share: f64) -> f64 {
        let fitted = || self.sets.iter().filter_map(|set| set.sizes.get(&column).map(|of| (set, of)));
        let continuous = |size: f64| -> f64 {
            fitted().map(|(set, [mean, sd])| set.weight * share_below((size - mean) / sd, set.freedom)).sum()
        };
        let none = 1.0 - fitted().map(|(set, _)| set.weight).sum::<f64>();
        let at_zero = continuous(0.0);
        if none > 0.0 && (at_zero..=at_zero + none).contains(&share) {
            return 0.0;
        }
        // 0 is below all positive sizes.
        let wanted = if at_zero < share { share - none } else { share };
        // A quantile of all lies between those of the sets.
        let half = |freedom: usize, sd: f64| BEYOND * interval(freedom) * sd;
        let ends = |sign: f64| fitted().map(move |(set, [mean, sd])| mean + sign * half(set.freedom, *sd));
        let [low, high] = [ends(-1.0).fold(0.0, f64::min), ends(1.0).fold(0.0, f64::max)];
        bisect(|size| continuous(size) < wanted, low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values that either of two equal columns explains, and waves of standard deviation 1 beside.
    fn twins(count: usize) -> ([Vec<Vec<f64>>; 2], Vec<f64>) {
        let wave = |order: usize| (0..count).map(move |i| (order * i) as f64 * std::f64::consts::TAU / count as f64);
        let one: Vec<f64> = wave(1).map(f64::cos).collect();
        let noise = wave(7).map(|angle| 2.0_f64.sqrt() * angle.sin());
        let off = one.iter().zip(noise).map(|(one, noise)| 3.0 * one + noise).collect();
        ([vec![one.clone()], vec![one]], off)
    }

    /// Where two columns are the same, each has half the weight: 0 is the lower end, and above the upper one lie 5 % of
    /// the normal distribution of half the weight, 1.645 standard deviations sqrt(2 / n) from the size.
    #[test]
    fn twins_have_half_the_weight_each() {
        let count = 4000;
        let ((columns, off), turn) = (twins(count), [vec![1.0; count]]);
        let fit = Selection { columns: &columns, always: &turn, off: &off };
        let sets = Averaging::new(&fit, &[0, 1], &[0], 1.0);
        assert!((sets.weight(0) - 0.5).abs() < 1e-9 && (sets.weight(1) - 0.5).abs() < 1e-9);
        let [low, high] = sets.interval(FitColumn::Of(0, 0));
        let expected = 3.0 + 1.644_854 * (2.0 / count as f64).sqrt();
        assert!(low == 0.0 && (high - expected).abs() < 1e-6, "{low} to {high}, expected {expected}");
        // One of them alone has the interval of its own fit.
        let alone = Averaging::new(&fit, &[0], &[0], 1.0);
        let [low, high] = alone.interval(FitColumn::Of(0, 0));
        let half = 1.959_964 * (2.0 / count as f64).sqrt();
        assert!((low - (3.0 - half)).abs() < 1e-6 && (high - (3.0 + half)).abs() < 1e-6, "{low} to {high}");
    }

    /// By hand: a column that takes z^2 off the squared residuals, alone or not at all, has the odds
    /// exp(z^2 / 2) / sqrt(n).
    #[test]
    fn weights_are_those_of_bic_by_hand() {
        let count = 100;
        let ((columns, off), turn) = (twins(count), [vec![1.0; count]]);
        let small: Vec<f64> = off.iter().zip(&columns[0][0]).map(|(off, one)| off - 2.6 * one).collect();
        let z_squared = 0.4_f64.powi(2) * count as f64 / 2.0;
        let fit = Selection { columns: &columns, always: &turn, off: &small };
        let odds = (0.5 * z_squared).exp() / (count as f64).sqrt();
        let sets = Averaging::new(&fit, &[0], &[], 1.0);
        assert!((sets.weight(0) - odds / (1.0 + odds)).abs() < 1e-9, "{} for odds {odds}", sets.weight(0));
        // Residuals of four times the variance make both sets more alike.
        let sets = Averaging::new(&fit, &[0], &[], 4.0);
        let odds = (0.125 * z_squared).exp() / (count as f64).sqrt();
        assert!((sets.weight(0) - odds / (1.0 + odds)).abs() < 1e-9, "{} for odds {odds}", sets.weight(0));
    }
}
