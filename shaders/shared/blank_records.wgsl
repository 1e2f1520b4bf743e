// What the host hands over for the blank field, member by member the same as crates/gpu/src/records.rs; a test compares
// both.

// What holds for a whole launch.
struct BlankLaunch {
    // Distance of neighbouring rays, mm.
    spacing_mm: f32,
    // Units of the ledger in a millimetre.
    units_per_mm: f32,
    // Spans that a ray has room for.
    capacity: u32,
    // Pieces that there is room for; 0 if nobody asks for them.
    piece_room: u32,
    // Rays of the launch: the slots of a list lie this far apart.
    rays: u32,
}

// Neighbouring rays and their passes in order of time.
struct BlankTile {
    first_pass: u32,
    pass_count: u32,
    first_ray: u32,
    ray_count: u32,
}

// One pass over one tile: the section of a hob tooth's sweep.
struct BlankPass {
    first_part: u32,
    part_count: u32,
    pass_id: u32,
}

// Part of its curve that runs one way across the rays: cubics in a parameter from 0 to 1.
struct BlankPart {
    // Along the rays, mm.
    along: vec4<f32>,
    // Across them, from the tile's first ray, mm.
    across: vec4<f32>,
    // Place across of the end: the same bits as the start of the next part.
    across_end_mm: f32,
    padding_1: f32,
    padding_2: f32,
    padding_3: f32,
}

// Material that a pass took from a ray; ends that it left bear its id.
struct BlankPiece {
    span: BlankSpan,
    // Ray of the launch.
    ray: u32,
    pass_id: u32,
}
