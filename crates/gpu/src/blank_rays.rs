//! Rays of the blank on the device, and what is taken from them: launches of the kernel `blank_rays`.
//!
//! In: lists of what is left on the rays; passes as closed outlines that stand in slices, and which of them visit each
//! tile, in order of time. Out: what is left then, what every pass removed, the longest material that a return stroke
//! met on each tile, the pieces that were taken where they are asked for. Lists go over one after the other, lie slot
//! by slot while they are cut, and come back one after the other (`blank_lists`). They stay on the device for as many
//! cuts as there are: of shaping one ([`super::blank`]), of hobbing one for each chunk of time
//! ([`super::blank_sweeps`]).
//!
//! No list has a fixed capacity: a ray without room stops, and the cut is begun again from lists with room for what it
//! needed.

mod back;
mod passes;
mod spans;

pub use passes::{RayPasses, outline_pieces, unit_mm, units};
pub use spans::{PackedRays, from_record};

use super::adapter::AdapterKind;
use super::blank_records::{BlankLaunch, BlankPiece, BlankSpan, BlankTile, LEDGER_HEAD, RayState};
use super::context::Gpu;
use super::device::Device;
use super::problem::GpuProblem;
use super::stamps::{STAMP_BYTES, Stamps, device_ns};
use back::{Returning, filled, roomy};
use bytemuck::Zeroable;
use gearcut_shaders::{BLANK_RAYS, WORKGROUP_THREADS};
use wgpu::BufferUsages as Use;

/// Iterations of all its loops that a thread may take in one launch. llvmpipe ends every loop after 65,535 of them in
/// all, without a word; a GPU is reset if a launch lasts for seconds, and takes some tens of nanoseconds for each.
fn most_iterations(kind: AdapterKind) -> usize {
    if kind == AdapterKind::Software { 50_000 } else { 4_000_000 }
}
/// Times that a visit goes round the outline at most: its runs twice, and its pieces.
const ROUNDS_PER_VISIT: usize = 3;
/// What a visit may take of these beside: Newton's steps and places in the list for each of eight crossings; so many
/// times the room of a ray's list for its spans.
const ITERATIONS_PER_VISIT: usize = 8 * (12 + 8 + 2);
const LIST_WALKS_PER_VISIT: usize = 4 * 4 + 2;
/// What a cut came back with besides lists.
pub struct RaysCut {
    /// Longest material that a return stroke met on a ray of each tile, mm.
    pub longest_met_mm: Vec<f32>,
    /// What was removed by both families, account by account, in the tiles' units.
    pub removed: Vec<[u64; 2]>,
    /// Pieces that were taken, if asked for, in any order.
    pub pieces: Vec<BlankPiece>,
}

/// How a cut ended.
pub enum CutOutcome {
    /// Whole.
    Done(RaysCut),
    /// A list needs room for so many spans, or so many pieces were taken; 0: there is room.
    NeedsRoom {
        /// Spans of the largest list.
        spans: usize,
        /// Pieces.
        pieces: usize,
    },
}

/// Lists of rays on the device.
pub struct RayLists<'a> {
    gpu: &'a Gpu,
    rays: usize,
    /// Spans that a ray has room for.
    pub capacity: usize,
    spans: wgpu::Buffer,
    states: wgpu::Buffer,
    packed: wgpu::Buffer,
    /// Spans and states before the last cut, if they are kept.
    kept: Option<[wgpu::Buffer; 2]>,
    /// What is yet to be sent.
    commands: Vec<wgpu::CommandBuffer>,
}

/// A cut on its way.
pub struct CutSent {
    returning: Returning,
    pieces: wgpu::Buffer,
    tiles: usize,
    accounts: usize,
    piece_room: usize,
    pieces_sent: usize,
    is_timed: bool,
}

/// Bytes of the lists of so many rays.
pub fn list_bytes(rays: usize, capacity: usize) -> u64 {
    (rays * capacity * size_of::<BlankSpan>()) as u64
}

impl<'a> RayLists<'a> {
    /// Lists with what is left; `keeps` what they were before a cut, so that it can be taken back.
    pub fn new(gpu: &'a Gpu, packed: &PackedRays, capacity: usize, keeps: bool) -> Result<Self, GpuProblem> {
        let device = &gpu.device;
        let rays = packed.rays.len();
        let bytes = list_bytes(rays, capacity) as usize;
        // Room that is not in use holds NaN in tests: whoever reads it shows.
        let poison = vec![0xFF; if gpu.options.poison_outputs { bytes } else { 0 }];
        let both = Use::STORAGE | Use::COPY_SRC;
        let states: &[u8] = bytemuck::cast_slice(&packed.rays);
        let kept = || -> Result<[wgpu::Buffer; 2], GpuProblem> {
            Ok([roomy(device, "spans before", bytes, &[], both)?, filled(device, "rays before", states, both)?])
        };
        let mut lists = Self {
            gpu,
            rays,
            capacity,
            spans: roomy(device, "spans", bytes, &poison, both)?,
            states: filled(device, "rays", states, both)?,
            packed: roomy(device, "packed spans", bytes, bytemuck::cast_slice(&packed.spans), both)?,
            kept: if keeps { Some(kept()?) } else { None },
            commands: Vec::new(),
        };
        // Spreading counts nothing.
        let no_ledger = filled(device, "ledger", &[0; 4 * LEDGER_HEAD], both)?;
        lists.run_lists(false, &no_ledger)?;
        Ok(lists)
    }

    /// What holds for launches over these lists.
    fn launch(&self) -> BlankLaunch {
        BlankLaunch {
            rays: self.rays as u32,
            capacity: self.capacity as u32,
            mm_per_unit: 0.0,
            reach_mm: 0.0,
            piece_room: 0,
            padding_1: 0,
            padding_2: 0,
            padding_3: 0,
        }
    }

    /// Encodes lists on their way: to slots, or back.
    fn run_lists(&mut self, back: bool, ledger: &wgpu::Buffer) -> Result<(), GpuProblem> {
        let device = &self.gpu.device;
        let pipeline = &self.gpu.blank_lists[usize::from(back)];
        let launch = filled(device, "launch", bytemuck::bytes_of(&self.launch()), Use::UNIFORM)?;
        let workgroups = self.rays.div_ceil(WORKGROUP_THREADS as usize) as u32;
        let commands = device.checked(|| {
            let buffers = [&launch, &self.spans, &self.states, &self.packed, ledger];
            let group = bind(device, pipeline, buffers.map(wgpu::Buffer::as_entire_binding));
            let mut encoder = device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(workgroups, 1, 1);
            drop(pass);
            encoder.finish()
        })?;
        self.commands.push(commands);
        Ok(())
    }

    /// Sends passes over tiles of the lists; `expected` pieces come back at once, others with a second wait.
    pub fn send(&mut self, own: &[BlankTile], work: &RayPasses, expected: usize) -> Result<CutSent, GpuProblem> {
        let device = &self.gpu.device;
        // As many visits in a launch as a thread's loops may take.
        let pieces = work.passes.iter().map(|pass| pass.piece_count).max().unwrap_or(0) as usize;
        let of_visit = ROUNDS_PER_VISIT * pieces + ITERATIONS_PER_VISIT + LIST_WALKS_PER_VISIT * self.capacity;
        let window = (most_iterations(device.facts.kind) / of_visit).max(1);
        // Tiles tell a launch its visits: lavapipe prepares the shader anew for every launch whose uniforms are new.
        let tiles = in_windows(own, window);
        let launch = BlankLaunch {
            mm_per_unit: work.mm_per_unit,
            reach_mm: work.reach_mm,
            piece_room: work.piece_room as u32,
            ..self.launch()
        };
        let both = Use::STORAGE | Use::COPY_SRC;
        let ledger_bytes = 4 * (LEDGER_HEAD + own.len() + 4 * work.accounts);
        let piece_bytes = work.piece_room * size_of::<BlankPiece>();
        let poison = vec![0xFF; if self.gpu.options.poison_outputs { piece_bytes } else { 0 }];
        let launch = filled(device, "launch", bytemuck::bytes_of(&launch), Use::UNIFORM)?;
        let tiles = filled(device, "blank tiles", bytemuck::cast_slice(&tiles), Use::STORAGE)?;
        let visits = filled(device, "visits", bytemuck::cast_slice(&work.visits), Use::STORAGE)?;
        let passes = filled(device, "blank passes", bytemuck::cast_slice(&work.passes), Use::STORAGE)?;
        let outline = filled(device, "outline", bytemuck::cast_slice(&work.outline), Use::STORAGE)?;
        let ledger = filled(device, "ledger", &vec![0; ledger_bytes], both)?;
        let pieces = roomy(device, "pieces", piece_bytes, &poison, both)?;
        let stamps = device.facts.timestamps.then(|| Stamps::new(device, 1));
        let pipeline = &self.gpu.blank_rays[0];
        let commands = device.checked(|| {
            let mut encoder = device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            if let Some([spans, states]) = &self.kept {
                encoder.copy_buffer_to_buffer(&self.spans, 0, spans, 0, spans.size());
                encoder.copy_buffer_to_buffer(&self.states, 0, states, 0, states.size());
            }
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(BLANK_RAYS.name),
                timestamp_writes: stamps.as_ref().map(|stamps| stamps.writes(0)),
            });
            pass.set_pipeline(pipeline);
            let window_bytes = window_tiles(own) as u64 * size_of::<BlankTile>() as u64;
            for offset in (0..tiles.size()).step_by(window_bytes as usize) {
                let size = std::num::NonZero::new(window_bytes);
                let tiles = wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: &tiles, offset, size });
                let others = [&launch, &visits, &passes, &outline, &self.spans, &self.states, &ledger, &pieces];
                let [launch, others @ ..] = others.map(wgpu::Buffer::as_entire_binding);
                let [visits, passes, outline, spans, states, ledger, pieces] = others;
                let resources = [launch, tiles, visits, passes, outline, spans, states, ledger, pieces];
                pass.set_bind_group(0, &bind(device, pipeline, resources), &[]);
                pass.dispatch_workgroups(own.len() as u32, 1, 1);
            }
            drop(pass);
            if let Some(stamps) = &stamps {
                stamps.resolve(&mut encoder, 1);
            }
            encoder.finish()
        })?;
        self.commands.push(commands);
        let pieces_sent = expected.min(work.piece_room);
        let mut wanted = vec![(&ledger, ledger_bytes), (&pieces, pieces_sent * size_of::<BlankPiece>())];
        wanted.extend(stamps.as_ref().map(|stamps| (&stamps.resolved, STAMP_BYTES)));
        let returning = self.gpu.send_back(std::mem::take(&mut self.commands), &wanted)?;
        Ok(CutSent {
            returning,
            pieces,
            tiles: own.len(),
            accounts: work.accounts,
            piece_room: work.piece_room,
            pieces_sent,
            is_timed: stamps.is_some(),
        })
    }
    /// Waits for a cut; a ray that crosses one outline more than eight times is a problem.
    pub fn collect(&self, sent: CutSent) -> Result<CutOutcome, GpuProblem> {
        let CutSent { returning, pieces, tiles, accounts, piece_room, pieces_sent, is_timed } = sent;
        let parts = self.gpu.collect_back(returning)?;
        let stamps = if is_timed { parts.last() } else { None };
        self.gpu.log().count(BLANK_RAYS.name, stamps.map(|stamps| device_ns(&self.gpu.device, stamps)));
        let ledger: Vec<u32> = bytemuck::pod_collect_to_vec(&parts[0]);
        let (head, rest) = ledger.split_at(LEDGER_HEAD);
        let [needed, crossings, taken] = [0, 1, 3].map(|k| head[k] as usize);
        if crossings > 0 {
            let reason = format!("a ray crosses one outline {crossings} times; eight are expected at most");
            return Err(GpuProblem::Invalid { reason });
        }
        let pieces_needed = if piece_room > 0 && taken > piece_room { taken } else { 0 };
        if needed > 0 || pieces_needed > 0 {
            return Ok(CutOutcome::NeedsRoom { spans: needed, pieces: pieces_needed });
        }
        let mut listed: Vec<BlankPiece> = bytemuck::pod_collect_to_vec(&parts[1]);
        listed.truncate(taken);
        if taken > pieces_sent {
            let all = self.gpu.send_back(Vec::new(), &[(&pieces, taken * size_of::<BlankPiece>())])?;
            listed = bytemuck::pod_collect_to_vec(&self.gpu.collect_back(all)?[0]);
        }
        let (met, sums) = rest.split_at(tiles);
        let pair = |sums: &[u32]| u64::from(sums[0]) + (u64::from(sums[1]) << 32);
        let removed = sums.chunks_exact(4).take(accounts).map(|of| [pair(&of[..2]), pair(&of[2..])]);
        Ok(CutOutcome::Done(RaysCut {
            longest_met_mm: met.iter().map(|&bits| f32::from_bits(bits)).collect(),
            removed: removed.collect(),
            pieces: listed,
        }))
    }

    /// Takes the last cut back.
    pub fn take_back(&mut self) -> Result<(), GpuProblem> {
        let device = &self.gpu.device;
        let Some([spans, states]) = &self.kept else { return Ok(()) };
        let commands = device.checked(|| {
            let mut encoder = device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            encoder.copy_buffer_to_buffer(spans, 0, &self.spans, 0, spans.size());
            encoder.copy_buffer_to_buffer(states, 0, &self.states, 0, states.size());
            encoder.finish()
        })?;
        self.commands.push(commands);
        Ok(())
    }

    /// All lists, one after the other.
    pub fn all(&mut self) -> Result<PackedRays, GpuProblem> {
        let ledger = filled(&self.gpu.device, "ledger", &[0; 4 * LEDGER_HEAD], Use::STORAGE | Use::COPY_SRC)?;
        self.run_lists(true, &ledger)?;
        let commands = std::mem::take(&mut self.commands);
        let head = self.gpu.collect_back(self.gpu.send_back(commands, &[(&ledger, 4 * LEDGER_HEAD)])?)?;
        let head: Vec<u32> = bytemuck::pod_collect_to_vec(&head[0]);
        let wanted = [
            (&self.states, self.rays * size_of::<RayState>()),
            (&self.packed, head[2] as usize * size_of::<BlankSpan>()),
        ];
        let parts = self.gpu.collect_back(self.gpu.send_back(Vec::new(), &wanted)?)?;
        let [rays, spans] = [&parts[0], &parts[1]];
        Ok(PackedRays { rays: bytemuck::pod_collect_to_vec(rays), spans: bytemuck::pod_collect_to_vec(spans) })
    }
}

/// Tiles of one launch with those that fill up its part of the buffer: parts begin at multiples of 256 bytes.
fn window_tiles(tiles: &[BlankTile]) -> usize {
    tiles.len().max(1).next_multiple_of(256 / size_of::<BlankTile>())
}

/// Tiles launch by launch, each with so many of its visits at most.
fn in_windows(tiles: &[BlankTile], visits: usize) -> Vec<BlankTile> {
    let most_visits = tiles.iter().map(|tile| tile.visit_count).max().unwrap_or(0);
    let windows = (most_visits as usize).div_ceil(visits).max(1);
    let mut windowed = vec![BlankTile::zeroed(); windows * window_tiles(tiles)];
    for (window, part) in windowed.chunks_exact_mut(window_tiles(tiles)).enumerate() {
        for (part, tile) in part.iter_mut().zip(tiles) {
            let before = ((window * visits) as u32).min(tile.visit_count);
            let visit_count = (tile.visit_count - before).min(visits as u32);
            *part = BlankTile { first_visit: tile.first_visit + before, visit_count, ..*tile };
        }
    }
    windowed
}

fn bind<const N: usize>(
    device: &Device,
    pipeline: &wgpu::ComputePipeline,
    resources: [wgpu::BindingResource; N],
) -> wgpu::BindGroup {
    let entry = |(binding, resource)| wgpu::BindGroupEntry { binding, resource };
    let entries: Vec<wgpu::BindGroupEntry> = (0..).zip(resources).map(entry).collect();
    let layout = pipeline.get_bind_group_layout(0);
    device.handle.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries })
}
