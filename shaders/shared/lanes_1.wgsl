// One row a thread: on a GPU waves hide latency, and registers decide how many there are.

alias Lanes = f32;
alias LaneFlags = bool;
alias LaneCounts = u32;

fn counted(lanes: LaneCounts) -> u32 {
    return lanes;
}

// Cells by their distance from a base cell.
fn lane_cells(base: i32, cell: Lanes) -> LaneCells {
    let c = cells[u32(base + i32(cell))];
    return LaneCells(c.x, c.y, c.z, c.w);
}
