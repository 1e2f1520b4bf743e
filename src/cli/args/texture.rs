//! What can be typed behind the commands that evaluate surfaces.

use super::ReadingArguments;
use crate::measure::topography::Form;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// What is taken off a surface before it is evaluated.
#[derive(Debug, Args)]
pub struct FilterArguments {
    /// F-operator: what is taken off before texture is evaluated; the default is that of texture windows in scenes.
    #[arg(long, value_enum, default_value_t = FormChoice::Poly2)]
    pub form: FormChoice,
    /// Nesting index of the S-filter: shorter waves are taken off (Gaussian, ISO 16610-61).
    #[arg(long, value_name = "UM")]
    pub s_filter_um: Option<f64>,
    /// Nesting index of the L-filter: longer waves are taken off (Gaussian, ISO 16610-61).
    #[arg(long, value_name = "UM")]
    pub l_filter_um: Option<f64>,
}

/// Arguments of `texture`.
#[derive(Debug, Args)]
pub struct TextureArguments {
    /// Surface file.
    pub file: PathBuf,
    /// How the file is read.
    #[command(flatten)]
    pub reading: ReadingArguments,
    /// What is taken off before texture is evaluated.
    #[command(flatten)]
    pub filters: FilterArguments,
    /// Make the L-filter the robust one (ISO 16610-71, of profiles ISO 16610-31), which deep scratches do not pull.
    #[arg(long)]
    pub robust: bool,
    /// Margin to leave out on every side, after the filters.
    #[arg(long, value_name = "UM", default_value_t = 0.0)]
    pub crop_um: f64,
    /// Give Smr also at this height over the mean plane; may be repeated.
    #[arg(long, value_name = "UM")]
    pub at_height_um: Vec<f64>,
    /// Give Smc, Vm and Vv also at this material ratio; may be repeated.
    #[arg(long, value_name = "PERCENT")]
    pub at_ratio_percent: Vec<f64>,
    /// Profile parameters of lines.
    #[command(flatten)]
    pub lines: LineArguments,
    /// Save the surface as it was read and prepared; the ending says how: x3p, sdf, ascii.sdf, sur, npy, csv; may be
    /// repeated.
    #[arg(long, value_name = "FILE")]
    pub save: Vec<PathBuf>,
    /// Let --save replace files; never the one that is read.
    #[arg(long)]
    pub force: bool,
    /// Print JSON: every value with unit and definition, or null and why.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `texture` that lines have: their chain begins at the heights as read, not after the areal filters.
#[derive(Debug, Args)]
#[command(next_help_heading = "Profiles")]
pub struct LineArguments {
    /// Profile parameters along the row next to y=UM or the column next to x=UM; may be repeated.
    #[arg(long, value_name = "x=UM|y=UM")]
    pub line: Vec<String>,
    /// So many lines, spread evenly over y (rows) or x (columns): mean and range of their parameters.
    #[arg(long, value_names = ["x|y", "N"], num_args = 2)]
    pub lines: Vec<String>,
    /// Profile whose parameters are given: R roughness, W waviness, P primary (no cut-off).
    #[arg(long, value_enum, default_value_t = ProfileChoice::R)]
    pub profile: ProfileChoice,
    /// Cut-off lambda_c [default: that of --l-filter-um, else by ISO 21920-3 from the limits or the estimated Ra].
    #[arg(long, value_name = "UM")]
    pub cutoff_um: Option<f64>,
    /// Profile S-filter lambda_s, 0 for none [default: by ISO 21920-3 where points are close enough].
    #[arg(long, value_name = "UM")]
    pub lambda_s_um: Option<f64>,
    /// F-operator of lines.
    #[arg(long, value_enum, default_value_t = LineFormChoice::Line)]
    pub line_form: LineFormChoice,
    /// Number of sections [default: 5, or as many as a short line holds].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub sections: Option<u16>,
    /// Length of a section [default: the cut-off].
    #[arg(long, value_name = "UM")]
    pub section_um: Option<f64>,
    /// What is left out at both ends of a line, at least [default: half a cut-off].
    #[arg(long, value_name = "UM")]
    pub run_in_um: Option<f64>,
    /// Longest hole that is bridged by a straight line [default: a hundredth of the line].
    #[arg(long, value_name = "UM")]
    pub bridge_um: Option<f64>,
    /// Upper limit of Ra on the drawing: it is judged, and gives the cut-off.
    #[arg(long, value_name = "UM")]
    pub ra_limit_um: Option<f64>,
    /// Upper limit of Rz on the drawing: it is judged, and gives the cut-off where Ra has no limit.
    #[arg(long, value_name = "UM")]
    pub rz_limit_um: Option<f64>,
}

/// Profiles of ISO 21920-2.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ProfileChoice {
    /// Roughness.
    R,
    /// Waviness.
    W,
    /// Primary profile.
    P,
}

/// F-operators of lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum LineFormChoice {
    /// Nothing but the mean.
    None,
    /// Least-squares straight line.
    Line,
    /// Least-squares arc of a circle.
    Arc,
    /// Least-squares polynomial of this degree.
    Poly2,
    /// Third degree.
    Poly3,
    /// Fourth degree.
    Poly4,
    /// Fifth degree.
    Poly5,
}

/// F-operators.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FormChoice {
    /// Nothing but the mean.
    None,
    /// Least-squares plane.
    Plane,
    /// Least-squares polynomial of second order.
    Poly2,
    /// That polynomial together with a circular cylinder.
    #[value(name = "poly2-plus-cylinder")]
    Poly2PlusCylinder,
}

impl FormChoice {
    /// The operator.
    pub fn form(self) -> Form {
        match self {
            Self::None => Form::None,
            Self::Plane => Form::Plane,
            Self::Poly2 => Form::Poly2,
            Self::Poly2PlusCylinder => Form::Poly2PlusCylinder,
        }
    }
}
