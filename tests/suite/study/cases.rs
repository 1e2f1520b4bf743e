//! Which cases there are: combinations, ranges, samples, shares.

use gearcut::study::design::{latin_hypercube, sobol};
use gearcut::study::parameter::{GridWords, NormalValues, RangeWords, StudyParameter};
use gearcut::study::plan::{SampleDesign, Shard, StudyPlan, USUAL_CASES};

fn grid(text: &str) -> StudyParameter {
    text.parse::<GridWords>().expect("a parameter").0
}

fn range(text: &str) -> StudyParameter {
    text.parse::<RangeWords>().expect("a parameter").0
}

/// Points 2 and 100 of 21 dimensions, as scipy.stats.qmc.Sobol(21, scramble=False) of scipy 1.17 gives them.
#[test]
fn points_of_sobols_sequence_are_those_of_another_program() {
    let expected = [
        (
            2,
            [
                0.75, 0.25, 0.25, 0.25, 0.75, 0.75, 0.25, 0.75, 0.75, 0.75, 0.75, 0.75, 0.25, 0.25, 0.75, 0.25, 0.75,
                0.25, 0.75, 0.25, 0.25,
            ],
        ),
        (
            100,
            [
                0.4140625, 0.2578125, 0.7734375, 0.7265625, 0.8828125, 0.7421875, 0.0234375, 0.4765625, 0.6328125,
                0.6953125, 0.4609375, 0.6796875, 0.4765625, 0.8515625, 0.3203125, 0.4921875, 0.6796875, 0.7421875,
                0.8359375, 0.3359375, 0.7578125,
            ],
        ),
    ];
    for (point, expected) in expected {
        // The first point of the sequence is left out.
        let found: Vec<f64> = (0..21).map(|dimension| sobol(dimension, point - 1)).collect();
        assert_eq!(found, expected, "point {point}");
    }
    assert!((0..21).all(|dimension| sobol(dimension, 0) == 0.5));
}

/// Of n samples one lies in each n-th of the range, and the shares of two parameters have nothing to do with each
/// other: their correlation scatters by 1 / sqrt(n - 1).
#[test]
fn a_latin_hypercube_has_one_sample_in_every_share() {
    let n = 400;
    let [first, second] = [0, 1].map(|parameter| latin_hypercube(7, parameter, n));
    for values in [&first, &second] {
        let mut shares: Vec<u32> = values.iter().map(|value| (value * f64::from(n)).ceil() as u32 - 1).collect();
        shares.sort_unstable();
        assert_eq!(shares, (0..n).collect::<Vec<_>>());
    }
    let products = first.iter().zip(&second).map(|(a, b)| (a - 0.5) * (b - 0.5)).sum::<f64>();
    let correlation = 12.0 * products / f64::from(n);
    assert!(correlation.abs() < 4.0 / f64::from(n - 1).sqrt(), "{correlation}");
    assert_eq!(latin_hypercube(7, 0, n), first);
    assert_ne!(latin_hypercube(8, 0, n), first);
}

#[test]
fn cases_are_all_combinations_and_shards_share_them() {
    let parameters = || vec![grid("gear.teeth=20,24,28"), range("a.b_mm=0.2..1.0/2"), grid("c={x=[1, 2]},{y=\"p,q\"}")];
    let plan = StudyPlan::new(parameters(), (None, SampleDesign::Sobol, 0), USUAL_CASES).expect("a plan");
    assert_eq!(plan.cases(), 12);
    assert_eq!(plan.settings(0), ["gear.teeth=20", "a.b_mm=0.2", "c={x=[1, 2]}"]);
    assert_eq!(plan.settings(1), ["gear.teeth=20", "a.b_mm=0.2", "c={y=\"p,q\"}"]);
    assert_eq!(plan.settings(11), ["gear.teeth=28", "a.b_mm=1.0", "c={y=\"p,q\"}"]);
    let all: std::collections::BTreeSet<Vec<String>> = (0..12).map(|case| plan.settings(case)).collect();
    assert_eq!(all.len(), 12);
    let shards: Vec<Shard> = ["1/3", "2/3", "3/3"].map(|text| text.parse().expect("a share")).to_vec();
    assert!((0..12).all(|case| shards.iter().filter(|shard| shard.has(case)).count() == 1));
    for text in ["0/3", "4/3", "1", "a/b", "1/0"] {
        assert!(text.parse::<Shard>().is_err(), "{text}");
    }
}

/// The middle of a range is the mean of its ends, of a logarithmic one their geometric mean.
#[test]
fn ranges_are_even_or_even_in_logarithms() {
    let values = |text: &str| {
        let plan = StudyPlan::new(vec![range(text)], (None, SampleDesign::Sobol, 0), USUAL_CASES).expect("a plan");
        (0..plan.cases()).map(|case| plan.values(case)[0].clone()).collect::<Vec<_>>()
    };
    assert_eq!(values("k=0.0..1.0/5"), ["0.0", "0.25", "0.5", "0.75", "1.0"]);
    assert_eq!(values("k=1..9/5"), ["1", "3", "5", "7", "9"]);
    assert_eq!(values("k=100..10000/3 log"), ["100", "1000", "10000"]);
    let sampled =
        StudyPlan::new(vec![range("k=2.0..4.0")], (Some(3), SampleDesign::Sobol, 0), USUAL_CASES).expect("a plan");
    assert_eq!([0, 1, 2].map(|case| sampled.values(case)[0].clone()), ["3.0", "3.5", "2.5"]);
}

#[test]
fn what_is_no_study_is_refused() {
    for text in ["k", "k=", "k=1..2/1", "k=2..1/3", "k=1..3/9", "k=0.0..1.0/3 log", "k=a..b/3", "k=1", "k=nan..2/3"] {
        assert!(text.parse::<RangeWords>().is_err(), "{text}");
    }
    let refused = |parameters: Vec<StudyParameter>, samples, most| {
        StudyPlan::new(parameters, (samples, SampleDesign::Sobol, 0), most).expect_err("no plan").problem
    };
    assert!(refused(vec![], None, 9).contains("no key differs"));
    assert!(refused(vec![grid("k=1,2"), grid("k=3")], None, 9).contains("`k` is a parameter twice"));
    assert!(refused(vec![grid("k=1,2")], Some(3), 9).contains("samples of nothing"));
    assert!(refused(vec![range("k=1..2")], None, 9).contains("not said how often"));
    assert!(refused(vec![grid("k=1,2,3,4"), grid("l=1,2,3")], None, 9).contains("12 cases are more than 9"));
    let many = (0..22).map(|k| range(&format!("k{k}=1..2"))).collect();
    assert!(refused(many, Some(4), 9).contains("22 parameters are more than the 21"));
}

/// Quantiles of the normal distribution (Abramowitz and Stegun, 1964, table 26.1): 84.134 % lie below one deviation
/// over the mean, 97.725 % below two.
#[test]
fn values_of_a_tolerance_are_those_of_tables() {
    let of = NormalValues::new([5.0, 1.5]).expect("a distribution");
    let at = |share: f64| of.at(share).parse::<f64>().expect("a number");
    for (share, expected) in [(0.5, 5.0), (0.841_344_7, 6.5), (0.158_655_3, 3.5), (0.977_249_9, 8.0)] {
        assert!((at(share) - expected).abs() < 1e-5, "{share}: {}", at(share));
    }
    assert!(at(1.0).is_finite() && at(1.0) > 15.0);
    assert!(NormalValues::new([5.0, 0.0]).is_err() && NormalValues::new([f64::NAN, 1.0]).is_err());
}
