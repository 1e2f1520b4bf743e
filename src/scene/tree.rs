//! TOML text to a tree that owns its values and knows where each was written.
//!
//! The parser's own tree borrows the text it was read from; this one can take in values of `--set` arguments
//! beside those of the file. Syntax errors (a key given twice among them) are reported here, all of them, and
//! end the reading: a half-read file would only give misleading follow-up problems.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::sources::At;

/// A value with its place.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// The value.
    pub value: TomlValue,
    /// Where the value stands.
    pub at: At,
}

/// What TOML can hold.
#[derive(Debug, Clone)]
pub(super) enum TomlValue {
    /// String.
    Text(String),
    /// Integer.
    Whole(i128),
    /// Integer or float beyond what a number can hold, infinite or not a number.
    Unusable,
    /// Finite float.
    Number(f64),
    /// Boolean.
    Boolean(bool),
    /// Date or time, as it is written.
    Date(String),
    /// Array.
    List(Vec<Node>),
    /// Table, in the order of the file.
    Table(Vec<KeyValue>),
}

/// One entry of a table.
#[derive(Debug, Clone)]
pub(super) struct KeyValue {
    /// The key.
    pub name: String,
    /// Where the key stands.
    pub name_at: At,
    /// Its value.
    pub node: Node,
}

/// A syntax error: where and what.
pub(super) type SyntaxError = (Range<usize>, String);

/// Reads a whole scene.
pub(super) fn parse_document(text: &str) -> Result<Node, Vec<SyntaxError>> {
    let (table, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        return Err(errors.iter().map(|error| (error.span().unwrap_or(0..0), words(error.message()))).collect());
    }
    let span = table.span();
    Ok(Node { value: table_value(table.get_ref(), &At::Scene), at: At::Scene(span) })
}

/// The parser's message, in plainer words where it speaks to programmers.
fn words(message: &str) -> String {
    match message {
        "duplicate key" => "this name is written a second time".to_owned(),
        message if message.starts_with("string values must be quoted") => {
            "a value is missing, or a text is not in quotes".to_owned()
        }
        message => message.replace('\n', ", "),
    }
}

/// Reads the value of `--set` argument number `index`, which begins at byte `start` of the argument.
pub(super) fn parse_value(index: usize, argument: &str, start: usize) -> Result<Node, String> {
    let start = argument.len() - argument[start..].trim_start().len();
    let text = argument[start..].trim_end();
    if text.is_empty() {
        return Err("it is empty".to_owned());
    }
    let place = |span: Range<usize>| At::Set(index, span.start + start..span.end + start);
    match DeValue::parse(text) {
        Ok(value) => Ok(node(&value, &place)),
        Err(_) if is_bare_word(text) => {
            Ok(Node { value: TomlValue::Text(text.to_owned()), at: At::Set(index, start..start + text.len()) })
        }
        Err(error) => Err(words(error.message())),
    }
}

/// A word or path without quotes: shells take the quotes away, so `--set` accepts it as text.
fn is_bare_word(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || matches!(c, '_' | '/' | '.'))
        && text.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.' | '/'))
}

fn table_value(table: &DeTable<'_>, place: &dyn Fn(Range<usize>) -> At) -> TomlValue {
    let mut entries: Vec<(usize, KeyValue)> = table
        .iter()
        .map(|(key, value)| {
            let name = key.get_ref().to_string();
            (key.span().start, KeyValue { name, name_at: place(key.span()), node: node(value, place) })
        })
        .collect();
    entries.sort_by_key(|(start, _)| *start);
    TomlValue::Table(entries.into_iter().map(|(_, entry)| entry).collect())
}

fn node(value: &Spanned<DeValue<'_>>, place: &dyn Fn(Range<usize>) -> At) -> Node {
    let converted = match value.get_ref() {
        DeValue::String(text) => TomlValue::Text(text.to_string()),
        DeValue::Integer(digits) => {
            i128::from_str_radix(digits.as_str(), digits.radix()).map_or(TomlValue::Unusable, TomlValue::Whole)
        }
        DeValue::Float(digits) => match digits.as_str().parse::<f64>() {
            Ok(number) if number.is_finite() => TomlValue::Number(number),
            _ => TomlValue::Unusable,
        },
        DeValue::Boolean(on) => TomlValue::Boolean(*on),
        DeValue::Datetime(date) => TomlValue::Date(date.to_string()),
        DeValue::Array(items) => TomlValue::List(items.iter().map(|item| node(item, place)).collect()),
        DeValue::Table(table) => table_value(table, place),
    };
    Node { value: converted, at: place(value.span()) }
}

impl Node {
    /// A table that nobody wrote.
    pub fn implied_table() -> Self {
        Self { value: TomlValue::Table(Vec::new()), at: At::Implied }
    }

    /// Entries of a table; none for other values.
    pub fn entries(&self) -> &[KeyValue] {
        if let TomlValue::Table(entries) = &self.value { entries } else { &[] }
    }

    /// Entries of a table to change.
    pub fn entries_mut(&mut self) -> Option<&mut Vec<KeyValue>> {
        if let TomlValue::Table(entries) = &mut self.value { Some(entries) } else { None }
    }

    /// The entry of this name.
    pub fn entry(&self, name: &str) -> Option<&KeyValue> {
        self.entries().iter().find(|entry| entry.name == name)
    }

    /// The kind of value, in words.
    pub fn kind(&self) -> &'static str {
        match self.value {
            TomlValue::Text(_) => "text",
            TomlValue::Whole(_) => "a whole number",
            TomlValue::Number(_) | TomlValue::Unusable => "a number with a point",
            TomlValue::Boolean(_) => "true or false",
            TomlValue::Date(_) => "a date",
            TomlValue::List(_) => "a list",
            TomlValue::Table(_) => "a table",
        }
    }
}
