//! Numbers out of the lines of a table: what parts its cells, which sign its decimals have, what is a hole.
//!
//! The first of these that a line has parts its cells: tabulator, semicolon, comma, blanks. A comma is the decimal sign
//! where cells are parted otherwise and have at most one comma and no point; commas in a table without another
//! separator are read as separators only where that is certain. Holes: empty cells, `nan`, `bad`, `---`. A separator at
//! the end of every line is none, but in the files of this program, where it stands before a hole. Numbers in quotation
//! marks are those numbers.

use super::super::bounds::{MOST_POINTS, height};
use crate::error::FileFault;
use crate::text::quoted;

/// How cells are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TextLayout {
    /// None: blanks.
    separator: Option<char>,
    decimal_comma: bool,
    /// The last cell of every line is empty and none.
    trailing: bool,
}

/// The numbers of a table.
#[derive(Debug)]
pub(super) struct TextTable {
    pub(super) columns: usize,
    pub(super) values: Vec<f64>,
    pub(super) remarks: Vec<String>,
}

/// A cell that stands for a point that was not measured.
fn is_hole(cell: &str) -> bool {
    cell.is_empty() || cell == "---" || cell.eq_ignore_ascii_case("bad") || cell.eq_ignore_ascii_case("nan")
}

/// Whether a line begins a table: every cell is a number or a hole, and one at least a number.
pub(super) fn begins(line: &str) -> bool {
    let mut numbers = false;
    line.split(['\t', ';', ',', ' ']).map(str::trim).all(|part| {
        let number = part.parse::<f64>().is_ok();
        numbers |= number && !is_hole(part);
        number || is_hole(part)
    }) && numbers
}

/// The text with its numbers out of quotation marks.
pub(super) fn without_quotes(text: String) -> Result<String, FileFault> {
    if !text.contains('"') {
        return Ok(text);
    }
    let mut plain = String::with_capacity(text.len());
    for (index, line) in text.split_inclusive('\n').enumerate() {
        let bare = line.replace('"', "");
        if !line.contains('"') || !begins(&bare) {
            plain.push_str(line);
            continue;
        }
        // Quotation marks that hold a comma beside commas that part cells.
        let (inside, outside) = (line.split('"').skip(1).step_by(2), line.split('"').step_by(2));
        if inside.into_iter().any(|part| part.contains(',')) && outside.into_iter().any(|part| part.contains(',')) {
            return Err(format!(
                "line {}: `{}`: commas part the cells and are decimal signs in quotation marks: export with points as \
                 decimal signs, or with semicolons between cells",
                index + 1,
                quoted(line.trim())
            )
            .into());
        }
        plain.push_str(&bare);
    }
    Ok(plain)
}

/// Whether some cell of a line is a number.
pub(super) fn has_number(line: &str) -> bool {
    line.split(['\t', ';', ',', ' ']).any(|part| part.trim().parse::<f64>().is_ok())
}

impl TextLayout {
    /// Of the lines of a table; `own` files have commas and points.
    pub(super) fn of(lines: &[(usize, &str)], own: bool) -> Result<Self, FileFault> {
        let has = |sign: char| lines.iter().any(|(_, line)| line.contains(sign));
        let separator = if has('\t') {
            Some('\t')
        } else if has(';') {
            Some(';')
        } else if has(',') && !commas_are_decimal(lines, own)? {
            Some(',')
        } else {
            None
        };
        let decimal_comma = separator != Some(',') && has(',');
        if decimal_comma && has('.') {
            let (number, line) = lines.iter().find(|(_, line)| line.contains(',')).expect("a comma");
            return Err(format!(
                "line {number}: `{}`: numbers with both commas and points: export without thousands separators, or \
                 with one decimal sign",
                quoted(line.trim())
            )
            .into());
        }
        let ends = |(_, line): &(usize, &str)| {
            separator.is_some_and(|sign| line.trim_end_matches([' ', '\r']).ends_with(sign))
        };
        Ok(Self { separator, decimal_comma, trailing: !own && lines.iter().all(ends) })
    }

    /// Blanks part the cells.
    pub(super) fn is_blank(self) -> bool {
        self.separator.is_none()
    }

    /// Cells of a line.
    pub(super) fn cells<'a>(self, line: &'a str) -> Box<dyn Iterator<Item = &'a str> + 'a> {
        let line = line.trim_end_matches('\r');
        match self.separator {
            Some(sign) => {
                let line =
                    if self.trailing { line.trim_end_matches(' ').strip_suffix(sign).unwrap_or(line) } else { line };
                Box::new(line.split(sign).map(str::trim))
            }
            None => Box::new(line.split_whitespace()),
        }
    }

    /// Numbers of all lines, every line as long as the first.
    pub(super) fn table(self, lines: &[(usize, &str)]) -> Result<TextTable, FileFault> {
        let (mut values, mut columns) = (Vec::new(), 0);
        for (row, &(number, line)) in lines.iter().enumerate() {
            let before = values.len();
            for (index, cell) in self.cells(line).enumerate() {
                if values.len() == MOST_POINTS {
                    return Err(FileFault::TooLarge(format!(
                        "line {number}: more than {MOST_POINTS} heights: crop or thin the surface"
                    )));
                }
                let at = |reason: String| format!("line {number}, column {}: {reason}", index + 1);
                values.push(if is_hole(cell) {
                    f64::NAN
                } else if self.decimal_comma && cell.contains(',') {
                    height(&cell.replacen(',', ".", 1))
                        .map_err(|_| at(format!("`{}` is not a height", quoted(cell))))?
                } else {
                    height(cell).map_err(|fault| at(fault.to_string()))?
                });
            }
            let count = values.len() - before;
            if row > 0 && count != columns {
                return Err(format!("line {number} has {count} heights, the first row has {columns}").into());
            }
            columns = count;
        }
        let mut remarks = Vec::new();
        let named = match self.separator {
            Some(';') => "semicolons between cells",
            Some('\t') => "tabulators between cells",
            Some(_) => "commas between cells",
            None => "blanks between cells",
        };
        if self.decimal_comma {
            remarks.push(format!("{named}, decimal commas"));
        }
        if self.trailing {
            remarks.push(format!("{named}, one at the end of every line, which is no cell"));
        }
        Ok(TextTable { columns, values, remarks })
    }
}

/// Whether commas, in a table without tabulators and semicolons, are decimal signs between blanks.
fn commas_are_decimal(lines: &[(usize, &str)], own: bool) -> Result<bool, FileFault> {
    let has = |sign: char| lines.iter().any(|(_, line)| line.contains(sign));
    if own || has('.') {
        return Ok(false);
    }
    let words = || lines.iter().flat_map(|(_, line)| line.split_whitespace());
    let blanks = lines.iter().any(|(_, line)| line.split_whitespace().nth(1).is_some());
    if blanks {
        // `1,5 2,5` against `1, 2, 3`.
        return Ok(words().all(|word| word.matches(',').count() <= 1 && !word.ends_with(',') && !word.starts_with(',')));
    }
    // Whole numbers between commas, or numbers with decimal commas between commas: fractions have no sign, and
    // leading zeros (`1,048`) or a whole part of -0 are no whole numbers.
    let pairs = |line: &str| {
        let cells: Vec<String> = line.trim_end_matches(',').split(',').map(|cell| cell.trim().to_owned()).collect();
        let digits = |cell: &String| !cell.is_empty() && cell.bytes().all(|b| b.is_ascii_digit());
        (cells.len().is_multiple_of(2) && cells.iter().skip(1).step_by(2).all(digits)).then_some(cells)
    };
    let paired: Option<Vec<Vec<String>>> = lines.iter().map(|(_, line)| pairs(line)).collect();
    let Some(rows) = paired else { return Ok(false) };
    let fraction = |cell: &String| cell.len() > 1 && cell.starts_with('0');
    let decimal = rows.iter().any(|cells| {
        cells.iter().step_by(2).any(|whole| whole == "-0") || cells.iter().skip(1).step_by(2).any(fraction)
    });
    if decimal || rows.iter().all(|cells| cells.len() == 2) {
        let (number, line) = lines[0];
        return Err(format!(
            "line {number}: `{}`: commas here may part cells or be decimal signs: export with points as decimal \
             signs, or with semicolons between cells",
            quoted(line.trim())
        )
        .into());
    }
    Ok(false)
}
