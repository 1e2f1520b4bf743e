//! A table of findings: columns with unit and definition, rows of numbers, counts and words.
//!
//! A table holds what is the same for every row, such as the allowances of all teeth; a value with a place or a reason
//! of its own is an entry of a section instead.
//!
//! A table may have a CSV file of its own. Where it would swell `results.json`, its rows stand in that file alone:
//! thousands of strokes and points, and rows whose values stand in the tree already, one section each.

use super::datum::Datum;
use super::row::{ColumnChart, QuantityRow};
use std::borrow::Cow;

/// Columns and rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Key in its section.
    pub key: String,
    /// What it shows.
    pub title: String,
    /// Columns; the first names the rows.
    pub columns: Vec<TableColumn>,
    /// Rows of as many cells as there are columns.
    pub rows: Vec<Vec<Datum>>,
    /// Rows after which the gear's shape repeats, if it does.
    pub period_rows: Option<u32>,
    /// Its CSV file in the output folder, such as `tables/flanks.csv`; none where `results.json` is enough.
    pub file: Option<String>,
    /// Whether the rows stand in the file alone: tables read from `results.json` have none then.
    pub rows_in_file: bool,
}

/// One column.
#[derive(Debug, Clone, PartialEq)]
pub struct TableColumn {
    /// Key.
    pub key: Cow<'static, str>,
    /// Unit; none for words, and for numbers whose units another column names row by row.
    pub unit: Option<Cow<'static, str>>,
    /// What its values are.
    pub definition: Cow<'static, str>,
    /// Why a value may be missing; none where none ever is.
    pub why: Option<Cow<'static, str>>,
    /// How comparisons draw it over the first column, if they do.
    pub chart: Option<ColumnChart>,
}

impl Table {
    /// An empty table.
    pub fn new(key: &str, title: &str, columns: Vec<TableColumn>) -> Self {
        Self {
            key: key.to_owned(),
            title: title.to_owned(),
            columns,
            rows: Vec::new(),
            period_rows: None,
            file: None,
            rows_in_file: false,
        }
    }

    /// A table with a row for each of these, whose columns follow.
    pub fn over<T>(key: &str, title: &str, of: impl IntoIterator<Item = T>) -> Columns<T> {
        let of: Vec<T> = of.into_iter().collect();
        let rows = of.iter().map(|_| Vec::new()).collect();
        Columns { of, table: Self { rows, ..Self::new(key, title, Vec::new()) } }
    }

    /// The table, in `tables/<name>.csv` as well.
    #[must_use]
    pub fn in_file(mut self, name: &str) -> Self {
        self.file = Some(format!("tables/{name}.csv"));
        self
    }

    /// The table, its rows in `tables/<name>.csv` alone.
    #[must_use]
    pub fn rows_in_file(self, name: &str) -> Self {
        Self { rows_in_file: true, ..self.in_file(name) }
    }

    /// The table with these rows.
    #[must_use]
    pub fn with_rows(mut self, rows: impl IntoIterator<Item = Vec<Datum>>) -> Self {
        self.rows.extend(rows);
        debug_assert!(self.rows.iter().all(|row| row.len() == self.columns.len()), "{}: a cell per column", self.key);
        self
    }

    /// Where the column of this key stands.
    pub fn column(&self, key: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.key == key)
    }

    /// Numbers of the column of a row of the table of quantities; none for words and for what is undefined.
    pub fn values(&self, row: &QuantityRow) -> impl Iterator<Item = Option<f64>> {
        self.numbers(row.key)
    }

    /// Numbers of a column, row by row; none for words, for what is undefined and for an unknown key.
    pub fn numbers(&self, key: &str) -> impl Iterator<Item = Option<f64>> {
        let column = self.column(key);
        self.rows.iter().map(move |row| row.get(column?)?.number())
    }
}

/// A table in the making: what its rows are of, and its columns so far.
#[derive(Debug)]
pub struct Columns<T> {
    of: Vec<T>,
    table: Table,
}

impl<T> Columns<T> {
    /// With a column of this row.
    #[must_use]
    pub fn column<V: Into<Datum>>(self, row: &QuantityRow, value: impl Fn(&T) -> V) -> Self {
        self.keyed(row.key, row, value)
    }

    /// With a column of this row, under a key that the row cannot know.
    #[must_use]
    pub fn keyed<V: Into<Datum>>(
        mut self,
        key: impl Into<Cow<'static, str>>,
        row: &QuantityRow,
        value: impl Fn(&T) -> V,
    ) -> Self {
        self.table.columns.push(TableColumn::of_row(key.into(), row));
        for (cells, of) in self.table.rows.iter_mut().zip(&self.of) {
            cells.push(value(of).into());
        }
        self
    }

    /// The table, in a file of this name below `tables/` as well.
    #[must_use]
    pub fn in_file(self, name: &str) -> Table {
        self.table.in_file(name)
    }

    /// The table, its rows in the file of this name below `tables/` alone.
    #[must_use]
    pub fn rows_in_file(self, name: &str) -> Table {
        self.table.rows_in_file(name)
    }
}

impl<T> From<Columns<T>> for Table {
    fn from(columns: Columns<T>) -> Self {
        columns.table
    }
}

impl TableColumn {
    fn of_row(key: Cow<'static, str>, row: &QuantityRow) -> Self {
        Self {
            key,
            unit: (!row.unit.is_empty()).then_some(Cow::Borrowed(row.unit)),
            definition: row.definition.into(),
            why: match row.reasons {
                [] => None,
                [reason] => Some(Cow::Borrowed(*reason)),
                reasons => Some(reasons.join("; or ").into()),
            },
            chart: row.chart,
        }
    }

    /// A column of numbers or counts.
    pub fn new(key: impl Into<Cow<'static, str>>, unit: &'static str, definition: &'static str) -> Self {
        Self { key: key.into(), unit: Some(unit.into()), definition: definition.into(), why: None, chart: None }
    }

    /// Key and unit as one word for the head of a file: `AB_mm`, `removal_rate_cm3_per_min`. Pure numbers have no unit
    /// there, nor what counts the things that its key names.
    pub fn head(&self) -> String {
        match self.unit.as_deref() {
            None | Some("1") => self.key.to_string(),
            Some(unit) if self.key.ends_with(unit) => self.key.to_string(),
            Some("%") => format!("{}_percent", self.key),
            Some(unit) => format!("{}_{}", self.key, unit.replace(['^', ' ', '(', ')'], "").replace('/', "_per_")),
        }
    }

    /// A column of numbers of many units; a column of words says in which unit each row is.
    pub fn by_row(key: impl Into<Cow<'static, str>>, definition: &'static str) -> Self {
        Self { key: key.into(), unit: None, definition: definition.into(), why: None, chart: None }
    }

    /// A column of words.
    pub fn words(key: &'static str, definition: &'static str) -> Self {
        Self { key: key.into(), unit: None, definition: definition.into(), why: None, chart: None }
    }

    /// The column, in which a value may be missing for this reason.
    #[must_use]
    pub fn or(mut self, why: &'static str) -> Self {
        self.why = Some(why.into());
        self
    }

    /// The column, drawn as bars by comparisons.
    #[must_use]
    pub fn as_bars(mut self) -> Self {
        self.chart = Some(ColumnChart::Bars);
        self
    }

    /// The column, drawn as a curve by comparisons.
    #[must_use]
    pub fn as_curve(mut self) -> Self {
        self.chart = Some(ColumnChart::Curve);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_of_files_end_with_the_unit() {
        let head = |key: &'static str, unit: &'static str| TableColumn::new(key, unit, "").head();
        assert_eq!(head("AB", "mm"), "AB_mm");
        assert_eq!(head("unevenness", "%"), "unevenness_percent");
        assert_eq!(head("removal_rate", "cm^3/min"), "removal_rate_cm3_per_min");
        assert_eq!(head("work_torque", "N m"), "work_torque_Nm");
        assert_eq!([head("tooth", "1"), head("two_flank_chips", "chips")], ["tooth", "two_flank_chips"]);
        assert_eq!(TableColumn::words("flank", "").head(), "flank");
    }

    #[test]
    fn columns_of_rows_know_unit_and_reasons() {
        static TOOTH: QuantityRow = QuantityRow::new("tooth", "1", "number");
        static RANGE: QuantityRow = QuantityRow::new("F_alpha", "um", "range").or(&["not cut", "cut away"]).bars();
        let teeth = [(1_u32, Some(0.5)), (2, None)];
        let table: Table =
            Table::over("flanks", "Flanks", teeth).column(&TOOTH, |of| of.0).column(&RANGE, |of| of.1).into();
        let heads: Vec<String> = table.columns.iter().map(TableColumn::head).collect();
        assert_eq!(heads, ["tooth", "F_alpha_um"]);
        assert_eq!(table.columns[1].why.as_deref(), Some("not cut; or cut away"));
        assert_eq!(table.columns[1].chart, Some(ColumnChart::Bars));
        assert_eq!(table.rows, [vec![Datum::Count(1), Datum::Number(0.5)], vec![Datum::Count(2), Datum::Undefined]]);
        assert_eq!(table.values(&RANGE).collect::<Vec<_>>(), [Some(0.5), None]);
    }

    #[test]
    fn rows_in_a_file_are_not_in_the_results_as_well() {
        let strokes = Table::new("strokes", "Strokes", vec![TableColumn::new("stroke", "1", "stroke")])
            .with_rows([vec![Datum::Count(0)]]);
        let rows = |table: Table| {
            let section = crate::findings::Section::new("chips", "Chips").table(table);
            let findings = crate::findings::Findings {
                program_version: String::new(),
                process: String::new(),
                scene: String::new(),
                complete: true,
                headline: Vec::new(),
                warnings: Vec::new(),
                sections: vec![section],
            };
            let table = findings.to_json()["sections"]["chips"]["strokes"].clone();
            (table["rows"].as_array().map(Vec::len), table["file"].as_str().map(str::to_owned))
        };
        let file = Some("tables/chips.csv".to_owned());
        assert_eq!(rows(strokes.clone()), (Some(1), None));
        assert_eq!(rows(strokes.clone().in_file("chips")), (Some(1), file.clone()));
        assert_eq!(rows(strokes.rows_in_file("chips")), (Some(0), file));
    }
}
