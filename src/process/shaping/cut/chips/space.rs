//! One tooth space and the passes that touch its neighbourhood, in order of time.
//!
//! In: the job and the number of a space. Out: the blank's contours and a window in the frame of the space, the passes
//! that reach into the window, and the section that they cut.

use super::own_region::{CoarseTooth, SweptRegion};
use super::section::SpaceSection;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::tool::edge_polygon::EdgePolygon;
use gearcut_core::frame::Rigid2;
use gearcut_core::gear::{Back, GearKind};
use gearcut_core::tool::{CuttingTool, PlanarTool};
use gearcut_core::units::TURN_RAD;
use glam::DVec2;

/// Chips of a smaller area are rounding, mm^2: a nanometre over a tenth of a millimetre.
pub(super) const LEAST_AREA_MM2: f64 = 1e-7;
/// Every so many corners of the tooth stand for it when a window is laid out.
const COARSE_CORNERS: usize = 16;
/// Half of the length along the pitch curve, in pitches, over which the outline can matter to a space.
const NEIGHBOURHOOD_PITCHES: f64 = 1.6;

/// How far the rays of a section are turned against the space. Rays that run along the blank's outline would meet the
/// ends of all chips at the same fraction of their spacing, and all areas would be off to the same side; turned by this
/// much, they meet them at every fraction in turn.
const SKEW_RAD: f64 = 0.15;

/// One pass near a space.
#[derive(Debug, Clone, Copy)]
pub(super) struct SpacePass {
    pub(super) operation: u32,
    pub(super) stroke: u32,
    pub(super) blade: u32,
    pub(super) section_from_blade: Rigid2,
    /// The tooth's tip stands in this space.
    pub(super) own: bool,
}

/// Pose of the tool when a stroke is in the middle of the face.
pub(super) fn middle_pose(job: &ShapingJob, operation: usize, stroke: usize) -> Rigid2 {
    let set = &job.operations[operation].strokes;
    set.pose_at(stroke, set.law.tau(0.0))
}

/// The blank as closed polygons, gear frame: its outline on the toothed side, and the circle round a ring. Between an
/// odd and the next even crossing of a ray is material. A bore is left out: no chip reaches it.
pub(super) fn contours(job: &ShapingJob) -> Vec<Vec<DVec2>> {
    let count = job.curve.samples_per_turn().clamp(8192, 1 << 15);
    let circle = |radius_mm: f64| {
        (0..count).map(|i| radius_mm * DVec2::from_angle(TURN_RAD * i as f64 / count as f64)).collect()
    };
    let outline = job.blank.polygon_mm(count);
    match job.blank.back {
        Back { kind: GearKind::Internal, radius_mm } => vec![outline, circle(radius_mm)],
        _ => vec![outline],
    }
}

/// One tooth space with passes that touch its neighbourhood.
pub(super) struct Space<'a> {
    pub(super) job: &'a ShapingJob,
    pub(super) polygon: &'a EdgePolygon,
    pub(super) number: u32,
    pub(super) work_from_section: Rigid2,
    contours_mm: Vec<Vec<DVec2>>,
    window_mm: [DVec2; 2],
    pub(super) passes: Vec<SpacePass>,
}

/// Up to where the material of a space's neighbourhood stands, and places that stand for a tooth's edge.
pub(super) struct StockHeight {
    /// Every few corners of the edge, blade frame.
    coarse_mm: Vec<DVec2>,
    /// Between two of them the edge stays within their distance of both; and poses may be others by some room.
    margin_mm: f64,
    /// Towards the tips of the gear's teeth, section frame.
    out: DVec2,
    top_mm: f64,
}

impl StockHeight {
    fn new(polygon: &EdgePolygon, out: DVec2, top_mm: f64, room_mm: f64) -> Self {
        let corners = polygon.corners_mm[..=polygon.edge_chords()].iter();
        let coarse_mm: Vec<DVec2> = corners.step_by(COARSE_CORNERS).copied().collect();
        let margin_mm = room_mm + coarse_mm.windows(2).map(|c| c[0].distance(c[1])).fold(0.0, f64::max);
        Self { coarse_mm, margin_mm, out, top_mm }
    }

    /// Places of a tooth's edge about which there can be material, section frame.
    fn met_by(&self, section_from_blade: &Rigid2) -> impl Iterator<Item = DVec2> {
        let placed = self.coarse_mm.iter().map(|&p| section_from_blade.point(p));
        placed.filter(|p| p.dot(self.out) < self.top_mm + self.margin_mm)
    }
}

impl<'a> Space<'a> {
    /// Space `number` (1 to z): the one after tooth `number`, with the passes that its chips depend on. Passes may
    /// stand elsewhere by as much as `room_mm`.
    pub(super) fn new(
        job: &'a ShapingJob,
        polygon: &'a EdgePolygon,
        contours_mm: &[Vec<DVec2>],
        number: u32,
        room_mm: f64,
    ) -> Self {
        let (mut space, stock) = Self::with_all_passes(job, polygon, contours_mm, number, room_mm);
        space.leave_out_idle_passes(&stock, room_mm);
        space
    }

    /// The same with all passes that touch its neighbourhood, and how far its material reaches.
    pub(super) fn with_all_passes(
        job: &'a ShapingJob,
        polygon: &'a EdgePolygon,
        contours_mm: &[Vec<DVec2>],
        number: u32,
        room_mm: f64,
    ) -> (Self, StockHeight) {
        let pitch_mm = std::f64::consts::PI * job.transverse.module_mm;
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
        let limits_rad = [at(-0.5), at(0.5)];
        let stock = StockHeight::new(polygon, out, top_mm, room_mm);
        space.lay_window(limits_rad, &stock);
        space.find_passes(limits_rad, &stock, room_mm);
        (space, stock)
    }

    /// Leaves out the passes that change none of its chips: those that come nowhere where its own teeth come.
    fn leave_out_idle_passes(&mut self, stock: &StockHeight, room_mm: f64) {
        let tooth = CoarseTooth::new(self.polygon);
        let own = self.passes.iter().filter(|pass| pass.own).map(|pass| &pass.section_from_blade);
        // Both may stand elsewhere.
        let region = SweptRegion::new(&tooth, stock.out, stock.top_mm, 2.0 * room_mm, own);
        let mut scratch = Vec::new();
        self.passes.retain(|pass| pass.own || region.is_entered_by(&pass.section_from_blade, &mut scratch));
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
    fn lay_window(&mut self, limits_rad: [f64; 2], stock: &StockHeight) {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        self.each_pass(|_, section_from_blade| {
            if !self.owns(section_from_blade, limits_rad) {
                return;
            }
            for p in stock.met_by(section_from_blade) {
                (low, high) = (low.min(p), high.max(p));
            }
        });
        self.window_mm = [low - stock.margin_mm, high + stock.margin_mm];
    }

    /// The passes that reach into the window and below the top of the material.
    fn find_passes(&mut self, limits_rad: [f64; 2], stock: &StockHeight, room_mm: f64) {
        let [low, high] = self.window_mm;
        let mut passes = Vec::new();
        if low.cmple(high).all() {
            let reach_mm = self.polygon.reach_mm + room_mm;
            self.each_pass(|pass, section_from_blade| {
                let center = section_from_blade.point(self.polygon.center_mm);
                if center.distance(center.clamp(low, high)) <= reach_mm
                    && stock.met_by(section_from_blade).next().is_some()
                {
                    passes.push(SpacePass { own: self.owns(section_from_blade, limits_rad), ..pass });
                }
            });
        }
        self.passes = passes;
    }

    /// Its material before the first pass.
    pub(super) fn section(&self) -> SpaceSection<'a> {
        SpaceSection::new(self.polygon, self.job.chip_spacing_mm, &self.contours_mm, self.window_mm)
    }
}
