//! Where texture is looked at: the scene's windows, or those that every gear gets.
//!
//! Without a `[[texture]]` in the scene, the whole active flanks (the evaluated profile over the whole face) of some
//! teeth are taken: those between which the marks differ most (on a cylindrical gear the ones with the largest and the
//! smallest radius of the pitch curve), and tooth 3, which Gao et al. (2017, Fig. 13) measured. Windows show the
//! finished surface: what roughing leaves there is its fillet and its feed, not a texture that anybody measures. A
//! window of a scene that names another operation shows that one.

use super::measured::MeasuredSurface;
use crate::job::GearJob;
use crate::measure::topography::{Chain, Form};
use crate::output::surface_files::MOST_POINTS;
use crate::scene::model::{TextureFilters, TextureWindow, WindowSides};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use std::sync::Arc;

/// Tooth that the paper measured.
const PAPER_TOOTH: u32 = 3;
/// Points along the tooth of a window that does not say otherwise.
const LEAD_POINTS: f64 = 50.0;

/// A window on one flank, resolved.
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Flank.
    pub side: Side,
    /// First point: along the tooth from the middle of the face, and along the profile from the form point, mm.
    pub start_mm: [f64; 2],
    /// Distance of points along the tooth and along the profile, mm.
    step_mm: [f64; 2],
    /// Points along the tooth and along the profile.
    pub count: [usize; 2],
    /// What it spans along the tooth and along the profile, mm.
    span_mm: [[f64; 2]; 2],
    /// Whether the scene leaves the distance of points along the tooth and along the profile open.
    pub(super) open_step: [bool; 2],
    /// Whether it leaves the length along the tooth and along the profile open.
    open_span: [bool; 2],
    /// F-operator and areal filters.
    pub chain: Chain,
    /// Cut-off of lines, um; none: by ISO 21920-3.
    pub cutoff_um: Option<f64>,
    /// Index of the operation that left what it shows.
    pub operation: usize,
    /// Surface that was measured there.
    pub measured: Option<Arc<MeasuredSurface>>,
}

impl Window {
    /// Places along the profile, mm from the form point.
    pub fn arcs_mm(&self) -> impl Iterator<Item = f64> {
        let (start, step) = (self.start_mm[1], self.step_mm[1]);
        (0..self.count[1]).map(move |i| start + step * i as f64)
    }

    /// Places along the tooth, mm from the middle of the face.
    pub fn rows_z_mm(&self) -> Vec<f64> {
        (0..self.count[0]).map(|i| self.start_mm[0] + self.step_mm[0] * i as f64).collect()
    }

    /// The same window with its points so far apart in one direction, along the tooth (0) or along the profile (1).
    pub(super) fn with_step(&self, direction: usize, step_mm: f64) -> Self {
        let mut finer = self.clone();
        finer.step_mm[direction] = step_mm;
        finer.lay();
        finer
    }

    /// The same window, shorter about its middle where the scene leaves that open, so that it has at most so many
    /// points if it can; both directions by the same factor.
    pub(super) fn narrowed(&self, most_points: usize) -> Self {
        let points = (self.count[0] * self.count[1]) as f64;
        let open = self.open_span.iter().filter(|&&open| open).count();
        let mut narrower = self.clone();
        if points > most_points as f64 && open > 0 {
            let share = (most_points as f64 / points).powf(1.0 / open as f64);
            for (span, _) in narrower.span_mm.iter_mut().zip(self.open_span).filter(|(_, open)| *open) {
                let (middle, half) = (0.5 * (span[0] + span[1]), 0.5 * share * (span[1] - span[0]));
                *span = [middle - half, middle + half];
            }
            narrower.lay();
        }
        narrower
    }

    /// Lays the points over what it spans. What is left over of the last step is shared by both ends.
    fn lay(&mut self) {
        for (direction, [low, high]) in self.span_mm.into_iter().enumerate() {
            let (length_mm, step_mm) = (high - low, self.step_mm[direction]);
            // Half a millionth of a step more: lengths that hold whole steps shall not lose the last by rounding.
            let steps = (length_mm / step_mm + 5e-7).floor();
            self.count[direction] = steps as usize + 1;
            self.start_mm[direction] = low + 0.5 * (length_mm - step_mm * steps);
        }
        self.start_mm[1] = self.start_mm[1].max(0.0);
    }

    /// Distance of points along the tooth and along the profile, mm.
    pub fn spacing_mm(&self) -> [f64; 2] {
        self.step_mm
    }

    /// Length along the tooth and along the profile, from the first to the last point, mm.
    pub fn length_mm(&self) -> [f64; 2] {
        std::array::from_fn(|k| self.step_mm[k] * (self.count[k] - 1) as f64)
    }

    /// Middle, mm: along the tooth, along the profile.
    pub fn center_mm(&self) -> [f64; 2] {
        let length = self.length_mm();
        std::array::from_fn(|k| self.start_mm[k] + 0.5 * length[k])
    }
}

/// All windows of a job.
///
/// # Errors
/// A tooth that the gear does not have, a window that does not lie on its flank, or one with too few or too many
/// points, and a measured surface that cannot be read.
pub fn windows(job: &dyn GearJob) -> Result<Vec<Window>> {
    let asked = if job.scene().textures.is_empty() { default_windows(job) } else { job.scene().textures.clone() };
    let mut windows = Vec::new();
    for (index, spec) in asked.iter().enumerate() {
        let measured = MeasuredSurface::of(index, spec)?;
        let sides = match spec.sides {
            WindowSides::Left => &[Side::Left][..],
            WindowSides::Right => &[Side::Right],
            WindowSides::Both => &[Side::Left, Side::Right],
        };
        for &side in sides {
            windows.push(Window { measured: measured.clone(), ..resolve(job, index, spec, side)? });
        }
    }
    Ok(windows)
}

/// Teeth that have windows where the scene names none: none where no marks stay on flanks.
pub fn default_teeth(job: &dyn GearJob) -> Vec<u32> {
    if job.marks_follow(job.operations().len() - 1) == [false; 2] {
        return Vec::new();
    }
    let mut chosen = job.teeth_that_differ_most();
    chosen.push(PAPER_TOOTH.min(job.scene().gear.teeth));
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

fn default_windows(job: &dyn GearJob) -> Vec<TextureWindow> {
    let window = |tooth| TextureWindow {
        tooth,
        sides: WindowSides::Both,
        operation: None,
        center_profile_mm: None,
        center_lead_mm: 0.0,
        length_profile_mm: None,
        length_lead_mm: None,
        profile_spacing_mm: None,
        lead_spacing_mm: None,
        form: Form::Poly2,
        filters: TextureFilters::default(),
        measured: None,
    };
    default_teeth(job).into_iter().map(window).collect()
}

fn resolve(job: &dyn GearJob, index: usize, spec: &TextureWindow, side: Side) -> Result<Window> {
    let teeth = job.scene().gear.teeth;
    let refuse = |name: &str, problem: String, way_out: &str| {
        Err(Refusal::new(&format!("texture[{index}].{name}"), problem, way_out).into())
    };
    if spec.tooth > teeth {
        return refuse("tooth", format!("the gear has {teeth} teeth"), "name a tooth that the gear has");
    }
    let operations = job.operations();
    let operation = match &spec.operation {
        None => operations.len() - 1,
        Some(asked) => match operations.iter().position(|(name, _)| name == asked) {
            Some(operation) => operation,
            None => {
                let names = operations.iter().map(|(name, _)| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
                return refuse(
                    "operation",
                    format!("no operation is named \"{asked}\"; there are {names}"),
                    "name one of them, or leave the key out for the last one",
                );
            }
        },
    };
    let flank_mm = job.profile_length_mm(spec.tooth, side)?;
    let [form_mm, tip_mm] = job.evaluated_profile_mm(spec.tooth, side)?;
    let face_mm = job.scene().gear.face_width_mm;
    let [back_mm, front_mm] = job.evaluated_face_mm();
    let fields = job.scene().fields;

    let span = |center: f64, length: Option<f64>, low: f64, high: f64| {
        length.map_or([low, high], |length| [center - 0.5 * length, center + 0.5 * length])
    };
    let middle_mm = spec.center_profile_mm.unwrap_or(0.5 * (form_mm + tip_mm));
    let profile = span(middle_mm, spec.length_profile_mm, form_mm, tip_mm);
    let along_tooth = span(spec.center_lead_mm, spec.length_lead_mm, back_mm, front_mm);
    let where_ = format!("tooth {} {}", spec.tooth, side.name());
    if profile[0] < -1e-9 || profile[1] > flank_mm + 1e-9 {
        return refuse(
            "length_profile_mm",
            format!(
                "the window from {:.3} to {:.3} mm does not lie on {where_}, whose flank is {flank_mm:.3} mm long",
                profile[0], profile[1]
            ),
            "make the window shorter, or move its center_profile_mm",
        );
    }
    if along_tooth[0] < -0.5 * face_mm - 1e-9 || along_tooth[1] > 0.5 * face_mm + 1e-9 {
        return refuse(
            "length_lead_mm",
            format!(
                "the window from {:.3} to {:.3} mm does not lie on the face, which ends at +-{:.3} mm",
                along_tooth[0],
                along_tooth[1],
                0.5 * face_mm
            ),
            "make the window shorter, or move its center_lead_mm",
        );
    }
    let length = [along_tooth[1] - along_tooth[0], profile[1] - profile[0]];
    // A field coarser than the window still gives two rows of points.
    let step_mm = [
        spec.lead_spacing_mm.unwrap_or((length[0] / LEAD_POINTS).max(fields.lead_spacing_mm).min(length[0])),
        spec.profile_spacing_mm.unwrap_or(fields.profile_spacing_mm.min(length[1])),
    ];
    let mut window = Window {
        tooth: spec.tooth,
        side,
        start_mm: [0.0; 2],
        step_mm,
        count: [0; 2],
        span_mm: [along_tooth, profile],
        open_step: [spec.lead_spacing_mm.is_none(), spec.profile_spacing_mm.is_none()],
        open_span: [spec.length_lead_mm.is_none(), spec.length_profile_mm.is_none()],
        chain: Chain {
            s_filter_um: spec.filters.s_filter_um,
            l_filter_um: spec.filters.l_filter_um,
            robust: spec.filters.robust,
            ..Chain::of_form(spec.form)
        },
        cutoff_um: spec.filters.cutoff_um,
        operation,
        measured: None,
    };
    window.lay();
    if let Some(l_um) = spec.filters.l_filter_um {
        let longest_um = UM_PER_MM * length[0].max(length[1]);
        if l_um > longest_um {
            return refuse(
                "l_filter_um",
                format!("{l_um} um is longer than the window on {where_}, which is {longest_um:.1} um long at most"),
                "use a shorter L-filter or a longer window",
            );
        }
        if let Some(s_um) = spec.filters.s_filter_um.filter(|s_um| *s_um >= l_um) {
            return refuse("s_filter_um", format!("{s_um} um is not below l_filter_um, {l_um} um"), "make it shorter");
        }
    } else if spec.filters.robust {
        return refuse("robust", "there is no L-filter that it could be of".to_owned(), "give l_filter_um as well");
    }
    let count = window.count;
    for (k, name) in ["lead_spacing_um", "profile_spacing_um"].into_iter().enumerate() {
        if count[k] < 2 {
            return refuse(
                name,
                format!("the window on {where_} has a single row of points"),
                "use a smaller spacing or a longer window",
            );
        }
        // Its files can be read again.
        if (count[0] as f64) * (count[1] as f64) > MOST_POINTS as f64 {
            return refuse(
                name,
                format!(
                    "the window on {where_} has {} x {} points, more than {} million",
                    count[0],
                    count[1],
                    MOST_POINTS / 1_000_000
                ),
                "use a wider spacing or a smaller window",
            );
        }
    }
    Ok(window)
}
