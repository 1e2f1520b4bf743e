//! The reader with processes that it has never heard of: everything that it says of them comes from their lists.

use super::keys::{Addition, Default, Key, KeySection, Kind, Range, Role};
use super::values::{Checked, Values};
use super::{
    FINISH_ALONE, KeyTable, ProcessPart, ScenePart, SceneProcess, Senseless, StandardOperation, load, parse, reference,
    schema, template,
};
use crate::machine_errors::{AxisErrors, ErrorLayer};
use std::path::Path;

/// Sawing: no linkage, keys in shared sections, one that is derived, one with a word more, one check.
static SAWING: SceneProcess = SceneProcess {
    name: "sawing",
    tool: "saw",
    tool_words: "a saw",
    needed: "module and teeth",
    scenes: "| `sawing/log.toml` | A log |\n",
    sections: &[&[
        KeySection::new(
            "coolant",
            Role::Plain,
            &[Key::number("flow_mm", "mm", Range::closed(0.0, 9.0), 1.0, "2.0", "How much.")],
            "What cools.",
        ),
        KeySection { path: "tool.saw", role: Role::Variant, keys: &[], groups: &[], teach: "A saw." },
    ]],
    added: &[
        &Addition {
            path: "operation[]",
            keys: &[Key {
                name: "cuts",
                kind: Kind::Whole { min: 1, max: 1000 },
                unit: "",
                default: Default::Derived("one for each tooth"),
                example: "7",
                teach: "Number of cuts.",
            }],
            groups: &[],
        },
        &Addition {
            path: "output",
            keys: &[Key::word("gcode", &["linear", "jigsaw", "none"], "linear", "\"linear\"", "Form of programs.")],
            groups: &[],
        },
    ],
    operations: &[
        StandardOperation { name: "top", template: &[("name", "\"top\""), ("cuts", "3")] },
        StandardOperation { name: "bottom", template: &[("name", "\"bottom\"")] },
    ],
    per_revolution: &["cuts"],
    of_one_gear: &[],
    on_demand: &["measure"],
    draft: "",
    cuts_rings: false,
    senseless: &[Senseless { path: "operation[].linkage", why: "an arm moves the saw", instead: "remove it and push" }],
    axes: &[],
    errors: &[],
    derive: |values| {
        let Some(teeth) = values.view("gear").whole("teeth") else { return };
        for index in 0..values.count("operation") {
            values.put_default(&format!("operation.{index}"), "cuts", Checked::Whole(teeth));
        }
    },
    check: |found| {
        let flow_mm = found.view("coolant").number("flow_mm");
        found.blame(flow_mm == Some(0.0), "coolant.flow_mm", || "the saw runs dry".to_owned(), "open the tap");
    },
    build: |values, _| sawing(values).map(ScenePart::new),
};

/// Filing: an operation has a linkage, and nothing else is its own.
static FILING: SceneProcess = SceneProcess {
    name: "filing",
    tool: "file",
    tool_words: "a file",
    needed: "module and teeth",
    scenes: "",
    sections: &[&[
        KeySection { path: "tool.file", role: Role::Variant, keys: &[], groups: &[], teach: "A file." },
        KeySection::new(
            "operation[].linkage",
            Role::Choice { default: Some("by_hand"), what: "linkage" },
            &[],
            "Who moves it.",
        ),
        KeySection::new("operation[].linkage.by_hand", Role::Variant, &[], "A hand."),
    ]],
    added: &[],
    operations: FINISH_ALONE,
    per_revolution: &[],
    of_one_gear: &[],
    on_demand: &[],
    draft: "",
    cuts_rings: false,
    senseless: &[],
    axes: &[],
    errors: &[],
    derive: |_| {},
    check: |_| {},
    build: |_, _| None,
};

#[derive(Debug, Clone, PartialEq)]
struct Sawing {
    cuts: Vec<(String, u32)>,
}

impl ProcessPart for Sawing {
    fn process(&self) -> &'static SceneProcess {
        &SAWING
    }

    fn error_layers(&self) -> Vec<ErrorLayer> {
        Vec::new()
    }

    fn keep_layers(&mut self, _: &[ErrorLayer]) {}

    fn axis_errors_mut(&mut self) -> &mut [AxisErrors] {
        &mut []
    }

    fn operation_names(&self) -> Vec<&str> {
        self.cuts.iter().map(|(name, _)| name.as_str()).collect()
    }
}

fn sawing(values: &Values) -> Option<Sawing> {
    let cut = |index: usize| {
        let path = format!("operation.{index}");
        let operation = values.view(&path);
        Some((operation.text("name")?.to_owned(), operation.whole("cuts")?))
    };
    Some(Sawing { cuts: (0..values.count("operation")).map(cut).collect::<Option<_>>()? })
}

const SCENE: &str = "[gear]\nmodule_mm = 3.0\nteeth = 24\n[tool.saw]\n";

fn table() -> KeyTable {
    KeyTable::new(&[&SAWING, &FILING])
}

fn problems(text: &str) -> String {
    parse(text, "log.toml", Path::new(""), &[], &table()).expect_err("a broken scene").to_string()
}

#[test]
fn a_scene_gives_the_process_its_own_part_back() {
    let text = format!("{SCENE}[[operation]]\n[[operation]]\nname = \"last\"\ncuts = 7\n");
    let loaded = parse(&text, "log.toml", Path::new(""), &[], &table()).expect("loads");
    let cuts = vec![("operation_1".to_owned(), 24), ("last".to_owned(), 7)];
    assert_eq!(loaded.scene.process.get(), Some(&Sawing { cuts }));
    assert_eq!(loaded.scene.process_name(), "sawing");
    assert_eq!(loaded.locate("operation.last.cuts").expect("written").written, "7");
    let resolved = loaded.resolved_toml();
    assert!(resolved.contains("flow_mm = 1.0  # default") && !resolved.contains("[operation.linkage"), "{resolved}");
    let again = parse(&resolved, "log.toml", Path::new(""), &[], &table()).expect("loads");
    assert_eq!(loaded.scene, again.scene);
    let other = parse(SCENE, "log.toml", Path::new(""), &[], &table()).expect("loads").scene;
    assert_ne!(loaded.scene.process, other.process);
}

#[test]
fn keys_of_other_processes_and_contradictions_are_refused() {
    let foreign = problems(&format!("{SCENE}[[operation]]\n[operation.linkage.by_hand]\n"));
    let why = "`operation.linkage` belongs to filing; this scene is for sawing, where an arm moves the saw";
    assert!(foreign.contains(why), "{foreign}");
    assert!(foreign.contains("remove it and push, or write [tool.file] instead of [tool.saw]"), "{foreign}");
    let foreign = problems(&format!("{}[[operation]]\ncuts = 3\n", SCENE.replace("saw", "file")));
    assert!(foreign.contains("`operation.cuts` belongs to sawing; this scene is for filing"), "{foreign}");
    assert!(problems(&format!("{SCENE}[coolant]\nflow_mm = 0\n")).contains("the saw runs dry"));
    let unknown = problems(&SCENE.replace("saw", "spoon"));
    assert!(unknown.contains("[tool] takes saw, file"), "{unknown}");
    let none = problems(&SCENE.replace("[tool.saw]\n", ""));
    assert!(none.contains("the tool is missing") && none.contains("write [tool.saw] or [tool.file]"), "{none}");
    let missing = load(Path::new("no_such_scene.toml"), &[], &table()).expect_err("no file").to_string();
    assert!(missing.contains("`gearcut new sawing`"), "{missing}");
}

/// A section on demand holds where it is written, and is not written back where it is not.
#[test]
fn sections_on_demand_hold_where_they_are_written() {
    let resolved = |text: &str| parse(text, "log.toml", Path::new(""), &[], &table()).expect("loads").resolved_toml();
    assert!(!resolved(SCENE).contains("[measure]"));
    let written = resolved(&format!("{SCENE}[measure]\nprofile_end_height_mm = 1.5\n"));
    assert!(written.contains("[measure]") && written.contains("profile_end_height_mm = 1.5"), "{written}");
    assert!(resolved(SCENE).contains("[material]"), "a section that is not on demand has its defaults");
}

#[test]
fn what_is_printed_comes_from_the_table() {
    let template = template(&table(), "sawing").expect("a template");
    assert!(template.contains("\ncuts = 3  # ") && template.contains("[tool.saw]"), "{template}");
    assert!(template.contains("\n[[operation]]\nname = \"bottom\"\n"), "{template}");
    assert!(!template.contains("by_hand") && !template.contains("[tool.file]"), "{template}");
    let reference = reference::markdown(&table());
    assert!(reference.contains("| `sawing/log.toml` | A log |\n\n## Keys\n"), "{reference}");
    // Its table stands at the end; its key comes after those of all operations.
    assert!(reference.find("### `[[picture]]`") < reference.find("### `[coolant]`"));
    assert!(reference.find("- `stock_per_flank_mm`") < reference.find("- `cuts`"));
    assert!(schema::json_schema(&table()).contains("\"cuts\""));
}

#[test]
fn a_word_that_one_process_knows_is_refused_to_others() {
    let with_jigsaw = format!("{SCENE}[output]\ngcode = \"jigsaw\"\n");
    parse(&with_jigsaw, "log.toml", Path::new(""), &[], &table()).expect("a word of sawing");
    let refused = problems(&with_jigsaw.replace("[tool.saw]", "[tool.file]"));
    assert!(refused.contains("log.toml:6:9") && refused.contains("\"linear\" or \"none\""), "{refused}");
    // Schema and reference have it, in the place of the shared key and once.
    let reference = reference::markdown(&table());
    assert_eq!(reference.matches("- `gcode` (\"linear\", \"jigsaw\" or \"none\"").count(), 1, "{reference}");
    assert!(reference.find("- `gcode`") < reference.find("- `gcode_contour_error_um`"));
    assert!(schema::json_schema(&table()).contains("\"jigsaw\""));
}

/// The table's default is that of the first process with the choice; the others' are told.
#[test]
fn defaults_of_a_choice_are_each_processs_own() {
    static MACHINE_FILING: SceneProcess = SceneProcess {
        name: "machine_filing",
        tool: "machine_file",
        sections: &[&[
            KeySection { path: "tool.machine_file", role: Role::Variant, keys: &[], groups: &[], teach: "A file." },
            KeySection::new(
                "operation[].linkage",
                Role::Choice { default: Some("crank"), what: "linkage" },
                &[],
                "Who moves it.",
            ),
            KeySection::new("operation[].linkage.crank", Role::Variant, &[], "A crank."),
        ]],
        ..FILING
    };
    let both = KeyTable::new(&[&FILING, &MACHINE_FILING]);
    let linkage = both.section("operation[].linkage").expect("a section");
    assert_eq!(linkage.default(), Some("by_hand"));
    assert_eq!(linkage.teach, "Who moves it; with [tool.machine_file] the default is crank.");
    let own = KeyTable::new(&[&MACHINE_FILING]);
    assert_eq!(own.section("operation[].linkage").expect("a section").default(), Some("crank"));
}

#[test]
#[should_panic(expected = "keys are added to spoon, which is no section")]
fn keys_for_no_section_are_noticed() {
    static LOST: SceneProcess =
        SceneProcess { added: &[&Addition { path: "spoon", keys: &[], groups: &[] }], ..FILING };
    KeyTable::new(&[&LOST]);
}

#[test]
#[should_panic(expected = "the key cuts of operation[] is listed twice")]
fn a_key_that_two_processes_add_is_noticed() {
    static SAWING_TOO: SceneProcess = SceneProcess {
        added: &[&Addition {
            path: "operation[]",
            keys: &[Key::number("cuts", "", Range::closed(0.0, 9.0), 1.0, "2.0", "Other cuts.")],
            groups: &[],
        }],
        ..FILING
    };
    KeyTable::new(&[&SAWING, &SAWING_TOO]);
}

#[test]
fn an_addition_that_two_processes_share_is_taken_once() {
    static SAWING_ALIKE: SceneProcess = SceneProcess { added: SAWING.added, ..FILING };
    let [alone, both] = [&[&SAWING][..], &[&SAWING, &SAWING_ALIKE]].map(KeyTable::new);
    let of = |table: &KeyTable| {
        let section = table.section("operation[]").expect("a section");
        (section.keys.len(), section.groups.len())
    };
    assert_eq!(of(&alone), of(&both));
}

#[test]
#[should_panic(expected = "the key module_mm of gear is listed twice")]
fn a_key_that_is_shared_already_is_noticed() {
    static MODULE: SceneProcess = SceneProcess {
        added: &[&Addition {
            path: "gear",
            keys: &[Key::number("module_mm", "mm", Range::closed(0.0, 9.0), 1.0, "2.0", "Again.")],
            groups: &[],
        }],
        ..FILING
    };
    KeyTable::new(&[&MODULE]);
}
