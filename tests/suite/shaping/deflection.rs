//! Cutter and work that give way: the balance of every stroke against a closed form and against the ledger, and what it
//! leaves on flanks. [`super::deflection_polygons`] finds the balance by another road.

use super::flank_heights::compare_whole_field;
use super::machine_errors::{changes, job};
use crate::fixtures::closed_form;
use crate::fixtures::shaped_gear::shaped_gear;
use gearcut::cut::cpu::Cpu;
use gearcut::machine_errors::Deflection;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::cut::chips::{ChipLedger, deflections};
use gearcut::process::shaping::gear::measure::flank_deflection::at_pitch_point_mm;
use glam::DVec4;

/// A round gear, fed in over half a turn.
pub(super) const ROUND: &str =
    shaped_gear!("teeth = 24", 480, "overlap_deg = 30.0\n[operation.infeed.spiral]\ndepth_mm = 6.75\nangle_deg = 90.0");
/// All six compliances.
pub(super) const SOFT: [&str; 6] = [
    "machine.compliance.tool_radial_um_per_kn=9",
    "machine.compliance.tool_tangential_um_per_kn=7",
    "machine.compliance.tool_torsional_urad_per_nm=2",
    "machine.compliance.work_radial_um_per_kn=3",
    "machine.compliance.work_tangential_um_per_kn=4",
    "machine.compliance.work_torsional_urad_per_nm=1",
];

pub(super) fn found(job: &ShapingJob) -> Vec<Vec<Deflection>> {
    deflections(job, &|| true).expect("it settles").expect("not stopped")
}

fn yielding(text: &str, settings: &[&str]) -> ShapingJob {
    let rigid = job(text, settings);
    rigid.deflected(found(&rigid))
}

fn ledger(job: &ShapingJob) -> ChipLedger {
    ChipLedger::new(job, &|| true).expect("not stopped")
}

pub(super) fn with<'a>(settings: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    settings.iter().chain(more).copied().collect()
}

/// A cutter that is fed straight into the work by f a stroke, with a force K per depth and nothing else, is pushed back
/// by `d = C K (f + d') / (1 + C K)`, d' what the stroke before was pushed back by: the balance
/// `d = C F_0 / (1 + C K)` of the chip that the commanded stroke would take, F_0 = K (f + d'). K grows with the depth;
/// the ledger of the rigid machine has it.
#[test]
fn a_plunging_stroke_rests_where_the_closed_form_says() {
    let text = ROUND
        .replace("[operation.infeed.spiral]", "[operation.infeed.plunge]")
        .replace("depth_mm = 6.75\nangle_deg = 90.0", "depth_mm = 6.0\n    strokes = 300");
    let text = text.replace("overlap_deg = 30.0", "window_deg = [0.0, 0.6]");
    let forces = [
        "material.normal_edge_force_n_per_mm=0",
        "machine.compliance.tool_radial_um_per_kn=30",
        "fields.chips.spacing_mm=0.02",
    ];
    let rigid = job(&text, &forces);
    let (chips, deflected) = (ledger(&rigid), &found(&rigid)[0]);
    let (feed_mm, c) = (6.0 / 300.0, 30e-6);
    let (mut before_mm, mut checked) = (0.0, 0);
    for (stroke, of) in deflected.iter().enumerate().take(200) {
        let of_ledger = &chips.operations[0].strokes[stroke];
        if stroke < 60 {
            // Until the chip has its full length, K grows by leaps.
            before_mm = of.radial_mm;
            continue;
        }
        if of_ledger.chips != 1 {
            break;
        }
        let stiffness = of_ledger.radial_n / feed_mm;
        let exact_mm = c * stiffness * (feed_mm + before_mm) / (1.0 + c * stiffness);
        println!("stroke {stroke}: {:.3} um for {:.3}, C K = {:.2}", 1e3 * of.radial_mm, 1e3 * exact_mm, c * stiffness);
        assert!((of.radial_mm / exact_mm - 1.0).abs() < 5e-3, "stroke {stroke}: {} for {exact_mm}", of.radial_mm);
        assert!(of.tangential_mm == 0.0 && of.tool_rad == 0.0 && of.work_rad == 0.0, "only what yields moves");
        before_mm = of.radial_mm;
        checked += 1;
    }
    assert!(checked > 30, "{checked} strokes");
}

/// d = C F with the forces that the ledger, which knows nothing of deflections, finds in the displaced strokes.
#[test]
fn the_ledger_of_the_displaced_strokes_has_the_forces_that_displace_them() {
    for (text, settings) in [(ROUND.to_owned(), vec![]), (RING.to_owned(), vec![]), (ROUND.to_owned(), CRANK.to_vec())]
    {
        // The ledger lays its rays anew for the displaced strokes: ends of chips fall otherwise between them.
        let job = yielding(&text, &with(&with(&SOFT, &settings), &["fields.chips.spacing_mm=0.02"]));
        let chips = ledger(&job);
        // As lengths: turns at the radii of both spindles.
        let lengths = DVec4::new(1.0, 1.0, 30.0, 66.0);
        let c = job.machine.compliance.diagonal();
        let off_um = |chips: &ChipLedger| {
            let strokes = chips.operations[0].strokes.iter().zip(&job.operations[0].deflections);
            let cutting = strokes.filter(|(of, _)| !of.is_idle());
            let mut off: Vec<f64> = cutting
                .map(|(of, d)| {
                    let load = DVec4::new(of.radial_n, of.tangential_n, of.cutter_torque_nmm, of.work_torque_nmm);
                    1e3 * (lengths * (c * load - d.coordinates())).abs().max_element()
                })
                .collect();
            off.sort_by(f64::total_cmp);
            off
        };
        let off = off_um(&chips);
        let (median_um, worst_um) = (off[off.len() / 2], off[off.len() - 1]);
        let coordinates = job.operations[0].deflections.iter().map(|d| 1e3 * (lengths * d.coordinates()).abs());
        let largest_um = coordinates.fold(0.0, |most: f64, um| most.max(um.max_element()));
        println!(
            "{} strokes, up to {largest_um:.2} um, C F within {median_um:.4} um (median), {worst_um:.4} um (worst)",
            off.len()
        );
        assert!(off.len() > 300 && largest_um > 10.0, "{} strokes, {largest_um} um", off.len());
        assert!(median_um < 0.05 && worst_um < 0.015 * largest_um, "{median_um} um, {worst_um} um");
        // The comparison can fail: forces of strokes that are not displaced.
        let stiff = off_um(&ledger(&super::machine_errors::job(&text, &settings)));
        println!("without displacement {:.2} um (median), {:.2} um", stiff[stiff.len() / 2], stiff[stiff.len() - 1]);
        assert!(stiff[stiff.len() - 1] > 3.0 * worst_um && stiff[stiff.len() / 2] > 3.0 * median_um);
    }
}

const CRANK: [&str; 1] = ["operation.finish.feed_during_stroke=true"];
const RING: &str = shaped_gear!(
    "kind = \"internal\"\nteeth = 48",
    960,
    "overlap_deg = 30.0\n[operation.infeed.spiral]\ndepth_mm = 6.75\nangle_deg = 90.0"
);

/// Flanks stand where the deflection of the stroke that makes them at the pitch point says, told apart left and right.
#[test]
fn flanks_follow_the_deflection_of_their_strokes() {
    let softer = ["machine.compliance.work_torsional_urad_per_nm=20"];
    for (text, cases) in [(ROUND, &[&SOFT[..1], &SOFT[1..2], &SOFT[2..3], &softer][..]), (RING, &[&SOFT[..]])] {
        // `changes` counts 3600 strokes in a turn.
        let fine = ["operation.finish.strokes_per_revolution=3600", "fields.chips.spacing_mm=0.1"];
        for only in cases {
            let soft = yielding(text, &with(&fine, only));
            let rigid = job(text, &fine);
            let teeth = [3, 5, 7].map(|eighth| eighth * soft.scene.gear.teeth / 8);
            let places = changes(&rigid, &soft, &teeth);
            // The surface at the pitch point is left by one of the two strokes about it: what is nearer is compared.
            // Two that are far apart say nothing.
            let compared = places.iter().filter_map(|(place, found_mm)| {
                let of = |stroke: f64| at_pitch_point_mm(&soft, 0, stroke as usize)[usize::from(place.side < 0.0)];
                let about = [of(place.stroke.floor()), of(place.stroke.ceil())];
                let [low, high] = [about[0].min(about[1]), about[0].max(about[1])];
                (high - low < 2e-4).then_some((found_mm.clamp(low, high), *found_mm))
            });
            let found: Vec<(f64, f64)> = compared.collect();
            assert!(2 * found.len() >= places.len(), "{} of {} places", found.len(), places.len());
            let name = format!("{only:?}");
            let [largest_um, worst_um] = closed_form::differences_um(&name, &found, |expected_mm| *expected_mm);
            assert!(
                largest_um > 0.2 && worst_um < (0.01 * largest_um).max(0.005),
                "{name}: {worst_um} of {largest_um}"
            );
        }
    }
}

/// A round gear whose left flanks alone are still stock: the cut pushes the cutter towards larger work angles or back,
/// and turns the work, as the side says.
#[test]
fn an_imbalance_of_left_and_right_chips_turns_the_work() {
    let soft = yielding(ROUND, &SOFT);
    let chips = ledger(&soft);
    let mut both_ways = [0; 2];
    for (stroke, of) in
        chips.operations[0].strokes.iter().enumerate().filter(|(_, of)| of.thickest_anywhere_mm() > 0.01)
    {
        let deflection = soft.operations[0].deflections[stroke];
        // The work is pushed the other way than the tool.
        let torque = of.work_torque_nmm;
        if torque.abs() > 1e3 {
            assert!(deflection.work_rad * torque > 0.0, "{stroke}: {deflection:?} under {torque} N mm");
            both_ways[usize::from(torque > 0.0)] += 1;
        }
        assert!(deflection.radial_mm > 0.0, "the cut pushes an outer cutter away from the axis: {deflection:?}");
    }
    println!("{both_ways:?} strokes with torque clockwise and counter-clockwise");
    assert!(both_ways.iter().sum::<i32>() > 100);
    let ring = yielding(RING, &SOFT);
    for (stroke, of) in ledger(&ring).operations[0].strokes.iter().enumerate() {
        assert!(of.thickest_anywhere_mm() < 0.01 || ring.operations[0].deflections[stroke].radial_mm < 0.0);
    }
}

/// The chips of displaced strokes are what the dexels of the whole blank lose to them.
#[test]
fn deflected_chips_sum_to_the_volume_that_the_blank_loses() {
    let two = format!(
        "{}{}",
        ROUND.replace("\"finish\"", "\"rough\"\n    stock_per_flank_mm = 0.2"),
        ROUND.split("[[operation]]").nth(1).map(|finish| format!("[[operation]]{finish}")).expect("an operation")
    );
    let blank = |job: &ShapingJob| -> Vec<f64> {
        let field = job.planar().blank_field().expect("fits in memory");
        let cut = job.cut_blank(&Cpu::default(), field, &|| true).expect("the native backend").expect("not stopped");
        let removed = |of: &[[f64; 2]]| of.iter().map(|by_family| 0.5 * (by_family[0] + by_family[1])).sum();
        cut.cuts.iter().map(|cut| removed(&cut.removed_mm3)).collect()
    };
    let rays = ["fields.blank.spacing_mm=0.05", "fields.chips.spacing_mm=0.015"];
    let (soft, rigid) = (yielding(&two, &with(&SOFT, &rays)), job(&two, &rays));
    let (chips, without, lost) = (ledger(&soft), ledger(&rigid), blank(&soft));
    for (index, lost_mm3) in lost.into_iter().enumerate() {
        let taken_mm3 = chips.area_mm2(index) * soft.scene.gear.face_width_mm;
        println!("operation {index}: {taken_mm3:.1} of {lost_mm3:.1} mm3");
        assert!((taken_mm3 / lost_mm3 - 1.0).abs() < 1e-3, "{taken_mm3} of {lost_mm3}");
    }
    // What roughing leaves finishing takes.
    assert!(chips.area_mm2(0) < without.area_mm2(0) && chips.area_mm2(1) > without.area_mm2(1));
}

#[test]
fn a_machine_without_compliance_displaces_nothing() {
    let zero: Vec<String> = SOFT.iter().map(|key| format!("{}=0", key.split('=').next().expect("a key"))).collect();
    let zero: Vec<&str> = zero.iter().map(String::as_str).collect();
    let (plain, zero) = (job(ROUND, &[]), job(ROUND, &zero));
    assert!(zero.machine.compliance.is_none());
    assert!(found(&zero)[0].iter().all(|of| *of == Deflection::default()));
    let (a, b) = (&plain.operations[0].strokes, &zero.operations[0].strokes);
    assert!((0..a.count()).all(|stroke| a.poses(stroke) == b.poses(stroke)));
    assert_eq!(ledger(&plain), ledger(&zero));
}

#[test]
fn candidates_equal_brute_force_on_a_machine_that_yields() {
    for feed in ["operation.finish.feed_during_stroke=false", "operation.finish.feed_during_stroke=true"] {
        let soft = yielding(ROUND, &with(&SOFT, &["fields.flank.lead_spacing_um=5000", feed]));
        for (tooth, side) in [(8, gearcut::terms::Side::Left), (13, gearcut::terms::Side::Right)] {
            let field = soft.flank_field(soft.target_flank(tooth, side));
            compare_whole_field(&soft, &field, soft.finishing());
        }
    }
}

#[test]
fn one_thread_and_two_find_the_same_bits() {
    let rigid = job(ROUND, &SOFT);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| found(&rigid))
    };
    let bits = |of: &[Vec<Deflection>]| -> Vec<u64> {
        of.iter().flatten().flat_map(|d| d.coordinates().to_array().map(f64::to_bits)).collect()
    };
    assert_eq!(bits(&on(1)), bits(&on(2)));
}

/// Rays a millimetre apart lose thin chips, whose force then comes and goes. That settles all the same, near the
/// deflections of fine rays.
#[test]
fn rays_that_lose_thin_chips_settle() {
    let largest_mm = |spacing: &str| {
        let job = job(ROUND, &with(&SOFT, &[spacing]));
        found(&job)[0].iter().map(|of| of.radial_mm).fold(0.0, f64::max)
    };
    let (coarse_mm, fine_mm) = (largest_mm("fields.chips.spacing_mm=1"), largest_mm("fields.chips.spacing_mm=0.05"));
    println!("{coarse_mm} mm, with fine rays {fine_mm}");
    assert!((coarse_mm / fine_mm - 1.0).abs() < 0.3);
}
