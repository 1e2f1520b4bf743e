// Dexels of an uncut field: every ray at the blank's surface, left by no pass.
//
// One thread per four rows of a column, one workgroup row (y) per column. Reads launch and the blank's height on every
// column; writes heights and passes.

@group(0) @binding(0) var<uniform> launch: Launch;
@group(0) @binding(1) var<storage, read> blank_mm: array<f32>;
// Rows in fours, as in planar_flank.
@group(0) @binding(2) var<storage, read_write> heights_mm: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> passes: array<vec4<u32>>;

const WORKGROUP_THREADS: u32 = 64u;
// Id of no pass.
const NO_PASS: u32 = 0xffffffffu;

@compute @workgroup_size(WORKGROUP_THREADS)
fn planar_uncut(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= launch.quads {
        return;
    }
    let at = id.y * launch.quads + id.x;
    heights_mm[at] = vec4(blank_mm[id.y]);
    passes[at] = vec4(NO_PASS);
}
