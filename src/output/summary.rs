//! Findings for the terminal: the headline, then what each section shows, then warnings by severity; at most 80
//! columns.
//!
//! Neighbouring sections that show the same quantities become the rows of one table, such as the texture of all
//! windows. What is undefined is told with its reason in the headline and left out below it.

use crate::findings::{Entry, Findings, Level, Quantity, Section};
use crate::output::progress::duration_text;
use crate::output::text::{Sheet, VALUE_COLUMN, plain, significant};
use crate::wrap::wrapped;
use gearcut_core::cut::KERNEL_UM;

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
        let mut lines = wrapped(&warning.line(), WIDTH - 2).into_iter();
        sheet.heading(&lines.next().unwrap_or_default());
        lines.for_each(|line| sheet.words(&line));
    }
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
    if quantity.is_count() { plain(value) } else { significant(if value.abs() < least { 0.0 } else { value }, 4) }
}

/// Value, unit and place, or why there is none.
pub fn shown(quantity: &Quantity) -> String {
    if let Some(why) = quantity.why() {
        return format!("none ({why})");
    }
    let text = match (quantity.value(), quantity.unit()) {
        (Some(seconds), Some("s")) => duration_text(seconds),
        (Some(_), Some(unit)) if unit != "1" => format!("{} {unit}", value_text(quantity)),
        _ => value_text(quantity),
    };
    quantity.place().map_or_else(|| text.clone(), |place| format!("{text} ({})", place.words()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::{Place, Warning};

    fn window(key: &str, sa: f64) -> Section {
        Section::new(key, key.replace('_', " "))
            .with("tooth", Quantity::count(3, "1", "tooth"))
            .part(Section::new("parameters", "Parameters").shown("Sa", "Sa", Quantity::number(sa, "um", "mean height")))
    }

    fn findings() -> Findings {
        let stock = Quantity::number(0.677_21, "mm", "stock").at(Place::on_flank(35, "left", 3.54, -15.0));
        let undefined =
            Quantity::undefined("um", "witness mark", "no dexel was left by the first or last strokes at all");
        Findings {
            program_version: "0.1.0".to_owned(),
            process: "shaping".to_owned(),
            scene: "made_by_hand".to_owned(),
            complete: true,
            headline: vec![
                Entry::headline("smallest_normal_stock", "smallest normal stock", stock),
                Entry::headline("witness_mark", "witness mark", undefined),
                Entry::headline("undercut_flanks", "undercut flanks", Quantity::count(12, "flanks", "undercut")),
            ],
            warnings: vec![Warning::warn(
                "words that go on and on until the line is much wider than any terminal would like it",
            )],
            sections: vec![
                Section::new("texture", "Texture")
                    .part(window("tooth_03_left", 0.25))
                    .part(window("tooth_03_right", 2.0)),
                Section::new("blank", "The whole gear")
                    .shown("left_volume", "left", Quantity::number(123.4, "mm3", "volume"))
                    .shown("deepest", "deepest", Quantity::undefined("mm", "depth", "there is none")),
                Section::new("empty", "Nothing to show").with("slices", Quantity::count(3, "slices", "slices")),
            ],
        }
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
                        \u{20} left                          123.4 mm3\n\
                        \nwarning: words that go on and on until the line is much wider than any\n\
                        \u{20} terminal would like it\n";
        assert_eq!(text, expected);
    }
}
