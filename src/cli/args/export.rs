//! What can be typed behind `export`.

use clap::{ArgGroup, Args, ValueEnum};
use std::path::PathBuf;

use super::{ComputeArguments, SceneArguments};

/// What can be written; one of them at least.
const FILES: [&str; 6] = ["dxf", "tool_dxf", "step", "points", "qif", "wire"];

/// Arguments of `export`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("files").required(true).multiple(true).args(FILES))]
#[command(group = ArgGroup::new("lists").multiple(true).args(["points", "qif"]))]
#[command(group = ArgGroup::new("sections").multiple(true).args(["dxf", "wire"]))]
pub struct ExportArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// DXF of the gear's section to write.
    #[arg(long, value_name = "FILE")]
    pub dxf: Option<PathBuf>,
    /// DXF of the tool to write: the whole shaper cutter, or the edge of one hob tooth.
    #[arg(long, value_name = "FILE")]
    pub tool_dxf: Option<PathBuf>,
    /// STEP file of the whole gear to write: one closed solid of smooth faces; of a bevel gear its flanks as surfaces.
    #[arg(long, value_name = "FILE", conflicts_with = "teeth")]
    pub step: Option<PathBuf>,
    /// Points of the flanks with their normals to write, as CSV: of all gears, bevel gears too.
    #[arg(long, value_name = "FILE")]
    pub points: Option<PathBuf>,
    /// QIF 3.0 document of the same points to write: nominal ones, and with --as-cut results with their deviations.
    #[arg(long, value_name = "FILE")]
    pub qif: Option<PathBuf>,
    /// Places along the profile and along the tooth at which the points lie; 200x1 scans the profile, 1x200 the helix.
    #[arg(long, value_name = "NxN", default_value = "9x5", value_parser = point_grid, requires = "lists")]
    pub grid: PointGrid,
    /// Program of wire erosion round the section to write, for LinuxCNC.
    #[arg(long, value_name = "FILE", conflicts_with = "teeth")]
    pub wire: Option<PathBuf>,
    /// Diameter of the wire.
    #[arg(long, value_name = "UM", default_value_t = 250.0, requires = "wire")]
    pub wire_diameter_um: f64,
    /// Spark gap between wire and gear.
    #[arg(long, value_name = "UM", default_value_t = 20.0, requires = "wire")]
    pub gap_um: f64,
    /// From the start hole to the path, straight.
    #[arg(long, value_name = "MM", default_value_t = 3.0, requires = "wire")]
    pub lead_mm: f64,
    /// Largest feed of the wire.
    #[arg(long, value_name = "MM", default_value_t = 3.0, requires = "wire")]
    pub feed_mm_per_min: f64,
    /// Largest distance between what is written and the curve, 0.01 to 1000.
    #[arg(long, value_name = "UM", default_value_t = 1.0)]
    pub tolerance_um: f64,
    /// Cut the gear and take the profile as the passes leave it, with every mark, instead of the target.
    #[arg(long)]
    pub as_cut: bool,
    /// Some teeth alone, as an open profile from the middle of a root to that of another: 3..5, or 4.
    #[arg(long, value_name = "FROM..TO", value_parser = tooth_range)]
    pub teeth: Option<ToothRange>,
    /// Place of the section along the tooth, from the middle of the face.
    #[arg(long, value_name = "MM", default_value_t = 0.0, requires = "sections")]
    pub section_mm: f64,
    /// Unit of length of the files.
    #[arg(long, value_enum, default_value_t = LengthUnitChoice::Mm)]
    pub units: LengthUnitChoice,
    /// Replace files that exist.
    #[arg(long)]
    pub force: bool,
    /// Backend and progress.
    #[command(flatten)]
    pub compute: ComputeArguments,
}

/// Units that files may be in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum LengthUnitChoice {
    /// Millimetres.
    Mm,
    /// Inches of 25.4 mm.
    Inch,
}

/// Places along profile and tooth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PointGrid(pub [usize; 2]);

/// `9x5`.
fn point_grid(text: &str) -> Result<PointGrid, String> {
    let number = |word: &str| word.trim().parse::<usize>().ok().filter(|count| (1..=10_000).contains(count));
    match text.split_once('x').map(|(profile, lead)| [profile, lead].map(number)) {
        Some([Some(profile), Some(lead)]) => Ok(PointGrid([profile, lead])),
        _ => Err("give places along profile and tooth, 1 to 10000 each, such as 9x5".to_owned()),
    }
}

/// First and last tooth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ToothRange(pub [u32; 2]);

/// `4`, or `3..5` with both ends.
fn tooth_range(text: &str) -> Result<ToothRange, String> {
    let (first, last) = text.split_once("..").unwrap_or((text, text));
    let number = |word: &str| word.trim().parse::<u32>().ok().filter(|&tooth| tooth > 0);
    match (number(first), number(last)) {
        (Some(first), Some(last)) if first <= last => Ok(ToothRange([first, last])),
        (Some(first), Some(last)) => Err(format!("the first tooth comes first: give {last}..{first}")),
        _ => Err("teeth are counted from 1: give one, such as 4, or the first and the last, such as 3..5".to_owned()),
    }
}
