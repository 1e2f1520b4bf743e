//! What the machine can do at most, measured in the same run as what the kernels do: arithmetic in the widest vectors,
//! and bytes to and from memory.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::hint::black_box;
use std::time::Instant;

/// Chains that do not wait for each other.
const CHAINS: usize = 16;
/// Rounds of one measurement.
const ROUNDS: usize = 4_000_000;
/// Bytes of the array that is copied: far more than the caches hold.
const COPIED_BYTES: usize = 512 << 20;
/// Measurements of which the fastest counts.
const RUNS: usize = 5;

struct Arithmetic;

impl WithSimd for Arithmetic {
    /// Lanes of a vector.
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        let [factor, shift] = [1.0 - 1e-9, 1e-9].map(|value| black_box(simd.splat_f64s(value)));
        let mut chains = [shift; CHAINS];
        for _ in 0..ROUNDS / CHAINS {
            for chain in &mut chains {
                *chain = simd.add_f64s(simd.mul_f64s(*chain, factor), shift);
            }
        }
        black_box(chains);
        S::F64_LANES
    }
}

fn fastest_s(run: impl Fn()) -> f64 {
    let times = std::iter::repeat_with(|| {
        let started = Instant::now();
        run();
        started.elapsed().as_secs_f64()
    });
    times.take(RUNS).fold(f64::INFINITY, f64::min)
}

/// f64 additions and multiplications in a second, on all of rayon's threads together; not fused, as the kernels' are
/// not.
pub fn operations_per_s() -> f64 {
    let threads = rayon::current_num_threads();
    let lanes = Arch::new().dispatch(Arithmetic);
    let time_s = fastest_s(|| {
        (0..threads).into_par_iter().for_each(|_| {
            black_box(Arch::new().dispatch(Arithmetic));
        });
    });
    (threads * ROUNDS * lanes * 2) as f64 / time_s
}

/// Bytes read and written in a second by a copy, on all of rayon's threads together.
pub fn memory_bytes_per_s() -> f64 {
    let from = vec![1_u64; COPIED_BYTES / 8];
    let to = std::sync::Mutex::new(vec![0_u64; COPIED_BYTES / 8]);
    let share = from.len().div_ceil(rayon::current_num_threads());
    let time_s = fastest_s(|| {
        let mut to = to.lock().expect("no other thread holds it");
        from.par_chunks(share).zip(to.par_chunks_mut(share)).for_each(|(from, to)| to.copy_from_slice(from));
        black_box(&*to);
    });
    2.0 * COPIED_BYTES as f64 / time_s
}
