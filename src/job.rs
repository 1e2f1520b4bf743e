//! What meshes, pictures, maps and texture ask of a job, whatever its process.
//!
//! In: a prepared job. Out: points and normals of the target in space, and what every operation left on a flank
//! ([`GearJob`]); nothing behind this interface knows a tool or a process. What only a cylindrical gear has, a pitch
//! curve and transverse sections, is a trait of its own ([`CylindricalGear`]): its closed body and the page's mesh of
//! its target rest on that, and a process whose gear has neither makes these two itself.

use crate::findings::Notice;
use crate::measure::round_gear::RoundGear;
use crate::scene::Scene;
use crate::scene::model::Gear;
use crate::surface::SurfaceGrid;
use crate::surface::triangles::{SectionProfile, in_space};
use gearcut_core::cut::Backend;
use gearcut_core::dexel::{BlankField, Layer, Ray};
use gearcut_core::error::Result;
use gearcut_core::frame::Rigid2;
use gearcut_core::gear::PitchCurve;
use gearcut_core::gear::blank::Blank;
use gearcut_core::terms::Side;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// How far below the target a ray records cuts, in modules: undercut and wrong linkages stay well inside.
pub const RAY_DEPTH_MODULES: f64 = 0.5;
/// How far above the target a ray can reach, in modules: half a pitch, where the neighbouring tooth begins.
pub const RAY_HEIGHT_MODULES: f64 = 0.5 * PI;
/// Root fields are coarser than flanks, at least so far apart along profile and tooth: roots carry no feed marks that
/// matter.
pub const ROOT_SPACING_MM: [f64; 2] = [0.02, 1.0];
/// Distance of tip rays along profile and tooth, mm.
pub const TIP_SPACING_MM: [f64; 2] = [0.02, 1.0];

/// Takes passes from a blank on a backend.
pub type CutTrial<'a> = dyn Fn(&dyn Backend, BlankField) -> Result<()> + 'a;

/// Passes over the whole blank on which backends are compared.
pub struct TrialBlank<'a> {
    /// The uncut blank.
    pub uncut: BlankField,
    /// Takes the passes from it.
    pub cut: Box<CutTrial<'a>>,
}

/// A job that is ready to cut.
pub trait GearJob: Sync {
    /// The scene.
    fn scene(&self) -> &Scene;

    /// Name of every operation and how far its tool stays back from full depth, mm, in order; the last one finishes.
    fn operations(&self) -> Vec<(&str, f64)>;

    /// Passes of all operations.
    fn passes(&self) -> u32;

    /// When a pass is made, s from the beginning of the first operation: a stroke begins, or a blade points to the
    /// work.
    fn pass_time_s(&self, pass: u32) -> f64;

    /// What of the machine's errors the passes do not follow.
    fn unfollowed_errors(&self) -> Vec<Notice> {
        Vec::new()
    }

    /// Whether marks of an operation follow each other along the tooth and along the profile. Where the axes rest
    /// during strokes a single mark runs along the tooth without end.
    fn marks_follow(&self, operation: usize) -> [bool; 2];

    /// How far marks of the last operation are apart along the profile and along the tooth, mm, where they repeat
    /// evenly: maps average over that much. `None`: over their cells alone.
    fn mark_spacing_mm(&self) -> Option<[f64; 2]> {
        None
    }

    /// Length of a target flank's profile in the middle of the face, mm.
    ///
    /// # Errors
    /// The tool generates no flank there.
    fn profile_length_mm(&self, tooth: u32, side: Side) -> Result<f64>;

    /// Ends of the evaluated part of a profile, arcs from the form point, mm.
    ///
    /// # Errors
    /// The tool generates no flank there.
    fn evaluated_profile_mm(&self, tooth: u32, side: Side) -> Result<[f64; 2]>;

    /// What profiles are inspected over, at arcs from the form point, all mm: the roll, which is where the profile's
    /// contacts lie on the line of action, from the pitch point, positive towards the tip. Over it an involute of
    /// another base circle runs straight. On a round gear it is the roll length of ISO 1328-1 less `r sin(alpha_t)`.
    /// Flanks without a line of action are inspected over their arcs.
    ///
    /// # Errors
    /// The tool generates no flank there.
    fn rolls_mm(&self, _tooth: u32, _side: Side, arcs_mm: &[f64]) -> Result<Vec<f64>> {
        Ok(arcs_mm.to_vec())
    }

    /// Part of the face that is evaluated, mm from its middle: all of it, unless the ends are left out.
    fn evaluated_face_mm(&self) -> [f64; 2] {
        [-0.5, 0.5].map(|share| share * self.scene().gear.face_width_mm)
    }

    /// Teeth between whose flanks marks differ most: where a scene names no window, texture is looked at there.
    fn teeth_that_differ_most(&self) -> Vec<u32>;

    /// Where a tooth stands and which way it looks.
    fn tooth_frame(&self, tooth: u32) -> ToothFrame;

    /// Places along a target flank's profile about `spacing_mm` apart, arcs from the form point, mm, both ends
    /// included.
    ///
    /// # Errors
    /// The tool generates no flank there.
    fn even_arcs_mm(&self, tooth: u32, side: Side, spacing_mm: f64) -> Result<Vec<f64>> {
        let length_mm = self.profile_length_mm(tooth, side)?;
        let intervals = (length_mm / spacing_mm).ceil().max(1.0);
        Ok((0..=intervals as usize).map(|i| length_mm * i as f64 / intervals).collect())
    }

    /// Points and normals of the target flank at the arcs `arcs_mm` from the form point, row after row at the places
    /// `rows_mm` along the tooth.
    ///
    /// # Errors
    /// The tool generates no flank there.
    fn target_points(&self, tooth: u32, side: Side, arcs_mm: &[f64], rows_mm: &[f64]) -> Result<Vec<Vec<Ray>>>;

    /// What every operation left on a part of a flank: arcs from the form point times places along the tooth, mm.
    ///
    /// # Errors
    /// The tool generates no flank there; the backend's.
    fn cut_flank(
        &self,
        backend: &dyn Backend,
        tooth: u32,
        side: Side,
        arcs_mm: &[f64],
        rows_mm: &[f64],
    ) -> Result<Vec<Layer>>;

    /// Some passes over the whole blank, for a backend on trial; none where the blank is cut as flanks are.
    ///
    /// # Errors
    /// A blank that does not fit in memory.
    fn trial_blank(&self) -> Result<Option<TrialBlank<'_>>> {
        Ok(None)
    }

    /// The same job as one of a cylindrical gear, if it is one.
    fn cylindrical(&self) -> Option<&dyn CylindricalGear>;
}

/// A job whose gear is cylindrical: it has a pitch curve, and every row of a flank stands in one transverse section.
pub trait CylindricalGear: GearJob {
    /// The pitch curve.
    fn curve(&self) -> &PitchCurve;

    /// The stock.
    fn blank(&self) -> &Blank;

    /// Sizes of the target if it is a round gear; none for others, and where a flank does not reach the pitch circle.
    ///
    /// # Errors
    /// The tool generates no flank there.
    fn round_gear(&self) -> Result<Option<RoundGear>>;

    /// Places along the tooth at which the target's sections say all of its shape: both ends of the face where it is
    /// straight.
    fn view_rows_z_mm(&self) -> Vec<f64>;

    /// The target flank's profile at the arcs `arcs_mm` from the form point in every section of `rows_z_mm`.
    ///
    /// # Errors
    /// The tool generates no flank there.
    fn target_profiles(
        &self,
        tooth: u32,
        side: Side,
        arcs_mm: &[f64],
        rows_z_mm: &[f64],
    ) -> Result<Vec<SectionProfile>>;

    /// [`GearJob::target_points`] from [`CylindricalGear::target_profiles`].
    ///
    /// # Errors
    /// The tool generates no flank there.
    fn target_in_space(&self, tooth: u32, side: Side, arcs_mm: &[f64], rows_z_mm: &[f64]) -> Result<Vec<Vec<Ray>>> {
        Ok(in_space(&self.target_profiles(tooth, side, arcs_mm, rows_z_mm)?, rows_z_mm))
    }

    /// Root of the space after tooth `space` in every section of `rows_z_mm`, equally many points about `spacing_mm`
    /// apart, between the ends of its flanks.
    ///
    /// # Errors
    /// The tool generates no flank there.
    fn target_roots(&self, space: u32, spacing_mm: f64, rows_z_mm: &[f64]) -> Result<Vec<SectionProfile>>;

    /// The root of the space after tooth `space` after all operations, in every section of `rows_z_mm`: points about
    /// `spacing_mm` apart, from the left flank of that tooth to the right one of the next.
    ///
    /// # Errors
    /// The tool generates no flank there; the backend's.
    fn cut_root(
        &self,
        backend: &dyn Backend,
        space: u32,
        spacing_mm: f64,
        rows_z_mm: &[f64],
    ) -> Result<Vec<Vec<DVec2>>>;

    /// The target round one tooth in the section `z_mm`, points about `spacing_mm` apart.
    ///
    /// # Errors
    /// A flank whose target is not known in closed form.
    fn target_section(&self, tooth: u32, z_mm: f64, spacing_mm: f64) -> Result<ToothSection>;

    /// Edge of the tool, its chords within `chord_mm`.
    fn tool_section(&self, chord_mm: f64) -> ToolSection;

    /// Where [`Self::tool_section`] stands in the gear when it cuts the middle of the face, stroke by stroke through
    /// all operations; none where the tool does not move in transverse sections.
    fn tool_places(&self) -> Vec<Rigid2> {
        Vec::new()
    }

    /// Whether errors of the machine, of the clamping or of a program may let sections along the tooth differ: a lead
    /// error, noise, a cutter that vibrates. Marks that repeat along the tooth are none of it.
    fn errors_vary_along_tooth(&self) -> bool;

    /// Surface of the tip land of a tooth after all operations; `None` on a pointed tooth.
    ///
    /// # Errors
    /// The tool generates no flank there; the backend's.
    fn tip_surface(&self, backend: &dyn Backend, tooth: u32) -> Result<Option<SurfaceGrid>>;
}

/// A tooth and the root behind it in a transverse section, counter-clockwise; gear frame, mm. Ends of flanks, fillets
/// and tip land are points of it.
#[derive(Debug, Clone, PartialEq)]
pub struct ToothSection {
    /// Right flank from its form point, tip land, left flank.
    pub tooth_mm: Vec<DVec2>,
    /// From there to the right flank of the next tooth.
    pub root_mm: Vec<DVec2>,
}

impl ToothSection {
    /// Points of the outline: both ends of the root belong to the flanks, which the fillet meets to rounding alone.
    pub fn outline_mm(&self) -> impl Iterator<Item = DVec2> {
        let root_mm = self.root_mm.get(1..self.root_mm.len().saturating_sub(1)).unwrap_or_default();
        self.tooth_mm.iter().chain(root_mm).copied()
    }
}

/// Outline of a tool.
#[derive(Debug, Clone, PartialEq)]
pub struct ToolSection {
    /// Points, mm.
    pub points_mm: Vec<DVec2>,
    /// Whether the last is joined to the first.
    pub is_closed: bool,
    /// What is drawn, and in which frame.
    pub words: String,
}

/// Where a tooth stands, gear frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothFrame {
    /// Its middle on the pitch surface, mm.
    pub place_mm: DVec3,
    /// Unit direction from root to tip.
    pub front: DVec3,
    /// Unit direction to the left of a viewer who stands before its tip and has `along` upwards: that of its left flank
    /// on an external gear, of its right flank in a ring.
    pub left: DVec3,
    /// Unit direction along the tooth.
    pub along: DVec3,
}

impl ToothFrame {
    /// Frame of a tooth of a cylindrical gear.
    pub fn of_cylinder(blank: &Blank, gear: &Gear, tooth: u32) -> Self {
        let pitch_mm = PI * gear.transverse_module_mm();
        let curve = blank.curve();
        let frame = curve.frame(curve.phi_at_arc(pitch_mm * (f64::from(tooth) - 0.5)));
        Self {
            place_mm: frame.point_mm.extend(0.0),
            front: blank.towards_tip(&frame).extend(0.0),
            left: (blank.kind().tip_sign() * frame.tangent).extend(0.0),
            along: DVec3::Z,
        }
    }
}

/// Teeth of a cylindrical gear with the largest and with the smallest radius of the pitch curve, where its curvature
/// and so the marks differ most.
pub fn teeth_of_extreme_radius(curve: &PitchCurve, teeth: u32) -> Vec<u32> {
    let pitch_mm = curve.perimeter_mm() / f64::from(curve.pitches());
    // Differences below a nanometre are rounding: a circular gear then takes its first tooth.
    let radius_nm = |tooth: u32| {
        let phi = curve.phi_at_arc((f64::from(tooth) - 0.5) * pitch_mm);
        (curve.frame(phi).point_mm.length() * 1e6).round() as i64
    };
    let largest = (1..=teeth).max_by_key(|&tooth| (radius_nm(tooth), std::cmp::Reverse(tooth))).unwrap_or(1);
    let smallest = (1..=teeth).min_by_key(|&tooth| (radius_nm(tooth), tooth)).unwrap_or(1);
    vec![largest, smallest]
}

/// Places evenly over a face of `width_mm` about `spacing_mm` apart, both ends included.
pub fn rows_z_mm(width_mm: f64, spacing_mm: f64) -> Vec<f64> {
    let intervals = (width_mm / spacing_mm).round().max(1.0) as usize;
    (0..=intervals).map(|i| width_mm * (i as f64 / intervals as f64 - 0.5)).collect()
}
