//! Pitch curves from drawings (DXF): the closed forms of arcs, ellipses and splines, and drawings that are refused.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};
use std::fmt::Write as _;

use gearcut::gear::PitchCurveShape;
use gearcut::process::load;

const SCENE: &str = "[gear]\nmodule_mm = 3.0\nteeth = 24\n[gear.pitch_curve.table]\nfile = \"curve.dxf\"\n\
    scale_to_close = true\n[tool.shaper_cutter]\nteeth = 20\n";
/// A circle of 36 mm.
const CIRCLE: &str = " 0\nCIRCLE\n 8\n0\n 10\n0.0\n 20\n0.0\n 40\n36.0\n";

/// A drawing in a unit with entities.
fn drawing(unit: &str, entities: &str) -> String {
    format!(
        "  0\r\nSECTION\r\n  2\r\nHEADER\r\n  9\r\n$INSUNITS\r\n 70\r\n{unit}\r\n  0\r\nENDSEC\r\n  0\nSECTION\n  2\n\
         ENTITIES\n{entities}  0\nENDSEC\n  0\nEOF\n"
    )
}

/// Polar points (rad, mm) of the pitch curve that a scene takes from a drawing, or what is said of it.
fn points(drawing: &[u8]) -> Result<Vec<[f64; 2]>, String> {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("curve.dxf"), drawing).expect("written");
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, SCENE).expect("written");
    match load(&path, &[]).map_err(|errors| errors.to_string())?.scene.gear.pitch_curve {
        PitchCurveShape::Table { points_rad_mm, .. } => Ok(points_rad_mm),
        other => panic!("{other:?}"),
    }
}

/// The same, of a drawing that is read.
fn read(unit: &str, entities: &str) -> Vec<[f64; 2]> {
    points(drawing(unit, entities).as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

/// Groups of a polyline with x, y and bulge of each vertex.
fn polyline(layer: &str, vertices: impl IntoIterator<Item = [f64; 3]>) -> String {
    let mut text = format!(" 0\nLWPOLYLINE\n 8\n{layer}\n 70\n1\n");
    for [x, y, bulge] in vertices {
        let _ = write!(text, " 10\n{x}\n 20\n{y}\n 42\n{bulge}\n");
    }
    text
}

/// A spline of degree two with weights: points x, y, weight, and knots.
fn spline(controls: &[[f64; 3]], knots: &[f64]) -> String {
    let mut text = format!(
        " 0\nSPLINE\n 8\n0\n 210\n0\n 220\n0\n 230\n1\n 70\n4\n 71\n2\n 72\n{}\n 73\n{}\n",
        knots.len(),
        controls.len()
    );
    for knot in knots {
        let _ = write!(text, " 40\n{knot}\n");
    }
    for [_, _, weight] in controls {
        let _ = write!(text, " 41\n{weight}\n");
    }
    for [x, y, _] in controls {
        let _ = write!(text, " 10\n{x}\n 20\n{y}\n 30\n0\n");
    }
    text
}

/// A circle as a spline of four quarters, which are exact (Piegl & Tiller 1997, example 7.2), about x.
fn round_spline(radius_mm: f64, x_mm: f64) -> String {
    let corners = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]];
    let controls: Vec<[f64; 3]> = corners
        .iter()
        .enumerate()
        .map(|(i, &[x, y])| {
            let weight = if i % 2 == 0 { 1.0 } else { FRAC_1_SQRT_2 };
            [x_mm + radius_mm * f64::from(x), radius_mm * f64::from(y), weight]
        })
        .collect();
    spline(&controls, &[0.0, 0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1.0, 1.0, 1.0])
}

/// Largest distance of points from the radius that a closed form gives, and largest step of their polar angles, deg.
fn off_mm(points: &[[f64; 2]], radius_mm: impl Fn(f64) -> f64) -> [f64; 2] {
    let off = points.iter().map(|&[at, mm]| (mm - radius_mm(at)).abs()).fold(0.0, f64::max);
    let next = |i: usize| points.get(i + 1).map_or(points[0][0] + TAU, |point| point[0]);
    let step = (0..points.len()).map(|i| next(i) - points[i][0]).fold(0.0, f64::max);
    [off, step.to_degrees()]
}

#[test]
fn circles_arcs_and_splines_are_their_closed_forms() {
    // Two arcs and two lines with bulges, one of them clockwise and one in a frame that looks from below.
    let quarter = 22.5_f64.to_radians().tan();
    let arc = " 0\nARC\n 8\n0\n 10\n0\n 20\n0\n 40\n36\n 50\n0\n 51\n90\n";
    let below = " 0\nARC\n 8\n0\n 10\n0\n 20\n0\n 40\n36\n 50\n0\n 51\n90\n 210\n0\n 220\n0\n 230\n-1\n";
    let old = format!(
        " 0\nPOLYLINE\n 8\n0\n 66\n1\n 0\nVERTEX\n 10\n-36\n 20\n0\n 42\n{quarter}\n 0\nVERTEX\n 10\n0\n 20\n-36\n \
         0\nSEQEND\n"
    );
    let open = format!(" 0\nLWPOLYLINE\n 8\n0\n 70\n0\n 10\n36\n 20\n0\n 42\n{}\n 10\n0\n 20\n-36\n", -quarter);
    let pieces = [arc, &old, &open, below].concat();
    let inch = polyline("0", [[36.0 / 25.4, 0.0, 1.0], [-36.0 / 25.4, 0.0, 1.0]]);
    let clockwise = polyline("0", [[36.0, 0.0, -1.0], [-36.0, 0.0, -1.0]]);
    let ellipse = " 0\nELLIPSE\n 8\n0\n 10\n0\n 20\n0\n 11\n0\n 21\n40\n 40\n0.8\n 41\n0\n 42\n6.283185307179586\n";
    let round = |_: f64| 36.0;
    for (name, unit, entities) in [
        ("circle", "4", CIRCLE.to_owned()),
        ("four kinds of quarters", "4", pieces),
        ("inch", "1", inch),
        ("clockwise", "4", clockwise),
        ("spline", "4", round_spline(36.0, 0.0)),
    ] {
        let found = read(unit, &entities);
        let [off, step_deg] = off_mm(&found, round);
        println!("{name}: {} points, {off:.1e} mm off, steps up to {step_deg:.2} deg", found.len());
        assert!(off < 1e-9 && step_deg < 3.0, "{name}: {off}, {step_deg}");
        assert!(found.len() >= 128 && found.len() <= 720, "{name}: {}", found.len());
    }
    // An ellipse about its middle, its long axis along y; a circle off its axis.
    let [off, _] = off_mm(&read("4", ellipse), |at| 40.0 * 32.0 / (40.0 * at.cos()).hypot(32.0 * at.sin()));
    assert!(off < 1e-9, "{off}");
    let moved = read("4", &round_spline(36.0, 5.0));
    let [off, _] = off_mm(&moved, |at| 5.0 * at.cos() + (36.0_f64.powi(2) - (5.0 * at.sin()).powi(2)).sqrt());
    assert!(off < 1e-9, "{off}");
    assert!(off_mm(&moved, round)[0] > 4.0, "the comparison is alive");
    // The pitch curve alone is taken where it has its layer.
    let layered = CIRCLE.replace("36.0", "10.0") + &CIRCLE.replace(" 8\n0\n", " 8\nPitch_Curve\n");
    assert!(off_mm(&read("4", &layered), round)[0] < 1e-9);
}

/// Vertices of lines are points as they are, from the smallest polar angle on.
#[test]
fn vertices_of_a_polyline_are_the_points() {
    let radius_mm = |at: f64| 36.0 + 2.0 * (2.0 * at).cos();
    let at = |i: i32| TAU * f64::from((i + 7) % 48) / 48.0 + 0.01;
    let vertices = (0..48).map(|i| [radius_mm(at(i)) * at(i).cos(), radius_mm(at(i)) * at(i).sin(), 0.0]);
    let found = read("4", &polyline("0", vertices));
    assert_eq!(found.len(), 48);
    assert!((found[0][0] - 0.01).abs() < 1e-12, "{:?}", found[0]);
    assert!(off_mm(&found, radius_mm)[0] < 1e-12);
}

#[test]
fn drawings_that_are_not_clear_are_refused() {
    let ring = |from: i32, shift: f64| {
        let at = |i: i32| PI * f64::from(i) / 12.0;
        let line = |i: i32| {
            let [(y, x), (v, u)] = [at(i).sin_cos(), at(i + 1).sin_cos()].map(|(y, x)| (36.0 * y, 36.0 * x + shift));
            format!(" 0\nLINE\n 8\n0\n 10\n{x}\n 20\n{y}\n 11\n{u}\n 21\n{v}\n")
        };
        (from..24).map(line).collect::<String>()
    };
    let without_length = " 0\nLINE\n 8\n0\n 10\n36\n 20\n0\n 11\n36\n 21\n0\n";
    assert_eq!(read("4", &(without_length.to_owned() + &ring(0, 0.0))).len(), 24);
    let near = CIRCLE.replace("CIRCLE", "ARC") + " 50\n0\n 51\n359.998\n";
    let square = polyline("0", [[36.0, 0.0, 0.0], [0.0, 36.0, 0.0], [-36.0, 0.0, 0.0], [0.0, -36.0, 0.0]]);
    let twice = (0..96).map(|i| {
        let at = TAU * f64::from(i) / 48.0;
        let mm = 36.0 + 3.0 * (0.5 * at).cos();
        [mm * at.cos(), mm * at.sin(), 0.0]
    });
    let cases: [(&str, String, &str, &str); 17] = [
        ("twice", drawing("4", &polyline("0", twice)), "runs 2 times round the origin", "meets the curve once"),
        ("no unit", drawing("0", CIRCLE), "the drawing has no unit", "inches (1)"),
        ("foot", drawing("2", CIRCLE), "$INSUNITS 2 is no unit of gears", "mm (4)"),
        ("silent", drawing("4", CIRCLE).replace("$INSUNITS", "$ACADVER"), "does not say what its unit is", "mm (4)"),
        ("empty", drawing("4", ""), "has no polyline", "PITCH_CURVE"),
        ("gap", drawing("4", &ring(1, 0.0)), "open at x", "join its ends"),
        ("gap of a micrometre", drawing("4", &near), "a gap of 0.0013 mm", "join its ends"),
        ("two", drawing("4", &(CIRCLE.to_owned() + &CIRCLE.replace("36.0", "10.0"))), "more than one", "PITCH_CURVE"),
        ("corner", drawing("4", &square), "a corner of 90.0 deg at x", "as a spline"),
        ("beside", drawing("4", &ring(0, 50.0)), "the polar angle does not grow", "axis of the gear"),
        ("block", drawing("4", " 0\nINSERT\n 8\n0\n 2\nGEAR\n"), "a block is not looked into", "explode"),
        ("cut off", drawing("4", CIRCLE).replace("  0\nEOF\n", ""), "the drawing is cut off", "ASCII DXF"),
        ("word", drawing("4", CIRCLE).replace("36.0", "wide"), "`wide` is no number", "again"),
        ("infinite", drawing("4", CIRCLE).replace("36.0", "inf"), "`inf` is no number", "again"),
        ("tilted", drawing("4", &(CIRCLE.to_owned() + " 210\n1\n 230\n0\n")), "not lie in the plane xy", "turn"),
        ("knots", drawing("4", &spline(&[[0.0, 0.0, 1.0]; 3], &[0.0; 5])), "do not fit together", "polyline"),
        ("fitted", drawing("4", " 0\nSPLINE\n 71\n3\n 11\n1\n 21\n1\n"), "fit points alone", "control points"),
    ];
    for (name, text, message, way_out) in cases {
        let said = points(text.as_bytes()).expect_err(name);
        assert!(said.contains("curve.dxf") && said.contains(message) && said.contains(way_out), "{name}: {said}");
    }
    let binary = points(b"AutoCAD Binary DXF\r\n\x1a\0\x00\x00SECTION\0").expect_err("binary");
    assert!(binary.contains("no group code of a DXF file") && binary.contains("ASCII DXF"), "{binary}");
}

/// Any beginning of a drawing, and any line of it replaced, is read or refused in words.
#[test]
fn damaged_drawings_never_end_in_a_panic() {
    let quarter = " 0\nARC\n 8\n0\n 10\n0\n 20\n0\n 40\n36\n 50\n0\n 51\n90\n".to_owned();
    let text = drawing("4", &(quarter + &round_spline(36.0, 0.0) + &polyline("0", [[36.0, 0.0, 1.0]; 3])));
    let lines: Vec<&str> = text.lines().collect();
    for (i, _) in lines.iter().enumerate() {
        let _ = points((lines[..i].join("\n") + "\n").as_bytes());
        for other in ["", "0", "-1", "1e308", "NaN", "EOF", "ENDSEC"] {
            let mut changed = lines.clone();
            changed[i] = other;
            let _ = points(changed.join("\n").as_bytes());
        }
    }
}
