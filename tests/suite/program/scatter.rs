//! `gearcut scatter`: rows that a stop does not take, equal bytes on any number of threads, refusals.

use crate::fixtures::command::{gearcut, gearcut_on_threads};
use std::fs;
use std::path::Path;
#[cfg(unix)]
use std::process::{Command, Stdio};
#[cfg(unix)]
use std::time::{Duration, Instant};

const SCENE: [&str; 7] = [
    "scatter",
    "scenes/shaping/noise.toml",
    "--quiet",
    "--set",
    "operation.finish.strokes_per_revolution=480",
    "--set",
    "operation.rough.strokes_per_revolution=240",
];

fn scatter(out: &Path, threads: u32, more: &[&str]) -> (i32, String) {
    let out = out.to_str().expect("a path");
    let done = gearcut_on_threads(threads, &[&SCENE[..], &["--out", out], more].concat());
    (done.code, done.out + &done.err)
}

fn read(out: &Path, name: &str) -> String {
    fs::read_to_string(out.join(name)).expect("a file")
}

#[test]
fn gears_scatter_alike_on_any_number_of_threads_and_after_a_stop() {
    let folder = tempfile::tempdir().expect("a folder");
    let (whole, stopped) = (folder.path().join("whole"), folder.path().join("stopped"));
    let (code, said) = scatter(&whole, 1, &["--seeds", "4"]);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("noise alone") && said.contains("all but edge") && said.contains("4 gears"), "{said}");
    assert_eq!(scatter(&stopped, 2, &["--seeds", "2"]).0, 0);
    let rows = read(&stopped, "seeds.csv");
    assert_eq!(rows.lines().count(), 3);
    // As a kill leaves it: a line without its end.
    fs::write(stopped.join("seeds.csv"), rows.clone() + "3,0.1,0.2").expect("written");
    assert_eq!(scatter(&stopped, 2, &["--seeds", "4"]).0, 0);
    for name in
        ["seeds.csv", "layers.csv", "scatter.csv", "run.json", "results.json", "report.html", "pictures/scatter.svg"]
    {
        assert_eq!(read(&whole, name), read(&stopped, name), "{name}");
    }
    assert!(read(&whole, "seeds.csv").starts_with(&rows));
    let values = |line: &str| line.split(',').skip(1).map(str::to_owned).collect::<Vec<_>>();
    let seeds: Vec<Vec<String>> = read(&whole, "seeds.csv").lines().skip(1).map(values).collect();
    assert!(seeds.iter().all(|row| row.iter().all(|value| value.parse::<f64>().is_ok_and(f64::is_finite))));
    assert!(seeds[0] != seeds[1] && seeds[1] != seeds[2]);
    // Layers are cut with the scene's own seed, which is the first.
    let all = read(&whole, "layers.csv").lines().find(|line| line.starts_with("all,")).map(values);
    assert_eq!(all.as_ref(), seeds.first());
    // Sa is the first number: of four gears its median is the mean of the two in the middle.
    let mut sa: Vec<f64> = seeds.iter().map(|row| row[0].parse().expect("a number")).collect();
    sa.sort_by(f64::total_cmp);
    let scatter_csv = read(&whole, "scatter.csv");
    let median = scatter_csv.lines().find_map(|line| line.strip_prefix("50.0,")).expect("a row of medians");
    let median: f64 = median.split(',').next().and_then(|sa| sa.parse().ok()).expect("a number");
    assert!((median - 0.5 * (sa[1] + sa[2])).abs() < 1e-12 * median, "{median} of {sa:?}");
    let results: serde_json::Value = serde_json::from_str(&read(&whole, "results.json")).expect("JSON");
    assert_eq!(results["headline"]["Sa"]["value"].as_f64(), Some(median));
    let report = read(&whole, "report.html");
    assert!(report.contains("all but it") && report.contains("every dot is a seed"));
    // The work spindle's noise goes on within a stroke: no gear of the four has a straight helix, and no two the same.
    let heads: Vec<String> = read(&whole, "seeds.csv").lines().next().map(values).expect("heads");
    for key in ["F_beta", "f_H_beta"] {
        let column = heads.iter().position(|head| head.starts_with(key)).expect("a column");
        let mut sizes: Vec<f64> = seeds.iter().map(|row| row[column].parse::<f64>().expect("a number").abs()).collect();
        sizes.sort_by(f64::total_cmp);
        sizes.dedup();
        assert!(sizes.len() == 4 && sizes[0] > 1e-4, "{key}: {sizes:?}");
    }
    assert_eq!(report.matches("<circle").count(), 10 * 4, "a dot for each gear and number");
    // Another scene does not go into the same folder, nor does another command's.
    let (code, said) = scatter(&whole, 1, &["--seeds", "4", "--tooth", "2"]);
    assert!(code == 1 && said.contains("another scene, flank or version"), "{said}");
    fs::write(whole.join("run.json"), "{\"program\": \"gearcut\", \"command\": \"pair\"}").expect("written");
    let (code, said) = scatter(&whole, 1, &["--seeds", "4"]);
    assert!(code == 1 && said.contains("another command"), "{said}");
}

/// A gear that is cut true and turns off its axis has deviations e sin(phi) along its normals, and e sin(phi) / cos(a)
/// along the pitch circle, a the pressure angle there, 20 deg. F_p is 2 e / cos(a) but for the teeth's distance from
/// the extremes, at most half a pitch of 15 deg each.
#[test]
fn gears_within_a_tolerance_have_the_pitch_deviations_of_their_eccentricities() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("gears");
    let path = out.to_str().expect("a path");
    let tolerance = ["--tolerance", "mounting.eccentricity_um=4..20"];
    let scene = ["scatter", "scenes/shaping/circular_m3_z24.toml", "--quiet", "--seeds", "3", "--out", path];
    let strokes = ["--set", "operation.finish.strokes_per_revolution=960"];
    let said = gearcut(&[&scene[..], &strokes, &tolerance].concat()).done().out;
    assert!(said.contains("3 gears"), "{said}");
    let drawn = read(&out, "drawn.csv");
    let drawn: Vec<Vec<&str>> = drawn.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let seeds = read(&out, "seeds.csv");
    let place = seeds.lines().next().expect("heads").split(',').position(|head| head.starts_with("F_p")).expect("F_p");
    assert_eq!(drawn.len(), 3);
    for (drawn, row) in drawn.iter().zip(seeds.lines().skip(1)) {
        let row: Vec<&str> = row.split(',').collect();
        assert_eq!((drawn[0], drawn[1]), (row[0], "mounting.eccentricity_um"));
        let number = |text: &str| text.parse::<f64>().expect("a number");
        let (eccentricity_um, found_um) = (number(drawn[2]), number(row[place]));
        assert!((4.0..=20.0).contains(&eccentricity_um));
        let share = found_um / (2.0 * eccentricity_um / 20_f64.to_radians().cos());
        println!("{eccentricity_um} um: F_p {found_um} um, {share} of the closed form");
        assert!(share > 7.5_f64.to_radians().cos() - 0.002 && share < 1.002, "{share}");
    }
    assert!(drawn[0][2] != drawn[1][2] && drawn[1][2] != drawn[2][2]);
    let report = read(&out, "report.html");
    assert!(report.contains("mounting.eccentricity_um from 4 to 20"));
    // Other limits do not go into the same folder, and limits that make no gear are refused before any is cut.
    let other = ["--tolerance", "mounting.eccentricity_um=4..21"];
    gearcut(&[&scene[..], &strokes, &other].concat()).failed(1, &["another scene, flank or version"]);
    for wrong in ["mounting.eccentric=0..1", "gear.module_mm=-1..2", "gear.teeth=1"] {
        let outcome = gearcut(&[&scene[..], &strokes, &["--tolerance", wrong]].concat());
        assert!(outcome.code == 1 || outcome.code == 2, "{wrong}: {}", outcome.err);
    }
    let twice = [&scene[..], &strokes, &tolerance, &tolerance].concat();
    gearcut(&twice).failed(1, &["mounting.eccentricity_um", "two tolerances"]);
}

#[test]
fn noise_that_strokes_do_not_follow_is_warned_of() {
    let folder = tempfile::tempdir().expect("a folder");
    let said = |name: &str, bandwidth: &str| {
        let bandwidth = format!("machine.errors.work.noise_bandwidth_hz={bandwidth}");
        let (code, said) = scatter(&folder.path().join(name), 2, &["--seeds", "0", "--set", &bandwidth]);
        assert_eq!(code, 0, "{said}");
        said
    };
    let warning = "noise of the work spindle up to 50.0 Hz is faster than strokes follow";
    assert_eq!(said("fast", "50").matches(warning).count(), 2, "both operations");
    assert!(!said("slow", "0.05").contains("faster than strokes follow"));
}

#[test]
fn scenes_without_errors_and_teeth_that_are_not_there_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("none");
    let sound = gearcut(&["scatter", "scenes/shaping/circular_m3_z24.toml", "--out", out.to_str().expect("a path")]);
    assert!(sound.code == 1 && sound.err.contains("no errors"), "{}", sound.err);
    let (code, said) = scatter(&out, 1, &["--tooth", "25"]);
    assert!(code == 1 && said.contains("the gear has 24"), "{said}");
}

/// Starts a run of many gears, waits for some of them, does something, and ends it by a signal; gives its exit code, if
/// it has one.
#[cfg(unix)]
fn ended_by(signal: &str, out: &Path, meanwhile: impl FnOnce()) -> Option<i32> {
    let mut child = Command::new(env!("CARGO_BIN_EXE_gearcut"))
        .args([&SCENE[..], &["--out", out.to_str().expect("a path"), "--seeds", "1000"]].concat())
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stderr(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .expect("started");
    let started = Instant::now();
    let rows = || fs::read_to_string(out.join("seeds.csv")).map_or(0, |text| text.lines().count());
    while rows() < 4 {
        assert!(started.elapsed() < Duration::from_secs(300), "no gears in five minutes");
        std::thread::sleep(Duration::from_millis(50));
    }
    meanwhile();
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().expect("a signal").success());
    child.wait().expect("ended").code()
}

#[cfg(unix)]
#[test]
fn what_is_finished_outlives_ctrl_c_and_a_kill() {
    let folder = tempfile::tempdir().expect("a folder");
    let (whole, stopped) = (folder.path().join("whole"), folder.path().join("stopped"));
    // A second run to the same folder is refused, and leaves the first one and its rows alone.
    let second = || {
        let (code, said) = scatter(&stopped, 1, &["--seeds", "2"]);
        assert!(code == 1 && said.contains("another run of gearcut (process"), "{said}");
        assert!(read(&stopped, "seeds.csv").lines().count() >= 4);
    };
    assert_eq!(ended_by("-INT", &stopped, second), Some(130));
    let kept = read(&stopped, "seeds.csv").lines().count();
    assert!(kept >= 4, "{kept} lines");
    assert_eq!(ended_by("-KILL", &stopped, || ()), None, "killed");
    assert!(read(&stopped, "seeds.csv").lines().count() >= kept);
    assert!(read(&stopped, "run.json").contains("\"complete\": false"));
    assert!(!stopped.join("scatter.csv").exists(), "nothing is told of gears that are not there");
    let seeds = ["--seeds", "3"];
    assert_eq!(scatter(&stopped, 2, &seeds).0, 0);
    assert_eq!(scatter(&whole, 2, &seeds).0, 0);
    assert_eq!(read(&whole, "scatter.csv"), read(&stopped, "scatter.csv"));
}
