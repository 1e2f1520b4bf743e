//! The hob of a scene that does not say all of it: the usual one of its module.
//!
//! In: module, pressure angle and the hob's heights. Out: diameter and length by DIN 8002, and the tip round that
//! leaves the root of ISO 53.

use super::model::Protuberance;

/// Tip diameter and length with full teeth of single-start hobs for spur gears (DIN 8002, form A) by module, each up to
/// the first number, mm. The standard's intermediate modules take the row they lie in.
const SIZES: [[f64; 3]; 10] = [
    [1.4, 50.0, 25.0],
    [1.8, 56.0, 32.0],
    [2.24, 63.0, 40.0],
    [2.8, 70.0, 50.0],
    [3.55, 80.0, 63.0],
    [4.5, 90.0, 70.0],
    [5.6, 100.0, 80.0],
    [7.1, 110.0, 100.0],
    [9.0, 125.0, 130.0],
    [11.2, 140.0, 160.0],
];
/// Smallest module of the standard.
const SMALLEST_MODULE_MM: f64 = 1.0;

/// Root round of the basic racks A and D of ISO 53, modules: as large as a clearance of 0.25 modules takes at 20 deg.
const ROOT_ROUND_MODULES: f64 = 0.38;
/// A clearance that takes this much of it takes it all: the standard's number is rounded.
const ROUNDED: f64 = 0.999;
/// Share of the round that would leave no tip land at most.
const OF_FULL_ROUND: f64 = 0.9;

/// Modules that have a usual hob, mm.
pub(super) const MODULES_MM: [f64; 2] = [SMALLEST_MODULE_MM, SIZES[SIZES.len() - 1][0]];

/// Tip diameter and length with full teeth, mm; `None` where the standard has no hob of this module.
pub(super) fn size_mm(module_mm: f64) -> Option<[f64; 2]> {
    let row = SIZES.iter().find(|[up_to_mm, ..]| module_mm <= *up_to_mm)?;
    (module_mm >= SMALLEST_MODULE_MM).then_some([row[1], row[2]])
}

/// Heights of hob and gear, modules, and what the tip looks like.
pub(super) struct HobTip {
    pub module_mm: f64,
    pub pressure_angle_rad: f64,
    pub hob_addendum: f64,
    pub gear_addendum: f64,
    pub thinning_mm: f64,
    pub protuberance: Option<Protuberance>,
}

impl HobTip {
    /// Tip round, mm: 0.38 modules, less where the clearance, the tip's width or a protuberance has no room for it; 0
    /// where the hob is no deeper than the gear's addendum.
    pub fn round_mm(&self) -> f64 {
        let (m, flank_rad) = (self.module_mm, self.pressure_angle_rad);
        let clearance_mm = (self.hob_addendum - self.gear_addendum) * m;
        let within = |height_mm: f64, angle_rad: f64| height_mm / (1.0 - angle_rad.sin());
        let standard_mm = ROOT_ROUND_MODULES * m;
        let mut round_mm = match within(clearance_mm, flank_rad) {
            room_mm if room_mm < ROUNDED * standard_mm => room_mm,
            _ => standard_mm,
        };
        let mut tip_rad = flank_rad;
        let mut half_tip_mm =
            std::f64::consts::FRAC_PI_4 * m - 0.5 * self.thinning_mm - self.hob_addendum * m * flank_rad.tan();
        if let Some(Protuberance { height_mm, angle_rad }) = self.protuberance {
            half_tip_mm += height_mm * (flank_rad.tan() - angle_rad.tan());
            round_mm = round_mm.min(OF_FULL_ROUND * within(height_mm, angle_rad));
            tip_rad = angle_rad;
        }
        let full_mm = half_tip_mm / (0.5 * (std::f64::consts::FRAC_PI_2 - tip_rad)).tan();
        round_mm.min(OF_FULL_ROUND * full_mm).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tip(pressure_angle_deg: f64, hob_addendum: f64, gear_addendum: f64) -> HobTip {
        let pressure_angle_rad = pressure_angle_deg.to_radians();
        HobTip { module_mm: 2.0, pressure_angle_rad, hob_addendum, gear_addendum, thinning_mm: 0.0, protuberance: None }
    }

    /// ISO 53, rack A: 0.38 modules; at 1.4 modules nine tenths of the full round (pi / 4 - 1.4 tan 20 deg) /
    /// tan 35 deg; a spline of 30 deg with a clearance of 0.15 modules 0.3; 25 deg and 1.25 modules are too pointed
    /// for 0.38.
    #[test]
    fn a_tip_round_is_that_of_the_standard_rack_where_it_fits() {
        assert_eq!(tip(20.0, 1.25, 1.0).round_mm(), 0.76);
        let full_mm = 2.0 * (std::f64::consts::FRAC_PI_4 - 1.4 * 0.363970234266202) / 0.700207538209710;
        assert!((tip(20.0, 1.4, 1.0).round_mm() - 0.9 * full_mm).abs() < 1e-12);
        assert!((tip(30.0, 0.6, 0.45).round_mm() - 0.6).abs() < 1e-12);
        let pointed_mm = tip(25.0, 1.25, 1.0).round_mm();
        assert!(pointed_mm > 0.5 && pointed_mm < 0.64, "{pointed_mm}");
        assert_eq!(tip(20.0, 1.0, 1.0).round_mm(), 0.0);
    }

    #[test]
    fn sizes_are_those_of_the_module() {
        assert_eq!(
            [1.0, 2.0, 3.0, 10.0].map(size_mm),
            [Some([50.0, 25.0]), Some([63.0, 40.0]), Some([80.0, 63.0]), Some([140.0, 160.0])]
        );
        assert_eq!([0.8, 12.0].map(size_mm), [None, None]);
    }
}
