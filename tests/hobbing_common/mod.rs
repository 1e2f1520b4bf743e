//! Hobbing cases of the independent implementation: gear, hob, linkage, and flank rays on its (z, sigma) grid.
//!
//! Its gear frame has x and y exchanged and z turned over against the project's; `flank` +1 faces the low-arc side of the space. Target: the rack's flank rolled
//! with the phase of each section, contact at the foot of the normal from the pitch point.
#![allow(dead_code, reason = "each test binary uses its own part")]

use gearcut::dexel::{Ray, SpatialField};
use gearcut::gear::PitchCurve;
use gearcut::gear::rack_generation::{Rack, RackGeneration};
use gearcut::linkage::HobbingLinkage;
use gearcut::linkage::hobbing::{FeedPath, HobbingGeometry, HobbingLaw};
use gearcut::passes::{HobTeeth, MotionTable};
use gearcut::scene::model::{
    EvenMotion, ExtraRotation, GashForm, Hand, Hob as HobSpec, HobSize, LinkageForm, PitchCurveShape, Worm,
};
use gearcut::tool::Hob;
use glam::{DVec2, DVec3};
use serde_json::Value;
use std::sync::Arc;

/// Everything of one case.
pub struct Case {
    pub curve: Arc<PitchCurve>,
    pub hob: Hob,
    pub linkage: HobbingLinkage,
    pub teeth: u32,
    pub normal_module_mm: f64,
    pub helix_angle_rad: f64,
    pub gear_hand: f64,
    pub pressure_angle_rad: f64,
    pub hob_speed_rad_per_s: f64,
    pub setup: Value,
}

pub fn data(name: &str) -> Value {
    let path = format!("tests/data/hobbing/{name}.json");
    serde_json::from_slice(&std::fs::read(&path).unwrap_or_else(|e| panic!("{path}: {e}"))).expect("JSON")
}

/// Rows of heights, mm.
pub fn heights(name: &str, file: &Value) -> Vec<Vec<f64>> {
    if let Some(rows) = file.get("heights") {
        return rows.as_array().expect("rows").iter().map(numbers).collect();
    }
    let bytes = std::fs::read(format!("tests/data/hobbing/{name}.f64le")).expect("heights");
    let values: Vec<f64> = bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("eight"))).collect();
    values.chunks(file["sigma"].as_array().expect("sigma").len()).map(<[f64]>::to_vec).collect()
}

pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
}

pub fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key}"))
}

pub const fn law(even: EvenMotion, extra: ExtraRotation, form: LinkageForm) -> HobbingLaw {
    HobbingLaw { even, extra, form }
}

/// The six schemes of Liu et al. 2013.
pub const SCHEMES: [(&str, EvenMotion, ExtraRotation); 6] = [
    ("I", EvenMotion::ArcLength, ExtraRotation::Work),
    ("II", EvenMotion::ArcLength, ExtraRotation::Hob),
    ("III", EvenMotion::RotationAngle, ExtraRotation::Work),
    ("IV", EvenMotion::RotationAngle, ExtraRotation::Hob),
    ("V", EvenMotion::PolarAngle, ExtraRotation::Work),
    ("VI", EvenMotion::PolarAngle, ExtraRotation::Hob),
];

/// Hob speed at which a cycle lasts `cycle_s`.
pub fn cycle_speed(curve: &PitchCurve, geometry: &HobbingGeometry, cycle_s: f64) -> f64 {
    curve.perimeter_mm() / (geometry.arc_per_hob_rad_mm() * cycle_s)
}

/// The hob of both papers: one start, 10 gashes, lead angle 3 deg 19', left-hand, sharp corners.
fn papers_hob_spec(length_mm: f64) -> HobSpec {
    HobSpec {
        starts: 1,
        hand: Hand::Left,
        gashes: 10,
        gash_form: GashForm::Axial,
        size: HobSize::LeadAngle((3.0 + 19.0 / 60.0_f64).to_radians()),
        length_mm,
        addendum_coefficient: 1.25,
        dedendum_coefficient: 1.25,
        worm: Worm::Involute,
        tip_radius_mm: 0.0,
        protuberance: None,
        thinning_mm: 0.0,
        regrind_mm: 0.0,
    }
}

/// That hob of module 8.
pub fn papers_hob(length_mm: f64) -> Hob {
    Hob::new(&papers_hob_spec(length_mm), 8.0, 20_f64.to_radians()).expect("a hob")
}

/// An ellipse of normal module 8; `a` is its semi-major axis, solved if there is none.
pub fn papers_ellipse(order: u32, eccentricity: f64, a: Option<f64>, helix: f64, teeth: u32) -> Arc<PitchCurve> {
    let shape = PitchCurveShape::Ellipse { order, eccentricity, semi_major_axis_mm: a };
    Arc::new(PitchCurve::new(&shape, 8.0 / helix.cos(), teeth).expect("a curve"))
}

/// The rack of the papers' hob: sharp tips 1.25 m high.
pub fn papers_rack(helix_angle_rad: f64, hand: f64) -> Rack {
    sharp_rack(8.0, 20_f64.to_radians(), 10.0, helix_angle_rad, hand)
}

fn sharp_rack(module_mm: f64, pressure_angle_rad: f64, tip_height_mm: f64, helix_angle_rad: f64, hand: f64) -> Rack {
    let transverse_module_mm = module_mm / helix_angle_rad.cos();
    Rack {
        transverse_module_mm,
        pressure_angle_rad: (pressure_angle_rad.tan() / helix_angle_rad.cos()).atan(),
        half_thickness_mm: 0.25 * std::f64::consts::PI * transverse_module_mm,
        tip_height_mm,
        tip_radius_mm: 0.0,
        helix_angle_rad,
        hand,
    }
}

impl Case {
    /// Case of a file's setup, its gashes made more or fewer and its feed changed by factors.
    pub fn with(setup: &Value, gash_factor: f64, feed_factor: f64) -> Self {
        Self::with_gashes(setup, gash_factor, feed_factor, GashForm::Axial)
    }

    /// The same with another form of gashes.
    pub fn with_gashes(setup: &Value, gash_factor: f64, feed_factor: f64, gash_form: GashForm) -> Self {
        let get = |key: &str| number(setup, key);
        let (normal_module_mm, helix_angle_rad) = (get("mn"), get("beta"));
        let teeth = get("Z") as u32;
        let order = get("n") as u32;
        let shape = if get("e") == 0.0 {
            PitchCurveShape::Circle
        } else {
            PitchCurveShape::Ellipse { order, eccentricity: get("e"), semi_major_axis_mm: None }
        };
        let curve =
            Arc::new(PitchCurve::new(&shape, normal_module_mm / helix_angle_rad.cos(), teeth).expect("a curve"));
        let hand = |h: f64| if h > 0.0 { Hand::Right } else { Hand::Left };
        let pressure_angle_rad = get("alpha_n");
        let spec = HobSpec {
            starts: get("K") as u32,
            hand: hand(get("hb")),
            gashes: (get("Zb") * gash_factor).round() as u32,
            gash_form,
            size: HobSize::LeadAngle(get("lam")),
            addendum_coefficient: get("ha0"),
            ..papers_hob_spec(400.0)
        };
        let hob = Hob::new(&spec, normal_module_mm, pressure_angle_rad).expect("a hob");
        let geometry = HobbingGeometry::new(&hob, helix_angle_rad, get("h"));
        let law = HobbingLaw { even: EvenMotion::ArcLength, extra: ExtraRotation::Work, form: LinkageForm::Exact };
        let path = FeedPath::steady(1.0, get("vz") * feed_factor, get("udot") * feed_factor);
        let linkage = HobbingLinkage::new(curve.clone(), geometry, law, get("wb"), &path).expect("a linkage");
        Self {
            curve,
            hob,
            linkage,
            teeth,
            normal_module_mm,
            helix_angle_rad,
            gear_hand: get("h"),
            pressure_angle_rad,
            hob_speed_rad_per_s: get("wb"),
            setup: setup.clone(),
        }
    }

    pub fn new(setup: &Value) -> Self {
        Self::with(setup, 1.0, 1.0)
    }

    pub fn passes(&self, hob_range_rad: [f64; 2]) -> HobTeeth {
        let motion = MotionTable::new(hob_range_rad, &[], |angle| self.linkage.head_from_work(angle));
        HobTeeth::new(0, &self.hob, self.hob.hand, motion)
    }

    /// Point and normal of the target flank, gear frame. `sigma`: roll past the crossing of flank and pitch line in the section `z` (the oracle's z).
    pub fn target(&self, space: i64, flank: f64, sigma: f64, z: f64) -> Ray {
        let (beta, h, e) = (self.helix_angle_rad, self.gear_hand, flank);
        let module = self.normal_module_mm / beta.cos();
        let pitch = std::f64::consts::PI * module;
        let arc = space as f64 * pitch - e * pitch / 4.0 - h * z * beta.tan() + sigma;
        let alpha = (self.pressure_angle_rad.tan() / beta.cos()).atan();
        let theta = self.curve.phi_at_arc(arc);
        let frame = self.curve.frame(theta);
        let contact = -e * sigma * alpha.cos();
        let normal = DVec3::new(e * alpha.cos(), alpha.sin(), h * e * beta.tan() * alpha.cos());
        // From the machine: x along the pitch line against growing arcs at P, y outwards.
        let to_work = |v: DVec2| v.x * frame.tangent + v.y * frame.normal;
        let point = frame.point_mm + contact * to_work(DVec2::new(normal.x, normal.y));
        let direction = to_work(DVec2::new(normal.x, normal.y));
        Ray {
            origin_mm: DVec3::new(point.x, point.y, -z),
            normal: DVec3::new(direction.x, direction.y, -normal.z).normalize(),
        }
    }

    /// The target by the project's own rack: sharp tips.
    pub fn rack_generation(&self) -> RackGeneration {
        let tip_height_mm = self.hob.tip_radius_mm - self.hob.pitch_radius_mm;
        let rack = sharp_rack(
            self.normal_module_mm,
            self.pressure_angle_rad,
            tip_height_mm,
            self.helix_angle_rad,
            self.gear_hand,
        );
        RackGeneration { curve: self.curve.clone(), rack }
    }

    /// Rays of a patch: columns are sigmas, rows are z.
    pub fn patch(&self, space: i64, flank: f64, sigmas: &[f64], z: &[f64]) -> SpatialField {
        SpatialField::new(sigmas.len(), z.len(), -4.0, |column, row| {
            (self.target(space, flank, sigmas[column], z[row]), 12.0)
        })
    }
}
