//! FANUC's rules for machining centres with the increment system IS-C, from the operator's manuals of Series 16/18
//! (B-62764EN: inverse time feed, decimal points, dwell) and 30i (B-64484EN: program configuration).

use super::controls::{Block, Done, one_of_each_group, run, words};

/// Largest position, mm or deg, and its digits after the point.
const LARGEST: f64 = 9999.9999;
const DECIMALS: usize = 4;
/// F in G93, and its digits after the point.
const INVERSE: std::ops::RangeInclusive<f64> = 0.001..=9999.999;
const INVERSE_DECIMALS: usize = 3;
/// Modal groups of the codes that these programs use.
const GROUPS: [&[f64]; 9] = [
    &[0.0, 1.0, 2.0, 3.0],
    &[4.0, 53.0],
    &[17.0, 18.0, 19.0],
    &[20.0, 21.0],
    &[40.0, 41.0, 42.0],
    &[43.0, 49.0],
    &[54.0, 55.0, 56.0],
    &[90.0, 91.0],
    &[93.0, 94.0, 95.0],
];
/// Cutting mode, exact stop.
const MORE: [f64; 2] = [61.0, 64.0];

/// Reads a program as the control does.
pub fn read(text: &str) -> Result<Done, String> {
    let lines: Vec<&str> = text.lines().collect();
    let [first, number, inner @ .., last] = lines.as_slice() else { return Err("too short".to_owned()) };
    if *first != "%" || *last != "%" {
        return Err("the tape begins and ends with %".to_owned());
    }
    program_number(number)?;
    let mut blocks = Vec::new();
    for line in inner {
        let code = uncommented(line)?;
        let mut words = words(&code).map_err(|why| format!("`{line}`: {why}"))?;
        one_of_each_group(&words, &GROUPS).map_err(|why| format!("`{line}`: {why}"))?;
        let known: Vec<f64> = GROUPS.concat().into_iter().chain(MORE).collect();
        if let Some(word) = words.iter().find(|word| word.letter == 'G' && !known.contains(&word.number)) {
            return Err(format!("`{line}`: alarm PS0010, improper G-code G{}", word.text));
        }
        let has = |number: f64| words.iter().any(|word| word.letter == 'G' && word.number == number);
        if has(20.0) || has(21.0) && words.len() > 1 {
            return Err(format!("`{line}`: G21 in a block of its own, and no inches"));
        }
        let dwells = has(4.0);
        let mut dwell_s = None;
        for word in &mut words {
            let decimals = word.text.split_once('.').map(|(_, decimals)| decimals.len());
            match word.letter {
                'X' | 'U' if dwells => {
                    if decimals.is_none() {
                        return Err(format!("`{line}`: without a point the dwell is in milliseconds"));
                    }
                    dwell_s = Some(word.number);
                }
                'P' if dwells && decimals.is_none() => dwell_s = Some(1e-3 * word.number),
                'X' | 'Y' | 'Z' | 'A' | 'B' | 'C' | 'W' => match decimals {
                    None => return Err(format!("`{line}`: {}{} has no decimal point", word.letter, word.text)),
                    Some(decimals) if decimals > DECIMALS => {
                        return Err(format!("`{line}`: {}{} has too many digits", word.letter, word.text));
                    }
                    Some(_) if word.number.abs() > LARGEST => {
                        return Err(format!("`{line}`: {}{} is out of range", word.letter, word.text));
                    }
                    Some(_) => {}
                },
                'F' => {
                    if !INVERSE.contains(&word.number) || decimals.is_none_or(|digits| digits > INVERSE_DECIMALS) {
                        return Err(format!("`{line}`: F{} is out of range or of digits", word.text));
                    }
                }
                'S' => {
                    if decimals.is_some() || word.number > 99_999.0 {
                        return Err(format!("`{line}`: S{} is no whole number of five digits", word.text));
                    }
                }
                'G' | 'M' => {}
                'N' => {
                    if decimals.is_some() || !(1.0..=99_999.0).contains(&word.number) {
                        return Err(format!("`{line}`: N{} is no sequence number", word.text));
                    }
                }
                letter => return Err(format!("`{line}`: {letter} means something else")),
            }
        }
        if dwells && dwell_s.is_none() {
            return Err(format!("`{line}`: a dwell without its time"));
        }
        if !words.is_empty() {
            blocks.push(Block { words, dwell_s });
        }
    }
    run(&blocks)
}

fn program_number(line: &str) -> Result<(), String> {
    let wrong = || format!("`{line}` is no program number with its title");
    let digits = line.strip_prefix('O').and_then(|rest| rest.get(..4)).ok_or_else(wrong)?;
    let number: u32 = digits.parse().map_err(|_| wrong())?;
    if !(1..=7999).contains(&number) {
        return Err(format!("O{number} may be protected"));
    }
    let title = line[5..].trim();
    let inside = title.strip_prefix('(').and_then(|title| title.strip_suffix(')'));
    if !title.is_empty() && inside.is_none_or(|inside| inside.len() > 31) {
        return Err(wrong());
    }
    uncommented(title).map(|_| ())
}

/// A line without its comments.
fn uncommented(line: &str) -> Result<String, String> {
    let shown = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || " .,+-/*=:()".contains(c);
    if let Some(c) = line.chars().find(|&c| !shown(c)) {
        return Err(format!("`{line}`: {c} is no character of a program"));
    }
    let (mut code, mut inside) = (String::new(), false);
    for c in line.chars() {
        match (inside, c) {
            (false, '(') => inside = true,
            (true, ')') => inside = false,
            (true, '(') | (false, ')') => return Err(format!("`{line}`: brackets within brackets")),
            (true, _) => {}
            (false, c) => code.push(c),
        }
    }
    if inside { Err(format!("`{line}`: a comment is not closed")) } else { Ok(code) }
}

#[test]
fn what_the_control_refuses_is_refused() {
    let program = |body: &str| format!("%\nO1001 (FINISH)\nG21\nG17 G90 G94\nG0 X1.0\n{body}\nM30\n%\n");
    read(&program("G93 G1 X2.5 F3.0\nG4 X0.5\nG4 P500")).expect("a good program");
    for (body, why) in [
        ("G93 G1 X2 F3.0", "no decimal point"),
        ("G93 G1 X2.00001 F3.0", "too many digits"),
        ("G93 G1 X10000.0 F3.0", "out of range"),
        ("G93 G1 X2.0 F10000.0", "F10000.0"),
        ("G93 G1 X2.0 F0.12345", "F0.12345"),
        ("G93 G1 X2.0", "without F"),
        ("S300.5 M3", "no whole number"),
        ("G4 X1", "milliseconds"),
        ("G4", "without its time"),
        ("G710", "improper G-code"),
        ("(µM)", "no character"),
        ("(A (B))", "brackets"),
        ("; COMMENT", "no character"),
        ("Q3.0", "means something else"),
    ] {
        let refused = read(&program(body)).expect_err(body);
        assert!(refused.contains(why), "{body}: {refused}");
    }
    for (head, why) in [("O9001", "protected"), ("FINISH", "no program number")] {
        let refused = read(&program("").replace("O1001 (FINISH)", head)).expect_err(head);
        assert!(refused.contains(why), "{head}: {refused}");
    }
}
