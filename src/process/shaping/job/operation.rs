//! One operation of a shaping job: its strokes, what they generate, and what it refuses.
//!
//! In: what the scene says of it, the gear, the cutter. Out: [`PreparedOperation`]; how far the depth follows the
//! thickness of the teeth; refusals of rims and programs.

use crate::machine_errors::Deflection;
use crate::process::shaping::ShaperCutter;
use crate::process::shaping::linkage::{CutterPose, ShapingLinkage, StrokeSchedule};
use crate::process::shaping::motion::actual::{ActualStrokes, Commanded};
use crate::process::shaping::motion::gcode;
use crate::process::shaping::motion::gcode::AxisProgram;
use crate::process::shaping::motion::returns::RetractionPlan;
use crate::process::shaping::motion::returns::facts::ReturnFacts;
use crate::process::shaping::motion::returns::survey::Survey;
use crate::process::shaping::motion::vibration::Vibration;
use crate::process::shaping::round_mesh::RoundMesh;
use crate::process::shaping::scene::model::{CutterSpec, Operation};
use crate::process::shaping::target::TargetFlank;
use crate::process::shaping::target::generation::Generation;
use crate::process::shaping::tool::involute_tooth::PROFILE_SHIFT;
use crate::scene::model::Gear;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::gear::GearKind;
use gearcut_core::gear::blank::Blank;
use gearcut_core::math::roots::sample_angle_rad;
use gearcut_core::passes::StrokeSet;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// A program under test makes this many times the strokes of the scene at most.
const MOST_TIMES_THE_STROKES: usize = 10;

/// One operation with its strokes.
#[derive(Debug, Clone)]
pub struct PreparedOperation {
    /// What the scene says, its offset with that of profile shifts and thickness allowance.
    pub spec: Operation,
    /// How far the cutter stays back from the depth that makes the teeth as drawn, mm.
    pub short_of_depth_mm: f64,
    /// The linkage.
    pub linkage: ShapingLinkage,
    /// What it generates in the limit of many strokes.
    pub generation: Arc<Generation>,
    /// Flanks of that, tooth by tooth, left before right, once they have been asked for: none where nothing is
    /// generated. Of the finishing operation they are no targets, which know of pointed teeth.
    pub(super) envelope: Arc<[OnceLock<Option<TargetFlank>>]>,
    /// Axis positions at every stroke.
    pub schedule: StrokeSchedule,
    /// Axis program that is cut instead of the schedule, if the scene names one.
    pub program: Option<AxisProgram>,
    /// What the machine makes of both.
    pub actual: ActualStrokes,
    /// Poses for the dexels.
    pub strokes: StrokeSet,
    /// How the cut displaces the cutter in every stroke; empty on a rigid machine.
    pub deflections: Vec<Deflection>,
    /// How it vibrates about that, row by row along the tooth; `None`: it does not.
    pub vibration: Option<Arc<Vibration>>,
    /// Return strokes over a turn, of ideal work and cutter; the same for a machine that yields.
    pub survey: Arc<Survey>,
    /// Which way the cutter is drawn back for the return strokes.
    pub retraction: RetractionPlan,
    /// What is known of them before cutting, once it has been asked for.
    pub(super) returns: OnceLock<Result<ReturnFacts, Refusal>>,
}

impl PreparedOperation {
    /// Strokes of half a turn of the work: strokes that are further apart and meet on a flank belong to different
    /// turns.
    pub fn half_turn(&self) -> usize {
        self.schedule.strokes_per_revolution() as usize / 2
    }

    /// How many strokes are cut: those of the program, or the scene's own.
    pub fn count(&self) -> usize {
        self.strokes.count()
    }

    /// Work angle at a stroke coordinate as commanded, rad: by the program that is cut, or by the schedule.
    pub fn work_angle_rad(&self, stroke: f64) -> f64 {
        match &self.program {
            Some(program) => program.at(stroke).psi_c_rad,
            None => self.schedule.state(stroke).psi_c_rad,
        }
    }

    /// Cutter in the spindle's frame at a stroke coordinate, where the axes really are.
    pub fn pose(&self, stroke: f64) -> CutterPose {
        self.pose_at_rest(stroke, 0.0)
    }

    /// The same so many double strokes later while the feed rests: noise goes on.
    pub fn pose_at_rest(&self, stroke: f64, later: f64) -> CutterPose {
        self.actual.pose(self.commanded(), stroke, later)
    }

    /// Whether the envelope of an operation of the same gear with such a cutter is this one's.
    pub(super) fn generates_as(&self, spec: &Operation) -> bool {
        (self.spec.linkage, self.spec.offset_mm) == (spec.linkage, spec.offset_mm)
    }

    /// What the axes are commanded.
    pub(super) fn commanded(&self) -> Commanded<'_> {
        Commanded { schedule: &self.schedule, program: self.program.as_ref() }
    }
}

/// An operation before anything is known of its poses.
pub(super) struct LaidOperation<'a> {
    pub(super) spec: Operation,
    pub(super) short_of_depth_mm: f64,
    /// One that generates the same gear, of which the rest is taken over.
    pub(super) same: Option<&'a PreparedOperation>,
    pub(super) linkage: ShapingLinkage,
    pub(super) schedule: StrokeSchedule,
    pub(super) program: Option<AxisProgram>,
    pub(super) actual: ActualStrokes,
}

impl LaidOperation<'_> {
    pub(super) fn commanded(&self) -> Commanded<'_> {
        Commanded { schedule: &self.schedule, program: self.program.as_ref() }
    }
}

/// How much further from the pitch curve the cutter's centre lies for the profile shifts of gear and cutter and the
/// allowance of the gear's tooth thickness, mm.
///
/// A cutter whose teeth are 2 x0 m tan(alpha) thicker thins the gear's by as much at any depth, and a shop sets it to
/// the depth that makes the teeth of the drawing: new or reground, it cuts one gear. So teeth are made thicker by
/// s = 2 (x + x0) m tan(alpha) + A than at the distance at which the pitch curves touch; of a round gear
/// 2 x m tan(alpha) + A are left of it on the reference circle, exactly ([`RoundMesh`]).
/// Road not taken: s / (2 tan(alpha)), the law of a rack, which makes teeth of module 3 with x = 0.5 on 24 teeth some
/// 0.08 mm too thick, and takes 0.54 mm for 0.5 from a ring. On other gears the
/// displacement is that of the round gear with as many teeth, and the thickness varies with the curvature by that
/// order.
pub(super) fn thickness_offset_mm(gear: &Gear, pitches: u32, tool: &CutterSpec) -> Result<f64, Refusal> {
    let alpha = gear.pressure_angle_rad;
    let thicker_mm = gear.extra_thickness_mm() + 2.0 * tool.profile_shift_coefficient * gear.module_mm * alpha.tan();
    if thicker_mm == 0.0 {
        return Ok(0.0);
    }
    let mesh = RoundMesh::new(gear.kind, gear.module_mm, alpha, [pitches, tool.teeth]);
    let Some(working_rad) = mesh.thicker_rad(alpha, thicker_mm) else {
        let [shift, allowance] = ["gear.profile_shift_coefficient", "gear.tooth_thickness_allowance_mm"];
        let (key, all) = match (tool.profile_shift_coefficient == 0.0, gear.tooth_thickness_allowance_mm == 0.0) {
            (false, _) => (PROFILE_SHIFT, format!("{shift}, {PROFILE_SHIFT} and {allowance}")),
            (true, true) => (shift, format!("{shift} and {allowance}")),
            (true, false) => (allowance, format!("{shift} and {allowance}")),
        };
        return Err(Refusal::new(
            key,
            format!("no depth of the cutter changes the tooth thickness by {thicker_mm:.3} mm"),
            format!("take less than {:.3} mm, by {all} together", mesh.room_mm(alpha)),
        ));
    };
    Ok(mesh.offset_mm(working_rad))
}

/// Refuses a ring that the cutter cuts through.
pub(super) fn rim_holds(
    rim_mm: f64,
    blank: &Blank,
    cutter: &ShaperCutter,
    operations: &[PreparedOperation],
) -> Result<(), Refusal> {
    let GearKind::Internal = blank.kind() else { return Ok(()) };
    let samples = blank.curve().samples_per_turn();
    let reach = |operation: &PreparedOperation| {
        let centers =
            (0..samples).map(|i| operation.linkage.pose(sample_angle_rad(i, samples), operation.spec.offset_mm));
        centers.map(|pose| pose.center_mm.length() + cutter.tip_radius_mm).fold(0.0, f64::max)
    };
    let reach_mm = operations.iter().map(reach).fold(0.0, f64::max);
    let missing_mm = reach_mm - blank.back.radius_mm;
    if missing_mm < 0.0 {
        return Ok(());
    }
    Err(Refusal::new(
        "gear.rim_mm",
        format!(
            "the rim of {rim_mm} mm is thinner than the teeth are deep: the cutter reaches {reach_mm:.3} mm from the \
            gear axis, the ring {:.3} mm",
            blank.back.radius_mm
        ),
        format!("make it thicker than {:.3} mm; 5 modules are usual", rim_mm + missing_mm),
    ))
}

/// The program that an operation is cut with. Other strokes than the scene's are judged, as long as there are not many
/// times as many: a wrong unit of F or S would otherwise ask for millions.
pub(super) fn read_program(path: &Path, spec: &Operation, schedule: &StrokeSchedule) -> Result<AxisProgram> {
    let program = gcode::read::file(path)?;
    let most = MOST_TIMES_THE_STROKES * schedule.count();
    if program.count() > most {
        return Err(Refusal::new(
            &format!("operation.{}.program", spec.name),
            format!(
                "{} makes {} strokes, the operation {}: more than {MOST_TIMES_THE_STROKES} times as many",
                path.display(),
                program.count(),
                schedule.count()
            ),
            "look at S and F of the program, and at strokes_per_revolution, revolutions and infeed of the scene",
        )
        .into());
    }
    Ok(program)
}
