// What the host hands over for rays through the blank, member by member the same as
// crates/gpu/src/blank_records.rs; a test compares both. Places across the rays are whole units, so that their
// differences are exact however far from the axis they lie.

// What holds for a launch.
struct BlankLaunch {
    // Rays of the lists: the slots of a list lie this far apart.
    rays: u32,
    // Spans that a ray has room for.
    capacity: u32,
    // Unit of places, a power of two.
    mm_per_unit: f32,
    // Outlines stay this near to their centres.
    reach_mm: f32,
    // Pieces that there is room for; 0 if nobody asks for them.
    piece_room: u32,
    padding_1: u32,
    padding_2: u32,
    padding_3: u32,
}

// Neighbouring rays of one family in one slice.
struct BlankTile {
    // Passes that visit it in a launch, in order of time.
    first_visit: u32,
    visit_count: u32,
    first_ray: u32,
    ray_count: u32,
    // 0: rays along x; 1: rays along y.
    family: u32,
    // Units of the ledger in a millimetre of the tile's rays.
    units_per_mm: f32,
    padding_1: u32,
    padding_2: u32,
}

// What a pass takes of one slice: a cutter tooth in one stroke, or the section of a sweep.
struct BlankPass {
    cos: f32,
    sin: f32,
    // Centre of the outline, units.
    center: vec2<i32>,
    // Its pieces.
    first_piece: u32,
    piece_count: u32,
    pass_id: u32,
    // Where what it takes is summed, or NO_ACCOUNT.
    account: u32,
}

// Part of a closed outline, from its node to the next one's: a cubic in a parameter from 0 to 1, from the outline's
// centre.
struct OutlinePiece {
    node_mm: vec2<f32>,
    rate_start: vec2<f32>,
    rate_end: vec2<f32>,
    // Distance from the chord at most, mm.
    sagitta_mm: f32,
    // The run that begins here, if one does: its pieces in the lowest byte, and an f32 without that byte, how far from
    // the run's chord its pieces may be seen, mm.
    run: u32,
}

// A ray.
struct RayState {
    // Place across, units.
    place: i32,
    // Spans on it, or NO_ROOM.
    count: u32,
    // Where its spans begin among those of all rays, on the way up and down.
    first: u32,
}

// Count of a ray whose list had no room: it is left alone, and the host begins again with more.
const NO_ROOM: u32 = 0xffffffffu;
// Account of a pass that takes nothing: a return stroke.
const NO_ACCOUNT: u32 = 0xffffffffu;

// Material that a pass took from a ray; ends that it left bear its id.
struct BlankPiece {
    span: BlankSpan,
    // Ray of the lists.
    ray: u32,
    pass_id: u32,
}
