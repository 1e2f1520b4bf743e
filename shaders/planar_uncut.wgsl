// Dexels of uncut fields: every ray at the blank's surface, left by no pass.
//
// One thread per four rows of a column, one workgroup row (y) per field. Reads fields and the blank's height on every
// column; writes heights and passes.

@group(0) @binding(0) var<storage, read> fields: array<FlankField>;
@group(0) @binding(1) var<storage, read> blank_mm: array<f32>;
// Rows in fours, as in planar_flank.
@group(0) @binding(2) var<storage, read_write> heights_mm: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> passes: array<vec4<u32>>;

const WORKGROUP_THREADS: u32 = 64u;
// Id of no pass.
const NO_PASS: u32 = 0xffffffffu;

@compute @workgroup_size(WORKGROUP_THREADS)
fn planar_uncut(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let field = fields[group.y];
    let quad = group.x * WORKGROUP_THREADS + local;
    if quad >= field.column_count * field.quads {
        return;
    }
    let at = field.first_quad + quad;
    heights_mm[at] = vec4(blank_mm[field.first_column + quad / field.quads]);
    passes[at] = vec4(NO_PASS);
}
