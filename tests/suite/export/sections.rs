//! Profiles of drawings against the target sampled a hundred times finer, both ways, and against involutes.

use super::{TOLERANCE_MM, distance_from_line_mm, export, from_path_mm, polyline};
use crate::fixtures::command::{gearcut, gearcut_in};
use gearcut::job::ToothSection;
use gearcut::process;
use glam::DVec2;
use std::f64::consts::{PI, TAU};
use std::path::Path;

/// The target round a tooth and the root before it at `z_mm`, by the library.
pub fn target(scene: &str, settings: &[&str], tooth: u32, z_mm: f64, spacing_mm: f64) -> Vec<DVec2> {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let loaded = process::load(Path::new(scene), &settings).expect("a scene");
    let mut chain = Vec::new();
    let job = process::prepare(&loaded.scene).expect("a job");
    job.with_gear(&mut |gear| {
        let gear = gear.cylindrical().expect("a cylinder");
        let [before, own]: [ToothSection; 2] =
            [tooth - 1, tooth].map(|tooth| gear.target_section(tooth, z_mm, spacing_mm).expect("a target"));
        let half = before.root_mm.len() / 2;
        chain.extend(&before.root_mm[half..]);
        chain.extend(&own.tooth_mm);
        chain.extend(&own.root_mm[..own.root_mm.len() / 2]);
        // Coarser chains end some micrometres off the middle of the root.
        let off = (0.03 / spacing_mm) as usize;
        chain = chain[off..chain.len() - off].to_vec();
        Ok(())
    })
    .expect("shown");
    chain
}

/// Scenes with round and other gears, rings, undercut, helical and hobbed teeth; more settings; a tooth.
const SCENES: [(&str, &[&str], u32); 7] = [
    ("scenes/shaping/circular_m3_z24.toml", &[], 3),
    ("scenes/shaping/circular_m3_z24.toml", &["gear.teeth=10"], 3),
    ("scenes/shaping/elliptical_normal.toml", &[], 5),
    ("scenes/shaping/order_2.toml", &[], 2),
    ("scenes/shaping/internal_circle.toml", &[], 4),
    ("scenes/shaping/internal_ellipse.toml", &[], 7),
    ("scenes/hobbing/circular_helical.toml", &[], 6),
];

#[test]
fn a_profile_is_within_the_tolerance_of_the_target_everywhere() {
    for (scene, settings, tooth) in SCENES {
        let sets: Vec<&str> = settings.iter().flat_map(|&setting| ["--set", setting]).collect();
        let teeth = format!("{tooth}");
        let dxf = export(scene, &[&["--teeth", &teeth], &sets[..]].concat());
        let (is_closed, pieces) = polyline(&dxf, "TARGET");
        assert!(!is_closed && pieces.len() < 100, "{scene} {settings:?}: {} pieces", pieces.len());
        let gap = pieces.windows(2).map(|pair| pair[0].end.distance(pair[1].start)).fold(0.0, f64::max);
        assert_eq!(gap, 0.0);
        // The fit has points some 10 um apart.
        let fine = target(scene, settings, tooth, 0.0, 1e-4);
        assert!(fine.len() > 50_000);
        let from_file = fine.iter().map(|&p| from_path_mm(&pieces, p)).fold(0.0, f64::max);
        let chain: Vec<[DVec2; 2]> = fine.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        let from_target = pieces
            .iter()
            .flat_map(|piece| (1..8).map(|i| piece.at(f64::from(i) / 8.0)))
            .filter(|p| p.distance(pieces[0].start).min(p.distance(pieces[pieces.len() - 1].end)) > 0.05)
            .map(|p| chain.iter().map(|&line| distance_from_line_mm(line, p)).fold(f64::INFINITY, f64::min))
            .fold(0.0, f64::max);
        assert!(from_file <= TOLERANCE_MM, "{scene} {settings:?}: target {from_file} mm from the file");
        assert!(from_target <= TOLERANCE_MM, "{scene} {settings:?}: file {from_target} mm from the target");
        assert!(from_file > 0.2 * TOLERANCE_MM, "{scene}: far fewer pieces would do: {from_file} mm");
    }
}

/// Flanks of a round gear by the law of involutes, r_b times the angle between both being the distance along the
/// normal: at radius r half a tooth is the angle pi / 2 z + inv(alpha) - inv(alpha_r), cos(alpha_r) = r_b / r.
#[test]
fn flanks_of_a_round_gear_are_involutes_and_its_contour_is_closed() {
    let scene = "scenes/shaping/circular_m3_z24.toml";
    let inv = |angle: f64| angle.tan() - angle;
    let (teeth, radius_mm, alpha) = (24.0, 36.0, 20_f64.to_radians());
    let base_mm = radius_mm * f64::cos(alpha);
    for (unit, arguments) in
        [(1.0, &["--tolerance-um", "0.2"][..]), (25.4, &["--tolerance-um", "0.2", "--units", "inch"])]
    {
        let dxf = export(scene, arguments);
        let (is_closed, pieces) = polyline(&dxf, "TARGET");
        assert!(is_closed);
        let mut on_flanks = 0;
        let mut off_mm = 0.0_f64;
        for p in pieces.iter().flat_map(|piece| (0..16).map(|i| unit * piece.at(f64::from(i) / 16.0))) {
            // Over the form circle, under the tip circle of 39 mm.
            let r = p.length();
            if (35.2..38.99).contains(&r) {
                let from_middle = (p.to_angle() / (TAU / teeth) - 0.5).rem_euclid(1.0);
                let half = from_middle.min(1.0 - from_middle) * TAU / teeth;
                let involute = 0.5 * PI / teeth + inv(alpha) - inv((base_mm / r).acos());
                off_mm = off_mm.max(base_mm * (half - involute).abs());
                on_flanks += 1;
            }
        }
        assert!(on_flanks > 48 * 3 * 16, "{on_flanks} places");
        assert!(off_mm <= 2e-4 && off_mm > 4e-5, "{off_mm} mm off the involute");
        let code = if unit == 1.0 { "4" } else { "1" };
        assert!(dxf.contains(&format!("$INSUNITS\n 70\n{code}\n")));
    }
}

/// As cut, an undercut tooth has a waist, and the profile is the target's but for marks of some micrometres.
#[test]
fn an_undercut_gear_as_cut_shows_its_undercut() {
    let scene = "scenes/shaping/circular_m3_z24.toml";
    let sets = ["--set", "gear.teeth=10", "--teeth", "3"];
    let (_, cut) = polyline(&export(scene, &[&sets[..], &["--as-cut"]].concat()), "AS_CUT");
    let (_, target) = polyline(&export(scene, &sets), "TARGET");
    let places: Vec<DVec2> = cut.iter().flat_map(|piece| (0..4).map(|i| piece.at(f64::from(i) / 4.0))).collect();
    let off_mm = places.iter().map(|&p| from_path_mm(&target, p)).fold(0.0, f64::max);
    assert!(off_mm > 2e-4 && off_mm < 0.02, "{off_mm} mm of marks");
    // Half the width of tooth 3 at every place, from its middle line.
    let middle = DVec2::from_angle(2.5 * TAU / 10.0);
    let widths: Vec<[f64; 2]> = places.iter().map(|&p| [middle.dot(p), middle.perp_dot(p).abs()]).collect();
    let widest_below = |limit: f64| widths.iter().filter(|of| of[0] < limit).map(|of| of[1]).fold(0.0, f64::max);
    // The waist: some place under the pitch circle is narrower than the tooth above it.
    let narrowest =
        widths.iter().filter(|of| of[0] < 15.0 && of[0] > 12.5).map(|of| of[1]).fold(f64::INFINITY, f64::min);
    let above = widths.iter().filter(|of| of[0] > 14.0 && of[0] < 15.0).map(|of| of[1]).fold(0.0, f64::max);
    assert!(narrowest < above - 0.05 && widest_below(12.0) > narrowest, "{narrowest} mm under {above} mm");
}

#[test]
fn the_same_scene_gives_the_same_bytes_and_tools_are_drawn() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/shaping/circular_m3_z24.toml");
    let scene = scene.to_str().expect("UTF-8");
    let write = |name: &str| {
        let arguments = ["export", scene, "--dxf", name, "--tool-dxf", "tool.dxf", "--force"];
        let outcome = gearcut_in(folder.path(), &arguments).done();
        outcome.says(&["TARGET", "closed", "a polyline within the same has", "PITCH_CURVE", "circle of 72 mm", "TOOL"]);
        std::fs::read(folder.path().join(name)).expect("written")
    };
    assert_eq!(write("a.dxf"), write("b.dxf"));
    // Tip circle of the cutter: module 3, 20 teeth, addendum 1.25.
    let tool = std::fs::read_to_string(folder.path().join("tool.dxf")).expect("written");
    let (is_closed, pieces) = polyline(&tool, "TOOL");
    let reach_mm = pieces.iter().map(|piece| piece.start.length()).fold(0.0, f64::max);
    assert!(is_closed && (reach_mm - 33.75).abs() < 1e-6, "{reach_mm} mm");
    let hob = folder.path().join("hob.dxf");
    gearcut(&["export", "scenes/hobbing/circular_spur.toml", "--tool-dxf", hob.to_str().expect("UTF-8")]).done();
    let (is_closed, pieces) = polyline(&std::fs::read_to_string(&hob).expect("written"), "TOOL");
    let highest_mm = pieces.iter().map(|piece| piece.start.y).fold(f64::NEG_INFINITY, f64::max);
    assert!(!is_closed && highest_mm > 0.0 && pieces.len() < 40, "{highest_mm} mm, {} pieces", pieces.len());
}

#[test]
fn what_cannot_be_exported_is_refused_with_a_way_out() {
    let scene = "scenes/shaping/circular_m3_z24.toml";
    let refused = |arguments: &[&str], words: &[&str]| {
        gearcut(&[&["export"], arguments].concat()).failed(1, words);
    };
    gearcut(&["export", scene]).failed(2, &["--dxf"]);
    gearcut(&["export", scene, "--dxf", "a.dxf", "--teeth", "5..3"]).failed(2, &["3..5"]);
    refused(&[scene, "--dxf", "scene.toml"], &["--dxf", "scene.toml", "way out", "scene.dxf"]);
    refused(&[scene, "--dxf", "a.dxf", "--teeth", "25"], &["--teeth", "there is no tooth 25", "24"]);
    refused(&[scene, "--dxf", "a.dxf", "--tolerance-um", "0"], &["--tolerance-um", "0.01 to 1000"]);
    refused(&[scene, "--dxf", "a.dxf", "--section-mm", "99"], &["--section-mm", "99 mm lies outside"]);
    refused(&["scenes/bevel/crown_gear.toml", "--dxf", "a.dxf"], &["bevel", "way out"]);
    // Nothing is written before everything is known to be possible.
    refused(&["scenes/bevel/crown_gear.toml", "--dxf", "a.dxf", "--points", "none.csv"], &["bevel", "way out"]);
    assert!(!Path::new("none.csv").exists());
    refused(&[scene, "--dxf", "no/such/folder/a.dxf"], &["no/such/folder"]);
    refused(&[scene, "--dxf", "a.dxf", "--tool-dxf", "a.dxf"], &["--tool-dxf", "a.dxf", "its own name"]);
    let folder = tempfile::tempdir().expect("a folder for the test");
    let there = folder.path().join("there.dxf");
    std::fs::write(&there, "somebody's").expect("written");
    refused(&[scene, "--dxf", there.to_str().expect("UTF-8")], &["there.dxf exists", "--force"]);
    assert_eq!(std::fs::read_to_string(&there).expect("kept"), "somebody's");
}
