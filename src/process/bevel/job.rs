//! A bevel scene made ready to cut: blank, head, settings of every operation, target flanks, and where they stand in
//! the gear.
//!
//! In: the checked scene. Out: [`BevelJob`]. The last operation is the finishing one: its settings make the target.
//!
//! **Gear frame**: z along the axis from the back to the apex, so that a viewer in front of the teeth looks against it;
//! space 0 is centred on the x axis where the middle of the face meets the pitch cone, and tooth j lies between spaces
//! j - 1 and j, counter-clockwise. The paper's work frame has its x axis along -z; where it stands about it follows
//! from the generated flanks. Which blades cut left flanks follows from them, too.

use super::actual::{ActualSlot, SlotMoment};
use super::axis_program::read;
use super::course::SlotCourse;
use super::operation::PreparedBevel;
use super::scene::model::{Bevel, BevelOperation, SlotFeed};
use super::slots::Slots;
use crate::gcode::read_file;
use crate::machine_errors::refuse_fast_noise;
use crate::scene::Scene;
use gearcut_core::bevel::blank::BevelBlank;
use gearcut_core::bevel::cradle::CradleSettings;
use gearcut_core::bevel::envelope::{Envelope, FlankPoint};
use gearcut_core::bevel::face_mill::{BladeKind, FaceMill};
use gearcut_core::bevel::five_axis::FiveAxisMachine;
use gearcut_core::bevel::flank::BevelFlank;
use gearcut_core::bevel::inferred::InferredCutter;
use gearcut_core::dexel::Ray;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::frame::Rigid3;
use gearcut_core::terms::Side;
use gearcut_core::units::TURN_RAD;
use glam::{DMat3, DVec3};
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Turns of the head before it can meet the blank at which a plunge begins: the first turn's blades end within.
const CLEAR_TURNS: f64 = 1.5;
/// Cradle angle that is rolled beyond what the flanks need, at either end, where the scene does not name the roll: some
/// twenty marks of each kind of blade at usual speeds.
pub const ROLL_MARGIN_RAD: f64 = 3.0 * PI / 180.0;
/// Width of a blade at its tip where the scene names none, in point widths: both kinds overlap by two fifths.
const TIP_WIDTH: f64 = 0.7;
/// Height of the cutting edges in whole depths at the heel.
const BLADE_HEIGHT: f64 = 1.5;
/// Rows and shares of the profile at which the needed roll is looked for; it is a smooth function of both.
const ROLL_PLACES: usize = 9;
/// Steps of the blades' angle at which the head is compared with the blank, rad: half a millimetre on a head of 100 mm.
const WINDOW_STEP_RAD: f64 = 0.005;
/// What the window is wider than the widest contact found, rad: the steps, and the roll between those looked at.
const WINDOW_MARGIN_RAD: f64 = 0.03;
/// Moments of a slot at which the head is compared with the blank.
const WINDOW_POSES: u32 = 25;

/// Rays of both targets in space 0, row after row, with the height of the blank's surface on each, mm.
pub(super) type KeptRays = [Vec<(Ray, f32)>; 2];

/// Everything known before the first dexel is cut.
#[derive(Debug)]
pub struct BevelJob {
    /// The scene.
    pub scene: Scene,
    /// Its part of this process.
    pub spec: Bevel,
    /// The blank.
    pub blank: BevelBlank,
    /// The head.
    pub head: FaceMill,
    /// Whether its radius was inferred, and what the settings say of it.
    pub inferred: InferredCutter,
    /// The six-axis machine.
    pub machine: FiveAxisMachine,
    /// Operations in order; the last one finishes.
    pub operations: Vec<PreparedBevel>,
    /// Target flanks of space 0 in the work frame, cut by outside and inside blades.
    pub target: [BevelFlank; 2],
    /// Cradle angles between which the target's flanks are cut, rad.
    pub needed_rad: [f64; 2],
    /// Angle about the head's axis, tool frame, at which blades stand in the middle of the slot, rad.
    pub middle_rad: f64,
    /// The work frame in the gear frame, for space 0.
    pub gear_from_work: Rigid3,
    /// Which blades cut left flanks.
    pub left: BladeKind,
    /// Turn of the finished gear as a whole, rad, that the zero of the work spindle makes up for.
    pub turn_rad: f64,
    /// Passes of all operations over all slots.
    pub slots: Slots,
    pub(super) rays: OnceLock<Result<KeptRays, Refusal>>,
}

impl BevelJob {
    /// Makes a scene ready.
    ///
    /// # Errors
    /// Cone data that make no teeth, a head that cannot be made, settings that miss the blank.
    pub fn new(scene: &Scene) -> Result<Self> {
        let Some(spec) = Bevel::of(scene) else {
            return Err(Refusal::new("tool", "this tool does not cut bevel gears", "write [tool.face_mill]").into());
        };
        let blank = blank(scene, spec)?;
        let (settings, inferred) = spec.settings_on(&blank)?;
        let mut head = head(spec, &blank, &inferred);
        let held_back =
            |offset_mm: f64| CradleSettings { sliding_base_mm: settings.sliding_base_mm - offset_mm, ..settings };
        let last = spec.operations.last().expect("a checked scene has at least one operation");
        let flank = |kind: BladeKind| {
            BevelFlank::new(Envelope { settings: held_back(last.offset_mm), surface: head.surface(kind) }, blank)
        };
        let target = [flank(BladeKind::Outside)?, flank(BladeKind::Inside)?];
        let (needed_rad, middle_rad) = needed_roll(&target)?;
        let mut start_s = 0.0;
        let operations: Vec<PreparedBevel> = spec
            .operations
            .iter()
            .map(|operation| {
                let prepared = PreparedBevel {
                    spec: operation.clone(),
                    settings: held_back(operation.offset_mm),
                    as_set: spec.with_errors(&held_back(operation.offset_mm)),
                    course: course(operation, &held_back(operation.offset_mm), &blank, needed_rad),
                    start_s,
                    program: operation.program.as_deref().map(|path| read_file(path, read)).transpose()?,
                };
                start_s += f64::from(blank.teeth) * prepared.cycle_s();
                Ok(prepared)
            })
            .collect::<Result<_>>()?;
        head.half_window_rad = 0.0;
        for operation in &operations {
            head.half_window_rad = head.half_window_rad.max(half_window_rad(operation, &head, &blank, middle_rad)?);
        }
        let (gear_from_work, left) = placed(&target)?;
        let machine = FiveAxisMachine { mounting_mm: spec.mounting_mm };
        let towards_work = Rigid3 { rotation: DMat3::from_rotation_z(middle_rad), translation_mm: DVec3::ZERO };
        let middle_z_mm = -(blank.outer_cone_distance_mm - 0.5 * blank.face_width_mm) * blank.pitch_angle_rad.cos();
        for operation in &operations {
            let names = ["x", "y", "z", "work", "swing"];
            refuse_fast_noise(spec.errors.axes.iter().zip(names), operation.spec.head_speed_rad_per_s / TURN_RAD)?;
        }
        let actual = operations
            .iter()
            .map(|operation| ActualSlot::new(&spec.errors, spec.head.mounting, machine, operation, middle_z_mm));
        let mut actual: Vec<ActualSlot> = actual.collect();
        let turn_rad = actual.last().map_or(0.0, ActualSlot::turn_rad);
        for of in &mut actual {
            of.make_up_for(turn_rad);
        }
        let slots = Slots::new(
            &operations,
            &head,
            (spec.head.start_angle_rad, blank.teeth),
            &|operation, slot, time_s, tool_rad| {
                let index = index(slot, blank.teeth);
                let indexed_rad = TURN_RAD * f64::from(slot) / f64::from(blank.teeth);
                let moment = SlotMoment { slot, indexed_rad, time_s, tool_rad };
                actual[operation].gear_from_head(&moment, &gear_from_work, &index, &towards_work)
            },
        )?;
        let job = Self {
            scene: scene.clone(),
            spec: spec.clone(),
            blank,
            head,
            inferred,
            machine,
            operations,
            target,
            needed_rad,
            middle_rad,
            gear_from_work,
            left,
            turn_rad,
            slots,
            rays: OnceLock::new(),
        };
        job.check_grid()?;
        Ok(job)
    }

    /// Spiral angle that the settings place on the mean point, rad; positive for right-hand spirals.
    pub fn inferred_spiral_rad(&self) -> f64 {
        self.finishing().settings.cradle_angle_rad.signum() * self.inferred.spiral_angle_rad
    }

    /// The finishing operation.
    pub fn finishing(&self) -> &PreparedBevel {
        self.operations.last().expect("a checked scene has at least one operation")
    }

    /// Blades that cut a side of the teeth.
    pub fn kind_of(&self, side: Side) -> BladeKind {
        match (side, self.left) {
            (Side::Left, kind) => kind,
            (Side::Right, BladeKind::Outside) => BladeKind::Inside,
            (Side::Right, BladeKind::Inside) => BladeKind::Outside,
        }
    }

    /// Space beside a flank: space j follows tooth j, and space 0 the last one.
    pub fn space_of(&self, tooth: u32, side: Side) -> u32 {
        match side {
            Side::Left => tooth % self.blank.teeth,
            Side::Right => tooth - 1,
        }
    }

    /// Target of a flank in space 0.
    pub fn target_of(&self, side: Side) -> &BevelFlank {
        &self.target[self.kind_of(side).index()]
    }
}

/// Turn about the gear's axis to a space.
pub fn index(space: u32, teeth: u32) -> Rigid3 {
    let angle = TURN_RAD * f64::from(space) / f64::from(teeth);
    Rigid3 { rotation: DMat3::from_rotation_z(angle), translation_mm: DVec3::ZERO }
}

fn blank(scene: &Scene, spec: &Bevel) -> Result<BevelBlank, Refusal> {
    let (gear, cones) = (&scene.gear, &spec.cones);
    BevelBlank::new(BevelBlank {
        teeth: gear.teeth,
        pitch_angle_rad: cones.pitch_angle_rad,
        face_angle_rad: cones.face_angle_rad,
        root_angle_rad: cones.root_angle_rad,
        outer_cone_distance_mm: 0.5 * gear.module_mm * f64::from(gear.teeth) / cones.pitch_angle_rad.sin(),
        face_width_mm: gear.face_width_mm,
        outer_addendum_mm: cones.addendum_mm,
        outer_dedendum_mm: cones.dedendum_mm,
    })
}

fn head(spec: &Bevel, blank: &BevelBlank, inferred: &InferredCutter) -> FaceMill {
    let of = &spec.head;
    let runouts_mm = if of.runouts_mm.is_empty() { vec![0.0; of.blades as usize] } else { of.runouts_mm.clone() };
    FaceMill {
        radius_mm: of.radius_mm.unwrap_or(inferred.radius_mm),
        point_width_mm: of.point_width_mm,
        blade_angles_rad: of.blade_angles_rad,
        corner_radii_mm: [of.corner_radius_mm; 2],
        tip_width_mm: of.tip_width_mm.unwrap_or(TIP_WIDTH * of.point_width_mm),
        blade_height_mm: BLADE_HEIGHT * (blank.outer_addendum_mm + blank.outer_dedendum_mm),
        runouts_mm,
        half_window_rad: PI,
    }
}

/// A slot's motion.
fn course(
    operation: &BevelOperation,
    settings: &CradleSettings,
    blank: &BevelBlank,
    needed_rad: [f64; 2],
) -> SlotCourse {
    match operation.feed {
        SlotFeed::Roll { rad_per_s, ends_rad } => {
            let from = ends_rad[0].unwrap_or(needed_rad[0] - ROLL_MARGIN_RAD);
            let to = ends_rad[1].unwrap_or(needed_rad[1] + ROLL_MARGIN_RAD);
            SlotCourse { range: [from, to], per_s: rad_per_s * (to - from).signum(), dwell_s: 0.0 }
        }
        SlotFeed::Plunge { mm_per_turn, dwell_revolutions } => {
            let turns_per_s = operation.head_speed_rad_per_s / TURN_RAD;
            let way_mm = deepest_mm(settings, blank) + CLEAR_TURNS * mm_per_turn;
            let per_s = mm_per_turn * turns_per_s;
            SlotCourse { range: [-way_mm, 0.0], per_s, dwell_s: dwell_revolutions / turns_per_s }
        }
    }
}

/// How deep the plane of the tips stands in the blank at most, mm.
fn deepest_mm(settings: &CradleSettings, blank: &BevelBlank) -> f64 {
    let heel_mm = blank.outer_cone_distance_mm;
    let tips =
        [heel_mm - blank.face_width_mm, heel_mm].map(|distance_mm| [distance_mm, blank.addendum_mm(distance_mm)]);
    tips.into_iter().map(|tip| -settings.short_of_mm(blank.axial_mm(tip))).fold(0.0, f64::max)
}

/// Cradle angles between which both flanks are cut, and the angle about the head's axis in their middle.
fn needed_roll(target: &[BevelFlank; 2]) -> Result<([f64; 2], f64), Refusal> {
    let mut needed = [f64::INFINITY, f64::NEG_INFINITY];
    let mut middle_rad = 0.0;
    for flank in target {
        let step = 1.0 / (ROLL_PLACES - 1) as f64;
        for i in 0..ROLL_PLACES {
            let row = flank.row(flank.blank.face_width_mm * (i as f64 * step - 0.5))?;
            for j in 0..ROLL_PLACES {
                let point = row.point(j as f64 * step)?;
                needed = [needed[0].min(point.cradle_rad), needed[1].max(point.cradle_rad)];
            }
        }
        middle_rad += 0.5 * flank.row(0.0)?.point(0.5)?.head_rad;
    }
    Ok((needed, middle_rad))
}

/// Half of the window in which an operation's blades are in the blank, about `middle_rad`.
fn half_window_rad(
    operation: &PreparedBevel,
    head: &FaceMill,
    blank: &BevelBlank,
    middle_rad: f64,
) -> Result<f64, Refusal> {
    let [from, to] = operation.course.range;
    let poses: Vec<Rigid3> = (0..WINDOW_POSES)
        .map(|i| from + (to - from) * f64::from(i) / f64::from(WINDOW_POSES - 1))
        .map(|moment| operation.as_set.work_from_tool(moment))
        .collect();
    let surfaces = BladeKind::BOTH.map(|kind| head.surface(kind));
    let inside = |off_rad: f64| {
        let tips = surfaces.iter().map(|surface| surface.point_mm(middle_rad + off_rad, 0.0));
        tips.into_iter().any(|tip| poses.iter().any(|pose| blank.holds(pose.point(tip))))
    };
    let steps = (PI / WINDOW_STEP_RAD) as u32;
    let touched = |sign: f64| (0..steps).filter(move |&i| inside(sign * WINDOW_STEP_RAD * f64::from(i)));
    let mut half = 0.0_f64;
    for sign in [1.0, -1.0] {
        let found: Vec<u32> = touched(sign).collect();
        if let Some(gap) = found.windows(2).find(|pair| pair[1] > pair[0] + 1) {
            return Err(Refusal::new(
                "tool.face_mill.radius_mm",
                format!(
                    "the head leaves the blank {:.1} deg from the middle of the slot and hits it again {:.1} deg from \
                     it: it cuts into the far side of the gear",
                    (WINDOW_STEP_RAD * f64::from(gap[0])).to_degrees(),
                    (WINDOW_STEP_RAD * f64::from(gap[1])).to_degrees()
                ),
                "check cutter radius, radial setting and root angle",
            ));
        }
        half = half.max(WINDOW_STEP_RAD * f64::from(found.last().copied().unwrap_or(0)));
    }
    if half == 0.0 {
        return Err(Refusal::new(
            "machine.cradle",
            format!("operation {}: the head never meets the blank", operation.spec.name),
            "check radial setting, cradle angle and sliding base",
        ));
    }
    Ok((half + WINDOW_MARGIN_RAD).min(PI))
}

/// The work frame in the gear frame, and the blades that cut left flanks: those at the smaller polar angle of a space.
fn placed(target: &[BevelFlank; 2]) -> Result<(Rigid3, BladeKind), Refusal> {
    let over = DMat3::from_cols(DVec3::NEG_Z, DVec3::NEG_Y, DVec3::NEG_X);
    let polar = |flank: &BevelFlank| -> Result<f64, Refusal> {
        let row = flank.row(0.0)?;
        let FlankPoint { point_mm, .. } = row.point(row.pitch_share())?;
        let point = over * point_mm;
        Ok(point.y.atan2(point.x))
    };
    let [outside, inside] = [polar(&target[0])?, polar(&target[1])?];
    // The way from one side of the slot to the other, short round.
    let across = (inside - outside + PI).rem_euclid(TURN_RAD) - PI;
    let turn = DMat3::from_rotation_z(-(outside + 0.5 * across));
    let left = if across > 0.0 { BladeKind::Outside } else { BladeKind::Inside };
    Ok((Rigid3 { rotation: turn * over, translation_mm: DVec3::ZERO }, left))
}
