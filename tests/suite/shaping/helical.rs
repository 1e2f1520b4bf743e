//! Helical gears through a helical guide: the target against the involute helicoid and the independent implementation,
//! the cut against spur gears whose teeth are turned, candidates against brute force.

use crate::fixtures::expected::number;
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::Field;
use gearcut::job::{CylindricalGear, GearJob};
use gearcut::passes::CutPlan;
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::gear::measure::flank_report;
use gearcut::process::shaping::scene::model::Shaping;
use gearcut::process::shaping::sections::GearPart;
use gearcut::scene::Scene;
use gearcut::terms::Side;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use std::path::Path;

const SIDES: [Side; 2] = [Side::Left, Side::Right];
const RING: [&str; 5] = [
    "gear.kind=\"internal\"",
    "gear.teeth=60",
    "gear.bore_diameter_mm=0",
    "machine.guide_lead_mm=606.9090959565",
    "gear.addendum_coefficient=0.8",
];
const OVAL: [&str; 4] = [
    "gear.teeth=42",
    "gear.pitch_curve={ellipse={order=3, eccentricity=0.1348}}",
    "machine.guide_lead_mm=606.9090959565",
    "operation.finish.strokes_per_revolution=2100",
];

fn scene(settings: &[&str]) -> Scene {
    let at_depth = ["operation.rough.infeed={none={}}", "operation.finish.infeed={none={}}"];
    let settings: Vec<String> = at_depth.iter().chain(settings).map(|&setting| setting.to_owned()).collect();
    load(Path::new("scenes/shaping/helical.toml"), &settings).unwrap_or_else(|error| panic!("{error}")).scene
}

fn job(settings: &[&str]) -> ShapingJob {
    ShapingJob::new(scene(settings)).expect("it is cut")
}

fn inv(angle_rad: f64) -> f64 {
    angle_rad.tan() - angle_rad
}

/// Polar angle of the involute helicoid that is a flank of a tooth, at a radius and a height.
fn helicoid_rad(scene: &Scene, (tooth, side): (u32, Side), radius_mm: f64, z_mm: f64) -> f64 {
    let gear = &scene.gear;
    let (teeth, beta) = (f64::from(gear.teeth), gear.helix_angle_rad);
    let alpha_t = (gear.pressure_angle_rad.tan() / beta.cos()).atan();
    let pitch_radius_mm = 0.5 * gear.module_mm * teeth / beta.cos();
    let alpha = (pitch_radius_mm * alpha_t.cos() / radius_mm).acos();
    let to_tip = gear.kind.tip_sign();
    let shift = 2.0 * gear.profile_shift_coefficient * gear.pressure_angle_rad.tan() / teeth;
    let half_rad = PI / (2.0 * teeth) + shift + to_tip * (inv(alpha_t) - inv(alpha));
    let turn_rad = gear.hand.sign() * beta.tan() * z_mm / pitch_radius_mm;
    (f64::from(tooth) - 0.5) * TAU / teeth + side.sign() * half_rad + turn_rad
}

#[test]
fn the_target_is_the_involute_helicoid() {
    let external: &[&str] = &["gear.profile_shift_coefficient=0.3"];
    let left: &[&str] = &["gear.hand=\"left\"", "gear.helix_angle_deg=25", "machine.guide_lead_mm=371.7"];
    for settings in [external, left, &RING] {
        let job = job(settings);
        let rows_mm = [-4.0, -1.3, 0.0, 4.0];
        let (mut worst_mm, mut lean) = (0.0_f64, 0.0_f64);
        for (tooth, side) in [(1, Side::Left), (1, Side::Right), (7, Side::Left), (24, Side::Right)] {
            let arcs_mm = job.even_arcs_mm(tooth, side, 0.1).expect("a flank");
            let rows = job.target_points(tooth, side, &arcs_mm, &rows_mm).expect("a flank");
            for (row, &z_mm) in rows.iter().zip(&rows_mm) {
                for ray in row {
                    let (p, radius_mm) = (ray.origin_mm.truncate(), ray.origin_mm.truncate().length());
                    let exact = radius_mm * DVec2::from_angle(helicoid_rad(&job.scene, (tooth, side), radius_mm, z_mm));
                    worst_mm = worst_mm.max(p.distance(exact));
                    // Along the helix the surface has no part of its normal.
                    let [below, above] = [-0.01, 0.01].map(|dz_mm| {
                        let turn = helicoid_rad(&job.scene, (tooth, side), radius_mm, z_mm + dz_mm);
                        (radius_mm * DVec2::from_angle(turn)).extend(z_mm + dz_mm)
                    });
                    lean = lean.max((above - below).normalize().dot(ray.normal).abs());
                    assert!((ray.normal.length() - 1.0).abs() < 1e-12);
                }
            }
        }
        println!("{settings:?}: {worst_mm:.1e} mm off the helicoid, normals lean {lean:.1e}");
        assert!(worst_mm < 1e-9 && lean < 1e-7, "{settings:?}: {worst_mm:.2e} mm, {lean:.2e}");
    }
}

/// Where sections turn by whole steps of the work, another stroke cuts what the middle's own stroke cuts there: the
/// same heights, left by strokes that many later.
#[test]
fn rows_a_step_of_the_work_apart_are_cut_alike() {
    let job = job(&[
        "machine.guide_lead_mm=606.9090959565",
        "operation.rough.strokes_per_revolution=600",
        "operation.finish.strokes_per_revolution=1200",
    ]);
    let gear = &job.scene.gear;
    let pitch_radius_mm = 0.5 * gear.transverse_module_mm() * f64::from(gear.teeth);
    // Of roughing, and so twice of finishing; rows a quarter of it apart.
    let step_mm = TAU / 600.0 * pitch_radius_mm / gear.helix_angle_rad.tan();
    let rows_mm: Vec<f64> = (-8..=8).map(|k| 0.25 * f64::from(k) * step_mm).collect();
    assert!(rows_mm[16] < 4.0 && step_mm > 0.4);
    for (tooth, side) in [(3, Side::Left), (9, Side::Right)] {
        let arcs_mm = job.even_arcs_mm(tooth, side, 0.02).expect("a flank");
        let layers = job.cut_flank(&Cpu::default(), tooth, side, &arcs_mm, &rows_mm).expect("native");
        for (operation, layer) in layers.iter().enumerate() {
            let (mut worst_mm, mut halves_mm) = (0.0_f64, 0.0_f64);
            for column in 0..arcs_mm.len() {
                let heights_mm = &layer.heights_mm[column * 17..][..17];
                let apart = |rows: [usize; 2]| f64::from((heights_mm[rows[0]] - heights_mm[rows[1]]).abs());
                worst_mm = (0..17).step_by(4).map(|row| apart([row, 8])).fold(worst_mm, f64::max);
                halves_mm = halves_mm.max(apart([7, 8]));
            }
            println!("tooth {tooth} {side:?}, operation {operation}: {:.4} nm", 1e6 * worst_mm);
            assert!(worst_mm < 1e-7, "tooth {tooth} {side:?}, operation {operation}: {worst_mm:.2e} mm");
            assert!(halves_mm > 1e-5, "between the steps of the work sections differ: {halves_mm:.2e} mm");
            let lowest_mm = layer.heights_mm.iter().copied().fold(f32::INFINITY, f32::min);
            assert!(lowest_mm > -1e-6, "the target is cut by {lowest_mm} mm");
        }
    }
}

/// Teeth of a spur gear's cutter turned by one angle: all have the same pitch error.
fn turned_spur(job: &ShapingJob, z_mm: f64) -> ShapingJob {
    let mut scene = job.scene.clone();
    scene.gear = job.transverse.clone();
    let tool = &mut Shaping::of_mut(&mut scene).expect("shaping").tool;
    *tool = job.cutter_spec.transverse(job.scene.gear.helix_angle_rad);
    let guide_rad = job.helix.expect("a helix").hand.sign() * TAU * z_mm / job.helix.expect("a helix").lead_mm;
    tool.pitch_errors_mm = vec![guide_rad * job.cutter.pitch_radius_mm; tool.teeth as usize];
    let machine = &mut Shaping::of_mut(&mut scene).expect("shaping").machine;
    (machine.guide_lead_mm, machine.guide_hand) = (None, None);
    ShapingJob::new(scene).expect("the section as a spur gear")
}

#[test]
fn sections_are_what_a_cutter_with_turned_teeth_leaves() {
    let traditional = [&OVAL[..], &["operation.rough.linkage={shaping_traditional={}}"]].concat();
    let feeding = ["operation.finish.feed_during_stroke=true", "operation.rough.feed_during_stroke=true"];
    let feeding_oval = [&OVAL[..], &feeding].concat();
    for settings in [&[][..], &RING, &OVAL, &traditional, &feeding_oval] {
        let job = job(settings);
        let z_mm = 3.7;
        let spur = turned_spur(&job, z_mm);
        for (tooth, side) in [(2, Side::Left), (11, Side::Right)] {
            let middle = job.field_over(
                job.target_flank(tooth, side),
                job.even_arcs_mm(tooth, side, 0.05).expect("a flank").into_iter(),
                vec![z_mm],
            );
            let part = GearPart::Flank(tooth, side);
            let cut = job.cut_on(&Cpu::default(), part, middle.clone()).expect("native");
            let helix = job.helix.expect("a helix");
            let band = job.bands(&helix, part, &middle).next().expect("a band").expect("a section");
            let rays = Field { rows_z_mm: vec![if spur.planar().rows_are_alike() { 0.0 } else { z_mm }], ..band.field };
            let same = spur.cut(&Cpu::default(), rays).expect("native");
            for (own, same) in cut.layers.iter().zip(&same.layers) {
                let apart_mm = own
                    .heights_mm
                    .iter()
                    .zip(&same.heights_mm)
                    .map(|(own, same)| (f64::from(*own) - f64::from(*same) * helix.cos_base_helix()).abs());
                let worst_mm = apart_mm.fold(0.0, f64::max);
                println!("{settings:?}, tooth {tooth} {side:?}: {:.4} nm", 1e6 * worst_mm);
                assert!(worst_mm < 5e-7, "{settings:?}: {worst_mm:.2e} mm");
                let off = (0..own.passes.len()).filter(|&i| own.passes[i] != same.passes[i]).count();
                assert!(50 * off <= own.passes.len(), "{off} dexels by other passes");
            }
        }
    }
}

#[test]
fn sections_of_a_noncircular_gear_are_the_oracles() {
    let path = "tests/data/shaping/helical_noncircular.json";
    let data: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(path).expect("oracle file")).expect("oracle JSON");
    let case = data["cases"].as_array().expect("cases").iter().find(|case| !case["noncircular_flank_points"].is_null());
    let case = case.expect("the case of a non-circular gear");
    let case = &case["noncircular_flank_points"];
    let scene = scene(&[
        "gear.module_mm=3",
        "gear.teeth=42",
        "gear.hand=\"left\"",
        "gear.face_width_mm=40",
        "gear.pitch_curve={ellipse={order=3, eccentricity=0.1348}}",
        "tool.shaper_cutter.teeth=20",
        "machine.guide_lead_mm=728.290915147773",
    ]);
    let job = ShapingJob::new(scene).expect("the gear");
    let lead_mm = number(&data["cases"][0]["lead_of_cutter_and_guide"]);
    assert!((job.helix.expect("a helix").needed_lead_mm - lead_mm).abs() < 1e-8);
    assert!((job.cutter.pitch_radius_mm - number(&data["cases"][0]["r_c"])).abs() < 1e-9);
    let (mut worst_mm, mut compared) = (0.0_f64, 0);
    for row in case["points"].as_array().expect("points") {
        let side = if row["flank"] == "left" { Side::Left } else { Side::Right };
        let (tooth, z_mm) = (row["tooth"].as_u64().expect("tooth") as u32, number(&row["Z"]));
        let point = DVec2::new(number(&row["point"][0]), number(&row["point"][1]));
        let flank = job.flank_in_section(tooth, side, z_mm).expect("a section");
        let length_mm = job.target_flank(tooth, side).length_mm();
        let beside = |arc_mm: f64| {
            let at = flank.at_arc(arc_mm);
            (point - at.point_mm).dot(at.normal.perp())
        };
        let [mut low, mut high] = [0.0, length_mm];
        let sign = beside(low).signum();
        assert!(sign * beside(high) < 0.0, "tooth {tooth} {side:?}, {z_mm} mm: beside the flank");
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if sign * beside(middle) > 0.0 { low = middle } else { high = middle }
        }
        let at = flank.at_arc(low);
        worst_mm = worst_mm.max((point - at.point_mm).dot(at.normal).abs());
        compared += 1;
    }
    println!("{compared} points, worst {worst_mm:.1e} mm");
    assert!(compared >= 12 && worst_mm < 1e-8, "{compared} points, {worst_mm:.2e} mm");
}

#[test]
fn candidates_of_bands_equal_brute_force_bit_for_bit() {
    let mut bands_seen = 0;
    for settings in [&[][..], &RING, &OVAL] {
        let job = job(settings);
        let helix = job.helix.expect("a helix");
        for (part, mut field) in [
            (GearPart::Flank(3, Side::Left), job.flank_field(job.target_flank(3, Side::Left))),
            (GearPart::Flank(10, Side::Right), job.flank_field(job.target_flank(10, Side::Right))),
            (GearPart::Root(4, job.planar().root_spacing_mm()), job.root_field(4)),
        ] {
            field.rows_z_mm = (0..24).map(|row| f64::from(row) / 3.0 - 4.0).collect();
            for band in job.bands(&helix, part, &field).step_by(5) {
                let band = band.expect("a section");
                let planar = job.planar_of(&band.strokes);
                for operation in &planar.operations {
                    let plans = [
                        CutPlan::new(&band.field, operation.strokes, planar.tool),
                        CutPlan::brute_force(&band.field, operation.strokes, planar.tool),
                    ];
                    assert!(plans[1].records.len() > 2 * plans[0].records.len());
                    let [few, all] = plans.map(|plan| {
                        let mut layer = band.field.blank_layer();
                        Cpu::default().cut(&band.field, &plan, &mut layer).expect("native");
                        (layer.heights_mm.iter().map(|h| h.to_bits()).collect::<Vec<_>>(), layer.passes)
                    });
                    assert!(few == all, "{settings:?}, {part:?}: candidates leave other heights");
                    bands_seen += 1;
                }
            }
        }
    }
    println!("{bands_seen} bands equal brute force");
    assert!(bands_seen > 40);
}

#[test]
fn another_lead_leaves_the_helix_deviation_of_its_closed_form() {
    for (lead_mm, settings) in
        [(606.9090959565, &[][..]), (600.0, &[]), (615.0, &[]), (600.0, &RING[..3]), (600.0, &OVAL[..2])]
    {
        let lead = format!("machine.guide_lead_mm={lead_mm}");
        let settings = [settings, &[lead.as_str(), "operation.finish.strokes_per_revolution=9600"]].concat();
        let job = job(&settings);
        let gear = &job.scene.gear;
        let helix = job.helix.expect("a helix");
        let rows_mm = job.planar().rows_z_mm(0.5);
        // Closed form: the guide's helix against the gear's, as transverse arcs, on the base tangent plane.
        let beta = (TAU * job.cutter.pitch_radius_mm / lead_mm).atan();
        let alpha_t = gear.transverse_pressure_angle_rad();
        let base_helix = (gear.helix_angle_rad.tan() * alpha_t.cos()).atan();
        let slope = gear.hand.sign() * (beta.tan() - gear.helix_angle_rad.tan()) * alpha_t.cos() * base_helix.cos();
        assert!((helix.slope(gear.kind, job.cutter.pitch_radius_mm) - slope).abs() < 1e-12);
        for side in SIDES {
            let flank = job.target_flank(5, side);
            let field = job.field_over(flank, job.planar().arcs_mm(flank.length_mm()), rows_mm.clone());
            let cut = job.cut_on(&Cpu::default(), GearPart::Flank(5, side), field).expect("native");
            let report = flank_report::measure(&job, flank, &cut, &rows_mm);
            let lead = report.lead.expect("a trace along the tooth");
            let [from_mm, to_mm] = lead.between_mm;
            let expected_um = 1e3 * side.sign() * slope * (to_mm - from_mm);
            let found_um = 1e3 * lead.slope_mm;
            println!("lead {lead_mm} mm, {side:?}: {found_um:.3} um, {expected_um:.3} um expected");
            assert!(
                (found_um - expected_um).abs() < 0.01 * expected_um.abs() + 0.05,
                "{found_um} um, {expected_um} um"
            );
        }
    }
}

/// The angle of nothing is the spur gear, whose own way through the kernels shares none of the bands.
#[test]
fn a_helix_of_nothing_cuts_the_spur_gear() {
    let [spur, barely] = [0.0, 1e-7_f64].map(|angle_deg| {
        let mut scene = scene(&[]);
        scene.gear.helix_angle_rad = angle_deg.to_radians();
        Shaping::of_mut(&mut scene).expect("shaping").machine.guide_lead_mm = None;
        ShapingJob::new(scene).expect("it is cut")
    });
    assert!(spur.helix.is_none() && barely.helix.is_some());
    for (tooth, side) in [(1, Side::Left), (8, Side::Right)] {
        let arcs_mm = spur.even_arcs_mm(tooth, side, 0.02).expect("a flank");
        let [of_spur, of_barely] = [&spur, &barely]
            .map(|job| job.cut_flank(&Cpu::default(), tooth, side, &arcs_mm, &[-4.0, 0.5, 4.0]).expect("native"));
        for (a, b) in of_spur.iter().zip(&of_barely) {
            let apart_mm = a.heights_mm.iter().zip(&b.heights_mm).map(|(a, b)| f64::from((a - b).abs()));
            let worst_mm = apart_mm.fold(0.0, f64::max);
            assert!(worst_mm < 1e-7, "{worst_mm:.2e} mm");
        }
    }
}

/// Points of sections as bodies, outlines and exports take them stand on the same surface.
#[test]
fn outlines_and_roots_turn_with_the_flanks() {
    for settings in [&[][..], &OVAL] {
        let job = job(settings);
        for z_mm in [-4.0, 2.5] {
            let outline = job.target_outline(z_mm, 0.02).expect("ordinary teeth");
            let depth_mm = |point: DVec3| outline.distance_mm(point.truncate(), 5.0).expect("near").abs();
            for side in SIDES {
                let arcs_mm = job.even_arcs_mm(6, side, 0.1).expect("a flank");
                for ray in &job.target_points(6, side, &arcs_mm, &[z_mm]).expect("a flank")[0] {
                    assert!(depth_mm(ray.origin_mm) < 2e-4, "{settings:?}: {} mm", depth_mm(ray.origin_mm));
                }
            }
            for (point, _) in &job.target_roots(6, 0.1, &[z_mm]).expect("a root")[0] {
                assert!(depth_mm(point.extend(z_mm)) < 2e-4, "{settings:?}: root {} mm", depth_mm(point.extend(z_mm)));
            }
        }
    }
}
