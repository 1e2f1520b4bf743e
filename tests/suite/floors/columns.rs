//! No line of code or prose is wider than 120 columns (CONTRIBUTING.md): Rust, shaders, Python, Markdown.
//!
//! Rows of tables in Markdown are as wide as they must be, and so are lines with a link that cannot be broken: a single
//! word. Widths are counted in characters.

use std::fs;
use std::path::Path;

const MOST_COLUMNS: usize = 120;
/// Where sources and pages stand, from the root of the project; its own files besides.
const FOLDERS: [&str; 9] = ["src", "crates", "tests", "benches", "examples", "docs", "scenes", "assets", ".ci"];
const ENDINGS: [&str; 4] = ["rs", "wgsl", "py", "md"];

/// Numbers of the lines that are too wide, with their widths.
fn wide_lines(text: &str, markdown: bool) -> Vec<(usize, usize)> {
    let may_be_wide = |line: &str| markdown && (line.trim_start().starts_with('|') || is_a_link(line));
    let lines = text.lines().enumerate().map(|(index, line)| (index + 1, line, line.chars().count()));
    lines
        .filter(|(_, line, columns)| *columns > MOST_COLUMNS && !may_be_wide(line))
        .map(|(number, _, columns)| (number, columns))
        .collect()
}

/// One word with an address in it, after the mark of a list or without one.
fn is_a_link(line: &str) -> bool {
    let words = line.trim().trim_start_matches("- ");
    !words.contains(' ') && words.contains("://")
}

/// Files of these kinds below a folder, without what builds and environments leave there.
fn files(folder: &Path, deep: bool, found: &mut Vec<std::path::PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for path in entries.map(|entry| entry.expect("an entry").path()) {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if path.is_dir() {
            if deep && !["target", "node_modules", "__pycache__", "venv", ".venv", "out"].contains(&name) {
                files(&path, true, found);
            }
        } else if path.extension().and_then(|ending| ending.to_str()).is_some_and(|ending| ENDINGS.contains(&ending)) {
            found.push(path);
        }
    }
}

#[test]
fn no_line_is_wider_than_120_columns() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    files(root, false, &mut found);
    for folder in FOLDERS {
        files(&root.join(folder), true, &mut found);
    }
    assert!(found.len() > 500, "{} files", found.len());
    let mut wide = Vec::new();
    for path in found {
        let text = fs::read_to_string(&path).expect("a text");
        let markdown = path.extension().is_some_and(|ending| ending == "md");
        for (number, columns) in wide_lines(&text, markdown) {
            wide.push(format!("{}:{number}: {columns} columns", path.strip_prefix(root).expect("below").display()));
        }
    }
    assert!(wide.is_empty(), "wider than {MOST_COLUMNS} columns:\n{}", wide.join("\n"));
}

/// The same check notices a planted line, by characters and not by bytes, and lets tables and links alone in Markdown.
#[test]
fn planted_wide_lines_are_noticed() {
    let (fits, wide) = ("µ".repeat(MOST_COLUMNS), "µ".repeat(MOST_COLUMNS + 1));
    let words = "a word ".repeat(20);
    for markdown in [false, true] {
        assert_eq!(wide_lines(&format!("a\n{fits}\n{wide}\n"), markdown), [(3, MOST_COLUMNS + 1)]);
        assert_eq!(wide_lines(&words, markdown).len(), 1);
    }
    let row = format!("| {words} |");
    let link = format!("- https://example.org/{}", "a".repeat(MOST_COLUMNS));
    assert_eq!(wide_lines(&format!("{row}\n{link}\n"), true), []);
    assert_eq!(wide_lines(&format!("{row}\n{link}\n"), false).len(), 2);
}
