//! The shipped data set: a row repeats from its scene, figures, charts, maps and texture, bit for bit.

use crate::fixtures::command::gearcut;
use gearcut::Side;
use gearcut::process;
use gearcut_core::cut::cpu::Cpu;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A row by the names of its columns.
fn row(folder: &Path) -> BTreeMap<String, String> {
    let mut reader = csv::Reader::from_path(folder.join("rows.csv")).expect("rows");
    let heads = reader.headers().expect("heads").clone();
    let all: Vec<csv::StringRecord> = reader.records().collect::<Result<_, _>>().expect("rows");
    assert_eq!(all.len(), 1);
    heads.iter().map(str::to_owned).zip(all[0].iter().map(str::to_owned)).collect()
}

/// Equal but for the last bit, which `serde_json` may read otherwise than the standard library.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= f64::EPSILON * b.abs()
}

fn quantity<'a>(document: &'a serde_json::Value, path: &[&str]) -> &'a serde_json::Value {
    path.iter().fold(document, |of, key| &of[key])
}

#[test]
fn a_row_repeats_from_its_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("row");
    let share = ["study", "studies/defects.toml", "--quiet", "--shard", "8/1000", "--out"];
    gearcut(&[&share[..], &[out.to_str().expect("a path")]].concat()).done().says(&["1 cases; their rows"]);
    let row = row(&out);
    assert_eq!(row["case"], "7");
    let about = fs::read_to_string(out.join("columns.csv")).expect("columns");
    let parameters = ["mounting.", "tool.", "machine."];
    let settings: Vec<String> = row
        .iter()
        .filter(|(key, _)| parameters.iter().any(|head| key.starts_with(head)))
        .map(|(key, value)| format!("{key}={value}"))
        .collect();
    assert_eq!(settings.len(), 15);
    let cut = folder.path().join("cut");
    let scene = "studies/defects_gear.toml";
    let mut words = vec!["cut", scene, "--quiet", "--backend", "cpu", "--only", "numbers", "--out"];
    words.push(cut.to_str().expect("a path"));
    words.extend(settings.iter().flat_map(|setting| ["--set", setting]));
    gearcut(&words).done();
    let results = fs::read_to_string(cut.join("results.json")).expect("results");
    let results: serde_json::Value = serde_json::from_str(&results).expect("JSON");
    let value = |path: &[&str]| quantity(&results, path)["value"].as_f64().expect("a number");
    let cell = |head: &str| -> f64 { row[head].parse().unwrap_or_else(|_| panic!("{head}: {}", row[head])) };
    for figure in ["F_alpha", "f_H_alpha", "F_beta", "f_p", "F_p", "F_r"] {
        assert!(same(cell(&format!("{figure}_um")), value(&["headline", figure])), "{figure}");
    }
    let mut pitches = 0;
    for tooth in 1..=24 {
        let key = format!("tooth_{tooth:02}");
        for side in ["left", "right"] {
            let head = format!("teeth.{key}.{side}.F_pi_um");
            assert!(same(cell(&head), value(&["sections", "teeth", &key, side, "F_pi"])), "{head}");
            pitches += 1;
        }
    }
    assert_eq!(pitches, 48);
    let texture = ["sections", "texture", "finish", "tooth_01_left", "parameters", "Sa"];
    assert!(same(cell("texture.finish.tooth_01_left.parameters.Sa_um"), value(&texture)));

    // Maps: rays of one's own at places of one's own reckoning.
    let loaded = process::load(Path::new(scene), &settings).expect("a scene");
    let prepared = process::prepare(&loaded.scene).expect("a gear");
    let mut compared = 0;
    for (tooth, side, [columns, rows]) in [(1, Side::Left, [21, 9]), (19, Side::Right, [41, 1])] {
        let ends = ["evaluated_from", "evaluated_to"];
        let [from, to] = ends.map(|end| value(&["sections", "teeth", &format!("tooth_{tooth:02}"), side.name(), end]));
        let u_mm: Vec<f64> = (0..columns).map(|i| from + (to - from) * i as f64 / (columns - 1) as f64).collect();
        let v_mm: Vec<f64> =
            if rows == 1 { vec![0.0] } else { (0..rows).map(|i| -4.5 + 9.0 * i as f64 / (rows - 1) as f64).collect() };
        let mut heights = Vec::new();
        prepared
            .with_gear(&mut |gear| {
                let layers = gear.cut_flank(&Cpu::default(), tooth, side, &u_mm, &v_mm)?;
                heights.clone_from(&layers.last().expect("an operation").heights_mm);
                Ok(())
            })
            .expect("a flank");
        for column in 0..columns {
            for row in 0..rows {
                let head = format!("map.tooth_{tooth:02}_{}.u{column:02}_v{row}_um", side.name());
                // A micrometre of a place moves a height by less than a nanometre on either side of a mark's edge.
                let height_um = 1e3 * f64::from(heights[column * rows + row]);
                assert!((cell(&head) - height_um).abs() < 1e-3, "{head}: {} and {height_um}", cell(&head));
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 21 * 9 + 41);
    assert!(about.contains("map.tooth_01_left.u00_v0_um,um,\"normal deviation of the finished flank"));
    // Planted: the same gear without its eccentricity is another one.
    let other = settings.iter().filter(|setting| !setting.starts_with("mounting.ecc")).cloned().collect::<Vec<_>>();
    assert_eq!(other.len(), 13);
    assert_ne!(process::load(Path::new(scene), &other).expect("a scene").resolved_toml(), loaded.resolved_toml());
}
