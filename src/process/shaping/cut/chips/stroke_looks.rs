//! All strokes in order of time, with the chips that each of them finds.
//!
//! In: a job, and for every stroke a pose that the caller chooses when the stroke's turn has come. Out: the chips of a
//! stroke in a pose that is tried ([`look`]), as elements of the edge with their forces; then they are taken away. All
//! tooth spaces are cut at the same time, for the forces of all cutter teeth in the cut add up.

use super::oblique::ElementForce;
use super::section::SpaceSection;
use super::space::{LEAST_AREA_MM2, Space, SpacePass, contours};
use crate::machine_errors::{Deflection, EdgeElement};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::tool::edge_polygon::EdgePolygon;
use gearcut_core::error::Refusal;
use gearcut_core::frame::Rigid2;
use gearcut_core::tool::{CuttingTool, PlanarTool};
use glam::{DVec2, DVec4};
use rayon::prelude::*;
use std::ops::Range;

/// Goes through the strokes of all operations. `judge` gives what is wanted of a stroke and the pose in which its chips
/// are taken away, at most `room_mm` from where the job has it; `advance` is called after every stroke and says whether
/// to go on. `None`: stopped.
///
/// # Errors
/// Those of `judge`.
pub(super) fn through_time<T>(
    job: &ShapingJob,
    room_mm: f64,
    advance: &(dyn Fn() -> bool + Sync),
    mut judge: impl FnMut(&Teeth, &mut [&mut SpaceInWork], usize, usize) -> Result<(T, Rigid2), Refusal>,
) -> Result<Option<Vec<Vec<T>>>, Refusal> {
    let polygon = EdgePolygon::new(job.cutter.edge(), job.chip_spacing_mm);
    let teeth = Teeth {
        polygon: &polygon,
        forces: ElementForce::along_edge(&job.material, job.cutter_spec.rake_angle_rad, &polygon.stations),
        tool_from_blade: (0..job.cutter.blade_count()).map(|blade| job.cutter.tool_from_blade(blade)).collect(),
        work_axis_mm: -job.eccentricity_mm(),
    };
    let contours_mm = contours(job);
    let spaces = job.spaces().into_par_iter();
    let mut spaces: Vec<SpaceInWork> = spaces
        .map(|number| {
            let space = Space::new(job, &polygon, &contours_mm, number, room_mm);
            SpaceInWork {
                section_from_work: space.work_from_section.inverse(),
                section: space.section(),
                space,
                now: 0..0,
                thickness_mm: Vec::new(),
            }
        })
        .collect();
    let mut found = Vec::with_capacity(job.operations.len());
    for operation in 0..job.operations.len() {
        let mut of_strokes = Vec::with_capacity(job.operations[operation].count());
        for stroke in 0..job.operations[operation].count() {
            let mut cut: Vec<&mut SpaceInWork> =
                spaces.iter_mut().filter_map(|space| space.begin(operation, stroke)).collect();
            let (wanted, pose) = judge(&teeth, &mut cut, operation, stroke)?;
            cut.par_iter_mut().for_each(|space| space.take_away(&pose, &teeth));
            of_strokes.push(wanted);
            if !advance() {
                return Ok(None);
            }
        }
        found.push(of_strokes);
    }
    Ok(Some(found))
}

/// The chips of a stroke in a pose: all its cutter teeth together.
pub(super) fn look(cut: &mut [&mut SpaceInWork], work_from_tool: &Rigid2, teeth: &Teeth) -> StrokeLook {
    let looks: Vec<StrokeLook> = cut.par_iter_mut().map(|space| space.look(work_from_tool, teeth)).collect();
    let load = looks.iter().map(|look| look.load).sum();
    StrokeLook { elements: looks.into_iter().flat_map(|look| look.elements).collect(), load }
}

/// The cutter's teeth with the law of their forces.
pub(super) struct Teeth<'a> {
    polygon: &'a EdgePolygon,
    forces: Vec<ElementForce>,
    tool_from_blade: Vec<Rigid2>,
    /// Work spindle in the gear frame.
    pub(super) work_axis_mm: DVec2,
}

/// A space, what is left in it, and its passes in the stroke under way.
pub(super) struct SpaceInWork<'a> {
    space: Space<'a>,
    section: SpaceSection<'a>,
    section_from_work: Rigid2,
    now: Range<usize>,
    thickness_mm: Vec<f64>,
}

/// A look at the chips of a stroke: elements in contact, and what the forces along inclined edges push with.
#[derive(Default)]
pub(super) struct StrokeLook {
    pub(super) elements: Vec<EdgeElement>,
    pub(super) load: DVec4,
}

impl SpaceInWork<'_> {
    /// Finds the passes of a stroke; nothing where none comes near.
    fn begin(&mut self, operation: usize, stroke: usize) -> Option<&mut Self> {
        let from = self.now.end;
        let of_stroke = |pass: &&SpacePass| pass.operation as usize == operation && pass.stroke as usize == stroke;
        let count = self.space.passes[from..].iter().take_while(of_stroke).count();
        self.now = from..from + count;
        (count > 0).then_some(self)
    }

    fn section_from_blade(&self, work_from_tool: &Rigid2, pass: &SpacePass, teeth: &Teeth) -> Rigid2 {
        self.section_from_work.after(work_from_tool).after(&teeth.tool_from_blade[pass.blade as usize])
    }

    /// Measures the chips of this space's own teeth and gives them back.
    fn look(&mut self, work_from_tool: &Rigid2, teeth: &Teeth) -> StrokeLook {
        let mut look = StrokeLook::default();
        for index in self.now.clone() {
            let pass = self.space.passes[index];
            if !pass.own {
                continue;
            }
            let section_from_blade = self.section_from_blade(work_from_tool, &pass, teeth);
            let area_mm2 = self.section.cut(&section_from_blade);
            if area_mm2 >= LEAST_AREA_MM2 {
                self.section.thickness_mm(&section_from_blade, &mut self.thickness_mm);
                let work_from_blade = self.space.work_from_section.after(&section_from_blade);
                look.add(teeth, &self.thickness_mm, &work_from_blade, work_from_tool.translation_mm);
            }
            self.section.put_back();
        }
        look
    }

    fn take_away(&mut self, work_from_tool: &Rigid2, teeth: &Teeth) {
        for index in self.now.clone() {
            let pass = self.space.passes[index];
            let section_from_blade = self.section_from_blade(work_from_tool, &pass, teeth);
            self.section.cut(&section_from_blade);
        }
    }
}

impl StrokeLook {
    fn add(&mut self, teeth: &Teeth, thickness_mm: &[f64], work_from_blade: &Rigid2, tool_axis_mm: DVec2) {
        let stations = teeth.polygon.stations.iter().zip(&teeth.forces).zip(thickness_mm);
        for ((station, force), &thickness_mm) in stations.filter(|(_, thickness_mm)| **thickness_mm > 0.0) {
            let point_mm = work_from_blade.point(station.point_mm);
            let normal = work_from_blade.direction(station.normal);
            let moves = |direction: DVec2| Deflection::moves(point_mm, direction, teeth.work_axis_mm, tool_axis_mm);
            let [_, normal_n_per_mm2, along_n_per_mm2] = force.chip_n_per_mm2;
            self.elements.push(EdgeElement {
                thickness_mm,
                moves: moves(normal),
                chip_n_per_mm: normal_n_per_mm2 * station.length_mm,
                edge_n: force.edge_n_per_mm[1] * station.length_mm,
            });
            let along_n = along_n_per_mm2 * thickness_mm * station.length_mm;
            if along_n != 0.0 {
                self.load += along_n * moves(normal.perp());
            }
        }
    }
}
