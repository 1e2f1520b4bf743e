//! Frames of hobbing: the hob's teeth in the section against a closed form of their own, the section pass by pass
//! against all passes at once, the page's hob, and the files of a run.

use crate::fixtures::command::gearcut;
use gearcut::cut::cpu::Cpu;
use gearcut::process::hobbing::cut_section::HobbedSection;
use gearcut::process::hobbing::report::passes::passes;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::steps::frames::section::SectionByStep;
use gearcut::tool::{CuttingTool, SpatialTool};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use std::path::Path;

const SCENE: &str = "scenes/hobbing/circular_spur.toml";
/// Few teeth and coarse rays.
const SMALL: [&str; 4] = [
    "gear.teeth=16",
    "operation.finish.axial_feed_mm_per_revolution=6",
    "tool.hob.length_mm=40",
    "fields.blank.spacing_mm=0.4",
];

/// A helical gear in two operations, radial approach, a hob of two starts with helical gashes.
const HELICAL: &str = "scenes/hobbing/circular_helical.toml";
const SMALL_HELICAL: [&str; 5] = [
    "gear.teeth=15",
    "operation.rough.axial_feed_mm_per_revolution=8",
    "operation.rough.radial_feed_mm_per_revolution=3",
    "operation.finish.axial_feed_mm_per_revolution=8",
    "fields.blank.spacing_mm=0.4",
];

fn job(scene: &str, settings: &[&str]) -> HobbingJob {
    let settings: Vec<String> = settings.iter().map(|&s| s.to_owned()).collect();
    let loaded = gearcut::process::load(Path::new(scene), &settings).unwrap_or_else(|e| panic!("{e}"));
    HobbingJob::new(&loaded.scene).expect("a gear")
}

/// Distance of a point from a closed polygon, mm.
fn off_mm(polygon: &[DVec2], at: DVec2) -> f64 {
    let sides = (0..polygon.len()).map(|i| [polygon[i], polygon[(i + 1) % polygon.len()]]);
    let off = |[a, b]: [DVec2; 2]| {
        let along = b - a;
        let share = ((at - a).dot(along) / along.length_squared().max(1e-30)).clamp(0.0, 1.0);
        at.distance(a + share * along)
    };
    sides.map(off).fold(f64::INFINITY, f64::min)
}

/// Where a point of a tooth's edge (distance from the hob's axis, place along it) goes through the middle of the face,
/// from nothing but the numbers of the scene: a right-hand hob of one start and 80 mm, module 3, whose axis leans by
/// its lead angle; a spur gear that turns by 1 / 16 of it; the slide's place in proportion to that. Machine: x along
/// the rack, y out of the gear, z against the gear's.
fn in_gear(hob_rad: f64, passage: f64, [rho_mm, y_mm]: [f64; 2], slide_mm: impl Fn(f64) -> f64) -> DVec2 {
    let (teeth, gashes, module_mm, pitch_mm) = (16.0, 12.0, 3.0, 40.0);
    let lead_rad = (module_mm / 80.0_f64).asin();
    let head_rad = -lead_rad;
    let axial_mm = -TAU * 0.5 * module_mm / lead_rad.cos() * passage / gashes - y_mm;
    let angle = |turned_rad: f64| {
        let behind_mm = slide_mm(turned_rad / teeth) + axial_mm * head_rad.sin();
        (behind_mm / (rho_mm * head_rad.cos())).asin()
    };
    // The slide hardly moves while a tooth goes through the work: the angle converges by itself.
    let swept_rad = (0..8).fold(0.0, |swept, _| angle(hob_rad + swept));
    let x_mm = rho_mm * head_rad.sin() * swept_rad.sin() + axial_mm * head_rad.cos();
    let out_mm = 0.5 * module_mm * teeth + pitch_mm - rho_mm * swept_rad.cos();
    let turned = DVec2::from_angle((hob_rad + swept_rad) / teeth);
    out_mm * turned + x_mm * turned.perp()
}

/// The teeth of the gash that points to the work, at passes from the first to the last.
#[test]
fn teeth_are_drawn_where_they_go_through_the_section() {
    let job = job(SCENE, &SMALL);
    let cutter = HobCutter::new(&job).expect("passes");
    let section = HobbedSection::new(&cutter).expect("a section");
    let linkage = &job.operations[0].linkage;
    let [first_mm, last_mm] = [0.0, linkage.end_s()].map(|time_s| linkage.axes::<1>(time_s).slide_mm.value());
    let slide_mm = |work_rad: f64| first_mm + (last_mm - first_mm).signum() * 6.0 * work_rad / TAU;
    let (mut worst_mm, mut drawn) = (0.0_f64, 0);
    for share in 0..=6 {
        let step = (section.steps() - 1) * share / 6;
        let (_, pass) = section.pass(step);
        let parts = section.tool_mm(step).expect("teeth");
        let turn = (pass.tool_angle_rad / TAU).floor();
        let gash = ((pass.tool_angle_rad / TAU - turn) * 12.0).round();
        // Teeth of this gash along the hob, an axial pitch apart.
        let row = (-4..=4).map(|pitch| gash + 12.0 * f64::from(pitch));
        let row: Vec<f64> =
            row.filter(|passage| job.hob.teeth.iter().any(|of| of.passage as f64 == *passage)).collect();
        assert_eq!(parts.len(), row.len(), "step {step}");
        drawn += parts.len();
        for passage in row {
            for at in job.hob.edge_of(0).points_mm(0.01) {
                let wanted_mm = in_gear(pass.tool_angle_rad, passage, at.to_array(), slide_mm);
                let nearest_mm = parts.iter().map(|part| off_mm(&part[0], wanted_mm)).fold(f64::INFINITY, f64::min);
                worst_mm = worst_mm.max(nearest_mm);
            }
        }
    }
    println!("{drawn} teeth, {worst_mm:e} mm off");
    assert!(drawn > 20 && worst_mm < 2e-6, "{drawn} teeth, {worst_mm} mm off");
}

/// No pass is left out between frames, nor between operations: pass by pass leaves what all at once leave.
#[test]
fn frames_leave_what_all_passes_leave() {
    for (scene, settings, operations) in [(SCENE, &SMALL[..], 1), (HELICAL, &SMALL_HELICAL, 2)] {
        let job = job(scene, settings);
        let cutter = HobCutter::new(&job).expect("passes");
        let mut section = HobbedSection::new(&cutter).expect("a section");
        let whole = section.field().clone();
        let steps = section.steps();
        let areas_mm2 = [0, steps / 5, steps / 2, steps].map(|until| {
            section.advance(until).expect("cuts");
            section.field().areas_mm2()[0][0]
        });
        println!("{scene}: {steps} passes, {areas_mm2:?} mm2, {}", section.title(steps));
        assert!(areas_mm2.windows(2).all(|pair| pair[0] > pair[1]), "{areas_mm2:?}");
        let at_once = cutter.cut_blank(&Cpu::default(), whole, &|| true).expect("cuts").expect("not stopped");
        assert_eq!(section.field().areas_mm2(), at_once.cut.field.areas_mm2());
        assert_eq!(cutter.operations.len(), operations);
        let [first, last] = [0, steps].map(|until| section.title(until));
        assert!(first.contains(": pass 0 of ") && last.starts_with("finish: pass "), "{first}, {last}");
    }
}

/// The page's hob at every pass that takes something: all chips are the blank's, and the tip of the tooth that takes it
/// is as far from the gear's axis as the numbers of the scene say when it points to the work.
#[test]
fn the_pages_hob_points_its_taking_tooth_to_the_work() {
    let job = job(SCENE, &SMALL);
    let cutter = HobCutter::new(&job).expect("passes");
    let field = job.blank_field().expect("rays");
    let blank = cutter.cut_blank(&Cpu::default(), field, &|| true).expect("cuts").expect("not stopped");
    let page = passes(&cutter, &blank).expect("fits in memory");
    let cut = &blank.cut;
    let removed_mm3: f64 = cut.blank_mm3.iter().zip(&cut.left_mm3[0]).map(|(before, after)| before - after).sum();
    let taken_mm3: f64 = page.strokes.iter().map(|stroke| stroke.taken[0]).sum();
    println!("{} passes take {taken_mm3} mm^3", page.strokes.len());
    assert!((taken_mm3 / (0.5 * removed_mm3) - 1.0).abs() < 1e-9);
    let lead_rad = (3.0 / 80.0_f64).asin();
    for stroke in page.strokes.iter().step_by(7) {
        let tooth = stroke.taken[3] as u32;
        let tip_mm = job.hob.tip_radius_mm;
        let at = stroke.gear_from_tool.after(&job.hob.tool_from_blade(tooth)).point(DVec3::new(tip_mm, 0.0, 0.0));
        let along_mm = TAU * 1.5 / lead_rad.cos() * job.hob.teeth[tooth as usize].passage as f64 / 12.0;
        let wanted_mm = (24.0 + 40.0 - tip_mm).hypot(along_mm * lead_rad.cos());
        assert!((at.truncate().length() - wanted_mm).abs() < 1e-6, "{stroke:?}: {wanted_mm} mm");
    }
}

#[test]
fn a_run_writes_as_many_frames_as_are_asked_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let arguments = ["cut", SCENE, "--draft", "--frames", "2", "--out", out.to_str().expect("a path")];
    gearcut(&arguments.into_iter().chain(SMALL.iter().flat_map(|set| ["--set", set])).collect::<Vec<_>>()).done();
    let mut names: Vec<String> = std::fs::read_dir(out.join("frames"))
        .expect("frames")
        .map(|entry| entry.expect("a file").file_name().into_string().expect("a name"))
        .collect();
    names.sort();
    assert_eq!(names, ["cut.apng", "frame_0001.png", "frame_0002.png"]);
    let bytes = std::fs::read(out.join("frames/cut.apng")).expect("an animation");
    let control = bytes.windows(4).position(|word| word == b"acTL").expect("animated");
    assert_eq!(bytes[control + 4..control + 8], [0, 0, 0, 2]);
}
