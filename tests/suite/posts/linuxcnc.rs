//! LinuxCNC's rules, from its G-code overview and reference (docs/src/gcode/overview.adoc, g-code.adoc).

use super::controls::{Block, Done, one_of_each_group, run, words};

/// Most characters of a line; the interpreter's buffer has one more for the end.
const LINE: usize = 255;
/// Modal groups of the codes that these programs use; G80 ends canned cycles and is a motion mode like G0 and G1.
const GROUPS: [&[f64]; 10] = [
    &[0.0, 1.0, 2.0, 3.0, 33.0, 80.0, 81.0, 84.0],
    &[17.0, 18.0, 19.0],
    &[90.0, 91.0],
    &[93.0, 94.0, 95.0],
    &[20.0, 21.0],
    &[40.0, 41.0, 42.0],
    &[43.0, 49.0],
    &[54.0, 55.0, 56.0, 57.0, 58.0, 59.0],
    &[61.0, 64.0],
    &[4.0, 10.0, 28.0, 30.0, 53.0, 92.0],
];

/// Reads a program as LinuxCNC does.
pub fn read(text: &str) -> Result<Done, String> {
    let mut lines = text.lines();
    let mut percents = 0;
    if text.trim_start().starts_with('%') {
        lines.next();
        percents = 1;
    }
    let mut blocks = Vec::new();
    for line in lines {
        if line.len() > LINE {
            return Err(format!("a line of {} characters: `{line}`", line.len()));
        }
        if line.trim() == "%" {
            percents += 1;
            break;
        }
        let code = uncommented(line)?;
        let words = words(&code)?;
        one_of_each_group(&words, &GROUPS).map_err(|why| format!("`{line}`: {why}"))?;
        let has = |number: f64| words.iter().any(|word| word.letter == 'G' && word.number == number);
        let known: Vec<f64> = GROUPS.concat();
        if let Some(word) = words.iter().find(|word| word.letter == 'G' && !known.contains(&word.number)) {
            return Err(format!("`{line}`: unknown G code G{}", word.text));
        }
        if has(20.0) {
            return Err(format!("`{line}`: inches"));
        }
        let p = words.iter().find(|word| word.letter == 'P').map(|word| word.number);
        if p.is_some() && !has(4.0) && !has(64.0) {
            return Err(format!("`{line}`: P word with no G code that uses it"));
        }
        if has(4.0) && p.is_none() {
            return Err(format!("`{line}`: dwell time P missing"));
        }
        let dwell_s = has(4.0).then(|| p.unwrap_or_default());
        if !words.is_empty() {
            blocks.push(Block { words, dwell_s });
        }
    }
    if percents == 1 {
        return Err("a percent sign at the beginning and none at the end".to_owned());
    }
    run(&blocks)
}

/// A line without its comments, blanks between letters and numbers left out, in capitals.
fn uncommented(line: &str) -> Result<String, String> {
    let mut code = String::new();
    let mut comment: Option<String> = None;
    for c in line.chars() {
        match (&mut comment, c) {
            (Some(_), '(') => return Err(format!("`{line}`: nested comment")),
            (Some(words), ')') => {
                let first = words.trim_start().to_ascii_lowercase();
                for command in ["msg,", "debug,", "print,", "log,", "logopen,", "probeopen", "py,", "abort,"] {
                    if first.starts_with(command) {
                        return Err(format!("`{line}`: this comment is a command"));
                    }
                }
                comment = None;
            }
            (Some(words), c) => words.push(c),
            (None, '(') => comment = Some(String::new()),
            (None, ')') => return Err(format!("`{line}`: a comment ends that has not begun")),
            (None, ';') => break,
            (None, ' ' | '\t') => {}
            (None, c) => code.push(c.to_ascii_uppercase()),
        }
    }
    if comment.is_some() {
        return Err(format!("`{line}`: a comment is not closed"));
    }
    Ok(code)
}

#[test]
fn what_the_control_refuses_is_refused() {
    let program = |body: &str| format!("%\nG17 G21 G40 G49 G80 G90 G94\nG0 X1\n{body}\nM30\n%\n");
    read(&program("G93 G1 X2 F3\nG4 P0.5")).expect("a good program");
    for (body, why) in [
        ("G93 G1 X2", "without F"),
        ("G1 X2 F3", "without G93"),
        ("G93 G1 X2 X3 F3", "stands twice"),
        ("G0 G1 X2", "in one block"),
        ("G4", "P missing"),
        ("G710", "unknown G"),
        ("(a (b) c)", "nested"),
        ("(MSG, hello)", "command"),
        ("(open", "not closed"),
    ] {
        let refused = read(&program(body)).expect_err(body);
        assert!(refused.contains(why), "{body}: {refused}");
    }
    assert!(read(&program(&format!("({})", "a".repeat(255)))).expect_err("long").contains("257 characters"));
    assert!(read("%\nG0\nM30\n").expect_err("one percent").contains("none at the end"));
}
