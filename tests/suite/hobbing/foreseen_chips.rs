//! The thickest chips that are known before a cut, against the cut of the whole blank, and in the lists of warnings of
//! `check` and `cut`.

use crate::fixtures::command::{gearcut, read_json};
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::{BlankField, BlankGrid};
use gearcut::process::hobbing::hob::HobEnd;
use gearcut::process::hobbing::measure::hob_load::OperationLoad;
use gearcut::process::hobbing::{HobCutter, HobbingJob, foreseen_chips};
use gearcut::process::load;
use std::path::Path;

/// Few dexels and rays.
const FEW: [&str; 4] = [
    "fields.flank.profile_spacing_um=800",
    "fields.flank.lead_spacing_um=2000",
    "fields.blank.spacing_mm=0.4",
    "fields.blank.slice_spacing_mm=15",
];

fn scene(name: &str, settings: &[&str]) -> HobbingJob {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let path = format!("scenes/hobbing/{name}.toml");
    let scene = load(Path::new(&path), &settings).unwrap_or_else(|problems| panic!("{problems}")).scene;
    HobbingJob::new(&scene).expect("a gear")
}

/// Largest thickness that each hob tooth takes in every operation; of the slices of `grid` alone.
fn thickness_mm(cutter: &HobCutter, of: impl Fn(BlankGrid) -> BlankGrid) -> Vec<Vec<f64>> {
    let field = cutter.job.blank_field().expect("it fits");
    let slice = field.slices[0].clone();
    let grid = of(field.grid);
    let field = BlankField { slices: vec![slice; grid.slices_z_mm.len()], grid };
    let cut = cutter.cut_blank(&Cpu::default(), field, &|| true).expect("cut").expect("not stopped");
    let loads = cutter.operations.iter().zip(&cut.chips).map(|(passes, chips)| OperationLoad::of_blank(passes, chips));
    loads.map(|load| load.teeth.iter().map(|tooth| tooth.thickness_mm).collect()).collect()
}

/// By a front of points, which knows no rays, the thickest chip of the spur gear is 0.141 mm (`thickness.rs`); rays
/// give thicknesses within a tenth.
#[test]
fn the_spur_gears_thickest_chip_is_that_of_the_front_of_points() {
    let job = scene("circular_spur", &["fields.blank.spacing_mm=0.15"]);
    let cutter = HobCutter::new(&job).expect("passes");
    let chip = foreseen_chips::of(&cutter).expect("they are found")[0].expect("it cuts");
    assert!((chip.thickness_mm / 0.141 - 1.0).abs() < 0.1, "{chip:?}");
}

/// A hob that ends within the roughing zone: its first tooth takes what teeth of a longer one share, or of one that is
/// shifted to the entering end.
#[test]
fn a_hob_that_ends_within_the_roughing_zone_is_known_by_its_end_tooth() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("gear.toml");
    let text = "[gear]\nmodule_mm = 3.0\nteeth = 31\nface_width_mm = 16\nhelix_angle_deg = 40\n\
                [tool.hob]\nreference_diameter_mm = 80\ngashes = 16\nlength_mm = 63\n\
                [[operation]]\nname = \"finish\"\naxial_feed_mm_per_revolution = 3\n";
    std::fs::write(&path, text).expect("a scene");
    let chip = |setting: &str| {
        let scene = load(&path, &[setting.to_owned()]).unwrap_or_else(|problems| panic!("{problems}")).scene;
        let job = HobbingJob::new(&scene).expect("a gear");
        foreseen_chips::of(&HobCutter::new(&job).expect("passes")).expect("they are found")[0].expect("it cuts")
    };
    let short = chip("tool.hob.length_mm=63");
    assert!((short.tooth, short.missed_end) == (0, Some(HobEnd::Entering)) && short.thickness_mm > 1.0, "{short:?}");
    for way_out in ["tool.hob.length_mm=100", "operation.finish.shift_start_mm=15"] {
        let chip = chip(way_out);
        assert!(chip.missed_end.is_none() && chip.thickness_mm < 0.2 * short.thickness_mm, "{way_out}: {chip:?}");
    }
}

mod slow {
    use super::*;

    /// What is foreseen is a chip of the cut: in the slice in the middle, all spaces with all their material, the
    /// same hob tooth takes one as thick or thicker; the whole blank has no thinner one, and one not much thicker.
    #[test]
    fn a_foreseen_chip_is_one_of_the_cut() {
        for (name, teeth, spacing_mm) in
            [("circular_spur", 20, 0.4), ("third_order_plain", 21, 0.5), ("circular_helical", 21, 0.3)]
        {
            let [teeth, spacing] = [format!("gear.teeth={teeth}"), format!("fields.blank.spacing_mm={spacing_mm}")];
            let job = scene(name, &["gear.face_width_mm=8", "fields.blank.slice_spacing_mm=4", &teeth, &spacing]);
            let cutter = HobCutter::new(&job).expect("passes");
            let foreseen = foreseen_chips::of(&cutter).expect("they are found");
            let middle = |grid: BlankGrid| {
                let z_mm = grid.slices_z_mm[grid.slices_z_mm.len() / 2];
                BlankGrid { slices_z_mm: vec![z_mm], ..grid }
            };
            let in_the_middle = thickness_mm(&cutter, middle);
            let everywhere = thickness_mm(&cutter, |grid| grid);
            assert_eq!(foreseen.len(), job.operations.len(), "{name}");
            for (operation, chip) in foreseen.iter().enumerate() {
                let chip = chip.expect("it cuts");
                let same_tooth_mm = in_the_middle[operation][chip.tooth];
                let largest_mm = everywhere[operation].iter().copied().fold(0.0, f64::max);
                println!("{name}, {operation}: {chip:?}, that tooth {same_tooth_mm}, whole blank {largest_mm}");
                assert!(chip.thickness_mm <= same_tooth_mm + 1e-9, "{name}: {chip:?}, {same_tooth_mm}");
                assert!(chip.thickness_mm <= largest_mm + 1e-9, "{name}: {chip:?}, {largest_mm}");
                let is_round = name.starts_with("circular");
                assert!(!is_round || chip.thickness_mm > 0.75 * largest_mm, "{name}: {chip:?}, {largest_mm}");
            }
        }
    }

    /// `check` tells it before the cut, `cut` in the same words and not a second time; of thin chips nothing is told.
    #[test]
    fn thick_chips_are_told_once_and_before_the_cut() {
        let set = FEW.iter().chain(&["gear.face_width_mm=6"]).flat_map(|&of| ["--set", of]).collect::<Vec<_>>();
        let check = |name: &str| {
            let file = format!("scenes/hobbing/{name}.toml");
            gearcut(&[&["check", &file][..], &set].concat()).done()
        };
        let told = check("third_order_plain").err;
        let sentence = |text: &str| text.contains("mm thick in the middle of the face, more than 0.5 mm");
        let known: Vec<&str> = told.lines().filter(|line| sentence(line)).collect();
        assert_eq!(known.len(), 1, "{told}");
        let thin = check("circular_spur");
        assert!(!thin.err.contains("mm thick"), "{}", thin.err);
        assert!(thin.out.contains("chips thicker than"), "{}", thin.out);
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("out");
        let only = ["--backend", "cpu", "--only", "numbers", "--out", out.to_str().expect("a path")];
        gearcut(&[&["cut", "scenes/hobbing/third_order_plain.toml"][..], &set, &only].concat());
        let results = read_json(&out.join("results.json"));
        let list = results["warnings"].as_array().expect("a list");
        let thick: Vec<&str> =
            list.iter().filter_map(|of| of["text"].as_str()).filter(|text| text.contains("mm thick")).collect();
        assert_eq!(thick.len(), 1, "{thick:?}");
        assert_eq!(known[0], format!("warning: {} [hob.thick_chip]", thick[0]));
    }
}
