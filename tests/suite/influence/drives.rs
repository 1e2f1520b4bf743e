//! Influences of what belongs to another error (how a drive follows, how a drift settles) against closed forms, and
//! which scenes have them.

use super::round::{Contact, SCENE, backend, contacts, grid};
use crate::fixtures::closed_form;
use crate::shaping::machine_errors::{ELLIPTICAL, changes, displaced, job};
use gearcut::influence::budget::chosen;
use gearcut::influence::derivative::Influence;
use gearcut::machine::Motion;
use gearcut::process;
use gearcut::process::shaping::ShapingJob;
use gearcut::scene::LoadedScene;
use gearcut::scene::error_parameters::{ErrorParameter, Shifted, error_parameters};
use std::f64::consts::TAU;
use std::path::Path;

/// Time of a turn of the work, s: 2,400 strokes at 300 a minute.
const TURN_S: f64 = 480.0;

fn loaded(text: &str, settings: &[&str]) -> LoadedScene {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    process::parse(text, "round.toml", Path::new(""), &settings).expect("a scene")
}

fn parameter(loaded: &LoadedScene, id: &str) -> Option<ErrorParameter> {
    error_parameters(loaded, true).into_iter().find(|parameter| parameter.id == id)
}

/// Whether an influence is its closed form, um per unit, to 1 % of the form's largest value or 0.02 um of the step.
fn agrees(influence: &Influence, contacts: &[Contact], form: impl Fn(&Contact) -> f64) -> bool {
    let forms: Vec<f64> = contacts.iter().map(form).collect();
    let most = forms.iter().fold(0.0, |most: f64, um| most.max(um.abs()));
    let off = influence.um_per_unit.iter().zip(&forms).map(|(got, form)| (got - form).abs()).fold(0.0, f64::max);
    println!("{}: {most:.3} um per unit at most, {:.2} % off", influence.parameter.id, 100.0 * off / most);
    off <= (0.01 * most).max(0.02 / influence.parameter.step)
}

#[test]
fn feed_forward_and_a_settling_drift_have_their_derivatives() {
    let forward = "machine.errors.work.feed_forward";
    let settling = "machine.errors.center_distance.drift_time_constant_min";
    let (gain_per_s, um_per_h, tau_s) = (10.0, 600.0, 240.0);
    let scene = loaded(
        SCENE,
        &[
            "machine.errors.work.velocity_gain_per_s=10",
            "machine.errors.work.feed_forward=0.4",
            "machine.errors.center_distance.drift_um_per_h=600",
            "machine.errors.center_distance.drift_time_constant_min=4",
        ],
    );
    let grid = grid(&scene);
    let before_um = grid.heights_um(&scene.scene, &backend()).expect("cut");
    let contacts = contacts(&grid);
    let influence = |id: &str, share: f64| {
        let parameter = parameter(&scene, id).unwrap_or_else(|| panic!("{id} is no parameter"));
        let step = share * parameter.step;
        let parameter = parameter.with_step(step);
        Influence::new(&scene, &grid, &before_um, &parameter, &backend()).expect("cut")
    };
    // The lag is (1 - f) v / K_v. It turns the whole gear, which is taken off.
    let found = influence(forward, 1.0);
    assert!(!found.upwards_only && agrees(&found, &contacts, |_| 0.0));
    let turned_rad = |share: f64| {
        let mut shifted = Shifted::new(&scene);
        assert!(shifted.shift(&parameter(&scene, forward).expect("a parameter"), share));
        ShapingJob::new(shifted.read(process::table()).expect("a scene").scene).expect("a gear").turn_rad
    };
    let (slope, expected) = ((turned_rad(0.1) - turned_rad(-0.1)) / 0.2, TAU / TURN_S / gain_per_s);
    assert!((slope / expected - 1.0).abs() < 1e-6, "{slope} rad, {expected} expected");
    // d/dtau of rate tau (1 - exp(-t / tau)), per minute.
    let form = |of: &Contact| {
        let x = TURN_S * of.work_rad / TAU / tau_s;
        60.0 * um_per_h / 3600.0 * (1.0 - (-x).exp() * (1.0 + x)) * of.out.dot(of.normal)
    };
    // The course by tau bends: the difference over a minute of four is 2 % off, over half of that a quarter of it.
    let found = influence(settling, 0.5);
    assert!(agrees(&found, &contacts, form));
    assert!(!agrees(&found, &contacts, |of| -form(of)) && !agrees(&found, &contacts, |of| 1.1 * form(of)));
}

/// With the whole speed fed forward, T e'' + e' + K e = T q'' is left of the loop: per unit of T the axis lags by a / K
/// - j / K^2, to the second order in the frequency over K.
#[test]
fn a_speed_loop_costs_what_the_axis_accelerates() {
    let gain = 20.0;
    // A turn in 45 s. The work turns evenly and the cutter does not.
    let settings = [
        "machine.double_strokes_per_minute=4800",
        "machine.errors.cutter.velocity_gain_per_s=20",
        "machine.errors.cutter.feed_forward=1.0",
    ];
    let (loaded, sound) = (loaded(ELLIPTICAL, &settings), job(ELLIPTICAL, &settings));
    let parameter = parameter(&loaded, "machine.errors.cutter.speed_loop_ms").expect("a parameter");
    let step_ms = 60.0 * parameter.step;
    let mut shifted = Shifted::new(&loaded);
    assert!(!shifted.shift(&parameter, -step_ms), "there is no time below 0");
    assert!(shifted.shift(&parameter, step_ms));
    let faulty = ShapingJob::new(shifted.read(process::table()).expect("a scene").scene).expect("a gear");
    let schedule = &sound.finishing().schedule;
    let lag_rad = |stroke: f64| {
        let acceleration = |stroke: f64| schedule.at(stroke)[1].acceleration;
        let jerk = (acceleration(stroke + 1.0) - acceleration(stroke - 1.0)) / schedule.time_s(2.0);
        1e-3 * step_ms * (acceleration(stroke) / gain - jerk / gain / gain)
    };
    let found = changes(&sound, &faulty, &[2, 4, 7, 9]);
    let form = |sign: f64| {
        let (sound, lag_rad) = (&sound, &lag_rad);
        move |place: &_| displaced(sound, place, |stroke| [0.0, -sign * lag_rad(stroke), 0.0])
    };
    closed_form::agree("speed loop", &found, [1.0, 0.02], form(1.0));
    let [_, wrong_um] = closed_form::differences_um("planted", &found, form(-1.0));
    assert!(wrong_um > 0.5, "the other sign is seen");
}

/// What belongs to another error is shifted where the scene has that.
#[test]
fn companions_are_parameters_where_their_error_is_there() {
    let names = |loaded: &LoadedScene, names: &[&str]| -> Vec<String> {
        let names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
        chosen(loaded, &names).map_or_else(|_| Vec::new(), |found| found.into_iter().map(|of| of.id).collect())
    };
    let plain = loaded(SCENE, &[]);
    let forward = "machine.errors.work.feed_forward";
    let settling = "machine.errors.center_distance.drift_time_constant_min";
    for id in [forward, settling, "machine.errors.work.speed_loop_ms", "machine.errors.work.gearbox_increment_arcsec"] {
        assert!(names(&plain, &[id]).is_empty(), "{id}");
    }
    let gain = loaded(SCENE, &["machine.errors.work.velocity_gain_per_s=30"]);
    assert!(names(&gain, &[]).contains(&forward.to_owned()));
    // All of it is fed forward: there is no more.
    let all = ["machine.errors.work.velocity_gain_per_s=30", "machine.errors.work.feed_forward=1.0"];
    assert!(names(&loaded(SCENE, &all), &[forward]).is_empty());
    let nearly = loaded(SCENE, &[all[0], "machine.errors.work.feed_forward=0.98"]);
    assert!((parameter(&nearly, forward).expect("a parameter").step - 0.02).abs() < 1e-12);
    // A drift that goes on evenly has no time constant to shift.
    assert!(names(&loaded(SCENE, &["machine.errors.center_distance.drift_um_per_h=60"]), &[settling]).is_empty());
    // What springs back is all without the key; what stays down is its parameter.
    let recovery = "tool.shaper_cutter.edge_rounding.recovery_share";
    assert!(names(&plain, &[recovery]).is_empty());
    let edge = ["radius_um=5", "minimum_chip_share=0.3"].map(|key| format!("tool.shaper_cutter.edge_rounding.{key}"));
    let rounded = loaded(SCENE, &edge.each_ref().map(String::as_str));
    let pressed = parameter(&rounded, recovery).expect("a parameter");
    let mut shifted = Shifted::new(&rounded);
    assert!(!shifted.shift(&pressed, -0.1), "no more than all of it springs back");
    assert!(shifted.shift(&pressed, 0.25));
    assert!(shifted.settings() == [format!("{recovery}=0.75")], "{:?}", shifted.settings());
}
