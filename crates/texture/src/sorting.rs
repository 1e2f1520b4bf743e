//! Heights sorted downwards, all of them or those that are looked for.
//!
//! In: heights with holes, and their ends. Out: all heights from the highest down, or the one of an index among them.
//! Law: classes of equal height part them, so that each class is sorted by itself, and a single index needs the heights
//! of its own class alone. Heights that all lie in a few classes take no longer than sorting without classes.

use rayon::prelude::*;

/// Heights laid into classes at a time.
const PART: usize = 1 << 18;
/// Heights of a class on average: few enough to be sorted in the nearest cache.
const IN_A_CLASS: usize = 256;
/// Sign of a float among its bits.
const SIGN: u64 = 1 << 63;

/// Whole number that is the smaller the higher a point lies: whole numbers are sorted faster than floats.
fn key(height: f64) -> u64 {
    let bits = height.to_bits();
    if height.is_sign_negative() { bits } else { !(bits | SIGN) }
}

/// Height of a key.
fn height(key: u64) -> f64 {
    f64::from_bits(if key & SIGN != 0 { key } else { !key & !SIGN })
}

/// Classes of equal height, from the highest down.
#[derive(Clone, Copy)]
struct HeightClasses {
    high_um: f64,
    per_um: f64,
    classes: usize,
}

impl HeightClasses {
    fn of(count: usize, [low, high]: [f64; 2]) -> Self {
        let classes = (count / IN_A_CLASS).clamp(1, 1 << 14);
        Self { high_um: high, per_um: if high > low { classes as f64 / (high - low) } else { 0.0 }, classes }
    }

    fn class(self, height_um: f64) -> usize {
        (((self.high_um - height_um) * self.per_um) as usize).min(self.classes - 1)
    }

    /// Where every class of some heights begins, and where the last ends; holes are left out.
    fn starts(self, heights_um: &[f64]) -> Vec<usize> {
        let mut starts = vec![0; self.classes + 1];
        measured(heights_um).for_each(|z| starts[self.class(z) + 1] += 1);
        for i in 0..self.classes {
            starts[i + 1] += starts[i];
        }
        starts
    }
}

/// Heights without the holes.
pub(crate) fn measured(heights_um: &[f64]) -> impl Iterator<Item = f64> {
    heights_um.iter().copied().filter(|z| !z.is_nan())
}

/// Keys of some heights, class after class.
struct ClassedKeys {
    keys: Vec<u64>,
    starts: Vec<usize>,
}

impl ClassedKeys {
    fn of(heights_um: &[f64], classes: HeightClasses) -> Self {
        let starts = classes.starts(heights_um);
        let mut next = starts.clone();
        let mut keys = vec![0; starts[classes.classes]];
        for z in measured(heights_um) {
            let place = &mut next[classes.class(z)];
            keys[*place] = key(z);
            *place += 1;
        }
        Self { keys, starts }
    }

    fn class(&self, class: usize) -> &[u64] {
        &self.keys[self.starts[class]..self.starts[class + 1]]
    }
}

/// Heights over `level_um`, sorted downwards; holes are left out.
pub(crate) fn sorted(heights_um: &[f64], ends_um: [f64; 2], level_um: f64) -> Vec<f64> {
    let classes = HeightClasses::of(heights_um.len(), ends_um);
    let parts: Vec<ClassedKeys> = heights_um.par_chunks(PART).map(|part| ClassedKeys::of(part, classes)).collect();
    let mut sorted_um = vec![0.0; parts.iter().map(|part| part.keys.len()).sum()];
    let mut rest = sorted_um.as_mut_slice();
    let mut places = Vec::with_capacity(classes.classes);
    for class in 0..classes.classes {
        let (place, after) = rest.split_at_mut(parts.iter().map(|part| part.class(class).len()).sum());
        places.push(place);
        rest = after;
    }
    places.into_par_iter().enumerate().for_each_init(Vec::new, |keys, (class, place)| {
        keys.clear();
        for part in &parts {
            keys.extend_from_slice(part.class(class));
        }
        keys.sort_unstable();
        for (z, &key) in place.iter_mut().zip(keys.iter()) {
            *z = height(key) - level_um;
        }
    });
    sorted_um
}

/// Single heights by their index among the sorted ones.
pub(crate) struct HeightSelection<'a> {
    heights_um: &'a [f64],
    classes: HeightClasses,
    /// Where every class begins among all heights, and where the last ends.
    starts: Vec<usize>,
    /// Keys of the classes that were looked into.
    sorted: Vec<(usize, Vec<u64>)>,
}

impl<'a> HeightSelection<'a> {
    pub(crate) fn of(heights_um: &'a [f64], ends_um: [f64; 2]) -> Self {
        let classes = HeightClasses::of(heights_um.len(), ends_um);
        let parts: Vec<Vec<usize>> = heights_um.par_chunks(PART).map(|part| classes.starts(part)).collect();
        let starts = (0..=classes.classes).map(|class| parts.iter().map(|part| part[class]).sum()).collect();
        Self { heights_um, classes, starts, sorted: Vec::new() }
    }

    /// Number of heights that are no holes.
    pub(crate) fn count(&self) -> usize {
        self.starts[self.classes.classes]
    }

    /// The height of an index downwards, um.
    pub(crate) fn nth_um(&mut self, index: usize) -> f64 {
        let class = self.starts.partition_point(|&start| start <= index) - 1;
        let known = self.sorted.iter().position(|(known, _)| *known == class).unwrap_or_else(|| {
            self.sorted.push((class, self.keys(class)));
            self.sorted.len() - 1
        });
        height(self.sorted[known].1[index - self.starts[class]])
    }

    /// Keys of a class, sorted.
    fn keys(&self, class: usize) -> Vec<u64> {
        let inside = |z: &f64| self.classes.class(*z) == class;
        let of_part = |part: &[f64]| measured(part).filter(inside).map(key).collect::<Vec<u64>>();
        let mut keys: Vec<u64> = self.heights_um.par_chunks(PART).flat_map_iter(of_part).collect();
        keys.sort_unstable();
        keys
    }
}
