//! gearcut as a library: the few items that other programs build on.

use gearcut::Job;
use gearcut::cut::cpu::Cpu;
use gearcut::job::GearJob;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::scene::LoadedScene;
use gearcut::terms::Side;
use std::path::Path;

fn spur() -> LoadedScene {
    let settings = ["gear.face_width_mm=4", "fields.flank.profile_spacing_um=200", "fields.flank.lead_spacing_um=500"];
    gearcut::load(Path::new("scenes/hobbing/circular_spur.toml"), &settings.map(str::to_owned))
        .unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn a_flank_holds_what_the_process_cuts_place_by_place() {
    let scene = spur();
    let flank = Job::new(&scene).expect("a scene that cuts").cut_flank(3, Side::Right).expect("a flank");
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
    let job = Job::new(&scene).expect("a scene that cuts");
    for tooth in [0, scene.scene.gear.teeth + 1] {
        let refused = job.cut_flank(tooth, Side::Left).expect_err("no such tooth").to_string();
        assert!(refused.contains(&format!("tooth {tooth}")), "{refused}");
    }
}
