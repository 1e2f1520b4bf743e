//! Surface texture of cut flanks: windows, their heights after an operation, ISO 25178 numbers, files and pictures.
//!
//! In: a [`GearJob`] and a backend. Out: [`WindowTexture`] per window, which goes to `results.json` and
//! into `texture/<operation>/`:
//!
//! | file | what |
//! | --- | --- |
//! | `tooth_03_left.x3p`, `.sdf`, `.npy`, `.csv` | normal deviations, nothing removed |
//! | `tooth_03_left_relief.png` | heights after the chain, lit from the side, exaggeration stated |
//! | `tooth_03_left_abbott.svg` | material ratio curve with the construction of Sk |
//! | `tooth_03_left_first.png` and others | a measured surface over the window (`measured`) |
//!
//! A window has its own dexels, cut for it: places uniform in **arc length** along the profile (y) and along the tooth
//! (x), heights along the target's normals. Its points lie between the rows and columns of the flank's own field, which
//! cannot stand in for them. Equal steps of roll angle would make arcs that grow with the roll, and Sdq, Sdr, Sal and
//! Std wrong with them. The target is subtracted by the dexels themselves; what the F-operator takes off beyond it is
//! named in the chain.

mod chart;
mod files;
mod findings;
mod laid_over;
mod measured;
pub mod quantities;
mod roughness;
mod sampling;
mod traces;
mod window;

pub use files::{NamedWindow, SURFACE_NOTE, named_windows, sheet_file};
pub use findings::{findings, foreseen};
pub use laid_over::Overlaid;
pub use roughness::{roughness, roughness_path};
pub use sampling::{SampledWindow, sampled};
pub use traces::{Direction, Traced, of_surface};
pub use window::{Window, default_teeth, windows};

use crate::findings::Notice;
use crate::findings::notices::{FewMarks, FewPoints, Holes, NoMarks, NotEvaluated};
use crate::interrupt::Interrupt;
use crate::job::{GearJob, RAY_DEPTH_MODULES};
use crate::measure::topography::{Arguments, Evaluation, Surface, TextureError};
use crate::output::folder::OutputFolder;
use crate::progress::Progress;
use gearcut_core::cut::Backend;
use gearcut_core::dexel::{Layer, NO_PASS};
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;
use laid_over::laid_over;
use rayon::prelude::*;
use sampling::{LineMarks, sampled_one};

/// Marks that a window should hold in a direction in which marks follow each other.
pub const ENOUGH_MARKS: usize = 5;

/// Points that each of those marks should have. The one step across a cusp averages both slopes: with N steps per
/// parabolic mark it takes 1/N off Sdq, 5 % here.
pub const ENOUGH_POINTS: f64 = 20.0;

/// Share of the depth that rays record from which on a height is their end: f32 and the last step of a search are far
/// finer.
const ENDS_SHARE: f64 = 0.999;

/// What the operation of a window left in it.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowTexture {
    /// The window.
    pub window: Window,
    /// Normal deviations, um; x along the tooth, y along the profile towards the tip; NaN where no pass
    /// came or a ray ends inside a cut. None where there is no height at all.
    pub heights: Option<Surface>,
    /// Marks that follow each other along the tooth and along the profile: `[x, y]`; 0 along the tooth where the axes
    /// rest during strokes, so that marks run along it without end.
    pub marks: [usize; 2],
    /// Points of a whole mark, mean over those between the first and the last edge; none where there is no whole one.
    pub points_per_mark: [Option<f64>; 2],
    /// What was evaluated, or why nothing could be.
    pub evaluated: Result<Evaluated, TextureError>,
    /// Lines along profile and tooth; none of windows that are cut for their surface alone.
    pub traces: Vec<Traced>,
    /// The measured surface over this one, if the scene names one; none of windows that are cut for their surface
    /// alone.
    pub overlaid: Option<Overlaid>,
}

/// A window after its chain.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluated {
    /// Heights after the chain, um.
    pub surface: Surface,
    /// What was done, step by step.
    pub chain: Vec<String>,
    /// Parameters, curve, core.
    pub evaluation: Evaluation,
}

/// What must be known of a window's numbers; windows that differ in the points of a mark alone are told together.
#[derive(Debug, Clone, PartialEq)]
pub enum WindowNote {
    /// Points without a height.
    Holes(usize),
    /// Nothing could be evaluated: why.
    NotEvaluated(String),
    /// There are no marks.
    NoMarks,
    /// So few marks follow each other.
    FewMarks(usize, &'static str),
    /// A mark has so few points in a direction; the key that makes more of them.
    FewPoints(f64, &'static str, &'static str),
}

impl WindowNote {
    /// Whether it says the same but for the points of a mark.
    pub fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::FewPoints(_, own, _), Self::FewPoints(_, other, _)) => own == other,
            _ => self == other,
        }
    }

    /// What is said of the windows of notes that are like this one, itself among them; `of` names them before the
    /// sentence, if anything does.
    pub fn notice(&self, alike: &[&Self], of: &str) -> Notice {
        match self {
            Self::Holes(holes) => Holes { of, holes }.notice(),
            Self::NotEvaluated(why) => NotEvaluated { of, why }.notice(),
            Self::NoMarks => NoMarks { of }.notice(),
            Self::FewMarks(count, direction) => {
                let marks = if *count == 1 { "1 mark".to_owned() } else { format!("{count} marks") };
                FewMarks { of, marks, direction, enough: ENOUGH_MARKS }.notice()
            }
            Self::FewPoints(_, direction, key) => {
                let all = || {
                    alike
                        .iter()
                        .filter_map(|of| if let Self::FewPoints(points, ..) = of { Some(*points) } else { None })
                };
                let ends = [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)];
                let [low, high] = ends.map(|points| format!("{points:.1}"));
                let points = if low == high { low } else { format!("{low} to {high}") };
                FewPoints { of, direction, points, enough: ENOUGH_POINTS, key }.notice()
            }
        }
    }
}

impl WindowTexture {
    /// What a reader must know before trusting its numbers and only its cut tells.
    fn notes(&self) -> Vec<WindowNote> {
        let mut notes = Vec::new();
        let holes = self.heights.as_ref().map_or(0, Surface::holes);
        if holes > 0 {
            notes.push(WindowNote::Holes(holes));
        }
        if let Err(reason) = &self.evaluated {
            notes.push(WindowNote::NotEvaluated(reason.to_string()));
        }
        notes
    }

    /// All that a reader must know before trusting its numbers, as sentences of this window alone.
    #[cfg(feature = "testing")]
    pub fn warnings(&self) -> Vec<String> {
        let marks = LineMarks { count: self.marks, points: self.points_per_mark };
        marks.notes().iter().chain(&self.notes()).map(|note| note.notice(&[note], "").text).collect()
    }
}

impl LineMarks {
    /// What the marks of a window say of its numbers.
    fn notes(&self) -> Vec<WindowNote> {
        let mut notes = Vec::new();
        if self.count == [0; 2] {
            notes.push(WindowNote::NoMarks);
        }
        for (&marks, direction) in self.count.iter().zip(["along the tooth", "along the profile"]) {
            if (1..ENOUGH_MARKS).contains(&marks) {
                notes.push(WindowNote::FewMarks(marks, direction));
            }
        }
        let spacings = [("along the tooth", "lead_spacing_um"), ("along the profile", "profile_spacing_um")];
        for (points, (direction, key)) in self.points.iter().zip(spacings) {
            if let Some(points) = points.filter(|&points| points < ENOUGH_POINTS) {
                notes.push(WindowNote::FewPoints(points, direction, key));
            }
        }
        notes
    }
}

/// What a reader must know before trusting the numbers of windows, what the drawing's limits say of them, and what is
/// hardly right about surfaces measured there.
pub fn warnings(job: &dyn GearJob, textures: &[WindowTexture]) -> Vec<Notice> {
    let lists = [findings::noted(job, textures), roughness::judged(job, textures), laid_over::doubted(job, textures)];
    lists.concat()
}

/// Writes files and pictures of all windows, and of surfaces measured there; `notes` are the scene and the run record.
///
/// # Errors
/// Files that cannot be written.
pub fn write(
    job: &dyn GearJob,
    textures: &[WindowTexture],
    folder: &OutputFolder,
    notes: &[(String, String)],
) -> Result<()> {
    files::write(job, textures, folder, notes)?;
    laid_over::write(job, textures, folder)
}

/// Cuts and evaluates windows of a job, as from [`sampled()`].
///
/// # Errors
/// Geometry and the backend. After Ctrl-C the windows that are finished are returned.
pub fn measure(
    job: &dyn GearJob,
    windows: &[SampledWindow],
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<Vec<WindowTexture>> {
    let step = progress.step("texture", windows.len() as u64, "windows");
    let textures: Vec<Option<WindowTexture>> = windows
        .par_iter()
        .map(|window| {
            let cut = || -> Result<WindowTexture> {
                let traces = traces::traced(job, backend, &window.window)?;
                let cut = cut_sampled(job, backend, window)?;
                let measured = window.window.measured.as_ref();
                let overlaid = measured.map(|of| laid_over(job, &window.window, of, cut.heights.as_ref()));
                Ok(WindowTexture { traces, overlaid, ..cut })
            };
            let done = if interrupt.is_raised() { Ok(None) } else { cut().map(Some) };
            step.advance(1);
            done
        })
        .collect::<Result<_>>()?;
    step.finish();
    Ok(textures.into_iter().flatten().collect())
}

/// Cuts one window, as finely as its marks ask for, through all operations and evaluates the surface that the one that
/// it shows left.
///
/// # Errors
/// Geometry and the backend.
pub fn cut_window(job: &dyn GearJob, backend: &dyn Backend, window: &Window) -> Result<WindowTexture> {
    cut_sampled(job, backend, &sampled_one(job, window)?)
}

fn cut_sampled(job: &dyn GearJob, backend: &dyn Backend, sampled: &SampledWindow) -> Result<WindowTexture> {
    let SampledWindow { window, marks } = sampled;
    let arcs_mm: Vec<f64> = window.arcs_mm().collect();
    let layers = job.cut_flank(backend, window.tooth, window.side, &arcs_mm, &window.rows_z_mm())?;
    let ([rows, columns], layer) = (window.count, &layers[window.operation]);
    let [dx, dy] = window.spacing_mm().map(|mm| mm * UM_PER_MM);
    let heights = Surface::new(rows, columns, dx, dy, heights_um(job, layer));
    let evaluated = heights.as_ref().map_err(Clone::clone).and_then(|heights| evaluate(heights, window));
    let (marks, points_per_mark) = (marks.count, marks.points);
    Ok(WindowTexture {
        window: window.clone(),
        heights: heights.ok(),
        marks,
        points_per_mark,
        evaluated,
        traces: Vec::new(),
        overlaid: None,
    })
}

/// Heights over the target, um; NaN where there is no surface: where no pass came, and where a ray ends inside a cut (a
/// flank that is gone has no texture).
fn heights_um(job: &dyn GearJob, layer: &Layer) -> Vec<f64> {
    let ends_mm = -ENDS_SHARE * RAY_DEPTH_MODULES * job.scene().gear.module_mm;
    let cut = layer.heights_mm.iter().zip(&layer.passes);
    cut.map(|(&height_mm, &pass)| match f64::from(height_mm) {
        height_mm if pass != NO_PASS && height_mm > ends_mm => height_mm * UM_PER_MM,
        _ => f64::NAN,
    })
    .collect()
}

fn evaluate(heights: &Surface, window: &Window) -> Result<Evaluated, TextureError> {
    let (surface, chain) = window.chain.apply(heights)?;
    let evaluation = Evaluation::of(&surface, &Arguments::default());
    Ok(Evaluated { surface, chain, evaluation })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alike_notes_become_one_with_the_range_of_their_numbers() {
        let note = |points| WindowNote::FewPoints(points, "along the tooth", "lead_spacing_um");
        let (a, b) = (note(3.71), note(4.42));
        assert!(a.is_like(&b) && !a.is_like(&WindowNote::Holes(3)));
        let says = |alike: &[&WindowNote], words: &str| assert!(a.notice(alike, "").text.contains(words), "{words}");
        says(&[&a, &b], "has only 3.7 to 4.4 points;");
        says(&[&a, &note(3.70)], "has only 3.7 points;");
    }
}
