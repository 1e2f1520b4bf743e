//! `report.pdf`: what is on its pages, read from the file itself.

use crate::fixtures::command::{gearcut, read_json};
use crate::fixtures::pdf::{PdfPage, pages};
use sha2::{Digest, Sha256};
use std::path::Path;

const SCENE: &str = "[gear]\nmodule_mm = 2.0\nteeth = 17\nface_width_mm = 6.0\nbore_diameter_mm = 10.0\n\
    [tool.shaper_cutter]\nteeth = 20\n[measure]\niso_1328_class = 9\n[fields.flank]\nprofile_spacing_um = 50.0\n\
    lead_spacing_um = 1000.0\n[fields.chips]\nspacing_mm = 0.5\n[fields.blank]\nspacing_mm = 1.0\n\
    [[picture]]\nname = \"gear\"\nwidth_px = 200\nheight_px = 150\n";
const FIELDS: &str = "[report]\npart = \"Pump gear β\"\ndrawing = \"4711-02 B\"\n\
    customer = \"Gebrüder Ähnlich (Ulm)\"\ndate = 2026-05-04\n";

fn cut(folder: &Path, name: &str, scene: &str, more: &[&str]) -> Vec<u8> {
    let (file, out) = (folder.join("scene.toml"), folder.join(name));
    std::fs::write(&file, scene).expect("a scene");
    let [file, out_path] = [&file, &out].map(|path| path.to_str().expect("a path").to_owned());
    let parts = ["--backend", "cpu", "--quiet", "--only", "report", "--only", "pictures", "--only", "texture"];
    let run = gearcut(&[&["cut", &file, "--out", &out_path][..], &parts, more].concat());
    assert!(run.code == 0, "{}", run.err);
    std::fs::read(out.join("report.pdf")).expect("a printed report")
}

fn has(page: &PdfPage, words: &str) -> bool {
    page.words.iter().any(|text| text == words)
}

/// Every page has the scene's fields, the hash that run.json has, and its number; two runs have the same bytes.
#[test]
fn every_page_says_what_it_is_of() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = format!("{SCENE}{FIELDS}");
    let bytes = cut(folder.path(), "one", &scene, &[]);
    assert!(bytes == cut(folder.path(), "two", &scene, &[]), "the same scene gives the same bytes");
    let record = read_json(&folder.path().join("one/run.json"));
    let hash = Sha256::digest(record["scene"].as_str().expect("the scene"));
    let hash: Vec<String> = hash.iter().map(|byte| format!("{byte:02x}")).collect();
    let hash = hash.concat();
    assert_eq!(record["scene_sha256"], hash.as_str());
    let pages = pages(&bytes);
    assert!((4..=6).contains(&pages.len()), "{} pages", pages.len());
    for (index, page) in pages.iter().enumerate() {
        assert_eq!(page.size_pt.map(f64::round), [595.0, 842.0], "A4");
        let number = format!("{} of {}", index + 1, pages.len());
        for words in ["Pump gear β", "4711-02 B", "Gebrüder Ähnlich (Ulm)", "2026-05-04", &hash[..16], &number] {
            assert!(has(page, words), "{words} on page {}: {:?}", index + 1, page.words);
        }
    }
    // In the order in which a drawing office reads, with the drawn gear, two sheets of maps, one of texture windows.
    let place = |words: &str| pages.iter().position(|page| has(page, words)).unwrap_or_else(|| panic!("{words}"));
    let order = ["Verdict", "Key numbers", "Profile, left flanks", "Axis motion", "Surface texture"].map(place);
    assert!(order.is_sorted() && order[0] == 0 && pages[0].pictures == 1, "{order:?}, {}", pages[0].pictures);
    assert!(pages.iter().map(|page| page.pictures).sum::<usize>() >= 4);
    let judged = pages[0]
        .words
        .iter()
        .any(|words| words.starts_with("Deviations: ISO 1328-1:2013 class 9: pass; class reached: "));
    assert!(judged, "{:?}", pages[0].words);
}

/// Fields that are left out stay empty but for the scene's name; the paper is US Letter where the scene says so.
#[test]
fn fields_are_left_to_a_pen_and_letter_is_another_paper() {
    let folder = tempfile::tempdir().expect("a folder");
    let pages = pages(&cut(folder.path(), "out", SCENE, &["--set", "report.paper=letter"]));
    assert!((4..=6).contains(&pages.len()), "{} pages", pages.len());
    for page in &pages {
        assert_eq!(page.size_pt, [612.0, 792.0]);
        assert!(has(page, "scene") && !has(page, "2026-05-04"), "{:?}", page.words);
    }
}
