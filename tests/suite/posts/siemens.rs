//! Rules of SINUMERIK in Siemens mode, from the programming manual NC programming (6FC5398-2EP40, 12/2019): chapters
//! on program names, blocks, comments, feedrate (G93), dwell (G4) and dimensions (G710).

use super::controls::{Block, Done, one_of_each_group, run, words};

/// Most characters of a block, its comment and its end counted.
const BLOCK: usize = 512;
/// G groups of the codes that these programs use.
const GROUPS: [&[f64]; 9] = [
    &[0.0, 1.0, 2.0, 3.0, 33.0],
    &[4.0],
    &[17.0, 18.0, 19.0],
    &[40.0, 41.0, 42.0],
    &[500.0, 54.0, 55.0, 56.0, 57.0],
    &[9.0, 60.0, 64.0],
    &[70.0, 71.0, 700.0, 710.0],
    &[90.0, 91.0],
    &[93.0, 94.0, 95.0],
];

/// Reads a program as the control does.
pub fn read(text: &str) -> Result<Done, String> {
    let mut blocks = Vec::new();
    let mut metric = false;
    for line in text.split_inclusive('\n') {
        if line.len() > BLOCK {
            return Err(format!("a block of {} characters", line.len()));
        }
        let code = line.split(';').next().unwrap_or_default().trim();
        if let Some(c) = code.chars().find(|&c| !(c.is_ascii_uppercase() || c.is_ascii_digit() || " .+-=".contains(c)))
        {
            return Err(format!("`{code}`: {c} is no part of a block of words"));
        }
        let mut words = words(code).map_err(|why| format!("`{code}`: {why}"))?;
        if words.iter().skip(1).any(|word| word.letter == 'N') {
            return Err(format!("`{code}`: N stands within a block"));
        }
        if words.first().is_some_and(|word| word.letter == 'N') {
            let number = words.remove(0);
            if number.text.contains(['.', '-', '+']) || number.text.len() > 8 {
                return Err(format!("`{code}`: N{} is no block number", number.text));
            }
        }
        one_of_each_group(&words, &GROUPS).map_err(|why| format!("`{code}`: {why}"))?;
        let known: Vec<f64> = GROUPS.concat();
        let mut gs = words.iter().filter(|word| word.letter == 'G');
        if let Some(word) = gs.find(|word| !known.contains(&word.number)) {
            return Err(format!("`{code}`: alarm 12470, G function G{} is unknown", word.text));
        }
        let has = |number: f64| words.iter().any(|word| word.letter == 'G' && word.number == number);
        metric |= has(710.0) || has(71.0);
        let mut dwell_s = None;
        if has(4.0) {
            let (others, time): (Vec<_>, Vec<_>) = words.iter().partition(|word| word.letter == 'G');
            if others.len() > 1 || time.len() != 1 || !matches!(time[0].letter, 'F' | 'S') {
                return Err(format!("`{code}`: G4 stands alone, with F in seconds or S in turns"));
            }
            if time[0].letter == 'S' {
                return Err(format!("`{code}`: a dwell in turns of the spindle"));
            }
            dwell_s = Some(time[0].number);
        }
        if words.iter().any(|word| matches!(word.letter, 'X' | 'Y' | 'Z' | 'W')) && !metric {
            return Err(format!("`{code}`: neither G710 nor G71 has been given"));
        }
        if !words.is_empty() {
            blocks.push(Block { words, dwell_s });
        }
    }
    run(&blocks)
}

/// Whether the control takes a name of a main program.
pub fn takes_name(file: &str) -> bool {
    let Some(name) = file.strip_suffix(".mpf") else { return false };
    let [a, b] = [0, 1].map(|place| name.chars().nth(place).unwrap_or(' '));
    let begins = (a.is_ascii_alphabetic() || a == '_') && b.is_ascii_alphabetic();
    begins && name.len() <= 24 && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

#[test]
fn what_the_control_refuses_is_refused() {
    let program = |body: &str| format!("; head\nN10 G17 G40 G54 G64 G90 G94 G710\nN20 G0 X1\n{body}\nN40 M30\n");
    read(&program("N30 G93 G1 X2 F3\nG4 F0.5")).expect("a good program");
    for (body, why) in [
        ("G93 G1 X2", "without F"),
        ("G21", "alarm 12470"),
        ("G49", "alarm 12470"),
        ("G4 P0.5", "G4 stands alone"),
        ("G4 F1 X2", "G4 stands alone"),
        ("(a comment)", "no part of a block"),
        ("%", "no part of a block"),
        ("G0 N5 X2", "N stands within"),
        ("N1.5 G0 X2", "no block number"),
        ("G90 G91 X2", "in one block"),
    ] {
        let refused = read(&program(body)).expect_err(body);
        assert!(refused.contains(why), "{body}: {refused}");
    }
    assert!(read(&program(&format!("; {}", "a".repeat(511)))).expect_err("long").contains("514 characters"));
    for (name, takes) in [("finish.mpf", true), ("f.mpf", false), ("1st.mpf", false), ("_N.mpf", true)] {
        assert_eq!(takes_name(name), takes, "{name}");
    }
}
