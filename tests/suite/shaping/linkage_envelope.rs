//! Allowances that follow from the linkages alone, against an independent implementation and the paper's readings.
//!
//! The envelope of an involute cutter flank under a planar motion is known in closed form: every contact normal passes
//! through the instantaneous centre Q and touches the base circle. Points A to D are where rough and finish envelope
//! cross the pitch curve (Gao et al. 2017, Fig. 9). This checks poses and their rates together: a wrong rate moves Q
//! and every point with it.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

use gearcut::gear::{GearKind, PitchCurve, PitchCurveShape};
use gearcut::process::shaping::linkage::ShapingLinkage;
use gearcut::process::shaping::scene::model::{Linkage, NormalReading, TraditionalDirection};
use glam::DVec2;
use serde_json::Value;

const MODULE_MM: f64 = 3.0;
const CUTTER_TEETH: f64 = 20.0;
const NORMAL: Linkage = Linkage::ShapingNormal { reading: NormalReading::Corrected };
const AS_PRINTED: Linkage = Linkage::ShapingNormal { reading: NormalReading::AsPrinted };
const TRADITIONAL: Linkage = Linkage::ShapingTraditional { direction: TraditionalDirection::CenterLine };
const POLAR: Linkage = Linkage::ShapingTraditional { direction: TraditionalDirection::PolarRadius };

/// Point of the envelope at `phi` on the flank of cutter tooth `space` that cuts the gear flank of the given side (+1:
/// left flank of the tooth before the space, -1: right flank of the tooth after it).
fn contact(linkage: &ShapingLinkage, phi: f64, offset_mm: f64, space: f64, side: f64) -> DVec2 {
    let motion = linkage.pose_motion(phi, offset_mm);
    let alpha = 20f64.to_radians();
    let base_mm = linkage.cutter_pitch_radius_mm() * alpha.cos();
    let to_center = motion.instantaneous_center_mm() - motion.pose.center_mm;
    let working = (base_mm / to_center.length()).acos();
    // Angles in the frame of the cutter: tooth `space` stands at -space * pitch; the flank leaves the base circle
    // there.
    let tooth = motion.pose.angle_rad - space * TAU / CUTTER_TEETH;
    let half_thickness = FRAC_PI_2 / CUTTER_TEETH + alpha.tan() - alpha;
    let base_start = tooth + side * half_thickness;
    let touching = to_center.to_angle() - side * working;
    // Unrolled angle: from where the involute starts to where the normal touches the base circle, against the side.
    let unrolled = side * (base_start - touching);
    let unrolled = (unrolled + PI).rem_euclid(TAU) - PI;
    let radial = DVec2::from_angle(touching);
    motion.pose.center_mm + radial * base_mm + radial.perp() * (side * base_mm * unrolled)
}

/// Where the envelope crosses the pitch curve.
fn crossing(linkage: &ShapingLinkage, offset_mm: f64, space: f64, side: f64) -> DVec2 {
    let curve = linkage.curve();
    let height = |phi: f64| {
        let point = contact(linkage, phi, offset_mm, space, side);
        point.length() - curve.radius(point.to_angle()).value()
    };
    let middle = curve.phi_at_arc(space * PI * MODULE_MM);
    let (mut lo, mut hi) = (middle - 0.15, middle + 0.15);
    let rising = height(hi) > 0.0;
    assert!((height(lo) > 0.0) != rising, "no crossing at space {space}");
    for _ in 0..60 {
        let mid = f64::midpoint(lo, hi);
        if (height(mid) > 0.0) == rising { hi = mid } else { lo = mid }
    }
    contact(linkage, lo, offset_mm, space, side)
}

/// A, B, C, D of a tooth.
fn points(linkage: &ShapingLinkage, tooth: u32) -> [DVec2; 4] {
    let (after, before) = (f64::from(tooth), f64::from(tooth - 1));
    [(2.0, after, 1.0), (0.0, after, 1.0), (0.0, before, -1.0), (2.0, before, -1.0)]
        .map(|(offset_mm, space, side)| crossing(linkage, offset_mm, space, side))
}

fn linkage(kind: Linkage) -> ShapingLinkage {
    let shape = PitchCurveShape::Ellipse { order: 3, eccentricity: 0.1348, semi_major_axis_mm: Some(61.11) };
    let curve = Arc::new(PitchCurve::new(&shape, MODULE_MM, 42).unwrap());
    ShapingLinkage::new(GearKind::External, kind, curve, MODULE_MM * CUTTER_TEETH / 2.0, 2.0).unwrap()
}

/// Largest and mean unevenness of the allowance, |AB - CD| / ((AB + CD) / 2), over one lobe, in percent.
fn unevenness(kind: Linkage) -> [f64; 2] {
    let linkage = linkage(kind);
    let each: Vec<f64> = (1..=14)
        .map(|tooth| {
            let [a, b, c, d] = points(&linkage, tooth);
            let (left, right) = (a.distance(b), c.distance(d));
            200.0 * (left - right).abs() / (left + right)
        })
        .collect();
    [each.iter().copied().fold(0.0, f64::max), each.iter().sum::<f64>() / each.len() as f64]
}

#[test]
fn envelope_points_agree() {
    let path = format!("{}/tests/data/shaping/external_s0_allowances.json", env!("CARGO_MANIFEST_DIR"));
    let data: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let runs = [("traditional", TRADITIONAL), ("normal", NORMAL), ("normal_as_printed", AS_PRINTED)];
    for (block, kind) in runs {
        let linkage = linkage(kind);
        for expected in data["exact_envelope"][block]["teeth"].as_array().unwrap() {
            let tooth = u32::try_from(expected["tooth"].as_u64().unwrap()).unwrap();
            for (point, name) in points(&linkage, tooth).iter().zip(["A", "B", "C", "D"]) {
                let expected = DVec2::new(expected[name][0].as_f64().unwrap(), expected[name][1].as_f64().unwrap());
                let off = point.distance(expected);
                assert!(off < 1e-7, "{block} tooth {tooth} {name}: {point} not {expected}, {off:e} off");
            }
        }
    }
}

#[test]
fn readings_differ_as_known() {
    for (kind, largest, mean) in
        [(TRADITIONAL, 129.52, 85.58), (NORMAL, 3.98, 2.07), (AS_PRINTED, 43.6, 28.9), (POLAR, 200.0, 131.9)]
    {
        let found = unevenness(kind);
        assert!((found[0] - largest).abs() < 0.06 && (found[1] - mean).abs() < 0.06, "{kind:?}: {found:?}");
    }
}
