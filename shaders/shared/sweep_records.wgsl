// What the host hands over for rays in space, member by member the same as crates/gpu/src/sweep_records.rs; a test
// compares both.

// Dexels of a part of a tile, column by column in groups of rows.
struct SpatialTile {
    // Direction of the tile's middle ray, and the lowest height that rays record.
    middle: vec4<f32>,
    first_group: u32,
    group_count: u32,
    first_visit: u32,
    visit_count: u32,
    // First record of the tile; visits count from there.
    first_record: u32,
    // Its field among those of the submission.
    field: u32,
    // Groups of a column.
    rows: u32,
    unused: u32,
}

// One sweep of one segment over one tile. Axes: r from the tool's axis, q in the direction of rotation, y along the
// blade's; r and y count from the segment's base point.
struct SpatialPass {
    // Rows r, q, y of the rotation, three for each of u^0, u^1, u^2; in w the same coefficient of the place of the
    // tile's middle ray at the start height.
    turn: array<vec4<f32>, 9>,
    // Coefficients of u^3 of the place, and the height where the iteration starts.
    place_3: vec4<f32>,
    // Table: coefficients of t to t^4, t = y against the base point. Arc: base point against the centre; square of its
    // distance from the centre less that of the radius; half of 1 / radius.
    curve: vec4<f32>,
    // Distance of the base point from the tool's axis.
    radius_mm: f32,
    // Turn of the rake face per mm of y.
    twist_rad_per_mm: f32,
    // Direction of the segment's x in (r, y).
    cos: f32,
    sin: f32,
    // y that belongs to the piece of the segment, in its frame against the base point, ends overlapping.
    y_from_mm: f32,
    y_to_mm: f32,
    // Table: coefficient of t^5.
    curve_5: f32,
    // 1 for an arc, 0 for a table.
    is_arc: u32,
    // Id of the pass.
    pass_id: u32,
    // Moments at which the sweep is good.
    t_from: f32,
    t_to: f32,
    unused: u32,
}
