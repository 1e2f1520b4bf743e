//! The blank field on the GPU: rays in f32, lists that grow.
//!
//! In: a [`BlankField`], an operation, as [`crate::cut::cpu::blank`]. Out: the field after it and what every pass removed. The host places every tooth in f64, splits its
//! outline where it turns back across the rays, and hands over each part as a pair of cubics; the shader finds roots and keeps the lists. Along the rays coordinates reach the blank's radius, where an f32
//! resolves 8 nm at 70 mm; across them they start at the tile.
//!
//! No list has a fixed capacity: a ray without room stops, and the tiles in work are begun again with room for what it needed.
//!
//! Return strokes go through the shader in their turn: they take nothing and add up the material that they meet. Where and how deep a stroke rubs is worked out natively, on the few tiles that met any.

use super::device::Device;
use super::pipeline::BLANK_RAYS;
use super::problem::GpuProblem;
use super::records::{BlankLaunch, BlankPart, BlankPass, BlankSpan, BlankTile};
use super::{Gpu, WORKGROUP_THREADS};
use crate::cut::cpu::blank::{BlankCut, BlankOperation, rubs_of_tile};
use crate::dexel::blank_field::{BlankField, Ray};
use crate::dexel::intervals::{End, Span};
use crate::passes::StrokeSet;
use crate::passes::blank_candidates::{PlacedPass, passes_at, reaching_strip};
use crate::planar_rays::{FAMILIES, Family, RayCrossings, RayRow};
use crate::tool::closed_tooth::PlacedScratch;
use rayon::prelude::*;
use std::time::Duration;
use wgpu::BufferUsages as Use;

/// Tiles of one submission: enough to fill a large GPU with their rays, few enough that their parts stay tens of megabytes.
const GROUP_TILES: usize = 16;
/// Bytes of parts in one launch at most; the adapter's own limit may be lower.
const LAUNCH_BYTES: usize = 64 << 20;
/// Spans that a ray has room for at first, beside those it has.
const FIRST_ROOM: usize = 8;
/// Material that the return strokes of a tile may meet unnoticed, mm along its rays: half the depth at which reports speak of rubbing, a dozen times what f32 may be off.
const UNNOTICED_MM: f64 = 5e-4;
/// Iterations of all its loops that a thread may take in one launch: llvmpipe ends every loop after 65,535 of them in all, without a word.
const MOST_ITERATIONS: usize = 50_000;
/// What a pass may take of these beside one for each of its parts: Newton's steps and places in the list for each of eight crossings; so many times the room of a ray's list for its spans.
const ITERATIONS_PER_PASS: usize = 8 * (12 + 8);
const LIST_WALKS_PER_PASS: usize = 3 * 4;
/// Longest wait for a launch.
const PATIENCE: Duration = Duration::from_secs(600);

/// One tile's work, composed.
struct TileWork {
    rays: std::ops::Range<usize>,
    passes: Vec<PassWork>,
}

/// One pass of a tile.
struct PassWork {
    id: u32,
    returns: bool,
    parts: Vec<BlankPart>,
}

/// What a group of tiles came back with.
struct Returned {
    rays: Vec<Ray>,
    /// Pass id and length removed, mm, in the order of tiles and time.
    removed_mm: Vec<(u32, f64)>,
    /// Whether the return strokes of each tile met material.
    rubs: Vec<bool>,
}

/// Why a group has to be done again.
enum Outcome {
    Done(Returned),
    NeedsRoom(usize),
}

impl Gpu {
    /// Runs an operation over the blank field; `first_room` spans are reserved beside those that a ray has, and more when they are needed. `advance` is called after every tile
    /// and says whether to go on; `None`: stopped.
    ///
    /// # Errors
    /// The device fails, or a ray crosses one tooth more than eight times; the field is then as it was.
    pub fn cut_blank_on_device(
        &self,
        field: &mut BlankField,
        operation: &BlankOperation,
        first_room: Option<usize>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<BlankCut>, GpuProblem> {
        self.device.alive()?;
        let set = operation.strokes;
        let grid = field.grid.clone();
        let mut result =
            BlankCut { removed_mm3: vec![[0.0; 2]; (set.end_pass() - set.first_pass) as usize], ..BlankCut::default() };
        let mut after = field.clone();
        let widths_mm = grid.slice_widths_mm();
        for (slice, lead_mm) in grid.leads_mm.iter().enumerate() {
            let place = |strokes: &StrokeSet| {
                passes_at(strokes, set.law.tau(*lead_mm), operation.tool, operation.tooth, operation.blank_reach_mm)
            };
            let (passes, returns) = (place(set), operation.returns.map(place).unwrap_or_default());
            let volume_per_length = grid.spacing_mm() * widths_mm[slice];
            for (f, family) in FAMILIES.into_iter().enumerate() {
                let row = grid.rows[f];
                let tiles: Vec<usize> = (0..row.count).step_by(WORKGROUP_THREADS as usize).collect();
                for group in tiles.chunks(GROUP_TILES) {
                    let work: Vec<TileWork> = group
                        .par_iter()
                        .map(|&first| compose(operation, [&passes, &returns], family, &row, first))
                        .collect();
                    let from = group[0];
                    let until = work.last().map_or(from, |tile| tile.rays.end);
                    let rays = &mut after.slices[slice].rays[f][from..until];
                    let returned = self.run_group(&work, family, &row, operation.tooth.reach_mm, rays, first_room)?;
                    for (old, new) in rays.iter_mut().zip(returned.rays) {
                        *old = new;
                    }
                    for (pass, length_mm) in returned.removed_mm {
                        result.removed_mm3[(pass - set.first_pass) as usize][f] += length_mm * volume_per_length;
                    }
                    let rubbing: Vec<&TileWork> =
                        work.iter().zip(&returned.rubs).filter(|(_, rubs)| **rubs).map(|(tile, _)| tile).collect();
                    let rubs = rubbing.par_iter().map(|tile| {
                        let place = [slice, f, tile.rays.start];
                        rubs_of_tile(field, place, tile.rays.len(), operation, [&passes, &returns])
                    });
                    result.rubs.extend(rubs.collect::<Vec<_>>().concat());
                    if !group.iter().all(|_| advance()) {
                        return Ok(None);
                    }
                }
            }
        }
        *field = after;
        Ok(Some(result))
    }

    /// Runs some tiles, with more room for their lists until they fit.
    fn run_group(
        &self,
        work: &[TileWork],
        family: Family,
        row: &RayRow,
        reach_mm: f64,
        rays: &[Ray],
        first_room: Option<usize>,
    ) -> Result<Returned, GpuProblem> {
        let longest = rays.iter().map(Vec::len).max().unwrap_or(0);
        let mut capacity = (longest + first_room.unwrap_or(FIRST_ROOM)).max(1);
        loop {
            let bytes = rays.len() * capacity * size_of::<BlankSpan>();
            let limit = self.device.facts.binding_bytes.min(self.device.facts.buffer_bytes);
            if bytes as u64 > limit {
                let reason = format!("lists of {capacity} spans for {} rays need {bytes} of {limit} bytes", rays.len());
                return Err(GpuProblem::OutOfMemory { reason });
            }
            match self.try_group(work, family, row, reach_mm, rays, capacity)? {
                Outcome::Done(returned) => return Ok(returned),
                Outcome::NeedsRoom(needed) => capacity = needed.max(2 * capacity),
            }
        }
    }

    fn try_group(
        &self,
        work: &[TileWork],
        family: Family,
        row: &RayRow,
        reach_mm: f64,
        rays: &[Ray],
        capacity: usize,
    ) -> Result<Outcome, GpuProblem> {
        let device = &self.device;
        // A tile's rays lie in the tooth over its whole height at most.
        let longest_mm = f64::from(WORKGROUP_THREADS) * 2.02 * reach_mm;
        let units_per_mm = (f64::from(u32::MAX) / longest_mm) as f32;
        let launch = BlankLaunch {
            spacing_mm: row.spacing_mm as f32,
            units_per_mm,
            capacity: capacity as u32,
            turn: if family == Family::X { 1.0 } else { -1.0 },
        };
        let counts: Vec<u32> = rays.iter().map(|ray| ray.len() as u32).collect();
        // Room that is not in use holds NaN: whoever reads it shows.
        let unused = f32::from_bits(u32::MAX);
        let empty = BlankSpan { low_mm: unused, high_mm: unused, ..bytemuck::Zeroable::zeroed() };
        let mut spans = vec![empty; rays.len() * capacity];
        for (ray, room) in rays.iter().zip(spans.chunks_mut(capacity)) {
            for (span, place) in ray.iter().zip(room) {
                *place = to_record(span, family);
            }
        }
        let launch_buffer = filled(device, "blank launch", bytemuck::bytes_of(&launch), Use::UNIFORM)?;
        let spans_buffer = filled(device, "spans", bytemuck::cast_slice(&spans), Use::STORAGE | Use::COPY_SRC)?;
        let counts_buffer = filled(device, "counts", bytemuck::cast_slice(&counts), Use::STORAGE | Use::COPY_SRC)?;
        let needs_buffer = filled(device, "needs", &[0; 8], Use::STORAGE | Use::COPY_SRC)?;
        let limit = LAUNCH_BYTES.min(device.facts.binding_bytes as usize) / size_of::<BlankPart>() / work.len().max(1);
        let first_ray = work[0].rays.start;
        let mut removed_mm = Vec::new();
        let mut met_mm = vec![0.0; work.len()];
        let mut next = vec![0; work.len()];
        while next.iter().zip(work).any(|(&at, tile)| at < tile.passes.len()) {
            let (mut tiles, mut passes, mut parts) = (Vec::new(), Vec::new(), Vec::new());
            for (tile, at) in work.iter().zip(&mut next) {
                let (first_pass, first_part) = (passes.len(), parts.len());
                let mut iterations = 0;
                while let Some(pass) = tile.passes.get(*at) {
                    iterations += pass.parts.len() + ITERATIONS_PER_PASS + LIST_WALKS_PER_PASS * capacity;
                    let full = parts.len() - first_part + pass.parts.len() > limit || iterations > MOST_ITERATIONS;
                    if parts.len() > first_part && full {
                        break;
                    }
                    passes.push(BlankPass {
                        first_part: parts.len() as u32,
                        part_count: pass.parts.len() as u32,
                        pass_id: pass.id,
                        returns: u32::from(pass.returns),
                    });
                    parts.extend_from_slice(&pass.parts);
                    *at += 1;
                }
                tiles.push(BlankTile {
                    first_pass: first_pass as u32,
                    pass_count: (passes.len() - first_pass) as u32,
                    first_ray: (tile.rays.start - first_ray) as u32,
                    ray_count: tile.rays.len() as u32,
                });
            }
            let zeros = vec![0_u32; passes.len()];
            let removed_buffer = filled(device, "removed", bytemuck::cast_slice(&zeros), Use::STORAGE | Use::COPY_SRC)?;
            let tiles_buffer = filled(device, "blank tiles", bytemuck::cast_slice(&tiles), Use::STORAGE)?;
            let passes_buffer = filled(device, "blank passes", bytemuck::cast_slice(&passes), Use::STORAGE)?;
            let parts_buffer = filled(device, "parts", bytemuck::cast_slice(&parts), Use::STORAGE)?;
            let bindings = [
                &launch_buffer,
                &tiles_buffer,
                &passes_buffer,
                &parts_buffer,
                &spans_buffer,
                &counts_buffer,
                &removed_buffer,
                &needs_buffer,
            ];
            self.launch_blank(&bindings, tiles.len())?;
            let needs: Vec<u32> = self.bring_back(&needs_buffer, 8)?;
            if needs[1] > 0 {
                let reason = "a ray crosses one cutter tooth more than eight times".to_owned();
                return Err(GpuProblem::Invalid { reason });
            }
            if needs[0] > 0 {
                return Ok(Outcome::NeedsRoom(needs[0] as usize));
            }
            let removed: Vec<u32> = self.bring_back(&removed_buffer, 4 * passes.len())?;
            let length = |units: u32| f64::from(units) / f64::from(units_per_mm);
            for (tile, met_mm) in tiles.iter().zip(&mut met_mm) {
                let own = tile.first_pass as usize..(tile.first_pass + tile.pass_count) as usize;
                for (pass, units) in passes[own.clone()].iter().zip(&removed[own]).filter(|(_, units)| **units > 0) {
                    if pass.returns == 0 {
                        removed_mm.push((pass.pass_id, length(*units)));
                    } else {
                        *met_mm += length(*units);
                    }
                }
            }
        }
        let counts: Vec<u32> = self.bring_back(&counts_buffer, 4 * counts.len())?;
        let spans: Vec<BlankSpan> = self.bring_back(&spans_buffer, size_of_val(spans.as_slice()))?;
        let rays = counts.iter().zip(spans.chunks(capacity));
        let rays = rays.map(|(&count, room)| room[..count as usize].iter().map(|s| from_record(s, family)).collect());
        let rubs = met_mm.iter().map(|&met_mm| met_mm > UNNOTICED_MM).collect();
        Ok(Outcome::Done(Returned { rays: rays.collect(), removed_mm, rubs }))
    }

    fn launch_blank(&self, bindings: &[&wgpu::Buffer], tiles: usize) -> Result<(), GpuProblem> {
        let device = &self.device;
        let pipeline = &self.blank_rays[0];
        device.checked(|| {
            let entries: Vec<wgpu::BindGroupEntry> = (0..)
                .zip(bindings)
                .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                .collect();
            let group = device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            let mut encoder = device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(BLANK_RAYS.name),
                timestamp_writes: None,
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(tiles as u32, 1, 1);
            drop(pass);
            device.queue.submit([encoder.finish()]);
        })?;
        self.log().count(BLANK_RAYS.name, None);
        Ok(())
    }

    /// The first bytes of a buffer, once all that was sent is done.
    fn bring_back<T: bytemuck::Pod>(&self, from: &wgpu::Buffer, bytes: usize) -> Result<Vec<T>, GpuProblem> {
        let device = &self.device;
        let (back, submission) = device.checked(|| {
            let back = device.handle.create_buffer(&wgpu::BufferDescriptor {
                label: Some("back"),
                size: bytes as u64,
                usage: Use::MAP_READ | Use::COPY_DST,
                mapped_at_creation: false,
            });
            if self.options.poison_outputs {
                device.queue.write_buffer(&back, 0, &vec![0xFF; bytes]);
            }
            let mut encoder = device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            encoder.copy_buffer_to_buffer(from, 0, &back, 0, bytes as u64);
            let submission = device.queue.submit([encoder.finish()]);
            back.map_async(wgpu::MapMode::Read, .., |_| {});
            (back, submission)
        })?;
        let wait = wgpu::PollType::Wait { submission_index: Some(submission), timeout: Some(PATIENCE) };
        if device.checked(|| device.handle.poll(wait))?.is_err() {
            return Err(GpuProblem::Silent { seconds: PATIENCE.as_secs() });
        }
        let lost = |reason: String| GpuProblem::Lost { reason };
        let view = device.checked(|| back.get_mapped_range(..))?.map_err(|error| lost(error.to_string()))?;
        Ok(bytemuck::pod_collect_to_vec(&view))
    }
}

/// A buffer with these bytes; an empty binding is not allowed, so it holds sixteen at least.
fn filled(device: &Device, label: &str, bytes: &[u8], usage: Use) -> Result<wgpu::Buffer, GpuProblem> {
    device.checked(|| {
        let size = bytes.len().max(64) as u64;
        let usage = usage | Use::COPY_DST;
        let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
        let buffer = device.handle.create_buffer(&descriptor);
        device.queue.write_buffer(&buffer, 0, bytes);
        buffer
    })
}

/// Strokes and return strokes of a tile as parts, in order of time; in f64 until the last subtraction.
fn compose(
    operation: &BlankOperation,
    [passes, returns]: [&[PlacedPass]; 2],
    family: Family,
    row: &RayRow,
    first: usize,
) -> TileWork {
    let rays = first..(first + WORKGROUP_THREADS as usize).min(row.count);
    let origin_mm = row.at_mm(first);
    let strip = [origin_mm, row.at_mm(rays.end - 1)];
    let (mut placed, mut crossings) = (PlacedScratch::default(), RayCrossings::default());
    let reaching = |passes, returning| {
        reaching_strip(passes, operation.tooth, family, strip).map(move |pass| (pass.stroke, returning, pass))
    };
    let mut order: Vec<(u32, bool, &PlacedPass)> = reaching(passes, false).chain(reaching(returns, true)).collect();
    // Stable: cutter teeth stay in their order; a stroke goes back before the next one comes.
    order.sort_by_key(|&(stroke, returning, _)| (stroke, returning));
    let passes = order
        .into_iter()
        .filter_map(|(stroke, returns, pass)| {
            let tooth = operation.tooth.placed(&pass.work_from_blade, &mut placed);
            crossings.lay(&tooth, family, row, rays.clone());
            let single = |c: [f64; 4]| c.map(|c| c as f32);
            let parts: Vec<BlankPart> = crossings
                .cubics(&tooth, family)
                .map(|cubic| {
                    let mut across = cubic.across;
                    across[0] -= origin_mm;
                    BlankPart {
                        along: single(cubic.along),
                        across: single(across),
                        across_end_mm: (cubic.across_end_mm - origin_mm) as f32,
                        ..bytemuck::Zeroable::zeroed()
                    }
                })
                .collect();
            let id = operation.strokes.pass_id(stroke as usize, pass.blade);
            (!parts.is_empty()).then_some(PassWork { id, returns, parts })
        })
        .collect();
    TileWork { rays, passes }
}

/// Components along and across the rays, in f32.
fn to_record(span: &Span, family: Family) -> BlankSpan {
    let turned = |n: [f32; 2]| if family == Family::X { n } else { [n[1], n[0]] };
    BlankSpan {
        low_mm: span.low.at_mm as f32,
        high_mm: span.high.at_mm as f32,
        low_pass: span.low.pass,
        high_pass: span.high.pass,
        low_normal: turned(span.low.normal),
        high_normal: turned(span.high.normal),
    }
}

fn from_record(span: &BlankSpan, family: Family) -> Span {
    let turned = |n: [f32; 2]| if family == Family::X { n } else { [n[1], n[0]] };
    let end = |at: f32, pass, normal| End { at_mm: f64::from(at), pass, normal: turned(normal) };
    Span {
        low: end(span.low_mm, span.low_pass, span.low_normal),
        high: end(span.high_mm, span.high_pass, span.high_normal),
    }
}
