//! Launches of the kernel `blank_rays`: tiles of rays, and pass by pass the closed curves that are taken from them.
//!
//! In: tiles with what is left on their rays and their passes in order of time, every curve split into [`BlankPart`]s.
//! Out: what is left then, what every pass took of every tile, and the pieces of material that it took, where they are
//! asked for. Cutter teeth in their strokes ([`super::blank`]) and sections of a hob tooth's sweep
//! ([`super::blank_sweeps`]) are the same from here on.
//!
//! No list has a fixed capacity: a ray without room stops, and the tiles in work are begun again with room for what it
//! needed. Tiles that do not fit the device together go one half after the other.

use super::device::Device;
use super::pipeline::BLANK_RAYS;
use super::problem::GpuProblem;
use super::readback::empty;
use super::records::{BlankLaunch, BlankPart, BlankPass, BlankPiece, BlankSpan, BlankTile};
use super::{Gpu, WORKGROUP_THREADS};
use gearcut_core::dexel::blank_field::RayMaterial;
use gearcut_core::dexel::intervals::{End, Span};
use gearcut_core::math::planar_rays::{ClosedCurve, Family, RayCrossings, RayRow};
use std::ops::Range;
use std::time::Duration;
use wgpu::BufferUsages as Use;

/// Bytes of parts in one launch at most; the adapter's own limit may be lower.
const LAUNCH_BYTES: usize = 64 << 20;
/// Spans that a ray has room for at first, beside those it has.
const FIRST_ROOM: usize = 8;
/// Iterations of all its loops that a thread may take in one launch: llvmpipe ends every loop after 65,535 of them in
/// all, without a word.
const MOST_ITERATIONS: usize = 50_000;
/// What a pass may take of these beside one for each of its parts: Newton's steps and places in the list for each of
/// eight crossings; so many times the room of a ray's list for its spans.
const ITERATIONS_PER_PASS: usize = 8 * (12 + 8);
const LIST_WALKS_PER_PASS: usize = 4 * 4;
/// More than rounding moves a ray and a node against each other: an ulp of f32 is 8 nm up to 128 mm from a tile's first
/// ray, where tiles of rays 2 mm apart end.
const MARGIN_MM: f64 = 2e-5;
/// Longest wait for a launch.
const PATIENCE: Duration = Duration::from_secs(600);

/// Neighbouring rays and the passes that visit them.
pub struct TileWork<'a> {
    /// Direction of the rays.
    pub family: Family,
    /// What is left on them.
    pub rays: &'a [RayMaterial],
    /// In order of time.
    pub passes: Vec<PassWork>,
}

/// One pass over one tile.
pub struct PassWork {
    /// Pass id.
    pub id: u32,
    /// Whether it takes nothing and only adds up what it meets.
    pub returns: bool,
    /// Its curve.
    pub parts: Vec<BlankPart>,
}

/// What holds for all tiles of an operation.
pub struct Terms {
    /// Distance of neighbouring rays, mm.
    pub spacing_mm: f64,
    /// Material that a pass can take of one ray at most, mm.
    pub longest_mm: f64,
    /// Spans that a ray has room for at first, beside those it has.
    pub first_room: usize,
    /// Pieces of a launch that there is room for, which grows; 0 if nobody asks for them.
    pub piece_room: usize,
}

impl Terms {
    /// Terms without pieces.
    pub fn new(spacing_mm: f64, longest_mm: f64, first_room: Option<usize>) -> Self {
        Self { spacing_mm, longest_mm, first_room: first_room.unwrap_or(FIRST_ROOM), piece_room: 0 }
    }
}

/// Material that a pass took from a ray; ends that it left bear its id.
pub struct TakenPiece {
    /// Pass id.
    pub pass: u32,
    /// Ray of the tile.
    pub ray: usize,
    /// The material.
    pub span: Span,
}

/// What a tile came back with.
#[derive(Default)]
pub struct TileDone {
    /// What is left.
    pub rays: Vec<RayMaterial>,
    /// Passes that took anything, in order of time, with the length, mm.
    pub removed_mm: Vec<(u32, f64)>,
    /// Length of what return strokes met, mm.
    pub met_mm: f64,
    /// What was taken, if asked for, by pass, ray and place.
    pub pieces: Vec<TakenPiece>,
}

/// How a launch over some tiles ended.
enum Outcome {
    Done(Vec<TileDone>),
    NeedsSpans(usize),
    NeedsPieces(usize),
}

/// Passes of one launch.
#[derive(Default)]
struct PassRound {
    tiles: Vec<BlankTile>,
    passes: Vec<BlankPass>,
    parts: Vec<BlankPart>,
}

impl PassRound {
    /// The next passes of all tiles, as many as a launch may hold; `next` is how far each tile has come. `None`: all
    /// are done.
    fn compose(work: &[TileWork], next: &mut [usize], capacity: usize, parts_of_tile: usize) -> Option<Self> {
        let mut round = Self::default();
        let mut first_ray = 0;
        for (tile, next) in work.iter().zip(next) {
            let (first_pass, first_part) = (round.passes.len(), round.parts.len());
            let mut iterations = 0;
            while let Some(pass) = tile.passes.get(*next) {
                iterations += pass.parts.len() + ITERATIONS_PER_PASS + LIST_WALKS_PER_PASS * capacity;
                let in_tile = round.parts.len() - first_part;
                if in_tile > 0 && (in_tile + pass.parts.len() > parts_of_tile || iterations > MOST_ITERATIONS) {
                    break;
                }
                round.passes.push(BlankPass {
                    first_part: round.parts.len() as u32,
                    part_count: pass.parts.len() as u32,
                    pass_id: pass.id,
                    returns: u32::from(pass.returns),
                });
                round.parts.extend_from_slice(&pass.parts);
                *next += 1;
            }
            round.tiles.push(BlankTile {
                first_pass: first_pass as u32,
                pass_count: (round.passes.len() - first_pass) as u32,
                first_ray,
                ray_count: tile.rays.len() as u32,
            });
            first_ray += tile.rays.len() as u32;
        }
        (!round.passes.is_empty()).then_some(round)
    }
}

impl Gpu {
    /// Runs tiles with all their passes, with more room for their lists until they fit.
    pub(super) fn run_blank_tiles(&self, work: &[TileWork], terms: &mut Terms) -> Result<Vec<TileDone>, GpuProblem> {
        let rays: usize = work.iter().map(|tile| tile.rays.len()).sum();
        let longest = work.iter().flat_map(|tile| tile.rays).map(Vec::len).max().unwrap_or(0);
        let mut capacity = (longest + terms.first_room).max(1);
        loop {
            let bytes = rays * capacity * size_of::<BlankSpan>();
            let bytes = bytes.max(terms.piece_room * size_of::<BlankPiece>());
            let limit = self.device.facts.binding_bytes.min(self.device.facts.buffer_bytes);
            if bytes as u64 > limit {
                if let (first, second @ [_, ..]) = work.split_at(work.len().div_ceil(2)) {
                    terms.piece_room = terms.piece_room.div_ceil(2);
                    let mut done = self.run_blank_tiles(first, terms)?;
                    done.extend(self.run_blank_tiles(second, terms)?);
                    return Ok(done);
                }
                let reason = format!("lists of {capacity} spans for {rays} rays need {bytes} of {limit} bytes");
                return Err(GpuProblem::OutOfMemory { reason });
            }
            match self.try_blank_tiles(work, terms, capacity)? {
                Outcome::Done(done) => return Ok(done),
                Outcome::NeedsSpans(needed) => capacity = needed.max(2 * capacity),
                Outcome::NeedsPieces(needed) => terms.piece_room = needed.max(2 * terms.piece_room),
            }
        }
    }

    fn try_blank_tiles(&self, work: &[TileWork], terms: &Terms, capacity: usize) -> Result<Outcome, GpuProblem> {
        let device = &self.device;
        let units_per_mm = (f64::from(u32::MAX) / (f64::from(WORKGROUP_THREADS) * terms.longest_mm)) as f32;
        let launch = BlankLaunch {
            spacing_mm: terms.spacing_mm as f32,
            units_per_mm,
            capacity: capacity as u32,
            piece_room: terms.piece_room as u32,
        };
        let counts: Vec<u32> = work.iter().flat_map(|tile| tile.rays).map(|ray| ray.len() as u32).collect();
        // Room that is not in use holds NaN: whoever reads it shows.
        let unused = f32::from_bits(u32::MAX);
        let no_span = BlankSpan { low_mm: unused, high_mm: unused, ..bytemuck::Zeroable::zeroed() };
        let mut spans = vec![no_span; counts.len() * capacity];
        let rays = work.iter().flat_map(|tile| tile.rays.iter().map(|ray| (tile.family, ray)));
        for ((family, ray), room) in rays.zip(spans.chunks_mut(capacity)) {
            for (span, place) in ray.iter().zip(room) {
                *place = to_record(span, family);
            }
        }
        let launch_buffer = filled(device, "blank launch", bytemuck::bytes_of(&launch), Use::UNIFORM)?;
        let spans_buffer = filled(device, "spans", bytemuck::cast_slice(&spans), Use::STORAGE | Use::COPY_SRC)?;
        let counts_buffer = filled(device, "counts", bytemuck::cast_slice(&counts), Use::STORAGE | Use::COPY_SRC)?;
        let piece_bytes = terms.piece_room * size_of::<BlankPiece>();
        let poison = vec![0xFF; if self.options.poison_outputs { piece_bytes } else { 0 }];
        let pieces_buffer = roomy(device, "pieces", piece_bytes, &poison, Use::STORAGE | Use::COPY_SRC)?;
        let parts_of_tile =
            LAUNCH_BYTES.min(device.facts.binding_bytes as usize) / size_of::<BlankPart>() / work.len().max(1);
        let mut done: Vec<TileDone> = work.iter().map(|_| TileDone::default()).collect();
        let mut next = vec![0; work.len()];
        while let Some(round) = PassRound::compose(work, &mut next, capacity, parts_of_tile) {
            let zeros = vec![0_u32; round.passes.len()];
            let removed_buffer = filled(device, "removed", bytemuck::cast_slice(&zeros), Use::STORAGE | Use::COPY_SRC)?;
            let needs_buffer = filled(device, "needs", &[0; NEEDS_BYTES], Use::STORAGE | Use::COPY_SRC)?;
            let tiles_buffer = filled(device, "blank tiles", bytemuck::cast_slice(&round.tiles), Use::STORAGE)?;
            let passes_buffer = filled(device, "blank passes", bytemuck::cast_slice(&round.passes), Use::STORAGE)?;
            let parts_buffer = filled(device, "parts", bytemuck::cast_slice(&round.parts), Use::STORAGE)?;
            let bindings = [
                &launch_buffer,
                &tiles_buffer,
                &passes_buffer,
                &parts_buffer,
                &spans_buffer,
                &counts_buffer,
                &removed_buffer,
                &needs_buffer,
                &pieces_buffer,
            ];
            self.launch_blank(&bindings, round.tiles.len())?;
            let needs: Vec<u32> = self.bring_back(&needs_buffer, NEEDS_BYTES)?;
            let (spans_needed, crossings_missed, pieces_taken) = (needs[0] as usize, needs[1], needs[2] as usize);
            if crossings_missed > 0 {
                let reason = "a ray crosses the curve of one pass more than eight times".to_owned();
                return Err(GpuProblem::Invalid { reason });
            }
            if spans_needed > 0 {
                return Ok(Outcome::NeedsSpans(spans_needed));
            }
            if pieces_taken > terms.piece_room {
                return Ok(Outcome::NeedsPieces(pieces_taken));
            }
            let removed: Vec<u32> = self.bring_back(&removed_buffer, 4 * round.passes.len())?;
            let length = |units: u32| f64::from(units) / f64::from(units_per_mm);
            for (tile, done) in round.tiles.iter().zip(&mut done) {
                let own = tile.first_pass as usize..(tile.first_pass + tile.pass_count) as usize;
                let removed = round.passes[own.clone()].iter().zip(&removed[own]).filter(|(_, units)| **units > 0);
                for (pass, units) in removed {
                    if pass.returns == 0 {
                        done.removed_mm.push((pass.pass_id, length(*units)));
                    } else {
                        done.met_mm += length(*units);
                    }
                }
            }
            let pieces: Vec<BlankPiece> = self.bring_back(&pieces_buffer, pieces_taken * size_of::<BlankPiece>())?;
            for piece in &pieces {
                let tile = round.tiles.partition_point(|tile| tile.first_ray <= piece.ray) - 1;
                done[tile].pieces.push(TakenPiece {
                    pass: piece.pass_id,
                    ray: (piece.ray - round.tiles[tile].first_ray) as usize,
                    span: from_record(&piece.span, work[tile].family),
                });
            }
        }
        let counts: Vec<u32> = self.bring_back(&counts_buffer, size_of_val(counts.as_slice()))?;
        let spans: Vec<BlankSpan> = self.bring_back(&spans_buffer, size_of_val(spans.as_slice()))?;
        let mut rays = counts.iter().zip(spans.chunks(capacity));
        for (tile, done) in work.iter().zip(&mut done) {
            let left = rays.by_ref().take(tile.rays.len());
            done.rays = left
                .map(|(&count, room)| room[..count as usize].iter().map(|s| from_record(s, tile.family)).collect())
                .collect();
            // Threads list their pieces as they come.
            done.pieces.sort_by(|a, b| {
                let place = |piece: &TakenPiece| (piece.pass, piece.ray);
                place(a).cmp(&place(b)).then(a.span.low.at_mm.total_cmp(&b.span.low.at_mm))
            });
        }
        Ok(Outcome::Done(done))
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
        if bytes == 0 {
            return Ok(Vec::new());
        }
        let device = &self.device;
        let (back, submission) = device.checked(|| {
            let back = empty(device, "back", bytes as u64, Use::MAP_READ | Use::COPY_DST);
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

/// Three numbers: the largest list that had no room, crossings that had none, pieces that were taken.
const NEEDS_BYTES: usize = 12;

/// A buffer with these bytes.
fn filled(device: &Device, label: &str, bytes: &[u8], usage: Use) -> Result<wgpu::Buffer, GpuProblem> {
    roomy(device, label, bytes.len(), bytes, usage)
}

/// A buffer of some size that begins with these bytes; an empty binding is not allowed, so it has sixty-four at least.
fn roomy(device: &Device, label: &str, size: usize, bytes: &[u8], usage: Use) -> Result<wgpu::Buffer, GpuProblem> {
    device.checked(|| {
        let buffer = empty(device, label, size.max(64) as u64, usage | Use::COPY_DST);
        device.queue.write_buffer(&buffer, 0, bytes);
        buffer
    })
}

/// The parts of a curve that rays of a tile cross; in f64 until the last subtraction. None: no ray comes near.
///
/// Rounded to f32 a node may change sides with a ray beside it. Neighbouring parts share the rounded node, so that the
/// ray crosses one of them still, and crossings come in pairs as long as both are there: parts are taken along that
/// come within [`MARGIN_MM`] of a ray.
pub fn parts(
    crossings: &mut RayCrossings,
    curve: &impl ClosedCurve,
    family: Family,
    row: &RayRow,
    rays: Range<usize>,
) -> Vec<BlankPart> {
    let origin_mm = row.at_mm(rays.start);
    crossings.lay_within(curve, family, row, rays, MARGIN_MM);
    let single = |c: [f64; 4]| c.map(|c| c as f32);
    crossings
        .cubics(curve, family)
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
        .collect()
}

/// Components of a normal along and across the rays, as the kernel has them. Seen along and across them, rays along y
/// are a mirror image: there the kernel's normals point the other way.
fn turned(normal: [f32; 2], family: Family) -> [f32; 2] {
    match family {
        Family::X => normal,
        Family::Y => [-normal[1], -normal[0]],
    }
}

fn to_record(span: &Span, family: Family) -> BlankSpan {
    BlankSpan {
        low_mm: span.low.at_mm as f32,
        high_mm: span.high.at_mm as f32,
        low_pass: span.low.pass,
        high_pass: span.high.pass,
        low_normal: turned(span.low.normal, family),
        high_normal: turned(span.high.normal, family),
    }
}

fn from_record(span: &BlankSpan, family: Family) -> Span {
    let end = |at: f32, pass, normal| End { at_mm: f64::from(at), pass, normal: turned(normal, family) };
    Span {
        low: end(span.low_mm, span.low_pass, span.low_normal),
        high: end(span.high_mm, span.high_pass, span.high_normal),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearcut_core::math::planar_rays::Piece;
    use glam::DVec2;

    struct Polygon {
        pieces: Vec<Piece>,
        nodes_mm: Vec<DVec2>,
    }

    impl ClosedCurve for Polygon {
        fn pieces(&self) -> &[Piece] {
            &self.pieces
        }
        fn node_mm(&self, index: usize) -> DVec2 {
            self.nodes_mm[index]
        }
        fn place(&self, _law: u32, _parameter: f64) -> [DVec2; 2] {
            [DVec2::ZERO; 2]
        }
        fn tangents(&self, _index: usize) -> [DVec2; 2] {
            [DVec2::ZERO; 2]
        }
    }

    /// Rays of a tile that cross an odd number of parts, as the shader counts.
    fn odd_rays(parts: &[BlankPart], row: &RayRow, rays: usize) -> usize {
        let odd = |ray: &usize| {
            let at_mm = *ray as f32 * row.spacing_mm as f32;
            let crosses = |part: &&BlankPart| {
                let (a, b) = (part.across[0], part.across_end_mm);
                a.min(b) <= at_mm && at_mm < a.max(b)
            };
            parts.iter().filter(crosses).count() % 2 == 1
        };
        (0..rays).filter(odd).count()
    }

    #[test]
    fn rays_cross_in_pairs_where_nodes_stand_beside_them() {
        let row = RayRow { first_mm: -60.25, spacing_mm: 0.3, count: 400 };
        let (mut alone, mut laid) = (0, RayCrossings::default());
        for turn in 0..40 {
            // Nodes within two nanometres of the rays, on both sides, on a zigzag up one side and down the other.
            let beside = |ray: usize, k: usize| row.at_mm(ray) + 1e-7 * f64::from((7 * k as i32 + turn) % 41 - 20);
            let up = (0..60).map(|k| DVec2::new(30.0, beside(100 + k, k)));
            let down = (0..60).rev().map(|k| DVec2::new(20.0, beside(100 + k, k + 3)));
            let nodes_mm: Vec<DVec2> = up.chain(down).collect();
            let straight = Piece { law: Piece::STRAIGHT, range: [0.0, 1.0], sagitta_mm: 0.0 };
            let curve = Polygon { pieces: vec![straight; nodes_mm.len()], nodes_mm };
            for first in [96, 128] {
                let rays = first..first + 64;
                assert_eq!(odd_rays(&parts(&mut laid, &curve, Family::X, &row, rays.clone()), &row, 64), 0);
                // Alive: without the margin some part is missing.
                laid.lay(&curve, Family::X, &row, rays);
                let origin_mm = row.at_mm(first);
                let bare: Vec<BlankPart> = laid
                    .cubics(&curve, Family::X)
                    .map(|cubic| BlankPart {
                        across: [(cubic.across[0] - origin_mm) as f32, 0.0, 0.0, 0.0],
                        across_end_mm: (cubic.across_end_mm - origin_mm) as f32,
                        ..bytemuck::Zeroable::zeroed()
                    })
                    .collect();
                alone += odd_rays(&bare, &row, 64);
            }
        }
        println!("{alone} rays would cross an odd number");
        assert!(alone > 0);
    }
}
