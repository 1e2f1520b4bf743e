//! The passes of an operation with a turning tool: every blade's sweep in every turn.
//!
//! In: the tool (blades whose rake faces hold its axis: hobs, face-mill heads, fly cutters), the machine's motion over
//! the tool's angle. Out: passes by number, the place of every blade, and the blades' edges in their rake faces.
//!
//! **Axes of a rake face.** r away from the tool's axis, w along it, with or against the tool's z, so that the normal
//! of r and w is that of the blade's x and y. A blade may look any way in that plane: a hob's away from the axis, a
//! face-mill head's along it. Kernels see an edge turned from its blade's axes into r and w; for a blade that looks
//! away from the axis the two are the same, bit for bit.
//!
//! **Window.** The head's x axis points to where the work is. While a blade is further from it than the tool's half
//! window, it is clear of the blank; what a blade meets there is none of its pass.
//!
//! **Numbering.** Pass id = first id + turn x blades + rank, where turns count from the first one that reaches the
//! work, and rank is the blade's place in the order in which the tool's blades pass the head's x axis within a turn;
//! blades of one gash follow each other by their own number. Ids therefore grow with time, gash by gash.
//! [`TurningPasses::blade_of`] leads back from the id to the turn and the blade.
//!
//! The road not taken: rake faces beside the axis (hook angles). A point of the work is then held where its distance
//! along the normal, not its angle, is the face's: another equation for the moment.

use super::motion::MotionTable;
use crate::error::Refusal;
use crate::frame::Rigid3;
use crate::tool::SpatialTool;
use crate::tool::blade_edges::BladeEdges;
use crate::tool::edge::Edge;
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// Largest distance of a rake face from the tool's axis, mm, and largest cosine of its normal to it, that count as
/// rounding: a blade 100 mm out then stands within a tenth of a nanometre of where it is taken to be.
const ROUNDING: f64 = 1e-9;
/// Turns of edges into the rake face that differ by less than this, rad, are one: over an edge of 100 mm a tenth of a
/// picometre. So blades that are placed by sines and cosines share their edges.
const SAME_TURN: f64 = 1e-12;

/// Where a blade sits in the tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BladePlace {
    /// Its number in the tool.
    pub blade: u32,
    /// Its place in the tool's frame.
    pub tool_from_blade: Rigid3,
    /// Angle of its rake face about the tool's axis at the blade's origin, rad.
    pub angle_rad: f64,
    /// Distance of the blade's origin from the tool's axis, along r, mm.
    pub radial_mm: f64,
    /// Place of the blade's origin along the tool's axis, mm.
    pub axial_mm: f64,
    /// +1 if w runs along the tool's z axis, -1 if against it.
    pub y_sign: f64,
    /// Direction of the blade's x axis in (r, w).
    pub looks: DVec2,
    /// Tool angle within a turn, 0 to 2 pi, at which it points along the head's x axis.
    lag_rad: f64,
}

/// One pass: a blade in one turn of the tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BladePass {
    /// Id.
    pub pass: u32,
    /// Index in [`TurningPasses::places`].
    pub rank: u32,
    /// Tool angle at which the blade points along the head's x axis, rad.
    pub tool_angle_rad: f64,
}

/// All passes of an operation.
#[derive(Debug, Clone)]
pub struct TurningPasses {
    /// Id of the first pass.
    pub first_pass: u32,
    /// Blades in the order of their passing.
    pub places: Vec<BladePlace>,
    /// Edges of the blades, turned into (r, w) about the blades' origins.
    pub edges: BladeEdges,
    /// The machine.
    pub motion: MotionTable,
    /// +1: the tool turns counter-clockwise about its z axis as its angle grows; -1: clockwise.
    pub turn: f64,
    /// Turn of the rake faces about the axis per mm of w, rad/mm, counter-clockwise about the tool's z axis.
    pub rake_twist_rad_per_mm: f64,
    /// A blade sweeps through the work only within this angle to either side of the head's x axis, rad
    /// ([`SpatialTool::half_window_rad`]).
    pub half_window_rad: f64,
    first_turn: i64,
    /// Passes of the first turn that come before the first one that counts.
    skipped: u32,
    count: u32,
}

impl BladePlace {
    /// Place of a blade whose edge has its middle at `middle_mm`, blade frame; `turn` as in [`TurningPasses`].
    fn new(blade: u32, tool_from_blade: Rigid3, middle_mm: DVec2, turn: f64) -> Result<Self, Refusal> {
        let (normal, origin_mm) = (tool_from_blade.rotation.z_axis, tool_from_blade.translation_mm);
        let beside_mm = normal.dot(origin_mm).abs();
        if normal.z.abs() > ROUNDING || beside_mm > ROUNDING {
            return Err(Refusal::new(
                "tool",
                format!(
                    "the rake face of blade {blade} leans by {:.3e} rad against the tool's axis and passes it at \
                     {beside_mm:.3e} mm",
                    normal.z.clamp(-1.0, 1.0).asin()
                ),
                "place blades in planes through the tool's axis: without hook and rake angles",
            ));
        }
        // r x (sign z) is the normal; r points to the side of the axis on which the edge is.
        let out = |y_sign: f64| DVec2::new(-y_sign * normal.y, y_sign * normal.x);
        let middle = tool_from_blade.point(middle_mm.extend(0.0)).truncate();
        let y_sign = if out(-1.0).dot(middle) > 0.0 { -1.0 } else { 1.0 };
        let out = out(y_sign);
        let angle_rad = out.y.atan2(out.x);
        // A blade a rounding before the full turn belongs to its beginning.
        let lag_rad = (-turn * angle_rad).rem_euclid(TAU);
        let lag_rad = if lag_rad > TAU - 1e-9 { 0.0 } else { lag_rad };
        let x_axis = tool_from_blade.rotation.x_axis;
        Ok(Self {
            blade,
            tool_from_blade,
            angle_rad,
            radial_mm: out.dot(origin_mm.truncate()),
            axial_mm: origin_mm.z,
            y_sign,
            looks: DVec2::new(out.dot(x_axis.truncate()), y_sign * x_axis.z),
            lag_rad,
        })
    }
}

impl TurningPasses {
    /// Passes whose blades point to the work at tool angles within the motion's range, half a window inside its ends;
    /// of whole turns alone.
    ///
    /// # Errors
    /// A rake face that does not hold the tool's axis, or a window of more than a turn.
    pub fn new(first_pass: u32, tool: &dyn SpatialTool, turn: f64, motion: MotionTable) -> Result<Self, Refusal> {
        let half_window_rad = tool.half_window_rad();
        if half_window_rad.is_nan() || half_window_rad <= 0.0 || half_window_rad > PI {
            return Err(Refusal::new(
                "tool",
                format!("blades are said to be in the work within {half_window_rad} rad to either side of it"),
                "use a half window above 0 and up to pi",
            ));
        }
        let mut places = (0..tool.blade_count())
            .map(|blade| BladePlace::new(blade, tool.tool_from_blade(blade), tool.edge_of(blade).center_mm, turn))
            .collect::<Result<Vec<_>, _>>()?;
        let edges = turned_edges(tool.edges(), &mut places);
        let gash = |place: &BladePlace| (place.lag_rad * 1e9).round() as i64;
        places.sort_by_key(|place| (gash(place), place.blade));
        let [from, to] = motion.range_rad();
        let first_turn = ((from + half_window_rad) / TAU).ceil() as i64;
        let turns = (((to - half_window_rad) / TAU).floor() as i64 - first_turn).max(0) as u32;
        let blades = places.len() as u32;
        Ok(Self {
            first_pass,
            places,
            edges,
            motion,
            turn,
            rake_twist_rad_per_mm: tool.rake_twist_rad_per_mm(),
            half_window_rad,
            first_turn,
            skipped: 0,
            count: turns * blades,
        })
    }

    /// The same with the passes of turns of which the motion has a part only: of a tool that is in the work from the
    /// first moment to the last.
    #[must_use]
    pub fn with_parts_of_turns(mut self) -> Self {
        let ends_rad = self.motion.range_rad();
        let [from, to] =
            [ends_rad[0] + self.half_window_rad, ends_rad[1] - self.half_window_rad].map(|a| self.blades_before(a));
        let blades = self.places.len().max(1) as i64;
        (self.first_turn, self.skipped) = (from.div_euclid(blades), from.rem_euclid(blades) as u32);
        self.count = (to - from).max(0) as u32;
        self
    }

    /// How many blades have passed the head's x axis up to a tool angle, from tool angle 0 on.
    fn blades_before(&self, tool_angle_rad: f64) -> i64 {
        let turn = (tool_angle_rad / TAU).floor();
        let of_turn = self.places.partition_point(|place| TAU * turn + place.lag_rad < tool_angle_rad);
        turn as i64 * self.places.len() as i64 + of_turn as i64
    }

    /// Places in the order of time of the passes whose blades point along the head's x axis between two tool angles.
    pub fn between(&self, from_rad: f64, to_rad: f64) -> Range<u32> {
        let first = self.first_turn * self.places.len() as i64 + i64::from(self.skipped);
        let [from, to] =
            [from_rad, to_rad].map(|angle| (self.blades_before(angle) - first).clamp(0, self.count.into()));
        from as u32..to as u32
    }

    /// The first passes alone, so many of them at most.
    #[must_use]
    pub fn first(&self, count: u32) -> Self {
        Self { count: self.count.min(count), ..self.clone() }
    }

    /// Number of passes.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Id after the last pass.
    pub fn end_pass(&self) -> u32 {
        self.first_pass + self.count()
    }

    /// Pass by its place in the order of time, 0 to [`Self::count`] - 1.
    pub fn pass(&self, index: u32) -> BladePass {
        let (blades, place) = (self.places.len() as u32, self.skipped + index);
        let (turn, rank) = (place / blades, place % blades);
        let tool_angle_rad = TAU * (self.first_turn + i64::from(turn)) as f64 + self.places[rank as usize].lag_rad;
        BladePass { pass: self.first_pass + index, rank, tool_angle_rad }
    }

    /// Pose in the work of the tool, turned as it is when a pass's blade points to the work.
    pub fn work_from_tool(&self, pass: &BladePass) -> Rigid3 {
        let turn = DMat3::from_rotation_z(self.turn * pass.tool_angle_rad);
        self.motion
            .head_from_work(pass.tool_angle_rad)
            .inverse()
            .after(&Rigid3 { rotation: turn, translation_mm: DVec3::ZERO })
    }

    /// Pieces of the motion that a pass's sweep has a part in: more than one where rates jump meanwhile.
    pub fn pieces(&self, pass: &BladePass) -> Range<u32> {
        self.motion.pieces([pass.tool_angle_rad - self.half_window_rad, pass.tool_angle_rad + self.half_window_rad])
    }

    /// Place of a pass's blade.
    pub fn place(&self, pass: &BladePass) -> &BladePlace {
        &self.places[pass.rank as usize]
    }

    /// Edge of a pass's blade, turned into (r, w).
    pub fn edge(&self, pass: &BladePass) -> &Edge {
        self.edges.edge_of(self.place(pass).blade)
    }

    /// Turn of the tool (counted from tool angle 0) and number of the blade behind a pass id of this set.
    pub fn blade_of(&self, pass_id: u32) -> (i64, u32) {
        let index = self.skipped + pass_id - self.first_pass;
        let blades = self.places.len() as u32;
        (self.first_turn + i64::from(index / blades), self.places[(index % blades) as usize].blade)
    }
}

/// The edges of a tool's blades (in the order of `places`) in (r, w), each kept once; blades that look alike but for
/// rounding get the same direction.
fn turned_edges(edges: &BladeEdges, places: &mut [BladePlace]) -> BladeEdges {
    let mut directions = vec![DVec2::X];
    let mut kept: Vec<(usize, DVec2)> = Vec::new();
    let mut pattern = Vec::new();
    for place in places {
        let near = |direction: &&DVec2| direction.distance(place.looks) < SAME_TURN;
        match directions.iter().find(near) {
            Some(&known) => place.looks = known,
            None => directions.push(place.looks),
        }
        let own = (edges.index_of(place.blade), place.looks);
        pattern.push(kept.iter().position(|known| *known == own).unwrap_or_else(|| {
            kept.push(own);
            kept.len() - 1
        }));
    }
    let turned = kept.iter().map(|&(edge, looks)| edges.edges()[edge].turned(looks));
    BladeEdges::new(turned.collect(), pattern)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::CuttingTool;
    use crate::tool::edge::{Segment, SegmentName};

    /// Blades placed one by one.
    struct Placed(Vec<Rigid3>, BladeEdges, f64);

    impl CuttingTool for Placed {
        fn blade_count(&self) -> u32 {
            self.0.len() as u32
        }
        fn edges(&self) -> &BladeEdges {
            &self.1
        }
    }

    impl SpatialTool for Placed {
        fn tool_from_blade(&self, index: u32) -> Rigid3 {
            self.0[index as usize]
        }
        fn half_window_rad(&self) -> f64 {
            self.2
        }
    }

    fn still() -> MotionTable {
        MotionTable::new([-2.0, 20.0], &[], |_| Rigid3 { rotation: DMat3::IDENTITY, translation_mm: DVec3::ZERO })
    }

    /// A blade frame with these axes, out of the tool's axis and along it, at an angle.
    fn frame(angle_rad: f64, x_axis: [f64; 2], y_axis: [f64; 2], [radial_mm, axial_mm]: [f64; 2]) -> Rigid3 {
        let out = DVec3::new(angle_rad.cos(), angle_rad.sin(), 0.0);
        let [x, y] = [x_axis, y_axis].map(|[r, z]| r * out + z * DVec3::Z);
        Rigid3 { rotation: DMat3::from_cols(x, y, x.cross(y)), translation_mm: radial_mm * out + axial_mm * DVec3::Z }
    }

    fn edge() -> Edge {
        let points = [[1.0, -1.5], [4.0, -0.5], [4.0, 1.0], [0.5, 1.5]].map(DVec2::from);
        Edge::new(points.windows(2).map(|p| Segment::straight(SegmentName::Tip, p[0], p[1])).collect())
    }

    /// Whatever way a blade looks, its edge in (r, w) stands where the blade's frame puts it in the tool.
    #[test]
    fn edges_in_the_rake_face_stand_where_the_blades_are() {
        let lean = 0.3_f64;
        let frames = [
            frame(0.7, [1.0, 0.0], [0.0, -1.0], [0.0, 3.0]),
            frame(2.5, [0.0, 1.0], [1.0, 0.0], [95.0, -2.0]),
            frame(-1.2, [0.0, -1.0], [1.0, 0.0], [90.0, 5.0]),
            frame(-2.9, [-lean.sin(), lean.cos()], [lean.cos(), lean.sin()], [50.0, 1.0]),
            frame(0.1, [0.0, -1.0], [-1.0, 0.0], [80.0, 0.0]),
        ];
        let set = TurningPasses::new(0, &Placed(frames.to_vec(), BladeEdges::shared(edge()), 1.0), 1.0, still())
            .expect("planes through the axis");
        for place in &set.places {
            let (own, turned) = (edge(), set.edges.edge_of(place.blade));
            for (segment, in_face) in own.segments.iter().zip(&turned.segments) {
                for y_mm in segment.y_range_mm {
                    let at = DVec2::new(segment.x_and_slope(y_mm)[0], y_mm);
                    let wanted = place.tool_from_blade.point(segment.blade_from_segment.point(at).extend(0.0));
                    let at = in_face.blade_from_segment.point(at);
                    let radius_mm = place.radial_mm + at.x;
                    let got = DVec3::new(
                        radius_mm * place.angle_rad.cos(),
                        radius_mm * place.angle_rad.sin(),
                        place.axial_mm + place.y_sign * at.y,
                    );
                    assert!(radius_mm > 0.0 && got.distance(wanted) < 1e-12, "blade {}", place.blade);
                }
            }
        }
        // Blades that look away from the axis keep their edge bit for bit.
        assert_eq!(set.edges.edge_of(0), &edge());
    }

    /// With parts of turns all blades pass that point to the work between both moments, and no others; ids keep their
    /// order, and lead back to turn and blade.
    #[test]
    fn parts_of_turns_have_every_pass_between_the_ends() {
        let angles = [0.3, 1.9, 3.1, 5.5];
        let frames: Vec<Rigid3> = angles.iter().map(|&a| frame(a, [0.0, 1.0], [1.0, 0.0], [95.0, 0.0])).collect();
        // No end falls on a blade, where rounding would decide.
        for (range, first_pass) in [([-0.75, 18.2], 0), ([1.4, 2.3], 7), ([4.0, 9.5], 100), ([2.0, 4.1], 3)] {
            let motion =
                MotionTable::new(range, &[], |_| Rigid3 { rotation: DMat3::IDENTITY, translation_mm: DVec3::ZERO });
            let tool = Placed(frames.clone(), BladeEdges::shared(edge()), 0.4);
            let whole = TurningPasses::new(first_pass, &tool, 1.0, motion).expect("a head");
            let set = whole.clone().with_parts_of_turns();
            // A blade at the angle a points along x when the tool has turned by -a, and any number of turns.
            let mut wanted: Vec<(f64, u32)> = (-3..6)
                .flat_map(|turn| (0..4_u32).map(move |blade| (TAU * f64::from(turn) - angles[blade as usize], blade)))
                .filter(|&(angle, _)| angle >= range[0] + 0.4 && angle < range[1] - 0.4)
                .collect();
            wanted.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert_eq!(set.count() as usize, wanted.len(), "{range:?}");
            assert!(set.count() >= whole.count());
            for (index, (angle, blade)) in wanted.into_iter().enumerate() {
                let pass = set.pass(index as u32);
                assert!((pass.tool_angle_rad - angle).abs() < 1e-12, "{range:?}, pass {index}");
                assert_eq!(pass.pass, first_pass + index as u32);
                assert_eq!(set.place(&pass).blade, blade);
                let (turn, of) = set.blade_of(pass.pass);
                assert_eq!((turn, of), ((angle / TAU).floor() as i64, blade));
            }
        }
    }

    #[test]
    fn blades_that_look_alike_share_their_edges() {
        let two = BladeEdges::in_turn(vec![edge(), Edge::new(edge().segments[..2].to_vec())]);
        let frames = (0..14).map(|i| frame(f64::from(i) * TAU / 14.0, [0.0, 1.0], [1.0, 0.0], [95.0, 0.0])).collect();
        let set = TurningPasses::new(0, &Placed(frames, two, 0.5), 1.0, still()).expect("a head");
        assert_eq!(set.edges.edges().len(), 2);
        assert!((0..14).all(|blade| set.edges.index_of(blade) == blade as usize % 2));
    }

    #[test]
    fn rake_faces_beside_the_axis_and_impossible_windows_are_refused() {
        let tool = |frame: Rigid3, half_window_rad: f64| {
            TurningPasses::new(0, &Placed(vec![frame], BladeEdges::shared(edge()), half_window_rad), 1.0, still())
        };
        let plain = frame(0.4, [0.0, 1.0], [1.0, 0.0], [95.0, 0.0]);
        assert!(tool(plain, PI).is_ok());
        let mut beside = plain;
        beside.translation_mm += 1e-3 * plain.rotation.z_axis;
        let mut leaning = plain;
        leaning.rotation *= DMat3::from_rotation_x(1e-3);
        for (frame, half_window_rad) in [(beside, 1.0), (leaning, 1.0), (plain, 0.0), (plain, 4.0), (plain, f64::NAN)] {
            assert!(tool(frame, half_window_rad).is_err());
        }
    }
}
