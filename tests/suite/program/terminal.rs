//! What commands print on a terminal of 80 columns: every line fits, and the words that weigh are in colour.
//!
//! `script` (util-linux) gives the program a terminal of its own, as the code asks for one; standard output and
//! standard error come out of it together.

use std::path::Path;
use std::process::Command;

/// Columns of the terminal.
const COLUMNS: usize = 80;
/// A round gear that is cut in moments, with a class that nothing of it keeps and texture too coarse to be true: its
/// list has warnings of several kinds.
const SCENE: &str = "[gear]\nmodule_mm = 3.0\nteeth = 12\nface_width_mm = 10.0\ntooth_thickness_allowance_mm = -0.05\n\
    [tool.shaper_cutter]\nteeth = 16\n\
    [measure]\niso_1328_class = 1\n\
    [[operation]]\nname = \"finish\"\nstrokes_per_revolution = 360\n[operation.infeed.none]\n\
    [fields.flank]\nprofile_spacing_um = 100.0\nlead_spacing_um = 5000.0\n\
    [fields.blank]\nspacing_mm = 1.0\n[fields.chips]\nspacing_mm = 0.3\n\
    [[texture]]\ntooth = 2\nprofile_spacing_um = 100.0\nlead_spacing_um = 1000.0\n";

/// What a command says on a terminal, and its exit code.
fn on_terminal(folder: &Path, arguments: &[&str]) -> (String, i32) {
    let quoted: Vec<String> = arguments.iter().map(|word| format!("'{word}'")).collect();
    let program = env!("CARGO_BIN_EXE_gearcut");
    let line = format!("stty cols {COLUMNS} rows 50; exec '{program}' {}", quoted.join(" "));
    let done = Command::new("script")
        .args(["--quiet", "--return", "--command", &line, "/dev/null"])
        .current_dir(folder)
        .env("TERM", "xterm")
        .env_remove("NO_COLOR")
        .stdin(std::process::Stdio::null())
        .output()
        .expect("script, of util-linux");
    (String::from_utf8(done.stdout).expect("UTF-8"), done.status.code().unwrap_or(-1))
}

/// A text without the sequences that colour it and move the cursor.
fn plain(text: &str) -> String {
    let mut parts = text.split('\u{1b}');
    let first = parts.next().unwrap_or_default().to_owned();
    let after = |part: &str| part.find(|c: char| c.is_ascii_alphabetic()).map_or("", |end| &part[end + 1..]).to_owned();
    parts.fold(first, |plain, part| plain + &after(part))
}

/// Lines that are too long; a word that no terminal can break, such as a path, is not, nor are the blanks with which
/// progress clears what was there.
fn too_long(text: &str) -> Vec<String> {
    let plain = plain(text);
    let lines = plain.split(['\n', '\r']);
    lines.map(str::trim_end).filter(|line| line.chars().count() > COLUMNS).map(str::to_owned).collect()
}

#[test]
fn every_line_fits_a_terminal_of_80_columns() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    std::fs::write(path.join("round.toml"), SCENE).expect("a scene");
    let shipped = ["shaping/internal_ellipse", "hobbing/circular_spur", "bevel/crown_gear", "bevel/crown_pinion"];
    for scene in shipped {
        let name = scene.rsplit('/').next().expect("a name");
        std::fs::copy(root.join(format!("scenes/{scene}.toml")), path.join(format!("{name}.toml"))).expect("a scene");
    }
    let surface = root.join("crates/texture/tests/data/p3_feed_marks.npy");
    std::fs::copy(surface, path.join("marks.npy")).expect("a surface");
    let long = "a_result_with_a_name_that_says_at_length_how_it_was_cut";
    let deep = "operation.finish.offset_mm=-0.3";
    let commands: [&[&str]; 22] = [
        &["check", "round.toml"],
        &["check", "internal_ellipse.toml"],
        &["check", "circular_spur.toml"],
        &["check", "crown_gear.toml"],
        &["axes", "round.toml"],
        &["cut", "round.toml", "--draft"],
        &["cut", "round.toml", "--only", "report", "--out", long],
        &["cut", "round.toml", "--only", "report", "--set", deep, "--out", "deep"],
        &["compare", long, "deep"],
        &["compare", long, "deep", long, "deep", long, "deep", long, "--out", "seven"],
        &["texture", "marks.npy", "--spacing-um", "2", "--line", "y=4"],
        &["devices"],
        &["new", "shaping", "--out", "new.toml"],
        &["mate", "round.toml", "--teeth", "18", "--out", "mate.toml"],
        &["pair", "round.toml", "--mate", "18", "--positions", "288"],
        &["scatter", "round.toml", "--seeds", "2", "--tolerance", "operation.finish.offset_mm=-0.01..0.01"],
        &["budget", "round.toml", "--parameters", "mounting", "--flanks", "2-left"],
        &[
            "diagnose",
            "round.toml",
            "--measured",
            "deep/inspection_charts.csv",
            "--noise-um",
            "0.2",
            "--parameters",
            "mounting",
        ],
        &["calibrate", "round.toml", "--measured", "deep/inspection_charts.csv", "--fit", "mounting.eccentricity_um"],
        &["check", "round.toml", "--set", "texture=[{ tooth = 99 }]"],
        &["--help"],
        &["cut", "--help"],
    ];
    for arguments in commands {
        let (text, code) = on_terminal(path, arguments);
        let started = std::time::Instant::now();
        let wide = too_long(&text);
        println!("{arguments:?}: {code}, {} lines, {:?}", text.lines().count(), started.elapsed());
        assert!(wide.is_empty(), "{arguments:?}: {wide:#?}");
        assert!(text.len() > 20, "{arguments:?} says nothing: {text}");
        assert!(code == 0 || code == 3 || text.contains("way out"), "{arguments:?} ends with {code}: {text}");
    }
}

/// `cut` tells its list in the colours of `check`'s.
#[test]
fn warnings_are_in_colour_in_every_command() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("round.toml"), SCENE).expect("a scene");
    let yellow = "\u{1b}[1;33mwarning:\u{1b}[0m ";
    for arguments in [&["check", "round.toml"][..], &["axes", "round.toml"], &["cut", "round.toml", "--only", "report"]]
    {
        let (text, _) = on_terminal(folder.path(), arguments);
        let told = plain(&text).matches("\nwarning: ").count();
        assert!(told > 0, "{arguments:?}: {text}");
        assert_eq!(text.matches(yellow).count(), told, "{arguments:?}: {text}");
    }
}

/// The test itself must notice a line that is too long.
#[test]
fn a_long_line_is_noticed() {
    let line = "x".repeat(COLUMNS);
    assert!(too_long(&format!("\u{1b}[1;31m{line}\u{1b}[0m\r\n")).is_empty());
    assert_eq!(too_long(&format!("short\r\n{line}y\r\n")), [format!("{line}y")]);
}
