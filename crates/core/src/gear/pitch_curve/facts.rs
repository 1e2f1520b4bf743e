//! What a pitch curve is like: its extreme curvatures, its concave zones, its extreme radii.
//!
//! In: r(phi) with three derivatives. Out: [`CurveFacts`], found once per curve. Law: with dots for d/dphi, kappa =
//! (r^2 + 2 r'^2 - r r'') / (r^2 + r'^2)^(3/2), positive where the gear is convex; its extrema are the sign changes of
//! its own derivative, zones are bounded by the sign changes of kappa.

use crate::math::jet::Jet;
use crate::math::roots::{sample_angle_rad, sign_changes};
use crate::units::TURN_RAD;

/// A place of extreme curvature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvatureExtremum {
    /// Polar angle in [0, 2 pi).
    pub phi_rad: f64,
    /// Signed curvature there, positive convex.
    pub curvature_per_mm: f64,
}

/// Shape of a pitch curve.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveFacts {
    /// Smallest radius of curvature without regard to its sign, mm.
    pub smallest_curvature_radius_mm: f64,
    /// Where it is.
    pub smallest_curvature_radius_phi_rad: f64,
    /// Largest signed curvature (the sharpest convex place).
    pub largest_curvature: CurvatureExtremum,
    /// Smallest signed curvature (the flattest or the most concave place).
    pub smallest_curvature: CurvatureExtremum,
    /// All local extrema of the curvature in increasing order of phi; empty for a circle.
    pub curvature_extrema: Vec<CurvatureExtremum>,
    /// Ranges of phi where the curve is concave, begin in [0, 2 pi), end after begin.
    pub concave_zones_rad: Vec<[f64; 2]>,
    /// No concave zone.
    pub convex: bool,
    /// Largest polar radius.
    pub largest_radius_mm: f64,
    /// Smallest polar radius.
    pub smallest_radius_mm: f64,
}

/// Signed curvature and its derivative with respect to phi, from r with three derivatives.
pub(super) fn curvature(radius: &Jet<4>) -> Jet<2> {
    let slopes = radius.differentiate::<3>();
    let (r, dr, ddr) = (radius.truncate::<2>(), slopes.truncate::<2>(), slopes.differentiate::<2>());
    let square = r * r + dr * dr;
    (square + dr * dr - r * ddr) / (square * square.sqrt())
}

impl CurveFacts {
    /// Of a curve, or of its sector alone: then the ends of the sector are among the extremes.
    pub(super) fn new(radius: impl Fn(f64) -> Jet<4>, samples: usize, sector_rad: Option<[f64; 2]>) -> Self {
        let holds = |phi: f64| sector_rad.is_none_or(|[from, to]| (phi - from).rem_euclid(TURN_RAD) <= to - from);
        let ends = || sector_rad.into_iter().flatten();
        let kappa = |phi: f64| curvature(&radius(phi));
        let extremum = |phi_rad: f64| CurvatureExtremum { phi_rad, curvature_per_mm: kappa(phi_rad).value() };
        let mut curvature_extrema: Vec<CurvatureExtremum> =
            sign_changes(|phi| kappa(phi).derivative(1), samples).iter().map(|c| extremum(c.phi_rad)).collect();
        curvature_extrema.retain(|extremum| holds(extremum.phi_rad));
        curvature_extrema.extend(ends().map(extremum));
        let by_curvature =
            |a: &CurvatureExtremum, b: &CurvatureExtremum| a.curvature_per_mm.total_cmp(&b.curvature_per_mm);
        let anywhere = extremum(sector_rad.map_or(sample_angle_rad(1, samples), |[from, _]| from));
        let largest_curvature = curvature_extrema.iter().copied().max_by(by_curvature).unwrap_or(anywhere);
        let smallest_curvature = curvature_extrema.iter().copied().min_by(by_curvature).unwrap_or(anywhere);
        let spread = largest_curvature.curvature_per_mm - smallest_curvature.curvature_per_mm;
        if spread <= 1e-11 * largest_curvature.curvature_per_mm.abs() {
            curvature_extrema.clear(); // a circle; what was found is rounding
        }
        let sharpest = if largest_curvature.curvature_per_mm.abs() >= smallest_curvature.curvature_per_mm.abs() {
            largest_curvature
        } else {
            smallest_curvature
        };
        let within = |zone: [f64; 2]| match sector_rad {
            None => Some(zone),
            Some([from, to]) => {
                let turns = TURN_RAD * ((from - zone[1]) / TURN_RAD).ceil();
                let [a, b] = [(zone[0] + turns).max(from), (zone[1] + turns).min(to)];
                (a < b).then_some([a, b])
            }
        };
        let concave_zones_rad: Vec<[f64; 2]> =
            concave_zones(|phi| kappa(phi).value(), samples).into_iter().filter_map(within).collect();
        let turning = sign_changes(|phi| radius(phi).derivative(1), samples);
        let places = || turning.iter().map(|c| c.phi_rad).filter(|&phi| holds(phi)).chain(ends());
        let radii = || places().chain([anywhere.phi_rad]).map(|phi| radius(phi).value());
        Self {
            smallest_curvature_radius_mm: 1.0 / sharpest.curvature_per_mm.abs(),
            smallest_curvature_radius_phi_rad: sharpest.phi_rad,
            largest_curvature,
            smallest_curvature,
            curvature_extrema,
            convex: concave_zones_rad.is_empty(),
            concave_zones_rad,
            largest_radius_mm: radii().fold(f64::NEG_INFINITY, f64::max),
            smallest_radius_mm: radii().fold(f64::INFINITY, f64::min),
        }
    }
}

/// From every falling sign change of the curvature to the rising one after it.
fn concave_zones(kappa: impl Fn(f64) -> f64, samples: usize) -> Vec<[f64; 2]> {
    let changes = sign_changes(kappa, samples);
    let next = |i: usize| {
        let after = changes[(i + 1) % changes.len()].phi_rad;
        if i + 1 < changes.len() { after } else { after + TURN_RAD }
    };
    (0..changes.len()).filter(|i| !changes[*i].rising).map(|i| [changes[i].phi_rad, next(i)]).collect()
}
