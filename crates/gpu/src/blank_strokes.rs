//! Launches of the kernel `blank_strokes`: tiles of rays and the strokes that visit them, in one submission.
//!
//! In: tiles, poses and outlines, what is left on the rays. Out: what is left then, what every pass removed, the
//! longest material that a return stroke met on each tile. Lists of spans go over one after the other, lie slot by slot
//! while they are cut, and come back one after the other (`blank_lists`). The host waits twice: for how many spans
//! there are, and for the spans.
//!
//! No list has a fixed capacity: a ray without room stops, and the tiles are begun again with room for what it needed.
//! Tiles that do not fit the device together go one half after the other.

use super::adapter::AdapterKind;
use super::blank_rays::{filled, from_record, roomy, to_record};
use super::context::Gpu;
use super::problem::GpuProblem;
use super::records::BlankSpan;
use super::stamps::{STAMP_BYTES, Stamps, device_ns};
use super::stroke_records::{LEDGER_HEAD, OutlinePiece, RayState, StrokeLaunch, StrokePass, StrokeTile};
use gearcut_core::dexel::blank_field::RayMaterial;
use gearcut_core::math::planar_rays::Family;
use gearcut_shaders::{BLANK_STROKES, WORKGROUP_THREADS};
use std::ops::Range;
use wgpu::BufferUsages as Use;

/// Iterations of all its loops that a thread may take in one launch. llvmpipe ends every loop after 65,535 of them in
/// all, without a word; a GPU is reset if a launch lasts for seconds, and takes some tens of nanoseconds for each.
fn most_iterations(kind: AdapterKind) -> usize {
    if kind == AdapterKind::Software { 50_000 } else { 4_000_000 }
}
/// What a visit may take of these beside one for each piece of the outline: Newton's steps and places in the list for
/// each of eight crossings; so many times the room of a ray's list for its spans.
const ITERATIONS_PER_VISIT: usize = 8 * (12 + 8 + 2);
const LIST_WALKS_PER_VISIT: usize = 4 * 4 + 2;
/// Distance of the parts of a uniform buffer that different launches bind: what every device takes.
const UNIFORM_STEP: usize = 256;

/// Tiles with all that visits them.
pub struct StrokeWork {
    /// Tiles.
    pub tiles: Vec<StrokeTile>,
    /// Passes that visit each tile in order of time, tile after tile.
    pub visits: Vec<u32>,
    /// The passes.
    pub passes: Vec<StrokePass>,
    /// Outlines of the teeth.
    pub outline: Vec<OutlinePiece>,
    /// Unit of places, mm.
    pub mm_per_unit: f32,
    /// Edges stay this near to their centres, mm.
    pub reach_mm: f32,
    /// Ids of the operation.
    pub pass_ids: Range<u32>,
    families: Vec<Family>,
    rays: Vec<RayState>,
    spans: Vec<BlankSpan>,
}

/// What the tiles came back with.
pub struct StrokesDone {
    /// What is left, ray by ray.
    pub rays: Vec<RayMaterial>,
    /// What every pass removed by both families, in the tiles' units.
    pub removed: Vec<[u64; 2]>,
    /// Longest material that a return stroke met on a ray of each tile, mm.
    pub longest_met_mm: Vec<f32>,
}

/// How a launch over some tiles ended.
enum StrokesOutcome {
    Done(Vec<Vec<u8>>),
    NeedsSpans(usize),
}

impl StrokeWork {
    /// Work of tiles with what is left on their rays and where these stand; passes are yet to come.
    pub fn new<'a>(
        tiles: Vec<StrokeTile>,
        material: impl Iterator<Item = (Family, &'a [RayMaterial])>,
        places: impl Iterator<Item = i32>,
    ) -> Self {
        let (mut families, mut spans, mut lists) = (Vec::new(), Vec::new(), Vec::new());
        for (family, rays) in material {
            families.push(family);
            for ray in rays {
                lists.push((spans.len() as u32, ray.len() as u32));
                spans.extend(ray.iter().map(|span| to_record(span, family)));
            }
        }
        let rays =
            lists.into_iter().zip(places).map(|((first, count), place)| RayState { place, count, first }).collect();
        Self {
            tiles,
            families,
            rays,
            spans,
            visits: Vec::new(),
            passes: Vec::new(),
            outline: Vec::new(),
            mm_per_unit: 0.0,
            reach_mm: 0.0,
            pass_ids: 0..0,
        }
    }

    fn rays_of(&self, tiles: &Range<usize>) -> Range<usize> {
        let (first, last) = (&self.tiles[tiles.start], &self.tiles[tiles.end - 1]);
        first.first_ray as usize..(last.first_ray + last.ray_count) as usize
    }
}

impl Gpu {
    /// Runs tiles with all their passes; `room` is what a ray has for more spans than it has, and grows where that is
    /// not enough.
    pub(super) fn run_strokes(&self, work: &StrokeWork, room: &mut usize) -> Result<StrokesDone, GpuProblem> {
        let mut done =
            StrokesDone { rays: Vec::new(), removed: vec![[0; 2]; work.pass_ids.len()], longest_met_mm: Vec::new() };
        let limits = self.allowance();
        // Lists in slots, and on their way.
        let limit = limits.buffer_bytes.min(limits.batch_bytes / 2);
        let mut waiting: Vec<Range<usize>> = std::iter::once(0..work.tiles.len()).collect();
        while let Some(tiles) = waiting.pop() {
            let rays = work.rays_of(&tiles);
            let longest = work.rays[rays.clone()].iter().map(|ray| ray.count).max().unwrap_or(0) as usize;
            let capacity = (longest + *room).max(1);
            let bytes = (rays.len() * capacity * size_of::<BlankSpan>()) as u64;
            if bytes > limit && tiles.len() > 1 {
                let middle = tiles.start.midpoint(tiles.end);
                waiting.extend([middle..tiles.end, tiles.start..middle]);
                continue;
            }
            if bytes > limit {
                let reason = format!("lists of {capacity} spans for {} rays need {bytes} of {limit} bytes", rays.len());
                return Err(GpuProblem::OutOfMemory { reason });
            }
            match self.try_strokes(work, tiles.clone(), capacity)? {
                StrokesOutcome::Done(parts) => done.take(work, &tiles, &parts)?,
                StrokesOutcome::NeedsSpans(needed) => {
                    *room = (needed - longest).max(2 * *room);
                    waiting.push(tiles);
                }
            }
        }
        Ok(done)
    }

    fn try_strokes(
        &self,
        work: &StrokeWork,
        tiles: Range<usize>,
        capacity: usize,
    ) -> Result<StrokesOutcome, GpuProblem> {
        let device = &self.device;
        let rays = work.rays_of(&tiles);
        let first_span = work.rays[rays.start].first;
        let states: Vec<RayState> =
            work.rays[rays.clone()].iter().map(|ray| RayState { first: ray.first - first_span, ..*ray }).collect();
        let span_count: u32 = states.iter().map(|ray| ray.count).sum();
        let spans = &work.spans[first_span as usize..][..span_count as usize];
        let own: Vec<StrokeTile> = work.tiles[tiles]
            .iter()
            .map(|tile| StrokeTile { first_ray: tile.first_ray - rays.start as u32, ..*tile })
            .collect();

        // As many visits in a launch as a thread's loops may take.
        let pieces = work.passes.iter().map(|pass| pass.piece_count).max().unwrap_or(0) as usize;
        let of_visit = pieces + ITERATIONS_PER_VISIT + LIST_WALKS_PER_VISIT * capacity;
        let window = (most_iterations(device.facts.kind) / of_visit).max(1);
        let most_visits = own.iter().map(|tile| tile.visit_count).max().unwrap_or(0) as usize;
        let launch = StrokeLaunch {
            rays: rays.len() as u32,
            capacity: capacity as u32,
            first_visit: 0,
            visit_count: window as u32,
            mm_per_unit: work.mm_per_unit,
            reach_mm: work.reach_mm,
            first_pass: work.pass_ids.start,
            padding: 0,
        };
        let windows = most_visits.div_ceil(window).max(1);
        let mut launches = vec![0; windows * UNIFORM_STEP];
        for (index, bytes) in launches.chunks_exact_mut(UNIFORM_STEP).enumerate() {
            let own = StrokeLaunch { first_visit: (index * window) as u32, ..launch };
            bytes[..size_of::<StrokeLaunch>()].copy_from_slice(bytemuck::bytes_of(&own));
        }

        let both = Use::STORAGE | Use::COPY_SRC;
        let ledger_len = LEDGER_HEAD + own.len() + 4 * work.pass_ids.len();
        let list_bytes = rays.len() * capacity * size_of::<BlankSpan>();
        // Room that is not in use holds NaN in tests: whoever reads it shows.
        let poison = vec![0xFF; if self.options.poison_outputs { list_bytes } else { 0 }];
        let launch_buffer = filled(device, "stroke launches", &launches, Use::UNIFORM)?;
        let tiles_buffer = filled(device, "stroke tiles", bytemuck::cast_slice(&own), Use::STORAGE)?;
        let visits_buffer = filled(device, "visits", bytemuck::cast_slice(&work.visits), Use::STORAGE)?;
        let passes_buffer = filled(device, "stroke passes", bytemuck::cast_slice(&work.passes), Use::STORAGE)?;
        let outline_buffer = filled(device, "outline", bytemuck::cast_slice(&work.outline), Use::STORAGE)?;
        let spans_buffer = roomy(device, "spans", list_bytes, &poison, Use::STORAGE)?;
        let packed_buffer = roomy(device, "packed spans", list_bytes, bytemuck::cast_slice(spans), both)?;
        let rays_buffer = filled(device, "rays", bytemuck::cast_slice(&states), both)?;
        let ledger_buffer = filled(device, "ledger", &vec![0; 4 * ledger_len], both)?;
        let lists = [&spans_buffer, &rays_buffer, &packed_buffer, &ledger_buffer];
        let strokes = [
            &tiles_buffer,
            &visits_buffer,
            &passes_buffer,
            &outline_buffer,
            &spans_buffer,
            &rays_buffer,
            &ledger_buffer,
        ];
        let stamps = device.facts.timestamps.then(|| Stamps::new(device, 1));
        device.checked(|| {
            let group = |pipeline: &wgpu::ComputePipeline, window: usize, buffers: &[&wgpu::Buffer]| {
                let uniform = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: &launch_buffer,
                    offset: (window * UNIFORM_STEP) as u64,
                    size: std::num::NonZero::new(size_of::<StrokeLaunch>() as u64),
                });
                let others = buffers.iter().map(|buffer| buffer.as_entire_binding());
                let entries: Vec<wgpu::BindGroupEntry> = (0..)
                    .zip(std::iter::once(uniform).chain(others))
                    .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
                    .collect();
                let layout = pipeline.get_bind_group_layout(0);
                device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: None,
                    layout: &layout,
                    entries: &entries,
                })
            };
            let mut encoder = device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(BLANK_STROKES.name),
                timestamp_writes: stamps.as_ref().map(|stamps| stamps.writes(0)),
            });
            let mut dispatch = |pipeline: &wgpu::ComputePipeline, group: &wgpu::BindGroup, workgroups: usize| {
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, group, &[]);
                pass.dispatch_workgroups(workgroups as u32, 1, 1);
            };
            let of_rays = rays.len().div_ceil(WORKGROUP_THREADS as usize);
            let [spread, collect] = [&self.blank_lists[0], &self.blank_lists[1]];
            dispatch(spread, &group(spread, 0, &lists), of_rays);
            for window in 0..windows {
                let pipeline = &self.blank_strokes[0];
                dispatch(pipeline, &group(pipeline, window, &strokes), own.len());
            }
            dispatch(collect, &group(collect, 0, &lists), of_rays);
            drop(pass);
            if let Some(stamps) = &stamps {
                stamps.resolve(&mut encoder, 1);
            }
            device.queue.submit([encoder.finish()]);
        })?;
        let head: Vec<u32> = self.bring_back(&ledger_buffer, 4 * LEDGER_HEAD)?;
        let (needed, crossings, left) = (head[0] as usize, head[1], head[2] as usize);
        if crossings > 0 {
            let reason = format!("a ray crosses one cutter tooth {crossings} times; eight are expected at most");
            return Err(GpuProblem::Invalid { reason });
        }
        if needed > 0 {
            self.log().count(BLANK_STROKES.name, None);
            return Ok(StrokesOutcome::NeedsSpans(needed));
        }
        let mut wanted = vec![
            (&packed_buffer, left * size_of::<BlankSpan>()),
            (&rays_buffer, size_of_val(states.as_slice())),
            (&ledger_buffer, 4 * ledger_len),
        ];
        wanted.extend(stamps.as_ref().map(|stamps| (&stamps.resolved, STAMP_BYTES)));
        let parts = self.bring_back_all(&wanted)?;
        let device_ns = parts.get(3).map(|stamps| device_ns(device, stamps));
        self.log().count(BLANK_STROKES.name, device_ns);
        Ok(StrokesOutcome::Done(parts))
    }
}

impl StrokesDone {
    /// Adds what some tiles came back with.
    fn take(&mut self, work: &StrokeWork, tiles: &Range<usize>, parts: &[Vec<u8>]) -> Result<(), GpuProblem> {
        let spans: Vec<BlankSpan> = bytemuck::pod_collect_to_vec(&parts[0]);
        let rays: Vec<RayState> = bytemuck::pod_collect_to_vec(&parts[1]);
        let ledger: Vec<u32> = bytemuck::pod_collect_to_vec(&parts[2]);
        let (met, removed) = ledger[LEDGER_HEAD..].split_at(tiles.len());
        self.longest_met_mm.extend(met.iter().map(|&bits| f32::from_bits(bits)));
        for (sum, taken) in self.removed.iter_mut().zip(removed.chunks_exact(4)) {
            *sum = [0, 1].map(|f| sum[f] + u64::from(taken[2 * f]) + (u64::from(taken[2 * f + 1]) << 32));
        }
        let mut rays = rays.iter();
        for tile in tiles.clone() {
            let family = work.families[tile];
            for ray in rays.by_ref().take(work.tiles[tile].ray_count as usize) {
                let list = spans.get(ray.first as usize..).and_then(|rest| rest.get(..ray.count as usize));
                let Some(list) = list else {
                    let reason = format!("a ray of {} spans from {} on, of {}", ray.count, ray.first, spans.len());
                    return Err(GpuProblem::Invalid { reason });
                };
                self.rays.push(list.iter().map(|span| from_record(span, family)).collect());
            }
        }
        Ok(())
    }
}
