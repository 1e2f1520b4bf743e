//! The pitch curve as a linkage law sees it: polar angle, radius and arc as series in the law's parameter.
//!
//! The parameter is the polar angle phi itself, or time or stroke when phi is a series in them: derivatives then follow
//! by the chain rule without further formulas.

use super::PitchCurve;
use crate::math::Jet;

/// The pitch curve as seen by a linkage law: series in the parameter.
#[derive(Debug, Clone, Copy)]
pub struct Rolling<const N: usize> {
    /// phi, rad.
    pub phi: Jet<N>,
    /// r, mm.
    pub r: Jet<N>,
    /// r' = dr/dphi, mm.
    pub dr: Jet<N>,
    /// s' = ds/dphi, mm.
    pub ds: Jet<N>,
    /// r as a series in phi.
    radius: Jet<4>,
}

impl<const N: usize> Rolling<N> {
    /// The curve where phi is the given series in the parameter; N <= 3.
    pub fn new(curve: &PitchCurve, phi: Jet<N>) -> Self {
        let radius = curve.radius(phi.value());
        let r = radius.truncate::<N>().compose(&phi);
        let dr = radius.differentiate::<N>().compose(&phi);
        Self { phi, r, dr, ds: (r * r + dr * dr).sqrt(), radius }
    }

    /// Arc length S in mm as a series in the parameter.
    pub fn arc(&self, curve: &PitchCurve) -> Jet<N> {
        let phi = self.phi.value();
        let (r, dr) = (self.radius.truncate::<3>(), self.radius.differentiate::<3>());
        (r * r + dr * dr).sqrt().integrate::<4>(curve.arc_mm(phi)).truncate::<N>().compose(&self.phi)
    }
}
