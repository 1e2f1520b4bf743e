//! A fit that Ctrl-C ends early: what is finished is kept.

use super::round::loaded;
use crate::fixtures::stopping::Stopping;
use gearcut::backend::Choice;
use gearcut::influence::budget::chosen;
use gearcut::influence::calibrate::{Calibration, MeasuredGear};
use gearcut::influence::charts::{LaidCharts, MeasuredLine};
use gearcut::influence::known_cuts::KnownCuts;
use gearcut::influence::measured::{Chart, MeasuredPoint};
use gearcut::interrupt::Interrupt;
use gearcut::process;
use gearcut::progress::{Progress, ProgressMode};
use gearcut::terms::Side;

/// Ctrl-C keeps the rounds that are done, and what none is done of is an interruption.
#[test]
fn a_fit_that_is_stopped_keeps_its_rounds() {
    let loaded = loaded(&[]);
    let parameters = chosen(&loaded, &["machine.errors.guide.tangential_um_per_100mm".to_owned()]).expect("a guide");
    let slope_um_per_mm = 0.3 * 20_f64.to_radians().cos();
    let point = |v_mm: f64| MeasuredPoint {
        tooth: 5,
        side: Side::Left,
        u_mm: 2.5,
        v_mm,
        deviation_um: 7.0 + slope_um_per_mm * v_mm,
    };
    let line = MeasuredLine { chart: Chart::Helix, points: (-4..=4).map(|i| point(2.0 * f64::from(i))).collect() };
    let measured = MeasuredGear { lines: vec![line.clone()], noise_um: 0.1, ..MeasuredGear::default() };
    let fit = |cuts: usize| {
        let interrupt = Interrupt::default();
        let backend = Stopping::at(cuts, &interrupt);
        let choice = Choice { backend: Box::new(backend), why: String::new(), on_trial: false };
        let quiet = Progress::new(ProgressMode::Quiet);
        Calibration::new(&loaded, &parameters, &measured, &choice, &quiet, &interrupt, &KnownCuts::default())
    };
    // The scene, both sides of a difference, the step.
    let stopped = fit(4).expect("a round");
    assert!(!stopped.complete && !stopped.settled, "{stopped:?}");
    let whole = fit(usize::MAX).expect("cut");
    assert!(whole.complete && whole.settled, "{whole:?}");
    for found in [&stopped, &whole] {
        let [shift, half] = found.fitted[0].1.expect("the helix says it");
        // Nine places of 0.1 um over sum(v^2) = 240 mm^2; 7 degrees of freedom.
        let expected = 2.365 * 0.1 / 240_f64.sqrt() / 20_f64.to_radians().cos() * 100.0;
        assert!((shift - 30.0).abs() < 0.3 && (half / expected - 1.0).abs() < 0.02, "{shift} +- {half}, {expected}");
        assert_eq!(found.freedom, 7);
    }
    assert!(matches!(fit(2), Err(gearcut::Error::Interrupted)));
    // Planted: the zero of the chart is nobody's; without it the line would be 7 um off.
    let mut raised = line;
    raised.points.iter_mut().for_each(|point| point.deviation_um += 50.0);
    let mut known = Vec::new();
    process::prepare(&loaded.scene)
        .expect("a gear")
        .with_gear(&mut |gear| {
            let um: Vec<f64> = raised.points.iter().map(|point| point.deviation_um).collect();
            known = LaidCharts::new(gear, &[raised.clone()])?.known(0, &um);
            Ok(())
        })
        .expect("a flank");
    let mean: f64 = known.iter().sum();
    assert!(mean.abs() < 1e-9 && (known[8] - 8.0 * slope_um_per_mm).abs() < 1e-9, "{known:?}");
}
