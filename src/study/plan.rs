//! The plan of a study: which cases there are, and what each of them sets.
//!
//! In: parameters, samples and their design. Out: the number of cases, and the settings of case `i`.
//!
//! The law: a case is one combination of the values of all listed parameters, and one sample of all others. The last
//! listed parameter changes fastest, samples faster still. Case numbers begin with 0.

use super::design::{MOST_OF_SOBOL, latin_hypercube, sobol};
use super::parameter::{ParameterValues, StudyParameter};
use crate::steps::record::sha256_hex;
use gearcut_core::error::Refusal;
use serde::Deserialize;
use std::str::FromStr;

/// Cases of a study that is not asked back.
pub const USUAL_CASES: u64 = 100_000;

/// What is done with every case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StudyCommand {
    /// The whole gear is cut and measured.
    #[default]
    Cut,
    /// The machine's axes alone.
    Axes,
}

impl StudyCommand {
    /// How it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cut => "cut",
            Self::Axes => "axes",
        }
    }
}

/// Where samples lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SampleDesign {
    /// One in each of equal shares of every range.
    #[default]
    LatinHypercube,
    /// Sobol's sequence.
    Sobol,
}

/// A share of a study: every `of`-th case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Which one, from 1.
    pub number: u64,
    /// Of how many.
    pub of: u64,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}` is no share: write i/n, such as 2/8; i counts from 1");
        let (number, of) = text.split_once('/').ok_or_else(wrong)?;
        let [number, of] = [number, of].map(|part| part.trim().parse::<u64>().ok());
        let shard = Self { number: number.ok_or_else(wrong)?, of: of.ok_or_else(wrong)? };
        if (1..=shard.of).contains(&shard.number) { Ok(shard) } else { Err(wrong()) }
    }
}

impl Shard {
    /// The whole study.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Whether a case belongs to it.
    pub fn has(self, case: u64) -> bool {
        case % self.of == self.number - 1
    }
}

/// Parameters and samples.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyPlan {
    parameters: Vec<StudyParameter>,
    samples: u32,
    cases: u64,
    /// For each parameter that is sampled, where its samples lie in its range; none for the others.
    shares: Vec<Option<Vec<f64>>>,
}

impl StudyPlan {
    /// Checked.
    ///
    /// # Errors
    /// No parameters; a key twice; samples without a range, or a range without samples; more cases than `most`.
    pub fn new(
        parameters: Vec<StudyParameter>,
        (samples, design, seed): (Option<u32>, SampleDesign, u32),
        most: u64,
    ) -> Result<Self, Refusal> {
        let refuse = |problem: String, way_out: &str| Err(Refusal::new("study", problem, way_out));
        if parameters.is_empty() {
            return refuse("no key differs from case to case".to_owned(), "give a parameter: see docs/studies.md");
        }
        for (place, parameter) in parameters.iter().enumerate() {
            if parameters[..place].iter().any(|other| other.key == parameter.key) {
                return refuse(format!("`{}` is a parameter twice", parameter.key), "leave one of them");
            }
        }
        let is_sampled = |of: &StudyParameter| !matches!(of.choice, ParameterValues::Values(_));
        let sampled = parameters.iter().filter(|of| is_sampled(of)).count();
        let samples = match (samples, sampled) {
            (None, 0) => 1,
            (Some(0), _) => return refuse("0 samples are no study".to_owned(), "take 1 or more"),
            (Some(_), 0) => {
                return refuse(
                    "samples of nothing: every parameter lists its values".to_owned(),
                    "leave the samples out, or give a range without a number of values",
                );
            }
            (None, _) => {
                return refuse(
                    "a range is sampled, and it is not said how often".to_owned(),
                    "give the number of samples, or of values in the range: KEY=a..b/n",
                );
            }
            (Some(samples), _) => samples,
        };
        if design == SampleDesign::Sobol && sampled > MOST_OF_SOBOL {
            return refuse(
                format!("{sampled} parameters are more than the {MOST_OF_SOBOL} that Sobol's sequence has here"),
                "take a Latin hypercube",
            );
        }
        let mut counts = parameters
            .iter()
            .map(|of| if let ParameterValues::Values(list) = &of.choice { list.len() as u64 } else { 1 });
        let cases = counts.try_fold(u64::from(samples), u64::checked_mul);
        let cases = match cases {
            Some(cases) if cases <= most => cases,
            _ => {
                let count = cases.map_or_else(|| "more than 10^19".to_owned(), |cases| cases.to_string());
                let way_out =
                    format!("take fewer values or samples; or mean it: --most-cases {}", cases.unwrap_or(most));
                return refuse(format!("{count} cases are more than {most}"), &way_out);
            }
        };
        let mut place = 0;
        let shares = parameters.iter().map(|of| {
            is_sampled(of).then(|| {
                let dimension = place;
                place += 1;
                match design {
                    SampleDesign::LatinHypercube => latin_hypercube(seed, dimension, samples),
                    SampleDesign::Sobol => (0..samples).map(|sample| sobol(dimension, sample)).collect(),
                }
            })
        });
        let shares = shares.collect();
        Ok(Self { parameters, samples, cases, shares })
    }

    /// The parameters.
    pub fn parameters(&self) -> &[StudyParameter] {
        &self.parameters
    }

    /// Number of cases.
    pub fn cases(&self) -> u64 {
        self.cases
    }

    /// The value of every parameter in a case, as texts of TOML.
    pub fn values(&self, case: u64) -> Vec<String> {
        let sample = (case % u64::from(self.samples)) as usize;
        let mut rest = case / u64::from(self.samples);
        let mut values: Vec<String> = Vec::with_capacity(self.parameters.len());
        for (parameter, shares) in self.parameters.iter().zip(&self.shares).rev() {
            values.push(match (&parameter.choice, shares) {
                (ParameterValues::Between(range), Some(shares)) => range.at(shares[sample]),
                (ParameterValues::Normal(normal), Some(shares)) => normal.at(shares[sample]),
                (ParameterValues::Values(list), _) => {
                    let place = (rest % list.len() as u64) as usize;
                    rest /= list.len() as u64;
                    list[place].clone()
                }
                (_, None) => unreachable!("what lists no values has samples"),
            });
        }
        values.reverse();
        values
    }

    /// What tells this plan from others.
    pub fn checksum(&self) -> String {
        let text = format!("{:?}", (&self.parameters, self.samples, &self.shares));
        sha256_hex(text.as_bytes())
    }

    /// What a case sets in the scene.
    pub fn settings(&self, case: u64) -> Vec<String> {
        let values = self.values(case);
        self.parameters.iter().zip(values).map(|(of, value)| format!("{}={value}", of.key)).collect()
    }
}
