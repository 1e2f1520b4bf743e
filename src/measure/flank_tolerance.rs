//! What ISO 1328-1:2013 allows the flanks of a round gear, class by class.
//!
//! In: class A, number of teeth, reference diameter d, normal module m_n, face width b, helix angle. Out:
//! tolerances of nine figures in um ([`ToleranceSizes::tolerance_um`]), or why the standard gives none.
//!
//! **Law** (5.3, formulas 5 to 12, in um with lengths in mm), each times sqrt(2)^(A - 5):
//!
//! | | |
//! | --- | --- |
//! | f_pT | 0.001 d + 0.4 m_n + 5 |
//! | F_pT | 0.002 d + 0.55 sqrt(d) + 0.7 m_n + 12 |
//! | f_H_alphaT | 0.4 m_n + 0.001 d + 4 |
//! | f_f_alphaT | 0.55 m_n + 5 |
//! | F_alphaT | root of the sum of both squares |
//! | f_H_betaT | 0.05 sqrt(d) + 0.35 sqrt(b) + 4 |
//! | f_f_betaT | 0.07 sqrt(d) + 0.45 sqrt(b) + 4 |
//! | F_betaT | root of the sum of both squares |
//! | F_rT | 0.9 F_pT (annex on runout, for information) |
//!
//! Totals are made of figures that are not rounded yet. **Rounding** (5.2.3): above 10 um to whole micrometres, from 5
//! to 10 um to 0.5 um, below 5 um to 0.1 um. **Range** (clause 1): 5 to 1000 teeth, d 5 to 15000 mm, m_n 0.5 to 70 mm,
//! b 4 to 1200 mm, helix angle to 45 deg, classes 1 to 11; 5.2.1 forbids to go beyond. The text of the standard is not
//! free: the formulas were compared in three programs that print its formula numbers; a fourth leaves 0.001 d out of
//! f_H_alphaT, which is 0.1 um on a gear of 100 mm.

use std::f64::consts::SQRT_2;

/// The classes, the finest first.
pub const CLASSES: std::ops::RangeInclusive<u32> = 1..=11;

/// A figure that a limit judges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InspectionFigure {
    /// f_p.
    SinglePitch,
    /// F_p.
    TotalPitch,
    /// F_alpha.
    ProfileTotal,
    /// f_f_alpha.
    ProfileForm,
    /// f_H_alpha.
    ProfileSlope,
    /// F_beta.
    HelixTotal,
    /// f_f_beta.
    HelixForm,
    /// f_H_beta.
    HelixSlope,
    /// F_r.
    Runout,
}

impl InspectionFigure {
    /// All, in the order in which an inspector states them.
    pub const ALL: [Self; 9] = [
        Self::ProfileTotal,
        Self::ProfileForm,
        Self::ProfileSlope,
        Self::HelixTotal,
        Self::HelixForm,
        Self::HelixSlope,
        Self::SinglePitch,
        Self::TotalPitch,
        Self::Runout,
    ];

    /// Key in results and in `[measure.limits]`, there with `_um`.
    pub fn key(self) -> &'static str {
        match self {
            Self::SinglePitch => "single_pitch",
            Self::TotalPitch => "total_pitch",
            Self::ProfileTotal => "profile_total",
            Self::ProfileForm => "profile_form",
            Self::ProfileSlope => "profile_slope",
            Self::HelixTotal => "helix_total",
            Self::HelixForm => "helix_form",
            Self::HelixSlope => "helix_slope",
            Self::Runout => "runout",
        }
    }

    /// Symbol of the standard in plain letters.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::SinglePitch => "f_p",
            Self::TotalPitch => "F_p",
            Self::ProfileTotal => "F_alpha",
            Self::ProfileForm => "f_f_alpha",
            Self::ProfileSlope => "f_H_alpha",
            Self::HelixTotal => "F_beta",
            Self::HelixForm => "f_f_beta",
            Self::HelixSlope => "f_H_beta",
            Self::Runout => "F_r",
        }
    }

    /// Symbol as drawings have it.
    pub fn sign(self) -> &'static str {
        match self {
            Self::SinglePitch => "fp",
            Self::TotalPitch => "Fp",
            Self::ProfileTotal => "Fα",
            Self::ProfileForm => "ffα",
            Self::ProfileSlope => "fHα",
            Self::HelixTotal => "Fβ",
            Self::HelixForm => "ffβ",
            Self::HelixSlope => "fHβ",
            Self::Runout => "Fr",
        }
    }

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::SinglePitch => "single pitch deviation",
            Self::TotalPitch => "total pitch deviation",
            Self::ProfileTotal => "total profile deviation",
            Self::ProfileForm => "profile form deviation",
            Self::ProfileSlope => "profile slope deviation",
            Self::HelixTotal => "total helix deviation",
            Self::HelixForm => "helix form deviation",
            Self::HelixSlope => "helix slope deviation",
            Self::Runout => "runout",
        }
    }

    /// Whether it is taken along the normal of a flank, as traces are, and not along an arc or a radius.
    pub fn is_along_normal(self) -> bool {
        !matches!(self, Self::SinglePitch | Self::TotalPitch | Self::Runout)
    }
}

/// Sizes that tolerances depend on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToleranceSizes {
    /// z.
    pub teeth: u32,
    /// d, mm.
    pub reference_diameter_mm: f64,
    /// m_n, mm.
    pub normal_module_mm: f64,
    /// b, mm.
    pub face_width_mm: f64,
    /// beta.
    pub helix_angle_rad: f64,
}

impl ToleranceSizes {
    /// Why the standard gives no tolerances for a gear of this size; none where it does.
    pub fn beyond(&self) -> Option<String> {
        let beta_deg = self.helix_angle_rad.to_degrees();
        let sizes = [
            ("teeth", f64::from(self.teeth), 5.0, 1000.0, ""),
            ("reference diameter", self.reference_diameter_mm, 5.0, 15_000.0, " mm"),
            ("normal module", self.normal_module_mm, 0.5, 70.0, " mm"),
            ("face width", self.face_width_mm, 4.0, 1200.0, " mm"),
            ("helix angle", beta_deg, 0.0, 45.0, " deg"),
        ];
        // A helix of 45 deg is one after its way through radians, too.
        let wrong = sizes.into_iter().find(|(_, size, low, high, _)| *size < low - 1e-9 || *size > high + 1e-9)?;
        let (name, size, low, high, unit) = wrong;
        Some(format!("ISO 1328-1:2013 holds for a {name} of {low} to {high}{unit}, not for {size}{unit}"))
    }

    /// What a class allows a figure, um, rounded as the standard has it.
    ///
    /// # Errors
    /// Why the standard gives no tolerance: a size or class out of its range.
    pub fn tolerance_um(&self, figure: InspectionFigure, class: u32) -> Result<f64, String> {
        if !CLASSES.contains(&class) {
            return Err(format!("ISO 1328-1:2013 has the classes 1 to 11, not {class}"));
        }
        match self.beyond() {
            Some(why) => Err(why),
            None => Ok(rounded_um(self.class_5_um(figure) * SQRT_2.powi(class as i32 - 5))),
        }
    }

    /// The finest class that allows a figure this value, um; none beyond class 11.
    ///
    /// # Errors
    /// Why the standard gives no tolerance for a gear of this size.
    pub fn class_of(&self, figure: InspectionFigure, value_um: f64) -> Result<Option<u32>, String> {
        for class in CLASSES {
            if value_um.abs() <= self.tolerance_um(figure, class)? {
                return Ok(Some(class));
            }
        }
        Ok(None)
    }

    /// Not rounded.
    fn class_5_um(&self, figure: InspectionFigure) -> f64 {
        let (d, m, b) = (self.reference_diameter_mm, self.normal_module_mm, self.face_width_mm);
        match figure {
            InspectionFigure::SinglePitch => 0.001 * d + 0.4 * m + 5.0,
            InspectionFigure::TotalPitch => 0.002 * d + 0.55 * d.sqrt() + 0.7 * m + 12.0,
            InspectionFigure::ProfileSlope => 0.4 * m + 0.001 * d + 4.0,
            InspectionFigure::ProfileForm => 0.55 * m + 5.0,
            InspectionFigure::ProfileTotal => {
                self.class_5_um(InspectionFigure::ProfileSlope).hypot(self.class_5_um(InspectionFigure::ProfileForm))
            }
            InspectionFigure::HelixSlope => 0.05 * d.sqrt() + 0.35 * b.sqrt() + 4.0,
            InspectionFigure::HelixForm => 0.07 * d.sqrt() + 0.45 * b.sqrt() + 4.0,
            InspectionFigure::HelixTotal => {
                self.class_5_um(InspectionFigure::HelixSlope).hypot(self.class_5_um(InspectionFigure::HelixForm))
            }
            InspectionFigure::Runout => 0.9 * self.class_5_um(InspectionFigure::TotalPitch),
        }
    }
}

/// A tolerance as the standard rounds it, um.
fn rounded_um(um: f64) -> f64 {
    let parts = if um > 10.0 {
        1.0
    } else if um >= 5.0 {
        2.0
    } else {
        10.0
    };
    (um * parts).round() / parts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Module 3, 24 teeth, 20 mm wide, class 5 by hand from the formulas, um: f_p 6.272 (5, 1.2, 0.072), F_p 18.911
    /// (12, 2.1, 0.144, 4.667), f_H_alpha 5.272, f_f_alpha 6.65, f_H_beta 5.990 (4, 0.424, 1.565), f_f_beta 6.606
    /// (4, 0.594, 2.012).
    const SIZES: ToleranceSizes = ToleranceSizes {
        teeth: 24,
        reference_diameter_mm: 72.0,
        normal_module_mm: 3.0,
        face_width_mm: 20.0,
        helix_angle_rad: 0.0,
    };

    fn all_um(class: u32) -> [f64; 9] {
        InspectionFigure::ALL.map(|figure| SIZES.tolerance_um(figure, class).expect("in range"))
    }

    #[test]
    fn classes_follow_from_the_fifth_by_roots_of_two_and_are_rounded_last() {
        // F_alpha = hypot(6.65, 5.272) = 8.486; F_beta = hypot(6.606, 5.990) = 8.917; F_r = 17.02.
        let same = |found: [f64; 9], expected: [f64; 9]| {
            let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-9, "{found:?} for {expected:?}");
        };
        same(all_um(5), [8.5, 6.5, 5.5, 9.0, 6.5, 6.0, 6.5, 19.0, 17.0]);
        // Class 7 is twice class 5 before rounding: 16.97, 13.3, 10.544, 17.83, 13.21, 11.98, 12.544, 37.82, 34.04.
        same(all_um(7), [17.0, 13.0, 11.0, 18.0, 13.0, 12.0, 13.0, 38.0, 34.0]);
        // Class 1 is a quarter: 2.12, 1.66, 1.318, 2.23, 1.65, 1.498, 1.568, 4.728, 4.255.
        same(all_um(1), [2.1, 1.7, 1.3, 2.2, 1.7, 1.5, 1.6, 4.7, 4.3]);
    }

    #[test]
    fn the_class_is_the_finest_that_allows_the_value() {
        assert_eq!(SIZES.class_of(InspectionFigure::SinglePitch, 6.5), Ok(Some(5)));
        assert_eq!(SIZES.class_of(InspectionFigure::SinglePitch, -6.51), Ok(Some(6)));
        assert_eq!(SIZES.class_of(InspectionFigure::SinglePitch, 0.0), Ok(Some(1)));
        assert_eq!(SIZES.class_of(InspectionFigure::SinglePitch, 60.0), Ok(None));
    }

    #[test]
    fn nothing_is_said_beyond_the_range_of_the_standard() {
        for (sizes, word) in [
            (ToleranceSizes { teeth: 4, ..SIZES }, "teeth"),
            (ToleranceSizes { normal_module_mm: 0.4, ..SIZES }, "normal module"),
            (ToleranceSizes { face_width_mm: 3.0, ..SIZES }, "face width"),
            (ToleranceSizes { reference_diameter_mm: 15_001.0, ..SIZES }, "reference diameter"),
        ] {
            let why = sizes.tolerance_um(InspectionFigure::Runout, 6).expect_err("out of range");
            assert!(why.contains(word), "{why}");
        }
        assert!(SIZES.tolerance_um(InspectionFigure::Runout, 12).is_err());
    }
}
