// Dexels once more, for the next plan to lower: those before stay as they are.
//
// One thread per four rows of a column, one workgroup row (y) per column. Reads launch, heights and passes; writes
// both.

@group(0) @binding(0) var<uniform> launch: Launch;
// Rows in fours, as in planar_flank.
@group(0) @binding(1) var<storage, read> before_mm: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> before_passes: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read_write> heights_mm: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> passes: array<vec4<u32>>;

const WORKGROUP_THREADS: u32 = 64u;

@compute @workgroup_size(WORKGROUP_THREADS)
fn planar_again(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= launch.quads {
        return;
    }
    let at = id.y * launch.quads + id.x;
    heights_mm[at] = before_mm[at];
    passes[at] = before_passes[at];
}
