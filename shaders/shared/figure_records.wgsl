// What comes back of figures of columns, member by member the same as crates/gpu/src/records.rs; a test compares both.

// One column after an operation. Rows count from its first one.
struct FigureColumn {
    lowest_mm: f32,
    lowest_row: u32,
    // Of the dexels that a pass has reached.
    reached_low_mm: f32,
    reached_low_row: u32,
    reached_high_mm: f32,
    reached_high_row: u32,
    // Dexels that none has.
    untouched: u32,
    // Dexels as low as their rays record.
    at_bottom: u32,
    // What the operation leaves over the last one.
    stock_low_mm: f32,
    stock_low_row: u32,
    stock_high_mm: f32,
    stock_high_row: u32,
    stock_sum_mm: f32,
    // Dexel of the profile's row.
    profile_mm: f32,
    profile_pass: u32,
}
