//! Layers of errors in `results.json` of hobbing and bevel cutting: those of the scene with the sizes of its keys, and
//! no others. Shaping's are told by its own test beside the words.

use crate::fixtures::command::{gearcut, read_json};
use std::collections::BTreeMap;

/// Layers of a coarse cut, and their words.
fn layers(scene: &str, settings: &[&str]) -> BTreeMap<String, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("cut");
    let arguments = ["cut", scene, "--backend", "cpu", "--only", "numbers", "--out", out.to_str().expect("a path")];
    let settings = settings.iter().flat_map(|&setting| ["--set", setting]);
    gearcut(&arguments.into_iter().chain(settings).collect::<Vec<_>>()).done();
    let results = read_json(&out.join("results.json"));
    let section = results["sections"]["machine_errors"].as_object().expect("a section");
    let words = section.iter().filter_map(|(key, entry)| Some((key.clone(), entry["value"].as_str()?.to_owned())));
    words.collect()
}

fn expected<const N: usize>(layers: [(&str, &str); N]) -> BTreeMap<String, String> {
    layers.map(|(key, words)| (key.to_owned(), words.to_owned())).into()
}

#[test]
fn a_hobbed_gear_tells_the_layers_that_are_on() {
    let coarse = [
        "gear.face_width_mm=4",
        "operation.finish.axial_feed_mm_per_revolution=4",
        "fields.flank.profile_spacing_um=300",
        "fields.blank.spacing_mm=1",
    ];
    let of_scene = [
        ("axes", "work spindle: wave of 12 arcsec; Y radial: drift 60 um/h at first"),
        ("guide", "sideways 40 um in 100 mm"),
        ("mounting", "eccentricity 6 um"),
        ("tool", "runout 6 um, wobble 10 um in 100 mm"),
    ];
    assert_eq!(layers("scenes/hobbing/machine_errors.toml", &coarse), expected(of_scene));
}

#[test]
fn a_bevel_gear_tells_the_layers_that_are_on() {
    let coarse = [
        "operation.finish.roll_speed_deg_per_s=20",
        "fields.flank.profile_spacing_um=300",
        "fields.flank.lead_spacing_um=2000",
        "fields.blank.spacing_mm=1",
        "machine.cradle_errors.sliding_base_mm=0.02",
    ];
    let of_scene = [
        ("axes", "A work spindle: wave of 8 arcsec; sliding base 0.02 mm"),
        ("mounting", "eccentricity 6 um; axial offset 15 um"),
        ("tool", "wobble 3 um in 100 mm"),
    ];
    assert_eq!(layers("scenes/bevel/machine_errors.toml", &coarse), expected(of_scene));
}
