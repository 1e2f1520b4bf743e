//! Scenes that load: the shipped ones, the shortest one, the template, and what is printed from the table of keys.

use std::fs;
use std::path::{Path, PathBuf};

use crate::fixtures::printed::stale;
use gearcut::gear::PitchCurveShape;
use gearcut::process::hobbing::scene::model::Hobbing;
use gearcut::process::shaping::scene::model::{
    Feed, Infeed, Linkage, NormalReading, Operation, Shaping, Tip, TraditionalDirection,
};
use gearcut::process::{PROCESSES, load, parse, table};
use gearcut::scene::keys::Role;
use gearcut::scene::model::Scene;
use gearcut::scene::{KeyTable, LoadedScene, SceneProcess, TableSection, reference, schema, template};

const SHORTEST: &str = "[gear]\nmodule_mm = 3.0\nteeth = 24\n[tool.shaper_cutter]\nteeth = 20\n";

fn shaping(scene: &Scene) -> &Shaping {
    Shaping::of(scene).expect("a shaping scene")
}

fn read(text: &str) -> LoadedScene {
    parse(text, "test.toml", Path::new("scenes/shaping"), &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Scenes that come with the program, process by process.
fn shipped() -> Vec<PathBuf> {
    PROCESSES.iter().flat_map(|process| shipped_of(process.scene)).collect()
}

/// Scenes of a process; there are as many as its list says.
fn shipped_of(process: &SceneProcess) -> Vec<PathBuf> {
    let folder = fs::read_dir(format!("scenes/{}", process.name)).expect("a folder of scenes");
    let mut paths: Vec<PathBuf> = folder.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    assert!(!paths.is_empty(), "no scenes for {}", process.name);
    assert_eq!(paths.len(), process.scenes.lines().count(), "scenes for {}: {paths:?}", process.name);
    paths
}

#[test]
fn shipped_scenes_load_and_are_listed_in_the_reference() {
    let reference = reference::markdown(table());
    for process in PROCESSES.iter().map(|process| process.scene) {
        for path in shipped_of(process) {
            let loaded = load(&path, &[]).unwrap_or_else(|errors| panic!("{errors}"));
            assert_eq!(Some(loaded.scene.name.as_str()), path.file_stem().and_then(|stem| stem.to_str()));
            assert_eq!(loaded.scene.process_name(), process.name);
            let name = format!("`{}/{}.toml`", process.name, loaded.scene.name);
            assert!(process.scenes.contains(&name), "{name} is not listed in scene/scenes.md of its process");
            assert!(reference.contains(&name), "{name} is not in the reference");
            let text = fs::read_to_string(&path);
            assert!(text.is_ok_and(|text| text.starts_with("# ")), "{name} opens without explanation");
        }
    }
}

#[test]
fn the_paper_scene_means_what_it_says() {
    let scene = load(Path::new("scenes/shaping/elliptical_normal.toml"), &[]).expect("loads").scene;
    let ellipse = PitchCurveShape::Ellipse { order: 3, eccentricity: 0.1348, semi_major_axis_mm: Some(61.11) };
    assert_eq!(scene.gear.pitch_curve, ellipse);
    assert_eq!((scene.gear.module_mm, scene.gear.teeth, scene.gear.face_width_mm), (3.0, 42, 30.0));
    assert!((scene.gear.pressure_angle_rad - std::f64::consts::PI / 9.0).abs() < 1e-15);
    assert_eq!((shaping(&scene).tool.teeth, shaping(&scene).tool.addendum_coefficient), (20, 1.25));
    let offsets: Vec<f64> = shaping(&scene).operations.iter().map(|operation| operation.offset_mm).collect();
    assert_eq!(offsets, [2.0, 0.0]);
    assert!(shaping(&scene).operations.iter().all(|operation| operation.feed == Feed::StrokesPerRevolution(4200)));
    assert_eq!((scene.fields.profile_spacing_mm, scene.fields.lead_spacing_mm), (0.005, 0.05));
}

/// The example of the design, comments and all: written once, promised to load.
#[test]
fn the_example_with_comments_inside_loads() {
    let text = r#"
[gear]
module_mm = 3.0
teeth = 42
pressure_angle_deg = 20.0
face_width_mm = 30.0
[gear.pitch_curve.ellipse]        # r = a (1 - k^2) / (1 - k cos n phi)
order = 3
eccentricity = 0.1348
semi_major_axis_mm = 61.11        # leave out: solved so that the curve closes on teeth * pi * module
[tool.shaper_cutter]
teeth = 20
addendum_coefficient = 1.25
[[operation]]
name = "rough"
offset_mm = 2.0                   # delta_d
strokes_per_revolution = 4200
[operation.linkage.shaping_normal]
[operation.infeed.none]
[[operation]]
name = "finish"
offset_mm = 0.0
strokes_per_revolution = 4200
feed_during_stroke = false        # true: the rotary feed goes on while the cutter is in the work (stroke law: crank)
[operation.linkage.shaping_normal]
[operation.infeed.none]
[fields.flank]
profile_spacing_um = 5.0
lead_spacing_um = 50.0
"#;
    let mut scene = read(text).scene;
    scene.name = "elliptical_normal".to_owned();
    assert_eq!(scene, load(Path::new("scenes/shaping/elliptical_normal.toml"), &[]).expect("loads").scene);
}

/// Depth and angle of a spiral, and the overlap beyond the turn, mm and deg.
fn spiral(operation: &Operation) -> [f64; 3] {
    let Infeed::Spiral { depth_mm, angle_rad } = operation.infeed else { panic!("{operation:?}") };
    [depth_mm, angle_rad.to_degrees(), operation.overlap_rad.to_degrees()]
}

fn assert_close(found: [f64; 3], wanted: [f64; 3]) {
    assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-9), "{found:?}, {wanted:?}");
}

/// The whole depth of the teeth is 2.25 modules, 6.75 mm; roughing leaves 0.2 mm on each flank of module 3.
#[test]
fn the_shortest_scene_roughs_on_a_spiral_and_finishes() {
    let scene = read(SHORTEST).scene;
    assert_eq!(scene.name, "test");
    assert_eq!(scene.gear.pitch_curve, PitchCurveShape::Circle);
    assert_eq!(scene.gear.face_width_mm, 30.0);
    let [rough, finish] = shaping(&scene).operations.as_slice() else {
        panic!("{} operations", shaping(&scene).operations.len())
    };
    assert_eq!((rough.name.as_str(), finish.name.as_str(), finish.offset_mm), ("rough", "finish", 0.0));
    // Both base circles together have (r_b1 + r_b2) (inv(alpha_w) - inv(alpha)) of room for each flank's stock.
    let (alpha_rad, offset_mm) = (20_f64.to_radians(), rough.offset_mm);
    let (base_mm, involute) = (66.0 * alpha_rad.cos(), |rad: f64| rad.tan() - rad);
    let working_rad = (base_mm / (66.0 + offset_mm)).acos();
    let stock_mm = base_mm * (involute(working_rad) - involute(alpha_rad));
    assert!((stock_mm - 0.2).abs() < 1e-10, "{offset_mm}: {stock_mm}");
    let angle_deg = |depth_mm: f64| 90.0 * depth_mm / 6.75;
    let deg = [6.75 - offset_mm, offset_mm].map(angle_deg);
    assert_close(spiral(rough), [6.75 - offset_mm, deg[0], deg[0]]);
    assert_close(spiral(finish), [offset_mm, deg[1], deg[1]]);
    assert_eq!(finish.linkage, Linkage::ShapingNormal { reading: NormalReading::Corrected });
    let feeds = [rough.feed, finish.feed];
    assert_eq!(feeds, [Feed::StrokesPerRevolution(480), Feed::StrokesPerRevolution(2400)]);
}

/// What of infeed and overlap is written holds; a window and a second cut at the same depth have nothing to feed.
#[test]
fn operations_feed_what_is_left_unless_they_say_otherwise() {
    let text = format!(
        "{SHORTEST}[[operation]]\noffset_mm = 1.5\n[[operation]]\noffset_mm = 0.75\n[operation.infeed.spiral]\n\
         angle_deg = 45\n[[operation]]\nrevolutions = 2\n[[operation]]\n[[operation]]\nwindow_deg = [0, 90]\n\
         [[operation]]\noffset_mm = -0.1\n[operation.infeed.none]\n"
    );
    let scene = read(&text).scene;
    let [first, second, third, same, window, deeper] = shaping(&scene).operations.as_slice() else {
        panic!("{} operations", shaping(&scene).operations.len())
    };
    assert_close(spiral(first), [5.25, 70.0, 70.0]);
    assert_close(spiral(second), [0.75, 45.0, 0.0]);
    assert_close(spiral(third), [0.75, 10.0, 0.0]);
    for operation in [same, window, deeper] {
        assert_eq!((operation.infeed, operation.overlap_rad), (Infeed::None, 0.0));
    }
    let again = read(&read(&text).resolved_toml()).scene;
    assert_eq!(scene, again);
}

#[test]
fn stock_per_flank_becomes_an_offset() {
    let scene = load(Path::new("scenes/shaping/elliptical_finishing_stock.toml"), &[]).expect("loads").scene;
    let rough = &shaping(&scene).operations[0];
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
        "radius_formula]\nradius = \"1 + 0.1*cos(phi)^2\"",
        "ratio_formula]\nratio = '1.1 + 0.1*sin(2*phi)'\ncenter_distance_mm = 77.7",
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
    for (curve, tip, linkage, infeed, feed) in combinations(&curves, &tips, &linkages, &infeeds, &feeds) {
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
    let scene = read(&format!(
        "{SHORTEST}[tool.shaper_cutter.tip.round]\nradius_mm = \
        0.3\n[[operation]]\n[operation.linkage.shaping_traditional]\n"
    ))
    .scene;
    assert_eq!(shaping(&scene).tool.tip, Tip::Round { radius_mm: 0.3 });
    let centre_line = Linkage::ShapingTraditional { direction: TraditionalDirection::CenterLine };
    assert_eq!(shaping(&scene).operations[0].linkage, centre_line);
}

/// All combinations of five lists.
fn combinations<'a>(
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
        // Files that are read with a scene stay where they are, beside it.
        let folder = path.parent().expect("a folder");
        let second = parse(&first.resolved_toml(), &path.display().to_string(), folder, &[]);
        assert_eq!(first.scene, second.unwrap_or_else(|errors| panic!("{errors}")).scene);
    }
}

#[test]
fn the_template_loads() {
    assert!(template(table(), "knitting").is_none());
    for process in table().processes() {
        let scene = read(&template(table(), process.name).expect("a template")).scene;
        assert_eq!(scene.process_name(), process.name);
        let names: &[&str] = if process.name == "shaping" { &["rough", "finish"] } else { &["operation_1"] };
        assert_eq!(scene.process.operation_names(), names);
        assert_eq!(scene.gear.face_width_mm, 30.0);
    }
}

#[test]
fn every_variant_of_hobbing_reads_back_from_its_resolved_text() {
    let hobs = [
        "lead_angle_deg = 3.3\nhand = \"left\"\nworm = \"straight_sided\"",
        "reference_diameter_mm = 80.1\nstarts = 2\ngash_form = \"helical\"\nprotuberance_height_mm = 1.7\nregrind_mm = \
        0.3",
    ];
    let linkages = [
        "hobbing]\neven_motion = \"rotation_angle\"\nextra_rotation = \"hob\"",
        "hobbing]\neven_motion = \"polar_angle\"\nform = \"as_printed\"",
        "hobbing_diagonal]\nshift_mm_per_revolution = 3.1\nshift_direction = \"adds\"\nfeed_of = \"resultant\"",
        "hobbing_diagonal]\nstrategy = \"repeating\"\nstroke_mm = 33.3\nreturn_mm_per_s = 7.7",
    ];
    // With material and evaluated profile, each written and not.
    let more = ["[material]\nname = \"C45\"\n", "[measure]\nprofile_end_height_mm = 2.1\n"];
    for (i, hob) in hobs.into_iter().enumerate() {
        for linkage in linkages {
            let more = more[i];
            let text = format!(
                "[gear]\nmodule_mm = 3.0\nteeth = 24\nhelix_angle_deg = 12.3\nhand = \"left\"\n[tool.hob]\nlength_mm = \
                90\n{hob}\n\
                 [machine.hobbing_limits]\nhob_speed_deg_per_s = 1234.5\n[[operation]]\napproach = \"radial\"\n\
                 stock_per_flank_mm = 0.1\n[[operation]]\nfeed_direction = \"conventional\"\noverrun_mm = 7.1\n\
                 head_angle_deg = 8.8\n[operation.linkage.{linkage}\n{more}"
            );
            let first = read(&text);
            let second = read(&first.resolved_toml());
            assert_eq!(first.scene, second.scene, "{}", first.resolved_toml());
            let material = Hobbing::of(&second.scene).expect("a hobbing scene").material;
            assert_eq!(material.is_some(), more.contains("C45"), "{}", first.resolved_toml());
            assert_eq!(second.scene.measure.profile_end_height_mm.is_some(), material.is_none());
            // Nothing of the other process stands in the resolved text.
            assert!(!first.resolved_toml().contains("strokes"), "{}", first.resolved_toml());
        }
    }
}

/// Blocks of the template stand between empty lines; `#` without a blank marks what can be switched on.
#[test]
fn everything_in_the_template_can_be_switched_on() {
    for process in table().processes() {
        let text = template(table(), process.name).expect("a template");
        let shortest = shortest(&text);
        read(&shortest);
        let (mut variants, mut keys) = (0, 0);
        for block in text.split("\n\n") {
            if block.lines().any(|line| line.starts_with("#[")) {
                let on =
                    block.lines().filter(|line| !line.contains("file = ")).map(|line| switch(line).unwrap_or(line));
                // What holds the section is off as well.
                let holder = if block.contains("#[operation") {
                    "[[operation]]\n"
                } else if block.contains("#[gear.pitch_curve.mate.driver") {
                    "[gear.pitch_curve.mate]\ndriver_teeth = 12\n"
                } else {
                    ""
                };
                read(&format!("{shortest}{holder}{}\n", on.collect::<Vec<_>>().join("\n")));
                variants += 1;
            } else {
                for key in block.lines().filter_map(switch) {
                    let mut one = block.replacen(&format!("#{key}"), key, 1);
                    if name(key) == "rim_mm" {
                        // Of rings alone, which hobs do not cut.
                        one = one.replacen("kind = \"external\"", "kind = \"internal\"", 1);
                        if process.name == "hobbing" {
                            continue;
                        }
                    }
                    let mut whole = text.clone();
                    if ["infeed_mm_per_revolution", "dwell_revolutions"].contains(&name(key)) {
                        // Of gears alone that are not generated.
                        whole = whole.replacen("#roll_ratio = 1.4647", "roll_ratio = 0.0", 1);
                    }
                    if name(key) == "spiral_angle_deg" {
                        // In place of both, and for a known head.
                        whole = whole.replacen("#radius_mm = ", "radius_mm = ", 1);
                    }
                    if name(key) == "coordinate" || needed(name(key)).contains(&"coordinate") {
                        // A mass vibrates on a spring.
                        whole = whole.replacen("#tool_tangential_um_per_kn = ", "tool_tangential_um_per_kn = ", 1);
                    }
                    if ["sector_deg", "dwell_radius_mm"].contains(&name(key)) {
                        // A sector is cut in one swing at depth.
                        whole = whole.replacen("\n[operation.infeed.spiral]", "\n[operation.infeed.none]", 1);
                    }
                    if ["guide_lead_mm", "guide_hand"].contains(&name(key)) {
                        // Spur gears have a straight guide; allowances of helical ones are not probed.
                        let probed = |block: &&str| !block.contains("[measure.cmm]");
                        whole = whole.split("\n\n").filter(probed).collect::<Vec<_>>().join("\n\n");
                        whole = whole.replacen("\nhelix_angle_deg = 0.0", "\nhelix_angle_deg = 15.0", 1);
                    }
                    for needed in needed(name(key)) {
                        one = one.replacen(&format!("#{needed} = "), &format!("{needed} = "), 1);
                    }
                    for rival in rivals(name(key)) {
                        one = one.replacen(&format!("\n{rival} = "), &format!("\n#{rival} = "), 1);
                    }
                    read(&whole.replacen(block, &one, 1));
                    keys += 1;
                }
            }
        }
        println!("{}: {variants} variants and {keys} keys switched on", process.name);
        assert_eq!(variants, switched_off(&KeyTable::new(&[process])), "{}", process.name);
        assert!(keys >= 12, "{}: {keys} keys", process.name);
    }
}

/// Keys without which another one of its section says nothing, as far as the section has them.
fn needed(name: &str) -> &'static [&'static str] {
    match name {
        "feed_forward" | "speed_loop_ms" => &["velocity_gain_per_s"],
        "gearbox_increment_arcsec" | "gearbox_increment_um" => &["gearbox_cycle_ms"],
        "drift_time_constant_min" => &["drift_um_per_h"],
        "noise_arcsec" | "noise_um" => &["noise_bandwidth_hz"],
        "noise_bandwidth_hz" => &["noise_arcsec", "noise_um"],
        "rq_um" => &["correlation_length_um"],
        "correlation_length_um" => &["rq_um"],
        "radius_um" => &["minimum_chip_share"],
        "coordinate" => &["natural_frequency_hz", "damping_ratio"],
        "natural_frequency_hz" => &["coordinate", "damping_ratio"],
        "damping_ratio" => &["coordinate", "natural_frequency_hz"],
        "minimum_chip_share" => &["radius_um"],
        "density_per_mm2"
        | "speeds_m_per_min"
        | "full_speeds_m_per_min"
        | "chip_um"
        | "chip_exponent"
        | "depth_um"
        | "width_um"
        | "scratch_share"
        | "scratch_length_um" => &[
            "density_per_mm2",
            "speeds_m_per_min",
            "full_speeds_m_per_min",
            "chip_um",
            "chip_exponent",
            "depth_um",
            "width_um",
            "scratch_share",
            "scratch_length_um",
        ],
        "stock_scatter_length_mm" => &["stock_scatter_um"],
        "dwell_radius_mm" => &["sector_deg"],
        "limit_mm" => &["life_m"],
        "life_m" | "gears_to_limit" => &["limit_mm"],
        "life_range_m" | "thickness_exponent_range" => &["limit_mm", "life_m"],
        _ => &[],
    }
}

/// Sections of a process's table that do not hold unless they are written.
fn switched_off(own: &KeyTable) -> usize {
    own.sections().iter().filter(|section| is_off(own, section)).count()
}

/// Whether a section with a header does not hold unless it is written.
fn is_off(own: &KeyTable, section: &TableSection) -> bool {
    match section.role {
        Role::List { fewest } => fewest == 0,
        Role::Variant => {
            let choice = own.section(section.parent_path()).expect("a variant is chosen somewhere");
            let other = choice.default().is_some_and(|default| default != section.name());
            other || own.section(choice.parent_path()).is_some_and(|holder| is_off(own, holder))
        }
        _ => false,
    }
}

/// A line of the template switched on, if it is off.
fn switch(line: &str) -> Option<&str> {
    line.strip_prefix('#').filter(|rest| rest.starts_with(|c: char| c != ' '))
}

/// Name of the key that a line of the template gives.
fn name(line: &str) -> &str {
    line.split(" = ").next().unwrap_or_default()
}

/// Keys that exclude this one.
fn rivals(name: &str) -> impl Iterator<Item = &'static str> {
    let groups = table().sections().iter().flat_map(|section| &section.groups);
    groups
        .filter(move |group| group.names.contains(&name))
        .flat_map(|group| group.names)
        .copied()
        .filter(move |rival| *rival != name)
}

/// What of a template cannot be left out: gear and tool with the keys that must be written.
fn shortest(template: &str) -> String {
    let mut out = String::new();
    let mut header = "";
    for line in template.lines() {
        if line.starts_with('[') {
            header = line;
            // The tool says which process it is, even where none of its keys must be written.
            if line.starts_with("[tool.") && line.matches('.').count() == 1 {
                out.extend([header, "\n"]);
                header = "";
            }
        } else if !line.starts_with('#') && (line.ends_with("; required") || line.ends_with("; one of the two")) {
            // The header of a section stands before the first key that must be written.
            if !header.is_empty() {
                out.extend([header, "\n"]);
                header = "";
            }
            out.extend([line, "\n"]);
        }
    }
    out
}

#[test]
fn schema_is_up_to_date() {
    stale("scenes/schema.json", &schema::json_schema(table()), "gearcut schema > scenes/schema.json");
}

#[test]
fn reference_is_up_to_date() {
    stale("scenes/README.md", &reference::markdown(table()), "GEARCUT_BLESS=1 cargo test --test suite scene::load");
}

/// A section that two other processes read is said to be both's.
#[test]
fn a_foreign_section_names_all_who_read_it() {
    let written = ["check", "scenes/bevel/crown_gear.toml", "--set", "measure.profile_start_height_mm=1.0"];
    crate::fixtures::command::gearcut(&written).failed(
        1,
        &[
            "belongs to shaping and hobbing; this scene is for bevel",
            "write [tool.shaper_cutter] or [tool.hob] instead",
        ],
    );
}
