//! The layers of errors that are on, in words.

use crate::findings::Section;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::linkage::dynamics::AXES;
use crate::process::shaping::scene::layers::OWN;
use crate::process::shaping::scene::model::Shaping;
use crate::steps::machine_errors::{TurnTakenOff, section};

/// The layers that are on; none of an ideal machine.
pub fn errors(job: &ShapingJob) -> Option<Section> {
    let model = Shaping::of(&job.scene)?;
    let sine = job.scene.gear.pressure_angle_rad.sin();
    let own: Vec<_> = OWN.iter().map(|own| (own.layer, own.words(model, sine))).collect();
    let turn = TurnTakenOff::of_round(job.turn_rad, &job.scene.gear, &job.curve);
    section(&model.machine.errors, &AXES, &own, turn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::load;
    use std::f64::consts::TAU;
    use std::path::Path;

    /// Layers of a scene and their words.
    fn layers(scene: &str) -> Vec<(String, String)> {
        let loaded = load(Path::new(&format!("scenes/shaping/{scene}.toml")), &[]).expect("a scene");
        let job = ShapingJob::new(loaded.scene).expect("a job");
        let known = job.scene.process.error_layers();
        let found = errors(&job).map_or_else(Vec::new, |section| section.entries);
        let names: Vec<&str> = found.iter().map(|entry| entry.key.as_str()).collect();
        assert_eq!(names, known.iter().map(|layer| layer.name()).collect::<Vec<_>>(), "{scene}");
        found.iter().map(|entry| (entry.key.clone(), entry.quantity.words().unwrap_or_default().to_owned())).collect()
    }

    /// A lag of omega / K_v, 2400 strokes at 300 a minute for a turn, is a turn of r cos(alpha) omega / K_v on flanks.
    #[test]
    fn a_turn_of_the_whole_gear_is_a_quantity_of_its_own() {
        let settings = ["machine.double_strokes_per_minute=300", "machine.errors.work.velocity_gain_per_s=10"];
        let settings = settings.map(str::to_owned);
        let loaded = load(Path::new("scenes/shaping/circular_m3_z24.toml"), &settings).expect("a scene");
        let job = ShapingJob::new(loaded.scene).expect("a job");
        let section = errors(&job).expect("an error");
        let found: Vec<f64> = section.sections[0].entries.iter().filter_map(|entry| entry.quantity.value()).collect();
        let turn_rad = -TAU / 480.0 / 10.0;
        let on_flanks_um = 36e3 * 20_f64.to_radians().cos() * turn_rad;
        assert!((found[0] / turn_rad.to_degrees() - 1.0).abs() < 1e-6, "{found:?}");
        assert!((found[1] / on_flanks_um - 1.0).abs() < 1e-6, "{found:?}, {on_flanks_um} um expected");
    }

    #[test]
    fn layers_that_are_on_are_told_with_the_sizes_of_their_keys() {
        assert!(layers("circular_m3_z24").is_empty(), "an ideal machine has none");
        let pair = |key: &str, words: &str| (key.to_owned(), words.to_owned());
        let noise = layers("noise");
        let radial = "0.5 um in every stroke";
        assert!(noise[0].0 == "noise" && noise[0].1.contains(radial) && noise[0].1.contains("1 arcsec up to 0.05 Hz"));
        assert_eq!(noise[1], pair("stock", "rough: 15 um on flanks over 20 mm"));
        assert_eq!(noise[2], pair("edge", "Rq 0.3 um, correlation length 25 um, seed 1"));
        let compliance = "cutter radially 8 um/kN, cutter tangentially 8 um/kN, cutter spindle 1 urad/(N m), work \
            radially 4 um/kN, work tangentially 4 um/kN, work spindle 0.5 urad/(N m)";
        assert_eq!(layers("deflection"), [pair("deflection", compliance)]);
        let torn = "up to 250 marks to a mm^2 between 2 and 60 m/min, 1 um deep in the mean, 20 um wide, 50 % of them \
            scratches of 200 um";
        assert_eq!(layers("built_up_edge").last(), Some(&pair("tearing", torn)));
        let rounded = layers("ploughing");
        assert!(rounded.last().is_some_and(|(key, words)| key == "ploughing" && words.contains("thinnest chip")));
        let lags = "work spindle: wave of 6 arcsec, wave of 2 arcsec, K_v 30 /s, 0 % fed forward; cutter spindle: K_v \
            33 /s, 0 % fed forward; centre distance: backlash 4 um, K_v 30 /s, 0 % fed forward, drift 30 um/h at first";
        let errors = [
            pair("axes", lags),
            pair("guide", "sideways 25 um in 100 mm; bow radially 2 um"),
            pair("mounting", "eccentricity 5 um; wobble 10 um in 100 mm"),
            pair("tool", "runout 3 um"),
        ];
        assert_eq!(layers("machine_errors"), errors);
    }
}
