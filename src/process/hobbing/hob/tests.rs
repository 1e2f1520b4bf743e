//! The edge against the helicoid it lies on, its chain, and what is refused.

use super::*;
use crate::process::hobbing::scene::model::Worm;
use gearcut_core::terms::Hand;
use gearcut_core::tool::edge::{Segment, SegmentShape};
use glam::DVec2;

fn spec() -> model::HobSpec {
    model::HobSpec {
        starts: 1,
        hand: Hand::Right,
        gashes: 10,
        gash_form: GashForm::Axial,
        size: HobSize::LeadAngle(3.3_f64.to_radians()),
        length_mm: 130.0,
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
    }
}

fn hob(spec: &model::HobSpec) -> Result<Hob, Refusal> {
    Hob::new(spec, 8.0, 20_f64.to_radians())
}

/// Points along a segment in the blade frame.
fn points(segment: &Segment) -> Vec<DVec2> {
    let [from, to] = segment.y_range_mm;
    (0..=40)
        .map(|i| {
            let y = from + (to - from) * f64::from(i) / 40.0;
            let x = match &segment.shape {
                SegmentShape::Table(table) => table.x_and_slope(y)[0],
                SegmentShape::Arc { radius_mm } => (radius_mm * radius_mm - y * y).sqrt() - radius_mm,
            };
            segment.blade_from_segment.point(DVec2::new(x, y))
        })
        .collect()
}

#[test]
fn edges_lie_on_an_involute_helicoid() {
    // An involute helicoid has an involute of its base circle in every plane across the axis. Edge points of several
    // teeth, brought to such planes along the screw, must lie on it: all starts, hands and gashes by one law.
    for (hand, starts, gash_form) in
        [(Hand::Right, 1, GashForm::Axial), (Hand::Left, 3, GashForm::Axial), (Hand::Left, 2, GashForm::Helical)]
    {
        let size = HobSize::ReferenceDiameter(140.0);
        let hob = hob(&model::HobSpec { starts, hand, gash_form, size, ..spec() }).unwrap();
        let p = hob.lead_mm / TAU;
        let base = p / (hob.lead_angle_rad.cos() * 20_f64.to_radians().cos()).acos().tan();
        // Every edge point, brought back along the screw into one axial section, lies on one curve z(rho).
        let section = |blade: u32, q: DVec2| {
            let rest = hob.tool_from_blade(blade).point(DVec3::new(q.x, q.y, 0.0));
            let twist = hob.rake_twist_rad_per_mm() * q.y;
            let angle = rest.y.atan2(rest.x) + twist;
            (rest.z - hob.hand * p * angle, q.x)
        };
        let mut worst = 0.0_f64;
        for (blade, side) in [(0_u32, 1.0), (3, 1.0), (5, -1.0)] {
            for step in 0..=20 {
                let radius = 61.0 + 0.8 * f64::from(step);
                let q = DVec2::new(radius, side * hob.half_thickness_mm(radius));
                let reference = DVec2::new(70.0, side * hob.half_thickness_mm(70.0));
                let ((z, _), (z0, _)) = (section(blade, q), section(blade, reference));
                // z - z0 = side p (inv(rho) - inv(70)).
                let inv = |r: f64| ((r / base).powi(2) - 1.0).sqrt() - (base / r).acos();
                let expected = side * p * (inv(radius) - inv(70.0));
                let wrapped = (z - z0 - expected) / hob.axial_pitch_mm;
                worst = worst.max((wrapped - wrapped.round()).abs() * hob.axial_pitch_mm);
            }
        }
        assert!(worst < 1e-10, "{hand:?} {starts} {gash_form:?}: {worst:e}");
    }
}

#[test]
fn tooth_and_space_fill_the_pitch() {
    for gash_form in [GashForm::Axial, GashForm::Helical] {
        let hob = hob(&model::HobSpec { gash_form, ..spec() }).unwrap();
        // In the normal section a tooth is pi m / 2 thick, whatever the gashes: axial half thickness times cos(lambda),
        // and times cos(lambda) again for the section across the thread that a helical gash is.
        let normal = 2.0 * hob.half_thickness_mm(hob.pitch_radius_mm);
        let turn = hob.lead_angle_rad.cos();
        let expected = match gash_form {
            GashForm::Axial => 4.0 * PI / turn,
            GashForm::Helical => 4.0 * PI * turn,
        };
        assert!((normal - expected).abs() < 1e-12);
    }
}

#[test]
fn the_chain_is_closed_whatever_the_tip() {
    let protuberance = Some(model::Protuberance { height_mm: 4.0, angle_rad: 10_f64.to_radians() });
    for (tip_radius_mm, protuberance) in [(0.0, None), (2.0, None), (1.5, protuberance), (0.0, protuberance)] {
        for worm in [Worm::Involute, Worm::StraightSided] {
            for regrind_mm in [0.0, 2.5] {
                let spec = model::HobSpec { worm, tip_radius_mm, protuberance, regrind_mm, ..spec() };
                let hob = hob(&spec).unwrap();
                let ends: Vec<[DVec2; 2]> =
                    hob.edge_of(0).segments.iter().map(points).map(|p| [p[0], p[p.len() - 1]]).collect();
                for pair in ends.windows(2) {
                    assert!(pair[0][1].distance(pair[1][0]) < 2e-7, "{spec:?}: gap at {}", pair[0][1]);
                }
                let top = hob.edge_of(0).segments.iter().flat_map(points).map(|p| p.x).fold(0.0, f64::max);
                assert!((top - hob.tip_radius_mm).abs() < 1e-12);
                // Regrinding sinks everything by one amount.
                let pitch = hob.pitch_radius_mm + regrind_mm;
                assert!((pitch - 8.0 / (2.0 * 3.3_f64.to_radians().sin())).abs() < 1e-12);
                if protuberance.is_some() {
                    let full = hob.edge_of(0).segments.iter().flat_map(points).filter(|p| p.y > 0.0);
                    let beyond = full.clone().filter(|p| p.x > hob.flank_end_radius_mm + 0.1 && p.x < top - 2.0);
                    let mut count = 0;
                    for p in beyond {
                        assert!(p.y > hob.half_thickness_mm(p.x), "a protuberance stands out");
                        count += 1;
                    }
                    assert!(count > 0);
                }
            }
        }
    }
}

#[test]
fn teeth_stand_on_the_thread() {
    for (hand, gash_form, starts) in
        [(Hand::Right, GashForm::Axial, 1), (Hand::Left, GashForm::Axial, 2), (Hand::Right, GashForm::Helical, 3)]
    {
        let size = HobSize::ReferenceDiameter(150.0);
        let hob = hob(&model::HobSpec { starts, hand, gash_form, size, ..spec() }).unwrap();
        assert_eq!(hob.teeth[0].label(1), "1");
        for tooth in &hob.teeth {
            let on_thread = hob.hand * hob.lead_mm / TAU * tooth.angle_rad;
            let off = (tooth.axial_mm - on_thread) / hob.axial_pitch_mm;
            let start = off - f64::from(tooth.start);
            let turns = start / f64::from(starts);
            assert!((turns - turns.round()).abs() < 1e-9, "{tooth:?}");
            assert!(tooth.axial_mm.abs() <= 65.0 + 1e-9);
        }
        for start in 0..starts {
            let thread: Vec<&HobTooth> = hob.teeth.iter().filter(|t| t.start == start).collect();
            assert!(thread.iter().zip(1..).all(|(tooth, number)| tooth.number == number));
            assert!(thread.windows(2).all(|w| (w[0].axial_mm - w[1].axial_mm - hob.tooth_spacing_mm()).abs() < 1e-9));
        }
    }
}

#[test]
fn impossible_hobs_are_refused_by_key() {
    let refused = |spec: model::HobSpec| hob(&spec).unwrap_err().key;
    assert_eq!(refused(model::HobSpec { size: HobSize::LeadAngle(0.6), ..spec() }), "tool.hob.lead_angle_deg");
    assert_eq!(
        refused(model::HobSpec { size: HobSize::ReferenceDiameter(7.0), ..spec() }),
        "tool.hob.reference_diameter_mm"
    );
    assert_eq!(refused(model::HobSpec { tip_radius_mm: 9.0, ..spec() }), "tool.hob.tip_radius_mm");
    assert_eq!(refused(model::HobSpec { addendum_coefficient: 2.4, ..spec() }), "tool.hob.addendum_coefficient");
    let flat = Some(model::Protuberance { height_mm: 4.0, angle_rad: 25_f64.to_radians() });
    assert_eq!(refused(model::HobSpec { protuberance: flat, ..spec() }), "tool.hob.protuberance_height_mm");
}
