//! Checked values of bevel scenes: cones, head, settings, limits, operations; mm, rad, s.

use crate::machine_errors::{MachineErrors, ToolMounting};
use crate::material::CuttingForce;
use crate::scene::Scene;
use gearcut_core::bevel::blank::MatingCones;
use gearcut_core::bevel::cradle::CradleSettings;
use gearcut_core::bevel::ease_off::Setting;
use std::path::PathBuf;

/// Spiral bevel gears: blank, head, machine and operations.
#[derive(Debug, Clone, PartialEq)]
pub struct Bevel {
    /// Cones of the blank.
    pub cones: Cones,
    /// The head.
    pub head: HeadSpec,
    /// Settings of the cradle machine.
    pub settings: SettingsSpec,
    /// What is wrong with the axes (X, Y, Z, work, swing) and the work on its spindle; the machine has no guide along
    /// the gear.
    pub errors: MachineErrors<5>,
    /// Mounting distance of the six-axis machine.
    pub mounting_mm: f64,
    /// Largest speeds of X, Y, Z, A and B, mm or rad per s; `None`: not limited.
    pub speed_limits: [Option<f64>; 5],
    /// Largest accelerations of the same axes, mm or rad per s^2.
    pub acceleration_limits: [Option<f64>; 5],
    /// Lowest and highest positions of X, Y, Z and B, mm or rad; `None`: not limited.
    pub travel: [[Option<f64>; 2]; 4],
    /// Points of inspection along profile and tooth.
    pub grid: [usize; 2],
    /// Operations in the order they are cut; the last one defines the target.
    pub operations: Vec<BevelOperation>,
    /// Cutting force of the work's material; `None` where the scene does not name it, and no force is computed.
    pub material: Option<CuttingForce>,
    /// Whether axis programs are written.
    pub programs: bool,
}

impl Bevel {
    /// The bevel part of a scene, if it cuts bevel gears.
    pub fn of(scene: &Scene) -> Option<&Self> {
        scene.process.get()
    }
}

/// Cone data beside those of `[gear]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cones {
    /// Pitch angle.
    pub pitch_angle_rad: f64,
    /// Face angle.
    pub face_angle_rad: f64,
    /// Root angle.
    pub root_angle_rad: f64,
    /// Outer addendum, mm.
    pub addendum_mm: f64,
    /// Outer dedendum, mm.
    pub dedendum_mm: f64,
    /// The mate, where the scene names it.
    pub mate: Option<MatingCones>,
    /// Angle between both axes of the pair.
    pub shaft_angle_rad: f64,
    /// Offset of both axes, mm.
    pub hypoid_offset_mm: f64,
}

/// The head as the scene describes it.
#[derive(Debug, Clone, PartialEq)]
pub struct HeadSpec {
    /// Mean radius, mm; `None`: inferred from the settings.
    pub radius_mm: Option<f64>,
    /// Point width, mm.
    pub point_width_mm: f64,
    /// Blade angles, outside and inside, rad.
    pub blade_angles_rad: [f64; 2],
    /// Radius of the cutting corners, mm.
    pub corner_radius_mm: f64,
    /// Width of blades at their tips, mm; `None`: 0.7 point widths.
    pub tip_width_mm: Option<f64>,
    /// Number of blades of both kinds.
    pub blades: u32,
    /// How far each blade stands out, mm; empty: none does.
    pub runouts_mm: Vec<f64>,
    /// Angle of the first blade when the first slot begins, rad.
    pub start_angle_rad: f64,
    /// How the head sits on its spindle.
    pub mounting: ToolMounting,
}

/// Settings as the scene names them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SettingsSpec {
    /// Settings; those below count only where they are given.
    pub cradle: CradleSettings,
    /// Mean spiral angle, where given in place of radial setting and cradle angle, rad; positive: right-hand.
    pub spiral_angle_rad: Option<f64>,
    /// Sliding base, where given, mm.
    pub sliding_base_mm: Option<f64>,
    /// The machine's root angle, where given, rad.
    pub root_angle_rad: Option<f64>,
    /// Ratio of roll, where given.
    pub roll_ratio: Option<f64>,
    /// How far the machine is off, setting by setting: mm, rad or a ratio.
    pub errors: [(Setting, f64); Setting::ALL.len()],
}

/// One run of the head over all slots.
#[derive(Debug, Clone, PartialEq)]
pub struct BevelOperation {
    /// Name, unique in the scene.
    pub name: String,
    /// How far the head stays back along its axis, mm.
    pub offset_mm: f64,
    /// Speed of the head against the cradle, rad/s.
    pub head_speed_rad_per_s: f64,
    /// How it goes through a slot.
    pub feed: SlotFeed,
    /// Time between two slots: withdraw, roll back or not, index, s.
    pub idle_s: f64,
    /// Axis program (G-code) that is cut instead of the settings' own positions.
    pub program: Option<PathBuf>,
}

/// How an operation goes through a slot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SlotFeed {
    /// The cradle rolls.
    Roll {
        /// Speed of the cradle, rad/s.
        rad_per_s: f64,
        /// Cradle angles at which the roll begins and ends, rad; `None`: what the flanks need.
        ends_rad: [Option<f64>; 2],
    },
    /// The head plunges and stays.
    Plunge {
        /// Way along its axis for each of its turns, mm.
        mm_per_turn: f64,
        /// Turns at full depth.
        dwell_revolutions: f64,
    },
}

impl SlotFeed {
    /// The key that makes it faster or slower.
    pub fn key(&self) -> &'static str {
        match self {
            Self::Roll { .. } => "roll_speed_deg_per_s",
            Self::Plunge { .. } => "infeed_mm_per_revolution",
        }
    }
}
