//! The plan of a study: which cases there are, and what each of them sets.
//!
//! In: parameters, samples and their design. Out: the number of cases, and the settings of case `i`.
//!
//! The law: a case is one combination of the values of all listed parameters, and one sample of all others. The last
//! listed parameter changes fastest, samples faster still, and the cases of a pair of samples fastest of all. Case
//! numbers begin with 0.

use super::design::{MOST_OF_SOBOL, latin_hypercube, sobol};
use super::parameter::{ParameterValues, StudyParameter};
use crate::steps::record::sha256_hex;
use gearcut_core::error::Refusal;
use serde::Deserialize;
use std::str::FromStr;

/// Places of the second point of a pair, and of the first case between both, among the cases of a sample.
const SECOND: u32 = 1;
const FIRST_OF_PAIRS: u32 = 2;
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
    /// The gear is rolled with another one.
    Pair,
}

impl StudyCommand {
    /// How it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cut => "cut",
            Self::Axes => "axes",
            Self::Pair => "pair",
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
    /// Two points of Sobol's sequence for each sample, and for each parameter the first one with that parameter of the
    /// second: cases in pairs that differ in one parameter alone, for total shares (Saltelli, *Comput. Phys. Commun.*
    /// 145, 2002).
    SobolPairs,
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
    /// Points of all sampled parameters together.
    samples: u32,
    /// Cases of each of them: more than one where they come in pairs.
    cases_of_a_sample: u32,
    cases: u64,
    /// For each parameter that is sampled, where its samples lie in its range, of pairs those of the second points
    /// behind those of the first ones; none for the others.
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
        let is_paired = design == SampleDesign::SobolPairs;
        let most_sampled = if is_paired { MOST_OF_SOBOL / 2 } else { MOST_OF_SOBOL };
        if design != SampleDesign::LatinHypercube && sampled > most_sampled {
            let each = if is_paired { "two points of " } else { "" };
            return refuse(
                format!("{sampled} parameters are more than the {most_sampled} that {each}Sobol's sequence has here"),
                "take a Latin hypercube",
            );
        }
        if is_paired && sampled == 0 {
            return refuse("no parameter is sampled in pairs".to_owned(), "give a range without a number of values");
        }
        let cases_of_a_sample = if is_paired { sampled as u32 + 2 } else { 1 };
        let mut counts = parameters
            .iter()
            .map(|of| if let ParameterValues::Values(list) = &of.choice { list.len() as u64 } else { 1 });
        let cases = counts.try_fold(u64::from(samples) * u64::from(cases_of_a_sample), u64::checked_mul);
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
                let sobol = |dimension| (0..samples).map(move |sample| sobol(dimension, sample));
                match design {
                    SampleDesign::LatinHypercube => latin_hypercube(seed, dimension, samples),
                    SampleDesign::Sobol => sobol(dimension).collect(),
                    SampleDesign::SobolPairs => sobol(dimension).chain(sobol(sampled + dimension)).collect(),
                }
            })
        });
        let shares = shares.collect();
        Ok(Self { parameters, samples, cases_of_a_sample, cases, shares })
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
        let (mut rest, point, place) = self.place(case);
        let mut sampled = self.shares.iter().flatten().count();
        let mut values: Vec<String> = Vec::with_capacity(self.parameters.len());
        for (parameter, shares) in self.parameters.iter().zip(&self.shares).rev() {
            values.push(match (&parameter.choice, shares) {
                (choice, Some(shares)) => {
                    sampled -= 1;
                    let is_second = place == SECOND || place == FIRST_OF_PAIRS + sampled as u32;
                    let share = shares[point as usize + if is_second { self.samples as usize } else { 0 }];
                    match choice {
                        ParameterValues::Between(range) => range.at(share),
                        ParameterValues::Normal(normal) => normal.at(share),
                        ParameterValues::Values(_) => unreachable!("listed values are not sampled"),
                    }
                }
                (ParameterValues::Values(list), None) => {
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

    /// A case as the combination of listed values, the sample and the place among the cases of that sample.
    fn place(&self, case: u64) -> (u64, u32, u32) {
        let [samples, own] = [self.samples, self.cases_of_a_sample].map(u64::from);
        (case / (samples * own), (case / own % samples) as u32, (case % own) as u32)
    }

    /// Whether a case is one of the points themselves, which have nothing to do with each other; those that differ from
    /// them in one parameter are not.
    pub fn is_a_point(&self, case: u64) -> bool {
        self.place(case).2 < FIRST_OF_PAIRS
    }

    /// Whether every value of each parameter comes with every value of the others.
    pub fn is_a_grid(&self) -> bool {
        self.shares.iter().all(Option::is_none)
    }

    /// Of the first point of each pair, by the number of the parameter: its second point, and the case that differs
    /// from it in this parameter alone. None of other cases, designs and parameters.
    pub fn partners(&self, case: u64, parameter: usize) -> Option<[u64; 2]> {
        self.shares.get(parameter)?.as_ref()?;
        let sampled = self.shares[..parameter].iter().flatten().count();
        let is_first = self.cases_of_a_sample > 1 && self.place(case).2 == 0;
        is_first.then(|| [u64::from(SECOND), u64::from(FIRST_OF_PAIRS) + sampled as u64].map(|place| case + place))
    }

    /// What tells this plan from others.
    pub fn checksum(&self) -> String {
        let text = format!("{:?}", (&self.parameters, self.samples, self.cases_of_a_sample, &self.shares));
        sha256_hex(text.as_bytes())
    }

    /// What a case sets in the scene.
    pub fn settings(&self, case: u64) -> Vec<String> {
        let values = self.values(case);
        self.parameters.iter().zip(values).map(|(of, value)| format!("{}={value}", of.key)).collect()
    }
}
