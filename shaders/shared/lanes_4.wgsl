// Four rows a thread: on a software adapter they hide the latency of divisions.

alias Lanes = vec4<f32>;
alias LaneFlags = vec4<bool>;
alias LaneCounts = vec4<u32>;

fn counted(lanes: LaneCounts) -> u32 {
    return lanes.x + lanes.y + lanes.z + lanes.w;
}
