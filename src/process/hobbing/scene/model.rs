//! Checked values of hobbing scenes: hob, limits of the machine, operations; mm, rad, s.

use crate::machine_errors::{MachineErrors, ToolMounting};
use crate::material::CuttingForce;
use crate::scene::Scene;
use crate::scene::drawn_profile::ToolProfile;
use crate::scene::tool_wear::WearSpec;
use gearcut_core::terms::Hand;
use std::path::PathBuf;

/// Hobbing: tool, machine and operations.
#[derive(Debug, Clone, PartialEq)]
pub struct Hobbing {
    /// The hob.
    pub tool: HobSpec,
    /// Limits of the axes, where known.
    pub limits: HobbingAxisLimits,
    /// What is wrong with the axes (hob, work, X, Y, slide, shift), the slide's guide and the work on its spindle.
    pub errors: MachineErrors<6>,
    /// Operations in the order they are cut; at least one. The last one defines the target flank.
    pub operations: Vec<HobbingOperation>,
    /// Cutting force of the work's material; `None` where the scene does not name it, and no force is computed.
    pub material: Option<CuttingForce>,
    /// How the hob wears; `None` where the scene does not say, and no wear is computed.
    pub wear: Option<WearSpec>,
    /// Whether axis programs are written.
    pub programs: bool,
}

impl Hobbing {
    /// The hobbing part of a scene, if it hobs.
    pub fn of(scene: &Scene) -> Option<&Self> {
        scene.process.get()
    }
}

/// A hob; module and pressure angle are the gear's, both normal.
#[derive(Debug, Clone, PartialEq)]
pub struct HobSpec {
    /// Number of starts K.
    pub starts: u32,
    /// Hand of the thread.
    pub hand: Hand,
    /// Number of gashes.
    pub gashes: u32,
    /// How the gashes run.
    pub gash_form: GashForm,
    /// What fixes the pitch cylinder.
    pub size: HobSize,
    /// Length of thread with full profile, mm.
    pub length_mm: f64,
    /// Addendum in modules: it cuts the gear's dedendum.
    pub addendum_coefficient: f64,
    /// Dedendum in modules.
    pub dedendum_coefficient: f64,
    /// Form of the thread's flanks.
    pub worm: Worm,
    /// Contour of a tooth that is drawn or measured, in place of the straight-sided basic rack.
    pub profile: Option<ToolProfile>,
    /// Radius of the tip round in the rake face, mm; 0: sharp.
    pub tip_radius_mm: f64,
    /// Protuberance, if the hob has one.
    pub protuberance: Option<Protuberance>,
    /// Where the flanks leave their line towards the root and relieve or chamfer the gear's tips, in the order of their
    /// heights.
    pub tip_reliefs: Vec<HobRelief>,
    /// Normal thickness taken off every tooth on the pitch cylinder, as on a roughing hob, mm.
    pub thinning_mm: f64,
    /// How much the radius has shrunk by regrinding, mm.
    pub regrind_mm: f64,
    /// How the hob sits on its spindle.
    pub mounting: ToolMounting,
    /// How far teeth stand off the thread along the axis, towards the entering end, mm: gash by gash, counted from the
    /// one at the hob's angle 0 in the order of their cuts, the same for all threads or thread after thread; empty: not
    /// at all.
    pub pitch_errors_mm: Vec<f64>,
}

impl HobSpec {
    /// Whether a tooth stands off its thread.
    pub fn has_pitch_errors(&self) -> bool {
        self.pitch_errors_mm.iter().any(|&error_mm| error_mm != 0.0)
    }

    /// How far the tooth of a thread, from 0, that cuts in a passage stands off it, mm.
    pub fn pitch_error_mm(&self, start: u32, passage: i64) -> f64 {
        let gash = passage.rem_euclid(i64::from(self.gashes)) as usize;
        let of_all = self.pitch_errors_mm.len() <= self.gashes as usize;
        let place = if of_all { gash } else { (start * self.gashes) as usize + gash };
        self.pitch_errors_mm.get(place).copied().unwrap_or(0.0)
    }
}

/// How gashes run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GashForm {
    /// Parallel to the hob's axis.
    Axial,
    /// At right angles to the thread on the pitch cylinder.
    Helical,
}

/// What fixes the hob's pitch cylinder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HobSize {
    /// Lead angle on the pitch cylinder, rad.
    LeadAngle(f64),
    /// Diameter of the pitch cylinder, mm.
    ReferenceDiameter(f64),
}

/// Form of the thread's flanks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Worm {
    /// Involute helicoid (ZI of ISO 1122-2): cuts exact involutes.
    Involute,
    /// Straight in the axial section (ZA): the straight-sided basic rack as many hobs are ground; cuts nearly an
    /// involute.
    StraightSided,
}

/// Protuberance: a steeper flank near the tip, which relieves the gear's root for grinding or shaving.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Protuberance {
    /// Height below the tip at which it begins, mm.
    pub height_mm: f64,
    /// Its normal pressure angle, smaller than the flank's.
    pub angle_rad: f64,
}

/// A part of a hob's flank that stands out towards the root: it takes off the gear's tips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HobRelief {
    /// Height over the hob's pitch line, towards its root, at which it begins, mm.
    pub height_mm: f64,
    /// How much further the flank stands out per height than its own line does, along the pitch line in the normal
    /// section.
    pub slope: f64,
}

/// Motion that is even in time while the slide rests (Liu et al. 2013: the three methods).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EvenMotion {
    /// Arc of the pitch curve: the hob turns evenly (schemes I and II).
    ArcLength,
    /// Work angle: the work turns evenly (III and IV).
    RotationAngle,
    /// Polar angle of the pitch point (V and VI).
    PolarAngle,
}

/// Axis that carries the extra rotation which the slide asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExtraRotation {
    /// The work (I, III, V).
    Work,
    /// The hob (II, IV, VI).
    Hob,
}

/// Reading of the papers' formulas.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkageForm {
    /// Rolling without slip at every moment.
    Exact,
    /// As printed: extra rotation v_z tan(beta) / r of the work alone. Wrong on curves that are no circles; kept to
    /// show what it does.
    AsPrinted,
}

/// Largest speeds and accelerations of a hobbing machine's axes in the order hob, work, tangential (X), radial (Y),
/// slide, shift; rad or mm, per s and s^2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HobbingAxisLimits {
    /// Speeds; `None`: not limited.
    pub speeds: [Option<f64>; 6],
    /// Accelerations; `None`: not limited.
    pub accelerations: [Option<f64>; 6],
}

/// One run of the hob over the work.
#[derive(Debug, Clone, PartialEq)]
pub struct HobbingOperation {
    /// Name, unique in the scene; files are named after it.
    pub name: String,
    /// How far the hob stays back from full depth, mm.
    pub offset_mm: f64,
    /// How the axes are linked.
    pub kind: HobbingKind,
    /// Speed of the hob in the mean of a cycle, rad/s.
    pub hob_speed_rad_per_s: f64,
    /// Feed along the gear's axis in the time of one cycle along the pitch curve, mm.
    pub axial_feed_mm_per_revolution: f64,
    /// Which way the slide feeds.
    pub feed_direction: FeedDirection,
    /// How the hob gets to depth.
    pub approach: Approach,
    /// Travel of the slide from its start to where the hob's axis passes the face; `None`: as much as the hob needs to
    /// start clear of the blank.
    pub approach_mm: Option<f64>,
    /// Travel of the slide beyond the other face; `None`: until the last contact has left the work.
    pub overrun_mm: Option<f64>,
    /// Tilt of the hob's axis against the transverse plane, if not h beta - h_b lambda.
    pub head_angle_rad: Option<f64>,
    /// Place of the hob's middle along its axis at the start, mm from the pitch point; `None`: 0, or the end of the
    /// shift's range.
    pub shift_start_mm: Option<f64>,
    /// Feed marks higher than this are warned of, mm.
    pub ridge_tolerance_mm: f64,
    /// Axis program (G-code) that is cut instead of the linkage's own positions.
    pub program: Option<PathBuf>,
}

/// How the axes are linked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HobbingKind {
    /// Five axes: the hob rests along its axis (Liu et al. 2013).
    Plain {
        /// Motion that is even in time.
        even: EvenMotion,
        /// Who carries the extra rotation.
        extra: ExtraRotation,
        /// Exact or as printed.
        form: LinkageForm,
    },
    /// Six axes: the hob shifts along its axis while it cuts (Liu et al. 2015).
    Diagonal {
        /// Shift in the time of one cycle along the pitch curve, mm.
        shift_mm_per_revolution: f64,
        /// Which way it shifts first.
        direction: ShiftDirection,
        /// What happens at the end of the hob.
        strategy: ShiftStrategy,
        /// Length of hob that is used; `None`: all that carries full contact.
        stroke_mm: Option<f64>,
        /// What the axial feed counts.
        feed_of: FeedOf,
        /// Exact or as printed.
        form: LinkageForm,
    },
}

/// Direction of the diagonal shift: whether it adds to the rolling or takes from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShiftDirection {
    /// U: the shift adds to the speed of the rack (kappa = +1).
    Adds,
    /// V: the shift takes from it (kappa = -1).
    Subtracts,
}

impl ShiftDirection {
    /// kappa.
    pub fn sign(self) -> f64 {
        match self {
            Self::Adds => 1.0,
            Self::Subtracts => -1.0,
        }
    }
}

/// What happens when the shift has reached the end of the hob.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShiftStrategy {
    /// Nothing: the whole shift must fit on the hob.
    OneWay,
    /// The hob leaves the work, travels back and cuts in again.
    Repeating {
        /// Speed of the idle travel, mm/s.
        return_mm_per_s: f64,
    },
    /// The shift turns round.
    Reciprocating,
}

/// What the axial feed of a diagonal operation counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FeedOf {
    /// The slide: the place where the hob's axis crosses the gear, which spaces the feed marks.
    Slide,
    /// Slide and the shift's component along the gear's axis: v*_z of Liu et al. 2015, which they keep constant.
    Resultant,
}

/// Which way the slide feeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FeedDirection {
    /// Climb: the hob feeds against the way its teeth go through the work; a left-hand hob feeds down.
    Climb,
    /// Conventional: it feeds the way its teeth go.
    Conventional,
}

/// How the hob gets to depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Approach {
    /// At depth beside the face, then along the axis into the work.
    Axial,
    /// Radially at the face, then along the axis.
    Radial {
        /// Radial feed in the time of one cycle, mm.
        feed_mm_per_revolution: f64,
    },
}
