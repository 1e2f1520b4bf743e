//! Nothing that is fed to the reader makes it panic, and whatever it takes reads back equal.

use std::path::Path;

use gearcut::process::{load, parse, table};
use proptest::prelude::*;

const SCENE: &str = include_str!("../../../scenes/shaping/elliptical_finishing_stock.toml");

/// Reads `text`; a scene that is taken must resolve to one that is taken and equal in the same folder, a refused one
/// must say why.
fn feed(text: &str, settings: &[String]) {
    match parse(text, "hostile.toml", Path::new("tests/broken"), settings) {
        Ok(loaded) => {
            let resolved = loaded.resolved_toml();
            let again = parse(&resolved, "hostile.toml", Path::new("tests/broken"), &[])
                .unwrap_or_else(|errors| panic!("{errors}\n{resolved}"));
            assert_eq!(loaded.scene, again.scene);
        }
        Err(errors) => {
            assert!(!errors.problems.is_empty());
            assert!(errors.to_string().starts_with("error: "));
        }
    }
}

/// A value that may stand behind a key: numbers of all sizes, texts, lists, tables.
fn value() -> impl Strategy<Value = String> {
    prop_oneof![
        any::<f64>().prop_map(|number| format!("{number:?}").replace("NaN", "nan")),
        (-1000.0..1000.0).prop_map(|number: f64| format!("{number:?}")),
        any::<i64>().prop_map(|number| number.to_string()),
        (0_u32..200).prop_map(|number| number.to_string()),
        prop::sample::select(vec![
            "nan",
            "-inf",
            "+inf",
            "-0.0",
            "1e999",
            "0xffffffffffffffffffffffffffffffffffff",
            "true",
            "{}",
            "[]",
            "[[]]",
            "[[0, 1]]",
            "{a={b={}}}",
            "1979-05-27",
            "\"arc\"",
            "''",
            "\"\u{1b}[31m\""
        ])
        .prop_map(str::to_owned),
        "\\PC{0,12}".prop_map(|text| format!("{text:?}")),
    ]
}

/// Paths of keys and sections, right and wrong.
fn path() -> impl Strategy<Value = String> {
    let keys: Vec<String> = table()
        .keys()
        .map(|(path, _)| path.replace("[]", ".0"))
        .chain(table().sections().iter().map(|section| section.path.replace("[]", ".1")))
        .collect();
    prop_oneof![8 => prop::sample::select(keys), 1 => "[a-z.\\[\\]0-9]{0,20}"]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_text(text in "\\PC{0,200}") {
        feed(&text, &[]);
    }

    #[test]
    fn random_toml_like_text(text in "(\\[{1,2}(gear|tool|operation|[a-z.]{0,9})\\]{1,2}\n|[a-z_]{1,9} ?= \
        ?[-0-9.e\"\\[\\]{}a-z,]{0,12}\n){0,20}") {
        feed(&text, &[]);
    }

    #[test]
    fn bytes_taken_out_or_put_in(at in 0..SCENE.len(), length in 0_usize..40, inserted in "\\PC{0,8}") {
        let start = (0..=at).rev().find(|&i| SCENE.is_char_boundary(i)).unwrap_or(0);
        let end = (start + length..=SCENE.len()).find(|&i| SCENE.is_char_boundary(i)).unwrap_or(SCENE.len());
        feed(&format!("{}{inserted}{}", &SCENE[..start], &SCENE[end..]), &[]);
    }

    #[test]
    fn lines_shuffled(
        order in Just((0..SCENE.lines().count()).collect::<Vec<_>>()).prop_shuffle(),
        kept in 1_usize..45,
    ) {
        let lines: Vec<&str> = SCENE.lines().collect();
        let shuffled: Vec<&str> = order.iter().take(kept).filter_map(|&i| lines.get(i).copied()).collect();
        feed(&shuffled.join("\n"), &[]);
    }

    #[test]
    fn random_settings(settings in prop::collection::vec((path(), value()), 1..4)) {
        let settings: Vec<String> = settings.into_iter().map(|(path, value)| format!("{path}={value}")).collect();
        feed(SCENE, &settings);
    }

    #[test]
    fn random_numbers_behind_every_key(path in path(), number in any::<f64>()) {
        feed(SCENE, &[format!("{path}={}", format!("{number:?}").replace("NaN", "nan"))]);
    }

    #[test]
    fn keys_are_looked_up_in_any_spelling(key in "[a-z._0-9\\[\\]]{0,30}") {
        let loaded = load(Path::new("scenes/shaping/elliptical_finishing_stock.toml"), &[]).expect("loads");
        let _ = loaded.locate(&key);
        let text = loaded.explain(&gearcut::Refusal::new(&key, "odd", "none")).to_string();
        prop_assert!(text.starts_with("error: scenes/"));
    }
}

#[test]
fn large_files_are_answered_at_once() {
    let name = "module_mm".repeat(100_000);
    feed(&format!("[gear]\n{name} = 3\n{SCENE}"), &[]);
    let unknown: Vec<String> = (0..50_000).map(|i| format!("modul{i} = 3")).collect();
    let errors = parse(&unknown.join("\n"), "hostile.toml", Path::new(""), &[]).expect_err("no scene");
    assert_eq!(errors.problems.len(), 100);
    assert!(errors.to_string().ends_with("only 100 problems are listed"));
    let points: Vec<String> = (0..100_001).map(|i| format!("[{:?}, 60]", 0.003 * f64::from(i))).collect();
    let table = format!("points_deg_mm = [{}]", points.join(", "));
    feed(&SCENE.replace("[gear.pitch_curve.ellipse]", &format!("[gear.pitch_curve.table]\n{table}\n")), &[]);
}

#[test]
fn deep_nesting_is_refused() {
    feed(&format!("a = {}{}", "[".repeat(100_000), "]".repeat(100_000)), &[]);
    feed(&format!("[{}a]", "a.".repeat(10_000)), &[]);
    feed(SCENE, &[format!("{}a=3", "gear.".repeat(3_000))]);
}
