// What the host hands over, member by member the same as src/cut/gpu/records.rs; a test compares both.

// Rows of one launch.
struct Launch {
    // Rows of the field, along the tooth.
    rows: u32,
    // Threads that share the rows of one column.
    threads_per_column: u32,
}

// Columns that visit the same passes.
struct Tile {
    first_column: u32,
    column_count: u32,
    first_record: u32,
    record_count: u32,
}

// One ray of the transverse plane, in the frame of its tile.
struct Column {
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
struct PassRecord {
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
    // Table: x of the base cell. Arc: base point against the centre.
    base_x_mm: f32,
    base_y_mm: f32,
    // Arc: square of the base point's distance from the centre less that of the radius.
    arc_excess_mm2: f32,
    // Table: cells in a millimetre, 0 for an arc.
    cells_per_mm: f32,
    cell_width_mm: f32,
    // First and last cell against the base cell.
    first_cell: f32,
    last_cell: f32,
    // Base cell in the table of all segments.
    base_cell: u32,
    // Id of the pass.
    pass_id: u32,
}
