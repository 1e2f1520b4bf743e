//! The blank field against brute force, against the target's closed form, against polygon clipping of the same strokes,
//! and with a hundred injected defects.

use crate::fixtures::clipping::clipped;
use crate::fixtures::command::scenes_of_all_shapes;
use crate::fixtures::paper::*;
use crate::fixtures::stroke_faults::{StrokeFaultKind, lone_strokes};
use gearcut::cut::CutBlank;
use gearcut::cut::cpu::Cpu;
use gearcut::cut::cpu::blank;
use gearcut::cut::{BlankCut, BlankOperation};
use gearcut::dexel::{BlankField, NO_PASS};
use gearcut::frame::Rigid2;
use gearcut::gear::PitchCurveShape;
use gearcut::gear::blank_outline::BlankOutline;
use gearcut::machine_errors::MachineErrors;
use gearcut::math::planar_rays::FAMILIES;
use gearcut::measure::target_outline::TargetOutline;
use gearcut::passes::StrokeSet;
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::scene::model::Shaping;
use gearcut::scene::model::Scene;
use gearcut::steps::planar::blank_report;
use gearcut::steps::planar::blank_report::BlankReport;
use gearcut::surface::BlankMesh;
use glam::DVec2;

/// Points of the target's outline, mm: chords of a fillet of 0.8 mm then miss 0.25 um, a quarter of the least damage
/// that is reported.
const TARGET_SPACING_MM: f64 = 0.04;

fn job(scene: Scene) -> ShapingJob {
    ShapingJob::new(scene).expect("a scene that cuts")
}

fn cut(job: &ShapingJob) -> CutBlank {
    job.cut_blank(&Cpu::default(), job.planar().blank_field().expect("fits in memory"), &|| true)
        .expect("the native backend")
        .expect("not stopped")
}

fn target(job: &ShapingJob) -> TargetOutline {
    job.target_outline(0.0, TARGET_SPACING_MM).expect("ordinary teeth")
}

fn report(job: &ShapingJob, cut: &CutBlank) -> BlankReport {
    blank_report::measure(&job.planar(), cut, &[target(job)])
}

/// A round gear of 24 teeth in so many finishing strokes.
fn round_gear(strokes: u32) -> Scene {
    let mut scene = paper_scene(vec![operation("finish", NORMAL, 0.0, strokes)]);
    scene.gear.pitch_curve = PitchCurveShape::Circle;
    scene.gear.teeth = 24;
    scene
}

/// Every end of material that a pass left, with its ray's family.
fn cut_ends(field: &BlankField) -> impl Iterator<Item = DVec2> {
    let rays = field
        .slices
        .iter()
        .flat_map(|slice| (0..2).flat_map(|f| slice.rays[f].iter().enumerate().map(move |(i, r)| (f, i, r))));
    rays.flat_map(|(f, i, ray)| {
        let at_mm = field.grid.rows[f].at_mm(i);
        let ends = ray.iter().flat_map(|span| [span.low, span.high]).filter(|end| end.pass != NO_PASS);
        ends.map(move |end| FAMILIES[f].point(end.at_mm, at_mm))
    })
}

#[test]
fn candidates_leave_the_same_bits_as_all_passes() {
    let mut rubs = 0;
    for (feed_during_stroke, runout_mm) in [(false, 0.05), (true, 0.0)] {
        let mut scene =
            paper_scene(vec![operation("rough", TRADITIONAL, 1.0, 150), operation("finish", NORMAL, 0.0, 150)]);
        Shaping::of_mut(&mut scene).expect("shaping").operations[1].feed_during_stroke = feed_during_stroke;
        Shaping::of_mut(&mut scene).expect("shaping").tool.runout_mm = runout_mm;
        scene.fields.blank_spacing_mm = 0.6;
        scene.fields.blank_slice_spacing_mm = 10.0;
        let job = job(scene);
        let reach_mm = BlankOutline::new(&job.blank).reach_mm();
        let mut fields = [job.planar().blank_field().expect("fits"), job.planar().blank_field().expect("fits")];
        for index in 0..2 {
            let strokes = &job.operations[index].strokes;
            let teeth = job.planar().closed_teeth(strokes, reach_mm);
            let returns = job.return_strokes(index);
            let done: Vec<BlankCut> = [true, false]
                .into_iter()
                .zip(&mut fields)
                .map(|(cull, field)| {
                    let operation = BlankOperation {
                        strokes,
                        returns: returns.as_ref(),
                        tool: &job.cutter,
                        teeth: &teeth,
                        blank_reach_mm: reach_mm,
                        cull,
                    };
                    blank::cut(field, &operation, &|| true).expect("not stopped")
                })
                .collect();
            assert!(done[0].removed_mm3 == done[1].removed_mm3 && done[0].rubs == done[1].rubs);
            rubs += done[0].rubs.len();
            assert!(done[0].stats.removing == done[1].stats.removing && done[0].stats.removing > 1000);
            assert!(done[0].stats.visited <= done[1].stats.visited);
        }
        assert_eq!(fields[0].slices.len(), if feed_during_stroke { 4 } else { 1 });
        assert!(fields[0] == fields[1]);
        // The comparison can fail: one stroke less leaves other bits.
        let mut fewer = job;
        let list: Vec<Stroke> =
            (0..150).filter(|&i| i != 75).map(|i| Stroke { at: f64::from(i), push_mm: 0.0 }).collect();
        replace_strokes(&mut fewer, 1, &list);
        assert!(cut(&fewer).field != fields[0]);
    }
    assert!(rubs > 100, "{rubs} rays rub on the way back");
}

/// A stroke of a faulty machine: where in the schedule, and how much too deep.
#[derive(Clone, Copy)]
struct Stroke {
    at: f64,
    push_mm: f64,
}

/// Gives an operation other strokes; later ones are counted on from them.
fn replace_strokes(job: &mut ShapingJob, operation: usize, strokes: &[Stroke]) {
    let mut first_pass = job.operations[operation].strokes.first_pass;
    for index in operation..job.operations.len() {
        let prepared = &job.operations[index];
        let law = prepared.strokes.law;
        let own: Vec<Stroke> = (0..prepared.strokes.count()).map(|i| Stroke { at: i as f64, push_mm: 0.0 }).collect();
        let list = if index == operation { strokes } else { &own };
        let set = StrokeSet::new(first_pass, &job.cutter, law, list.len(), |lambda| {
            let whole = lambda.round();
            let stroke = list[whole as usize];
            let pose = prepared.schedule.state(stroke.at + lambda - whole).pose;
            let push = pose.center_mm.normalize() * stroke.push_mm;
            Rigid2::new(pose.angle_rad, pose.center_mm - push)
        });
        first_pass = set.end_pass();
        job.operations[index].strokes = set;
    }
}

#[test]
fn volumes_balance_and_sections_are_the_targets() {
    let scene = paper_scene(vec![operation("rough", NORMAL, 2.0, 4200), operation("finish", NORMAL, 0.0, 4200)]);
    let job = job(scene);
    let mut cut = cut(&job);
    let clean = report(&job, &cut);
    println!("{clean:?}");
    for operation in &clean.operations {
        assert!(operation.imbalance() < 1e-10, "{:e}", operation.imbalance());
    }
    let end_face = clean.end_face.expect("ordinary teeth");
    for f in 0..2 {
        let off_mm2 = end_face.cut_mm2[f] - end_face.target_mm2;
        println!("family {f}: {off_mm2:.4} mm2 off the target, bound {:.1}", end_face.bound_mm2[f]);
        // Strokes leave more than the target, most of it in the fillets, where a sharp corner leaves teeth of some
        // micrometres; the rest is what rays 0.1 mm apart miss.
        assert!(off_mm2.abs() < end_face.bound_mm2[f] && (0.0..0.5).contains(&off_mm2));
    }
    assert!(clean.gouges.is_empty() && clean.interference.is_empty());
    assert!(lone_strokes(&job.planar(), &cut, &clean).is_empty());
    // A ledger without one pass is out of balance.
    let passes = &mut cut.cuts[1].removed_mm3;
    let dropped = passes.iter().position(|pass| pass[0] > 0.1).expect("some pass cuts");
    passes[dropped] = [0.0; 2];
    assert!(report(&job, &cut).operations[1].imbalance() > 1e-6);
}

#[test]
fn surfaces_lie_on_the_target() {
    // Rounded corners leave no teeth in the fillets; at 4,200 strokes nothing stands more than 0.2 um over the target,
    // and nothing lies below it but the chords of the target's own fillets.
    let mut scene = paper_scene(vec![operation("finish", NORMAL, 0.0, 4200)]);
    Shaping::of_mut(&mut scene).expect("shaping").tool.tip =
        gearcut::process::shaping::scene::model::Tip::Round { radius_mm: 0.6 };
    scene.fields.blank_spacing_mm = 0.2;
    let job = job(scene);
    let target = job.target_outline(0.0, 0.02).expect("ordinary teeth");
    let cut = cut(&job);
    let heights: Vec<f64> = cut_ends(&cut.field).map(|p| target.distance_mm(p, 3.0).expect("near")).collect();
    let low = heights.iter().copied().fold(0.0, f64::min);
    let high = heights.iter().copied().fold(0.0, f64::max);
    println!("{} places, {:.1} to {:.1} nm over the target", heights.len(), 1e6 * low, 1e6 * high);
    assert!(heights.len() > 3000 && low > -1e-4 && high < 5e-4);
}

#[test]
fn sections_equal_polygon_clipping_of_the_same_strokes() {
    let job = job(round_gear(240));
    let cut = cut(&job);
    let polygon = TargetOutline::new(clipped(&job), job.blank.back);
    let ends = cut_ends(&cut.field).map(|p| polygon.distance_mm(p, 1.0).expect("near").abs()).fold(0.0, f64::max);
    // Chords of 0.02 mm on the cutter stand 5 to 60 nm off it; nothing else differs.
    println!("ends of rays at most {:.1} nm off the clipped outline", 1e6 * ends);
    assert!(ends < 1e-4);
    // Between the rays: the mesh's contour against the clipped outline, both ways. Cusps between rays are what a grid
    // of 0.1 mm cannot hold; within 0.5 of half a cell.
    let mesh = BlankMesh::new(&cut.field, None).mesh;
    let rim: Vec<DVec2> = mesh.positions_mm.iter().filter(|p| p.z < 0.0).map(|p| p.truncate()).collect();
    let outer = |p: &&DVec2| p.length() > 20.0;
    let off = rim.iter().filter(outer).map(|&p| polygon.distance_mm(p, 1.0).expect("near").abs()).fold(0.0, f64::max);
    let half_cell_mm = 0.5 * cut.field.grid.spacing_mm();
    println!("contour at most {:.2} um off, {:.3} of half a cell", 1e3 * off, off / half_cell_mm);
    assert!(off < 0.5 * half_cell_mm);
    // Area: both against the outline's.
    let bore_mm2 = std::f64::consts::PI * 100.0;
    let area_mm2 = polygon.area_mm2().abs() - bore_mm2;
    let [x, y] = cut.field.areas_mm2()[0];
    println!(
        "area {area_mm2:.4}, rays {:.4} and {:.4} off, mesh {:.4}",
        x - area_mm2,
        y - area_mm2,
        mesh.volume_mm3() / 30.0 - area_mm2
    );
    assert!((x - area_mm2).abs() < 0.2 && (y - area_mm2).abs() < 0.2);
}

#[test]
fn fields_beyond_memory_are_refused_with_a_spacing_that_fits() {
    let mut scene = machine_scene();
    scene.fields.blank_spacing_mm = 0.001;
    scene.fields.blank_slice_spacing_mm = 0.5;
    Shaping::of_mut(&mut scene).expect("shaping").operations[1].feed_during_stroke = true;
    let refusal = job(scene.clone()).planar().blank_grid().expect_err("a thousand million spans");
    assert_eq!(refusal.key, "spacing of the blank's rays");
    assert!(refusal.problem.contains("61 slices") && refusal.problem.contains("bytes"), "{refusal}");
    let fits = refusal.way_out.split(' ').find_map(|word| word.parse::<f64>().ok()).expect("a spacing");
    scene.fields.blank_spacing_mm = fits;
    assert!(job(scene.clone()).planar().blank_grid().is_ok());
    scene.fields.blank_spacing_mm = 0.9 * fits;
    assert!(job(scene).planar().blank_grid().is_err());
}

/// The elliptical gear, 1,440 strokes in both operations.
fn machine_scene() -> Scene {
    paper_scene(vec![operation("rough", NORMAL, 2.0, 1440), operation("finish", NORMAL, 0.0, 1440)])
}

/// How many teeth lie between the pitch point of a stroke and a tooth.
fn teeth_away(job: &ShapingJob, operation: usize, at: f64, tooth: u32) -> f64 {
    let phi = job.operations[operation].schedule.state(at).phi_rad;
    let pitch_point = job.curve.arc_mm(phi) / job.curve.perimeter_mm() * 42.0;
    let away = (pitch_point - f64::from(tooth) + 0.5).rem_euclid(42.0);
    away.min(42.0 - away)
}

#[test]
fn gouges_are_found_and_named() {
    // Faults of strokes and cutter do not change the target.
    let target = target(&job(machine_scene()));
    let half_cell_mm = 0.05;
    let mut found = 0;
    for run in 0..3_u32 {
        let mut job = job(machine_scene());
        let operation = usize::from(run != 1);
        let faulty: Vec<u32> = (0..10).map(|k| 41 + 137 * k + 11 * run).collect();
        // Half a cell and more; an earlier operation has to pass its own allowance of 2 mm first.
        let depth = |k: u32| f64::from(k) * 0.02 + if operation == 1 { half_cell_mm } else { 2.0 + half_cell_mm };
        let list: Vec<Stroke> = (0..1440)
            .map(|at| {
                let push_mm = faulty.iter().position(|&f| f == at).map_or(0.0, |k| depth(k as u32));
                Stroke { at: f64::from(at), push_mm }
            })
            .collect();
        replace_strokes(&mut job, operation, &list);
        let cut = cut(&job);
        let report = blank_report::measure(&job.planar(), &cut, std::slice::from_ref(&target));
        let lone = lone_strokes(&job.planar(), &cut, &report);
        let damage = if operation == 1 { &report.gouges } else { &report.interference };
        let other = if operation == 1 { &report.interference } else { &report.gouges };
        for (k, &at) in faulty.iter().enumerate() {
            let made: Vec<_> = damage.iter().filter(|d| d.stroke == at as usize).collect();
            assert!(!made.is_empty(), "run {run}: stroke {at} is not found");
            let deepest = made.iter().map(|d| d.depth_mm).fold(0.0, f64::max);
            let excess_mm = depth(k as u32) - if operation == 1 { 0.0 } else { 2.0 };
            // An earlier operation stands back along the normal; pushed along the line of centres it comes in beside
            // its own place.
            assert!(operation == 0 || deepest <= 1.001 * excess_mm, "run {run}: {deepest} of {excess_mm}");
            // A tenth of it at least shows: where the tip does not reach the root, the flanks take the sine of the
            // pressure angle.
            assert!(deepest >= 0.1 * excess_mm, "run {run}: {deepest} of {excess_mm}");
            assert!(made.iter().all(|d| teeth_away(&job, operation, f64::from(at), d.place.tooth) <= 2.5));
            found += 1;
        }
        assert!(damage.iter().all(|d| faulty.contains(&(d.stroke as u32))), "run {run}: {damage:?}");
        assert!(other.is_empty() && lone.is_empty(), "run {run}: {lone:?}");
    }
    assert_eq!(found, 30);
}

mod slow {
    use super::*;

    #[test]
    fn meshes_of_all_shapes_are_closed() {
        for path in scenes_of_all_shapes() {
            let mut scene = load(&path, &[]).unwrap_or_else(|errors| panic!("{errors}")).scene;
            scene.fields.blank_slice_spacing_mm = 15.0;
            scene.fields.blank_spacing_mm *= 2.0;
            let name = scene.name.clone();
            let job = job(scene);
            let cut = cut(&job);
            let BlankMesh { mesh, guessed } = BlankMesh::new(&cut.field, None);
            let volume_mm3 = mesh.volume_mm3();
            let [x, y] = cut.field.volumes_mm3();
            // The cutter's base shapes the tips of one scene: there is no target in closed form, and nothing to damage.
            // Sections of a helical gear differ from slice to slice.
            let slices_z_mm: &[f64] = if job.helix.is_some() { &cut.field.grid.slices_z_mm } else { &[0.0] };
            let targets = slices_z_mm.iter().map(|&z_mm| job.target_outline(z_mm, TARGET_SPACING_MM).ok());
            let targets: Option<Vec<_>> = targets.collect();
            let base_shapes_tips = name == "fourier_concave";
            assert_eq!(targets.is_none(), base_shapes_tips, "{name}");
            let report = blank_report::measure(&job.planar(), &cut, &targets.unwrap_or_default());
            let lone = lone_strokes(&job.planar(), &cut, &report);
            println!(
                "{name}: {} slices, {} triangles, {guessed} guessed, volume {:.5} of the rays', {} gouges, {} \
                interference, {} rubs, faults {:?}",
                cut.field.slices.len(),
                mesh.triangles.len(),
                2.0 * volume_mm3 / (x + y),
                report.gouges.len(),
                report.interference.len(),
                report.rubbing.len(),
                lone,
            );
            assert!(mesh.is_closed(), "{name}: {:?}", mesh.edge_faults());
            assert!((2.0 * volume_mm3 / (x + y) - 1.0).abs() < 1e-3, "{name}");
            assert_eq!(guessed, 0, "{name}");
            // A cutter that runs out by 5 um gouges as deep as that, and no deeper but for the target's chords; so do
            // the errors of one scene's machine, all of them together by less than 50 um; nothing else does.
            let errors = job.machine.errors != MachineErrors::default();
            let runout_mm = if errors { 0.05 } else { job.cutter_spec.runout_mm };
            let damage = || report.gouges.iter().chain(&report.interference);
            assert_eq!(damage().count() > 0, runout_mm > 0.0, "{name}");
            assert!(damage().all(|d| d.depth_mm < runout_mm + 5e-4), "{name}: {:?}", damage().collect::<Vec<_>>());
            assert!(lone.is_empty(), "{name}: {lone:?}");
        }
    }

    #[test]
    fn shifted_teeth_are_found_and_named() {
        // Faults of strokes and cutter do not change the target.
        let target = target(&job(machine_scene()));
        for run in 0..4_u32 {
            let mut scene = machine_scene();
            let blade = (3 * run + 1) % 20;
            let shift_mm = if run % 2 == 0 { 0.05 } else { -0.05 } * (1.0 + f64::from(run) / 10.0);
            Shaping::of_mut(&mut scene).expect("shaping").tool.pitch_errors_mm =
                (0..20).map(|b| if b == blade { shift_mm } else { 0.0 }).collect();
            let job = job(scene);
            let cut = cut(&job);
            let report = blank_report::measure(&job.planar(), &cut, std::slice::from_ref(&target));
            let lone = lone_strokes(&job.planar(), &cut, &report);
            // Cutter tooth b cuts the spaces b, b + 20, b + 40 of 42 in turn against its own count: each of them is
            // damaged on one side, as deep as the shift along the flank's normal.
            assert!(!report.gouges.is_empty(), "run {run}");
            let teeth: std::collections::BTreeSet<u32> = report.gouges.iter().map(|d| d.place.tooth).collect();
            assert!((2..=3).contains(&teeth.len()), "run {run}: teeth {teeth:?}");
            assert!(report.gouges.iter().all(|d| d.blade == blade), "run {run}: {:?}", report.gouges);
            let deepest = report.gouges.iter().map(|d| d.depth_mm).fold(0.0, f64::max);
            let normal_mm = shift_mm.abs() * 20_f64.to_radians().cos();
            assert!((0.8..1.3).contains(&(deepest / normal_mm)), "run {run}: {deepest} of {normal_mm}");
            assert!(lone.is_empty() && report.interference.is_empty(), "run {run}: {lone:?}");
        }
    }

    #[test]
    fn missing_and_doubled_strokes_are_found_and_named() {
        // Faults of strokes and cutter do not change the target.
        let target = target(&job(machine_scene()));
        let mut found = 0;
        for run in 0..6_u32 {
            let mut job = job(machine_scene());
            let operation = (run % 2) as usize;
            let doubled = run >= 3;
            // Ten strokes, more than three teeth apart; the last tooth pitch of the turn meets what the first strokes
            // cut and leaves no trace of a stroke.
            let faulty: Vec<u32> = (0..10).map(|k| 37 + 131 * k + 7 * run).collect();
            let mut list = Vec::new();
            for at in 0..1440 {
                let copies = match (faulty.contains(&at), doubled) {
                    (true, false) => 0,
                    (true, true) => 2,
                    _ => 1,
                };
                list.extend(std::iter::repeat_n(Stroke { at: f64::from(at), push_mm: 0.0 }, copies));
            }
            replace_strokes(&mut job, operation, &list);
            let cut = cut(&job);
            let report = blank_report::measure(&job.planar(), &cut, std::slice::from_ref(&target));
            let lone = lone_strokes(&job.planar(), &cut, &report);
            assert_eq!(lone.len(), 10, "run {run}: {lone:?}");
            for (k, (fault, &at)) in lone.iter().zip(&faulty).enumerate() {
                // Strokes are numbered as the machine made them.
                let shift = if doubled { k + 1 } else { 0 };
                let expected = if doubled { at as usize + shift } else { at as usize - k };
                assert_eq!((fault.operation, fault.fault.stroke), (operation, expected), "run {run}: {fault:?}");
                let kind = if doubled { StrokeFaultKind::Doubled } else { StrokeFaultKind::MissingBefore };
                assert_eq!(fault.fault.kind, kind);
                let away = teeth_away(&job, operation, f64::from(at), fault.space);
                assert!(away <= 2.5, "run {run}: {fault:?} is {away} teeth from the pitch point");
                found += 1;
            }
            assert!(report.gouges.is_empty() && report.interference.is_empty());
        }
        assert_eq!(found, 60);
    }
}
