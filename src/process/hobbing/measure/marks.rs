//! The lattice of cutting marks on a hobbed flank: from the machine's motion, and from the surface itself, side by
//! side.
//!
//! **From kinematics** ([`crate::process::hobbing::linkage::marks`]): a gash leaves its mark where its rake face passes
//! the point in which worm, rack and gear touch. Neither the pitch curve nor the law in time enters: in the coordinates
//! (roll, z) the marks of an even feed are one lattice on every gear.
//!
//! **From the surface.** A patch about the pitch line in the middle of the face, regular in (roll, z), is cut by all
//! passes; the autocorrelation of its heights has peaks at the vectors from mark to mark. Nothing of the kinematics
//! enters but the size of the patch.
//!
//! Lengths and angles are those on the flank at the pitch line, where a step of roll is sin(alpha_t) long in the
//! transverse plane, and a step of z at constant roll 1 / cos(beta) along the tooth trace.

use crate::process::hobbing::HobCutter;
use crate::process::hobbing::linkage::marks::{MarkStep, Marks, shortest};
use gearcut_core::cut::Backend;
use gearcut_core::dexel::{NO_PASS, Ray, SpatialField};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::TURN_RAD;
use glam::DVec2;

/// Lower peaks are chance: marks repeat with correlations above 0.9.
const SMALLEST_PEAK: f64 = 0.5;

/// A peak is the highest of so many lags to either side: along a ridge that crosses the grid askew, single lags stand
/// out that are no marks.
const LOBE: i64 = 8;
/// Points of the patch along roll and z.
const POINTS: usize = 121;
/// Lags of the autocorrelation reach a third of the patch to either side: it is so many steps of the lattice wide.
const STEPS: f64 = 4.4;
/// Steps that enclose a smaller area than this share of a rectangle's run along one line.
const ALONG_ONE_LINE: f64 = 0.2;
/// Steps within this share of each other count as equally long.
const EQUALLY_LONG: f64 = 1.02;

/// The lattice on one flank.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkLattice {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Flank.
    pub side: Side,
    /// The shortest two steps from the machine's motion.
    pub kinematic: [MarkStep; 2],
    /// The same from the surface, in the same order and direction, or why it shows none.
    pub surface: Result<[MarkStep; 2], String>,
}

/// Both lattices on the flank of `tooth` after the last operation.
///
/// # Errors
/// The backend's.
pub fn measure(cutter: &HobCutter, backend: &dyn Backend, tooth: u32, side: Side) -> Result<MarkLattice> {
    let job = cutter.job;
    let teeth = job.scene.gear.teeth;
    let marks = Marks { linkage: &job.finishing().linkage, target: &job.target, hob: &job.hob, side };
    let space = i64::from(tooth) - i64::from(side == Side::Right);
    let (gash, turned, _) = marks.nearest(space, teeth, 0.0);
    let spanning = [marks.to_next_gash(gash, turned), marks.to_same_tooth(gash, turned, teeth)];
    let length_per_roll = job.target.rack.pressure_angle_rad.sin();
    let kinematic = marks.reduced(spanning, length_per_roll);
    let lattice = |surface| MarkLattice { tooth, side, kinematic, surface };
    // A patch that holds the steps which are shortest in its own coordinates, and lies on the flank.
    let own = shortest(spanning, |step| step);
    let widest = |pick: fn(DVec2) -> f64| own.iter().map(|&step| pick(step).abs()).fold(0.0, f64::max);
    let half_mm = [widest(|step| step.x), widest(|step| step.y)].map(|step| 0.5 * STEPS * step);
    let target = cutter.target(tooth, side)?;
    let tip_roll_mm =
        -side.sign() * job.blank.addendum_mm / (length_per_roll * job.target.rack.pressure_angle_rad.cos());
    let room_mm = [target.form_roll_mm.abs().min(tip_roll_mm.abs()), 0.5 * job.scene.gear.face_width_mm];
    if half_mm[0] > room_mm[0] || half_mm[1] > room_mm[1] {
        return Ok(lattice(Err(format!(
            "the patch of {:.2} mm of roll and {:.2} mm along the axis that would show the steps is larger than the \
            flank",
            2.0 * half_mm[0],
            2.0 * half_mm[1]
        ))));
    }
    let place = |half_mm: f64, i: usize| half_mm * (2.0 * i as f64 / (POINTS - 1) as f64 - 1.0);
    let low_mm = -0.5 * job.scene.gear.module_mm;
    let field = SpatialField::new(POINTS, POINTS, low_mm, |column, row| {
        let contact = job.target.flank_contact(space, side, place(half_mm[0], column), place(half_mm[1], row));
        (Ray { origin_mm: contact.point_mm, normal: contact.normal }, job.scene.gear.module_mm)
    });
    let (layers, _) = cutter.cut_field(backend, &field)?;
    let finished = layers.last().expect("at least one operation");
    if finished.passes.contains(&NO_PASS) {
        return Ok(lattice(Err("no pass reached a place of the patch".to_owned())));
    }
    let heights: Vec<f64> = finished.heights_mm.iter().map(|&height| f64::from(height)).collect();
    let spacing_mm = half_mm.map(|half_mm| 2.0 * half_mm / (POINTS - 1) as f64);
    let length = |step: DVec2| marks.on_flank(step, length_per_roll).length_mm();
    let steps = autocorrelation_steps(&heights, [POINTS, POINTS], spacing_mm, length);
    let across = |a: DVec2, b: DVec2| {
        let [a, b] = [a, b].map(|step| marks.on_flank(step, length_per_roll).on_flank_mm);
        a.perp_dot(b).abs() > ALONG_ONE_LINE * a.length() * b.length()
    };
    let second = steps.first().and_then(|&first| steps[1..].iter().copied().find(|&step| across(first, step)));
    let (Some(&first), Some(second)) = (steps.first(), second) else {
        return Ok(lattice(Err("the heights repeat themselves in fewer than two directions".to_owned())));
    };
    let found = marks.reduced([first, second], length_per_roll);
    // Where the lattice is nearly rectangular, the longer step and its sum or difference with the shorter one are
    // equally long, and either may be taken.
    let [shorter, longer] = found;
    let pairs = [0.0, 1.0, -1.0]
        .map(|turns| [shorter, marks.on_flank(longer.step_mm + turns * shorter.step_mm, length_per_roll)])
        .into_iter()
        .filter(|[_, other]| other.length_mm() <= EQUALLY_LONG * longer.length_mm());
    Ok(lattice(Ok(like(pairs, kinematic))))
}

/// Steps of a lattice in the order and direction of those of another, from the pair that lies nearest: each of `others`
/// takes the nearer one, forwards or backwards.
fn like(pairs: impl Iterator<Item = [MarkStep; 2]>, others: [MarkStep; 2]) -> [MarkStep; 2] {
    let turned = |step: MarkStep, other: MarkStep| {
        let back = step.on_flank_mm.dot(other.on_flank_mm) < 0.0;
        if back { MarkStep { step_mm: -step.step_mm, on_flank_mm: -step.on_flank_mm, ..step } } else { step }
    };
    let apart = |pair: &[MarkStep; 2]| -> f64 {
        pair.iter().zip(&others).map(|(a, b)| a.on_flank_mm.distance(b.on_flank_mm)).sum()
    };
    pairs
        .flat_map(|[a, b]| [[a, b], [b, a]])
        .map(|[a, b]| [turned(a, others[0]), turned(b, others[1])])
        .min_by(|a, b| apart(a).total_cmp(&apart(b)))
        .expect("the pair that was found is among them")
}

/// Angle between two directions without arrows, rad, 0 to pi/2.
pub fn between_rad(a_rad: f64, b_rad: f64) -> f64 {
    let apart = (a_rad - b_rad).rem_euclid(0.5 * TURN_RAD);
    apart.min(0.5 * TURN_RAD - apart)
}

/// Steps from mark to mark as the surface shows them: peaks of its autocorrelation, nearest first by `length`, none the
/// negative of another.
///
/// `heights` stand on a regular grid, `count[0]` columns of `count[1]` rows, `spacing_mm` apart. Lags reach a third of
/// the grid, and steps shorter than eight points are not told from the marks themselves. A paraboloid through a peak's
/// neighbours places it between grid points.
pub fn autocorrelation_steps(
    heights: &[f64],
    count: [usize; 2],
    spacing_mm: [f64; 2],
    length: impl Fn(DVec2) -> f64,
) -> Vec<DVec2> {
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    let centered: Vec<f64> = heights.iter().map(|h| h - mean).collect();
    let reach = count.map(|n| (n / 3) as i64);
    let [columns, rows] = count.map(|n| n as i64);
    // Mean product of the overlapping parts, over their own powers: 1 for a surface that repeats itself.
    let correlation = |du: i64, dv: i64| {
        let (mut product, mut here, mut there) = (0.0, 0.0, 0.0);
        for column in du.max(0)..(columns + du).min(columns) {
            for row in dv.max(0)..(rows + dv).min(rows) {
                let a = centered[(column * rows + row) as usize];
                let b = centered[((column - du) * rows + row - dv) as usize];
                product += a * b;
                here += a * a;
                there += b * b;
            }
        }
        product / (here * there).sqrt()
    };
    let width = 2 * reach[1] + 1;
    // Half a plane of lags; the other half mirrors it.
    let lags: Vec<f64> = (0..=reach[0])
        .flat_map(|du| (-reach[1]..=reach[1]).map(move |dv| (du, dv)))
        .map(|(du, dv)| correlation(du, dv))
        .collect();
    let at = |du: i64, dv: i64| {
        let (du, dv) = if du < 0 { (-du, -dv) } else { (du, dv) };
        lags[(du * width + dv + reach[1]) as usize]
    };
    let is_peak = |du: i64, dv: i64| {
        let here = at(du, dv);
        let near = |center: i64, reach: i64| (center - LOBE).max(-reach)..=(center + LOBE).min(reach);
        near(du, reach[0]).all(|i| near(dv, reach[1]).all(|j| at(i, j) <= here))
    };
    let mut peaks: Vec<DVec2> = Vec::new();
    for du in 0..reach[0] {
        for dv in -reach[1] + 1..reach[1] {
            if (du == 0 && dv <= 0) || at(du, dv) < SMALLEST_PEAK || !is_peak(du, dv) {
                continue;
            }
            // Vertex of the paraboloid through the nine lags around: on a ridge that runs askew both directions belong
            // together.
            let d = |i: i64, j: i64| at(du + i, dv + j);
            let gradient = 0.5 * DVec2::new(d(1, 0) - d(-1, 0), d(0, 1) - d(0, -1));
            let (uu, vv) = (d(1, 0) - 2.0 * d(0, 0) + d(-1, 0), d(0, 1) - 2.0 * d(0, 0) + d(0, -1));
            let uv = 0.25 * (d(1, 1) - d(1, -1) - d(-1, 1) + d(-1, -1));
            let determinant = uu * vv - uv * uv;
            let vertex = DVec2::new(uv * gradient.y - vv * gradient.x, uv * gradient.x - uu * gradient.y) / determinant;
            let fine = DVec2::new(du as f64, dv as f64) + vertex.clamp(DVec2::NEG_ONE, DVec2::ONE);
            peaks.push(fine * DVec2::from_array(spacing_mm));
        }
    }
    peaks.sort_by(|a, b| length(*a).total_cmp(&length(*b)));
    peaks
}
