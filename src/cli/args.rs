//! What can be typed, and the help that teaches it: one example per command, what it writes, in which units.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

/// The whole command line.
#[derive(Debug, Parser)]
#[command(
    name = "gearcut",
    version,
    about = "Cuts non-circular gears on this computer before anyone cuts them in steel, and measures what the cutter leaves.",
    after_help = "First steps:\n  \
        gearcut check scenes/shaping/elliptical_normal.toml   what the scene means, in a second\n  \
        gearcut cut scenes/shaping/elliptical_normal.toml     cut it and measure it\n  \
        gearcut new shaping --out my_gear.toml                a commented scene of your own\n\n\
        Exit codes: 0 done; 1 refused or failed, with the reason; 2 wrong usage; 130 stopped by Ctrl-C."
)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Cut a scene and measure what is left.
    #[command(after_help = "Example:\n  \
        gearcut cut scenes/shaping/elliptical_normal.toml --set operation.rough.offset_mm=1.5\n\n\
        Writes a folder (out/<scene> unless --out or the scene says otherwise): results.json with every number, its unit\n\
        and its definition; run.json to repeat the run; tables as CSV (mm, um, deg in the column names); maps of every\n\
        flank as EXR and PNG (um); axis tables and charts. An existing folder is replaced only if gearcut wrote it, and\n\
        only after the new one is complete. The summary goes to standard output, progress to standard error.")]
    Cut(CutArguments),
    /// Say what a scene means: pitch curve, teeth, axes, relief, warnings, cost. Cuts nothing.
    #[command(after_help = "Example:\n  \
        gearcut check scenes/shaping/elliptical_normal.toml --set gear.teeth=45\n\n\
        Prints lengths in mm or um, angles in deg, speeds in deg/s and mm/s; writes no files.")]
    Check(SceneArguments),
    /// Write the axis positions of every stroke, with charts.
    #[command(after_help = "Example:\n  \
        gearcut axes scenes/shaping/elliptical_normal.toml --out out/axes_of_my_gear\n\n\
        Writes a folder (out/<scene>_axes unless --out is given): axes/<operation>.csv with one row per stroke (s, deg,\n\
        mm, deg/s, mm/s, deg/s^2, mm/s^2), <operation>.ngc (G-code in straight lines, see docs/gcode.md), and charts of positions, velocities, accelerations and relief clearance over\n\
        the work angle as PNG and SVG. Prints the peaks against the machine's limits.")]
    Axes(AxesArguments),
    /// Put two results side by side.
    #[command(after_help = "Example:\n  \
        gearcut compare out/elliptical_traditional out/elliptical_normal\n\n\
        Writes a folder (compare_<A>_<B> beside B unless --out is given): comparison.csv with the headline numbers of\n\
        both and their differences, and the unevenness of the allowance as bars by tooth (%), both results in one chart\n\
        (first period of the pitch curve, and all teeth) and each on its own scale, as PNG and SVG. Prints the table.")]
    Compare(CompareArguments),
    /// List what can compute here.
    #[command(after_help = "Example:\n  gearcut devices")]
    Devices,
    /// Print the JSON Schema of scene files, for editors that complete and check TOML.
    #[command(after_help = "Example:\n  gearcut schema > scene.schema.json")]
    Schema,
    /// Write a commented scene to start from.
    #[command(after_help = "Example:\n  gearcut new shaping --out my_gear.toml\n\n\
        Every key stands in it with its unit, its range and its default. An existing file is never replaced.")]
    New(NewArguments),
}

/// A scene and what is changed in it.
#[derive(Debug, Args)]
pub struct SceneArguments {
    /// Scene file (TOML).
    pub scene: PathBuf,
    /// Put another value into the scene, such as gear.module_mm=2.5 or operation.rough.offset_mm=1.5; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,
}

/// Arguments of `cut`.
#[derive(Debug, Args)]
pub struct CutArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Folder to write [default: out/<scene>].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What computes: auto takes a GPU if there is a real one.
    #[arg(long, value_enum, default_value_t = BackendChoice::Auto)]
    pub backend: BackendChoice,
    /// What happens to a flank whose GPU is lost or runs out of memory.
    #[arg(long, value_enum, default_value_t = GpuFailureChoice::Redo)]
    pub on_gpu_failure: GpuFailureChoice,
    /// Show no progress and no summary.
    #[arg(long, conflicts_with = "json")]
    pub quiet: bool,
    /// Report progress on standard error as one JSON object per line, and print results.json instead of the summary.
    #[arg(long)]
    pub json: bool,
}

/// What computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum BackendChoice {
    /// A real GPU if there is one, else the processor.
    Auto,
    /// A GPU, or fail.
    Gpu,
    /// The processor, in double precision.
    Cpu,
}

/// What to do when a GPU fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum GpuFailureChoice {
    /// Cut the flank again on the processor.
    Redo,
    /// Stop the run.
    Stop,
}

/// Arguments of `axes`.
#[derive(Debug, Args)]
pub struct AxesArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Folder to write [default: out/<scene>_axes].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `compare`.
#[derive(Debug, Args)]
pub struct CompareArguments {
    /// Output folder of the first run (or its results.json).
    pub a: PathBuf,
    /// Output folder of the second run (or its results.json).
    pub b: PathBuf,
    /// Folder to write [default: compare_<A>_<B> beside B].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `new`.
#[derive(Debug, Args)]
pub struct NewArguments {
    /// What the scene is for.
    #[arg(value_parser = clap::builder::PossibleValuesParser::new(gearcut::scene::PROCESSES))]
    pub process: String,
    /// File to write [default: standard output].
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}
