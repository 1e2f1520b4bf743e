//! The hob pass by pass, for the page's 3D view: where it is, what each pass takes, and the work after it.
//!
//! In: passes of all operations, what they took of the blank. Out: the teeth that cut, each by its edge and a thickness
//! behind its rake face, on a round body without gashes, and the poses of the hob in the gear when the tooth of a pass
//! points to the work. Passes that take nothing are left out.

use crate::output::report::viewer::{ViewerStroke, ViewerStrokes};
use crate::process::hobbing::blank::HobbedBlank;
use crate::process::hobbing::{HobCutter, HobbingJob};
use crate::steps::report::work;
use crate::surface::mesh::Mesh;
use crate::surface::prism::{blade, prism};
use crate::surface::triangles::Triangles;
use gearcut_core::cut::sweep_chips::PassChip;
use gearcut_core::error::Result;
use gearcut_core::units::{TURN_RAD, UM_PER_MM};
use glam::DVec2;
use std::collections::BTreeSet;

/// More passes than this are thinned by a whole factor: they take some half a megabyte of the page.
const MOST_PASSES: usize = 8_000;
/// Thickness of a drawn tooth, as a share of the way from gash to gash at the pitch radius.
const THICKNESS: f64 = 0.25;
/// Chords of a drawn edge, mm: a tenth of a pixel of the view.
const CHORD_MM: f64 = 0.05;
/// Points of the body's rim.
const RIM_POINTS: u32 = 96;

/// Passes of a job that take something.
///
/// # Errors
/// A field that does not fit in memory.
pub fn passes(cutter: &HobCutter, blank: &HobbedBlank) -> Result<ViewerStrokes> {
    let job = cutter.job;
    let taking = cutter.operations.iter().zip(&blank.chips).enumerate().flat_map(|(operation, (set, chips))| {
        let mut taking: Vec<&PassChip> = chips.iter().filter(|chip| chip.volume_mm3() > 0.0).collect();
        taking.sort_by_key(|chip| chip.pass);
        taking.into_iter().map(move |chip| (operation, set, chip))
    });
    let taking: Vec<_> = taking.collect();
    let cutting: BTreeSet<u32> = taking.iter().map(|(_, set, chip)| set.blade_of(chip.pass).1).collect();
    let every = taking.len().div_ceil(MOST_PASSES).max(1);
    let strokes = taking.iter().step_by(every).map(|(operation, set, chip)| {
        let own = chip.pass - set.first_pass;
        let tooth = f64::from(set.blade_of(chip.pass).1);
        ViewerStroke {
            place: [*operation, own as usize],
            gear_from_tool: set.work_from_tool(&set.pass(own)),
            taken: [chip.volume_mm3(), UM_PER_MM * chip.thickness_mm, chip.travel_mm, tooth],
        }
    });
    let behind_mm = THICKNESS * TURN_RAD / f64::from(job.hob.gashes) * job.hob.pitch_radius_mm;
    let mut tool = Triangles::default();
    let mut parts = vec![[0, 0]; job.hob.teeth.len()];
    for index in cutting {
        let first = tool.indices.len();
        tool.add_mesh(&blade(&job.hob, index, cutter.operations[0].turn, behind_mm, CHORD_MM));
        parts[index as usize] = [first, tool.indices.len() - first];
    }
    tool.add_mesh(&body(job, &tool));
    let operations = job.operations.iter().zip(cutter.operations.iter());
    let last_passes: Vec<u32> = taking.iter().step_by(every).map(|(_, _, chip)| chip.pass).collect();
    let uncut = work::field(&job.scene, &job.stock, false)?;
    Ok(ViewerStrokes {
        tool,
        noun: "pass",
        operations: operations.map(|(of, set)| (of.spec.name.clone(), set.count() as usize)).collect(),
        words: "chip {0} mm³, {1} µm thick, {2} mm long, hob tooth {3}",
        names: job.hob.labels(),
        parts,
        strokes: strokes.collect(),
        work: work::watched(uncut, &last_passes, |field, watch| Ok(cutter.cut_blank_watched(field, watch)?))?,
    })
}

/// A cylinder below the drawn teeth, as long as the row of all teeth.
fn body(job: &HobbingJob, teeth: &Triangles) -> Mesh {
    let radii_mm = teeth.positions_mm.iter().map(|at| f64::from(at[0]).hypot(f64::from(at[1])));
    let radius_mm = radii_mm.fold(job.hob.pitch_radius_mm, f64::min);
    let along_mm = job.hob.teeth.iter().map(|tooth| tooth.axial_mm);
    let (low_mm, high_mm) = along_mm.fold((0.0_f64, 0.0_f64), |(low, high), z| (low.min(z), high.max(z)));
    let rim_mm = |i: u32| radius_mm * DVec2::from_angle(TURN_RAD * f64::from(i) / f64::from(RIM_POINTS));
    let beyond_mm = 0.5 * job.hob.axial_pitch_mm;
    prism(&[(0..RIM_POINTS).map(rim_mm).collect()], [low_mm - beyond_mm, high_mm + beyond_mm])
}
