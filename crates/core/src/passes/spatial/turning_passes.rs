//! The passes of an operation with a turning tool: every tooth's sweep in every turn.
//!
//! In: the tool (blades whose rake faces hold its axis), the machine's motion over the tool's angle. Out: passes by
//! number.
//!
//! **Numbering.** Pass id = first id + turn x teeth + rank, where turns count from the first one that reaches the work,
//! and rank is the tooth's place in the order in which the tool's teeth pass the head's x axis (towards the work)
//! within a turn; teeth of one gash follow each other by their own number. Ids therefore grow with time, gash by gash.
//! [`TurningPasses::blade_of`] leads back from the id to the turn and the tooth.

use super::motion::MotionTable;
use crate::tool::SpatialTool;
use crate::tool::blade_edges::BladeEdges;
use crate::tool::edge::Edge;
use std::f64::consts::TAU;
use std::ops::Range;

/// Where a blade sits in the tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BladePlace {
    /// Its number in the tool.
    pub blade: u32,
    /// Angle of its rake face about the tool's axis where blade y = 0, rad.
    pub angle_rad: f64,
    /// Place of blade y = 0 along the tool's axis, mm.
    pub axial_mm: f64,
    /// +1 if blade y runs along the tool's z axis, -1 if against it.
    pub y_sign: f64,
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
#[derive(Debug, Clone, PartialEq)]
pub struct TurningPasses {
    /// Id of the first pass.
    pub first_pass: u32,
    /// Blades in the order of their passing.
    pub places: Vec<BladePlace>,
    /// Edges of the blades.
    pub edges: BladeEdges,
    /// The machine.
    pub motion: MotionTable,
    /// +1: the tool turns counter-clockwise about its z axis as its angle grows; -1: clockwise.
    pub turn: f64,
    /// Turn of the rake faces about the axis per mm of blade y, rad/mm, counter-clockwise about the tool's z axis.
    pub rake_twist_rad_per_mm: f64,
    /// A blade sweeps through the work only within this angle to either side of the head's x axis, rad
    /// ([`SpatialTool::half_sweep_rad`]).
    pub half_sweep_rad: f64,
    first_turn: i64,
    turns: u32,
}

impl TurningPasses {
    /// Passes whose blades point to the work at tool angles within the motion's range, half a sweep inside its ends.
    pub fn new(first_pass: u32, tool: &dyn SpatialTool, turn: f64, motion: MotionTable) -> Self {
        let mut places: Vec<BladePlace> = (0..tool.blade_count())
            .map(|blade| {
                let tool_from_blade = tool.tool_from_blade(blade);
                let out = tool_from_blade.rotation.x_axis;
                let angle_rad = out.y.atan2(out.x);
                // A blade a rounding before the full turn belongs to its beginning.
                let lag_rad = (-turn * angle_rad).rem_euclid(TAU);
                let lag_rad = if lag_rad > TAU - 1e-9 { 0.0 } else { lag_rad };
                let y_sign = tool_from_blade.rotation.y_axis.z.signum();
                BladePlace { blade, angle_rad, axial_mm: tool_from_blade.translation_mm.z, y_sign, lag_rad }
            })
            .collect();
        let gash = |place: &BladePlace| (place.lag_rad * 1e9).round() as i64;
        places.sort_by_key(|place| (gash(place), place.blade));
        let [from, to] = motion.range_rad();
        let half_sweep_rad = tool.half_sweep_rad();
        let first_turn = ((from + half_sweep_rad) / TAU).ceil() as i64;
        let turns = (((to - half_sweep_rad) / TAU).floor() as i64 - first_turn).max(0) as u32;
        Self {
            first_pass,
            places,
            edges: tool.edges().clone(),
            motion,
            turn,
            rake_twist_rad_per_mm: tool.rake_twist_rad_per_mm(),
            half_sweep_rad,
            first_turn,
            turns,
        }
    }

    /// Number of passes.
    pub fn count(&self) -> u32 {
        self.turns * self.places.len() as u32
    }

    /// Id after the last pass.
    pub fn end_pass(&self) -> u32 {
        self.first_pass + self.count()
    }

    /// Pass by its place in the order of time, 0 to [`Self::count`] - 1.
    pub fn pass(&self, index: u32) -> BladePass {
        let (turn, rank) = (index / self.places.len() as u32, index % self.places.len() as u32);
        let tool_angle_rad = TAU * (self.first_turn + i64::from(turn)) as f64 + self.places[rank as usize].lag_rad;
        BladePass { pass: self.first_pass + index, rank, tool_angle_rad }
    }

    /// Pieces of the motion that a pass's sweep has a part in: more than one where rates jump meanwhile.
    pub fn pieces(&self, pass: &BladePass) -> Range<u32> {
        self.motion.pieces([pass.tool_angle_rad - self.half_sweep_rad, pass.tool_angle_rad + self.half_sweep_rad])
    }

    /// Place of a pass's blade.
    pub fn place(&self, pass: &BladePass) -> &BladePlace {
        &self.places[pass.rank as usize]
    }

    /// Edge of a pass's blade.
    pub fn edge(&self, pass: &BladePass) -> &Edge {
        self.edges.edge_of(self.place(pass).blade)
    }

    /// Turn of the tool (counted from tool angle 0) and number of the tooth behind a pass id of this set.
    pub fn blade_of(&self, pass_id: u32) -> (i64, u32) {
        let index = pass_id - self.first_pass;
        let teeth = self.places.len() as u32;
        (self.first_turn + i64::from(index / teeth), self.places[(index % teeth) as usize].blade)
    }
}
