//! The cost of a shaping scene.
//!
//! For the blank and the chips, the cutter teeth that reach the blank are counted for strokes spread over all
//! operations, and the rays that they cross.

use crate::output::chip_places::CHIPS_OF_A_CELL;
use crate::output::flank_maps::FlankMaps;
use crate::output::text::{Sheet, significant};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::chips::{last_chips_on_map, ploughed_layers};
use crate::process::shaping::scene::model::EdgeRounding;
use crate::process::shaping::stage_costs::STAGE_COSTS;
use crate::process::shaping::tearing::LOOKUP_MM;
use gearcut_core::cut::Backend as _;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::cut::cpu::blank::TILE_RAYS;
use gearcut_core::dexel::{Field, RayGrid as _};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::gear::blank_outline::BlankOutline;
use gearcut_core::math::planar_rays::{FAMILIES, RayCrossings};
use gearcut_core::passes::planar::blank_candidates::passes_at;
use gearcut_core::passes::planar::candidates::TILE_COLUMNS;
use gearcut_core::passes::{CutPlan, PassRecord};
use gearcut_core::terms::Side;
use gearcut_core::tool::closed_tooth::PlacedScratch;

use crate::process::shaping::tooth_facts::ToothFacts;
use crate::steps::check_cost::{BYTES_PER_DEXEL, BlankCost, FlankCost, PLANNED_FLANKS};
use crate::steps::computer_speed::{ComputerSpeed, so_far_s};
use crate::steps::planar::CutField;
use crate::steps::{check_cost, stages};

/// What one thread of the native backend takes for the plan of a tile, s.
const PLAN_S_PER_TILE: f64 = 6.0e-5;
/// The same for one evaluation (dexel against pass), in groups of [`ROWS_AT_ONCE`].
const CUT_S_PER_EVALUATION: f64 = 2.6e-9;
/// The same for measuring a dexel of one surface.
const MEASURE_S_PER_DEXEL: f64 = 1e-8;
/// The same for a dexel of a row that another row stands for, where maps show it.
const COPY_S_PER_DEXEL: f64 = 5e-9;
/// Share of the columns that are cut row by row where a few rows tell of the others: 2 to 11 % were found.
const UNTOLD_SHARE: f64 = 0.06;
/// Cells of maps beside one another, in all their rows, whose chips are followed for the estimate. What a chip takes
/// depends on how many passes come near: 2e-6 to 4e-4 s for a cell were found on two gears, so that it is timed on the
/// scene's own. On fewer cells what comes first on each strip would count too much.
const CHIP_CELLS: f64 = 24.0;
/// Of so many planned flanks one gets such a strip.
const CHIPS_EVERY: usize = 4;
/// Rows that the kernel takes at once, whether there are as many or not.
const ROWS_AT_ONCE: usize = 16;
/// Tiles that are planned on each of them.
const PLANNED_TILES: usize = 32;

/// The same for one pass that is looked at on one ray where edges are rounded and passes followed in strict order, the
/// choice of passes included: 1.2 to 2.5e-6 s were found on six gears (docs/edge.md).
const FOLLOW_S_PER_LOOK: f64 = 1.6e-6;
/// The same for a mark of a built-up edge that rays see: the chip that left its place.
const MARK_S: f64 = 5.0e-5;
/// Columns and rows of a flank on which passes are followed for the estimate.
const FOLLOWED: [usize; 2] = [6, 4];
/// Strokes of each operation that are placed in the blank.
const PLACED_STROKES: usize = 40;
/// What one thread takes for a ray that a cutter tooth crosses, its return stroke checked, and for each tooth in each
/// slice beside, s.
const BLANK_S_PER_RAY_PASS: f64 = 9e-8;
const BLANK_S_PER_PASS: f64 = 8e-6;
/// What it takes to follow the chips of a cutter tooth in one stroke, s, at the spacing [`CHIP_SPACING_MM`] and the
/// module [`CHIP_MODULE_MM`]; it grows with the section of a tooth and the inverse of the spacing.
const CHIPS_S_PER_PASS: f64 = 3.2e-5;
const CHIP_SPACING_MM: f64 = 0.05;
const CHIP_MODULE_MM: f64 = 3.0;

/// Adds the estimate to the report.
///
/// # Errors
/// A blank field that does not fit in memory; a piece that cannot be cut.
pub fn print(sheet: &mut Sheet, job: &ShapingJob, facts: &[ToothFacts]) -> Result<()> {
    let before_s = so_far_s();
    let surfaces = job.operations.len();
    let (mut rows, mut planned_columns, mut records) = (0, 0.0, 0.0);
    let (mut evaluations, mut tiles) = (0.0, 0.0);
    let (mut followed, mut mapped) = (Followed::default(), Mapped::default());
    let mut machine = ComputerSpeed::default();
    for (number, (tooth, side)) in facts
        .iter()
        .step_by(facts.len().div_ceil(PLANNED_FLANKS).max(1))
        .zip([Side::Left, Side::Right].into_iter().cycle())
        .enumerate()
    {
        let field = job.flank_field(job.target_flank(tooth.tooth, side));
        if job.cutter_spec.edge_rounding.is_none() && number.is_multiple_of(CHIPS_EVERY) {
            mapped.add(job, &field, number, (tooth.tooth, side))?;
        }
        let field = some_tiles(field);
        rows = field.rows();
        planned_columns += field.columns.len() as f64;
        let mut field = field;
        // Which rows are cut does not matter, only how many.
        field.rows_z_mm.truncate(job.planar().distinct_rows(rows));
        if let Some(rounding) = &job.cutter_spec.edge_rounding {
            followed.add(job, &field, rounding, &mut machine);
        }
        for operation in &job.operations {
            let plan = machine.piece(
                || CutPlan::new(&field, &operation.strokes, &job.cutter),
                |plan| plan.tiles.len() as f64 * PLAN_S_PER_TILE,
            );
            if machine.wants_more() {
                let idle_rows = field.rows().next_multiple_of(ROWS_AT_ONCE) as f64 / field.rows() as f64;
                let expected_s = plan.dexel_passes() as f64 * idle_rows * CUT_S_PER_EVALUATION;
                let mut layer = field.blank_layer();
                machine.piece(|| Cpu::default().cut(&field, &plan, &mut layer), |_| expected_s)?;
            }
            records += plan.records.len() as f64;
            tiles += plan.tiles.len() as f64;
            evaluations += plan.dexel_passes() as f64;
        }
    }
    let spacing_mm = job.scene.fields.profile_spacing_mm;
    let columns = |length_mm: f64| (length_mm / spacing_mm).floor() + 1.0;
    let per_flank: Vec<f64> =
        facts.iter().flat_map(ToothFacts::flanks).map(|(_, flank)| columns(flank.length_mm)).collect();
    let (all_columns, longest) = (per_flank.iter().sum::<f64>(), per_flank.iter().copied().fold(0.0, f64::max));
    let (dexels, largest) = (all_columns * rows as f64, longest * rows as f64);
    let scale = all_columns / planned_columns;
    let rows_cut = job.planar().distinct_rows(rows);
    let rows_measured = if job.planar().rows_are_alike() { 1 } else { rows };
    // Columns that are cut in all rows, where a few tell of the others.
    let row_by_row = if rows_cut == rows_measured { 0.0 } else { UNTOLD_SHARE * rows as f64 / rows_cut as f64 };
    let map_spacing_mm = job.scene.output.map_spacing_mm;
    let map_rows =
        if job.planar().rows_are_alike() { 1.0 } else { (job.scene.gear.face_width_mm / map_spacing_mm).floor() + 1.0 };
    let map_cells = all_columns * spacing_mm / map_spacing_mm * map_rows;
    let idle_rows = rows_cut.next_multiple_of(ROWS_AT_ONCE) as f64 / rows_cut as f64;
    let flanks = FlankCost {
        flanks: per_flank.len(),
        largest,
        dexels,
        evaluations: evaluations * (1.0 + row_by_row) * scale,
        per_dexel: evaluations / (planned_columns * (rows_cut * surfaces) as f64),
        records: records * scale,
        note: match rows_cut {
            1 if rows > 1 => "; rows are alike: one is cut for all",
            _ if rows_cut < rows => "; a few rows tell of those between",
            _ => "",
        },
        bytes: rayon::current_num_threads() as f64
            * (largest * (BYTES_PER_DEXEL * surfaces) as f64
                + records / planned_columns * longest * size_of::<PassRecord>() as f64),
        seconds: mapped.s_per_column() * all_columns
            + machine.factor()
                * (all_columns * (rows_measured * surfaces) as f64 * MEASURE_S_PER_DEXEL
                    + all_columns * ((rows - rows_cut) * surfaces) as f64 * COPY_S_PER_DEXEL
                    + marks_s(job, facts)
                    + match &job.cutter_spec.edge_rounding {
                        None => {
                            let evaluated = evaluations * (idle_rows + row_by_row);
                            scale * (tiles * PLAN_S_PER_TILE + evaluated * CUT_S_PER_EVALUATION)
                        }
                        Some(_) => {
                            let followed_of_a_cell = if rows_measured == 1 { 1.0 } else { CHIPS_OF_A_CELL as f64 };
                            let rays = all_columns * rows_measured as f64 + map_cells * followed_of_a_cell;
                            rays * followed.looks_per_ray() * FOLLOW_S_PER_LOOK
                        }
                    }),
    };
    let beside_s = before_s + machine.factor() * stages::beside_cutting_s(job, &STAGE_COSTS);
    check_cost::print(sheet, &job.scene.fields, &flanks, &blank_cost(job, machine)?, beside_s);
    Ok(())
}

/// Passes that were followed in strict order for the estimate.
#[derive(Default)]
struct Followed {
    looks: f64,
    rays: f64,
}

impl Followed {
    /// Follows them on some rays of a field.
    fn add(&mut self, job: &ShapingJob, field: &Field, rounding: &EdgeRounding, machine: &mut ComputerSpeed) {
        let some =
            |count: usize, most: usize| -> Vec<usize> { (0..count).step_by(count.div_ceil(most).max(1)).collect() };
        let sample = field.at([&some(field.columns.len(), FOLLOWED[0]), &some(field.rows(), FOLLOWED[1])]);
        self.rays += sample.len() as f64;
        // The clock is that of one thread.
        let Ok(alone) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else { return };
        let follow = || ploughed_layers(job, &sample, rounding).1.dexel_passes as f64;
        self.looks += alone.install(|| machine.piece(follow, |looks| looks * FOLLOW_S_PER_LOOK));
    }

    /// By all operations.
    fn looks_per_ray(&self) -> f64 {
        self.looks / self.rays.max(1.0)
    }
}

/// Cells of maps that were sampled, and their chips followed, for the estimate.
#[derive(Default)]
struct Mapped {
    columns: f64,
    taken: ComputerSpeed,
}

impl Mapped {
    /// Follows chips on a strip of a flank, farther along the profile from flank to flank.
    fn add(&mut self, job: &ShapingJob, field: &Field, number: usize, (tooth, side): (u32, Side)) -> Result<()> {
        let spacing_mm = job.scene.output.map_spacing_mm;
        let wanted = (CHIP_CELLS * spacing_mm / job.scene.fields.profile_spacing_mm).ceil().max(2.0) as usize;
        let first = field.columns.len().saturating_sub(wanted) * (number % PLANNED_FLANKS) / PLANNED_FLANKS;
        let columns: Vec<_> = field.columns.iter().skip(first).take(wanted).copied().collect();
        self.columns += columns.len() as f64;
        let CutField { field, layers, .. } = job.cut(&Cpu::default(), Field { columns, ..field.clone() })?;
        let follow = || {
            let maps = FlankMaps::sample(tooth, side, [&field.arcs_mm(), field.rows_mm()], &layers, spacing_mm);
            last_chips_on_map(job, &field, &maps.chip_places(&layers, field.rows()))
        };
        self.taken.piece(follow, |_| 0.0);
        Ok(())
    }

    /// By all operations, for a column of dexels.
    fn s_per_column(&self) -> f64 {
        self.taken.taken_s() / self.columns.max(1.0)
    }
}

/// Marks of a built-up edge: those that rows of dexels see, s. Places of straight strokes are asked for once.
fn marks_s(job: &ShapingJob, facts: &[ToothFacts]) -> f64 {
    let Some(edge) = &job.cutter_spec.built_up_edge else { return 0.0 };
    let seen = |length_mm: f64| (length_mm / job.scene.fields.lead_spacing_mm).min(1.0);
    let share = edge.scratch_share * seen(edge.scratch_length_mm) + (1.0 - edge.scratch_share) * seen(edge.width_mm);
    let to_a_mm = edge.density_per_mm2 * job.scene.gear.face_width_mm * share * job.operations.len() as f64;
    let lengths_mm = facts.iter().flat_map(ToothFacts::flanks).map(|(_, flank)| flank.length_mm).sum::<f64>();
    let most = if job.planar().rows_are_alike() { 1.0 / LOOKUP_MM } else { f64::INFINITY };
    lengths_mm * to_a_mm.min(most) * MARK_S
}

/// Rays through the blank and the cutter teeth that cross them.
fn blank_cost(job: &ShapingJob, machine: ComputerSpeed) -> Result<BlankCost, Refusal> {
    let grid = job.planar().blank_grid()?;
    let reach_mm = BlankOutline::new(&job.blank).reach_mm();
    let (mut passes, mut ray_passes) = (0.0, 0.0);
    let (mut placed, mut crossings) = (PlacedScratch::default(), RayCrossings::default());
    for operation in &job.operations {
        let set = &operation.strokes;
        let teeth = job.planar().closed_teeth(set, reach_mm);
        let every = set.count().div_ceil(PLACED_STROKES).max(1);
        let all = passes_at(set, set.law.tau(0.0), &job.cutter, &teeth, reach_mm);
        passes += all.len() as f64;
        let (mut strokes, mut crossed) = (0, 0);
        for pass in all.iter().filter(|pass| (pass.stroke as usize).is_multiple_of(every)) {
            let tooth = &teeth[pass.edge];
            let outline = tooth.placed(&pass.work_from_blade, &mut placed);
            strokes += 1;
            for (family, row) in FAMILIES.into_iter().zip(&grid.rows) {
                // Tiles that the circle round the edge does not reach are left out.
                let across = family.across(pass.center_mm);
                let rays = [-tooth.reach_mm, tooth.reach_mm].map(|r| row.first_at_or_above(across + r));
                let tiles = rays[0] / TILE_RAYS * TILE_RAYS..rays[1].next_multiple_of(TILE_RAYS).min(row.count);
                crossings.lay(&outline, family, row, tiles);
                crossed += crossings.touched().filter(|&ray| crossings.crosses(ray)).count();
            }
        }
        ray_passes += all.len() as f64 * f64::from(crossed as u32) / f64::from(strokes.max(1));
    }
    ray_passes *= grid.slices_z_mm.len() as f64;
    let section_mm2 = (job.scene.gear.module_mm / CHIP_MODULE_MM).powi(2);
    let chips_s = passes * CHIPS_S_PER_PASS * section_mm2 * CHIP_SPACING_MM / job.chip_spacing_mm;
    let in_slices = passes * grid.slices_z_mm.len() as f64;
    let blank_s = ray_passes * BLANK_S_PER_RAY_PASS + in_slices * BLANK_S_PER_PASS;
    let seconds = machine.factor() * (blank_s + chips_s);
    let crossings = format!(
        "{} thousand cutter teeth reach it and cross {} million of them",
        significant(1e-3 * passes, 3),
        significant(1e-6 * ray_passes, 2)
    );
    Ok(BlankCost { crossings, bytes: grid.estimated_bytes(&job.blank), grid, seconds })
}

/// Whole tiles spread evenly over a field, so that planning them takes the same time whatever the spacing.
fn some_tiles(field: Field) -> Field {
    let every = field.columns.len().div_ceil(TILE_COLUMNS * PLANNED_TILES).max(1);
    let columns = field.columns.chunks(TILE_COLUMNS).step_by(every).flatten().copied().collect();
    Field { columns, ..field }
}
