//! `--set`, and finding keys again after loading.

use std::path::Path;

use gearcut::Refusal;
use gearcut::gear::PitchCurveShape;
use gearcut::process::shaping::scene::model::{
    Feed, Linkage, NormalReading, Shaping, StrokeSpacing, TraditionalDirection,
};
use gearcut::process::{load, parse};
use gearcut::scene::model::Scene;
use gearcut::scene::{LoadedScene, SourcePlace};

const PAPER: &str = "scenes/shaping/elliptical_normal.toml";

fn shaping(scene: &Scene) -> &Shaping {
    Shaping::of(scene).expect("a shaping scene")
}

fn set(settings: &[&str]) -> LoadedScene {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    load(Path::new(PAPER), &settings).unwrap_or_else(|errors| panic!("{errors}"))
}

#[test]
fn settings_take_the_place_of_written_values_and_defaults() {
    let scene = set(&[
        "gear.module_mm=2.5",
        "gear.pitch_curve.ellipse.semi_major_axis_mm = 50.9",
        "operation.rough.offset_mm=1.5",
        "operation.1.offset_mm=0.25",
        "operation[1].name=last",
        "operation.0.stroke_spacing=\"arc\"",
        "tool.shaper_cutter.pitch_errors_um=[]",
        "output.folder=out/a-b.c",
    ])
    .scene;
    assert_eq!(scene.gear.module_mm, 2.5);
    assert_eq!((shaping(&scene).operations[0].offset_mm, shaping(&scene).operations[1].offset_mm), (1.5, 0.25));
    assert_eq!(
        (shaping(&scene).operations[1].name.as_str(), shaping(&scene).operations[0].spacing),
        ("last", StrokeSpacing::Arc)
    );
    assert_eq!(scene.output.folder.as_deref(), Some(Path::new("out/a-b.c")));
}

#[test]
fn a_setting_takes_the_place_of_its_rivals() {
    let loaded = set(&[
        "operation.rough.linkage.shaping_traditional={}",
        "operation.finish.circular_feed_mm_per_stroke=0.2",
        "operation.finish.linkage.shaping_normal.reading=as_printed",
        "gear.pitch_curve.circle={}",
    ]);
    let traditional = Linkage::ShapingTraditional { direction: TraditionalDirection::CenterLine };
    let as_printed = Linkage::ShapingNormal { reading: NormalReading::AsPrinted };
    assert_eq!(shaping(&loaded.scene).operations[0].linkage, traditional);
    assert_eq!(shaping(&loaded.scene).operations[1].linkage, as_printed);
    assert_eq!(shaping(&loaded.scene).operations[1].feed, Feed::CircularMmPerStroke(0.2));
    assert_eq!(loaded.scene.gear.pitch_curve, PitchCurveShape::Circle);
}

#[test]
fn settings_reach_the_operation_that_nobody_wrote() {
    let text = "[gear]\nmodule_mm = 3.0\nteeth = 24\n[tool.shaper_cutter]\nteeth = 20\n";
    let settings = ["operation.finish.strokes_per_revolution=481", "operation.rough.stock_per_flank_mm=0.3"];
    let loaded = parse(text, "short.toml", Path::new(""), &settings.map(str::to_owned)).expect("loads");
    let [rough, finish] = shaping(&loaded.scene).operations.as_slice() else { panic!("two operations") };
    assert_eq!((rough.feed, finish.feed), (Feed::StrokesPerRevolution(480), Feed::StrokesPerRevolution(481)));
    // Involutes of the base circles, from 66 mm between the axes on.
    let (bases_mm, inv) = (66.0 * 20_f64.to_radians().cos(), |angle: f64| angle.tan() - angle);
    let between_mm = bases_mm * (inv((bases_mm / (66.0 + rough.offset_mm)).acos()) - inv(20_f64.to_radians()));
    assert!((between_mm - 0.3).abs() < 1e-9, "{between_mm}");
    // A tool that is set chooses what operations the scene has without any.
    let (tool, gear) = ("tool.shaper_cutter.teeth=20".to_owned(), text.split("[tool").next().expect("a gear"));
    let settings = [tool, "operation.rough.strokes_per_revolution=482".to_owned()];
    let set = parse(gear, "short.toml", Path::new(""), &settings).expect("loads").scene;
    assert_eq!(shaping(&set).operations[0].feed, Feed::StrokesPerRevolution(482));
}

#[test]
fn written_keys_are_located() {
    let loaded = set(&["gear.teeth=43"]);
    let module = loaded.locate("gear.module_mm").expect("written");
    assert_eq!(module.written, "3.0");
    assert_eq!(module.place.to_string(), format!("{PAPER}:8:13"));
    for key in ["operation.finish.offset_mm", "operation.1.offset_mm", "operation[1].offset_mm"] {
        assert_eq!(loaded.locate(key).expect("written").written, "0.0", "{key}");
    }
    assert_eq!(loaded.locate("operation.offset_mm").expect("written").written, "2.0");
    let teeth = loaded.locate("gear.teeth").expect("set");
    assert_eq!(
        (teeth.written.as_str(), teeth.place),
        ("43", SourcePlace::Set { argument: "gear.teeth=43".to_owned() })
    );
    assert!(loaded.locate("gear.bore_diameter_mm").is_none(), "a default stands nowhere");
    for key in ["", "operation", "operation.7.offset_mm", "no.such.key", "..", "operation.."] {
        assert!(loaded.locate(key).is_none(), "{key}");
    }
}

#[test]
fn refusals_are_explained_at_their_place() {
    let loaded = set(&[]);
    let refusal = Refusal::new("tool.shaper_cutter.teeth", "the cutter undercuts", "take fewer teeth");
    let expected = format!(
        "error: {PAPER}:19:9: `tool.shaper_cutter.teeth` = 20: the cutter undercuts\n  19 | teeth = 20\n     |         \
        ^^\n  way out: take fewer teeth"
    );
    assert_eq!(loaded.explain(&refusal).to_string(), expected);
    let refusal = Refusal::new("gear.bore_diameter_mm", "too large", "make it smaller");
    let text = loaded.explain(&refusal).to_string();
    assert!(
        text.starts_with(&format!(
            "error: {PAPER}:7:2: `gear.bore_diameter_mm` (not written, 0.0 by default): too large\n"
        )),
        "{text}"
    );
    let text = loaded.explain(&Refusal::new("nonsense", "odd", "none")).to_string();
    assert!(text.starts_with(&format!("error: {PAPER}:1:1: `nonsense`: odd\n")), "{text}");
}

#[test]
fn windows_line_ends_and_a_byte_order_mark_do_not_shift_places() {
    let text = "\u{feff}[gear]\r\nmodule_mm = 300\r\nteeth = 24\r\n[tool.shaper_cutter]\r\nteeth = 20\r\n";
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("dos.toml");
    std::fs::write(&path, text).expect("write the scene");
    let errors = load(&path, &[]).expect_err("out of range").to_string();
    assert!(errors.starts_with(&format!("error: {}:2:13: ", path.display())), "{errors}");
    assert!(errors.contains("\n  2 | module_mm = 300\n"), "{errors}");
    std::fs::write(&path, text.replace('2', "\u{feff}3")).expect("write the scene");
    assert!(load(&path, &[]).is_err(), "a byte order mark inside is no blank");
    std::fs::write(&path, [0xff, 0xfe, 0x41]).expect("write the scene");
    assert!(load(&path, &[]).expect_err("no UTF-8").to_string().contains("not UTF-8"));
}
