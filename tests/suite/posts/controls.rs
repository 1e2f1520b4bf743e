//! What all controls have in common: words, modal states, blocks that take their time.

use std::collections::BTreeMap;

/// A word of a block.
#[derive(Debug, Clone, PartialEq)]
pub struct Word {
    pub letter: char,
    pub number: f64,
    /// The number as it is written.
    pub text: String,
}

/// Positions of the axes that have one, mm and deg.
pub type Position = BTreeMap<char, f64>;

/// What a program does.
#[derive(Debug, Default)]
pub struct Done {
    /// Positions that rapid travel led to, in order, with whether the lines had begun.
    pub rapid: Vec<(bool, Position)>,
    /// Ends of the lines with their moments, min; the first is where they begin.
    pub path: Vec<(f64, Position)>,
    /// Speed of the spindle when it was switched on.
    pub speed: Option<f64>,
    /// Axes at rest after the last line, s.
    pub dwell_s: f64,
    pub ended: bool,
}

/// What a control's reader makes of a block.
pub struct Block {
    pub words: Vec<Word>,
    /// The dwell of a block with G4, s.
    pub dwell_s: Option<f64>,
}

/// Runs blocks: G0, G1, G90, G91, G93, G94, S, M3, M5, M30; other words are the readers' own affair.
///
/// # Errors
/// Number of the block and what is wrong with it.
pub fn run(blocks: &[Block]) -> Result<Done, String> {
    let mut done = Done::default();
    let (mut at, mut motion, mut incremental, mut inverse) = (Position::new(), None, None, None);
    let (mut speed, mut runs, mut minutes) = (None, false, 0.0);
    for (index, block) in blocks.iter().enumerate() {
        let wrong = |why: &str| Err(format!("block {index}: {why}"));
        if done.ended {
            return wrong("a block after the end");
        }
        let (mut target, mut feed, mut starts) = (Position::new(), None, false);
        for word in &block.words {
            match (word.letter, word.number) {
                ('G', 0.0) => motion = Some(0),
                ('G', 1.0) => motion = Some(1),
                ('G', 90.0) => incremental = Some(false),
                ('G', 91.0) => incremental = Some(true),
                ('G', 93.0) => inverse = Some(true),
                ('G', 94.0) => inverse = Some(false),
                ('S', number) => speed = Some(number),
                ('M', 3.0) => starts = true,
                ('M', 5.0) => runs = false,
                ('M', 30.0) => done.ended = true,
                ('F', number) if block.dwell_s.is_none() => feed = Some(number),
                ('A' | 'B' | 'C' | 'X' | 'Y' | 'Z' | 'W', number) if block.dwell_s.is_none() => {
                    target.insert(word.letter, number);
                }
                _ => {}
            }
        }
        if let Some(seconds) = block.dwell_s {
            if !target.is_empty() {
                return wrong("a dwell with positions");
            }
            done.dwell_s += seconds;
        }
        if starts {
            if speed.is_none() {
                return wrong("the spindle starts without S");
            }
            (runs, done.speed) = (true, speed);
        }
        if target.is_empty() {
            continue;
        }
        let Some(incremental) = incremental else { return wrong("neither G90 nor G91 has been given") };
        let before = at.clone();
        for (&letter, &number) in &target {
            let from = at.get(&letter).copied();
            match (incremental, from) {
                (true, None) => return wrong("an increment from nowhere"),
                (true, Some(from)) => at.insert(letter, from + number),
                (false, _) => at.insert(letter, number),
            };
        }
        match (motion, inverse) {
            (None, _) => return wrong("axes move, but neither G0 nor G1 has been given"),
            (Some(0), _) if runs => return wrong("rapid travel while the spindle runs"),
            (Some(0), _) => done.rapid.push((!done.path.is_empty(), at.clone())),
            (Some(_), Some(true)) => {
                let Some(feed) = feed else { return wrong("G93 without F in the block") };
                if done.path.is_empty() {
                    done.path.push((0.0, before));
                }
                minutes += 1.0 / feed;
                done.path.push((minutes, at.clone()));
            }
            (Some(_), _) => return wrong("a line without G93: the meaning of F is that of mm and deg"),
        }
    }
    if !done.ended {
        return Err("the program does not end".to_owned());
    }
    Ok(done)
}

/// Refuses two words of one modal group in a block: `groups` lists the codes of each.
pub fn one_of_each_group(words: &[Word], groups: &[&[f64]]) -> Result<(), String> {
    for group in groups {
        let of: Vec<&Word> = words.iter().filter(|word| word.letter == 'G' && group.contains(&word.number)).collect();
        if of.len() > 1 {
            return Err(format!("G{} and G{} in one block", of[0].text, of[1].text));
        }
    }
    let letters = words.iter().filter(|word| !matches!(word.letter, 'G' | 'M'));
    for letter in letters.map(|word| word.letter) {
        if words.iter().filter(|word| word.letter == letter).count() > 1 {
            return Err(format!("{letter} stands twice in a block"));
        }
    }
    Ok(())
}

/// Splits what is no comment into words; `separated` where the control wants blanks between them.
pub fn words(block: &str) -> Result<Vec<Word>, String> {
    let mut found = Vec::new();
    let mut rest = block.trim();
    while let Some(letter) = rest.chars().next() {
        if !letter.is_ascii_uppercase() {
            return Err(format!("`{rest}` does not begin with a letter"));
        }
        let number = &rest[1..];
        let end = number.find(|c: char| !(c.is_ascii_digit() || ".+-".contains(c))).unwrap_or(number.len());
        let text = &number[..end];
        let value = text.parse().map_err(|_| format!("`{letter}{text}` is no word"))?;
        found.push(Word { letter, number: value, text: text.to_owned() });
        rest = number[end..].trim_start();
    }
    Ok(found)
}
