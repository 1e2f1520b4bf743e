//! Frames of bevel gears: blades where the settings put them, the slot pass by pass against all passes at once.

use super::jobs::job;
use gearcut::cut::cpu::Cpu;
use gearcut::process::bevel::blank::CellGrid;
use gearcut::process::bevel::body::of_cells;
use gearcut::process::bevel::slot_frames::SlotFrames;
use gearcut::steps::frames::CutByStep;
use glam::{DVec2, DVec3};

const COARSE: [&str; 2] = ["fields.blank.spacing_mm=0.5", "fields.blank.slice_spacing_mm=4"];

/// When a blade points to the slot, the corner behind its tip lies beside the head's mean radius, in the plane of the
/// tips, in the direction of the slot's middle: the tool's pose by the settings alone, at the time that the head needs
/// for its turn.
#[test]
fn blades_are_drawn_where_the_settings_put_them() {
    for scene in ["tilted", "formate"] {
        let job = job(scene, &COARSE).expect("a gear");
        let frames = SlotFrames::new(&job).expect("a slot");
        let (operation, set) = (job.finishing(), job.slots.of(job.operations.len() - 1, 0));
        let before = frames.steps() - set.count() as usize;
        for share in [0, 1, 3, 4] {
            let own = (set.count() - 1) * share / 4;
            let pass = set.pass(own);
            let time_s = (pass.tool_angle_rad - job.spec.head.start_angle_rad) / operation.spec.head_speed_rad_per_s;
            let pose = job.gear_from_work.after(&operation.settings.work_from_tool(operation.course.at(time_s)[0]));
            let (head, kind) = (&job.head, set.place(&pass).blade);
            let beside_mm = 0.5 * head.point_width_mm - head.tip_width_mm;
            let radius_mm = head.radius_mm + if kind % 2 == 0 { beside_mm } else { -beside_mm };
            let corner_mm = pose.point((radius_mm * DVec2::from_angle(job.middle_rad)).extend(0.0));
            let parts = frames.tool(before + own as usize).expect("blades");
            let drawn = parts.iter().flat_map(|part| &part.positions_mm);
            let nearest_mm = drawn.map(|at: &DVec3| at.distance(corner_mm)).fold(f64::INFINITY, f64::min);
            println!("{scene}, pass {own}: {} blades, {nearest_mm:e} mm off", parts.len());
            assert!(nearest_mm < 1e-6, "{scene}, pass {own}: {nearest_mm} mm");
        }
    }
}

#[test]
fn frames_leave_what_all_passes_of_the_slot_leave() {
    let job = job("tilted", &COARSE).expect("a gear");
    let mut frames = SlotFrames::new(&job).expect("a slot");
    let grid = CellGrid::of_scene(&job).expect("rays");
    let steps = frames.steps();
    let volumes_mm3 = [0, steps / 4, steps / 2, steps].map(|until| {
        frames.advance(until).expect("cuts");
        let body = frames.work(0).expect("a body");
        assert!(body.is_closed());
        body.volume_mm3()
    });
    assert!(volumes_mm3.windows(2).all(|pair| pair[0] > pair[1]), "{volumes_mm3:?}");
    let (layers, _) = job.cut_cell(&Cpu::default(), &grid, 0, false).expect("cuts");
    let (cut, uncut) = (layers.last().expect("a layer"), grid.field(&job, 0).blank_layer());
    let cells = [(job.blank.teeth - 1, uncut.clone()), (0, cut.clone()), (1, uncut)];
    assert!(frames.work(0).expect("a body") == of_cells(&job, &grid, &cells, job.scene.fields.blank_spacing_mm));
    let [first, last] = [0, steps].map(|until| frames.title(until));
    assert!(first.starts_with("finish: pass 0 of ") && last == first.replace("pass 0", &format!("pass {steps}")));
}
