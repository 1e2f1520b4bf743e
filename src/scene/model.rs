//! The checked scene: every value present, in range and in internal units (mm, rad, s).
//!
//! Comes from [`super::load`], goes to the processes. Nothing here knows about TOML, nor what a process has for itself:
//! its folder gets that back from `ScenePart`. Keys of the scene file are the field names with their unit
//! (`face_width_mm`, `pressure_angle_deg`); angles are radians here.

use super::process::ScenePart;
use gearcut_core::error::Refusal;
use gearcut_core::gear::blank::Blank;
use gearcut_core::gear::{GearKind, PitchCurve, PitchCurveShape};
use gearcut_core::terms::{Hand, Side};
use gearcut_texture::Form;
use std::path::PathBuf;
use std::sync::Arc;

/// One job: what is cut, with what, how, and what is measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Name of the scene: the file's stem; the output folder is named after it.
    pub name: String,
    /// The gear to cut.
    pub gear: Gear,
    /// How it is cut: tool, machine and operations of one process.
    pub process: ScenePart,
    /// Where profiles are evaluated.
    pub measure: Measure,
    /// Texture windows; empty: those that `crate::texture` takes by itself.
    pub textures: Vec<TextureWindow>,
    /// Dexel spacing.
    pub fields: Fields,
    /// What is written.
    pub output: Output,
    /// Fields of the printed report.
    pub report: ReportHead,
    /// Pictures to draw.
    pub pictures: Vec<Picture>,
    /// Whether it is a [draft](super::draft): its numbers are rough.
    pub is_draft: bool,
}

/// alpha_t of a pressure angle in the normal section: tan(alpha_t) = tan(alpha_n) / cos(beta).
pub fn transverse_pressure_angle_rad(normal_rad: f64, helix_rad: f64) -> f64 {
    if helix_rad == 0.0 { normal_rad } else { (normal_rad.tan() / helix_rad.cos()).atan() }
}

/// cos(beta_b) of a pressure angle in the normal section: sin(beta_b) = sin(beta) cos(alpha_n).
pub fn base_helix_cosine(normal_rad: f64, helix_rad: f64) -> f64 {
    (1.0 - (helix_rad.sin() * normal_rad.cos()).powi(2)).sqrt()
}

impl Gear {
    /// Transverse module m_t = m / cos(beta): pi m_t of the pitch curve for every tooth.
    pub fn transverse_module_mm(&self) -> f64 {
        self.module_mm / self.helix_angle_rad.cos()
    }

    /// Transverse pressure angle: tan(alpha_t) = tan(alpha) / cos(beta).
    pub fn transverse_pressure_angle_rad(&self) -> f64 {
        transverse_pressure_angle_rad(self.pressure_angle_rad, self.helix_angle_rad)
    }

    /// The transverse section as a spur gear: module and pressure angle are its own, heights stay as they are.
    #[must_use]
    pub fn transverse(&self) -> Self {
        if self.helix_angle_rad == 0.0 {
            return self.clone();
        }
        let cos = self.helix_angle_rad.cos();
        Self {
            module_mm: self.transverse_module_mm(),
            pressure_angle_rad: self.transverse_pressure_angle_rad(),
            helix_angle_rad: 0.0,
            addendum_coefficient: self.addendum_coefficient * cos,
            profile_shift_coefficient: self.profile_shift_coefficient * cos,
            ..self.clone()
        }
    }

    /// cos(beta_b): what is normal to a flank over what is normal to it in the transverse section, for every generated
    /// flank. Along the face the rack moves by tan(beta) along the pitch curve, and the flank by cos(alpha_t) of that.
    pub fn base_helix_cosine(&self) -> f64 {
        base_helix_cosine(self.pressure_angle_rad, self.helix_angle_rad)
    }

    /// How far its teeth stand along the pitch curve at a height, against those in the middle of the face, mm.
    pub fn turned_mm(&self, z_mm: f64) -> f64 {
        self.hand.sign() * self.helix_angle_rad.tan() * z_mm
    }

    /// How far the blank stands over the pitch curve, towards the tips: (h_a + x) m, mm.
    pub fn addendum_mm(&self) -> f64 {
        (self.addendum_coefficient + self.profile_shift_coefficient) * self.module_mm
    }

    /// How much thicker than half a pitch a tooth is meant to be, transverse arc of the pitch curve: 2 x m tan(alpha_t)
    /// and the allowance, mm.
    pub fn extra_thickness_mm(&self) -> f64 {
        let shift_mm = self.profile_shift_coefficient * self.module_mm;
        2.0 * shift_mm * self.transverse_pressure_angle_rad().tan() + self.tooth_thickness_allowance_mm
    }

    /// Radius of the stock where a sector has no teeth, mm; `None` of a gear with teeth all round.
    pub fn dwell_radius_mm(&self, curve: &PitchCurve) -> Option<f64> {
        let lowest_mm = curve.facts().smallest_radius_mm - DWELL_DEPTH_MODULES * self.module_mm;
        curve.sector_rad().map(|_| self.dwell_radius_mm.unwrap_or(lowest_mm))
    }

    /// The stock round its pitch curve.
    ///
    /// # Errors
    /// A pitch curve that is curved more sharply than the addendum allows; a dwell that does not fit a sector.
    pub fn blank(&self, curve: Arc<PitchCurve>) -> Result<Blank, Refusal> {
        let addendum_mm = self.addendum_mm();
        match self.kind {
            GearKind::External => {
                let dwell_radius_mm = self.dwell_radius_mm(&curve);
                let blank = Blank::new(curve, addendum_mm)?.with_bore(0.5 * self.bore_diameter_mm);
                match dwell_radius_mm {
                    Some(radius_mm) => blank.with_dwell(radius_mm),
                    None => Ok(blank),
                }
            }
            GearKind::Internal => Blank::ring(curve, addendum_mm, self.rim_mm),
        }
    }

    /// Refuses a bore that the roots of standard teeth reach where the pitch curve comes nearest to the axis. That of a
    /// sector is held against its dwell.
    ///
    /// # Errors
    /// Such a bore.
    pub fn check_bore(&self, curve: &PitchCurve) -> Result<(), Refusal> {
        let depth_mm = (DEDENDUM_COEFFICIENT - self.profile_shift_coefficient) * self.module_mm;
        let root_mm = 2.0 * (curve.facts().smallest_radius_mm - depth_mm);
        let bore_mm = self.bore_diameter_mm;
        if bore_mm > 0.0 && bore_mm >= root_mm && curve.sector_rad().is_none() {
            return Err(Refusal::new(
                "gear.bore_diameter_mm",
                format!("it reaches the tooth roots, which come down to a diameter of {root_mm:.3} mm"),
                "make the bore smaller, or leave it out",
            ));
        }
        Ok(())
    }
}

impl Scene {
    /// Name of the process that it is for.
    pub fn process_name(&self) -> &'static str {
        self.process.process().name
    }
}

/// Depth of standard teeth below the pitch curve, in modules (ISO 53, profile A).
const DEDENDUM_COEFFICIENT: f64 = 1.25;

/// Depth of a sector's dwell below the smallest radius of its pitch curve, in modules, unless the scene gives its
/// radius: the depth of teeth, 1.25, and as much again for a cutter that rolls out over falling radii.
pub const DWELL_DEPTH_MODULES: f64 = 2.5;

/// The gear: pitch curve, teeth and blank.
#[derive(Debug, Clone, PartialEq)]
pub struct Gear {
    /// External, or a ring with internal teeth.
    pub kind: GearKind,
    /// Module m in mm; on a helical gear the normal module, the tool's own.
    pub module_mm: f64,
    /// Number of teeth z on the pitch curve: all round, or of the sector.
    pub teeth: u32,
    /// Pressure angle alpha of gear and cutter on the pitch curve; on a helical gear in the normal section.
    pub pressure_angle_rad: f64,
    /// Helix angle beta on the pitch curve; 0 for a spur gear.
    pub helix_angle_rad: f64,
    /// Hand of the helix.
    pub hand: Hand,
    /// Face width B.
    pub face_width_mm: f64,
    /// Addendum of the blank over the pitch curve, in modules, without the profile shift.
    pub addendum_coefficient: f64,
    /// Profile shift x, in modules: towards the tips.
    pub profile_shift_coefficient: f64,
    /// Diameter of an external gear's bore; 0 for none.
    pub bore_diameter_mm: f64,
    /// Material of a ring outside the largest radius of its pitch curve; means nothing on external gears.
    pub rim_mm: f64,
    /// Change of tooth thickness on the pitch curve that every operation gets (negative: thinner teeth, backlash).
    pub tooth_thickness_allowance_mm: f64,
    /// Distance of the axes at which a pair with it is rolled; `None`: that of the profile shifts.
    pub center_distance_mm: Option<f64>,
    /// Radius of the stock where a sector has no teeth; `None`: [`DWELL_DEPTH_MODULES`] below its pitch curve.
    pub dwell_radius_mm: Option<f64>,
    /// Shape of the pitch curve.
    pub pitch_curve: PitchCurveShape,
}

/// Where profiles are evaluated, as heights over the pitch curve along its normal, and the limits that the gear must
/// keep.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measure {
    /// Lower end; `None`: the form point, 5 % left out.
    pub profile_start_height_mm: Option<f64>,
    /// Upper end; `None`: the tip, 5 % left out.
    pub profile_end_height_mm: Option<f64>,
    /// Flank tolerance class of ISO 1328-1:2013, of round gears.
    pub iso_1328_class: Option<u32>,
    /// Diameter of balls over which round gears are measured; `None`: the usual one.
    pub ball_diameter_mm: Option<f64>,
    /// What the drawing allows.
    pub limits: DrawnLimits,
}

/// What the drawing of a gear allows its flanks, um; `None` where it says nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DrawnLimits {
    /// F_alpha.
    pub profile_total_um: Option<f64>,
    /// f_f_alpha.
    pub profile_form_um: Option<f64>,
    /// f_H_alpha.
    pub profile_slope_um: Option<f64>,
    /// F_beta.
    pub helix_total_um: Option<f64>,
    /// f_f_beta.
    pub helix_form_um: Option<f64>,
    /// f_H_beta.
    pub helix_slope_um: Option<f64>,
    /// f_p.
    pub single_pitch_um: Option<f64>,
    /// F_p.
    pub total_pitch_um: Option<f64>,
    /// F_r.
    pub runout_um: Option<f64>,
    /// Ra of lines on flanks.
    pub ra_um: Option<f64>,
    /// Rz of lines on flanks.
    pub rz_um: Option<f64>,
}

impl Measure {
    /// Arcs of a flank's profile at both ends, mm, where `arc_at` finds a height; `None` where the scene names no
    /// height, or the flank does not reach it.
    pub fn ends_mm(&self, arc_at: impl Fn(f64) -> Option<f64>) -> [Option<f64>; 2] {
        self.heights_mm().map(|height_mm| height_mm.and_then(&arc_at))
    }

    /// Heights of both ends, mm.
    pub fn heights_mm(&self) -> [Option<f64>; 2] {
        [self.profile_start_height_mm, self.profile_end_height_mm]
    }
}

/// A window on the flanks of one tooth whose texture is evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureWindow {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Which of its flanks.
    pub sides: WindowSides,
    /// Name of the operation after which it is looked at; `None`: the last one.
    pub operation: Option<String>,
    /// Middle along the profile, mm from the form point; `None`: the middle of the evaluated profile.
    pub center_profile_mm: Option<f64>,
    /// Middle along the tooth, mm from the middle of the face.
    pub center_lead_mm: f64,
    /// Length along the profile; `None`: the evaluated profile.
    pub length_profile_mm: Option<f64>,
    /// Length along the tooth; `None`: the whole face.
    pub length_lead_mm: Option<f64>,
    /// Distance of points along the profile; `None`: that of the flank field.
    pub profile_spacing_mm: Option<f64>,
    /// Distance of points along the tooth; `None`: a fiftieth of the length, at least that of the flank field.
    pub lead_spacing_mm: Option<f64>,
    /// F-operator.
    pub form: Form,
    /// What follows it.
    pub filters: TextureFilters,
    /// Surface that was measured there.
    pub measured: Option<PathBuf>,
}

/// Filters of a window's surface and of the lines across it; um, `None`: no filter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TextureFilters {
    /// Areal S-filter.
    pub s_filter_um: Option<f64>,
    /// Areal L-filter.
    pub l_filter_um: Option<f64>,
    /// L-filter and cut-off are robust ones.
    pub robust: bool,
    /// Cut-off of lines; `None`: by ISO 21920-3.
    pub cutoff_um: Option<f64>,
}

/// Flanks that a window lies on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WindowSides {
    /// The left one.
    Left,
    /// The right one.
    Right,
    /// Both, one after the other.
    Both,
}

/// Dexel spacing of the fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fields {
    /// Along the profile of the flank.
    pub profile_spacing_mm: f64,
    /// Along the tooth.
    pub lead_spacing_mm: f64,
    /// Of the rays through the whole blank.
    pub blank_spacing_mm: f64,
    /// Of the blank's slices, where sections differ along the tooth.
    pub blank_slice_spacing_mm: f64,
}

/// What is written and how finely.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// Spacing of maps.
    pub map_spacing_mm: f64,
    /// Spacing of vertices on meshes.
    pub mesh_spacing_mm: f64,
    /// Whether every flank is drawn by itself, and not only those that are looked at.
    pub draws_all_flanks: bool,
    /// Folder given in the scene, if any; the command line wins.
    pub folder: Option<PathBuf>,
    /// Largest displacement on the flanks that straight lines of axis programs may cause.
    pub gcode_contour_error_mm: f64,
    /// Control for which axis programs are written.
    pub post: Post,
}

/// The head of the printed report; what is left out is an empty field.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ReportHead {
    /// Name of the part; the scene's where left out.
    pub part: Option<String>,
    /// Number of the drawing.
    pub drawing: Option<String>,
    /// For whom the gear is.
    pub customer: Option<String>,
    /// Date as it is printed.
    pub date: Option<String>,
    /// Whether the paper is US Letter, and not A4.
    pub us_letter: bool,
}

/// The control that reads an axis program; `crate::gcode` has what each expects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Post {
    /// None in particular: the dialect that gearcut itself reads.
    Plain,
    /// LinuxCNC.
    LinuxCnc,
    /// SINUMERIK in Siemens mode.
    Siemens,
    /// FANUC with the G-codes of machining centres.
    Fanuc,
}

/// One picture of the cut gear.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Name of its files, unique in the scene.
    pub name: String,
    /// What is shown.
    pub view: PictureView,
    /// Tooth, from 1; for the views tooth and flank.
    pub tooth: u32,
    /// Flank; for the view flank.
    pub side: Side,
    /// What colours show.
    pub colour: PictureColour,
    /// Where the viewer stands: counter-clockwise from phi = 0, from the tooth's direction, or from the root of a
    /// rolled-out flank.
    pub azimuth_rad: f64,
    /// How high over the transverse plane, or over the rolled-out flank.
    pub elevation_rad: f64,
    /// Width of the picture at the object; `None`: what the view shows by itself.
    pub extent_mm: Option<f64>,
    /// Factor on the heights of a flank; `None`: chosen from the heights.
    pub exaggeration: Option<f64>,
    /// Width and height without title and legend.
    pub size_px: (u32, u32),
    /// Write the values behind the pixels as EXR.
    pub exr: bool,
}

/// What a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureView {
    /// The whole gear.
    Gear,
    /// A tooth with its neighbours.
    Tooth,
    /// A flank rolled out flat, heights exaggerated, under raking light.
    Flank,
}

/// What the colours of a picture show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureColour {
    /// Normal stock that the last operation found.
    Stock,
    /// Normal deviation from the target.
    Height,
    /// Pass that left the surface.
    Pass,
    /// Nothing.
    Clay,
}
