//! What a bevel scene means: blank, settings, head, operations, cost.

use super::axes_report::BevelAxesReport;
use super::blank::CellGrid;
use super::findings;
use super::job::BevelJob;
use super::stage_costs::STAGE_COSTS;
use crate::findings::Notice;
use crate::output::text::{Sheet, plain, significant};
use crate::steps::axes;
use crate::steps::check_cost::{BYTES_PER_DEXEL, TimeCost};
use crate::steps::computer_speed::{ComputerSpeed, so_far_s};
use crate::steps::foreseen::{OF_WINDOWS, print_unknown};
use crate::steps::parts::Stages;
use crate::steps::stages;
use gearcut_core::cut::Backend as _;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::dexel::FreeRays;
use gearcut_core::error::Result;
use gearcut_core::passes::SweepPlan;
use gearcut_core::terms::Side;

/// What one thread of the native backend takes for a dexel's ray, s.
const RAY_S_PER_DEXEL: f64 = 1.1e-7;
/// The same for measuring a dexel of one surface.
const MEASURE_S_PER_DEXEL: f64 = 3e-8;
/// The same for one evaluation (dexel against record).
const CUT_S_PER_EVALUATION: f64 = 6.7e-8;
/// Bytes of a dexel's ray: two vectors and the blank's height.
const BYTES_PER_RAY: f64 = 52.0;
/// Rows of a flank that are planned and cut for the estimate, about the middle of the face.
const PLANNED_ROWS: usize = 96;

/// Prints everything; what must be known before cutting.
///
/// # Errors
/// Geometry that cannot be cut.
pub fn print(sheet: &mut Sheet, job: &BevelJob) -> Result<Vec<Notice>> {
    let operations = BevelAxesReport::of_job(job);
    sheet.heading(&format!("{}: {}", job.scene.name, gear_words(job)));
    print_blank(sheet, job)?;
    print_head(sheet, job);
    for operation in &operations {
        axes::print(operation, sheet);
    }
    // Before the cost: a cut does it as well.
    let foreseen = findings::foresee(job, &operations, Stages::ALL)?;
    print_cost(sheet, job)?;
    let kinds = ["parts of flanks that the roll does not cover", OF_WINDOWS];
    print_unknown(sheet, &kinds);
    Ok(foreseen.warnings)
}

/// The gear in a line.
pub(super) fn gear_words(job: &BevelJob) -> String {
    let kind = if job.finishing().settings.blank_offset_mm == 0.0 { "Spiral bevel" } else { "Hypoid" };
    format!(
        "{kind} gear, {} teeth, outer module {} mm, pitch angle {:.4} deg, face width {} mm",
        job.blank.teeth,
        significant(job.blank.outer_module_mm(), 6),
        job.blank.pitch_angle_rad.to_degrees(),
        plain(job.blank.face_width_mm)
    )
}

fn print_blank(sheet: &mut Sheet, job: &BevelJob) -> Result<()> {
    let blank = &job.blank;
    sheet.heading("Blank");
    let [pitch, face, root] = [blank.pitch_angle_rad, blank.face_angle_rad, blank.root_angle_rad].map(f64::to_degrees);
    sheet.line("cones", format!("pitch {pitch:.4}, face {face:.4}, root {root:.4} deg"));
    let (outer, mean) = (blank.outer_cone_distance_mm, blank.mean_cone_distance_mm());
    sheet.line("cone distances", format!("outer {outer:.4} mm, mean {mean:.4} mm"));
    let inner = outer - blank.face_width_mm;
    let depth = |at: f64| blank.addendum_mm(at) + blank.dedendum_mm(at);
    sheet.line(
        "whole depth",
        format!("{:.3} mm at the toe, {:.3} in the middle, {:.3} at the heel", depth(inner), depth(mean), depth(outer)),
    );
    for side in [Side::Left, Side::Right] {
        let (target, kind) = (job.target_of(side), job.kind_of(side));
        let spiral = target.row(0.0)?.spiral_angle_rad()?.to_degrees();
        sheet.line(
            &format!("{} flanks", side.name()),
            format!(
                "{}, cut by {} blades, spiral angle {spiral:.3} deg, profile {:.3} mm long",
                kind.flank(),
                kind.name(),
                target.length_mm()
            ),
        );
    }
    Ok(())
}

fn print_head(sheet: &mut Sheet, job: &BevelJob) {
    let (head, settings) = (&job.head, &job.finishing().settings);
    sheet.heading("Head and settings");
    let source = if job.spec.head.radius_mm.is_some() { "given" } else { "inferred from the settings" };
    sheet.line("mean radius", format!("{:.4} mm, {source}", head.radius_mm));
    sheet.line(
        "settings say",
        format!(
            "radius {:.4} mm and spiral angle {:.4} deg through the mean point, ratio of roll {:.6}",
            job.inferred.radius_mm,
            job.inferred.spiral_angle_rad.to_degrees(),
            job.inferred.roll_ratio
        ),
    );
    sheet.line(
        "blades",
        format!("{}, outside and inside in turn, point width {} mm", head.blades(), plain(head.point_width_mm)),
    );
    sheet.line(
        "in the work",
        format!("within {:.2} deg to either side of the slot's middle", head.half_window_rad.to_degrees()),
    );
    sheet.line("ratio of roll", format!("{:.6}", settings.roll.ratio));
    let missed_mm = job.depth_missed_mm();
    let words = if missed_mm > 0.0 { "short of" } else { "beyond" };
    sheet.line("tips stand", format!("{:.4} mm {words} the blank's roots, middle of the face", missed_mm.abs()));
}

fn print_cost(sheet: &mut Sheet, job: &BevelJob) -> Result<()> {
    let before_s = so_far_s();
    let fields = job.scene.fields;
    let PlannedSides { dexels, evaluations, largest, plan_s, machine } = PlannedSides::of(job)?;
    let surfaces = job.operations.len() as f64;
    let threads = rayon::current_num_threads();
    sheet.heading("Cost of the cut (nothing has been cut)");
    let grid = CellGrid::of_scene(job)?;
    sheet.details(|sheet| {
        sheet.line(
            "flank fields",
            format!(
                "{} of at most {:.2} million dexels, {} by {} um; {} million in all",
                2 * job.blank.teeth,
                1e-6 * largest,
                plain(1e3 * fields.profile_spacing_mm),
                plain(1e3 * fields.lead_spacing_mm),
                significant(1e-6 * dexels, 3)
            ),
        );
        sheet.line(
            "evaluations",
            format!(
                "{} million dexels against passes, {:.1} per dexel and operation",
                significant(1e-6 * evaluations, 3),
                evaluations / (dexels * surfaces)
            ),
        );
        let rays = f64::from(job.blank.teeth) * (grid.columns * grid.rows()) as f64;
        let passes = f64::from(job.slots.count()) / f64::from(job.blank.teeth);
        sheet.line(
            "whole blank",
            format!(
                "{} thousand rays in {} rows, each met by some {:.0} passes",
                significant(1e-3 * rays, 3),
                grid.rows(),
                passes
            ),
        );
        // The rays of both sides are kept.
        let bytes =
            largest * (threads as f64 * (BYTES_PER_RAY + BYTES_PER_DEXEL as f64 * surfaces) + 2.0 * BYTES_PER_RAY);
        sheet.line("memory", format!("{:.0} MB: one flank at a time on each of {threads} threads", 1e-6 * bytes));
    });
    let cut_s = dexels * (RAY_S_PER_DEXEL + surfaces * MEASURE_S_PER_DEXEL) + evaluations * CUT_S_PER_EVALUATION;
    let [cut_s, beside_s] = [cut_s, stages::beside_cutting_s(job, &STAGE_COSTS)].map(|s| s * machine.factor());
    let blank_s = blank_s(job, &grid)?;
    TimeCost { flanks_s: plan_s + cut_s, blank_s, beside_s: before_s + beside_s }.print(sheet);
    Ok(())
}

/// What planning and cutting bands of both sides found.
struct PlannedSides {
    /// Of all flanks.
    dexels: f64,
    /// Of all flanks.
    evaluations: f64,
    /// Dexels of the largest flank.
    largest: f64,
    /// What planning takes, of all flanks, s of one core of this machine.
    plan_s: f64,
    /// What rays and cuts of the bands took.
    machine: ComputerSpeed,
}

impl PlannedSides {
    fn of(job: &BevelJob) -> Result<Self> {
        let teeth = f64::from(job.blank.teeth);
        let machine = ComputerSpeed::default();
        let mut all = Self { dexels: 0.0, evaluations: 0.0, largest: 0.0, plan_s: 0.0, machine };
        for side in [Side::Left, Side::Right] {
            let [arcs_mm, rows_mm] = job.places_mm(side);
            let flank = (arcs_mm.len() * rows_mm.len()) as f64;
            let first = rows_mm.len().saturating_sub(PLANNED_ROWS) / 2;
            let planned = rows_mm[first..(first + PLANNED_ROWS).min(rows_mm.len())].to_vec();
            let rays_s = |rays: &FreeRays| rays.field.len() as f64 * RAY_S_PER_DEXEL;
            let rays = || job.rays_over(1, side, arcs_mm, planned);
            let field = all.machine.piece(rays, |rays| rays.as_ref().map_or(0.0, rays_s))?.field;
            let (mut visits, mut planning) = (0.0, ComputerSpeed::default());
            for operation in 0..job.operations.len() {
                let mut layer = field.blank_layer();
                let passes = job.slots.of(operation, job.space_of(1, side));
                let plan = planning.piece(|| SweepPlan::new(&field, passes), |_| 0.0);
                let own = plan.dexel_passes() as f64;
                let cut_s = own * CUT_S_PER_EVALUATION;
                all.machine.piece(|| Cpu::default().cut_spatial(&field, &plan, &mut layer), |_| cut_s)?;
                visits += own;
            }
            let bands = teeth * flank / field.len() as f64;
            all.evaluations += bands * visits;
            all.plan_s += bands * planning.taken_s();
            all.dexels += teeth * flank;
            all.largest = all.largest.max(flank);
        }
        Ok(all)
    }
}

/// What cutting the whole blank takes, s of one core of this machine: a slot's cell on few of its rows is cut, so that
/// it does not matter how many of the passes come near.
fn blank_s(job: &BevelJob, grid: &CellGrid) -> Result<f64> {
    let last = grid.rows() - 1;
    let mut some = vec![0, last / 2, last];
    some.dedup();
    let of_some = |values: &[f64]| some.iter().map(|&row| values[row]).collect();
    let cell =
        CellGrid { distances_mm: of_some(&grid.distances_mm), middles_rad: of_some(&grid.middles_rad), ..grid.clone() };
    let beside = job.neighbours_may_reach(&cell);
    let share = some.len() as f64 / (grid.rows() as f64 * f64::from(job.blank.teeth));
    let mut machine = ComputerSpeed::default();
    machine.piece(|| job.cut_cell(&Cpu::default(), &cell, 0, beside), |_| 0.0)?;
    Ok(machine.taken_s() / share)
}
