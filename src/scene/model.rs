//! The checked scene: every value present, in range and in internal units (mm, rad, s).
//!
//! Comes from [`super::load`], goes to `run`. Nothing here knows about TOML. Keys of the scene file
//! are the field names with their unit (`face_width_mm`, `pressure_angle_deg`); angles are radians here.

mod hobbing;

pub use hobbing::{
    Approach, EvenMotion, ExtraRotation, FeedDirection, FeedOf, GashForm, Hob, HobSize, Hobbing, HobbingAxisLimits,
    HobbingKind, HobbingOperation, LinkageForm, Protuberance, ShiftDirection, ShiftStrategy, Worm,
};

use crate::gear::PitchCurveShape;
use crate::terms::{Hand, Side};
use gearcut_texture::Form;
use std::path::PathBuf;

use crate::material::EdgeForce;

/// One job: what is cut, with what, how, and what is measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Name of the scene: the file's stem; the output folder is named after it.
    pub name: String,
    /// The gear to cut.
    pub gear: Gear,
    /// How it is cut: tool, machine and operations of one process.
    pub process: Process,
    /// Texture windows; empty: those that [`crate::texture`] takes by itself.
    pub textures: Vec<TextureWindow>,
    /// Dexel spacing.
    pub fields: Fields,
    /// What is written.
    pub output: Output,
    /// Pictures to draw.
    pub pictures: Vec<Picture>,
}

/// A process with all that is its own.
#[derive(Debug, Clone, PartialEq)]
pub enum Process {
    /// Shaping with a pinion cutter.
    Shaping(Shaping),
    /// Hobbing.
    Hobbing(Hobbing),
}

/// Shaping: tool, machine and operations.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaping {
    /// The shaper cutter.
    pub tool: ShaperCutter,
    /// The machine: stroke, clearances, mounting errors, axis limits.
    pub machine: Machine,
    /// Operations in the order they are cut; at least one. The last one defines the target flank.
    pub operations: Vec<Operation>,
    /// Force coefficients of the work's material.
    pub material: EdgeForce,
    /// Distance of the rays on which chips are followed, mm.
    pub chip_spacing_mm: f64,
    /// Where profiles are evaluated.
    pub measure: Measure,
}

impl Gear {
    /// Transverse module m_t = m / cos(beta): pi m_t of the pitch curve for every tooth.
    pub fn transverse_module_mm(&self) -> f64 {
        self.module_mm / self.helix_angle_rad.cos()
    }

    /// Transverse pressure angle: tan(alpha_t) = tan(alpha) / cos(beta).
    pub fn transverse_pressure_angle_rad(&self) -> f64 {
        (self.pressure_angle_rad.tan() / self.helix_angle_rad.cos()).atan()
    }
}

impl Scene {
    /// The shaping part, if the scene shapes.
    pub fn shaping(&self) -> Option<&Shaping> {
        if let Process::Shaping(shaping) = &self.process { Some(shaping) } else { None }
    }

    /// The shaping part, to try other values.
    pub fn shaping_mut(&mut self) -> Option<&mut Shaping> {
        if let Process::Shaping(shaping) = &mut self.process { Some(shaping) } else { None }
    }

    /// The hobbing part, if the scene hobs.
    pub fn hobbing(&self) -> Option<&Hobbing> {
        if let Process::Hobbing(hobbing) = &self.process { Some(hobbing) } else { None }
    }

    /// Name of the process that it is for.
    pub fn process_name(&self) -> &'static str {
        match &self.process {
            Process::Shaping(_) => "shaping",
            Process::Hobbing(_) => "hobbing",
        }
    }

    /// Names of the operations in order.
    pub fn operation_names(&self) -> Vec<&str> {
        match &self.process {
            Process::Shaping(shaping) => shaping.operations.iter().map(|o| o.name.as_str()).collect(),
            Process::Hobbing(hobbing) => hobbing.operations.iter().map(|o| o.name.as_str()).collect(),
        }
    }
}

/// The gear: pitch curve, teeth and blank.
#[derive(Debug, Clone, PartialEq)]
pub struct Gear {
    /// Module m in mm; on a helical gear the normal module, the tool's own.
    pub module_mm: f64,
    /// Number of teeth z on the closed pitch curve.
    pub teeth: u32,
    /// Pressure angle alpha of gear and cutter on the pitch curve; on a helical gear in the normal section.
    pub pressure_angle_rad: f64,
    /// Helix angle beta on the pitch curve; 0 for a spur gear.
    pub helix_angle_rad: f64,
    /// Hand of the helix.
    pub hand: Hand,
    /// Face width B.
    pub face_width_mm: f64,
    /// Addendum of the blank over the pitch curve, in modules.
    pub addendum_coefficient: f64,
    /// Diameter of the bore; pictures and meshes use it.
    pub bore_diameter_mm: f64,
    /// Change of tooth thickness on the pitch curve that every operation gets (negative: thinner teeth, backlash).
    pub tooth_thickness_allowance_mm: f64,
    /// Shape of the pitch curve.
    pub pitch_curve: PitchCurveShape,
}

/// Shaper cutter by its projected transverse profile.
#[derive(Debug, Clone, PartialEq)]
pub struct ShaperCutter {
    /// z0.
    pub teeth: u32,
    /// Addendum in modules (1.25 cuts the gear's root clearance).
    pub addendum_coefficient: f64,
    /// Dedendum in modules.
    pub dedendum_coefficient: f64,
    /// Profile shift x0 in modules.
    pub profile_shift_coefficient: f64,
    /// Tooth thickness taken off on the pitch circle.
    pub thinning_mm: f64,
    /// Shape of the tip corners.
    pub tip: Tip,
    /// Top rake of its conical rake face, rad; for forces alone.
    pub rake_angle_rad: f64,
    /// Distance of the cutter's profile axis from its spindle axis.
    pub runout_mm: f64,
    /// Direction of the runout in the cutter frame, from cutter tooth 0.
    pub runout_angle_rad: f64,
    /// Cumulative pitch error of each cutter tooth on the pitch circle, mm, positive counter-clockwise; empty or one
    /// value per tooth.
    pub pitch_errors_mm: Vec<f64>,
}

/// Tip corners of the cutter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tip {
    /// Sharp corners.
    Sharp,
    /// Round of this radius, tangent to flank and tip circle.
    Round {
        /// Radius of the round.
        radius_mm: f64,
    },
    /// Straight chamfer between flank and tip circle.
    Chamfer {
        /// Radial height below the tip circle where the chamfer leaves the flank.
        height_mm: f64,
        /// Angle of the chamfer against the tooth centre line.
        angle_rad: f64,
    },
}

/// The machine around the cut.
#[derive(Debug, Clone, PartialEq)]
pub struct Machine {
    /// Ram speed: double strokes per minute.
    pub double_strokes_per_minute: f64,
    /// Ram travel above the face before the cut.
    pub approach_mm: f64,
    /// Ram travel below the face after the cut.
    pub overrun_mm: f64,
    /// Back-off along the centre line during the return stroke.
    pub back_off_mm: f64,
    /// Distance of the gear axis from the work spindle axis.
    pub work_eccentricity_mm: f64,
    /// Direction of the eccentricity in the gear frame.
    pub work_eccentricity_angle_rad: f64,
    /// Limits of the axes, where known.
    pub limits: AxisLimits,
}

/// Largest speeds and accelerations the axes allow; `None`: not limited.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisLimits {
    /// Work spindle, rad/s.
    pub work_speed_rad_per_s: Option<f64>,
    /// Cutter spindle, rad/s.
    pub cutter_speed_rad_per_s: Option<f64>,
    /// Centre distance, mm/s.
    pub center_distance_speed_mm_per_s: Option<f64>,
    /// Work spindle, rad/s^2.
    pub work_acceleration_rad_per_s2: Option<f64>,
    /// Cutter spindle, rad/s^2.
    pub cutter_acceleration_rad_per_s2: Option<f64>,
    /// Centre distance, mm/s^2.
    pub center_distance_acceleration_mm_per_s2: Option<f64>,
}

/// One run of a linkage over the work.
#[derive(Debug, Clone, PartialEq)]
pub struct Operation {
    /// Name, unique in the scene; folders are named after it.
    pub name: String,
    /// delta_d: how far the cutter stays back, along the direction the linkage gives.
    pub offset_mm: f64,
    /// Which linkage moves the axes.
    pub linkage: Linkage,
    /// How many strokes.
    pub feed: Feed,
    /// What advances equally from stroke to stroke.
    pub spacing: StrokeSpacing,
    /// First and last work angle psi_c, when only part of the turn is cut.
    pub window_rad: Option<[f64; 2]>,
    /// Turns of the work.
    pub revolutions: u32,
    /// Work angle beyond the whole turns, so that the end overlaps the start.
    pub overlap_rad: f64,
    /// How the cutter gets to depth.
    pub infeed: Infeed,
    /// The rotary feed goes on while the cutter is in the work (crank law); otherwise the pose is frozen during a
    /// stroke.
    pub feed_during_stroke: bool,
    /// Axis program (G-code) that is cut instead of the linkage's own positions; the linkage remains the target.
    pub program: Option<PathBuf>,
}

/// Linkage models of external shaping; Gao et al. 2017.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Linkage {
    /// Finish angles, the offset added to the centre distance.
    ShapingTraditional {
        /// Direction in which the offset moves the cutter.
        direction: TraditionalDirection,
    },
    /// Offset along the normal of the pitch curve.
    ShapingNormal {
        /// Which reading of Eq. 12.
        reading: NormalReading,
    },
}

/// Direction of the traditional linkage's offset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TraditionalDirection {
    /// Along the line of centres (the machine's radial axis): what the paper's Eq. 5 to 8 describe.
    CenterLine,
    /// Along the polar radius of the pitch point: a reading that does not fit the paper's numbers, kept for comparison.
    PolarRadius,
}

/// Reading of Eq. 12 of the normal linkage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NormalReading {
    /// beta' in psi_b: the cutter keeps its phase along the normal.
    Corrected,
    /// beta without the offset in psi_b, as printed: wrong, kept to show what it does.
    AsPrinted,
}

/// Number of strokes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Feed {
    /// N double strokes per work revolution.
    StrokesPerRevolution(u32),
    /// Mean arc of pitch curve per double stroke.
    CircularMmPerStroke(f64),
}

/// What advances equally from stroke to stroke.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StrokeSpacing {
    /// Work angle psi_c (the paper's choice).
    WorkAngle,
    /// Arc of the pitch curve.
    Arc,
    /// Time, while the slowest axis runs at its speed limit; needs `machine.limits`.
    Time,
}

/// How the cutter gets to depth before the rolling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Infeed {
    /// Already at depth at the first stroke.
    None,
    /// Radially at the start angle, without rolling.
    Plunge {
        /// Depth to feed.
        depth_mm: f64,
        /// Number of strokes.
        strokes: u32,
    },
    /// Evenly while rolling over the first part of the turn.
    Spiral {
        /// Depth to feed.
        depth_mm: f64,
        /// Work angle over which it is fed.
        angle_rad: f64,
    },
    /// Part by plunging, the rest while rolling.
    PlungeAndRoll {
        /// Depth plunged.
        plunge_depth_mm: f64,
        /// Strokes of the plunge.
        strokes: u32,
        /// Depth fed while rolling.
        roll_depth_mm: f64,
        /// Work angle over which it is fed.
        angle_rad: f64,
    },
}

/// A window on the flanks of one tooth whose texture is evaluated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureWindow {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Which of its flanks.
    pub sides: WindowSides,
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

/// Where profiles are evaluated, as heights over the pitch curve along its normal; `None`: from the form point to the
/// tip, 5 % left out at each end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measure {
    /// Lower end.
    pub profile_start_height_mm: Option<f64>,
    /// Upper end.
    pub profile_end_height_mm: Option<f64>,
}

/// What is written and how finely.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// Spacing of maps.
    pub map_spacing_mm: f64,
    /// Spacing of vertices on meshes.
    pub mesh_spacing_mm: f64,
    /// Folder given in the scene, if any; the command line wins.
    pub folder: Option<PathBuf>,
    /// Form of the axis programs.
    pub gcode: GcodeDialect,
    /// Largest displacement on the flanks that their straight lines may cause.
    pub gcode_contour_error_mm: f64,
}

/// Form of axis programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GcodeDialect {
    /// Straight lines in inverse time.
    Linear,
    /// The one-block form of Gao et al. 2017, marked as not to be run.
    PaperG84,
    /// None.
    None,
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
    /// Height over the target.
    Height,
    /// Pass that left the surface.
    Pass,
    /// Nothing.
    Clay,
}
