//! Axis positions and cutter poses: what every shaping linkage answers with.
//!
//! In: the pitch curve at a parameter ([`gearcut_core::gear::Rolling`]). Out: [`Axes`] (work angle, cutter angle,
//! centre distance) as series in that parameter, and the [`CutterPose`] that they give. The law is the frame convention
//! in the head of [`super`]: tooth 0 points along the line of centres at psi_b = 0, towards the gear axis where the
//! cutter stands outside, away from it where the cutter stands in a ring.
//!
//! The parameter is the polar angle phi, or time or stroke when phi itself is a series in them: derivatives then follow
//! by the chain rule without further formulas. The number of terms N is chosen by the caller: 1 for positions, 2 for
//! rates, 3 for accelerations.

use std::f64::consts::PI;

use glam::DVec2;

use gearcut_core::gear::GearKind;
use gearcut_core::math::Jet;

/// Positions of the three axes as series with N terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axes<const N: usize> {
    /// Work angle: polar angle of the cutter centre in the gear frame, rad, unwrapped.
    pub psi_c_rad: Jet<N>,
    /// Cutter angle against the line of centres, rad, unwrapped.
    pub psi_b_rad: Jet<N>,
    /// Centre distance l, mm.
    pub center_distance_mm: Jet<N>,
}

/// Place and orientation of the cutter in the gear frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutterPose {
    /// Cutter axis O_b, mm.
    pub center_mm: DVec2,
    /// Direction of cutter tooth 0, rad, unwrapped: a point q of the cutter frame lies at center + rotation(angle) q.
    pub angle_rad: f64,
}

/// Pose with its first derivative with respect to phi at constant offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseMotion {
    /// The pose.
    pub pose: CutterPose,
    /// dO_b/dphi, mm per rad.
    pub center_rate_mm_per_rad: DVec2,
    /// Derivative of the orientation, rad per rad.
    pub angle_rate: f64,
}

impl PoseMotion {
    /// Point of the gear frame (mm) that is at rest in cutter and work alike: O_b + i O_b' / theta'. In finishing it is
    /// the pitch point; the contact normals of all flanks pass through it.
    pub fn instantaneous_center_mm(&self) -> DVec2 {
        self.pose.center_mm + self.center_rate_mm_per_rad.perp() / self.angle_rate
    }
}

impl<const N: usize> Axes<N> {
    /// The pose at the axis positions.
    pub fn pose(&self, gear: GearKind) -> CutterPose {
        CutterPose::new(gear, [self.psi_c_rad, self.psi_b_rad, self.center_distance_mm].map(|axis| axis.value()))
    }
}

impl CutterPose {
    /// From the axis positions: work angle and cutter angle, rad, centre distance, mm.
    pub fn new(gear: GearKind, [psi_c_rad, psi_b_rad, center_distance_mm]: [f64; 3]) -> Self {
        let towards_work_rad = match gear {
            GearKind::External => psi_c_rad + PI,
            GearKind::Internal => psi_c_rad,
        };
        Self { center_mm: DVec2::from_angle(psi_c_rad) * center_distance_mm, angle_rad: towards_work_rad + psi_b_rad }
    }
}

impl Axes<2> {
    /// The pose and its derivative with respect to the parameter.
    pub(super) fn pose_motion(&self, gear: GearKind) -> PoseMotion {
        let out = DVec2::from_angle(self.psi_c_rad.value());
        let (l, turn) = (self.center_distance_mm, self.psi_c_rad.derivative(1));
        PoseMotion {
            pose: self.pose(gear),
            center_rate_mm_per_rad: out * l.derivative(1) + out.perp() * (l.value() * turn),
            angle_rate: turn + self.psi_b_rad.derivative(1),
        }
    }
}
