//! The cost of a hobbing scene.
//!
//! Flanks are planned in a band about the middle of the face, and the first is cut as well. For the blank, the sweeps
//! that reach a slice are found for some passes and slices, and the rays that they cross are counted.

use crate::output::text::{Sheet, significant};
use crate::process::hobbing::HobCutter;
use crate::process::hobbing::warnings::greatest_common_divisor;
use gearcut_core::Result;
use gearcut_core::cut::Backend as _;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::dexel::SpatialField;
use gearcut_core::math::planar_rays::FAMILIES;
use gearcut_core::passes::SweepPlan;
use gearcut_core::passes::sections::swept_sections::SweptSection;
use gearcut_core::passes::spatial::sweep::SweepRecord;
use gearcut_core::terms::Side;
use rayon::prelude::*;

use crate::steps::check_cost::{BYTES_PER_DEXEL, BlankCost, FlankCost, PLANNED_FLANKS};
use crate::steps::computer_speed::ComputerSpeed;
use crate::steps::{check_cost, stages};

/// Rows of a flank that are planned, about the middle of the face. Fewer would not do: what a plan costs however small
/// its field is would count too much, and over fewer than half of a tile's rows planning has no third row to tell bent
/// heights from straight ones, and keeps thousands of passes.
const PLANNED_ROWS: usize = 96;
/// The first planned band is cut as well, and timed to calibrate the estimate; so is every one with fewer dexels.
///
/// Road not taken: a third of the profile on each flank, in turn. It saves a quarter of a second; but tiles at the ends
/// of a part meet fewer passes, and the evaluations came out 5 % too few, 17 % on coarse dexels.
const FEW_DEXELS: usize = 20_000;
/// What one thread of the native backend takes for a dexel's ray, s.
const RAY_S_PER_DEXEL: f64 = 5.5e-8;
/// The same for the plan of a tile.
const PLAN_S_PER_TILE: f64 = 1.1e-4;
/// The same for one evaluation (dexel against record).
const CUT_S_PER_EVALUATION: f64 = 5e-8;
/// The same for measuring a dexel of one surface.
const MEASURE_S_PER_DEXEL: f64 = 1e-8;
/// Bytes of a dexel's ray: two vectors and the blank's height.
const BYTES_PER_RAY: usize = 52;

/// Slices and passes of an operation that are looked at, at most; of the passes some hundreds come near the blank.
const SLICES: usize = 5;
const PASSES: u32 = 8000;
/// What it takes to find whether a sweep reaches a slice, s.
const BLANK_S_PER_SECTION: f64 = 0.8e-6;
/// What a ray that a sweep reaches takes, s.
const BLANK_S_PER_RAY_PASS: f64 = 2.8e-8;

/// Adds the estimate to the report.
///
/// # Errors
/// A flank that the hob does not generate; a blank field that does not fit in memory.
pub fn print(sheet: &mut Sheet, cutter: &HobCutter) -> Result<()> {
    let (fields, beside_s) = (&cutter.job.scene.fields, stages::beside_cutting_s(cutter));
    let ((flanks, machine), blank) = (flank_cost(cutter)?, blank_cost(cutter)?);
    check_cost::print(sheet, fields, &flanks, &blank, beside_s, machine);
    Ok(())
}

/// Rows about the middle of the face.
fn planned_rows_mm(cutter: &HobCutter) -> Vec<f64> {
    let spacing_mm = cutter.job.scene.fields.lead_spacing_mm;
    let rows = ((cutter.job.scene.gear.face_width_mm / spacing_mm).round() as usize + 1).min(PLANNED_ROWS);
    (0..rows).map(|i| spacing_mm * (i as f64 - 0.5 * (rows - 1) as f64)).collect()
}

/// What planning a band of a flank found.
struct PlannedBand {
    dexels: f64,
    tiles: f64,
    records: f64,
    evaluations: f64,
    /// What it took, where it was cut too.
    machine: ComputerSpeed,
}

/// Plans a flank's band, and cuts it where it is the first or a small one.
fn plan(cutter: &HobCutter, number: usize, (tooth, side): (u32, Side)) -> Result<PlannedBand> {
    let target = cutter.target(tooth, side)?;
    let [arcs_mm, _] = cutter.places_mm(target);
    let rows_mm = planned_rows_mm(cutter);
    let is_cut = number == 0 || arcs_mm.len() * rows_mm.len() < FEW_DEXELS;
    let mut machine = ComputerSpeed::default();
    let rays_s = |field: &SpatialField| field.len() as f64 * RAY_S_PER_DEXEL;
    let field = machine.piece(|| cutter.rays_over(target, arcs_mm, rows_mm).field, rays_s);
    let mut sum = PlannedBand { dexels: field.len() as f64, tiles: 0.0, records: 0.0, evaluations: 0.0, machine };
    for passes in cutter.operations.iter() {
        let plan_s = |plan: &SweepPlan| plan.tiles.len() as f64 * PLAN_S_PER_TILE;
        let plan = sum.machine.piece(|| SweepPlan::new(&field, passes), plan_s);
        let evaluations = plan.dexel_passes() as f64;
        if is_cut {
            let mut layer = field.blank_layer();
            let cut_s = evaluations * CUT_S_PER_EVALUATION;
            sum.machine.piece(|| Cpu::default().cut_spatial(&field, &plan, &mut layer), |_| cut_s)?;
        }
        sum.tiles += plan.tiles.len() as f64;
        sum.records += plan.records.len() as f64;
        sum.evaluations += evaluations;
    }
    if !is_cut {
        sum.machine = ComputerSpeed::default();
    }
    Ok(sum)
}

/// With it, how fast this machine plans and cuts.
fn flank_cost(cutter: &HobCutter) -> Result<(FlankCost, ComputerSpeed)> {
    let job = cutter.job;
    let (gear, fields) = (&job.scene.gear, &job.scene.fields);
    let surfaces = job.operations.len() as f64;
    let every = (gear.teeth as usize).div_ceil(PLANNED_FLANKS);
    let teeth: Vec<(u32, Side)> =
        (1..=gear.teeth).step_by(every).zip([Side::Left, Side::Right].into_iter().cycle()).collect();
    let planned: Vec<PlannedBand> =
        teeth.into_par_iter().enumerate().map(|(number, flank)| plan(cutter, number, flank)).collect::<Result<_>>()?;
    let mut machine = ComputerSpeed::default();
    for part in &planned {
        machine += part.machine;
    }
    let sum = |of: fn(&PlannedBand) -> f64| planned.iter().map(of).sum::<f64>();
    let rows = (gear.face_width_mm / fields.lead_spacing_mm).round() + 1.0;
    let per_flank: Vec<f64> = (1..=gear.teeth)
        .into_par_iter()
        .flat_map_iter(|tooth| [Side::Left, Side::Right].map(|side| (tooth, side)))
        .map(|(tooth, side)| {
            let length_mm = cutter.target(tooth, side)?.length_mm();
            Ok(((length_mm / fields.profile_spacing_mm).round() + 1.0) * rows)
        })
        .collect::<Result<_>>()?;
    let (dexels, largest) = (per_flank.iter().sum::<f64>(), per_flank.iter().copied().fold(0.0, f64::max));
    let scale = dexels / sum(|p| p.dexels);
    let records = scale * sum(|p| p.records);
    let evaluations = scale * sum(|p| p.evaluations);
    let bytes_of_rays = largest * (BYTES_PER_RAY as f64 + BYTES_PER_DEXEL as f64 * surfaces);
    let bytes_of_records = records / dexels * largest * size_of::<SweepRecord>() as f64;
    let cost = FlankCost {
        flanks: per_flank.len(),
        largest,
        dexels,
        evaluations,
        per_dexel: evaluations / (dexels * surfaces),
        records,
        note: "",
        bytes: rayon::current_num_threads() as f64 * (bytes_of_rays + bytes_of_records),
        seconds: dexels * (RAY_S_PER_DEXEL + surfaces * MEASURE_S_PER_DEXEL)
            + scale * sum(|p| p.tiles) * PLAN_S_PER_TILE
            + evaluations * CUT_S_PER_EVALUATION,
    };
    Ok((cost, machine))
}

/// Rays through the blank and the sweeps that cross them.
fn blank_cost(cutter: &HobCutter) -> Result<BlankCost> {
    let grid = cutter.job.blank_grid()?;
    let slices = grid.slices_z_mm.len();
    let every_slice = slices.div_ceil(SLICES);
    let (mut sections, mut ray_passes) = (0.0, 0.0);
    for operation in 0..cutter.operations.len() {
        let set = &cutter.operations[operation];
        // Blades follow one another in turn: a step that shares no divisor with their number meets all of them.
        let blades = set.places.len() as u32;
        let least = set.count().div_ceil(PASSES).max(1);
        let every = (least..=least + blades).find(|&every| greatest_common_divisor(every, blades) == 1).unwrap_or(1);
        let passes = cutter.some_sections(operation, every, true)?;
        let found: Vec<[f64; 2]> = grid
            .slices_z_mm
            .par_iter()
            .skip(every_slice / 2)
            .step_by(every_slice)
            .map_init(SweptSection::default, |section, &z_mm| {
                let mut found = [0.0; 2];
                for pass in 0..passes.len() {
                    if !passes.section(pass, z_mm, section) {
                        continue;
                    }
                    found[0] += 1.0;
                    for (family, row) in FAMILIES.into_iter().zip(&grid.rows) {
                        let [low, high] = section.across_mm(family).map(|across| row.first_at_or_above(across));
                        found[1] += high.saturating_sub(low) as f64;
                    }
                }
                found
            })
            .collect();
        let scale = f64::from(every) * slices as f64 / found.len() as f64;
        sections += scale * found.iter().map(|[sections, _]| sections).sum::<f64>();
        ray_passes += scale * found.iter().map(|[_, rays]| rays).sum::<f64>();
    }
    let crossings = format!(
        "hob teeth go through sections {} million times and reach {} million of them",
        significant(1e-6 * sections, 3),
        significant(1e-6 * ray_passes, 3)
    );
    let seconds = sections * BLANK_S_PER_SECTION + ray_passes * BLANK_S_PER_RAY_PASS;
    Ok(BlankCost { crossings, bytes: grid.estimated_bytes(&cutter.job.blank), grid, seconds })
}
