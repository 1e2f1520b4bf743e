//! A shaping scene made ready to cut: pitch curve, cutter, blank, linkages, strokes; and the dexel fields of every
//! flank and root.
//!
//! In: the checked scene. Out: [`ShapingJob`], from which fields and plans are made one flank at a time, so that memory
//! does not grow with the number of teeth; of every tooth only the target is kept. The last operation is the finishing
//! one: its continuous envelope is the target.

mod operation;

pub use operation::PreparedOperation;

use crate::drawn_tooth::envelope::DrawnSpaces;
use crate::machine_errors::Deflection;
use crate::material::EdgeForce;
use crate::measure::round_gear::is_round;
use crate::process::shaping::ShaperCutter;
use crate::process::shaping::helix::Helix;
use crate::process::shaping::linkage::{ShapingLinkage, StrokeSchedule, dynamics};
use crate::process::shaping::motion::actual::{ActualStrokes, Commanded, scattered};
use crate::process::shaping::motion::returns::RetractionPlan;
use crate::process::shaping::motion::returns::facts::ReturnFacts;
use crate::process::shaping::motion::returns::motion::RamTimes;
use crate::process::shaping::motion::returns::survey::Survey;
use crate::process::shaping::motion::vibration::Vibration;
use crate::process::shaping::scene::model::{CutterSpec, GcodeDialect, Machine, Shaping};
use crate::process::shaping::swing::swing_rad;
use crate::process::shaping::target::TargetFlank;
use crate::process::shaping::target::fillet::Fillet;
use crate::process::shaping::target::generation::Generation;
use crate::process::shaping::target::tooth_target::ToothTarget;
use crate::scene::Scene;
use crate::scene::model::Gear;
use crate::scene::tool_wear::WearSpec;
use crate::steps::planar::{PlanarGear, PlanarOperation, ProfilePoint};
use gearcut_core::dexel::Field;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::frame::Rigid2;
use gearcut_core::gear::PitchCurve;
use gearcut_core::gear::blank::Blank;
use gearcut_core::passes::StrokeSet;
use gearcut_core::passes::planar::strokes::StrokeLaw;
use gearcut_core::terms::Side;
use glam::DVec2;
use operation::{LaidOperation, read_program, rim_holds, thickness_offset_mm};
use std::f64::consts::PI;
use std::ops::RangeInclusive;
use std::sync::{Arc, OnceLock};

/// Everything known before the first dexel is cut.
///
/// Made from a scene it stands on a rigid machine. On one that yields, strokes are displaced by what they cut:
/// [`crate::process::shaping::cut::chips::as_cut`] makes that gear.
#[derive(Debug, Clone)]
pub struct ShapingJob {
    /// The scene.
    pub scene: Scene,
    /// The machine.
    pub machine: Machine,
    /// Force coefficients of the work's material.
    pub material: EdgeForce,
    /// Distance of the rays on which chips are followed, mm.
    pub chip_spacing_mm: f64,
    /// Form of the axis programs.
    pub gcode: GcodeDialect,
    /// How the cutter wears, where the scene says.
    pub wear: Option<WearSpec>,
    /// The cutter as the scene describes it.
    pub cutter_spec: CutterSpec,
    /// Its transverse section as a spur gear: the scene's own gear where that is one.
    pub transverse: Gear,
    /// What the guide does along the face; none for spur gears.
    pub helix: Option<Helix>,
    /// The pitch curve.
    pub curve: Arc<PitchCurve>,
    /// The cutter.
    pub cutter: ShaperCutter,
    /// The stock.
    pub blank: Blank,
    /// Operations in order; the last one finishes.
    pub operations: Vec<PreparedOperation>,
    /// Turn of the finished gear as a whole, rad, that the zero of the work spindle makes up for.
    pub turn_rad: f64,
    /// Target of every tooth.
    targets: Vec<ToothTarget>,
}

impl ShapingJob {
    /// Makes a scene ready.
    ///
    /// # Errors
    /// Geometry that cannot be cut: see the parts.
    pub fn new(scene: Scene) -> Result<Self> {
        Self::laid_out(scene, None, true)?.with_own_targets()
    }

    /// Makes another scene ready. Targets of teeth take most of that time, and no error moves them: where both scenes
    /// generate the same gear they are taken over, and so is all else that follows from what is the same in both: the
    /// cutter, linkages, envelopes and the room of return strokes.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub fn sharing_targets(&self, scene: Scene) -> Result<Self> {
        let job = Self::laid_out(scene, Some(self), true)?;
        if self.generates(&job) { Ok(Self { targets: self.targets.clone(), ..job }) } else { job.with_own_targets() }
    }

    fn with_own_targets(self) -> Result<Self> {
        let targets = ToothTarget::of_all(self.target_generation(), &self.blank, self.scene.gear.teeth)?;
        Ok(Self { targets, ..self })
    }

    /// The machine and what its strokes command, without a pose or a tooth: enough for the axes.
    ///
    /// # Errors
    /// As for [`Self::new`], targets apart.
    pub(super) fn of_axes(scene: Scene) -> Result<Self> {
        Self::laid_out(scene, None, false)
    }

    /// The machine and its strokes, and no tooth. What is the same in the scene of a job `like` this one is taken over.
    fn laid_out(scene: Scene, like: Option<&Self>, has_poses: bool) -> Result<Self> {
        let Some(shaping) = Shaping::of(&scene) else {
            let way_out = "write [tool.shaper_cutter] for shaping";
            return Err(Refusal::new("tool", "this tool does not shape gears", way_out).into());
        };
        let machine = shaping.machine.clone();
        let (material, chip_spacing_mm) = (shaping.material, shaping.chip_spacing_mm);
        let gcode = shaping.gcode;
        let transverse = scene.gear.transverse();
        let gear = &transverse;
        let like = like.filter(|of| of.scene.gear == scene.gear);
        let curve = match like {
            Some(of) => of.curve.clone(),
            None => Arc::new(PitchCurve::new(&gear.pitch_curve, gear.module_mm, gear.teeth)?),
        };
        let transverse_tool = shaping.tool.transverse(scene.gear.helix_angle_rad);
        let cutter = match like.filter(|of| of.cutter_spec == shaping.tool) {
            Some(of) => of.cutter.clone(),
            None => ShaperCutter::new(&transverse_tool, gear)?,
        };
        let mut alike = like.filter(|of| of.cutter.generates_as(&cutter));
        let helix = Helix::of(&scene.gear, &machine, &curve, &cutter)?;
        scene.gear.check_bore(&curve)?;
        let blank = gear.blank(curve.clone())?;
        // Flanks refer to the cutter for as long as they are kept.
        let shared_cutter = Arc::new(cutter.clone());
        let passes: f64 = shaping.operations.len() as f64;
        let mut operations: Vec<PreparedOperation> = Vec::new();
        let (mut laid, mut start_s) = (Vec::new(), 0.0);
        let allowance_mm = thickness_offset_mm(gear, curve.pitches(), &transverse_tool)?;
        for spec in &shaping.operations {
            let (mut spec, short_of_depth_mm) = (spec.clone(), spec.offset_mm);
            spec.offset_mm += allowance_mm;
            // Return strokes meet what is left by the operations before: they are alike as well.
            alike = alike.filter(|of| of.operations.get(laid.len()).is_some_and(|of| of.generates_as(&spec)));
            let same = alike.map(|of| &of.operations[laid.len()]);
            let linkage = match same {
                Some(of) => of.linkage.clone(),
                None => {
                    ShapingLinkage::new(gear.kind, spec.linkage, curve.clone(), cutter.pitch_radius_mm, spec.offset_mm)?
                }
            };
            if spec.window_rad.is_none() {
                spec.window_rad = swing_rad(&blank, &cutter, &linkage, spec.offset_mm)?;
            }
            let schedule = StrokeSchedule::new(&spec, &linkage, &machine)?;
            let program = spec.program.as_deref().map(|path| read_program(path, &spec, &schedule)).transpose()?;
            // Times, drifts and lags are those of the program that is cut.
            let schedule = match &program {
                Some(program) if program.is_at_another_speed(machine.double_strokes_per_minute) => {
                    schedule.at_speed(program.double_strokes_per_minute)
                }
                _ => schedule,
            };
            let commanded = Commanded { schedule: &schedule, program: program.as_ref() };
            let count = commanded.count();
            let ids = count as f64 * f64::from(cutter.teeth) * passes;
            if ids >= f64::from(u32::MAX) {
                return Err(Refusal::new(
                    "operation.strokes_per_revolution",
                    format!("{count} strokes with {} cutter teeth are more passes than can be numbered", cutter.teeth),
                    "use fewer strokes or revolutions",
                )
                .into());
            }
            let errors = scattered(&machine.errors, spec.stock_scatter, &schedule);
            let guide_turn = helix.as_ref().map(|of| of.cutter_rad_per_mm);
            let actual = ActualStrokes::new(&errors, commanded, start_s, 0.5 * gear.face_width_mm, guide_turn);
            start_s += schedule.time_s(count as f64);
            laid.push(LaidOperation { spec, short_of_depth_mm, same, linkage, schedule, program, actual });
        }
        let finishing = laid.last().filter(|_| is_round(&curve));
        let turn_rad = finishing.map_or(0.0, |of| of.actual.turn_rad(of.commanded()));
        let mut first_pass = 0;
        for mut of in laid {
            of.actual.make_up_for(turn_rad);
            let commanded = of.commanded();
            let LaidOperation { spec, same, schedule, actual, .. } = &of;
            let count = commanded.count();
            let crank = machine.crank(gear.face_width_mm);
            let law = if spec.feed_during_stroke {
                crank
            } else if actual.differs_along_tooth() {
                StrokeLaw::Guided { half_face_mm: 0.5 * gear.face_width_mm }
            } else {
                StrokeLaw::Frozen
            };
            let posed = if has_poses { count } else { 0 };
            let strokes = StrokeSet::along_guide(first_pass, &cutter, law, posed, |lambda, z_mm| {
                let at_rest = if law.rests() { crank.stroke_share(crank.tau(z_mm)) } else { 0.0 };
                actual.placed(schedule, lambda, &actual.pose(commanded, lambda, at_rest), z_mm)
            });
            first_pass = strokes.end_pass();
            let (generation, envelope, survey) = match same {
                Some(of) => (of.generation.clone(), of.envelope.clone(), of.survey.clone()),
                None => {
                    let (linkage, cutter) = (of.linkage.clone(), shared_cutter.clone());
                    let drawn = cutter.drawn().map(|_| Arc::new(DrawnSpaces::new(blank.clone())));
                    let generation = Arc::new(Generation { linkage, cutter, offset_mm: spec.offset_mm, drawn });
                    let before = operations.iter().map(|before| &before.generation);
                    let generations = before.chain([&generation]).cloned().collect();
                    let survey = Survey::new(generations, blank.clone(), curve.pitches(), gear.module_mm);
                    let envelope = (0..2 * gear.teeth).map(|_| OnceLock::new()).collect();
                    (generation, envelope, Arc::new(survey))
                }
            };
            let retraction = RetractionPlan::new(&machine, schedule, &survey)?;
            let returns = OnceLock::new();
            let LaidOperation { spec, short_of_depth_mm, linkage, schedule, program, actual, .. } = of;
            operations.push(PreparedOperation {
                spec,
                short_of_depth_mm,
                linkage,
                generation,
                envelope,
                schedule,
                program,
                actual,
                strokes,
                deflections: Vec::new(),
                vibration: None,
                survey,
                retraction,
                returns,
            });
        }
        rim_holds(gear.rim_mm, &blank, &cutter, &operations)?;
        Ok(Self {
            machine,
            material,
            chip_spacing_mm,
            wear: shaping.wear,
            gcode,
            cutter_spec: shaping.tool.clone(),
            curve,
            cutter,
            blank,
            operations,
            turn_rad,
            targets: Vec::new(),
            helix,
            transverse,
            scene,
        })
    }

    /// Whether the target is that of another job, too: gear, finishing operation and cutter have the same numbers in
    /// all that a [`Generation`] and a blank are made of.
    fn generates(&self, other: &Self) -> bool {
        self.scene.gear == other.scene.gear
            && self.finishing().generates_as(&other.finishing().spec)
            && self.cutter.generates_as(&other.cutter)
    }

    /// The same gear with its strokes displaced, operation by operation and stroke by stroke; return strokes, which
    /// cut nothing, stay where they are.
    #[must_use]
    pub fn deflected(&self, deflections: Vec<Vec<Deflection>>) -> Self {
        let mut job = self.clone();
        let work_axis_mm = -job.eccentricity_mm();
        for (operation, deflections) in job.operations.iter_mut().zip(deflections) {
            let displaced = |stroke: usize, pose: &Rigid2| deflections[stroke].displaced(pose, work_axis_mm);
            operation.strokes = operation.strokes.displaced(displaced);
            operation.deflections = deflections;
        }
        job
    }

    /// The same gear with a cutter that vibrates, operation by operation.
    #[must_use]
    pub fn vibrating(mut self, found: Vec<Vibration>) -> Self {
        for (operation, vibration) in self.operations.iter_mut().zip(found) {
            operation.vibration = Some(Arc::new(vibration));
        }
        self
    }

    /// Whether the cutter vibrates: rows along the tooth are then cut differently.
    pub fn vibrates(&self) -> bool {
        self.operations.iter().any(|operation| operation.vibration.is_some())
    }

    /// The same gear as the section at a height is cut, all along the tooth.
    #[must_use]
    pub fn of_section(&self, z_mm: f64) -> Self {
        let mut job = self.clone();
        for (section, operation) in job.operations.iter_mut().zip(&self.operations) {
            section.strokes = self.strokes_in_section(operation, z_mm);
            section.vibration = None;
        }
        job
    }

    /// Strokes of an operation in one section: the cutter as it stands when the ram passes it.
    pub fn strokes_in_section(&self, operation: &PreparedOperation, z_mm: f64) -> StrokeSet {
        let set = &operation.strokes;
        StrokeSet::new(set.first_pass, &self.cutter, StrokeLaw::Frozen, set.count(), |stroke| {
            self.pose_in_section(operation, stroke as usize, z_mm)
        })
    }

    /// Whether the strokes stand where they cut: a machine that yields displaces them.
    pub fn is_as_cut(&self) -> bool {
        self.machine.compliance.is_none() || self.operations.iter().any(|operation| !operation.deflections.is_empty())
    }

    /// Where the gear axis sits off the work spindle in the middle of the face, mm.
    pub(crate) fn eccentricity_mm(&self) -> DVec2 {
        self.machine.errors.mounting.axis_mm(0.0)
    }

    /// The finishing operation.
    pub fn finishing(&self) -> &PreparedOperation {
        self.operations.last().expect("a checked scene has at least one operation")
    }

    /// Flank of a tooth (1 to z) in the envelope of one operation; `None` where nothing is generated.
    pub fn envelope_flank(&self, operation: usize, tooth: u32, side: Side) -> Option<&TargetFlank> {
        let PreparedOperation { generation, envelope, .. } = &self.operations[operation];
        let index = 2 * (tooth as usize - 1) + usize::from(side == Side::Right);
        envelope[index].get_or_init(|| TargetFlank::new(generation, &self.blank, tooth, side).ok()).as_ref()
    }

    /// Continuous generation by the finishing operation: the target.
    pub fn target_generation(&self) -> &Arc<Generation> {
        &self.finishing().generation
    }

    /// What is known of the return strokes of an operation before cutting; none where the cutter is not drawn back.
    ///
    /// # Errors
    /// A back-off so large that the retraction leads to no pose.
    pub fn return_facts(&self, operation: usize) -> Result<Option<&ReturnFacts>, Refusal> {
        if self.machine.back_off_mm <= 0.0 {
            return Ok(None);
        }
        let PreparedOperation { survey, schedule, retraction, returns, .. } = &self.operations[operation];
        let limits = dynamics::limits(&self.machine.limits);
        let facts = returns.get_or_init(|| ReturnFacts::new(survey, retraction, schedule, &self.ram_times(), &limits));
        facts.as_ref().map(Some).map_err(Clone::clone)
    }

    /// When the ram passes the ends of the face.
    pub fn ram_times(&self) -> RamTimes {
        RamTimes::new(self.scene.gear.face_width_mm, self.machine.approach_mm, self.machine.overrun_mm)
    }

    /// Largest speed of the ram on its crank in an operation, mm/s.
    pub fn ram_speed_mm_per_s(&self, operation: usize) -> f64 {
        let stroke_mm = self.machine.approach_mm + self.scene.gear.face_width_mm + self.machine.overrun_mm;
        PI * stroke_mm * self.operations[operation].schedule.double_strokes_per_minute() / 60.0
    }

    /// Tooth spaces, each after the tooth of its number; before tooth 1 of a sector there is one more.
    pub fn spaces(&self) -> RangeInclusive<u32> {
        u32::from(self.blank.dwell().is_none())..=self.scene.gear.teeth
    }

    /// Target of a tooth (1 to z).
    pub fn target(&self, tooth: u32) -> &ToothTarget {
        &self.targets[tooth as usize - 1]
    }

    /// Target flank of a tooth (1 to z).
    pub fn target_flank(&self, tooth: u32, side: Side) -> &TargetFlank {
        self.target(tooth).flank(side)
    }

    /// Scene, blank, cutter and strokes, as planar steps need them.
    pub fn planar(&self) -> PlanarGear<'_> {
        let operations = self.operations.iter();
        PlanarGear {
            scene: &self.scene,
            blank: &self.blank,
            tool: &self.cutter,
            operations: operations.map(|o| PlanarOperation { name: &o.spec.name, strokes: &o.strokes }).collect(),
        }
    }

    /// Dexel field on a target flank with the scene's spacing.
    pub fn flank_field(&self, flank: &TargetFlank) -> Field {
        let planar = self.planar();
        let rows_z_mm = planar.rows_z_mm(self.scene.fields.lead_spacing_mm);
        self.field_over(flank, planar.arcs_mm(flank.length_mm()), rows_z_mm)
    }

    /// Dexel field on a part of a target flank: places along the profile (arcs from the form point) and along the
    /// tooth, mm.
    pub fn field_over(&self, flank: &TargetFlank, arcs_mm: impl Iterator<Item = f64>, rows_z_mm: Vec<f64>) -> Field {
        let point = |arc_mm: f64| {
            // Rounding must not carry the last column beyond the tip.
            let arc_mm = arc_mm.min(flank.length_mm());
            let contact = flank.at_arc(arc_mm);
            ProfilePoint { arc_mm, point_mm: contact.point_mm, normal: contact.normal, phi_rad: contact.phi_rad }
        };
        self.planar().flank_field(arcs_mm.map(point), rows_z_mm)
    }

    /// Target root of the space after tooth `space`, as points about `spacing_mm` apart: from its left flank to its
    /// right one. Under a flank that is undercut it begins where both cross. Behind the last tooth of a sector these
    /// are the half of its last space and that of its first one, with the dwell between them.
    pub fn target_root(&self, space: u32, spacing_mm: f64) -> Vec<ProfilePoint> {
        let mut points: Vec<ProfilePoint> = Vec::new();
        for (fillet, ends) in self.target_fillets(space) {
            let own = fillet.points(ends, spacing_mm);
            let before_mm = points.last().zip(own.first());
            let before_mm = before_mm.map_or(0.0, |(last, next)| last.arc_mm + last.point_mm.distance(next.point_mm));
            points.extend(own.into_iter().map(|point| ProfilePoint { arc_mm: before_mm + point.arc_mm, ..point }));
        }
        points
    }

    /// Cutter of a stroke in a section: as it stands when the ram passes it, turned by the guide.
    pub fn pose_in_section(&self, operation: &PreparedOperation, stroke: usize, z_mm: f64) -> Rigid2 {
        let set = &operation.strokes;
        let pose = set.pose_at(stroke, set.law.tau(z_mm));
        let vibrating = operation.vibration.as_ref();
        let pose = vibrating.map_or(pose, |of| of.at(stroke, z_mm).displaced(&pose, -self.eccentricity_mm()));
        self.helix.as_ref().map_or(pose, |helix| helix.guided(&pose, z_mm))
    }

    /// Fillets behind a tooth with the places on them between which they are the target: one, from the tooth's left
    /// flank to the next one's right flank, or both halves behind the last tooth of a sector.
    pub fn target_fillets(&self, space: u32) -> Vec<(Fillet<'_>, [f64; 2])> {
        let teeth = self.scene.gear.teeth;
        let before = if space == 0 { teeth } else { space };
        let of = |space: i64| Fillet::new(self.target_generation(), space as f64);
        let [left, right] = [(before, Side::Left), (space % teeth + 1, Side::Right)]
            .map(|(tooth, side)| self.target_flank(tooth, side).undercut.map(|undercut| undercut.fillet_at));
        let left = left.unwrap_or(0.0);
        if self.blank.dwell().is_none() || before < teeth {
            let fillet = of(i64::from(space));
            let right = right.unwrap_or(fillet.end());
            return vec![(fillet, [left, right])];
        }
        let (last, first) = (of(i64::from(teeth)), of(0));
        let (to, from, right) = (last.middle(), first.middle(), right.unwrap_or(first.end()));
        vec![(last, [left, to]), (first, [from, right])]
    }

    /// The dwell behind a tooth, with normals out of the stock: of the last tooth of a sector, else nothing.
    pub fn dwell_mm(&self, tooth: u32, spacing_mm: f64) -> Vec<[DVec2; 2]> {
        let ends = |fillets: &[(Fillet<'_>, [f64; 2])]| {
            let [(last, [_, to]), (first, [from, _])] = fillets else { return None };
            Some([last.at(*to)?.1, first.at(*from)?.1])
        };
        match (self.blank.dwell(), ends(&self.target_fillets(tooth))) {
            (Some(dwell), Some(ends_mm)) => dwell.path_mm(ends_mm, spacing_mm),
            _ => Vec::new(),
        }
    }

    /// Dexel field on the root of a space (space j lies after tooth j).
    pub fn root_field(&self, space: u32) -> Field {
        let planar = self.planar();
        planar.root_field(&self.target_root(space, planar.root_spacing_mm()))
    }
}
