//! Influences against closed forms, over whole flanks; and where they are not linear.

use super::round::{CUTTER_MM, Contact, PITCH_MM, backend, contacts, grid, loaded};
use gearcut::influence::derivative::Influence;
use gearcut::influence::figures::Figures;
use gearcut::influence::gear_grid::GearGrid;
use gearcut::scene::error_parameters::{ErrorParameter, Shifted, error_parameters};
use gearcut::scene::{LoadedScene, Scene};
use gearcut::terms::Side;
use glam::DVec2;
use std::f64::consts::PI;

/// Seconds of arc at the pitch circle of the work and of the cutter, um.
const WORK_UM: f64 = PITCH_MM * 1e3 * PI / 180.0 / 3600.0;
const CUTTER_UM: f64 = CUTTER_MM * 1e3 * PI / 180.0 / 3600.0;
const ALPHA_RAD: f64 = 20.0 * PI / 180.0;

fn parameter(loaded: &LoadedScene, id: &str) -> ErrorParameter {
    let all = error_parameters(loaded, true);
    all.into_iter().find(|parameter| parameter.id == id).unwrap_or_else(|| panic!("{id} is no parameter"))
}

struct Round {
    loaded: LoadedScene,
    grid: GearGrid,
    before_um: Vec<f64>,
    contacts: Vec<Contact>,
}

impl Round {
    fn new() -> Self {
        let loaded = loaded(&[]);
        let grid = grid(&loaded);
        let before_um = grid.heights_um(&loaded.scene, &backend()).expect("cut");
        let contacts = contacts(&grid);
        Self { loaded, grid, before_um, contacts }
    }

    fn influence(&self, parameter: &ErrorParameter) -> Influence {
        Influence::new(&self.loaded, &self.grid, &self.before_um, parameter, &backend()).expect("cut")
    }

    /// Largest difference of an influence from its closed form, and the form's largest value, um per unit.
    fn off(&self, influence: &Influence, expected: impl Fn(&Contact) -> f64) -> [f64; 2] {
        let expected: Vec<f64> = self.contacts.iter().map(expected).collect();
        let most = expected.iter().fold(0.0, |most: f64, um| most.max(um.abs()));
        let differ = influence.um_per_unit.iter().zip(&expected).map(|(got, expected)| (got - expected).abs());
        [differ.fold(0.0, |most: f64, um| if um.is_nan() { um } else { most.max(um) }), most]
    }

    /// Whether it is its closed form to 1 % of that form's largest value; heights to 0.02 um, for facets of the strokes
    /// stand up to 0.08 um high and move.
    fn agrees(&self, influence: &Influence, expected: impl Fn(&Contact) -> f64) -> bool {
        let [off, most] = self.off(influence, expected);
        off <= (0.01 * most).max(0.02 / influence.parameter.step)
    }
}

/// A closed form, um per unit.
type Form<'a> = &'a dyn Fn(&Contact) -> f64;

#[test]
fn influences_are_their_closed_forms_over_whole_flanks() {
    let round = Round::new();
    let shifted = |of: &Contact, out: f64, around: f64| of.normal.dot(out * of.out + around * of.around);
    let z = |of: &Contact| of.z_mm / 100.0;
    let bow = |of: &Contact| (of.z_mm / 10.0).powi(2);
    // The cutter's tooth 0 points to the gear's axis when the work begins; it turns about the gear and about itself.
    let runout =
        |of: &Contact, from: f64| -DVec2::from_angle(of.work_rad * (1.0 + PITCH_MM / CUTTER_MM) + from).dot(of.normal);
    let cases: [(&str, Form); 15] = [
        ("mounting.eccentricity_um@0", &|of| -of.normal.x),
        ("mounting.eccentricity_um@90", &|of| -of.normal.y),
        ("mounting.wobble_um_per_100mm@0", &|of| -z(of) * of.normal.x),
        ("machine.errors.guide.radial_um_per_100mm", &|of| shifted(of, z(of), 0.0)),
        ("machine.errors.guide.tangential_um_per_100mm", &|of| shifted(of, 0.0, z(of))),
        ("machine.errors.guide.radial_bow_um", &|of| shifted(of, bow(of), 0.0)),
        ("machine.errors.guide.tangential_bow_um", &|of| shifted(of, 0.0, bow(of))),
        ("machine.errors.work.periodic_amplitudes_arcsec@2/0", &|of| {
            WORK_UM / PITCH_MM * (2.0 * of.work_rad).sin() * (of.point_mm.perp_dot(of.normal))
        }),
        ("machine.errors.cutter.periodic_amplitudes_arcsec@1/90", &|of| {
            shifted(of, 0.0, -CUTTER_UM * (PITCH_MM / CUTTER_MM * of.work_rad).cos())
        }),
        ("machine.errors.center_distance.scale_um_per_m", &|of| shifted(of, (PITCH_MM + CUTTER_MM) / 1e3, 0.0)),
        // They turn the whole gear.
        ("machine.errors.work.backlash_arcsec", &|_| 0.0),
        ("machine.errors.work.velocity_gain_per_s", &|_| 0.0),
        ("machine.errors.cutter.velocity_gain_per_s", &|_| 0.0),
        ("tool.shaper_cutter.runout_um@0", &|of| runout(of, 0.0)),
        ("tool.shaper_cutter.runout_um@90", &|of| runout(of, 0.5 * PI)),
    ];
    let mut wrong = Vec::new();
    for (id, expected) in cases {
        let influence = round.influence(&parameter(&round.loaded, id));
        let [off, most] = round.off(&influence, expected);
        println!("{id}: {most:.3} um per unit at most, {:.2} % off", 100.0 * off / most);
        if !round.agrees(&influence, expected) {
            wrong.push(format!("{id}: {off} um off of {most} um per unit"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
    // Planted: the other sign is seen.
    let eccentric = round.influence(&parameter(&round.loaded, "mounting.eccentricity_um@0"));
    assert!(!round.agrees(&eccentric, |of| of.normal.x));
}

/// Figures of influences by hand: an eccentricity swings the cumulative pitch by 2 / cos(alpha), a sideways slope of
/// the guide is a helix slope over the evaluated face, a pitch error of the cutter stands in single pitch deviations.
#[test]
fn figures_of_influences_are_those_by_hand() {
    let round = Round::new();
    let figures = |id: &str| Figures::new(&round.grid, &round.influence(&parameter(&round.loaded, id)).um_per_unit);
    let eccentric = figures("mounting.eccentricity_um@0");
    // On the pitch circle, whose 24 teeth do not meet both extremes.
    let places = |side: Side| {
        let of_side = round.grid.flanks.iter().filter(move |flank| flank.side == side && flank.is_point());
        of_side.map(move |flank| -flank.rays[0].normal.x / ALPHA_RAD.cos() * side.sign())
    };
    let range = |values: Vec<f64>| {
        let [low, high] = [f64::min, f64::max].map(|fold| values.iter().copied().reduce(fold).expect("teeth"));
        high - low
    };
    let expected = range(places(Side::Left).collect()).max(range(places(Side::Right).collect()));
    let share = expected / 2.0 * ALPHA_RAD.cos();
    assert!((7.5_f64.to_radians().cos() - 1e-6..1.0 + 1e-6).contains(&share), "{expected}");
    assert!((eccentric.total_pitch / expected - 1.0).abs() < 0.002, "{eccentric:?}, {expected} expected");
    assert!(eccentric.thickness.abs() < 0.01 && eccentric.helix < 0.01, "{eccentric:?}");
    let slope = figures("machine.errors.guide.tangential_um_per_100mm");
    assert!((slope.helix_slope.abs() / (0.18 * ALPHA_RAD.cos()) - 1.0).abs() < 0.01, "{slope:?}");
    assert!((slope.helix / slope.helix_slope.abs() - 1.0).abs() < 0.01 && slope.total_pitch < 0.01, "{slope:?}");
    let scale = figures("machine.errors.center_distance.scale_um_per_m");
    // Both flanks of a tooth leave a sin(alpha): 2 a tan(alpha) on the circle.
    let thicker = 2.0 * 66e-3 * ALPHA_RAD.tan();
    assert!((scale.thickness / thicker - 1.0).abs() < 0.002, "{scale:?}, {thicker} expected");
}

#[test]
fn half_a_step_tells_what_is_not_linear() {
    let round = Round::new();
    let checked = |parameter: &ErrorParameter| {
        let influence = round.influence(parameter);
        let heights_um = |scene: &Scene| round.grid.heights_um(scene, &backend());
        influence.checked(&round.loaded, &round.before_um, &heights_um).expect("cut")
    };
    let eccentric = parameter(&round.loaded, "mounting.eccentricity_um@0");
    assert!(checked(&eccentric).is_linear());
    // Planted: the square of an eccentricity of 0.9 mm over the curvature of flanks is not small.
    let large = checked(&eccentric.with_step(900.0));
    assert!(!large.is_linear(), "half a step differs by {}, bend {}", large.half_step_um, large.bend_um());
    let backlash = checked(&parameter(&round.loaded, "machine.errors.work.backlash_arcsec"));
    assert!(backlash.upwards_only && backlash.is_linear(), "{} arcsec", backlash.half_step_um);
}

/// Shifts compose, through the scene's own keys and its reader.
#[test]
fn shifted_scenes_are_those_that_are_written() {
    let loaded = loaded(&["mounting.eccentricity_um=3".to_owned(), "machine.errors.work.backlash_arcsec=2".to_owned()]);
    let of = |id: &str| parameter(&loaded, id);
    let mut shifted = Shifted::new(&loaded);
    assert!(shifted.shift(&of("mounting.eccentricity_um@90"), 4.0));
    assert!(shifted.shift(&of("tool.shaper_cutter.pitch_errors_um@3"), 1.5));
    for (phase, by) in [(0, 3.0), (90, -2.0)] {
        let wave = of(&format!("machine.errors.work.periodic_amplitudes_arcsec@2/{phase}"));
        assert!(shifted.shift(&wave, by));
    }
    let backlash = of("machine.errors.work.backlash_arcsec");
    assert!(!shifted.shift(&backlash, -2.5), "there is no backlash below 0");
    let again = shifted.read(gearcut::process::table()).expect("a scene");
    let pitch: Vec<&str> = (0..20).map(|tooth| if tooth == 2 { "1.5" } else { "0.0" }).collect();
    let written = super::round::loaded(&[
        "mounting.eccentricity_um=5".to_owned(),
        format!("mounting.eccentricity_angle_deg={:?}", 4.0_f64.atan2(3.0).to_degrees()),
        format!("tool.shaper_cutter.pitch_errors_um=[{}]", pitch.join(", ")),
        "machine.errors.work.periodic_orders=[2.0, 2.0]".to_owned(),
        "machine.errors.work.periodic_amplitudes_arcsec=[3.0, -2.0]".to_owned(),
        "machine.errors.work.periodic_phases_deg=[0.0, 90.0]".to_owned(),
        "machine.errors.work.backlash_arcsec=2".to_owned(),
    ]);
    assert_eq!(again.scene, written.scene);
    assert!(Shifted::new(&again).settings().is_empty(), "nothing is shifted yet");
}
