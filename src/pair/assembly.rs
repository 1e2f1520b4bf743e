//! The gears in the machine: where their axes are, how they sit on them, and which flanks touch at an angle of the
//! driver.
//!
//! In: the pitch pair, flanks of both gears in their own frames, errors of mounting. Out: [`Meshing`], which answers
//! for any angle of the driver how far the driven gear may turn.
//!
//! The driven gear's own frame is that of the machine at phi_1 = 0, moved to its axis.

use glam::DVec2;

use super::contact::{PairPose, Touch, touch};
use super::flank_chain::{FlankChain, GearFlanks, PolarFlank};
use super::pitch_pair::{PitchPair, PitchPoint};
use gearcut_core::error::Refusal;
use gearcut_core::terms::Side;

/// Teeth beside the one at the pitch point that are asked whether they touch.
const TEETH_BESIDE: i64 = 5;

/// Errors of mounting.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Mounting {
    /// Added to the closing centre distance, mm.
    pub center_distance_error_mm: f64,
    /// From the axis of rotation to the origin of the pitch curve, each in the frame of its gear, mm.
    pub eccentricity_mm: [DVec2; 2],
}

/// Two flanks that touch, or would if the others let them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothTouch {
    /// The driver's tooth, unwrapped.
    pub tooth: i64,
    /// The touch.
    pub touch: Touch,
}

/// What the flanks of one side allow at one angle of the driver.
#[derive(Debug, Clone, PartialEq)]
pub struct SideTouch {
    /// Transmission error of the driven gear when this side touches, rad.
    pub error_rad: f64,
    /// The pair that touches first.
    pub acting: ToothTouch,
    /// All pairs within reach, in the order of teeth.
    pub pairs: Vec<ToothTouch>,
}

/// Both sides at one angle of the driver.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    /// The pitch point.
    pub pitch: PitchPoint,
    /// The driving flanks.
    pub right: SideTouch,
    /// The back flanks.
    pub left: SideTouch,
}

/// Two gears in mesh.
#[derive(Debug, Clone)]
pub struct Meshing {
    /// The pitch curves.
    pub pitch: PitchPair,
    driver: GearFlanks<FlankChain>,
    driven: GearFlanks<PolarFlank>,
    axis_2_mm: DVec2,
}

impl Meshing {
    /// Puts two gears together.
    ///
    /// # Errors
    /// Flanks of the driven gear that cannot be rolled.
    pub fn new(
        pitch: PitchPair,
        driver: &GearFlanks<FlankChain>,
        driven: &GearFlanks<FlankChain>,
        mounting: &Mounting,
    ) -> Result<Self, Refusal> {
        let [off_1, off_2] = mounting.eccentricity_mm;
        let axis_2_mm =
            DVec2::new(pitch.sign() * (pitch.center_distance_mm() + mounting.center_distance_error_mm), 0.0);
        Ok(Self {
            driver: driver.map(|chain| Ok::<_, Refusal>(chain.moved(off_1)))?,
            driven: driven.map(|chain| PolarFlank::new(&chain.moved(off_2)))?,
            pitch,
            axis_2_mm,
        })
    }

    /// The same gears at another centre distance: `error_mm` is added to the closing one.
    #[must_use]
    pub fn at_center_distance(&self, error_mm: f64) -> Self {
        let axis_2_mm = DVec2::new(self.pitch.sign() * (self.pitch.center_distance_mm() + error_mm), 0.0);
        Self { axis_2_mm, ..self.clone() }
    }

    /// How the gears stand at an angle of the driver, with the driven gear where the pitch curves want it.
    pub fn stand(&self, pitch: &PitchPoint) -> PairPose {
        PairPose {
            phi_1_rad: pitch.phi_1_rad,
            axis_2_mm: self.axis_2_mm,
            phi_2_rad: pitch.phi_2_rad,
            sign: self.pitch.sign(),
        }
    }

    /// What the flanks of a side allow; `distance_error_mm` moves the driven axis along the line of centres.
    ///
    /// # Errors
    /// No pair of flanks is within reach.
    pub fn side(&self, pitch: &PitchPoint, side: Side, distance_error_mm: f64) -> Result<SideTouch, Refusal> {
        let mut stand = self.stand(pitch);
        stand.axis_2_mm.x += self.pitch.sign() * distance_error_mm;
        let at = (pitch.arc_mm / self.pitch.pitch_mm()).round() as i64;
        first_touch(&self.driver, &self.driven, &stand, side, at)
    }

    /// Both sides at an angle of the driver.
    ///
    /// # Errors
    /// No pair of flanks is within reach.
    pub fn at(&self, phi_1_rad: f64) -> Result<Moment, Refusal> {
        let pitch = self.pitch.at(phi_1_rad);
        let [right, left] = [Side::Right, Side::Left].map(|side| self.side(&pitch, side, 0.0));
        Ok(Moment { pitch, right: right?, left: left? })
    }
}

/// The pairs of a side near the tooth `at`, and the one that touches first.
///
/// # Errors
/// No pair of flanks is within reach.
pub fn first_touch(
    driver: &GearFlanks<FlankChain>,
    driven: &GearFlanks<PolarFlank>,
    stand: &PairPose,
    side: Side,
    at: i64,
) -> Result<SideTouch, Refusal> {
    // A tooth has one place on a small gear: no label is asked twice.
    let most = driver.right.len().min(driven.right.len()) as i64;
    let beside = TEETH_BESIDE.min((most - 1) / 2);
    let pairs: Vec<ToothTouch> = (at - beside..=at + beside)
        .filter_map(|tooth| {
            let touch = touch(driver.get(side, tooth), driven.get(side, tooth), stand, side)?;
            Some(ToothTouch { tooth, touch })
        })
        .collect();
    let push = |pair: &ToothTouch| -side.sign() * pair.touch.error_rad;
    let acting = pairs.iter().copied().max_by(|a, b| push(a).total_cmp(&push(b))).ok_or_else(|| {
        Refusal::new(
            "gear.addendum_coefficient",
            format!(
                "no {} flanks touch when the driver stands at {:.3} deg",
                side.name(),
                stand.phi_1_rad.to_degrees()
            ),
            "use a smaller centre distance or a larger addendum_coefficient",
        )
    })?;
    Ok(SideTouch { error_rad: acting.touch.error_rad, acting, pairs })
}
