//! Newton's method: free from a good guess, or within a bracket, where it cannot fail.
//!
//! In: a function that gives what is missing at a value and the step that should bring it (missing / rate). Out: the
//! value. The step is the caller's, so that secants and bounded rates serve as well as derivatives.
//!
//! The last step is taken, not evaluated again: of a smooth function the error left is of the order of its square.

use super::convergence::{Step, iterate};
use super::roots::bisect;
use crate::error::NotConverged;
use std::ops::ControlFlow;

/// A bracket without ends for [`newton_within`].
pub const EVERYWHERE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Size of a last step: `absolute + relative |x|`, in the unit of x.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LastStep {
    /// Near 0.
    pub absolute: f64,
    /// As a share of the value.
    pub relative: f64,
}

impl LastStep {
    /// The same everywhere.
    pub fn absolute(absolute: f64) -> Self {
        Self { absolute, relative: 0.0 }
    }

    /// A share of 1 + |x|.
    pub fn relative(relative: f64) -> Self {
        Self { absolute: relative, relative }
    }

    fn holds(self, step: f64, x: f64) -> bool {
        step.abs() <= self.absolute + self.relative * x.abs()
    }
}

/// Root near `start`, by at most `most` steps; `at` gives what is missing at a value and the step to take there.
///
/// It ends with the first step as small as `last`, which is taken. Nothing is assumed about the function, so nothing is
/// promised either: from a bad guess the iteration may run away.
///
/// # Errors
/// No step was as small.
pub fn newton(
    what: &'static str,
    start: f64,
    last: LastStep,
    most: u32,
    mut at: impl FnMut(f64) -> [f64; 2],
) -> Result<f64, NotConverged> {
    iterate(what, start, most, |x| {
        let [residual, step] = at(x);
        let to = x + step;
        if last.holds(step, to) { ControlFlow::Break(to) } else { ControlFlow::Continue(Step { to, residual }) }
    })
}

/// Root of a function whose missing part falls through zero once between `low` and `high`, from `start` between them;
/// `at` gives what is missing at a value (positive below the root) and the step to take there.
///
/// Ends may be infinite: values that were looked at take their places. A step beyond an end goes to it, the first time,
/// and to the middle of the bracket afterwards. It ends with the first step as small as `last`, which is taken; after
/// `most` steps the bracket is halved to the last bit. **It cannot fail**: it takes at most `most` evaluations, as many
/// doublings as an infinite end needs, and some 60 halvings on ordinary brackets. What is not a number gives NaN.
pub fn newton_within(
    start: f64,
    [mut low, mut high]: [f64; 2],
    last: LastStep,
    most: u32,
    mut at: impl FnMut(f64) -> [f64; 2],
) -> f64 {
    let mut x = start;
    let (mut seen_low, mut seen_high) = (false, false);
    for _ in 0..most {
        let [missing, step] = at(x);
        if missing.is_nan() {
            return f64::NAN;
        }
        if missing >= 0.0 {
            (low, seen_low) = (x, true);
        }
        if missing <= 0.0 {
            (high, seen_high) = (x, true);
        }
        let next = x + step;
        if last.holds(step, next) {
            return next.max(low).min(high);
        }
        x = if next > low && next < high {
            next
        } else if next >= high && !seen_high && high.is_finite() {
            high
        } else if next <= low && !seen_low && low.is_finite() {
            low
        } else if low.is_finite() && high.is_finite() {
            f64::midpoint(low, high)
        } else {
            break;
        };
    }
    halved(x, [low, high], |x| at(x)[0])
}

/// Root of a function whose missing part falls through zero once between two ends, infinite or not, by doubling and
/// halving.
fn halved(from: f64, [mut low, mut high]: [f64; 2], mut missing: impl FnMut(f64) -> f64) -> f64 {
    for side in [-1.0, 1.0] {
        let mut reach = 1e-9 * (1.0 + from.abs());
        while (if side < 0.0 { low } else { high }).is_infinite() {
            let probe = from + side * reach;
            let value = missing(probe);
            if value.is_nan() || probe.is_infinite() {
                return f64::NAN;
            }
            if value >= 0.0 {
                low = probe;
            }
            if value <= 0.0 {
                high = probe;
            }
            reach *= 2.0;
        }
    }
    bisect(|x| missing(x) > 0.0, low, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn square_root_of(two: f64) -> impl Fn(f64) -> [f64; 2] {
        move |x| [two - x * x, (two - x * x) / (2.0 * x)]
    }

    #[test]
    fn finds_square_roots_and_reports_what_has_none() {
        let found = newton("a root", 1.0, LastStep::absolute(1e-8), 20, square_root_of(2.0)).unwrap();
        assert!((found - 2.0_f64.sqrt()).abs() < 1e-15);
        let error = newton("a root", 1.5, LastStep::absolute(1e-8), 20, square_root_of(-2.0)).unwrap_err();
        assert_eq!(error.after, 20);
        assert!(error.residual < -2.0 && error.last_step.abs() > 1e-8);
    }

    #[test]
    fn a_last_step_may_be_told_in_both_ways() {
        for last in [LastStep::absolute(1e-3), LastStep::relative(1e-6)] {
            let found = newton("a root", 900.0, last, 20, square_root_of(1e6)).unwrap();
            assert!((found - 1000.0).abs() < 1e-8);
        }
        assert!(newton("a root", 900.0, LastStep::default(), 3, square_root_of(1e6)).is_err());
    }

    /// Newton's method alone runs away from the arctangent's root where it starts too far off.
    #[test]
    fn a_bracket_keeps_it_from_running_away() {
        let arctangent = |x: f64| [-x.atan(), -x.atan() * (1.0 + x * x)];
        assert!(newton("a root", 3.0, LastStep::absolute(1e-12), 60, arctangent).is_err());
        for bracket in [[-5.0, 4.0], EVERYWHERE, [-5.0, f64::INFINITY]] {
            assert!(newton_within(3.0, bracket, LastStep::absolute(1e-12), 60, arctangent).abs() < 1e-12);
        }
    }

    /// Steps that are useless: what is left is doubling and halving.
    #[test]
    fn useless_steps_do_no_harm() {
        let stuck = |x: f64| [5.0 - x, 1e-3 * (5.0_f64 - x).signum()];
        for bracket in [[0.0, 8.0], EVERYWHERE] {
            let found = newton_within(1.0, bracket, LastStep::absolute(1e-9), 10, stuck);
            assert!((found - 5.0).abs() < 1e-14, "{found}");
        }
        assert!(newton_within(1.0, EVERYWHERE, LastStep::absolute(1e-9), 10, |_| [f64::NAN, 1.0]).is_nan());
        assert!(newton_within(1.0, EVERYWHERE, LastStep::absolute(1e-9), 10, |_| [1.0, 0.1]).is_nan());
    }

    proptest! {
        /// Rates that change by a factor of nineteen.
        #[test]
        fn every_rising_wave_is_inverted(root in -50.0_f64..50.0, start in -50.0_f64..50.0, wave in 0.0_f64..0.9) {
            let rising = |x: f64| x + wave * x.sin();
            let at = |x: f64| {
                let missing = rising(root) - rising(x);
                [missing, missing / (1.0 + wave * x.cos())]
            };
            let found = newton_within(start, EVERYWHERE, LastStep::relative(1e-13), 40, at);
            prop_assert!((found - root).abs() < 1e-11, "{found} for {root}");
        }
    }
}
