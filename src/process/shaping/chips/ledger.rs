//! The ledger of a whole job: spaces in parallel, strokes in order of time within each of them.

use super::oblique::{ElementForce, RakeFace};
use super::section::SpaceSection;
use super::stroke::{StrokeChips, StrokePose, ToothChip};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::edge_polygon::{EdgePolygon, Station};
use crate::process::shaping::scene::model::Infeed;
use gearcut_core::cut::LEAST_CHIP_MM;
use gearcut_core::frame::Rigid2;
use gearcut_core::gear::{Back, GearKind};
use gearcut_core::tool::{CuttingTool, PlanarTool};
use gearcut_core::units::TURN_RAD;
use glam::DVec2;
use rayon::prelude::*;

/// Chips of a smaller area are rounding, mm^2: a nanometre over a tenth of a millimetre.
const LEAST_AREA_MM2: f64 = 1e-7;
/// Most rows of a map over strokes: more cannot be told apart in a picture, and files stay small.
const MOST_ROWS: usize = 2000;
/// Every so many corners of the tooth stand for it when a window is laid out.
const COARSE_CORNERS: usize = 16;
/// Half of the length along the pitch curve, in pitches, over which the outline can matter to a space.
const NEIGHBOURHOOD_PITCHES: f64 = 1.6;

/// How far the rays of a section are turned against the space. Rays that run along the blank's outline would meet the
/// ends of all chips at the same fraction of their spacing, and all areas would be off to the same side; turned by this
/// much, they meet them at every fraction in turn.
const SKEW_RAD: f64 = 0.15;

/// Largest uncut chip thickness over rows (strokes or spaces) and stations of the edge.
#[derive(Debug, Clone, PartialEq)]
pub struct ThicknessMap {
    /// Rows.
    pub rows: usize,
    /// Strokes (or spaces) that a row stands for.
    pub per_row: f64,
    /// Thickness, mm, row by row; 0 where nothing is cut.
    pub thickness_mm: Vec<f32>,
}

/// Chips of one operation.
#[derive(Debug, Clone, PartialEq)]
pub struct OperationChips {
    /// The first stroke comes at full depth, without an infeed: it takes a plug of whole tooth spaces at once, as no
    /// machine would, and is left out where strokes are compared.
    pub enters_at_depth: bool,
    /// One entry per stroke.
    pub strokes: Vec<StrokeChips>,
    /// Largest thickness over strokes and edge, over all cutter teeth.
    pub by_stroke: ThicknessMap,
    /// Largest thickness over tooth spaces (1 to z) and edge.
    pub by_space: ThicknessMap,
}

/// Chips of a whole job.
#[derive(Debug, Clone, PartialEq)]
pub struct ChipLedger {
    /// Operations in order.
    pub operations: Vec<OperationChips>,
    /// Places along the edge.
    pub stations: Vec<Station>,
    /// Spacing of rays and stations, mm.
    pub spacing_mm: f64,
}

/// One pass near a space.
#[derive(Debug, Clone, Copy)]
struct SpacePass {
    operation: u32,
    stroke: u32,
    blade: u32,
    section_from_blade: Rigid2,
    /// The tooth's tip stands in this space.
    own: bool,
}

/// What one space gives to the ledger.
struct SpaceChips {
    chips: Vec<ToothChip>,
    /// Per operation, (row of the map over strokes, thickness at the stations).
    rows: Vec<Vec<(usize, Vec<f32>)>>,
}

impl ChipLedger {
    /// Follows all strokes of a job; `advance` is called after every space and says whether to go on. `None`: stopped.
    pub fn new(job: &ShapingJob, advance: &(dyn Fn() -> bool + Sync)) -> Option<Self> {
        let spacing_mm = job.chip_spacing_mm;
        let polygon = EdgePolygon::new(job.cutter.edge(), spacing_mm);
        let rake_rad = job.cutter_spec.rake_angle_rad;
        let force = |station: &Station| {
            let face = RakeFace::on_cone(rake_rad, station.point_mm, station.normal);
            ElementForce::new(&job.material, rake_rad, face)
        };
        let forces: Vec<ElementForce> = polygon.stations.iter().map(force).collect();
        let contours_mm = contours(job);
        let spaces: Vec<Option<SpaceChips>> = (1..=job.scene.gear.teeth)
            .into_par_iter()
            .map(|space| {
                let chips = Space::new(job, &polygon, &contours_mm, space).cut(&forces, spacing_mm);
                advance().then_some(chips)
            })
            .collect();
        let stations = polygon.stations.len();
        let map = |rows: usize, per_row| ThicknessMap { rows, per_row, thickness_mm: vec![0.0; rows * stations] };
        let mut operations: Vec<OperationChips> = job
            .operations
            .iter()
            .map(|operation| {
                let count = operation.count();
                OperationChips {
                    enters_at_depth: operation.spec.infeed == Infeed::None,
                    strokes: vec![StrokeChips::default(); count],
                    by_stroke: map(count.min(MOST_ROWS), count.max(1) as f64 / count.clamp(1, MOST_ROWS) as f64),
                    by_space: map(job.scene.gear.teeth as usize, 1.0),
                }
            })
            .collect();
        let mut chips = Vec::new();
        for (index, space) in spaces.into_iter().enumerate() {
            let space = space?;
            chips.extend(space.chips);
            for (operation, rows) in operations.iter_mut().zip(space.rows) {
                for (row, thickness_mm) in rows {
                    raise(&mut operation.by_stroke.thickness_mm[row * stations..][..stations], &thickness_mm);
                    raise(&mut operation.by_space.thickness_mm[index * stations..][..stations], &thickness_mm);
                }
            }
        }
        chips.sort_unstable_by_key(|c| (c.operation, c.stroke, c.blade));
        let eccentricity_mm = job.eccentricity_mm();
        let module_mm = job.scene.gear.module_mm;
        for chip in &chips {
            let pose = middle_pose(job, chip.operation, chip.stroke as usize);
            let stroke = &mut operations[chip.operation].strokes[chip.stroke as usize];
            stroke.add(chip, module_mm, pose.translation_mm + eccentricity_mm);
        }
        Some(Self { operations, stations: polygon.stations, spacing_mm })
    }

    /// Area that an operation takes from the transverse section, mm^2.
    pub fn area_mm2(&self, operation: usize) -> f64 {
        self.operations[operation].strokes.iter().map(|stroke| stroke.area_mm2).sum()
    }
}

impl OperationChips {
    /// The stroke with the largest value, an entry at depth left out; `None` if all others are idle.
    pub fn largest(&self, value: impl Fn(&StrokeChips) -> f64) -> Option<(usize, &StrokeChips)> {
        let compared = self.strokes.iter().enumerate().skip(usize::from(self.enters_at_depth));
        let busy = compared.filter(|(_, stroke)| !stroke.is_idle());
        busy.reduce(|best, next| if value(next.1) > value(best.1) { next } else { best })
    }

    /// The first stroke, where it enters at depth and cuts.
    pub fn entry(&self) -> Option<&StrokeChips> {
        self.strokes.first().filter(|stroke| self.enters_at_depth && !stroke.is_idle())
    }

    /// Strokes that cut nothing.
    pub fn idle(&self) -> usize {
        self.strokes.iter().filter(|stroke| stroke.is_idle()).count()
    }
}

fn raise(map: &mut [f32], values: &[f32]) {
    for (cell, &value) in map.iter_mut().zip(values) {
        *cell = cell.max(value);
    }
}

/// Pose of the tool when a stroke is in the middle of the face.
fn middle_pose(job: &ShapingJob, operation: usize, stroke: usize) -> Rigid2 {
    let set = &job.operations[operation].strokes;
    set.pose_at(stroke, set.law.tau(0.0))
}

/// The blank as closed polygons, gear frame: its outline on the toothed side, and the circle round a ring. Between an
/// odd and the next even crossing of a ray is material. A bore is left out: no chip reaches it.
fn contours(job: &ShapingJob) -> Vec<Vec<DVec2>> {
    let count = job.curve.samples_per_turn().clamp(8192, 1 << 15);
    let closed = |at: &dyn Fn(f64) -> DVec2| (0..count).map(|i| at(TURN_RAD * i as f64 / count as f64)).collect();
    let outline = closed(&|phi| job.blank.outline_mm(phi));
    match job.blank.back {
        Back { kind: GearKind::Internal, radius_mm } => vec![outline, closed(&|a| radius_mm * DVec2::from_angle(a))],
        _ => vec![outline],
    }
}

/// One tooth space with the passes that touch its neighbourhood.
struct Space<'a> {
    job: &'a ShapingJob,
    polygon: &'a EdgePolygon,
    number: u32,
    work_from_section: Rigid2,
    contours_mm: Vec<Vec<DVec2>>,
    window_mm: [DVec2; 2],
    passes: Vec<SpacePass>,
}

impl<'a> Space<'a> {
    /// Space `number` (1 to z): the one after tooth `number`.
    fn new(job: &'a ShapingJob, polygon: &'a EdgePolygon, contours_mm: &[Vec<DVec2>], number: u32) -> Self {
        let pitch_mm = std::f64::consts::PI * job.scene.gear.module_mm;
        let at = |pitches: f64| job.curve.phi_at_arc((f64::from(number) + pitches) * pitch_mm);
        let middle = job.curve.frame(at(0.0));
        let out = job.blank.towards_tip(&middle);
        let rotation = DVec2::from_angle(SKEW_RAD).rotate(out);
        let work_from_section = Rigid2 { rotation, translation_mm: middle.point_mm };
        let section_from_work = work_from_section.inverse();
        let placed = |contour: &Vec<DVec2>| contour.iter().map(|&p| section_from_work.point(p)).collect();
        let contours_mm: Vec<Vec<DVec2>> = contours_mm.iter().map(placed).collect();
        let near_mm = NEIGHBOURHOOD_PITCHES * pitch_mm;
        let out = section_from_work.direction(out);
        // Across a ring lies its other side.
        let far_mm = match job.blank.kind() {
            GearKind::External => f64::INFINITY,
            GearKind::Internal => job.curve.facts().smallest_radius_mm,
        };
        let heights_mm = contours_mm[0].iter().filter(|p| p.perp_dot(out).abs() < near_mm).map(|p| p.dot(out));
        let top_mm = heights_mm.filter(|&height_mm| height_mm < far_mm).fold(0.0, f64::max);
        let mut space = Self {
            job,
            polygon,
            number,
            work_from_section,
            contours_mm,
            window_mm: [DVec2::INFINITY, DVec2::NEG_INFINITY],
            passes: Vec::new(),
        };
        space.lay_window([at(-0.5), at(0.5)], out, top_mm);
        space.find_passes([at(-0.5), at(0.5)]);
        space
    }

    /// All passes with the section pose of their blades, in order of time.
    fn each_pass(&self, mut act: impl FnMut(SpacePass, &Rigid2)) {
        let section_from_work = self.work_from_section.inverse();
        let cutter = &self.job.cutter;
        let blades: Vec<Rigid2> = (0..cutter.blade_count()).map(|blade| cutter.tool_from_blade(blade)).collect();
        // No tooth of the cutter is nearer to the section's origin than its axis less this.
        let tool_reach_mm = blades.iter().map(|b| b.point(self.polygon.center_mm).length()).fold(0.0, f64::max);
        let near_mm = 4.0 * self.polygon.reach_mm;
        for operation in 0..self.job.operations.len() {
            for stroke in 0..self.job.operations[operation].strokes.count() {
                let section_from_tool = section_from_work.after(&middle_pose(self.job, operation, stroke));
                if section_from_tool.translation_mm.length() > tool_reach_mm + near_mm {
                    continue;
                }
                for (blade, tool_from_blade) in blades.iter().enumerate() {
                    let section_from_blade = section_from_tool.after(tool_from_blade);
                    if section_from_blade.point(self.polygon.center_mm).length() > near_mm {
                        continue;
                    }
                    let pass = SpacePass {
                        operation: operation as u32,
                        stroke: stroke as u32,
                        blade: blade as u32,
                        section_from_blade,
                        own: false,
                    };
                    act(pass, &section_from_blade);
                }
            }
        }
    }

    /// Whether a tooth's tip stands between the polar angles at which the space begins and ends.
    fn owns(&self, section_from_blade: &Rigid2, [from_rad, to_rad]: [f64; 2]) -> bool {
        let tip = self.work_from_section.point(section_from_blade.point(self.polygon.tip_mm));
        (tip.to_angle() - from_rad).rem_euclid(TURN_RAD) < to_rad - from_rad
    }

    /// The box round all places where this space's own teeth can meet material.
    fn lay_window(&mut self, limits_rad: [f64; 2], out: DVec2, top_mm: f64) {
        let coarse: Vec<DVec2> =
            self.polygon.corners_mm[..=self.polygon.edge_chords()].iter().step_by(COARSE_CORNERS).copied().collect();
        // Between two of them the tooth stays within their distance of both.
        let margin_mm = coarse.windows(2).map(|c| c[0].distance(c[1])).fold(0.0, f64::max);
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        self.each_pass(|_, section_from_blade| {
            if !self.owns(section_from_blade, limits_rad) {
                return;
            }
            for p in coarse.iter().map(|&p| section_from_blade.point(p)).filter(|p| p.dot(out) < top_mm + margin_mm) {
                (low, high) = (low.min(p), high.max(p));
            }
        });
        self.window_mm = [low - margin_mm, high + margin_mm];
    }

    /// The passes that reach into the window.
    fn find_passes(&mut self, limits_rad: [f64; 2]) {
        let [low, high] = self.window_mm;
        let mut passes = Vec::new();
        if low.cmple(high).all() {
            let reach_mm = self.polygon.reach_mm;
            self.each_pass(|pass, section_from_blade| {
                let center = section_from_blade.point(self.polygon.center_mm);
                if center.distance(center.clamp(low, high)) <= reach_mm {
                    passes.push(SpacePass { own: self.owns(section_from_blade, limits_rad), ..pass });
                }
            });
        }
        self.passes = passes;
    }

    fn cut(&self, forces: &[ElementForce], spacing_mm: f64) -> SpaceChips {
        let operations = &self.job.operations;
        let mut chips = Vec::new();
        let mut rows: Vec<Vec<(usize, Vec<f32>)>> = vec![Vec::new(); operations.len()];
        if self.passes.is_empty() {
            return SpaceChips { chips, rows };
        }
        let mut section = SpaceSection::new(self.polygon, spacing_mm, &self.contours_mm, self.window_mm);
        let mut thickness_mm = Vec::new();
        for pass in &self.passes {
            let area_mm2 = section.cut(&pass.section_from_blade);
            if !pass.own || area_mm2 < LEAST_AREA_MM2 {
                continue;
            }
            section.thickness_mm(&pass.section_from_blade, &mut thickness_mm);
            let operation = pass.operation as usize;
            let mut chip = ToothChip {
                operation,
                stroke: pass.stroke,
                blade: pass.blade,
                space: self.number,
                area_mm2,
                contact_mm: [0.0; 3],
                thickest_mm: [0.0; 3],
                cutting_n: 0.0,
                side_force_n: DVec2::ZERO,
                work_torque_nmm: 0.0,
                cutter_torque_nmm: 0.0,
            };
            let stand = StrokePose {
                work_from_blade: self.work_from_section.after(&pass.section_from_blade),
                cutter_axis_mm: middle_pose(self.job, operation, pass.stroke as usize).translation_mm,
                work_axis_mm: -self.job.eccentricity_mm(),
            };
            chip.measure(&self.polygon.stations, forces, &thickness_mm, &stand);
            chips.push(chip);
            let row =
                pass.stroke as usize * operations[operation].count().min(MOST_ROWS) / operations[operation].count();
            let shown = thickness_mm.iter().map(|&h| if h < LEAST_CHIP_MM { 0.0 } else { h as f32 });
            match rows[operation].last_mut() {
                Some((last, values)) if *last == row => raise(values, &shown.collect::<Vec<_>>()),
                _ => rows[operation].push((row, shown.collect())),
            }
        }
        SpaceChips { chips, rows }
    }
}
