// What the host hands over, member by member the same as crates/gpu/src/records.rs; a test compares both.

// Columns that visit the same passes.
struct FlankTile {
    first_column: u32,
    column_count: u32,
    first_record: u32,
    record_count: u32,
    // First quad of rows of its first column.
    first_quad: u32,
    // Quads of rows in a column, the last one filled up.
    quads: u32,
    // Rows of its field, along the tooth.
    rows: u32,
    // Threads that share the rows of one column.
    threads_per_column: u32,
    // First quad of its field's row phases.
    first_phase: u32,
    // Its field among those of the submission.
    field: u32,
}

// One ray of the transverse plane, in the frame of its tile.
struct FlankColumn {
    // Origin against the tile's origin.
    offset_mm: vec2<f32>,
    // Unit direction.
    normal: vec2<f32>,
    // Direction less that of the tile's middle ray, exact where the difference of two f32 would not be.
    normal_change: vec2<f32>,
    // Lowest height that the ray records.
    low_mm: f32,
    padding: f32,
}

// One pass of one segment over one tile. Coefficients belong to tau^0 to tau^3.
struct FlankPass {
    // Rotation from the tile's frame into the segment's.
    cos: vec4<f32>,
    sin: vec4<f32>,
    // Place of the tile's middle ray at height start_mm, against the segment's base point.
    x_mm: vec4<f32>,
    y_mm: vec4<f32>,
    // Height where the iteration starts; the result counts from it.
    start_mm: f32,
    // y that belongs to the segment, against the base point, ends overlapping.
    y_from_mm: f32,
    y_to_mm: f32,
    // Id of the pass.
    pass_id: u32,
    // Table: coefficients of t to t^4, t = y against the base point. Arc: base point against the centre; square of its
    // distance from the centre less that of the radius; nothing.
    curve: vec4<f32>,
    // Table: coefficient of t^5.
    curve_5: f32,
    // 1 for an arc, 0 for a table.
    is_arc: u32,
    padding_1: u32,
    padding_2: u32,
}
