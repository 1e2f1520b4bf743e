use super::*;
use std::f64::consts::TAU;

/// Marks 60 um apart across 20 deg with ripples and hills that repeat nowhere; places in um.
fn flank(x: f64, y: f64) -> f64 {
    let across = x * 20_f64.to_radians().cos() + y * 20_f64.to_radians().sin();
    let hill = |cx: f64, cy: f64, r: f64| (-((x - cx).powi(2) + (y - cy).powi(2)) / (r * r)).exp();
    (TAU * across / 60.0).cos() + 1.5 * hill(210.0, 130.0, 50.0) - 1.2 * hill(420.0, 260.0, 70.0)
        + 0.8 * hill(90.0, 330.0, 40.0)
}

fn sampled(nx: usize, ny: usize, step: f64, height: impl Fn(f64, f64) -> f64) -> Surface {
    let heights = (0..nx * ny).map(|i| height((i % nx) as f64 * step, (i / nx) as f64 * step)).collect();
    Surface::new(nx, ny, step, step, heights).expect("a grid")
}

#[test]
fn a_shifted_tilted_part_comes_back_to_its_place() {
    let whole = sampled(180, 140, 3.0, flank);
    // A part that begins at (71.3, 46.9) um, on other points, tilted.
    let part = sampled(170, 150, 2.0, |x, y| flank(x + 71.3, y + 46.9) + 4.0 + 0.003 * x - 0.007 * y);
    let found = aligned(&whole, &part).expect("laid over");
    let a = &found.alignment;
    assert_eq!(a.mirrored, [false, false]);
    assert!((a.shift_um[0] - 71.3).abs() < 0.05 && (a.shift_um[1] - 46.9).abs() < 0.05, "{a:?}");
    assert!((a.plane[1] + 3.0).abs() < 0.05 && (a.plane[2] - 7.0).abs() < 0.05, "{a:?}");
    assert!(a.correlation > 0.9999, "{a:?}");
    let rest = difference(&found).expect("a difference");
    let largest = rest.heights_um().iter().fold(0.0_f64, |m, z| m.max(z.abs()));
    assert!(largest < 0.02, "{largest}");
}

/// An instrument's noise of 30 nm on marks of 1 um: the hills hold the part across and along the marks. Where there are
/// marks alone, which all look alike, it stays across them and slides along them.
#[test]
fn noise_of_an_instrument_moves_a_part_by_a_fraction_of_a_point() {
    // Sum of four equal distributions, 30 nm.
    let noise = |x: f64, y: f64| {
        let mut state = (x * 7919.0 + y * 104_729.0).to_bits();
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / (1_u64 << 31) as f64 - 0.5
        };
        0.03 * 3_f64.sqrt() * (0..4).map(|_| next()).sum::<f64>()
    };
    let whole = sampled(180, 140, 3.0, |x, y| flank(x, y) + noise(x + 1e4, y));
    let part = sampled(170, 150, 2.0, |x, y| flank(x + 71.3, y + 46.9) + noise(x, y));
    let found = aligned(&whole, &part).expect("laid over").alignment;
    let off = [found.shift_um[0] - 71.3, found.shift_um[1] - 46.9];
    println!("{off:?} {found:?}");
    assert!(off[0].hypot(off[1]) < 0.2 && found.correlation > 0.99, "{off:?} {found:?}");
    let marks = |x: f64, y: f64| (TAU * (x * 20_f64.to_radians().cos() + y * 20_f64.to_radians().sin()) / 60.0).cos();
    let whole = sampled(180, 140, 3.0, |x, y| marks(x, y) + noise(x + 1e4, y));
    let part = sampled(170, 150, 2.0, |x, y| marks(x + 71.3, y + 46.9) + noise(x, y));
    let found = aligned(&whole, &part).expect("laid over").alignment;
    let off = [found.shift_um[0] - 71.3, found.shift_um[1] - 46.9];
    let across = off[0] * 20_f64.to_radians().cos() + off[1] * 20_f64.to_radians().sin();
    println!("{across} {off:?} {found:?}");
    assert!((across - 60.0 * (across / 60.0).round()).abs() < 0.1, "{across} {found:?}");
}

#[test]
fn mirrors_are_found_and_inverted_heights_told() {
    let whole = sampled(150, 130, 3.0, flank);
    for (mirrored, k) in [([true, false], 1), ([false, true], 2), ([true, true], 3)] {
        let turned = mirror(&whole, mirrored).expect("mirrored");
        let a = aligned(&whole, &turned).expect("laid over").alignment;
        assert_eq!(a.mirrored, mirrored, "{a:?}");
        assert!(a.by_mirror[k] > 0.99 && a.shift_um.iter().all(|s| s.abs() < 0.05), "{a:?}");
    }
    let inverted = sampled(150, 130, 3.0, |x, y| -flank(x, y));
    let a = aligned(&whole, &inverted).expect("laid over").alignment;
    // Half a mark beside it, turned round, correlates well, too; the other sign leaves less than half of that variance.
    assert!(a.inverted > 0.99 && fits_better(a.inverted, a.correlation), "{a:?}");
}

#[test]
fn holes_do_not_pull_and_strangers_do_not_correlate() {
    let whole = sampled(160, 130, 3.0, flank);
    let holed =
        sampled(160, 130, 3.0, |x, y| if (x - 200.0).hypot(y - 150.0) < 60.0 { f64::NAN } else { flank(x + 12.0, y) });
    let a = aligned(&whole, &holed).expect("laid over").alignment;
    assert!((a.shift_um[0] - 12.0).abs() < 0.05 && a.shift_um[1].abs() < 0.05, "{a:?}");
    let stranger = sampled(160, 130, 3.0, |x, y| ((0.37 * x * x + 1.7 * y).sin() * 43_758.545_3).fract());
    assert!(aligned(&whole, &stranger).expect("laid over").alignment.correlation < 0.5);
}

#[test]
fn marks_have_their_pitch_direction_and_phase() {
    let wave = |late_um: f64| {
        move |x: f64, y: f64| {
            let across = x * 0.6_f64.cos() - y * 0.6_f64.sin();
            0.7 * (TAU * (across - late_um) / 41.3).cos() + 1e-5 * (x - 100.0) * y
        }
    };
    let first = sampled(250, 200, 2.0, wave(0.0));
    let found = marks(&first).expect("marks");
    assert!((found.pitch_um - 41.3).abs() < 0.02, "{found:?}");
    assert!((found.direction_deg + 0.6_f64.to_degrees()).abs() < 0.03, "{found:?}");
    assert!((found.amplitude_um - 0.7).abs() < 0.01, "{found:?}");
    let late = found.phase_on_deg(&sampled(250, 200, 2.0, wave(10.0))).expect("a phase");
    assert!((late + 360.0 * 10.0 / 41.3).abs() < 0.2, "{late}");
    let flat = Surface::new(20, 20, 1.0, 1.0, vec![0.0; 400]).expect("a grid");
    assert!(marks(&flat).expect_err("none").to_string().contains("no marks"));
}
