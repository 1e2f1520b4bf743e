//! Cutting forces from uncut chip thickness, edge element by edge element.
//!
//! Law (linear edge force model: Armarego and Brown 1969; Altintas, Manufacturing Automation, 2012, section 2.4): an
//! edge element of length b with uncut chip thickness h feels
//!
//! `F_c = (K_c h + K_ce) b` against its motion, and `F_n = (K_n h + K_ne) b` along its normal, away from the work.
//!
//! The coefficients belong to an element square to the cutting motion, with the rake of the cutter's tip; what becomes
//! of them on inclined flanks belongs to the chip ledger.
//!
//! **Built-in materials** come from Kienzle's law F_c = k_c1.1 b h^(1 - m_c) (Kienzle and Victor 1957; constants after
//! König and Essel 1973, as shop tables print them), turned into a line by least squares of the relative error over
//! [`FITTED_MM`], the thicknesses that shaping meets; it stays within 15 % of the law there and lies 30 % above it at
//! 0.3 mm. Kienzle's constants were measured at 0.05 mm and more; below that the line is an extrapolation. They hold
//! for sharp carbide at about 100 m/min; high-speed steel at shaping speeds and worn edges need 10 to 30 % more. F_n is
//! taken as [`NORMAL_SHARE`] of F_c: friction coefficient 0.5 at zero rake (Merchant 1945: F_n / F_c = tan(friction
//! angle - rake)). Whoever needs better numbers gives measured ones in the scene.

/// Thicknesses over which Kienzle's law becomes a line, mm.
pub const FITTED_MM: [f64; 2] = [0.01, 0.1];
/// F_n over F_c of the built-in materials.
pub const NORMAL_SHARE: f64 = 0.5;

/// A material by Kienzle's constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kienzle {
    /// Name as scenes write it.
    pub name: &'static str,
    /// Force on a chip of 1 mm by 1 mm, N/mm^2.
    pub force_n_per_mm2: f64,
    /// m_c.
    pub exponent: f64,
}

/// Built-in materials: the first is the default.
pub const MATERIALS: [Kienzle; 4] = [
    Kienzle { name: "16MnCr5", force_n_per_mm2: 2100.0, exponent: 0.26 },
    Kienzle { name: "42CrMo4", force_n_per_mm2: 2500.0, exponent: 0.26 },
    Kienzle { name: "18CrNi8", force_n_per_mm2: 2260.0, exponent: 0.30 },
    Kienzle { name: "C45", force_n_per_mm2: 2220.0, exponent: 0.14 },
];
/// Their names.
pub const MATERIAL_NAMES: [&str; 4] = [MATERIALS[0].name, MATERIALS[1].name, MATERIALS[2].name, MATERIALS[3].name];

/// Coefficients of the linear edge force model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeForce {
    /// K_c, N/mm^2.
    pub cutting_n_per_mm2: f64,
    /// K_ce, N/mm.
    pub cutting_edge_n_per_mm: f64,
    /// K_n, N/mm^2.
    pub normal_n_per_mm2: f64,
    /// K_ne, N/mm.
    pub normal_edge_n_per_mm: f64,
}

impl Kienzle {
    /// The built-in material of this name.
    pub fn named(name: &str) -> Option<Self> {
        MATERIALS.into_iter().find(|material| material.name == name)
    }

    /// Cutting force per length of edge, N/mm.
    #[cfg(feature = "testing")]
    pub fn force_n_per_mm(&self, thickness_mm: f64) -> f64 {
        self.force_n_per_mm2 * thickness_mm.powf(1.0 - self.exponent)
    }

    /// The line nearest to Kienzle's law over [`FITTED_MM`]: least squares of (K h + E) / F - 1, in closed form.
    pub fn edge_force(&self) -> EdgeForce {
        let [a, b] = FITTED_MM;
        let power = 1.0 - self.exponent;
        // Integral of h^p over the fitted thicknesses.
        let moment = |p: f64| (b.powf(p + 1.0) - a.powf(p + 1.0)) / (p + 1.0);
        let (k, k2) = (self.force_n_per_mm2, self.force_n_per_mm2 * self.force_n_per_mm2);
        let [hh, h1, ones] = [2.0, 1.0, 0.0].map(|p| moment(p - 2.0 * power) / k2);
        let [h, one] = [1.0, 0.0].map(|p| moment(p - power) / k);
        let determinant = hh * ones - h1 * h1;
        let cutting_n_per_mm2 = (h * ones - h1 * one) / determinant;
        let cutting_edge_n_per_mm = (hh * one - h * h1) / determinant;
        EdgeForce {
            cutting_n_per_mm2,
            cutting_edge_n_per_mm,
            normal_n_per_mm2: NORMAL_SHARE * cutting_n_per_mm2,
            normal_edge_n_per_mm: NORMAL_SHARE * cutting_edge_n_per_mm,
        }
    }
}

/// The cutting force alone: the law of an edge element, summed over the edge of a chip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CuttingForce {
    /// K_c, N/mm^2.
    pub per_area_n_per_mm2: f64,
    /// K_ce, N/mm.
    pub per_length_n_per_mm: f64,
}

impl CuttingForce {
    /// Cutting force on a chip of this section, over this length of edge, N. With mm3 and mm2 instead, what both sweep
    /// on a travel, it is the work, N mm.
    pub fn on_chip(&self, section_mm2: f64, edge_mm: f64) -> f64 {
        self.per_area_n_per_mm2 * section_mm2 + self.per_length_n_per_mm * edge_mm
    }
}

impl EdgeForce {
    /// Cutting and normal force of an edge element, N.
    #[cfg(feature = "testing")]
    pub fn on_element(&self, thickness_mm: f64, length_mm: f64) -> [f64; 2] {
        [
            (self.cutting_n_per_mm2 * thickness_mm + self.cutting_edge_n_per_mm) * length_mm,
            (self.normal_n_per_mm2 * thickness_mm + self.normal_edge_n_per_mm) * length_mm,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Specific cutting force k_c in kN/mm^2 at feeds of 0.16, 0.25, 0.4, 0.63, 1.0 and 1.6 mm under 45 degrees, as a
    /// maker of chucks prints it (Röhm, RN 1391, table 2).
    #[test]
    fn built_in_materials_agree_with_a_shop_table() {
        let table = [
            ("16MnCr5", [3.75, 3.30, 2.95, 2.60, 2.30, 2.05], 0.02),
            ("42CrMo4", [4.35, 3.90, 3.45, 3.10, 2.75, 2.45], 0.02),
            ("18CrNi8", [4.35, 3.80, 3.30, 2.90, 2.50, 2.20], 0.02),
            ("C45", [3.05, 2.80, 2.60, 2.40, 2.20, 2.05], 0.07),
        ];
        for (name, row, share) in table {
            let material = Kienzle::named(name).expect("built in");
            for (feed, printed) in [0.16, 0.25, 0.4, 0.63, 1.0, 1.6].into_iter().zip(row) {
                let h = feed * std::f64::consts::FRAC_1_SQRT_2;
                let ours = material.force_n_per_mm(h) / h / 1000.0;
                assert!((ours / printed - 1.0).abs() < share, "{name} at {feed}: {ours} against {printed}");
            }
        }
    }

    /// A wedge of chip, thickness 0 to 0.2 mm over 3 mm of edge: the sum over elements is the law of the whole section.
    #[test]
    fn the_force_on_a_chip_is_the_sum_over_its_edge() {
        let line = MATERIALS[1].edge_force();
        let element_mm = 3.0 / 300.0;
        let thickness_mm = |i: u32| 0.2 * (f64::from(i) + 0.5) / 300.0;
        let sum: f64 = (0..300).map(|i| line.on_element(thickness_mm(i), element_mm)[0]).sum();
        let force = CuttingForce {
            per_area_n_per_mm2: line.cutting_n_per_mm2,
            per_length_n_per_mm: line.cutting_edge_n_per_mm,
        };
        assert!((force.on_chip(0.5 * 0.2 * 3.0, 3.0) / sum - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_line_stays_near_kienzles_law() {
        for material in MATERIALS {
            let line = material.edge_force();
            assert!(line.cutting_n_per_mm2 > 0.0 && line.cutting_edge_n_per_mm > 0.0);
            for i in 0..=100 {
                let h = 0.01 + 0.09 * f64::from(i) / 100.0;
                let share = line.on_element(h, 1.0)[0] / material.force_n_per_mm(h) - 1.0;
                assert!(share.abs() < 0.15, "{} at {h} mm: {share}", material.name);
            }
            // Least squares: no other line is nearer.
            let distance = |dk: f64, de: f64| -> f64 {
                (0..900)
                    .map(|i| {
                        let h = 0.01 + 0.0001 * (f64::from(i) + 0.5);
                        let force = (line.cutting_n_per_mm2 + dk) * h + line.cutting_edge_n_per_mm + de;
                        (force / material.force_n_per_mm(h) - 1.0).powi(2)
                    })
                    .sum()
            };
            let best = distance(0.0, 0.0);
            for (dk, de) in [(5.0, 0.0), (-5.0, 0.0), (0.0, 0.5), (0.0, -0.5)] {
                assert!(distance(dk, de) > best, "{}: {dk} {de}", material.name);
            }
        }
    }
}
