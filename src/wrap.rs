//! Texts as a terminal takes them: in lines of a width, and without characters that command it.
//!
//! The terminal's summary and the reference of scene keys are wrapped alike.

/// Text broken between words into lines of at most `width` characters; a longer word stays whole.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.last_mut().expect("one line at least");
        if last.is_empty() {
            last.push_str(word);
        } else if last.chars().count() + 1 + word.chars().count() <= width {
            last.push(' ');
            last.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

/// A text of others, fit to print: characters that would command the terminal are shown by their codes, line breaks and
/// tabs apart.
pub fn printable(text: &str) -> String {
    let shown = |c: char| {
        if c.is_control() && !matches!(c, '\n' | '\t') { c.escape_default().to_string() } else { c.to_string() }
    };
    text.chars().map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_between_words_at_the_width() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("µµ µµ µµ", 5), ["µµ µµ", "µµ"]);
        assert_eq!(wrapped("unbreakable word", 4), ["unbreakable", "word"]);
    }
    #[test]
    fn nothing_commands_the_terminal() {
        assert_eq!(printable("a\u{1b}[31mred\u{7}\tb\r\n\u{9b}1m"), "a\\u{1b}[31mred\\u{7}\tb\\r\n\\u{9b}1m");
        assert_eq!(printable("µm ° –"), "µm ° –");
    }
}
