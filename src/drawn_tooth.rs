//! A tool's tooth as it is drawn or measured: arcs, lines and corners from root to root.
//!
//! In: points of the contour ([`contour`]) and a tolerance. Out: [`DrawnTooth`], the parts of the contour in the order
//! of the chain, from which the envelope is made ([`envelope`]), and the segments that cut. Where a tooth lies on its
//! tool, [`ContourPlace`] says: on a shaper cutter's pitch circle, or on the pitch line of a hob's basic rack.
//!
//! The contour is divided at its corners ([`runs`]), and every smooth run is fitted with arcs that meet without a kink
//! ([`biarcs`]) within half the tolerance. Where arcs are hollow, tangents replace them that cross within the other
//! half: bounds of passes and Newton's method along a ray rest on convex segments, and a line is one. So a cut by a
//! drawn edge equals brute force bit for bit, on both backends, by what holds for every edge. Tangents lie in the tool:
//! a gear keeps material by so much, and is not cut below what the arcs generate.
//!
//! **Names.** The tip is the part that crosses the centre line; what lies beside it with a normal within
//! [`FLANK_RAD`] of the centre line is its corner, the rest up to where normals turn back for good the flank, and then
//! the root. Arcs are divided where their normals pass that angle.
//!
//! Road not taken: hollow tables with bounds of their own. They would cut without the error of tangents, a fraction of
//! a micrometre on a tool that was measured to one, and need another law in every bound and every kernel.

pub mod biarcs;
pub mod contour;
pub mod envelope;
pub mod flank;
mod runs;
pub mod scattered;

use biarcs::ArcPiece;
use gearcut_core::error::Refusal;
use gearcut_core::tool::edge::{Edge, Segment, SegmentName};
use glam::DVec2;
use scattered::turn_rad;
use std::f64::consts::FRAC_PI_4;
use std::path::Path;

/// Normals further than this from the tooth's centre line are those of flanks, rad: half-way between tip and flank.
const FLANK_RAD: f64 = FRAC_PI_4;
/// Ends of parts whose normals differ by more than this have a corner between them, rad.
pub const KINK_RAD: f64 = 1e-9;
/// The tip may lie this far, in modules, beside where the scene's addendum has it: what a measured tool is off, and
/// less than any mistake of unit or module.
const TIP_OFF_MODULES: f64 = 0.05;
/// A place this near to the centre line is on it, mm: rounding.
const SAME_MM: f64 = 1e-9;
/// Segments of an edge: a blade's set of them has 128 bits.
const MOST_SEGMENTS: usize = 128;

/// Part of a drawn edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawnPart {
    /// What it is on the tooth.
    pub name: SegmentName,
    /// Its law.
    pub law: PartLaw,
}

/// Law of a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PartLaw {
    /// An arc, or a corner of radius 0: its places are centre + radius * normal, normals from the first angle to the
    /// last. A hollow arc has a negative radius, and its normals turn back.
    Turn {
        /// Centre, blade frame.
        center_mm: DVec2,
        /// Radius; below 0: hollow.
        radius_mm: f64,
        /// Angles of the outward normals at both ends.
        normals_rad: [f64; 2],
    },
    /// A line.
    Line {
        /// First end.
        start_mm: DVec2,
        /// Last end.
        end_mm: DVec2,
    },
}

/// A place of a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgePlace {
    /// Point, blade frame.
    pub point_mm: DVec2,
    /// Unit normal out of the tool.
    pub normal: DVec2,
}

impl PartLaw {
    /// The place at a share, 0 to 1.
    pub fn at(&self, share: f64) -> EdgePlace {
        match *self {
            Self::Turn { center_mm, radius_mm, normals_rad: [from, to] } => {
                let normal = DVec2::from_angle(from + share * (to - from));
                EdgePlace { point_mm: center_mm + radius_mm * normal, normal }
            }
            Self::Line { start_mm, end_mm } => {
                let normal = -(end_mm - start_mm).normalize_or(DVec2::Y).perp();
                EdgePlace { point_mm: start_mm.lerp(end_mm, share), normal }
            }
        }
    }

    /// Derivatives of point and normal over the share.
    pub fn rates(&self, share: f64) -> [DVec2; 2] {
        match *self {
            Self::Turn { radius_mm, normals_rad: [from, to], .. } => {
                let turned = (to - from) * DVec2::from_angle(from + share * (to - from)).perp();
                [radius_mm * turned, turned]
            }
            Self::Line { start_mm, end_mm } => [end_mm - start_mm, DVec2::ZERO],
        }
    }

    /// The arc or line of a piece of the contour.
    fn of_piece(piece: &ArcPiece) -> Self {
        let (start_mm, end_mm, sweep) = (piece.start_mm, piece.end_mm, piece.sweep_rad());
        if piece.bulge == 0.0 {
            return Self::Line { start_mm, end_mm };
        }
        let radius_mm = 0.5 * start_mm.distance(end_mm) / (0.5 * sweep).sin();
        let from = -piece.directions()[0].perp();
        let from_rad = from.to_angle();
        Self::Turn { center_mm: start_mm - radius_mm * from, radius_mm, normals_rad: [from_rad, from_rad + sweep] }
    }

    /// The parts up to and from shares at which normals pass an angle of the flanks.
    fn divided(self) -> Vec<Self> {
        let Self::Turn { center_mm, radius_mm, normals_rad: [from, to] } = self else { return vec![self] };
        let (low, high) = (from.min(to), from.max(to));
        let mut ends = vec![from, to];
        ends.extend([-FLANK_RAD, FLANK_RAD].into_iter().filter(|&at| at > low + KINK_RAD && at < high - KINK_RAD));
        ends.sort_by(|a, b| if to > from { a.total_cmp(b) } else { b.total_cmp(a) });
        let turn = |pair: &[f64]| Self::Turn { center_mm, radius_mm, normals_rad: [pair[0], pair[1]] };
        ends.windows(2).map(turn).collect()
    }
}

/// Where a tooth lies on its tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContourPlace {
    /// Section of its keys.
    pub section: &'static str,
    /// What carries its pitch.
    pub pitch: TeethOn,
}

/// What carries the pitch of a tooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TeethOn {
    /// The pitch circle of a cutter about the origin.
    Circle {
        /// Teeth on it.
        teeth: u32,
        /// Its radius, mm.
        radius_mm: f64,
    },
    /// The pitch line of a basic rack, through the origin.
    Line {
        /// From tooth to tooth, mm.
        pitch_mm: f64,
    },
}

impl ContourPlace {
    /// Key of the contour's file.
    pub fn file_key(&self) -> String {
        format!("{}.file", self.section)
    }

    /// Distance from the cutter's axis, or out from the pitch line, mm.
    pub fn out_mm(&self, at: DVec2) -> f64 {
        match self.pitch {
            TeethOn::Circle { .. } => at.length(),
            TeethOn::Line { .. } => at.x,
        }
    }
}

/// A drawn tooth.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnTooth {
    /// Where it lies.
    pub place: ContourPlace,
    /// Its parts, from the right root over the tip to the left root.
    pub parts: Vec<DrawnPart>,
    /// Smallest and largest distance from the cutter's axis, or out from the pitch line, mm.
    pub reach_mm: [f64; 2],
    /// How far the edge that cuts passes from the contour at most, mm.
    pub tolerance_mm: f64,
}

impl DrawnTooth {
    /// From a file.
    ///
    /// # Errors
    /// See [`contour::read`]; a tooth without a tip.
    pub fn read(path: &Path, place: ContourPlace, tolerance_mm: f64) -> Result<Self, Refusal> {
        Self::through(&contour::read(path, place)?, place, tolerance_mm).ok_or_else(|| {
            let problem = format!("{}: the tooth has no tip that crosses x = 0", path.display());
            Refusal::new(&place.file_key(), problem, "draw the tip with a land or a round")
        })
    }

    /// Through points, the tooth along x; none where no part crosses the centre line as a tip.
    pub fn through(points_mm: &[DVec2], place: ContourPlace, tolerance_mm: f64) -> Option<Self> {
        let runs = runs::smooth(points_mm, 0.5 * tolerance_mm);
        let pieces = runs.iter().flat_map(|run| biarcs::fit(run, 0.5 * tolerance_mm));
        let laws: Vec<PartLaw> = pieces.flat_map(|piece| PartLaw::of_piece(&piece).divided()).collect();
        let parts = with_corners(&named(&laws)?);
        let out = points_mm.iter().map(|&at| place.out_mm(at));
        let (low, high) = out.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), r| (low.min(r), high.max(r)));
        Some(Self { place, parts, reach_mm: [low, high], tolerance_mm })
    }

    /// Refuses a tip that does not lie where the scene's addendum has it, `addendum_mm` over the pitch circle or line.
    ///
    /// # Errors
    /// The tip is lower or higher by more than [`TIP_OFF_MODULES`].
    pub fn refuse_other_addendum(
        &self,
        (tool, file): (&str, &Path),
        tip_mm: f64,
        shift: f64,
        scene_coefficient: f64,
        module_mm: f64,
    ) -> Result<(), Refusal> {
        let addendum = tip_mm / module_mm - shift;
        if (addendum - scene_coefficient).abs() <= TIP_OFF_MODULES {
            return Ok(());
        }
        let pitch = match self.place.pitch {
            TeethOn::Circle { radius_mm, .. } => format!("circle of {radius_mm:.3} mm"),
            TeethOn::Line { .. } => "line".to_owned(),
        };
        Err(Refusal::new(
            &format!("{tool}.addendum_coefficient"),
            format!(
                "the tip that {} has lies {tip_mm:.4} mm, {addendum:.4} modules over the pitch {pitch}",
                file.display()
            ),
            format!("write addendum_coefficient = {addendum:.3}, or look at the unit of the file and the module"),
        ))
    }

    /// Whether it turns outwards alone between its roots.
    fn is_convex(&self) -> bool {
        let is_root = |part: &&DrawnPart| matches!(part.name, SegmentName::RootRight | SegmentName::RootLeft);
        let parts: Vec<&DrawnPart> = self.parts.iter().filter(|part| !is_root(part)).collect();
        let is_hollow = |part: &&DrawnPart| matches!(part.law, PartLaw::Turn { radius_mm, .. } if radius_mm < 0.0);
        let turns_in = |pair: &[&DrawnPart]| {
            let [end, start] = [pair[0].law.at(1.0), pair[1].law.at(0.0)];
            turn_rad(end.normal, start.normal) < -KINK_RAD
        };
        !parts.iter().any(is_hollow) && !parts.windows(2).any(turns_in)
    }

    /// The edge that cuts.
    ///
    /// # Errors
    /// More segments than a blade may have.
    pub fn edge(&self) -> Result<Edge, Refusal> {
        let sharp = |part: &&DrawnPart| !matches!(part.law, PartLaw::Turn { radius_mm: 0.0, .. });
        let segments: Vec<Segment> =
            self.parts.iter().filter(sharp).flat_map(|part| segments(part, 0.5 * self.tolerance_mm)).collect();
        self.edge_of(segments)
    }

    /// The edge of these segments.
    ///
    /// # Errors
    /// More segments than a blade may have.
    pub fn edge_of(&self, segments: Vec<Segment>) -> Result<Edge, Refusal> {
        if segments.len() <= MOST_SEGMENTS {
            let edge = Edge::new(segments);
            return Ok(if self.is_convex() { edge } else { edge.hollow() });
        }
        let problem = format!(
            "within {} um the edge takes {} arcs, lines and tangents of hollows, more than {MOST_SEGMENTS}",
            1e3 * self.tolerance_mm,
            segments.len()
        );
        Err(Refusal::new(
            &format!("{}.tolerance_um", self.place.section),
            problem,
            "allow more, or smooth what was measured",
        ))
    }
}

/// What a drawn tooth is made of, in words.
pub fn drawn_words(tooth: &DrawnTooth) -> String {
    let count = |is_counted: &dyn Fn(&PartLaw) -> bool| tooth.parts.iter().filter(|part| is_counted(&part.law)).count();
    format!(
        "drawn, within {} um: {} convex arcs, {} hollow ones, {} lines, {} corners",
        1e3 * tooth.tolerance_mm,
        count(&|law| matches!(law, PartLaw::Turn { radius_mm, .. } if *radius_mm > 0.0)),
        count(&|law| matches!(law, PartLaw::Turn { radius_mm, .. } if *radius_mm < 0.0)),
        count(&|law| matches!(law, PartLaw::Line { .. })),
        count(&|law| matches!(law, PartLaw::Turn { radius_mm: 0.0, .. })),
    )
}

/// Arcs and lines with their names; none where no tip crosses the centre line.
fn named(laws: &[PartLaw]) -> Option<Vec<DrawnPart>> {
    let is_side = |law: &PartLaw| law.at(0.5).normal.to_angle().abs() > FLANK_RAD;
    let tip = laws.iter().position(|law| law.at(1.0).point_mm.y > -SAME_MM)?;
    if is_side(&laws[tip]) {
        return None;
    }
    // First and last flank on either side of the tip.
    let ends = |range: std::ops::Range<usize>| {
        let sides = || range.clone().filter(|&i| is_side(&laws[i]));
        (sides().next(), sides().next_back())
    };
    let (right, left) = (ends(0..tip), ends(tip + 1..laws.len()));
    let name = |i: usize| match (right, left) {
        _ if i == tip => SegmentName::Tip,
        ((Some(first), _), _) if i < first => SegmentName::RootRight,
        ((_, Some(last)), _) if i < tip && i <= last => SegmentName::FlankRight,
        _ if i < tip => SegmentName::CornerRight,
        (_, (Some(first), _)) if i < first => SegmentName::CornerLeft,
        (_, (_, Some(last))) if i <= last => SegmentName::FlankLeft,
        _ => SegmentName::RootLeft,
    };
    Some(laws.iter().enumerate().map(|(i, &law)| DrawnPart { name: name(i), law }).collect())
}

/// The same with a corner wherever the normal jumps outwards between two parts. Where it jumps back the tooth is
/// notched: both parts go on to the corner, and none is needed.
fn with_corners(parts: &[DrawnPart]) -> Vec<DrawnPart> {
    let mut all: Vec<DrawnPart> = Vec::new();
    for part in parts {
        if let Some(before) = all.last() {
            let (end, start) = (before.law.at(1.0), part.law.at(0.0));
            let kink_rad = turn_rad(end.normal, start.normal);
            if kink_rad > KINK_RAD {
                let from = end.normal.to_angle();
                let law =
                    PartLaw::Turn { center_mm: start.point_mm, radius_mm: 0.0, normals_rad: [from, from + kink_rad] };
                all.push(DrawnPart { name: between(before.name, part.name), law });
            }
        }
        all.push(*part);
    }
    all
}

/// What a corner between two parts is: one beside the tip belongs to it.
fn between(before: SegmentName, after: SegmentName) -> SegmentName {
    match (before, after) {
        (_, SegmentName::Tip) => SegmentName::CornerRight,
        (SegmentName::Tip, _) => SegmentName::CornerLeft,
        (SegmentName::CornerRight, _) | (_, SegmentName::CornerRight) => SegmentName::CornerRight,
        (SegmentName::CornerLeft, _) | (_, SegmentName::CornerLeft) => SegmentName::CornerLeft,
        (SegmentName::FlankRight, _) | (_, SegmentName::FlankRight) => SegmentName::FlankRight,
        (SegmentName::FlankLeft, _) | (_, SegmentName::FlankLeft) => SegmentName::FlankLeft,
        (other, _) => other,
    }
}

/// Convex segments of a part: of a hollow arc its tangents, which cross within a tolerance of it.
fn segments(part: &DrawnPart, tolerance_mm: f64) -> Vec<Segment> {
    match part.law {
        PartLaw::Line { start_mm, end_mm } => vec![Segment::straight(part.name, start_mm, end_mm)],
        PartLaw::Turn { center_mm, radius_mm, normals_rad } if radius_mm > 0.0 => {
            vec![Segment::arc(part.name, center_mm, radius_mm, normals_rad)]
        }
        PartLaw::Turn { center_mm, radius_mm, normals_rad: [from, to] } => {
            // Neighbouring tangents over the angle a meet r (1 / cos(a / 2) - 1) off the arc.
            let radius = radius_mm.abs();
            let most_rad = 2.0 * (radius / (radius + tolerance_mm)).acos();
            let count = ((to - from).abs() / most_rad).ceil().max(1.0);
            let step = (to - from) / count;
            let vertex = |i: u32| {
                let normal = DVec2::from_angle(from + (f64::from(i) + 0.5) * step);
                center_mm + radius_mm / (0.5 * step).cos() * normal
            };
            let [start, end] = [0.0, 1.0].map(|share| part.law.at(share).point_mm);
            lines(part.name, [start].into_iter().chain((0..count as u32).map(vertex)).chain([end]))
        }
    }
}

/// The lines through points.
pub fn lines(name: SegmentName, points_mm: impl Iterator<Item = DVec2>) -> Vec<Segment> {
    let points_mm: Vec<DVec2> = points_mm.collect();
    points_mm.windows(2).map(|pair| Segment::straight(name, pair[0], pair[1])).collect()
}
