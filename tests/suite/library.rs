//! gearcut as a library: the few items that other programs build on.

use gearcut::Job;
use gearcut::cut::cpu::Cpu;
use gearcut::interrupt::Interrupt;
use gearcut::job::GearJob;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::progress::{Event, Progress};
use gearcut::scene::LoadedScene;
use gearcut::steps::parts::{Parts, Stages};
use gearcut::terms::Side;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

fn spur() -> LoadedScene {
    let settings = ["gear.face_width_mm=4", "fields.flank.profile_spacing_um=200", "fields.flank.lead_spacing_um=500"];
    gearcut::load(Path::new("scenes/hobbing/circular_spur.toml"), &settings.map(str::to_owned))
        .unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn a_flank_holds_what_the_process_cuts_place_by_place() {
    let scene = spur();
    let flank = Job::new(spur()).expect("a scene that cuts").cut_flank(3, Side::Right).expect("a flank");
    let job = HobbingJob::new(&scene.scene).expect("a scene that cuts");
    let cutter = HobCutter::new(&job).expect("passes");
    let (columns, rows) = (flank.arcs_mm.len(), flank.face_mm.len());
    assert!(columns > 10 && rows == 9, "{columns} columns, {rows} rows");
    // One dexel at a time: a flank that mixes up columns and rows has another surface.
    for (column, row) in [(1, 0), (columns / 2, 3), (columns - 2, 7)] {
        let at = ([flank.arcs_mm[column]], [flank.face_mm[row]]);
        let layers = cutter.cut_flank(&Cpu::default(), 3, Side::Right, &at.0, &at.1).expect("a dexel");
        for (operation, layer) in layers.iter().enumerate() {
            assert_eq!(flank.pass(operation, column, row), Some(layer.passes[0]));
            let alone_um = 1e3 * f64::from(layer.heights_mm[0]);
            let deviation_um = flank.deviation_um(operation, column, row).expect("cut");
            // Newton's method starts elsewhere among other dexels; 0.1 nm is the bound of the native kernel's heights.
            assert!((deviation_um - alone_um).abs() < 1e-4, "{deviation_um} um, {alone_um} um alone");
        }
    }
    let other = [flank.deviation_um(0, 1, 0), flank.deviation_um(0, 0, 1)];
    assert_ne!(other[0], other[1], "the surface tells columns from rows");
}

#[test]
fn a_tooth_that_the_gear_does_not_have_is_refused() {
    let scene = spur();
    let job = Job::new(spur()).expect("a scene that cuts");
    for tooth in [0, scene.scene.gear.teeth + 1] {
        let refused = job.cut_flank(tooth, Side::Left).expect_err("no such tooth").to_string();
        assert!(refused.contains(&format!("tooth {tooth}")), "{refused}");
    }
}

/// A coarse round gear: seconds for all of it.
fn coarse() -> LoadedScene {
    let text = "
        [gear]
        module_mm = 3.0
        teeth = 24
        face_width_mm = 4.0
        [tool.shaper_cutter]
        teeth = 20
        [fields.flank]
        profile_spacing_um = 200.0
        lead_spacing_um = 1000.0
    ";
    gearcut::parse(text, "round.toml", Path::new(""), &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn arrays_of_a_flank_have_one_shape_with_rows_fastest() {
    let flank = Job::new(spur()).expect("a scene that cuts").cut_flank(3, Side::Right).expect("a flank");
    let [columns, rows] = flank.shape();
    let last = flank.operations.len() - 1;
    for (column, row) in [(1, 0), (columns / 2, 3), (columns - 2, rows - 1)] {
        let dexel = column * rows + row;
        let height_mm = f64::from(flank.deviations_mm(last)[dexel]);
        let place_mm = flank.points_mm()[dexel] + height_mm * flank.normals()[dexel];
        let point_mm = flank.point_mm(last, column, row).expect("cut");
        assert!((place_mm - point_mm).length() < 1e-12, "{place_mm} {point_mm}");
        // A spur gear: rows lie along the axis.
        assert!((flank.points_mm()[dexel].z - flank.face_mm[row]).abs() < 1e-12);
        assert_eq!(Some(flank.passes(last)[dexel]), flank.pass(last, column, row));
    }
    assert_eq!(flank.points_mm().len(), columns * rows);
    assert!(flank.stock_mm(last).iter().all(|&stock_mm| stock_mm == 0.0 || stock_mm.is_nan()));
}

#[test]
fn a_flank_at_places_of_the_callers_own_holds_the_same_heights() {
    let job = Job::new(coarse()).expect("a scene that cuts");
    let whole = job.cut_flank(5, Side::Left).expect("a flank");
    let (columns, rows) = ([3, 7, 11], [0, 2]);
    let arcs_mm = columns.map(|column| whole.arcs_mm[column]);
    let own = job.cut_flank_at(5, Side::Left, &arcs_mm, &rows.map(|row| whole.face_mm[row])).expect("a flank");
    assert_eq!(own.shape(), [3, 2]);
    for (i, column) in columns.into_iter().enumerate() {
        for (k, row) in rows.into_iter().enumerate() {
            let [here, there] =
                [(&own, own.dexel(i, k)), (&whole, whole.dexel(column, row))].map(|(of, at)| of.deviations_mm(1)[at]);
            // Newton's method starts elsewhere among other dexels; 0.1 nm is the bound of the native kernel's heights.
            assert!((here - there).abs() < 1e-7, "{here} mm, {there} mm");
        }
    }
    let length_mm = whole.arcs_mm[whole.arcs_mm.len() - 1];
    for (arcs_mm, words) in
        [(&[0.5, 0.2][..], "increase"), (&[0.0, 1.01 * length_mm], "beside"), (&[f64::NAN], "beside")]
    {
        let refused = job.cut_flank_at(5, Side::Left, arcs_mm, &[0.0]).expect_err("bad places").to_string();
        assert!(refused.contains(words), "{refused}");
    }
}

/// What a page draws of a round gear lies where its drawing says: tips, roots, pitch circle, and the cutter's axis.
#[test]
fn a_planar_view_is_the_drawing_of_a_round_gear() {
    let job = Job::new(coarse()).expect("a scene that cuts");
    let view = job.planar_view(0.01).expect("a gear with sections");
    let [lowest, highest] = [f64::INFINITY, 0.0];
    let ends = |points: &[glam::DVec2]| {
        points.iter().fold([lowest, highest], |[low, high], p| [low.min(p.length()), high.max(p.length())])
    };
    let near = |found: [f64; 2], expected: [f64; 2], mm: f64| {
        let off = [found[0] - expected[0], found[1] - expected[1]];
        assert!(off.iter().all(|off| off.abs() < mm), "{found:?} mm, {expected:?} expected");
    };
    near(ends(&view.pitch_mm), [36.0; 2], 1e-9);
    near(ends(&view.stock_mm), [39.0; 2], 1e-9);
    // The cutter has an addendum of 1.25 modules, and roots lie where its tips end.
    near(ends(&view.gear_mm), [36.0 - 3.75, 39.0], 1e-3);
    near(ends(&view.tool_mm), [30.0 - 3.75, 33.75], 1e-3);
    let (_, last_mm) = view.strokes[view.strokes.len() - 1];
    near([last_mm.length(); 2], [66.0; 2], 1e-9);
    let turns: f64 = view.strokes[view.strokes.len() - 2..].windows(2).map(|two| two[1].0 - two[0].0).sum();
    let angle = view.strokes[view.strokes.len() - 2].1.angle_to(last_mm);
    // In the gear's frame the cutter rolls round: its axis goes on by an angle, and it turns by that and z / z_c of it.
    let rolls = (turns / angle - (1.0 + 24.0 / 20.0)).abs();
    assert!(rolls < 1e-6, "{turns} rad while its axis goes on by {angle}");
}

/// A run that keeps no file finds what one with a folder finds.
#[test]
fn findings_are_those_of_a_run_with_a_folder() {
    let job = Job::new(coarse()).expect("a scene that cuts");
    let folder = tempfile::tempdir().expect("a folder");
    let written = job.run().only(Parts::of([])).into_folder(&folder.path().join("run")).expect("a run").findings;
    let found = job.run().found().expect("findings");
    assert_eq!(found.to_json(), written.to_json());
}

#[test]
fn notices_and_charts_come_without_a_folder() {
    let job = Job::new(spur()).expect("a scene that cuts");
    let mut sheet = gearcut::output::text::Sheet::default();
    let all = job.foreseen().expect("notices");
    assert_eq!(all, job.check(&mut sheet).expect("notices"));
    let undercut = "gear.teeth=10".to_owned();
    let few = Job::new(coarse().with_settings(&[undercut], gearcut::key_table()).expect("a scene")).expect("it cuts");
    let (all, some) = (few.foreseen().expect("notices"), few.foreseen_of_shapes().expect("notices"));
    assert!(some.iter().any(|notice| notice.id == "flank.undercut"), "{some:?}");
    assert!(some.len() < all.len() && some.iter().all(|notice| all.contains(notice)), "{some:?} of {all:?}");
    let charts = job.axis_charts().expect("charts");
    assert!(!charts.is_empty() && charts.iter().all(|(name, svg)| !name.is_empty() && svg.starts_with("<svg")));
}

#[test]
fn a_job_is_shared_by_threads_and_ends_when_its_flag_is_raised() {
    let job = Job::new(coarse()).expect("a scene that cuts");
    let alone = job.cut_flank(2, Side::Left).expect("a flank");
    let other = job.clone();
    let thread = std::thread::spawn(move || other.cut_flank(2, Side::Left).expect("a flank"));
    let met = Mutex::new(Vec::new());
    job.cut_flanks(&Interrupt::default(), |flank| {
        met.lock().expect("no thread has failed").push((flank.tooth, flank.side.name()));
        Ok(())
    })
    .expect("all flanks");
    let mut met = met.into_inner().expect("no thread has failed");
    met.sort_unstable();
    let all: Vec<_> = (1..=24).flat_map(|tooth| ["left", "right"].map(|side| (tooth, side))).collect();
    assert_eq!(met, all);
    let same = thread.join().expect("the thread ends");
    assert_eq!(same.deviations_mm(1), alone.deviations_mm(1));

    let (interrupt, count) = (Interrupt::default(), AtomicUsize::new(0));
    let ended = job.cut_flanks(&interrupt, |_| {
        count.fetch_add(1, Ordering::Relaxed);
        interrupt.raise();
        Ok(())
    });
    assert!(matches!(ended, Err(gearcut::Error::Interrupted)), "{ended:?}");
    assert!(count.into_inner() < 48, "the flag came too late");
}

#[test]
fn a_run_is_watched_event_by_event() {
    let job = Job::new(coarse()).expect("a scene that cuts");
    let seen = Arc::new(Mutex::new(Vec::new()));
    let of_watcher = Arc::clone(&seen);
    let progress = Progress::watched(move |event| of_watcher.lock().expect("no thread has failed").push(event.clone()));
    let folder = tempfile::tempdir().expect("a folder");
    job.run().only(Parts::of([])).show(&progress).into_folder(&folder.path().join("gear")).expect("numbers");
    let seen = seen.lock().expect("no thread has failed");
    let cut =
        |event: &&Event| matches!(event, Event::StepFinished { done: 48, total: 48, unit, .. } if unit == "flanks");
    assert_eq!(seen.iter().filter(cut).count(), 1, "{seen:?}");
}

/// What the page in the browser reads of the findings is among what it has measured: keys that it reads after a point
/// whose measurement it leaves out.
fn unmeasured(page: &str, paths: &[String]) -> Vec<String> {
    let stages = Stages::of_paths(paths);
    let is_key = |c: char| c.is_ascii_lowercase() || c == '_';
    let keys = page.split('.').skip(1).map(|after| after.split(|c| !is_key(c)).next().unwrap_or_default());
    keys.filter(|key| !key.is_empty() && !stages.find(key)).map(str::to_owned).collect()
}

#[test]
fn the_page_has_measured_what_it_reads() {
    let page = std::fs::read_to_string("web/page/page.js").expect("the page");
    let list = page.split_once("paths: [").and_then(|(_, after)| after.split_once(']')).expect("its wishes").0;
    let paths: Vec<String> = list.split(',').map(|path| path.trim().trim_matches('"').to_owned()).collect();
    assert!(unmeasured(&page, &paths).is_empty(), "{:?}", unmeasured(&page, &paths));
    // Planted: without allowances their table and the captions of both linkages are empty.
    let fewer: Vec<String> = paths.iter().filter(|path| *path != "allowance").cloned().collect();
    let missing = unmeasured(&page, &fewer);
    assert!(["allowance", "unevenness_max", "unevenness_mean"].iter().all(|key| missing.iter().any(|m| m == key)));
}
