//! The cost of a hobbing scene.
//!
//! Flanks are planned in a band about the middle of the face, and the first is cut as well. For the blank, the sweeps
//! that reach a slice are found for some passes and slices, and the rays that they cross are counted.

use crate::output::text::{Sheet, significant};
use crate::process::hobbing::HobCutter;
use crate::process::hobbing::stage_costs::STAGE_COSTS;
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

use crate::steps::check_cost::{BYTES_PER_DEXEL, BlankCost, FlankCost};
use crate::steps::computer_speed::{ComputerSpeed, so_far_s};
use crate::steps::{check_cost, stages};

/// Rows of a flank that are planned, about the middle of the face. Fewer would not do: what a plan costs however small
/// its field is would count too much, and over fewer than half of a tile's rows planning has no third row to tell bent
/// heights from straight ones, and keeps thousands of passes.
const PLANNED_ROWS: usize = 96;
/// Flanks that are planned: left and right in turn. Each takes a twelfth of a second.
const PLANNED_FLANKS: usize = 5;
/// The first planned band is cut as well, and timed to calibrate the estimate; so is every one with fewer dexels.
///
/// Road not taken: a third of the profile on each flank, in turn. It saves a quarter of a second; but tiles at the ends
/// of a part meet fewer passes, and the evaluations came out 5 % too few, 17 % on coarse dexels.
const FEW_DEXELS: usize = 20_000;
/// What one thread of the native backend takes for a dexel's ray, s.
const RAY_S_PER_DEXEL: f64 = 5.5e-8;
/// What planning a root takes, over what planning a flank takes: 0.9 and 1.3 were found on two gears, whose roots were
/// planned, and hardly cut, on rows a millimetre apart.
const ROOT_OF_A_FLANK: f64 = 1.1;
/// How far beside a band passes come near it, so that they have to be planned, both ends together, in modules: by trial
/// on a gear of module 3 and one of module 8, whose flanks took 0.30 and 0.24 s, and their bands 0.08 and 0.05 s.
const BESIDE_BAND_MODULES: f64 = 0.95;
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
const BLANK_S_PER_RAY_PASS: f64 = 4.2e-8;

/// Adds the estimate to the report.
///
/// # Errors
/// A flank that the hob does not generate; a blank field that does not fit in memory.
pub fn print(sheet: &mut Sheet, cutter: &HobCutter) -> Result<()> {
    let before_s = so_far_s();
    let (flanks, machine) = flank_cost(cutter)?;
    let blank = blank_cost(cutter, machine)?;
    let beside_s = before_s + machine.factor() * stages::beside_cutting_s(cutter, &STAGE_COSTS);
    check_cost::print(sheet, &cutter.job.scene.fields, &flanks, &blank, beside_s);
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
    records: f64,
    evaluations: f64,
    /// What it took to plan it, s.
    plan_s: f64,
    /// What rays and cut took, where it was cut too.
    machine: ComputerSpeed,
}

/// Plans a flank's band, and cuts it where it is the first or a small one.
fn plan(cutter: &HobCutter, number: usize, (tooth, side): (u32, Side)) -> Result<PlannedBand> {
    let target = cutter.target(tooth, side)?;
    let [arcs_mm, _] = cutter.places_mm(target);
    let rows_mm = planned_rows_mm(cutter);
    let is_cut = number == 0 || arcs_mm.len() * rows_mm.len() < FEW_DEXELS;
    let (mut planning, mut cutting) = (ComputerSpeed::default(), ComputerSpeed::default());
    let rays_s = |field: &SpatialField| field.len() as f64 * RAY_S_PER_DEXEL;
    let field = cutting.piece(|| cutter.rays_over(target, arcs_mm, rows_mm).field, rays_s);
    let (mut records, mut evaluations) = (0.0, 0.0);
    for passes in cutter.operations.iter() {
        let plan = planning.piece(|| SweepPlan::new(&field, passes), |_| 0.0);
        let own = plan.dexel_passes() as f64;
        if is_cut {
            let mut layer = field.blank_layer();
            let cut_s = own * CUT_S_PER_EVALUATION;
            cutting.piece(|| Cpu::default().cut_spatial(&field, &plan, &mut layer), |_| cut_s)?;
        }
        records += plan.records.len() as f64;
        evaluations += own;
    }
    let machine = if is_cut { cutting } else { ComputerSpeed::default() };
    Ok(PlannedBand { dexels: field.len() as f64, records, evaluations, plan_s: planning.taken_s(), machine })
}

/// With it, how fast this machine plans and cuts.
fn flank_cost(cutter: &HobCutter) -> Result<(FlankCost, ComputerSpeed)> {
    let job = cutter.job;
    let (gear, fields) = (&job.scene.gear, &job.scene.fields);
    let surfaces = job.operations.len() as f64;
    let every = (gear.teeth as usize).div_ceil(PLANNED_FLANKS).max(1);
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
    // Passes come near a band from beside it, so that a whole flank costs less than its share.
    let beside_mm = BESIDE_BAND_MODULES * gear.module_mm;
    let band_mm = fields.lead_spacing_mm * planned_rows_mm(cutter).len() as f64;
    let of_bands = (gear.face_width_mm + beside_mm) / (band_mm + beside_mm);
    let plan_s = of_bands * sum(|p| p.plan_s) * 2.0 * f64::from(gear.teeth) / planned.len() as f64;
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
        seconds: plan_s
            + f64::from(gear.teeth) * ROOT_OF_A_FLANK * plan_s / per_flank.len() as f64
            + machine.factor()
                * (dexels * (RAY_S_PER_DEXEL + surfaces * MEASURE_S_PER_DEXEL) + evaluations * CUT_S_PER_EVALUATION),
    };
    Ok((cost, machine))
}

/// Rays through the blank and the sweeps that cross them.
fn blank_cost(cutter: &HobCutter, machine: ComputerSpeed) -> Result<BlankCost> {
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
    let seconds = machine.factor() * (sections * BLANK_S_PER_SECTION + ray_passes * BLANK_S_PER_RAY_PASS);
    Ok(BlankCost { crossings, bytes: grid.estimated_bytes(&cutter.job.stock), grid, seconds })
}
