//! `gearcut texture`, run as a user runs it.

use crate::fixtures::command::{gearcut, gearcut_in};
use serde_json::Value;

const SURFACES: &str = "crates/texture/tests/data";

#[test]
fn the_table_names_chain_values_units_and_reasons() {
    let file = format!("{SURFACES}/p3_feed_marks.npy");
    gearcut(&["texture", &file, "--spacing-um", "40", "--form", "none", "--line", "y=2000"]).done().says(&[
        "256 x 225, 40 x 40 um apart",
        "F-operator",
        "L-filter",
        "Sa",
        "0.95304 um",
        "none",
        "as along feed marks",
        "core parameters",
        "profile along x at y = 2000 um",
        "RSm",
    ]);
}

#[test]
fn json_holds_every_value_with_unit_and_definition_or_the_reason() {
    let file = format!("{SURFACES}/p8_sl_filter.npy");
    let outcome = gearcut(&[
        "texture",
        &file,
        "--spacing-um",
        "1",
        "1",
        "--form",
        "none",
        "--s-filter-um",
        "6",
        "--l-filter-um",
        "32",
        "--crop-um",
        "64",
        "--at-ratio-percent",
        "30",
        "--at-height-um",
        "-0.5",
        "--json",
    ])
    .done();
    let json: Value = serde_json::from_str(&outcome.out).expect("JSON");
    let parameters = json["parameters"].as_object().expect("by symbol");
    assert!(parameters.len() > 45, "{}", parameters.len());
    for (symbol, quantity) in parameters {
        assert!(quantity["definition"].is_string() && quantity["unit"].is_string(), "{symbol}: {quantity}");
        assert!(quantity["value"].is_number() || quantity["why"].is_string(), "{symbol}: {quantity}");
    }
    let sq = parameters["Sq"]["value"].as_f64().expect("a number");
    assert!((sq - 0.867441903).abs() < 0.0104, "{sq}");
    assert!(parameters.contains_key("Smc(30)") && parameters.contains_key("Smr(-0.5)"));
    let chain = json["chain"].as_array().expect("steps");
    assert!(chain.iter().any(|s| s.as_str().is_some_and(|s| s.contains("ISO 16610-61, 32 um"))), "{chain:?}");
}

#[test]
fn surfaces_are_saved_in_other_formats_with_the_same_numbers() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let source = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(SURFACES).join("formats/tiny_nan.x3p");
    let source = source.to_str().expect("a plain path");
    let names = ["s.x3p", "s.sdf", "s_ascii.sdf", "s.npy", "s.csv"];
    let mut arguments = vec!["texture", source, "--json"];
    arguments.extend(names.iter().flat_map(|name| ["--save", name]));
    let first: Value = serde_json::from_str(&gearcut_in(folder.path(), &arguments).done().out).expect("JSON");
    for name in names {
        let outcome = gearcut_in(folder.path(), &["texture", name, "--json"]).done();
        let again: Value = serde_json::from_str(&outcome.out).expect("JSON");
        assert_eq!(again["read"], first["read"], "{name}");
        let value = |json: &Value| json["parameters"]["Sq"]["value"].as_f64().expect("a number");
        assert!((value(&again) / value(&first) - 1.0).abs() < 1e-12, "{name}");
    }
}

#[test]
fn what_cannot_be_done_is_refused_with_a_way_out() {
    let npy = format!("{SURFACES}/p1_sine_oblique.npy");
    let x3p = format!("{SURFACES}/formats/tiny_double.x3p");
    let with = |more: &[&str]| gearcut(&[&["texture", npy.as_str(), "--spacing-um", "1", "1.25"], more].concat());
    gearcut(&["texture", &npy]).failed(1, &["p1_sine_oblique.npy", "--spacing-um"]);
    gearcut(&["texture", "no_such_file.x3p"]).failed(1, &["no_such_file.x3p"]);
    gearcut(&["texture", "README.md"]).failed(1, &["README.md", "not an X3P"]);
    gearcut(&["texture", &x3p, "--spacing-um", "9"]).failed(1, &["2 x 3 um apart"]);
    with(&["--crop-um", "200"]).failed(1, &["takes all of"]);
    with(&["--l-filter-um", "0"]).failed(1, &["--l-filter-um", "positive"]);
    with(&["--s-filter-um", "1"]).failed(1, &["two points"]);
    with(&["--s-filter-um", "50", "--l-filter-um", "20"]).failed(1, &["must be shorter"]);
    with(&["--line", "z=3"]).failed(1, &["neither x nor y"]);
    with(&["--line", "y=1e9"]).failed(1, &["outside"]);
    with(&["--save", "s.bmp"]).failed(1, &["s.bmp", ".x3p"]);
    with(&["--at-ratio-percent", "130"]).failed(1, &["130 %"]);
    with(&["--form", "sphere"]).failed(2, &["poly2-plus-cylinder"]);
    with(&["--robust"]).failed(1, &["--l-filter-um"]);
    with(&["--lines", "z", "3"]).failed(1, &["neither x nor y"]);
    with(&["--lines", "y", "1"]).failed(1, &["no number of lines from 2 to"]);
    with(&["--line", "y=0", "--cutoff-um", "0"]).failed(1, &["--cutoff-um", "above 0"]);
    with(&["--line", "y=0", "--profile", "p", "--cutoff-um", "8"]).failed(1, &["primary profile has no cut-off"]);
    with(&["--line", "y=0", "--profile", "w", "--ra-limit-um", "1"]).failed(1, &["judged on roughness"]);
    // A line that does not suit its chain is none, with the reason; the areal numbers are there.
    with(&["--line", "y=0", "--cutoff-um", "5000"]).done().says(&["none", "a cut-off of 5000 um needs 10 mm", "Sa"]);
}

#[test]
fn help_teaches_with_examples() {
    gearcut(&["texture", "--help"]).done().says(&["gearcut texture measured.sdf", "ISO 16610-61", "--spacing-um"]);
}

/// A surface of ten by eight points in the dialects of other programs: heights whose Sa is 0.81284 um.
#[test]
fn dialects_arrive_with_their_heights() {
    let table = |separator: &str, comma: bool, unit_um: f64| -> String {
        let text = std::fs::read_to_string(format!("{SURFACES}/dialects/heights_um.txt")).expect("there");
        let cell = |word: &str| format!("{:.9}", word.parse::<f64>().expect("a height") / unit_um);
        let row = |line: &str| line.split_whitespace().map(cell).collect::<Vec<_>>().join(separator);
        let text: String = text.lines().map(|line| row(line) + "\n").collect();
        if comma { text.replace('.', ",") } else { text }
    };
    let folder = tempfile::tempdir().expect("a folder for the test");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    write("comma.csv", &table(";", true, 1.0));
    write("mm.txt", &format!("# Value units: mm\n{}", table("\t", false, 1e3)));
    let run = |arguments: &[&str]| gearcut_in(folder.path(), &[&["texture"], arguments, &["--form", "none"]].concat());
    let spacing = ["--spacing-um", "2", "3"];
    run(&[&["comma.csv", "--height-unit", "um"][..], &spacing].concat()).done().says(&["0.81284 um", "decimal commas"]);
    run(&[&["comma.csv"][..], &spacing].concat()).failed(1, &["a table of 10 x 8 heights", "--height-unit um"]);
    run(&[&["comma.csv", "--height-unit", "mm"][..], &spacing].concat()).done().says(&["warning", "in another unit?"]);
    run(&[&["mm.txt"][..], &spacing].concat()).done().says(&["0.81284 um"]);
    run(&[&["mm.txt", "--height-unit", "nm"][..], &spacing].concat()).failed(1, &["in mm, not in nm"]);
    run(&["mm.txt", "--height-unit", "furlong"]).failed(2, &["not a unit of length"]);
}

#[test]
fn replicas_are_turned_back_and_said() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(SURFACES).join("dialects/bcr.sdf");
    let file = file.to_str().expect("a plain path");
    let folder = tempfile::tempdir().expect("a folder for the test");
    let run = |arguments: &[&str]| gearcut_in(folder.path(), &[&["texture"], arguments, &["--form", "none"]].concat());
    run(&[file, "--invert", "--mirror", "x", "--save", "back.csv"]).done().says(&[
        "0.81284 um",
        "invert:",
        "mirror: x",
    ]);
    let back = std::fs::read_to_string(folder.path().join("back.csv")).expect("saved");
    let first = back.lines().find(|line| !line.starts_with('#')).expect("a row");
    assert!(first.starts_with("0.732,-0.477,-0.155,"), "{first}");
    run(&[file, "--crop-to-um", "0", "10", "3", "12", "--rotate", "90"]).done().says(&["4 x 6, 3 x 2 um apart"]);
    run(&[file, "--mask-um", "0", "4", "0", "6"]).done().says(&["mask: 9 points left out"]);
    run(&[file, "--mask-um", "0", "4", "0", "6", "--fill"]).done().says(&["fill: 9 holes"]);
    run(&[file, "--outliers", "50"]).done().says(&["outliers: 0 points"]);
    for (wrong, words) in [
        (&["--outliers", "0"][..], "--outliers"),
        (&["--rotate", "up"], "`up` is no angle"),
        (&["--crop-to-um", "5", "5", "0", "1"], "no rectangle"),
        (&["--crop-to-um", "50", "55", "0", "1"], "no point in"),
        (&["--height-unit", "um"], "leave --height-unit"),
    ] {
        run(&[&[file], wrong].concat()).failed(1, &[words]);
    }
}

#[test]
fn saving_replaces_nothing_without_force_and_never_what_was_read() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let text = "# gearcut surface: heights in um\n# dx_um = 1\n# dy_um = 1\n1,2,3\n4,5,7\n";
    std::fs::write(folder.path().join("s.csv"), text).expect("written");
    std::fs::write(folder.path().join("thesis.csv"), "years of work").expect("written");
    let run =
        |arguments: &[&str]| gearcut_in(folder.path(), &[&["texture", "s.csv", "--form", "none"], arguments].concat());
    let holds = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("there");
    for own in ["s.csv", "./s.csv"] {
        run(&["--save", own]).failed(1, &["is the file that is read"]);
        run(&["--save", own, "--force"]).failed(1, &["is the file that is read"]);
    }
    run(&["--save", "thesis.csv"]).failed(1, &["thesis.csv exists", "--force"]);
    assert_eq!((holds("s.csv").as_str(), holds("thesis.csv").as_str()), (text, "years of work"));
    run(&["--save", "thesis.csv", "--force"]).done();
    assert!(holds("thesis.csv").starts_with("# gearcut surface"));
}

/// 8 waves of amplitude 0.5 um, 25 um long: without a cut-off Pa = 2A / pi and Pq = A / sqrt 2, in every format.
#[test]
fn a_file_that_is_a_profile_has_its_parameters() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let height = |i: u32| 0.5 * (std::f64::consts::TAU * f64::from(i) / 50.0).sin();
    let lines: Vec<String> = (0..400).map(|i| format!("{:.3}\t{:.6}", 0.5 * f64::from(i), height(i))).collect();
    std::fs::write(folder.path().join("trace.txt"), lines.join("\n")).expect("written");
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let pro = root.join(SURFACES).join("dialects/profile.pro");
    let units = ["trace.txt", "--spacing-unit", "um", "--height-unit", "um"];
    for file in [&[pro.to_str().expect("a plain path")][..], &units] {
        let arguments =
            [&["texture"], file, &["--profile", "p", "--line-form", "none", "--lambda-s-um", "0", "--json"]];
        let out = gearcut_in(folder.path(), &arguments.concat()).done().out;
        let json: Value = serde_json::from_str(&out).expect("JSON");
        assert_eq!((&json["read"]["points"], &json["read"]["spacing_um"]), (&400.into(), &0.5.into()), "{file:?}");
        let value = |symbol: &str| json["profiles"][0]["parameters"][symbol]["value"].as_f64().expect(symbol);
        assert!((value("Pa") / std::f64::consts::FRAC_1_PI - 1.0).abs() < 2e-3, "{}", value("Pa"));
        assert!((value("Pq") / 0.125_f64.sqrt() - 1.0).abs() < 2e-3, "{}", value("Pq"));
    }
    let run = |arguments: &[&str]| gearcut_in(folder.path(), &[&["texture"], arguments].concat());
    run(&["trace.txt", "--spacing-um", "0.5"]).failed(1, &["a profile of 400 points", "--spacing-unit"]);
    run(&[&units[..], &["--save", "t.csv"]].concat()).failed(1, &["it is a profile"]);
    run(&[&units[..], &["--invert"]].concat()).failed(1, &["it is a profile"]);
    run(&[&units[..], &["--line", "y=1"]].concat()).failed(1, &["no lines to choose from"]);
}
