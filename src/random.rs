//! Random numbers that follow from a key.
//!
//! In: a seed, the source that asks (an axis, an edge), and which of its numbers it asks for. Out: a number of the
//! standard normal distribution, or a row of even numbers, always the same for the same key. Nothing is counted on the
//! way, so that neither the order of questions nor the number of threads matters.
//!
//! Law: the key, all 32 bytes of it, is that of the stream cipher ChaCha with 8 rounds (Bernstein, *ChaCha, a variant
//! of Salsa20*, 2008), whose first 16 bytes are two even numbers; they make one normal number (Box and Muller, *A note
//! on the generation of random normal deviates*, 1958). Ciphers as generators without a state: Salmon, Moraes, Dror and
//! Shaw, *Parallel random numbers: as easy as 1, 2, 3*, SC 2011.

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;

/// Numbers of one source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Draws {
    seed: u32,
    source: u32,
}

impl Draws {
    /// Numbers of a source, all others with another seed.
    pub fn new(seed: u32, source: u32) -> Self {
        Self { seed, source }
    }

    /// Numbers of the same source in another gear.
    #[must_use]
    pub fn of_gear(self, number: u32) -> Self {
        Self { seed: self.seed.wrapping_add(number), ..self }
    }

    /// Numbers spread evenly above 0 and up to 1, one after the other.
    pub fn even(self, which: [i64; 2]) -> impl FnMut() -> f64 + use<> {
        let mut key = [0; 32];
        let words = [i64::from(self.seed), i64::from(self.source), which[0], which[1]];
        for (bytes, word) in key.chunks_exact_mut(8).zip(words) {
            bytes.copy_from_slice(&word.to_le_bytes());
        }
        let mut stream = ChaCha8Rng::from_seed(key);
        // 53 bits, above 0 and up to 1.
        move || ((stream.next_u64() >> 11) + 1) as f64 / (1_u64 << 53) as f64
    }

    /// A number of mean 0 and variance 1.
    pub fn normal(self, which: [i64; 2]) -> f64 {
        let mut even = self.even(which);
        let (radius, turn) = ((-2.0 * even().ln()).sqrt(), even());
        radius * (TAU * turn).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean, variance, and the fourth moment of a normal number: 0, 1, 3. Of n numbers they scatter by 1, sqrt(2) and
    /// sqrt(96) over sqrt(n) (variances of x, x^2 and x^4); four times that is allowed.
    #[test]
    fn numbers_have_the_moments_of_the_normal_distribution() {
        let count = 200_000;
        let mut sums = [0.0; 3];
        for index in 0..count {
            let x = Draws::new(7, 3).normal([index, -index]);
            for (sum, power) in sums.iter_mut().zip([x, x * x, x.powi(4)]) {
                *sum += power / count as f64;
            }
        }
        let scatter = (count as f64).sqrt().recip();
        for ((sum, expected), variance) in sums.into_iter().zip([0.0, 1.0, 3.0]).zip([1.0_f64, 2.0, 96.0]) {
            assert!((sum - expected).abs() < 4.0 * variance.sqrt() * scatter, "{sums:?}");
        }
    }

    #[test]
    fn every_part_of_the_key_makes_another_number() {
        let number = |seed, source, which| Draws::new(seed, source).normal(which);
        let here = number(1, 2, [3, 4]);
        assert_eq!(here, number(1, 2, [3, 4]));
        for other in [number(2, 2, [3, 4]), number(1, 3, [3, 4]), number(1, 2, [4, 4]), number(1, 2, [3, -4])] {
            assert!((here - other).abs() > 1e-6);
        }
    }
}
