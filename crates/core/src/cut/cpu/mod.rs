//! The native backend: f64, one tile at a time, 16 rows at once (8 in space), with the widest vectors that the
//! processor has.
//!
//! The instruction set is chosen when the program starts, so `cargo build --release` without flags is fast everywhere.
//! No fused multiply-add is used and every chunk has the same rows on all of them: AVX2, AVX-512 and plain x86-64 or
//! ARM give the **same bytes**.

pub mod blank;
pub mod blank_sweeps;
mod planar;
mod spatial;

pub use spatial::Taken;

use super::sweep_chips::SweepsCut;
use super::{Backend, CutStats};
use super::{BlankCut, BlankOperation};
use crate::dexel::{BlankField, Field, Layer, SpatialField};
use crate::error::Error;
use crate::passes::sections::swept_sections::SweptSections;
use crate::passes::{CutPlan, SweepPlan};
use pulp::Arch;
#[cfg(target_arch = "x86_64")]
use pulp::x86::{V3, V4};
use std::ops::Range;

/// Vector instructions to use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Vectors {
    /// The widest that the processor has.
    Widest,
    /// AVX2 even where AVX-512 exists: for benchmarks.
    Avx2,
    /// What every processor of the architecture has: for tests.
    Baseline,
}

/// The native backend.
#[derive(Debug, Clone, Copy)]
pub struct Cpu {
    vectors: Vectors,
}

impl Default for Cpu {
    fn default() -> Self {
        Self { vectors: Vectors::Widest }
    }
}

impl Cpu {
    /// Backend with given vectors; `None` when the processor lacks them.
    pub fn with_vectors(vectors: Vectors) -> Option<Self> {
        #[cfg(target_arch = "x86_64")]
        let there = vectors != Vectors::Avx2 || V3::try_new().is_some();
        #[cfg(not(target_arch = "x86_64"))]
        let there = vectors != Vectors::Avx2;
        there.then_some(Self { vectors })
    }

    /// Name of the instruction set in use.
    pub fn instruction_set(self) -> &'static str {
        match self.vectors {
            Vectors::Baseline => "baseline",
            Vectors::Avx2 => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Vectors::Widest if V4::try_new().is_some() => "AVX-512",
            #[cfg(target_arch = "x86_64")]
            Vectors::Widest if V3::try_new().is_some() => "AVX2",
            Vectors::Widest => "baseline",
        }
    }

    /// Runs all records of a plan in their order and records what each takes from the rays: one entry for each record
    /// of the plan. `spread_per_mm`: how much the rays of each column part (curvature of the curve that they stand on),
    /// so that lengths become areas.
    ///
    /// The plan must hold every pass that reaches the field: what a culled one would have taken would be added to
    /// another.
    pub fn cut_with_ledger(
        self,
        field: &SpatialField,
        plan: &SweepPlan,
        spread_per_mm: &[f64],
        layer: &mut Layer,
    ) -> (CutStats, Vec<Taken>) {
        let mut stats = CutStats::default();
        let mut taken = vec![Taken::default(); plan.records.len()];
        for tile in &plan.tiles {
            stats += self.dispatch(spatial::LedgerCut {
                cut: spatial::SpatialTileCut {
                    field,
                    tile,
                    records: &plan.records[tile.records.clone()],
                    segments: &plan.segments,
                    heights_mm: &mut layer.heights_mm,
                    passes: &mut layer.passes,
                },
                spread_per_mm,
                taken: &mut taken[tile.records.clone()],
            });
        }
        (stats, taken)
    }

    fn dispatch<T: pulp::NullaryFnOnce<Output = CutStats>>(self, tile: T) -> CutStats {
        match self.vectors {
            Vectors::Widest => Arch::new().dispatch(tile),
            Vectors::Baseline => pulp::NullaryFnOnce::call(tile),
            #[cfg(target_arch = "x86_64")]
            Vectors::Avx2 => match V3::try_new() {
                Some(avx2) => pulp::Simd::vectorize(avx2, tile),
                None => pulp::NullaryFnOnce::call(tile),
            },
            #[cfg(not(target_arch = "x86_64"))]
            Vectors::Avx2 => Arch::new().dispatch(tile),
        }
    }
}

impl Backend for Cpu {
    fn name(&self) -> String {
        format!("cpu ({}, {} threads)", self.instruction_set(), rayon::current_num_threads())
    }

    /// Neither instruction set nor threads change a byte.
    fn name_in_files(&self) -> String {
        "cpu".to_owned()
    }

    fn cut(&self, field: &Field, plan: &CutPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        let rows = field.rows();
        let mut stats = CutStats { dexels: field.len() as u64, ..CutStats::default() };
        for tile in &plan.tiles {
            let dexels = tile.columns.start * rows..tile.columns.end * rows;
            stats += self.dispatch(planar::TileCut {
                columns: &field.columns[tile.columns.clone()],
                origin_mm: tile.origin_mm,
                records: &plan.records[tile.records.clone()],
                segments: &plan.segments,
                row_phases: &plan.row_phases,
                heights_mm: &mut layer.heights_mm[dexels.clone()],
                passes: &mut layer.passes[dexels],
            });
        }
        Ok(stats)
    }

    fn cut_blank(
        &self,
        field: &mut BlankField,
        operation: &BlankOperation,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<BlankCut>, Error> {
        Ok(blank::cut(field, operation, advance))
    }

    fn cut_blank_sweeps(
        &self,
        field: &mut BlankField,
        sections: &SweptSections,
        passes: Range<u32>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<SweepsCut>, Error> {
        Ok(blank_sweeps::cut(field, sections, passes, advance))
    }

    fn cut_spatial(&self, field: &SpatialField, plan: &SweepPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        let mut stats = CutStats { dexels: field.len() as u64, ..CutStats::default() };
        for tile in &plan.tiles {
            stats += self.dispatch(spatial::SpatialTileCut {
                field,
                tile,
                records: &plan.records[tile.records.clone()],
                segments: &plan.segments,
                heights_mm: &mut layer.heights_mm,
                passes: &mut layer.passes,
            });
        }
        Ok(stats)
    }
}
