// What the host hands over for strokes through the blank, member by member the same as
// crates/gpu/src/stroke_records.rs; a test compares both. Places across the rays are whole units, so that their
// differences are exact however far from the axis they lie.

// What holds for a launch.
struct StrokeLaunch {
    // Rays of the launch: the slots of a list lie this far apart.
    rays: u32,
    // Spans that a ray has room for.
    capacity: u32,
    // Visits of every tile that this launch takes: from here, so many.
    first_visit: u32,
    visit_count: u32,
    // Unit of places, a power of two.
    mm_per_unit: f32,
    // Edges of teeth stay this near to their centres.
    reach_mm: f32,
    // Id of the operation's first pass.
    first_pass: u32,
    padding: u32,
}

// Neighbouring rays of one family in one slice.
struct StrokeTile {
    // Passes that visit it, in order of time.
    first_visit: u32,
    visit_count: u32,
    first_ray: u32,
    ray_count: u32,
    // 0: rays along x; 1: rays along y.
    family: u32,
    // Units of the ledger in a millimetre of this slice.
    units_per_mm: f32,
    padding_1: u32,
    padding_2: u32,
}

// A cutter tooth in one stroke, where it stands in one slice.
struct StrokePass {
    cos: f32,
    sin: f32,
    // Centre of the edge, units.
    center: vec2<i32>,
    // Its outline.
    first_piece: u32,
    piece_count: u32,
    pass_id: u32,
    // 1: a return stroke, which takes nothing.
    returns: u32,
}

// Part of a tooth's closed outline, from its node to the next one's: a cubic in a parameter from 0 to 1. Axes of the
// blade, from the centre of the edge.
struct OutlinePiece {
    node_mm: vec2<f32>,
    rate_start: vec2<f32>,
    rate_end: vec2<f32>,
    // Distance from the chord at most, mm.
    sagitta_mm: f32,
    padding: u32,
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
