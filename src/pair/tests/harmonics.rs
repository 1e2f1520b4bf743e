//! Waves of the transmission error.

use super::*;
use crate::pair::rolling::{peak_to_peak, roll, turns_of_period};
use serde_json::json;

#[test]
fn an_eccentric_driver_gives_one_long_wave() {
    let file = data("p01_circular");
    let case = &file["cases"][0];
    let pair = pair_of(&case["design"]);
    let eccentric = json!({ "e1": 0.03, "eps1": 0.7 });
    let meshing = meshing(&pair, addendum_mm(&case["design"]), &eccentric);
    let rolled = roll(&meshing, 480, || Ok(())).expect("a period");
    assert_eq!((rolled.turns, turns_of_period([20, 40])), (2, 2));
    let error = rolled.transmission_error(Side::Right);
    // e1 / rb2 for a wave of the first order, to first order; the next one is smaller by e1 / a.
    let first = 0.03 / case["base_radii"][1].as_f64().expect("a radius");
    let amplitude = |order: f64| error.harmonics.iter().find(|h| h.0 == order).expect("an order").1;
    assert!((amplitude(1.0) / first - 1.0).abs() < 2e-3, "{} not {first}", amplitude(1.0));
    assert!(amplitude(2.0) < 2e-3 * first && amplitude(20.0) < 1e-5 * first);
    assert!(peak_to_peak(&error.mesh_rad) < 1e-5 * first, "{}", peak_to_peak(&error.mesh_rad));
    for (i, ratio) in rolled.ratios().into_iter().enumerate() {
        let phi = rolled.moments[i].pitch.phi_1_rad;
        let slope = first * (phi - 0.7 + 20.0_f64.to_radians()).cos();
        assert!((ratio[1] - 1.0 / (0.5 + slope)).abs() < 1e-5, "{ratio:?} at {phi}");
    }
    assert!(roll(&meshing, 100, || Ok(())).is_err_and(|refused| refused.to_string().contains("40 teeth")));
}
