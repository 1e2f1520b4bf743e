//! The whole blank on rays: volumes against closed forms, a test of points in the tool's frame and the ledger of chips;
//! passes near a row against all passes; the device against the native backend; the closed body.

use super::jobs::job;
use crate::fixtures::layers::{frames_apart_mm, same_but_for_frames};
use gearcut::bevel::face_mill::{BladeKind, FaceMill};
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::Layer;
use gearcut::frame::Rigid3;
use gearcut::interrupt::Interrupt;
use gearcut::passes::{SweepPlan, TurningPasses};
use gearcut::process::bevel::BevelJob;
use gearcut::process::bevel::blank::{self, CellGrid, CutCells};
use gearcut::process::bevel::body::body;
use gearcut::process::bevel::chips::{self, SlotLedger};
use gearcut::process::bevel::job::index;
use gearcut::process::bevel::slots::Slots;
use gearcut::progress::{Progress, ProgressMode};
use gearcut::terms::Side;
use glam::{DMat3, DVec2, DVec3};
use std::cell::Cell;
use std::f64::consts::TAU;

const SIDES: [Side; 2] = [Side::Left, Side::Right];
const COARSE: [&str; 2] = ["fields.blank.spacing_mm=0.2", "fields.blank.slice_spacing_mm=3"];

fn coarse(scene: &str, more: &[&str]) -> BevelJob {
    job(scene, &[&COARSE[..], more].concat()).expect("a gear")
}

fn whole(job: &BevelJob) -> CutCells {
    blank::cut(job, &Cpu::default(), &Progress::new(ProgressMode::Quiet), &Interrupt::default())
        .expect("cuts")
        .expect("not stopped")
}

fn ledger(job: &BevelJob, grid: &CellGrid, slot: u32) -> SlotLedger {
    chips::measure(job, grid, slot, &Progress::new(ProgressMode::Quiet), &Interrupt::default())
        .expect("cuts")
        .expect("not stopped")
}

/// Volume of the ring's quadrangle turned about the axis (Pappus): between the face cone and `below_mm` under the root
/// cone.
fn ring_mm3(job: &BevelJob, below_mm: f64) -> f64 {
    let blank = &job.blank;
    let [heel, toe] = [blank.outer_cone_distance_mm, blank.outer_cone_distance_mm - blank.face_width_mm];
    let corner = |distance_mm: f64, height_mm: f64| blank.axial_mm([distance_mm, height_mm]);
    let section = [
        corner(toe, -blank.dedendum_mm(toe) - below_mm),
        corner(heel, -blank.dedendum_mm(heel) - below_mm),
        corner(heel, blank.addendum_mm(heel)),
        corner(toe, blank.addendum_mm(toe)),
    ];
    // Area times the way of its centre: the integral of radius over the polygon, edge by edge.
    let moment = |i: usize| {
        let (a, b): (DVec2, DVec2) = (section[i], section[(i + 1) % 4]);
        a.perp_dot(b) * (a.y + b.y) / 6.0
    };
    TAU * (0..4).map(moment).sum::<f64>()
}

/// Rays of the uncut blank hold the closed form's volume; what the trapezoidal rule leaves of it falls with the square
/// of the rows' distance.
#[test]
fn the_uncut_ring_has_the_volume_of_its_section() {
    for scene in ["five_linkage_corrected", "crown_pinion"] {
        let job = coarse(scene, &[]);
        let off = |slice_mm: f64| {
            let grid = CellGrid::new(&job, 0.5, slice_mm).expect("rays");
            let found_mm3 = f64::from(job.blank.teeth) * grid.volume_mm3(&job, &grid.field(&job, 0).blank_mm);
            found_mm3 / ring_mm3(&job, -grid.low_mm) - 1.0
        };
        let [coarse, fine] = [4.0, 1.0].map(off);
        println!("{scene}: {coarse:e} and {fine:e} off");
        assert!(coarse.abs() < 1e-3 && fine.abs() < 1e-4, "{scene}: {coarse:e}, {fine:e}");
        assert!(fine.abs() < 0.1 * coarse.abs() + 1e-7, "{scene}: {coarse:e}, {fine:e}");
    }
}

/// Whether any moment of the last operation's roll has a point of space 0, gear frame, between the cones of both kinds
/// of blades and beyond the plane of their tips: closed forms in the tool's frame, without blades and without rays.
fn is_swept(job: &BevelJob, point_mm: DVec3) -> bool {
    const STEPS: u32 = 300;
    let operation = job.finishing();
    let [from, to] = operation.course.range;
    let in_work = job.gear_from_work.inverse().point(point_mm);
    let [outside, inside] = BladeKind::BOTH.map(|kind| job.head.surface(kind));
    (0..=STEPS).any(|i| {
        let moment = from + (to - from) * f64::from(i) / f64::from(STEPS);
        let at = operation.as_set.work_from_tool(moment).inverse().point(in_work);
        let (radius_mm, height_mm) = (at.truncate().length(), -at.z);
        (0.0..=job.head.blade_height_mm).contains(&height_mm)
            && radius_mm < outside.point_radius_mm + height_mm * outside.blade_angle_rad.tan()
            && radius_mm > inside.point_radius_mm - height_mm * inside.blade_angle_rad.tan()
    })
}

/// The slot on rays has the volume that points tell which lie between the head's cones at some moment.
#[test]
fn a_slot_has_the_volume_of_the_points_that_the_head_sweeps() {
    const POINTS: u32 = 12_000;
    for scene in ["five_linkage_corrected", "crown_pinion", "formate"] {
        let job = coarse(scene, &["tool.face_mill.corner_radius_mm=0", "tool.face_mill.runouts_um=[]"]);
        let grid = CellGrid::of_scene(&job).expect("rays");
        let (layers, _) = job.cut_cell(&Cpu::default(), &grid, 0, false).expect("cuts");
        let uncut = grid.field(&job, 0).blank_mm;
        let removed = |heights_mm: &[f32]| grid.volume_mm3(&job, &uncut) - grid.volume_mm3(&job, heights_mm);
        let on_rays_mm3 = removed(&layers.last().expect("an operation").heights_mm);
        // Points spread over the cell by the golden ratio's kin; each stands for its share of the volume.
        let (mut swept_mm3, mut all_mm3) = (0.0, 0.0);
        let toe_mm = job.blank.outer_cone_distance_mm - job.blank.face_width_mm;
        let fine = CellGrid::new(&job, 0.05, 0.1).expect("rays");
        for i in 0..POINTS {
            let share = |step: f64| (f64::from(i) * step + 0.5).fract();
            let distance_mm = toe_mm + job.blank.face_width_mm * share(0.819_172_5);
            let row = ((distance_mm - toe_mm) / job.blank.face_width_mm * (fine.rows() - 1) as f64).round() as usize;
            let column = (share(0.671_043_6) * fine.columns as f64) as usize;
            let (ray, top_mm) = fine.ray(&job, column, row);
            let height_mm = top_mm * share(0.549_700_5);
            let at = ray.at(height_mm);
            let weight = at.truncate().length() * top_mm;
            all_mm3 += weight;
            if is_swept(&job, at) {
                swept_mm3 += weight;
            }
        }
        let pitch_rad = TAU / f64::from(job.blank.teeth);
        let scale = pitch_rad * job.blank.face_width_mm / f64::from(POINTS);
        let off = on_rays_mm3 / (swept_mm3 * scale) - 1.0;
        println!("{scene}: {on_rays_mm3} mm3 on rays, {} by points, {} in all", swept_mm3 * scale, all_mm3 * scale);
        // Twelve thousand points leave some thousandths; rays 3 mm apart along the face about one.
        assert!(off.abs() < 0.008, "{scene}: {off}");
    }
}

/// Chips are summed pass by pass by one code path, what is left comes from all passes at once by another.
#[test]
fn chips_add_up_to_what_is_missing() {
    for (scene, material) in [("five_linkage_corrected", true), ("crown_pinion", false)] {
        let set: &[&str] =
            if material { &["material.name=\"C45\"", "material.cutting_edge_force_n_per_mm=0"] } else { &[] };
        let job = coarse(scene, set);
        let grid = CellGrid::of_scene(&job).expect("rays");
        let slot = 1;
        let found = ledger(&job, &grid, slot);
        let taken_mm3: f64 = found.passes.iter().map(|pass| pass.volume_mm3).sum();
        let missing_mm3 = found.blank_mm3 - found.left_mm3;
        assert!((taken_mm3 / missing_mm3 - 1.0).abs() < 1e-9, "{taken_mm3} of {missing_mm3} mm3");
        let (layers, _) = job.cut_cell(&Cpu::default(), &grid, slot, false).expect("cuts");
        let lowest_mm3 = grid.volume_mm3(&job, &layers.last().expect("an operation").heights_mm);
        let off = (found.left_mm3 - found.overhang_mm3) / lowest_mm3 - 1.0;
        println!(
            "{scene}: {} passes took {taken_mm3} mm3, {off:e} off all at once, {} mm3 hang over",
            found.passes.len(),
            found.overhang_mm3
        );
        assert!(off.abs() < 1e-9, "{off:e}");
        assert!(found.overhang_mm3 < 1e-6 * missing_mm3, "{} mm3", found.overhang_mm3);
        // Alive: a pass that is left out is missed.
        let thickest = found.passes.iter().map(|pass| pass.volume_mm3).fold(0.0, f64::max);
        assert!(((taken_mm3 - thickest) / missing_mm3 - 1.0).abs() > 1e-4);
        // Passes follow each other in time, and the cradle with them.
        assert!(found.passes.windows(2).all(|pair| pair[0].pass < pair[1].pass));
        if material {
            // Without a force along the edge the work is K_c times the volume.
            let work: f64 = found.passes.iter().map(|pass| pass.work_nmm.expect("a material")).sum();
            let k_c = job.spec.material.expect("a material").per_area_n_per_mm2;
            assert!((work / (k_c * missing_mm3) - 1.0).abs() < 1e-9, "{work}");
        } else {
            assert!(found.passes.iter().all(|pass| pass.force_n.is_none() && pass.work_nmm.is_none()));
        }
    }
}

/// Neighbours that are said to be clear change no bit of any slot's cell; where teeth come to a point, as at the crown
/// gear's toe, they are not said to be.
#[test]
fn neighbours_that_are_said_to_be_clear_take_nothing() {
    let fast = ["operation.finish.roll_speed_deg_per_s=20", "fields.blank.spacing_mm=0.8"];
    for scene in ["five_linkage_corrected", "hypoid"] {
        let job = coarse(scene, &fast);
        let grid = CellGrid::of_scene(&job).expect("rays");
        assert!(!job.neighbours_may_reach(&grid), "{scene}");
        for slot in [0, job.blank.teeth - 1] {
            let [own, all] = [false, true].map(|beside| job.cut_cell(&Cpu::default(), &grid, slot, beside));
            assert!(own.expect("cuts").0 == all.expect("cuts").0, "{scene}, slot {slot}");
        }
    }
    let pointed = coarse("crown_gear", &fast);
    assert!(pointed.neighbours_may_reach(&CellGrid::of_scene(&pointed).expect("rays")));
}

/// Blades farther round than the head's window stay clear of the blank: with a wider window the ends of the face, which
/// they leave last, are the same.
#[test]
fn blades_beyond_the_window_take_nothing() {
    for scene in ["five_linkage_corrected", "hypoid", "crown_pinion"] {
        let job = coarse(scene, &["operation.finish.roll_speed_deg_per_s=10", "fields.blank.spacing_mm=0.4"]);
        let cut = |half_window_rad: f64, row: usize| {
            let head = FaceMill { half_window_rad, ..job.head.clone() };
            let pose = |operation: usize, slot: u32, time_s: f64, _: f64| {
                let operation = &job.operations[operation];
                let to_work = DMat3::from_rotation_z(job.middle_rad);
                let to_work = Rigid3 { rotation: to_work, translation_mm: DVec3::ZERO };
                let pose = operation.as_set.work_from_tool(operation.course.at(time_s)[0]).after(&to_work);
                index(slot, job.blank.teeth).after(&job.gear_from_work).after(&pose)
            };
            let slots = Slots::new(&job.operations, &head, (0.0, job.blank.teeth), &pose).expect("passes");
            let grid = CellGrid::of_scene(&job).expect("rays");
            let field = grid.field_of_rows(&job, 3, row..row + 1);
            let mut layer = field.blank_layer();
            let plan = SweepPlan::brute_force(&field, slots.of(job.operations.len() - 1, 3));
            Cpu::default().cut_spatial(&field, &plan, &mut layer).expect("cuts");
            layer
        };
        let window_rad = job.head.half_window_rad;
        let last = CellGrid::of_scene(&job).expect("rays").rows() - 1;
        for row in [0, last] {
            let [own, wide, narrow] = [window_rad, window_rad + 0.15, 0.1 * window_rad].map(|window| cut(window, row));
            let off_mm = |other: &Layer| {
                let heights = own.heights_mm.iter().zip(&other.heights_mm);
                heights.map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max)
            };
            // Motion tables of other ranges differ by rounding.
            assert!(off_mm(&wide) < 1e-6, "{scene}, row {row}: {:e} mm", off_mm(&wide));
            // Alive: in a window that is too narrow blades are missing.
            assert!(off_mm(&narrow) > 1e-3, "{scene}, row {row}: {:e} mm", off_mm(&narrow));
        }
    }
}

/// An undercut is as deep as points below the target are swept by the head at other moments of its roll.
#[test]
fn an_undercut_is_as_deep_as_the_head_sweeps() {
    let sharp = ["tool.face_mill.corner_radius_mm=0"];
    let pinion = job("hypoid_crown_pinion", &sharp).expect("a pinion");
    let words = pinion.undercut_warning().expect("flanks").expect("an undercut").text;
    assert!(words.starts_with("undercut: blades of the same slot go 0."), "{words}");
    let found = SIDES.map(|side| pinion.deepest_cut(side, &[0]).expect("flanks"));
    let deepest = if found[0].depth_mm > found[1].depth_mm { found[0] } else { found[1] };
    let [arc_mm, along_mm] = deepest.at_mm;
    println!("{words}: {deepest:?}");
    // The flank's place in space 0.
    let tooth = if deepest.side == Side::Left { pinion.blank.teeth } else { 1 };
    let rays = pinion.rays_over(tooth, deepest.side, vec![arc_mm], vec![along_mm]).expect("a ray");
    let at = |share: f64| rays.field.ray(0, 0).at(-share * deepest.depth_mm);
    assert!(is_swept(&pinion, at(0.97)) && !is_swept(&pinion, at(1.03)));
    // The gear has none.
    assert_eq!(job("crown_gear", &[]).expect("a gear").undercut_warning().expect("flanks"), None);
}

/// Candidates, which the blank does not use, leave the cell as all passes do, rays of a row being farther apart than
/// the blades' rounds are wide.
#[test]
fn candidates_and_all_passes_leave_the_same_cell() {
    let job = job("five_linkage_corrected", &["operation.finish.roll_speed_deg_per_s=10"]).expect("a gear");
    let grid = CellGrid::of_scene(&job).expect("rays");
    let mut visits = [0, 0];
    for (rows, slot) in [(1, 0), (8, 7)] {
        for first in (0..grid.rows() - rows).step_by(rows) {
            let field = grid.field_of_rows(&job, slot, first..first + rows);
            let set = job.slots.of(1, slot);
            let plans = [SweepPlan::new(&field, set), SweepPlan::brute_force(&field, set)];
            (0..2).for_each(|k| visits[k] += plans[k].dexel_passes());
            let [layer, all] = plans.map(|plan| {
                let mut layer = field.blank_layer();
                Cpu::default().cut_spatial(&field, &plan, &mut layer).expect("cuts");
                layer
            });
            assert!(layer == all, "slot {slot}, rows from {first}");
        }
    }
    assert!(visits[1] > 3 * visits[0], "{visits:?}");
}

/// What a device looks at: the candidates of a whole cell, tile by tile.
#[test]
fn candidates_of_whole_cells_leave_what_all_passes_near_their_rows_leave() {
    let roll = "operation.finish.roll_speed_deg_per_s=10";
    for (scene, slots) in [("five_linkage_corrected", [0, 40]), ("crown_pinion", [1, 3]), ("hypoid", [0, 5])] {
        let job = coarse(scene, &[roll, "fields.blank.spacing_mm=0.3"]);
        let grid = CellGrid::of_scene(&job).expect("rays");
        for slot in slots {
            let swept = job.swept_cell(&grid, slot, false);
            let cpu = Cpu::default();
            let all_in_turn = |plans: &dyn Fn(&TurningPasses) -> Vec<SweepPlan>| {
                let apart_mm = Cell::new(0.0_f32);
                let cut = swept.cut_in_turn(&cpu, |set| {
                    let plans = plans(set);
                    let largest_mm = plans.iter().map(|plan| frames_apart_mm([plan])).fold(apart_mm.get(), f32::max);
                    apart_mm.set(largest_mm);
                    plans
                });
                (cut.expect("cuts"), apart_mm.get())
            };
            let (near, off_near) = all_in_turn(&|set| swept.by.plans(&swept.field, set).collect());
            let (in_patches, off_in_patches) = all_in_turn(&|set| vec![SweepPlan::in_patches(&swept.field, set)]);
            println!("{scene}: frames may be {off_near} and {off_in_patches} mm off");
            println!("{scene}: {} pairs of {}", in_patches.stats.dexel_passes, near.stats.dexel_passes);
            assert!(in_patches.stats.dexel_passes < near.stats.dexel_passes);
            for (in_patches, near) in in_patches.layers.iter().zip(&near.layers) {
                same_but_for_frames(&format!("{scene}, slot {slot}"), in_patches, near, off_near + off_in_patches);
                assert!(*near != swept.field.blank_layer());
            }
        }
    }
}

/// Passes that are left out because they stay clear of a row take nothing from it.
#[test]
fn passes_near_a_row_and_all_passes_leave_the_same() {
    for scene in ["five_linkage_corrected", "crown_pinion"] {
        let job = coarse(scene, &["operation.finish.roll_speed_deg_per_s=10", "fields.blank.spacing_mm=0.4"]);
        let grid = CellGrid::of_scene(&job).expect("rays");
        for (slot, row) in [(0, 0), (7, 5)] {
            let field = grid.field_of_rows(&job, slot, row..row + 1);
            for operation in 0..job.operations.len() {
                let set = job.slots.of(operation, slot);
                let plans = [SweepPlan::brute_force(&field, set), SweepPlan::of_all_passes(&field, set)];
                let [layer, all] = plans.map(|plan| {
                    let mut layer = field.blank_layer();
                    let stats = Cpu::default().cut_spatial(&field, &plan, &mut layer).expect("cuts");
                    assert_eq!(stats.unconverged, 0);
                    layer
                });
                assert!(layer == all, "{scene}, slot {slot}, row {row}, operation {operation}");
                assert!(layer != field.blank_layer());
            }
        }
    }
}

/// The body is closed, looks outwards, and holds what the rays hold: chords are short by some thousandths.
#[test]
fn the_body_is_closed_and_has_the_volume_of_the_rays() {
    for scene in ["crown_pinion", "crown_gear"] {
        let job = coarse(scene, &["operation.finish.roll_speed_deg_per_s=20"]);
        let whole = whole(&job);
        let mesh = body(&job, &whole, 0.2);
        assert!(mesh.is_closed(), "{scene}: {:?}", mesh.edge_faults());
        let left_mm3 = whole.left_mm3[0];
        println!("{scene}: {} mm3 in the mesh, {left_mm3} on rays of {}", mesh.volume_mm3(), whole.blank_mm3);
        assert!((mesh.volume_mm3() / left_mm3 - 1.0).abs() < 3e-3, "{scene}");
        assert!(left_mm3 < 0.9 * whole.blank_mm3);
        // Cells are alike but for the blades' phase.
        let of_slot = |slot: usize| whole.grid.volume_mm3(&job, &whole.slots[slot][0].heights_mm);
        assert!((of_slot(3) / of_slot(0) - 1.0).abs() < 5e-3, "{} and {} mm3", of_slot(0), of_slot(3));
    }
}

#[cfg(feature = "gpu")]
#[test]
fn the_device_cuts_the_same_cell() {
    use crate::fixtures::parity::{Parity, cut_both_in_space, software_gpu, strict};
    use gearcut::cut::SweptField;
    /// As on flanks, but rays lean by the blades' angle against the surface, which stretches errors by 1 / sin 20 deg.
    const SWEPT_NM: f64 = 6.0;
    let gpu = software_gpu(strict());
    let job = coarse("five_linkage_corrected", &["operation.finish.roll_speed_deg_per_s=20"]);
    let grid = CellGrid::of_scene(&job).expect("rays");
    let field = grid.field_of_rows(&job, 2, 4..5);
    let plan = SweepPlan::brute_force(&field, job.slots.of(1, 2));
    let (parity, _, _, _) = cut_both_in_space(&gpu, "slot 2, row 4", &field, &plan);
    println!("{parity}");
    assert_eq!(parity.verdict_within(SWEPT_NM), Ok(()));
    // The whole cell through both operations, as a run cuts it.
    let swept = job.swept_cell(&grid, 2, false);
    let [native, got] =
        [&Cpu::default() as &dyn Backend, &gpu].map(|backend| swept.clone().cut(backend).expect("cuts"));
    let mut parity = Parity::default();
    for (native, got) in native.layers.iter().zip(&got.layers) {
        parity.add("slot 2", grid.columns, native, &[], got);
    }
    println!("{parity}");
    assert_eq!(parity.verdict_within(SWEPT_NM), Ok(()));
    // The next slot's blades stand at another phase, and are seen.
    let other = SweptField { field: swept.field.clone(), ..job.swept_cell(&grid, 3, false) }.cut(&gpu).expect("cuts");
    assert!(other.layers != got.layers);
}
