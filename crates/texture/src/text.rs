//! Words out of a file, made fit to print: a file must not steer the terminal, nor fill it.

/// Characters of a file's word that a message quotes.
const QUOTED: usize = 40;
/// Characters of a whole message; only texts of other libraries about hostile files come near.
const MESSAGE: usize = 600;

/// A word of a file for a message: control characters replaced, cut where it is long.
pub(crate) fn quoted(word: &str) -> String {
    printable(word, QUOTED)
}

/// A whole reason for a message; its line breaks stay.
pub(crate) fn reason(text: &str) -> String {
    let lines: Vec<String> = text.lines().map(|line| printable(line, MESSAGE)).collect();
    shortened(&lines.join("\n"), MESSAGE)
}

/// A length to four decimals, without trailing zeros.
pub(crate) fn short(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn printable(text: &str, most: usize) -> String {
    let plain: String =
        text.chars().take(most + 1).map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect();
    shortened(&plain, most)
}

fn shortened(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        None => text.to_owned(),
        Some(_) => text.chars().take(most - 3).chain("...".chars()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_cannot_steer_the_terminal() {
        assert_eq!(quoted("\u{1b}[31mred\u{7}\u{9b}2J"), "\u{fffd}[31mred\u{fffd}\u{fffd}2J");
        assert_eq!(reason("first\nse\u{8}cond"), "first\nse\u{fffd}cond");
        assert_eq!(quoted(&"x".repeat(1_000_000)), format!("{}...", "x".repeat(37)));
        assert_eq!(quoted("\u{b5}m"), "\u{b5}m");
    }
}
