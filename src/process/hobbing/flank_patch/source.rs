//! What a patch of a target flank is made from: the flank itself, section by section, and places to compare them at.

use super::chebyshev::{PARTS, chebyshev};
use super::{FlankPatch, PANELS};
use crate::process::hobbing::rack_generation::RackGeneration;
use gearcut_core::dexel::Ray;
use gearcut_core::gear::blank::Blank;
use gearcut_core::math::roots::halve;
use gearcut_core::terms::Side;
use glam::DVec3;
use std::f64::consts::PI;

/// Gauss-Legendre rule on [-1, 1], eight points: half of the nodes with their weights.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_3),
];

/// What a patch is made from.
pub(super) struct Source<'a> {
    pub generation: &'a RackGeneration,
    pub blank: &'a Blank,
    pub space: i64,
    pub side: Side,
    pub face_width_mm: f64,
    pub form_roll_mm: f64,
}

impl Source<'_> {
    /// Lengths of the middle section's profile up to the panels' ends.
    pub fn lengths_mm(&self, tip_roll_mm: f64) -> Vec<f64> {
        let half = 0.5 * (tip_roll_mm - self.form_roll_mm) / PANELS as f64;
        let speed = |roll: f64| self.generation.flank_contact(self.space, self.side, roll, 0.0).length_per_roll;
        let mut lengths_mm = vec![0.0];
        for panel in 0..PANELS {
            let middle = self.form_roll_mm + half * (2 * panel + 1) as f64;
            let sum: f64 = GAUSS
                .iter()
                .map(|&(node, weight)| weight * (speed(middle - half * node) + speed(middle + half * node)))
                .sum();
            lengths_mm.push(lengths_mm[panel] + (half * sum).abs());
        }
        lengths_mm
    }

    pub fn tip_roll_mm(&self, z_mm: f64) -> Option<f64> {
        let height = |roll: f64| {
            let contact = self.generation.flank_contact(self.space, self.side, roll, z_mm);
            self.blank.height(contact.point_mm.truncate(), contact.phi_rad).0 - self.blank.addendum_mm
        };
        // Towards the tip the roll has the other sign; heights climb steadily.
        let module_mm = self.generation.rack.transverse_module_mm;
        let farthest = -self.side.sign() * 8.0 * module_mm;
        if height(farthest) < 0.0 {
            return None;
        }
        let [low, high] = halve(|roll| height(roll) < 0.0, 0.0, farthest, 60);
        Some(0.5 * (low + high))
    }

    /// Point and normal at a share of the roll in a section.
    fn at(&self, share: f64, z_mm: f64, tip_roll_mm: f64) -> [f64; PARTS] {
        let roll = self.form_roll_mm + share * (tip_roll_mm - self.form_roll_mm);
        let contact = self.generation.flank_contact(self.space, self.side, roll, z_mm);
        let (p, n) = (contact.point_mm, contact.normal);
        [p.x, p.y, p.z, n.x, n.y, n.z]
    }

    pub fn coefficients(&self, terms: usize) -> Option<Vec<Vec<[f64; PARTS]>>> {
        let node = |i: usize| (PI * (i as f64 + 0.5) / terms as f64).cos();
        let mut rows = Vec::new();
        for j in 0..terms {
            let z_mm = 0.5 * self.face_width_mm * node(j);
            let tip = self.tip_roll_mm(z_mm)?;
            let values: Vec<[f64; PARTS]> = (0..terms).map(|i| self.at(0.5 + 0.5 * node(i), z_mm, tip)).collect();
            rows.push(chebyshev(&values));
        }
        // Coefficients along the profile, each expanded along the tooth.
        Some((0..terms).map(|k| chebyshev(&rows.iter().map(|row| row[k]).collect::<Vec<_>>())).collect())
    }

    /// Places between the nodes at which patches are compared with the flank; none in a section without a tip.
    pub fn checks(&self) -> Vec<Option<Check>> {
        let section = |z: f64| {
            let z_mm = 0.5 * self.face_width_mm * z;
            let tip = self.tip_roll_mm(z_mm);
            [0.0, 0.02, 0.31, 0.66, 0.98, 1.0].map(|share| {
                let [x, y, z, nx, ny, nz] = self.at(share, z_mm, tip?);
                Some(Check {
                    z_mm,
                    share,
                    exact: Ray { origin_mm: DVec3::new(x, y, z), normal: DVec3::new(nx, ny, nz) },
                })
            })
        };
        [-1.0, -0.93, -0.41, 0.17, 0.77, 1.0].into_iter().flat_map(section).collect()
    }
}

/// A place of the flank itself.
pub(super) struct Check {
    z_mm: f64,
    share: f64,
    exact: Ray,
}

/// Largest distance of a patch from the flank at these places.
pub(super) fn error_mm(checks: &[Option<Check>], patch: &FlankPatch) -> f64 {
    let error = |check: &Check| {
        let ray = patch.section(check.z_mm).ray(check.share);
        // A turn of the normal moves what stands a millimetre above the flank.
        ray.origin_mm.distance(check.exact.origin_mm).max(ray.normal.distance(check.exact.normal))
    };
    checks.iter().map(|check| check.as_ref().map_or(f64::INFINITY, error)).fold(0.0, f64::max)
}
