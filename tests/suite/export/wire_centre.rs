//! Where a wire's centre runs beside polygons, and the signed distances that it is judged by.

use gearcut::export::wire_centre::centre_path;
use gearcut::measure::target_outline::TargetOutline;
use gearcut_core::gear::Back;
use glam::DVec2;
use std::f64::consts::PI;

/// Path round a square of 10 mm with a notch in its upper side, 4 mm deep, from the middle of its lower side.
fn round_a_notch(half_mm: f64) -> (TargetOutline, Vec<DVec2>) {
    let [left, right] = [5.0 - half_mm, 5.0 + half_mm];
    let notch = [(right, 10.0), (right, 6.0), (left, 6.0), (left, 10.0)];
    let corners = [&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)], &notch[..], &[(0.0, 10.0)]].concat();
    let corners: Vec<DVec2> = corners.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
    let side = |i: usize| {
        let [from, to] = [i, (i + 1) % 8].map(|i| corners[i]);
        (0..50).map(move |k| from.lerp(to, f64::from(k) / 50.0))
    };
    let mut chain: Vec<DVec2> = (0..8).flat_map(side).collect();
    chain.rotate_left(25);
    let outline = TargetOutline::new(chain.clone(), Back::bore(0.0));
    let path = centre_path(&chain, &outline, 0.5, 0.4999).expect("a path");
    (outline, path)
}

fn near(path: &[DVec2], place: DVec2) -> f64 {
    path.iter().map(|p| p.distance(place)).fold(f64::INFINITY, f64::min)
}

/// The wire goes round sharp corners on arcs and turns at once in hollow ones.
#[test]
fn hollow_corners_are_turned_in_and_sharp_ones_gone_round() {
    let (outline, path) = round_a_notch(2.0);
    for x in [3.5, 6.5] {
        assert!(near(&path, DVec2::new(x, 6.5)) < 1e-9, "{x}: {}", near(&path, DVec2::new(x, 6.5)));
    }
    let off = |p: &DVec2| outline.distance_mm(*p, 1.0).expect("near") - 0.5;
    assert!(path.iter().all(|p| off(p).abs() < 1e-9));
    let length_mm: f64 = path.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    // Quarters of circles at six corners; two sides end half a millimetre earlier at either hollow one.
    let exact_mm = 48.0 + 6.0 * 0.25 * PI - 4.0 * 0.5;
    assert!((length_mm - exact_mm).abs() < 1e-3, "{length_mm} mm, not {exact_mm} mm");
}

/// Arcs about the edges of a notch of 0.6 mm cross 0.4 mm above it; the wire of 1 mm goes no deeper.
#[test]
fn a_notch_too_narrow_is_passed_by() {
    let (outline, path) = round_a_notch(0.3);
    assert!(near(&path, DVec2::new(5.0, 10.4)) < 1e-3);
    assert!(path.iter().all(|p| outline.distance_mm(*p, 1.0).is_none_or(|far| far > 0.4998)));
    assert!(path.iter().all(|p| (p.x - 5.0).abs() > 0.4 || p.y < 0.0 || p.y > 10.39));
}

/// Beyond a corner sharper than a right angle a point lies behind the line of one of its sides.
#[test]
fn beyond_a_sharp_corner_there_is_air_and_in_its_hollow_twin_material() {
    let needle = [(0.0, -1.0), (10.0, 0.0), (0.0, 1.0)].map(|(x, y)| DVec2::new(x, y)).to_vec();
    let round = |outline: &TargetOutline| {
        (-80..=80)
            .map(|deg| DVec2::new(10.0, 0.0) + DVec2::from_angle(f64::from(deg).to_radians()))
            .map(|p| outline.distance_mm(p, 2.0).expect("near"))
            .collect::<Vec<_>>()
    };
    let tip = round(&TargetOutline::new(needle.clone(), Back::bore(0.0)));
    assert!(tip.iter().all(|far| (far - 1.0).abs() < 1e-12), "{tip:?}");
    let slit = [(20.0, -5.0), (20.0, 5.0), (-1.0, 5.0), (0.0, 1.0), (10.0, 0.0), (0.0, -1.0), (-1.0, -5.0)];
    let slit = slit.map(|(x, y)| DVec2::new(x, y)).to_vec();
    let foot = round(&TargetOutline::new(slit, Back::bore(0.0)));
    assert!(foot.iter().all(|far| (far + 1.0).abs() < 1e-12), "{foot:?}");
}
