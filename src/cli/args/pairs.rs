//! What can be typed behind the commands that roll two gears.

use clap::{ArgGroup, Args, ValueEnum};
use std::path::PathBuf;

use super::{RunArguments, VerdictArguments};

/// Arguments of `contact`.
#[derive(Debug, Args)]
pub struct ContactArguments {
    /// The gear: a scene with a face-mill head.
    pub gear: PathBuf,
    /// The pinion that runs with it.
    pub pinion: PathBuf,
    /// The pinion as its concave flanks are finished, where they have settings of their own.
    pub pinion_concave: Option<PathBuf>,
    /// Put another value into the gear's scene; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set_gear: Vec<String>,
    /// Put another value into the pinion's scenes; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set_pinion: Vec<String>,
    /// Offset of the pinion's axis (E).
    #[arg(long, value_name = "UM", default_value_t = 0.0)]
    pub e_um: f64,
    /// Pinion along its axis, away from the apex (P).
    #[arg(long, value_name = "UM", default_value_t = 0.0)]
    pub p_um: f64,
    /// Gear along its axis, away from the apex (G).
    #[arg(long, value_name = "UM", default_value_t = 0.0)]
    pub g_um: f64,
    /// Error of the shaft angle (Sigma).
    #[arg(long, value_name = "DEG", default_value_t = 0.0)]
    pub sigma_deg: f64,
    /// Thickness of the marking compound of contact ellipses.
    #[arg(long, value_name = "UM", default_value_t = 6.35)]
    pub marking_um: f64,
    /// Folder to write [default: out/<GEAR>_with_<PINION>].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print results.json instead of the summary.
    #[arg(long)]
    pub json: bool,
    /// What makes the verdict bad.
    #[command(flatten)]
    pub verdict: VerdictArguments,
}

/// Arguments of `pair`.
#[derive(Debug, Args)]
#[command(
    group = ArgGroup::new("gear B").required(true).args(["b", "mate"]),
    override_usage = "gearcut pair [OPTIONS] <A> <B | --mate <TEETH>>"
)]
pub struct PairArguments {
    /// Gear A, the driver: a scene or a folder that `gearcut cut` wrote.
    pub a: PathBuf,
    /// Gear B: the same; leave it out with --mate.
    pub b: Option<PathBuf>,
    /// Gear B is the mate of gear A with so many teeth, cut like gear A.
    #[arg(long, value_name = "TEETH", value_parser = clap::value_parser!(u32).range(4..=2000))]
    pub mate: Option<u32>,
    /// The mate is a ring with internal teeth.
    #[arg(long, requires = "mate")]
    pub internal: bool,
    /// Put another value into gear A's scene; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set_a: Vec<String>,
    /// Put another value into gear B's scene; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set_b: Vec<String>,
    /// Which flanks are rolled.
    #[arg(long, value_enum, default_value_t = FlankChoice::Cut)]
    pub flanks: FlankChoice,
    /// Positions in a period of the pair, 8 or more for each tooth that passes [default: 2000, or 12 for each tooth].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(64..=1_000_000))]
    pub positions: Option<u32>,
    /// Transverse sections that are rolled [default: 1 of spur gears; 11 of helical ones, of axes out of parallel, and
    /// where errors of cutting vary along the face].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=201))]
    pub sections: Option<u32>,
    /// Distance of the axes [default: gear.center_distance_mm of the scenes, else that of the profile shifts of round
    /// gears, and the one at which other pitch curves close].
    #[arg(long, value_name = "MM")]
    pub center_distance_mm: Option<f64>,
    /// Added to that distance.
    #[arg(long, value_name = "UM", default_value_t = 0.0)]
    pub center_distance_error_um: f64,
    /// How far gear A's pitch curve sits off its axis of rotation.
    #[arg(long, value_name = "UM", default_value_t = 0.0)]
    pub eccentricity_a_um: f64,
    /// Polar angle of gear A at which it sits out.
    #[arg(long, value_name = "DEG", default_value_t = 0.0)]
    pub eccentricity_a_at_deg: f64,
    /// How far gear B's pitch curve sits off its axis of rotation.
    #[arg(long, value_name = "UM", default_value_t = 0.0)]
    pub eccentricity_b_um: f64,
    /// Polar angle of gear B at which it sits out.
    #[arg(long, value_name = "DEG", default_value_t = 0.0)]
    pub eccentricity_b_at_deg: f64,
    /// Teeth by which gear B is turned on, modulo its teeth: other teeth meet.
    #[arg(long, value_name = "TEETH", default_value_t = 0)]
    pub phase_teeth: i64,
    /// How far the axes come apart from end to end of the common face, in their plane (ISO/TR 10064-3); at most 10 um
    /// for each mm of it.
    #[arg(long, value_name = "UM", default_value_t = 0.0)]
    pub parallelism_in_plane_um: f64,
    /// How far they come apart across their plane.
    #[arg(long, value_name = "UM", default_value_t = 0.0)]
    pub parallelism_out_of_plane_um: f64,
    /// Thickness of the marking compound of contact patterns.
    #[arg(long, value_name = "UM", default_value_t = 6.0)]
    pub marking_um: f64,
    /// Backend, progress and verdict.
    #[command(flatten)]
    pub run: RunArguments,
    /// Folder to write [default: out/<A>_with_<B>].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print results.json instead of the summary.
    #[arg(long)]
    pub json: bool,
}

/// Which flanks are rolled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FlankChoice {
    /// As cut, with every stroke and the fillets.
    Cut,
    /// Conjugate ones, without strokes and fillets.
    Nominal,
}
