//! Passes of one launch.
//!
//! In: tiles with their passes, and how far each tile has come. Out: records of the next passes, as many as a launch
//! may hold: its bytes, and the iterations that a thread may take.

use super::TileWork;
use crate::records::{BlankPart, BlankPass, BlankTile};

/// Iterations of all its loops that a thread may take in one launch: llvmpipe ends every loop after 65,535 of them in
/// all, without a word.
const MOST_ITERATIONS: usize = 50_000;
/// What a pass may take of these beside one for each of its parts: Newton's steps and places in the list for each of
/// eight crossings; so many times the room of a ray's list for its spans.
const ITERATIONS_PER_PASS: usize = 8 * (12 + 8);
const LIST_WALKS_PER_PASS: usize = 4 * 4;

/// Passes of one launch.
#[derive(Default)]
pub struct PassRound {
    /// One for each tile of the work.
    pub tiles: Vec<BlankTile>,
    /// Passes, tile after tile.
    pub passes: Vec<BlankPass>,
    /// Parts of their curves.
    pub parts: Vec<BlankPart>,
}

impl PassRound {
    /// The next passes of all tiles, as many as a launch may hold; `next` is how far each tile has come. `None`: all
    /// are done.
    pub fn compose(work: &[TileWork], next: &mut [usize], capacity: usize, parts_of_tile: usize) -> Option<Self> {
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
