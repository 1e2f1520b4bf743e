//! The planar kernel against the native one on random and on edge inputs, and proof that the comparison can fail.

use crate::fixtures::paper::*;
use crate::fixtures::parity::*;
use gearcut::cut::{Backend, CutJob, cut_in_turn};
use gearcut::dexel::{Column, Field};
use gearcut::gpu::GpuOptions;
use gearcut::gpu::shaders::Rows;
use gearcut::passes::planar::strokes::{NODES, cubic_through};
use gearcut::passes::{CutPlan, PassRecord, Tile};
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::scene::model::{Shaping, Tip};
use gearcut::terms::Side;
use gearcut::tool::edge::{Edge, Segment, SegmentShape};
use glam::DVec2;

/// What the shader may add to a height, nm, as its head says; 0.48 measured.
const ADDED_NM: f64 = 1.0;

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
    let angle = random.within(0.0, 6.3);
    let from_tile = DVec2::from_angle(angle);
    let origin_in_segment = DVec2::new(x, y) - height_mm * normal_in_segment;
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
        segment: index as u32,
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

/// Many tiles that share nothing but the rows.
fn random_field(tiles: u32, edge: &Edge, seed: u64) -> (Field, CutPlan) {
    let mut random = Random(seed);
    let (mut columns, mut records, mut all) = (Vec::new(), Vec::new(), Vec::new());
    for pass in 0..tiles {
        let (rays, record, origin_mm) = random_tile(&mut random, edge, pass);
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

/// Dexels are born on the device, all plans of a field run over them there, and fields share a submission.
#[test]
fn plans_in_turn_leave_the_bytes_of_plans_one_by_one() {
    let operations = vec![operation("rough", NORMAL, 2.0, 360), operation("finish", NORMAL, 0.0, 720)];
    let job = ShapingJob::new(paper_scene(operations)).expect("the paper's gear");
    let mut fields: Vec<Field> = (5..8).map(|tooth| job.flank_field(job.target_flank(tooth, Side::Left))).collect();
    fields.push(job.root_field(2));
    // Rows that fill their quads, and rows that do not.
    for (field, rows) in fields.iter_mut().zip([13, 16, 1, 7]) {
        field.rows_z_mm.truncate(rows);
    }
    let plan = |field: &Field| -> Vec<CutPlan> {
        job.operations.iter().map(|prepared| CutPlan::new(field, &prepared.strokes, &job.cutter)).collect()
    };
    let mut plans: Vec<Vec<CutPlan>> = fields.iter().map(plan).collect();
    let jobs = |plans: &'_ [Vec<CutPlan>]| {
        let gpu = software_gpu(strict());
        let jobs: Vec<CutJob> =
            fields.iter().zip(plans).map(|(field, plans)| CutJob { field, start: None, plans }).collect();
        let together = gpu.cut_jobs(&jobs).expect("cuts");
        (together, gpu.stage_times()[0].batches, cut_in_turn(&gpu, &jobs).expect("cuts"))
    };
    let (together, submissions, apart) = jobs(&plans);
    assert!(together == apart, "layers or counts differ");
    assert_eq!(submissions, 1);
    // From a layer the plans go one by one, and end the same.
    let gpu = software_gpu(strict());
    let rest = CutJob { field: &fields[0], start: Some(&together[0][0].0), plans: &plans[0][1..] };
    assert!(gpu.cut_jobs(&[rest]).expect("cuts")[0][0] == together[0][1]);
    // Alive: a pass less in the first plan of the last field.
    plans[3][0].tiles.iter_mut().for_each(|tile| tile.records.end = tile.records.start);
    assert!(jobs(&plans).0 != together);
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
