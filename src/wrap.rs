//! Texts as a terminal takes them: in lines of a width, and without characters that command it.
//!
//! The terminal's summary and the reference of scene keys are wrapped alike.

/// Text broken between words into lines of at most `width` characters; a longer word stays whole.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    hanging("", text, 0, width)
}

/// Text behind a label, broken between words; the lines after the first are indented.
fn hanging(label: &str, text: &str, indent: usize, width: usize) -> Vec<String> {
    let mut lines = vec![label.to_owned()];
    let mut bare = true; // whether the last line has no word yet
    for word in text.split(' ') {
        let last = lines.last_mut().expect("one line at least");
        if bare {
            last.push_str(word);
        } else if last.chars().count() + 1 + word.chars().count() <= width {
            last.push(' ');
            last.push_str(word);
        } else {
            lines.push(format!("{:indent$}{word}", ""));
        }
        bare &= word.is_empty();
    }
    lines
}

/// A text whose lines fit a width. A value goes on below where it begins, two blanks or more behind its label; a
/// message goes on below its second letter. Of rows of tables, with more columns than these, only words in the last
/// column go on below where they begin; numbers stay whole.
pub fn fitted(text: &str, width: usize) -> String {
    text.split('\n').map(|line| fitted_line(line, width)).collect::<Vec<_>>().join("\n")
}

fn fitted_line(line: &str, width: usize) -> String {
    let lead = line.len() - line.trim_start().len();
    let columns = line.split("  ").filter(|part| !part.trim().is_empty()).count();
    if line.chars().count() <= width {
        return line.to_owned();
    }
    let value_at = if columns > 1 { line.rfind("  ").map_or(lead, |gap| gap + 2) } else { lead };
    let (label, value) = line.split_at(value_at);
    let column = label.chars().count();
    let longest = value.split(' ').map(|word| word.chars().count()).max().unwrap_or(0);
    // A word that only fits on a line of its own, such as a path, goes on one.
    if columns == 2 && column + longest > width {
        let indent = " ".repeat(lead + 2);
        return format!("{}\n{}", label.trim_end(), hanging(&indent, value, lead + 2, width).join("\n"));
    }
    let beside = columns > 1 && column <= width / 2;
    if columns > 2 && !(beside && value.contains(' ')) {
        return line.to_owned();
    }
    hanging(label, value, if beside { column } else { lead + 2 }, width).join("\n")
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
    fn values_and_messages_go_on_below_their_beginning() {
        let text = "warning: one two three\n  label     four five six seven\n  a  b  ddddddddddddddddddddd\n  S  1  \
                    five six seven\n  label     a/path/of/20/chars\nshort";
        let fitted = fitted(text, 20);
        assert_eq!(
            fitted,
            "warning: one two\n  three\n  label     four\n    five six seven\n  a  b  ddddddddddddddddddddd\n  S  1  \
             five six\n        seven\n  label\n    a/path/of/20/chars\nshort"
        );
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(words(&fitted), words(text));
    }

    #[test]
    fn nothing_commands_the_terminal() {
        assert_eq!(printable("a\u{1b}[31mred\u{7}\tb\r\n\u{9b}1m"), "a\\u{1b}[31mred\\u{7}\tb\\r\n\\u{9b}1m");
        assert_eq!(printable("µm ° –"), "µm ° –");
    }
}
