// Four rows a thread: on a software adapter they hide the latency of divisions.

alias Lanes = vec4<f32>;
alias LaneFlags = vec4<bool>;
alias LaneCounts = vec4<u32>;

fn counted(lanes: LaneCounts) -> u32 {
    return lanes.x + lanes.y + lanes.z + lanes.w;
}

// Cells by their distance from a base cell.
fn lane_cells(base: i32, cell: Lanes) -> LaneCells {
    let index = vec4<u32>(vec4<i32>(cell) + vec4<i32>(base));
    let c = transpose(mat4x4<f32>(cells[index.x], cells[index.y], cells[index.z], cells[index.w]));
    return LaneCells(c[0], c[1], c[2], c[3]);
}
