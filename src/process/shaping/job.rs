//! A shaping scene made ready to cut: pitch curve, cutter, blank, linkages, strokes; and the dexel fields of every
//! flank and root.
//!
//! In: the checked scene. Out: [`Job`], from which fields and plans are made one flank at a time, so that memory does
//! not grow with the number of teeth. The last operation is the finishing one: its continuous envelope is the target.

use crate::cut::{Backend, CutStats};
use crate::dexel::{Column, Field, Layer};
use crate::error::{Error, Refusal, Result};
use crate::frame::Rigid2;
use crate::gear::PitchCurve;
use crate::gear::blank::Blank;
use crate::job::{RAY_DEPTH_MODULES, RAY_HEIGHT_MODULES, ROOT_SPACING_MM, leads_mm};
use crate::material::EdgeForce;
use crate::math::roots::try_halve;
use crate::passes::planar::strokes::StrokeLaw;
use crate::passes::{CutPlan, StrokeSet};
use crate::process::shaping::ShaperCutter;
use crate::process::shaping::gcode;
use crate::process::shaping::gcode::AxisProgram;
use crate::process::shaping::generation::Generation;
use crate::process::shaping::linkage::{CutterPose, ShapingLinkage, StrokeSchedule};
use crate::process::shaping::scene::model::{self, Machine, Measure, Operation, Shaping};
use crate::process::shaping::target::{TargetFlank, target_root};
use crate::scene::Scene;
use crate::terms::Side;
use crate::tool::CuttingTool;
use glam::DVec2;
use std::path::Path;
use std::sync::Arc;

/// Rays of a fillet stay within this share of its radius: further out they would cross each other.
const FILLET_SHARE: f64 = 0.8;

/// One operation with its strokes.
#[derive(Debug)]
pub struct PreparedOperation {
    /// What the scene says.
    pub spec: Operation,
    /// The linkage.
    pub linkage: ShapingLinkage,
    /// Axis positions at every stroke.
    pub schedule: StrokeSchedule,
    /// Axis program that is cut instead of the schedule, if the scene names one.
    pub program: Option<AxisProgram>,
    /// Poses for the dexels.
    pub strokes: StrokeSet,
}

impl PreparedOperation {
    /// Cutter in the gear frame at a stroke coordinate, as it is cut.
    pub fn pose(&self, stroke: f64) -> CutterPose {
        pose(self.program.as_ref(), &self.schedule, stroke)
    }
}

fn pose(program: Option<&AxisProgram>, schedule: &StrokeSchedule, stroke: f64) -> CutterPose {
    program.map_or_else(|| schedule.state(stroke).pose, |program| program.at(stroke).pose())
}

/// Everything known before the first dexel is cut.
#[derive(Debug)]
pub struct Job {
    /// The scene.
    pub scene: Scene,
    /// The machine.
    pub machine: Machine,
    /// Force coefficients of the work's material.
    pub material: EdgeForce,
    /// Distance of the rays on which chips are followed, mm.
    pub chip_spacing_mm: f64,
    /// Where profiles are evaluated.
    pub measure: Measure,
    /// The cutter as the scene describes it.
    pub cutter_spec: model::ShaperCutter,
    /// The pitch curve.
    pub curve: Arc<PitchCurve>,
    /// The cutter.
    pub cutter: ShaperCutter,
    /// The stock.
    pub blank: Blank,
    /// Operations in order; the last one finishes.
    pub operations: Vec<PreparedOperation>,
    /// Height of each tooth's tip over the pitch curve where it is pointed below the blank's outline.
    pointed_mm: Vec<Option<f64>>,
}

/// One flank after all operations.
#[derive(Debug)]
pub struct CutFlank {
    /// Rays.
    pub field: Field,
    /// What each operation left, in order.
    pub layers: Vec<Layer>,
    /// What the backend met.
    pub stats: CutStats,
}

impl Job {
    /// Makes a scene ready.
    ///
    /// # Errors
    /// Geometry that cannot be cut: see the parts.
    pub fn new(scene: Scene) -> Result<Self> {
        let gear = &scene.gear;
        let Some(shaping) = Shaping::of(&scene) else {
            let way_out = "write [tool.shaper_cutter] for shaping";
            return Err(Refusal::new("tool", "this tool does not shape gears", way_out).into());
        };
        let machine = shaping.machine.clone();
        let (material, chip_spacing_mm, measure) = (shaping.material, shaping.chip_spacing_mm, shaping.measure);
        if gear.helix_angle_rad != 0.0 {
            return Err(Refusal::new(
                "gear.helix_angle_deg",
                "shaping cuts spur gears: a helical gear needs a helical guide on the ram, which is not modelled yet",
                "set helix_angle_deg = 0, or hob the gear with [tool.hob]",
            )
            .into());
        }
        let curve = Arc::new(PitchCurve::new(&gear.pitch_curve, gear.module_mm, gear.teeth)?);
        let cutter = ShaperCutter::new(&shaping.tool, gear)?;
        let blank = Blank::new(curve.clone(), gear.addendum_coefficient * gear.module_mm)?;
        let passes: f64 = shaping.operations.len() as f64;
        let mut operations = Vec::new();
        let mut first_pass = 0;
        // A cutter pulled back by d leaves teeth 2 d tan(alpha) thicker on the pitch curve.
        let allowance_mm = gear.tooth_thickness_allowance_mm / (2.0 * gear.pressure_angle_rad.tan());
        for spec in &shaping.operations {
            let mut spec = spec.clone();
            spec.offset_mm += allowance_mm;
            let linkage = ShapingLinkage::new(spec.linkage, curve.clone(), cutter.pitch_radius_mm, spec.offset_mm)?;
            let schedule = StrokeSchedule::new(&spec, &linkage, &machine)?;
            let count = schedule.count();
            let ids = count as f64 * f64::from(cutter.teeth) * passes;
            if ids >= f64::from(u32::MAX) {
                return Err(Refusal::new(
                    "operation.strokes_per_revolution",
                    format!("{count} strokes with {} cutter teeth are more passes than can be numbered", cutter.teeth),
                    "use fewer strokes or revolutions",
                )
                .into());
            }
            let law = if spec.feed_during_stroke {
                StrokeLaw::crank(gear.face_width_mm, machine.approach_mm, machine.overrun_mm)
            } else {
                StrokeLaw::Frozen
            };
            let eccentricity = eccentricity_mm(&machine);
            let program = spec.program.as_deref().map(|path| read_program(path, &spec, &schedule)).transpose()?;
            let strokes = StrokeSet::new(first_pass, &cutter, law, count, |lambda| {
                let pose = pose(program.as_ref(), &schedule, lambda);
                Rigid2::new(pose.angle_rad, pose.center_mm - eccentricity)
            });
            first_pass = strokes.end_pass();
            operations.push(PreparedOperation { spec, linkage, schedule, program, strokes });
        }
        let mut job = Self {
            machine,
            material,
            chip_spacing_mm,
            measure,
            cutter_spec: shaping.tool.clone(),
            curve,
            cutter,
            blank,
            operations,
            pointed_mm: vec![None; gear.teeth as usize],
            scene,
        };
        let pointed = (1..=job.scene.gear.teeth).map(|tooth| job.pointed_height(tooth)).collect::<Result<_>>()?;
        job.pointed_mm = pointed;
        Ok(job)
    }

    /// Where the gear axis sits off the work spindle, in the gear frame, mm.
    pub(crate) fn eccentricity_mm(&self) -> DVec2 {
        eccentricity_mm(&self.machine)
    }

    /// The finishing operation.
    pub fn finishing(&self) -> &PreparedOperation {
        self.operations.last().expect("a checked scene has at least one operation")
    }

    /// Continuous generation by one operation.
    pub fn generation(&self, operation: usize) -> Generation<'_> {
        let PreparedOperation { spec, linkage, .. } = &self.operations[operation];
        Generation { linkage, cutter: &self.cutter, offset_mm: spec.offset_mm }
    }

    /// Continuous generation by the finishing operation: the target.
    pub fn target_generation(&self) -> Generation<'_> {
        self.generation(self.operations.len() - 1)
    }

    /// Target flank of a tooth (1 to z).
    ///
    /// # Errors
    /// The cutter generates no flank there.
    pub fn target_flank<'a>(
        &self,
        generation: &'a Generation<'a>,
        tooth: u32,
        side: Side,
    ) -> Result<TargetFlank<'a>, Refusal> {
        TargetFlank::new(generation, &self.blank, tooth, side, self.pointed_mm[tooth as usize - 1])
    }

    /// Tip land of a tooth: from the left flank's tip to the right one's along the outline's direction, mm; negative if
    /// the flanks have crossed.
    pub fn tip_land_mm(&self, left: &TargetFlank, right: &TargetFlank) -> f64 {
        let (l, r) = (left.at_arc(left.length_mm()), right.at_arc(right.length_mm()));
        let tangent = self
            .curve
            .frame(self.blank.height(0.5 * (l.point_mm + r.point_mm), 0.5 * (l.phi_rad + r.phi_rad)).1)
            .tangent;
        (l.point_mm - r.point_mm).dot(tangent)
    }

    /// Height at which a tooth is pointed, if that is below the blank's outline.
    fn pointed_height(&self, tooth: u32) -> Result<Option<f64>> {
        let generation = self.target_generation();
        let land = |height_mm: Option<f64>| -> Result<f64, Refusal> {
            let flank = |side| TargetFlank::new(&generation, &self.blank, tooth, side, height_mm);
            Ok(self.tip_land_mm(&flank(Side::Left)?, &flank(Side::Right)?))
        };
        if land(None)? > 0.0 {
            return Ok(None);
        }
        let [low, _] = try_halve(|height_mm| Ok(land(Some(height_mm))? > 1e-3), 0.0, self.blank.addendum_mm, 40)
            .map_err(|refusal: Refusal| refusal)?;
        if low == 0.0 {
            return Err(Refusal::new(
                "gear.tooth_thickness_allowance_mm",
                format!("tooth {tooth} is pointed below the pitch curve"),
                "use a larger module, a cutter with less profile shift, or a smaller thickness allowance",
            )
            .into());
        }
        Ok(Some(low))
    }

    /// Dexel field on a target flank with the scene's spacing.
    pub fn flank_field(&self, flank: &TargetFlank) -> Field {
        let fields = self.scene.fields;
        let count = (flank.length_mm() / fields.profile_spacing_mm).floor() as usize + 1;
        let arcs_mm = (0..count).map(|i| i as f64 * fields.profile_spacing_mm);
        self.field_over(flank, arcs_mm, self.leads_mm(fields.lead_spacing_mm))
    }

    /// Dexel field on a part of a target flank: places along the profile (arcs from the form point) and along the
    /// tooth, mm.
    pub fn field_over(&self, flank: &TargetFlank, arcs_mm: impl Iterator<Item = f64>, leads_mm: Vec<f64>) -> Field {
        let module_mm = self.scene.gear.module_mm;
        let mut exit_mm = 0.0;
        let columns = arcs_mm
            .map(|arc_mm| {
                // Rounding must not carry the last column beyond the tip.
                let arc_mm = arc_mm.min(flank.length_mm());
                let contact = flank.at_arc(arc_mm);
                let limit_mm = RAY_HEIGHT_MODULES * module_mm;
                exit_mm = self.blank.exit_mm(contact.point_mm, contact.normal, contact.phi_rad, exit_mm, limit_mm);
                Column {
                    arc_mm,
                    origin_mm: contact.point_mm,
                    normal: contact.normal,
                    low_mm: -RAY_DEPTH_MODULES * module_mm,
                    blank_mm: exit_mm,
                }
            })
            .collect();
        Field { columns, leads_mm }
    }

    /// Dexel field on the root of a space (space j lies after tooth j).
    pub fn root_field(&self, space: u32) -> Field {
        let generation = self.target_generation();
        let fields = self.scene.fields;
        let module_mm = self.scene.gear.module_mm;
        let spacing_mm = fields.profile_spacing_mm.max(ROOT_SPACING_MM[0]);
        let points = target_root(&generation, i64::from(space), spacing_mm);
        let columns = points
            .iter()
            .enumerate()
            .map(|(i, point)| {
                let (a, b) = (points[i.saturating_sub(1)], points[(i + 1).min(points.len() - 1)]);
                // Where normals converge (the fillet), rays end before they meet.
                let closing = -(b.normal - a.normal).dot((b.point_mm - a.point_mm).normalize_or_zero());
                let radius_mm = if closing > 0.0 { (b.arc_mm - a.arc_mm) / closing } else { f64::INFINITY };
                let limit_mm = (RAY_HEIGHT_MODULES * module_mm).min(FILLET_SHARE * radius_mm);
                let blank_mm = self.blank.exit_mm(point.point_mm, point.normal, point.phi_rad, limit_mm, limit_mm);
                Column {
                    arc_mm: point.arc_mm,
                    origin_mm: point.point_mm,
                    normal: point.normal,
                    low_mm: -RAY_DEPTH_MODULES * module_mm,
                    blank_mm,
                }
            })
            .collect();
        Field { columns, leads_mm: self.leads_mm(fields.lead_spacing_mm.max(ROOT_SPACING_MM[1])) }
    }

    /// Rows along the tooth: evenly over the face, both ends included.
    fn leads_mm(&self, spacing_mm: f64) -> Vec<f64> {
        leads_mm(self.scene.gear.face_width_mm, spacing_mm)
    }

    /// Whether every row of a field is cut alike: the cutter stands still while it is in the work, so its pose is the
    /// same at all places along the tooth.
    pub fn rows_are_alike(&self) -> bool {
        self.operations.iter().all(|operation| operation.strokes.law == StrokeLaw::Frozen)
    }

    /// Runs all operations over a field. Where all rows are alike, one is cut for all: every height and pass id is what
    /// cutting each of them would give.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut(&self, backend: &dyn Backend, field: Field) -> Result<CutFlank, Error> {
        if self.rows_are_alike() && field.rows() > 1 {
            let (layers, stats) = self.cut_rows(backend, &field.section())?;
            let rows = field.rows();
            return Ok(CutFlank { layers: layers.iter().map(|layer| layer.repeated(rows)).collect(), field, stats });
        }
        let (layers, stats) = self.cut_rows(backend, &field)?;
        Ok(CutFlank { field, layers, stats })
    }

    /// Runs all operations over every row of a field.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_rows(&self, backend: &dyn Backend, field: &Field) -> Result<(Vec<Layer>, CutStats), Error> {
        let mut layers: Vec<Layer> = Vec::with_capacity(self.operations.len());
        let mut stats = CutStats::default();
        for operation in &self.operations {
            let plan = CutPlan::new(field, &operation.strokes, &self.cutter);
            let mut layer = layers.last().cloned().unwrap_or_else(|| field.blank_layer());
            stats += backend.cut(field, self.cutter.edge(), &plan, &mut layer)?;
            layers.push(layer);
        }
        Ok((layers, stats))
    }
}

/// The program that an operation is cut with.
fn read_program(path: &Path, spec: &Operation, schedule: &StrokeSchedule) -> Result<AxisProgram> {
    let program = gcode::read::file(path)?;
    if program.count() != schedule.count() {
        return Err(Refusal::new(
            &format!("operation.{}.program", spec.name),
            format!("{} makes {} strokes, the operation {}", path.display(), program.count(), schedule.count()),
            "set strokes_per_revolution, revolutions, window_deg and infeed as they are in the program",
        )
        .into());
    }
    Ok(program)
}

/// The gear sits off the work spindle by the eccentricity, and turns with it: a constant shift in the gear frame.
fn eccentricity_mm(machine: &Machine) -> DVec2 {
    machine.work_eccentricity_mm * DVec2::from_angle(machine.work_eccentricity_angle_rad)
}
