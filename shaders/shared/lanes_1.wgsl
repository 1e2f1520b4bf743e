// One row a thread: on a GPU waves hide latency, and registers decide how many there are.

alias Lanes = f32;
alias LaneFlags = bool;
alias LaneCounts = u32;

fn counted(lanes: LaneCounts) -> u32 {
    return lanes;
}
