//! Places in a unit cube where a study looks: one for each sample, a number for each parameter.
//!
//! - **Latin hypercube** (McKay, Beckman and Conover, *Technometrics* 21, 1979): of n samples every parameter has one
//!   in each of n equal shares of its range; which share goes with which sample is shuffled for each parameter alone.
//! - **Sobol's sequence** (1967), with the direction numbers of Joe and Kuo (*SIAM J. Sci. Comput.* 30, 2008; their
//!   file `new-joe-kuo-6`), without its first point, which is the corner of the cube. Samples of 2^k - 1 are balanced.
//!   More samples go on where fewer ended: a study can grow.
//!
//! Everything follows from seed, parameter and sample (`crate::random`). Road not taken: scrambled sequences, whose
//! error bars ask for several studies.

use crate::random::Draws;

/// The random numbers of studies: no axis, stock, edge or tolerance draws from here.
const SOURCE: u32 = u32::MAX - 1;

/// Bits of a number of the sequence.
const BITS: usize = 32;

/// Degree, coefficients and initial numbers of the polynomials of dimensions 2 and up.
const POLYNOMIALS: [(usize, u32, &[u32]); 20] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
    (5, 7, &[1, 1, 7, 11, 19]),
    (5, 11, &[1, 1, 5, 1, 1]),
    (5, 13, &[1, 1, 1, 3, 11]),
    (5, 14, &[1, 3, 5, 5, 31]),
    (6, 1, &[1, 3, 3, 9, 7, 49]),
    (6, 13, &[1, 1, 1, 15, 21, 21]),
    (6, 16, &[1, 3, 1, 13, 27, 49]),
    (6, 19, &[1, 1, 1, 15, 7, 5]),
    (6, 22, &[1, 3, 1, 15, 13, 25]),
    (6, 25, &[1, 1, 5, 5, 19, 61]),
    (7, 1, &[1, 3, 7, 11, 23, 15, 103]),
    (7, 4, &[1, 3, 7, 13, 13, 15, 69]),
];

/// Most parameters that Sobol's sequence samples.
pub const MOST_OF_SOBOL: usize = POLYNOMIALS.len() + 1;

/// Number `sample`, from 0, of dimension `dimension`, from 0, of Sobol's sequence: above 0 and below 1.
///
/// # Panics
/// A dimension beyond [`MOST_OF_SOBOL`].
pub fn sobol(dimension: usize, sample: u32) -> f64 {
    let directions = directions(dimension);
    // In the order of Gray's code, as everybody counts it.
    let index = u64::from(sample) + 1;
    let gray = index ^ (index >> 1);
    let bits = (0..BITS).filter(|bit| gray >> bit & 1 == 1).fold(0, |bits, bit| bits ^ directions[bit]);
    f64::from(bits) / (1_u64 << BITS) as f64
}

fn directions(dimension: usize) -> [u32; BITS] {
    let mut numbers = [0_u32; BITS];
    let Some((degree, coefficients, first)) = dimension.checked_sub(1).map(|place| POLYNOMIALS[place]) else {
        return std::array::from_fn(|bit| 1 << (BITS - 1 - bit));
    };
    for bit in 0..BITS {
        numbers[bit] = if bit < degree {
            first[bit] << (BITS - 1 - bit)
        } else {
            let far = numbers[bit - degree];
            let own = far ^ (far >> degree);
            let taken = (1..degree).filter(|k| coefficients >> (degree - 1 - k) & 1 == 1);
            taken.fold(own, |sum, k| sum ^ numbers[bit - k])
        };
    }
    numbers
}

/// Where every one of `samples` lies in the range of a parameter: above 0, at most 1.
pub fn latin_hypercube(seed: u32, parameter: usize, samples: u32) -> Vec<f64> {
    let mut even = Draws::new(seed, SOURCE).even([parameter as i64, 0]);
    shuffled(&mut even, samples).into_iter().map(|share| (f64::from(share) + even()) / f64::from(samples)).collect()
}

/// 0 to `count` - 1 in an order of chance that is always the same.
pub(super) fn in_an_order_of_chance(count: u32) -> Vec<u32> {
    shuffled(&mut Draws::new(0, SOURCE).even([-1, 0]), count)
}

/// By Fisher and Yates.
fn shuffled(even: &mut impl FnMut() -> f64, count: u32) -> Vec<u32> {
    let mut numbers: Vec<u32> = (0..count).collect();
    for last in (1..numbers.len()).rev() {
        numbers.swap(last, ((even() * (last + 1) as f64) as usize).min(last));
    }
    numbers
}
