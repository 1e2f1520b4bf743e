//! Words of a program: letters with numbers, block by block, comments left out.

/// A word: letter, number, and the text for messages.
pub struct Word<'a> {
    /// Upper-case letter.
    pub letter: char,
    /// Its number.
    pub number: f64,
    /// As it stands in the program.
    pub text: &'a str,
}

/// Takes block after block; `block` tells whether the program has ended. Gives the number of lines, and whether an end
/// was there; errors name the line.
///
/// # Errors
/// Line and word of what is malformed.
pub fn blocks(
    text: &str,
    mut block: impl FnMut(&[Word]) -> Result<bool, String>,
) -> Result<(usize, Result<(), String>), String> {
    let (mut lines, mut ended) = (0, false);
    for (index, line) in text.lines().enumerate() {
        lines = index + 1;
        let words = words(line).map_err(|why| format!("line {lines}: {why}"))?;
        if ended && !words.is_empty() {
            return Err(format!("line {lines}: a block after the end of the program"));
        }
        ended = block(&words).map_err(|why| format!("line {lines}: {why}"))?;
    }
    let cut_off = || format!("line {lines}: the program ends without M30: it may have been cut off");
    Ok((lines, if ended { Ok(()) } else { Err(cut_off()) }))
}

/// Splits a line into words, comments left out.
fn words(line: &str) -> Result<Vec<Word<'_>>, String> {
    let mut found = Vec::new();
    let mut rest = line.trim();
    while let Some(first) = rest.chars().next() {
        if first == ';' || first == '%' {
            break;
        }
        if first == '(' {
            let Some(end) = rest.find(')') else { return Err(format!("the comment `{}` is not closed", cut(rest))) };
            rest = rest[end + 1..].trim_start();
            continue;
        }
        if !first.is_ascii_alphabetic() {
            return Err(format!("`{}` does not begin with a letter", cut(rest)));
        }
        let number = rest[1..].trim_start();
        let digits =
            number.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '+' | '-'))).unwrap_or(number.len());
        let text = &rest[..rest.len() - number.len() + digits];
        let value: f64 =
            number[..digits].parse().map_err(|_| format!("word `{}`: no number after the letter", cut(text)))?;
        if !value.is_finite() {
            return Err(format!("word `{}`: the number is too large", cut(text)));
        }
        found.push(Word { letter: first.to_ascii_uppercase(), number: value, text });
        rest = number[digits..].trim_start();
    }
    Ok(found)
}

fn cut(text: &str) -> String {
    let mut short: String = text.chars().take(24).collect();
    if short.len() < text.len() {
        short.push_str("...");
    }
    short
}
