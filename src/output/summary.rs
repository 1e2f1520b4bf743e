//! Findings for the terminal: the headline, then what each section shows, then warnings by severity; at most 80
//! columns.
//!
//! Neighbouring sections that show the same quantities become the rows of one table, such as the texture of all
//! windows. What is undefined is told with its reason in the headline and left out below it.

use crate::findings::{Entry, Findings, Level, Notice, Quantity, Section};
use crate::number_text::{plain, significant};
use crate::output::text::{Sheet, VALUE_COLUMN};
use crate::progress::duration_text;
use crate::wrap::wrapped;
use gearcut_core::cut::KERNEL_UM;

/// Most lines of all warnings in a brief summary, and of each.
const LINES_OF_WARNINGS: usize = 12;
const LINES_OF_A_WARNING: usize = 3;
/// Widest line, characters.
const WIDTH: usize = 80;
/// Shares below this are rounding, per cent.
const LEAST_PERCENT: f64 = 1e-9;

/// Headline, sections and warnings.
pub fn print(findings: &Findings, sheet: &mut Sheet) {
    for entry in &findings.headline {
        line(sheet, &entry.title, &shown(&entry.quantity));
    }
    for section in &findings.sections {
        print_section(sheet, &section.title, section);
    }
    for warning in &findings.warnings {
        let mut lines = wrapped(&warning.line_with_id(), WIDTH - 2).into_iter();
        sheet.heading(&lines.next().unwrap_or_default());
        lines.for_each(|line| sheet.words(&line));
    }
}

/// What a screen holds: the headline and whatever else has room, then the gravest warnings; the sheet
/// has `most` lines at most.
pub fn print_brief(findings: &Findings, sheet: &mut Sheet, most: usize) {
    let warnings = brief_warnings(&findings.warnings);
    // An empty line and the heading.
    let most = most.saturating_sub(warnings.len() + 2);
    let headline = findings.headline.iter().filter(|entry| is_defined(entry) && !is_none(&entry.quantity));
    for entry in headline.take(most.saturating_sub(sheet.count_lines())) {
        sheet.line(&entry.title, on_a_line(&entry.quantity));
    }
    for section in &findings.sections {
        let mut own = Sheet::default();
        print_section(&mut own, &section.title, section);
        sheet.append_within(&own, most.saturating_sub(sheet.count_lines()));
    }
    sheet.heading("What must be known, the gravest first");
    for line in &warnings {
        sheet.margin(line);
    }
}

/// Lines of warnings in a brief summary: the gravest first, each on few lines.
fn brief_warnings(warnings: &[Notice]) -> Vec<String> {
    let mut lines = Vec::new();
    for (index, warning) in warnings.iter().enumerate() {
        let mut own = wrapped(&warning.line_with_id(), WIDTH - "   ...".len());
        if own.len() > LINES_OF_A_WARNING {
            own.truncate(LINES_OF_A_WARNING);
            own[LINES_OF_A_WARNING - 1].push_str(" ...");
        }
        for line in &mut own[1..] {
            line.insert_str(0, "  ");
        }
        if lines.len() + own.len() > LINES_OF_WARNINGS {
            lines.push(format!("and {} more", warnings.len() - index));
            break;
        }
        lines.extend(own);
    }
    lines
}

/// A count of nothing, which is as it should be.
fn is_none(quantity: &Quantity) -> bool {
    quantity.whole() == Some(0)
}

/// Value and unit, with the place where a line has room for it.
fn on_a_line(quantity: &Quantity) -> String {
    let whole = shown(quantity);
    if whole.chars().count() <= WIDTH - VALUE_COLUMN { whole } else { without_place(quantity) }
}

/// A label and its value on as many lines as it takes.
pub fn line(sheet: &mut Sheet, label: &str, value: &str) {
    for (i, part) in wrapped(value, WIDTH - VALUE_COLUMN).iter().enumerate() {
        sheet.line(if i == 0 { label } else { "" }, part);
    }
}

fn is_defined(entry: &Entry) -> bool {
    entry.quantity.why().is_none()
}

/// What a section shows, its parts included.
fn shown_entries(section: &Section) -> Vec<&Entry> {
    let own = section.entries.iter().filter(|entry| entry.level <= Level::Summary);
    own.chain(section.sections.iter().flat_map(shown_entries)).collect()
}

/// Prints a section under a heading, if it shows anything.
fn print_section(sheet: &mut Sheet, title: &str, section: &Section) {
    let mut entries = section.entries.iter().filter(|e| e.level <= Level::Summary && is_defined(e)).peekable();
    let mut headed = entries.peek().is_some();
    if headed {
        sheet.heading(title);
    }
    for entry in entries {
        line(sheet, &entry.title, &shown(&entry.quantity));
    }
    let parts: Vec<&Section> =
        section.sections.iter().filter(|part| shown_entries(part).into_iter().any(is_defined)).collect();
    for alike in parts.chunk_by(|a, b| form(a) == form(b)) {
        match table(alike) {
            Some(rows) => {
                if !std::mem::replace(&mut headed, true) {
                    sheet.heading(title);
                }
                sheet.table(&rows);
            }
            None => alike.iter().for_each(|part| {
                print_section(sheet, &format!("{}: {}", section.title, part.title), part);
            }),
        }
    }
}

/// Titles of what a section shows, with units where the title does not name them.
fn form(section: &Section) -> Vec<String> {
    shown_entries(section)
        .into_iter()
        .map(|entry| match entry.quantity.unit() {
            Some(unit) if unit != "1" && !entry.title.contains(unit) => format!("{} {unit}", entry.title),
            _ => entry.title.clone(),
        })
        .collect()
}

/// Sections of one form as rows under its titles; none for a single section, for titles that repeat, and where it
/// would be wider than a line.
fn table(sections: &[&Section]) -> Option<Vec<Vec<String>>> {
    let mut titles = vec![String::new()];
    titles.extend(form(sections.first().filter(|_| sections.len() > 1)?));
    if (1..titles.len()).any(|i| titles[..i].contains(&titles[i])) {
        return None;
    }
    let mut rows = vec![titles];
    for section in sections {
        let values = shown_entries(section).into_iter().map(|entry| value_text(&entry.quantity));
        rows.push(std::iter::once(section.title.clone()).chain(values).collect());
    }
    let widest = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let width: usize = 2 + (0..rows[0].len()).map(widest).sum::<usize>() + 3 * (rows[0].len() - 1);
    (width <= WIDTH).then_some(rows)
}

/// The value without its unit.
fn value_text(quantity: &Quantity) -> String {
    let Some(value) = quantity.value() else { return quantity.words().unwrap_or("-").to_owned() };
    // What lies below the resolution is rounding and reads as zero.
    let least = match quantity.unit() {
        Some("um") => KERNEL_UM,
        Some("%") => LEAST_PERCENT,
        _ => 0.0,
    };
    if quantity.whole().is_some() {
        plain(value)
    } else {
        significant(if value.abs() < least { 0.0 } else { value }, 4)
    }
}

/// Value and unit.
fn without_place(quantity: &Quantity) -> String {
    match (quantity.value(), quantity.unit()) {
        (Some(seconds), Some("s")) => duration_text(seconds),
        (Some(_), Some(unit)) if unit != "1" => format!("{} {unit}", value_text(quantity)),
        _ => value_text(quantity),
    }
}

/// Value, unit and place, or why there is none.
pub fn shown(quantity: &Quantity) -> String {
    if let Some(why) = quantity.why() {
        return format!("none ({why})");
    }
    let text = without_place(quantity);
    quantity.place().map_or_else(|| text.clone(), |place| format!("{text} ({})", place.words()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::Severity;
    use crate::findings::{Place, QuantityRow};

    const NO_DEXEL: &str = "no dexel was left by the first or last strokes at all";
    const NONE: &str = "there is none";
    static TOOTH: QuantityRow = QuantityRow::new("tooth", "1", "tooth");
    static SA: QuantityRow = QuantityRow::new("Sa", "um", "mean height").shown();
    static STOCK: QuantityRow = QuantityRow::new("smallest_stock", "mm", "stock").titled("smallest normal stock");
    static WITNESS: QuantityRow = QuantityRow::new("witness_mark", "um", "witness mark").or(&[NO_DEXEL]);
    static UNDERCUT: QuantityRow = QuantityRow::new("undercut_flanks", "flanks", "undercut");
    static LEFT: QuantityRow = QuantityRow::new("left_volume", "mm^3", "volume").titled("left").shown();
    static DEEPEST: QuantityRow = QuantityRow::new("deepest", "mm", "depth").or(&[NONE]).shown();
    static SLICES: QuantityRow = QuantityRow::new("slices", "slices", "slices");
    static MORE: QuantityRow = QuantityRow::new("more", "teeth", "teeth").shown();

    fn window(key: &str, sa: f64) -> Section {
        Section::new(key, key.replace('_', " "))
            .entries([TOOTH.of(3_u32)])
            .part(Section::new("parameters", "Parameters").entries([SA.of(sa)]))
    }

    fn findings() -> Findings {
        let headline = [
            STOCK.of(0.677_21).at(Place::on_flank(35, "left", 3.54, -15.0)),
            WITNESS.none(NO_DEXEL),
            UNDERCUT.of(12_u32),
        ];
        let words = "words that go on and on until the line is much wider than any terminal would like it";
        let sections = vec![
            Section::new("texture", "Texture").part(window("tooth_03_left", 0.25)).part(window("tooth_03_right", 2.0)),
            Section::new("blank", "The whole gear").entries([LEFT.of(123.4), DEEPEST.none(NONE)]),
            Section::new("empty", "Nothing to show").entries([SLICES.of(3_u32)]),
        ];
        let warnings = [Notice::new("flank.made", Severity::Warning, words)];
        Findings::new("shaping", "made_by_hand", true, headline, warnings, sections)
    }

    /// Forty entries, ten sections and thirty long warnings on 33 lines, nothing but the ends of them cut off.
    #[test]
    fn a_brief_summary_is_no_longer_than_asked() {
        let mut found = findings();
        found.headline.extend((0..40_u64).map(|i| MORE.of(i).titled(format!("more {i}"))));
        let title = |i: u64| format!("section {i}");
        found.sections.extend((0..10).map(|i| Section::new("some", title(i)).entries([MORE.of(i).titled("of it")])));
        found.warnings = (0..30)
            .map(|i| Notice::new("flank.made", Severity::Warning, format!("{i} {}", "many words ".repeat(30))))
            .collect();
        let mut sheet = Sheet::brief();
        sheet.heading("a gear");
        print_brief(&found, &mut sheet, 33);
        assert!(sheet.count_lines() <= 33, "{}", sheet.count_lines());
        let text = sheet.into_text();
        assert!(text.contains("smallest normal stock         0.6772 mm\n"), "{text}");
        assert!(!text.contains("witness mark") && !text.contains("more 0 "), "none and nothing are left out: {text}");
        assert!(text.contains(" ...\n") && text.contains("and 26 more"), "{text}");
    }

    #[test]
    fn the_summary_is_narrow_and_has_the_headline_first() {
        let mut sheet = Sheet::default();
        print(&findings(), &mut sheet);
        let text = sheet.into_text();
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH), "{text}");
        let expected = "  smallest normal stock         0.6772 mm (tooth 35 left, u 3.54 mm, v -15.00\n\
                        \u{20}                               mm)\n\
                        \u{20} witness mark                  none (no dexel was left by the first or last\n\
                        \u{20}                               strokes at all)\n\
                        \u{20} undercut flanks               12 flanks\n\
                        \nTexture\n\
                        \u{20}                   Sa um\n\
                        \u{20} tooth 03 left    0.2500\n\
                        \u{20} tooth 03 right    2.000\n\
                        \nThe whole gear\n\
                        \u{20} left                          123.4 mm^3\n\
                        \nwarning: words that go on and on until the line is much wider than any\n\
                        \u{20} terminal would like it [flank.made]\n";
        assert_eq!(text, expected);
    }
}
