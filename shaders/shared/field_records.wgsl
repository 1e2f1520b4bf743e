// What the host hands over of whole fields, member by member the same as crates/gpu/src/records.rs; a test compares
// both.

// A field among those of a submission.
struct FlankField {
    first_column: u32,
    column_count: u32,
    // Its first quad of rows.
    first_quad: u32,
    // Quads of rows in a column, the last one filled up.
    quads: u32,
    // Rows, along the tooth.
    rows: u32,
    // Row whose dexels come back.
    profile_row: u32,
}
