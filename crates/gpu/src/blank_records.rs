//! What the host hands to `blank_rays` and `blank_lists`, and what comes back, member by member.
//!
//! Members stand in the order of `shaders/shared/blank_records.wgsl` and `shaders/shared/span_records.wgsl`; a test
//! asks naga for names, offsets and sizes and compares.

use bytemuck::{Pod, Zeroable};

/// Numbers of the ledger before those of tiles: the largest list that had no room, most crossings of one outline that
/// had none, spans of all rays, pieces that were taken.
pub const LEDGER_HEAD: usize = 4;
/// Count of a ray whose list had no room.
pub const NO_ROOM: u32 = u32::MAX;
/// Account of a pass that takes nothing: a return stroke.
pub const NO_ACCOUNT: u32 = u32::MAX;

/// What holds for a launch.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct BlankLaunch {
    /// Rays of the lists: the slots of a list lie this far apart.
    pub rays: u32,
    /// Spans that a ray has room for.
    pub capacity: u32,
    /// Unit of places, a power of two, mm.
    pub mm_per_unit: f32,
    /// Outlines stay this near to their centres, mm.
    pub reach_mm: f32,
    /// Pieces that there is room for; 0 if nobody asks for them.
    pub piece_room: u32,
    /// Nothing.
    pub padding_1: u32,
    /// Nothing.
    pub padding_2: u32,
    /// Nothing.
    pub padding_3: u32,
}

/// Neighbouring rays of one family in one slice.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct BlankTile {
    /// First of the visits of a launch, in order of time.
    pub first_visit: u32,
    /// Number of visits.
    pub visit_count: u32,
    /// First ray of the lists.
    pub first_ray: u32,
    /// Number of rays.
    pub ray_count: u32,
    /// 0: rays along x; 1: rays along y.
    pub family: u32,
    /// Units of the ledger in a millimetre of the tile's rays.
    pub units_per_mm: f32,
    /// Nothing.
    pub padding_1: u32,
    /// Nothing.
    pub padding_2: u32,
}

/// What a pass takes of one slice: a cutter tooth in one stroke, or the section of a sweep.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct BlankPass {
    /// Cosine of the outline's turn.
    pub cos: f32,
    /// Sine of it.
    pub sin: f32,
    /// Its centre, units.
    pub center: [i32; 2],
    /// First piece of it.
    pub first_piece: u32,
    /// Number of pieces.
    pub piece_count: u32,
    /// Id of the pass.
    pub pass_id: u32,
    /// Where what it takes is summed, or [`NO_ACCOUNT`].
    pub account: u32,
}

/// Part of a closed outline: a cubic in a parameter from 0 to 1, from the outline's centre.
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
    /// The run that begins here, if one does: its pieces in the lowest byte, and an f32 without that byte, how far from
    /// the run's chord its pieces may be seen, mm.
    pub run: u32,
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

/// Material on a ray; normals as components along and across the rays, on the side that the host has turned them to.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct BlankSpan {
    /// Lower end, mm.
    pub low_mm: f32,
    /// Upper end, mm.
    pub high_mm: f32,
    /// Pass that left the lower end.
    pub low_pass: u32,
    /// Pass that left the upper end.
    pub high_pass: u32,
    /// Normal at the lower end.
    pub low_normal: [f32; 2],
    /// Normal at the upper end.
    pub high_normal: [f32; 2],
}

/// Material that a pass took from a ray.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct BlankPiece {
    /// The material; ends that the pass left bear its id.
    pub span: BlankSpan,
    /// Ray of the lists.
    pub ray: u32,
    /// Id of the pass.
    pub pass_id: u32,
}
