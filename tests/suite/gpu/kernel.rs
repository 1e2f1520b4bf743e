//! The planar kernel against the native one on random and on edge inputs, and proof that the comparison can fail.

use crate::fixtures::paper::*;
use crate::fixtures::parity::*;
use gearcut::cut::cpu::Cpu;
use gearcut::cut::{Backend, CutLayers, PlannedField, cut_in_turn};
use gearcut::dexel::figures::{FieldColumns, LinesAt};
use gearcut::dexel::{Column, Field};
use gearcut::gpu::shaders::Rows;
use gearcut::gpu::{GpuOptions, OnGpuFailure};
use gearcut::passes::planar::strokes::{NODES, cubic_through};
use gearcut::passes::{CutPlan, PassRecord, Tile};
use gearcut::process::shaping::scene::model::{Shaping, Tip};
use gearcut::process::shaping::{PreparedOperation, ShapingJob};
use gearcut::terms::Side;
use gearcut::tool::edge::{Edge, Segment, SegmentName, SegmentShape};
use glam::DVec2;
use std::collections::BTreeMap;
use std::sync::Mutex;

/// What the shader may add to a height, nm, as its head says; 0.48 measured.
const ADDED_NM: f64 = 1.0;
/// The same along rays some five degrees off an edge's tangent, which make a dozen nanometres of one across the edge.
const ADDED_WHERE_RAYS_GRAZE_NM: f64 = 12.0;

/// Uniform numbers in [0, 1): splitmix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.next()
    }
}

/// A blade of the paper's cutter, with rounded tips: tables and arcs large and small.
fn edge() -> Edge {
    let mut scene = paper_scene(vec![operation("finish", NORMAL, 0.0, 100)]);
    Shaping::of_mut(&mut scene).expect("shaping").tool.tip = Tip::Round { radius_mm: 0.4 };
    ShapingJob::new(scene).expect("the paper's gear").cutter.edge().clone()
}

/// A tile of rays that look at one segment, and a pass that moves during its stroke.
fn random_tile(random: &mut Random, edge: &Edge, pass: u32) -> (Vec<Column>, PassRecord, DVec2) {
    let index = (random.next() * edge.segments.len() as f64) as usize;
    let segment = &edge.segments[index];
    let [y_from, y_to] = segment.y_range_mm;
    // The middle ray meets the segment a little beyond its ends at most, up to 70 degrees off its normal.
    let y = random.within(y_from - 0.1, y_to + 0.1);
    let (x, slope) = place(segment, y);
    let normal_in_segment = DVec2::from_angle(random.within(-1.2, 1.2)).rotate(DVec2::new(-1.0, slope).normalize());
    let height_mm = random.within(-1.0, 4.0);
    tile_at(random, [pass, index as u32], DVec2::new(x, y), normal_in_segment, height_mm)
}

/// A tile of rays that run some hundredths of a millimetre under the skin of a flank, and enter it some five
/// degrees off its tangent; the search starts beyond the place where they are deepest, as it does where the tile's
/// middle ray passes elsewhere.
fn grazing_tile(random: &mut Random, edge: &Edge, pass: u32) -> (Vec<Column>, PassRecord, DVec2) {
    let flanks: Vec<usize> = (0..edge.segments.len())
        .filter(|&index| matches!(edge.segments[index].name, SegmentName::FlankLeft | SegmentName::FlankRight))
        .collect();
    let index = flanks[(random.next() * flanks.len() as f64) as usize];
    let [y_from, y_to] = edge.segments[index].y_range_mm;
    let y = random.within(0.7 * y_from + 0.3 * y_to, 0.3 * y_from + 0.7 * y_to);
    let (x, slope) = place(&edge.segments[index], y);
    let along = DVec2::new(slope, 1.0).normalize() * if random.next() < 0.5 { 1.0 } else { -1.0 };
    // Neighbouring columns lie up to 15 um beside the middle one.
    let deepest = DVec2::new(x - 0.045, y);
    let (deepest_at_mm, beyond_mm) = (random.within(-0.5, 2.0), random.within(0.01, 0.15));
    let (columns, record, origin_mm) = tile_at(random, [pass, index as u32], deepest, along, deepest_at_mm);
    (columns, PassRecord { start_mm: record.start_mm + beyond_mm, ..record }, origin_mm)
}

/// Rays round one that is at `place_mm` at a height, with its direction, both in the segment's frame.
fn tile_at(
    random: &mut Random,
    [pass, segment]: [u32; 2],
    place_mm: DVec2,
    normal_in_segment: DVec2,
    height_mm: f64,
) -> (Vec<Column>, PassRecord, DVec2) {
    let angle = random.within(0.0, 6.3);
    let from_tile = DVec2::from_angle(angle);
    let origin_in_segment = place_mm - height_mm * normal_in_segment;
    let tile_origin_mm = DVec2::new(random.within(-60.0, 60.0), random.within(-60.0, 60.0));
    let normal = DVec2::new(from_tile.x, -from_tile.y).rotate(normal_in_segment);
    let columns = (0..7)
        .map(|i| {
            let step = f64::from(i) - 3.0;
            let turn = DVec2::from_angle(0.01 * step * random.next());
            Column {
                arc_mm: 0.005 * step,
                origin_mm: tile_origin_mm + 0.005 * step * normal.perp(),
                normal: turn.rotate(normal),
                low_mm: -1.5,
                blank_mm: 4.7,
            }
        })
        .collect();
    // A rigid rotation that goes on during the stroke: arcs rely on unit directions.
    let turn_rad = random.within(-1e-3, 1e-3);
    let turning = NODES.map(|tau| DVec2::from_angle(angle + turn_rad * tau));
    let mut drift = |size: f64| [0.0; 3].map(|_: f64| random.within(-size, size));
    let cubic = |constant: f64, rest: [f64; 3]| [constant, rest[0], rest[1], rest[2]];
    let record = PassRecord {
        pass,
        segment,
        start_mm: height_mm,
        cos: cubic_through(&turning.map(|v| v.x)),
        sin: cubic_through(&turning.map(|v| v.y)),
        x_mm: cubic(origin_in_segment.x, drift(0.02)),
        y_mm: cubic(origin_in_segment.y, drift(0.02)),
    };
    (columns, record, tile_origin_mm)
}

/// x and slope of a segment.
fn place(segment: &Segment, y: f64) -> (f64, f64) {
    match &segment.shape {
        SegmentShape::Table(table) => {
            let [x, slope] = table.x_and_slope(y);
            (x, slope)
        }
        SegmentShape::Arc { radius_mm } => {
            let x = (radius_mm * radius_mm - y * y).max(1e-3).sqrt();
            (x - radius_mm, -y / x)
        }
    }
}

/// What makes a tile's rays and its pass.
type MakeTile = fn(&mut Random, &Edge, u32) -> (Vec<Column>, PassRecord, DVec2);

fn random_field(tiles: u32, edge: &Edge, seed: u64) -> (Field, CutPlan) {
    field_of(random_tile, tiles, edge, seed)
}

/// Many tiles that share nothing but the rows.
fn field_of(tile: MakeTile, tiles: u32, edge: &Edge, seed: u64) -> (Field, CutPlan) {
    let mut random = Random(seed);
    let (mut columns, mut records, mut all) = (Vec::new(), Vec::new(), Vec::new());
    for pass in 0..tiles {
        let (rays, record, origin_mm) = tile(&mut random, edge, pass);
        let first = columns.len();
        columns.extend(rays);
        let first_record = records.len();
        // A second pass that ties with the first everywhere: the lower id must stand.
        records.extend([record, PassRecord { pass: pass + tiles, ..record }]);
        all.push(Tile { columns: first..columns.len(), origin_mm, records: first_record..records.len() });
    }
    let row_phases: Vec<f64> = (0..13).map(|row| f64::from(row) / 6.0 - 1.0).collect();
    let field = Field { columns, rows_z_mm: row_phases.clone() };
    let segments = edge.segments.as_slice().into();
    (field, CutPlan { tiles: all, records, row_phases, segments })
}

#[test]
fn random_rays_are_cut_alike_and_ties_go_to_the_lowest_pass() {
    let edge = edge();
    let (field, plan) = random_field(4000, &edge, 7);
    let blank = field.blank_layer();
    // As on software adapters, and as on GPUs.
    for rows in [Rows::Many, Rows::Few] {
        let gpu = software_gpu(GpuOptions { rows: Some(rows), ..strict() });
        let (parity, layers) = cut_both(&gpu, "random", &field, &plan, [&blank; 4]);
        println!("random, {rows:?} rows a thread: {parity}");
        assert_eq!(parity.verdict_within(ADDED_NM), Ok(()));
        assert!(parity.cut > field.len() / 2, "{} of {} rays met something", parity.cut, field.len());
        let tied = layers[3].passes.iter().filter(|&&pass| pass != u32::MAX && pass >= 4000).count();
        assert_eq!(tied, 0, "ties went to the higher pass");
    }
}

/// Newton's method that starts beyond the deepest place of a ray runs out of the tool again: both backends go back and
/// find the entry.
#[test]
fn rays_that_graze_are_cut_alike_wherever_the_search_starts() {
    let edge = edge();
    let (field, plan) = field_of(grazing_tile, 700, &edge, 11);
    let blank = field.blank_layer();
    for rows in [Rows::Many, Rows::Few] {
        let gpu = software_gpu(GpuOptions { rows: Some(rows), ..strict() });
        let (parity, _) = cut_both(&gpu, "grazing", &field, &plan, [&blank; 4]);
        println!("grazing, {rows:?} rows a thread: {parity}");
        assert_eq!(parity.verdict_within(ADDED_WHERE_RAYS_GRAZE_NM), Ok(()));
        assert!(parity.cut > field.len() / 3, "{} of {} rays met something", parity.cut, field.len());
    }
}

#[test]
fn edge_inputs_are_cut_alike() {
    let edge = edge();
    let [gpu, few] = [Rows::Many, Rows::Few].map(|rows| software_gpu(GpuOptions { rows: Some(rows), ..strict() }));
    for rows in [1, 2, 3, 4, 5, 63, 64, 65, 257] {
        for columns in [1, 2, 15, 16, 17] {
            let (mut field, mut plan) = random_field(6, &edge, rows * 100 + columns);
            plan.row_phases = (0..rows).map(|row| row as f64 / rows as f64 * 2.0 - 1.0).collect();
            field.rows_z_mm.clone_from(&plan.row_phases);
            // Tiles of another width, and one that no pass visits.
            let width = columns as usize;
            let own = field.columns.chunks_exact(7).flat_map(|rays| rays.iter().cycle().take(width));
            field.columns = own.copied().collect();
            for (index, tile) in plan.tiles.iter_mut().enumerate() {
                tile.columns = index * width..(index + 1) * width;
            }
            plan.tiles[2].records = 0..0;
            let blank = field.blank_layer();
            let place = format!("{rows} rows, {columns} columns");
            for gpu in [&gpu, &few] {
                let (parity, _) = cut_both(gpu, &place, &field, &plan, [&blank; 4]);
                let verdict = parity.verdict_within(ADDED_NM);
                assert!(verdict.is_ok() || parity.cut == 0, "{verdict:?}");
            }
        }
    }
    let (mut field, mut plan) = random_field(1, &edge, 1);
    (field.columns, plan.tiles) = (Vec::new(), Vec::new());
    let mut nothing = field.blank_layer();
    let stats = gpu.cut(&field, &plan, &mut nothing).expect("nothing to do");
    assert_eq!(stats.dexel_passes, 0);
}

#[test]
fn small_batches_give_the_same_bytes() {
    let job = ShapingJob::new(paper_scene(vec![operation("finish", NORMAL, 0.0, 720)])).expect("the paper's gear");
    let mut field = job.flank_field(job.target_flank(5, Side::Left));
    field.rows_z_mm.truncate(200);
    let plan = CutPlan::brute_force(&field, &job.finishing().strokes, &job.cutter);
    let cut = |memory_limit_bytes: Option<u64>| {
        let gpu = software_gpu(GpuOptions { memory_limit_bytes, ..strict() });
        let mut layer = field.blank_layer();
        gpu.cut(&field, &plan, &mut layer).expect("fits");
        (layer, gpu.stage_times())
    };
    let (whole, one) = cut(None);
    // A few columns and one round of records at a time.
    let (parts, many) = cut(Some(260_000));
    println!("{} batches against {}", many[0].batches, one[0].batches);
    assert!(many[0].batches > 50 * one[0].batches);
    assert!(whole == parts, "batches change the result");
}

/// Fields through both plans of a job, by so many rows each: those that fill their quads, and those that do not.
fn planned_fields(job: &ShapingJob, rows: [usize; 4], lines: Option<LinesAt>) -> Vec<PlannedField> {
    let flank = |tooth| job.flank_field(job.target_flank(tooth, Side::Left));
    let fields = (5..8).map(flank).chain([job.root_field(2)]);
    let planned = |(mut field, rows): (Field, usize)| {
        field.rows_z_mm.truncate(rows);
        let plan = |prepared: &PreparedOperation| CutPlan::new(&field, &prepared.strokes, &job.cutter);
        let plans = job.operations.iter().map(plan).collect();
        PlannedField { field, plans, lines }
    };
    fields.zip(rows).map(planned).collect()
}

/// What is left of fields that go to a backend together.
fn cut_together(backend: &dyn Backend, fields: &[PlannedField]) -> Vec<CutLayers> {
    let done = Mutex::new(BTreeMap::new());
    let take = |index: usize, _: PlannedField, left: CutLayers| {
        assert!(done.lock().expect("no panic").insert(index, left).is_none(), "field {index} comes twice");
        Ok(())
    };
    backend.cut_fields(fields.len(), &|index| Ok(Some(fields[index].clone())), &take).expect("cuts");
    let done = done.into_inner().expect("no panic");
    assert_eq!(done.len(), fields.len());
    done.into_values().collect()
}

fn two_cuts() -> ShapingJob {
    let operations = vec![operation("rough", NORMAL, 2.0, 360), operation("finish", NORMAL, 0.0, 720)];
    ShapingJob::new(paper_scene(operations)).expect("the paper's gear")
}

/// Dexels are born on the device, all plans of a field run over them there, and fields share a submission.
#[test]
fn plans_in_turn_leave_the_bytes_of_plans_one_by_one() {
    let gpu = software_gpu(strict());
    let mut fields = planned_fields(&two_cuts(), [13, 16, 1, 7], None);
    let together = cut_together(&gpu, &fields);
    assert_eq!(gpu.stage_times()[0].batches, 1);
    let apart: Vec<CutLayers> =
        fields.iter().map(|planned| cut_in_turn(&gpu, planned, |_, _| ()).expect("cuts")).collect();
    assert!(together == apart, "layers or counts differ");
    // More fields than go together: three submissions, two of them on their way at once.
    let many: Vec<PlannedField> = fields.iter().cycle().take(40).cloned().collect();
    let before = gpu.stage_times()[0].batches;
    assert!(cut_together(&gpu, &many).iter().zip(together.iter().cycle()).all(|(left, of)| left == of));
    assert_eq!(gpu.stage_times()[0].batches, before + 3);
    // Alive: a pass less in the first plan of the last field.
    fields[3].plans[0].tiles.iter_mut().for_each(|tile| tile.records.end = tile.records.start);
    assert!(cut_together(&gpu, &fields) != together);
}

/// Where lines alone are wanted, the figures of the columns are made on the device: to the last bit those of the dexels
/// that it brings back otherwise, and for the sums, which it adds up in f32, to a millionth.
#[test]
fn figures_made_on_the_device_are_those_of_its_dexels() {
    let job = two_cuts();
    let lines = LinesAt { row: 6, column: 40 };
    // More rows than threads, and a field whose dexels are fewer bytes than figures.
    let rows = [13, 200, 4, 31];
    let dexels = planned_fields(&job, rows, None);
    let mut fields = planned_fields(&job, rows, Some(lines));
    // Columns of which nothing is reached, and some of whose dexels are.
    for plan in fields.iter_mut().flat_map(|planned| &mut planned.plans) {
        plan.tiles[1].records.end = plan.tiles[1].records.start;
    }
    let dexels: Vec<PlannedField> =
        dexels.into_iter().zip(&fields).map(|(of, cut)| PlannedField { plans: cut.plans.clone(), ..of }).collect();
    let gpu = software_gpu(strict());
    let [left, figures] = [&dexels, &fields].map(|fields| cut_together(&gpu, fields));
    let native = cut_together(&Cpu::default(), &fields);
    assert!(cut_together(&gpu, &fields) == figures, "other figures the second time");
    assert!(figures[2].figures.is_none() && figures[2] == left[2]);
    let mut untouched = 0;
    for index in [0, 1, 3] {
        let (field, made) = (&fields[index].field, figures[index].figures.as_ref().expect("figures"));
        assert!(figures[index].layers.is_empty() && figures[index].stats == left[index].stats);
        let made = FieldColumns::Figures(made);
        let [own, native] = [&left, &native].map(|of| FieldColumns::Dexels { field, layers: &of[index].layers, lines });
        assert!(made.profile() == own.profile() && made.along() == own.along(), "field {index}: lines");
        for column in 0..field.columns.len() {
            for operation in 0..2 {
                let [made, own, native] = [made, own, native].map(|columns| columns.heights(operation, column));
                assert_eq!(made, own, "{index}, {column}");
                let off_mm = f64::from(made.lowest.height_mm - native.lowest.height_mm).abs();
                assert!(off_mm < 1e-6 * ADDED_NM, "{index}, {column}: {made:?} for {native:?}");
            }
            let [made, own, native] = [made, own, native].map(|columns| columns.stock(0, column, 0.0));
            assert_eq!((made.range, made.untouched), (own.range, own.untouched), "{index}, {column}");
            let off_mm = (made.sum_mm - native.sum_mm).abs();
            assert!(off_mm < 1e-6 * ADDED_NM * rows[index] as f64, "{index}, {column}: {made:?} for {native:?}");
            assert!((made.sum_mm - own.sum_mm).abs() <= 1e-6 * own.sum_mm.abs(), "{made:?} for {own:?}");
            untouched += own.untouched;
        }
    }
    assert!(untouched > 0, "no column was left alone");
    // Planted: passes of finishing 50 nm off.
    fields[1].plans[1].records.iter_mut().for_each(|record| record.x_mm[0] += 5e-5);
    assert!(cut_together(&gpu, &fields)[1] != figures[1]);
}

/// Figures of a device that is lost are the native ones, and no field is lost with it.
#[test]
fn fields_after_the_loss_are_cut_natively() {
    let gpu = software_gpu(GpuOptions { on_failure: OnGpuFailure::RedoNatively, ..strict() });
    gpu.lose_device();
    let fields = planned_fields(&two_cuts(), [13, 16, 1, 7], Some(LinesAt::default()));
    assert!(cut_together(&gpu, &fields) == cut_together(&Cpu::default(), &fields));
    assert_eq!(gpu.incidents().len(), 1, "{:?}", gpu.incidents());
}

#[test]
fn a_planted_difference_is_noticed() {
    let gpu = software_gpu(strict());
    let edge = edge();
    let (field, plan) = random_field(100, &edge, 3);
    let blank = field.blank_layer();
    let (honest, layers) = cut_both(&gpu, "honest", &field, &plan, [&blank; 4]);
    assert_eq!(honest.verdict_within(ADDED_NM), Ok(()));
    let compare = |plant: &dyn Fn(&mut gearcut::dexel::Layer)| {
        let mut planted = layers[3].clone();
        plant(&mut planted);
        let mut parity = Parity::default();
        parity.add("planted", field.rows(), &layers[0], &[layers[1].clone(), layers[2].clone()], &planted);
        parity.verdict_within(ADDED_NM)
    };
    let at = layers[0].passes.iter().position(|&pass| pass != u32::MAX).expect("a cut dexel");
    assert!(compare(&|layer| layer.heights_mm[at] += 2e-5).is_err(), "20 nm on one dexel");
    assert!(compare(&|layer| layer.heights_mm[at] = f32::from_bits(u32::MAX)).is_err(), "the poison itself");
    assert!(compare(&|layer| *layer = blank.clone()).is_err(), "no pass at all");
    // A pass a nanometre-scale lift away in its own frame shows through the whole path.
    let mut lifted = plan.clone();
    for record in &mut lifted.records {
        record.x_mm[0] += 5e-5;
    }
    let mut layer = field.blank_layer();
    gpu.cut(&field, &lifted, &mut layer).expect("cuts");
    assert!(compare(&|planted| planted.clone_from(&layer)).is_err(), "passes 50 nm off");
}
