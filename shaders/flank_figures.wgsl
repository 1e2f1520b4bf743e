// Figures of every column of some fields after an operation: extremes with their rows, counts, stock over the last one.
//
// One workgroup per column (x) of a field (y): each thread looks at every 64th row, then halves of the threads join in
// a fixed order, so that sums do not depend on what the device does first. Reads fields, the lowest height that each
// column records, what the operation left and what the last one left; writes figures. Twin:
// crates/core/src/dexel/figures.rs. Adds to the sum of a column's stock what adding up in f32 rounds: below 1e-6 of it.

@group(0) @binding(0) var<storage, read> fields: array<FlankField>;
@group(0) @binding(1) var<storage, read> low_mm: array<f32>;
// Columns follow each other, each filled up to whole fours.
@group(0) @binding(2) var<storage, read> heights_mm: array<f32>;
@group(0) @binding(3) var<storage, read> passes: array<u32>;
@group(0) @binding(4) var<storage, read> last_heights_mm: array<f32>;
@group(0) @binding(5) var<storage, read> last_passes: array<u32>;
@group(0) @binding(6) var<storage, read_write> figures: array<FigureColumn>;

const WORKGROUP_THREADS: u32 = 64u;
// Id of no pass.
const NO_PASS: u32 = 0xffffffffu;
// No height is as far from the target, mm.
const FARTHEST_MM: f32 = 3.0e38;
// Cuts shallower than this below the target are numerical, mm.
const RESOLUTION_MM: f32 = 1e-6;

// A height and its row.
struct RowHeight {
    height_mm: f32,
    row: u32,
}

// Figures of some rows of a column.
struct Figures {
    lowest: RowHeight,
    reached_low: RowHeight,
    reached_high: RowHeight,
    stock_low: RowHeight,
    stock_high: RowHeight,
    stock_sum_mm: f32,
    untouched: u32,
    at_bottom: u32,
}

var<workgroup> parts: array<Figures, WORKGROUP_THREADS>;

fn lower(a: RowHeight, b: RowHeight) -> RowHeight {
    if b.height_mm < a.height_mm || (b.height_mm == a.height_mm && b.row < a.row) {
        return b;
    }
    return a;
}

fn higher(a: RowHeight, b: RowHeight) -> RowHeight {
    if b.height_mm > a.height_mm || (b.height_mm == a.height_mm && b.row < a.row) {
        return b;
    }
    return a;
}

fn joined(a: Figures, b: Figures) -> Figures {
    return Figures(
        lower(a.lowest, b.lowest),
        lower(a.reached_low, b.reached_low),
        higher(a.reached_high, b.reached_high),
        lower(a.stock_low, b.stock_low),
        higher(a.stock_high, b.stock_high),
        a.stock_sum_mm + b.stock_sum_mm,
        a.untouched + b.untouched,
        a.at_bottom + b.at_bottom,
    );
}

@compute @workgroup_size(WORKGROUP_THREADS)
fn flank_figures(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let field = fields[group.y];
    if group.x >= field.column_count {
        return;
    }
    let column = field.first_column + group.x;
    let first = 4u * (field.first_quad + field.quads * group.x);
    let farthest = RowHeight(FARTHEST_MM, field.rows);
    let deepest = RowHeight(-FARTHEST_MM, field.rows);
    var own = Figures(farthest, farthest, deepest, farthest, deepest, 0.0, 0u, 0u);
    for (var row = local; row < field.rows; row += WORKGROUP_THREADS) {
        let height_mm = heights_mm[first + row];
        let pass_id = passes[first + row];
        let here = RowHeight(height_mm, row);
        own.lowest = lower(own.lowest, here);
        if height_mm <= low_mm[column] {
            own.at_bottom += 1u;
        }
        if pass_id == NO_PASS {
            own.untouched += 1u;
            continue;
        }
        own.reached_low = lower(own.reached_low, here);
        own.reached_high = higher(own.reached_high, here);
        // Where the last operation takes nothing because this one has cut below the target, minus that depth.
        let gouged = pass_id == last_passes[first + row] && height_mm < -RESOLUTION_MM;
        let stock_mm = select(height_mm - last_heights_mm[first + row], height_mm, gouged);
        own.stock_low = lower(own.stock_low, RowHeight(stock_mm, row));
        own.stock_high = higher(own.stock_high, RowHeight(stock_mm, row));
        own.stock_sum_mm += stock_mm;
    }
    parts[local] = own;
    for (var half = WORKGROUP_THREADS / 2u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if local < half {
            parts[local] = joined(parts[local], parts[local + half]);
        }
    }
    if local == 0u {
        let all = parts[0];
        figures[column] = FigureColumn(
            all.lowest.height_mm,
            all.lowest.row,
            all.reached_low.height_mm,
            all.reached_low.row,
            all.reached_high.height_mm,
            all.reached_high.row,
            all.untouched,
            all.at_bottom,
            all.stock_low.height_mm,
            all.stock_low.row,
            all.stock_high.height_mm,
            all.stock_high.row,
            all.stock_sum_mm,
            heights_mm[first + field.profile_row],
            passes[first + field.profile_row],
        );
    }
}
