//! Errors as values: what a surface does not allow, which file cannot be used, and why.
//!
//! Every sentence on surfaces, lines and filters is one of [`TextureError`], with what it names as fields, ready to
//! print. Formats say more than a list could hold: a [`FileFault`] says of what kind a fault is, with a sentence.

use std::path::PathBuf;

use crate::text::{self, short};

/// What a surface, a line or a step of a chain does not allow, and why a parameter does not exist.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// A grid of fewer points than a surface has.
    #[error("a surface needs at least 2 x 2 points, not {nx} x {ny}")]
    SmallGrid {
        /// Points along x.
        nx: usize,
        /// Points along y.
        ny: usize,
    },
    /// A spacing that is no length.
    #[error("the spacing must be positive, not {dx_um} x {dy_um} um")]
    NoSpacing {
        /// Along x, um.
        dx_um: f64,
        /// Along y, um.
        dy_um: f64,
    },
    /// A spacing beyond what is evaluated.
    #[error(
        "a spacing of {spacing_um:e} um is out of range, {:e} to {:e} um: is it in another unit?",
        range_um[0], range_um[1]
    )]
    SpacingOutOfRange {
        /// Distance of points, um.
        spacing_um: f64,
        /// Least and most, um.
        range_um: [f64; 2],
    },
    /// Heights and grid differ.
    #[error("{heights} heights do not fill a grid of {nx} x {ny}")]
    UnfilledGrid {
        /// Number of heights.
        heights: usize,
        /// Points along x.
        nx: usize,
        /// Points along y.
        ny: usize,
    },
    /// Holes alone.
    #[error("no point of the surface was measured")]
    NothingMeasured,
    /// A height beyond what is evaluated; points and rows count from 1, a line has no row.
    #[error(
        "the height of point {point}{} is {}, beyond +-{most_um:e} um (1 m), where squares and sums \
         overflow: give heights in the right unit, and leave out points that were not measured",
        row.map_or_else(String::new, |row| format!(" in row {row}")),
        // What f64 cannot hold in um came in as its largest number.
        if height_um.abs() < f64::MAX { format!("{height_um:e} um") } else { "more than any number".to_owned() }
    )]
    HeightOutOfRange {
        /// Its point in the row or line.
        point: usize,
        /// Its row.
        row: Option<usize>,
        /// The height, um.
        height_um: f64,
        /// The largest that is evaluated, um.
        most_um: f64,
    },
    /// A margin as wide as the surface.
    #[error("cropping {margin_um} um on every side takes all of {:.3} x {:.3} mm", size_mm[0], size_mm[1])]
    NothingLeft {
        /// What is cropped on every side, um.
        margin_um: f64,
        /// Size along x and y, mm.
        size_mm: [f64; 2],
    },
    /// A rectangle beside the map.
    #[error(
        "no point in {}: the map reaches from 0 to {} um and from 0 to {} um",
        rectangle_words(rectangle_um), size_um[0], size_um[1]
    )]
    EmptyRectangle {
        /// The rectangle, um.
        rectangle_um: [[f64; 2]; 2],
        /// Size of the map along x and y, um.
        size_um: [f64; 2],
    },
    /// More holes than are filled.
    #[error("{percent:.0} % of the points are holes; up to {most_percent:.0} % are filled")]
    TooManyHoles {
        /// Share of holes, %.
        percent: f64,
        /// Largest share that is filled, %.
        most_percent: f64,
    },
    /// A surface without a direction to turn by.
    #[error("no lay to turn to: {0}")]
    NoLay(Box<TextureError>),
    /// The same, of a parameter that needs a spectrum.
    #[error("the map has {holes} holes, and a Fourier spectrum needs every point; crop them away")]
    HolesInSpectrum {
        /// Number of holes.
        holes: usize,
    },
    /// Two surfaces without enough in common.
    #[error("the surfaces share too few measured points to be laid over each other")]
    TooLittleInCommon,
    /// Two surfaces beside each other.
    #[error("the surfaces do not overlap")]
    NoOverlap,
    /// A surface without a wave that it holds often enough.
    #[error("the surface has no marks")]
    NoMarks,
    /// A surface that is its mean plane.
    #[error("the surface is flat")]
    FlatSurface,
    /// A line that is its mean.
    #[error("the line is flat")]
    FlatLine,
    /// No wave between one in the window and two points.
    #[error("the spectrum is empty")]
    NoWaves,
    /// An autocorrelation that is wider than the window.
    #[error("the autocorrelation does not fall to 0.2 inside the window: it is too small for the texture")]
    NoDecay,
    /// The same along one direction.
    #[error("the autocorrelation does not fall to 0.2 inside the window in every direction, as along feed marks")]
    OpenDecay,
    /// Heights too few or too alike for a parameter.
    #[error("too few neighbouring points were measured")]
    FewNeighbours,
    /// No closed hill or dale.
    #[error("no {what} lies wholly inside the window")]
    NoFeature {
        /// "hill" or "dale".
        what: &'static str,
    },
    /// Fewer than five peaks or pits.
    #[error("only {found} significant {what} lie wholly inside the window, five are needed")]
    FewFeatures {
        /// How many.
        found: usize,
        /// "peaks" or "pits".
        what: &'static str,
    },
    /// A line without a profile element.
    #[error("the line holds no whole profile element")]
    NoElement,
    /// A curve of too few heights.
    #[error("{heights} heights are too few for a material probability curve")]
    ShortProbability {
        /// How many.
        heights: usize,
    },
    /// A curve without plateau and dales.
    #[error("the material probability curve is that of one stratum, no plateau over dales")]
    OneStratum,
    /// Points that do not determine a form.
    #[error("the measured points do not determine the form: use a simpler one")]
    FormUndetermined,
    /// A cylinder whose search does not end.
    #[error(
        "no cylinder fits: after {rounds} rounds the search still goes by {:e} rad and {:e} 1/um, at {} rad and {:e} \
         1/um; take form = \"poly2\"",
        step[0], step[1], at[0], at[1]
    )]
    NoCylinder {
        /// Rounds of the search.
        rounds: usize,
        /// Its last steps of angle, rad, and curvature, 1/um.
        step: [f64; 2],
        /// Where it is, rad and 1/um.
        at: [f64; 2],
    },
    /// A line that is no arc.
    #[error("no arc of a circle fits the line: take a polynomial as its form")]
    NoArc,
    /// An arc whose search does not end.
    #[error("the arc of the line does not settle in {steps} steps: take a polynomial as its form")]
    UnsettledArc {
        /// Steps of the search.
        steps: usize,
    },
    /// Filters in the wrong order.
    #[error("the {short} ({short_um} um) must be shorter than the {long} ({long_um} um)")]
    FiltersCross {
        /// Name of the filter of short waves.
        short: &'static str,
        /// Its nesting index, um.
        short_um: f64,
        /// Name of what bounds it.
        long: &'static str,
        /// Its length, um.
        long_um: f64,
    },
    /// An L-filter beyond the surface.
    #[error(
        "the L-filter ({index_um} um) is longer than the surface ({longest_um:.1} um): ISO 25178-3 wants an area at \
         least as long, and such a filter only takes a plane off; take a shorter one, or none"
    )]
    LongFilter {
        /// Nesting index, um.
        index_um: f64,
        /// Longer side of the surface, um.
        longest_um: f64,
    },
    /// A filter under two points.
    #[error(
        "a filter of {index_um} um on points {spacing_um} um apart: nothing shorter than two points can be told apart"
    )]
    ShortFilter {
        /// Nesting index, um.
        index_um: f64,
        /// Distance of points, um.
        spacing_um: f64,
    },
    /// A robust filter that goes on.
    #[error(
        "the robust filter of {index_um} um does not settle: after {rounds} rounds c = {c_um:e} um still changes by \
         {change:e} of itself; take robust = false, or another nesting index"
    )]
    UnsettledFilter {
        /// Nesting index, um.
        index_um: f64,
        /// Rounds.
        rounds: usize,
        /// Distance from the mean at which weights end, um.
        c_um: f64,
        /// Its last change, as a share.
        change: f64,
    },
    /// No line.
    #[error("there is no line to evaluate")]
    NoLine,
    /// Lines of two spacings.
    #[error("lines of one evaluation must have equal spacing")]
    UnequalSpacing,
    /// A line of few points.
    #[error("a line of {points} points is too short: {fewest} at least are needed")]
    ShortLine {
        /// Its points.
        points: usize,
        /// The fewest that are evaluated.
        fewest: usize,
    },
    /// A line of few measured points.
    #[error("only {points} points of the line were measured, {fewest} are needed")]
    HardlyMeasured {
        /// Measured points.
        points: usize,
        /// The fewest that are evaluated.
        fewest: usize,
    },
    /// A hole that is not bridged.
    #[error(
        "the line has a hole of {points} points, {length_um:.4} um long, {start_um:.4} um from its start, and holes \
         are bridged up to {longest_um:.4} um"
    )]
    LongHole {
        /// Its points.
        points: usize,
        /// Its length, um.
        length_um: f64,
        /// Where it begins, um.
        start_um: f64,
        /// The longest that is bridged, um.
        longest_um: f64,
    },
    /// A cut-off of few points.
    #[error("{cut_off} {fewest}{} at least make a section", if *of_class { "" } else { " points" })]
    ShortCutOff {
        /// The cut-off and the distance of points, in words.
        cut_off: String,
        /// Fewest points of a section.
        fewest: f64,
        /// Whether it is that of a setting class.
        of_class: bool,
    },
    /// Sections that do not fit a line.
    #[error(
        "the line is {} mm long; a cut-off of {cutoff_um} um needs {} mm for {} of {} um and a run-in of {} um at both \
         ends: take a shorter cut-off, less of both, or a longer line",
        short(*length_mm), short(*needed_mm),
        if *sections == 1 { "a section".to_owned() } else { format!("{sections} sections") },
        short(*section_um), short(*run_in_um)
    )]
    NoRoom {
        /// Length of the line, mm.
        length_mm: f64,
        /// Cut-off, um.
        cutoff_um: f64,
        /// Length that is needed, mm.
        needed_mm: f64,
        /// Number of sections.
        sections: usize,
        /// Length of a section, um.
        section_um: f64,
        /// Length of the run-in at either end, um.
        run_in_um: f64,
    },
}

/// Where a rectangle lies.
pub(crate) fn rectangle_words([[x0, x1], [y0, y1]]: &[[f64; 2]; 2]) -> String {
    format!("x {x0} to {x1} um, y {y0} to {y1} um")
}

/// For callers whose errors are sentences.
impl From<TextureError> for String {
    fn from(error: TextureError) -> Self {
        error.to_string()
    }
}

/// What is wrong with a file; the sentence says where in it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FileFault {
    /// It is no file of its kind, or not whole: a header, an entry or heights cannot be understood.
    #[error("{}", text::reason(_0))]
    Malformed(String),
    /// It is whole, but of a form that is not read.
    #[error("{}", text::reason(_0))]
    NotRead(String),
    /// It declares or holds more than is read.
    #[error("{}", text::reason(_0))]
    TooLarge(String),
    /// It does not say what an option has to say: a unit, a spacing.
    #[error("{}", text::reason(_0))]
    Unsaid(String),
    /// What it says and what an option says differ.
    #[error("{}", text::reason(_0))]
    Contradicted(String),
    /// Its heights are no surface that is evaluated.
    #[error(transparent)]
    Surface(#[from] TextureError),
}

impl From<String> for FileFault {
    fn from(sentence: String) -> Self {
        Self::Malformed(sentence)
    }
}

impl From<&str> for FileFault {
    fn from(sentence: &str) -> Self {
        Self::Malformed(sentence.to_owned())
    }
}

/// What can go wrong with a file.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file could not be opened, read or written.
    #[error("{action} {}: {source}", path.display())]
    Io {
        /// What was being done: "cannot read", "cannot write".
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A file that was read is not what it should be.
    #[error("cannot use {}: {fault}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Its format, where that is known.
        format: Option<&'static str>,
        /// What is wrong with it.
        fault: FileFault,
    },
    /// The format cannot hold what should be written.
    #[error("cannot write {}: {fault}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Why not.
        fault: FileFault,
    },
}

impl Error {
    /// Adapter for `map_err`: a read that failed.
    pub(crate) fn reading(path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::Io { action: "cannot read", path, source }
    }
}

/// Result of everything that reads or writes files.
pub type Result<T, E = Error> = std::result::Result<T, E>;
