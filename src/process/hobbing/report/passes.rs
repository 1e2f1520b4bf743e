//! The hob pass by pass, for the page's 3D view: where it is, and what each pass takes.
//!
//! In: passes of all operations, what they took of the blank. Out: the teeth that cut, each by its edge and a thickness
//! behind its rake face, and the poses of the hob in the gear when the tooth of a pass points to the work. Passes that
//! take nothing are left out.

use crate::output::report::viewer::{ViewerStroke, ViewerStrokes};
use crate::process::hobbing::HobCutter;
use crate::process::hobbing::blank::HobbedBlank;
use crate::surface::prism::blade;
use crate::surface::triangles::Triangles;
use gearcut_core::cut::sweep_chips::PassChip;
use gearcut_core::units::{TURN_RAD, UM_PER_MM};
use std::collections::BTreeSet;

/// More passes than this are thinned by a whole factor: they take some half a megabyte of the page.
const MOST_PASSES: usize = 8_000;
/// Thickness of a drawn tooth, as a share of the way from gash to gash at the pitch radius.
const THICKNESS: f64 = 0.25;
/// Chords of a drawn edge, mm: a tenth of a pixel of the view.
const CHORD_MM: f64 = 0.05;

/// Passes of a job that take something.
pub fn passes(cutter: &HobCutter, blank: &HobbedBlank) -> ViewerStrokes {
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
    for index in cutting {
        tool.add_mesh(&blade(&job.hob, index, cutter.operations[0].turn, behind_mm, CHORD_MM));
    }
    let operations = job.operations.iter().zip(cutter.operations.iter());
    ViewerStrokes {
        tool,
        noun: "pass",
        operations: operations.map(|(of, set)| (of.spec.name.clone(), set.count() as usize)).collect(),
        words: "chip {0} mm³, {1} µm thick, {2} mm long, hob tooth {3}",
        names: job.hob.labels(),
        strokes: strokes.collect(),
    }
}
