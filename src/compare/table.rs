//! The lines of a comparison, as CSV and for the terminal.

use super::lines::{Line, is_rounding};
use super::quantities::{DEFINITION, DIFFERENCE_TO_FIRST, PATH, RATIO_TO_FIRST, UNIT, VALUE_OF_RESULT};
use super::{Comparison, letters};
use crate::findings::{Quantity, Table};
use crate::number_text::significant;
use crate::output::text::Sheet;

/// Longest words that stand in a column of the terminal, characters.
const LONGEST_WORDS: usize = 20;

impl Comparison {
    /// A row with the names of the results, then one for each line. Values are words: those of some lines are.
    pub(super) fn as_table(&self) -> Table {
        let rows = std::iter::once(None).chain(self.lines.iter().map(Some));
        let mut table = Table::over("comparison", "Comparison", rows)
            .column(&PATH, |line| line.map_or("name", |line: &Line| line.name.as_str()))
            .column(&UNIT, |line| Some(line.as_ref()?.either()?.unit()?.to_owned()));
        for (index, (letter, one)) in letters().zip(&self.results).enumerate() {
            table = table.column(VALUE_OF_RESULT.as_column().keyed(letter.to_string()), |line| match line {
                None => Some(one.name.clone()),
                Some(line) => line.quantities[index].as_ref().and_then(in_full),
            });
        }
        for (index, letter) in letters().take(self.results.len()).skip(1).enumerate() {
            let column = DIFFERENCE_TO_FIRST.as_column().keyed(format!("difference_{letter}_minus_a"));
            table = table.column(column, |line| line.and_then(|line| line.differences().nth(index)?));
        }
        for (index, letter) in letters().take(self.results.len()).skip(1).enumerate() {
            let column = RATIO_TO_FIRST.as_column().keyed(format!("ratio_{letter}_to_a"));
            table = table.column(column, |line| line.and_then(|line| line.ratios().nth(index)?));
        }
        let definition = |line: &Line| Some(line.either()?.definition().to_owned());
        let of_names = "name under which the result is shown";
        table.column(&DEFINITION, |line| line.map_or(Some(of_names.to_owned()), definition)).into()
    }

    /// Titles, then one row per line: its values, difference and ratio where there are just two, the unit.
    pub(super) fn printed_rows<'a>(&self, lines: impl Iterator<Item = &'a Line>) -> Vec<Vec<String>> {
        let mut titles = vec![String::new()];
        titles.extend(self.results.iter().map(|one| one.name.clone()));
        let two = self.results.len() == 2;
        if two {
            titles.extend(["difference", "ratio"].map(str::to_owned));
        }
        titles.push("unit".into());
        let rows = lines.map(|line| {
            let mut row = vec![line.title.clone()];
            row.extend(line.quantities.iter().map(|quantity| printed(quantity.as_ref())));
            if two {
                let number = |value: Option<f64>| value.map_or_else(String::new, shown);
                row.extend(line.differences().chain(line.ratios()).map(number));
            }
            row.push(match line.either().and_then(Quantity::unit) {
                None | Some("1") => String::new(),
                Some(unit) => unit.to_owned(),
            });
            row
        });
        [titles].into_iter().chain(rows).collect()
    }
}

/// Blanks between columns of numbers below their names, and before the first of them.
const STACKED_GAP: usize = 2;

impl Comparison {
    /// A table of lines, stacked where it is wider than a line.
    pub(super) fn print_rows<'a>(
        &self,
        sheet: &mut Sheet,
        width: Option<usize>,
        lines: impl Iterator<Item = &'a Line>,
    ) {
        let rows = self.printed_rows(lines);
        let mut table = Sheet::default();
        table.table(&rows);
        match width.filter(|&width| table.is_wider_than(width)) {
            None => sheet.table(&rows),
            Some(width) => self.print_stacked(sheet, width, &rows),
        }
    }

    /// Each name with its unit above its numbers; the results are columns a, b, ..., as many in a line as fit.
    fn print_stacked(&self, sheet: &mut Sheet, width: usize, rows: &[Vec<String>]) {
        let Some((titles, rows)) = rows.split_first() else { return };
        let numbers = titles.len() - 2;
        let results = self.results.len();
        let heads: Vec<String> =
            letters().map(String::from).take(results).chain(titles[1 + results..].to_vec()).collect();
        let cells = rows.iter().flat_map(|row| &row[1..=numbers]).chain(&heads[..numbers]);
        let widest = cells.map(|cell| cell.chars().count()).max().unwrap_or(0);
        let in_line = ((width - 2) / (widest + STACKED_GAP)).max(1);
        let lines = |cells: &[String]| -> Vec<String> {
            let cell = |cell: &String| format!("{:STACKED_GAP$}{cell:>widest$}", "");
            cells.chunks(in_line).map(|line| line.iter().map(cell).collect::<String>().trim_end().to_owned()).collect()
        };
        for (letter, one) in heads.iter().zip(&self.results) {
            sheet.words(&format!("{letter}: {}", one.name));
        }
        for line in lines(&heads[..numbers]) {
            sheet.words(&line);
        }
        for row in rows {
            let unit = &row[1 + numbers];
            sheet.words(&if unit.is_empty() { row[0].clone() } else { format!("{}, {unit}", row[0]) });
            for line in lines(&row[1..=numbers]) {
                sheet.words(&line);
            }
        }
    }
}

fn shown(value: f64) -> String {
    if is_rounding(value) { "0".to_owned() } else { significant(value, 4) }
}

/// A value in full: the fewest digits that read back to it.
fn in_full(quantity: &Quantity) -> Option<String> {
    quantity.words().map(str::to_owned).or_else(|| quantity.value().map(|value| format!("{value:?}")))
}

fn printed(quantity: Option<&Quantity>) -> String {
    let Some(quantity) = quantity else { return "none".to_owned() };
    match (quantity.value(), quantity.words()) {
        (Some(value), _) => shown(value),
        // Places are told at length in the file.
        (None, Some(words)) if words.chars().count() > LONGEST_WORDS => "see the file".to_owned(),
        (None, Some(words)) => words.to_owned(),
        (None, None) => "none".to_owned(),
    }
}
