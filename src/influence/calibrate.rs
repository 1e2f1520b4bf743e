//! Keys of a scene fitted to measured numbers.
//!
//! In: a scene, numbers of its results as they were measured, each with its standard uncertainty, and the names of the
//! parameters that may change. Out: [`Calibration`]: fitted sizes with intervals, which of them the numbers say nothing
//! about, and all numbers before and after.
//!
//! **Law.** The sum of ((measured - predicted) / uncertainty)^2 is made least by the method of Levenberg and Marquardt
//! (Marquardt, *An Algorithm for Least-Squares Estimation of Nonlinear Parameters*, 1963): each step is the linear
//! least squares of the residuals by the derivatives at hand, with one more row sqrt(damping) for each parameter
//! counted in its natural steps. Derivatives are central differences of whole cuts. Intervals are those of the linear
//! fit at the end.
//!
//! A parameter whose derivatives are nothing, or a combination of the others', cannot be identified, and is said to:
//! its shift means nothing then. Road not taken: a crate for nonlinear least squares. They bring a matrix library with
//! them, and the linear fit that diagnoses use is all that is needed.

mod measured;
mod write;

use super::derivative::read;
use super::interval::interval;
use super::numbers::{Numbers, numbers};
use crate::backend::Choice;
use crate::interrupt::Interrupt;
use crate::output::progress::Progress;
use crate::scene::LoadedScene;
use crate::scene::error_parameters::{ErrorParameter, Shifted};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::math::column_basis::{ColumnBasis, norm};
use statrs::distribution::{ChiSquared, ContinuousCDF};

pub use measured::{MeasuredNumber, read_numbers};
pub use write::{findings, write};

/// Most rounds: each takes two cuts for every parameter and one or more besides. A fit that needs more is none.
const MOST_ROUNDS: usize = 12;
/// Fitting ends where the linear fit would take less than this off the squared residuals: a thirtieth of an
/// uncertainty.
const SETTLED: f64 = 1e-3;
/// Damping of the first round, against squares of derivatives per natural step over the uncertainty: a little.
const FIRST_DAMPING: f64 = 1e-3;
/// How damping changes after a good and after a bad step (Marquardt 1963).
const DAMPING_FACTOR: f64 = 10.0;
/// Damping beyond which no step is tried.
const MOST_DAMPING: f64 = 1e6;

/// What was fitted.
#[derive(Debug, Clone)]
pub struct Calibration {
    /// Parameters with their shifts from the scene and half their intervals; `None`: they cannot be identified.
    pub fitted: Vec<(ErrorParameter, Option<[f64; 2]>)>,
    /// Measured numbers with what the scene predicted for them, and what the fitted scene does.
    pub numbers: Vec<(MeasuredNumber, [f64; 2])>,
    /// `--set` arguments that make the scene the fitted one.
    pub settings: Vec<String>,
    /// Squared residuals over the uncertainties.
    pub chi_square: f64,
    /// Measured numbers less parameters that could be identified.
    pub freedom: usize,
    /// Chance of residuals as large from the uncertainties alone; `None` without freedom.
    pub chance: Option<f64>,
    /// Whether the last round still moved them.
    pub settled: bool,
}

/// What is cut again and again.
struct Trial<'a> {
    loaded: &'a LoadedScene,
    parameters: &'a [ErrorParameter],
    measured: &'a [MeasuredNumber],
    choice: &'a Choice,
    interrupt: &'a Interrupt,
}

impl Trial<'_> {
    /// The scene with shifted parameters; `None` where it has no word for them.
    fn shifted(&self, shifts: &[f64]) -> Option<Shifted<'_>> {
        let mut shifted = Shifted::new(self.loaded);
        let all = self.parameters.iter().zip(shifts).all(|(parameter, &by)| shifted.shift(parameter, by));
        all.then_some(shifted)
    }

    /// Predicted values of the measured numbers.
    fn predicted(&self, shifts: &[f64]) -> Result<Option<Vec<f64>>> {
        let Some(shifted) = self.shifted(shifts) else { return Ok(None) };
        let found = numbers(&read(&shifted)?, self.choice, self.interrupt)?;
        let one = |measured: &MeasuredNumber| value_of(&found, measured);
        self.measured.iter().map(one).collect::<Result<Vec<f64>, Refusal>>().map(Some).map_err(Into::into)
    }

    /// Residuals over the uncertainties.
    fn residuals(&self, predicted: &[f64]) -> Vec<f64> {
        let one = |(measured, predicted): (&MeasuredNumber, &f64)| (measured.value - predicted) / measured.uncertainty;
        self.measured.iter().zip(predicted).map(one).collect()
    }

    /// Derivatives of the predicted values by one parameter, for a natural step, over the uncertainties.
    fn column(&self, shifts: &[f64], here: &[f64], index: usize) -> Result<Vec<f64>> {
        let step = self.parameters[index].step;
        let at = |by: f64| {
            let mut moved = shifts.to_vec();
            moved[index] += by;
            self.predicted(&moved)
        };
        let (above, below) = (at(step)?, at(-step)?);
        let width = f64::from(u8::from(above.is_some()) + u8::from(below.is_some()));
        let (above, below) = (above.unwrap_or_else(|| here.to_vec()), below.unwrap_or_else(|| here.to_vec()));
        let rows = above.iter().zip(&below).zip(self.measured);
        Ok(rows.map(|((a, b), measured)| (a - b) / width.max(1.0) / measured.uncertainty).collect())
    }
}

fn value_of(found: &Numbers, measured: &MeasuredNumber) -> Result<f64, Refusal> {
    found.get(&measured.quantity).map(|(value, _)| *value).ok_or_else(|| {
        Refusal::new(
            "--measured",
            format!("`{}` is no number of this scene's results", measured.quantity),
            "name numbers by their paths in results.json, those of its headline as headline.KEY; `gearcut cut SCENE \
             --only numbers` writes one",
        )
    })
}

impl Calibration {
    /// Fits parameters to measured numbers.
    ///
    /// # Errors
    /// Numbers that the results do not have; values that the scene may not have; geometry; Ctrl-C.
    pub fn new(
        loaded: &LoadedScene,
        parameters: &[ErrorParameter],
        measured: &[MeasuredNumber],
        choice: &Choice,
        progress: &Progress,
        interrupt: &Interrupt,
    ) -> Result<Self> {
        let trial = Trial { loaded, parameters, measured, choice, interrupt };
        let count = parameters.len();
        let mut shifts = vec![0.0; count];
        let before = trial.predicted(&shifts)?.expect("nothing is shifted");
        let mut here = before.clone();
        let mut left = norm(&trial.residuals(&here)).powi(2);
        let (mut damping, mut settled) = (FIRST_DAMPING, false);
        let step = progress.step("fit", MOST_ROUNDS as u64, "rounds at most");
        let mut columns = Vec::new();
        for _ in 0..MOST_ROUNDS {
            columns = (0..count).map(|index| trial.column(&shifts, &here, index)).collect::<Result<Vec<_>>>()?;
            step.advance(1);
            let residuals = trial.residuals(&here);
            // The derivatives of the intervals are those at the end.
            settled = left - alive(&columns).left_of(&residuals) < SETTLED;
            let before_round = left;
            while !settled && left >= before_round && damping < MOST_DAMPING {
                let by = damped(&columns, &residuals, damping);
                let moved: Vec<f64> = (0..count).map(|i| shifts[i] + by[i] * parameters[i].step).collect();
                let there = trial.predicted(&moved)?;
                let better = there.map(|there| (norm(&trial.residuals(&there)).powi(2), there));
                if let Some((least, there)) = better.filter(|(least, _)| *least < left) {
                    (left, here, shifts) = (least, there, moved);
                    damping /= DAMPING_FACTOR;
                } else {
                    damping *= DAMPING_FACTOR;
                }
            }
            if left >= before_round {
                break;
            }
        }
        step.finish();
        // What the others say as well is nobody's: a parameter is identified beside all of them.
        let beside_others = |index: usize| {
            let mut others = ColumnBasis::default();
            for (_, column) in columns.iter().enumerate().filter(|(other, _)| *other != index) {
                let _dependent = norm(column) > DEAD && others.take(column);
            }
            others.take(&columns[index])
        };
        let identified: Vec<bool> =
            (0..count).map(|index| norm(&columns[index]) > DEAD && beside_others(index)).collect();
        let mut basis = ColumnBasis::default();
        let taken: Vec<bool> = columns.iter().map(|column| norm(column) > DEAD && basis.take(column)).collect();
        let solution = basis.solve(&trial.residuals(&here));
        let freedom = measured.len().saturating_sub(basis.columns());
        // Without freedom the stated uncertainties are all that is known.
        let spread = if freedom > 0 { (left / freedom as f64).max(1.0).sqrt() } else { 1.0 };
        let width = spread * interval(freedom);
        let mut place = 0;
        let mut half_widths = Vec::new();
        for (parameter, &taken) in parameters.iter().zip(&taken) {
            half_widths.push(taken.then(|| width * solution.covariance[place][place].sqrt() * parameter.step));
            place += usize::from(taken);
        }
        let fitted = parameters.iter().zip(&identified).zip(shifts.iter().zip(half_widths)).map(
            |((parameter, &identified), (&shift, half))| {
                (parameter.clone(), half.filter(|_| identified).map(|half| [shift, half]))
            },
        );
        let noise = (freedom > 0).then(|| ChiSquared::new(freedom as f64).expect("freedom is above 0"));
        Ok(Self {
            fitted: fitted.collect(),
            numbers: measured.iter().cloned().zip(before.into_iter().zip(here).map(|(a, b)| [a, b])).collect(),
            settings: trial.shifted(&shifts).map_or_else(Vec::new, |shifted| shifted.settings()),
            chi_square: left,
            freedom,
            chance: noise.map(|noise| noise.sf(left)),
            settled,
        })
    }
}

/// A parameter says nothing of which a natural step moves the numbers by less than this share of their uncertainties:
/// its interval would be forty natural steps wide to either side, and marks of strokes move numbers so little, too.
const DEAD: f64 = 0.05;

/// The columns that say anything.
fn alive(columns: &[Vec<f64>]) -> ColumnBasis {
    let mut basis = ColumnBasis::default();
    for column in columns.iter().filter(|column| norm(column) > DEAD) {
        let _dependent = basis.take(column);
    }
    basis
}

/// Least squares of residuals by columns, in natural steps, held back by damping; columns that say nothing stay at 0.
fn damped(columns: &[Vec<f64>], residuals: &[f64], damping: f64) -> Vec<f64> {
    let count = columns.len();
    let mut basis = ColumnBasis::default();
    let mut taken = Vec::new();
    for (index, column) in columns.iter().enumerate() {
        let size = norm(column);
        let mut longer = column.clone();
        longer.extend((0..count).map(|row| if row == index { damping.sqrt() * size } else { 0.0 }));
        taken.push(size > DEAD && basis.take(&longer));
    }
    let mut right = residuals.to_vec();
    right.resize(residuals.len() + count, 0.0);
    let mut values = basis.solve(&right).values.into_iter();
    taken.into_iter().map(|taken| if taken { values.next().unwrap_or(0.0) } else { 0.0 }).collect()
}
