//! Bevel cases of the independent implementation: tests/data/bevel/b*.json, whose tolerances stand in the files.

use gearcut::bevel::blank::BevelBlank;
use gearcut::bevel::cradle::{CradleSettings, Roll, Tilt};
use gearcut::bevel::face_mill::{BladeKind, CuttingSurface};
use serde_json::Value;

pub fn data(name: &str) -> Value {
    let path = format!("tests/data/bevel/{name}.json");
    serde_json::from_slice(&std::fs::read(&path).unwrap_or_else(|e| panic!("{path}: {e}"))).expect("JSON")
}

pub fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key} of {value}"))
}

pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
}

#[track_caller]
pub fn close(what: &str, found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{what}: {found} not {expected}, off by {:e}", found - expected);
}

/// Settings of the paper's Table 2.
pub fn settings(file: &Value) -> CradleSettings {
    let of = |key: &str| number(&file["settings"], key);
    CradleSettings {
        radial_setting_mm: of("Sr"),
        cradle_angle_rad: of("theta_c").to_radians(),
        blank_offset_mm: of("Em"),
        cross_shift_mm: of("XB"),
        sliding_base_mm: 0.0,
        center_to_back_mm: of("Xp"),
        root_angle_rad: of("gm").to_radians(),
        tilt: Tilt::default(),
        roll: Roll { ratio: of("Ra"), ..Roll::default() },
    }
}

/// The gear of the paper's Table 1.
pub fn blank(file: &Value) -> BevelBlank {
    let of = |key: &str| number(&file["settings"], key);
    BevelBlank::new(BevelBlank {
        teeth: of("z2") as u32,
        pitch_angle_rad: of("gamma2").to_radians(),
        face_angle_rad: of("gf2").to_radians(),
        root_angle_rad: of("gr2").to_radians(),
        outer_cone_distance_mm: of("Re"),
        face_width_mm: of("face"),
        outer_addendum_mm: of("ha2"),
        outer_dedendum_mm: of("hf2"),
    })
    .expect("the paper's gear")
}

/// The oracle's cutter: straight, sharp blades of 20 deg on a mean radius of 95.25 mm with a point width of 2 mm.
pub fn surface(kind: BladeKind) -> CuttingSurface {
    CuttingSurface {
        kind,
        point_radius_mm: 95.25 + kind.sign(),
        blade_angle_rad: 20_f64.to_radians(),
        corner_radius_mm: 0.0,
    }
}
