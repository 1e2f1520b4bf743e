//! The work on the page after any stroke: nodes and surfaces against rays that are cut by exactly these strokes, and
//! the places of the slider against the chips that its strokes take.

use gearcut::cut::cpu::Cpu;
use gearcut::dexel::blank_field::Slice;
use gearcut::dexel::intervals::{End, Span, contains};
use gearcut::dexel::removal::{EDGE_STEPS, Removal, RemovalWatch};
use gearcut::dexel::{BlankField, BlankGrid, NO_PASS};
use gearcut::math::planar_rays::{Family, RayRow};
use gearcut::output::report::viewer::work::OUTSIDE;
use gearcut::process;
use gearcut::process::hobbing::cut_section::HobbedSection;
use gearcut::process::hobbing::report::passes::passes;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::cut::section::CutSection;
use gearcut::scene::Scene;
use gearcut::steps::frames::section::SectionByStep;
use gearcut::steps::whole_blank;
use gearcut::tool::CuttingTool;
use glam::DVec2;
use std::path::Path;

/// Few strokes and coarse rays.
const SMALL: [&str; 3] = [
    "fields.blank.spacing_mm=0.3",
    "operation.rough.strokes_per_revolution=800",
    "operation.finish.strokes_per_revolution=1200",
];
/// A gear and a ring, roughed and finished.
const SHAPED: [&str; 2] = ["scenes/shaping/circular_m3_z24.toml", "scenes/shaping/internal_circle.toml"];
const HOBBED: [&str; 5] = [
    "gear.teeth=16",
    "operation.finish.axial_feed_mm_per_revolution=6",
    "tool.hob.length_mm=40",
    "fields.blank.spacing_mm=0.4",
    "fields.blank.slice_spacing_mm=4",
];

fn scene(path: &str, settings: &[&str]) -> Scene {
    let settings: Vec<String> = settings.iter().map(|&set| set.to_owned()).collect();
    process::load(Path::new(path), &settings).unwrap_or_else(|error| panic!("{error}")).scene
}

/// Nodes that are material after a pass.
fn left(removal: &Removal, pass: Option<u32>) -> Vec<bool> {
    let stays = |taken: u32| pass.is_none_or(|pass| taken > pass);
    removal.nodes.iter().map(|node| node.is_some_and(stays)).collect()
}

/// Nodes that rays along x have in material.
fn on_rays(field: &BlankField, slice: usize) -> Vec<bool> {
    let [rows, columns] = field.grid.rows;
    let rays = &field.slices[slice].rays[0];
    (0..rows.count).flat_map(|row| (0..columns.count).map(move |k| contains(&rays[row], columns.at_mm(k)))).collect()
}

fn differing(one: &[bool], other: &[bool]) -> usize {
    one.iter().zip(other).filter(|(one, other)| one != other).count()
}

/// Largest distance between the ends of material on the rays and where the finished work has them, mm, and how many
/// were compared: those between two nodes of which one is material.
fn worst_end_mm(removal: &Removal, grid: &BlankGrid, field: &BlankField) -> (f64, usize) {
    let [rows, columns] = &grid.rows;
    let solid = left(removal, Some(NO_PASS - 1));
    let (mut worst_mm, mut count) = (0.0_f64, 0);
    for family in [0, 1] {
        let (along, step) = if family == 0 { (columns, 1) } else { (rows, columns.count) };
        for (ray, spans) in field.slices[0].rays[family].iter().enumerate() {
            for edge in 0..along.count - 1 {
                let node = if family == 0 { ray * columns.count + edge } else { edge * columns.count + ray };
                if solid[node] == solid[node + step] {
                    continue;
                }
                let steps = f64::from(removal.edges[family][node]) / f64::from(EDGE_STEPS);
                let at_mm = along.at_mm(edge) + steps * along.spacing_mm;
                let ends = spans.iter().flat_map(|span| [span.low.at_mm, span.high.at_mm]);
                worst_mm = ends.map(|end_mm| (end_mm - at_mm).abs()).fold(f64::INFINITY, f64::min).max(worst_mm);
                count += 1;
            }
        }
    }
    (worst_mm, count)
}

fn end(at_mm: f64, pass: u32) -> End {
    End { pass, ..End::of_blank(at_mm, DVec2::X) }
}

/// Nodes at 0 to 9 mm on two rays from 0.4 to 8.6 mm; cuts from below on one of them.
#[test]
fn nodes_go_with_their_first_pass_and_surfaces_rest() {
    let row = |count| RayRow { first_mm: 0.0, spacing_mm: 1.0, count };
    let grid = BlankGrid { rows: [row(2), row(10)], slices_z_mm: vec![0.0], face_width_mm: 1.0 };
    let blank = vec![Span { low: end(0.4, NO_PASS), high: end(8.6, NO_PASS) }];
    let rays = [vec![blank; 2], vec![Vec::new(); 10]];
    let watch = RemovalWatch::new(&BlankField { grid, slices: vec![Slice { rays }] });
    for (pass, to_mm) in [(3, 2.4), (50, 2.7), (60, 4.2)] {
        watch.note(0, Family::X, 1, [end(-1.0, pass), end(to_mm, pass)]);
    }
    let [removal] = watch.finish().try_into().expect("a slice");
    let stays = Some(NO_PASS);
    let cut = [None, Some(3), Some(3), Some(60), Some(60), stays, stays, stays, stays, None];
    let uncut: Vec<_> = (0..10).map(|node| stays.filter(|_| (1..=8).contains(&node))).collect();
    assert_eq!(removal.nodes, [&uncut[..], &cut].concat());
    let at_mm = |node: usize| f64::from(removal.edges[0][node]) / f64::from(EDGE_STEPS);
    let half_step_mm = 0.5 / f64::from(EDGE_STEPS);
    // The blank's ends, what pass 3 leaves for 47 passes and not what pass 50 leaves for ten, the finished end.
    for (node, expected_mm) in [(0, 0.4), (8, 0.6), (10, 0.4), (12, 0.4), (14, 0.2), (18, 0.6)] {
        assert!((at_mm(node) - expected_mm).abs() <= half_step_mm, "node {node}: {} mm", at_mm(node));
    }
    assert_eq!(at_mm(11), 0.0, "both nodes go together");
}

/// After any stroke the nodes are those of the section after exactly these strokes, which stroke by stroke take more;
/// one stroke more or less is seen. In the end the surface is the section's between nodes, too.
#[test]
fn shaped_work_is_the_section_after_every_stroke() {
    for path in SHAPED {
        let job = ShapingJob::new(scene(path, &SMALL)).expect("can be cut");
        let field = whole_blank::field(&job.scene, &job.blank, true).expect("fits in memory");
        let watch = RemovalWatch::new(&field);
        job.cut_blank_watched(field, &watch);
        let [removal] = watch.finish().try_into().expect("a slice");
        let mut section = CutSection::new(&job).expect("fits in memory");
        let strokes = CutSection::strokes(&job);
        let blades = job.cutter.blade_count();
        let after = |stroke: usize| left(&removal, (stroke as u32 * blades).checked_sub(1));
        let (mut before, mut seen) = (usize::MAX, 0);
        for share in [0, 1, 5, 20, 40, 55, 70, 90, 100] {
            let until = strokes * share / 100;
            section.advance(until);
            let rays = on_rays(section.field(), 0);
            let drawn = if until == 0 { left(&removal, None) } else { after(until) };
            assert_eq!(differing(&drawn, &rays), 0, "{path}: after {until} of {strokes} strokes");
            let count = drawn.iter().filter(|&&node| node).count();
            assert!(count < before, "{path}: {count} nodes after {until} strokes, {before} before");
            before = count;
            seen += differing(&after((until + 1).min(strokes)), &rays);
        }
        assert!(seen > 0, "{path}: a stroke too many is not seen");
        let (worst_mm, count) = worst_end_mm(&removal, &section.field().grid, section.field());
        println!("{path}: {strokes} strokes, {seen} nodes of strokes too many, {count} ends {worst_mm:.5} mm off");
        let half_step_mm = 0.5 * 0.3 / f64::from(EDGE_STEPS);
        assert!(count > 2000 && worst_mm < half_step_mm * (1.0 + 1e-9), "{path}: {worst_mm} mm of {half_step_mm}");
    }
}

/// The same pass by pass, in the middle of the face.
#[test]
fn hobbed_work_is_the_section_after_every_pass() {
    let scene = scene("scenes/hobbing/circular_spur.toml", &HOBBED);
    let job = HobbingJob::new(&scene).expect("a gear");
    let cutter = HobCutter::new(&job).expect("passes");
    let field = whole_blank::field(&job.scene, &job.stock, true).expect("fits in memory");
    let watch = RemovalWatch::new(&field);
    cutter.cut_blank_watched(field, &watch).expect("hobs have sections");
    let [removal] = watch.finish().try_into().expect("a slice");
    let mut section = HobbedSection::new(&cutter).expect("a section");
    let steps = section.steps();
    for share in [10, 30, 50, 51, 70, 100] {
        let until = steps * share / 100;
        section.advance(until).expect("cuts");
        // Up to the pass of the next step; passes between the two are cut as well.
        let last = if until < steps { section.pass(until).1.pass - 1 } else { NO_PASS - 1 };
        let drawn = left(&removal, Some(last));
        assert_eq!(differing(&drawn, &on_rays(section.field(), 0)), 0, "after {until} of {steps} passes");
    }
    let (worst_mm, count) = worst_end_mm(&removal, &section.field().grid, section.field());
    println!("{steps} passes, {count} ends {worst_mm:.5} mm off");
    assert!(count > 500 && worst_mm < 0.5 * 0.4 / f64::from(EDGE_STEPS) * (1.0 + 1e-9), "{worst_mm} mm");
}

/// From place to place of the slider the slabs lose what the passes up to there take of the whole blank. Some 2 % for
/// seven slabs and nodes as areas; one place in ten off would be far more.
#[test]
fn slabs_lose_what_the_chips_are() {
    let scene = scene("scenes/hobbing/circular_spur.toml", &HOBBED);
    let job = HobbingJob::new(&scene).expect("a gear");
    let cutter = HobCutter::new(&job).expect("passes");
    let blank = cutter.cut_blank(&Cpu::default(), job.blank_field().expect("rays"), &|| true);
    let page = passes(&cutter, &blank.expect("cuts").expect("not stopped")).expect("fits in memory");
    let count = page.strokes.len();
    let gone_mm3 = |place: usize| -> f64 {
        let slabs = page.work.slabs.iter().map(|slab| {
            let gone = slab.gone_from.iter().filter(|&&from| from != OUTSIDE && usize::from(from) <= place).count();
            gone as f64 * page.work.spacing_mm.powi(2) * (slab.z_mm[1] - slab.z_mm[0])
        });
        slabs.sum()
    };
    let taken_mm3 = |place: usize| page.strokes[..place].iter().map(|stroke| stroke.taken[0]).sum::<f64>();
    let all_mm3 = taken_mm3(count);
    let worst = |shift: usize| {
        let off = (2..=8).map(|tenth| (gone_mm3(count * tenth / 10 + shift) - taken_mm3(count * tenth / 10)).abs());
        off.fold(0.0, f64::max) / all_mm3
    };
    println!("{count} passes take {all_mm3:.1} mm3; off by {:.4}, shifted by {:.4}", worst(0), worst(count / 10));
    assert!((gone_mm3(count) / all_mm3 - 1.0).abs() < 0.02, "{} of {all_mm3} mm3", gone_mm3(count));
    assert!(worst(0) < 0.04 && worst(count / 10) > 0.08, "{}, {}", worst(0), worst(count / 10));
}
