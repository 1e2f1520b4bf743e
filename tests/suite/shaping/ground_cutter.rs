//! The cutter as it is ground, against an independent implementation: edges of spur and helical cutters, and the flanks
//! that they cut on a round gear.

use crate::fixtures::expected::number;
use gearcut::cut::cpu::Cpu;
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::scene::model::Shaping;
use gearcut::process::shaping::tool::ground_flank::GroundFlank;
use gearcut::scene::Scene;
use gearcut::terms::Side;
use gearcut_core::tool::CuttingTool as _;
use gearcut_core::tool::edge::SegmentName;
use glam::DVec2;
use serde_json::Value;
use std::path::Path;

fn data(name: &str) -> Value {
    let path = format!("tests/data/shaping/{name}.json");
    serde_json::from_str(&std::fs::read_to_string(path).expect("oracle file")).expect("oracle JSON")
}

fn rows(of: &Value) -> &[Value] {
    of.as_array().expect("rows")
}

/// The oracle's cutter of 20 teeth of module 3 with a rake of 5 deg and a relief of 6 deg, on a round gear of 40 teeth.
fn scene(settings: &[&str]) -> Scene {
    let own = [
        "gear.teeth=40",
        "tool.shaper_cutter.rake_angle_deg=5",
        "tool.shaper_cutter.grinding.tip_relief_angle_deg=6",
        "operation.rough.strokes_per_revolution=400",
    ];
    let settings: Vec<String> = own.iter().chain(settings).map(|&setting| setting.to_owned()).collect();
    load(Path::new("scenes/shaping/circular_m3_z24.toml"), &settings).unwrap_or_else(|error| panic!("{error}")).scene
}

/// Its left flank, in the transverse section.
fn flank(scene: &Scene) -> GroundFlank {
    let shaping = Shaping::of(scene).expect("it shapes");
    let spec = shaping.tool.transverse(scene.gear.helix_angle_rad);
    let gear = scene.gear.transverse();
    let half_mm = 0.25 * std::f64::consts::PI * gear.module_mm;
    GroundFlank::new(&spec, &spec.grinding.expect("it is ground"), &gear, 2.0 * half_mm).expect("a cutter")
}

const PLAIN: &str = "tool.shaper_cutter.grinding.pressure_angle_deg=20";

#[test]
fn edges_deviate_as_the_oracles() {
    let mut compared = 0;
    let mut hold = |of: &GroundFlank, row: &Value, tolerance_um: f64, name: &str| {
        for (radius, e_um) in rows(&row["r"]).iter().zip(rows(&row["e_um"])) {
            let found_um = 1e3 * of.deviation_mm(number(radius));
            assert!((found_um - number(e_um)).abs() < tolerance_um, "{name}: {found_um} against {e_um} um at {radius}");
            compared += 1;
        }
    };
    for (name, settings) in [("ground_edge_plain", &[PLAIN][..]), ("ground_edge_corrected", &[])] {
        let flank = flank(&scene(settings));
        // Regrinding turns the edge, and changes nothing of its deviation.
        for row in rows(&data(name)["rows"]) {
            hold(&flank, row, 1e-6, name);
        }
    }
    // Helical cutters with a conical face, ground with the gear's pressure angle and corrected.
    for case in rows(&data("helical_noncircular")["cases"]) {
        for row in rows(&case["rows"]).iter().filter(|row| row["face"] == "cone") {
            let normal_rad = number(&row["alpha0_deg"]).to_radians().tan();
            let beta = number(&case["beta_deg"]);
            let ground_deg = (normal_rad * beta.to_radians().cos()).atan().to_degrees();
            let settings = [
                format!("gear.helix_angle_deg={beta}"),
                format!("tool.shaper_cutter.grinding.pressure_angle_deg={ground_deg}"),
            ];
            hold(&flank(&scene(&settings.each_ref().map(String::as_str))), row, 1e-5, "helical");
        }
    }
    assert!(compared > 60, "{compared} places");
}

/// The usual correction, which the program takes by itself, is the oracle's.
#[test]
fn helical_cutters_are_corrected_as_the_oracles() {
    let case = &data("helical_noncircular")["cases"][2];
    let beta = format!("gear.helix_angle_deg={}", number(&case["beta_deg"]));
    let flank = flank(&scene(&[&beta]));
    let row = rows(&case["rows"]).iter().find(|row| row["face"] == "cone").expect("a cone");
    for (radius, e_um) in rows(&row["r"]).iter().zip(rows(&row["e_um"])) {
        assert!((1e3 * flank.deviation_mm(number(radius)) - number(e_um)).abs() < 1e-5);
    }
}

/// The edge that cuts runs through the oracle's points of it, on both flanks; without its grinding it would not.
#[test]
fn the_edge_that_cuts_goes_through_the_oracles_points() {
    for (name, settings) in [("ground_edge_plain", &[PLAIN][..]), ("ground_edge_corrected", &[])] {
        let job = ShapingJob::new(scene(settings)).expect("it is cut");
        let data = data(name);
        let new = rows(&data["rows"]).iter().find(|row| number(&row["s"]) == 0.0).expect("the design section");
        let beside_mm = |edge: &gearcut_core::tool::edge::Edge, point: DVec2| {
            let flank = if point.y > 0.0 { SegmentName::FlankLeft } else { SegmentName::FlankRight };
            let flanks = edge.segments.iter().filter(|segment| segment.name == flank);
            let beside = flanks.filter_map(|segment| {
                let at = segment.blade_from_segment.inverse().point(point);
                let [from, to] = segment.y_range_mm;
                let [x, slope] = segment.x_and_slope(at.y);
                (at.y >= from && at.y <= to).then(|| (at.x - x).abs() / slope.hypot(1.0))
            });
            beside.fold(f64::INFINITY, f64::min)
        };
        let (mut worst_mm, mut without_mm) = (0.0_f64, 0.0_f64);
        for (x, y) in rows(&new["x"]).iter().zip(rows(&new["y"])) {
            let point = DVec2::new(number(x), number(y));
            // The oracle's tip is higher: its addendum is that of the section, not of the edge.
            if point.length() > job.cutter.tip_radius_mm {
                continue;
            }
            for point in [point, DVec2::new(point.x, -point.y)] {
                worst_mm = worst_mm.max(beside_mm(job.cutter.edges().edge_of(0), point));
                without_mm = without_mm.max(beside_mm(job.cutter.edge(), point));
            }
        }
        println!("{name}: within {:.3} nm; {:.2} um beside the involute", 1e6 * worst_mm, 1e3 * without_mm);
        assert!(worst_mm < 1e-7, "{name}: {worst_mm:.2e} mm");
        assert!(without_mm > 1e-3, "{name}: {without_mm:.2e} mm");
    }
}

/// Flanks of a round gear after strokes so dense that their scallops are below a nanometre, place by place.
#[test]
fn a_round_gear_has_the_oracles_deviations() {
    let data = data("ground_gear_circular");
    for (name, settings) in [("plain", &[PLAIN][..]), ("corrected", &[])] {
        let dense = ["operation.finish.strokes_per_revolution=40000", "gear.face_width_mm=1"];
        let job = ShapingJob::new(scene(&[&dense, settings].concat())).expect("it is cut");
        let block = rows(&data[name]["blocks"]).iter().find(|block| number(&block["s"]) == 0.0).expect("as designed");
        let (mut worst_um, mut compared) = (0.0_f64, 0);
        for row in rows(&block["rows"]).iter().filter(|row| row["within_tip"] == true && row["tooth"] == 3) {
            let side = if row["flank"] == "left" { Side::Left } else { Side::Right };
            let target = job.target_flank(3, side);
            let point = DVec2::new(number(&row["nominal_point"][0]), number(&row["nominal_point"][1]));
            let beside =
                |arc_mm: f64| (point - target.at_arc(arc_mm).point_mm).dot(target.at_arc(arc_mm).normal.perp());
            let [mut low, mut high] = [0.0, target.length_mm()];
            let sign = beside(low).signum();
            // The lowest and the highest places may lie beyond the flank that is measured.
            if sign * beside(high) > 0.0 {
                continue;
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if sign * beside(middle) > 0.0 { low = middle } else { high = middle }
            }
            let field = job.field_over(target, [low].into_iter(), vec![0.0]);
            let cut = job.cut_on(&Cpu::default(), gearcut::process::shaping::sections::GearPart::Flank(3, side), field);
            let layers = cut.expect("it is cut").layers;
            let found_um = 1e3 * f64::from(layers.last().expect("finished").heights_mm[0]);
            worst_um = worst_um.max((found_um - number(&row["deviation_um"])).abs());
            compared += 1;
        }
        println!("{name}: {compared} places, {worst_um:.5} um");
        assert!(compared == 8 && worst_um < 1e-3, "{name}: {compared} places, {worst_um} um");
    }
}

/// Cutters whose ground base circle lies outside of the gear's or inside, of few teeth, with rounds and chamfers, for
/// rings and helical gears: all have an edge without gaps.
#[test]
fn edges_of_all_kinds_of_cutters_are_closed() {
    let tip = "tool.shaper_cutter.tip";
    let (round, chamfer) =
        (format!("{tip}.round.radius_mm=0.5"), format!("{tip}.chamfer={{height_mm=0.3, angle_deg=45}}"));
    let own = |key: &str| format!("tool.shaper_cutter.grinding.{key}");
    let kinds: [Vec<String>; 7] = [
        vec![own("pressure_angle_deg=18")],
        vec![own("pressure_angle_deg=22.9")],
        vec!["tool.shaper_cutter.rake_angle_deg=-15".to_owned()],
        vec![round],
        vec![chamfer],
        vec!["tool.shaper_cutter.teeth=9".to_owned()],
        vec!["gear.helix_angle_deg=20".to_owned()],
    ];
    for settings in kinds {
        let job = ShapingJob::new(scene(&settings.iter().map(String::as_str).collect::<Vec<_>>()));
        let job = job.unwrap_or_else(|error| panic!("{settings:?}: {error}"));
        let edge = job.cutter.edges().edge_of(0);
        let ends = edge.segments.iter().map(|segment| {
            segment.y_range_mm.map(|y| segment.blade_from_segment.point(DVec2::new(segment.x_and_slope(y)[0], y)))
        });
        let ends: Vec<[DVec2; 2]> = ends.collect();
        let widest_mm = ends.windows(2).map(|pair| pair[0][1].distance(pair[1][0])).fold(0.0, f64::max);
        println!("{settings:?}: {} segments, gaps up to {:.4} nm", edge.segments.len(), 1e6 * widest_mm);
        assert!(widest_mm < 2e-7, "{settings:?}: {widest_mm:.2e} mm");
    }
}
