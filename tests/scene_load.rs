//! Scenes that load: the shipped ones, the shortest one, the template, and what is printed from the table of keys.

use std::fs;
use std::path::{Path, PathBuf};

use gearcut::scene::model::{Feed, Infeed, Linkage, NormalReading, PitchCurveShape, Tip, TraditionalDirection};
use gearcut::scene::{LoadedScene, load, parse, reference, schema, template};

const SHORTEST: &str = "[gear]\nmodule_mm = 3.0\nteeth = 24\n[tool.shaper_cutter]\nteeth = 20\n";

fn read(text: &str) -> LoadedScene {
    parse(text, "test.toml", Path::new("scenes/shaping"), &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

fn shipped() -> Vec<PathBuf> {
    let folder = fs::read_dir("scenes/shaping").expect("the folder of scenes");
    let mut paths: Vec<PathBuf> = folder.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    assert!(paths.len() >= 8, "only {} scenes found", paths.len());
    paths
}

#[test]
fn shipped_scenes_load_and_are_listed_in_the_reference() {
    let reference = reference::markdown();
    for path in shipped() {
        let loaded = load(&path, &[]).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(Some(loaded.scene.name.as_str()), path.file_stem().and_then(|stem| stem.to_str()));
        let name = format!("`shaping/{}.toml`", loaded.scene.name);
        assert!(reference.contains(&name), "{name} is not listed in src/scene/reference_introduction.md");
        assert!(fs::read_to_string(&path).is_ok_and(|text| text.starts_with("# ")), "{name} opens without explanation");
    }
}

#[test]
fn the_paper_scene_means_what_it_says() {
    let scene = load(Path::new("scenes/shaping/elliptical_normal.toml"), &[]).expect("loads").scene;
    let ellipse = PitchCurveShape::Ellipse { order: 3, eccentricity: 0.1348, semi_major_axis_mm: Some(61.11) };
    assert_eq!(scene.gear.pitch_curve, ellipse);
    assert_eq!((scene.gear.module_mm, scene.gear.teeth, scene.gear.face_width_mm), (3.0, 42, 30.0));
    assert!((scene.gear.pressure_angle_rad - std::f64::consts::PI / 9.0).abs() < 1e-15);
    assert_eq!((scene.tool.teeth, scene.tool.addendum_coefficient), (20, 1.25));
    let offsets: Vec<f64> = scene.operations.iter().map(|operation| operation.offset_mm).collect();
    assert_eq!(offsets, [2.0, 0.0]);
    assert!(scene.operations.iter().all(|operation| operation.feed == Feed::StrokesPerRevolution(4200)));
    assert_eq!((scene.fields.profile_spacing_mm, scene.fields.lead_spacing_mm), (0.005, 0.05));
}

#[test]
fn the_shortest_scene_cuts_one_finishing_operation() {
    let scene = read(SHORTEST).scene;
    assert_eq!(scene.name, "test");
    assert_eq!(scene.gear.pitch_curve, PitchCurveShape::Circle);
    assert_eq!(scene.gear.face_width_mm, 30.0);
    let [finish] = scene.operations.as_slice() else { panic!("{} operations", scene.operations.len()) };
    assert_eq!((finish.name.as_str(), finish.offset_mm), ("finish", 0.0));
    assert_eq!(finish.linkage, Linkage::ShapingNormal { reading: NormalReading::Corrected });
    assert_eq!(finish.feed, Feed::StrokesPerRevolution(2400));
}

#[test]
fn stock_per_flank_becomes_an_offset() {
    let scene = load(Path::new("scenes/shaping/elliptical_finishing_stock.toml"), &[]).expect("loads").scene;
    let rough = &scene.operations[0];
    assert!((rough.offset_mm * scene.gear.pressure_angle_rad.sin() - 0.2).abs() < 1e-15);
    assert_eq!(rough.infeed, Infeed::Spiral { depth_mm: 6.2, angle_rad: std::f64::consts::FRAC_PI_2 });
}

#[test]
fn every_variant_loads_and_reads_back_from_its_resolved_text() {
    let curves = [
        "circle]",
        "ellipse]\norder = 1\neccentricity = 0.3",
        "sinusoidal_ratio]\norder = 2\nmean_ratio = 1.1\nratio_amplitude = 0.1\ncenter_distance_mm = 77.7",
        "pascal]\norder = 2\neccentricity = 0.07\nmean_radius_mm = 36.1",
        "fourier]\nsine = [0.1]",
        "table]\nfile = \"table_of_points.csv\"\nscale_to_close = false",
        "table]\npoints_deg_mm = [[0, 36], [90.5, 36.25], [180.1, 36], [270.7, 36.1]]",
    ];
    let tips = ["sharp]", "round]\nradius_mm = 0.3", "chamfer]\nheight_mm = 0.3\nangle_deg = 33.3"];
    let linkages = ["shaping_traditional]\ndirection = \"polar_radius\"", "shaping_normal]\nreading = \"as_printed\""];
    let infeeds = [
        "none]",
        "plunge]\ndepth_mm = 6.1\nstrokes = 70",
        "spiral]\ndepth_mm = 6.1\nangle_deg = 77.7",
        "plunge_and_roll]\nplunge_depth_mm = 3.3\nstrokes = 40\nroll_depth_mm = 2.9\nangle_deg = 66.6",
    ];
    let feeds = [
        "strokes_per_revolution = 777\noffset_mm = 0.1",
        "circular_feed_mm_per_stroke = 0.123\nwindow_deg = [-10.1, 100.3]",
    ];
    let limits = "[machine.limits]\nwork_speed_deg_per_s = 61.7\ncenter_distance_acceleration_mm_per_s2 = 501.3\n";
    let tool = "[tool.shaper_cutter]\nteeth = 5\nrunout_um = 3.3\npitch_errors_um = [0.1, 0.2, 0.3, 0.4, -0.7]\n";
    let mut count = 0;
    for (curve, tip, linkage, infeed, feed) in itertools(&curves, &tips, &linkages, &infeeds, &feeds) {
        let text = format!(
            "[gear]\nmodule_mm = 3.0\nteeth = 24\nface_width_mm = 0.3\n[gear.pitch_curve.{curve}\n{tool}\
             [tool.shaper_cutter.tip.{tip}\n{limits}[[operation]]\nstock_per_flank_mm = 0.17\n[[operation]]\n{feed}\n\
             stroke_spacing = \"time\"\n[operation.linkage.{linkage}\n[operation.infeed.{infeed}\n\
             [measure]\nprofile_start_height_mm = -1.1\n[output]\nfolder = 'a \\ \"b\"'\n"
        );
        let first = read(&text);
        let second = read(&first.resolved_toml());
        assert_eq!(first.scene, second.scene, "{}", first.resolved_toml());
        count += 1;
    }
    println!("{count} combinations read back");
    let scene = read(&format!("{SHORTEST}[tool.shaper_cutter.tip.round]\nradius_mm = 0.3\n[[operation]]\n[operation.linkage.shaping_traditional]\n")).scene;
    assert_eq!(scene.tool.tip, Tip::Round { radius_mm: 0.3 });
    let centre_line = Linkage::ShapingTraditional { direction: TraditionalDirection::CenterLine };
    assert_eq!(scene.operations[0].linkage, centre_line);
}

/// All combinations of five lists.
fn itertools<'a>(
    a: &'a [&str],
    b: &'a [&str],
    c: &'a [&str],
    d: &'a [&str],
    e: &'a [&str],
) -> impl Iterator<Item = (&'a str, &'a str, &'a str, &'a str, &'a str)> {
    let pairs = a.iter().flat_map(move |a| b.iter().map(move |b| (*a, *b)));
    let fours = pairs.flat_map(move |(a, b)| c.iter().flat_map(move |c| d.iter().map(move |d| (a, b, *c, *d))));
    fours.flat_map(move |(a, b, c, d)| e.iter().map(move |e| (a, b, c, d, *e)))
}

#[test]
fn shipped_scenes_read_back_from_their_resolved_text() {
    for path in shipped() {
        let first = load(&path, &[]).expect("loads");
        let second = parse(&first.resolved_toml(), &path.display().to_string(), Path::new(""), &[]);
        assert_eq!(first.scene, second.unwrap_or_else(|errors| panic!("{errors}")).scene);
    }
}

#[test]
fn the_template_loads_also_with_any_of_its_keys_switched_on() {
    assert!(template("knitting").is_none());
    let text = template("shaping").expect("a template");
    let plain = read(&text).scene;
    assert_eq!(plain.operations[0].name, "operation_1");
    let keys: Vec<&str> = text.lines().filter(|line| line.starts_with('#') && line.contains(" = ")).collect();
    let mut switched = 0;
    for key in keys.iter().filter(|line| !line.starts_with("# ")) {
        let on = text.replacen(key, &key[1..], 1);
        let outcome = parse(&on, "test.toml", Path::new(""), &[]).map_err(|errors| errors.to_string());
        let refused = outcome.err().filter(|errors| !errors.contains("is not a") && !errors.contains("is missing"));
        assert!(refused.is_none_or(|errors| errors.contains("say the same thing twice")), "{key}");
        switched += 1;
    }
    assert!(switched > 20, "only {switched} keys to switch on");
}

#[test]
fn schema_is_up_to_date() {
    stale("scenes/schema.json", &schema::json_schema(), "gearcut schema > scenes/schema.json");
}

#[test]
fn reference_is_up_to_date() {
    stale("scenes/README.md", &reference::markdown(), "GEARCUT_BLESS=1 cargo test --test scene_load");
}

/// Says when a printed file is no longer what the table of keys says; `GEARCUT_BLESS` rewrites it.
fn stale(path: &str, wanted: &str, command: &str) {
    if std::env::var_os("GEARCUT_BLESS").is_some() {
        fs::write(path, wanted).expect("write the printed file");
    }
    let found = fs::read_to_string(path).unwrap_or_default();
    assert!(found == wanted, "{path} is stale: run `{command}`");
}
