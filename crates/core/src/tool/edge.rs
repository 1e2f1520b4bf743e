//! A blade's cutting edge: a chain of named segments, analytic in f64, with the table each backend reads.
//!
//! Segments follow each other counter-clockwise round the blade (up the right flank, over the tip, down the left
//! flank), the tool's body on their left. Every segment has a frame of its own: origin at its middle, **x out of the
//! tool**, y along its chord in the chain's direction. A ray (origin and direction in that frame, p(h) = o + h n)
//! enters the tool where `f(h) = x(h) - U(y(h))` falls through zero, U being the edge's x over y: an [`EdgeTable`] or,
//! for arcs, the circle itself.

use super::edge_profile::{BladeCurve, CurveProfile, InvoluteProfile, StraightProfile};
use super::edge_table::{EdgeTable, TableError};
use super::involute::Involute;
use crate::frame::Rigid2;
use crate::math::convergence::{Step, iterate};
use glam::DVec2;
use std::ops::ControlFlow;

/// What a segment is on the tooth; results tell tip, left and right flank apart by it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SegmentName {
    /// Root circle beside the right flank.
    RootRight,
    /// Straight part between root circle and involute.
    BaseRight,
    /// Right (clockwise) flank.
    FlankRight,
    /// Round, chamfer or protuberance between right flank and tip.
    CornerRight,
    /// Tip circle.
    Tip,
    /// Round, chamfer or protuberance between tip and left flank.
    CornerLeft,
    /// Left (counter-clockwise) flank.
    FlankLeft,
    /// Straight part between involute and root circle.
    BaseLeft,
    /// Root circle beside the left flank.
    RootLeft,
}

/// Last step along a ray to an edge, mm.
const ENTRY_MM: f64 = 1e-12;
/// Newton steps along a ray to an edge at most. On a convex function residual and rate shrink together: each step
/// leaves at most a quarter of their product (from f1 / f0 + f1' / f0' <= 1). Before a step is shorter than
/// [`ENTRY_MM`] at a rate above [`LEAST_FALL`] the product is above 1e-30 mm, so that sixty steps suffice for every ray
/// that starts within 1e6 mm of the edge.
const ENTRY_STEPS: u32 = 60;
/// Steps to the foot of a rough edge's normal: each leaves the product of two slopes of the one before, 0.1 at most of
/// a shift that is below a micrometre.
const FOOT_STEPS: u32 = 4;
/// Panels of Simpson's rule for lengths: flanks bend by a few tenths of a radian, which leaves picometres.
const LENGTH_PANELS: u32 = 256;
/// Fall of the residual along a ray below which the ray runs beside the edge and does not enter it.
const LEAST_FALL: f64 = 1e-9;

/// How a backend evaluates a segment.
#[derive(Debug, Clone, PartialEq)]
pub enum SegmentShape {
    /// Cubic table x = U(y).
    Table(EdgeTable),
    /// Circle through the frame's origin with its centre at (-radius, 0): convex, exact.
    Arc {
        /// Radius in mm.
        radius_mm: f64,
    },
}

/// One segment of an edge.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// What it is.
    pub name: SegmentName,
    /// Its frame in the blade.
    pub blade_from_segment: Rigid2,
    /// Its law.
    pub shape: SegmentShape,
    /// First and last y that belong to the segment.
    pub y_range_mm: [f64; 2],
    /// Radius of a circle round the frame's origin that holds the segment.
    pub reach_mm: f64,
    /// Smallest and largest dx/dy on the segment.
    pub slope_range: [f64; 2],
    /// What it would be without its roughness; `None`: it has none.
    pub smooth: Option<SmoothEdge>,
}

/// What a rough segment is rough about.
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothEdge {
    /// The edge without roughness.
    pub table: EdgeTable,
    /// Smallest and largest dx/dy of it.
    pub slope_range: [f64; 2],
    /// The rough edge stays within this of it along x, mm.
    pub depth_mm: f64,
    /// Largest slope of the roughness against the smooth edge at the nodes of the rough table.
    pub steepness: f64,
}

/// The chain of segments of one blade.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// Segments, counter-clockwise.
    pub segments: Vec<Segment>,
    /// Circle in the blade frame that holds all of them: centre.
    pub center_mm: DVec2,
    /// Circle in the blade frame that holds all of them: radius.
    pub reach_mm: f64,
    /// Whether the tool turns no corner inwards and has no hollow, its root apart: it then lies behind the tangent at
    /// any place of its flanks and its tip.
    pub is_convex: bool,
}

/// Where a ray enters a segment or the continuation of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayHit {
    /// Ray parameter, mm.
    pub height_mm: f64,
    /// y of the hit in the segment's frame; may lie outside its range.
    pub y_mm: f64,
    /// Edge normal at the hit in the segment's frame, out of the tool.
    pub normal: DVec2,
    /// Curvature of the edge at the hit, 1/mm, positive where the tool is convex; 0 on the continuation.
    pub curvature_per_mm: f64,
}

/// Frame on the chord from `start` to `end` (chain direction): origin at its middle, y along it, x out of the tool.
fn chord_frame(start: DVec2, end: DVec2) -> Rigid2 {
    let y_axis = (end - start).normalize_or(DVec2::Y);
    Rigid2 { rotation: -y_axis.perp(), translation_mm: 0.5 * (start + end) }
}

impl Segment {
    /// Part of an involute between two rolls, in the chain's direction.
    ///
    /// # Errors
    /// The finest table misses the edge, or a place of it is not found.
    pub fn involute(name: SegmentName, involute: Involute, rolls: [f64; 2]) -> Result<Self, TableError> {
        // The right flank climbs from root to tip, the left one descends.
        let [from, to] = if involute.side > 0.0 { [rolls[1], rolls[0]] } else { rolls };
        let (start, end) = (involute.point(from), involute.point(to));
        let blade_from_segment = chord_frame(start, end);
        let segment_from_blade = blade_from_segment.inverse();
        let half_mm = 0.5 * start.distance(end);
        let profile = InvoluteProfile::new(involute, segment_from_blade, rolls);
        let table = EdgeTable::fit(&profile, [-half_mm, half_mm])?;
        Ok(Self::from_table(name, blade_from_segment, table, [-half_mm, half_mm]))
    }

    /// Part of a curve between two parameters, in the chain's direction.
    ///
    /// # Errors
    /// The finest table misses the edge, or a place of it is not found.
    pub fn curve(name: SegmentName, curve: &impl BladeCurve, range: [f64; 2]) -> Result<Self, TableError> {
        let [start, end] = range.map(|w| curve.point_and_rate(w)[0]);
        let blade_from_segment = chord_frame(start, end);
        let half_mm = 0.5 * start.distance(end);
        let profile = CurveProfile { curve, segment_from_blade: blade_from_segment.inverse(), range };
        let table = EdgeTable::fit(&profile, [-half_mm, half_mm])?;
        Ok(Self::from_table(name, blade_from_segment, table, [-half_mm, half_mm]))
    }

    /// Straight edge from `start_mm` to `end_mm` in the chain's direction.
    pub fn straight(name: SegmentName, start_mm: DVec2, end_mm: DVec2) -> Self {
        let half_mm = 0.5 * start_mm.distance(end_mm);
        let table = EdgeTable::fit(&StraightProfile, [-half_mm, half_mm]).expect("a straight line needs one cell");
        Self::from_table(name, chord_frame(start_mm, end_mm), table, [-half_mm, half_mm])
    }

    fn from_table(name: SegmentName, blade_from_segment: Rigid2, table: EdgeTable, y_range_mm: [f64; 2]) -> Self {
        let places = (0..=table.cells.len()).map(|i| {
            let y = table.y_start_mm + i as f64 / table.cells_per_mm;
            (y, table.x_and_slope(y))
        });
        let (mut reach, mut low, mut high) = (0.0_f64, f64::INFINITY, f64::NEG_INFINITY);
        for (y, [x, slope]) in places {
            reach = reach.max(x.hypot(y));
            (low, high) = (low.min(slope), high.max(slope));
        }
        // Between the nodes the edge stays within the table's tolerance of a chord: a thousandth is ample.
        let reach_mm = reach * 1.001;
        Self {
            name,
            blade_from_segment,
            shape: SegmentShape::Table(table),
            y_range_mm,
            reach_mm,
            slope_range: [low, high],
            smooth: None,
        }
    }

    /// Convex arc round `center_mm` from polar angle `from_rad` to `to_rad` (counter-clockwise, less than half a turn).
    pub fn arc(name: SegmentName, center_mm: DVec2, radius_mm: f64, [from_rad, to_rad]: [f64; 2]) -> Self {
        let middle = DVec2::from_angle(0.5 * (from_rad + to_rad));
        let half_rad = 0.5 * (to_rad - from_rad);
        let half_mm = radius_mm * half_rad.sin();
        Self {
            name,
            blade_from_segment: Rigid2 { rotation: middle, translation_mm: center_mm + radius_mm * middle },
            shape: SegmentShape::Arc { radius_mm },
            y_range_mm: [-half_mm, half_mm],
            reach_mm: 2.0 * radius_mm * (0.5 * half_rad).sin() * 1.001,
            slope_range: [-half_rad.tan(), half_rad.tan()],
            smooth: None,
        }
    }

    /// x in mm and dx/dy of the edge at `y_mm`, in the segment's frame.
    pub fn x_and_slope(&self, y_mm: f64) -> [f64; 2] {
        match &self.shape {
            SegmentShape::Table(table) => table.x_and_slope(y_mm),
            SegmentShape::Arc { radius_mm } => {
                let rise = (radius_mm * radius_mm - y_mm * y_mm).max(0.0).sqrt();
                [-y_mm * y_mm / (radius_mm + rise), -y_mm / rise.max(f64::MIN_POSITIVE)]
            }
        }
    }

    /// The same segment on the other side of the blade's centre line.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let name = match self.name {
            SegmentName::CornerLeft => SegmentName::CornerRight,
            SegmentName::FlankLeft => SegmentName::FlankRight,
            SegmentName::BaseLeft => SegmentName::BaseRight,
            SegmentName::RootLeft => SegmentName::RootRight,
            other => other,
        };
        let flip = |v: DVec2| DVec2::new(v.x, -v.y);
        let frame = self.blade_from_segment;
        let shape = match &self.shape {
            SegmentShape::Arc { radius_mm } => SegmentShape::Arc { radius_mm: *radius_mm },
            SegmentShape::Table(table) => SegmentShape::Table(table.mirrored()),
        };
        Self {
            name,
            blade_from_segment: Rigid2 { rotation: flip(frame.rotation), translation_mm: flip(frame.translation_mm) },
            shape,
            y_range_mm: [-self.y_range_mm[1], -self.y_range_mm[0]],
            reach_mm: self.reach_mm,
            slope_range: [-self.slope_range[1], -self.slope_range[0]],
            smooth: self.smooth.as_ref().map(|smooth| SmoothEdge {
                table: smooth.table.mirrored(),
                slope_range: [-smooth.slope_range[1], -smooth.slope_range[0]],
                depth_mm: smooth.depth_mm,
                steepness: smooth.steepness,
            }),
        }
    }

    /// The segment without its roughness.
    #[must_use]
    pub fn smoothed(&self) -> Self {
        match &self.smooth {
            None => self.clone(),
            Some(SmoothEdge { table, slope_range, .. }) => Self {
                shape: SegmentShape::Table(table.clone()),
                slope_range: *slope_range,
                smooth: None,
                ..self.clone()
            },
        }
    }

    /// Length along the segment without its roughness, mm.
    pub fn length_mm(&self) -> f64 {
        let smooth = self.smoothed();
        let [from, to] = self.y_range_mm;
        let width = (to - from) / f64::from(LENGTH_PANELS);
        let stretch = |y: f64| smooth.x_and_slope(y)[1].hypot(1.0);
        let simpson = |panel: u32| {
            let y = from + width * f64::from(panel);
            width / 6.0 * (stretch(y) + 4.0 * stretch(y + 0.5 * width) + stretch(y + width))
        };
        (0..LENGTH_PANELS).map(simpson).sum()
    }

    /// How far the segment stays within its smooth course along x, mm.
    pub fn depth_mm(&self) -> f64 {
        self.smooth.as_ref().map_or(0.0, |smooth| smooth.depth_mm)
    }

    /// The same segment, rough: `height(s)` gives how far it stands out along its normal (mm) at an arc length s from
    /// its first end (mm), and the derivative of that. The edge is the cubic through heights and slopes in cells of
    /// about `cell_mm`. An arc stays as it is.
    #[must_use]
    pub fn roughened(&self, cell_mm: f64, height: impl Fn(f64) -> [f64; 2]) -> Self {
        let SegmentShape::Table(smooth) = &self.shape else { return self.clone() };
        let [y_from, y_to] = self.y_range_mm;
        let cells = ((y_to - y_from) / cell_mm).ceil().max(1.0) as usize;
        let (mut arc_mm, mut before) = (0.0, y_from);
        let stretch = |y: f64| smooth.x_and_slope(y)[1].hypot(1.0);
        let mut steepness = 0.0_f64;
        let nodes: Vec<[f64; 2]> = (0..=cells)
            .map(|node| {
                let y = y_from + (y_to - y_from) * node as f64 / cells as f64;
                // Simpson's rule: over a cell of micrometres the edge is nearly straight.
                arc_mm += (y - before) / 6.0 * (stretch(before) + 4.0 * stretch(0.5 * (before + y)) + stretch(y));
                before = y;
                // The place of the smooth edge whose normal comes out at this y: a fixed point, as the normal leans by
                // much less than 1 and heights are small against their wavelengths.
                let (mut foot, mut rise) = (y, 0.0);
                let mut node = [0.0; 2];
                for _ in 0..FOOT_STEPS {
                    let [x, slope] = smooth.x_and_slope(foot);
                    let stretch = slope.hypot(1.0);
                    let [height_mm, climb] = height(arc_mm + (foot - y) * stretch);
                    node = [x + (y - foot) * slope + height_mm * stretch, (slope + climb) / (1.0 - climb * slope)];
                    (foot, rise) = (y + height_mm * slope / stretch, climb);
                }
                steepness = steepness.max(rise.abs());
                node
            })
            .collect();
        let table = EdgeTable::through(&nodes, [y_from, y_to]);
        let depth_mm = table.largest_distance_mm(smooth);
        let slope_range = self.slope_range;
        let smooth = Some(SmoothEdge { table: smooth.clone(), slope_range, depth_mm, steepness });
        Self { smooth, ..Self::from_table(self.name, self.blade_from_segment, table, self.y_range_mm) }
    }

    /// Where the ray `origin + h direction` (segment frame, unit direction) enters the tool through this segment or its
    /// continuation (end tangents of a table, the full circle of an arc). `None`: it never does.
    ///
    /// The residual of a convex segment is convex in h, so Newton's method from a place where it falls runs
    /// monotonically to the entry, however far away it starts: the law of the planar kernels
    /// (`cut/cpu/planar.rs`, `shaders/shared/entry.wgsl`), which start near the entry and look for a place where the
    /// residual falls only when they find it rising. Segments of shaper cutters are convex by construction (an involute
    /// from its one side, a straight line, an arc), rough ones within what their smooth course says. Should it not
    /// arrive (a ray that is not a number), that is no miss: the last place counts as the entry, and who bounds with it
    /// keeps the pass.
    pub fn enter(&self, origin_mm: DVec2, direction: DVec2) -> Option<RayHit> {
        match &self.shape {
            SegmentShape::Arc { radius_mm } => {
                let b = direction.x * (origin_mm.x + radius_mm) + direction.y * origin_mm.y;
                let c = origin_mm.length_squared() + 2.0 * radius_mm * origin_mm.x;
                let discriminant = b * b - c;
                if discriminant <= 0.0 {
                    return None;
                }
                let root = discriminant.sqrt();
                let height_mm = if b < 0.0 { c / (root - b) } else { -b - root };
                let hit = origin_mm + height_mm * direction;
                let normal = (hit + DVec2::new(*radius_mm, 0.0)) / *radius_mm;
                Some(RayHit { height_mm, y_mm: hit.y, normal, curvature_per_mm: 1.0 / radius_mm })
            }
            SegmentShape::Table(table) => self.enter_table(table, origin_mm, direction),
        }
    }

    fn enter_table(&self, table: &EdgeTable, o: DVec2, n: DVec2) -> Option<RayHit> {
        let falls = |slope: f64| n.x - slope * n.y < 0.0;
        if !self.slope_range.iter().any(|&slope| falls(slope)) {
            return None;
        }
        let mut h = if n.x < -0.1 { -o.x / n.x } else { -o.y * n.y };
        let mut first = Some(table.x_and_slope(o.y + h * n.y)).filter(|&[_, slope]| falls(slope));
        if first.is_none() {
            // Start beyond the end where the ray still runs into the tool: the residual is straight out there.
            let end = usize::from(falls(self.slope_range[1]) && !falls(self.slope_range[0]));
            let places = [table.y_start_mm, table.y_end_mm()];
            let y = places.into_iter().find(|&y| falls(table.x_and_slope(y)[1])).unwrap_or(places[end]);
            h = (y - o.y) / n.y;
        }
        let found = iterate("a ray's entry into an edge", h, ENTRY_STEPS, |h| {
            let [x, slope] = first.take().unwrap_or_else(|| table.x_and_slope(o.y + h * n.y));
            let rate = n.x - slope * n.y;
            if rate >= -LEAST_FALL {
                return ControlFlow::Break(None);
            }
            let residual = o.x + h * n.x - x;
            let step = residual / rate;
            let to = h - step;
            if step.abs() < ENTRY_MM {
                ControlFlow::Break(Some(to))
            } else {
                ControlFlow::Continue(Step { to, residual })
            }
        });
        let height_mm = match found {
            Ok(entry) => entry?,
            Err(lost) => lost.last,
        };
        let y_mm = o.y + height_mm * n.y;
        let normal = DVec2::new(1.0, -table.x_and_slope(y_mm)[1]).normalize();
        Some(RayHit { height_mm, y_mm, normal, curvature_per_mm: table.curvature(y_mm) })
    }
}

impl Edge {
    /// Edge of a chain of segments.
    pub fn new(segments: Vec<Segment>) -> Self {
        let corners: Vec<DVec2> = segments.iter().map(|s| s.blade_from_segment.translation_mm).collect();
        let low = corners.iter().copied().reduce(DVec2::min).unwrap_or_default();
        let high = corners.iter().copied().reduce(DVec2::max).unwrap_or_default();
        let center_mm = 0.5 * (low + high);
        let reach_mm = segments
            .iter()
            .map(|s| s.blade_from_segment.translation_mm.distance(center_mm) + s.reach_mm)
            .fold(0.0, f64::max);
        Self { segments, center_mm, reach_mm, is_convex: true }
    }

    /// The same edge, hollow somewhere.
    #[must_use]
    pub fn hollow(self) -> Self {
        Self { is_convex: false, ..self }
    }

    /// Points along the edge from its right end to its left one, chords within about `chord_mm` of it, the ends of all
    /// segments among them; blade frame, mm.
    pub fn points_mm(&self, chord_mm: f64) -> Vec<DVec2> {
        let mut points = Vec::new();
        for segment in &self.segments {
            let [from, to] = segment.y_range_mm;
            let x = |y: f64| match &segment.shape {
                SegmentShape::Table(table) => table.x_and_slope(y)[0],
                SegmentShape::Arc { radius_mm } => (radius_mm * radius_mm - y * y).max(0.0).sqrt() - radius_mm,
            };
            // A chord of 1/n of the segment bulges by 1/n^2 of what the whole segment bulges over its own chord.
            let bulge_mm =
                (1..8).map(|i| (x(from + (to - from) * f64::from(i) / 8.0) - x(from)).abs()).fold(0.0, f64::max);
            let count = (bulge_mm / chord_mm).sqrt().ceil().max(1.0) as u32;
            // A segment begins where the one before it ends, to rounding: that place is one point.
            points.pop();
            points.extend((0..=count).map(|i| {
                let y = from + (to - from) * f64::from(i) / f64::from(count);
                segment.blade_from_segment.point(DVec2::new(x(y), y))
            }));
        }
        points
    }

    /// The same edge in axes in which its own x axis has the direction `x_axis`.
    #[must_use]
    pub fn turned(&self, x_axis: DVec2) -> Self {
        let turn = Rigid2 { rotation: x_axis, translation_mm: DVec2::ZERO };
        let segment = |segment: &Segment| {
            let blade_from_segment = turn.after(&segment.blade_from_segment);
            Segment { blade_from_segment, ..segment.clone() }
        };
        let segments = self.segments.iter().map(segment).collect();
        Self { segments, center_mm: turn.point(self.center_mm), ..*self }
    }
}
