//! r(phi) of each kind of pitch curve, with three derivatives.
//!
//! In: the checked shape. Out: the unit radius u(phi), where r = size * u and the size is the shape's own parameter in
//! mm (semi-major axis, centre distance, mean radius). Each law is written once, as a formula of series ([`Jet`]), and
//! its derivatives follow from it.
//!
//! Sources: n-order ellipse, Gao et al. 2017, Eq. 13; driver of a sinusoidal ratio, Litvin and Fuentes, *Noncircular
//! Gears*, 2009, ch. 2: r = C / (1 + i(phi)) with i the angular speed ratio driver : driven.

use super::formula_law::FormulaLaw;
use super::mate::MateLaw;
use super::sector::{SectorLaw, UnitLaw, check_range};
use crate::error::Refusal;
use crate::gear::{FormulaMeaning, PitchCurveShape, TableScaling};
use crate::math::Jet;
use crate::math::periodic_spline::PeriodicSpline;
use crate::parameter;
use std::sync::Arc;

/// A radius law of unit size.
#[derive(Debug, Clone)]
pub(super) enum RadiusLaw {
    Circle,
    Ellipse { order: f64, eccentricity: f64 },
    SinusoidalRatio { order: f64, mean_ratio: f64, ratio_amplitude: f64 },
    Pascal { order: f64, eccentricity: f64 },
    Fourier { cosine: Vec<f64>, sine: Vec<f64> },
    Table { spline: PeriodicSpline },
    Formula(FormulaLaw),
    Mate(Box<MateLaw>),
    Sector(SectorLaw),
}

/// A law with its size, if one is given.
pub(super) struct SizedLaw {
    pub(super) law: RadiusLaw,
    pub(super) size_mm: Option<f64>,
    /// Name of the shape.
    pub(super) key: &'static str,
    /// Name of its size; the shape's own where it has none.
    pub(super) size_key: &'static str,
}

impl SizedLaw {
    /// Checks the shape's own parameters. Module, teeth and accuracy are for a mate, whose driver must close first.
    pub(super) fn new(shape: &PitchCurveShape, module_mm: f64, teeth: u32, accuracy_mm: f64) -> Result<Self, Refusal> {
        if let PitchCurveShape::Sector { law, range_rad } = shape {
            check_range(*range_rad)?;
            let own = Self::over(law, Some(*range_rad), (module_mm, teeth, accuracy_mm))?;
            let law = RadiusLaw::Sector(SectorLaw::new(Arc::new(own.law), *range_rad, teeth, own.key)?);
            return Ok(Self { law, ..own });
        }
        Self::over(shape, None, (module_mm, teeth, accuracy_mm))
    }

    /// The law of a shape all round, or over a sector alone.
    fn over(
        shape: &PitchCurveShape,
        sector: Option<[f64; 2]>,
        (module_mm, teeth, accuracy_mm): (f64, u32, f64),
    ) -> Result<Self, Refusal> {
        let sized = match shape {
            PitchCurveShape::Circle => {
                let key = parameter::CIRCLE;
                Self { law: RadiusLaw::Circle, size_mm: None, key, size_key: key }
            }
            PitchCurveShape::Ellipse { order, eccentricity, semi_major_axis_mm } => {
                let (order, eccentricity) = (
                    lobes(parameter::ELLIPSE_ORDER, *order)?,
                    below_one(parameter::ELLIPSE_ECCENTRICITY, *eccentricity)?,
                );
                Self {
                    law: RadiusLaw::Ellipse { order, eccentricity },
                    size_mm: *semi_major_axis_mm,
                    key: parameter::ELLIPSE,
                    size_key: parameter::ELLIPSE_SIZE,
                }
            }
            PitchCurveShape::SinusoidalRatio { order, mean_ratio, ratio_amplitude, center_distance_mm } => {
                let order = lobes(parameter::SINUSOIDAL_ORDER, *order)?;
                let (mean_ratio, ratio_amplitude) = (*mean_ratio, *ratio_amplitude);
                let smallest = mean_ratio - ratio_amplitude.abs();
                if smallest.is_nan() || smallest <= 0.0 {
                    return Err(Refusal::new(
                        parameter::SINUSOIDAL_AMPLITUDE,
                        format!("the ratio falls to {smallest}: the driven gear would stop or turn back"),
                        format!("keep the amplitude below the mean ratio {mean_ratio}"),
                    ));
                }
                Self {
                    law: RadiusLaw::SinusoidalRatio { order, mean_ratio, ratio_amplitude },
                    size_mm: *center_distance_mm,
                    key: parameter::SINUSOIDAL_RATIO,
                    size_key: parameter::SINUSOIDAL_SIZE,
                }
            }
            PitchCurveShape::Pascal { order, eccentricity, mean_radius_mm } => {
                let (order, eccentricity) = (
                    lobes(parameter::PASCAL_ORDER, *order)?,
                    below_one(parameter::PASCAL_ECCENTRICITY, *eccentricity)?,
                );
                Self {
                    law: RadiusLaw::Pascal { order, eccentricity },
                    size_mm: *mean_radius_mm,
                    key: parameter::PASCAL,
                    size_key: parameter::PASCAL_SIZE,
                }
            }
            PitchCurveShape::Fourier { cosine, sine, mean_radius_mm } => Self {
                law: RadiusLaw::Fourier { cosine: cosine.clone(), sine: sine.clone() },
                size_mm: *mean_radius_mm,
                key: parameter::FOURIER,
                size_key: parameter::FOURIER_SIZE,
            },
            PitchCurveShape::Table { points_rad_mm, scaling } => {
                let (spline, mean_radius_mm) = PeriodicSpline::new(points_rad_mm, sector)?;
                Self {
                    law: RadiusLaw::Table { spline },
                    size_mm: (*scaling == TableScaling::AsGiven).then_some(mean_radius_mm),
                    key: parameter::TABLE,
                    size_key: parameter::TABLE_SCALING,
                }
            }
            PitchCurveShape::Formula { formula, meaning, size_mm } => {
                let (key, size_key) = match meaning {
                    FormulaMeaning::Radius => (parameter::RADIUS_FORMULA, parameter::RADIUS_FORMULA_SIZE),
                    FormulaMeaning::Ratio(_) => (parameter::RATIO_FORMULA, parameter::RATIO_FORMULA_SIZE),
                };
                Self {
                    law: RadiusLaw::Formula(FormulaLaw::new(formula, *meaning, sector)?),
                    size_mm: *size_mm,
                    key,
                    size_key,
                }
            }
            PitchCurveShape::Mate { .. } | PitchCurveShape::Sector { .. } if sector.is_some() => {
                return Err(Refusal::new(
                    parameter::SECTOR,
                    "the law of a mate is closed all round, with the teeth of its whole turn",
                    "write the radius or the ratio of the sector itself",
                ));
            }
            PitchCurveShape::Sector { .. } => unreachable!("taken above"),
            PitchCurveShape::Mate { driver, kind } => {
                let law = MateLaw::new(driver, *kind, module_mm, teeth, accuracy_mm)?;
                let size_mm = Some(law.center_distance_mm());
                let key = parameter::MATE;
                Self { law: RadiusLaw::Mate(Box::new(law)), size_mm, key, size_key: key }
            }
        };
        if let Some(size_mm) = sized.size_mm.filter(|size_mm| !(size_mm.is_finite() && *size_mm > 0.0)) {
            let problem = format!("{size_mm} mm is not a positive length");
            return Err(Refusal::new(
                sized.size_key,
                problem,
                "leave it out: the size that closes the curve is solved",
            ));
        }
        Ok(sized)
    }
}

/// Number of lobes, at least one.
fn lobes(key: &str, order: u32) -> Result<f64, Refusal> {
    if order == 0 {
        return Err(Refusal::new(key, "order 0 has no lobes", "give 1 or more, or use a circle"));
    }
    Ok(f64::from(order))
}

/// Eccentricity in 0 <= k < 1, where the radius stays positive.
fn below_one(key: &str, eccentricity: f64) -> Result<f64, Refusal> {
    if (0.0..1.0).contains(&eccentricity) {
        return Ok(eccentricity);
    }
    let problem = format!("{eccentricity} is outside 0 <= k < 1: the radius would not stay positive and finite");
    Err(Refusal::new(key, problem, "give a value from 0 to below 1"))
}

impl UnitLaw for RadiusLaw {
    fn unit(&self, phi_rad: f64) -> Jet<4> {
        let wave = |order: f64| (Jet::<4>::variable(phi_rad) * order).sin_cos();
        match self {
            Self::Circle => Jet::constant(1.0),
            Self::Ellipse { order, eccentricity: k } => (wave(*order).1 * -*k + 1.0).recip() * (1.0 - k * k),
            Self::SinusoidalRatio { order, mean_ratio, ratio_amplitude } => {
                (wave(*order).0 * *ratio_amplitude + (1.0 + mean_ratio)).recip()
            }
            Self::Pascal { order, eccentricity } => wave(*order).1 * *eccentricity + 1.0,
            Self::Fourier { cosine, sine } => fourier(cosine, sine, phi_rad),
            Self::Table { spline } => spline.at(phi_rad),
            Self::Formula(law) => law.unit(phi_rad),
            Self::Mate(law) => law.unit(phi_rad),
            Self::Sector(law) => law.unit(phi_rad),
        }
    }

    fn breaks_rad(&self) -> Vec<f64> {
        match self {
            Self::Table { spline } => spline.knots_rad(),
            Self::Mate(law) => law.breaks_rad(),
            Self::Sector(law) => law.breaks_rad(),
            _ => Vec::new(),
        }
    }

    /// 128 per period of the highest harmonic that counts, 8 between knots of a table.
    fn samples_per_turn(&self) -> usize {
        let periods = match self {
            Self::Circle => 1.0,
            Self::Ellipse { order, eccentricity: k } | Self::Pascal { order, eccentricity: k } => {
                order * (1.0 + 4.0 * k)
            }
            Self::SinusoidalRatio { order, mean_ratio, ratio_amplitude } => {
                order * (1.0 + 4.0 * ratio_amplitude.abs() / (1.0 + mean_ratio))
            }
            Self::Fourier { cosine, sine } => 2.0 * cosine.len().max(sine.len()).max(1) as f64,
            Self::Formula(law) => law.harmonics,
            Self::Table { spline } => return (8 * spline.knots_rad().len()).max(1024),
            Self::Mate(law) => return law.samples_per_turn().max(1024),
            Self::Sector(law) => return law.samples_per_turn().max(1024),
        };
        ((128.0 * periods).ceil() as usize).max(1024)
    }
}

/// 1 + sum of c_j cos(j phi) + s_j sin(j phi), each harmonic's derivatives by turning its phase.
fn fourier(cosine: &[f64], sine: &[f64], phi_rad: f64) -> Jet<4> {
    let mut derivatives = [1.0, 0.0, 0.0, 0.0];
    for j in 1..=cosine.len().max(sine.len()) {
        let (c, s) = (cosine.get(j - 1).copied().unwrap_or(0.0), sine.get(j - 1).copied().unwrap_or(0.0));
        let order = j as f64;
        let (sin, cos) = (order * phi_rad).sin_cos();
        let (even, odd) = (c * cos + s * sin, order * (s * cos - c * sin));
        derivatives[0] += even;
        derivatives[1] += odd;
        derivatives[2] -= order * order * even;
        derivatives[3] -= order * order * odd;
    }
    Jet::from_derivatives(derivatives)
}
