// A part of a tile visits the records that the host has listed for it.

fn search(tile: SpatialTile, best: Lanes, local: u32) -> f32 {
    return 0.0;
}

fn is_clear(i: u32, below_mm: f32) -> bool {
    return false;
}

// Record of a visit.
fn visit(tile: SpatialTile, i: u32) -> u32 {
    return tile.first_record + visits[tile.first_visit + i];
}

fn count_visits(tile: SpatialTile, visited: u32) {}
