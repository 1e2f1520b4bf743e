//! Rings cut whole: the exact internal involute, scallops, candidates against all passes, the blank against its target,
//! against clipping and against other numbers of threads, closed bodies, programs read back.

use crate::fixtures::clipping::clipped;
use crate::fixtures::paper::{NORMAL, TRADITIONAL, operation};
use crate::fixtures::rings::*;
use gearcut::cut::cpu::{Cpu, blank};
use gearcut::cut::{Backend, BlankOperation, CutBlank};
use gearcut::dexel::NO_PASS;
use gearcut::frame::Rigid2;
use gearcut::gear::PitchCurveShape;
use gearcut::gear::blank_outline::BlankOutline;
use gearcut::job::CylindricalGear;
use gearcut::math::planar_rays::FAMILIES;
use gearcut::measure::scallop::{cusps, facets};
use gearcut::measure::target_outline::TargetOutline;
use gearcut::passes::planar::strokes::StrokeLaw;
use gearcut::passes::{CutPlan, StrokeSet};
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::axes_report::programs;
use gearcut::process::shaping::motion::gcode::read;
use gearcut::process::shaping::scene::model::{Operation, Shaping};
use gearcut::scene::model::{Fields, Scene};
use gearcut::steps::gear_surfaces::complete;
use gearcut::steps::planar::blank_report;
use gearcut::steps::view_mesh::ViewMesh;
use gearcut::surface::gear_solid::gear_solid;
use gearcut::surface::outline::{BODY_MM, Outline};
use gearcut::surface::{BlankMesh, SurfaceGrid};
use gearcut::terms::Side;
use gearcut::tool::involute::{Involute, inv};
use glam::DVec2;
use std::f64::consts::{PI, TAU};

const ALPHA_RAD: f64 = 20.0 * PI / 180.0;

fn job(scene: Scene) -> ShapingJob {
    ShapingJob::new(scene).expect("a ring")
}

/// 60 teeth of module 2: pitch radius 60 mm.
fn round_ring(operations: Vec<Operation>) -> Scene {
    ring_scene(PitchCurveShape::Circle, 60, 20, operations)
}

/// An oval ring that every step can be tried on: 54 teeth, cutter of 16.
fn oval_ring(operations: Vec<Operation>) -> Scene {
    let shape = PitchCurveShape::Ellipse { order: 2, eccentricity: 0.08, semi_major_axis_mm: None };
    ring_scene(shape, 54, 16, operations)
}

/// The flank of a round ring is the involute of a pinion that fills it: base radius R_p cos(alpha), a tooth of half a
/// pitch in every space. Distance of a point from it, along its normal.
fn distance_mm(point_mm: DVec2, space: u32, side: Side) -> f64 {
    let flank =
        Involute { base_radius_mm: 60.0 * ALPHA_RAD.cos(), half_angle_rad: PI / 120.0 + inv(ALPHA_RAD), side: 1.0 };
    let roll = flank.roll_at_radius(point_mm.length());
    // The left flank of a tooth lies at the smaller arc of its space.
    let angle = -side.sign() * (point_mm.to_angle() - f64::from(space) * TAU / 60.0);
    flank.base_radius_mm * (angle + roll - roll.atan() - flank.half_angle_rad)
}

#[test]
fn the_flank_of_a_round_ring_is_the_internal_involute() {
    let job = job(round_ring(vec![operation("finish", NORMAL, 0.0, 6000)]));
    let mut worst_mm = 0.0_f64;
    let mut cut_mm = [f64::INFINITY, f64::NEG_INFINITY];
    for (tooth, side, space) in [(1, Side::Left, 1), (1, Side::Right, 0), (8, Side::Left, 8), (14, Side::Right, 13)] {
        let flank = job.target_flank(tooth, side);
        for i in 0..=100 {
            let contact = flank.at_arc(flank.length_mm() * f64::from(i) / 100.0);
            worst_mm = worst_mm.max(distance_mm(contact.point_mm, space, side).abs());
        }
        // What 100 strokes a tooth leave stands over it by the scallops alone.
        let cut = job.cut(&Cpu::default(), job.flank_field(flank)).expect("cut");
        for (column, ray) in cut.field.columns.iter().enumerate().skip(4) {
            // Near its base the cutter is curved sharply, and scallops grow.
            if flank.at_arc(ray.arc_mm).roll < 0.1 {
                continue;
            }
            let height_mm = f64::from(cut.layers[0].column(column, cut.field.rows())[0]);
            let over_mm = -distance_mm(ray.origin_mm + height_mm * ray.normal, space, side);
            cut_mm = [cut_mm[0].min(over_mm.abs()), cut_mm[1].max(over_mm.abs())];
        }
    }
    println!("target {worst_mm:.2e} mm off the involute, cut surface at most {:.2e} mm", cut_mm[1]);
    assert!(worst_mm < 1e-11 && cut_mm[1] < 2e-5);
}

/// Height of the scallop between two strokes whose pitch points lie `feed_mm` apart, at the pitch point of a flank.
fn pitch_scallop_mm(job: &ShapingJob, tooth: u32, side: Side, feed_mm: f64) -> f64 {
    let flank = job.target_flank(tooth, side);
    let crossing = flank.pitch_crossing(&job.blank).expect("it crosses");
    let arc_mm = job.curve.arc_mm(crossing.phi_rad);
    let strokes_around = StrokeSet::new(0, &job.cutter, StrokeLaw::Frozen, 2, |lambda| {
        let pose = job.finishing().linkage.pose(job.curve.phi_at_arc(arc_mm + (lambda - 0.5) * feed_mm), 0.0);
        Rigid2::new(pose.angle_rad, pose.center_mm)
    });
    let pitch_arc_mm = flank.at_height(&job.blank, 0.0).expect("it crosses").0;
    let arcs = (0..4000).map(|i| pitch_arc_mm + 0.1 * feed_mm * (f64::from(i) / 2000.0 - 1.0));
    let field = job.field_over(flank, arcs, vec![-10.0, 10.0]);
    let mut layer = field.blank_layer();
    let plan = CutPlan::new(&field, &strokes_around, &job.cutter);
    Cpu::default().cut(&field, &plan, &mut layer).expect("native");
    cusps(&facets(&field, &layer, 0)).iter().map(|c| c.height_mm).fold(f64::INFINITY, f64::min)
}

/// h = (f^2 sin(alpha) / 8) (1 / r_c - 1 / R_p) at the pitch point, with the arc f between two strokes.
#[test]
fn scallops_follow_the_law_of_internal_gearing() {
    for (strokes, side) in [(2400, Side::Left), (2400, Side::Right), (4800, Side::Left)] {
        let mut scene = round_ring(vec![operation("finish", NORMAL, 0.0, strokes)]);
        scene.fields = Fields { profile_spacing_mm: 0.4 / f64::from(strokes), lead_spacing_mm: 20.0, ..scene.fields };
        scene.gear.addendum_coefficient = 0.15;
        let feed_mm = 60.0 * TAU / f64::from(strokes);
        let found = pitch_scallop_mm(&job(scene), 3, side, feed_mm);
        let law = feed_mm * feed_mm * ALPHA_RAD.sin() / 8.0 * (1.0 / 20.0 - 1.0 / 60.0);
        println!("{strokes} strokes: {:.5} um, law {:.5} um", 1e3 * found, 1e3 * law);
        assert!((found / law - 1.0).abs() < 0.005, "{found} against {law}");
    }
}

/// Rows of the table in docs/internal.md: what strokes leave at the pitch point of the paper's ring, tooth 9, against
/// the law with the curvature of the pitch curve there, and against the roughness that is printed.
#[test]
fn strokes_of_the_papers_ring_leave_what_the_docs_say() {
    let job = job(ring_scene(mate_shape(None), 102, 13, vec![operation("finish", NORMAL, 0.0, 6120)]));
    for (per_tooth, documented_um) in [(60, 0.030), (20, 0.27), (7, 2.2)] {
        let feed_mm = 2.0 * PI / f64::from(per_tooth);
        let flank = job.target_flank(9, Side::Left);
        let phi_rad = flank.pitch_crossing(&job.blank).expect("it crosses").phi_rad;
        let bent_per_mm = 1.0 / 13.0 - job.curve.frame(phi_rad).curvature_per_mm;
        let law_um = 1e3 * feed_mm * feed_mm * ALPHA_RAD.sin() / 8.0 * bent_per_mm;
        let found_um = 1e3 * pitch_scallop_mm(&job, 9, Side::Left, feed_mm);
        println!("{per_tooth} strokes a tooth: {found_um:.5} um, law {law_um:.5} um");
        // The law is the first term of a series in f / r_c: at 7 strokes a tooth, f is a fifteenth of r_c.
        assert!((found_um / law_um - 1.0).abs() < 0.005_f64.max(0.5 * (feed_mm / 13.0).powi(2)), "{found_um}");
        assert!((found_um / documented_um - 1.0).abs() < 0.03, "{found_um} um, the docs say {documented_um}");
        // Ra of parabolas of the height h is 4 h / (9 sqrt(3)): below the printed 0.7 um in every row.
        assert!(4.0 * found_um / (9.0 * 3_f64.sqrt()) < 0.7);
    }
}

/// Candidates against all passes: every height and pass, on flanks and a root, roughing and finishing.
#[test]
fn candidates_equal_brute_force_in_a_ring() {
    for feed_during_stroke in [false, true] {
        let mut operations = vec![operation("rough", TRADITIONAL, 0.4, 300), operation("finish", NORMAL, 0.0, 720)];
        operations[1].revolutions = 2;
        for operation in &mut operations {
            operation.feed_during_stroke = feed_during_stroke;
        }
        let mut scene = oval_ring(operations);
        scene.fields = Fields { profile_spacing_mm: 0.02, lead_spacing_mm: 5.0, ..scene.fields };
        let job = job(scene);
        let mut fields: Vec<_> = [(1, Side::Left), (6, Side::Right), (11, Side::Left)]
            .map(|(tooth, side)| job.flank_field(job.target_flank(tooth, side)))
            .into();
        fields.push(job.root_field(4));
        for field in &fields {
            for operation in &job.operations {
                let cut = |plan: &CutPlan| {
                    let mut layer = field.blank_layer();
                    Cpu::default().cut(field, plan, &mut layer).expect("native");
                    (layer.heights_mm.iter().map(|h| h.to_bits()).collect::<Vec<_>>(), layer.passes)
                };
                let plan = CutPlan::new(field, &operation.strokes, &job.cutter);
                let brute = CutPlan::brute_force(field, &operation.strokes, &job.cutter);
                assert!(brute.records.len() > 2 * plan.records.len());
                let (found, all) = (cut(&plan), cut(&brute));
                assert!(found == all, "{}", operation.spec.name);
                assert!(all.1.iter().any(|&pass| pass != NO_PASS));
            }
        }
    }
}

/// A last tile of a single column has no width that would hide a box that is too small by some nanometres: the pass
/// that the tile before told of was lost.
#[test]
fn a_column_alone_in_its_tile_is_cut_as_by_all_passes() {
    let path = std::path::Path::new("scenes/shaping/internal_interfering.toml");
    let job = job(gearcut::process::load(path, &[]).expect("a shipped scene").scene);
    let strokes = &job.finishing().strokes;
    let mut compared = 0;
    for (tooth, side) in [(3, Side::Right), (3, Side::Left), (20, Side::Right)] {
        let flank = job.target_flank(tooth, side);
        for last in (0..40).map(|i| 3.80187 - 0.0437 * f64::from(i)) {
            let field = job.field_over(flank, (0..17).map(|i| last - 0.005 * f64::from(16 - i)), vec![-8.0]);
            let cut = |plan: &CutPlan| {
                let mut layer = field.blank_layer();
                Cpu::default().cut(&field, plan, &mut layer).expect("native");
                (layer.heights_mm.iter().map(|h| h.to_bits()).collect::<Vec<_>>(), layer.passes)
            };
            let plan = CutPlan::new(&field, strokes, &job.cutter);
            assert_eq!(plan.tiles.last().expect("tiles").columns, 16..17);
            let brute = CutPlan::brute_force(&field, strokes, &job.cutter);
            assert!(cut(&plan) == cut(&brute), "tooth {tooth} {side:?}, {last} mm");
            compared += 1;
        }
    }
    assert_eq!(compared, 120);
}

fn cut(job: &ShapingJob) -> CutBlank {
    let field = job.planar().blank_field().expect("fits in memory");
    job.cut_blank(&Cpu::default(), field, &|| true).expect("the native backend").expect("not stopped")
}

#[test]
fn the_blank_of_a_ring_is_cut_to_its_target_and_no_further() {
    let mut scene = oval_ring(vec![operation("rough", NORMAL, 0.5, 360), operation("finish", NORMAL, 0.0, 1440)]);
    scene.fields.blank_spacing_mm = 0.1;
    let job = job(scene);
    let cut = cut(&job);
    let target = job.target_outline(0.0, 0.02).expect("ordinary teeth");
    let report = blank_report::measure(&job.planar(), &cut, std::slice::from_ref(&target));
    assert!(report.gouges.is_empty() && report.interference.is_empty(), "{:?}", report.gouges);
    let lone = crate::fixtures::stroke_faults::lone_strokes(&job.planar(), &cut, &report);
    assert!(lone.is_empty(), "{lone:?}");
    assert!(report.operations.iter().all(|of| of.imbalance() < 1e-9));
    let face = report.end_face.expect("known");
    for f in 0..2 {
        let off_mm2 = (face.cut_mm2[f] - face.target_mm2).abs();
        println!("{:.3} mm2 cut, {:.3} mm2 target, bound {:.3}", face.cut_mm2[f], face.target_mm2, face.bound_mm2[f]);
        assert!(off_mm2 < face.bound_mm2[f]);
    }
    // Ends that a pass left lie on the target or over it by the scallops.
    let slice = &cut.field.slices[0];
    let (mut low_mm, mut high_mm) = (f64::INFINITY, f64::NEG_INFINITY);
    for (f, family) in FAMILIES.into_iter().enumerate() {
        for (ray, spans) in slice.rays[f].iter().enumerate() {
            let ends = spans.iter().flat_map(|span| [span.low, span.high]).filter(|end| end.pass != NO_PASS);
            for end in ends {
                let place = family.point(end.at_mm, cut.field.grid.rows[f].at_mm(ray));
                // Into the material the distance is negative: an end outside the target is material that is left.
                let over_mm = target.distance_mm(place, 1.0).expect("near");
                (low_mm, high_mm) = (low_mm.min(over_mm), high_mm.max(over_mm));
                let normal = DVec2::from_array(end.normal.map(f64::from));
                let outside = target.distance_mm(place + 0.05 * normal, 1.0).expect("near");
                assert!(outside > over_mm, "the normal of {place} looks into the ring");
            }
        }
    }
    println!("ends {:.3} to {:.3} um over the target", 1e3 * low_mm, 1e3 * high_mm);
    // Scallops are highest near the cutter's base, where its involute is curved most sharply.
    assert!(low_mm > -2e-4 && high_mm < 1e-2);
    let mesh = BlankMesh::new(&cut.field, None).mesh;
    assert!(mesh.is_closed(), "{:?}", mesh.edge_faults());
    // A cutter pushed 0.05 mm too deep gouges.
    let mut deep = oval_ring(vec![operation("finish", NORMAL, -0.05, 360)]);
    deep.fields.blank_spacing_mm = 0.2;
    let deep = self::job(deep);
    let report = blank_report::measure(&deep.planar(), &self::cut(&deep), std::slice::from_ref(&target));
    let deepest = report.gouges.iter().map(|gouge| gouge.depth_mm).fold(0.0, f64::max);
    assert!((0.01..0.051).contains(&deepest), "{deepest}");
}

/// The paper's ring: the closed form behind the cutter's base holds what the strokes leave of the tips.
#[test]
fn relieved_tips_are_no_gouges() {
    let mut scene = paper_ring(2040);
    scene.fields.blank_spacing_mm = 0.2;
    let job = job(scene);
    let cut = cut(&job);
    let target = job.target_outline(0.0, 0.02).expect("the base is followed");
    let report = blank_report::measure(&job.planar(), &cut, std::slice::from_ref(&target));
    assert!(report.gouges.is_empty(), "{:?}", report.gouges);
    let face = report.end_face.expect("known");
    assert!((face.cut_mm2[0] - face.target_mm2).abs() < face.bound_mm2[0]);
}

#[test]
fn blank_candidates_leave_the_same_bits_as_all_passes_in_a_ring() {
    let mut scene = oval_ring(vec![operation("finish", NORMAL, 0.0, 240)]);
    scene.fields.blank_spacing_mm = 0.6;
    let job = job(scene);
    let reach_mm = BlankOutline::new(&job.blank).reach_mm();
    let strokes = &job.operations[0].strokes;
    let teeth = job.planar().closed_teeth(strokes, reach_mm);
    let returns = job.return_strokes(0);
    let cut = |cull| {
        let mut field = job.planar().blank_field().expect("fits");
        let operation = BlankOperation {
            strokes,
            returns: returns.as_ref(),
            tool: &job.cutter,
            teeth: &teeth,
            blank_reach_mm: reach_mm,
            cull,
        };
        let done = blank::cut(&mut field, &operation, &|| true).expect("not stopped");
        (field, done.removed_mm3, done.rubs)
    };
    let (culled, all) = (cut(true), cut(false));
    assert!(culled == all);
    assert!(culled.1.iter().filter(|pass| pass[0] > 0.0).count() > 200);
}

#[test]
fn the_section_of_a_ring_equals_polygon_clipping_of_the_same_strokes() {
    let mut scene = oval_ring(vec![operation("finish", NORMAL, 0.0, 180)]);
    scene.fields.blank_spacing_mm = 0.1;
    let job = job(scene);
    let field = cut(&job).field;
    let polygon = TargetOutline::new(clipped(&job), job.blank.back);
    let mut worst_mm = 0.0_f64;
    for (f, family) in FAMILIES.into_iter().enumerate() {
        for (ray, spans) in field.slices[0].rays[f].iter().enumerate() {
            let ends = spans.iter().flat_map(|span| [span.low, span.high]).filter(|end| end.pass != NO_PASS);
            let places = ends.map(|end| family.point(end.at_mm, field.grid.rows[f].at_mm(ray)));
            let off = places.map(|place| polygon.distance_mm(place, 1.0).expect("near").abs());
            worst_mm = worst_mm.max(off.fold(0.0, f64::max));
        }
    }
    println!("ends of rays at most {:.1} nm off the clipped outline", 1e6 * worst_mm);
    assert!(worst_mm < 1e-4);
}

#[test]
fn other_numbers_of_threads_leave_the_same_bytes() {
    let mut scene = oval_ring(vec![operation("rough", TRADITIONAL, 0.4, 200), operation("finish", NORMAL, 0.0, 360)]);
    scene.fields = Fields { profile_spacing_mm: 0.05, lead_spacing_mm: 5.0, blank_spacing_mm: 0.5, ..scene.fields };
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let job = job(scene.clone());
            let flank = job.cut(&Cpu::default(), job.flank_field(job.target_flank(5, Side::Left))).expect("cut");
            (cut(&job), flank.layers)
        })
    };
    let (one, three) = (run(1), run(3));
    assert!(one.0 == three.0 && one.1 == three.1);
}

#[test]
fn the_body_of_a_ring_is_closed_and_as_large_as_its_blank() {
    let mut scene = oval_ring(vec![operation("rough", NORMAL, 0.4, 360), operation("finish", NORMAL, 0.0, 1080)]);
    scene.fields = Fields { profile_spacing_mm: 0.02, lead_spacing_mm: 10.0, blank_spacing_mm: 0.1, ..scene.fields };
    let job = job(scene);
    let backend = Cpu::default();
    let surface = |field| {
        let cut = job.cut(&backend, field).expect("cut");
        SurfaceGrid::new(&cut.field, &cut.layers, 0.1)
    };
    let sides = (1..=54).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]);
    let flanks = sides.map(|(tooth, side)| surface(job.flank_field(job.target_flank(tooth, side)))).collect();
    let roots = (1..=54).map(|space| surface(job.root_field(space))).collect();
    let surfaces = complete(&job, &backend, flanks, roots, &|| ()).expect("tips");
    let solid = gear_solid(&Outline::new(&surfaces, &job.blank, BODY_MM), &job.blank.back).expect("a closed body");
    assert!(solid.is_closed(), "{:?}", solid.edge_faults());
    assert!(solid.parts.iter().any(|part| part.name == "rim"));
    let volume_mm3 = cut(&job).field.volumes_mm3();
    println!("{:.2} mm3 lofted, {:.2} mm3 on rays", solid.volume_mm3(), volume_mm3[0]);
    assert!((solid.volume_mm3() / volume_mm3[0] - 1.0).abs() < 1e-4);
    // The target as the report shows it: closed, faces outwards.
    let view = ViewMesh::new(&job).expect("a mesh");
    let parts = view.flanks.iter().map(|flank| &flank.triangles).chain([&view.body]);
    let corner = |p: [f32; 3]| glam::DVec3::from_array(p.map(f64::from));
    let shown_mm3: f64 = parts
        .flat_map(|part| part.indices.chunks(3).map(|t| [0, 1, 2].map(|k| corner(part.positions_mm[t[k] as usize]))))
        .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
        .sum();
    // Its points are half a millimetre apart.
    assert!((shown_mm3 / volume_mm3[0] - 1.0).abs() < 1e-2, "{shown_mm3} mm3 shown");
    assert_eq!(job.blank().kind().name(), "internal");
}

#[test]
fn a_program_of_a_ring_reads_back_and_cuts_the_same_gear() {
    let mut finish = operation("finish", NORMAL, 0.0, 720);
    finish.feed_during_stroke = true;
    let mut scene = oval_ring(vec![finish]);
    scene.fields = Fields { profile_spacing_mm: 0.05, lead_spacing_mm: 10.0, ..scene.fields };
    let direct = job(scene.clone());
    let text = programs::text(&direct, &direct.operations[0], &[]).expect("wanted").expect("written");
    let program = read::program(&text).expect("its own program");
    // X runs inside the ring, C against the work angle, B against the rolling of an external cutter.
    let [first, last] = [&program.knots[0], program.knots.last().expect("knots")];
    assert!(program.knots.iter().all(|k| k.center_distance_mm < direct.curve.facts().largest_radius_mm - 14.0));
    let turns = (last.psi_b_rad - first.psi_b_rad) / (last.psi_c_rad - first.psi_c_rad);
    assert!((turns + 54.0 / 16.0).abs() < 0.01, "{turns}");
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), &text).expect("written");
    Shaping::of_mut(&mut scene).expect("shaping").operations[0].program = Some(file.path().to_owned());
    let read = job(scene);
    for (tooth, side) in [(1, Side::Left), (10, Side::Right)] {
        let heights = |job: &ShapingJob| {
            let cut = job.cut(&Cpu::default(), job.flank_field(job.target_flank(tooth, side))).expect("cut");
            cut.layers[0].heights_mm.clone()
        };
        let [ours, theirs] = [&direct, &read].map(heights);
        let worst = ours.iter().zip(&theirs).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
        println!("tooth {tooth}: {worst:.2e} mm off");
        assert!(worst <= 1e-3 && worst > 0.0, "{worst}");
    }
}
