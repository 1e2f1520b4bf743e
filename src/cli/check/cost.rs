//! What the cut will cost: dexels, records, evaluations, memory, time.
//!
//! Dexels follow from the lengths of all profiles and the spacing. Records and evaluations are planned for a few flanks spread
//! over the gear, exactly as the cut would plan them, and scaled to all flanks by their dexels. Time takes the rate of one
//! thread, stated with the result.

use gearcut::Refusal;
use gearcut::dexel::Field;
use gearcut::gear::generation::Side;
use gearcut::job::Job;
use gearcut::output::progress::duration_text;
use gearcut::output::text::{Sheet, plain};
use gearcut::passes::candidates::TILE_COLUMNS;
use gearcut::passes::{CutPlan, PassRecord};

use super::facts::ToothFacts;

/// Flanks that are planned for the estimate: left and right in turn, and a number that seldom divides the periods of a curve.
const PLANNED_FLANKS: usize = 5;
/// Evaluations (dexel against pass) per second and thread of the native backend with AVX-512 at 2.5 GHz, planning and
/// measuring included; AVX2 reaches about half of it.
const EVALUATIONS_PER_SECOND_AND_THREAD: f64 = 5.0e7;
/// Tiles that are planned on each of them.
const PLANNED_TILES: usize = 32;
/// Bytes per dexel and surface: height and pass id.
const BYTES_PER_DEXEL: usize = 8;

/// Adds the estimate to the report.
///
/// # Errors
/// A flank that the cutter does not generate.
pub fn print(sheet: &mut Sheet, job: &Job, facts: &[ToothFacts]) -> Result<(), Refusal> {
    let surfaces = job.operations.len();
    let generation = job.target_generation();
    let (mut rows, mut planned_dexels, mut records, mut evaluations) = (0.0, 0.0, 0.0, 0.0);
    for (tooth, side) in facts
        .iter()
        .step_by(facts.len().div_ceil(PLANNED_FLANKS).max(1))
        .zip([Side::Left, Side::Right].into_iter().cycle())
    {
        let flank = job.target_flank(&generation, tooth.tooth, side)?;
        let field = some_tiles(job.flank_field(&flank));
        rows = field.rows() as f64;
        planned_dexels += field.len() as f64;
        for operation in &job.operations {
            let plan = CutPlan::new(&field, &operation.strokes, &job.cutter);
            records += plan.records.len() as f64;
            evaluations += plan.dexel_passes() as f64;
        }
    }
    let spacing_mm = job.scene.fields.profile_spacing_mm;
    let columns = |length_mm: f64| (length_mm / spacing_mm).floor() + 1.0;
    let per_flank: Vec<f64> =
        facts.iter().flat_map(ToothFacts::flanks).map(|(_, flank)| columns(flank.length_mm) * rows).collect();
    let (dexels, largest) = (per_flank.iter().sum::<f64>(), per_flank.iter().copied().fold(0.0, f64::max));
    let scale = dexels / planned_dexels;
    let cores = rayon::current_num_threads();
    let seconds = evaluations * scale / (EVALUATIONS_PER_SECOND_AND_THREAD * cores as f64);
    let bytes = cores as f64
        * (largest * (BYTES_PER_DEXEL * surfaces) as f64
            + records / planned_dexels * largest * size_of::<PassRecord>() as f64);

    sheet.heading("Cost of the cut (nothing has been cut)");
    sheet.line(
        "flank fields",
        format!(
            "{} of at most {:.2} million dexels, {} by {} um; {:.1} million in all",
            per_flank.len(),
            1e-6 * largest,
            plain(1e3 * spacing_mm),
            plain(1e3 * job.scene.fields.lead_spacing_mm),
            1e-6 * dexels
        ),
    );
    sheet.line(
        "evaluations",
        format!(
            "{:.0} million dexels against passes, {:.1} per dexel and operation, from {} thousand records",
            1e-6 * evaluations * scale,
            evaluations / (planned_dexels * surfaces as f64),
            (1e-3 * records * scale).round()
        ),
    );
    sheet.line("memory", format!("{:.0} MB: one flank at a time on each of {cores} threads", 1e-6 * bytes));
    sheet.line(
        "time",
        format!(
            "{} on the processor at {:.0} million evaluations per second and thread; files come on top",
            duration_text(seconds),
            1e-6 * EVALUATIONS_PER_SECOND_AND_THREAD
        ),
    );
    Ok(())
}

/// Whole tiles spread evenly over a field, so that planning them takes the same time whatever the spacing.
fn some_tiles(field: Field) -> Field {
    let every = field.columns.len().div_ceil(TILE_COLUMNS * PLANNED_TILES).max(1);
    let columns = field.columns.chunks(TILE_COLUMNS).step_by(every).flatten().copied().collect();
    Field { columns, ..field }
}
