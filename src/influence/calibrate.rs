//! Keys of a scene fitted to what was measured of its gear.
//!
//! In: a scene; numbers of its results, numbers of surfaces and lines of inspection charts as they were measured, with
//! standard uncertainties ([`MeasuredGear`]); and the names of the parameters that may change. Out: [`Calibration`]:
//! fitted sizes with intervals, which of them the measured values say nothing about, and all values before and after.
//!
//! **Law.** The sum of ((measured - predicted) / uncertainty)^2 is made least by the method of Levenberg and Marquardt
//! (Marquardt, *An Algorithm for Least-Squares Estimation of Nonlinear Parameters*, 1963): each step is the linear
//! least squares of the residuals by the derivatives at hand, with one more row sqrt(damping) for each parameter
//! counted in its natural steps. Derivatives are central differences of cuts; what is random keeps its seed, so that
//! both sides of a difference have the same noise. Intervals are those of the linear fit at the end.
//!
//! Every key stays in its range: a step ends where a parameter meets the end of it, which then holds that parameter as
//! long as the fit draws it further out. It is said to have no interval, for the least squares lie beyond.
//!
//! A parameter whose derivatives are nothing, or a combination of the others', cannot be identified, and is said to:
//! its shift means nothing then. After Ctrl-C the fit is that of the rounds that are done; cuts
//! are kept, and the next run goes the same way through them ([`super::known_cuts`]). Road not taken: a crate for
//! nonlinear least squares. They bring a matrix library with them, and the linear fit that diagnoses use is all that is
//! needed.

mod files;
mod measured;
mod surface;
mod trial;
mod write;

use super::interval::interval;
use super::known_cuts::KnownCuts;
use crate::backend::Choice;
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use crate::scene::LoadedScene;
use crate::scene::error_parameters::ErrorParameter;
use gearcut_core::error::{Error, Result};
use gearcut_core::math::column_basis::{ColumnBasis, norm};
use statrs::distribution::{ChiSquared, ContinuousCDF};
use trial::Trial;

pub use files::read;
pub use measured::{MeasuredGear, MeasuredNumber, MeasuredWish};
pub use write::{findings, write};

/// Most rounds: each takes two cuts for every parameter and one or more besides. A fit that needs more is none.
const MOST_ROUNDS: usize = 12;
/// Fitting ends where the linear fit would take less than this off the squared residuals: a thirtieth of an
/// uncertainty.
const SETTLED: f64 = 1e-3;
/// Where no step makes the fit better, it has settled if the linear fit would take less than this off: a tenth of half
/// an interval, 0.1 x 1.96 standard deviations, squared. On a knee, where the deeper of two strokes remains, a
/// difference over both sides is the mean of two slopes, and the linear fit sees a gain that is none.
const SETTLED_ON_KNEE: f64 = 0.038;
/// Damping of the first round, against squares of derivatives per natural step over the uncertainty: a little.
const FIRST_DAMPING: f64 = 1e-3;
/// How damping changes after a good and after a bad step (Marquardt 1963).
const DAMPING_FACTOR: f64 = 10.0;
/// Damping beyond which no step is tried.
const MOST_DAMPING: f64 = 1e6;

/// What was fitted.
#[derive(Debug, Clone)]
pub struct Calibration {
    /// Parameters with their shifts from the scene and half their intervals; `None`: they cannot be identified, or are
    /// at the end of their range.
    pub fitted: Vec<(ErrorParameter, Option<[f64; 2]>)>,
    /// Shifts of parameters that the end of their key's range holds; `None` for the others.
    pub at_end: Vec<Option<f64>>,
    /// Measured numbers, then the places of measured lines, with what the scene predicted for them, and what the
    /// fitted scene does.
    pub values: Vec<Calibrated>,
    /// `--set` arguments that make the scene the fitted one.
    pub settings: Vec<String>,
    /// Squared residuals over the uncertainties.
    pub chi_square: f64,
    /// Measured values less what measuring machines add, and less parameters that could be identified.
    pub freedom: usize,
    /// Chance of residuals as large from the uncertainties alone; `None` without freedom.
    pub chance: Option<f64>,
    /// Whether the last round moved them no more.
    pub settled: bool,
    /// Whether it led beyond what a scene may say, or what can be cut.
    pub beyond: bool,
    /// Whether Ctrl-C left it all its rounds.
    pub complete: bool,
}

/// A measured value and what is said of it, in its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibrated {
    /// As it was measured; of lines without what a measuring machine adds.
    pub measured: f64,
    /// By the scene as it is.
    pub predicted: f64,
    /// By the fitted scene.
    pub fitted: f64,
}

/// Where a fit stands.
struct FitState {
    shifts: Vec<f64>,
    /// Predicted there.
    here: Vec<f64>,
    /// Squared residuals.
    left: f64,
    /// Derivatives of the last round that has all of them.
    columns: Vec<Vec<f64>>,
    /// Parameters that the ends of their ranges hold.
    held: Vec<bool>,
    /// Whether a step of the last round led to shifts that the scene may not have, or that no gear can be cut with.
    beyond: bool,
    settled: bool,
}

impl FitState {
    /// Goes on round by round until nothing more is to be gained.
    fn run(&mut self, trial: &Trial, parameters: &[ErrorParameter]) -> Result<()> {
        let count = parameters.len();
        let mut damping = FIRST_DAMPING;
        for _ in 0..MOST_ROUNDS {
            let column = |index| trial.column(&self.shifts, &self.here, index);
            self.columns = (0..count).map(column).collect::<Result<Vec<_>>>()?;
            let residuals = trial.residuals(&self.here);
            self.hold(trial, parameters, &residuals, damping);
            // The derivatives of the intervals are those at the end.
            let gain = self.left - alive(&self.columns).left_of(&residuals);
            self.settled = gain < SETTLED;
            let before_round = self.left;
            self.beyond = false;
            while !self.settled && self.left >= before_round && damping < MOST_DAMPING {
                let by = damped(&self.columns, &residuals, damping);
                let wanted: Vec<f64> = (0..count).map(|i| self.shifts[i] + by[i] * parameters[i].step).collect();
                let moved = trial.within(&self.shifts, &wanted);
                let there = trial.predicted(&moved)?;
                self.beyond |= moved != wanted || there.is_none();
                let better = there.map(|there| (norm(&trial.residuals(&there)).powi(2), there));
                if let Some((least, there)) = better.filter(|(least, _)| *least < self.left) {
                    (self.left, self.here, self.shifts) = (least, there, moved);
                    damping /= DAMPING_FACTOR;
                } else {
                    damping *= DAMPING_FACTOR;
                }
            }
            if self.left >= before_round {
                self.settled = gain < SETTLED_ON_KNEE;
                break;
            }
        }
        Ok(())
    }

    /// Holds the parameters that the next step would draw beyond their ranges: their columns count no more.
    fn hold(&mut self, trial: &Trial, parameters: &[ErrorParameter], residuals: &[f64], damping: f64) {
        self.held = vec![false; parameters.len()];
        loop {
            let by = damped(&self.columns, residuals, damping);
            let ends = (0..by.len()).find(|&i| trial.is_at_end(&self.shifts, i, by[i] * parameters[i].step));
            let Some(index) = ends else { break };
            self.held[index] = true;
            self.columns[index].fill(0.0);
        }
    }

    /// Which parameters the columns say anything of, beside all others.
    fn identified(&self) -> Vec<bool> {
        let columns = &self.columns;
        // What the others say as well is nobody's: a parameter is identified beside all of them.
        let beside_others = |index: usize| {
            let mut others = ColumnBasis::default();
            for (_, column) in columns.iter().enumerate().filter(|(other, _)| *other != index) {
                let _dependent = norm(column) > DEAD && others.take(column);
            }
            others.take(&columns[index])
        };
        (0..columns.len()).map(|index| norm(&columns[index]) > DEAD && beside_others(index)).collect()
    }
}

impl Calibration {
    /// Fits parameters to what was measured; cuts that are known are not made again.
    ///
    /// # Errors
    /// Numbers and places that the gear does not have; values that the scene may not have; geometry; Ctrl-C in the
    /// first round.
    pub fn new(
        loaded: &LoadedScene,
        parameters: &[ErrorParameter],
        measured: &MeasuredGear,
        choice: &Choice,
        progress: &Progress,
        interrupt: &Interrupt,
        known: &KnownCuts,
    ) -> Result<Self> {
        let count = parameters.len();
        // A round takes two cuts for each parameter and mostly one for its step.
        let step = progress.step("fit", (1 + MOST_ROUNDS * (2 * count + 1)) as u64, "cuts at most");
        let trial = Trial::new(loaded, parameters, measured, (choice, known), interrupt, &step)?;
        let shifts = vec![0.0; count];
        let before = trial.predicted(&shifts)?.expect("nothing is shifted");
        let left = norm(&trial.residuals(&before)).powi(2);
        let mut fit = FitState {
            shifts,
            here: before.clone(),
            left,
            columns: Vec::new(),
            held: Vec::new(),
            beyond: false,
            settled: false,
        };
        let complete = match fit.run(&trial, parameters) {
            Err(Error::Interrupted) if !fit.columns.is_empty() => false,
            other => other.map(|()| true)?,
        };
        let mut basis = ColumnBasis::default();
        let taken: Vec<bool> = fit.columns.iter().map(|column| norm(column) > DEAD && basis.take(column)).collect();
        let solution = basis.solve(&trial.residuals(&fit.here));
        let freedom = trial.count().saturating_sub(basis.columns());
        // Without freedom the stated uncertainties are all that is known.
        let spread = if freedom > 0 { (fit.left / freedom as f64).max(1.0).sqrt() } else { 1.0 };
        let width = spread * interval(freedom);
        let mut place = 0;
        let mut half_widths = Vec::new();
        for (parameter, &taken) in parameters.iter().zip(&taken) {
            half_widths.push(taken.then(|| width * solution.covariance[place][place].sqrt() * parameter.step));
            place += usize::from(taken);
        }
        let fitted = parameters.iter().zip(fit.identified()).zip(fit.shifts.iter().zip(half_widths)).map(
            |((parameter, identified), (&shift, half))| {
                (parameter.clone(), half.filter(|_| identified).map(|half| [shift, half]))
            },
        );
        let noise = (freedom > 0).then(|| ChiSquared::new(freedom as f64).expect("freedom is above 0"));
        let found = Self {
            fitted: fitted.collect(),
            at_end: fit.held.iter().zip(&fit.shifts).map(|(&held, &shift)| held.then_some(shift)).collect(),
            values: trial.compared(&before, &fit.here),
            settings: trial.shifted(&fit.shifts).map_or_else(Vec::new, |shifted| shifted.settings()),
            chi_square: fit.left,
            freedom,
            chance: noise.map(|noise| noise.sf(fit.left)),
            settled: fit.settled,
            beyond: fit.beyond,
            complete,
        };
        drop(trial);
        step.finish();
        Ok(found)
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
