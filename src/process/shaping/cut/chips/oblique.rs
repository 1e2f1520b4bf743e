//! Force coefficients of an edge element whose rake face leans: oblique cutting.
//!
//! In: the coefficients of the material, the cutter's top rake, a place of the edge. Out: [`ElementForce`] with all
//! three components.
//!
//! **Geometry.** The edge is known by its projection on the transverse plane; the cutting motion is square to it. A
//! cutter with top rake gamma has a dished, conical rake face, whose height along the cutting motion grows with the
//! distance rho from the cutter axis, z = rho tan gamma. With t along and n across the projected edge, n out of the
//! tool, and e away from the axis:
//!
//! `tan(inclination) = tan(gamma) (t . e)`, `tan(normal rake) = tan(gamma) (n . e) cos(inclination)`.
//!
//! So the tip circle cuts square to its motion with the full rake, and flanks are inclined by nearly gamma with little
//! rake. At gamma = 0 inclination and rake vanish everywhere: this holds for every flat face square to the stroke,
//! whatever the profile.
//!
//! **Law.** The classical transformation from orthogonal cutting (E. J. A. Armarego, R. C. Whitfield, CIRP Annals 34,
//! 1985; Y. Altintas, *Manufacturing Automation*, 2nd ed. 2012, section 2.9). The coefficients hold where the
//! inclination is zero and the rake is gamma. From them come the friction angle beta, tan(beta - gamma) = K_n / K_c,
//! the shear angle by Merchant (1945), phi = pi/4 - (beta - rake)/2, and the shear stress. With these, chip flow by
//! Stabler (1964), eta = inclination i, and tan(beta_n) = tan(beta) cos(eta):
//!
//! ```text
//! c   = sqrt(cos^2(phi + beta_n - rake_n) + tan^2(eta) sin^2(beta_n))
//! K_c = tau / sin(phi)         (cos(beta_n - rake_n) + tan(i) tan(eta) sin(beta_n)) / c     against the motion
//! K_n = tau / (sin(phi) cos(i)) sin(beta_n - rake_n) / c                                      on the tool, against n
//! K_t = tau / sin(phi)         (cos(beta_n - rake_n) tan(i) - tan(eta) sin(beta_n)) / c     on the tool, along t
//! ```
//!
//! The edge's own coefficients K_ce and K_ne stay as they are, and have no part along the edge.

use crate::material::EdgeForce;
use crate::process::shaping::tool::edge_polygon::Station;
use glam::DVec2;
use std::f64::consts::FRAC_PI_4;

/// How the rake face leans at a place of the edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RakeFace {
    /// Of the edge against the plane square to the motion, rad; positive where the edge runs ahead along t, a quarter
    /// turn counter-clockwise from n.
    pub inclination_rad: f64,
    /// Rake in the plane square to the edge, rad.
    pub normal_rake_rad: f64,
}

/// Force on an edge element by its uncut chip thickness and its length in projection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementForce {
    /// K_c, K_n, K_t: N/mm^2.
    pub chip_n_per_mm2: [f64; 3],
    /// K_ce, K_ne: N/mm.
    pub edge_n_per_mm: [f64; 2],
}

impl RakeFace {
    /// On a cone with this top rake; point (from the cutter axis, mm) and unit normal out of the tool in projection.
    pub fn on_cone(top_rake_rad: f64, point_mm: DVec2, normal: DVec2) -> Self {
        let (slope, away) = (top_rake_rad.tan(), point_mm.normalize_or_zero());
        let inclination_rad = (slope * normal.perp().dot(away)).atan();
        let normal_rake_rad = (slope * normal.dot(away) * inclination_rad.cos()).atan();
        Self { inclination_rad, normal_rake_rad }
    }
}

/// Friction angle and shear stress of orthogonal cutting, and the shear angle that goes with a rake.
#[derive(Debug, Clone, Copy)]
struct Shear {
    friction_rad: f64,
    stress_n_per_mm2: f64,
}

impl Shear {
    fn of(force: &EdgeForce, rake_rad: f64) -> Self {
        let lean_rad = (force.normal_n_per_mm2 / force.cutting_n_per_mm2).atan();
        let shear_rad = FRAC_PI_4 - 0.5 * lean_rad;
        let stress_n_per_mm2 =
            force.cutting_n_per_mm2 * shear_rad.sin() * (shear_rad + lean_rad).cos() / lean_rad.cos();
        Self { friction_rad: lean_rad + rake_rad, stress_n_per_mm2 }
    }

    fn shear_rad(&self, rake_rad: f64) -> f64 {
        FRAC_PI_4 - 0.5 * (self.friction_rad - rake_rad)
    }
}

impl ElementForce {
    /// At every station of an edge with a conical rake face.
    pub fn along_edge(force: &EdgeForce, top_rake_rad: f64, stations: &[Station]) -> Vec<Self> {
        let at = |station: &Station| {
            let face = RakeFace::on_cone(top_rake_rad, station.point_mm, station.normal);
            Self::new(force, top_rake_rad, face)
        };
        stations.iter().map(at).collect()
    }

    /// For a place whose rake face leans, from coefficients that hold at zero inclination and the rake `top_rake_rad`.
    pub fn new(force: &EdgeForce, top_rake_rad: f64, face: RakeFace) -> Self {
        let edge_n_per_mm = [force.cutting_edge_n_per_mm, force.normal_edge_n_per_mm];
        // Where chips cost nothing there is no friction to speak of.
        if force.cutting_n_per_mm2 <= 0.0 {
            return Self { chip_n_per_mm2: [0.0, force.normal_n_per_mm2, 0.0], edge_n_per_mm };
        }
        let shear = Shear::of(force, top_rake_rad);
        let RakeFace { inclination_rad, normal_rake_rad } = face;
        let phi = shear.shear_rad(normal_rake_rad);
        let tan_flow = inclination_rad.tan();
        let friction_n = (shear.friction_rad.tan() * inclination_rad.cos()).atan();
        let lean = friction_n - normal_rake_rad;
        let side = tan_flow * friction_n.sin();
        let scale = shear.stress_n_per_mm2 / phi.sin() / (phi + lean).cos().hypot(side);
        let chip_n_per_mm2 = [
            scale * (lean.cos() + tan_flow * side),
            scale * lean.sin() / inclination_rad.cos(),
            scale * (lean.cos() * tan_flow - side),
        ];
        Self { chip_n_per_mm2, edge_n_per_mm }
    }

    /// Against the motion, against n, and along t, N.
    pub fn on_element(&self, thickness_mm: f64, length_mm: f64) -> [f64; 3] {
        let [cutting, normal, along] = self.chip_n_per_mm2.map(|k| k * thickness_mm * length_mm);
        let [cutting_edge, normal_edge] = self.edge_n_per_mm.map(|k| k * length_mm);
        [cutting + cutting_edge, normal + normal_edge, along]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::MATERIALS;
    use glam::DVec3;

    #[test]
    fn a_square_edge_with_the_cutters_rake_keeps_the_coefficients() {
        for material in MATERIALS {
            for rake_rad in [0.0, 0.1, -0.05] {
                let force = material.edge_force();
                let face = RakeFace { inclination_rad: 0.0, normal_rake_rad: rake_rad };
                let [cutting, normal, along] = ElementForce::new(&force, rake_rad, face).chip_n_per_mm2;
                assert!((cutting / force.cutting_n_per_mm2 - 1.0).abs() < 1e-12);
                assert!((normal / force.normal_n_per_mm2 - 1.0).abs() < 1e-12 && along == 0.0);
            }
        }
    }

    /// Statics in space, without the formulas: rake face, chip flow and shear plane as vectors; friction pulls along
    /// the flow, and what is left in the shear plane is its area times the shear stress.
    #[test]
    fn inclined_elements_are_in_equilibrium() {
        let force = MATERIALS[0].edge_force();
        let (n, t, v) = (DVec3::X, DVec3::Y, DVec3::Z);
        let mut largest_along: f64 = 0.0;
        for top_rake_rad in [0.0, 0.09, 0.2] {
            for inclination_rad in [-0.5, -0.1, 0.0, 0.08, 0.35] {
                for normal_rake_rad in [-0.1, 0.0, 0.03, 0.15] {
                    let face = RakeFace { inclination_rad, normal_rake_rad };
                    let ours = ElementForce::new(&force, top_rake_rad, face).chip_n_per_mm2;
                    let shear = Shear::of(&force, top_rake_rad);
                    let (sin, cos) = inclination_rad.sin_cos();
                    let (edge, ahead) = (cos * t + sin * v, cos * v - sin * t);
                    let rake_normal = normal_rake_rad.cos() * ahead - normal_rake_rad.sin() * n;
                    let up_the_rake = -normal_rake_rad.cos() * n - normal_rake_rad.sin() * ahead;
                    let flow = cos * up_the_rake - sin * edge;
                    let resultant = -rake_normal + shear.friction_rad.tan() * flow;
                    let phi = shear.shear_rad(normal_rake_rad);
                    let shear_normal = phi.sin() * ahead + phi.cos() * n;
                    let in_plane = (resultant - resultant.dot(shear_normal) * shear_normal).length();
                    // One mm of edge in projection, one mm thick.
                    let area_mm2 = 1.0 / (cos * phi.sin());
                    let on_tool = resultant * (shear.stress_n_per_mm2 * area_mm2 / in_plane);
                    let exact = [-on_tool.dot(v), -on_tool.dot(n), on_tool.dot(t)];
                    for (ours, exact) in ours.into_iter().zip(exact) {
                        assert!(
                            (ours - exact).abs() < 1e-9 * exact.abs().max(ours.abs()).max(1.0),
                            "{ours} {exact} {face:?}"
                        );
                    }
                    largest_along = largest_along.max(ours[2].abs());
                }
            }
        }
        assert!(largest_along > 0.1 * force.cutting_n_per_mm2);
    }

    #[test]
    fn a_cone_inclines_the_flanks_and_not_the_tip() {
        let rake_rad = 5_f64.to_radians();
        let tip = RakeFace::on_cone(rake_rad, DVec2::new(33.0, 0.0), DVec2::X);
        assert!(tip.inclination_rad == 0.0 && (tip.normal_rake_rad - rake_rad).abs() < 1e-15);
        // Flanks whose normals stand 70 degrees off the centre line, left and right.
        for side in [1.0, -1.0] {
            let normal = DVec2::from_angle(side * 70_f64.to_radians());
            let flank = RakeFace::on_cone(rake_rad, DVec2::new(30.0, 0.0), normal);
            let expected = -side * (rake_rad.tan() * 70_f64.to_radians().sin()).atan();
            assert!((flank.inclination_rad - expected).abs() < 1e-15);
            assert!(
                (flank.normal_rake_rad.tan() - rake_rad.tan() * 70_f64.to_radians().cos() * expected.cos()).abs()
                    < 1e-15
            );
        }
        assert_eq!(
            RakeFace::on_cone(0.0, DVec2::new(30.0, 2.0), DVec2::Y),
            RakeFace { inclination_rad: 0.0, normal_rake_rad: 0.0 }
        );
    }
}
