//! Launches of the kernel `blank_rays`: tiles of rays, and pass by pass the closed curves that are taken from them.
//!
//! In: tiles with what is left on their rays and their passes in order of time, every curve split into [`BlankPart`]s.
//! Out: what is left then, what every pass took of every tile, and the pieces of material that it took, where they are
//! asked for. The curves are sections of a hob tooth's sweep ([`super::blank_sweeps`]).
//!
//! No list has a fixed capacity: a ray without room stops, and the tiles in work are begun again with room for what it
//! needed. Tiles that do not fit the device together go one half after the other.

mod launch;
mod parts;
mod round;
mod spans;

pub use launch::{filled, roomy};
pub use parts::parts;
pub use spans::{from_record, to_record};

use super::context::Gpu;
use super::problem::GpuProblem;
use super::records::{BlankLaunch, BlankPart, BlankPiece, BlankSpan};
use gearcut_core::dexel::blank_field::RayMaterial;
use gearcut_core::dexel::intervals::Span;
use gearcut_core::math::planar_rays::Family;
use gearcut_shaders::WORKGROUP_THREADS;
use round::PassRound;
use wgpu::BufferUsages as Use;

/// Bytes of parts in one launch at most; the adapter's own limit may be lower.
const LAUNCH_BYTES: usize = 64 << 20;
/// Spans that a ray has room for at first, beside those it has.
const FIRST_ROOM: usize = 8;
/// Three numbers: the largest list that had no room, crossings that had none, pieces that were taken.
const NEEDS_BYTES: usize = 12;

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
    /// What was taken, if asked for, by pass, ray and place.
    pub pieces: Vec<TakenPiece>,
}

/// How a launch over some tiles ended.
enum Outcome {
    Done(Vec<TileDone>),
    NeedsSpans(usize),
    NeedsPieces(usize),
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
        let counts: Vec<u32> = work.iter().flat_map(|tile| tile.rays).map(|ray| ray.len() as u32).collect();
        let units_per_mm = (f64::from(u32::MAX) / (f64::from(WORKGROUP_THREADS) * terms.longest_mm)) as f32;
        let launch = BlankLaunch {
            spacing_mm: terms.spacing_mm as f32,
            units_per_mm,
            capacity: capacity as u32,
            piece_room: terms.piece_room as u32,
            rays: counts.len() as u32,
        };
        // Room that is not in use holds NaN: whoever reads it shows.
        let unused = f32::from_bits(u32::MAX);
        let no_span = BlankSpan { low_mm: unused, high_mm: unused, ..bytemuck::Zeroable::zeroed() };
        let mut spans = vec![no_span; counts.len() * capacity];
        let rays = work.iter().flat_map(|tile| tile.rays.iter().map(|ray| (tile.family, ray)));
        for (index, (family, ray)) in rays.enumerate() {
            for (slot, span) in ray.iter().enumerate() {
                spans[slot * counts.len() + index] = to_record(span, family);
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
                done.removed_mm.extend(removed.map(|(pass, units)| (pass.pass_id, length(*units))));
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
        let mut rays = counts.iter().enumerate();
        for (tile, done) in work.iter().zip(&mut done) {
            let left = rays.by_ref().take(tile.rays.len());
            let list = |(ray, &count): (usize, &u32)| {
                spans[ray..]
                    .iter()
                    .step_by(counts.len())
                    .take(count as usize)
                    .map(|s| from_record(s, tile.family))
                    .collect()
            };
            done.rays = left.map(list).collect();
            // Threads list their pieces as they come.
            done.pieces.sort_by(|a, b| {
                let place = |piece: &TakenPiece| (piece.pass, piece.ray);
                place(a).cmp(&place(b)).then(a.span.low.at_mm.total_cmp(&b.span.low.at_mm))
            });
        }
        Ok(Outcome::Done(done))
    }
}
