//! Normal linkage: the cutter stays back along the normal of the pitch curve.
//!
//! In: the rolling pitch curve, r_c and the offset delta_d, both negative in a ring. Out: axis positions. Law, with d =
//! r_c + delta_d (Gao et al. 2017, Eq. 9, 10 and 12, which all have the form of Eq. 1 with d for r_c):
//!
//! ```text
//! alpha' = atan2(d cos mu, r + d sin mu)     psi_c = phi - alpha'
//! beta'  = atan2(r cos mu, r sin mu + d)     psi_b = S / r_c - beta'
//! l      = |P + d n| = sqrt(r^2 + 2 r d sin mu + d^2)
//! ```
//!
//! With cos mu = r'/s' and sin mu = r/s' (s' = ds/dphi) no angle mu is needed. The orientation of the cutter in the
//! gear frame, psi_c + pi + psi_b = phi + mu + pi/2 + S/r_c, does not contain d: the rough position is the finish
//! position moved along the normal, which is what evens the allowance out.
//!
//! As printed, Eq. 12 has beta (without the offset) in psi_b. The cutter is then also turned by beta - beta' against
//! the normal offset, up to 0.17 mm on the pitch circle of the paper's example, and the unevenness of the allowance is
//! 43.6 % instead of 4.0 %: kept as a reading of its own, to show that.
//!
//! The inverse work angle is one to one while 1 + d kappa > 0, since psi_c' = s' (1 + d kappa) (r sin mu + d) / l^2; in
//! a ring the last factor must be positive too, the cutter's centre on this side of the gear axis.

use super::axes::Axes;
use crate::process::shaping::scene::model::NormalReading;
use gearcut_core::gear::Rolling;
use gearcut_core::math::Jet;

/// alpha', from the polar radius of the pitch point to the cutter centre.
pub(super) fn alpha<const N: usize>(rolling: &Rolling<N>, d: Jet<N>) -> Jet<N> {
    let Rolling { r, dr, ds, .. } = *rolling;
    (d * dr).atan2(&(r * ds + d * r))
}

/// beta', between the line of centres and the normal of the pitch curve, seen from the cutter centre.
pub(super) fn beta<const N: usize>(rolling: &Rolling<N>, d: Jet<N>) -> Jet<N> {
    let Rolling { r, dr, ds, .. } = *rolling;
    (r * dr).atan2(&(r * r + d * ds))
}

/// Distance of the point P + d n from the work axis.
pub(super) fn center_distance<const N: usize>(rolling: &Rolling<N>, d: Jet<N>) -> Jet<N> {
    let Rolling { r, ds, .. } = *rolling;
    (r * r + d * d + r * r * d * 2.0 / ds).sqrt()
}

/// Axis positions.
pub(super) fn axes<const N: usize>(
    rolling: &Rolling<N>,
    arc: Jet<N>,
    cutter_pitch_radius_mm: f64,
    offset_mm: Jet<N>,
    reading: NormalReading,
) -> Axes<N> {
    let d = offset_mm + cutter_pitch_radius_mm;
    let beta = match reading {
        NormalReading::Corrected => beta(rolling, d),
        NormalReading::AsPrinted => beta(rolling, Jet::constant(cutter_pitch_radius_mm)),
    };
    Axes {
        psi_c_rad: rolling.phi - alpha(rolling, d),
        psi_b_rad: arc * (1.0 / cutter_pitch_radius_mm) - beta,
        center_distance_mm: center_distance(rolling, d),
    }
}
