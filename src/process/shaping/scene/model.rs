//! Checked values of shaping scenes: cutter, machine, operations; mm, rad, s.

use crate::machine_errors::{Compliance, MachineErrors, OneMass};
use crate::material::EdgeForce;
use crate::random::Draws;
use crate::scene::Scene;
use crate::scene::drawn_profile::ToolProfile;
use crate::scene::tool_wear::WearSpec;
use gearcut_core::gear::GearKind;
use gearcut_core::passes::planar::strokes::StrokeLaw;
use gearcut_core::terms::Hand;
use std::f64::consts::TAU;
use std::path::PathBuf;

/// Shaping: tool, machine and operations.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaping {
    /// The shaper cutter.
    pub tool: CutterSpec,
    /// The machine: stroke, clearances, errors, axis limits.
    pub machine: Machine,
    /// Operations in the order they are cut; at least one. The last one defines the target flank.
    pub operations: Vec<Operation>,
    /// Force coefficients of the work's material.
    pub material: EdgeForce,
    /// Distance of the rays on which chips are followed, mm.
    pub chip_spacing_mm: f64,
    /// Form of the axis programs.
    pub gcode: GcodeDialect,
    /// How the cutter wears; `None` where the scene does not say, and no wear is computed.
    pub wear: Option<WearSpec>,
    /// Coordinate measurement of the allowances, if the scene asks for one.
    pub cmm: Option<CmmSpec>,
}

/// A coordinate measurement of the allowances.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CmmSpec {
    /// Points on a profile.
    pub points: u32,
    /// Diameter of the probe's ball, mm.
    pub probe_diameter_mm: f64,
    /// Standard deviation of a point along its normal, mm.
    pub point_deviation_mm: f64,
    /// Standard deviation of the gear's axis in x and in y before it is finished, mm.
    pub clamping_offset_mm: f64,
    /// Standard deviation of its turn then, rad.
    pub clamping_turn_rad: f64,
    /// Measurements by chance.
    pub draws: u32,
    /// Where chance begins.
    pub seed: u32,
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

impl Shaping {
    /// The shaping part of a scene, if it shapes.
    pub fn of(scene: &Scene) -> Option<&Self> {
        scene.process.get()
    }

    /// The same, to try other values.
    #[cfg(feature = "testing")]
    pub fn of_mut(scene: &mut Scene) -> Option<&mut Self> {
        scene.process.get_mut()
    }
}

/// Shaper cutter by its projected transverse profile.
#[derive(Debug, Clone, PartialEq)]
pub struct CutterSpec {
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
    /// Top rake of its conical rake face, rad; for forces, and for the edge where the grinding is known.
    pub rake_angle_rad: f64,
    /// Distance of the cutter's profile axis from its spindle axis.
    pub runout_mm: f64,
    /// Direction of the runout in the cutter frame, from cutter tooth 0.
    pub runout_angle_rad: f64,
    /// Cumulative pitch error of each cutter tooth on the pitch circle, mm, positive counter-clockwise; empty or one
    /// value per tooth.
    pub pitch_errors_mm: Vec<f64>,
    /// How its flanks are ground; `None`: their edges are true involutes.
    pub grinding: Option<Grinding>,
    /// Roughness of its edges along the flanks.
    pub edge_roughness: Option<EdgeRoughness>,
    /// Rounding of its edges across; `None`: sharp ones.
    pub edge_rounding: Option<EdgeRounding>,
    /// What builds up on its edges and tears flanks; `None`: nothing does.
    pub built_up_edge: Option<BuiltUpEdge>,
    /// Contour of a tooth that is drawn or measured, in place of the involute one.
    pub profile: Option<ToolProfile>,
}

impl CutterSpec {
    /// Coefficients of a cutter in modules of its transverse section, from those in modules of its normal one.
    #[must_use]
    pub fn transverse(&self, helix_angle_rad: f64) -> Self {
        let cos = if helix_angle_rad == 0.0 { 1.0 } else { helix_angle_rad.cos() };
        Self {
            addendum_coefficient: self.addendum_coefficient * cos,
            dedendum_coefficient: self.dedendum_coefficient * cos,
            profile_shift_coefficient: self.profile_shift_coefficient * cos,
            grinding: self.grinding.map(|grinding| Grinding {
                pressure_angle_rad: grinding.pressure_angle_rad.map(|normal_rad| (normal_rad.tan() / cos).atan()),
                ..grinding
            }),
            ..self.clone()
        }
    }
}

/// How flanks of a cutter are ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grinding {
    /// alpha_t: relief of the tip.
    pub tip_relief_rad: f64,
    /// alpha_0, in the section of the cutter's numbers; `None`: corrected for rake and relief.
    pub pressure_angle_rad: Option<f64>,
}

/// Pits and scratches that fragments of a built-up edge tear into flanks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BuiltUpEdge {
    /// lambda_0: marks to a mm2 where cutting speed and chip favour them most.
    pub density_per_mm2: f64,
    /// v_1 to v_4: cutting speeds at which marks begin, are densest from and to, and end.
    pub speeds_mm_per_s: [f64; 4],
    /// h_0: thickness of the chip where the density reaches its full value.
    pub chip_mm: f64,
    /// p: how the density goes with the thickness on the other side of it.
    pub chip_exponent: f64,
    /// Mean depth of marks in their middle.
    pub depth_mm: f64,
    /// Mean width of marks across the stroke.
    pub width_mm: f64,
    /// Share of marks that are scratches; the others are pits.
    pub scratch_share: f64,
    /// Mean length of scratches along the stroke.
    pub scratch_length_mm: f64,
    /// Which marks.
    pub seed: u32,
}

/// Rounding of cutting edges, which take no chip thinner than a share of their radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeRounding {
    /// r_beta.
    pub radius_mm: f64,
    /// k: thinnest chip over the radius.
    pub minimum_chip_share: f64,
    /// Share of what is not cut that springs back behind the edge.
    pub recovery_share: f64,
}

/// Roughness of cutting edges along the cutter's flanks.
#[derive(Debug, Clone, PartialEq)]
pub enum EdgeRoughness {
    /// A random one on every flank, normal, of the autocovariance Rq^2 exp(-(s / l)^2).
    Spectrum {
        /// Rq: its standard deviation.
        rq_mm: f64,
        /// l: arc along the edge at which the autocovariance has fallen to 1/e.
        correlation_mm: f64,
        /// Which cutter.
        seed: u32,
    },
    /// A measured one, the same on all flanks, from a table.
    Profile(PathBuf),
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

/// One coordinate of the machine as a mass on a spring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineVibration {
    /// Which coordinate of a [`crate::machine_errors::Deflection`].
    pub axis: usize,
    /// Undamped.
    pub natural_frequency_hz: f64,
    /// Over the critical damping.
    pub damping_ratio: f64,
}

impl MachineVibration {
    /// Words for the coordinates, in their order.
    pub const AXES: [&str; 4] = ["radial", "tangential", "tool_torsional", "work_torsional"];

    /// The mass on the spring of a machine's compliance.
    pub fn mass(&self, compliance: &Compliance) -> OneMass {
        OneMass {
            compliance: compliance.diagonal()[self.axis],
            natural_rad_per_s: TAU * self.natural_frequency_hz,
            damping_ratio: self.damping_ratio,
        }
    }
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
    /// How far the cutter is drawn back during the return stroke.
    pub back_off_mm: f64,
    /// Which way.
    pub retraction: Retraction,
    /// Lead of the helical guide on the ram; `None`: the one that the gear's helix needs, none for spur gears.
    pub guide_lead_mm: Option<f64>,
    /// Its hand; `None`: the one that the gear needs.
    pub guide_hand: Option<Hand>,
    /// What is wrong with its axes (work, cutter, centre distance), its ram's guide and the work on its spindle.
    pub errors: MachineErrors<3>,
    /// How far cutter and work give way to the forces of the cut.
    pub compliance: Compliance,
    /// How they vibrate; `None`: they do not.
    pub vibration: Option<MachineVibration>,
    /// Limits of the axes, where known.
    pub limits: AxisLimits,
}

impl Machine {
    /// How the ram passes a face of this width, mm.
    pub fn crank(&self, face_width_mm: f64) -> StrokeLaw {
        StrokeLaw::crank(face_width_mm, self.approach_mm, self.overrun_mm)
    }

    /// Speed of the ram at a height over the middle of the face, over its largest; 0 beyond its stroke.
    pub fn speed_share(&self, face_width_mm: f64, z_mm: f64) -> f64 {
        let stroke_mm = self.approach_mm + face_width_mm + self.overrun_mm;
        let middle_mm = 0.5 * (self.approach_mm - self.overrun_mm);
        (1.0 - (2.0 * (z_mm - middle_mm) / stroke_mm).powi(2)).max(0.0).sqrt()
    }
}

/// Hand of the guide, and of the cutter, that a gear needs.
pub fn guide_hand(kind: GearKind, hand: Hand) -> Hand {
    match (kind, hand) {
        (GearKind::External, Hand::Right) | (GearKind::Internal, Hand::Left) => Hand::Left,
        _ => Hand::Right,
    }
}

/// Which way the cutter is drawn back for the return stroke; the laws are in
/// [`crate::process::shaping::linkage::retraction`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Retraction {
    /// Along the line of centres, by the machine's own relief.
    CenterLine,
    /// Along the normal of the pitch curve.
    Normal,
    /// Along the line of centres, the cutter turned as it would roll on.
    Turned,
    /// Along the direction, at one angle to the normal, that clears stock as well.
    Tilted,
    /// Along the line of centres where that is clear, turned where it is not.
    Auto,
}

impl Retraction {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::CenterLine => "along the line of centres",
            Self::Normal => "along the normal of the pitch curve",
            Self::Turned => "along the line of centres, the cutter turned",
            Self::Tilted => "tilted out of the normal of the pitch curve",
            Self::Auto => "along the line of centres, the cutter turned where that is not clear",
        }
    }
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
    /// Cutting force of the ram, N.
    pub cutting_force_n: Option<f64>,
}

/// Scatter of the stock that an operation leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StockScatter {
    /// Standard deviation of the offset: that of the stock normal to flanks / sin(pressure angle).
    pub deviation_mm: f64,
    /// Arc of pitch curve over which its correlation falls to 1/e; `None`: another offset with every stroke.
    pub length_mm: Option<f64>,
    /// Where its numbers come from.
    pub draws: Draws,
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
    /// How the stock scatters that it leaves; `None`: not at all.
    pub stock_scatter: Option<StockScatter>,
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
