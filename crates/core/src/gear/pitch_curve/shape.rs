//! Which kind of curve a pitch curve is, and its sizes.

use crate::gear::GearKind;
use crate::math::formula::Formula;

/// Shape of the closed pitch curve r(phi). A size left out (`None`) is solved so that the curve closes: perimeter = pi
/// m z.
#[derive(Debug, Clone, PartialEq)]
pub enum PitchCurveShape {
    /// r = m z / 2.
    Circle,
    /// r = a (1 - k^2) / (1 - k cos(n phi)); Gao et al. 2017, Eq. 13.
    Ellipse {
        /// n >= 1.
        order: u32,
        /// k, 0 <= k < 1.
        eccentricity: f64,
        /// a.
        semi_major_axis_mm: Option<f64>,
    },
    /// Driver of a pair whose ratio is i(phi) = c + b sin(n phi): r = C / (1 + i).
    SinusoidalRatio {
        /// n >= 1.
        order: u32,
        /// c.
        mean_ratio: f64,
        /// b, smaller than c.
        ratio_amplitude: f64,
        /// C.
        center_distance_mm: Option<f64>,
    },
    /// Pascal's limacon, r = R (1 + k cos(n phi)).
    Pascal {
        /// n >= 1.
        order: u32,
        /// k, 0 <= k < 1.
        eccentricity: f64,
        /// R.
        mean_radius_mm: Option<f64>,
    },
    /// r = R (1 + sum of c_j cos(j phi) + s_j sin(j phi)), j = 1, 2, ...
    Fourier {
        /// c_1, c_2, ... relative to R.
        cosine: Vec<f64>,
        /// s_1, s_2, ... relative to R.
        sine: Vec<f64>,
        /// R.
        mean_radius_mm: Option<f64>,
    },
    /// Periodic spline through given points.
    Table {
        /// Polar angles (rad, increasing, within one turn) and radii (mm).
        points_rad_mm: Vec<[f64; 2]>,
        /// How the radii become a curve that closes.
        scaling: TableScaling,
    },
    /// r(phi) by a formula; see [`FormulaMeaning`].
    Formula {
        /// The formula.
        formula: Formula,
        /// What its values are.
        meaning: FormulaMeaning,
        /// C of the ratio, or what the radius is multiplied by.
        size_mm: Option<f64>,
    },
    /// The gear that runs with a driver; see [`super::mate`].
    Mate {
        /// The gear it runs with.
        driver: Box<Driver>,
        /// External: r2 = a - r1. Internal: r2 = a + r1.
        kind: GearKind,
    },
    /// A part of the turn with teeth; see [`super::sector`].
    Sector {
        /// Law over that part; its size is solved so that the part carries the teeth.
        law: Box<PitchCurveShape>,
        /// First and last polar angle, rad.
        range_rad: [f64; 2],
    },
}

/// What the values of a formula of phi are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FormulaMeaning {
    /// The radius over its scale.
    Radius,
    /// The angular speed i of the gear over that of its mate: r = C / (1 + i) outside, C / (1 - i) of a ring.
    Ratio(GearKind),
}

/// How far the radii of a table may be scaled so that the perimeter is pi m z.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableScaling {
    /// By no more than rounding and measuring explain, [`LARGEST_UNASKED_SCALING`]: more is another gear.
    Small,
    /// By any factor.
    Any,
    /// Not at all: the points are the curve.
    AsGiven,
}

/// Radii of a table are scaled by no larger share than this where the scene does not ask for it.
pub const LARGEST_UNASKED_SCALING: f64 = 0.01;

/// The gear that a mate runs with.
#[derive(Debug, Clone, PartialEq)]
pub struct Driver {
    /// Its pitch curve.
    pub curve: PitchCurveShape,
    /// Its number of teeth.
    pub teeth: u32,
    /// Polar angle of the driver that meets the mate's polar angle 0, rad; `None`: the middle of the driver's first
    /// tooth.
    pub start_rad: Option<f64>,
}

impl PitchCurveShape {
    /// Mean radius of the points of a table that is scaled, mm, and how far it may be.
    pub(super) fn scaled_from_mm(&self) -> Option<(f64, TableScaling)> {
        match self {
            Self::Sector { law, .. } => law.scaled_from_mm(),
            Self::Table { points_rad_mm, scaling } if *scaling != TableScaling::AsGiven => {
                let sum_mm: f64 = points_rad_mm.iter().map(|[_, radius_mm]| radius_mm).sum();
                Some((sum_mm / points_rad_mm.len() as f64, *scaling))
            }
            _ => None,
        }
    }

    /// The shape itself, or the law of a sector.
    pub fn law(&self) -> &Self {
        match self {
            Self::Sector { law, .. } => law,
            _ => self,
        }
    }

    /// The shape in words, such as "ellipse of order 3, eccentricity 0.1348".
    pub fn words(&self) -> String {
        match self {
            Self::Circle => "circle".to_owned(),
            Self::Ellipse { order, eccentricity, .. } => {
                format!("ellipse of order {order}, eccentricity {eccentricity}")
            }
            Self::SinusoidalRatio { order, mean_ratio, ratio_amplitude, .. } => {
                let sign = if *ratio_amplitude < 0.0 { '-' } else { '+' };
                format!("driver of the ratio {mean_ratio} {sign} {} sin({order} phi)", ratio_amplitude.abs())
            }
            Self::Pascal { order, eccentricity, .. } => {
                format!("Pascal's limacon of order {order}, eccentricity {eccentricity}")
            }
            Self::Fourier { cosine, sine, .. } => {
                format!("Fourier series with {} harmonics", cosine.len().max(sine.len()))
            }
            Self::Table { points_rad_mm, .. } => {
                format!("spline through {} points", points_rad_mm.len())
            }
            Self::Formula { formula, meaning, .. } => match meaning {
                FormulaMeaning::Radius => format!("radius by the formula {}", formula.text()),
                FormulaMeaning::Ratio(_) => format!("driver of the ratio {}", formula.text()),
            },
            Self::Sector { law, range_rad } => {
                let [from_deg, to_deg] = range_rad.map(|phi| (1e9 * phi.to_degrees()).round() / 1e9);
                format!("sector from {from_deg} to {to_deg} deg, {}", law.words())
            }
            Self::Mate { driver, .. } => format!("mate of {} teeth: {}", driver.teeth, driver.curve.words()),
        }
    }
}
