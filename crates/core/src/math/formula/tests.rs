//! Formulas against the same mathematics written in Rust, and texts that are none.

use super::*;

fn value(text: &str, phi: f64) -> f64 {
    Formula::parse(text).unwrap_or_else(|fault| panic!("{text}: {fault:?}")).at::<1>(phi).value()
}

#[test]
fn formulas_mean_what_mathematics_means() {
    let phi = 0.7_f64;
    for (text, expected) in [
        ("1 + 0.3*sin(2*phi)", 1.0 + 0.3 * (2.0 * phi).sin()),
        ("2 - 3 - 4", -5.0),
        ("2/4/5", 0.1),
        ("-phi^2", -phi * phi),
        ("(-phi)^3", -phi.powi(3)),
        ("2*-3", -6.0),
        ("1.5e-1 + .5 + 2.E1", 20.65),
        ("sqrt(1 - 0.5*cos(phi)^2)", (1.0 - 0.5 * phi.cos().powi(2)).sqrt()),
        (" exp( 0.2 * cos(phi - pi/4) ) / (1+tan(0.1)) ", {
            (0.2 * (phi - std::f64::consts::FRAC_PI_4).cos()).exp() / (1.0 + 0.1_f64.tan())
        }),
        ("φ^0 + 2*π", 1.0 + 2.0 * std::f64::consts::PI),
    ] {
        assert!((value(text, phi) - expected).abs() < 1e-15 * (1.0 + expected.abs()), "{text}");
    }
}

/// Derivatives against differences of the value over ever smaller steps, taken to their limit (Richardson).
#[test]
fn derivatives_are_those_of_the_value() {
    let text = "exp(0.3*sin(phi))/(2 + cos(3*phi)^2) + tan(0.2*phi)*sqrt(2 + phi)";
    let (formula, phi) = (Formula::parse(text).expect("a formula"), 0.4);
    let jet = formula.at::<4>(phi);
    let f = |x: f64| formula.at::<1>(x).value();
    let first = |h: f64| (f(phi + h) - f(phi - h)) / (2.0 * h);
    let second = |h: f64| (f(phi + h) - 2.0 * f(phi) + f(phi - h)) / (h * h);
    let third =
        |h: f64| (f(phi + 2.0 * h) - 2.0 * f(phi + h) + 2.0 * f(phi - h) - f(phi - 2.0 * h)) / (2.0 * h.powi(3));
    let limit = |of: &dyn Fn(f64) -> f64, h: f64| (4.0 * of(0.5 * h) - of(h)) / 3.0;
    for (k, (found, within)) in
        [(limit(&first, 1e-3), 1e-10), (limit(&second, 3e-3), 1e-8), (limit(&third, 1e-2), 1e-5)]
            .into_iter()
            .enumerate()
    {
        let expected = jet.derivative(k + 1);
        assert!((found - expected).abs() < within * expected.abs().max(1.0), "{k}: {found} {expected}");
    }
}

#[test]
fn what_is_no_formula_is_refused_at_its_place() {
    for (text, at, words) in [
        ("", 0..0, "ends"),
        ("1 + ", 4..4, "ends"),
        ("1 + * 2", 4..5, "`*` is no value"),
        ("2 phi", 2..3, "operator is missing"),
        ("1 + 0,3*phi", 5..6, "numbers have a point"),
        ("sin(0,3)", 5..6, "numbers have a point"),
        ("sin(phi", 3..4, "never closed"),
        ("sin phi", 0..3, "into brackets"),
        ("1 + 0.3*sinus(phi)", 8..13, "`sinus` is not known"),
        ("1 + x", 4..5, "phi (rad)"),
        ("phi^0.5", 4..7, "sqrt"),
        ("phi^-1", 4..5, "whole number"),
        ("1..2", 2..3, "operator is missing"),
        (".", 0..1, "no number"),
        ("1e999", 0..5, "no number"),
        ("(1 + 2))", 7..8, "operator is missing"),
        ("1 + °", 4..6, "no value"),
    ] {
        let fault = Formula::parse(text).expect_err(text);
        assert!(fault.message.contains(words), "{text}: {}", fault.message);
        assert_eq!(fault.at, at, "{text}: {}", fault.message);
    }
    let deep = format!("{}1{}", "(".repeat(5000), ")".repeat(5000));
    assert!(Formula::parse(&deep).expect_err("deep").message.contains("too deep"));
}
