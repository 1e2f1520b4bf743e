//! Keys of scenes from which parameters of the core are read.
//!
//! In: the name that a refusal of the core blames. Out: the key, whose place in the file is known.

use gearcut_core::parameter as of;

/// Section of pitch curves.
const CURVE: &str = "gear.pitch_curve.";

const KEYS: [(&str, &str); 41] = [
    (of::MODULE, "gear.module_mm"),
    (of::ADDENDUM, "gear.addendum_coefficient"),
    (of::FACE_WIDTH, "gear.face_width_mm"),
    (of::CIRCLE, "gear.pitch_curve.circle"),
    (of::ELLIPSE, "gear.pitch_curve.ellipse"),
    (of::ELLIPSE_ORDER, "gear.pitch_curve.ellipse.order"),
    (of::ELLIPSE_ECCENTRICITY, "gear.pitch_curve.ellipse.eccentricity"),
    (of::ELLIPSE_SIZE, "gear.pitch_curve.ellipse.semi_major_axis_mm"),
    (of::SINUSOIDAL_RATIO, "gear.pitch_curve.sinusoidal_ratio"),
    (of::SINUSOIDAL_ORDER, "gear.pitch_curve.sinusoidal_ratio.order"),
    (of::SINUSOIDAL_AMPLITUDE, "gear.pitch_curve.sinusoidal_ratio.ratio_amplitude"),
    (of::SINUSOIDAL_SIZE, "gear.pitch_curve.sinusoidal_ratio.center_distance_mm"),
    (of::PASCAL, "gear.pitch_curve.pascal"),
    (of::PASCAL_ORDER, "gear.pitch_curve.pascal.order"),
    (of::PASCAL_ECCENTRICITY, "gear.pitch_curve.pascal.eccentricity"),
    (of::PASCAL_SIZE, "gear.pitch_curve.pascal.mean_radius_mm"),
    (of::FOURIER, "gear.pitch_curve.fourier"),
    (of::FOURIER_SIZE, "gear.pitch_curve.fourier.mean_radius_mm"),
    (of::RADIUS_FORMULA, "gear.pitch_curve.radius_formula.radius"),
    (of::RADIUS_FORMULA_SIZE, "gear.pitch_curve.radius_formula.scale_mm"),
    (of::RATIO_FORMULA, "gear.pitch_curve.ratio_formula.ratio"),
    (of::RATIO_FORMULA_SIZE, "gear.pitch_curve.ratio_formula.center_distance_mm"),
    (of::TABLE, "gear.pitch_curve.table"),
    (of::TABLE_POINTS, "gear.pitch_curve.table.points_deg_mm"),
    (of::TABLE_SCALING, "gear.pitch_curve.table.scale_to_close"),
    (of::MATE, "gear.pitch_curve.mate"),
    (of::MATE_DRIVER, "gear.pitch_curve.mate.driver"),
    (of::MATE_DRIVER_TEETH, "gear.pitch_curve.mate.driver_teeth"),
    (of::SECTOR, "gear.sector_deg"),
    (of::DWELL_RADIUS, "gear.dwell_radius_mm"),
    (of::PITCH_ANGLE, "gear.bevel.pitch_angle_deg"),
    (of::ROOT_ANGLE, "gear.bevel.root_angle_deg"),
    (of::FACE_ANGLE, "gear.bevel.face_angle_deg"),
    (of::BLADES, "tool.face_mill.blades"),
    (of::TIP_WIDTH, "tool.face_mill.tip_width_mm"),
    (of::CORNER_RADIUS, "tool.face_mill.corner_radius_mm"),
    (of::CRADLE, "machine.cradle"),
    (of::BLANK_OFFSET, "machine.cradle.blank_offset_mm"),
    (of::SLIDING_BASE, "machine.cradle.sliding_base_mm"),
    (of::MACHINE_ROOT_ANGLE, "machine.cradle.root_angle_deg"),
    (of::RAY_SPACING, "fields.blank.spacing_mm"),
];

/// The key from which a parameter is read; a name that is none of the core's is a key already.
pub fn key_of(name: &str) -> String {
    if let Some(of_driver) = name.strip_prefix(of::OF_DRIVER) {
        let key = key_of(of_driver);
        return format!("gear.pitch_curve.mate.driver.{}", key.strip_prefix(CURVE).unwrap_or(&key));
    }
    KEYS.iter().find(|(known, _)| *known == name).map_or(name, |(_, key)| key).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process;

    /// A parameter of the core without a key, and a key that no scene has, are found.
    #[test]
    fn every_parameter_of_the_core_has_a_key() {
        for name in of::ALL {
            let key = key_of(name);
            assert_ne!(key, *name, "{name} has no key");
            assert!(process::table().knows(&key), "no scene has {key}");
        }
        assert_eq!(key_of("driver's driver's eccentricity of the ellipse"), {
            "gear.pitch_curve.mate.driver.mate.driver.ellipse.eccentricity"
        });
        assert_eq!(key_of("tool.hob.starts"), "tool.hob.starts");
    }
}
