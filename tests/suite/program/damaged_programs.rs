//! Programs with a defect, cut as they say: the depth under the target is the one that geometry gives, and the exit
//! code tells a damaged gear from a sound one.
//!
//! `tests/suite/shaping/planted.rs` holds forty defects that the judgement of axes must find; here a few are cut.

mod slow {
    use crate::fixtures::command::{gearcut, read_json};
    use serde_json::Value;
    use std::fs;
    use std::ops::RangeInclusive;

    const SCENE: &str = "scenes/shaping/elliptical_normal.toml";
    const STROKES: &str = "480";
    /// Pitch radius of the scene's cutter and its pressure angle.
    const CUTTER_RADIUS_MM: f64 = 30.0;
    const PRESSURE_ANGLE_DEG: f64 = 20.0;

    /// What a defect makes of a block's X, C and B.
    type Defect = fn(usize, [f64; 3]) -> [f64; 3];

    /// A defect, and what its gear must show.
    struct Case {
        name: &'static str,
        defect: Defect,
        code: i32,
        depth_mm: RangeInclusive<f64>,
        sides: RangeInclusive<u64>,
    }

    /// The program with every position changed; blocks of positions are counted from 0.
    fn changed(program: &str, defect: Defect) -> String {
        let mut block = 0;
        let mut lines = Vec::new();
        for line in program.lines() {
            let mut words: Vec<String> = line.split(' ').map(str::to_owned).collect();
            let places = ['X', 'C', 'B'].map(|axis| words.iter().position(|word| word.starts_with(axis)));
            if let ([Some(x), Some(c), Some(b)], true) = (places, line.starts_with('N')) {
                let at = [x, c, b].map(|place| words[place][1..].parse().expect("a number"));
                for (place, value) in [x, c, b].into_iter().zip(defect(block, at)) {
                    words[place] = format!("{}{value:.6}", &words[place][..1]);
                }
                block += 1;
            }
            lines.push(words.join(" "));
        }
        assert!(block > 400, "{block} positions");
        lines.join("\n") + "\n"
    }

    /// Exit code, and the section on what the last operation cut below the target.
    fn cut(program: &str) -> (i32, Value) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name).to_str().expect("a path").to_owned();
        fs::write(path("planted.ngc"), program).expect("a file");
        let strokes = |operation: &str| format!("operation.{operation}.strokes_per_revolution={STROKES}");
        let under_test = format!("operation.finish.program={}", path("planted.ngc"));
        let (rough, finish, out) = (strokes("rough"), strokes("finish"), path("out"));
        let settings = ["--set", &rough, "--set", &finish, "--set", &under_test, "--out", &out];
        let arguments = ["cut", SCENE, "--draft", "--quiet", "--backend", "cpu"];
        let outcome = gearcut(&[&arguments[..], &settings].concat());
        let results = read_json(&folder.path().join("out/results.json"));
        (outcome.code, results["sections"]["blank"]["gouges"].clone())
    }

    fn own_program() -> String {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("own").to_str().expect("a path").to_owned();
        let strokes = format!("operation.finish.strokes_per_revolution={STROKES}");
        let fine = "output.gcode_contour_error_um=0.1";
        gearcut(&["axes", SCENE, "--set", &strokes, "--set", fine, "--out", &out]).done();
        fs::read_to_string(folder.path().join("own/axes/finish.ngc")).expect("a program")
    }

    fn one_deep(block: usize, [x, c, b]: [f64; 3]) -> [f64; 3] {
        [if block == 211 { x - 0.1 } else { x }, c, b]
    }

    /// The cutter's axis 5 mm from the gear's.
    fn one_through_the_hub(block: usize, [x, c, b]: [f64; 3]) -> [f64; 3] {
        [if block == 214 { 5.0 } else { x }, c, b]
    }

    /// A guide off by 220 um in 100 mm moves teeth by 22 um along the reference circle at the end of a face of 20 mm.
    /// Flanks move along their normals by cos(alpha_t) cos(beta_b) = cos(alpha_n) cos(beta) of that: less than a gouge,
    /// which 22 um cos(alpha_t) in the transverse section would be.
    #[test]
    fn on_a_helical_flank_depth_is_along_its_normal() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name).to_str().expect("a path").to_owned();
        let scene = "[gear]\nmodule_mm = 3.0\nteeth = 24\nface_width_mm = 20\nhelix_angle_deg = 40\n\
            [tool.shaper_cutter]\nteeth = 20\n[[operation]]\nname = \"finish\"\nstrokes_per_revolution = 1200\n\
            [operation.infeed.none]\n[machine.errors.guide]\ntangential_um_per_100mm = 220\n";
        fs::write(path("helical.toml"), scene).expect("a file");
        let (scene, out) = (path("helical.toml"), path("out"));
        let outcome = gearcut(&["cut", &scene, "--draft", "--quiet", "--backend", "cpu", "--out", &out]);
        let results = read_json(&folder.path().join("out/results.json"));
        let deepest = &results["sections"]["blank"]["gouges"]["deepest"];
        let normal_mm = 0.022 * 20_f64.to_radians().cos() * 40_f64.to_radians().cos();
        let found_mm = deepest["value"].as_f64().expect("a depth");
        assert_eq!((outcome.code, &deepest["place"]["zone"]), (0, &Value::from("flank")), "{}", outcome.err);
        assert!((found_mm - normal_mm).abs() < 5e-5, "{found_mm} mm deep, by geometry {normal_mm}");
    }

    #[test]
    fn damage_is_as_deep_as_geometry_says() {
        let own = own_program();
        // A cutter turned by an angle comes closer to one flank of each tooth by the angle times its base radius.
        let turned_mm = 0.5_f64.to_radians() * CUTTER_RADIUS_MM * PRESSURE_ANGLE_DEG.to_radians().cos();
        let within = |mm: f64| (0.995 * mm)..=(1.005 * mm);
        let case = |name, defect, code, depth_mm, sides| Case { name, defect, code, depth_mm, sides };
        let cases = [
            case("all strokes 0.5 mm deep", |_, [x, c, b]| [x - 0.5, c, b], 3, within(0.5), 84..=84),
            // A deviation: under the 18.8 um from which on it is a gouge.
            case("all strokes 10 um deep", |_, [x, c, b]| [x - 0.01, c, b], 0, within(0.01), 84..=84),
            case("cutter half a degree round", |_, [x, c, b]| [x, c, b + 0.5], 3, within(turned_mm), 42..=84),
            // Its normals lie within some 25 degrees of the line of centres.
            case("a stroke 0.1 mm deep", one_deep, 3, 0.09..=0.1, 2..=6),
            // What lies at the gear's axis is as deep as the root circle is large.
            case("a stroke through the hub", one_through_the_hub, 3, 45.0..=55.0, 20..=84),
        ];
        let (code, sound) = cut(&own);
        assert_eq!((code, &sound["places"]["value"]), (0, &Value::from(0)), "the program itself");
        for Case { name, defect, code: expected_code, depth_mm, sides } in cases {
            let (code, found) = cut(&changed(&own, defect));
            let deepest_mm = found["deepest"]["value"].as_f64().unwrap_or(f64::NAN);
            let count = found["places"]["value"].as_u64().unwrap_or(u64::MAX);
            assert_eq!(code, expected_code, "{name}");
            assert!(depth_mm.contains(&deepest_mm), "{name}: {deepest_mm} mm deep, expected {depth_mm:?}");
            assert!(sides.contains(&count), "{name}: {count} sides of teeth, expected {sides:?}");
        }
    }
}
