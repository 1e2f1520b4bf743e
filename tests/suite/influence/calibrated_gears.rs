//! Calibrations of many gears that were cut with known errors, by the lines of their inspections.

use super::cut_gears::{GEARS, KnownErrors, NOISE_UM, Random, TEETH, Tally, coarse};
use gearcut::backend::{BackendWish, Choice, OnFailure, choose};
use gearcut::influence::calibrate::{Calibration, MeasuredGear, findings};
use gearcut::influence::charts::{LaidCharts, MeasuredLine};
use gearcut::influence::gear_grid::evenly;
use gearcut::influence::known_cuts::KnownCuts;
use gearcut::influence::measured::{Chart, MeasuredPoint};
use gearcut::interrupt::Interrupt;
use gearcut::process::{self, ProcessJob};
use gearcut::progress::{Progress, ProgressMode};
use gearcut::scene::LoadedScene;
use gearcut::terms::Side;
use std::f64::consts::PI;
use std::sync::LazyLock;

const SIDES: [Side; 2] = [Side::Left, Side::Right];

/// Profile and helix of both flanks of four teeth, the first and the last among them, and pitch of both sides.
fn lines(loaded: &LoadedScene) -> (Vec<MeasuredLine>, LaidCharts) {
    let half_mm = 0.45 * loaded.scene.gear.face_width_mm;
    let (mut lines, mut laid) = (Vec::new(), None);
    process::prepare(&loaded.scene)
        .expect("a gear")
        .with_gear(&mut |gear| {
            let point = |tooth, side, u_mm, v_mm| MeasuredPoint { tooth, side, u_mm, v_mm, deviation_um: 0.0 };
            for (tooth, side) in [1, 6, 11, TEETH].into_iter().flat_map(|tooth| SIDES.map(|side| (tooth, side))) {
                let [from_mm, to_mm] = gear.evaluated_profile_mm(tooth, side)?;
                let profile = evenly([from_mm, to_mm], 9).into_iter().map(|u_mm| point(tooth, side, u_mm, 0.0));
                lines.push(MeasuredLine { chart: Chart::Profile, points: profile.collect() });
                let middle_mm = 0.5 * (from_mm + to_mm);
                let helix = evenly([-half_mm, half_mm], 5).into_iter().map(|v_mm| point(tooth, side, middle_mm, v_mm));
                lines.push(MeasuredLine { chart: Chart::Helix, points: helix.collect() });
            }
            lines.extend(SIDES.map(|side| {
                let pitch = (1..=TEETH).map(|tooth| point(tooth, side, f64::NAN, f64::NAN));
                MeasuredLine { chart: Chart::Pitch, points: pitch.collect() }
            }));
            laid = Some(LaidCharts::new(gear, &lines)?);
            Ok(())
        })
        .expect("flanks");
    (lines, laid.expect("a gear"))
}

/// A round gear and its lines.
struct Bench {
    loaded: LoadedScene,
    ready: Box<dyn ProcessJob>,
    lines: Vec<MeasuredLine>,
    laid: LaidCharts,
    choice: Choice,
}

/// One for all tests.
static BENCH: LazyLock<Bench> = LazyLock::new(Bench::new);

impl Bench {
    fn new() -> Self {
        let loaded = coarse();
        let (lines, laid) = lines(&loaded);
        let ready = process::prepare(&loaded.scene).expect("a gear");
        Self {
            loaded,
            ready,
            lines,
            laid,
            choice: choose(BackendWish::Cpu, OnFailure::default()).expect("the processor"),
        }
    }

    /// The gear that is cut with these errors, as it is measured.
    fn measured(&self, errors: &KnownErrors, random: &mut Random) -> MeasuredGear {
        let ready = self.ready.with_errors_of(&errors.scene(&self.loaded)).expect("a gear");
        let cut_um = self.laid.predicted_um(ready.as_ref(), self.choice.backend.as_ref()).expect("cut");
        let mut lines = self.lines.clone();
        for (line, cut_um) in lines.iter_mut().zip(cut_um) {
            for (point, um) in line.points.iter_mut().zip(cut_um) {
                point.deviation_um = um + NOISE_UM * random.normal();
            }
        }
        MeasuredGear { lines, noise_um: NOISE_UM, ..MeasuredGear::default() }
    }

    /// The errors of a gear fitted.
    fn fit(&self, errors: &KnownErrors, measured: &MeasuredGear) -> Calibration {
        let parameters: Vec<_> = errors.sizes.iter().map(|(parameter, _)| parameter.clone()).collect();
        let (quiet, go_on, known) = (Progress::new(ProgressMode::Quiet), Interrupt::default(), KnownCuts::default());
        Calibration::new(&self.loaded, &parameters, measured, &self.choice, &quiet, &go_on, &known).expect("cut")
    }
}

mod slow {
    use super::*;

    #[test]
    fn errors_of_gears_that_were_cut_are_in_their_intervals() {
        let bench = &*BENCH;
        let mut random = Random(20_261_125);
        let (mut tally, mut planted) = (Tally::default(), Tally::default());
        for gear in 0..GEARS {
            let errors = KnownErrors::draw(&bench.loaded, &mut random);
            let found = bench.fit(&errors, &bench.measured(&errors, &mut random));
            assert!(found.settled, "gear {gear}: {:?}", errors.sources);
            tally.blamed += usize::from(found.chance.is_some_and(|chance| chance < 1e-3));
            for (parameter, fitted) in &found.fitted {
                let fitted = fitted.unwrap_or_else(|| panic!("gear {gear}: {} is not identified", parameter.id));
                tally.count(fitted, errors.size_of(&parameter.id));
                planted.count(fitted, 1.1 * errors.size_of(&parameter.id));
            }
        }
        println!("{tally:?}; planted {planted:?}");
        assert!(tally.holds(), "{tally:?}");
        assert!(tally.blamed <= 1, "noise alone was called unexplained: {tally:?}");
        // Planted: errors a tenth larger than those of the cut.
        assert!(!planted.holds(), "{planted:?}");
    }

    /// What no fitted error makes: profiles of one tooth hollow by 4 um.
    #[test]
    fn an_error_outside_of_the_model_is_called_unexplained() {
        let bench = &*BENCH;
        let mut random = Random(12);
        let errors = KnownErrors::draw(&bench.loaded, &mut random);
        let sound = bench.measured(&errors, &mut random);
        let mut hollow = sound.clone();
        for line in hollow.lines.iter_mut().filter(|line| line.chart == Chart::Profile && line.points[0].tooth == TEETH)
        {
            let last = (line.points.len() - 1) as f64;
            let share = |place: usize| place as f64 / last;
            line.points.iter_mut().enumerate().for_each(|(i, point)| point.deviation_um -= 4.0 * (PI * share(i)).sin());
        }
        for (measured, is_told) in [(&hollow, true), (&sound, false)] {
            let found = bench.fit(&errors, measured);
            let tree = findings(&bench.loaded.scene, measured, &found);
            let told = tree.warnings.iter().any(|warning| warning.text.starts_with("unexplained"));
            assert_eq!(told, is_told, "chance {:?}: {:?}", found.chance, tree.warnings);
        }
    }
}
