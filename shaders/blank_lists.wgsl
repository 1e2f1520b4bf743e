// Lists of spans on their way: one after the other as the host has them, slot by slot as the kernel does.
//
// One thread per ray. To the device: spreads the spans of its ray over the slots. Back: takes a place among those of
// all rays and puts them there; which ray comes first does not matter, because every ray says where its own begin.

@group(0) @binding(0) var<uniform> launch: BlankLaunch;
@group(0) @binding(1) var<storage, read_write> spans: array<BlankSpan>;
@group(0) @binding(2) var<storage, read_write> rays: array<RayState>;
@group(0) @binding(3) var<storage, read_write> packed: array<BlankSpan>;
// Its third number: spans of all rays.
@group(0) @binding(4) var<storage, read_write> ledger: array<atomic<u32>>;

const WORKGROUP_THREADS: u32 = 64u;
// The way back.
override BACK: bool = false;

@compute @workgroup_size(WORKGROUP_THREADS)
fn blank_lists(@builtin(global_invocation_id) id: vec3<u32>) {
    let ray = id.x;
    if ray >= launch.rays {
        return;
    }
    let count = rays[ray].count;
    if BACK {
        if count == NO_ROOM {
            return;
        }
        let first = atomicAdd(&ledger[2], count);
        rays[ray].first = first;
        for (var k = 0u; k < count; k++) {
            packed[first + k] = spans[k * launch.rays + ray];
        }
    } else {
        let first = rays[ray].first;
        for (var k = 0u; k < count; k++) {
            spans[k * launch.rays + ray] = packed[first + k];
        }
    }
}
