//! What other programs do with gearcut: two jobs in two threads, one of them ended early; a flank read as slices;
//! findings read; progress watched.

use gearcut::findings::quantities::flanks::SMALLEST_STOCK;
use gearcut::interrupt::Interrupt;
use gearcut::progress::{Event, Progress};
use gearcut::{Error, Job, Parts, Side};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

/// A coarse round gear.
const SCENE: &str = "
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

type Outcome<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;

fn main() -> Outcome<()> {
    let scene = gearcut::parse(SCENE, "round.toml", Path::new(""), &[])?;
    let job = Job::new(scene)?;
    flank(&job)?;
    let other = job.clone();
    let ended = std::thread::spawn(move || ended_early(&other));
    let whole = whole(&job, &std::env::temp_dir().join(format!("gearcut_library_user_{}", std::process::id())));
    ended.join().map_err(|_| "the other thread failed")?;
    whole
}

/// A flank is slices of one shape, [columns, rows], rows fastest: a column is a place along the profile.
fn flank(job: &Job) -> Outcome<()> {
    let flank = job.cut_flank(3, Side::Right)?;
    let finish = flank.operation("finish").ok_or("no operation finishes")?;
    let [columns, rows] = flank.shape();
    let heights_mm: &[f32] = flank.deviations_mm(finish);
    assert_eq!([flank.arcs_mm.len(), flank.face_mm.len(), heights_mm.len()], [columns, rows, columns * rows]);
    // The gear is a spur gear: along a tooth all heights are alike, along a profile strokes leave scallops.
    let column = columns / 2;
    let along_tooth = &heights_mm[column * rows..(column + 1) * rows];
    let along_profile: Vec<f32> = heights_mm.iter().copied().skip(rows / 2).step_by(rows).collect();
    let range = |of: &[f32]| of.iter().copied().fold(f32::MIN, f32::max) - of.iter().copied().fold(f32::MAX, f32::min);
    assert!(range(along_tooth) < 1e-6 && range(&along_profile[columns / 4..3 * columns / 4]) > 1e-5);
    assert_eq!([flank.points_mm().len(), flank.normals().len(), flank.passes(finish).len()], [columns * rows; 3]);
    println!("{columns} x {rows} dexels of tooth 3 right, {:.3} um apart at most", 1e3 * range(&along_profile));
    Ok(())
}

/// A job that ends when its flag is raised.
fn ended_early(job: &Job) {
    let (interrupt, flanks) = (Interrupt::default(), AtomicUsize::new(0));
    let ended = job.cut_flanks(&interrupt, |_| {
        flanks.fetch_add(1, Ordering::Relaxed);
        interrupt.raise();
        Ok(())
    });
    assert!(matches!(ended, Err(Error::Interrupted)), "{ended:?}");
    let flanks = flanks.into_inner();
    assert!(flanks < 48, "the flag came too late");
    println!("ended after {flanks} of 48 flanks");
}

/// A run of the whole job, watched, with its findings.
fn whole(job: &Job, folder: &Path) -> Outcome<()> {
    let finished = Arc::new(Mutex::new(0));
    let of_watcher = Arc::clone(&finished);
    let progress = Progress::watched(move |event| {
        if let Event::StepFinished { done, unit, .. } = event
            && unit == "flanks"
        {
            *of_watcher.lock().expect("no watcher has failed") += done;
        }
    });
    let done = job.run().only(Parts::of([])).show(&progress).into_folder(folder)?;
    assert!(!done.interrupted && *finished.lock().expect("no watcher has failed") == 48);
    for entry in &done.findings.headline {
        assert!(!entry.quantity.definition().is_empty(), "{}", entry.title);
    }
    let stock = done.findings.first(&SMALLEST_STOCK).ok_or("no stock in the headline")?;
    println!("stock {:?} {}", stock.value(), stock.unit().unwrap_or_default());
    for notice in &done.findings.warnings {
        println!("{} {}", notice.severity.name(), notice.id);
    }
    Ok(std::fs::remove_dir_all(folder)?)
}
