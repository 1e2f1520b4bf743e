// One row a thread: on a GPU waves hide latency, and registers decide how many there are.

// Threads of a workgroup: the dexels of a cell of a patch, and the host's number.
const WORKGROUP_THREADS: u32 = 128u;

alias Lanes = f32;
alias LaneFlags = bool;
alias LaneCounts = u32;

fn counted(lanes: LaneCounts) -> u32 {
    return lanes;
}
