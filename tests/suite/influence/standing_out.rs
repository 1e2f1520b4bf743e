//! What stands out of a gear and is no error of a machine.

use super::cut_gears::{NOISE_UM, Random, TEETH, coarse};
use super::round::backend;
use gearcut::influence::diagnose::{Diagnosis, ErrorModel, MeasuredCuts, Noise, diagnose, findings, sheet};
use gearcut::influence::gear_grid::evenly;
use gearcut::influence::known_cuts::KnownCuts;
use gearcut::influence::measured::MeasuredPoint;
use gearcut::interrupt::Interrupt;
use gearcut::output::text::Sheet;
use gearcut::process;
use gearcut::progress::{Progress, ProgressMode};
use gearcut::scene::LoadedScene;
use gearcut::terms::Side;

/// Five by five places on both flanks of every tooth.
fn places(loaded: &LoadedScene) -> Vec<MeasuredPoint> {
    let mut found = Vec::new();
    process::prepare(&loaded.scene)
        .expect("a gear")
        .with_gear(&mut |gear| {
            for (tooth, side) in (1..=TEETH).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]) {
                for u_mm in evenly(gear.evaluated_profile_mm(tooth, side)?, 5) {
                    let along = evenly([-8.0, 8.0], 5).into_iter();
                    found.extend(along.map(|v_mm| MeasuredPoint { tooth, side, u_mm, v_mm, deviation_um: 0.0 }));
                }
            }
            Ok(())
        })
        .expect("flanks");
    found
}

/// The gear room: a scene, what its gear shows at the places, and its cuts.
struct Room {
    loaded: LoadedScene,
    points: Vec<MeasuredPoint>,
    known: KnownCuts,
}

impl Room {
    fn new() -> Self {
        let loaded = coarse();
        let points = places(&loaded);
        Self { loaded, points, known: KnownCuts::default() }
    }

    /// A gear with an eccentricity and something added, diagnosed; what is said of it.
    fn diagnosed(
        &self,
        eccentric_um: f64,
        add_um: impl Fn(&MeasuredPoint) -> f64,
    ) -> (ErrorModel, Diagnosis, Vec<String>, String) {
        let cpu = backend();
        let cuts = MeasuredCuts::new(&self.loaded, &self.points, &cpu, &self.known).expect("places");
        let settings = [format!("mounting.eccentricity_um={eccentric_um}")];
        let eccentric = self.loaded.with_settings(&settings, process::table()).expect("a scene");
        let cut_um = cuts.deviations_um(&eccentric.scene).expect("cut");
        let mut random = Random(5);
        let measured_um: Vec<f64> =
            self.points.iter().zip(&cut_um).map(|(at, um)| um + add_um(at) + NOISE_UM * random.normal()).collect();
        let names = ["mounting.eccentricity_um", "machine.errors.work"].map(str::to_owned);
        let (quiet, go_on) = (Progress::new(ProgressMode::Quiet), Interrupt::default());
        let (model, found) =
            diagnose(&cuts, &measured_um, &Noise::of_values(NOISE_UM), &names, &quiet, &go_on).expect("a diagnosis");
        let tree = findings(&self.loaded.scene, &model, &self.points, &Noise::of_values(NOISE_UM), &found);
        let mut printed = Sheet::default();
        sheet(&model, &found, &tree, &mut printed);
        let warnings = tree.warnings.iter().map(|warning| warning.text.clone()).collect();
        (model, found, warnings, printed.into_text())
    }
}

fn named(model: &ErrorModel, found: &Diagnosis) -> Vec<String> {
    found.named.iter().map(|named| model.sources[named.source].key.clone()).collect()
}

/// Twice a displaced tooth is no wave of the drive, on an eccentric gear either; a hollow profile and a step along the
/// face are no errors of a machine. Each is named with its size, and nothing else is.
#[test]
fn teeth_steps_and_hollow_profiles_are_named_as_what_they_are() {
    let room = Room::new();
    let displaced = |at: &MeasuredPoint| match (at.tooth, at.side) {
        (7 | 8, Side::Left) => 9.0,
        (7 | 8, Side::Right) => -9.0,
        _ => 0.0,
    };
    let (ends, half) = (room.points[0].u_mm, 0.5 * (room.points[24].u_mm - room.points[0].u_mm));
    let hollow = |at: &MeasuredPoint| -6.0 * (1.0 - ((at.u_mm - ends) / half - 1.0).powi(2));
    let step = |at: &MeasuredPoint| if at.v_mm > 2.0 { 2.5 } else { -2.5 };
    let thin = |at: &MeasuredPoint| if at.tooth == 3 { -6.0 } else { 0.0 };
    let eccentric = vec!["mounting.eccentricity_um".to_owned()];
    for (eccentric_um, add_um, words, sizes_um, expected) in [
        (
            8.0,
            &displaced as &dyn Fn(&MeasuredPoint) -> f64,
            "teeth 7 and 8 stand out by ",
            &[9.0, -9.0, 9.0, -9.0][..],
            eccentric.clone(),
        ),
        (0.0, &hollow, "profiles of all teeth are hollow: ", &[-6.0, -6.0], vec![]),
        (8.0, &step, "flanks of all teeth step at v = 2.00 mm: ", &[5.0, 5.0], eccentric.clone()),
        (8.0, &thin, "tooth 3 stands out by ", &[-6.0, -6.0], eccentric.clone()),
    ] {
        let (model, found, warnings, printed) = room.diagnosed(eccentric_um, add_um);
        assert_eq!(named(&model, &found), expected, "{warnings:?}");
        assert_eq!(found.unexplained_um, 0.0, "{warnings:?}");
        // What stands out comes before all that is fitted.
        assert!(warnings[0].contains(words) && printed.contains(words), "no {words} in {warnings:?}, {printed}");
        assert!(printed.find(words) < printed.find("explained"), "{printed}");
        let found_um: Vec<f64> = found.standing_out_um.iter().flatten().map(|of| of.size).collect();
        assert_eq!(found_um.len(), sizes_um.len(), "{warnings:?}");
        // Twenty-five places with a noise of half a micrometre.
        assert!(found_um.iter().zip(sizes_um).all(|(found, planted)| (found - planted).abs() < 0.4), "{found_um:?}");
        assert!(found.named.iter().all(|named| named.weight > 0.95));
        for fitted in found.named.iter().flat_map(|named| &named.fitted).flatten() {
            assert!(fitted.holds(8.0) || fitted.holds(0.0), "{fitted:?}");
        }
    }
}

/// Every second tooth is off: no error of the machine, and too many teeth to be single ones. What is named beside that
/// has no interval and no weight, in words as in tables.
#[test]
fn nothing_is_sure_while_deviations_are_unexplained() {
    let room = Room::new();
    let odd = |at: &MeasuredPoint| if at.tooth.is_multiple_of(2) { 5.0 } else { -5.0 };
    let (model, found, warnings, printed) = room.diagnosed(12.0, odd);
    assert!(found.unexplained_um > 4.0 && model.standing_out.is_empty(), "{} um", found.unexplained_um);
    assert!(!found.named.is_empty(), "the eccentricity is there");
    assert!(warnings[0].starts_with("unexplained"), "{warnings:?}");
    assert!(printed.contains("no interval holds") && !printed.contains(" to "), "{printed}");
    let tree = findings(&room.loaded.scene, &model, &room.points, &Noise::of_values(NOISE_UM), &found);
    let table = tree.at_path("diagnosis").and_then(|section| section.table_at("sources")).expect("a table");
    for column in ["low", "high", "half_if_right", "sure"] {
        assert!(table.numbers(column).all(|cell| cell.is_none()), "{column} is withheld");
    }
    assert!(table.numbers("size").any(|cell| cell.is_some()));
    let turn = tree.at_path("diagnosis").and_then(|of| of.entries.iter().find(|entry| entry.key == "turn_low"));
    assert_eq!(turn.expect("an entry").quantity.value(), None);
}
