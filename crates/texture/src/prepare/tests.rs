use super::*;
use std::f64::consts::TAU;

fn grid(nx: usize, ny: usize, height: impl Fn(f64, f64) -> f64) -> Surface {
    let heights = (0..nx * ny).map(|i| height((i % nx) as f64, (i / nx) as f64)).collect();
    Surface::new(nx, ny, 2.0, 3.0, heights).expect("a grid")
}

fn only(change: impl FnOnce(&mut Preparation)) -> Preparation {
    let mut preparation = Preparation::default();
    change(&mut preparation);
    preparation
}

#[test]
fn a_replica_turned_back_is_the_original() {
    let original = grid(7, 5, |x, y| (1.3 * x + 0.7 * y * y).sin());
    let replica = {
        let heights = (0..35).map(|i| -original.row(i / 7)[6 - i % 7]).collect();
        Surface::new(7, 5, 2.0, 3.0, heights).expect("a grid")
    };
    let back = Preparation { invert: true, mirror: Some(MirrorAxis::X), ..Preparation::default() };
    let (turned, words) = back.apply(&replica).expect("turned");
    assert_eq!(turned, original);
    assert_eq!(words.len(), 2);
}

#[test]
fn right_angles_move_points_and_four_of_them_move_none() {
    let original = grid(4, 3, |x, y| x + 10.0 * y);
    let quarter = only(|p| p.rotate = Some(Turn::Degrees(90.0)));
    let (once, _) = quarter.apply(&original).expect("turned");
    assert_eq!((once.nx(), once.ny(), once.dx_um(), once.dy_um()), (3, 4, 3.0, 2.0));
    // +x turns to +y: the first row runs up the last column.
    assert_eq!(once.column(2), [0.0, 1.0, 2.0, 3.0]);
    let back = only(|p| p.rotate = Some(Turn::Degrees(-90.0)));
    assert_eq!(back.apply(&once).expect("turned").0, original);
    let half = only(|p| p.rotate = Some(Turn::Degrees(180.0)));
    assert_eq!(half.apply(&original).expect("turned").0, quarter.apply(&once).expect("turned").0);
}

/// A wave that runs at 30 deg runs at 47 deg after a turn by 17: the map is the wave of that direction, to the damping
/// of the interpolation.
#[test]
fn a_turned_wave_runs_in_the_turned_direction() {
    let wave = |deg: f64| {
        let (sin, cos) = deg.to_radians().sin_cos();
        move |x: f64, y: f64| (TAU * (x * cos + y * sin) / 40.0).sin()
    };
    let (nx, ny) = (160, 110);
    let place = |x: f64, y: f64| (2.0 * (x - 79.5), 3.0 * (y - 54.5));
    let original = grid(nx, ny, |x, y| {
        let (x, y) = place(x, y);
        wave(30.0)(x, y)
    });
    let (turned, words) = only(|p| p.rotate = Some(Turn::Degrees(17.0))).apply(&original).expect("turned");
    assert!(words[0].contains("17.000 deg"), "{words:?}");
    assert_eq!(turned.holes(), 0);
    let (mx, my) = (turned.nx(), turned.ny());
    for y in 0..my {
        for x in 0..mx {
            let (u, v) = (2.0 * (x as f64 - 0.5 * (mx - 1) as f64), 3.0 * (y as f64 - 0.5 * (my - 1) as f64));
            let error = turned.row(y)[x] - wave(47.0)(u, v);
            assert!(error.abs() < 0.02, "{x} {y}: {error}");
        }
    }
    let (along, _) = only(|p| p.rotate = Some(Turn::Lay)).apply(&original).expect("turned");
    let std = Spatial::of(&along, false).std.expect("a direction");
    assert!((std - 90.0).abs() < 1.0, "{std}");
}

#[test]
fn the_inscribed_rectangle_touches_the_map() {
    for (w, h, deg) in [(3.0, 2.0, 10.0_f64), (2.0, 3.0, 10.0), (5.0, 1.0, 40.0), (1.0, 5.0, 60.0), (2.0, 2.0, 45.0)] {
        let (sin, cos) = deg.to_radians().sin_cos();
        let [a, b] = inscribed(w, h, sin, cos);
        // Corners of the rectangle in the frame of the map.
        let reach = [a * cos + b * sin, a * sin + b * cos];
        assert!(reach[0] <= w + 1e-9 && reach[1] <= h + 1e-9, "{w} {h} {deg}: {a} {b}");
        assert!((reach[0] - w).abs() < 1e-9 || (reach[1] - h).abs() < 1e-9);
    }
}

#[test]
fn spikes_are_outliers_and_steps_of_the_surface_are_none() {
    let noise = |x: f64, y: f64| 0.01 * ((12.9898 * x + 78.233 * y).sin() * 43758.5453).fract();
    let mut heights = grid(40, 30, |x, y| noise(x, y) + if x > 19.0 { 5.0 } else { 0.0 }).heights_um().to_vec();
    for i in [77, 500, 1111] {
        heights[i] += 1.0;
    }
    let spiked = Surface::new(40, 30, 2.0, 3.0, heights).expect("a grid");
    let (kept, words) = only(|p| p.outliers = Some(8.0)).apply(&spiked).expect("kept");
    assert!(words[0].starts_with("outliers: 3 points"), "{words:?}");
    assert!([77, 500, 1111].iter().all(|&i| kept.heights_um()[i].is_nan()));
}

/// x y and x^2 - y^2 are harmonic on the grid as well: holes filled with them come back.
#[test]
fn holes_are_filled_with_the_harmonic_surface() {
    let original = grid(30, 20, |x, y| 0.01 * (x * y - 3.0 * x + x * x - y * y));
    let holes = |x: f64, y: f64| (8.0..=14.0).contains(&x) && (5.0..=11.0).contains(&y);
    let holed = grid(30, 20, |x, y| if holes(x, y) { f64::NAN } else { original.row(y as usize)[x as usize] });
    let (filled, words) = only(|p| p.fill = true).apply(&holed).expect("filled");
    assert_eq!(words, ["fill: 49 holes filled with harmonic surfaces"]);
    for (a, b) in filled.heights_um().iter().zip(original.heights_um()) {
        assert!((a - b).abs() < 1e-4, "{a} {b}");
    }
    let empty = grid(30, 20, |x, _| if x > 10.0 { f64::NAN } else { x });
    assert!(only(|p| p.fill = true).apply(&empty).expect_err("too many").to_string().contains("20 %"));
}

#[test]
fn rectangles_take_the_points_in_them() {
    let original = grid(6, 5, |x, y| x + 10.0 * y);
    let (part, _) = only(|p| p.crop_um = Some([[2.0, 6.0], [3.0, 8.9]])).apply(&original).expect("a part");
    assert_eq!(part.heights_um(), [11.0, 12.0, 13.0, 21.0, 22.0, 23.0]);
    let (masked, words) = only(|p| p.masks_um = vec![[[2.0, 6.0], [3.0, 8.9]]]).apply(&original).expect("masked");
    assert_eq!(masked.holes(), 6);
    assert!(words[0].starts_with("mask: 6 points"), "{words:?}");
    for beside in [[[-5.0, -1.0], [0.0, 5.0]], [[20.0, 30.0], [0.0, 5.0]], [[0.1, 0.2], [0.0, 5.0]]] {
        assert!(
            only(|p| p.crop_um = Some(beside)).apply(&original).expect_err("beside").to_string().contains("no point")
        );
    }
}
