// Four rows a thread: on a software adapter they hide the latency of divisions.

// Threads of a workgroup: the rows of one cell, which are the lanes of one vector of 256 bits, and the host's number.
const WORKGROUP_THREADS: u32 = 8u;

alias Lanes = vec4<f32>;
alias LaneFlags = vec4<bool>;
alias LaneCounts = vec4<u32>;

fn counted(lanes: LaneCounts) -> u32 {
    return lanes.x + lanes.y + lanes.z + lanes.w;
}
