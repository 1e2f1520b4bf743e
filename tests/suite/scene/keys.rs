//! The table of keys agrees with itself, and so does that of every process.

use std::collections::BTreeSet;

use gearcut::process::table;
use gearcut::scene::KeyTable;
use gearcut::scene::keys::{Default, KeySection, Kind, Role};

#[test]
fn sections_stand_inside_sections_and_choices_have_their_default() {
    agrees(table());
    for process in table().processes() {
        agrees(&KeyTable::new(&[process]));
    }
}

fn agrees(table: &KeyTable) {
    let mut seen = BTreeSet::new();
    for section in table.sections() {
        assert!(
            section.path.is_empty() || seen.contains(section.parent_path()),
            "{} stands before its holder",
            section.path
        );
        assert!(seen.insert(section.path), "{} twice", section.path);
        assert!(section.teach.ends_with('.'), "{}: {}", section.path, section.teach);
        if let Role::Choice { default: Some(default), .. } = section.role {
            assert!(table.children(section).any(|child| child.name() == default), "{}: {default}", section.path);
        }
        for group in &section.groups {
            assert!(group.names.iter().all(|name| section.key(name).is_some()), "{}: {:?}", section.path, group.names);
        }
    }
}

/// Each process has one tool of its own, and what several list is the same but for the default of a choice.
#[test]
fn processes_do_not_contradict_each_other() {
    let processes = table().processes();
    let tools: BTreeSet<&str> = processes.iter().map(|process| process.tool).collect();
    let names: BTreeSet<&str> = processes.iter().map(|process| process.name).collect();
    assert_eq!([tools.len(), names.len()], [processes.len(); 2], "{tools:?}, {names:?}");
    for (i, process) in processes.iter().enumerate() {
        let tool = format!("tool.{}", process.tool);
        assert!(KeyTable::new(&[process]).section(&tool).is_some(), "{tool}");
        for other in &processes[..i] {
            let lists =
                |section: &&KeySection| other.sections.iter().copied().flatten().find(|o| o.path == section.path);
            for section in process.sections.iter().copied().flatten() {
                let Some(twin) = lists(&section) else { continue };
                let keys = [section, twin].map(|section| section.keys.iter().map(|key| key.name).collect::<Vec<_>>());
                assert_eq!(keys[0], keys[1], "{}", section.path);
                let whats = [section.role, twin.role].map(|role| match role {
                    Role::Choice { what, .. } => what,
                    _ => "no choice",
                });
                assert_eq!(whats[0], whats[1], "{}", section.path);
            }
        }
    }
}

#[test]
fn defaults_are_allowed_and_units_stand_in_the_names() {
    let mut paths = BTreeSet::new();
    for (path, key) in table().keys() {
        assert!(key.teach.ends_with('.'), "{path}: {}", key.teach);
        match (key.kind, key.default) {
            (Kind::Number(range), Default::Number(number)) => assert!(range.contains(number), "{path} = {number}"),
            (Kind::Whole { min, max }, Default::Whole(number)) => assert!((min..=max).contains(&number), "{path}"),
            (Kind::Word(words), Default::Word(word)) => assert!(words.contains(&word), "{path} = {word}"),
            (kind, default) => {
                let fits = match default {
                    Default::Boolean(_) => matches!(kind, Kind::Boolean),
                    Default::EmptyList => matches!(kind, Kind::Numbers { .. }),
                    Default::Number(_) | Default::Whole(_) | Default::Word(_) => false,
                    Default::Required | Default::OneOfGroup | Default::Derived(_) | Default::LeftOut(_) => true,
                };
                assert!(fits, "{path}: default {default:?} for {kind:?}");
            }
        }
        let suffix = match key.unit {
            "mm" => "_mm",
            "um" => "_um",
            "deg" => "_deg",
            "mm per stroke" => "_mm_per_stroke",
            "mm per revolution" => "_mm_per_revolution",
            "deg, mm" => "_deg_mm",
            "deg/s" => "_deg_per_s",
            "mm/s" => "_mm_per_s",
            "deg/s^2" => "_deg_per_s2",
            "mm/s^2" => "_mm_per_s2",
            "1/min" => "_per_minute",
            "m/min" => "_m_per_min",
            "1/mm^2" => "_per_mm2",
            "m" => "_m",
            "s" => "_s",
            "ms" => "_ms",
            "min" => "_min",
            "1/s" => "_per_s",
            "Hz" => "_hz",
            "arcsec" => "_arcsec",
            "um/m" => "_um_per_m",
            "um/h" => "_um_per_h",
            "um/100 mm" => "_um_per_100mm",
            "N" => "_n",
            "N/mm^2" => "_n_per_mm2",
            "N/mm" => "_n_per_mm",
            "um/kN" => "_um_per_kn",
            "urad/(N m)" => "_urad_per_nm",
            "pixels" => "_px",
            "modules" => "_coefficient",
            "" | "relative to R" | "1/turn" => "",
            unit => panic!("{path}: no rule for the unit {unit}"),
        };
        assert!(key.name.ends_with(suffix), "{path} is in {}", key.unit);
        assert!(paths.insert(path.clone()), "{path} twice");
    }
    assert!(paths.len() > 60, "{} keys", paths.len());
}

#[test]
fn ranges_keep_their_open_ends() {
    let ellipse =
        table().section("gear.pitch_curve.ellipse").and_then(|section| section.key("eccentricity")).expect("a key");
    let Kind::Number(range) = ellipse.kind else { panic!("a number") };
    assert!(range.contains(0.0) && range.contains(1.0_f64.next_down()) && !range.contains(1.0));
    assert!(!range.contains(f64::NAN) && !range.contains(-f64::MIN_POSITIVE));
    assert_eq!(range.to_string(), "0 to below 1");
}
