//! Surface texture of cut flanks: windows, their heights after every operation, ISO 25178 numbers, files and pictures.
//!
//! In: a [`GearJob`] and a backend. Out: [`WindowTexture`] per window and operation, which goes to `results.json` and
//! into `texture/<operation>/`:
//!
//! | file | what |
//! | --- | --- |
//! | `tooth_03_left.x3p`, `.sdf`, `.npy`, `.csv` | normal deviations, nothing removed |
//! | `tooth_03_left_relief.png` | heights after the chain, lit from the side, exaggeration stated |
//! | `tooth_03_left_abbott.svg` | material ratio curve with the construction of Sk |
//!
//! A window has its own dexels, cut for it: places uniform in **arc length** along the profile (y) and along the tooth
//! (x), heights along the target's normals. Its points lie between the rows and columns of the flank's own field, which
//! cannot stand in for them. Equal steps of roll angle would make arcs that grow with the roll, and Sdq, Sdr, Sal and
//! Std wrong with them. The target is subtracted by the dexels themselves; what the F-operator takes off beyond it is
//! named in the chain.

mod chart;
mod files;
mod findings;
mod window;

pub use files::write;
pub use findings::{findings, quantities, warnings};
pub use window::{Window, windows};

use crate::interrupt::Interrupt;
use crate::job::{GearJob, RAY_DEPTH_MODULES};
use crate::measure::topography::{Arguments, Chain, Evaluation, Surface};
use crate::output::progress::Progress;
use gearcut_core::cut::Backend;
use gearcut_core::dexel::NO_PASS;
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;
use rayon::prelude::*;

/// Marks that a window should hold in a direction in which marks follow each other.
pub const ENOUGH_MARKS: usize = 5;

/// Points that each of those marks should have. The one step across a cusp averages both slopes: with N steps per
/// parabolic mark it takes 1/N off Sdq, 5 % here.
pub const ENOUGH_POINTS: f64 = 20.0;

/// Share of the depth that rays record from which on a height is their end: f32 and the last step of a search are far
/// finer.
const ENDS_SHARE: f64 = 0.999;

/// What one operation left in one window.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowTexture {
    /// The window.
    pub window: Window,
    /// Index of the operation.
    pub operation: usize,
    /// Normal deviations, um; x along the tooth, y along the profile towards the tip; NaN where no pass
    /// came or a ray ends inside a cut. None where there is no height at all.
    pub heights: Option<Surface>,
    /// Marks that follow each other along the tooth and along the profile: `[x, y]`; 0 along the tooth where the axes
    /// rest during strokes, so that marks run along it without end.
    pub marks: [usize; 2],
    /// What was evaluated, or why nothing could be.
    pub evaluated: Result<Evaluated, String>,
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

impl WindowTexture {
    /// What a reader must know before trusting its numbers.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        for (marks, direction) in self.marks.iter().zip(["along the tooth", "along the profile"]) {
            if (1..ENOUGH_MARKS).contains(marks) {
                let marks = if *marks == 1 { "1 mark".to_owned() } else { format!("{marks} marks") };
                warnings.push(format!(
                    "the window holds only {marks} {direction}; {ENOUGH_MARKS} at least make its numbers representative"
                ));
            }
        }
        let spacings = [("along the tooth", "lead_spacing_um"), ("along the profile", "profile_spacing_um")];
        for ((marks, count), (direction, key)) in self.marks.iter().zip(self.window.count).zip(spacings) {
            // Parts of marks at both ends make the points of few marks look fewer than they are.
            let points = count as f64 / *marks as f64;
            if *marks >= ENOUGH_MARKS && points < ENOUGH_POINTS {
                warnings.push(format!(
                    "a mark {direction} has only {points:.1} points; \
                     with less than {ENOUGH_POINTS} slopes are averaged over cusps, \
                     and Sdq and Sdr come out low: make {key} smaller"
                ));
            }
        }
        let holes = self.heights.as_ref().map_or(0, Surface::holes);
        if holes > 0 {
            warnings.push(format!("{holes} points of the window are holes: no pass reached them, or they are cut deeper than their rays record"));
        }
        if let Err(reason) = &self.evaluated {
            warnings.push(format!("the window could not be evaluated: {reason}"));
        }
        warnings
    }
}

/// Cuts and evaluates windows of a job, as from [`windows()`].
///
/// # Errors
/// Geometry and the backend. After Ctrl-C the windows that are finished are returned.
pub fn measure(
    job: &dyn GearJob,
    windows: &[Window],
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<Vec<WindowTexture>> {
    let step = progress.step("texture", windows.len() as u64, "windows");
    let textures: Vec<Vec<WindowTexture>> = windows
        .par_iter()
        .map(|window| {
            let done = if interrupt.is_raised() { Ok(Vec::new()) } else { cut_window(job, backend, window) };
            step.advance(1);
            done
        })
        .collect::<Result<_>>()?;
    step.finish();
    Ok(textures.concat())
}

/// Cuts one window through all operations and evaluates what each of them left, or the last alone.
///
/// # Errors
/// Geometry and the backend.
pub fn cut_window(job: &dyn GearJob, backend: &dyn Backend, window: &Window) -> Result<Vec<WindowTexture>> {
    let (arcs_mm, rows_z_mm): (Vec<f64>, Vec<f64>) = (window.arcs_mm().collect(), window.rows_z_mm());
    let (columns, rows) = (arcs_mm.len(), rows_z_mm.len());
    let layers = job.cut_flank(backend, window.tooth, window.side, &arcs_mm, &rows_z_mm)?;
    let first = if window.every_operation { 0 } else { layers.len() - 1 };
    Ok(layers
        .iter()
        .enumerate()
        .skip(first)
        .map(|(operation, layer)| {
            // Where a ray ends inside a cut, its end is no surface: a flank that is gone has no texture.
            let ends_mm = -ENDS_SHARE * RAY_DEPTH_MODULES * job.scene().gear.module_mm;
            let height = |i: usize| {
                let height_mm = f64::from(layer.heights_mm[i]);
                let is_surface = layer.passes[i] != NO_PASS && height_mm > ends_mm;
                if is_surface { height_mm * UM_PER_MM } else { f64::NAN }
            };
            let heights_um: Vec<f64> = (0..columns * rows).map(height).collect();
            let [dx, dy] = window.spacing_mm().map(|mm| mm * UM_PER_MM);
            let heights = Surface::new(rows, columns, dx, dy, heights_um);
            let along_tooth = if job.marks_follow_along_tooth(operation) {
                facets(&layer.passes[columns / 2 * rows..(columns / 2 + 1) * rows])
            } else {
                0
            };
            let along_profile = facets(&layer.passes.iter().skip(rows / 2).step_by(rows).copied().collect::<Vec<_>>());
            let marks = [along_tooth, along_profile];
            let evaluated = heights.as_ref().map_err(Clone::clone).and_then(|heights| evaluate(heights, window));
            WindowTexture { window: window.clone(), operation, heights: heights.ok(), marks, evaluated }
        })
        .collect())
}

/// Facets along a line: one more than the changes of the pass that left it.
fn facets(passes: &[u32]) -> usize {
    passes.windows(2).filter(|pair| pair[0] != pair[1]).count() + 1
}

fn evaluate(heights: &Surface, window: &Window) -> Result<Evaluated, String> {
    let (surface, chain) = Chain::of_form(window.form).apply(heights)?;
    let evaluation = Evaluation::of(&surface, &Arguments::default());
    Ok(Evaluated { surface, chain, evaluation })
}
