//! The chip ledger against closed forms, against exact polygon clipping of the same strokes, and against the blank
//! field.

use crate::fixtures::paper::*;
use gearcut::cut::CutBlank;
use gearcut::cut::cpu::Cpu;
use gearcut::frame::Rigid2;
use gearcut::gear::PitchCurveShape;
use gearcut::material::EdgeForce;
use gearcut::passes::StrokeSet;
use gearcut::process::shaping::cut::chips::{ChipLedger, StrokeChips};
use gearcut::process::shaping::linkage::{CutterPose, StrokeSchedule};
use gearcut::process::shaping::scene::model::{Infeed, Shaping};
use gearcut::process::shaping::tool::edge_polygon::EdgeSide;
use gearcut::process::shaping::{PreparedOperation, ShapingJob};
use gearcut::tool::{CuttingTool, PlanarTool};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use std::f64::consts::TAU;
use std::path::Path;

fn ledger(job: &ShapingJob) -> ChipLedger {
    ChipLedger::new(job, &|| true).expect("not stopped")
}

/// Corners of thin chips that a single coarse ray finds: the surface of a chip on the other flank is not theirs. With
/// rays 0.05 mm apart the thickest chips of finishing are 64 and 42 um thick, after the first stroke of all.
#[test]
fn rays_far_apart_take_no_surface_of_another_chip() {
    for (scene, fine_mm) in [("sector_spiral", 0.0643), ("fourier_concave", 0.0420)] {
        let path = format!("scenes/shaping/{scene}.toml");
        let loaded = gearcut::load(Path::new(&path), &["fields.chips.spacing_mm=0.2".to_owned()]);
        let job = ShapingJob::new(loaded.unwrap_or_else(|problems| panic!("{problems}")).scene).expect("a gear");
        let chips = ledger(&job);
        let finishing = chips.operations.last().expect("an operation");
        let thickest = finishing.strokes[1..].iter().map(StrokeChips::thickest_anywhere_mm);
        let thickest_mm = thickest.fold(0.0, f64::max);
        println!("{scene}: {thickest_mm}");
        assert!(thickest_mm > 0.8 * fine_mm && thickest_mm < 1.3 * fine_mm, "{scene}: {thickest_mm}");
    }
}

fn cut_blank(job: &ShapingJob) -> CutBlank {
    job.cut_blank(&Cpu::default(), job.planar().blank_field().expect("fits in memory"), &|| true)
        .expect("the native backend")
        .expect("not stopped")
}

fn round_job(strokes: u32) -> ShapingJob {
    let mut scene = paper_scene(vec![operation("cut", NORMAL, 0.0, strokes)]);
    scene.gear.teeth = 24;
    scene.gear.pitch_curve = PitchCurveShape::Circle;
    ShapingJob::new(scene).expect("an ordinary gear")
}

/// Twice the signed area of a polygon, halved.
fn area(contour: &[[f64; 2]]) -> f64 {
    let next = contour.iter().cycle().skip(1);
    0.5 * contour.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
}

/// Area that each stroke takes from the blank, by clipping polygons with chords of some hundred nanometres.
fn clipped_areas(job: &ShapingJob) -> Vec<f64> {
    let mut blank: Vec<Vec<[f64; 2]>> = vec![
        (0..20_000)
            .map(|i| {
                let frame = job.curve.frame(TAU * f64::from(i) / 20_000.0);
                (frame.point_mm + job.blank.addendum_mm * frame.normal).to_array()
            })
            .collect(),
    ];
    let cutter = &job.cutter;
    let mut tooth = Vec::new();
    for segment in &cutter.edge().segments {
        let [from, to] = segment.y_range_mm;
        for i in 0..=80 {
            let y = from + (to - from) * f64::from(i) / 80.0;
            tooth.push(segment.blade_from_segment.point(glam::DVec2::new(segment.x_and_slope(y)[0], y)));
        }
    }
    tooth.push(glam::DVec2::ZERO);
    let total = |shape: &[Vec<[f64; 2]>]| shape.iter().map(|contour| area(contour)).sum::<f64>();
    let set = &job.operations[0].strokes;
    let mut left = total(&blank);
    (0..set.count())
        .map(|stroke| {
            let pose = set.poses(stroke)[0];
            let teeth: Vec<Vec<[f64; 2]>> = (0..cutter.blade_count())
                .map(|blade| pose.after(&cutter.tool_from_blade(blade)))
                .filter(|place| place.point(cutter.edge().center_mm).length() < 45.0)
                .map(|place| tooth.iter().map(|&p| place.point(p).to_array()).collect())
                .collect();
            blank = blank.overlay(&teeth, OverlayRule::Difference, FillRule::NonZero).into_iter().flatten().collect();
            let before = std::mem::replace(&mut left, total(&blank));
            before - left
        })
        .collect()
}

fn sections(chips: &ChipLedger) -> Vec<f64> {
    chips.operations[0].strokes.iter().map(|s| s.area_mm2).collect()
}

/// A job whose machine has its cutter elsewhere: pose by stroke coordinate.
fn moved(mut job: ShapingJob, pose: impl Fn(&StrokeSchedule, f64) -> CutterPose) -> ShapingJob {
    let PreparedOperation { strokes, schedule, .. } = &job.operations[0];
    let strokes = StrokeSet::new(0, &job.cutter, strokes.law, strokes.count(), |lambda| {
        let pose = pose(schedule, lambda);
        Rigid2::new(pose.angle_rad, pose.center_mm)
    });
    job.operations[0].strokes = strokes;
    job
}

/// A stroke is not made: the cutter stands where the one before stood.
fn without_stroke(job: ShapingJob, stroke: u32) -> ShapingJob {
    let missing = f64::from(stroke);
    moved(job, |schedule, lambda| {
        schedule.state(if (lambda - missing).abs() < 0.5 { missing - 1.0 } else { lambda }).pose
    })
}

/// The cutter stands too far from the work by so much.
fn drawn_back(job: ShapingJob, by_mm: f64) -> ShapingJob {
    moved(job, |schedule, lambda| {
        let pose = schedule.state(lambda).pose;
        CutterPose { center_mm: pose.center_mm + by_mm * pose.center_mm.normalize(), ..pose }
    })
}

/// Whether sections are those of exact polygons: their sum within a thousandth; strokes within what the ends of chips
/// allow, half a spacing of 0.05 mm at each of a few ends of chips some tenths of a millimetre thick.
fn sections_verdict(ours_mm2: &[f64], exact_mm2: &[f64]) -> Result<(), String> {
    let [taken, sum] = [ours_mm2, exact_mm2].map(|areas| areas.iter().sum::<f64>());
    let mut off: Vec<(f64, usize)> =
        ours_mm2.iter().zip(exact_mm2).enumerate().map(|(stroke, (a, b))| ((a - b).abs(), stroke)).collect();
    off.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (median, (worst, stroke)) = (off[off.len() / 2].0, off[off.len() - 1]);
    let told = format!(
        "sum {taken:.4} of {sum:.4} mm2; per stroke off by {median:.4} (median), {worst:.4} (worst, stroke {stroke}) \
        of {:.3}",
        sum / exact_mm2.len() as f64
    );
    println!("{told}");
    match ((taken / sum - 1.0).abs() < 1e-3, median < 0.01 && worst < 0.1) {
        (true, true) => Ok(()),
        (false, _) => Err(format!("the sum is off: {told}")),
        (_, false) => Err(format!("strokes are off: {told}")),
    }
}

#[test]
fn sections_are_those_of_exact_polygons_stroke_by_stroke() {
    let job = round_job(160);
    let exact = clipped_areas(&job);
    assert_eq!(sections_verdict(&sections(&ledger(&job)), &exact), Ok(()));
    // The comparison can fail: a stroke that was never made, whose chip the next one takes, and a cutter too far out.
    let missed = sections(&ledger(&without_stroke(round_job(160), 80)));
    let verdict = sections_verdict(&missed, &exact).expect_err("a stroke is missing");
    assert!(verdict.contains("strokes are off") && verdict.contains("stroke 8"), "{verdict}");
    let back = sections(&ledger(&drawn_back(round_job(160), 0.05)));
    let verdict = sections_verdict(&back, &exact).expect_err("the cutter stands 0.05 mm too far out");
    assert!(verdict.contains("the sum is off"), "{verdict}");
}

#[test]
fn the_ledger_and_the_blank_field_take_the_same_volume() {
    let scene = paper_scene(vec![operation("rough", NORMAL, 2.0, 420), operation("finish", NORMAL, 0.0, 420)]);
    let job = ShapingJob::new(scene).expect("the paper's gear");
    let blank = cut_blank(&job);
    let chips = ledger(&job);
    for (index, cut) in blank.cuts.iter().enumerate() {
        let removed = cut.removed_mm3.iter().fold(0.0, |sum, by_family| sum + 0.5 * (by_family[0] + by_family[1]));
        let taken = chips.area_mm2(index) * job.scene.gear.face_width_mm;
        println!("{taken:.1} of {removed:.1} mm3");
        assert!((taken / removed - 1.0).abs() < 1e-3, "{taken} of {removed}");
    }
}

#[test]
fn a_plunging_tooth_takes_chips_of_known_thickness() {
    // Strokes of 0.02 mm straight into the work: every place of the edge takes 0.02 mm times the share of its normal
    // along the line of centres.
    let mut scene = paper_scene(vec![operation("cut", NORMAL, 0.0, 240)]);
    scene.gear.teeth = 24;
    scene.gear.pitch_curve = PitchCurveShape::Circle;
    Shaping::of_mut(&mut scene).expect("shaping").operations[0].infeed = Infeed::Plunge { depth_mm: 6.0, strokes: 300 };
    Shaping::of_mut(&mut scene).expect("shaping").operations[0].window_rad = Some([0.0, 0.01]);
    let job = ShapingJob::new(scene).expect("an ordinary gear");
    let chips = ledger(&job);
    let operation = &chips.operations[0];
    let stations = chips.stations.len();
    let mut checked = 0;
    for stroke in 20..300 {
        let (row, sum) =
            (&operation.by_stroke.thickness_mm[stroke * stations..][..stations], &operation.strokes[stroke]);
        // Later the neighbouring teeth cut too, at an angle.
        if sum.chips != 1 {
            break;
        }
        let depth_mm = 0.75 + 0.02 * stroke as f64;
        for (station, &thickness) in chips.stations.iter().zip(row) {
            let expected = 0.02 * station.normal.x;
            // Within some spacings of its end, the chip's old surface is known less well.
            let deep = station.point_mm.x > job.cutter.tip_radius_mm - depth_mm + 0.25;
            if deep && station.to_corner_mm > 0.1 {
                let off = (f64::from(thickness) - expected).abs();
                assert!(off < 1e-4, "{stroke} {station:?}: {thickness} for {expected}");
                checked += 1;
            }
        }
        assert!((sum.thickest_mm[EdgeSide::Tip as usize] - 0.02).abs() < 1e-4);
        let difference = sum.thickest_mm[EdgeSide::Left as usize] - sum.thickest_mm[EdgeSide::Right as usize];
        assert!(difference.abs() < 1e-4, "{difference}");
        // Symmetric but for a station more on one side, where the chip ends.
        let station_n = job.material.on_element(0.02, 2.0 * chips.spacing_mm)[1];
        assert!(sum.work_torque_nmm.abs() < station_n * 50.0, "{}", sum.work_torque_nmm);
    }
    assert!(checked > 2000, "{checked} places");
}

#[test]
fn thickness_scales_with_the_feed() {
    let median = |strokes: u32| {
        let job = round_job(strokes);
        let chips = ledger(&job);
        let mut tips: Vec<f64> =
            chips.operations[0].strokes.iter().map(|s| s.thickest_mm[EdgeSide::Tip as usize]).collect();
        tips.sort_by(f64::total_cmp);
        tips[tips.len() / 2]
    };
    let (coarse, fine) = (median(480), median(960));
    println!("{coarse} and {fine} mm");
    assert!((coarse / fine - 2.0).abs() < 0.05, "{coarse} {fine}");
}

#[test]
fn forces_follow_from_section_and_contact_and_balance_the_torques() {
    let only_section = EdgeForce {
        cutting_n_per_mm2: 1000.0,
        cutting_edge_n_per_mm: 0.0,
        normal_n_per_mm2: 400.0,
        normal_edge_n_per_mm: 0.0,
    };
    let only_edge = EdgeForce {
        cutting_n_per_mm2: 0.0,
        cutting_edge_n_per_mm: 50.0,
        normal_n_per_mm2: 0.0,
        normal_edge_n_per_mm: 20.0,
    };
    for force in [only_section, only_edge] {
        let mut job = round_job(960);
        job.material = force;
        let strokes = ledger(&job).operations[0].strokes.clone();
        for (index, stroke) in strokes.iter().enumerate().take(700).skip(200) {
            let expected = if force.cutting_edge_n_per_mm == 0.0 {
                1000.0 * stroke.area_mm2
            } else {
                50.0 * stroke.contact_length_mm()
            };
            assert!((stroke.cutting_n / expected - 1.0).abs() < 0.04, "{index}: {} for {expected}", stroke.cutting_n);
            // Whatever the edge does, the torques about both axes differ by the tangential force at the centre
            // distance.
            let l = job.operations[0].schedule.state(index as f64).center_distance_mm;
            let balance = stroke.work_torque_nmm + stroke.cutter_torque_nmm + l * stroke.tangential_n;
            assert!(balance.abs() < 1e-6 * l * stroke.cutting_n, "{balance}");
            assert!(stroke.radial_n > 0.0, "the cut pushes the tool away");
        }
    }
}

#[test]
fn a_dropped_pass_turns_the_balance_red() {
    // Stroke by stroke against the blank field, which has other rays and another kernel.
    let job = round_job(480);
    let removed = &cut_blank(&job).cuts[0].removed_mm3;
    let width_mm = job.scene.gear.face_width_mm;
    let by_blank: Vec<f64> = removed
        .chunks(job.cutter.blade_count() as usize)
        .map(|passes| passes.iter().map(|pass| 0.5 * (pass[0] + pass[1])).sum::<f64>() / width_mm)
        .collect();
    // The largest difference of a stroke, as a share of the mean stroke; the first one takes a plug, the last ones meet
    // what it left.
    let mean_mm2 = by_blank.iter().sum::<f64>() / by_blank.len() as f64;
    let worst = |ledger: &[f64]| {
        let pairs = ledger.iter().zip(&by_blank).skip(1).take(440);
        pairs.map(|(a, b)| (a - b).abs() / mean_mm2).fold(0.0, f64::max)
    };
    let clean = sections(&ledger(&job));
    println!("strokes within {:.4} of the mean stroke", worst(&clean));
    assert!(worst(&clean) < 0.1);
    let parts = |ledger: &[f64]| (ledger.iter().sum::<f64>() / by_blank.iter().sum::<f64>() - 1.0).abs();
    // Chips that the ledger thinks thinner than the blank's: its cutter stands 0.05 mm further out.
    let thinner = sections(&ledger(&drawn_back(round_job(480), 0.05)));
    println!("sums within {:.1e}, {:.1e} with the cutter drawn back", parts(&clean), parts(&thinner));
    assert!(parts(&clean) < 1e-3 && parts(&thinner) > 1.5e-3);
    // A stroke that was never made: the next one takes both chips, and is found out by as much.
    let missed = sections(&ledger(&without_stroke(round_job(480), 200)));
    assert!(missed[200] < 0.01 * mean_mm2 && missed[201] > 1.8 * clean[201]);
    assert!(worst(&missed) > 0.9);
}

#[test]
fn a_raked_cutter_changes_forces_and_keeps_their_balance() {
    let with_rake = |rake_rad: f64| {
        let mut job = round_job(960);
        job.cutter_spec.rake_angle_rad = rake_rad;
        (ledger(&job).operations[0].strokes.clone(), job)
    };
    let (flat, _) = with_rake(0.0);
    let (raked, job) = with_rake(5_f64.to_radians());
    for (index, (stroke, flat)) in raked.iter().zip(&flat).enumerate().take(700).skip(200) {
        assert_eq!(stroke.area_mm2, flat.area_mm2, "rake changes forces, not shapes");
        // Flanks lose rake against the tip, to which the coefficients belong: a little more force, far below the share
        // of the angle.
        let more = stroke.cutting_n / flat.cutting_n - 1.0;
        assert!((1e-4..0.06).contains(&more), "{index}: {more}");
        let l = job.operations[0].schedule.state(index as f64).center_distance_mm;
        let balance = stroke.work_torque_nmm + stroke.cutter_torque_nmm + l * stroke.tangential_n;
        assert!(balance.abs() < 1e-6 * l * stroke.cutting_n, "{balance}");
        // Flanks with less rake are pushed away more; of that the pull along them takes a part back.
        assert!((1e-3..0.1).contains(&(stroke.radial_n / flat.radial_n - 1.0)), "{index}: {}", stroke.radial_n);
    }
}

#[test]
fn a_first_stroke_at_depth_stands_apart() {
    let job = round_job(480);
    let operation = &ledger(&job).operations[0];
    let entry = operation.entry().expect("no infeed");
    let (stroke, largest) = operation.largest(|s| s.cutting_n).expect("it cuts");
    println!("{} N on entry, {} N in stroke {stroke}", entry.cutting_n, largest.cutting_n);
    assert!(stroke > 0 && entry.cutting_n > 10.0 * largest.cutting_n);
    let mut scene = job.scene.clone();
    Shaping::of_mut(&mut scene).expect("shaping").operations[0].infeed =
        Infeed::Spiral { depth_mm: 6.0, angle_rad: 1.0 };
    let fed = &ledger(&ShapingJob::new(scene).expect("an ordinary gear")).operations[0];
    assert!(fed.entry().is_none());
    assert!(fed.largest(|s| s.cutting_n).expect("it cuts").1.cutting_n < 0.2 * entry.cutting_n);
}

#[test]
fn runs_past_the_first_turn_are_idle() {
    let mut scene = paper_scene(vec![operation("cut", NORMAL, 0.0, 240)]);
    scene.gear.teeth = 24;
    scene.gear.pitch_curve = PitchCurveShape::Circle;
    Shaping::of_mut(&mut scene).expect("shaping").operations[0].revolutions = 2;
    let job = ShapingJob::new(scene).expect("an ordinary gear");
    let operation = &ledger(&job).operations[0];
    // The second turn repeats the first: whole pitches apart, the same cutter angles come back.
    assert!(operation.idle() >= 200, "{} idle", operation.idle());
    assert!(operation.strokes[300..].iter().all(|s| s.area_mm2 < 1e-3));
}
