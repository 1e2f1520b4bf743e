//! A table of findings: columns of numbers, counts or words, each with unit and definition.
//!
//! In: what the rows are of, and for each column its row of the table of quantities and a function. Out: [`Table`],
//! whose [`TableCells`] a writer takes column by column in the form of its choice.
//!
//! A table holds what is the same for every row, such as the allowances of all teeth; a value with a place or a reason
//! of its own is an entry of a section instead.
//!
//! A table may have a file of its own. Where it would swell `results.json`, its rows are in that file alone: thousands
//! of strokes and points, and rows whose values are in the tree already, one section each.

use super::column::{TableCell, TableCells};
use super::datum::Datum;
use super::row::{BY_ROW, ColumnChart, QuantityRow, title_of};
use std::borrow::Cow;

/// Ending of the files of tables that a run writes.
const CSV: &str = "csv";

/// Name of the file of a table: that of the table, with the ending of the form that is written.
pub fn table_file(name: &str) -> String {
    format!("{name}.{CSV}")
}

/// Name of the table in a file: [`table_file`] the other way.
pub(super) fn table_name(file: &str) -> &str {
    file.strip_suffix(CSV).and_then(|name| name.strip_suffix('.')).unwrap_or(file)
}

/// Columns and rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Key in its section.
    pub key: String,
    /// What it shows.
    pub title: String,
    /// Columns; the first names the rows.
    pub columns: Vec<TableColumn>,
    /// Values of each column, as many of one as of another.
    pub cells: Vec<TableCells>,
    /// Rows after which the gear's shape repeats, if it does.
    pub period_rows: Option<u32>,
    /// Its file in the output folder without an ending, such as `tables/flanks`; none where `results.json` is enough.
    pub file: Option<String>,
    /// Whether the rows stand in the file alone: tables read from `results.json` have none then.
    pub rows_in_file: bool,
}

/// What a column holds.
#[derive(Debug, Clone, PartialEq)]
pub struct TableColumn {
    /// Key.
    pub key: Cow<'static, str>,
    /// What it is called where people read it: its key in words unless its row has a title.
    pub title: Cow<'static, str>,
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
    /// A table without columns.
    pub(super) fn new(key: &str, title: &str) -> Self {
        Self {
            key: key.to_owned(),
            title: title.to_owned(),
            columns: Vec::new(),
            cells: Vec::new(),
            period_rows: None,
            file: None,
            rows_in_file: false,
        }
    }

    /// A table with a row for each of these, whose columns follow.
    pub fn over<T>(key: &str, title: &str, of: impl IntoIterator<Item = T>) -> Columns<T> {
        Columns { of: of.into_iter().collect(), table: Self::new(key, title) }
    }

    /// The table, in a file of this name below `tables/` as well.
    #[must_use]
    pub fn in_file(self, name: &str) -> Self {
        self.at(&format!("tables/{name}"))
    }

    /// The table, its rows in the file of this name below `tables/` alone.
    #[must_use]
    pub fn rows_in_file(self, name: &str) -> Self {
        Self { rows_in_file: true, ..self.in_file(name) }
    }

    /// The table, in this file of the output folder, which has no ending.
    #[must_use]
    pub fn at(self, file: &str) -> Self {
        Self { file: Some(file.to_owned()), ..self }
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.cells.first().map_or(0, TableCells::len)
    }

    /// Whether there are none, or none here.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A row.
    pub fn row(&self, row: usize) -> Vec<Datum> {
        self.cells.iter().map(|cells| cells.datum(row)).collect()
    }

    /// All rows.
    pub fn rows(&self) -> impl Iterator<Item = Vec<Datum>> {
        (0..self.len()).map(|row| self.row(row))
    }

    /// Names of the rows: the first column in words.
    pub fn names(&self) -> impl Iterator<Item = String> {
        self.cells.first().into_iter().flat_map(|cells| (0..cells.len()).map(|row| cells.datum(row).name()))
    }

    /// Where the column of this key stands.
    pub fn column(&self, key: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.key == key)
    }

    /// Numbers of the column of a row of the table of quantities; none for words and for what is undefined.
    pub fn values(&self, row: &QuantityRow) -> impl Iterator<Item = Option<f64>> {
        self.numbers(row.key)
    }

    /// Words of the column of a row; none for numbers and where there is none.
    pub fn words(&self, row: &QuantityRow) -> impl Iterator<Item = Option<&str>> {
        let cells = self.column(row.key).and_then(|column| self.cells.get(column));
        (0..self.len()).map(move |row| match cells? {
            TableCells::Words(words) => words[row].as_deref(),
            _ => None,
        })
    }

    /// Numbers of two columns as the points of a curve; NaN where there is none.
    pub fn points(&self, x: &QuantityRow, y: &QuantityRow) -> Vec<(f64, f64)> {
        let [x, y] = [x, y].map(|row| self.values(row).map(|value| value.unwrap_or(f64::NAN)));
        x.zip(y).collect()
    }

    /// Numbers of a column, row by row; none for words, for what is undefined and for an unknown key.
    pub fn numbers(&self, key: &str) -> impl Iterator<Item = Option<f64>> {
        let cells = self.column(key).and_then(|column| self.cells.get(column));
        (0..self.len()).map(move |row| cells?.datum(row).number())
    }
}

/// A table in the making: what its rows are of, and its columns so far.
#[derive(Debug)]
pub struct Columns<T> {
    of: Vec<T>,
    table: Table,
}

impl<T> Columns<T> {
    /// With a column of this row of the table of quantities, or of a row with a key, unit or words of its own.
    #[must_use]
    pub fn column<V: TableCell>(mut self, column: impl Into<TableColumn>, value: impl Fn(&T) -> V) -> Self {
        self.table.columns.push(column.into());
        self.table.cells.push(V::cells(self.of.iter().map(|of| Some(value(of)))));
        self
    }

    /// The table, in a file of this name below `tables/` as well.
    #[must_use]
    pub fn in_file(self, name: &str) -> Table {
        self.table.in_file(name)
    }

    /// The table, in this file of the output folder as well.
    #[must_use]
    pub fn at(self, file: &str) -> Table {
        self.table.at(file)
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

impl QuantityRow {
    /// As a column.
    pub fn as_column(&self) -> TableColumn {
        TableColumn {
            key: self.key.into(),
            title: self.title().into(),
            unit: (!["", BY_ROW].contains(&self.unit)).then_some(Cow::Borrowed(self.unit)),
            definition: self.definition.into(),
            why: match self.reasons {
                [] => None,
                [reason] => Some(Cow::Borrowed(*reason)),
                reasons => Some(reasons.join("; or ").into()),
            },
            chart: self.chart,
        }
    }
}

impl From<&QuantityRow> for TableColumn {
    fn from(row: &QuantityRow) -> Self {
        row.as_column()
    }
}

impl TableColumn {
    /// The same under this key, which its row cannot know, such as one that ends with the side of a tooth.
    #[must_use]
    pub fn keyed(self, key: impl Into<Cow<'static, str>>) -> Self {
        let key = key.into();
        Self { title: title_of(&key).into(), key, ..self }
    }

    /// The same, not drawn by comparisons.
    #[must_use]
    pub fn undrawn(self) -> Self {
        Self { chart: None, ..self }
    }

    /// The same in a unit that its row cannot know, such as that of an axis.
    #[must_use]
    pub fn in_unit(self, unit: impl Into<Cow<'static, str>>) -> Self {
        Self { unit: Some(unit.into()), ..self }
    }

    /// The same with words after its definition that only this run knows.
    #[must_use]
    pub fn remarked(self, remark: &str) -> Self {
        Self { definition: format!("{}{remark}", self.definition).into(), ..self }
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_of_files_end_with_the_unit() {
        let head = |key: &'static str, unit: &'static str| QuantityRow::new(key, unit, "").as_column().head();
        assert_eq!(head("AB", "mm"), "AB_mm");
        assert_eq!(head("unevenness", "%"), "unevenness_percent");
        assert_eq!(head("removal_rate", "cm^3/min"), "removal_rate_cm3_per_min");
        assert_eq!(head("work_torque", "N m"), "work_torque_Nm");
        assert_eq!([head("tooth", "1"), head("two_flank_chips", "chips")], ["tooth", "two_flank_chips"]);
        assert_eq!([head("flank", ""), head("step", BY_ROW)], ["flank", "step"]);
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
        assert_eq!(
            table.cells,
            [TableCells::Counts(vec![Some(1), Some(2)]), TableCells::Numbers(vec![Some(0.5), None])]
        );
        assert_eq!(table.values(&RANGE).collect::<Vec<_>>(), [Some(0.5), None]);
    }

    #[test]
    fn rows_in_a_file_are_not_in_the_results_as_well() {
        static STROKE: QuantityRow = QuantityRow::new("stroke", "1", "stroke");
        let strokes = Table::from(Table::over("strokes", "Strokes", [0_u32]).column(&STROKE, |stroke| *stroke));
        let rows = |table: Table| {
            let section = crate::findings::Section::new("chips", "Chips").table(table);
            let findings = crate::findings::Findings::new("", "", true, [], [], vec![section]);
            let table = findings.to_json()["sections"]["chips"]["strokes"].clone();
            (table["rows"].as_array().map(Vec::len), table["file"].as_str().map(str::to_owned))
        };
        let file = Some("tables/chips.csv".to_owned());
        assert_eq!(rows(strokes.clone()), (Some(1), None));
        assert_eq!(rows(strokes.clone().in_file("chips")), (Some(1), file.clone()));
        assert_eq!(rows(strokes.rows_in_file("chips")), (Some(0), file));
    }
}
