//! Cut flanks against closed forms: marks of the blades, a blade that stands out, the slot's depth; candidates against
//! all passes; the device against the native backend.

use super::jobs::job;
use crate::fixtures::layers::{frames_apart_mm, same_but_for_frames, same_heights_but_for_frames};
use gearcut::bevel::ease_off::Setting;
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::{FreeRays, Layer};
use gearcut::passes::SweepPlan;
use gearcut::process::bevel::BevelJob;
use gearcut::process::bevel::measure::{self, MarkForm};
use gearcut::process::bevel::net::{self, Position};
use gearcut::terms::Side;
use gearcut::texture::{cut_window, windows};

/// The teeth of this pinion are undercut at the toe, 0.1 mm deep and beyond where flanks are evaluated: windows that no
/// scene asks for show the marks of blades, 0.27 um high, and no pit.
#[test]
fn windows_by_default_lie_where_flanks_are_evaluated() {
    let spacing = ["fields.flank.profile_spacing_um=40", "fields.flank.lead_spacing_um=40"];
    let job = job("crown_pinion", &spacing).expect("a gear");
    let windows = windows(&job).expect("windows");
    let left = windows.iter().find(|window| window.side == Side::Left).expect("a left flank");
    let surface = cut_window(&job, &Cpu::default(), left).expect("cut").heights.expect("a surface");
    let ends = |ends: [f64; 2], height_um: &f64| [ends[0].min(*height_um), ends[1].max(*height_um)];
    let [low_um, high_um] = surface.heights_um().iter().fold([f64::INFINITY, f64::NEG_INFINITY], ends);
    assert!((0.2..1.0).contains(&(high_um - low_um)), "{low_um} to {high_um} um");
}

const SIDES: [Side; 2] = [Side::Left, Side::Right];
/// Numerical resolution of the native backend on face-milled cones, mm.
const BOUND_MM: f64 = 1e-7;
/// A faster roll, whose marks stand far above the resolution.
const FAST: &str = "operation.finish.roll_speed_deg_per_s=20";

/// Rays round the middle of a flank: so many columns and rows so far apart, mm.
pub fn patch(job: &BevelJob, tooth: u32, side: Side, [columns, rows]: [usize; 2], step_mm: [f64; 2]) -> FreeRays {
    let middle_mm = 0.5 * job.target_of(side).length_mm();
    let places = |count: usize, step: f64, middle: f64| -> Vec<f64> {
        (0..count).map(|i| middle + step * (i as f64 - 0.5 * (count - 1) as f64)).collect()
    };
    let (arcs_mm, rows_mm) = (places(columns, step_mm[0], middle_mm), places(rows, step_mm[1], 0.0));
    job.rays_over(tooth, side, arcs_mm, rows_mm).expect("rays")
}

/// What the finishing operation leaves by itself.
fn finished(job: &BevelJob, tooth: u32, side: Side, rays: &FreeRays) -> Layer {
    let (layers, stats) = job.cut_field(&Cpu::default(), job.space_of(tooth, side), &rays.field).expect("cuts");
    assert_eq!(stats.unconverged, 0);
    layers.last().expect("an operation").clone()
}

fn heights_mm(layer: &Layer) -> impl Iterator<Item = f64> + '_ {
    layer.heights_mm.iter().map(|&height| f64::from(height))
}

/// Between two passes of a kind of blade the cone stands over its envelope by the closed form; nowhere does it go
/// below. A tilted head does the same.
#[test]
fn marks_have_their_height_and_go_down_to_the_target() {
    let tilted = ["machine.cradle.tilt_deg=2", "machine.cradle.swivel_deg=-40", "tool.face_mill.radius_mm=95.25", FAST];
    let jobs = [&[FAST][..], &tilted].map(|keys| job("five_linkage_printed", keys).expect("a gear"));
    for (job, side) in jobs.iter().flat_map(|job| SIDES.map(|side| (job, side))) {
        let MarkForm { spacing_mm, height_mm } = measure::marks(job, side).expect("a flank").expect("marks");
        // Two marks wide and high, in steps of a fiftieth of a mark.
        let rays = patch(job, 5, side, [120, 120], [0.02 * spacing_mm; 2]);
        let layer = finished(job, 5, side, &rays);
        let lowest_mm = heights_mm(&layer).fold(f64::INFINITY, f64::min);
        let highest_mm = heights_mm(&layer).fold(f64::NEG_INFINITY, f64::max);
        println!(
            "{side:?}: {lowest_mm:e} to {highest_mm:e} mm, {height_mm:e} mm in closed form, {spacing_mm} mm apart"
        );
        assert!(lowest_mm.abs() < BOUND_MM, "{lowest_mm:e} mm");
        // Within 1.2 marks the height of the ridges changes with the place by a few per cent.
        assert!((highest_mm / height_mm - 1.0).abs() < 0.05, "{highest_mm:e} of {height_mm:e} mm");
        // Passes of neighbouring facets follow each other by the two kinds of blades.
        let mut passes = layer.passes.clone();
        passes.sort_unstable();
        passes.dedup();
        assert!(passes.len() >= 2 && passes.windows(2).all(|pair| (pair[1] - pair[0]).is_multiple_of(2)), "{passes:?}");
        assert!(passes.iter().all(|&pass| job.slots.blade_of(pass) % 2 == job.kind_of(side).index() as u32));
    }
}

/// Blades pass from the first moment of the roll to the last, wherever the head's turn begins and ends: the ends of the
/// flanks have marks as high as their middle, in slots of any phase.
#[test]
fn marks_are_no_higher_where_the_roll_begins_and_ends() {
    let job = job("five_linkage_printed", &[FAST]).expect("a gear");
    for side in SIDES {
        let height_mm = measure::marks(&job, side).expect("a flank").expect("marks").height_mm;
        let [length_mm, half_mm] = [job.target_of(side).length_mm(), 0.5 * job.blank.face_width_mm];
        for tooth in [1, 14, 27, 40, 55] {
            let arcs_mm = (0..12).map(|i| length_mm * f64::from(i) / 11.0).collect();
            let rows_mm = (0..40).map(|i| half_mm * (f64::from(i) / 19.5 - 1.0)).collect();
            let rays = job.rays_over(tooth, side, arcs_mm, rows_mm).expect("rays");
            let layer = finished(&job, tooth, side, &rays);
            let highest_mm = heights_mm(&layer).fold(f64::NEG_INFINITY, f64::max);
            // Marks lie farther apart at the heel: their height goes with the square of that.
            assert!(highest_mm < 3.0 * height_mm, "tooth {tooth} {side:?}: {highest_mm:e} of {height_mm:e} mm");
        }
    }
}

/// With a modified roll, marks go down to the target of the modified roll as they do to that of an even one.
#[test]
fn a_modified_roll_is_cut_as_its_target_says() {
    let modified = ["machine.cradle.modified_roll_c=0.008", "machine.cradle.modified_roll_d=-0.03"];
    let [even, job] =
        [&[FAST][..], &[&modified[..], &[FAST]].concat()].map(|set| job("five_linkage_printed", set).expect("a gear"));
    for side in SIDES {
        let MarkForm { spacing_mm, .. } = measure::marks(&job, side).expect("a flank").expect("marks");
        let (mut lowest_mm, mut farthest_mm) = (f64::INFINITY, 0.0_f64);
        for (along_mm, share) in [(-15.0, 0.2), (0.0, 0.5), (15.0, 0.8)] {
            let arc_mm = share * job.target_of(side).length_mm();
            let even_places = |middle: f64| {
                (0..60).map(|i| middle + 0.025 * spacing_mm * (f64::from(i) - 29.5)).collect::<Vec<f64>>()
            };
            let rays = job.rays_over(5, side, even_places(arc_mm), even_places(along_mm)).expect("rays");
            lowest_mm = lowest_mm.min(heights_mm(&finished(&job, 5, side, &rays)).fold(f64::INFINITY, f64::min));
            // Alive: an even roll leaves another flank.
            let other = finished(&even, 5, side, &rays);
            farthest_mm = heights_mm(&other).map(f64::abs).fold(farthest_mm, f64::max);
        }
        println!("{side:?}: down to {lowest_mm:e} mm; an even roll is {farthest_mm} mm off");
        assert!(lowest_mm.abs() < BOUND_MM, "{lowest_mm:e} mm");
        assert!(farthest_mm > 0.002, "{farthest_mm} mm");
    }
}

/// Marks counted along the profile and along the tooth give the distance of their lines in the flank.
#[test]
fn marks_are_as_far_apart_as_their_closed_form() {
    let job = job("five_linkage_printed", &[]).expect("a gear");
    for side in SIDES {
        // Way from the first to the last change of marks on a line of dexels, and marks on it, counted in time.
        let marks = |size: [usize; 2], step_mm: [f64; 2]| {
            let rays = patch(&job, 5, side, size, step_mm);
            let layer = finished(&job, 5, side, &rays);
            let changes: Vec<usize> =
                (1..layer.passes.len()).filter(|&i| layer.passes[i] != layer.passes[i - 1]).collect();
            let [first, last] = [changes[0], changes[changes.len() - 1]];
            let at = |i: usize| rays.field.ray(i / size[1], i % size[1]).origin_mm;
            let grows = if layer.passes[last] > layer.passes[first] { 1.0 } else { -1.0 };
            (at(last) - at(first), grows * (changes.len() - 1) as f64)
        };
        let ((a, n_a), (b, n_b)) = (marks([800, 1], [0.0025, 1.0]), marks([1, 800], [1.0, 0.01]));
        let (aa, ab, bb) = (a.dot(a), a.dot(b), b.dot(b));
        let per_mm = ((n_a * bb - n_b * ab) * a + (n_b * aa - n_a * ab) * b) / (aa * bb - ab * ab);
        let share = 1.0 / per_mm.length() / measure::marks(&job, side).expect("a flank").expect("marks").spacing_mm;
        println!("{side:?}: {n_a} and {n_b} marks, {share} of the closed form");
        // The distance changes by some per cent over the lines.
        assert!((share - 1.0).abs() < 0.05, "{side:?}: {share}");
    }
}

/// A blade that stands out by d leaves d cos(blade angle) below the target where it passes, and its neighbours reach
/// the surface no more.
#[test]
fn a_blade_that_stands_out_leaves_the_flank() {
    let runouts = "tool.face_mill.runouts_um=[0, 0, 0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]";
    let job = job("five_linkage_printed", &[runouts]).expect("a gear");
    for side in SIDES {
        let rays = patch(&job, 1, side, [40, 60], [0.05, 0.1]);
        let layer = finished(&job, 1, side, &rays);
        let lowest_mm = heights_mm(&layer).fold(f64::INFINITY, f64::min);
        let stands_out = job.kind_of(side).index() == 0;
        let wanted_mm = if stands_out { -0.01 * 20_f64.to_radians().cos() } else { 0.0 };
        // Every eighth mark, whose bottom a dexel may miss by 0.05 mm of its 0.8: 1e-8 mm.
        assert!((lowest_mm - wanted_mm).abs() < 2.0 * BOUND_MM, "{side:?}: {lowest_mm:e} not {wanted_mm:e}");
        let by_that = layer.passes.iter().filter(|&&pass| job.slots.blade_of(pass) == 4).count();
        assert_eq!(by_that, if stands_out { layer.passes.len() } else { 0 }, "{side:?}");
    }
}

/// The plane of the tips stands parallel to the root cone: the slot misses the same depth everywhere, counted square to
/// the pitch cone.
#[test]
fn slots_are_as_deep_as_the_tips_stand() {
    let cpu = Cpu::default();
    for (scene, missed_mm) in [("five_linkage_printed", 0.746_364_5), ("five_linkage_corrected", -3.5e-5)] {
        let job =
            job(scene, &["fields.flank.profile_spacing_um=500", "fields.flank.lead_spacing_um=500"]).expect("a gear");
        assert!((job.depth_missed_mm() - missed_mm).abs() < 2e-6, "{} mm", job.depth_missed_mm());
        let report = |tooth, side| {
            let rays = job.rays(tooth, side).expect("rays");
            let (layers, _) = job.cut_field(&cpu, job.space_of(tooth, side), &rays.field).expect("cuts");
            measure::measure(&job, tooth, side, &rays, &layers).expect("measured")
        };
        let flanks = [report(1, Side::Left), report(2, Side::Right)];
        let slot = measure::slot(&job, &cpu, [&flanks[0], &flanks[1]]).expect("a slot");
        assert_eq!(slot.len(), 9);
        let off_mm = job.depth_missed_mm() / job.blank.dedendum_angle_rad().cos();
        for row in &slot {
            let depth_mm = row.depth_mm.expect("cut");
            // In the middle of the slot the tips stand a little beside the generatrix: a ten-thousandth of a
            // millimetre.
            assert!(
                (row.whole_depth_mm - depth_mm - off_mm).abs() < 2e-4,
                "{} mm of {off_mm}",
                row.whole_depth_mm - depth_mm
            );
        }
        // Slots open towards the heel: 5.2, 6.2 and 7.6 mm on the pitch cone, as the independent solver has them.
        let widths: Vec<f64> = slot.iter().map(|row| row.width_mm.expect("cut")).collect();
        assert!(widths.is_sorted(), "{widths:?}");
        if scene == "five_linkage_printed" {
            assert!((widths[4] - 6.2).abs() < 0.06, "{widths:?}");
        }
    }
}

/// With any spacing of rows and any points of the grid the slot is measured in the middle of the face, where the
/// blank's depth is known in closed form.
#[test]
fn a_slot_is_measured_in_the_middle_of_the_face() {
    let cpu = Cpu::default();
    for (spacing, points) in [(1000, 9), (1000, 6), (1900, 5)] {
        let settings = [format!("fields.flank.lead_spacing_um={spacing}"), format!("inspection.tooth_points={points}")];
        let coarse = "fields.flank.profile_spacing_um=800";
        let job = job("spiral_angle", &[&settings[0], &settings[1], coarse]).expect("a gear");
        let report = |tooth, side| {
            let rays = job.rays(tooth, side).expect("rays");
            let (layers, _) = job.cut_field(&cpu, job.space_of(tooth, side), &rays.field).expect("cuts");
            measure::measure(&job, tooth, side, &rays, &layers).expect("measured")
        };
        let slot = measure::slot(&job, &cpu, [&report(1, Side::Left), &report(2, Side::Right)]).expect("a slot");
        let middle = slot.iter().find(|row| row.along_mm == 0.0).expect("a row in the middle");
        // Teeth that get deeper in proportion to the cone distance.
        let blank = &job.blank;
        let outer_mm = blank.outer_addendum_mm + blank.outer_dedendum_mm;
        let angles = [blank.face_angle_rad - blank.pitch_angle_rad, blank.dedendum_angle_rad()].map(f64::tan);
        let wanted_mm = outer_mm - 0.5 * blank.face_width_mm * (angles[0] + angles[1]);
        println!("{spacing} um, {points} points: {} of {wanted_mm} mm", middle.whole_depth_mm);
        assert!((middle.whole_depth_mm - wanted_mm).abs() < 1e-9, "{} of {wanted_mm} mm", middle.whole_depth_mm);
        assert!(middle.width_mm.is_some() && (middle.depth_mm.expect("cut") - wanted_mm).abs() < 1e-3, "{middle:?}");
        assert!(slot.is_sorted_by(|a, b| a.along_mm < b.along_mm), "{slot:?}");
    }
}

#[test]
fn candidates_and_all_passes_leave_the_same_flank() {
    let formate = job("formate", &[]).expect("a gear");
    let rolled = job("five_linkage_corrected", &[FAST]).expect("a gear");
    for (job, tooth, side) in
        [(&rolled, 1, Side::Left), (&rolled, 31, Side::Right), (&formate, 1, Side::Left), (&formate, 31, Side::Right)]
    {
        // On the face of both.
        let rays = patch(job, tooth, side, [40, 80], [0.12, 0.3]);
        for operation in 0..job.operations.len() {
            let set = job.slots.of(operation, job.space_of(tooth, side));
            let plans =
                [SweepPlan::new, SweepPlan::brute_force, SweepPlan::in_patches].map(|plan| plan(&rays.field, set));
            assert!(plans[1].dexel_passes() > 4 * plans[0].dexel_passes());
            assert!(plans[1].dexel_passes() > 2 * plans[2].dexel_passes());
            let apart_mm = frames_apart_mm([&plans[0], &plans[2]]);
            let [layer, all, in_patches] = plans.map(|plan| {
                let mut layer = rays.field.blank_layer();
                Cpu::default().cut_spatial(&rays.field, &plan, &mut layer).expect("cuts");
                layer
            });
            assert!(layer == all, "tooth {tooth} {side:?}, operation {operation}");
            // Blades that plunge leave one surface during the dwell.
            let is_rolled = !job.operations[operation].settings.plunges();
            let same = if is_rolled { same_but_for_frames } else { same_heights_but_for_frames };
            same(&format!("tooth {tooth} {side:?}"), &in_patches, &all, apart_mm);
            assert!(layer != rays.field.blank_layer());
        }
    }
}

/// Roughing holds the head back along its axis: it leaves the offset times the sine of the blade angle.
#[test]
fn roughing_leaves_its_stock() {
    let job = job("five_linkage_corrected", &["tool.face_mill.runouts_um=[]"]).expect("a gear");
    for side in SIDES {
        let rays = patch(&job, 2, side, [10, 20], [0.05, 0.5]);
        let (layers, _) = job.cut_field(&Cpu::default(), job.space_of(2, side), &rays.field).expect("cuts");
        for (rough, finish) in heights_mm(&layers[0]).zip(heights_mm(&layers[1])) {
            // Not the same along a generated flank: the moment of contact moves with the head.
            assert!((rough - finish - 0.2).abs() < 2e-3, "{} mm", rough - finish);
        }
    }
}

#[cfg(feature = "gpu")]
#[test]
fn the_device_cuts_the_same_flanks() {
    use crate::fixtures::parity::{cut_both_in_space, software_gpu, strict};
    /// What the shaders add at most, nm, as with other face-mill heads: 1.11 measured.
    const SWEPT_NM: f64 = 2.0;
    let gpu = software_gpu(strict());
    let formate = job("formate", &[]).expect("a gear");
    for (tooth, side) in [(1, Side::Left), (40, Side::Right)] {
        let rays = patch(&formate, tooth, side, [32, 64], [0.1, 0.3]);
        let plan = SweepPlan::new(&rays.field, formate.slots.of(0, formate.space_of(tooth, side)));
        let (parity, _, _, _) = cut_both_in_space(&gpu, &format!("Formate, tooth {tooth}"), &rays.field, &plan);
        println!("{parity}");
        assert_eq!(parity.verdict_within(SWEPT_NM), Ok(()));
    }
    let job = job("five_linkage_corrected", &[FAST]).expect("a gear");
    for (tooth, side) in [(1, Side::Left), (40, Side::Right)] {
        let rays = patch(&job, tooth, side, [32, 64], [0.15, 0.5]);
        let plan = SweepPlan::new(&rays.field, job.slots.of(1, job.space_of(tooth, side)));
        let (parity, _, _, _) = cut_both_in_space(&gpu, &format!("tooth {tooth}"), &rays.field, &plan);
        println!("{parity}");
        assert_eq!(parity.verdict_within(SWEPT_NM), Ok(()));
        // The next slot's passes stand at another phase, and are seen.
        let other = SweepPlan::new(&rays.field, job.slots.of(0, job.space_of(tooth, side)));
        let mut layer = rays.field.blank_layer();
        gpu.cut_spatial(&rays.field, &other, &mut layer).expect("cuts");
        assert!(layer != finished(&job, tooth, side, &rays));
    }
}

/// A machine whose root angle is off cuts what its ease-off says, and the deviations name the error.
#[test]
fn errors_of_settings_are_cut_and_named() {
    let job = job("setting_errors", &["fields.flank.profile_spacing_um=400", "fields.flank.lead_spacing_um=1000"])
        .expect("a gear");
    for side in SIDES {
        let rays = job.rays(1, side).expect("rays");
        let (layers, _) = job.cut_field(&Cpu::default(), job.space_of(1, side), &rays.field).expect("cuts");
        let mut flank = measure::measure(&job, 1, side, &rays, &layers).expect("measured");
        let explained = measure::explained(&job, &flank).expect("flanks").expect("deviations");
        println!("{side:?}: {:?}", &explained[..2]);
        assert_eq!(explained[0].setting, Setting::RootAngle);
        assert!((explained[0].error.to_degrees() / 0.02 - 1.0).abs() < 0.01);
        // What is left are the marks: some nanometres.
        assert!(explained[0].left_rms_mm < 1e-5 && explained[1].left_rms_mm > 1e-4);
        // A plane put into the grid comes back as thickness, spiral and pressure angle; a bow adds to none of them.
        let [shares, along_mm] = flank.own.grid_places.clone();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let [x0, y0] = [mean(&along_mm), mean(&shares) * flank.length_mm];
        let bow = |x: f64| (x - x0).powi(2) - mean(&along_mm.iter().map(|x| (x - x0).powi(2)).collect::<Vec<_>>());
        for (i, point) in flank.own.grid.iter_mut().enumerate() {
            let [x, y] = [along_mm[i / shares.len()], shares[i % shares.len()] * flank.length_mm];
            point.deviation_mm = Some(0.004 + 3e-4 * (x - x0) - 5e-4 * (y - y0) + 1e-5 * bow(x));
        }
        let position = Position::of(&flank).expect("all of it was cut");
        assert!((position.middle_mm - 0.004).abs() < 1e-9 && (position.pressure_rad + 5e-4).abs() < 1e-12);
        assert!((position.spiral_rad / 3e-4 - 1.0).abs() < 0.05, "{position:?}");
        let drawn = net::svg(&flank, "tooth 1").expect("all of it was cut");
        assert_eq!(drawn.matches("<polyline").count(), 2 * (shares.len() + along_mm.len()));
        // The corner of toe and root 0.6 pm off the middle: no label is longer than a hundredth of the bar asks for.
        let others_mm: f64 = flank.own.grid[1..].iter().filter_map(|point| point.deviation_mm).sum();
        flank.own.grid[0].deviation_mm = Some(others_mm / (flank.own.grid.len() - 1) as f64 + 6e-10);
        let drawn = net::svg(&flank, "tooth 1").expect("all of it was cut");
        assert!(drawn.contains("text-anchor=\"end\">0.00</text>"), "{drawn}");
        flank.own.grid[3].deviation_mm = None;
        assert!(Position::of(&flank).is_none() && net::svg(&flank, "tooth 1").is_none());
    }
}
