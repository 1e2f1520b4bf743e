// One row a thread: on a GPU waves hide latency, and registers decide how many there are.

// Threads of a workgroup: one wave on every GPU, and the host's number.
const WORKGROUP_THREADS: u32 = 64u;

alias Lanes = f32;
alias LaneFlags = bool;
alias LaneCounts = u32;

fn counted(lanes: LaneCounts) -> u32 {
    return lanes;
}
