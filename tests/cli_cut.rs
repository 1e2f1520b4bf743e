//! `gearcut cut` from the outside: what it writes, that the same scene gives the same bytes, and that nothing is lost when it is stopped.

#[path = "common/command.rs"]
mod command;

use command::gearcut;
use gearcut::output::surface_files::read_surface;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const PAPER: &str = "scenes/shaping/elliptical_normal.toml";
const COARSE: [&str; 10] = [
    "--set",
    "fields.flank.profile_spacing_um=50",
    "--set",
    "fields.flank.lead_spacing_um=5000",
    "--set",
    "fields.chips.spacing_mm=0.2",
    "--set",
    "fields.blank.spacing_mm=0.5",
    "--set",
    "picture=[]",
];

fn read_json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON")
}

/// Files below a folder with their bytes, `run.json` (which holds times) left out.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(&next).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else if path.file_name().is_some_and(|name| name != "run.json") {
                let bytes = std::fs::read(&path).expect("a file");
                found.push((path.strip_prefix(folder).expect("inside").to_owned(), bytes));
            }
        }
    }
    found.sort();
    found
}

#[test]
fn every_shipped_scene_is_cut_and_the_same_scene_gives_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut scenes: Vec<PathBuf> = std::fs::read_dir("scenes/shaping")
        .expect("scenes")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    scenes.sort();
    assert!(scenes.len() >= 8);
    for scene in &scenes {
        let scene_text = scene.to_str().expect("a name");
        let out = folder.path().join(scene.file_stem().expect("a stem"));
        let out_text = out.to_str().expect("a path");
        gearcut(&[&["cut", scene_text, "--out", out_text, "--backend", "cpu"], &COARSE[..]].concat())
            .done()
            .says(&["smallest normal stock", "flanks cut"]);
        let results = read_json(&out.join("results.json"));
        assert_eq!(results["complete"], true);
        assert_eq!(results["headline"]["undercut_flanks"]["value"], 0, "{scene_text}");
        let record = read_json(&out.join("run.json"));
        let checksums = record["sha256"].as_object().expect("checksums");
        assert_eq!(checksums.len(), files(&out).len());
        assert!(record["scene"].as_str().expect("the scene").contains("[gear]"));
    }
    // What a surface is of goes with it in every format.
    for ending in ["x3p", "sdf", "npy", "csv"] {
        let path = folder.path().join(format!("elliptical_normal/texture/finish/tooth_03_left.{ending}"));
        let notes = read_surface(&path, None).expect("a surface with its spacing").notes;
        for (name, words) in [("frame", "arc length along the target profile"), ("scene", "[gear]"), ("run", "version")]
        {
            let note = notes.iter().find(|note| note.0 == name);
            assert!(note.is_some_and(|note| note.1.contains(words)), "{ending}: {name} is {note:?}");
        }
    }
    let again = folder.path().join("again");
    let text = again.to_str().expect("a path");
    gearcut(&[&["cut", PAPER, "--out", text, "--quiet", "--backend", "cpu"], &COARSE[..]].concat()).done();
    assert!(files(&again) == files(&folder.path().join("elliptical_normal")), "the same scene gave other bytes");
}

#[test]
fn json_prints_the_results() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("gear");
    let arguments = [
        &["cut", "scenes/shaping/circular_m3_z24.toml", "--json", "--out"],
        &[out.to_str().expect("a path")][..],
        &COARSE[..],
    ];
    let outcome = gearcut(&arguments.concat()).done();
    let printed: Value = serde_json::from_str(&outcome.out).expect("JSON on standard output");
    assert_eq!(printed, read_json(&out.join("results.json")));
    for line in outcome.err.lines() {
        let event: Value = serde_json::from_str(line).expect("one JSON event per line");
        assert!(event["event"].is_string());
    }
}

/// Starts a long run and waits until its first maps stand in the temporary folder.
#[cfg(unix)]
#[expect(clippy::zombie_processes, reason = "every test waits for the child it is given; a panic ends the test anyway")]
fn started(parent: &Path) -> (std::process::Child, PathBuf) {
    let out = parent.join("gear");
    let child = Command::new(env!("CARGO_BIN_EXE_gearcut"))
        .args(["cut", PAPER, "--backend", "cpu", "--set", "fields.flank.lead_spacing_um=20", "--out"])
        .arg(&out)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    for _ in 0..6000 {
        let maps = std::fs::read_dir(parent).expect("the folder").flatten().map(|e| e.path().join("allowance"));
        if maps.filter_map(|path| std::fs::read_dir(path).ok()).any(|mut files| files.next().is_some()) {
            return (child, out);
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    panic!("no map appeared in two minutes");
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_the_finished_flanks() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut child, out) = started(folder.path());
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(kill.success());
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    let results = read_json(&out.join("results.json"));
    assert_eq!(results["complete"], false);
    let maps = std::fs::read_dir(out.join("allowance")).expect("maps").count();
    assert!(maps >= 2, "the finished flanks' maps are there");
    assert!(results["headline"]["smallest_normal_stock"]["value"].is_number());
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 1, "nothing temporary is left");
}

#[cfg(unix)]
#[test]
fn a_killed_run_leaves_nothing_under_the_final_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut child, out) = started(folder.path());
    child.kill().expect("killed");
    child.wait().expect("an end");
    assert!(!out.exists());
}

#[test]
fn meshes_pictures_and_frames_are_written_and_are_the_same_every_time() {
    let folder = tempfile::tempdir().expect("a folder");
    let small = "picture=[{name='gear',width_px=96,height_px=72},{name='mark',view='flank',tooth=3,side='right',\
                 colour='pass',width_px=96,height_px=72,exr=true}]";
    let cut = |name: &str| {
        let out = folder.path().join(name);
        let arguments = [
            &["cut", "scenes/shaping/circular_m3_z24.toml", "--quiet", "--backend", "cpu", "--frames", "3", "--out"],
            &[out.to_str().expect("a path")][..],
            &COARSE[..4],
            &["--set", small],
        ];
        gearcut(&arguments.concat()).done();
        files(&out)
    };
    let written = cut("a");
    assert!(written == cut("b"), "the same scene gave other bytes");
    let bytes = |name: &str| &written.iter().find(|(path, _)| path == Path::new(name)).expect(name).1;
    assert!(bytes("mesh/gear.stl").starts_with(b"gearcut, mm: gear of circular_m3_z24 "));
    assert!(bytes("mesh/gear.glb").starts_with(b"glTF\x02\0\0\0"));
    assert_eq!(written.iter().filter(|(path, _)| path.starts_with("mesh/flanks")).count(), 48);
    for name in ["pictures/gear.png", "pictures/mark.png", "frames/frame_0003.png"] {
        let picture = image::load_from_memory(bytes(name)).expect("a PNG").into_rgb8();
        let colours: std::collections::BTreeSet<_> = picture.pixels().map(|p| p.0).collect();
        assert!(colours.len() > 50, "{name} shows hardly anything: {} colours", colours.len());
    }
    // An animated PNG says in its acTL chunk how many frames it has.
    let moving = bytes("frames/cut.apng");
    let control = moving.windows(4).position(|chunk| chunk == b"acTL").expect("an animation");
    assert_eq!(moving[control + 4..control + 8], 3_u32.to_be_bytes());
    let map = gearcut::output::exr_map::read_exr_map(&folder.path().join("a/pictures/mark.exr")).expect("an EXR");
    let names: Vec<&str> = map.channels.iter().map(|channel| channel.name.as_str()).collect();
    assert_eq!(names, ["depth_mm", "normal_x", "normal_y", "normal_z", "pass_id", "value"]);
    assert_eq!((map.grid.u.count, map.grid.v.count), (72, 96));
    let gearcut::output::exr_map::Samples::U32(passes) = &map.channels[4].samples else { panic!("pass ids are whole") };
    assert!(passes.iter().filter(|&&pass| pass != u32::MAX).count() > 3000);
}
