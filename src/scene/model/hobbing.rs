//! Checked values of hobbing scenes: the hob.

/// Hand of a helix: of the gear's teeth or of the hob's thread.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hand {
    /// Rises to the right when seen with the axis upright.
    Right,
    /// Rises to the left.
    Left,
}

impl Hand {
    /// +1 for right, -1 for left.
    pub fn sign(self) -> f64 {
        match self {
            Self::Right => 1.0,
            Self::Left => -1.0,
        }
    }

    /// `right` or `left`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Left => "left",
        }
    }
}

/// A hob; module and pressure angle are the gear's, both normal.
#[derive(Debug, Clone, PartialEq)]
pub struct Hob {
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
    /// Radius of the tip round in the rake face, mm; 0: sharp.
    pub tip_radius_mm: f64,
    /// Protuberance, if the hob has one.
    pub protuberance: Option<Protuberance>,
    /// Normal thickness taken off every tooth on the pitch cylinder, as on a roughing hob, mm.
    pub thinning_mm: f64,
    /// How much the radius has shrunk by regrinding, mm.
    pub regrind_mm: f64,
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
    /// Straight in the axial section (ZA): the straight-sided basic rack as many hobs are ground; cuts nearly an involute.
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
    /// As printed: extra rotation v_z tan(beta) / r of the work alone. Wrong on curves that are no circles; kept to show what it does.
    AsPrinted,
}
