//! What can be typed on how a surface file is read, and what is done to the surface before it is evaluated.

use crate::output::surface_files::LengthUnit;
use clap::{Args, ValueEnum};
use std::str::FromStr;

/// Arguments of `texture` on reading.
#[derive(Debug, Args)]
#[command(next_help_heading = "Reading")]
pub struct ReadingArguments {
    /// Distance of points along x and y, for files that carry none; one value holds for both.
    #[arg(long, value_name = "DX [DY]", num_args = 1..=2)]
    pub spacing_um: Vec<f64>,
    /// Unit of the heights, for files that do not say it: m, mm, um, nm ...
    #[arg(long, value_name = "UNIT", value_parser = LengthUnit::from_str)]
    pub height_unit: Option<LengthUnit>,
    /// Unit of spacings and positions in the file, for files that do not say it.
    #[arg(long, value_name = "UNIT", value_parser = LengthUnit::from_str)]
    pub spacing_unit: Option<LengthUnit>,
    /// Leave out the points that the file's own mask marks (GWY).
    #[arg(long)]
    pub use_mask: bool,
    /// Leave out the points in this rectangle; may be repeated.
    #[arg(long, value_names = ["X0", "X1", "Y0", "Y1"], num_args = 4)]
    pub mask_um: Vec<f64>,
    /// Leave out points farther from the median of 5 x 5 points than so many standard deviations, such as 6.
    #[arg(long, value_name = "SIGMAS")]
    pub outliers: Option<f64>,
    /// Fill holes with the harmonic surface through their edges.
    #[arg(long)]
    pub fill: bool,
    /// Change the sign of the heights: a replica shows hills for valleys.
    #[arg(long)]
    pub invert: bool,
    /// Let this axis run the other way: a replica shows left for right.
    #[arg(long, value_enum, value_name = "AXIS")]
    pub mirror: Option<AxisChoice>,
    /// Keep this rectangle only.
    #[arg(long, value_names = ["X0", "X1", "Y0", "Y1"], num_args = 4)]
    pub crop_to_um: Vec<f64>,
    /// Turn the surface counter-clockwise, from +x towards +y, or until its lay runs along x.
    #[arg(long, value_name = "DEG|lay", allow_hyphen_values = true)]
    pub rotate: Option<String>,
}

/// Axes of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum AxisChoice {
    /// Along the rows.
    X,
    /// From row to row.
    Y,
}
