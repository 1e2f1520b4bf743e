//! The GPU backend beside the native one: which adapter, which dexels count, how far apart.
//!
//! All dexels are compared. A difference above the bound is excused only where the native height itself is not
//! **stable**: where it moves by more than the bound when the ray is shifted sideways by 2 nm, because the ray grazes a
//! corner and hit or miss is a matter of a nanometre. Such dexels are counted, and must lie within the native heights
//! of that shift.
#![allow(dead_code, reason = "each test binary uses its own part")]

pub mod blank;

use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::cut::gpu::adapter::{AdapterWish, adapters};
use gearcut::cut::gpu::{Gpu, GpuOptions, OnGpuFailure};
use gearcut::dexel::{Field, Layer, Ray, SpatialField};
use gearcut::passes::{CutPlan, SweepPlan};
use gearcut::tool::edge::Edge;
use glam::DVec3;
use std::fmt;

/// Largest difference between the GPU's height and the native one.
pub const BOUND_NM: f64 = 10.0;
/// Sideways shift under which a height must be stable to be compared.
const SHIFT_MM: f64 = 2e-6;

/// Options of a test: outputs poisoned, every problem an error.
pub fn strict() -> GpuOptions {
    GpuOptions { on_failure: OnGpuFailure::Stop, memory_limit_bytes: None, poison_outputs: true }
}

/// The software adapter, chosen on purpose and named; a test without one fails.
pub fn software_gpu(options: GpuOptions) -> Gpu {
    let gpu = Gpu::new(AdapterWish::Software, options).unwrap_or_else(|problem| {
        let there: Vec<String> = adapters().iter().map(|a| a.facts.to_string()).collect();
        panic!("these tests need a software adapter: {problem}; adapters: {there:?}")
    });
    println!("on {}", gpu.name());
    gpu
}

/// How far two backends are apart over many dexels.
#[derive(Debug, Default)]
#[must_use = "a comparison that nobody looks at proves nothing"]
pub struct Parity {
    /// Differences, nm.
    differences_nm: Vec<f64>,
    worst: Option<(f64, String)>,
    /// Dexels that differ because they are not stable.
    pub unstable: usize,
    /// Unstable dexels outside the native heights of the shift.
    pub outside: usize,
    /// Dexels left by another pass.
    pub other_pass: usize,
    /// Outputs that no thread wrote, or that are no numbers.
    pub poisoned: usize,
    /// Largest change of a native height under the shift, nm.
    pub steepest_nm: f64,
    /// Dexels that some pass has cut.
    pub cut: usize,
}

impl Parity {
    /// Adds what two backends made of one field; `shifted`: the native layers with rays shifted to both sides.
    pub fn add(&mut self, place: &str, rows: usize, native: &Layer, shifted: &[Layer], gpu: &Layer) {
        for dexel in 0..native.heights_mm.len() {
            let layers = std::iter::once(native).chain(shifted);
            let heights: Vec<f64> = layers.map(|layer| f64::from(layer.heights_mm[dexel]) * 1e6).collect();
            let got = f64::from(gpu.heights_mm[dexel]) * 1e6;
            let blank = gpu.passes[dexel] == u32::MAX;
            self.poisoned += usize::from(!got.is_finite());
            self.cut += usize::from(!blank);
            self.other_pass += usize::from(native.passes[dexel] != gpu.passes[dexel]);
            let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
            let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let difference = (got - heights[0]).abs();
            self.steepest_nm = self.steepest_nm.max(high - low);
            if difference > BOUND_NM && high - low > BOUND_NM {
                self.unstable += 1;
                self.outside += usize::from(!(low - BOUND_NM..=high + BOUND_NM).contains(&got));
                continue;
            }
            if self.worst.as_ref().is_none_or(|(worst, _)| difference > *worst) {
                let passes = (native.passes[dexel], gpu.passes[dexel]);
                let at = format!("{place}, column {}, row {}, passes {passes:?}", dexel / rows, dexel % rows);
                self.worst = Some((difference, at));
            }
            self.differences_nm.push(difference);
        }
    }

    /// Adds another comparison.
    pub fn merge(&mut self, mut other: Self) {
        self.differences_nm.append(&mut other.differences_nm);
        if other.worst.as_ref().map(|w| w.0) > self.worst.as_ref().map(|w| w.0) {
            self.worst = other.worst;
        }
        self.unstable += other.unstable;
        self.outside += other.outside;
        self.other_pass += other.other_pass;
        self.poisoned += other.poisoned;
        self.cut += other.cut;
        self.steepest_nm = self.steepest_nm.max(other.steepest_nm);
    }

    /// Dexels compared or counted.
    pub fn count(&self) -> usize {
        self.differences_nm.len() + self.unstable
    }

    /// Median, 99 % quantile and maximum, nm.
    pub fn quantiles_nm(&self) -> [f64; 3] {
        let mut sorted = self.differences_nm.clone();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| sorted.get((share * (sorted.len().saturating_sub(1)) as f64) as usize).copied();
        [0.5, 0.99, 1.0].map(|share| at(share).unwrap_or(0.0))
    }

    /// What is wrong, if anything.
    pub fn verdict(&self) -> Result<(), String> {
        let allowed = (1e-5 * self.count() as f64).ceil() as usize;
        let max_nm = self.quantiles_nm()[2];
        let wrong = [
            (self.poisoned > 0, "outputs that are no numbers".to_owned()),
            (self.cut == 0, "nothing was cut".to_owned()),
            (max_nm > BOUND_NM, format!("{max_nm:.2} nm apart")),
            (self.outside > 0, format!("{} unstable dexels outside the heights of the shift", self.outside)),
            (self.unstable > allowed, format!("{} unstable dexels, {allowed} allowed", self.unstable)),
        ];
        match wrong.into_iter().find(|(is_wrong, _)| *is_wrong) {
            None => Ok(()),
            Some((_, what)) => Err(format!("{what}: {self}")),
        }
    }
}

impl fmt::Display for Parity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [median, q99, max] = self.quantiles_nm();
        let place = self.worst.as_ref().map_or("", |(_, place)| place.as_str());
        write!(
            f,
            "{} dexels ({} cut): median {median:.4} nm, q99 {q99:.4} nm, max {max:.4} nm at {place}; {} unstable, \
             {} by another pass, {:.0} nm under a shift of 2 nm",
            self.count(),
            self.cut,
            self.unstable,
            self.other_pass,
            self.steepest_nm
        )
    }
}

/// The field with every ray shifted sideways.
fn shifted(field: &Field, by_mm: f64) -> Field {
    let mut field = field.clone();
    for column in &mut field.columns {
        column.origin_mm += by_mm * column.normal.perp();
    }
    field
}

/// Runs one plan on both backends from the same layers and compares; gives what each left.
pub fn cut_both(
    gpu: &dyn Backend,
    place: &str,
    field: &Field,
    edge: &Edge,
    plan: &CutPlan,
    before: [&Layer; 4],
) -> (Parity, [Layer; 4]) {
    let native = Cpu::default();
    let run = |backend: &dyn Backend, field: &Field, before: &Layer| {
        let mut layer = before.clone();
        let stats = backend.cut(field, edge, plan, &mut layer).unwrap_or_else(|error| panic!("{place}: {error}"));
        assert_eq!(stats.unconverged, 0, "{place}: iterations of {} stopped short", backend.name());
        assert_eq!(stats.dexel_passes, plan.dexel_passes(), "{place}");
        layer
    };
    let layers = [
        run(&native, field, before[0]),
        run(&native, &shifted(field, SHIFT_MM), before[1]),
        run(&native, &shifted(field, -SHIFT_MM), before[2]),
        run(gpu, field, before[3]),
    ];
    let mut parity = Parity::default();
    let [center, left, right, got] = &layers;
    parity.add(place, field.rows(), center, &[left.clone(), right.clone()], got);
    (parity, layers)
}

/// A field in space with every ray shifted sideways along one of two directions.
fn shifted_in_space(field: &SpatialField, by_mm: [f64; 2]) -> SpatialField {
    SpatialField::new(field.columns(), field.rows(), field.low_mm, |column, row| {
        let ray = field.ray(column, row);
        let along = ray.normal.cross(DVec3::Z).normalize();
        let origin_mm = ray.origin_mm + by_mm[0] * along + by_mm[1] * ray.normal.cross(along);
        (Ray { origin_mm, ..ray }, f64::from(field.blank_mm[field.index(column, row)]))
    })
}

/// Runs one plan of sweeps on both backends from the blank and compares; gives the native layer, those of four shifts, and the GPU's.
pub fn cut_both_in_space(
    gpu: &dyn Backend,
    place: &str,
    field: &SpatialField,
    edge: &Edge,
    plan: &SweepPlan,
) -> (Parity, Layer, Vec<Layer>, Layer) {
    let run = |backend: &dyn Backend, field: &SpatialField| {
        let mut layer = field.blank_layer();
        let stats =
            backend.cut_spatial(field, edge, plan, &mut layer).unwrap_or_else(|error| panic!("{place}: {error}"));
        assert_eq!(stats.unconverged, 0, "{place}: iterations of {} stopped short", backend.name());
        (layer, stats.dexel_passes)
    };
    let native = |field: &SpatialField| {
        let (layer, visits) = run(&Cpu::default(), field);
        assert_eq!(visits, plan.dexel_passes(), "{place}");
        layer
    };
    let center = native(field);
    let shifts = [[SHIFT_MM, 0.0], [-SHIFT_MM, 0.0], [0.0, SHIFT_MM], [0.0, -SHIFT_MM]];
    let shifted: Vec<Layer> = shifts.map(|by| native(&shifted_in_space(field, by))).into();
    let (got, visits) = run(gpu, field);
    assert_eq!(visits, plan.tile_passes(), "{place}: shaders visit whole tiles");
    let mut parity = Parity::default();
    parity.add(place, field.rows(), &center, &shifted, &got);
    (parity, center, shifted, got)
}
