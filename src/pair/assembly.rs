//! The gears in the machine: where their axes are, how they sit on them, and which flanks touch at an angle of the
//! driver.
//!
//! In: the pitch pair, flanks of both gears in their own frames in one or several transverse sections, errors of
//! mounting. Out: [`Meshing`], which answers for any angle of the driver how far the driven gear may turn.
//!
//! Law: a rotation about the driven axis keeps every point in its transverse section, so each section asks for a
//! rotation of its own, and the gears touch at the largest of them (right flanks; at the left ones the smallest). That
//! is exact for parallel axes, spur or helical. Axes out of parallel are taken as axes that stand apart by another
//! vector in every section, which leaves out squares of the inclination: a nanometre at 0.1 mm over 30 mm of face.
//!
//! The driven gear's own frame is that of the machine at phi_1 = 0, moved to its axis.

use glam::DVec2;

use super::contact::{PairPose, Touch, touch};
use super::flank_chain::{FlankChain, GearFlanks, PolarFlank};
use super::pitch_pair::{PitchPair, PitchPoint};
use gearcut_core::error::Refusal;
use gearcut_core::gear::GearKind;
use gearcut_core::terms::Side;

/// Teeth beside the one at the pitch point that are asked whether they touch.
const TEETH_BESIDE: i64 = 5;

/// Errors of mounting.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AssemblyErrors {
    /// Added to the closing centre distance, mm.
    pub center_distance_error_mm: f64,
    /// From the axis of rotation to the origin of the pitch curve, each in the frame of its gear, mm.
    pub eccentricity_mm: [DVec2; 2],
    /// How much further from the driver the driven axis stands per length along the face: in the plane of both axes,
    /// positive apart, and across it, positive towards +y of the machine; mm per mm.
    pub inclination: DVec2,
}

/// Flanks of both gears in one transverse section.
#[derive(Debug, Clone, Copy)]
pub struct SectionFlanks<'a> {
    /// Place along the face, from its middle, mm.
    pub z_mm: f64,
    /// How far the teeth stand along the driver's pitch curve beyond those of the middle section, mm: 0 on spur gears.
    pub shift_mm: f64,
    /// The driver's.
    pub driver: &'a GearFlanks<FlankChain>,
    /// The driven gear's.
    pub driven: &'a GearFlanks<FlankChain>,
}

/// Two flanks that touch, or would if the others let them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothTouch {
    /// The driver's tooth, unwrapped.
    pub tooth: i64,
    /// Number of the section.
    pub section: usize,
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
    /// All pairs within reach, section by section in the order of teeth.
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

impl Moment {
    /// One of the sides.
    pub fn side(&self, side: Side) -> &SideTouch {
        match side {
            Side::Right => &self.right,
            Side::Left => &self.left,
        }
    }
}

/// Both gears in one section.
#[derive(Debug, Clone)]
pub struct GearsInSection {
    /// Place along the face, from its middle, mm.
    pub z_mm: f64,
    shift_mm: f64,
    /// The driver's flanks, moved by its eccentricity.
    pub driver: GearFlanks<FlankChain>,
    /// The driven gear's, moved by its own.
    pub driven: GearFlanks<PolarFlank>,
    axis_offset_mm: DVec2,
}

impl GearsInSection {
    /// Labels of the teeth that may touch when `pitch` is the pitch point.
    pub fn near(&self, pitch: &PitchPoint, pitch_mm: f64) -> impl Iterator<Item = i64> + use<> {
        let at = ((pitch.arc_mm - self.shift_mm) / pitch_mm).round() as i64;
        labels(&self.driver, &self.driven, at, TEETH_BESIDE)
    }

    /// Labels of the teeth whose tips may be in their mate. A ring has its tip circle cross the driver's far from the
    /// line of centres, where flanks that touch nothing may cross as well: there all teeth are looked at.
    pub fn crossing(&self, pitch: &PitchPoint, pair: &PitchPair) -> impl Iterator<Item = i64> + use<> {
        let at = ((pitch.arc_mm - self.shift_mm) / pair.pitch_mm()).round() as i64;
        let beside = if pair.teeth().driven == GearKind::Internal { i64::MAX } else { TEETH_BESIDE };
        labels(&self.driver, &self.driven, at, beside)
    }
}

/// Two gears in mesh.
#[derive(Debug, Clone)]
pub struct Meshing {
    /// The pitch curves.
    pub pitch: PitchPair,
    /// The sections that are looked at.
    pub sections: Vec<GearsInSection>,
    /// How far the gears are moved off their axes of rotation, each in its own frame, mm.
    pub eccentricity_mm: [DVec2; 2],
    center_distance_error_mm: f64,
}

impl Meshing {
    /// Puts two gears together that are looked at in one section.
    pub fn new(
        pitch: PitchPair,
        driver: &GearFlanks<FlankChain>,
        driven: &GearFlanks<FlankChain>,
        mounting: &AssemblyErrors,
    ) -> Self {
        Self::of_sections(pitch, &[SectionFlanks { z_mm: 0.0, shift_mm: 0.0, driver, driven }], mounting)
    }

    /// Puts two gears together.
    pub fn of_sections(pitch: PitchPair, sections: &[SectionFlanks], mounting: &AssemblyErrors) -> Self {
        let [off_1, off_2] = mounting.eccentricity_mm;
        let section = |of: &SectionFlanks| {
            let [apart, across] = (mounting.inclination * of.z_mm).to_array();
            GearsInSection {
                z_mm: of.z_mm,
                shift_mm: of.shift_mm,
                driver: of.driver.each(|chain| chain.moved(off_1)),
                driven: of.driven.each(|chain| PolarFlank::new(&chain.moved(off_2))),
                axis_offset_mm: DVec2::new(pitch.sign() * apart, across),
            }
        };
        let sections = sections.iter().map(section).collect();
        let AssemblyErrors { center_distance_error_mm, eccentricity_mm, .. } = *mounting;
        Self { pitch, sections, eccentricity_mm, center_distance_error_mm }
    }

    /// What is added to the closing centre distance, mm.
    pub fn center_distance_error_mm(&self) -> f64 {
        self.center_distance_error_mm
    }

    /// Axis of the driven gear in the middle section, machine frame, mm; the driver's is the origin.
    pub fn axis_2_mm(&self) -> DVec2 {
        DVec2::new(self.pitch.sign() * (self.pitch.center_distance_mm() + self.center_distance_error_mm), 0.0)
    }

    /// How the gears stand in a section, with the driven gear where the pitch curves want it; `distance_error_mm` moves
    /// its axis along the line of centres.
    pub fn stand(&self, pitch: &PitchPoint, section: &GearsInSection, distance_error_mm: f64) -> PairPose {
        let moved_mm = DVec2::new(self.pitch.sign() * distance_error_mm, 0.0);
        PairPose {
            phi_1_rad: pitch.phi_1_rad,
            axis_2_mm: self.axis_2_mm() + moved_mm + section.axis_offset_mm,
            phi_2_rad: pitch.phi_2_rad,
            sign: self.pitch.sign(),
        }
    }

    /// What the flanks of a side allow; `distance_error_mm` moves the driven axis along the line of centres.
    ///
    /// # Errors
    /// No pair of flanks is within reach.
    pub fn side(&self, pitch: &PitchPoint, side: Side, distance_error_mm: f64) -> Result<SideTouch, Refusal> {
        let mut pairs = Vec::new();
        for (index, section) in self.sections.iter().enumerate() {
            let stand = self.stand(pitch, section, distance_error_mm);
            for tooth in section.near(pitch, self.pitch.pitch_mm()) {
                let touch = touch(section.driver.get(side, tooth), section.driven.get(side, tooth), &stand, side);
                pairs.extend(touch.map(|touch| ToothTouch { tooth, section: index, touch }));
            }
        }
        first_of(pairs, side, pitch.phi_1_rad)
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

/// Labels up to `beside` from the tooth `at`; a tooth has one place on a small gear, so no label is given twice.
fn labels<A, B>(
    driver: &GearFlanks<A>,
    driven: &GearFlanks<B>,
    at: i64,
    beside: i64,
) -> impl Iterator<Item = i64> + use<A, B> {
    let most = driver.right.len().min(driven.right.len()) as i64;
    let beside = beside.min((most - 1) / 2);
    at - beside..=at + beside
}

/// The pairs of a side near the tooth `at` in one section, and the one that touches first.
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
    let pairs = labels(driver, driven, at, TEETH_BESIDE).filter_map(|tooth| {
        let touch = touch(driver.get(side, tooth), driven.get(side, tooth), stand, side)?;
        Some(ToothTouch { tooth, section: 0, touch })
    });
    first_of(pairs.collect(), side, stand.phi_1_rad)
}

/// The pair of a side that touches first.
fn first_of(pairs: Vec<ToothTouch>, side: Side, phi_1_rad: f64) -> Result<SideTouch, Refusal> {
    let push = |pair: &ToothTouch| -side.sign() * pair.touch.error_rad;
    let acting = pairs.iter().copied().max_by(|a, b| push(a).total_cmp(&push(b))).ok_or_else(|| {
        Refusal::new(
            "gear.addendum_coefficient",
            format!("no {} flanks touch with the driver at {:.3} deg", side.name(), phi_1_rad.to_degrees()),
            "use a smaller centre distance or a larger addendum_coefficient",
        )
    })?;
    Ok(SideTouch { error_rad: acting.touch.error_rad, acting, pairs })
}
