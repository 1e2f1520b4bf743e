//! Meshes of cut gears: closed, free of crossings, as large as polygon clipping says, and readable.

mod common;

use gearcut::cut::cpu::Cpu;
use gearcut::gear::generation::Side;
use gearcut::job::{GearJob, HobCutter, HobbingJob, Job};
use gearcut::scene;
use gearcut::surface::gear_solid::gear_solid;
use gearcut::surface::gear_surfaces::complete;
use gearcut::surface::outline::Outline;
use gearcut::surface::section::Section;
use gearcut::surface::{BlankMesh, Mesh, SurfaceGrid};
use glam::DVec2;
use std::collections::HashMap;
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

/// Crossings of a closed contour with itself, found through a grid of 0.5 mm.
fn crossings(contour: &[DVec2]) -> usize {
    let count = contour.len();
    let piece = |i: usize| (contour[i], contour[(i + 1) % count]);
    let mut cells: HashMap<(i64, i64), Vec<usize>> = HashMap::new();
    for i in 0..count {
        let (a, b) = piece(i);
        let cell = |p: DVec2| ((p.x * 2.0).floor() as i64, (p.y * 2.0).floor() as i64);
        let (low, high) = (cell(a.min(b)), cell(a.max(b)));
        for x in low.0..=high.0 {
            for y in low.1..=high.1 {
                cells.entry((x, y)).or_default().push(i);
            }
        }
    }
    let side = |a: DVec2, b: DVec2, p: DVec2| (b - a).perp_dot(p - a);
    let mut found = 0;
    for pieces in cells.values() {
        for (k, &i) in pieces.iter().enumerate() {
            for &j in &pieces[k + 1..] {
                let ((a, b), (c, d)) = (piece(i), piece(j));
                let apart = i.abs_diff(j) > 1 && i.abs_diff(j) < count - 1;
                if apart && side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0 {
                    found += 1;
                }
            }
        }
    }
    found
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

/// Hobbed gears, helical and undercut among them, are closed bodies, as large as their face width times the area inside the target's polygon: feed and generating marks of some micrometres stand over it.
#[test]
fn hobbed_gears_give_closed_bodies() {
    let backend = Cpu::default();
    let body = |name: &str, settings: &[&str]| {
        let coarse =
            ["fields.flank.profile_spacing_um=100", "fields.flank.lead_spacing_um=2500", "output.mesh_spacing_mm=0.3"];
        let settings: Vec<String> = coarse.iter().chain(settings).map(|&s| s.to_owned()).collect();
        let path = format!("scenes/hobbing/{name}.toml");
        let job = HobbingJob::new(&scene::load(Path::new(&path), &settings).expect("a scene").scene).expect("a job");
        let cutter = HobCutter::new(&job).expect("passes");
        let flanks = (1..=job.scene.gear.teeth)
            .flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)])
            .map(|(tooth, side)| {
                let cut = cutter.cut(&backend, tooth, side).expect("cut");
                SurfaceGrid::new(&cut.rays, &cut.layers, job.scene.output.mesh_spacing_mm)
            })
            .collect();
        let surfaces = complete(&cutter, &backend, flanks, &|| ()).expect("roots and tips");
        let outline = Outline::new(&surfaces, &job.blank);
        let solid = gear_solid(&outline, 20.0).expect("a closed body");
        assert!(solid.is_closed(), "{name}: {:?}", solid.edge_faults());
        for r in [0, outline.rows() / 2, outline.rows() - 1] {
            assert_eq!(crossings(&outline.row_mm(r)), 0, "{name} row {r}");
        }
        println!("{name}: {} triangles, {:.1} mm^3", solid.triangles.len(), solid.volume_mm3());
        (solid.volume_mm3(), job)
    };
    for (name, settings) in [
        (
            "circular_helical",
            &["gear.teeth=13", "gear.face_width_mm=10", "tool.hob.starts=1", "tool.hob.gashes=28"][..],
        ),
        (
            "third_order_plain",
            &["gear.face_width_mm=5", "fields.flank.profile_spacing_um=400", "output.mesh_spacing_mm=0.5"],
        ),
    ] {
        let (volume_mm3, job) = body(name, settings);
        let gear = &job.scene.gear;
        let cutter = HobCutter::new(&job).expect("passes");
        let section = section_area_mm2(&cutter) - 100.0 * std::f64::consts::PI;
        let expected = section * gear.face_width_mm;
        println!("{name}: {volume_mm3:.1} for {expected:.1} mm^3");
        assert!((volume_mm3 / expected - 1.0).abs() < 5e-4, "{name}: {volume_mm3} for {expected}");
    }
}

/// Area of the target's polygon in the middle of the face.
fn section_area_mm2(job: &dyn GearJob) -> f64 {
    let mut points: Vec<DVec2> = Vec::new();
    for tooth in 1..=job.scene().gear.teeth {
        let profile = |side| job.target_profiles(tooth, side, 0.1, &[0.0]).expect("a flank").1[0].clone();
        let [right, left] = [Side::Right, Side::Left].map(profile);
        let foot = |point: DVec2| job.blank().height(point, point.to_angle()).1;
        let [from, to] = [&right, &left].map(|flank| foot(flank[flank.len() - 1].0));
        let land = (to - from).rem_euclid(std::f64::consts::TAU);
        points.extend(right.iter().map(|p| p.0));
        points.extend((1..20).map(|i| job.blank().outline_mm(from + land * f64::from(i) / 20.0)));
        points.extend(left.iter().rev().map(|p| p.0));
        points.extend(job.target_roots(tooth, 0.1, &[0.0]).expect("a root")[0].iter().map(|p| p.0));
    }
    (0..points.len()).map(|i| 0.5 * points[i].perp_dot(points[(i + 1) % points.len()])).sum()
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
