//! What is left of slices as the host knows it, and the chips of their passes.
//!
//! In: pieces of material that the device took, sorted by pass, family and ray. Out: where anything may be left, never
//! less than there is; chips, measured between both ends of their pieces.

use super::UNITS_PER_MM;
use crate::blank_rays::from_record;
use crate::blank_records::BlankPiece;
use gearcut_core::cut::sweep_chips::{ChipSurfaces, PassChip};
use gearcut_core::dexel::blank_field::{BlankGrid, RayMaterial, Slice};
use gearcut_core::dexel::intervals::subtract;
use gearcut_core::dexel::span_table::SpanTable;
use gearcut_core::math::planar_rays::FAMILIES;
use gearcut_core::passes::sections::swept_sections::SweepHeading;

/// What is left of a slice as the host knows it: never less than there is.
pub(super) struct SliceLeft {
    rays: [Vec<RayMaterial>; 2],
    /// The same at a glance.
    pub(super) tables: [SpanTable; 2],
}

impl SliceLeft {
    pub(super) fn new(slice: &Slice) -> Self {
        Self { rays: slice.rays.clone(), tables: [0, 1].map(|f: usize| SpanTable::new(&slice.rays[f])) }
    }

    /// Takes pieces away.
    pub(super) fn take(&mut self, pieces: &[BlankPiece], first_ray: usize, rays_of_x: usize) {
        for piece in pieces {
            let (f, ray) = family_and_ray(piece, first_ray, rays_of_x);
            let span = from_record(&piece.span, FAMILIES[f]);
            subtract(&mut self.rays[f][ray], span.low, span.high);
            self.tables[f].renew(ray, &self.rays[f][ray]);
        }
    }
}

/// Family of a piece's ray, and its place among them.
fn family_and_ray(piece: &BlankPiece, first_ray: usize, rays_of_x: usize) -> (usize, usize) {
    let place = piece.ray as usize - first_ray;
    if place < rays_of_x { (0, place) } else { (1, place - rays_of_x) }
}

/// Chips of one slice in order of time, from what its passes removed and the pieces, sorted by pass, family and ray.
pub(super) fn chips_of_slice(
    grid: &BlankGrid,
    width_mm: f64,
    headings: &[(u32, SweepHeading)],
    removed: &[[u64; 2]],
    pieces: &[BlankPiece],
    first_ray: usize,
) -> Vec<PassChip> {
    let mut of_passes = pieces.chunk_by(|a, b| a.pass_id == b.pass_id).peekable();
    let mut surfaces = ChipSurfaces::default();
    let mut chips = Vec::new();
    for ((pass, heading), removed) in headings.iter().zip(removed) {
        surfaces.clear();
        if let Some(own) = of_passes.next_if(|pieces| pieces[0].pass_id == *pass) {
            for piece in own {
                let (f, ray) = family_and_ray(piece, first_ray, grid.rows[0].count);
                let span = from_record(&piece.span, FAMILIES[f]);
                surfaces.add_piece(FAMILIES[f], grid.rows[f].at_mm(ray), &span, *pass);
            }
        }
        if *removed != [0; 2] {
            let removed_mm3 = removed.map(|units| units as f64 / UNITS_PER_MM * grid.spacing_mm() * width_mm);
            chips.push(PassChip::of_slice(*pass, heading, removed_mm3, width_mm, &surfaces, grid.spacing_mm()));
        }
    }
    chips
}
