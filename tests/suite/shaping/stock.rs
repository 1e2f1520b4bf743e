//! Stock that roughing leaves on round gears: as cut, by the closed form of two involutes, and as the scene says.

use crate::fixtures::command::{gearcut, read_json};
use crate::fixtures::expected::close;
use std::fs;

const COARSE: [&str; 8] = [
    "--set",
    "fields.flank.profile_spacing_um=200",
    "--set",
    "fields.flank.lead_spacing_um=10000",
    "--set",
    "fields.blank.spacing_mm=2",
    "--set",
    "fields.chips.spacing_mm=1",
];

/// A round gear by its drawing.
struct Round {
    gear: &'static str,
    module_mm: f64,
    /// Negative of a ring.
    teeth: f64,
    cutter_teeth: u32,
    helix_deg: f64,
    stock_mm: f64,
}

impl Round {
    /// (inv alpha_w' - inv alpha_w) (r_b + r_b0) cos(beta_b) between two offsets.
    fn stock_mm(&self, [finished_mm, roughed_mm]: [f64; 2]) -> f64 {
        let (alpha, beta) = (20_f64.to_radians(), self.helix_deg.to_radians());
        let alpha_t = (alpha.tan() / beta.cos()).atan();
        let pitch_mm = 0.5 * self.module_mm / beta.cos() * (self.teeth + f64::from(self.cutter_teeth));
        let base_mm = pitch_mm * alpha_t.cos();
        let inv = |offset_mm: f64| {
            let working = (base_mm / (pitch_mm + offset_mm)).acos();
            working.tan() - working
        };
        let base_helix = (beta.tan() * alpha_t.cos()).atan();
        (inv(roughed_mm) - inv(finished_mm)) * base_mm * base_helix.cos()
    }

    /// Offsets of finishing and roughing, and smallest, largest and mean stock on all flanks, mm.
    fn cut(&self) -> ([f64; 2], [f64; 3]) {
        let folder = tempfile::tempdir().expect("a folder");
        let [scene, out] = ["round.toml", "out"].map(|name| folder.path().join(name));
        let strokes = 80.0 * self.teeth.abs();
        let text = format!(
            "[gear]\n{}\nmodule_mm = {}\nteeth = {}\nface_width_mm = 10\n[tool.shaper_cutter]\nteeth = {}\n\
             [[operation]]\nname = \"rough\"\nstock_per_flank_mm = {}\nstrokes_per_revolution = {strokes}\n\
             [[operation]]\nname = \"finish\"\nstrokes_per_revolution = {strokes}\n",
            self.gear,
            self.module_mm,
            self.teeth.abs(),
            self.cutter_teeth,
            self.stock_mm
        );
        fs::write(&scene, text).expect("a scene");
        let [scene, out] = [scene, out].map(|path| path.to_str().expect("a path").to_owned());
        let arguments = ["cut", &scene, "--quiet", "--backend", "cpu", "--only", "numbers", "--out", &out];
        gearcut(&[&arguments[..], &COARSE[..]].concat()).done();
        let results = read_json(&folder.path().join("out/results.json"));
        let operations = &results["sections"]["operations"];
        let value = |entry: &serde_json::Value| entry["value"].as_f64().expect("a number");
        let stock = &operations["rough"]["flank_stock"];
        assert!(value(&operations["finish"]["short_of_depth"]).abs() < 1e-12);
        (
            ["finish", "rough"].map(|name| value(&operations[name]["offset"])),
            ["smallest_stock", "largest_stock", "mean_stock"].map(|name| value(&stock[name])),
        )
    }
}

#[test]
fn round_gears_keep_the_stock_that_the_scene_says() {
    let shifted = "profile_shift_coefficient = 0.3";
    let helical = "helix_angle_deg = 22\nhand = \"left\"\nprofile_shift_coefficient = 0.3\n\
                   tooth_thickness_allowance_mm = -0.05";
    for round in [
        Round { gear: shifted, module_mm: 3.0, teeth: 12.0, cutter_teeth: 12, helix_deg: 0.0, stock_mm: 0.5 },
        Round { gear: "", module_mm: 2.0, teeth: 20.0, cutter_teeth: 20, helix_deg: 0.0, stock_mm: 0.2 },
        Round { gear: helical, module_mm: 2.0, teeth: 17.0, cutter_teeth: 25, helix_deg: 22.0, stock_mm: 0.2 },
        Round {
            gear: "kind = \"internal\"",
            module_mm: 3.0,
            teeth: -60.0,
            cutter_teeth: 25,
            helix_deg: 0.0,
            stock_mm: 0.2,
        },
    ] {
        let (offsets_mm, [smallest_mm, largest_mm, mean_mm]) = round.cut();
        let what = format!("module {}, {} teeth", round.module_mm, round.teeth);
        println!("{what}: {offsets_mm:?}, {smallest_mm} to {largest_mm}, {mean_mm} mm");
        close(&what, round.stock_mm(offsets_mm), round.stock_mm, 1e-9);
        close(&what, mean_mm, round.stock_mm, 5e-4);
        close(&what, largest_mm, round.stock_mm, 5e-4);
        close(&what, smallest_mm, round.stock_mm, 2e-3);
    }
}

#[test]
fn a_ring_cannot_keep_more_than_its_base_circle_allows() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("ring.toml");
    let text = "[gear]\nkind = \"internal\"\nmodule_mm = 3\nteeth = 40\n[tool.shaper_cutter]\nteeth = 20\n\
                [[operation]]\nname = \"rough\"\nstock_per_flank_mm = 0.5\n[[operation]]\nname = \"finish\"\n";
    fs::write(&scene, text).expect("a scene");
    // inv(20 deg) 30 mm cos(20 deg)
    let words = ["no depth of the cutter makes a stock of 0.5 mm on each flank", "take less than 0.420 mm"];
    gearcut(&["check", scene.to_str().expect("a path")]).failed(1, &words);
}
