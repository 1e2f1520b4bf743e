//! What a parameter does to a kept quantity: its share of the quantity's variance, and the quantity's mean along it.
//!
//! In: the values of a parameter and of a quantity, case by case. Out: [`Effect`].
//!
//! Law: cases are parted by the parameter, one part for each value where values come again, else parts of as many cases
//! each. The first-order index of Sobol (*Math. Model. Comput. Exp.* 1, 1993) is the variance of the parts' means over
//! the variance of all cases (from given cases: Plischke, Borgonovo and Smith, *Eur. J. Oper. Res.* 226, 2013). Means
//! of few cases scatter by chance, and that would count as an effect: it is taken off (Kelley, *Proc. Nat. Acad. Sci.*
//! 21, 1935). Cases of a balanced design scatter less than that, so that the 95 % interval ends above the index without
//! it: half of it on either side is that of a jackknife that leaves a twentieth of the cases out (Kott, *J. Off. Stat.*
//! 17, 2001). What all shares together lack of 100 % is what parameters do together, and chance. In a whole grid every
//! part has the same values of all other parameters: no chance is in its mean, and the index is exact for the grid.
//!
//! The total index is the share that is lost where a parameter is fixed: half the mean square of what the quantity
//! changes between two cases that differ in this parameter alone, over the variance (Jansen, *Comput. Phys. Commun.*
//! 117, 1999). It asks for a design with such pairs ([`super::plan::SampleDesign::SobolPairs`]).

use super::design::in_an_order_of_chance;
use crate::influence::interval::interval;

/// Most values that are parts of their own, and most parts of a range.
const MOST_PARTS: usize = 32;
/// Fewest cases of a part of a range.
const LEAST_IN_A_PART: usize = 4;
/// Groups of the jackknife.
const GROUPS: usize = 20;
/// Values that differ by less, in the unit of their quantity or as a share of them, are the same but for rounding: the
/// centre distance of a round gear has accelerations of 1e-20 mm/s^2.
const ROUNDING: f64 = 1e-12;

/// Which cases of a study an effect is found from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StudiedCases {
    /// Every value of each parameter with every value of the others.
    WholeGrid,
    /// Samples of ranges, or a grid with holes.
    Some,
}

/// What a parameter does to a quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// Mean of the quantity in each part, in the order of the parameter.
    pub parts: Vec<EffectPart>,
    /// First-order index; none where the quantity is the same in all cases, or the cases are too few to part.
    pub share: Option<VarianceShare>,
    /// Total index; none where no cases come in pairs.
    pub total: Option<VarianceShare>,
}

/// Cases with nearly the same value of the parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectPart {
    /// The value, or the mean of the values.
    pub at: String,
    /// The same as a number, if it is one.
    pub number: Option<f64>,
    /// Mean of the quantity.
    pub mean: f64,
    /// Cases.
    pub cases: usize,
}

/// An index of Sobol: from 0 to 1 but for chance, of which a little more may be taken off a first-order one than it
/// added.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VarianceShare {
    /// The index.
    pub index: f64,
    /// Its 95 % interval.
    pub interval: [f64; 2],
}

impl Effect {
    /// Of values of a parameter, as texts, and of a quantity, one for each case; of a whole grid, or of some cases.
    pub fn of(values: &[&str], quantity: &[f64], cases: StudiedCases) -> Self {
        let numbers: Option<Vec<f64>> = values.iter().map(|value| value.parse().ok()).collect();
        let parts = parted(values, numbers.as_deref());
        let part_of = |cases: &Vec<usize>| {
            let number = numbers.as_ref().map(|numbers| mean(cases.iter().map(|&case| numbers[case])));
            let is_one = cases.iter().all(|&case| values[case] == values[cases[0]]);
            let at = match number {
                Some(number) if !is_one => format!("{number}"),
                _ => values[cases[0]].to_owned(),
            };
            EffectPart { at, number, mean: mean(cases.iter().map(|&case| quantity[case])), cases: cases.len() }
        };
        let share = if parts.len() > 1 { first_order(&parts, quantity, cases) } else { None };
        Self { parts: parts.iter().map(part_of).collect(), share, total: None }
    }

    /// By how much the means of the parts differ at most.
    pub fn swing(&self) -> f64 {
        let means = self.parts.iter().map(|part| part.mean);
        let [low, high] = means.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], mean| [l.min(mean), h.max(mean)]);
        if is_rounding(high - low, high) { 0.0 } else { high - low }
    }
}

/// Cases by parts, in the order of numbers, else in that in which values first come. Too many words are one part: they
/// have no neighbours.
fn parted(values: &[&str], numbers: Option<&[f64]>) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    if let Some(numbers) = numbers {
        order.sort_by(|&a, &b| numbers[a].total_cmp(&numbers[b]));
    }
    let mut own: Vec<Vec<usize>> = Vec::new();
    for &case in &order {
        match own.iter_mut().find(|part| values[part[0]] == values[case]) {
            Some(part) => part.push(case),
            None => own.push(vec![case]),
        }
        if own.len() > MOST_PARTS {
            break;
        }
    }
    if own.len() <= MOST_PARTS && (numbers.is_none() || values.len() >= 2 * own.len()) {
        return own;
    }
    if numbers.is_none() {
        return vec![order];
    }
    let count = (values.len() as f64).sqrt().min((values.len() / LEAST_IN_A_PART) as f64);
    let count = (count as usize).clamp(1, MOST_PARTS);
    (0..count).map(|part| order[part * order.len() / count..(part + 1) * order.len() / count].to_vec()).collect()
}

fn first_order(parts: &[Vec<usize>], quantity: &[f64], cases: StudiedCases) -> Option<VarianceShare> {
    let [index, with_chance] = indices_without(parts, quantity, &|_| true)?;
    if cases == StudiedCases::WholeGrid {
        return Some(VarianceShare { index: with_chance, interval: [with_chance; 2] });
    }
    let half = half_interval(quantity.len(), |counts| Some(indices_without(parts, quantity, counts)?[0]));
    Some(VarianceShare { index, interval: [index - half, with_chance + half] })
}

/// Half the 95 % interval of what `without` makes of the cases that count, left out group by group.
fn half_interval(cases: usize, without: impl Fn(&dyn Fn(usize) -> bool) -> Option<f64>) -> f64 {
    let mut group = vec![0; cases];
    let groups = GROUPS.min(cases);
    for (place, case) in in_an_order_of_chance(cases as u32).into_iter().enumerate() {
        group[case as usize] = place % groups;
    }
    let found: Vec<f64> = (0..groups).filter_map(|left_out| without(&|case| group[case] != left_out)).collect();
    let centre = mean(found.iter().copied());
    let squares: f64 = found.iter().map(|index| (index - centre).powi(2)).sum();
    interval(groups - 1) * (squares * (groups - 1) as f64 / groups as f64).sqrt()
}

/// The total index from the quantity at the two points of each pair, and where the first one has the parameter of the
/// second one; none of fewer than two pairs, and where the quantity does not differ.
pub fn total(pairs: &[[f64; 3]]) -> Option<VarianceShare> {
    if pairs.len() < 2 {
        return None;
    }
    let of = |counts: &dyn Fn(usize) -> bool| {
        let own: Vec<&[f64; 3]> = (0..pairs.len()).filter(|&pair| counts(pair)).map(|pair| &pairs[pair]).collect();
        let points = || own.iter().flat_map(|[first, second, _]| [*first, *second]);
        let centre = mean(points());
        let variance = points().map(|value| (value - centre).powi(2)).sum::<f64>() / (2 * own.len() - 1) as f64;
        let changes = mean(own.iter().map(|[first, _, between]| 0.5 * (between - first).powi(2)));
        (!is_rounding(variance.sqrt(), centre)).then(|| changes / variance)
    };
    let index = of(&|_| true)?;
    let half = half_interval(pairs.len(), of);
    Some(VarianceShare { index, interval: [index - half, index + half] })
}

/// The index of the cases that count, without and with what chance may make of it; none where the quantity does not
/// differ, or each part has one case.
fn indices_without(parts: &[Vec<usize>], quantity: &[f64], counts: &dyn Fn(usize) -> bool) -> Option<[f64; 2]> {
    let parts = parts.iter().map(|part| part.iter().filter(|&&case| counts(case)).map(|&case| quantity[case]));
    let parts: Vec<Vec<f64>> = parts.map(Iterator::collect).filter(|part: &Vec<f64>| !part.is_empty()).collect();
    let all = mean(parts.iter().flatten().copied());
    let cases: usize = parts.iter().map(Vec::len).sum();
    let squares = |values: &[f64], about: f64| values.iter().map(|value| (value - about).powi(2)).sum::<f64>();
    let total: f64 = parts.iter().map(|part| squares(part, all)).sum();
    let within: f64 = parts.iter().map(|part| squares(part, mean(part.iter().copied()))).sum();
    let freedom = cases.checked_sub(parts.len()).filter(|&freedom| freedom > 0)?;
    let by_chance = (parts.len() - 1) as f64 * within / freedom as f64;
    let deviation = (total / cases as f64).sqrt();
    (!is_rounding(deviation, all)).then(|| [by_chance, 0.0].map(|off| (total - within - off) / total))
}

fn is_rounding(difference: f64, of: f64) -> bool {
    difference <= ROUNDING * of.abs().max(1.0)
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), value| (sum + value, count + 1));
    sum / count as f64
}

#[cfg(test)]
mod tests {
    use super::super::design::sobol;
    use super::*;
    use std::f64::consts::PI;

    fn indices(count: u32, dimensions: usize, of: impl Fn(&[f64]) -> f64) -> Vec<VarianceShare> {
        let points: Vec<Vec<f64>> =
            (0..count).map(|sample| (0..dimensions).map(|dimension| sobol(dimension, sample)).collect()).collect();
        let quantity: Vec<f64> = points.iter().map(|point| of(point)).collect();
        let index = |dimension: usize| {
            let values: Vec<String> = points.iter().map(|point| format!("{:?}", point[dimension])).collect();
            let values: Vec<&str> = values.iter().map(String::as_str).collect();
            Effect::of(&values, &quantity, StudiedCases::Some).share.expect("cases enough")
        };
        (0..dimensions).map(index).collect()
    }

    /// Ishigami and Homma (1990), a = 7, b = 0.1: first-order indices 0.3139, 0.4424 and 0 (Saltelli et al., *Global
    /// Sensitivity Analysis*, 2008).
    #[test]
    fn indices_of_a_known_function_are_within_their_intervals() {
        let found = indices(2047, 3, |x| {
            let [x, y, z] = [x[0], x[1], x[2]].map(|share| PI * (2.0 * share - 1.0));
            x.sin() + 7.0 * y.sin().powi(2) + 0.1 * z.powi(4) * x.sin()
        });
        for (found, expected) in found.iter().zip([0.3139, 0.4424, 0.0]) {
            let [low, high] = found.interval;
            assert!(low <= expected && expected <= high, "{found:?} for {expected}");
            assert!((found.index - expected).abs() < 0.02 && high - low < 0.14, "{found:?} for {expected}");
        }
    }

    /// Of a linear budget the index is the square of each term over their sum.
    /// Total indices by the design of a study: Ishigami's function has 0.5576, 0.4424 and 0.2437 (Saltelli et al.), of
    /// which the third is all of it what x and z do together; a sum of terms has its first-order indices again.
    #[test]
    fn total_indices_of_known_functions_are_within_their_intervals() {
        use super::super::parameter::{ParameterValues, StudyParameter, ValueRange};
        use super::super::plan::{SampleDesign, StudyPlan};
        type Known<'a> = (&'a dyn Fn(&[f64]) -> f64, [f64; 3]);
        let ishigami = |x: &[f64]| {
            let [x, y, z] = [x[0], x[1], x[2]].map(|share| PI * (2.0 * share - 1.0));
            x.sin() + 7.0 * y.sin().powi(2) + 0.1 * z.powi(4) * x.sin()
        };
        let linear = |x: &[f64]| 4.0 * x[0] + 2.0 * x[1] + x[2];
        let functions: [Known<'_>; 2] =
            [(&ishigami, [0.5576, 0.4424, 0.2437]), (&linear, [16.0 / 21.0, 4.0 / 21.0, 1.0 / 21.0])];
        let range = ValueRange::new([0.0, 1.0], false, false).expect("a range");
        let parameter = |key: &str| StudyParameter { key: key.to_owned(), choice: ParameterValues::Between(range) };
        let parameters = ["x", "y", "z"].map(parameter).to_vec();
        let plan = StudyPlan::new(parameters, (Some(511), SampleDesign::SobolPairs, 0), 10_000).expect("a plan");
        assert_eq!(plan.cases(), 5 * 511);
        for (of, expected) in functions {
            let value = |case: u64| {
                let point: Vec<f64> = plan.values(case).iter().map(|text| text.parse().expect("a number")).collect();
                of(&point)
            };
            for (place, expected) in expected.into_iter().enumerate() {
                let pairs = (0..plan.cases()).filter_map(|case| Some((case, plan.partners(case, place)?)));
                let pairs: Vec<[f64; 3]> =
                    pairs.map(|(case, [second, between])| [case, second, between].map(value)).collect();
                assert_eq!(pairs.len(), 511);
                let found = total(&pairs).expect("pairs enough");
                let [low, high] = found.interval;
                assert!(low <= expected && expected <= high, "{found:?} for {expected}");
                // Another program finds errors of 0.017 at most on these points, and ends of intervals 0.20 away at
                // most over 200 ways to group the pairs.
                assert!((found.index - expected).abs() < 0.02 && high - low < 0.4, "{found:?} for {expected}");
                // Planted: of the points alone, which have nothing to do with each other, every index would be 1.
                let wrong: Vec<[f64; 3]> = pairs.iter().map(|[first, second, _]| [*first, *second, *second]).collect();
                assert!((total(&wrong).expect("pairs enough").index - 1.0).abs() < 0.1);
            }
        }
    }

    #[test]
    fn a_linear_budget_has_the_squares_of_its_terms() {
        let terms = [4.0, 2.0, 1.0, 0.0];
        let whole: f64 = terms.iter().map(|term| term * term).sum();
        let found = indices(1023, 4, |x| x.iter().zip(terms).map(|(x, term)| term * x).sum());
        for (found, term) in found.iter().zip(terms) {
            let expected = term * term / whole;
            let [low, high] = found.interval;
            assert!(low <= expected && expected <= high, "{found:?} for {expected}");
            assert!((found.index - expected).abs() < 0.04, "{found:?} for {expected}");
        }
    }

    /// Scallops of K / N^2 at listed numbers of strokes N, and cutters that do nothing: all of the variance is that of
    /// the strokes, and means are the law.
    #[test]
    fn listed_values_are_parts_of_their_own() {
        let strokes = ["600", "1200", "2400", "4800"];
        let cases: Vec<(&str, &str)> =
            strokes.iter().flat_map(|&n| ["20", "26", "34"].map(|cutter| (n, cutter))).collect();
        let scallop = |n: &str| 3.6e6 / n.parse::<f64>().expect("a number").powi(2);
        let quantity: Vec<f64> = cases.iter().map(|(n, _)| scallop(n)).collect();
        let [strokes_of, cutters]: [Vec<&str>; 2] =
            [cases.iter().map(|of| of.0).collect(), cases.iter().map(|of| of.1).collect()];
        let effect = Effect::of(&strokes_of, &quantity, StudiedCases::WholeGrid);
        assert_eq!(effect.parts.iter().map(|part| part.at.as_str()).collect::<Vec<_>>(), strokes);
        assert!(effect.parts.iter().all(|part| (part.mean - scallop(&part.at)).abs() < 1e-12 && part.cases == 3));
        assert!((effect.share.expect("cases enough").index - 1.0).abs() < 1e-12);
        assert!((effect.swing() - scallop("600") + scallop("4800")).abs() < 1e-12);
        let none = |cases| Effect::of(&cutters, &quantity, cases);
        let [grid, some] = [StudiedCases::WholeGrid, StudiedCases::Some].map(none);
        let [grid_share, some_share] = [&grid, &some].map(|of| of.share.expect("cases enough"));
        assert!(grid_share.index.abs() < 1e-12 && grid_share.interval == [grid_share.index; 2]);
        assert!(some_share.index < -0.01, "what chance may have added is taken off");
        assert!(grid.swing() < 1e-12);
        let words =
            Effect::of(&["normal", "traditional", "normal", "traditional"], &[1.0, 3.0, 1.0, 3.0], StudiedCases::Some);
        assert_eq!(words.parts.iter().map(|part| part.at.as_str()).collect::<Vec<_>>(), ["normal", "traditional"]);
        assert_eq!(words.swing(), 2.0);
    }

    /// x + 2 y + x y over x of 0, 1, 2 and y of 0, 1: by hand the means along x are 1 + 1.5 x, with the variance 1.5,
    /// those along y are 1 + 3 y, with 2.25, and the whole variance is 47/12: the sixth that is left is what both do
    /// together.
    #[test]
    fn shares_of_a_grid_are_those_by_hand() {
        let cases = ["0", "1", "2"].into_iter().flat_map(|x| ["0", "1"].map(|y| (x, y)));
        let cases: Vec<(&str, &str)> = cases.collect();
        let number = |text: &str| text.parse::<f64>().expect("a number");
        let value = |&(x, y): &(&str, &str)| number(x) + 2.0 * number(y) + number(x) * number(y);
        let quantity: Vec<f64> = cases.iter().map(value).collect();
        let share =
            |values: Vec<&str>| Effect::of(&values, &quantity, StudiedCases::WholeGrid).share.expect("enough").index;
        let [x, y] = [share(cases.iter().map(|of| of.0).collect()), share(cases.iter().map(|of| of.1).collect())];
        let whole = 47.0 / 12.0;
        assert!((x - 1.5 / whole).abs() < 1e-12 && (y - 2.25 / whole).abs() < 1e-12, "{x} and {y} of {whole}");
    }

    #[test]
    fn what_cannot_be_found_is_not_stated() {
        let of = |values: &[&str], quantity: &[f64]| Effect::of(values, quantity, StudiedCases::Some);
        assert_eq!(of(&["1", "2", "3"], &[1.0, 2.0, 3.0]).share, None, "three cases are no study");
        let words: Vec<String> = (0..80).map(|case| format!("word {}", case % 40)).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let many = of(&words, &(0..80).map(f64::from).collect::<Vec<_>>());
        assert_eq!((many.share, many.parts.len(), many.swing()), (None, 1, 0.0), "40 words are no range");
        let alike = of(&["1", "1", "2", "2"], &[5.0; 4]);
        assert_eq!((alike.share, alike.swing()), (None, 0.0));
        let rounding = of(&["1", "1", "2", "2"], &[1e-20, 2e-20, 6e-20, 7e-20]);
        assert_eq!((rounding.share, rounding.swing()), (None, 0.0));
        assert_eq!([total(&[]), total(&[[1.0, 2.0, 3.0]]), total(&[[5.0; 3]; 4])], [None; 3]);
    }
}
