//! Traditional linkage: the finish motion, with the cutter held back by the offset.
//!
//! In: the rolling pitch curve, r_c and the offset delta_d, both negative in a ring. Out: axis positions. Law (Gao et
//! al. 2017, Eq. 1 to 8): alpha and beta of the finish position (delta_d = 0 in the formulas of
//! [`crate::process::shaping::linkage::normal`]), and l + delta_d. The offset moves the cutter along the line of
//! centres, which the normal of the pitch curve leaves by beta: the two flanks of a space get unequal allowances. The
//! paper's Eq. 8, r sin alpha = r' sin alpha', holds for this reading: the instantaneous centre moves parallel to the
//! line of centres.
//!
//! A second reading is kept for comparison: the offset along the polar radius of the pitch point, orientation as in
//! finishing. The cutter centre is then (r + r_c sin mu + delta_d, -r_c cos mu) in the frame of the polar radius, and
//! psi_b = S/r_c + mu - pi/2 + alpha_p keeps the orientation. It gives 200 % unevenness, against the 132 % printed.

use super::axes::Axes;
use crate::process::shaping::linkage::normal::{alpha, beta, center_distance};
use crate::process::shaping::scene::model::TraditionalDirection;
use gearcut_core::gear::Rolling;
use gearcut_core::math::Jet;

/// Angle from the polar radius of the pitch point to the cutter centre.
pub(super) fn work_lag<const N: usize>(
    rolling: &Rolling<N>,
    cutter_pitch_radius_mm: f64,
    offset_mm: Jet<N>,
    direction: TraditionalDirection,
) -> Jet<N> {
    let Rolling { r, dr, ds, .. } = *rolling;
    match direction {
        TraditionalDirection::CenterLine => alpha(rolling, Jet::constant(cutter_pitch_radius_mm)),
        TraditionalDirection::PolarRadius => {
            (dr * cutter_pitch_radius_mm).atan2(&((r + offset_mm) * ds + r * cutter_pitch_radius_mm))
        }
    }
}

/// Axis positions.
pub(super) fn axes<const N: usize>(
    rolling: &Rolling<N>,
    arc: Jet<N>,
    cutter_pitch_radius_mm: f64,
    offset_mm: Jet<N>,
    direction: TraditionalDirection,
) -> Axes<N> {
    let Rolling { phi, r, dr, ds, .. } = *rolling;
    let finish = Jet::constant(cutter_pitch_radius_mm);
    let lag = work_lag(rolling, cutter_pitch_radius_mm, offset_mm, direction);
    let roll = arc * (1.0 / cutter_pitch_radius_mm);
    let (psi_b_rad, center_distance_mm) = match direction {
        TraditionalDirection::CenterLine => {
            (roll - beta(rolling, finish), center_distance(rolling, finish) + offset_mm)
        }
        TraditionalDirection::PolarRadius => {
            let along = r + offset_mm + r * cutter_pitch_radius_mm / ds;
            let across = dr * cutter_pitch_radius_mm / ds;
            (roll - dr.atan2(&r) + lag, (along * along + across * across).sqrt())
        }
    };
    Axes { psi_c_rad: phi - lag, psi_b_rad, center_distance_mm }
}
