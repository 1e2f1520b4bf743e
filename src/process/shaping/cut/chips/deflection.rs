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

use super::space::middle_pose;
use super::stroke_looks::{SpaceInWork, Teeth, look, through_time};
use crate::machine_errors::{Deflection, NoBalance, balance};
use crate::process::shaping::ShapingJob;
use gearcut_core::error::Refusal;
use gearcut_core::frame::Rigid2;
use gearcut_core::units::UM_PER_MM;
use glam::DVec4;

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
pub(super) const LARGEST_MODULES: f64 = 0.1;

/// Deflection of every stroke of every operation; `advance` is called after every stroke and says whether to go on.
/// `None`: stopped.
///
/// # Errors
/// A displacement of more than a tenth of the module, or one that does not settle.
pub fn deflections(
    job: &ShapingJob,
    advance: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Vec<Vec<Deflection>>>, Refusal> {
    let limit_mm = LARGEST_MODULES * job.scene.gear.module_mm;
    let mut before = Deflection::default();
    through_time(job, limit_mm, advance, |teeth, cut, operation, stroke| {
        if stroke == 0 {
            before = Deflection::default();
        }
        let rest = YieldingStroke { job, teeth, commanded: middle_pose(job, operation, stroke), limit_mm };
        before = rest.settle(cut, before).map_err(|unsettled| unsettled.told(job, operation, stroke))?;
        Ok((before, before.displaced(&rest.commanded, teeth.work_axis_mm)))
    })
}

/// How far each coordinate moves a point of the edge at most: 1, or mm for a rad.
pub(super) fn lengths_mm(job: &ShapingJob, work_from_tool: &Rigid2) -> DVec4 {
    let to_work_mm = work_from_tool.translation_mm.distance(-job.eccentricity_mm());
    let tool_mm = job.cutter.tip_radius_mm;
    DVec4::new(1.0, 1.0, tool_mm, to_work_mm + tool_mm)
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
            let seen = look(cut, &pose, self.teeth);
            let wanted = balance(diagonal, &seen.elements, q, seen.load).map_err(Unsettled::NoBalance)?;
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

    fn lengths_mm(&self) -> DVec4 {
        lengths_mm(self.job, &self.commanded)
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
