//! gearcut against two-dimensional polygon clipping stroke by stroke, the way gear cutting is usually simulated.
//!
//! Job: the finishing of the round gear m 3, z 24 with the cutter z0 20 in 1,440 strokes, one transverse section, in
//! one process. The peer, in one thread because strokes follow each other, subtracts the cutter's teeth, as polygons,
//! from the blank's outline once per stroke (i_overlay 9, 32-bit engine, its buffers kept between strokes). It runs
//! twice: on the outline as one polygon, and on an outline split into one sector per tooth space, so that a stroke
//! touches a few sectors only. gearcut cuts all 48 flanks and 24 roots, in one thread and in all; its time runs from
//! the scene to the heights: curve, targets, rays, plans and kernel.
//!
//! Distances are taken on the same rays for both: normals of the exact involute, every 20 um along the profile, 5 %
//! left out at either end. Two references answer two questions:
//!
//! * the **surface of the strokes**, the lowest involute over all strokes and cutter teeth, found on each ray from the
//!   involute's closed form: the error of the method;
//! * the **involute** that infinitely many strokes would leave: the error of the method and the scallops that 1,440
//!   strokes leave, whoever computes them.
//!
//! `cargo bench --bench polygon_clipping`; the same job with shapely: `benches/peers/shapely_clipping.py`.

mod common;
#[allow(
    dead_code,
    clippy::wildcard_imports,
    reason = "shared with the tests: a bench takes its part, and clippy lets test crates alone import a whole module"
)]
#[path = "../tests/suite/fixtures/paper.rs"]
mod scenes;

use gearcut::cut::cpu::Cpu;
use gearcut::dexel::Field;
use gearcut::frame::Rigid2;
use gearcut::gear::PitchCurveShape;
use gearcut::process::shaping::ShaperCutter;
use gearcut::process::shaping::ShapingJob;
use gearcut::scene::Scene;
use gearcut::scene::model::Fields;
use gearcut::terms::Side;
use gearcut::tool::involute::Involute;
use gearcut::tool::{CuttingTool, PlanarTool};
use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Solver;
use i_overlay::float::overlay::{FloatOverlay, OverlayOptions};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::time::{Duration, Instant};

const STROKES: u32 = 1440;
const TEETH: u32 = 24;
/// Spacing of the rays: a few per facet, about as many as the clipped outline has vertices.
const SPACING_MM: f64 = 0.02;
/// Chords of the peer's cutter flank; 40 put its outline 0.2 um rms off the surface of the strokes.
const CHORDS: [usize; 4] = [20, 40, 80, 160];
/// Share of the profile left out at either end.
const MARGIN: f64 = 0.05;
/// Rounds over all methods, in turn, so that a disturbance does not fall on one of them; the fastest run of each
/// counts.
const ROUNDS: usize = 3;

type Contour = Vec<[f64; 2]>;

fn scene() -> Scene {
    let mut scene = scenes::paper_scene(vec![scenes::operation("finish", scenes::NORMAL, 0.0, STROKES)]);
    scene.gear.pitch_curve = PitchCurveShape::Circle;
    scene.gear.teeth = TEETH;
    scene.fields = Fields { profile_spacing_mm: SPACING_MM, lead_spacing_mm: 30.0, ..scene.fields };
    scene
}

fn flanks() -> impl Iterator<Item = (u32, Side)> {
    (1..=TEETH).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)])
}

/// What gearcut made of the job.
struct Cut {
    /// Heights on the flanks, flank by flank, mm.
    heights_mm: Vec<Vec<f64>>,
    /// Number of rays, roots included.
    rays: usize,
    /// Time for curve, cutter and strokes; for targets and rays; for plans and kernel.
    parts: [Duration; 3],
}

/// Everything gearcut does, from the scene to the heights of all flanks and roots, in so many sections.
fn gearcut_flanks(backend: Cpu, rows: usize) -> Cut {
    let started = Instant::now();
    let job = ShapingJob::new(scene()).expect("a round gear");
    let prepared = started.elapsed();
    let rows_z_mm: Vec<f64> = (0..rows).map(|row| 0.05 * (row as f64 - (rows / 2) as f64)).collect();
    let section = |field: Field| Field { rows_z_mm: rows_z_mm.clone(), ..field };
    let places: Vec<(u32, Side)> = flanks().collect();
    let on_flanks = places.par_iter().map(|&(tooth, side)| section(job.flank_field(job.target_flank(tooth, side))));
    let on_roots = (1..=TEETH).into_par_iter().map(|space| section(job.root_field(space)));
    let fields: Vec<Field> = on_flanks.chain(on_roots).collect();
    let laid_out = started.elapsed();
    let rays = fields.iter().map(Field::len).sum();
    // Every section is cut, also where all of them are alike.
    let mut heights_mm: Vec<Vec<f64>> = fields
        .into_par_iter()
        .map(|field| {
            job.planar().cut_rows(&backend, &field).expect("native").layers[0]
                .heights_mm
                .iter()
                .map(|&h| h.into())
                .collect()
        })
        .collect();
    heights_mm.truncate(flanks().count());
    let parts = [prepared, laid_out.saturating_sub(prepared), started.elapsed().saturating_sub(laid_out)];
    Cut { heights_mm, rays, parts }
}

/// One cutter tooth as a polygon in its own frame: flanks of `chords` chords with equal arrow heights, a tip arc,
/// straight below the base circle.
fn tooth_polygon(cutter: &ShaperCutter, chords: usize) -> Vec<DVec2> {
    let tooth = cutter.involute().expect("involute flanks");
    let root_mm = tooth.base_radius_mm - 2.0;
    let flank = |side: f64| -> Vec<DVec2> {
        let involute: Involute = tooth.flank(side);
        let tip_roll = involute.roll_at_radius(cutter.tip_radius_mm);
        // The arrow height of a chord is r_b u du^2 / 8: equal steps of u^(3/2) make all of them equal.
        let on_flank = (0..=chords).map(|i| involute.point(tip_roll * (i as f64 / chords as f64).powf(2.0 / 3.0)));
        let root = root_mm * DVec2::from_angle(side * tooth.half_angle_rad);
        std::iter::once(root).chain(on_flank).collect()
    };
    let (mut outline, mut left) = (flank(-1.0), flank(1.0));
    let tip_rad = left[left.len() - 1].to_angle();
    outline
        .extend((1..16).map(|i| cutter.tip_radius_mm * DVec2::from_angle(tip_rad * (2.0 * f64::from(i) / 16.0 - 1.0))));
    left.reverse();
    outline.extend(left);
    outline
}

/// The blank's outline: one polygon, or one per tooth space.
fn blank_polygons(radius_mm: f64, sectors: u32) -> Vec<Vec<Contour>> {
    let arc = |from: f64, to: f64, count: u32| -> Contour {
        (0..=count)
            .map(|i| (DVec2::from_angle(from + (to - from) * f64::from(i) / f64::from(count)) * radius_mm).to_array())
            .collect()
    };
    if sectors == 1 {
        let mut whole = arc(0.0, TAU, 30 * TEETH);
        whole.pop();
        return vec![vec![whole]];
    }
    let pitch = TAU / f64::from(sectors);
    (0..sectors)
        .map(|sector| {
            let middle = pitch * f64::from(sector);
            let mut outline = arc(middle - 0.5 * pitch, middle + 0.5 * pitch, 30);
            outline.push([0.0, 0.0]);
            vec![outline]
        })
        .collect()
}

fn bounds<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> [DVec2; 2] {
    points.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], &p| {
        [low.min(DVec2::from_array(p)), high.max(DVec2::from_array(p))]
    })
}

/// Clips stroke by stroke; gives the edges of the outline that is left.
fn clip_strokes(job: &ShapingJob, chords: usize, sectors: u32) -> Vec<[DVec2; 2]> {
    let tooth = tooth_polygon(&job.cutter, chords);
    let blades: Vec<Rigid2> = (0..job.cutter.blade_count()).map(|blade| job.cutter.tool_from_blade(blade)).collect();
    let radius_mm = 0.5 * 3.0 * f64::from(TEETH) + job.blank.addendum_mm;
    let mut regions = blank_polygons(radius_mm, sectors);
    let boxes: Vec<[DVec2; 2]> = regions.iter().map(|region| bounds(region.iter().flatten())).collect();
    let mut overlay = FloatOverlay::<[f64; 2], i32>::new_empty(OverlayOptions::default(), Solver::default(), 1 << 14);
    let strokes = &job.finishing().strokes;
    for stroke in 0..strokes.count() {
        let pose = strokes.poses(stroke)[0];
        let teeth: Vec<(Contour, [DVec2; 2])> = blades
            .iter()
            .map(|tool_from_blade| {
                let work_from_blade = pose.after(tool_from_blade);
                tooth.iter().map(|&p| work_from_blade.point(p).to_array()).collect::<Contour>()
            })
            .filter(|contour| contour.iter().any(|&p| DVec2::from_array(p).length() < radius_mm))
            .map(|contour| {
                let bounds = bounds(contour.iter());
                (contour, bounds)
            })
            .collect();
        for (region, [low, high]) in regions.iter_mut().zip(&boxes) {
            let near: Vec<Contour> = teeth
                .iter()
                .filter(|(_, [l, h])| l.cmple(*high).all() && h.cmpge(*low).all())
                .map(|(contour, _)| contour.clone())
                .collect();
            if near.is_empty() {
                continue;
            }
            overlay.reinit_with_subj_and_clip(region, &near);
            *region = overlay.overlay(OverlayRule::Difference, FillRule::NonZero).into_iter().flatten().collect();
        }
    }
    let edges = |contour: &Contour| -> Vec<[DVec2; 2]> {
        let next = contour.iter().cycle().skip(1);
        contour.iter().zip(next).map(|(&a, &b)| [DVec2::from_array(a), DVec2::from_array(b)]).collect()
    };
    regions.iter().flatten().flat_map(edges).collect()
}

/// Height at which a ray crosses the outline, nearest to the target.
fn outline_height_mm(edges: &[[DVec2; 2]], origin: DVec2, normal: DVec2) -> f64 {
    let across = |p: DVec2| normal.perp_dot(p - origin);
    edges
        .iter()
        .filter(|[a, _]| a.distance_squared(origin) < 1.0)
        .filter_map(|&[a, b]| {
            let (u, v) = (across(a), across(b));
            ((u <= 0.0) != (v <= 0.0)).then(|| (a + (b - a) * (u / (u - v)) - origin).dot(normal))
        })
        .fold(f64::INFINITY, |best, h| if h.abs() < best.abs() { h } else { best })
}

/// Height at which a ray enters one cutter flank, from the closed form of the distance to an involute,
/// `r_b (sigma theta + u - atan u - psi_b)`.
fn involute_height_mm(cutter: &ShaperCutter, side: f64, origin: DVec2, direction: DVec2) -> Option<f64> {
    let tooth = cutter.involute()?;
    let r_b = tooth.base_radius_mm;
    let mut h = -0.05;
    for _ in 0..60 {
        let p = origin + h * direction;
        let u = ((p.length() / r_b).powi(2) - 1.0).max(0.0).sqrt();
        let distance = r_b * (side * p.to_angle() + u - u.atan() - tooth.half_angle_rad);
        let rate = DVec2::from_angle(p.to_angle() + side * (FRAC_PI_2 - u.atan())).dot(direction);
        if p.x <= 0.0 || rate > -0.05 {
            return None;
        }
        let step = distance / rate;
        h -= step;
        if step.abs() < 1e-14 {
            let radius_mm = (origin + h * direction).length();
            return (radius_mm <= cutter.tip_radius_mm && radius_mm > r_b + 1e-4).then_some(h);
        }
    }
    None
}

/// A ray of one flank and what the strokes leave on it, in closed form.
struct Station {
    flank: usize,
    column: usize,
    origin: DVec2,
    normal: DVec2,
    strokes_mm: f64,
}

fn stations(job: &ShapingJob) -> Vec<Station> {
    let strokes = &job.finishing().strokes;
    let mut stations = Vec::new();
    for (index, (tooth, side)) in flanks().enumerate() {
        let flank = job.target_flank(tooth, side);
        let evaluated = MARGIN * flank.length_mm()..(1.0 - MARGIN) * flank.length_mm();
        for (column, ray) in job.flank_field(flank).columns.iter().enumerate() {
            if !evaluated.contains(&ray.arc_mm) {
                continue;
            }
            let mut strokes_mm = f64::INFINITY;
            for stroke in 0..strokes.count() {
                let pose = strokes.poses(stroke)[0];
                if pose.translation_mm.distance(ray.origin_mm) > job.cutter.tip_radius_mm {
                    continue;
                }
                for blade in 0..job.cutter.blade_count() {
                    let blade_from_work = pose.after(&job.cutter.tool_from_blade(blade)).inverse();
                    let (o, n) = (blade_from_work.point(ray.origin_mm), blade_from_work.direction(ray.normal));
                    let height = involute_height_mm(&job.cutter, side.sign(), o, n).filter(|h| *h > -1.5);
                    strokes_mm = height.map_or(strokes_mm, |h| strokes_mm.min(h));
                }
            }
            stations.push(Station { flank: index, column, origin: ray.origin_mm, normal: ray.normal, strokes_mm });
        }
    }
    stations
}

/// Root mean square and largest magnitude, um.
fn rms_and_largest_um(distances_mm: impl Iterator<Item = f64>) -> [f64; 2] {
    let (mut sum, mut largest, mut count) = (0.0, 0.0_f64, 0.0);
    for distance in distances_mm {
        sum += distance * distance;
        largest = largest.max(distance.abs());
        count += 1.0;
    }
    [1e3 * (sum / f64::max(count, 1.0)).sqrt(), 1e3 * largest]
}

fn row(what: &str, time: Duration, size: &str, heights_mm: &[f64], stations: &[Station]) {
    let [off_strokes, worst] =
        rms_and_largest_um(stations.iter().zip(heights_mm).map(|(s, height)| height - s.strokes_mm));
    let [off_involute, _] = rms_and_largest_um(heights_mm.iter().copied());
    let ms = 1e3 * time.as_secs_f64();
    println!("| {what} | {ms:.1} | {size} | {off_strokes:.2e} | {worst:.2e} | {off_involute:.4} |");
}

/// A method of cutting: its name, and how it is run; gives the size of its result, the heights at the stations, and the
/// time of its parts if it has any.
type Method<'a> = (String, Box<dyn Fn() -> Outcome + 'a>);

/// What one run of a method gave.
struct Outcome {
    time: Duration,
    size: String,
    heights_mm: Vec<f64>,
    parts: Option<[Duration; 3]>,
}

fn main() {
    println!("{}", common::machine());
    println!("m 3, z 24, z0 20, {STROKES} strokes; fastest of {ROUNDS} runs\n");
    let job = ShapingJob::new(scene()).expect("a round gear");
    let stations = stations(&job);
    let [scallops, highest] = rms_and_largest_um(stations.iter().map(|s| s.strokes_mm));
    println!(
        "{} rays compared; surface of the strokes: {scallops:.4} um rms off the involute, highest scallop {highest:.4} \
        um\n",
        stations.len()
    );
    let (job, stations) = (&job, &stations);
    let threads = |count: usize| rayon::ThreadPoolBuilder::new().num_threads(count).build().expect("threads");
    let pools = [("one thread", threads(1)), ("all threads", threads(0))];
    let mut methods: Vec<Method> = Vec::new();
    for backend in common::backends() {
        for (rows, sections) in [(1, "one section"), (601, "601 sections")] {
            for (crew, pool) in &pools {
                let cut = move || {
                    let started = Instant::now();
                    let cut = pool.install(|| gearcut_flanks(backend, rows));
                    let time = started.elapsed();
                    let height = |s: &Station| cut.heights_mm[s.flank][s.column * rows + rows / 2];
                    let heights_mm = stations.iter().map(height).collect();
                    Outcome { time, size: format!("{} rays", cut.rays), heights_mm, parts: Some(cut.parts) }
                };
                methods.push((format!("gearcut, {}, {crew}, {sections}", backend.instruction_set()), Box::new(cut)));
            }
        }
    }
    for (sectors, layout) in [(1, "one outline"), (TEETH, "24 sectors")] {
        for chords in CHORDS {
            let clip = move || {
                let started = Instant::now();
                let edges = clip_strokes(job, chords, sectors);
                let time = started.elapsed();
                let heights_mm = stations.iter().map(|s| outline_height_mm(&edges, s.origin, s.normal)).collect();
                Outcome { time, size: format!("{} edges", edges.len()), heights_mm, parts: None }
            };
            methods.push((format!("clipping, {layout}, {chords} chords per flank, one section"), Box::new(clip)));
        }
    }
    let mut best: Vec<Option<Outcome>> = methods.iter().map(|_| None).collect();
    for _ in 0..ROUNDS {
        for ((_, run), best) in methods.iter().zip(&mut best) {
            let outcome = run();
            if best.as_ref().is_none_or(|b| outcome.time < b.time) {
                *best = Some(outcome);
            }
        }
    }
    println!(
        "| method | time, ms | size of the result | off the strokes' surface: rms, um | largest, um | off the \
        involute: rms, um |"
    );
    println!("| --- | --- | --- | --- | --- | --- |");
    let outcomes: Vec<(&str, Outcome)> =
        methods.iter().zip(best).filter_map(|((what, _), best)| Some((what.as_str(), best?))).collect();
    for (what, Outcome { time, size, heights_mm, .. }) in &outcomes {
        row(what, *time, size, heights_mm, stations);
    }
    println!();
    for (what, outcome) in &outcomes {
        let Some(parts) = outcome.parts else { continue };
        let [prepared, laid_out, cut] = parts.map(|part| 1e3 * part.as_secs_f64());
        println!(
            "{what}: {prepared:.1} ms curve, cutter, strokes; {laid_out:.1} ms targets and rays; {cut:.1} ms plans and \
            kernel"
        );
    }
    let in_one_section = |(what, _): &&(&str, Outcome)| what.ends_with("one thread, one section");
    let Some(ours) = outcomes.iter().filter(in_one_section).map(|(_, outcome)| outcome.time).min() else { return };
    for (what, outcome) in outcomes.iter().filter(|(_, outcome)| outcome.parts.is_none()) {
        println!(
            "{what}: {:.1} times the time of gearcut in one thread",
            outcome.time.as_secs_f64() / ours.as_secs_f64()
        );
    }
}
