//! Meshes of cut gears: closed, free of crossings, as large as polygon clipping says, and readable.

use crate::fixtures::clipping::clipped;
use crate::fixtures::command::scenes_of_all_shapes;
use crate::fixtures::contour::crossings;
use gearcut::cut::cpu::Cpu;
use gearcut::process;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::cut::section::{CutSection, cutter_solid};
use gearcut::steps::frames::section::section_body;
use gearcut::steps::gear_surfaces::complete;
use gearcut::surface::gear_solid::gear_solid;
use gearcut::surface::outline::{BODY_MM, Outline};
use gearcut::surface::{BlankMesh, Mesh, SurfaceGrid};
use gearcut::terms::Side;
use glam::DVec2;
use std::f64::consts::PI;
use std::path::Path;

const COARSE: [&str; 2] = ["fields.flank.profile_spacing_um=20", "fields.flank.lead_spacing_um=2000"];

fn load(path: &Path, settings: &[&str]) -> ShapingJob {
    let settings: Vec<String> = COARSE.iter().chain(settings).map(|&s| s.to_owned()).collect();
    ShapingJob::new(process::load(path, &settings).expect("a shipped scene").scene).expect("can be cut")
}

fn outline_and_solid(job: &ShapingJob) -> (Outline, Mesh) {
    let backend = Cpu::default();
    let flanks = (1..=job.scene.gear.teeth)
        .flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)])
        .map(|(tooth, side)| {
            let target = job.target_flank(tooth, side);
            let cut = job.cut(&backend, job.flank_field(target)).expect("cut");
            SurfaceGrid::new(&cut.field, &cut.layers, job.scene.output.mesh_spacing_mm)
        })
        .collect();
    let root = |space| {
        let cut = job.cut(&backend, job.root_field(space)).expect("cut");
        SurfaceGrid::new(&cut.field, &cut.layers, job.scene.output.mesh_spacing_mm)
    };
    let roots = (1..=job.scene.gear.teeth).map(root).collect();
    let surfaces = complete(job, &backend, flanks, roots, &|| ()).expect("tips");
    let outline = Outline::new(&surfaces, &job.blank, BODY_MM);
    let solid = gear_solid(&outline, &job.blank.back).expect("a closed body");
    (outline, solid)
}

#[test]
fn every_shape_gives_a_closed_body() {
    for path in scenes_of_all_shapes() {
        let job = load(&path, &["fields.flank.profile_spacing_um=60"]);
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

/// Teeth are displaced from their target, and the gear is the true one, displaced within the blank's outline: where its
/// teeth are pushed out by d they lose d^2 tan(alpha_a), and as much where they are drawn in, cos(alpha_a) being r_b /
/// r_a. Corners between rays may leave 0.004 mm^2 a tooth beside it.
#[test]
fn a_gear_off_its_axis_has_the_true_gears_body() {
    let section_mm2 = |eccentricity_um: u32| {
        let off = format!("mounting.eccentricity_um={eccentricity_um}");
        let (outline, solid) = outline_and_solid(&load(Path::new("scenes/shaping/circular_m3_z24.toml"), &[&off]));
        assert_eq!(crossings(&outline.row_mm(0)), 0, "{eccentricity_um} um");
        solid.volume_mm3() / (outline.rows_z_mm[outline.rows() - 1] - outline.rows_z_mm[0])
    };
    let true_mm2 = section_mm2(0);
    for eccentricity_um in [30, 120] {
        let lost_mm2 =
            12.0 * (1e-3 * f64::from(eccentricity_um)).powi(2) * (36.0 * 20_f64.to_radians().cos() / 39.0).acos().tan();
        let off_mm2 = section_mm2(eccentricity_um) - true_mm2 + lost_mm2;
        println!("{eccentricity_um} um off: {off_mm2} mm^2 more than {true_mm2} - {lost_mm2}");
        assert!(off_mm2.abs() < 0.16, "{eccentricity_um} um: {off_mm2}");
    }
}

/// Ways that share nothing but the scene: dexels on the flanks lofted, rays through the blank as the pictures of
/// the cut draw them, and polygons of every stroke clipped off. Chords of the clipped polygons over some 500 mm of
/// outline may leave 0.7 mm^2; a single stroke left out where the cutter plunges is far more.
#[test]
fn the_body_is_as_large_as_clipping_says() {
    let job = load(Path::new("scenes/shaping/circular_m3_z24.toml"), &[]);
    let (_, solid) = outline_and_solid(&job);
    let from_dexels_mm2 = solid.volume_mm3() / job.scene.gear.face_width_mm;
    let polygon = clipped(&job);
    let outline_mm2 =
        (0..polygon.len()).map(|i| 0.5 * polygon[i].perp_dot(polygon[(i + 1) % polygon.len()])).sum::<f64>();
    let clipped_mm2 = outline_mm2 - 0.25 * PI * job.scene.gear.bore_diameter_mm.powi(2);
    println!("{from_dexels_mm2:.4} mm^2 from dexels, {clipped_mm2:.4} mm^2 clipped");
    assert!((from_dexels_mm2 - clipped_mm2).abs() < 0.7);

    let mut section = CutSection::new(&job).expect("fits in memory");
    let strokes = CutSection::strokes(&job);
    // In two steps, as pictures do.
    section.advance(strokes / 3);
    let half_way_mm2 = section.area_mm2();
    section.advance(strokes);
    let drawn = section_body(section.field(), DVec2::from_angle(0.3));
    println!("{:.4} mm^2 on rays, {half_way_mm2:.4} after a third of the strokes", section.area_mm2());
    assert!((section.area_mm2() - clipped_mm2).abs() < 0.7 && half_way_mm2 > section.area_mm2() + 10.0);
    assert!(drawn.is_closed(), "{:?}", drawn.edge_faults());
    assert!((drawn.volume_mm3() / job.scene.gear.face_width_mm - clipped_mm2).abs() < 0.7);
    let cutter = cutter_solid(&job, [1.0, 3.0], &CutSection::work_from_tool(&job, 7));
    assert!(cutter.is_closed() && cutter.volume_mm3() > 0.0, "{:?}", cutter.edge_faults());
}

/// A few teeth of a gear whose other teeth no pass reaches, and a small pinion that the cutter undercuts.
#[test]
fn windows_and_undercut_leave_closed_bodies_in_the_blank() {
    // Flanks and roots of the target may never be reached there, so that no body can be made of them; rays through the
    // blank know no target.
    let window = ["operation.finish.window_deg=[0, 100]", "operation.rough.window_deg=[0, 100]"];
    for settings in [&window[..], &["gear.teeth=12"]] {
        let settings = [settings, &["fields.blank.spacing_mm=0.2"]].concat();
        let job = load(Path::new("scenes/shaping/circular_m3_z24.toml"), &settings);
        let cut = job
            .cut_blank(&Cpu::default(), job.planar().blank_field().expect("fits"), &|| true)
            .expect("native")
            .expect("not stopped");
        let BlankMesh { mesh, guessed } = BlankMesh::new(&cut.field, None);
        assert!(mesh.is_closed() && guessed == 0, "{settings:?}: {:?}", mesh.edge_faults());
    }
}
