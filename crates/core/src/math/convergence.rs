//! What all iterations share: a limit on their steps, and an error with numbers where they do not end before it.
//!
//! The finders: [`super::roots`] (brackets: bisection, regula falsi), [`super::newton`] (Newton's method, free and
//! within a bracket), [`super::extremum`] (golden section). What fits none of them goes through [`iterate`].
//!
//! Loops of their own, each with its guarantee at its place:
//!
//! - the kernels of flanks (`cut::cpu::planar`, `passes::spatial::sweep_roots`) run on several rays at once and count
//!   those that do not converge (`CutStats::unconverged`); `SweepRecord::places` gives its last step, and bounds made
//!   with it hold only where that is small;
//! - [`super::planar_rays`] is the inner loop of whole blanks: it stays within the ends of a part of a curve and halves
//!   it to the last bit should Newton's method not arrive;
//! - `passes::sections::swept_pose` follows some ten million edge points, eight at once or one after the other; where
//!   Newton's method does not arrive, the range is halved;
//! - `passes::spatial::sweep`: a polynomial is inverted by a fixed number of steps, tested over all arguments;
//! - `tool::edge`: the foot of a rough edge's normal by four steps, each of which leaves a tenth at most of the one
//!   before, of a shift below a micrometre;
//! - `bevel::envelope` (Newton's method in two unknowns) and `bevel::ease_off` (a flank on another one's normal) end
//!   with [`NotConverged`]; the place of a first contact in `bevel::contact` is a search by halved steps over a bounded
//!   flank, and takes only places that touch earlier;
//! - outside of the core, `machine_errors::balance` (Newton's method in four unknowns on a strictly convex energy) ends
//!   with [`NotConverged`]; `process::shaping::chips::deflection` looks at a stroke 40 times at most and refuses one
//!   that still moves; `influence::calibrate` takes only steps that lower the sum of squares, 12 rounds at most, and
//!   says whether it has settled; `pair::double_flank` widens its bracket until it holds the tight mesh or is wider
//!   than the teeth reach, which is refused; `process::hobbing::linkage::marks` reduces a lattice (whole numbers, whose
//!   lengths shrink by a factor);
//! - `gearcut-texture`, which does not know this crate, has two searches that end with an error of their own (`form`,
//!   `gaussian`).

use crate::error::NotConverged;
use std::ops::ControlFlow;

/// Where an iteration goes next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Next value.
    pub to: f64,
    /// What the function misses at the value before.
    pub residual: f64,
}

/// Repeats `step` from `start` until it breaks with a result, `most` times at most.
///
/// # Errors
/// It has not broken by then, or it went to a value that is not a number.
pub fn iterate<R>(
    what: &'static str,
    start: f64,
    most: u32,
    mut step: impl FnMut(f64) -> ControlFlow<R, Step>,
) -> Result<R, NotConverged> {
    let mut error = NotConverged { what, after: 0, last: start, last_step: f64::INFINITY, residual: f64::NAN };
    while error.after < most {
        match step(error.last) {
            ControlFlow::Break(result) => return Ok(result),
            ControlFlow::Continue(Step { to, residual }) => {
                error.after += 1;
                (error.last_step, error.last, error.residual) = (to - error.last, to, residual);
                if to.is_nan() {
                    break;
                }
            }
        }
    }
    Err(error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fixed_point_is_found_and_a_runaway_reported() {
        let cosine = |x: f64| {
            let to = x.cos();
            if to == x { ControlFlow::Break(x) } else { ControlFlow::Continue(Step { to, residual: to - x }) }
        };
        let found = iterate("the fixed point of the cosine", 1.0, 200, cosine).unwrap();
        assert!((found - 0.739_085_133_215_160_6).abs() < 1e-15);
        let runaway = |x: f64| ControlFlow::<f64, Step>::Continue(Step { to: 2.0 * x, residual: x });
        let error = iterate("nothing", 1.0, 10, runaway).unwrap_err();
        assert_eq!((error.after, error.last, error.last_step, error.residual), (10, 1024.0, 512.0, 512.0));
        assert!(error.to_string().contains("nothing is not found after 10 steps: last value 1.024e3"), "{error}");
        assert!(error.settled(500.0).is_err() && error.settled(512.0) == Ok(1024.0));
    }

    #[test]
    fn what_is_not_a_number_ends_at_once() {
        let lost = |_| ControlFlow::<f64, Step>::Continue(Step { to: f64::NAN, residual: 1.0 });
        let error = iterate("nothing", 1.0, 10, lost).unwrap_err();
        assert_eq!(error.after, 1);
        assert!(error.settled(f64::INFINITY).is_err());
    }
}
