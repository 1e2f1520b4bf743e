//! Round gears that are cut with known errors, and what a statistic of fits to them promises.
//!
//! The cut goes to depth with its first stroke and ends over its own beginning, on the first and the last tooth. A
//! cutter of 20 teeth comes there with other teeth the second time: where it does not run true, the deeper of two
//! strokes remains, and heights bend as a knee. Both teeth are measured as a whole, as inspections do with the first.

use super::round::SCENE;
use gearcut::influence::budget::chosen;
use gearcut::influence::gear_grid::evenly;
use gearcut::influence::measured::MeasuredPoint;
use gearcut::process;
use gearcut::scene::error_parameters::{ErrorParameter, Shifted};
use gearcut::scene::{LoadedScene, Scene};
use gearcut::terms::Side;
use std::f64::consts::TAU;
use std::path::Path;

/// Standard deviation of every measured value, as on the machine of a good gauge room.
pub const NOISE_UM: f64 = 0.5;
/// Gears of a statistic.
pub const GEARS: usize = 50;
/// Gears of which the sources must be named rightly.
pub const NAMED_AT_LEAST: usize = 45;
/// Share of sizes within their 95 % intervals.
const HELD: std::ops::RangeInclusive<f64> = 0.90..=0.99;
/// Few teeth and strokes, for time.
pub const TEETH: u32 = 16;
const STROKES: u32 = 600;
/// Errors of this scene that a measuring machine sees beside the noise: those that do more than turn its teeth alike or
/// move a spur gear along its axis.
pub const SEEN: [&str; 14] = [
    "machine.errors.center_distance.drift_um_per_h",
    "machine.errors.center_distance.scale_um_per_m",
    "machine.errors.cutter.periodic_amplitudes_arcsec@1",
    "machine.errors.cutter.periodic_amplitudes_arcsec@2",
    "machine.errors.guide.radial_bow_um",
    "machine.errors.guide.radial_um_per_100mm",
    "machine.errors.guide.tangential_bow_um",
    "machine.errors.guide.tangential_um_per_100mm",
    "machine.errors.work.periodic_amplitudes_arcsec@1",
    "machine.errors.work.periodic_amplitudes_arcsec@2",
    "mounting.eccentricity_um",
    "mounting.wobble_um_per_100mm",
    "tool.shaper_cutter.pitch_errors_um",
    "tool.shaper_cutter.runout_um",
];

/// The scene.
pub fn coarse() -> LoadedScene {
    coarse_with(&[])
}

/// The scene with other settings.
pub fn coarse_with(others: &[String]) -> LoadedScene {
    let settings = [format!("gear.teeth={TEETH}"), format!("operation.finish.strokes_per_revolution={STROKES}")];
    process::parse(SCENE, "round.toml", Path::new(""), &[&settings[..], others].concat()).expect("a scene")
}

/// Places on both flanks of every tooth: of four teeth 9 x 3, of all others the middle.
pub fn places(loaded: &LoadedScene) -> Vec<MeasuredPoint> {
    let half_mm = 0.45 * loaded.scene.gear.face_width_mm;
    let mut found = Vec::new();
    process::prepare(&loaded.scene)
        .expect("a gear")
        .with_gear(&mut |gear| {
            for (tooth, side) in (1..=TEETH).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]) {
                let [columns, rows] = if [1, 6, 11, TEETH].contains(&tooth) { [9, 3] } else { [1, 1] };
                for u_mm in evenly(gear.evaluated_profile_mm(tooth, side)?, columns) {
                    let along = evenly([-half_mm, half_mm], rows);
                    found.extend(along.into_iter().map(|v_mm| MeasuredPoint {
                        tooth,
                        side,
                        u_mm,
                        v_mm,
                        deviation_um: 0.0,
                    }));
                }
            }
            Ok(())
        })
        .expect("flanks");
    found
}

/// Numbers that look random and are the same every time: Marsaglia's xorshift64*, and normal ones of them (Box and
/// Muller).
pub struct Random(pub u64);

impl Random {
    pub fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        ((self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    pub fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (TAU * self.uniform()).cos()
    }
}

/// Errors with which a gear is cut.
pub struct KnownErrors {
    /// Keys of their sources, in order.
    pub sources: Vec<String>,
    /// All parameters with their sizes.
    pub sizes: Vec<(ErrorParameter, f64)>,
}

impl KnownErrors {
    /// Two of the sources that are seen, each part of one to three natural steps to either side.
    pub fn draw(loaded: &LoadedScene, random: &mut Random) -> Self {
        let first = (random.uniform() * SEEN.len() as f64) as usize;
        let second = (first + 1 + (random.uniform() * (SEEN.len() - 1) as f64) as usize) % SEEN.len();
        let mut sources = vec![SEEN[first].to_owned(), SEEN[second].to_owned()];
        sources.sort_unstable();
        let usual = chosen(loaded, &[]).expect("all of them");
        let mut sizes = Vec::new();
        for parameter in usual.into_iter().filter(|parameter| sources.contains(&parameter.source)) {
            let sign = if random.uniform() < 0.5 { -1.0 } else { 1.0 };
            let size = sign * (1.0 + 2.0 * random.uniform()) * parameter.step;
            sizes.push((parameter, size));
        }
        Self { sources, sizes }
    }

    /// The scene with these errors.
    pub fn scene(&self, loaded: &LoadedScene) -> Scene {
        let mut shifted = Shifted::new(loaded);
        assert!(self.sizes.iter().all(|(parameter, size)| shifted.shift(parameter, *size)), "{:?}", self.sources);
        shifted.read(process::table()).expect("a scene").scene
    }

    /// The size of a parameter; 0 where it is none of these.
    pub fn size_of(&self, id: &str) -> f64 {
        self.sizes.iter().find(|(parameter, _)| parameter.id == id).map_or(0.0, |(_, size)| *size)
    }
}

/// What fits to many gears have found.
#[derive(Debug, Default, Clone, Copy)]
pub struct Tally {
    /// Gears of which the sources were named rightly, no more and no fewer.
    pub named: usize,
    /// Fitted sizes, and those of them within their intervals.
    pub sizes: usize,
    pub held: usize,
    /// Gears of which something was called unexplained.
    pub blamed: usize,
}

impl Tally {
    /// Counts a fitted size with half its interval.
    pub fn count(&mut self, [size, half]: [f64; 2], known: f64) {
        self.add((size - known).abs() <= half);
    }

    /// Counts a size that its interval holds or not.
    pub fn add(&mut self, held: bool) {
        self.sizes += 1;
        self.held += usize::from(held);
    }

    /// Whether 90 to 99 % of the sizes are within their intervals.
    pub fn holds(&self) -> bool {
        HELD.contains(&(self.held as f64 / self.sizes as f64))
    }
}
