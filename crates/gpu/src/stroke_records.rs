//! What the host hands to `blank_strokes` and `blank_lists`, member by member.
//!
//! Members stand in the order of `shaders/shared/stroke_records.wgsl`; a test asks naga for names, offsets and sizes
//! and compares.

use bytemuck::{Pod, Zeroable};

/// Numbers of the ledger before those of tiles: the largest list that had no room, most crossings of one outline that
/// had none, spans of all rays, nothing.
pub const LEDGER_HEAD: usize = 4;
/// Count of a ray whose list had no room.
pub const NO_ROOM: u32 = u32::MAX;

/// What holds for a launch.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct StrokeLaunch {
    /// Rays of the launch: the slots of a list lie this far apart.
    pub rays: u32,
    /// Spans that a ray has room for.
    pub capacity: u32,
    /// First of the visits of every tile that this launch takes.
    pub first_visit: u32,
    /// Number of them.
    pub visit_count: u32,
    /// Unit of places, a power of two, mm.
    pub mm_per_unit: f32,
    /// Edges of teeth stay this near to their centres, mm.
    pub reach_mm: f32,
    /// Id of the operation's first pass.
    pub first_pass: u32,
    /// Nothing.
    pub padding: u32,
}

/// Neighbouring rays of one family in one slice.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct StrokeTile {
    /// First of the visits, in order of time.
    pub first_visit: u32,
    /// Number of visits.
    pub visit_count: u32,
    /// First ray of the launch.
    pub first_ray: u32,
    /// Number of rays.
    pub ray_count: u32,
    /// 0: rays along x; 1: rays along y.
    pub family: u32,
    /// Units of the ledger in a millimetre of this slice.
    pub units_per_mm: f32,
    /// Nothing.
    pub padding_1: u32,
    /// Nothing.
    pub padding_2: u32,
}

/// A cutter tooth in one stroke, where it stands in one slice.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct StrokePass {
    /// Cosine of the blade's turn.
    pub cos: f32,
    /// Sine of it.
    pub sin: f32,
    /// Centre of the edge, units.
    pub center: [i32; 2],
    /// First piece of its outline.
    pub first_piece: u32,
    /// Number of pieces.
    pub piece_count: u32,
    /// Id of the pass.
    pub pass_id: u32,
    /// 1: a return stroke, which takes nothing.
    pub returns: u32,
}

/// Part of a tooth's closed outline: a cubic in a parameter from 0 to 1, from the centre of the edge.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct OutlinePiece {
    /// Where it starts, mm.
    pub node_mm: [f32; 2],
    /// Rate at its start, mm.
    pub rate_start: [f32; 2],
    /// Rate at its end, mm.
    pub rate_end: [f32; 2],
    /// Distance from its chord at most, mm.
    pub sagitta_mm: f32,
    /// Nothing.
    pub padding: u32,
}

/// A ray.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct RayState {
    /// Place across, units.
    pub place: i32,
    /// Spans on it, or [`NO_ROOM`].
    pub count: u32,
    /// Where its spans begin among those of all rays.
    pub first: u32,
}
