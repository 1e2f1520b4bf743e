//! What can be typed behind the commands that ask what errors of machine and tool do.

use super::{RunArguments, SceneArguments, VerdictArguments};
use crate::scatter::tolerance::Tolerance;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `scatter`.
#[derive(Debug, Args)]
pub struct ScatterArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Number of gears; 0: the table of layers alone.
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(0..=100_000))]
    pub seeds: u32,
    /// A key of the scene that differs from gear to gear, every value between its limits being as likely; may be given
    /// several times.
    #[arg(long = "tolerance", value_name = "KEY=LOW..HIGH")]
    pub tolerances: Vec<Tolerance>,
    /// Tooth whose flank is looked at, from 1.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub tooth: u32,
    /// Which of its flanks.
    #[arg(long, value_enum, default_value_t = FlankSide::Left)]
    pub side: FlankSide,
    /// Folder to write or to go on with [default: out/<scene>_scatter].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Backend, progress and verdict.
    #[command(flatten)]
    pub run: RunArguments,
}

/// A flank of a tooth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FlankSide {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

/// Arguments of `calibrate`.
#[derive(Debug, Args)]
pub struct CalibrateArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// What was measured: numbers, places or charts (CSV), a surface (X3P, SDF, ...); several times for several files.
    #[arg(long, value_name = "FILE", required = true)]
    pub measured: Vec<String>,
    /// Standard uncertainty of every deviation on a chart and of every figure of an inspection.
    #[arg(long, value_name = "UM")]
    pub noise_um: Option<f64>,
    /// Standard uncertainty of the numbers of surfaces, per cent of each, of heights at least of Sa.
    #[arg(long, value_name = "PERCENT")]
    pub surface_percent: Option<f64>,
    /// Numbers that are taken from surfaces, by the symbols of ISO 25178-2.
    #[arg(long, value_name = "SYMBOLS", value_delimiter = ',', default_values = ["Sa", "Sk", "Spk", "Svk"])]
    pub surface_numbers: Vec<String>,
    /// Errors to fit, by key, section or whole name, such as mounting.eccentricity_um@90.
    #[arg(long, value_name = "KEYS", value_delimiter = ',', required = true)]
    pub fit: Vec<String>,
    /// Folder to write [default: out/<scene>_calibration].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Backend, progress and verdict.
    #[command(flatten)]
    pub run: RunArguments,
}

/// Arguments of `deviations`.
#[derive(Debug, Args)]
pub struct DeviationsArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Measured points (CSV), or a measured section (DXF).
    #[arg(long, value_name = "FILE")]
    pub measured: PathBuf,
    /// What may be moved to bring the points onto the target.
    #[arg(long, value_enum, default_value = "turn")]
    pub fit: FitChoice,
    /// Radius of the probe's ball, where the points are its centres.
    #[arg(long, value_name = "MM", default_value_t = 0.0)]
    pub probe_radius_mm: f64,
    /// Section of a drawing, from the middle of the face.
    #[arg(long, value_name = "MM", default_value_t = 0.0)]
    pub section_mm: f64,
    /// Layer of a drawing that has the points.
    #[arg(long, value_name = "NAME")]
    pub layer: Option<String>,
    /// Folder to write [default: out/<scene>_deviations].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Show no progress.
    #[arg(long)]
    pub quiet: bool,
    /// What makes the verdict bad.
    #[command(flatten)]
    pub verdict: VerdictArguments,
}

/// What may be moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FitChoice {
    /// Nothing: the points are in the gear's frame, x through the middle of a space, tooth 1 counter-clockwise of it.
    None,
    /// The gear about its axis.
    Turn,
    /// The same, and the axis across itself.
    Centre,
    /// The same, and the tilt of the axis.
    Axis,
    /// All of a body: the place along the axis as well.
    Body,
}

/// Arguments of `diagnose`.
#[derive(Debug, Args)]
pub struct DiagnoseArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Measured deviations (CSV).
    #[arg(long, value_name = "FILE")]
    pub measured: PathBuf,
    /// Standard deviation of the noise in each measured value, marks of strokes included. What the axes do at random
    /// counts beside it, as the scene has it: noise_arcsec or noise_um and noise_bandwidth_hz of
    /// [machine.errors.AXIS].
    #[arg(long, value_name = "UM")]
    pub noise_um: f64,
    /// Folder to write [default: out/<scene>_diagnosis].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Backend, progress and verdict.
    #[command(flatten)]
    pub run: RunArguments,
    /// Errors to try, by key, section or whole name [default: all; the first entry of lists].
    #[arg(long, value_name = "KEYS", value_delimiter = ',')]
    pub parameters: Vec<String>,
}

/// Arguments of `budget`.
#[derive(Debug, Args)]
pub struct BudgetArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Folder to write [default: out/<scene>_budget].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Errors to shift, by key, section or whole name, such as mounting or tool.shaper_cutter.runout_um@90 [default:
    /// all; the first entry of lists].
    #[arg(long, value_name = "KEYS", value_delimiter = ',')]
    pub parameters: Vec<String>,
    /// Cut these flanks alone, such as 1-left,7-right; pitch is left out then [default: both flanks of four teeth, and
    /// all on the pitch curve].
    #[arg(long, value_name = "FLANKS", value_delimiter = ',')]
    pub flanks: Vec<String>,
    /// Make whole cuts as well, and write the influence on every number that they report to tables/numbers.csv.
    #[arg(long)]
    pub numbers: bool,
    /// Backend, progress and verdict.
    #[command(flatten)]
    pub run: RunArguments,
}
