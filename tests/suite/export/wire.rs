//! Programs of wire erosion: replayed by their words alone, against the drawing.

use super::{FilePiece, from_path_mm, polyline};
use crate::fixtures::command::gearcut;
use glam::DVec2;
use std::f64::consts::TAU;

/// Lines and arcs of a program by its words alone: from, to, and the centre of an arc with its turn.
fn program(text: &str) -> Vec<FilePiece> {
    let mut at: Option<DVec2> = None;
    let mut pieces = Vec::new();
    for line in text.lines().filter(|line| line.starts_with('G') && line.contains('X')) {
        let word = |letter: char| line.split(' ').find_map(|word| word.strip_prefix(letter)?.parse::<f64>().ok());
        let to = DVec2::new(word('X').expect("X"), word('Y').expect("Y"));
        let from = at.replace(to).unwrap_or(to);
        let bulge = word('I').map_or(0.0, |i| {
            let centre = from + DVec2::new(i, word('J').expect("J"));
            let (start, end) = (from - centre, to - centre);
            assert!((start.length() - end.length()).abs() < 1e-6, "{line}");
            let turn = if line.starts_with("G3") { 1.0 } else { -1.0 };
            (0.25 * (turn * start.angle_to(end)).rem_euclid(TAU)).tan() * turn
        });
        if line.starts_with("G1") || bulge != 0.0 {
            pieces.push(FilePiece { start: from, end: to, bulge });
        }
    }
    pieces
}

/// What a wire of 0.29 mm leaves at the feet of the walls that lead down to an arc about the axis: its circle touches
/// both where its centre is 0.145 mm off the wall's line and off the arc.
fn corner_mm(profile: &[FilePiece], radius_mm: f64) -> Vec<f64> {
    let on_arc = |p: DVec2| (p.length() - radius_mm).abs() < 1e-6;
    let walls = profile.iter().filter(|piece| piece.bulge == 0.0 && on_arc(piece.start) != on_arc(piece.end));
    let left = walls.map(|wall| {
        let [foot, up] = if on_arc(wall.start) { [wall.start, wall.end] } else { [wall.end, wall.start] };
        let along = (up - foot).normalize();
        // The air is clockwise of the first wall's way down and counter-clockwise of the last one's.
        let out = if on_arc(wall.start) { -along.perp() } else { along.perp() };
        let beside = foot + 0.145 * out;
        // |beside + t along| = radius + 0.145
        let (half, rest) = (beside.dot(along), beside.length_squared() - (radius_mm + 0.145).powi(2));
        let centre = beside + (half.mul_add(half, -rest).sqrt() - half) * along;
        centre.distance(foot) - 0.145
    });
    left.collect()
}

/// The wire's centre keeps half a wire and the gap off the drawing, everywhere, on the side of the air.
#[test]
fn a_wire_runs_round_the_profile_at_its_distance() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let as_cut = ["--set", "gear.teeth=10", "--as-cut", "--tolerance-um", "10", "--wire-diameter-um", "250"];
    for (name, layer, within_mm, scene, more) in [
        ("round", "TARGET", 2e-3, "scenes/shaping/circular_m3_z24.toml", &[][..]),
        ("undercut", "TARGET", 2e-3, "scenes/shaping/circular_m3_z24.toml", &["--set", "gear.teeth=10"]),
        ("undercut_as_cut", "AS_CUT", 2e-2, "scenes/shaping/circular_m3_z24.toml", &as_cut),
        ("oval", "TARGET", 2e-3, "scenes/shaping/elliptical_normal.toml", &[]),
        ("ring", "TARGET", 2e-3, "scenes/shaping/internal_circle.toml", &[]),
        ("hobbed", "TARGET", 2e-3, "scenes/hobbing/circular_spur.toml", &["--set", "gear.teeth=18"]),
        ("sector", "TARGET", 2e-3, "scenes/shaping/sector_spiral.toml", &[]),
    ] {
        let [dxf, ngc] = ["dxf", "ngc"].map(|ending| folder.path().join(format!("{name}.{ending}")));
        let [dxf_name, ngc_name] = [&dxf, &ngc].map(|path| path.to_str().expect("UTF-8"));
        let arguments = ["export", scene, "--quiet", "--dxf", dxf_name, "--wire", ngc_name];
        gearcut(&[&arguments, more].concat()).done().says(&["path of the wire", "read back, off the profile"]);
        let text = std::fs::read_to_string(&ngc).expect("written");
        let pieces = program(&text);
        let (_, profile) = polyline(&std::fs::read_to_string(&dxf).expect("written"), layer);
        let near = |p: DVec2| {
            let is_long = |piece: &FilePiece| piece.start.distance(piece.end) > 5.0;
            let close = |piece: &&FilePiece| is_long(piece) || piece.start.distance(p).min(piece.end.distance(p)) < 5.0;
            profile.iter().filter(close).map(|piece| piece.distance_mm(p)).fold(f64::INFINITY, f64::min)
        };
        let round = &pieces[1..pieces.len() - 1];
        let off: Vec<f64> = round.iter().flat_map(|piece| [0.0, 0.3, 0.7].map(|t| near(piece.at(t)) - 0.145)).collect();
        let worst = off.iter().map(|off| off.abs()).fold(0.0, f64::max);
        // Both files are within their tolerance of what they are made of.
        assert!(worst <= within_mm && worst > 1e-5, "{name}: {worst} mm");
        // Once round: every vertex of the profile is reached, but for the feet of a dwell's walls.
        let missed_mm = |at: &&FilePiece| from_path_mm(round, at.start) - 0.145;
        let is_foot = |at: &&FilePiece| name == "sector" && (at.start.length() - 26.0).abs() < 1e-6;
        let (feet, others): (Vec<_>, Vec<_>) = profile.iter().partition(is_foot);
        let missed = others.iter().map(missed_mm).fold(0.0, f64::max);
        assert!(missed <= within_mm, "{name}: {missed} mm");
        let left: Vec<f64> = feet.iter().map(missed_mm).filter(|left| *left > within_mm).collect();
        assert_eq!(left.len(), if name == "sector" { 2 } else { 0 }, "{name}: {left:?}");
        assert!(left.iter().all(|left| corner_mm(&profile, 26.0).iter().any(|exact| (left - exact).abs() < 1e-3)));
        let turned: f64 = round.iter().map(|piece| piece.start.angle_to(piece.end)).sum();
        assert!((turned - TAU).abs() < 1e-6, "{name}: {turned} rad round the axis");
        // On the side of the air: the start hole lies beyond the tips.
        let lead = pieces[0];
        assert!((lead.start.length() > lead.end.length()) == (name != "ring"), "{name}");
        assert!((lead.start.distance(lead.end) - 3.0).abs() < 1e-6, "{name}");
    }
}

#[test]
fn a_wire_that_cannot_follow_is_refused_and_programs_are_read_strictly() {
    let scene = "scenes/shaping/circular_m3_z24.toml";
    let thick = ["export", scene, "--quiet", "--wire", "a.ngc", "--wire-diameter-um", "1000", "--gap-um", "500"];
    gearcut(&thick).failed(1, &["--wire-diameter-um", "would leave", "polar angle", "thinner wire"]);
    let sharp = ["export", scene, "--quiet", "--wire", "a.ngc", "--as-cut", "--set", "gear.teeth=10"];
    gearcut(&sharp).failed(1, &["would leave 0.0", "below 0.145 mm", "--tolerance-um", "leave --as-cut out"]);
    let gap = ["export", scene, "--wire", "a.ngc", "--gap-um", "0.001"];
    gearcut(&gap).failed(1, &["--gap-um", "0.001 um", "--gap-um 1"]);
    gearcut(&["export", scene, "--wire", "a.ngc", "--units", "inch"]).failed(1, &["--units", "in mm"]);
    gearcut(&["export", scene, "--wire", "a.ngc", "--gap-um=-1"]).failed(1, &["--gap-um", "0 to 500"]);
    gearcut(&["export", scene, "--points", "a.csv", "--grid", "9"]).failed(2, &["9x5"]);
    let head = "G17 G21 G90 G94\nG0 X0 Y0\n";
    let read = |body: &str| gearcut::export::wire::read(&format!("{head}{body}\nM2\n"));
    let path = read("G1 X1 F2\nG3 X-1 Y0 I-1 J0\nG2 Y2 I0 J1").expect("a path");
    let bulges: Vec<f64> = path.vertices.iter().map(|vertex| vertex.bulge).collect();
    assert!((bulges[1] - 1.0).abs() < 1e-12 && (bulges[2] + 1.0).abs() < 1e-12, "half circles: {bulges:?}");
    for (body, words) in [
        ("G1 X1", "`F` is missing"),
        ("G3 X1 Y1 I1 F2", "needs I and J"),
        ("G1 X1 I1 J0 F2", "belong to an arc"),
        ("G2 X1 Y1 I1 J1 F2", "ends 0"),
        ("G1 X1 Z1 F2", "axes are X and Y"),
        ("G5 X1 F2", "not read"),
    ] {
        let why = read(body).expect_err(body);
        assert!(why.contains(words), "{body}: {why}");
    }
    let why = gearcut::export::wire::read("G21 G90 G94\nG0 X0 Y0\nG3 X1 Y0 I0.5 J0 F1\nM2\n").expect_err("no plane");
    assert!(why.contains("G17"), "{why}");
}
