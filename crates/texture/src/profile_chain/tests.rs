use super::*;
use std::f64::consts::TAU;

fn trace(count: usize, spacing_um: f64, at: impl Fn(f64) -> f64) -> ProfileTrace {
    ProfileTrace::new((0..count).map(|i| at(i as f64 * spacing_um)).collect(), spacing_um).expect("a line")
}

fn wave(x: f64, length: f64) -> f64 {
    (TAU * x / length).sin()
}

fn one(chain: &ProfileChain, trace: &ProfileTrace) -> (Profile, Vec<String>) {
    let found = chain.evaluate(std::slice::from_ref(trace)).expect("a line that suits");
    (found.lines[0].clone().expect("a profile"), found.words)
}

fn near(value: f64, closed: f64, share: f64) {
    assert!((value - closed).abs() <= share * closed.abs(), "{value} is not {closed}");
}

/// Roughness of 0.1 mm over a wave of 4 mm: 0.8 mm leaves 1 - 2^-0.04 of the wave, 1 - 2^-64 of the roughness.
#[test]
fn waves_longer_than_the_cutoff_are_no_roughness() {
    // Even about the middle, so that the wave has no tilt of its own.
    let line = trace(1601, 5.0, |x| wave(x + 1000.0, 4000.0) + 0.1 * wave(x, 100.0));
    let chain = ProfileChain { cutoff: CutOff::Um(800.0), ..ProfileChain::default() };
    let (rough, words) = one(&chain, &line);
    let left = 1.0 - 2_f64.powf(-0.04);
    near(rough.q, (0.5 * (0.01 + left * left)).sqrt(), 1e-3);
    near(rough.a, 0.0647, 5e-3);
    assert!(words.contains(&"profile L-filter: Gaussian, ISO 16610-21, cut-off 800 um".to_owned()), "{words:?}");
    assert!(words.iter().any(|w| w.contains("5 of 800 um in the middle")), "{words:?}");
    // What is called primary is all of it, what is called waviness the rest of the wave.
    let of_kind = |kind| one(&ProfileChain { kind, ..chain }, &line).0;
    near(of_kind(ProfileKind::Primary).q, (0.5 * 1.01_f64).sqrt(), 1e-3);
    near(of_kind(ProfileKind::Waviness).q, 2_f64.powf(-0.04) / 2_f64.sqrt(), 1e-3);
}

#[test]
fn the_class_gives_the_cutoff_and_a_short_line_the_next_that_fits() {
    let rough = |x: f64| 0.5 * wave(x, 50.0);
    let cutoff = |line: &ProfileTrace, cutoff| {
        let chain = ProfileChain { cutoff, ..ProfileChain::default() };
        let found = chain.evaluate(std::slice::from_ref(line)).expect("a line that suits");
        (found.cutoff_um.expect("a cut-off"), found.words[3].clone())
    };
    let long = trace(5001, 1.0, rough);
    let (um, words) = cutoff(&long, CutOff::Estimated);
    assert!(um == 800.0 && words.contains("Sc3 of ISO 21920-3 for Ra 0.32 um, estimated with 800 um"), "{words}");
    assert_eq!(cutoff(&long, CutOff::OfRaLimit(0.1)).0, 250.0);
    assert_eq!(cutoff(&long, CutOff::OfRzLimit(0.1)).0, 80.0);
    let (um, words) = cutoff(&trace(3201, 1.0, rough), CutOff::OfRaLimit(0.8));
    let because = "250 um, because 800 um (Sc3 of ISO 21920-3 for a limit of Ra 0.8 um) with its sections and \
                   run-in needs 4.8 mm, and the line is 3.2 mm long";
    assert!(um == 250.0 && words.contains(because), "{words}");
    // Smooth waves far longer than any cut-off do not make the cut-off shrink to nothing.
    let (um, _) = cutoff(&trace(6001, 1.0, |x| 0.3 * wave(x, 500.0)), CutOff::Estimated);
    assert_eq!(um, 800.0);
    // Too short for any: as many sections as the run-in leaves room for.
    let whole = ProfileChain::default().evaluate(&[trace(400, 0.5, rough)]).expect("a short line");
    assert!(whole.cutoff_um == Some(80.0) && whole.words[4].contains("1 of 119.5 um, which is what"));
}

#[test]
fn a_line_read_backwards_lifted_or_tilted_has_the_same_parameters() {
    let at = |x: f64| 0.4 * wave(x, 61.0) + 0.2 * wave(x, 143.7) + 0.1 * (0.013 * x).sin().powi(5);
    let chain = ProfileChain::default();
    let (plain, _) = one(&chain, &trace(3001, 2.0, at));
    let backwards = trace(3001, 2.0, |x| at(6000.0 - x));
    let lifted = trace(3001, 2.0, |x| at(x) + 1234.5);
    let tilted = trace(3001, 2.0, |x| at(x) + 0.2 * x - 77.0);
    for (name, other) in [("backwards", backwards), ("lifted", lifted), ("tilted", tilted)] {
        let (other, _) = one(&chain, &other);
        let same = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-7, "{name}: {a} is not {b}");
        let numbers = |p: &Profile| {
            [p.a, p.q, p.ku, p.t, p.z, p.zx, p.p, p.v, p.dq, p.core.sk, p.core.spk, p.core.smr1, p.core.smr2]
        };
        for (a, b) in numbers(&other).into_iter().zip(numbers(&plain)) {
            same(a, b);
        }
        same(other.sm.clone().expect("elements"), plain.sm.clone().expect("elements"));
    }
}

#[test]
fn a_missing_point_costs_nothing() {
    let at = |x: f64| 0.5 * wave(x, 25.0);
    let mut heights: Vec<f64> = (0..400).map(|i| at(f64::from(i) * 0.5)).collect();
    heights[137] = f64::NAN;
    let (profile, words) = one(&ProfileChain::default(), &ProfileTrace::new(heights.clone(), 0.5).expect("a line"));
    // 119.5 um hold 4.78 waves, from 1.6 on: the mean of |sin| over them is 0.6505, not 2 / pi. The cut-off leaves
    // 1 - 2^-10.24, the S-filter 2^-0.01.
    near(profile.a, 0.5 * 0.6505 * 0.999_17 * 0.993_09, 2e-3);
    assert_eq!(words[0], "holes: 1 of 1 points in all, bridged by straight lines, the longest over 1 um");
    heights[140..160].fill(f64::NAN);
    let holed = ProfileTrace::new(heights, 0.5).expect("a line");
    let refused = ProfileChain::default().evaluate(std::slice::from_ref(&holed)).expect_err("a long hole");
    assert!(refused.to_string().contains("bridged up to 1.9950 um"), "{refused}");
    // Beside a good line the holed one is the only one without parameters.
    let both = ProfileChain::default().evaluate(&[holed, trace(400, 0.5, at)]).expect("one good line");
    assert!(both.lines[0].is_err() && both.lines[1].is_ok());
}

#[test]
fn what_does_not_suit_the_line_says_why() {
    let line = trace(501, 8.0, |x| wave(x, 100.0));
    let refused = |chain: ProfileChain| chain.evaluate(std::slice::from_ref(&line)).expect_err("unsuited").to_string();
    let of = |cutoff| ProfileChain { cutoff, ..ProfileChain::default() };
    assert!(refused(of(CutOff::Um(5000.0))).contains("4 mm long; a cut-off of 5000 um needs 10 mm for a section"));
    assert!(refused(of(CutOff::Um(70.0))).contains("10 points at least"));
    let six = ProfileChain { sections: Some(6), ..of(CutOff::Um(800.0)) };
    assert!(refused(six).contains("needs 5.6 mm for 6 sections of 800 um and a run-in of 400 um"));
    let crossed = ProfileChain { s_filter: ShortFilter::Um(900.0), ..of(CutOff::Um(800.0)) };
    assert!(refused(crossed).contains("must be shorter"));
    let coarse = trace(50, 400.0, |x| wave(x, 4000.0));
    let few = of(CutOff::OfRaLimit(0.8)).evaluate(&[coarse]).expect_err("coarse");
    assert!(few.to_string().contains("points 400 um apart are too few for a cut-off of 800 um"), "{few}");
    assert!(ProfileChain::default().evaluate(&[]).is_err());
}

#[test]
fn the_s_filter_is_left_out_where_points_are_too_far_apart() {
    let (fine, words) = one(&ProfileChain::default(), &trace(20_001, 0.5, |x| wave(x, 2.5) + wave(x, 100.0)));
    assert!(words[2].contains("2.5 um"), "{words:?}");
    near(fine.q, 0.625_f64.sqrt(), 5e-3);
    let (_, words) = one(&ProfileChain::default(), &trace(5001, 4.0, |x| wave(x, 100.0)));
    assert_eq!(words[2], "profile S-filter: none; 2.5 um of ISO 21920-3 needs points 0.5 um apart, not 4");
}
