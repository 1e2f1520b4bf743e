//! JSON Schema of the scene file, printed from the table of keys, for editors that complete and check TOML.
//!
//! The draft is 2020-12. What one key allows and which keys exclude each other is in it; what only several values
//! together show (names that repeat, a window that ends before it begins) is left to the reader.

use serde_json::{Map, Value, json};

use super::keys::{Default, Key, Kind, Range, Role};
use super::table::{KeyTable, TableSection};

/// The schema as text, one line break at the end: the content of `scenes/schema.json`.
pub fn json_schema(table: &KeyTable) -> String {
    let mut root = Map::new();
    root.insert("$schema".to_owned(), json!("https://json-schema.org/draft/2020-12/schema"));
    root.insert("title".to_owned(), json!("gearcut scene"));
    if let Some(section) = table.section("") {
        root.extend(of_section(table, section));
    }
    let mut text = serde_json::to_string_pretty(&Value::Object(root)).unwrap_or_default();
    text.push('\n');
    text
}

/// Schema of one section.
fn of_section(table: &KeyTable, section: &TableSection) -> Map<String, Value> {
    let mut properties = Map::new();
    for key in &section.keys {
        properties.insert(key.name.to_owned(), property(key));
    }
    for child in table.children(section) {
        let inner = Value::Object(of_section(table, child));
        let value = match child.role {
            Role::List { fewest } => json!({ "type": "array", "minItems": fewest, "items": inner }),
            _ => inner,
        };
        properties.insert(child.name().to_owned(), value);
    }
    let mut schema = Map::new();
    schema.insert("type".to_owned(), json!("object"));
    schema.insert("description".to_owned(), json!(section.teach));
    schema.insert("additionalProperties".to_owned(), json!(false));
    schema.insert("properties".to_owned(), Value::Object(properties));
    let required: Vec<&str> = required_names(table, section);
    if !required.is_empty() {
        schema.insert("required".to_owned(), json!(required));
    }
    if let Role::Choice { default, .. } = section.role {
        schema.insert("maxProperties".to_owned(), json!(1));
        if default.is_none() {
            schema.insert("minProperties".to_owned(), json!(1));
        }
    }
    let rules: Vec<Value> = section
        .groups
        .iter()
        .map(|group| {
            let each: Vec<Value> = group.names.iter().map(|name| json!({ "required": [name] })).collect();
            if group.required { json!({ "oneOf": each }) } else { json!({ "not": { "required": group.names } }) }
        })
        .collect();
    if !rules.is_empty() {
        schema.insert("allOf".to_owned(), json!(rules));
    }
    schema
}

/// Keys and sections that must be there.
fn required_names(table: &KeyTable, section: &TableSection) -> Vec<&'static str> {
    let keys = section.keys.iter().filter(|key| matches!(key.default, Default::Required)).map(|key| key.name);
    let sections = table.children(section).filter(|child| must_be_there(table, child)).map(TableSection::name);
    keys.chain(sections).collect()
}

/// Whether a table must be written: it asks for something, and it is not one of several to choose from.
fn must_be_there(table: &KeyTable, section: &TableSection) -> bool {
    match section.role {
        Role::Variant | Role::List { .. } => false,
        Role::Choice { default, .. } => default.is_none(),
        Role::Plain => !required_names(table, section).is_empty(),
    }
}

/// Schema of one key.
fn property(key: &Key) -> Value {
    let mut schema = match key.kind {
        Kind::Number(range) => number(range),
        Kind::Whole { min, max } => json!({ "type": "integer", "minimum": min, "maximum": max }),
        Kind::Boolean => json!({ "type": "boolean" }),
        Kind::Word(words) => json!({ "type": "string", "enum": words }),
        Kind::Name => json!({ "type": "string", "pattern": "^[A-Za-z0-9_][A-Za-z0-9_-]{0,63}$" }),
        Kind::Path | Kind::Formula => json!({ "type": "string", "minLength": 1 }),
        Kind::Text { most } => json!({ "type": "string", "minLength": 1, "maxLength": most }),
        Kind::Numbers { range, most } => json!({ "type": "array", "items": number(range), "maxItems": most }),
        Kind::Pair(range) => json!({ "type": "array", "items": number(range), "minItems": 2, "maxItems": 2 }),
        Kind::Points { angle, radius, fewest, most } => {
            let point = json!({
                "type": "array", "prefixItems": [number(angle), number(radius)], "items": false, "minItems": 2
            });
            json!({ "type": "array", "items": point, "minItems": fewest, "maxItems": most })
        }
    };
    if let Value::Object(schema) = &mut schema {
        let unit = if key.unit.is_empty() { String::new() } else { format!(" Unit: {}.", key.unit) };
        let default = match key.default {
            Default::Derived(words) | Default::LeftOut(words) => format!(" Default: {words}."),
            _ => String::new(),
        };
        schema.insert("description".to_owned(), json!(format!("{}{unit}{default}", key.teach)));
        let default = match key.default {
            Default::Number(number) => Some(json!(number)),
            Default::Whole(number) => Some(json!(number)),
            Default::Boolean(on) => Some(json!(on)),
            Default::Word(word) => Some(json!(word)),
            Default::EmptyList => Some(json!([])),
            Default::Required | Default::OneOfGroup | Default::Derived(_) | Default::LeftOut(_) => None,
        };
        if let Some(default) = default {
            schema.insert("default".to_owned(), default);
        }
    }
    schema
}

fn number(range: Range) -> Value {
    let low = if range.above_min { "exclusiveMinimum" } else { "minimum" };
    let high = if range.below_max { "exclusiveMaximum" } else { "maximum" };
    json!({ "type": "number", low: range.min, high: range.max })
}
