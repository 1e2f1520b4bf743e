//! `gearcut cut` from the outside: what it writes, and that the same scene gives the same bytes.

use crate::fixtures::command::{
    assert_same_files, files, gearcut, gearcut_on_threads, read_json, scenes_of_all_shapes,
};
use crate::fixtures::json_schema::assert_is_results;
use crate::fixtures::picture::Picture;
use gearcut::output::surface_files::read_surface;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use tempfile::TempDir;

const ROUND: &str = "scenes/shaping/circular_m3_z24.toml";
const COARSE: [&str; 12] = [
    "--set",
    "fields.flank.profile_spacing_um=50",
    "--set",
    "fields.flank.lead_spacing_um=5000",
    "--set",
    "fields.chips.spacing_mm=0.2",
    "--set",
    "fields.blank.spacing_mm=0.5",
    "--set",
    "picture=[{name='gear',width_px=96,height_px=72},{name='mark',view='flank',tooth=3,side='right',colour='pass',\
     width_px=96,height_px=72,exr=true}]",
    "--frames",
    "3",
];

/// What makes a scene quick where only its findings are looked at.
const BRIEF: [&str; 14] = [
    "--only",
    "report",
    "--set",
    "picture=[]",
    "--set",
    "fields.flank.profile_spacing_um=400",
    "--set",
    "fields.flank.lead_spacing_um=10000",
    "--set",
    "fields.blank.spacing_mm=4",
    "--set",
    "fields.blank.slice_spacing_mm=30",
    "--set",
    "fields.chips.spacing_mm=2",
];

/// A whole result with every kind of file.
struct WholeResult {
    folder: TempDir,
    files: Vec<(PathBuf, Vec<u8>)>,
}

/// Cut once, on two threads, for all tests that look at it.
static WHOLE: LazyLock<WholeResult> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("a path").to_owned() + "/gear";
    let arguments = [&["cut", ROUND, "--quiet", "--backend", "cpu", "--out", &out], &COARSE[..]].concat();
    gearcut_on_threads(2, &arguments).done();
    let files = files(Path::new(&out));
    WholeResult { folder, files }
});

/// A draft goes beside the whole result, on coarser dexels unless a setting says otherwise.
#[test]
fn a_draft_is_coarse_and_takes_no_result_away() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scene = root.join("scenes/shaping/circular_m3_z24.toml");
    let scene = scene.to_str().expect("a path");
    let arguments = ["cut", scene, "--draft", "--backend", "cpu", "--set", "fields.blank.spacing_mm=0.7"];
    let run = crate::fixtures::command::gearcut_in(folder.path(), &arguments).done();
    assert!(run.out.contains("flanks cut"), "{}", run.out);
    let out = folder.path().join("out/circular_m3_z24_draft");
    let record = read_json(&out.join("run.json"));
    assert_eq!(record["written"], serde_json::json!(["numbers", "report"]));
    let resolved = record["scene"].as_str().expect("the scene");
    assert!(resolved.contains("profile_spacing_um = 40.0") && resolved.contains("spacing_mm = 0.7"), "{resolved}");
    assert!(!out.join("pictures").exists() && !out.join("maps").exists());
    // What the terminal says of the work, the page says too.
    let [from, to] = ["dexels  ", " passes each"].map(|words| run.out.rfind(words).expect("a line on dexels"));
    let dexels = run.out[from..to].trim_start_matches("dexels").trim_start();
    let page = std::fs::read_to_string(out.join("report.html")).expect("a page");
    assert!(page.contains(&format!("{dexels} passes each")), "{dexels}");
    assert!(resolved.contains("map_spacing_mm = 0.4"), "{resolved}");
}

mod slow {
    use super::*;

    #[test]
    fn the_same_scene_gives_the_same_bytes_and_prints_its_results() {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("gear");
        let out_text = out.to_str().expect("a path");
        let arguments = [&["cut", ROUND, "--json", "--backend", "cpu", "--out", out_text], &COARSE[..]].concat();
        let outcome = gearcut_on_threads(1, &arguments).done();
        assert_same_files(&WHOLE.files, &files(&out));
        let printed: Value = serde_json::from_str(&outcome.out).expect("JSON on standard output");
        assert_eq!(printed, read_json(&out.join("results.json")));
        for line in outcome.err.lines() {
            let event: Value = serde_json::from_str(line).expect("one JSON event per line");
            assert!(event["event"].is_string());
        }
    }

    #[test]
    fn meshes_pictures_frames_and_surfaces_are_written() {
        let WholeResult { folder, files: written } = &*WHOLE;
        let bytes = |name: &str| &written.iter().find(|(path, _)| path == Path::new(name)).expect(name).1;
        assert!(bytes("mesh/gear.stl").starts_with(b"gearcut, mm: gear of circular_m3_z24 "));
        assert!(bytes("mesh/gear.glb").starts_with(b"glTF\x02\0\0\0"));
        assert_eq!(written.iter().filter(|(path, _)| path.starts_with("mesh/flanks")).count(), 48);
        for name in ["pictures/gear.png", "pictures/mark.png", "frames/frame_0003.png"] {
            let colours: std::collections::BTreeSet<_> = Picture::of(bytes(name)).pixels.into_iter().collect();
            assert!(colours.len() > 50, "{name} shows hardly anything: {} colours", colours.len());
        }
        // An animated PNG says in its acTL chunk how many frames it has.
        let moving = bytes("frames/cut.apng");
        let control = moving.windows(4).position(|chunk| chunk == b"acTL").expect("an animation");
        assert_eq!(moving[control + 4..control + 8], 3_u32.to_be_bytes());
        let gear = folder.path().join("gear");
        let map = gearcut::output::exr_map::read_exr_map(&gear.join("pictures/mark.exr")).expect("an EXR");
        let names: Vec<&str> = map.channels.iter().map(|channel| channel.name.as_str()).collect();
        assert_eq!(names, ["depth_mm", "normal_x", "normal_y", "normal_z", "pass_id", "value"]);
        assert_eq!((map.grid.u.count, map.grid.v.count), (72, 96));
        let gearcut::output::exr_map::Samples::U32(passes) = &map.channels[4].samples else {
            panic!("pass ids are whole")
        };
        assert!(passes.iter().filter(|&&pass| pass != u32::MAX).count() > 3000);
        // What a surface is of goes with it, and so it does in every format that is made of it.
        let window = gear.join("texture/finish/tooth_01_left.x3p");
        for ending in ["x3p", "sdf", "npy", "csv"] {
            let path = folder.path().join(format!("saved.{ending}"));
            let [from, to] = [&window, &path].map(|path| path.to_str().expect("UTF-8"));
            gearcut(&["texture", from, "--save", to]).done();
            let notes = read_surface(&path, None).expect("a surface with its spacing").notes;
            for (name, words) in
                [("frame", "arc length along the target profile"), ("scene", "[gear]"), ("run", "version")]
            {
                let note = notes.iter().find(|note| note.0 == name);
                assert!(note.is_some_and(|note| note.1.contains(words)), "{ending}: {name} is {note:?}");
            }
        }
    }

    /// What is asked for has the bytes that it has in a whole result, and nothing else is there.
    #[test]
    fn parts_that_are_left_out_are_left_out_and_the_rest_keeps_its_bytes() {
        let folder = tempfile::tempdir().expect("a folder");
        let cut = |name: &str, only: &[&str]| {
            let out = folder.path().join(name);
            let arguments = [
                &["cut", ROUND, "--quiet", "--backend", "cpu", "--out", out.to_str().expect("a path")],
                &COARSE[..10],
                only,
            ];
            gearcut(&arguments.concat()).done();
            files(&out)
        };
        let whole = &WHOLE.files;
        let beside = ["results.json", "inspection_charts.csv"];
        let is_number = |path: &Path| path.starts_with("tables") || beside.iter().any(|name| path == Path::new(name));
        let same = |part: &[(PathBuf, Vec<u8>)], belongs: &dyn Fn(&Path) -> bool| {
            let wanted: Vec<_> = whole.iter().filter(|(path, _)| belongs(path)).cloned().collect();
            assert!(wanted.len() > 5, "a whole result holds it");
            let found: Vec<_> = part.iter().filter(|(path, _)| path != Path::new("run.json")).cloned().collect();
            assert_same_files(&wanted, &found);
        };
        same(&cut("numbers", &["--only", "numbers"]), &is_number);
        same(&cut("maps", &["--only", "maps,axes"]), &|path| {
            is_number(path) || ["maps", "allowance", "deviation", "axes"].iter().any(|part| path.starts_with(part))
        });
        same(&cut("pictures", &["--only", "pictures"]), &|path| is_number(path) || path.starts_with("pictures"));
        let record = read_json(&folder.path().join("maps/run.json"));
        assert_eq!(record["written"], serde_json::json!(["numbers", "maps", "axes"]));
        let stages = record["stages"].as_array().expect("stages");
        for stage in ["chips", "cut", "cut the whole blank", "tables and charts", "checksums"] {
            assert!(
                stages.iter().any(|found| found["stage"] == stage && found["wall_s"].is_f64()),
                "{stage}: {stages:?}"
            );
        }
        gearcut(&["cut", ROUND, "--only", "sheets"]).failed(2, &["sheets", "numbers, maps"]);
    }

    /// Of every kind of scene what it finds, and its page.
    #[test]
    fn every_kind_of_scene_is_cut() {
        let folder = tempfile::tempdir().expect("a folder");
        let others = ["built_up_edge", "deflection", "noise", "ploughing", "real_surface"];
        let others = others.map(|name| PathBuf::from(format!("scenes/shaping/{name}.toml")));
        for scene in scenes_of_all_shapes().iter().chain(&others) {
            let scene_text = scene.to_str().expect("a name");
            let out = folder.path().join(scene.file_stem().expect("a stem"));
            let out_text = out.to_str().expect("a path");
            // Fewer strokes than a shop would make: what is found of each is the same.
            let named = std::fs::read_to_string(scene).expect("a scene");
            let operations = [("rough", 500), ("finish", 1500)].into_iter();
            let operations = operations.filter(|(name, _)| named.contains(&format!("name = \"{name}\"")));
            let strokes: Vec<_> = operations
                .map(|(name, strokes)| format!("operation.{name}.strokes_per_revolution={strokes}"))
                .collect();
            let fewer: Vec<_> = strokes.iter().flat_map(|set| ["--set", set]).collect();
            gearcut(&[&["cut", scene_text, "--out", out_text, "--backend", "cpu"], &BRIEF[..], &fewer].concat())
                .done()
                .says(&["smallest normal stock", "flanks cut"]);
            let results = read_json(&out.join("results.json"));
            assert_is_results(&results);
            assert_eq!(results["complete"], true);
            assert_eq!(results["headline"]["undercut_flanks"]["value"], 0, "{scene_text}");
            let record = read_json(&out.join("run.json"));
            let checksums = record["sha256"].as_object().expect("checksums");
            assert_eq!(checksums.len() + 1, files(&out).len(), "all files but the record itself");
            assert!(record["scene"].as_str().expect("the scene").contains("[gear]"));
        }
    }
}
