//! Meshes of cut gears: closed, free of crossings, as large as polygon clipping says, and readable.

#[path = "common/contour.rs"]
mod contour;

use contour::crossings;
use gearcut::cut::cpu::Cpu;
use gearcut::gear::generation::Side;
use gearcut::job::Job;
use gearcut::scene;
use gearcut::surface::gear_solid::gear_solid;
use gearcut::surface::gear_surfaces::complete;
use gearcut::surface::outline::Outline;
use gearcut::surface::section::Section;
use gearcut::surface::{BlankMesh, Mesh, SurfaceGrid};
use glam::DVec2;
use std::path::{Path, PathBuf};

const COARSE: [&str; 2] = ["fields.flank.profile_spacing_um=20", "fields.flank.lead_spacing_um=2000"];

fn load(path: &Path, settings: &[&str]) -> Job {
    let settings: Vec<String> = COARSE.iter().chain(settings).map(|&s| s.to_owned()).collect();
    Job::new(scene::load(path, &settings).expect("a shipped scene").scene).expect("can be cut")
}

fn outline_and_solid(job: &Job) -> (Outline, Mesh) {
    let backend = Cpu::default();
    let generation = job.target_generation();
    let flanks = (1..=job.scene.gear.teeth)
        .flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)])
        .map(|(tooth, side)| {
            let target = job.target_flank(&generation, tooth, side).expect("a flank");
            let cut = job.cut(&backend, job.flank_field(&target)).expect("cut");
            SurfaceGrid::new(&cut.field, &cut.layers, job.scene.output.mesh_spacing_mm)
        })
        .collect();
    let surfaces = complete(job, &backend, flanks, &|| ()).expect("roots and tips");
    let outline = Outline::new(&surfaces, &job.blank);
    let solid = gear_solid(&outline, job.scene.gear.bore_diameter_mm).expect("a closed body");
    (outline, solid)
}

fn shipped_scenes() -> Vec<PathBuf> {
    let mut scenes: Vec<PathBuf> = std::fs::read_dir("scenes/shaping")
        .expect("scenes")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    scenes.sort();
    assert!(scenes.len() >= 8);
    scenes
}

#[test]
fn every_shipped_scene_gives_a_closed_body() {
    for path in shipped_scenes() {
        let job = load(&path, &[]);
        let (outline, solid) = outline_and_solid(&job);
        assert!(solid.is_closed(), "{}: {:?}", path.display(), solid.edge_faults());
        let row = outline.row_mm(0);
        println!(
            "{}: {} rows, {} columns, {} triangles, {:.3} mm^3",
            path.display(),
            outline.rows(),
            row.len(),
            solid.triangles.len(),
            solid.volume_mm3()
        );
        for r in [0, outline.rows() - 1] {
            assert_eq!(crossings(&outline.row_mm(r)), 0, "{}", path.display());
        }
    }
}

/// Two ways that share nothing but the scene: dexels sewn together, and polygons of every stroke clipped off. Chords of 2 um on the cutter and 0.4 um on the blank, over some 500 mm of outline, may
/// leave 0.7 mm^2; a single stroke left out where the cutter plunges is far more.
#[test]
fn the_body_is_as_large_as_clipping_says() {
    let job = load(Path::new("scenes/shaping/circular_m3_z24.toml"), &[]);
    let (_, solid) = outline_and_solid(&job);
    let from_dexels_mm2 = solid.volume_mm3() / job.scene.gear.face_width_mm;
    let mut section = Section::new(&job);
    section.advance(Section::strokes(&job));
    let clipped_mm2 = section.area_mm2();
    println!("{from_dexels_mm2:.4} mm^2 from dexels, {clipped_mm2:.4} mm^2 clipped");
    assert!((from_dexels_mm2 - clipped_mm2).abs() < 0.7);
    assert!(section.solid([-1.0, 1.0], DVec2::X).is_closed());
}

/// A few teeth of a gear whose other teeth no pass reaches, and a small pinion that the cutter undercuts.
#[test]
fn windows_and_undercut_leave_closed_bodies_in_the_blank() {
    // Flanks and roots of the target may cross each other or never be reached there, so that no body can be made of them; rays through the blank know no target.
    let window = ["operation.finish.window_deg=[0, 100]", "operation.rough.window_deg=[0, 100]"];
    for settings in [&window[..], &["gear.teeth=12"]] {
        let settings = [settings, &["fields.blank.spacing_mm=0.2"]].concat();
        let job = load(Path::new("scenes/shaping/circular_m3_z24.toml"), &settings);
        let cut = job
            .cut_blank(&Cpu::default(), job.blank_field().expect("fits"), &|| true)
            .expect("native")
            .expect("not stopped");
        let BlankMesh { mesh, guessed } = BlankMesh::new(&cut.field, None);
        assert!(mesh.is_closed() && guessed == 0, "{settings:?}: {:?}", mesh.edge_faults());
    }
}
