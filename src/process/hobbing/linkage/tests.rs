//! Series against finite differences, motions against poses, the law of rolling, and limits.

use super::*;
use crate::machine::{Limits, Motion, Order, Peak, peaks};
use crate::process::hobbing::Hob;
use crate::process::hobbing::scene::model::{GashForm, HobSize, HobSpec, Worm};
use gearcut_core::frame::RigidMotion3;
use gearcut_core::gear::PitchCurveShape;
use gearcut_core::terms::Hand;
use glam::DVec3;

fn hob(hand: Hand) -> Hob {
    let spec = HobSpec {
        starts: 2,
        hand,
        gashes: 12,
        gash_form: GashForm::Axial,
        size: HobSize::ReferenceDiameter(90.0),
        length_mm: 120.0,
        addendum_coefficient: 1.25,
        dedendum_coefficient: 1.25,
        worm: Worm::Involute,
        profile: None,
        tip_radius_mm: 0.0,
        protuberance: None,
        tip_reliefs: Vec::new(),
        thinning_mm: 0.0,
        regrind_mm: 0.0,
        mounting: crate::machine_errors::ToolMounting::default(),
        pitch_errors_mm: Vec::new(),
    };
    Hob::new(&spec, 4.0, 20_f64.to_radians()).unwrap()
}

fn curve(shape: &PitchCurveShape, helix_rad: f64) -> Arc<PitchCurve> {
    Arc::new(PitchCurve::new(shape, 4.0 / helix_rad.cos(), 41).unwrap())
}

fn ellipse() -> PitchCurveShape {
    PitchCurveShape::Ellipse { order: 2, eccentricity: 0.2, semi_major_axis_mm: None }
}

/// Approach, cut with shift, and a return: rates that jump.
fn path() -> FeedPath {
    let phase = |duration_s, slide, shift, radial| FeedPhase {
        duration_s,
        slide_mm_per_s: slide,
        shift_mm_per_s: shift,
        radial_mm_per_s: radial,
    };
    FeedPath {
        start_slide_mm: 12.0,
        start_shift_mm: -9.0,
        start_radial_mm: 3.0,
        phases: vec![phase(2.0, 0.0, 0.0, -1.5), phase(9.0, -1.3, 0.4, 0.0), phase(1.0, 0.0, -3.6, 2.0)],
    }
}

fn laws() -> Vec<HobbingLaw> {
    let mut laws = Vec::new();
    for even in [EvenMotion::ArcLength, EvenMotion::RotationAngle, EvenMotion::PolarAngle] {
        for extra in [ExtraRotation::Work, ExtraRotation::Hob] {
            for form in [LinkageForm::Exact, LinkageForm::AsPrinted] {
                laws.push(HobbingLaw { even, extra, form });
            }
        }
    }
    laws
}

fn linkage(law: HobbingLaw) -> HobbingLinkage {
    let beta = 0.3;
    let geometry = HobbingGeometry::new(&hob(Hand::Right), beta, 1.0);
    HobbingLinkage::new(curve(&ellipse(), beta), geometry, law, 25.0, &path()).unwrap()
}

fn columns<const N: usize>(axes: &HobbingAxes<N>) -> [Jet<N>; 9] {
    [
        axes.hob_rad,
        axes.work_rad,
        axes.x_mm,
        axes.y_mm,
        axes.slide_mm,
        axes.shift_mm,
        axes.radial_mm,
        axes.polar_rad,
        axes.arc_mm,
    ]
}

#[test]
fn velocities_and_accelerations_are_derivatives() {
    let h = 1e-3;
    for law in laws() {
        let linkage = linkage(law);
        for t in [0.7, 3.1, 5.9, 10.2, 11.4] {
            // Central differences of fourth order.
            let at = |k: f64| columns(&linkage.axes::<1>(t + k * h)).map(|j| j.value());
            let (m2, m1, z, p1, p2) = (at(-2.0), at(-1.0), at(0.0), at(1.0), at(2.0));
            for (i, jet) in columns(&linkage.axes::<3>(t)).into_iter().enumerate() {
                let first = (m2[i] - 8.0 * m1[i] + 8.0 * p1[i] - p2[i]) / (12.0 * h);
                let second = (-m2[i] + 16.0 * m1[i] - 30.0 * z[i] + 16.0 * p1[i] - p2[i]) / (12.0 * h * h);
                let scale = 1.0 + jet.derivative(1).abs() + jet.derivative(2).abs();
                assert!((jet.derivative(1) - first).abs() < 1e-9 * scale, "{law:?} axis {i} at {t}: {first}");
                assert!((jet.derivative(2) - second).abs() < 1e-5 * scale, "{law:?} axis {i} at {t}: {second}");
            }
        }
    }
}

#[test]
fn nothing_jumps_between_pieces() {
    for law in laws() {
        let linkage = linkage(law);
        for corner in [2.0, 11.0] {
            let before = columns(&linkage.axes::<1>(corner - 1e-9));
            let after = columns(&linkage.axes::<1>(corner + 1e-9));
            for (i, (a, b)) in before.into_iter().zip(after).enumerate() {
                assert!((a.value() - b.value()).abs() < 1e-6, "{law:?} axis {i} at {corner}");
            }
        }
    }
}

#[test]
fn exact_laws_roll_without_slip() {
    for law in laws().into_iter().filter(|law| law.form == LinkageForm::Exact) {
        let linkage = linkage(law);
        let g = *linkage.geometry();
        for i in 0..=60 {
            let t = 0.2 * f64::from(i);
            let axes = linkage.axes::<2>(t);
            let rolled = g.arc_per_hob_rad_mm() * axes.hob_rad.value()
                + g.arc_per_slide() * axes.slide_mm.value()
                + g.arc_per_shift() * axes.shift_mm.value();
            assert!((rolled - axes.arc_mm.value()).abs() < 1e-9, "{law:?} at {t}");
            let RigidMotion3 { pose, .. } = linkage.motion(t);
            // P, a point of the work's pitch curve, lies under the hob's axis at the pitch radius while the hob is at
            // depth.
            let p = linkage.curve().frame(axes.polar_rad.value()).point_mm;
            let work_from_head = linkage.work_from_head(t);
            let head = work_from_head.inverse().point(DVec3::new(p.x, p.y, 0.0));
            let radius = head.x.hypot(head.y);
            let tilt = -axes.slide_mm.value() * g.head_angle_rad.cos();
            let depth = g.pitch_radius_mm + axes.radial_mm.value();
            assert!((radius - depth.hypot(tilt)).abs() < 1e-9, "{radius}");
            assert!((pose.translation_mm - work_from_head.translation_mm).length() < 1e-12);
        }
    }
}

#[test]
fn motions_are_the_rates_of_poses() {
    let h = 1e-4;
    for law in laws() {
        let linkage = linkage(law);
        for t in [1.1, 4.4, 8.3, 11.6] {
            let motion = linkage.motion(t);
            for q in [DVec3::new(45.0, 3.0, -20.0), DVec3::new(-10.0, 44.0, 30.0)] {
                let at = |k: f64| linkage.work_from_tool(t + k * h).point(q);
                let difference = (at(-2.0) - 8.0 * at(-1.0) + 8.0 * at(1.0) - at(2.0)) / (12.0 * h);
                let found = motion.velocity_at(motion.pose.point(q));
                assert!(found.distance(difference) < 1e-6 * difference.length(), "{law:?}: {found} not {difference}");
            }
        }
    }
}

#[test]
fn the_printed_form_is_exact_on_a_circle() {
    let beta = 0.3;
    let geometry = HobbingGeometry::new(&hob(Hand::Left), beta, -1.0);
    let circle = curve(&PitchCurveShape::Circle, beta);
    let path = FeedPath::steady(30.0, -0.8, 0.0);
    for even in [EvenMotion::ArcLength, EvenMotion::RotationAngle, EvenMotion::PolarAngle] {
        let make = |form| {
            let law = HobbingLaw { even, extra: ExtraRotation::Work, form };
            HobbingLinkage::new(circle.clone(), geometry, law, 25.0, &path).unwrap()
        };
        let (exact, printed) = (make(LinkageForm::Exact), make(LinkageForm::AsPrinted));
        let q = DVec3::new(45.0, 3.0, -20.0);
        for t in [0.0, 7.0, 29.0] {
            let off = exact.work_from_tool(t).point(q) - printed.work_from_tool(t).point(q);
            assert!(off.length() < 1e-9, "{even:?} at {t}: {off}");
        }
    }
}

#[test]
fn time_follows_from_the_hob_angle() {
    for law in laws() {
        let linkage = linkage(law);
        for turns in [0.3, 7.0, 20.0, 45.6] {
            let angle = std::f64::consts::TAU * turns;
            let t = linkage.time_at_hob_angle(angle);
            assert!((linkage.axes::<1>(t).hob_rad.value() - angle).abs() < 1e-10, "{law:?}: {turns}");
        }
    }
}

#[test]
fn feeds_faster_than_the_rolling_are_refused() {
    let beta = 0.5;
    let geometry = HobbingGeometry::new(&hob(Hand::Left), beta, 1.0);
    let law = |even| HobbingLaw { even, extra: ExtraRotation::Work, form: LinkageForm::Exact };
    let fast = FeedPath::steady(1.0, 400.0, 0.0);
    for even in [EvenMotion::ArcLength, EvenMotion::PolarAngle] {
        assert!(HobbingLinkage::new(curve(&ellipse(), beta), geometry, law(even), 25.0, &fast).is_err());
    }
    // A hollow: the work angle cannot be even.
    let hollow = PitchCurveShape::Pascal { order: 3, eccentricity: 0.2, mean_radius_mm: None };
    let still = FeedPath::steady(1.0, 0.0, 0.0);
    let refused = HobbingLinkage::new(curve(&hollow, beta), geometry, law(EvenMotion::RotationAngle), 25.0, &still);
    assert!(refused.unwrap_err().problem.contains("not convex"));
}

/// Sixty-five short pieces with two feeds in turn, then a fast one: its peak is found, and what repeats is searched
/// only until the whole curve has been gone over.
#[test]
fn a_peak_behind_many_equal_pieces_is_found() {
    let phase = |duration_s, slide, shift| FeedPhase {
        duration_s,
        slide_mm_per_s: slide,
        shift_mm_per_s: shift,
        radial_mm_per_s: 0.0,
    };
    let law = HobbingLaw { even: EvenMotion::ArcLength, extra: ExtraRotation::Work, form: LinkageForm::Exact };
    let geometry = HobbingGeometry::new(&hob(Hand::Right), 0.3, 1.0);
    let curve = curve(&ellipse(), 0.3);
    let linkage_of = |phases: Vec<FeedPhase>| {
        let path = FeedPath { phases, ..FeedPath::steady(1.0, 0.0, 0.0) };
        HobbingLinkage::new(curve.clone(), geometry, law, 25.0, &path).unwrap()
    };
    let turning = |pieces: u32| (0..pieces).map(|i| phase(0.9, 1.0, if i % 2 == 0 { 0.4 } else { -0.4 }));
    let linkage = linkage_of(turning(65).chain([phase(40.0, 1.0, 2.5), phase(1.0, 1.0, 0.4)]).collect());
    let found = peaks(&linkage, &[Limits::default(); 6]);
    let of = |peaks: &[Peak], name: &str| peaks.iter().find(|peak| peak.name() == name).copied().unwrap();
    let shift = of(&found, "shift speed");
    assert!((shift.value - 2.5).abs() < 1e-12 && shift.at > 64.9 * 0.9, "{shift:?}");
    let pieces = Motion::pieces(&linkage).len();
    assert!((3..66).contains(&pieces), "{pieces} pieces");
    // Without the fast piece every axis's peaks are those of a search through all pieces.
    let even = linkage_of(turning(65).collect());
    let found = peaks(&even, &[Limits::default(); 6]);
    for peak in &found {
        let index = dynamics::AXES.iter().position(|axis| axis == peak.axis).unwrap();
        let samples = (0..40_000).map(|i| {
            let motion = dynamics::motion(&even.axes(even.end_s() * (f64::from(i) + 0.5) / 40_000.0))[index];
            match peak.order {
                Order::Speed => motion.velocity.abs(),
                _ => motion.acceleration.abs(),
            }
        });
        let sampled = samples.fold(0.0, f64::max);
        let tolerance = 1e-3 * sampled + 1e-9;
        assert!((peak.value - sampled).abs() < tolerance, "{}: {} {sampled}", peak.name(), peak.value);
    }
}
