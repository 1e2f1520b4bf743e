//! What can be typed behind the commands that make many scenes.

use super::{ComputeArguments, SceneArguments};
use crate::study::parameter::{GridWords, RangeWords};
use crate::study::plan::USUAL_CASES;
use crate::study::{SampleDesign, Shard, StudyCommand};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `study`.
#[derive(Debug, Args)]
pub struct StudyArguments {
    /// Study file (TOML).
    pub study: PathBuf,
    /// Which cases are made, and how.
    #[command(flatten)]
    pub cases: CasesArguments,
}

/// Arguments of `sweep`.
#[derive(Debug, Args)]
pub struct SweepArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Values of a key, such as gear.teeth=20,24,28; tables of TOML as well; may be repeated.
    #[arg(long, value_name = "KEY=A,B,C")]
    pub grid: Vec<GridWords>,
    /// N values of a key evenly from A to B, such as machine.back_off_mm=0.2..1.0/5, `log` behind it in logarithms;
    /// without /N one value between them for each sample; may be repeated.
    #[arg(long, value_name = "KEY=A..B/N")]
    pub range: Vec<RangeWords>,
    /// Quantities that become columns: keys of the headline, or paths below `sections` of results.json; `*` is any text
    /// without a dot.
    #[arg(long, value_name = "KEYS", value_delimiter = ',', required = true)]
    pub keep: Vec<String>,
    /// What is done with every case.
    #[arg(long, value_enum, default_value_t = CommandChoice::Cut)]
    pub command: CommandChoice,
    /// The scene of the other gear of pairs; its keys begin with mate., options of `gearcut pair` with pair.
    #[arg(long, value_name = "SCENE")]
    pub mate: Option<PathBuf>,
    /// Cut drafts: coarse dexels and rays.
    #[arg(long)]
    pub draft: bool,
    /// Number of samples of the ranges without a number of values.
    #[arg(long, value_name = "N")]
    pub samples: Option<u32>,
    /// Where samples lie.
    #[arg(long, value_enum, default_value_t = DesignChoice::LatinHypercube)]
    pub design: DesignChoice,
    /// Seed of the Latin hypercube.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u32,
    /// Which cases are made, and how.
    #[command(flatten)]
    pub cases: CasesArguments,
}

/// Which cases are made, and how.
#[derive(Debug, Args)]
pub struct CasesArguments {
    /// Make one share of the cases alone, such as 2/8: the second of eight.
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    pub shard: Shard,
    /// Largest number of cases that is taken for meant.
    #[arg(long, value_name = "N", default_value_t = USUAL_CASES)]
    pub most_cases: u64,
    /// Folder to write or to go on with [default: out/<name>_study, in it shard_<i>_of_<n> for shares].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Backend and progress.
    #[command(flatten)]
    pub compute: ComputeArguments,
}

/// What is done with every case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CommandChoice {
    /// Cut and measure the whole gear.
    Cut,
    /// Move the axes alone.
    Axes,
    /// Roll the gear with the one of --mate.
    Pair,
}

impl CommandChoice {
    /// The command.
    pub fn command(self) -> StudyCommand {
        match self {
            Self::Cut => StudyCommand::Cut,
            Self::Axes => StudyCommand::Axes,
            Self::Pair => StudyCommand::Pair,
        }
    }
}

/// Where samples lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DesignChoice {
    /// One in each of equal shares of every range.
    LatinHypercube,
    /// Sobol's sequence.
    Sobol,
    /// Pairs of its points, and cases between them that differ in one parameter alone: total shares.
    SobolPairs,
}

impl DesignChoice {
    /// The design.
    pub fn design(self) -> SampleDesign {
        match self {
            Self::LatinHypercube => SampleDesign::LatinHypercube,
            Self::Sobol => SampleDesign::Sobol,
            Self::SobolPairs => SampleDesign::SobolPairs,
        }
    }
}
