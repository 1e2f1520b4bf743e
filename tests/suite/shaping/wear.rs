//! Wear of a shaper cutter's teeth: one tooth by hand, places of the edge against the involute's length, what wears
//! against what is taken.

use gearcut::measure::tool_wear::ToolWear;
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::cut::chips::ChipLedger;
use gearcut::process::shaping::cut::chips::stroke::{PlaceContact, ToothChip};
use gearcut::process::shaping::gear::measure::cutter_wear;
use gearcut::process::shaping::tool::edge_polygon::EdgePolygon;
use gearcut_core::passes::sections::swept_sections::{EDGE_PLACES, FLANK_PLACES};
use glam::DVec2;
use std::f64::consts::PI;
use std::path::Path;

/// A round gear in few strokes, with these constants of wear.
fn job(wear: &[&str]) -> ShapingJob {
    let mut settings: Vec<String> = wear.iter().map(|key| format!("tool.shaper_cutter.wear.{key}")).collect();
    settings.push("fields.chips.spacing_mm=0.03".to_owned());
    for operation in 0..2 {
        settings.push(format!("operation.{operation}.strokes_per_revolution=1200"));
    }
    let scene = load(Path::new("scenes/shaping/circular_m3_z24.toml"), &settings).unwrap_or_else(|e| panic!("{e}"));
    ShapingJob::new(scene.scene).expect("a scene that cuts")
}

fn ledger(job: &ShapingJob) -> ChipLedger {
    ChipLedger::new(job, &|| true).expect("not stopped")
}

/// Without chips: stations alone.
fn empty(job: &ShapingJob) -> ChipLedger {
    let none = 0;
    ChipLedger::of_spaces(job, 1..=none, &|| true).expect("not stopped")
}

#[test]
fn without_its_section_no_wear_is_computed() {
    let job = job(&[]);
    let ledger = ChipLedger::of_spaces(&job, 1..=1, &|| true).expect("not stopped");
    assert!(ledger.worn_by.is_empty() && cutter_wear::measure(&job, &ledger).is_none());
}

/// Tooth 3 cuts twice with all of its tip, over the face width F, through chips 0.2 mm and 0.05 mm thick: by x = 2 and
/// h_1 = 0.1 mm they count 4 and 1/4 times. The ram runs at pi times stroke and double strokes at most; v_1 is half of
/// it, so that with Taylor's n = 1/3 both count 2^2 times as much. A = F (4 + 1/4) 4 = 17 F, and with L_1 = 30 m a gear
/// wears VB = 0.2 mm 17 F / 30,000.
#[test]
fn wear_of_one_tooth_is_that_by_hand() {
    let vb_mm = |exponent: &str| {
        let plain = job(&["limit_mm=0.2", "life_m=30"]);
        let speed_m_per_min = {
            let strokes_per_minute = plain.finishing().schedule.double_strokes_per_minute();
            let machine = &plain.machine;
            let stroke_mm = machine.approach_mm + plain.scene.gear.face_width_mm + machine.overrun_mm;
            PI * stroke_mm * strokes_per_minute / 1e3
        };
        let law = [
            "limit_mm=0.2".to_owned(),
            "life_m=30".to_owned(),
            "thickness_mm=0.1".to_owned(),
            format!("thickness_exponent={exponent}"),
            format!("taylor_exponent={}", 1.0 / 3.0),
            format!("speed_m_per_min={}", 0.5 * speed_m_per_min),
        ];
        let job = job(&law.each_ref().map(String::as_str));
        let mut ledger = empty(&job);
        let tip_mm = EdgePolygon::wear_place_lengths_mm(&ledger.stations)[FLANK_PLACES];
        let chip = |stroke, thickness_mm: f64| {
            let mut edge = [PlaceContact::default(); EDGE_PLACES];
            edge[FLANK_PLACES] = PlaceContact { length_mm: tip_mm, thick_mm2: tip_mm * thickness_mm };
            ToothChip {
                operation: 1,
                stroke,
                blade: 3,
                space: 1,
                area_mm2: 1.0,
                contact_mm: [0.0, tip_mm, 0.0],
                edge,
                thickest_mm: [0.0; 3],
                cutting_n: 0.0,
                side_force_n: DVec2::ZERO,
                work_torque_nmm: 0.0,
                cutter_torque_nmm: 0.0,
            }
        };
        ledger.worn_by = vec![chip(10, 0.2), chip(11, 0.05)];
        let worn = cutter_wear::measure(&job, &ledger).expect("the scene has it");
        assert_eq!(worn.by_constants.cost.first(), Some([3, FLANK_PLACES]));
        (0.2 / worn.by_constants.gears(), job.scene.gear.face_width_mm)
    };
    let (found_mm, face_mm) = vb_mm("2");
    let by_hand_mm = 0.2 * 17.0 * face_mm / 30e3;
    assert!((found_mm / by_hand_mm - 1.0).abs() < 1e-9, "{found_mm} against {by_hand_mm}");
    // A wrong exponent is seen.
    assert!((vb_mm("2.1").0 / by_hand_mm - 1.0).abs() > 0.05);
}

/// Between two radii an involute is (R^2 - r^2) / (2 r_b) long.
#[test]
fn places_of_a_flank_are_as_long_as_their_involute() {
    let job = job(&[]);
    let ledger = empty(&job);
    let lengths_mm = EdgePolygon::wear_place_lengths_mm(&ledger.stations);
    let (spec, gear) = (&job.cutter_spec, &job.transverse);
    let pitch_radius_mm = 0.5 * gear.module_mm * f64::from(spec.teeth);
    let tip_mm = pitch_radius_mm + gear.module_mm * spec.addendum_coefficient;
    let depth_mm = gear.module_mm * (spec.addendum_coefficient + spec.dedendum_coefficient);
    let base_mm = pitch_radius_mm * gear.pressure_angle_rad.cos();
    for under in 0..FLANK_PLACES - 2 {
        let [high_mm, low_mm] = [under, under + 1].map(|place| tip_mm - 0.25 * depth_mm * place as f64);
        // Deeper quarters have the base circle and the root besides.
        assert!(low_mm > base_mm, "quarter {under} is no involute");
        let meant_mm = (high_mm * high_mm - low_mm * low_mm) / (2.0 * base_mm);
        for place in [FLANK_PLACES - 1 - under, FLANK_PLACES + 1 + under] {
            // Whole stations are counted.
            assert!((lengths_mm[place] - meant_mm).abs() < 0.04, "{place}: {} against {meant_mm}", lengths_mm[place]);
        }
    }
}

fn worn(job: &ShapingJob, ledger: &ChipLedger) -> ToolWear {
    cutter_wear::measure(job, ledger).expect("the scene has it")
}

/// With x = 1 and no influence of speed an edge wears by the volume that passes over it: equivalent lengths times
/// lengths of edge times h_1 are the volume, which rays count by their lengths and know no thickness. And a fit to 12
/// gears says 12.
#[test]
fn by_the_first_power_of_thickness_wear_is_the_volume() {
    let of = |exponent: &str| {
        let exponent = format!("thickness_exponent={exponent}");
        job(&["limit_mm=0.2", "gears_to_limit=12", "taylor_exponent=1", &exponent])
    };
    let right = of("1");
    // One ledger serves both exponents.
    let ledger = ledger(&right);
    let lengths_mm = EdgePolygon::wear_place_lengths_mm(&ledger.stations);
    // Both operations are at depth from the first stroke on, which takes a plug that no machine would.
    let taken = ledger.operations.iter().flat_map(|operation| operation.strokes.iter().skip(1));
    let volume_mm3 = taken.map(|stroke| stroke.area_mm2).sum::<f64>() * right.scene.gear.face_width_mm;
    let share = |job: &ShapingJob| {
        let worn = worn(job, &ledger);
        assert!((worn.by_constants.gears() - 12.0).abs() < 1e-12);
        let places = worn.by_constants.cost.equivalent_mm.iter().flat_map(|of| of.iter().zip(&lengths_mm));
        places.map(|(mm, length_mm)| mm * length_mm * worn.law.thickness_mm).sum::<f64>() / volume_mm3
    };
    let [right, wrong] = [right, of("1.1")].map(|job| share(&job));
    println!("volume by wear over volume by rays: {right:.4}; with x = 1.1 {wrong:.4}");
    assert!((right - 1.0).abs() < 0.02, "{right}");
    assert!((wrong - 1.0).abs() > 0.05, "{wrong}");
}
