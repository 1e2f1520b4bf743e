//! Chatter of the cutter: how it vibrates in every stroke under the force of its own chips.
//!
//! In: a job whose strokes are where they are deflected to, and the mass ([`crate::machine_errors::OneMass`]). Out: a
//! [`Vibration`] for every operation; a job with it has flanks that follow, row by row.
//!
//! Law: the strokes are followed in order of time, each from the entry into the face to its end; then the mass rings
//! down until the ram is back. A stroke's force is that of its chips as the ledger sees them where the deflection holds
//! the cutter, element by element of the edge ([`crate::machine_errors::ChipForce`]); the surface that it finds is the
//! one of the stroke before, at the same place along the tooth. The mean over a long stroke is the deflection; at the
//! entry the cutter comes from where it swings freely, and the force jumps.
//!
//! What is simplified: all chips of a stroke meet the wave of the stroke before, those at the edge of old stock as
//! well, which makes chatter likelier. The chips on each side of the coordinate share one wave, which is lost where the
//! last of them is. No wave of an operation is met by the next one. The whole blank, the ledger and the chips on maps
//! are those of the deflected strokes without vibration.
//!
//! Road not taken: a ledger of chips in each of some hundred sections along the tooth. It would follow every element's
//! own old surface, and take a hundred times as long.

use super::deflection::{LARGEST_MODULES, deflections, lengths_mm};
use super::space::middle_pose;
use super::stroke_looks::{look, through_time};
use crate::machine_errors::{Chatter, ChipForce};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::motion::vibration::{FaceTimes, StrokeVibration, Vibration};
use crate::process::shaping::scene::model::MachineVibration;
use gearcut_core::error::Refusal;
use gearcut_core::units::UM_PER_MM;

/// Displacements of an operation at most: a gigabyte.
const MOST_MOMENTS: usize = 1 << 28;

/// The gear as the machine really cuts it: strokes deflected, and vibrating where the scene says; the job itself on a
/// rigid machine. `advance` is called after every stroke of either and says whether to go on. `None`: stopped.
///
/// # Errors
/// Those of [`deflections`], and vibrations that are as large.
pub fn as_cut(job: &ShapingJob, advance: &(dyn Fn() -> bool + Sync)) -> Result<Option<ShapingJob>, Refusal> {
    if job.machine.compliance.is_none() {
        return Ok(Some(job.clone()));
    }
    let Some(found) = deflections(job, advance)? else { return Ok(None) };
    let deflected = job.deflected(found);
    let Some(machine) = job.machine.vibration else { return Ok(Some(deflected)) };
    Ok(vibrations(&deflected, &machine, advance)?.map(|found| deflected.vibrating(found)))
}

/// Vibration of every operation; as for [`as_cut`].
fn vibrations(
    job: &ShapingJob,
    machine: &MachineVibration,
    advance: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Vec<Vibration>>, Refusal> {
    let mass = machine.mass(&job.machine.compliance);
    let width_mm = job.scene.gear.face_width_mm;
    let times = FaceTimes::new(job.machine.crank(width_mm), width_mm);
    let limit_mm = LARGEST_MODULES * job.scene.gear.module_mm;
    let timing = |operation: usize| {
        let stroke_s = job.operations[operation].schedule.time_s(1.0);
        let cut_s = times.cut_share() * stroke_s;
        (cut_s, stroke_s - cut_s, Chatter::steps_in(&mass, cut_s))
    };
    for (index, operation) in job.operations.iter().enumerate() {
        let (_, _, steps) = timing(index);
        if operation.count() * (steps + 1) > MOST_MOMENTS {
            return Err(Refusal::new(
                "machine.vibration.natural_frequency_hz",
                format!(
                    "operation {}: {} strokes in {steps} steps each are more than {MOST_MOMENTS} displacements",
                    operation.spec.name,
                    operation.count()
                ),
                "take a lower frequency, more double_strokes_per_minute or fewer strokes_per_revolution",
            ));
        }
    }
    let fresh = |operation: usize| {
        let (cut_s, _, steps) = timing(operation);
        Chatter::new(mass, cut_s / steps as f64, steps)
    };
    let mut chatter = fresh(0);
    let mut off: Vec<Vec<f32>> = vec![Vec::new(); job.operations.len()];
    let found = through_time(job, 0.0, advance, |teeth, cut, operation, stroke| {
        if stroke == 0 {
            chatter = fresh(operation);
        }
        let pose = middle_pose(job, operation, stroke);
        let seen = look(cut, &pose, teeth);
        let moved = seen.elements.iter().map(|of| of.chip_n_per_mm * of.moves[machine.axis].powi(2)).sum::<f64>();
        let force = ChipForce::of_sides(&seen.elements, machine.axis, seen.load[machine.axis]);
        let rest = job.operations[operation].deflections[stroke].coordinates()[machine.axis];
        let displaced = chatter.stroke(&force, rest);
        chatter.ring_down(timing(operation).1);
        let most = displaced.iter().fold(0.0_f64, |most, off| most.max(off.abs()));
        let most_mm = most * lengths_mm(job, &pose)[machine.axis];
        if most_mm > limit_mm {
            let name = &job.operations[operation].spec.name;
            return Err(Refusal::new(
                "machine.vibration",
                format!(
                    "operation {name}, stroke {stroke}: the cutter vibrates by {:.0} um, more than a tenth of the \
                    module",
                    UM_PER_MM * most_mm
                ),
                "look at the compliance and the damping ratio, or let the cutter in gradually (operation.infeed)",
            ));
        }
        let mean_square = displaced.iter().map(|off| off * off).sum::<f64>() / displaced.len() as f64;
        off[operation].extend(displaced.iter().map(|&off| off as f32));
        Ok((StrokeVibration { share_of_limit: moved / mass.least_limit(), rms: mean_square.sqrt() }, pose))
    })?;
    let with_strokes = |(strokes, off)| Vibration { axis: machine.axis, times, off, strokes };
    Ok(found.map(|found| found.into_iter().zip(off).map(with_strokes).collect()))
}
