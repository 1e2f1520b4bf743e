//! The lofted body of hobbed gears, undercut ones among them: closed, and in the place where the rays through the blank
//! and the target's polygon have it, on every tooth.
//!
//! The blank field knows neither flanks nor roots: its rays run through the whole stock, and its kernel cuts sections
//! of sweeps. The polygon of the target follows from the rack's meshing alone. A vertex that lies anywhere but on the
//! cut surface misses both.

use crate::fixtures::contour::crossings;
use gearcut::cut::CutBlank;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::intervals::Span;
use gearcut::math::planar_rays::FAMILIES;
use gearcut::measure::target_outline::TargetOutline;
use gearcut::process;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::steps::gear_surfaces::complete;
use gearcut::surface::SurfaceGrid;
use gearcut::surface::gear_solid::gear_solid;
use gearcut::surface::outline::{BODY_MM, Outline};
use gearcut::terms::Side;
use glam::DVec2;
use rayon::prelude::*;
use std::path::Path;

/// How far the body's sections may lie from the blank's contours, mm: chords of 0.1 mm miss a ridge that a sharp hob
/// corner leaves by half of that times the slope of its sides, 35 degrees.
const FROM_BLANK_MM: f64 = 0.035;
/// The same in the mean over a section, mm, as area per length of the contour: chords cut off ridges and fill grooves.
const MEAN_FROM_BLANK_MM: f64 = 0.001;
/// How far the body may lie under the target, mm: the helix's chord over a row of 1 mm on the smallest root, and that
/// of the polygon.
const UNDER_TARGET_MM: f64 = 0.002;

/// A thin slice of a scene's gear: rows of the body and slices of the blank 1 mm apart.
fn job(name: &str, settings: &[&str]) -> HobbingJob {
    let thin = [
        "gear.face_width_mm=2",
        "gear.bore_diameter_mm=10",
        "fields.flank.profile_spacing_um=100",
        "fields.flank.lead_spacing_um=1000",
        "fields.blank.spacing_mm=1",
        "fields.blank.slice_spacing_mm=1",
        "output.mesh_spacing_mm=0.1",
    ];
    let settings: Vec<String> = thin.iter().chain(settings).map(|&s| s.to_owned()).collect();
    let loaded = process::load(Path::new(&format!("scenes/hobbing/{name}.toml")), &settings).expect("a scene");
    HobbingJob::new(&loaded.scene).expect("a job")
}

fn outline(cutter: &HobCutter) -> Outline {
    let job = cutter.job;
    let both = |tooth| [(tooth, Side::Left), (tooth, Side::Right)];
    let flanks: Vec<(u32, Side)> = (1..=job.scene.gear.teeth).flat_map(both).collect();
    let flanks = flanks
        .into_par_iter()
        .map(|(tooth, side)| {
            let cut = cutter.cut(&Cpu::default(), tooth, side).expect("cut");
            SurfaceGrid::new(&cut.rays, &cut.layers, job.scene.output.mesh_spacing_mm)
        })
        .collect();
    let root = |space| cutter.root_surface(&Cpu::default(), space).expect("a root");
    let roots = (1..=job.scene.gear.teeth).into_par_iter().map(root).collect();
    let surfaces = complete(cutter, &Cpu::default(), flanks, roots, &|| ()).expect("tips");
    Outline::new(&surfaces, &job.blank, BODY_MM)
}

/// Lowest and highest of some points over the target, mm.
fn over_target_mm(target: &TargetOutline, points_mm: impl Iterator<Item = DVec2>) -> [f64; 2] {
    points_mm.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| {
        let height = target.distance_mm(p, 10.0).expect("within 10 mm of the target");
        [low.min(height), high.max(height)]
    })
}

/// Ends of the spans of a slice of the blank, the bore's left out.
fn ends_mm(cut: &CutBlank, slice: usize, bore_radius_mm: f64) -> Vec<DVec2> {
    let rays = FAMILIES.into_iter().zip(&cut.field.slices[slice].rays).zip(&cut.field.grid.rows);
    let ends = rays.flat_map(|((family, rays), row)| {
        rays.iter().enumerate().flat_map(move |(index, spans)| {
            let ends = spans.iter().flat_map(|span| [span.low.at_mm, span.high.at_mm]);
            ends.map(move |along_mm| family.point(along_mm, row.at_mm(index)))
        })
    });
    ends.filter(|p| p.length() > bore_radius_mm + 1e-6).collect()
}

fn check(name: &str, settings: &[&str]) {
    let job = job(name, settings);
    let cutter = HobCutter::new(&job).expect("passes");
    let outline = outline(&cutter);
    let solid = gear_solid(&outline, &job.blank.back).expect("a body");
    assert!(solid.is_closed(), "{name}: {:?}", solid.edge_faults());

    let cut = cutter
        .cut_blank(&Cpu::default(), job.blank_field().expect("fits"), &|| true)
        .expect("cuts")
        .expect("not stopped")
        .cut;
    let grid = &cut.field.grid;
    let bore_radius_mm = 0.5 * job.scene.gear.bore_diameter_mm;
    // Over the target: sections of the blank, sections of the body, and the body's triangles between them.
    let infinite = [f64::INFINITY, f64::NEG_INFINITY];
    let (mut of_blank, mut of_body, mut of_chords) = (infinite, infinite, infinite);
    let (mut farthest_mm, mut mean_mm) = (0.0_f64, 0.0_f64);
    for (slice, &z_mm) in grid.slices_z_mm.iter().enumerate() {
        let row =
            outline.rows_z_mm.iter().position(|row_z_mm| (row_z_mm - z_mm).abs() < 1e-9).expect("a row in every slice");
        let contour = outline.row_mm(row);
        assert_eq!(crossings(&contour), 0, "{name} at {z_mm} mm");
        let section = TargetOutline::new(contour.clone(), job.blank.back);
        let target = job.target_outline(z_mm, 0.02);
        let ends = ends_mm(&cut, slice, bore_radius_mm);
        let off = |p: &DVec2| section.distance_mm(*p, 10.0).expect("within 10 mm of the body").abs();
        farthest_mm = ends.iter().map(off).fold(farthest_mm, f64::max);
        let wider = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        of_blank = wider(of_blank, over_target_mm(&target, ends.into_iter()));
        of_body = wider(of_body, over_target_mm(&target, contour.iter().copied()));
        // Areas by the same rays, so that their spacing does not enter.
        let length_mm: f64 = (0..contour.len()).map(|i| contour[i].distance(contour[(i + 1) % contour.len()])).sum();
        for ((family, rays), row) in FAMILIES.into_iter().zip(&cut.field.slices[slice].rays).zip(&grid.rows) {
            let of_blank_mm: f64 = rays.iter().flatten().map(Span::length_mm).sum();
            let spans = section.spans(family, row);
            let of_body_mm: f64 = spans.iter().flatten().map(|span| span[1] - span[0]).sum();
            mean_mm = mean_mm.max((of_body_mm - of_blank_mm).abs() * row.spacing_mm / length_mm);
        }
    }
    for pair in 1..outline.rows() {
        let [below, above] = [pair - 1, pair].map(|row| outline.row_mm(row));
        let target = job.target_outline(0.5 * (outline.rows_z_mm[pair - 1] + outline.rows_z_mm[pair]), 0.02);
        let middles = (0..below.len()).map(|i| 0.5 * (below[i] + above[(i + 1) % above.len()]));
        let [low, high] = over_target_mm(&target, middles);
        of_chords = [of_chords[0].min(low), of_chords[1].max(high)];
    }
    println!(
        "{name} {settings:?}: {} triangles; {farthest_mm:.4} mm from the blank, {mean_mm:.6} mm in the mean; over the \
        target: blank {of_blank:.5?}, body {of_body:.5?}, between rows {of_chords:.5?} mm",
        solid.triangles.len()
    );
    assert!(farthest_mm < FROM_BLANK_MM && mean_mm < MEAN_FROM_BLANK_MM);
    for [low, high] in [of_body, of_chords] {
        assert!(low > -UNDER_TARGET_MM, "{low} mm under the target");
        assert!(high < of_blank[1] + FROM_BLANK_MM, "{high} mm over the target, the blank {}", of_blank[1]);
    }
    assert!(of_blank[1] > 0.005, "marks are seen");
}

mod slow {
    use super::*;

    /// Two rows and two slices.
    const NARROW: &str = "gear.face_width_mm=1";

    /// Teeth are fewer than in the scenes, and faces as narrow as can be, or this would be the longest test of all:
    /// what a body is made of is the same on each of them.
    #[test]
    fn every_other_scene() {
        let ellipse = "operation.finish.linkage.hobbing";
        check("circular_spur", &["gear.teeth=20", NARROW]);
        check("circular_helical", &["gear.teeth=11", "tool.hob.starts=1", "tool.hob.gashes=18", NARROW]);
        check("third_order_diagonal", &["gear.teeth=21", NARROW]);
        // Each extra rotation once; all six schemes have their axes compared with the oracle.
        for (even, extra) in [("rotation_angle", "hob"), ("polar_angle", "work")] {
            check(
                "ellipse_six_schemes",
                &[
                    "gear.teeth=21",
                    NARROW,
                    &format!("{ellipse}.even_motion={even}"),
                    &format!("{ellipse}.extra_rotation={extra}"),
                ],
            );
        }
    }

    #[test]
    fn a_small_helical_gear_undercut_on_every_tooth() {
        let small = ["gear.module_mm=2", "gear.teeth=16", "gear.helix_angle_deg=15", "tool.hob.tip_radius_mm=0"];
        check("circular_spur", &small);
    }

    #[test]
    fn the_third_order_gear_undercut_at_its_lobes() {
        // Flanks have four rows, roots three: the middle one lies between the flanks' own.
        check("third_order_plain", &["fields.flank.lead_spacing_um=667"]);
    }
}
