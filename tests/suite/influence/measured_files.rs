//! What gearcut writes of a gear is read back without editing, and gives the errors with which the gear was cut.

use super::round::SCENE;
use crate::fixtures::command::{gearcut_in, read_json};
use gearcut::backend::{BackendWish, OnFailure, choose};
use gearcut::influence::numbers::{numbers, texture_numbers};
use gearcut::interrupt::Interrupt;
use gearcut::process;
use gearcut::terms::Side;
use std::path::Path;

const COARSE: [&str; 6] = [
    "operation.finish.strokes_per_revolution=480",
    "fields.flank.profile_spacing_um=80",
    "fields.flank.lead_spacing_um=2500",
    "fields.blank.spacing_mm=1.0",
    "fields.blank.slice_spacing_mm=20",
    "fields.chips.spacing_mm=0.4",
];

/// A folder with the scene of a round gear, and its command with coarse settings and more arguments.
struct Shop(tempfile::TempDir);

impl Shop {
    fn new(more: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("round.toml"), format!("{SCENE}{more}")).expect("written");
        Self(folder)
    }

    fn run(&self, command: &str, settings: &[&str], arguments: &[&str]) -> crate::fixtures::command::Outcome {
        let set = COARSE.iter().chain(settings).flat_map(|setting| ["--set", setting]);
        let all: Vec<&str> = [command, "round.toml"].into_iter().chain(set).chain(arguments.iter().copied()).collect();
        gearcut_in(self.0.path(), &all)
    }

    /// Shift and half interval of a fitted parameter.
    fn fitted(&self, out: &str, id: &str) -> [f64; 2] {
        let table = std::fs::read_to_string(self.0.path().join(out).join("tables/fits.csv")).expect("a table");
        let row = table.lines().find(|line| line.starts_with(&format!("{id},"))).unwrap_or_else(|| panic!("{table}"));
        let cells: Vec<&str> = row.split(',').collect();
        [2, 3].map(|column| cells[column].parse().unwrap_or_else(|_| panic!("{id} has no size: {table}")))
    }
}

/// A gear with an eccentricity of 9 um in the direction of 30 deg and a sideways slope of the guide: its inspection is
/// read as it was written, by both commands, and the errors come back. Signs are those of the charts: a slope of the
/// other sign is outside of the interval by far.
#[test]
fn an_inspection_gives_back_the_errors_of_its_gear() {
    let shop = Shop::new("");
    let errors = [
        "mounting.eccentricity_um=9",
        "mounting.eccentricity_angle_deg=30",
        "machine.errors.guide.tangential_um_per_100mm=25",
    ];
    // The numbers alone have all that is read here.
    shop.run("cut", &errors, &["--only", "numbers", "--out", "cut"]).done();
    let fit = "mounting.eccentricity_um,machine.errors.guide.tangential_um_per_100mm";
    let charts = ["--measured", "cut/inspection_charts.csv", "--noise-um", "0.2"];
    let calibrate = |settings: &[&str], out: &str, more: &[&str]| {
        shop.run("calibrate", settings, &[&["--out", out], more].concat()).done().says(&["fitted"]);
    };
    calibrate(&[], "by_charts", &[&charts[..], &["--fit", fit]].concat());
    let expected = [
        ("mounting.eccentricity_um@0", 9.0 * 30_f64.to_radians().cos()),
        ("mounting.eccentricity_um@90", 9.0 * 30_f64.to_radians().sin()),
        ("machine.errors.guide.tangential_um_per_100mm", 25.0),
    ];
    for (id, expected) in expected {
        let [shift, half] = shop.fitted("by_charts", id);
        // The charts are the model's own: what is left is second order and rounding, the interval that of the noise.
        assert!((shift - expected).abs() < half && (shift / expected - 1.0).abs() < 0.01, "{id}: {shift} +- {half}");
        assert!(half < 0.1 * expected, "{id}: +- {half}");
    }
    let lines = std::fs::read_to_string(shop.0.path().join("by_charts/tables/lines.csv")).expect("a table");
    assert!(lines.starts_with("line,places,measured_um,off_predicted_um,off_fitted_um"), "{lines}");
    for words in ["profile of tooth 1 left", "helix of tooth 13 right", "pitch of left flanks"] {
        assert!(lines.contains(words), "no {words}: {lines}");
    }
    // Figures alone: a scene that starts with a little of the error shows the fit its direction.
    let guide = "machine.errors.guide.tangential_um_per_100mm";
    let start = [errors[0], errors[1], "machine.errors.guide.tangential_um_per_100mm=20"];
    let figures = ["--measured", "cut/tables/inspection.csv", "--noise-um", "0.2", "--fit", guide];
    calibrate(&start, "by_figures", &figures);
    let [shift, half] = shop.fitted("by_figures", guide);
    assert!((shift - 5.0).abs() < half.min(0.1), "{shift} +- {half}");
    let named = shop.run("diagnose", &[], &[&charts[..], &["--parameters", "mounting,machine.errors.guide"]].concat());
    named.done().says(&["work eccentricity", "guide: tangential slope"]);
    for (arguments, words) in [
        (&["--measured", "cut/inspection_charts.csv"][..], "--noise-um"),
        (&["--measured", "cut/nothing.csv", "--noise-um", "1"], "nothing.csv"),
        (&["--measured", "cut/run.json", "--surface-percent", "5"], "not an X3P"),
        (&["--measured", "cut/inspection_charts.csv", "--noise-um=-1"], "above 0"),
    ] {
        shop.run("calibrate", &[], &[arguments, &["--fit", fit]].concat()).failed(1, &[words]);
    }
}

const WINDOW: &str = "
    [tool.shaper_cutter.edge_roughness]
    rq_um = 0.2
    correlation_length_um = 25.0
    [[texture]]
    tooth = 3
    side = \"left\"
    length_profile_mm = 0.5
    length_lead_mm = 0.5
    profile_spacing_um = 5.0
    lead_spacing_um = 250.0
";

/// The surface of a gear whose edges are twice as rough gives back their roughness: seeds are equal, so that the course
/// of the edges is.
#[test]
fn a_surface_gives_back_the_roughness_of_the_edges() {
    let shop = Shop::new(WINDOW);
    // Many strokes: numbers of a few marks jump when a stroke comes to lie over its neighbour.
    let fine = "operation.finish.strokes_per_revolution=1200";
    let rough = [fine, "tool.shaper_cutter.edge_roughness.rq_um=0.4"];
    shop.run("cut", &rough, &["--only", "texture", "--out", "cut"]).done();
    let key = "tool.shaper_cutter.edge_roughness.rq_um";
    let surface = ["--measured", "cut/texture/finish/tooth_03_left.x3p", "--surface-percent", "3", "--fit", key];
    let done = shop.run("calibrate", &[fine], &surface).done();
    let done = done.says(&["texture.finish.tooth_03_left.parameters.Sa"]);
    let [shift, half] = shop.fitted("out/round_calibration", key);
    assert!((shift - 0.2).abs() < 0.002 && half > 0.0 && half < 0.05, "{shift} +- {half} um");
    let results = read_json(&shop.0.path().join("out/round_calibration/results.json"));
    // The window is the scene's own; its numbers are no independent ones, and the output says so.
    let warnings = results["warnings"].as_array().expect("a list");
    let told = warnings.iter().map(|warning| warning["text"].as_str().expect("words")).collect::<Vec<_>>();
    assert_eq!(told.len(), 1, "{told:?}");
    let words = "Sa, Sk, Spk, Svk of finish.tooth_03_left come from one surface";
    assert!(told[0].contains(words) && told[0].contains("a factor of up to 2.0"), "{told:?}");
    let printed = done.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(printed.contains(words), "{}", done.err);
    let page = std::fs::read_to_string(shop.0.path().join("out/round_calibration/report.html")).expect("a page");
    assert!(page.contains(words), "the page does not say it");
    // One number of it is one observation.
    let alone = [&surface[..], &["--surface-numbers", "Sa", "--out", "one"]].concat();
    let done = shop.run("calibrate", &[fine], &alone).done();
    assert!(!done.err.contains("one surface"), "{}", done.err);
    let [shift, half] = shop.fitted("one", key);
    assert!((shift - 0.2).abs() < 0.002 && half > 0.0, "{shift} +- {half} um");
    let gone = [&surface[..1], &["cut/texture/finish/tooth_03_left.x3p@finish.tooth_04_left"], &surface[2..]].concat();
    shop.run("calibrate", &[], &gone).failed(1, &["finish.tooth_04_left", "finish.tooth_03_left"]);
    // What is random is no error of form.
    let random = ["--measured", "cut/points.csv", "--noise-um", "1", "--parameters", key];
    std::fs::write(shop.0.path().join("cut/points.csv"), "tooth,flank,u_mm,v_mm,deviation_um\n1,left,2,0,0\n")
        .expect("written");
    shop.run("diagnose", &[], &random).failed(1, &["random"]);
}

/// What the cut does comes back like an error: a compliance from the charts, the thinnest chip from a surface. Radius
/// and share of the thinnest chip are known as their product alone, and neither is identified beside the other.
#[test]
fn compliance_and_ploughing_come_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let soft = SCENE.replace("teeth = 24", "teeth = 12").replace(
        "[machine]",
        "[fields.chips]\nspacing_mm = 0.2\n[machine.compliance]\ntool_radial_um_per_kn = 4.0\n[machine]",
    );
    let spiral = soft
        .replace("strokes_per_revolution = 2400", "strokes_per_revolution = 240")
        .replace("[operation.infeed.none]", "[operation.infeed.spiral]\ndepth_mm = 7.0\nangle_deg = 90.0");
    std::fs::write(folder.path().join("soft.toml"), spiral).expect("written");
    let edge = "[tool.shaper_cutter.edge_rounding]\nradius_um = 5.0\nminimum_chip_share = 0.3\n";
    let plough = format!("{SCENE}{edge}{PLOUGHED}").replace("= 2400", "= 480");
    std::fs::write(folder.path().join("plough.toml"), plough).expect("written");
    let run = |arguments: &[&str]| gearcut_in(folder.path(), arguments);
    let compliance = "machine.compliance.tool_radial_um_per_kn";
    run(&["cut", "soft.toml", "--only", "report", "--out", "cut", "--set", &format!("{compliance}=8")]).done();
    let charts = ["--measured", "cut/inspection_charts.csv", "--noise-um", "0.2", "--fit", compliance, "--out", "a"];
    run(&[&["calibrate", "soft.toml"], &charts[..]].concat()).done();
    let share = "tool.shaper_cutter.edge_rounding.minimum_chip_share";
    run(&["cut", "plough.toml", "--only", "texture", "--out", "ploughed", "--set", &format!("{share}=0.4")]).done();
    let surface = ["--measured", "ploughed/texture/finish/tooth_03_left.x3p", "--surface-percent", "2"];
    let alone = [&["calibrate", "plough.toml"], &surface[..], &["--fit", share, "--out", "b"]].concat();
    run(&alone).done();
    for (out, id, expected) in [("a", compliance, 4.0), ("b", share, 0.1)] {
        let table = std::fs::read_to_string(folder.path().join(out).join("tables/fits.csv")).expect("a table");
        let cells: Vec<&str> = table.lines().nth(1).expect("a row").split(',').collect();
        let [shift, half] = [2, 3].map(|column| cells[column].parse::<f64>().expect("a number"));
        assert!((shift - expected).abs() < half && half < 0.3 * expected, "{id}: {shift} +- {half}");
    }
    let both = [&["calibrate", "plough.toml"], &surface[..], &["--surface-numbers", "Sa", "--out", "c"]].concat();
    let both = run(&[&both[..], &["--fit", "tool.shaper_cutter.edge_rounding"]].concat()).done();
    assert!(both.err.contains("minimum_chip_share cannot be identified"), "{}", both.err);
}

const PLOUGHED: &str = "
    [[texture]]
    tooth = 3
    side = \"left\"
    length_profile_mm = 3.0
    length_lead_mm = 0.5
    profile_spacing_um = 10.0
    lead_spacing_um = 250.0
    [fields.flank]
    profile_spacing_um = 80.0
    lead_spacing_um = 5000.0
    [fields.blank]
    spacing_mm = 1.0
    [fields.chips]
    spacing_mm = 0.4
";

/// Windows that are cut alone have the numbers of the whole result.
#[test]
fn windows_cut_alone_have_the_numbers_of_the_result() {
    let settings: Vec<String> = COARSE.iter().map(|&setting| setting.to_owned()).collect();
    let scene = format!("{SCENE}{WINDOW}");
    let loaded = process::parse(&scene, "round.toml", Path::new(""), &settings).expect("a scene");
    let choice = choose(BackendWish::Cpu, OnFailure::default()).expect("the processor");
    let whole = numbers(&loaded, &choice, &Interrupt::default()).expect("cut");
    let alone = texture_numbers(&loaded, &[(3, Side::Left)], &choice, &Interrupt::default()).expect("cut");
    assert!(alone.len() > 30 && alone.iter().all(|(path, value)| whole.get(path) == Some(value)), "{alone:?}");
    let of_texture = whole.keys().filter(|path| path.starts_with("texture.") || path.starts_with("roughness.")).count();
    assert_eq!(alone.len(), of_texture);
}
