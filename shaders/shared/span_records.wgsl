// Spans of the blank, the same as in crates/gpu/src/blank_records.rs; a test compares both.

// Material on a ray; normals as components along and across the rays, out of the material for rays along x; for rays
// along y the host turns them round, which the exchanged axes make up for.
struct BlankSpan {
    low_mm: f32,
    high_mm: f32,
    low_pass: u32,
    high_pass: u32,
    low_normal: vec2<f32>,
    high_normal: vec2<f32>,
}
