//! Pitch curves from a wish for a motion: tables of the mate's angle against the gear's, and motions that no pair has.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use gearcut::gear::PitchCurve;
use gearcut::process::load;

/// Rows over a turn of a motion in rad.
fn table(rows: u32, motion: impl Fn(f64) -> f64) -> String {
    let mut text = "# a wish\nphi_deg, mate_deg\n".to_owned();
    for i in 0..=rows {
        let phi = TAU * f64::from(i) / f64::from(rows);
        let _ = writeln!(text, "{:.9},{:.9}", phi.to_degrees(), motion(phi).to_degrees());
    }
    text
}

/// The pitch curve of a scene whose points file this is, or what is said of it.
fn curve(gear: &str, shape: &str, table: &str) -> Result<PitchCurve, String> {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("motion.csv"), table).expect("written");
    let path = folder.path().join("scene.toml");
    let text = format!("[gear]\nmodule_mm = 3.0\n{gear}{shape}[tool.shaper_cutter]\nteeth = 18\n");
    std::fs::write(&path, text).expect("written");
    let scene = load(&path, &[]).map_err(|errors| errors.to_string())?.scene;
    let gear = &scene.gear;
    PitchCurve::new(&gear.pitch_curve, gear.module_mm, gear.teeth).map_err(|refusal| refusal.problem)
}

const MOTION: &str = "[gear.pitch_curve.table]\nfile = \"motion.csv\"\n";

/// psi = phi + 0.15 (1 - cos 2 phi) turns the mate by 1 + 0.3 sin 2 phi; a gear inside a ring by 2 turns and 0.2 cos 3
/// phi. The curves are those of the ratios as formulas, to the fourth order of the rows' distance.
#[test]
fn motions_give_the_curves_of_their_ratios() {
    let external: fn(f64) -> f64 = |phi| phi + 0.15 * (1.0 - (2.0 * phi).cos());
    let ring: fn(f64) -> f64 = |phi| 2.0 * phi + 0.2 / 3.0 * (3.0 * phi).sin() + 1.0;
    let cases = [
        ("teeth = 32\n", external, "1/(1 + 0.3*sin(2*phi))"),
        ("kind = \"internal\"\nteeth = 72\n", ring, "1/(2 + 0.2*cos(3*phi))"),
    ];
    for (gear, motion, ratio) in cases {
        let exact = curve(gear, &format!("[gear.pitch_curve.ratio_formula]\nratio = \"{ratio}\"\n"), "").expect(ratio);
        let off_mm = |rows: u32| {
            let found = curve(gear, MOTION, &table(rows, motion)).expect("a curve");
            let off = |i: u32| {
                let phi = TAU * f64::from(i) / 1000.0;
                (found.frame(phi).radius_mm - exact.frame(phi).radius_mm).abs()
            };
            (0..1000).map(off).fold(0.0, f64::max)
        };
        let [coarse_mm, fine_mm] = [72, 144].map(off_mm);
        println!("{ratio}: {coarse_mm:.2e} and {fine_mm:.2e} mm");
        assert!(coarse_mm < 1e-3 && fine_mm < 1e-4, "{coarse_mm} {fine_mm}");
        assert!(coarse_mm > 8.0 * fine_mm, "the fourth order is a factor of 16");
    }
}

#[test]
fn what_no_pair_does_is_refused_with_its_place() {
    let gear = "teeth = 32\n";
    let refused = |gear: &str, table: &str, words: &[&str]| {
        let said = curve(gear, MOTION, table).expect_err("no curve");
        for word in words {
            assert!(said.contains(word), "{word}: {said}");
        }
    };
    let back = |phi: f64| phi + 0.6 * (2.0 * phi).sin();
    refused(gear, &table(72, back), &["motion.csv", "stops or turns back between", "way out"]);
    let slow = |phi: f64| 1.1 * phi + 0.2 * phi.sin();
    refused("kind = \"internal\"\nteeth = 72\n", &table(72, slow), &["turns to one of the ring at", "faster"]);
    let text = table(72, |phi| phi);
    let (open, _) = text.trim_end().rsplit_once('\n').expect("rows");
    refused(gear, open, &["from 0 to 355 deg, not over one turn", "both ends included"]);
    refused(gear, &table(6, |phi| phi), &["7 rows are too few"]);
    refused("teeth = 12\nsector_deg = [-70.0, 70.0]\n", &text, &["gear.sector_deg", "ratio_formula"]);
    refused(gear, &text.replace("mate_deg", "psi"), &["the header is not phi_deg,radius_mm or phi_deg,mate_deg"]);
}
