//! How far tool and work give way in every stroke: the balance of the cut with a machine that yields.
//!
//! In: a job of a machine with compliance, its strokes where the axes put them. Out: a [`Deflection`] for every stroke
//! of every operation. Whoever displaces the strokes by it has the poses of which flanks, maps, textures and chips
//! follow.
//!
//! **Order.** Strokes follow each other in time, and each finds what the deflected ones before it have left. So this
//! goes through time once, stroke by stroke over all tooth spaces at the same time, for the forces of all cutter teeth
//! in the cut add up. A stroke is looked at (its chips are measured with the cutter where it is thought to stand, and
//! given back), the balance of its chips with the machine is found ([`crate::machine_errors::balance`]), it is looked
//! at there, and so on until it stays; then its chips are taken away. Between two looks thickness follows the cutter
//! linearly, along the edge's normal: edge and old surface are parallel within milliradians, so that a look nearly
//! always confirms the one before. The chips are those of the ledger ([`super::section`]), and so is the law of their
//! forces; the cost grows with the number of strokes.
//!
//! **One displacement for a stroke.** The force on a straight tooth is that of the section that is being cut, the same
//! from one end of the face to the other while the axes rest. So the whole stroke is displaced alike. The start of the
//! cut, where the force rises from nothing, is left out: a machine follows within milliseconds, and vibrates about it.
//! Where the feed goes on during a stroke, or a guide leads the cutter aside, the section in the middle of the face
//! stands for all, as in the ledger. Return strokes cut nothing and are not displaced.
//!
//! Road not taken: displacements from the forces of the rigid machine. They are too large by as much as the cut is
//! stiff, and miss that what one stroke leaves the next one takes.

use super::oblique::ElementForce;
use super::section::SpaceSection;
use super::space::{LEAST_AREA_MM2, Space, SpacePass, contours, middle_pose};
use crate::machine_errors::{Deflection, EdgeElement, NoBalance, balance};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::tool::edge_polygon::EdgePolygon;
use gearcut_core::error::Refusal;
use gearcut_core::frame::Rigid2;
use gearcut_core::tool::{CuttingTool, PlanarTool};
use gearcut_core::units::UM_PER_MM;
use glam::{DVec2, DVec4};
use rayon::prelude::*;
use std::ops::Range;

/// A look that moves no point of the edge by more than this is the last one, mm. The next one would move it by a
/// hundredth of that, a fiftieth in one case of ten (counted on a round gear of module 3): 10 nm, where the ledger's
/// thicknesses are good to 100.
const SETTLED_MM: f64 = 5e-4;
/// Looks at a stroke at most. One or two are usual.
const MOST_LOOKS: usize = 40;
/// A step that turns back and is not shorter than this share of the one before shows a force that jumps between both.
const TURNING_SHARE: f64 = 0.5;
/// Largest displacement of a point of the edge, in modules. Compliances are measured over tens of micrometres; beyond
/// this the cutter does not cut this gear any more. A choice, not a limit of the method.
const LARGEST_MODULES: f64 = 0.1;

/// Deflection of every stroke of every operation; `advance` is called after every stroke and says whether to go on.
/// `None`: stopped.
///
/// # Errors
/// A displacement of more than a tenth of the module, or one that does not settle.
pub fn deflections(
    job: &ShapingJob,
    advance: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Vec<Vec<Deflection>>>, Refusal> {
    let polygon = EdgePolygon::new(job.cutter.edge(), job.chip_spacing_mm);
    let teeth = Teeth {
        polygon: &polygon,
        forces: ElementForce::along_edge(&job.material, job.cutter_spec.rake_angle_rad, &polygon.stations),
        tool_from_blade: (0..job.cutter.blade_count()).map(|blade| job.cutter.tool_from_blade(blade)).collect(),
        work_axis_mm: -job.eccentricity_mm(),
    };
    let limit_mm = LARGEST_MODULES * job.scene.gear.module_mm;
    let contours_mm = contours(job);
    let spaces = job.spaces().into_par_iter();
    let mut spaces: Vec<SpaceInWork> = spaces
        .map(|number| {
            let space = Space::new(job, &polygon, &contours_mm, number, limit_mm);
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
        let mut of_strokes: Vec<Deflection> = Vec::with_capacity(job.operations[operation].count());
        for stroke in 0..job.operations[operation].count() {
            let mut cut: Vec<&mut SpaceInWork> =
                spaces.iter_mut().filter_map(|space| space.begin(operation, stroke)).collect();
            let commanded = middle_pose(job, operation, stroke);
            let before = of_strokes.last().copied().unwrap_or_default();
            let rest = YieldingStroke { job, teeth: &teeth, commanded, limit_mm };
            let settled = rest.settle(&mut cut, before).map_err(|unsettled| unsettled.told(job, operation, stroke))?;
            let pose = settled.displaced(&commanded, teeth.work_axis_mm);
            cut.par_iter_mut().for_each(|space| space.take_away(&pose, &teeth));
            of_strokes.push(settled);
            if !advance() {
                return Ok(None);
            }
        }
        found.push(of_strokes);
    }
    Ok(Some(found))
}

/// The cutter's teeth with the law of their forces.
struct Teeth<'a> {
    polygon: &'a EdgePolygon,
    forces: Vec<ElementForce>,
    tool_from_blade: Vec<Rigid2>,
    /// Work spindle in the gear frame.
    work_axis_mm: DVec2,
}

/// A space, what is left in it, and its passes in the stroke under way.
struct SpaceInWork<'a> {
    space: Space<'a>,
    section: SpaceSection<'a>,
    section_from_work: Rigid2,
    now: Range<usize>,
    thickness_mm: Vec<f64>,
}

/// A look at the chips of a stroke: elements in contact, and what the forces along inclined edges push with.
#[derive(Default)]
struct StrokeLook {
    elements: Vec<EdgeElement>,
    load: DVec4,
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

/// One stroke of a machine that yields.
struct YieldingStroke<'a> {
    job: &'a ShapingJob,
    teeth: &'a Teeth<'a>,
    commanded: Rigid2,
    limit_mm: f64,
}

/// A stroke that finds no balance.
enum Unsettled {
    /// The balance displaces a point of the edge by more than the limit.
    TooFar { displaced_mm: f64 },
    /// The last look still changed it.
    StillMoving { displaced_mm: f64, still_mm: f64 },
    /// The chips of a look have no balance.
    NoBalance(NoBalance),
}

impl YieldingStroke<'_> {
    /// The displacement in balance with the chips that are then cut, from one that is thought to be near.
    fn settle(&self, cut: &mut [&mut SpaceInWork], near: Deflection) -> Result<Deflection, Unsettled> {
        let diagonal = self.job.machine.compliance.diagonal();
        let mut q = near.coordinates();
        let (mut last_pull, mut share) = (DVec4::ZERO, 1.0);
        let mut still_mm = 0.0;
        for _ in 0..MOST_LOOKS {
            let pose = Deflection::of_coordinates(q).displaced(&self.commanded, self.teeth.work_axis_mm);
            let looks: Vec<StrokeLook> = cut.par_iter_mut().map(|space| space.look(&pose, self.teeth)).collect();
            let load = looks.iter().map(|look| look.load).sum();
            let elements: Vec<EdgeElement> = looks.into_iter().flat_map(|look| look.elements).collect();
            let wanted = balance(diagonal, &elements, q, load).map_err(Unsettled::NoBalance)?;
            // A chip so thin that the rays no longer see it pushes no more, and is seen again when the cutter falls
            // back: with half a step at every turn it comes to rest where the chip is lost.
            let pull = wanted - q;
            let turns = (self.lengths_mm() * pull).dot(self.lengths_mm() * last_pull) < 0.0;
            if turns && self.moved_mm(pull) > TURNING_SHARE * self.moved_mm(last_pull) {
                share *= 0.5;
            }
            last_pull = pull;
            let next = self.within_limit(q + share * pull);
            still_mm = self.moved_mm(next - q);
            q = next;
            if still_mm < SETTLED_MM {
                let displaced_mm = self.moved_mm(wanted);
                let settled = Ok(Deflection::of_coordinates(q));
                return if displaced_mm <= self.limit_mm { settled } else { Err(Unsettled::TooFar { displaced_mm }) };
            }
        }
        Err(Unsettled::StillMoving { displaced_mm: self.moved_mm(q), still_mm })
    }

    /// How far each coordinate moves a point of the edge at most: 1, or mm for a rad.
    fn lengths_mm(&self) -> DVec4 {
        let to_work_mm = self.commanded.translation_mm.distance(self.teeth.work_axis_mm);
        let tool_mm = self.job.cutter.tip_radius_mm;
        DVec4::new(1.0, 1.0, tool_mm, to_work_mm + tool_mm)
    }

    /// No point of the edge goes further than this, mm.
    fn moved_mm(&self, q: DVec4) -> f64 {
        let [radial, tangential, tool, work] = (self.lengths_mm() * q).to_array();
        radial.hypot(tangential) + tool.abs() + work.abs()
    }

    fn within_limit(&self, q: DVec4) -> DVec4 {
        let moved_mm = self.moved_mm(q);
        if moved_mm > self.limit_mm { q * (self.limit_mm / moved_mm) } else { q }
    }
}

impl Unsettled {
    fn told(&self, job: &ShapingJob, operation: usize, stroke: usize) -> Refusal {
        let name = &job.operations[operation].spec.name;
        let (problem, way_out) = match self {
            Self::TooFar { displaced_mm } => (
                format!(
                    "the cut pushes the cutter {:.0} um away, more than a tenth of the module",
                    UM_PER_MM * displaced_mm
                ),
                "let the cutter in gradually (operation.infeed, more strokes_per_revolution), or look at the \
                compliances",
            ),
            Self::StillMoving { displaced_mm, still_mm } => (
                format!(
                    "the deflection does not settle: {:.2} um, still changing by {:.2} um after {MOST_LOOKS} looks",
                    UM_PER_MM * displaced_mm,
                    UM_PER_MM * still_mm
                ),
                "take a smaller fields.chips.spacing_mm, more strokes_per_revolution, or smaller compliances",
            ),
            Self::NoBalance(lost) => (
                lost.to_string(),
                "look at the compliances, the coefficients of [material] and the cutter's rake angle",
            ),
        };
        Refusal::new("machine.compliance", format!("operation {name}, stroke {stroke}: {problem}"), way_out)
    }
}
