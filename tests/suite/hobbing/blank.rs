//! The blank field of hobbed gears: sections of sweeps against the equations of the flank kernel, candidates against
//! all passes, what is left against the target, loads against the ledger.

use crate::fixtures::space_ledger::{LedgerGrid, SpaceLedger};
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::cut::cpu::blank_sweeps;
use gearcut::dexel::{NO_PASS, Ray, SpatialField};
use gearcut::math::planar_rays::{ClosedCurve, FAMILIES, Piece};
use gearcut::math::ray_reach::LooseOutline;
use gearcut::passes::SweepPlan;
use gearcut::passes::sections::section_band::{InSlice, SectionBand};
use gearcut::passes::sections::swept_sections::SweptSection;
use gearcut::passes::spatial::sweep::Sweep;
use gearcut::process::hobbing::measure::blank_report;
use gearcut::process::hobbing::measure::engagement::Engagement;
use gearcut::process::hobbing::measure::hob_load::OperationLoad;
use gearcut::process::hobbing::{HobCutter, HobbedBlank, HobbingJob};
use gearcut::process::load;
use gearcut::surface::BlankMesh;
use gearcut::tool::CuttingTool;
use gearcut::tool::edge::Edge;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

fn job(scene: &str, sets: &[&str]) -> HobbingJob {
    let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
    let loaded = load(Path::new(&format!("scenes/hobbing/{scene}.toml")), &sets).unwrap_or_else(|e| panic!("{e}"));
    HobbingJob::new(&loaded.scene).expect("a scene that cuts")
}

fn cut_blank(cutter: &HobCutter) -> HobbedBlank {
    let field = cutter.job.blank_field().expect("fits");
    cutter.cut_blank(&Cpu::default(), field, &|| true).expect("the native backend").expect("not stopped")
}

const SMALL: [&str; 3] = ["gear.face_width_mm=6", "fields.blank.spacing_mm=0.5", "fields.blank.slice_spacing_mm=1.0"];

/// Distance of a point of the rake face (distance from the axis, y) from the edge.
fn off_edge_mm(edge: &Edge, point: DVec2) -> f64 {
    let off = edge.segments.iter().map(|segment| {
        let p = segment.blade_from_segment.inverse().point(point);
        let y = p.y.clamp(segment.y_range_mm[0], segment.y_range_mm[1]);
        let [x, slope] = segment.x_and_slope(y);
        let beyond = p.y - y;
        // Near the edge: across it, or from the segment's end.
        ((p.x - x - slope * beyond) / slope.hypot(1.0)).abs().max(beyond.abs())
    });
    off.fold(f64::INFINITY, f64::min)
}

#[test]
fn sections_hold_the_edge_at_the_moment_of_their_slice() {
    // The last two turn their shift round six times a revolution, and lift the hob from its work at 20 mm/s: a cubic
    // over such a moment has its corner rounded off.
    let turning = "operation.finish.linkage.hobbing_diagonal.shift_mm_per_revolution=500";
    let lifting = "operation.finish.linkage.hobbing_diagonal.strategy=repeating";
    for (scene, sets, bound_nm) in [
        ("circular_spur", &[][..], 20.0),
        ("circular_helical", &[], 20.0),
        ("third_order_diagonal", &[], 20.0),
        ("third_order_diagonal", &[turning], 3000.0),
        ("third_order_diagonal", &[lifting], 3000.0),
    ] {
        let job = job(scene, sets);
        let cutter = HobCutter::new(&job).expect("passes");
        let last = job.operations.len() - 1;
        let (set, sections) = (&cutter.operations[last], cutter.sections(last, true).expect("a hob"));
        let half_mm = 0.5 * job.scene.gear.face_width_mm;
        let (mut worst_nm, mut points, mut rounded, mut section) = (0.0_f64, 0, 0, SweptSection::default());
        for index in (0..sections.len()).step_by(sections.len() / 150) {
            for z_mm in [-half_mm, -0.31 * half_mm, 0.0, half_mm] {
                if !sections.section(index, z_mm, &mut section) {
                    continue;
                }
                let pass = set.pass(section.pass - set.first_pass);
                for piece in section.pieces().iter().filter(|piece| piece.law != Piece::STRAIGHT) {
                    for share in [0.0, 0.3, 0.5, 0.8] {
                        let place = section.place(piece.law, share)[0].extend(z_mm);
                        // Only where the blank may be does the place matter.
                        if place.truncate().length() > job.blank.outline_mm(0.0).length() + 20.0 {
                            continue;
                        }
                        let held = |piece| {
                            let sweep = Sweep::new(set, &pass, piece, place, 1.0)?;
                            sweep.in_rake_face(DVec3::ZERO).expect("the moment settles")
                        };
                        // A rounded corner lies between both motions.
                        let Some([radius, y]) = set.pieces(&pass).find_map(held) else {
                            rounded += 1;
                            continue;
                        };
                        worst_nm = worst_nm.max(1e6 * off_edge_mm(job.hob.edge_of(0), DVec2::new(radius, y)));
                        points += 1;
                    }
                }
            }
        }
        println!(
            "{scene} {sets:?}: {} of {} passes, {points} points, {rounded} at corners, {worst_nm:.2} nm off the edge",
            sections.len(),
            set.count()
        );
        assert!(points > 3000 && worst_nm < bound_nm && 1000 * rounded < points);
    }
}

#[test]
fn neighbouring_slices_are_known_from_the_one_in_their_middle() {
    let steep: &[&str] = &["gear.helix_angle_deg=38", "tool.hob.starts=2", "tool.hob.length_mm=200"];
    for (scene, sets, operation) in [
        ("circular_spur", &[][..], 0),
        ("circular_helical", &[], 0),
        ("circular_helical", &[], 1),
        ("circular_helical", steep, 1),
        ("ellipse_six_schemes", &[], 0),
        ("third_order_plain", &[], 0),
        ("third_order_diagonal", &[], 0),
    ] {
        let job = job(scene, sets);
        let cutter = HobCutter::new(&job).expect("passes");
        let sections = cutter.sections(operation, true).expect("a hob");
        let half_mm = 0.5 * sections.band_mm();
        let (mut band, mut outline, mut section) =
            (SectionBand::default(), LooseOutline::default(), SweptSection::default());
        // Largest distance of the true section from the outline, as a share of its tolerance: on the edge, where it is
        // closed, and of ends of pieces alone, as a share of what is not arrow height.
        let (mut worst, mut pieces) = ([0.0_f64; 3], 0);
        for index in (0..sections.len()).step_by(sections.len() / 60) {
            for at_mm in [-0.4, -0.1, 0.0, 0.3].map(|share: f64| share * job.scene.gear.face_width_mm) {
                if !band.set(&sections, index, [at_mm - half_mm, at_mm + half_mm]) {
                    continue;
                }
                for share in [-1.0, -0.9, -0.4, 0.0, 0.7, 1.0] {
                    let z_mm = at_mm + share * half_mm;
                    let known = band.outline(&sections, z_mm, &mut outline);
                    let there = sections.section(index, z_mm, &mut section);
                    assert!(there == (known == InSlice::Within) || known == InSlice::Followed, "{scene}: {known:?}");
                    if known != InSlice::Within {
                        continue;
                    }
                    let count = section.pieces().len();
                    assert_eq!(count, outline.corners_mm.len());
                    for (i, piece) in section.pieces().iter().enumerate() {
                        let [a, b] = [i, (i + 1) % count].map(|i| outline.corners_mm[i]);
                        if piece.law != Piece::STRAIGHT && share != 0.0 {
                            let moved_mm = a.distance(section.node_mm(i));
                            worst[2] = worst[2].max(moved_mm / (outline.tolerances_mm[i] - 1.1 * piece.sagitta_mm));
                        }
                        for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
                            let [from, to] = [i, (i + 1) % count].map(|i| section.node_mm(i));
                            let closing = piece.law == Piece::STRAIGHT;
                            let place = if closing { from.lerp(to, share) } else { section.place(piece.law, share)[0] };
                            let along = ((place - a).dot(b - a) / a.distance_squared(b).max(1e-18)).clamp(0.0, 1.0);
                            let off = place.distance(a.lerp(b, along)) / outline.tolerances_mm[i];
                            let worst = &mut worst[usize::from(closing)];
                            *worst = worst.max(off);
                        }
                        pieces += 1;
                    }
                }
            }
        }
        println!("{scene} {sets:?}, operation {operation}: {pieces} pieces, {worst:?} of their tolerance");
        assert!(pieces > 4_000);
        // Half of it is what the hob's circle bends.
        assert!(worst.iter().all(|worst| *worst < 0.9) && worst[2] > 0.3);
    }
}

#[test]
fn the_mesh_is_closed_and_loads_are_those_of_the_ledger() {
    let job = job(
        "circular_spur",
        &["gear.face_width_mm=10", "fields.blank.spacing_mm=0.3", "fields.blank.slice_spacing_mm=1.0"],
    );
    let cutter = HobCutter::new(&job).expect("passes");
    let blank = cut_blank(&cutter);
    let mesh = BlankMesh::new(&blank.cut.field, None).mesh;
    let left_mm3 = blank.cut.left_mm3[0];
    println!("{} triangles, {} mm3 against {left_mm3:?}", mesh.triangles.len(), mesh.volume_mm3());
    assert!(mesh.is_closed(), "{:?}", mesh.edge_faults());
    assert!((mesh.volume_mm3() / left_mm3[0] - 1.0).abs() < 2e-3);

    // One space of a round gear stands for all. Its ledger knows no candidates, no x and y rays and no sections.
    let load = OperationLoad::of_blank(&cutter.operations[0], &blank.chips[0]);
    let pitch_mm = PI * job.scene.gear.transverse_module_mm();
    let root_mm = job.hob.tip_radius_mm - job.hob.pitch_radius_mm;
    // Two slices half a feed apart stand for the whole face.
    let grid = LedgerGrid {
        slices_mm: vec![-0.5, 0.5],
        slice_width_mm: 0.5 * job.scene.gear.face_width_mm,
        spacing_mm: 0.2,
        heights_mm: [-root_mm - 0.5, job.blank.addendum_mm],
    };
    let mut ledger = SpaceLedger::new(&job.curve, &grid, pitch_mm, |z| job.target.space_arc_mm(0, z));
    let (teeth, _) = ledger.cut(&cutter.operations[0]);
    let spaces = f64::from(job.scene.gear.teeth);
    let of_ledger: f64 = teeth.iter().map(|tooth| spaces * tooth.volume_mm3).sum();
    println!("{of_ledger} mm3 by the ledger, {} by the blank", load.volume_mm3());
    assert!((of_ledger / load.volume_mm3() - 1.0).abs() < 2e-3);
    let forecast = {
        let grid = [root_mm + 0.5, job.blank.addendum_mm, 0.1];
        Engagement::of_space(&job.operations[0].linkage, &job.target, &job.hob, 0, 0.0, grid).expect("moments")
    };
    // The forecast counts points of one section of one space. The blank lies within it where the face is wide; the
    // shares of entry and exit are the same, as every section meets all that the slide goes by.
    let of_section_mm3 = spaces * forecast.total_mm2() * job.scene.gear.face_width_mm;
    println!("{of_section_mm3} mm3 by the forecast");
    assert!((of_section_mm3 / load.volume_mm3() - 1.0).abs() < 5e-3);
    let mut apart = 0.0_f64;
    for (tooth, measured) in job.hob.teeth.iter().zip(&load.teeth) {
        apart = apart.max((forecast.share(tooth.passage) - measured.volume_mm3 / load.volume_mm3()).abs());
    }
    println!("shares of forecast and blank within {apart:.4}");
    assert!(apart < 5e-3, "{apart}");
    let (mut worst, mut thickest) = (0.0_f64, [0.0_f64; 2]);
    for (index, (tooth, wanted)) in load.teeth.iter().zip(&teeth).enumerate() {
        let shares = [tooth.volume_mm3 / load.volume_mm3(), spaces * wanted.volume_mm3 / of_ledger];
        worst = worst.max((shares[0] - shares[1]).abs());
        thickest = [thickest[0].max(tooth.thickness_mm), thickest[1].max(wanted.thickness_mm)];
        if shares[1] > 0.005 {
            println!(
                "  {index}: {:.4} {:.4}, {:.3} {:.3} mm",
                shares[0], shares[1], tooth.thickness_mm, wanted.thickness_mm
            );
        }
    }
    println!(
        "worst share {worst:.4}, thickest chips {thickest:?} mm, travel {:.1} m",
        1e-3 * load.teeth.iter().map(|t| t.travel_mm).sum::<f64>()
    );
    assert!(worst < 0.004);
    assert!((thickest[0] / thickest[1] - 1.0).abs() < 0.1);
}

mod slow {
    use super::*;

    #[test]
    fn candidates_leave_what_all_passes_leave() {
        for (scene, teeth, face, spacing) in
            [("circular_spur", 20, 0.6, 1.5), ("circular_helical", 21, 0.6, 1.5), ("third_order_plain", 21, 0.6, 2.0)]
        {
            // Slices so close that several are known from one section.
            let [teeth, face] = [format!("gear.teeth={teeth}"), format!("gear.face_width_mm={face}")];
            let spacing = format!("fields.blank.spacing_mm={spacing}");
            let job = job(scene, &[&teeth, &face, &spacing, "fields.blank.slice_spacing_mm=0.3"]);
            let cutter = HobCutter::new(&job).expect("passes");
            let cut = |cull: bool, tolerance_share: f64| {
                let mut field = job.blank_field().expect("fits");
                let chips: Vec<_> = (0..job.operations.len())
                    .map(|operation| {
                        let set = &cutter.operations[operation];
                        let mut sections = cutter.sections(operation, cull).expect("a hob");
                        sections.tolerance_share = tolerance_share;
                        let ids = set.first_pass..set.end_pass();
                        let steps = AtomicUsize::new(0);
                        let advance = || {
                            steps.fetch_add(1, Ordering::Relaxed);
                            true
                        };
                        let done = blank_sweeps::cut(&mut field, &sections, ids, &advance).expect("done");
                        // Progress counts slices, however many are cut together.
                        assert_eq!(steps.into_inner(), field.slices.len());
                        println!(
                            "{scene}, cull {cull}, tolerance x {tolerance_share}: {} of {} passes in {} slices, {:?}",
                            sections.len(),
                            set.count(),
                            field.slices.len(),
                            done.cut.stats
                        );
                        done.chips
                    })
                    .collect();
                (field, chips)
            };
            let all = cut(false, 1.0);
            assert!(cut(true, 1.0) == all, "{scene}");
            assert!(all.1.iter().all(|chips| chips.len() > 1000));
            let set = &cutter.operations[0];
            let mut field = job.blank_field().expect("fits");
            let stopped = blank_sweeps::cut(
                &mut field,
                &cutter.sections(0, true).expect("a hob"),
                set.first_pass..set.end_pass(),
                &|| false,
            );
            assert!(stopped.is_none(), "told to stop");
            // A wrong cull is noticed: outlines too narrow by some micrometres keep passes out.
            assert!(scene != "circular_spur" || cut(true, -3.0) != all);
        }
    }

    #[test]
    fn what_is_left_is_the_target_and_its_marks() {
        for (scene, sets) in [
            ("circular_spur", vec!["operation.finish.axial_feed_mm_per_revolution=1.0", "fields.blank.spacing_mm=0.8"]),
            ("circular_helical", vec!["fields.blank.spacing_mm=0.8"]),
            (
                "third_order_plain",
                vec!["fields.blank.spacing_mm=1.0", "fields.blank.slice_spacing_mm=7.0", "gear.face_width_mm=14"],
            ),
        ] {
            let mut all = SMALL.to_vec();
            if scene == "third_order_plain" {
                all.clear();
            }
            all.extend(sets);
            let job = job(scene, &all);
            let cutter = HobCutter::new(&job).expect("passes");
            let blank = cut_blank(&cutter);
            let report = blank_report::measure(&cutter, &blank.cut);
            // Both balances: pass by pass against the rays, and the two families against each other.
            for removed in &report.operations {
                println!("{scene}: removed {:?} by passes, {:?} by rays", removed.by_passes_mm3, removed.by_rays_mm3);
                assert!(removed.imbalance() < 1e-9);
            }
            let section = report.section;
            println!(
                "{scene}: section {:?} against {} mm2, bound {:?}",
                section.cut_mm2, section.target_mm2, section.bound_mm2
            );
            assert!((section.cut_mm2[0] - section.cut_mm2[1]).abs() < section.bound_mm2[0]);
            assert!((0..2).all(|f| (section.cut_mm2[f] - section.target_mm2).abs() < section.bound_mm2[f]));
            assert!(report.gouges.is_empty() && report.interference.is_empty(), "{:?}", report.gouges);
            // No end that a pass left lies under the target; near the pitch curve none lies higher over it than feed
            // and generating marks together. (A sharp hob corner leaves higher cusps in fillets.)
            let sharpest = job.curve.facts().curvature_extrema.iter().map(|e| e.curvature_per_mm).fold(0.0, f64::max);
            let marks_um =
                1e3 * (job.feed_mark_mm(job.finishing()).unwrap() + job.generating_mark_mm(sharpest).unwrap());
            // The outline is transverse, marks are normal to the flank.
            let cos_base = {
                let gear = &job.scene.gear;
                let tan_base = gear.helix_angle_rad.tan() * gear.transverse_pressure_angle_rad().cos();
                1.0 / tan_base.hypot(1.0)
            };
            let (mut lowest_um, mut highest_um, mut ends) = (f64::INFINITY, 0.0_f64, 0);
            let grid = &blank.cut.field.grid;
            for (slice, &z_mm) in blank.cut.field.slices.iter().zip(&grid.slices_z_mm) {
                let target = job.target_outline(z_mm, 0.03);
                for (f, family) in FAMILIES.into_iter().enumerate() {
                    for (ray, spans) in slice.rays[f].iter().enumerate() {
                        for end in spans.iter().flat_map(|span| [span.low, span.high]).filter(|end| end.pass != NO_PASS)
                        {
                            let place = family.point(end.at_mm, grid.rows[f].at_mm(ray));
                            let over_um = 1e3 * target.distance_mm(place, 2.0).expect("near");
                            lowest_um = lowest_um.min(over_um);
                            if job.blank.height(place, place.to_angle()).0.abs() < 0.05 * job.scene.gear.module_mm {
                                highest_um = highest_um.max(over_um * cos_base);
                            }
                            ends += 1;
                        }
                    }
                }
            }
            println!(
                "{scene}: {ends} ends, {lowest_um:.4} um and more over the target, at most {highest_um:.2} at the \
                pitch curve; marks {marks_um:.2}"
            );
            // 0.2 um: chords of the outline over hollow fillets lie in the material's stead. Marks are formulas for the
            // pitch line.
            assert!(ends > 5_000 && lowest_um > -0.2);
            assert!(highest_um < 1.3 * marks_um && highest_um > 0.5 * marks_um);
        }
    }

    #[test]
    fn ends_of_spans_are_the_flank_kernels_heights() {
        for scene in ["circular_helical", "third_order_diagonal"] {
            let small: &[&str] = if scene == "circular_helical" {
                &SMALL
            } else {
                &["fields.blank.spacing_mm=0.4", "fields.blank.slice_spacing_mm=25"]
            };
            let job = job(scene, small);
            let cutter = HobCutter::new(&job).expect("passes");
            let blank = cut_blank(&cutter);
            let grid = &blank.cut.field.grid;
            let slice = grid.slices_z_mm.len() / 2;
            let near = job.blank.outline_mm(0.7);
            let mut rays = Vec::new();
            for (f, family) in FAMILIES.into_iter().enumerate() {
                for (ray, spans) in blank.cut.field.slices[slice].rays[f].iter().enumerate() {
                    for (end, sign) in spans.iter().flat_map(|span| [(span.low, -1.0), (span.high, 1.0)]) {
                        let place = family.point(end.at_mm, grid.rows[f].at_mm(ray));
                        let across = family.along(DVec2::from_array(end.normal.map(f64::from))).abs();
                        let last = cutter.operations.last().expect("one").first_pass;
                        if place.distance(near) < 9.0 && end.pass != NO_PASS && end.pass >= last && across > 0.3 {
                            let normal = family.point(sign, 0.0).extend(0.0);
                            rays.push((Ray { origin_mm: place.extend(grid.slices_z_mm[slice]), normal }, end.pass));
                        }
                    }
                }
            }
            assert!(rays.len() >= 20, "{}", rays.len());
            let field = SpatialField::new(rays.len(), 1, -0.3, |column, _| (rays[column].0, 0.3));
            let passes = cutter.operations.last().expect("one");
            let plan = SweepPlan::brute_force(&field, passes);
            let mut layer = field.blank_layer();
            Cpu::default().cut_spatial(&field, &plan, &mut layer).expect("cuts");
            let worst_nm = layer.heights_mm.iter().map(|h| 1e6 * f64::from(h.abs())).fold(0.0, f64::max);
            let same = rays.iter().zip(&layer.passes).filter(|((_, pass), other)| pass == *other).count();
            println!("{scene}: {} ends, {worst_nm:.2} nm from the flank kernel, {same} by the same pass", rays.len());
            assert!(worst_nm < 60.0 && same == rays.len());
        }
    }
}
